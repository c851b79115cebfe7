"""Which unknown belongs to which node or joint: slots of three numbers in blocks of six."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import IntArray
from ..connections.joint_build import Row, rigid, rows_of
from ..model.bodies.rigid import RigidBody
from ..model.joints.basic import Slide
from ..model.joints.connections import Spherical
from ..model.model import Model
from ..model.points import Point
from ..model.supports.winches import by_body
from .nodes import is_loop, layout, names_of, node_of
from .probe import Probe, locate


class Numbering:
    """Slots of all nodes, in the order of the model, then the blocks of the joints.

    Attributes
    ----------
    slots : dict of str to ndarray, shape (nodes, vectors + internal)
        First unknown of each vector of each node, by body; connected nodes share the slot of r.  Internal
        vectors stand at the node at which their element starts, those of the last node are not used.
    shared : dict of str to int
        Number of vectors of a node that its elements share, by body.
    multipliers : dict of str to ndarray
        Unknowns of the multipliers, by joint or rigid body.
    arcs : dict of str to int
        Unknown of the arc length s, by sliding joint.
    lengths : dict of str to int
        Unknown of the length of a cable, by winch.
    blocks : int
        Number of blocks of six unknowns.
    sliding : list of int
        Blocks of the sliding joints.
    rows : dict of str to list of Row
        Rows of the joints that are made of rows and of the rigid bodies, by name, in the slots before
        :meth:`renumber`.
    """

    def __init__(self, model: Model) -> None:
        self.model = model
        self.slots: dict[str, IntArray] = {}
        self.shared: dict[str, int] = {}
        self.multipliers: dict[str, IntArray] = {}
        self.arcs: dict[str, int] = {}
        self.lengths: dict[str, int] = {}
        self.sliding: list[int] = []
        self.rows: dict[str, list[Row]] = {}
        self._known: set[Any] = set()
        self.blocks = 0
        for body in model.bodies.values():
            nodes, shared, internal = layout(body)
            vectors = shared + internal
            self.shared[body.name] = shared
            per_node = (vectors + 1) // 2
            row = np.arange(nodes)
            if is_loop(body):
                row[-1] = 0  # its last node is its first
                nodes -= 1
            starts = 6 * (self.blocks + per_node * row[:, None]) + 3 * np.arange(vectors)
            self.slots[body.name] = starts.astype(np.int64)
            self.blocks += nodes * per_node
            if isinstance(body, RigidBody):
                self._keep(body.name, rigid(body, self.slots))
        tied = {c.name: c for c in model.connections if isinstance(c, Spherical) and c.shared}
        if tied:  # first: rows are made of slots
            self._share(tied.values())
        for joint in model.connections:
            if isinstance(joint, Slide):
                self.sliding.append(self.blocks)
                self._number(joint.name, 3)
                self.arcs[joint.name] = int(self.multipliers[joint.name][0]) + 3
            elif joint.name not in tied and (rows := rows_of(joint, self._locate, self.slots)):
                self._keep(joint.name, rows)
        for winch in by_body(model).values():
            self.lengths[winch.name] = 6 * self.blocks
            self.blocks += 1

    def _locate(self, point: Point) -> Probe:
        return locate(point, self.slots[point.body.name])

    def _keep(self, name: str, rows: list[Row]) -> None:
        """Rows and blocks for their multipliers; one that is there, as of a second weld, stays out."""
        new = [row for row in rows if row.key not in self._known]
        self._known.update(row.key for row in new)
        self.rows[name] = new
        self._number(name, len(new))

    def _number(self, name: str, rows: int) -> None:
        """Blocks for a number of multipliers."""
        self.multipliers[name] = 6 * self.blocks + np.arange(rows)
        self.blocks += (rows + 5) // 6

    def _share(self, balls: Iterable[Spherical]) -> None:
        """Give both nodes of each joint the same slot for r, that of the first."""
        goes = np.arange(6 * self.blocks)
        for ball in balls:
            ends = [p for p in (ball.a, ball.b) if isinstance(p, Point)]
            a, b = (int(self.slots[p.body.name][node_of(p.body, p.x), 0]) for p in ends)
            goes[_end(goes, b)] = _end(goes, a)
        while not np.array_equal(further := goes[goes], goes):
            goes = further
        for slots in self.slots.values():
            slots[:, 0] = goes[slots[:, 0]]

    def renumber(self, rank: IntArray) -> None:
        """Move block k to place rank[k]."""
        for table in (self.slots, self.multipliers):
            for name, unknowns in table.items():
                table[name] = 6 * rank[unknowns // 6] + unknowns % 6
        self.arcs = {name: int(6 * rank[i // 6] + i % 6) for name, i in self.arcs.items()}
        self.lengths = {name: int(6 * rank[i // 6]) for name, i in self.lengths.items()}
        self.sliding = [int(rank[b]) for b in self.sliding]

    def all_multipliers(self) -> IntArray:
        """Unknowns of all multipliers, ascending."""
        return np.sort(np.concatenate([np.zeros(0, dtype=np.int64), *self.multipliers.values()]))

    def used(self) -> NDArray[np.bool_]:
        """Mask of the unknowns that some node or joint has, shape (6 blocks,)."""
        mask = np.zeros(6 * self.blocks, dtype=bool)
        for name, slots in self.slots.items():
            shared = self.shared[name]
            for c in range(3):
                mask[slots[:, :shared] + c] = True
                mask[slots[:-1, shared:] + c] = True
        mask[self.all_multipliers()] = True
        mask[list(self.arcs.values())] = True
        mask[list(self.lengths.values())] = True
        return mask

    def each(self, name: str) -> IntArray:
        """Slots of the nodes of a body, the one where a loop closes once."""
        slots = self.slots[name]
        return slots[:-1] if is_loop(self.model.bodies[name]) else slots

    def describe(self, unknown: int) -> str:
        """Name of an unknown: body, node and component, or joint."""
        for name, slots in self.slots.items():
            node, vector = np.nonzero((slots <= unknown) & (unknown < slots + 3))
            if len(node):
                body = self.model.bodies[name]
                where = name if len(slots) == 1 else f"{name} node {node[0]}"
                component = "xyz"[unknown - slots[node[0], vector[0]]]
                return f"{where} {names_of(body)[vector[0]]} {component}"
        for name, unknowns in self.multipliers.items():
            if unknown in unknowns:
                return f"force of {name}"
        for name, arc in self.arcs.items():
            if unknown == arc:
                return f"arc length of {name}"
        for name, length in self.lengths.items():
            if unknown == length:
                return f"length of {name}"
        return f"unknown {unknown}"


def _end(goes: IntArray, slot: int) -> int:
    """Where a slot has come to that was moved, perhaps several times."""
    while goes[slot] != slot:
        slot = int(goes[slot])
    return slot
