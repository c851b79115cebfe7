"""Linear state spaces beside damped modes, equilibria and simulations of the same models."""

import pickle

import numpy as np
import pytest
from scipy.linalg import expm
from scipy.signal import lsim

import ancf
from ancf.errors import ModelError, SolveError
from ancf.solvers.linear import all_modes, slope
from helpers import EXACT, SOLIDS, rate, square

DAMPED = {"damping": 0.06, "axial_damping": 2.0, "bending_damping": 0.01}


def rope(model, start, end, element="cable", elements=4, **given):
    section = square(element, EA=2e3, EI=0.8, rhoA=0.4, **DAMPED)
    return model.add_beam(
        "rope", start=start, end=end, elements=elements, section=section, element=element, **given
    )


def body(model, at, name="load"):
    return model.add_rigid_body(name, at=at, mass=1.5, inertia=(0.02, 0.03, 0.04))


def hanging(u, element, **held):
    """A body below a rope that is clamped aslant, on a spring to the ground."""
    line = rope(u, (0, 0, 0), (0.5, 0.1, -1.2), element)
    u.clamp(line.start, name="hook", **held)
    load = body(u, (0.6, 0.1, -1.3))
    u.connect(line.end, load.at(-0.1, 0, 0.1), name="pin")
    u.add_spring(load.at(0, 0.1, 0), (0.6, 1.0, -1.0), stiffness=8.0, damping=0.3, name="spring")
    return load, [
        "tension(rope.at(0.5))",
        "spring_force(spring)",
        "spring_length(spring)",
        "position(load)[2]",
    ]


def clamped(u, element, **held):
    """A body at the end of a beam, all of its directions held by it."""
    line = rope(u, (0, 0, 0), (0.9, 0.1, 0.05), element)
    u.clamp(line.start, name="hook", **held)
    load = body(u, (1.0, 0.1, 0.0))
    given = {"stretch": "free"} if element == "cable" else {}
    u.clamp(line.end, to=load, name="grip", **given)
    if element == "cable":
        u.add_spring(load.at(0, 0.1, 0), (1.0, 0.9, 0.4), stiffness=20.0, damping=0.4)
        u.add_spring(load.at(0, -0.1, 0), (1.0, -0.9, 0.4), stiffness=20.0, damping=0.4)
    return load, [
        "multiplier(grip)[2]",
        "joint_moment(grip)[1]",
        "position(load)[2]",
        "curvature(rope.at(0.3))",
    ]


def hinged(u, element, **held):
    """A pendulum of two bodies on hinges, with a torsion spring, at the end of a rope."""
    arm = body(u, (0.3, 0, -0.1), "arm")
    load = body(u, (0.75, 0, -0.3))
    u.hinge(arm.at(-0.3, 0, 0.1), (0, 0, 0), axis=(0, 1, 0), name="shoulder")
    u.hinge(arm.at(0.25, 0, -0.1), load.at(-0.2, 0, 0.1), axis=(0, 1, 0), name="elbow")
    u.add_torsion_spring(arm, load, axis=(0, 1, 0), stiffness=6.0, damping=0.2, name="knee")
    line = rope(u, (0.75, 0.0, -0.3), (1.9, 0.2, 0.3), element, natural_shape="straight", length=1.4)
    u.connect(line.start, load.centre, name="eye")
    u.clamp(line.end, name="hook", **held)
    return load, ["torsion_angle(knee)", "torsion_moment(knee)", "multiplier(elbow)[0]", "position(load)[0]"]


def sliding(u, element, **held):
    """A bead on a sagging wire, held by a spring."""
    line = rope(u, (0, 0, 0), (1.8, 0.1, 0.2), element, elements=6, length=1.83)
    u.pin(line.start, name="hook", **held)
    u.hold(line.end, position="yz", name="end")
    u.add_spring(line.end, (2.2, 0.1, 0.25), stiffness=200.0, damping=0.5)
    bead = u.add_point_mass("load", at=line.at(0.7).initial_position, mass=0.4)
    u.slide(bead, along=line, s=0.7, name="eye")
    u.add_spring(bead, (0.5, 0.1, -1.0), stiffness=30.0, damping=0.2, name="spring")
    u.add_spring(line.at(1.2), (1.2, 0.6, 0.3), stiffness=30.0, damping=0.2)
    return bead, ["arc_length(eye)", "normal_force(eye)[2]", "spring_force(spring)", "position(load)[0]"]


