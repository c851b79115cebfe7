"""Sweeps over speed and distance: cases against single runs, resuming, the report, bad input."""

import json
from types import SimpleNamespace

import numpy as np
import pandas as pd
import pypdfium2
import pytest
from typer.testing import CliRunner

from ancf import ModelError
from ancf.catenary import Mesh, Quantity, acceptance, read_line, run
from ancf.catenary.report.sweep import Sweep, pieces, warned, write_sweep
from ancf.cli.app import app
from ancf.design.sweep import SPACING, SPEED, SweepCase, sweep, values_of
from ancf.viz.html import page
from ancf.viz.printed.blocks import Picture, Table, blocks

LINE = """
title = "Short line"
system_height = 1.2
contact_wire = {EA = 15e6, EI = 195.0, mass = 1.35, tension = 20e3}
messenger_wire = {EA = 11.6e6, EI = 131.7, mass = 1.07, tension = 16e3}
droppers = {stiffness = 100e3}
steady_arm = {vertical = 300.0}
spans = [{repeat = 5, length = 40.0, droppers = [10.0, 20.0, 30.0]}]
"""
COARSE = {"mesh": Mesh(contact=2.5, messenger=5.0), "step": 2e-3, "pantograph": "en50318-2002"}


@pytest.fixture(scope="module")
def path(tmp_path_factory):
    made = tmp_path_factory.mktemp("line") / "line.toml"
    made.write_text(LINE)
    return made


@pytest.fixture(scope="module")
def swept(path, tmp_path_factory):
    folder = tmp_path_factory.mktemp("sweep")
    place = {"window": (80.0, 120.0), "until": 125.0}
    return (
        folder,
        place,
        sweep(read_line(path), (120.0, 180.0), (30.0, 45.0), folder=folder, workers=0, **COARSE, **place),
    )


class TestCases:
    def test_all_pairs_in_order(self, swept):
        _, _, table = swept
        pairs = list(zip(table[SPEED], table[SPACING], strict=True))
        assert pairs == [(120.0, 30.0), (120.0, 45.0), (180.0, 30.0), (180.0, 45.0)]
        assert set(table["status"]) == {"ok"}

    @pytest.mark.filterwarnings("ignore:run.window:UserWarning")
    @pytest.mark.parametrize("row", [1, 2])
    def test_each_is_a_run(self, swept, path, row):
        """The same numbers as a run of its own, to the last digit but those of another form of the line."""
        _, place, table = swept
        given = {key: value for key, value in COARSE.items() if key != "mesh"} | place
        at, apart = table[SPEED][row] / 3.6, table[SPACING][row]
        done = run(read_line(path), speed=at, spacing=apart, mesh=COARSE["mesh"], **given)
        for k in (0, 1):
            found = acceptance(done, k)
            assert {q.key: table[f"{q.key}_{k + 1}"][row] for q in found} == pytest.approx(
                {q.key: q.value for q in found}, rel=1e-9
            )
            accepted = all(q.inside is not False for q in found)
            assert table[f"accepted_{k + 1}"][row] == float(accepted)

    def test_goes_on(self, swept, path, monkeypatch):
        """Nothing is computed twice; what is new is added; another line is refused."""
        folder, place, table = swept
        calls = []
        monkeypatch.setattr("ancf.design.sweep.run_line", lambda *a, **k: calls.append(k) or 1 / 0)
        line, more = read_line(path), {**COARSE, **place, "folder": folder, "workers": 0}
        again = sweep(line, (120.0, 180.0), (30.0, 45.0), **more)
        assert calls == []
        pd.testing.assert_frame_equal(again, table)
        longer = sweep(line, (120.0, 150.0, 180.0), (30.0, 45.0), **more)
        assert [call["speed"] for call in calls] == [150.0 / 3.6] * 2
        assert list(longer["status"] == "failed") == [False, False, True, True, False, False]
        other = read_line(path, {"contact_wire.tension": 21e3})
        with pytest.raises(ModelError, match="another study"):
            sweep(other, (120.0,), (30.0,), **more)

    @pytest.mark.parametrize(
        ("values", "accepted"), [((1.0, 1.0), 1.0), ((1.0, 9.0), 0.0), ((9.0, 9.0), 0.0)]
    )
    def test_accepted_is_what_no_limit_speaks_against(self, path, monkeypatch, values, accepted):
        """A quantity without a limit says nothing."""
        found = [Quantity(f"q{k}", "", "N", value, high=5.0) for k, value in enumerate(values)]
        monkeypatch.setattr("ancf.design.sweep.run_line", lambda *a, **k: SimpleNamespace(recordings=[0]))
        monkeypatch.setattr(
            "ancf.design.sweep.acceptance", lambda *a: [*found, Quantity("free", "", "N", 3.0)]
        )
        case = SweepCase(read_line(path), {}, mesh=COARSE["mesh"])
        assert case(**{SPEED: 100.0}) == {
            "q0_1": values[0], "q1_1": values[1], "free_1": 3.0, "accepted_1": accepted,
            "outside_q0_1": float(values[0] > 5.0), "outside_q1_1": float(values[1] > 5.0),
        }  # fmt: skip


