"""Rigid bodies and hinges against the equations of rigid body dynamics, integrated by scipy to 1e-12.

All models have one zero moment, so that they have the same kinds of forces and compile once.
"""

import numpy as np
import pytest

import ancf
from ancf.bodies.build import second_moments
from helpers import METHODS, rate, rotation, solution
from motions import rod_on_a_hinge

G = 9.81
INERTIA = (1.0, 2.0, 2.6)
STEPS = (4e-3, 2e-3, 1e-3)


def one_body(gravity=(0, 0, 0), inertia=INERTIA, at=(0, 0, 0), mass=2.0, axes=None):
    model = ancf.Model(gravity=gravity)
    body = model.add_rigid_body("body", at=at, mass=mass, inertia=inertia, axes=axes)
    model.add_moment(body, (0, 0, 0))
    return model, body


def axes_of(result, body):
    """Rotation matrices (n_t, 3, 3) of a body, columns d_1, d_2, d_3."""
    centre = result.position(body.centre)
    places = np.eye(3)
    return np.stack([result.position(body.at(*e)) - centre for e in places], axis=-1)


def spins_of(result, body):
    """Angular velocities (n_t, 3), global: half the sum of d_i x d_i'."""
    centre, v = result.position(body.centre), result.velocity(body.centre)
    pairs = [(result.position(body.at(*e)) - centre, result.velocity(body.at(*e)) - v) for e in np.eye(3)]
    return 0.5 * sum(np.cross(d, rate) for d, rate in pairs)


def angular_momentum(result, body):
    """About the origin, from positions, velocities and the inertia alone."""
    R, w = axes_of(result, body), spins_of(result, body)
    inner = np.einsum("tij,jk,tlk,tl->ti", R, body.inertia, R, w)
    return inner + body.mass * np.cross(result.position(body.centre), result.velocity(body.centre))


def errors_of_steps(run, wanted, steps=STEPS):
    """Distances of run(step) from the exact result."""
    return [np.linalg.norm(np.asarray(run(step)) - wanted) for step in steps]


def free_rotation(torque, spin, t_end):
    """Rotation matrix and spin (body axes) by Euler's equations; torque(t, R) in body axes."""
    inertia = np.array(INERTIA)

    def rates(t, y):
        R, w = y[:9].reshape(3, 3), y[9:]
        dw = (torque(t, R) - np.cross(w, inertia * w)) / inertia
        return np.append((R @ cross(w)).ravel(), dw)

    y = solution(rates, np.append(np.eye(3).ravel(), spin), t_end)[-1]
    return y[:9].reshape(3, 3), y[9:]


def cross(w):
    return np.array([[0, -w[2], w[1]], [w[2], 0, -w[0]], [-w[1], w[0], 0]])


class TestFreeRotation:
    """The tumbling body that spins about its middle axis."""

    SPIN = (0.05, 3.0, 0.02)

    def run(self, step, method, t_end=3.0, **more):
        model, body = one_body()
        body.set_motion(velocity=(0.4, -0.2, 0.1), angular_velocity=self.SPIN)
        return ancf.simulate(model, t_end=t_end, step=step, integrator=method, **more), body

    def test_follows_eulers_equations(self, method):
        wanted = free_rotation(lambda t, R: np.zeros(3), self.SPIN, 3.0)[0]
        errors = errors_of_steps(lambda h: axes_of(*self.run(h, method))[-1], wanted, (8e-3, 4e-3, 2e-3))
        assert rate(errors) == pytest.approx([2, 2], abs=0.1)
        assert errors[-1] < 1e-3

    def test_conserves(self, method):
        result, body = self.run(1e-3, method)
        L, R, energy = angular_momentum(result, body), axes_of(result, body), result.energy.total
        assert np.max(np.abs(L - L[0])) < 1e-5 * np.linalg.norm(L[0])
        assert np.max(np.abs(energy - energy[0])) < 1e-5 * energy[0]
        assert result.position(body)[-1] == pytest.approx(3.0 * np.array([0.4, -0.2, 0.1]), abs=1e-11)
        drift = {"ggl": 1e-12, "index3": 1e-12, "index1": 1e-6, "index2": 1e-4}[method.formulation]
        assert np.max(np.abs(np.einsum("tki,tkj->tij", R, R) - np.eye(3))) < drift

    def test_energy_of_the_start(self):
        result, body = self.run(1e-3, METHODS["ggl"], t_end=1e-3)
        w, v = np.array(self.SPIN), np.array([0.4, -0.2, 0.1])
        wanted = 0.5 * body.mass * v @ v + 0.5 * w @ (np.array(INERTIA) * w)
        assert result.energy.kinetic[0] == pytest.approx(wanted, rel=1e-13)

    def test_inertia_in_any_axes(self):
        """The same body described in other body axes moves the same."""
        Q = rotation((1, 2, -0.5), 0.7)
        ends = []
        for R in (np.eye(3), Q):  # its axes are the columns of R, where its inertia is R^T I R
            model, body = one_body(inertia=R.T @ np.diag(INERTIA) @ R, axes=R)
            body.set_motion(angular_velocity=self.SPIN)
            result = ancf.simulate(model, t_end=1.0, step=2e-3, integrator=METHODS["ggl"])
            ends.append(axes_of(result, body)[-1] @ R.T)
        assert ends[1] == pytest.approx(ends[0], abs=1e-10)
        assert not np.allclose(ends[0], np.eye(3), atol=0.1)

    def test_second_moments(self):
        """A box by the definition of the integrals."""
        a, b, c, mass = 0.2, 0.5, 1.1, 3.0
        inertia = mass / 12 * np.array([b**2 + c**2, a**2 + c**2, a**2 + b**2])
        _, body = one_body(inertia=inertia, mass=mass)
        assert second_moments(body) == pytest.approx(np.diag([a**2, b**2, c**2]) * mass / 12, abs=1e-15)


