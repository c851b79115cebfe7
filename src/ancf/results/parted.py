"""Forces in joints that have no multipliers, as their nodes share a position: what one of the bodies needs.

The model is made once more without the joint.  In the state that is asked about, with its accelerations, the
equations of motion of the second body then miss the force of the joint at its node.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import ModelError, called, named
from ..model.joints.basic import Spherical
from ..model.points import Point
from ..system.core import apply_load, place_supports, residual
from ..system.redundancy import independent
from ..system.system import System
from . import remembered
from .remembered import Remembered


def shared_joint(system: System, joint: Any) -> Spherical | None:
    """The joint, or that of this name, if it is one whose nodes share their position."""
    name = called(joint)
    balls = (c for c in system.model.connections if isinstance(c, Spherical) and c.shared)
    return next((ball for ball in balls if ball.name == name), None)


class Parted:
    """A model without one of its joints, to which states of the model are brought.

    Parameters
    ----------
    system : System
        Of the whole model.
    joint : Spherical
        One of its joints, with nodes that share their position.

    Raises
    ------
    ModelError
        Supports hold both nodes, so that nobody can tell what the joint carries.
    """

    def __init__(self, system: System, joint: Spherical) -> None:
        self.joint, self.end, self.sign = joint, *_loose_end(system, joint)
        model = system.model.snapshot()
        model.connections.remove(joint)
        self.system = independent(model)
        self.system.skip_energies()
        self._from, self._to = _matched(system, self.system)

    def force(
        self, q: FloatArray, v: FloatArray, a: FloatArray | None, t: float, known: Remembered
    ) -> FloatArray:
        """Force that the second end receives in a state of the whole model, N, shape (3,).

        ``a`` are accelerations; without them it is an equilibrium, whatever given motions do next.
        """
        mine = self.system
        remembered.restore(mine, known)
        for name, value in known.inputs.items():
            mine.inputs.give(name, value)
        rests = a is None
        q, v, a = (self._brought(x) for x in (q, v, np.zeros_like(q) if a is None else a))
        tables = mine.inputs.moment(t, (q, v))
        place_supports(mine.supports, mine.value, tables, 0, q, v, a)
        if rests:
            v, a = np.zeros((2, mine.size))
        f, r = np.zeros((2, mine.size))
        apply_load(mine.core.loads, tables.value[0], f)
        residual(mine.core.batches, mine.core.ws, q, v, a, f, r)
        return self.sign * r[self._place : self._place + 3]

    @property
    def _place(self) -> int:
        return _position_slot(self.system, self.end)

    def _brought(self, x: FloatArray) -> FloatArray:
        brought = np.zeros(self.system.size)
        brought[self._to] = x[self._from]
        return brought


def _loose_end(system: System, joint: Spherical) -> tuple[Point, float]:
    """The end that no support holds, the second one if it is neither, and the sign of what it receives."""
    for end, sign in ((joint.b, 1.0), (joint.a, -1.0)):
        assert isinstance(end, Point)
        if not any(_same_node(system, support.point, end) for support in system.model.supports):
            return end, sign
    what = "supports hold both of its nodes: what the joint carries of it is not determined"
    raise ModelError(named(joint.name), what, "hold one of them")


def _same_node(system: System, one: Point, other: Point) -> bool:
    """Whether two points are the same node of the same body."""
    return one.body is other.body and _position_slot(system, one) == _position_slot(system, other)


def _position_slot(system: System, end: Point) -> int:
    node = end.body.node_at(end.x) if hasattr(end.body, "node_at") else 0
    return int(system.slots[end.body.name][node or 0, 0])


def _matched(whole: System, parted: System) -> tuple[IntArray, IntArray]:
    """Where entries of the state of one system are in that of the other."""
    pairs = []
    for name, slots in parted.slots.items():
        for tables in ((whole.slots, slots), (whole.numbering.slots, parted.numbering.slots[name])):
            pairs += [(tables[0][name] + c, tables[1] + c) for c in range(3)]
    pairs += [(whole.joints[name], unknowns) for name, unknowns in parted.joints.items()]
    lengths = parted.numbering.lengths
    pairs += [(np.array([whole.numbering.lengths[name]]), np.array([i])) for name, i in lengths.items()]
    return tuple(np.concatenate([side[k].ravel() for side in pairs]) for k in range(2))  # type: ignore
