"""What supports hold stays where it is told to be, to the last bit, whatever moves around it."""

import numpy as np
import pytest

import ancf
from random_models import RandomModel

METHODS = {
    "trapezoidal": ancf.Trapezoidal(),
    "kept matrix": ancf.Trapezoidal(newton=ancf.Newton(corotate=False)),
    "index 1": ancf.Trapezoidal(formulation="index1"),
    "alpha": ancf.GeneralizedAlpha(rho_inf=0.8),
}
#: Some with clamps that turn, in whose axes directions are held, beside sliding joints.
SEEDS = [30, 55, 67, *range(10)]


def still(system):
    """Unknowns that are held and have no motion of their own, as directions along axes that turn."""
    return np.setdiff1d(system.core.supports.held, system.core.supports.prescribed)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("method", METHODS)
def test_random_models(method, seed):
    """Held directions of turning clamps drifted, 1 mrad in 20 ms of steps of 10 µs beside a sliding joint."""
    run = ancf.stepper(RandomModel(seed).model, step=5e-5, integrator=METHODS[method])
    held = still(run.system)
    first = run.q[held]
    run.advance(300)
    assert np.array_equal(run.q[held], first)
    assert not run.v[held].any()


@pytest.mark.parametrize("elements", [1, 2, 5])
@pytest.mark.parametrize("others", [0, 1, 3])
@pytest.mark.parametrize("step", [1e-3, 1e-5])
def test_a_clamp_that_turns_beside_a_ring(step, others, elements):
    """Its direction is the given one, however many bodies there are before and behind the cable."""
    model = ancf.Model(gravity=(0.0, 1.0, -9.81))
    section = ancf.Section(EA=300.0, EI=0.5, rhoA=0.8, bending_damping=0.01)
    for k in range(others):
        model.add_beam(f"before{k}", start=(0, k + 1, 0), end=(1, k + 1, 0), elements=2, section=section)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
    for k in range(others):
        model.add_rigid_body(f"behind{k}", at=(k, 0, 3), mass=1.0, inertia=(0.1, 0.2, 0.3))
    model.clamp(rope.start, rotation=lambda t: 0.3 * np.sin(9.0 * t), axis=(0, 1, 0))
    model.slide((0.4, 0, 0), along=rope, friction=0.2)
    run = ancf.stepper(model, step=step)
    run.advance(round(0.02 / step))
    direction = run.slope("rope.start") / np.linalg.norm(run.slope("rope.start"))
    angle = 0.3 * np.sin(9.0 * run.t)
    assert np.abs(direction - (np.cos(angle), 0.0, -np.sin(angle))).max() < 1e-14
