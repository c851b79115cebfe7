"""Line files that an engineer gets wrong: one message each, with file, row and column where there is one."""

import pytest

from ancf import catenary
from ancf.errors import ModelError

LINE = """
title = "Line"
system_height = 1.2
contact_support = "free"
anchors = "tension"
dropper_rule = {first = 5.0, pitch_max = 10.0}
supports = "supports.csv"
[contact_wire]
type = "CuAg AC-100"
tension = 12e3
[messenger_wire]
type = "BzII 50"
tension = 10e3
[droppers]
EA = 0.9e6
[steady_arm]
vertical = 250.0
"""
TABLE = "position,height,stagger\n0,5.3,0.2\n50,5.3,-0.2\n100,5.3,0.2\n150,5.3,-0.2\n"
FIXED = LINE.replace('"tension"', '"fixed"')
COARSE = catenary.Mesh(contact=3.0, messenger=5.0)
#: What is wrong: line file, table, how the message begins, and what it says.
CASES = {
    "a column is missing": (
        LINE,
        TABLE.replace("position", "place"),
        "supports.csv, column position",
        "is missing",
    ),
    "a column nobody knows": (
        LINE,
        TABLE.replace("stagger", "stager"),
        "supports.csv, column stager",
        '"stagger"?',
    ),
    "tension in kN": (LINE.replace("12e3", "12"), TABLE, "contact_wire.tension", "units are N"),
    "spans in mm": (
        LINE,
        "position,height,stagger\n0,5.3,0.2\n60000,5.3,-0.2\n120000,5.3,0.2\n",
        "supports.csv, row 2, column position",
        "units are m",
    ),
    "height in mm": (
        LINE,
        TABLE.replace("5.3,-0.2", "5300,-0.2", 1),
        "supports.csv, row 2, column height",
        "5300",
    ),
    "stagger beyond the strip": (
        LINE,
        TABLE.replace("-0.2", "-1.2", 1),
        "supports.csv, row 2, column stagger",
        "the strip of benchmark-2015 reaches to 0.725 m",
    ),
    "an unknown wire": (LINE.replace("AC-100", "AC-110"), TABLE, "contact_wire.type", "did you mean"),
    "an empty cell": (
        LINE,
        TABLE.replace("100,5.3", "100,"),
        "supports.csv, row 3, column height",
        "is empty",
    ),
    "a word": (LINE, TABLE.replace("100,5.3", "100,high"), "supports.csv, row 3, column height", '"high"'),
    "supports that go back": (
        LINE,
        TABLE.replace("100,", "40,"),
        "supports.csv, row 3, column position",
        "behind one at 50 m",
    ),
    "a slack wire": (
        FIXED + "[conditions]\ntemperature = 120.0\n",
        TABLE,
        "line.conditions.temperature",
        "the contact wire is slack",
    ),
}


def passage(path):
    """The line is read, formed and run along."""
    line = catenary.read_line(path)
    return catenary.run(line, mesh=COARSE, speed=30.0, start=20.0, window=(50.0, 100.0), until=105.0)


@pytest.mark.parametrize("name", CASES)
def test_one_message(name, tmp_path):
    text, table, where, what = CASES[name]
    (tmp_path / "line.toml").write_text(text)
    (tmp_path / "supports.csv").write_text(table)
    with pytest.raises(ModelError) as caught:
        passage(tmp_path / "line.toml")
    said = str(caught.value).replace(f"{tmp_path}/", "")
    assert said.startswith(f"{where}: ")
    assert what in said
    assert "\n" not in said


@pytest.mark.parametrize("start", [150.0, 400.0])
def test_sections_that_do_not_meet(tmp_path, start):
    one = '[[sections]]\nstart = {}\nsupports = "supports.csv"\n'
    sections = one.format(0.0) + one.format(start)
    (tmp_path / "line.toml").write_text(LINE.replace('supports = "supports.csv"\n', "") + sections)
    (tmp_path / "supports.csv").write_text(TABLE)
    with pytest.raises(ModelError, match=r"sections\[1\].start: is .* have to overlap"):
        catenary.read_line(tmp_path / "line.toml")


def test_negative_dropper_lengths(tmp_path):
    rows = ["span,dropper,natural_length_mm"]
    rows += [f"{k // 5 + 1},{k % 5 + 1},{-900 if k == 7 else 900}" for k in range(15)]
    (tmp_path / "lengths.csv").write_text("\n".join(rows) + "\n")
    (tmp_path / "supports.csv").write_text(TABLE)
    (tmp_path / "line.toml").write_text('dropper_lengths = "lengths.csv"\n' + LINE)
    with pytest.raises(ModelError, match=r"lengths.csv, row 8, column natural_length_mm: is -900 mm"):
        catenary.read_line(tmp_path / "line.toml")