class TestLoads:
    def test_force_at_the_centre(self):
        """Constant acceleration is exact for the trapezoidal rule; no rotation."""
        model, body = one_body(gravity=(0, 0, -G))
        model.add_force(body, (3.0, 0, 2.0))
        result = ancf.simulate(model, t_end=1.0, step=0.01)
        t = result.t[:, None]
        wanted = 0.5 * t**2 * (np.array([1.5, 0, 1.0]) - (0, 0, G))
        assert result.position(body) == pytest.approx(wanted, abs=1e-11)
        assert axes_of(result, body) == pytest.approx(np.tile(np.eye(3), (len(t), 1, 1)), abs=1e-11)
        assert result.energy.drift == pytest.approx(np.zeros(len(t)), abs=1e-9)

    def test_moment_and_force_off_the_centre(self, method):
        """M(t) and F (both global) at the place p: Euler's equations with R^T M + p x R^T F."""
        p, F = np.array([0.3, -0.2, 0.5]), np.array([1.0, 2.0, -1.5])

        def moment(t):
            return np.array([2.0 * np.sin(3 * t), -1.0, 0.5 * t])

        def run(step):
            model, body = one_body()
            body.set_motion(angular_velocity=(0.5, 1.0, -0.4))
            model.add_moment(body, moment)
            model.add_force(body.at(*p), F)
            result = ancf.simulate(model, t_end=1.6, step=step, integrator=method)
            self.balance = np.ptp(result.energy.balance) / np.max(result.energy.kinetic)
            return axes_of(result, body)[-1]

        wanted, _ = free_rotation(lambda t, R: R.T @ moment(t) + np.cross(p, R.T @ F), (0.5, 1.0, -0.4), 1.6)
        errors = errors_of_steps(run, wanted, (8e-3, 4e-3, 2e-3))
        assert rate(errors) == pytest.approx([2, 2], abs=0.1)
        assert errors[-1] < 1e-4
        assert self.balance < 1e-4

    def test_spring_between_two_bodies(self):
        """Two free bodies joined by a spring at their rims: momentum and energy stay."""
        model, a = one_body()
        b = model.add_rigid_body("b", at=(2.0, 0, 0), mass=0.7, inertia=(0.1, 0.2, 0.25))
        model.add_spring(a.at(0.5, 0.3, 0), b.at(-0.4, 0, 0.2), stiffness=30.0, length=0.6)
        a.set_motion(velocity=(0, 0.5, 0), angular_velocity=(0, 0, 1.0))
        result = ancf.simulate(model, t_end=2.0, step=5e-4)
        momentum = sum(body.mass * result.velocity(body) for body in (a, b))
        L = angular_momentum(result, a) + angular_momentum(result, b)
        assert np.max(np.abs(momentum - momentum[0])) < 1e-10
        assert np.max(np.abs(L - L[0])) < 1e-5 * np.linalg.norm(L[0])
        assert np.ptp(result.energy.total) < 1e-5 * result.energy.total[0]
        assert np.ptp(result.energy.strain) > 0.1


