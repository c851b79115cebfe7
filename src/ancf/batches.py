"""Tuples of batches as all kernels take them, whatever kinds are in them, and what is done with each in turn.

A kernel that is given a plain tuple of batches is compiled for its kinds, with all that their operations do:
half a minute for each new combination.  :class:`Batches` is one type for all combinations.  It has a table
of addresses: where a batch lies and where its operations are.  These are compiled once for each kind, and the
kernels once for all models; an operation that does nothing costs nothing.

Table, 64-bit numbers: how many batches, then for each the address of its record (the named tuple as compiled
code holds it) and those of its operations in the order of :data:`OPERATIONS`, 0 for none.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from llvmlite import ir
from numba import literal_unroll, types
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.errors import TypingError
from numba.core.registry import cpu_target
from numba.core.typing.typeof import Purpose, _TypeofContext
from numba.extending import NativeValue, intrinsic, overload, register_model, typeof_impl, unbox

from .compiled import (
    PART,
    add_force,
    add_inertia,
    add_tangent,
    does_something,
    find_event,
    inverted,
    kernel,
    measure,
    separate_kernel,
    strain_energy,
)

VECTOR = types.Array(types.float64, 1, "C")


class BatchesType(types.Type):
    """Type of all :class:`Batches` in kernels: the address of the table."""

    def __init__(self) -> None:
        super().__init__(name="Batches")


class RecordType(types.Type):
    """Type in kernels of the address of a batch of a type."""

    def __init__(self, batch: Any) -> None:
        self.batch = batch
        super().__init__(name=f"Record({batch})")


register_model(BatchesType)(models.OpaqueModel)
register_model(RecordType)(models.OpaqueModel)


@intrinsic
def write(typing, batch, words):
    """Write a batch as a record into an array of words."""

    def generate(context, builder, signature, arguments):
        place = context.make_array(signature.args[1])(context, builder, arguments[1]).data
        place = builder.bitcast(place, context.get_data_type(batch).as_pointer())
        context.pack_value(builder, batch, arguments[0], place)
        return context.get_dummy_value()

    return types.none(batch, words), generate


@intrinsic
def read(typing, record):
    """The batch at an address."""

    def generate(context, builder, signature, arguments):
        place = builder.bitcast(arguments[0], context.get_data_type(record.batch).as_pointer())
        return context.unpack_value(builder, record.batch, place)

    return record.batch(record), generate


@kernel
def keep(batch, words):
    """See :func:`write`."""
    write(batch, words)


@separate_kernel
def force_at(record, q, v, a, r, ws):
    """``add_force`` of the batch at an address."""
    add_force(read(record), q, v, a, r, ws)


@separate_kernel
def inertia_at(record, a, r, ws):
    """``add_inertia`` of the batch at an address."""
    add_inertia(read(record), a, r, ws)


@separate_kernel
def tangent_at(record, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """``add_tangent`` of the batch at an address."""
    add_tangent(read(record), q, v, A, c_mass, c_damping, c_stiffness, ws)


@separate_kernel
def energy_at(record, q, ws):
    """``strain_energy`` of the batch at an address."""
    return 1.0 * strain_energy(read(record), q, ws)


@separate_kernel
def event_at(record, q):
    """``find_event`` of the batch at an address."""
    return find_event(read(record), q)


@separate_kernel
def inverted_at(record, q, ws):
    """``inverted`` of the batch at an address."""
    return inverted(read(record), q, ws)


@separate_kernel
def measure_at(record, q, v):
    """``measure`` of the batch at an address."""
    measure(read(record), q, v)


_V, _x = VECTOR, types.float64
#: Kernels that apply an operation to the batch at an address, the types of what they take besides, and return.
OPERATIONS: dict[Any, tuple[Any, tuple[Any, ...], Any]] = {
    add_force: (force_at, (_V, _V, _V, _V, _V), types.none),
    add_inertia: (inertia_at, (_V, _V, _V), types.none),
    add_tangent: (tangent_at, (_V, _V, _V, _x, _x, _x, _V), types.none),
    strain_energy: (energy_at, (_V, _V), types.float64),
    find_event: (event_at, (_V,), types.int64),
    inverted: (inverted_at, (_V, _V), types.int64),
    measure: (measure_at, (_V, _V), types.none),
}
_ROW = 1 + len(OPERATIONS)


class Batches(tuple[Any, ...]):
    """Batches as kernels take them; in Python a tuple.

    Attributes
    ----------
    address : int
        Of the table, which lives as long as this object.
    """

    address: int

    def __new__(cls, batches: Iterable[Any] = ()) -> Batches:
        """From batches of any kinds."""
        self = super().__new__(cls, batches)
        records = [_record(batch) for batch in self]
        numbers = [len(records), *(n for words, found in records for n in (words.ctypes.data, *found))]
        table = np.array(numbers, dtype=np.int64)
        self._kept = table, records
        self.address = table.ctypes.data
        return self

    def __reduce__(self) -> Any:
        return Batches, (tuple(self),)  # the table is of this process


_BATCHES = BatchesType()
_compiled: dict[Any, tuple[int, tuple[int, ...]]] = {}


def _record(batch: Any) -> tuple[Any, tuple[int, ...]]:
    """The record of a batch and the addresses of its operations."""
    kind = typeof_impl(batch, _TypeofContext(Purpose.argument))
    if kind not in _compiled:
        context = cpu_target.target_context
        size = context.get_abi_sizeof(context.get_data_type(kind))
        _compiled[kind] = -(-size // 8), tuple(_address(type(batch), kind, stub) for stub in OPERATIONS)
    length, found = _compiled[kind]
    words = np.zeros(length, dtype=np.int64)
    keep(batch, words)
    return words, found


def _address(batch_type: type, kind: Any, stub: Any) -> int:
    """Address of an operation of a kind of batch, which is compiled, or taken from the cache; 0 for none."""
    if not does_something(batch_type, stub):
        return 0
    dispatcher, given, _ = OPERATIONS[stub]
    signature = (RecordType(kind), *given)
    dispatcher.compile(signature)
    compiled = dispatcher.overloads[signature]
    return int(compiled.library.get_pointer_to_function(compiled.fndesc.llvm_func_name))


@typeof_impl.register(Batches)
def _typeof(batches, context):
    return _BATCHES


@unbox(BatchesType)
def _unbox(kind, batches, c):
    number = c.pyapi.object_getattr_string(batches, "address")
    address = c.pyapi.long_as_voidptr(number)
    c.pyapi.decref(number)
    return NativeValue(address, is_error=c.pyapi.c_api_error())


_WORD = ir.IntType(64)
_ZERO, _ONE = ir.Constant(_WORD, 0), ir.Constant(_WORD, 1)


def _number(builder, table, place):
    """A number of the table."""
    return builder.load(builder.gep(builder.bitcast(table, _WORD.as_pointer()), [place]))


@intrinsic
def number_of(typing, batches):
    """How many batches there are."""

    def generate(context, builder, signature, arguments):
        return _number(builder, arguments[0], _ZERO)

    return types.int64(batches), generate


@overload(len)
def _length(batches):
    if isinstance(batches, BatchesType):
        return lambda batches: number_of(batches)
    return None


def _caller(stub: Any, nothing: Any = None) -> Any:
    """Intrinsic ``call(batches, k, arguments)``: an operation of batch k; `nothing` where it does nothing."""
    column = ir.Constant(_WORD, 2 + list(OPERATIONS).index(stub))
    _, given, result = OPERATIONS[stub]

    @intrinsic
    def call(typing, batches, k, arguments):
        if not all(_fits(have, want) for have, want in zip(arguments, given, strict=True)):
            raise TypingError(f"{stub.__name__} takes {given}, not {tuple(arguments)}")

        def generate(context, builder, signature, values):
            table, k, packed = values
            row = builder.mul(k, ir.Constant(_WORD, _ROW))
            record, place = (_number(builder, table, builder.add(row, c)) for c in (_ONE, column))
            items = [
                item if isinstance(want, types.Array) else context.cast(builder, item, have, want)
                for item, have, want in zip(
                    cgutils.unpack_tuple(builder, packed), arguments, given, strict=True
                )
            ]
            if nothing is None:
                with builder.if_then(builder.icmp_unsigned("!=", place, _ZERO)):
                    _call(context, builder, place, record, items, given, result)
                return context.get_dummy_value()
            out = cgutils.alloca_once_value(builder, context.get_constant(result, nothing))
            with builder.if_then(builder.icmp_unsigned("!=", place, _ZERO)):
                builder.store(_call(context, builder, place, record, items, given, result), out)
            return builder.load(out)

        return result(batches, types.int64, arguments), generate

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


def _call(context, builder, place, record, items, given, result):
    """Call the kernel at an address with a record and other arguments."""
    signature = types.voidptr, *given
    function = builder.inttoptr(place, context.call_conv.get_function_type(result, signature).as_pointer())
    record = builder.inttoptr(record, context.get_value_type(types.voidptr))
    call = context.call_conv.call_function
    status, value = call(builder, function, result, signature, [record, *items])
    with cgutils.if_unlikely(builder, status.is_error):
        context.call_conv.return_status_propagate(builder, status)
    return value


_force, _inertia, _tangent = _caller(add_force), _caller(add_inertia), _caller(add_tangent)
_energy, _event, _inverted = _caller(strain_energy, 0.0), _caller(find_event, -1), _caller(inverted, -1)
_measure = _caller(measure)


def _each(of_tuple: Callable[..., Any], of_batches: Callable[..., Any], default: Any = None) -> Any:
    """Kernel whose first argument are batches, as a plain tuple or as :class:`Batches`."""

    def stub(batches, *arguments):
        raise TypeError("only in compiled code")

    def nothing(batches, *arguments):
        return default

    @overload(stub, jit_options=PART, strict=False)
    def _choose(batches, *arguments):
        if isinstance(batches, BatchesType):
            return of_batches
        return of_tuple if len(batches) else nothing

    return stub


def _forces_of_tuple(batches, q, v, a, r, ws):
    for batch in literal_unroll(batches):
        add_force(batch, q, v, a, r, ws)


def _forces(batches, q, v, a, r, ws):
    for k in range(number_of(batches)):
        _force(batches, k, (q, v, a, r, ws))


def _inertias_of_tuple(batches, a, r, ws):
    for batch in literal_unroll(batches):
        add_inertia(batch, a, r, ws)


def _inertias(batches, a, r, ws):
    for k in range(number_of(batches)):
        _inertia(batches, k, (a, r, ws))


def _tangents_of_tuple(batches, q, v, A, c_mass, c_damping, c_stiffness, ws):
    for batch in literal_unroll(batches):
        add_tangent(batch, q, v, A, c_mass, c_damping, c_stiffness, ws)


def _tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws):
    for k in range(number_of(batches)):
        _tangent(batches, k, (q, v, A, c_mass, c_damping, c_stiffness, ws))


def _energies_of_tuple(batches, q, ws):
    energy = 0.0
    for batch in literal_unroll(batches):
        energy += strain_energy(batch, q, ws)
    return energy


def _energies(batches, q, ws):
    energy = 0.0
    for k in range(number_of(batches)):
        energy += _energy(batches, k, (q, ws))
    return energy


def _events_of_tuple(batches, q):
    code = -1
    for batch in literal_unroll(batches):
        if code < 0:
            code = find_event(batch, q)
    return code


def _events(batches, q):
    code = -1
    for k in range(number_of(batches)):
        if code < 0:
            code = _event(batches, k, (q,))
    return code


def _inverted_of_tuple(batches, q, ws):
    slot = -1
    for batch in literal_unroll(batches):
        found = inverted(batch, q, ws)
        if found >= 0:
            slot = found
    return slot


def _inverted_of_batches(batches, q, ws):
    slot = -1
    for k in range(number_of(batches)):
        found = _inverted(batches, k, (q, ws))
        if found >= 0:
            slot = found
    return slot


def _measures_of_tuple(batches, q, v):
    for batch in literal_unroll(batches):
        measure(batch, q, v)


def _measures(batches, q, v):
    for k in range(number_of(batches)):
        _measure(batches, k, (q, v))


#: The operations, of all batches in turn: see :mod:`ancf.compiled`.
add_forces = _each(_forces_of_tuple, _forces)
add_inertias = _each(_inertias_of_tuple, _inertias)
add_tangents = _each(_tangents_of_tuple, _tangents)
measure_all = _each(_measures_of_tuple, _measures)
#: Sum of all strain energies, J.
strain_energies = _each(_energies_of_tuple, _energies, 0.0)
#: Code of the first event, or -1.
find_events = _each(_events_of_tuple, _events, -1)
#: The last slot that ``inverted`` gives, or -1.
last_inverted = _each(_inverted_of_tuple, _inverted_of_batches, -1)