def swimming(u, element, **held):
    """A float on a rope in a current that is an input too."""
    section = ancf.Section(EA=2e3, EI=0.8, rhoA=0.4, diameter=0.03, drag=(1.2, 0.2), added_mass=(1.0, 0.1))
    line = u.add_beam("rope", start=(0, 0, 0), end=(0.6, 0, 1.4), elements=5, section=section)
    u.pin(line.start, name="hook", **held)
    stream = u.add_input("stream", 0.9, unit="m/s")
    u.add_fluid("sea", density=1000.0, velocity=(stream, 0.1, 0.0))
    load = u.add_point_mass("load", at=(0.6, 0, 1.4), mass=0.5)
    u.connect(line.end, load)
    u.add_force(load, (0, 0, 30.0))
    return load, ["position(load)[0]", "tension(rope.end)", "norm(position(load))"]


def following(u, element, **held):
    """A column below a force that turns with its end."""
    line = rope(u, (0, 0, 0), (0.05, 0, 1.0), element, elements=5)
    u.clamp(line.start, name="hook", **held)
    u.add_follower_force(line.end, (-0.7, 0.0, 0.0) if element == "cable" else (-0.7, 0.2, 0.1))
    load = u.add_point_mass("load", at=(0.05, 0, 1.0), mass=0.05)
    u.connect(line.end, load)
    return load, ["position(load)[0]", "tension(rope.at(0.2))", "bending_moment(rope.at(0.3))"]


BUILDS = {
    "hanging": hanging,
    "clamped": clamped,
    "hinged": hinged,
    "sliding": sliding,
    "swimming": swimming,
    "following": following,
}

#: Each with the elements that it has.
CASES = [
    (name, e)
    for name in BUILDS
    for e in ("cable", *SOLIDS)
    if e == "cable" or name not in ("sliding", "swimming")
]
ids = [f"{name}-{element}" for name, element in CASES]
cases = pytest.mark.parametrize(("name", "element"), CASES, ids=ids)


def built(name, element, push=0.3, **held):
    """A model whose load an input pushes, and questions that suit it; ``held``: what moves its hook."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    u = model.add_input("push", push, unit="N")
    load, outputs = BUILDS[name](model, element, **held)
    model.add_force(load, (u, 0.4 * u, -0.3 * u))
    return model, outputs


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


def answers(state, outputs):
    """Outputs of a state, by the model's own linear state space about it: their values there."""
    return ancf.linearise(state.model, about=state, outputs=outputs).outputs_at


HELD = ["reaction(hook)[0]", "reaction(hook)[2]"]
#: Supports of which a moment is asked.
CLAMPED = ("hanging", "clamped", "hinged", "following")


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


class Asked:
    """Answers of a run for formulas."""

    def __init__(self, run):
        self.run = run

    def value(self, name):
        raise AssertionError(name)

    def ask(self, quantity, item):
        return getattr(self.run, quantity)(item)


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


def assert_of_second_order(left, least=1e-7):
    """Remainders (sizes, outputs) at halved sizes fall with the square, where round-off lets them be seen."""
    orders = np.array([rate(column)[-1] for column in left.T])
    seen = left[-1] > least
    assert seen.sum() >= 0.5 * len(seen), left[-1]
    assert np.all(np.abs(orders[seen] - 2.0) < 0.05), orders


def given_motion(times):
    """A smooth start from rest, its rate and second rate."""
    w = 7.0
    c, si = np.cos(w * times), np.sin(w * times)
    return np.array([(1 - c) ** 2, 2 * w * si * (1 - c), 2 * w**2 * (c - c**2 + si**2)]).T


