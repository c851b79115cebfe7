"""A model with every kind of joint, for the tests of kernels and of the linear algebra."""

import numpy as np

import ancf
from ancf.connections.joint import JointBatch
from ancf.connections.sliding import SlidingBatch
from ancf.system.system import System
from helpers import SOFT

#: Weights of C, dC/dt and d2C/dt2 in the rows of the joints.
LEVELS = {"position": (1.0, 0.0, 0.0), "velocity": (0.0, 1.0, 0.0), "acceleration": (0.0, 0.0, 1.0)}


def mechanism(stretch="fixed", **sliding):
    """Cable - rigid hub - rigid arm in a loop, a mass that slides on the cable, one on the arm."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(**SOFT)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=3, section=section)
    stay = model.add_beam("stay", start=(2, 0, 0), end=(2, 1, 0.5), elements=2, section=section)
    hub = model.add_rigid_body("hub", at=(2.2, 0, 0), mass=1.5, inertia=(0.3, 0.4, 0.5))
    arm = model.add_rigid_body("arm", at=(2.7, 0, 0), mass=0.8, inertia=(0.0, 0.2, 0.2))
    model.pin(wire.start)
    model.clamp(stay.end, stretch=stretch)
    model.clamp(wire.end, to=hub, name="clamp")
    model.connect(stay.start, hub.at(-0.2, 0, 0), name="ball")
    model.hinge(hub.at(0.3, 0, 0), arm.at(-0.2, 0, 0), axis=(0, 1, 1), name="hinge")
    tip = model.add_point_mass("tip", at=wire.initial_position(0.5), mass=0.3)
    given = {"mass": 0.2, "viscous": 0.3} | sliding
    model.slide(tip, along=wire, s=0.5, name="on wire", **given)
    bob = model.add_point_mass("bob", at=(2.9, 0, 0), mass=0.4)
    model.slide(bob, along=arm, line=((-0.1, 0, 0), (0.6, 0, 0)), name="on arm")
    model.connect(wire.at(1.2), model.add_point_mass("load", at=(1.2, 0, 0), mass=0.5), name="hook")
    return System(model)


def joints_of(system):
    """The batch of rows and that of the sliding joints."""
    kinds = (JointBatch, SlidingBatch)
    return [next(b for b in system.core.joints.batches if isinstance(b, kind)) for kind in kinds]


def bare(system):
    """Without the part of the forces that vanishes from the solution (augmented Lagrangian)."""
    rows, _ = joints_of(system)
    rows.scale[:] = 0.0
    rows.alpha[:] = 0.0
    return system


def at_level(system, name):
    system.level[:] = LEVELS[name]
    return system


def moving(system, seed=4):
    """A state somewhere near the initial shape, its velocities and accelerations."""
    rng = np.random.default_rng(seed)
    q, _ = system.initial_state()
    used = np.flatnonzero(system.numbering.used())
    v, a = np.zeros(system.size), np.zeros(system.size)
    q[used] += 0.05 * rng.uniform(-1, 1, len(used))
    q[system.multipliers] = rng.uniform(-1, 1, len(system.multipliers))
    v[used], a[used] = rng.uniform(-1, 1, (2, len(used)))
    v[system.multipliers] = a[system.multipliers] = 0.0
    return q, v, a
