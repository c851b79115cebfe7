"""Clamps that turn and slides that are led as inputs of a linear model, beside equilibria and runs."""

import numpy as np
import pytest
from linear_cases import (
    Asked,
    answers,
    assert_of_second_order,
    body,
    built,
    by_rule,
    given_motion,
    refused,
    rope,
)

import ancf
from ancf.errors import ModelError
from helpers import EXACT, SOLIDS

STEP, STEPS = 4e-3, 50
MOTION = given_motion(STEP * np.arange(STEPS + 1))
AXES = "xyz"


ARM = "position(arm)[0] + position(arm)[1] + position(arm)[2]"


def hub(element, **held):
    """A body that a clamp turns, with a beam clamped to it beside its centre, and a body on a hinge."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    base = body(model, (-0.2, 0.1, 0.1), "base")
    model.clamp(base, name="hook", **held)
    line = rope(model, (0, 0, 0), (0.5, 0.1, -1.0), element)
    model.clamp(line.start, to=base, name="grip", **({"stretch": "free"} if element == "cable" else {}))
    load = body(model, (0.6, 0.1, -1.1))
    model.connect(line.end, load.at(-0.1, 0, 0.1), name="pin")
    arm = body(model, (-0.5, 0, -0.4), "arm")
    model.hinge(arm.at(0.3, 0, 0.3), base.at(0, -0.1, -0.2), axis=(0, 1, 0), name="elbow")
    model.add_spring(load.at(0, 0.1, 0), (0.6, 1.0, -1.0), stiffness=8.0, damping=0.3, name="spring")
    return model, ["tension(rope.at(0.5))", "spring_force(spring)", "multiplier(grip)[1]", ARM]


def made(name, element, **held):
    return hub(element, **held) if name == "hub" else built(name, element, **held)


#: Family, element, how its clamp holds it, axes.
TURNED = [
    ("hanging", "cable", {}, (0, 1, 2)),
    ("hanging", "cable", {"stretch": "fixed"}, (1,)),
    *(("hanging", element, {}, (0, 2)) for element in SOLIDS),
    *(("hanging", element, {"stretch": "fixed"}, (1,)) for element in SOLIDS),
    ("clamped", "cable", {}, (1,)),
    *(("clamped", element, {}, (0, 1)) for element in SOLIDS),
    ("following", "cable", {}, (1,)),
    ("following", "nonlocking", {}, (2,)),
    ("hinged", "cable", {}, (2,)),
]
HUBS = [("hub", element, {}, (0, 1, 2)) for element in ("cable", *SOLIDS)]


def each(turned):
    """Every axis of every case."""
    cases = [(name, element, held, axis) for name, element, held, axes in turned for axis in axes]
    ids = [
        f"{name}-{element}-{held.get('stretch', 'free')}-{AXES[axis]}" for name, element, held, axis in cases
    ]
    return pytest.mark.parametrize(("name", "element", "held", "axis"), cases, ids=ids)


MOMENTS = [f"reaction_moment(hook)[{c}]" for c in range(3)]


def about(axis, angle):
    """A rotation vector of functions of time."""
    return [angle if c == axis else 0.0 for c in range(3)]


def remainders(linear, formulas, along, moving, sizes):
    """What runs add beside the linear model, per largest change: (sizes, outputs); ``moving`` by the size."""
    left = []
    for size in sizes:
        run = ancf.stepper(
            moving(size), step=STEP, start=linear.about, integrator=ancf.Trapezoidal(newton=EXACT)
        )
        found = [linear.outputs_at]
        for _ in range(STEPS):
            run.advance()
            found.append([formula(Asked(run)) for formula in formulas.values()])
        added = np.max(np.abs(found - linear.outputs_at - size * along), axis=0)
        left.append(added / np.abs(along).max(axis=0))
    return np.array(left)


@each(TURNED)
def test_a_clamp_that_turns(name, element, held, axis):
    """Its angular acceleration and velocity as inputs: the remainder of runs is of order two."""
    model, outputs = made(name, element, **held)
    by_forces = ("multiplier", "joint_moment")
    smooth = [*(text for text in outputs if not text.startswith(by_forces)), "velocity(load)[0]"]
    inertial = [text for text in outputs if text not in smooth]
    inertial += ["reaction(hook)[0]", "acceleration(load)[2]", *MOMENTS]
    state = ancf.equilibrium(model)
    quick = ancf.linearise(model, about=state, outputs=smooth, inputs=[f"angular_velocity(hook)[{axis}]"])
    every = [*smooth, *inertial]
    given = [f"angular_acceleration(hook)[{axis}]"]
    linear = ancf.linearise(model, about=state, outputs=every, inputs=given)
    count = len(linear.frequencies_hz)
    assert (linear.states[count], linear.state_units[count]) == (f"turn of hook {AXES[axis]}", "rad")
    assert (linear.states[-1], linear.state_units[-1]) == (f"rate of turn of hook {AXES[axis]}", "rad/s")
    assert (linear.input_units, quick.input_units) == (("rad/s^2",), ("rad/s",))
    along = by_rule(linear, 2, MOTION, STEP)
    scale = np.abs(along).max(axis=0)
    assert np.all(scale > 1e-9)
    mine = along[:, : len(smooth)] / scale[: len(smooth)]
    np.testing.assert_allclose(
        by_rule(quick, 1, MOTION, STEP) / scale[: len(smooth)], mine, rtol=0, atol=1e-7
    )

    def moving(size):
        return made(name, element, rotation_vector=about(axis, f"{size!r}*(1 - cos(7*t))**2"), **held)[0]

    formulas = ancf.design.linear_outputs.formulas_of(model, every)
    assert_of_second_order(remainders(linear, formulas, along, moving, (1e-3, 5e-4)), 3e-8)


@each(HUBS)
def test_bodies_on_joints_of_a_body_that_turns(name, element, held, axis):
    """Beside runs, extrapolated to steps of no length: joints lead them by the rule of the run."""
    model, outputs = made(name, element, **held)
    outputs = [*outputs, "velocity(load)[0]", "reaction(hook)[0]", "acceleration(load)[2]", *MOMENTS]
    state = ancf.equilibrium(model)
    given = [f"angular_acceleration(hook)[{axis}]"]
    linear = ancf.linearise(model, about=state, outputs=outputs, inputs=given)
    fine = 16
    wanted = by_rule(linear, 2, given_motion(STEP / fine * np.arange(fine * STEPS + 1)), STEP / fine)[::fine]
    formulas = ancf.design.linear_outputs.formulas_of(model, outputs)

    def added(size, part):
        moving = made(name, element, rotation_vector=about(axis, f"{size!r}*(1 - cos(7*t))**2"), **held)[0]
        run = ancf.stepper(moving, step=STEP / part, start=state, integrator=ancf.Trapezoidal(newton=EXACT))
        found = []
        for _ in range(STEPS):
            run.advance(part)
            found.append([formula(Asked(run)) for formula in formulas.values()])
        return np.array(found)

    size = 1e-4
    far, near = ((added(size, part) - added(-size, part)) / (2 * size) for part in (1, 2))
    scale = np.abs(wanted).max(axis=0)
    assert np.all(scale > 1e-6)
    found = (4 * near - far) / 3
    np.testing.assert_allclose(found / scale, wanted[1:] / scale, rtol=0, atol=5e-4)


@pytest.mark.parametrize("step", [2e-3, 1e-3, 5e-4, 2e-4])
@each(HUBS)
def test_full_newton_steps_end_at_round_off(name, element, held, axis, step):
    """With a tolerance that is less than the round-off of a correction, from the first step on."""
    state = ancf.equilibrium(made(name, element, **held)[0])
    moving = made(name, element, rotation_vector=about(axis, "1e-3*(1 - cos(7*t))**2"), **held)[0]
    method = ancf.Trapezoidal(newton=EXACT)
    result = ancf.simulate(moving, t_end=60 * step, step=step, start=state, integrator=method)
    assert result.stats.retries == 0
    looser = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-12, modified=False))
    other = ancf.simulate(moving, t_end=60 * step, step=step, start=state, integrator=looser)
    kept = np.setdiff1d(np.arange(result.system.size), result.system.multipliers)
    assert result.q[:, kept] == pytest.approx(other.q[:, kept], abs=1e-9)


@each(TURNED + HUBS)
def test_static_gain_of_a_turn_is_that_of_equilibria(name, element, held, axis):
    """Where all stands still after a turn, beside extrapolated differences of equilibria."""
    outputs = [*made(name, element, **held)[1], "reaction(hook)[2]", *MOMENTS]
    model = made(name, element, **held)[0]
    linear = ancf.linearise(
        model, about=ancf.equilibrium(model), outputs=outputs, inputs=[f"angular_acceleration(hook)[{axis}]"]
    )
    count = len(linear.frequencies_hz)
    first = linear.A[count + 1 : 2 * count + 1]
    rest = np.linalg.solve(first[:, :count], -first[:, count])
    gain = linear.C[:, :count] @ rest + linear.C[:, count]

    def at(angle):
        turning = made(name, element, rotation_vector=about(axis, angle), **held)[0]
        return answers(ancf.equilibrium(turning), outputs)

    h = 4e-3
    near, far = ((at(d) - at(-d)) / (2 * d) for d in (h, 2 * h))
    wanted = (4 * near - far) / 3
    assert np.abs(wanted).max() > 1e-3
    np.testing.assert_allclose(gain, wanted, rtol=1e-5, atol=1e-7 * np.abs(wanted).max())


@pytest.mark.parametrize("word", ["rotation", "rotation_vector"])
@pytest.mark.parametrize("element", ["cable", *SOLIDS])
def test_a_clamp_that_is_turned_already(element, word):
    """About a state whose clamp is turned far, and goes on about another axis."""
    turn, way = (0.3, 0.8, -0.2), (0.0, 0.0, 1.0)
    angle = float(np.linalg.norm(turn))
    here = {"rotation": angle, "axis": turn} if word == "rotation" else {"rotation_vector": turn}
    outputs = [*built("hanging", element)[1], *MOMENTS]
    model = built("hanging", element, **here)[0]
    linear = ancf.linearise(
        model, about=ancf.equilibrium(model), outputs=outputs, inputs=["angular_acceleration(hook)[2]"]
    )
    count = len(linear.frequencies_hz)
    first = linear.A[count + 1 : 2 * count + 1]
    gain = linear.C[:, :count] @ np.linalg.solve(first[:, :count], -first[:, count]) + linear.C[:, count]

    def at(by):
        from scipy.spatial.transform import Rotation

        both = Rotation.from_rotvec(np.multiply(by, way)) * Rotation.from_rotvec(turn)
        turning = built("hanging", element, rotation_vector=both.as_rotvec().tolist())[0]
        return answers(ancf.equilibrium(turning), outputs)

    h = 4e-3
    near, far = ((at(d) - at(-d)) / (2 * d) for d in (h, 2 * h))
    wanted = (4 * near - far) / 3
    np.testing.assert_allclose(gain, wanted, rtol=1e-5, atol=1e-7 * np.abs(wanted).max())


@pytest.mark.parametrize("moves", [True, False])
@pytest.mark.parametrize("word", ["velocity", "acceleration"])
@pytest.mark.parametrize(
    ("name", "element", "axis"),
    [("hanging", "cable", 1), ("hanging", "nonlocking", 0), ("clamped", "original", 2), ("hub", "cable", 1)],
)
def test_states_of_a_run_whose_clamp_turns(name, element, axis, word, moves):
    """The turn is among the states, also of a linear model of the same clamp at rest."""
    size, w = 1e-4, 7.0
    moving = made(name, element, rotation_vector=about(axis, f"{size}*sin({w}*t)**2"))[0]
    model = moving if moves else made(name, element)[0]
    outputs, given = ["position(load)[0]", "velocity(load)[2]"], [f"angular_{word}(hook)[{axis}]"]
    state = ancf.equilibrium(moving)
    linear = ancf.linearise(model, about=ancf.equilibrium(model), outputs=outputs, inputs=given)
    run = ancf.stepper(moving, step=2e-3, start=state)
    run.advance(60)
    x, angle = linear.state(run), w * run.t
    s, ds = size * np.sin(angle) ** 2, size * w * np.sin(2 * angle)
    assert x[len(linear.frequencies_hz)] == pytest.approx(s, rel=1e-5)
    if word == "acceleration":
        assert x[-1] == pytest.approx(ds, rel=1e-4)
    added = run.position("load")[0] - linear.outputs_at[0], run.velocity("load")[2]
    seen = linear.C @ x + linear.D[:, 0] * (ds if word == "velocity" else 0.0)
    assert seen == pytest.approx(added, rel=2e-3, abs=2e-3 * np.abs(added).max())


def test_states_of_a_model_whose_bodies_came_in_another_order():
    """They are found by their names."""
    made_of = []
    for names in (("a", "b"), ("b", "a")):
        model = ancf.Model()
        for name in names:
            x = {"a": 0.0, "b": 1.0}[name]
            mass = model.add_point_mass(name, at=(x, 0, 0), mass=1.0 + x)
            for c in np.eye(3):
                model.add_spring(mass, np.array([x, 0, 0]) + c, stiffness=5.0 + 2.0 * x)
        made_of.append(model)
    made_of[1].bodies["a"].set_motion(velocity=(0.3, 0.0, 0.1))
    linear = ancf.linearise(made_of[0], outputs=["position(a)[0]", "velocity(a)[2]", "velocity(b)[0]"])
    run = ancf.stepper(made_of[1], step=1e-3)
    run.advance(20)
    wanted = run.position("a")[0], run.velocity("a")[2], run.velocity("b")[0]
    assert linear.C @ linear.state(run) == pytest.approx(wanted, rel=1e-3, abs=1e-9)


def test_three_turns_of_a_cable_are_two():
    """What a cable does not feel of three turns at once has no effect, and is read as the least of them."""
    model, _ = built("hanging", "cable")
    state = ancf.equilibrium(model)
    outputs = ["position(load)[0]", "position(load)[1]", "reaction_moment(hook)[2]"]
    given = [f"angular_acceleration(hook)[{c}]" for c in range(3)]
    linear = ancf.linearise(model, about=state, outputs=outputs, inputs=given)
    along = np.array([0.5, 0.1, -1.2])
    unfelt = linear.frequency_response([0.4, 1.1]) @ along
    assert np.abs(unfelt).max() < 1e-8 * np.abs(linear.frequency_response([0.4, 1.1])).max()
    moving, _ = built("hanging", "cable", rotation_vector=("1e-4*sin(7*t)**2", "2e-4*sin(7*t)**2", 0))
    run = ancf.stepper(moving, step=2e-3, start=state)
    run.advance(60)
    count = len(linear.frequencies_hz)
    read, turn = linear.state(run)[count : count + 3], np.array([1e-4, 2e-4, 0.0]) * np.sin(7 * run.t) ** 2
    assert read == pytest.approx(turn - along * (along @ turn) / (along @ along), rel=1e-3, abs=1e-9)


def test_a_wheel_behind_a_torsion_spring():
    """Closed form: a clamped base turns, a wheel on its hinge follows as an oscillator."""
    model = ancf.Model()
    base = model.add_rigid_body("base", at=(0, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.3))
    wheel = model.add_rigid_body("wheel", at=(0, 0.5, 0), mass=1.0, inertia=(0.03, 0.05, 0.03))
    model.clamp(base, name="table")
    model.hinge(wheel, base.at(0, 0.5, 0), axis=(0, 1, 0), name="axle")
    model.add_torsion_spring(wheel, base, axis=(0, 1, 0), stiffness=4.0, damping=0.1, name="shaft")
    linear = ancf.linearise(
        model,
        inputs=["angular_acceleration(table)[1]"],
        outputs=["joint_angle(axle)", "reaction_moment(table)[1]", "torsion_moment(shaft)"],
    )
    hz = np.array([0.3, 1.5, 4.0])
    s = 2j * np.pi * hz
    behind = -1.0 / (s**2 + (0.1 * s + 4.0) / 0.05)  # of the wheel against the base, per rad/s^2
    wanted = np.array([behind, 0.2 - (4.0 + 0.1 * s) * behind, (4.0 + 0.1 * s) * behind]).T
    found = linear.frequency_response(hz)[:, :, 0]
    np.testing.assert_allclose(found, wanted, rtol=1e-9)


def slid(element, motion):
    """A body hung from a place on a wire that is given, beside springs."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    line = rope(model, (0, 0, 0), (1.8, 0.1, 0.2), element, elements=6, length=1.83)
    model.pin(line.start, name="hook")
    model.hold(line.end, position="yz", name="end")
    model.add_spring(line.end, (2.2, 0.1, 0.25), stiffness=200.0, damping=0.5)
    load = body(model, line.at(0.75).initial_position + np.array([0, 0, -0.3]))
    model.slide(load.at(0, 0, 0.3), along=line, motion=motion, name="eye")
    model.add_spring(line.at(1.22), (1.2, 0.6, 0.3), stiffness=30.0, damping=0.2)
    model.add_spring(load.at(0.1, 0.1, 0), (0.6, 0.8, -0.5), stiffness=3.0, damping=0.2, name="spring")
    if element != "cable":
        model.hold(line.start, position="", twist=True)
    return model, ["position(load)[0]", "tension(rope.at(0.5))", "spring_force(spring)"]


