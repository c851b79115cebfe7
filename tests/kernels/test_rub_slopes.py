"""Derivatives of friction on surfaces, and of what it remembers, against differences."""

from itertools import product

import numpy as np
import pytest
from test_ground_slopes import B, G, agree, change, choose, differences, force, keep, lanes, operate, tangents
from test_surface_kernels import KINDS, beside, shaken

from ancf.compiled import (
    add_changes,
    add_force_slopes,
    add_memory_changes,
    add_memory_slopes,
    add_slopes_beside,
    choose_memory,
    remember_along,
    traits,
)
from ancf.contact.rub_along import OWN
from ancf.contact.touch import FRICTION
from ancf.linalg.eight import lane_rows
from ancf.linalg.sparse import to_sparse
from ancf.solvers.rare import knowing
from ancf.system.system import System
from helpers import some

#: Arrays of a memory with derivatives.
ARRAYS = "anchor", "limit", "before"
SHAPES = pytest.mark.parametrize("kind", ["cylinder", "sphere", "torus", "sheave", "mesh"])
BODIES = pytest.mark.parametrize("on", [False, True], ids=["ground", "body"])
FRICTIONS = pytest.mark.parametrize("friction", some([0.001, 0.02, 0.4, 50.0]))
#: What slips drags its anchor along, or the damper alone pulls beyond the limit.
DAMPINGS = pytest.mark.parametrize("damping", [0.5, 50.0])


def lying(kind, on, friction, damping=50.0, seed=4, drifts=True):
    """A beam that rubs on a surface, which moves with a body where it is on one.

    System, the batch as it does a step, the state and the memory: it remembers some steps, sticks in some
    points and slips in others, with what is chosen for these.
    """
    system = System(beside(KINDS[kind], on=on, depth=0.003, damping=damping, friction=friction))
    q, v = shaken(system, 2e-4, seed)
    rng = np.random.default_rng(seed)
    if on:  # perhaps not quite a rigid body, as it drifts
        body = system.slots["body"].ravel()
        for c in range(3):
            q[body + c] += drifts * 1e-4 * rng.standard_normal(len(body))
            v[body + c] += 0.05 * rng.standard_normal(len(body))
    batch, slightly = system.parts["rubbing"], rng.uniform(-1e-4, 1e-4, q.shape)
    for near in (q - slightly, q + 0.5 * slightly):
        keep(knowing(choose_memory, [batch]), near, v)
    out = np.zeros(5 * batch.limit.size + len(batch.most))
    choose(knowing(choose_memory, [batch]), q, v, out)
    return system, remembering(batch, out), (q, v, np.zeros(system.size)), out[: 5 * batch.limit.size]


def remembering(batch, memory):
    """The batch with such a memory of its own; any row may have a limit."""
    n = batch.limit.size
    parts = np.split(memory[: 5 * n].copy(), [3 * n, 4 * n])
    own = {key: x.reshape(getattr(batch, key).shape) for key, x in zip(ARRAYS, parts, strict=True)}
    lit = np.array([len(batch.most), *range(len(batch.most))])
    return batch._replace(**own, lit=lit, most=batch.most.copy(), far=batch.far.copy())


def both(batch, system, states):
    """The force on the unknowns, and the memory that a step leaves in this state, with sizes of limits."""
    own = remembering(batch, np.concatenate([getattr(batch, key).ravel() for key in ARRAYS]))
    r = np.zeros(system.size)
    force(knowing(choose_memory, [own]), *states, r, system.core.ws)
    keep(knowing(choose_memory, [own]), *states[:2])
    return r, np.concatenate([getattr(own, key).ravel() for key in ARRAYS])


def alike(found, wanted, points):
    """Whether derivatives of anchors, limits and forces before are."""
    n = 3 * points
    parts = [slice(0, n), slice(n, n + points), slice(n + points, None)]
    return all(agree(found[own], wanted[own], 3e-6) for own in parts)


