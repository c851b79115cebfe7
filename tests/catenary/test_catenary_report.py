"""The HTML report and ``ancf validate``, on a made-up run."""

import base64
import dataclasses
import html
import io
import json
from html.parser import HTMLParser
from types import SimpleNamespace
from xml.etree import ElementTree

import numpy as np
import pytest
from matplotlib.image import imread
from typer.testing import CliRunner

import catenary_stand_in as stand_in
from ancf import ModelError
from ancf.catenary import (
    Auxiliary,
    DropperRule,
    Droppers,
    Elasticity,
    MeasuringHead,
    StitchWire,
    Wire,
    measure,
    validate,
)
from ancf.catenary.answers.acceptance import acceptance, verdict
from ancf.catenary.answers.quantity import shown
from ancf.catenary.answers.references import reference_case
from ancf.catenary.answers.statistics import statistics
from ancf.catenary.report import Content, write_report
from ancf.catenary.report.figures import FIGURES, figure_names, picture
from ancf.catenary.report.tables import line_data, pantograph_data
from ancf.cli.app import app
from ancf.viz import style
from commands import python
from overhead_lines import collector, short_line

ROW = ["quantity", "unit", "value", "low", "high", "inside", "tag"]
NAMES = (
    "mean force Fm",
    "standard deviation 0-20 Hz",
    "Fm + 3 sigma",
    "Fm - 3 sigma",
    "actual maximum",
    "actual minimum",
    "uplift at support",
    "loss of contact",
)
#: Those that the table of the measuring pantograph has too.
MEASURED = NAMES[:2]
VOID = {"meta", "link", "img", "br", "hr"}


@pytest.fixture(scope="module")
def run():
    return stand_in.run()


@pytest.fixture(scope="module")
def two():
    return stand_in.run(count=2)


def at_speed(run, kmh):
    return dataclasses.replace(run, speed=kmh / 3.6)


class Page(HTMLParser):
    """Reads a page; every element must be closed in order."""

    def __init__(self, text):
        super().__init__()
        self.open, self.tags, self.texts = [], [], []
        self.feed(text)
        self.close()
        assert self.open == []

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, dict(attributes)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag):
        assert self.open.pop() == tag

    def handle_data(self, data):
        self.texts.append(data)

    def all(self, tag):
        return [attributes for name, attributes in self.tags if name == tag]


@pytest.fixture(scope="module")
def text(run, tmp_path_factory):
    path = tmp_path_factory.mktemp("report") / "deep" / "report.html"
    given = {"reference": reference_case("en50318-2002"), "elasticity": stand_in.elasticity()}
    write_report(run, path, measured=[measure(run, head=MeasuringHead(corrected_mass=0.0))], **given)
    return path.read_text(encoding="utf-8")