def by_rule(linear, order, motion, step, gain=1.0):
    """Outputs (steps + 1, outputs) by the trapezoidal rule where s, s' and s'' (steps + 1, 3) are given.

    The rule is that of the unknowns: z = p + g s, where the modes follow a support that moves at rest.
    """
    count, first = len(linear.frequencies_hz), linear.states.index("rate of mode 1")
    rows, B = linear.A[first : first + count], linear.B[:, 0]
    m, g = -B[:count] / gain, -linear.reading.of_q[:count, -1]
    K, D = rows[:, :count], rows[:, first : first + count]

    def beside(s, ds, dds):
        u = (dds if order == 2 else ds) / gain
        more = rows[:, -1] * ds if order == 2 else 0.0
        own = rows[:, count] * s + D @ (m * ds) + more + B[first : first + count] * u - m * dds
        return own - K @ g * s - D @ g * ds + g * dds

    z, dz, found = np.zeros(count), np.zeros(count), []
    ddz = beside(*motion[0])
    inverse = np.linalg.inv(np.eye(count) - 0.25 * step**2 * K - 0.5 * step * D)
    for k, given in enumerate(motion):
        s, ds, dds = given
        if k:
            z, dz = z + step * dz + 0.25 * step**2 * ddz, dz + 0.5 * step * ddz
            ddz = inverse @ (K @ z + D @ dz + beside(*given))
            z, dz = z + 0.25 * step**2 * ddz, dz + 0.5 * step * ddz
        x = np.concatenate([z - g * s, [s], dz - g * ds + m * ds, [ds] if order == 2 else []])
        found.append(linear.C @ x + linear.D[:, 0] * (dds if order == 2 else ds) / gain)
    return np.array(found)


MOVED = [
    ("hanging", "cable"),
    ("hanging", "nonlocking"),
    ("hinged", "cable"),
    ("clamped", "original"),
    ("sliding", "cable"),
]


@pytest.mark.parametrize("axis", [0, 2])
@pytest.mark.parametrize(("name", "element"), MOVED)
def test_a_support_that_moves(name, element, axis):
    """Acceleration and velocity of a support as inputs: the remainder of runs is of order two."""
    step, steps = 4e-3, 50
    motion = given_motion(step * np.arange(steps + 1))
    model, outputs = built(name, element)
    by_forces = ("multiplier", "joint_moment", "normal_force")
    smooth = [*(text for text in outputs if not text.startswith(by_forces)), "velocity(load)[0]"]
    inertial = [text for text in outputs if text not in smooth]
    inertial += ["reaction(hook)[2]", "acceleration(load)[2]"]
    state = ancf.equilibrium(model)
    quick = ancf.linearise(model, about=state, outputs=smooth, inputs=[f"velocity(hook)[{axis}]"])
    linear = ancf.linearise(
        model, about=state, outputs=[*smooth, *inertial], inputs=[f"acceleration(hook)[{axis}]"]
    )
    for text in inertial:
        with pytest.raises(ModelError, match="depends on how fast"):
            ancf.linearise(model, about=state, outputs=[text], inputs=[f"velocity(hook)[{axis}]"])
    along = by_rule(linear, 2, motion, step)
    mine = along[:, : len(smooth)]
    scale = np.abs(mine).max(axis=0)
    np.testing.assert_allclose(by_rule(quick, 1, motion, step) / scale, mine / scale, rtol=0, atol=1e-8)
    formulas = ancf.design.linear_outputs.formulas_of(model, [*smooth, *inertial])
    left = []
    for size in (1e-3, 5e-4):
        shift = [0.0, 0.0, 0.0]
        shift[axis] = f"{size!r}*(1 - cos(7*t))**2"
        moving, _ = built(name, element, displacement=shift)
        run = ancf.stepper(moving, step=step, start=state, integrator=ancf.Trapezoidal(newton=EXACT))
        found = [linear.outputs_at]
        for _ in range(steps):
            run.advance()
            found.append([formula(Asked(run)) for formula in formulas.values()])
        left.append(
            np.max(np.abs(found - linear.outputs_at - size * along), axis=0) / np.abs(along).max(axis=0)
        )
    assert_of_second_order(np.array(left), 2e-8)


