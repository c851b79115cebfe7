"""Measure ancf and Exudyn in turn, print tables and store ``results.json``.

``python benchmarks/run.py [--quick] [--cases NAME ...] [--missing] [--minutes M]``; see README.md in this
folder. Every piece, a case or one of the other tables, is stored as soon as it was measured.
"""

from __future__ import annotations

import argparse
import os
import sys
import time
from collections.abc import Callable, Iterable
from functools import partial
from pathlib import Path
from typing import Any

from rich.console import Console

from cases import CASES, Case, Overhead
from machine import load
from measure import ONE_THREAD, RefusedError, Worker, compare, contacts, memory, workers
from report import show
from startup import startup
from store import Store

HERE = Path(__file__).parent
SECONDS, QUICK_SECONDS = 0.1, 0.03  # CPU time of one measurement of a short case
WIDTH = 160  # columns of what is no terminal; a narrower terminal breaks lines itself
TABLES = "memory", "elements", "kernels", "startup_s"
SIDES = {
    "ancf": ("ours", {"EXUDYN_MODULE": ""}),
    "standard": ("peer_exudyn", {"EXUDYN_MODULE": ""}),
    "fast": ("peer_exudyn", {"EXUDYN_MODULE": "fast"}),
}
Piece = Callable[[], Any]
PAGES = "python docs/readme_figures.py", "python docs/verification_book.py"


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    add = parser.add_argument
    add("--quick", action="store_true", help="the short cases alone, in some minutes; stored with -o only")
    add("--list", action="store_true", help="print names of all pieces and what they took, measure nothing")
    add("--show", action="store_true", help="print the tables of what is stored, measure nothing")
    add("--cases", nargs="+", choices=[*CASES, *TABLES], metavar="NAME", help="these pieces alone")
    add("--missing", action="store_true", help="leave out what is stored for this commit")
    add("--minutes", type=float, help="begin no piece that would last longer, as far as is known")
    add("--pairs", type=int, default=3, help="least pairs of measurements for each variant (default: 3)")
    add("-o", "--output", type=Path, help="default: results.json in this folder")
    return parser.parse_args()


def chosen(options: argparse.Namespace, store: Store) -> list[str]:
    """Names of the pieces to measure."""
    if options.cases:
        names = [name for name in (*CASES, *TABLES) if name in options.cases]
    elif options.quick:
        names = [name for name, case in CASES.items() if case.quick] + ["elements", "startup_s"]
    else:
        names = [*CASES, *TABLES]
    return [name for name in names if not (options.missing and store.has(name))]


def measure(own: Worker, peers: dict[str, Worker], case: Case, options: argparse.Namespace) -> dict[str, Any]:
    """Row of a case."""
    seconds = QUICK_SECONDS if options.quick else SECONDS
    pairs = options.pairs if case.long or options.quick else 2 * options.pairs + 1
    try:
        row = compare(own, peers, case, pairs, seconds)
        if isinstance(case, Overhead):
            row["contacts"] = contacts(own, case)
    except RefusedError as failure:
        raise SystemExit(f"{case.name}: {failure}") from None
    return row


def memories(cases: Iterable[Case]) -> list[dict[str, Any]]:
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


def elements(quick: bool) -> list[dict[str, Any]]:
    """Costs of our kinds of elements; imported late, when one thread is set."""
    from elements import costs

    return costs(3) if quick else costs()


def kernels() -> list[dict[str, Any]]:
    """Our kernels by themselves."""
    from elements import all_kernels

    return all_kernels()


def pieces(own: Worker, peers: dict[str, Worker], options: argparse.Namespace) -> dict[str, Piece]:
    """How each piece is measured."""
    made: dict[str, Piece] = {
        name: partial(measure, own, peers, case, options) for name, case in CASES.items()
    }
    repeats, first_run = (2, False) if options.quick else (3, True)
    return made | {
        "memory": lambda: memories(CASES.values()),
        "elements": lambda: elements(options.quick),
        "kernels": kernels,
        "startup_s": lambda: startup(repeats, first_run),
    }


def run(names: list[str], store: Store, options: argparse.Namespace, console: Console) -> None:
    """Measure piece by piece, as long as there is time."""
    end = time.perf_counter() + 60.0 * (options.minutes or float("inf"))
    with workers(**SIDES) as ready:
        if "ancf" not in ready:
            raise SystemExit("ancf cannot be imported: pip install -e '.[bench]'")
        own, peers = ready.pop("ancf"), ready
        if not peers:
            console.print("Exudyn is not installed (pip install -e '.[bench]'): our side alone", markup=False)
        made = pieces(own, peers, options)
        for name in names:
            begun = time.perf_counter()
            if begun + store.seconds(name) > end:
                console.print(f"{name}: left out, it would take {store.seconds(name):.0f} s")
                continue
            before = load()
            store.take(name, made[name](), begun, before)
            console.print(f"[dim]{name}: {time.perf_counter() - begun:.0f} s[/]")


def listed(store: Store, console: Console) -> None:
    """Print the pieces, the commits that they were measured with and how long that took."""
    for name in (*CASES, *TABLES):
        known = store.results["measured"].get(name, {})
        line = f"{name:24} {known.get('commit', '')!s:10} {store.seconds(name):6.0f} s"
        console.print(line, highlight=False)


def main() -> None:
    options = arguments()
    console = Console(width=max(WIDTH, Console().width) if not sys.stdout.isatty() else None)
    os.environ.update(ONE_THREAD)
    default = None if options.quick else HERE / "results.json"
    store = Store(options.output or default)
    if options.list:
        listed(store, console)
        return
    begin = time.perf_counter()
    if not options.show:
        run(chosen(options, store), store, options, console)
        if not options.quick:
            store.remember()
    show(store.results, console)
    console.print(f"[dim]{time.perf_counter() - begin:.0f} s, {store.file or 'not stored'}[/]")
    if store.file == HERE / "results.json" and not options.show:
        console.print("pages with these numbers, which tests compare: " + " && ".join(PAGES), highlight=False)


if __name__ == "__main__":
    main()
