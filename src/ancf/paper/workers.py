"""Worker processes: each takes a group of exhibits, computes them one after another, and takes the next."""

from __future__ import annotations

import multiprocessing
import os
import signal
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection, wait
from typing import TYPE_CHECKING, Any, Literal, TypeVar

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

T = TypeVar("T")
Kind = Literal["start", "done", "compiling", "died"]
#: Called in this process with what happens: kind, name, and what came out when it is done.
Watch = Callable[[Kind, str, Any], None]
#: One thread each: the processes share the cores.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
PATIENCE = 2.0  # s that a process gets to end


@dataclass
class Worker:
    """A process, this end of its pipe, and what it has still to do."""

    process: BaseProcess
    pipe: Connection
    left: deque[str] = field(default_factory=deque)

    def give(self, group: Sequence[str]) -> None:
        """Hand over a group of names; none ends the process."""
        self.left = deque(group)
        with suppress(OSError):  # it died: the other end of the pipe tells
            self.pipe.send(list(group))


def run_groups(groups: Sequence[Sequence[str]], make: Callable[[str], T], jobs: int, watch: Watch) -> None:
    """Call ``make`` with all names, in `jobs` processes; `watch` gets what comes out.

    ``make`` is pickled and must not raise. A name whose process dies is reported as ``died``, with the exit
    code; the rest of its group goes to another process. Ctrl-C ends the processes.
    """
    waiting = deque(group for group in groups if group)
    with _workers(min(jobs, len(waiting)), make) as workers:
        for worker in workers:
            worker.give(waiting.popleft())
        while busy := [worker for worker in workers if worker.left]:
            for pipe in wait([worker.pipe for worker in busy]):
                worker = next(worker for worker in busy if worker.pipe is pipe)
                if not _heard(worker, watch):
                    watch("died", worker.left.popleft(), worker.process.exitcode)
                    if worker.left:
                        waiting.appendleft(tuple(worker.left))
                    workers[workers.index(worker)] = worker = _start(make)
                if not worker.left and waiting:
                    worker.give(waiting.popleft())


def _heard(worker: Worker, watch: Watch) -> bool:
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


@contextmanager
def _workers(count: int, make: Callable[[str], Any]) -> Iterator[list[Worker]]:
    workers: list[Worker] = []
    try:
        for _ in range(count):
            workers.append(_start(make))
        yield workers
        for worker in workers:
            worker.give(())
            worker.process.join(PATIENCE)
    finally:
        for worker in workers:
            worker.pipe.close()
            _end(worker.process)


def _start(make: Callable[[str], Any]) -> Worker:
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=_serve, args=(theirs, make), daemon=True)
    with _one_thread():
        process.start()
    theirs.close()
    return Worker(process, ours)


def _end(process: BaseProcess) -> None:
    process.terminate()
    process.join(PATIENCE)
    if process.is_alive():
        process.kill()


@contextmanager
def _one_thread() -> Iterator[None]:
    """Variables that a new process inherits, unless the user has set them."""
    added = [name for name in THREADS if name not in os.environ]
    os.environ.update(dict.fromkeys(added, "1"))
    try:
        yield
    finally:
        for name in added:
            del os.environ[name]


def _serve(pipe: Connection, make: Callable[[str], Any]) -> None:
    """What a worker does: it waits for groups until it gets an empty one."""
    from ..compiled import announce_compilation

    signal.signal(signal.SIGINT, signal.SIG_IGN)  # the first process answers Ctrl-C and ends this one
    announce_compilation(lambda: pipe.send(("compiling", "", None)))
    with suppress(EOFError, OSError):  # the first process has gone
        while group := pipe.recv():
            for name in group:
                pipe.send(("start", name, None))
                pipe.send(("done", name, make(name)))
