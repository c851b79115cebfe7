"""Studies of functions: the table against direct calls, whatever ends on the way."""

import functools
import multiprocessing
import os
import random
import signal
import subprocess
import sys
import textwrap
import time

import numpy as np
import pandas as pd
import pytest

import ancf
from ancf.design import processes
from ancf.design.journal import Journal, Outcome, case_key, progress_of
from ancf.design.processes import MOST_DEATHS
from commands import PATIENCE, python
from design_functions import (
    angles,
    cantilever,
    counted,
    deadly,
    ishigami,
    napping,
    product,
    sometimes_wrong,
)
from places import TESTS

TWO = {"a": ancf.Uniform(1.0, 3.0), "b": ancf.Uniform(0.0, 1.0)}


def samples(count=24, **more):
    return ancf.sample(TWO, method="sobol", count=count, seed=2, **more)


def quiet(function, table, **more):
    return ancf.study(function, table, report=False, **more)


def bytes_of(folder):
    return [(folder / name).read_bytes() for name in ("table.csv", "table.parquet")]


class TestTable:
    @pytest.mark.parametrize(("count", "workers"), [(1, 0), (17, 0), (17, 1), (1, 3), (17, 3)])
    def test_is_what_the_function_returns(self, workers, count):
        table, rows = quiet(product, samples(count), workers=workers), samples(count)
        assert [*table.columns] == ["a", "b", "sum", "product", "status", "message"]
        assert np.array_equal(table["product"], rows["a"] * rows["b"])
        assert np.array_equal(table["sum"], rows["a"] + rows["b"])
        assert set(table["status"]) == {"ok"}

    def test_does_not_depend_on_the_number_of_workers(self, tmp_path):
        for workers in (0, 1, 3):
            quiet(sometimes_wrong, samples(60), folder=tmp_path / str(workers), workers=workers)
        assert bytes_of(tmp_path / "0") == bytes_of(tmp_path / "1") == bytes_of(tmp_path / "3")

    def test_csv_has_every_bit(self, tmp_path):
        table = quiet(product, samples(), folder=tmp_path, workers=0)
        read = pd.read_csv(tmp_path / "table.csv", index_col="case", dtype=str)
        assert [*map(float, read["product"])] == table["product"].tolist()
        parquet = pd.read_parquet(tmp_path / "table.parquet")
        assert np.array_equal(parquet["product"], table["product"])

    def test_kinds_of_values_stay(self):
        """Counts stay whole and words stay words."""
        seen = []

        def function(n, word):
            seen.append((type(n), word))
            return {"double": 2 * n}

        quiet(function, ancf.sample({"n": [1, 2], "word": ["x", "y"]}, method="grid"), workers=0)
        assert seen == [(int, "x"), (int, "y"), (int, "x"), (int, "y")]

    def test_runs_of_models(self):
        rows = ancf.sample({"EI": ancf.Uniform(0.1, 1.0), "elements": [2, 3]}, method="random", count=6)
        table = quiet(cantilever, rows, workers=2)
        direct = [cantilever(**row) for row in rows.to_dict("records")]
        assert np.array_equal(table["tip"], [one["tip"] for one in direct])

    def test_functions_without_a_module(self):
        """Of a notebook or a script, and what they enclose."""
        factor = 3.0
        table = quiet(lambda a, b: {"y": factor * a + b}, samples(5), workers=1)
        assert np.array_equal(table["y"], factor * table["a"] + table["b"])

    def test_script_without_a_guard(self, tmp_path):
        """Its processes do not run it again."""
        script = tmp_path / "script.py"
        script.write_text(
            textwrap.dedent("""
            import ancf
            print("begins")
            rows = ancf.sample({"a": [1.0, 2.0, 3.0]}, method="grid")
            def square(a):
                return {"y": a * a}
            print(ancf.study(square, rows, workers=2)["y"].tolist())
            """),
            encoding="utf-8",
        )
        ran = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=PATIENCE)
        assert ran.returncode == 0, ran.stderr
        assert ran.stdout == "begins\n[1.0, 4.0, 9.0]\n"

    def test_progress(self):
        steps = []
        quiet(product, samples(30), workers=1, progress=steps.append)
        assert steps[-1].done == steps[-1].wanted == 30
        assert [s.done for s in steps] == sorted(s.done for s in steps)
        assert steps[-1].left == 0.0


