"""Sensitivities by eight parameters abreast: one in each lane of every unknown.

See :mod:`ancf.solvers.derivatives.sensitivity` for the equations.  All parameters of a step share its
matrices, whose numbers are read once for eight of them.
"""

from __future__ import annotations

import numpy as np

from ...batches import BESIDE
from ...compiled import formula, inline_kernel, kernel
from ...linalg.lanes import multiply_abreast, multiply_twisted_abreast, rows_of, solve_abreast
from ...simd import LANES, every, load, store
from ...system.core import drive
from ..rare import add_slopes_along, add_slopes_beside_all
from ..status import OK, SINGULAR, SLOW
from ..step.scheme import coefficients
from .abreast_room import add_push, follow_abreast, kept, predicted, sizes_of, turn_abreast
from .ahead import look_ahead
from .edge import corrected_at_edge, edge_anew, multiply_stiffness, solve_rows, to_shadows_abreast
from .foreseen import foresee
from .friction import add_remembered, bring, remember_changes, remember_group
from .lacking import columns_anew, to_local_abreast
from .mixing_abreast import X, mixed, taken
from .sensitivity import DIFFERENCED, ENOUGH, MOST, add_lossy, both_along, is_done

#: The correction after which those that do not shrink may be round-off, and how small they are then.
LATE, SILENT = 7, 1e-12


@formula
def see(core, x, room):
    """Keep x as the matrices take it, the values of shadows at the unknowns where they have their rows."""
    supports = core.supports
    if supports.rot_slot.shape[0] == 0:
        return
    for i in range(x.shape[0]):
        store(load(x, i), room.seen, i)
    for k in range(supports.rot_slot.shape[0]):
        for c in range(3):
            store(load(x, supports.rot_shadow[k] + c), room.seen, supports.rot_slot[k] + c)


@formula
def add_product(core, values, x, room):
    """Add a matrix times x to r, the rows of shadows where the matrix has them."""
    see(core, x, room)
    own = room.seen if core.supports.rot_slot.shape[0] > 0 else x
    multiply_abreast(core.factor, values, own, room.r, core.joints.first)


@formula
def products(core, m, K, C, W, moves, room):
    """r = M s_a + C s_v + K s_q of the exact batches; ``moves``: s_a is not zero."""
    d, r, supports = room.d, room.r, core.supports
    for i in range(r.shape[0]):
        store(every(0.0), r, i)
    see(core, d[0], room)
    multiply_stiffness(core, (K, C, W), room.seen if supports.rot_slot.shape[0] > 0 else d[0], room)
    if moves:
        add_product(core, m.M, d[2], room)
    if m.damped:
        add_product(core, C, d[1], room)
    to_shadows_abreast(supports, r)


@inline_kernel
def lane_of(room, lane, d):
    """The sensitivity in a lane as vectors (3, size)."""
    for k in range(3):
        for i in range(d.shape[1]):
            d[k, i] = room.d[k, i, lane]


@inline_kernel
def add_others(core, m, x, room, lane):
    """Add what the batches that are not exact do to r, of one lane."""
    r, d = m.work[0], m.work[1:4]
    lane_of(room, lane, d)
    for i in range(r.shape[0]):
        r[i] = 0.0
    if m.lossy.table.shape[0] > 0:
        add_lossy(core, m, x, d, r)
    if m.rough.table.shape[0] > 0:
        both_along(m.rough, core, m, x, d, r)
    for i in range(r.shape[0]):
        room.r[i, lane] += r[i]


