"""Make the pictures of the tutorials in docs/_static/tutorials from what the pages compute.

Run from the repository root: python docs/tutorial_pictures.py [NAMES]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path
from typing import Any

import numpy as np
from code_blocks import link_examples, run_page
from matplotlib.axes import Axes
from matplotlib.figure import Figure

import ancf
from ancf.viz import style

DOCS = Path(__file__).resolve().parent
TARGET = DOCS / "_static" / "tutorials"
WIDTH, HEIGHT = 165.0, 66.0  # mm
Names = dict[str, Any]


def shape(source: ancf.Result | ancf.State, beam: str, length: float, count: int = 81) -> np.ndarray:
    """Positions along a beam, (count, 3) or (count, n_t, 3)."""
    return np.array([source.position(f"{beam}.at({x})") for x in np.linspace(0, length, count)])


def cantilever(page: Names, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    result, shapes = page["result"], shape(page["result"], "rod", page["L"])
    for k in range(0, 801, 100):
        left.plot(*shapes[:, k, ::2].T, color=style.BLUE, alpha=0.3 + 0.7 * k / 800, linewidth=0.9)
    left.plot(*shape(page["rest"], "rod", page["L"])[:, ::2].T, color=style.ORANGE, linewidth=2)
    left.set(xlabel="x [m]", ylabel="z [m]", aspect="equal")
    right.plot(result.t, page["moment"], color=style.BLUE, label="let go")
    rest = page["rest"].bending_moment("rod.start")
    right.axhline(rest, color=style.ORANGE, linestyle="--", label="at rest")
    right.set(xlabel="time [s]", ylabel="moment at the clamp [N m]", ylim=(0, None))
    right.legend()


def pendulum(page: Names, figure: Figure) -> None:
    above, beside, right = figure.subplots(1, 3, width_ratios=(1, 1, 1.3))
    result, shapes = page["result"], shape(page["result"], "rope", 1.0, 41)
    for axes, j, name in ((above, 1, "y"), (beside, 2, "z")):
        axes.plot(page["tip"][:1001, 0], page["tip"][:1001, j], color=style.ORANGE, linewidth=0.8)
        for k in range(0, 1001, 125):
            axes.plot(*shapes[:, k, (0, j)].T, color=style.BLUE, alpha=0.3 + 0.7 * k / 1000, linewidth=0.9)
        axes.set(xlabel="x [m]", ylabel=f"{name} [m]", aspect="equal", xlim=(-1.05, 1.15), ylim=(-1.1, 1.0))
    right.plot(result.t, page["tension"], color=style.LIGHT, linewidth=0.6, label="no damping")
    right.plot(result.t, page["damped"].tension("rope.start"), color=style.BLUE, label="axial damping")
    right.axhline(0.05 * 9.81, color=style.ORANGE, linestyle="--", label="at rest")
    right.set(xlabel="time [s]", ylabel="tension at the hook [N]", ylim=(0, 2.4))
    right.legend(loc="upper right")


def mooring(page: Names, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    state = page["state"]
    for k in range(3):
        colour = style.BLUE if k else style.ORANGE
        left.plot(*shape(state, f"line {k + 1}", page["LENGTH"])[:, ::2].T, color=colour)
    left.plot(*state.position("buoy")[::2], "o", color="black", markersize=5)
    left.set(xlabel="x [m]", ylabel="z [m]", aspect="equal")
    for (period, (t, tension)), look in zip(page["histories"].items(), LOOKS, strict=True):
        late = t >= 3 * period
        right.plot(t[late] / period - 3, tension[late] / 1e3, label=f"{period} s", **look)
    right.set(xlabel="time / period", ylabel="tension at the fairlead [kN]")
    right.legend(title="swell of")


LOOKS: tuple[dict[str, Any], ...] = (
    {"color": style.GREEN, "linestyle": ":"},
    {"color": style.ORANGE, "linestyle": "--"},
    {"color": style.BLUE, "linestyle": "-"},
)


def sliding(page: Names, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    run, ride = page["run"], page["ride"]
    shapes, places = shape(run, "rope", page["LENGTH"]), run.position("trolley")
    for k in range(0, 2001, 400):
        shade = 0.35 + 0.65 * k / 2000
        left.plot(*shapes[:, k, ::2].T, color=style.BLUE, alpha=shade, linewidth=0.9)
        left.plot(*places[k, ::2], "o", color=style.ORANGE, alpha=shade)
    left.set(xlabel="x [m]", ylabel="z [m]")
    right.plot(ride.sensors.t, page["s"], color=style.BLUE)
    right.set(xlabel="time [s]", ylabel="place on the rope s [m]")


def overhead_line(page: Names, figure: Figure) -> None:
    left, right = figure.subplots(1, 2, width_ratios=(1.5, 1))
    _force(page, left)
    run = page["run"]
    support = int(np.argmin(abs(run.form.line.supports - 150.0)))
    since = run.t - np.interp(150.0, run.recordings[0].position, run.t)
    right.plot(since, 1e3 * run.uplift[:, support], color=style.BLUE)
    right.set(xlabel="time since the passing [s]", ylabel="lift of the support [mm]", xlim=(-1.5, 1.5))


def _force(page: Names, axes: Axes) -> None:
    run, found = page["run"], page["found"]
    recording, window = run.recordings[0], found.window
    axes.plot(recording.position[window], recording.force[window], color=style.LIGHT, label="unfiltered")
    axes.plot(recording.position[window], found.force[window], color=style.BLUE, label="below 20 Hz")
    places = [x for x in run.form.line.dropper_x if run.window[0] <= x <= run.window[1]]
    axes.plot(places, np.zeros(len(places)), "|", color="black", label="dropper")
    axes.set(xlabel="track position [m]", ylabel="contact force [N]", ylim=(0, None))
    axes.legend(ncols=3, loc="lower center", bbox_to_anchor=(0.5, 1.0))


def hoist(page: Names, figure: Figure) -> None:
    at_rest, lifted, right = figure.subplots(1, 3, width_ratios=(0.8, 0.8, 1.3))
    run = page["run"]
    length, angle = page["rope"].length, np.linspace(0, 2 * np.pi, 60)
    drawn = shape(run, "rope", length, 321)
    for axes, n, title in ((at_rest, 0, "at rest"), (lifted, -1, "lifted")):
        for k in range(1, 5):
            x, _, z = run.position(f"sheave {k}.centre")[n]
            axes.fill(x + 0.15 * np.cos(angle), z + 0.15 * np.sin(angle), color=style.LIGHT)
            rim = run.position(f"sheave {k}.at(0.15, 0, 0)")[n]
            axes.plot([x, rim[0]], [z, rim[2]], color="white")
        x, _, z = run.position("block.centre")[n]
        axes.plot(x, z, "s", color=style.ORANGE, markersize=7)
        axes.plot(*drawn[:, n, ::2].T, color=style.BLUE, linewidth=1.2)
        axes.set(title=title, xlabel="x [m]", ylabel="z [m]", aspect="equal")
    right.plot(run.sensors.t, page["pull"], color=style.BLUE, label="computed")
    right.plot(run.sensors.t, page["expected"], "--", color="black", label="by hand")
    right.set(xlabel="time [s]", ylabel="force of the hand [N]", ylim=(0.85 * page["by_hand"], None))
    right.legend()


def mooring_line(page: Names, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    moved, rough = page["moved"], page["rough"]
    shapes = shape(moved, "chain", 320.0)
    for k in range(600, 800, 25):
        left.plot(*shapes[:, k, ::2].T, color=style.LIGHT, linewidth=0.9)
    left.plot(*shape(page["rest"], "chain", 320.0)[:, ::2].T, color=style.BLUE, label="at rest")
    left.plot(*shape(page["hauled"], "chain", 320.0)[:, -1, ::2].T, color=style.ORANGE, label="hauled in")
    left.axhline(-100.0, color="black", linewidth=0.8)
    left.set(xlabel="x [m]", ylabel="z [m]")
    left.legend()
    right.plot(
        rough.sensors.t, rough.sensors.tension("chain.end") / 1e3, color=style.ORANGE, label="3 m in the sea"
    )
    right.plot(moved.t, moved.tension("chain.end") / 1e3, color=style.BLUE, label="2 m in calm water")
    right.set(xlabel="time [s]", ylabel="force at the fairlead [kN]")
    right.legend(ncols=2, loc="lower center", bbox_to_anchor=(0.5, 1.0))


def conductor(page: Names, figure: Figure) -> None:
    left, right = figure.subplots(1, 2)
    for name, colour, label in (("calm", style.BLUE, "calm"), ("blown", style.ORANGE, "25 m/s")):
        left.plot(*shape(page[name], "wire", 303.0)[:, 1:].T, color=colour, label=label)
    middle = page["swing"].position("wire.at(151.5)")
    left.plot(*middle[:, 1:].T, color=style.GREEN, linewidth=0.9, label="middle in the gust")
    left.set(xlabel="y [m]", ylabel="z [m]", aspect="equal")
    left.legend(loc="upper right")
    shaken, swing = page["shaken"], page["swing"]
    right.plot(shaken.t[page["late"]], page["lean"], color=style.LIGHT, label="turbulence")
    right.plot(swing.t, page["angle"], color=style.GREEN, label="gust")
    right.set(xlabel="time [s]", ylabel="lean of the span [deg]")
    right.legend()


#: Pictures and the pages that they belong to.
PICTURES = {
    "cantilever": ("cantilever", cantilever),
    "pendulum": ("pendulum", pendulum),
    "mooring": ("hanging_and_moored_cable", mooring),
    "sliding": ("sliding_joint", sliding),
    "overhead_line": ("overhead_line", overhead_line),
    "hoist": ("hoist", hoist),
    "mooring_line": ("mooring", mooring_line),
    "conductor": ("conductor", conductor),
}


def main(names: list[str]) -> None:
    TARGET.mkdir(parents=True, exist_ok=True)
    for name in names or PICTURES:
        page, draw = PICTURES[name]
        with tempfile.TemporaryDirectory() as folder:
            link_examples(Path(folder))
            found = run_page(DOCS / "tutorials" / f"{page}.md", Path(folder))
            with style.new_figure(WIDTH, HEIGHT) as figure:
                draw(found, figure)
                figure.savefig(TARGET / f"{name}.png")


if __name__ == "__main__":
    main(sys.argv[1:])
