"""Balls and cylinders that slide until they roll, down planes and on a table that turns."""

import numpy as np
import pytest

import ancf
from contact_laws import unit

METHODS = {
    "trapezoidal": {"step": 4e-4},
    "alpha": {"step": 4e-4, "integrator": ancf.GeneralizedAlpha(rho_inf=0.8)},
    "radau": {"step": 1e-3, "integrator": ancf.Radau(tolerance=1e-7)},
}
SHAPES = ["ball", "cylinder"]


class Roller:
    """A ball, or a cylinder about the second axis, just pressed into a plane whose normal is the third."""

    def __init__(self, seed, shape, slope=0.0, on=None):
        self.rng = rng = np.random.default_rng(seed)
        self.axes = np.linalg.qr(rng.standard_normal((3, 3)))[0]
        self.axes *= np.linalg.det(self.axes)
        self.g, self.m, self.R, self.mu = (
            rng.uniform(*x) for x in ((5, 15), (0.3, 3), (0.05, 0.3), (0.1, 0.4))
        )
        x, y, z = self.axes.T
        self.J = rng.uniform(0.35, 0.6) * self.m * self.R**2
        k = 1e5 * self.m * self.g / self.R
        places = 1 if shape == "ball" else 2
        self.model = ancf.Model(gravity=tuple(self.g * (np.sin(slope) * x - np.cos(slope) * z)))
        self.foot = rng.standard_normal(3)
        sunk = self.m * self.g * np.cos(slope) / (k * places)
        inertia = self.J * np.eye(3)
        if shape != "ball":
            inertia += 0.3 * self.J * (np.eye(3) - np.outer(y, y))
        at = self.foot + (self.R - sunk) * z
        self.body = self.model.add_rigid_body("roller", at=at, mass=self.m, inertia=inertia)
        skin = {
            "ball": lambda: ancf.Sphere(self.R),
            "cylinder": lambda: ancf.Capsule(radius=self.R, length=1.2 * self.R, axis=tuple(y)),
        }[shape]()
        one = self.model.add_surface("skin", skin, on=self.body)
        plane = ancf.Plane(tuple(self.foot), tuple(z))
        if on is not None:
            table = self.model.add_rigid_body("table", at=self.foot, mass=1.0, inertia=np.eye(3))
            self.model.clamp(table, rotation=lambda t: on * t, axis=tuple(z))
            table.set_motion(angular_velocity=tuple(on * z))
            plane = ancf.Plane((0, 0, 0), tuple(z))
        floor = self.model.add_surface("floor", plane, on=None if on is None else table)
        law = {
            "stiffness": k,
            "damping": 0.3 * np.sqrt(k * self.m),
            "friction": self.mu if on is None else 0.9,
        }
        self.model.add_contact(one, floor, **law)

    def starts(self, velocity, spin):
        self.body.set_motion(velocity=tuple(velocity), angular_velocity=tuple(spin))


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("seed", range(3))
def test_slides_until_it_rolls(seed, shape, method):
    """Its slip u falls evenly, by mu g (1 + m R^2/J); it rolls with v - u/(1 + m R^2/J)."""
    one = Roller(seed, shape)
    x, y, z = one.axes.T
    v = one.rng.uniform(0.5, 2) * x
    w = 0.5 * v @ x / one.R * (one.rng.standard_normal(3) if shape == "ball" else one.rng.uniform(-1, 1) * y)
    one.starts(v, w)
    u = v + np.cross(w, -one.R * z)
    u -= (u @ z) * z
    share = 1.0 + one.m * one.R**2 / one.J
    stops = np.linalg.norm(u) / (one.mu * one.g * share)
    run = ancf.simulate(one.model, t_end=1.2 * stops, **METHODS[method])
    rolls = v - u / share
    spun = w + one.m / one.J * np.cross(-one.R * z, rolls - v)
    size = np.linalg.norm(u)
    slides = run.t < 0.9 * stops
    slowed = v - one.mu * one.g * run.t[slides, None] * unit(u)
    assert np.max(np.abs(run.velocity(one.body)[slides] - slowed)) < 3e-4 * size
    assert np.max(np.abs(run.velocity(one.body)[-1] - rolls)) < 5e-4 * size
    assert np.max(np.abs(run.angular_velocity(one.body)[-1] - spun)) * one.R < 2e-3 * size


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize(("seed", "slope"), [(0, 0.1), (1, 0.4), (2, 0.7), (3, 1.0)])
def test_down_a_slope(seed, slope, shape, method):
    """It rolls with g sin(a)/(1 + J/(m R^2)), or slips where that takes more friction than there is."""
    one = Roller(seed, shape, slope)
    run = ancf.simulate(one.model, t_end=0.4, **METHODS[method])
    pull, held = one.g * np.sin(slope), one.mu * one.g * np.cos(slope)
    rolls = pull / (1.0 + one.J / (one.m * one.R**2))
    slips = pull - rolls > held
    a, turns = (pull - held, held * one.m * one.R / one.J) if slips else (rolls, rolls / one.R)
    found = run.velocity(one.body), run.angular_velocity(one.body)
    for values, rate, axis in zip(found, (a, turns), one.axes.T[:2], strict=True):
        assert np.max(np.abs(values - rate * run.t[:, None] * axis)) < 1e-3 * rate * 0.4


@pytest.mark.parametrize("seed", range(4))
def test_on_a_table_that_turns(seed):
    """Its velocity turns with W/(1 + m R^2/J), wherever it is, to the first order in the step."""
    off = []
    for step in (1e-3, 2.5e-4):
        W = 2.0
        one = Roller(seed, "ball", on=W)
        x, y, z = one.axes.T
        v = 0.5 * (one.rng.standard_normal() * x + one.rng.standard_normal() * y)
        one.starts(v, np.cross(z, v) / one.R)
        run = ancf.simulate(one.model, t_end=0.5, step=step)
        angle = W / (1.0 + one.m * one.R**2 / one.J) * run.t[:, None]
        wanted = np.cos(angle) * v + np.sin(angle) * np.cross(z, v)
        off.append(np.max(np.abs(run.velocity(one.body) - wanted)) / np.linalg.norm(v))
    assert off[0] < 3e-3
    assert off[1] < 0.25 * off[0] + 2e-4
