"""Kernels of springs, moments, joints and masses, by the rules and bars of test_elements."""

from itertools import product

import numpy as np
import pytest

import ancf
from ancf.connections.sliding import FREE, FROZEN
from ancf.elements.registry import ELEMENTS
from ancf.system.core import inertia
from ancf.system.probe import R_Y, R_Z
from ancf.system.system import System
from helpers import (
    BY_DIFFERENCES,
    BY_ROUND_OFF,
    SOLIDS,
    assert_close,
    cable,
    derivative,
    energy,
    forces,
    matrix,
    random_rate,
    rotation,
    shaken,
)
from mechanisms import LEVELS, at_level, bare, joints_of, mechanism, moving


def two_bodies(element):
    model, a = cable("straight", elements=2, name="a", element=element)
    _, b = cable("curved", elements=2, name="b", model=model, element=element)
    return model, a, b


def spring_system(element, kind):
    """Springs between points inside elements, on beams off the centreline, or to the ground."""
    model, a, b = two_bodies(element)
    here, there = ((0.1, -0.05), (-0.12, 0.08)) if element in SOLIDS else ((), ())
    other = (0.3, -0.5, 1.2) if kind == "to ground" else b.at(0.3 * b.length, *there)
    given = {"stiffness": 30.0, "damping": 4.0, "slack": kind in ("tight", "slack")}
    model.add_spring(a.at(0.7 * a.length, *here), other, length=9.0 if kind == "slack" else 0.2, **given)
    return System(model)


def moment_system(element):
    model, a, b = two_bodies(element)
    model.add_moment(a.at(0.4 * a.length), (0.5, -1.0, 2.0))
    model.add_moment(b.end, (0.3, 0.2, -0.7))
    return System(model)


@pytest.fixture(
    params=list(product(ELEMENTS, ["both ways", "tight", "to ground"])), ids=lambda p: "-".join(p)
)
def spring(request):
    return spring_system(*request.param)


def order_of(one, other):
    """Unknowns of a system in the order of another one, whose springs may have changed it."""
    order = np.full(one.size, -1)
    for body, slots in one.slots.items():
        for mine, there in zip(slots.ravel(), other.slots[body].ravel(), strict=True):
            order[there : there + 3] = np.arange(mine, mine + 3)
    assert sorted(order.tolist()) == list(range(one.size))
    return order


class TestSprings:
    def test_force_is_gradient_of_energy(self, spring):
        q = shaken(spring)
        assert_close(forces(spring, q), derivative(lambda x: energy(spring, x), q), BY_DIFFERENCES)

    def test_tangent_is_gradient_of_force(self, spring):
        q = shaken(spring)
        wanted = derivative(lambda x: forces(spring, x), q)
        assert_close(matrix(spring, q, stiffness=1.0), wanted, BY_DIFFERENCES)

    def test_damping_matrix_is_derivative_by_velocity(self, spring):
        q = shaken(spring)
        rest = forces(spring, q)
        small = 1e-3  # a tight slack spring must stay tight
        columns = [(forces(spring, q, v=small * e) - rest) / small for e in np.eye(len(q))]
        assert_close(matrix(spring, q, damping=1.0), np.stack(columns, axis=-1), 1e-9)

    @pytest.mark.parametrize("kind", ELEMENTS)
    def test_slack_carries_nothing(self, kind):
        model, _, _ = two_bodies(kind)
        slack, bare = spring_system(kind, "slack"), System(model)
        q, v, k = shaken(slack), random_rate(slack), order_of(slack, bare)
        assert np.array_equal(forces(slack, q, v=v)[k], forces(bare, q[k], v=v[k]))
        with_spring = matrix(slack, q, damping=1, stiffness=1)[np.ix_(k, k)]
        assert_close(with_spring, matrix(bare, q[k], damping=1, stiffness=1), 1e-15)
        assert energy(slack, q) == energy(bare, q[k])

    def test_damper_of_a_loose_slack_spring_does_nothing(self):
        """Its ends fly apart faster than it is too short: k (l - l0) + c dl/dt > 0, and yet no force."""
        loose, both = spring_system("cable", "slack"), spring_system("cable", "both ways")
        bare = System(two_bodies("cable")[0])
        q, k = shaken(loose), order_of(loose, bare)
        back = np.argsort(k)
        apart = -1e3 * (forces(bare, q[k])[back] - forces(both, q))  # against the pull of a tight one
        without = forces(bare, q[k], v=apart[k])[back]
        assert np.array_equal(forces(loose, q, v=apart), without)
        assert not np.allclose(forces(both, q, v=apart), without)

    def test_slack_never_pushes(self):
        """A tight spring whose ends approach fast: the damper would push more than the spring pulls."""
        tight, both = spring_system("cable", "tight"), spring_system("cable", "both ways")
        model, _, _ = two_bodies("cable")
        bare = System(model)
        q, k = shaken(tight), order_of(tight, bare)
        back = np.argsort(k)
        v = 100.0 * (forces(bare, q[k])[back] - forces(tight, q))  # the spring pulls its ends this way
        without = forces(bare, q[k], v=v[k])[back]
        assert np.array_equal(forces(tight, q, v=v), without)
        assert not np.allclose(forces(both, q, v=v), without)


