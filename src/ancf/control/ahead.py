"""Steps one by one at little cost: functions of time are tabulated for many steps ahead."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError, SolveError
from ..model.functions.expression import Expression
from ..results.store import MemoryStore
from ..solvers.quick import DONE, PACKED, Quick
from ..solvers.sleeping.far import LOOKED
from ..solvers.status import EVENT, OK, SLOW, TURN
from ..solvers.stepping import Run
from ..system.core import Tables
from ..system.drives import driven_steps
from ..system.inputs import on_grid
from .foreseen import Foreseen

#: Steps ahead, and after how many of them at most a piece of the next tables is made.
ROWS, STRIDE = 256, 32


class Ahead:
    """The next steps of a run; how many are taken at once changes nothing of what is computed.

    Parameters
    ----------
    run : Run
        Started, or restored.
    store : MemoryStore
        Takes what sensors record.
    """

    def __init__(self, run: Run, store: MemoryStore) -> None:
        self.run, self.store = run, store
        inputs = run.system.inputs
        assert isinstance(inputs, Foreseen)
        self.inputs, self.memo = inputs, run.memory.memo
        self.led: list[tuple[int, Any, Expression]] = []  # loads, their components, formulas of inputs
        for load in self.inputs.led:
            function = self.inputs.loads[load]
            one = function.size == 1  # a number stands in all three
            self.led += [(load, slice(None) if one else part, formula) for part, formula in function.led]
        bundle = run.bundle(ROWS)
        self.tables, self.out = bundle.tables, bundle.out
        self.quick = Quick(bundle)
        self.step = self.quick.step
        self.stride = int(np.clip(ROWS // (inputs.pieces + 1), 1, STRIDE))
        if self.stride > LOOKED:
            self.stride -= self.stride % LOOKED
        slow = bool(self.inputs.drives) or any(f.uses_t for *_, f in self.led)
        self.cells = None if slow else self._cells()
        self.row: Any = self.tables.value.reshape(-1).data
        self.sure = False  # the next step may be taken by the shortest way
        self.base = run.done  # steps before the first row
        self.at = self.rows = self.given = 0  # next row, rows that may be taken, and those with inputs of now
        self.made = 0  # rows that are tabulated; those behind `rows` are not taken yet
        self.coming: Iterator[Tables | None] | None = None  # makes the tables of the steps after these
        self.next: Tables | None = None  # these, once they are made
        self.width = 1  # rows that get inputs at once
        self.handed = 0  # rows whose samples are stored
        self.changes = self.inputs.changes

    def take(self, steps: int) -> None:
        """Take some steps; see :meth:`ancf.Stepper.advance`."""
        run, end = self.run, self.run.done + steps
        while run.done < end:
            if self.at == self.rows:
                self.tabulate(end - run.done)
            if self.changes != self.inputs.changes:
                self.changes, self.given, self.width = self.inputs.changes, self.at, 1
            count = min(end, run.look, self.base + self.rows) - run.done
            if self.given < self.at + count:
                self.lead(count)
            self.settle(*((0, SLOW) if run.hesitates else self.quick.take(self.at, count)))
            run.heed_energy()
        self.sure = not run.hesitates

    def settle(self, done: int, status: int) -> None:
        """Go on after so many steps, and see to what ended the last one."""
        run = self.run
        self.at += done
        run.done += done
        if status >= EVENT:
            run.happened(status - EVENT, run.time(run.done), run.done)
            run.store(-1, self.at - 1, self.out)
        elif status == TURN:
            run.turn()
        elif status != OK:
            self.bridge(status)

    def one(self) -> bool:
        """Take a step with as little Python as there can be; whether that was possible."""
        at, run = self.at, self.run
        if at == self.rows or not self.sure:
            return False
        if self.changes != self.inputs.changes:
            if self.cells is None:
                return False
            first, row, given = at * self.wide, self.row, self.inputs.given
            for cells, name, formula in self.cells:
                number = given[name] if name else formula.at(given)
                if not name and not math.isfinite(number):
                    return False
                for cell in cells:
                    row[first + cell] = number
            self.changes, self.given, self.width = self.inputs.changes, at + 1, 1
        elif at >= self.given:
            return False
        packed = self.step(at, 1)
        if packed == DONE:
            self.at = at + 1
            run.done += 1
        else:
            self.sure = False
            self.settle(*divmod(packed, PACKED))
            self.sure = not run.hesitates
        if run.done == run.look:
            run.heed_energy()
        return True

    def _cells(self) -> list[tuple[list[int], str, Expression]]:
        """Places in a row of the table that depend on an input, its name, or else a formula."""
        self.wide = self.tables.value[0].size
        found = []
        for load, component, formula in self.led:
            parts = range(3) if isinstance(component, slice) else (component,)
            name = formula.text if formula.text in self.inputs.given else ""
            found.append(([3 * load + part for part in parts], name, formula))
        return found

    def rewound(self) -> None:
        """The run is elsewhere now: go on from there with the tables that are made, if they reach there."""
        at = self.run.done - self.base
        if not 0 <= at <= self.made:
            self.base, self.rows, self.made, at = self.run.done, 0, 0, 0
            self.coming = self.next = None
        self.at = self.given = self.handed = at
        self.rows, self.width, self.sure = max(self.rows, at), 1, False

    def bridge(self, status: int) -> None:
        """A step that has failed, in smaller ones; if these fail too, everything is as it was before."""
        run, before = self.run, self.run.snapshot()
        try:
            run.bridged(run.time(run.done), run.h, run.done + 1, status)
        except (SolveError, ModelError):
            run.put_back(before)
            raise
        run.store(-1, self.at, self.out, run.bridge.sample)
        self.at += 1
        run.done += 1
        if self.inputs.drives:  # lengths go on from where the parts of the step have left them
            self.given, self.width = self.at, 1

    def tabulate(self, wanted: int) -> None:
        """Functions of time of the next steps; of those that are wanted if one fails further on.

        Where these are many the steps after those are tabulated meanwhile, piece by piece: no single step
        has to wait for all of them.
        """
        if self.rows < self.made:
            self.prepare(-(-self.inputs.pieces // (ROWS // self.stride - 1)))
            self.hand_over()
            self.rows = min(self.rows + self.stride, self.made)
            return
        self.hand_over()
        self.prepare(self.inputs.pieces)
        found, self.coming, self.next = self.next, None, None
        self.given = 0 if self.led else ROWS  # inputs may have changed since
        if found is None:
            found, self.given = self.tabled(wanted), ROWS
        rows = len(found.value)
        for x, y in zip(found, self.tables, strict=True):
            y[:rows] = x
        self.base, self.at, self.handed, self.rows, self.made = self.run.done, 0, 0, rows, rows
        self.given, self.changes = min(self.given, rows), self.inputs.changes
        if rows == ROWS and self.inputs.pieces > 1:
            run = self.run
            times = run.time(run.done + rows), run.h, rows, run.t_start, run.t_end
            self.coming = self.inputs.piecewise(*times)
            # in the middle between steps in which parts of a line turn: no step has to wait for both
            self.rows = self.stride + (LOOKED // 2 - self.base - self.stride) % LOOKED

    def tabled(self, wanted: int) -> Tables:
        """Tables of as many of the next steps as can be made at once."""
        run = self.run
        for rows in (ROWS, min(wanted, ROWS), 1):
            try:
                times = run.time(run.done), run.h, rows, run.t_start, run.t_end
                return self.inputs.tables(*times, self.here)
            except ModelError:
                if rows == 1:
                    raise
        raise AssertionError

    def prepare(self, pieces: int) -> None:
        """Make some pieces of the tables that come, if there are any left to make."""
        try:
            for _ in range(pieces):
                if self.coming is not None and self.next is None:
                    self.next = next(self.coming)
        except ModelError:  # a function fails further on: said when it is asked for
            self.coming = None

    def lead(self, count: int) -> None:
        """Loads that depend on inputs, of the next steps; of ever more while the inputs stay as they are."""
        first = self.given
        last = min(first + max(count, self.width), self.rows)
        self.width *= 2
        try:
            self.drive(first, last)
        except ModelError:  # perhaps further on than is asked for
            last = self.at + count
            self.drive(first, last)
        value, given, times = self.tables.value, self.inputs.given, np.zeros(0)
        for load, component, formula in self.led:
            if not formula.uses_t:
                number = formula.at(given)
                value[first:last, load, component] = number
                sound = math.isfinite(number)
            else:
                times = self.times(first, last) if not len(times) else times
                values = formula.under(given, times)
                value[first:last, load, component] = values[:, None] if component == slice(None) else values
                sound = bool(np.all(np.isfinite(values)))
            if not sound:  # this says where, when and what
                self.inputs.loads[load].under(given, self.times(first, last))
        self.given = last

    @property
    def here(self) -> tuple[FloatArray, FloatArray]:
        """State vectors now."""
        return self.run.memory.q, self.run.memory.v

    def drive(self, first: int, last: int) -> None:
        """Lengths that follow from step to step in the rows from ``first`` to ``last``."""
        for drive in self.inputs.drives:
            if first == self.at:
                length, rate = (float(x[drive.unknown]) for x in self.here)
            else:
                length, rate = self.tables.motion[first - 1, drive.column, :2].tolist()
            times = self.times(first, last)
            found = driven_steps(drive.winch, length, rate, times, self.run.h, self.inputs.given)
            drive.put(self.tables, slice(first, last), found)

    def times(self, first: int, last: int) -> FloatArray:
        """Times at the ends of the steps of some rows, s."""
        run = self.run
        return on_grid(run.time(self.base), run.h, np.arange(first + 1, last + 1), run.t_start)

    def hand_over(self) -> None:
        """Store what was recorded."""
        if self.run.sampling.width and self.at > self.handed:
            numbers = np.arange(self.base + self.handed + 1, self.base + self.at + 1)
            times: FloatArray = self.run.t_start + self.run.h * numbers.astype(
                np.float64
            )  # as :meth:`Run.time`
            self.store.record(times, self.out.samples[self.handed : self.at].copy())
        self.handed = self.at
