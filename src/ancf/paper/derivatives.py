"""Derivatives by numbers of models, beside differences of whole computations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ..viz import style
from .check import Check
from .derivative_cases import Question, questions
from .derivative_line import CASE, CHANGE, SPEED, of_line
from .differences import DECADES, ROUND_OFF, extrapolated, order, remainders
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TITLE = "Derivatives of equilibria, runs and modes by numbers of models"
EXAMPLE = ""
CLAIM = (
    "Not in the paper. The exact derivatives of all entries of an answer over all stored times, beside "
    "central differences of whole computations, which are extrapolated; and what is left of a change when "
    "the derivative is taken away, which falls with its square."
)
LEFT = tuple(f"left_{k}" for k in range(1, len(DECADES) + 1))
COLUMNS = (
    *("computation", "asked", "parameter", "derivative", "reference", "largest", "error", "accepted"),
    *("order", "change", *LEFT),
)
SIZE = (170.0, 120.0)  # mm
#: Largest error of a derivative as a share of the largest entry, and how far an order may be from 2.
BAR, SLOPE_BAR = 1e-7, 0.05
#: The same of a line, whose droppers slacken.
LINE_BAR = 1e-4
#: Largest change of a number for Taylor's remainders, as a share of it; less where differences need less.
WIDTH = 1e-2
LEAST = 1e-13  # of the axes: what is smaller is round-off

NOTES = [
    "derivative, reference: the entry of all, at all times, that differs most, per unit of the parameter "
    "(SI). largest: largest entry by differences, whose share the error is.",
    "left_1 to left_4: largest entry of f(p + h) - f(p) - h f'(p) as a share of f and h f'; h is the change, "
    "a share of p, a tenth, a hundredth and a thousandth of it. order: power of h of the decade that is "
    "farthest from 2; none where all is round-off.",
    "Runs: trapezoidal rule, Newton's method to round-off. Differences: five widths, each half of the one "
    "before, extrapolated (Romberg); the entry of the table that agrees best with its neighbours.",
    f"{CASE}: by the natural length of a dropper, through form finding, slack droppers and contact, beside "
    f"two runs with {1e6 * CHANGE:g} um more and less, so little that droppers slacken in the same order.",
]


def data(short: bool = False) -> Table:
    """All derivatives; the short form has the equilibrium and one run."""
    rows = [row for question in questions(short) for row in _rows(question)]
    return Table("derivatives", COLUMNS, [*rows, *([] if short else _line_rows())], [*NOTES])


def checks(table: Table) -> list[Check]:
    """Errors and orders of all derivatives."""
    rows = [dict[str, Any](zip(COLUMNS, values, strict=True)) for values in table.rows]
    return [check for row in rows for check in _checks(row)]


def _checks(row: dict[str, Any]) -> Iterator[Check]:
    name = f"{row['computation']}, {row['asked']}, by {row['parameter']}"
    by = "central differences of whole computations"
    by = by if row[LEFT[0]] is None else f"extrapolated {by}"
    yield Check(
        f"Derivative: {name}", row["derivative"], row["reference"], row["accepted"] * row["largest"], "", by
    )
    if row["order"] is not None:
        yield Check(f"Taylor remainder: {name}", row["order"], 2.0, SLOPE_BAR, "", "Taylor's theorem")


def draw(table: Table, figure: Figure) -> None:
    """Errors as dots, with the bar; remainders over the change, with the slope of 2."""
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.25))
    groups = list(dict.fromkeys(str(row[0]) for row in table.rows))
    for k, group in enumerate(groups):
        color = style.look(k).color
        rows = [row for row in table.rows if row[0] == group]
        errors = np.maximum([float(row[COLUMNS.index("error")]) for row in rows], LEAST)
        left.plot(errors, np.full(len(rows), k), linestyle="none", marker="o", markersize=3, color=color)
        for row in rows:
            if row[-1] is not None:
                change, *left_over = (float(x) for x in row[-len(LEFT) - 1 :])
                _remainders(right, change, left_over, color)
    accepted = [float(table.values("accepted", computation=group)[0]) for group in groups]
    rows_of = np.arange(len(groups))
    left.vlines(accepted, rows_of - 0.35, rows_of + 0.35, color="black", linewidth=1.2, label="accepted")
    left.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), fontsize=6.5)
    left.set(xscale="log", xlim=(0.5 * LEAST, 10 * LINE_BAR), xlabel="error of the derivative, relative")
    left.set_yticks(range(len(groups)), groups, fontsize=6.5)
    left.set_ylim(len(groups) - 0.5, -0.5)
    h = WIDTH * np.array(DECADES)
    right.plot(h, 100.0 * h**2, color="black", linewidth=0.8, linestyle="--", label="slope 2")
    right.set(xscale="log", yscale="log", xlabel="change of the parameter, relative")
    right.set_ylabel("what is left of the change, relative")
    right.legend(loc="lower left", bbox_to_anchor=(0.0, 1.0), fontsize=6.5)
    style.panel_name(left, "a")
    style.panel_name(right, "b")


def _remainders(axes: Axes, change: float, left: Sequence[float], color: Any) -> None:
    """Of one number, as far as they are no round-off."""
    pairs = [(change * h, x) for h, x in zip(DECADES, left, strict=True) if x > 10.0 * ROUND_OFF]
    if len(pairs) > 1:
        axes.plot(*zip(*pairs, strict=True), color=color, linewidth=0.8, marker=".", markersize=3)


def _rows(question: Question) -> Iterator[tuple[Any, ...]]:
    """A row for each number of a question."""
    _, slopes = question.compute(question.model, list(question.widths))
    for name, width in question.widths.items():

        def answer(model: Any) -> Any:
            return question.compute(model, ())[0]

        wanted, own = extrapolated(answer, question.model, name, width), slopes[name]
        off, largest = np.abs(own - wanted), float(np.max(np.abs(wanted)))
        place = np.unravel_index(np.argmax(off), np.shape(off))
        error = float(off[place]) / largest
        change = min(width, WIDTH)
        left = remainders(answer, question.model, name, own, change)
        numbers = float(own[place]), float(wanted[place]), largest, error, BAR, order(left), change
        yield question.name, question.asked, name, *numbers, *left


def _line_rows() -> Iterator[tuple[Any, ...]]:
    """Rows of the overhead line, without remainders."""
    for found in of_line():
        largest = abs(found.reference)
        error = abs(found.derivative - found.reference) / largest
        head = f"{CASE}, {SPEED:g} km/h", f"{found.asked} of the force", f"dropper {found.dropper}"
        numbers = found.derivative, found.reference, largest, error, LINE_BAR, None, CHANGE
        yield *head, *numbers, *[None] * len(LEFT)
