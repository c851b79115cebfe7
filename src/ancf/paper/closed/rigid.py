"""Rigid bodies with a closed form: a swinging rod and a fast top."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

import ancf

from .case import Case

if TYPE_CHECKING:
    from ... import Model, RigidBody

G = 9.81  # m/s^2
LENGTH = 1.0  # m, of the rod; it has 1 kg
OWN, ABOUT_END = LENGTH**2 / 12.0, LENGTH**2 / 3.0  # kg m^2
STEP = 5e-4  # s


def cases() -> list[Case]:
    """All of them."""
    return [*_rod(), _sway(), _top()]


def _rod() -> list[Case]:
    """Let go level: when it hangs straight down, and what its hinge carries there."""
    model, rod = _hinged()
    result = ancf.simulate(model, t_end=0.6, step=STEP)
    x = result.position(rod)[:, 0]
    i = int(np.argmax(x < 0.0))
    t = float(result.t[i - 1] + STEP * x[i - 1] / (x[i - 1] - x[i]))
    from scipy.special import ellipk

    wanted = math.sqrt(ABOUT_END / (0.5 * G * LENGTH)) * float(ellipk(0.5))
    force = -float(result.multiplier("hinge")[:, 2].min())
    return [
        Case("rod let go level: time until it hangs", "none", t, wanted, 1e-5, "s",
             "physical pendulum, elliptic integral"),
        Case("rod let go level: largest force in the hinge", "none", force, 2.5 * G, 1e-5, "N", "5/2 m g"),
    ]  # fmt: skip


def _sway() -> Case:
    model, _ = _hinged()
    value = float(ancf.modes(model, about=ancf.equilibrium(model), count=1).frequencies[0])
    wanted, where = math.sqrt(1.5 * G / LENGTH), "sqrt(3 g/(2 L))"
    return Case("hanging rod: frequency", "none", value, wanted, 1e-8, "rad/s", where)


def _hinged() -> tuple[Model, RigidBody]:
    """A rod along x hinged at the origin about y, with a zero moment as the top has."""
    model = ancf.Model(gravity=(0.0, 0.0, -G))
    rod = model.add_rigid_body("rod", at=(0.5 * LENGTH, 0.0, 0.0), mass=1.0, inertia=(0.01, OWN, OWN))
    model.add_moment(rod, (0.0, 0.0, 0.0))
    model.hinge(rod.at(-0.5 * LENGTH, 0.0, 0.0), (0.0, 0.0, 0.0), axis=(0.0, 1.0, 0.0), name="hinge")
    return model, rod


def _top() -> Case:
    """A top with a level axis precesses at m g l/(I w) for ever, exactly at this rate of precession."""
    mass, arm, spin, inertia = 1.5, 0.4, 60.0, (0.02, 0.05, 0.05)
    model = ancf.Model(gravity=(0.0, 0.0, -G))
    top = model.add_rigid_body("top", at=(arm, 0.0, 0.0), mass=mass, inertia=inertia)
    model.add_moment(top, (0.0, 0.0, 0.0))
    model.connect(top.at(-arm, 0.0, 0.0), (0.0, 0.0, 0.0))
    wanted = mass * G * arm / (inertia[0] * spin)
    top.set_motion(angular_velocity=(spin, 0.0, wanted), about=(0.0, 0.0, 0.0))
    result = ancf.simulate(model, t_end=0.5, step=STEP)
    x, y, _ = result.position(top)[-1].tolist()
    rate = math.atan2(y, x) % (2.0 * math.pi) / 0.5
    return Case("fast top: precession", "none", rate, wanted, 2e-4, "rad/s", "m g l/(I w)")
