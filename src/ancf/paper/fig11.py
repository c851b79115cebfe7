"""Fig. 11: path of the mass of the sliding beam (7.4) in the plane of y and z."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import trajectory
from .check import Check
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Fig. 11: path of the sliding beam's mass, seen from its end"
EXAMPLE, CLAIM = trajectory.EXAMPLE, trajectory.CLAIM
COLUMNS = trajectory.COLUMNS
SIZE = trajectory.SIZE


def data(short: bool = False) -> Table:
    """Positions of the mass in m and the arc length s of the joint in m, every 2 ms."""
    return trajectory.data("fig11", short)


def draw(table: Table, figure: Figure) -> None:
    """Z over Y of the mass; it starts at Y = 3 m, Z = 1 m."""
    trajectory.draw(table, figure, "y", "z")


def checks(table: Table) -> list[Check]:
    """Y of the mass and the place of the joint beside the references; x and z are judged in Fig. 10."""
    return trajectory.checks(table, "ys")
