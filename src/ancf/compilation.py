"""What is said and done when kernels have to be compiled: a line before and after, and a process that helps.

Most of a first run is the compilation of two independent halves: the time stepping, which is the same for all
models, and the operations of the kinds that a model has.  A second process begins at the other end of the
list; what one works on the other waits for (:mod:`ancf.kernel_cache`), and both leave it in the cache.
"""

from __future__ import annotations

import atexit
import gc
import json
import multiprocessing
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias, cast

import numba
from numba.core import event

from .compiled import traits
from .errors import ModelError
from .model import checks
from .model.integrators import INTEGRATORS, Explicit, Integrator, NewmarkFamily, Trapezoidal
from .model.model import Model

Kernel: TypeAlias = tuple[Any, tuple[Any, ...]]

BEFORE = "compiling the numerical core, once on this machine: {what} first, 10 to 40 s in all ..."
AFTER = "compiled in {seconds:.0f} s: {what}"
#: What is said of files with kernels, by the beginning of their names.
PARTS = {
    "solvers.static": "equilibria",
    "solvers.radau": "Radau's method",
    "solvers.explicit": "explicit stepping",
    "solvers": "time stepping",
    "system": "matrix and supports",
    "linalg": "factorisation",
    "loads": "loads",
    "contact": "contact",
    "records": "records",
}


def _to_stderr(text: str) -> None:
    """In a script or a notebook: nothing waits for long without a word."""
    with suppress(OSError, ValueError):
        print(f"ancf: {text}", file=sys.stderr, flush=True)


class _Listener(event.Listener):
    """Counts what is compiled, says that it begins, and has a process help."""

    def __init__(self) -> None:
        self.say: Callable[[str], None] = _to_stderr
        self.depth = 0
        self.collects = True
        self.began = 0.0
        self.names: list[str] = []
        self.work: tuple[Model, Integrator | None] | None = None
        self.helper: subprocess.Popen[bytes] | None = None
        self.helped: Any = None  # outline of what that works on

    def on_start(self, event: Any) -> None:
        self.depth += 1
        if self.depth > 1:
            return
        self.collects = gc.isenabled()
        gc.disable()  # what a compiler makes lives as long as it works: looking through it takes an eighth
        if self.work is None:
            return
        name = _named(event.data)
        if not self.names:
            self.began = time.perf_counter()
            if self.say is _to_stderr:
                self.say(BEFORE.format(what=name))
            self.help()
        if name not in self.names:
            self.names.append(name)

    def on_end(self, event: Any) -> None:
        self.depth -= 1
        if self.depth == 0 and self.collects:
            gc.enable()

    def help(self) -> None:
        """Start a process that compiles from the other end, if there is a core and a cache for it.

        One that works on something else, as the wires of a line before its pantographs, ends.
        """
        if self.work is None or not _useful():
            return
        model, method = self.work
        with suppress(ValueError, TypeError):
            wanted = {"model": model.to_dict(), "method": method.name if method else None}
            outline = isinstance(method, Explicit), _outline(wanted["model"])
            if self.helper is None or self.helper.poll() is not None or outline != self.helped:
                self.end()
                self.helped = outline
                self._start(json.dumps(wanted))

    def _start(self, given: str) -> None:
        folder = str(Path(__file__).parent.parent)
        path = os.pathsep.join([folder, *filter(None, [os.environ.get("PYTHONPATH")])])
        env = {**os.environ, "PYTHONPATH": path, "ANCF_HELPS": "1"}
        if folder := getattr(numba.config, "CACHE_DIR", ""):
            env["NUMBA_CACHE_DIR"] = folder
        with suppress(OSError, ValueError, TypeError):
            silent = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL}
            command = [sys.executable, "-m", "ancf.compilation"]
            self.helper = subprocess.Popen(command, stdin=subprocess.PIPE, env=env, **silent)  # type: ignore[call-overload]
            assert self.helper is not None
            assert self.helper.stdin is not None
            self.helper.stdin.write(given.encode())
            self.helper.stdin.close()

    def finish(self) -> None:
        """Say what was compiled."""
        if self.names:
            self.say(AFTER.format(seconds=time.perf_counter() - self.began, what=", ".join(self.names)))
        self.names = []

    def end(self) -> None:
        """End the process that helps."""
        if self.helper is not None:
            self.helper.kill()
            self.helper.wait()
            self.helper = None


_listener = _Listener()
cast(Any, event).register("numba:compile", _listener)
atexit.register(_listener.end)


def announce(say: Callable[[str], None]) -> None:
    """Say by `say` what was compiled: a command has a console of its own, and says itself that it begins."""
    _listener.say = say


def check_model(given: object) -> None:
    """Raise ModelError for what is no Model."""
    if not isinstance(given, Model):
        hint = "a model file is computed by: ancf run FILE" if isinstance(given, str | Path) else ""
        raise ModelError("model", f"must be a Model, is {checks.shown(given)}", hint)


@contextmanager
def expected(model: Model, method: Integrator | None = None) -> Iterator[None]:
    """Here kernels may have to be compiled for a model, and for a method if it is simulated.

    Raises
    ------
    ModelError
        What is to be computed is no model.
    """
    check_model(model)
    if _listener.work is not None:
        yield
        return
    _listener.work = model, method
    try:
        yield
        _listener.finish()
    finally:
        _listener.work, _listener.names = None, []
        if method is not None:  # all is compiled; after an equilibrium the stepping is what comes next
            _listener.end()


