"""Steps one by one that cost little more than the steps: all that a kernel takes lies ready as a record.

To hand a run's hundreds of arrays to a kernel takes many times as long as a step of a small model.  So they
are written into a record once (:mod:`ancf.batches`), with room for the functions of time of many steps, and
a step is a call with the address of the record and the number of its row.
"""

from __future__ import annotations

from functools import partial
from typing import Any, NamedTuple

import numpy as np
from numba import types
from numpy.typing import NDArray

from ..addresses import address_of, caller, pointer
from ..compiled import kernel, separate_kernel
from ..records import recorded, type_of
from ..system.core import Core, Tables
from .apart import Apart
from .block import take_explicit, take_implicit
from .newmark import Rule
from .sampling import Output, Sampling
from .status import OK
from .step.memory import Memory
from .step.scheme import Scheme

#: Factor of the number of steps in what kernels return, where a status is smaller; one step that went well.
PACKED = 1 << 32
DONE = PACKED + OK


@recorded
class Implicit(NamedTuple):
    """All that :func:`ancf.solvers.newmark.advance` takes."""

    steps: int  # address
    core: Core
    memory: Memory
    tables: Tables
    step: float
    scheme: Scheme
    rule: Rule
    row: NDArray[np.int64]  # (rows,) -1: no states are kept
    sampling: Sampling
    out: Output
    apart: Apart


@recorded
class Direct(NamedTuple):
    """The same of :func:`ancf.solvers.explicit.steps.advance_explicit`."""

    steps: int  # address
    core: Core
    memory: Memory
    tables: Tables
    step: float
    turning: bool
    row: NDArray[np.int64]
    sampling: Sampling
    out: Output
    apart: Apart


@separate_kernel
def implicit_at(record, first, count):
    """Steps from ``first`` on, of the tables; how many were done and the status of the last one, packed."""
    b, last = record, first + count
    tables = Tables(b.tables.value[first:last], b.tables.motion[first:last], b.tables.rotation[first:last])
    out = Output(b.out.q, b.out.v, b.out.work, b.out.samples[first:last])
    row = b.row[first:last]
    given = b.core, b.memory, tables, b.step, b.scheme, b.rule, row, b.sampling, out, b.apart
    done, status = take_implicit(b.steps, given)
    return done * PACKED + status


@separate_kernel
def direct_at(record, first, count):
    """See :func:`implicit_at`."""
    b, last = record, first + count
    tables = Tables(b.tables.value[first:last], b.tables.motion[first:last], b.tables.rotation[first:last])
    out = Output(b.out.q, b.out.v, b.out.work, b.out.samples[first:last])
    row = b.row[first:last]
    given = b.core, b.memory, tables, b.step, b.turning, row, b.sampling, out, b.apart
    done, status = take_explicit(b.steps, given)
    return done * PACKED + status


_steps = caller(types.int64, (types.voidptr, types.int64, types.int64))


@kernel
def steps_at(function, record, first, count):
    """The kernel at an address, one for all models: Python calls what takes numbers alone much faster."""
    return _steps(function, (pointer(record), first, count))


class Quick:
    """Steps of a bundle.

    Parameters
    ----------
    bundle : Implicit or Direct
        Its arrays are read and written in place.
    """

    def __init__(self, bundle: Any) -> None:
        self.bundle = bundle
        dispatcher: Any = implicit_at if isinstance(bundle, Implicit) else direct_at
        function = address_of(dispatcher, (type_of(bundle), types.int64, types.int64), types.int64)
        #: As :meth:`take`, which divides what it returns by PACKED.
        self.step: Any = partial(steps_at, function, bundle.address)

    def take(self, first: int, count: int) -> tuple[int, int]:
        """Take ``count`` steps from row ``first`` on; how many were done, and the status of the last one."""
        done, status = divmod(self.step(first, count), PACKED)
        return done, status


def shared(run: Any, rows: int) -> dict[str, Any]:
    """What both bundles have, of a :class:`ancf.solvers.stepping.Run`, with room for so many steps."""
    system = run.system
    now = system.inputs.tables(run.t_start, run.h, 1, run.t_start, run.t_end)
    return {
        "steps": run.kernels[0],
        "core": system.core,
        "memory": run.memory,
        "tables": Tables(*(np.zeros((rows, *x.shape[1:])) for x in now)),
        "step": run.h,
        "row": np.full(rows, -1, dtype=np.int64),
        "sampling": run.sampling,
        "out": run.room(0, rows),
        "apart": run.kernels[1],
    }
