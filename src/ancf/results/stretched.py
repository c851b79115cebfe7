"""Axial strains that are no longer small: cables and beams that are stretched farther than EA is constant.

Forces are EA times the strain, and bending, mass and diameter stay those of the natural length.  A tenth is
more than steel or fibre ropes bear; what stretches so far is of rubber, or its EA was given in another unit.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..elements.slopes import mean_strain, vectors_of
from ..model.bodies.beam import Beam
from .tension import middles, natural_vectors, of_material, parts

#: Strain from which on it is said: steel yields at 0.002, ropes of polyester break at about 0.15.
LARGE = 0.1
#: Elements that are looked at together, and in all: of a longer history every second, third, ... state.
CHUNK, MOST = 50_000, 500_000
#: Bodies that a note names beside the first.
MOST_NAMED = 3


@dataclass(frozen=True)
class Stretched:
    """The largest axial strain of a body in a history.

    Parameters
    ----------
    body, point : str
        The cable or beam, and the middle of an element.
    t : float
        Time, s.
    strain : float
        Mean of the element; below zero where a beam with a cross-section is pressed.
    EA : float
        Axial stiffness of the body, N.
    """

    body: str
    point: str
    t: float
    strain: float
    EA: float

    def __str__(self) -> str:
        how = "is stretched by" if self.strain > 0.0 else "is pressed together by"
        size = f"{100.0 * abs(self.strain):.3g} %"
        return (
            f'"{self.body}" {how} {size} at {self.point}, t = {self.t:.6g} s: was its '
            f"EA of {self.EA:g} N given in kN, or do its ends go too far? steel yields at 0.2 %, fibre ropes "
            "break at some 15 %; rubber goes so far, but its EA would not stay constant"
        )


def stretched(known: Any) -> list[Stretched]:
    """The largest strain of each body, where it is above a tenth; the largest first.

    ``known`` is a state or a history, whose stored states are looked at.  What cables are pressed by is left
    to :mod:`ancf.results.tension`.
    """
    beams, times = [body for body in known.bodies.values() if isinstance(body, Beam)], np.atleast_1d(known.t)
    every = max(1, -(-len(times) * sum(beam.elements for beam in beams) // MOST))
    found: dict[str, Stretched] = {}
    for rows, place in parts(known, beams, every, CHUNK):
        q = np.atleast_2d(known.q[place])
        for beam in beams:
            new = _largest(beam, strains(known, beam, q), times[rows])
            old = abs(found[beam.name].strain) if beam.name in found else LARGE
            if abs(new.strain) > old:
                found[beam.name] = new
    return sorted(found.values(), key=lambda item: -abs(item.strain))


def strains(known: Any, beam: Beam, q: FloatArray) -> FloatArray:
    """Mean change of length per natural length of each element in states (n_t, size), shape (n_t, n)."""
    vectors = vectors_of(beam.node_x, known.slots[beam.name], q)
    unknown, _ = known.lengths.get(beam.name, (-1, 0.0))
    if unknown >= 0:
        vectors = of_material(vectors, beam.length / q[:, unknown][:, None])
    natural = natural_vectors(beam)
    here = mean_strain(vectors, "material")
    return here if natural is None else here - mean_strain(natural, "material")


def notes(found: list[Stretched]) -> list[str]:
    """One text: the worst of them, and the names of others."""
    if not found:
        return []
    others = [f'"{item.body}"' for item in found[1 : 1 + MOST_NAMED]]
    if len(found) > 1 + MOST_NAMED:
        others.append(f"{len(found) - 1 - MOST_NAMED} more")
    return [f"{found[0]}; so far as well: {', '.join(others)}" if others else str(found[0])]


def _largest(beam: Beam, strain: FloatArray, times: FloatArray) -> Stretched:
    size = np.abs(strain) if beam.has_section else np.maximum(strain, 0.0)
    row, element = divmod(int(np.argmax(size)), strain.shape[1])
    found = float(strain[row, element]) if size[row, element] else 0.0
    return Stretched(
        beam.name, str(beam.at(middles(beam)[element])), float(times[row]), found, beam.section.EA
    )
