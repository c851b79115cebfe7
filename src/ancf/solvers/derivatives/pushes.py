"""What parameters do to the residuals of the steps of a block, at fixed states: dR/dp.

The batches that a parameter changes have been compiled at values around its own.  R_p is the sum of their
forces with the weights of a difference formula; batches that serve several parameters, as those of the model
itself, are evaluated once.
"""

from __future__ import annotations

from typing import NamedTuple

from ...arrays import FloatArray, IntArray
from ...batches import Batches, add_force_of, add_forces
from ...compiled import inline_kernel, kernel
from ...system.core import drive, external_force, onto_shadows, to_local
from ..rare import add_changes_of, add_number_work_of
from .friction import bring


class Uses(NamedTuple):
    """Batches around the values of parameters, and what their forces count for which of these."""

    batches: Batches
    start: IntArray  # (batches + 1,) first use of each
    of: IntArray  # row of the pushes
    weight: FloatArray  # per unit of the parameter


class Changes(NamedTuple):
    """Batches that know what changes of their numbers do, and the changes by which parameters there are."""

    batches: Batches
    start: IntArray  # (batches + 1,) first change of each
    of: IntArray  # row of the pushes, by change
    rates: FloatArray  # of the numbers, change by change
    rates_from: IntArray  # (batches + 1,) where those of each batch begin
    kinds: IntArray  # see ``Traits.kinds``, change by change
    kinds_from: IntArray  # (batches + 1,)
    begin: IntArray  # (changes,) room: where the rows begin in the pushes of all steps


@inline_kernel
def all_forces(core, inputs, q, v, a, r):
    """r = what is out of balance at a state in physical components: at shadows what supports hold."""
    external_force(core.loads, inputs, r)
    for i in range(r.shape[0]):
        r[i] = -r[i]
    add_forces(core.batches, q, v, a, r, core.ws)


@inline_kernel
def add_turned(supports, turn, r, row):
    """Add to a row of the pushes that local axes turn by R' under the forces r, R'^T r."""
    for k in range(turn.shape[0]):
        i, j = supports.rot_slot[k], supports.rot_shadow[k]
        for c in range(3):
            for m in range(3):
                row[i + c] += turn[k, m, c] * r[j + m]


@inline_kernel
def add_changed(changes, q, v, a, step, push, ws):
    """Add to the pushes of a step what changes of numbers do."""
    begin, of, out = changes.begin, changes.of, push.reshape(-1)
    for m in range(of.shape[0]):
        begin[m] = (of[m] * push.shape[1] + step) * push.shape[2]
    for k in range(changes.start.shape[0] - 1):
        rates = changes.rates[changes.rates_from[k] : changes.rates_from[k + 1]]
        kinds = changes.kinds[changes.kinds_from[k] : changes.kinds_from[k + 1]]
        own = begin[changes.start[k] : changes.start[k + 1]]
        add_changes_of(changes.batches, k, q, v, a, rates, kinds, own, out, ws)


@kernel
def add_pushes(core, uses, changes, turn, first, loaded, tables, way, friction, work, push):
    """Add the forces of the batches to the pushes, and bring these into the form that the solve wants.

    Parameters
    ----------
    core : Core
        Of the model itself; its supports and inputs are those of all.
    uses, changes : Uses, Changes
    turn : (rows, k, 3, 3)
        Derivatives of the local axes, or no rows.
    first : (rows, size)
        What steady loads do, in physical components.
    loaded : (rows,)
        Whether other loads do something as well.
    tables : Tables
        At the ends of the steps.
    way : Way
        States there.
    friction : Friction
        With what batches remember in the steps.
    work : (size,)
    push : (rows, steps, size)
        Filled; at the start what other loads do, in the same.
    """
    n, size = core.weight.shape[0], work.shape[0]
    for step in range(way.q.shape[0]):
        q, v, a = way.q[step], way.v[step], way.a[step]
        drive(core.supports, core.loads.value, tables, step, q, v, a)
        bring(friction, step)
        for p in range(push.shape[0]):
            row, steady = push[p, step], first[p]
            if loaded[p]:
                for i in range(size):
                    row[i] += steady[i]
            else:
                for i in range(size):
                    row[i] = steady[i]
        for k in range(uses.start.shape[0] - 1):
            for i in range(size):
                work[i] = 0.0
            add_force_of(uses.batches, k, q, v, a, work, core.ws)
            for m in range(uses.start[k], uses.start[k + 1]):
                row, weight = push[uses.of[m], step], uses.weight[m]
                for i in range(size):
                    row[i] += weight * work[i]
        add_changed(changes, q, v, a, step, push, core.ws)
        for p in range(push.shape[0]):
            row = push[p, step]
            to_local(core.supports, row)
            for i in range(n, size):
                row[i] = 0.0
        if turn.shape[0] > 0:
            all_forces(core, tables.value[step], q, v, a, work)
            for p in range(push.shape[0]):
                add_turned(core.supports, turn[p], work, push[p, step])


