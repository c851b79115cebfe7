"""Moments that supports and joints exert, N m, along global axes.

The slopes of a node and the directors of a rigid body are vectors d that turn with it.  A small turn theta of
the node moves each by theta x d, so that forces F on these unknowns do the work theta . sum d x F: the sum is
the moment about the node, however the vectors stretch.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import ModelError, named
from ..model.joints import Slide
from ..model.kind import body_of
from ..model.kinds import kind_of
from ..model.points import Point
from ..model.supports import Support
from ..system.core import residual
from ..system.sensors import turning
from ..system.system import System


def of_support(system: System, item: Support, q: FloatArray, forces: FloatArray) -> FloatArray:
    """Moment of the ground on the node of a support, about that node, shape (..., 3).

    Parameters
    ----------
    system : System
    item : Support
    q, forces : ndarray, shape (..., size)
        State vectors, and what they leave out of balance.
    """
    vectors = turning(system, item)
    return turned(q, forces, vectors, vectors)


def of_joint(system: System, item: Any, q: FloatArray) -> FloatArray:
    """Moment that the second end of a joint receives, a body or the ground, shape (..., 3).

    It is about the point of the first end; what the multipliers add to the residual is all that a joint does.

    Parameters
    ----------
    system : System
        None that a run is using.
    item : connection with multipliers
    q : ndarray, shape (..., size)
    """
    if q.ndim == 1:
        return _of_joint(system, item, q)
    return np.array([_of_joint(system, item, one) for one in q]).reshape(-1, 3)


def checked_joint(system: System, joint: Any) -> Any:
    """The joint of a model with multipliers that an object or a name means.

    Raises
    ------
    ModelError
        There is no such one.
    """
    name = getattr(joint, "name", joint)
    items = {c.name: c for c in system.model.connections if c.name in system.joints}
    items = {key: c for key, c in items.items() if not isinstance(c, Slide)}
    if not isinstance(name, str) or name not in items:
        there = f"there are: {', '.join(items)}" if items else "there are none"
        raise ModelError(named(name), f"is no joint with a moment here; {there}")
    return items[name]


def _of_joint(system: System, item: Any, q: FloatArray) -> FloatArray:
    first, *others = kind_of(item).ends_of(item)
    second = body_of(others[-1]) if others else None
    body, sign = (body_of(first), -1.0) if second is None else (second, 1.0)
    assert body is not None
    without = q.copy()
    without[system.joints[item.name]] = 0.0
    received = _internal(system, without) - _internal(system, q)
    slots = system.slots[body.name][:, : system.numbering.shared[body.name]]
    about = system.probe(first).field(q) if isinstance(first, Point) else first.position
    places = slots[:, :1] + np.arange(3)
    arms, pulled = q[places] - about, received[places]
    vectors = slots[:, 1:].ravel()
    moment: FloatArray = np.cross(arms, pulled).sum(axis=0) + turned(q, received, vectors, vectors)
    return sign * moment


def _internal(system: System, q: FloatArray) -> FloatArray:
    """Internal forces and constraints of a state at rest, shape (size,)."""
    none, r = np.zeros(system.size), np.zeros(system.size)
    residual(system.core.batches, system.core.ws, q, none, none, none, r)
    return r


def turned(q: FloatArray, forces: FloatArray, vectors: IntArray, acting: IntArray) -> FloatArray:
    """Sum of d x F, shape (..., 3), of vectors d at places in the last axis of q, and F in that of forces."""
    total: FloatArray = np.zeros((*q.shape[:-1], 3))
    for slot, place in zip(vectors.tolist(), acting.tolist(), strict=True):
        total = total + np.cross(q[..., slot : slot + 3], forces[..., place : place + 3])
    return total
