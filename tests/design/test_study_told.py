"""What a study tells of its cases: the best and the worst, notes, its title; and of slips."""

import json

import numpy as np
import pandas as pd
import pytest

import ancf
from ancf.design.statistics import drawn_rows
from ancf.model import checks
from design_functions import angles, ishigami, product

PRESSED = """
gravity = [0, 0, -9.81]
[parameters]
push = 0.0
kp = 1.0
kd = 2.0
[sections.rope]
EA = 1e4
EI = 0.01
rhoA = 0.1
[[bodies]]
name = "rope"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 4
section = "rope"
[[supports]]
type = "clamp"
point = "rope.start"
[[loads]]
type = "force"
point = "rope.end"
force = ["-push", 0, 0]
"""
RUN = '[simulation]\nt_end = 0.02\nstep = 1e-3\nstart = "equilibrium"\n'
STUDY = """
model = "m.toml"
[[parameters]]
path = "push"
values = [-5.0, 5.0, 8.0, -6.0]
[sampling]
method = "grid"
[[outputs]]
name = "z"
formula = "last(position(rope.end)[2])"
"""


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.toml").write_text(PRESSED + RUN, encoding="utf-8")
    (tmp_path / "s.toml").write_text(STUDY, encoding="utf-8")
    return tmp_path


def about(folder="out"):
    from pathlib import Path

    return json.loads((Path(folder) / "study.json").read_text(encoding="utf-8"))


class TestExtremes:
    @pytest.mark.parametrize("method", ["random", "saltelli", "morris", "latin-hypercube"])
    @pytest.mark.parametrize("seed", [1, 2])
    def test_are_those_of_their_cases(self, tmp_path, method, seed):
        samples = ancf.sample(angles(), method=method, count=16, seed=seed)
        table = ancf.study(ishigami, samples, folder=tmp_path, workers=0, report=False)
        found = about(tmp_path)["statistics"]
        row, good = found["outputs"]["y"], table["y"][drawn_rows(table)]
        assert table["y"][row["minimum_case"]] == row["minimum"] == good.min()
        assert table["y"][row["maximum_case"]] == row["maximum"] == good.max()
        assert [one["case"] for one in found["extremes"]] == sorted(
            {row["minimum_case"], row["maximum_case"]}
        )
        for one in found["extremes"]:
            assert one["parameters"] == {name: table[name][one["case"]] for name in angles()}

    def test_of_failed_cases(self, tmp_path):
        """They count nowhere; outputs of no case have none."""

        def case(a):
            if a > 2:
                raise ancf.SolveError("t = 0 s", "diverged")
            return {"y": a, "z": -a}

        samples = ancf.sample({"a": [3.0, 1.0, 2.0, 4.0]}, method="grid")
        ancf.study(case, samples, folder=tmp_path / "a", workers=0, report=False)
        row = about(tmp_path / "a")["statistics"]["outputs"]["y"]
        assert (row["minimum_case"], row["maximum_case"]) == (1, 2)
        ancf.study(case, samples.head(1), folder=tmp_path / "b", workers=0)
        assert about(tmp_path / "b")["statistics"]["extremes"] == []

    def test_are_shown(self, here, call):
        ran = call("study", "s.toml", "-o", "out", "-j", "0")
        assert ran.code == 0, ran.err
        table = pd.read_csv("out/table.csv")
        least, most = int(table["z"].argmin()), int(table["z"].argmax())
        lines = [line.split() for line in ran.out.splitlines()]
        (row,) = [line for line in lines if line[:1] == ["z"]]
        assert row[1] == "[m]"
        assert (row[5], row[7]) == (str(least), str(most))
        for case, said in ((least, "smallest"), (most, "largest")):
            (row,) = [line for line in lines if line[:1] == [str(case)]]
            assert row == [str(case), f"{table['push'][case]:g}", said, "z"]
        page = (here / "out" / "report.html").read_text(encoding="utf-8")
        assert "Smallest and largest" in page


class TestNotes:
    @pytest.mark.parametrize("ends", [RUN, "[equilibrium]\n"])
    def test_are_those_of_the_run(self, here, call, ends):
        (here / "m.toml").write_text(PRESSED + ends, encoding="utf-8")
        (here / "s.toml").write_text(
            STUDY.replace("last(position(rope.end)[2])", "position(rope.end)[2]") if ends != RUN else STUDY,
            encoding="utf-8",
        )
        ran = call("study", "s.toml", "-o", "out", "-j", "0")
        table = pd.read_csv("out/table.csv", keep_default_na=False)
        pressed = table["message"].str.contains('note: "rope" is pressed')
        assert pressed.any()
        assert not pressed.all()
        assert not pressed[table["push"] < 0].any()
        noted = table["message"] != ""
        assert about()["statistics"]["noted"] == noted.sum()
        first = int(np.argmax(noted))
        assert about()["first_noted"] == {"case": first, "message": table["message"][first]}
        assert f"with notes, in the column message; the first, case {first}: note: " in " ".join(
            ran.out.split()
        )
        assert '<section id="notes">' in (here / "out" / "report.html").read_text(encoding="utf-8")

    def test_none_of_runs_without(self, tmp_path):
        samples = ancf.sample({"a": [1.0], "b": [1.0]}, method="grid")
        table = ancf.study(product, samples, folder=tmp_path, workers=0)
        assert set(table["message"]) == {""}
        assert about(tmp_path)["statistics"]["noted"] == 0
        assert 'id="notes"' not in (tmp_path / "report.html").read_text(encoding="utf-8")


