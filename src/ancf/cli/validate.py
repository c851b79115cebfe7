"""``ancf validate``: a reference case against its published ranges, as a table, JSON, CSV and a report."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING

from ..errors import ModelError
from .output import OutputFolder
from .screen import Screen, console

if TYPE_CHECKING:
    from ..catenary.answers.references import Reference
    from ..catenary.answers.run_data import Run


def validate_case(
    case: str, speed_kmh: float | None, folder: Path, report: bool = True, quiet: bool = False
) -> None:
    """Run, compare, write and print; without a speed at each that has ranges, in folders of their own.

    Raises
    ------
    ModelError
        Unknown case, wrong speed, a folder that cannot be written, or matplotlib is missing for the report;
        nothing was computed.

    """
    from ..catenary.answers.references import reference_case
    from ..model.checks import positive
    from ..viz.style import require_matplotlib

    reference = reference_case(case)
    if speed_kmh is not None:
        positive(speed_kmh, "--speed")
    if report:
        require_matplotlib()
    if speed_kmh is not None:
        return _at_speed(reference, speed_kmh, folder, report, quiet)
    for speed in reference.speeds:
        _at_speed(reference, speed, folder / f"{speed:g}", report, quiet)


def _at_speed(reference: Reference, speed_kmh: float, folder: Path, report: bool, quiet: bool) -> None:
    from ..catenary import validate

    output, screen = OutputFolder(folder), Screen(quiet)
    with output.locked():
        screen.announce_compilation()
        with screen.progress(1) as progress:
            run = validate.reference_run(reference.name, speed_kmh, progress=progress)
        files = validate.write_validation(run, reference, folder, report)
    if not quiet:
        show(run, reference)
        console().print("written: " + ", ".join(str(file) for file in files), soft_wrap=True)


#: Cases that have no speed, with the modules that compute them.
WITHOUT_SPEED = {"mooring": "mooring", "contact": "reeving"}


def validate_groups(
    case: str, speed_kmh: float | None, folder: Path, report: bool = True, quiet: bool = False
) -> None:
    """Compute mooring lines or ropes on surfaces, compare, write and print.

    Raises
    ------
    ModelError
        A speed, which they do not have, or a folder that cannot be written; nothing was computed.

    """
    from ..catenary.answers.table import table

    validate = import_module(f"..{WITHOUT_SPEED[case]}.validate", __package__)
    if speed_kmh is not None:
        raise ModelError("--speed", f'the case "{case}" has none', "leave it out")
    output, screen = OutputFolder(folder), Screen(quiet)
    with output.locked():
        screen.announce_compilation()

        def said(done: int, of: int) -> None:
            if not quiet:
                screen.say(f"{done} of {of} cases computed")

        groups = validate.compare(said)
        files = validate.write(groups, folder, report)
    if quiet:
        return
    to = console()
    for group in groups:
        to.print(group.title, style="bold", soft_wrap=True)
        to.print(table(group.rows))
    judged = [q.inside for group in groups for q in group.rows if q.inside is not None]
    to.print(f"{sum(judged)} of {len(judged)} inside the accepted ranges", soft_wrap=True)
    to.print("written: " + ", ".join(str(file) for file in files), soft_wrap=True)


def show(run: Run, reference: Reference) -> None:
    """Print the table of the reference's quantities."""
    from ..catenary.answers.references import filter_note, second_reading
    from ..catenary.answers.statistics import statistics
    from ..catenary.answers.table import table

    screen = console()
    rows = reference.compare(statistics(run), run.speed_kmh)
    screen.print(f"{reference.title}, {run.speed_kmh:.4g} km/h", style="bold", soft_wrap=True)
    screen.print(table(rows))
    if note := reference.note(run.speed_kmh):
        screen.print(note, soft_wrap=True)
    judged = [q.inside for q in rows if q.inside is not None]
    if judged:
        note = filter_note(rows, second_reading(run, reference))
        screen.print(f"{sum(judged)} of {len(judged)} inside the accepted ranges; {note}", soft_wrap=True)
    screen.print(
        f"real-time factor {run.real_time_factor:.3g}: {run.simulated_seconds:.3g} s simulated in "
        f"{run.cpu_seconds:.3g} s of CPU time",
        soft_wrap=True,
    )
