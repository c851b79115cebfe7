"""Random models that touch each other, surfaces and grounds, in water and wind.

What contacts do is that of the theory page, written once more; momenta change by it; and nothing depends on
how a model is written down.
"""

from __future__ import annotations

import numpy as np
import pytest

import ancf
from ancf.model.surfaces.body_contact import BodyContact
from ancf.model.surfaces.surface import SurfaceContact
from contact_laws import on_ball, on_beam, on_ground, points_of
from helpers import some
from random_worlds import FRAMES, STEP, World, differences, run_of


@pytest.mark.parametrize("seed", range(8))
def test_frames(seed):
    """One model, turned, mirrored, renumbered, in other units."""
    assert {key: off for key, off in differences(World, seed, FRAMES).items() if not off < 1e-5} == {}


def weight(world, run):
    force, moment = np.zeros((2, len(run.t), 3))
    for body in world.model.bodies.values():
        parts = [(body.centre, body.mass)] if hasattr(body, "centre") else points_of(body, 3)
        for point, part in parts:
            f = (part if hasattr(body, "centre") else part * body.section.rhoA) * world.g
            force, moment = force + f, moment + np.cross(run.position(point), f)
    return force, moment


def balls_alone(world):
    """Without contacts of capsules on what stands on the ground."""
    for name, contact in list(world.contacts.items()):
        if isinstance(contact, BodyContact) and not isinstance(contact.surface.shape, ancf.Sphere):
            world.model.connections.remove(world.contacts.pop(name))


@pytest.mark.parametrize("seed", range(100, 120))
def test_newton_and_euler(seed):
    """Each contact's force and friction, and the momenta: those that act between bodies change nothing."""
    world = World(seed, more=False)
    balls_alone(world)
    run = run_of(world)
    force, moment = weight(world, run)
    size = float(np.max(np.abs(force)))
    for contact in world.contacts.values():
        if not isinstance(contact, SurfaceContact | BodyContact):
            continue
        beam = isinstance(contact, SurfaceContact)
        f, m, normal, friction = (on_beam if beam else on_ball)(run, contact)
        assert np.max(np.abs(run.sensors.contact_force(contact) - normal)) < 1e-6 * max(np.max(normal), 1.0)
        rubbed = run.sensors.friction_force(contact)
        assert np.max(np.abs(rubbed - friction)) < 1e-6 * max(np.max(normal), 1.0)
        assert np.all(rubbed <= 1.2 * contact.friction * np.max(normal) + 1e-12)
        size = max(size, float(np.max(np.abs(f))))
        if (contact.surface if beam else contact.other).on is None:
            force, moment = force + f, moment + m
    for ground in world.model.grounds:
        for beam in world.model.beams.values():
            f, m = on_ground(run, ground, beam)
            force, moment, size = force + f, moment + m, max(size, float(np.max(np.abs(f))))
    for given, momentum, left in (
        (force, run.momentum, 1e-6),
        (moment, run.angular_momentum((0, 0, 0)), 1e-3),
    ):
        change = np.diff(momentum, axis=0) / STEP - 0.5 * (given[1:] + given[:-1])
        assert np.max(np.abs(change)) < left * size


def tie(world, point, stiffness):
    for axis in np.eye(3):
        world.model.add_spring(point, tuple(point.initial_position + 0.7 * axis), stiffness=stiffness)


@pytest.mark.parametrize("seed", some([202, 203, 208, 210, 211, 212, 220, 222, 223, 225, 227, 228, 231, 234]))
def test_a_run_from_an_equilibrium_stays_there(seed):
    """On springs, pressed on each other, on surfaces and grounds with friction that sticks."""
    world = World(seed, more=False)
    for body in world.model.bodies.values():
        body.set_motion(velocity=(0.0, 0.0, 0.0), angular_velocity=(0.0, 0.0, 0.0))
        if hasattr(body, "centre"):
            for arm in 0.3 * np.eye(3):
                tie(world, body.at(*arm), 60.0)
                tie(world, body.at(*-arm), 60.0)
        else:
            for x in (0.0, 0.5, 1.0):
                tie(world, body.at(x * body.length), 30.0)
    state = ancf.equilibrium(world.model)
    run = ancf.simulate(world.model, t_end=0.02, step=1e-3, start=state)
    assert max(float(state.contact_force(c)) for c in world.contacts.values()) > 0.1
    for point in world.points:
        assert np.max(np.abs(run.velocity(point))) < 1e-6
    for contact in world.contacts.values():
        force = run.contact_force(contact)
        assert np.max(np.abs(force - state.contact_force(contact))) < 1e-6 * max(np.max(force), 1.0)
