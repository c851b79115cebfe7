"""Moments that supports and joints exert, N m, and forces of joints, N, along global axes.

The slopes of a node and the directors of a rigid body are vectors d that turn with it.  A small turn theta of
the node moves each by theta x d, so that forces F on these unknowns do the work theta . sum d x F: the sum is
the moment about the node, however the vectors stretch.  A force anywhere on a body comes to its positions
with weights whose sum is one: the forces on these add up to it.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import ModelError, named
from ..model.bodies.axes import cross
from ..model.joints.basic import Slide, Spherical
from ..model.kind import body_of
from ..model.kinds import kind_of
from ..model.points import Point
from ..model.supports.support import Support
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
    item : connection with multipliers
    q : ndarray, shape (..., size)
    """
    first, body, sign = _second_end(item)
    received = _received(system, item, q)
    slots = system.slots[body.name][:, : system.numbering.shared[body.name]]
    about = system.probe(first).field(q) if isinstance(first, Point) else np.asarray(first.position)
    places = slots[:, :1] + np.arange(3)
    arms, pulled = q[..., places] - about[..., None, :], received[..., places]
    vectors = slots[:, 1:].ravel()
    moment: FloatArray = cross(arms, pulled).sum(axis=-2) + turned(q, received, vectors, vectors)
    return sign * moment


def force_of_joint(system: System, item: Any, q: FloatArray) -> FloatArray:
    """Force that the second end of a joint receives, a body or the ground, shape (..., 3).

    Parameters
    ----------
    system : System
    item : connection with multipliers
    q : ndarray, shape (..., size)
    """
    if isinstance(item, Slide):
        return np.array(q[..., system.joints[item.name][:3]])
    _, body, sign = _second_end(item)
    places = np.unique(system.slots[body.name][:, 0])[:, None] + np.arange(3)
    force: FloatArray = _received(system, item, q)[..., places].sum(axis=-2)
    return sign * force


def _second_end(item: Any) -> tuple[Any, Any, float]:
    """First end of a joint, the body on which its forces are looked for, and -1 if that is the first one."""
    first, *others = kind_of(item).ends_of(item)
    second = body_of(others[-1]) if others else None
    body, sign = (body_of(first), -1.0) if second is None else (second, 1.0)
    assert body is not None
    return first, body, sign


def checked_joint(system: System, joint: Any, slides: bool = False) -> Any:
    """The joint of a model with multipliers that an object or a name means; ``slides``: or a sliding one.

    Raises
    ------
    ModelError
        There is no such one.
    """
    name = getattr(joint, "name", joint)
    items = {c.name: c for c in system.model.connections if c.name in system.joints}
    items = {key: c for key, c in items.items() if slides or not isinstance(c, Slide)}
    if not isinstance(name, str) or name not in items:
        if slides:
            items |= {c.name: c for c in system.model.connections if isinstance(c, Spherical)}
        there = f"there are: {', '.join(items)}" if items else "there are none"
        raise ModelError(named(name), f"is no joint with a {'force' if slides else 'moment'} here; {there}")
    return items[name]


def _received(system: System, item: Any, q: FloatArray) -> FloatArray:
    """Forces of a joint on the unknowns, shape (..., size): see :mod:`ancf.connections.joint`."""
    batch, received = system.parts["joints"], np.zeros(q.shape)
    rows = np.flatnonzero(np.isin(batch.unknown, system.joints[item.name]))
    _refuse_common(
        system, item, {int(s) for n in rows for s in batch.slot[batch.start[n] : batch.start[n + 1]]}
    )
    for n in rows:
        entries = range(batch.start[n], batch.start[n + 1])
        vectors = [batch.constant[n, 3 * k : 3 * k + 3] + np.zeros((*q.shape[:-1], 3)) for k in range(2)]
        for k in entries:
            slot = batch.slot[k]
            vectors[batch.second[k]] = vectors[batch.second[k]] + batch.factor[k] * q[..., slot : slot + 3]
        strength = q[..., batch.unknown[n], None]
        for k in entries:
            slot = batch.slot[k]
            received[..., slot : slot + 3] -= batch.factor[k] * strength * vectors[1 - batch.second[k]]
    return received


def _refuse_common(system: System, item: Any, slots: set[int]) -> None:
    """Of a node that both bodies share, and near which the joint acts, nobody can tell who receives what."""
    bodies = {body.name for body in map(body_of, kind_of(item).ends_of(item)) if body is not None}
    for slot in slots if len(bodies) == 2 else ():
        if all(np.any(system.slots[name] == slot) for name in bodies):
            what = f"it acts on an element at a node that {' and '.join(sorted(bodies))} share"
            raise ModelError(named(item.name), what, "let an element end between the two")


def turned(q: FloatArray, forces: FloatArray, vectors: IntArray, acting: IntArray) -> FloatArray:
    """Sum of d x F, shape (..., 3), of vectors d at places in the last axis of q, and F in that of forces."""
    total: FloatArray = np.zeros((*q.shape[:-1], 3))
    for slot, place in zip(vectors.tolist(), acting.tolist(), strict=True):
        total = total + cross(q[..., slot : slot + 3], forces[..., place : place + 3])
    return total
