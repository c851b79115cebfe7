"""Bends of cables that have turned out of their plane: a cable resists the size of its bend alone.

What is bent by nature bends out of its plane at no cost, and so gives way where it would have to straighten:
a ring that is pressed goes two to four times as far as one that keeps its plane.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..elements.slopes import Vectors, slope, vectors_of
from ..model.bodies.beam import Beam
from .tension import extremes, natural_vectors

#: Share of the change of the bends that turning may take unsaid; smaller changes of a bend are none.
TURNED, CHANGED = 0.05, 1e-7
#: Tension times square of the radius over EI from which on tension makes the shape, not bending.
HELD = 10.0
#: Bends below this share of the largest have no direction; elements of a cable that are looked at.
STRAIGHT, MOST = 0.05, 3000


def looked_at(model: Any) -> list[Beam]:
    """Cables of a model that are bent by nature and may turn that bend."""
    beams = model.beams.values()
    return [b for b in beams if b.turns_its_bend and b.section.EI > 0.0 and b.elements <= MOST]


def notes(known: Any) -> list[str]:
    """What is said of cables of a state whose bends have turned, the first of them."""
    for beam in looked_at(known.system.model):
        now = vectors_of(beam.node_x, known.system.slots[beam.name], known.q[None, :])
        angle, share = turned(beam, now)
        if share > TURNED and _bending_matters(known, beam):
            return [
                f'"{beam.name}" is bent by nature, and nothing resists that this bend turns: it did by up to '
                f"{np.degrees(angle):.2g} degrees, which takes {100 * share:.2g} % of how its bend would "
                "change in one plane; hold its plane at each node (position and slope), or take "
                'element="nonlocking"'
            ]
    return []


def turned(beam: Beam, now: list[Vectors]) -> tuple[float, float]:
    """Largest angle by which bends have turned, rad, and the share that this takes of their changes."""
    still = natural_vectors(beam)
    assert still is not None
    weight = np.repeat(np.diff(beam.node_x), 3)
    (size, angle), (first, before) = (_bends(beam, vectors) for vectors in (now, still))
    weight = np.where(first > STRAIGHT * np.max(first), weight * first, 0.0)
    off = angle - before
    off -= np.angle(np.sum(weight * np.exp(1j * off)))
    off = np.where(weight > 0.0, np.angle(np.exp(1j * off)), 0.0)
    change = size * np.cos(off) - first
    kept, taken = (float(np.sqrt(np.sum(weight * x**2))) for x in (change, size - first - change))
    least = CHANGED * float(np.sqrt(np.sum(weight * first**2)))
    return float(np.max(np.abs(off))), taken / kept if kept > least else 0.0


def _bends(beam: Beam, vectors: list[Vectors]) -> tuple[FloatArray, FloatArray]:
    """Curvatures (3 n,) at both ends and in the middle of each element, and their angles about the cable.

    Angles are counted from a normal that is carried along without turning about the cable.
    """
    h, places = np.diff(beam.node_x), []
    for xi in (0.0, 0.5, 1.0):
        c, a, b = (6.0 - 12.0 * xi) / h, (6.0 * xi - 4.0) / h, (6.0 * xi - 2.0) / h
        bent = np.stack([(c * chord + a * first + b * last)[0] for chord, first, last in vectors], axis=-1)
        along = np.stack([slope(part, xi)[0] for part in vectors], axis=-1)
        places.append((along, bent))
    along, bent = (np.stack(x, axis=1).reshape(-1, 3) for x in zip(*places, strict=True))
    length = np.linalg.norm(along, axis=1, keepdims=True)
    tangent, vector = along / length, np.cross(along, bent) / length**2
    normal = _carried(tangent)
    angle = np.arctan2(np.sum(vector * np.cross(tangent, normal), axis=1), np.sum(vector * normal, axis=1))
    return np.linalg.norm(vector, axis=1), angle


def _carried(tangent: FloatArray) -> FloatArray:
    """Normals (n, 3) to tangents (n, 3), each the one before, turned as little as the tangent makes it."""
    least = np.eye(3)[int(np.argmin(np.abs(tangent[0])))]
    normal = np.cross(tangent[0], least)
    normal /= np.linalg.norm(normal)
    made = [normal]
    for last, now in pairwise(tangent):
        middle = last + now
        normal = normal - 2.0 * (normal @ now) / max(float(middle @ middle), 1e-12) * middle
        made.append(normal)
    return np.array(made)


def _bending_matters(known: Any, beam: Beam) -> bool:
    """Whether it is bending that makes the shape, not tension."""
    radius, pulls = beam.length / (2.0 * np.pi), extremes(known, [beam])[beam.name]
    return max(map(abs, pulls)) * radius**2 < HELD * beam.section.EI
