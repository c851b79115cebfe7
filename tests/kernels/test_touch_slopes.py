"""Derivatives of what cables do to each other along directions, against differences of their forces."""

import numpy as np
import pytest
from test_changes import forces, found_by_kernel

import ancf
from ancf.compiled import traits
from ancf.contact.strand import DAMPING, RADIUS, STIFFNESS
from ancf.solvers.derivatives.sensitivity import Way
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


@pytest.mark.parametrize("speed", [0.03, 0.1, -0.1])
@pytest.mark.parametrize(
    ("angle", "gap", "shift", "elements"),
    [
        (1.57, -2e-4, 0.0, (4, 4)),
        (1.0, -1e-3, 0.013, (5, 7)),
        (0.3, -2e-4, 0.1, (4, 3)),
        (1.2, -1e-3, 0.4995, (4, 4)),
    ],
    ids=["crossed", "deep", "slanted", "at ends"],
)
def test_of_numbers(angle, gap, shift, elements, speed):
    """Stiffness, damping and radii of a contact, by themselves and together, against differences."""
    system = crossed(angle, gap, shift, elements, 300.0)
    batch, way = system.parts["crossing"], Way(*(x[None] for x in moved(system, speed)))
    moves = [np.zeros((2, *batch.data.shape)) for _ in range(3)]
    for move, column in zip(moves, (STIFFNESS, DAMPING, RADIUS), strict=True):
        move[0, :, column] = batch.data[:, column]
    radii = [np.zeros_like(batch.radius)] * 3 + [0.01 * batch.radius, np.where(batch.cable == 0, 1e-4, 0.0)]
    moves = [*(move[0] for move in moves), np.zeros_like(batch.data), moves[0][0] + 0.01 * moves[2][0]]

    def at(k, e):
        """The batch with the k-th change."""
        return batch._replace(data=batch.data + e * moves[k], radius=batch.radius + e * radii[k])

    numbers, step = traits(batch).numbers, 1e-4
    rates = [numbers(at(k, 1.0)) - numbers(batch) for k in range(len(moves))]
    found = found_by_kernel(system, rates, way, "crossing")
    for k, own in enumerate(found):
        near = [forces(system, at(k, step * x), way) for x in (-2.0, -1.0, 1.0, 2.0)]
        wanted = (near[0] - 8.0 * near[1] + 8.0 * near[2] - near[3]) / (12.0 * step)
        assert np.max(np.abs(own - wanted)) <= 1e-8 * np.max(np.abs(wanted)), k
        assert np.max(np.abs(wanted)) > 1e-6, k


@pytest.mark.parametrize("elements", [8, 13])
@pytest.mark.parametrize("damping", [0.0, 1e3])
def test_of_a_loop(elements, damping):
    system = looped(elements, damping)
    assert check_along(system, "crossing", moved(system, 0.1), 1e-7, 1e-8) > 1.0
