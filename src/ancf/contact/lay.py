"""Where the axis of a capsule is nearest to a surface of revolution, and how its places share the force.

With the depths g of places on the axis, the energy of a contact is

    U = k/2 [ sum over halves (g_C^2 + tau (g_A g_B/g_C)^2) - g_0^2 ],

depths that are zero where nothing touches.  C is the deepest place of a half of the axis, A and B are the
ends of the stretch along which a straight line can lie on the surface: where a capsule lies flat, C is one of
them and U is that of two springs, where it crosses they are outside and U is that of one; in between the
force is continuous.  tau goes to one over a radius of length of that stretch.  Bodies that are not convex may
be touched in two places, so that the axis is taken in two halves, on a torus where it is nearest to the axis
of revolution, on a sheave in the middle of its groove.  The shallowest place 0 between C and C of both halves
is subtracted, so that nothing counts twice where they are one.

All these places are extrema of the depth, or fixed in a body, so that the forces along the normals are the
gradient of U.  Where A or B is the end of the surface, not of the capsule, tau changes as the two slide along
each other: that is a force of its own, across the end, in this place.
"""

from __future__ import annotations

import math

from ..compiled import inline_kernel, separate_kernel
from .profiles import NUMBER, profile_of

#: Places of the first half: C, A, B, what tau does in A and in B; those of the second one are OTHER further.
DEEPEST, FIRST, LAST, OFF_FIRST, OFF_LAST, OTHER = range(6)
#: The shallowest place between both halves.
SHALLOW = 2 * OTHER
#: What fixes an end of a stretch: the end of the axis, a height, a radius of the surface.
AT_END, AT_HEIGHT, AT_RADIUS = range(3)
#: Pieces of a half in which the deepest place is looked for, and halvings of the one that has it.
PIECES, HALVINGS = 8, 54

CYLINDER, CAPSULE, TORUS, SHEAVE = (NUMBER[word] for word in ("cylinder", "capsule", "torus", "sheave"))


@inline_kernel
def along(shape, numbers, line, s):
    """Distance of the place at the share s of a line from a surface, and its derivative by s.

    ``line``: height of its start and the change of it, square of the radius as b0 + 2 b1 s + b2 s^2.
    """
    h0, hd, b0, b1, b2 = line
    rho = math.sqrt(max(b0 + s * (2.0 * b1 + s * b2), 0.0))
    d, n_rho, n_z, _ = profile_of(shape, numbers, rho, h0 + s * hd)
    away = (b1 + b2 * s) / rho if rho > 0.0 else 0.0
    return d, n_rho * away + n_z * hd


@inline_kernel
def turn_between(shape, numbers, line, lo, hi, sense):
    """Share between two others where the distance turns, from falling to rising for sense 1."""
    for _ in range(HALVINGS):
        s = 0.5 * (lo + hi)
        _, slope = along(shape, numbers, line, s)
        if sense * slope < 0.0:
            lo = s
        else:
            hi = s
    return 0.5 * (lo + hi)


@inline_kernel
def nearest_on(shape, numbers, line, lo, hi):
    """Share between two others where the distance is least."""
    best, least = 0, math.inf
    for i in range(PIECES + 1):
        d, _ = along(shape, numbers, line, lo + (hi - lo) * i / PIECES)
        if d < least:
            best, least = i, d
    piece = (hi - lo) / PIECES
    return turn_between(
        shape, numbers, line, max(lo + (best - 1) * piece, lo), min(lo + (best + 1) * piece, hi), 1.0
    )


@inline_kernel
def halved_at(shape, line):
    """Share where the second half begins; 1 where a body is convex."""
    h0, hd, _, b1, b2 = line
    if shape == TORUS and b2 > 0.0:
        return min(max(-b1 / b2, 0.0), 1.0)
    if shape == SHEAVE and hd != 0.0:
        return min(max(-h0 / hd, 0.0), 1.0)
    return 1.0


@inline_kernel
def cut(a, b, lo, hi, what):
    """The part of the stretch from a to b within lo and hi, and what its ends are; none has a > b."""
    if min(b, hi) < max(a, lo):
        return 1.0, AT_END, 0.0, AT_END
    return max(a, lo), what if a > lo else AT_END, min(b, hi), what if b < hi else AT_END


@inline_kernel
def below(line, height, lo, hi):
    """The stretch with heights up to this one, on both sides."""
    h0, hd = line[0], line[1]
    if hd == 0.0:
        return cut(lo, hi, lo, hi, AT_END) if abs(h0) <= height else cut(1.0, 0.0, 0.0, 1.0, AT_END)
    a, b = (-height - h0) / hd, (height - h0) / hd
    return cut(min(a, b), max(a, b), lo, hi, AT_HEIGHT)


@inline_kernel
def beyond(line, height, lo, hi):
    """The stretch of one half with larger heights."""
    h0, hd = line[0], line[1]
    far = hi if abs(h0 + hi * hd) >= abs(h0 + lo * hd) else lo
    if hd == 0.0 or abs(h0 + far * hd) <= height:
        none = abs(h0 + far * hd) <= height
        return cut(1.0, 0.0, 0.0, 1.0, AT_END) if none else cut(lo, hi, lo, hi, AT_END)
    at = ((height if h0 + far * hd > 0.0 else -height) - h0) / hd
    return cut(at, far, lo, hi, AT_HEIGHT) if far == hi else cut(far, at, lo, hi, AT_HEIGHT)


