"""``ancf optimise``: lengths of droppers with which a number of a run along a line is least."""

from __future__ import annotations

import csv
from pathlib import Path
from typing import TYPE_CHECKING

from ..files import drafted, to_json, writing
from .output import OutputFolder
from .screen import Screen, console, table
from .summary import plural

if TYPE_CHECKING:
    from ..design.droppers import LineOptimum, Tried
    from ..design.optimisation_file import OptimisationFile

FILES = ("optimum.toml", "optimum.json", "runs.csv")


def optimise_file(path: Path, folder: Path, quiet: bool = False) -> None:
    """Search, write and print.

    Raises
    ------
    ModelError
        The file or its line are wrong, or the folder cannot be written.
    SolveError
        A run failed.
    """
    from ..design.optimisation_file import read_optimisation

    given, screen = read_optimisation(path), Screen(quiet)
    OutputFolder(folder, FILES)
    screen.announce_compilation()
    objective, count = given.formulas[0].text, 0
    screen.say(f"looking for {len(given.parameters)} lengths with which {objective} is least ...")

    def report(tried: Tried) -> None:
        nonlocal count
        count += 1
        more = "".join(f", {text} = {x:.6g}" for text, x in tried.constraints.items())
        screen.say(f"run {count}: {objective} = {tried.objective:.6g}{more}")

    found = given.search(report)
    files = _write(given, found, folder)
    if not quiet:
        _show(given, found)
        console().print("written: " + ", ".join(map(str, files)), soft_wrap=True)


def _write(given: OptimisationFile, found: LineOptimum, folder: Path) -> list[Path]:
    from .._version import __version__

    files = [folder / name for name in FILES]
    with writing(files[0]), drafted(files[0]) as draft:
        draft.write_text(given.optimum_text(found), encoding="utf-8")
    about = {
        "title": given.title,
        "objective": {"formula": given.formulas[0].text, "first": found.first, "least": found.objective},
        "parameters": {
            name: {"change [m]": x, "slope [per m]": found.slope[name]} for name, x in found.values.items()
        },
        "constraints": found.constraints,
        "gradients": len(found.tried),
        "converged": found.converged,
        "message": found.message,
        "versions": {"ancf": __version__},
    }
    with writing(files[1]), drafted(files[1]) as draft:
        draft.write_text(to_json(about, indent=2), encoding="utf-8", errors="backslashreplace")
    with writing(files[2]), drafted(files[2]) as draft, draft.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        names = list(found.values)
        limits = list(found.constraints)
        writer.writerow(["run", given.formulas[0].text, *limits, *(f"{name} [m]" for name in names)])
        for k, tried in enumerate(found.tried, start=1):
            numbers = [tried.objective, *tried.constraints.values(), *tried.values.values()]
            writer.writerow([k, *map(repr, numbers)])
    return files


def _show(given: OptimisationFile, found: LineOptimum) -> None:
    where, shown = console(), table("parameter", "change, mm", "droppers")
    for name, x in found.values.items():
        shown.add_row(name, f"{1e3 * x:.3f}", " ".join(given.parameters[name].labels))
    where.print(shown)
    text = given.formulas[0].text
    runs = plural(len(found.tried), "run")
    where.print(f"{text}: {found.first:.6g} -> {found.objective:.6g} with {runs} with gradients")
    if not found.converged:
        where.print(f"note: the search has not converged: {found.message}", soft_wrap=True)
