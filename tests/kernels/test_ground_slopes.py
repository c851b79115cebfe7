"""Derivatives of the forces of grounds with friction, and of what it remembers, against differences."""

import numpy as np
import pytest

import ancf
from ancf.batches import add_forces, add_tangents, remember_all
from ancf.compiled import (
    add_changes,
    add_force_slopes,
    add_memory_changes,
    add_memory_slopes,
    add_slopes_beside,
    choose_memory,
    kernel,
    remember_along,
    traits,
)
from ancf.linalg.eight import lane_rows
from ancf.linalg.sparse import to_sparse
from ancf.solvers.rare import (
    add_changes_of,
    add_memory_changes_of,
    add_memory_slopes_of,
    add_slopes_along,
    add_slopes_beside_all,
    choose_memory_of,
    knowing,
    remember_along_of,
)
from ancf.system.system import System
from strained import states

HEIGHTS = np.random.default_rng(1).uniform(-0.1, 0.3, (4, 3)).tolist()
HILLS = {"x": [-1, 0.2, 0.8, 2.0], "y": [-1, 0.1, 2.0], "z": HEIGHTS}
#: Of a step, by which its rates go with positions.
B, G = 0.02, 0.5
PLACES = ((-2.0, 1 / 12), (-1.0, -8 / 12), (1.0, 8 / 12), (2.0, -1 / 12))
GROUNDS = pytest.mark.parametrize("height", [0.05, HILLS], ids=["plane", "hills"])
FRICTION = pytest.mark.parametrize("friction", [0.0, 0.02, 0.4, 50.0])
SPEEDS = pytest.mark.parametrize("speed", [0.0, 0.05, 1.0])
CHANGED = ("grounds", "diameter", "weight", "shape")


@kernel
def operate(batches, q, v, a, d, z, r, beside, w, ws):
    add_slopes_along(batches, q, v, a, d, r, ws)
    add_slopes_beside_all(batches, q, v, a, d, beside, ws)
    add_memory_slopes_of(batches, 0, q, v, z, w, ws)
    remember_along_of(batches, 0, q, v, d, z, ws)


@kernel
def change(batches, q, v, a, rates, kinds, begin, r, places, z, ws):
    add_changes_of(batches, 0, q, v, a, rates, kinds, begin, r, ws)
    add_memory_changes_of(batches, 0, q, v, rates, kinds, places, z, ws)


@kernel
def choose(batches, q, v, out):
    choose_memory_of(batches, 0, q, v, out)


@kernel
def force(batches, q, v, a, r, ws):
    add_forces(batches, q, v, a, r, ws)


@kernel
def keep(batches, q, v):
    remember_all(batches, q, v)


@kernel
def tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws):
    add_tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws)


def lying(height, friction, speed, elements):
    """A cable that lies on a ground here and there; system, the batch, its state, and the memory of a step.

    The batch remembers some steps, sticks in some points and slips in others, with what is chosen for these.
    """
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e3, EI=2.0, rhoA=1.0, diameter=0.05)
    model.add_beam("rope", start=(0, 0, 0), end=(1.2, 0.3, 0.2), elements=elements, section=section)
    given = {"stiffness": 3e4, "damping": 2e3, "friction": friction, "stick": 8e3}
    model.add_ground("floor", height=height, **given)
    system = System(model)
    q, v, a, _, rng = states(system, 3)
    batch, v = system.parts["ground"], speed * v
    slightly = rng.uniform(-2e-3, 2e-3, q.shape)
    for near in (q - slightly, q + 0.5 * slightly):
        keep(knowing(choose_memory, [batch]), near, v)
    out = np.zeros(batch.anchor.size + batch.limit.size)
    choose(knowing(choose_memory, [batch]), q, v, out)
    return system, remembering(batch, out), (q, v, a), out


def remembering(batch, memory):
    """The batch with such a memory of its own."""
    anchor, limit = np.split(memory.copy(), [batch.anchor.size])
    return batch._replace(anchor=anchor.reshape(batch.anchor.shape), limit=limit.reshape(batch.limit.shape))


