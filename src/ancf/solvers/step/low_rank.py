"""What has changed since the matrix was factorised, or never was in it, as a small correction.

A dropper that goes slack takes c b b^T out of the iteration matrix K, with b the gradient of its length and
c = k + (G/B) d; a contact that pushes adds the same with the gradient of its overlap.  Instead of a new
factorisation Woodbury's formula corrects the solution x = K^-1 r:

    (K + sum c_j b_j b_j^T)^-1 r = x - Z (diag(1/c) + B^T Z)^-1 B^T x,      z_j = K^-1 b_j,

where c is negative for what went slack.  The z_j of springs are kept as long as the factorisation is,
those of contacts, which move on, for one step.  Sliding joints have rows R at the border of K, with a Schur
complement S (:mod:`ancf.linalg.border`); with them z_j becomes z_j + K^-1 R^T e_j, e_j = S^-1 R z_j, of which
e_j alone changes in every step.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numba import types

from ...addresses import caller
from ...arrays import FloatArray, IntArray
from ...choices import optional
from ...compiled import formula, inline_kernel, separate_kernel
from ...connections.contact_build import no_contacts
from ...connections.contact_touch import DAMPING, FORCE, STIFFNESS, add_row, touch
from ...connections.spring_damper import spring_gradient, spring_state
from ...linalg.border import across, solve_small, spread
from ...linalg.reach import clear, solve_near, spread_of
from ...records import recorded
from ...system.core import has_rows, to_local
from ...system.system import System

#: Springs that are corrected at once; beyond them the iteration slows down and the matrix is renewed.
MOST = 24
#: Steps for which the row of a contact is kept.
KEPT = 1
#: Unknowns on which a spring or a contact depends, at most, and ranges of blocks that they make.
WIDEST, RANGES = 60, 4


@recorded
class Patches(NamedTuple):
    """Rows b_j, z_j and products b_i . z_j of all contacts, then of springs that differ from the matrix."""

    contacts: Any  # ContactBatch
    springs: Any  # SpringBatch
    entry: IntArray  # (MOST, WIDEST) unknowns of b_j
    value: FloatArray  # (MOST, WIDEST)
    width: IntArray  # (MOST,) their number
    back: FloatArray  # (MOST, size) z_j, zero but in these ranges of blocks:
    low: IntArray  # (MOST, RANGES)
    high: IntArray  # (MOST, RANGES)
    ranges: IntArray  # (MOST,) their number
    gram: FloatArray  # (MOST, MOST)
    spring: IntArray  # (MOST,) which spring, of rows behind those of the contacts
    used: IntArray  # (2,) rows in use, and the age of those of the contacts in steps
    active: IntArray  # (MOST,) workspace
    small: FloatArray  # (MOST, MOST + 1) workspace
    met: FloatArray  # (MOST, 2, 6 t) R z_j and S^-1 R z_j, with t rows of sliding joints
    total: FloatArray  # (6 t,) workspace
    slots: IntArray  # (WIDEST,) workspace
    spread: int  # see ancf.linalg.reach


def room_for_patches(system: System) -> tuple[Patches, ...]:
    """Room for the contacts and slack springs of a system, one item; none if it has none."""
    springs, contacts = system.springs, system.parts.get("contacts", no_contacts())
    size, touching = system.size, len(contacts.slot)
    most = touching + min(MOST, int(np.count_nonzero(springs.data[:, 3])))
    if most == 0:
        return ()
    rows = len(system.core.joints.border.number)
    room = Patches(
        contacts,
        springs,
        np.zeros((most, WIDEST), dtype=np.int64),
        np.zeros((most, WIDEST)),
        np.zeros(most, dtype=np.int64),
        np.zeros((most, size)),
        np.zeros((most, RANGES), dtype=np.int64),
        np.zeros((most, RANGES), dtype=np.int64),
        np.zeros(most, dtype=np.int64),
        np.zeros((most, most)),
        np.zeros(most, dtype=np.int64),
        np.array([touching, KEPT], dtype=np.int64),
        np.zeros(most, dtype=np.int64),
        np.zeros((most, most + 1)),
        np.zeros((most, 2, 6 * rows)),
        np.zeros(6 * rows),
        np.zeros(WIDEST, dtype=np.int64),
        spread_of(system.core.factor, system.core.joints.first),
    )
    return (room,)


def _forget(patches):
    p = patches[0]
    p.used[0], p.used[1] = p.contacts.slot.shape[0], KEPT


def _move_on(patches):
    patches[0].used[1] += 1


@inline_kernel
def times(p, k, x):
    """b_k . x."""
    total = 0.0
    for i in range(p.width[k]):
        total += p.value[k, i] * x[p.entry[k, i]]
    return total


@inline_kernel
def empty(p, k, n):
    """Set row k of Z to zero."""
    for m in range(p.ranges[k]):
        clear(p.back[k], p.low[k, m], p.high[k, m])
    for i in range(n, p.back.shape[1]):
        p.back[k, i] = 0.0
    p.ranges[k] = p.width[k] = 0


@inline_kernel
def add_slots(core, p, listed, count):
    """Add slots to those that are there, in ascending order, each once; the number of all."""
    supports = core.supports
    for m in range(listed.shape[0]):
        slot = listed[m]
        for k in range(supports.rot_slot.shape[0]):
            if supports.rot_shadow[k] == slot:
                slot = supports.rot_slot[k]
        i = count
        while i > 0 and p.slots[i - 1] > slot:
            i -= 1
        if slot < 0 or (i > 0 and p.slots[i - 1] == slot):
            continue
        for j in range(count, i, -1):
            p.slots[j] = p.slots[j - 1]
        p.slots[i] = slot
        count += 1
    return count


@inline_kernel
def fill(core, factor, p, k, count):
    """Row k of B, of Z and of the products; z_k holds b_k in physical components, in so many slots.

    What is held takes no part: the rows of the matrix there are those of the identity.
    """
    z, w, ranges = p.back[k], 0, 0
    to_local(core.supports, z)
    for m in range(core.supports.held.shape[0]):
        z[core.supports.held[m]] = 0.0
    for m in range(count):
        block = p.slots[m] // 6
        for i in range(p.slots[m], p.slots[m] + 3):
            if z[i] != 0.0:
                p.entry[k, w], p.value[k, w] = i, z[i]
                w += 1
        if ranges > 0 and (block <= p.high[k, ranges - 1] + p.spread or ranges == RANGES):
            p.high[k, ranges - 1] = block + 1
        else:
            p.low[k, ranges], p.high[k, ranges] = block, block + 1
            ranges += 1
    p.width[k] = w
    p.ranges[k] = solve_near(factor, core.joints.first, z, p.low[k], p.high[k], ranges, p.spread)
    for j in range(p.used[0]):
        p.gram[j, k] = times(p, j, z)
        p.gram[k, j] = p.gram[j, k]


@inline_kernel
def renew_contacts(core, factor, p, q, v, n):
    """Rows of the contacts in the state q, v."""
    for j in range(p.contacts.slot.shape[0]):
        empty(p, j, n)
        pushes, e, xi, m, _ = touch(p.contacts, j, q, v)
        if pushes:
            add_row(p.contacts, j, e, xi, m, 1.0, p.back[j])
            count = add_slots(core, p, p.contacts.slot[j], 0)
            fill(core, factor, p, j, add_slots(core, p, p.contacts.line_slot[e], count))
        p.spring[j] = pushes
    p.used[1] = 0


@inline_kernel
def place_of(core, p, e, q, n):
    """Row of spring e, which is made if it is not there; -1 if there is no room."""
    for k in range(p.contacts.slot.shape[0], p.used[0]):
        if p.spring[k] == e:
            return k
    k = p.used[0]
    if k == p.back.shape[0]:
        return -1
    empty(p, k, n)
    spring_gradient(p.springs, e, q, p.back[k])
    p.spring[k], p.used[0] = e, k + 1
    fill(core, core.factor, p, k, add_slots(core, p, p.springs.base[e], 0))
    return k


@inline_kernel
def changed(core, p, q, v, gb, n):
    """Rows that differ from the matrix in ``active``, 1/c on the diagonal of ``small``; their number."""
    m = 0
    for j in range(p.contacts.slot.shape[0]):
        closed = p.spring[j] == 0 and p.contacts.found[j, FORCE] > 0.0
        if p.used[1] >= KEPT or (closed and p.used[1] > 0):
            renew_contacts(core, core.factor, p, q, v, n)
    for j in range(p.contacts.slot.shape[0]):
        if p.spring[j] != 0 and p.contacts.found[j, FORCE] > 0.0:
            p.active[m] = j
            p.small[m, m] = 1.0 / (p.contacts.data[j, STIFFNESS] + gb * p.contacts.data[j, DAMPING])
            m += 1
    for e in range(p.springs.data.shape[0]):
        if p.springs.data[e, 3] == 0.0:
            continue
        _, _, _, _, carries = spring_state(p.springs, e, q, v)
        if carries == (p.springs.inside[e] != 0) or m == p.back.shape[0]:
            continue
        k = place_of(core, p, e, q, n)
        if k < 0:
            continue
        c = p.springs.data[e, 0] + gb * p.springs.data[e, 1]
        p.active[m] = k
        p.small[m, m] = 1.0 / (c if carries else -c)
        m += 1
    return m


@inline_kernel
def eliminate(A, m):
    """Solve the m equations A[:, :m] y = A[:, m] with pivoting; y replaces the column m."""
    for k in range(m):
        pivot = k
        for i in range(k + 1, m):
            if abs(A[i, k]) > abs(A[pivot, k]):
                pivot = i
        for j in range(k, m + 1):
            A[k, j], A[pivot, j] = A[pivot, j], A[k, j]
        for i in range(k + 1, m):
            f = A[i, k] / A[k, k]
            for j in range(k + 1, m + 1):
                A[i, j] -= f * A[k, j]
    for k in range(m - 1, -1, -1):
        for j in range(k + 1, m):
            A[k, m] -= A[k, j] * A[j, m]
        A[k, m] /= A[k, k]


@inline_kernel
def meet_border(border, p, m):
    """What the active rows do to the rows of the sliding joints, and these to their products."""
    for i in range(m):
        across(border, p.back[p.active[i]], p.met[i, 0])
        for c in range(p.total.shape[0]):
            p.met[i, 1, c] = p.met[i, 0, c]
        solve_small(border, p.met[i, 1])
    for i in range(m):
        for j in range(m):
            for c in range(p.total.shape[0]):
                p.small[i, j] += p.met[i, 0, c] * p.met[j, 1, c]


@inline_kernel
def correct_border(border, p, m, n, x):
    """The part of the correction that comes through the sliding joints; they stand behind n unknowns."""
    for c in range(p.total.shape[0]):
        p.total[c] = 0.0
        for j in range(m):
            p.total[c] += p.small[j, m] * p.met[j, 1, c]
        x[n + c] += p.total[c]
    spread(border, p.total, x)


@inline_kernel
def fill_small(p, m):
    """Add the products of the active rows to what ``small`` has of them, on its diagonal."""
    for i in range(m):
        for j in range(m):
            g = p.gram[p.active[i], p.active[j]]
            p.small[i, j] = g + p.small[i, i] if i == j else g


@inline_kernel
def take_out(p, m, x):
    """Correct x by the active rows; ``small`` is used up, and holds their shares in its column m."""
    for i in range(m):
        p.small[i, m] = times(p, p.active[i], x)
    eliminate(p.small, m)
    for j in range(m):
        k, y = p.active[j], p.small[j, m]
        z = p.back[k]
        for piece in range(p.ranges[k]):
            for i in range(6 * p.low[k, piece], 6 * p.high[k, piece]):
                x[i] -= y * z[i]


def _correct(patches, core, q, v, gb, x):
    p, n, border = patches[0], 6 * core.joints.first, core.joints.border
    m = changed(core, p, q, v, gb, n)
    if m == 0:
        return
    fill_small(p, m)
    if has_rows(core.joints):
        meet_border(border, p, m)
    take_out(p, m, x)
    if has_rows(core.joints):
        correct_border(border, p, m, n, x)


#: The matrix is new.
forget = optional(_forget)
#: A new step begins.
move_on = optional(_move_on)
#: ``correct(patches, core, q, v, gb, x)``: the solution x of the factorised matrix, corrected.
correct = optional(_correct)


@separate_kernel
def correct_rows(core, s, gb):
    """Correct the solution s.r of a model with patches; see :func:`correct`."""
    correct(s.patches, core, s.q, s.v, gb, s.r)


_correct_rows = caller(types.none)


@formula
def corrected(place, core, s, gb):
    """Call :func:`correct_rows` by its address, which is 0 without patches."""
    if place != 0:
        _correct_rows(place, (core, s, gb))
