"""The journal of a study: one row of a database for each case, written when it ends.

SQLite in WAL mode keeps what was committed when the process is killed at any moment; a case is known by its
values, so that more samples, another order or another number of workers repeat none.
"""

from __future__ import annotations

import hashlib
import json
import sqlite3
from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..errors import ModelError, StorageError
from ..model import checks

VERSION = 1
OK, FAILED = "ok", "failed"
TABLES = """
CREATE TABLE IF NOT EXISTS about (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS cases (
    key TEXT PRIMARY KEY, status TEXT NOT NULL, outputs TEXT NOT NULL, message TEXT NOT NULL,
    seconds REAL NOT NULL
) WITHOUT ROWID;
"""


@dataclass(frozen=True)
class Outcome:
    """What came out of one case.

    Parameters
    ----------
    status : "ok" or "failed"
    outputs : dict of str to float
    message : str
        Why it failed, or what to know of it.
    seconds : float
        It took, s.
    wrong_kind : bool
        Whether its outputs are no numbers at all; known only where it was computed.
    """

    status: str
    outputs: dict[str, float] = field(default_factory=dict)
    message: str = ""
    seconds: float = 0.0
    wrong_kind: bool = False

    @property
    def failed(self) -> bool:
        """Whether it has no outputs."""
        return self.status == FAILED


def case_key(values: Mapping[str, Any]) -> str:
    """By what a case is known: its values to the last bit, in any order."""
    plain = {name: v if isinstance(v, str) else _bits(v) for name, v in values.items()}
    text = json.dumps(plain, sort_keys=True, ensure_ascii=False)
    return hashlib.sha256(text.encode("utf-8")).hexdigest()[:32]


def _bits(value: float) -> str:
    """A number to its last bit; 2 and 2.0 are the same, whole ones beyond 2**53 have more digits."""
    number = float(value)
    return number.hex() if number == value else str(value)


class Journal:
    """The finished cases of a study, in a file or in memory.

    Parameters
    ----------
    path : Path or None
        None: in memory.
    identity : mapping
        What makes the study: two with other values must not share a journal.
    where : str
        The folder, for messages.

    Raises
    ------
    ModelError
        The file belongs to another study, or is none.
    """

    def __init__(self, path: Path | None, identity: Mapping[str, Any], where: str) -> None:
        self.where = where
        with self._storing(reading=True):
            self._base = sqlite3.connect(":memory:" if path is None else path, timeout=60.0)
            self._base.execute("PRAGMA journal_mode=WAL")
            self._base.execute("PRAGMA synchronous=NORMAL")
            self._base.executescript(TABLES)
            self._check(identity)

    def _check(self, identity: Mapping[str, Any]) -> None:
        text = {"version": json.dumps(VERSION)} | {
            key: json.dumps(value, sort_keys=True) for key, value in identity.items()
        }
        known = dict(self._base.execute("SELECT key, value FROM about WHERE key NOT LIKE 'plan%'"))
        for key in sorted({*known, *text}) if known else ():
            if known.get(key) != text.get(key):
                what = (
                    f"holds another study: its {key} is {_short(known.get(key))}, not {_short(text.get(key))}"
                )
                raise ModelError(self.where, what, "choose another folder, or empty this one")
        with self._base:
            rows = text.items()
            self._base.executemany("INSERT OR IGNORE INTO about VALUES (?, ?)", rows)

    def plan(self, cases: int) -> None:
        """Keep how many cases are wanted."""
        with self._storing(), self._base:
            self._base.execute("INSERT OR REPLACE INTO about VALUES ('plan', ?)", (json.dumps(cases),))

    def outcomes(self) -> dict[str, Outcome]:
        """All that has ended, by key."""
        with self._storing(reading=True):
            rows = self._base.execute("SELECT key, status, outputs, message, seconds FROM cases").fetchall()
        return {key: Outcome(status, json.loads(out), *rest) for key, status, out, *rest in rows}

    def add(self, ended: Iterable[tuple[str, Outcome]]) -> None:
        """Write cases that have ended; one that is there stays."""
        rows = [(k, o.status, json.dumps(o.outputs), o.message, o.seconds) for k, o in ended]
        with self._storing(), self._base:
            self._base.executemany("INSERT OR IGNORE INTO cases VALUES (?, ?, ?, ?, ?)", rows)

    def forget_failed(self) -> None:
        """Take out what failed, to be tried again."""
        with self._storing(), self._base:
            self._base.execute("DELETE FROM cases WHERE status = ?", (FAILED,))

    def close(self) -> None:
        """Close the file; what was written ahead goes into it."""
        self._base.close()

    @contextmanager
    def _storing(self, reading: bool = False) -> Iterator[None]:
        try:
            yield
        except ModelError:
            raise
        except (sqlite3.Error, ValueError) as error:
            if reading:
                raise ModelError(self.where, f"journal.sqlite cannot be read: {error}") from None
            what = f"cannot be written any more: {error}"
            raise StorageError(self.where, what, "make room; the same command goes on") from None


@dataclass(frozen=True)
class Progress:
    """How far a study is, from its journal.

    Parameters
    ----------
    wanted, done, failed : int
    seconds : float
        All cases took together, s.
    """

    wanted: int
    done: int
    failed: int
    seconds: float


def progress_of(folder: Path) -> Progress:
    """How far the study in a folder is; nothing is written, another process may be at work.

    Raises
    ------
    ModelError
        There is no study.
    """
    path = folder / "journal.sqlite"
    if not path.is_file():
        raise ModelError(str(folder), "holds no study: there is no journal.sqlite")
    try:
        base = sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro", uri=True, timeout=60.0)
        plan = base.execute("SELECT value FROM about WHERE key = 'plan'").fetchone()
        query = "SELECT count(*), sum(status = 'failed'), total(seconds) FROM cases"
        done, failed, seconds = base.execute(query).fetchone()
        base.close()
    except sqlite3.Error as error:
        raise ModelError(str(path), f"cannot be read: {error}") from None
    return Progress(json.loads(plan[0]) if plan else done, done, failed or 0, seconds)


def _short(text: str | None) -> str:
    return "missing" if text is None else checks.shown(json.loads(text))
