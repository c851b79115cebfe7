"""Validation: a reference case of a standard, run and compared with the published ranges."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .._version import __version__
from ..errors import ModelError
from ..model import checks
from ..model.checks import positive
from .answers.references import (
    REFERENCE,
    SECOND_FILTER,
    Reference,
    filter_note,
    reference_case,
    second_reading,
)
from .answers.statistics import Statistics, statistics
from .answers.write import summary, write_json, write_run
from .elasticity import elasticity_beside

if TYPE_CHECKING:
    from .answers.quantity import Quantity
    from .answers.run_data import Run
    from .lines.line import Line


def middle_spans(line: Line, count: int) -> tuple[float, float]:
    """Track interval of some spans in the middle of a line, m; of two middles the earlier one.

    Raises
    ------
    ModelError
        The line has not so many spans besides its two end spans.

    """
    spans = len(line.spans)
    if not 1 <= count <= spans - 2:
        what = f"cannot evaluate {count} of {spans} spans: the end spans are not evaluated"
        raise ModelError("window", what, "take a longer line")
    first = (spans - count) // 2
    return float(line.supports[first]), float(line.supports[first + count])


def reference_run(case: str, speed_kmh: float, progress: Callable[[Any], None] | None = None) -> Run:
    """Run a reference case at a speed.

    Parameters
    ----------
    case : str
        Name of a reference case, ``en50318-2002``.
    speed_kmh : float
        Any speed; there are ranges for some only.
    progress : callable, optional
        Called as that of `ancf.simulate`.

    Raises
    ------
    ModelError
        There is no such case, or the speed is not a positive number.

    """
    chosen = reference_case(case)
    speed = positive(speed_kmh, "speed") / 3.6
    from .lines.catalogue import read_line
    from .lines.line import Line
    from .run import run

    line = read_line(chosen.line)
    assert isinstance(line, Line)
    window = middle_spans(line, chosen.spans)
    return run(line, speed=speed, pantograph=chosen.pantograph, window=window, progress=progress)


def validation(run: Run, reference: Reference, found: Statistics) -> dict[str, Any]:
    """What ``validate.json`` holds: case, speed, real-time factor, rows, and all about the run.

    ``all_inside`` is null at a speed without ranges; ``note`` says so then. ``second_filter`` has the
    verdicts with a filter of another order.
    """
    rows, again = reference.compare(found, run.speed_kmh), second_reading(run, reference)
    return {
        "case": reference.name,
        "speed_kmh": round(run.speed_kmh, 6),
        "real_time_factor": run.real_time_factor,
        "filter": found.filter.text,
        "rows": [q.row for q in rows],
        "all_inside": _all_inside(rows),
        "second_filter": {
            "filter": SECOND_FILTER.text,
            "rows": [q.row for q in again],
            "all_inside": _all_inside(again),
            "note": filter_note(rows, again),
        },
        "note": reference.note(run.speed_kmh),
        "source": reference.source,
        "ancf": __version__,
        "run": summary(run, [found]),
    }


def _all_inside(rows: list[Quantity]) -> bool | None:
    judged = [q.inside for q in rows if q.inside is not None]
    return all(judged) if judged else None


def write_validation(run: Run, reference: Reference, folder: str | Path, report: bool = True) -> list[Path]:
    """Write ``validate.json``, the CSV files of the run and ``report.html``.

    Parameters
    ----------
    run : Run
    reference : Reference
    folder : str or Path
        Made when it does not exist.
    report : bool
        Whether the report is written, which needs matplotlib.

    Returns
    -------
    list of Path
        The files written.

    """
    checks.kind(reference, "write_validation.reference", Reference, REFERENCE)
    folder, found = checks.path(folder, "write_validation.folder"), statistics(run)
    files = [write_json(validation(run, reference, found), folder / "validate.json")]
    files += write_run(run, folder, [found])
    if report:
        from .report import write_report

        gives = elasticity_beside(run.form.line)
        files.append(gives.save(folder / "elasticity.csv"))
        files.append(write_report(run, folder / "report.html", reference=reference, elasticity=gives))
    return files
