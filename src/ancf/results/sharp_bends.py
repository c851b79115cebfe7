"""Elements of cables that are too long for the bend they make: curvature times length of an element.

A cubic element that turns by more than about a radian follows neither a change of its curvature nor an arc.
What the number means is measured on the elastica, see docs/theory/cable.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..elements.slopes import Vectors, vectors_of
from ..model.bodies.beam import Beam
from .tension import cables, parts

#: Curvature times length of an element above which it is said, and that of the elements that are advised.
SHARP, ADVISED = 1.0, 0.5
#: Elements that are looked at together, and in all: of a longer history every second, third, ... state.
CHUNK, MOST = 50_000, 500_000
#: Texts of a history.
MOST_NOTES = 3
#: Smallest square of a slope that is no cusp.
CUSP = 1e-9


@dataclass(frozen=True)
class SharpBend:
    """The sharpest bend of a cable in a history, for the elements it has.

    Parameters
    ----------
    body, point : str
        The cable, and the end of the element.
    t : float
        Time, s.
    bend : float
        Curvature there times the length of the element, rad.
    element : float
        Length of the element, m.
    """

    body: str
    point: str
    t: float
    bend: float
    element: float

    def __str__(self) -> str:
        wanted = self.element * ADVISED / self.bend
        where = f"{self.point}, t = {self.t:.6g} s"
        return (
            f'"{self.body}" bends too sharply for its elements: curvature times length is {self.bend:.2g} at '
            f"{where}; above {SHARP:g} a bending moment is often 10 % and more too low: take "
            f"elements of {wanted:.2g} m there instead of {self.element:.2g} m"
        )


def sharp_bends(known: Any) -> list[SharpBend]:
    """The sharpest bend of each cable that resists bending, where it is above ``SHARP``; the worst first.

    ``known`` is a state or a history, whose stored states are looked at.
    """
    beams = [beam for beam in cables(known) if beam.section.EI > 0.0]
    times = np.atleast_1d(known.t)
    every = max(1, -(-len(times) * sum(beam.elements for beam in beams) // MOST))
    found: dict[str, SharpBend] = {}
    for rows, place in parts(known, beams, every, CHUNK):
        q = np.atleast_2d(known.q[place])
        for beam in beams:
            bend = _sharpest(beam, bends(vectors_of(beam.node_x, known.slots[beam.name], q)), times[rows])
            if bend.bend > max(SHARP, found[bend.body].bend if bend.body in found else 0.0):
                found[bend.body] = bend
    return sorted(found.values(), key=lambda item: -item.bend)


def notes(found: list[SharpBend]) -> list[str]:
    """The worst of them as texts, one line each."""
    more = [f"{len(found) - MOST_NOTES} more cables bend too sharply"] if len(found) > MOST_NOTES else []
    return [*map(str, found[:MOST_NOTES]), *more]


def bends(vectors: list[Vectors]) -> FloatArray:
    """Curvature per natural length times length at the first and last ends of elements, shape (2, n_t, n)."""
    ends = (
        ([first for _, first, _ in vectors], [6 * c - 4 * a - 2 * b for c, a, b in vectors]),
        ([last for _, _, last in vectors], [2 * a + 4 * b - 6 * c for c, a, b in vectors]),
    )
    found: FloatArray = np.stack([_turned(slope, change) for slope, change in ends])
    return found


def _turned(slope: list[FloatArray], change: list[FloatArray]) -> FloatArray:
    """|r_x x r_xx h| / |r_x|^2: the same, in whatever unit the arc length is counted."""
    (x, y, z), (u, v, w) = slope, change
    crossed = np.sqrt((y * w - z * v) ** 2 + (z * u - x * w) ** 2 + (x * v - y * u) ** 2)
    found: FloatArray = crossed / np.maximum(x * x + y * y + z * z, CUSP)
    return found


def _sharpest(beam: Beam, bend: FloatArray, times: FloatArray) -> SharpBend:
    end, row, element = (int(k) for k in np.unravel_index(int(np.argmax(bend)), bend.shape))
    point = str(beam.at(float(beam.node_x[element + end])))
    length = float(np.diff(beam.node_x)[element])
    return SharpBend(beam.name, point, float(times[row]), float(bend[end, row, element]), length)
