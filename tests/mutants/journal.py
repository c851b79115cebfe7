"""What earlier runs found out: a run that was interrupted goes on where it stopped.

A test that passed and a mutant that was noticed are kept under a digest of what they depend on: the sources
of the package, the helpers and data of the tests, the folders of the tests in question, for a mutant its
change too. When any of it changes, the entry is not found any more. Survivors and errors are never kept.
"""

import hashlib
import json
from collections.abc import Iterable
from functools import cache
from pathlib import Path

from .listing import PACKAGE, ROOT, Mutant

TESTS = ROOT / "tests"


def _digest(paths: Iterable[Path]) -> str:
    """Digest of files, by their place and what is in them."""
    total = hashlib.sha256()
    for path in sorted(p for p in paths if p.is_file()):
        total.update(f"{path.relative_to(ROOT)} {hashlib.sha256(path.read_bytes()).hexdigest()}\n".encode())
    return total.hexdigest()


@cache
def _common() -> str:
    """Digest of what every test may use and of what decides how it is run."""
    runner = [Path(__file__).with_name(name) for name in ("plugin.py", "runner.py")]
    shared = [*TESTS.glob("*.py"), *(TESTS / "data").rglob("*"), *(ROOT / "examples").rglob("*")]
    return _digest([*PACKAGE.rglob("*.py"), *shared, *runner])


@cache
def _folder(name: str) -> str:
    """Digest of a folder of tests; its files may use each other."""
    return _digest((TESTS / name).glob("*.py"))


class Journal:
    """Entries in the file ``path``, a line each; with ``anew`` those of earlier runs are left alone."""

    def __init__(self, path: Path, anew: bool = False) -> None:
        self._path = path
        self._known: dict[str, str] = {}
        if path.exists() and not anew:
            for line in path.read_text(encoding="utf-8").splitlines():
                self._take(line)

    def _take(self, line: str) -> None:
        try:
            key, said = json.loads(line)
        except ValueError:  # the last line of a run that was killed
            return
        self._known[key] = said

    def noticed(self, mutant: Mutant) -> str | None:
        """What pytest said of the first test that failed with this change, None when it is not known."""
        return self._known.get(_of_mutant(mutant))

    def keep_noticed(self, mutant: Mutant, said: str) -> None:
        """Keep that the tests notice this change."""
        self._keep(_of_mutant(mutant), said)

    def passed(self, test: str, how: str) -> bool:
        """Whether this test is known to pass without a change when kernels are run in this way."""
        return _of_test(test, how) in self._known

    def keep_passed(self, tests: Iterable[str], how: str) -> None:
        """Keep that these tests pass without a change."""
        for test in tests:
            self._keep(_of_test(test, how), "")

    def _keep(self, key: str, said: str) -> None:
        self._known[key] = said
        with self._path.open("a", encoding="utf-8") as file:
            file.write(json.dumps([key, said]) + "\n")


def _key(tests: Iterable[str], *more: str) -> str:
    folders = sorted({test.rpartition("/")[0] for test in (t.split("::")[0] for t in tests)})
    return hashlib.sha256("\n".join([_common(), *map(_folder, folders), *tests, *more]).encode()).hexdigest()


def _of_test(test: str, how: str) -> str:
    return _key([test], how)


def _of_mutant(mutant: Mutant) -> str:
    how = "interpreted" if mutant.interprets else "compiled" if mutant.compiles else "kernels kept"
    return _key(mutant.tests, mutant.file, mutant.old, mutant.new, how)
