"""Forces of random fluids on bodies in random states: the theory page's formula, written once more."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from numpy.polynomial.legendre import leggauss

import ancf
from ancf.batches import Batches
from ancf.system.core import residual
from ancf.system.system import System
from fluid_laws import airy, gust, inside, morison, on_body, random_flow

KINDS = ("constant", "of time", "profile", "formula")
PLACES, WEIGHTS = leggauss(5)
G = 9.81


class Sea:
    """A cable, two beams, a mass and a rigid body in one to three fluids, with waves or gusts or none."""

    def __init__(self, seed: int, wavy: bool) -> None:
        self.rng = rng = np.random.default_rng(seed)
        self.g = np.array([0.0, 0.0, -G]) if wavy else 5.0 * rng.standard_normal(3)
        self.t, self.model = rng.uniform(0.2, 9.0), ancf.Model(gravity=tuple(self.g))
        self.fluids: list[dict[str, Any]] = []
        for k, element in enumerate(("cable", "original", "nonlocking")):
            self._beam(f"b{k}", element)
        given = {"at": rng.standard_normal(3), "mass": 1.0, "volume": rng.uniform(0.0, 0.1)}
        given |= {"drag_area": rng.uniform(0, 0.3), "added_mass": rng.uniform(0, 1)}
        self.model.add_point_mass("mass", **given)
        self.model.add_rigid_body("body", inertia=(0.3, 0.4, 0.5), **given | {"at": rng.standard_normal(3)})
        level, most = 0.3 * rng.standard_normal(), math.inf
        if wavy:
            self._fluid("water", 1000.0, -most, level, waves=self._waves())
            if rng.random() < 0.5:
                self._fluid("air", 30.0, level, most, gusts=self._gusts())
        elif rng.random() < 0.4:
            self._fluid("water", 1000.0, -most, level)
            self._fluid("oil", 800.0, level, level + 0.15)
            self._fluid("air", 20.0, level + 0.15, most, gusts=self._gusts())
        else:
            self._fluid("water", 1000.0, -most, most, on=["b0", "mass"])
            self._fluid("air", 20.0, -most, most, on=["b1", "b2", "body"], gusts=self._gusts())

    def _beam(self, name: str, element: str) -> None:
        rng = self.rng
        start, way, d = rng.standard_normal(3), rng.standard_normal(3), rng.uniform(0.02, 0.2)
        given: dict[str, Any] = {"drag": tuple(rng.uniform(0, 2, 2))}
        if rng.random() < 0.7:
            given["added_mass"] = tuple(rng.uniform(0, 1.5, 2))
        if element == "cable":
            section = ancf.Section(EA=100.0, EI=1.0, rhoA=1.0, diameter=d, **given)
        else:
            section = ancf.Section.circle(d, E=1e5, rho=100.0, nu=0.3, **given)
        end, count = start + rng.uniform(0.8, 2.5) * way / np.linalg.norm(way), int(rng.integers(1, 4))
        self.model.add_beam(name, start=start, end=end, elements=count, section=section, element=element)

    def _waves(self) -> ancf.Waves:
        rng = self.rng
        given = {"direction": rng.uniform(-3, 3), "depth": rng.choice([None, rng.uniform(12, 20)])}
        given |= {"stretching": str(rng.choice(["wheeler", "none"])), "ramp": float(rng.choice([0.0, 5.0]))}
        if rng.random() < 0.5:
            return ancf.Waves.regular(0.4, 4.0, phase=rng.uniform(0, 6), **given)
        return ancf.Waves.jonswap(0.3, 4.0, seed=int(rng.integers(99)), components=7, **given)

    def _gusts(self) -> ancf.Gusts | None:
        rng = self.rng
        given = {"direction": rng.uniform(-3, 3), "line": tuple(rng.standard_normal(3)), "extent": (-3, 3)}
        given |= {"spacing": 1.0, "duration": 10.0, "ramp": float(rng.choice([0.0, 4.0]))}
        made = ancf.Gusts.von_karman(speed=5.0, deviation=1.0, length=10.0, **given)
        return made if rng.random() < 0.7 else None

    def _fluid(self, name: str, density: float, low: float, high: float, **more: Any) -> None:
        given, speed, rate = random_flow(self.rng, str(self.rng.choice(KINDS)))
        heights = {"above": low, "below": high}
        heights = {key: z for key, z in heights.items() if math.isfinite(z)}
        self.model.add_fluid(name, density, velocity=given, **heights, **more)
        self.fluids.append(
            {"density": density, "low": low, "high": high, "speed": speed, "rate": rate, **more}
        )

    def moves(self, fluid: dict[str, Any], r: Any) -> tuple[Any, Any, float, float]:
        """Velocity and acceleration of a fluid at a place, and the heights between which it is there."""
        u, du = fluid["speed"](self.t, r), fluid["rate"](self.t, r)
        low, high = fluid["low"], fluid["high"]
        if fluid.get("waves") is not None:
            more, rate, rise = airy(fluid["waves"], self.t, r, high, G)
            u, du, high = u + more, du + rate, high + rise
        below = next((f for f in self.fluids if f.get("waves") is not None and f["high"] == low), None)
        if below is not None:
            low += airy(below["waves"], self.t, r, low, G)[2]
        if fluid.get("gusts") is not None:
            more, rate = gust(fluid["gusts"], self.t, r)
            u, du = u + more, du + rate
        return u, du, low, high

    def around(self, name: str) -> list[dict[str, Any]]:
        """The fluids that act on a body."""
        return [fluid for fluid in self.fluids if name in fluid.get("on", [name])]

    def forces(self, system: System, q: Any, v: Any, a: Any) -> Any:
        """Generalised forces of all fluids."""
        out = np.zeros(system.size)
        for beam in self.model.beams.values():
            for x0, x1 in zip(beam.node_x[:-1], beam.node_x[1:], strict=True):
                begin, h = x0, x1 - x0
                for xi, w in zip(PLACES, 0.5 * h * WEIGHTS, strict=True):
                    x = x0 + 0.5 * h * (1.0 + xi)
                    probe, ahead = system.probe(beam.at(x)), begin + 0.5 * w - x
                    begin += w
                    f = w * self._on_piece(beam, probe, ahead, w, q, v, a)
                    for slot, factor in zip(probe.slots, probe.S[0], strict=True):
                        out[slot : slot + 3] += factor * f
        for name in ("mass", "body"):
            body = self.model.bodies[name]
            slot = system.probe(body.point if name == "mass" else body.centre).slots[0]
            r, rv, ra = (x[slot : slot + 3] for x in (q, v, a))
            for fluid in self.around(name):
                u, du, low, high = self.moves(fluid, r)
                share = inside(r[2], (6.0 * body.volume / np.pi) ** (1 / 3), low, high)
                share = 1.0 if math.isinf(low) and math.isinf(high) else share
                out[slot : slot + 3] += share * on_body(body, fluid["density"], self.g, u - rv, du, ra)
        return out

    def _on_piece(self, beam: Any, probe: Any, ahead: float, length: float, q: Any, v: Any, a: Any) -> Any:
        """Per reference length of a piece whose middle is so far ahead of the point that stands for it."""
        r, slope, f = probe.field(q), probe.field(q, 1), np.zeros(3)
        stretch = np.linalg.norm(slope)
        t = slope / stretch
        tall = stretch * length * abs(t[2]) + beam.section.diameter * np.sqrt(1.0 - t[2] ** 2)
        for fluid in self.around(beam.name):
            u, du, low, high = self.moves(fluid, r)
            whole = math.isinf(low) and math.isinf(high)
            share = 1.0 if whole else inside(r[2] + ahead * slope[2], tall, low, high)
            past, own = u - probe.field(v), probe.field(a)
            f = f + share * morison(beam.section, fluid["density"], self.g, t, past, du, own)
        return f


@pytest.mark.parametrize("wavy", [False, True])
@pytest.mark.parametrize("seed", range(12))
def test_forces(seed, wavy):
    """Bent, stretched, moving and accelerated; masses come out of the water as balls of their volume."""
    sea = Sea(seed, wavy)
    system = System(sea.model)
    q, _ = system.initial_state(sea.t)
    q, v, a = np.array([[0.1], [1.0], [5.0]]) * sea.rng.standard_normal((3, len(q))) + [q, 0 * q, 0 * q]
    system.place(sea.t, q.copy(), 0 * q, 0 * q)
    r = np.zeros(system.size)
    residual(Batches((system.parts["fluid"],)), system.core.ws, q, v, a, 0 * q, r)
    wanted = sea.forces(system, q, v, a)
    assert np.abs(wanted).max() > 1.0
    assert np.abs(-r - wanted).max() < 1e-6 * np.abs(wanted).max()
