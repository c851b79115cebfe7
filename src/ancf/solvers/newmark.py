"""One compiled block of implicit steps of the Newmark family, with a modified Newton method.

At the end of a step the unknown is the acceleration a, with

    q = q~ + B a,      v = v~ + G a,      B = beta h^2 (1 - alpha_f)/(1 - alpha_m),
                                          G = gamma h (1 - alpha_f)/(1 - alpha_m),

where q~ and v~ hold everything that is known; the trapezoidal rule is alpha_m = alpha_f = 0, beta = 1/4,
gamma = 1/2.  Newton corrects q by dq, v by (G/B) dq and a by dq/B with the matrix M/B + (G/B) C + K.

Modified Newton keeps that matrix over iterations and steps.  With the contraction theta of successive
corrections the error left is about theta/(1 - theta) |dq|, and the iteration stops when that is below
the tolerance.  The matrix is renewed when theta exceeds the limit or the iterations run out.  What is left
of the forces is carried over to the next step where that matters (:mod:`ancf.solvers.step.carry`).

Constraints add multipliers to the unknowns, which have no rates: dq alone is added to them.  Which time
derivative of a constraint its row asks for is the formulation's choice (:mod:`ancf.solvers.formulations`).
"""

from __future__ import annotations

import math
from typing import NamedTuple

from ..batches import find_events, remember_all
from ..compiled import formula, inline_kernel, separate_kernel
from ..records import recorded
from ..system.core import (
    drive,
    external_force,
    follow,
    has_rows,
)
from .apart import (
    begin_parts,
    book,
    end_parts,
    entwined,
    iterated,
    iterated_awake,
    matrix_anew,
    projected,
    show_parts,
    tail_anew,
    take_note,
    take_sample,
    zones_held,
    zones_let_go,
)
from .sleeping.awake import asleep, finish_awake, load_awake, predict_awake, restore_awake
from .status import (
    DIVERGED,
    EVENT,
    FAR,
    INVERTED,
    ITERATIONS,
    NOT_FINITE,
    OK,
    SINGULAR,
    SLOW,
    TURN,
)
from .step.carry import carry, keeps_rows, unbalanced
from .step.checks import check_sections, check_way
from .step.corotation import turn
from .step.corrections import UNLIMITED, largest, update
from .step.entwined import solve_apart
from .step.low_rank import move_on
from .step.memory import ETA, H_FACTOR, KNOWN, NOISE, NORM, WORST
from .step.near import take_all
from .step.renewal import count
from .step.scheme import coefficients, finish, predict, restore, show_bars

#: Least theta/(1 - theta) that is believed before a step has shown its own contraction, and the power that
#: brings the one of the step before nearer to 1.
STALE, AGED = 0.03, 0.8
#: Corrections up to this multiple of the tolerance, and up to this size, that a new matrix does not reduce
#: are round-off.  Where friction sticks and slips a kink of its force may be the reason: a smaller multiple,
#: until all has been tried.
ROUND_OFF, AT_KINKS = 1e4, 1e2
LARGEST_ROUND_OFF = 1e-7
#: Up to which corrections are round-off, whatever the tolerance, if a matrix of its own makes one no smaller.
TINIEST = 1e-13
#: By which round-off that was seen once is forgotten from step to step.
FADING = 0.99
#: It diverges: so large a correction, a ratio of two, or one above 1 after so many iterations with a new one.
FLOWN, GROWN, TRIED = 1e3, 2.0, 3
#: Iterations with one matrix after which it is renewed at the latest, and the first that may tell so.
LONGEST, FIRST_TOLD = 7, 2

#: Iterations after which the zones in which cables touch are held.
PATIENT = 12
#: Attempts at a step: 0 with the matrix that is kept, 1 with a new one, 2 with one for every iteration.
LAST = 2

#: Largest change of a slope, or of a position in sizes of the model, in a step that is looked at closely.
FURTHEST = 0.5

#: Error of the accelerations that is left in a step with constraints: what is left in q returns divided
#: by B, with one sign, where a joint keeps it from being felt as a displacement.  Rows that are kept with
#: the matrix may turn for long and add it up; those of sliding joints are made anew in each step.  And the
#: least tolerance.
KEPT, RENEWED, FINEST = 1e-6, 1e-5, 1e-15


