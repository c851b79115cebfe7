"""Steps of the parts of a line that sleep, see :mod:`ancf.system.far`.

With their modes y, the boundary's displacements x and the masses P between them, a part that sleeps obeys

    y'' + loss y' + w^2 y + P (x'' + drag x' - shift x) = 0,
    residual on x = f + M x'' + C x' + K x + P^T (y'' + drag y' - shift y),

which is linear: of each step the modes are eliminated, with D = 1/B + (G/B) loss + w^2 and the weights
W = 1/B + (G/B) drag - shift of the coupling, and

    S = M/B + (G/B) C + K - (W P)^T D^-1 (W P)

is what the boundary feels of the part.  So a step evaluates the residual at the prediction once, corrects it
by S (x - x~) while Newton's method moves the boundary, and then the modes follow.
"""

from __future__ import annotations

from ..compiled import formula, inline_kernel, optional, separate_kernel
from ..connections.sliding import slider
from ..connections.spring_damper import spring_state
from ..linalg.reach import solve_ranges
from ..simd import LANES, every, load, store, total
from ..system.core import to_local
from ..system.far import (
    ASLEEP,
    AWAY,
    BAR,
    BORDER,
    CALM,
    CALMED,
    COLUMN,
    COUPLING,
    DROPPERS,
    EDGE,
    EDGES,
    ENTRY,
    FELT,
    GUESS,
    GUESS_RATE,
    HIGH,
    HUNG,
    INNER,
    INSIDE,
    KIND,
    MODES,
    NEAR,
    PLACE,
    POSITION,
    RANGES,
    RATE,
    REST,
    ROWS,
    SECOND,
    SHIFT,
    SIGHT,
    SLEEPING,
    STEP,
    WATCHED,
    add_far,
)
from ..system.near import clear_beyond, residual_near
from .low_rank import corrected
from .near import take
from .scheme import finish_rows, note_step, predict_rows, restore_rows

# rows of the workspace: displacements, rates and accelerations of a boundary, and x'' - shift x
X, V, A, ALONG = range(4)


@inline_kernel
def tune(far, h, gb, ib):
    """Matrices of all kinds for a step of the length h."""
    for t in range(far.kind.shape[0]):
        n, o, high = far.kind[t, EDGES], far.kind[t, COUPLING], far.kind[t, HIGH]
        column = far.kind[t, COLUMN]
        for i in range(column, column + n * high):
            whole = ib * load(far.mass, i) + gb * load(far.damping, i) + load(far.stiffness, i)
            store(whole, far.matrix, i)
        for k in range(far.kind[t, ROWS]):
            m = far.kind[t, MODES] + k
            weight = every(ib - far.memo[SHIFT]) + gb * load(far.drag, m)
            inverse = 1.0 / (every(ib) + gb * load(far.loss, m) + load(far.square, m))
            store(weight, far.weight, m)
            store(inverse, far.inverse, m)
            for i in range(n):
                scaled = weight * weight * inverse * load(far.coupling, o + n * k + i)
                for j in range(n):
                    row = column + high * i + j // LANES
                    far.matrix[row, j % LANES] -= total(scaled * load(far.coupling, o + n * k + j))
    far.memo[STEP] = h


def _predict_awake(items, s, h, scheme, keep, shadows):
    far = items[0]
    if far.counts[SLEEPING] == 0:
        return False
    for k in range(far.counts[RANGES]):
        predict_rows(s, h, scheme, keep, 6 * far.range[k, 0], 6 * far.range[k, 1])
    predict_rows(s, h, scheme, keep, shadows, s.q.shape[0])
    return True


def _restore_awake(items, s, shadows):
    far = items[0]
    if far.counts[SLEEPING] == 0:
        return False
    for k in range(far.counts[RANGES]):
        restore_rows(s, 6 * far.range[k, 0], 6 * far.range[k, 1])
    restore_rows(s, shadows, s.q.shape[0])
    return True


def _finish_awake(items, s, h, scheme, shadows):
    far = items[0]
    if far.counts[SLEEPING] == 0:
        return False
    for k in range(far.counts[RANGES]):
        finish_rows(s, scheme, 6 * far.range[k, 0], 6 * far.range[k, 1])
    finish_rows(s, scheme, shadows, s.q.shape[0])
    note_step(s, h)
    return True


@inline_kernel
def edge_residual(far, p, s):
    """Residual of the boundary of a part without its modes, in ``push``; keeps the prediction."""
    t, first, border = far.part[p, KIND], far.part[p, EDGE], far.part[p, BORDER]
    n, o, high = far.kind[t, EDGES], far.kind[t, COLUMN], far.kind[t, HIGH]
    for i in range(n):
        u = far.edge[first + i]
        far.guess[first + i] = s.q[u]
        x = s.q[u] - far.still[first + i]
        far.room[X, i], far.room[V, i], far.room[A, i] = x, s.v[u], s.a[u]
        far.room[ALONG, i] = s.a[u] - far.memo[SHIFT] * x
    for k in range(high):
        sum_of = load(far.force, border + k)
        for j in range(n):
            row = o + high * j + k
            sum_of = sum_of + load(far.mass, row) * far.room[A, j] + load(far.damping, row) * far.room[V, j]
            sum_of = sum_of + load(far.stiffness, row) * far.room[X, j]
        store(sum_of, far.push, border + k)


