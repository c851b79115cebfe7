"""Tables of measured columns for calibrations."""

import numpy as np
import pytest

import ancf
from ancf.design.calibration_data import columns_of

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
