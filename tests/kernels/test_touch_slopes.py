"""Derivatives of what cables do to each other along directions, against differences of their forces."""

import numpy as np
import pytest

import ancf
from ancf.system.system import System
from sloped import check_along

D, K = 0.02, 1e6
SECTION = ancf.Section(EA=1e5, EI=0.1, rhoA=0.3, diameter=D)


def crossed(angle, gap, shift, elements, damping):
    """Two cables that cross at shares 0.5 + shift of their lengths."""
    model = ancf.Model()
    way = 0.5 * np.array([np.cos(angle), np.sin(angle), 0.0])
    at, along = np.array([0.0, 0.0, D + gap]), np.array([1.0, 0.0, 0.0])
    ends = at - (0.5 - shift) * along, at + (0.5 + shift) * along
    others = -(1.0 - 1.4 * shift) * way, (1.0 + 1.4 * shift) * way
    for name, (start, end), n in zip("ab", (ends, others), elements, strict=True):
        model.add_beam(name, start=start, end=end, elements=n, section=SECTION)
    model.add_contact(*model.bodies.values(), stiffness=K, damping=damping, name="touch")
    return System(model)


def looped(elements, damping):
    """One cable in a loop that closes on itself."""
    t = np.linspace(-0.15, 2 * np.pi + 0.15, 60)
    path = np.stack([0.3 * np.sin(t), -0.3 * np.cos(t), 0.0199 * t / (2 * np.pi)], axis=1)
    path[:, 1] *= np.where(np.abs(t - np.pi) < np.pi, 1.0, 1.02)
    model = ancf.Model()
    rope = model.add_beam("rope", path=path, elements=elements, section=SECTION)
    model.add_contact(rope, rope, stiffness=K, damping=damping, name="touch")
    return System(model)


def moved(system, speed, seed=3, by=1e-4):
    """A state near the initial one, bent by the slopes, and a motion."""
    q, rng = system.initial_state()[0], np.random.default_rng(seed)
    used = system.numbering.used()
    return (q + by * used * rng.uniform(-1, 1, q.size), speed * used * rng.uniform(-1, 1, q.size), 0.0 * q)


@pytest.mark.parametrize(("damping", "speed"), [(0.0, 0.0), (300.0, 0.1), (300.0, -0.1), (1e3, 0.05)])
@pytest.mark.parametrize(
    ("angle", "gap", "shift", "elements"),
    [
        (1.57, -2e-4, 0.0, (4, 4)),
        (1.0, -1e-3, 0.013, (5, 7)),
        (1.0, -2e-6, 0.2, (3, 4)),
        (0.3, -2e-4, 0.1, (4, 3)),
        (0.05, -1e-3, 0.3, (3, 4)),
        (0.0, -1e-3, 0.3, (2, 5)),
        (1.2, -1e-3, 0.4995, (4, 4)),
    ],
    ids=["crossed", "deep", "grazing", "slanted", "nearly along", "along", "at ends"],
)
def test_of_cables(angle, gap, shift, elements, damping, speed):
    """Zones move with the cables, end where these do, and what damping pulls is cut off."""
    system = crossed(angle, gap, shift, elements, damping)
    given = moved(system, speed, by=min(1e-4, 0.1 * abs(gap)))
    assert check_along(system, "crossing", given, min(1e-7, 3e-4 * abs(gap)), 3e-8) > 1.0


@pytest.mark.parametrize("elements", [8, 13])
@pytest.mark.parametrize("damping", [0.0, 1e3])
def test_of_a_loop(elements, damping):
    system = looped(elements, damping)
    assert check_along(system, "crossing", moved(system, 0.1), 1e-7, 1e-8) > 1.0
