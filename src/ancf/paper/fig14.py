"""Fig. 14: contact force at the pan-head of example 7.5, at 32 m/s (a) and 45 m/s (b)."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray
from ..viz import style
from . import overhead
from .check import Check
from .table import Table, sampled_rows

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


TITLE = "Fig. 14: contact force at the pan-head"
EXAMPLE = "7.5"
CLAIM = (
    "The contact force at two speeds, from 100 N at standstill, oscillates strongly, as known from the "
    "literature. The joint carries no tension. The zigzag hardly matters for the force as a whole."
)
COLUMNS = ("speed", "t", "position", "force_raw", "force_20hz", "penalty_20hz")
SIZE = (170.0, 118.0)  # mm
OUTPUT_STEP = 1e-3  # s
DIGITS = 6  # of the numbers in the table
TOP = 300.0  # N, end of the axes: only single peaks next to the fixed end go beyond
RAW: dict[str, Any] = {"color": style.LIGHT, "linewidth": 0.5}


def data(short: bool = False) -> Table:
    """Contact force in N over time and track position, every 1 ms.

    The short form runs at 32 m/s along two sections.
    """
    table = Table("fig14", COLUMNS, [], [*overhead.NOTES, *_settings()])
    for speed in overhead.SPEEDS[:1] if short else overhead.SPEEDS:
        run = overhead.history(speed, short=short)
        soft = overhead.history(speed, "penalty", short)
        every = round(OUTPUT_STEP / float(run.t[1] - run.t[0]))
        recording = run.recordings[0]
        below = (overhead.measured(each).force for each in (run, soft))
        columns = (run.t, recording.position, recording.force, *below)
        table.rows.extend(sampled_rows((speed,), *(_rounded(x[::every]) for x in columns)))
        table.notes.extend([overhead.text(run), overhead.text(soft)])
        if not short:
            table.notes.append(_plane(speed))
    return table


def draw(table: Table, figure: Figure) -> None:
    """Force over the track, unfiltered and below 20 Hz; triangles are masts, ticks are droppers."""
    speeds = list(dict.fromkeys(table.values("speed").tolist()))
    panels = figure.subplots(len(speeds), sharex=True, sharey=True, squeeze=False)[:, 0]
    for axes, speed, name in zip(panels, speeds, "ab", strict=False):
        x, raw, below = (table.values(column, speed=speed) for column in COLUMNS[2:5])
        axes.axhline(
            overhead.pantograph().static_force,
            color=style.GREY,
            linewidth=0.6,
            linestyle="--",
            label="at standstill",
        )
        axes.plot(x, raw, label="unfiltered", **RAW)
        axes.plot(x, below, color=style.BLUE, linewidth=1.3, label="below 20 Hz")
        axes.set(ylabel="contact force [N]", xlim=(0.0, _end(x)))
        axes.set_title(f"{speed:g} m/s")
        axes.set_title(name, loc="left", x=-0.07, fontweight="bold")
        _mark_line(axes, _end(x))
    panels[0].set_ylim(0.0, TOP)
    panels[-1].set_xlabel("track position [m]")
    panels[-1].set_xticks(np.arange(0.0, _end(x) + 1.0, 30.0))
    style.legend_above(figure, panels[0], columns=5)


def _settings() -> list[str]:
    return [
        f"The pantograph starts {overhead.START:g} m from the first support, in static equilibrium with the "
        f"line, and has its full speed from then on; the run ends {overhead.LEFT:g} m before the last "
        f"support. Generalised-alpha, spectral radius 0.6, step {1e3 * overhead.STEP:g} ms (short form "
        f"{1e3 * overhead.SHORT_STEP:g} ms), Newton tolerance 1e-9 of the line's length.",
        "Contact: the paper's sliding joint without sideways force; vertically it only pushes, it loses and "
        "regains contact. force_raw is its force at every 1 ms, force_20hz the force of all steps through a "
        "Butterworth filter of order 6, forward and backward, 20 Hz. penalty_20hz is the same of another "
        "run, with a contact of 50 kN/m instead of the joint.",
        "A rigid joint passes on the impacts of droppers that come tight and of elements that it hands over "
        "to: the unfiltered peaks depend on mesh and step, the force below 20 Hz hardly does. The picture "
        f"ends at {TOP:g} N, which some peaks beside the last support exceed.",
        "The curves of the paper's Fig. 14 are not available as numbers, and depend on the missing data: "
        "what can be compared is their look and size.",
    ]


def _plane(speed: float) -> str:
    return (
        f"For comparison, {speed:g} m/s: an independent plane linear model of the line (penalty contact, "
        f"slack droppers) has a standard deviation of about {overhead.plane(speed)[1]:.0f} N below 20 Hz. It "
        "moves by some newtons with the place where the pantograph starts: the line is too short for a "
        "steady state. The zigzag, which that model lacks, takes 5 to 7 % off in this one."
    )


#: Share of the plane model's standard deviation by which this one may differ: it has a zigzag.
PLANE_BARS = {32.0: 0.1, 45.0: 0.16}


def checks(table: Table) -> list[Check]:
    """Mean force, the two contacts beside each other, and the plane model on the whole line.

    That the force does not pull is no check: it is recorded as the part of the multiplier that pushes.
    """
    speeds: list[float] = np.unique(table.values("speed")).tolist()
    return [check for speed in speeds for check in (_joint(table, speed), *_penalty(table, speed))]


def _joint(table: Table, speed: float) -> Check:
    """The short line has one section without a fixed end only."""
    whole, wanted = _inside(table, speed)[1], overhead.pantograph().static_force
    mean = _window(table, speed, "force_raw").mean()
    where = "balance of the pantograph; its lowest spring takes some newtons where the wire is lifted"
    return Check(f"{_name(speed)}: mean force", float(mean), wanted, 4.0 if whole else 6.0, "N", where)


def _penalty(table: Table, speed: float) -> list[Check]:
    joint, soft = (_window(table, speed, column) for column in ("force_20hz", "penalty_20hz"))
    where, sigma = "the same run with a penalty contact of 50 kN/m", "standard deviation below 20 Hz"
    found = [
        Check(f"{_name(speed)}: {sigma}, joint beside penalty", float(joint.std()), float(soft.std()),
              0.1 * float(soft.std()), "N", where),
        Check(f"{_name(speed)}: mean below 20 Hz, joint beside penalty", float(joint.mean()),
              float(soft.mean()), 0.5, "N", where),
    ]  # fmt: skip
    if _inside(table, speed)[1]:
        wanted, where = overhead.plane(speed)[1], f"{overhead.plane_origin()}; without zigzag"
        bar = PLANE_BARS[speed] * wanted
        found.append(Check(f"{_name(speed)}: {sigma}, penalty", float(soft.std()), wanted, bar, "N", where))
    return found


def _window(table: Table, speed: float, column: str) -> FloatArray:
    """Values of a column in the window."""
    inside: FloatArray = table.values(column, speed=speed)[_inside(table, speed)[0]]
    return inside


def _inside(table: Table, speed: float) -> tuple[Any, bool]:
    """Which rows of a speed are evaluated, and whether the run has passed the whole line."""
    x = table.values("position", speed=speed)
    low, high = overhead.WINDOW
    return (x >= low) & (x <= high), bool(x[-1] > high)


def _name(speed: float) -> str:
    return f"7.5, {speed:g} m/s"


def _rounded(values: FloatArray) -> FloatArray:
    """Numbers with few digits: the file stays small."""
    return np.round(values, DIGITS - 2)


def _end(x: FloatArray) -> float:
    """Last support that the run comes near, m."""
    return float(60.0 * np.ceil(x[-1] / 60.0))


def _mark_line(axes: Axes, end: float) -> None:
    """Masts as triangles with a thin line above, droppers as ticks, along the lower edge."""
    line, edge = overhead.line(), axes.get_xaxis_transform()
    masts, droppers = (x[x <= end + 1e-6] for x in (line.supports, line.dropper_x))
    look: dict[str, Any] = {"transform": edge, "clip_on": False, "linestyle": "none", "color": "black"}
    axes.vlines(masts, 0, 1, transform=edge, color=style.GREY, linewidth=0.6, zorder=0.5)
    axes.plot(masts, 0.0 * masts, marker="^", markersize=5, label="mast", zorder=5, **look)
    axes.plot(droppers, 0.0 * droppers, marker="|", markersize=5, label="dropper", zorder=5, **look)
    axes.grid(axis="x", visible=False)
