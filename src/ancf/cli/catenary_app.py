"""The commands of overhead lines, ``ancf catenary ...``."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import typer

from .common_options import Folder, OptionalFolder, Quiet, Report, Set, States, To
from .guard import reported
from .line_options import (
    Aerodynamic,
    BrokenDroppers,
    ContactKind,
    ContactStiffness,
    Elements,
    Forces,
    LineName,
    Masses,
    Measure,
    OutputStep,
    PantographFile,
    Pantographs,
    Reduce,
    ResponseFile,
    ResponseKind,
    Roof,
    Runs,
    Spacing,
    Spacings,
    Speed,
    Speeds,
    Start,
    StaticForce,
    Step,
    Underside,
    Until,
    Window,
)
from .study_options import Retry, Workers

catenary = typer.Typer(help="Overhead lines.", no_args_is_help=True, rich_markup_mode=None)


@catenary.command("form")
def catenary_form(
    line: LineName, output: OptionalFolder = None, quiet: Quiet = False, given: Set = None
) -> None:
    """Find the form of an overhead line and print its dropper schedule and the loads of its arms.

    With -o writes OUT/schedule.csv, lengths in mm, with an auxiliary wire also
    OUT/long_schedule.csv, OUT/arms.csv and a picture, OUT/form.png.
    """
    with reported():
        from .catenary import show_form

        show_form(line, output, quiet, given)


@catenary.command("run")
def catenary_run(
    line: LineName,
    speed: Speed,
    output: Folder = Path("out"),
    pantograph: Pantographs = None,
    spacing: Spacing = None,
    start: Start = None,
    window: Window = None,
    until: Until = None,
    contact: ContactKind = "penalty",
    contact_stiffness: ContactStiffness = None,
    step: Step = None,
    mesh: Elements = None,
    roof: Roof = None,
    underside: Underside = None,
    measure: Measure = None,
    reduce: Reduce = False,
    break_dropper: BrokenDroppers = None,
    output_step: OutputStep = None,
    states: States = True,
    report: Report = True,
    to: To = None,
    quiet: Quiet = False,
    given: Set = None,
) -> None:
    """Run pantographs along an overhead line.

    Writes OUT/results.h5 for ancf view and ancf export, OUT/run.json, CSV files and OUT/report.html (also
    as PDF and DOCX), and prints the statistics of the contact force.
    """
    with reported():
        from .catenary_run import run_line

        options: dict[str, Any] = {
            "spacing": spacing,
            "start": start,
            "window": window,
            "contact": contact,
            "step": step,
        }
        options |= {"output_step": output_step, "until": until, "contact_stiffness": contact_stiffness}
        options |= {"mesh": mesh, "roof": roof, "underside": underside, "reduce": reduce or None}
        options["broken_droppers"] = break_dropper
        run_line(line, speed, pantograph, options, output, report, states, quiet, given, to, measure)


@catenary.command("sweep")
def catenary_sweep(
    line: LineName,
    speed: Speeds,
    output: Folder = Path("out"),
    spacing: Spacings = None,
    pantograph: Pantographs = None,
    start: Start = None,
    window: Window = None,
    until: Until = None,
    step: Step = None,
    mesh: Elements = None,
    break_dropper: BrokenDroppers = None,
    workers: Workers = None,
    retry: Retry = False,
    to: To = None,
    quiet: Quiet = False,
    given: Set = None,
) -> None:
    """Run pantographs along an overhead line at many speeds, and distances of a second one.

    Writes OUT/table.csv with a row for each case and OUT/report.html (also as PDF and DOCX). Cases run in
    parallel; the same command goes on after any end.
    """
    with reported():
        from .catenary_sweep import sweep_line

        options: dict[str, Any] = {"start": start, "window": window, "until": until, "step": step}
        options |= {
            "mesh": mesh,
            "workers": workers,
            "retry": retry,
            "broken_droppers": break_dropper or None,
        }
        sweep_line(line, speed, spacing, pantograph, options, output, to, quiet, given)


@catenary.command("compare")
def catenary_compare(
    folders: Runs, output: Folder = Path("comparison"), to: To = None, quiet: Quiet = False
) -> None:
    """Compare runs that ancf catenary run has written: quantities side by side, forces over each other.

    Writes OUT/table.csv and OUT/report.html (also as PDF and DOCX).
    """
    with reported():
        from .catenary_compare import compare_runs

        compare_runs(folders, output, to, quiet)


@catenary.command("identify")
def catenary_identify(
    response: ResponseFile,
    output: PantographFile = Path("pantograph.toml"),
    kind: ResponseKind = "apparent_mass",
    masses: Masses = None,
    static_force: StaticForce = 70.0,
    aerodynamic: Aerodynamic = 0.0,
    quiet: Quiet = False,
) -> None:
    """Fit a pantograph to the frequency response at its strip, and write it as a file for ancf catenary run.

    RESPONSE.csv has the columns frequency in Hz, and real and imag, or magnitude and phase_deg.
    """
    with reported():
        from .catenary_identify import identify

        identify(response, output, kind, masses, static_force, aerodynamic, quiet)


@catenary.command("elasticity")
def catenary_elasticity(
    line: LineName,
    output: OptionalFolder = None,
    force: Forces = None,
    quiet: Quiet = False,
    given: Set = None,
) -> None:
    """Lift the contact wire along the middle span of an overhead line and print how far it gives.

    Forces of 100 and 200 N by default. With -o writes OUT/elasticity.csv.
    """
    with reported():
        from .catenary import show_elasticity

        show_elasticity(line, output, force or [100.0, 200.0], quiet, given)


@catenary.command("list")
def catenary_list() -> None:
    """List the lines, pantographs and wires that come with the package."""
    with reported():
        from .catenary_list import show_catalogue

        show_catalogue()
