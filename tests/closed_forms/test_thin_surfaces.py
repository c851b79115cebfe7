"""Ropes against surfaces thinner than their elements are long: they stay outside, or there is an error."""

import pytest

import ancf


@pytest.mark.parametrize("place", [0.5, 0.44, 0.41])
@pytest.mark.parametrize("elements", [4, 8, 9])
def test_never_through(elements, place):
    """Too fast for the spring of the contact, wherever the wire is between the points of an element."""
    model = ancf.Model()
    section = ancf.Section(EA=1e5, EI=0.01, rhoA=0.3, diameter=0.02)
    rope = model.add_beam("rope", start=(0, 0, 0.3), end=(1, 0, 0.3), elements=elements, section=section)
    rope.set_motion(velocity=(0, 0, -10.0))
    wire = model.add_surface("wire", ancf.Cylinder(radius=0.01, at=(place, 0, 0), axis=(0, 1, 0)))
    model.add_contact(rope, wire, stiffness=1e5)
    with pytest.raises(ancf.SolveError, match="goes through a surface"):
        ancf.simulate(model, t_end=0.06, step=0.01)


@pytest.mark.parametrize("place", [0.5, 0.44])
def test_slow_ones_are_stopped(place):
    """The same wire bears a rope that is slow, and throws it back."""
    model = ancf.Model()
    section = ancf.Section(EA=1e5, EI=0.01, rhoA=0.3, diameter=0.02, bending_damping=1e-3)
    rope = model.add_beam("rope", start=(0, 0, 0.03), end=(1, 0, 0.03), elements=8, section=section)
    rope.set_motion(velocity=(0, 0, -0.3))
    wire = model.add_surface("wire", ancf.Cylinder(radius=0.01, at=(place, 0, 0), axis=(0, 1, 0)))
    contact = model.add_contact(rope, wire, stiffness=1e5)
    run = ancf.simulate(model, t_end=0.15, step=1e-3, sensors=[contact])
    assert run.position(rope.at(place))[:, 2].min() > 0.01
    assert run.sensors.contact_force(contact).max() > 0.1
