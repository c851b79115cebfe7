"""What of a line can sleep: parts between given boundaries, their matrices and their modes.

Craig and Bampton's substructures, Coupling of substructures for dynamic analyses, AIAA Journal 6 (1968) 1313.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np

from ...arrays import BoolArray, FloatArray, IntArray
from ...compiled import traits
from ...elements.cable import CableBatch
from ...later import connected_components, coo_array, csc_array, csr_array, eigh, splu
from ...system.core import apply_load, assemble, residual
from ...system.matrix import Places
from ...system.system import System
from .lanes import lanes_of, sleep, wake

#: Blocks of which a part consists at least: smaller ones are not worth it.
FEWEST = 24
#: Share of the largest entries up to which the matrices of two parts are alike.
ALIKE = 1e-4
#: Batches that a line with parts may have.
KNOWN = ("springs", "bodies", "contacts")


class Part(NamedTuple):
    """A part of a line: unknowns, cable elements and springs of its own."""

    inner: IntArray  # unknowns inside that move
    number: IntArray  # their places along the wires
    edge: IntArray  # unknowns of its boundary that move
    blocks: IntArray
    elements: IntArray  # of the cables' batch
    springs: IntArray


class Kind(NamedTuple):
    """Parts that are alike: modes with a boundary that is fixed, and the boundary itself.

    ``inside`` are the columns [Psi Phi] of the unknowns inside, (inner, edge + modes), ``project`` gives the
    modes of displacements with x = 0, (modes, inner).
    """

    square: FloatArray
    loss: FloatArray
    drag: FloatArray
    coupling: FloatArray
    inside: FloatArray
    project: FloatArray
    mass: FloatArray
    damping: FloatArray
    stiffness: FloatArray


def cables_of(system: System) -> CableBatch | None:
    """The cables of a system in which nothing keeps parts from sleeping; None in others."""
    found = {n: b for n, b in system.parts.items() if isinstance(b, CableBatch) and len(b.base)}
    others = [n for n, b in system.parts.items() if len(b[0]) and n not in KNOWN and n not in found]
    plain = not system.core.accounted and not system.constraints.rotations and not len(system.multipliers)
    able = len(found) == 1 and not others and plain and system.core.near
    return next(iter(found.values())) if able else None


def parts_of(system: System, cables: CableBatch, cuts: IntArray) -> list[Part]:
    """The parts between blocks that cut a line, with nothing but cables between those and what is inside."""
    n, pairs = system.numbering.blocks, system.pairs
    cut = np.zeros(n, dtype=bool)
    cut[cuts] = True
    inside = pairs[~cut[pairs].any(axis=1)]
    graph = coo_array((np.ones(len(inside)), (inside[:, 0], inside[:, 1])), shape=(n, n))
    number = connected_components(graph, directed=False)[1]
    number[cut] = -1
    free = np.zeros(system.size, dtype=bool)
    free[system.free] = True
    reached = [_blocks_of(batch, n) for batch in (cables, system.springs)]
    driven = set((system.inputs.prescribed // 6).tolist())
    parts = []
    for k in np.flatnonzero(np.bincount(number[~cut], minlength=1) >= FEWEST):
        mine = number == k
        blocks = np.flatnonzero(mine)
        touching = pairs[mine[pairs].any(axis=1)]
        edge = np.setdiff1d(touching, blocks)
        of_cables, of_springs = (_touching(table, mine) for table in reached)
        if driven & {*blocks.tolist(), *edge.tolist()} or not _is_closed(
            system, mine, of_springs, reached[1]
        ):
            continue
        if len(edge):
            inner = _free(free, blocks)
            places = np.arange(len(inner))
            parts.append(Part(inner, places, _free(free, edge), blocks, of_cables, of_springs))
    return parts


def _free(free: BoolArray, blocks: IntArray) -> IntArray:
    """Unknowns of blocks that move."""
    unknowns: IntArray = (6 * blocks[:, None] + np.arange(6)).ravel()
    return unknowns[free[unknowns]]


def _blocks_of(batch: Any, none: int) -> IntArray:
    """Blocks of the unknowns of each part of a batch, ``none`` where there is none."""
    base: IntArray = getattr(batch, traits(batch).slots[0])
    blocks: IntArray = np.where(base >= 0, base // 6, none)
    return blocks


def _touching(table: IntArray, mine: BoolArray) -> IntArray:
    return np.flatnonzero(np.append(mine, False)[table].any(axis=1))


def _is_closed(system: System, mine: BoolArray, springs: IntArray, table: IntArray) -> bool:
    """Whether springs and bodies are inside altogether, and the springs carry at rest by their stiffness."""
    within = np.append(mine, True)[table[springs]].all()
    batch = system.springs
    plain = (
        not batch.data[springs, 4].any()
        and not np.diff(batch.begins)[np.r_[2 * springs, 2 * springs + 1]].any()
    )
    return bool(within and plain)


def in_order(system: System, parts: list[Part]) -> list[Part]:
    """The same parts with their unknowns sorted along their wires, so that parts that are alike show it."""
    key = np.zeros(system.numbering.blocks, dtype=np.int64)
    begin = 0
    for slots in reversed(system.numbering.slots.values()):
        blocks = slots // 6
        key[blocks] = begin - np.arange(len(blocks), 0, -1)[:, None]
        begin -= len(blocks)

    def sort(unknowns: IntArray) -> IntArray:
        return unknowns[np.lexsort((unknowns % 6, unknowns // 6, key[unknowns // 6]))]

    return [part._replace(inner=sort(part.inner), edge=sort(part.edge)) for part in parts]


class Blocks(NamedTuple):
    """A symmetric matrix of a part: inside, between inside and boundary, and on the boundary."""

    inner: Any  # sparse (inner, inner)
    mixed: Any  # sparse (inner, edge)
    edge: FloatArray  # (edge, edge), of the part alone

    def sorted(self, order: IntArray) -> Blocks:
        """The same with the unknowns inside in another order."""
        inner = self.inner[order][:, order]
        inner.sort_indices()
        return Blocks(inner, self.mixed[order], self.edge)


class Matrices:
    """Mass, damping and stiffness of a line at rest, and of parts of it alone.

    Parameters
    ----------
    system : System
    cables : CableBatch
    parts : list of Part
    q : ndarray, shape (size,)
        The line at rest without strips.
    """

    def __init__(self, system: System, cables: CableBatch, parts: list[Part], q: FloatArray) -> None:
        self.system, self.q = system, q
        self._pattern = _pattern(system.places)
        values = self._values()
        self.whole, self.force = [self._matrix(x) for x in values], self._residual()
        self.alone, self.group = [], _apart(parts)
        for number in range(max(self.group, default=-1) + 1):  # one group after the other is taken away
            group = [part for part, own in zip(parts, self.group, strict=True) if own == number]
            lanes = [lanes_of(cables, part.elements) for part in group]
            mine = [(own, sleep(cables, own)) for own in lanes]
            without = self._values()
            self.alone.append(([x - y for x, y in zip(values, without, strict=True)], self._residual()))
            for own, kept in mine:
                wake(cables, own, kept)

    def of_part(self, k: int, part: Part) -> tuple[list[Blocks], FloatArray]:
        """M, C and K of part k, and its forces on its boundary at rest, N."""
        alone, force = self.alone[self.group[k]]
        i, b = part.inner, part.edge
        pattern, place = self._pattern
        number = pattern[b][:, b].toarray()  # from 1 on, 0: nothing there
        at, found = place[np.maximum(number, 1) - 1], []
        for matrix, own in zip(self.whole, alone, strict=True):
            rows = matrix[i]
            found.append(Blocks(rows[:, i], rows[:, b], np.where(number > 0, own[at], 0.0)))
        return found, self.force[b] - force[b]

    def _values(self) -> list[FloatArray]:
        """M, C and K as the values of the iteration matrix."""
        core, still, found = self.system.core, np.zeros_like(self.q), []
        for which in ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)):
            assemble(core.batches, core.ws, self.q, still, core.A, *which)
            found.append(core.A.copy())
        return found

    def _matrix(self, values: FloatArray) -> csr_array:
        pattern, place = self._pattern
        return csr_array((values[place], pattern.indices, pattern.indptr), shape=pattern.shape)

    def _residual(self) -> FloatArray:
        core, zero = self.system.core, np.zeros(self.system.size)
        f, r = np.zeros_like(zero), np.zeros_like(zero)
        now = self.system.inputs.moment(0.0, (self.q, zero))
        apply_load(core.loads, now.value[0], f)
        residual(core.batches, core.ws, self.q, zero, zero, f, r)
        return r


def _apart(parts: list[Part]) -> list[int]:
    """Groups of parts, each by its number, in which no two share a boundary; they come in any order."""
    group: list[int] = []
    for k, part in enumerate(parts):
        beside = {
            own
            for own, other in zip(group, parts[:k], strict=True)
            if np.intersect1d(part.edge, other.edge).size
        }
        group.append(next(number for number in range(k + 1) if number not in beside))
    return group


def _pattern(places: Places) -> tuple[csr_array, IntArray]:
    """Where the entries of the symmetric matrix stand, and their places in the values of its lower half."""
    n, at = places.n, np.arange(6)
    inside = 6 * np.maximum(at[:, None], at) + np.minimum(at[:, None], at)
    below = 36 * (n + np.arange(len(places.column)))[:, None, None] + 6 * at[:, None] + at
    place = np.concatenate([36 * np.arange(n)[:, None, None] + inside, below, below.transpose(0, 2, 1)])
    i = np.concatenate([np.arange(n), places.rows, places.column])
    j = np.concatenate([np.arange(n), places.column, places.rows])
    rows = np.broadcast_to((6 * i)[:, None, None] + at[:, None], place.shape)
    columns = np.broadcast_to((6 * j)[:, None, None] + at, place.shape)
    numbers = np.arange(place.size) + 1  # not 0: a place that is none
    made = csr_array((numbers, (rows.ravel(), columns.ravel())), shape=(6 * n, 6 * n))
    ordered = place.ravel()[made.data - 1]
    made.data = numbers  # those of the entries as they stand
    return made, ordered


class Shapes(NamedTuple):
    """Modes of a part whose boundary is fixed, up to a frequency."""

    inner: tuple[Any, Any]  # mass and stiffness that have them, sparse
    square: FloatArray  # (modes,)
    modes: FloatArray  # (inner, modes)

    def of(self, number: IntArray) -> Shapes:
        """The same of unknowns inside with these numbers."""
        return self._replace(modes=self.modes[number])


def shapes_of(blocks: list[Blocks], frequency: float, aside: BoolArray, known: list[Shapes]) -> Shapes:
    """Modes of a part, taken from a ``known`` one that it is like, or whose mirror image it is like.

    Modes are left out in which hardly anything moves but what is ``aside``, (inner,): in these directions
    nothing acts on a part.
    """
    mass, _, stiffness = (one.inner for one in blocks)
    for other in known:
        for sign in (np.ones(len(aside)), np.where(aside, -1.0, 1.0)):
            turned = [_turned(x, sign) for x in (mass, stiffness)]
            if alike(other.inner, turned):
                return Shapes((mass, stiffness), *_refined(mass, stiffness, sign[:, None] * other.modes))
    M, omega = mass.toarray(), 2.0 * np.pi * frequency
    square, modes = eigh(stiffness.toarray(), M, subset_by_value=(-np.inf, omega * omega))
    wanted = np.einsum("ik,ik->k", modes[~aside], (M @ modes)[~aside]) > LEAST
    return Shapes((mass, stiffness), square[wanted], modes[:, wanted])


def _refined(mass: Any, stiffness: Any, modes: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Modes and their w^2 from those of a part that is like this one: a step of subspace iteration."""
    better = _solver(stiffness).solve(mass @ modes)
    square, turn = eigh(better.T @ (stiffness @ better), better.T @ (mass @ better))
    return square, better @ turn


