"""Steps one by one that cost little more than the steps: all that a kernel takes lies ready as a record.

To hand a run's hundreds of arrays to a kernel takes many times as long as a step of a small model.  So they
are written into a record once (:mod:`ancf.batches`), with room for the functions of time of many steps, and
a step is a call with the address of the record and the number of its row.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numba import typeof, types
from numba.core import cgutils
from numba.core.registry import cpu_target
from numba.extending import intrinsic
from numpy.typing import NDArray

from ..compiled import kernel, separate_kernel
from ..records import RecordType, keep, read
from ..system.core import Core, Tables
from .explicit import advance_explicit
from .memory import Memory
from .newmark import Rule, advance
from .sampling import Output, Sampling
from .scheme import Scheme
from .status import OK

#: Factor of the number of steps in what kernels return, where a status is smaller; one step that went well.
PACKED = 1 << 32
DONE = PACKED + OK


class Implicit(NamedTuple):
    """All that :func:`ancf.solvers.newmark.advance` takes."""

    core: Core
    memory: Memory
    tables: Tables
    step: float
    scheme: Scheme
    rule: Rule
    row: NDArray[np.int64]  # (rows,) -1: no states are kept
    sampling: Sampling
    out: Output


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


@separate_kernel
def implicit_at(record, first, count):
    """Steps from ``first`` on, of the tables; how many were done and the status of the last one, packed."""
    b, last = read(record), first + count
    tables = Tables(b.tables.value[first:last], b.tables.motion[first:last], b.tables.rotation[first:last])
    out = Output(b.out.q, b.out.v, b.out.work, b.out.samples[first:last])
    row = b.row[first:last]
    done, status = advance(b.core, b.memory, tables, b.step, b.scheme, b.rule, row, b.sampling, out)
    return done * PACKED + status


@separate_kernel
def direct_at(record, first, count):
    """See :func:`implicit_at`."""
    b, last = read(record), first + count
    tables = Tables(b.tables.value[first:last], b.tables.motion[first:last], b.tables.rotation[first:last])
    out = Output(b.out.q, b.out.v, b.out.work, b.out.samples[first:last])
    row = b.row[first:last]
    done, status = advance_explicit(b.core, b.memory, tables, b.step, b.turning, row, b.sampling, out)
    return done * PACKED + status


@intrinsic
def call_at(typing, function, record, first, count):
    """Call the kernel at an address with a record and two numbers."""

    def generate(context, builder, signature, values):
        given = types.voidptr, types.int64, types.int64
        kind = context.call_conv.get_function_type(types.int64, given).as_pointer()
        place = builder.inttoptr(values[0], kind)
        record = builder.inttoptr(values[1], context.get_value_type(types.voidptr))
        call = context.call_conv.call_function
        status, value = call(builder, place, types.int64, given, [record, values[2], values[3]])
        with cgutils.if_unlikely(builder, status.is_error):
            context.call_conv.return_status_propagate(builder, status)
        return value

    return types.int64(types.int64, types.int64, types.int64, types.int64), generate


@kernel
def steps_at(function, record, first, count):
    """The kernel at an address, one for all models: Python calls what takes numbers alone much faster."""
    return call_at(function, record, first, count)


class Quick:
    """Steps of a bundle.

    Parameters
    ----------
    bundle : Implicit or Direct
        Its arrays are read and written in place.
    """

    def __init__(self, bundle: Any) -> None:
        self.bundle = bundle
        kind, context = typeof(bundle), cpu_target.target_context
        size = context.get_abi_sizeof(context.get_data_type(kind))
        self._words = np.zeros(-(-size // 8), dtype=np.int64)
        keep(bundle, self._words)
        dispatcher: Any = implicit_at if isinstance(bundle, Implicit) else direct_at
        signature = (RecordType(kind), types.int64, types.int64)
        dispatcher.compile(signature)
        compiled = dispatcher.overloads[signature]
        address = compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name)
        self._function, self._record = int(address), int(self._words.ctypes.data)
        #: As :meth:`take`, which divides what it returns by PACKED.
        self.step: Any = partial(steps_at, self._function, self._record)

    def take(self, first: int, count: int) -> tuple[int, int]:
        """Take ``count`` steps from row ``first`` on; how many were done, and the status of the last one."""
        done, status = divmod(self.step(first, count), PACKED)
        return done, status


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
    }
