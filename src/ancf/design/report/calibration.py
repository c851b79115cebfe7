"""The report of a calibration: parameters with their confidence, the histories and what is left."""

from __future__ import annotations

import datetime
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from ..._version import __version__
from ...files import write_text
from ...model.tables import plural
from ...viz import style
from ...viz.html import element, figure, page, pairs, section, table

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from matplotlib.figure import Figure

    from ..fit import Fit

#: Columns of the data that are drawn.
MOST_FIGURES = 24


def write_calibration(path: Path, fit: Fit, title: str = "") -> Path:
    """Write the report as one HTML file.

    Raises
    ------
    ModelError
        matplotlib is missing, or the file cannot be written.
    """
    style.require_matplotlib()
    title = title or "Calibration"
    parts = [
        section("Parameters", "parameters", _parameters(fit), *_correlation(fit)),
        section("Residuals", "residuals", _columns(fit), *_figures(fit)),
        section("Data", "data", pairs(_data(fit))),
    ]
    notes = [element("p", f"{note}.", class_="verdict") for note in fit.notes()]
    columns, parameters = plural(len(fit.measured), "column"), plural(len(fit.values), "parameter")
    head = f"{plural(fit.count, 'number')} in {columns}, {parameters}."
    day = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    foot = element("p", f"ancf {__version__}, {day}", class_="faint")
    top = [element("h1", title), element("p", head, class_="faint"), *notes]
    return write_text(path, page(title, *top, *parts, foot))


def _parameters(fit: Fit) -> Element:
    heads = ("parameter", "value", "standard error", "95 % confidence", "lower bound", "upper bound")
    intervals, rows = fit.confidence(), []
    for name, x in fit.values.items():
        low, high = intervals[name]
        within = f"{low:.6g} to {high:.6g}" if np.isfinite(high - low) else "not told"
        rows.append(
            [name, f"{x:.6g}", f"{fit.deviations[name]:.3g}", within, *map("{:g}".format, fit.bounds[name])]
        )
    return table(heads, rows, range(1, 6))


def _correlation(fit: Fit) -> list[Element]:
    if len(fit.values) < 2:
        return []
    rows = [
        [name, *("–" if not np.isfinite(x) else f"{x:.3f}" for x in row)]
        for name, row in zip(fit.names, fit.correlation, strict=True)
    ]
    return [element("h3", "Correlation"), table(["", *fit.names], rows, range(1, 1 + len(fit.names)))]


def _columns(fit: Fit) -> Element:
    rows = [
        [name, str(len(fit.measured[name])), f"{fit.rms[name]:.4g}", f"{fit.scales[name]:.4g}"]
        for name in fit.measured
    ]
    return table(("column", "numbers", "rms of the residuals", "divided by"), rows, range(1, 4))


def _figures(fit: Fit) -> list[Element]:
    made = []
    for k, name in enumerate([*fit.measured][:MOST_FIGURES]):
        with style.new_figure(style.TWO_COLUMNS, 70.0) as canvas:
            _draw(canvas, fit, name)
            svg = style.svg(canvas)
        caption = "Above: dots are measured, the line is the model. Below: model less data."
        made.append(figure(f"column-{k}", name, caption, svg))
    return made


def _draw(canvas: Figure, fit: Fit, name: str) -> None:
    above, below = canvas.subplots(2, 1, sharex=True, height_ratios=[2, 1])
    t = fit.t[name]
    size = 8.0 if len(t) < 100 else 3.0
    above.scatter(t, fit.measured[name], s=size, color=style.GREY, lw=0, label="measured")
    above.plot(t, fit.predicted[name], color=style.BLUE, lw=1.0, label="model")
    above.set_ylabel(name, fontsize=6)
    below.axhline(0.0, color=style.BLACK, lw=0.6)
    below.scatter(t, fit.residuals[name], s=size, color=style.ORANGE, lw=0)
    below.set_ylabel("residual")
    below.set_xlabel(style.axis_label("t"))
    style.legend_above(canvas, above)


def _data(fit: Fit) -> list[tuple[str, str]]:
    return [
        ("computations of the model", str(fit.evaluations)),
        ("search", fit.message),
        ("numbers less parameters", str(fit.freedom)),
    ]
