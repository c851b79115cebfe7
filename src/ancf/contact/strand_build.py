"""From contacts between cables of the model to the flat arrays of their batches."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from numba import types

from .. import addresses
from ..arrays import FloatArray, IntArray
from ..compiled import VECTOR, traits
from ..elements.registry import ELEMENTS
from ..errors import ModelError
from ..later import cKDTree
from ..model.bodies.beam import Beam
from ..model.points import Point
from ..model.surfaces.cable_contact import CableContact
from ..records import RecordType, type_of
from .build import SUNK
from .grip import COLUMNS, GripBatch
from .near import PIECE
from .rows import StrandBatch
from .strand import APART, find_zones_at

#: Diameters of a cell, and the most cells of an element.
CELL, MOST_CELLS = 2.0, 8
#: Margin of the list of what is near, in lengths of an element and in diameters.
OF_LENGTH, OF_DIAMETER = 0.5, 1.0
#: Places in the list for each element, and for each length of an element that a reach has.
NEAR, MORE_NEAR = 24, 24
#: Zones for each element, and besides.
ZONES, MORE_ZONES = 6, 64
#: Rows of the matrix for a zone, the most of them, and vectors of the solver.
ROWS, MOST_ROWS, VECTORS = 7, 8000, 81
#: Spacing of the places that are looked at in the initial shape, in radii, and the most of a cable.
SPACING, MOST_PLACES = 0.5, 100_000


def strands(
    items: Sequence[CableContact],
    locate: Callable[[Any], Any],
    measured: FloatArray,
    size: int,
) -> dict[str, Any]:
    """Batches of the normal forces and, where there is any, of the friction, which share their arrays.

    They leave what they find in ``measured``, shape (contacts, 4).  ``size``: room for a state vector.
    ModelError if cables lie in each other in the initial shape.
    """
    for item in items:
        _refuse_sunk(item)
    cables = list(dict.fromkeys(body for item in items for body in (item.body, item.other)))
    law = np.full((len(cables), len(cables)), -1, dtype=np.int64)
    for k, item in enumerate(items):
        i, j = cables.index(item.body), cables.index(item.other)
        law[i, j] = law[j, i] = k
    radius = [max(x.radius_of(cable) for x in items if cable in (x.body, x.other)) for cable in cables]
    counts = [cable.elements for cable in cables]
    which = np.repeat(np.arange(len(cables)), counts).astype(np.int64)
    n, length = len(which), np.concatenate([np.diff(cable.node_x) for cable in cables])
    radii = np.array(radius)[which]
    cells = min(MOST_CELLS, math.ceil(float(np.max(length / (CELL * 2.0 * radii)))))
    margin = OF_LENGTH * float(length.mean()) + OF_DIAMETER * 2.0 * max(radius)
    reach = (2.0 * (max(radius) + margin) + float(length.max())) / float(length.min())
    zones = ZONES * n + MORE_ZONES
    ends = np.cumsum([0, *counts])
    starts = [np.arange(a, b, PIECE) for a, b in pairwise(ends.tolist())]
    pieces = np.concatenate([*starts, ends[-1:]]).astype(np.int64)
    batch = StrandBatch(
        base=np.concatenate([_slots(cable, locate) for cable in cables]),
        length=length,
        place=np.concatenate([cable.node_x[:-1] for cable in cables]),
        radius=radii,
        cable=which,
        beside=_beside(counts),
        law=law,
        data=np.array([_numbers(item) for item in items]),
        found=measured,
        cells=np.array([cells], dtype=np.int64),
        seen=np.zeros((n, 12)),
        room=np.array([-1.0, margin, 1.0, 0.0, -1.0, float(length.max()), -1.0]),
        first=np.zeros(n + 1, dtype=np.int64),
        near=np.zeros(n * min(n, NEAR + int(MORE_NEAR * reach)) + 2, dtype=np.int64),
        piece=pieces,
        box=np.zeros((len(pieces) - 1, 6)),
        middle=np.zeros((n, 4)),
        head=np.full(2 ** math.ceil(math.log2(2 * n + 2)), -1, dtype=np.int64),
        link=np.zeros(n, dtype=np.int64),
        last=np.full((n, 12), np.inf),
        grip=np.full((zones, COLUMNS), -1.0),
        older=np.zeros((zones, COLUMNS)),
        zone=np.zeros((zones, 10)),
        at=np.zeros((min(ROWS * zones, MOST_ROWS), 2), dtype=np.int64),
        row=np.zeros((min(ROWS * zones, MOST_ROWS), 25)),
        basis=np.zeros((VECTORS, size)),
        small=np.zeros((VECTORS + 1, VECTORS + 3)),
        search=0,
    )
    given = RecordType(type_of(batch)), VECTOR
    batch = batch._replace(search=addresses.address_of(find_zones_at, given, types.int64))
    found: dict[str, Any] = {"crossing": batch}
    if any(item.friction > 0.0 for item in items):
        found["gripping"] = GripBatch(*batch)
    return found


def share(parts: dict[str, Any]) -> None:
    """Let the friction have the arrays of the normal forces again: each has been mapped by itself."""
    if "gripping" in parts:
        parts["gripping"] = GripBatch(*parts["crossing"])


def renumbered(batch: Any, items: Sequence[CableContact]) -> Any:
    """The batch with the numbers of these contacts and lengths of cables in place of others nearby.

    The list of what is near, and the room for it, stay: they have margins.  What contacts remember is their
    own.
    """
    cables = list(dict.fromkeys(body for item in items for body in (item.body, item.other)))
    own = {key: getattr(batch, key).copy() for key in traits(batch).memory if key != "found"}
    return batch._replace(
        length=np.concatenate([np.diff(cable.node_x) for cable in cables]),
        place=np.concatenate([cable.node_x[:-1] for cable in cables]),
        data=np.array([_numbers(item) for item in items]),
        **own,
    )


def _numbers(item: CableContact) -> list[float]:
    stick = item.stiffness if item.stick is None else item.stick
    drag = item.damping * math.sqrt(stick / item.stiffness)
    radius = min(item.radius_of(item.body), item.radius_of(item.other))
    return [radius, item.stiffness, item.damping, item.friction, stick, drag]


def _slots(cable: Beam, locate: Callable[[Any], Any]) -> IntArray:
    """Slots of r and r_x of both nodes of each element."""
    used = np.flatnonzero(
        np.any(ELEMENTS[cable.element].shape(cable.element, [0.25, 0.6], 1.0) != 0.0, axis=0)
    )
    middles = 0.5 * (cable.node_x[:-1] + cable.node_x[1:])
    return np.array([locate(Point(cable, float(x), "")).slots[used] for x in middles], dtype=np.int64)


def _beside(counts: list[int]) -> IntArray:
    """Elements before and behind each one, -1 at the ends of its cable."""
    found, first = [], 0
    for count in counts:
        k = np.arange(first, first + count)
        row = np.stack([k - 1, k + 1], axis=1)
        row[0, 0] = row[-1, 1] = -1
        found.append(row)
        first += count
    return np.concatenate(found).astype(np.int64)


def _places(cable: Beam, spacing: float) -> tuple[FloatArray, FloatArray]:
    """Arc lengths, and initial places there."""
    count = min(max(math.ceil(cable.length / spacing), 2), MOST_PLACES)
    x = np.linspace(0.0, cable.length, count + 1)
    return x, cable.initial_places(x)


def _refuse_sunk(item: CableContact) -> None:
    """ModelError where two cables, or two places of one, lie in each other in the initial shape."""
    a, b = item.radius_of(item.body), item.radius_of(item.other)
    x, places = _places(item.body, SPACING * min(a, b))
    y, others = (x, places) if item.other is item.body else _places(item.other, SPACING * min(a, b))
    pairs = cKDTree(places).query_ball_tree(cKDTree(others), a + b)
    worst = 0.0, 0.0, 0.0
    for i, near in enumerate(pairs):
        j = np.array(near, dtype=np.int64)
        if item.other is item.body:
            j = j[np.abs(y[j] - x[i]) > APART * 2.0 * a]
        if len(j):
            away = np.linalg.norm(others[j] - places[i], axis=1)
            k = int(np.argmin(away))
            worst = max(worst, (a + b - float(away[k]), float(x[i]), float(y[j[k]])))
    depth, at, there = worst
    if depth > SUNK * min(a, b):
        place = f'"{item.body.name}" at about x = {at:.4g} m is {depth:.4g} m inside "{item.other.name}"'
        hint = f"let their axes begin at least {a + b:.4g} m, both radii, away from each other"
        raise ModelError(item.name, f"{place} at {there:.4g} m", hint)
