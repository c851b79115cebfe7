"""Write docs/speed.md: the stored benchmarks of each commit that measured them.

Run from the repository root, in a clone with its history: python docs/benchmark_history.py
"""

from __future__ import annotations

import json
import subprocess
from pathlib import Path
from typing import Any

FILE = "benchmarks/results.json"
PAGE = Path(__file__).parent / "speed.md"
#: Columns: rows of the stored results.
CASES = {
    "cantilever-4": "7.1, 4",
    "cantilever-32": "7.1, 32",
    "pendulum-32": "7.2, 32",
    "sliding-64+4": "7.4, 64+4",
    "cable-100": "swinging cable, 100",
    "cable-1000": "swinging cable, 1000",
    "overhead-32": "7.5, 224+112",
}
HEAD = """# Speed from commit to commit

What `python benchmarks/run.py` stored: µs of processor time for each step of ours, and in brackets
how many times as long the other program took, with the fastest of its settings that were tried and
accurate. Which cases and settings there are has grown; the machines had other work to do on some
days, so that a row is no promise, and ratios within a row say more than times from row to row. How
each number is measured is told in [](howto/benchmarks.md).

`python docs/benchmark_history.py` writes this page from the history of the repository.
"""


def git(*command: str) -> str:
    """What git prints."""
    return subprocess.run(["git", *command], capture_output=True, text=True, check=True).stdout


def row(commit: str, date: str) -> str:
    """One line of the table."""
    results: dict[str, Any] = json.loads(git("show", f"{commit}:{FILE}"))
    found = {case["name"]: case for case in results["cases"]}
    cells = [date, f"`{commit}`"]
    for name in CASES:
        case = found.get(name)
        if case is None or "ancf" not in case:
            cells.append("")
            continue
        ratio = f" ({case['ratio']:.3g})" if case.get("ratio") else ""
        cells.append(f"{case['ancf']['us_per_step']:.3g}{ratio}")
    return f"| {' | '.join(cells)} |"


def page() -> str:
    """The whole page, the newest measurements first."""
    commits = [line.split() for line in git("log", "--format=%h %as", "--", FILE).splitlines()]
    lines = [f"| date | commit | {' | '.join(CASES.values())} |", "|" + "---|" * (len(CASES) + 2)]
    return "\n".join([HEAD, *lines, *(row(commit, date) for commit, date in commits)]) + "\n"


if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
