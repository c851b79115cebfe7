"""``ancf catenary sweep``: pantographs along a line at many speeds and distances, with a report."""

from __future__ import annotations

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from ..errors import ModelError, SolveError
from .guard import FAILED
from .screen import Screen, console, table
from .summary import plural

if TYPE_CHECKING:
    from pandas import DataFrame

    from ..catenary import Line, Mesh, Route

#: Quantities on the screen, and their digits.
SHOWN = (("mean_force", 1), ("deviation", 1), ("minimum", 1), ("arcing", 2), ("uplift", 1))


def sweep_line(
    name: str,
    speeds: str,
    spacings: str | None,
    pantographs: list[str] | None,
    options: dict[str, Any],
    folder: Path,
    to: str | None = None,
    quiet: bool = False,
    changes: list[str] | None = None,
) -> None:
    """Compute what is left, write the table and the reports, and print.

    Raises
    ------
    ModelError
        Something given is wrong, or a package is missing; nothing was computed.
    typer.Exit
        With code 1 when cases failed.
    """
    from ..catenary import Mesh, find_pantograph, read_line
    from ..catenary.broken import told as broken_text
    from ..design.sweep import sweep, values_of
    from ..model.file.paths import assignments
    from ..viz.printed import chosen
    from ..viz.style import require_matplotlib
    from .study import cases_progress

    formats = chosen(to)
    require_matplotlib()
    given = {key: value for key, value in options.items() if value is not None}
    if "mesh" in given:
        given["mesh"] = Mesh(contact=given["mesh"][0], messenger=given["mesh"][1])
    line, at = read_line(name, assignments(changes)), values_of(speeds, "--speed")
    apart = values_of(spacings, "--spacing") if spacings is not None else []
    units = [find_pantograph(unit) for unit in pantographs or ["benchmark-2015"]]
    screen = Screen(quiet)
    screen.announce_compilation()
    try:
        with cases_progress(screen) as progress:
            unit = units[0] if len(units) == 1 else units
            done = sweep(line, at, apart, folder=folder, progress=progress, pantograph=unit, **given)
    except KeyboardInterrupt as error:
        error.add_note(f"what has ended is kept in {folder}: the same command goes on")
        raise
    names = [units[min(k, len(units) - 1)].name for k in range(2 if apart else 1)]
    told, broken = _state(line, given.get("mesh", Mesh())), given.get("broken_droppers", ())
    said = [*told, ("Broken droppers", ", ".join(broken))] if broken else told
    files = _report(line, done, names, said, folder, formats)
    if not quiet:
        console().print("; at rest ".join(text for _, text in told), soft_wrap=True)
        if broken:
            console().print(broken_text(broken), soft_wrap=True)
        _show(done, len(names))
        console().print("written: " + ", ".join(map(str, [folder / "table.csv", *files])), soft_wrap=True)
        _tell_warnings(done)
    failed = done[done["status"] != "ok"]
    if len(failed):
        text = f"{len(failed)} of {len(done)} cases failed; the first: {failed['message'].iloc[0]}"
        console(stderr=True).print(text, style="bold", soft_wrap=True)
        raise typer.Exit(FAILED)


def _state(line: Line | Route, mesh: Mesh) -> list[tuple[str, str]]:
    """The conditions that all cases share, and the tensions at rest, as reports of runs have them."""
    from ..catenary import form
    from ..catenary.answers.state import at_rest, state

    told = [("State", state(line))]
    with suppress(ModelError, SolveError):  # each case says why
        told.append(("At rest", at_rest(form(line, mesh))))
    return told


def _report(
    line: Line | Route,
    done: DataFrame,
    names: list[str],
    state: list[tuple[str, str]],
    folder: Path,
    formats: tuple[str, ...],
) -> list[Path]:
    from ..catenary.answers.state import titled
    from ..catenary.report.sweep import Sweep, write_sweep
    from ..design.sweep import SPACING, SPEED

    told = names if len(set(names)) == len(names) else [f"{name} ({k + 1})" for k, name in enumerate(names)]
    rows = [{str(key): value for key, value in row.items()} for row in done.to_dict("records")]
    first = "Pantographs, the first ahead" if len(told) > 1 else "Pantograph"
    settings = [*state, (first, ", ".join(told))]
    return write_sweep(Sweep(titled(line), rows, SPEED, SPACING, told, settings), folder, formats)


def _show(done: DataFrame, count: int) -> None:
    from ..catenary.report.sweep import verdict
    from ..design.sweep import SPACING, SPEED

    apart = SPACING in done.columns
    heads = ["speed [km/h]", *(["distance [m]"] if apart else []), *(["pantograph"] if count > 1 else [])]
    shown = table(*heads, "Fm [N]", "sigma [N]", "smallest [N]", "NQ [%]", "uplift [mm]", "limits")
    for row in done[done["status"] == "ok"].to_dict("records"):
        for k in range(1, count + 1):
            place = [f"{row[SPEED]:g}", *([f"{row[SPACING]:g}"] if apart else [])]
            numbers = [_text(row.get(f"{key}_{k}"), digits) for key, digits in SHOWN]
            shown.add_row(*place, *([str(k)] if count > 1 else []), *numbers, verdict(row, k - 1))
    console().print(shown)


def _tell_warnings(done: DataFrame) -> None:
    """What cases warned of, each text once with the cases that it was said of."""
    from ..catenary.report.sweep import warned
    from ..design.sweep import SPACING, SPEED

    rows = [{str(key): value for key, value in row.items()} for row in done.to_dict("records")]
    told = warned(rows, SPEED, SPACING)
    if told:
        count = len({place for _, places in told for place in places})
        console().print(f"{plural(count, 'case')} with warnings:", soft_wrap=True)
        for text, places in told:
            console().print(f"  {', '.join(places)}: {text}", soft_wrap=True)


def _text(value: float | None, digits: int) -> str:
    return "" if value is None else f"{value:.{digits}f}"
