"""How joints that turn about an axis have turned, from state vectors: for one state or a history."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..connections.torsion import TorsionBatch
from ..connections.torsion_build import torsion_springs
from ..errors import ModelError, called, named
from ..model.joints.basic import Revolute
from ..model.joints.guides import Cylindrical, Planar, Prismatic
from ..model.joints.rigid_joints import Universal
from ..model.joints.torsion import TorsionSpring
from .torsion_fields import TorsionFields, angle_of, is_known, rate_of

#: Joints with one axis about which their bodies turn; of these a prismatic one does not.
Turning = Revolute | Cylindrical | Planar


class JointAngles(TorsionFields):
    """Angles of hinges, cylindrical and planar joints; shapes are () for a state, (n_t,) for a history.

    A joint is the object that the model gave, or its name.
    """

    def joint_angle(self, joint: Any) -> FloatArray:
        """Angle by which the first end of a hinge has turned against the second about the axis, rad.

        From the initial shape on, right-handed; of cylindrical and planar joints as well. A history goes on
        beyond half a turn: full turns are counted from time to time, between which it may turn by less than
        half of one. The angle of a state, also of a run that a controller sees, is within half a turn.

        Raises
        ------
        ModelError
            There is no such joint, or it has no axis to turn about.
        """
        angle: FloatArray = angle_of(self._turning(joint), self.q)
        return np.unwrap(angle) if angle.ndim else angle

    def joint_rate(self, joint: Any) -> FloatArray:
        """Rate of :meth:`joint_angle`, rad/s.

        Raises
        ------
        ModelError
            As for :meth:`joint_angle`.
        """
        rate: FloatArray = rate_of(self._turning(joint), self.q, self.v)
        return rate

    def has_angle(self, name: str) -> bool:
        """Whether a joint turns about an axis; of sensors, and its ends were recorded."""
        item = turning_joints(self.model.connections).get(name) if isinstance(name, str) else None
        return item is not None and is_known(self._measured(item))

    def _measured(self, item: Turning) -> TorsionBatch:
        """A torsion spring without stiffness in the place of a joint: what measures its angle."""
        return torsion_springs([TorsionSpring(item.name, item.a, item.b, item.axis, 0, 0, 0)], self.slots)

    def _turning(self, joint: Any) -> TorsionBatch:
        name = called(joint)
        known = turning_joints(self.model.connections)
        item = known.get(name) if isinstance(name, str) else None
        if item is None:
            raise self._unturned(name, known)
        batch = self._measured(item)
        if not is_known(batch):
            raise ModelError(named(name), "was not recorded by the sensors", "list it in sensors")
        return batch

    def _unturned(self, name: Any, known: dict[str, Turning]) -> ModelError:
        what = "is no hinge, cylindrical or planar joint here"
        there = f"there are: {', '.join(known)}" if known else "there are none"
        return ModelError(named(name), f"{what}; {there}", self._other_motion(name))

    def _other_motion(self, name: Any) -> str:
        """What is asked of a connection that has no axis to turn about, "" if nothing is."""
        item = next((one for one in self.model.connections if one.name == name), None)
        if isinstance(item, TorsionSpring):
            return f'torsion_angle("{name}") is that of a torsion spring'
        if isinstance(item, Universal):
            return f'joint_angles("{name}") has the two of a universal joint'
        return f'joint_displacement("{name}") is its way' if isinstance(item, Prismatic) else ""


def turning_joints(connections: list[Any]) -> dict[str, Turning]:
    """Joints among the connections of a model that turn about one axis, by name."""
    return {
        item.name: item
        for item in connections
        if isinstance(item, Turning) and not isinstance(item, Prismatic)
    }