def _solver(matrix: Any) -> Any:
    """Factors of a symmetric sparse matrix."""
    return splu(csc_array(matrix), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})


def _turned(matrix: Any, sign: FloatArray) -> Any:
    """A sparse matrix whose rows and columns have these signs."""
    rows = np.repeat(np.arange(len(sign)), np.diff(matrix.indptr))
    data = matrix.data * sign[rows] * sign[matrix.indices]
    return csr_array((data, matrix.indices, matrix.indptr), shape=matrix.shape)


def reduced(blocks: list[Blocks], shapes: Shapes, step: tuple[float, float]) -> Kind:
    """A part by its modes, by what a boundary moves within a step, and by its boundary.

    Parameters
    ----------
    blocks : list of Blocks
        M, C and K.
    shapes : Shapes
    step : (float, float)
        Factors of M and C beside K in the matrix of a step, 1/B in 1/s^2 and G/B in 1/s.
    """
    mass, damping, stiffness = blocks
    psi = _followed(blocks, (0.0, 0.0, 1.0))
    square, modes = _completed(mass.inner, stiffness.inner, shapes, _followed(blocks, (*step, 1.0)) - psi)
    moved = (mass.inner @ modes).T
    coupling = modes.T @ mass.mixed + moved @ psi
    slowed = (damping.inner @ modes).T
    lost = modes.T @ damping.mixed + slowed @ psi
    size = np.sum(coupling * coupling, axis=1)
    drag = np.sum(lost * coupling, axis=1) / np.where(size > 0.0, size, 1.0)
    return Kind(
        square,
        np.einsum("ki,ik->k", slowed, modes),
        drag,
        coupling,
        np.hstack([psi, modes]),
        moved,
        *(_condensed(psi, one) for one in blocks),
    )


