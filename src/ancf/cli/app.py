"""The commands and their options; everything heavy is imported by the command that needs it."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated

import typer

from . import export_options as exporting
from .catenary_app import catenary
from .common_options import (
    AnyInput,
    Folder,
    Jobs,
    ModelFile,
    Names,
    Quick,
    Quiet,
    Report,
    Resume,
    SchemaFile,
    Set,
    Verify,
)
from .guard import reported
from .line_options import Case, CaseSpeed
from .study_options import CalibrationFile, OptimisationFile, Retry, Scheduler, Status, StudyFile, Workers
from .view_options import Color, Frames, Live, Open, Page, Several, Traced

app = typer.Typer(
    name="ancf",
    help="Thin beams and cables that move a lot: absolute nodal coordinate formulation.",
    epilog="Exit codes: 0 done, 1 the solve failed, 2 the input is wrong, "
    "130 stopped by Ctrl-C, 143 by SIGTERM.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,
)

app.add_typer(catenary, name="catenary")


def _show_version(wanted: bool) -> None:
    if wanted:
        from .. import __version__

        typer.echo(f"ancf {__version__}")
        raise typer.Exit


@app.callback()
def _common(
    version: Annotated[
        bool, typer.Option("--version", callback=_show_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    pass


@app.command()
def run(
    model: ModelFile,
    output: Folder = Path("out"),
    quiet: Quiet = False,
    verify: Verify = False,
    resume: Resume = False,
    given: Set = None,
) -> None:
    """Compute what a model file asks for.

    Writes OUT/results.h5 while it runs, and OUT/summary.json at the end. With --verify it computes again with
    half the step and twice the elements, prints how much every output changes, and writes OUT/verify.json.
    With --resume a run that was stopped, or that has a later t_end now, goes on where OUT/results.h5 ends.
    """
    with reported():
        from .run import run_file

        run_file(model, output, quiet, verify, resume, given)


@app.command()
def check(file: AnyInput, given: Set = None) -> None:
    """Say whether a file is right: a model file, a line file, or a results file."""
    with reported():
        from .check import check_file

        check_file(file, given)


@app.command()
def schema(output: SchemaFile = None) -> None:
    """Print the JSON Schema of model files."""
    with reported():
        from .schema import write_schema

        write_schema(output)


@app.command()
def info(file: AnyInput) -> None:
    """Say what is in a results, model or line file.

    A results file may belong to a run that is not finished, or was killed.
    """
    with reported():
        from .info import show_info

        show_info(file)


@app.command()
def export(
    results: exporting.ResultsFile,
    to: exporting.Kind = None,
    output: exporting.Target = None,
    points: exporting.Points = None,
    frames: exporting.Frames = None,
    start: exporting.FromTime = None,
    end: exporting.ToTime = None,
    color: exporting.Color = None,
    fps: exporting.Fps = None,
    view: exporting.View = None,
    quiet: Quiet = False,
) -> None:
    """Write a results file for other programs.

    vtk: one file with all times for ParaView. csv: tables of sensors, points, springs, joints and energies;
    parquet, xlsx: the same.
    mp4, gif: a movie. The run may have failed, been stopped or still go on.
    """
    with reported():
        from .export import export_file

        times = {"frames": frames, "start": start, "end": end}
        chosen = {**times, "points": points, "color": color, "fps": fps, "view": view}
        export_file(results, to, output, chosen, quiet)


@app.command()
def reproduce(
    names: Names = None,
    output: Folder = Path("out"),
    quick: Quick = False,
    jobs: Jobs = None,
    quiet: Quiet = False,
) -> None:
    """Recompute the paper and compare every number that has a reference.

    Writes OUT/NAME.png, OUT/NAME.csv and OUT/NAME.json for each figure, OUT/checks.json, and OUT/index.html
    with all of it. The exit code is 1 when a check fails.
    """
    with reported():
        from .reproduce import reproduce_figures

        reproduce_figures(names or ["all"], output, quick, jobs, quiet)


@app.command()
def view(
    results: Several,
    output: Page = None,
    frames: Frames = 240,
    color: Color = None,
    trace: Traced = None,
    show: Open = False,
    live: Live = False,
) -> None:
    """Make a moving picture of results files, or of a line at rest: an HTML page that needs no network.

    Prints the path of the page. Several runs are compared: drawn together, their curves in the same plots.
    With --live the page follows a run that goes on, or waits for it.
    """
    with reported():
        from .view import view_file

        view_file(results, output, {"frames": frames, "color": color, "trace": trace}, show, live)


@app.command()
def validate(
    case: Case,
    speed: CaseSpeed = None,
    output: Folder = Path("out"),
    report: Report = True,
    quiet: Quiet = False,
) -> None:
    """Run a reference case of a standard, mooring lines or ropes on drums, beside what is published.

    Writes OUT/validate.json, CSV files and OUT/report.html, of a line at several speeds in OUT/KMH.
    Quantities outside their ranges are reported and are no error: the exit code is 0 when all was computed.
    """
    with reported():
        from .validate import WITHOUT_SPEED, validate_case, validate_groups

        if case in WITHOUT_SPEED:
            validate_groups(case, speed, output, report, quiet)
        else:
            validate_case(case, speed, output, report, quiet)


@app.command()
def study(
    file: StudyFile,
    output: Folder = Path("out"),
    workers: Workers = None,
    scheduler: Scheduler = None,
    retry: Retry = False,
    status: Status = False,
    report: Report = True,
    quiet: Quiet = False,
) -> None:
    """Compute many variants of a model or a line.

    Writes OUT/table.csv, OUT/table.parquet, OUT/study.json and OUT/report.html. Whatever is killed, the same
    command goes on; more samples later repeat none. The exit code is 1 when cases failed.
    """
    with reported():
        from .study import run_study, show_status

        if status:
            show_status(output if file.is_file() else file)
            return
        options = {"workers": workers, "scheduler": scheduler, "retry": retry, "report": report}
        run_study(file, output, options, quiet)


@app.command()
def calibrate(
    file: CalibrationFile,
    output: Folder = Path("out"),
    workers: Workers = None,
    report: Report = True,
    quiet: Quiet = False,
) -> None:
    """Find parameters of a model from measured histories, by least squares.

    Writes OUT/fit.json, OUT/fit.csv and OUT/report.html, and prints the parameters with their confidence.
    """
    with reported():
        from .calibrate import calibrate_file

        calibrate_file(file, output, workers, report, quiet)


@app.command()
def optimise(file: OptimisationFile, output: Folder = Path("out"), quiet: Quiet = False) -> None:
    """Find lengths of droppers with which a number of a run along a line is least, by exact gradients.

    Writes OUT/optimum.toml, the line with these lengths, OUT/optimum.json and OUT/runs.csv.
    """
    with reported():
        from .optimise import optimise_file

        optimise_file(file, output, quiet)


MoorDynInput = Annotated[
    Path, typer.Argument(metavar="LINES.txt", help="Input file of MoorDyn, version 2.", show_default=False)
]
Model = Annotated[
    Path | None,
    typer.Option("--output", "-o", metavar="MODEL.toml", help="Model file.", show_default="beside it"),
]


@app.command("import-moordyn")
def import_moordyn(lines: MoorDynInput, output: Model = None) -> None:
    """Make a model file from an input file of MoorDyn.

    Prints what the file has and the model has not; it stands at the head of the model file too.
    """
    with reported():
        from .import_moordyn import import_file

        import_file(lines, lines.with_suffix(".toml") if output is None else output)


@app.command("export-fmu")
def export_fmu(model: ModelFile, output: exporting.Unit = None, fmi: exporting.Fmi = "3.0") -> None:
    """Write a model file as a unit of co-simulation (FMU), which Python and this package run.

    Its inputs are the model's, its outputs what the sensors of [simulation] record.
    """
    with reported():
        from .export_fmu import export_unit

        export_unit(model, model.with_suffix(".fmu") if output is None else output, fmi)


Copy = Annotated[
    Path | None, typer.Option("--copy", metavar="FOLDER", help="Copy them there.", show_default=False)
]


@app.command()
def examples(copy: Copy = None) -> None:
    """List the examples that come with the package, or copy them: ancf examples --copy .

    No file that was changed is overwritten.
    """
    with reported():
        from .examples import show_examples

        show_examples(copy)


@app.command()
def docs(
    word: Annotated[
        list[str] | None, typer.Argument(help="A page, or what it is about.", show_default=False)
    ] = None,
    copy: Copy = None,
) -> None:
    """Show the page of the documentation about a word: ancf docs winch; without one, list all pages."""
    with reported():
        from .docs import show_docs

        show_docs(" ".join(word) if word else None, copy)


@app.command()
def warmup(quiet: Quiet = False) -> None:
    """Compile what runs need, ahead of them; what is compiled already takes seconds."""
    with reported():
        from .warmup import warm_up

        warm_up(quiet)


def start() -> None:
    """Parse the arguments and do what they say."""
    _fill_streams()
    for stream in (sys.stdout, sys.stderr):
        if hasattr(stream, "reconfigure"):  # a title in Greek must not stop a run in a terminal without it
            stream.reconfigure(errors="backslashreplace")
    app()


def _fill_streams() -> None:
    """Take the numbers of closed streams: a results file that got one would take messages."""
    while (spare := os.open(os.devnull, os.O_RDWR)) <= 2:
        pass
    os.close(spare)
