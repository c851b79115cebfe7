"""Weld: two points stay together, and so do the directions of their bodies.

A beam that is the frame of the other end keeps its slopes at right angles there, as a clamp does: a moment on
slopes that may shear would turn the section by more, the shorter the elements are. Where the axes of both are
not along each other, it stretches by the same in all directions there, so that any direction turns with it.
"""

from __future__ import annotations

import numpy as np

from ..arrays import IntArray
from ..model.bodies.beam import Beam
from ..model.joints.rigid_joints import Weld
from ..model.points import Point
from .directions import alike, held, slopes_of, unsheared
from .joint_build import UNITS, Locate, Row, Vector, coincide

#: Cosine of the angle of two axes, or what it lacks of 1, up to which they are normal or parallel.
ALIGNED = 1e-9


def rows(joint: Weld, locate: Locate, slots: dict[str, IntArray]) -> list[Row]:
    """Of two cables a common slope, or a right angle; else the directions of one go with the other."""
    together = coincide(joint.a, joint.b, locate)
    frame, other = sorted((joint.a, joint.b), key=_stiffness, reverse=True)
    if _stiffness(frame):
        kept = frame_rows(frame, other, slots) if isinstance(frame.body, Beam) else []
        return [*together, *kept, *held(other, frame, slots)]
    (one, along), (two, beyond) = slopes_of(joint.a, slots)[0], slopes_of(joint.b, slots)[0]
    if not joint.shares_slope:
        return [*together, Row(one, two)]
    sign = 1.0 if along @ beyond > 0.0 else -1.0
    scaled = Vector(two.slots, (sign * joint.a.body.stretch / joint.b.body.stretch,))
    return [*together, *(Row(one.minus(scaled), unit) for unit in UNITS)]


def frame_rows(frame: Point, other: Point, slots: dict[str, IntArray]) -> list[Row]:
    """What a node of a beam keeps as the frame of another one."""
    mine = np.array([along for _, along in slopes_of(frame, slots)])
    theirs = np.array([along for _, along in slopes_of(other, slots)])
    cosines = np.abs(theirs @ mine.T)
    aligned = bool(np.all(np.minimum(cosines, 1.0 - cosines) < ALIGNED))
    return unsheared(frame, slots) + ([] if aligned else alike(frame, slots))


def _stiffness(point: Point) -> int:
    """What is the better frame: a rigid body (2), a beam with a cross-section (1), a cable is none (0)."""
    return (1 if point.body.has_section else 0) if isinstance(point.body, Beam) else 2
