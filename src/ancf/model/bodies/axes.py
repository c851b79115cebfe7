"""Axes of the cross-section: local y at the start, carried along the path without twist."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks

Sampler = Callable[[FloatArray], tuple[FloatArray, FloatArray]]

PARALLEL = 1e-6  # sine of the angle below which two directions are the same
FEWEST_SAMPLES = 512
MOST_SAMPLES = 65_536
LARGEST_TURN = 0.02  # rad, of the tangent from sample to sample


def first_axis(y_axis: Any, tangent: FloatArray, where: str) -> FloatArray:
    """Unit vector (3,) of local y at the start of a beam, normal to its unit tangent.

    Parameters
    ----------
    y_axis : (3,) or None
        A direction near it; by default local z points up as far as it can: y is along e_z x tangent, or
        along e_y where the beam starts vertical.

    Raises
    ------
    ModelError
        The direction is no direction, or is the tangent's.

    """
    if y_axis is None:
        across = np.array([0.0 - tangent[1], tangent[0], 0.0])  # e_z x tangent
        near = np.array([0.0, 1.0, 0.0]) if np.linalg.norm(across) <= PARALLEL else across
    else:
        near = checks.direction(y_axis, where)
        if np.linalg.norm(np.cross(near, tangent)) <= PARALLEL:
            what = f"{near.tolist()} is along the tangent at the start, local y is normal to it"
            raise ModelError(where, what)
    return normal_part(near, tangent)


def along(shape: Sampler, fraction: FloatArray, first: FloatArray) -> FloatArray:
    """Local y axes (n, 3) at the nodes of a path, carried from the first one.

    From one sample of the path to the next the axis turns by the double reflection of Wang, Juettler,
    Zheng and Liu (ACM Transactions on Graphics 27, 2008), which does not turn about the tangent up to an
    error of fourth order. The samples are so close that it does not depend on the nodes.

    Parameters
    ----------
    shape : callable
        Positions and unit tangents at fractions of the path.
    fraction : (n,) array
        The nodes, 0 to 1.
    first : (3,) array
        Axis at fraction 0.

    """
    parts = -(-FEWEST_SAMPLES // (fraction.size - 1))
    position, tangent = shape(subdivided(fraction, parts))
    while _largest_turn(tangent) > LARGEST_TURN and 2 * len(tangent) <= MOST_SAMPLES:
        parts *= 2
        position, tangent = shape(subdivided(fraction, parts))
    return _double_reflection(position, tangent, first)[::parts].copy()


def closing(y: FloatArray, tangent: FloatArray, fraction: FloatArray) -> FloatArray:
    """Local y axes (n, 3) of a loop: carried without twist they come back turned, which is spread evenly."""
    first, last = y[0], y[-1]
    angle = float(np.arctan2(np.cross(first, last) @ tangent[0], first @ last))
    turn = -angle * fraction[:, None]
    turned: FloatArray = np.cos(turn) * y + np.sin(turn) * np.cross(tangent, y)
    turned[-1] = first
    return turned


def cross(u: FloatArray, v: FloatArray) -> FloatArray:
    """Vector products of (..., 3) and (..., 3): ``np.cross`` takes several times as long for few."""
    one, two = [1, 2, 0], [2, 0, 1]
    product: FloatArray = u[..., one] * v[..., two] - u[..., two] * v[..., one]
    return product


def carried(vector: FloatArray, old: FloatArray, new: FloatArray) -> FloatArray:
    """Vectors (n, 3) after the smallest rotations that take the unit vectors `old` to `new`."""
    w = cross(old, new)
    cosine = np.sum(old * new, axis=1, keepdims=True)
    turned: FloatArray = cosine * vector + cross(w, vector)
    turned += w * np.sum(w * vector, axis=1, keepdims=True) / (1 + cosine)
    return turned


def between(y: FloatArray, tangent: FloatArray, middle: FloatArray) -> FloatArray:
    """Unit axes (n, 3) between neighbouring nodes, as near to one node's axis as to the other's.

    Parameters
    ----------
    y, tangent : (n+1, 3) arrays
        At the nodes.
    middle : (n, 3) array
        Unit tangents in between.

    """
    both = carried(y[:-1], tangent[:-1], middle) + carried(y[1:], tangent[1:], middle)
    return normal_part(both, middle)


def middle_slopes(position: FloatArray, slope: FloatArray, length: FloatArray) -> FloatArray:
    """Slopes (n, 3) in the middle of cubics between nodes with positions and slopes (n+1, 3)."""
    chord: FloatArray = np.diff(position, axis=0) / length[:, None]
    return 1.5 * chord - 0.25 * (slope[:-1] + slope[1:])


def turns(position: FloatArray, slope: FloatArray, length: FloatArray) -> FloatArray:
    """Angles (n,) in rad by which the tangent turns from node to middle to node of each element."""
    middle = middle_slopes(position, slope, length)
    return _angle(slope[:-1], middle) + _angle(middle, slope[1:])


def normal_part(vector: FloatArray, tangent: FloatArray) -> FloatArray:
    """Unit vectors (..., 3) along the parts of vectors that are normal to unit tangents."""
    normal = vector - np.sum(vector * tangent, axis=-1, keepdims=True) * tangent
    unit: FloatArray = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
    return unit


def subdivided(knots: FloatArray, parts: int) -> FloatArray:
    """Each interval between knots in equal parts."""
    fraction = np.arange(parts) / parts
    inner = knots[:-1, None] + fraction * np.diff(knots)[:, None]
    return np.append(inner.ravel(), knots[-1])


def _angle(one: FloatArray, two: FloatArray) -> FloatArray:
    angle: FloatArray = np.arctan2(np.linalg.norm(np.cross(one, two), axis=1), np.sum(one * two, axis=1))
    return angle


def _largest_turn(tangent: FloatArray) -> float:
    return float(np.max(np.linalg.norm(np.diff(tangent, axis=0), axis=1)))


def _double_reflection(position: FloatArray, tangent: FloatArray, first: FloatArray) -> FloatArray:
    """Axes at all samples: what each step adds to the angle from an arbitrary normal, summed up."""
    u = _any_normal(tangent)
    v = np.cross(tangent, u)
    chord = np.diff(position, axis=0)
    moved, end = _reflected(u[:-1], chord), _reflected(tangent[:-1], chord)
    moved = _reflected(moved, tangent[1:] - end)
    step = np.arctan2(np.sum(moved * v[1:], axis=1), np.sum(moved * u[1:], axis=1))
    angle = np.arctan2(first @ v[0], first @ u[0]) + np.concatenate([[0.0], np.cumsum(step)])
    return normal_part(np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v, tangent)


def _any_normal(tangent: FloatArray) -> FloatArray:
    """Unit normals (n, 3): along the coordinate axis from which each tangent is farthest."""
    farthest = np.eye(3)[np.argmin(np.abs(tangent), axis=1)]
    return normal_part(farthest, tangent)


def _reflected(vector: FloatArray, normal: FloatArray) -> FloatArray:
    """Vectors (n, 3) mirrored in planes with the given normals of any length; as they are where it is 0."""
    size = np.sum(normal**2, axis=1, keepdims=True)
    factor = 2 * np.sum(normal * vector, axis=1, keepdims=True) / np.where(size > 0.0, size, 1.0)
    mirrored: FloatArray = vector - factor * normal
    return mirrored
