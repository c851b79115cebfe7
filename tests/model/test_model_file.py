"""The model file: what it gives, and one message with the path in the file for everything wrong."""

import copy
import json
import tomllib

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError
from ancf.model.file import parse_study, read_study, schema
from ancf.model.settings import EquilibriumSettings, SimulationSettings
from commands import python

TEXT = """
title = "Two wires"
gravity = [0, 0, -9.81]
[sections.strip]
shape = "rectangle"
width = 0.01
height = 0.01
E = 1e8
rho = 500
[[bodies]]
name = "beam"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 4
section = "strip"
element = "cable"
strain = "paper"
motion = { angular_velocity = [0, 0, 4], about = [0.5, 0, 0] }
[[bodies]]
type = "beam"
name = "arc"
path = [[1, 0, 0], [2, 0.5, 0], [3, 0.5, 0], [4, 0, 0]]
nodes = [0, 1, 3]
length = 3
natural_shape = "straight"
gauss = [4, 2]
section = { EA = 1e4, EI = 0.0833, rhoA = 0.05, damping = 0.03 }
[[supports]]
type = "clamp"
point = "beam.start"
stretch = "fixed"
rotation = "where(t < 15, 4/15*(t**2/2 + (15/(2*pi))**2*(cos(2*pi*t/15) - 1)), 4*(t - 7.5))"
[[supports]]
type = "pin"
point = "arc.end"
displacement = { t = [0, 1], value = [[0, 0, 0], [0, 0, 0.1]] }
name = "far end"
[[supports]]
type = "hold"
point = "arc.at(1)"
position = "y"
[[loads]]
type = "force"
point = "beam.end"
force = [0, 0, "-1*sin(2*pi*t)"]
[[loads]]
type = "moment"
point = "beam.end"
moment = [0, 0.5, 0]
[[loads]]
type = "distributed"
body = "arc"
load = [0, 1, 0]
between = [0.5, 1.5]
[[connections]]
type = "spherical"
a = "beam.end"
b = "arc.start"
[[connections]]
type = "spring"
a = "beam.at(0.5)"
b = [0.5, 0, 1]
stiffness = 100
slack = true
[simulation]
t_end = 0.4
step = 2.5e-4
integrator = { type = "generalized_alpha", rho_inf = 0.9 }
start = "equilibrium"
equilibrium_of = ["arc"]
output_step = 1e-3
outputs = ["beam.end", "beam.at(0.5)"]
[equilibrium]
load_steps = 5
"""
DATA = tomllib.loads(TEXT)
MISSING = type("Missing", (), {"__repr__": lambda self: "missing"})()  # the same name in every process


def changed(*changes):
    """The data above with the value at each path replaced, or removed."""
    data = copy.deepcopy(DATA)
    for path, value in changes:
        table = data
        for key in path[:-1]:
            table = table[key]
        if value is MISSING:
            del table[path[-1]]
        else:
            table[path[-1]] = value
    return data


def test_a_whole_file(tmp_path):
    file = tmp_path / "model.toml"
    file.write_text(TEXT, encoding="utf-8")
    study = read_study(file)
    model = study.model
    assert (study.title, model.title) == ("Two wires", "Two wires")
    assert study.source_text == TEXT
    assert list(model.bodies) == ["beam", "arc"]
    beam, arc = model.body("beam"), model.body("arc")
    assert (beam.strain, beam.elements, beam.section.EA) == ("paper", 4, pytest.approx(1e4))
    np.testing.assert_array_equal([beam.angular_velocity, beam.about], [[0, 0, 4], [0.5, 0, 0]])
    np.testing.assert_array_equal(arc.node_x, [0, 1, 3])
    assert (arc.gauss, arc.natural_shape, arc.section.damping) == ((4, 2), "straight", 0.03)
    assert [s.name for s in model.supports] == ["clamp at beam.start", "far end", "hold at arc.at(1)"]
    assert model.supports[0].rotation(20.0)[0] == pytest.approx(50.0)
    np.testing.assert_allclose(model.supports[1].displacement(0.5), [0, 0, 0.05])
    assert [type(load).__name__ for load in model.loads] == ["Force", "Moment", "DistributedLoad"]
    np.testing.assert_allclose(model.loads[0].force(0.25), [0, 0, -1])
    assert model.connections[1].slack is True
    assert study.simulation == SimulationSettings(
        t_end=0.4,
        step=2.5e-4,
        integrator=ancf.GeneralizedAlpha(0.9),
        start="equilibrium",
        equilibrium_of=("arc",),
        output_step=1e-3,
        outputs=("beam.end", "beam.at(0.5)"),
    )
    assert study.equilibrium == EquilibriumSettings(5)