#: Least share of the kinetic energy of a mode that is not aside.
LEAST = 1e-2
#: Least share of the kinetic energy of what is added to the modes that these do not have already, and least
#: ratio of the energies of two vectors that are added.
ADDED, APART = 1e-18, 1e-6


def _followed(blocks: list[Blocks], factors: tuple[float, float, float]) -> FloatArray:
    """What the inside does with each unknown of the boundary, by the sum of M, C and K with these factors."""
    inner, mixed = (
        sum(factor * getattr(one, name) for factor, one in zip(factors, blocks, strict=True))
        for name in ("inner", "mixed")
    )
    found: FloatArray = -_solver(inner).solve(mixed.toarray())
    return found


def _completed(
    mass: Any, stiffness: Any, shapes: Shapes, wanted: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Modes and their w^2 with others of higher frequencies so that ``wanted``, (inner, n), is among them."""
    modes, size = shapes.modes, np.einsum("ij,ij->j", wanted, mass @ wanted)
    added = wanted
    for _ in range(2):  # once more for the round-off
        added = added - modes @ (modes.T @ (mass @ added))
    energy = np.einsum("ij,ij->j", added, mass @ added)
    added = added[:, energy > ADDED * size] / np.sqrt(energy[energy > ADDED * size])
    share, turn = eigh(added.T @ (mass @ added))
    added = added @ (turn[:, share > APART * share.max()] / np.sqrt(share[share > APART * share.max()]))
    square, turn = eigh(added.T @ (stiffness @ added), added.T @ (mass @ added))
    return np.append(shapes.square, square), np.hstack([modes, added @ turn])


def _condensed(psi: FloatArray, blocks: Blocks) -> FloatArray:
    """A matrix of the boundary with Psi^T of what is inside."""
    half = psi.T @ blocks.mixed
    return np.ascontiguousarray(blocks.edge + half + half.T + psi.T @ (blocks.inner @ psi))


def alike(one: Iterable[Any], other: Iterable[Any]) -> bool:
    """Whether matrices, sparse ones or others, are the same but for little."""
    pairs = list(zip(one, other, strict=True))
    if any(x.shape != y.shape for x, y in pairs):
        return False
    for x, y in pairs:
        size = np.abs(x if isinstance(x, np.ndarray) else x.data).max(initial=0.0)
        if np.abs(_difference(x, y)).max(initial=0.0) > ALIKE * size:
            return False
    return True


def _difference(x: Any, y: Any) -> FloatArray:
    """Entries of the difference of two matrices, sparse ones or others."""
    if isinstance(x, np.ndarray):
        found: FloatArray = x - y
    elif np.array_equal(x.indices, y.indices) and np.array_equal(x.indptr, y.indptr):
        found = x.data - y.data
    else:
        found = (x - y).data
    return found
