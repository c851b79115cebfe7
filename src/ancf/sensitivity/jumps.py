"""Sensitivities over a jump: something happens to a sliding joint, or joints shift an initial motion.

The motion begins anew there, from the places and velocities before, with what shifts them onto the
constraints that hold from then on, and with new accelerations and multipliers: (q, v, a)+ = J(q-, v-; p).
Steps before and after it are followed as all others, so that the derivative is that of the numbers of the run
as long as the jump comes after the same step.  J is smooth; its derivatives along the state and by the
parameter at a fixed state are differences of order four and more.
"""

from __future__ import annotations

from typing import Any, NamedTuple, NoReturn

import numpy as np

from ..arrays import FloatArray
from ..errors import SolveError
from ..solvers.derivatives.sensitivity import ABAR, A, Q, V
from ..solvers.events import happen
from ..solvers.start import consistent_start
from ..system.system import System
from .family import Family
from .memory import slope

#: Change of the state of the differences, in sizes of the model, and of velocities in these per second.
FAR = 1e-4
#: The same up to which two states are one.
ALIKE = 1e-9


class Jump(NamedTuple):
    """One of a run.

    Parameters
    ----------
    number, code : int
        Step after which it came, and what it was, see :func:`ancf.solvers.events.happen`.
    t : float
    before, after : ndarray, shape (3, size)
        q, v, a.
    """

    number: int
    code: int
    t: float
    before: FloatArray
    after: FloatArray


def note_jumps(run: Any, remembers: bool) -> list[Jump]:
    """Let a run note its jumps in a list, but end at the first one if friction remembers the way."""
    found: list[Jump] = []
    happened, m = run.happened, run.memory

    def noted(code: int, t: float, number: int) -> None:
        if remembers:
            what = "a sliding joint opens, closes or reaches an end "
            what += "there, beyond which friction with memory is not followed"
            raise SolveError(f"sensitivities at t = {t:.6g} s, step {number}", what, "end the run before")
        before = np.stack([m.q, m.v, m.a])
        happened(code, t, number)
        found.append(Jump(number, code, t, before, np.stack([m.q, m.v, m.a])))

    run.happened = noted
    return found


def end_at_jumps(run: Any, error: type[Exception]) -> None:
    """Let a run end with an error where something happens to a sliding joint."""

    def happened(code: int, t: float, number: int) -> NoReturn:
        raise error

    run.happened = happened


class Anew:
    """A new start, as a function of the state from which it is made and of the system.

    Parameters
    ----------
    run : Run
    base : System
        In which joints are as they were before.
    state : (q, v)
        Before.
    t : float
    code : int, optional
        What happens to a joint there.
    """

    def __init__(self, run: Any, base: System, state: Any, t: float, code: int | None = None) -> None:
        self.base, self.code, self.weights = base, code, base.weights()
        self.state = np.stack(state)
        self._when = t - run.h, run.h, 1, run.t_start, run.t_end
        slides = base.parts.get("slides")
        self._joints = None if slides is None else (slides.mode.copy(), slides.open.copy())
        self._level = base.level.copy()

    def __call__(self, system: System, q: FloatArray, v: FloatArray) -> FloatArray:
        """q, v, a after it, (3, size)."""
        q, v = q.copy(), v.copy()
        if self._joints is not None:
            slides = system.parts["slides"]
            slides.mode[...], slides.open[...] = self._joints
        if len(system.measured):
            system.measured[...] = self.base.measured
        if self.code is not None:
            happen(system, q, v, self.code, "sensitivities")
        tables = system.inputs.tables(*self._when, (q, v), still=True)
        a = consistent_start(system, q, v, tables)
        system.level[:] = self._level
        return np.stack([q, v, a])

    def check(self, states: Any) -> None:
        """Raise SolveError if it does not lead to the places and velocities that a run has after it."""
        for mine, own in zip(self(self.base, *self.state)[:2], states, strict=True):
            if np.max(np.abs(mine - own) * self.weights, initial=0.0) > ALIKE:
                what = "something happens to a sliding joint where the run starts, which is not followed"
                raise SolveError("sensitivities at the start", what, "begin beside it")

    def along(self, d: FloatArray) -> FloatArray:
        """Derivative along that of the state before, (2, size)."""
        size = float(np.max(np.abs(d) * self.weights, initial=0.0))
        found = slope(lambda x: self(self.base, *(self.state + x * d)), FAR, size)
        return np.zeros((3, d.shape[1])) if isinstance(found, float) else found

    def by(self, family: Family) -> FloatArray:
        """Derivative by a parameter at the fixed state before."""
        here, found = self(self.base, *self.state), np.zeros((3, self.base.size))
        for system, weight in family.around():
            if system is not self.base:
                found += weight * (self(system, *self.state) - here)
        return found

    def derivatives(self, families: list[Family], d: Any) -> FloatArray:
        """Derivatives of q, v, a and the algorithmic acceleration, (p, 4, size), from those before.

        Joints of the system are as after it then, as with each call.
        """
        made = np.zeros((len(families), 4, self.base.size))
        for own, family, before in zip(made, families, d, strict=True):
            own[[Q, V, A]] = self.along(np.stack(before)) + self.by(family)
            own[ABAR] = own[A]
        return made
