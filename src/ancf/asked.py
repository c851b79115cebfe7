"""Operations of batches that only sensitivities ask for, see :mod:`ancf.compiled`."""

from __future__ import annotations

from typing import Any


def add_rate_stiffness(batch, q, v, S, W, ws):
    """Add what the derivative of the batch's forces by q has because of v, and the tangent at v has not.

    Its symmetric half goes to the block values ``S``, the antisymmetric one to ``W``, of which the blocks on
    the other side of the diagonal are the transposed ones with the other sign.
    """
    raise TypeError(f"{type(batch).__name__} does not know how velocities change its stiffness")


def add_rate_work(batch, q, v, x, out, ws):
    """Add the derivative of x . force by q to ``out``, of what :func:`add_rate_stiffness` is about."""
    raise TypeError(f"{type(batch).__name__} does not know how velocities change its stiffness")


def add_tangent_work(batch, q, v, x, by_q, by_v, by_a, ws):
    """Add K x, C x and M x, of the matrices of :func:`add_tangent`, to ``by_q``, ``by_v`` and ``by_a``."""
    raise TypeError(f"{type(batch).__name__} does not know the products of its matrices")


def add_number_work(batch, q, v, a, x, out, ws):
    """Add the derivatives of x . force by the numbers of the batch, ``Traits.numbers``, to ``out``."""
    raise TypeError(f"{type(batch).__name__} does not know what its numbers do")


def add_changes(batch, q, v, a, rates, kinds, begin, out, ws):
    """Add the derivatives of the force along changes of the batch's numbers, ``rates``, one after the other,
    to where in ``out`` each begins; ``kinds``: see ``Traits.kinds``.
    """
    raise TypeError(f"{type(batch).__name__} does not know what its numbers do")


def add_work_slopes(batch, q, v, a, x, by_q, by_v, by_a, ws):
    """Add the derivatives of x . force by q, v and a, without what vanishes where rows of joints are zero."""
    raise TypeError(f"{type(batch).__name__} does not know the slopes of the work of its forces")


def add_force_slopes(batch, q, v, a, d, r, ws):
    """Add the derivatives of the force along eight directions, d (3, size, 8) of q, v and a, to r (size, 8),
    without what vanishes where rows of joints are zero.
    """
    raise TypeError(f"{type(batch).__name__} does not know the slopes of its forces")


def add_slopes_beside(batch, q, v, a, d, r, ws):
    """Of :func:`add_force_slopes`, what the tangent with 1 for K leaves out where rates go with d[0]."""
    raise TypeError(f"{type(batch).__name__} does not know the slopes of its forces")


def choose_memory(batch, q, v, out):
    """Write what the batch remembers to ``out``, with limits as derivatives of a step that ends in the state
    want them: negative where friction slips, as it then does in all states, beyond reach where it sticks.
    """
    raise TypeError(f"{type(batch).__name__} does not know what its memory does")


def add_memory_slopes(batch, q, v, z, r, ws):
    """Add the derivatives of the force along eight changes of the memory, z (m, 8), to r (size, 8)."""
    raise TypeError(f"{type(batch).__name__} does not know what its memory does")


def remember_along(batch, q, v, d, z, ws):
    """Let z, changes of what a step began with in eight lanes, be those of what it leaves; d as in
    :func:`add_force_slopes`.
    """
    raise TypeError(f"{type(batch).__name__} does not know what its memory does")


def add_memory_changes(batch, q, v, rates, kinds, begin, out, ws):
    """Add what changes of the batch's numbers do to what a step leaves to where in ``out`` each begins, every
    eighth; see :func:`add_changes`.
    """
    raise TypeError(f"{type(batch).__name__} does not know what its memory does")


def take_memory_work(batch, q, v, x, z, ws):
    """Take the derivatives of x . force by what the batch remembers from z, (m,)."""
    raise TypeError(f"{type(batch).__name__} does not know what its memory does")


def take_memory_back(batch, q, v, z, by_q, by_v, numbers, ws):
    """Let z, derivatives of a number by what a step leaves, be those by what it began with.

    Those by the state and by the batch's numbers, ``Traits.numbers``, are taken from ``by_q``, ``by_v`` and
    ``numbers``.
    """
    raise TypeError(f"{type(batch).__name__} does not know what its memory does")


def take_measured_slopes(batch, q, v, dq, dv, out):
    """Write the derivatives of what is measured (``measure``) along a change of the state, in its order."""
    raise TypeError(f"{type(batch).__name__} does not know the slopes of what it measures")


def add_measured_work(batch, q, v, y, by_q, by_v):
    """Add the derivatives of y . measured by the state, y for what is measured (``measure``) in its order."""
    raise TypeError(f"{type(batch).__name__} does not know the slopes of what it measures")


#: Operations that only sensitivities ask for, by their names in :func:`implements`.
OF_SENSITIVITIES: dict[str, Any] = {
    "rate_stiffness": add_rate_stiffness,
    "rate_work": add_rate_work,
    "tangent_work": add_tangent_work,
    "number_work": add_number_work,
    "changes": add_changes,
    "work_slopes": add_work_slopes,
    "force_slopes": add_force_slopes,
    "slopes_beside": add_slopes_beside,
    "memory_choice": choose_memory,
    "memory_slopes": add_memory_slopes,
    "memory_along": remember_along,
    "memory_changes": add_memory_changes,
    "memory_work": take_memory_work,
    "memory_back": take_memory_back,
    "measured_slopes": take_measured_slopes,
    "measured_work": add_measured_work,
}
