"""Derivatives of the work of forces of a batch by the state, against differences; models in fluids."""

import numpy as np

import ancf
from ancf.batches import Batches, add_tangents
from ancf.compiled import add_force_slopes, add_slopes_beside, add_work_slopes, does_something, kernel
from ancf.linalg.eight import lane_rows
from ancf.linalg.sparse import to_sparse
from ancf.solvers.rare import add_all_slopes, add_slopes_along, add_slopes_beside_all, knowing
from ancf.system.core import drive, residual

PLACES = ((-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12))


@kernel
def slopes(batches, q, v, a, x, by_q, by_v, by_a, ws):
    add_all_slopes(batches, q, v, a, x, by_q, by_v, by_a, ws)


@kernel
def along(batches, q, v, a, d, r, ws):
    add_slopes_along(batches, q, v, a, d, r, ws)


@kernel
def beside(batches, q, v, a, d, r, ws):
    add_slopes_beside_all(batches, q, v, a, d, r, ws)


@kernel
def tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws):
    add_tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws)


@kernel
def driven(supports, value, tables, q, v, a):
    drive(supports, value, tables, 0, q, v, a)


def at_time(system, t, states):
    """Let inputs be those of a time."""
    tables = system.inputs.tables(t - 1e-3, 1e-3, 1, 0.0, np.inf)
    driven(system.core.supports, system.core.loads.value, tables, *states)


def work_of(batch, system, states, x):
    """x . force, with nothing kept."""
    r = np.empty(system.size)
    if hasattr(batch, "kept"):
        batch.kept[...] = np.inf
    residual(Batches([batch]), system.core.ws, *states, np.zeros(system.size), r)
    return x @ r


def found_slopes(batch, system, states, x):
    """By q, v and a, (3, size)."""
    found = np.zeros((3, system.size))
    slopes(knowing(add_work_slopes, [batch]), *states, x, *found, system.core.ws)
    return found


def check_transposed(batch, system, states, x, by):
    """The slopes along eight random directions are those of the work, to round-off."""
    size, rng = system.size, np.random.default_rng(5)
    d, found = lane_rows(3 * size).reshape(3, size, 8), lane_rows(size)
    d[...] = rng.uniform(-1, 1, d.shape)
    along(knowing(add_force_slopes, [batch]), *states, d, found, system.core.ws)
    terms = np.sum(np.abs(by)) + np.abs(x) @ np.max(np.abs(found), axis=1)
    assert np.max(np.abs(x @ found - np.einsum("ki,kin->n", by, d))) <= 1e-13 * terms


def force_along(batch, system, states, d):
    """Derivatives of the force along directions d (3, size, 8)."""
    found = lane_rows(system.size)
    along(knowing(add_force_slopes, [batch]), *states, d, found, system.core.ws)
    return found


def check_along(system, name, states, step=1e-6, share=1e-9, seed=5):
    """Of a batch along eight random directions, against differences of order four; their largest entry."""
    batch, size = system.parts[name], system.size
    d = lane_rows(3 * size).reshape(3, size, 8)
    d[...] = np.random.default_rng(seed).uniform(-1, 1, d.shape)
    wanted, r, most = np.zeros((size, 8)), np.empty(size), 0.0
    for lane in range(8):
        for place, weight in PLACES:
            near = [y + step * place * d[n, :, lane] for n, y in enumerate(states)]
            residual(Batches([batch]), system.core.ws, *near, np.zeros(size), r)
            wanted[:, lane] += weight / step * r
            most = max(most, np.max(np.abs(r)))
    found, largest = force_along(batch, system, states, d), np.max(np.abs(wanted))
    assert np.max(np.abs(found - wanted)) <= share * largest + 1e-14 * most / step
    return largest


