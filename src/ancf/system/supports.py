"""Supports of the model as held unknowns, local axes and given motions."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from ..model.functions import TimeFunction
from ..model.model import Model
from ..model.supports import Clamp, Hold, Pin
from .numbering import Numbering, node_index

FloatArray = NDArray[np.float64]


@dataclass(frozen=True)
class Rotation:
    """Local axes of a slot: R(t) = exp(theta(t) axis) R0, constant without an angle."""

    slot: int
    R0: FloatArray  # (3, 3), first column along the initial tangent
    axis: FloatArray
    angle: TimeFunction | None = None
    rate: TimeFunction | None = None
    acceleration: TimeFunction | None = None

    def matrices(self, theta: FloatArray, rate: FloatArray, acceleration: FloatArray) -> FloatArray:
        """R, dR/dt and d2R/dt2, shape (n, 3, 3, 3), from angles of shape (n,)."""
        K = np.cross(np.eye(3), self.axis)  # K x = axis x x
        s, c = np.sin(theta)[:, None, None], np.cos(theta)[:, None, None]
        R = np.eye(3) + s * K + (1 - c) * (K @ K)
        w, dw = rate[:, None, None], acceleration[:, None, None]
        return np.stack([R, w * (K @ R), dw * (K @ R) + w**2 * (K @ K @ R)], axis=1) @ self.R0


@dataclass(frozen=True)
class Motion:
    """Given motion of unknowns: ``values(t)`` of shape (n, k) for times (n,)."""

    unknowns: list[int]
    values: Callable[[FloatArray], FloatArray]
    rates: Callable[[FloatArray], tuple[FloatArray, FloatArray]] | None = None


@dataclass
class Constraints:
    """What the supports of a model hold."""

    held: set[int] = field(default_factory=set)
    rotations: list[Rotation] = field(default_factory=list)
    motions: list[Motion] = field(default_factory=list)
    driven: set[int] = field(default_factory=set)  # slots


def collect(model: Model, numbering: Numbering) -> Constraints:
    """All supports of the model; a later clamp of the same node refines the earlier one."""
    constraints = Constraints()
    clamps: dict[int, Clamp] = {}
    for support in model.supports:
        body = support.point.body
        node = node_index(body.node_x, support.point.x)
        r, r_x = (int(i) for i in numbering.slots[body.name][node, :2])
        if isinstance(support, Pin):
            _hold_position(constraints, r, body.node_position[node], support.displacement)
        elif isinstance(support, Hold):
            constraints.held |= {r + "xyz".index(c) for c in support.position}
            constraints.held |= {r_x + "xyz".index(c) for c in support.slope}
        else:
            clamps[r_x] = _refined(clamps.get(r_x), support)
    for r_x, clamp in clamps.items():
        body = clamp.point.body
        node = node_index(body.node_x, clamp.point.x)
        r = int(numbering.slots[body.name][node, 0])
        _hold_position(constraints, r, body.node_position[node], clamp.displacement)
        _hold_slope(constraints, r_x, clamp, body.node_tangent[node], body.stretch)
    return constraints


def _refined(earlier: Clamp | None, later: Clamp) -> Clamp:
    if earlier is None:
        return later
    if later.rotation is None:
        later = replace(
            later,
            rotation=earlier.rotation,
            rate=earlier.rate,
            acceleration=earlier.acceleration,
            axis=earlier.axis,
        )
    return later if later.displacement is not None else replace(later, displacement=earlier.displacement)


def _hold_position(
    constraints: Constraints, slot: int, position: FloatArray, displacement: TimeFunction | None
) -> None:
    unknowns = [slot, slot + 1, slot + 2]
    constraints.held |= set(unknowns)
    if displacement is not None:
        table = displacement.table
        constraints.motions.append(Motion(unknowns, lambda t: position + table(t)))
        constraints.driven.add(slot)


def _hold_slope(
    constraints: Constraints, slot: int, clamp: Clamp, tangent: FloatArray, stretch: float
) -> None:
    rotation = Rotation(slot, axes(tangent), clamp.axis, clamp.rotation, clamp.rate, clamp.acceleration)
    if clamp.rotation is not None:
        constraints.driven.add(slot)
    if clamp.stretch == "free":
        constraints.held |= {slot + 1, slot + 2}
        constraints.rotations.append(rotation)
        return
    constraints.held |= {slot, slot + 1, slot + 2}
    if clamp.rotation is None:
        return
    angle, rate, acceleration = clamp.rotation, clamp.rate, clamp.acceleration

    def slope(order: int, t: FloatArray) -> FloatArray:
        zero = np.zeros_like(t)
        first = rate.table(t)[:, 0] if rate is not None else zero
        second = acceleration.table(t)[:, 0] if acceleration is not None else zero
        return stretch * rotation.matrices(angle.table(t)[:, 0], first, second)[:, order, :, 0]

    exact = None if rate is None else (lambda t: (slope(1, t), slope(2, t)))
    constraints.motions.append(Motion([slot, slot + 1, slot + 2], lambda t: slope(0, t), exact))


def axes(tangent: FloatArray) -> FloatArray:
    """Right-handed axes (3, 3) with the tangent as first column."""
    t = tangent / np.linalg.norm(tangent)
    helper = np.eye(3)[int(np.argmin(np.abs(t)))]
    n = np.cross(t, helper)
    n /= np.linalg.norm(n)
    return np.column_stack([t, n, np.cross(t, n)])
