"""What contacts with surfaces do in states: sums over a beam, and along it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..compiled import kernel
from ..elements.shapes import gauss
from ..model.surfaces.surface import SurfaceContact
from ..records import Located
from .press import press_measure, pressed
from .rub import drawn, rub_measure, rubbed
from .rubbed import RUBBED
from .touch import carrier, lie, nodes_of, outside, place_on, row_of

__all__ = ["ContactLine", "contact_line", "frictions", "nearest_places", "pressures"]

#: Share of the limit from which a point counts as one that slips: its memory has come back to it.
AT_LIMIT = 0.999


@dataclass(frozen=True)
class ContactLine:
    """What a beam and a surface do to each other at m points along the beam.

    Of a cable with a winch places are those on the mesh, forces are per length of the material.

    Parameters
    ----------
    x : (m,) m
        Reference arc length.
    gap : (m,) m
        Negative where they touch.
    normal : (m,) N/m
        Normal force per length.
    friction : (m, 3) N/m
        Friction per length on the beam, global components.
    limit : (m,) N/m
        Largest friction.
    slips : (m,) of bool
        Where friction is at its limit.
    """

    x: FloatArray
    gap: FloatArray
    normal: FloatArray
    friction: FloatArray
    limit: FloatArray
    slips: BoolArray


@kernel
def press_values(batch, q, v, out):
    """What ``found`` says of each contact in each state, ``out`` of shape (states, contacts, 4)."""
    for n in range(q.shape[0]):
        press_measure(batch, q[n], v[n])
        for j in range(batch.found.shape[0]):
            out[n, j, 0], out[n, j, 1] = batch.found[j, 0], batch.found[j, 1]


@kernel
def rub_values(batch, q, v):
    """Fill ``found``."""
    rub_measure(batch, q, v)


@kernel
def press_line(batch, j, q, v, out):
    """Gap and normal force at the points of contact j, ``out`` of shape (rows, points, 2)."""
    m = 0
    for e in range(batch.base.shape[0]):
        if batch.contact[e] != j:
            continue
        row = row_of(batch, e, q, v)
        for p in range(batch.weight.shape[1]):
            g, _, N, _, _, _, _, _, _ = pressed(batch, e, p, row)
            out[m, p, 0], out[m, p, 1] = -g, N
        m += 1


@kernel
def rub_line(batch, j, q, v, out):
    """Friction and its limit at the points of contact j, ``out`` of shape (rows, points, 4)."""
    m = 0
    for e in range(batch.base.shape[0]):
        if batch.contact[e] != j:
            continue
        row = row_of(batch, e, q, v)
        for p in range(batch.weight.shape[1]):
            r, _, u, n = rubbed(batch, e, p, row)
            w, _, f, _ = drawn(batch, e, p, r, u, n, row[2], q)
            out[m, p, 0], out[m, p, 1], out[m, p, 2] = -f * w[0], -f * w[1], -f * w[2]
            out[m, p, 3] = batch.limit[e, p]
        m += 1


@kernel
def press_nearest(batch, j, q, out):
    """Of contact j in states: the place on the axis that is nearest to the surface, and the surface there.

    ``out`` of shape (states, 2, 3).
    """
    for n in range(q.shape[0]):
        nearest = np.inf
        for e in range(batch.base.shape[0]):
            if batch.contact[e] != j:
                continue
            body, nodes = carrier(batch, e, q[n]), nodes_of(batch, e, q[n])
            at, axis = lie(batch, e, body)
            for p in range(batch.weight.shape[1]):
                r = place_on(batch, e, p, nodes)
                d, normal, _, _, _ = outside(batch, e, p, body, at, axis, r)
                if d < nearest:
                    nearest = d
                    for c in range(3):
                        out[n, 0, c], out[n, 1, c] = r[c], r[c] - d * normal[c]


def nearest_places(batch: Any, j: int, q: FloatArray) -> FloatArray:
    """Where contact j is nearest in states (n, size): on the axis and on the surface, (n, 2, 3) m."""
    out = np.empty((len(q), 2, 3))
    press_nearest(Located(batch), j, np.ascontiguousarray(q), out)
    return out


def pressures(batch: Any, q: FloatArray, v: FloatArray) -> FloatArray:
    """Force and depth of each contact in states (n, size), NaN behind them, (n, contacts, 4)."""
    mine = batch._replace(found=batch.found.copy())  # a question must not move what a run measures
    out = np.full((len(q), len(batch.found), 4), np.nan)
    press_values(Located(mine), q, v, out)
    return out


def frictions(batch: Any, q: FloatArray, v: FloatArray) -> FloatArray:
    """Friction and the share of it that slips of each contact where a run begins, (contacts, 2)."""
    mine = batch._replace(found=batch.found.copy())
    rub_values(Located(mine), np.ascontiguousarray(q), np.ascontiguousarray(v))
    return np.array(mine.found[:, RUBBED:])


def contact_line(
    parts: dict[str, Any], items: list[SurfaceContact], item: SurfaceContact, q: FloatArray, v: FloatArray
) -> ContactLine:
    """What a beam and a surface do along the beam in a state; `items` are all such contacts of a model."""
    beam, pressing = item.body, parts["pressing"]
    j, (n, points) = items.index(item), (item.body.elements, pressing.weight.shape[1])
    found, rough = np.empty((n, points, 2)), np.zeros((n, points, 4))
    press_line(Located(pressing), j, q, v, found)
    if item.friction > 0.0:
        rubbing = parts["rubbing"]  # with the limits that acted; what has left the surface is free
        limits = np.where(rubbing.before > 0.0, rubbing.acted, 0.0)
        rub_line(Located(rubbing._replace(limit=limits)), j, q, v, rough)
    x = beam.node_x[:-1, None] + gauss(points)[0] * np.diff(beam.node_x)[:, None]
    size, limit = np.linalg.norm(rough[..., :3], axis=-1), rough[..., 3]
    slips = (limit > 0.0) & (size >= AT_LIMIT * limit)
    return ContactLine(
        x=x.ravel(),
        gap=found[..., 0].ravel(),
        normal=found[..., 1].ravel(),
        friction=rough[..., :3].reshape(-1, 3),
        limit=limit.ravel(),
        slips=slips.ravel(),
    )
