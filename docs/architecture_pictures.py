"""Draw the two pictures of docs/architecture.md: ``python docs/architecture_pictures.py``."""

from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.axes import Axes

from ancf.viz import style

FOLDER = Path(__file__).parent / "_static"

#: From the top floor down: folders and files, what they hold; the same as in `tests/house/test_layers.py`.
FLOORS = (
    ("cli", "commands, terminal, folders of output"),
    ("design", "studies of many variants, in parallel"),
    ("paper", "the paper's exhibits"),
    ("cosimulation", "a model file as a unit of FMI"),
    ("mooring  reeving", "lines and ropes beside other programs"),
    ("validation", "numbers beside their references"),
    ("catenary", "overhead lines"),
    ("verification", "half the step, twice the elements"),
    ("viz", "scene → viewer, pictures, exports"),
    ("resumption", "a run that goes on where its file ends"),
    ("analysis", "equilibrium, simulate, modes"),
    ("sensitivity", "exact derivatives of equilibria, runs and modes"),
    ("control", "inputs, controllers, steps one by one"),
    ("preparation", "a model compiled, started, carried out"),
    ("compilation", "what is done while kernels are compiled"),
    ("results", "states, histories, files"),
    ("solvers", "steps, statics, eigenvalues"),
    ("system", "a model as flat arrays, numbered and ordered"),
    ("contact", "kernels of beams on surfaces"),
    ("connections  loads", "kernels of springs, joints, strips, moments"),
    ("elements  bodies  linalg", "kernels of elements, block factorisation"),
    ("model", "the description: bodies, kinds, integrators"),
    ("simd", "eight elements as one value in kernels"),
    ("batches", "batches of all kinds under one type"),
    ("records  operations", "batches and operations at an address"),
    ("vectors  words", "triples of numbers in kernels, where arrays are"),
    ("choices", "kernels by the type of what they take"),
    ("compiled", "kernels, and operations by type of batch"),
    ("kept", "code that kernels take in, for other processes"),
    ("asked  parts  addresses", "code that kernels take in or call"),
    ("files  worker  columns  garbage", "files that are complete or absent, processes"),
    ("errors  arrays  interrupts  later", "messages, arrays, signals, imports that wait"),
)
#: On the lowest floor too, but for the package alone.
UNSHOWN = ("_version", "kernel_cache", "reading")
#: One step: what is computed from what.
STEP = (
    ("Tables", "functions of time,\none row a step"),
    ("predict", "a extrapolated,\nq and v follow"),
    ("drive", "held unknowns,\nshadows of slopes"),
    ("residual", "batches add\nforces into r"),
    ("restrict, turn", "r in local axes,\nin the frame of J"),
    ("solve", "block L D Lᵀ,\nkept over steps"),
    ("update", "q, v, a;\nnorm → go on?"),
    ("finish", "energies, outputs,\nsensors, events"),
)


def box(axes: Axes, x: float, y: float, width: float, height: float, color: str) -> None:
    """A rounded box."""
    axes.add_patch(
        plt.matplotlib.patches.FancyBboxPatch(
            (x, y),
            width,
            height,
            boxstyle="round,pad=0.0,rounding_size=0.08",
            facecolor=color,
            edgecolor=style.GREY,
        )
    )


def floors() -> None:
    """The house: a floor imports from those below."""
    figure, axes = plt.subplots(figsize=(7.6, 6.6))
    for k, (name, what) in enumerate(reversed(FLOORS)):
        box(axes, 0.0, k, 14.2, 0.8, "white")
        axes.text(0.2, k + 0.38, name, va="center", family="monospace", fontsize=8.5, weight="bold")
        axes.text(6.6, k + 0.38, what, va="center", fontsize=8.5)
    axes.annotate(
        "", (14.7, 0.2), (14.7, len(FLOORS) - 0.4), arrowprops={"arrowstyle": "-|>", "color": style.BLUE}
    )
    axes.text(14.9, len(FLOORS) / 2, "imports", rotation=270, va="center", color=style.BLUE, fontsize=9)
    axes.set(xlim=(-0.1, 15.4), ylim=(-0.1, len(FLOORS)))
    save(figure, axes, "architecture_floors", "; ".join(name for name, _ in FLOORS))


def step() -> None:
    """One implicit step, in two rows."""
    figure, axes = plt.subplots(figsize=(6.8, 2.9))
    places = [(3.4 * (k % 4), 2.0 - 2.0 * (k // 4)) for k in range(len(STEP))]
    for (name, what), (x, y) in zip(STEP, places, strict=True):
        box(axes, x, y, 2.7, 1.2, "white")
        axes.text(x + 1.35, y + 0.92, name, ha="center", va="center", fontsize=9, weight="bold")
        axes.text(x + 1.35, y + 0.4, what, ha="center", va="center", fontsize=7.5)
    arrow = {"arrowstyle": "-|>", "color": style.BLUE}
    for row in (0, 4):
        for k in range(row, row + 3):
            (x, y), (z, _) = places[k], places[k + 1]
            axes.annotate("", (z, y + 0.6), (x + 2.7, y + 0.6), arrowprops=arrow)
    axes.plot([11.55, 11.55, 1.35], [2.0, 1.6, 1.6], color=style.BLUE, linewidth=1.0)
    axes.annotate("", (1.35, 1.2), (1.35, 1.62), arrowprops=arrow)
    back = {**arrow, "color": style.ORANGE}
    path = [8.15, 8.15, 13.3, 13.3, 12.95], [0.0, -0.45, -0.45, 2.6, 2.6]
    axes.plot(*path, color=style.ORANGE, linewidth=1.0)
    axes.annotate("", (12.9, 2.6), (13.32, 2.6), arrowprops=back)
    axes.text(10.7, -0.75, "not converged: residual anew", ha="center", color=style.ORANGE, fontsize=7.5)
    axes.set(xlim=(-0.1, 13.5), ylim=(-0.95, 3.3))
    save(figure, axes, "architecture_step", "; ".join(name for name, _ in STEP))


def save(figure: plt.Figure, axes: Axes, name: str, shows: str) -> None:
    """Write docs/_static/NAME.png, with what it shows as its description."""
    axes.set_axis_off()
    metadata = {"Description": shows}
    figure.savefig(FOLDER / f"{name}.png", dpi=160, bbox_inches="tight", metadata=metadata)
    plt.close(figure)


if __name__ == "__main__":
    floors()
    step()
