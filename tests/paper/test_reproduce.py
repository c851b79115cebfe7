"""Reproducing the paper: verdicts, errors, the JSON files, and the command."""

import csv
import math
import os
import platform
import re
import shutil
import subprocess
import sys
import warnings
from dataclasses import replace
from pathlib import Path

import pytest

from ancf.errors import ModelError
from ancf.paper import FIGURES, verify
from ancf.paper.check import Check
from ancf.paper.entry import Entry, Reproduction, use_of_tolerance
from ancf.paper.report import write_summary
from ancf.paper.report.machine import commit
from fake_exhibits import BAD, FAKES, GOOD, LOST, Fake, load

pytest.importorskip("matplotlib")

CHECK_KEYS = ["name", "value", "reference", "tolerance", "passed", "rule", "unit", "origin", "figure"]


@pytest.fixture
def call(call):
    return lambda *arguments: call("reproduce", *arguments)


class TestVerdicts:
    def test_of_each_exhibit(self, made):
        words = ["passed", "failed", "no check", "error", "error", "passed"]
        assert [entry.verdict for entry in made.entries] == words
        assert [entry.name for entry in made.entries] == [fake.name for fake in FAKES]
        assert not made.passed
        assert made.verdict == "3 of 5 checks passed, 2 of 6 exhibits could not be computed"
        assert [check.name for _, check in made.failed] == [BAD.name, LOST.name]

    def test_errors_and_files(self, made):
        entries = {entry.name: entry for entry in made.entries}
        assert entries["figsolve"].error == "t = 0.1 s: no convergence <here> (smaller steps)"
        assert entries["figsolve"].traceback == ""
        assert entries["figfault"].error == "internal error: RuntimeError: wheel off"
        assert "wheel off" in entries["figfault"].traceback
        assert entries["figsolve"].files == ()
        assert entries["figsolve"].title == "Title of figsolve <b>"
        assert [path.name for path in entries["figbad"].files] == ["figbad.png", "figbad.csv", "figbad.json"]

    def test_all_pass(self, fakes, tmp_path):
        made = verify(["figgood", "figlast", "fignone"], tmp_path)
        assert made.passed
        assert made.verdict == "2 of 2 checks passed"

    def test_files_of_an_earlier_run_go(self, fakes, tmp_path, monkeypatch):
        verify(["figgood"], tmp_path)
        monkeypatch.setitem(FIGURES, "figgood", Fake("figgood", error=RuntimeError("now it fails")))
        assert verify(["figgood"], tmp_path).entries[0].files == ()
        assert sorted(path.name for path in tmp_path.iterdir()) == ["checks.json", "index.html"]

    def test_a_fault_in_the_checks_keeps_the_picture(self, fakes, tmp_path, monkeypatch):
        broken = Fake("figgood")
        broken.checks = lambda table: 1 / 0
        monkeypatch.setitem(FIGURES, "figgood", broken)
        entry = verify(["figgood"], tmp_path).entries[0]
        assert entry.verdict == "error"
        assert [path.name for path in entry.files] == ["figgood.png"]

    def test_warnings_become_notes(self, fakes, tmp_path, monkeypatch):
        loud = Fake("figgood")
        loud.checks = lambda table: warnings.warn("the beam is thick", stacklevel=1) or []
        monkeypatch.setitem(FIGURES, "figgood", loud)
        with pytest.MonkeyPatch.context() as context:
            context.setattr("warnings.filters", [])
            entry = verify(["figgood"], tmp_path).entries[0]
        assert entry.notes[-1] == "Warning: the beam is thick"

    def test_ctrl_c_goes_up(self, fakes, tmp_path, monkeypatch):
        monkeypatch.setitem(FIGURES, "figgood", Fake("figgood", error=KeyboardInterrupt()))
        with pytest.raises(KeyboardInterrupt):
            verify(["figgood"], tmp_path)

    @pytest.mark.parametrize("jobs", [0, -3])
    def test_number_of_processes(self, fakes, tmp_path, jobs):
        with pytest.raises(ModelError, match="jobs must be at least 1"):
            verify(["all"], tmp_path, jobs=jobs)


class TestUseOfTolerance:
    @pytest.mark.parametrize(
        ("rule", "value", "reference", "tolerance", "use"),
        [
            ("within", 1.25, 1.0, 0.5, 0.5),
            ("within", 0.0, 1.0, 0.5, 2.0),
            ("within", 1.0, 1.0, 0.0, 0.0),
            ("within", 1.1, 1.0, 0.0, math.inf),
            ("factor", 2.0, 4.0, 4.0, 0.5),
            ("factor", 4.0, 2.0, 4.0, 0.5),
            ("factor", -4.0, 2.0, 4.0, math.inf),
            ("at least", 5.0, 4.0, 0.5, 0.0),
            ("at least", 3.9, 4.0, 0.2, 0.5),
            ("at most", 4.1, 4.0, 0.2, 0.5),
            ("at most", math.nan, 4.0, 0.2, math.inf),
        ],
    )
    def test_by_rule(self, rule, value, reference, tolerance, use):
        check = Check("a", value, reference, tolerance, "", "b", rule)
        assert use_of_tolerance(check) == pytest.approx(use)
        assert check.passed == (use <= 1)

    def test_largest(self):
        assert Entry("a", checks=(GOOD, BAD)).largest_use == pytest.approx(100.0)
        assert Entry("a").largest_use is None


