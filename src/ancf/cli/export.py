"""``ancf export``: a results file for ParaView, as tables or as a movie."""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import ModelError
from ..files import exists, results_at
from ..model import checks
from .results_file import open_result
from .screen import Screen, console

if TYPE_CHECKING:
    from .. import Result

#: Suffix of what is written, by the word after --to; tables go to a folder.
SUFFIXES = {"vtk": ".vtkhdf", "csv": "", "parquet": "", "xlsx": ".xlsx", "mp4": ".mp4", "gif": ".gif"}
#: Words by which a kind is called elsewhere.
ALSO = {"excel": "xlsx", "paraview": "vtk", "vtkhdf": "vtk"}
TIMES, PICTURES = ("frames", "start", "end"), ("color", "fps", "view")
#: Options that mean something, by the word after --to.
OPTIONS = {
    "vtk": TIMES,
    "csv": ("points",),
    "parquet": ("points",),
    "xlsx": ("points",),
    "mp4": TIMES + PICTURES,
    "gif": TIMES + PICTURES,
}


def export_file(
    file: Path, to: str | None, output: Path | None, options: dict[str, Any], quiet: bool = False
) -> None:
    """Write a results file in another format and print what was written.

    Parameters
    ----------
    file : Path
        Results file or its folder, also of a run that was stopped, failed or goes on.
    to : "vtk", "csv", "parquet", "xlsx", "mp4" or "gif", optional
        Default as `output` ends.
    output : Path, optional
        File to write, or folder; default beside the results file.
    options : dict
        ``frames``, ``start``, ``end``, ``points``, ``color``, ``fps``, ``view``; None where not given.
    quiet : bool
        Print nothing.

    Raises
    ------
    ModelError
        Something is wrong with what was given; nothing was written.

    """
    to = _kind(to, output)
    given = _given(to, options)
    file = results_at(file)
    result = open_result(file)
    screen = Screen(quiet)
    if result.status != "complete":
        screen.say(f"the run is not complete ({result.status}): exporting up to t = {result.t[-1]:.6g} s")
    target = _target(file, to, output)
    if to != "xlsx" and SUFFIXES[to]:
        written = [_moving(result, to, target, given)]
    else:
        written = _tables(result, to, target, given, screen)
    if not quiet:
        console().print("written: " + ", ".join(map(str, written)), soft_wrap=True)


def split_points(text: str) -> list[str]:
    """Points that commas outside brackets separate: ``beam.end,beam.at(0.5, 0, 0.01)``."""
    labels = [part.strip() for part in re.split(r",(?![^()]*\))", text)]
    return [label for label in labels if label]


def _kind(to: str | None, output: Path | None) -> str:
    """What is to be written, by the word after --to or else by the end of the file after -o."""
    if to is None:
        ends = {end: kind for kind, end in SUFFIXES.items() if end}
        to = ends.get("" if output is None else output.suffix.lower())
    if to is None:
        what = f"is missing: one of {checks.listed(tuple(SUFFIXES))}"
        if (
            output is not None and (end := output.suffix.lower().removeprefix(".")) in SUFFIXES
        ):  # several tables
            raise ModelError("--to", what, f"{end} fills a folder: --to {end} -o {output.with_suffix('')}")
        raise ModelError("--to", what, "or -o with a file that ends so")
    return checks.choice(ALSO.get(to, to), "--to", tuple(SUFFIXES))


def _given(to: str, options: dict[str, Any]) -> dict[str, Any]:
    """Options that were given; one that means nothing here is an error."""
    given = {name: value for name, value in options.items() if value is not None}
    for name in given:
        if name not in OPTIONS[to]:
            kinds = [kind for kind, names in OPTIONS.items() if name in names]
            raise ModelError(
                f"--{name}", f"means nothing with --to {to}", f"it belongs to {', '.join(kinds)}"
            )
    return given


def _target(file: Path, to: str, output: Path | None) -> Path:
    """File or folder to write to."""
    suffix = SUFFIXES[to]
    if not suffix:
        if output is not None and (output.suffix.lower() == f".{to}" or exists(output, "is_file")):
            what = "names one file, but there are several tables"
            raise ModelError(f"-o {output}", what, "give a folder")
        return file.parent if output is None else output
    if output is None:
        return file.with_suffix(suffix)
    if exists(output, "is_dir"):
        return output / file.with_suffix(suffix).name
    if output.suffix.lower() != suffix:
        raise ModelError(f"-o {output}", f"must end in {suffix} with --to {to}, or be a folder that exists")
    return output


def _moving(result: Result, to: str, target: Path, given: dict[str, Any]) -> Path:
    """Write the mesh or the movie."""
    if to == "vtk":
        from ..viz.export import write_vtk

        return write_vtk(result, target, **given)
    from ..viz.pictures.movie import write_movie
    from ..viz.scene import make_scene

    times = {name: given.pop(name) for name in TIMES if name in given}
    write_movie(make_scene(result, **times), target, **given)
    return target


def _tables(result: Result, to: str, target: Path, given: dict[str, Any], screen: Screen) -> list[Path]:
    from ..viz.export import write_csv, write_parquet, write_xlsx
    from ..viz.export.csv_files import has_sensors

    points = split_points(given["points"]) if "points" in given else None
    if points == []:
        raise ModelError("--points", "names no point", 'such as --points "beam.end,beam.at(0.5)"')
    if points is None and not has_sensors(result):
        table = "the sheet points" if to == "xlsx" else f"points.{to}"
        screen.say(f"no sensors were recorded: {table} has ends and middles; --points chooses others")
    if to == "xlsx":
        return [write_xlsx(result, target, points)]
    return (write_csv if to == "csv" else write_parquet)(result, target, points)
