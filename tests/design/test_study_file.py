"""Study files and the command: what they compute, against direct runs, and what they refuse."""

import json
import tomllib

import numpy as np
import pandas as pd
import pytest

import ancf
from ancf import catenary
from ancf.design.file import read_study_file
from ancf.design.lines import STATISTICS
from ancf.model.file import read_study
from commands import MODEL, SIMULATION
from overhead_lines import TOML
from places import EXAMPLES

SHORT = SIMULATION.replace("0.4", "0.02")
STUDY = """
title = "Cantilevers"
model = "m.toml"
[[parameters]]
path = "sections.strip.E"
name = "E"
distribution = { type = "uniform", low = 8e7, high = 1.2e8 }
[[parameters]]
path = "bodies.beam.elements"
values = [2, 3]
[sampling]
method = "sobol"
count = 4
seed = 3
[[outputs]]
name = "tip"
formula = "last(position(beam.end)[2])"
[[outputs]]
name = "pull"
formula = "max(abs(tension(beam.at(0.5))))"
"""
#: Two spans, coarse and slow enough to be run in a second.
LINE = """
title = "Two spans"
line = "line.toml"
[[parameters]]
path = "spans[0].length"
values = [61.0, 62.0]
[[parameters]]
path = "contact_wire.tension"
name = "T"
values = [20e3]
[sampling]
method = "grid"
[[outputs]]
name = "longest"
formula = "max(dropper_length)"
[[outputs]]
name = "first"
formula = "dropper_load[0]"
"""


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.toml").write_text(MODEL + SHORT, encoding="utf-8")
    (tmp_path / "s.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


def with_text(here, old, new, text=STUDY):
    assert old in text
    (here / "s.toml").write_text(text.replace(old, new), encoding="utf-8")


class TestModels:
    def test_outputs_are_those_of_runs(self, here, call):
        ran = call("study", "s.toml", "-o", "out", "--no-report", "-j", "1")
        assert ran.code == 0, ran.err
        table = pd.read_parquet("out/table.parquet")
        for row in table.to_dict("records"):
            given = {"sections.strip.E": row["E"], "bodies.beam.elements": row["bodies.beam.elements"]}
            study = read_study("m.toml", given)
            settings = study.simulation
            result = ancf.simulate(study.model, t_end=settings.t_end, step=settings.step)
            assert result.position("beam.end")[-1, 2] == row["tip"]
            assert np.max(np.abs(result.tension("beam.at(0.5)"))) == row["pull"]
        about = json.loads((here / "out" / "study.json").read_text(encoding="utf-8"))
        assert (about["cases"], about["failed"], about["design"]["seed"]) == (4, 0, 3)
        assert set(about["files"]) == {"s.toml", "m.toml"}

    def test_again_and_more(self, here, call):
        """Finished work is told at once, more samples compute the new ones alone."""
        assert call("study", "s.toml", "-j", "1", "-q", "--no-report").code == 0
        before = (here / "out" / "study.json").stat().st_mtime_ns
        again = call("study", "s.toml", "--no-report")
        assert again.code == 0
        assert "tip" in again.out
        assert (here / "out" / "study.json").stat().st_mtime_ns == before
        with_text(here, "count = 4", "count = 6")
        ran = call("study", "s.toml", "-j", "1", "--no-report")
        assert "case 6 of 6" in ran.err
        assert call("study", "out", "--status").out.startswith("out: 6 of 6 cases done, 0 failed")

    def test_failed_cases(self, here, call):
        with_text(here, "values = [2, 3]", "values = [2, -3]")
        ran = call("study", "s.toml", "-j", "1")
        assert ran.code == 1
        assert "of 4 cases failed; the first, case" in ran.said
        assert "bodies[0].elements: must be >= 1, is -3" in ran.said
        table = pd.read_csv("out/table.csv")
        assert set(table["status"]) == {"ok", "failed"}
        assert "cases failed; statistics are those of the others" in (here / "out" / "report.html").read_text(
            "utf-8"
        )
        assert call("study", "s.toml", "-q").code == 1

    def test_equilibrium_and_frequencies(self, here):
        (here / "m.toml").write_text(MODEL + "[equilibrium]\n", encoding="utf-8")
        with_text(here, "max(abs(tension(beam.at(0.5))))", "frequency[1]")
        file = read_study_file("s.toml")
        row = file.samples.to_dict("records")[0]
        found = file.case(**row)
        model = read_study(
            "m.toml", {"sections.strip.E": row["E"], "bodies.beam.elements": row["bodies.beam.elements"]}
        ).model
        state = ancf.equilibrium(model)
        assert found["tip"] == state.position("beam.end")[2]
        assert found["pull"] == ancf.modes(model, about=state, count=2).frequencies_hz[1]

    def test_list(self, here):
        with_text(here, 'method = "sobol"\ncount = 4\nseed = 3', 'method = "list"\nfile = "cases.csv"')
        (here / "cases.csv").write_text(
            "bodies.beam.elements, E\n2, 0.1e9\n3, 1.1000000000000001e8\n", encoding="utf-8"
        )
        rows = read_study_file("s.toml").samples
        assert rows["E"].tolist() == [0.1e9, 1.1000000000000001e8]
        assert rows["bodies.beam.elements"].tolist() == [2, 3]

    @pytest.mark.parametrize(
        ("text", "phrase"),
        [
            ("E, elements\n1, 2\n", 'lacks "bodies.beam.elements" and has "elements", which is no parameter'),
            ("E\n1\n", 'lacks "bodies.beam.elements"'),
            ("E, bodies.beam.elements\n1\n", "row 2: has 1 entries, the head has 2"),
            ("E, E\n1, 2\n", 'column 2 has the name "E", must be unique'),
            (", E\n0, 2\n", "index=False"),
            ("E, bodies.beam.elements\n", "has no rows"),
            (None, "no such file"),
        ],
    )
    def test_lists_that_do_not_fit(self, here, text, phrase):
        with_text(here, 'method = "sobol"\ncount = 4\nseed = 3', 'method = "list"\nfile = "cases.csv"')
        if text is not None:
            (here / "cases.csv").write_text(text, encoding="utf-8")
        with pytest.raises(ancf.ModelError) as caught:
            read_study_file("s.toml")
        assert phrase in str(caught.value)
        assert caught.value.where == "sampling.file"

    @pytest.mark.parametrize(
        ("old", "new", "phrase"),
        [
            (
                "sections.strip.E",
                "sections.strap.E",
                '"sections" has no "strap", there are: "strip" did you mean',
            ),
            ("sections.strip.E", "sections.strip.EE", "sections.strip.EE: unknown key"),
            ("high = 1.2e8", "hihg = 1.2e8", "parameters[0].distribution.hihg: unknown key"),
            (", high = 1.2e8", "", "parameters[0].distribution: uniform needs low and high: high missing"),
            ('"uniform"', '"unifrom"', 'did you mean "uniform"'),
            ("values = [2, 3]", "", "parameters[1]: says nothing of how it varies"),
            ("values = [2, 3]", "values = [2]\ngrid = {low=1, high=2, count=2}", "has values and grid"),
            ('"sobol"', '"sobel"', "sampling.method: is 'sobel'"),
            (
                "values = [2, 3]",
                "values = [nan, 3]",
                "values[0]: must be a finite number, is nan",
            ),
            ("values = [2, 3]", "values = [[2], 3]", "parameters[1].values[0]: must be a number or"),
            ('"sobol"\ncount = 4', '"grid"', "parameters[0]: must be a list of values"),
            ("count = 4", "", "sampling.count: is missing"),
            (
                "tension(beam.at(0.5))",
                "tensoin(beam.at(0.5))",
                'outputs.pull: "max(abs(tensoin(beam.at(0.5))))": unknown',
            ),
            ("tension(beam.at(0.5))", "tension(baem.at(0.5))", 'did you mean "beam"'),
            ("tension(beam.at(0.5))", "spring_force(beam.end)", "is asked of a spring, beam.end is a point"),
            ('name = "pull"', 'name = "tip"', 'outputs[1].name: "tip" is the name of another column'),
            ('name = "pull"', 'name = "E"', 'outputs[1].name: "E" is the name of another column'),
            ('model = "m.toml"', "", "model: is missing"),
            ('model = "m.toml"', 'model = "n.toml"', "no such file"),
            ('model = "m.toml"', 'model = "m.toml"\nline = "x"', "model: stands beside line"),
            ('model = "m.toml"', 'model = "m.toml"\n[run]\nspeed = 1', "run: has no effect on a model"),
            ("seed = 3", "sed = 3", 'sampling.sed: unknown key, allowed: "method", "count", "seed", "file"'),
        ],
    )
    def test_bad(self, here, call, old, new, phrase):
        with_text(here, old, new)
        ran = call("study", "s.toml", "--no-report")
        assert ran.code == 2
        assert phrase in ran.said
        assert not (here / "out").exists()

    def test_another_study_in_the_folder(self, here, call):
        assert call("study", "s.toml", "-j", "1", "-q", "--no-report").code == 0
        with_text(here, "last(", "first(")
        ran = call("study", "s.toml", "--no-report")
        assert ran.code == 2
        assert "folder out: holds another study: its outputs is" in ran.said
        assert call("study", "out", "--status").out.startswith("out: 4 of 4")

    def test_status_of_no_study(self, here, call):
        ran = call("study", "out", "--status")
        assert ran.code == 2
        assert "out: holds no study" in ran.said


class TestLines:
    @pytest.fixture
    def line(self, here):
        with catenary.line_file("en50318-2002").open("rb") as file:
            data = tomllib.load(file)
        import tomli_w

        data["spans"] = [{**data["spans"][0], "repeat": 1}] * 5
        for key in ("stagger", "messenger_stagger", "system_height"):
            if isinstance(data.get(key), list):
                data[key] = data[key][:6]
        (here / "line.toml").write_text(tomli_w.dumps(data), encoding="utf-8")
        return here

    def test_at_rest(self, line):
        with_text(line, "Two", "Three", LINE)
        file = read_study_file("s.toml")
        for row in file.samples.to_dict("records"):
            given = {"spans[0].length": row["spans[0].length"], "contact_wire.tension": row["T"]}
            form = catenary.form(catenary.read_line("line.toml", given))
            assert file.case(**row) == {"longest": form.dropper_length.max(), "first": form.dropper_load[0]}

    def test_runs(self, line):
        text = LINE.replace('line = "line.toml"', 'line = "line.toml"\n[run]\nspeed = 200\nstep = 4e-3')
        text = text.replace("max(dropper_length)", "sigma").replace("dropper_load[0]", "uplift[1]")
        text = text.replace("[sampling]", '[[parameters]]\npath = "run.speed"\nvalues = [180.0]\n[sampling]')
        with_text(line, "Two", "Three", text)
        file = read_study_file("s.toml")
        row = file.samples.to_dict("records")[0]
        found = file.case(**row)
        line_ = catenary.read_line("line.toml", {"spans[0].length": 61.0, "contact_wire.tension": 20e3})
        run = catenary.run(line_, speed=180.0 / 3.6, step=4e-3)
        statistics = catenary.statistics(run)
        assert found == {"longest": statistics["deviation"].value, "first": 1e3 * run.uplift[:, 1].max()}
        keys = {q.key for q in statistics.quantities}
        assert set(STATISTICS) <= keys | {"relative_deviation"}

    @pytest.mark.parametrize(
        ("old", "new", "phrase"),
        [
            ("spans[0].length", "spans[5].length", '"spans" has 5 entries, [0] to [4]'),
            ("spans[0].length", "run.speed", "run: is missing: a parameter is one of a run"),
            ("max(dropper_length)", "sigma", 'unknown name "sigma"'),
            ("max(dropper_length)", "tension(x)", 'unknown name "tension"'),
            ('line = "line.toml"', 'line = "line.toml"\n[run]\nsped = 3', "run.sped: unknown key"),
            ('line = "line.toml"', 'line = "line.toml"\n[run]\nstep = 1e-3', "run.speed: must be a number"),
            (
                'line = "line.toml"',
                'line = "line.toml"\n[run]\nspeed = 200\npantograph = "dsa"',
                'run.pantograph: there is no "dsa"',
            ),
            (
                'line = "line.toml"',
                'line = "line.toml"\n[run]\nspeed = 200\npantograph = ["dsa380", "mine.toml"]',
                "mine.toml: no such file",
            ),
        ],
    )
    def test_bad(self, line, old, new, phrase):
        with_text(line, old, new, LINE)
        with pytest.raises(ancf.ModelError) as caught:
            read_study_file("s.toml")
        assert phrase in str(caught.value)


@pytest.mark.parametrize("listed", [False, True])
def test_a_pantograph_lies_beside_the_study(here, listed):
    """As model and line do, wherever the command is called."""
    folder = here / "elsewhere"
    folder.mkdir()
    (folder / "mine.toml").write_text(
        "masses = [15.0]\nstiffness = [50.0]\ndamping = [90.0]\nstatic_force = 120.0\n", encoding="utf-8"
    )
    name = '["mine.toml", "dsa380"]' if listed else '"mine.toml"'
    text = LINE.replace(
        'line = "line.toml"', f'line = "en50318-2002"\n[run]\nspeed = 200\npantograph = {name}'
    )
    (folder / "s.toml").write_text(text, encoding="utf-8")
    found = read_study_file("elsewhere/s.toml").case.inner.run["pantograph"]
    first = found[0] if listed else found
    assert catenary.find_pantograph(first).masses == (15.0,)


def test_sampling_that_is_missing_says_what_to_write(here):
    with_text(here, '[sampling]\nmethod = "sobol"\ncount = 4\nseed = 3', "")
    with pytest.raises(ancf.ModelError, match=r"sampling: is missing .*a table \[sampling\] with \"method\""):
        read_study_file("s.toml")


def test_example():
    file = read_study_file(EXAMPLES / "study.toml")
    assert file.samples.shape == (96, 4)
    assert file.title == "Hanging cable in a gust"


def test_tolerances():
    """The example's lines differ by the errors of their droppers alone."""
    file = read_study_file(EXAMPLES / "tolerances.toml")
    assert len(file.samples) == 1000
    case = file.case.inner
    lines = [case.read({"deviation": 0.003, "seed": seed})[0] for seed in (1.0, 2.0)]
    assert [line.dropper_errors.seed for line in lines] == [1, 2]


def test_tension_lengths(here):
    """Tables of supports lie beside the line file, wherever the study is; they are part of it."""
    folder = here / "lines"
    folder.mkdir()
    tail = ""
    for k, (heights, starts) in enumerate((("0,0,0,0.02,0.3", 0.0), ("0.3,0.02,0,0,0", 64.0)), start=1):
        rows = [f"{32 * i},{h}" for i, h in enumerate(heights.split(","))]
        (folder / f"{k}.csv").write_text("position,height\n" + "\n".join(rows), encoding="utf-8")
        text = f'[[sections]]\nstart = {starts}\nsupports = "{k}.csv"\n'
        tail += text
    head = TOML.partition("[[spans]]")[0].replace("stagger = 0.2", 'anchors = "tension"\nstagger = 0.2')
    rule = "dropper_rule = {first = 3.0, pitch_max = 7.0}\n"
    (folder / "track.toml").write_text(rule + head + tail, encoding="utf-8")
    study = (
        'title = "Two"\nline = "lines/track.toml"\n[[parameters]]\npath = "dropper_errors.seed"\n'
        "values = [1, 2]\n"
        '[[parameters]]\npath = "dropper_errors.deviation"\nvalues = [0.004]\n[sampling]\nmethod = "grid"\n'
        '[[outputs]]\nname = "least"\nformula = "min(dropper_load)"\n'
        '[[outputs]]\nname = "held"\nformula = "max(support_load)"\n'
    )
    (here / "s.toml").write_text(study, encoding="utf-8")
    file = read_study_file("s.toml")
    plain = {"dropper_errors.deviation": 0.004}
    found = [file.case(**plain, **{"dropper_errors.seed": seed}) for seed in (1, 2)]
    assert found[0]["least"] != found[1]["least"]
    assert found[0]["held"] > 300.0
    before = file.case.identity()
    (folder / "1.csv").write_text((folder / "1.csv").read_text().replace("0.02", "0.03"), encoding="utf-8")
    assert read_study_file("s.toml").case.identity() != before
