"""What the nodes of each kind of body hold: vectors of three unknowns and their initial values.

=============  =====  ===========================================  =========================
body           nodes  vectors of a node                            internal to an element
=============  =====  ===========================================  =========================
cable          n + 1  r, r_x
original       n + 1  r, r_x, r_y, r_z
nonlocking     n + 1  r, r_x, r_y, r_z                             r_yx, r_zx at its start
point mass     1      r
rigid body     1      r, d_1, d_2, d_3 (directors)
=============  =====  ===========================================  =========================
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..elements.registry import ELEMENTS
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body, PointMass, RigidBody
from ..model.elements import KINDS


def layout(body: Body) -> tuple[int, int, int]:
    """Number of nodes, of vectors that a node shares with its neighbours, and of internal ones."""
    if isinstance(body, PointMass):
        return 1, 1, 0
    if isinstance(body, RigidBody):
        return 1, 4, 0
    kind = KINDS[body.element]
    return body.elements + 1, kind.vectors, kind.internal


def is_loop(body: Body) -> bool:
    """Whether its last node is its first."""
    return isinstance(body, Beam) and body.closed


def start_vectors(body: Body) -> FloatArray:
    """Vectors of the nodes in the initial shape, shape (nodes, vectors + internal, 3)."""
    if isinstance(body, PointMass):
        return body.position.reshape(1, 1, 3).copy()
    if isinstance(body, RigidBody):
        return np.vstack([body.position, body.axes.T])[None]
    vectors = ELEMENTS[body.element].initial_vectors(body)
    if body.closed:
        vectors[-1] = vectors[0]  # the internal ones too: the last row has no element
    return vectors


def node_of(body: Body, x: float) -> int:
    """Index of the node next to the reference arc length x."""
    return int(np.argmin(np.abs(body.node_x - x))) if isinstance(body, Beam) else 0


def names_of(body: Body) -> tuple[str, ...]:
    """Names of the vectors of a node, for messages."""
    if isinstance(body, RigidBody):
        return "position", "director d_1", "director d_2", "director d_3"
    return "position", "slope r_x", "slope r_y", "slope r_z", "internal r_yx", "internal r_zx"
