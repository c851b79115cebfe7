"""A worker process with a pipe: what it has to do, how it starts with one thread, how it ends."""

from __future__ import annotations

import multiprocessing
import os
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass, field
from multiprocessing.connection import Connection
from typing import TYPE_CHECKING, Any, Generic, TypeVar

if TYPE_CHECKING:
    from multiprocessing.process import BaseProcess

T = TypeVar("T")
#: One thread each: the processes share the cores.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
PATIENCE = 2.0  # s that a process gets to end


@dataclass
class Worker(Generic[T]):
    """A process, this end of its pipe, and what it has still to do."""

    process: BaseProcess
    pipe: Connection
    left: deque[T] = field(default_factory=deque)

    def give(self, work: Iterable[T]) -> None:
        """Hand over work; none ends the process."""
        self.left = deque(work)
        with suppress(OSError):  # it died: the other end of the pipe tells
            self.pipe.send(list(self.left))


def start(serve: Callable[..., None], given: Any) -> Worker[Any]:
    """Start a process that calls ``serve(pipe, given)``."""
    context = multiprocessing.get_context("spawn")
    ours, theirs = context.Pipe()
    process = context.Process(target=serve, args=(theirs, given), daemon=True)
    with one_thread():
        process.start()
    theirs.close()
    return Worker(process, ours)


@contextmanager
def crew(count: int, start_one: Callable[[], Worker[T]]) -> Iterator[list[Worker[T]]]:
    """Workers, which end with this context whatever happens."""
    workers: list[Worker[T]] = []
    try:
        for _ in range(count):
            workers.append(start_one())
        yield workers
        for worker in workers:
            worker.give(())
        for worker in workers:
            worker.process.join(PATIENCE)
    finally:
        for worker in workers:
            worker.pipe.close()
            end(worker.process)


def end(process: BaseProcess) -> None:
    """End a process, by force if it does not."""
    process.terminate()
    process.join(PATIENCE)
    if process.is_alive():
        process.kill()
        process.join(PATIENCE)


@contextmanager
def one_thread() -> Iterator[None]:
    """Variables that a new process inherits, unless the user has set them."""
    added = [name for name in THREADS if name not in os.environ]
    os.environ.update(dict.fromkeys(added, "1"))
    try:
        yield
    finally:
        for name in added:
            del os.environ[name]
