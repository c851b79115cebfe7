"""A series in units of one quantity is refused where another one is meant, and taken where it belongs."""

import json
import math

import pytest

import ancf
from ancf.cosimulation.units import BaseUnit, base_unit
from ancf.model.file import read_study
from ancf.model.functions.units import KINDS, factor, in_plain_units, kind_of

#: Where a series may stand, with the unit of the package that belongs there.
PLACES = {
    "pin": ("m", lambda m, b, s: m.pin(b.start, displacement=(s, 0, 0))),
    "clamp": ("m", lambda m, b, s: m.clamp(b.start, displacement=(0, s, 0))),
    "hold": ("m", lambda m, b, s: m.hold(b.start, position="z", displacement=(0, 0, s))),
    "turn": ("rad", lambda m, b, s: m.clamp(b.start, rotation=s, axis=(0, 1, 0))),
    "force": ("N", lambda m, b, s: m.add_force(b.end, (0, s, 0))),
    "follower": ("N", lambda m, b, s: m.add_follower_force(b.end, (s, 0, 0))),
    "moment": ("N m", lambda m, b, s: m.add_moment(b.end, (0, 0, s))),
    "load": ("N/m", lambda m, b, s: m.add_distributed_load(b, (0, 0, s))),
    "pressure": ("N/m", lambda m, b, s: m.add_pressure(b, s, axis=(0, 0, 1))),
    "wind": ("m/s", lambda m, b, s: m.add_fluid("air", density=1.2, velocity=(s, 0, 0))),
    "winch": ("m", lambda m, b, s: m.winch(b.start, length=s)),
}
#: A unit of each kind, not that of the package where there is another one.
UNITS = [[*known][-1] for known in KINDS.values()]


def made(place, series):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.1, diameter=0.01)
    beam = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    PLACES[place][1](model, beam, series)
    return model


@pytest.mark.parametrize("table", [False, True])
@pytest.mark.parametrize("unit", ["", *UNITS])
@pytest.mark.parametrize("place", PLACES)
def test_units_of_something_else_are_refused(place, unit, table):
    wanted = PLACES[place][0]
    given = {"t": [0.0, 1.0, 2.0], "value": [1.0, 1.0, 1.0]}
    series = {**given, "unit": unit} if table else ancf.Series(**given, unit=unit)
    if unit and unit not in KINDS[wanted]:
        with pytest.raises(ancf.ModelError, match=rf"^add_|^[a-z]+\(.* must be in {wanted} ") as caught:
            made(place, series)
        assert caught.value.hint
        return
    model = made(place, series)
    again = ancf.Model.from_dict(json.loads(json.dumps(model.to_dict())))
    assert again.to_dict() == model.to_dict()


@pytest.mark.parametrize("vector", [False, True])
@pytest.mark.parametrize(("head", "unit"), [("x [kN]", ""), ("x", "kN"), ("x (deg)", ""), ("x [m]", "deg")])
def test_in_files(tmp_path, head, unit, vector):
    rows = "\n".join(f"{k / 10},{k}" for k in range(5))
    (tmp_path / "lab.csv").write_text(f"t,{head}\n{rows}\n", encoding="utf-8")
    column = '["x", "x", "x"]' if vector else '"x"'
    one = f'{{ csv = "lab.csv", column = {column}{f", unit = {unit!r}" if unit else ""} }}'
    path = tmp_path / "model.toml"
    path.write_text(
        f"""
[[bodies]]
type = "point_mass"
name = "mass"
at = [0, 0, 0]
mass = 1
[[supports]]
type = "pin"
point = "mass"
displacement = {one if vector else f"[0, 0, {one}]"}
""",
        encoding="utf-8",
    )
    with pytest.raises(ancf.ModelError, match=r"must be in m ") as caught:
        read_study(path)
    assert caught.value.where == f"supports[0].displacement{'' if vector else '[2]'}"


