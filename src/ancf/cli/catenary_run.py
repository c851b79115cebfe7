"""``ancf catenary run``: pantographs along a line, as a table, JSON, CSV and a report."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..errors import ModelError, SolveError
from .output import OutputFolder
from .screen import Screen, console

#: Time between the states in results.h5, s, rounded to steps: a pantograph at 300 km/h moves by 1.7 m.
OUTPUT_STEP = 0.02
#: What may be written.
FILES = [
    *("results.h5", "run.json", "statistics.*", "force_*.csv", "uplift.csv", "droppers.csv", "cycles.csv"),
    *("measured_*.csv", "elasticity.csv", "report.*"),
]

if TYPE_CHECKING:
    from ..catenary.answers.measuring import Measured, MeasuringHead
    from ..catenary.answers.run_data import Run
    from ..catenary.answers.statistics import Statistics


def run_line(
    name: str,
    speed_kmh: float,
    pantographs: list[str] | None,
    options: dict[str, Any],
    folder: Path,
    report: bool = True,
    states: bool = True,
    quiet: bool = False,
    changes: list[str] | None = None,
    to: str | None = None,
    measure: Path | None = None,
) -> None:
    """Run, write and print.

    Raises
    ------
    ModelError
        Something given is wrong, or matplotlib is missing for the report; nothing was computed.

    """
    from ..catenary.answers.measuring_file import read_measuring_head
    from ..catenary.forms.mesh import Mesh
    from ..catenary.lines.catalogue import read_line
    from ..catenary.ready import STEP
    from ..catenary.run import run
    from ..model.checks import positive
    from ..model.file.paths import assignments
    from ..model.settings import MOST_STEPS
    from ..viz.printed import chosen
    from ..viz.style import require_matplotlib

    if to is not None and not report:
        raise ModelError("--to", "has no effect with --no-report", "leave one of both out")
    formats = chosen(to) if report else ()
    speed = positive(speed_kmh, "--speed") / 3.6
    line = read_line(name, assignments(changes))
    head = None if measure is None else read_measuring_head(measure)
    if head is not None:
        head.check(1.0 / positive(options["step"] or STEP, "--step"), speed)
    if report:
        require_matplotlib()
    given = {key: value for key, value in options.items() if value is not None and value != []}
    if "mesh" in given:
        given["mesh"] = Mesh(contact=given["mesh"][0], messenger=given["mesh"][1])
    if states:
        step = positive(given.get("step", STEP), "--step")
        given.setdefault("output_step", max(1, round(min(OUTPUT_STEP / step, MOST_STEPS))) * step)
    if pantographs:
        given["pantograph"] = pantographs[0] if len(pantographs) == 1 else pantographs
    output, screen = OutputFolder(folder, FILES), Screen(quiet)
    with output.locked():
        output.clear()
        given["file"] = output.results if states else None
        screen.announce_compilation()
        with _said_after(quiet), screen.progress(1) as progress, _kept(given["file"]):
            done = run(line, speed=speed, progress=progress, **given)
        found, measured = _read(done, head)
        files = [*([output.results] if states else []), *_written(done, folder, formats, found, measured)]
    if not quiet:
        show(done, found, measured)
        console().print("written: " + ", ".join(str(file) for file in files), soft_wrap=True)


@contextmanager
def _said_after(quiet: bool) -> Iterator[None]:
    """Keep warnings until what shows the progress is gone, however that ends."""
    caught: list[warnings.WarningMessage] = []
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            yield
    finally:
        for warning in [] if quiet else caught:
            warnings.warn(warning.message, stacklevel=1)


@contextmanager
def _kept(results: Path | None) -> Iterator[None]:
    """Say of a run that stops early how far its file goes."""
    try:
        yield
    except (SolveError, KeyboardInterrupt) as error:
        result = getattr(error, "result", None)
        if results is not None and result is not None:
            error.add_note(f"states up to t = {result.t[-1]:.6g} s kept in {results}")
        raise


def _read(done: Run, head: MeasuringHead | None) -> tuple[list[Statistics], list[Measured]]:
    """Statistics of each pantograph, and what each would have measured."""
    from ..catenary.answers.measuring import measure
    from ..catenary.answers.statistics import statistics

    every = range(len(done.recordings))
    measured = [] if head is None else [measure(done, k, head) for k in every]
    return [statistics(done, k) for k in every], measured


def _written(
    done: Run, folder: Path, formats: tuple[str, ...], found: list[Statistics], measured: list[Measured]
) -> list[Path]:
    from ..catenary.answers.measuring_file import write_measured
    from ..catenary.answers.write import summary, write_json, write_run

    files = [write_json(summary(done, found), folder / "run.json"), *write_run(done, folder, found)]
    files += [write_measured(one, folder / f"measured_{k + 1}.csv") for k, one in enumerate(measured)]
    if formats:
        from ..catenary.elasticity import elasticity_beside
        from ..catenary.report import write_reports

        gives = elasticity_beside(done.form.line)
        files.append(gives.save(folder / "elasticity.csv"))
        files += write_reports(done, folder, formats, elasticity=gives, measured=measured)
    return files


def show(done: Run, found: Sequence[Statistics] = (), measured: Sequence[Measured] = ()) -> None:
    """Print the statistics of each pantograph, and what it would have measured."""
    from ..catenary.answers.acceptance import acceptance, footnote, verdict
    from ..catenary.answers.measuring_file import compared
    from ..catenary.answers.state import at_rest, state
    from ..catenary.answers.table import table
    from ..catenary.broken import told

    screen = console()
    found_form = done.form
    screen.print(f"{state(found_form.line)}; at rest {at_rest(found_form)}", soft_wrap=True)
    if done.broken_droppers:
        screen.print(told(done.broken_droppers), soft_wrap=True)
    for k, one in enumerate(found or _read(done, None)[0]):
        title = f"{done.recordings[k].name}, {one['speed'].value:.4g} km/h"
        screen.print(title, style="bold", soft_wrap=True)
        asked = acceptance(done, k, found=one)
        number = f"Pantograph {k + 1}" if len(done.recordings) > 1 else "Pantograph"
        screen.print(table(asked))
        screen.print(f"{number}: {verdict(asked)}", style="bold", soft_wrap=True)
        if footnote(one):
            screen.print(footnote(one), soft_wrap=True)
        known = {q.key for q in asked}
        screen.print(table(q for q in one.quantities if q.key not in known))
        for name, true, force in compared(measured[k]) if measured else ():
            text = f"measured: {name} {force:.1f} N, {force - true:+.2f} N from the true one"
            screen.print(text, soft_wrap=True)
    screen.print(
        f"real-time factor {done.real_time_factor:.3g}: {done.simulated_seconds:.3g} s simulated in "
        f"{done.cpu_seconds:.3g} s of CPU time",
        soft_wrap=True,
    )
