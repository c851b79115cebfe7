"""What is removed from a list of a model leaves its name free; in copies everything stays as it is."""

import pickle

import pytest

import ancf
from ancf.errors import ModelError

ADDED = {
    "fluids": lambda m, b: m.add_fluid("x", density=1000.0, velocity=(1, 0, 0)),
    "grounds": lambda m, b: m.add_ground("x", height=-1.0, stiffness=1e4),
    "surfaces": lambda m, b: m.add_surface("x", ancf.Sphere(0.1)),
    "loads": lambda m, b: m.add_force(b.end, (0, 0, 1), name="x"),
    "connections": lambda m, b: m.add_spring(b.end, (2, 0, 0), stiffness=1.0, name="x"),
    "supports": lambda m, b: m.pin(b.end, name="x"),
}


def built():
    model = ancf.Model()
    section = ancf.Section(EA=1.0, EI=1.0, rhoA=1.0, diameter=0.1)
    return model, model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)


@pytest.mark.parametrize("other", sorted(ADDED))
@pytest.mark.parametrize("kind", sorted(ADDED))
def test_a_name_is_free_again(kind, other):
    model, beam = built()
    ADDED[kind](model, beam)
    with pytest.raises(ModelError, match='"x" is the name of'):
        ADDED[other](model, beam)
    kept = model.snapshot()
    getattr(model, kind).clear()
    ADDED[other](model, beam)
    with pytest.raises(ModelError, match='"x" is the name of'):
        ADDED[other](kept, beam)
    again = pickle.loads(pickle.dumps(model))
    with pytest.raises(ModelError, match='"x" is the name of'):
        ADDED[other](again, again.bodies["beam"])


def test_inputs_are_given_by_name():
    model, beam = built()
    model.pin(beam.start)
    model.add_force(beam.end, (model.add_input("thrust"), 0, 0))
    run = ancf.stepper(model, step=1e-2)
    with pytest.raises(AttributeError, match=r'run.inputs\["thrust"\] = 5.0'):
        run.inputs.thrust = 5.0
    run.inputs["thrust"] = 5.0
    assert run.inputs["thrust"] == 5.0


def test_places_that_do_not_meet():
    model, beam = built()
    mass = model.add_point_mass("mass", at=(3, 0, 0), mass=1.0)
    with pytest.raises(ModelError, match="must coincide") as caught:
        model.connect(mass, beam.end)
    assert "spring or a beam" in caught.value.hint
    with pytest.raises(ModelError, match="nothing holds"):
        ancf.equilibrium(model)
    with pytest.raises(ModelError, match="no direction") as caught:
        model.add_spring(mass, (3, 0, 0), stiffness=1.0)
    assert "length=" in caught.value.hint


@pytest.mark.parametrize("size", [3.0, 40.0, 700.0])
def test_a_mass_below_a_ground(size):
    model = ancf.Model()
    section = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0, diameter=0.1)
    model.add_beam("beam", start=(0, 0, 0), end=(size, 0, 0), elements=4, section=section)
    model.add_ground("bed", height=0.0, stiffness=1e4)
    depth = 3e-4 * size
    model.add_point_mass("clump", at=(size / 2, 0, -depth), mass=1.0)
    result = ancf.simulate(model, t_end=1e-3, step=1e-3)
    assert any('"clump" is' in note and "below the ground" in note for note in result.notes), result.notes
