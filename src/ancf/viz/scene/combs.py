"""What surfaces do to beams as it is drawn: a tooth for each element that touches."""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...contact.combs import FORCE, PLACE, SLIDE, teeth
from ...model.surfaces.surface import SurfaceContact
from .parts import Comb

#: Length of the longest tooth, in sizes of what is drawn.
LONGEST = 0.08
#: Share of a tooth that has to slip for it to count.
MOST_OF_IT = 0.5
#: Share of friction from which on all of it slips.
ALL_OF_IT = 1.0 - 1e-9


def make_combs(
    shown: Any, system: Any, size: float, slipping: dict[str, tuple[FloatArray, FloatArray]]
) -> list[Comb]:
    """Combs of all contacts with surfaces that are touched at some of the times that are drawn.

    ``slipping`` has the friction (n,) in N that slips and its share (n,), of contacts of which it is known.
    """
    items = [item for item in shown.model.connections if isinstance(item, SurfaceContact)]
    found = []
    for j, item in enumerate(items):
        values = teeth(system.parts["pressing"], j, shown.q, shown.rates)
        per_length = np.linalg.norm(values[..., FORCE:SLIDE], axis=-1)
        ever = per_length.max(axis=0) > 0.0
        if not np.any(ever):
            continue
        values, per_length = values[:, ever], per_length[:, ever]
        place, slide = values[..., PLACE:FORCE], values[..., SLIDE]
        scale = LONGEST * size / float(per_length.max())
        ends = np.stack([place, place + scale * values[..., FORCE:SLIDE]], axis=2)
        limits = item.friction * per_length * np.diff(item.body.node_x)[ever]
        slips = None if item.name not in slipping else fastest(slide, limits, *slipping[item.name])
        found.append(Comb(item.name, ends, per_length, slide, slips))
    return found


def fastest(slide: FloatArray, limits: FloatArray, slipping: FloatArray, share: FloatArray) -> BoolArray:
    """Which teeth slip, (n, k): those that slide fastest, whose limits (n, k) add up to ``slipping`` (n,).

    What slips has friction as large as its limit; what sticks creeps by its elasticity alone.  Friction has
    acted with the limits of a step before, where something bounces with quite other ones than now: no more
    slips than its share (n,) of the limits of now, and if that is 1 everything does.
    """
    order = np.argsort(-slide, axis=1)
    sorted_limits = np.take_along_axis(limits, order, axis=1)
    after = np.cumsum(sorted_limits, axis=1)
    slipping = np.where(share < ALL_OF_IT, np.minimum(slipping, share * after[:, -1]), np.inf)
    slips = np.zeros(slide.shape, dtype=bool)
    reached = (after - (1.0 - MOST_OF_IT) * sorted_limits <= slipping[:, None]) & (sorted_limits > 0.0)
    np.put_along_axis(slips, order, reached, axis=1)
    return slips
