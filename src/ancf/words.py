"""Named tuples as words: what Python and NumPy keep in memory of their items, read by a kernel.

To ask an array for its address, its shape and its strides from Python takes longer than a step of a small
model, and a system has hundreds of arrays.  C interfaces say where objects have what is asked: one call of a
kernel goes through a tuple with all that it holds.
"""

from __future__ import annotations

import ctypes
import sys
from ctypes import string_at
from functools import cache
from struct import Struct
from typing import Any

import numba
import numpy as np
from llvmlite import ir
from numba import types
from numba.extending import intrinsic

from .arrays import IntArray
from .compiled import kernel

#: Where objects have their type, and those with a length this; numbers have their value there.
KIND, LENGTH = object.__basicsize__ - 8, object.__basicsize__
#: Where tuples have their items, and whole numbers their digits.
ITEMS, DIGITS = tuple.__basicsize__, LENGTH + 8
#: A whole number has its sign and count of digits in one word, or counts negative ones below zero.
TAGGED = sys.version_info >= (3, 12)
#: What NumPy's C interface has behind the head of all objects, 16 bytes: words of an array object.
BEGIN, AXES, SHAPE, STRIDES, SORT, FLAGS = 16, 24, 32, 40, 56, 64
#: Flags that tell how numbers lie: rows or columns without gaps, aligned, writeable.
LAYOUT = 0x0001 | 0x0002 | 0x0100 | 0x0400
#: Of a word with 64 bits, and of a whole number's digit.
HALF, BITS = 0xFFFFFFFF, 30

#: What items are.
ARRAY, WORD, WHOLE, TUPLE, RECORD = range(5)
#: There is no room, or an item is of a kind that is not known.
SMALL, UNKNOWN = -1, -2
#: Plain tuples one in the other, records, and items in the room of a kernel.
DEEP, RECORDS, SIGNS = 16, 256, 2048


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
def whole(item):
    """The whole number in an object."""
    count = word_at(item + LENGTH)
    negative = (count & 3) == 2 if TAGGED else count < 0
    count = count >> 3 if TAGGED else abs(count)
    number = 0
    for k in range(count):
        digit = word_at(item + DIGITS + 8 * (k >> 1)) >> (32 * (k & 1)) & HALF
        number |= digit << (BITS * k)
    return -number if negative else number


@kernel
def put_array(item, out, n, most):
    """Write the words of an array from word n on, as far as there is room; how many these are."""
    axes = word_at(item + AXES) & HALF
    if n + 1 + 2 * axes <= most:
        shape, strides = word_at(item + SHAPE), word_at(item + STRIDES)
        put_word(out + 8 * n, word_at(item + BEGIN))
        for m in range(axes):
            put_word(out + 8 * (n + 1 + m), word_at(shape + 8 * m))
            put_word(out + 8 * (n + 1 + axes + m), word_at(strides + 8 * m))
    return 1 + 2 * axes


@kernel
def role_of(kind, roles, count):
    """What items of a type are."""
    for k in range(count):
        if word_at(roles + 16 * k) == kind:
            return word_at(roles + 16 * k + 8)
    return UNKNOWN


@kernel
def spell(value, roles, known, out, most, room):
    """Write the words of a named tuple, and those of recorded ones in it behind them.

    Parameters
    ----------
    value : int
        Address of the tuple.
    roles, known : int
        Address of what items of types are, and how many types.
    out, most : int
        Address of the words, and how many there is room for.
    room : int
        Address of words for this kernel: see :class:`_Room`.

    Returns
    -------
    tuple of int
        Words, of which those within ``most`` were written, SMALL or UNKNOWN; and signs, the same for tuples
        whose items are of the same kinds and whose arrays lie alike.
    """
    waiting, signs = room + 16 * DEEP, room + 16 * (DEEP + RECORDS)
    n, m, records, record = 0, 0, 1, 0
    put_word(waiting, value)
    while record < records:
        if record > 0 and word_at(waiting + 16 * record + 8) < most:
            put_word(out + 8 * word_at(waiting + 16 * record + 8), out + 8 * n)
        depth = 0
        put_word(room, word_at(waiting + 16 * record))
        put_word(room + 8, 0)
        record += 1
        while depth >= 0:
            within, k = word_at(room + 16 * depth), word_at(room + 16 * depth + 8)
            if k == word_at(within + LENGTH):
                depth -= 1
                continue
            put_word(room + 16 * depth + 8, k + 1)
            item = word_at(within + ITEMS + 8 * k)
            sign = word_at(item + KIND)
            role = role_of(sign, roles, known)
            if role == UNKNOWN:
                return UNKNOWN, m
            if m + 2 > SIGNS or depth + 1 == DEEP or records == RECORDS:
                return SMALL, m
            if role == ARRAY:
                layout, axes = word_at(item + FLAGS) & LAYOUT, word_at(item + AXES) & HALF
                sign = word_at(item + SORT) + (layout << 48) + (axes << 60)  # addresses have 47 bits
                n += put_array(item, out, n, most)
            elif role == TUPLE:
                depth += 1
                put_word(room + 16 * depth, item)
                put_word(room + 16 * depth + 8, 0)
                put_word(signs + 8 * m, word_at(item + LENGTH))
                m += 1
            else:
                if role == RECORD:
                    put_word(waiting + 16 * records, item)
                    put_word(waiting + 16 * records + 8, n)
                    records += 1
                elif n < most:
                    put_word(out + 8 * n, whole(item) if role == WHOLE else word_at(item + LENGTH))
                n += 1
            put_word(signs + 8 * m, sign)
            m += 1
    return n, m