class TestAgain:
    def test_nothing_is_computed_twice(self, tmp_path):
        calls = tmp_path / "calls"
        calls.mkdir()
        function = functools.partial(counted, str(calls))
        for count in (10, 10, 25):
            table = quiet(function, samples(count), folder=tmp_path / "out", workers=2)
            assert len(table) == count
            assert len([*calls.iterdir()]) == count
        quiet(function, samples(25).iloc[::-1], folder=tmp_path / "out", workers=1)
        assert len([*calls.iterdir()]) == 25

    def test_rows_that_are_the_same_are_computed_once(self, tmp_path):
        rows = pd.DataFrame({"a": [1.0, 2.0, 1.0], "b": [0.5, 0.5, 0.5]})
        table = quiet(functools.partial(counted, str(tmp_path)), rows, workers=0)
        assert table["product"].tolist() == [0.5, 1.0, 0.5]
        assert len([*tmp_path.iterdir()]) == 2

    @pytest.mark.parametrize("other", [napping, functools.partial(counted, "."), lambda a, b: {"y": a}])
    def test_another_study_is_refused(self, tmp_path, other):
        quiet(product, samples(3), folder=tmp_path, workers=0)
        before = bytes_of(tmp_path)
        with pytest.raises(ancf.ModelError, match="holds another study: its"):
            quiet(other, samples(3), folder=tmp_path, workers=0)
        assert bytes_of(tmp_path) == before
        assert progress_of(tmp_path).done == 3

    def test_finished_work_starts_no_process(self, tmp_path, monkeypatch):
        quiet(product, samples(200), folder=tmp_path, workers=0)
        stamp = (tmp_path / "study.json").stat().st_mtime_ns
        monkeypatch.setattr(processes, "start", None)
        quiet(product, samples(200), folder=tmp_path, workers=2)
        assert (tmp_path / "study.json").stat().st_mtime_ns == stamp

    def test_two_at_once_are_refused(self, tmp_path):
        def inner(a, b):
            with pytest.raises(ancf.ModelError, match="another run is writing to it"):
                quiet(product, samples(1), folder=tmp_path, workers=0)
            return {"y": 1.0}

        assert quiet(inner, samples(1), folder=tmp_path, workers=0)["status"].tolist() == ["ok"]


class TestFailures:
    @pytest.mark.parametrize("workers", [0, 2])
    def test_are_rows_with_their_message(self, workers):
        table = quiet(sometimes_wrong, samples(40), workers=workers)
        wrong = (table["a"] > 2.5) | (table["b"] < 0.1)
        assert np.array_equal(table["status"] == "failed", wrong)
        assert 5 < wrong.sum() < 35
        raised = table[table["a"] > 2.5]
        assert raised["message"].str.fullmatch(r"t = \d\.\d+ s: the step diverged \(a smaller step\)").all()
        nan = table[wrong & (table["a"] <= 2.5)]
        assert (nan["message"] == "product: is nan, must be a finite number").all()
        assert table[wrong]["product"].isna().all()

    def test_are_computed_again_when_that_is_asked(self, tmp_path):
        calls = tmp_path / "calls"
        calls.mkdir()
        function = functools.partial(deadly_once, str(calls))
        assert (quiet(function, samples(4), folder=tmp_path / "out", workers=0)["status"] == "failed").all()
        assert (quiet(function, samples(4), folder=tmp_path / "out", workers=0)["status"] == "failed").all()
        assert (
            quiet(function, samples(4), folder=tmp_path / "out", workers=0, retry=True)["status"] == "ok"
        ).all()

    @pytest.mark.parametrize(
        ("returned", "phrase"),
        [
            (3.0, "outputs: must be numbers by name, are 3.0"),
            ({}, "outputs: must be numbers by name"),
            ({"y": "text"}, "outputs.y: must be a number, is 'text'"),
            ({"y": [1.0, 2.0]}, "outputs.y: must be a number"),
            ({"y": None}, "outputs.y: must be a number"),
            ({"y": True}, "outputs.y: must be a number"),
        ],
    )
    def test_outputs_that_are_no_numbers(self, returned, phrase):
        """It is the function that is wrong: the study ends at once."""
        with pytest.raises(ancf.ModelError) as caught:
            quiet(lambda a, b: returned, samples(50), workers=0)
        assert phrase in str(caught.value)

    def test_outputs_of_a_worker_that_are_no_numbers(self):
        with pytest.raises(ancf.ModelError, match=r"outputs: must be numbers by name, are 3\.0"):
            quiet(lambda a, b: 3.0, samples(50), workers=1)

    def test_what_is_finished_stays(self, tmp_path):
        """A later output of the wrong kind is a failed case."""
        table = quiet(lambda a, b: {"y": a if b < 0.9 else "much"}, samples(30), folder=tmp_path, workers=0)
        assert 0 < (table["status"] == "failed").sum() < 15

    def test_warnings_are_told(self):
        def function(a, b):
            import warnings

            warnings.warn("near the wave speed", UserWarning, stacklevel=1)
            return {"y": a}

        assert set(quiet(function, samples(3), workers=0)["message"]) == {"warning: near the wave speed"}

    @pytest.mark.parametrize(
        ("arguments", "phrase"),
        [
            ((3, samples(2)), "study.function: must be a function"),
            ((product, [1, 2]), "must be a DataFrame"),
            ((product, samples(2).head(0)), "must be a DataFrame with a row"),
            ((product, samples(2).assign(b=[1.0, np.nan])), 'study.samples["b"][1]: must be a finite number'),
            ((product, samples(2).rename(columns={"b": "status"})), "is a name that is taken"),
            ((lambda a, b: {"a": 1.0}, samples(2)), "outputs.a: is the name of a parameter"),
        ],
    )
    def test_bad(self, arguments, phrase):
        with pytest.raises(ancf.ModelError) as caught:
            quiet(*arguments, workers=0)
        assert phrase in str(caught.value)

    @pytest.mark.parametrize(
        ("function", "named"),
        [
            (lambda a, load: {"y": a}, "'load'"),
            (lambda a: {"y": a}, "'b'"),
            (lambda a, b, c: {"y": a}, "'c'"),
            (lambda: {"y": 1.0}, "'a'"),
            (functools.partial(lambda a, b, c: {"y": a}, b=2.0), "'c'"),
        ],
    )
    @pytest.mark.parametrize("workers", [0, 2])
    def test_function_of_other_arguments(self, function, named, workers, tmp_path):
        """Refused at once, not case by case: nothing is computed, no journal begun."""
        with pytest.raises(ancf.ModelError, match="does not take the columns of the samples, a, b") as caught:
            quiet(function, samples(4), workers=workers, folder=tmp_path / "out")
        assert caught.value.where == "study.function"
        assert named in caught.value.what
        assert not (tmp_path / "out").exists()

    @pytest.mark.parametrize(
        "function",
        [
            lambda a, b, c=1.0: {"y": a * b * c},
            lambda **values: {"y": values["a"] * values["b"]},
            functools.partial(lambda c, a, b: {"y": a * b}, 1.0),
        ],
    )
    def test_function_that_takes_them_in_its_way(self, function):
        table = quiet(function, samples(4), workers=0)
        assert table["y"].to_numpy() == pytest.approx((table["a"] * table["b"]).to_numpy())

    def test_function_that_cannot_go_to_another_process(self):
        lock = multiprocessing.Lock()
        with pytest.raises(ancf.ModelError, match="cannot be handed to other processes"):
            quiet(lambda a, b: {"y": float(lock is None)}, samples(2), workers=1)