@pytest.mark.parametrize("element", ["cable", *SOLIDS])
def test_a_slide_that_is_led(element):
    """Along its carrier, by its acceleration and its velocity: the remainder of runs is of order two."""
    model, smooth = slid(element, 0.75)
    state = ancf.equilibrium(model)
    every = [
        *smooth,
        "velocity(load)[2]",
        "normal_force(eye)[2]",
        "reaction(hook)[2]",
        "acceleration(load)[0]",
    ]
    linear = ancf.linearise(model, about=state, outputs=every, inputs=["acceleration(eye)"])
    quick = ancf.linearise(model, about=state, outputs=smooth, inputs=["velocity( eye )"])
    count = len(linear.frequencies_hz)
    assert linear.states[count] == quick.states[count] == "place of eye"
    assert (linear.input_units, quick.input_units) == (("m/s^2",), ("m/s",))
    along = by_rule(linear, 2, MOTION, STEP)
    mine, scale = along[:, : len(smooth)], np.abs(along).max(axis=0)
    np.testing.assert_allclose(
        by_rule(quick, 1, MOTION, STEP) / scale[: len(smooth)], mine / scale[: len(smooth)], rtol=0, atol=1e-8
    )
    formulas = ancf.design.linear_outputs.formulas_of(model, every)
    left = remainders(
        linear,
        formulas,
        along,
        lambda size: slid(element, f"0.75 + {size!r}*(1 - cos(7*t))**2")[0],
        (4e-4, 2e-4),
    )
    assert_of_second_order(left, 1e-7)


