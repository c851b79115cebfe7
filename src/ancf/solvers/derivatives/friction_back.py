"""What friction remembers, backwards through the steps of a block, see ``friction``.

With zeta the derivatives of a number by z_{n+1}, what a step leaves, and lambda of the step,

    mu_q + g_q^T zeta,  mu_v + g_v^T zeta  are what lambda is for,
    zeta_n = g_z^T zeta - R_z^T lambda,

and the number changes by zeta . g_p - lambda . R_p.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...batches import Batches
from ...compiled import inline_kernel
from ...records import recorded
from ..rare import take_memory_back_of, take_memory_work_of


@recorded
class Forgetting(NamedTuple):
    """Batches with friction and the derivatives of a number by what they remember."""

    batches: Batches  # whose memory is that of one step
    first: IntArray  # (batches + 1,) where the memory of each begins
    zeta: FloatArray  # (m,) by the memories
    begin: IntArray  # (batches + 1,) where the numbers of each begin
    numbers: FloatArray  # (k,) by these, opposed
    anew: bool  # what is remembered at the start is of the state there


def nothing_forgotten() -> Forgetting:
    """Of models without."""
    one, floats = np.zeros(1, dtype=np.int64), np.zeros(0)
    return Forgetting(Batches(), one, floats, one, floats, False)


@inline_kernel
def is_there(back):
    """Whether there is friction that remembers the way."""
    return back.first.shape[0] > 1


@inline_kernel
def through_memory(back, q, v, by_q, by_v, ws):
    """Take g_q^T zeta and g_v^T zeta from by_q and by_v, of a step; zeta is g_z^T zeta then."""
    for k in range(back.first.shape[0] - 1):
        z = back.zeta[back.first[k] : back.first[k + 1]]
        numbers = back.numbers[back.begin[k] : back.begin[k + 1]]
        take_memory_back_of(back.batches, k, q, v, z, by_q, by_v, numbers, ws)


@inline_kernel
def through_force(back, q, v, x, ws):
    """Take R_z^T x from zeta, of x with its shadows."""
    for k in range(back.first.shape[0] - 1):
        z = back.zeta[back.first[k] : back.first[k + 1]]
        take_memory_work_of(back.batches, k, q, v, x, z, ws)
