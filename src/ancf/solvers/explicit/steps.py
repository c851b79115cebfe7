"""One compiled block of explicit steps: central differences with the factorised mass matrix.

In the coordinates x = L^T q of M = L L^T the mass matrix is the identity and the method is that of Verlet;
in the coordinates q it costs one evaluation of the forces and one solve with the factors of M per step:

    v_{n+1/2} = v_n + h/2 a_n,  q_{n+1} = q_n + h v_{n+1/2},
    M a_{n+1} = F(t_{n+1}) - f(q_{n+1}, v_{n+1/2} + h/2 a_n),  v_{n+1} = v_{n+1/2} + h/2 a_{n+1}.

Forces that depend on the velocity see the prediction v_n + h a_n, whose error of the size h^2 keeps the
order 2.
"""

from __future__ import annotations

from ...batches import remember_all
from ...compiled import kernel, separate_kernel
from ...system.core import (
    assemble,
    drive,
    external_force,
    factorise_matrix,
    follow,
    residual,
    restrict,
    solve_matrix,
    to_local,
)
from ..apart import book, take_note, take_sample
from ..status import DIVERGED, NOT_FINITE, OK, SINGULAR, STEPS
from ..step.memory import NORM, WORST

#: A step in which something moves by more than this many sizes of the model is no motion.
FAR = 10.0


@kernel
def mass_factor(core, q, v):
    """Factorise the mass matrix; negative when it is singular."""
    assemble(core.batches, core.ws, q, v, core.A, 1.0, 0.0, 0.0)
    restrict(core.supports, core.A)
    return factorise_matrix(core.A, core.factor)


@separate_kernel
def advance_explicit(core, s, tables, h, turning, keep, sampling, out, apart):
    """Take the steps of one block; see :func:`ancf.solvers.newmark.advance` for the arguments.

    ``turning`` says that local axes, or an added mass, turn, and the mass matrix with them.  ``s.a1`` holds
    the velocity in the middle of the step.
    """
    n_free = core.weight.shape[0]
    for n in range(keep.shape[0]):
        moved = 0.0
        for i in range(s.q.shape[0]):
            s.q0[i], s.v0[i], s.a0[i] = s.q[i], s.v[i], s.a[i]
        for i in range(n_free):
            half = 0.5 * h * s.a[i]
            s.a1[i] = s.v[i] + half
            s.q[i] += h * s.a1[i]
            s.v[i] = s.a1[i] + half
            s.a[i] = 0.0
            x = abs(h * s.a1[i]) * core.weight[i]
            if not x <= moved:
                moved, s.memo[WORST] = x, float(i)
        s.memo[NORM] = moved
        status = OK
        if not moved <= FAR:
            status = DIVERGED if moved < 1e300 else NOT_FINITE
        else:
            external_force(core.loads, tables.value[n], s.f)
            drive(core.supports, core.loads.value, tables, n, s.q, s.v, s.a)
            if turning and mass_factor(core, s.q, s.v) < 0:
                status = SINGULAR
            residual(core.batches, core.ws, s.q, s.v, s.a, s.f, s.r)
            to_local(core.supports, s.r)
            solve_matrix(core.factor, s.r)
            total = 0.0
            for i in range(n_free):
                total += abs(s.r[i]) * core.weight[i]
            if not total < 1e300:
                status = NOT_FINITE
        if status != OK:
            for i in range(s.q.shape[0]):
                s.q[i], s.v[i], s.a[i] = s.q0[i], s.v0[i], s.a0[i]
            return n, status
        for i in range(n_free):
            s.a[i] -= s.r[i]
            s.v[i] = s.a1[i] + 0.5 * h * s.a[i]
        for k in range(core.supports.prescribed.shape[0]):
            s.v[core.supports.prescribed[k]] = tables.motion[n, k, 1]
        follow(core.supports, s.q, s.v, s.a)
        s.counts[STEPS] += 1
        book(apart, core, s, h)
        if n < out.samples.shape[0]:
            take_note(apart, core, s, sampling)
            take_sample(apart, sampling, s, out.samples[n])
        remember_all(core.remembering, s.q, s.v)
        if keep[n] >= 0:
            for i in range(s.q.shape[0]):
                out.q[keep[n], i], out.v[keep[n], i] = s.q[i], s.v[i]
            out.work[keep[n], 0], out.work[keep[n], 1] = s.work[0], s.work[1]
    return keep.shape[0], OK
