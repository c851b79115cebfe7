"""Kernels of contact with surfaces: distances, forces in balance, tangents, what is far."""

import math

import numpy as np
import pytest

import ancf
from ancf.batches import Batches
from ancf.contact.press import BONDED, COUNT, WATCHED, press_free, press_lost
from ancf.contact.profiles import distances
from ancf.linalg.sparse import to_sparse
from ancf.model.surfaces.shapes import SHAPES
from ancf.system.core import assemble, keep_memory, residual
from ancf.system.system import System

AXIS = np.array([0.3, -0.5, 0.8]) / np.linalg.norm([0.3, -0.5, 0.8])
AT = np.array([0.1, 0.2, -0.3])


def arc(rho, z, radius, first, last):
    a = np.linspace(first, last, 4000)
    return np.stack([rho + radius * np.cos(a), z + radius * np.sin(a)], axis=1)


def segment(a, b):
    s = np.linspace(0.0, 1.0, 4000)[:, None]
    return (1 - s) * np.array(a) + s * np.array(b)


def groove(R, r, depth, angle):
    """Half a groove of a sheave, z > 0, and its rim far out."""
    b = 0.5 * angle
    foot = np.array([R + r - r * math.sin(b), r * math.cos(b)])
    top = foot + (R + depth - foot[0]) / math.cos(b) * np.array([math.cos(b), math.sin(b)])
    bottom = arc(R + r, 0.0, r, 0.5 * math.pi + b, math.pi)
    return np.concatenate([bottom, segment(foot, top), segment(top, (R + depth, 1.0))]), foot, top


#: Shape, its outline (rho, |z|) as many points, and whether a place (rho, |z|) is inside.
OUTLINES = {
    "plane": (ancf.Plane(AT, AXIS), segment((0.0, 0.0), (2.0, 0.0)), None),
    "cylinder": (ancf.Cylinder(0.2, AT, AXIS), segment((0.2, 0.0), (0.2, 2.0)), lambda x, z: x < 0.2),
    "can": (
        ancf.Cylinder(0.2, AT, AXIS, length=0.3),
        np.concatenate([segment((0.2, 0.0), (0.2, 0.15)), segment((0.2, 0.15), (0.0, 0.15))]),
        lambda x, z: (x < 0.2) & (z < 0.15),
    ),
    "sphere": (
        ancf.Sphere(0.25, AT),
        arc(0.0, 0.0, 0.25, 0.0, 0.5 * math.pi),
        lambda x, z: x**2 + z**2 < 0.0625,
    ),
    "capsule": (
        ancf.Capsule(0.1, 0.3, AT, AXIS),
        np.concatenate([segment((0.1, 0.0), (0.1, 0.15)), arc(0.0, 0.15, 0.1, 0.0, 0.5 * math.pi)]),
        lambda x, z: np.hypot(x, np.maximum(z - 0.15, 0.0)) < 0.1,
    ),
    "torus": (
        ancf.Torus(0.3, 0.05, AT, AXIS),
        arc(0.3, 0.0, 0.05, 0.0, math.pi),
        lambda x, z: np.hypot(x - 0.3, z) < 0.05,
    ),
    "sheave": (
        ancf.Sheave(0.2, 0.03, 0.08, 0.9, AT, AXIS),
        groove(0.2, 0.03, 0.08, 0.9)[0],
        None,
    ),
}


#: Of what is drawn: least and largest rho, largest z, height of its longest chord.
#: A cylinder without an end is drawn as long as it is wide.
DRAWN = {
    "cylinder": (0.2, 0.2, 0.4, 1e-9),
    "can": (0.0, 0.2, 0.15, 1e-9),
    "sphere": (0.0, 0.25, 0.25, 2.5e-3),
    "capsule": (0.0, 0.1, 0.25, 1e-3),
    "torus": (0.25, 0.35, 0.05, 2e-3),
    "sheave": (0.2, 0.28, groove(0.2, 0.03, 0.08, 0.9)[2][1] + 0.3 * 0.03, 2e-4),
}


def places(count=300, seed=2):
    return AT + np.random.default_rng(seed).uniform(-0.45, 0.45, (count, 3))


