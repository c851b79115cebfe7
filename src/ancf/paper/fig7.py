"""Fig. 7: tip displacement of the rotating beam (7.3) at 7 s against the number of elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import convergence, kinds, spin_up
from .curves import counted
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

KINDS = kinds.KINDS
COUNTS, SHORT_COUNTS = (1, 2, 4, 8, 16, 32, 64), (1, 2, 4)
COLUMNS = ("element", "elements", "u_transverse", "u_axial")
TIME, SHORT_TIME = 7.0, 0.7  # s
SIZE = convergence.SIZE


def data(short: bool = False) -> Table:
    """Displacements at 7 s in the frame of the clamp, m; the short form takes 0.7 s."""
    counts, t_end = (SHORT_COUNTS, SHORT_TIME) if short else (COUNTS, TIME)
    rows = [_row(element, n, t_end) for element in KINDS for n in counts]
    measured = [
        f"Measured, {e}, {counted(n, 'element')}, t = {t_end:g} s: "
        f"u_transverse = {u:.7f} m, u_axial = {w:.7f} m."
        for e, n, u, w in rows
    ]
    return Table("fig7", COLUMNS, [*rows], [*spin_up.NOTES, convergence.NOTE, *measured])


def draw(table: Table, figure: Figure) -> None:
    """Transverse displacement, and how far both are from the finest mesh."""
    names = {"u_transverse": "transverse", "u_axial": "axial"}
    convergence.draw(table, figure, ("u_transverse", "transverse tip displ. at 7 s [m]"), names)


def _row(element: str, elements: int, t_end: float) -> tuple[str, int, float, float]:
    result = spin_up.run(spin_up.build(elements, element), t_end, output_step=t_end)
    transverse, axial = spin_up.tip_displacement(result)
    return element, elements, float(transverse[-1]), float(axial[-1])