def _outline(given: Any) -> Any:
    """A description without its numbers: what is equal is compiled alike."""
    if isinstance(given, dict):
        return {key: _outline(value) for key, value in given.items()}
    if isinstance(given, list | tuple):
        return [_outline(value) for value in given]
    return given if isinstance(given, str | bool) or given is None else 0


def _useful() -> bool:
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    # without locks both would compile the same
    wanted = cores > 1 and sys.platform != "win32" and not getattr(numba.config, "DISABLE_JIT", 0)
    if multiprocessing.parent_process() is not None:  # one of many that share the cores
        return False
    return wanted and "ANCF_HELPS" not in os.environ and bool(sys.executable)


def _named(data: Any) -> str:
    """What a kernel is for, in words."""
    origin = data["dispatcher"].py_func.__module__ or "a formula"
    package, module = origin.split(".")[0], origin.removeprefix("ancf.")
    if package not in ("ancf", "a formula"):
        return "operations on arrays" if package == "numba" else "your functions"
    for argument in data["args"]:
        kind = getattr(argument, "batch", argument)
        batch = getattr(kind, "instance_class", None)
        if batch is not None and batch.__name__ != "Batches" and module in ("batches", "records"):
            return _words(batch.__name__)
    return next((said for start, said in PARTS.items() if module.startswith(start)), module)


def _words(name: str) -> str:
    """``CableBatch`` as "cable"."""
    short = name.removesuffix("Batch")
    return "".join(f" {c.lower()}" if c.isupper() and k else c.lower() for k, c in enumerate(short))


class Needed(NamedTuple):
    """Kernels with the types of what they take, none of them compiled."""

    steps: Kernel  # takes the steps of the method
    operations: list[Kernel]  # of the kinds of the model, in the order in which a System asks for them
    resting: list[Kernel]  # of an equilibrium besides them
    apart: list[Kernel]  # what is apart from the steps
    sensors: list[Kernel]  # what sensors need besides it


def needed(model: Model, method: Integrator | None) -> Needed:
    """What a model needs.

    Parameters
    ----------
    model : Model
    method : Integrator or None
        One that takes no steps of its own kernel is read as the default.
    """
    from .records import RecordType, type_of
    from .solvers.apart import Apart, apart_of, strands_of
    from .solvers.apart import needed as apart_needed
    from .solvers.block import stepping
    from .solvers.runs import run_of
    from .solvers.sampling import sampling_of
    from .system.sensors import listing
    from .system.system import System

    found: list[Kernel] = []

    def note(dispatcher: Any, signature: tuple[Any, ...], result: Any) -> int:
        found.append((dispatcher, signature))
        return 0

    used = method if isinstance(method, NewmarkFamily | Explicit) else Trapezoidal()
    with _in_place_of_compiling(note):
        system = System(model)
        operations, found = found, []
        run: Any = run_of(used, system, 0.0, 1.0, 0.5, 1)
        memory, sampling = run.memory, run.sampling
        types = type_of(system.core), type_of(memory), type_of(sampling)
        wanted = apart_needed(system.core, memory, sampling, run.explicit)
        apart_of(*types, wanted, strands_of(system.core))
        apart, found = found, []
        apart_of(*types, tuple(name in ("note", "sample") for name in Apart._fields))
        system.sensors = listing(system, [*map(model.sensor, system.measures)], accelerations=False)
        sampling_of(system)
    batches = [batch for batch in system.core.batches if len(batch[0])]
    resting = [
        (kernel, (RecordType(type_of(batch)), *given))
        for batch in batches
        for kernel, given in traits(batch).resting
    ]
    return Needed(stepping(system.core, memory, sampling, run.explicit), operations, resting, apart, found)


@contextmanager
def _in_place_of_compiling(note: Callable[..., int]) -> Iterator[None]:
    """Here kernels that are called by an address are not compiled: what gives their addresses is `note`."""
    from . import addresses

    there = cast(Any, addresses)
    address, there.address_of = there.address_of, note
    found, there.found = there.found, {}
    try:
        yield
    finally:
        there.address_of, there.found = address, found


def main() -> None:
    """Compile what the process that started this one will need, beginning with what it needs last."""
    given = json.load(sys.stdin)
    method = INTEGRATORS[given["method"]]() if given["method"] else None
    try:
        found = needed(Model.from_dict(given["model"]), method)
    except Exception:  # a model with Python functions, of which a description keeps the names only
        mass = Model()
        mass.add_point_mass("m", at=(0, 0, 0), mass=1.0)
        found = needed(mass, method)
    jobs = [found.steps, *found.operations[::-1]]
    if method is None:  # what comes after an equilibrium, as a rule
        jobs = [*found.operations[::-1], *found.resting, found.steps]
    jobs += [*found.apart[::-1], *found.sensors]
    for dispatcher, signature in jobs:
        if getattr(getattr(dispatcher, "_cache", None), "cache_path", ""):  # else nothing would be kept
            with suppress(Exception):
                dispatcher.compile(signature)


if __name__ == "__main__":
    main()
