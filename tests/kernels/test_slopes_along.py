"""Derivatives of forces of joints and moments along eight directions, and what of them tangents leave out."""

import numpy as np
import pytest

from ancf.batches import add_forces, add_tangents
from ancf.compiled import add_force_slopes, add_slopes_beside, add_work_slopes, kernel
from ancf.connections.sliding import FREE, FROZEN
from ancf.linalg.eight import lane_rows
from ancf.linalg.sparse import to_sparse
from ancf.solvers.rare import add_all_slopes, add_slopes_along, add_slopes_beside_all, knowing
from ancf.system.system import System
from mechanisms import LEVELS, bare, joints_of, mechanism, moving
from sloped import at_time
from strained import cable, solid, states

MIXED = LEVELS | {"mixed": (0.3, 0.5, 0.2)}
PLACES = ((-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12))
#: Of a step, by which its rates go with positions.
B, G = 0.02, 0.5
SLIDING = {
    "smooth": {},
    "rubs": {"friction": 0.4, "friction_velocity": 2.0},
    "released": {"release": (0.0, 0.6, 0.8)},
}
KINDS = pytest.mark.parametrize("kind", [0, 1], ids=["rows", "slides"])
WEIGHTS = pytest.mark.parametrize("level", MIXED)
WAYS = pytest.mark.parametrize("way", SLIDING)


@kernel
def along(batches, q, v, a, d, r, ws):
    add_slopes_along(batches, q, v, a, d, r, ws)


@kernel
def beside(batches, q, v, a, d, r, ws):
    add_slopes_beside_all(batches, q, v, a, d, r, ws)


@kernel
def works(batches, q, v, a, x, by_q, by_v, by_a, ws):
    add_all_slopes(batches, q, v, a, x, by_q, by_v, by_a, ws)


@kernel
def forces(batches, q, v, a, r, ws):
    add_forces(batches, q, v, a, r, ws)


@kernel
def tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws):
    add_tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws)


def lanes(size, seed=3):
    """Eight random directions (3, size, 8)."""
    d = lane_rows(3 * size).reshape(3, size, 8)
    d[...] = np.random.default_rng(seed).uniform(-1, 1, d.shape)
    return d


def derived(system, kind, d, operation=along):
    batches = knowing(add_force_slopes, [joints_of(system)[kind]], add_slopes_beside)
    r = lane_rows(system.size)
    operation(batches, *moving(system), d, r, system.core.ws)
    return r


@KINDS
@WEIGHTS
@WAYS
@pytest.mark.parametrize("mode", [None, FROZEN, FREE])
def test_against_differences(kind, level, way, mode):
    system = bare(mechanism("free", **SLIDING[way]))
    system.level[:] = MIXED[level]
    d = lanes(system.size)
    if mode is not None:  # s does not change then
        slides = joints_of(system)[1]
        slides.mode[:] = mode
        d[:, slides.unknown + 3] = 0.0
    batches = knowing(add_force_slopes, [joints_of(system)[kind]])
    states, found = moving(system), derived(system, kind, d)
    for k in range(8):
        wanted = np.zeros(system.size)
        for place, weight in PLACES:
            r = np.zeros(system.size)
            moved = [x + 1e-3 * place * y for x, y in zip(states, d[..., k], strict=True)]
            forces(batches, *moved, r, system.core.ws)
            wanted += weight / 1e-3 * r
        assert np.max(np.abs(found[:, k] - wanted)) < 1e-8 * max(1.0, np.max(np.abs(wanted)))


@KINDS
@WEIGHTS
@WAYS
def test_is_the_transposed_of_the_slopes_of_work(kind, level, way):
    """To round-off: x . (T d) = (T^T x) . d."""
    system = bare(mechanism("free", **SLIDING[way]))
    system.level[:] = MIXED[level]
    d, x = lanes(system.size), np.random.default_rng(5).uniform(-1, 1, system.size)
    found, by = derived(system, kind, d), np.zeros((3, system.size))
    batches = knowing(add_work_slopes, [joints_of(system)[kind]])
    works(batches, *moving(system), x, *by, system.core.ws)
    assert x @ found == pytest.approx(np.einsum("ki,kin->n", by, d), rel=1e-12, abs=1e-12)


@KINDS
@WEIGHTS
@WAYS
def test_what_the_tangent_leaves_out(kind, level, way):
    """With the tangent, and rates as of a step, it is the whole derivative."""
    system = bare(mechanism("fixed", **SLIDING[way]))
    w = np.array(MIXED[level])
    system.level[:] = w / (w @ (1.0, G / B, 1.0 / B))
    d = lanes(system.size)
    d[0, system.n :] = 0.0
    d[1], d[2] = G / B * d[0], d[0] / B
    d[1:, system.multipliers] = 0.0
    batch, A, (q, v, _) = joints_of(system)[kind], np.zeros_like(system.core.A), moving(system)
    tangents(knowing(add_force_slopes, [batch]), q, v, A, 1.0 / B, G / B, 1.0, system.core.ws)
    kept = to_sparse(A, system.places) @ d[0, : system.n]
    found = derived(system, kind, d) - derived(system, kind, d, beside)
    assert np.max(np.abs(found[: system.n] - kept)) < 1e-11 * np.max(np.abs(found))
    assert not np.any(found[system.n :])


def turned(element, seed):
    """A beam under moments that change, in a strained state; the system, the batch of them and the state."""
    model, beam = cable("material", 3, "curved") if element == "cable" else solid(element, "curved")
    for place, moment in ((beam.end, (0.3, "2*t", -1.2)), (beam.at(0.55), (1.1, 0.2, 0.7))):
        model.add_moment(place, moment)
    system = System(model)
    given = states(system, seed)[:3]
    at_time(system, 0.37, given)
    return system, system.parts[next(name for name in system.parts if "moment" in name)], given


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
def test_of_moments(element, seed):
    """As the slopes of their work have it, which differences check elsewhere, and as the tangent has it."""
    system, batch, given = turned(element, seed)
    d, x = lanes(system.size), np.random.default_rng(5).uniform(-1, 1, system.size)
    found, rest, by = lane_rows(system.size), lane_rows(system.size), np.zeros((3, system.size))
    batches = knowing(add_force_slopes, [batch], add_slopes_beside, add_work_slopes)
    along(batches, *given, d, found, system.core.ws)
    works(batches, *given, x, *by, system.core.ws)
    assert x @ found == pytest.approx(np.einsum("ki,kin->n", by, d), rel=1e-12, abs=1e-12)
    beside(batches, *given, d, rest, system.core.ws)
    A = np.zeros_like(system.core.A)
    tangents(batches, *given[:2], A, 0.0, 0.0, 1.0, system.core.ws)
    kept = to_sparse(A, system.places) @ d[0, : system.n]
    assert np.max(np.abs(found[: system.n] - rest[: system.n] - kept)) < 1e-12 * np.max(np.abs(found))
    assert np.max(np.abs(rest)) > 0.01 * np.max(np.abs(found))
