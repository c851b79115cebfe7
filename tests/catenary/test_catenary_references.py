"""Published ranges, quantities, the table on a screen and the files of a run, on a made-up run."""

import csv
import dataclasses
import io
import json
import re

import numpy as np
import pytest
from rich.console import Console

import catenary_stand_in as stand_in
from ancf import ModelError
from ancf.catenary.answers.quantity import Quantity, shown, shown_limits
from ancf.catenary.answers.references import (
    filter_note,
    reference_case,
    reference_names,
    rows,
    second_reading,
)
from ancf.catenary.answers.statistics import statistics
from ancf.catenary.answers.table import table
from ancf.catenary.answers.write import write_run
from ancf.catenary.report.tables import flattened

#: The accepted ranges as published: by case and quantity, at the lower and the higher speed.
PUBLISHED = {
    "en50318-2002": {
        "speeds": (250, 300),
        "mean force Fm": ("N", (110, 120), (110, 120), "V2"),
        "standard deviation 0-20 Hz": ("N", (26, 31), (32, 40), "V2"),
        "Fm + 3 sigma": ("N", (190, 210), (210, 230), "V2"),
        "Fm - 3 sigma": ("N", (20, 40), (-5, 20), "V2"),
        "actual maximum": ("N", (175, 210), (190, 225), "V"),
        "actual minimum": ("N", (50, 75), (30, 55), "V"),
        "uplift at support": ("mm", (48, 55), (55, 65), "V2"),
        "loss of contact": ("%", (0, 0), (0, 0), "V2"),
    },
    "en50318-2018-ac-simple": {
        "speeds": (275, 320),
        "mean force Fm": ("N", (141.5, 146.5), (166.5, 171.5), "U"),
        "standard deviation 0-20 Hz": ("N", (31.9, 34.8), (49.5, 62.9), "U"),
        "standard deviation 0-5 Hz": ("N", (26.4, 28.9), (38.7, 44.4), "U"),
        "standard deviation 5-20 Hz": ("N", (16.2, 22.4), (29.0, 46.2), "U"),
        "actual maximum": ("N", (219, 244), (295, 343), "U"),
        "actual minimum": ("N", (71, 86), (55, 82), "U"),
        "range of contact-point height": ("mm", (38, 49), (46, 55), "U"),
        "uplift at support": ("mm", (39, 48), (59, 64), "U"),
        "loss of contact": ("%", (0, 0), (0, 0), "U"),
    },
}
ROW = ["quantity", "unit", "value", "low", "high", "inside", "tag"]


@pytest.fixture(scope="module")
def run():
    return stand_in.run()


@pytest.fixture(scope="module")
def two():
    return stand_in.run(count=2)


def at_speed(run, kmh):
    return dataclasses.replace(run, speed=kmh / 3.6)


class TestReferences:
    def test_names(self):
        assert reference_names() == sorted(PUBLISHED)

    @pytest.mark.parametrize("case", PUBLISHED)
    @pytest.mark.parametrize("which", [0, 1])
    def test_ranges_are_those_published(self, run, case, which):
        expected = dict(PUBLISHED[case])
        found = rows(at_speed(run, expected.pop("speeds")[which]), case)
        assert [list(row) for row in found] == [ROW] * len(expected)
        assert {row["quantity"] for row in found} == set(expected)
        for row in found:
            unit, *ranges, tag = expected[row["quantity"]]
            assert (row["unit"], row["low"], row["high"], row["tag"]) == (unit, *ranges[which], tag)
            assert row["inside"] is bool(row["low"] <= row["value"] <= row["high"])

    @pytest.mark.parametrize("kmh", [275.0, 249.9, 300.1, 10.0])
    def test_nothing_between_the_speeds(self, run, kmh):
        found = rows(at_speed(run, kmh), "en50318-2002")
        assert len(found) == 8
        assert {(r["low"], r["high"], r["inside"], r["tag"]) for r in found} == {(None, None, None, None)}
        note = reference_case("en50318-2002").note(kmh)
        assert note.startswith(f"no accepted ranges at {kmh:g} km/h")
        assert note.endswith("at 250 and 300 km/h")

    def test_round_off_in_the_speed(self, run):
        found = rows(dataclasses.replace(run, speed=250 / 3.6 * (1 + 1e-12)), "en50318-2002")
        assert found[0]["low"] == 110
        assert reference_case("en50318-2002").note(250.0) == ""

    def test_unknown(self):
        with pytest.raises(ModelError, match=r'no "en50318-2020".*did you mean "en50318-2002"'):
            reference_case("en50318-2020")


