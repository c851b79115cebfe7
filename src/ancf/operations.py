"""The operations of :mod:`ancf.compiled` as kernels on the record of a batch, which have addresses."""

from __future__ import annotations

from typing import Any

from numba import types

from .compiled import (
    VECTOR,
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
    find_event,
    inverted,
    measure,
    remember,
    remember_along,
    separate_kernel,
    strain_energy,
    take_measured_slopes,
    take_memory_back,
    take_memory_work,
)


@separate_kernel
def force_at(record, q, v, a, r, ws):
    """``add_force`` of the batch at an address."""
    add_force(record, q, v, a, r, ws)


@separate_kernel
def inertia_at(record, a, r, ws):
    """``add_inertia`` of the batch at an address."""
    add_inertia(record, a, r, ws)


@separate_kernel
def tangent_at(record, q, v, A, c_mass, c_damping, c_stiffness, ws):
    """``add_tangent`` of the batch at an address."""
    add_tangent(record, q, v, A, c_mass, c_damping, c_stiffness, ws)


@separate_kernel
def energy_at(record, q, ws):
    """``strain_energy`` of the batch at an address."""
    return 1.0 * strain_energy(record, q, ws)


@separate_kernel
def event_at(record, q):
    """``find_event`` of the batch at an address."""
    return find_event(record, q)


@separate_kernel
def inverted_at(record, q, ws):
    """``inverted`` of the batch at an address."""
    return inverted(record, q, ws)


@separate_kernel
def measure_at(record, q, v):
    """``measure`` of the batch at an address."""
    measure(record, q, v)


@separate_kernel
def remember_at(record, q, v):
    """``remember`` of the batch at an address."""
    remember(record, q, v)


@separate_kernel
def rate_stiffness_at(record, q, v, S, W, ws):
    """``add_rate_stiffness`` of the batch at an address."""
    add_rate_stiffness(record, q, v, S, W, ws)


@separate_kernel
def rate_work_at(record, q, v, x, out, ws):
    """``add_rate_work`` of the batch at an address."""
    add_rate_work(record, q, v, x, out, ws)


@separate_kernel
def work_slopes_at(record, q, v, a, x, by_q, by_v, by_a, ws):
    """``add_work_slopes`` of the batch at an address."""
    add_work_slopes(record, q, v, a, x, by_q, by_v, by_a, ws)


@separate_kernel
def force_slopes_at(record, q, v, a, d, r, ws):
    """``add_force_slopes`` of the batch at an address."""
    add_force_slopes(record, q, v, a, d, r, ws)


@separate_kernel
def slopes_beside_at(record, q, v, a, d, r, ws):
    """``add_slopes_beside`` of the batch at an address."""
    add_slopes_beside(record, q, v, a, d, r, ws)


@separate_kernel
def number_work_at(record, q, v, a, x, out, ws):
    """``add_number_work`` of the batch at an address."""
    add_number_work(record, q, v, a, x, out, ws)


@separate_kernel
def changes_at(record, q, v, a, rates, kinds, begin, out, ws):
    """``add_changes`` of the batch at an address."""
    add_changes(record, q, v, a, rates, kinds, begin, out, ws)


@separate_kernel
def memory_choice_at(record, q, v, out):
    """``choose_memory`` of the batch at an address."""
    choose_memory(record, q, v, out)


@separate_kernel
def memory_slopes_at(record, q, v, z, r, ws):
    """``add_memory_slopes`` of the batch at an address."""
    add_memory_slopes(record, q, v, z, r, ws)


@separate_kernel
def memory_along_at(record, q, v, d, z, ws):
    """``remember_along`` of the batch at an address."""
    remember_along(record, q, v, d, z, ws)


@separate_kernel
def memory_changes_at(record, q, v, rates, kinds, begin, out, ws):
    """``add_memory_changes`` of the batch at an address."""
    add_memory_changes(record, q, v, rates, kinds, begin, out, ws)


@separate_kernel
def memory_work_at(record, q, v, x, z, ws):
    """``take_memory_work`` of the batch at an address."""
    take_memory_work(record, q, v, x, z, ws)


@separate_kernel
def memory_back_at(record, q, v, z, by_q, by_v, numbers, ws):
    """``take_memory_back`` of the batch at an address."""
    take_memory_back(record, q, v, z, by_q, by_v, numbers, ws)


@separate_kernel
def measured_slopes_at(record, q, v, dq, dv, out):
    """``take_measured_slopes`` of the batch at an address."""
    take_measured_slopes(record, q, v, dq, dv, out)


@separate_kernel
def measured_work_at(record, q, v, y, by_q, by_v):
    """``add_measured_work`` of the batch at an address."""
    add_measured_work(record, q, v, y, by_q, by_v)


@separate_kernel
def tangent_work_at(record, q, v, x, by_q, by_v, by_a, ws):
    """``add_tangent_work`` of the batch at an address."""
    add_tangent_work(record, q, v, x, by_q, by_v, by_a, ws)


_V, _x = VECTOR, types.float64
_PLACES = types.Array(types.int64, 1, "C")
_LANES, _VECTORS = types.Array(_x, 2, "C"), types.Array(_x, 3, "C")
#: Kernels of the operations on a record, the types of what they take besides it, and what they return.
OPERATIONS: dict[Any, tuple[Any, tuple[Any, ...], Any]] = {
    add_force: (force_at, (_V, _V, _V, _V, _V), types.none),
    add_inertia: (inertia_at, (_V, _V, _V), types.none),
    add_tangent: (tangent_at, (_V, _V, _V, _x, _x, _x, _V), types.none),
    strain_energy: (energy_at, (_V, _V), types.float64),
    find_event: (event_at, (_V,), types.int64),
    inverted: (inverted_at, (_V, _V), types.int64),
    measure: (measure_at, (_V, _V), types.none),
    remember: (remember_at, (_V, _V), types.none),
    add_rate_stiffness: (rate_stiffness_at, (_V, _V, _V, _V, _V), types.none),
    add_number_work: (number_work_at, (_V, _V, _V, _V, _V, _V), types.none),
    add_rate_work: (rate_work_at, (_V, _V, _V, _V, _V), types.none),
    add_work_slopes: (work_slopes_at, (_V, _V, _V, _V, _V, _V, _V, _V), types.none),
    add_force_slopes: (force_slopes_at, (_V, _V, _V, _VECTORS, _LANES, _V), types.none),
    add_slopes_beside: (slopes_beside_at, (_V, _V, _V, _VECTORS, _LANES, _V), types.none),
    add_changes: (changes_at, (_V, _V, _V, _V, _PLACES, _PLACES, _V, _V), types.none),
    add_tangent_work: (tangent_work_at, (_V, _V, _V, _V, _V, _V, _V), types.none),
    choose_memory: (memory_choice_at, (_V, _V, _V), types.none),
    add_memory_slopes: (memory_slopes_at, (_V, _V, _LANES, _LANES, _V), types.none),
    remember_along: (memory_along_at, (_V, _V, _VECTORS, _LANES, _V), types.none),
    add_memory_changes: (memory_changes_at, (_V, _V, _V, _PLACES, _PLACES, _V, _V), types.none),
    take_memory_work: (memory_work_at, (_V, _V, _V, _V, _V), types.none),
    take_memory_back: (memory_back_at, (_V, _V, _V, _V, _V, _V, _V), types.none),
    take_measured_slopes: (measured_slopes_at, (_V, _V, _V, _V, _V), types.none),
    add_measured_work: (measured_work_at, (_V, _V, _V, _V, _V), types.none),
}