class TestGyroscope:
    def test_steady_precession(self):
        """A top with a level axis precesses at m g l/(I_axis w) for ever: it keeps its height."""
        inertia, arm, w = (0.02, 0.05, 0.05), 0.4, 60.0
        model, top = one_body(gravity=(0, 0, -G), inertia=inertia, at=(arm, 0, 0), mass=1.5)
        model.connect(top.at(-arm, 0, 0), (0, 0, 0))
        precession = 1.5 * G * arm / (inertia[0] * w)
        top.set_motion(angular_velocity=(w, 0, precession), about=(0, 0, 0))
        result = ancf.simulate(model, t_end=0.5, step=5e-4, integrator=METHODS["ggl"])
        angle = precession * result.t
        circle = arm * np.stack([np.cos(angle), np.sin(angle), np.zeros_like(angle)], axis=1)
        assert angle[-1] > 2.0
        assert result.position(top) == pytest.approx(circle, abs=1e-3 * arm)
        assert np.ptp(result.energy.total) < 1e-5 * result.energy.kinetic[0]


def swing_angle(length, inertia, mass, t, start=0.0):
    """Angle below the level of a physical pendulum let go at rest."""
    k = mass * G * length / (inertia + mass * length**2)
    return solution(lambda t, y: [y[1], k * np.cos(y[0])], [start, 0.0], t)[:, 0]


class TestHinge:
    def test_physical_pendulum(self, method):
        wanted = swing_angle(0.5, 1 / 12, 1.0, 1.2)[-1]

        def run(step):
            model, rod, _ = rod_on_a_hinge()
            x, y, z = ancf.simulate(model, t_end=1.2, step=step, integrator=method).position(rod)[-1]
            assert abs(y) < 1e-12
            return np.arctan2(-z, x) % (2 * np.pi)

        errors = errors_of_steps(run, wanted, (2e-3, 1e-3, 5e-4))
        assert rate(errors)[-1] == pytest.approx(2, abs=0.1)  # index 1: 1.5, 1.8, 1.9
        assert errors[-1] < 1e-5

    def test_smaller_steps_are_better(self):
        """With the default settings too: what Newton leaves must not add up over many steps."""
        wanted, errors = swing_angle(0.5, 1 / 12, 1.0, 1.2)[-1], []
        for step in (1e-3, 2.5e-4, 1.25e-4):
            model, rod, _ = rod_on_a_hinge()
            x, _, z = ancf.simulate(model, t_end=1.2, step=step).position(rod)[-1]
            errors.append(abs(np.arctan2(-z, x) % (2 * np.pi) - wanted))
        assert errors[2] < errors[1] < errors[0]

    def test_thin_rod(self):
        """No moment of inertia about its own axis, about which the hinge holds it."""
        model, rod, _ = rod_on_a_hinge(inertia=(0, 1 / 12, 1 / 12))
        result = ancf.simulate(model, t_end=1.2, step=1e-3)
        angle = swing_angle(0.5, 1 / 12, 1.0, result.t[1:])
        wanted = 0.5 * np.stack([np.cos(angle), 0 * angle, -np.sin(angle)], axis=1)
        assert result.position(rod)[1:] == pytest.approx(wanted, abs=1e-5)
        assert np.ptp(result.energy.total) < 1e-5 * np.ptp(result.energy.kinetic)

    def test_reaction(self):
        """At rest, level: the hinge carries a quarter of the weight; in the lowest place 5/2 of it."""
        model, rod, joint = rod_on_a_hinge(inertia=(0, 1 / 12, 1 / 12))
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        force = result.multiplier(joint)[:, :3]  # on the ground
        assert force[0] == pytest.approx((0, 0, -G / 4), abs=1e-9)
        lowest = int(np.argmin(result.position(rod)[:, 2]))
        assert force[lowest] == pytest.approx((0, 0, -2.5 * G), abs=0.1)
        assert force[lowest][2] == pytest.approx(-2.5 * G, rel=1e-5)

    def test_reaction_moment(self):
        """A weight beside the plane of a hinge: it holds the moments about x and z alone."""
        model, rod, joint = rod_on_a_hinge()
        load = model.add_point_mass("load", at=(0.5, 0.3, 0), mass=0.4)
        model.connect(rod.at(0, 0.3, 0), load)
        result = ancf.simulate(model, t_end=0.01, step=1e-3)
        assert result.position(load)[-1, 1] == pytest.approx(0.3, abs=1e-12)
        assert np.max(np.abs(result.multiplier(joint)[0, 3:])) > 0.1

    def test_skew_axis(self):
        """About an axis at 30 degrees to the vertical the pendulum sees cos 60 of gravity."""
        tilt = np.radians(60)
        axis = (0, np.sin(tilt), np.cos(tilt))
        model, rod, _ = rod_on_a_hinge(axis=axis)
        result = ancf.simulate(model, t_end=1.2, step=1e-3)
        # the moment about the axis of the weight is m g l sin(tilt), its inertia that of the whole mass
        k = G * 0.5 * np.sin(tilt) / (1 / 12 + 0.25)
        angle = solution(lambda t, y: [y[1], k * np.cos(y[0])], [0.0, 0.0], 1.2)[-1, 0]
        other = np.cross(axis, (1, 0, 0))
        wanted = 0.5 * (np.cos(angle) * np.array([1, 0, 0]) + np.sin(angle) * other)
        assert result.position(rod)[-1] == pytest.approx(wanted, abs=1e-5)
        assert result.position(rod)[-1] @ axis == pytest.approx(0, abs=1e-12)

    def test_turned_model(self):
        Q = rotation((0.3, -1.0, 0.6), 2.1)
        paths = []
        for turn in (np.eye(3), Q):
            model, rod, joint = rod_on_a_hinge(turn=turn)
            result = ancf.simulate(model, t_end=0.5, step=1e-3, integrator=METHODS["ggl"])
            paths.append(result.position(rod.at(0.5, 0, 0)) @ turn)
            paths.append(result.multiplier(joint)[:, :3] @ turn)
        assert paths[2] == pytest.approx(paths[0], abs=1e-12)
        assert paths[3] == pytest.approx(paths[1], abs=1e-9)

    def test_frequency(self):
        model, rod, _ = rod_on_a_hinge(axis=(0, 1, 0))
        state = ancf.equilibrium(model)
        assert state.position(rod) == pytest.approx((0, 0, -0.5), abs=1e-10)
        wanted = np.sqrt(G * 0.5 / (1 / 12 + 0.25))
        assert ancf.modes(model, about=state, count=1).frequencies[0] == pytest.approx(wanted, rel=1e-9)