@pytest.mark.parametrize("element", ["cable", *SOLIDS])
def test_static_gain_of_a_slide_is_that_of_equilibria(element):
    outputs = [*slid(element, 0.75)[1], "normal_force(eye)[0]", "reaction(hook)[2]"]
    model = slid(element, 0.75)[0]
    linear = ancf.linearise(
        model, about=ancf.equilibrium(model), outputs=outputs, inputs=["acceleration(eye)"]
    )
    count = len(linear.frequencies_hz)
    first = linear.A[count + 1 : 2 * count + 1]
    gain = linear.C[:, :count] @ np.linalg.solve(first[:, :count], -first[:, count]) + linear.C[:, count]

    def at(place):
        moved = slid(element, f"0.75 + {place!r}*ramp(t, 0, 1)")[0]
        return answers(ancf.equilibrium(moved, time=2.0), outputs)

    h = 2e-3
    near, far = ((at(d) - at(-d)) / (2 * d) for d in (h, 2 * h))
    wanted = (4 * near - far) / 3
    np.testing.assert_allclose(gain, wanted, rtol=1e-5, atol=1e-6 * np.abs(wanted).max())


@pytest.mark.parametrize("moves", [True, False])
def test_the_place_of_a_slide_is_read_from_a_run(moves):
    """Also by a linear model of a slide that stands."""
    moving = slid("cable", "0.75 + 1e-4*sin(7*t)**2")[0]
    state = ancf.equilibrium(moving)
    model = moving if moves else slid("cable", 0.75)[0]
    linear = ancf.linearise(
        model, about=ancf.equilibrium(model), outputs=["position(load)[0]"], inputs=["acceleration(eye)"]
    )
    run = ancf.stepper(moving, step=2e-3, start=state)
    run.advance(60)
    x, angle = linear.state(run), 7 * run.t
    assert x[len(linear.frequencies_hz)] == pytest.approx(1e-4 * np.sin(angle) ** 2, rel=1e-7)
    assert x[-1] == pytest.approx(7e-4 * np.sin(2 * angle), rel=1e-4)
    assert linear.C @ x == pytest.approx(run.position("load")[0] - linear.outputs_at[0], rel=2e-3)


