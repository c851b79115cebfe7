"""The line of a body along which something slides or is touched, and the point that does.

Both are sums over slots of the state vector, of which a batch has COLUMNS for each: those in use come
first, behind them is -1.  ``line_poly`` has the factors of the line as powers of xi = (s - start)/length.
"""

from __future__ import annotations

from ..compiled import formula

#: Most vectors of unknowns that a point of a body depends on.
COLUMNS = 10


@formula
def element_at(batch, j, s):
    """Element of the carrier that holds s, the first or last one beyond the ends."""
    low, high = batch.first[j], batch.first[j + 1] - 1
    while low < high:
        middle = (low + high + 1) // 2
        if s >= batch.x[middle, 0]:
            low = middle
        else:
            high = middle - 1
    return low


@formula
def shape(batch, e, k, xi, derivative):
    """Factor of column k, or a derivative with respect to s."""
    c0, c1, c2, c3 = (
        batch.line_poly[e, k, 0],
        batch.line_poly[e, k, 1],
        batch.line_poly[e, k, 2],
        batch.line_poly[e, k, 3],
    )
    il = 1.0 / batch.x[e, 1]
    if derivative == 0:
        return c0 + xi * (c1 + xi * (c2 + xi * c3))
    if derivative == 1:
        return il * (c1 + xi * (2.0 * c2 + xi * 3.0 * c3))
    if derivative == 3:
        return 6.0 * il * il * il * c3
    return il * il * (2.0 * c2 + 6.0 * xi * c3)


@formula
def line(batch, e, xi, q, derivative):
    """Point of the carrier's line or a derivative with respect to s, from values q."""
    x, y, z = 0.0, 0.0, 0.0
    for k in range(COLUMNS):
        i = batch.line_slot[e, k]
        if i < 0:
            break
        w = shape(batch, e, k, xi, derivative)
        x += w * q[i]
        y += w * q[i + 1]
        z += w * q[i + 2]
    return x, y, z


@formula
def slider(batch, j, q, fixed):
    """Position of the sliding point (fixed = 1) or its rate (fixed = 0)."""
    x, y, z = fixed * batch.offset[j, 0], fixed * batch.offset[j, 1], fixed * batch.offset[j, 2]
    for k in range(COLUMNS):
        i = batch.slot[j, k]
        if i < 0:
            break
        w = batch.factor[j, k]
        x += w * q[i]
        y += w * q[i + 1]
        z += w * q[i + 2]
    return x, y, z
