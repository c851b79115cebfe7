"""Linear models of what touches, with friction that sticks, beside runs of the same models."""

import numpy as np
import pytest
from test_linearise import nonlinear, trapezoids

import ancf
from helpers import SOLIDS

AXES = np.eye(3)
LAW = {"stiffness": 5e3, "damping": 4.0, "stick": 3e3}
STEP, STEPS, SIZES = 1e-3, 60, (0.02, 0.01, 0.005)


def tied(model, point, stiffness):
    """A spring along each axis."""
    for axis in AXES:
        place = tuple(point.initial_position + 0.5 * axis)
        model.add_spring(point, place, stiffness=stiffness, damping=0.5)


def line(model, name, element, start, end, elements):
    if element == "cable":
        section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.5, diameter=0.04, bending_damping=0.01)
    else:
        section = ancf.Section.circle(0.04, E=4e5, rho=400.0, nu=0.3, bending_damping=0.01)
    return model.add_beam(name, start=start, end=end, elements=elements, section=section, element=element)


def on_plane(model, element, beam, law):
    model.add_contact(beam, model.add_surface("s", ancf.Plane((0, 0, 0), (0, 0, 1))), **law)


def on_ground(model, element, beam, law):
    model.add_ground("g", height=0.0, **{**law, "stiffness": 5e4, "stick": 3e4})


def on_cylinder(model, element, beam, law):
    drum = model.add_surface("s", ancf.Cylinder(0.3, (0.5, 0, -0.3), (0, 1, 0)))
    model.add_contact(beam, drum, **law)


def on_ball(model, element, beam, law):
    """A ball with a mass, held by springs."""
    body = model.add_rigid_body("q", at=(0.4, 0.01, -0.3), mass=1.0, inertia=(0.05, 0.06, 0.07))
    for arm in AXES:
        tied(model, body.at(*(0.2 * arm)), 30.0)
    model.add_contact(beam, model.add_surface("s", ancf.Sphere(0.3), on=body), **law)


def on_beam(model, element, beam, law):
    other = line(model, "other", element, (0.6, -0.5, -0.02), (0.6, 0.5, -0.02), 3)
    model.clamp(other.start)
    model.clamp(other.end)
    model.add_contact(beam, other, **law)


LAID = [on_plane, on_ground, on_cylinder, on_ball, on_beam]


def assert_linear(model, outputs):
    """Taylor: a run with an input leaves a remainder of order two."""
    state = ancf.equilibrium(model)
    linear = ancf.linearise(model, about=state, inputs=["push"], outputs=outputs)
    along = trapezoids(linear, STEP, STEPS)
    rest = nonlinear(model, state, outputs, 0.0, STEP, STEPS)
    left = [
        np.abs(nonlinear(model, state, outputs, size, STEP, STEPS) - rest - size * along).max(axis=0)
        for size in SIZES
    ]
    left = np.array(left) / np.abs(along).max(axis=0)
    assert np.all(left[-1] < 2e-3 * SIZES[-1]), left / np.array(SIZES)[:, None]
    seen = left[-1] > 1e-9
    assert np.all(np.log2(left[-2] / left[-1])[seen] > 1.8), left
    return state, linear


@pytest.mark.parametrize("friction", [0.0, 5.0])
@pytest.mark.parametrize("lay", LAID)
@pytest.mark.parametrize("element", ["cable", *SOLIDS])
def test_a_beam_that_lies(element, lay, friction):
    model = ancf.Model(gravity=(0, 0, -9.81))
    beam = line(model, "beam", element, (0, 0, 0.02), (1, 0, 0.02), 4)
    for x in (0.0, 0.5, 1.0):
        tied(model, beam.at(x), 20.0)
    lay(model, element, beam, LAW | {"friction": friction})
    push = model.add_input("push", 0.0)
    model.add_force(beam.at(0.3), (push, push, push))
    assert_linear(model, ["position(beam.at(0.3))[0]", "position(beam.at(0.9))[1]"])


def ball(friction, other, stick=5e3):
    """A ball of 1 kg and 0.1 m on a surface, held by soft springs."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    body = model.add_rigid_body("ball", at=(0, 0, 0.1), mass=1.0, inertia=(4e-3, 4e-3, 4e-3))
    for arm in AXES:
        tied(model, body.at(*(0.05 * arm)), 20.0)
    skin = model.add_surface("skin", ancf.Sphere(0.1), on=body)
    floor = model.add_surface("floor", other)
    law = {"stiffness": 1e4, "damping": 20.0, "friction": friction, "stick": stick}
    model.add_contact(skin, floor, **law, name="touch")
    push = model.add_input("push", 0.0)
    model.add_force(body.at(0.01, 0.02, 0.03), (push, 0.5 * push, push))
    return model


SHAPES = [
    ancf.Plane((0, 0, 0), (0, 0.1, 1)),
    ancf.Sphere(0.4, (0, 0, -0.4)),
    ancf.Cylinder(0.4, (0, 0, -0.4), (0.2, 1, 0)),
    ancf.Torus(0.6, 0.1, (0, 0, 0.5), (0, 1, 0)),
]


@pytest.mark.parametrize("friction", [0.0, 3.0])
@pytest.mark.parametrize("other", SHAPES, ids=lambda shape: type(shape).__name__)
def test_a_ball_that_rests(other, friction):
    state, linear = assert_linear(ball(friction, other), [f"position(ball)[{k}]" for k in range(3)])
    assert state.contact_force("touch") > 1.0
    damped = ancf.damped_modes(state.system.model, about=state, count=3).eigenvalues
    for value in damped:
        assert np.min(np.abs(linear.eigenvalues - value)) < 1e-8 * abs(value)
