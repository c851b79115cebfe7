"""Steps of the parts of a line that sleep, see :mod:`ancf.system.far`.

With their modes y, the boundary's displacements x and the masses P between them, a part that sleeps obeys

    y'' + loss y' + w^2 y + P (x'' + drag x') = 0,
    residual on x = f + M x'' + C x' + K x + P^T (y'' + drag y'),

which is linear: of each step the modes are eliminated.  From predictions y~, v~ without acceleration and with
the weights D = 1/B + (G/B) loss + w^2 and W = 1/B + (G/B) drag, the boundary feels

    f + (M - P^T W/D P) x'' + (C - P^T W/D drag P) x' + K x + P^T (drag v~ - W/D (loss v~ + w^2 y~)),

whose last term is known before the step.  So a step evaluates this at the prediction of x once, corrects it
by its derivative S while Newton's method moves the boundary, and then the modes follow.
"""

from __future__ import annotations

from ...compiled import inline_kernel, separate_kernel
from ...connections.carrier import slider
from ...connections.spring_damper import spring_state
from ...simd import LANES, every, load, store
from ...system.far import (
    ACROSS,
    ASLEEP,
    AWAY,
    BAR,
    BORDER,
    CALM,
    CALMED,
    COLUMN,
    COUPLING,
    DROPPERS,
    DUE,
    EDGE,
    EDGES,
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
    RATE,
    ROWS,
    SECOND,
    SIGHT,
    SLEEPING,
    STEP,
    TO_SLEEP,
    TO_WAKE,
    WATCHED,
)
from ..status import STEPS

# rows of the workspace: displacements, rates and accelerations of a boundary, and what is seen
X, V, A, SEEN = range(4)
#: Steps between two looks at the parts: in 4 ms a strip runs 0.3 m.
LOOKED = 4


@inline_kernel
def tune(far, h, gb, ib):
    """Matrices of all kinds for a step of the length h."""
    for t in range(far.kind.shape[0]):
        n, begin, o = far.kind[t, EDGES], far.kind[t, MODES], far.kind[t, COLUMN]
        last = o + n * far.kind[t, HIGH]
        for i in range(o, last):
            store(load(far.mass, i), far.felt_mass, i)
            store(load(far.damping, i), far.felt_damping, i)
        for k in range(begin, begin + far.kind[t, ROWS]):
            loss, drag, square = load(far.loss, k), load(far.drag, k), load(far.square, k)
            inverse = 1.0 / (every(ib) + gb * loss + square)
            share = (every(ib) + gb * drag) * inverse
            store(inverse, far.inverse, k)
            store(0.0 - share * square, far.by_place, k)
            store(drag - share * loss, far.by_rate, k)
            store(share, far.state, FELT, 0)
            for m in range(LANES):
                condense(far, t, LANES * (k - begin) + m, far.state[FELT, 0, m], far.drag[k, m])
        for i in range(o, last):
            felt = ib * load(far.felt_mass, i) + gb * load(far.felt_damping, i)
            store(felt + load(far.stiffness, i), far.matrix, i)
    far.memo[STEP] = h


