"""Cases in processes of this machine: each takes a few, sends every outcome at once, takes the next."""

from __future__ import annotations

import multiprocessing
import os
import signal
import sys
import threading
import time
import types
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from multiprocessing.connection import Connection, wait
from typing import Any

from ..worker import PATIENCE, Worker, crew, start
from .journal import FAILED, Outcome
from .work import outcome, unpacked

Case = tuple[str, dict[str, Any]]
#: Work that is handed over at once, s, and the most cases.
AT_ONCE, MOST_AT_ONCE = 0.5, 200
#: Processes that may die over one case before it counts as failed.
MOST_DEATHS = 3
#: s without compiling in the first case after which the others begin.
QUIET = 3.0


class Processes:
    """Computes cases in a number of processes.

    Parameters
    ----------
    function : bytes
        See :func:`ancf.design.work.packed`.
    count : int
    """

    def __init__(self, function: bytes, count: int) -> None:
        self._function, self._count = function, count
        self._deaths: dict[str, int] = {}
        self._seconds, self._ended = 0.0, 0
        self._compiling, self._changed = 0, 0.0

    def outcomes(self, cases: Sequence[Case]) -> Iterator[tuple[str, Outcome]]:
        """Outcomes by key, as they come.

        The first case runs alone until the kernels are compiled: the others find them in the cache.
        """
        waiting, alone = deque(cases), True
        with crew(min(self._count, len(waiting)), self._start) as workers:
            self._changed = time.monotonic()
            workers[0].give([waiting.popleft()])
            while any(worker.left for worker in workers) or waiting:
                for pipe in wait([worker.pipe for worker in workers if worker.left], timeout=0.5):
                    worker = next(worker for worker in workers if worker.pipe is pipe)
                    yield from self._heard(worker, workers, waiting)
                alone = alone and not self._ended and not self._quiet()
                for worker in workers:
                    if waiting and not worker.left and (not alone or worker is workers[0]):
                        worker.give(self._some(waiting, len(workers)))

    def _quiet(self) -> bool:
        return not self._compiling and time.monotonic() - self._changed > QUIET

    def _some(self, waiting: deque[Case], workers: int) -> list[Case]:
        """As many cases as make half a second of work, fewer towards the end."""
        mean = self._seconds / self._ended if self._ended else AT_ONCE
        most = min(MOST_AT_ONCE, len(waiting) // (2 * workers), int(AT_ONCE / max(mean, 1e-6)))
        return [waiting.popleft() for _ in range(max(1, most))]

    def _heard(
        self, worker: Worker[Case], workers: list[Worker[Case]], waiting: deque[Case]
    ) -> Iterator[tuple[str, Outcome]]:
        """Take one message of a worker, or replace it if it has died."""
        try:
            kind, made = worker.pipe.recv()
        except (EOFError, OSError):
            yield from self._died(worker, workers, waiting)
            return
        if kind == "compiling":
            self._compiling, self._changed = made, time.monotonic()
            return
        key, _ = worker.left.popleft()
        self._seconds, self._ended = self._seconds + made.seconds, self._ended + 1
        yield key, made

    def _died(
        self, worker: Worker[Case], workers: list[Worker[Case]], waiting: deque[Case]
    ) -> Iterator[tuple[str, Outcome]]:
        worker.process.join(PATIENCE)
        self._compiling = 0
        key = worker.left[0][0]
        self._deaths[key] = self._deaths.get(key, 0) + 1
        if self._deaths[key] == MOST_DEATHS:
            worker.left.popleft()
            told = f"the process that computed it ended {MOST_DEATHS} times, the last with {_end_of(worker)}"
            yield key, Outcome(FAILED, {}, told)
        waiting.extendleft(reversed(worker.left))
        worker.pipe.close()
        workers[workers.index(worker)] = self._start()

    def _start(self) -> Worker[Case]:
        with without_script():
            return start(serve, self._function)


def _end_of(worker: Worker[Case]) -> str:
    code = worker.process.exitcode
    if code is not None and code < 0:
        return f"signal {-code}"
    return f"exit code {code}"


@contextmanager
def without_script() -> Iterator[None]:
    """A new process must not run the user's script again: the function comes to it by value."""
    main = sys.modules["__main__"]
    sys.modules["__main__"] = types.ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


def serve(pipe: Connection, function: bytes) -> None:
    """What a process does: it waits for cases until it gets none."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process answers Ctrl-C and ends this one
    _end_with_parent()
    call: Any = None
    with suppress(EOFError, OSError):  # the first process has gone
        while cases := pipe.recv():
            if call is None:
                _tell_compiling(pipe)
                call = unpacked(function)
            for _, values in cases:
                pipe.send(("done", outcome(call, values)))


def _end_with_parent() -> None:
    """End when the first process does, also in the middle of a case."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def watch(sentinel: int) -> None:
        wait([sentinel])
        os._exit(1)

    threading.Thread(target=watch, args=(parent.sentinel,), daemon=True).start()


def _tell_compiling(pipe: Connection) -> None:
    """Send how deep it is in compiling whenever that begins or ends."""
    from ..kernel_cache import watch_compilation

    watch_compilation(lambda depth: pipe.send(("compiling", depth)))