def test_the_least_file():
    body = {
        "name": "b",
        "start": [0, 0, 0],
        "end": [1, 0, 0],
        "elements": 1,
        "section": {"EA": 1, "EI": 0, "rhoA": 1},
    }
    study = parse_study({"bodies": [body]})
    assert study.simulation is None
    assert study.equilibrium is None
    assert study.model.supports == []
    study = parse_study({"bodies": [body], "simulation": {"t_end": 1, "step": 1}})
    assert study.simulation == SimulationSettings(1.0, 1.0)
    assert parse_study({"bodies": [body], "equilibrium": {}}).equilibrium == EquilibriumSettings(1)


@pytest.mark.parametrize(
    ("given", "wanted"),
    [
        ("trapezoidal", ancf.Trapezoidal()),
        ("generalized_alpha", ancf.GeneralizedAlpha()),
        ({"type": "generalized_alpha", "rho_inf": 0}, ancf.GeneralizedAlpha(0)),
        ("radau", ancf.Radau()),
        (
            {"type": "radau", "stages": 2, "tolerance": 1e-5, "max_step": 0.01},
            ancf.Radau(stages=2, tolerance=1e-5, max_step=0.01),
        ),
        ({"type": "explicit", "check": False}, ancf.Explicit(check=False)),
    ],
)
def test_integrator(given, wanted):
    assert parse_study(changed((("simulation", "integrator"), given))).simulation.integrator == wanted


