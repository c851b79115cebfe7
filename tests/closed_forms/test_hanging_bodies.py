"""Rigid bodies on joints hang with their centres as low as the joints let them, wherever they are drawn."""

import numpy as np
import pytest

import ancf
from upright import UP, axes

G = 9.81
#: From a joint to the centre of the body: hanging askew, level, askew upwards, nearly and exactly upright.
ARMS = {
    "askew": (0.1, 0.0, -0.5),
    "level": (0.5, 0.0, 0.0),
    "upwards": (0.3, 0.1, 0.4),
    "nearly": (1e-6, 0.0, 0.5),
    "upright": (0.0, 0.0, 0.5),
}


def chain(count, arm, up, mass=2.0, size=1.0):
    """Bodies on ball joints, one on the other, the first one on the ground."""
    R = axes(up)
    model, place, last = ancf.Model(gravity=tuple(-G * R[2])), np.zeros(3), (0.0, 0.0, 0.0)
    for k in range(count):
        d = size * (1.0 + 0.3 * k) * R.T @ ARMS[arm]
        inertia = tuple(mass * size**2 * x for x in (0.01, 0.015, 0.02))
        body = model.add_rigid_body(f"body{k}", at=tuple(place + d), mass=(1.0 + k) * mass, inertia=inertia)
        model.connect(body.at(*-d), last)
        last, place = body.at(*d), place + 2.0 * d
    return model, R


@pytest.mark.parametrize("arm", ARMS)
@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("up", UP)
def test_a_chain_hangs_straight_down(up, count, arm):
    model, R = chain(count, arm, up)
    state = ancf.equilibrium(model)
    below, long = 0.0, float(np.linalg.norm(ARMS[arm]))
    for k in range(count):
        below -= (1.0 + 0.3 * k) * long
        assert R @ state.position(f"body{k}") == pytest.approx((0.0, 0.0, below), abs=1e-9)
        below -= (1.0 + 0.3 * k) * long


@pytest.mark.parametrize("size", [1e-3, 1.0, 50.0])
@pytest.mark.parametrize("mass", [1e-3, 1.0, 1e5])
@pytest.mark.parametrize("arm", ["upwards", "upright"])
def test_of_any_mass_and_size(arm, mass, size):
    model, _ = chain(2, arm, "z", mass, size)
    state = ancf.equilibrium(model)
    assert state.position("body1") == pytest.approx(
        (0.0, 0.0, -3.3 * size * np.linalg.norm(ARMS[arm])), abs=1e-9 * size
    )


@pytest.mark.parametrize("arm", ARMS)
@pytest.mark.parametrize("axis", [(0, 1, 0), (1, 0, 0), (0.6, 0.0, 0.8), (0.3, -0.5, 0.2)])
@pytest.mark.parametrize("up", UP)
def test_on_a_hinge_it_is_as_low_as_it_can_be(up, axis, arm):
    R = axes(up)
    e = R.T @ axis / np.linalg.norm(axis)  # never upright
    d = R.T @ ARMS[arm]
    model = ancf.Model(gravity=tuple(-G * R[2]))
    body = model.add_rigid_body("body", at=tuple(d), mass=2.0, inertia=(0.02, 0.03, 0.04))
    model.hinge(body.at(*-d), (0.0, 0.0, 0.0), axis=tuple(e))
    radius, down = np.linalg.norm(d - (d @ e) * e), -R[2] + (R[2] @ e) * e
    lowest = (d @ e) * e + radius * down / np.linalg.norm(down)
    assert ancf.equilibrium(model).position(body.centre) == pytest.approx(lowest, abs=1e-8)


@pytest.mark.parametrize("arm", ARMS)
@pytest.mark.parametrize("EI", [0.0, 0.02])
@pytest.mark.parametrize("count", [1, 2])
def test_a_hook_on_a_rope(count, EI, arm):
    """Bodies on ball joints below a rope: all of it hangs straight down."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    place = np.array((0.6, 0.1, -0.8))
    section = ancf.Section(EA=1e6, EI=EI, rhoA=0.2)
    rope = model.add_beam("rope", start=(0, 0, 0), end=tuple(place), elements=6, section=section)
    model.pin(rope.start)
    last, total = rope.end, 0.0
    for k in range(count):
        d = np.array(ARMS[arm])
        body = model.add_rigid_body(
            f"body{k}", at=tuple(place + d), mass=1.0 + k, inertia=(0.01, 0.015, 0.02)
        )
        model.connect(body.at(*-d), last)
        last, place, total = body.at(*d), place + 2.0 * d, total + 1.0 + k
    state, length = ancf.equilibrium(model), np.linalg.norm((0.6, 0.1, -0.8))
    stretched = length + 9.81 * length * (total + 0.1 * length) / 1e6
    low = -stretched - (2 * count - 1) * np.linalg.norm(ARMS[arm])
    assert state.position(f"body{count - 1}") == pytest.approx((0.0, 0.0, low), abs=1e-6)


@pytest.mark.parametrize("count", [1, 2, 3])
@pytest.mark.parametrize("arm", ["askew", "upright"])
@pytest.mark.parametrize(("mass", "size"), [(2.0, 1.0), (1e-3, 1e-2), (1e4, 30.0)])
@pytest.mark.parametrize("up", UP)
def test_modes_about_it(up, mass, size, arm, count):
    """A compound pendulum swings in two planes with w^2 = m g l/(I + m l^2); it turns about itself freely."""
    R, d = axes(up), size * axes(up).T @ ARMS["upright" if arm == "upright" else "askew"]
    model, inertia = ancf.Model(gravity=tuple(-G * R[2])), 0.05 * mass * size**2
    body = model.add_rigid_body("body", at=tuple(d), mass=mass, inertia=(inertia, inertia, inertia))
    model.connect(body.at(*-d), (0.0, 0.0, 0.0))
    arm_length = np.linalg.norm(d)
    square = mass * G * arm_length / (inertia + mass * arm_length**2)
    found = ancf.modes(model, about=ancf.equilibrium(model), count=count).frequencies_hz
    expected = np.sqrt([0.0, square, square])[:count] / (2.0 * np.pi)
    assert found == pytest.approx(expected, rel=1e-7, abs=1e-6 * np.sqrt(square))