@pytest.mark.parametrize("unit", ["kN", "deg", "m/s"])
def test_motions_of_roofs(unit):
    from ancf.catenary.vehicles.roof import roofs

    with pytest.raises(ancf.ModelError, match=r"run\.roof\.up: .* must be in m "):
        roofs(ancf.Series([0.0, 1.0], [0.0, 1e-3], unit=unit), 1)


@pytest.mark.parametrize("unit", ["rad/s", "rpm", "s"])
def test_responses_over_something_else_than_frequencies(tmp_path, unit):
    from ancf.catenary.vehicles.response_file import read_response

    path = tmp_path / "response.csv"
    path.write_text(f"frequency [{unit}],real,imag\n1,2,3\n2,3,4\n", encoding="utf-8")
    with pytest.raises(ancf.ModelError, match='wanted one of "Hz"'):
        read_response(path)


@pytest.mark.parametrize("unit", ["mm", "cm"])
def test_a_run_of_a_file_without_units_goes_on(tmp_path, unit):
    """Its description has the values alone, as files of earlier versions do."""
    scale = {"mm": 1e3, "cm": 1e2}[unit]

    def moved(**given):
        model = ancf.Model()
        mass = model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
        model.pin(mass, displacement=(ancf.Series([0.0, 0.5, 1.0], **given), 0, 0))
        return model

    plain = moved(value=[0.0, 0.25, 1.0])
    path = tmp_path / "run.h5"
    ancf.simulate(plain, t_end=0.1, step=0.01, file=path)
    same = moved(value=[0.0, 0.25 * scale, scale], unit=unit)
    assert ancf.resume(path, model=same, t_end=0.2).t[-1] == pytest.approx(0.2)
    other = moved(value=[0.0, 0.5 * scale, scale], unit=unit)
    with pytest.raises(ancf.ModelError, match=r"resume\.model"):
        ancf.resume(path, model=other, t_end=0.3)


#: Units by their definitions, in m, s, kg and rad.
DEFINED = {
    "kn": 1852.0 / 3600.0,
    "km/h": 1000.0 / 3600.0,
    "in": 25.4e-3,
    "ft": 12 * 25.4e-3,
    "lbf": 0.45359237 * 9.80665,
    "g": 9.80665,
    "deg/s": 2 * math.pi / 360.0,
    "deg/s^2": 2 * math.pi / 360.0,
    "rpm": 2 * math.pi / 60.0,
    "%": 1e-2,
}


@pytest.mark.parametrize("unit", DEFINED)
def test_sizes_of_units(unit):
    assert factor(unit, "here") == pytest.approx(DEFINED[unit], rel=1e-12)
    assert factor(unit, "here", kind_of(unit)) == factor(unit, "here")


@pytest.mark.parametrize("kind", KINDS)
def test_units_are_those_that_exported_units_have(kind):
    """Two tables, of columns and of descriptions, say the same of what both know."""
    whole = base_unit(kind) if kind else BaseUnit(1.0, {})
    known = [(unit, base_unit(unit)) for unit in KINDS[kind] if unit not in ("", "g", "kn", "in")]
    assert all(found.exponents == whole.exponents for _, found in known if found is not None)
    for unit, found in known:
        if found is not None:
            assert factor(unit, "here") == pytest.approx(found.factor / whole.factor, rel=1e-12)


@pytest.mark.parametrize("unit", ["ms", "kN", "deg", "mm"])
def test_columns_in_plain_units(unit):
    """Empty entries stay; heads lose their units; plain columns stay as they are."""
    found = in_plain_units({f"a [{unit}]": ["2", "", -0.5], "b": ["3", "4", "5"]}, "table")
    size = {"ms": 1e-3, "kN": 1e3, "deg": math.pi / 180, "mm": 1e-3}[unit]
    assert found["a"][1] == ""
    assert [found["a"][0], found["a"][2]] == pytest.approx([2 * size, -0.5 * size], rel=1e-15)
    assert found["b"] == ["3", "4", "5"]
