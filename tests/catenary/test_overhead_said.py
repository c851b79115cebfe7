"""What is said of the state in which a line was looked at: form, elasticity, runs, comparisons, reports."""

import json
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from typer.testing import CliRunner

from ancf.catenary import Conditions, Route, form, read_line, run, statistics
from ancf.catenary.answers.kept import read_run
from ancf.catenary.answers.state import state, tensions, titled
from ancf.catenary.answers.write import summary, write_json, write_run
from ancf.catenary.report import write_reports
from ancf.cli.app import app
from overhead_lines import COARSE, STEP, TOML, collector, short_line


def invoked(*arguments):
    done = CliRunner().invoke(app, list(map(str, arguments)))
    assert done.exit_code == 0, done.output
    return " ".join(done.output.split())


def hot(degrees=40.0, **given):
    return replace(short_line(**given), conditions=Conditions(temperature=degrees))


class TestWords:
    def test_state(self):
        assert state(short_line()) == "as designed, 10 °C, fixed ends"
        line = replace(
            short_line(anchors="tension"), conditions=Conditions(temperature=-5.0, wear=0.2, ice=0.5)
        )
        assert state(line) == "-5 °C, ice 0.5 kg/m, contact wire worn by 20 %, ends pulled by weights"
        assert titled(line) == "Short line, -5 °C, ice 0.5 kg/m, contact wire worn by 20 %"
        assert titled(short_line()) == "Short line"

    @pytest.mark.parametrize("anchors", list(product(("fixed", "tension"), repeat=3)))
    def test_ends_of_all_sections(self, anchors):
        """Only those of the first section were told."""
        lines = [short_line(anchors=kind, stagger=0.0, height=(0.1, *[0.0] * 4, 0.1)) for kind in anchors]
        told = state(Route(lines=tuple(lines), starts=(0.0, 136.0, 272.0)))
        words = {"fixed": "fixed ends", "tension": "ends pulled by weights"}
        if len(set(anchors)) == 1:
            assert told == f"as designed, 10 °C, {words[anchors[0]]}"
            return
        for kind, text in words.items():
            at = [f"{k + 1}" for k, own in enumerate(anchors) if own == kind]
            assert f"{text} (section{'s' * (len(at) > 1)} {', '.join(at)})" in told

    def test_tensions_between_fixed_ends(self):
        """Heat takes EA alpha dT from wires that hang nearly straight; sag gives some of it back."""
        rows = {name: (was, low) for name, was, low, _ in tensions(form(hot(15.0), COARSE))}
        was, low = rows["contact wire"]
        assert was == 20e3
        assert 0.5 < (was - low) / (15e6 * 17e-6 * 5.0) < 1.0


class TestCut:
    @pytest.mark.parametrize("anchors", ["tension", "fixed"])
    def test_lengths_that_are_cut_stay(self, anchors):
        """They are measured in the shop, whatever the weather in which the line is looked at."""
        plain, warm = form(short_line(anchors=anchors), COARSE), form(hot(anchors=anchors), COARSE)
        assert warm.cut_length == pytest.approx(plain.dropper_natural, rel=1e-12)
        assert warm.dropper_natural == pytest.approx(plain.dropper_natural * (1 + 17e-6 * 30.0), rel=1e-12)
        assert [row.natural for row in warm.schedule()] == pytest.approx(1e3 * plain.dropper_natural)

    def test_wave_speed_of_a_worn_wire(self):
        """sqrt(T/((1 - w) m)) under the same weights."""
        worn = replace(short_line(anchors="tension"), conditions=Conditions(wear=0.2))
        assert worn.wave_speed == pytest.approx(np.sqrt(20e3 / (0.8 * 1.35)), rel=1e-3)
        assert form(worn, COARSE).wave_speed == pytest.approx(worn.wave_speed, rel=1e-4)
        iced = replace(short_line(anchors="tension"), conditions=Conditions(ice=0.5, contact_tension=18e3))
        assert form(iced, COARSE).wave_speed == pytest.approx(iced.wave_speed, rel=1e-4)


def test_form_and_elasticity_print_it(tmp_path):
    (tmp_path / "line.toml").write_text(
        TOML.replace("[contact_wire]", 'anchors = "fixed"\n[contact_wire]', 1)
    )
    found = form(read_line(tmp_path / "line.toml", {"conditions.temperature": 35.0}))
    for command in ("form", "elasticity"):
        said = invoked("catenary", command, tmp_path / "line.toml", "--set", "conditions.temperature=35")
        assert "35 °C, fixed ends; at rest contact wire" in said
        assert f"wave speed {3.6 * found.wave_speed:.0f} km/h" in said
        assert f"contact wire {found.pull[0].min():.0f}" in said
        assert "(designed 20000)" in said


@pytest.fixture(scope="module")
def done():
    return run(hot(30.0), speed=40.0, pantograph=collector(), step=STEP, mesh=COARSE)


class TestRuns:
    def test_report(self, done, tmp_path, undrawn):
        write_reports(done, tmp_path, ("html",))
        text = (tmp_path / "report.html").read_text()
        assert "<h1>Short line, 30 °C, 144 km/h</h1>" in text
        pull = done.form.pull[0]
        assert f"contact wire {pull.min():.0f} N (designed 20000)" in text
        assert "tension of the contact wire in this state [N]" in text

    def test_comparison(self, done, tmp_path):
        found = [statistics(done)]
        for name in ("one", "two"):
            write_json(summary(done, found), tmp_path / name / "run.json")
            write_run(done, tmp_path / name, found)
        assert json.loads((tmp_path / "one" / "run.json").read_text())["state"] == "30 °C, fixed ends"
        said = f"30 °C, fixed ends, contact wire {done.form.pull[0].min():.0f} N (designed 20000)"
        assert said in read_run(tmp_path / "one")[0].state
        printed = invoked("catenary", "compare", tmp_path / "one", tmp_path / "two", "-o", tmp_path / "both")
        assert said in printed
        assert said in (tmp_path / "both" / "report.html").read_text()