def double_pendulum(t):
    """Angles below the level of two rods of 1 m and 1 kg, let go at rest: level and hanging."""
    half, own = 0.5, 1 / 12

    def rates(t, y):
        a, b, da, db = y
        c, s = np.cos(a - b), np.sin(a - b)
        M = np.array([[own + 0.25 + 1.0, half * c], [half * c, own + 0.25]])
        right = [-half * s * db**2 + 1.5 * G * np.cos(a), half * s * da**2 + 0.5 * G * np.cos(b)]
        return [da, db, *np.linalg.solve(M, right)]

    return solution(rates, [0.0, np.pi / 2, 0.0, 0.0], t)[:, :2]


class TestTwoBodies:
    def build(self, free=False):
        model, first, _ = rod_on_a_hinge()
        inertia = (1 / 12, 1 / 12, 0.01)
        second = model.add_rigid_body("second", at=(1.0, 0, -0.5), mass=1.0, inertia=inertia)
        joint = model.hinge(first.at(0.5, 0, 0), second.at(0, 0, 0.5), axis=(0, 1, 0))
        return model, first, second, joint

    def test_double_pendulum(self, method):
        a, b = double_pendulum(1.0)[-1]
        first = np.array([np.cos(a), -np.sin(a)])
        wanted = np.append(0.5 * first, first + 0.5 * np.array([np.cos(b), -np.sin(b)]))

        def run(step):
            model, one, two, _ = self.build()
            result = ancf.simulate(model, t_end=1.0, step=step, integrator=method)
            return np.append(result.position(one)[-1, [0, 2]], result.position(two)[-1, [0, 2]])

        errors = errors_of_steps(run, wanted)
        assert rate(errors) == pytest.approx([2, 2], abs=0.15)
        assert errors[-1] < 2e-4

    def test_joint_stays_closed(self):
        model, one, two, _ = self.build()
        result = ancf.simulate(model, t_end=2.0, step=2e-3)
        gap = result.position(one.at(0.5, 0, 0)) - result.position(two.at(0, 0, 0.5))
        assert np.max(np.abs(gap)) < 1e-10
        assert np.max(np.abs(result.position(one.at(-0.5, 0, 0)))) < 1e-10
        assert np.ptp(result.energy.total) < 1e-3 * np.ptp(result.energy.kinetic)

    @pytest.mark.parametrize("joint", ["hinge", "spherical"])
    def test_free_pair_conserves_momentum(self, joint):
        model, a = one_body()
        b = model.add_rigid_body("b", at=(1.5, 0, 0), mass=0.7, inertia=(0.1, 0.2, 0.25))
        meet = (a.at(1, 0, 0), b.at(-0.5, 0, 0))
        _ = model.hinge(*meet, axis=(0, 1, 1)) if joint == "hinge" else model.connect(*meet)
        a.set_motion(angular_velocity=(0, 1.0, 0.7), about=(1, 0, 0))
        b.set_motion(angular_velocity=(0, 2.5, 2.2), about=(1, 0, 0))
        result = ancf.simulate(model, t_end=2.0, step=1e-3)
        momentum = sum(body.mass * result.velocity(body) for body in (a, b))
        L = angular_momentum(result, a) + angular_momentum(result, b)
        assert np.max(np.abs(momentum - momentum[0])) < 1e-9
        assert np.max(np.abs(L - L[0])) < 1e-5 * np.linalg.norm(L[0])
        assert np.ptp(result.energy.total) < 1e-5 * result.energy.total[0]
        assert np.ptp(axes_of(result, b)[:, 0, 0]) > 0.5

    def test_start_is_made_consistent(self):
        """A body moves where the joint forbids it: the nearest motion in the sense of the mass is taken."""
        model, rod, _ = rod_on_a_hinge(inertia=(0, 1 / 12, 1 / 12))
        rod.set_motion(velocity=(0, 0, 1.0))  # a push at the centre: w = m l v/(I + m l^2)
        result = ancf.simulate(model, t_end=1e-3, step=1e-3)
        assert result.velocity(rod)[0] == pytest.approx((0, 0, 0.75), abs=1e-9)