@pytest.mark.parametrize(
    ("inputs", "match"),
    [
        (["angular_velocity(hok)[0]"], r"inputs\[0\]: unknown clamp 'hok', known: \"hook\" .did you mean"),
        (
            ["angular_acceleration(hook)"],
            r"has three components .give one, such as angular_acceleration.hook.\[2",
        ),
        (["acceleration(hook)"], "has three components"),
        (
            ["angular_velocity(hook)[1]", "angular_acceleration(hook)[1]"],
            'turns "hook" about y, which another',
        ),
        (["rotation(hook)[1]"], '"rotation" is no motion that can be an input'),
    ],
)
def test_wrong_turns(inputs, match):
    refused(built("hanging", "cable")[0], match, inputs=inputs)


@pytest.mark.parametrize(
    ("inputs", "match"),
    [
        (["acceleration(eye)[0]"], r'"eye" is led along its carrier .write acceleration.eye'),
        (["angular_velocity(eye)"], r'"eye" is led along its carrier .write velocity.eye'),
        (["velocity(eye)", "acceleration('eye')"], 'moves "eye", which another input does already'),
        (["angular_velocity(hook)[1]"], "unknown clamp 'hook', the model has none"),
    ],
)
def test_wrong_slides(inputs, match):
    refused(slid("cable", 0.75)[0], match, inputs=inputs)


