"""Functions of time of a run that is led, tabulated for many steps ahead and at little cost."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..system.core import Tables
from ..system.inputs import Inputs, differences, on_grid

#: Steps ahead, and of how many of them a piece of the tables has the motions.
ROWS, PIECE = 256, 64
#: Distance of a place in time from the grid of the steps, in steps, up to which it is on it.
ON_GRID = 1e-6


class Foreseen(Inputs):
    """Inputs whose tables are made for many steps at once, and given out in the parts that are asked for.

    A controller that is asked at every step would have them made anew each time, which costs more than the
    step. Only loads that depend on the model's inputs are computed again.
    """

    def __init__(self, inputs: Inputs) -> None:
        vars(self).update(vars(inputs))
        self._base, self._grid = 0, (0.0, 0.0, 0.0)  # step before the first row; length of steps, times
        self._known: Tables | None = None
        self._timely = [k for k, load in enumerate(self.loads) if not load.constant]
        self._constant: FloatArray | None = None
        alike = all(m.rates is None and m.drive is None for m in self.motions)
        self._plain = alike and not self.rotations

    def tables(
        self,
        start: float,
        step: float,
        steps: int,
        first: float,
        last: float,
        here: tuple[FloatArray, FloatArray] | None = None,
        still: bool = False,
    ) -> Tables:
        """As :meth:`Inputs.tables` makes them."""
        place = (start - first) / step
        before, asked = round(place) if abs(place) < 1e15 else 0, (start, step, steps, first, last)
        if self.drives or still or abs(place - before) > ON_GRID:
            return super().tables(*asked, here, still)
        if steps > ROWS // 2:
            return self._made(*asked)
        at = before - self._base
        if self._known is None or self._grid != (step, first, last) or not 0 <= at <= self._rows - steps:
            room = int(min((last - start) / step + ON_GRID, ROWS))
            try:
                self._known = self._made(start, step, max(steps, room), first, last)
            except ModelError:  # a function of time fails, perhaps further on than is asked for
                self._known = None
                return super().tables(*asked)
            self._base, self._grid, at = before, (step, first, last), 0
        rows = slice(at, at + steps)
        found = Tables(*(table[rows] for table in self._known))
        if self.led:
            times = on_grid(start, step, np.arange(1, steps + 1), first)
            for load in self.led:
                found.value[:, load] = self.loads[load].under(self.given, times)
        return found

    @property
    def _rows(self) -> int:
        return 0 if self._known is None else len(self._known.value)

    def _made(
        self,
        start: float,
        step: float,
        steps: int,
        first: float,
        last: float,
        known: FloatArray | None = None,
    ) -> Tables:
        """Tables with the constant loads as they were, and one difference formula for all motions.

        ``known`` are the motions, if they are, (steps, unknowns, 3).
        """
        if not self._plain:
            return super().tables(start, step, steps, first, last)
        times = on_grid(start, step, np.arange(1, steps + 1), first)
        if self._constant is None:
            rows = [load(float(times[0])) if load.constant else np.zeros(3) for load in self.loads]
            self._constant = np.array(rows).reshape(-1, 3)
        value = np.repeat(self._constant[None], steps, axis=0)
        for k in self._timely:
            value[:, k] = self.loads[k].under(self.given, times)
        motion = np.zeros((steps, 0, 3)) if known is None else known
        if known is None and self.motions:
            motion = np.stack(differences(self._ways, times, step, first, last), axis=-1)
            motion[:, :, 0] += np.concatenate(
                [np.broadcast_to(m.rest, len(m.unknowns)) for m in self.motions]
            )
        return Tables(value, motion, np.zeros((steps, 0, 3, 3, 3)))

    @property
    def pieces(self) -> int:
        """In how many pieces tables of as many steps as can be can be made, 1: at once alone."""
        return len(self.motions) * (ROWS // PIECE) + 1 if self._plain and not self.drives else 1

    def piecewise(
        self, start: float, step: float, steps: int, first: float, last: float
    ) -> Iterator[Tables | None]:
        """The tables that :meth:`tables` makes of many steps, made piece by piece; the last one is them."""
        times = on_grid(start, step, np.arange(1, steps + 1), first)
        motion = np.zeros((steps, sum(len(one.unknowns) for one in self.motions), 3))
        column = 0
        for one in self.motions:
            columns = slice(column, column + len(one.unknowns))
            for begin in range(0, steps, PIECE):
                rows = slice(begin, begin + PIECE)
                for k, found in enumerate(differences(one.values, times[rows], step, first, last)):
                    motion[rows, columns, k] = found if k else one.rest + found
                yield None
            column = columns.stop
        yield self._made(start, step, steps, first, last, motion)

    def _ways(self, times: FloatArray) -> FloatArray:
        """All given motions from where they rest, side by side."""
        return np.concatenate([motion.values(times) for motion in self.motions], axis=1)
