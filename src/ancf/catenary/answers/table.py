"""Statistics as a table on a screen."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from .quantity import shown, shown_limits, verdict

if TYPE_CHECKING:
    from rich.table import Table

    from .quantity import Quantity

#: Heads of the columns, and how each is aligned.
COLUMNS = (
    ("quantity", "left"),
    ("value", "right"),
    ("unit", "left"),
    ("accepted", "right"),
    ("", "left"),
    ("tag", "left"),
)
STYLES = {True: "green", False: "bold red", None: ""}


def table(quantities: Iterable[Quantity]) -> Table:
    """Table for `rich`: value, unit, accepted range, whether it is inside, tag."""
    from rich.table import Table
    from rich.text import Text

    made = Table(box=None, pad_edge=False, padding=(0, 2, 0, 0), header_style="bold")
    for head, side in COLUMNS:
        made.add_column(head, justify="right" if side == "right" else "left", overflow="fold")
    for q in quantities:
        made.add_row(*texts(q)[:4], Text(verdict(q), style=STYLES[q.inside]), q.tag or "")
    return made


def texts(quantity: Quantity) -> tuple[str, str, str, str, str, str]:
    """Cells of one row."""
    q = quantity
    unit = "" if q.unit == "count" else q.unit
    return q.name, shown(q.value, q.unit), unit, shown_limits(q), verdict(q), q.tag or ""
