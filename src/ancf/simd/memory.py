"""Lanes and triples from arrays and back.

A kernel reads the numbers of a chunk of elements as rows of eight, and the unknowns of their nodes through a
table of places, lane by lane.  Where the six unknowns of a node lie side by side, whole nodes are read and
turned from rows to columns in registers instead of number by number.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from llvmlite import ir
from numba import types
from numba.core import cgutils

from .values import DOUBLE, INT, LANES, VECTOR, in_kernels, lanes, parts_of, triple, whole


def load(array: Any, *place: Any) -> Any:
    """The eight numbers of a one-dimensional array from a place on, or a row of an array (..., 8)."""
    return array[place[0] : place[0] + LANES].copy() if array.ndim == 1 else array[place].copy()


def store(value: Any, array: Any, *place: Any) -> None:
    """Write eight numbers to where :func:`load` would take them from."""
    if array.ndim == 1:
        array[place[0] : place[0] + LANES] = value
    else:
        array[place] = value


def load_six(array: Any, place: Any) -> Any:
    """Six numbers of a one-dimensional array from a place on, and two zeros."""
    return np.append(array[place : place + 6], (0.0, 0.0))


def store_six(value: Any, array: Any, place: Any) -> None:
    """Write the first six numbers to a one-dimensional array, from a place on."""
    array[place : place + 6] = value[:6]


def store_columns(a: Any, b: Any, c: Any, d: Any, e: Any, f: Any, array: Any, place: Any) -> None:
    """Write six rows of six numbers column after column to a one-dimensional array, from a place on."""
    array[place : place + 36] = np.stack([x[:6] for x in (a, b, c, d, e, f)], axis=1).ravel()


def gather(x: Any, slots: Any, *place: Any) -> Any:
    """The Triple of x[i], x[i + 1], x[i + 2] for the eight i = slots[place]."""
    return x[slots[place][None] + np.arange(3)[:, None]]


def scatter(value: Any, x: Any, slots: Any, *place: Any) -> None:
    """Add a Triple to where :func:`gather` would take it from, lane after lane."""
    np.add.at(x, slots[place][None] + np.arange(3)[:, None], value)


def put(value: Any, x: Any, slots: Any, *place: Any) -> None:
    """Write a Triple to where :func:`gather` would take it from, lane after lane."""
    for m, i in enumerate(slots[place]):
        x[i : i + 3] = value[:, m]


def gather_nodes(x: Any, slots: Any, *place: Any) -> Any:
    """Two Triples: of x[i], x[i + 1], x[i + 2] and of x[i + 3], x[i + 4], x[i + 5]."""
    return gather(x, slots, *place), gather(x[3:], slots, *place)


def scatter_nodes(first: Any, second: Any, x: Any, slots: Any, *place: Any) -> None:
    """Add two Triples to where :func:`gather_nodes` would take them from."""
    scatter(first, x, slots, *place)
    scatter(second, x[3:], slots, *place)


def put_nodes(first: Any, second: Any, x: Any, slots: Any, *place: Any) -> None:
    """Write two Triples to where :func:`gather_nodes` would take them from, lane after lane."""
    for m, i in enumerate(slots[place]):
        x[i : i + 6] = np.append(first[:, m], second[:, m])


def gather_lanes(x: Any, slots: Any, *place: Any) -> Any:
    """Eight values: the numbers x[i + k] for the eight i = slots[place], k from 0 to 7."""
    return tuple(x[slots[place][None] + np.arange(LANES)[:, None]])


def put_lanes(a: Any, b: Any, c: Any, d: Any, e: Any, f: Any, g: Any, h: Any, x: Any, *place: Any) -> None:
    """Write eight values to where :func:`gather_lanes` would take them from, lane after lane.

    ``place``: the slots, and the place in them.
    """
    slots, *row = place
    for i, values in zip(slots[tuple(row)], np.stack([a, b, c, d, e, f, g, h], axis=1), strict=True):
        x[i : i + LANES] = values


def _is_rows(array: Any, place: Any, dtype: Any = types.float64) -> bool:
    """Whether rows of eight of an array can be taken at a place."""
    fits = isinstance(array, types.Array) and array.dtype == dtype and array.layout == "C"
    return fits and len(place) == max(array.ndim - 1, 1) and all(isinstance(k, types.Integer) for k in place)


def _pointer(context: Any, builder: Any, kind: Any, array: Any, place: Any, kinds: Any) -> Any:
    """To the number of an array at a place, or to the first of a row."""
    made = context.make_array(kind)(context, builder, array)
    numbers = [context.cast(builder, i, k, types.intp) for i, k in zip(place, kinds, strict=True)]
    numbers += [context.get_constant(types.intp, 0)] * (kind.ndim - len(numbers))
    return cgutils.get_item_pointer(context, builder, kind, made, numbers)


@in_kernels(load, lambda array, *place: lanes if _is_rows(array, place) else None)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    pointer = _pointer(context, builder, signature.args[0], arguments[0], arguments[1:], signature.args[1:])
    return builder.load(builder.bitcast(pointer, VECTOR.as_pointer()), align=8)


@in_kernels(
    store, lambda value, array, *place: types.none if value is lanes and _is_rows(array, place) else None
)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    pointer = _pointer(context, builder, signature.args[1], arguments[1], arguments[2:], signature.args[2:])
    builder.store(arguments[0], builder.bitcast(pointer, VECTOR.as_pointer()), align=8)
    return context.get_dummy_value()


@in_kernels(load_six, lambda array, place: lanes if _is_rows(array, (place,)) else None)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    begin = _pointer(context, builder, signature.args[0], arguments[0], arguments[1:], signature.args[1:])
    four = builder.load(_at(builder, begin, 0, 4), align=8)
    two = builder.load(_at(builder, begin, 4, 2), align=8)
    rest = _shuffle(builder, two, ir.Constant(two.type, None), 0, 1, 2, 3)
    return _shuffle(builder, four, rest, *range(LANES))


@in_kernels(
    store_six,
    lambda value, array, place: types.none if value is lanes and _is_rows(array, (place,)) else None,
)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    value, array, place = arguments
    begin = _pointer(context, builder, signature.args[1], array, [place], signature.args[2:])
    builder.store(_shuffle(builder, value, value, 0, 1, 2, 3), _at(builder, begin, 0, 4), align=8)
    builder.store(_shuffle(builder, value, value, 4, 5), _at(builder, begin, 4, 2), align=8)
    return context.get_dummy_value()


def _is_vector(x: Any) -> bool:
    return isinstance(x, types.Array) and (x.dtype, x.ndim, x.layout) == (types.float64, 1, "C")


def _begins(context: Any, builder: Any, kinds: Any, values: Any) -> list[Any]:
    """Pointers to the numbers x[i] of the lanes, for x, slots and a place."""
    slot = _pointer(context, builder, kinds[1], values[1], values[2:], kinds[2:])
    x = context.make_array(kinds[0])(context, builder, values[0])
    first = [builder.load(builder.gep(slot, [INT(m)], inbounds=True)) for m in range(LANES)]
    return [builder.gep(x.data, [i], inbounds=True) for i in first]


@in_kernels(
    gather,
    lambda x, slots, *place: triple if _is_vector(x) and _is_rows(slots, place, types.int64) else None,
)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    parts = [ir.Constant(VECTOR, ir.Undefined)] * 3
    for m, begin in enumerate(_begins(context, builder, signature.args, arguments)):
        for k in range(3):
            number = builder.load(builder.gep(begin, [INT(k)], inbounds=True))
            parts[k] = builder.insert_element(parts[k], number, INT(m))
    return whole(builder, parts)


def _takes(*values: Any) -> Any:
    """Kinds of a function that writes values of these kinds to places of x and returns nothing."""

    def kinds(*given: Any) -> Any:
        n = len(values)
        x, slots, *place = given[n:]
        fits = given[:n] == values and _is_vector(x) and _is_rows(slots, place, types.int64)
        return types.none if fits else None

    return kinds


def _writer(plain: Any, adds: bool) -> None:
    """Compiled form of :func:`scatter` and :func:`put`."""

    @in_kernels(plain, _takes(triple))
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        parts = parts_of(context, builder, triple, arguments[0])
        for m, begin in enumerate(_begins(context, builder, signature.args[1:], arguments[1:])):
            for k in range(3):
                pointer = builder.gep(begin, [INT(k)], inbounds=True)
                number = builder.extract_element(parts[k], INT(m))
                builder.store(builder.fadd(builder.load(pointer), number) if adds else number, pointer)
        return context.get_dummy_value()


_writer(scatter, True)
_writer(put, False)


def _shuffle(builder: Any, x: Any, y: Any, *mask: int) -> Any:
    """The chosen numbers of two LLVM vectors, counted through both."""
    return builder.shuffle_vector(x, y, ir.Constant(ir.VectorType(INT, len(mask)), list(mask)))


#: The first halves and the second halves of two vectors of four.
HALVES = (0, 1, 4, 5), (2, 3, 6, 7)


def _transposed(builder: Any, x: list[Any]) -> list[Any]:
    """Four vectors of four, rows for columns, in eight steps within and across halves of a register."""
    low = [_shuffle(builder, x[k], x[k + 1], 0, 4, 2, 6) for k in (0, 2)]
    high = [_shuffle(builder, x[k], x[k + 1], 1, 5, 3, 7) for k in (0, 2)]
    return [_shuffle(builder, *pair, *half) for half in HALVES for pair in (low, high)]


def _at(builder: Any, begin: Any, k: int, size: int) -> Any:
    """Pointer to a vector of numbers from the k-th on."""
    wanted = ir.VectorType(DOUBLE, size).as_pointer()
    return builder.bitcast(builder.gep(begin, [INT(k)], inbounds=True), wanted)


@in_kernels(
    store_columns,
    lambda *given: (
        types.none if all(x is lanes for x in given[:6]) and _is_rows(given[6], given[7:]) else None
    ),
)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    rows, kinds = arguments[:6], signature.args
    begin = _pointer(context, builder, kinds[6], arguments[6], arguments[7:], kinds[7:])
    fours = [_shuffle(builder, x, x, 0, 1, 2, 3) for x in rows]
    ends = [_shuffle(builder, x, x, 4, 5) for x in rows]
    low = _transposed(builder, fours[:4])
    pairs = [_shuffle(builder, ends[k], ends[k + 1], 0, 2, 1, 3) for k in (0, 2, 4)]
    low += [_shuffle(builder, pairs[0], pairs[1], *half) for half in HALVES]
    high = [_shuffle(builder, fours[4], fours[5], k, k + 4) for k in range(4)]
    high += [_shuffle(builder, pairs[2], pairs[2], *half) for half in ((0, 1), (2, 3))]
    for k, (four, two) in enumerate(zip(low, high, strict=True)):
        builder.store(four, _at(builder, begin, 6 * k, 4), align=8)
        builder.store(two, _at(builder, begin, 6 * k + 4, 2), align=8)
    return context.get_dummy_value()


@in_kernels(
    gather_nodes,
    lambda x, slots, *place: (
        types.UniTuple(triple, 2) if _is_vector(x) and _is_rows(slots, place, types.int64) else None
    ),
)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    begins = _begins(context, builder, signature.args, arguments)
    halves = []
    for four in (begins[:4], begins[4:]):
        rows = _transposed(builder, [builder.load(_at(builder, b, 0, 4), align=8) for b in four])
        ends = [builder.load(_at(builder, b, 4, 2), align=8) for b in four]
        pairs = [_shuffle(builder, ends[k], ends[k + 2], 0, 1, 2, 3) for k in (0, 1)]
        halves.append([*rows, _shuffle(builder, *pairs, 0, 4, 2, 6), _shuffle(builder, *pairs, 1, 5, 3, 7)])
    parts = [_shuffle(builder, a, b, *range(LANES)) for a, b in zip(*halves, strict=True)]
    return context.make_tuple(
        builder, signature.return_type, (whole(builder, parts[:3]), whole(builder, parts[3:]))
    )


#: What is taken of two vectors of eight in three rounds: every other number, then every other pair.
EVEN, ODD = (0, 8, 2, 10, 4, 12, 6, 14), (1, 9, 3, 11, 5, 13, 7, 15)
OUTER, INNER = (0, 1, 4, 5, 8, 9, 12, 13), (2, 3, 6, 7, 10, 11, 14, 15)


def _turned(builder: Any, x: list[Any]) -> list[Any]:
    """Eight vectors of eight, rows for columns."""
    even = [_shuffle(builder, x[k], x[k + 1], *EVEN) for k in (0, 2, 4, 6)]
    odd = [_shuffle(builder, x[k], x[k + 1], *ODD) for k in (0, 2, 4, 6)]
    columns: dict[int, Any] = {}
    for first, four in enumerate((even, odd)):
        for second, mask in enumerate((OUTER, INNER)):
            halves = [_shuffle(builder, four[k], four[k + 1], *mask) for k in (0, 2)]
            for third, own in enumerate((OUTER, INNER)):
                columns[first + 2 * second + 4 * third] = _shuffle(builder, *halves, *own)
    return [columns[k] for k in range(LANES)]


@in_kernels(
    gather_lanes,
    lambda x, slots, *place: (
        types.UniTuple(lanes, LANES) if _is_vector(x) and _is_rows(slots, place, types.int64) else None
    ),
)
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    begins = _begins(context, builder, signature.args, arguments)
    rows = [builder.load(_at(builder, begin, 0, LANES), align=8) for begin in begins]
    return context.make_tuple(builder, signature.return_type, _turned(builder, rows))


@in_kernels(put_lanes, _takes(*[lanes] * LANES))
def _(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    begins = _begins(context, builder, signature.args[LANES:], arguments[LANES:])
    for begin, row in zip(begins, _turned(builder, list(arguments[:LANES])), strict=True):
        builder.store(row, _at(builder, begin, 0, LANES), align=8)
    return context.get_dummy_value()


def _node_writer(plain: Any, adds: bool) -> None:
    """Compiled form of :func:`scatter_nodes` and :func:`put_nodes`."""

    @in_kernels(plain, _takes(triple, triple))
    def generate(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        begins = _begins(context, builder, signature.args[2:], arguments[2:])
        parts = [p for value in arguments[:2] for p in parts_of(context, builder, triple, value)]
        for h in (0, 4):
            half = [_shuffle(builder, p, p, *range(h, h + 4)) for p in parts]
            pairs = [_shuffle(builder, half[4], half[5], *mask) for mask in ((0, 4, 2, 6), (1, 5, 3, 7))]
            ends = [_shuffle(builder, p, p, *k) for k in ((0, 1), (2, 3)) for p in pairs]
            for begin, row, end in zip(begins[h : h + 4], _transposed(builder, half[:4]), ends, strict=True):
                for place, numbers in ((_at(builder, begin, 0, 4), row), (_at(builder, begin, 4, 2), end)):
                    more = builder.fadd(builder.load(place, align=8), numbers) if adds else numbers
                    builder.store(more, place, align=8)
        return context.get_dummy_value()


_node_writer(scatter_nodes, True)
_node_writer(put_nodes, False)
