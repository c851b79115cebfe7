"""Forces of sliding joints in a stream: momenta of what slides and of the wire, each by itself."""

import numpy as np
import pytest

import ancf
from contact_laws import points_of, unit
from fluid_laws import morison, on_body

EXACT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-13))
T_END, STEP = 0.03, 5e-4
MASS, WET = 1.0, {"volume": 2e-3, "drag_area": 0.05, "added_mass": 0.5}


class Ring:
    """A wire of a seed with an end that moves, in a stream; a ring, a mass or a body slides on it."""

    def __init__(self, seed):
        rng = np.random.default_rng(seed)
        self.g, self.flow, self.density = (
            4 * rng.standard_normal(3),
            rng.standard_normal(3),
            rng.uniform(50, 300),
        )
        self.model = ancf.Model(gravity=tuple(self.g))
        element, d = str(rng.choice(["cable", "nonlocking", "original"])), rng.uniform(0.03, 0.08)
        wet = {"drag": tuple(rng.uniform(0.1, 2, 2)), "added_mass": tuple(rng.uniform(0, 1.2, 2))}
        if element == "cable":
            soft = {"EA": rng.uniform(100, 500), "EI": rng.uniform(0.1, 2), "rhoA": rng.uniform(0.3, 2)}
            section = ancf.Section(**soft, diameter=d, **wet)
        else:
            section = ancf.Section.circle(
                d, E=rng.uniform(5e4, 1e5), rho=rng.uniform(100, 400), nu=0.3, **wet
            )
        start = 0.3 * rng.standard_normal(3)
        ends = {"start": start, "end": start + 1.2 * unit(rng.standard_normal(3))}
        self.wire = self.model.add_beam("wire", **ends, elements=3, section=section, element=element)
        way, often = 0.03 * rng.standard_normal(3), rng.uniform(3, 9)
        self.held = self.model.pin(
            self.wire.start, displacement=lambda t: tuple(way * (1 - np.cos(often * t)))
        )
        self.point, end = None, self.wire.at(0.6 * self.wire.length).initial_position
        slides = tuple(end)
        if seed % 3 == 1:
            body = self.model.add_point_mass("mass", at=end, mass=MASS, **WET)
            self.body, self.point, slides = body, body.point, body
        elif seed % 3 == 2:
            arm = 0.1 * rng.standard_normal(3)
            given = {"at": end - arm, "mass": MASS, "inertia": 0.05 * np.eye(3)}
            self.body = self.model.add_rigid_body("body", **given, **WET)
            self.point, slides = self.body.centre, self.body.at(*arm)
        self.model.slide(slides, along=self.wire, friction=float(rng.choice([0, 0.2])), name="ring")
        self.model.add_fluid("water", self.density, velocity=tuple(self.flow))

    def on_wire(self, run, point):
        """Force of the stream and weight per length at a point."""
        section, still = self.wire.section, np.zeros(3)
        parts = zip(run.slope(point), run.velocity(point), run.acceleration(point), strict=True)
        stream = [
            morison(section, self.density, self.g, unit(s), self.flow - v, still, a) for s, v, a in parts
        ]
        return np.array(stream) + section.rhoA * self.g

    def left(self, step):
        """Change of the momenta that no force explains, in the largest force times the time."""
        run = ancf.simulate(self.model, t_end=T_END, step=step, integrator=EXACT)
        joint, support = run.joint_force("ring"), run.reaction(self.held)
        size, points = np.max(np.abs(joint)) + np.max(np.abs(support)), list(points_of(self.wire, 5))
        force = joint + support + sum(w * self.on_wire(run, point) for point, w in points)
        momentum = self.wire.section.rhoA * sum(w * run.velocity(point) for point, w in points)
        found = [(force, momentum)]
        if self.point is not None:
            motion = zip(run.velocity(self.point), run.acceleration(self.point), strict=True)
            still = np.zeros(3)
            stream = [on_body(self.body, self.density, self.g, self.flow - v, still, a) for v, a in motion]
            found.append((np.array(stream) + MASS * self.g - joint, MASS * run.velocity(self.point)))
        given = [(step * np.cumsum(0.5 * (f[1:] + f[:-1]), axis=0), p[1:] - p[0]) for f, p in found]
        return np.array([np.max(np.abs(change - push)) for push, change in given]) / (size * T_END)


@pytest.mark.parametrize("seed", range(12))
def test_newton(seed):
    ring = Ring(seed)
    coarse, fine = ring.left(STEP), ring.left(STEP / 2)
    assert np.all(coarse < 1e-6)
    assert np.all((fine < 0.3 * coarse) | (fine < 5e-8))
