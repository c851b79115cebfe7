"""Axial forces of whole cables over a history: their extremes, and where one is pressed.

A cable that is pressed harder than a straight piece of its own length can stand, pi^2 EI/L^2, would buckle in
half waves of pi sqrt(EI/N).  Elements that are longer than half of that cannot show it: they carry a
compression that no rope has.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..elements.slopes import Vectors, mean_strain, slope, vectors_of
from ..model.bodies.beam import Beam

#: Element forces that are computed at once, and in all: of a longer history every second, third, ... state.
CHUNK, MOST = 100_000, 2_000_000
#: Share of the axial stiffness, and of the largest force, below which a compression is not spoken of.
NOISE, SMALL = 1e-10, 1e-3
#: Texts of a history; all are in ``summary.json``.
MOST_NOTES = 5


@dataclass(frozen=True)
class Compression:
    """The largest compression of a cable in a history.

    Parameters
    ----------
    body, point : str
        The cable, and the middle of an element.
    arc_length : float
        Reference arc length of that point, m.
    t : float
        Time, s.
    tension, largest : float
        The force there, N, below zero, and the largest force of this cable.
    half_wave : float
        Length at which a straight piece buckles under it, m; 0 without bending stiffness.
    element : float
        Length of the element, m.
    """

    body: str
    point: str
    arc_length: float
    t: float
    tension: float
    largest: float
    half_wave: float
    element: float

    def __str__(self) -> str:
        where = f'"{self.body}" is pressed: {self.tension:.4g} N at {self.point}, t = {self.t:.6g} s'
        if self.half_wave == 0.0:
            return f"{where}; without bending stiffness it can bear none: it is slack there"
        wave = f"its largest force is {self.largest:.4g} N; a piece of {self.half_wave:.3g} m would buckle"
        if self.half_wave < 2 * self.element:
            return f"{where}; {wave}, which elements of {self.element:.3g} m cannot show"
        return f"{where}; {wave}"

    def as_dict(self) -> dict[str, Any]:
        """All by name."""
        return asdict(self)


def compressions(known: Any) -> list[Compression]:
    """The largest compression of each cable that is pressed harder than it can stand, the worst first.

    Middles of the elements in a state, or at the stored times of a history; of one with more than two million
    forces at times that are evenly spaced.
    """
    beams, times = cables(known), np.atleast_1d(known.t)
    low = {beam.name: _Lowest() for beam in beams}
    states, elements = len(times), sum(beam.elements for beam in beams)
    for rows, forces in pieces(known, beams, every=max(1, -(-states * elements // MOST))):
        for name, force in forces.items():
            low[name].see(rows, force)
    found = [_compression(times, beam, low[beam.name]) for beam in beams if states]
    return sorted((item for item in found if item is not None), key=lambda item: item.tension)


def notes(found: list[Compression]) -> list[str]:
    """The worst of them as texts, one line each."""
    more = [f"{len(found) - MOST_NOTES} more cables are pressed"] if len(found) > MOST_NOTES else []
    return [*map(str, found[:MOST_NOTES]), *more]


def cables(known: Any) -> list[Beam]:
    """Bodies without a cross-section."""
    return [body for body in known.bodies.values() if isinstance(body, Beam) and not body.has_section]


def extremes(known: Any, beams: list[Beam], parts: int = 1) -> dict[str, tuple[float, float]]:
    """Smallest and largest force by cable over a history, N, averaged over so many elements in a row."""
    found = {beam.name: (np.inf, -np.inf) for beam in beams}
    for _, forces in pieces(known, beams):
        for name, force in forces.items():
            mean = force.reshape(len(force), -1, parts).mean(axis=-1)
            low, high = found[name]
            found[name] = min(low, float(mean.min())), max(high, float(mean.max()))
    return found


def element_forces(
    beam: Beam, slots: IntArray, q: FloatArray, v: FloatArray | None, length: tuple[int, float] = (-1, 0.0)
) -> FloatArray:
    """Forces of a cable in the middles of its elements, as ``tension`` gives them, N, shape (n_t, n).

    ``q`` and, with axial damping, ``v`` are of shape (n_t, size); ``length`` is that of a cable with a
    winch, see :func:`ancf.system.probe.lengths_of`.
    """
    section, strain = beam.section, beam.strain
    vectors = vectors_of(beam.node_x, slots, q)
    if length[0] >= 0:
        vectors = of_material(vectors, beam.length / q[:, length[0]][:, None])
    force: FloatArray = section.EA * (mean_strain(vectors, strain) - _natural(beam))
    if strain == "material" and not section.axial_damping:
        return force
    r_x = [slope(part) for part in vectors]
    stretch = np.sqrt(sum(x * x for x in r_x))
    if section.axial_damping and v is not None:
        rates = vectors_of(beam.node_x, slots, v) if length[0] < 0 else _rates(beam, slots, q, v, *length)
        rate = sum(x * slope(part) for x, part in zip(r_x, rates, strict=True))
        force += section.axial_damping * (rate / stretch if strain == "material" else rate)
    return force if strain == "material" else force * stretch


def along(known: Any, beam: Beam, x: FloatArray) -> FloatArray:
    """Forces of a cable at arc lengths x (m,), linear between the middles of its elements, N, (n_t, m).

    Beyond the outer middles it is what it is there. Within elements the force wavers where they are too long
    for how they bend, in their middles it does not, see :mod:`ancf.results.wavering`.
    """
    places = np.asarray(middles(beam))
    after = np.clip(np.searchsorted(places, x), min(1, beam.elements - 1), beam.elements - 1)
    before = np.maximum(after - 1, 0)
    span = np.where(after > before, places[after] - places[before], 1.0)
    share = np.clip((x - places[before]) / span, 0.0, 1.0)
    found = np.empty((len(known.q), len(x)))
    for rows, forces in pieces(known, [beam]):
        force = forces[beam.name]
        found[rows] = (1.0 - share) * force[:, before] + share * force[:, after]
    return found


class _Lowest:
    """Smallest and largest force of a cable so far, and where the smallest is."""

    def __init__(self) -> None:
        self.low, self.high, self.row, self.element = np.inf, 0.0, 0, 0

    def see(self, rows: IntArray, force: FloatArray) -> None:
        self.high = max(self.high, float(force.max()))
        row, element = divmod(int(np.argmin(force)), force.shape[1])
        if force[row, element] < self.low:
            self.low, self.row, self.element = float(force[row, element]), int(rows[row]), element


def _compression(times: FloatArray, beam: Beam, seen: _Lowest) -> Compression | None:
    section, pressure = beam.section, -seen.low
    if not pressure > max(np.pi**2 * section.EI / beam.length**2, NOISE * section.EA, SMALL * seen.high):
        return None
    x, h = middles(beam)[seen.element], float(np.diff(beam.node_x)[seen.element])
    wave, t = float(np.pi * np.sqrt(section.EI / pressure)), float(times[seen.row])
    return Compression(beam.name, str(beam.at(x)), x, t, seen.low, seen.high, wave, h)


def pieces(known: Any, beams: list[Beam], every: int = 1) -> Iterator[tuple[IntArray, dict[str, FloatArray]]]:
    """Rows of a history, or the one of a state, and the forces of each cable there, part after part."""
    damped = any(beam.section.axial_damping for beam in beams)
    for rows, place in parts(known, beams, every, CHUNK):
        q, v = np.atleast_2d(known.q[place]), np.atleast_2d(known.rates[place]) if damped else None
        yield (
            rows,
            {
                beam.name: element_forces(
                    beam, known.slots[beam.name], q, v, known.lengths.get(beam.name, (-1, 0.0))
                )
                for beam in beams
            },
        )


def parts(known: Any, beams: list[Beam], every: int, most: int) -> Iterator[tuple[IntArray, Any]]:
    """Rows of a history, or the one of a state, and where they are in its arrays: part after part.

    Every so many rows, and in a part so many that they have ``most`` elements of the beams in all.
    """
    single = len(known.q.shape) == 1
    chosen = np.zeros(1, dtype=np.int64) if single else np.arange(0, known.q.shape[0], every)
    count = max(1, most // max(1, sum(beam.elements for beam in beams)))
    for begin in range(0, len(chosen) if beams else 0, count):
        rows = chosen[begin : begin + count]
        yield rows, ... if single else slice(int(rows[0]), int(rows[-1]) + 1, every)


def middles(beam: Beam) -> list[float]:
    """Arc lengths of the middles of the elements, m."""
    places: list[float] = (0.5 * (beam.node_x[:-1] + beam.node_x[1:])).tolist()
    return places


def of_material(vectors: list[Vectors], factor: FloatArray) -> list[Vectors]:
    """Tangents by the material of a cable with a winch, whose length has changed by 1/factor."""
    return [(factor * chord, factor * first, factor * last) for chord, first, last in vectors]


def _rates(
    beam: Beam, slots: IntArray, q: FloatArray, v: FloatArray, unknown: int, far: float
) -> list[Vectors]:
    """Rates of r_x at the material of a cable with a winch, see :mod:`ancf.elements.winched`."""
    h, x, made = np.diff(beam.node_x), beam.node_x - far, []
    mu = (v[:, unknown] / q[:, unknown])[:, None]
    places = zip(vectors_of(beam.node_x, slots, q), vectors_of(beam.node_x, slots, v), strict=True)
    for k, ((chord, first, last), (v_chord, v_first, v_last)) in enumerate(places):
        slope = np.take(q, slots[:, 1] + k, axis=1)
        bend = (6 * chord - 4 * first - 2 * last) / h, (2 * first + 4 * last - 6 * chord) / h
        made.append(
            (
                v_chord - mu * np.diff(x * slope, axis=1) / h,
                v_first - mu * (first + x[:-1] * bend[0]),
                v_last - mu * (last + x[1:] * bend[1]),
            )
        )
    return of_material(made, beam.length / q[:, unknown][:, None])


def _natural(beam: Beam) -> FloatArray:
    """Mean axial strains of the natural shape, shape (n,)."""
    vectors = natural_vectors(beam)
    return np.zeros(beam.elements) if vectors is None else mean_strain(vectors, beam.strain)[0]


def natural_vectors(beam: Beam) -> list[Vectors] | None:
    """Tangents of the natural shape, (1, n) each; None where it is straight and has no nodes of its own."""
    natural = beam.natural
    if natural is None:
        return None
    row = np.stack([natural.node_position / natural.stretch, natural.node_tangent], axis=1).reshape(1, -1)
    return vectors_of(beam.node_x, 3 * np.arange(2 * (beam.elements + 1)).reshape(-1, 2), row)
