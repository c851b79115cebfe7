"""Fig. 2: tip of the cantilever (7.1) at 0.4 s against the number of elements."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any

from . import cantilever, compare, convergence, kinds
from .check import Check
from .curves import counted
from .references import SHORT, exists, origin, reference
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Fig. 2: tip of the falling cantilever"
EXAMPLE = "7.1"
CLAIM = (
    "The tip at 0.4 s over the number of elements: the cable and the nonlocking element converge fast, the "
    "original element slowly."
)
KINDS = kinds.KINDS
COUNTS, SHORT_COUNTS = (1, 2, 4, 8, 16, 32, 64), (1, 4, 16)
COLUMNS = ("element", "elements", "tip_x", "tip_z")
SIZE = convergence.SIZE


def data(short: bool = False) -> Table:
    """Tip position at 0.4 s, m; z is the vertical."""
    counts = SHORT_COUNTS if short else COUNTS
    rows = [_row(element, n) for element in KINDS for n in counts]
    measured = [
        f"Measured, {e}, {counted(n, 'element')}: tip at ({x:.7f}, {z:.7f}) m." for e, n, x, z in rows
    ]
    return Table("fig2", COLUMNS, [*rows], [*cantilever.NOTES, convergence.NOTE, *measured])


def draw(table: Table, figure: Figure) -> None:
    """Vertical displacement, and how far both are from the finest mesh."""
    names = {"tip_z": "vertical", "tip_x": "horizontal"}
    convergence.draw(table, figure, ("tip_z", "vertical tip displacement [m]"), names)


def checks(table: Table) -> list[Check]:
    """Tips beside the reference's, the limit of fine meshes and small steps, and the trend of the paper."""
    found = [check for element in KINDS for n in (1, 4, 16, 64) for check in _tip(table, element, n)]
    found += [check for n in (4, 16, 64) for check in _limit_of_steps(table, n)]
    return [*found, *_trend(table)]


def _tip(table: Table, element: str, n: int) -> list[Check]:
    """Tip at 0.4 s; the cable's Newton iterations leave a little more than those of the beams."""
    row, key = table.row(element=element, elements=n), f"7.1.tip.{SHORT[element]}.n{n}.h0.25ms"
    if row is None or not exists(key):
        return []
    tolerance = 2e-7 if element == kinds.CABLE else 5e-8
    return compare.beside_reference(f"7.1 {element}, {counted(n, 'element')}", _named(row), key, tolerance)


def _limit_of_steps(table: Table, n: int) -> list[Check]:
    row, key = table.row(element=kinds.CABLE, elements=n), f"7.1.tip.cable.n{n}.step_converged"
    name = f"7.1 cable, {n} elements, against the limit of small steps"
    return [] if row is None else compare.beside_reference(name, _named(row), key, 5e-6)


def _trend(table: Table) -> list[Check]:
    """How far four and sixteen elements are from the limit."""
    limit = "7.1.tip.cable.n64.step_converged"
    far = {(e, n): _distance(table, e, n, limit) for e in KINDS for n in (4, 16)}
    where = origin(limit) + "; a hundredth of the beam's length is our bound"
    cases = ((kinds.CABLE, 4), (kinds.NONLOCKING, 4), (kinds.ORIGINAL, 16))
    near = [
        Check(
            f"7.1 {e}, {n} elements: distance of the tip from the limit",
            far[e, n],
            0.01,
            0.0,
            "m",
            where,
            "at most",
        )
        for e, n in cases
    ]
    ratio = far[kinds.ORIGINAL, 4] / far[kinds.NONLOCKING, 4]
    said = "the paper, section 7.1: the original element converges slowly; the factor of 10 is our bound"
    name = "7.1, 4 elements: distance from the limit, original over nonlocking"
    return [*near, Check(name, ratio, 10.0, 0.0, "", said, "at least")]


def _distance(table: Table, element: str, n: int, key: str) -> float:
    row = table.row(element=element, elements=n)
    return math.nan if row is None else math.dist((row["tip_x"], row["tip_z"]), reference(key))


def _named(row: dict[str, Any]) -> dict[str, float]:
    return compare.picked(row, {"tip_x": "tip x", "tip_z": "tip z"})


def _row(element: str, elements: int) -> tuple[str, int, float, float]:
    result = cantilever.run(cantilever.build(elements, element=element))
    x, _, z = result.position("beam.end")[-1].tolist()
    return element, elements, x, z