def at_the_edge(highest, frequency=18.0):
    """A run at 250 km/h whose force, 115 N and a sine near the cut-off, has this maximum below 20 Hz."""
    made = stand_in.run(step=1e-3)
    ratio = np.tan(np.pi * frequency / 1000.0) / np.tan(np.pi * 20.0 / 1000.0)
    low = 1.0 + ratio**12  # gain of order 6, forward and backward
    force = 115.0 + (highest - 115.0) * low * np.sin(2 * np.pi * frequency * made.t)
    records = [dataclasses.replace(made.recordings[0], force=force)]
    return dataclasses.replace(made, recordings=records), low / (1.0 + ratio**8)


class TestSecondFilter:
    """The same run with a filter of order 4, whose gain is less just below the cut-off."""

    def read(self, run):
        reference = reference_case("en50318-2002")
        first, second = reference.compare(statistics(run), 250.0), second_reading(run, reference)
        highest = [next(q for q in rows if q.key == "maximum") for rows in (first, second)]
        return highest, filter_note(first, second)

    def test_a_verdict_that_turns_is_told_with_its_number(self):
        run, less = at_the_edge(175.5)
        (six, four), note = self.read(run)
        wanted = 115.0 + 60.5 * less
        assert six.inside
        assert six.value == pytest.approx(175.5, rel=3e-3)
        assert not four.inside
        assert four.value == pytest.approx(wanted, rel=3e-3)
        assert f"actual maximum {four.value:.5g} N is outside 175 to 210" in note
        assert note.startswith("with a filter of order 4 instead of 6 ")
        assert " of 8 are inside: " in note

    def test_a_verdict_that_does_not_turn(self):
        run, _ = at_the_edge(195.0)
        assert "actual maximum" not in self.read(run)[1]

    def test_without_ranges_there_is_nothing_to_say(self, run):
        reference = reference_case("en50318-2002")
        fast = at_speed(run, 275.0)
        assert filter_note(reference.compare(statistics(fast), 275.0), second_reading(fast, reference)) == ""


class TestQuantity:
    @pytest.mark.parametrize(
        ("value", "low", "high", "inside"),
        [
            (5.0, 5.0, 6.0, True),
            (6.0, 5.0, 6.0, True),
            (6.001, 5.0, 6.0, False),
            (4.999, 5.0, None, False),
            (0.1, None, 0.3, True),
            (1.0, None, None, None),
        ],
    )
    def test_inside(self, value, low, high, inside):
        assert Quantity("x", "x", "N", value, low, high).inside is inside

    @pytest.mark.parametrize("kind", [float, np.float64, np.float32])
    @pytest.mark.parametrize(("value", "told"), [(2.0, True), (4.0, False), (-4.0, False)])
    def test_inside_of_any_kind_of_number(self, kind, value, told):
        """Who asks "is False" hears it of numpy's numbers too."""
        assert Quantity("x", "x", "N", kind(value), -3.0, kind(3.0)).inside is told

    def test_texts(self):
        assert shown(-3.14159, "N") == "\N{MINUS SIGN}3.1"
        assert shown(-0.01, "N") == "0.0"
        assert shown(3, "count") == "3"
        assert shown(None, "N") == ""
        assert shown_limits(Quantity("x", "x", "N", 1.0, -5.0, 20.0)) == "\N{MINUS SIGN}5 to 20"
        assert shown_limits(Quantity("x", "x", "N", 1.0, 0.0, 0.0)) == "0"
        assert shown_limits(Quantity("x", "x", "", 1.0, None, 0.3)) == "≤ 0.3"
        assert shown_limits(Quantity("x", "x", "", 1.0, 0.3, None)) == "≥ 0.3"

    def test_settings(self):
        assert flattened({"a_b": 1.5, "mesh": {"contact": 1, "none": None}}) == [
            ("a b", "1.5"),
            ("mesh, contact", "1"),
        ]


