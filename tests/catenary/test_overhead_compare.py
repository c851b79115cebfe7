"""Runs side by side: what is read back, differences by hand, reports, messages; limits that a sweep names."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest

import catenary_stand_in as stand_in
from ancf.catenary import Quantity, read_run, statistics, write_run
from ancf.catenary.answers.kept import _numbered, read_runs
from ancf.catenary.report.build import _box
from ancf.catenary.report.comparison import differences, write_comparison, write_table
from ancf.catenary.report.sweep import verdict
from ancf.catenary.report.tables import beside
from ancf.errors import ModelError
from ancf.viz.html import MANY


@pytest.fixture(scope="module")
def folders(tmp_path_factory):
    """Folders of two runs at different speeds, and the runs."""
    root = tmp_path_factory.mktemp("runs")
    runs = {"slow": stand_in.run(speed=200 / 3.6), "fast": stand_in.run(speed=270 / 3.6)}
    for name, run in runs.items():
        write_run(run, root / name)
    return root, runs


class TestRead:
    def test_what_was_written(self, folders):
        root, runs = folders
        for name, run in runs.items():
            (kept,) = read_run(root / name)
            told = statistics(run)
            assert kept.name == name
            assert kept.speed_kmh == pytest.approx(told["speed"].value, abs=1e-5)
            assert {q.key: q.value for q in kept.statistics} == pytest.approx(
                {q.key: q.value for q in told.quantities}, nan_ok=True
            )
            assert kept.force == pytest.approx(told.force, rel=1e-8)
            assert kept.position == pytest.approx(run.recordings[0].position, rel=1e-8)

    def test_two_pantographs(self, tmp_path):
        write_run(stand_in.run(count=2, spacing=100.0), tmp_path / "train")
        names = [kept.name for kept in read_run(tmp_path / "train")]
        assert names == ["train, leading (1)", "train, trailing 1 (2)"]

    def test_a_name_that_has_its_number(self, tmp_path):
        for unit, data in enumerate(("pantograph 1", "pantograph 2")):
            assert _numbered(data, unit) == data
        assert _numbered("pantograph 1", 1) == "pantograph 1 (2)"

    def test_folders_of_one_name(self, folders, tmp_path):
        root, runs = folders
        write_run(runs["fast"], tmp_path / "slow")
        names = [kept.name for kept in read_runs([root / "slow", tmp_path / "slow"])]
        assert names == [str(root / "slow"), str(tmp_path / "slow")]


class TestCompared:
    def test_differences(self, folders):
        root, runs = folders
        both = read_runs([root / "slow", root / "fast"])
        rows = dict(zip([q.key for q in both[0].quantities], differences(both), strict=True))
        slow, fast = (statistics(run) for run in runs.values())
        for key in ("mean_force", "deviation", "maximum", "loss"):
            _, _, values, (change,) = rows[key]
            assert values == pytest.approx([slow[key].value, fast[key].value])
            assert change == pytest.approx(fast[key].value - slow[key].value, abs=1e-9)

    def test_table(self, folders, tmp_path):
        root, _ = folders
        path = write_table(read_runs([root / "slow", root / "fast"]), tmp_path / "table.csv")
        with path.open(encoding="utf-8", newline="") as file:
            head, *rows = csv.reader(file)
        assert head == ["quantity", "unit", "slow", "fast", "fast less slow"]
        numbers = np.array([[float(cell) for cell in row[2:]] for row in rows if all(row[2:])])
        assert len(numbers) > 10
        assert numbers[:, 2] == pytest.approx(numbers[:, 1] - numbers[:, 0], abs=1e-5)

    def test_report(self, folders, tmp_path):
        root, _ = folders
        (path,) = write_comparison(read_runs([root / "slow", root / "fast"]), tmp_path, ["html"])
        text = path.read_text(encoding="utf-8")
        for wanted in (
            "fast less slow",
            "Contact force below 20 Hz",
            "200 km/h",
            "270 km/h",
            "Largest while the pantograph passes",
        ):
            assert wanted in text

    def test_command(self, folders, call):
        root, _ = folders
        done = call(
            "catenary", "compare", str(root / "slow"), str(root / "fast"), "-o", "both", "--to", "html"
        )
        assert done.code == 0, done.said
        assert "mean force" in done.out
        assert sorted(path.name for path in Path("both").iterdir()) == ["report.html", "table.csv"]


class TestRefused:
    def test_folders(self, folders, tmp_path):
        root, _ = folders
        with pytest.raises(ModelError, match="holds no run of pantographs"):
            read_runs([root / "slow", tmp_path])
        with pytest.raises(ModelError, match="stands there twice"):
            read_runs([root / "slow", root / "slow"])
        with pytest.raises(ModelError, match="are 1 pantographs"):
            read_runs([root / "slow"])

    @pytest.mark.parametrize("damage", ["{", "[]", '{"pantographs": [{}], "window_m": [0, 1]}'])
    def test_damaged(self, folders, tmp_path, damage):
        write_run(folders[1]["slow"], tmp_path / "run")
        (tmp_path / "run/statistics.json").write_text(damage)
        with pytest.raises(ModelError, match=r"statistics\.json|run\.json"):
            read_run(tmp_path / "run")

    def test_a_column_that_is_gone(self, folders, tmp_path):
        write_run(folders[1]["slow"], tmp_path / "run")
        path = tmp_path / "run/force_1.csv"
        path.write_text(path.read_text().replace("force_20hz_N", "force", 1))
        with pytest.raises(ModelError, match="column force_20hz_N: is missing"):
            read_run(tmp_path / "run")
        assert json.loads((tmp_path / "run/statistics.json").read_text())["pantographs"]


class TestLimitsOfASweep:
    def test_named(self):
        row = {
            "accepted_1": 0.0,
            "outside_deviation_1": 1.0,
            "outside_uplift_1": 1.0,
            "outside_mean_force_1": 0.0,
        }
        row |= {"accepted_2": 0.0, "outside_mean_force_2": 1.0, "outside_uplift_2": float("nan")}
        assert verdict(row, 0) == "outside: σ, uplift"
        assert verdict(row, 1) == "outside: Fm"
        assert verdict(row | {"accepted_1": 1.0}, 0) == "inside"


@pytest.mark.parametrize("count", [1, 2, 3, 4, 6])
def test_many_columns_take_the_window(count):
    """Four pantographs side by side have twelve columns."""
    rows = [Quantity("deviation", "standard deviation", "N", 30.0, high=32.0, tag="U")]
    made = beside([f"run {k}" for k in range(count)], [rows] * count)
    columns = len(made.findall(".//thead/tr/*"))
    assert columns == (6 if count == 1 else 4 + 2 * count)
    assert ("wide" in made.get("class").split()) == (columns >= MANY)


@pytest.mark.parametrize(
    ("values", "tone"),
    [((), ""), ((None,), ""), ((30.0,), "inside"), ((30.0, None), "inside"), ((30.0, 33.0), "outside")],
)
def test_a_verdict_has_its_colour(values, tone):
    """Of nothing that is judged neither."""
    rows = [
        Quantity("deviation", "", "N", value or 0.0, high=None if value is None else 32.0) for value in values
    ]
    assert _box("told", rows).get("class").split() == ["verdict", *filter(None, [tone])]
