"""What stands upright without being held from the side falls over: said of the equilibrium that is found."""

import numpy as np
import pytest

import ancf
from upright import UP, axes

SAID = "stood above all that holds it and hangs below it: it has fallen over"


def mast(up, height):
    """A mast on a pin, whose top may be held."""
    R = axes(up)
    model = ancf.Model(gravity=tuple(-9.81 * R[2]))
    section = ancf.Section.circle(diameter=height / 100, E=2.1e11, rho=7850.0, nu=0.3)
    pole = model.add_beam("pole", start=(0, 0, 0), end=tuple(height * R[2]), elements=6, section=section)
    model.pin(pole.start)
    return model, pole, R


def guys(model, pole, R, height, count, slack):
    """Guys from the top to the ground, so much longer than the way."""
    rope = ancf.Section(EA=1e6, EI=0.0, rhoA=0.05)
    for k in range(count):
        angle = 2.0 * np.pi * k / count + 0.3
        foot = height * (np.cos(angle) * R[0] + np.sin(angle) * R[1])
        given = {"start": tuple(pole.end.initial_position), "end": tuple(foot), "elements": 6}
        length = slack * height * np.sqrt(2.0)
        guy = model.add_beam(f"guy{k}", section=rope, length=length, **given)
        model.connect(pole.end, guy.start)
        model.pin(guy.end)


@pytest.mark.parametrize("count", [0, 1, 2])
@pytest.mark.parametrize("height", [1.0, 10.0, 40.0])
@pytest.mark.parametrize("up", UP)
def test_a_mast_without_guys_that_hold_it(up, height, count):
    model, pole, R = mast(up, height)
    guys(model, pole, R, height, count, 1.02)
    state = ancf.equilibrium(model)
    assert state.position(pole.end) @ R[2] < -0.9 * height
    said = [note for note in state.notes if SAID in note]
    assert len(said) == 1
    assert said[0].startswith('"pole"')


@pytest.mark.parametrize("slack", [0.998, 1.0])
@pytest.mark.parametrize("count", [3, 4, 5])
@pytest.mark.parametrize("up", UP)
def test_a_mast_that_guys_hold(up, count, slack):
    model, pole, R = mast(up, 10.0)
    guys(model, pole, R, 10.0, count, slack)
    state = ancf.equilibrium(model)
    assert state.position(pole.end) @ R[2] > 9.0
    assert not any(SAID in note for note in state.notes)


@pytest.mark.parametrize("up", UP)
@pytest.mark.parametrize("kind", ["clamped", "level", "hanging", "arch", "weightless"])
def test_what_hangs_or_stands_as_it_should(up, kind):
    R = axes(up)
    model = ancf.Model(gravity=(0, 0, 0) if kind == "weightless" else tuple(-9.81 * R[2]))
    section = ancf.Section(EA=1e5, EI=50.0, rhoA=0.3)
    end = {"clamped": R[2], "level": R[0], "hanging": -R[2], "arch": R[0], "weightless": R[2]}[kind]
    given = {"start": (0, 0, 0), "end": tuple(end)}
    if kind == "arch":  # a rope that is drawn above what holds it, by less than it sags
        given = {"path": [(0.0, 0.0, 0.0), tuple(0.5 * R[0] + 0.2 * R[2]), tuple(R[0])]}
    rope = model.add_beam("rope", **given, elements=8, section=section)
    model.clamp(rope.start) if kind == "clamped" else model.pin(rope.start)
    if kind == "arch":
        model.pin(rope.end)
    if kind == "weightless":
        model.add_force(rope.end, tuple(0.1 * R[2]))
    assert not any(SAID in note for note in ancf.equilibrium(model).notes)


@pytest.mark.parametrize("up", UP)
@pytest.mark.parametrize("offset", [(0.0, 0.0, 0.5), (0.3, 0.1, 0.4)])
def test_a_body_on_a_joint(up, offset):
    R = axes(up)
    model = ancf.Model(gravity=tuple(-9.81 * R[2]))
    body = model.add_rigid_body("box", at=tuple(R.T @ offset), mass=2.0, inertia=(0.02, 0.03, 0.04))
    model.connect(body.at(*(-(R.T @ offset))), (0.0, 0.0, 0.0))
    state = ancf.equilibrium(model)
    assert state.position(body.centre) @ R[2] == pytest.approx(-np.linalg.norm(offset), rel=1e-6)
    assert [note for note in state.notes if SAID in note and note.startswith('"box"')]


@pytest.mark.parametrize("height", [1.0, 10.0])
def test_states_of_runs_are_not_looked_at(height):
    model, _, _ = mast("z", height)
    start = ancf.equilibrium(model)
    assert any(SAID in note for note in start.notes)
    state = ancf.simulate(model, start=start, t_end=0.01, step=1e-3).state(-1)
    assert not any(SAID in note for note in state.notes)
