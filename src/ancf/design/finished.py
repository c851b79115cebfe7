"""A study that is finished already: told by its files alone, without what computes it."""

from __future__ import annotations

import hashlib
import json
import tomllib
from pathlib import Path
from typing import Any

from .._version import __version__
from .fingerprints import first_changed

#: What a study leaves; study.json is written when the others are there.
FILES = ("table.csv", "table.parquet", "study.json", "report.html")


def finished(folder: Path, files: dict[str, str], report: bool) -> dict[str, Any] | None:
    """What study.json says, if it was made of these files by this version; else None.

    Nor may a file have changed that its cases have read.
    """
    try:
        found: dict[str, Any] = json.loads((folder / "study.json").read_text(encoding="utf-8"))
        same = found["files"] == files and found["versions"]["ancf"] == __version__
        same = same and not first_changed(found["read"], folder)
    except (OSError, ValueError, LookupError, TypeError, AttributeError):
        return None
    there = all((folder / name).is_file() for name in FILES if report or name != "report.html")
    return found if same and there else None


def hashes(path: Path) -> dict[str, str]:
    """Hashes of a study file and of the files that it names, by their names; of those that can be read."""
    found = {path.name: _hash(path)}
    try:
        data = tomllib.loads(path.read_text(encoding="utf-8-sig"))
        sampling = data.get("sampling")
        named = [
            data.get("model"),
            data.get("line"),
            sampling.get("file") if isinstance(sampling, dict) else None,
        ]
    except (OSError, ValueError, AttributeError):
        named = []
    for name in named:
        if isinstance(name, str):
            found[name] = _hash(path.parent / name)
    return found


def _hash(path: Path) -> str:
    try:
        return hashlib.sha256(path.read_bytes()).hexdigest()
    except (OSError, ValueError):
        return ""
