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
from .fingerprints import first_changed, moved, named

VERSION = 1
OK, FAILED = "ok", "failed"
TABLES = """
CREATE TABLE IF NOT EXISTS about (key TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS cases (
    key TEXT PRIMARY KEY, status TEXT NOT NULL, outputs TEXT NOT NULL, message TEXT NOT NULL,
    seconds REAL NOT NULL
) WITHOUT ROWID;
CREATE TABLE IF NOT EXISTS files (path TEXT PRIMARY KEY, hash TEXT NOT NULL) WITHOUT ROWID;
"""
#: Keys of what makes a study in the order in which it is told what differs; the others come behind.
ORDER = ("version", "function", "outputs", "parameters", "run", "modules", "values")
#: What journals of earlier versions do not have: it is taken as it is now.
LATER = ("modules", "values")
#: How a difference is said of what is known by its hash alone.
SAID = {
    "source": "the source of its function has changed",
    "arguments": "its function had other arguments",
    "model": "its model or line file, or a table that it names, has changed",
    "line": "its line has changed",
    "hash": "its line, its pantographs or the settings of its runs have changed",
}
ANOTHER = "choose another folder, or empty this one"


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
    files : dict of str to str
        Fingerprints of the files that it read, by their paths; known only where it was computed.
    """

    status: str
    outputs: dict[str, float] = field(default_factory=dict)
    message: str = ""
    seconds: float = 0.0
    wrong_kind: bool = False
    files: dict[str, str] = field(default_factory=dict)

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
    files : mapping
        Fingerprints of the files that make it, by their paths.

    Raises
    ------
    ModelError
        The file belongs to another study or is none, or a file that its cases have read has changed.
    """

    def __init__(
        self,
        path: Path | None,
        identity: Mapping[str, Any],
        where: str,
        files: Mapping[str, str] | None = None,
    ) -> None:
        self.where, self._folder = where, None if path is None else path.parent
        with self._storing(reading=True):
            self._base = sqlite3.connect(":memory:" if path is None else path, timeout=60.0)
            self._base.execute("PRAGMA journal_mode=WAL")
            self._base.execute("PRAGMA synchronous=NORMAL")
            self._base.executescript(TABLES)
            self._check(identity, files or {})

    def _check(self, identity: Mapping[str, Any], files: Mapping[str, str]) -> None:
        text = {"version": json.dumps(VERSION)} | {
            key: json.dumps(value, sort_keys=True) for key, value in identity.items()
        }
        known = dict(self._base.execute("SELECT key, value FROM about WHERE key NOT LIKE 'plan%'"))
        keys = {*known, *text} - {key for key in LATER if key not in known}
        differ = sorted((key for key in keys if known.get(key) != text.get(key)), key=_place) if known else ()
        if differ and _place(differ[0])[0] < ORDER.index("modules"):
            self._refuse(differ[0], known, text)
        self._check_files()
        for key in differ:
            self._refuse(key, known, text)
        with self._base:
            rows = text.items()
            self._base.executemany("INSERT OR IGNORE INTO about VALUES (?, ?)", rows)
            self._keep(files)

    def _refuse(self, key: str, known: Mapping[str, str], text: Mapping[str, str]) -> None:
        before, now = known.get(key), text.get(key)
        said = SAID.get(key, f"its {key} is {_short(before)}, not {_short(now)}")
        if key in LATER:
            said = _said(key, json.loads(before or "{}"), json.loads(now or "{}"))
        raise ModelError(self.where, f"holds another study: {said}", ANOTHER)

    def _check_files(self) -> None:
        """Raise ModelError if a file that was read has changed; one that is gone its reader will miss."""
        if self._folder is None:
            return
        if changed := first_changed(self.files(), self._folder):
            what = f'holds a study of another "{named(changed)}": the file has changed since'
            raise ModelError(self.where, what, ANOTHER)

    def _keep(self, files: Mapping[str, str]) -> None:
        """Keep fingerprints of files.

        Raises
        ------
        ModelError
            A file has changed while the study ran.
        """
        if self._folder is None:
            return
        for path, now in files.items():
            row = (moved(path, self._folder), now)
            self._base.execute("INSERT OR IGNORE INTO files VALUES (?, ?)", row)
            (before,) = self._base.execute("SELECT hash FROM files WHERE path = ?", row[:1]).fetchone()
            if before != now:
                what = f'is of another "{named(path)}": the file has changed while the study ran'
                raise ModelError(self.where, what, ANOTHER)

    def plan(self, cases: int) -> None:
        """Keep how many cases are wanted."""
        with self._storing(), self._base:
            self._base.execute("INSERT OR REPLACE INTO about VALUES ('plan', ?)", (json.dumps(cases),))

    def outcomes(self) -> dict[str, Outcome]:
        """All that has ended, by key."""
        with self._storing(reading=True):
            rows = self._base.execute("SELECT key, status, outputs, message, seconds FROM cases").fetchall()
        return {key: Outcome(status, json.loads(out), *rest) for key, status, out, *rest in rows}

    def files(self) -> dict[str, str]:
        """Fingerprints of the files that the study or a case has read, by paths from its folder."""
        with self._storing(reading=True):
            return dict(self._base.execute("SELECT path, hash FROM files ORDER BY path"))

    def add(self, ended: Iterable[tuple[str, Outcome]]) -> None:
        """Write cases that have ended, and what they have read; one that is there stays."""
        ended = list(ended)
        rows = [(k, o.status, json.dumps(o.outputs), o.message, o.seconds) for k, o in ended]
        with self._storing(), self._base:
            for _, one in ended:
                self._keep(one.files)
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


def _place(key: str) -> tuple[int, str]:
    return (ORDER.index(key) if key in ORDER else len(ORDER), key)


def _said(key: str, before: Mapping[str, str], now: Mapping[str, str]) -> str:
    """What differs of the modules and values that a function rests on."""
    name = next(name for name in (*before, *now) if before.get(name) != now.get(name))
    if key == "values":
        return f"its {name} is {before.get(name, 'missing')}, not {now.get(name, 'missing')}"
    if name not in before or name not in now:
        return f'its function names the module "{name}" {"no more" if name in before else "as well"}'
    return f'the module "{name}", on which its function rests, has changed since'


def _short(text: str | None) -> str:
    return "missing" if text is None else checks.shown(json.loads(text))