STRIP, BEAM = ("sections", "strip"), ("bodies", 0)
CLAMP, FORCE, SPRING, RUN = ("supports", 0), ("loads", 0), ("connections", 1), ("simulation",)
NAN, INF = float("nan"), float("inf")
BAD = [
    (("titel",), "x", "titel", 'did you mean "title"?'),
    (("title",), 5, "title", "must be text, is 5"),
    (("gravity",), [0, 0], "gravity", "has 2 entries, wanted 3"),
    (("gravity",), [0, 0, "9"], "gravity[2]", "must be a number, is '9'"),
    (("gravity",), [0, 0, True], "gravity[2]", "must be a number, is True"),
    (("gravity",), [0, 0, NAN], "gravity[2]", "finite"),
    (("gravity",), [0, 0, 10**400], "gravity[2]", "must be a number"),
    (("gravity",), -9.81, "gravity", "must be a list"),
    (("bodies",), MISSING, "bodies", "is missing"),
    (("bodies",), [], "bodies", "at least 1"),
    (("bodies",), {}, "bodies", "must be a list"),
    *(
        ((key,), {"name": "a"}, key, f"begins with [[{key}]], in double brackets")
        for key in ("bodies", "supports", "loads", "connections", "fluids", "grounds", "surfaces", "inputs")
    ),
    (("sections", "my strip"), {"EA": 1, "EI": 1, "rhoA": 0}, 'sections."my strip".rhoA', "must be > 0"),
    ((*STRIP, "E"), -1, "sections.strip.E", "must be > 0, is -1"),
    ((*STRIP, "E"), MISSING, "sections.strip.E", "is missing (Young's modulus [N/m^2])"),
    ((*STRIP, "nu"), 0.5, "sections.strip.nu", "must be < 0.5"),
    ((*STRIP, "widht"), 1, "sections.strip.widht", 'did you mean "width"?'),
    ((*STRIP, "shape"), "triangle", "sections.strip.shape", 'must be one of "rectangle", "circle"'),
    ((*STRIP, "width"), 1e-300, "sections.strip.EI", "must be > 0"),
    ((*STRIP, "height"), 0.02, "bodies[0].section", "one bending stiffness"),
    (STRIP, 3, "sections.strip", "must be a table"),
    ((*BEAM, "type"), "rod", "bodies[0].type", 'must be one of "beam"'),
    ((*BEAM, "name"), MISSING, "bodies[0].name", "is missing"),
    ((*BEAM, "name"), "arc", "bodies[1].name", "name of a body already"),
    ((*BEAM, "name"), "a.b", "bodies[0].name", "must be letters"),
    ((*BEAM, "section"), "stripp", "bodies[0].section", 'did you mean "strip"?'),
    ((*BEAM, "section"), 4, "bodies[0].section", "the name of a section or a table"),
    ((*BEAM, "section"), MISSING, "bodies[0].section", "is missing"),
    ((*BEAM, "section"), {"EA": 1, "EI": 1}, "bodies[0].section.rhoA", "is missing (Mass per length [kg/m])"),
    ((*BEAM, "section"), {"EA": NAN, "EI": 1, "rhoA": 1}, "bodies[0].section.EA", "finite"),
    ((*BEAM, "section"), {"shape": "circl"}, "bodies[0].section.shape", 'did you mean "circle"?'),
    ((*BEAM, "elements"), 0, "bodies[0].elements", "must be >= 1, is 0"),
    ((*BEAM, "elements"), 2.5, "bodies[0].elements", "whole number"),
    ((*BEAM, "elements"), 10**9, "bodies[0].elements", "between 1 and 1000000"),
    ((*BEAM, "elements"), MISSING, "bodies[0].elements", "is missing"),
    ((*BEAM, "element"), "orignal", "bodies[0].element", 'did you mean "original"?'),
    ((*BEAM, "element"), "original", "bodies[0].strain", '"paper" is a strain measure of cables'),
    ((*BEAM, "end"), [0, 0, 0], "bodies[0].end", "coincides with start"),
    ((*BEAM, "end"), MISSING, "bodies[0].end", "is missing"),
    ((*BEAM, "path"), [[0, 0, 0]], "bodies[0].path", "not both"),
    ((*BEAM, "length"), 0, "bodies[0].length", "must be > 0"),
    ((*BEAM, "gauss"), [5], "bodies[0].gauss", "has 1 entries, wanted 2"),
    ((*BEAM, "gauss"), [5, 99], "bodies[0].gauss[1]", "between 1 and 10"),
    ((*BEAM, "motion"), {"velocty": [0, 0, 0]}, "bodies[0].motion.velocty", 'did you mean "velocity"?'),
    ((*BEAM, "motion", "about"), [0, 0], "bodies[0].motion.about", "wanted 3"),
    (("bodies", 1, "path", 1), [1, 0, 0], "bodies[1].path[1]", "coincides with path[0]"),
    (("bodies", 1, "path", 1), [1, 0], "bodies[1].path[1]", "wanted 3"),
    (("bodies", 1, "nodes"), [0, 2, 1, 3], "bodies[1].nodes[2]", "increasing"),
    ((*CLAMP, "type"), "clmp", "supports[0].type", 'did you mean "clamp"?'),
    ((*CLAMP, "type"), MISSING, "supports[0].type", 'must be one of "pin", "clamp", "hold"'),
    (CLAMP, "clamp", "supports[0]", "must be a table"),
    ((*CLAMP, "point"), MISSING, "supports[0].point", "is missing"),
    ((*CLAMP, "point"), "baem.start", "supports[0].point", 'did you mean "beam"?'),
    ((*CLAMP, "point"), "beam.at(0.3)", "supports[0].point", "0.25 m and 0.5 m"),
    ((*CLAMP, "point"), "beam.at(7)", "supports[0].point", "outside the beam"),
    ((*CLAMP, "point"), "beam", "supports[0].point", "is no point"),
    ((*CLAMP, "point"), "arc.end", "supports[1].point", "both hold position x"),
    ((*CLAMP, "strech"), "free", "supports[0].strech", 'did you mean "stretch"?'),
    ((*CLAMP, "stretch"), "fix", "supports[0].stretch", 'must be one of "free", "fixed"'),
    ((*CLAMP, "rotation"), "sinn(t)", "supports[0].rotation", 'did you mean "sin"?'),
    ((*CLAMP, "rotation"), "1/t", "supports[0].rotation", "at t = 0 s"),
    ((*CLAMP, "rotation"), [1, 2, 3], "supports[0].rotation", "must be a number"),
    ((*CLAMP, "rotation_rate"), "t", "supports[0].rotation_acceleration", "give both"),
    ((*CLAMP, "axis"), [0, 0, 0], "supports[0].axis", "zero vector"),
    (("supports", 1, "name"), "beam", "supports[1].name", "name of a body already"),
    (("supports", 2, "position"), "w", "supports[2].position", 'letters of "xyz"'),
    ((*FORCE, "force"), [0, 0], "loads[0].force", "has 2 components, wanted 3"),
    ((*FORCE, "force"), [0, 0, "t +"], "loads[0].force[2]", "no formula of t"),
    ((*FORCE, "force"), [0, 0, True], "loads[0].force[2]", "must be a number"),
    ((*FORCE, "force"), {"t": [1, 0], "value": [[0, 0, 0]] * 2}, "loads[0].force.t[1]", "increasing"),
    (("simulation", "step"), "20 ms", "simulation.step", "is '20 ms', must be a number in s"),
    (("simulation", "t_end"), "1.5e-3s", "simulation.t_end", "must be a number in s (give the number alone)"),
    ((*STRIP, "E"), "210 GPa", "sections.strip.E", "must be a number in N/m^2"),
    (
        (*STRIP, "drag"),
        1.2,
        "sections.strip.drag",
        "must be a list, is 1.2 (float) (Drag coefficients, normal",
    ),
    ((*BEAM, "end"), 5, "bodies[0].end", "must be a list, is 5 (int) (End of a straight beam"),
    ((*BEAM, "n"), 5, "bodies[0].n", 'did you mean "elements"?'),
    ((*RUN, "dt"), 1e-3, "simulation.dt", 'did you mean "step"?'),
    ((*RUN, "duration"), 1.0, "simulation.duration", 'did you mean "t_end"?'),
    (("hinges",), [{}], "hinges", '[[connections]] with type = "hinge"'),
    (("pin",), {}, "pin", '[[supports]] with type = "pin"'),
    (("beams",), [{}], "beams", "([[bodies]])"),
    (("Cables",), [{}], "Cables", "([[bodies]])"),
    (("point_masses",), [{}], "point_masses", '[[bodies]] with type = "point_mass"'),
    (("rigid_bodies",), [{}], "rigid_bodies", '[[bodies]] with type = "rigid_body"'),
    (("forces",), [], "forces", '[[loads]] with type = "force"'),
    ((*FORCE, "force"), MISSING, "loads[0].force", "is missing (Force, function of t, or of t and the point"),
    ((*FORCE, "moment"), [0, 0, 1], "loads[0].moment", 'allowed: "type", "point", "force", "name"'),
    (("loads", 1, "moment"), [1, 0, 0], "loads[1].moment", "torque"),
    (("loads", 2, "body"), "acr", "loads[2].body", 'did you mean "arc"?'),
    (("loads", 2, "between"), [2, 1], "loads[2].between", "x0 < x1"),
    (("connections", 0, "b"), "arc.end", "connections[0].b", "m apart"),
    ((*SPRING, "b"), [0, 0], "connections[1].b", "wanted (3,)"),
    ((*SPRING, "b"), "beam.strt", "connections[1].b", 'did you mean "beam.start"?'),
    ((*SPRING, "b"), "arc.ende", "connections[1].b", 'did you mean "arc.end"?'),
    (("gravity",), -9.81, "gravity", "must be a list, is -9.81 (float) (Gravity, [x, y, z] [m/s^2])"),
    ((*SPRING, "stiffness"), "3", "connections[1].stiffness", "must be a number"),
    ((*SPRING, "stiffness"), -3, "connections[1].stiffness", "must be >= 0"),
    ((*SPRING, "slack"), 1, "connections[1].slack", "true or false"),
    ((*RUN, "t_end"), MISSING, "simulation.t_end", "is missing (End time [s])"),
    ((*RUN, "t_end"), 0, "simulation.t_end", "must be > 0"),
    ((*RUN, "step"), 0, "simulation.step", "must be > 0"),
    ((*RUN, "step"), 1, "simulation.step", "longer than the whole run of 0.4 s"),
    ((*RUN, "step"), 1e-30, "simulation.step", "more than 1e+09 steps"),
    ((*RUN, "output_step"), 3e-4, "simulation.output_step", "multiple of step"),
    ((*RUN, "output_step"), 1e-5, "simulation.output_step", "multiple of step"),
    ((*RUN, "integrator"), "runge", "simulation.integrator", '"trapezoidal", "generalized_alpha"'),
    ((*RUN, "integrator"), 3, "simulation.integrator", "a name or a table"),
    ((*RUN, "integrator"), {"rho_inf": 1}, "simulation.integrator.type", "is missing"),
    ((*RUN, "integrator", "rho"), 1, "simulation.integrator.rho", 'did you mean "rho_inf"?'),
    ((*RUN, "integrator", "rho_inf"), 1.5, "simulation.integrator.rho_inf", "between 0 and 1"),
    ((*RUN, "integrator", "type"), "trapezoidal", "simulation.integrator.rho_inf", "not of trapezoidal"),
    ((*RUN, "integrator"), {"type": "radau", "stages": 4}, "simulation.integrator.stages", "between 2 and 3"),
    ((*RUN, "integrator"), {"type": "radau", "tolerance": 1}, "simulation.integrator.tolerance", "between"),
    (
        (*RUN, "integrator"),
        {"type": "radau", "adaptive": 1},
        "simulation.integrator.adaptive",
        "True or False",
    ),
    ((*RUN, "integrator"), {"type": "radau", "max_step": 0}, "simulation.integrator.max_step", "must be > 0"),
    ((*RUN, "integrator"), {"type": "radau", "safety": 1}, "simulation.integrator.safety", "of explicit"),
    ((*RUN, "integrator"), {"type": "explicit", "safety": 2}, "simulation.integrator.safety", "at most 1"),
    ((*RUN, "integrator"), {"type": "explicit", "chek": True}, "simulation.integrator.chek", '"check"?'),
    ((*RUN, "outputs"), ["beam.mid"], "simulation.outputs[0]", "is no point"),
    ((*RUN, "equilibrium_of"), ["acr"], "simulation.equilibrium_of[0]", 'did you mean "arc"?'),
    (("equilibrium", "load_steps"), 0, "equilibrium.load_steps", "must be >= 1"),
    (("equilibrium", "load_steps"), 10**9, "equilibrium.load_steps", "between 1 and"),
]


