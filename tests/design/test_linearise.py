"""Linear state spaces beside damped modes, equilibria and simulations of the same models."""

import pickle

import numpy as np
import pytest
from linear_cases import (
    CLAMPED,
    HELD,
    Asked,
    answers,
    assert_of_second_order,
    built,
    cases,
    driven,
    rope,
)
from scipy.linalg import expm
from scipy.signal import lsim

import ancf
from ancf.errors import ModelError
from ancf.solvers.modes.linear_moved import slope
from helpers import EXACT


@cases
def test_eigenvalues_are_those_of_damped_modes(name, element):
    model, _ = built(name, element)
    state = ancf.equilibrium(model)
    wanted = ancf.damped_modes(model, about=state, count=12).eigenvalues
    linear = ancf.linearise(model, about=state, outputs=["position(load)[0]"])
    found = linear.eigenvalues
    assert np.all(np.abs(wanted) > 0.0)
    for value in (*wanted, *wanted.conj()):
        assert np.min(np.abs(found - value)) <= 1e-8 * abs(value), value


@cases
def test_static_gain_is_that_of_equilibria(name, element):
    """D - C A^-1 B beside extrapolated differences of equilibria, reactions and their moments included."""
    model, outputs = built(name, element)
    outputs = [*outputs, *HELD, *(["reaction_moment(hook)[1]"] if name in CLAMPED else [])]
    linear = ancf.linearise(model, about=ancf.equilibrium(model), inputs=["push"], outputs=outputs)
    gain = linear.D - linear.C @ np.linalg.solve(linear.A, linear.B)

    def at(push):
        return answers(ancf.equilibrium(built(name, element, push)[0]), outputs)

    h = 4e-3
    near, far = ((at(0.3 + d) - at(0.3 - d)) / (2 * d) for d in (h, 2 * h))
    wanted = (4 * near - far) / 3
    assert np.abs(wanted).max() > 1e-3
    np.testing.assert_allclose(gain[:, 0], wanted, rtol=2e-6, atol=2e-8 * np.abs(wanted).max())
    assert linear.frequency_response(0.0)[0] == pytest.approx(gain, rel=1e-12)


def signal(t):
    return np.sin(9.0 * t) + 0.4 * np.cos(23.0 * t)


def nonlinear(model, state, outputs, size, step, steps):
    """Changes of outputs after each step of a run with an input of this size, (steps, outputs)."""
    first = model.inputs["push"].value
    run = ancf.stepper(model, step=step, start=state, integrator=ancf.Trapezoidal(newton=EXACT))
    seen = ancf.design.linear_outputs.formulas_of(model, outputs)
    found = []
    for k in range(steps):
        run.inputs["push"] = first + size * signal((k + 1) * step)
        run.advance()
        found.append([formula(Asked(run)) for formula in seen.values()])
    return np.array(found)


def trapezoids(linear, step, steps):
    """The same of a linear model for the input 1, by the trapezoidal rule."""
    n = len(linear.A)
    ahead = np.linalg.inv(np.eye(n) - 0.5 * step * linear.A)
    back = np.eye(n) + 0.5 * step * linear.A
    x, before, found = np.zeros(n), 0.0, []
    for k in range(steps):
        u = signal((k + 1) * step)
        x = ahead @ (back @ x + 0.5 * step * linear.B[:, 0] * (before + u))
        before = u
        found.append(linear.C @ x + linear.D[:, 0] * u)
    return np.array(found)


@cases
def test_what_a_run_adds_falls_with_the_square_of_the_input(name, element):
    """Taylor: the linear model by the rule of the run leaves a remainder of order two."""
    model, outputs = built(name, element)
    outputs = [*outputs, "velocity(load)[0]", *HELD, "acceleration(load)[2]"]
    state = ancf.equilibrium(model)
    linear = ancf.linearise(model, about=state, outputs=outputs, inputs=["push"])
    step, steps = 4e-3, 60
    along = trapezoids(linear, step, steps)
    scale = np.abs(along).max(axis=0)
    sizes = (0.1, 0.05, 0.025)
    left = []
    for size in sizes:
        added = nonlinear(model, state, outputs, size, step, steps) - linear.outputs_at
        left.append(np.abs((added - size * along) / scale).max(axis=0))
    assert_of_second_order(np.array(left))


