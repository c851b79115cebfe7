"""How much the cables of a model are pressed in a state."""

from __future__ import annotations

import numpy as np

from ...arrays import FloatArray
from ...elements.slopes import mean_strain, vectors_of
from ...system.system import System


def least_stretch(system: System, q: FloatArray) -> float:
    """Least mean length of the tangent r_x over an element of all cables; infinity without any.

    Ends of elements would not do: where a cable is pressed, its tangents at the nodes may be long.
    Cables with a winch, whose material moves through their elements, are left out.
    """
    found = [np.inf]
    for name, slots in system.slots.items():
        if slots.shape[1] != 2 or name in system.lengths:  # r and r_x are the unknowns of a cable's node
            continue
        vectors = vectors_of(system.model.beams[name].node_x, slots, q[None])
        found.append(1.0 + float(np.min(mean_strain(vectors, "material"))))
    return min(found)
