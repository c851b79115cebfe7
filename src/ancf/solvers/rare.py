"""Operations of batches that sensitivities or sensors alone ask for; they are compiled when somebody does."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numba import typeof

from .. import addresses
from ..batches import (
    ALONG,
    BESIDE,
    CHANGES,
    CHOICE,
    KEEPING,
    MEASURED,
    MEMORY_BACK,
    MEMORY_WORK,
    METERS,
    NUMBERS,
    OWN_CHANGES,
    PRODUCTS,
    RARE,
    RATES,
    REMEMBERED,
    SLOPES,
    WORKS,
    Batches,
    address_of,
    caller_of,
)
from ..compiled import (
    add_changes,
    add_force_slopes,
    add_measured_work,
    add_memory_changes,
    add_memory_slopes,
    add_number_work,
    add_rate_stiffness,
    add_rate_work,
    add_slopes_beside,
    add_tangent_work,
    add_work_slopes,
    choose_memory,
    inline_kernel,
    remember_along,
    take_measured_slopes,
    take_memory_back,
    take_memory_work,
)

_rate, _numbers = caller_of(add_rate_stiffness), caller_of(add_number_work)
_work, _slopes = caller_of(add_rate_work), caller_of(add_work_slopes)
_along, _beside = caller_of(add_force_slopes), caller_of(add_slopes_beside)
_changes, _products = caller_of(add_changes), caller_of(add_tangent_work)
_choose, _memory_slopes = caller_of(choose_memory), caller_of(add_memory_slopes)
_along_memory, _memory_changes = caller_of(remember_along), caller_of(add_memory_changes)
_memory_work, _memory_back = caller_of(take_memory_work), caller_of(take_memory_back)
_measured, _meters = caller_of(take_measured_slopes), caller_of(add_measured_work)


def knowing(stub: Any, batches: Iterable[Any], *others: Any) -> Batches:
    """Batches whose kinds have an operation, or several, that not all models need."""
    made = Batches(batches)
    for k, batch in enumerate(made):
        for own in (stub, *others):
            made.table[k, RARE[own]] = _place(batch, own)
    return made


def _place(batch: Any, stub: Any) -> int:
    """Address of an operation, which is looked up by what arrays a batch has: numba takes longer for that."""
    key = type(batch), stub, *map(_kind, batch)
    if key not in addresses.found:
        addresses.found[key] = address_of(type(batch), typeof(batch), stub)
    return int(addresses.found[key])


def _kind(field: Any) -> Any:
    array = isinstance(field, np.ndarray)
    return (field.dtype, field.ndim, field.flags.num) if array else type(field)


@inline_kernel
def add_rate_stiffnesses(batches, q, v, S, W, ws):
    """What velocities do to the stiffness of all of the batches, see ``add_rate_stiffness``."""
    table = batches.table
    for k in range(table.shape[0]):
        _rate(table[k, RATES], table[k, 0], (q, v, S, W, ws))


@inline_kernel
def add_rate_works(batches, q, v, x, out, ws):
    """What velocities do to x . force by q of all of the batches, see ``add_rate_work``."""
    table = batches.table
    for k in range(table.shape[0]):
        _work(table[k, WORKS], table[k, 0], (q, v, x, out, ws))


@inline_kernel
def add_tangent_works(batches, q, v, x, by_q, by_v, by_a, ws):
    """Products of the matrices of all of the batches with x, see ``add_tangent_work``."""
    table = batches.table
    for k in range(table.shape[0]):
        _products(table[k, PRODUCTS], table[k, 0], (q, v, x, by_q, by_v, by_a, ws))


@inline_kernel
def add_all_slopes(batches, q, v, a, x, by_q, by_v, by_a, ws):
    """Derivatives of x . force by q, v and a of all of the batches, see ``add_work_slopes``."""
    table = batches.table
    for k in range(table.shape[0]):
        _slopes(table[k, SLOPES], table[k, 0], (q, v, a, x, by_q, by_v, by_a, ws))


@inline_kernel
def add_slopes_along(batches, q, v, a, d, r, ws):
    """Derivatives of the forces of all of the batches along eight directions, see ``add_force_slopes``."""
    table = batches.table
    for k in range(table.shape[0]):
        _along(table[k, ALONG], table[k, 0], (q, v, a, d, r, ws))


@inline_kernel
def add_slopes_beside_all(batches, q, v, a, d, r, ws):
    """What tangents leave out of all of the batches, see ``add_slopes_beside``."""
    table = batches.table
    for k in range(table.shape[0]):
        _beside(table[k, BESIDE], table[k, 0], (q, v, a, d, r, ws))


@inline_kernel
def add_number_work_of(batches, k, q, v, a, x, out, ws):
    """``add_number_work`` of one of the :class:`Batches`."""
    table = batches.table
    _numbers(table[k, NUMBERS], table[k, 0], (q, v, a, x, out, ws))


@inline_kernel
def add_changes_of(batches, k, q, v, a, rates, kinds, begin, out, ws):
    """``add_changes`` of one of the :class:`Batches`."""
    table = batches.table
    _changes(table[k, CHANGES], table[k, 0], (q, v, a, rates, kinds, begin, out, ws))


@inline_kernel
def choose_memory_of(batches, k, q, v, out):
    """``choose_memory`` of one of the :class:`Batches`."""
    table = batches.table
    _choose(table[k, CHOICE], table[k, 0], (q, v, out))


@inline_kernel
def add_memory_slopes_of(batches, k, q, v, z, r, ws):
    """``add_memory_slopes`` of one of the :class:`Batches`."""
    table = batches.table
    _memory_slopes(table[k, REMEMBERED], table[k, 0], (q, v, z, r, ws))


@inline_kernel
def remember_along_of(batches, k, q, v, d, z, ws):
    """``remember_along`` of one of the :class:`Batches`."""
    table = batches.table
    _along_memory(table[k, KEEPING], table[k, 0], (q, v, d, z, ws))


@inline_kernel
def add_memory_changes_of(batches, k, q, v, rates, kinds, begin, out, ws):
    """``add_memory_changes`` of one of the :class:`Batches`."""
    table = batches.table
    _memory_changes(table[k, OWN_CHANGES], table[k, 0], (q, v, rates, kinds, begin, out, ws))


@inline_kernel
def take_memory_work_of(batches, k, q, v, x, z, ws):
    """``take_memory_work`` of one of the :class:`Batches`."""
    table = batches.table
    _memory_work(table[k, MEMORY_WORK], table[k, 0], (q, v, x, z, ws))


@inline_kernel
def take_memory_back_of(batches, k, q, v, z, by_q, by_v, numbers, ws):
    """``take_memory_back`` of one of the :class:`Batches`."""
    table = batches.table
    _memory_back(table[k, MEMORY_BACK], table[k, 0], (q, v, z, by_q, by_v, numbers, ws))


@inline_kernel
def take_measured_slopes_of(batches, k, q, v, dq, dv, out):
    """``take_measured_slopes`` of one of the :class:`Batches`."""
    table = batches.table
    _measured(table[k, MEASURED], table[k, 0], (q, v, dq, dv, out))


@inline_kernel
def add_measured_work_of(batches, k, q, v, y, by_q, by_v):
    """``add_measured_work`` of one of the :class:`Batches`."""
    table = batches.table
    _meters(table[k, METERS], table[k, 0], (q, v, y, by_q, by_v))
