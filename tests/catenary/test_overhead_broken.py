"""Broken droppers: as an option, out of all statistics of slack, named in files, reports and comparisons."""

import csv
import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

import catenary_stand_in as stand_in
from ancf import ModelError, catenary
from ancf.catenary.answers.acceptance import acceptance
from ancf.catenary.answers.kept import read_runs
from ancf.catenary.answers.passing import dropper_forces
from ancf.catenary.broken import chosen, told
from ancf.catenary.report.comparison import pieces
from ancf.catenary.report.content import Content
from ancf.catenary.report.figures import FIGURES
from ancf.viz import style
from overhead_lines import COARSE, STEP, collector, short_line

GIVEN = {"speed": 40.0, "pantograph": collector(), "step": STEP}


@cache
def found():
    return catenary.form(short_line(), COARSE)


@cache
def whole(count):
    return stand_in.run(count=count, spacing=80.0)


@cache
def broken(count, labels):
    """The made-up run with droppers that carry nothing."""
    run, line = whole(count), whole(count).form.line
    force = run.dropper_force.copy()
    for span, number in chosen(line, labels, "test"):
        force[:, 9 * (span - 1) + number - 1] = 0.0
    return replace(run, dropper_force=force, broken_droppers=labels)


def as_if_slack(run):
    return replace(run, broken_droppers=())


FAMILY = [(count, labels) for count in (1, 2, 3) for labels in (("5-3",), ("6-9", "5-1"), ("2-2", "5-5"))]


class TestStatistics:
    @pytest.mark.parametrize(("count", "labels"), FAMILY)
    def test_are_those_of_the_others(self, count, labels):
        run = broken(count, labels)
        inside = [label for label in labels if label[0] in "56"]
        for k in range(count):
            known, there = catenary.statistics(run, k), catenary.statistics(whole(count), k)
            rest = [d for d in there.droppers if d.label not in labels]
            slack = [d.slack for d in rest if d.slack.number]
            assert known["broken_droppers"].value == len(inside)
            assert known["slack_droppers"].value == len(slack)
            assert known["slack_number"].value == sum(one.number for one in slack)
            assert known["slack_longest"].value == pytest.approx(1e3 * max(one.longest for one in slack))
            assert known["dropper_maximum"].value == max(d.largest for d in rest)
            counted = catenary.statistics(as_if_slack(run), k)
            assert counted["slack_longest"].value > 3.0 * known["slack_longest"].value

    @pytest.mark.parametrize(
        ("name", "said"),
        [
            ("deviaton", 'did you mean "deviation"'),
            ("sigma", "known are mean_force, deviation"),
            (3, "quantity 3"),
        ],
    )
    @pytest.mark.parametrize("count", [1, 2])
    def test_unknown_name(self, count, name, said):
        known = catenary.statistics(whole(count), count - 1)
        with pytest.raises(ModelError, match=said) as caught:
            known[name]
        assert str(caught.value).startswith(f"statistics: there is no quantity {name!r}")
        assert all(key in str(caught.value) for key in known)
        assert known.get(name) is None
        assert name not in known

    def test_without_broken_ones_nothing_is_said(self):
        assert "broken_droppers" not in catenary.statistics(whole(1))
        assert not any(d.broken for d in dropper_forces(whole(1)))

    def test_of_a_window_of_broken_ones_there_is_no_force(self):
        labels = tuple(f"{span}-{number}" for span in (5, 6) for number in range(1, 10))
        known = catenary.statistics(broken(1, labels))
        assert known["broken_droppers"].value == 18
        assert not {"dropper_maximum", "slack_droppers", "slack_longest"} & set(known)


