"""From parts of a line to the arrays that kernels take."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import FloatArray, IntArray
from ...connections.spring_damper import SLACK
from ...simd import LANES
from ...system.far import (
    ACROSS,
    BORDER,
    COLUMN,
    COUPLING,
    DROPPERS,
    EDGE,
    EDGES,
    ENTRY,
    HIGH,
    HUNG,
    INNER,
    INSIDE,
    KIND,
    MODES,
    PLACE,
    ROWS,
    SIGHT,
    WATCHED,
    Far,
)
from ...system.system import System
from .parts import Kind, Matrices, Part, Shapes, alike, reduced, shapes_of

#: Components in which strips and droppers act, and in which nothing does: z and y.
ACTS, ASIDE = 2, 1


@dataclass(frozen=True)
class FarPlan:
    """What of a line may sleep.

    Parameters
    ----------
    cuts : ndarray of int
        Blocks of unknowns that part it: those of the wires' nodes at the supports.
    rest : ndarray, shape (size,)
        State vector of the line at rest.
    frequency : float, Hz
        Up to which the modes are taken.
    near : float, m
        Distance of a strip at which a part wakes.
    """

    cuts: IntArray
    rest: FloatArray
    frequency: float
    near: float


def kinds_of(
    matrices: Matrices, parts: list[Part], plan: FarPlan, step: tuple[float, float]
) -> tuple[list[Kind], list[int], list[FloatArray]]:
    """Kinds for steps with these factors of mass and damping, those of all parts, and forces at rest."""
    kinds: list[Kind] = []
    known: list[Any] = []
    shapes: list[Shapes] = []
    kind_of, forces = [], []
    for k, part in enumerate(parts):
        blocks, force = matrices.of_part(k, part)
        flat = [x for one in blocks for x in one]
        found = next((j for j, other in enumerate(known) if alike(other, flat)), None)
        if found is None:
            found = len(kinds)
            known.append(flat)
            aside, order = part.inner % 3 == ASIDE, np.argsort(part.number)
            shapes.append(
                shapes_of([one.sorted(order) for one in blocks], plan.frequency, aside[order], shapes)
            )
            kinds.append(reduced(blocks, shapes[-1].of(part.number), step))
        kind_of.append(found)
        forces.append(force)
    return kinds, kind_of, forces


def arrays_of(
    system: System,
    parts: list[Part],
    kinds: list[Kind],
    kind_of: list[int],
    forces: list[FloatArray],
    plan: FarPlan,
    watched: IntArray,
) -> Far:
    """All parts as kernels take them."""
    of_kind = [_of_kind(kind) for kind in kinds]
    springs = system.springs
    of_part = []
    for part, force in zip(parts, forces, strict=True):
        hung = part.springs[springs.data[part.springs, SLACK] != 0.0]
        still, rest = plan.rest[part.edge], plan.rest[part.inner]
        numbers = {"edge": part.edge, "inner": part.inner, "hung": hung, "entry": _entries(system, part.edge)}
        of_part.append({**numbers, "still": still, "rest": rest, "force": _lanes(force[:, None])[:, 0]})
    listed: list[list[dict[str, Any]]] = [of_kind, of_part]
    made = {name: np.concatenate([row[name] for row in each]) for each in listed for name in each[0]}
    begins = {name: _begins([row[name] for row in each]) for each in listed for name in each[0]}
    table = np.zeros((len(kinds), 10), dtype=np.int64)
    for t, kind in enumerate(kinds):
        edges, first = kind.mass.shape[1], parts[kind_of.index(t)]
        table[t, [MODES, ROWS, EDGES]] = begins["square"][t], len(of_kind[t]["square"]), edges
        columns = {COUPLING: "coupling", COLUMN: "mass", SIGHT: "sight", ACROSS: "across"}
        table[t, list(columns)] = [begins[name][t] for name in columns.values()]
        table[t, HIGH] = -(-edges // LANES)
        table[t, [INSIDE, WATCHED]] = len(kind.inside), int(np.isin(first.inner, watched).sum())
    lines = np.zeros((len(parts), 11), dtype=np.int64)
    lines[:, KIND] = kind_of
    lines[:, PLACE] = _begins([of_kind[t]["square"] for t in kind_of])
    for column, name in (
        (EDGE, "edge"),
        (BORDER, "force"),
        (ENTRY, "entry"),
        (INNER, "inner"),
        (HUNG, "hung"),
    ):
        lines[:, column] = begins[name]
    lines[:, DROPPERS] = [len(row["hung"]) for row in of_part]
    blocks, rows = system.numbering.blocks, sum(len(of_kind[t]["square"]) for t in kind_of)
    return Far(
        part=lines,
        place=np.array([_extent(part, plan.rest) for part in parts]),
        kind=table,
        **{name: np.zeros_like(made["square"]) for name in ("inverse", "by_place", "by_rate")},
        **{name: np.zeros_like(made["mass"]) for name in ("felt_mass", "felt_damping", "matrix")},
        state=np.zeros((7, rows, LANES)),
        guess=np.zeros(len(made["edge"])),
        push=np.zeros_like(made["force"]),
        room=np.zeros((4, LANES * (1 + int(table[:, HIGH].max())))),
        sleeps=np.zeros(blocks, dtype=np.int64),
        range=np.zeros((blocks // 2 + 2, 2), dtype=np.int64),
        counts=np.zeros(2, dtype=np.int64),
        memo=np.zeros(4),
        **made,
    )


def _of_kind(kind: Kind) -> dict[str, Any]:
    """Arrays of a kind by lanes; names as in :class:`ancf.system.far.Far`."""
    found = {name: _lanes(getattr(kind, name)[:, None])[:, 0] for name in ("square", "loss", "drag")}
    (modes, edges), even = kind.coupling.shape, len(kind.mass) % 2
    full = LANES * len(found["square"])
    coupling, psi = (np.pad(x, ((0, 0), (0, even))) for x in (kind.coupling, kind.inside[:, :edges]))
    sight = np.hstack([psi, kind.inside[:, edges:], np.zeros((len(psi), full - modes))])
    found |= {"coupling": _lanes(coupling).reshape(-1, LANES), "sight": _lanes(sight).reshape(-1, LANES)}
    found["across"] = _columns(np.pad(kind.coupling, ((0, full - modes), (0, 0))).T)
    for name in ("mass", "damping", "stiffness"):
        found[name] = _columns(np.pad(getattr(kind, name), ((0, 0), (0, even))))
    return found


def _columns(matrix: FloatArray) -> FloatArray:
    """One column after the other, by rows of eight."""
    return _lanes(matrix).transpose(1, 0, 2).reshape(-1, LANES)


def _begins(rows: list[Any]) -> IntArray:
    """Where each of them begins in all of them together."""
    ends: IntArray = np.cumsum([0, *map(len, rows)])[:-1]
    return ends


def _lanes(columns: FloatArray) -> FloatArray:
    """Rows (k, n) of numbers as (k/8, n, 8), with zeros behind the last."""
    k, n = columns.shape
    padded = np.zeros((LANES * -(-k // LANES), n))
    padded[:k] = columns
    return np.ascontiguousarray(padded.reshape(-1, LANES, n).transpose(0, 2, 1))


def _entries(system: System, edge: IntArray) -> IntArray:
    """Places in the values of the iteration matrix of all pairs of a boundary's unknowns, -1: none."""
    i, j = (x.ravel() for x in np.meshgrid(edge, edge, indexing="ij"))
    return system.places.of(i, j)


def _extent(part: Part, rest: FloatArray) -> tuple[float, float]:
    """Where a part begins and ends along the track, m."""
    x = rest[6 * part.blocks]
    return float(x.min()), float(x.max())