@pytest.mark.parametrize("at_start", [True, False])
@pytest.mark.parametrize("factor", [1.0, -0.5])
def test_a_winch_that_follows_a_speed(at_start, factor):
    """The speed of a winch as an input, also of a formula of inputs."""
    step, steps = 2e-3, 100
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=2e3, EI=0.05, rhoA=0.3, damping=0.05, axial_damping=4.0)
    ends = [(0.0, 0.0, 0.0), (0.0, 0.0, -1.5)]
    start, end = ends if at_start else ends[::-1]
    line = model.add_beam("rope", start=start, end=end, elements=4, section=section)
    top, low = (line.start, line.end) if at_start else (line.end, line.start)
    load = model.add_point_mass("load", at=ends[1], mass=2.0)
    model.connect(low, load)
    model.pin(top, name="hook")
    model.add_spring(load, (0.7, 0.2, -1.6), stiffness=25.0, damping=0.1, name="spring")
    pay = model.add_input("pay", 0.0, unit="m/s")
    model.winch(top, length=1.5, speed=factor * pay, acceleration=1e9, name="drum")
    state = ancf.equilibrium(model)
    outputs = ["position(load)[2]", "velocity(load)[2]", "tension(rope.at(0.7))", "spring_force(spring)"]
    linear = ancf.linearise(model, about=state, outputs=outputs)
    assert linear.states[len(linear.frequencies_hz)] == "length of drum"
    formulas = ancf.design.linear_outputs.formulas_of(model, outputs)
    w = factor * given_motion(step * np.arange(steps + 1))[:, 0]
    dw = np.concatenate([[0.0], np.diff(w) / step])
    s = np.concatenate([[0.0], np.cumsum(0.5 * step * (w[1:] + w[:-1]))])
    along = by_rule(linear, 1, np.array([s, w, dw]).T, step, factor)
    left = []
    for size in (0.02, 0.01):
        run = ancf.stepper(model, step=step, start=state, integrator=ancf.Trapezoidal(newton=EXACT))
        found = [linear.outputs_at]
        for k in range(steps):
            run.inputs["pay"] = size * w[k + 1] / factor
            run.advance()
            found.append([formula(Asked(run)) for formula in formulas.values()])
        left.append(
            np.max(np.abs(found - linear.outputs_at - size * along), axis=0) / np.abs(along).max(axis=0)
        )
    assert_of_second_order(np.array(left), 2e-8)


READ = [("hanging", "cable"), ("hinged", "nonlocking"), ("clamped", "original"), ("sliding", "cable")]


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


def driven(**given):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=2e3, EI=0.05, rhoA=0.3)
    line = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -1.5), elements=3, section=section)
    model.pin(line.start, name="hook")
    pay = model.add_input("pay", given.pop("first", 0.0))
    model.add_input("idle", 0.0)
    given = {key: (pay if value is None else value) for key, value in given.items()}
    model.winch(line.start, acceleration=1.0, name="drum", **given)
    return model


def refused(model, match, error=ModelError, **given):
    about = given.pop("about", None) or ancf.equilibrium(model)
    with pytest.raises(error, match=match):
        ancf.linearise(model, about=about, **given)


@pytest.mark.parametrize(
    ("inputs", "match"),
    [
        (["pusch"], r"linearise\.inputs\[0\]: unknown input 'pusch', known: \"push\" .did you mean"),
        ("push", "must be a list of inputs, is 'push'"),
        ({"push": 1.0}, "must be a list of inputs"),
        ([3.0], r"inputs\[0\]: must be the name of an input or a motion of a support, is 3.0"),
        (["push", "push"], r'inputs\[1\]: "push" is an input already'),
        (["velocity(hok)[0]"], "unknown support 'hok', known: \"hook\""),
        (["position(hook)[0]"], '"position" is no motion that can be an input'),
        (["acceleration(end)[0]"], '"end" does not hold x'),
        (["velocity(hook)[2]", "acceleration('hook')[2]"], 'moves "hook" along z, which another input does'),
        (["rotation(hook)"], "unknown input 'rotation.hook.'.*motions of supports are such as"),
    ],
)
def test_wrong_inputs(inputs, match):
    model, _ = built("sliding", "cable")
    refused(model, match, inputs=inputs)


@pytest.mark.parametrize(
    ("given", "inputs", "match"),
    [
        ({"length": None, "speed": 0.5, "first": 1.5}, ["pay"], '"pay" is the length to which "drum" goes'),
        ({"length": 1.5, "speed": None, "first": 0.1}, ["pay"], '"drum" goes with 0.1 m/s'),
        ({"length": 1.5, "speed": None}, ["idle"], '"idle" acts on nothing'),
        ({"length": 1.5, "speed": None}, ["velocity(drum)[0]"], "unknown support 'drum'"),
    ],
)
def test_wrong_inputs_of_winches(given, inputs, match):
    refused(driven(**given), match, inputs=inputs)