class TestSupports:
    def test_driven_body(self):
        """A clamped body goes where the clamp turns and shifts it."""
        model, body = one_body(gravity=(0, 0, -G), at=(1, 2, 3))
        model.clamp(body, rotation="0.8*sin(3*t)", axis=(0, 0, 1), displacement=("0.1*t", 0, 0))
        load = model.add_point_mass("load", at=(1.5, 2, 3), mass=0.5)
        joint = model.connect(body.at(0.5, 0, 0), load)
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        angle = 0.8 * np.sin(3 * result.t)
        wanted = np.stack([1 + 0.1 * result.t + 0.5 * np.cos(angle), 2 + 0.5 * np.sin(angle)], axis=1)
        assert result.position(load)[:, :2] == pytest.approx(wanted, abs=1e-9)
        force = result.multiplier(joint)  # that the load receives
        rate_ = 2.4 * np.cos(3 * result.t)
        radial = -0.5 * 0.5 * rate_**2
        towards = np.stack([np.cos(angle), np.sin(angle)], axis=1)
        assert np.sum(force[:, :2] * towards, axis=1) == pytest.approx(radial, abs=2e-3)
        assert force[:, 2] == pytest.approx(np.full(len(angle), 0.5 * G), abs=1e-7)
        assert np.ptp(result.energy.balance) < 1e-5 * np.max(result.energy.kinetic)

    def test_pinned_centre_turns_freely(self):
        model, body = one_body(gravity=(0, 0, -G))
        model.pin(body)
        body.set_motion(angular_velocity=(0, 0, 2.0))
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        assert np.max(np.abs(result.position(body))) == 0.0
        assert axes_of(result, body)[-1] == pytest.approx(rotation((0, 0, 1), -2.0), abs=1e-6)


