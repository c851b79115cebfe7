"""Processes that reproduce the paper: what they share, how they end, and the cache that they fill."""

import os
import signal
import subprocess
import sys
import time
from functools import partial

import pytest

from ancf.paper import FIGURES, verify
from ancf.paper.schedule import cores, grouped
from ancf.paper.workers import run_groups
from commands import PATIENCE

pytest.importorskip("matplotlib")


def answer(name):
    """Work of a test's processes."""
    if name == "dies":
        os._exit(7)
    return f"{name} by {os.getpid()}"


def slow_answer(name, folder):
    (folder / f"{os.getpid()}.pid").touch()
    time.sleep(PATIENCE)
    return name


def soon(happened):
    """Wait for something."""
    end = time.monotonic() + PATIENCE
    while not happened():
        assert time.monotonic() < end
        time.sleep(0.05)


def alive(group):
    """Whether a group still has a process."""
    try:
        os.killpg(group, 0)
    except ProcessLookupError:
        return False
    return True


class TestSchedule:
    def test_every_figure_once(self):
        groups = grouped(FIGURES)
        assert sorted(name for group in groups for name in group) == sorted(FIGURES)

    def test_figures_that_share_runs_stay_together(self):
        groups = grouped(["fig5", "new", "fig11", "fig4", "fig10"])
        assert sorted(map(sorted, groups)) == [["fig10", "fig11"], ["fig4", "fig5"], ["new"]]

    def test_cores(self):
        assert 1 <= cores() <= (os.cpu_count() or 1)


class TestWorkers:
    def test_groups_stay_together(self):
        seen = []
        groups = [["a", "b"], ["c"], ["d", "e"]]
        run_groups(groups, answer, 2, lambda *event: seen.append(event))
        done = {name: made for kind, name, made in seen if kind == "done"}
        assert sorted(done) == list("abcde")
        owner = {name: made.split()[-1] for name, made in done.items()}
        assert owner["a"] == owner["b"]
        assert owner["d"] == owner["e"]
        assert str(os.getpid()) not in owner.values()
        assert [event[1] for event in seen if event[0] == "start" and event[1] in "ab"] == ["a", "b"]

    def test_a_process_that_dies_takes_no_other_with_it(self):
        seen = []
        run_groups([["a", "dies", "b"], ["c"]], answer, 2, lambda *event: seen.append(event))
        assert sorted(name for kind, name, _ in seen if kind == "done") == ["a", "b", "c"]
        assert [(name, code) for kind, name, code in seen if kind == "died"] == [("dies", 7)]

    def test_ctrl_c_ends_the_processes(self, tmp_path):
        def stop(kind, name, made):
            while len(list(tmp_path.glob("*.pid"))) < 2:
                time.sleep(0.05)
            raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            run_groups([["a"], ["b"]], partial(slow_answer, folder=tmp_path), 2, stop)
        for path in tmp_path.glob("*.pid"):
            with pytest.raises(ProcessLookupError):
                os.kill(int(path.stem), 0)

    def test_parallel_and_serial_give_the_same(self, tmp_path):
        serial = verify(["fig1", "fig12"], tmp_path / "serial", short=True)
        parallel = verify(["fig1", "fig12"], tmp_path / "parallel", short=True, jobs=2)
        assert parallel.jobs == 2
        assert serial.passed
        assert parallel.passed
        assert parallel.checks == serial.checks
        for name in ("fig1", "fig12"):
            for kind in ("png", "csv", "json"):
                one, other = (made.folder / f"{name}.{kind}" for made in (serial, parallel))
                assert one.read_bytes() == other.read_bytes()

    def test_ctrl_c(self, tmp_path):
        """A real process in a group of its own, stopped while its two workers compute."""
        old = [tmp_path / "out" / f"{name}.png" for name in ("fig14", "fig6")]
        old[0].parent.mkdir()
        for path in old:
            path.touch()
        command = [sys.executable, "-m", "ancf", "reproduce", "fig14", "fig6", "-j", "2"]
        ran = subprocess.Popen(
            command,
            cwd=tmp_path,
            stderr=subprocess.PIPE,
            text=True,
            start_new_session=True,
            # a process that was started in the background ignores Ctrl-C, and hands that on
            preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        )
        soon(lambda: not any(path.exists() for path in old))  # taken away when their figures begin
        os.killpg(ran.pid, signal.SIGINT)
        _, said = ran.communicate(timeout=PATIENCE)
        assert ran.returncode == 130
        assert said.splitlines()[-1] == "stopped by Ctrl-C"
        soon(lambda: not alive(ran.pid))
