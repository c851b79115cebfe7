"""Fig. 7: tip displacement of the rotating beam (7.3) at 7 s against the number of elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import compare, convergence, kinds, spin_up
from .check import Check
from .curves import counted
from .references import SHORT, origin, reference
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Fig. 7: tip of the rotating beam against the number of elements"
EXAMPLE = "7.3"
CLAIM = (
    "The tip displacement at 7 s, in the frame of the clamp, over the number of elements: the new elements "
    "do better than the original one."
)
KINDS = kinds.KINDS
COUNTS, SHORT_COUNTS = (1, 2, 4, 8, 16, 32, 64), (1, 4, 16)
COLUMNS = ("element", "elements", "u_transverse", "u_axial")
TIME = 7.0  # s
#: Largest difference from the reference with the same mesh and step, m.
BARS = {kinds.CABLE: 3e-6, kinds.ORIGINAL: 1e-6, kinds.NONLOCKING: 1e-6}
NAMES = {"u_transverse": "transverse", "u_axial": "axial"}
SIZE = convergence.SIZE


def data(short: bool = False) -> Table:
    """Displacements at 7 s in the frame of the clamp, m; the short form has fewer meshes."""
    counts = SHORT_COUNTS if short else COUNTS
    rows = [_row(element, n) for element in KINDS for n in counts]
    measured = [
        f"Measured, {e}, {counted(n, 'element')}, t = {TIME:g} s: "
        f"u_transverse = {u:.7f} m, u_axial = {w:.7f} m."
        for e, n, u, w in rows
    ]
    return Table("fig7", COLUMNS, [*rows], [*spin_up.NOTES, convergence.NOTE, *measured])


def draw(table: Table, figure: Figure) -> None:
    """Transverse displacement, and how far both are from the finest mesh."""
    convergence.draw(table, figure, ("u_transverse", "transverse tip displ. at 7 s [m]"), NAMES)


def checks(table: Table) -> list[Check]:
    """Displacements beside the reference's, the limits of small steps and of fine meshes, and the trend."""
    found = [check for element in KINDS for n in (4, 16) for check in _same_mesh(table, element, n)]
    found += [check for n in (2, 4, 8) for check in _limit_of_steps(table, n)]
    found += [check for element in (kinds.CABLE, kinds.NONLOCKING) for check in _limit(table, element)]
    return [*found, _trend(table)]


def _same_mesh(table: Table, element: str, n: int) -> list[Check]:
    row, key = table.row(element=element, elements=n), f"7.3.{SHORT[element]}.n{n}.h1ms"
    if row is None:
        return []
    wanted = [reference(key)[name] for name in ("uy7", "ux7")]
    name = f"7.3 {element}, {n} elements, 7 s"
    return compare.numbers(name, compare.picked(row, NAMES), wanted, BARS[element], "m", origin(key))


def _limit_of_steps(table: Table, n: int) -> list[Check]:
    """Steps of 1 ms leave some 2e-6 m."""
    row, key = table.row(element=kinds.CABLE, elements=n), f"7.3.cable.n{n}_v0.step_converged.t7"
    if row is None:
        return []
    name = f"7.3 cable, {n} elements, 7 s, against the limit of small steps"
    return compare.numbers(name, compare.picked(row, NAMES), reference(key)[::-1], 5e-6, "m", origin(key))


def _limit(table: Table, element: str) -> list[Check]:
    """Sixteen elements beside the limit."""
    row, keys = table.row(element=element, elements=16), ("7.3.converged.uy7", "7.3.converged.ux7")
    if row is None:
        return []
    found, name = compare.picked(row, NAMES), f"7.3 {element}, 16 elements, 7 s, against the limit"
    return [
        Check(f"{name}: {text}", found[text], reference(key), bar, "m", origin(key))
        for text, key, bar in zip(found, keys, (5e-6, 2e-6), strict=True)
    ]


def _trend(table: Table) -> Check:
    """Errors of four elements against the limit."""
    limit = reference("7.3.converged.uy7")
    original, cable, nonlocking = (
        abs(float(table.values("u_transverse", element=element, elements=4)[0]) - limit)
        for element in (kinds.ORIGINAL, kinds.CABLE, kinds.NONLOCKING)
    )
    said = "the paper, section 7.3: the new elements do better; the factor of 10 is our bound"
    name = "7.3, 4 elements, 7 s: error, original over the larger of the two others"
    return Check(name, original / max(cable, nonlocking), 10.0, 0.0, "", said, "at least")


def _row(element: str, elements: int) -> tuple[str, int, float, float]:
    result = spin_up.run(spin_up.build(elements, element), TIME, output_step=TIME)
    transverse, axial = spin_up.tip_displacement(result)
    return element, elements, float(transverse[-1]), float(axial[-1])