def check_beside(system, name, states, rate=300.0):
    """Rates that go with the directions: all is the tangent's and what is beside it; that, of all."""
    batch, size = system.parts[name], system.size
    d, rest = lane_rows(3 * size).reshape(3, size, 8), lane_rows(size)
    d[...] = np.random.default_rng(7).uniform(-1, 1, d.shape)
    d[1] = rate * d[0]
    found = force_along(batch, system, states, d)
    beside(knowing(add_force_slopes, [batch], add_slopes_beside), *states, d, rest, system.core.ws)
    A = np.zeros_like(system.core.A)
    tangents(Batches([batch]), *states[:2], A, 0.0, rate, 1.0, system.core.ws)
    n, largest = system.n, np.max(np.abs(found))
    kept = to_sparse(A, system.places) @ d[0, :n]
    assert np.max(np.abs((found - rest)[:n] - kept)) < 1e-12 * largest
    return np.max(np.abs(rest)) / largest


def check_slopes(system, name, states, x, step=1e-3, share=1e-9):
    """Of a batch by every unknown; the largest derivatives by q, v and a."""
    batch, sizes = system.parts[name], []
    found = found_slopes(batch, system, states, x)
    for n, made in enumerate(found):
        wanted = np.zeros(system.size)
        for i in range(system.size):
            for place, weight in PLACES:
                near = [y.copy() for y in states]
                near[n][i] += step * place
                wanted[i] += weight / step * work_of(batch, system, near, x)
        size = np.max(np.abs(wanted))
        round_off = 1e-14 * abs(work_of(batch, system, states, x)) / step
        assert np.max(np.abs(made - wanted)) <= share * size + round_off, n
        sizes.append(size)
    if does_something(type(batch), add_force_slopes):
        check_transposed(batch, system, states, x, found)
    return sizes


WAVES = {
    "deep": {"spectrum": "regular", "height": 0.6, "period": 2.5, "ramp": 4.0, "direction": 0.4},
    "shallow": {"spectrum": "jonswap", "height": 0.4, "period": 3.0, "depth": 3.0, "components": 20},
    "unstretched": {"spectrum": "regular", "height": 0.5, "period": 3.0, "depth": 8.0, "stretching": "none"},
}
SPEEDS = {
    "still": (0.0, 0.0, 0.0),
    "steady": (0.7, "0.2*sin(3*t)", 0.1),
    "sheared": {"z": [-3.0, -0.4, 2.0], "velocity": [[0.1, 0, 0.2], [0.8, 0.3, 0.1], [1.2, 0, -0.2]]},
    "formulas": ("0.5*sin(x - t)*exp(0.3*z)", "0.2*y + 0.1*x*z", "0.3*cos(y + z + 2*t)"),
}
GUSTS = {"speed": 9.0, "deviation": 2.0, "length": 30.0, "extent": (-2.0, 6.0), "spacing": 0.8}
GUSTS |= {"line": (1.0, 0.3, 0.0), "direction": 0.3, "duration": 20.0, "ramp": 3.0}


def of_hull(**more):
    """A section that fluids know."""
    hull = {"diameter": 0.12, "drag": (1.2, 0.1), "added_mass": (1.0, 0.3)}
    return ancf.Section(EA=4e3, EI=20.0, rhoA=3.0, **hull, **more)


def afloat(elements=3, lift=0.0, section=None, buoy=True, **fluid):
    """A cable that pierces a surface at z = 0, unless it lies lower, and perhaps a point mass, in a fluid."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    ends = {"start": (0.0, 0.0, lift - 1.6), "end": (1.5, 0.4, lift + 0.5)}
    rope = model.add_beam("rope", elements=elements, section=section or of_hull(), **ends)
    model.pin(rope.start)
    if buoy:
        own = {"mass": 2.0, "volume": 2e-3, "drag_area": 0.02, "added_mass": 0.5}
        ball = model.add_point_mass("buoy", at=ends["end"], **own)
        model.connect(ball, rope.end)
    model.add_fluid("sea", density=1025.0, **fluid)
    return model


def in_waves(kind, elements=3, **more):
    """The same in waves."""
    return afloat(elements, below=0.02, waves=WAVES[kind], **more)


def under_gusts(**more):
    """In waves, and above them in gusty air."""
    model = in_waves("deep", **more)
    model.add_fluid("air", density=1.3, above=0.02, velocity=(9.0, 1.0, 0.0), gusts=GUSTS)
    return model
