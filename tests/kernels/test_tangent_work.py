"""Products of matrices with a vector, without the matrices: the kernels against differences of the forces."""

import numpy as np
import pytest

from ancf.batches import Batches, add_tangents
from ancf.compiled import add_rate_work, add_tangent_work, kernel
from ancf.solvers.rare import add_rate_works, add_tangent_works, knowing
from ancf.system.core import residual
from ancf.system.system import System
from strained import SECTIONS, SOLIDLY, cable, of_solids, solid, sprung, states

#: Batches of points, which have no elements of their own.
MADE_OF_POINTS = ("SpringBatch", "InertiaBatch")


@kernel
def all_works(batches, q, v, x, by_q, by_v, by_a, ws):
    add_tangent_works(batches, q, v, x, by_q, by_v, by_a, ws)


@kernel
def rate_works(batches, q, v, x, out, ws):
    add_rate_works(batches, q, v, x, out, ws)


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


def hung():
    """Springs of all kinds at a cable, one with curves, at a mass and at a rigid body."""
    model = sprung()
    mass = model.add_point_mass("mass", at=(0.4, 0.1, -0.6), mass=3.0)
    body = model.add_rigid_body("body", at=(1.0, 0.2, -0.5), mass=2.0, inertia=(0.5, 0.7, 0.9))
    force, loss = [(-1.0, -4.0), (0.0, 0.0), (2.0, 9.0)], [(-3.0, -5.0), (0.0, 0.0), (3.0, 7.0)]
    model.add_spring(mass, (0.9, 0.3, 0.5), stiffness=5.0, damping=2.0, length=0.3, slack=True)
    model.add_spring(mass, body.at(0.1, 0.2, 0.0), law=force, damper=loss, length=0.4)
    return model


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_of_springs_and_masses(seed):
    """By q, with what velocities do, v and a, by differences of order six of the forces in motion."""
    system = System(hung())
    core, size = system.core, system.size
    q, v, a, x, rng = states(system, seed)
    batches = [batch for name, batch in system.parts.items() if type(batch).__name__ in MADE_OF_POINTS]
    assert len(batches) == 2
    made, whole = np.zeros((3, size)), Batches(batches)
    all_works(knowing(add_tangent_work, batches), q, v, x, *made, core.ws)
    rate_works(knowing(add_rate_work, batches), q, v, x, made[0], core.ws)

    def work(*state):
        r = np.empty(size)
        residual(whole, core.ws, *state, np.zeros(size), r)
        return x @ r

    used = np.where(q != 0.0, 1.0, 0.0)
    for which, (found, e) in enumerate(zip(made, (1e-4, 1e-3, 1.0), strict=True)):
        change = used * rng.uniform(-1, 1, size)

        def slope(step, which=which, change=change):
            ahead, behind = [q, v, a], [q, v, a]
            ahead[which], behind[which] = ahead[which] + step * change, behind[which] - step * change
            return (work(*ahead) - work(*behind)) / (2 * step)

        wanted = 1.5 * slope(e) - 0.6 * slope(2 * e) + 0.1 * slope(3 * e)
        round_off = 4e-16 * abs(work(q, v, a)) / e
        assert found @ change == pytest.approx(
            wanted, abs=1e-8 * np.abs(found * change).sum() + 9 * round_off
        )
        assert np.abs(found).max() > 0.0