@pytest.mark.parametrize(
    ("outputs", "match"),
    [
        (["position(load)"], r"outputs\[0\]: .*gives numbers of shape \(3,\), must give one number"),
        (["position(laod)[0]"], r"position\(laod\): .*did you mean \"load\""),
        (["tension(load)"], "a point mass has no strains, forces or slopes"),
        (["positoin(load)[0]"], 'unknown name "positoin"'),
        (["t"], 'unknown name "t"'),
        (["speed(load)"], r"speed\(load\) has no linear part .*velocity"),
        ("position(load)[0]", "must be a list of formulas or a dict"),
        ([None], r"outputs\[0\]: must be a formula, is None"),
        ({"x": 3.0}, r'outputs\["x"\]: must be a formula, is 3.0'),
        (["position(load)[0]", "position(load)[0]"], "is an output already"),
        (["acceleration(eye)[0]"], r"is asked of a point"),
        (["norm(velocity(load))"], r'\["?0"?\]: "norm.velocity.load.." has a kink'),
        (["1/(position(load)[0] - position(load)[0])"], "must be a finite number"),
    ],
)
def test_wrong_outputs(outputs, match):
    model, _ = built("sliding", "cable")
    refused(model, match, outputs=outputs)


def test_kinks_are_refused():
    """The curvature of what is straight, and a spring that is just slack."""
    model = ancf.Model()
    section = ancf.Section(EA=2e3, EI=0.5, rhoA=0.3)
    line = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section)
    model.clamp(line.start)
    model.add_force(line.end, (0, model.add_input("push", 0.0), 0))
    model.add_spring(line.end, (1, 1, 0), stiffness=10.0, length=1.0, slack=True, name="tie")
    refused(
        model, r"outputs\[0\]: curvature\(rope.at\(0.4\)\) has a kink", outputs=["curvature(rope.at(0.4))"]
    )
    refused(model, r"spring_force\(tie\) has a kink", outputs=["spring_force(tie)"])
    ancf.linearise(model, outputs=["spring_length(tie)", "tension(rope.at(0.4))", "position(rope.end)[1]"])


def test_states_that_move_are_refused():
    model, _ = built("hanging", "cable")
    run = ancf.stepper(model, step=0.01, start=ancf.equilibrium(model))
    run.inputs["push"] = 2.0
    run.advance(5)
    refused(model, "the state moves, ", SolveError, about=run.state())
    turning = ancf.Model()
    shaft = rope(turning, (0, 0, 0), (1, 0, 0), "nonlocking")
    turning.pin(shaft.start)
    turning.hold(shaft.end, position="yz")
    shaft.set_motion(angular_velocity=(5.0, 0, 0))
    with pytest.raises(SolveError, match=r"the state moves.*damped_modes has the modes"):
        ancf.linearise(turning)
    pushed, _ = built("hanging", "cable", displacement=("0.1*t", 0, 0))
    with pytest.raises(SolveError, match="the state moves"):
        ancf.linearise(pushed, about=ancf.equilibrium(pushed))


def test_what_is_no_equilibrium_is_said():
    model, outputs = built("hanging", "cable")
    with pytest.raises(ModelError, match=r"linearise\.about: the initial shape is no equilibrium"):
        ancf.linearise(model)
    other, _ = built("hanging", "cable", push=3.0)
    moved = ancf.linearise(model, about=ancf.equilibrium(other), outputs=outputs)
    assert "the state is no equilibrium" in moved.notes[0]
    assert moved.notes[0][:50] in str(moved)
    with pytest.raises(ModelError, match=r"linearise.about: must be a State"):
        ancf.linearise(model, about="rest")
    with pytest.raises(ModelError, match="state of another model"):
        ancf.linearise(model, about=ancf.equilibrium(built("sliding", "cable")[0]))


def test_what_is_too_large_or_has_no_mass_is_refused():
    model = ancf.Model()
    section = ancf.Section(EA=2e3, EI=0.5, rhoA=0.3)
    line = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=260, section=section)
    model.clamp(line.start)
    with pytest.raises(SolveError, match=r"linearise: 15\d\d unknowns, the most are 1500"):
        ancf.linearise(model)


