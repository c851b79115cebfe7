"""The folder that a command writes to: found unusable before anything is computed."""

from __future__ import annotations

import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..errors import ModelError
from ..files import drafted, locked, spare_inputs, to_json, writable


class OutputFolder:
    """Makes the folder and tries it.

    Parameters
    ----------
    path : Path
    files : iterable of str
        Names of what is going to be written there, patterns as ``force_*.csv``.

    Raises
    ------
    ModelError
        It cannot be made or written; one of the files was read by the command.

    """

    def __init__(self, path: Path, files: Iterable[str] = ()) -> None:
        self.path = writable(path, f"output folder {path}")
        spare_inputs(path, files)

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

    @property
    def verification(self) -> Path:
        """Where the verification goes."""
        return self.path / "verify.json"

    @property
    def again(self) -> Path:
        """Where a computation for the verification goes while it is needed."""
        return self.path / "verify.h5"

    @contextmanager
    def locked(self) -> Iterator[None]:
        """No other run writes to the folder meanwhile; a killed run leaves no lock."""
        with locked(self.path, f"output folder {self.path}"):
            yield

    def clear(self) -> None:
        """Take away summary and table of an earlier run, and check that all files can be written."""
        files = (self.results, self.summary, self.sensors, self.verification, self.again)
        spare_inputs(self.path, [path.name for path in files])
        for path in files:
            if path.is_dir() or (path.exists() and not os.access(path, os.W_OK)):
                raise ModelError(str(path), "cannot be written: it is a folder or write-protected")
        for path in (self.summary, self.sensors, self.verification, self.again):
            path.unlink(missing_ok=True)

    def write_summary(self, summary: dict[str, Any]) -> None:
        """Write the summary; the file is complete or absent."""
        _write(self.summary, summary)

    def write_verification(self, found: dict[str, Any]) -> None:
        """Write the verification; the file is complete or absent."""
        _write(self.verification, found)


def _write(path: Path, data: dict[str, Any]) -> None:
    with drafted(path) as draft:
        draft.write_text(to_json(data, indent=2), encoding="utf-8", errors="backslashreplace")
