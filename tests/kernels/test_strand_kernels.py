"""Kernels of cables that touch: crossings, balance with friction, what is near, rows of the solver."""

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ancf
from ancf.contact.near import LEFT, node_moved
from ancf.contact.rows import rows_in
from ancf.linalg.sparse import to_sparse
from ancf.system.contacts import touching
from ancf.system.core import assemble, keep_memory, residual, restrict
from ancf.system.system import System

D, K = 0.02, 1e7


def crossed(angle=0.5 * math.pi, gap=-2e-4, shift=0.0, elements=(4, 4), friction=0.0, swapped=False, **law):
    """Two straight cables without stress that cross at their own places; they are D + gap apart."""
    model = ancf.Model()
    section = ancf.Section(EA=1e5, EI=0.1, rhoA=0.3, diameter=D)
    way = 0.5 * np.array([math.cos(angle), math.sin(angle), 0.0])
    above = np.array([0.0, 0.0, D + gap])
    along = np.array([1.0, 0.0, 0.0])
    ends = above - (0.5 - shift) * along, above + (0.5 + shift) * along
    others = -(1.0 - 0.7 * shift) * way, (1.0 + 0.7 * shift) * way
    a = model.add_beam("a", start=ends[0], end=ends[1], elements=elements[0], section=section)
    b = model.add_beam("b", start=others[0], end=others[1], elements=elements[1], section=section)
    model.add_contact(*((b, a) if swapped else (a, b)), stiffness=K, friction=friction, name="touch", **law)
    return System(model)


def forces(system, q, v=None):
    """Forces on all unknowns of unstressed cables: those of contact alone."""
    v, r = np.zeros_like(q) if v is None else v, np.empty_like(q)
    residual(system.core.batches, system.core.ws, q, v, 0 * q, 0 * q, r)
    return -r


def sums(system, q, f):
    """Sum of the forces on each cable, and the moment of all: that of slopes as well."""
    total, moment = [], np.zeros(3)
    for slots in system.slots.values():
        vectors = np.stack([q[slots + c] for c in range(3)], axis=-1)
        given = np.stack([f[slots + c] for c in range(3)], axis=-1)
        total.append(given[:, 0].sum(axis=0))
        moment += np.cross(vectors, given).sum(axis=(0, 1))
    return np.array(total), moment


class TestCrossing:
    @pytest.mark.parametrize("angle", [0.5 * math.pi, 1.0, 0.3, 0.1, 2.8])
    def test_force_by_depth_and_angle(self, angle):
        """4/3 k sqrt(2 D) g^1.5 / sin(angle) for depths that are small against D."""
        for gap in (-2e-5, -2e-4):
            system = crossed(angle, gap)
            q, _ = system.initial_state()
            total, _ = sums(system, q, forces(system, q))
            wanted = 4 / 3 * K * math.sqrt(2 * D) * (-gap) ** 1.5 / math.sin(angle)
            assert total[0, 2] == pytest.approx(wanted, rel=-1.2 * gap / D + 2e-5)

    @pytest.mark.parametrize("angle", [0.5 * math.pi, 0.2])
    def test_wherever_the_mesh_lies(self, angle):
        """Also where the crossing is at nodes of one cable or both, and whichever cable is named first."""
        found = [
            sums(system, q, forces(system, q))[0][0, 2]
            for shift, elements, swapped in [
                (0.0, (4, 4), False),
                (0.0, (4, 4), True),
                (0.013, (4, 4), False),
                (0.1, (5, 3), False),
                (0.125, (4, 7), True),
                (0.2, (20, 11), False),
            ]
            for system in [crossed(angle, shift=shift, elements=elements, swapped=swapped)]
            for q in [system.initial_state()[0]]
        ]
        assert np.ptp(found) < 1e-5 * found[0]

    def test_side_by_side(self):
        """k g per length of what they share, whatever the meshes."""
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=0.1, rhoA=0.3, diameter=D)
        a = model.add_beam("a", start=(0, 0, D - 1e-4), end=(1, 0, D - 1e-4), elements=5, section=section)
        b = model.add_beam("b", start=(0.3, 0, 0), end=(1.4, 0, 0), elements=3, section=section)
        model.add_contact(a, b, stiffness=K)
        system = System(model)
        q, _ = system.initial_state()
        total, moment = sums(system, q, forces(system, q))
        ends = 4 / 3 * math.sqrt(2 * D) * (1e-4) ** 1.5  # the rounds beyond both ends
        assert total[0, 2] == pytest.approx(K * (0.7e-4 + 0.5 * ends), rel=2e-3)
        assert np.allclose(moment, 0.0, atol=1e-12 * total[0, 2])


