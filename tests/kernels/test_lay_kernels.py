"""Capsules on surfaces of revolution: nearest places, forces as the gradient of the energy, no jumps."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from test_surface_kernels import force_and_matrix

import ancf
from ancf.contact.profiles import distances
from ancf.system.system import System

K, RADIUS, LENGTH = 1e4, 0.03, 0.3
#: Shapes with axes of their own, and how far from their middles a capsule may be that touches.
SHAPES = {
    "cylinder": (ancf.Cylinder(0.1, (0.01, 0.02, 0.0), (0.1, 0.3, 1.0)), 0.14),
    "can": (ancf.Cylinder(0.1, (0.01, 0.02, 0.0), (0.1, 0.3, 1.0), length=0.25), 0.2),
    "capsule": (ancf.Capsule(0.08, 0.2, (0.01, 0.02, 0.0), (0.1, 0.3, 1.0)), 0.2),
    "torus": (ancf.Torus(0.15, 0.02, (0.01, 0.02, 0.0), (0.1, 0.3, 1.0)), 0.2),
    "sheave": (ancf.Sheave(0.1, 0.04, 0.06, 0.9, (0.01, 0.02, 0.0), (0.1, 0.3, 1.0)), 0.2),
}


def stage(shape, **more):
    """System of a capsule along x of its body and a shape on another body, far from each other."""
    model = ancf.Model()
    for k, (name, skin) in enumerate(
        [("rod", ancf.Capsule(RADIUS, LENGTH, axis=(1, 0, 0))), ("other", shape)]
    ):
        body = model.add_rigid_body(name, at=(0, 10.0 * k, 0), mass=1.0, inertia=(1, 1, 1))
        model.add_surface(f"skin of {name}", skin, on=body)
    model.add_contact("skin of rod", "skin of other", stiffness=K, **more)
    return System(model)


def put(system, q, name, at, turn):
    """Lay a body there."""
    slots = system.slots[name][0]
    for slot, x in zip(slots, [at, *turn.as_matrix().T], strict=True):
        q[slot : slot + 3] = x


def axis_of(at, turn, count=4001):
    return at + np.linspace(-0.5, 0.5, count)[:, None] * LENGTH * turn.apply([1.0, 0.0, 0.0])


def laid(shape, reach, rng, depth, along=False):
    """A place and a turn of the rod in which it is this deep in a shape at the origin, or nearly along it."""
    line, _ = Rotation.align_vectors([shape.direction], [[1.0, 0.0, 0.0]])
    while True:
        turn, way = Rotation.random(rng=rng), rng.standard_normal(3)
        turn = Rotation.from_rotvec(0.05 * rng.standard_normal(3)) * line if along else turn
        middle, way = rng.uniform(-reach, reach, 3), way / np.linalg.norm(way)
        far, near = middle + 2.0 * way, middle
        if distances(shape, axis_of(near, turn, 201)).min() > RADIUS - depth:
            continue
        for _ in range(50):
            at = 0.5 * (far + near)
            inside = distances(shape, axis_of(at, turn)).min() < RADIUS - depth
            far, near = (far, at) if inside else (at, near)
        return at, turn


def energy(system, q):
    return ancf.State(system, 0.0, q, 0.0 * q).energy.strain


def rigid(system, q, name, move, spin):
    """Rates of a body that moves and turns."""
    rate = np.zeros_like(q)
    for k, slot in enumerate(system.slots[name][0]):
        rate[slot : slot + 3] = np.cross(spin, q[slot : slot + 3]) + (move if k == 0 else 0.0)
    return rate


@pytest.mark.parametrize("name", SHAPES)
def test_nearest_place(name):
    """The gap against many places on the axis, touching or far."""
    shape, reach = SHAPES[name]
    system, rng = stage(shape), np.random.default_rng(5)
    other = Rotation.random(rng=rng)
    for depth in [*rng.uniform(0.0, 0.02, 10), *rng.uniform(-0.1, 0.0, 10)]:
        at, turn = laid(shape, reach, rng, depth)
        q, v = system.initial_state()
        put(system, q, "rod", other.apply(at) + 1.0, other * turn)
        put(system, q, "other", np.ones(3), other)
        found = ancf.State(system, 0.0, q, v).contact_gap("contact of skin of rod and skin of other")
        assert found == pytest.approx(-depth, abs=1e-6)


@pytest.mark.parametrize("name", SHAPES)
def test_forces_are_the_gradient_of_the_energy(name):
    """By moves and turns of both, from all sides; no force and no moment is left over."""
    shape, reach = SHAPES[name]
    system, rng = stage(shape), np.random.default_rng(7)
    for along, depth in zip([False, True] * 20, rng.uniform(1e-4, 0.015, 40), strict=True):
        check_gradient(system, *laid(shape, reach, rng, depth, along), rng)


def check_gradient(system, at, turn, rng):
    """Of the energy by moves and turns of both bodies, the second one at the origin."""
    q, v = system.initial_state()
    put(system, q, "rod", at, turn)
    put(system, q, "other", np.zeros(3), Rotation.identity())
    r, _ = force_and_matrix(system, "bumping", q, v)
    size = np.abs(r).max()
    assert size > 0.0
    for body in ("rod", "other"):
        move = rigid(system, q, body, *rng.standard_normal((2, 3)))
        slope = (energy(system, q + 1e-7 * move) - energy(system, q - 1e-7 * move)) / 2e-7
        assert r @ move == pytest.approx(slope, abs=2e-4 * size)
    for move in (np.eye(6)).reshape(6, 2, 3):
        both = sum(rigid(system, q, body, *move) for body in ("rod", "other"))
        assert r @ both == pytest.approx(0.0, abs=1e-9 * size)


@pytest.mark.parametrize(("name", "end"), [("can", 0.125), ("capsule", 0.1)])
@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_forces_where_it_slides_off_the_end(name, end, side):
    """The gradient too, with less than a radius side by side: there the share of the two springs changes."""
    shape, up = SHAPES[name][0], 0.1 if name == "can" else 0.08
    system, rng = stage(shape), np.random.default_rng(11)
    line, _ = Rotation.align_vectors([shape.direction], [[1.0, 0.0, 0.0]])
    for shared in RADIUS * np.array([0.2, 0.5, 0.8]):
        along = side * (end + 0.5 * LENGTH - shared) * shape.direction
        across = line.apply([0.0, 0.0, up + RADIUS - 2e-3])
        tilt = Rotation.from_rotvec(3e-3 * rng.standard_normal(3))
        check_gradient(system, np.asarray(shape.at) + along + across, tilt * line, rng)


def lying(name):
    """Axis of the shape along x, height of the rod's axis above it, and of what it leans over."""
    up = {"cylinder": 0.1, "can": 0.1, "capsule": 0.08, "sheave": 0.16}[name]
    shape = SHAPES[name][0]
    return type(shape)(**{**vars(shape), "at": (0, 0, 0), "axis": (1, 0, 0)}), up


