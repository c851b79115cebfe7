"""States of a linear model that are read from a run, and reductions."""

import numpy as np
import pytest
from linear_cases import READ, Asked, assert_of_second_order, built

import ancf
from helpers import EXACT


@pytest.mark.parametrize(("name", "element"), READ)
def test_states_of_a_run(name, element):
    """C x + D u of the states that are read from a run is its output, to the second order."""
    model, outputs = built(name, element)
    outputs = [*outputs, "velocity(load)[0]"]
    state = ancf.equilibrium(model)
    linear = ancf.linearise(model, about=state, outputs=outputs, inputs=["push"])
    formulas = ancf.design.linear_outputs.formulas_of(model, outputs)
    assert linear.state(state) == pytest.approx(np.zeros(len(linear.A)), abs=1e-9)
    left, few = [], []
    for size in (0.1, 0.05):
        run = ancf.stepper(model, step=4e-3, start=state, integrator=ancf.Trapezoidal(newton=EXACT))
        run.inputs["push"] = 0.3 + size
        run.advance(40)
        added = [formula(Asked(run)) for formula in formulas.values()] - linear.outputs_at
        seen = linear.C @ linear.state(run) + linear.D[:, 0] * size
        left.append(np.abs(added - seen) / np.maximum(np.abs(linear.outputs_at), 0.1))
        small = linear.reduced(8)
        few.append(np.abs(small.state(run.state()) - np.delete(linear.state(run), missing(linear, 8))).max())
    assert_of_second_order(np.array(left), 1e-9)
    assert few == [0.0, 0.0]


def missing(linear, modes):
    """Places of the states that a reduction leaves out."""
    kept = {f"{word}mode {k}" for word in ("", "rate of ") for k in range(1, modes + 1)}
    return [k for k, name in enumerate(linear.states) if "mode" in name and name not in kept]


@pytest.mark.parametrize("axis", [0, 2])
@pytest.mark.parametrize("word", ["velocity", "acceleration"])
@pytest.mark.parametrize(("name", "element"), READ)
def test_states_of_a_run_whose_support_moves(name, element, word, axis):
    """The motion of a support is among the states, its rate in them or beside them."""
    size, w = 1e-4, 7.0
    shift = [0.0, 0.0, 0.0]
    shift[axis] = f"{size}*sin({w}*t)**2"
    model, _ = built(name, element, displacement=shift)
    state = ancf.equilibrium(model)
    linear = ancf.linearise(
        model,
        about=state,
        outputs=["position(load)[0]", "velocity(load)[2]"],
        inputs=[f"{word}(hook)[{axis}]"],
    )
    run = ancf.stepper(model, step=2e-3, start=state)
    run.advance(60)
    x, angle = linear.state(run), w * run.t
    s, ds = size * np.sin(angle) ** 2, size * w * np.sin(2 * angle)
    count = len(linear.frequencies_hz)
    assert x[count] == pytest.approx(s, rel=1e-9)
    if word == "acceleration":
        assert x[-1] == pytest.approx(ds, rel=1e-4)
    added = run.position("load")[0] - linear.outputs_at[0], run.velocity("load")[2]
    u = ds if word == "velocity" else 0.0
    seen = linear.C @ x + linear.D[:, 0] * u
    assert seen == pytest.approx(added, rel=2e-3, abs=2e-3 * np.abs(added).max())


@pytest.mark.parametrize(("name", "element"), READ)
@pytest.mark.parametrize("modes", [1, 4, 9])
def test_reduction_keeps_the_static_gain_and_the_lowest_modes(name, element, modes):
    model, outputs = built(name, element)
    state = ancf.equilibrium(model)
    inputs = ["push", "acceleration(hook)[2]"]
    outputs = [*outputs, "reaction(hook)[2]"]
    whole = ancf.linearise(model, about=state, outputs=outputs, inputs=inputs)
    small = ancf.linearise(model, about=state, outputs=outputs, inputs=inputs, modes=modes)
    assert len(small.A) == 2 * modes + 2 == len(small.states) == len(small.state_units)
    assert small.states[:2] == (("mode 1", "mode 2") if modes > 1 else ("mode 1", "displacement of hook z"))
    assert small.frequencies_hz == pytest.approx(whole.frequencies_hz[:modes])
    assert small.left_out_hz == whole.frequencies_hz[modes]
    assert f"from {small.left_out_hz:.4g} Hz" in str(small)
    left = []
    for hz in (2e-3 * small.left_out_hz, 1e-3 * small.left_out_hz):
        a, b = (one.frequency_response(hz)[0] for one in (whole, small))
        left.append(np.abs(a - b) / np.abs(a))
    assert np.max(left) < 2e-3
    pushed = [one[:, 0] for one in left]
    assert np.all(pushed[1] < 0.6 * pushed[0])
    twice = whole.reduced(modes + 3).reduced(modes)
    for key in "ABCD":
        mine, other = getattr(small, key), getattr(twice, key)
        np.testing.assert_allclose(other, mine, rtol=0, atol=1e-9 * np.abs(mine).max())


@pytest.mark.parametrize("modes", [2, 3, 6])
@pytest.mark.parametrize("element", ["cable", "original"])
def test_reduction_of_what_follows(element, modes):
    """Where modes are coupled by a following force, those left out have a part in all four matrices."""
    model, outputs = built("following", element)
    whole = ancf.linearise(model, about=ancf.equilibrium(model), outputs=[*outputs, "reaction(hook)[0]"])
    small = whole.reduced(modes)
    at_rest = small.frequency_response(0.0)[0]
    assert at_rest == pytest.approx(whole.frequency_response(0.0)[0], rel=1e-9)
    kept = [whole.states.index(name) for name in small.states]
    assert not np.allclose(small.A, whole.A[np.ix_(kept, kept)], rtol=1e-9, atol=0.0)
