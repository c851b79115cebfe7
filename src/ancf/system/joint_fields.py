"""What joints do, from state vectors: the same face for one state or a history."""

from __future__ import annotations

from typing import Any

from ..arrays import FloatArray, IntArray
from ..errors import ModelError, called, named
from ..model.joints.basic import Slide, Spherical


class JointFields:
    """Values of joints; shapes are (k,) and () for a state, (n_t, k) and (n_t,) for a history.

    A joint is the object that the model gave, or its name.
    """

    _joints: dict[str, IntArray]
    _arcs: dict[str, int]

    @property
    def joints(self) -> dict[str, IntArray]:
        """Unknowns of the multipliers by joint or rigid body; s of a sliding joint is the last."""
        return self._joints

    @property
    def arcs(self) -> dict[str, int]:
        """Unknown of the arc length by sliding joint."""
        return self._arcs

    def arc_length(self, joint: Any) -> FloatArray:
        """Reference arc length s of a sliding joint on its carrier, m.

        Raises
        ------
        ModelError
            There is no such sliding joint.
        """
        s: FloatArray = self.q[..., self._arc(joint)]  # type: ignore[attr-defined]
        return s

    def arc_rate(self, joint: Any) -> FloatArray:
        """Rate of the arc length, m/s."""
        s: FloatArray = self.v[..., self._arc(joint)]  # type: ignore[attr-defined]
        return s

    def multiplier(self, joint: Any) -> FloatArray:
        """Multipliers of a joint.

        They are numbers of the rows of a joint: see :meth:`joint_force` and ``joint_moment`` for what it
        carries. Of a sliding joint, and of joints that keep two points together, the first three are the
        force, N, that the second body receives. Those that hold axes follow, N m.
        Nodes that a spherical joint ties at their centrelines share their unknowns, without multipliers.

        Raises
        ------
        ModelError
            There is no such joint with multipliers.
        """
        name = called(joint)
        if name not in self._joints:
            raise _unknown(name, self._joints)
        unknowns = self._joints[name]
        if name in self._arcs:
            unknowns = unknowns[:-1]
        values: FloatArray = self.q[..., unknowns]  # type: ignore[attr-defined]
        return values

    def has_force(self, name: str) -> bool:
        """Whether a joint has multipliers; of sensors, and all that its force needs was recorded."""
        connections = self.model.connections  # type: ignore[attr-defined]
        return (
            isinstance(name, str) and name in self._joints and any(item.name == name for item in connections)
        )

    def has_moment(self, name: str) -> bool:
        """The same of a joint that holds directions, and not points alone."""
        connections = self.model.connections  # type: ignore[attr-defined]
        points = {item.name for item in connections if isinstance(item, Slide | Spherical)}
        return self.has_force(name) and name not in points

    def _arc(self, joint: Any) -> int:
        name = called(joint)
        if name not in self._arcs:
            raise _unknown(name, self._arcs)
        return self._arcs[name]


def _unknown(name: Any, known: dict[str, Any]) -> ModelError:
    there = "there are: " + ", ".join(known) if known else "there are none"
    return ModelError(named(name), f"is no joint of this kind here; {there}")