@pytest.mark.parametrize(("path", "value", "where", "phrase"), BAD, ids=lambda v: str(v)[:30])
def test_bad_value(path, value, where, phrase):
    with pytest.raises(ModelError) as caught:
        parse_study(changed((path, value)))
    lines = str(caught.value).split("\n  ")
    found = [line for line in lines if line.startswith(f"{where}: ")]
    assert len(found) == 1, str(caught.value)
    assert phrase in found[0]
    if len(lines) == 1:
        assert caught.value.where == where


def test_settings_that_are_not_used():
    with pytest.raises(ModelError) as caught:
        parse_study(changed((("simulation", "start"), "reference")))
    assert "simulation.equilibrium_of: is not used" in str(caught.value)
    assert "equilibrium: is not used" in str(caught.value)


def test_data_that_is_no_table():
    with pytest.raises(ModelError, match="the file: must be a table"):
        parse_study([])


def test_several_problems_one_per_line():
    changes = [(("gravity",), [0, 0]), ((*STRIP, "E"), 0), (("loads", 0, "force"), [0, 0, "u"])]
    with pytest.raises(ModelError) as caught:
        parse_study(changed(*changes), "cable.toml")
    assert caught.value.where == "cable.toml"
    lines = str(caught.value).split("\n  ")
    assert lines[0] == "cable.toml: 3 problems:"
    assert [line.split(": ")[0] for line in lines[1:]] == ["gravity", "sections.strip.E", "loads[0].force[2]"]


