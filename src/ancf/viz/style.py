"""The one place of how figures look: sizes in mm as printed, colours, lines, markers, labels and units.

Curves differ by colour, dash and marker together, so that a grey copy and a colour-blind eye keep them
apart; ``tests/pictures/test_style.py`` measures it. What is drawn for orientation only is grey.
"""

from __future__ import annotations

import io
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, NamedTuple

from ..errors import ModelError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.colors import Colormap
    from matplotlib.figure import Figure

MM_PER_INCH = 25.4
DPI = 200
#: Above the highest marker, of the height of a panel.
ROOM = 0.05
#: Width of a figure in one column of a page, and across two, mm.
ONE_COLUMN, TWO_COLUMNS = 85.0, 170.0

#: Colours of curves, from a palette made for colour-blind readers (Okabe and Ito; Tol).
BLUE, ORANGE, GREEN, SKY, WINE, BLACK = "#0060A8", "#D55E00", "#009E73", "#56B4E9", "#882255", "#000000"
#: For orientation: thin lines and text, bands and paths, shaded intervals, the grid, faces of bodies.
GREY, LIGHT, SHADE, GRID, FACE = "#6B6B6B", "#B8B8B8", "#EDEDED", "#E2E2E2", "#E8EEF4"

#: Stops of the map from small to large values, dark to light; none is too light for a thin line on white.
SEQUENTIAL = (
    "#0d0887",
    "#43039e",
    "#6c00a8",
    "#920fa3",
    "#b32c8e",
    "#ce4b75",
    "#e4695e",
    "#f48948",
    "#fdae32",
)

#: Named colours of pages for a browser, on white and on a dark screen.
PAGE = {
    "paper": "#ffffff", "ink": "#1a1a1a", "grey": "#5c5c5c", "light": LIGHT, "grid": GRID, "shade": "#f4f6f8",
    "blue": BLUE, "orange": ORANGE, "green": GREEN, "bad": "#a33c00", "fine": "#00603f",
}  # fmt: skip
DARK = {
    "paper": "#15181c", "ink": "#e8eaed", "grey": "#a7adb4", "light": "#646b73", "grid": "#343a41",
    "shade": "#20252b", "blue": "#5aa9ea", "orange": "#ff9248", "green": "#3fcf9f", "bad": "#ffab80",
    "fine": "#6fdcb4",
}  # fmt: skip
#: LOOKS and SEQUENTIAL for a dark screen.
DARK_CURVES: tuple[str, ...] = (DARK["blue"], DARK["orange"], DARK["green"], "#9bd7ff", "#e58ac0", "#e8eaed")
DARK_SEQUENTIAL = (
    "#5b78e0",
    "#7f73e2",
    "#a06bd8",
    "#c065c4",
    "#da63a6",
    "#ee6a84",
    "#fa7f60",
    "#fd9f45",
    "#fcc63c",
)


class Look(NamedTuple):
    """How one of several curves is drawn."""

    color: str
    line: Any
    marker: str


#: One after the other for the curves of a figure.
LOOKS = (
    Look(BLUE, "-", "o"),
    Look(ORANGE, "--", "s"),
    Look(GREEN, (0, (5, 1.2, 1, 1.2)), "^"),
    Look(SKY, (0, (8, 2)), "D"),
    Look(WINE, ":", "v"),
    Look(BLACK, (0, (5, 1.2, 1, 1.2, 1, 1.2)), "x"),
)

#: Units of what can be asked of a state or a result, by the name of the question.
UNITS: dict[str, str | None] = {
    "t": "s",
    "input": None,  # each has its own
    "position": "m",
    "velocity": "m/s",
    "speed": "m/s",
    "tension": "N",
    "strain": "",
    "curvature": "1/m",
    "bending_moment": "N m",
    "torque": "N m",
    "twist": "rad",
    "energy": "J",
    "arc_length": "m",
    "arc_rate": "m/s",
    "normal_force": "N",
    "sliding_friction": "N",
    "multiplier": "N",
    "joint_force": "N",
    "joint_moment": "N m",
    "joint_angle": "rad",
    "joint_rate": "rad/s",
    "joint_angles": "rad",
    "joint_rates": "rad/s",
    "joint_displacement": "m",
    "joint_velocity": "m/s",
    "reaction": "N",
    "reaction_moment": "N m",
    "spring_force": "N",
    "spring_length": "m",
    "torsion_angle": "rad",
    "torsion_moment": "N m",
    "contact_force": "N",
    "contact_gap": "m",
    "friction_force": "N",
    "slipping": "",
    "frequency": "Hz",
}
#: Symbols that stand in labels instead of the name.
SYMBOLS = {
    "t": "$t$",
    "joint_force": "force of the joint",
    "joint_moment": "moment of the joint",
    "joint_angle": "angle of the joint",
    "joint_rate": "rate of the joint",
    "joint_angles": "angle of the joint",
    "joint_rates": "rate of the joint",
    "joint_displacement": "way of the joint",
    "joint_velocity": "velocity of the joint",
}

