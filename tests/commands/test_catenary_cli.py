"""``ancf catenary run`` and ``ancf validate``: files, what is printed, exit codes."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import ancf
from ancf.viz.scene import make_scene
from overhead_lines import TOML


@pytest.fixture
def call(call, monkeypatch):
    """Run a command in a folder with the line file; returns exit code, stdout, stderr as one line."""
    monkeypatch.setenv("COLUMNS", "200")
    Path("line.toml").write_text(TOML, encoding="utf-8")

    def run(*arguments):
        ran = call(*arguments)
        return ran.code, ran.out, ran.said

    return run


QUICK = ("catenary", "run", "line.toml", "--speed", "140", "--step", "0.002")


def read(path):
    return json.loads(Path(path).read_text(encoding="utf-8"))


def test_run_writes_json_tables_and_report(call):
    code, out, _ = call(*QUICK, "-o", "out")
    assert code == 0
    done = read("out/run.json")
    assert done["speed_kmh"] == pytest.approx(140.0, rel=1e-9)
    assert done["real_time_factor"] > 0.0
    tables = sorted(path.name for path in Path("out").glob("*.csv"))
    assert tables
    for name in tables:
        with Path("out", name).open(encoding="utf-8", newline="") as file:
            table = list(csv.reader(file))
        assert len(table) > 1
        assert {len(row) for row in table} == {len(table[0])}
    page = Path("out/report.html").read_text(encoding="utf-8")
    assert "Short line" in page
    assert "http" not in page.split("<body")[0]  # nothing is fetched
    for text in ("mean force Fm", "uplift at support", "real-time factor", "written: "):
        assert text in out


def test_run_without_a_report(call):
    code, _, _ = call(*QUICK, "--no-report", "--no-states", "-o", "out")
    assert code == 0
    assert Path("out/run.json").exists()
    assert not Path("out/report.html").exists()
    assert not Path("out/results.h5").exists()


def test_states_show_the_pantograph_passing(call):
    code, _, _ = call(*QUICK, "--no-report", "-o", "out")
    assert code == 0
    result = ancf.load("out/results.h5")
    assert np.diff(result.t)[:-1] == pytest.approx(0.02)
    scene = make_scene(result)
    [strip] = scene.strips
    with Path("out/force_1.csv").open(encoding="utf-8", newline="") as file:
        t, x, raw = np.array([[float(cell) for cell in row[:3]] for row in list(csv.reader(file))[1:]]).T
    assert strip.ends[:, :, 0].mean(axis=1) == pytest.approx(np.interp(scene.t, t, x), abs=1e-6)
    assert strip.force == pytest.approx(np.interp(scene.t, t, raw), abs=1e-3)


def test_quiet_run_prints_nothing(call):
    code, out, err = call(*QUICK, "--no-report", "--quiet", "-o", "out")
    assert (code, out, err) == (0, "", "")


@pytest.mark.filterwarnings("ignore:run.window")
def test_run_of_two_different_pantographs(call):
    both = ("--pantograph", "benchmark-2015", "--pantograph", "dsa380", "--spacing", "30")
    place = ("--start", "10", "--window", "60", "80")
    code, out, _ = call(*QUICK, *both, *place, "--no-report", "-o", "out")
    assert code == 0
    assert out.count("mean force Fm") == 2
    assert len(read("out/run.json")["pantographs"]) == 2


def test_run_by_the_joint(call):
    code, _, _ = call(*QUICK, "--contact", "joint", "--no-report", "-o", "out")
    assert code == 0
    assert "joint" in Path("out/run.json").read_text(encoding="utf-8")


def test_validate_prints_and_writes_the_rows(call):
    code, out, _ = call("validate", "en50318-2002", "--speed", "250", "--no-report", "-o", "out")
    assert code == 0
    done = read("out/validate.json")
    assert (done["case"], done["speed_kmh"]) == ("en50318-2002", 250.0)
    assert done["real_time_factor"] > 0.0
    assert len(done["rows"]) == 8
    for row in done["rows"]:
        assert set(row) == {"quantity", "unit", "value", "low", "high", "inside", "tag"}
        assert row["inside"] is (row["low"] <= row["value"] <= row["high"])
        assert row["quantity"] in out
    assert done["all_inside"] is True
    assert "8 of 8 inside" in out


WRONG = {
    "unknown line": (("catenary", "run", "en50318-2003", "--speed", "100"), "en50318-2002"),
    "unknown pantograph": ((*QUICK, "--pantograph", "dsa"), "dsa380"),
    "speed below zero": (("catenary", "run", "line.toml", "--speed", "-5"), "--speed"),
    "window outside": ((*QUICK, "--window", "100", "400"), "run.window"),
    "start outside": ((*QUICK, "--start", "400"), "run.start"),
    "spacing too long": ((*QUICK, "--spacing", "200"), "run.window"),
    "window backwards": ((*QUICK, "--window", "100", "60"), "the smaller place first: 60 100"),
    "end inside the window": ((*QUICK, "--until", "80"), "run.until"),
    "end before the window": ((*QUICK, "--until", "30", "--no-report", "--no-states"), "run.until"),
    "formats of no report": ((*QUICK, "--to", "exe", "--no-report"), "--to: has no effect with --no-report"),
    "page of no report": ((*QUICK, "--to", "html", "--no-report"), "--to: has no effect with --no-report"),
    "unknown contact": ((*QUICK, "--contact", "glue"), "run.contact"),
    "unknown case": (("validate", "en50318", "--speed", "250"), "en50318-2002"),
    "validate at no speed": (("validate", "en50318-2002", "--speed", "0"), "--speed"),
}


@pytest.mark.parametrize("case", WRONG)
def test_wrong_input_ends_with_2_and_names_it(call, case):
    arguments, text = WRONG[case]
    code, out, err = call(*arguments, "-o", "out")
    assert code == 2
    assert text in err
    assert "written" not in out
    assert not list(Path().glob("out/*.json"))


def test_a_field_wrong_in_the_file_is_named(call):
    Path("line.toml").write_text(TOML.replace("tension = 20e3", "tension = 0.0"), encoding="utf-8")
    code, _, err = call(*QUICK, "-o", "out")
    assert code == 2
    assert "contact_wire.tension" in err