class TestReport:
    def test_needs_nothing_else(self, text):
        assert text.startswith("<!DOCTYPE html>\n<html lang=")
        page = Page(text)
        assert "http" not in text
        assert page.all("script") == []
        sources = [a.get("src") or a.get("href") for tag in ("img", "link", "a") for a in page.all(tag)]
        assert all(source.startswith(("data:", "#")) for source in sources)
        assert "url(" not in text
        assert "@import" not in text

    def test_links_lead_somewhere(self, text):
        page = Page(text)
        ids = [a["id"] for _, a in page.tags if "id" in a]
        assert len(ids) == len(set(ids))
        assert {a["href"][1:] for a in page.all("a")} <= set(ids)

    def test_has_every_figure(self, text):
        page = Page(text)
        assert [a["id"] for a in page.all("figure")] == [f"figure-{name}" for name in FIGURES]
        for image in page.all("img"):
            svg = base64.b64decode(image["src"].removeprefix("data:image/svg+xml;base64,"))
            assert ElementTree.fromstring(svg).tag.endswith("svg")
            assert image["alt"]

    def test_has_every_row(self, text, run):
        cells = [t.strip() for t in Page(text).texts]
        for q in statistics(run).quantities:
            assert cells.count(q.name) >= 1, q.name
            assert shown(q.value, q.unit) in cells
        for name in NAMES:
            assert cells.count(name) == (2 if name not in MEASURED else 3), name
        assert {"inside", "outside", "V2", "190 to 210", "20 to 40"} <= set(cells)
        assert "Butterworth" in text
        assert "real-time factor" in text
        assert "contact stiffness" in text
        assert "998.0" in cells  # length of the first dropper in mm
        assert any("3 of 8 quantities inside" in c and "with a filter of order 4" in c for c in cells)

    def test_escapes(self, run, tmp_path, undrawn):
        made = dataclasses.replace(run, settings={"<b>": "a & b </td>"})
        Page(write_report(made, tmp_path / "r.html").read_text())

    def test_several_pantographs(self, two, tmp_path):
        text = write_report(two, tmp_path / "r.html", reference=reference_case("en50318-2002")).read_text()
        page = Page(text)
        ids = {a["id"] for a in page.all("section")}
        assert {"statistics-1", "statistics-2", "droppers-1", "droppers-2"} <= ids
        assert "Statistics, leading" in page.texts
        assert "Statistics, trailing 1" in page.texts
        assert page.texts.count("uplift at support") == 3  # each against its range, and both side by side

    def test_equal_names_are_told_apart(self, two):
        same = [dataclasses.replace(r, name="twin") for r in two.recordings]
        content = Content.of(dataclasses.replace(two, recordings=same))
        assert [content.name(0), content.name(1)] == ["twin (1)", "twin (2)"]

    @pytest.mark.parametrize("factor", [0.5, 2.0])
    def test_a_verdict_keeps_its_capitals(self, run, factor, tmp_path, undrawn):
        """Names of quantities and units, at the head of the page as on the screen."""
        recordings = [dataclasses.replace(one, force=factor * one.force) for one in run.recordings]
        made = dataclasses.replace(run, recordings=recordings)
        told = verdict(acceptance(made, 0))
        assert told != told.lower()
        page = html.unescape(write_report(made, tmp_path / "page.html").read_text(encoding="utf-8"))
        assert f"O{told[1:]} of EN 50367" in page

    def test_speed_without_ranges(self, run, tmp_path, undrawn):
        reference = reference_case("en50318-2002")
        text = write_report(at_speed(run, 260.0), tmp_path / "r.html", reference=reference).read_text()
        assert "no accepted ranges at 260 km/h" in text

    def test_figures_without_elasticity(self, run):
        assert set(FIGURES) - set(figure_names(Content.of(run))) == {"elasticity", "measured"}

    @pytest.mark.parametrize("name", ["form", "force", "histogram", "uplift", "dropper-extremes"])
    def test_a_figure_is_drawn_once_for_all_formats(self, run, name, monkeypatch):
        """On paper it looks as if it had been drawn for it."""
        kind, drawn = FIGURES[name], []

        def draw(content, figure):
            drawn.append(figure)
            kind.draw(content, figure)

        alone, content = Content.of(run), Content.of(run)
        picture(name, alone, style.png)
        monkeypatch.setitem(FIGURES, name, dataclasses.replace(kind, draw=draw))
        assert picture(name, content, style.svg).startswith("<?xml")
        after = imread(io.BytesIO(picture(name, content, style.png)))
        assert len(drawn) == 1
        assert np.mean(after[..., :3].min(axis=2) < 0.9) > 0.01  # there is something on it
        for one, two in zip(alone.drawn[name].axes, content.drawn[name].axes, strict=True):
            assert one.get_position().bounds == pytest.approx(two.get_position().bounds, abs=0.01)

    def test_elasticity(self, text):
        cells = Page(text).texts
        assert "Static elasticity of span 5" in cells
        at = cells.index("non-uniformity [%]")
        row = [c for c in cells[at + 1 :] if c.strip()][:8]
        assert row == ["100", "0.4000", "0.6000", "20.0", "200", "0.4400", "0.6600", "20.0"]

    def test_loads_of_the_supports(self, text):
        """What steady arms pull and carry at rest stands beside their uplift."""
        cells = [c for c in Page(text).texts if c.strip()]
        at = cells.index("carries [N]")
        assert cells[at - 1] == "pulls to the left [N]"
        assert cells[at + 2 : at + 6] == ["1", "0", "40", "0"]
        assert cells[at + 7 : at + 11] == ["2", "60", "-20", "0"]

    def test_measured(self, text, run):
        """The table of the measuring pantograph: true, measured and what is between them."""
        cells, found = Page(text).texts, measure(run, head=MeasuringHead(corrected_mass=0.0))
        at = cells.index("measured [N]")
        row = [c for c in cells[at + 1 :] if c.strip()][1:5]
        true, force = (float(np.std(f[found.window])) for f in (found.true, found.force))
        mean = float(np.mean(found.true[found.window]))
        assert row[:2] == ["mean force Fm", f"{mean:.1f}"]
        assert f"{true:.1f}" in cells
        assert f"{force - true:+.2f}" in cells
        assert f"{found.largest_error:.2f}" in cells

    def test_a_line_without_losses_and_slack(self, run, tmp_path):
        calm = [dataclasses.replace(r, force=np.full(run.t.size, 120.0)) for r in run.recordings]
        forces = np.full_like(run.dropper_force, 80.0)
        made = dataclasses.replace(run, recordings=calm, dropper_force=forces, uplift=0 * run.uplift)
        Page(write_report(made, tmp_path / "r.html").read_text())
        assert statistics(made)["loss"].value == 0.0
        assert statistics(made)["slack_droppers"].value == 0


