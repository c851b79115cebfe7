"""Which elements of cables are near each other: a list that is made anew when something has moved far.

The list has all pairs whose balls, with a margin, meet.  It holds until an unknown has moved by so much
that a pair which is not in it could touch.  That is looked at once in a step, and with every evaluation of
the forces where steps are long.  Elements are sorted into a grid of cubes, each as wide as the largest
ball, by a hash of its place; so the list costs time in proportion to the elements (Teschner et al. 2003).

Before that, pieces of cables are looked at, in boxes along the axes: where all that may touch each other lie
apart, or are nearly straight beside each other, the list is empty and half of the least distance may be gone.

Elements of one cable that is nearly straight between them are left out: where all tangents are within 60
degrees of one direction, places are farther apart than half of the cable between them.
"""

from __future__ import annotations

import math

import numpy as np

from ..compiled import formula, inline_kernel
from ..records import beginning
from ..vectors import dot
from .strand import StrandBatch, cubic, less, on_cubic

#: Places of ``room``: how far anything may go until the list is made again; the widest margin; whether every
#: evaluation of the forces looks; whether the list has just been made; the share of the way that the step
#: just judged has used up, -1: not known; the length of the longest element.
LEFT, WIDEST, LIVE, MADE, SEEN, LONGEST = range(6)
#: Elements of a piece of a cable, and the most pairs of pieces for each element that are looked at.
PIECE, PAIRS = 32, 16
#: Share of the way that is left after which a step makes the list again.
USED = 0.5
#: Change of a tangent with which the list is made again, and the cosine of the angle from a common direction
#: up to which tangents count as nearly parallel: together 60 degrees.
TURNED, STRAIGHT = 0.4, 0.83
#: Factors of the hash.
FACTORS = (73856093, 19349663, 83492791)


@beginning(StrandBatch)
def node_moved(batch, e, k, q, near, turned):
    """Share of what the list allows for that a node has used up; near and turned: what 1 m and 1 rad do."""
    i, j, seen = batch.base[e, k], batch.base[e, k + 1], batch.seen[e]
    x = abs(q[i] - seen[3 * k]) + abs(q[i + 1] - seen[3 * k + 1]) + abs(q[i + 2] - seen[3 * k + 2])
    y = abs(q[j] - seen[3 * k + 3]) + abs(q[j + 1] - seen[3 * k + 4]) + abs(q[j + 2] - seen[3 * k + 5])
    return x * near + y * turned


@beginning(StrandBatch)
def chord_turned(batch, e, q):
    """Share of the turning that the list allows for that the chord of an element has used up."""
    i, j, seen, way = batch.base[e, 0], batch.base[e, 2], batch.seen[e], 0.0
    for c in range(3):
        way += abs((q[j + c] - q[i + c]) - (seen[6 + c] - seen[c]))
    return way / (TURNED * batch.length[e])


@formula
def touches_itself(batch):
    """Whether some cable may."""
    own = False
    for k in range(batch.law.shape[0]):
        own = own or batch.law[k, k] >= 0
    return own


@beginning(StrandBatch)
def used_up(batch, q):
    """Share of what the list allows for that is used up; more than all without a list."""
    if batch.room[LEFT] < 0.0:
        return np.inf
    near, most = 1.0 / batch.room[LEFT], 0.0
    turned, own = max(0.4 * batch.room[LONGEST] * near, 1.0 / TURNED), touches_itself(batch)
    for e in range(batch.base.shape[0]):
        most = max(most, node_moved(batch, e, 0, q, near, turned))
        if own:
            most = max(most, chord_turned(batch, e, q))
        if batch.beside[e, 1] < 0:
            most = max(most, node_moved(batch, e, 2, q, near, turned))
    return most


@formula
def anything(batch):
    """Whether anything is near."""
    return batch.first[batch.base.shape[0]] > 0


@beginning(StrandBatch)
def keep(batch, q, into):
    """Copy the unknowns of all elements."""
    for e in range(batch.base.shape[0]):
        for k in range(4):
            for c in range(3):
                into[e, 3 * k + c] = q[batch.base[e, k] + c]


@beginning(StrandBatch)
def ball(batch, e, q):
    """Middle of an element, and the radius of a ball about it that holds its cable."""
    c = cubic(batch, e, q)
    m = on_cubic(c, 0.5)
    a, b = less(c[0], m), less(on_cubic(c, 1.0), m)
    h = math.sqrt(max(dot(a, a), dot(b, b)))
    t, u = c[1], less(on_cubic(c, 1.0), c[0])
    bent = math.sqrt(dot(less(t, u), less(t, u))) + math.sqrt(dot(c[3], c[3]))
    return m, h + 0.3 * bent + batch.radius[e]


