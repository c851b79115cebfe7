"""Iterations of a part of a line: the same step, forces and solutions of what has not converged alone."""

from __future__ import annotations

import numpy as np
import pytest

import ancf
from ancf.compiled import kernel
from ancf.solvers.step.near import take, unsettled
from ancf.solvers.stepping import Run
from ancf.system.core import apply_supports, residual, to_local
from ancf.system.near import SEGMENT, clear_beyond, residual_near
from ancf.system.system import System

LENGTH = 120.0


@kernel
def forces_near(near, supports, count, n, ws, q, v, a, f, r):
    """Kernels of their own for parts of others."""
    residual_near(near, count, n, ws, q, v, a, f, r)
    to_local(supports, r)
    clear_beyond(near, count, n // 6, r)


@kernel
def ranges_above(near, limit, n):
    return unsettled(near, limit, n)


@kernel
def taken(near, s, weight, count):
    return take(near, s, weight, 2.0, 3.0, count)


def line(elements=120, strips=(10.0,), speed=40.0, clamped=False):
    """Two wires coupled by slack droppers, and strips that run along the lower one."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e6, EI=100.0, rhoA=1.0, damping=0.1, axial_damping=20.0)
    wires = [
        model.add_beam(name, section=section, start=(0, 0, z), end=(LENGTH, 0, z), elements=count, length=119)
        for name, z, count in (("lower", 0.0, elements), ("upper", 1.0, elements // 2))
    ]
    for wire in wires:
        (model.clamp if clamped else model.pin)(wire.start)  # a clamp has local axes
        model.pin(wire.end)
    droppers = [
        model.add_spring(
            wires[0].at(x * 119 / LENGTH),
            wires[1].at(x * 119 / LENGTH),
            stiffness=1e5,
            damping=5.0,
            length=0.995,
            slack=True,
        )
        for x in np.arange(4.0, LENGTH - 2.0, 4.0)
    ]
    contacts = []
    for k, x in enumerate(strips):
        head = model.add_point_mass(f"head {k}", at=(x, 0, -1e-3), mass=5.0)
        model.hold(head, position="xy", displacement=[f"{speed}*t", 0, 0])
        head.set_motion(velocity=(speed, 0, 0))
        model.add_force(head, (0, 0, 5.0 * 9.81 + 150.0))
        contacts.append(model.add_contact(head, wires[0], stiffness=50e3, damping=20.0))
    return model, droppers, contacts


def shaken(system, seed=0):
    """A state near the initial one."""
    rng = np.random.default_rng(seed)
    q = system.initial_state()[0]
    return q + 1e-4 * rng.normal(size=q.shape), rng.normal(size=q.shape), rng.normal(size=q.shape)


@pytest.mark.parametrize("clamped", [False, True])
@pytest.mark.parametrize("ranges", [[(0, 3)], [(20, 25), (60, 61), (150, 182)], [(181, 182)]])
def test_forces_in_ranges_are_those_of_the_whole(ranges, clamped):
    system = System(line(clamped=clamped)[0])
    core, (near,) = system.core, system.core.near
    q, v, a = shaken(system)
    f = np.random.default_rng(1).normal(size=system.size)
    whole, part = np.zeros(system.size), np.full(system.size, np.nan)
    residual(core.batches, core.ws, q, v, a, f, whole)
    apply_supports(core.supports, whole)
    for k, (low, high) in enumerate(ranges):
        near.low[k], near.high[k] = low, high
    forces_near(near, core.supports, len(ranges), system.n, core.ws, q, v, a, f, part)
    inside = np.zeros(system.n // 6, dtype=bool)
    for low, high in ranges:
        inside[low:high] = True
    size = np.abs(whole).max()
    blocks, wanted = part[: system.n].reshape(-1, 6), whole[: system.n].reshape(-1, 6)
    assert np.abs(blocks[inside] - wanted[inside]).max() <= 1e-13 * size
    assert not blocks[~inside].any()
    chunks = sum(int(g[1] - g[0]) for g in near.groups)
    assert chunks < len(near.touched)  # not all elements were asked
    assert near.touched.max() <= system.n // 6  # a node with local axes is where its unknowns are


def test_what_is_left_to_iterate_and_what_is_taken():
    system = System(line()[0])
    core, (near,) = system.core, system.core.near
    n = system.n // 6
    run = Run(system, ancf.GeneralizedAlpha(0.8), 0.0, 1.0, 1e-3, 1)
    s, rng = run.memory, np.random.default_rng(3)
    for vector in (s.q, s.v, s.a, s.r):
        vector[:] = rng.normal(size=vector.shape)
    s.r[: system.n].reshape(-1, 6)[40:] *= 1e-6
    s.r[6 * 140] = 0.5
    before = s.q.copy(), s.v.copy(), s.a.copy()
    near.low[0], near.high[0] = 0, n
    norm = taken(near, s, core.weight, 1)
    assert norm == np.max(np.abs(s.r[: system.n] * core.weight))
    for now, then, factor in zip((s.q, s.v, s.a), before, (1.0, 2.0, 3.0), strict=True):
        assert now[: system.n] == pytest.approx(then[: system.n] - factor * s.r[: system.n], abs=1e-14)
    count = ranges_above(near, 1e-3, n)
    inside = np.zeros(n, dtype=bool)
    for k in range(count):
        inside[near.low[k] : near.high[k]] = True
    large = np.abs(s.r[: system.n] * core.weight).reshape(-1, 6).max(axis=1) > 1e-3
    assert inside[large].all()
    assert count == 2
    assert inside.sum() <= large.sum() + 2 * (2 * SEGMENT + 2 * near.spread)
    s.r[7] = np.nan
    near.low[0], near.high[0] = 0, n
    assert np.isnan(taken(near, s, core.weight, 1))


def run(newton, energy=False, **given):
    model, droppers, contacts = line(**given)
    result = ancf.simulate(
        model,
        t_end=0.3,
        step=1e-3,
        start=ancf.equilibrium(model, of=["lower", "upper"]),
        integrator=ancf.GeneralizedAlpha(0.9, newton=newton),
        sensors=[*droppers, *contacts],
        energy=energy,
    )
    sensors = result.sensors
    return result, np.stack([sensors.contact_force(c) for c in contacts])


@pytest.mark.parametrize(
    "given",
    [
        {},
        {"strips": (10.0, 60.0)},
        {"strips": (20.0,), "speed": 80.0, "elements": 240},
        {"strips": (40.0, 10.0, 75.0), "elements": 60, "energy": True},
    ],
)
def test_runs_are_those_with_whole_iterations(given, monkeypatch):
    """Against iterations of which each range is the whole line: the same motion within the tolerance."""
    newton = ancf.Newton(corotate=False, tolerance=1e-10)
    result, force = run(newton, **given)
    monkeypatch.setattr("ancf.system.near.spread_of", lambda factor: 10**6)
    plain, whole = run(newton, **given)
    assert np.std(whole[:, 50:], axis=1).min() > 5.0
    assert np.std(force, axis=1) == pytest.approx(np.std(whole, axis=1), rel=1e-5)
    assert force == pytest.approx(whole, abs=1e-3 * np.std(whole))
    assert result.q[-1] == pytest.approx(plain.q[-1], abs=1e-6)
    assert result.stats.newton_iterations <= 1.02 * plain.stats.newton_iterations
    assert result.stats.factorizations <= plain.stats.factorizations + 1


def test_blocks_of_steps_and_snapshots_do_not_matter(tmp_path):
    """The same bits whether a run is taken at once or goes on from a file."""
    newton = ancf.Newton(corotate=False)

    def simulated(t_end, file):
        model, _, contacts = line(strips=(10.0, 50.0))
        integrator = ancf.GeneralizedAlpha(0.9, newton=newton)
        given = {"step": 1e-3, "integrator": integrator, "sensors": contacts, "energy": False}
        return ancf.simulate(model, t_end=t_end, output_step=0.05, file=file, **given)

    whole = simulated(0.2, None)
    simulated(0.1, tmp_path / "part.h5")
    joined = ancf.resume(tmp_path / "part.h5", t_end=0.2)
    assert np.array_equal(joined.q[-1], whole.q[-1])
