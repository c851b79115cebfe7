"""``checks.json``: all checks of a reproduction, for programs."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..._version import __version__
from ...files import to_json, write_text
from .machine import commit, machine, now

if TYPE_CHECKING:
    from ..entry import Entry, Reproduction


def write_summary(made: Reproduction) -> Path:
    """Write ``checks.json``; numbers that are none become null."""
    return write_text(made.summary, to_json(summary(made)))


def summary(made: Reproduction) -> dict[str, Any]:
    """What ``checks.json`` holds."""
    checks = [{**c.plain(), "figure": entry.name} for entry in made.entries for c in entry.checks]
    return {
        "version": __version__,
        "commit": commit(),
        "date": now(),
        "quick": made.quick,
        "passed": made.passed,
        "jobs": made.jobs,
        "seconds": round(made.seconds, 3),
        "machine": machine(),
        "checks": checks,
        "exhibits": [{**_exhibit(entry), "commit": commit()} for entry in made.entries],
    }


def _exhibit(entry: Entry) -> dict[str, Any]:
    found: dict[str, Any] = {
        "name": entry.name,
        "title": entry.title,
        "example": entry.example,
        "seconds": round(entry.seconds, 3),
        "cpu_seconds": round(entry.cpu_seconds, 3),
        "checks": len(entry.checks),
        "failed": len(entry.failed),
        "error": entry.error or None,
    }
    return found | ({"traceback": entry.traceback} if entry.traceback else {})