class TestDistances:
    def test_all_shapes_are_here(self):
        meshes = {ancf.Mesh}  # kernels/test_meshes.py
        assert {type(shape) for shape, _, _ in OUTLINES.values()} | meshes == set(SHAPES.values())

    @pytest.mark.parametrize("name", DRAWN)
    def test_what_is_drawn_is_the_shape(self, name):
        shape, outline, _ = OUTLINES[name]
        drawn = np.array(shape.outline)
        low, wide, high, chord = DRAWN[name]
        assert drawn[:, 0].min() == pytest.approx(low, abs=1e-12)
        assert drawn[:, 0].max() == pytest.approx(wide)
        assert [drawn[:, 1].min(), drawn[:, 1].max()] == pytest.approx([-high, high])
        for points, most in ((drawn, 0.0), (0.5 * (drawn[1:] + drawn[:-1]), chord)):
            near = np.hypot(outline[:, 0] - points[:, :1], outline[:, 1] - np.abs(points[:, 1:]))
            assert near.min(axis=1).max() < most + 4e-4  # between two points of the outline

    @pytest.mark.parametrize("name", OUTLINES)
    def test_against_the_nearest_of_many_points(self, name):
        shape, outline, inside = OUTLINES[name]
        r = places()
        found = distances(shape, r)
        z = (r - AT) @ (AXIS if name != "sphere" else np.array([0, 0, 1.0]))
        axis = AXIS if name != "sphere" else np.array([0, 0, 1.0])
        rho = np.linalg.norm(r - AT - z[:, None] * axis, axis=1)
        height = z if name == "plane" else np.abs(z)
        near = np.hypot(outline[:, 0] - rho[:, None], outline[:, 1] - height[:, None]).min(axis=1)
        if name == "sheave":  # nobody is deep inside of it: the sign is that of the groove
            outer = rho > 0.2
            _, foot, top = groove(0.2, 0.03, 0.08, 0.9)
            width = np.where(
                rho < foot[0],
                np.sqrt(np.maximum(0.03**2 - (rho - 0.23) ** 2, 0.0)),
                foot[1] + (rho - foot[0]) / (top[0] - foot[0]) * (top[1] - foot[1]),
            )
            free = (rho > 0.28) | (outer & (height < width))
            clear = free | (outer & (height - width < 0.01))  # where the groove is nearest
            assert clear.sum() > 100
            assert found[clear] == pytest.approx(np.where(free, near, -near)[clear], abs=2e-4)
            return
        sign = np.sign(z) if name == "plane" else np.where(inside(rho, height), -1.0, 1.0)
        assert (sign < 0).any()
        assert found == pytest.approx(sign * near, abs=3e-4)


def beside(shape, friction=0.0, on=False, depth=0.003, damping=50.0):
    """A beam of three elements that is some way inside a shape at one place."""
    model = ancf.Model()
    section = ancf.Section(EA=1e3, EI=1.0, rhoA=1.0, diameter=0.02)
    rope = model.add_beam("rope", start=(-0.15, 0, 0), end=(0.15, 0, 0), elements=3, section=section)
    body = model.add_rigid_body("body", at=(0.02, -0.03, -0.1), mass=1.0, inertia=(1, 1, 1)) if on else None
    surface = model.add_surface(
        "thing", shape(0.01 - depth, (0.02, -0.03, -0.1) if on else (0, 0, 0)), on=body
    )
    model.add_contact(rope, surface, stiffness=1e4, damping=damping, friction=friction, stick=3e3)
    return model


def below(kind, **numbers):
    """Maker of a shape whose highest place is the distance ``gap`` below the origin, in axes about ``at``."""

    def make(gap, at):
        deep = {"plane": 0.0, "sphere": 0.3, "cylinder": 0.2, "capsule": 0.1, "torus": 0.35, "sheave": 0.2}[
            kind
        ]
        place = np.array([0.001, 0.002, -gap - deep]) - at
        axis = (
            {}
            if kind == "sphere"
            else {"normal": (0, 0, 1)}
            if kind == "plane"
            else {"axis": (0.1, 1.0, 0.0)}
        )
        return SHAPES[kind](at=place, **axis, **numbers)

    return make


def below_mesh(gap, at):
    """An octahedron with an edge below the rope."""
    points = 0.3 * np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1.0]])
    rows = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
    turn = np.array([[1, 0, 0], [0, 1, 1], [0, -1, 1]]) / [[1], [np.sqrt(2)], [np.sqrt(2)]]
    points = points @ turn.T
    return ancf.Mesh(points=points, triangles=rows, at=np.array([0.001, 0.0, -gap - points[:, 2].max()]) - at)


