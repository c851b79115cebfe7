"""A parameter that lets a dropper slacken at another time is reported, with the change that it takes."""

import numpy as np
import pytest

import ancf
from ancf.model.vary import varied

TIGHT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14, modified=False))
GIVEN = {"t_end": 0.06, "step": 1e-3, "integrator": TIGHT}


def thrown(speed, slack=True):
    """A mass on a string that is thrown upwards from where the string carries it."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    bob = model.add_point_mass("bob", at=(0, 0, -1.02), mass=1.0)
    model.add_spring(bob, (0, 0, 0), stiffness=490.5, length=1.0, slack=slack, name="string")
    bob.set_motion(velocity=(0.0, 0.0, speed))
    return model


def slack_steps(model):
    """At which steps the string is slack."""
    return ancf.simulate(model, **GIVEN).spring_length("string") <= 1.0


@pytest.mark.parametrize("speed", [0.4, 0.7])
@pytest.mark.parametrize("name", ["bob.velocity[2]", "string.length"])
def test_least_change_is_that_of_whole_runs(speed, name):
    """Just below the change that is told all steps keep their branch, just above one does not."""
    model = thrown(speed)
    own = ancf.simulate(model, sensitivities=[name], **GIVEN).sensitivity(name)
    (found,) = own.branches(10.0)
    assert found.name == "string"
    assert own.branches(0.99 * found.by) == []
    assert [one.by for one in own.branches(1.01 * found.by)] == [found.by]

    def same(by):
        other, length = varied(model, name, own.value + by), 1.0
        now = ancf.simulate(other, **GIVEN)
        if name == "string.length":
            length += by
        return np.array_equal(now.spring_length("string") <= length, slack_steps(model))

    assert all(same(sign * 0.9 * found.by) for sign in (1, -1))
    assert not all(same(sign * 1.1 * found.by) for sign in (1, -1))


def test_what_has_no_branches():
    own = ancf.simulate(thrown(0.7, slack=False), sensitivities=["gravity"], **GIVEN).sensitivity("gravity")
    assert own.branches(1.0) == []
    with pytest.raises(ancf.ModelError, match=r"branches\.by"):
        own.branches(0.0)


def test_contacts():
    """A wire that lifts off a strip."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    wire = model.add_beam(
        "wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=500.0, EI=0.5, rhoA=0.2)
    )
    model.pin(wire.start)
    model.pin(wire.end)
    head = model.add_point_mass("head", at=(0.5, 0, -0.001), mass=0.4)
    model.add_contact(head, along=wire, stiffness=3000.0, name="strip")
    head.set_motion(velocity=(0.0, 0.0, 0.2))
    own = ancf.simulate(model, sensitivities=["head.velocity[2]"], **GIVEN).sensitivity("head.velocity[2]")
    (found,) = own.branches(1.0)
    assert found.name == "strip"
    assert 0.0 < found.by < 1.0
    assert own.branches(0.5 * found.by) == []
