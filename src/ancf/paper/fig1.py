"""Fig. 1: modes 1 to 12 of the original element, and the six that the nonlocking one adds.

One nodal coordinate at a time is changed in the element of eq. 9: length 1 m, along x. Modes 13 to 24 are
modes 1 to 12 at the other node. Modes 25 to 30 are those of the internal r_yx and r_zx (eq. 15).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ..arrays import FloatArray
from ..elements.solid_shapes import shape
from ..viz import style
from .boxes import CORNERS, draw_box, draw_directions, draw_frame, eye
from .check import Check
from .curves import look_of
from .kinds import NONLOCKING, ORIGINAL
from .table import Table, Value

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TITLE = "Fig. 1: modes of the original and the nonlocking element"
EXAMPLE = ""
CLAIM = (
    "Each nodal coordinate by itself: axial modes, bending modes that are cubic along the axis, and modes of "
    "the section that are linear only, so that the section cannot follow the axis. That is why thin original "
    "elements lock; the nonlocking element adds modes that are quadratic along the axis."
)
LENGTH, WIDTH = 1.0, 0.3  # m, of the element and of its square section
LARGEST = 0.15  # m, displacement of a corner in the picture
STATIONS = 13  # along the element
SIZE = (170.0, 82.0)  # mm
COLUMNS = ("element", "mode", "vector", "component", "meaning", "change", "x", "y", "z", "X", "Y", "Z")

#: Vectors of the first node, and what changing x, y, z of each one does.
MEANINGS: dict[str, tuple[str, str, str]] = {
    "r": ("axial", "axis bends", "axis bends"),
    "r_x": ("axial", "axis bends", "axis bends"),
    "r_y": ("rotation, shear", "thickness", "torsion, shear"),
    "r_z": ("rotation, shear", "torsion, shear", "thickness"),
}
INTERNAL: dict[str, tuple[str, str, str]] = {
    "r_yx": ("inner rotation", "inner thickness", "inner torsion"),
    "r_zx": ("inner rotation", "inner torsion", "inner thickness"),
}

NOTES = [
    "Element of eq. 9: length 1 m, nodes at x = 0 and 1 m; drawn with a square section of 0.3 m, which the "
    "modes do not depend on. One coordinate of the first node is changed in each mode; modes 13 to 24 are "
    "the same at the second node.",
    f"The change is such that the corner that moves farthest moves by {LARGEST:g} m; it is in m for r, "
    "without unit for r_x, r_y, r_z, in 1/m for r_yx, r_zx. Points of the four long edges: x, y, z in the "
    "element, X, Y, Z where they are.",
    "Modes 25 to 30 are the inner coordinates r_yx and r_zx of the nonlocking element: nothing at the nodes, "
    "quadratic in between. With them the rotation of the section can follow the slope of the axis.",
]


class Mode(NamedTuple):
    """One coordinate of an element: its number from 1, its vector's column in the shape functions."""

    element: str
    number: int
    column: int
    vector: str
    component: int
    meaning: str


def modes() -> list[Mode]:
    """Modes 1 to 12 of the original element and 25 to 30 of the nonlocking one."""
    found = []
    for element, first, column, table in ((ORIGINAL, 1, 0, MEANINGS), (NONLOCKING, 25, 8, INTERNAL)):
        for i, (vector, meanings) in enumerate(table.items()):
            for k, meaning in enumerate(meanings):
                found.append(Mode(element, first + 3 * i + k, column + i, vector, k, meaning))
    return found


def data(short: bool = False) -> Table:
    """Points of the deformed long edges, m; the short form is the same, nothing is simulated."""
    rows = [row for mode in modes() for row in _rows(mode)]
    return Table("fig1", COLUMNS, rows, [*NOTES])


def draw(table: Table, figure: Figure) -> None:
    """One small drawing for each mode, in rows of six, with the undeformed outline."""
    panels = figure.subplots(3, 6).ravel()
    places = _places()
    for axes, mode in zip(panels, modes(), strict=True):
        X, Y, Z = (table.values(c, element=mode.element, mode=mode.number) for c in "XYZ")
        edges = np.stack([X, Y, Z], axis=-1).reshape(places.shape)
        draw_box(axes, edges, look_of(mode.element).color)
        draw_frame(axes, places)
        _finish(axes, mode)
    draw_directions(panels[0], np.array([0.8, 0.0, 0.29]), 0.13)
    _legend(figure)


