"""Initial shapes: a straight line, a spline through points, a function of u; read off at true arc lengths."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..functions.function import call
from .axes import subdivided

GAUSS_POINTS, GAUSS_WEIGHTS = np.polynomial.legendre.leggauss(8)
CHUNK = 20_000
MOST_SAMPLES = 32_768
#: Curves until a spline must have its own arc length as parameter, and how much longer it may get meanwhile.
MOST_CURVES, LONGEST = 100, 1.5
#: Of the size of a path: two points closer than that are one, where it closes.
SAME = 1e-9


def straight(start: FloatArray, end: FloatArray, fraction: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Positions and unit tangents (n, 3) at fractions (n,) of the line."""
    tangent = (end - start) / np.linalg.norm(end - start)
    position = start + fraction[:, None] * (end - start)
    position[-1] = end
    return position, np.tile(tangent, (fraction.size, 1))


class Curve:
    """A spline in a parameter u, read by its arc length."""

    def __init__(self, knots: FloatArray, points: FloatArray, where: str, closed: bool = False) -> None:
        from scipy.interpolate import CubicSpline

        self.where = where
        self._spline: Any = CubicSpline(knots, points, bc_type="periodic" if closed else "not-a-knot")
        self._slope: Any = self._spline.derivative()
        self._parts = max(2, 64 // knots.size)
        self._u = subdivided(knots, self._parts)
        self._pieces = _arc(self._slope, self._u[:-1], self._u[1:])
        self._s = np.concatenate([[0.0], np.cumsum(self._pieces)])

    @property
    def length(self) -> float:
        """Arc length, m."""
        return float(self._s[-1])

    @property
    def knot_lengths(self) -> FloatArray:
        """Arc lengths at the knots."""
        return self._s[:: self._parts].copy()

    def at(self, s: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Positions and unit tangents (n, 3) at arc lengths (n,), m."""
        u = np.concatenate([self._parameter(s[i : i + CHUNK]) for i in range(0, s.size, CHUNK)])
        slope = self._slope(u)
        speed = np.linalg.norm(slope, axis=1)
        slow = speed <= 1e-6 * self.length / (self._u[-1] - self._u[0])
        if np.any(slow):
            place = f"{s[int(np.argmax(slow))]:.6g} m from its start"
            raise ModelError(self.where, f"has no tangent {place}: it stops or turns back there")
        return self._spline(u), slope / speed[:, None]

    def _parameter(self, s: FloatArray) -> FloatArray:
        i = np.clip(np.searchsorted(self._s, s, side="right") - 1, 0, self._pieces.size - 1)
        left, right, rest = self._u[i], self._u[i + 1], s - self._s[i]
        u: FloatArray = left + rest / np.maximum(self._pieces[i], 1e-300) * (right - left)
        for _ in range(12):
            speed = np.maximum(np.linalg.norm(self._slope(u), axis=1), 1e-300)
            move = (_arc(self._slope, left, u) - rest) / speed
            u = np.clip(u - move, left, right)
            if np.all(np.abs(move) <= 1e-14 * self._u[-1]):
                break
        return u


def interpolated(points: FloatArray, where: str, closed: bool = False) -> Curve:
    """Spline through points (m, 3) whose parameter is its own arc length at the points.

    A closed one goes on from the last point to the first, which may stand there again.

    There is no such spline through some points whose distances differ much: the search for it makes the
    curve longer and longer. It then passes through them with the parameter of the chords' lengths.
    """
    for k in np.flatnonzero(~(np.abs(points).max(axis=1) <= checks.LARGEST)).tolist():
        checks.place(points[k], f"{where}[{k}]")
    if closed:
        points = _loop(points)
    chords = np.linalg.norm(np.diff(points, axis=0), axis=1)
    if not np.all(chords > 1e-12 * np.sum(chords)) or not np.isfinite(np.sum(chords)):
        i = int(np.argmin(chords))
        raise ModelError(f"{where}[{i + 1}]", f"coincides with {where.rpartition('.')[2]}[{i}]")
    knots = np.concatenate([[0.0], np.cumsum(chords)])
    first = curve = Curve(knots, points, where, closed)
    for _ in range(MOST_CURVES):
        change = np.max(np.abs(curve.knot_lengths - knots))
        if change <= 1e-12 * curve.length:
            return curve
        if curve.length > LONGEST * first.length:
            break
        knots = curve.knot_lengths
        curve = Curve(knots, points, where, closed)
    return first


def _loop(points: FloatArray) -> FloatArray:
    """The points with the first one at the end."""
    size = float(np.max(np.ptp(points, axis=0)))
    if np.linalg.norm(points[-1] - points[0]) <= SAME * size:
        points = points[:-1]
    return np.concatenate([points, points[:1]])


def sampled(function: Callable[[float], Any], where: str, closed: bool = False) -> Curve:
    """Spline through samples of a function u -> (3,), u from 0 to 1, refined until it stands still."""
    fractions = np.linspace(0.0, 1.0, 33)
    before: FloatArray | None = None
    count, change = 512, np.inf
    while count <= MOST_SAMPLES:
        curve = _sample(function, count, where, closed)
        now = curve.at(fractions * curve.length)[0]
        scale = curve.length + 1e-3 * float(np.max(np.abs(now)))
        change = np.inf if before is None else float(np.max(np.abs(now - before))) / scale
        if change <= 1e-11:
            return curve
        before, count = now, 2 * count
    if change <= 1e-7:
        return curve
    raise ModelError(where, "is not smooth: its arc length does not settle", "join two beams at a corner")


def _sample(function: Callable[[float], Any], count: int, where: str, closed: bool) -> Curve:
    u = np.linspace(0.0, 1.0, count + 1)
    points = np.array([call(function, value, 3, where, "u", "") for value in u.tolist()])
    if float(np.max(np.abs(points))) > checks.LARGEST:
        raise ModelError(where, f"leaves the space within {checks.LARGEST:g} m")
    if float(np.max(np.ptp(points, axis=0))) == 0.0:
        raise ModelError(where, "has no length: the function returns the same position for every u")
    if closed:
        gap = float(np.linalg.norm(points[-1] - points[0]))
        if gap > SAME * float(np.max(np.ptp(points, axis=0))):
            what = f"does not close: u = 0 and u = 1 are {gap:.4g} m apart"
            raise ModelError(where, what, "end where it starts, or leave closed out")
        points[-1] = points[0]
    return Curve(u, points, where, closed)


def _arc(slope: Any, a: FloatArray, b: FloatArray) -> FloatArray:
    half = (b - a) / 2
    u = ((a + b) / 2)[:, None] + half[:, None] * GAUSS_POINTS
    speed: FloatArray = np.linalg.norm(slope(u), axis=2)
    result: FloatArray = half * (speed @ GAUSS_WEIGHTS)
    return result
