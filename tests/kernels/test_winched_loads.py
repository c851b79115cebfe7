"""Forces along cables of changing length: on the material that passes, found by differences of its motion."""

from itertools import pairwise

import numpy as np
import pytest

import ancf
from ancf.batches import Batches
from ancf.contact.profiles import distances
from ancf.elements.shapes import gauss
from ancf.system.core import keep_memory, residual
from ancf.system.system import System
from compiled_kernels import total_strain_energy

G = np.array([0.0, 0.0, -9.81])
MADE = 1.2
NODES = [0.0, 0.4, 0.9, MADE]


def winched(at_start, surround, noise=0.1):
    """A cable of 1.8 m on a mesh of 1.2 m in a shape and a motion at random, and its System."""
    section = ancf.Section(EA=40.0, EI=2.0, rhoA=0.7, diameter=0.03, drag=(1.3, 0.4), added_mass=(0.9, 0.2))
    model = ancf.Model(gravity=G)
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1.2, 0.1, 0), length=MADE, section=section, nodes=NODES
    )
    model.winch(beam.start if at_start else beam.end, length=1.8)
    surround(model, beam)
    system = System(model)
    rng = np.random.default_rng(5)
    q, v = system.initial_state()
    a, L = np.zeros_like(q), system.lengths["beam"][0]
    used = np.setdiff1d(np.flatnonzero(system.numbering.used()), [L, L + 1, L + 2])
    q[used] = 1.5 * q[used] + noise * rng.uniform(-1, 1, len(used))
    v[used], a[used] = rng.uniform(-1, 1, (2, len(used)))
    v[L], a[L] = -0.8, 0.5
    return system, beam, q, v, a


def of_loads(system, q, v, a):
    """Residual of the loads that depend on the state."""
    r = np.zeros_like(q)
    residual(system.core.external, system.core.ws, q, v, a, np.zeros_like(q), r)
    return r


def material(system, beam, q, v, a, points):
    """Of each point of quadrature of the material: probe, length, place, tangent, velocity, acceleration."""
    L, far = system.lengths["beam"]
    xi, weight = gauss(points)
    found = []

    def at(label, dt):
        state = q + dt * v + 0.5 * dt * dt * a
        probe = system.probe(beam.at(label * MADE / state[L] + far))
        return probe.field(state)

    h = 1e-4
    for left, right in pairwise(NODES):
        for s, w in zip(xi, weight, strict=True):
            x = left + s * (right - left)
            label = (x - far) * q[L] / MADE
            before, here, after = (at(label, dt) for dt in (-h, 0.0, h))
            probe = system.probe(beam.at(x))
            tangent = probe.slope(q)
            size = w * (right - left) * q[L] / MADE
            speed, rate = (after - before) / (2 * h), (after - 2 * here + before) / (h * h)
            found.append((probe, size, here, tangent / np.linalg.norm(tangent), speed, rate))
    return found


def gathered(system, q, found, forces):
    """What forces per length of the material leave in the residual, and the rate at which they work."""
    L, far = system.lengths["beam"]
    wanted, power = np.zeros_like(q), 0.0
    for (probe, size, _, _, speed, _), f in zip(found, forces, strict=True):
        for slot, factor in zip(probe.slots, probe.S[0], strict=True):
            wanted[slot : slot + 3] -= size * factor * f
        drawn = (probe.x - far) * sum(
            factor * q[slot : slot + 3] for slot, factor in zip(probe.slots, probe.S[1], strict=True)
        )
        wanted[L] += size * f @ drawn / q[L]
        power += size * f @ speed
    return wanted, power


@pytest.mark.parametrize("at_start", [True, False])
def test_fluid(at_start):
    U, rho, d, area = np.array([0.4, -0.3, 0.2]), 900.0, 0.03, np.pi * 0.03**2 / 4
    system, beam, q, v, a = winched(at_start, lambda m, b: m.add_fluid("water", rho, velocity=U))
    found, forces = material(system, beam, q, v, a, 5), []
    for _, _, _, t, speed, rate in found:
        w = U - speed
        wt, wn = (w @ t) * t, w - (w @ t) * t
        bt, bn = (rate @ t) * t, rate - (rate @ t) * t
        drag = 0.5 * rho * d * (1.3 * np.linalg.norm(wn) * wn + 0.4 * np.pi * np.linalg.norm(wt) * wt)
        forces.append(drag - rho * area * (G + 0.9 * bn + 0.2 * bt))
    wanted, power = gathered(system, q, found, forces)
    r = of_loads(system, q, v, a)
    assert r == pytest.approx(wanted, abs=2e-6 * np.abs(wanted).max())
    assert -r @ v == pytest.approx(power, rel=1e-6)


