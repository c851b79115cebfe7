"""Curves over time, paths of points and energies of a result."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from .. import style
from .picture import Picture
from .projection import Projection, parse_plane, projection
from .questions import QUANTITIES, SCALARS, ask, label, quantity_of

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

AXES = "xyz"
WIDTH, PANEL, REST = 130.0, 48.0, 22.0  # mm: of a figure, height of a panel, of legend and labels
PATH = (110.0, 90.0)  # mm
ENERGIES = ("kinetic", "strain", "potential", "total")
WORK = ("dissipated", "supplied")


@dataclass(frozen=True)
class Curve:
    """One curve, with its text in the legend; one without a name is grey and not in it."""

    name: str
    x: FloatArray
    y: FloatArray


@dataclass(frozen=True)
class Panel:
    """Curves that share their axes."""

    label: str
    curves: list[Curve]


def plot(
    source: Any,
    what: Sequence[Any],
    *,
    quantity: str | None = None,
    x: str = "t",
    plane: str | None = None,
    size: tuple[float, float] | None = None,
) -> Picture:
    """Picture of a result or its sensors; see :meth:`ancf.Result.plot`."""
    style.require_matplotlib()
    if len(source.t) == 0:
        raise ModelError("plot", "nothing was stored, so there is nothing to draw")
    if plane is not None:
        return _paths(source, what, quantity, plane, size)
    checks.choice(x, "plot.x", ("t", *SCALARS))
    if not what or quantity == "energy":
        panels = _energies(source, what, quantity, x)
    else:
        panels = list(_panels(source, what, quantity, x))
    return draw_panels(panels, style.axis_label(x), size)


def draw_panels(panels: Sequence[Panel], x_label: str, size: tuple[float, float] | None = None) -> Picture:
    """Picture of panels under each other."""
    names = list(dict.fromkeys(curve.name for panel in panels for curve in panel.curves if curve.name))
    shape = size_of(size, (WIDTH, REST + PANEL * len(panels)))
    with style.new_figure(*shape) as figure:
        rows = figure.subplots(len(panels), sharex=True, squeeze=False)[:, 0]
        for axes, panel in zip(rows, panels, strict=True):
            for curve in panel.curves:
                mark = style.look(0).marker if len(curve.x) == 1 else None
                look = style.line(names.index(curve.name)) if curve.name in names else {"color": style.GREY}
                axes.plot(curve.x, curve.y, label=curve.name or "_", marker=mark, **look)
            axes.set_ylabel(panel.label)
            axes.margins(x=0.0 if len(panel.curves[0].x) > 1 else 0.5)
        rows[-1].set_xlabel(x_label)
        _legend(figure, rows.tolist(), shape[0])
        return Picture(figure)


def size_of(given: Any, default: tuple[float, float]) -> tuple[float, float]:
    """Width and height in mm, checked."""
    if given is None:
        return default
    width, height = checks.array(given, "plot.size", (2,)).tolist()
    return checks.positive(width, "plot.size"), checks.positive(height, "plot.size")


def _panels(source: Any, what: Sequence[Any], quantity: str | None, x: str) -> Iterator[Panel]:
    """A panel for each quantity; of several vectors one for each component."""
    groups: dict[tuple[str, str], list[Any]] = {}
    for item in what:
        asked = quantity_of(source, item, quantity)
        unit = source.model.inputs[label(item)].unit if asked == "input" else ""
        groups.setdefault((asked, unit), []).append(item)
    for (asked, unit), items in groups.items():
        along = [_along(source, x, item) for item in items]
        values = [ask(source, asked, item) for item in items]
        names = [label(item) for item in items]
        if QUANTITIES[asked].vector:
            yield from _components(asked, names, along, values)
            if asked == "joint_force" and len(items) == 1:
                yield from _moment(source, items[0], along[0])
        else:
            curves = [Curve(*given) for given in zip(names, along, values, strict=True)]
            yield Panel(style.axis_label(asked) + (f" [{unit}]" if unit else ""), curves)


def _along(source: Any, x: str, item: Any) -> FloatArray:
    if x == "t":
        t: FloatArray = np.asarray(source.t)
        return t
    return ask(source, quantity_of(source, item, x), item)


def _components(
    quantity: str, names: list[str], along: list[FloatArray], values: list[FloatArray]
) -> Iterator[Panel]:
    """One item: its components in a panel, and moments in another; several items: a panel per component."""
    if len(names) == 1:
        columns = values[0][:, :3].T
        letters = QUANTITIES[quantity].letters
        curves = [Curve(f"{names[0]} {c}", along[0], v) for c, v in zip(letters, columns, strict=False)]
        yield Panel(style.axis_label(quantity), curves)
        return
    for k, letter in enumerate(QUANTITIES[quantity].letters):
        columns_of = zip(names, along, values, strict=True)
        curves = [Curve(name, x, value[:, k]) for name, x, value in columns_of if value.shape[1] > k]
        yield Panel(style.axis_label(quantity, letter), curves)


def _moment(source: Any, item: Any, along: FloatArray) -> Iterator[Panel]:
    """Moment of a joint that has one along global axes."""
    name, text = label(item), style.axis_label("joint_moment")
    if source.has_moment(name):
        moment = ask(source, "joint_moment", item)
        yield Panel(text, [Curve(f"{name} {c}", along, v) for c, v in zip(AXES, moment.T, strict=True)])


def _energies(source: Any, what: Sequence[Any], quantity: str | None, x: str) -> list[Panel]:
    """Energies and how their balance drifts, of a result that accounted for them."""
    if quantity not in (None, "energy"):
        raise ModelError("plot", f'"{quantity}" of what?', f'such as plot("beam.end", quantity="{quantity}")')
    if what:
        raise ModelError("plot.quantity", '"energy" is that of the whole model', "leave the points out")
    if x != "t":
        raise ModelError("plot.x", f'energies are drawn over "t", not "{x}"')
    if not hasattr(source, "energy"):
        names = ", ".join(source.names)
        raise ModelError("plot", "sensors have no energies", f"give one of: {names}")
    t, energy = np.asarray(source.t), source.energy
    shown = [Curve(name, t, getattr(energy, name)) for name in ENERGIES]
    shown += [Curve(name, t, getattr(energy, name)) for name in WORK if np.any(getattr(energy, name))]
    drift = Curve("", t, energy.drift)
    return [Panel(style.axis_label("energy"), shown), Panel("drift of the balance [J]", [drift])]


def _paths(
    source: Any, what: Sequence[Any], quantity: str | None, plane: str, size: tuple[float, float] | None
) -> Picture:
    """Paths of points in a plane or in space; a ring is where each begins."""
    axes_of = parse_plane(plane, "plot.plane")
    if not what:
        raise ModelError("plot", "a path of what?", f'such as plot("beam.end", plane="{plane}")')
    for item in what:
        if quantity_of(source, item, quantity) != "position":
            raise ModelError("plot.plane", "only points have a path, without another quantity")
    paths = {label(item): ask(source, "position", item) for item in what}
    shape = size_of(size, PATH)
    with style.new_figure(*shape) as figure:
        view = projection(np.concatenate([*paths.values()]), axes_of)
        axes = view.add_axes(figure)
        for k, (name, path) in enumerate(paths.items()):
            _path(axes, view, path, name, k)
        _legend(figure, [axes], shape[0])
        return Picture(figure)


def _path(axes: Axes, view: Projection, path: FloatArray, name: str, k: int) -> None:
    axes.plot(*view(path).T, label=name, clip_on=False, **style.line(k))
    axes.plot(
        *view(path[:1]).T,
        marker="o",
        color=style.look(k).color,
        markerfacecolor="white",
        linestyle="",
        clip_on=False,
    )


def _legend(figure: Figure, rows: Sequence[Axes], width: float) -> None:
    """Legend above all panels, with as many columns as there is room for."""
    found: dict[str, Any] = {}
    for axes in rows:
        handles, labels = axes.get_legend_handles_labels()
        found |= dict(zip(labels, handles, strict=True))
    longest = max(map(len, found))
    columns = int(np.clip(width / (1.55 * longest + 14.0), 1, len(found)))
    figure.legend(found.values(), found.keys(), loc="outside upper center", ncols=columns)