@pytest.mark.parametrize(
    ("modes", "match"),
    [
        (0, r"linearise\.modes"),
        (1.5, r"linearise\.modes"),
        (1000, r"linearise\.modes"),
        (1, "2 motions have no stiffness"),
    ],
)
def test_wrong_numbers_of_modes(modes, match):
    model = ancf.Model()
    free = model.add_point_mass("free", at=(0, 0, 0), mass=1.0)
    model.hold(free, position="z")
    other = model.add_point_mass("other", at=(1, 0, 0), mass=1.0)
    model.hold(other, position="yz")
    model.add_spring(other, (2, 0, 0), stiffness=3.0)
    with pytest.raises(ModelError, match=match):
        ancf.linearise(model, modes=modes)
    linear = ancf.linearise(model, modes=2)
    assert linear.frequencies_hz == pytest.approx([0.0, 0.0])
    assert np.all(linear.eigenvalues == 0.0)


def test_wrong_frequencies_and_states():
    model = ancf.Model()
    free = model.add_point_mass("free", at=(0, 0, 0), mass=1.0)
    model.hold(free, position="yz", name="rail")
    model.add_force(free, (model.add_input("push"), 0, 0))
    linear = ancf.linearise(model, outputs=["position(free)[0]"])
    with pytest.raises(ModelError, match="at 0 Hz it is infinite"):
        linear.frequency_response([0.0])
    with pytest.raises(ModelError, match=r"frequency_response\.f\[1\]"):
        linear.frequency_response([1.0, -1.0])
    assert linear.frequency_response(2.0)[0, 0, 0] == pytest.approx(-1.0 / (4.0 * np.pi) ** 2)
    with pytest.raises(ModelError, match="state: must be a State or a run, is 3"):
        linear.state(3)
    with pytest.raises(ModelError, match="state of another model"):
        linear.state(ancf.equilibrium(built("sliding", "cable")[0]))


def test_what_joints_hold_cannot_be_moved():
    """A hook on a rail that a joint to the ground holds as well."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    base = body(model, (0, 0, 0), "base")
    model.hold(base, position="xyz", name="hook")
    model.connect(base.at(0.2, 0, 0), (0.2, 0, 0))
    refused(model, "cannot move: joints hold it", inputs=["acceleration(hook)[0]"])


def test_a_hanging_body_turns_freely():
    """About the line of a rope nothing resists: the double zero is exact, other modes keep their digits."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.2, damping=0.1)
    line = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -2), elements=6, section=section)
    model.pin(line.start)
    load = body(model, (0, 0, -2.2))
    model.connect(line.end, load.at(0, 0, 0.2))
    state = ancf.equilibrium(model)
    linear = ancf.linearise(model, about=state)
    assert linear.frequencies_hz[0] == 0.0
    assert np.all(np.abs(linear.eigenvalues[:2]) < 1e-12)
    wanted = ancf.modes(model, about=state, count=12).frequencies_hz
    assert linear.frequencies_hz[1:12] == pytest.approx(wanted[1:], rel=1e-9)


@pytest.mark.parametrize("stiffness", [1e3, 1e7])
@pytest.mark.parametrize("element", ["cable", "nonlocking"])
def test_low_modes_keep_their_digits(element, stiffness):
    """Of a body on soft springs at a beam that is stiff: M x = mu K x, with the highest mode far above."""
    model = ancf.Model()
    section = square(element, EA=stiffness, EI=stiffness * 1e-4, rhoA=0.4)
    line = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=6, section=section, element=element
    )
    for k, point in enumerate((line.start, line.at(0.5), line.end)):
        for c in np.eye(3):
            model.add_spring(point, point.initial_position + 2.0 * c, stiffness=2e-3 + 1e-4 * k)
    wanted = ancf.modes(model, count=5).frequencies_hz
    linear = ancf.linearise(model)
    low = wanted > 1e-2  # the twist is neutral
    assert np.sum(low) >= 4
    assert linear.frequencies_hz[:5][low] == pytest.approx(wanted[low], rel=1e-8)


