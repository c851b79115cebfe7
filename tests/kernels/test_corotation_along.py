"""Corrections turned where elements are short: fields stay smooth, residuals turn by the transposed."""

import numpy as np
import pytest

import ancf
from ancf.solvers.step import corotation, corotation_along
from ancf.system.system import System
from helpers import rotation
from turned_frames import back, forth, turned

RNG = np.random.default_rng(4)
SECTION = ancf.Section(EA=1e4, EI=1.0, rhoA=0.1)


def spiral(x, bent, twisted):
    """Tangents (n, 3) of a wire that bends in two planes."""
    t = np.stack([np.ones_like(x), bent * np.sin(2 * x), twisted * x * (1 - x)], axis=1)
    t /= np.linalg.norm(t, axis=1)[:, None]
    return t


def state(system, name, bent, twisted):
    """State vector of a System whose wire has these tangents."""
    q = np.zeros(system.size)
    slots = system.numbering.each(name)
    x = system.model.bodies[name].node_x[: len(slots)]
    q[slots[:, 1, None] + np.arange(3)] = spiral(x, bent, twisted)
    return q


def wire(held=False, **mesh):
    model = ancf.Model()
    beam = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), section=SECTION, **mesh)
    if held:
        model.pin(beam.start)
        model.clamp(beam.end)
    system = System(model)
    return system, corotation.turning_nodes(system, 1.0)


def derivative_error(elements, bent, turn_of_plane):
    """Largest difference of a turned field's derivatives at inner nodes and those of its positions."""
    system, frames = wire(elements=elements)
    slots, R = system.numbering.each("wire"), rotation((1.0, 2.0, -0.5), turn_of_plane)
    before, now = (state(system, "wire", b, 0.0).reshape(-1, 3) @ R.T for b in (0.3, bent))
    turned(frames, before.ravel(), now.ravel())
    error = size = 0.0
    for u in np.eye(3):  # the same at all nodes
        r = np.zeros(system.size)
        r[slots[:, 0, None] + np.arange(3)] = u
        forth(frames, r)
        moved, slope = r[slots[:, 0, None] + np.arange(3)], r[slots[:, 1, None] + np.arange(3)]
        exact = (moved[2:] - moved[:-2]) * elements / 4.0
        error, size = max(error, np.max(np.abs(slope[1:-1] - exact))), max(size, np.max(np.abs(exact)))
    return error, size


@pytest.mark.parametrize("elements", [64, 125])
@pytest.mark.parametrize(("bent", "turn_of_plane"), [(0.9, 0.0), (-0.6, 1.1), (2.0, 3.0)])
def test_a_field_that_bends_in_its_plane_keeps_its_derivative(elements, bent, turn_of_plane):
    """Of the second order in the elements; without k all of it would be missing."""
    coarse, size = derivative_error(elements, bent, turn_of_plane)
    fine, _ = derivative_error(2 * elements, bent, turn_of_plane)
    assert size > 0.2
    assert fine < 0.3 * coarse < 0.01 * size


@pytest.mark.parametrize("mesh", [{"elements": 21}, {"nodes": [0.0, 0.01, 0.05, 0.06, 0.5, 0.52, 1.4, 2.0]}])
@pytest.mark.parametrize("held", [False, True])
def test_back_is_the_transposed_of_forth(mesh, held):
    system, frames = wire(held, **mesh)
    turned(frames, state(system, "wire", 0.3, -0.2), state(system, "wire", 1.3, 0.8))
    assert np.any(frames.along.k != 0.0)
    x, y = RNG.standard_normal((2, system.size))
    x[system.core.supports.held] = y[system.core.supports.held] = 0.0
    there, here = x.copy(), y.copy()
    forth(frames, there)
    back(frames, here)
    assert there @ y == pytest.approx(x @ here, rel=1e-13)
    assert np.all(there[system.core.supports.held] == 0.0)
    assert np.all(here[system.core.supports.held] == 0.0)


@pytest.mark.parametrize("elements", [3, 8, 9, 30])
def test_nothing_changes_without_a_rotation(elements):
    system, frames = wire(elements=elements)
    q = state(system, "wire", 0.7, 0.4)
    turned(frames, q, q)
    r = RNG.standard_normal(system.size)
    there = r.copy()
    forth(frames, there)
    assert there == pytest.approx(r, abs=1e-14)


@pytest.mark.parametrize("elements", [50, 200])
@pytest.mark.parametrize(("share", "turns"), [(0.9, False), (1.1, True)])
def test_only_where_the_stiffness_would_be_felt(elements, share, turns):
    """12 EI k^2/h^2 against 4 rhoA/step^2, with k one over the length."""
    system, _ = wire(elements=elements)
    wrong = 12.0 * SECTION.EI / (2.0 / elements * 2.0) ** 2
    step = np.sqrt(share * corotation_along.STIFF * 4.0 * SECTION.rhoA / wrong)
    frames = corotation.turning_nodes(system, step)
    assert bool(np.any(frames.along.row >= 0)) == turns


def falling(elements, step, omega):
    """A wire pinned at one end, with gravity and perhaps a spin."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.0833, rhoA=0.1)
    beam = model.add_beam("wire", start=(0, 0, 0), end=(10, 0, 0), elements=elements, section=section)
    beam.set_motion(angular_velocity=(0, 0, omega))
    model.pin(beam.start)
    result = ancf.simulate(
        model,
        t_end=50 * step,
        step=step,
        integrator=ancf.GeneralizedAlpha(rho_inf=0.8),
        output_step=50 * step,
    )
    return result.stats.jacobians, result.position(beam.end)[-1]


@pytest.mark.parametrize(
    ("elements", "step", "omega"), [(10_000, 5e-3, 0.0), (14_000, 5e-3, 1.0), (20_000, 4e-3, 0.0)]
)
def test_one_matrix_serves_longer(elements, step, omega, monkeypatch):
    count, tip = falling(elements, step, omega)
    monkeypatch.setattr(corotation_along, "STIFF", np.inf)
    plain, same = falling(elements, step, omega)
    assert tip == pytest.approx(same, abs=1e-7)
    assert count < 0.6 * plain