class TestWindow:
    @pytest.mark.parametrize(
        ("spans", "count", "window"), [(10, 2, (240, 360)), (9, 3, (180, 360)), (10, 3, (180, 360))]
    )
    def test_middle(self, spans, count, window):
        assert validate.middle_spans(stand_in.line(spans), count) == window

    def test_end_spans_are_dropped(self):
        with pytest.raises(ModelError, match="cannot evaluate 9 of 10 spans"):
            validate.middle_spans(stand_in.line(10), 9)


class TestCommand:
    def validate(self, monkeypatch, run, *arguments):
        calls = []

        def reference_run(case, speed_kmh, progress=None):
            calls.append((case, speed_kmh))
            if progress:
                progress(SimpleNamespace(step=1, steps=1, t=1.0))
            return at_speed(run, speed_kmh)

        monkeypatch.setattr(validate, "reference_run", reference_run)
        made = Elasticity(4, np.array([0.0, 30.0, 60.0]), np.array([100.0]), np.array([[0.02, 0.04, 0.02]]))
        monkeypatch.setattr(validate, "elasticity_beside", lambda line: made)
        return CliRunner().invoke(app, ["validate", *arguments]), calls

    def test_writes_and_prints(self, monkeypatch, run, tmp_path, undrawn):
        arguments = ("en50318-2002", "--speed", "250", "-o", str(tmp_path))
        done, calls = self.validate(monkeypatch, run, *arguments)
        assert done.exit_code == 0, done.output
        assert calls == [("en50318-2002", 250.0)]
        assert "standard deviation 0-20 Hz" in done.stdout
        assert "3 of 8 inside the accepted ranges; with a filter of order 4 instead of 6" in done.stdout
        assert "real-time factor" in done.stdout
        found = json.loads((tmp_path / "validate.json").read_text())
        assert (found["case"], found["speed_kmh"]) == ("en50318-2002", 250.0)
        assert found["real_time_factor"] == run.real_time_factor
        assert [list(row) for row in found["rows"]] == [ROW] * 8
        assert found["all_inside"] is False
        assert found["note"] == ""
        written = {"report.html", "elasticity.csv", "statistics.csv", "force_1.csv"}
        assert written <= {p.name for p in tmp_path.iterdir()}

    def test_without_a_speed_it_runs_each_that_has_ranges(self, monkeypatch, run, tmp_path):
        """The case by the beginning of its name, which it alone has."""
        arguments = ("en50318-2018", "-o", str(tmp_path / "new"), "--no-report")
        done, calls = self.validate(monkeypatch, run, *arguments)
        assert done.exit_code == 0, done.output
        assert calls == [("en50318-2018-ac-simple", 275.0), ("en50318-2018-ac-simple", 320.0)]
        for kmh in (275, 320):
            found = json.loads((tmp_path / f"new/{kmh}/validate.json").read_text())
            assert found["speed_kmh"] == kmh

    def test_quiet(self, monkeypatch, run, tmp_path):
        arguments = ("en50318-2002", "--speed", "250", "-o", str(tmp_path), "-q", "--no-report")
        done, _ = self.validate(monkeypatch, run, *arguments)
        assert (done.exit_code, done.output) == (0, "")

    @pytest.mark.parametrize(
        ("arguments", "message"),
        [
            (("en50318-202", "--speed", "250"), 'there is no "en50318-202"'),
            (("en50318-2002", "--speed", "-5"), "--speed: must be > 0"),
            (("en50318-2002", "--speed", "nan"), "--speed: must be a finite number"),
            (("en50318",), 'there is no "en50318"'),
        ],
    )
    def test_wrong_input(self, monkeypatch, run, tmp_path, arguments, message):
        done, calls = self.validate(monkeypatch, run, *arguments, "-o", str(tmp_path / "out"))
        assert done.exit_code == 2
        assert message in done.output
        assert calls == []


