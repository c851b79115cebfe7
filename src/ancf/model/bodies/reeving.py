"""Reeving: the path of a rope or belt over wheels in one plane, made of arcs and their common tangents."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks

#: Arc in rad below which a wheel is only touched.
TOUCHED = 1e-9
#: Of the size of the path: how far a centre may be from the plane of the others.
OFF_PLANE = 1e-9
TURNS = {"left": 1.0, "right": -1.0}
KEYS = ("at", "radius", "turn")


class Reeving:
    """Path of the axis of a rope or belt: around wheels, straight in between.

    Parameters
    ----------
    wheels : sequence of (at, radius, turn)
        Centre (3,) in m, radius of the axis on it in m (that of the wheel and half the thickness), and
        "left" or "right": which way the path turns there, seen against `axis`. Tables with these keys do,
        in which `turn` may be missing: "left".
    axis : (3,)
        Normal of the plane of all wheels.
    start, end : (3,) m
        Ends; without them the path closes.

    Raises
    ------
    ModelError
        A wheel is too near to the next, is off the plane, or has no radius.
    """

    def __init__(self, wheels: Any, axis: Any, start: Any = None, end: Any = None) -> None:
        where = "Reeving"
        if not isinstance(wheels, Sequence) or isinstance(wheels, str) or not wheels:
            raise ModelError(f"{where}.wheels", f"must be a list of wheels, is {checks.shown(wheels)}")
        made = [_wheel(wheel, f"{where}.wheels[{k}]") for k, wheel in enumerate(wheels)]
        self.axis = checks.direction(axis, f"{where}.axis")
        if (start is None) != (end is None):
            raise ModelError(
                f"{where}.{'start' if start is None else 'end'}", "is missing: give both or none"
            )
        self.closed = start is None
        if self.closed and len(made) < 2:
            raise ModelError(f"{where}.wheels", "a closed path needs two wheels or more")
        if not self.closed:
            ends = [checks.place(x, f"{where}.{key}") for key, x in (("start", start), ("end", end))]
            made = [(ends[0], 0.0, 1.0), *made, (ends[1], 0.0, 1.0)]
        self._pieces = _pieces(made, self.axis, self.closed, where)

    def curve(self, where: str, closed: bool) -> Reeved:
        """The path, for a beam that closes or not."""
        if closed != self.closed:
            what = "has no ends" if self.closed else "has ends"
            hint = "closed = true joins the end of a beam to its start" if self.closed else "leave closed out"
            raise ModelError(where, f"{what}, the beam {'has' if self.closed else 'has none'}", hint)
        return Reeved(*self._pieces, self.axis)

    @property
    def length(self) -> float:
        """Arc length, m."""
        return float(self._pieces[0][-1])


@dataclass(frozen=True, slots=True, eq=False)
class Reeved:
    """Arcs and lines one after the other.

    Parameters
    ----------
    s : (m + 1,) m
        Arc lengths at which the pieces begin, and the whole.
    origin : (m, 3) m
        Where each begins.
    tangent : (m, 3)
        Unit tangents there.
    curvature : (m,) 1/m
        Signed, 0 of a line.
    axis : (3,)
        About which they turn.
    """

    s: FloatArray
    origin: FloatArray
    tangent: FloatArray
    curvature: FloatArray
    axis: FloatArray

    @property
    def length(self) -> float:
        """Arc length, m."""
        return float(self.s[-1])

    def at(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Positions and unit tangents (n, 3) at arc lengths (n,), m."""
        k = np.clip(np.searchsorted(self.s, s, side="right") - 1, 0, len(self.curvature) - 1)
        way, c, t = s - self.s[k], self.curvature[k], self.tangent[k]
        aside, angle = np.cross(self.axis, t), c * way
        safe = np.where(c == 0.0, 1.0, c)
        ahead = np.where(c == 0.0, way, np.sin(angle) / safe)[:, None]
        over = np.where(c == 0.0, 0.0, 2.0 * np.sin(0.5 * angle) ** 2 / safe)[:, None]
        position: FloatArray = self.origin[k] + ahead * t + over * aside
        tangent: FloatArray = np.cos(angle)[:, None] * t + np.sin(angle)[:, None] * aside
        return position, tangent


Round = tuple[FloatArray, float, float]


def _wheel(given: Any, where: str) -> Round:
    """Centre, radius and sign of a wheel."""
    hint = f"{', '.join(KEYS)}"
    table = (
        dict(given)
        if isinstance(given, dict)
        else dict(zip(KEYS, checks.items(given, where, hint), strict=False))
    )
    if unknown := set(table) - set(KEYS):
        raise ModelError(f"{where}.{min(unknown)}", f"is no key of a wheel, which has {', '.join(KEYS)}")
    for key in KEYS[:2]:
        if key not in table:
            raise ModelError(f"{where}.{key}", "is missing")
    turn = checks.choice(table.get("turn", "left"), f"{where}.turn", tuple(TURNS))
    return (
        checks.place(table["at"], f"{where}.at"),
        checks.positive(table["radius"], f"{where}.radius"),
        TURNS[turn],
    )


def _pieces(
    rounds: list[Round], axis: FloatArray, closed: bool, where: str
) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Lengths, origins, tangents and curvatures of lines and arcs."""
    pairs = list(zip(rounds, [*rounds[1:], rounds[0]] if closed else rounds[1:], strict=False))
    ways = [_tangent(a, b, axis, f"{where}: wheels {k} and {k + 1}") for k, (a, b) in enumerate(pairs)]
    found: list[tuple[float, FloatArray, FloatArray, float]] = []
    for k, (length, direction, leaves) in enumerate(ways):
        found.append((length, leaves, direction, 0.0))
        if closed or k + 1 < len(ways):
            centre, radius, sign = rounds[(k + 1) % len(rounds)]
            after = ways[(k + 1) % len(ways)][1]
            turn = math.atan2(float(np.cross(direction, after) @ axis), float(direction @ after)) * sign
            turn %= 2.0 * math.pi
            if TOUCHED < turn < 2.0 * math.pi - TOUCHED:
                first = centre - sign * radius * np.cross(axis, direction)
                found.append((turn * radius, first, direction, sign / radius))
    found = [piece for piece in found if piece[0] > 0.0]
    s = np.concatenate([[0.0], np.cumsum([piece[0] for piece in found])])
    return s, *(np.array([piece[k] for piece in found]) for k in (1, 2, 3))  # type: ignore[return-value]


def _tangent(a: Round, b: Round, axis: FloatArray, where: str) -> tuple[float, FloatArray, FloatArray]:
    """Length and direction of the line from one wheel to the next, and where it leaves the first."""
    apart = b[0] - a[0]
    size = float(np.linalg.norm(apart))
    if abs(float(apart @ axis)) > OFF_PLANE * (size + a[1] + b[1]):
        raise ModelError(where, "are not in one plane normal to the axis")
    across = b[2] * b[1] - a[2] * a[1]
    square = size * size - across * across
    if square <= 0.0:
        what = f"are {size:.4g} m apart: no line touches both with radii {a[1]:.4g} and {b[1]:.4g} m"
        raise ModelError(where, what, "move them apart, or turn the path the same way on both")
    length = math.sqrt(square)
    direction = (length * apart - across * np.cross(axis, apart)) / (size * size)
    leaves: FloatArray = a[0] - a[2] * a[1] * np.cross(axis, direction)
    return length, direction, leaves