class TestAlongArcs:
    """Curved cables one on the other, one of them past the end of the other."""

    @pytest.mark.parametrize("elements", [(6, 9), (8, 13), (10, 7), (21, 20)])
    @pytest.mark.parametrize("radius", [0.08, 0.11, 0.3])
    def test_no_force_jumps(self, elements, radius):
        """While one is turned on the other the forces change evenly: else some steps have no solution."""
        section, model = ancf.Section(EA=1e5, EI=0.1, rhoA=0.3, diameter=D), ancf.Model()
        paths = [(radius, (0.0, 1.5), 0.0), (radius + D - 2e-4, (-1.0, 1.2), 3e-4)]
        for name, count, (size, ends, aside) in zip("ab", elements, paths, strict=True):
            a = np.linspace(*ends, 80)
            arc = [size * np.cos(a) + aside * math.cos(0.7), 0 * a, size * np.sin(a) + aside * math.sin(0.7)]
            model.add_beam(name, path=np.transpose(arc), elements=count, section=section)
        model.add_contact(*model.beams.values(), stiffness=K, name="touch")
        system = System(model)
        q, _ = system.initial_state()
        moving, resting, found = system.slots["b"].ravel(), system.slots["a"][:, 0], []
        for angle in np.linspace(0.0, 0.3, 201):
            turned, c, s = q.copy(), math.cos(angle), math.sin(angle)
            turned[moving] = c * q[moving] - s * q[moving + 2]
            turned[moving + 2] = s * q[moving] + c * q[moving + 2]
            f = forces(system, turned)
            found.append([f[resting + i] for i in range(3)])
        assert np.abs(found).max() > 1.0
        assert np.abs(np.diff(found, 2, axis=0)).max() < 3e-3 * np.abs(found).max()


class TestBalance:
    @pytest.mark.parametrize("angle", [0.5 * math.pi, 0.9, 0.3, 0.02, 3.0])
    @pytest.mark.parametrize("seed", [0, 1])
    def test_no_force_and_no_moment_from_nowhere(self, angle, seed):
        """Friction that sticks and slips, in a state that is bent and moved away."""
        system = crossed(angle, -4e-4, shift=0.03, friction=0.4)
        q, v = system.initial_state()
        keep_memory(system.core.remembering, q, v)
        rng = np.random.default_rng(seed)
        moved = q + 2e-5 * rng.standard_normal(len(q)) * np.where(np.arange(len(q)) % 6 < 3, 1.0, 20.0)
        smooth = [b for b in system.core.batches if type(b).__name__ == "StrandBatch"]
        r = np.zeros_like(q)
        for batches in (system.core.rubbing, type(system.core.rubbing)(smooth)):
            residual(batches, system.core.ws, moved, rng.standard_normal(len(q)), 0 * q, 0 * q, r)
            total, moment = sums(system, moved, r)
            size = np.abs(r).max()
            assert size > 1e-3
            assert np.allclose(total.sum(axis=0), 0.0, atol=1e-12 * size)
            assert np.allclose(moment, 0.0, atol=1e-12 * size)

    @pytest.mark.parametrize("angle", [0.5 * math.pi, 0.3])
    def test_turned_as_a_whole_nothing_is_stretched(self, angle):
        system = crossed(angle, -4e-4, shift=0.03, friction=0.4)
        q, v = system.initial_state()
        keep_memory(system.core.remembering, q, v)
        slipped = q.copy()
        slipped[system.slots["a"][:, 0]] += 1e-6
        keep_memory(system.core.remembering, slipped, v)  # some stretch
        before = np.zeros_like(q)
        residual(system.core.rubbing, system.core.ws, slipped, v, 0 * q, 0 * q, before)
        R = Rotation.from_rotvec([0.7, -1.2, 2.0]).as_matrix()
        turned, after, wanted = slipped.copy(), np.zeros_like(q), before.copy()
        for slots in system.slots.values():
            for i in slots.ravel():
                turned[i : i + 3], wanted[i : i + 3] = R @ slipped[i : i + 3], R @ before[i : i + 3]
        residual(system.core.rubbing, system.core.ws, turned, v, 0 * q, 0 * q, after)
        assert np.abs(before).max() > 1e-3
        assert np.allclose(after, wanted, atol=1e-9 * np.abs(before).max())


