"""Places along beams that come from what a state answers."""

import numpy as np
import pytest

import ancf


def bead(length):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.5, rhoA=1.0)
    ends = {"start": (0, 0, 0), "end": (2, 0, 0)}
    wire = model.add_beam("wire", **ends, elements=8, section=section, length=length)
    model.pin(wire.start)
    model.pin(wire.end)
    mass = model.add_point_mass("bead", at=wire.initial_position(0.8), mass=2.0)
    joint = model.slide(mass, along=wire, name="ring")
    model.hold(mass, position="x")
    return model, wire, mass, joint


@pytest.mark.parametrize("length", [2.0, 2.1, 2.4])
def test_where_a_state_says_that_a_joint_is(length):
    model, wire, mass, joint = bead(length)
    state = ancf.equilibrium(model)
    place = state.arc_length(joint)
    assert np.shape(place) == ()
    assert state.position(wire.at(place)) == pytest.approx(state.position(mass), abs=1e-9)


@pytest.mark.parametrize("value", [np.array(True), np.array("1.0"), np.array(np.nan), np.array([1.0]), None])
def test_what_is_no_number(value):
    with pytest.raises(ancf.ModelError, match=r"wire\.at: must be a (finite )?number"):
        bead(2.0)[1].at(value)
