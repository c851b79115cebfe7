"""Runs that a controller leads: functions of time are tabulated ahead, which changes no bit."""

import numpy as np
import pytest

import ancf
from ancf import ModelError
from runs_to_continue import RUNS, adaptive

NAMES = [name for name, run in RUNS.items() if not adaptive(run[1])]


@pytest.mark.filterwarnings("ignore:energies of the run do not add up")
@pytest.mark.parametrize("every", [1, 3])
@pytest.mark.parametrize("name", NAMES)
def test_a_controller_that_does_nothing_changes_nothing(name, every):
    build, method, step, steps, sensors = RUNS[name]
    given = {"t_end": (steps + 4) * step, "step": step, "integrator": method, "sensors": sensors}
    whole = ancf.simulate(build(), **given)
    led = ancf.simulate(build(), **given, controller=lambda run: None, control_step=every * step)
    assert np.array_equal(led.q[-1], whole.q[-1])
    assert np.array_equal(led.v[-1], whole.v[-1])


def moved(calls, fails=np.inf):
    """A mass that is carried along by a given motion, with a force over time and one by an input."""

    def place(t):
        calls.append(t)
        if t > fails:
            raise ValueError("no more")
        return (0.1 * np.sin(20.0 * t), 0.0, 0.0)

    model = ancf.Model()
    hand = model.add_point_mass("hand", at=(0.0, 0.0, 0.0), mass=1.0)
    load = model.add_point_mass("load", at=(1.0, 0.0, 0.0), mass=2.0)
    model.pin(hand, displacement=place)
    model.add_spring(hand, load, stiffness=500.0, length=1.0)
    model.hold(load, position="yz")
    model.add_force(load, (model.add_input("push"), 0.0, 0.0))
    model.add_force(load, ("3*t", 0.0, 0.0))
    return model, load


class TestMotion:
    def test_is_asked_for_ahead(self):
        """Not at seven times for each step, which the differences of its rates need."""
        calls = []
        model, _ = moved(calls)

        def begin(run):  # it was looked through for jumps before
            if run.t == 0.0:
                calls.clear()

        ancf.simulate(model, t_end=1.0, step=1e-3, controller=begin, control_step=1e-3)
        assert 1000 <= len(calls) <= 1300

    def test_inputs_count_from_the_next_step_on(self):
        """The same as a function of time that is known before."""
        model, load = moved([])

        def push(run):
            run.inputs["push"] = 5.0 if run.t >= 0.2 - 1e-9 else 0.0

        led = ancf.simulate(model, t_end=0.4, step=1e-3, controller=push, control_step=1e-3)
        known, other = moved([])
        known.add_force(other, lambda t: (5.0 if t > 0.2 + 1e-9 else 0.0, 0.0, 0.0))
        told = ancf.simulate(known, t_end=0.4, step=1e-3)
        assert led.position(load)[-1] == pytest.approx(told.position(other)[-1], abs=1e-12)

    def test_a_function_that_fails_later(self):
        """The run goes as far as without a controller, and says the same."""
        said, times = [], []
        for led in ({}, {"controller": lambda run: times.append(run.t), "control_step": 1e-3}):
            model, _ = moved([], fails=0.35)
            with pytest.raises(ModelError, match="no more") as caught:
                ancf.simulate(model, t_end=1.0, step=1e-3, **led)
            said.append(str(caught.value))
        assert said[0] == said[1]
        assert times[-1] == pytest.approx(0.347, abs=1.5e-3)


class TestPieces:
    """Where there are many given motions the tables to come are made piece by piece."""

    def test_are_the_same_tables(self):
        model, _ = moved([])
        live = ancf.stepper(model, step=1e-3)
        inputs, asked = live.system.inputs, (0.256, 1e-3, 256, 0.0, 1e9)
        *before, made = inputs.piecewise(*asked)
        assert len(before) == inputs.pieces - 1 > 0
        assert all(piece is None for piece in before)
        for mine, wanted in zip(made, inputs.tables(*asked), strict=True):
            assert np.array_equal(mine, wanted)

    @pytest.mark.parametrize("together", [1, 7, 50])
    def test_change_nothing(self, together):
        """Steps over several tables, with an input that changes between them, against a run of all."""

        def push(t):
            return 5.0 * max(round(t / 1e-3) // together, 0)

        known, other = moved([])
        known.add_force(other, lambda t: (push(t - 1e-3), 0.0, 0.0))
        told = ancf.simulate(known, t_end=0.7, step=1e-3)
        model, load = moved([])
        live = ancf.stepper(model, step=1e-3)
        for first in range(0, 700, together):
            live.inputs["push"] = push(first * 1e-3)
            live.advance(together)
        assert live.position(load) == pytest.approx(told.position(other)[-1], abs=1e-9)

    def test_a_function_that_fails_in_tables_to_come(self):
        """The run goes on to where it fails, step by step."""
        model, _ = moved([], fails=0.4)
        live = ancf.stepper(model, step=1e-3)
        while live.t < 0.39:
            live.advance()
        with pytest.raises(ModelError, match="no more"):
            live.advance(10)
        assert live.t == pytest.approx(0.397, abs=1.5e-3)
