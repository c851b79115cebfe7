"""Entry: what became of one exhibit; Reproduction: all of them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from .check import Check

Verdict = Literal["passed", "failed", "error", "no check"]


@dataclass(frozen=True, slots=True)
class Entry:
    """What became of one exhibit, a figure or table.

    Parameters
    ----------
    name, title, example, claim : str
        Of the exhibit: ``fig2``, its title, the example of the paper, what the paper says of it.
    checks : tuple of Check
    notes : tuple of str
        Assumptions, settings and measured numbers.
    files : tuple of Path
        Written: picture, table, JSON.
    seconds, cpu_seconds : float
        Wall and processor time, s.
    error : str
        Why it could not be computed or judged; empty when it was.
    traceback : str
        Where an internal error arose.

    """

    name: str
    title: str = ""
    example: str = ""
    claim: str = ""
    checks: tuple[Check, ...] = ()
    notes: tuple[str, ...] = ()
    files: tuple[Path, ...] = ()
    seconds: float = 0.0
    cpu_seconds: float = 0.0
    error: str = ""
    traceback: str = ""

    @property
    def failed(self) -> tuple[Check, ...]:
        """Checks that did not pass."""
        return tuple(check for check in self.checks if not check.passed)

    @property
    def verdict(self) -> Verdict:
        """In a word."""
        if self.error:
            return "error"
        if not self.checks:
            return "no check"
        return "failed" if self.failed else "passed"

    @property
    def largest_use(self) -> float | None:
        """Largest use of a tolerance, see :func:`use_of_tolerance`; None without checks."""
        return max(map(use_of_tolerance, self.checks), default=None)

    def file(self, kind: str) -> Path | None:
        """The file that ends in ``.png``, ``.csv`` or ``.json``, if it was written."""
        return next((path for path in self.files if path.suffix == f".{kind}"), None)


@dataclass(frozen=True, slots=True)
class Reproduction:
    """All exhibits of one call.

    Parameters
    ----------
    entries : tuple of Entry
        In the order of their names in the call.
    folder : Path
        Where the files are.
    quick : bool
        Whether these are the short forms.
    jobs : int
        Processes that computed them.
    seconds : float
        Wall time of all, s.

    """

    entries: tuple[Entry, ...]
    folder: Path
    quick: bool
    jobs: int
    seconds: float

    @property
    def page(self) -> Path:
        """The page with everything, ``index.html``."""
        return self.folder / "index.html"

    @property
    def summary(self) -> Path:
        """The checks as JSON, ``checks.json``."""
        return self.folder / "checks.json"

    @property
    def checks(self) -> list[Check]:
        """All checks."""
        return [check for entry in self.entries for check in entry.checks]

    @property
    def failed(self) -> list[tuple[Entry, Check]]:
        """Checks that did not pass, with their exhibits."""
        return [(entry, check) for entry in self.entries for check in entry.failed]

    @property
    def errors(self) -> list[Entry]:
        """Exhibits that could not be computed or judged."""
        return [entry for entry in self.entries if entry.error]

    @property
    def passed(self) -> bool:
        """Whether all exhibits were computed and all checks passed."""
        return not self.failed and not self.errors

    @property
    def verdict(self) -> str:
        """In one line: ``117 of 120 checks passed, 1 of 18 exhibits could not be computed``."""
        count = len(self.checks)
        text = f"{count - len(self.failed)} of {count} checks passed"
        if self.errors:
            text += f", {len(self.errors)} of {len(self.entries)} exhibits could not be computed"
        return text


def use_of_tolerance(check: Check) -> float:
    """Share of the tolerance that a check uses: 0 exact, 1 just passed, beyond 1 failed."""
    if not math.isfinite(check.value):
        return math.inf
    if check.rule == "factor":
        return _use_of_factor(check)
    signs = {"within": abs(check.deviation), "at least": -check.deviation, "at most": check.deviation}
    away = max(signs[check.rule], 0.0)
    if check.tolerance > 0:
        return away / check.tolerance
    return 0.0 if away == 0 else math.inf


def _use_of_factor(check: Check) -> float:
    ratio = check.value / check.reference if check.reference else math.nan
    if not ratio > 0:
        return math.inf
    return abs(math.log(ratio)) / math.log(check.tolerance) if check.tolerance > 1 else float(ratio != 1)
