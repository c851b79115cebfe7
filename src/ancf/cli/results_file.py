"""A results file that a command is given, with one message for whatever is wrong with it."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import ModelError
from ..files import exists, results_at

if TYPE_CHECKING:
    from .. import Result


def open_result(path: Path) -> Result:
    """Result from a file, or from the one in a folder, finished or not.

    Raises
    ------
    ModelError
        There is no such file, it is no results file, or has no states yet.

    """
    import ancf

    path = results_at(path)
    if path.suffix.lower() == ".toml" and exists(path):
        hint = f"ancf run {path} -o out writes out/results.h5"
        raise ModelError(str(path), "is a model file, not a results file", hint)
    with reading(path):
        result = ancf.load(path)
        states = len(result.t)
    if states == 0:
        raise ModelError(str(path), "holds no states yet", f"ancf info {path} says how far the run is")
    return result


@contextmanager
def reading(path: Path) -> Iterator[None]:
    """Turn what goes wrong while a file is read into one message about the file."""
    try:
        yield
    except ModelError:
        raise
    except (OSError, KeyError, ValueError, TypeError, AttributeError, RuntimeError) as error:
        raise ModelError(str(path), f"is not a results file of ancf: {error}") from None
