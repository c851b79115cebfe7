"""What is said of a step of the Newmark family that has failed for good."""

from __future__ import annotations

from ..arrays import FloatArray
from ..errors import SolveError
from ..system.system import System
from .bridge import MOST_PARTS
from .memory import NORM, WORST
from .status import COLLAPSED, DIVERGED, FAR, NOT_FINITE, SINGULAR, SLOW, TOO_MANY, UNBALANCED

REASONS = {
    DIVERGED: "Newton's method diverged, also with full Jacobians and smaller steps",
    NOT_FINITE: "the forces are no longer finite, also with smaller steps",
    SINGULAR: "the iteration matrix is singular",
    SLOW: "Newton's method did not converge, also with full Jacobians and smaller steps",
    FAR: "the motion in a step is too large, also in smaller steps",
    UNBALANCED: "energy came from nowhere, also with smaller steps",
    TOO_MANY: f"steps had to be halved, into more than {MOST_PARTS} parts on average",
}


def failed(system: System, memo: FloatArray, t: float, number: int, reason: str, h: float) -> SolveError:
    """Step ``number`` of length h at t has failed; ``memo`` is that of the run's memory."""
    where = f"t = {t:.6g} s, step {number}, {system.numbering.describe(int(memo[WORST]))}"
    what = f"{reason}; last correction {memo[NORM]:.3g}, step {h:g} s"
    hint = f"try a step of {h / 10:.2g} s or less, GeneralizedAlpha, more elements, or some damping"
    return SolveError(where, what, hint)


def collapsed(system: System, memo: FloatArray, t: float, number: int, h: float) -> SolveError:
    """A cross-section has collapsed in step ``number`` of length h at t."""
    what = f"{COLLAPSED}; step {h:g} s"
    hint = f"try a step of {h / 10:.2g} s or less, GeneralizedAlpha, more elements, or a stiffer section"
    return SolveError(f"t = {t:.6g} s, step {number}, {system.element_of(int(memo[WORST]))}", what, hint)