class TestMoments:
    @pytest.mark.parametrize("kind", ELEMENTS)
    def test_tangent_is_symmetric_part_of_gradient(self, kind):
        system = moment_system(kind)
        q = shaken(system)
        gradient = derivative(lambda x: forces(system, x), q)
        assert_close(matrix(system, q, stiffness=1.0), 0.5 * (gradient + gradient.T), BY_DIFFERENCES)

    @pytest.mark.parametrize("kind", ELEMENTS)
    def test_does_work_on_rotations(self, kind):
        """Turning everything a little takes the work M . angle, in any state; a cable takes no torque."""
        system, bare = moment_system(kind), System(two_bodies(kind)[0])
        q = shaken(system)
        moment = forces(bare, q) - forces(system, q)
        w = np.array([0.3, -0.4, 0.2])
        slots = system.slots
        turned = np.zeros_like(q)
        for s in (s for body in slots.values() for s in body.ravel()):
            turned[s : s + 3] = np.cross(w, q[s : s + 3])
        work = 0.0
        for load in system.model.loads:
            p = system.probe(load.point).field(q, 1)
            t = p / np.linalg.norm(p)
            M = load.moment(0.0)
            work += (M if kind in SOLIDS else M - t * (t @ M)) @ w
        # the first moment is inside an element of the straight body, the other one at a node
        assert moment @ turned == pytest.approx(work, rel=1e-11)

    @pytest.mark.parametrize("kind", SOLIDS)
    def test_works_on_the_mean_rotation_of_a_sheared_section(self, kind):
        """delta theta is the rigid turn nearest to the changes of r_y and r_z, weighted by I_z and I_y."""
        system, bare = moment_system(kind), System(two_bodies(kind)[0])
        q, dq = shaken(system), random_rate(system)
        work = 0.0
        for load in system.model.loads:
            probe, section = system.probe(load.point), load.point.body.section
            vectors, changes = ([probe.field(x, row) for row in (R_Y, R_Z)] for x in (q, dq))
            w = np.sqrt([section.I_z, section.I_y])
            # least squares: sqrt(w_i) (theta x r_i - delta r_i)
            rows = [-x * np.cross(np.eye(3), r) for x, r in zip(w, vectors, strict=True)]
            wanted = [x * d for x, d in zip(w, changes, strict=True)]
            turn = np.linalg.lstsq(np.vstack(rows), np.concatenate(wanted))[0]
            work += load.moment(0.0) @ turn
        assert (forces(bare, q) - forces(system, q)) @ dq == pytest.approx(work, rel=1e-9)


SLIDING = {
    "slides": {},
    "released": {"release": (0, 0.6, 0.8)},
    "one-sided": {"unilateral": (0, 0, 1), "release": (0, 1, 0)},
}


