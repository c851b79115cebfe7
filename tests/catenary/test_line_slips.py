"""Slips in line files: units that are a thousand off, kinds of values, keys that are missing."""

import copy
import math
import tomllib

import pytest

import ancf
from ancf import catenary
from ancf.catenary.lines.entries import TABLES, LineEntry
from ancf.catenary.lines.file import parse_track
from ancf.model.file.parameters import leaves
from overhead_lines import TOML

WIRE = {"EA": 5e6, "EI": 10.0, "mass": 0.3, "tension": 2e3, "diameter": 0.009}
#: What stands beside a key that belongs to a part which the plain line has not.
BESIDE = {
    "stitch": {"stitch": {**WIRE, "reach": 9.0}},
    "auxiliary_wire": {
        "auxiliary_wire": {**WIRE, "height": 0.25, "places": {"first": 4.0, "pitch_max": 9.0}},
        "long_droppers": {"stiffness": 1e5},
    },
    "conditions": {"conditions": {"wind": 5.0}},
}
KINDS = [
    -1.0,
    0.0,
    1e30,
    -1e30,
    math.nan,
    math.inf,
    "12 kN",
    "",
    True,
    None,
    [],
    [1.0],
    [[1.0, 2.0]],
    {},
    10**400,
]
#: Places and values that can only be slips: kN, mm, degrees, GPa, parts per million and the like.
SLIPS = [
    ("contact_wire.EA", 15e9, "units are N"),
    ("messenger_wire.EA", 11.6e9, "units are N"),
    ("contact_wire.EI", 195e6, "units are N m^2"),
    ("messenger_wire.EI", 131.7e6, "units are N m^2"),
    ("contact_wire.tension", 20.0, "units are N"),
    ("contact_wire.expansion", 17.0, "units are 1/K"),
    ("messenger_wire.expansion", 0.017, "units are 1/K"),
    ("contact_wire.drag", 1e3, "between 0 and 100"),
    ("contact_wire.diameter", 12.0, "units are m"),
    ("temperature", 283.15, "between -80 and 200"),
    ("conditions.temperature", 293.15, "between -80 and 200"),
    ("conditions.contact_tension", 20.0, "units are N"),
    ("conditions.contact_tension", 20e6, "units are N"),
    ("conditions.messenger_tension", 16.0, "units are N"),
    ("conditions.messenger_tension", 16e6, "units are N"),
    ("conditions.air_density", 1225.0, "of air: 1.225"),
    ("conditions.gust_length", 1e-3, "between 1 and 10000"),
    ("messenger_stagger", 200.0, "units are m"),
    ("messenger_support_mass", 1e6, "between 0 and 10000"),
    ("steady_arm.length", 1200.0, "between 0.05 and 20"),
    ("steady_arm.length", 1.2e-3, "between 0.05 and 20"),
    ("steady_arm.stiffness", 1.0, "between 10000 and"),
    ("steady_arm.lateral", 1e30, "leave it out"),
    ("steady_arm.uplift_stop", 200.0, "between 0.001 and 10"),
    ("stitch.reach", 0.009, "units are m"),
    ("spans.0.long_droppers", [5.0, 15.0], "without an auxiliary wire"),
]  # fmt: skip


def line(place, value):
    """Tables of the line with a value at a place."""
    tables = tomllib.loads(TOML)
    first = place.split(".")[0]
    tables |= copy.deepcopy(BESIDE.get(first, BESIDE["auxiliary_wire"] if first == "long_droppers" else {}))
    if first == "conditions":
        for wire in ("contact_wire", "messenger_wire"):
            tables[wire]["diameter"] = 0.012
    if first == "steady_arm" and place.split(".")[-1] in ("length", "stiffness", "angle", "push", "side"):
        tables["steady_arm"] = {"length": 1.2}
    inside = tables
    *above, last = place.split(".")
    for key in above:
        inside = inside[int(key)] if key.isdigit() else inside.setdefault(key, {})
    inside[last] = value
    return tables


@pytest.mark.parametrize(("place", "value", "hint"), SLIPS)
def test_units(place, value, hint):
    with pytest.raises(ancf.ModelError) as caught:
        parse_track(line(place, value))
    assert caught.value.where.removeprefix("line.") == place.replace(".0.", "[0].")
    assert hint in str(caught.value)


PLACES = [
    *(key for key in LineEntry.model_fields if key not in TABLES),
    *(f"{t}.{'0.' if t == 'spans' else ''}{k}" for t in TABLES if t not in ("supports", "loads", "report")
      for k in TABLES[t].model_fields),
]  # fmt: skip


@pytest.mark.parametrize("place", PLACES)
def test_kinds_of_values(place):
    """Every key of the file with every kind of value: a line, or one error that knows no inner names."""
    for value in KINDS:
        said = refusal(line(place, value))
        assert not any(inner in said for inner in ("add_", "[SupportEntry]", ".str:"))
        asked_elsewhere = place == "auxiliary_wire.places" and value is None  # then spans have to say it
        table = "_wire" if place == "contact_wire.rail" else place.split(".")[0]
        assert not said or asked_elsewhere or table.removesuffix("s") in said


def refusal(tables):
    try:
        parse_track(tables)
    except ancf.ModelError as error:
        return str(error)
    return ""


@pytest.mark.parametrize("key", ["supports", "dropper_lengths", "contact_wire.lift", "messenger_wire.lift"])
@pytest.mark.parametrize("value", [1.0, True, math.nan, {"a": 1}])
def test_a_file_or_rows_are_one_problem(key, value):
    tables = line(key, value)
    with pytest.raises(ancf.ModelError) as caught:
        parse_track(tables)
    assert caught.value.where == key
    assert "must be a list" in caught.value.what


@pytest.mark.parametrize("missing", ["first", "pitch_max"])
def test_rules_of_auxiliaries_that_lack_a_key(missing):
    tables = line("auxiliary_wire.height", 0.25)
    del tables["auxiliary_wire"]["places"][missing]
    with pytest.raises(ancf.ModelError, match="is missing") as caught:
        parse_track(tables)
    assert caught.value.where == f"auxiliary_wire.places.{missing}"


@pytest.mark.parametrize("degrees", [-40.0, 10.0, 35.0])
@pytest.mark.parametrize("strain", [1e-5, 1e-3])
def test_what_is_stiff_but_meant_is_found(degrees, strain):
    """Close to the limits, lines come to rest."""
    tables = line("temperature", degrees)
    tables["contact_wire"]["EA"] = tables["contact_wire"]["tension"] / strain
    tables["spans"][0]["repeat"] = 2
    form = catenary.form(parse_track(tables))
    assert all(force > 0.0 for force in form.dropper_force)


def test_all_tables_are_known():
    inside = {
        name
        for name, field in LineEntry.model_fields.items()
        if any(hasattr(leaf, "model_fields") for leaf in leaves(field.annotation))
    }
    assert inside == set(TABLES)
