"""Supports, clamps, slides and winches that inputs of a linear model move, beside runs."""

import numpy as np
import pytest
from linear_cases import (
    Asked,
    assert_of_second_order,
    body,
    built,
    by_rule,
    given_motion,
    refused,
)

import ancf
from ancf.errors import ModelError
from helpers import EXACT

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


def test_what_joints_hold_cannot_be_moved():
    """A hook on a rail that a joint to the ground holds as well."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    base = body(model, (0, 0, 0), "base")
    model.hold(base, position="xyz", name="hook")
    model.connect(base.at(0.2, 0, 0), (0.2, 0, 0))
    refused(model, "cannot move: joints hold it", inputs=["acceleration(hook)[0]"])


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
