"""Steps one by one that cost little more than the steps: all that a kernel takes lies ready as a record.

To hand a run's hundreds of arrays to a kernel takes many times as long as a step of a small model.  So they
are written into a record once (:mod:`ancf.batches`), with room for the functions of time of many steps, and
a step is a call with the address of the record and the number of its row.
"""

from __future__ import annotations

import ctypes
from typing import Any, NamedTuple

import numpy as np
from numba import typeof, types
from numba.core.registry import cpu_target
from numpy.typing import NDArray

from ..compiled import separate_kernel
from ..records import RecordType, keep, read
from ..system.core import Core, Tables
from .explicit import advance_explicit
from .memory import Memory
from .newmark import Rule, advance
from .sampling import Output, Sampling
from .scheme import Scheme


class Implicit(NamedTuple):
    """All that :func:`ancf.solvers.newmark.advance` takes, and where it says how it ended."""

    core: Core
    memory: Memory
    tables: Tables
    step: float
    scheme: Scheme
    rule: Rule
    row: NDArray[np.int64]  # (rows,) -1: no states are kept
    sampling: Sampling
    out: Output
    ended: NDArray[np.int64]  # (2,) steps done and the status of the last one


class Direct(NamedTuple):
    """The same of :func:`ancf.solvers.explicit.advance_explicit`."""

    core: Core
    memory: Memory
    tables: Tables
    step: float
    turning: bool
    row: NDArray[np.int64]
    sampling: Sampling
    out: Output
    ended: NDArray[np.int64]


@separate_kernel
def implicit_at(record, first, count):
    """Steps ``first`` to ``first + count`` of the tables."""
    b, last = read(record), first + count
    tables = Tables(b.tables.value[first:last], b.tables.motion[first:last], b.tables.rotation[first:last])
    out = Output(b.out.q, b.out.v, b.out.work, b.out.samples[first:last])
    row = b.row[first:last]
    done, status = advance(b.core, b.memory, tables, b.step, b.scheme, b.rule, row, b.sampling, out)
    b.ended[0], b.ended[1] = done, status


@separate_kernel
def direct_at(record, first, count):
    """See :func:`implicit_at`."""
    b, last = read(record), first + count
    tables = Tables(b.tables.value[first:last], b.tables.motion[first:last], b.tables.rotation[first:last])
    out = Output(b.out.q, b.out.v, b.out.work, b.out.samples[first:last])
    row = b.row[first:last]
    done, status = advance_explicit(b.core, b.memory, tables, b.step, b.turning, row, b.sampling, out)
    b.ended[0], b.ended[1] = done, status


class Quick:
    """Steps of a bundle.

    Parameters
    ----------
    bundle : Implicit or Direct
        Its arrays are read and written in place.
    """

    def __init__(self, bundle: Any) -> None:
        self.bundle, self.ended = bundle, bundle.ended
        kind, context = typeof(bundle), cpu_target.target_context
        size = context.get_abi_sizeof(context.get_data_type(kind))
        self._words = np.zeros(-(-size // 8), dtype=np.int64)
        keep(bundle, self._words)
        dispatcher: Any = implicit_at if isinstance(bundle, Implicit) else direct_at
        signature = (RecordType(kind), types.int64, types.int64)
        dispatcher.compile(signature)
        compiled = dispatcher.overloads[signature]
        address = compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name)
        # as numba calls a function: place of the result, place of an exception, arguments; returns a status
        prototype = ctypes.CFUNCTYPE(ctypes.c_int32, *[ctypes.c_void_p] * 3, ctypes.c_int64, ctypes.c_int64)
        self._call, self._scratch = prototype(address), np.zeros(4, dtype=np.int64)
        places = self._scratch.ctypes.data
        self._given = places, places + 16, self._words.ctypes.data

    def take(self, first: int, count: int) -> tuple[int, int]:
        """Take ``count`` steps from row ``first`` on; how many were done, and the status of the last one."""
        self._call(*self._given, first, count)
        return int(self.ended[0]), int(self.ended[1])


def shared(run: Any, rows: int) -> dict[str, Any]:
    """What both bundles have, of a :class:`ancf.solvers.stepping.Run`, with room for so many steps."""
    system = run.system
    now = system.inputs.tables(run.t_start, run.h, 1, run.t_start, run.t_end)
    return {
        "core": system.core,
        "memory": run.memory,
        "tables": Tables(*(np.zeros((rows, *x.shape[1:])) for x in now)),
        "step": run.h,
        "row": np.full(rows, -1, dtype=np.int64),
        "sampling": run.sampling,
        "out": run.room(0, rows),
        "ended": np.zeros(2, dtype=np.int64),
    }
