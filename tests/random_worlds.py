"""Random models in random surroundings that touch at once, in any frame, units and order of what is added."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.spatial.transform import Rotation

import ancf

SHAPES = ("plane", "cylinder", "can", "sphere", "capsule", "torus", "sheave", "mesh")
FACES = np.array([[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]])


@dataclass(frozen=True)
class Frame:
    """How a model is written down: turned or mirrored, moved, later, in other units, beams from other ends.

    ``R`` is orthogonal, about z where there are surfaces of fluids and grounds; ``o`` is added first, m.
    ``later`` is when all begins, s; ``size`` are the numbers of a unit of length, time and mass; ``order``
    mixes what is added.
    """

    R: Any = field(default_factory=lambda: np.eye(3))
    o: Any = field(default_factory=lambda: np.zeros(3))
    size: tuple[float, float, float] = (1.0, 1.0, 1.0)
    order: int | None = None
    flipped: bool = False
    later: float = 0.0

    def clock(self, t: float) -> float:
        """Time since all began, s."""
        return t / self.size[1] - self.later

    def number(self, x: Any, length: float = 0, time: float = 0, mass: float = 0) -> Any:
        """In these units."""
        return x * self.size[0] ** length * self.size[1] ** time * self.size[2] ** mass

    def vector(self, x: Any, length: float = 0, time: float = 0, mass: float = 0) -> Any:
        """As a polar vector; a direction without powers of units."""
        return self.number(1.0, length, time, mass) * (self.R @ np.asarray(x, float))

    def axial(self, x: Any, length: float = 0, time: float = 0, mass: float = 0) -> Any:
        """As an axial vector, such as a moment."""
        return np.linalg.det(self.R) * self.vector(x, length, time, mass)

    def place(self, x: Any) -> Any:
        """As a position."""
        return self.size[0] * (self.R @ (np.asarray(x, float)) + self.o)

    def law(self, f: Callable[[float], Any], *powers: float, axial: bool = False) -> Callable[[float], Any]:
        """As a function of time."""
        turned = self.axial if axial else self.vector
        return lambda t: tuple(turned(f(self.clock(t)), *powers))


ABOUT_Z = Rotation.from_rotvec([0.0, 0.0, 0.7]).as_matrix()
FRAMES = {
    "turned": Frame(R=ABOUT_Z, o=np.array([0.3, -0.2, 0.5])),
    "mirrored": Frame(R=ABOUT_Z @ np.diag([1.0, -1.0, 1.0])),
    "beams from their ends": Frame(flipped=True),
    "renamed in another order": Frame(order=3),
    "millimetres and grams": Frame(size=(1e3, 1.0, 1e3)),
    "odd units": Frame(size=(0.01, 100.0, 0.3)),
}
#: From an equilibrium of nothing at another time. Of grounds with dampers it remembers limits of rest.
LATER = {"later": Frame(later=0.37)}
#: How runs of worlds are made: to round-off, s.
EXACT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-13))
STEP, COUNT = 2.5e-4, 40


def unit(x: Any) -> Any:
    """Of length one."""
    return np.asarray(x) / np.linalg.norm(x)


class World:
    """A model of a seed in a frame.

    Attributes
    ----------
    points : list of Point
        Of all bodies, the same ones in all frames.
    contacts : dict
        By a name that is the same in all frames.
    """

    def __init__(self, seed: int, frame: Frame | None = None, more: bool = True) -> None:
        self.frame = frame = Frame() if frame is None else frame
        self.rng = rng = np.random.default_rng(seed)
        self.g = np.array([0.0, 0.0, -9.81])
        self.model = ancf.Model(gravity=tuple(frame.vector(self.g, 1, -2)))
        self.beams: dict[str, tuple[Any, Any, Any, float]] = {}
        self.skins: dict[str, tuple[Any, Any, Any, Any, float]] = {}
        self.contacts: dict[str, Any] = {}
        self._points: dict[str, list[Any]] = {}
        count = rng.integers(1, 4, 2)
        self._each([("_beam", k) for k in range(count[0])] + [("_body", k) for k in range(count[1])])
        self._hits()
        others = ["_ground"] * int(rng.integers(0, 2))
        if more:
            others += ["_fluid"] * int(rng.integers(0, 2)) + ["_spring", "_load"] * int(rng.integers(0, 3))
        self._each(list(zip(others, range(len(others)), strict=True)))
        self.points = [point for name in sorted(self._points) for point in self._points[name]]

    def _each(self, jobs: list[tuple[str, int]]) -> None:
        """Add all of these, in the order of the frame, each with random numbers of its own."""
        seeds = self.rng.integers(0, 2**31, len(jobs))
        order = np.arange(len(jobs))
        if self.frame.order is not None:
            order = np.random.default_rng(self.frame.order).permutation(order)
        for k in order.tolist():
            getattr(self, jobs[k][0])(jobs[k][1], np.random.default_rng(seeds[k]))

    def name(self, text: str) -> str:
        """Another one where the order is."""
        return text if self.frame.order is None else "z" + text[::-1]

    def _section(self, rng: Any, element: str, d: float) -> ancf.Section:
        f = self.frame.number
        given = {"drag": tuple(rng.uniform(0.1, 2, 2)), "added_mass": tuple(rng.uniform(0, 1.2, 2))}
        if element == "cable":
            EA, EI, rhoA = rng.uniform(100, 500), rng.uniform(0.1, 3), rng.uniform(0.3, 2)
            given |= {"EI": f(EI, 3, -2, 1), "rhoA": f(rhoA, -1, 0, 1), "bending_damping": f(0.01, 3, -1, 1)}
            return ancf.Section(EA=f(EA, 1, -2, 1), diameter=f(d, 1), **given)
        E, rho = rng.uniform(5e4, 1e5), rng.uniform(100, 400)
        return ancf.Section.circle(f(d, 1), E=f(E, -1, -2, 1), rho=f(rho, -3, 0, 1), nu=0.3, **given)

    def _rod(self, name: str, rng: Any, start: Any, end: Any, d: float) -> Any:
        """A straight beam and its points."""
        element, count = str(rng.choice(["cable", "original", "nonlocking"])), int(rng.integers(1, 4))
        ends = [self.frame.place(x) for x in ((end, start) if self.frame.flipped else (start, end))]
        given = {"section": self._section(rng, element, d), "elements": count, "element": element}
        if element != "cable":
            given["y_axis"] = self.frame.vector(unit(rng.standard_normal(3)))
        beam = self.model.add_beam(self.name(name), start=ends[0], end=ends[1], **given)
        places = [beam.length * abs(x - self.frame.flipped) for x in (0.0, rng.random(), 1.0)]
        self._points[name] = [beam.at(x) for x in places]
        self.beams[name] = beam, start, end, d
        return beam

    def _beam(self, k: int, rng: Any) -> None:
        start = 0.6 * rng.standard_normal(3)
        self._rod(
            f"b{k}",
            rng,
            start,
            start + rng.uniform(0.5, 1.5) * unit(rng.standard_normal(3)),
            rng.uniform(0.03, 0.1),
        )

    def _body(self, k: int, rng: Any) -> None:
        """A rigid body with a ball or a capsule about it."""
        f, at, name = self.frame, 0.6 * rng.standard_normal(3), f"m{k}"
        turn = f.R @ np.linalg.qr(rng.standard_normal((3, 3)))[0]
        inertia = turn @ np.diag(rng.uniform(0.05, 0.09, 3)) @ turn.T
        wet = {"volume": f.number(rng.uniform(0, 4e-3), 3), "drag_area": f.number(rng.uniform(0, 0.1), 2)}
        body = self.model.add_rigid_body(
            self.name(name),
            at=f.place(at),
            mass=f.number(rng.uniform(0.5, 3), mass=1),
            inertia=f.number(inertia, 2, 0, 1),
            added_mass=rng.uniform(0, 1),
            **wet,
        )
        arm, off, axis, radius = (
            *rng.standard_normal((2, 3)),
            unit(rng.standard_normal(3)),
            rng.uniform(0.05, 0.2),
        )
        given = {"radius": f.number(radius, 1), "at": f.vector(0.1 * off, 1)}
        ball = rng.random() < 0.5
        long = {"length": f.number(rng.uniform(0.1, 0.4), 1), "axis": f.vector(axis)}
        shape = ancf.Sphere(**given) if ball else ancf.Capsule(**given, **long)
        surface = self.model.add_surface(self.name(f"skin {k}"), shape, on=body)
        self.skins[name] = surface, body, at, None if ball else axis, radius
        self._points[name] = [body.centre, body.at(*f.vector(0.2 * arm, 1))]

    def _surface(
        self, name: str, rng: Any, p: Any, n: Any, t: Any, radius: float, but: str, kinds: Any
    ) -> Any:
        """A shape that a ball of this radius at p nearly touches from the side n; t runs along it."""
        f, kind, gap, R = self.frame, str(rng.choice(kinds)), rng.uniform(0, 3e-3), rng.uniform(0.1, 0.4)
        turn, others = rng.uniform(-0.5, 0.5), [key for key in sorted(self.skins) if key != but]
        on = self.skins[str(rng.choice(others))] if others and rng.random() < 0.5 else None
        side = np.cross(n, t)
        axis = f.vector(np.cos(turn) * side + np.sin(turn) * t)

        def at(x: Any) -> Any:
            return f.place(x) if on is None else f.vector(x - on[2], 1)

        foot, N = p - (radius + gap) * n, lambda x: f.number(x, 1)
        if kind == "mesh":
            corners = R * np.array([n, -n, 1.3 * t, -1.3 * t, 1.3 * side, -1.3 * side])
            right = np.linalg.det(f.R) > 0.0
            given = {"points": N(corners @ f.R.T), "triangles": (FACES[:, ::-1] if right else FACES).tolist()}
            shape = ancf.Mesh(**given, at=at(foot - R * n))
        else:
            shape = {
                "plane": lambda: ancf.Plane(at(foot), f.vector(n)),
                "cylinder": lambda: ancf.Cylinder(N(R), at(foot - R * n), axis),
                "can": lambda: ancf.Cylinder(N(R), at(foot - R * n), axis, length=N(0.3)),
                "sphere": lambda: ancf.Sphere(N(R), at(foot - R * n)),
                "capsule": lambda: ancf.Capsule(N(R), N(0.5), at(foot - R * n), axis),
                "torus": lambda: ancf.Torus(N(R + 0.1), N(0.1), at(foot - (R + 0.2) * n), axis),
                "sheave": lambda: ancf.Sheave(
                    N(R), N(1.1 * radius + gap), N(3 * radius + gap), 0.9, at(foot - R * n), f.vector(side)
                ),
            }[kind]()
        return self.model.add_surface(self.name(name), shape, on=None if on is None else on[1])

    def _law(self, rng: Any, per: float) -> dict[str, Any]:
        f, k = self.frame, rng.uniform(2e3, 2e4)
        damping, friction = float(rng.choice([0, 0.01])) * k, float(rng.choice([0.0, 0.3]))
        given = {"stiffness": f.number(k, -per, -2, 1), "damping": f.number(damping, -per, -1, 1)}
        return given | {"friction": friction, "stick": f.number(k * rng.uniform(0.3, 1), -per, -2, 1)}

    def _hits(self) -> None:
        """Each beam and body runs into something."""
        for name, (beam, start, end, d) in sorted(self.beams.items()):
            rng = np.random.default_rng(self.rng.integers(2**31))
            t = unit(end - start)
            n = unit(np.cross(t, rng.standard_normal(3)))
            p = start + rng.uniform(0.2, 0.8) * (end - start)
            if rng.random() < 0.6:
                other = self._surface(f"by {name}", rng, p, n, t, 0.5 * d, "", SHAPES)
            else:
                turn, wide = rng.uniform(0.3, 2.8), rng.uniform(0.03, 0.1)
                way = rng.uniform(0.2, 0.6) * (np.cos(turn) * t + np.sin(turn) * np.cross(n, t))
                middle = p - (0.5 * d + 0.5 * wide + rng.uniform(0, 3e-3)) * n
                other = self._rod(f"x{name}", rng, middle - way, middle + way, wide)
            self._touch(name, beam, other, n, rng, 1.0)
        for name, (skin, body, at, axis, radius) in sorted(self.skins.items()):
            rng = np.random.default_rng(self.rng.integers(2**31))
            t = unit(rng.standard_normal(3)) if axis is None else axis
            n, p = unit(np.cross(t, rng.standard_normal(3))), at + self._offset(skin)
            other = self._surface(f"by {name}", rng, p, n, t, radius, name, SHAPES[:-1])
            self._touch(name, skin, other, n, rng, 0.0)
            spin = self.frame.axial(3.0 * rng.standard_normal(3) * (rng.random() < 0.5), 0, -1)
            body.set_motion(velocity=body.velocity, angular_velocity=spin)

    def _offset(self, skin: Any) -> Any:
        return self.frame.R.T @ skin.shape.at / self.frame.size[0]

    def _touch(self, name: str, one: Any, other: Any, n: Any, rng: Any, per: float) -> None:
        velocity = 0.3 * rng.standard_normal(3) - rng.uniform(0.2, 1.5) * n
        moving = self.skins[name][1] if name in self.skins else one
        moving.set_motion(velocity=self.frame.vector(velocity, 1, -1))
        law = self._law(rng, per)
        self.contacts[name] = self.model.add_contact(one, other, name=self.name(f"c {name}"), **law)

    def _ground(self, k: int, rng: Any) -> None:
        f, d = self.frame, self._law(rng, 2.0)
        n, h = unit([*0.3 * rng.standard_normal(2), 1.0]), 0.3 * rng.standard_normal() - 0.5
        n, height = f.R @ n, h + (f.o @ (f.R @ n)) / (f.R @ n)[2]
        self.model.add_ground(self.name(f"g{k}"), height=f.number(height, 1), normal=n, **d)

    def _fluid(self, k: int, rng: Any) -> None:
        f, z = self.frame, np.sort(rng.uniform(-1, 1, 4))
        v = np.array([f.vector(x, 1, -1) for x in rng.standard_normal((4, 3)) * [1, 1, 0]])
        level, wind, w = rng.standard_normal() * 0.2, rng.standard_normal(3), rng.uniform(1, 6)
        level = f.number(level + f.o[2], 1)
        given = {"z": f.number(z + f.o[2], 1), "velocity": v}
        self.model.add_fluid(
            self.name("w"), f.number(rng.uniform(50, 300), -3, 0, 1), velocity=given, below=level
        )
        blows = f.law(lambda t: wind * np.sin(w * t), 1, -1)
        self.model.add_fluid(self.name("air"), f.number(10.0, -3, 0, 1), velocity=blows, above=level)

    def _any(self, rng: Any) -> Any:
        points = [point for name in sorted(self._points) for point in self._points[name]]
        return points[int(rng.integers(len(points)))]

    def _spring(self, k: int, rng: Any) -> None:
        f, a, way = self.frame, self._any(rng), rng.uniform(0.2, 1) * unit(rng.standard_normal(3))
        b = self._any(rng) if rng.random() < 0.5 else tuple(a.initial_position + f.vector(way, 1))
        given = {"length": f.number(rng.uniform(0.1, 1), 1), "damping": f.number(rng.uniform(0, 2), 0, -1, 1)}
        soft = rng.uniform(5, 50)
        curve = np.array([(-0.2, -2), (-0.05, -0.3), (0, 0), (0.1, 0.1), (0.3, 1)]) * [1.0, soft]
        if rng.random() < 0.5:
            given["law"] = curve * [f.number(1.0, 1), f.number(1.0, 1, -2, 1)]
        else:
            given |= {"stiffness": f.number(soft, 0, -2, 1), "slack": bool(rng.random() < 0.5)}
        self.model.add_spring(a, b, name=self.name(f"s{k}"), **given)

    def _load(self, k: int, rng: Any) -> None:
        f, c, w, name = self.frame, 2.0 * rng.standard_normal(3), rng.uniform(1, 20), self.name(f"l{k}")
        beam = self.beams[str(rng.choice(sorted(self.beams)))][0]
        kind, backward = str(rng.choice(["force", "between", "pressure", "law", "follower"])), f.flipped
        if kind == "force":
            self.model.add_force(self._any(rng), f.law(lambda t: c * np.cos(w * t), 1, -2, 1), name=name)
        elif kind == "between":
            low, high = np.sort(np.abs(np.sort(rng.random(2)) - backward)) * beam.length
            law = f.law(lambda t: c * np.cos(w * t), 0, -2, 1)
            self.model.add_distributed_load(beam, law, between=(low, high), name=name)
        elif kind == "pressure":  # along tangent x axis
            size = f.number(c[0], 0, -2, 1) * np.linalg.det(f.R) * (-1 if backward else 1)
            self.model.add_pressure(beam, size, axis=f.vector(unit(c)), name=name)
        elif kind == "law":
            drag = float(f.number(rng.uniform(0, 1), 0, -1, 1))
            law = [f"-({drag!r})*v{x}" for x in "xyz"]
            self.model.add_force(self._any(rng), law, name=name)
        else:
            size = f.number(c[0], 1, -2, 1) * (-1 if backward else 1)
            self.model.add_follower_force(beam.end if not backward else beam.start, (size, 0, 0), name=name)

    def answers(self, run: ancf.Result) -> dict[str, Any]:
        """What a run tells, in the units and along the axes of no frame."""
        f, out = self.frame, {}
        for k, point in enumerate(self.points):
            out[f"place {k}"] = run.position(point) / f.number(1.0, 1) @ f.R - f.R.T @ f.o
            out[f"velocity {k}"] = run.velocity(point) / f.number(1.0, 1, -1) @ f.R
        for name, contact in self.contacts.items():
            out[f"force of {name}"] = run.sensors.contact_force(contact) / f.number(1.0, 1, -2, 1)
            out[f"friction of {name}"] = run.sensors.friction_force(contact) / f.number(1.0, 1, -2, 1)
        for key in ("kinetic", "strain", "dissipated", "supplied"):
            out[key] = getattr(run.energy, key) / f.number(1.0, 2, -2, 1)
        out["momentum"] = run.momentum / f.number(1.0, 1, -1, 1) @ f.R
        return out


def run_of(world: World) -> ancf.Result:
    """A short run in the units of a world, from its initial shape."""
    later, time = world.frame.later, world.frame.size[1]
    given = {"t_end": (later + COUNT * STEP) * time, "step": STEP * time, "integrator": EXACT}
    if later:
        given["start"] = ancf.equilibrium(world.model, of=[], time=later * time)
    return ancf.simulate(world.model, sensors=list(world.contacts.values()), **given)


def differences(make: Callable[..., World], seed: int, frames: dict[str, Frame]) -> dict[str, float]:
    """How far what a run tells goes apart in each of the frames, by its name and theirs, as a share."""
    first, found = make(seed), {}
    wanted = first.answers(run_of(first))
    for name, frame in frames.items():
        world = make(seed, frame)
        answers = world.answers(run_of(world))
        for key, values in wanted.items():
            size = max(float(np.max(np.abs(values))), 1.0 if "of" in key else 0.1)
            found[f"{name}: {key}"] = float(np.max(np.abs(answers[key] - values))) / size
    return found
