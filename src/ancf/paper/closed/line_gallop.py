"""A wire that gallops in wind, let go from a small swing, beside Den Hartog's growth rate."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from scipy.optimize import least_squares

import ancf

from ... import catenary
from ...arrays import FloatArray
from ..check import Check

LENGTH, ALPHA, STEEP = 40.0, 0.05, 0.4  # m, 1/s, rad
#: Until when the wire is pushed, s.
LET_GO = 0.4


def checks() -> list[Check]:
    """One that grows, and one whose lift damps it."""
    found = []
    for slope, wind in ((-6.0, 12.0), (2.0, 12.0)):
        line = string(slope, wind)
        (told,) = catenary.galloping(line)
        name = f"Overhead line, wire in wind of {wind:g} m/s, dCL/da + CD = {told.criterion:g}: growth"
        origin = "-(rho D U (dCL/da + CD)/2 m + alpha)/2, Den Hartog"
        found.append(Check(name, growth(line), told.growth, 0.02 * abs(told.growth), "1/s", origin))
    return found


def string(slope: float, wind: float) -> catenary.Line:
    """A contact wire alone between two ends, whose lift is straight over the angle of attack."""
    lift = ((-STEEP, -slope * STEEP), (STEEP, slope * STEEP))
    return catenary.Line(
        spans=(catenary.Span(length=LENGTH, droppers=()),),
        contact_wire=catenary.Wire(
            EA=12e6, EI=1.0, mass=0.95, tension=15e3, diameter=0.0122, drag=1.1, lift=lift
        ),
        steady_arm=catenary.SteadyArm(vertical=0.0),
        damping=catenary.Rayleigh(alpha=ALPHA),
        conditions=catenary.Conditions(wind=wind),
    )


def growth(line: catenary.Line) -> float:
    """Of the amplitude of its second mode, which the sag does not stretch, in the motion, 1/s."""
    model = catenary.assemble(catenary.form(line, catenary.Mesh(contact=2.0))).model
    wire, start = model.bodies["contact"], ancf.equilibrium(model)
    assert isinstance(wire, ancf.model.Beam)
    quarter = wire.at(0.25 * wire.length)
    model.add_force(quarter, _push(8.0))
    model.add_force(wire.at(0.75 * wire.length), _push(-8.0))
    sensors = ancf.simulate(
        model, t_end=12.0, step=5e-3, start=start, sensors=[quarter], energy=False
    ).sensors
    late = sensors.t > 1.5 * LET_GO
    t, z = sensors.t[late], sensors.position(quarter)[late, 2] - float(start.position(quarter)[2])

    def wrong(p: FloatArray) -> FloatArray:
        swing: FloatArray = np.exp(p[0] * t) * (p[1] * np.cos(p[2] * t) + p[3] * np.sin(p[2] * t)) + p[4] - z
        return swing / float(np.abs(z).max())

    w = 2.0 * np.pi * np.sqrt(line.contact_wire.tension / line.contact_wire.mass) / LENGTH
    return float(least_squares(wrong, [0.0, 0.5 * float(np.ptp(z)), w, 0.0, 0.0]).x[0])


def _push(size: float) -> Callable[[float], tuple[float, float, float]]:
    """Half a wave of force upwards, N."""
    return lambda t: (0.0, 0.0, size * np.sin(np.pi * t / LET_GO) if t < LET_GO else 0.0)