def test_without_matplotlib_it_says_what_to_install(tmp_path):
    """Tables and files need no matplotlib; the report stops before anything is written."""
    code = f"""
import sys
sys.modules["matplotlib"] = None
sys.path.insert(0, {str(stand_in.__file__.rsplit("/", 1)[0])!r})
import catenary_stand_in
from pathlib import Path
from ancf.catenary.report import write_report
from ancf.catenary.answers.write import write_run
run, folder = catenary_stand_in.run(), Path({str(tmp_path)!r})
write_run(run, folder)
try:
    write_report(run, folder / "report.html")
except Exception as error:
    print(error)
"""
    done = python(code)
    assert done.code == 0, done.err
    assert done.out == "figures: matplotlib is not installed (pip install 'ancf[plot]')\n"
    assert (tmp_path / "statistics.csv").exists()
    assert not (tmp_path / "report.html").exists()


class TestShape:
    """The picture of the line at rest has the places of wires and droppers."""

    def drawn(self, content):
        with style.new_figure(180, 150) as figure:
            FIGURES["form"].draw(content, figure)
            return figure.axes

    def test_wires_droppers_and_strips(self, run):
        form = run.form
        side, sag, plan = self.drawn(Content.of(run))
        assert [line.get_ydata().tolist() for line in side.lines[:2]] == [
            shape.position[:, 2].tolist() for shape in (form.contact, form.messenger)
        ]
        ends = np.array([segment for c in side.collections for segment in c.get_segments()])
        droppers = ends[np.isin(ends[:, 0, 0], form.line.dropper_x)][:, :, 1]
        assert np.ptp(droppers, axis=1) == pytest.approx(form.dropper_length)
        assert np.all(sag.lines[0].get_ydata() == 0.0)
        strips = [line.get_ydata()[0] for line in plan.lines if line.get_linestyle() == "--"]
        assert {-725.0, 725.0} <= set(strips)

    def test_tension_lengths_in_their_places(self, run):
        """Staggers and sag from the nominal height of a second tension length that begins at 540 m."""
        line = stand_in.line()
        line.height_at = lambda x: 5.0 + 0.001 * np.asarray(x)
        form, move = stand_in.form(), np.array([540.0, 0.2, 5.0])
        first, second = form.contact.position, form.contact.position + move
        first[:, 2] = line.height_at(first[:, 0])
        second[:, 2] = line.height_at(first[:, 0]) - 0.02
        parts = [SimpleNamespace(**{**vars(form), "line": line}) for _ in range(2)]
        parts[1].contact = SimpleNamespace(position=second, nodes=form.contact.nodes)
        line.starts = (0.0, 540.0)
        form.line, form.shifted = line, tuple(parts)
        _, sag, plan = self.drawn(Content.of(dataclasses.replace(run, form=form)))
        assert sag.lines[0].get_ydata() == pytest.approx(0.0, abs=1e-9)
        assert sag.lines[1].get_ydata() == pytest.approx(-20.0)
        assert [plan.lines[k].get_ydata().mean() for k in (0, 2)] == pytest.approx([0.0, 200.0])
        assert plan.lines[2].get_xdata()[0] == 540.0


WIRE = Wire(EA=3e6, EI=10.0, mass=0.3125, tension=3e3)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"stitch": StitchWire(wire=WIRE, reach=7.25)}, ("stitch wires", "0.3125 kg/m", "7.25 m")),
        (
            {
                "auxiliary": Auxiliary(
                    wire=WIRE,
                    height=0.375,
                    droppers=Droppers(EA=2e5),
                    places=DropperRule(first=5.0, pitch_max=10.0),
                )
            },
            ("auxiliary", "0.3125 kg/m", "0.375 m"),
        ),
        ({"contact_spacing": 0.0625}, ("two contact wires", "0.0625")),
    ],
)
def test_line_is_told_with_all_its_wires(changes, said):
    texts = []
    for line in (short_line(**changes), short_line()):
        made = SimpleNamespace(line=line, pull=np.full((4, 2), 1e4))
        texts.append("".join(line_data(SimpleNamespace(run=SimpleNamespace(form=made))).itertext()))
    assert all(text in texts[0] for text in said)
    assert said[0] not in texts[1]


@pytest.mark.parametrize("relaxed", ["start", "nominal", "mean"])
def test_pantograph_is_told_with_where_its_spring_is_relaxed(relaxed):
    content = SimpleNamespace(run=SimpleNamespace(pantographs=[collector(relaxed_at=relaxed)]))
    assert f"relaxed at{relaxed}" in "".join(pantograph_data(content, 0).itertext())
