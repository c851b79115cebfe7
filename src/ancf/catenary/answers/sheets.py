"""What forms, runs and statistics say of themselves when they are printed."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...errors import ModelError
from ...model.tables import Sheet, Table, plural
from ..told import LINES, SHEETS
from .acceptance import acceptance
from .quantity import Quantity
from .state import at_rest, state
from .table import texts

if TYPE_CHECKING:
    from ...arrays import FloatArray
    from ..elasticity import Elasticity
    from ..forms.route_form import AnyForm
    from ..lines.line import Line
    from ..lines.route import Route
    from .run_data import Run
    from .statistics import Statistics

KMH, MM = 3.6, 1e3


def size_of(line: Line | Route) -> str:
    """Spans, droppers and length."""
    droppers = plural(int(line.dropper_x.size), "dropper")
    return f"{plural(len(line.spans), 'span')}, {droppers}, {line.length:g} m"


def of_form(found: AnyForm) -> Sheet:
    """A line at rest: state, tensions, droppers."""
    line = found.line
    droppers = ""
    if found.dropper_load.size:
        droppers = (
            f"{_range(found.dropper_load)} N, {_range(MM * found.dropper_natural)} mm long without force"
        )
    facts = [
        ("line", size_of(line)),
        ("state", state(line)),
        ("tensions", at_rest(found)),
        ("droppers", droppers),
        ("waves", f"{KMH * found.wave_speed:.0f} km/h on the contact wire"),
    ]
    return Sheet(f"{line.title or 'Overhead line'}, at rest", facts)


def line_of_form(found: AnyForm) -> str:
    """The same in a line."""
    title = f"{found.line.title!r}, " if found.line.title else ""
    return f"{type(found).__name__}({title}{size_of(found.line)}, {state(found.line)})"


def of_run(run: Run) -> Sheet:
    """A run: its line, its way, how long it took, and what the standards ask for of each pantograph."""
    line, (low, high) = run.form.line, run.window
    names = ", ".join(recording.name for recording in run.recordings)
    facts = [
        ("line", size_of(line)),
        ("state", f"{state(line)}; at rest {at_rest(run.form)}"),
        ("pantographs", names),
        ("evaluated", f"from {low:g} m to {high:g} m"),
        (
            "computed",
            f"{run.t[-1]:.4g} s in {len(run.t) - 1} steps, real-time factor {run.real_time_factor:.3g}",
        ),
    ]
    return Sheet(_title(run), facts, _tables(run))


def line_of_run(run: Run) -> str:
    """The same in a line."""
    low, high = run.window
    title = f"{run.form.line.title!r}, " if run.form.line.title else ""
    count = plural(len(run.recordings), "pantograph")
    return f"Run({title}{KMH * run.speed:.4g} km/h, {count}, {low:g} m to {high:g} m)"


def of_statistics(found: Statistics) -> Sheet:
    """All quantities of a pantograph."""
    return Sheet(found.pantograph, (), [_table(found.quantities)])


def line_of_statistics(found: Statistics) -> str:
    """Whose they are, and how many."""
    return f"Statistics({found.pantograph!r}, {plural(len(found), 'quantity', 'quantities')})"


def _title(run: Run) -> str:
    return f"{run.form.line.title or 'Overhead line'}, {KMH * run.speed:.4g} km/h"


def of_elasticity(found: Elasticity) -> Sheet:
    """How far each place gives, and how uneven that is, by the force."""
    heads = ("at [m]", *(f"{force:g} N [mm/N]" for force in found.force))
    rows = [
        (f"{x:.2f}", *(f"{e:.4f}" for e in values)) for x, values in zip(found.x, found.value.T, strict=True)
    ]
    ratios = zip(found.force, found.nonuniformity, strict=True)
    facts = [("non-uniformity", ", ".join(f"{100 * ratio:.1f} % at {force:g} N" for force, ratio in ratios))]
    return Sheet(f"Elasticity along span {found.span + 1}", facts, [Table(heads, rows, most=len(rows))])


def line_of_elasticity(found: Elasticity) -> str:
    """The same in a line."""
    return f"Elasticity(span {found.span + 1}, {_range(found.value)} mm/N)"


def _tables(run: Run) -> list[Table]:
    """A table for each pantograph; none of a run that does not cover its window."""
    try:
        return [_table(acceptance(run, k)) for k in range(len(run.recordings))]
    except ModelError:
        return []


def _table(rows: list[Quantity] | tuple[Quantity, ...]) -> Table:
    heads = ("quantity", "value", "unit", "accepted", "verdict", "tag")
    return Table(heads, [texts(q) for q in rows], most=len(rows))


def _range(values: FloatArray) -> str:
    return f"{np.min(values):.4g} to {np.max(values):.4g}"


def tell() -> None:
    """Let forms, runs, statistics and elasticities print by this module."""
    SHEETS.update({"Form": of_form, "RouteForm": of_form, "Run": of_run, "Statistics": of_statistics})
    SHEETS["Elasticity"], LINES["Elasticity"] = of_elasticity, line_of_elasticity
    LINES.update({"Form": line_of_form, "RouteForm": line_of_form})
    LINES.update({"Run": line_of_run, "Statistics": line_of_statistics})