class TestTable:
    def test_on_screen(self, run):
        console = Console(width=110, file=io.StringIO())
        console.print(table(reference_case("en50318-2002").compare(statistics(run), 250.0)))
        lines = [re.split(r"\s{2,}", line.strip()) for line in console.file.getvalue().splitlines()]
        assert lines[0] == ["quantity", "value", "unit", "accepted", "tag"]
        assert lines[1] == ["mean force Fm", "114.8", "N", "110 to 120", "inside", "V2"]
        assert ["loss of contact", "0.46", "%", "0", "outside", "V2"] in lines


class TestFiles:
    def test_all(self, two, tmp_path):
        files = {path.name: path for path in write_run(two, tmp_path / "new")}
        names = {
            "statistics.csv",
            "statistics.json",
            "uplift.csv",
            "droppers.csv",
            "cycles.csv",
            "force_1.csv",
            "force_2.csv",
        }
        assert set(files) == names
        assert all(path.stat().st_size for path in files.values())

    def test_force(self, run, tmp_path):
        write_run(run, tmp_path)
        found = np.genfromtxt(tmp_path / "force_1.csv", delimiter=",", names=True)
        recording = run.recordings[0]
        np.testing.assert_allclose(found["position_m"], recording.position, rtol=1e-8)
        np.testing.assert_allclose(found["force_raw_N"], recording.force, rtol=1e-8)
        np.testing.assert_allclose(found["force_20hz_N"], statistics(run).force, rtol=1e-7)
        assert len(found) == len(run.t)

    def test_uplift_and_droppers(self, two, tmp_path):
        write_run(two, tmp_path)
        with (tmp_path / "uplift.csv").open() as file:
            uplift = list(csv.DictReader(file))
        assert len(uplift) == 11
        assert uplift[1]["uplift_1_mm"] == ""
        assert float(uplift[1]["uplift_2_mm"]) == pytest.approx(54.6, abs=0.1)
        with (tmp_path / "droppers.csv").open() as file:
            droppers = list(csv.DictReader(file))
        assert len(droppers) == 90
        assert float(droppers[40]["largest_N"]) == pytest.approx(two.dropper_force[:, 40].max(), rel=1e-6)

    def test_statistics(self, two, tmp_path):
        write_run(two, tmp_path)
        with (tmp_path / "statistics.csv").open() as file:
            table = list(csv.DictReader(file))
        found = statistics(two, 1)
        own = {row["key"]: row for row in table if row["pantograph"] == "trailing 1"}
        assert set(own) == {q.key for q in found.quantities}
        assert float(own["deviation"]["value"]) == pytest.approx(found["deviation"].value, rel=1e-8)
        assert own["relative_deviation"]["inside"] == "true"
        full = json.loads((tmp_path / "statistics.json").read_text())
        assert [p["name"] for p in full["pantographs"]] == ["leading", "trailing 1"]
        assert full["real_time_factor"] == two.real_time_factor

    def test_no_nan_in_json(self, run, tmp_path):
        made = dataclasses.replace(run, settings={"x": np.nan, "y": np.float64(2.0), "z": np.arange(2)})
        write_run(made, tmp_path)
        found = json.loads((tmp_path / "statistics.json").read_text(), parse_constant=pytest.fail)
        assert found["settings"] == {"x": None, "y": 2.0, "z": [0, 1]}

    def test_folder_that_cannot_be_written(self, run, tmp_path):
        (tmp_path / "file").touch()
        with pytest.raises(ModelError, match="cannot be written"):
            write_run(run, tmp_path / "file")
