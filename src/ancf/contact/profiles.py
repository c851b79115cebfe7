"""Profiles of surfaces of revolution: signed distance in the half plane of radius rho and height z.

A profile is one function ``profile(numbers, rho, z)`` that returns

    d                the distance from the surface, negative inside,
    n_rho, n_z       its gradient, the unit normal that points outwards,
    bend             the curvature of the line of equal distance in that plane, 1/m, positive where convex,

for the numbers of its shape in the order of their declaration (:mod:`ancf.model.surfaces.shapes`).
With the curvature n_rho/rho about the axis, ``bend`` is all of the derivative of the normal.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import inline_kernel, kernel
from ..model.surfaces.shape import Shape
from ..model.surfaces.shapes import SHAPES


@inline_kernel
def plane(numbers, rho, z):
    """The half space z < 0."""
    return z, 0.0, 1.0, 0.0


@inline_kernel
def round_corner(x, y):
    """Distance from a corner that is x and y away, both positive."""
    d = math.sqrt(x * x + y * y)
    s = 1.0 / d if d > 0.0 else 0.0
    return d, x * s, y * s, s


@inline_kernel
def cylinder(numbers, rho, z):
    """Radius and length, the middle at z = 0; a length of 0 stands for no end."""
    out = rho - numbers[0]
    if numbers[1] == 0.0:
        return out, 1.0, 0.0, 0.0
    up = 1.0 if z >= 0.0 else -1.0
    over = abs(z) - 0.5 * numbers[1]
    if out > 0.0 and over > 0.0:
        d, x, y, bend = round_corner(out, over)
        return d, x, up * y, bend
    if over > out:
        return over, 0.0, up, 0.0
    return out, 1.0, 0.0, 0.0


@inline_kernel
def sphere(numbers, rho, z):
    """Radius."""
    r, x, y, bend = round_corner(rho, z)
    return r - numbers[0], x, y, bend


@inline_kernel
def capsule(numbers, rho, z):
    """Radius, and length between the centres of the round ends."""
    over = max(abs(z) - 0.5 * numbers[1], 0.0)
    if over == 0.0:
        return rho - numbers[0], 1.0, 0.0, 0.0
    r, x, y, bend = round_corner(rho, over)
    return r - numbers[0], x, y if z > 0.0 else -y, bend


@inline_kernel
def torus(numbers, rho, z):
    """Radius of the centreline and of the tube."""
    r, x, y, bend = round_corner(rho - numbers[0], z)
    return r - numbers[1], x, y, bend


@inline_kernel
def sheave(numbers, rho, z):
    """Tread radius at the bottom of the groove, its radius, its depth, sine of half the angle of the flanks.

    The bottom is an arc, the flanks are its tangents, the rim is a cylinder without end.
    """
    groove, s = numbers[1], numbers[3]
    c = math.sqrt(1.0 - s * s)
    x, y = rho - numbers[0] - groove, abs(z)  # from the centre of the arc
    up = 1.0 if z >= 0.0 else -1.0
    rim = numbers[2] - groove  # its height over the centre
    long = (rim + groove * s) / c  # of the flank
    at = (x + groove * s) * c + (y - groove * c) * s  # along the flank
    off = (x + groove * s) * s - (y - groove * c) * c  # from the flank, positive inside the groove
    edge = groove * c + long * s
    if x >= rim and y >= edge:
        return x - rim, 1.0, 0.0, 0.0
    if at > long and y < edge:
        d, a, b, bend = round_corner(x - rim, edge - y)
        return d, a, -up * b, bend
    if off < 0.0 and y > edge and x - rim > off:
        return x - rim, 1.0, 0.0, 0.0
    if at > 0.0:
        return off, s, -up * c, 0.0
    r, a, b, bend = round_corner(x, y)
    return groove - r, -a, -up * b, -bend


#: By the word of the shape.
PROFILES: dict[str, Callable[..., Any]] = {
    "plane": plane,
    "cylinder": cylinder,
    "sphere": sphere,
    "capsule": capsule,
    "torus": torus,
    "sheave": sheave,
}
#: Number of a shape in the arrays of a batch.
NUMBER = {word: k for k, word in enumerate(SHAPES)}


def _or(number: int, own: Any, others: Any) -> Any:
    """Kernel that takes `own` for shapes of this number, else what the others take."""

    @inline_kernel
    def chosen(shape, numbers, rho, z):
        if shape == number:
            return own(numbers, rho, z)
        return others(shape, numbers, rho, z)

    return chosen


@inline_kernel
def _nowhere(shape, numbers, rho, z):
    return math.inf, 0.0, 0.0, 0.0


def _all() -> Any:
    chosen = _nowhere
    for word, profile in PROFILES.items():
        chosen = _or(NUMBER[word], profile, chosen)
    return chosen


#: Profile of any shape: ``profile_of(shape, numbers, rho, z)``.
profile_of = _all()


@kernel
def distances_from(shape, numbers, rho, z, out):
    """Signed distances of places in the half plane, m."""
    for k in range(rho.shape[0]):
        out[k] = profile_of(shape, numbers, rho[k], z[k])[0]


def distances(shape: Shape, places: FloatArray) -> FloatArray:
    """Signed distances of places (n, 3), in the axes in which a shape is given, from its surface, m."""
    arm = places - shape.place
    z = arm @ shape.direction
    rho = np.linalg.norm(arm - z[:, None] * shape.direction, axis=1)
    out = np.empty(len(places))
    distances_from(NUMBER[shape.word], np.array([*shape.numbers, 0.0]), rho, z, out)
    return out