@beginning(StrandBatch)
def bucket(batch, x, y, z):
    """Where the elements of a cube of the grid are listed."""
    mixed = (x * FACTORS[0]) ^ (y * FACTORS[1]) ^ (z * FACTORS[2])
    return mixed & (batch.head.shape[0] - 1)


@inline_kernel
def cube(m, wide):
    """Cube of the grid with a place in it."""
    return math.floor(m[0] / wide), math.floor(m[1] / wide), math.floor(m[2] / wide)


@beginning(StrandBatch)
def leads(batch, e, q, u):
    """Whether all tangents of element e are nearly along u."""
    c = cubic(batch, e, q)
    last = (
        c[1][0] + 2.0 * c[2][0] + 3.0 * c[3][0],
        c[1][1] + 2.0 * c[2][1] + 3.0 * c[3][1],
        c[1][2] + 2.0 * c[2][2] + 3.0 * c[3][2],
    )
    middle = (c[1][0] + c[2][0], c[1][1] + c[2][1], c[1][2] + c[2][2])  # the derivative is between these
    least = STRAIGHT * math.sqrt(dot(u, u))
    along = dot(c[1], u) > least * math.sqrt(dot(c[1], c[1]))
    along = along and dot(middle, u) > least * math.sqrt(dot(middle, middle))
    return along and dot(last, u) > least * math.sqrt(dot(last, last))


@beginning(StrandBatch)
def straight_to(batch, e, step, q, most):
    """The last element from e on, before (-1) or behind it (1), up to which its cable is nearly straight.

    No more than ``most`` are looked at.
    """
    c, last = cubic(batch, e, q), e
    u = less(on_cubic(c, 1.0), c[0])
    for _ in range(most):
        if not leads(batch, last, q, u):
            return e
        other = batch.beside[last, 0 if step < 0 else 1]
        if other < 0 or not leads(batch, other, q, u):
            return last
        last = other
    return last


@beginning(StrandBatch)
def may_touch(batch, a, b, before, behind, margin):
    """Whether two elements belong into the list; a's cable is straight from ``before`` to ``behind``."""
    if a == b or batch.law[batch.cable[a], batch.cable[b]] < 0:
        return False
    if batch.cable[a] == batch.cable[b] and before <= b <= behind:
        return False
    m, o = batch.middle[a], batch.middle[b]
    x, y, z, reach = m[0] - o[0], m[1] - o[1], m[2] - o[2], m[3] + o[3] + 2.0 * margin
    return x * x + y * y + z * z < reach * reach


@beginning(StrandBatch)
def sort_in(batch, start, count, b):
    """Put element b into the ascending entries of one element; their number."""
    k = count
    while k > start and batch.near[k - 1] > b:
        batch.near[k] = batch.near[k - 1]
        k -= 1
    if k > start and batch.near[k - 1] == b:  # two cubes of one bucket
        while k < count:
            batch.near[k] = batch.near[k + 1]
            k += 1
        return count
    batch.near[k] = b
    return count + 1


@beginning(StrandBatch)
def sort_into_cubes(batch, wide):
    """Lists of the elements in each bucket."""
    for k in range(batch.head.shape[0]):
        batch.head[k] = -1
    for e in range(batch.base.shape[0]):
        x, y, z = cube(batch.middle[e], wide)
        k = bucket(batch, x, y, z)
        batch.link[e] = batch.head[k]
        batch.head[k] = e


