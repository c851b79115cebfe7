"""One style for all figures: sizes in mm as printed, colours that survive a grey copy, small plain type."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from ..errors import ModelError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM_PER_INCH = 25.4
DPI = 200

BLUE, ORANGE, GREEN, GREY, LIGHT = "#0060A8", "#D55E00", "#009E73", "#6B6B6B", "#B8B8B8"

#: Settings that matplotlib holds while a figure is made.
SETTINGS: dict[Any, Any] = {
    "font.size": 8.0,
    "axes.labelsize": 8.0,
    "axes.titlesize": 8.0,
    "xtick.labelsize": 7.0,
    "ytick.labelsize": 7.0,
    "legend.fontsize": 7.5,
    "mathtext.fontset": "dejavusans",
    "axes.linewidth": 0.6,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "axes.axisbelow": True,
    "grid.linewidth": 0.4,
    "grid.color": "#E2E2E2",
    "lines.linewidth": 1.2,
    "lines.markersize": 4.5,
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "xtick.minor.size": 1.2,
    "ytick.minor.size": 1.2,
    "xtick.minor.width": 0.4,
    "ytick.minor.width": 0.4,
    "legend.frameon": False,
    "legend.handlelength": 1.7,
    "legend.columnspacing": 1.2,
    "legend.borderaxespad": 0.2,
    "savefig.dpi": DPI,
}


def require_matplotlib() -> None:
    """Raise a ModelError that says what to install when matplotlib is missing."""
    try:
        import matplotlib  # noqa: F401
    except ImportError:
        raise ModelError("figures", "matplotlib is not installed", "pip install 'ancf[plot]'") from None


@contextmanager
def new_figure(width: float, height: float) -> Iterator[Figure]:
    """Empty figure of a size in mm, in the style of the package; needs no display."""
    require_matplotlib()
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context(SETTINGS):
        yield Figure(figsize=(width / MM_PER_INCH, height / MM_PER_INCH), layout="constrained")


def legend_above(figure: Figure, axes: Axes, columns: int = 4) -> None:
    """One legend above all panels, from the labels of one of them."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=min(columns, len(labels)))


def counts_on_x(axes: Axes, counts: list[int]) -> None:
    """Logarithmic axis of numbers of elements, each with its tick."""
    axes.set_xscale("log", base=2)
    axes.set_xticks(counts, [str(n) for n in counts])
    axes.set_xlabel("number of elements")


def panel_name(axes: Axes, name: str) -> None:
    """Bold letter at the upper left, above the axis of y."""
    axes.set_title(name, loc="left", x=-0.28, fontweight="bold")