class TestValues:
    @pytest.mark.parametrize(
        ("text", "values"),
        [
            ("160:320:20", np.arange(160.0, 321.0, 20.0)),
            ("250", [250.0]),
            ("200,250:300:25", [200.0, 250.0, 275.0, 300.0]),
            ("0.1:0.3:0.1", [0.1, 0.2, 0.3]),
        ],
    )
    def test_of_texts(self, text, values):
        assert values_of(text, "--speed") == pytest.approx(list(values))

    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("160:320", "is no number and no range"),
            ("fast", '"fast" is no number and no range'),
            ("160:320:-20", "has a step of -20, must be > 0"),
            ("100:160:0", "has a step of 0, must be > 0"),
            ("320:160:20", "is empty: it begins at 320, not below 160"),
            ("160:330:20", "does not end at 330: the steps from 160 on are 20 .*last is 320 or 340"),
            ("200,200", "200 is given twice"),
            ("-5", "must be > 0"),
            ("nan", '"nan" is no number'),
            ("1:2:1e-9", "more than 10000 values"),
            ("", "is no number"),
        ],
    )
    def test_wrong(self, text, said):
        with pytest.raises(ModelError, match=f"--speed: .*{said}"):
            values_of(text, "--speed")


def made_up(speeds, spacings, count):
    """Cases with plain numbers; the second one has failed."""
    rows = []
    for v in speeds:
        for d in spacings or [None]:
            row = {SPEED: v, "status": "ok", "message": ""} | ({} if d is None else {SPACING: d})
            for k in range(1, count + 1):
                row |= {f"mean_force_{k}": 100.0 + v / 10, f"deviation_{k}": 10.0 * k + v / 20}
                row |= {f"mean_force_low_{k}": 80.0, f"mean_force_high_{k}": 150.0, f"accepted_{k}": 2.0 - k}
                row |= {f"minimum_{k}": 30.0, f"maximum_{k}": 200.0, f"arcing_{k}": 0.0, f"uplift_{k}": 40.0}
            rows.append(row)
    if len(rows) > 1:
        rows[1] = {key: rows[1][key] for key in (SPEED, SPACING) if key in rows[1]} | {
            "status": "failed", "message": "run.start: outside"
        }  # fmt: skip
    names = [f"unit {k + 1}" for k in range(count)]
    return Sweep("Line <A>", rows, SPEED, SPACING, names, [("Pantographs", ", ".join(names))])