@inline_kernel
def condense(far, t, m, share, drag):
    """Take from the boundary's mass and damping what mode m of a kind follows within a step."""
    n, o, high = far.kind[t, EDGES], far.kind[t, COLUMN], far.kind[t, HIGH]
    row = far.kind[t, ACROSS] + high * m
    for i in range(n):
        part = share * far.across[row + i // LANES, i % LANES]
        for j in range(high):
            c, place = load(far.across, row + j) * part, o + high * i + j
            store(load(far.felt_mass, place) - c, far.felt_mass, place)
            store(load(far.felt_damping, place) - c * drag, far.felt_damping, place)


@inline_kernel
def see_edge(far, p, s):
    """Displacements, rates and accelerations of the boundary of a part, in the workspace."""
    first = far.part[p, EDGE]
    for i in range(far.kind[far.part[p, KIND], EDGES]):
        u = far.edge[first + i]
        far.room[X, i] = s.q[u] - far.still[first + i]
        far.room[V, i], far.room[A, i] = s.v[u], s.a[u]


@inline_kernel
def foresee(far, p, scheme, h):
    """Predictions of the modes with no acceleration at the end of the step, and what is felt of them."""
    am, af, be, ga = scheme.alpha_m, scheme.alpha_f, scheme.beta, scheme.gamma
    hh, begin = h * h, far.kind[far.part[p, KIND], MODES]
    for k in range(far.kind[far.part[p, KIND], ROWS]):
        row, m = far.part[p, PLACE] + k, begin + k
        y, v = load(far.state, POSITION, row), load(far.state, RATE, row)
        a, bar = load(far.state, SECOND, row), load(far.state, BAR, row)
        coming = (af / (1.0 - am)) * a - (am / (1.0 - am)) * bar
        y = y + h * v + hh * ((0.5 - be) * bar + be * coming)
        v = v + h * ((1.0 - ga) * bar + ga * coming)
        store(y, far.state, GUESS, row)
        store(v, far.state, GUESS_RATE, row)
        store(load(far.by_place, m) * y + load(far.by_rate, m) * v, far.state, FELT, row)


@inline_kernel
def push_edge(far, p):
    """What a part does to its boundary at the prediction, in ``push``."""
    t, place, border = far.part[p, KIND], far.part[p, PLACE], far.part[p, BORDER]
    n, o, high, a = far.kind[t, EDGES], far.kind[t, COLUMN], far.kind[t, HIGH], far.kind[t, ACROSS]
    felt, room = far.state[FELT], far.room
    for j in range(high):
        s0, s1, s2, s3 = load(far.force, border + j), every(0.0), every(0.0), every(0.0)
        for k in range(far.kind[t, ROWS]):
            z, row = place + k, a + high * LANES * k + j
            for m in range(0, LANES, 4):  # four sums, which do not wait for each other
                s0 = s0 + load(far.across, row + high * m) * felt[z, m]
                s1 = s1 + load(far.across, row + high * (m + 1)) * felt[z, m + 1]
                s2 = s2 + load(far.across, row + high * (m + 2)) * felt[z, m + 2]
                s3 = s3 + load(far.across, row + high * (m + 3)) * felt[z, m + 3]
        for i in range(n):
            row = o + high * i + j
            s0 = s0 + load(far.felt_mass, row) * room[A, i]
            s1 = s1 + load(far.felt_damping, row) * room[V, i]
            s2 = s2 + load(far.stiffness, row) * room[X, i]
        store((s0 + s1) + (s2 + s3), far.push, border + j)


@separate_kernel
def begin_far(core, s, h, scheme, gb, ib):
    """What the parts that sleep do to their boundaries at the prediction."""
    far = core.far[0]
    if far.counts[SLEEPING] == 0:
        return
    if far.memo[STEP] != h:
        tune(far, h, gb, ib)
    for p in range(far.part.shape[0]):
        if far.part[p, ASLEEP] == 0:
            continue
        first = far.part[p, EDGE]
        for i in range(first, first + far.kind[far.part[p, KIND], EDGES]):
            far.guess[i] = s.q[far.edge[i]]
        see_edge(far, p, s)
        foresee(far, p, scheme, h)
        push_edge(far, p)


@inline_kernel
def follow_modes(far, p, scheme, gb, ib):
    """The modes of a part at the end of the step, where its boundary has come to."""
    am, af = scheme.alpha_m, scheme.alpha_f
    c1, c2, c3 = (1.0 - af) / (1.0 - am), af / (1.0 - am), -am / (1.0 - am)
    t, room = far.part[p, KIND], far.room
    n, begin, o = far.kind[t, EDGES], far.kind[t, MODES], far.kind[t, COUPLING]
    n += n % 2
    for k in range(far.kind[t, ROWS]):
        m, row, c = begin + k, far.part[p, PLACE] + k, o + n * k
        a0, a1, v0, v1 = every(0.0), every(0.0), every(0.0), every(0.0)
        for i in range(0, n, 2):
            even, odd = load(far.coupling, c + i), load(far.coupling, c + i + 1)
            a0, a1 = a0 + even * room[A, i], a1 + odd * room[A, i + 1]
            v0, v1 = v0 + even * room[V, i], v1 + odd * room[V, i + 1]
        y, v = load(far.state, GUESS, row), load(far.state, GUESS_RATE, row)
        rest = load(far.loss, m) * v + load(far.square, m) * y + (a0 + a1) + load(far.drag, m) * (v0 + v1)
        x = load(far.inverse, m) * rest
        a = -ib * x
        bar = c1 * a + c2 * load(far.state, SECOND, row) + c3 * load(far.state, BAR, row)
        store(y - x, far.state, POSITION, row)
        store(v - gb * x, far.state, RATE, row)
        store(a, far.state, SECOND, row)
        store(bar, far.state, BAR, row)


@inline_kernel
def show(far, p, s, first, last):
    """Positions and velocities of some of the unknowns inside a part that sleeps, by rows of eight.

    Those of its boundary are in the workspace.
    """
    t, place, inner = far.part[p, KIND], far.part[p, PLACE], far.part[p, INNER]
    n, rows, room = far.kind[t, EDGES], far.kind[t, ROWS], far.room
    n += n % 2
    position, rate = far.state[POSITION], far.state[RATE]
    for w in range(first, last, LANES):
        o = far.kind[t, SIGHT] + (n + LANES * rows) * (w // LANES)
        q0, q1, v0, v1 = every(0.0), every(0.0), every(0.0), every(0.0)
        for i in range(0, n, 2):
            even, odd = load(far.sight, o + i), load(far.sight, o + i + 1)
            q0, q1 = q0 + even * room[X, i], q1 + odd * room[X, i + 1]
            v0, v1 = v0 + even * room[V, i], v1 + odd * room[V, i + 1]
        for k in range(rows):
            z, c = place + k, o + n + LANES * k
            for m in range(0, LANES, 2):
                even, odd = load(far.sight, c + m), load(far.sight, c + m + 1)
                q0, q1 = q0 + even * position[z, m], q1 + odd * position[z, m + 1]
                v0, v1 = v0 + even * rate[z, m], v1 + odd * rate[z, m + 1]
        store(q0 + q1, room[A], 0)
        store(v0 + v1, room[SEEN], 0)
        for m in range(min(LANES, last - w)):
            i = inner + w + m
            s.q[far.inner[i]] = far.rest[i] + room[A, m]
            s.v[far.inner[i]] = room[SEEN, m]


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
            see_edge(far, p, s)
            show(far, p, s, 0, far.kind[t, INSIDE])
        else:
            for i in range(inner + far.kind[t, WATCHED], inner + far.kind[t, INSIDE]):
                s.q[far.inner[i]], s.v[far.inner[i]] = far.rest[i], 0.0


@inline_kernel
def turns(far, known, s):
    """Whether a part has to wake, or may sleep, which is looked at every so many steps.

    The step after one in which parts turn makes a matrix: the two never have to be done in one.
    """
    if s.counts[STEPS] % LOOKED != 0:
        return False
    found = False
    for p in range(far.part.shape[0]):
        asleep, d = far.part[p, ASLEEP] != 0, distance(far, p, known.contacts, s.q)
        taut, due = is_taut(far, p, known.springs, s), 0
        far.part[p, CALM] = far.part[p, CALM] + 1 if taut else 0
        if asleep:
            due = TO_WAKE if d < far.memo[NEAR] or not taut else 0
        elif d > far.memo[AWAY] and far.part[p, CALM] >= far.memo[CALMED]:
            due = TO_SLEEP
        far.part[p, DUE] = due
        found = found or due != 0
    return found


@separate_kernel
def end_far(core, s, scheme, gb, ib):
    """Modes at the end of the step, and what is watched; whether a part has to wake, or may sleep."""
    far = core.far[0]
    for p in range(far.part.shape[0]):
        if far.part[p, ASLEEP] != 0:
            see_edge(far, p, s)
            follow_modes(far, p, scheme, gb, ib)
            show(far, p, s, 0, far.kind[far.part[p, KIND], WATCHED])
    return turns(far, s.patches[0], s)