@pytest.mark.parametrize("at_start", [True, False])
def test_law_of_the_state(at_start):
    def surround(model, beam):
        model.add_distributed_load(beam, ["-0.7*vx*y", "0.3*vy - x", "vz*vx + sin(z)"])

    system, beam, q, v, a = winched(at_start, surround)
    found = material(system, beam, q, v, a, 4)
    forces = [
        np.array([-0.7 * u[0] * r[1], 0.3 * u[1] - r[0], u[2] * u[0] + np.sin(r[2])])
        for _, _, r, _, u, _ in found
    ]
    wanted, power = gathered(system, q, found, forces)
    r = of_loads(system, q, v, a)
    assert r == pytest.approx(wanted, abs=1e-7 * np.abs(wanted).max())
    assert -r @ v == pytest.approx(power, rel=1e-7)


@pytest.mark.parametrize("at_start", [True, False])
def test_ground(at_start):
    """Spring and damper against the material, no friction before the first step."""
    k, c, d = 2e3, 300.0, 0.03

    def surround(model, beam):
        model.add_ground("floor", height=0.5, stiffness=k, damping=c, friction=0.4)

    system, beam, q, v, a = winched(at_start, surround)
    floor = system.parts["ground"]
    found, forces = material(system, beam, q, v, a, 10), []
    for _, _, r, _, u, _ in found:
        depth = 0.5 - r[2]
        on = np.clip(1.0 + depth / (0.01 * d), 0.0, 1.0)
        forces.append(np.array([0, 0, d * max(0.0, k * depth - c * on * u[2])]))
    wanted, power = gathered(system, q, found, forces)
    r = of_loads(system, q, v, a)
    assert np.count_nonzero(floor.limit) == 0
    assert r == pytest.approx(wanted, abs=1e-6 * np.abs(wanted).max())
    assert -r @ v == pytest.approx(power, rel=1e-6)


@pytest.mark.parametrize("at_start", [True, False])
@pytest.mark.parametrize(("rate", "until"), [(-0.5, 1.0), (0.5, 0.7)])
def test_anchors_go_with_the_material(at_start, rate, until):
    """All sticks: after a motion each anchor is where its material was at first, but next to what is new."""

    def surround(model, beam):
        model.add_ground("floor", height=1.0, stiffness=1e3, damping=0.0, friction=1e9)

    system, beam, q, v, _ = winched(at_start, surround, 0.01)
    L, far = system.lengths["beam"]
    v[:], v[L] = 0.0, rate
    v[system.slots["beam"][:, 0] + 1] = 0.3 * np.array(NODES) ** 2
    v[system.slots["beam"][:, 1] + 1] = 0.6 * np.array(NODES)
    q0, xi = q.copy(), gauss(10)[0]
    for k in range(41):
        q = q0 + 0.01 * k * v
        keep_memory(system.core.remembering, q, v)
    off, moved = [], []
    for e, (left, right) in enumerate(pairwise(NODES)):
        for p, x in enumerate(left + xi * (right - left)):
            label = (x - far) * q[L] / q0[L]  # where it was on the mesh
            if abs(label) <= until * MADE:
                origin = system.probe(beam.at(label + far)).field(q0)
                off.append(np.linalg.norm(system.parts["ground"].anchor[e, p] - origin))
                moved.append(np.linalg.norm(system.probe(beam.at(x)).field(q) - origin))
    assert len(off) > 15
    assert max(off) < 0.01 * max(moved)


def pushed(system, name, q, v):
    """Residual of one batch."""
    r = np.zeros_like(q)
    residual(Batches((system.parts[name],)), system.core.ws, q, v, np.zeros_like(q), np.zeros_like(q), r)
    return r


