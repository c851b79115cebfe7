"""Directions of one body that stay as they are in another one, or in space."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.bodies.beam import Beam
from ..model.points import Point
from .joint_build import Row, Vector, axis_of, node_axes, normals


def slopes_of(point: Point, slots: dict[str, IntArray]) -> list[tuple[Vector, FloatArray]]:
    """The slopes of a node of a beam or cable, and their initial unit directions (3,)."""
    beam = point.body
    assert isinstance(beam, Beam)
    node = int(np.argmin(np.abs(beam.node_x - point.x)))
    axes = node_axes(beam, node)
    vectors = (Vector((int(slots[beam.name][node, k + 1]),), (1.0,)) for k in range(axes.shape[1]))
    return [(vector, axis / np.linalg.norm(axis)) for vector, axis in zip(vectors, axes.T, strict=True)]


def unsheared(point: Point, slots: dict[str, IntArray]) -> list[Row]:
    """Rows by which the slopes of a node of a beam stay normal to each other."""
    slopes = [slope for slope, _ in slopes_of(point, slots)]
    return [Row(slopes[i], slopes[j]) for i, j in ((0, 1), (0, 2), (1, 2))]


def alike(point: Point, slots: dict[str, IntArray]) -> list[Row]:
    """Rows by which the slopes of a node stretch by the same: (r_x - r_y) . (r_x + r_y) and so on."""
    (first, _), *others = slopes_of(point, slots)
    opposed = (Vector(other.slots, (-1.0,)) for other, _ in others)
    return [
        Row(first.minus(other), first.minus(minus)) for (other, _), minus in zip(others, opposed, strict=True)
    ]


def held(point: Point, frame: Point | FloatArray, slots: dict[str, IntArray]) -> list[Row]:
    """Rows by which the directions of a node's slopes, or of a rigid body, go with a frame.

    The frame is a rigid body, a node of a beam with a cross-section, or the ground. Slopes may stretch.
    """
    if isinstance(point.body, Beam):
        return [
            Row(slope, axis_of(frame, normal, slots))
            for slope, along in slopes_of(point, slots)
            for normal in normals(along)
        ]
    x, y, z = np.eye(3)
    return [Row(axis_of(point, i, slots), axis_of(frame, j, slots)) for i, j in ((x, y), (x, z), (y, z))]
