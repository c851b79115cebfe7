"""Worker processes: each takes a group of exhibits, computes them one after another, and takes the next."""

from __future__ import annotations

import signal
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from multiprocessing.connection import Connection, wait
from typing import Any, Literal, TypeVar

from ..worker import PATIENCE, Worker, crew, start

T = TypeVar("T")
Kind = Literal["start", "done", "compiling", "died"]
#: Called in this process with what happens: kind, name, and what came out when it is done.
Watch = Callable[[Kind, str, Any], None]


def run_groups(groups: Sequence[Sequence[str]], make: Callable[[str], T], jobs: int, watch: Watch) -> None:
    """Call ``make`` with all names, in `jobs` processes; `watch` gets what comes out.

    ``make`` is pickled and must not raise. A name whose process dies is reported as ``died``, with the exit
    code; the rest of its group goes to another process. Ctrl-C ends the processes.
    """
    waiting = deque(group for group in groups if group)
    with crew(min(jobs, len(waiting)), lambda: start(_serve, make)) as workers:
        for worker in workers:
            worker.give(waiting.popleft())
        while busy := [worker for worker in workers if worker.left]:
            for pipe in wait([worker.pipe for worker in busy]):
                worker = next(worker for worker in busy if worker.pipe is pipe)
                if not _heard(worker, watch):
                    watch("died", worker.left.popleft(), worker.process.exitcode)
                    if worker.left:
                        waiting.appendleft(tuple(worker.left))
                    workers[workers.index(worker)] = worker = start(_serve, make)
                if not worker.left and waiting:
                    worker.give(waiting.popleft())


def _heard(worker: Worker[str], watch: Watch) -> bool:
    """Take one message of a worker; False when its process has ended."""
    try:
        kind, name, made = worker.pipe.recv()
    except (EOFError, OSError):
        worker.process.join(PATIENCE)
        return False
    if kind == "done":
        worker.left.popleft()
    watch(kind, name, made)
    return True


def _serve(pipe: Connection, make: Callable[[str], Any]) -> None:
    """What a worker does: it waits for groups until it gets an empty one."""
    from ..kernel_cache import announce_compilation

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process answers Ctrl-C and ends this one
    announce_compilation(lambda: pipe.send(("compiling", "", None)))
    with suppress(EOFError, OSError):  # the first process has gone
        while group := pipe.recv():
            for name in group:
                pipe.send(("start", name, None))
                pipe.send(("done", name, make(name)))
