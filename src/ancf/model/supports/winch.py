"""Winches: what pays out or hauls in a cable at one of its ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, cast

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..bodies.beam import Beam
from ..functions.function import TimeFunction
from ..points import Point

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
        Natural length of what is paid out, m; of a winch that follows a speed the first one.
    speed : TimeFunction or None
        Speed that it follows, m/s, or the largest one with which it goes to a length that is an input.
    acceleration : float or None
        Largest change of its speed in time, m/s^2.
    """

    name: str
    point: Point
    length: TimeFunction
    speed: TimeFunction | None = None
    acceleration: float | None = None

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

    @property
    def driven(self) -> bool:
        """Whether its length follows from step to step, not from the time alone."""
        return self.speed is not None

    @property
    def goes_to_length(self) -> bool:
        """Whether such a winch goes to a length that is given; else it follows a speed."""
        return bool(self.length.inputs)

    def lengths(self, times: FloatArray) -> FloatArray:
        """Lengths at times (n,) in s, (n, 1); ModelError where next to nothing is left."""
        found = self.length.table(times)
        self.check_left(found[:, 0], times)
        return found

    def check_left(self, lengths: FloatArray, times: FloatArray) -> None:
        """Raise ModelError at the first of the times (n,) in s at which next to nothing is left, in m."""
        gone = np.flatnonzero(lengths < LEAST * self.beam.length)
        if len(gone):
            raise _nothing_left(self, float(lengths[gone[0]]), f" at t = {times[gone[0]]:.6g} s")


def _nothing_left(winch: Winch, length: float, when: str) -> ModelError:
    least = LEAST * winch.beam.length
    what = f'leaves {length:.6g} m of "{winch.beam.name}"{when}, the least is {least:.6g} m'
    return ModelError(winch.length.where, what, "stop hauling in before that, or end the run")


def make_winch(
    where: str, name: str, point: Point, length: Any, speed: Any = None, acceleration: Any = None
) -> Winch:
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
    followed = None if speed is None else TimeFunction(speed, 1, f"{where}.speed", "m/s")
    limit = None if acceleration is None else checks.positive(acceleration, f"{where}.acceleration")
    item = Winch(name, point, TimeFunction(length, 1, f"{where}.length", "m"), followed, limit)
    _check_drive(where, item)
    if not item.length.missing and (first := float(item.length(0.0)[0])) < LEAST * body.length:
        raise _nothing_left(item, first, " at t = 0")
    return item


def _check_drive(where: str, item: Winch) -> None:
    """Raise ModelError if a winch could jump, or has two masters."""
    length, speed = item.length, item.speed
    if speed is None and length.inputs:
        what = f'depends on the input "{next(iter(length.inputs))}", which may jump'
        hint = "give speed= and acceleration=, the most that the winch can do, or an input as speed="
        raise ModelError(length.where, what, hint)
    if speed is None:
        if item.acceleration is not None:
            what = "is given without speed=, and a length that is a function of time needs neither"
            raise ModelError(f"{where}.acceleration", what)
        return
    if item.acceleration is None:
        what = "is missing: a speed that jumps would be an impulse"
        raise ModelError(f"{where}.acceleration", what, "give the most that the winch can do, m/s^2")
    if not length.inputs and not length.constant:
        what = "is a function of time, and speed= is given as well"
        raise ModelError(length.where, what, "give the length at the start as a number, or no speed")
    if length.inputs and (not speed.constant or float(speed(0.0)[0]) <= 0.0):
        what = "is the largest speed of a winch that goes to a length, and must be a positive number"
        raise ModelError(speed.where, what)
