"""The command line as processes: Ctrl-C, kill, a full disk, a terminal, a second start."""

import json
import os
import re
import signal
import subprocess
import sys
import time

import pytest

import ancf
from commands import LONG, MODEL, PATIENCE, SIMULATION, Ran, python
from overhead_lines import TOML


def process(folder, *arguments, **environment):
    """Start a command as a user does; Ctrl-C reaches it even where the tests run in the background."""
    return subprocess.Popen(
        [sys.executable, "-m", "ancf", *arguments],
        cwd=folder,
        env={**os.environ, **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )


def finished(folder, *arguments, **environment):
    work = process(folder, *arguments, **environment)
    out, err = work.communicate(timeout=PATIENCE)
    return Ran(work.returncode, out, err)


def running_until_stored(folder):
    """A long run that has stored more than its first state."""
    (folder / "model.toml").write_text(MODEL + LONG, encoding="utf-8")
    work = process(folder, "run", "model.toml", "-o", "out")
    deadline = time.monotonic() + PATIENCE
    while time.monotonic() < deadline and work.poll() is None:
        time.sleep(0.3)
        try:
            if len(ancf.load(folder / "out/results.h5").t) > 10:
                return work
        except (ancf.ModelError, OSError):
            pass
    work.kill()
    raise AssertionError(f"no results: {work.communicate()}")


@pytest.mark.skipif(sys.platform == "win32", reason="no limit of file sizes")
def test_a_full_disk(tmp_path, call):
    import resource

    (tmp_path / "model.toml").write_text(MODEL + SIMULATION, encoding="utf-8")
    call("run", "model.toml")  # so that nothing is compiled under the limit
    (tmp_path / "model.toml").write_text(MODEL + LONG, encoding="utf-8")
    command = [sys.executable, "-m", "ancf", "run", "model.toml", "-q"]
    limit = 1_000_000
    ran = subprocess.run(
        command,
        cwd=tmp_path,
        capture_output=True,
        text=True,
        preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)),
    )
    assert ran.returncode == 1
    assert ran.stderr.startswith("error: out/results.h5: cannot be written any more: File too large\n")
    assert len(ran.stderr.splitlines()) == 3
    assert "kept in out/results.h5" in ran.stderr
    info = call("info", "out/results.h5")
    assert info.code == 0
    assert "not finished" in info.out


def test_ctrl_c_keeps_the_results(tmp_path, call):
    work = running_until_stored(tmp_path)
    work.send_signal(signal.SIGINT)
    out, err = work.communicate(timeout=PATIENCE)
    assert work.returncode == 130
    assert out == ""
    assert "Traceback" not in err
    assert re.search(r"stopped by Ctrl-C\n  results up to t = \S+ s kept in out/results.h5", err)
    result = ancf.load(tmp_path / "out/results.h5")
    assert result.status == "interrupted"
    summary = json.loads((tmp_path / "out/summary.json").read_text(encoding="utf-8"))
    assert summary["status"] == "interrupted"
    assert summary["t"] == result.t[-1]
    info = call("info", "out/results.h5")
    assert info.code == 0
    assert "stopped before its end; reached t = " in info.out


def test_a_killed_run_can_be_read(tmp_path, call):
    work = running_until_stored(tmp_path)
    second = call("run", "model.toml")
    work.kill()
    work.communicate(timeout=PATIENCE)
    assert "output folder out: another run is writing to it" in second.err
    assert second.code == 2
    info = call("info", "out/results.h5")
    assert (info.code, info.err) == (0, "")
    assert "not finished: still running, or killed; reached t = " in info.out
    assert "of 100000 s" in info.out
    assert not (tmp_path / "out/summary.json").exists()


def test_a_later_start_compiles_nothing(tmp_path, call):
    (tmp_path / "model.toml").write_text(MODEL + SIMULATION, encoding="utf-8")
    call("run", "model.toml")
    ran = finished(tmp_path, "run", "model.toml")
    assert ran.code == 0
    assert "compiling" not in ran.err


def test_the_message_about_compiling_comes_once(tmp_path):
    lines = (
        "import numba",
        "from ancf.cli.screen import Screen",
        "Screen().announce_compilation()",
        "for x in (1, 1.0): numba.njit(lambda x: x + 1)(x)",
    )
    ran = python("\n".join(lines))
    assert ran.code == 0
    assert ran.err == "compiling the numerical core: this happens only once on this machine ...\n"


@pytest.mark.parametrize(
    ("arguments", "written"),
    [
        (("catenary", "form", "line.toml"), {"schedule.csv", "arms.csv"}),
        (("catenary", "elasticity", "line.toml"), {"elasticity.csv"}),
        (("run", "model.toml"), {"results.h5", "summary.json"}),
    ],
)
def test_a_reader_that_goes_away_costs_no_files(tmp_path, arguments, written):
    """As with ``| head -1``: what is printed is lost, what is written is not."""
    (tmp_path / "line.toml").write_text(TOML, encoding="utf-8")
    (tmp_path / "model.toml").write_text(MODEL + SIMULATION, encoding="utf-8")
    reading, writing = os.pipe()
    os.close(reading)
    done = subprocess.run(
        [sys.executable, "-m", "ancf", *arguments, "-o", "out"],
        cwd=tmp_path,
        stdout=writing,
        stderr=subprocess.PIPE,
        timeout=PATIENCE,
    )
    os.close(writing)
    assert done.returncode == 0, done.stderr
    assert {file.name for file in (tmp_path / "out").iterdir()} >= written


def test_a_terminal_that_knows_no_letters(tmp_path):
    (tmp_path / "model.toml").write_text(MODEL + SIMULATION, encoding="utf-8")
    ran = finished(tmp_path, "info", "model.toml", PYTHONIOENCODING="ascii")
    assert (ran.code, ran.err) == (0, "")
    assert r"Gr\xf6\xdfe" in ran.out


@pytest.mark.skipif(sys.platform == "win32", reason="no pseudo-terminals")
@pytest.mark.parametrize("no_color", ["", "1"])
def test_bar_in_a_terminal(tmp_path, no_color):
    text = MODEL + SIMULATION.replace("t_end = 0.4", "t_end = 5.0")
    (tmp_path / "model.toml").write_text(text, encoding="utf-8")
    seen = in_terminal(tmp_path, ["run", "model.toml"], NO_COLOR=no_color, TERM="xterm", COLUMNS="120")
    assert re.search(r"\d+ %  step \d+ of 20000", seen)
    assert "Traceback" not in seen
    assert "\x1b[?25h" in seen  # the cursor is shown again
    assert bool(re.search(r"\x1b\[(3\d|9\d)[\d;]*m", seen)) != bool(no_color)


def in_terminal(folder, arguments, **environment):
    import pty

    ours, theirs = pty.openpty()
    command = [sys.executable, "-m", "ancf", *arguments]
    work = subprocess.Popen(
        command, cwd=folder, env={**os.environ, **environment}, stdout=theirs, stderr=theirs
    )
    os.close(theirs)
    seen = b""
    while True:
        try:
            part = os.read(ours, 4096)
        except OSError:
            break
        if not part:
            break
        seen += part
    os.close(ours)
    assert work.wait(timeout=PATIENCE) == 0
    return seen.decode("utf-8", errors="replace")
