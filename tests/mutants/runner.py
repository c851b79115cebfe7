"""Runs the tests of mutants on copies of the package."""

import multiprocessing
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from itertools import repeat
from pathlib import Path
from queue import Queue

if sys.platform != "win32":
    import fcntl
    import resource

from .journal import Journal
from .listing import PACKAGE, ROOT, Mutant

KILLED, SURVIVED, WRONG = "killed", "survived", "error"
#: Children are forked from a process that has imported all that a change does not touch.
_SERVER = multiprocessing.get_context("forkserver" if sys.platform != "win32" else "spawn")
_TOUCHED_BY_NONE = (
    "numpy scipy.linalg scipy.sparse.linalg scipy.signal scipy.interpolate numba.extending h5py"
)
_SERVER.set_forkserver_preload([*_TOUCHED_BY_NONE.split(), "pydantic", "pytest", "typer", "rich.console"])
#: A mutant that makes its tests hang is noticed too: after so many seconds of processor time, on a busy
#: machine as on a quiet one, or of waiting.
LONGEST, LONGEST_WAIT = 300, 3600.0
#: Test files after which those that passed are put down.
_FILES_AT_ONCE = 6


@dataclass(frozen=True)
class Verdict:
    """What became of a mutant, what pytest said of the first test that failed, and the time it took, s."""

    mutant: Mutant
    outcome: str
    said: str
    seconds: float


class Copies:
    """A copy of the sources for each worker, at a fixed place: what is compiled serves the next run too."""

    def __init__(self, workers: int) -> None:
        self.place = (
            Path(tempfile.gettempdir()) / f"ancf-mutants-{os.getuid() if hasattr(os, 'getuid') else 0}"
        )
        self.base = self.place / "base"
        self.place.mkdir(mode=0o700, exist_ok=True)
        self._alone = (self.place / "lock").open("w")
        if sys.platform != "win32":
            fcntl.flock(self._alone, fcntl.LOCK_EX)  # another run would change the same copies
        self._copy_sources()
        self.stamp = _stamp(self.base)
        self.workers = [self.place / str(k) for k in range(workers)]

    def _copy_sources(self) -> None:
        """Renew the sources of the base, which keeps its compiled kernels."""
        target = self.base / "ancf"
        if target.exists():
            for path in target.rglob("*.py"):
                path.unlink()
        shutil.copytree(PACKAGE, target, dirs_exist_ok=True)
        if not any(target.rglob("*.nbi")):
            # not above: what imports this file must not import the unchanged package
            from ..compiled_kernels import take_kernels

            take_kernels(target)

    def spread(self) -> None:
        """Make the copies of the workers, compiled kernels included."""
        for copy in self.workers:
            shutil.rmtree(copy, ignore_errors=True)
            shutil.copytree(self.base, copy)

    def run(self, tests: list[str], copy: Path, how: str, *options: str) -> tuple[int | None, str]:
        """Run pytest with the package of a copy: exit code, None when the tests hang, and what it printed."""
        arguments = ["-o", "addopts=", "-q", "--no-header", "--tb=no", "-rf", "-p", "no:cacheprovider"]
        arguments += ["-p", "tests.mutants.plugin"]
        arguments += ["-W", "ignore::RuntimeWarning"] if how == "interpreted" else []
        arguments += [*options, *(f"tests/{test}" for test in tests)]
        with tempfile.TemporaryDirectory(dir=self.place) as folder:
            said = Path(folder) / "said.txt"
            cache = f"{folder}/kernels" if how == "compile" else ""
            child = _SERVER.Process(
                target=run_pytest, args=(arguments, str(copy), how, cache, str(said), copy == self.base)
            )
            child.start()
            child.join(LONGEST_WAIT)
            code = child.exitcode
            if code is None:
                child.kill()
                child.join()
            return code, said.read_text(encoding="utf-8") if said.exists() else ""


def run_pytest(arguments: list[str], package: str, how: str, cache: str, said: str, is_base: bool) -> None:
    """What a child does: pytest with this package; what it prints goes to the file ``said``.

    The base, which no change makes hang, takes the time it takes: it runs many tests at once and compiles.
    """
    if sys.platform != "win32" and not is_base:
        resource.setrlimit(resource.RLIMIT_CPU, (LONGEST, LONGEST))
    file = os.open(said, os.O_CREAT | os.O_WRONLY)
    for stream in (1, 2):
        os.dup2(file, stream)
    os.chdir(ROOT)
    sys.path[:] = [package, str(ROOT), *(p for p in sys.path if p not in (str(ROOT), str(PACKAGE.parent)))]
    sys.dont_write_bytecode = not is_base
    environment = {"PYTHONPATH": package, "ANCF_MUTANTS": how, "PYTEST_DISABLE_PLUGIN_AUTOLOAD": "1"}
    os.environ.update(environment | {"MPLBACKEND": "Agg"})
    import numba
    import pytest

    numba.config.CACHE_DIR = cache  # "": beside the sources
    code = int(pytest.main(arguments))
    sys.stdout.flush()
    os._exit(code)