@SHAPES
@BODIES
@FRICTIONS
@DAMPINGS
def test_along_states_and_memories(kind, on, friction, damping):
    """One after the other, as forces and memories have them."""
    system, batch, given, memory = lying(kind, on, friction, damping)
    batches = knowing(
        add_force_slopes, [batch], add_slopes_beside, add_memory_slopes, remember_along, choose_memory
    )
    points, size = batch.limit.size, system.size
    d, z, z_all = lanes(3, size), lanes(len(memory), seed=4), lane_rows(len(memory) + len(batch.most))
    limits = slice(3 * points, 4 * points)
    z[limits] *= (memory[limits] < 0.0)[:, None]  # others have no limit that counts
    z_all[: len(memory)] = z
    r, rest, w, left = lane_rows(size), lane_rows(size), lane_rows(size), z_all.copy()
    room = lane_rows(len(left))
    room[...] = left
    operate(batches, *given, d, room, r, rest, w, system.core.ws)
    for k in range(8):

        def moved(x, k=k):
            return both(batch, system, [y + x * e for y, e in zip(given, d[..., k], strict=True)])

        def remembered(x, k=k):
            change = np.ones(len(memory))
            change[limits] = np.sign(memory[limits])
            return both(remembering(batch, memory + x * change * z[:, k]), system, given)

        by_state, by_memory = differences(moved, 1e-7), differences(remembered, 1e-7)
        assert agree(r[:, k], by_state[0], 3e-6)
        assert agree(w[:, k], by_memory[0], 3e-6)
        assert alike(room[: len(memory), k], by_state[1] + by_memory[1], points)


@SHAPES
@BODIES
@FRICTIONS
@pytest.mark.parametrize("name", ["rubbing", "pressing"])
def test_what_tangents_leave_out(kind, on, friction, name):
    system, batch, given, _ = lying(kind, on, friction, drifts=False)
    batch = batch if name == "rubbing" else system.parts["pressing"]
    batches, size = knowing(add_force_slopes, [batch], add_slopes_beside, add_memory_slopes), system.size
    d, z = lanes(3, size), lane_rows(5 * system.parts["rubbing"].limit.size)
    d[0, system.n :] = 0.0
    d[1], d[2] = G / B * d[0], d[0] / B
    r, rest, w = lane_rows(size), lane_rows(size), lane_rows(size)
    operate(batches, *given, d, z, r, rest, w, system.core.ws)
    A = np.zeros_like(system.core.A)
    tangents(batches, *given[:2], A, 1.0 / B, G / B, 1.0, system.core.ws)
    kept = to_sparse(A, system.places) @ d[0, : system.n]
    found = (r - rest)[: system.n]
    assert np.max(np.abs(found - kept)) < 1e-11 * np.max(np.abs(r))
    assert np.any(rest)


