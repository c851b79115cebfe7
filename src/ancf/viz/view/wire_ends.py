"""The scale of contact forces on a wire, without those near its ends, where it is stiff.

Reports of overhead lines leave the first and the last span out.  A viewer knows no spans; but runs along a
line record the wire at its supports, and the outer ones of these are where its end spans begin.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...model.bodies.beam import Beam
from ...model.surfaces.contact import Contact

#: Recorded points inside of a wire from which on they are taken for its supports, and the share of times
#: that has to remain between the outer ones.
SUPPORTS, SHARE = 4, 0.25


def scale(result: Any, states: Any, name: str, force: FloatArray) -> tuple[float, float] | None:
    """Least and greatest force of a contact while it is on none of the end spans of its wire.

    Parameters
    ----------
    result : Result
        With sensors.
    states : Histories
        Its stored states.
    name : str
        Of a contact.
    force : (n,) N
        As recorded.

    Returns
    -------
    tuple of float, optional
        None where it is on no wire with recorded supports, or hardly ever between these.
    """
    touch = next((c for c in result.model.connections if c.name == name), None)
    if not isinstance(touch, Contact):
        return None
    supports = _supports(result.sensors, touch.carrier)
    if len(supports) < SUPPORTS:
        return None
    inside = _between(result.sensors.t, states, touch, supports)
    if np.count_nonzero(inside) < SHARE * len(inside):
        return None
    return float(np.min(force[inside])), float(np.max(force[inside]))


def _supports(sensors: Any, wire: Beam) -> FloatArray:
    """Places at the start (n, 3) of the points that are recorded inside of a wire, along it."""
    found = [p for p in sensors.listing.points if p.body is wire or p.body.name == wire.name]
    inside = sorted((p for p in found if 0.0 < p.x < wire.length), key=lambda p: p.x)
    return np.array([sensors.position(p)[0] for p in inside]).reshape(-1, 3)


def _between(t: FloatArray, states: Any, touch: Contact, supports: FloatArray) -> BoolArray:
    """Whether at recorded times (n,) the strip is past the first support and before the last one."""
    head = states.position(touch.point)
    ways = []
    for one, other in (supports[:2], supports[:-3:-1]):  # inwards, from both ends
        along = (other - one) / np.linalg.norm(other - one)
        ways.append(np.interp(t, states.t, (head - one) @ along))
    passed: BoolArray = (ways[0] >= 0.0) & (ways[1] >= 0.0)
    return passed