def test_rows_are_the_stiffness():
    """All but how normals turn, which is N/(k D) of it; friction sticks."""
    system = crossed(1.0, -1e-4, shift=0.03, friction=0.5, elements=(2, 2))
    q, v = system.initial_state()
    keep_memory(system.core.remembering, q, v)
    n = system.n
    assemble(system.core.batches, system.core.ws, q, v, system.core.A, 0.0, 0.0, 1.0)
    restrict(system.core.supports, system.core.A)
    whole = (to_sparse(system.core.A, system.places) + touching(system.core, q, n).matrix()).toarray()
    step, found = 1e-8, np.empty((n, n))
    for i in range(n):
        e = np.zeros_like(q)
        e[i] = step
        found[:, i] = (forces(system, q - e) - forces(system, q + e))[:n] / (2 * step)
    assert np.abs(found - whole).max() < 0.02 * np.abs(found).max()


@pytest.mark.parametrize("angle", [1.0, 0.6, 0.3, 2.8])
@pytest.mark.parametrize(
    "pulled", [(0.0, 0.0), (1e-5, 2e-6), (-3e-4, 1e-4)], ids=["at rest", "drawn", "slips"]
)
def test_rows_are_the_damping(angle, pulled):
    """All of it, normal and along, and of what slips the part across the way that it is drawn."""
    system = crossed(angle, -1e-4, 0.03, (1, 2), friction=0.5, damping=2e3, stick=2e6)
    q, v = system.initial_state()
    keep_memory(system.core.remembering, q, v)
    q[system.slots["a"][:, 0]] += pulled[0]
    q[system.slots["a"][:, 0] + 1] += pulled[1]
    rows, _, damping = rows_in(system.parts["crossing"], q)
    step, found = 1e-6, np.empty((len(q), len(q)))
    for i, e in enumerate(step * np.eye(len(q))):
        found[:, i] = (forces(system, q, -e) - forces(system, q, e)) / (2 * step)
    assert len(damping) == len(rows) > 10
    assert np.abs(found - (rows.T * damping) @ rows).max() < 1e-8 * np.abs(found).max()


