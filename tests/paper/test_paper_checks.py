"""Every exhibit judges its numbers and is written: checks pass, can fail, and say what they compare with."""

import csv
import dataclasses
import json
import math
from functools import cache

import numpy as np
import pytest

from ancf.errors import ModelError
from ancf.paper import FIGURES, Table, closed_forms, en50318, fig8, orders, reproduce, sliding
from ancf.paper.closed import statics, vibration
from ancf.paper.order_studies import MESH, Study

#: Columns that each exhibit judges, and a change that must be seen: a factor or what is added to each number.
JUDGED = {
    "fig1": [("X", "add", 1e-9), ("Y", "add", 1e-9), ("Z", "add", 1e-9)],
    "fig2": [("tip_x", "add", 1e-5), ("tip_z", "add", 1e-5)],
    "fig3": [("jacobians", "times", 4), ("jacobians", "times", 0.25)],
    "fig4": [("tip_x", "add", 1e-5), ("tip_y", "add", 1e-5), ("tip_z", "add", 1e-5)],
    "fig5": [("mid_x", "add", 1e-5), ("mid_y", "add", 1e-5), ("mid_z", "add", 1e-5)],
    "fig6": [("jacobians", "times", 4), ("t_reached", "times", 0.9), ("steps", "times", 100)],
    "fig7": [("u_transverse", "add", 1e-5), ("u_axial", "add", 1e-5)],
    "fig8": [("u_transverse", "add", 1e-5), ("t", "add", 0.01)],
    "fig9": [("x", "add", 1e-4), ("y", "add", 1e-4), ("z", "add", 1e-4)],
    "fig10": [("x", "add", 1e-4), ("z", "add", 1e-4)],
    "fig11": [("y", "add", 1e-4), ("s", "add", 1e-4)],
    "fig12": [],
    "fig13": [("z", "times", 1.01)],
    "fig14": [("force_raw", "add", -10.0), ("penalty_20hz", "times", 1.2), ("force_20hz", "add", 1.0)],
    "table2": [("tip_x", "add", 1e-4), ("jacobians", "times", 1e4)],
    "closed-forms": [("value", "times", 1.001), ("reference", "times", 1.001)],
    "connections": [("value", "times", 1.001), ("reference", "times", 1.001)],
    "orders": [("rate", "add", 0.3)],
    "derivatives": [("derivative", "times", 1.001), ("reference", "times", 1.001), ("order", "add", 0.1)],
    "overhead": [("value", "times", 1.05), ("reference", "add", 40.0)],
    "en50318": [("value", "times", 1.5)],
}
EXAMPLES = {"", "7.1", "7.2", "7.3", "7.4", "7.5"}


JACOBIANS = ["element", "f", "E", "jacobians", "newton_iterations", "steps", "status", "t_reached"]
PARTS = ["element", "carrier", "slider"]
COUNTERS = ["steps", "newton_iterations", "jacobians"]
NUMBER = ["name", "element", "value", "reference"]
COLUMNS = {
    "fig1": ["element", "mode", "vector", "component", "meaning", "change", *"xyzXYZ"],
    "fig2": ["element", "elements", "tip_x", "tip_z"],
    "fig3": JACOBIANS,
    "fig4": ["element", "elements", "t", "tip_x", "tip_y", "tip_z", "mid_x", "mid_y", "mid_z"],
    "fig5": ["element", "elements", "t", "tip_x", "tip_y", "tip_z", "mid_x", "mid_y", "mid_z"],
    "fig6": JACOBIANS,
    "fig7": ["element", "elements", "u_transverse", "u_axial"],
    "fig8": ["element", "elements", "t", "u_transverse"],
    "fig9": [*PARTS, "t", "body", "arc_length", "x", "y", "z"],
    "fig10": [*PARTS, "t", "x", "y", "z", "s"],
    "fig11": [*PARTS, "t", "x", "y", "z", "s"],
    "fig12": ["symbol", "meaning", "value", "unit", "tag"],
    "fig13": ["part", "number", "x", "y", "z"],
    "fig14": ["speed", "t", "position", "force_raw", "force_20hz", "penalty_20hz"],
    "table2": [*PARTS, "t", *COUNTERS, "cpu_seconds", "paper_seconds", "tip_x", "tip_y", "tip_z"],
    "closed-forms": [*NUMBER, "deviation", "tolerance", "unit", "origin"],
    "connections": [*NUMBER, "deviation", "tolerance", "unit", "origin"],
    "derivatives": [
        *("computation", "asked", "parameter", "derivative", "reference", "largest", "error"),
        *("accepted", "order", "change"),
        *(f"left_{k}" for k in range(1, 5)),
    ],
    "orders": ["study", "over", "element", "order", "size", "error", "rate"],
    "overhead": ["name", "value", "reference", "tolerance", "unit", "origin"],
    "en50318": ["case", "speed_kmh", "quantity", "unit", "value", "low", "high", "verdict", "tag"],
}
#: First columns of those figures that do not have all three kinds of elements.
KINDS = {
    "fig1": {"original", "nonlocking"},
    "fig3": {"cable", "nonlocking"},
    "fig9": {"cable"},
    "fig12": {"m_1", "m_2", "k_1", "k_2", "c_1", "c_2", "F_H", "b", "y_max"},
    "fig13": {"contact wire", "carrier", "dropper", "mast", "pantograph"},
    "fig14": {32.0},
    "en50318": {"en50318-2002"},
}


