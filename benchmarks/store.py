"""The stored results: each piece of a run is put in its place as soon as it is there."""

from __future__ import annotations

import json
import subprocess
import time
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from cases import CASES
from machine import load, machine

HERE = Path(__file__).parent
Results = dict[str, Any]
KEYS = "ratio", "equal_accuracy"


def commit() -> str | None:
    """Commit of the sources, with a plus where they were changed since; None where there is no repository."""
    told = [
        subprocess.run(["git", "-C", str(HERE), *command], capture_output=True, text=True, check=False)
        for command in (("rev-parse", "--short", "HEAD"), ("status", "--porcelain", "--", "../src"))
    ]
    return None if told[0].returncode else told[0].stdout.strip() + "+" * bool(told[1].stdout.strip())


@dataclass
class Store:
    """A results file that pieces are put into.

    Parameters
    ----------
    file : Path or None
        Where it is, None: it is kept in memory only.
    results : dict
        All of it: "cases", a row each, and tables by their names; "measured" tells of each piece with which
        commit, when, on what and beside which load it was measured, and how long that took.
    """

    file: Path | None
    results: Results = field(default_factory=dict)
    commit: str | None = field(default_factory=commit)
    new: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        if self.file is not None and self.file.exists():
            self.results = json.loads(self.file.read_text(encoding="utf-8"))
        self.results.setdefault("cases", [])
        self.results.setdefault("measured", {})

    def has(self, piece: str) -> bool:
        """Whether a piece was measured with this commit."""
        found = self.results["measured"].get(piece)
        return found is not None and self.commit is not None and found["commit"] == self.commit

    def seconds(self, piece: str) -> float:
        """How long the piece took when it was measured last, wall time; 0 if that is not known."""
        return float(self.results["measured"].get(piece, {}).get("seconds", 0.0))

    def take(self, piece: str, measured: Any, begun: float, load_before: float | None) -> None:
        """Put a piece in its place and write the file; ``begun`` is of ``time.perf_counter``."""
        told = {"commit": self.commit, **machine(), "load_before": load_before}
        told["seconds"] = round(time.perf_counter() - begun, 1)
        if piece in CASES:
            rows = {row["name"]: row for row in self.results["cases"]} | {piece: measured}
            self.results["cases"] = [rows[name] for name in CASES if name in rows]
            self.results["growth"] = growth(self.results["cases"])
        else:
            self.results[piece] = measured
        self.results["measured"][piece] = told
        self.results["machine"] = told
        self.new.append(piece)
        self.write()

    def write(self) -> None:
        """Write the file, if there is one, and never half of it."""
        if self.file is not None:
            beside = self.file.with_suffix(".part")
            beside.write_text(json.dumps(self.results, indent=1) + "\n", encoding="utf-8")
            beside.replace(self.file)

    def remember(self) -> None:
        """Add a line with the commit and the ratios of what is new to the history beside the file."""
        cases = {row["name"]: brief(row) for row in self.results["cases"] if row["name"] in self.new}
        if self.file is None or self.commit is None or not cases:
            return
        line = {"commit": self.commit, "machine": {**machine(), "load": load()}, "cases": cases}
        with self.file.with_name("history.jsonl").open("a", encoding="utf-8") as history:
            history.write(json.dumps(line) + "\n")


def brief(row: Results) -> Results:
    """Ratios of a case, and our time."""
    return {
        **{key: row.get(key) for key in KEYS},
        "ratio_whole": row["exudyn"].get(row["best"], {}).get("ratio_whole"),
        "us_per_step": row["ancf"]["us_per_step"],
    }


def growth(rows: list[Results]) -> Results:
    """Microseconds per step and element of the swinging cable, and their ratio from 100 to 10000."""
    each = {}
    for row in rows:
        if row["name"].startswith("cable"):
            peer = row["exudyn"].get(row["best"], {}).get("us_per_step")
            each[str(row["elements"])] = {
                "ancf": row["ancf"]["us_per_step"] / row["elements"],
                "exudyn": None if peer is None else peer / row["elements"],
            }
    small, large = each.get("100", {}), each.get("10000", {})
    ratios = {
        side: large[side] / small[side] if small.get(side) and large.get(side) else None
        for side in ("ancf", "exudyn")
    }
    return {"us_per_step_and_element": each, **ratios}
