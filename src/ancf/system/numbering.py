"""Which unknown belongs to which node: slots of three numbers in blocks of six."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ..elements.registry import ELEMENTS
from ..model.connections import Spherical
from ..model.model import Model

IntArray = NDArray[np.int64]


class Numbering:
    """Slots of all nodes, in the order of the model.

    Attributes
    ----------
    slots : dict of str to ndarray, shape (nodes, vectors)
        First unknown of each vector of each node, by body; connected nodes share the slot of r.
    blocks : int
        Number of blocks of six unknowns.
    owner : list of (str, int)
        Body and node of each block.
    """

    def __init__(self, model: Model) -> None:
        self.slots: dict[str, IntArray] = {}
        self.owner: list[tuple[str, int]] = []
        for beam in model.bodies.values():
            vectors = ELEMENTS[beam.element].vectors
            first = 6 * len(self.owner)
            nodes = beam.elements + 1
            size = 6 * ((vectors + 1) // 2)
            starts = first + size * np.arange(nodes)[:, None] + 3 * np.arange(vectors)
            self.slots[beam.name] = starts.astype(np.int64)
            self.owner += [(beam.name, i) for i in range(nodes) for _ in range(size // 6)]
        self.blocks = len(self.owner)
        for joint in model.connections:
            if isinstance(joint, Spherical):
                self._share(joint)

    def _share(self, joint: Spherical) -> None:
        """Give both nodes the same slot for r."""
        a, b = (self.slots[p.body.name][node_index(p.body.node_x, p.x), 0] for p in (joint.a, joint.b))
        for slots in self.slots.values():
            slots[slots[:, 0] == b, 0] = a

    def renumber(self, rank: IntArray) -> None:
        """Move block k to place rank[k]."""
        for name, slots in self.slots.items():
            self.slots[name] = 6 * rank[slots // 6] + slots % 6
        owner = list(self.owner)
        for k, place in enumerate(rank):
            owner[place] = self.owner[k]
        self.owner = owner

    def used(self) -> NDArray[np.bool_]:
        """Mask of the unknowns that some node has, shape (6 blocks,)."""
        mask = np.zeros(6 * self.blocks, dtype=bool)
        for slots in self.slots.values():
            for c in range(3):
                mask[slots + c] = True
        return mask

    def describe(self, unknown: int) -> str:
        """Name of an unknown: body, node and component."""
        for name, slots in self.slots.items():
            node, vector = np.nonzero((slots <= unknown) & (unknown < slots + 3))
            if len(node):
                what = ("position", "slope r_x", "slope r_y", "slope r_z")[vector[0]]
                return f"{name} node {node[0]} {what} {'xyz'[unknown - slots[node[0], vector[0]]]}"
        return f"unknown {unknown}"


def node_index(node_x: NDArray[np.float64], x: float) -> int:
    """Index of the node next to the reference arc length x."""
    return int(np.argmin(np.abs(node_x - x)))