@kernel
def add_loads(loads, value, weight, work, push):
    """Subtract the weighted dead loads with these inputs, (steps or 1, n, 3), from the pushes of a row."""
    for step in range(push.shape[0]):
        if step < value.shape[0]:
            external_force(loads, value[step], work)
        for i in range(work.shape[0]):
            push[step, i] -= weight * work[i]


@kernel
def weigh_pushes(core, uses, known, begin, tables, way, friction, lam, work, pushed, numbers, turned, total):
    """Add lambda . R_p at the ends of steps to what they are for the parameters and for numbers of batches.

    Parameters
    ----------
    core, uses, tables, way : Core, Uses, Tables, Way
        See :func:`add_pushes`.
    known : Batches
        Of the model itself, which know what their numbers do.
    begin : (batches + 1,)
        Where the numbers of each of them begin.
    friction : Friction
        With what batches remember in the steps.
    lam : (steps, size)
        lambda at the unknowns; filled at the shadows.
    work : (size,)
    pushed : (rows,)
        For the parameters of the uses.
    numbers : (m,)
        Derivatives by the numbers.
    turned : (k, 3, 3)
        The same by the local axes in lambda . R^T r, or k = 0: they are not asked for.
    total : (size,)
        Sum of lambda.
    """
    n, supports = core.weight.shape[0], core.supports
    for step in range(way.q.shape[0]):
        q, v, a, x = way.q[step], way.v[step], way.a[step], lam[step]
        drive(core.supports, core.loads.value, tables, step, q, v, a)
        bring(friction, step)
        onto_shadows(core.supports, x)
        for i in range(work.shape[0]):
            total[i] += x[i]
        for k in range(begin.shape[0] - 1):
            add_number_work_of(known, k, q, v, a, x, numbers[begin[k] : begin[k + 1]], core.ws)
        for k in range(uses.start.shape[0] - 1):
            for i in range(work.shape[0]):
                work[i] = 0.0
            add_force_of(uses.batches, k, q, v, a, work, core.ws)
            to_local(core.supports, work)
            found = 0.0
            for i in range(n):
                found += work[i] * x[i]
            for m in range(uses.start[k], uses.start[k + 1]):
                pushed[uses.of[m]] += uses.weight[m] * found
        if turned.shape[0] > 0:
            all_forces(core, tables.value[step], q, v, a, work)
            for k in range(turned.shape[0]):
                i, j = supports.rot_slot[k], supports.rot_shadow[k]
                for m in range(3):
                    for c in range(3):
                        turned[k, m, c] += work[j + m] * x[i + c]


@kernel
def weigh_loads(loads, value, total, lam):
    """Sum over the steps of lambda, (steps, size) with its shadows, times dead loads of these inputs.

    ``total``: the sum of lambda over the steps, which all that does not change is weighed with.
    """
    found = 0.0
    for i in range(total.shape[0]):
        found += total[i] * loads.still[i]
    for step in range(lam.shape[0]):
        load, x = value[step], lam[step]
        for m in range(loads.hung_slot.shape[0]):
            length, i = load[loads.hung_row[m], 0], loads.hung_slot[m]
            for c in range(3):
                found += length * loads.hung[m, c] * x[i + c]
        for k in range(loads.start.shape[0] - 1):
            size = load[loads.grows[k], 0] if loads.grows[k] >= 0 else 1.0
            for m in range(loads.start[k], loads.start[k + 1]):
                i, w = loads.slot[m], size * loads.factor[m]
                for c in range(3):
                    found += w * load[k, c] * x[i + c]
    return found
