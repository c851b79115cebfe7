"""Steppers that go back to a snapshot: the bits of a run that just went on, whatever was tried meanwhile."""

import pickle

import numpy as np
import pytest

import ancf
from ancf import catenary
from motions import pendulum
from runs_to_continue import RUNS, adaptive

NAMES = [name for name, run in RUNS.items() if not adaptive(run[1])]


def columns(run):
    """All that was recorded."""
    return {name: np.array(x) for name, x in run.sensors._arrays().items()}


def same(one, other):
    return all(np.array_equal(one[name], other[name]) for name in one)


@pytest.mark.filterwarnings("ignore:energies of the run do not add up")
@pytest.mark.parametrize("name", NAMES)
def test_same_bits_again(name):
    """Back from near, from afar (beyond what is tabulated ahead), before and behind, and in another run."""
    build, method, step, steps, sensors = RUNS[name]
    given = {"step": step, "integrator": method, "sensors": sensors}
    run = ancf.stepper(build(), **given)
    marks, seen = {}, {}
    for k in range(steps + 1):
        if k in (0, steps // 3, steps - 1):
            marks[k] = run.snapshot()
        seen[k] = run.q
        if k < steps:
            run.advance()
    recorded = columns(run)
    for k in (steps - 1, steps // 3, 0, steps // 3):
        if k <= run.t / step + 0.5:
            run.restore(pickle.loads(pickle.dumps(marks[k])))
        assert run.t == pytest.approx(k * step, abs=1e-12)
        assert np.array_equal(run.q, seen[k])
        run.advance(steps - k)
        assert np.array_equal(run.q, seen[steps])
        assert same(recorded, columns(run))
    other = ancf.stepper(build(), **given)
    other.advance(steps // 3)
    other.restore(marks[steps // 3])
    other.advance(steps - steps // 3)
    assert np.array_equal(other.q, seen[steps])


def pushed():
    model, beam = pendulum()
    thrust = model.add_input("thrust", 0.5)
    model.add_force(beam.end, (0, 2 * thrust, "3*sin(9*t)"))
    return model


@pytest.mark.parametrize("way", [1, 7, 90, 300])
def test_inputs_of_then(way):
    """What was given since is forgotten, in the run and in its history; what is given now holds."""
    given = {"step": 1e-3, "sensors": ["beam.end"]}
    run, plain = (ancf.stepper(pushed(), **given) for _ in range(2))
    for one in (run, plain):
        one.inputs["thrust"] = 0.3
        one.advance(40)
    here = run.snapshot()
    run.inputs["thrust"] = 7.0
    run.advance(way)
    run.inputs["thrust"] = -7.0
    run.advance(3)
    run.restore(here)
    assert run.inputs["thrust"] == 0.3
    for one in (run, plain):
        one.advance(20)
        one.inputs["thrust"] = 1.0
        one.advance(20)
    assert np.array_equal(run.q, plain.q)
    assert run.energy.supplied == plain.energy.supplied
    assert np.array_equal(run.sensors.input("thrust"), plain.sensors.input("thrust"))
    assert same(columns(run), columns(plain))


def shaken():
    """A cable whose support moves: its motions are tabulated piece by piece."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e3, EI=0.1, rhoA=0.2, axial_damping=1.0)
    cable = model.add_beam("cable", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section)
    model.pin(cable.start, displacement=("0.1*sin(20*t)", 0.0, "0.05*sin(31*t)"))
    return model


@pytest.mark.parametrize("build", [pushed, shaken])
@pytest.mark.parametrize("far", [100, 400, 700])
def test_forward_again(far, build):
    """To a later snapshot, within and beyond what is tabulated ahead."""
    run = ancf.stepper(build(), step=1e-3)
    start = run.snapshot()
    run.advance(far)
    later = run.snapshot()
    run.advance(30)
    q = run.q
    run.restore(start)
    run.advance(5)
    run.restore(later)
    run.advance(30)
    assert np.array_equal(run.q, q)


def test_saved_after_going_back(tmp_path):
    run, plain = (ancf.stepper(pushed(), step=1e-3, sensors=["beam.end"]) for _ in range(2))
    here = run.snapshot()
    run.advance(30)
    run.restore(here)
    for one in (run, plain):
        one.advance(10)
    run.save(tmp_path / "run.h5")
    again = ancf.stepper(pushed(), start=tmp_path / "run.h5")
    for one in (again, plain):
        one.advance(10)
    assert np.array_equal(again.q, plain.q)
    assert same(columns(again), columns(plain))


def test_looking_ahead():
    """The use of it: of some thrusts the one that brings the end nearest to a place, tried one by one."""
    run, goal = ancf.stepper(pushed(), step=1e-3), np.array([0.9, 0.1, -0.2])
    misses = []
    for _ in range(10):
        here, found = run.snapshot(), {}
        for thrust in (-3.0, 0.0, 3.0):
            run.inputs["thrust"] = thrust
            run.advance(20)
            found[thrust] = float(np.linalg.norm(run.position("beam.end") - goal))
            run.restore(here)
        best = min(found, key=found.get)
        run.inputs["thrust"] = best
        run.advance(20)
        misses.append(float(np.linalg.norm(run.position("beam.end") - goal)))
        assert misses[-1] == found[best]
    assert run.t == pytest.approx(0.2)


def test_after_a_step_that_failed():
    """A snapshot of before takes the run back behind what an input has spoilt."""
    run = ancf.stepper(pushed(), step=1e-3)
    run.advance(10)
    here, q = run.snapshot(), run.q
    run.inputs["thrust"] = 1e12
    with pytest.raises(ancf.SolveError):
        run.advance(50)
    run.restore(here)
    assert np.array_equal(run.q, q)
    run.advance(20)
    plain = ancf.stepper(pushed(), step=1e-3)
    plain.advance(30)
    assert np.array_equal(run.q, plain.q)


@pytest.mark.parametrize("kind", ["reduced", "whole"])
def test_along_a_line(kind):
    """Spans that slept sleep again, with a new matrix, which alone moves the whole line by 0.08 N."""
    line = catenary.read_line("en50318-2002")
    given = {"speed": 70.0, "pantograph": "en50318-2002", "step": 2e-3, "reduce": kind == "reduced"}
    run = catenary.stepper(line, mesh=catenary.Mesh(contact=2.5, messenger=5.0), **given)
    forces = []
    run.advance(300)
    here = run.snapshot()
    for _ in range(3):
        found = []
        for _ in range(60):
            run.advance(10)
            found.append(run.pantograph().force)
        forces.append(found)
        run.restore(here)
        assert run._run.sleeps == (kind == "reduced")
    assert np.ptp(forces[0]) > 10.0
    assert forces[1] == forces[2]
    assert np.allclose(forces[0], forces[1], rtol=0, atol=0.1 if kind == "reduced" else 0.0)


def test_a_whole_line_in_a_reduced_one():
    """A snapshot that knows of no spans that sleep: all are awake then, and fall asleep by themselves."""
    line, mesh = catenary.read_line("en50318-2002"), catenary.Mesh(contact=2.5, messenger=5.0)
    given = {"speed": 70.0, "pantograph": "en50318-2002", "step": 2e-3, "mesh": mesh}
    whole, run = catenary.stepper(line, **given), catenary.stepper(line, reduce=True, **given)
    for one in (whole, run):
        one.advance(100)
    run.restore(whole.snapshot())
    assert not run._run.sleeps
    for one in (whole, run):
        one.advance(200)
    assert run._run.sleeps
    assert run.pantograph().force == pytest.approx(whole.pantograph().force, abs=0.5)


class TestRefused:
    def test_what_is_none(self):
        run = ancf.stepper(pushed(), step=1e-3)
        with pytest.raises(ancf.ModelError, match=r"restore.checkpoint: must be what run.snapshot\(\) gave"):
            run.restore(run.state())

    @pytest.mark.parametrize(
        "other",
        [
            lambda: ancf.stepper(pendulum(3)[0], step=1e-3),
            lambda: ancf.stepper(pushed(), step=1e-3, integrator=ancf.Radau(adaptive=False)),
        ],
    )
    def test_of_another_model(self, other):
        """The run is where it was, and goes on."""
        run, plain, other = ancf.stepper(pushed(), step=1e-3), ancf.stepper(pushed(), step=1e-3), other()
        for one in (run, plain, other):
            one.advance(5)
        with pytest.raises(ancf.ModelError):
            run.restore(other.snapshot())
        for one in (run, plain):
            one.advance(5)
        assert np.array_equal(run.q, plain.q)

    def test_of_another_step(self):
        run, other = ancf.stepper(pushed(), step=1e-3), ancf.stepper(pushed(), step=2e-3)
        other.advance(3)
        with pytest.raises(ancf.ModelError, match=r"is of step 3 at t = .* s, where this run is not"):
            run.restore(other.snapshot())

    def test_later_than_what_was_recorded(self):
        run, other = (ancf.stepper(pushed(), step=1e-3, sensors=["beam.end"]) for _ in range(2))
        other.advance(3)
        with pytest.raises(ancf.ModelError, match="is later than this run"):
            run.restore(other.snapshot())