@formula
def foresee(far, p, k, scheme, h):
    """Prediction of eight modes whose acceleration at the end of the step is zero; kept for the end."""
    am, af, be, ga = scheme.alpha_m, scheme.alpha_f, scheme.beta, scheme.gamma
    row, hh = far.part[p, PLACE] + k, h * h
    y, v = load(far.state, POSITION, row), load(far.state, RATE, row)
    a, bar = load(far.state, SECOND, row), load(far.state, BAR, row)
    coming = (af / (1.0 - am)) * a - (am / (1.0 - am)) * bar
    y = y + h * v + hh * ((0.5 - be) * bar + be * coming)
    v = v + h * ((1.0 - ga) * bar + ga * coming)
    store(y, far.state, GUESS, row)
    store(v, far.state, GUESS_RATE, row)
    return y, v


@inline_kernel
def mode_residuals(far, p, h, scheme):
    """Predict the modes of a part and their residuals, and add what they do to the boundary."""
    t, place, border = far.part[p, KIND], far.part[p, PLACE], far.part[p, BORDER]
    n, rows, begin, o = far.kind[t, EDGES], far.kind[t, ROWS], far.kind[t, MODES], far.kind[t, COUPLING]
    for k in range(rows):
        m = begin + k
        y, v = foresee(far, p, k, scheme, h)
        along, rate = every(0.0), every(0.0)
        for i in range(n):
            c = load(far.coupling, o + n * k + i)
            along = along + c * far.room[ALONG, i]
            rate = rate + c * far.room[V, i]
        drag = load(far.drag, m)
        rest = load(far.loss, m) * v + load(far.square, m) * y + along + drag * rate
        felt = drag * v - far.memo[SHIFT] * y - load(far.weight, m) * load(far.inverse, m) * rest
        store(rest, far.state, REST, place + k)
        store(felt, far.state, FELT, place + k)
    for i in range(n):
        sum_of = every(0.0)
        for k in range(rows):
            sum_of = sum_of + load(far.coupling, o + n * k + i) * load(far.state, FELT, place + k)
        far.push[border + i // LANES, i % LANES] += total(sum_of)


@separate_kernel
def begin_far(core, s, h, scheme, gb, ib):
    """Residuals of the parts that sleep at the prediction."""
    far = core.far[0]
    if far.counts[SLEEPING] == 0:
        return
    if far.memo[STEP] != h:
        tune(far, h, gb, ib)
    for p in range(far.part.shape[0]):
        if far.part[p, ASLEEP] != 0:
            edge_residual(far, p, s)
            mode_residuals(far, p, h, scheme)


@inline_kernel
def follow_modes(far, p, s, scheme, gb, ib):
    """The modes of a part at the end of the step, where its boundary has come to."""
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    t, first = far.part[p, KIND], far.part[p, EDGE]
    n, begin, o = far.kind[t, EDGES], far.kind[t, MODES], far.kind[t, COUPLING]
    for i in range(n):
        far.room[X, i] = far.guess[first + i] - s.q[far.edge[first + i]]
    for k in range(far.kind[t, ROWS]):
        m, row = begin + k, far.part[p, PLACE] + k
        moved = every(0.0)
        for i in range(n):
            moved = moved + load(far.coupling, o + n * k + i) * far.room[X, i]
        x = load(far.inverse, m) * (load(far.state, REST, row) - load(far.weight, m) * moved)
        a = -ib * x
        bar = c1 * a + c2 * load(far.state, SECOND, row) + c3 * load(far.state, BAR, row)
        store(load(far.state, GUESS, row) - x, far.state, POSITION, row)
        store(load(far.state, GUESS_RATE, row) - gb * x, far.state, RATE, row)
        store(a, far.state, SECOND, row)
        store(bar, far.state, BAR, row)


@inline_kernel
def show(far, p, s, first, last):
    """Positions and velocities of some of the unknowns inside a part that sleeps, by rows of eight."""
    t, edge, place = far.part[p, KIND], far.part[p, EDGE], far.part[p, PLACE]
    n, rows, inner = far.kind[t, EDGES], far.kind[t, ROWS], far.part[p, INNER]
    for i in range(n):
        u = far.edge[edge + i]
        far.room[X, i], far.room[V, i] = s.q[u] - far.still[edge + i], s.v[u]
    for w in range(first, last, LANES):
        o = far.kind[t, SIGHT] + (n + LANES * rows) * (w // LANES)
        q, v = every(0.0), every(0.0)
        for i in range(n):
            c = load(far.sight, o + i)
            q = q + c * far.room[X, i]
            v = v + c * far.room[V, i]
        for k in range(rows):
            for m in range(LANES):
                c = load(far.sight, o + n + LANES * k + m)
                q = q + c * far.state[POSITION, place + k, m]
                v = v + c * far.state[RATE, place + k, m]
        store(q, far.room[A], 0)
        store(v, far.room[ALONG], 0)
        for m in range(min(LANES, last - w)):
            i = inner + w + m
            s.q[far.inner[i]] = far.rest[i] + far.room[A, m]
            s.v[far.inner[i]] = far.room[ALONG, m]


@inline_kernel
def distance(far, p, contacts, q):
    """Distance of the nearest strip from a part along the track, m."""
    least = 1e300
    for j in range(contacts.slot.shape[0]):
        x = slider(contacts, j, q, 1.0)[0]
        least = min(least, max(far.place[p, 0] - x, x - far.place[p, 1], 0.0))
    return least


@inline_kernel
def is_taut(far, p, springs, s):
    """Whether all droppers of a part carry."""
    for k in range(far.part[p, HUNG], far.part[p, HUNG] + far.part[p, DROPPERS]):
        _, _, _, tension, _ = spring_state(springs, far.hung[k], s.q, s.v)
        if not tension > 0.0:
            return False
    return True


@separate_kernel
def show_far(core, s, whole):
    """Positions and velocities in the parts that sleep; or what is not watched of them stands still again."""
    far = core.far[0]
    for p in range(far.part.shape[0]):
        if far.part[p, ASLEEP] == 0:
            continue
        t, inner = far.part[p, KIND], far.part[p, INNER]
        if whole:
            show(far, p, s, 0, far.kind[t, INSIDE])
        else:
            for i in range(inner + far.kind[t, WATCHED], inner + far.kind[t, INSIDE]):
                s.q[far.inner[i]], s.v[far.inner[i]] = far.rest[i], 0.0


@inline_kernel
def turns(far, known, s):
    """Whether a part has to wake, or may sleep."""
    found = False
    for p in range(far.part.shape[0]):
        asleep, d = far.part[p, ASLEEP] != 0, distance(far, p, known.contacts, s.q)
        taut = is_taut(far, p, known.springs, s)
        far.part[p, CALM] = far.part[p, CALM] + 1 if taut else 0
        if asleep:
            found = found or d < far.memo[NEAR] or not taut
        else:
            found = found or (d > far.memo[AWAY] and far.part[p, CALM] >= far.memo[CALMED])
    return found


@separate_kernel
def end_far(core, s, scheme, gb, ib):
    """Modes at the end of the step, and what is watched; whether a part has to wake, or may sleep."""
    far = core.far[0]
    for p in range(far.part.shape[0]):
        if far.part[p, ASLEEP] != 0:
            follow_modes(far, p, s, scheme, gb, ib)
            show(far, p, s, 0, far.kind[far.part[p, KIND], WATCHED])
    return turns(far, s.patches[0], s)


def _asleep(items):
    return items[0].counts[SLEEPING] > 0


@separate_kernel
def iterate_awake(core, s, gb, ib, correct):
    """Correct what is awake; its norm. `correct` is an address, see
    :func:`ancf.solvers.low_rank.corrected`.
    """
    far, near, n = core.far[0], core.near[0], core.weight.shape[0]
    count = far.counts[RANGES]
    for k in range(count):
        near.low[k], near.high[k] = far.range[k, 0], far.range[k, 1]
    residual_near(near, count, n, core.ws, s.q, s.v, s.a, s.f, s.r)
    add_far(far, s)
    to_local(core.supports, s.r)
    clear_beyond(near, count, n // 6, s.r)
    solve_ranges(core.factor, s.r, near.low, near.high, count)
    corrected(correct, core, s, gb)
    return take(near, s, core.weight, gb, ib, count)


def _isolate(items, factor, A):
    far = items[0]
    if far.counts[SLEEPING] == 0:
        return
    n = factor.row_start.shape[0] - 1
    for b in range(n):
        if far.sleeps[b] != 0:
            for m in range(36):
                A[36 * b + m] = 1.0 if m % 7 == 0 else 0.0
        for k in range(factor.row_start[b], factor.row_start[b + 1]):
            if far.sleeps[b] != 0 or far.sleeps[factor.column[k]] != 0:
                for m in range(36):
                    A[36 * (n + k) + m] = 0.0
    for p in range(far.part.shape[0]):
        if far.part[p, ASLEEP] != 0:
            t = far.part[p, KIND]
            n = far.kind[t, EDGES]
            for i in range(n):
                for j in range(n):
                    place, row = far.entry[far.part[p, ENTRY] + n * i + j], far.kind[t, HIGH] * i + j // LANES
                    if place >= 0:
                        A[place] += far.matrix[far.kind[t, COLUMN] + row, j % LANES]


#: ``predict_awake(core.far, s, h, scheme, keep, shadows)``: predict what is awake, if something sleeps.
predict_awake = optional(_predict_awake, False)
#: ``restore_awake(core.far, s, shadows)``: it is as at the start of the step, likewise.
restore_awake = optional(_restore_awake, False)
#: ``finish_awake(core.far, s, h, scheme, shadows)``: accept the step, likewise.
finish_awake = optional(_finish_awake, False)
#: ``asleep(core.far)``: whether a part sleeps.
asleep = optional(_asleep, False)
#: ``isolate(core.far, factor, A)``: rows of what sleeps are those of the identity; boundaries feel the parts.
isolate = optional(_isolate)
