"""Fig. 13: the three-dimensional pantograph/catenary system of example 7.5, at rest."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray
from ..viz import style
from . import overhead
from .check import Check
from .table import Table, Value

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..catenary import Form

TITLE = "Fig. 13: the overhead line at rest"
EXAMPLE = "7.5"
CLAIM = (
    "Four sections of 60 m with a zigzag contact wire of 224 elements under a carrier, seven droppers in "
    "each, no stitch wires. All is in static equilibrium before the pantograph starts."
)
COLUMNS = ("part", "number", "x", "y", "z")
SIZE = (170.0, 196.0)  # mm
VIEW = {"elev": 22.0, "azim": -72.0}  # degrees
#: Enlargement of heights and of sideways distances against lengths along the track.
TALL, WIDE = 30.0, 40.0
LOOKS: dict[str, dict[str, Any]] = {
    "contact wire": {"color": style.BLUE, "linewidth": 1.6},
    "carrier": {"color": style.ORANGE, "linewidth": 1.3},
    "dropper": {"color": style.GREY, "linewidth": 0.8},
    "mast": {"color": "black", "linewidth": 1.3},
    "pantograph": {"color": style.GREEN, "linewidth": 1.8},
}
#: Of the axes, m, and places in the picture, mm.
SIDES, HEIGHTS, MARGIN = (-0.8, 0.8), (-0.75, 1.75), 3.0
LEFT, RIGHT, BOTTOM, GAP = 16.0, 4.0, 11.0, 13.0
SPACE, ZOOM = (-20.0, 115.0, 200.0, 82.0), 1.52
MAST_SIDE, MAST_FOOT, MAST_TOP = 0.55, -0.6, 1.65  # m, where the drawing puts a mast
BELOW = 0.35  # m, distance of the pantograph's masses in the drawing


def data(short: bool = False) -> Table:
    """Positions of the nodes in m; a dropper has its lower and its upper end, a mast both supports.

    The short form is the same: nothing is simulated.
    """
    form = overhead.form()
    rows: list[tuple[Value, ...]] = []
    for part, places in _parts(form):
        for number, place in enumerate(places, start=1):
            rows.extend((part, number, *point) for point in np.round(np.atleast_2d(place), 6).tolist())
    return Table("fig13", COLUMNS, rows, _notes(form))


def draw(table: Table, figure: Figure) -> None:
    """The system in space, and seen from the side and from above."""
    figure.set_layout_engine("none")
    _draw_space(figure, table)
    reach = np.ptp(table.values("x")) + 2.0 * MARGIN
    scale = (SIZE[0] - LEFT - RIGHT) / reach  # mm/m along the track
    low = BOTTOM
    for letter, across, limits, factor in (("c", 1, SIDES, WIDE), ("b", 2, HEIGHTS, TALL)):
        height = factor * scale * (limits[1] - limits[0])
        axes = _place(figure, (LEFT, low, scale * reach, height))
        _draw_flat(axes, table, across)
        view = "from the side, heights" if across == 2 else "from above, widths"
        axes.set_title(f"{view} enlarged {factor:g} times")
        axes.set_title(letter, loc="left", x=-0.07, fontweight="bold")
        axes.set(ylim=limits, ylabel=f"{'xyz'[across]} [m]", xlabel="x [m]" if across == 1 else "")
        low += height + GAP


def checks(table: Table) -> list[Check]:
    """Heights of the carrier at the droppers of the inner sections, each and its mirror images.

    Lengths, counts and places of the paper went in, and are no results.
    """
    ends = _points(table, "dropper").reshape(4, 7, 2, 3)[1:3]
    height = np.ptp(ends[..., 2], axis=2)
    where = f"{overhead.plane_origin()}; less the bend of the carrier over its hinges"
    found = []
    for k, wanted in enumerate(overhead.plane_heights()[:4]):
        value = float(np.mean([height[:, k], height[:, 6 - k]]))
        name = f"7.5 line, inner sections: carrier above dropper {k + 1}"
        found.append(Check(name, value, wanted - _bend(), 2e-3, "m", where))
    return found


def _bend() -> float:
    """How much lower a carrier that is hinged at the masts hangs than one that bends over them, m.

    It has the slope w L/(2 T) there, with the weight w of all that hangs on it, and a bend of the length
    (EI/T)^(1/2).
    """
    dropper = float(np.mean(overhead.plane_heights()))
    weight = 9.81 * (0.89 + 0.446 + 0.089 * dropper / 7.5)  # N/m
    tension, EI = 10e3, 150.0
    return float(0.5 * 60.0 * weight / tension * np.sqrt(EI / tension))


def _notes(form: Form) -> list[str]:
    short, long = form.dropper_natural.min(), form.dropper_natural.max()
    force = form.dropper_force
    return [
        *overhead.NOTES,
        "Rows: nodes of contact wire and carrier; lower and upper end of each dropper; the supports of "
        "contact wire and carrier at each mast; roof, frame, pan-head and the two ends of the strip.",
        f"The picture enlarges heights {TALL:g} times and widths {WIDE:g} times against lengths along the "
        f"track. Masts (drawn {MAST_SIDE:g} m beside the track) and the pantograph's masses ({BELOW:g} m "
        "apart) stand where the drawing wants them; the model has the supports of the wires and the vertical "
        "motion of the masses only.",
        f"Measured at rest: lengths of the droppers without force {short:.4f} to {long:.4f} m, their forces "
        f"{force.min():.1f} to {force.max():.1f} N.",
    ]


def _parts(form: Form) -> list[tuple[str, Any]]:
    """Each part with its places: (n, 3), or for each number several points."""
    contact, carrier = form.contact, form.messenger
    assert carrier is not None
    places = contact.position[contact.nodes.dropper], carrier.position[carrier.nodes.dropper]
    heights = form.contact_height, form.messenger_height  # of the clamps, not of the nodes
    clamps = [np.column_stack([p[:, :2], z]) for p, z in zip(places, heights, strict=True)]
    ends = list(zip(*clamps, strict=True))
    masts = [(contact.position[i], carrier.position[j]) for i, j in
             zip(contact.nodes.support, carrier.nodes.support, strict=True)]  # fmt: skip
    return [
        ("contact wire", contact.position),
        ("carrier", carrier.position),
        ("dropper", ends),
        ("mast", masts),
        ("pantograph", [_pantograph(form)]),
    ]


def _pantograph(form: Form) -> FloatArray:
    """Roof, frame, head and the ends of the strip (5, 3) at the start of the run."""
    x, half = overhead.START, 0.5 * overhead.pantograph().strip_length
    top = float(np.interp(x, form.contact.position[:, 0], form.contact.position[:, 2]))
    chain = [(x, 0.0, top - k * BELOW) for k in (2, 1, 0)]
    return np.array([*chain, (x, -half, top), (x, half, top)])


def _points(table: Table, part: str, number: int | None = None) -> FloatArray:
    """Positions (n, 3) of a part, or of one of its numbers."""
    only: dict[str, Value] = {"part": part} if number is None else {"part": part, "number": number}
    return np.column_stack([table.values(column, **only) for column in "xyz"])


def _lines(table: Table) -> list[tuple[str, FloatArray]]:
    """What is drawn: lines (n, 3) of each part."""
    lines = [(part, _points(table, part, n)) for part in ("mast", "dropper") for n in _numbers(table, part)]
    lines = [(part, _bracket(line)) if part == "mast" else (part, line) for part, line in lines]
    for part in ("carrier", "contact wire"):
        lines.append((part, _points(table, part)))
    unit = _points(table, "pantograph")
    return [*lines, ("pantograph", unit[:3]), ("pantograph", unit[3:])]


def _bracket(supports: FloatArray) -> FloatArray:
    """A mast beside the track with arms to the supports of contact wire and carrier."""
    below, above = supports
    x = below[0]
    side = [(x, MAST_SIDE, z) for z in (below[2] + 0.12, MAST_FOOT, MAST_TOP, above[2] + 0.06)]
    return np.array([below, *side, above])


def _numbers(table: Table, part: str) -> list[int]:
    return list(dict.fromkeys(table.values("number", part=part).astype(int).tolist()))


def _place(figure: Figure, box: tuple[float, float, float, float], **options: Any) -> Any:
    """Axes at a place in mm: left, bottom, width, height."""
    left, low, width, height = box
    place = (left / SIZE[0], low / SIZE[1], width / SIZE[0], height / SIZE[1])
    return figure.add_axes(place, **options)


def _draw_space(figure: Figure, table: Table) -> None:
    axes = _place(figure, SPACE, projection="3d", computed_zorder=False)
    seen: set[str] = set()
    for part, line in _lines(table):
        axes.plot(*line.T, label=None if part in seen else part, clip_on=False, **LOOKS[part])
        seen.add(part)
    chain = _points(table, "pantograph")[1:3]
    axes.plot(*chain.T, "s", color=LOOKS["pantograph"]["color"], markersize=4.0, clip_on=False)
    length = table.values("x").max()
    axes.set(xlim=(0.0, length), ylim=SIDES, zlim=HEIGHTS, xlabel="x [m]", ylabel="y [m]", zlabel="z [m]")
    axes.set_box_aspect((length, WIDE * np.ptp(SIDES), TALL * np.ptp(HEIGHTS)), zoom=ZOOM)
    axes.set_xticks(np.arange(0.0, length + 1.0, 60.0))
    axes.set_yticks([-0.5, 0.0, 0.5])
    axes.set_zticks([-0.5, 0.0, 0.5, 1.0, 1.5])
    axes.view_init(**VIEW)
    axes.xaxis.labelpad, axes.yaxis.labelpad, axes.zaxis.labelpad = 4.0, 0.0, -7.0
    axes.tick_params("both", pad=-2.0)
    figure.text(LEFT / SIZE[0] - 0.06, 1.0 - 12.0 / SIZE[1], "a", fontweight="bold")
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="upper center", ncols=len(labels))


def _draw_flat(axes: Axes, table: Table, across: int) -> None:
    """View from the side (2, heights) or from above (1, widths)."""
    for part, line in _lines(table):
        axes.plot(line[:, 0], line[:, across], **LOOKS[part])
    length = table.values("x").max()
    axes.set_xlim(-MARGIN, length + MARGIN)
    axes.set_xticks(np.arange(0.0, length + 1.0, 30.0))
