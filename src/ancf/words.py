"""Where the numbers of arrays are, and how they lie: what NumPy keeps in memory of each, read by a kernel.

To ask an array for its address, its shape and its strides from Python takes longer than a step of a small
model, and a system has hundreds of arrays.  NumPy's C interface says where an array object has them.
"""

from __future__ import annotations

from array import array
from ctypes import string_at
from functools import cache
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from .arrays import IntArray
from .compiled import kernel

#: What NumPy's C interface has behind the head of all objects, 16 bytes: words of an array object.
BEGIN, AXES, SHAPE, STRIDES, KIND, FLAGS = 16, 24, 32, 40, 56, 64
#: Where a list has the address of its items.
LISTED = 24
#: Flags that tell how numbers lie: rows or columns without gaps, aligned, writeable.
LAYOUT = 0x0001 | 0x0002 | 0x0100 | 0x0400
#: Of a whole number with 32 bits.
HALF = 0xFFFFFFFF
#: Most axes of an array in a record, and its most words.
MOST = 7
ROOM = 1 + 2 * MOST


@intrinsic
def word_at(typing, place):
    """The whole number at an address."""

    def generate(context, builder, signature, values):
        return builder.load(builder.inttoptr(values[0], ir.IntType(64).as_pointer()))

    return types.int64(types.int64), generate


@intrinsic
def put_word(typing, place, word):
    """Put a whole number at an address."""

    def generate(context, builder, signature, values):
        builder.store(values[1], builder.inttoptr(values[0], ir.IntType(64).as_pointer()))
        return context.get_dummy_value()

    return types.void(types.int64, types.int64), generate


@kernel
def spell(items, count, number, numbers, out, signs):
    """Write the words of arrays and numbers; how many these are.

    Parameters
    ----------
    items : int
        Address of a list of arrays, with the object at the address ``number`` where there is one.
    count, number : int
    numbers : int
        Address of the numbers, in their order.
    out, signs : int
        Addresses: of the words, and of a word an item, the same for arrays of one kind and layout.
    """
    n, first = 0, word_at(items + LISTED)
    for k in range(count):
        item, sign = word_at(first + 8 * k), 0
        if item == number:
            put_word(out + 8 * n, word_at(numbers))
            numbers += 8
            n += 1
        else:
            axes, shape, strides = word_at(item + AXES) & HALF, word_at(item + SHAPE), word_at(item + STRIDES)
            put_word(out + 8 * n, word_at(item + BEGIN))
            for m in range(axes):
                put_word(out + 8 * (n + 1 + m), word_at(shape + 8 * m))
                put_word(out + 8 * (n + 1 + axes + m), word_at(strides + 8 * m))
            n += 1 + 2 * axes
            layout = word_at(item + FLAGS) & LAYOUT
            sign = word_at(item + KIND) + (layout << 48) + (axes << 60)  # addresses have 47 bits
        put_word(signs + 8 * k, sign)
    return n


class _Room:
    """Where words are written, at an address that is asked for once."""

    def __init__(self, count: int) -> None:
        self.count, self.words = count, np.empty((ROOM + 1) * count, dtype=np.int64)
        self.begin = int(self.words.ctypes.data)
        self.signs = self.begin + 8 * ROOM * count


_room = _Room(64)
_NONE = id(None)


def _read(items: list[Any], numbers: array[int]) -> tuple[IntArray, bytes]:
    global _room
    count = len(items)
    if count > _room.count:
        _room = _Room(2 * count)
    room = _room
    n = spell(id(items), count, _NONE, numbers.buffer_info()[0], room.begin, room.signs)
    return room.words[:n].copy(), string_at(room.signs, 8 * count)


def asked(items: list[Any], numbers: array[int]) -> tuple[IntArray, bytes]:
    """The same as :func:`spelled`, as NumPy tells it."""
    words: list[int] = []
    signs, left = [], iter(numbers)
    for item in items:
        if item is None:
            words.append(next(left))
        else:
            words += [int(item.__array_interface__["data"][0]), *item.shape, *item.strides]
        signs.append(None if item is None else (item.dtype, item.ndim, item.flags.num & LAYOUT))
    return np.array(words, dtype=np.int64), repr(signs).encode()


@cache
def _reads() -> bool:
    """Whether the kernel finds what NumPy tells."""
    if getattr(numba.config, "DISABLE_JIT", 0):
        return False
    cube, seven = np.zeros((3, 4, 5)), array("q", [-7])
    items = [cube, cube[:, ::2].T, None, cube[0, 0], np.arange(3), np.zeros(()), np.zeros((0, 2), dtype=bool)]
    alike, other = ([np.zeros(3), cube], [np.zeros(3, dtype=np.int64), cube])
    same = np.array_equal(_read(items, seven)[0], asked(items, seven)[0])
    return same and _read(alike, seven)[1] != _read(other, seven)[1]


def spelled(items: list[Any], numbers: array[int]) -> tuple[IntArray, bytes]:
    """Words of arrays, each its address, shape and strides, and of numbers; and what tells the arrays' kinds.

    Parameters
    ----------
    items : list of ndarray or None
        Arrays of at most seven axes; None where a number stands.
    numbers : array of "q"
        These, as words.
    """
    return _read(items, numbers) if _reads() else asked(items, numbers)
