"""Momentum and angular momentum against sums over points, closed forms and the impulses of loads."""

from itertools import pairwise

import numpy as np
import pytest

import ancf
from ancf.elements.registry import ELEMENTS
from helpers import cable

G = np.array([0.3, -0.2, -9.81])


def flying(element="cable"):
    """A curved beam, a mass on it, a rigid body that spins beside it: nothing holds them."""
    model = ancf.Model(gravity=G)
    _, beam = cable("curved", elements=5, element=element, model=model)
    beam.set_motion(velocity=(0.3, 0.1, -0.2), angular_velocity=(1.0, -2.0, 1.5))
    hub = model.add_rigid_body("hub", at=(2, 1, 0), mass=1.3, inertia=(0.02, 0.03, 0.04))
    hub.set_motion(velocity=(0.0, 1.0, 0.5), angular_velocity=(3.0, 1.0, -2.0))
    bob = model.add_point_mass("bob", at=(0.2, 2.0, 0.1), mass=0.7)
    bob.set_motion(velocity=(-1.0, 0.0, 2.0))
    return model, beam, hub, bob


def of_points(state, beam):
    """Mass, momentum and angular momentum of a thin cable from many points on it."""
    x, weight = np.polynomial.legendre.leggauss(8)
    p, L, mass = np.zeros(3), np.zeros(3), 0.0
    for a, b in pairwise(beam.node_x):
        for s, w in zip(0.5 * (a + b) + 0.5 * (b - a) * x, 0.5 * (b - a) * weight, strict=True):
            dm = w * beam.section.rhoA
            r, v = state.position(beam.at(s)), state.velocity(beam.at(s))
            p, L, mass = p + dm * v, L + dm * np.cross(r, v), mass + dm
    return mass, p, L


@pytest.mark.parametrize("about", [(0, 0, 0), (1.0, -2.0, 0.5)])
def test_sum_over_points_and_bodies(about):
    model, beam, hub, bob = flying()
    result = ancf.simulate(model, t_end=0.05, step=1e-3)
    for k in (0, 17, 50):
        state = result.state(k)
        _, p, L = of_points(state, beam)
        w = state.angular_velocity(hub)
        R = np.stack([state.position(hub.at(*e)) - state.position(hub.centre) for e in np.eye(3)], axis=1)
        L = L + R @ np.diag([0.02, 0.03, 0.04]) @ R.T @ w
        for body, mass in ((hub.centre, 1.3), (bob, 0.7)):
            r, v = state.position(body), state.velocity(body)
            p, L = p + mass * v, L + mass * np.cross(r, v)
        L = L - np.cross(about, p)
        assert np.allclose(state.momentum, p, rtol=1e-10)
        assert np.allclose(state.angular_momentum(about), L, rtol=1e-9)
        assert np.array_equal(result.momentum[k], state.momentum)
        assert np.array_equal(result.angular_momentum(about)[k], state.angular_momentum(about))


@pytest.mark.parametrize("element", ELEMENTS)
def test_grow_by_the_impulse_of_gravity(element):
    model, beam, _, _ = flying(element)
    mass = 1.3 + 0.7 + beam.section.rhoA * beam.length
    result = ancf.simulate(model, t_end=0.1, step=1e-3)
    p, L = result.momentum, result.angular_momentum()
    assert np.allclose(p, p[0] + np.outer(result.t, mass * G), atol=1e-9 * np.abs(p).max())
    # dL/dt = M r_c x g, and r_c moves by the momentum: by the trapezoidal rule of p
    arm = np.cumsum(np.vstack([np.zeros(3), 0.5e-3 * (p[1:] + p[:-1])]), axis=0)
    spin = np.cumsum(
        np.vstack([np.zeros(3), 0.5e-3 * (np.cross(arm, G)[1:] + np.cross(arm, G)[:-1])]), axis=0
    )
    start = L[0] + np.outer(result.t, np.cross(first_moment(result), G))
    assert np.allclose(L, start + spin, atol=2e-5 * np.abs(L).max())


def summed(rates):
    """Integral from the start by the trapezoidal rule."""
    return np.cumsum(np.vstack([np.zeros(3), 0.5e-3 * (rates[1:] + rates[:-1])]), axis=0)


def first_moment(result):
    """Sum of m r at the start."""
    beam = result.model.bodies["beam"]
    x, weight = np.polynomial.legendre.leggauss(12)
    total = 1.3 * result.position("hub.centre")[0] + 0.7 * result.position("bob")[0]
    for a, b in pairwise(beam.node_x):
        for s, w in zip(0.5 * (a + b) + 0.5 * (b - a) * x, 0.5 * (b - a) * weight, strict=True):
            total = total + w * beam.section.rhoA * result.position(beam.at(s))[0]
    return total


@pytest.mark.parametrize("seed", range(4))
def test_angular_velocity_of_a_body(seed):
    rng = np.random.default_rng(seed)
    w = rng.normal(size=3)
    model = ancf.Model()
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    hub = model.add_rigid_body("hub", at=(1, 2, 3), mass=2.0, inertia=(0.2, 0.2, 0.2), axes=axes)
    hub.set_motion(angular_velocity=w)
    result = ancf.simulate(model, t_end=0.1, step=1e-3)
    assert result.angular_velocity("hub").shape == (101, 3)
    assert np.allclose(result.angular_velocity(hub), w, atol=1e-4)
    assert np.allclose(result.state(0).angular_velocity(hub), w, atol=1e-13)


def test_of_a_file_and_of_a_run_that_goes_on(tmp_path):
    model, *_ = flying()
    result = ancf.simulate(model, t_end=0.02, step=1e-3, file=tmp_path / "a.h5")
    loaded = ancf.load(tmp_path / "a.h5")
    assert np.array_equal(loaded.momentum, result.momentum)
    assert np.array_equal(loaded.angular_momentum((1, 0, 0)), result.angular_momentum((1, 0, 0)))
    run = ancf.stepper(model, step=1e-3)
    run.advance(20)
    assert np.array_equal(run.momentum, result.momentum[-1])


def test_what_has_none():
    model, *_ = flying()
    state = ancf.simulate(model, t_end=1e-3, step=1e-3).state()
    with pytest.raises(ancf.ModelError, match="is no rigid body"):
        state.angular_velocity("bob")
    with pytest.raises(ancf.ModelError, match=r"unknown rigid body .hob., known: .hub."):
        state.angular_velocity("hob")
    with pytest.raises(ancf.ModelError, match=r"angular_momentum\.about"):
        state.angular_momentum((1, 2))
