"""Tables of measured columns for calibrations."""

import numpy as np
import pytest

import ancf
from ancf.design.calibration_data import bounds_of, columns_of, numbers_of, priors_of, start_of, unit_of

T = np.linspace(0.0, 2.0, 41)


class TestFiles:
    """Heads of measured tables may have units; a component of a formula is none."""

    HEAD = "t,position(beam.end)[2],position(beam.end)[1]"

    @pytest.mark.parametrize(
        ("head", "scale"),
        [
            ("t [s],position(beam.end)[2] [m],position(beam.end)[1] [m]", (1.0, 1.0, 1.0)),
            ("t [ms],position(beam.end)[2] [mm],position(beam.end)[1]", (1e3, 1e3, 1.0)),
            ("t (min),position(beam.end)[2],position(beam.end)[1] (km)", (1 / 60, 1.0, 1e-3)),
        ],
    )
    def test_units(self, tmp_path, head, scale):
        rows = np.column_stack([T, np.sin(T), np.cos(T)])
        for name, top, numbers in (("plain", self.HEAD, rows), ("units", head, rows * scale)):
            np.savetxt(tmp_path / f"{name}.csv", numbers, delimiter=",", header=top, comments="")
        plain, found = (columns_of(tmp_path / f"{name}.csv") for name in ("plain", "units"))
        assert plain.keys() == found.keys() == set(self.HEAD.split(","))
        for name, column in plain.items():
            assert found[name] == pytest.approx(column, rel=1e-12, abs=1e-15)

    @pytest.mark.parametrize(
        ("text", "phrase"),
        [
            ("t [furlong],x\n0,1\n", "is 'furlong', known are"),
            ("t [s],x [mm]\n0,long\n", "must hold numbers, holds 'long'"),
            ("t [s],x [mm],x\n0,1,1\n", 'has two columns "x"'),
            ("t [mm],x\n0,1\n", 'is \'mm\', wanted one of "s", "ms"'),
            ("t,position(b.at(0.5))[2] [kN]\n0,1\n", 'is \'kN\', wanted one of "m", "mm"'),
            ("t,tension(b.end) [m]\n0,1\n", 'is \'m\', wanted one of "N", "kN"'),
            ("t,strain(b.end) [mm]\n0,1\n", "is 'mm', wanted one of"),
        ],
    )
    def test_one_message(self, tmp_path, text, phrase):
        (tmp_path / "data.csv").write_text(text, encoding="utf-8")
        with pytest.raises(ancf.ModelError) as caught:
            columns_of(tmp_path / "data.csv")
        assert phrase in str(caught.value)

    def test_empty_entries_stay_empty(self, tmp_path):
        (tmp_path / "data.csv").write_text("t [ms],x [mm]\n0,1\n1000,\n", encoding="utf-8")
        found = columns_of(tmp_path / "data.csv")
        assert found["t"].tolist() == [0.0, 1.0]
        assert np.array_equal(found["x"], [1e-3, np.nan], equal_nan=True)


class TestBounds:
    """Where a parameter is looked for, and where the search begins."""

    @pytest.mark.parametrize(
        ("low", "high", "middle"),
        [
            (1.0, 9.0, 5.0),
            (2.0, 200.0, 20.0),
            (1e-6, 1e4, 0.1),
            (0.0, 100.0, 50.0),
            (-3.0, 100.0, 48.5),
            (-100.0, -1.0, -50.5),
        ],
    )
    def test_begins_in_the_middle_of_the_bounds_or_of_their_logarithms(self, low, high, middle):
        """The geometric mean of positive bounds that are more than ten apart, else the mean."""
        bounds = bounds_of({"EA": (low, high), "EI": (3.0, 5.0)})
        assert bounds == {"EA": (low, high), "EI": (3.0, 5.0)}
        assert start_of(None, bounds) == pytest.approx({"EA": middle, "EI": 4.0}, rel=1e-12)
        assert start_of({"EA": high}, bounds) == {"EA": high, "EI": 4.0}

    @pytest.mark.parametrize(
        ("given", "phrase"),
        [
            ({}, "must be bounds"),
            ([1.0, 2.0], "must be bounds"),
            ({"EA": (2.0, 2.0)}, "the first must be below"),
            ({"EA": (3.0, 2.0)}, "the first must be below"),
            ({"EA": (1.0, 2.0, 3.0)}, "EA"),
        ],
    )
    def test_none(self, given, phrase):
        with pytest.raises(ancf.ModelError) as caught:
            bounds_of(given)
        assert phrase in str(caught.value)

    @pytest.mark.parametrize("start", [{"EA": 0.9}, {"EA": 2.1}, {"EB": 1.5}])
    def test_no_start(self, start):
        with pytest.raises(ancf.ModelError, match=r"calibrate\.start: E"):
            start_of(start, {"EA": (1.0, 2.0)})

    @pytest.mark.parametrize("pair", [(0.9, 0.1), (2.1, 0.1), (1.5, 0.0), (1.5, -0.1)])
    def test_no_prior(self, pair):
        bounds = {"EA": (1.0, 2.0)}
        assert priors_of({"EA": (1.5, 0.1)}, bounds) == {"EA": (1.5, 0.1)}
        with pytest.raises(ancf.ModelError, match=r"calibrate\.priors: EA, its"):
            priors_of({"EA": pair}, bounds)


class TestColumns:
    @pytest.mark.parametrize("times", [[0.0, 0.1, 0.3], [0.2, 1.0], [5.0]])
    def test_increasing_times_from_0_on(self, times):
        found = columns_of({"t": times, "x": np.ones(len(times))})
        assert found["t"].tolist() == times

    @pytest.mark.parametrize("times", [[0.0, 0.0, 1.0], [0.0, 2.0, 1.0], [-0.1, 0.0], [], [0.0, np.nan]])
    def test_other_times(self, times):
        with pytest.raises(ancf.ModelError, match="must be increasing times from 0 on"):
            columns_of({"t": times, "x": np.ones(len(times))})

    @pytest.mark.parametrize("count", [1, 2, 4])
    def test_as_many_entries_as_times(self, count):
        with pytest.raises(ancf.ModelError, match=f"has {count} entries for 3 times"):
            columns_of({"t": [0.0, 1.0, 2.0], "x": np.ones(count)})

    @pytest.mark.parametrize(
        ("given", "phrase"),
        [([1.0, 2.0], "has the shape"), (1.0, "has the shape"), ([1.0, np.inf, 2.0], "is not finite")],
    )
    def test_what_a_model_gives_is_finite_and_as_long(self, given, phrase):
        times = np.arange(3.0)
        assert numbers_of([1, 2, 3], times, "x").tolist() == [1.0, 2.0, 3.0]
        with pytest.raises(ancf.ModelError) as caught:
            numbers_of(given, times, "x")
        assert phrase in str(caught.value)

    @pytest.mark.parametrize(
        ("column", "unit"),
        [
            ("t", "s"),
            ("tension(beam.end)", "N"),
            ("velocity(beam.at(0.5))[1]", "m/s"),
            ("spring_length(a)", "m"),
            ("multiplier(bead)", None),
            ("energy(total)", None),
            ("2*tension(beam.end)", None),
            ("x", None),
        ],
    )
    def test_unit_of_a_question(self, column, unit):
        """None where it depends on what is asked, as that of a multiplier, and of formulas."""
        assert unit_of(column) == unit
