"""The ropes on surfaces that are validated: models, what is read off them, and the closed forms."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ..analysis import equilibrium, simulate
from ..arrays import FloatArray
from ..model.bodies.beam import Beam
from ..model.integrators import Trapezoidal
from ..model.model import Model
from ..model.sections.section import Section
from ..model.surfaces.shapes import Cylinder, Sheave

GRAVITY = 9.81
#: Radius of the drums and of the rope's axis on them, diameter of the rope, m.
RADIUS, DIAMETER = 0.2, 0.02
AXIS = RADIUS + 0.5 * DIAMETER
TAIL, TAIL_ELEMENTS, PER_TURN = 0.1, 2, 64


def wound(angle: float, pitch: float, EA: float) -> tuple[Model, Beam, FloatArray, float]:
    """A rope wound about the y axis by an angle, with straight tails.

    Returns
    -------
    tuple
        Model, rope, the unit tangent of its end, and the angle by which its tangent turns, rad: that of
        a helix is less than `angle`.
    """
    p = pitch / (2.0 * math.pi)
    ds, n = math.hypot(AXIS, p), max(8, round(PER_TURN * angle / (2.0 * math.pi)))

    def point(a: Any) -> FloatArray:
        return np.stack([AXIS * np.cos(a), p * np.asarray(a), AXIS * np.sin(a)], axis=-1)

    def tangent(a: float) -> FloatArray:
        return np.array([-AXIS * math.sin(a), p, AXIS * math.cos(a)]) / ds

    way = np.linspace(0.0, TAIL, 12)[1:, None]
    path = [
        point(0.0) - way[::-1] * tangent(0.0),
        point(np.linspace(0.0, angle, 20 * n)),
        point(angle) + way * tangent(angle),
    ]
    tail = np.linspace(0.0, TAIL, TAIL_ELEMENTS + 1)
    on = TAIL + np.linspace(0.0, angle * ds, n + 1)
    nodes = np.unique(np.concatenate([tail, on, TAIL + angle * ds + tail]).round(12))
    model = Model()
    section = Section(EA=EA, EI=1e-3, rhoA=0.3, diameter=DIAMETER)
    rope = model.add_beam("rope", path=np.concatenate(path), nodes=nodes, length=nodes[-1], section=section)
    return model, rope, tangent(angle), AXIS * angle / ds


def capstan(friction: float, turns: float, load: float = 1000.0) -> tuple[float, float]:
    """Ratio of the forces at the ends of a rope that is about to slip, and exp(mu phi)."""
    pitch = 0.05 if turns > 1.0 else 0.0
    model, rope, way, phi = wound(2.0 * math.pi * turns, pitch, 1e5 if turns > 1.0 else 1e6)
    drum = model.add_surface("drum", Cylinder(radius=RADIUS, axis=(0, 1, 0)))
    model.add_contact(rope, drum, stiffness=1e8, friction=friction)
    held = model.pin(rope.start)
    model.add_force(rope.end, load * way)
    ratio = load / float(np.linalg.norm(equilibrium(model).reaction(held)))
    return ratio, math.exp(friction * phi)


def line_load(load: float) -> tuple[float, float]:
    """Mean force per length of a rope on half a drum without friction, away from its ends, and T/R, N/m.

    Per length without load, at the radius of the axis where it presses.
    """
    EA, k = 1e6, 1e8
    model, rope, way, _ = wound(math.pi, 0.0, EA)
    drum = model.add_surface("drum", Cylinder(radius=RADIUS, axis=(0, 1, 0)))
    contact = model.add_contact(rope, drum, stiffness=k)
    model.pin(rope.start)
    model.add_force(rope.end, load * way)
    line = equilibrium(model).contact_line(contact.name)
    middle = np.abs(line.x - 0.5 * rope.length) < 0.25 * math.pi * AXIS
    weight = 0.5 * np.polynomial.legendre.leggauss(5)[1]
    force = (line.normal[middle].reshape(-1, 5) @ weight).mean()
    return float(force), load * (1.0 + load / EA) / (AXIS - load / (AXIS * k))


def hung_over(low: float, drop: float = 0.5, mass: float = 2.0) -> tuple[float, float]:
    """Difference of the forces at the ends of a heavy rope over a smooth drum, and w (z_b - z_a), N."""
    arc = np.linspace(0.0, math.pi, 60)
    over = np.stack([AXIS * np.cos(arc), 0.0 * arc, AXIS * np.sin(arc)], axis=1)
    left, right = (
        np.stack([np.full(20, side * AXIS), np.zeros(20), np.linspace(0.0, -depth, 21)[1:]], axis=1)
        for side, depth in ((1.0, drop), (-1.0, low))
    )
    model = Model(gravity=(0, 0, -GRAVITY))
    section = Section(EA=1e6, EI=1e-3, rhoA=mass, diameter=DIAMETER)
    path = np.concatenate([left[::-1], over, right])
    rope = model.add_beam("rope", path=path, elements=60, section=section)
    drum = model.add_surface("drum", Cylinder(radius=RADIUS, axis=(0, 1, 0)))
    model.add_contact(rope, drum, stiffness=1e7)
    pulled = 2e-4
    ends = model.pin(rope.start, displacement=(0, 0, -pulled)), model.pin(rope.end)
    state = equilibrium(model)
    forces = [float(np.linalg.norm(state.reaction(end))) for end in ends]
    return forces[1] - forces[0], mass * GRAVITY * (drop + pulled - low)


def thrown(friction: float, step: float = 2e-6, time: float = 0.03) -> dict[str, float]:
    """One cable thrown over another one, which nothing holds.

    Returns
    -------
    dict
        Largest changes of ``momentum`` and ``angular`` momentum over their sizes, largest ``drift`` of the
        energy over the kinetic energy at the start, and ``lost``, the share of that which friction took.
    """
    section = Section(EA=1e4, EI=0.05, rhoA=0.3, diameter=DIAMETER)
    model, way = Model(), 0.5 * np.array([math.cos(1.2), math.sin(1.2), 0.0])
    start = np.array([-0.47, 0.02, DIAMETER + 0.002])
    one = model.add_beam(
        "one", start=start, end=start + np.array([1.0, 0.0, 0.0]), elements=3, section=section
    )
    two = model.add_beam("two", start=-way, end=way, elements=4, section=section)
    one.set_motion(velocity=(0.3, 0.1, -0.5))
    model.add_contact(one, two, stiffness=1e5, damping=20.0 if friction else 0.0, friction=friction)
    run = simulate(model, t_end=time, step=step, output_step=1e-3, integrator=Trapezoidal())
    p, L, kinetic = run.momentum, run.angular_momentum(), float(run.energy.kinetic[0])
    return {
        "momentum": float(np.abs(p - p[0]).max() / np.abs(p[0]).max()),
        "angular": float(np.abs(L - L[0]).max() / np.abs(L).max()),
        "drift": float(np.abs(run.energy.drift).max()) / kinetic,
        "lost": float(run.energy.dissipated[-1]) / kinetic,
    }


def pulley(inertia: float, step: float = 5e-4) -> dict[str, float]:
    """Two equal masses on a rope over a pulley that friction turns, pushed for a while.

    Returns
    -------
    dict
        ``speed`` at the end over that of a rope that neither stretches nor slips, and ``drift`` of the
        energy over the work of the push.
    """
    mass, drop, rope_mass, push, time = 2.5, 0.5, 0.05, 4.0, 0.4
    arc = np.linspace(0.0, math.pi, 60)
    over = np.stack([AXIS * np.cos(arc), 0.0 * arc, AXIS * np.sin(arc)], axis=1)
    sides = [
        np.stack([np.full(20, side * AXIS), np.zeros(20), np.linspace(0.0, -drop, 21)[1:]], axis=1)
        for side in (1.0, -1.0)
    ]
    length = math.pi * AXIS
    down, on = np.linspace(0.0, drop, 15), drop + np.linspace(0.0, length, 13)
    nodes = np.unique(np.concatenate([down, on, drop + length + down]).round(12)) * (1.0 - 1e-6)
    model = Model(gravity=(0, 0, -GRAVITY))
    section = Section(EA=1e5, EI=1e-5, rhoA=rope_mass, diameter=DIAMETER, axial_damping=20.0)
    path = np.concatenate([sides[0][::-1], over, sides[1]])
    rope = model.add_beam("rope", path=path, nodes=nodes, length=nodes[-1], section=section)
    for name, end, x in (("A", rope.start, AXIS), ("B", rope.end, -AXIS)):
        model.connect(model.add_point_mass(name, at=(x, 0, -drop), mass=mass), end)
    hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=2.0, inertia=(0.6 * inertia, inertia, 0.6 * inertia))
    model.hinge(hub, (0, 0, 0), axis=(0, 1, 0))
    drum = model.add_surface("drum", Cylinder(radius=RADIUS, axis=(0, 1, 0)), on=hub)
    model.add_contact(rope, drum, stiffness=1e6, damping=300.0, friction=0.5)
    model.add_force("A", (0, 0, f"-{push}*sin(pi*t/{time})**2"))
    start = equilibrium(model, of=["rope", "A", "B"])
    run = simulate(model, t_end=time, step=step, output_step=0.1, start=start)
    carried = 2.0 * mass + inertia / AXIS**2 + rope_mass * rope.length
    speed = 0.5 * (run.velocity("B") - run.velocity("A"))[-1, 2]
    work = float(np.ptp(run.energy.supplied))
    return {
        "speed": float(speed) / (0.5 * push * time / carried),
        "drift": float(np.abs(run.energy.drift).max()) / work,
    }


def hoist(step: float = 1e-3, time: float = 1.0) -> float:
    """Largest error of the account of energies over the work of the motor.

    A motor turns a drum on which friction winds a rope that goes over a sheave and lifts 20 kg.
    """
    turn, sheave = 0.15 + 0.008, 1.0
    model = Model(gravity=(0, 0, -GRAVITY))
    section = Section(EA=2e5, EI=0.01, rhoA=0.2, diameter=0.016, axial_damping=200.0, bending_damping=0.002)
    angle = np.linspace(0.0, 4.5 * math.pi, 55)  # from the clip around the drum to its top
    on = np.stack(
        [sheave + turn * np.cos(angle), 0.0375 * (1.0 - angle / angle[-1]), turn * np.sin(angle)], axis=1
    )
    over = np.linspace(0.5 * math.pi, math.pi, 13)
    path = [
        on,
        np.stack([np.linspace(sheave, 0.0, 21)[1:-1], np.zeros(19), np.full(19, turn)], axis=1),
        np.stack([turn * np.cos(over), 0.0 * over, turn * np.sin(over)], axis=1),
        np.stack([np.full(16, -turn), np.zeros(16), np.linspace(0.0, -0.8, 17)[1:]], axis=1),
    ]
    rope = model.add_beam(
        "rope", path=np.concatenate(path), elements=110, section=section, natural_shape="straight"
    )
    drum = model.add_rigid_body("drum", at=(sheave, 0, 0), mass=20.0, inertia=(0.15, 0.2, 0.15))
    wheel = model.add_rigid_body("sheave", at=(0, 0, 0), mass=4.0, inertia=(0.03, 0.05, 0.03))
    barrel = model.add_surface("barrel", Cylinder(radius=0.15, axis=(0, 1, 0)), on=drum)
    groove = model.add_surface("groove", Sheave(0.15, groove=0.0085, depth=0.025, axis=(0, 1, 0)), on=wheel)
    for body, x in ((drum, sheave), (wheel, 0.0)):
        model.hinge(body, (x, 0, 0), axis=(0, 1, 0))
    for surface in (barrel, groove):
        model.add_contact(rope, surface, stiffness=5e6, damping=2000.0, friction=0.2)
    clip = drum.at(turn, 0.0375, -0.04)
    model.add_spring(rope.start, clip, stiffness=1e5, damping=100.0)
    model.connect(model.add_point_mass("load", at=(-turn, 0, -0.8), mass=20.0), rope.end)
    model.add_moment(drum, (0, "31.4 + 2.4*sin(pi*t)", 0))
    start = equilibrium(model, of=["rope", "load"])
    run = simulate(model, t_end=time, step=step, output_step=0.05, start=start)
    return float(np.abs(run.energy.drift).max() / np.ptp(run.energy.supplied))
