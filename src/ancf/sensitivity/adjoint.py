"""The adjoint of a simulation: one number's derivatives by any number of parameters, in bounded memory.

A first pass takes the steps and leaves a snapshot at the beginning of each block of them.  The second goes
through the blocks from the last to the first: their states come back by taking their steps again, to the last
bit, and the adjoint goes back through them (:mod:`ancf.solvers.derivatives.adjoint`).
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import SolveError
from ..preparation import Prepared
from ..results.state import State
from ..solvers.derivatives.adjoint import back_start, back_steps
from ..solvers.derivatives.ahead import ahead_of
from ..solvers.derivatives.friction import Friction
from ..solvers.derivatives.friction_back import Forgetting, nothing_forgotten
from ..solvers.derivatives.sensitivity import Way, accelerations
from ..solvers.status import OK
from ..system.core import follow_supports
from ..system.system import System
from .base import check_differentiable, matrices_of
from .blocks import Block, Collector, Keeping
from .family import Family
from .follow import Trail, check_method, given_start, when_cut
from .jumps import end_at_jumps
from .memory_back import MemoryBack
from .nearby import Nearby
from .objective import Asked, Key, Objective
from .parameters import Parameter
from .remembering import friction_of
from .start import Start
from .weighed import Weighed


class UnsolvedError(SolveError):
    """The equations of an adjoint cannot be solved."""

    def __init__(self) -> None:
        super().__init__("gradient", "the equations of the adjoint cannot be solved", "smaller steps")


class Adjoint:
    """A simulation that is gone through forwards and backwards.

    Parameters
    ----------
    made : Prepared
        At its start, every step stored.
    parameters : list of Parameter
    start : State or None
    """

    objective: Objective | None = None

    def __init__(self, made: Prepared, parameters: list[Parameter], start: State | None, where: str) -> None:
        self._check(made, start, where)
        self.run: Any = made.run
        self.system = System(made.system.model, like=made.system)
        self.memory = MemoryBack(self.system) if friction_of(self.system) else None
        check_differentiable(self.system, where, follows=True)
        self.families = [Family(parameter, self.system, shifts=True) for parameter in parameters]
        self.nearby = Nearby(self.families, self.system, shifts=True)
        marked = self.memory.marked if self.memory else None
        self.weighed = Weighed(self.nearby, marked.batches if marked else None)
        instead = marked.instead(self.system) if marked else ()
        self.m = matrices_of(self.system.core, self.system.size, moving=True, back=True, marked=instead)
        self._check_memory(start)
        self.ahead = ahead_of(self.system.core, self.m)
        self.given = given_start(self.families, self.run.t_start, self.system, start, where)
        self._shifts: FloatArray | None = None  # factors of C of joints at the steps of a block, (n, size)
        self.blocks: list[Block] = []
        end_at_jumps(self.run, UnsolvedError)  # over these sensitivities go forwards
        self._prepare()

    def _check(self, made: Prepared, start: State | None, where: str) -> None:
        """Raise ModelError if the method, or how the run begins, has no adjoint."""
        check_method(made, where)

    def _check_memory(self, start: State | None) -> None:
        """Raise UnsolvedError if parameters do more to what friction remembers than is gone back through."""
        memory = self.memory
        if memory and not (memory.allows(self.families, self.weighed) and memory.take(start, self.families)):
            raise UnsolvedError

    @property
    def back(self) -> Forgetting:
        """What kernels have of that."""
        return self.memory.back if self.memory else nothing_forgotten()

    def _remember(self, friction: Friction) -> None:
        """Let batches with friction know what they remember in the steps that come."""
        self.ahead, self.weighed.friction = self.ahead._replace(friction=friction), friction

    def _prepare(self) -> None:
        """What else a kind of adjoint has."""

    def ask(self, asked: Asked, unknowns: Mapping[Key, IntArray]) -> None:
        """Say of what the number is made, before it is gone through backwards.

        Parameters
        ----------
        asked : function
            How histories are found, see ``Asked``.
        unknowns : mapping
            By the questions on which the number depends the entries of the state vectors on which these do.
        """
        self.objective = Objective(self.system, self.families, asked, unknowns)
        self.unknowns = self.objective.unknowns

    def forwards(self, others: Any = None) -> tuple[FloatArray, dict[Any, FloatArray]]:
        """Take all steps; times and histories of what is asked by now.

        ``others``: a recorder that takes samples of sensors, the first state and the last one.
        """
        run, store = self.run, Collector(others)
        run.begin(store)
        t, q, v = store.taken()
        self.first = q[0].copy(), v[0].copy(), run.memory.a.copy()
        self.begun = self.memory.keep(run) if self.memory else {}
        times, found = [t], [self._histories(q, v)]
        keeping = Keeping(self.system, run.steps, bool(self.memory))
        each = 8 * self.system.size * (6 * len(self.nearby.others) + 12)
        most = keeping.most(each, int(run.steps))
        while run.done < run.steps:
            h = run.h if run.done < run.full else run.rest
            block = Block(run.done, self._count(most), h, None if keeping.some else run.snapshot())
            block.memory = self.memory.keep(run) if self.memory else {}
            trail, before = Trail(run), run.memory.q.copy()
            self._take(block.count, store)
            t, q, v = store.taken()
            if keeping.some:
                block.kept = keeping.keep(before, q, v, trail, run.memory.a.copy())
            times.append(t)
            found.append(self._histories(q, v))
            self.blocks.append(block)
        store.end()
        self.t = np.concatenate(times)
        return self.t, {key: np.concatenate([one[key] for one in found]) for key in found[0]}

    def _histories(self, q: FloatArray, v: FloatArray) -> dict[Key, FloatArray]:
        return self.objective.histories(q, v) if self.objective is not None else {}

    def _count(self, most: int) -> int:
        """Steps of the next block: so many that what the run hands over at once need not be put together."""
        run = self.run
        left: int = (run.full if run.done < run.full else run.steps) - run.done
        at_once: int = min(run.look - run.done, run.span.room(run.done))
        return min(most, left) if at_once < most // 4 else -(-at_once // -(-at_once // most))

    def backwards(self, slopes: dict[Any, FloatArray]) -> FloatArray:
        """Derivatives of the number by the parameters, (p,), from those by the histories."""
        run, system = self.run, self.system
        assert self.objective is not None
        total, mu = np.zeros(len(self.families)), np.zeros((4, system.size))
        still = np.zeros(system.size)  # by derivatives of q that are the same at all times
        room, self._room_a = np.zeros((2, max(block.count for block in self.blocks), system.size))
        for block in reversed(self.blocks):
            rows = slice(block.done + 1, block.done + block.count + 1)
            own = {key: slope[rows] for key, slope in slopes.items()}
            way = self._way(block)
            wanted = self.objective.wanted(way.q, way.v, own)
            when = run.time(block.done), block.h, run.t_start, run.t_end
            lam = room[: len(way.q)]
            tables = system.inputs.tables(*when[:2], block.count, *when[2:])
            if self.memory:
                self._remember(self.memory.look(block.memory, way, tables))
            lost, turned = np.zeros(system.size), np.zeros((self.weighed.turning, 3, 3))
            if self._back(way, block.h, tables, wanted, (mu, lam, lost, turned)) != OK:
                raise UnsolvedError
            still -= lost
            still[self.unknowns] += np.sum(wanted[:, 0], axis=0)
            self._add_axes(way, wanted, turned)
            total += self._pushed(way, when, tables, wanted, lam, turned)
            total += self.objective.explicit(way.q, way.v, own)
            block.kept = None
        total += self._of_start({key: slope[:1] for key, slope in slopes.items()}, mu, still)
        for k, shift in self.nearby.shifts.items():
            total[k] += still @ self._followed(shift)
        return total

    def _back(self, way: Way, h: float, tables: Any, wanted: FloatArray, sums: Any) -> int:
        """Carry the adjoint back through a block, see :func:`back_steps` for the sums; a status."""
        given = self.system.core, self.m, self.ahead, tables, way, wanted, self.unknowns
        _, status = back_steps(*given, h, self.run.scheme, *sums)
        return int(status)

    def _add_axes(self, way: Way, wanted: FloatArray, turned: FloatArray) -> None:
        """Take from ``turned`` the derivatives of the number by local axes through the states there."""
        supports = self.system.core.supports
        for k in range(len(turned)):
            i, j = supports.rot_slot[k], supports.rot_shadow[k]
            for c in range(3):
                for m in np.flatnonzero(self.unknowns == j + c):
                    for n, x in enumerate((way.q, way.v)):
                        turned[k, c] -= wanted[:, n, m] @ x[:, i : i + 3]

    def _pushed(
        self, way: Way, when: Any, tables: Any, wanted: FloatArray, lam: FloatArray, turned: FloatArray
    ) -> FloatArray:
        """What is due to what parameters do to the states of a block at fixed free unknowns."""
        made = -self.weighed.at_steps(way, when, tables, lam, turned)
        for k in self.nearby.others:
            family = self.families[k]
            family.know(self.system)
            found = family.at_steps(*way, when, gaps=self._shifts is not None)
            held = np.moveaxis(found.held[:2], 0, 1)[:, :, self.unknowns]
            made[k] += np.sum(held * wanted) - np.sum(lam * found.push)
            if self._shifts is not None:
                made[k] -= np.sum(self._shifts * found.gap)
        return made

    def _followed(self, shift: FloatArray) -> FloatArray:
        """A derivative of q that is the same at all times, the shadows filled."""
        moved, still = shift.copy(), np.zeros((2, shift.size))
        follow_supports(self.system.core.supports, moved, *still)
        return moved

    def _of_start(self, slopes: dict[Any, FloatArray], mu: FloatArray, still: FloatArray) -> FloatArray:
        """What parameters do to the start; ``still`` is added to."""
        run, system = self.run, self.system
        first = self.first
        assert self.objective is not None
        wanted = self.objective.wanted(first[0][None].copy(), first[1][None].copy(), slopes)
        when = (run.t_start - run.h, run.h, run.t_start, run.t_end)
        if self.memory:
            way, tables = Way(*(x[None].copy() for x in first)), system.inputs.tables(*when[:2], 1, *when[2:])
            self._remember(self.memory.start(self.begun, way, tables))
        total = self._back_start(Start(system, self.m, *first, when), when, wanted, mu, still)
        still[self.unknowns] += wanted[0, 0]
        if self.memory:
            self.memory.hand_to(self.weighed)
            total += self.memory.of_start(len(total))
        total -= self.weighed.in_all(when, system.inputs.tables(*when[:2], 1, *when[2:]))
        total += [float(mu[0] @ dq + mu[1] @ dv) for dq, dv in self.given]
        return (
            total + self.objective.explicit(first[0][None], first[1][None], slopes) + self.objective.of_sums()
        )

    def _back_start(
        self,
        begin: Start,
        when: tuple[float, float, float, float],
        wanted: FloatArray,
        mu: FloatArray,
        still: FloatArray,
    ) -> FloatArray:
        """Carry the adjoint through what makes a start consistent; what parameters do to that."""
        system, lam, lost = self.system, np.zeros_like(begin.q), np.zeros_like(begin.q)
        turned = np.zeros((self.weighed.turning, 3, 3))
        self._through_start(begin, wanted, mu, (lam, lost, turned))
        still -= lost
        way = Way(*(x[None] for x in (begin.q, begin.v, begin.a)))
        self._add_axes(way, wanted, turned)
        tables = system.inputs.tables(*when[:2], 1, *when[2:])
        return self._pushed(way, when, tables, wanted, lam[None], turned)

    def _through_start(self, begin: Start, wanted: FloatArray, mu: FloatArray, sums: Any) -> None:
        """Carry the adjoint through the accelerations of a start, see :func:`back_start` for the sums."""
        y = begin.q, begin.v, begin.a
        back_start(self.system.core, self.m, y, wanted[0], self.unknowns, mu, *sums)

    def _take(self, count: int, store: Collector) -> None:
        run = self.run
        end = run.done + count
        while run.done < end:
            run.take(min(end - run.done, run.look - run.done, run.span.room(run.done)), store)
        when_cut(run, run.done)

    def _way(self, block: Block) -> Way:
        """The states of a block, taken again if they were not kept."""
        a = self._room_a[: block.count]
        if block.kept is None:
            assert block.snapshot is not None
            run, store = self.run, Collector()
            run.put_back(block.snapshot)
            trail = Trail(run)
            self._take(block.count, store)
            _, q, v = store.taken()
            end = run.memory.a
        else:
            q, v, trail, end = block.kept.states(block.h, self.run.scheme)
        accelerations(v, block.h, self.run.scheme, trail.before, a)
        a[-1] = end
        return Way(q, v, a)
