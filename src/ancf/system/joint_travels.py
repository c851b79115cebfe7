"""How far bodies have slid on each other along the axis of a joint, for one state or a history."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..connections.joint_build import Vector, axis_of, place_of
from ..errors import ModelError, called, named
from ..model.joints.guides import Cylindrical
from ..model.points import Point, initial_position
from .fields import Fields
from .joint_angles import JointAngles
from .joint_vectors import dot, recorded, values_of


class JointTravels(JointAngles):
    """Travels of prismatic and cylindrical joints; shapes are () for a state, (n_t,) for a history.

    A joint is the object that the model gave, or its name.
    """

    def joint_displacement(self, joint: Any) -> FloatArray:
        """Way of the first end of a prismatic or cylindrical joint along the axis of the second, m.

        From the initial shape on, positive in the direction of the axis, which turns with the second end.

        Raises
        ------
        ModelError
            There is no such joint, or it has no axis to slide along.
        """
        item, gap, axis = self._led_along(joint)
        between = initial_position(item.a) - initial_position(item.b)
        along = values_of(axis, self.q)
        way: FloatArray = dot(values_of(gap, self.q), along) / np.sqrt(dot(along, along))
        return way - float(between @ item.axis)

    def joint_velocity(self, joint: Any) -> FloatArray:
        """Rate of :meth:`joint_displacement`, m/s.

        Raises
        ------
        ModelError
            As for :meth:`joint_displacement`.
        """
        _, gap, axis = self._led_along(joint)
        along = values_of(axis, self.q)
        # the joint holds the gap along the axis, so that turns and stretches of the axis have no part
        rate: FloatArray = dot(values_of(gap, self.v, rates=True), along) / np.sqrt(dot(along, along))
        return rate

    def has_travel(self, name: str) -> bool:
        """Whether a joint slides along an axis; of sensors, and its ends were recorded."""
        item = sliding_joints(self.model.connections).get(name) if isinstance(name, str) else None
        return item is not None and recorded(*self._ends(item))

    def _ends(self, item: Cylindrical) -> tuple[Vector, Vector]:
        """From the second end to the first one, and the axis."""

        def located(point: Point) -> Any:
            return Fields._probe(self, point)  # sensors know the ends of a joint that is listed

        gap = place_of(item.a, located).minus(place_of(item.b, located))
        return gap, axis_of(item.b, item.axis, self.slots)

    def _led_along(self, joint: Any) -> tuple[Cylindrical, Vector, Vector]:
        name = called(joint)
        known = sliding_joints(self.model.connections)
        item = known.get(name) if isinstance(name, str) else None
        if item is None:
            there = f"there are: {', '.join(known)}" if known else "there are none"
            hint = f'arc_length("{name}") is that of a sliding joint' if name in self._slides() else ""
            raise ModelError(named(name), f"is no prismatic or cylindrical joint here; {there}", hint)
        gap, axis = self._ends(item)
        if not recorded(gap, axis):
            raise ModelError(named(name), "was not recorded by the sensors", "list it in sensors")
        return item, gap, axis

    def _slides(self) -> dict[str, int]:
        """Sliding joints, which have a place on their carrier."""
        return getattr(self, "arcs", {})


def sliding_joints(connections: list[Any]) -> dict[str, Cylindrical]:
    """Joints among the connections of a model along whose axis one body slides on the other, by name."""
    return {item.name: item for item in connections if isinstance(item, Cylindrical)}
