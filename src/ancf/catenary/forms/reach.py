"""Whether the contact wire stays on the strips between its supports: versines of curves against staggers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...errors import ModelError
from ..lines.line import Line
from .shape import WireShape

#: Half of the widest head of a pantograph, m: 1950 mm (EN 50367).
WIDEST = 0.975
#: Half of the strip that pantographs have by default, m.
STRIP = 0.725


@dataclass(frozen=True)
class Aside:
    """Where the contact wire is farthest from the axis of the pantograph in a span.

    Attributes
    ----------
    span : int
        Index of the span.
    track, side : float
        Place along the track and to its left, m.

    """

    span: int
    track: float
    side: float


def asides(line: Line, contact: WireShape, reach: float) -> Iterator[Aside]:
    """Spans that a wire leaves the reach in m within, though it is on the strip at both supports."""
    x, y = contact.position[:, 0], np.abs(contact.position[:, 1])
    inside = np.abs(line.stagger) <= reach
    for k, (first, last) in enumerate(zip(contact.nodes.support, contact.nodes.support[1:], strict=False)):
        node = int(first + np.argmax(y[first : last + 1]))
        if inside[k] and inside[k + 1] and y[node] > reach:
            yield Aside(k, float(x[node]), float(contact.position[node, 1]))


def check_aside(line: Line, contact: WireShape) -> None:
    """Raise ModelError where the wire leaves every pantograph between two supports."""
    for found in asides(line, contact, WIDEST):
        what = f"{_said(line, found)}, no head of a pantograph reaches beyond {WIDEST:g} m"
        raise ModelError(_place(line, found.span), what, _hint(line, found.span))


def cautions(line: Line, contact: WireShape) -> list[str]:
    """What is to be said of spans in which the wire leaves strips of the usual length, or hangs free."""
    aside = [
        f"{_place(line, found.span)}: {_said(line, found)}, strips of {2.0 * STRIP:g} m reach to "
        f"{STRIP:g} m; {_hint(line, found.span)}"
        for found in asides(line, contact, STRIP)
    ]
    return without_droppers(line) + aside


def without_droppers(line: Line) -> list[str]:
    """What is to be said of a line whose messenger carries nothing."""
    if line.messenger_wire is None or len(line.dropper_x):
        return []
    wire, longest = line.contact_wire, max(span.length for span in line.spans)
    sag = wire.mass * line.gravity * longest**2 / (8.0 * wire.tension)
    text = f"there are none: the messenger carries nothing, the contact wire sags by {sag:.2f} m"
    return [f"droppers: {text}; give places, or dropper_rule"]


def _said(line: Line, found: Aside) -> str:
    span = line.spans[found.span]
    text = f"the contact wire lies {abs(found.side):.2f} m beside the track at {found.track:.1f} m"
    if span.radius is None:
        return text
    radius, versine = abs(span.radius), span.length**2 / (8.0 * abs(span.radius))
    return f"{text}: a curve of {radius:g} m has a versine of {versine:.2f} m over {span.length:g} m"


def _hint(line: Line, span: int) -> str:
    """The longest span in this curve that staggers at the ends of a strip allow."""
    radius = line.spans[span].radius
    if radius is None:
        return "other staggers, or shorter spans"
    return f"spans of at most {math.floor(math.sqrt(16.0 * abs(radius) * STRIP))} m, staggers to its outside"


def _place(line: Line, span: int) -> str:
    key = "radius" if line.spans[span].radius is not None else "stagger"
    if span < len(line.rows):
        return f"{line.rows[span]}{key}"
    return f"line.spans[{span}].radius" if key == "radius" else f"line.stagger[{span}]"
