"""What ancf.linearise refuses, and what it says."""

import numpy as np
import pytest
from linear_cases import built, driven, refused, rope

import ancf
from ancf.errors import ModelError, SolveError


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
        (
            ["rotation(hook)"],
            '"rotation" is no motion that can be an input: "velocity", "acc',
        ),
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