class TestTitles:
    @pytest.mark.parametrize(
        ("function", "title", "wanted"),
        [(product, "", "product"), (product, "Mine", "Mine"), (lambda a, b: {"y": a}, "", "Study")],
    )
    def test_of_functions(self, tmp_path, function, title, wanted):
        samples = ancf.sample({"a": [1.0, 2.0], "b": [1.0]}, method="grid")
        ancf.study(function, samples, folder=tmp_path, workers=0, title=title)
        assert f"<h1>{wanted}</h1>" in (tmp_path / "report.html").read_text(encoding="utf-8")

    @pytest.mark.parametrize(
        ("own", "model", "wanted"), [("", "Crane", "Crane"), ("Gains", "Crane", "Gains")]
    )
    def test_of_files(self, here, call, own, model, wanted):
        (here / "m.toml").write_text(f'title = "{model}"\n{PRESSED}{RUN}', encoding="utf-8")
        (here / "s.toml").write_text(f'title = "{own}"\n{STUDY}', encoding="utf-8")
        assert call("study", "s.toml", "-o", "out", "-j", "0", "-q").code == 0
        assert f"<h1>{wanted}</h1>" in (here / "out" / "report.html").read_text(encoding="utf-8")


class TestSlips:
    @pytest.mark.parametrize("command", ["run", "study", "calibrate", "optimise", "check"])
    def test_python_files(self, here, call, command):
        """Also such as would be TOML."""
        for text in ("import ancf\n", "a = 1\n"):
            (here / "robot.py").write_text(text, encoding="utf-8")
            ran = call(command, "robot.py")
            assert ran.code == 2
            assert "robot.py: is a Python file, files of TOML are read here" in ran.said
            assert "python robot.py" in ran.said

    @pytest.mark.parametrize(("given", "meant"), [("kP", "kp"), ("pusj", "push"), ("KD", "kd")])
    @pytest.mark.parametrize("place", [0, 1])
    def test_paths_of_parameters(self, here, call, given, meant, place):
        """Where they stand in the study file, and the name that is near, also one of [parameters]."""
        other = '[[parameters]]\npath = "sections.rope.EA"\nvalues = [1e4]\n'
        text = STUDY.replace('"push"', f'"{given}"')
        text = (
            text.replace("[sampling]", f"{other}[sampling]")
            if not place
            else text.replace("[[parameters]]", f"{other}[[parameters]]", 1)
        )
        (here / "s.toml").write_text(text, encoding="utf-8")
        ran = call("study", "s.toml", "-o", "out")
        assert ran.code == 2
        assert f'parameters[{place}].path: "{given}": the file has no "{given}", there are:' in ran.said
        assert f'did you mean "{meant}"?' in ran.said

    def test_status_of_a_study_file(self, here, call):
        assert call("study", "s.toml", "-o", "st", "-j", "0", "-q", "--no-report").code == 0
        for given in (("s.toml", "-o", "st"), ("st",)):
            assert call("study", *given, "--status").out.startswith("st: 4 of 4 cases done, 0 failed")
        assert "out: holds no study" in call("study", "s.toml", "--status").said


class TestNearNames:
    @pytest.mark.parametrize(
        ("given", "known", "meant"),
        [
            ("El", ["E", "EI", "EA"], "EI"),
            ("kP", ["kp", "kd"], "kp"),
            ("R0PE", ["rope", "hope"], "rope"),
            ("E1", ["E", "EI", "EA"], "EI"),
            ("rop", ["rope", "trolley"], "rope"),
        ],
    )
    def test_what_looks_alike_comes_first(self, given, known, meant):
        assert checks.nearest(given, known) == f'did you mean "{meant}"?'
        assert checks.nearest(given, known[::-1]) == f'did you mean "{meant}"?'

    @pytest.mark.parametrize("name", ["qqqq", "", 3.0, None])
    def test_of_nothing(self, name):
        assert checks.nearest(name, ["rope", "trolley"]) == ""

    @pytest.mark.parametrize(
        ("asked", "phrase"),
        [
            ("r.El", 'did you mean "EI"'),
            ("rod.EI", 'the model has no "rod", there are: "r", "held"'),
        ],
    )
    def test_of_sensitivities(self, asked, phrase):
        model = ancf.Model()
        section = ancf.Section(EA=1e4, EI=1.0, rhoA=0.1)
        made = model.add_beam("r", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
        model.clamp(made.start, name="held")
        with pytest.raises(ancf.ModelError) as caught:
            ancf.equilibrium(model, sensitivities=[asked])
        assert phrase in str(caught.value)
