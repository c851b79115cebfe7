"""FarSpans: which parts of a line sleep, and how they fall asleep and wake."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np

from ...arrays import FloatArray, IntArray
from ...connections.spring_damper import IDLE, SLACK
from ...simd import LANES
from ...system.far import (
    ASLEEP,
    AWAY,
    BAR,
    CALM,
    CALMED,
    DROPPERS,
    DUE,
    EDGE,
    HUNG,
    INNER,
    NEAR,
    PLACE,
    POSITION,
    RANGES,
    RATE,
    SECOND,
    SLEEPING,
    TO_SLEEP,
    TO_WAKE,
    WATCHED,
)
from ...system.system import System
from ..step.memory import H_FACTOR, Memory
from .arrays import ACTS, FarPlan, arrays_of, kinds_of
from .far import LOOKED
from .lanes import Chunks, lanes_of, sleep, wake
from .parts import Matrices, Part, cables_of, in_order, parts_of

#: Distance, m, by which a part that may sleep is further from all strips than one that has to wake.
BETWEEN = 2.0
#: Time for which droppers have to be taut before a part sleeps, s.
CALM_TIME = 0.05
#: Largest force on the boundary of a part, N, that its linear model may leave out as it falls asleep.
LEFT = 0.2


class FarSpans:
    """The parts of a line that sleep in a run.

    Parameters
    ----------
    system : System
        Its core gets the parts, and is to be taken anew.
    memory : Memory
    plan : FarPlan
    watched : ndarray of int
        Unknowns that are recorded in every step.
    step : (float, float, float)
        Its length in s, and the factors of mass and damping in its matrix.
    """

    def __init__(
        self,
        system: System,
        memory: Memory,
        plan: FarPlan,
        watched: IntArray,
        step: tuple[float, float, float],
    ) -> None:
        self.system, self.memory = system, memory
        self.parts: list[Part] = []
        self.left_out = 0.0  # largest displacement that the modes could not take over, m
        self.neglected = 0.0  # largest force that linear parts left out as they fell asleep, N
        cables = cables_of(system)
        if cables is None:
            return
        self.cables = cables
        watched = watched[watched % 6 == ACTS]
        parts = in_order(system, parts_of(system, cables, plan.cuts))
        watched = np.union1d(watched, _hung(system))
        self.parts = [_watched_first(part, watched) for part in parts if _is_still(system, part)]
        if not self.parts:
            return
        matrices = Matrices(system, cables, self.parts, plan.rest)
        self.kinds, self.kind_of, forces = kinds_of(matrices, self.parts, plan, step[1:])
        self.far = arrays_of(system, self.parts, self.kinds, self.kind_of, forces, plan, watched)
        self.far.memo[NEAR], self.far.memo[AWAY] = plan.near, plan.near + BETWEEN
        self.far.memo[CALMED] = np.ceil(CALM_TIME / (LOOKED * step[0]))
        self.kept: list[Any] = [None] * len(self.parts)
        self.lanes = [lanes_of(cables, part.elements) for part in self.parts]
        self.rows = [_rows_of(system, part) for part in self.parts]
        self.places = [np.flatnonzero(part.inner % 6 < 3) for part in self.parts]  # displacements
        self.shown = [
            np.ascontiguousarray(kind.inside[self.places[self.kind_of.index(t)], kind.mass.shape[1] :])
            for t, kind in enumerate(self.kinds)
        ]
        self.chunks = Chunks(cables, [part.elements for part in self.parts], system.core.near[0].touched)
        self.bounds = np.ones(len(self.far.sleeps) + 2, dtype=np.int64)
        system.core = system.core._replace(far=(self.far,))

    def begin(self) -> None:
        """Let sleep what may at the start."""
        if self.parts:
            self.far.part[:, CALM] = int(self.far.memo[CALMED])
            self._go_to_sleep(self._fitting(self._calm()))

    def turn(self) -> None:
        """Wake what has to, or let sleep one part that may: a step has to wait for it."""
        found = self.far.part[:, DUE]
        due = np.flatnonzero(found == TO_WAKE).tolist()
        for k in due:
            self._wake(k)
        self._go_to_sleep([] if due else self._fitting(np.flatnonzero(found == TO_SLEEP)[:1].tolist()))

    def wake_all(self) -> list[int]:
        """Go on with the whole line; what was asleep."""
        asleep = np.flatnonzero(self.far.part[:, ASLEEP]).tolist() if self.parts else []
        for k in asleep:
            self._wake(k)
        if asleep:
            self._ranges()
        return asleep

    def sleep_on(self, parts: list[int]) -> None:
        """Let sleep what has just been woken, if it still may."""
        if parts:
            self.far.part[parts, CALM] = int(self.far.memo[CALMED])
            self._go_to_sleep([k for k in self._calm() if k in parts])

    def sleepers(self) -> dict[str, list[int]]:
        """Which parts sleep, and how long each has been calm, for a snapshot of the run."""
        if not self.parts:
            return {"asleep": [], "calm": []}
        part = self.far.part
        return {"asleep": np.flatnonzero(part[:, ASLEEP]).tolist(), "calm": part[:, CALM].tolist()}

    def put_back(self, sleepers: dict[str, list[int]]) -> None:
        """Let sleep what slept at a snapshot, in whose state all are awake now; none of a whole line."""
        if sleepers.get("asleep"):
            self._go_to_sleep(sleepers["asleep"])
        if self.parts:
            self.far.part[:, CALM] = sleepers.get("calm", 0)

    def _calm(self) -> list[int]:
        """Parts that may sleep."""
        part, memo, near = self.far.part, self.far.memo, self._distances()
        may = (part[:, ASLEEP] == 0) & (near > memo[AWAY]) & (part[:, CALM] >= memo[CALMED])
        return np.flatnonzero(may).tolist()

    def _fitting(self, parts: list[int]) -> list[int]:
        """Those that move about their rest as their modes do; the others have to be calm for longer.

        A slack stitch wire, or one that moves far, does not: to take its motion for that of modes would
        stretch it as it wakes, which feeds its motion each time.
        """
        found = []
        for k in parts:
            force = self._neglects(k)
            if force > LEFT:
                self.far.part[k, CALM] = 0
            else:
                found.append(k)
                self.neglected = max(self.neglected, force)
        return found

    def _neglects(self, k: int) -> float:
        """Force on the boundary of a part, in the direction of strips, that its modes leave out now, N."""
        part, kind, m = self.parts[k], self.kinds[self.kind_of[k]], self.memory
        own, edge = self._own(k, (m.q, m.v, m.a))
        y, v, a = own @ kind.project.T
        acts = part.edge % 6 == ACTS
        left: FloatArray = kind.coupling[:, acts].T @ (a - self._followed(k, y, v, edge[2], edge[1]))
        return float(np.linalg.norm(left))

    def _own(self, k: int, vectors: tuple[FloatArray, ...]) -> tuple[FloatArray, FloatArray]:
        """Of positions and rates: what the inside of a part does beside following its boundary, and this."""
        part, kind, far = self.parts[k], self.kinds[self.kind_of[k]], self.far
        n, first, begin = len(part.edge), far.part[k, EDGE], far.part[k, INNER]
        inside, edge = (np.array([x[at] for x in vectors]) for at in (part.inner, part.edge))
        inside[0] -= far.rest[begin : begin + len(part.inner)]
        edge[0] -= far.still[first : first + n]
        return inside - edge @ kind.inside[:, :n].T, edge

    def _followed(self, k: int, y: FloatArray, v: FloatArray, at: FloatArray, rate: FloatArray) -> FloatArray:
        """Accelerations of the modes of a part whose boundary has these accelerations and rates."""
        kind = self.kinds[self.kind_of[k]]
        pushed = kind.coupling @ at + kind.drag * (kind.coupling @ rate)
        followed: FloatArray = -kind.loss * v - kind.square * y - pushed
        return followed

    def _go_to_sleep(self, parts: list[int]) -> None:
        for k in parts:
            self._sleep(k)
        self._ranges()

    @property
    def some(self) -> bool:
        """Whether a part sleeps."""
        return bool(self.parts) and int(self.far.counts[SLEEPING]) > 0

    @contextmanager
    def woken(self) -> Iterator[None]:
        """The whole line awake for a while; what was asleep sleeps on as if nothing had been."""
        if not self.some:
            yield
            return
        kept = [x.copy() for x in self._changed()]
        asleep = self.wake_all()
        try:
            yield
        finally:
            for k in asleep:
                self._still(k)
            for x, old in zip(self._changed(), kept, strict=True):
                x[:] = old

    def _changed(self) -> list[Any]:
        """All that :meth:`wake_all` changes but the constants of cables and springs."""
        m, far = self.memory, self.far
        own = [far.part, far.sleeps, far.range, far.counts, self.chunks.touched, self.chunks.asleep]
        return [m.q, m.v, m.a, m.abar, m.a0, m.a1, m.a2, m.a3, m.memo, *own]

    def _distances(self) -> FloatArray:
        """Distances (k,) of the nearest strip, m."""
        contacts, q = self.system.parts["contacts"], self.memory.q
        value = np.where(contacts.slot >= 0, contacts.factor * q[np.maximum(contacts.slot, 0)], 0.0)
        x = value.sum(axis=1) + contacts.offset[:, 0]
        low, high = self.far.place.T
        found: FloatArray = np.maximum(np.maximum(low[:, None] - x, x - high[:, None]), 0.0).min(axis=1)
        return found

    def _sleep(self, k: int) -> None:
        part, kind, m, far = self.parts[k], self.kinds[self.kind_of[k]], self.memory, self.far
        begin = far.part[k, INNER]
        own, _ = self._own(k, (m.q, m.v, m.abar))
        y, v, bar = own @ kind.project.T
        left = own[0, self.places[k]] - self.shown[self.kind_of[k]] @ y
        self.left_out = max(self.left_out, float(np.abs(left).max()))
        a = self._followed(k, y, v, m.a[part.edge], m.v[part.edge])
        for row, values in ((POSITION, y), (RATE, v), (SECOND, a), (BAR, bar)):
            self._put(k, row, values)
        hidden = slice(begin + far.kind[self.kind_of[k], WATCHED], begin + len(part.inner))
        m.q[far.inner[hidden]], m.v[far.inner[hidden]] = far.rest[hidden], 0.0
        m.a[part.inner] = 0.0
        self._still(k)
        self._alone(k)
        self._mark(k, 1)

    def _alone(self, k: int) -> None:
        """Let the rows of a part in the factors be those of the identity."""
        factor, b, rows = self.system.core.factor, self.parts[k].blocks, self.rows[k]
        for values, places in ((factor.L, rows), (factor.LT, rows), (factor.D_inv, b)):
            values.reshape(-1, 36)[places] = 0.0
        factor.D_inv.reshape(-1, 36)[b, ::7] = 1.0

    def _still(self, k: int) -> None:
        """Take stiffness and mass from the cables of a part, and let its droppers push for themselves."""
        self.kept[k] = sleep(self.cables, self.lanes[k])
        springs = self.system.springs.data
        springs[self.parts[k].springs, SLACK], springs[self.parts[k].springs, IDLE] = 0.0, 1.0

    def _wake(self, k: int) -> None:
        part, kind, m = self.parts[k], self.kinds[self.kind_of[k]], self.memory
        far, first = self.far, self.far.part[k, EDGE]
        still = far.still[first : first + len(part.edge)]
        rest = far.rest[far.part[k, INNER] :][: len(part.inner)]
        modes = [self._get(k, row) for row in (POSITION, RATE, SECOND, BAR)]
        edge = (m.q[part.edge] - still, m.v[part.edge], m.a[part.edge], m.abar[part.edge])
        seen = kind.inside @ np.vstack([np.stack(edge, 1), np.stack(modes, 1)])
        m.q[part.inner] = rest + seen[:, 0]
        m.v[part.inner], m.a[part.inner], m.abar[part.inner] = seen[:, 1:].T
        for vector in (m.a0, m.a1, m.a2, m.a3):
            vector[part.inner] = m.a[part.inner]
        wake(self.cables, self.lanes[k], self.kept[k])
        first = far.part[k, HUNG]
        springs = self.system.springs.data
        springs[far.hung[first : first + far.part[k, DROPPERS]], SLACK] = 1.0
        springs[part.springs, IDLE] = 0.0
        far.part[k, CALM] = 0
        self._mark(k, 0)

    def _put(self, k: int, row: int, values: FloatArray) -> None:
        lanes = self.far.state[row].reshape(-1)
        first = LANES * self.far.part[k, PLACE]
        lanes[first : first + len(values)] = values

    def _get(self, k: int, row: int) -> FloatArray:
        lanes = self.far.state[row].reshape(-1)
        first = LANES * self.far.part[k, PLACE]
        found: FloatArray = lanes[first : first + len(self.kinds[self.kind_of[k]].square)]
        return found

    def _mark(self, k: int, asleep: int) -> None:
        self.far.part[k, ASLEEP] = asleep
        self.far.sleeps[self.parts[k].blocks] = asleep
        self.chunks.mark(k, asleep)

    def _ranges(self) -> None:
        """Ranges of blocks that are awake; the matrix is another one."""
        far = self.far
        self.bounds[1:-1] = far.sleeps
        turns = np.flatnonzero(self.bounds[1:] != self.bounds[:-1])  # they begin and end by turns
        far.counts[RANGES], far.counts[SLEEPING] = len(turns) // 2, int(far.part[:, ASLEEP].sum())
        far.range.reshape(-1)[: len(turns)] = turns
        self.memory.memo[H_FACTOR] = 0.0


def _hung(system: System) -> IntArray:
    """Heights of the ends of all springs: what their forces follow from."""
    springs = system.springs
    slots: IntArray = springs.base[(springs.base >= 0) & (springs.factor != 0.0)]
    return slots + ACTS


def _rows_of(system: System, part: Part) -> IntArray:
    """Blocks beside the diagonal that a part has in the factors."""
    start = system.core.factor.row_start
    rows: IntArray = np.concatenate([np.arange(start[b], start[b + 1]) for b in part.blocks.tolist()])
    return rows


def _is_still(system: System, part: Part) -> bool:
    """Whether the loads on it are the same at all times."""
    mine = set(part.inner.tolist())
    for (slots, _), function in zip(system.patterns, system.inputs.loads, strict=False):
        if not function.constant and mine & set((slots[:, None] + np.arange(3)).ravel().tolist()):
            return False
    return True


def _watched_first(part: Part, watched: IntArray) -> Part:
    """Its unknowns with those that are recorded before all others."""
    seen = np.isin(part.inner, watched)
    order = np.concatenate([np.flatnonzero(seen), np.flatnonzero(~seen)])
    return part._replace(inner=part.inner[order], number=order)