@inline_kernel
def within(line, radius, lo, hi):
    """The stretch with radii up to this one."""
    _, _, b0, b1, b2 = line
    c = b0 - radius * radius
    if b2 == 0.0:
        return cut(lo, hi, lo, hi, AT_END) if c <= 0.0 else cut(1.0, 0.0, 0.0, 1.0, AT_END)
    root = b1 * b1 - b2 * c
    if root < 0.0:
        return cut(1.0, 0.0, 0.0, 1.0, AT_END)
    r = math.sqrt(root)
    return cut((-b1 - r) / b2, (-b1 + r) / b2, lo, hi, AT_RADIUS)


@inline_kernel
def rim_edge(numbers):
    """Height of the edge of the rim of a sheave over the middle of its groove."""
    s = numbers[3]
    c = math.sqrt(1.0 - s * s)
    return numbers[1] * c + (numbers[2] - numbers[1] * (1.0 - s)) / c * s


@inline_kernel
def shallowest(shape, numbers, line, middle, c, other):
    """Share of the shallowest place between the deepest ones of both halves, of a sheave in its groove."""
    if shape == SHEAVE:
        lo, _, hi, _ = below(line, rim_edge(numbers), c, other)
        return middle if lo > hi else turn_between(shape, numbers, line, lo, hi, -1.0)
    return turn_between(shape, numbers, line, c, other, -1.0)


@inline_kernel
def flat_part(shape, numbers, line, lo, hi):
    """Ends of the stretch along which a line can lie on a surface, and what they are; none has a > b."""
    if shape == CYLINDER and numbers[1] > 0.0:
        x, y = below(line, 0.5 * numbers[1], lo, hi), within(line, numbers[0], lo, hi)
        if x[0] > x[2]:
            return y
        if y[0] > y[2]:
            return x
        a, b = x if x[0] <= y[0] else y, x if x[2] >= y[2] else y
        return a[0], a[1], b[2], b[3]
    if shape == CYLINDER:
        return lo, AT_END, hi, AT_END
    if shape == CAPSULE:
        return below(line, 0.5 * numbers[1], lo, hi)
    if shape == SHEAVE:
        return beyond(line, rim_edge(numbers), lo, hi)
    return 1.0, AT_END, 0.0, AT_END


@inline_kernel
def depth_at(shape, numbers, line, radius, s):
    """Depth of a place, none below zero."""
    d, _ = along(shape, numbers, line, s)
    return max(radius - d, 0.0)


@inline_kernel
def shares(shape, numbers, line, size, radius, lo, hi, c, place):
    """A place of a half whose deepest one is c: its share of the line, what it is, shares of force and U."""
    a, of_a, b, of_b = flat_part(shape, numbers, line, lo, hi)
    deepest = depth_at(shape, numbers, line, radius, c)
    x, y, on, rate = 0.0, 0.0, 0.0, 0.0
    if b > a and deepest > 0.0:
        x = depth_at(shape, numbers, line, radius, a) / deepest
        y = depth_at(shape, numbers, line, radius, b) / deepest
        size /= radius
        on = min((b - a) * size, 1.0)
        on, rate = on * on * (3.0 - 2.0 * on), 6.0 * on * (1.0 - on) * size
    if place == FIRST:
        return a, of_a, on * y * y, 0.0
    if place == LAST:
        return b, of_b, on * x * x, 0.0
    if place == OFF_FIRST:
        return a, of_a, (-0.5 * rate * deepest * x * y * y if of_a != AT_END else 0.0), 0.0
    if place == OFF_LAST:
        return b, of_b, (0.5 * rate * deepest * x * x * y if of_b != AT_END else 0.0), 0.0
    both = on * x * x * y * y
    return c, AT_END, 1.0 - both, 1.0 + both


@separate_kernel
def lay(shape, numbers, line, size, radius, part):
    """A place of a capsule: share of its axis, what it is, shares of force, of losses, and of U.

    ``part``: which one; ``line`` as in :func:`along`; ``size`` and ``radius`` of the capsule, m.
    """
    if part != DEEPEST and part != OTHER:
        d, _ = along(shape, numbers, line, 0.5)
        if d > 0.5 * size + radius:  # out of reach, where only what is nearest is of interest
            return 0.5, AT_END, 0.0, 0.0, 0.0
    middle = halved_at(shape, line)
    c = nearest_on(shape, numbers, line, 0.0, middle)
    if shape != TORUS and shape != SHEAVE:
        s, what, w, energy = shares(shape, numbers, line, size, radius, 0.0, 1.0, c, part)
        return s, what, w, w, energy
    other = nearest_on(shape, numbers, line, middle, 1.0)
    top = shallowest(shape, numbers, line, middle, c, other)
    if part == SHALLOW:
        return top, AT_END, -1.0, 0.0, -1.0
    lo, hi, place = 0.0, middle, part
    if part >= OTHER:
        c, other, lo, hi, place = other, c, middle, 1.0, part - OTHER
    s, what, w, energy = shares(shape, numbers, line, size, radius, lo, hi, c, place)
    deepest = depth_at(shape, numbers, line, radius, c)
    least = depth_at(shape, numbers, line, radius, top)
    if least == 0.0:
        return s, what, w, w, energy
    # as much is lost where both are one as in one of them
    x = least / deepest
    y = least / depth_at(shape, numbers, line, radius, other)
    return s, what, w, w * (1.0 - x * x + 0.5 * x * x * y * y), energy
