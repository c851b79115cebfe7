"""Units of the columns of studies: from formulas, from paths of files, as given; where they stand."""

import json

import pandas as pd
import pytest

import ancf
from ancf import catenary
from ancf.design.file import read_study_file
from ancf.design.lines import OF_FORM, OF_RUN, SIGMA, STATISTICS, UNITS
from ancf.design.units import unit_of_formula
from ancf.model.file import schema
from ancf.viz import style
from overhead_lines import COARSE, STEP, collector, short_line

WORDS = {"tension": "N", "position": "m", "velocity": "m/s", "t": "s", "slipping": "", "input": None}


@pytest.mark.parametrize(
    ("formula", "unit"),
    [
        ("max(tension(cable.start))", "N"),
        ("-min(position(cable.at(10.5))[2])", "m"),
        ("range(position(c)[1]) + 0.5", "m"),
        ("2 - t", "s"),
        ("norm(position(c))", "m"),
        ("percentile(abs(tension(a)), 95)", "N"),
        ("at(tension(a), 1.5) - last(tension(b))", "N"),
        ("max(last(tension(a)), first(tension(b)), 3)", "N"),
        ("last(where(t > 1, tension(a), 0))", "N"),
        ("integral(tension(a))", "N s"),
        ("integral(norm(velocity(a)))", "m"),
        ("last(tension(a)) / first(tension(b))", ""),
        ("mean(slipping(a))", ""),
        ("1e-3 * max(tension(a))", None),  # kN, or 0.001 of it
        ("max(tension(a)) / 1000", None),
        ("max(tension(a)) + last(t)", None),
        ("max(tension(a)) / last(t)", None),
        ("max(tension(a)) ** 2", None),
        ("sqrt(max(tension(a)))", None),
        ("last(input(drive))", None),
        ("max(last(tension(a)), last(t))", None),
        ("2 * pi", None),
    ],
)
def test_of_formulas(formula, unit):
    assert unit_of_formula(formula, WORDS) == unit


def test_of_quantities_of_a_run_along_a_line():
    found = catenary.statistics(
        catenary.run(short_line(), speed=40.0, pantograph=collector(), mesh=COARSE, step=STEP)
    )
    run = {q.key: q.unit for q in found.values() if q.key in STATISTICS}
    assert len(run) > 10
    assert {key: UNITS[key] for key in run} == {k: "" if unit == "count" else unit for k, unit in run.items()}
    assert set(UNITS) == {*OF_FORM, *OF_RUN, *STATISTICS, SIGMA, "uplift_maximum"}


MODEL = """
gravity = [0, 0, -9.81]
[sections.rope]
EA = 1e5
EI = 1.0
rhoA = 0.5
damping = 0.2
[[bodies]]
type = "beam"
name = "rope"
section = "rope"
start = [0, 0, 0]
end = [4, 0, 0]
elements = 4
[[supports]]
type = "pin"
point = "rope.start"
[[connections]]
type = "spring"
name = "stay"
a = "rope.end"
b = [4, 0, 1]
stiffness = 1e4
damping = 3.0
[[loads]]
type = "force"
point = "rope.end"
force = [0, 0, -2]
[equilibrium]
"""
#: Paths of it with their units; rigid bodies and torsion springs have a damping or stiffness of their own.
PATHS = {
    "sections.rope.EA": "N",
    "sections.rope.damping": "N s/m^2",
    "bodies.rope.end[0]": "m",
    "gravity[2]": "m/s^2",
    "connections.stay.stiffness": "N/m",
    "connections[0].damping": "N s/m",
    "loads[0].force[2]": "N",
    "bodies.rope.elements": None,
}


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "model.toml").write_text(MODEL)
    return tmp_path


def study_of(folder, text, outputs):
    (folder / "study.toml").write_text(
        f'model = "model.toml"\n{text}\n[sampling]\nmethod = "grid"\n{outputs}'
    )
    return folder / "study.toml"


@pytest.mark.parametrize("path", PATHS)
def test_of_paths(folder, path):
    value = 4 if path.endswith("elements") else 1.0
    text = f'[[parameters]]\npath = "{path}"\nvalues = [{value}]'
    file = study_of(folder, text, '[[outputs]]\nname = "pull"\nformula = "last(tension(rope.start))"')
    expected = {"pull": "N"} | ({} if PATHS[path] is None else {path: PATHS[path]})
    assert read_study_file(file).units == expected


def test_every_number_of_a_model_file_says_its_unit():
    """What the report knows is what the descriptions end with."""
    told = [
        (table, key)
        for table, given in schema()["$defs"].items()
        for key, one in given.get("properties", {}).items()
        if one.get("type") == "number" and "[" not in one.get("description", "[")
    ]
    assert not told


def test_report_command_and_json_have_them(folder, call, monkeypatch):
    labels = set()

    def drawn(figure):
        for axes in figure.axes:
            labels.update((axes.get_xlabel(), axes.get_ylabel()))
        return plain(figure)

    plain = style.svg
    monkeypatch.setattr(style, "svg", drawn)
    text = """
[[parameters]]
path = "sections.rope.EA"
name = "EA"
values = [1e5, 2e5, 3e5]
[[parameters]]
path = "loads[0].force[2]"
name = "load"
unit = "N downwards"
values = [-1.0, -2.0]"""
    outputs = """
[[outputs]]
name = "pull"
formula = "last(tension(rope.start))"
[[outputs]]
name = "pull_kN"
formula = "1e-3*last(tension(rope.start))"
unit = "kN"
[[outputs]]
name = "bare"
formula = "last(tension(rope.start))**2"
"""
    ran = call("study", study_of(folder, text, outputs), "-o", folder / "out")
    assert ran.code == 0
    units = {"EA": "N", "load": "N downwards", "pull": "N", "pull_kN": "kN"}
    assert json.loads((folder / "out/study.json").read_text())["units"] == units
    page = (folder / "out/report.html").read_text()
    for shown in ("EA [N]", "load [N downwards]", "pull [N]", "pull_kN [kN]"):
        assert f">{shown}<" in page
    for shown in ("pull [N]", "pull_kN [kN]", "EA [N]"):
        assert shown in ran.out
    assert {"EA [N]", "load [N downwards]", "pull [N]", "mean of pull [N]", "mean of pull_kN [kN]"} <= labels
    assert "bare" in labels
    assert list(pd.read_csv(folder / "out/table.csv"))[1:6] == ["EA", "load", "pull", "pull_kN", "bare"]


def cubes(x):
    return {"cube": x**3}


def test_of_a_function(tmp_path):
    cases = ancf.sample({"x": [1.0, 2.0, 3.0]}, method="grid")
    table = ancf.study(cubes, cases, workers=0, folder=tmp_path, units={"x": "m", "cube": "m^3"})
    assert table.attrs["units"] == {"x": "m", "cube": "m^3"}
    assert "cube [m^3]" in (tmp_path / "report.html").read_text()
    # other units are another report, of the same cases
    ancf.study(cubes, cases, workers=0, folder=tmp_path, units={"x": "cm", "cube": "cm^3"})
    assert "cube [cm^3]" in (tmp_path / "report.html").read_text()


@pytest.mark.parametrize(
    ("units", "said"),
    [
        ({"cub": "m^3"}, 'study.units: there is no column "cub" .did you mean "cube"'),
        ({"cube": 3}, 'study.units."cube".: must be text, is 3'),
        ("m", "study.units: must be a mapping"),
    ],
)
def test_what_is_none(units, said):
    with pytest.raises(ancf.ModelError, match=said):
        ancf.study(cubes, ancf.sample({"x": [1.0]}, method="grid"), workers=0, units=units)
