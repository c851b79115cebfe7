"""Modes of what strips and cables touch: differences of forces, and a damped contact in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.linalg import eigh

import ancf
from ancf.linalg.sparse import to_sparse
from ancf.system.core import apply_supports, assemble, residual


def _pressed(length, force, elements=30):
    """A wire of 60 m over a head that a soft spring and a force press against it."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    copper = ancf.Section(EA=15e6, EI=195.0, rhoA=1.35)
    wire = model.add_beam(
        "wire", start=(0, 0, 0), end=(60, 0, 0), elements=elements, length=length, section=copper
    )
    model.pin(wire.start)
    model.pin(wire.end)
    head = model.add_point_mass("head", at=(20, 0, -2.3), mass=7.2)
    model.hold(head, position="xy")
    model.add_spring(head, (20, 0, -4.0), stiffness=50.0, length=1.7)
    model.add_force(head, (0, 0, 7.2 * 9.81 + force))
    model.add_contact(head, along=wire, stiffness=50e3)
    return model


def _by_differences(state, count):
    """Frequencies in Hz with the stiffness by differences of all forces; loads cancel."""
    system, core = state.system, state.system.core
    q, n, still = np.array(state.q), state.system.n, np.zeros_like(state.q)
    free = np.setdiff1d(system.free, system.multipliers)
    K = np.zeros((n, n))
    for i in free:
        sides = []
        for step in (1e-6, -1e-6):
            near, r = q.copy(), np.empty_like(q)
            near[i] += step
            residual(core.batches, core.ws, near, still, still, still, r)
            apply_supports(core.supports, r)
            sides.append(r[:n])
        K[:, i] = (sides[0] - sides[1]) / 2e-6
    assemble(core.batches, core.ws, q, still, core.A, 1.0, 0.0, 0.0)
    M = to_sparse(core.A, system.places).toarray()
    K, M = (x[np.ix_(free, free)] for x in (0.5 * (K + K.T), M))
    return np.sqrt(eigh(K, M, eigvals_only=True)[:count]) / (2 * np.pi)


@pytest.mark.parametrize(("length", "force"), [(59.92, 300.0), (60.3, 120.0), (60.3, 300.0), (60.6, 500.0)])
def test_force_of_a_strip_turns_with_the_wire(length, force):
    """On a sagging wire the turn of the force softens what moves along it, by up to 2 %."""
    model = _pressed(length, force)
    state = ancf.equilibrium(model)
    expected = _by_differences(state, 8)
    assert ancf.modes(model, about=state, count=8).frequencies_hz == pytest.approx(expected, rel=1e-7)


@pytest.mark.parametrize(("length", "force"), [(59.92, 300.0), (60.6, 500.0)])
def test_damped_modes_know_strips(length, force):
    """Nothing is damped: the frequencies are those of modes."""
    model = _pressed(length, force)
    state = ancf.equilibrium(model)
    expected = ancf.modes(model, about=state, count=6).frequencies_hz
    assert ancf.damped_modes(model, about=state, count=6).frequencies_hz == pytest.approx(expected, rel=1e-6)


@pytest.mark.parametrize("damping", [1.0, 10.0, 60.0])
def test_damped_contact_of_a_head(damping):
    """A head on a wire that hardly gives: omega^2 = k/m and the ratio c/(2 sqrt(k m))."""
    model = ancf.Model()
    stiff = ancf.Section(EA=1e9, EI=1e7, rhoA=1e4)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=stiff)
    model.clamp(wire.start)
    model.clamp(wire.end)
    head = model.add_point_mass("head", at=(1, 0, 0), mass=1.0)
    model.hold(head, position="xy")
    model.add_force(head, (0, 0, 10.0))
    model.add_contact(head, along=wire, stiffness=1e3, damping=damping)
    state = ancf.equilibrium(model)
    found = ancf.damped_modes(model, about=state, count=1)
    assert abs(found.eigenvalues[0]) == pytest.approx(np.sqrt(1e3), rel=1e-3)
    assert found.damping_ratios[0] == pytest.approx(damping / (2 * np.sqrt(1e3)), rel=1e-3)


@pytest.mark.parametrize("damping", [0.0, 20.0])
def test_damped_modes_know_cables_that_touch(damping):
    """Two cables, one across the other: frequencies as of modes, and damping lowers none to nothing."""
    section = ancf.Section(EA=1e4, EI=0.05, rhoA=0.3, diameter=0.02)
    model = ancf.Model(gravity=(0, 0, -9.81))
    low = model.add_beam("low", start=(0, -0.5, 0), end=(0, 0.5, 0), elements=6, section=section)
    top = model.add_beam("top", start=(-0.5, 0, 0.02), end=(0.5, 0, 0.02), elements=6, section=section)
    for point in (low.start, low.end, top.start, top.end):
        model.pin(point)
    model.add_contact(top, low, stiffness=1e6, damping=damping)
    model.add_force(top.at(0.5), (0, 0, -20))
    state = ancf.equilibrium(model)
    expected = ancf.modes(model, about=state, count=6).frequencies_hz
    found = ancf.damped_modes(model, about=state, count=6)
    assert found.frequencies_hz == pytest.approx(expected, rel=1e-3 if damping else 1e-6)
    assert (found.damping_ratios.max() > 1e-6) == (damping > 0.0)
