"""The steps of a run: how many, how long the last one is, and which of them know nothing of its end."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from ..system.inputs import STENCIL


@dataclass(frozen=True)
class Span:
    """Steps from t_start to t_end, s; the last one is shorter if they do not fit.

    Parameters
    ----------
    t_start, t_end, step : float
        In s.
    """

    t_start: float
    t_end: float
    step: float

    @property
    def full(self) -> int:
        """Steps of the whole length."""
        return int(np.floor((self.t_end - self.t_start) / self.step + 1e-9))

    @property
    def rest(self) -> float:
        """Length of the shorter step at the end, s; 0 for none."""
        rest = self.t_end - self.t_start - self.full * self.step
        return rest if rest > 1e-9 * self.step else 0.0

    @property
    def steps(self) -> int:
        """All steps."""
        return self.full + (self.rest > 0.0)

    @property
    def open(self) -> int:
        """Steps until which a run with a later end would be the same.

        The rates of given motions are differences, one-sided next to the end of a run.
        """
        half = STENCIL // 2
        return min(self.full, max(self.full - half, half))

    def room(self, done: int) -> int:
        """Steps that a block may have after so many: of one length, not beyond ``open``."""
        ends = (self.open, self.full, self.steps)
        return next(end for end in ends if end > done) - done
