"""Bodies that only a contact could hold: what an equilibrium that was not found says of them."""

from __future__ import annotations

import numpy as np

from ...errors import SolveError
from ...model.bodies.beam import Beam
from .iteration import COUNTED_MU, LEAST_MU, Iteration

ALONE = 1e-3  # of mu: what the square of a vibration may differ from it, if mu alone holds that
RESTS = 1e-9  # longest correction that moves nothing, positions in sizes of the model


def adrift(it: Iteration, where: str) -> SolveError | None:
    """Error about the body that mu alone holds in the present state; None, if there is none.

    The last correction tells a body that goes away from one that no load moves.
    """
    found = _loose(it)
    if found is None:
        return None
    free = f'nothing holds "{found[0]}" in {found[1]}'
    if it.last <= RESTS:
        what = "no load moves it there: where it rests is not determined"
        return SolveError(where, f"{free}, and {what}", "hold it")
    what = "its loads take it away from all that could"
    return SolveError(where, f"{free}, and {what}", "turn its force towards what it shall touch, or hold it")


def _loose(it: Iteration) -> tuple[str, str] | None:
    """Name of a body with mass alone and the axis along which it has no stiffness."""
    least = COUNTED_MU if len(it.core.joints.tail) else LEAST_MU
    it.mu = least * it.ratio
    if it.factorise(it.mu) != 0:
        return None
    square, x = it.softest()
    if not abs(square - it.mu) <= ALONE * it.mu:
        return None
    slot = int(np.argmax(np.abs(x) * it.core.weight))
    for name, body in it.system.model.bodies.items():
        first = it.system.numbering.slots[name][:, 0]
        if not isinstance(body, Beam) and np.any(inside := (first <= slot) & (slot < first + 3)):
            return name, "xyz"[slot - int(first[inside][0])]
    return None
