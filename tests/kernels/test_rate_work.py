"""What velocities do to x . force by the shape: the kernels against differences of the forces."""

import numpy as np
import pytest

import ancf
from ancf.batches import Batches
from ancf.compiled import kernel
from ancf.sensitivity.base import matrices_of
from ancf.solvers.derivatives.directions import products_along
from ancf.solvers.rare import add_rate_works, add_tangent_works
from ancf.system.core import residual
from ancf.system.system import System
from strained import SECTIONS, cable, sprung, states


@kernel
def all_works(batches, q, v, x, out, ws):
    add_rate_works(batches, q, v, x, out, ws)


@kernel
def all_products(batches, q, v, x, by_q, by_v, by_a, ws):
    add_tangent_works(batches, q, v, x, by_q, by_v, by_a, ws)


def check(system, seed, parts=None):
    """Along a random change of the shape: differences of order six, without what is in the matrices."""
    core, size = system.core, system.size
    q, v, a, x, rng = states(system, seed)
    change = 0.02 * np.where(q != 0.0, 1.0, 0.0) * rng.uniform(-1, 1, size)
    m = matrices_of(core, size, moving=True, back=True)
    assert len(m.stirred)
    assert not len(m.rough) + len(m.lossy)
    batches = Batches((parts or system.parts).values())

    def force(e):
        r = np.empty(size)
        residual(batches, core.ws, q + e * change, v, a, np.zeros(size), r)
        return x @ r

    one, two, three = ((force(e) - force(-e)) / (2 * e) for e in (1e-3, 2e-3, 3e-3))
    still, known, out = np.zeros(size), np.empty(size), np.zeros(size)
    along = np.stack([change, still, still])
    products_along(core, m, q, v, a, along, np.zeros((0, 3, 3)), still, known)
    all_works(m.stirred, q, v, x, out, core.ws)
    products = np.zeros((3, size))
    all_products(m.worked, q, v, x, *products, core.ws)
    known = np.concatenate([x * known, products[0] * change])  # in matrices, and of those who do without
    wanted = 1.5 * one - 0.6 * two + 0.1 * three - known.sum()
    terms = np.abs(out * change).sum()
    round_off = np.finfo(float).eps * abs(force(0.0)) / 1e-3
    assert abs(out @ change - wanted) <= 1e-8 * terms + 1e-11 * np.abs(known).sum() + 4 * round_off
    assert terms > 1e-6 * np.abs(known).sum()


@pytest.mark.parametrize("elements", [3, 9])
@pytest.mark.parametrize("shape", ["straight", "curved"])
@pytest.mark.parametrize("strain", ["material", "paper"])
@pytest.mark.parametrize("damping", ["axial", "bending", "all"])
def test_of_cables(damping, strain, shape, elements):
    check(System(cable(strain, elements, shape, **SECTIONS[damping])[0]), 1)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_of_springs(seed):
    check(System(sprung()), seed)


@pytest.mark.parametrize("element", ["original", "nonlocking"])
@pytest.mark.parametrize("damping", [{"axial_damping": 5.0}, {"bending_damping": 0.5}])
def test_of_solid_beams(damping, element):
    model = ancf.Model()
    section = ancf.Section.rectangle(0.2, 0.1, E=1e3, rho=9.0, **damping)
    given = {"start": (0, 0, 0), "end": (1.2, 0.3, 0), "elements": 3, "section": section}
    model.add_beam("beam", element=element, **given)
    check(System(model), 1)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_of_torsion_springs(seed):
    """Between two bodies, and against the ground."""
    model = ancf.Model()
    hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=1.0, inertia=(1, 2, 3))
    arm = model.add_rigid_body("arm", at=(1, 0, 0), mass=1.0, inertia=(1, 2, 3))
    model.add_torsion_spring(hub, arm, axis=(0, 1, 0.3), stiffness=3.0, damping=7.0)
    model.add_torsion_spring(arm, (1, 0, 0), axis=(1, 1, 0), stiffness=3.0, damping=2.0)
    system = System(model)
    free = {name: batch for name, batch in system.parts.items() if not hasattr(batch, "level")}
    check(system, seed, free)