#: Settings that matplotlib holds while a figure is made and saved.
SETTINGS: dict[Any, Any] = {
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.5,
    "figure.labelsize": 8.0,
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.linewidth": 0.4,
    "grid.color": GRID,
    "lines.linewidth": 1.2,
    "lines.markersize": 4.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.size": 1.2,
    "ytick.minor.size": 1.2,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "legend.frameon": False,
    "legend.handlelength": 2.4,
    "legend.columnspacing": 1.2,
    "legend.borderaxespad": 0.2,
    "savefig.dpi": DPI,
    "svg.fonttype": "path",  # letters look the same everywhere
    "svg.hashsalt": "ancf",  # the same figure makes the same file
}


def require_matplotlib() -> None:
    """Raise a ModelError that says what to install when matplotlib is missing."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise ModelError("figures", "matplotlib is not installed", "pip install 'ancf[plot]'") from None


@contextmanager
def settings() -> Iterator[None]:
    """Let matplotlib draw and save in the style of the package."""
    require_matplotlib()
    from matplotlib import rc_context

    with rc_context(SETTINGS):
        yield


def set_ffmpeg(path: str) -> None:
    """Where matplotlib finds the program that writes movies, until the figure is done."""
    from matplotlib import rcParams

    rcParams["animation.ffmpeg_path"] = path


@contextmanager
def new_figure(width: float, height: float) -> Iterator[Figure]:
    """Empty figure of a size in mm, in the style of the package; needs no display."""
    with settings():
        from matplotlib.figure import Figure

        yield Figure(figsize=(width / MM_PER_INCH, height / MM_PER_INCH), layout="constrained")


def look(k: int) -> Look:
    """Look of curve k = 0, 1, ...; after one round the colours come again with other lines and markers."""
    turn, colour = divmod(k, len(LOOKS))
    other = LOOKS[(colour + turn) % len(LOOKS)]
    return Look(LOOKS[colour].color, other.line, other.marker)


def line(k: int) -> dict[str, Any]:
    """Colour and line of curve k, as arguments of ``Axes.plot``."""
    return {"color": look(k).color, "linestyle": look(k).line}


def colormap() -> Colormap:
    """Map of matplotlib for quantities along bodies, from SEQUENTIAL."""
    from matplotlib.colors import LinearSegmentedColormap

    return LinearSegmentedColormap.from_list("ancf", SEQUENTIAL)


def axis_label(quantity: str, component: str = "") -> str:
    """Label with unit: "tension [N]", "velocity x [m/s]", "strain [-]"; other names stay as they are."""
    if quantity not in UNITS:
        return quantity
    name, unit = SYMBOLS.get(quantity, quantity.replace("_", " ")), UNITS[quantity]
    named = f"{name} {component}" if component else name
    return named if unit is None else f"{named} [{unit or '-'}]"


def legend_above(figure: Figure, axes: Axes, columns: int = 4) -> None:
    """One legend above all panels, from the labels of one of them, each label once."""
    handles, labels = axes.get_legend_handles_labels()
    unique = dict(zip(labels, handles, strict=True))
    figure.legend(unique.values(), unique.keys(), loc="outside upper center", ncols=min(columns, len(unique)))


def counts_on_x(axes: Axes, counts: list[int]) -> None:
    """Logarithmic axis of numbers of elements, each with its tick."""
    axes.set_xscale("log", base=2)
    axes.set_xticks(counts, [str(n) for n in counts])
    axes.set_xlabel("number of elements")


def from_zero(axes: Axes) -> None:
    """Let y begin at 0, or at what is below it, with room above the highest marker."""
    low, high = min(0.0, axes.get_ylim()[0]), axes.get_ylim()[1]
    axes.set_ylim(low, high + ROOM * (high - low))


def panel_name(axes: Axes, name: str) -> None:
    """Bold letter at the upper left, above the axis of y."""
    axes.set_title(name, loc="left", x=-0.28, fontweight="bold")


def png(figure: Figure, dpi: float = DPI) -> bytes:
    """Figure as the bytes of a PNG file."""
    file = io.BytesIO()
    with settings():
        figure.savefig(file, format="png", dpi=dpi)
    return file.getvalue()


def svg(figure: Figure) -> str:
    """Figure as the text of an SVG picture."""
    file = io.BytesIO()
    with settings():
        figure.savefig(file, format="svg", metadata={"Date": None})
    return file.getvalue().decode("utf-8")