class TestJSON:
    def test_summary(self, made):
        found = load(made.summary)
        wanted = {
            "version",
            "commit",
            "date",
            "quick",
            "passed",
            "jobs",
            "seconds",
            "machine",
            "checks",
            "exhibits",
        }
        assert set(found) == wanted
        assert found["quick"] is True
        assert found["passed"] is False
        assert re.fullmatch(r"\d{4}-\d\d-\d\dT\d\d:\d\d:\d\dZ", found["date"])
        assert {"python", "numpy", "numba", "ancf", "cores"} <= set(found["machine"])
        assert all(list(check) == CHECK_KEYS for check in found["checks"])
        assert [check["passed"] for check in found["checks"]] == [True, True, False, False, True]
        assert [check["figure"] for check in found["checks"]] == ["figgood", *["figbad"] * 3, "figlast"]
        assert found["checks"][2]["value"] == 0.5
        assert found["checks"][3]["value"] is None

    def test_commit(self, made):
        """Of the clone that computed, for all and for each exhibit."""
        found = load(made.summary)
        assert found["commit"] == commit()
        assert {exhibit["commit"] for exhibit in found["exhibits"]} == {commit()}

    def test_commit_is_none_outside_of_a_clone(self, tmp_path):
        (tmp_path / "copied.py").write_text("")
        assert commit(tmp_path / "copied.py") is None

    def test_commit_of_a_changed_clone_says_so(self, tmp_path):
        if shutil.which("git") is None:
            pytest.skip("no git on this machine")
        file = tmp_path / "module.py"
        file.write_text("a = 1")
        known = ("-c", "user.name=a", "-c", "user.email=a@b.c")
        for command in (("init", "-q"), ("add", "."), (*known, "commit", "-qm", "first")):
            subprocess.run(["git", *command], cwd=tmp_path, check=True)
        clean = commit(file)
        assert re.fullmatch(r"[0-9a-f]{12}", clean)
        file.write_text("a = 2")
        assert commit(file) == f"{clean}-dirty"

    def test_exhibits(self, made):
        exhibits = {exhibit["name"]: exhibit for exhibit in load(made.summary)["exhibits"]}
        assert list(exhibits) == [fake.name for fake in FAKES]
        bad = exhibits["figbad"]
        assert (bad["checks"], bad["failed"], bad["error"]) == (3, 2, None)
        assert bad["title"] == "Title of figbad <b>"
        assert bad["seconds"] >= 0
        assert exhibits["figsolve"]["error"].startswith("t = 0.1 s: no convergence")
        assert "traceback" not in exhibits["figsolve"]
        assert "RuntimeError: wheel off" in exhibits["figfault"]["traceback"]

    def test_names_no_machine_and_no_folder(self, made):
        text = made.summary.read_text(encoding="utf-8")
        assert str(made.folder) not in text
        assert platform.node() not in text
        assert str(Path(sys.modules["ancf"].__file__).parents[1]) + os.sep not in text

    def test_numbers_of_numpy(self, tmp_path):
        numpy = pytest.importorskip("numpy")
        odd = replace(
            GOOD, value=numpy.float64(1.0), reference=numpy.float64(1.0), tolerance=numpy.float64(1)
        )
        write_summary(Reproduction((Entry("a", checks=(odd,)),), tmp_path, False, 1, 0.0))
        assert load(tmp_path / "checks.json")["checks"][0]["passed"] is True

    def test_of_each_exhibit(self, made):
        found = load(made.folder / "figbad.json")
        assert list(found) == ["name", "columns", "rows", "notes", "checks"]
        assert [check["passed"] for check in found["checks"]] == [True, False, False]
        with (made.folder / "figbad.csv").open(newline="", encoding="utf-8") as file:
            assert list(csv.reader(file)) == [["x", "y"], ["0.0", "1.0"], ["1.0", "3.0"]]


class TestCommand:
    def test_all_passed(self, fakes, call):
        code, out, err = call("figgood", "figlast", "--quick", "-j", "1")
        assert code == 0
        assert out == "2 of 2 checks passed; see out/index.html\n"
        lines = [re.sub(r"\d+\.\d s", "T", line) for line in err.splitlines()]
        assert lines == ["figgood: 1 check passed, T (1 of 2)", "figlast: 1 check passed, T (2 of 2)"]
        assert load(Path("out/checks.json"))["quick"] is True

    def test_failed_checks(self, fakes, call):
        code, out, err = call("figbad", "figgood", "-j", "1", "-o", "there")
        assert code == 1
        assert "figbad: 2 of 3 checks FAILED" in err
        assert re.search(r"figbad: tip: <x> & y +0\.5 +0\.4 +0\.001 +m", out)
        assert out.splitlines()[-1] == "2 of 4 checks passed; see there/index.html"
        assert load(Path("there/checks.json"))["quick"] is False

    def test_errors(self, fakes, call):
        code, out, err = call("figfault", "figsolve", "figgood", "-j", "1")
        assert code == 1
        assert "figfault: internal error: RuntimeError: wheel off" in out
        assert "figsolve: t = 0.1 s: no convergence" in out
        assert "Traceback" not in out + err
        assert out.splitlines()[-1].startswith("1 of 1 checks passed, 2 of 3 exhibits could not be computed")

    def test_quiet(self, fakes, call):
        assert call("figgood", "-q", "-j", "1") == (0, "", "")
        code, out, err = call("figbad", "-q", "-j", "1")
        assert (code, out) == (1, "")
        assert "2 of 3 checks" not in err
        assert "1 of 3 checks passed" in err

    @pytest.mark.parametrize(
        ("arguments", "said"), [(["fig99"], "unknown figure"), (["fig2", "-j", "0"], "at least 1")]
    )
    def test_wrong_input(self, call, arguments, said):
        code, out, err = call(*arguments)
        assert (code, out) == (2, "")
        assert said in err
