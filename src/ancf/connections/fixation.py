"""Fixation: a node of a beam or cable clamped to a rigid body."""

from __future__ import annotations

import numpy as np

from ..arrays import IntArray
from ..model.bodies.beam import Beam
from ..model.joints.basic import Fixation
from .joint_build import UNITS, Locate, Row, Vector, node_axes, normals


def rows(joint: Fixation, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Position and slopes of a node go with a rigid body; with a free stretch only their directions."""
    beam, hub = joint.point.body, joint.to
    assert isinstance(beam, Beam)
    node = int(np.argmin(np.abs(beam.node_x - joint.point.x)))
    here = locate(joint.point)
    arm = hub.axes.T @ (beam.node_position[node] - hub.position)
    seat = Vector(tuple(slots[hub.name][0].tolist()), (1.0, *arm.tolist()))
    gap = Vector(tuple(here.slots.tolist()), tuple(here.S[0].tolist())).minus(seat)
    found = [Row(gap, unit) for unit in UNITS]
    axes = node_axes(beam, node)
    for k in range(min(slots[beam.name].shape[1], 4) - 1):
        slope = Vector((int(slots[beam.name][node, k + 1]),), (1.0,))
        size = float(np.linalg.norm(axes[:, k]))
        along = axes[:, k] / size
        held = [(n, 0.0) for n in normals(along)]
        if joint.stretch == "fixed":
            held.append((along, size))
        for direction, value in held:
            turned = Vector(tuple(slots[hub.name][0, 1:4].tolist()), tuple((hub.axes.T @ direction).tolist()))
            found.append(Row(slope, turned, value))
    return found
