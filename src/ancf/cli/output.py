"""The folder that a command writes to: found unusable before anything is computed."""

from __future__ import annotations

import json
import math
import os
import re
import sys
import tempfile
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import Any

from ancf.errors import ModelError, SolveError

if sys.platform != "win32":
    import fcntl


class StorageError(SolveError):
    """The results file can no longer be written: the disk is full, or gone."""


class OutputFolder:
    """Makes the folder and tries it.

    Parameters
    ----------
    path : Path

    Raises
    ------
    ModelError
        It cannot be made or written.

    """

    def __init__(self, path: Path) -> None:
        self.path = path
        try:
            path.mkdir(parents=True, exist_ok=True)
            with tempfile.TemporaryFile(dir=path):
                pass
        except (OSError, ValueError) as error:
            reason = getattr(error, "strerror", None) or error
            raise ModelError(
                f"output folder {path}", f"cannot be written: {reason}", "choose another with -o"
            ) from None

    @property
    def results(self) -> Path:
        """Where the results go."""
        return self.path / "results.h5"

    @property
    def summary(self) -> Path:
        """Where the summary goes."""
        return self.path / "summary.json"

    @property
    def sensors(self) -> Path:
        """Where the table of the sensors goes."""
        return self.path / "sensors.csv"

    @contextmanager
    def locked(self) -> Iterator[None]:
        """No other run writes to the folder meanwhile; a killed run leaves no lock."""
        with ExitStack() as stack:
            with suppress(OSError):  # a file system without locks
                self._lock(stack)
            yield

    def _lock(self, stack: ExitStack) -> None:
        if sys.platform == "win32":
            return
        descriptor = os.open(self.path, os.O_RDONLY)
        stack.callback(os.close, descriptor)
        try:
            fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            what = "another run is writing to it"
            raise ModelError(f"output folder {self.path}", what, "choose another with -o") from None

    def clear(self) -> None:
        """Take away summary and table of an earlier run, and check that all files can be written."""
        for path in (self.results, self.summary, self.sensors):
            if path.is_dir() or (path.exists() and not os.access(path, os.W_OK)):
                raise ModelError(str(path), "cannot be written: it is a folder or write-protected")
        self.summary.unlink(missing_ok=True)
        self.sensors.unlink(missing_ok=True)

    def write_summary(self, summary: dict[str, Any]) -> None:
        """Write the summary; the file is complete or absent."""
        text = json.dumps(finite(summary), indent=2, ensure_ascii=False, allow_nan=False) + "\n"
        draft = self.summary.with_suffix(".json.part")
        draft.write_text(text, encoding="utf-8", errors="backslashreplace")
        draft.replace(self.summary)


def storage_problem(error: Exception) -> str:
    """What the system says when HDF5 cannot write, such as "No space left on device"; else nothing."""
    found = re.search(r"errno = \d+, error message = '([^']*)'", str(error))
    if found:
        return found[1]
    return error.strerror or "" if isinstance(error, OSError) else ""


def finite(value: Any) -> Any:
    """The same with null instead of NaN and infinity, which JSON does not know."""
    if isinstance(value, dict):
        return {str(key): finite(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [finite(item) for item in value]
    if hasattr(value, "tolist"):
        return finite(value.tolist())
    return None if isinstance(value, float) and not math.isfinite(value) else value
