"""What batches of elements that may touch surfaces have in common."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..records import recorded


@recorded
class Touching(NamedTuple):
    """What all batches of elements that may touch surfaces begin with."""

    base: NDArray[np.int64]  # (n, k + 4) slots of the element and of the body of the surface
    dest: NDArray[np.int64]  # (n, (k + 4)^2)
    shape: FloatArray  # (n, points, k)
    reach: FloatArray  # (n, k) largest factors, negative of positions
    weight: FloatArray  # (n, points) m
    winch: NDArray[np.int64]  # (n,) see contact/reel.py
    unwound: FloatArray  # (n,) 1/m
    mesh: FloatArray  # (n, 3)
    contact: NDArray[np.int64]  # (n,) which contact
    surface: NDArray[np.int64]  # (n,) which surface
    data: FloatArray  # (contacts, 6) columns RADIUS ... DRAG
    surfaces: FloatArray  # (surfaces, 10) columns PLACE ... NUMBERS
    shape_of: NDArray[np.int64]  # (surfaces,) number of the profile
    found: FloatArray  # (contacts, 4) what sensors take
    tree: FloatArray  # (m, 8) boxes of all meshes, see contact.mesh; (0,) if there are none
    faces: FloatArray  # (t, 30) their triangles
    hint: NDArray[np.int64]  # (n, points) triangle that was nearest when it was looked for last
    far: FloatArray  # (n, 5) memory: where the first node was, ROOM and GONE
    bond: NDArray[np.int64]  # (n, points) 1 where the surface holds a point while loads come on, else 0
