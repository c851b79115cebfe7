"""Records: named tuples as compiled code holds them, at an address.

A kernel that takes a named tuple by value takes every number of every array in it: of a whole system
hundreds, which each function that it is handed on to takes again, and Python hands over one by one.  A
*record* is the same in memory, and kernels take its address.  They read a field where they use it; as no
field changes while the record lives (entries of arrays do), they need not read it twice.
"""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from functools import cached_property
from typing import Any, TypeVar

import numpy as np
from llvmlite import ir
from numba import typeof, types
from numba._dispatcher import compute_fingerprint
from numba.core import cgutils
from numba.core.datamodel import models
from numba.core.typing.templates import AttributeTemplate, infer_getattr
from numba.extending import (
    NativeValue,
    lower_cast,
    lower_getattr_generic,
    register_model,
    typeof_impl,
    unbox,
)

from .arrays import IntArray
from .compiled import formula
from .words import begin_of, spelled

T = TypeVar("T")
F = TypeVar("F", bound=Callable[..., Any])
WORD = ir.IntType(64)


class RecordType(types.Type):
    """Type in kernels of the address of a named tuple of a type."""

    def __init__(self, batch: Any) -> None:
        self.batch = batch
        kind = batch.instance_class
        # names of kernels are made of those of types, which would be thousands of letters long
        text = f"{kind.__module__}.{kind.__qualname__}{batch.fields}{batch}"
        super().__init__(name=f"{kind.__name__}Record{hashlib.sha256(text.encode()).hexdigest()[:16]}")


register_model(RecordType)(models.OpaqueModel)


@lower_cast(RecordType, RecordType)
def _same_address(context: Any, builder: Any, have: Any, want: Any, address: Any) -> Any:
    return address


def beginning(kind: Any) -> Callable[[F], F]:
    """Decorate a formula that takes what records of several kinds begin with: the fields of one kind.

    It is compiled once for all of them, as for a record of that kind, which has the same address.
    """

    def narrower(given: Any) -> Any:
        """Type of such a record, of one that begins so."""
        fields = kind._fields
        if not isinstance(given, RecordType) or given.batch.fields[: len(fields)] != fields:
            return given
        return RecordType(types.NamedTuple(given.batch.types[: len(fields)], kind))

    def narrow(dispatcher: Any) -> None:
        template = dispatcher.get_call_template
        dispatcher.get_call_template = lambda args, kws: template((narrower(args[0]), *args[1:]), kws)

    return lambda function: formula(function, narrow)


_types: dict[Any, Any] = {}
#: Types and kinds of arrays that are told by where they are in memory: no other one may come to be there.
_kinds: list[Any] = []
#: Classes of tuples that kernels take as records.
_recorded: set[type] = set()


def type_of(value: Any) -> Any:
    """Type in kernels of a value; numba's own way asks each array of a tuple anew."""
    return value.numba_type if hasattr(type(value), "numba_type") else _type_of(value)


def _type_of(value: Any) -> Any:
    key = compute_fingerprint(value)
    if key not in _types:
        _types[key] = typeof(value)
    return _types[key]


def recorded(kind: type[T]) -> type[T]:
    """Let kernels take the named tuples of a class as records."""

    def numba_type(value: Any, context: Any) -> RecordType:
        return RecordType(types.NamedTuple([typeof(item) for item in value], made))

    def type_told(value: Any) -> Any:
        """What a type in kernels is looked up by: the kinds of all that a tuple holds."""
        key = made, value.spelled[1]
        if key not in _types:
            hold_kinds(value)
            _types[key] = typeof(value)
        return _types[key]

    about: dict[str, Any] = {
        "__doc__": kind.__doc__,
        "__module__": kind.__module__,
        "__qualname__": kind.__qualname__,
        "__getstate__": lambda value: None,  # addresses are of this process
        "spelled": cached_property(_spelled),
        "address": cached_property(lambda value: begin_of(value.spelled[0])),
        "numba_type": cached_property(type_told),
    }
    made = type(kind.__name__, (kind,), about)
    for name in ("spelled", "address", "numba_type"):
        about[name].__set_name__(made, name)
    typeof_impl.register(made)(numba_type)
    _recorded.add(made)
    return made


@unbox(RecordType)
def _unbox(kind: Any, given: Any, c: Any) -> Any:
    number = c.pyapi.object_getattr_string(given, "address")
    failed = cgutils.is_null(c.builder, number)
    address = cgutils.alloca_once_value(c.builder, c.context.get_constant_null(types.voidptr))
    with c.builder.if_then(c.builder.not_(failed)):
        c.builder.store(c.pyapi.long_as_voidptr(number), address)
        c.pyapi.decref(number)
    return NativeValue(c.builder.load(address), is_error=failed)


