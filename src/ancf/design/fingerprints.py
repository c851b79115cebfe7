"""Fingerprints of the files that cases read: by them a study is told from one of files that have changed."""

from __future__ import annotations

import hashlib
import json
import os
import tomllib
from collections.abc import Iterable, Mapping
from functools import lru_cache
from pathlib import Path

#: What comes with the package changes with its version alone.
PACKAGE = Path(__file__).resolve().parents[1]
#: Digits of a fingerprint.
DIGITS = 32


def fingerprints(paths: Iterable[Path]) -> dict[str, str]:
    """Fingerprints of files by their whole paths, of those that can be read and are none of the package."""
    found = {}
    for path in dict.fromkeys(Path(os.path.abspath(path)) for path in paths):
        if not path.is_relative_to(PACKAGE) and (made := fingerprint(path)):
            found[str(path)] = made
    return found


def fingerprint(path: Path) -> str:
    """Of what a file says, in TOML without comments and order; empty of one that cannot be read."""
    try:
        about = path.stat()
        return _fingerprint(path, about.st_mtime_ns, about.st_size, about.st_ino)
    except (OSError, ValueError):
        return ""


@lru_cache(maxsize=1000)
def _fingerprint(path: Path, *stat: int) -> str:
    """Each case asks: a file that was not touched is not read again."""
    content = path.read_bytes()
    if path.suffix == ".toml":
        try:
            tables = tomllib.loads(content.decode("utf-8-sig"))
            content = json.dumps(tables, sort_keys=True, default=str).encode()
        except ValueError:
            pass
    return hashlib.sha256(content).hexdigest()[:DIGITS]


def moved(path: str, folder: Path) -> str:
    """A path as seen from a folder, so that both can be moved together."""
    try:
        return Path(os.path.relpath(path, folder)).as_posix()
    except ValueError:  # another drive
        return path


def first_changed(known: Mapping[str, str], folder: Path) -> str:
    """The first file of those known, by their paths from a folder, that says something else now, or ""."""
    for path, before in known.items():
        now = fingerprint(Path(os.path.abspath(folder / path)))
        if now and now != before:
            return str(Path(os.path.abspath(folder / path)))
    return ""


def named(path: str) -> str:
    """A path for messages: from where the command runs, if that is shorter."""
    try:
        return min(path, os.path.relpath(path), key=len)
    except ValueError:
        return path
