"""Derivatives of what bodies do to each other along directions; what tangents lack of them."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_lay_kernels import SHAPES, laid, put, stage

import ancf
from helpers import some
from sloped import check_along, check_beside

BELOW = SHAPES | {
    "sphere": (ancf.Sphere(0.1, (0.01, 0.02, 0.0)), 0.15),
    "plane": (ancf.Plane((0.01, 0.02, 0.0), (0.1, -1.0, 0.2)), 0.3),
}
DEPTHS = [1e-2, 2e-3, 1e-5]


def touching(name, depth, damping, along, seed, speed):
    """A capsule this deep in a shape, both on bodies that move."""
    shape, reach = BELOW[name]
    system, rng = stage(shape, damping=damping), np.random.default_rng(seed)
    q, _ = system.initial_state()
    put(system, q, "rod", *laid(shape, reach, rng, depth, along))
    put(system, q, "other", np.zeros(3), Rotation.identity())
    return system, (q, speed * rng.uniform(-1, 1, q.size), 0.0 * q)


@pytest.mark.parametrize(("damping", "speed"), some([(30.0, 0.3), (0.0, 0.0), (100.0, 0.02)]))
@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("along", [False, True], ids=["anyhow", "along"])
@pytest.mark.parametrize("name", [name for name in BELOW if name != "sphere"])
def test_of_capsules(name, along, depth, damping, speed):
    """Across and nearly along surfaces, which share their force among several places."""
    found = []
    for seed in range(4):
        system, given = touching(name, depth, damping, along, seed, speed)
        found.append(check_along(system, "bumping", given, min(1e-7, 3e-3 * depth), 1e-8))
    assert max(found) > 1.0


@pytest.mark.parametrize("depth", DEPTHS)
@pytest.mark.parametrize("seed", range(4))
def test_of_spheres(seed, depth):
    """With a capsule: nearest to a place inside of it or to an end."""
    system, given = touching("sphere", depth, 100.0, False, seed, 0.02)
    assert check_along(system, "bumping", given, min(1e-7, 3e-3 * depth), 1e-8) > 1.0


@pytest.mark.parametrize("damping", [0.0, 100.0])
@pytest.mark.parametrize("name", BELOW)
def test_what_tangents_lack(name, damping):
    """Rates that go with the directions: all is the tangent's and what is beside it."""
    for seed in range(3):
        system, given = touching(name, 2e-3, damping, False, seed, 0.02)
        assert check_beside(system, "bumping", given) > 1e-3