class Located:
    """A named tuple for kernels that take it as a record, at an address that holds while this lives."""

    def __init__(self, value: Any) -> None:
        self.value, self._words = value, words_of(value)
        self.address = begin_of(self._words)


@typeof_impl.register(Located)
def _typeof_located(given: Any, context: Any) -> RecordType:
    return RecordType(type_of(given.value))


# --- in Python


def place(value: Any) -> int:
    """Address of a recorded tuple; it holds while the tuple lives."""
    return int(value.address)


def words_of(value: Any) -> IntArray:
    """A named tuple as a record, in an array of words; it holds the addresses of the arrays of the tuple."""
    return _spelled(value)[0]


def words_and_kind(value: Any) -> tuple[IntArray, Any]:
    """The same, and what is equal for tuples of a class whose arrays lie alike and whose other items do."""
    words, signs = _spelled(value)
    return words, (type(value), signs)


def hold_kinds(value: Any) -> None:
    """Keep the types and the kinds of arrays in a tuple, before something is looked up by what tells them."""
    for item in tuple.__iter__(value):  # the fields, whatever a class lets one see
        _kinds.append(type(item))
        if isinstance(item, np.ndarray):
            _kinds.append(item.dtype)
        elif isinstance(item, tuple):
            hold_kinds(item)


def _spelled(value: Any) -> tuple[IntArray, bytes]:
    return spelled(value, _recorded)


# --- in kernels


@infer_getattr
class _Fields(AttributeTemplate):
    key = RecordType

    def generic_resolve(self, record: Any, name: str) -> Any:  # type: ignore[override]
        fields = record.batch.fields
        return record.batch.types[fields.index(name)] if name in fields else None


@lower_getattr_generic(RecordType)
def _getattr(context: Any, builder: Any, record: Any, address: Any, name: str) -> Any:
    before = record.batch.types[: record.batch.fields.index(name)]
    words = builder.bitcast(address, WORD.as_pointer())
    kind = record.batch.types[len(before)]
    return _value(context, builder, kind, words, sum(_length(item) for item in before))[0]


def _length(kind: Any) -> int:
    """Words of a value of a type."""
    if isinstance(kind, types.Array):
        return 1 + 2 * int(kind.ndim)
    return sum(_length(item) for item in _items(kind)) if isinstance(kind, types.BaseTuple) else 1


def _items(kind: Any) -> Any:
    return kind.types


def _word(builder: Any, words: Any, k: int) -> Any:
    """What is at a place, and remains."""
    value = builder.load(builder.gep(words, [ir.Constant(WORD, k)], inbounds=True))
    value.set_metadata("invariant.load", builder.module.add_metadata([]))
    return value


def _value(context: Any, builder: Any, kind: Any, words: Any, k: int) -> tuple[Any, int]:
    """The value of a type from word k on, and the word behind it."""
    if isinstance(kind, types.BaseTuple):
        items = []
        for item in _items(kind):
            value, k = _value(context, builder, item, words, k)
            items.append(value)
        return context.make_tuple(builder, kind, items), k
    if isinstance(kind, types.Array):
        return _array(context, builder, kind, words, k), k + _length(kind)
    word = _word(builder, words, k)
    if isinstance(kind, RecordType):
        word = builder.inttoptr(word, context.get_value_type(kind))
    elif kind is types.float64:
        word = builder.bitcast(word, ir.DoubleType())
    elif kind is types.boolean:
        word = cgutils.is_not_null(builder, word)
    elif kind is not types.int64:
        raise TypeError(f"no record has {kind}")
    return word, k + 1


def _array(context: Any, builder: Any, kind: Any, words: Any, k: int) -> Any:
    """An array; who owns it is nothing to kernels."""
    array, n = context.make_array(kind)(context, builder), kind.ndim
    numbers = [_word(builder, words, k + m) for m in range(1 + 2 * n)]
    array.data = builder.inttoptr(numbers[0], array.data.type)
    array.shape = cgutils.pack_array(builder, numbers[1 : n + 1], ty=WORD)
    array.strides = cgutils.pack_array(builder, numbers[n + 1 :], ty=WORD)
    items = numbers[1]
    for number in numbers[2 : n + 1]:
        items = builder.mul(items, number)
    array.nitems = items
    size = context.get_abi_sizeof(context.get_data_type(kind.dtype))
    array.itemsize = context.get_constant(types.intp, size)
    array.meminfo, array.parent = (ir.Constant(x.type, None) for x in (array.meminfo, array.parent))
    return array._getvalue()
