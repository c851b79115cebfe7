"""Measure ancf and Exudyn in turn, print tables and store ``results.json``.

``python benchmarks/run.py [--quick] [--only NAME] [-o FILE]``; see README.md in this folder.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

from rich.console import Console

from cases import CASES, Case, Overhead
from machine import load, machine
from measure import ONE_THREAD, RefusedError, Worker, compare, contacts, memory, workers
from report import show
from startup import startup

HERE = Path(__file__).parent
SECONDS, QUICK_SECONDS = 0.1, 0.03  # CPU time of one measurement of a short case
SIDES = {
    "ancf": ("ours", {"EXUDYN_MODULE": ""}),
    "standard": ("peer_exudyn", {"EXUDYN_MODULE": ""}),
    "fast": ("peer_exudyn", {"EXUDYN_MODULE": "fast"}),
}


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    add = parser.add_argument
    add("--quick", action="store_true", help="the short cases alone, in less than a minute")
    add(
        "--only",
        action="append",
        choices=list(CASES),
        metavar="NAME",
        help="this case alone; may be repeated",
    )
    add("--pairs", type=int, default=3, help="least pairs of measurements for each variant (default: 3)")
    add(
        "-o",
        "--output",
        type=Path,
        default=HERE / "results.json",
        help="default: results.json in this folder",
    )
    return parser.parse_args()


def chosen(options: argparse.Namespace) -> list[Case]:
    return [
        case
        for case in CASES.values()
        if (case.name in options.only if options.only else case.quick or not options.quick)
    ]


def measure(cases: list[Case], pairs: int, seconds: float, console: Console) -> list[dict[str, Any]]:
    """Rows of all cases."""
    rows = []
    with workers(**SIDES) as ready:
        if "ancf" not in ready:
            raise SystemExit("ancf cannot be imported: pip install -e '.[bench]'")
        own, peers = ready.pop("ancf"), ready
        if not peers:
            console.print("Exudyn is not installed (pip install -e '.[bench]'): our side alone", markup=False)
        for case in cases:
            console.print(f"[dim]{case.title}, {case.elements} elements[/]")
            rows.append(checked(own, peers, case, pairs, seconds))
            if isinstance(case, Overhead):
                rows[-1]["contacts"] = contacts(own, case)
    return rows


def checked(own: Worker, peers: dict[str, Worker], case: Case, pairs: int, seconds: float) -> dict[str, Any]:
    try:
        return compare(own, peers, case, pairs if case.long or seconds < SECONDS else 2 * pairs + 1, seconds)
    except RefusedError as failure:
        raise SystemExit(f"{case.name}: {failure}") from None


def memories(cases: list[Case]) -> list[dict[str, Any]]:
    """Memory of both sides for the swinging cable."""
    rows = []
    for case in cases:
        if not case.name.startswith("cable"):
            continue
        row: dict[str, Any] = {"name": case.name, "title": case.title, "elements": case.elements}
        for side, module in (("ancf", "ours"), ("exudyn", "peer_exudyn")):
            try:
                row[side] = memory(case, module)
            except RefusedError:
                row[side] = None
        rows.append(row)
    return rows


def growth(rows: list[dict[str, Any]]) -> dict[str, Any]:
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


def replaced(stored: dict[str, Any], new: dict[str, Any]) -> dict[str, Any]:
    """A stored run with the cases of a new one, which keep the machine that measured them."""
    fresh = {row["name"]: {**row, "measured": new["machine"]} for row in new["cases"]}
    cases = [fresh.get(row["name"], row) for row in stored["cases"]]
    return {**stored, "cases": cases, "growth": growth(cases)}


def our_elements(quick: bool) -> dict[str, Any]:
    """Costs and kernels of our kinds of elements; imported late, when one thread is set."""
    from elements import all_kernels, costs

    return {"elements": costs(3) if quick else costs(), "kernels": [] if quick else all_kernels()}


def remember(results: dict[str, Any], file: Path) -> None:
    """Add a line with the commit and all ratios to the history; where there is no repository, none."""
    git = subprocess.run(
        ["git", "-C", str(HERE), "rev-parse", "--short", "HEAD"], capture_output=True, text=True, check=False
    )
    if git.returncode:
        return
    keys = "ratio", "equal_accuracy"
    cases = {
        row["name"]: {
            **{key: row.get(key) for key in keys},
            "ratio_whole": row["exudyn"].get(row["best"], {}).get("ratio_whole"),
            "us_per_step": row["ancf"]["us_per_step"],
        }
        for row in results["cases"]
    }
    line = {"commit": git.stdout.strip(), "machine": results["machine"], "cases": cases}
    with file.open("a", encoding="utf-8") as history:
        history.write(json.dumps(line) + "\n")


def main() -> None:
    options = arguments()
    console = Console(width=None if sys.stdout.isatty() else 100)
    os.environ.update(ONE_THREAD)
    begin = time.perf_counter()
    before = load()
    cases = chosen(options)
    rows = measure(cases, options.pairs, QUICK_SECONDS if options.quick else SECONDS, console)
    results: dict[str, Any] = {
        "machine": {**machine(), "load_before": before},
        "quick": options.quick,
        "pairs": options.pairs,
        "cases": rows,
        "growth": growth(rows),
    }
    console.print("[dim]memory, elements, start[/]")
    results["memory"] = memories(cases)
    results |= {} if options.only else our_elements(options.quick)
    results["startup_s"] = {} if options.only else startup(2 if options.quick else 3, not options.quick)
    results["seconds"] = time.perf_counter() - begin
    if options.only and options.output.exists():
        results = replaced(json.loads(options.output.read_text(encoding="utf-8")), results)
    options.output.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    if not (options.quick or options.only):
        remember(results, options.output.with_name("history.jsonl"))
    show(results, console)
    console.print(f"[dim]{results['seconds']:.0f} s, stored in {options.output.name}[/]")


if __name__ == "__main__":
    main()
