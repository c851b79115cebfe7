"""Stage: what is between a mass of a pantograph and the one below: spring, damper, friction and stops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks

#: Rows of a curve: elongation in m, or its rate in m/s, and force in N.
Rows = tuple[tuple[float, float], ...]
#: Elongation at which a spring can meet a stop, m; more is a slip of units.
FARTHEST = 5.0


@dataclass(frozen=True, slots=True)
class Stage:
    """Spring, damper, friction and stops below a mass.

    Parameters
    ----------
    spring : float, N/m, or rows of elongation in m and force in N
    damper : float, N s/m, or rows of rate in m/s and force in N
    friction : float, N
    stops : (float, float), m
        Elongations of the spring at which it meets a stop, the first one negative.
    stop_stiffness : float, N/m

    """

    spring: float | Rows
    damper: float | Rows
    friction: float
    stops: tuple[float, float] | None
    stop_stiffness: float

    @property
    def stiffness(self) -> float:
        """Of the spring where it is straight all along, else 0, N/m."""
        return 0.0 if isinstance(self.spring, tuple) else self.spring

    @property
    def damping(self) -> float:
        """Of the damper where it is straight all along, else 0, N s/m."""
        return 0.0 if isinstance(self.damper, tuple) else self.damper

    @property
    def law(self) -> FloatArray | None:
        """Rows (n, 2) of the force beside the straight spring, m and N; None for no force."""
        spring = np.array(self.spring) if isinstance(self.spring, tuple) else None
        if self.stops is None:
            return spring
        low, high = self.stops
        stop = self.stop_stiffness
        stopped = np.array([[low - 1.0, -stop], [low, 0.0], [high, 0.0], [high + 1.0, stop]])
        if spring is None:
            return stopped
        places = np.union1d(spring[:, 0], stopped[:, 0])
        return np.column_stack([places, along(spring, places) + along(stopped, places)])

    @property
    def resistance(self) -> FloatArray | None:
        """Rows (n, 2) of the damper, m/s and N; None where it is straight all along."""
        return np.array(self.damper) if isinstance(self.damper, tuple) else None

    def force(self, elongation: Any) -> Any:
        """Of the spring and its stops, N, tension positive."""
        law = self.law
        return self.stiffness * np.asarray(elongation) + (0.0 if law is None else along(law, elongation))

    def elongation(self, force: float) -> float:
        """At which the spring and its stops carry a force in N, tension positive, m."""
        law = self.law
        if law is None:
            return force / self.stiffness
        x, f = law[:, 0], law[:, 1] + self.stiffness * law[:, 0]
        return float(along(np.column_stack([f, x]), force))

    def slope(self, elongation: float) -> float:
        """Stiffness there, N/m."""
        short = 1e-6
        return float((self.force(elongation + short) - self.force(elongation - short)) / (2.0 * short))

    @property
    def damping_at_rest(self) -> float:
        """Of the damper for small motions, in the mean of both directions, N s/m."""
        rows, short = self.resistance, 1e-6
        if rows is None:
            return self.damping
        pair = along(rows, np.array([-short, short]))
        return float(pair[1] - pair[0]) / (2.0 * short)


def along(rows: FloatArray, x: Any) -> Any:
    """Values of a curve (n, 2), which goes straight on beyond its ends."""
    k = np.clip(np.searchsorted(rows[:, 0], x, side="right") - 1, 0, len(rows) - 2)
    low, high = rows[k], rows[k + 1]
    share = (np.asarray(x) - low[..., 0]) / (high[..., 0] - low[..., 0])
    return low[..., 1] + share * (high[..., 1] - low[..., 1])


def spring_of(given: Any, where: str) -> float | Rows:
    """A stiffness, or the rows of a curve that rises all along."""
    if not isinstance(given, Sequence | np.ndarray):
        return checks.non_negative(given, where)
    rows = checks.curve(given, where)
    falling = np.flatnonzero(np.diff(rows[:, 1]) <= 0.0)
    if falling.size:
        k = int(falling[0]) + 1
        what = f"is {rows[k, 1]:g} N after {rows[k - 1, 1]:g} N: the force has to rise with the elongation"
        raise ModelError(f"{where}[{k}][1]", what, "elongation in m and force in N, tension positive")
    return tuple((float(x), float(f)) for x, f in rows)


def damper_of(given: Any, where: str) -> float | Rows:
    """A damping, or the rows of a curve; the model checks that it takes energy."""
    if not isinstance(given, Sequence | np.ndarray):
        return checks.non_negative(given, where)
    return tuple((float(x), float(f)) for x, f in checks.curve(given, where))


def stops_of(given: Any, where: str) -> tuple[float, float] | None:
    """Two elongations, or None for no stops."""
    if given is None or (isinstance(given, Sequence) and len(given) == 0):
        return None
    low, high = checks.array(given, where, (2,)).tolist()
    if not low < high:
        raise ModelError(where, f"are {low:g} and {high:g} m", "the shortest first, [-0.03, 0.03]")
    if not low <= 0.0 <= high:
        what = f"are {low:g} and {high:g} m, the spring without elongation is beyond both"
        raise ModelError(where, what, "one below and one above 0, [-0.03, 0.03]")
    if max(abs(low), abs(high)) > FARTHEST:
        raise ModelError(where, f"are {low:g} and {high:g} m", "units are m: [-0.03, 0.03]")
    return float(low), float(high)