def test_it_is_that_of_scipy():
    """lsim, and exp(A t) after a while of a constant input."""
    model, outputs = built("hanging", "cable")
    linear = ancf.linearise(model, about=ancf.equilibrium(model), outputs=outputs, inputs=["push"], modes=3)
    system = linear.to_scipy()
    t = np.linspace(0.0, 1.5, 301)
    _, y, x = lsim(system, np.ones_like(t), t)
    A = np.block([[linear.A, linear.B], [np.zeros((1, 7))]])
    wanted = expm(1.5 * A)[:-1, -1]
    assert x[-1] == pytest.approx(wanted, rel=1e-8, abs=1e-9)
    assert y[-1] == pytest.approx(linear.C @ wanted + linear.D[:, 0], rel=1e-8, abs=1e-9)


def test_it_prints_and_is_kept():
    model, _ = built("hanging", "cable")
    named = {"sag [m]": "position(load)[2]", "product": "tension(rope.start)*position(load)[0]"}
    linear = ancf.linearise(model, about=ancf.equilibrium(model), outputs=named)
    assert repr(linear) == f"LinearModel(1 input, 2 outputs, {len(linear.A)} states)"
    assert "sag [m]" in str(linear)
    assert linear.output_units == ("m", "")
    assert linear.inputs_at == pytest.approx([0.3])
    state = linear.about
    wanted = state.position("load")[2], state.tension("rope.start") * state.position("load")[0]
    assert linear.outputs_at == pytest.approx(wanted)
    parts = ancf.linearise(
        model, about=state, outputs=["tension(rope.start)", "position(load)[0]"], inputs=["push"]
    )
    chain = parts.outputs_at[1] * parts.C[0] + parts.outputs_at[0] * parts.C[1]
    assert linear.C[1] == pytest.approx(chain, rel=1e-8)
    by_object = ancf.linearise(model, about=state, outputs=named, inputs=[model.inputs["push"]])
    assert by_object.frequency_response(0.0)[0] == pytest.approx(linear.frequency_response(0.0)[0], rel=1e-8)
    winched = driven(length=1.5, speed=None)  # has an input that acts on nothing as well
    assert ancf.linearise(winched, about=ancf.equilibrium(winched)).inputs == ("pay",)
    again = pickle.loads(pickle.dumps(linear))
    assert np.array_equal(again.A, linear.A)
    assert again.state(state) == pytest.approx(linear.state(state))


def test_inputs_of_a_run_go_on():
    """About a state of a run whose inputs were given, they have these values."""
    found = []
    for given in (0.3, 0.9):
        model, outputs = built("swimming", "cable", push=given)
        found.append(ancf.linearise(model, about=ancf.equilibrium(model), outputs=outputs, inputs=["stream"]))
    model, outputs = built("swimming", "cable")
    run = ancf.stepper(model, step=0.01, start=ancf.equilibrium(model))
    run.inputs["push"] = 0.9
    state = ancf.State(found[1].about.system, 0.0, found[1].about.q, 0.0 * found[1].about.v, None, run.known)
    now = ancf.linearise(model, about=state, outputs=outputs, inputs=["stream"])
    assert now.notes == []
    assert pytest.approx(found[1].C @ np.linalg.solve(found[1].A, found[1].B)) == now.C @ np.linalg.solve(
        now.A, now.B
    )


@pytest.mark.parametrize("scale", [1.7, 1.3e4])
def test_slopes_settle(scale):
    """Of straight lines at once, of curves with a smaller step, and beside what cannot be asked for."""

    def root(x):
        if 0.01 * scale + x < 0.0:
            raise ModelError("here", "no root")
        return np.array([np.sqrt(0.01 + x / scale), np.sin(3.0 * x / scale)])

    assert slope(root, scale) * scale == pytest.approx([5.0, 3.0], rel=5e-12)
    assert slope(lambda x: np.array([2.0 * x / scale + 1e3]), scale) * scale == pytest.approx(
        [2.0], rel=1e-12
    )
    for beside, error in ((1e2, 2e-10), (1e6, 1e-7)):  # round-off of which does not let it settle
        noisy = slope(lambda x, beside=beside: np.array([np.sin(3.1 * x / scale) + beside]), scale) * scale
        assert noisy == pytest.approx([3.1], rel=error)

    def none(x):
        raise ModelError("here", "never")

    with pytest.raises(ModelError, match="never"):
        slope(none, 1.0)


