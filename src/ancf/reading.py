"""What a command reads: what writes files asks for it, and writes over none of it; studies know it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path

#: What the command in hand has read so far; None where none runs, and nothing is kept.
_READ: ContextVar[list[Path] | None] = ContextVar("read", default=None)


@contextmanager
def inputs_spared() -> Iterator[None]:
    """Within this context no file is written over that was read in it, see :func:`as_input`."""
    before = _READ.set([])
    try:
        yield
    finally:
        _READ.reset(before)


@contextmanager
def inputs_told() -> Iterator[list[Path]]:
    """The files that are read within this context, as they come; they stay inputs of what is around it."""
    around, found = _READ.get(), list[Path]()
    before = _READ.set(found)
    try:
        yield found
    finally:
        _READ.reset(before)
        if around is not None:
            around.extend(found)


def as_input(path: Path) -> Path:
    """A file that is going to be read, and stays as it is while the command runs."""
    read = _READ.get()
    if read is not None:
        read.append(path)
    return path


def inputs() -> tuple[Path, ...]:
    """The files that were read so far."""
    return tuple(_READ.get() or ())