def _stamp(copy: Path) -> str:
    """Stamp of the compiled kernels of unchanged sources."""
    code = "from ancf import compiled; print(compiled._STAMP)"
    environment = {**os.environ, "PYTHONPATH": str(copy)}
    done = subprocess.run([sys.executable, "-c", code], env=environment, capture_output=True, text=True)
    if not done.stdout.strip():
        raise RuntimeError(done.stderr)
    return done.stdout.strip()


def unchanged(mutants: list[Mutant], copies: Copies, journal: Journal) -> set[str]:
    """Tests that fail without a change, or that are not there; this compiles what the others need."""
    failing: set[str] = set()
    for how in ("interpreted", copies.stamp):
        chosen = [m for m in mutants if m.interprets == (how == "interpreted")]
        tests = sorted({t for m in chosen for t in m.tests if not journal.passed(t, how)})
        missing = _missing(tests, copies, how)
        failing |= missing
        parts = _parts([t for t in tests if t not in missing])
        with ThreadPoolExecutor(len(copies.workers)) as pool:
            done = pool.map(copies.run, parts, repeat(copies.base), repeat(how))
            for part, (code, said) in zip(parts, done, strict=True):
                failed = re.findall(r"^(?:FAILED|ERROR) tests/(\S+)", said, re.MULTILINE)
                bad = {t for t in part for f in failed if f == t or f.startswith((f"{t}[", f"{t}::"))}
                if code not in (0, 1):
                    raise RuntimeError(said)
                failing |= bad
                journal.keep_passed([t for t in part if t not in bad], how)
    return failing


def _parts(tests: list[str]) -> list[list[str]]:
    """Tests of a few files; those of a file stay together, for they compile the same kernels."""
    files = sorted({t.split("::")[0] for t in tests})
    parts = [files[k : k + _FILES_AT_ONCE] for k in range(0, len(files), _FILES_AT_ONCE)]
    return [[t for t in tests if t.split("::")[0] in part] for part in parts]


def _missing(tests: list[str], copies: Copies, how: str) -> set[str]:
    """Tests that pytest does not find."""
    if not tests:
        return set()
    _, said = copies.run(sorted({t.split("::")[0] for t in tests}), copies.base, how, "--collect-only")
    there = {line.removeprefix("tests/") for line in said.splitlines() if "::" in line}
    return {t for t in tests if not any(x == t or x.startswith((f"{t}[", f"{t}::")) for x in there)}


def run_all(mutants: list[Mutant], workers: int, report, anew: bool = False) -> list[Verdict]:
    """Verdict of each mutant; ``report`` is called with each as it comes, ``anew`` repeats earlier runs."""
    copies = Copies(workers)
    journal = Journal(copies.place / "journal.jsonl", anew)
    known = [Verdict(m, KILLED, said, 0.0) for m in mutants if (said := journal.noticed(m)) is not None]
    open_ = [m for m in mutants if journal.noticed(m) is None]
    failing = unchanged(open_, copies, journal)
    copies.spread()
    free: Queue[Path] = Queue()
    for copy in copies.workers:
        free.put(copy)

    def judge(mutant: Mutant) -> Verdict:
        copy = free.get()
        try:
            verdict = _judge(mutant, copies, copy, failing)
        finally:
            free.put(copy)
        if verdict.outcome == KILLED:
            journal.keep_noticed(mutant, verdict.said)
        report(verdict)
        return verdict

    with ThreadPoolExecutor(workers) as pool:
        return [*known, *pool.map(judge, open_)]


def _judge(mutant: Mutant, copies: Copies, copy: Path, failing: set[str]) -> Verdict:
    start = time.perf_counter()
    bad = [test for test in mutant.tests if test in failing]
    if bad:
        return Verdict(mutant, WRONG, f"fails without the change: {bad[0]}", 0.0)
    try:
        changed = mutant.changed()
    except ValueError as error:
        return Verdict(mutant, WRONG, str(error), 0.0)
    path = copy / "ancf" / mutant.file
    original = path.stat()
    text = path.read_text(encoding="utf-8")
    try:
        for old in (path.parent / "__pycache__").glob(f"{path.stem}.*.pyc"):
            old.unlink()  # a change within a second and of the same length would not be seen
        path.write_text(changed, encoding="utf-8")
        how = "interpreted" if mutant.interprets else "compile" if mutant.compiles else copies.stamp
        outcome, said = _outcome(mutant, copies, copy, how)
    finally:
        path.write_text(text, encoding="utf-8")
        os.utime(path, ns=(original.st_atime_ns, original.st_mtime_ns))
    return Verdict(mutant, outcome, said, time.perf_counter() - start)


def _outcome(mutant: Mutant, copies: Copies, copy: Path, how: str) -> tuple[str, str]:
    """Outcome and what pytest said."""
    one_case = any(test.endswith("]") for test in mutant.tests)  # which is to run
    form = "--slow" if one_case else "--whole"
    code, text = copies.run(list(mutant.tests), copy, how, "-x", form)
    if code is None:
        return KILLED, "the tests hang"
    if code < 0:
        return KILLED, f"the tests end with signal {-code}"
    if code == 0:
        return SURVIVED, ""
    said = re.search(r"^FAILED tests/(.*)$", text, re.MULTILINE)
    if code == 1 and said:
        return KILLED, said[1]
    lines = text.strip().splitlines()
    return WRONG, f"pytest ended with {code}: {lines[-1] if lines else ''}"
