"""``ancf catenary``: form and static elasticity of an overhead line."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from ..model.file.paths import assignments
from .output import OutputFolder
from .screen import Screen, console, table

if TYPE_CHECKING:
    from ..catenary import Elasticity, Line, Route
    from ..catenary.forms.route_form import AnyForm
    from ..catenary.forms.schedule import LongRow


def show_form(name: str, output: Path | None, quiet: bool = False, given: list[str] | None = None) -> None:
    """Find the form of a line and print its droppers and arms; with a folder also write both there."""
    from .. import catenary
    from ..catenary.forms.arm_loads import write
    from ..catenary.forms.long_schedule import long_rows, save_long_schedule
    from ..catenary.lines.galloping import said

    line = catenary.read_line(name, assignments(given))
    names = ("schedule.csv", "long_schedule.csv", "arms.csv", "form.png")
    folder = None if output is None else OutputFolder(output, names)
    Screen(quiet).announce_compilation()
    found = catenary.form(line)
    long = long_rows(found)
    if not quiet:
        _print_schedule(line, found)
        if long:
            _print_long_schedule(long)
        _print_arms(found)
        for text in said(line):
            console().print(f"warning: {text}", soft_wrap=True)
    if folder is not None:
        _written(found.save_schedule(folder.path / "schedule.csv"), quiet)
        if long:
            _written(save_long_schedule(found, folder.path / "long_schedule.csv"), quiet)
        _written(write(catenary.arm_loads(found), folder.path / "arms.csv"), quiet)
        if find_spec("matplotlib") is not None:
            _written(found.plot().save(folder.path / "form.png"), quiet)


def show_elasticity(
    name: str,
    output: Path | None,
    forces: list[float],
    quiet: bool = False,
    given: list[str] | None = None,
) -> None:
    """Compute the static elasticity and print it; with a folder also ``elasticity.csv`` there."""
    from .. import catenary

    line = catenary.read_line(name, assignments(given))
    folder = None if output is None else OutputFolder(output, ("elasticity.csv",))
    Screen(quiet).announce_compilation()
    found = catenary.elasticity(line, forces)
    if not quiet:
        _print_elasticity(line, found)
    if folder is not None:
        _written(found.save(folder.path / "elasticity.csv"), quiet)


def _print_schedule(line: Line | Route, found: AnyForm) -> None:
    from ..catenary.answers.state import at_rest, state
    from ..catenary.forms.schedule import texts

    heads = ("span", "dropper", "at [m]", "track [m]", "length [mm]", "unstretched [mm]")
    shown = table(*heads, "load at the lower end [N]", "wire height [mm]", "messenger height [mm]")
    for row in found.schedule():
        shown.add_row(*texts(row))
    where = console()
    where.print(_title(line, found.wave_speed), soft_wrap=True)
    where.print(f"{state(line)}; at rest {at_rest(found)}", soft_wrap=True)
    where.print(shown)
    total = float(found.cut_length.sum())
    lengths, degrees = found.dropper_length, line.parts[0].temperature
    shortest = f"the shortest {1e3 * float(lengths.min()):.1f} mm, " if lengths.size else ""
    where.print(
        f"{lengths.size} droppers, {total:.3f} m unstretched in all (as cut, at {degrees:g} °C), {shortest}"
        f"contact wire {line.parts[0].contact_support} at the supports",
        soft_wrap=True,
    )


def _print_long_schedule(long: list[LongRow]) -> None:
    from ..catenary.forms.schedule import texts

    heads = ("span", "long dropper", "at [m]", "track [m]", "length [mm]", "unstretched [mm]")
    shown = table(*heads, "load at the lower end [N]")
    for row in long:
        shown.add_row(*texts(row))
    where = console()
    where.print("between messenger and auxiliary", soft_wrap=True)
    where.print(shown)


def _print_arms(found: AnyForm) -> None:
    from ..catenary.forms.arm_loads import arm_loads, texts

    heads = ("support", "track [m]", "by the curve [N]", "by the stagger [N]", "to the left [N]", "up [N]")
    shown = table(*heads, "hinge", "arm")
    for row in arm_loads(found):
        shown.add_row(*texts(row))
    console().print(shown)


def _print_elasticity(line: Line | Route, found: Elasticity) -> None:
    from ..catenary.answers.state import at_rest, state

    shown = table("at [m]", *(f"{force:g} N [mm/N]" for force in found.force))
    for x, values in zip(found.x, found.value.T, strict=True):
        shown.add_row(f"{x:.2f}", *(f"{value:.4f}" for value in values))
    where = console()
    formed = found.form
    where.print(_title(line, line.wave_speed if formed is None else formed.wave_speed), soft_wrap=True)
    told = "" if formed is None else f"; at rest {at_rest(formed)}"
    where.print(state(line) + told, soft_wrap=True)
    where.print(f"elasticity along span {found.span + 1}", soft_wrap=True)
    where.print(shown)
    for force, ratio in zip(found.force, found.nonuniformity, strict=True):
        where.print(f"non-uniformity at {force:g} N: {100 * ratio:.1f} %", soft_wrap=True)


def _title(line: Line | Route, wave_speed: float) -> str:
    size = f"{len(line.spans)} spans, {line.length:g} m, wave speed {3.6 * wave_speed:.0f} km/h"
    return f"{line.title}: {size}" if line.title else size


def _written(path: Path, quiet: bool) -> None:
    if not quiet:
        console().print(str(path), soft_wrap=True)