KINDS = {
    "mesh": below_mesh,
    "plane": below("plane"),
    "sphere": below("sphere", radius=0.3),
    "cylinder": below("cylinder", radius=0.2),
    "capsule": below("capsule", radius=0.1, length=0.2),
    "torus": below("torus", radius=0.3, tube=0.05),
    "sheave": below("sheave", radius=0.2, groove=0.0115, depth=0.05),
}


def force_and_matrix(system, part, q, v, weights=(0.0, 0.0, 1.0)):
    batch = Batches((system.parts[part],))
    r, zero = np.zeros(system.size), np.zeros(system.size)
    residual(batch, system.core.ws, q, v, zero, zero, r)
    A = np.zeros(system.places.size)
    assemble(batch, system.core.ws, q, v, A, *weights)
    return r, to_sparse(A, system.places).toarray()


def shaken(system, size, seed=4):
    q, _ = system.initial_state()
    rng = np.random.default_rng(seed)
    v = np.zeros(system.size)
    rope = system.slots["rope"][:, :2].ravel()
    for c in range(3):
        q[rope + c] += size * rng.standard_normal(len(rope))
        v[rope + c] += 0.02 * rng.standard_normal(len(rope))
    return q, v


class TestForces:
    @pytest.mark.parametrize("kind", KINDS)
    def test_matrix_is_the_derivative(self, kind):
        """Of the normal force by places, the normal turns with them, and by velocities."""
        system = System(beside(KINDS[kind], damping=0.0))
        q, v = shaken(system, 1e-4)
        force, K = force_and_matrix(system, "pressing", q, v)
        assert np.abs(force).max() > 1e-2
        for move in np.eye(system.size)[system.slots["rope"][:, :2].ravel()[:, None] + np.arange(3)].reshape(
            -1, system.size
        ):
            ahead, _ = force_and_matrix(system, "pressing", q + 1e-7 * move, v)
            back, _ = force_and_matrix(system, "pressing", q - 1e-7 * move, v)
            change = (ahead - back)[: system.n] / 2e-7
            assert K @ move[: system.n] == pytest.approx(change, abs=2e-4 * np.abs(K).max())

    def test_friction_that_sticks_and_slips(self):
        """Its matrix is the derivative on a plane, where the normal stays."""
        system = System(beside(KINDS["plane"], friction=0.5, damping=20.0))
        q, v = shaken(system, 1e-4)
        keep_memory(system.core.remembering, q, 0.0 * v)
        keep_memory(system.core.remembering, q, 0.0 * v)
        rng = np.random.default_rng(1)
        for size in (1e-6, 3e-2):  # sticks, slips
            there = q + size * np.isin(np.arange(system.size), system.slots["rope"][:, 0])  # along x
            force, K = force_and_matrix(system, "rubbing", there, v)
            _, C = force_and_matrix(system, "rubbing", there, v, (0.0, 1.0, 0.0))
            assert np.abs(force).max() > 0.0
            move = np.zeros(system.size)
            move[: system.n] = rng.standard_normal(system.n)
            for matrix, dq, dv in ((K, 1e-8 * move, 0.0), (C, 0.0, 1e-8 * move)):
                ahead, _ = force_and_matrix(system, "rubbing", there + dq, v + dv)
                back, _ = force_and_matrix(system, "rubbing", there - dq, v - dv)
                change = (ahead - back)[: system.n] / 2e-8
                assert matrix @ move[: system.n] == pytest.approx(change, abs=1e-4 * np.abs(change).max())

    @pytest.mark.parametrize("kind", ["cylinder", "torus", "sheave"])
    def test_in_balance_with_what_carries_the_surface(self, kind):
        """No force and no moment is left over; and the forces are those of the surface on the ground."""
        found = []
        for on in (False, True):
            system = System(beside(KINDS[kind], friction=0.4, on=on))
            q, v = shaken(system, 1e-4)
            keep_memory(system.core.remembering, q, v)
            q = q + 1e-5 * np.isin(np.arange(system.size), system.slots["rope"][:, 0])
            r = sum(force_and_matrix(system, part, q, v)[0] for part in ("pressing", "rubbing"))
            rope = system.slots["rope"][:, :2].ravel()
            found.append(np.array([r[rope + c] for c in range(3)]))
            if on:
                slots = np.concatenate([rope, system.slots["body"].ravel()])
                vectors = np.array([[x[s : s + 3] for s in slots] for x in (q, r)])
                weights = np.isin(
                    slots, np.concatenate([system.slots["rope"][:, 0], system.slots["body"][:, 0]])
                )
                assert np.abs(found[1]).max() > 0.1
                assert vectors[1][weights].sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-9)
                assert np.cross(*vectors).sum(axis=0) == pytest.approx(np.zeros(3), abs=1e-9)
        assert found[0] == pytest.approx(found[1], abs=1e-9)

    def test_energy_is_that_of_the_force(self):
        system = System(beside(KINDS["cylinder"], damping=0.0))
        q, v = shaken(system, 1e-4)
        move = np.zeros(system.size)
        move[: system.n] = np.random.default_rng(3).standard_normal(system.n)

        def energy(q):
            return ancf.State(system, 0.0, q, v).energy.strain

        force = force_and_matrix(system, "pressing", q, v)[0] + force_and_matrix(system, "cable", q, 0 * v)[0]
        slope = (energy(q + 1e-7 * move) - energy(q - 1e-7 * move)) / 2e-7
        assert force @ move == pytest.approx(slope, rel=1e-5)


