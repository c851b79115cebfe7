"""What one pantograph does to the line: when it is in the window, uplift at the supports, dropper forces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from .signals import Intervals, at_zero, sample_rate

if TYPE_CHECKING:
    from .run_data import Run

#: Two track positions are the same within this length, m.
SAME_PLACE = 1e-6


@dataclass(frozen=True)
class SupportUplift:
    """Largest uplift of the contact wire at a support while a pantograph passes.

    Parameters
    ----------
    number : int
        Of the support, the first one is 1.
    position : float
        Track position, m.
    uplift : float
        m.

    """

    number: int
    position: float
    uplift: float


@dataclass(frozen=True)
class DropperForces:
    """Forces of one dropper over some time.

    Parameters
    ----------
    span, number : int
        The first span of the line and the first dropper of a span are 1.
    position : float
        Track position, m.
    rest, largest, smallest : float
        Tension before the run and its extremes, N.
    slack : Intervals
        When it carried nothing; never, of a broken one.
    broken : bool
        Whether the line does not have it: its forces are 0.

    """

    span: int
    number: int
    position: float
    rest: float
    largest: float
    smallest: float
    slack: Intervals
    broken: bool = False

    @property
    def label(self) -> str:
        """Span and number, "8-3"."""
        return f"{self.span}-{self.number}"


def check_run(run: Any, where: str, pantograph: object = 0) -> int:
    """Raise ModelError if it is no run, or has no such pantograph; its place in ``run.recordings``."""
    if not hasattr(run, "recordings"):
        raise ModelError(
            f"{where}.run", f"must be a Run, is {checks.shown(run)}", "ancf.catenary.run makes one"
        )
    return checks.integer(pantograph, f"{where}.pantograph", 0, len(run.recordings) - 1)


def in_window(run: Run, pantograph: int = 0) -> slice:
    """Samples in which a pantograph is in the evaluated window.

    Raises
    ------
    ModelError
        The run does not cover the window with this pantograph.

    """
    position, (low, high) = run.recordings[pantograph].position, run.window
    inside = np.flatnonzero((position >= low - SAME_PLACE) & (position <= high + SAME_PLACE))
    reach = np.max(np.abs(np.diff(position)), initial=0.0) + SAME_PLACE
    if len(inside) < 2 or np.min(position) > low + reach or np.max(position) < high - reach:
        what = f"is {low:g} m to {high:g} m, the run covers {np.min(position):g} m to {np.max(position):g} m"
        where = f'window of pantograph "{run.recordings[pantograph].name}"'
        raise ModelError(where, what, "run longer, start earlier, or take a shorter window")
    return slice(int(inside[0]), int(inside[-1]) + 1)


def speeds_in_window(run: Run, pantograph: int = 0) -> FloatArray:
    """Speeds (n,) of a pantograph at the samples in which it is in the evaluated window, m/s."""
    speeds: FloatArray = np.gradient(run.recordings[pantograph].position, run.t)
    return speeds[in_window(run, pantograph)]


def uplift_at_supports(run: Run, pantograph: int = 0) -> list[SupportUplift]:
    """Largest uplift at each support that a pantograph passes.

    A pantograph passes a support from the middle of the span before to the middle of the span after, as long
    as no other pantograph is nearer to the support.
    """
    line = run.form.line
    supports, (before, behind) = np.asarray(line.supports), line.reach
    position = run.recordings[pantograph].position
    found = []
    for j, x in enumerate(supports):
        passing = (position >= before[j]) & (position <= behind[j]) & _nearest(run, pantograph, x)
        if np.min(position) - SAME_PLACE <= x <= np.max(position) + SAME_PLACE and np.any(passing):
            found.append(SupportUplift(j + 1, float(x), float(np.max(run.uplift[passing, j]))))
    return found


def uplift_in_window(run: Run, pantograph: int = 0) -> list[SupportUplift]:
    """The same for the supports of the window, those at its two ends included."""
    low, high = run.window
    everywhere = uplift_at_supports(run, pantograph)
    return [u for u in everywhere if low - SAME_PLACE <= u.position <= high + SAME_PLACE]


def dropper_forces(run: Run, over: slice | None = None) -> list[DropperForces]:
    """Forces of all droppers over some samples, the whole run by default.

    Those that push and those that are broken are never slack.
    """
    step, slacken = 1.0 / sample_rate(run.t), can_slacken(run)
    part = run.dropper_force[over if over is not None else slice(None)]
    places, broken = dropper_places(run), broken_places(run)
    return [
        DropperForces(
            *place,
            float(rest),
            float(np.max(force)),
            float(np.min(force)),
            at_zero(force if slack and not gone else np.ones_like(force), step),
            gone,
        )
        for place, rest, force, gone, slack in zip(
            places, run.form.dropper_force, part.T, broken, slacken, strict=True
        )
    ]


def dropper_places(run: Run) -> list[tuple[int, int, float]]:
    """Span, number in the span (both from 1) and track position of each dropper."""
    line = run.form.line
    places = zip(line.dropper_span, line.dropper_number, line.dropper_x, strict=True)
    return [(int(span) + 1, int(number) + 1, float(x)) for span, number, x in places]


def can_slacken(run: Run) -> list[bool]:
    """Of each dropper whether it carries tension only, as those of its section do."""
    return [part.droppers.slack for part in run.form.line.parts for _ in range(len(part.dropper_x))]


def broken_places(run: Run) -> list[bool]:
    """Of each dropper whether it is broken."""
    return [f"{span}-{number}" in run.broken_droppers for span, number, _ in dropper_places(run)]


def droppers_in_window(run: Run, pantograph: int = 0) -> list[DropperForces]:
    """Forces of the droppers of the window while a pantograph is in it."""
    low, high = run.window
    return [d for d in dropper_forces(run, in_window(run, pantograph)) if low <= d.position <= high]


def _nearest(run: Run, pantograph: int, x: float) -> npt.NDArray[np.bool_]:
    distances = np.array([np.abs(recording.position - x) for recording in run.recordings])
    return np.asarray(distances[pantograph] <= np.min(distances, axis=0))


def passing_time(run: Run, x: float, pantograph: int = 0) -> float | None:
    """Time at which a pantograph is nearest to a track position; None when it never gets there."""
    position: FloatArray = run.recordings[pantograph].position
    if not np.min(position) <= x <= np.max(position):
        return None
    return float(run.t[np.argmin(np.abs(position - x))])