@inline_kernel
def out_of_balance(core, m, matrices, x, turn, push, friction, n, first, moves, room):
    """r = M s_a + C s_v + K s_q + R_p as the solve wants it, of step n and parameters from ``first`` on."""
    r, count = room.r, min(LANES, push.shape[0] - first)
    follow_abreast(core.supports, room.d)
    turn_abreast(core.supports, turn, x, room.d)
    products(core, m, matrices[0], matrices[1], matrices[2], moves, room)
    if m.lossy.table.shape[0] > 0 or m.rough.table.shape[0] > 0:
        for k in range(count):
            if room.open[k] > 0.0:
                add_others(core, m, x, room, k)
    add_slopes_along(m.joined, x[0], x[1], x[2], room.d, r, core.ws)
    add_remembered(friction, first // LANES, x[0], x[1], r, core.ws)
    to_local_abreast(core.supports, r)
    add_push(room, push, n, first, count)
    for k in range(core.supports.held.shape[0]):
        store(every(0.0), r, core.supports.held[k])


@inline_kernel
def shifted(core, m, factor, x, gap, n, first, joined, room):
    """Shift s_q of the open lanes onto the derivative of C = 0; their ``shift`` is the size of that."""
    joints, r, d, count = core.joints, room.r, room.d, min(LANES, gap.shape[0] - first)
    follow_abreast(core.supports, d)
    for i in range(r.shape[0]):
        store(every(0.0), r, i)
    joints.level[0], joints.level[1], joints.level[2] = 1.0, 0.0, 0.0
    add_slopes_along(m.joined, x[0], x[1], x[2], d, r, core.ws)
    joints.level[0], joints.level[1], joints.level[2] = joined.w0, joined.w1, joined.w2
    for i in range(core.weight.shape[0]):
        if joints.mask[i] == 0.0:
            store(every(0.0), r, i)
    for k in range(joints.multipliers.shape[0]):
        i = joints.multipliers[k]
        for lane in range(count):
            r[i, lane] = room.open[lane] * (r[i, lane] + gap[first + lane, n, i])
    solve_abreast(factor, r)
    for k in range(joints.multipliers.shape[0]):
        store(every(0.0), r, joints.multipliers[k])
    sizes_of(r, core.weight, room.shift)
    for i in range(core.weight.shape[0]):
        store(load(d, 0, i) - load(r, i), d, 0, i)


@formula
def correct(core, room, B, G):
    """Subtract the corrections in r; multipliers have no rates."""
    d, multipliers = room.d, core.joints.multipliers
    for i in range(core.weight.shape[0]):
        c = load(room.r, i)
        store(load(d, 0, i) - c, d, 0, i)
        store(load(d, 1, i) - (G / B) * c, d, 1, i)
        store(load(d, 2, i) - (1.0 / B) * c, d, 2, i)
    for k in range(multipliers.shape[0]):
        store(every(0.0), d, 1, multipliers[k])
        store(every(0.0), d, 2, multipliers[k])


@inline_kernel
def out_again(core, m, W, x, room, B, G):
    """r = what is out of balance after the corrections in r: what these do that is not in the factors."""
    r, seen, supports = room.r, room.seen, core.supports
    for i in range(r.shape[0]):
        store(load(r, i), seen, i)
        store(every(0.0), r, i)
    for k in range(supports.rot_slot.shape[0]):
        i, j, R = supports.rot_slot[k], supports.rot_shadow[k], supports.rot_R[k, 0]
        x0, x1, x2 = load(seen, i), load(seen, i + 1), load(seen, i + 2)
        for c in range(3):
            y = R[c, 0] * x0 + R[c, 1] * x1 + R[c, 2] * x2
            store(y, seen, i + c)
            store(y, seen, j + c)
    if W.shape[0] > 0:
        multiply_twisted_abreast(core.factor, W, seen, r, core.joints.first)
    for k in range(supports.rot_slot.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            store(load(r, i + c), r, j + c)
    if m.joined.table.shape[0] > 0:
        add_beside(core, m, x, seen, r, B, G)
    to_local_abreast(supports, r)
    turned_back(core, r)


@inline_kernel
def add_beside(core, m, x, change, r, B, G):
    """Add what tangents leave out of what a change of s_q, with the rates of a step, does."""
    d = m.along
    for i in range(r.shape[0]):
        c = load(change, i)
        store(c, d, 0, i)
        store((G / B) * c, d, 1, i)
        store((1.0 / B) * c, d, 2, i)
    add_slopes_beside_all(m.joined, x[0], x[1], x[2], d, r, core.ws)


@inline_kernel
def all_beside(core, m):
    """Whether forces that know their slopes know all that tangents leave out, without multipliers."""
    known = core.joints.multipliers.shape[0] == 0
    for k in range(m.joined.table.shape[0]):
        known = known and m.joined.table[k, BESIDE] != 0
    return known


@formula
def turned_back(core, r):
    """Change the sign of r; zero at held unknowns."""
    supports = core.supports
    for i in range(core.weight.shape[0]):
        store(-1.0 * load(r, i), r, i)
    for k in range(supports.held.shape[0]):
        store(every(0.0), r, supports.held[k])


@inline_kernel
def not_done(room, weight, count, enough, mixes):
    """Number of lanes whose corrections, of sizes ``norm``, go on; these stay open.

    ``mixes``: some that do not shrink, before the last of a few that are mixed, are no round-off yet.
    """
    left = 0
    sizes_of(room.d[0], weight, room.size)
    for k in range(count):
        if room.open[k] > 0.0:
            norm = max(room.norm[k], room.shift[k])
            early = mixes and norm > SILENT * room.size[k]
            if not early and is_done(norm, room.size[k], room.before[k], enough):
                room.open[k] = 0.0
            else:
                room.before[k] = norm
                left += 1
    return left


@inline_kernel
def not_silent(core, m, factor, push, n, first, count, room):
    """Number of lanes whose corrections are more than the round-off of forces that cancel; these stay open.

    What parameters do may be borne by joints alone, and a sensitivity is round-off then: its corrections are
    compared with what the same forces do where nothing bears them.
    """
    r, multipliers, left = room.r, core.joints.multipliers, 0
    for i in range(r.shape[0]):
        for k in range(LANES):
            r[i, k] = (1.0 if i % 2 == 0 else -1.0) * push[first + min(k, count - 1), n, i]
    for k in range(multipliers.shape[0]):
        store(every(0.0), r, multipliers[k])
    for k in range(core.supports.held.shape[0]):
        store(every(0.0), r, core.supports.held[k])
    solve_rows(m, factor, room)
    sizes_of(r, core.weight, room.size)
    for k in range(count):
        if room.open[k] > 0.0 and max(room.norm[k], room.shift[k]) <= SILENT * room.size[k]:
            room.open[k] = 0.0
        left += 1 if room.open[k] > 0.0 else 0
    return left


@inline_kernel
def solved(
    core, m, factor, matrices, left, x, turn, push, gap, friction, n, first, joined, at_once, edge, room, B, G
):
    """Corrections of predicted sensitivities, perhaps ``at_once``; a status.

    ``left``: what of W is not in the factors.
    """
    joints, count = core.joints, min(LANES, push.shape[0] - first)
    rough = m.rough.table.shape[0] > 0
    jointed = m.joined.table.shape[0] > 0
    known = m.lossy.table.shape[0] == 0 and not m.turning and not rough
    known = known and (not jointed or all_beside(core, m))
    projects = joined.projects and joints.multipliers.shape[0] > 0
    enough = DIFFERENCED if rough else ENOUGH
    again = left.shape[0] > 0 or jointed
    foresees = m.outside and known and not projects
    mixes = room.mix.shape[0] > 0 and not foresees
    for k in range(LANES):
        room.before[k], room.open[k], room.shift[k] = np.inf, 1.0 if k < count else 0.0, 0.0
    for round in range(MOST):
        if mixes:
            taken(core.weight.shape[0], room.d, room.mix, X)
        if round > 0 and known and not projects:
            out_again(core, m, left, x, room, B, G)
        else:
            moves = not at_once or turn.shape[0] > 0
            out_of_balance(core, m, matrices, x, turn, push, friction, n, first, moves, room)
        if at_once and jointed:
            corrected_at_edge(core, m, factor, x, gap, n, first, count, joined, edge, room, G / B, 1.0 / B)
            return OK
        solve_rows(m, factor, room)
        if foresees:
            foresee(room, core.weight, round)
        correct(core, room, B, G)
        if at_once:
            return OK
        sizes_of(room.r, core.weight, room.norm)
        if projects:
            shifted(core, m, factor, x, gap, n, first, joined, room)
        if not_done(room, core.weight, count, enough, mixes and round < LATE) == 0 or (known and not again):
            return OK
        if round == LATE and not known and not_silent(core, m, factor, push, n, first, count, room) == 0:
            return OK
        if mixes:
            mixed(core, room, B, G, round)
    return SLOW


@inline_kernel
def takes_one(m, edge, left):
    """Whether one correction is all: what the factors of a step lack of its matrix is known, or nothing."""
    whole = left.shape[0] == 0 and m.lossy.table.shape[0] == 0 and m.rough.table.shape[0] == 0
    return whole and not m.turning and (m.joined.table.shape[0] == 0 or edge.c.shape[1] > 0)


@kernel
def follow_steps(core, m, ahead, room, edge, tables, way, push, gap, turn, h, scheme, joined, s, out, place):
    """Carry sensitivities through the steps of a block.

    Parameters
    ----------
    core, m, ahead, room, edge : Core, Matrices, Ahead, Abreast, Edge
        With what friction remembers in the steps; derivatives of that at the start are changed to the end's.
    tables : Tables
        At the ends of the steps.
    way : Way
    push, gap : (p, steps, size)
        Derivatives of the residual and of the constraints' positions, at fixed free unknowns.
    turn : (p/8 rounded up, k, 3, 3, 8)
        Derivatives of the local axes of supports, or k = 0: they do not turn with a parameter.
    h, scheme, joined : float, Scheme, Constraining
    s : (p/8 rounded up, 4, size, 8)
        At the start; changed to the end.
    out : (p, rows, 1, 2 or 3, size)
        s_v, or s_q, s_v and s_a, at the ends of the steps, in the rows from ``place`` on.
    place : int

    Returns
    -------
    Steps done and the status of the last one.
    """
    B, G = coefficients(h, scheme)
    friction, plain = ahead.friction, m.joined.table.shape[0] == 0
    level = core.joints.level
    level[0], level[1], level[2] = joined.w0, joined.w1, joined.w2
    for n in range(way.q.shape[0]):
        lane = n % LANES
        if lane == 0:
            bad = look_ahead(core, m, ahead, tables, way, n, B, G, False)
            if bad >= 0:
                return n + bad, SINGULAR
        whole = ahead.whole[0] > 0.0
        factor = rows_of(core.factor, ahead.eight, lane, whole)
        matrices = (ahead.K[lane], ahead.C[lane], ahead.W[lane])
        left = ahead.W[lane, 0:0] if whole else ahead.W[lane]
        few = takes_one(m, edge, left)
        x = (way.q[n], way.v[n], way.a[n])
        drive(core.supports, core.loads.value, tables, n, x[0], x[1], x[2])
        bring(friction, n)
        few = few and (plain or columns_anew(core, m, edge.columns, x, room.r, G / B, 1.0 / B))
        if few and not plain:
            own = (joined, edge, room, G / B, 1.0 / B)
            if not edge_anew(core, m, factor, matrices, x, *own):
                return n, SINGULAR
        for g in range(s.shape[0]):
            predicted(s[g], room.d, h, scheme, 0.0 if few else 1.0)
            axes, first, own = turn[g], LANES * g, (joined, few, edge, room, B, G)
            status = solved(core, m, factor, matrices, left, x, axes, push, gap, friction, n, first, *own)
            if status != OK:
                return n, status
            follow_abreast(core.supports, room.d)
            turn_abreast(core.supports, axes, x, room.d)
            remember_group(friction, g, x[0], x[1], room.d, core.ws)
            kept(room, s[g], scheme, out, place + n, LANES * g)
        remember_changes(friction, x[0], x[1], core.ws)
    return way.q.shape[0], OK
