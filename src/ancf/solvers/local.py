"""Derivatives of the forces of batches that know what they touch: only that is moved for differences.

A contact of a strip with a wire touches a dozen of the unknowns of a long line.  See
:func:`ancf.compiled.touched`; ``near`` has what is touched and, in the rows behind, the direction there.
"""

from __future__ import annotations

from ..batches import add_forces
from ..compiled import formula, inline_kernel
from .rare import all_touched
from .sensitivity import LEAST

#: Part of a derivative by which differences agree that reach over no kink; how much closer the next one is
#: taken otherwise, and how often: the closest has round-off of 1e-7 of a contact on a line of some metres.
BENT, CLOSE, CLOSER = 1e-3, 8.0, 3


@inline_kernel
def look_near(m, x):
    """Keep the state x where :func:`add_local` moves it; the number of unknowns that rough batches touch."""
    w = m.work
    for i in range(w.shape[1]):
        w[4, i], w[5, i], w[6, i], w[7, i] = x[0][i], x[1][i], x[2][i], 0.0
    return all_touched(m.rough, x[0], m.near[0])


@inline_kernel
def largest_near(row, index, weight):
    """Largest entry by size, weighted; shadows count as they are."""
    size = 0.0
    for t in range(row.shape[0]):
        i = int(index[t])
        size = max(size, abs(row[t]) * (weight[i] if i < weight.shape[0] else 1.0))
    return size


@inline_kernel
def differenced(core, m, x, count, e, f):
    """Derivative of the forces of rough batches along ``near``, in its row 6: q moves by e, rates by f."""
    near, w = m.near, m.work
    for t in range(count):
        near[6, t] = 0.0
    for side in (1.0, -1.0):
        for t in range(count):
            i = int(near[0, t])
            w[4, i] = x[0][i] + side * e * near[1, t]
            w[5, i] = x[1][i] + side * f * near[2, t]
            w[6, i] = x[2][i] + side * f * near[3, t]
        add_forces(m.rough, w[4], w[5], w[6], w[7], core.ws)
        for t in range(count):
            i = int(near[0, t])
            near[6, t] += side * w[7, i] / (2.0 * (e + f))
            w[7, i] = 0.0  # it may stand there twice
    for t in range(count):
        i = int(near[0, t])
        w[4, i], w[5, i], w[6, i] = x[0][i], x[1][i], x[2][i]


@formula
def agree(far, near):
    """Whether two differences of a derivative do."""
    apart, size = 0.0, 0.0
    for t in range(far.shape[0]):
        apart, size = max(apart, abs(far[t] - near[t])), max(size, abs(far[t]))
    return apart <= BENT * size


@inline_kernel
def add_moved(core, m, x, count, e, f, r, lane):
    """Add the derivative of the forces of rough batches along ``near`` to r: q moves by e, rates by f.

    Where a contact nearly opens or closes the difference would reach over that: it is taken more closely
    until the next one agrees, which has more round-off.  Where none do that is all there is, and the first,
    which has the least, stands.
    """
    near, taken = m.near, 4
    for k in range(CLOSER + 1):
        differenced(core, m, x, count, e, f)
        last = 4 if k < 2 else 5
        if k > 0 and agree(near[last, :count], near[6, :count]):
            taken = last
            break
        for t in range(count):
            near[4 if k == 0 else 5, t] = near[6, t]
        e, f = e / CLOSE, f / CLOSE
    for t in range(count):
        r[int(near[0, t]), lane] += near[taken, t]


@inline_kernel
def add_local(core, m, x, count, r, lane):
    """Add what rough batches do along ``near`` to r, of one lane: only what they touch is moved."""
    near = m.near
    index = near[0, :count]
    size = largest_near(near[1, :count], index, core.weight)
    if size > LEAST:
        add_moved(core, m, x, count, m.moved / size, 0.0, r, lane)
    size = largest_near(near[2, :count], index, core.weight)
    size = size if size > LEAST else largest_near(near[3, :count], index, core.weight)
    if size > LEAST:
        add_moved(core, m, x, count, 0.0, m.moved / size, r, lane)


@inline_kernel
def add_locals(core, m, x, room, lanes):
    """The same of the sensitivities in all lanes that are open."""
    if m.rough.table.shape[0] == 0 or not m.local:
        return
    count = look_near(m, x)
    for lane in range(lanes):
        if room.open[lane] > 0.0:
            for t in range(count):
                i = int(m.near[0, t])
                for k in range(3):
                    m.near[1 + k, t] = room.d[k, i, lane]
            add_local(core, m, x, count, room.r, lane)