def both(batch, system, states):
    """The force on the unknowns, and the memory that a step leaves in this state, with sizes of limits."""
    r, own = np.zeros(system.size), batch._replace(anchor=batch.anchor.copy(), limit=batch.limit.copy())
    force(knowing(choose_memory, [own]), *states, r, system.core.ws)
    keep(knowing(choose_memory, [own]), *states[:2])
    return r, np.concatenate([own.anchor.ravel(), own.limit.ravel()])


def differences(of, step):
    """Of order four, of both; what does not change leaves no round-off."""
    here = of(0.0)
    found = [
        [weight / step * (x - own) for x, own in zip(of(place * step), here, strict=True)]
        for place, weight in PLACES
    ]
    return [np.sum(own, axis=0) for own in zip(*found, strict=True)]


def agree(found, wanted, share):
    """Whether derivatives do, within a share of the largest one."""
    return np.max(np.abs(found - wanted)) <= share * np.max(np.abs(wanted))


def lanes(*shape, seed=3, size=1.0):
    made = lane_rows(int(np.prod(shape))).reshape(*shape, 8)
    made[...] = size * np.random.default_rng(seed).uniform(-1, 1, made.shape)
    return made


@GROUNDS
@FRICTION
@SPEEDS
@pytest.mark.parametrize("elements", [2, 5])
def test_along_states_and_memories(height, friction, speed, elements):
    """One after the other, as forces and memories have them; with the tangent, what is beside it is all."""
    system, batch, given, memory = lying(height, friction, speed, elements)
    batches = knowing(
        add_force_slopes, [batch], add_slopes_beside, add_memory_slopes, remember_along, choose_memory
    )
    points, size = batch.anchor.size, system.size
    d, z = lanes(3, size), lanes(len(memory), seed=4)
    z[points:] *= (memory[points:] < 0.0)[:, None]  # others have no limit that counts
    r, rest, w, left = lane_rows(size), lane_rows(size), lane_rows(size), lane_rows(len(memory))
    left[...] = z
    operate(batches, *given, d, left, r, rest, w, system.core.ws)
    for k in range(8):

        def moved(x, k=k):
            return both(batch, system, [y + x * e for y, e in zip(given, d[..., k], strict=True)])

        def remembered(x, k=k):
            change = np.where(np.arange(len(memory)) < points, 1.0, np.sign(memory)) * z[:, k]
            return both(remembering(batch, memory + x * change), system, given)

        by_state, by_memory = differences(moved, 1e-7), differences(remembered, 1e-7)
        assert agree(r[:, k], by_state[0], 1e-6)
        assert agree(w[:, k], by_memory[0], 1e-6)
        assert agree(left[:points, k], (by_state[1] + by_memory[1])[:points], 1e-6)
        assert agree(left[points:, k], (by_state[1] + by_memory[1])[points:], 1e-6)


@GROUNDS
@FRICTION
@SPEEDS
def test_what_tangents_leave_out(height, friction, speed):
    system, batch, given, memory = lying(height, friction, speed, 4)
    batches = knowing(add_force_slopes, [batch], add_slopes_beside, add_memory_slopes, remember_along)
    d, z, size = lanes(3, system.size), lanes(len(memory)), system.size
    d[0, system.n :] = 0.0
    d[1], d[2] = G / B * d[0], d[0] / B
    r, rest, w = lane_rows(size), lane_rows(size), lane_rows(size)
    operate(batches, *given, d, z, r, rest, w, system.core.ws)
    A = np.zeros_like(system.core.A)
    tangents(batches, *given[:2], A, 1.0 / B, G / B, 1.0, system.core.ws)
    kept = to_sparse(A, system.places) @ d[0, : system.n]
    found = (r - rest)[: system.n]
    assert np.max(np.abs(found - kept)) < 1e-11 * np.max(np.abs(r))
    assert np.any(rest) == (height is HILLS)