@recorded
class Rule(NamedTuple):
    """Newton's rule: see :class:`ancf.Newton`."""

    tolerance: float
    contraction: float
    max_iterations: int
    modified: bool
    corotate: bool
    w0: float  # weights of C, dC/dt and d2C/dt2 in the rows of the multipliers
    w1: float
    w2: float
    projects: bool  # positions are shifted onto C = 0
    furthest: float  # largest change of an unknown in a step, in units of the size of the model or of a slope
    first: int  # attempts at a step, from 0 to LAST
    last: int


@formula
def still(joints, v, a):
    """Multipliers have no rates."""
    for k in range(joints.multipliers.shape[0]):
        v[joints.multipliers[k]] = 0.0
        a[joints.multipliers[k]] = 0.0


@inline_kernel
def worst_unknown(s, weight):
    """Unknown with the largest (or no finite) correction."""
    worst, largest = 0, -1.0
    for i in range(weight.shape[0]):
        x = abs(s.r[i]) * weight[i]
        if not x < UNLIMITED:
            return i
        if x > largest:
            worst, largest = i, x
    return worst


@formula
def newton(core, s, h, rule, modified, B, G, apart):
    """Solve the equations of one step from the prediction in s; returns a status."""
    renew, fresh = s.memo[H_FACTOR] != h, False  # fresh: the matrix was renewed in this step
    has_joints = core.joints.multipliers.shape[0] > 0
    taut = len(s.patches) > 0 and not has_joints  # a line of wires, as a rule
    if rule.corotate and not renew:
        turn(s.frames, s.q)
    if not renew and has_rows(core.joints):
        renew = not tail_anew(apart, core, s, rule, B, G)
    move_on(s.patches)
    eta = max(s.memo[ETA] ** AGED, STALE)
    tolerance = rule.tolerance
    if has_joints:
        jointed = KEPT if keeps_rows(core.joints) else RENEWED
        tolerance = max(min(tolerance, jointed * B * largest(s.a, core.weight)), FINEST)
    tolerance = max(tolerance, s.memo[NOISE])
    s.memo[NOISE] *= FADING
    older, old, since, whole, last = -1.0, -1.0, 0, True, -1.0
    noise = AT_KINKS if core.sticks and modified else ROUND_OFF
    noise = min(noise * rule.tolerance, LARGEST_ROUND_OFF)
    other = modified and s.memo[KNOWN] == 0.0 and not has_joints and not core.damped  # start, see unresolved
    tries = 0 if other else TRIED
    nearby = modified and len(core.near) > 0 and not rule.corotate  # a part of it may iterate by itself
    for iteration in range(rule.max_iterations):
        if renew:
            if not matrix_anew(apart, core, s, h, B, G):
                return SINGULAR
            renew, fresh, older, old, eta, since, whole = False, True, -1.0, -1.0, 1.0, 0, True
        if iteration == PATIENT:
            zones_held(apart, core, s)
        if whole and asleep(core.far):
            norm = iterated_awake(apart, core, s, G / B, 1.0 / B)
        elif whole:
            unbalanced(core, s, h)
            solve_apart(core, s, rule.corotate, G / B, apart.correct)
            entwined(apart, core, s, rule, G / B)
            if nearby:
                norm = take_all(core.near, s, core.weight, G / B, 1.0 / B)
            else:
                norm = update(s, core.weight, G / B, 1.0 / B)
        else:
            norm = iterated(apart, core, s, tolerance / eta, G / B, 1.0 / B)
        size, whole = norm, not nearby
        if has_joints:
            still(core.joints, s.v, s.a)
            if rule.projects:  # the shift leaves the accelerations alone: its own tolerance is the rule's
                shift = projected(apart, core, s, rule)
                size, norm = max(norm, shift), max(norm, shift * min(tolerance / rule.tolerance, 1.0))
        follow(core.supports, s.q, s.v, s.a)
        s.counts[ITERATIONS] += 1
        s.memo[NORM] = size
        if not size < UNLIMITED:
            return NOT_FINITE
        theta = norm / old if old > 0.0 else -1.0
        if theta >= 0.0:
            eta = theta / (1.0 - theta) if theta < 1.0 else UNLIMITED
        if eta * norm <= tolerance:
            s.memo[ETA] = eta
            if rule.corotate and modified:
                count(s, iteration + 1.0, fresh)
            return OK
        # of joints one may make up for what the matrix lacks, as friction by multipliers: two have to tell
        tiny = fresh and size <= noise
        alike = theta > rule.contraction and (not has_joints or 0.0 < rule.contraction * older < norm)
        if tiny and alike:
            s.memo[NOISE], s.memo[ETA] = 2.0 * norm, 1.0
            return OK
        if not modified and 0.0 < rule.contraction * last < norm and size <= TINIEST:
            return OK
        last = norm
        grows = theta >= GROWN or (theta >= 1.0 and fresh and iteration > tries)
        if size > FLOWN or (grows and not tiny):
            return DIVERGED
        # of a taut wire position and slope take turns: two corrections tell how fast they shrink
        rate = math.sqrt(norm / older) if older > 0.0 and taut else theta
        older, old = old, norm
        renew = not modified or (rate > rule.contraction and since >= FIRST_TOLD) or rate > 1.0
        renew = renew or since == LONGEST
        since += 1
    return SLOW


