"""Point masses and rigid bodies that are below a ground, which carries cables and beams only."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..errors import ModelError
from ..model.bodies.rigid import PointMass, RigidBody

#: Depth that is spoken of, in sizes of the model, and stored states that are looked at.
SUNK, MOST = 2e-4, 500


def of_bodies(known: Any) -> list[str]:
    """Notes on a state or a history, one for each body and ground."""
    try:
        model = known.system.model
    except ModelError:  # a file of another version
        return []
    bodies = [body for body in model.bodies.values() if isinstance(body, PointMass | RigidBody)]
    notes = []
    for body in bodies if model.grounds else []:
        places = np.atleast_2d(known.position(body))
        chosen = np.unique(np.linspace(0, len(places) - 1, min(MOST, len(places))).astype(int))
        for ground in model.grounds:
            depths = [ground.depth(places[k]) for k in chosen]
            if max(depths) > SUNK * model.size:
                t = float(np.atleast_1d(known.t)[chosen[int(np.argmax(depths))]])
                where = f'is {max(depths):.3g} m below the ground "{ground.name}" at t = {t:.6g} s'
                what = (
                    "grounds carry cables and beams; a sphere on a rigid body touches a plane (add_surface)"
                )
                notes.append(f'"{body.name}" {where}: {what}')
    return notes
