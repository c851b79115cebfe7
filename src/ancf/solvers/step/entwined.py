"""Corrections with what cables do to each other, which is not in the factorised matrix.

Which unknowns contacts between cables couple changes while they move.  So the matrix K that is factorised is
that of all else, and the correction x of (K + sum k_i b_i b_i^T) x = r is found with it by GMRES (Saad &
Schultz 1986, here with K^-1 from the left): each round costs one solve with the factors and products with the
rows b_i, which have 24 entries.  There are never more rounds than rows, and fewer where rows are alike.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import formula, inline_kernel, separate_kernel
from ...contact.rows import find_rows
from ...contact.strand import HELD, find_zones
from ...system.core import onto_shadows, solve_kept, to_local
from .corotation import turn_back, turn_forth
from .low_rank import corrected

#: Share of the correction that may be wrong.
LEFT = 1e-4
#: Sizes of corrections from which on an iteration has gone astray.
UNLIMITED = 1e300


@inline_kernel
def product_of(x, y, n):
    """Product of the first n numbers."""
    total = 0.0
    for i in range(n):
        total += x[i] * y[i]
    return total


@inline_kernel
def times_rows(batch, rows, x, out):
    """out = sum k_i b_i (b_i . x)."""
    for i in range(out.shape[0]):
        out[i] = 0.0
    for m in range(rows):
        row = batch.row[m]
        total = 0.0
        for side in range(2):
            e = batch.at[m, side]
            for k in range(4):
                i, o = batch.base[e, k], 12 * side + 3 * k
                total += row[o] * x[i] + row[o + 1] * x[i + 1] + row[o + 2] * x[i + 2]
        total *= row[24]
        for side in range(2):
            e = batch.at[m, side]
            for k in range(4):
                i, o = batch.base[e, k], 12 * side + 3 * k
                out[i] += total * row[o]
                out[i + 1] += total * row[o + 1]
                out[i + 2] += total * row[o + 2]


@inline_kernel
def rotate(H, k):
    """Apply the rotations of earlier columns to column k of H, and one more that clears what is below it."""
    c, s = H.shape[1] - 3, H.shape[1] - 2
    for j in range(k):
        x, y = H[j, k], H[j + 1, k]
        H[j, k], H[j + 1, k] = H[j, c] * x + H[j, s] * y, H[j, c] * y - H[j, s] * x
    x, y = H[k, k], H[k + 1, k]
    size = math.sqrt(x * x + y * y)
    H[k, c], H[k, s] = (x / size, y / size) if size > 0.0 else (1.0, 0.0)
    H[k, k], H[k + 1, k] = size, 0.0
    g = H.shape[1] - 1
    H[k + 1, g] = -H[k, s] * H[k, g]
    H[k, g] *= H[k, c]


@inline_kernel
def combine(H, V, k, n, x):
    """x = the combination of the first k vectors that leaves least."""
    g = H.shape[1] - 1
    for i in range(k - 1, -1, -1):
        for j in range(i + 1, k):
            H[i, g] -= H[i, j] * H[j, g]
        H[i, g] = H[i, g] / H[i, i] if H[i, i] != 0.0 else 0.0
    for i in range(n):
        x[i] = 0.0
    for j in range(k):
        for i in range(n):
            x[i] += H[j, g] * V[j, i]


@inline_kernel
def clear(batch, vectors, rows):
    """Leave the workspace as it was: what is zero is not kept in files."""
    for j in range(vectors):
        for i in range(batch.basis.shape[1]):
            batch.basis[j, i] = 0.0
    for m in range(rows):
        for i in range(25):
            batch.row[m, i] = 0.0


@formula
def solve_turned(core, s, corotate):
    """Replace the residual s.r by the correction, with a factorisation that turns with the nodes."""
    if corotate:
        turn_back(s.frames, s.r)
    solve_kept(core, s.r, np.int64(0))
    if corotate:
        turn_forth(s.frames, s.r)


@inline_kernel
def solve_apart(core, s, corotate, gb, correct):
    """The same with what :mod:`ancf.solvers.step.low_rank` corrects."""
    solve_turned(core, s, corotate)
    if not corotate:
        corrected(correct, core, s, gb)


@inline_kernel
def next_vector(batch, rows, core, s, corotate, gb, correct, k):
    """Vector k + 1 of the basis, normal to those before it, and column k of the small matrix."""
    n, V, H = core.weight.shape[0], batch.basis, batch.small
    onto_shadows(core.supports, V[k])
    times_rows(batch, rows, V[k], s.r)
    to_local(core.supports, s.r)
    solve_apart(core, s, corotate, gb, correct)
    for i in range(n):
        s.r[i] += V[k, i]
    for j in range(k + 1):
        H[j, k] = product_of(V[j], s.r, n)
        for i in range(n):
            s.r[i] -= H[j, k] * V[j, i]
    size = math.sqrt(product_of(s.r, s.r, n))
    H[k + 1, k] = size
    for i in range(n):
        V[k + 1, i] = s.r[i] / size if size > 0.0 else 0.0


@separate_kernel
def solve_entwined(batch, core, s, corotate, gb, correct):
    """Let the correction s.r of the factorised matrix be that with what cables do to each other."""
    rows = find_rows(batch, s.q, s.v, gb, 1.0)
    if rows == 0:
        return
    n, V, H = core.weight.shape[0], batch.basis, batch.small
    g, size = H.shape[1] - 1, math.sqrt(product_of(s.r, s.r, n))
    if not 0.0 < size < UNLIMITED:
        return
    H[0, g] = size
    for i in range(n):
        V[0, i] = s.r[i] / size
    k = 0
    while k < V.shape[0] - 1:
        next_vector(batch, rows, core, s, corotate, gb, correct, k)
        rotate(H, k)
        k += 1
        if not abs(H[k, g]) > LEFT * size:
            break
    combine(H, V, k, n, s.r)
    clear(batch, k + 1, rows)


@separate_kernel
def hold_zones(batch, q):
    """Let where cables press on each other remain what it is in this state.

    Pieces that come and go make forces jump, by little, but a step that ends at a jump has no solution.
    """
    batch.room[HELD] = find_zones(batch, q)


@separate_kernel
def let_go_zones(batch):
    """Find it in each state again."""
    batch.room[HELD] = -1.0