@formula
def take_steps(core, s, tables, h, scheme, rule, keep, sampling, out, apart):
    """See :func:`advance`."""
    B, G = coefficients(h, scheme)
    level = core.joints.level
    level[0], level[1], level[2] = rule.w0, rule.w1, rule.w2
    status = OK
    for n in range(keep.shape[0]):
        if not load_awake(core.far, core.loads, tables.value[n], s.f, core.weight.shape[0]):
            external_force(core.loads, tables.value[n], s.f)
        for attempt in range(rule.first, rule.last + 1):
            keeps = 1.0 if attempt == 0 else 0.0
            if not predict_awake(core.far, s, h, scheme, keeps, core.weight.shape[0]):
                predict(s, h, scheme, keeps)
            drive(core.supports, core.loads.value, tables, n, s.q, s.v, s.a)
            begin_parts(apart, core, s, h, scheme, G / B, 1.0 / B)
            status = newton(core, s, h, rule, rule.modified and attempt < LAST, B, G, apart)
            zones_let_go(apart, core)
            if status == OK:
                status = check_sections(core, s)
            if status == OK and rule.furthest < UNLIMITED:
                status = check_way(core, s, rule.furthest)
            if status == OK:
                break
            if status != SINGULAR and status != INVERTED and status != FAR:  # else it says where already
                s.memo[WORST] = worst_unknown(s, core.weight)
            if not restore_awake(core.far, s, core.weight.shape[0]):
                restore(s)
            s.memo[H_FACTOR], s.memo[ETA] = 0.0, 1.0
        if status != OK:
            return n, status
        carry(core, s, h)
        if not finish_awake(core.far, s, h, scheme, core.weight.shape[0]):
            finish(s, h, scheme)
        turn = end_parts(apart, core, s, scheme, G / B, 1.0 / B)
        book(apart, core, s, h)
        if n < out.samples.shape[0]:
            take_note(apart, core, s, sampling)
            take_sample(apart, sampling, s, out.samples[n])  # with what has acted, before it is renewed
        remember_all(core.remembering, s.q, s.v)
        if keep[n] >= 0:
            show_parts(apart, core, s, True)
            for i in range(s.q.shape[0]):
                out.q[keep[n], i], out.v[keep[n], i] = s.q[i], s.v[i]
            show_parts(apart, core, s, False)
            out.work[keep[n], 0], out.work[keep[n], 1] = s.work[0], s.work[1]
        event = find_events(core.joints.tail, s.q)
        if event >= 0:
            return n + 1, EVENT + event
        if turn:
            return n + 1, TURN
    return keep.shape[0], status


@separate_kernel
def advance(core, s, tables, h, scheme, rule, keep, sampling, out, apart):
    """Take the steps of one block.

    ``keep[n]`` is the row of the outputs that takes the state at the end of step n, or -1; its samples
    are row n of theirs, if there is one.  A step that fails is tried again with a new matrix, and then
    with one for every iteration.  Returns the number of steps done and the status of the last one; a
    failed step leaves the state at its start, an event ends the block after a step.  ``apart`` are the
    addresses of what is not part of this kernel.
    """
    done, status = take_steps(core, s, tables, h, scheme, rule, keep, sampling, out, apart)
    show_bars(s, scheme)
    return done, status