def test_problems_of_the_model_are_collected_too():
    changes = [
        ((*CLAMP, "point"), "beam.at(0.3)"),
        ((*FORCE, "point"), "x.end"),
        (("connections", 0, "b"), "arc.end"),
    ]
    with pytest.raises(ModelError) as caught:
        parse_study(changed(*changes))
    assert "model: 3 problems:" in str(caught.value)
    for place in ("supports[0].point: ", "loads[0].point: ", "connections[0].b: "):
        assert f"\n  {place}" in str(caught.value)


def test_at_most_ten_lines():
    with pytest.raises(ModelError) as caught:
        parse_study(changed((("supports",), [{"type": "pin"}] * 30)))
    lines = str(caught.value).split("\n")
    assert len(lines) == 12
    assert lines[-1].strip() == "and 20 more"


def test_a_later_failure_names_the_place_in_the_file():
    study = parse_study(changed(((*FORCE, "force"), [0, 0, "1/(1 - t)"])))
    with pytest.raises(ModelError, match=r"loads\[0\]\.force: .* at t = 1 s"):
        study.model.loads[0].force.table(np.array([0.0, 1.0]))


@pytest.mark.parametrize(
    ("text", "place", "phrase"),
    [
        ("gravity = [0, 0\nx = 1\n", "line 2, column 1", "TOML syntax"),
        ("title = 'a'\ngravity = \n", "line 2, column 11", "Invalid value"),
        ('title = "abc', "line 1, column 13", "TOML syntax"),
        ("a = 1\na = 2\n", "line 2, column 6", "Cannot overwrite a value"),
    ],
)
def test_bad_syntax(tmp_path, text, place, phrase):
    file = tmp_path / "model.toml"
    file.write_text(text)
    with pytest.raises(ModelError) as caught:
        read_study(file)
    assert caught.value.where == f"{file}, {place}"
    assert phrase in caught.value.what