class TestReport:
    @pytest.mark.parametrize(
        ("speeds", "spacings", "count"),
        [((200.0,), (), 1), ((160.0, 200.0, 250.0), (), 1), ((250.0,), (50.0, 100.0, 200.0), 2),
         ((160.0, 200.0), (50.0, 100.0), 2), (tuple(np.arange(100.0, 200.0)), (), 1)],
    )  # fmt: skip
    def test_pieces(self, speeds, spacings, count):
        given = made_up(speeds, spacings, count)
        parts = pieces(given, "title", save=lambda _: b"png")
        found = list(blocks(parts))
        assert sum(isinstance(block, Picture) for block in found) == count
        tables = [block for block in found if isinstance(block, Table)]
        assert [len(t.rows) - 1 for t in tables[:count]] == [len(given.done)] * count
        assert len(tables) == count + (len(given.rows) > 1)
        text = page("title", *parts)
        assert ("run.start: outside" in text) == (len(given.rows) > 1)
        accepted = len(given.done) if count == 1 else 0
        assert f"{accepted} of {len(given.rows)} cases are accepted with all pantographs" in text

    def test_warnings_once_with_their_cases(self):
        given = made_up((160.0, 200.0, 250.0), (), 1)
        speed = "run.speed: {} km/h is {} of the wave speed"
        given.rows[0]["message"] = f"warning: {speed.format(160, 0.91)}; warning: run.step: 5 ms is long"
        given.rows[2]["message"] = f"warning: {speed.format(250, 1.42)}"
        assert warned(given.rows, SPEED, SPACING) == [
            (speed.format(160, 0.91), ["160 km/h", "250 km/h"]),
            ("run.step: 5 ms is long", ["160 km/h"]),
        ]
        text = page("title", *pieces(given, "title", save=lambda _: b"png"))
        assert "160 km/h, 250 km/h" in text
        assert "run.step: 5 ms is long" in text

    def test_files(self, tmp_path):
        files = write_sweep(made_up((160.0, 200.0, 250.0), (), 1), tmp_path, ("html", "pdf", "docx"))
        assert [path.name for path in files] == ["report.html", "report.pdf", "report.docx"]
        assert "Line &lt;A&gt;: sweep" in files[0].read_text()
        text = pypdfium2.PdfDocument(files[1])[0].get_textpage().get_text_range()
        assert "Line <A>: sweep" in text


class TestCommand:
    def sweep(self, *arguments):
        return CliRunner().invoke(app, ["catenary", "sweep", *map(str, arguments)])

    def test_writes_and_tells(self, path, tmp_path):
        options = ["--speed", "150", "--spacing", "30", "--step", "0.002", "--mesh", "2.5", "5", "-j", "1"]
        place = ["--window", "80", "120", "--pantograph", "en50318-2002", "-o", tmp_path]
        done = self.sweep(path, *options, *place, "--until", "125")
        assert done.exit_code == 0, done.output
        table = pd.read_csv(tmp_path / "table.csv")
        assert table[SPEED].tolist() == [150.0]
        assert f"{table['deviation_2'][0]:.1f}" in done.output
        assert json.loads((tmp_path / "study.json").read_text())["failed"] == 0
        assert {"report.html", "report.pdf", "report.docx"} <= {p.name for p in tmp_path.iterdir()}
        assert "en50318-2002 (2)" in (tmp_path / "report.html").read_text()

    @pytest.mark.parametrize(
        ("changes", "said"),
        [
            ((), ["as designed, 10 °C, fixed ends", "contact wire 20000 N (designed 20000)"]),
            (
                ("anchors=tension", "conditions.contact_tension=15e3", "conditions.wear=0.2"),
                [
                    "contact wire worn by 20 %",
                    "pulled by weights",
                    "contact wire 15000 N (designed 20000)",
                ],
            ),
            (
                ("anchors=fixed", "conditions.temperature=-20", "conditions.wind=12"),
                ["-20 °C, wind 12 m/s, fixed ends", "N (designed 16000)"],
            ),
        ],
    )
    def test_says_the_conditions_of_the_line(self, path, tmp_path, changes, said):
        """On the screen and in the report, whose title has what is not as designed."""
        line = path.with_name("wide.toml")
        line.write_text(LINE.replace("mass = 1", "diameter = 0.013, mass = 1"))
        options = ["--speed", "150", "--step", "0.002", "--mesh", "2.5", "5", "-j", "0", "--to", "html"]
        sets = [word for change in changes for word in ("--set", change)]
        done = self.sweep(line, *options, *sets, "--window", "80", "90", "--until", "95", "-o", tmp_path)
        assert done.exit_code == 0, done.output
        report = (tmp_path / "report.html").read_text("utf-8")
        for text in said:
            assert text in " ".join(done.output.split())
            assert text in report
        title = report.partition("<title>")[2].partition("</title>")[0]
        assert title.startswith("Short line: sweep" if not changes else "Short line, ")

    @pytest.mark.parametrize(
        ("arguments", "said"),
        [
            (("--speed", "300:100:20"), "--speed"),
            (("--speed", "100", "--spacing", "a"), "--spacing"),
            (("--speed", "100", "--to", "odt"), "--to"),
            (("--speed", "100", "--pantograph", "no"), 'there is no "no"'),
        ],
    )
    def test_wrong(self, path, tmp_path, arguments, said):
        done = self.sweep(path, *arguments, "-o", tmp_path / "out")
        assert done.exit_code == 2
        assert said in done.output
        assert not (tmp_path / "out").exists()
