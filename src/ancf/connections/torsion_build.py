"""From torsion springs of the model to the flat arrays of a TorsionBatch."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.bodies.beam import Beam
from ..model.joints.torsion import TorsionSpring
from ..model.points import Point
from .directions import slopes_of
from .joint_build import Vector, axis_of, normals
from .torsion import SLOTS, TorsionBatch


def torsion_springs(items: Sequence[TorsionSpring], slots: dict[str, IntArray]) -> TorsionBatch:
    """Batch of all torsion springs, in these slots of the nodes by body."""
    n = len(items)
    batch = TorsionBatch(
        base=np.full((n, SLOTS), -1, dtype=np.int64),
        dest=np.full((n, SLOTS * SLOTS), -1, dtype=np.int64),
        turned=np.zeros((n, 2, 3)),
        frame=np.zeros((n, 2, 2, 3)),
        constant=np.zeros((n, 2, 2, 3)),
        data=np.zeros((n, 4)),
        last=np.zeros(n),
    )
    for e, item in enumerate(items):
        frame, turning = item.frame, item.turning
        sense = 1.0 if turning is item.a else -1.0
        batch.data[e] = item.stiffness, item.damping, item.angle, sense
        for k, (vector, along) in enumerate(_turned(turning, item.axis, slots)):
            batch.base[e, : len(vector.slots)] = vector.slots
            batch.turned[e, k, : len(vector.slots)] = vector.factors
            for j, direction in enumerate((along, np.cross(item.axis, along))):
                seen = axis_of(frame, direction, slots)
                batch.constant[e, k, j] = seen.constant
                batch.base[e, 3 : 3 + len(seen.slots)] = seen.slots
                batch.frame[e, k, j, : len(seen.slots)] = seen.factors
    return batch


def _turned(point: Point, axis: FloatArray, slots: dict[str, IntArray]) -> list[tuple[Vector, FloatArray]]:
    """Vectors that turn with a body, and their initial parts (3,) normal to an axis.

    Of a rigid body two normals: of one alone the direction would count where the axis is free to tilt. Of a
    beam with a cross-section r_y and r_z, in the shares in which they take a torque, see
    :mod:`ancf.loads.section_moment`; of a cable its slope.
    """
    body = point.body
    if not isinstance(body, Beam):
        return [(axis_of(point, along, slots), along) for along in normals(axis)]
    slopes = slopes_of(point, slots)
    section = body.section
    if not body.has_section:
        shares = [1.0]
    else:
        assert section.I_y is not None
        assert section.I_z is not None
        slopes, whole = slopes[1:], section.I_y + section.I_z
        shares = [section.I_z / whole, section.I_y / whole]
    own = tuple(vector.slots[0] for vector, _ in slopes)
    found = []
    for k, ((_, along), share) in enumerate(zip(slopes, shares, strict=True)):
        factors = tuple(share if i == k else 0.0 for i in range(len(own)))
        found.append((Vector(own, factors), along - (along @ axis) * axis))
    return found
