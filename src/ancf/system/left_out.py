"""Rows of joints that were left out, as other joints and supports held them: whether they still do.

That they hold them wherever the mechanism can get is looked at once (:mod:`ancf.system.redundancy`), with
supports at rest. Given motions of supports may part what was together.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import SolveError
from .core import constraints
from .joints import rows_of_places
from .system import System

#: From which gap on, in sizes of the model, or cosine of the angle between directions, a row is no longer
#: held, and how much larger than the largest one of rows that are solved for it may be.
APART, BESIDE = 1e-4, 1e2


def heeded(system: System, recorder: Any) -> Any:
    """The recorder of a run, which fails where rows that were left out are not held in a stored state."""
    return Heeded(system, recorder) if len(system.spare) else recorder


class Heeded:
    """Looks at the states that a recorder is given and hands them on; see ``Recorder`` for its methods."""

    def __init__(self, system: System, recorder: Any) -> None:
        self._system, self._recorder = system, recorder

    def __getattr__(self, name: str) -> Any:
        return getattr(self._recorder, name)

    def append(self, t: FloatArray, q: FloatArray, v: FloatArray, work: FloatArray) -> None:
        """States up to the first one in which a joint has come apart, which is the last one stored.

        Raises
        ------
        SolveError
            There is one.
        """
        for k in range(len(t)):
            problem = come_apart(self._system, q[k], f"t = {t[k]:.6g} s")
            if problem is not None:
                last = slice(k + 1)
                self._recorder.append(t[last], q[last], v[last], work[last])
                raise problem
        self._recorder.append(t, q, v, work)


def come_apart(system: System, q: FloatArray, where: str) -> SolveError | None:
    """The joint whose rows that were left out are not held in a state, or None."""
    if not len(system.spare):
        return None
    joints, still = system.core.joints, q.copy()
    still[system.multipliers] = 0.0
    gaps, zero, level = np.zeros(system.size), np.zeros(system.size), system.level.copy()
    system.level[:] = 1.0, 0.0, 0.0
    constraints(joints, still, zero, zero, gaps, system.core.ws)
    system.level[:] = level
    rows = np.concatenate([system.spare, np.setdiff1d(system.parts["joints"].unknown, system.spare)])
    places, gap = np.isin(rows, rows_of_places(system)), np.abs(gaps[rows])
    apart, count = np.where(places, gap / system.model.size, gap), len(system.spare)
    worst = int(np.argmax(apart[:count]))
    if not apart[worst] > max(APART, BESIDE * float(np.max(apart[count:], initial=0.0))):
        return None
    unit = "m" if places[worst] else "rad"
    name = next(name for name, own in system.numbering.multipliers.items() if rows[worst] in own)
    what = f'"{name}" is off by {gap[worst]:.3g} {unit}: others held that at the start, and no longer do'
    return SolveError(where, what, "a given motion of a support contradicts it: let one of them hold less")