class _Room:
    """Where a kernel notes tuples that it is within, records that are to come, and signs."""

    def __init__(self) -> None:
        self.words = np.empty(2 * DEEP + 2 * RECORDS + SIGNS, dtype=np.int64)
        self.begin = asked_begin(self.words)
        self.signs = self.begin + 16 * (DEEP + RECORDS)


class _Roles:
    """What items of types are; the types stay, since they are told by where they are in memory."""

    def __init__(self) -> None:
        self.types: list[type] = []
        self.table = np.empty((0, 2), dtype=np.int64)
        self.begin = 0

    def learn(self, value: Any, recorded: set[type]) -> bool:
        """Learn of all items; False if there is one that a kernel cannot read."""
        for item in tuple.__iter__(value):
            role = _role(type(item), recorded)
            if role is None:
                return False
            if role in (TUPLE, RECORD) and not self.learn(item, recorded):
                return False
            if type(item) not in self.types:
                self.types.append(type(item))
                self.table = np.vstack([self.table, [id(type(item)), role]])
                self.begin = asked_begin(self.table)
        return True


def _role(kind: type, recorded: set[type]) -> int | None:
    if kind is np.ndarray:
        return ARRAY
    if kind in recorded:
        return RECORD
    if issubclass(kind, tuple):
        return TUPLE
    if kind in (float, np.float64, np.int64):
        return WORD
    return WHOLE if kind in (int, bool) else None


def asked_begin(array: Any) -> int:
    """Address of the numbers of an array, from where NumPy tells it."""
    return int(array.__array_interface__["data"][0])


def looked_up(array: Any) -> int:
    """The same from where NumPy's C interface has it, behind what all objects have: seven times as fast."""
    begin: int = _number(id(array) + BEGIN).value
    return begin


_number: Any = ctypes.c_ssize_t.from_address
_sample = np.zeros(3)
#: Address of the numbers of an array.
begin_of = looked_up if looked_up(_sample) == asked_begin(_sample) else asked_begin

_room, _roles = _Room(), _Roles()
#: Words that the last tuple of a class had.
_lengths: dict[type, int] = {}


def _read(value: Any, recorded: set[type]) -> tuple[IntArray, bytes]:
    length = _lengths.get(type(value), 64)
    while True:
        words = np.empty(length, dtype=np.int64)
        n, m = spell(id(value), _roles.begin, len(_roles.types), begin_of(words), length, _room.begin)
        if n == length:
            return words, string_at(_room.signs, 8 * m)
        if n == SMALL or (n == UNKNOWN and not _roles.learn(value, recorded)):
            return asked(value, recorded)
        if n >= 0:
            _lengths[type(value)] = length = n


_DOUBLE, _INTEGER = Struct("d"), Struct("q")


def asked(value: Any, recorded: set[type]) -> tuple[IntArray, bytes]:
    """The same as :func:`spelled`, as Python and NumPy tell it."""
    words: list[int] = []
    signs: list[Any] = []
    waiting: list[tuple[Any, int]] = [(value, -1)]
    begins = [(place, _ask(record, recorded, words, signs, waiting)) for record, place in waiting]
    made = np.array(words, dtype=np.int64)
    for place, begin in begins[1:]:
        made[place] = begin_of(made) + 8 * begin
    return made, repr(signs).encode()


def _ask(
    value: Any, recorded: set[type], words: list[int], signs: list[Any], waiting: list[tuple[Any, int]]
) -> int:
    """Add the items of a tuple; the word at which they begin."""
    begin = len(words)
    for item in tuple.__iter__(value):  # the fields, whatever a class lets one see
        kind = type(item)
        if kind is np.ndarray:
            words += [asked_begin(item), *item.shape, *item.strides]
            signs.append((item.dtype, item.ndim, item.flags.num & LAYOUT))
        elif isinstance(item, tuple) and kind not in recorded:
            signs.append((id(kind), tuple.__len__(item)))
            _ask(item, recorded, words, signs, waiting)
        else:
            signs.append(id(kind))
            if kind in recorded:
                waiting.append((item, len(words)))
            real = isinstance(item, float)
            words.append(0 if kind in recorded else _bits(item) if real else int(item))
    return begin


def _bits(number: float) -> int:
    bits: int = _INTEGER.unpack(_DOUBLE.pack(number))[0]
    return bits


@cache
def _reads() -> bool:
    """Whether the kernel finds what Python and NumPy tell."""
    if getattr(numba.config, "DISABLE_JIT", 0) or sys.int_info.bits_per_digit != BITS:
        return False
    cube = np.zeros((3, 4, 5))
    arrays = cube, cube[:, ::2].T, cube[0, 0], np.arange(3), np.zeros(()), np.zeros((0, 2), dtype=bool)
    numbers = 0, -7, 1 << 29, -(1 << 30), (1 << 46) + 5, True, False, 2.5, np.float64(-1e300), np.int64(-3)
    items = (*arrays, numbers, ((), (1, (2.0,))))
    alike, other = (np.zeros(3), cube), (np.zeros(3, dtype=np.int64), cube)
    same = np.array_equal(_read(items, set())[0], asked(items, set())[0])
    return same and _read(alike, set())[1] != _read(other, set())[1]


def spelled(value: Any, recorded: set[type]) -> tuple[IntArray, bytes]:
    """Words of a tuple, and what tells the kinds of all that it holds.

    Of an array these are its address, shape and strides, of plain tuples those of their items, of a recorded
    one its address; its own words stand behind.

    Parameters
    ----------
    value : tuple
        Of arrays of any type, numbers and tuples of such.
    recorded : set of type
        Classes of tuples that are records.
    """
    return _read(value, recorded) if _reads() else asked(value, recorded)