@beginning(StrandBatch)
def fill(batch, q, margin, wide):
    """Make the list with a margin; whether there is room for it."""
    n, count = batch.base.shape[0], 0
    sort_into_cubes(batch, wide)
    for e in range(n):
        batch.first[e] = count
        own = batch.law[batch.cable[e], batch.cable[e]] >= 0
        most = 1 + int(wide / batch.length[e])
        before, behind = e, e
        if own:
            before, behind = straight_to(batch, e, -1, q, most), straight_to(batch, e, 1, q, most)
        x, y, z = cube(batch.middle[e], wide)
        for around in range(27):
            b = batch.head[bucket(batch, x + around % 3 - 1, y + around // 3 % 3 - 1, z + around // 9 - 1)]
            while b >= 0:
                if may_touch(batch, e, b, before, behind, margin):
                    if count + 1 >= batch.near.shape[0]:
                        return False
                    count = sort_in(batch, batch.first[e], count, b)
                b = batch.link[b]
    batch.first[n] = count
    return True


@beginning(StrandBatch)
def look(batch, q):
    """Make the list if it may be out of date."""
    if not used_up(batch, q) < 1.0:
        make(batch, q)


@beginning(StrandBatch)
def look_if_live(batch, q):
    """The same where steps are long."""
    if batch.room[LIVE] > 0.0:
        look(batch, q)


@beginning(StrandBatch)
def look_ahead(batch, q):
    """Make the list in time for the next step.

    Where steps are not judged (:func:`look_back`), or need it one after the other, forces look all the time.
    """
    judged = batch.room[SEEN] >= 0.0
    used = batch.room[SEEN] if judged else used_up(batch, q)
    batch.room[SEEN] = -1.0
    made = not used < USED
    if made:
        make(batch, q)
    batch.room[LIVE] = 1.0 if not judged or (made and batch.room[MADE] > 0.0) else 0.0
    batch.room[MADE] = 1.0 if made else 0.0


@beginning(StrandBatch)
def look_back(batch, q):
    """Whether a step may have missed what is near: it went too far; the next attempt looks all the time."""
    batch.room[SEEN] = used_up(batch, q)
    if batch.room[LIVE] > 0.0 or batch.room[SEEN] < 1.0:
        return False
    make(batch, q)
    batch.room[LIVE], batch.room[SEEN] = 1.0, -1.0
    return anything(batch)


@formula
def box_in(batch):
    """Boxes about the balls of all elements of each piece."""
    for i in range(batch.box.shape[0]):
        for c in range(3):
            batch.box[i, c], batch.box[i, 3 + c] = np.inf, -np.inf
        for e in range(batch.piece[i], batch.piece[i + 1]):
            for c in range(3):
                batch.box[i, c] = min(batch.box[i, c], batch.middle[e, c] - batch.middle[e, 3])
                batch.box[i, 3 + c] = max(batch.box[i, 3 + c], batch.middle[e, c] + batch.middle[e, 3])


@beginning(StrandBatch)
def all_lead(batch, i, j, q):
    """Whether the cable is nearly straight from the start of piece i to the end of piece j."""
    first, last = cubic(batch, batch.piece[i], q), cubic(batch, batch.piece[j + 1] - 1, q)
    u, straight = less(on_cubic(last, 1.0), first[0]), True
    for e in range(batch.piece[i], batch.piece[j + 1]):
        straight = straight and leads(batch, e, q, u)
    return straight


@beginning(StrandBatch)
def free_way(batch, q):
    """How far everything may go before pieces of cables meet that may touch, m; 0 where some may already.

    Pieces next to each other are no obstacle where their cable is nearly straight.
    """
    n, least = batch.box.shape[0], np.inf
    if n * n > PAIRS * batch.base.shape[0] and n > PIECE:
        return 0.0
    box_in(batch)
    for i in range(n):
        for j in range(i, n):
            a, b = batch.cable[batch.piece[i]], batch.cable[batch.piece[j]]
            if batch.law[a, b] < 0 or (a == b and j == i and n > 1 and follows(batch, i)):
                continue
            if a == b and j <= i + 1:
                if not all_lead(batch, i, j, q):
                    return 0.0
                continue
            away = 0.0
            for c in range(3):
                away = max(away, batch.box[j, c] - batch.box[i, 3 + c], batch.box[i, c] - batch.box[j, 3 + c])
            least = min(least, 0.5 * away)
            if least == 0.0:
                return 0.0
    return least


@beginning(StrandBatch)
def follows(batch, i):
    """Whether the next piece is of the same cable: then both are looked at together."""
    return i + 1 < batch.box.shape[0] and batch.cable[batch.piece[i]] == batch.cable[batch.piece[i + 1]]


@beginning(StrandBatch)
def make(batch, q):
    """Make the list with the widest margin for which there is room."""
    largest, sound = 0.0, True
    for e in range(batch.base.shape[0]):
        m, h = ball(batch, e, q)
        batch.middle[e, 0], batch.middle[e, 1], batch.middle[e, 2], batch.middle[e, 3] = m[0], m[1], m[2], h
        sound = sound and h < 1e100
        largest = max(largest, h)
    batch.room[LEFT] = -1.0
    margin = batch.room[WIDEST]
    for e in range(batch.base.shape[0] + 1):
        batch.first[e] = 0
    if not sound or largest > 1e6 * margin:
        return  # an iteration that goes astray
    free = free_way(batch, q)
    if free > margin:
        keep(batch, q, batch.seen)
        batch.room[LEFT] = free
        return
    while not fill(batch, q, margin, 2.0 * (largest + margin)):
        margin *= 0.5
        if margin < 1e-9 * batch.room[WIDEST]:
            break
    keep(batch, q, batch.seen)
    batch.room[LEFT] = margin
