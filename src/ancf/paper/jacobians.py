"""Jacobians of a run against Young's modulus: what Figs. 3 and 6 share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import ancf

from ..viz import style
from .curves import counted, points_of
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ancf import Newton, Result

COLUMNS = ("element", "f", "E", "jacobians", "newton_iterations", "steps")
ELEMENTS = 4
SIZE = (88.0, 68.0)  # mm


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
        Assumptions.

    """

    name: str
    kinds: tuple[str, ...]
    factors: list[float]
    youngs_modulus: Callable[[float], float]
    run: Callable[[str, float], Result]
    notes: list[str]

    def table(self) -> Table:
        """Run all and count."""
        rows = [self._row(element, f) for element in self.kinds for f in self.factors]
        return Table(self.name, COLUMNS, rows, [*self.notes, *_measured(rows)])

    def _row(self, element: str, f: float) -> tuple[str | int | float, ...]:
        stats = self.run(element, f).stats
        counts = (int(stats.jacobians), int(stats.newton_iterations), int(stats.steps))
        return (element, f, self.youngs_modulus(f), *counts)


def factors(low: float, high: float, count: int) -> list[float]:
    """Values of f from high to low, evenly spaced on a logarithmic axis, to four digits."""
    return [float(f"{high * (low / high) ** (i / (count - 1)):.4g}") for i in range(count)]


def plain_newton() -> Newton:
    """Modified Newton method as the paper knew it: a kept Jacobian is not turned with the nodes."""
    return ancf.Newton(tolerance=1e-10, contraction=0.5, corotate=False)


def rule(t_end: float) -> list[str]:
    """What the counts depend on, in words."""
    newton = plain_newton()
    return [
        f"{ELEMENTS} elements, {t_end:g} s. Modified Newton: the Jacobian is kept over iterations and steps, "
        f"and renewed when the contraction exceeds {newton.contraction:g} or after 8 iterations of a step; "
        f"a step ends when the estimated error left is below {newton.tolerance:g} of the length. The package "
        "would turn a kept Jacobian with the nodes and need fewer; this is switched off (corotate=False).",
        "The paper states neither its rule nor its tolerance: compare the trend, not the counts.",
    ]


def draw(table: Table, figure: Figure) -> None:
    """Jacobians over E, both axes logarithmic; every step would be the upper line."""
    axes = figure.subplots()
    for element in table.kinds():
        E, jacobians = (table.values(column, element=element) for column in ("E", "jacobians"))
        axes.plot(E, jacobians, **points_of(element))
    steps = float(table.values("steps").max())
    axes.axhline(steps, color=style.GREY, linewidth=0.8, linestyle=":", label=f"one per step ({steps:.0f})")
    axes.set(
        xscale="log", yscale="log", xlabel=r"Young's modulus $E$ [N/m$^2$]", ylabel="Jacobians in the run"
    )
    style.legend_above(figure, axes)


def _measured(rows: list[tuple[str | int | float, ...]]) -> list[str]:
    """Softest and stiffest run of each kind, in words."""
    notes = []
    for element in dict.fromkeys(row[0] for row in rows):
        mine = sorted((row for row in rows if row[0] == element), key=lambda row: float(row[2]))
        for _, f, E, jacobians, iterations, steps in (mine[0], mine[-1]):
            counts = f"{counted(int(jacobians), 'Jacobian')}, {iterations} Newton iterations, {steps} steps"
            notes.append(f"Measured, {element}, f = {f}, E = {E:.3g} N/m^2: {counts}.")
    return notes