@pytest.mark.parametrize("text", ["x = " + "1" * 5000, "x = " + "[" * 5000])
def test_strange_syntax(tmp_path, text):
    file = tmp_path / "model.toml"
    file.write_text(text)
    with pytest.raises(ModelError, match="TOML syntax"):
        read_study(file)


def test_files_that_cannot_be_read(tmp_path):
    (tmp_path / "cantilever.toml").write_text(TEXT)
    with pytest.raises(ModelError, match=r"no such file \(did you mean \"cantilever.toml\"\?\)"):
        read_study(tmp_path / "cantilver.toml")
    with pytest.raises(ModelError, match="no such file"):
        read_study(tmp_path / "nowhere" / "model.toml")
    with pytest.raises(ModelError, match="is a folder"):
        read_study(tmp_path)
    with pytest.raises(ModelError, match="cannot be read"):
        read_study("a\0b")
    (tmp_path / "latin.toml").write_bytes(b'title = "\xe9t\xe9"')
    with pytest.raises(ModelError, match="is not UTF-8 text: byte 9"):
        read_study(tmp_path / "latin.toml")


def test_byte_order_mark_is_accepted(tmp_path):
    file = tmp_path / "model.toml"
    file.write_bytes(b"\xef\xbb\xbf" + TEXT.encode())
    assert read_study(file).title == "Two wires"


def properties(part, place="schema"):
    """Every (path, schema) of a property anywhere in a JSON Schema."""
    if isinstance(part, dict):
        for key, value in part.get("properties", {}).items():
            yield f"{place}.{key}", value
        for key, value in part.items():
            yield from properties(value, f"{place}.{key}")
    if isinstance(part, list):
        for i, value in enumerate(part):
            yield from properties(value, f"{place}[{i}]")


def test_every_property_has_a_description():
    found = list(properties(schema()))
    assert len(found) > 70
    assert [place for place, value in found if not value.get("description", "").strip()] == []


def test_every_number_has_its_unit():
    units = {
        place: value["description"]
        for place, value in properties(schema())
        if '"number"' in json.dumps(value)
    }
    units = {place: text for place, text in units.items() if not place.endswith((".sections", ".integrator"))}
    assert len(units) > 40
    assert [place for place, text in units.items() if not text.rstrip(".").endswith("]")] == []
    by_name = {place.rpartition(".")[2]: text for place, text in units.items()}
    for key, unit in {
        "EA": "[N]",
        "EI": "[N m^2]",
        "rhoA": "[kg/m]",
        "force": "[N]",
        "moment": "[N m]",
    }.items():
        assert unit in by_name[key]


def test_schema_is_json_and_names_every_kind():
    text = json.dumps(schema())
    for kind in ("pin", "clamp", "hold", "force", "moment", "distributed", "spherical", "spring", "circle"):
        assert f'"const": "{kind}"' in text
    assert '"const": "moments"' in text
    assert '["cable", "original", "nonlocking"]' in text


def test_the_python_api_does_not_import_pydantic():
    code = "import sys, ancf.model, ancf.model.settings; print('pydantic' in sys.modules)"
    assert python(code).out.strip() == "False"