def deadly_once(folder, a, b):
    from pathlib import Path

    mark = Path(folder) / f"{a!r}"
    if mark.exists() and len([*Path(folder).iterdir()]) >= 4:
        return product(a, b)
    mark.touch()
    raise RuntimeError("not yet")


class TestKilled:
    @pytest.mark.parametrize("times", [pytest.param(1, marks=pytest.mark.slow), 2])
    def test_worker(self, tmp_path, times):
        """Its case is computed by another one."""
        rows = ancf.sample({"a": [1, 2, 3, 4, 5, 6], "b": [0.5, 1.5]}, method="grid")
        table = quiet(functools.partial(deadly, str(tmp_path), times), rows, workers=2)
        assert len([*tmp_path.iterdir()]) == times
        assert np.array_equal(table["product"], rows["a"] * rows["b"])

    def test_worker_again_and_again(self, tmp_path):
        """The case is a failed one, the others are not."""
        rows = ancf.sample({"a": [1, 2, 3, 4, 5], "b": [0.5]}, method="grid")
        table = quiet(functools.partial(deadly, str(tmp_path), 99), rows, workers=2)
        assert table["status"].tolist() == ["ok", "ok", "failed", "ok", "ok"]
        assert table["message"][2] == "the process that computed it ended 3 times, the last with signal 9"

    @pytest.mark.parametrize("seed", [1, *(pytest.param(k, marks=pytest.mark.slow) for k in (2, 3))])
    def test_any_worker_at_any_time(self, tmp_path, seed):
        """Two of them: a third that dies over the same case would make it a failed one."""
        draw, killed = random.Random(seed), []

        def kill(step):
            children = multiprocessing.active_children()
            if len(killed) < MOST_DEATHS - 1 and draw.random() < 0.3 and children:
                killed.append(draw.choice(children).pid)
                os.kill(killed[-1], signal.SIGKILL)

        quiet(napping, samples(80), folder=tmp_path / "a", workers=2, progress=kill)
        quiet(napping, samples(80), folder=tmp_path / "b", workers=0)
        assert killed
        assert bytes_of(tmp_path / "a") == bytes_of(tmp_path / "b")

    def test_parent_at_random_moments(self, tmp_path, request):
        """The same call goes on; the table is the same to the last bit and no worker stays behind."""
        code = textwrap.dedent(f"""
            import sys
            sys.path.insert(0, {str(TESTS)!r})
            import ancf
            from design_functions import napping
            two = {{"a": ancf.Uniform(1.0, 3.0), "b": ancf.Uniform(0.0, 1.0)}}
            rows = ancf.sample(two, method="sobol", count=int(sys.argv[2]), seed=2)
            ancf.study(napping, rows, folder=sys.argv[1], workers=2, report=False)
            """)
        draw = random.Random(5)
        kills, count = (20, 400) if request.config.getoption("--slow") else (2, 100)
        command = [sys.executable, "-c", code, tmp_path / "a", str(count)]
        reached = [0]
        for _ in range(kills):
            process = subprocess.Popen(command, start_new_session=True)
            wanted = reached[-1] + draw.randrange(1, 9 * count // (10 * kills))
            while process.poll() is None and done_in(tmp_path / "a") < wanted:
                time.sleep(draw.uniform(0.001, 0.02))
            process.kill()
            process.wait()
            reached.append(done_in(tmp_path / "a"))
            assert gone(process.pid)
        assert reached == sorted(reached)
        assert 0 < reached[1] <= reached[-1] < count
        ran = python(code, tmp_path / "a", str(count))
        assert ran.code == 0, ran.err
        quiet(napping, samples(count), folder=tmp_path / "b", workers=0)
        assert bytes_of(tmp_path / "a") == bytes_of(tmp_path / "b")

    def test_interrupt(self, tmp_path):
        """Ctrl-C keeps what has ended."""

        def stop(step):
            if step.done >= 5:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            quiet(napping, samples(50), folder=tmp_path, workers=2, progress=stop)
        assert 5 <= progress_of(tmp_path).done < 50
        assert len(quiet(napping, samples(50), folder=tmp_path, workers=2)) == 50


def done_in(folder):
    try:
        return progress_of(folder).done
    except ancf.ModelError:
        return 0


def gone(session):
    """Whether no process of a session is left after a while."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        try:
            os.killpg(session, 0)
        except ProcessLookupError:
            return True
        time.sleep(0.05)
    return False


class TestJournal:
    def test_cases_are_known_by_their_values(self):
        assert case_key({"a": 1, "b": 2.0}) == case_key({"b": 2, "a": 1.0})
        different = [{"a": 1}, {"a": "1"}, {"b": 1}, {"a": 1 + 1e-16 * 3}, {"a": 1, "b": 1}]
        assert len({case_key(values) for values in different}) == len(different)

    def test_keeps_bits_and_the_first_of_two(self, tmp_path):
        values = {"x": 0.1 + 0.2, "y": 1e-310, "z": -0.0}
        journal = Journal(tmp_path / "j", {"function": "f"}, "out")
        journal.add([("k", Outcome("ok", values, "", 1.5)), ("k", Outcome("failed"))])
        journal.close()
        again = Journal(tmp_path / "j", {"function": "f"}, "out").outcomes()
        assert again == {"k": Outcome("ok", values, "", 1.5)}

    def test_damaged(self, tmp_path):
        (tmp_path / "journal.sqlite").write_bytes(b"no database" * 100)
        with pytest.raises(ancf.ModelError, match=r"journal\.sqlite cannot be read: file is not a database"):
            quiet(product, samples(2), folder=tmp_path, workers=0)
        with pytest.raises(ancf.ModelError, match="cannot be read"):
            progress_of(tmp_path)

    def test_no_study(self, tmp_path):
        with pytest.raises(ancf.ModelError, match="holds no study"):
            progress_of(tmp_path)


class TestFiles:
    def test_are_all_there(self, tmp_path):
        rows = ancf.sample(angles(), method="saltelli", count=8, seed=1)
        ancf.study(ishigami, rows, folder=tmp_path, workers=0, title="Ishigami <b>")
        names = {path.name for path in tmp_path.iterdir() if not path.name.endswith(("-wal", "-shm"))}
        assert names == {"journal.sqlite", "table.csv", "table.parquet", "study.json", "report.html"}
        page = (tmp_path / "report.html").read_text(encoding="utf-8")
        assert "Ishigami &lt;b&gt;" in page
        assert "40 cases of 3 parameters, sampling: saltelli" in page

    def test_formulas_of_spreadsheets_are_spelt_out(self, tmp_path):
        quiet(lambda word: {"y": 1.0}, pd.DataFrame({"word": ["=1+1", "x"]}), folder=tmp_path, workers=0)
        assert "\n0,'=1+1," in (tmp_path / "table.csv").read_text(encoding="utf-8")

    def test_pandas_is_not_imported_with_the_package(self):
        code = "import sys, ancf, ancf.cli.app, ancf.cli.study; print({'pandas', 'dask'} & set(sys.modules))"
        assert python(code).out == "set()\n"
