"""A key in a table that does not have it: the message says in which table of the file it is known."""

import tomllib

import pytest

import ancf
from ancf.catenary.lines.entries import TABLES, LineEntry
from ancf.catenary.lines.file import parse_track
from ancf.model.file import parse_study
from ancf.model.file.entries import EquilibriumEntry, FileEntry, SimulationEntry
from ancf.model.file.messages import elsewhere
from ancf.model.file.parameters import leaves
from overhead_lines import TOML

MODEL = """
[sections.rope]
EA = 1e4
EI = 0.1
rhoA = 1.0
[[bodies]]
name = "rope"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 2
section = "rope"
[[supports]]
type = "pin"
point = "rope.start"
[simulation]
t_end = 0.1
step = 1e-3
"""


def plain(top):
    """Keys of a kind of file that are no tables, or for whose tables the name of a file may stand."""
    kinds = {name: [*leaves(field.annotation)] for name, field in top.model_fields.items()}
    return [
        name
        for name, inside in kinds.items()
        if str in inside or not any(hasattr(leaf, "model_fields") for leaf in inside)
    ]


@pytest.mark.parametrize("table", ["contact_wire", "messenger_wire", "damping", "steady_arm", "spans"])
@pytest.mark.parametrize("key", plain(LineEntry))
def test_of_the_top_in_a_table_of_a_line(key, table):
    if key in TABLES[table].model_fields:
        return
    tables = tomllib.loads(TOML)
    inside = tables[table][0] if table == "spans" else tables[table]
    inside[key] = tables.pop(key, 1.0)
    with pytest.raises(ancf.ModelError) as caught:
        parse_track(tables)
    assert "unknown key, allowed" in str(caught.value)
    assert f'"{key}" belongs at the top of the file' in str(caught.value)


@pytest.mark.parametrize("table", ["contact_wire", "messenger_wire", "damping", "steady_arm", "spans"])
@pytest.mark.parametrize("key", sorted(set(TABLES) - {"spans", "supports", "loads"}))
def test_a_table_in_a_line_in_a_table_of_a_line(key, table):
    """``dropper_rule = {...}`` below a table is a key of that table."""
    if key in TABLES[table].model_fields:
        return
    tables = tomllib.loads(TOML)
    inside = tables[table][0] if table == "spans" else tables[table]
    inside[key] = {"first": 5.0}
    with pytest.raises(ancf.ModelError, match=f'"{key}" belongs at the top of the file'):
        parse_track(tables)


@pytest.mark.parametrize("table", ["sections.rope", "bodies", "supports", "simulation"])
@pytest.mark.parametrize(
    ("key", "home"),
    [
        *((key, "top of the file") for key in ("gravity", "title")),
        *((key, "[simulation]") for key in SimulationEntry.model_fields if key != "start"),
        *((key, "[equilibrium]") for key in EquilibriumEntry.model_fields),
        *((key, "[sections.NAME]") for key in ("EA", "EI", "rhoA", "drag")),
        *((key, "[[bodies]]") for key in ("elements", "path", "mass", "inertia")),
    ],
)
def test_of_another_table_in_a_model(key, home, table):
    tables = tomllib.loads(MODEL)
    inside = tables["sections"]["rope"] if "." in table else tables[table]
    inside = inside[0] if isinstance(inside, list) else inside
    inside[key] = 1.0
    if home.strip("[]").replace("NAME", "rope") == table:
        return
    with pytest.raises(ancf.ModelError) as caught:
        parse_study(tables, "model")
    told = str(caught.value)
    if "unknown key" in told:
        assert home in told


def test_all_over_the_file_or_nowhere():
    assert (
        elsewhere("name", FileEntry) == elsewhere("tension", LineEntry) == elsewhere("foo", FileEntry) == ""
    )


@pytest.mark.parametrize(
    ("tables", "parse"), [(TOML, parse_track), (MODEL, lambda t: parse_study(t, "model"))]
)
@pytest.mark.parametrize("used", [False, True])
def test_below_the_parameters(tables, parse, used):
    """A key of the file there would be a parameter that nothing uses, and the file would have its default."""
    line = parse is parse_track
    keys = plain(LineEntry if line else FileEntry)
    for key in keys:
        if key in ("parameters", "tags"):
            continue
        given = {"parameters": {key: 1.5}, **tomllib.loads(tables)}
        if used:
            place, name = (given["contact_wire"], "EI") if line else (given["sections"]["rope"], "EI")
            place[name] = f"100 * {key}"
            parse(given)
            continue
        with pytest.raises(ancf.ModelError, match="no formula names it") as caught:
            parse(given)
        assert caught.value.where == f"parameters.{key}"


def test_parameters_of_one_section_of_a_route():
    tables = tomllib.loads(TOML)
    spans = tables.pop("spans")
    tables["parameters"] = {"gravity": 9.81, "messenger_support": 5e5}
    sections = [
        {"start": 0.0, "spans": spans},
        {"start": 120.0, "spans": spans, "messenger_support": "messenger_support"},
    ]
    with pytest.raises(ancf.ModelError, match=r"parameters\.gravity: .* no formula names it"):
        parse_track({**tables, "sections": sections})
    tables["parameters"].pop("gravity")
    assert parse_track({**tables, "sections": sections}).parts[1].messenger_support == 5e5
