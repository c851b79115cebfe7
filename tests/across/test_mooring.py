"""Mooring lines against MoorPy, MoorDyn and a measured chain: the stored numbers and the report of them."""

import json

import numpy as np
import pytest

from ancf.mooring import cases, validate

ROWS = {(row["case"], row["key"]): row for group in validate.references()["group"] for row in group["row"]}


@pytest.fixture(scope="module")
def chain():
    return cases.forces_of_chain()


@pytest.mark.parametrize("key", [key for case, key in ROWS if case == "chain"])
def test_chain_of_moordyn(chain, key):
    """Statics within 0.05 %, extremes of 160 segments within 1 %, with 20 elements."""
    row = ROWS["chain", key]
    assert len(cases.GRADED) == 21
    assert chain[key] == pytest.approx(row["value"], rel=row["share"])
    assert row["share"] <= (5e-4 if key.startswith("static") else 1e-2)


@pytest.mark.parametrize(("radius", "period", "measured"), [(0.125, 2.0, 47.5), (0.15, 3.0, 45.8)])
def test_measured_chain(radius, period, measured):
    """Two of the motions, with coarse steps; the command takes all."""
    assert cases.mean_peak(radius, period, steps=250, elements=20) == pytest.approx(measured, abs=1.6)


class TestReport:
    @pytest.fixture
    def groups(self, monkeypatch):
        """Numbers that are not computed: each reference times 1 + 0.2 %, measured peaks plus 1 N."""

        def near(case):
            return lambda *_: {key: 1.002 * row["value"] for (name, key), row in ROWS.items() if name == case}

        monkeypatch.setattr(cases, "catenary", lambda mu: near("rubbing catenary" if mu else "catenary")())
        monkeypatch.setattr(cases, "forces_of_chain", near("chain"))
        monkeypatch.setattr(cases, "heaving_chain", near("heaving chain"))
        measured = validate.references()["measured"]
        printed = iter([force for row in measured["periods"].values() for force in row])
        monkeypatch.setattr(cases, "mean_peak", lambda radius, period: next(printed) + 1.0)
        said = []
        groups = validate.compare(lambda done, of: said.append((done, of)))
        assert said == [(k, 19) for k in range(1, 20)]
        return groups

    def test_ranges(self, groups):
        """0.2 % is inside of 1 % and of 5 % of a range, outside of 0.05 % and of 1e-4."""
        verdicts = {q.name: q.inside for group in groups for q in group.rows if q.inside is not None}
        assert verdicts["H without friction"] is False
        assert verdicts["root mean square error of all"] is True
        for group in groups[1:3]:
            for q in group.rows:
                tight = "static" in q.name and "320" in group.title
                assert q.inside is (not tight), q.name

    def test_root_mean_square(self, groups):
        assert groups[-1].rows[-1].value == pytest.approx(1.0)
        assert [q.value for q in groups[-1].rows[:2]] == pytest.approx([43.5, 47.8])

    def test_files(self, groups, tmp_path):
        written = validate.write(groups, tmp_path)
        assert [path.name for path in written] == ["validate.json", "report.html"]
        plain = json.loads(written[0].read_text())
        assert plain["case"] == "mooring"
        assert plain["all_inside"] is False
        assert len(plain["rows"]) == sum(len(group.rows) for group in groups) == 28
        assert set(plain["rows"][0]) == {
            *("quantity", "unit", "value", "low", "high", "inside", "tag"),
            "reference",
        }
        for row, (number, _) in zip(plain["rows"], [*ROWS.items()], strict=False):
            assert row["reference"] == pytest.approx(ROWS[number]["value"], rel=1e-12)
        assert [row["reference"] for row in plain["rows"][12:14]] == [42.5, 46.8]
        assert set(plain["source"]) == {group.title for group in groups}
        page = written[1].read_text()
        assert page.count("<table>") == len(groups)
        assert "outside" in page
        assert page.count("data:image/svg+xml") == 1
        assert "+0.2 %" in page
        assert "9 of 13 inside the accepted ranges" in page
        assert "10.3390/jmse4010005" in page
        assert [path.name for path in validate.write(groups, tmp_path, report=False)] == ["validate.json"]


def test_peaks_are_of_the_cycles_that_are_read():
    model, line = cases.measured_chain(0.1, 2.0)

    class Run:
        t = np.linspace(0.0, 12.0, 121)

        def tension(self, point):
            assert point == line.end
            return np.floor(self.t / 2.0) + np.sin(np.pi * self.t)

    assert model.fluids
    assert cases.peaks(Run(), line, 2.0) == pytest.approx([4.0, 5.0, 6.0])