def test_turns_that_do_nothing_are_refused():
    """About the line of a cable; of a beam with a cross-section it is a twist."""
    for element in ("cable", "nonlocking"):
        model = ancf.Model()
        line = rope(model, (0, 0, 0), (1, 0, 0), element)
        model.clamp(line.start, name="hook")
        given = {"inputs": ["angular_acceleration(hook)[0]"], "outputs": ["position(rope.end)[2]"]}
        if element == "cable":
            with pytest.raises(ModelError, match="about its own line, which a cable does not feel"):
                ancf.linearise(model, **given)
        else:
            ancf.linearise(model, **given)


def test_what_joints_hold_cannot_be_turned():
    """A clamped base that a hinge to the ground holds as well."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    base = body(model, (0, 0, 0), "base")
    model.clamp(base, name="hook")
    rod = body(model, (0.6, 0, 0.1), "rod")
    model.connect(rod.at(-0.4, 0, -0.1), base.at(0.2, 0, 0))
    model.hinge(rod.at(0.4, 0, 0.2), (1.0, 0, 0.3), axis=(0, 1, 0))
    load = model.add_point_mass("load", at=(1, 1, 0), mass=1.0)
    for c in np.eye(3):
        model.add_spring(load, load.position + c, stiffness=5.0)
    refused(model, "cannot move: joints hold it", inputs=["angular_acceleration(hook)[2]"])
    ancf.linearise(model, about=ancf.equilibrium(model), inputs=["angular_acceleration(hook)[0]"])
