"""What users try first, by other words, is told what does it."""

import pytest

import ancf


@pytest.mark.parametrize(
    ("name", "said"),
    [
        ("add_seabed", "add_ground"),
        ("add_cable", "add_beam"),
        ("add_buoy", "add_rigid_body"),
        ("add_pulley", "add_surface"),
        ("add_current", "add_fluid"),
        ("add_mass", "add_point_mass"),
        ("fix", "clamp"),
    ],
)
def test_methods(name, said):
    model = ancf.Model()
    with pytest.raises(AttributeError, match=f"has no attribute '{name}': .*{said}") as error:
        getattr(model, name)
    hint = str(error.value).split(": ", 1)[1]
    assert all(hasattr(model, word) for word in (said, hint.split("(")[0]))


@pytest.mark.parametrize("name", ["frobnicate", "linearise", "suffix", "add_rotational_massage"])
def test_nothing_is_guessed(name):
    with pytest.raises(AttributeError) as error:
        getattr(ancf.Model(), name)
    assert str(error.value) == f"Model has no attribute '{name}'"


def test_gravity_is_a_vector():
    with pytest.raises(ancf.ModelError, match=r"Model.gravity: .*\(0, 0, -9.81\) where z points upwards"):
        ancf.Model(gravity=9.81)


def test_a_file_in_place_of_its_columns():
    model = ancf.Model()
    line = model.add_beam(
        "line", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1, EI=1, rhoA=1)
    )
    with pytest.raises(ancf.ModelError, match=r"ancf\.Series\.read"):
        model.pin(line.start, displacement="vessel.csv")
