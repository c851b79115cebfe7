"""Jacobians of a run against Young's modulus: what Figs. 3 and 6 share."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import ancf

from ..viz import style
from .check import Check
from .curves import counted, look_of, points_of
from .references import SHORT, origin, reference
from .table import Table, Value

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .. import Newton, Result

COLUMNS = ("element", "f", "E", "jacobians", "newton_iterations", "steps", "status", "t_reached")
COMPLETE, FAILED = "complete", "failed"
ELEMENTS = 4
FACTOR = 3.0  # between counts of two implementations with the same limits
SIZE = (100.0, 76.0)  # mm


@dataclass(frozen=True, slots=True)
class Sweep:
    """Runs of one example with several f.

    Parameters
    ----------
    name : str
        Name of the figure.
    kinds : tuple of str
        Kinds of elements.
    factors : list of float
        Values of f.
    youngs_modulus : callable
        E in N/m^2 of f.
    run : callable
        The run with a kind of element and f.
    notes : list of str
        Assumptions; what is measured is added.

    """

    name: str
    kinds: tuple[str, ...]
    factors: list[float]
    youngs_modulus: Callable[[float], float]
    run: Callable[[str, float], Result]
    notes: list[str] = field(default_factory=list)

    def table(self) -> Table:
        """Run all and count; a run that the solver gives up is counted until there, with its message."""
        stopped: list[str] = []
        rows = [self._row(element, f, stopped) for element in self.kinds for f in self.factors]
        return Table(self.name, COLUMNS, rows, [*self.notes, *_measured(rows), *stopped])

    def _row(self, element: str, f: float, stopped: list[str]) -> tuple[Value, ...]:
        try:
            result, status = self.run(element, f), COMPLETE
        except ancf.SolveError as error:
            stopped.append(f"Not finished, {element}, f = {f}: {error}")
            result, status = error.result, FAILED
        stats = result.stats
        counts = (int(stats.jacobians), int(stats.newton_iterations), int(stats.steps))
        return (element, f, self.youngs_modulus(f), *counts, status, float(result.t[-1]))


def factors(low: float, high: float, count: int) -> list[float]:
    """Values of f from high to low, evenly spaced on a logarithmic axis, to four digits."""
    return [float(f"{high * (low / high) ** (i / (count - 1)):.4g}") for i in range(count)]


def count(table: Table, element: str, f: float) -> float:
    """Jacobians of a run; not a number where there is no such run or it was given up."""
    row = table.row(element=element, f=f)
    return math.nan if row is None or row["status"] != COMPLETE else float(row["jacobians"])


def counts(table: Table, example: str, cases: Iterable[tuple[str, float]]) -> list[Check]:
    """Counts of runs (element, f) within a factor of 3 of the references with the same contraction."""
    found = []
    for element, f in cases:
        key = f"jac.{example}.{SHORT[element]}.f{f:g}.theta{plain_newton().contraction:g}.tol1e-08"
        name = f"{example} {element}, f = {f:g}: Jacobians"
        where = origin(key) + "; two rules differ by up to a factor of 3"
        found.append(Check(name, count(table, element, f), reference(key), FACTOR, "", where, "factor"))
    return found


def plain_newton() -> Newton:
    """Modified Newton method as the paper knew it: a kept Jacobian is not turned with the nodes."""
    return ancf.Newton(tolerance=1e-10, contraction=0.5, corotate=False)


def rule(t_end: float) -> list[str]:
    """What the counts depend on, in words."""
    newton = plain_newton()
    return [
        f"{ELEMENTS} elements, {t_end:g} s. Modified Newton: the Jacobian is kept over iterations and steps, "
        f"and renewed when the contraction exceeds {newton.contraction:g} or after 8 iterations of a step; "
        f"a step ends when the estimated error left is below {newton.tolerance:g} of the length. A step that "
        "fails so is tried again with a new Jacobian for every iteration, then in parts. The package would "
        "turn a kept Jacobian with the nodes and need fewer; this is switched off (corotate=False).",
        "The paper states neither its rule nor its tolerance: compare the trend, not the counts.",
        f'A run that was given up has the status "{FAILED}"; its counts end at t_reached. The picture '
        "marks it by a cross at the upper edge, without a count.",
    ]


def draw(table: Table, figure: Figure) -> None:
    """Jacobians over E, both axes logarithmic; one Jacobian for every step would be the dotted line."""
    axes = figure.subplots()
    kinds = table.kinds()
    for element in kinds:
        only: dict[str, Value] = {"element": element, "status": COMPLETE}
        E, jacobians = (table.values(column, **only) for column in ("E", "jacobians"))
        axes.plot(E, jacobians, **points_of(element))
    steps = float(table.values("steps").max())
    axes.axhline(steps, color=style.GREY, linewidth=0.8, linestyle=":", label=f"one per step ({steps:.0f})")
    axes.set(
        xscale="log", yscale="log", xlabel=r"Young's modulus $E$ [N/m$^2$]", ylabel="Jacobians in the run"
    )
    _draw_stopped(table, axes)
    style.legend_above(figure, axes, columns=3)


def _draw_stopped(table: Table, axes: Axes) -> None:
    """A row of crosses for each kind of element above everything that was counted."""
    stopped = [e for e in table.kinds() if table.values("E", element=e, status=FAILED).size]
    if not stopped:
        return
    low, high = axes.get_ylim()
    axes.set_ylim(low, high * 2.5 ** (len(stopped) + 0.5))
    for i, (element, marker) in enumerate(zip(stopped, "x+1", strict=False)):
        E = table.values("E", element=element, status=FAILED)
        look: dict[str, Any] = {"color": look_of(element).color, "marker": marker, "linestyle": ""}
        axes.plot(E, [high * 2.5**i * 1.6] * E.size, **look, label=f"{element}, not finished")


def _measured(rows: list[tuple[Value, ...]]) -> list[str]:
    """Softest and stiffest finished run of each kind, in words."""
    notes = []
    for element in dict.fromkeys(row[0] for row in rows):
        mine = [row for row in rows if row[0] == element and row[6] == COMPLETE]
        mine.sort(key=lambda row: float(row[2]))
        for _, f, E, jacobians, iterations, steps, *_ in mine[:: max(1, len(mine) - 1)]:
            counts = f"{counted(int(jacobians), 'Jacobian')}, {iterations} Newton iterations, {steps} steps"
            notes.append(f"Measured, {element}, f = {f}, E = {E:.3g} N/m^2: {counts}.")
    return notes
