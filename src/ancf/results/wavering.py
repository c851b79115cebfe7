"""Axial forces of cables that waver within elements, which are too long for them, if not for the shape.

Where a cubic element bends, its r_x cannot keep its length everywhere: it is stretched here and pressed
there, by some (kappa h)^2.  What that adds vanishes in the mean, so that shapes and reactions hardly feel it,
but times a large EA it is more than the force itself.  A force that loads change within an element changes
from element to element as well; what changes within one by more than that is taken for such a wavering.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..elements.shapes import gauss
from ..elements.slopes import POINTS, Vectors, mean_strain, slope, vectors_of
from ..model.bodies.beam import Beam
from .tension import cables, natural_vectors, of_material, parts

#: Share of the largest force of a cable from which a wavering is said: at rest, and in a motion, in which
#: waves of the length of an element are some of it.
AT_REST, IN_MOTION = 0.1, 1.0
#: Elements that are looked at together, and in all: of a longer history every second, third, ... state.
CHUNK, MOST = 50_000, 500_000
#: Texts of a history.
MOST_NOTES = 3
#: Share of the axial stiffness below which forces are round-off.
NOISE = 1e-10


@dataclass(frozen=True)
class Wavering:
    """The largest wavering of the force of a cable in a history.

    Parameters
    ----------
    body, point : str
        The cable, and the end of the element.
    t : float
        Time, s.
    tension, off : float
        Mean force of the element, and how far the force at its end is from where it should be, N.
    largest : float
        Largest force of an element of the cable, the mean along it and what it carries across, N.
    element : float
        Length of the element, m.
    """

    body: str
    point: str
    t: float
    tension: float
    off: float
    largest: float
    element: float

    def __str__(self) -> str:
        where = f"about {self.tension:.3g} N at {self.point}, t = {self.t:.6g} s"
        return (
            f'forces along "{self.body}" waver within its elements of {self.element:.3g} m: by '
            f"{self.off:.3g} N {where}, where the largest force of an element is {self.largest:.3g} N: take "
            "shorter elements, or ask for forces of supports and joints"
        )


def waverings(known: Any) -> list[Wavering]:
    """The largest wavering of each cable, where it is above the share that is said; the worst first.

    ``known`` is a state or a history, whose stored states are looked at.
    """
    beams, times = [beam for beam in cables(known) if beam.elements > 1], np.atleast_1d(known.t)
    every = max(1, -(-len(times) * sum(beam.elements for beam in beams) // MOST))
    worst: dict[str, Wavering] = {}
    for rows, place in parts(known, beams, every, CHUNK):
        q = np.atleast_2d(known.q[place])
        for beam in beams:
            new, old = _worst(known, beam, q, times[rows]), worst.get(beam.name)
            if old is not None:
                largest = max(new.largest, old.largest)
                new = replace(new if new.off > old.off else old, largest=largest)
            worst[beam.name] = new
    share = AT_REST if len(known.q.shape) == 1 else IN_MOTION
    noise = {beam.name: NOISE * beam.section.EA for beam in beams}
    said = [item for item in worst.values() if item.off > max(share * item.largest, noise[item.body])]
    return sorted(said, key=lambda item: -item.off)


def notes(found: list[Wavering]) -> list[str]:
    """The worst of them as texts, one line each."""
    more = [f"forces of {len(found) - MOST_NOTES} more cables waver"] if len(found) > MOST_NOTES else []
    return [*map(str, found[:MOST_NOTES]), *more]


def _worst(known: Any, beam: Beam, q: FloatArray, times: FloatArray) -> Wavering:
    mean, off = _forces(known, beam, q)
    row, element = divmod(int(np.argmax(off)), off.shape[1])
    point, length = str(beam.at(float(beam.node_x[element]))), float(np.diff(beam.node_x)[element])
    force, largest = float(mean[row, element]), float(np.max(np.hypot(mean, _across(known, beam, q))))
    return Wavering(beam.name, point, float(times[row]), force, float(off[row, element]), largest, length)


def _forces(known: Any, beam: Beam, q: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Mean elastic force of each element, and by how much that at its ends wavers, N, (n_t, n) each."""
    vectors = vectors_of(beam.node_x, known.slots[beam.name], q)
    length = known.lengths.get(beam.name, (-1, 0.0))
    if length[0] >= 0:
        vectors = of_material(vectors, beam.length / q[:, length[0]][:, None])
    mean, within = mean_strain(vectors, beam.strain), strain_slope(vectors, beam.strain)
    if (natural := natural_vectors(beam)) is not None:
        mean = mean - mean_strain(natural, beam.strain)
        within = within - strain_slope(natural, beam.strain)
    mean, within = beam.section.EA * mean, beam.section.EA * within
    steps = np.abs(np.diff(mean, axis=1))
    none = np.zeros((len(mean), 1))
    between = np.maximum(np.hstack([none, steps]), np.hstack([steps, none]))
    return mean, np.maximum(np.abs(within) - between, 0.0)


def _across(known: Any, beam: Beam, q: FloatArray) -> FloatArray:
    """Forces across elements that bend, EI r_xxx, N, (n_t, n): a cantilever may carry by nothing else."""
    vectors, h = vectors_of(beam.node_x, known.slots[beam.name], q), np.diff(beam.node_x)
    third = [(6.0 * (first + last) - 12.0 * chord) / h**2 for chord, first, last in vectors]
    found: FloatArray = beam.section.EI * np.sqrt(sum(np.square(part) for part in third))
    return found


def strain_slope(vectors: list[Vectors], strain: str) -> FloatArray:
    """Axial strain of elements, projected on a line: at the end less that in the middle, (n_t, n)."""
    total: FloatArray = np.zeros_like(vectors[0][0])
    for xi, weight in zip(*(x.tolist() for x in gauss(POINTS)), strict=True):
        square = sum(np.square(slope(part, xi)) for part in vectors)
        total += 3.0 * weight * (2.0 * xi - 1.0) * (0.5 * square if strain == "paper" else np.sqrt(square))
    return total