@pytest.mark.parametrize("at_start", [True, False])
@pytest.mark.parametrize(
    "shape",
    [ancf.Plane((0, 0, -0.014), (0.005, 0.0, 1.0)), ancf.Cylinder(0.3, (0.7, 0, -0.311), (0, 1, 0))],
    ids=["plane", "cylinder"],
)
class TestSurface:
    K, C = 2e3, 40.0

    def touching(self, at_start, shape, damping):
        def surround(model, beam):
            model.add_contact(beam, model.add_surface("floor", shape), stiffness=self.K, damping=damping)

        return winched(at_start, surround, 0.02)

    def test_its_elastic_force_is_the_derivative_of_the_energy(self, at_start, shape):
        """By the length as well."""
        system, _, q, v, _ = self.touching(at_start, shape, 0.0)
        part, h = Batches((system.parts["pressing"],)), 1e-6
        energies = [total_strain_energy(part, system.core.ws, q + s * h * v) for s in (-1, 1)]
        r = pushed(system, "pressing", q, v)
        assert np.abs(r).max() > 1.0
        assert r @ v == pytest.approx((energies[1] - energies[0]) / (2 * h), rel=1e-6)

    def test_force_and_damping_on_the_material(self, at_start, shape):
        system, beam, q, v, a = self.touching(at_start, shape, self.C)
        found, forces, lossy = material(system, beam, q, v, a, 5), [], []
        for _, _, r, _, u, _ in found:
            h = 1e-6
            d, n = distances(shape, r[None])[0], np.zeros(3)
            for c in range(3):
                n[c] = np.subtract(*(distances(shape, (r + s * h * np.eye(3)[c])[None])[0] for s in (1, -1)))
            n /= 2 * h
            g = 0.015 - d
            on = np.clip(g / (0.02 * 0.015), 0.0, 1.0)
            N = max(0.0, self.K * g - self.C * on * (u @ n)) if g > 0.0 else 0.0
            forces.append(N * n)
            lossy.append((N - self.K * max(g, 0.0)) * n)
        wanted, _ = gathered(system, q, found, forces)
        _, lost = gathered(system, q, found, lossy)
        L = system.lengths["beam"][0]
        r = pushed(system, "pressing", q, v)
        rest = np.arange(len(q)) != L
        assert r[rest] == pytest.approx(wanted[rest], abs=1e-5 * np.abs(wanted).max())
        assert -(r - pushed(system, "pressing", q, 0.0 * v)) @ v == pytest.approx(lost, rel=1e-5)


@pytest.mark.parametrize("at_start", [True, False])
@pytest.mark.parametrize(("rate", "until"), [(-0.5, 1.0), (0.5, 0.7)])
def test_anchors_on_a_surface_go_with_the_material(at_start, rate, until):
    """All sticks on a body that turns: in its axes each anchor is where its material was at first."""

    def surround(model, beam):
        board = model.add_rigid_body("board", at=(0.4, 0, -0.2), mass=1.0, inertia=(1, 1, 1))
        table = model.add_surface("table", ancf.Plane((0, 0, 0.19), (0, 0, 1)), on=board)
        model.add_contact(beam, table, stiffness=1e3, friction=1e9)

    system, beam, q, v, _ = winched(at_start, surround, 0.003)
    L, far = system.lengths["beam"]
    v[:], v[L] = 0.0, rate
    v[system.slots["beam"][:, 0] + 1] = 0.3 * np.array(NODES) ** 2
    v[system.slots["beam"][:, 1] + 1] = 0.6 * np.array(NODES)
    q0, xi = q.copy(), gauss(5)[0]
    place, *directors = system.slots["board"][0]
    q0[place : place + 3] = 0.4, 0.0, -0.2
    for k in range(41):
        q = q0 + 0.01 * k * v
        turn = 0.02 * k  # about x
        axes = np.array([[1, 0, 0], [0, np.cos(turn), np.sin(turn)], [0, -np.sin(turn), np.cos(turn)]])
        for slot, axis in zip(directors, axes, strict=True):
            q[slot : slot + 3] = axis
        for slots in system.slots["beam"]:  # the beam turns with it
            for slot, origin in zip(slots, (q[place : place + 3], np.zeros(3)), strict=True):
                q[slot : slot + 3] = origin + (q[slot : slot + 3] - origin) @ axes
        keep_memory(system.core.remembering, q, v)
    off, moved = [], []
    for e, (left, right) in enumerate(pairwise(NODES)):
        for p, x in enumerate(left + xi * (right - left)):
            label = (x - far) * q[L] / q0[L]
            if abs(label) <= until * MADE:
                origin = system.probe(beam.at(label + far)).field(q0) - q0[place : place + 3]
                off.append(np.linalg.norm(system.parts["rubbing"].anchor[e, p] - origin))
                here = (system.probe(beam.at(x)).field(q) - q[place : place + 3]) @ axes.T
                moved.append(np.linalg.norm(here - origin))
    assert len(off) > 7
    assert max(off) < 0.02 * max(moved)
