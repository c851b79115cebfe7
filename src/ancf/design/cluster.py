"""Cases on a Dask cluster: the same work as in processes of this machine, in tasks of some cases."""

from __future__ import annotations

import hashlib
import socket
import threading
import time
from collections import deque
from collections.abc import Iterator, Sequence
from contextlib import suppress
from typing import Any

from ..errors import ModelError, SolveError
from ..model.checks import shown
from .extras import extra
from .journal import FAILED, Outcome
from .processes import Case
from .work import Function, outcome, unpacked

#: s until a scheduler must have answered, and one that listens but is busy.
PATIENCE, BUSY = 10.0, 300.0
#: Work of one task, s, and the most cases; tasks that wait for each thread of the cluster.
AT_ONCE, MOST_AT_ONCE, WAITING = 2.0, 500, 2
#: s that the first case has to itself, so that the kernels are compiled once.
ALONE = 120.0
#: Functions of this process by their bytes; a process of a cluster computes one case at a time.
_functions: dict[str, Function] = {}
_one = threading.Lock()


def listens(address: str) -> bool:
    """Whether something takes connections at ``tcp://host:port``."""
    host, _, port = address.removeprefix("tcp://").rpartition(":")
    try:
        socket.create_connection((host.strip("[]"), int(port)), timeout=PATIENCE).close()
    except (OSError, ValueError):
        return False
    return True


class Cluster:
    """Computes cases on the workers of a scheduler.

    Parameters
    ----------
    function : bytes
        See :func:`ancf.design.work.packed`.
    scheduler : str or distributed.Client
        Its address, ``tcp://host:8786``.

    Raises
    ------
    ModelError
        It does not answer.
    """

    def __init__(self, function: bytes, scheduler: Any) -> None:
        self._function = function
        self._distributed = extra("distributed")
        self._own = isinstance(scheduler, str)
        self._client = self._connected(scheduler) if self._own else scheduler
        self._seconds, self._ended = 0.0, 0
        self._suspects: deque[Case] = deque()
        self._alone = ""

    def _connected(self, address: str) -> Any:
        make = self._distributed.Client
        try:
            try:
                return make(address, timeout=PATIENCE, set_as_default=False)
            except OSError:
                if not listens(address):
                    raise
                return make(address, timeout=BUSY, set_as_default=False)
        except (OSError, ValueError, ImportError) as error:
            what = f"does not answer: {str(error).splitlines()[0] if str(error) else type(error).__name__}"
            hint = "start one with: dask scheduler; and on each machine: dask worker ADDRESS --nthreads 1"
            raise ModelError(f"scheduler {shown(address)}", what, hint) from None

    def outcomes(self, cases: Sequence[Case]) -> Iterator[tuple[str, Outcome]]:
        """Outcomes by key, as their tasks end.

        The first case runs alone until it has ended, or for two minutes. A cluster counts the end of a
        process against all that waited there; so cases that seem to have ended one run again at last, alone.

        Raises
        ------
        SolveError
            The cluster has gone.
        """
        waiting = deque(cases)
        tasks: dict[Any, list[Case]] = {}
        try:
            self._submit([waiting.popleft()], tasks)
            begun = time.monotonic()
            while tasks or waiting or self._suspects:
                if not tasks and not waiting:
                    suspect = self._suspects.popleft()
                    self._alone = suspect[0]
                    self._submit([suspect], tasks)
                alone = not self._ended and time.monotonic() - begun < ALONE
                if not alone:
                    while waiting and len(tasks) < self._room():
                        self._submit(self._some(waiting), tasks)
                yield from self._ready(tasks)
        except (OSError, self._distributed.CancelledError) as error:
            told = str(error).splitlines()[0] if str(error) else type(error).__name__
            raise SolveError("scheduler", f"has gone: {told}", "the same command goes on") from None
        finally:
            for task in tasks:
                task.cancel()
            if self._own:
                self._client.close()

    def _submit(self, cases: list[Case], tasks: dict[Any, list[Case]]) -> None:
        task = self._client.submit(run_cases, self._function, cases, pure=False, retries=0)
        tasks[task] = cases

    def _room(self) -> int:
        threads = sum(
            worker["nthreads"] for worker in self._client.scheduler_info(n_workers=-1)["workers"].values()
        )
        return max(1, WAITING * int(threads))

    def _some(self, waiting: deque[Case]) -> list[Case]:
        mean = self._seconds / self._ended if self._ended else AT_ONCE
        most = min(MOST_AT_ONCE, len(waiting) // (2 * self._room()), int(AT_ONCE / max(mean, 1e-6)))
        return [waiting.popleft() for _ in range(max(1, most))]

    def _ready(self, tasks: dict[Any, list[Case]]) -> Iterator[tuple[str, Outcome]]:
        """Outcomes of the tasks that have ended since; waits half a second at most."""
        if not tasks:
            return
        with self._client.as_current(), suppress(TimeoutError):
            self._distributed.wait([*tasks], timeout=0.5, return_when="FIRST_COMPLETED")
        if self._client.status not in ("running", "connecting"):
            raise OSError(f"the connection is {self._client.status}")
        for task in [task for task in tasks if task.done()]:
            cases = tasks.pop(task)
            error = task.exception()
            if error is None:
                made = task.result()
            elif len(cases) > 1:  # which of them it was shows when each has a task of its own
                for case in cases:
                    self._submit([case], tasks)
                continue
            elif cases[0][0] != self._alone:
                self._suspects.extend(cases)
                continue
            else:
                told = f"the process that computed it ended: {type(error).__name__}"
                made = [(cases[0][0], Outcome(FAILED, {}, told))]
            for key, ended in made:
                self._seconds, self._ended = self._seconds + ended.seconds, self._ended + 1
                yield key, ended


def run_cases(function: bytes, cases: Sequence[Case]) -> list[tuple[str, Outcome]]:
    """What a task does."""
    name = hashlib.sha256(function).hexdigest()
    with _one:
        if name not in _functions:
            _functions[name] = unpacked(function)
        return [(key, outcome(_functions[name], values)) for key, values in cases]
