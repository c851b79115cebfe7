"""Rates of given motions at few times are those of many, to the last bit, and a moment is asked once."""

import numpy as np
import pytest

import ancf
from ancf.system import inputs
from ancf.system.system import System

CASES = [(n, k, room) for n in (1, 2, 5, inputs.FEW) for k in (0, 1, 3, 9) for room in (0, 2, np.inf)]


def moved(t):
    """Columns that grow, swing, and are zero of either sign."""
    return np.column_stack([np.sin(3.0 * t), np.exp(-t) * np.cos(50.0 * t), -0.0 * t, t**3])


@pytest.mark.parametrize(("n", "k", "room"), CASES)
@pytest.mark.parametrize("step", [1e-4, 3e-3])
def test_the_same_bits(n, k, room, step, monkeypatch):
    times = 0.2 + step * (k + np.arange(n))
    given = moved, times, step, 0.2, times[-1] + step * room if room else times[-1]
    few = inputs.differences(*given)
    monkeypatch.setattr(inputs, "FEW", 0)
    assert [x.tobytes() for x in few] == [x.tobytes() for x in inputs.differences(*given)]


def lifted(asked, level):
    """A rope whose start a Python function moves that counts its calls; an input pulls its end."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    rope = model.add_beam(
        "rope", start=(0, 0, 0), end=(0, 0, -1), elements=2, section=ancf.Section(EA=1e4, EI=0.1, rhoA=0.1)
    )

    def way(t):
        asked.append(t)
        return 0.0, 0.0, level * np.sin(4.0 * t)

    model.pin(rope.start, displacement=way)
    model.add_force(rope.end, (0.0, 0.0, model.add_input("pull", 1.0)))
    return model


@pytest.mark.parametrize("level", [0.1, 2.0])
def test_a_moment_is_asked_once(level):
    asked = []
    system = System(lifted(asked, level))
    states = [system.initial_state(0.3)]
    count = len(asked)
    states.append(system.initial_state(0.3))
    assert len(asked) == count
    other = system.initial_state(0.4)
    assert len(asked) > count
    states.append(system.initial_state(0.3))
    for q, v in states[1:]:
        np.testing.assert_array_equal(q, states[0][0])
        np.testing.assert_array_equal(v, states[0][1])
    assert np.max(np.abs(other[0] - states[0][0])) > 1e-3 * level


@pytest.mark.parametrize("pull", [2.0, -3.5])
def test_a_new_input_is_seen(pull):
    """What is kept of a moment has the inputs of then."""
    system = System(lifted([], 0.1))
    zero = np.zeros(system.size)
    before = system.inputs.moment(0.3, (zero, zero)).value.copy()
    system.inputs.give("pull", pull)
    after = system.inputs.moment(0.3, (zero, zero)).value
    assert np.max(np.abs(after - before)) == pytest.approx(abs(pull - 1.0))
