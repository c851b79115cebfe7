"""Tuples of batches as all kernels take them, whatever kinds are in them, and what is done with each in turn.

A kernel that is given a plain tuple of batches is compiled for its kinds, with all that their operations do:
half a minute for each new combination.  :class:`Batches` is one type for all combinations.  It has a table
of addresses: where a batch lies as a record (the named tuple as compiled code holds it), and where its
operations are.  These are compiled once for each kind, and the kernels once for all models; an operation that
does nothing costs nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

import numpy as np
from numba import literal_unroll, typeof, types
from numba.core import cgutils
from numba.core.errors import TypingError
from numba.extending import intrinsic, overload, typeof_impl
from numpy.typing import NDArray

from . import addresses
from .addresses import call_at, pointer
from .compiled import (
    PART,
    add_changes,
    add_force,
    add_force_slopes,
    add_inertia,
    add_measured_work,
    add_memory_changes,
    add_memory_slopes,
    add_number_work,
    add_rate_stiffness,
    add_rate_work,
    add_slopes_beside,
    add_tangent,
    add_tangent_work,
    add_work_slopes,
    choose_memory,
    does_something,
    find_event,
    inline_kernel,
    inverted,
    measure,
    remember,
    remember_along,
    strain_energy,
    take_measured_slopes,
    take_memory_back,
    take_memory_work,
)
from .operations import OPERATIONS
from .records import RecordType, hold_kinds, words_and_kind
from .words import begin_of

_COLUMNS = 1 + len(OPERATIONS)
_NONE = np.zeros((0, _COLUMNS), dtype=np.int64)
FORCE, INERTIA, TANGENT, ENERGY, EVENT, INVERTED, MEASURE, REMEMBER = range(1, 9)
RATES, NUMBERS, WORKS, SLOPES, ALONG, BESIDE, CHANGES, PRODUCTS = range(9, 17)
CHOICE, REMEMBERED, KEEPING, OWN_CHANGES, MEMORY_WORK, MEMORY_BACK, MEASURED, METERS = range(17, _COLUMNS)
#: Operations compiled for those who ask for them, see :mod:`ancf.solvers.rare`, and their columns.
RARE = {
    measure: MEASURE,
    add_rate_stiffness: RATES,
    add_number_work: NUMBERS,
    add_rate_work: WORKS,
    add_work_slopes: SLOPES,
    add_force_slopes: ALONG,
    add_slopes_beside: BESIDE,
    add_changes: CHANGES,
    add_tangent_work: PRODUCTS,
    choose_memory: CHOICE,
    add_memory_slopes: REMEMBERED,
    remember_along: KEEPING,
    add_memory_changes: OWN_CHANGES,
    take_memory_work: MEMORY_WORK,
    take_memory_back: MEMORY_BACK,
    take_measured_slopes: MEASURED,
    add_measured_work: METERS,
}


class _Table(NamedTuple):
    table: NDArray[np.int64]  # (batches, 1 + operations) addresses: of the record, of its operations, 0: none


class Batches(_Table):
    """Batches as kernels take them; in Python a tuple of the batches, in compiled code the table alone."""

    _batches: tuple[Any, ...]
    _records: list[NDArray[np.int64]]

    def __new__(cls, batches: Iterable[Any] = ()) -> Batches:
        """From batches of any kinds."""
        kept = tuple(batches)
        if not kept:
            self = super().__new__(cls, _NONE)
            self._batches, self._records = (), []
            return self
        rows = [_row(batch) for batch in kept]
        numbers = [(begin_of(words), *found) for words, found in rows]
        self = super().__new__(cls, np.array(numbers, dtype=np.int64).reshape(len(rows), _COLUMNS))
        self._batches, self._records = kept, [words for words, _ in rows]
        return self

    def __iter__(self) -> Iterator[Any]:
        return iter(self._batches)

    def __bool__(self) -> bool:
        return bool(self._batches)

    def __len__(self) -> int:
        return len(self._batches)

    def __getitem__(self, k: Any) -> Any:
        return self._batches[k]

    def __contains__(self, batch: Any) -> bool:
        return any(batch is mine for mine in self._batches)

    def __repr__(self) -> str:
        return f"Batches({', '.join(type(batch).__name__ for batch in self._batches)})"

    def __reduce__(self) -> Any:
        return Batches, (self._batches,)  # addresses are of this process


_TYPE = types.NamedTuple((types.Array(types.int64, 2, "C"),), Batches)


@typeof_impl.register(Batches)
def _typeof(batches, context):
    return _TYPE


def _row(batch: Any) -> tuple[NDArray[np.int64], tuple[int, ...]]:
    """The record of a batch and the addresses of its operations; of an empty one none is compiled."""
    if len(batch[0]) == 0:
        return np.zeros(1, dtype=np.int64), (0,) * len(OPERATIONS)
    words, key = words_and_kind(batch)
    if key not in addresses.found:
        hold_kinds(batch)
        kind = typeof(batch)
        places = tuple(0 if stub in RARE else address_of(type(batch), kind, stub) for stub in OPERATIONS)
        addresses.found[key] = places
    return words, addresses.found[key]


def address_of(batch_type: type, kind: Any, stub: Any) -> int:
    """Address of an operation of a kind of batch, which is compiled, or taken from the cache; 0 for none."""
    if not does_something(batch_type, stub):
        return 0
    dispatcher, given, result = OPERATIONS[stub]
    return addresses.address_of(dispatcher, (RecordType(kind), *given), result)


def caller_of(stub: Any, nothing: Any = None) -> Any:
    """Intrinsic ``call(place, record, arguments)`` of an operation; `nothing` where its address is 0."""
    _, given, result = OPERATIONS[stub]

    @intrinsic
    def call(typing, place, record, arguments):
        if not all(_fits(have, want) for have, want in zip(arguments, given, strict=True)):
            raise TypingError(f"{stub.__name__} takes {given}, not {tuple(arguments)}")

        def generate(context, builder, signature, values):
            place, record, packed = values
            items = [
                item if isinstance(want, types.Array) else context.cast(builder, item, have, want)
                for item, have, want in zip(
                    cgutils.unpack_tuple(builder, packed), arguments, given, strict=True
                )
            ]
            out = None
            if nothing is not None:
                out = cgutils.alloca_once_value(builder, context.get_constant(result, nothing))
            with builder.if_then(cgutils.is_not_null(builder, place)):
                pointer = builder.inttoptr(record, context.get_value_type(types.voidptr))
                value = call_at(context, builder, place, [pointer, *items], (types.voidptr, *given), result)
                if out is not None:
                    builder.store(value, out)
            return context.get_dummy_value() if out is None else builder.load(out)

        return result(types.int64, types.int64, arguments), generate

    return call


def _fits(have: Any, want: Any) -> bool:
    """Whether an argument can be given: a vector without gaps, or any number for a number."""
    if isinstance(want, types.Array):
        return isinstance(have, types.Array) and (have.dtype, have.ndim, have.layout) == (
            want.dtype,
            want.ndim,
            want.layout,
        )
    return isinstance(have, types.Number)


_force, _inertia, _tangent = caller_of(add_force), caller_of(add_inertia), caller_of(add_tangent)
_energy, _event, _inverted = caller_of(strain_energy, 0.0), caller_of(find_event, -1), caller_of(inverted, -1)
_measure, _remember = caller_of(measure), caller_of(remember)


def _each(of_tuple: Callable[..., Any], of_batches: Callable[..., Any], default: Any = None) -> Any:
    """Kernel whose first argument are batches, as a plain tuple or as :class:`Batches`."""

    def stub(batches, *arguments):
        raise TypeError("only in compiled code")

    def nothing(batches, *arguments):
        return default

    @overload(stub, jit_options=PART, strict=False)
    def _choose(batches, *arguments):
        return of_batches if batches is _TYPE else (of_tuple if len(batches) else nothing)

    return stub


def _forces_of_tuple(batches, q, v, a, r, ws):
    for batch in literal_unroll(batches):
        add_force(batch, q, v, a, r, ws)


def _forces(batches, q, v, a, r, ws):
    table = batches.table
    for k in range(table.shape[0]):
        _force(table[k, FORCE], table[k, 0], (q, v, a, r, ws))


def _inertias_of_tuple(batches, a, r, ws):
    for batch in literal_unroll(batches):
        add_inertia(batch, a, r, ws)


def _inertias(batches, a, r, ws):
    table = batches.table
    for k in range(table.shape[0]):
        _inertia(table[k, INERTIA], table[k, 0], (a, r, ws))


def _tangents_of_tuple(batches, q, v, A, c_mass, c_damping, c_stiffness, ws):
    for batch in literal_unroll(batches):
        add_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws)


def _tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws):
    table = batches.table
    for k in range(table.shape[0]):
        _tangent(table[k, TANGENT], table[k, 0], (q, v, A, c_mass, c_damping, c_stiffness, ws))


def _energies_of_tuple(batches, q, ws):
    energy = 0.0
    for batch in literal_unroll(batches):
        energy += strain_energy(batch, q, ws)
    return energy


def _energies(batches, q, ws):
    energy, table = 0.0, batches.table
    for k in range(table.shape[0]):
        energy += _energy(table[k, ENERGY], table[k, 0], (q, ws))
    return energy


def _events_of_tuple(batches, q):
    code = -1
    for batch in literal_unroll(batches):
        if code < 0:
            code = find_event(batch, q)
    return code


def _events(batches, q):
    code, table = -1, batches.table
    for k in range(table.shape[0]):
        if code < 0:
            code = _event(table[k, EVENT], table[k, 0], (q,))
    return code


def _inverted_of_tuple(batches, q, ws):
    slot = -1
    for batch in literal_unroll(batches):
        found = inverted(batch, q, ws)
        if found >= 0:
            slot = found
    return slot


def _inverted_of_batches(batches, q, ws):
    slot, table = -1, batches.table
    for k in range(table.shape[0]):
        found = _inverted(table[k, INVERTED], table[k, 0], (q, ws))
        if found >= 0:
            slot = found
    return slot


def _measures_of_tuple(batches, q, v):
    for batch in literal_unroll(batches):
        measure(batch, q, v)


def _measures(batches, q, v):
    table = batches.table
    for k in range(table.shape[0]):
        _measure(table[k, MEASURE], table[k, 0], (q, v))


def _remembered_by_tuple(batches, q, v):
    for batch in literal_unroll(batches):
        remember(batch, q, v)


def _remembered(batches, q, v):
    table = batches.table
    for k in range(table.shape[0]):
        _remember(table[k, REMEMBER], table[k, 0], (q, v))


@inline_kernel
def record_at(batches, k):
    """The record of one of the :class:`Batches`, for a kernel that is called by its address."""
    return pointer(batches.table[k, 0])


@inline_kernel
def add_force_of(batches, k, q, v, a, r, ws):
    """``add_force`` of one of the :class:`Batches`."""
    table = batches.table
    _force(table[k, FORCE], table[k, 0], (q, v, a, r, ws))


#: The operations, of all batches in turn: see :mod:`ancf.compiled`.
add_forces = _each(_forces_of_tuple, _forces)
add_inertias = _each(_inertias_of_tuple, _inertias)
add_tangents = _each(_tangents_of_tuple, _tangents)
measure_all = _each(_measures_of_tuple, _measures)
remember_all = _each(_remembered_by_tuple, _remembered)
#: Sum of all strain energies, J.
strain_energies = _each(_energies_of_tuple, _energies, 0.0)
#: Code of the first event, or -1.
find_events = _each(_events_of_tuple, _events, -1)
#: The last slot that ``inverted`` gives, or -1.
last_inverted = _each(_inverted_of_tuple, _inverted_of_batches, -1)
