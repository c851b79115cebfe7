"""What friction on grounds remembers, backwards: the transposed of what it is forwards, to round-off."""

import numpy as np
import pytest
from test_ground_slopes import FRICTION, GROUNDS, SPEEDS, change, lanes, lying, operate

from ancf.compiled import (
    add_changes,
    add_force_slopes,
    add_memory_changes,
    add_memory_slopes,
    add_number_work,
    add_slopes_beside,
    add_work_slopes,
    kernel,
    remember_along,
    take_memory_back,
    take_memory_work,
    traits,
)
from ancf.linalg.eight import lane_rows
from ancf.solvers.rare import (
    add_all_slopes,
    add_number_work_of,
    knowing,
    take_memory_back_of,
    take_memory_work_of,
)

FORWARDS = add_force_slopes, add_slopes_beside, add_memory_slopes, remember_along
BACK = add_work_slopes, add_number_work, take_memory_work, take_memory_back


@kernel
def back(batches, q, v, a, x, by, out, taken, z, by_q, by_v, numbers, ws):
    add_all_slopes(batches, q, v, a, x, by[0], by[1], by[2], ws)
    add_number_work_of(batches, 0, q, v, a, x, out, ws)
    take_memory_work_of(batches, 0, q, v, x, taken, ws)
    take_memory_back_of(batches, 0, q, v, z, by_q, by_v, numbers, ws)


def backwards(batch, system, given, x, z, count):
    """What the work of x and derivatives z by what a step leaves have by states, numbers and memories."""
    size, m = system.size, len(traits(batch).numbers(batch))
    by, out, taken, left = np.zeros((3, size)), np.zeros(m), np.zeros(count), z.copy()
    by_q, by_v, numbers = np.zeros(size), np.zeros(size), np.zeros(m)
    batches = knowing(BACK[0], [batch], *BACK[1:])
    back(batches, *given, x, by, out, taken, left, by_q, by_v, numbers, system.core.ws)
    return by, out, -taken, left, (-by_q, -by_v), -numbers


def same(found, wanted, terms):
    """Whether sums agree to round-off of their terms."""
    return np.max(np.abs(found - wanted)) <= 1e-13 * np.max(terms) + 1e-300


def check_states(batch, system, given, count, smooth):
    """Along eight states and memories, whose entries without a derivative are not ``smooth``."""
    rng, size = np.random.default_rng(6), system.size
    x, y = rng.uniform(-1, 1, size), rng.uniform(-1, 1, count) * smooth
    d, z = lanes(3, size), lanes(count, seed=4)
    z *= smooth[:, None]
    r, rest, w, left = lane_rows(size), lane_rows(size), lane_rows(size), lane_rows(count)
    left[...] = z
    operate(knowing(FORWARDS[0], [batch], *FORWARDS[1:]), *given, d, left, r, rest, w, system.core.ws)
    by, _, taken, by_z, (by_q, by_v), _ = backwards(batch, system, given, x, y, count)
    terms = np.abs(x) @ np.abs(r) + np.abs(by).sum()
    assert same(x @ r, np.einsum("ki,kin->n", by, d), terms)
    assert same(x @ w, taken @ z, np.abs(x) @ np.abs(w) + np.abs(taken).sum())
    found = by_q @ d[0] + by_v @ d[1] + by_z @ z
    terms = np.abs(y) @ np.abs(left) + np.abs(by_q).sum() + np.abs(by_v).sum() + np.abs(by_z).sum()
    assert same(y @ (left * smooth[:, None]), found, terms)


def check_numbers(batch, system, given, count):
    """Along three changes of all numbers."""
    rng, size = np.random.default_rng(6), system.size
    x, y = rng.uniform(-1, 1, size), rng.uniform(-1, 1, count)
    numbers = traits(batch).numbers(batch)
    rates = rng.uniform(-1, 1, (3, len(numbers))) * np.where(numbers == 0.0, 0.1, numbers)
    kinds = np.concatenate([np.asarray(traits(batch).kinds(batch, rate), dtype=np.int64) for rate in rates])
    r, z = np.zeros((3, size)), lane_rows(count)
    begin, places = size * np.arange(3), np.arange(3)
    batches = knowing(add_changes, [batch], add_memory_changes)
    change(batches, *given, rates.ravel(), kinds, begin, r.ravel(), places, z.reshape(-1), system.core.ws)
    _, out, _, _, _, own = backwards(batch, system, given, x, y, count)
    assert same(r @ x, rates @ out, np.abs(r) @ np.abs(x) + np.abs(rates) @ np.abs(out))
    terms = np.abs(y) @ np.abs(z[:, :3]) + np.abs(rates) @ np.abs(own)
    assert same(y @ z[:, :3], rates @ own, terms)
    assert np.any(out)
    assert np.any(own)


@GROUNDS
@FRICTION
@SPEEDS
@pytest.mark.parametrize("elements", [2, 5])
def test_states_and_memories(height, friction, speed, elements):
    system, batch, given, memory = lying(height, friction, speed, elements)
    smooth, points = np.ones(len(memory)), batch.anchor.size
    smooth[points:] = np.where(memory[points:] > 1e9, 0.0, 1.0)  # of what sticks the limit does not count
    check_states(batch, system, given, len(memory), smooth)


@GROUNDS
@FRICTION
@SPEEDS
def test_numbers(height, friction, speed):
    system, batch, given, memory = lying(height, friction, speed, 3)
    check_numbers(batch, system, given, len(memory))
