"""What lands with a speed along a surface: its friction, spring and damper, gives back what it took at most.

A damper that pulled beyond the limit stretched the spring to its limit at once, however little had moved, and
the finer the steps the slower it could be: what had landed sprang back many times as fast as it had come.
"""

import numpy as np
import pytest

import ancf

KINDS = ["ball", "ground", "plane", "cable"]


def landing(kind, rng, speed):
    """Something that lands with 1 m/s and a speed across; the model, that direction, the time of contact."""
    model, turn = ancf.Model(), rng.uniform(0, 2 * np.pi)
    way, mass, d = np.array([np.cos(turn), np.sin(turn), 0.0]), rng.uniform(0.5, 2.0), 0.02
    k = 10 ** rng.uniform(4, 6)
    damping, friction = k * 10 ** rng.uniform(-3, -1.5) * np.sqrt(1e4 / k), rng.uniform(0.2, 0.6)
    law = {"stiffness": k, "damping": damping, "friction": friction}
    if kind == "ball":
        body = model.add_rigid_body("ball", at=(0, 0, 0.1), mass=mass, inertia=(1e3, 1e3, 1e3))
        skin = model.add_surface("skin", ancf.Sphere(0.1), on=body)
        model.add_contact(skin, model.add_surface("floor", ancf.Plane((0, 0, 0), (0, 0, 1))), **law)
    else:
        section = ancf.Section(EA=1e4, EI=10.0, rhoA=mass, diameter=d)
        height = {"ground": 0.015 * d, "plane": 0.5 * d, "cable": d}[kind]
        at, side = np.array([0.0, 0.0, height]), 0.5 * np.array([-way[1], way[0], 0.0])
        ends = {"start": at - side, "end": at + side}
        body = model.add_beam("rope", elements=2, section=section, **ends)
        if kind == "ground":
            given = {"stiffness": k / d, "damping": damping / d}
            model.add_ground("bed", height=0.0, friction=friction, **given)
        elif kind == "plane":
            model.add_contact(body, model.add_surface("floor", ancf.Plane((0, 0, 0), (0, 0, 1))), **law)
        else:
            wire = ancf.Section(EA=1e6, EI=1e3, rhoA=mass, diameter=d)
            other = model.add_beam("bar", start=-0.1 * way, end=0.1 * way, elements=1, section=wire)
            model.clamp(other.start)
            model.clamp(other.end)
            model.add_contact(body, other, **law | {"stiffness": 100 * k, "damping": 100 * damping})
    body.set_motion(velocity=tuple(speed * way - (0, 0, 1.0)))
    return model, way, np.pi * np.sqrt(mass / k)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(6))
def test_it_leaves_no_faster_than_it_came(kind, seed):
    rng = np.random.default_rng(seed)
    speed = 10 ** rng.uniform(-3, -1)
    model, way, contact = landing(kind, rng, speed)
    step = contact * 10 ** rng.uniform(-4, -3)
    run = ancf.simulate(model, t_end=1.2 * contact, step=step, energy=False)
    along = run.momentum @ way
    assert np.max(np.abs(along)) < 1.05 * along[0]
    assert along[-1] < 0.999 * along[0]