@SHAPES
@BODIES
@FRICTIONS
@DAMPINGS
@pytest.mark.parametrize("field", ["data", "weight", "shape"])
@pytest.mark.parametrize("name", ["rubbing", "pressing"])
def test_changes_of_numbers(kind, on, friction, damping, field, name):
    """Three changes at once, one of which is none."""
    system, batch, given, memory = lying(kind, on, friction, damping)
    rubs = name == "rubbing"
    batch = batch if rubs else system.parts["pressing"]
    own, rng = getattr(batch, field), np.random.default_rng(7)
    rates = np.zeros((3, *own.shape))
    rates[::2] = rng.uniform(0.2, 1.0, (2, *own.shape)) * np.where(own == 0.0, 0.01, own)
    if field == "data":
        rates[:, :, OWN:] = 0.0
        rates[:, :, 0] *= 0.01  # a radius is large beside a depth
        rates[:, :, FRICTION] *= 1.0 if rubs else 0.0
    rates *= 0.1 if field == "shape" else 1.0
    numbers = traits(batch).numbers
    each = np.array([numbers(batch._replace(**{field: own + rate})) - numbers(batch) for rate in rates])
    kinds = np.concatenate([np.asarray(traits(batch).kinds(batch, rate), dtype=np.int64) for rate in each])
    size, points = system.size, 5 * system.parts["rubbing"].limit.size
    r, z = np.zeros((3, size)), lane_rows(points + len(system.parts["rubbing"].most))
    begin, places = size * np.arange(3), np.arange(3)
    batches = knowing(add_changes, [batch], add_memory_changes)
    change(batches, *given, each.ravel(), kinds, begin, r.ravel(), places, z.reshape(-1), system.core.ws)

    def moved(x, rate):
        changed = batch._replace(**{field: own + x * rate})
        if rubs:
            return both(changed, system, given)
        r = np.zeros(size)
        force(knowing(choose_memory, [changed]), *given, r, system.core.ws)
        return (r,)

    for k in range(3):
        wanted = differences(lambda x, k=k: moved(x, rates[k]), 1e-5)
        assert agree(r[k], wanted[0], 3e-6)
        if rubs:
            assert alike(z[:points, k], wanted[1], len(memory) // 5)
    assert np.any(r[0])
    assert not np.any(r[1])
    assert not np.any(z[:, 1])


@SHAPES
@pytest.mark.parametrize("field", ["data", "shape"])
@pytest.mark.parametrize("depth", [1e-4, 1.6e-4])
def test_where_damping_comes_on(kind, field, depth):
    """In the first hundredths of the radius: forces of what leaves and comes, by states and numbers."""
    system = System(beside(KINDS[kind], depth=depth, damping=50.0))
    q, v = shaken(system, 1e-6)
    given, batch, size = (q, v, np.zeros(system.size)), system.parts["pressing"], system.size
    own, rng = getattr(batch, field), np.random.default_rng(7)
    rate = rng.uniform(0.2, 1.0, own.shape) * (1e-3 if field == "shape" else own)
    if field == "data":
        rate[:, FRICTION:], rate[:, 0] = 0.0, 0.002 * rate[:, 0]
    numbers = traits(batch).numbers
    change_of = numbers(batch._replace(**{field: own + rate})) - numbers(batch)
    kinds = np.asarray(traits(batch).kinds(batch, change_of), dtype=np.int64)
    r, z, none = np.zeros(size), lane_rows(1), np.zeros(1, dtype=np.int64)
    batches = knowing(add_changes, [batch], add_memory_changes)
    change(batches, *given, change_of, kinds, none, r, none, z.reshape(-1), system.core.ws)
    d, along, rest, w = lanes(3, size), lane_rows(size), lane_rows(size), lane_rows(size)
    batches = knowing(add_force_slopes, [batch], add_slopes_beside, add_memory_slopes)
    operate(batches, *given, d, z, along, rest, w, system.core.ws)

    def moved(states, own):
        r = np.zeros(size)
        force(knowing(choose_memory, [batch._replace(**{field: own})]), *states, r, system.core.ws)
        return (r,)

    assert np.any(r)
    assert agree(r, differences(lambda x: moved(given, own + x * rate), 1e-4)[0], 1e-6)
    for k in range(8):
        wanted = differences(lambda x, k=k: moved(given + x * np.moveaxis(d, -1, 0)[k], own), 1e-8)
        assert agree(along[:, k], wanted[0], 1e-5)


def test_the_memories_are_of_all_kinds():
    """Some points stick, some slip and drag their anchors along, or do not, some touch without any so far."""
    kinds, drags = set(), set()
    for friction, damping in product((0.001, 0.02, 0.4, 50.0), (0.5, 50.0)):
        system, batch, given, memory = lying("cylinder", True, friction, damping)
        kinds |= set(np.sign(np.where(batch.limit > 1e9, 2.0, batch.limit)).ravel().tolist())
        _, left = both(batch, system, given)
        moved = np.any((left - memory)[: batch.anchor.size].reshape(*batch.anchor.shape) != 0.0, axis=2)
        drags |= set(moved[batch.limit < 0.0].tolist())
    assert {-1.0, 1.0} <= kinds
    assert drags == {False, True}
