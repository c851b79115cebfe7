"""Elements of changing length: stiffness and force on the length by differences, momenta by quadrature."""

import numpy as np
import pytest

import ancf
from ancf.linalg.sparse import to_sparse
from ancf.system.core import assemble, residual
from ancf.system.energy import energies
from ancf.system.system import System
from compiled_kernels import total_strain_energy

G = np.array([0.3, -0.2, -9.81])


def winched(at_start, strain, speed=0.0):
    """A cable in a shape and a motion at random, one and a half times as long as its mesh, and its System."""
    section = ancf.Section(EA=40.0, EI=2.0, rhoA=0.7)
    model = ancf.Model(gravity=G)
    given = {"section": section, "nodes": [0.0, 0.4, 0.9, 1.2], "strain": strain}
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1.2, 0.1, 0), length=1.2, **given)
    model.winch(beam.start if at_start else beam.end, length=f"1.8 + {speed}*t")
    system = System(model)
    rng = np.random.default_rng(5)
    q, v = system.initial_state()
    length = system.lengths["beam"][0]
    used = np.setdiff1d(np.flatnonzero(system.numbering.used()), [length, length + 1, length + 2])
    q[used] = 1.5 * q[used] + 0.1 * rng.uniform(-1, 1, len(used))
    v[used] = rng.uniform(-1, 1, len(used))
    return system, beam, q, v, length, used


def out_of_balance(system, q, v, a):
    r, none = np.empty_like(q), np.zeros_like(q)
    residual(system.core.batches, system.core.ws, q, v, a, none, r)
    return r


CASES = [(True, "material"), (False, "paper")]


@pytest.mark.parametrize(("at_start", "strain"), CASES)
def test_stiffness_is_the_derivative_of_the_forces(at_start, strain):
    system, _, q, _, _length, used = winched(at_start, strain)
    none, core, h = np.zeros_like(q), system.core, 1e-6
    assemble(core.batches, core.ws, q, none, core.A, 0.0, 0.0, 1.0)
    K = to_sparse(core.A, system.places).toarray()
    rng = np.random.default_rng(1)
    d = np.zeros_like(q)
    d[used] = rng.uniform(-1, 1, len(used))
    ahead, behind = (out_of_balance(system, q + s * h * d, none, none) for s in (1, -1))
    slope = (ahead - behind) / (2 * h)
    assert (K @ d[: system.n])[used] == pytest.approx(slope[used], rel=1e-6, abs=1e-6)


@pytest.mark.parametrize(("at_start", "strain"), CASES)
def test_force_on_the_length_at_rest_is_that_of_the_energies(at_start, strain):
    system, _, q, _, length, _ = winched(at_start, strain)
    none, h = np.zeros_like(q), 1e-5
    change = np.zeros_like(q)
    change[length] = h
    ahead, behind = (energies(system, (q + s * change)[None], none[None])[0] for s in (1, -1))
    force = out_of_balance(system, q, none, none)[length]
    assert force == pytest.approx((ahead - behind)[1:].sum() / (2 * h), rel=1e-7)


@pytest.mark.parametrize(("at_start", "strain"), CASES)
def test_all_power_is_the_rate_of_the_energies(at_start, strain):
    """Whatever the accelerations: sum v r, weight aside, is d/dt of kinetic, strain and potential energy."""
    system, _, q, v, length, used = winched(at_start, strain, speed=0.8)
    rng = np.random.default_rng(2)
    a, h = np.zeros_like(q), 1e-5
    v[length] = 0.8
    a[used], a[length] = rng.uniform(-1, 1, len(used)), 0.6
    states = [(q + s * h * v + 0.5 * h * h * a, v + s * h * a) for s in (1, -1)]
    ahead, behind = (energies(system, x[None], rate[None])[0] for x, rate in states)
    loads = system.core.loads
    weight = q[length] * loads.hung  # it is no force of the elements
    of_weight = sum(w @ v[i : i + 3] for w, i in zip(weight, loads.hung_slot, strict=True))
    power = v @ out_of_balance(system, q, v, a) - of_weight
    assert power == pytest.approx((ahead - behind).sum() / (2 * h), rel=1e-7)


@pytest.mark.parametrize(("at_start", "strain"), CASES)
def test_momenta_are_those_of_the_material(at_start, strain):
    """By many points: v - r_x times the speed of the places past the material."""
    system, beam, q, v, length, _ = winched(at_start, strain)
    v[length] = -0.7
    state = ancf.State(system, 0.0, q, v)
    x, weight = np.polynomial.legendre.leggauss(6)
    p, L, kinetic = np.zeros(3), np.zeros(3), 0.0
    for a, b in zip(beam.node_x, beam.node_x[1:], strict=False):
        for s, w in zip(0.5 * (a + b) + 0.5 * (b - a) * x, 0.5 * (b - a) * weight, strict=True):
            point, dm = beam.at(s), w * 1.5 * 0.7
            from_far = s - (1.2 if at_start else 0.0)
            speed = state.velocity(point) - state.slope(point) * (-0.7 / 1.2) * from_far
            p, L = p + dm * speed, L + dm * np.cross(state.position(point) - (1, 2, 3), speed)
            kinetic += 0.5 * dm * speed @ speed
    assert state.momentum == pytest.approx(p, rel=1e-12)
    assert state.angular_momentum((1, 2, 3)) == pytest.approx(L, rel=1e-12)
    assert state.energy.kinetic == pytest.approx(kinetic, rel=1e-12)
    assert total_strain_energy(system.core.batches, system.core.ws, q) == state.energy.strain
