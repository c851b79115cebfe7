"""How much the cables of a model are pressed in a state."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..elements.shapes import gauss, hermite
from ..system.system import System

#: Gauss points of a mean over an element.
POINTS = 5


def least_stretch(system: System, q: FloatArray) -> float:
    """Least mean length of the tangent r_x over an element of all cables; infinity without any.

    Ends of elements would not do: where a cable is pressed, its tangents at the nodes may be long.
    Cables with a winch, whose material moves through their elements, are left out.
    """
    found = [np.inf]
    for name, slots in system.slots.items():
        if slots.shape[1] != 2 or name in system.lengths:  # r and r_x are the unknowns of a cable's node
            continue
        nodes = q[slots[..., None] + np.arange(3)]
        sides = np.concatenate([nodes[:-1], nodes[1:]], axis=1)
        xi, weight = gauss(POINTS)
        size, places = np.broadcast_arrays(np.diff(system.model.beams[name].node_x)[:, None], xi)
        slopes = np.einsum("egk,ekc->egc", hermite(places, size, 1), sides)
        found.append(float(np.min(np.linalg.norm(slopes, axis=-1) @ weight)))
    return min(found)
