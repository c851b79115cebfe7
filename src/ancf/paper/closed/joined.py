"""Welds, guides, joints, torsion springs and closed loops with a closed form."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

import ancf

from .case import EI, LENGTH, RHO_A, Case, cable

if TYPE_CHECKING:
    from ... import Model, RigidBody

G = 9.81  # m/s^2
FORCE = 1e-4  # N: so small that beams bend as in the textbook
BALL = (0.1, 0.1, 0.1)  # kg m^2


def statics() -> list[Case]:
    """Of cables alone."""
    return [_frame(), _guided(), _rayleigh(), _elastic_clamp()]


def motions() -> list[Case]:
    """Of rigid bodies on joints."""
    return [_universal(), *_cylindrical(), _prismatic(), _planar(), _torsion_spring(), *_parallelogram()]


def _frame() -> Case:
    """A column and a girder at a right angle, welded, with a force down at the tip."""
    model, column = cable(8, end=(0.0, 0.0, LENGTH))
    corner, tip = (0.0, 0.0, LENGTH), (LENGTH, 0.0, LENGTH)
    girder = model.add_beam("girder", start=corner, end=tip, elements=8, section=column.section)
    model.clamp(column.start)
    model.weld(column.end, girder.start)
    model.add_force(girder.end, (0.0, 0.0, -FORCE))
    drop = LENGTH - float(ancf.equilibrium(model).position(girder.end)[2])
    wanted = FORCE * (LENGTH**3 / (3.0 * EI) + LENGTH**3 / EI + LENGTH / column.section.EA)
    return Case("weld, frame of two beams: drop of the tip", "cable", drop, wanted, 1e-4, "m",
                "F l^3/(3 EI) + F l^2 h/EI + F h/EA")  # fmt: skip


def _guided() -> Case:
    model, beam = cable(8)
    model.clamp(beam.start)
    model.guide(beam.end, axis=(0.0, 0.0, 1.0))
    model.add_force(beam.end, (0.0, 0.0, FORCE))
    value = float(ancf.equilibrium(model).position(beam.end)[2])
    wanted = FORCE * LENGTH**3 / (12.0 * EI)
    return Case("guided end: deflection", "cable", value, wanted, 1e-5, "m", "F L^3/(12 EI)")


def _rayleigh() -> Case:
    """With a rotary inertia 40 times that of a wire so stiff."""
    inertia = 0.05
    model = ancf.Model()
    section = ancf.Section(EA=1e5, EI=EI, rhoA=RHO_A, rotary_inertia=inertia)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(LENGTH, 0, 0), elements=16, section=section)
    model.pin(beam.start)
    model.pin(beam.end)
    value = float(ancf.modes(model, count=4).frequencies[2])  # each twice, in y and in z
    k = 2.0 * math.pi / LENGTH
    wanted = k**2 * math.sqrt(EI / (RHO_A + inertia * k**2))
    return Case("rotary inertia, beam on two pins: frequency 2", "cable", value, wanted, 1e-4, "rad/s",
                "Rayleigh, k^2 sqrt(EI/(rhoA + rhoI k^2))")  # fmt: skip


def _elastic_clamp() -> Case:
    stiffness = 4.0
    model, beam = cable(8)
    model.pin(beam.start)
    model.hold(beam.start, slope="y")
    model.add_torsion_spring(beam.start, (0, 0, 0), axis=(0, 1, 0), stiffness=stiffness)
    model.add_force(beam.end, (0.0, 0.0, FORCE))
    value = float(ancf.equilibrium(model).position(beam.end)[2])
    wanted = FORCE * (LENGTH**3 / (3.0 * EI) + LENGTH**2 / stiffness)
    return Case("torsion spring, elastic clamp: deflection", "cable", value, wanted, 1e-5, "m",
                "F L^3/(3 EI) + F L^2/k")  # fmt: skip


def _body(gravity: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> tuple[Model, RigidBody]:
    model = ancf.Model(gravity=gravity)
    return model, model.add_rigid_body("body", at=(0.3, 0.0, 0.0), mass=2.0, inertia=(0.2, 0.3, 0.4))


def _universal() -> Case:
    """The driven shaft lags or leads: its angle after the driving one has turned by 0.6 rad."""
    bend, turned = 0.9, 0.6
    along = np.array([math.cos(bend), math.sin(bend), 0.0])
    axes = np.column_stack([along, (0.0, 0.0, 1.0), np.cross(along, (0.0, 0.0, 1.0))])
    model = ancf.Model()
    driving = model.add_rigid_body("driving", at=(0, 0, 0), mass=1.0, inertia=BALL)
    driven = model.add_rigid_body("driven", at=along, mass=1.0, inertia=BALL, axes=axes)
    model.clamp(driving, rotation=f"{turned}*t", axis=(1, 0, 0))
    model.universal(driving, driven.at(-1, 0, 0), axis_a=(0, 0, 1), axis_b=axes[:, 2])
    model.cylindrical(driven, 2.0 * along, axis=along)
    driven.set_motion(angular_velocity=turned * math.cos(bend) * along)
    result = ancf.simulate(model, t_end=1.0, step=1e-3)
    arm = (result.position(driven.at(0, 0, 1)) - result.position(driven))[-1]
    value = math.atan2(-float(arm @ axes[:, 1]), float(arm @ axes[:, 2]))
    wanted = math.atan(math.tan(turned) * math.cos(bend))
    return Case("universal joint: angle of the driven shaft", "none", value, wanted, 1e-5, "rad",
                "Hooke's joint, tan a = tan b cos(bend)")  # fmt: skip


def _cylindrical() -> list[Case]:
    slope, spin = 0.5, 3.0
    model, body = _body((G * math.sin(slope), 0.0, -G * math.cos(slope)))
    body.set_motion(angular_velocity=(spin, 0.0, 0.0))
    model.cylindrical(body, (1.0, 0.0, 0.0), axis=(1.0, 0.0, 0.0))
    result = ancf.simulate(model, t_end=0.5, step=1e-3)
    way = float(result.position(body)[-1, 0]) - 0.3
    turned = float(result.angular_velocity(body)[-1, 0])
    wanted = 0.5 * G * math.sin(slope) * 0.25
    return [
        Case("cylindrical joint: way down a rod", "none", way, wanted, 1e-8, "m", "g sin(slope) t^2/2"),
        Case("cylindrical joint: spin about the rod", "none", turned, spin, 1e-5, "rad/s", "as at the start"),
    ]


def _prismatic() -> Case:
    """A slider on an arm that turns."""
    rate, at, t = 4.0, 0.1, 0.6
    model = ancf.Model()
    arm = model.add_rigid_body("arm", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
    slider = model.add_rigid_body("slider", at=(at, 0, 0), mass=0.5, inertia=(0.01, 0.01, 0.01))
    slider.set_motion(angular_velocity=(0, 0, rate), about=(0, 0, 0))
    model.clamp(arm, rotation=f"{rate}*t")
    model.prismatic(arm, slider, axis=(1, 0, 0))
    value = float(np.linalg.norm(ancf.simulate(model, t_end=t, step=1e-3).position(slider)[-1]))
    wanted = at * math.cosh(rate * t)
    return Case("prismatic joint: slider on a turning arm", "none", value, wanted, 2e-5, "m", "r cosh(w t)")


def _planar() -> Case:
    """Thrown across a slope."""
    model, body = _body((2.0, -1.0, -G))
    body.set_motion(velocity=(0.5, 1.5, 0.0), angular_velocity=(0.0, 0.0, -2.0))
    model.planar(body, (0.9, -0.4, 0.0), axis=(0.0, 0.0, 1.0))
    x, y, _ = ancf.simulate(model, t_end=0.5, step=1e-3).position(body)[-1].tolist()
    wanted = math.hypot(0.5 * 0.5 + 0.25, 1.5 * 0.5 - 0.125)
    value = math.hypot(x - 0.3, y)
    return Case("planar joint: way on a slope", "none", value, wanted, 1e-8, "m", "parabola v t + g t^2/2")


def _torsion_spring() -> Case:
    """A wheel that swings by more than two turns."""
    stiffness, inertia, spin = 2.0, 0.3, 40.0
    model = ancf.Model()
    wheel = model.add_rigid_body("wheel", at=(0, 0, 0), mass=1.0, inertia=(0.2, 0.2, inertia))
    model.hinge(wheel, (0, 0, 0), axis=(0, 0, 1))
    spring = model.add_torsion_spring(wheel, (0, 0, 0), axis=(0, 0, 1), stiffness=stiffness)
    wheel.set_motion(angular_velocity=(0, 0, spin))
    rate = math.sqrt(stiffness / inertia)
    result = ancf.simulate(model, t_end=0.5 * math.pi / rate, step=5e-4, sensors=[spring])
    value = float(result.sensors.torsion_angle(spring)[-1])
    return Case(
        "torsion spring, wheel: largest angle", "none", value, spin / rate, 2e-4, "rad", "w sqrt(I/k)"
    )


def _parallelogram() -> list[Case]:
    """Two hanging cranks and a coupler, four hinges: three of their rows are held twice."""
    length, crank, coupler, pull = 0.5, 1.0, 2.0, 8.0
    model = ancf.Model(gravity=(0.0, 0.0, -G))
    thin, half = (crank * length**2 / 12,) * 3, np.array([0.0, 0.0, 0.5 * length])
    bodies = [
        model.add_rigid_body(name, at=(x, 0, -0.5 * length), mass=crank, inertia=thin)
        for name, x in (("left", 0.0), ("right", 0.8))
    ]
    bar = model.add_rigid_body("coupler", at=(0.4, 0, -length), mass=coupler, inertia=BALL)
    for body, x in zip(bodies, (0.0, 0.8), strict=True):
        model.hinge(body.at(*half), (x, 0.0, 0.0), axis=(0, 1, 0))
        model.hinge(body.at(*-half), bar.at(x - 0.4, 0.0, 0.0), axis=(0, 1, 0))
    model.add_force(bar, (pull, 0.0, 0.0))
    state = ancf.equilibrium(model)
    weight = (crank + coupler) * G
    rate = math.sqrt(math.hypot(pull, weight) / ((2.0 * crank / 3.0 + coupler) * length))
    return [
        Case("loop with redundant joints: pulled aside", "none", float(state.position(bar)[0]) - 0.4,
             length * math.sin(math.atan2(pull, weight)), 1e-8, "m", "tan(angle) = F/weight"),
        Case("loop with redundant joints: frequency", "none",
             float(ancf.modes(model, about=state, count=1).frequencies[0]), rate, 1e-7, "rad/s",
             "pendulum of the parallelogram"),
    ]  # fmt: skip
