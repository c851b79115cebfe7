"""The figures of the report, for one output each."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...viz import style
from ..statistics import column, drawn_rows, exceedance, label_of, parameters_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from pandas import DataFrame

#: Panels of scattered points, parameters in bars, dots in a panel.
MOST_PANELS, MOST_BARS, MOST_DOTS = 9, 20, 3000
PANEL = (56.0, 46.0)  # mm
Draw = Callable[["Figure", "DataFrame", dict[str, Any], str], None]


@dataclass(frozen=True)
class FigureKind:
    """One figure of an output.

    Parameters
    ----------
    title, caption : str
    size : callable
        Width and height, mm, by the number of parameters.
    draw : callable
    shown : callable
        Whether an output has it.
    """

    title: str
    caption: str
    size: Callable[[int], tuple[float, float]]
    draw: Draw
    shown: Callable[[Any, dict[str, Any], str], bool]


def picture(key: str, table: DataFrame, found: dict[str, Any], name: str) -> str:
    """SVG of a figure."""
    kind = FIGURES[key]
    with style.new_figure(*kind.size(len(parameters_of(table)))) as figure:
        kind.draw(figure, table, found, name)
        return style.svg(figure)


def _varies(table: DataFrame, found: dict[str, Any], name: str) -> bool:
    values = column(table, name)
    good = values[np.isfinite(values)]
    return len(good) > 1 and bool(np.ptp(good) > 0.0)


def _drawn(table: DataFrame, found: dict[str, Any], name: str) -> bool:
    return "percentiles" in found["outputs"][name] and _varies(table, found, name)


def _affected(table: DataFrame, found: dict[str, Any], name: str) -> bool:
    return any(row["bins"] for row in found["effects"][name].values())


def _compared(table: DataFrame, found: dict[str, Any], name: str) -> bool:
    """Whether there are several parameters, whose effects may be compared: of one its cases say all."""
    return len(parameters_of(table)) > 1 and _affected(table, found, name)


def _averaged(table: DataFrame, found: dict[str, Any], name: str) -> bool:
    """Whether there are several parameters, or several cases with one value, to take means of."""
    own = parameters_of(table)
    repeated = any(table[key].duplicated().any() for key in own)
    return (len(own) > 1 or repeated) and _affected(table, found, name)


def _with_indices(method: str) -> Callable[[Any, dict[str, Any], str], bool]:
    return lambda table, found, name: bool(found.get(method, {}).get(name, {}).get("indices"))


def _distribution(figure: Figure, table: DataFrame, found: dict[str, Any], name: str) -> None:
    values = column(table, name)[drawn_rows(table)]
    good = values[np.isfinite(values)]
    left, right = figure.subplots(1, 2)
    left.hist(good, bins=min(60, max(8, int(np.sqrt(len(good))))), color=style.SKY, edgecolor="white", lw=0.3)
    mean = found["outputs"][name]["mean"]
    left.axvline(mean, color=style.BLACK, lw=1.0)
    left.set_xlabel(label_of(table, name))
    left.set_ylabel("cases")
    ordered, above, low, high = exceedance(values)
    right.fill_between(ordered, low, high, step="post", color=style.LIGHT, alpha=0.6, lw=0)
    right.step(ordered, above, where="post", color=style.BLUE)
    right.set_yscale("log")
    right.set_ylim(0.3 / len(ordered), 1.3)
    right.set_xlabel(label_of(table, name))
    right.set_ylabel("share of cases above")


def _scatter(figure: Figure, table: DataFrame, found: dict[str, Any], name: str) -> None:
    y = column(table, name)
    good = np.flatnonzero(np.isfinite(y))[:MOST_DOTS]
    for axes, key in zip(*_panels(figure, table, found, name), strict=False):
        x = _numeric(axes, table[key].to_numpy()[good])
        size = 6.0 if len(good) < 500 else 2.0
        axes.scatter(x, y[good], s=size, color=style.BLUE, alpha=0.6, lw=0)
        if len(parameters_of(table)) == 1 and len(np.unique(x)) == len(x):  # a curve
            order = np.argsort(x)
            axes.plot(x[order], y[good][order], color=style.BLUE, lw=0.8)
        axes.set_xlabel(label_of(table, key))
        axes.set_ylabel(label_of(table, name))


def _effects(figure: Figure, table: DataFrame, found: dict[str, Any], name: str) -> None:
    panels, names = _panels(figure, table, found, name)
    for axes, key in zip(panels, names, strict=False):
        rows = found["effects"][name][key]["bins"]
        at = _numeric(axes, np.array([row["at"] for row in rows], dtype=object))
        means, errors = [row["mean"] for row in rows], [row["error"] or 0.0 for row in rows]
        axes.errorbar(at, means, yerr=errors, color=style.BLUE, marker="o", ms=3, capsize=2, lw=1.0)
        axes.set_xlabel(label_of(table, key))
        axes.set_ylabel(f"mean of {label_of(table, name)}")
        axes.set_title(_explains(found["effects"][name][key]), fontsize=7)
    low = min(axes.get_ylim()[0] for axes in panels[: len(names)])
    high = max(axes.get_ylim()[1] for axes in panels[: len(names)])
    for axes in panels[: len(names)]:
        axes.set_ylim(low, high)


def _explains(effect: dict[str, Any]) -> str:
    """What a parameter explains; of an effect that the cases cannot tell from chance what that explains."""
    if effect["share"] == 0.0 < effect["chance"]:
        return f"not told from chance ({_percent(effect['chance'])})"
    return f"{_percent(effect['share'])} of the variance"


def _percent(share: float) -> str:
    """Of 100 in whole numbers, of 1 in tenths; what is no more than round-off is 0."""
    if share < 1e-12:
        return "0 %"
    if share < 0.0005:
        return "< 0.1 %"
    return f"{100.0 * share:.1f} %" if share < 0.0995 else f"{100.0 * share:.0f} %"


def _tornado(figure: Figure, table: DataFrame, found: dict[str, Any], name: str) -> None:
    rows = []
    for key in _ranked(table, found, name)[:MOST_BARS]:
        bins = found["effects"][name][key]["bins"]
        rows.append((key, bins[0]["mean"], bins[-1]["mean"]))
    rows.sort(key=lambda row: abs(row[2] - row[1]))
    axes = figure.subplots()
    middle = found["outputs"][name]["mean"]
    places = np.arange(len(rows))
    for k, (label, colour) in enumerate((("lowest values", style.SKY), ("highest values", style.ORANGE)), 1):
        axes.barh(
            places, [row[k] - middle for row in rows], left=middle, color=colour, height=0.6, label=label
        )
    axes.axvline(middle, color=style.BLACK, lw=0.8)
    axes.set_yticks(places, [row[0] for row in rows])
    axes.set_xlabel(f"mean of {label_of(table, name)}")
    axes.grid(axis="y", visible=False)
    style.legend_above(figure, axes)


def _sobol(figure: Figure, table: DataFrame, found: dict[str, Any], name: str) -> None:
    rows = sorted(found["saltelli"][name]["indices"].items(), key=lambda item: -item[1]["ST"])[:MOST_BARS]
    axes = figure.subplots()
    places = np.arange(len(rows))
    for shift, key, label, colour in (
        (-0.2, "S1", "first order", style.BLUE),
        (0.2, "ST", "total", style.ORANGE),
    ):
        values, half = [row[key] for _, row in rows], [row[f"{key}_conf"] for _, row in rows]
        axes.bar(
            places + shift,
            values,
            0.36,
            yerr=half,
            color=colour,
            label=label,
            capsize=2,
            error_kw={"lw": 0.8},
        )
    axes.set_xticks(places, [key for key, _ in rows], rotation=0 if len(rows) < 6 else 40)
    axes.set_ylabel("Sobol' index")
    axes.grid(axis="x", visible=False)
    style.legend_above(figure, axes)


def _morris(figure: Figure, table: DataFrame, found: dict[str, Any], name: str) -> None:
    axes = figure.subplots()
    for k, (key, row) in enumerate(found["morris"][name]["indices"].items()):
        look = style.look(k)
        point = {"color": look.color, "marker": look.marker, "ls": "", "label": key, "capsize": 2}
        axes.errorbar(row["mu_star"], row["sigma"], xerr=row["mu_star_conf"], **point)
    axes.set_xlabel(f"mean size of the effects µ* on {label_of(table, name)}")
    axes.set_ylabel(f"their deviation σ{label_of(table, name).removeprefix(name)}")
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    style.legend_above(figure, axes)


def _ranked(table: DataFrame, found: dict[str, Any], name: str) -> list[str]:
    """Parameters with an effect, the largest first."""
    effects = found["effects"][name]
    return sorted(
        (key for key in effects if effects[key]["bins"]),
        key=lambda key: (-effects[key]["share"], -effects[key]["explained"]),
    )


def _panels(
    figure: Figure, table: DataFrame, found: dict[str, Any], name: str
) -> tuple[list[Axes], list[str]]:
    names = _ranked(table, found, name)[:MOST_PANELS]
    rows, columns = _grid(len(names))
    panels = figure.subplots(rows, columns, squeeze=False).ravel().tolist()
    for axes in panels[len(names) :]:
        axes.set_visible(False)
    return panels, names


def _grid(count: int) -> tuple[int, int]:
    columns = min(3, max(1, count))
    return -(-count // columns), columns


def _numeric(axes: Axes, x: Any) -> Any:
    """Numbers as they are; words as places with ticks."""
    if not any(isinstance(v, str) for v in x.tolist()):
        return x.astype(np.float64)
    words = sorted({str(v) for v in x.tolist()})
    axes.set_xticks(range(len(words)), words)
    return np.array([words.index(str(v)) for v in x.tolist()], dtype=np.float64)


def _of_panels(count: int) -> tuple[float, float]:
    rows, columns = _grid(min(count, MOST_PANELS))
    if count == 1:
        return _wide(count)
    return max(PANEL[0] * columns, 1.5 * PANEL[0]), PANEL[1] * rows


def _of_bars(count: int) -> tuple[float, float]:
    return style.TWO_COLUMNS, 28.0 + 7.0 * min(count, MOST_BARS)


def _wide(count: int) -> tuple[float, float]:
    return style.TWO_COLUMNS, 62.0


FIGURES: dict[str, FigureKind] = {
    "distribution": FigureKind(
        "Distribution",
        "Left: all cases, the line is their mean. Right: share of the cases above a value, with the 95 % "
        "confidence band of each place.",
        _wide,
        _distribution,
        _drawn,
    ),
    "tornado": FigureKind(
        "Tornado",
        "Mean of the cases with the lowest and with the highest values of each parameter, beside the mean.",
        _of_bars,
        _tornado,
        _compared,
    ),
    "effects": FigureKind(
        "Main effects",
        "Mean over the cases with about this value of one parameter, and its standard error; the share of "
        "the variance that one parameter alone explains: exact on a full grid, else an estimate beyond "
        "what as many random groups of cases explain.",
        _of_panels,
        _effects,
        _averaged,
    ),
    "sobol": FigureKind(
        "Sobol' indices",
        "Share of the variance of a parameter alone, and with its interactions, with 95 % confidence.",
        _wide,
        _sobol,
        _with_indices("saltelli"),
    ),
    "morris": FigureKind(
        "Morris' elementary effects",
        "To the right: parameters that matter. Above: those whose effect varies.",
        _wide,
        _morris,
        _with_indices("morris"),
    ),
    "scatter": FigureKind(
        "Cases over the parameters",
        "Each dot is a case.",
        _of_panels,
        _scatter,
        _affected,
    ),
}