def test_modes_are_orthogonal():
    rng = np.random.default_rng(3)
    scale = 10.0 ** np.linspace(0.0, 5.0, 40)
    Q = np.linalg.qr(rng.standard_normal((40, 40)))[0]
    M = np.diag(1.0 + rng.random(40))
    K = np.sqrt(M) @ (Q * scale**2) @ Q.T @ np.sqrt(M)
    values, vectors = all_modes(0.5 * (K + K.T), M)
    np.testing.assert_allclose(vectors.T @ M @ vectors, np.eye(40), rtol=0, atol=1e-13)
    assert values == pytest.approx(scale**2, rel=1e-6)


def test_a_body_on_two_supports_follows_one():
    """A rigid bar between two carriages, one of which is moved: the other end stays, the middle goes half."""
    model = ancf.Model()
    bar = model.add_rigid_body("bar", at=(0, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.2))
    ends = [
        model.add_point_mass(name, at=(x, 0, 0), mass=1.0) for name, x in (("left", -1.0), ("right", 1.0))
    ]
    for end, x in zip(ends, (-1.0, 1.0), strict=True):
        model.connect(end, bar.at(x, 0, 0))
    model.pin(ends[0], name="fixed")
    model.hold(ends[1], position="yz", name="moved")
    model.add_torsion_spring(bar, (0, 0, 0), axis=(1, 0, 0), stiffness=2.0)
    linear = ancf.linearise(
        model,
        inputs=["acceleration(moved)[2]"],
        outputs=["position(bar)[2]", "reaction(moved)[2]", "acceleration(bar)[2]"],
    )
    hz = np.array([0.3, 2.0])
    found = linear.frequency_response(hz)[:, :, 0]
    s = -1.0 / (2 * np.pi * hz) ** 2
    wanted = np.array([0.5 * s, 1.0 + 0.5 + 0.05 + 0.0 * s, 0.5 + 0.0 * s]).T  # 1 + m/4 + I/4
    np.testing.assert_allclose(found, wanted, rtol=1e-9)


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


@pytest.mark.parametrize("heavy", [1.0, 1e12])
@pytest.mark.parametrize("stiffness", [1e4, 1e9])
def test_stiff_beams_turn_freely(stiffness, heavy):
    """The twist of a stiff beam on two pins is neutral, however large the stiffnesses that cancel in it.

    A heavy mass beside it makes the mean frequency small, of which the zero is no share then.
    """
    model = ancf.Model()
    section = square("nonlocking", EA=stiffness, EI=1e-3 * stiffness, rhoA=0.5)
    line = model.add_beam(
        "beam", start=(0, 0, 0), end=(0.6, 0.5, 0.7), elements=4, section=section, element="nonlocking"
    )
    model.pin(line.start)
    model.pin(line.end)
    far = model.add_point_mass("far", at=(5, 0, 0), mass=heavy)
    model.hold(far, position="yz")
    model.add_spring(far, (6, 0, 0), stiffness=heavy)
    linear = ancf.linearise(model)
    assert linear.frequencies_hz[0] == 0.0
    assert linear.frequencies_hz[1] == pytest.approx(1.0 / (2 * np.pi), rel=1e-9)
    assert np.abs(linear.eigenvalues[:2]).max() < 1e-9


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


def test_reaction_beside_a_winch():
    """The pin of a rope that a winch pays out carries the load and what more of the rope weighs."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=2e5, EI=0.05, rhoA=0.3, damping=0.05, axial_damping=40.0)
    line = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -1.5), elements=4, section=section)
    load = model.add_point_mass("load", at=(0, 0, -1.5), mass=2.0)
    model.connect(line.end, load)
    model.pin(line.start, name="hook")
    pay = model.add_input("pay", 0.0, unit="m/s")
    model.winch(line.start, length=1.5, speed=pay, acceleration=1e9, name="drum")
    state = ancf.equilibrium(model)
    with pytest.raises(ModelError, match=r'"reaction.hook..2." depends on how fast "pay" changes'):
        ancf.linearise(model, about=state, outputs=["reaction(hook)[2]"])
    linear = ancf.linearise(model, about=state, outputs=["tension(rope.start)", "position(load)[2]"])
    tension, place = linear.frequency_response([1e-3])[0, :, 0] * (2j * np.pi * 1e-3)  # per metre
    assert place == pytest.approx(-1.0, rel=1e-3)
    assert tension == pytest.approx(0.3 * 9.81, rel=2e-2)
