"""Derivatives of what sensors record at every step: a travelling contact, droppers near their slack."""

import pytest

import ancf
from slopes import extrapolated, off

METHOD = ancf.GeneralizedAlpha(0.9, newton=ancf.Newton(tolerance=1e-13, modified=False))


def travelling_strip(stiff=40.0):
    """A long wire on a dropper, under which a strip travels."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.05, rhoA=0.1, damping=0.05)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(40, 0, 0), elements=8, length=40.02, section=section)
    model.pin(wire.start)
    model.pin(wire.end)
    clamp = model.add_point_mass("clamp", at=(20, 0, 3.0), mass=0.3)
    model.pin(clamp)
    model.add_spring(wire.at(20), clamp, stiffness=stiff, length=3.1, slack=True, name="stay")
    strip = model.add_point_mass("strip", at=(12, 0, -0.5), mass=1.0)
    model.hold(strip, position="xy", displacement=("4*t", 0, 0))
    strip.set_motion(velocity=(4, 0, 0))
    model.add_spring(strip, (12, 0, -1.0), stiffness=30.0, length=0.5, name="base")
    model.add_force(strip, (0, 0, 15.0), name="lift")
    model.add_contact(strip, wire, stiffness=2000.0, name="touch")
    return model


SENSORS = ["touch", "stay", "strip", "wire.at(20)"]
ASKED = {
    "contact_force": "touch",
    "contact_gap": "touch",
    "spring_force": "stay",
    "position": "wire.at(20)",
    "acceleration": "strip",
}


def recorded(model, names=()):
    start = ancf.equilibrium(model, sensitivities=names)
    given = {"t_end": 0.1, "step": 2e-3, "output_step": 0.1, "integrator": METHOD, "start": start}
    return ancf.simulate(model, sensors=SENSORS, sensitivities=names, **given).sensors


@pytest.fixture(scope="module")
def sensors():
    names = ["stay.length", "touch.stiffness", "lift.force[2]"]
    return recorded(travelling_strip(), names)


@pytest.mark.parametrize(("name", "step"), [("stay.length", 1e-4), ("touch.stiffness", 1e-2)])
def test_against_differences(sensors, name, step):
    own, model = sensors.sensitivity(name), travelling_strip()
    assert not sensors.listing.springs  # unknowns have derivatives
    assert len(own.t) == 51
    for quantity, item in ASKED.items():
        wanted = extrapolated(lambda m, a=quantity, i=item: getattr(recorded(m), a)(i), model, name, step, 3)
        assert off(getattr(own, quantity)(item), wanted) < 1e-6, quantity


def test_what_is_not_known(sensors):
    with pytest.raises(ancf.ModelError, match="there is none by"):
        sensors.sensitivity("stay.lenght")
    with pytest.raises(ancf.ModelError, match="known of equilibria and of the stored states"):
        sensors.sensitivity("stay.length").reaction("strip")
    with pytest.raises(AttributeError, match="has no 'colour'"):
        _ = sensors.sensitivity("stay.length").colour


@pytest.mark.parametrize("name", ["stay.length", "clamp.at[2]"])
@pytest.mark.parametrize("stiff", [40.0, 4e3, 4e5])
def test_droppers_near_their_slack(stiff, name):
    """A taut dropper is stretched by less than a difference of its length or place would change it."""
    model = travelling_strip(stiff)
    own = ancf.equilibrium(model, sensitivities=[name]).sensitivity(name)

    def height(m):
        return ancf.equilibrium(m).position("wire.at(20)")[2]

    wanted = extrapolated(height, model, name, 3e-6, 2)
    assert own.position("wire.at(20)")[2] == pytest.approx(wanted, rel=1e-5)
