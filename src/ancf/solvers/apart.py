"""What a step needs rarely, or few models need: kernels of their own, which steps call by their addresses."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

from numba import types

from .. import addresses
from ..addresses import caller
from ..batches import add_tangents, record_at
from ..compiled import formula, separate_kernel
from ..linalg.border import clear_rows, find_rows, forget_columns, renew_border
from ..records import RecordType, recorded, type_of
from ..system.core import (
    Core,
    assemble,
    constraint_rows,
    factorise_head,
    has_rows,
    restrict,
    solve_kept,
    to_local,
)
from .sampling import Sampling, note_now, sample
from .sleeping.awake import asleep, iterate_awake, matrix_awake
from .sleeping.far import begin_far, end_far, show_far
from .status import FACTORIZATIONS, JACOBIANS
from .step.balance import balance
from .step.corotation import remember, turn_forth, turn_rows
from .step.corrections import shift
from .step.entwined import hold_zones, let_go_zones, solve_entwined
from .step.low_rank import correct_rows, forget
from .step.memory import H_FACTOR, WORST, Memory
from .step.near import iterate
from .step.renewal import renewed
from .step.scheme import Scheme

#: Share of the tolerance up to which constraints need no shift.
HELD = 0.1


@recorded
class Apart(NamedTuple):
    """Addresses; 0 where a model does not need it."""

    new_matrix: int
    renew_tail: int  # of sliding joints
    project: int  # of joints
    balance: int  # something dissipates, or loads do work
    note: int  # sensors that take accelerations or reactions
    sample: int  # sensors
    begin_far: int  # of a line parts that can sleep
    end_far: int
    show_far: int
    iterate_awake: int
    matrix_awake: int
    correct: int  # contacts, or springs that may go slack
    iterate: int  # of a line what is near
    entwined: int  # cables touch each other
    hold_zones: int
    let_go_zones: int


_new_matrix, _renew_tail, _project = caller(types.boolean), caller(types.boolean), caller(types.float64)
_balance, _note, _sample = caller(types.none), caller(types.none), caller(types.none)
_begin_far, _end_far, show_far_at = caller(types.none), caller(types.boolean), caller(types.none)
_iterate_awake, _iterate = caller(types.float64, nothing=math.inf), caller(types.float64, nothing=math.inf)
_matrix_awake = caller(types.int64, nothing=0)
_entwined, _zones = caller(types.none), caller(types.none)


@separate_kernel
def new_matrix(core, s, h, B, G, awake):
    """Make and factorise the matrix of a step h in the present state; whether that is possible.

    ``awake`` is the address of :func:`ancf.solvers.sleeping.awake.matrix_awake` where something may sleep.
    """
    s.counts[JACOBIANS] += 1
    s.counts[FACTORIZATIONS] += 1
    if asleep(core.far):
        bad = _matrix_awake(awake, (core, s, G / B, 1.0 / B))
    else:
        assemble(core.batches, core.ws, s.q, s.v, core.A, 1.0 / B, G / B, 1.0)
        restrict(core.supports, core.A)
        bad = factorise_head(core.A, core.factor, core.joints.first)
    remember(s.frames, s.q)
    if bad >= 0 and has_rows(core.joints):
        forget_columns(core.joints.border)
        find_rows(core.joints.border, core.A, core.factor)
        bad = min(renew_border(core.joints.border, core.A, core.factor), 0)
        bad -= core.joints.first if bad < 0 else 0
    if bad < 0:
        s.memo[WORST] = 6.0 * (-bad - 1)
        return False
    s.memo[H_FACTOR] = h
    forget(s.patches)
    renewed(s)
    return True


@separate_kernel
def renew_tail(core, s, corotate, B, G):
    """Renew the rows of the sliding joints alone; whether that is possible."""
    joints, A = core.joints, core.A
    clear_rows(joints.border, A, joints.first)
    add_tangents(joints.tail, s.q, s.v, A, 1.0 / B, G / B, 1.0, core.ws)
    restrict(joints.supports, A)
    find_rows(joints.border, A, core.factor)
    if corotate:
        turn_rows(s.frames, joints.border, A)
    return renew_border(joints.border, A, core.factor) >= 0


@separate_kernel
def project(core, s, tolerance, corotate, w0, w1, w2):
    """Shift the positions onto C = 0; the norm of the shift. The weights are those of the rows otherwise."""
    joints = core.joints
    joints.level[0], joints.level[1], joints.level[2] = 1.0, 0.0, 0.0
    constraint_rows(joints, s.q, s.v, s.a, s.r, core.ws)
    joints.level[0], joints.level[1], joints.level[2] = w0, w1, w2
    norm = 0.0
    for k in range(joints.multipliers.shape[0]):
        norm = max(norm, abs(s.r[joints.multipliers[k]]) * joints.weight[k])
    if norm <= HELD * tolerance:
        return 0.0
    to_local(core.supports, s.r)  # as in solve_turned, but there is nothing to turn back
    solve_kept(core, s.r, min(joints.lowest, joints.first))
    if corotate:
        turn_forth(s.frames, s.r)
    return shift(s.q, s.r, joints.mask, core.weight)


@formula
def matrix_anew(apart, core, s, h, B, G):
    """See :func:`new_matrix`."""
    return _new_matrix(apart.new_matrix, (core, s, h, B, G, apart.matrix_awake))


@formula
def tail_anew(apart, core, s, rule, B, G):
    """See :func:`renew_tail`."""
    return _renew_tail(apart.renew_tail, (core, s, rule.corotate, B, G))


@formula
def projected(apart, core, s, rule):
    """See :func:`project`."""
    return _project(apart.project, (core, s, rule.tolerance, rule.corotate, rule.w0, rule.w1, rule.w2))


@formula
def book(apart, core, s, h):
    """See :func:`ancf.solvers.step.balance.balance`."""
    if core.accounted:
        _balance(apart.balance, (core, s, h))


@formula
def take_note(apart, core, s, sampling):
    """See :func:`ancf.solvers.sampling.note`."""
    _note(apart.note, (core, s, sampling))


@formula
def take_sample(apart, sampling, s, row):
    """See :func:`ancf.solvers.sampling.sample`; nothing happens without sensors."""
    if apart.sample != 0:
        _sample(apart.sample, (sampling, s.q, s.v, row))


@formula
def begin_parts(apart, core, s, h, scheme, gb, ib):
    """See :func:`ancf.solvers.sleeping.far.begin_far`; nothing happens where nothing can sleep."""
    if apart.begin_far != 0:
        _begin_far(apart.begin_far, (core, s, h, scheme, gb, ib))


@formula
def end_parts(apart, core, s, scheme, gb, ib):
    """See :func:`ancf.solvers.sleeping.far.end_far`."""
    return apart.end_far != 0 and _end_far(apart.end_far, (core, s, scheme, gb, ib))


@formula
def show_parts(apart, core, s, whole):
    """See :func:`ancf.solvers.sleeping.far.show_far`."""
    if apart.show_far != 0:
        show_far_at(apart.show_far, (core, s, whole))


@formula
def iterated_awake(apart, core, s, gb, ib):
    """See :func:`ancf.solvers.sleeping.awake.iterate_awake`."""
    return _iterate_awake(apart.iterate_awake, (core, s, gb, ib, apart.correct))


@formula
def iterated(apart, core, s, limit, gb, ib):
    """See :func:`ancf.solvers.step.near.iterate`."""
    return _iterate(apart.iterate, (core, s, limit, gb, ib, apart.correct))


@formula
def entwined(apart, core, s, rule, gb):
    """See :func:`ancf.solvers.step.entwined.solve_entwined`; nothing happens where no cables touch."""
    if apart.entwined != 0:
        _entwined(apart.entwined, (record_at(core.entwined, 0), core, s, rule.corotate, gb, apart.correct))


@formula
def zones_held(apart, core, s):
    """See :func:`ancf.solvers.step.entwined.hold_zones`."""
    if apart.hold_zones != 0:
        _zones(apart.hold_zones, (record_at(core.entwined, 0), s.q))


@formula
def zones_let_go(apart, core):
    """See :func:`ancf.solvers.step.entwined.let_go_zones`."""
    if apart.let_go_zones != 0:
        _zones(apart.let_go_zones, (record_at(core.entwined, 0),))


def needed(core: Core, memory: Memory, sampling: Sampling, explicit: bool) -> tuple[bool, ...]:
    """Which of :class:`Apart` a model needs."""
    joints, implicit = core.joints, not explicit
    return (
        implicit,
        implicit and len(joints.border.number) > 0,
        implicit and len(joints.multipliers) > 0,
        bool(core.damped or core.loaded),
        len(sampling.moved) > 0 or len(sampling.pushed) > 0,
        sampling.width > 0,
        *(5 * (implicit and bool(core.far) and len(core.far[0].part) > 0,)),
        implicit and len(memory.patches) > 0,
        implicit and len(core.near) > 0,
        *(3 * (implicit and len(core.entwined) > 0,)),
    )


def strands_of(core: Core) -> Any:
    """Type of the contacts between cables; None without them."""
    return RecordType(type_of(core.entwined[0])) if core.entwined else None


def apart_of(core: Any, memory: Any, sampling: Any, wanted: tuple[bool, ...], strands: Any = None) -> Apart:
    """Those that are wanted, for arrays of these types; they are compiled if they were not.

    ``strands``: type of the contacts between cables.
    """
    flag, number, vector = types.boolean, types.float64, types.Array(types.float64, 1, "C")
    both, scheme = (core, memory), type_of(Scheme(0.0, 0.0, 0.0, 0.0))
    kernels: list[tuple[Any, Any, tuple[Any, ...]]] = [
        (new_matrix, flag, (*both, number, number, number, types.int64)),
        (renew_tail, flag, (*both, flag, number, number)),
        (project, number, (*both, number, flag, number, number, number)),
        (balance, types.none, (*both, number)),
        (note_now, types.none, (*both, sampling)),
        (sample, types.none, (sampling, vector, vector, vector)),
        (begin_far, types.none, (*both, number, scheme, number, number)),
        (end_far, flag, (*both, scheme, number, number)),
        (show_far, types.none, (*both, flag)),
        (iterate_awake, number, (*both, number, number, types.int64)),
        (matrix_awake, types.int64, (*both, number, number)),
        (correct_rows, types.none, (*both, number)),
        (iterate, number, (*both, number, number, number, types.int64)),
        (solve_entwined, types.none, (strands, *both, flag, number, types.int64)),
        (hold_zones, types.none, (strands, vector)),
        (let_go_zones, types.none, (strands,)),
    ]
    found = [
        addresses.address_of(kernel, given, result) if needs else 0
        for (kernel, result, given), needs in zip(kernels, wanted, strict=True)
    ]
    return Apart(*found)