def test_inputs_leave_loads_as_they_are():
    """A moment and a following force of inputs have their first values again when matrices are made."""
    found = []
    for given in (("push", "turn"), ("turn", "push"), ()):
        model = ancf.Model()
        line = rope(model, (0, 0, 0), (1, 0, 0), "cable")
        model.clamp(line.start)
        push, turn = model.add_input("push", 0.4), model.add_input("turn", 0.02)
        model.add_follower_force(line.end, (-push, 0, 0))
        model.add_moment(line.end, (0, turn, 0))
        state = ancf.equilibrium(model)
        found.append(ancf.linearise(model, about=state, inputs=given).eigenvalues[:8])
    for mine in found[:2]:
        assert mine == pytest.approx(found[2], rel=1e-9)


@pytest.mark.parametrize("element", ["cable", "nonlocking"])
def test_moments_turn_with_the_load(element):
    """The moment of a clamp of a beam with a large force along it, beside differences of equilibria."""
    outputs = ["reaction_moment(wall)[0]", "reaction_moment(wall)[1]", "reaction_moment(wall)[2]"]

    def made(push):
        model = ancf.Model()
        line = rope(model, (0, 0, 0), (0.8, 0.1, 0.2), element)
        model.clamp(line.start, name="wall")
        u = model.add_input("push", push)
        model.add_force(line.end, (80.0, 3.0 * u, 2.0 - u))
        return model

    state = ancf.equilibrium(made(0.5))
    linear = ancf.linearise(made(0.5), about=state, outputs=outputs)
    h = 4e-3
    near, far = (
        np.array([answers(ancf.equilibrium(made(0.5 + s * d)), outputs) for s in (1, -1)]) for d in (h, 2 * h)
    )
    wanted = (8 * (near[0] - near[1]) - (far[0] - far[1])) / (12 * h)
    assert linear.frequency_response(0.0)[0, :, 0] == pytest.approx(wanted, rel=1e-6, abs=1e-8)


@pytest.mark.parametrize("damping", [0.0, 5.0])
def test_damping_is_part_of_an_output(damping):
    """Tension of a damped rope: strain and its rate, from places and from velocities."""
    model = ancf.Model()
    section = ancf.Section(EA=1e3, EI=0.1, rhoA=1e-3, axial_damping=damping)
    line = model.add_beam("rope", start=(0, 0, 0), end=(2, 0, 0), elements=2, section=section)
    model.clamp(line.start)
    load = model.add_point_mass("load", at=(2, 0, 0), mass=1.0)
    model.connect(line.end, load)
    model.hold(load, position="yz")
    model.add_force(load, (model.add_input("pull"), 0, 0))
    linear = ancf.linearise(model, outputs=["tension(rope.at(1))", "position(load)[0]", "velocity(load)[0]"])
    tension, place, speed = linear.frequency_response([0.3, 2.0])[:, :, 0].T
    assert tension == pytest.approx((1e3 * place + damping * speed) / 2.0, rel=2e-3)


@pytest.mark.parametrize("tension", [1e2, 1e7])
def test_forces_of_inputs_keep_their_digits(tension):
    """Small inputs beside large forces at rest."""
    model = ancf.Model()
    section = ancf.Section(EA=100.0 * tension, EI=0.5, rhoA=0.4)
    line = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section, length=0.98)
    model.pin(line.start)
    model.pin(line.end)
    turn = model.add_input("turn")
    model.add_force(line.at(0.49), (0.0, turn, 0.0))
    linear = ancf.linearise(model, about=ancf.equilibrium(model), outputs=["position(rope.at(0.49))[1]"])
    shape = linear.C[0, : len(linear.frequencies_hz)]
    pushed = linear.B[len(linear.frequencies_hz) :, 0]
    assert pushed == pytest.approx(
        shape, rel=1e-9, abs=1e-11
    )  # the place that is asked is the place of the force
