"""What happens to sliding joints in steps of Radau: contact opens, carriers end; as by other methods."""

import numpy as np
import pytest

import ancf

T = 0.24
RADAU = {
    "3, constant": (ancf.Radau(adaptive=False), 2.5e-4),
    "2, constant": (ancf.Radau(stages=2, adaptive=False), 5e-4),
    "3, adaptive": (ancf.Radau(), 1e-3),
    "2, adaptive": (ancf.Radau(stages=2, tolerance=1e-7), 1e-3),
}


def cart(pull=4.0, frequency=60.0, speed=1.5, **joint):
    """A cart below a stiff wire, which pulls at it until it is pushed away, or reaches the end."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e5, EI=20.0, rhoA=0.5)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=6, section=section)
    model.clamp(wire.start)
    model.clamp(wire.end)
    mass = model.add_point_mass("cart", at=(0.3, 0, 0), mass=0.3)
    mass.set_motion(velocity=(speed, 0, 0))
    model.slide(mass, along=wire, name="joint", **joint)
    model.add_force(mass, (0, 0, f"{pull}*sin({frequency}*t)"))
    return model


CARTS = {
    "opens": {"unilateral": (0, 0, 1)},
    "opens early": {"unilateral": (0, 0, 1), "pull": -4.0, "frequency": 25.0},
    "closes again": {"unilateral": (0, 0, 1), "pull": 9.0, "frequency": 40.0},
    "opens the other way": {"unilateral": (0, 0, -1), "pull": 6.0, "frequency": 20.0},
    "leaves": {"at_end": "release", "speed": 9.0},
    "ends": {"at_end": "clamp", "speed": 9.0},
}


@pytest.fixture(scope="module")
def wanted():
    """Of each cart its motion and multipliers with short steps."""
    found = {}

    def of(name):
        if name not in found:
            found[name] = ancf.simulate(cart(**CARTS[name]), t_end=T, step=1e-4, output_step=2e-3)
        return found[name]

    return of


@pytest.mark.parametrize("method", RADAU)
@pytest.mark.parametrize("name", CARTS)
def test_moves_as_by_the_trapezoidal_rule(name, method, wanted):
    """Events are at ends of steps: places differ by what a step later or earlier does."""
    integrator, step = RADAU[method]
    run = ancf.simulate(cart(**CARTS[name]), t_end=T, step=step, output_step=2e-3, integrator=integrator)
    other = wanted(name)
    assert np.allclose(run.position("cart"), other.position("cart"), rtol=0, atol=2e-2 * 9.0 * step + 5e-4)
    assert np.max(np.abs(run.energy.drift)) < 1e-3
    if "unilateral" in CARTS[name]:
        along = run.multiplier("joint") @ np.array(CARTS[name]["unilateral"])
        opened = np.flatnonzero(np.all(other.multiplier("joint")[:, [2]] == 0.0, axis=1))
        assert len(opened) > 20
        far = opened[opened > opened[0] + 3]
        free = np.linalg.norm(run.position("cart") - other.position("cart"), axis=1) < 1e-3
        assert np.any(along[far] == 0.0)
        assert np.min(along) > -0.5
        assert np.max(np.abs(along)) < 200.0
        assert np.all(free[far])
