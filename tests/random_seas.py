"""Random cables in random seas, on grounds, surfaces, each other and winches, for all methods."""

from __future__ import annotations

from typing import Any

import numpy as np

import ancf
from contact_laws import unit


class Sea:
    """A model of a seed, for all methods, with friction or without.

    Attributes
    ----------
    points : list of Point
    contacts : list of connections
    """

    def __init__(self, seed: int, friction: bool = True) -> None:
        self.rng, self.friction = np.random.default_rng(seed), friction
        self.model = ancf.Model(gravity=(0.0, 0.0, -9.81))
        self.points: list[Any] = []
        self.free: list[Any] = []  # points that springs may pull
        self.contacts: list[Any] = []
        self.low = np.inf
        for k in range(int(self.rng.integers(1, 4))):
            self._rope(k)
        if self.rng.random() < 0.5:
            damping = self.rng.uniform(0, 500)
            given = {"stiffness": self.rng.uniform(2e4, 1e5), "damping": damping, "friction": self._mu()}
            self.model.add_ground("bed", height=self.low + self.rng.uniform(-2e-2, 5e-3), **given)
        if self.rng.random() < 0.7:
            self._fluids()
        for k in range(int(self.rng.integers(0, 3))):
            self._spring(k)

    def _mu(self) -> float:
        return float(self.rng.choice([0.1, 0.3])) if self.friction else 0.0

    def _law(self) -> dict[str, float]:
        k = self.rng.uniform(2e3, 2e4)
        return {"stiffness": k, "damping": k * float(self.rng.choice([0, 0.01])), "friction": self._mu()}

    def _section(self, d: float) -> ancf.Section:
        rng = self.rng
        wet = {"drag": tuple(rng.uniform(0.1, 2, 2)), "added_mass": tuple(rng.uniform(0, 1.2, 2))}
        soft = {"EA": rng.uniform(100, 500), "EI": rng.uniform(0.05, 1), "rhoA": rng.uniform(0.3, 2)}
        return ancf.Section(**soft, **wet, diameter=d, bending_damping=0.01, axial_damping=0.2)

    def _rope(self, k: int) -> None:
        """A rope with one end held that moves, perhaps by a winch, and what it runs into."""
        rng, model, d = self.rng, self.model, self.rng.uniform(0.03, 0.08)
        start, t = 0.5 * rng.standard_normal(3), unit(rng.standard_normal(3))
        end = start + rng.uniform(0.6, 1.5) * t
        self.low = min(self.low, start[2], end[2])
        given = {"section": self._section(d), "elements": int(rng.integers(2, 5))}
        rope = model.add_beam(f"b{k}", start=start, end=end, **given)
        held, other = (rope.start, rope.end)[:: 1 if rng.random() < 0.5 else -1]
        self.points += [held, other, rope.at(0.4 * rope.length)]
        self.free.append(other)
        winch = False
        if rng.random() < 0.7:
            way, w = 0.03 * rng.standard_normal(3), rng.uniform(3, 10)
            model.pin(held, displacement=lambda t: tuple(way * (1 - np.cos(w * t))))
            winch = rng.random() < 0.6
            if winch:
                change, often = rng.choice([-1, 1]) * rng.uniform(0.05, 0.2), rng.uniform(3, 9)
                model.winch(held, length=lambda t: rope.length * (1 + change * (1 - np.cos(often * t))))
            if rng.random() < 0.5:
                wet = {"volume": rng.uniform(0, 4e-3), "drag_area": rng.uniform(0, 0.1)}
                load = model.add_point_mass(f"m{k}", at=other.initial_position, mass=1.0, **wet)
                model.connect(other, load)
        n = unit(np.cross(t, rng.standard_normal(3)))
        p, fast = start + rng.uniform(0.3, 0.7) * (end - start), rng.uniform(0.2, 1.2)
        if winch or rng.random() < 0.6:
            self._surface(rope, p - (0.5 * d + rng.uniform(0, 3e-3)) * n, n, t)
        else:
            self._across(rope, p - (0.5 * d + rng.uniform(0, 3e-3)) * n, n, t)
        if not winch:
            rope.set_motion(velocity=tuple(-fast * n + 0.1 * rng.standard_normal(3)))

    def _surface(self, rope: Any, foot: Any, n: Any, t: Any) -> None:
        R, kind = self.rng.uniform(0.1, 0.4), str(self.rng.choice(["ball", "drum", "plane"]))
        shape = {
            "ball": ancf.Sphere(R, tuple(foot - R * n)),
            "drum": ancf.Cylinder(R, tuple(foot - R * n), tuple(np.cross(n, t))),
            "plane": ancf.Plane(tuple(foot), tuple(n)),
        }[kind]
        surface = self.model.add_surface(f"{kind} of {rope.name}", shape)
        self.contacts.append(self.model.add_contact(rope, surface, **self._law()))

    def _across(self, rope: Any, foot: Any, n: Any, t: Any) -> None:
        rng = self.rng
        wide, turn = rng.uniform(0.03, 0.08), rng.uniform(0.4, 2.7)
        way = rng.uniform(0.3, 0.6) * (np.cos(turn) * t + np.sin(turn) * np.cross(n, t))
        ends = {"start": foot - 0.5 * wide * n - way, "end": foot - 0.5 * wide * n + way}
        self.low = min(self.low, ends["start"][2], ends["end"][2])
        given = {"section": self._section(wide), "elements": int(rng.integers(1, 4))}
        other = self.model.add_beam(f"x{rope.name}", **ends, **given)
        self.points += [other.start, other.end]
        self.contacts.append(self.model.add_contact(rope, other, **self._law()))

    def _fluids(self) -> None:
        rng, level = self.rng, 0.2 * self.rng.standard_normal()
        kind, density = str(rng.choice(["waves", "constant", "formula", "profile"])), rng.uniform(50, 300)
        z, v = np.sort(rng.uniform(-1, 1, 4)), rng.standard_normal((4, 3)) * [1, 1, 0]
        waves = {
            "direction": rng.uniform(-3, 3),
            "phase": rng.uniform(0, 6),
            "depth": rng.choice([None, 5.0]),
        }
        given = {
            "waves": {"waves": ancf.Waves.regular(rng.uniform(0.1, 0.3), rng.uniform(1, 2), **waves)},
            "constant": {"velocity": tuple(v[0])},
            "formula": {"velocity": ["0.5*sin(2*x+t)*cos(z)", "0.3*y*t", "0.4*exp(z/4)*cos(2*t)"]},
            "profile": {"velocity": {"z": z, "velocity": v}},
        }[kind]
        self.model.add_fluid("water", density, below=level, **given)
        wind, w = 3 * rng.standard_normal(3), rng.uniform(2, 9)
        self.model.add_fluid("air", 10.0, velocity=lambda t: tuple(wind * np.sin(w * t)), above=level)

    def _spring(self, k: int) -> None:
        rng, point = self.rng, self.free[int(self.rng.integers(len(self.free)))]
        place = point.initial_position + rng.uniform(0.2, 1) * unit(rng.standard_normal(3))
        given = {"stiffness": rng.uniform(5, 50), "damping": rng.uniform(0, 2), "length": rng.uniform(0.1, 1)}
        self.model.add_spring(point, tuple(place), name=f"s{k}", slack=bool(rng.random() < 0.5), **given)