class TestJoints:
    """Rows of joints and sliding joints: C is what the model means, the rest follows from it by derivation.

    State vectors off the constraints, with random multipliers; alpha is left out, for its forces vanish
    where the constraints hold.
    """

    @pytest.fixture(params=SLIDING)
    def system(self, request):
        return bare(mechanism(**SLIDING[request.param]))

    @staticmethod
    def rows(system, q, v=None, a=None):
        lam = system.multipliers
        return forces(system, q, v, a)[lam]

    def test_velocity_rows_are_the_rate_of_the_constraints(self, system):
        q, v, a = moving(system)
        wanted = derivative(lambda h: self.rows(system, q + h[0] * v), np.zeros(1))[:, 0]
        released = self.released_rows(system, q)  # u . lambda = 0 stands there in every form
        got = self.rows(at_level(system, "velocity"), q, v, a) - released
        assert_close(got, wanted, BY_DIFFERENCES)

    def test_acceleration_rows_are_the_second_derivative(self, system):
        q, v, a = moving(system)

        def rate(h):
            return self.rows(system, q + h * v + 0.5 * h**2 * a, v + h * a)

        at_level(system, "velocity")
        wanted = derivative(lambda h: rate(h[0]), np.zeros(1))[:, 0]
        released = self.released_rows(system, q)
        got = self.rows(at_level(system, "acceleration"), q, v, a) - released
        assert_close(got, wanted, BY_DIFFERENCES)

    @staticmethod
    def released_rows(system, q):
        """The part of the rows that does not come from the constraint."""
        kept = system.level.copy()
        system.level[:] = 0.0
        found = forces(system, q)[system.multipliers]
        system.level[:] = kept
        return found

    def test_stiffness_is_gradient_of_force(self, system):
        """With C itself in the rows the whole matrix: forces of the joints change with q and s too."""
        q, _, _ = moving(system)
        assert_close(
            matrix(system, q, stiffness=1.0), derivative(lambda x: forces(system, x), q), BY_DIFFERENCES
        )

    @pytest.mark.parametrize("level", LEVELS)
    def test_gradient_of_the_rows_is_the_same_in_every_form(self, system, level):
        """C_q, by q, v or a."""
        q, v, a = moving(system)
        wanted = derivative(lambda x: self.rows(system, x), q)
        at_level(system, level)
        part = {"position": "stiffness", "velocity": "damping", "acceleration": "mass"}[level]
        got = matrix(system, q, **{part: 1.0})
        C = got[system.multipliers]
        if level != "position":  # what stands in released directions does not depend on the form
            x = v if level == "velocity" else a
            by = {
                "velocity": lambda x: self.rows(system, q, x, a),
                "acceleration": lambda x: self.rows(system, q, v, x),
            }
            wanted = derivative(by[level], x)
            C, wanted = (np.delete(m, system.multipliers, axis=1) for m in (C, wanted))
        assert_close(C, wanted, BY_DIFFERENCES)
        assert_close(got, got.T, BY_ROUND_OFF)

    def test_forces_do_no_work_in_motions_that_the_joints_allow(self, system):
        """v . C_q^T lambda = lambda . dC/dt for every v."""
        q, v, _ = moving(system)
        none = q.copy()
        none[system.multipliers] = 0.0
        power = v @ (forces(system, q) - forces(system, none))
        at_level(system, "velocity")
        rows = self.rows(system, q, v) - self.released_rows(system, q)
        assert power == pytest.approx(q[system.multipliers] @ rows, rel=1e-11)
        assert abs(power) > 0.1

    def test_whole_matrix_at_rest(self):
        """With alpha, where the constraints hold: alpha C_q^T C_q is the gradient of its forces."""
        system = mechanism()
        q, _ = system.initial_state()
        q[system.multipliers] = np.random.default_rng(1).uniform(-1, 1, len(system.multipliers))
        A = matrix(system, q, stiffness=1.0)  # sets alpha
        rows, _ = joints_of(system)
        assert np.all(rows.alpha > 0)
        assert_close(A, derivative(lambda x: forces(system, x), q, step=1e-4), BY_DIFFERENCES)

    @pytest.mark.parametrize("mode", [FROZEN, FREE])
    def test_held_or_let_go(self, mode):
        """s keeps its value; let go, the joint has no force either."""
        system = bare(mechanism())
        q, v, a = moving(system)
        _, sliding = joints_of(system)
        lam = system.joints["on wire"][:3]
        unheld = q.copy()
        unheld[lam] = 0.0
        before = forces(system, q) - forces(system, unheld)
        sliding.mode[0] = mode
        r, A = forces(system, q, v, a), matrix(system, q, stiffness=1.0)
        s = system.numbering.arcs["on wire"]
        assert r[s] == 0.0
        assert np.array_equal(A[s], np.eye(system.n)[s])
        now = forces(system, q) - forces(system, unheld)
        others = np.setdiff1d(np.arange(system.n), [*lam, s])
        if mode == FREE:
            assert not np.any(now[others])
            assert A[np.ix_(lam, lam)] == pytest.approx(A[lam[0], lam[0]] * np.eye(3))
            assert A[lam[0], lam[0]] != 0.0  # the multipliers stay zero
        else:
            assert np.array_equal(now[others], before[others])

    def test_open_contact_has_no_force(self):
        system = bare(mechanism(unilateral=(0, 0, 1)))
        q, _, _ = moving(system)
        closed = matrix(system, q, stiffness=1.0)
        _, sliding = joints_of(system)
        sliding.open[0] = 1
        lam, tip = system.joints["on wire"][:3], system.slots["tip"][0, 0] + np.arange(3)
        opened = matrix(system, q, stiffness=1.0)
        assert closed[lam][:, tip] == pytest.approx(np.eye(3))
        assert opened[lam][:, tip] == pytest.approx(np.diag([1.0, 1.0, 0.0]))

    def test_friction(self):
        """c |t|^2 s' + mu N |t| tanh(|t| s'/v0) with the force N across the line."""
        mu, v0, c = 0.3, 0.7, 0.25
        plain = mechanism(viscous=0.0)
        rough = mechanism(viscous=c, friction=mu, friction_velocity=v0)
        q, v, _ = moving(rough)
        s = rough.numbering.arcs["on wire"]
        t = rough.probe(rough.model.bodies["wire"].at(float(q[s]))).field(q, 1)
        lam, size = q[rough.joints["on wire"][:3]], np.linalg.norm(t)
        normal = np.linalg.norm(lam - (lam @ t) * t / size**2)
        wanted = c * size**2 * v[s] + mu * normal * size * np.tanh(size * v[s] / v0)
        difference = forces(rough, q, v) - forces(plain, q, v)
        assert difference[s] == pytest.approx(wanted, rel=1e-12)
        assert not np.any(np.delete(difference, s))
        C = matrix(rough, q, damping=1.0)[s, s]  # at rest
        slope = derivative(lambda x: forces(rough, q, x)[[s]], np.zeros_like(q))[0, s]
        assert slope == pytest.approx(C, rel=1e-7)

    @pytest.mark.parametrize(
        ("element", "place"), [("cable", ()), ("original", (0.02, -0.03)), ("nonlocking", (0.01, 0.04))]
    )
    def test_line_is_that_of_the_carrier(self, element, place):
        """The point of the carrier at s, on every element and beyond the ends, from the results' formulas."""
        model = ancf.Model()
        section = ancf.Section.rectangle(0.1, 0.1, E=1e4, rho=100.0)
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(2, 0, 0), nodes=(0, 0.5, 1.4, 2.0), section=section, element=element
        )
        given = {"offset": place} if place else {}
        mass = model.add_point_mass("mass", at=beam.at(0.7, *place).initial_position, mass=1.0)
        joint = model.slide(mass, along=beam, s=0.7, **given)
        system = System(model)
        q = shaken(system)
        arc, lam = system.numbering.arcs[joint.name], system.joints[joint.name][:3]
        for s in (0.0, 0.2, 0.5, 0.9, 1.4, 1.7, 2.0):
            q[arc] = s
            gap = forces(system, q)[lam]
            state = ancf.State(system, 0.0, q, np.zeros_like(q))
            assert gap == pytest.approx(state.position(mass) - state.position(beam.at(s, *place)), abs=1e-13)


