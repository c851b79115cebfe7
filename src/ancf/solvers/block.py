"""Blocks of steps as Python asks for them: by addresses, as handing over hundreds of arrays takes longer."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import types

from .. import addresses
from ..addresses import caller, pointer
from ..compiled import kernel
from ..records import type_of
from ..system.core import Core, Tables
from .apart import Apart, apart_of, needed, show_far_at, strands_of
from .explicit.steps import advance_explicit
from .newmark import Rule, advance
from .sampling import Output, Sampling
from .step.memory import Memory
from .step.scheme import Scheme

#: What a block of steps returns: how many were done, and the status of the last one.
BLOCK = types.UniTuple(types.int64, 2)
_TABLES = type_of(Tables(np.zeros((0, 0, 3)), np.zeros((0, 0, 3)), np.zeros((0, 0, 3, 3, 3))))
_KEPT, _OUT = types.Array(types.int64, 1, "C"), type_of(Output.of(0, 0, 0, 0))
_SCHEME, _APART = type_of(Scheme(0.0, 0.0, 0.0, 0.0)), type_of(Apart(*[0] * len(Apart._fields)))
_RULE = type_of(Rule(0.0, 0.0, 0, True, True, 0.0, 0.0, 0.0, True, 0.0, 0, 0))


def implicit_types(
    core: Any, memory: Any, sampling: Any, scheme: Any = _SCHEME, rule: Any = _RULE, apart: Any = _APART
) -> tuple[Any, ...]:
    """Of what :func:`ancf.solvers.newmark.advance` takes, with these of the records."""
    return core, memory, _TABLES, types.float64, scheme, rule, _KEPT, sampling, _OUT, apart


def explicit_types(core: Any, memory: Any, sampling: Any, apart: Any = _APART) -> tuple[Any, ...]:
    """The same of :func:`ancf.solvers.explicit.steps.advance_explicit`."""
    return core, memory, _TABLES, types.float64, types.boolean, _KEPT, sampling, _OUT, apart


#: Call steps by their address.
take_implicit = caller(BLOCK, implicit_types(*6 * (types.voidptr,)))
take_explicit = caller(BLOCK, explicit_types(*4 * (types.voidptr,)))


@kernel
def implicit_block(steps, core, memory, tables, h, scheme, rule, keep, sampling, out, apart):
    """Call :func:`ancf.solvers.newmark.advance`; all but tables, h, keep and out are addresses."""
    core, memory, sampling = pointer(core), pointer(memory), pointer(sampling)
    scheme, rule, apart = pointer(scheme), pointer(rule), pointer(apart)
    return take_implicit(steps, (core, memory, tables, h, scheme, rule, keep, sampling, out, apart))


@kernel
def explicit_block(steps, core, memory, tables, h, turning, keep, sampling, out, apart):
    """The same for :func:`ancf.solvers.explicit.steps.advance_explicit`."""
    core, memory, sampling, apart = pointer(core), pointer(memory), pointer(sampling), pointer(apart)
    return take_explicit(steps, (core, memory, tables, h, turning, keep, sampling, out, apart))


@kernel
def show_at(function, core, memory, whole):
    """Call :func:`ancf.solvers.sleeping.far.show_far` by its address, with those of core and memory."""
    show_far_at(function, (pointer(core), pointer(memory), whole))


def stepping(core: Core, memory: Memory, sampling: Sampling, explicit: bool) -> tuple[Any, tuple[Any, ...]]:
    """The kernel that takes steps, and the types of what it takes."""
    return _stepping((type_of(core), type_of(memory), type_of(sampling)), explicit)


def _stepping(given: tuple[Any, ...], explicit: bool) -> tuple[Any, tuple[Any, ...]]:
    return (advance_explicit, explicit_types(*given)) if explicit else (advance, implicit_types(*given))


def kernels_of(core: Core, memory: Memory, sampling: Sampling, explicit: bool) -> tuple[int, Apart]:
    """Addresses of the kernel that takes steps and of those that it calls; what is missing is compiled."""
    given = type_of(core), type_of(memory), type_of(sampling)
    wanted = needed(core, memory, sampling, explicit)
    strands = strands_of(core)
    key = given, wanted, strands
    if key not in addresses.found:
        apart = apart_of(*given, wanted, strands)
        addresses.found[key] = addresses.address_of(*_stepping(given, explicit), BLOCK), apart
    steps, apart = addresses.found[key]
    return steps, apart