class TestFar:
    def test_forces_do_not_depend_on_what_was_far(self):
        """Wherever a beam was when it was looked at last, it is found where it touches."""
        system = System(beside(KINDS["sphere"]))
        q, v = shaken(system, 1e-4)
        wanted, _ = force_and_matrix(system, "pressing", q, v)
        rng = np.random.default_rng(7)
        for height in (0.0, 0.02, 0.3, 5.0):
            away = q.copy()
            away[system.slots["rope"][:, 0] + 2] += height
            away[system.slots["rope"][:, 0]] += 0.1 * rng.standard_normal()
            system.parts["pressing"].far[:] = -np.inf
            keep_memory(system.core.remembering, away, v)
            assert force_and_matrix(system, "pressing", q, v)[0] == pytest.approx(wanted, abs=1e-12)
        assert (system.parts["pressing"].far[:, 3] > 1.0).all()

    def test_all_are_looked_at_where_nobody_watches(self):
        """A method that never asks what passed through must not leave out what was far."""
        system = System(beside(KINDS["sphere"]))
        q, v = shaken(system, 1e-4)
        away = q.copy()
        away[system.slots["rope"][:, 0] + 2] += 5.0
        batch = system.parts["pressing"]
        keep_memory(system.core.remembering, away, v)  # it has come far in one step
        batch.near[WATCHED] = 1
        keep_memory(system.core.remembering, away, v)
        assert batch.near[COUNT] == 0
        for _ in range(2):
            keep_memory(system.core.remembering, away, v)
            assert batch.near[COUNT] == len(batch.base)


class TestHeld:
    """Points that just touch are held while the loads of an equilibrium come on."""

    @staticmethod
    def above_a_plane(low, high, stiffness=1e6):
        """A straight rope of radius 1 cm whose gap grows evenly along it, m."""
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=1e-2, rhoA=0.3, diameter=0.02)
        ends = {"start": (0, 0, 0.01 + low), "end": (1, 0, 0.01 + high)}
        rope = model.add_beam("rope", **ends, elements=8, section=section)
        model.add_contact(rope, model.add_surface("floor", ancf.Plane()), stiffness=stiffness)
        system = System(model)
        return system, system.parts["pressing"], system.initial_shape()

    def test_those_in_reach_are_pulled_until_they_are_let_go(self):
        system, batch, q = self.above_a_plane(0.0, 4.0 * BONDED * 0.01)
        press_lost(batch, q, True)
        count = batch.bond.size // 4
        assert batch.bond.ravel().tolist() == [1] * count + [0] * (3 * count)  # of eight elements, two
        force, _ = force_and_matrix(system, "pressing", q, 0.0 * q)
        down = force[system.slots["rope"][:, 0] + 2].sum()
        assert down == pytest.approx(1e6 * 0.25 * 0.5 * BONDED * 0.01, rel=1e-6)  # the mean gap of a quarter
        assert press_free(batch, q, False) == count
        assert not batch.bond.any()
        assert not force_and_matrix(system, "pressing", q, 0.0 * q)[0].any()

    def test_those_that_are_pressed_stay_until_all_are_let_go(self):
        _, batch, q = self.above_a_plane(-1e-5, -1e-5)
        press_lost(batch, q, True)
        assert press_free(batch, q, False) == 0
        assert batch.bond.all()
        assert press_free(batch, q, True) == 0
        assert not batch.bond.any()
        press_lost(batch, q, False)
        assert not batch.bond.any()
