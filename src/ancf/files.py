"""What all writers of files share: one error for a place that cannot be written, drafts, JSON."""

from __future__ import annotations

import json
import math
import os
import re
import sys
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager, suppress
from fnmatch import fnmatch
from pathlib import Path
from typing import Any

from .errors import ModelError
from .reading import inputs

if sys.platform != "win32":
    import fcntl

#: How HDF5 reports what the system said.
HDF5_PROBLEM = re.compile(r"errno = \d+, error message = '([^']*)'")
#: Results file of an output folder, and so many other names are said where it is missing.
RESULTS, MOST_NAMED = "results.h5", 5
#: First characters of what a spreadsheet takes for a formula.
FORMULAS = ("=", "+", "-", "@", "\t", "\r")
#: Characters that change what a terminal shows: controls, deletes, turns of the direction of writing.
CONTROL = re.compile(r"[\x00-\x08\x0b-\x1f\x7f-\x9f\u200e\u200f\u2028-\u202e\u2066-\u2069]")


def _spare(path: Path) -> None:
    for read in inputs():
        beside(path, read, "output")


def spare_inputs(folder: Path, patterns: Iterable[str]) -> None:
    """Refuse a folder where files of these names are going to be written and one of them was read.

    Raises
    ------
    ModelError
        There is such a file.
    """
    for path in inputs():
        with suppress(OSError):
            if path.parent.samefile(folder) and any(fnmatch(path.name, pattern) for pattern in patterns):
                beside(folder / path.name, path, "output")


@contextmanager
def writing(path: str | Path, folder: Path | None = None) -> Iterator[None]:
    """Make the folder of a file; within this context the system's errors become one about the file.

    Parameters
    ----------
    path : path
        What is written, as it stands in the message.
    folder : Path, optional
        Where it is written; default the folder that holds `path`.

    Raises
    ------
    ModelError
        The folder cannot be made, something cannot be written, or the file is one that the command reads.
    """
    try:
        if "\0" in str(path):
            raise OSError("its name holds a null byte")
        _make(Path(path).parent if folder is None else folder)
        _spare(Path(path))
        yield
    except (FileExistsError, NotADirectoryError):
        what = "cannot be written: a file stands in the way"
        raise ModelError(str(path), what, "choose another place") from None
    except OSError as error:
        what = f"cannot be written: {problem(error) or error}"
        raise ModelError(str(path), what, "choose another place") from None


def writable(folder: Path, name: str = "") -> Path:
    """Make a folder and try it, before anything is computed; `name` stands for it in the message.

    Raises
    ------
    ModelError
        It cannot be made or written.
    """
    with writing(name or folder, folder), tempfile.TemporaryFile(dir=folder):
        return folder


@contextmanager
def locked(folder: Path | None, name: str) -> Iterator[None]:
    """No other run writes to the folder meanwhile; a killed run leaves no lock. None is no folder.

    Raises
    ------
    ModelError
        Another process holds it; `name` stands for the folder in the message.
    """
    with ExitStack() as stack:
        if folder is not None:
            with suppress(OSError):  # a file system without locks
                _lock(folder, name, stack)
        yield


def _lock(folder: Path, name: str, stack: ExitStack) -> None:
    if sys.platform == "win32":
        return
    descriptor = os.open(folder, os.O_RDONLY)
    stack.callback(os.close, descriptor)
    try:
        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise ModelError(name, "another run is writing to it", "choose another with -o") from None


def _make(folder: Path) -> None:
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except ValueError as error:  # a name that no system takes
        raise OSError(str(error)) from None


@contextmanager
def drafted(path: Path) -> Iterator[Path]:
    """Place to write to; it becomes the file when all went well, and is gone otherwise.

    Raises
    ------
    ModelError
        The file is one that the command reads.
    """
    _spare(path)
    draft = path.with_name(path.name + ".part")
    try:
        yield draft
        draft.replace(path)
    except BaseException:
        draft.unlink(missing_ok=True)
        raise


def write_text(path: Path, text: str) -> Path:
    """Write a text file and make its folder.

    Raises
    ------
    ModelError
        It cannot be written.
    """
    with writing(path):
        path.write_text(text, encoding="utf-8", errors="backslashreplace")
    return path


def beside(output: Path, source: Path, option: str = "-o") -> Path:
    """A file to write that is not the one that was read.

    Raises
    ------
    ModelError
        It is.
    """
    with suppress(OSError):
        if output.samefile(source):
            raise ModelError(f"{option} {output}", "is the file that is read", "choose another place or name")
    return output


def cell(value: Any) -> Any:
    """A cell of a CSV file: text that a spreadsheet would compute gets an apostrophe; numbers stay."""
    if not isinstance(value, str) or not value.startswith(FORMULAS) or len(value) == 1:
        return value
    try:
        float(value)
    except ValueError:
        return "'" + value
    return value


def visible(text: str) -> str:
    """Text whose control characters, which a terminal would obey, are spelt out; lines and tabs stay."""
    return text if text.isprintable() else CONTROL.sub(lambda found: ascii(found[0])[1:-1], text)


def results_at(path: Path) -> Path:
    """The results file that a path names wherever results are read: in a folder that of ``ancf run -o``."""
    inside = path / RESULTS
    return inside if exists(path, "is_dir") and exists(inside) else path


def no_results(folder: Path) -> ModelError:
    """A folder that names no results file; the hint has those of other names, or else its model files."""
    results, models = (sorted(file.name for file in folder.glob(end)) for end in ("*.h5", "*.toml"))
    found = ", ".join((results or models)[:MOST_NAMED])
    hint = f"name the file: {found}" if results else f"it has model files: {found}" if models else ""
    return ModelError(str(folder), f"is a folder without {RESULTS}", hint)


def exists(path: Path, kind: str = "exists") -> bool:
    """Whether there is such a file, or with "is_dir" such a folder; a name that no system takes is none."""
    try:
        return bool(getattr(path, kind)())
    except (OSError, ValueError):
        return False


def problem(error: Exception) -> str:
    """What the system says is wrong, such as "No space left on device", also through HDF5; else nothing."""
    found = HDF5_PROBLEM.search(str(error))
    if found:
        return found[1]
    return error.strerror or "" if isinstance(error, OSError) else ""


def to_json(data: Any, indent: int = 1) -> str:
    """JSON that any reader takes: null instead of NaN and infinity."""
    return json.dumps(plain(data), indent=indent, ensure_ascii=False, allow_nan=False) + "\n"


def plain(value: Any) -> Any:
    """The same in types that JSON has; arrays become lists, and what JSON does not know its text."""
    if isinstance(value, dict):
        return {str(key): plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    if hasattr(value, "tolist"):
        return plain(value.tolist())
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    return value if isinstance(value, str | int | bool | None) else str(value)
