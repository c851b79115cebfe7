"""Memory: state and workspace of a run that takes steps of one length in a compiled loop."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray
from ...records import recorded
from ..status import COUNTS
from .corotation import Frames
from .low_rank import Patches


@recorded
class Memory(NamedTuple):
    """State and workspace of a run; all arrays of length n unless said otherwise."""

    q: FloatArray
    v: FloatArray
    a: FloatArray
    abar: FloatArray  # the generalised-alpha method's algorithmic acceleration
    a1: FloatArray  # accelerations one, two and three steps before a0, for the predictor
    a2: FloatArray
    a3: FloatArray
    q0: FloatArray  # copies at the start of the last step
    v0: FloatArray
    a0: FloatArray
    r: FloatArray
    f: FloatArray
    left: FloatArray  # forces that Newton's method has left in all steps, see carry
    push: FloatArray  # forces that do work at the start of the step
    push_new: FloatArray
    loss: FloatArray  # forces that dissipate, opposed, at the start of the step
    loss_new: FloatArray
    counts: NDArray[np.int64]  # (5,) see COUNTS
    memo: FloatArray  # (11,) see below
    work: FloatArray  # (2,) energy dissipated and supplied since the start, J
    frames: Frames
    patches: tuple[Patches, ...]  # one or none


#: Numbers in a line of the cache, and in a page.
LINE, PAGE = 8, 512
#: Entries of Memory that are vectors of length n; they come first.
VECTORS = 17

# entries of Memory.memo
H_FACTOR, ETA, H_PREV, WORST, NORM, NOISE, KNOWN, USUAL, EXCESS, LIMIT, WORN = range(11)
#: Iterations more than usual after which a matrix is renewed for the first time, see renewal: what it costs.
FIRST_LIMIT = 8.0


def aligned(count: int, n: int) -> list[FloatArray]:
    """So many vectors of n zeros that each begin with a line of the cache: no eight numbers are on three."""
    step = -(-n // LINE) * LINE
    step += LINE if step % PAGE == 0 else 0  # places that differ by pages wait for each other
    whole = np.zeros(count * step + LINE)
    first = -(whole.ctypes.data // whole.itemsize) % LINE
    return [whole[first + k * step : first + k * step + n] for k in range(count)]


def allocate(n: int, frames: Frames, patches: tuple[Patches, ...]) -> Memory:
    """Memory for state vectors of length n."""
    vectors: Any = dict(zip(Memory._fields[:VECTORS], aligned(VECTORS, n), strict=True))
    counts = np.zeros(len(COUNTS), dtype=np.int64)
    own: Any = {"counts": counts, "memo": np.zeros(11), "work": np.zeros(2)}
    memory = Memory(**vectors, **own, frames=frames, patches=patches)
    memory.memo[ETA], memory.memo[LIMIT] = 1.0, FIRST_LIMIT
    return memory