@GROUNDS
@FRICTION
@SPEEDS
@pytest.mark.parametrize("field", CHANGED)
def test_changes_of_numbers(height, friction, speed, field):
    """Of grounds all but their direction, whose size is one; three changes at once, one of which is none."""
    system, batch, given, memory = lying(height, friction, speed, 3)
    own, rng = getattr(batch, field), np.random.default_rng(7)
    rates = np.zeros((3, *own.shape))
    rates[::2] = rng.uniform(0.2, 1.0, (2, *own.shape)) * np.where(own == 0.0, 0.1, own)
    if field == "grounds":
        rates[:, :, 3:6] = 0.0
        rates[:, :, 0:3] *= 0.1
    numbers = traits(batch).numbers
    each = np.array([numbers(batch._replace(**{field: own + rate})) - numbers(batch) for rate in rates])
    kinds = np.concatenate([np.asarray(traits(batch).kinds(batch, rate), dtype=np.int64) for rate in each])
    size, count = system.size, len(memory)
    r, z = np.zeros((3, size)), lane_rows(count)
    begin, places = size * np.arange(3), np.arange(3)
    batches = knowing(add_changes, [batch], add_memory_changes)
    change(batches, *given, each.ravel(), kinds, begin, r.ravel(), places, z.reshape(-1), system.core.ws)
    for k in range(3):
        wanted = differences(
            lambda x, k=k: both(batch._replace(**{field: own + x * rates[k]}), system, given), 1e-6
        )
        assert agree(r[k], wanted[0], 1e-6)
        assert agree(z[: batch.anchor.size, k], wanted[1][: batch.anchor.size], 1e-6)
        assert agree(z[batch.anchor.size :, k], wanted[1][batch.anchor.size :], 1e-6)
    assert np.any(r[0])
    assert not np.any(r[1])
    assert not np.any(z[:, 1])


@pytest.mark.parametrize("friction", [0.02, 0.4, 50.0])
def test_the_memories_are_of_all_kinds(friction):
    """Where friction is large all sticks, else some does and some slips."""
    found = []
    for speed in (0.05, 1.0):
        _, batch, _, _ = lying(0.05, friction, speed, 5)
        found.append((int(np.sum(batch.limit < 0.0)), int(np.sum(batch.limit > 1e9))))
    slip, stick = np.sum(found, axis=0)
    assert (slip > 0) == (friction < 1.0)
    assert stick > 0


@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_in_the_last_hundredth(part):
    """Of a diameter above a ground damping comes on: what the numbers do there."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e3, EI=2.0, rhoA=1.0, diameter=0.05)
    model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.add_ground("floor", height=-part * 0.01 * 0.05, stiffness=3e4, damping=2e3, friction=0.3)
    system = System(model)
    q, v = system.initial_state()
    v[2::3] = -0.3  # slopes as well: it comes down, and turns
    batch, size = system.parts["ground"], system.size
    rate = np.zeros(len(traits(batch).numbers(batch)))
    rate[batch.grounds.size : batch.grounds.size + batch.diameter.size] = 0.05
    r, z, none = np.zeros(size), lane_rows(4 * batch.limit.size), np.zeros(1, dtype=np.int64)
    batches, given = knowing(add_changes, [batch], add_memory_changes), (q, v, np.zeros(size))
    change(batches, *given, rate, none, none, r, none, z.reshape(-1), system.core.ws)

    def moved(x):
        return both(batch._replace(diameter=batch.diameter + x * 0.05), system, given)

    wanted = differences(moved, 1e-5)
    assert agree(r, wanted[0], 1e-7)
    assert agree(z[:, 0], wanted[1], 1e-7)
    assert np.any(r)


@pytest.mark.parametrize(("share", "slips"), [(0.9, True), (1 - 1e-6, True), (1 - 5e-8, False), (1.1, False)])
@pytest.mark.parametrize("way", [1e-4, 2e-3])
def test_at_the_limit(way, share, slips):
    """Friction that is a share of its limit beyond it sticks, if that is round-off."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e3, EI=2.0, rhoA=1.0, diameter=0.05)
    model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.add_ground("floor", height=0.001, stiffness=3e4, damping=2e3, friction=0.3, stick=8e3)
    system = System(model)
    (q, v), batch = system.initial_state(), system.parts["ground"]
    traits(batch).laid(batch, q)
    batch.anchor[..., 1] -= way
    batch.limit[...] = share * 0.05 * 8e3 * way
    out = np.zeros(batch.anchor.size + batch.limit.size)
    choose(knowing(choose_memory, [batch]), q, v, out)
    limits = out[batch.anchor.size :]
    assert np.array_equal(limits, -batch.limit.ravel()) if slips else np.all(limits > 1e9)