@cache
def short(name):
    return FIGURES[name].data(short=True)


@cache
def judged(name):
    return FIGURES[name].checks(short(name))


def changed(table, column, how, size):
    """The table with another column of numbers; what is None stays."""
    at = table.columns.index(column)

    def new(value):
        if value is None:
            return None
        return value * size if how == "times" else value + size

    rows = [(*row[:at], new(row[at]), *row[at + 1 :]) for row in table.rows]
    return Table(table.name, table.columns, rows, table.notes)


def failed(checks):
    return [check.name for check in checks if not check.passed]


class TestExhibits:
    def test_all_are_tested(self):
        assert set(JUDGED) == set(FIGURES)

    @pytest.mark.parametrize("name", FIGURES)
    def test_says_what_it_is(self, name):
        exhibit = FIGURES[name]
        number = name.replace("fig", "Fig. ").replace("table", "Table ")
        if name.startswith(("fig", "table")):
            assert exhibit.TITLE.startswith(f"{number}: ")
        assert exhibit.EXAMPLE in EXAMPLES
        assert exhibit.CLAIM.endswith(".")
        assert exhibit.CLAIM.startswith("Not in the paper.") == (not name.startswith(("fig", "table")))

    @pytest.mark.parametrize("name", FIGURES)
    def test_passes(self, name):
        checks = judged(name)
        assert bool(checks) == bool(JUDGED[name])  # what is only given, as in a sketch, is not judged
        assert not failed(checks)

    @pytest.mark.parametrize("name", FIGURES)
    def test_can_fail(self, name):
        """A wrong number in any column that is judged is seen."""
        for column, how, size in JUDGED[name]:
            assert failed(FIGURES[name].checks(changed(short(name), column, how, size))), column

    @pytest.mark.parametrize("name", FIGURES)
    def test_numbers_and_origins(self, name):
        for check in judged(name):
            assert check.origin
            assert math.isfinite(check.reference)
            assert check.tolerance >= (1.0 if check.rule == "factor" else 0.0)
            assert isinstance(check.value, float)
            assert isinstance(check.reference, float | int)

    def test_names_are_unique(self):
        names = [check.name for name in FIGURES for check in judged(name)]
        assert len(names) > 150
        assert len(set(names)) == len(names)

    def test_no_number_is_judged_twice(self):
        """The same value against the same reference of the same origin would count for two."""
        found = [check for name in FIGURES for check in judged(name) if check.rule == "within"]
        for k, one in enumerate(found):
            for other in found[:k]:
                same = (one.origin, one.reference, one.unit) == (other.origin, other.reference, other.unit)
                near = abs(one.value - other.value) < 0.05 * max(one.tolerance, other.tolerance)
                # orders of two methods are two numbers, and both are 2
                known = (
                    one.reference == 0.0 or "EN 50318" in one.name or one.name.startswith(("Order", "Taylor"))
                )
                assert not (same and near and not known), (one.name, other.name)

    def test_no_input_is_judged(self):
        """What must be met exactly is counted in a run; what was given to it could not be missed."""
        counted = ("Jacobians", "given up", "loss of contact")
        for name in FIGURES:
            exact = [c.name for c in judged(name) if c.rule == "within" and c.tolerance == 0.0]
            assert all(any(word in text for word in counted) for text in exact), exact

    def test_times_are_not_judged(self):
        table = changed(short("table2"), "cpu_seconds", "times", 1e6)
        assert FIGURES["table2"].checks(table) == judged("table2")

    def test_the_largest_lag_has_a_row(self):
        """Rows every 20 ms would miss it."""
        t = short("fig8").values("t", element="cable")
        assert 6.747 in np.round(t, 9)
        assert np.diff(t).max() < 0.02 + 1e-9
        assert len(t) <= 352

    def test_a_run_that_is_too_short_has_no_lag(self):
        rows = [row for row in short("fig8").rows if row[2] < 5.0]
        assert fig8.checks(Table("fig8", fig8.COLUMNS, rows, [])) == []


