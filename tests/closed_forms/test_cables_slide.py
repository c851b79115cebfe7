"""A cable that slides across another one at any angle: friction is mu N against the speed past the other.

Without damping, which presses more in front of the patch than behind it, and so holds back what slides.
"""

import numpy as np
import pytest

import ancf
from contact_laws import points_of, unit

STEP, FRICTION, PRESS = 1e-5, 0.2, 20.0


@pytest.mark.parametrize("seed", range(8))
def test_friction_is_against_the_speed_past_the_other(seed):
    rng, d = np.random.default_rng(seed), 0.04
    t, s, n = np.linalg.qr(rng.standard_normal((3, 3)))[0].T
    angle = rng.uniform(0.9, 2.2)
    across = np.cos(angle) * t + np.sin(angle) * s
    model, section = ancf.Model(), ancf.Section(EA=1e4, EI=50.0, rhoA=1.0, diameter=d)
    above = (d - 1e-4) * n
    moves = model.add_beam("moves", start=above - 0.5 * t, end=above + 0.5 * t, elements=2, section=section)
    rests = model.add_beam("rests", start=-0.5 * across, end=0.5 * across, elements=2, section=section)
    model.clamp(rests.start)
    model.clamp(rests.end)
    contact = model.add_contact(moves, rests, stiffness=1e6, friction=FRICTION)
    v = 1.5 * unit(rng.standard_normal(2) @ [t, s])
    moves.set_motion(velocity=tuple(v))
    model.add_distributed_load(moves, tuple(-PRESS * n))
    run = ancf.simulate(model, t_end=0.01, step=STEP, sensors=[contact])
    momentum = sum(w * section.rhoA * run.velocity(point) for point, w in points_of(moves, 5))
    force = np.gradient(momentum, run.t, axis=0)[300:900] + PRESS * moves.length * n
    normal = force @ n
    friction = force - normal[:, None] * n
    assert np.all(run.sensors.slipping(contact)[300:900] == 1.0)
    past = (run.velocity(moves.at(0.5)) - run.velocity(rests.at(0.5)))[300:900]
    past -= (past @ n)[:, None] * n
    off = friction + FRICTION * normal[:, None] * past / np.linalg.norm(past, axis=1)[:, None]
    assert np.max(np.abs(off)) < 5e-3 * FRICTION * np.max(normal)
