"""From sliding joints of the model to the flat arrays of a SlidingBatch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..compiled import Role, implements
from ..elements.registry import ELEMENTS
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import RigidBody
from ..model.joints.basic import Slide
from ..model.points import Point
from .carrier import COLUMNS
from .in_matrix import bind_sliding, sliding_pairs
from .joint_build import place_of
from .sliding import (
    MU,
    VISCOUS,
    SlidingBatch,
    sliding_event,
    sliding_force,
    sliding_inertia,
    sliding_tangent,
)
from .sliding_slopes import sliding_slopes, sliding_slopes_along, sliding_slopes_beside

#: Places in an element, and what makes a polynomial of its values there.
FOUR = np.linspace(0.0, 1.0, 4)
FITTED = np.linalg.inv(np.vander(FOUR, 4, increasing=True))


def sliding(
    joints: Sequence[Slide],
    unknowns: Sequence[int],
    level: FloatArray,
    locate: Callable[[Point], Any],
    slots: dict[str, IntArray],
) -> SlidingBatch:
    """Batch of these joints, whose blocks start at ``unknowns``; places follow later."""
    n = len(joints)
    lines = [carrier_line(joint, slots) for joint in joints]
    counts = [len(line[0]) for line in lines]
    slot, factor, offset = np.full((n, COLUMNS), -1), np.zeros((n, COLUMNS)), np.zeros((n, 3))
    for k, joint in enumerate(joints):
        point = place_of(joint.point, locate)
        slot[k, : len(point.slots)], factor[k, : len(point.factors)] = point.slots, point.factors
        offset[k] = point.constant
    m = sum(counts)
    return SlidingBatch(
        unknown=np.array(unknowns, dtype=np.int64),
        level=level,
        own=np.full(n, -1, dtype=np.int64),
        slot=slot.astype(np.int64),
        factor=factor,
        place=np.full((n, COLUMNS), -1, dtype=np.int64),
        offset=offset,
        first=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        x=np.concatenate([np.zeros((0, 2)), *(line[0] for line in lines)]),
        line_slot=np.concatenate([np.zeros((0, COLUMNS)), *(line[1] for line in lines)]).astype(np.int64),
        line_poly=np.concatenate([np.zeros((0, COLUMNS, 4)), *(line[2] for line in lines)]),
        line_place=np.full((m, COLUMNS), -1, dtype=np.int64),
        data=np.array([[j.mass, j.viscous, j.friction, j.friction_velocity] for j in joints]).reshape(n, 4),
        released=_directions([j.release for j in joints]),
        unilateral=_directions([j.unilateral for j in joints]),
        open=np.zeros(n, dtype=np.int64),
        mode=np.zeros(n, dtype=np.int64),
    )


def _directions(given: Sequence[FloatArray | None]) -> FloatArray:
    rows = [np.zeros(3) if d is None else np.asarray(d) for d in given]
    return np.array(rows, dtype=np.float64).reshape(len(rows), 3)


def carrier_line(joint: Slide, slots: dict[str, IntArray]) -> tuple[FloatArray, IntArray, FloatArray]:
    """Elements of the carrier: start and length (m, 2), slots (m, COLUMNS), polynomials (m, COLUMNS, 4)."""
    body = joint.carrier
    if isinstance(body, RigidBody):
        assert joint.line is not None
        start, end = joint.line
        length = float(np.linalg.norm(end - start))
        poly = np.zeros((1, COLUMNS, 4))
        poly[0, 0, 0] = 1.0
        poly[0, 1:4, 0], poly[0, 1:4, 1] = start, end - start
        line = np.full((1, COLUMNS), -1)
        line[0, :4] = slots[body.name][0, :4]
        return np.array([[0.0, length]]), line, poly
    return beam_line(body, slots[body.name], *joint.offset)


def _lengths(h: FloatArray) -> list[tuple[float, IntArray]]:
    """Lengths and the elements that have them; those that differ by round-off are one."""
    order = np.argsort(h, kind="stable")
    ends = np.flatnonzero(np.diff(h[order]) > 4.0 * np.spacing(h[order[1:]])) + 1
    return [(float(h[own[0]]), own) for own in np.split(order, ends)]


def beam_line(
    body: Beam, seen: IntArray, y: float = 0.0, z: float = 0.0
) -> tuple[FloatArray, IntArray, FloatArray]:
    """The same of a beam's line at the place (y, z) of the section; ``seen`` are the beam's slots."""
    h = np.diff(body.node_x)
    columns = [seen[:-1, :4], seen[1:, :4]] if seen.shape[1] > 2 else [seen[:-1, :2], seen[1:, :2]]
    used = np.hstack([*columns, seen[:-1, 4:]])
    line = np.full((len(h), COLUMNS), -1)
    line[:, : used.shape[1]] = used
    poly = np.zeros((len(h), COLUMNS, 4))
    for length, own in _lengths(h):
        values = ELEMENTS[body.element].shape(body.element, FOUR, length, y, z)  # (4, columns)
        poly[own, : used.shape[1]] = (FITTED @ values).T
    if y == 0.0 and z == 0.0:  # columns that do not contribute
        line[np.all(poly == 0.0, axis=2)] = -1
    order = np.argsort(line < 0, axis=1, kind="stable")  # what is not used comes last
    line, poly = np.take_along_axis(line, order, axis=1), np.take_along_axis(poly, order[:, :, None], axis=1)
    return np.column_stack([body.node_x[:-1], h]), line, poly


implements(
    SlidingBatch,
    force=sliding_force,
    inertia=sliding_inertia,
    tangent=sliding_tangent,
    work_slopes=sliding_slopes,
    force_slopes=sliding_slopes_along,
    slopes_beside=sliding_slopes_beside,
    event=sliding_event,
    role=Role.CONSTRAINS | Role.SLIDES | Role.DISSIPATES,
    slots=("unknown", "slot", "line_slot"),
    couples=sliding_pairs,
    bind=bind_sliding,
    damped=lambda batch: bool(np.any(batch.data[:, [VISCOUS, MU]])),
)