def checks(table: Table) -> list[Check]:
    """Identities of the shape functions, from the points of the table alone.

    Sums of shapes with their mirror images, the shapes of the second node, are known fields. A unit
    translation of both nodes moves all by one. With r and r_x of a rotated rigid element the points turn,
    which stretches nothing. r_y of both nodes moves a point by its y. Inner shapes keep the ends.
    """
    x = _places()[0, :, 0]
    move, turn, section = (_factor(table, mode) for mode in (2, 5, 7))
    inner = np.array([_factor(table, mode) for mode in range(25, 31)])
    far = {
        "translation moves all points by one": move + move[:, ::-1] - 1.0,
        "rotation moves points by their distance": LENGTH * move[:, ::-1] + turn - turn[:, ::-1] - x,
        "constant r_y moves points by their y": section + section[:, ::-1] - _places()[:, :, 1],
        "inner modes leave both ends at rest": inner[..., [0, -1]],
        "inner modes leave the axis at rest": inner.mean(axis=1),
    }
    where = "identity of the shape functions"
    return [
        Check(f"Fig. 1: {name}", float(np.abs(gap).max()), 0.0, 1e-12, "", where) for name, gap in far.items()
    ]


def _factor(table: Table, mode: int) -> FloatArray:
    """Shape function (4, STATIONS) of a mode at the points of the long edges."""
    component = "xyz".index(next(str(row[3]) for row in table.rows if row[1] == mode))
    before, after = (table.values("xyzXYZ"[3 * i + component], mode=mode) for i in (0, 1))
    factor: FloatArray = (after - before) / table.values("change", mode=mode)
    return factor.reshape(4, STATIONS)


def _places() -> FloatArray:
    """Points (4, STATIONS, 3) of the undeformed long edges."""
    x = np.linspace(0.0, LENGTH, STATIONS)
    return np.array([[(s, 0.5 * WIDTH * y, 0.5 * WIDTH * z) for s in x] for y, z in CORNERS])


def _rows(mode: Mode) -> list[tuple[Value, ...]]:
    places = _places()
    xi = places[0, :, 0] / LENGTH
    factor = np.stack(
        [shape(mode.element, xi, LENGTH, float(y), float(z))[:, mode.column] for y, z in places[:, 0, 1:]]
    )
    change = LARGEST / float(np.abs(factor).max())
    moved = places.copy()
    moved[..., mode.component] += change * factor
    head = (mode.element, mode.number, mode.vector, "xyz"[mode.component], mode.meaning, change)
    points = np.concatenate([places, moved], axis=-1).reshape(-1, 6).tolist()
    return [(*head, *point) for point in points]


def _finish(axes: Axes, mode: Mode) -> None:
    """Same scale everywhere, no axes, number and meaning above."""
    corners = _places().reshape(-1, 3) @ eye()[:2].T
    low, high = corners.min(axis=0) - LARGEST, corners.max(axis=0) + LARGEST
    axes.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]), aspect="equal")
    axes.axis("off")
    name, _, derivatives = mode.vector.partition("_")
    vector = rf"\mathbf{{{name}}}" + (f"_{{{derivatives}}}" if derivatives else "")
    title = f"{mode.number}  {mode.meaning}\n${'xyz'[mode.component]}$ of ${vector}$"
    axes.set_title(title, fontsize=7.0, pad=2.0)


def _legend(figure: Figure) -> None:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    handles = [
        Patch(color=look_of(ORIGINAL).color, alpha=0.6, label="original, 24 coordinates (modes 1 to 12)"),
        Patch(color=look_of(NONLOCKING).color, alpha=0.6, label="added by nonlocking (modes 25 to 30)"),
        Line2D([], [], color=style.GREY, linestyle=(0, (3, 2)), linewidth=0.8, label="undeformed"),
    ]
    figure.legend(handles=handles, loc="outside upper center", ncols=3)