class TestStatics:
    def test_rod_on_three_springs(self):
        """Each carries a third of the weight; one that is softer makes the rod lean."""
        model, plate = one_body(gravity=(0, 0, -G), inertia=(0.2, 0.2, 0.4), mass=3.0)
        corners = [(np.cos(a), np.sin(a), 0.0) for a in 2 * np.pi * np.arange(3) / 3]
        for corner in corners:
            model.add_spring(plate.at(*corner), np.add(corner, (0, 0, 2.0)), stiffness=200.0)
        state = ancf.equilibrium(model)
        sag = 3.0 * G / 600.0
        assert state.position(plate) == pytest.approx((0, 0, -sag), abs=1e-10)
        assert state.position(plate.at(*corners[1])) == pytest.approx(
            np.subtract(corners[1], (0, 0, sag)), abs=1e-9
        )
        # sideways it swings on three strings, up and down on three springs
        found = ancf.modes(model, about=state, count=6).frequencies
        for wanted in (np.sqrt(G / (2.0 + sag)), np.sqrt(200.0)):
            assert np.min(np.abs(found / wanted - 1)) < 1e-6

    def test_hanging_chain(self):
        """Two rods joined by a hinge find their lowest place from a level start."""
        model, first, second, joint = TestTwoBodies().build()
        state = ancf.equilibrium(model)
        assert state.position(first) == pytest.approx((0, 0, -0.5), abs=1e-9)
        assert state.position(second) == pytest.approx((0, 0, -1.5), abs=1e-9)
        assert state.multiplier(joint)[:3] == pytest.approx((0, 0, G), abs=1e-8)  # the second receives

    def test_moment_against_weight(self):
        """M = m g l sin(angle from the vertical)."""
        model, rod, _ = rod_on_a_hinge()
        model.add_moment(rod, (0, -1.0 * G * 0.5 * np.sin(0.6), 0))
        state = ancf.equilibrium(model)
        assert state.position(rod) == pytest.approx((0.5 * np.sin(0.6), 0, -0.5 * np.cos(0.6)), abs=1e-9)


class TestBad:
    def test_free_thin_rod(self):
        """Nothing resists its rotation about its own axis."""
        model, _ = one_body(inertia=(0, 1.0, 1.0))
        with pytest.raises(ancf.SolveError, match="mass matrix is singular") as caught:
            ancf.simulate(model, t_end=1.0, step=0.01)
        assert "body" in str(caught.value)

    def test_joint_to_what_is_held(self):
        model, body = one_body()
        model.clamp(body)
        model.connect(body.at(0, 0, 1), (0, 0, 1), name="bolt")
        with pytest.raises(ancf.ModelError, match='"bolt" joins what supports hold already'):
            ancf.simulate(model, t_end=1.0, step=0.01)


class TestSize:
    """What a body is made of, and what else is in the model, changes nothing of how it turns."""

    @staticmethod
    def turned(mass, radius, beside):
        """Place of a point at the radius after 1 s of 1 rad/s about z, in radii, and counts of the run."""
        model = ancf.Model()
        if beside:
            steel = ancf.Section(EA=1e8, EI=1e3, rhoA=10.0)
            rope = model.add_beam("rope", start=(3, 0, 0), end=(8, 0, 0), elements=4, section=steel)
            model.pin(rope.start)
            ship = model.add_rigid_body("ship", at=(9, 0, 0), mass=1e5, inertia=(1e5, 1e5, 1e5))
            model.connect(rope.end, ship.at(-1, 0, 0))
        own = 0.5 * mass * radius**2
        body = model.add_rigid_body("body", at=(0, 0, 0), mass=mass, inertia=(own, own, 2 * own))
        body.set_motion(angular_velocity=(0, 0, 1.0))
        run = ancf.simulate(model, t_end=1.0, step=1e-2)
        assert not run.notes
        arm = run.position(body.at(radius, 0, 0))[-1] - run.position(body.centre)[-1]
        return arm / radius, run.stats

    @pytest.mark.parametrize("beside", [False, True], ids=["alone", "beside a ship on a rope"])
    @pytest.mark.parametrize(
        ("mass", "radius"), [(1e-9, 1e-3), (1e-15, 1e-5), (1.0, 1e-6), (1e-18, 1.0), (1e9, 1e3)]
    )
    def test_a_body_of_any_mass_and_size_turns_alike(self, mass, radius, beside):
        arm, stats = self.turned(mass, radius, beside)
        np.testing.assert_allclose(arm, (np.cos(1.0), np.sin(1.0), 0.0), atol=2e-5)
        assert stats.jacobians < 10