@pytest.mark.parametrize("name", ["cylinder", "can", "capsule", "sheave"])
def test_tilts_without_jumps(name):
    """Flat it is borne by two springs, tilted by one; in between smoothly."""
    shape, up = lying(name)
    system, depth = stage(shape), 3e-4
    steps = np.linspace(-0.02, 0.02, 401)
    found = []
    for turn in (Rotation.from_rotvec([0, a, 0]) for a in steps):
        q, v = system.initial_state()
        put(system, q, "rod", (0.0, 0.0, up + RADIUS - depth), turn)
        put(system, q, "other", np.zeros(3), Rotation.identity())
        r, _ = force_and_matrix(system, "bumping", q, v)
        found.append(
            [
                r @ rigid(system, q, "rod", (0, 0, -1.0), (0, 0, 0)),
                r @ rigid(system, q, "rod", (0, 0, 0), (0, 1.0, 0)),
            ]
        )
    force, torque = np.array(found).T
    assert force[200] == pytest.approx((4.0 if name == "sheave" else 2.0) * K * depth, rel=1e-9)
    # a step tilts the ends by 15e-6 m
    assert np.abs(np.diff(force)).max() < 4.5 * K * 1.6e-5
    assert np.abs(np.diff(torque)).max() < 4.5 * K * 1.6e-5 * LENGTH
    assert torque[200] == pytest.approx(0.0, abs=1e-9 * K)


@pytest.mark.parametrize("angle", [0.1, 0.3, math.pi / 2])
@pytest.mark.parametrize("name", ["cylinder", "capsule"])
def test_across_it_is_one_spring(name, angle):
    shape, up = lying(name)
    system, depth = stage(shape), 1e-4
    q, v = system.initial_state()
    put(system, q, "rod", (0.0, 0.0, up + RADIUS - depth), Rotation.from_rotvec([0, 0, angle]))
    put(system, q, "other", np.zeros(3), Rotation.identity())
    r, _ = force_and_matrix(system, "bumping", q, v)
    slot = system.slots["rod"][0, 0]
    assert r[slot : slot + 3] == pytest.approx([0.0, 0.0, -K * depth], abs=1e-9 * K)


def test_lying_in_a_ring_two_places_become_one():
    """On the chord of a ring it has two springs, as its tangent one, beyond less; without a jump."""
    R, tube, depth = 0.15, 0.02, 2e-4
    system = stage(ancf.Torus(R, tube))
    found = []
    for y in R + np.linspace(-0.02, 0.004, 481):
        q, v = system.initial_state()
        put(system, q, "rod", (0.0, y, tube + RADIUS - depth), Rotation.identity())
        put(system, q, "other", np.zeros(3), Rotation.identity())
        r, _ = force_and_matrix(system, "bumping", q, v)
        found.append(-r[system.slots["rod"][0, 0] + 2])
    force = np.array(found) / (K * depth)
    assert force[:200] == pytest.approx(2.0, rel=1e-9)
    assert force[400] == pytest.approx(1.0, rel=1e-9)
    assert (np.diff(force) < 1e-9).all()
    assert np.abs(np.diff(force)).max() < 0.03
