"""Pictures of a line at rest: from the side with droppers, sag of the contact wire, staggers in plan."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from ...viz import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from .shape import WireShape

MM = 1e3
#: Looks of the wires, from the lowest up.
CONTACT, MESSENGER, AUXILIARY = (style.line(k) | {"linewidth": 1.0} for k in range(3))
FINE: dict[str, Any] = {"color": style.GREY, "linewidth": 0.5}
ENDS: dict[str, Any] = {"color": style.GREY, "linewidth": 0.7}


def draw_form(found: Any, figure: Figure, strip: float, window: tuple[float, float] | None = None) -> None:
    """From the side, the contact wire alone, from above; length of the strips and what is evaluated, m."""
    side, sag, plan = figure.subplots(3, sharex=True, height_ratios=(1.2, 1.0, 1.0))
    line = found.line
    starts = getattr(line, "starts", (0.0,))
    for form, start in zip(found.shifted, starts, strict=True):
        _from_the_side(side, form)
        contacts = [shape for shape in (form.contact, form.twin) if shape is not None]
        for x, _, z in (shape.position.T for shape in contacts):
            sag.plot(x, MM * (z - form.line.height_at(x - start)), **CONTACT)
        for name, shape, look in _wires(form):
            plan.plot(shape.position[:, 0], MM * shape.position[:, 1], label=name, **look)
    for k, y in enumerate((-0.5 * MM * strip, 0.5 * MM * strip)):
        plan.axhline(y, linestyle="--", label="ends of the strip" if k == 0 else None, **ENDS)
    for axes in (side, sag, plan):
        if window is not None:
            shade_window(axes, window)
        axes.set_xlim(float(np.min(line.supports)), float(np.max(line.supports)))
        mark_line(axes, line)
    side.set_ylabel("height at rest [m]")
    sag.set_ylabel("contact wire over\nits nominal height [mm]")
    plan.set(xlabel="track position [m]", ylabel="to the left of the axis [mm]")
    style.legend_above(figure, plan, 6)


def _wires(form: Any) -> Iterator[tuple[str, WireShape, dict[str, Any]]]:
    """Name, shape and look of each wire of a tension length."""
    yield "contact wire", form.contact, CONTACT
    if form.twin is not None:
        yield "second contact wire", form.twin, CONTACT | {"linestyle": ":"}
    if form.auxiliary is not None:
        yield "auxiliary", form.auxiliary, AUXILIARY
    if form.messenger is not None:
        yield "messenger", form.messenger, MESSENGER
    for stitch in form.stitches:
        yield "stitch wire", stitch, AUXILIARY


def _from_the_side(axes: Axes, form: Any) -> None:
    for _, shape, look in _wires(form):
        axes.plot(shape.position[:, 0], shape.position[:, 2], **look)
    places = form.contact.position[form.contact.nodes.dropper, 0]
    axes.vlines(places, form.contact_height, form.messenger_height, **FINE)
    upper, lower = form.messenger, form.auxiliary
    if upper is not None and lower is not None:
        low, high = lower.position[lower.nodes.stitch], upper.position[upper.nodes.dropper]
        axes.vlines(low[:, 0], low[:, 2], high[:, 2], **FINE)


def shade_window(axes: Axes, window: tuple[float, float]) -> None:
    """Shade the track interval that is evaluated."""
    axes.axvspan(*window, color=style.SHADE, linewidth=0, zorder=0, label="evaluated")


def mark_line(axes: Axes, line: Any) -> None:
    """Masts as triangles and droppers as ticks along the lower edge, masts as thin lines above."""
    edge = axes.get_xaxis_transform()
    axes.vlines(line.supports, 0, 1, transform=edge, color=style.LIGHT, linewidth=0.4, zorder=0.5)
    at: dict[str, Any] = {
        "transform": edge,
        "clip_on": False,
        "linestyle": "none",
        "color": "black",
        "zorder": 5,
    }
    supports, droppers = _seen(axes, line.supports), _seen(axes, line.dropper_x)
    axes.plot(supports, np.zeros(len(supports)), marker="^", markersize=4.5, label="mast", **at)
    axes.plot(droppers, np.zeros(len(droppers)), marker="|", markersize=4, label="dropper", **at)


def _seen(axes: Axes, x: Any) -> Any:
    low, high = axes.get_xlim()
    places = np.asarray(x)
    return places[(places >= low - 1e-6) & (places <= high + 1e-6)]