class TestFiles:
    @pytest.mark.parametrize(("count", "labels"), FAMILY)
    def test_say_which(self, tmp_path, count, labels):
        catenary.write_run(broken(count, labels), tmp_path)
        with (tmp_path / "droppers.csv").open(encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        gone = {f"{r['span']}-{r['dropper']}" for r in rows if r["state"] == "broken"}
        assert gone == set(labels)
        assert {r["state"] for r in rows} == {"broken", "whole"}
        for row in rows:
            cells = [row[key] for key in ("rest_N", "largest_N", "smallest_N", "slack_count", "slack_s")]
            assert all(cells) != (row["state"] == "broken")
        assert json.loads((tmp_path / "statistics.json").read_text())["broken_droppers"] == list(labels)
        cycles = (tmp_path / "cycles.csv").read_text()
        for label in labels:
            assert f"force_N,{label.replace('-', ',')}," not in cycles
        for kept in catenary.read_run(tmp_path):
            assert told(labels) in kept.state

    @pytest.mark.parametrize(("count", "labels"), FAMILY[:4])
    def test_report(self, tmp_path, count, labels):
        path = catenary.write_report(broken(count, labels), tmp_path / "report.html")
        text = path.read_text(encoding="utf-8")
        assert told(labels)[1:] in text
        inside = [label for label in labels if label[0] in "56"]
        assert text.count('<td class="number">broken</td>') >= count * len(inside)
        assert "broken" not in catenary.write_report(whole(1), tmp_path / "whole.html").read_text()


class TestCompared:
    @pytest.mark.parametrize(("before", "after"), [(1, 1), (2, 2), (3, 3), (1, 2), (3, 2), (2, 1)])
    def test_each_with_its_place_in_the_train(self, tmp_path, before, after):
        catenary.write_run(whole(before), tmp_path / "before")
        catenary.write_run(broken(after, ("5-3",)), tmp_path / "after")
        runs = read_runs([tmp_path / "before", tmp_path / "after"])
        shown = ["".join(one.itertext()) for one in _heads(runs)]
        label = lambda name, count, k: name if count == 1 else f"{name}-{k}"  # noqa: E731
        pairs = [
            f"{label('after', after, k)} less {label('before', before, k)}"
            for k in range(1, min(before, after) + 1)
        ]
        names = [label("before", before, k + 1) for k in range(before)]
        names += [label("after", after, k + 1) for k in range(after)]
        assert shown == ["quantity", "unit", *names, *pairs]
        by_key = _rows(runs)
        for k in range(min(before, after)):
            values = [
                catenary.statistics(run, k)["mean_force"].value for run in (whole(before), whole(after))
            ]
            change = by_key["mean force Fm, AC"][before + after + k]
            assert change == pytest.approx(values[1] - values[0], abs=1e-6)

    def test_one_train_with_its_first(self, tmp_path):
        from ancf.catenary.report.comparison import heads

        catenary.write_run(whole(3), tmp_path / "train")
        columns = heads(read_runs([tmp_path / "train"]))
        assert columns[3:] == ["train-2 less train-1", "train-3 less train-1"]

    @pytest.mark.parametrize("width", [60, 80, 100])
    def test_words_stay_whole_on_narrow_screens(self, tmp_path, call, monkeypatch, width):
        from ancf.cli import screen

        monkeypatch.setattr(screen, "WIDTH_OF_A_FILE", width)
        catenary.write_run(whole(2), tmp_path / "before")
        catenary.write_run(broken(2, ("5-3",)), tmp_path / "after")
        done = call("catenary", "compare", "before", "after", "--to", "html")
        assert done.code == 0, done.err
        words = set(done.out.split())
        names = [f"{name}-{k}" for name in ("before", "after") for k in (1, 2)]
        assert {"contact-point", "height", "unfiltered", "deviation", *names} <= words
        table = done.out[done.out.index("quantity") :].split("written")[0]
        assert max(map(len, table.splitlines())) <= width


def _heads(runs):
    tables = [t for part in pieces(runs, style.svg) for t in part.iter("table")]
    return list(tables[1].iter("th"))


def _rows(runs):
    from ancf.catenary.report.comparison import differences

    return {name: [*values, *changes] for name, _, values, changes in differences(runs)}


class TestScale:
    @pytest.mark.parametrize("count", [1, 2, 3])
    @pytest.mark.parametrize("name", ["force", "force-window", "dropper-extremes", "height"])
    def test_what_happens_at_the_end_of_the_line_does_not_set_it(self, count, name):
        run = whole(count)
        recordings, forces = [], run.dropper_force.copy()
        for one in run.recordings:
            late = one.position > run.form.line.length - 20.0
            force = np.where(late, 5e3, one.force)
            recordings.append(replace(one, force=force, height=np.where(late, 9.0, one.height)))
        forces[:, -2:] = 5e3
        shown = _axes(name, replace(run, recordings=recordings, dropper_force=forces))
        for axes, before in zip(shown, _axes(name, run), strict=True):
            assert axes.get_ylim() == pytest.approx(before.get_ylim(), rel=0.02)
            assert axes.get_ylim()[1] < 500.0

    @pytest.mark.parametrize("count", [1, 2])
    def test_holds_what_is_evaluated(self, count):
        run = whole(count)
        for k, axes in enumerate(_axes("force", run)):
            x, force = run.recordings[k].position, run.recordings[k].force
            inside = force[(x >= run.window[0]) & (x <= run.window[1])]
            assert axes.get_ylim()[0] < inside.min()
            assert axes.get_ylim()[1] > inside.max()


def _axes(name, run):
    content = Content.of(run)
    kind = FIGURES[name]
    with style.new_figure(*kind.size(content)) as figure:
        kind.draw(content, figure)
        return list(figure.axes)


class TestOption:
    @pytest.mark.parametrize("labels", [("1-1",), ("3-3",), ("5-5", "2-4")])
    def test_does_what_breaking_them_in_the_model_does(self, labels):
        def gone(overhead):
            for label in labels:
                overhead.break_dropper(*map(int, label.split("-")))

        one = catenary.run(found(), broken_droppers=list(labels), **GIVEN)
        other = catenary.run(found(), modify=gone, **GIVEN)
        assert np.array_equal(one.recordings[0].force, other.recordings[0].force)
        assert np.array_equal(one.dropper_force, other.dropper_force)
        assert set(one.broken_droppers) == set(other.broken_droppers) == set(labels)
        assert one.settings["broken droppers"] == other.settings["broken droppers"]
        assert ("model" in one.settings, "model" in other.settings) == (False, True)

    @pytest.mark.parametrize(
        ("given", "said"),
        [
            (["8-1"], "there is no dropper '8-1'.*the line has 5 spans"),
            (["2-6"], "there is no dropper '2-6'.*span 2 has the droppers 2-1 to 2-5"),
            (["0-1"], "there is no dropper '0-1'"),
            (["2.4"], "there is no dropper '2.4'.*did you mean \"2-4\""),
            ([(2, 4)], "there is no dropper"),
            ("2-4", "must be labels of droppers"),
            (["2-4", "3-1", "2-4"], "dropper 2-4 is given twice"),
        ],
    )
    def test_refused(self, given, said):
        for ask in (catenary.run, catenary.stepper):
            with pytest.raises(ModelError, match=r"broken_droppers: (?s:" + said + ")"):
                ask(found(), broken_droppers=given, **GIVEN)
        if isinstance(given, list) and all(isinstance(one, str) for one in given):
            with pytest.raises(ModelError, match=r"sweep\.broken_droppers"):
                catenary_sweep(given)

    def test_not_in_a_model_that_lacks_it(self):
        overhead = catenary.assemble(found())
        overhead.break_dropper(2, 4)
        with pytest.raises(ModelError, match="dropper 2-4: is broken already"):
            overhead.run(broken_droppers=["2-4"], **GIVEN)

    def test_command(self, call, tmp_path):
        done = call("catenary", "run", "en50318-2002", "--speed", 250, "--break-dropper", "5-11")
        assert done.code == 2
        assert "there is no dropper '5-11'" in done.err
        assert "span 5 has the droppers 5-1 to 5-9" in done.err

    @pytest.mark.slow
    @pytest.mark.parametrize("labels", [("5-3",), ("4-2", "6-9")])
    def test_sweep_names_them(self, call, labels):
        asked = [word for label in labels for word in ("--break-dropper", label)]
        done = call(
            "catenary", "sweep", "en50318-2002", "--speed", 250, "--mesh", 2.5, 5, "--step", 2e-3, *asked,
            "--pantograph", "en50318-2002", "--workers", 1, "--to", "html", "-o", "swept",
        )  # fmt: skip
        assert done.code == 0, done.err
        assert f"\n{told(labels)}\n" in done.out
        report = Path("swept/report.html").read_text(encoding="utf-8")
        assert f"Broken droppers: {', '.join(labels)}." in report


def catenary_sweep(given):
    from ancf.design.sweep import sweep

    return sweep(short_line(), [100.0], broken_droppers=given)


@pytest.mark.parametrize("labels", [(), ("8-3",), ("8-3", "8-4", "9-1")])
def test_words(labels):
    text = told(labels)
    assert text == ("" if not labels else f"broken dropper{'s' * (len(labels) > 1)} {', '.join(labels)}")


def test_strain_of_clamps_stays():
    """What bends at the clamps of a broken dropper is its mass alone: they stand in acceptance as before."""
    keys = {q.key for q in acceptance(broken(1, ("5-3",)))}
    assert keys == {q.key for q in acceptance(whole(1))}
