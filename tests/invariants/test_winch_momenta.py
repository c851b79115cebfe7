"""Momenta of cables whose length changes: what acts on them, and what material that enters brings along."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import ancf
from contact_laws import distance, normals, points_of, pressure, unit
from fluid_laws import morison

EXACT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-13))
FLOW, DENSITY, DRAG = np.array([0.8, -0.5, 0.4]), 80.0, 0.4


class Hoist:
    """A cable of a seed from a winch that moves to a pin, a load or nothing, over a ball or in water."""

    def __init__(self, seed: int) -> None:
        self.rng = rng = np.random.default_rng(seed)
        self.g, d = 4.0 * rng.standard_normal(3), rng.uniform(0.02, 0.06)
        given = {"drag": tuple(rng.uniform(0.2, 2, 2)), "axial_damping": float(rng.choice([0.0, 0.5]))}
        self.section = ancf.Section(
            EA=rng.uniform(100, 500),
            EI=rng.uniform(0.01, 0.3),
            rhoA=rng.uniform(0.3, 1.5),
            diameter=d,
            **given,
        )
        self.model = ancf.Model(gravity=tuple(self.g))
        start, t, self.L = 0.3 * rng.standard_normal(3), unit(rng.standard_normal(3)), rng.uniform(0.8, 2.0)
        ends = {"start": start, "end": start + self.L * t}
        self.cable = self.model.add_beam(
            "rope", **ends, elements=int(rng.integers(3, 7)), section=self.section
        )
        self.far = self.cable.length if rng.random() < 0.5 else 0.0
        self.drum, end = (self.cable.start, self.cable.end)[:: 1 if self.far else -1]
        way, speed = 0.05 * rng.standard_normal(3), rng.uniform(2, 6)
        self.held = [self.model.pin(self.drum, displacement=lambda t: tuple(way * (1 - np.cos(speed * t))))]
        kind = seed % 3
        if kind == 0:
            self.held.append(self.model.pin(end))
        elif kind == 1:
            load = self.model.add_point_mass("load", at=end.initial_position, mass=rng.uniform(0.3, 2))
            self.model.connect(end, load)
        self.size, self.often = rng.choice([-1, 1]) * rng.uniform(0.05, 0.25) * self.L, rng.uniform(3, 9)
        self.model.winch(self.drum, length=lambda t: self.L + self.size * (1 - np.cos(self.often * t)))
        self.contact, self.wet = None, seed % 2 == 0
        if self.wet:
            self.model.add_fluid("water", DENSITY, velocity=tuple(FLOW))
        else:
            n = unit(np.cross(t, rng.standard_normal(3)))
            at = start + rng.uniform(0.3, 0.7) * self.L * t - (0.5 * d - 0.002) * n
            ball = self.model.add_surface("ball", ancf.Sphere(0.3, at - 0.3 * n))
            law = {"stiffness": rng.uniform(1e3, 5e3), "damping": 20.0}
            self.contact = self.model.add_contact(self.cable, ball, **law)
        self.model.add_distributed_load(self.cable, [f"-{DRAG}*v{x}" for x in "xyz"])

    def balance(self, run: ancf.Result) -> tuple[Any, ...]:
        """Force and moment on the material that is out, its momenta, and the largest force."""
        L = (self.L + self.size * (1 - np.cos(self.often * run.t)))[:, None]
        dL = (self.size * self.often * np.sin(self.often * run.t))[:, None]
        force, moment, P, H = np.zeros((4, len(run.t), 3))
        for point, w in points_of(self.cable, 5):
            r, slope = run.position(point), run.slope(point)
            w, v = w * L / self.cable.length, self.material(run, point, L, dL)
            f = self.section.rhoA * self.g - DRAG * v + self.around(r, slope, v)
            force, moment = force + w * f, moment + w * np.cross(r, f)
            P, H = P + w * self.section.rhoA * v, H + w * self.section.rhoA * np.cross(r, v)
        entering = self.section.rhoA * dL * self.material(run, self.drum, L, dL)
        others = [(self.drum, entering), *((s.point, run.reaction(s)) for s in self.held)]
        for body in self.model.bodies.values():
            if body is not self.cable:
                others.append((body.point, body.mass * self.g))
                P = P + body.mass * run.velocity(body)
                H = H + body.mass * np.cross(run.position(body), run.velocity(body))
        for point, f in others:
            force, moment = force + f, moment + np.cross(run.position(point), f)
        return force, moment, P, H, max(float(np.max(np.abs(f))) for _, f in others)

    def material(self, run: ancf.Result, point: Any, L: Any, dL: Any) -> Any:
        """Velocity of the material that passes a place, which is at x - far on the mesh."""
        return run.velocity(point) - dL / self.cable.length * (point.x - self.far) * run.slope(point)

    def around(self, r: Any, slope: Any, v: Any) -> Any:
        """What the surroundings do per length of the material."""
        if self.wet:
            forces = [
                morison(self.section, DENSITY, self.g, unit(t), FLOW - u, np.zeros(3), np.zeros(3))
                for t, u in zip(slope, v, strict=True)
            ]
            return np.array(forces)
        shape, radius = self.contact.surface.shape, 0.5 * self.section.diameter
        n = normals(shape, r)
        N = pressure(self.contact, radius - distance(shape, r), -np.sum(v * n, axis=1), radius)
        return N[:, None] * n


@pytest.mark.parametrize("seed", range(12))
def test_newton_and_euler(seed):
    """With an error of order two in the step, and without that of the momenta that results tell."""
    left = []
    for step in (1e-3, 5e-4):
        hoist = Hoist(seed)
        run = ancf.simulate(hoist.model, t_end=0.03, step=step, integrator=EXACT)
        force, moment, P, H, size = hoist.balance(run)
        assert run.momentum == pytest.approx(P, abs=1e-10 * np.max(np.abs(P)))
        assert run.angular_momentum((0, 0, 0)) == pytest.approx(H, abs=1e-10 * np.max(np.abs(H)))
        for given, momentum in ((force, P), (moment, H)):
            change = np.diff(momentum, axis=0) / step - 0.5 * (given[1:] + given[:-1])
            left.append(float(np.max(np.abs(change))) / size)
    for first, second in zip(left[:2], left[2:], strict=True):
        assert first < 1e-3
        assert second < 0.3 * first or second < 1e-7