class TestInertia:
    """Point masses and rigid bodies."""

    def test_kinetic_energy_of_rigid_motions(self):
        inertia = np.array([[0.5, 0.1, -0.05], [0.1, 0.6, 0.02], [-0.05, 0.02, 0.7]])
        model, R = ancf.Model(), rotation((1, -2, 0.5), 0.8)
        body = model.add_rigid_body("body", at=(1, 2, 3), mass=2.0, inertia=inertia, axes=R)
        mass = model.add_point_mass("mass", at=(0, 1, 0), mass=0.7)
        w, u, p = np.array([0.3, -1.2, 2.0]), np.array([0.5, 0.1, -0.4]), np.array([1.0, 0, 2.0])
        body.set_motion(velocity=u, angular_velocity=w, about=(0, 0, 0))
        mass.set_motion(velocity=p)
        system = System(model)
        q, v = system.initial_state()
        M = matrix(system, q, mass=1.0)
        centre = u + np.cross(w, (1, 2, 3))
        wanted = centre @ centre + 0.5 * w @ R @ inertia @ R.T @ w + 0.35 * p @ p
        assert 0.5 * v[: system.n] @ M @ v[: system.n] == pytest.approx(wanted, rel=1e-13)

    def test_inertia_is_mass_times_acceleration(self):
        system = bare(mechanism())
        q, _, a = moving(system)
        M = matrix(system, q, mass=1.0)
        r = np.empty_like(q)
        inertia(system.core.batches, system.core.ws, a, r)
        assert_close(r, M @ a, BY_ROUND_OFF)
        assert_close(forces(system, q, a=a) - forces(system, q), M @ a, 1e-11)
        assert not np.any(M[system.multipliers])
        s = system.numbering.arcs["on wire"]
        assert M[s, s] == pytest.approx(0.2)
