"""Fig. 10: path of the mass of the sliding beam (7.4) in the plane of x and z."""

from __future__ import annotations

from typing import TYPE_CHECKING

from . import trajectory
from .check import Check
from .table import Table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

TITLE = "Fig. 10: path of the sliding beam's mass, seen from the side"
EXAMPLE, CLAIM = trajectory.EXAMPLE, trajectory.CLAIM
COLUMNS = trajectory.COLUMNS
SIZE = trajectory.SIZE


def data(short: bool = False) -> Table:
    """Positions of the mass in m and the arc length s of the joint in m, every 2 ms."""
    return trajectory.data("fig10", short)


def draw(table: Table, figure: Figure) -> None:
    """Z over X of the mass; it starts at X = 1 m, Z = 1 m."""
    trajectory.draw(table, figure, "x", "z")


def checks(table: Table) -> list[Check]:
    """X and z of the mass beside the references, and the two finest meshes beside each other."""
    return [*trajectory.checks(table, "xz"), trajectory.agreement(table)]