class TestClosedForms:
    def test_elastica_is_that_of_the_tables(self):
        """Mattiasson's table of 1981 for F L^2/EI = 1 and 10: drop and shortening of the tip."""
        for load, drop, shortening in ((1.0, 0.30172, 0.05643), (10.0, 0.81061, 0.55500)):
            found = statics._bent_by_a_force(load)
            assert found == pytest.approx((drop, 1.0 - shortening), abs=6e-6)

    def test_square_of_textbooks(self):
        assert statics.square_torsion() / statics.SIDE**4 == pytest.approx(0.1406, abs=5e-5)

    def test_stiff_catenary_does_not_stretch(self):
        H, V, sag = statics._elastic(1e14)
        a = H / statics.WEIGHT
        assert 2 * a * math.sinh(5.0 / a) == pytest.approx(10.5, rel=1e-10)
        assert sag == pytest.approx(a * (math.cosh(5.0 / a) - 1), rel=1e-10)
        assert pytest.approx(0.5 * 10.5 * statics.WEIGHT) == V

    def test_thin_timoshenko_beam_is_eulers(self, monkeypatch):
        monkeypatch.setattr(vibration, "SIDE", 1e-4)
        k = math.pi / 2.0
        wanted = k**2 * math.sqrt(1e9 * 1e-8 / 12 / 1000.0)
        assert vibration._shear_frequency(k, 5 / 6) == pytest.approx(wanted, rel=1e-7)

    def test_deviation_is_that_of_the_row(self):
        table = short("closed-forms")
        for row in table.rows:
            assert row[4] == pytest.approx(row[2] / row[3] - 1.0, abs=1e-15)
        assert len(closed_forms.checks(table)) == len(table.rows) > 30


class TestTables:
    """Of example 7.4."""

    def test_trajectories_are_those_of_the_runs(self):
        table = short("fig10")
        assert table.kinds() == ["cable", "original", "nonlocking"]
        mesh = sliding.MESHES[2]
        t, *place, s = (table.values(column, **mesh.only) for column in ("t", "x", "y", "z", "s"))
        result = sliding.history(mesh, short=True)
        assert t == pytest.approx(result.t)
        assert np.abs(np.array(place).T - result.position("slider.end")).max() == 0.0
        assert s == pytest.approx(result.arc_length("joint"))

    def test_centrelines_meet_in_the_joint(self):
        """At each time the slider's first point lies on the carrier, where s says."""
        table = short("fig9")
        result = sliding.history(FIGURES["fig9"].MESH, short=True)
        for t in np.unique(table.values("t")):
            first = [table.values(c, t=t, body="slider")[0] for c in "xyz"]
            arc, *line = (table.values(c, t=t, body="carrier") for c in ("arc_length", "x", "y", "z"))
            s = result.arc_length("joint")[int(np.argmin(np.abs(result.t - t)))]
            there = [np.interp(s, arc, values) for values in line]
            assert first == pytest.approx(there, abs=2e-4)

    def test_times_and_counters(self):
        table = short("table2")
        assert [row[:3] for row in table.rows] == [
            ("original", 6, 2), ("nonlocking", 6, 2), ("cable", 6, 2), ("cable", 64, 4), ("cable", 128, 8)
        ]  # fmt: skip
        assert [row[8] for row in table.rows] == [38.0, 72.0, 6.0, 71.0, None]
        for row in table.rows:
            t, steps, iterations, jacobians, seconds = row[3:8]
            assert t == pytest.approx(0.25)
            assert steps == 1250
            assert iterations >= steps
            assert jacobians >= 1
            assert seconds > 0.0


class TestOrders:
    def table(self, errors):
        study = Study("s", MESH, "cable", 3, tuple(0.1 / 2**k for k in range(len(errors))), errors)
        return Table("orders", orders.COLUMNS, orders._rows(study), [])

    def test_rates(self):
        table = self.table((0.8, 0.1, 0.0125))
        assert [row[6] for row in table.rows] == [None, 3.0, 3.0]
        assert not failed(orders.checks(table))

    def test_the_last_rate_counts(self):
        assert not failed(orders.checks(self.table((0.2, 0.1, 0.0125))))
        assert failed(orders.checks(self.table((0.8, 0.1, 0.05))))

    def test_methods_have_their_orders(self):
        found = {row[0]: row[3] for row in short("orders").rows if row[1] == "step"}
        assert sorted(found.values()) == [2, 2, 2, 3, 5]


