"""Mesh: how fine the wires are divided, and where their nodes are along the track."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np

from ...arrays import FloatArray, IntArray
from ...errors import ModelError
from ...model import checks
from ..lines.line import Line

MOST_ELEMENTS = 1_000_000  # of a wire
GROWTH = 0.7  # length of an element gained per distance from the place that wants short ones


@dataclass(frozen=True, slots=True, kw_only=True)
class Mesh:
    """Largest lengths of the elements, m.

    A wire bends at a dropper within about sqrt(EI/T), some 0.1 m, which elements of metres cannot follow.
    The droppers make up for it (:mod:`ancf.catenary.clamps`): they need no short elements. A messenger that
    bends over its supports needs some there, and one with stitch wires at their ends.

    Parameters
    ----------
    contact, messenger : float
        At most, anywhere on the wire.
    contact_support, messenger_support : float
        At most, beside a support; None for no limit of its own.
    dropper : float
        At most, beside a dropper or the end of a stitch wire, on both wires; None for no limit of its own.

    """

    contact: float = 0.8
    messenger: float = 2.0
    contact_support: float | None = None
    messenger_support: float | None = None
    dropper: float | None = None

    def __post_init__(self) -> None:
        """Check that the lengths are positive."""
        for key in ("contact", "messenger"):
            checks.positive(getattr(self, key), f"mesh.{key}")
        for key in ("contact_support", "messenger_support", "dropper"):
            if getattr(self, key) is not None:
                checks.positive(getattr(self, key), f"mesh.{key}")

    def nodes(self, line: Line, wire: str) -> Nodes:
        """Track positions of the nodes of "contact", "messenger" or "auxiliary", which is meshed alike."""
        own = "contact" if wire == "contact" else "messenger"
        largest: float = getattr(self, own)
        near: float = getattr(self, f"{own}_support") or largest
        at_dropper = self.dropper or largest
        ends = stitch_ends(line) if wire == "messenger" else np.zeros((0, 2))
        loads = np.array([load.position for load in line.loads_on(wire)])
        droppers, hung = line.dropper_x, ends.ravel()
        if line.auxiliary is not None and wire == "messenger":
            droppers = line.long_x
        if wire == "auxiliary":
            hung = line.long_x
        groups = (line.supports, droppers, hung, loads)
        return _nodes(groups, (near, at_dropper, at_dropper, largest), largest)

    def stitch_nodes(self, line: Line, support: int) -> Nodes:
        """The same of the stitch wire at a support; its two ends are its supports."""
        ends = stitch_ends(line)[support - 1]
        near = self.dropper or self.messenger
        droppers = line.dropper_x[line.dropper_stitch == support]
        return _nodes((ends, droppers, np.zeros(0), np.zeros(0)), (near,) * 4, self.messenger)


@dataclass(frozen=True, slots=True)
class Nodes:
    """Nodes of a wire.

    Attributes
    ----------
    x : (n,) m
        Track positions at rest.
    support, dropper, stitch, load : arrays of int
        Which of them are at the supports, the droppers, the ends of stitch wires and at masses. Of an
        auxiliary `stitch` is where it hangs from the messenger, whose `dropper` is that then.

    """

    x: FloatArray
    support: IntArray
    dropper: IntArray
    stitch: IntArray
    load: IntArray

    @property
    def marks(self) -> IntArray:
        """Nodes whose track positions are prescribed, ascending."""
        return np.unique(np.concatenate([self.support, self.dropper, self.stitch, self.load]))


def stitch_ends(line: Line) -> FloatArray:
    """Track positions of the ends of the stitch wires (supports - 2, 2), m; none without them."""
    if line.stitch is None:
        return np.zeros((0, 2))
    ends: FloatArray = line.supports[1:-1, None] + line.stitch.reach * np.array([-1.0, 1.0])
    return ends


def _nodes(groups: tuple[FloatArray, ...], sizes: tuple[float, ...], largest: float) -> Nodes:
    """Nodes at all places of four groups of marks and between them; sizes beside the marks, m."""
    places, back = np.unique(np.round(np.concatenate(groups), 9), return_inverse=True)
    near = np.full(places.size, largest)
    np.minimum.at(near, back, np.repeat(sizes, [group.size for group in groups]))
    cells, room = [], MOST_ELEMENTS
    for (a, b), (at_a, at_b) in zip(pairwise(places), pairwise(near), strict=True):
        cells.append(divided(a, b, at_a, at_b, largest, room))
        room -= cells[-1].size
    x = np.concatenate([*(cell[:-1] for cell in cells), places[-1:]])
    first = np.concatenate([[0], np.cumsum([cell.size - 1 for cell in cells])])
    return Nodes(x, *np.split(first[back], np.cumsum([group.size for group in groups])[:-1]))


def divided(
    a: float, b: float, at_a: float, at_b: float, largest: float, most: int = MOST_ELEMENTS
) -> FloatArray:
    """Places from a to b whose distances are at most at_a and at_b at the ends and grow inwards, m."""

    def size(x: Any) -> Any:
        return np.minimum(largest, np.minimum(at_a + GROWTH * (x - a), at_b + GROWTH * (b - x)))

    x = np.linspace(a, b, 2001)
    middle = 0.5 * (x[1:] + x[:-1])
    count = np.concatenate([[0.0], np.cumsum((x[1] - x[0]) / size(middle))])
    if not count[-1] <= most:
        raise ModelError(
            "mesh", f"makes more than {MOST_ELEMENTS} elements of a wire", "give longer elements"
        )
    elements = max(1, int(np.ceil(count[-1] - 1e-9)))
    places: FloatArray = np.interp(np.linspace(0.0, count[-1], elements + 1), count, x)
    places[0], places[-1] = a, b
    return places
