"""Products of matrices with a vector, without the matrices: the kernels against differences of the forces."""

import numpy as np
import pytest

from ancf.batches import Batches, add_tangents
from ancf.compiled import add_tangent_work, kernel
from ancf.solvers.rare import add_tangent_works, knowing
from ancf.system.core import residual
from ancf.system.system import System
from strained import SECTIONS, SOLIDLY, cable, of_solids, solid, states


@kernel
def all_works(batches, q, v, x, by_q, by_v, by_a, ws):
    add_tangent_works(batches, q, v, x, by_q, by_v, by_a, ws)


@kernel
def tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws):
    add_tangents(batches, q, v, A, c_mass, c_damping, c_stiffness, ws)


def check(model, name, seed=1):
    """K x by differences of order six at rest; in rates and accelerations forces are linear."""
    system = System(model)
    batch, size = system.parts[name], system.size
    q, v, a, x, rng = states(system, seed)
    change = 0.02 * np.where(q != 0.0, 1.0, 0.0) * rng.uniform(-1, 1, size)
    batches, none, ws = Batches([batch]), np.zeros(size), system.core.ws
    made = np.zeros((3, size))
    all_works(knowing(add_tangent_work, [batch]), q, v, x, *made, ws)

    def work(q, v, a):
        r = np.empty(size)
        residual(batches, ws, q, v, a, np.zeros(size), r)
        return x * r

    def slope(e):
        return (work(q + e * change, none, none) - work(q - e * change, none, none)).sum() / (2 * e)

    wanted = 1.5 * slope(1e-3) - 0.6 * slope(2e-3) + 0.1 * slope(3e-3)
    still = work(q, none, none)
    round_off = 1e-12 * np.abs(still).sum()
    assert abs(made[0] @ change - wanted) <= 1e-9 * np.abs(made[0] * change).sum() + 1e3 * round_off
    for found, own, given in ((made[1], v, (q, v, none)), (made[2], a, (q, none, a))):
        terms = work(*given)
        wanted = (terms - still).sum()
        assert abs(found @ own - wanted) <= 1e-11 * np.abs(found * own).sum() + round_off
    return [np.abs(one).max() for one in made]


@of_solids
def test_of_solid_beams(element, shape, section, damping, elements):
    stiff, damped, heavy = check(solid(element, shape, section, elements, **SOLIDLY[damping])[0], element)
    assert min(stiff, heavy) > 0.0
    assert (damped > 0.0) == (damping != "plain")


@pytest.mark.parametrize("elements", [3, 9])
@pytest.mark.parametrize("shape", ["straight", "curved"])
@pytest.mark.parametrize("strain", ["material", "paper"])
@pytest.mark.parametrize("damping", SECTIONS)
def test_of_cables(damping, strain, shape, elements):
    stiff, damped, heavy = check(cable(strain, elements, shape, **SECTIONS[damping])[0], "cable")
    assert min(stiff, heavy) > 0.0
    assert (damped > 0.0) == (damping != "plain")


@pytest.mark.parametrize("damping", SOLIDLY)
@pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
def test_the_matrix_of_a_step_is_the_sum_of_its_parts(element, damping):
    """Of each alone there are fewer blocks."""
    own = SOLIDLY[damping]
    made = cable("material", 3, "curved", **own) if element == "cable" else solid(element, "curved", **own)
    system = System(made[0])
    q, v, _, _, _ = states(system, 1)
    batches, parts = Batches([system.parts[element]]), np.zeros((4, system.core.A.size))
    for A, factors in zip(parts, ((7.0, 0, 0), (0, 3.0, 0), (0, 0, 1.0), (7.0, 3.0, 1.0)), strict=True):
        tangents(batches, q, v, A, *map(float, factors), system.core.ws)
    for k in range(3):
        assert np.any(parts[k]) == (k != 1 or damping != "plain")
    assert np.abs(parts[3] - parts[:3].sum(axis=0)).max() <= 1e-13 * np.abs(parts[:3]).sum(axis=0).max()