class TestStandard:
    def row(self, case, value, low, high):
        return (case, 250.0, "some force", "N", value, low, high, "inside", "V")

    @pytest.mark.parametrize(
        ("value", "passed"), [(110.0, True), (120.0, True), (109.9, False), (120.1, False)]
    )
    def test_limits_are_inside(self, value, passed):
        table = Table("en50318", en50318.COLUMNS, [self.row(en50318.JUDGED, value, 110.0, 120.0)], [])
        (check,) = en50318.checks(table)
        assert check.passed is passed

    def test_range_of_one_value(self):
        table = Table("en50318", en50318.COLUMNS, [self.row(en50318.JUDGED, 0.0, 0.0, 0.0)], [])
        assert not failed(en50318.checks(table))
        assert failed(en50318.checks(changed(table, "value", "add", 0.1)))

    def test_ranges_that_are_not_verified_are_not_judged(self):
        table = Table("en50318", en50318.COLUMNS, [self.row(en50318.SHOWN, 1e9, 0.0, 1.0)], [])
        assert en50318.checks(table) == []

    def test_verdicts_are_those_of_the_checks(self):
        table = short("en50318")
        assert [check.passed for check in judged("en50318")] == [row[7] == "inside" for row in table.rows]
        assert len(table.rows) == 8


@pytest.fixture(scope="module")
def reproduced(tmp_path_factory):
    """Folder with all figures in their short form, and the calls of progress; each is computed once here."""
    folder, calls = tmp_path_factory.mktemp("figures") / "new" / "folder", []
    with pytest.MonkeyPatch.context() as patch:
        for name, module in FIGURES.items():
            patch.setattr(module, "data", asked_for_short(short(name)))
        reproduce(["all"], folder, short=True, progress=lambda *call: calls.append(call))
    return folder, calls


def asked_for_short(table):
    """What an exhibit gives instead of computing it again."""

    def data(short):
        assert short
        return dataclasses.replace(table, notes=[*table.notes])

    return data


class TestReproduce:
    @pytest.mark.parametrize("name", COLUMNS)
    def test_writes_table_and_picture(self, reproduced, name):
        folder, _ = reproduced
        full = json.loads((folder / f"{name}.json").read_text(encoding="utf-8"))
        assert list(full) == ["name", "columns", "rows", "notes", "checks"]
        assert full["name"] == name
        assert full["columns"] == COLUMNS[name]
        assert full["rows"]
        assert all(len(row) == len(full["columns"]) for row in full["rows"])
        kinds = {"cable", "original", "nonlocking"}
        if name not in ("closed-forms", "connections", "orders", "derivatives", "overhead"):  # many names
            assert {row[0] for row in full["rows"]} == KINDS.get(name, kinds)
        assert len(full["notes"]) >= 4
        assert all(isinstance(note, str) for note in full["notes"])
        assert all(check["passed"] for check in full["checks"])
        with (folder / f"{name}.csv").open(newline="", encoding="utf-8") as file:
            head, *rows = csv.reader(file)
        assert head == full["columns"]
        texts = [["" if value is None else str(value) for value in row] for row in full["rows"]]
        assert texts == rows
        assert (folder / f"{name}.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"

    def test_reports_progress(self, reproduced):
        _, calls = reproduced
        count = len(FIGURES)
        assert [call[1:] for call in calls] == [(i, count) for i in range(count + 1)]
        assert [call[0] for call in calls[:-1]] == list(FIGURES)

    def test_every_figure_is_tested(self):
        assert set(COLUMNS) == set(FIGURES)

    def test_unknown_figure(self, tmp_path):
        with pytest.raises(ModelError, match=r'unknown figure "fig22".*did you mean "fig2"'):
            reproduce(["fig22"], tmp_path)

    def test_no_figure(self, tmp_path):
        with pytest.raises(ModelError, match="no figure named"):
            reproduce([], tmp_path)

    def test_folder_that_cannot_be_written(self, tmp_path):
        (tmp_path / "file").write_text("", encoding="utf-8")
        with pytest.raises(ModelError, match="cannot be written"):
            reproduce(["fig2"], tmp_path / "file" / "out", short=True)

    def test_without_matplotlib(self, tmp_path, monkeypatch):
        monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
        with pytest.raises(ModelError, match=r"ancf\[plot\]"):
            reproduce(["fig2"], tmp_path, short=True)
