"""Winches: what pays out or hauls in a cable at one of its ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from .beam import Beam
from .functions import TimeFunction
from .points import Point

#: Differences of unit tangents that are none.
STRAIGHT = 1e-12
#: Least length, of that of the mesh: with it, elements are a thousand times as quick.
LEAST = 1e-3


@dataclass(frozen=True, slots=True, eq=False)
class Winch:
    """Changes the natural length of a cable at one of its ends.

    Attributes
    ----------
    point : Point
        That end: material enters and leaves there. Its place is not held.
    length : TimeFunction
        Natural length of what is paid out, m.
    """

    name: str
    point: Point
    length: TimeFunction

    @property
    def held(self) -> frozenset[str]:
        """No component of a position or a slope."""
        return frozenset()

    @property
    def displacement(self) -> None:
        """It moves no node."""
        return None

    @property
    def beam(self) -> Beam:
        """The cable."""
        return cast(Beam, self.point.body)

    @property
    def at_start(self) -> bool:
        """Whether it is at the start of the cable."""
        return self.point.x == 0.0

    def lengths(self, times: FloatArray) -> FloatArray:
        """Lengths at times (n,) in s, (n, 1); ModelError where next to nothing is left."""
        found = self.length.table(times)
        gone = np.flatnonzero(found[:, 0] < LEAST * self.beam.length)
        if len(gone):
            raise _nothing_left(self, float(found[gone[0], 0]), f" at t = {times[gone[0]]:.6g} s")
        return found


def _nothing_left(winch: Winch, length: float, when: str) -> ModelError:
    least = LEAST * winch.beam.length
    what = f'leaves {length:.6g} m of "{winch.beam.name}"{when}, the least is {least:.6g} m'
    return ModelError(winch.length.where, what, "stop hauling in before that, or end the run")


def make_winch(where: str, name: str, point: Point, length: Any) -> Winch:
    """Check what ``Model.winch`` was given."""
    body = point.body
    if not isinstance(body, Beam) or body.has_section:
        what = f'"{body.name}" is no cable, a winch pays out and hauls in cables'
        raise ModelError(f"{where}.point", what, 'add_beam(..., element="cable")')
    if body.closed or point.x not in (0.0, body.length):
        what = f"{point} is no end of the cable"
        raise ModelError(f"{where}.point", what, f"give {body.name}.start or .end")
    natural = body.natural
    if natural is not None and np.any(np.abs(natural.node_tangent - natural.node_tangent[0]) > STRAIGHT):
        what = f'"{body.name}" has a natural curvature, which cannot be wound up'
        raise ModelError(f"{where}.point", what, 'give add_beam(..., natural_shape="straight")')
    item = Winch(name, point, TimeFunction(length, 1, f"{where}.length"))
    if not item.length.missing and (first := float(item.length(0.0)[0])) < LEAST * body.length:
        raise _nothing_left(item, first, " at t = 0")
    return item
