"""The two angles of universal joints, for one state or a history."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..connections.joint_build import Vector, axis_of
from ..errors import ModelError, called, named
from ..model.joints.rigid_joints import Universal
from .joint_travels import JointTravels
from .joint_vectors import dot, recorded, values_of


class CrossAngles(JointTravels):
    """Angles of universal joints; shapes are (2,) for a state, (n_t, 2) for a history.

    With R the turn of the first body against the second one from the initial shape on,
    R = rotation about ``axis_b`` by the second angle times rotation about ``axis_a`` by the first.
    """

    def joint_angles(self, joint: Any) -> FloatArray:
        """Angles of a universal joint, rad: of the first body on the cross, and of the cross on the second.

        The first is about ``axis_a``, the second about ``axis_b``, both right-handed, from the initial shape
        on. A history goes on beyond half a turn, as :meth:`joint_angle` does.

        Raises
        ------
        ModelError
            There is no such joint, or it is no universal joint.
        """
        each = [
            np.arctan2(dot(x, s), dot(x, c))
            for x, c, s in (self._values(axes, self.q) for axes in self._crossed(joint))
        ]
        angles: FloatArray = np.stack(each, axis=-1)
        return np.unwrap(angles, axis=0) if angles.ndim > 1 else angles

    def joint_rates(self, joint: Any) -> FloatArray:
        """Rates of :meth:`joint_angles`, rad/s.

        Raises
        ------
        ModelError
            As for :meth:`joint_angles`.
        """
        each = []
        for axes in self._crossed(joint):
            x, c, s = self._values(axes, self.q)
            dx, dc, ds = (values_of(one, self.v, rates=True) for one in axes)
            C, S = dot(x, c), dot(x, s)
            dC, dS = dot(dx, c) + dot(x, dc), dot(dx, s) + dot(x, ds)
            each.append((C * dS - S * dC) / (C * C + S * S))
        return np.stack(each, axis=-1)

    def has_angles(self, name: str) -> bool:
        """Whether a joint has two angles; of sensors, and its ends were recorded."""
        item = crosses(self.model.connections).get(name) if isinstance(name, str) else None
        return item is not None and all(recorded(*axes) for axes in self._axes(item))

    @staticmethod
    def _values(axes: tuple[Vector, ...], q: Any) -> tuple[FloatArray, ...]:
        return tuple(values_of(one, q) for one in axes)

    def _axes(self, item: Universal) -> list[tuple[Vector, Vector, Vector]]:
        """Of each angle the axis that turns, and where it is at no angle and at a quarter of a turn."""
        a, b, across = item.axis_a, item.axis_b, np.cross(item.axis_a, item.axis_b)

        def of(end: Any, direction: FloatArray) -> Vector:
            return axis_of(end, direction, self.slots)

        # the second axis, seen from the first body, turns the other way round
        first = of(item.b, b), of(item.a, b), of(item.a, -across)
        second = of(item.a, a), of(item.b, a), of(item.b, -across)
        return [first, second]

    def _crossed(self, joint: Any) -> list[tuple[Vector, Vector, Vector]]:
        name = called(joint)
        known = crosses(self.model.connections)
        item = known.get(name) if isinstance(name, str) else None
        if item is None:
            there = f"there are: {', '.join(known)}" if known else "there are none"
            hint = f'joint_angle("{name}") is the one of a hinge' if self.has_angle(str(name)) else ""
            raise ModelError(named(name), f"is no universal joint here; {there}", hint)
        found = self._axes(item)
        if not all(recorded(*axes) for axes in found):
            raise ModelError(named(name), "was not recorded by the sensors", "list it in sensors")
        return found


def crosses(connections: list[Any]) -> dict[str, Universal]:
    """Universal joints among the connections of a model, by name."""
    return {item.name: item for item in connections if isinstance(item, Universal)}