class TestNear:
    @staticmethod
    def coil(elements, seed, turns=6.3):
        """A loose coil with a few cables through it."""
        rng = np.random.default_rng(seed)
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=0.1, rhoA=0.3, diameter=D)
        a = np.linspace(0, 2 * np.pi * turns, 40 * elements)
        path = np.stack([0.1 * np.cos(a), 0.1 * np.sin(a), 0.035 * a / (2 * np.pi)], axis=1)
        coil = model.add_beam("coil", path=path, elements=elements, section=section)
        model.add_contact(coil, coil, stiffness=K)
        for k in range(2):
            x = 0.07 * rng.standard_normal(2)
            line = model.add_beam(
                f"l{k}", start=(*x, -0.1), end=(*x + 0.01, 0.4), elements=5, section=section
            )
            model.add_contact(coil, line, stiffness=K)
        return System(model)

    def test_a_node_that_moves_uses_up_what_is_left(self):
        """Its way by the sum of components, and the turn of its slope, each in its share."""
        system = self.coil(24, 0)
        q, v = system.initial_state()
        keep_memory(system.core.remembering, q, v)
        batch = system.parts["crossing"]
        for slot, size, share in ((0, 0.02, 0.02 * 50.0), (1, -0.3, 0.3 * 2.0)):
            moved = q.copy()
            moved[batch.base[3, slot] + 1] += size
            used = node_moved.py_func(batch, 3, 0, moved, 50.0, 2.0)
            assert used == pytest.approx(share, abs=1e-12)

    @staticmethod
    def apart(elements, seed, own):
        """Wavy cables away from each other, and a state to which everything may move."""
        rng = np.random.default_rng(seed)
        model, section = ancf.Model(), ancf.Section(EA=1e5, EI=0.1, rhoA=0.3, diameter=D)
        x, cables = np.linspace(0, 3, 200), []
        for k in range(3):
            phase, wide = rng.uniform(0, 6, 2), 0.2 * rng.uniform(size=2)
            path = np.stack(
                [x, 0.9 * k + wide[0] * np.sin(x + phase[0]), wide[1] * np.sin(2 * x + phase[1])], 1
            )
            cables.append(model.add_beam(f"c{k}", path=path, elements=elements, section=section))
        for a, b in ((0, 1), (1, 2)):
            model.add_contact(cables[a], cables[b], stiffness=K)
        if own:
            model.add_contact(cables[1], cables[1], stiffness=K)
        return System(model), [cables[0], cables[1], cables[2]]

    @pytest.mark.parametrize("own", [False, True])
    @pytest.mark.parametrize(("elements", "seed"), [(20, 0), (33, 1), (64, 2), (100, 5)])
    def test_what_is_free_is_half_of_the_least_distance_or_less(self, elements, seed, own):
        """Against the distance of many places; a good part of it where cables are nearly straight."""
        system, cables = self.apart(elements, seed, own)
        q, v = system.initial_state()
        keep_memory(system.core.remembering, q, v)
        batch, places = system.parts["crossing"], []
        for cable in cables:
            places.append(np.array([cable.initial_position(s) for s in np.linspace(0, cable.length, 400)]))
        pairs = [(0, 1), (1, 2)]
        least = min(np.linalg.norm(places[a][:, None] - places[b], axis=-1).min() for a, b in pairs) - D
        assert batch.first[-1] == 0
        assert 0.15 * least < batch.room[LEFT] < 0.5 * least

    def test_a_cable_bent_round_is_not_taken_for_straight(self):
        """The list of a hairpin has the pairs of its two legs."""
        a = np.linspace(0, np.pi, 50)
        legs = np.linspace(0, 1, 30)[:-1]
        bow = np.stack([1 + 0.5 * 1.02 * D * np.sin(a), -0.5 * 1.02 * D * np.cos(a)], 1)
        path = np.vstack(
            [np.stack([legs, 0 * legs - 0.51 * D], 1), bow, np.stack([legs, 0 * legs + 0.51 * D], 1)[::-1]]
        )
        model, section = ancf.Model(), ancf.Section(EA=1e5, EI=0.1, rhoA=0.3, diameter=D)
        pin = model.add_beam(
            "pin", path=np.column_stack([path, 0 * path[:, 0]]), elements=60, section=section
        )
        model.add_contact(pin, pin, stiffness=K)
        system = System(model)
        q, v = system.initial_state()
        keep_memory(system.core.remembering, q, v)
        batch = system.parts["crossing"]
        assert all(batch.first[e] < batch.first[e + 1] for e in range(5, 20))

    @pytest.mark.parametrize(("elements", "seed"), [(24, 0), (37, 3), (60, 2)])
    def test_list_has_all_that_may_touch(self, elements, seed):
        """Against all pairs of many places; lists that were made elsewhere find the same forces."""
        system = self.coil(elements, seed)
        q, v = system.initial_state()
        rng = np.random.default_rng(seed)
        batch = system.parts["crossing"]
        for size in (0.0, 0.004, 0.008):
            q = q + size * rng.standard_normal(len(q)) * np.where(np.arange(len(q)) % 6 < 3, 1.0, 0.0)
            renewed = forces(system, q)
            keep_memory(system.core.remembering, q, v)
            fresh = forces(system, q)
            assert np.allclose(renewed, fresh, atol=1e-9 * max(np.abs(fresh).max(), 1.0))
            xi = np.linspace(0, 1, 9)
            y = 1 - xi
            S = np.stack([y**2 * (1 + 2 * xi), xi * y**2, xi**2 * (1 + 2 * y), -y * xi**2])
            S = S[:, None] * np.stack([np.ones(len(batch.base)), batch.length] * 2)[:, :, None]
            ends = np.stack([q[batch.base + c] for c in range(3)], axis=-1)
            places = np.einsum("ken,ekc->enc", S, ends)
            listed = {
                (e, b)
                for e in range(len(batch.base))
                for b in batch.near[batch.first[e] : batch.first[e + 1]]
            }
            for e in range(len(batch.base)):
                away = np.linalg.norm(places[e][None, :, None] - places[:, None], axis=-1).min(axis=(1, 2))
                for b in np.flatnonzero(away < 2 * batch.radius[e]):
                    same = batch.cable[e] == batch.cable[b]
                    if batch.law[batch.cable[e], batch.cable[b]] >= 0 and not (same and abs(e - b) <= 6):
                        assert (e, b) in listed
