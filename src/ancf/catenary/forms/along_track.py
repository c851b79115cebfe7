"""Loads that act along the wires of a line: the pull of a curve, wind."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import pairwise

import numpy as np

import ancf

from ...arrays import FloatArray
from ..lines.cant import sideways_gravity
from ..lines.conditions import Conditions
from ..lines.line import Line
from .mesh import stitch_ends
from .shape import Strung, WireShape

#: Distance of the places between which gusts are interpolated, m, and time in which they grow, s.
GUST_SPACING, GUST_RAMP = 10.0, 1.0
#: Places nearer to each other are one, m: nodes are rounded, the sums of spans are not.
SAME = 1e-6
#: A part of a wire along the track and its sideways load: from and to in m, N per m of track.
Piece = tuple[float, float, float]


def curve_pull(line: Line, shape: WireShape, name: str) -> list[Piece]:
    """What curve and cant do to a wire, in coordinates that follow the track.

    A straight wire under the tension T is bent in them by the curvature of the track 1/R, as by a load T/R
    towards the inside of the curve. Across a canted track its weight has a part to the lower side. ``name``
    is "contact", "messenger", "auxiliary" or "stitch".
    """
    if not any(line.cants) and not any(span.radius is not None for span in line.spans):
        return []
    low, high = float(shape.nodes.x[0]), float(shape.nodes.x[-1])
    cuts = [x for x in line.supports.tolist() if low + SAME < x < high - SAME]
    pieces = [(a, b, shape.wire.tension * c) for a, b, c in _curved(line, [low, *cuts, high])]
    if name == "messenger" and line.stitch is not None:
        for a, b in stitch_ends(line).tolist():
            parts = _curved(line, [a, 0.5 * (a + b), b])
            pieces += [(x0, x1, -line.stitch.wire.tension * c) for x0, x1, c in parts]
    return pieces + [(a, b, shape.wire.mass * c) for a, b, c in sideways_gravity(line, [low, *cuts, high])]


def _curved(line: Line, cuts: list[float]) -> Iterator[Piece]:
    for a, b in pairwise(cuts):
        span = int(np.searchsorted(line.supports, 0.5 * (a + b), side="right")) - 1
        if line.spans[span].radius is not None:
            yield a, b, line.spans[span].curvature


def add_sideways(model: ancf.Model, wire: Strung, pieces: list[Piece]) -> None:
    """Put sideways loads on a wire in a model; its parts are those of the track at rest in the design."""
    shape = wire.shape
    for a, b, load in pieces:
        first, last = (float(np.interp(x, shape.nodes.x, shape.arc)) for x in (a, b))
        per_arc = load * (b - a) / (last - first)
        for beam, start in zip(wire.beams, shape.arc[wire.first].tolist(), strict=True):
            x0, x1 = max(first - start, 0.0), min(last - start, beam.length)
            if x1 > x0 + 1e-9:
                model.add_distributed_load(beam, (0.0, per_arc, 0.0), between=(x0, x1))


def add_wind(model: ancf.Model, air: Conditions, extent: tuple[float, float]) -> None:
    """Wind across the track as a fluid in which the wires stand, with gusts over an extent in m if wanted."""
    gusts = None
    if air.turbulence > 0.0:
        gusts = ancf.Gusts.von_karman(
            speed=abs(air.wind),
            deviation=air.turbulence * abs(air.wind),
            length=air.gust_length,
            extent=extent,
            direction=math.copysign(0.5 * math.pi, air.wind),
            line=(1.0, 0.0, 0.0),
            spacing=GUST_SPACING,
            ramp=GUST_RAMP,
            seed=air.seed,
        )
    model.add_fluid("wind", density=air.air_density, velocity=(0.0, air.wind, 0.0), gusts=gusts)


def lumped_pull(x: FloatArray, pieces: list[Piece]) -> FloatArray:
    """The same loads as forces (n,) in N at places x (n,), m."""
    force = np.zeros(x.size)
    cell = np.diff(x)
    for a, b, load in pieces:
        inside = np.clip(np.minimum(x[1:], b) - np.maximum(x[:-1], a), 0.0, cell)
        force[:-1] += 0.5 * load * inside
        force[1:] += 0.5 * load * inside
    return force
