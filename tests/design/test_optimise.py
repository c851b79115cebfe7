"""``ancf optimise``: lengths of droppers with the least deviation, and what its files say."""

import json
import shutil
from pathlib import Path

import pytest

import ancf
from ancf import catenary
from ancf.catenary.forms.mesh import Mesh
from ancf.cli.optimise import optimise_file
from ancf.design.optimisation_file import read_optimisation

EXAMPLES = Path(__file__).parents[2] / "examples"
QUICK = """
title = "Two lengths"
line = "line.toml"
objective = "sigma + 0.01*mean_force"
most = 2

[run]
speed = 288.0
pantograph = "en50318-2002"
step = 4e-3
start = 10.0
window = [61.0, 101.0]
mesh = { contact = 4.0, messenger = 6.0 }

[[parameters]]
name = "middle"
droppers = ["1-3", "2-3"]
low = -0.01
high = 0.01

[[parameters]]
name = "last"
droppers = ["2-5"]
low = -0.02
high = 0.02
start = 0.001

[[constraints]]
formula = "uplift_maximum"
high = 90.0
"""


@pytest.fixture
def folder(tmp_path):
    text = (EXAMPLES / "droppers_line.toml").read_text(encoding="utf-8")
    text = text.replace("repeat = 4\nlength = 65.0", "repeat = 3\nlength = 61.0")
    text = text.replace("41.667, 50.834, 60.0]", "41.667, 55.0]")
    (tmp_path / "line.toml").write_text(text, encoding="utf-8")
    (tmp_path / "find.toml").write_text(QUICK, encoding="utf-8")
    return tmp_path


@pytest.mark.filterwarnings("ignore::UserWarning")
def test_the_optimum_from_its_file_is_the_optimum(folder):
    optimise_file(folder / "find.toml", folder / "out", quiet=True)
    told = json.loads((folder / "out" / "optimum.json").read_text(encoding="utf-8"))
    assert told["objective"]["least"] < told["objective"]["first"]
    assert told["gradients"] == len((folder / "out" / "runs.csv").read_text().splitlines()) - 1
    assert told["constraints"]["uplift_maximum"] <= 90.0 + 1e-6
    given = read_optimisation(folder / "find.toml")
    line = catenary.read_line(folder / "out" / "optimum.toml")
    done = catenary.run(line, mesh=Mesh(contact=4.0, messenger=6.0), **given.settings)
    found = catenary.statistics(done)
    least = found["deviation"].value + 0.01 * found["mean_force"].value
    assert least == pytest.approx(told["objective"]["least"], rel=1e-12)


@pytest.mark.parametrize(("name", "spans"), [("droppers.toml", 4), ("droppers_13.toml", 13)])
def test_the_examples_can_be_read(name, spans):
    given = read_optimisation(EXAMPLES / name)
    assert len(given.parameters) >= 10
    assert len(given.line.spans) == spans
    labels = [label for one in given.parameters.values() for label in one.labels]
    assert len(set(labels)) == len(labels)
    assert given.settings["speed"] == pytest.approx(280 / 3.6)


class TestBadInput:
    @pytest.mark.parametrize(
        ("old", "new", "told"),
        [
            ('"2-5"', '"2-9"', "parameters.1..droppers.*there is no dropper"),
            ('name = "last"', 'name = "middle"', "name of another one"),
            ("low = -0.02", "low = 0.03", "do not ascend"),
            ("speed = 288.0", "", "run.speed"),
            ("step = 4e-3", "stepp = 4e-3", "run.stepp: unknown key"),
            ("contact = 4.0", "wire = 4.0", "run.mesh.wire"),
            ('"sigma + 0.01*mean_force"', '"loss"', "unknown name"),
            ("most = 2", "most = 0", "most"),
            ('"line.toml"', '"no.toml"', "no.toml"),
            ('"uplift_maximum"', '"uplift"', "constraints.0..formula"),
        ],
    )
    def test_files(self, folder, old, new, told):
        path = folder / "find.toml"
        path.write_text(QUICK.replace(old, new, 1), encoding="utf-8")
        with pytest.raises(ancf.ModelError, match=told):
            read_optimisation(path)

    def test_lengths_that_are_there_already(self, folder):
        shutil.copy(folder / "line.toml", folder / "plain.toml")
        text = (folder / "plain.toml").read_text(encoding="utf-8")
        (folder / "line.toml").write_text("dropper_lengths = [1.0]\n" + text, encoding="utf-8")
        with pytest.raises(ancf.ModelError, match="has dropper_lengths already"):
            read_optimisation(folder / "find.toml")
