"""Sliding joints against closed forms: a bead on a wire, a curve or a string, friction, drives.

Beads on the straight line of a rigid body use one kind of System, beads on cables another one.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq

import ancf
from helpers import METHODS, rate, rotation, solution

G = 9.81
SLOPE = np.array([0.6, 0.0, -0.8])  # direction of the inclined wire


def incline(turn=None, speed=0.0, weight=1.0, **more):
    """A bead on an inclined wire of length 5, which a clamped rigid body carries."""
    turn = np.eye(3) if turn is None else turn
    model = ancf.Model(gravity=turn @ (0, 0, -G))
    wire = model.add_rigid_body("wire", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1), axes=turn)
    model.clamp(wire)
    bead = model.add_point_mass("bead", at=turn @ SLOPE, mass=weight)
    bead.set_motion(velocity=speed * (turn @ SLOPE))
    joint = model.slide(bead, along=wire, line=((0, 0, 0), 5 * SLOPE), name="joint", **more)
    return model, bead, joint


class TestIncline:
    def test_free_bead(self, method):
        """Constant acceleration is exact; the wire carries the normal part of the weight."""
        model, bead, joint = incline()
        result = ancf.simulate(model, t_end=0.9, step=0.01, integrator=method)
        s = 1 + 0.5 * 0.8 * G * result.t**2
        assert result.arc_length(joint) == pytest.approx(s, abs=1e-9)
        assert result.arc_rate(joint) == pytest.approx(0.8 * G * result.t, abs=1e-9)
        assert result.position(bead) == pytest.approx(s[:, None] * SLOPE, abs=1e-9)
        force = np.array([0, 0, -G]) - (SLOPE @ (0, 0, -G)) * SLOPE  # that the wire receives
        assert result.multiplier(joint) == pytest.approx(np.tile(force, (len(s), 1)), abs=1e-6)
        assert np.ptp(result.energy.total) < 1e-9

    def test_mass_that_goes_with_s(self):
        """It adds inertia and no weight."""
        model, _, joint = incline(mass=0.6)
        result = ancf.simulate(model, t_end=0.9, step=0.01)
        s = 1 + 0.5 * 0.8 * G / 1.6 * result.t**2
        assert result.arc_length(joint) == pytest.approx(s, abs=1e-9)
        kinetic = 0.5 * 1.6 * (0.8 * G / 1.6 * result.t) ** 2
        assert result.energy.kinetic == pytest.approx(kinetic, abs=1e-9)

    def test_drive_force(self):
        """m s'' = m g sin - 5 + 4 t along the wire; its work is supplied."""
        model, _, joint = incline(force="-5 + 4*t")
        result = ancf.simulate(model, t_end=0.9, step=1e-3)
        t = result.t
        s = 1 + 0.5 * (0.8 * G - 5) * t**2 + 4 / 6 * t**3
        assert result.arc_length(joint) == pytest.approx(s, abs=1e-6)
        speed = (0.8 * G - 5) * t + 2 * t**2
        work = np.array([np.trapezoid((-5 + 4 * t[:n]) * speed[:n], t[:n]) for n in range(1, len(t) + 1)])
        assert result.energy.supplied == pytest.approx(work, abs=1e-5)
        assert np.ptp(result.energy.balance) < 1e-7

    def test_viscous_friction(self, method):
        """v = v_end (1 - exp(-c t/m)), order 2."""
        c, errors = 3.0, []
        end = 0.8 * G / c
        wanted = 1 + end * (0.9 - (1 - np.exp(-c * 0.9)) / c)
        for step in (0.02, 0.01, 0.005):
            model, _, joint = incline(viscous=c)
            result = ancf.simulate(model, t_end=0.9, step=step, integrator=method)
            errors.append(result.arc_length(joint)[-1] - wanted)
        assert rate(errors) == pytest.approx([2, 2], abs=0.1)
        lost = result.energy.total[0] - result.energy.total[-1]
        assert result.energy.dissipated[-1] == pytest.approx(lost, rel=1e-4)
        assert lost > 5.0

    def test_coulomb_friction_slows(self):
        model, _, joint = incline(friction=0.3, friction_velocity=1e-5, speed=1.0)
        result = ancf.simulate(model, t_end=0.9, step=2e-3)
        wanted = 1 + result.t + 0.5 * G * (0.8 - 0.3 * 0.6) * result.t**2
        assert result.arc_length(joint) == pytest.approx(wanted, abs=1e-6)
        path = wanted - 1
        assert result.energy.dissipated == pytest.approx(0.3 * 0.6 * G * path, abs=1e-4)
        assert np.ptp(result.energy.balance) < 1e-4

    def test_coulomb_friction_holds(self):
        """Steeper than the slope it creeps by v0 atanh(tan(slope)/mu)."""
        mu, v0 = 2.0, 1e-4
        model, _, joint = incline(friction=mu, friction_velocity=v0)
        result = ancf.simulate(model, t_end=0.5, step=2e-3)
        creep = v0 * np.arctanh(0.8 / 0.6 / mu)
        assert result.arc_rate(joint)[-1] == pytest.approx(creep, rel=1e-4)
        assert result.arc_length(joint)[-1] < 1 + 2 * 0.5 * creep

    def test_prescribed_motion(self):
        """m s'' - m g sin is what the drive of s gives; its work is supplied."""
        model, bead, joint = incline(motion="1 + 0.5*sin(3*t)")
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        s = 1 + 0.5 * np.sin(3 * result.t)
        assert result.arc_length(joint) == pytest.approx(s, abs=1e-12)
        assert result.position(bead) == pytest.approx(s[:, None] * SLOPE, abs=1e-9)
        along = result.multiplier(joint) @ SLOPE  # that the wire receives
        assert along == pytest.approx(0.8 * G + 4.5 * np.sin(3 * result.t), abs=1e-3)
        energy = result.energy.total
        assert result.energy.supplied == pytest.approx(energy - energy[0], abs=1e-5)

    def test_turned_model(self):
        Q = rotation((0.3, -1.0, 0.6), 2.1)
        runs = []
        for turn in (np.eye(3), Q):
            model, bead, joint = incline(turn, friction=0.2, viscous=0.3)
            result = ancf.simulate(model, t_end=0.5, step=1e-3, integrator=METHODS["ggl"])
            runs.append(
                (result.arc_length(joint), result.position(bead) @ turn, result.multiplier(joint) @ turn)
            )
        for one, two, bar in zip(*runs, (1e-12, 1e-12, 1e-8), strict=True):
            assert two == pytest.approx(one, abs=bar)

    def test_released_direction(self):
        """No force across the plane of x and z: a push in y drives the bead off the wire."""
        model, bead, joint = incline(release=(0, 1, 0))
        model.add_force(bead, (0, 2.0, 0))
        result = ancf.simulate(model, t_end=0.5, step=2e-3)
        assert result.position(bead)[:, 1] == pytest.approx(result.t**2, abs=1e-9)
        assert np.max(np.abs(result.multiplier(joint)[:, 1])) < 1e-9
        s = 1 + 0.5 * 0.8 * G * result.t**2
        assert result.arc_length(joint) == pytest.approx(s, abs=1e-9)

    def test_moving_wire(self, method):
        """A level wire that turns about the vertical at a constant rate: r'' = w^2 r."""
        w, errors = 2.0, []
        for step in (4e-3, 2e-3, 1e-3):
            model = ancf.Model(gravity=(0, 0, -G))
            wire = model.add_rigid_body("wire", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
            model.clamp(wire, rotation="2*t", axis=(0, 0, 1))
            bead = model.add_point_mass("bead", at=(0.3, 0, 0), mass=1.5)
            bead.set_motion(velocity=(0, w * 0.3, 0))
            joint = model.slide(bead, along=wire, line=((0, 0, 0), (3, 0, 0)))
            result = ancf.simulate(model, t_end=1.0, step=step, integrator=method)
            errors.append(result.arc_length(joint)[-1] - 0.3 * np.cosh(w))
        assert rate(errors) == pytest.approx([2, 2], abs=0.15)
        assert np.ptp(result.energy.balance) < 1e-4 * result.energy.kinetic[-1]


class TestRefused:
    def wire(self, model, name="wire", z=0.0):
        wire = model.add_rigid_body(name, at=(0, 0, z), mass=1.0, inertia=(1, 1, 1))
        model.clamp(wire)
        return {"along": wire, "line": ((0, 0, 0), (4, 0, 0))}

    def bead(self, hold="", **more):
        model = ancf.Model(gravity=(0, 0, -G))
        bead = model.add_point_mass("bead", at=(1, 0, 0), mass=1.0)
        if hold:
            model.hold(bead, position=hold)
        model.slide(bead, name="joint", **self.wire(model), **more)
        return model, bead

    @pytest.mark.parametrize(("hold", "how"), [("yz", ""), ("y", ""), ("y", "release"), ("xyz", "")])
    def test_what_supports_hold_already(self, hold, how):
        """A direction held by a support must be released in the joint."""
        model, _ = self.bead(hold, **({"release": (0, 1, 0)} if how else {}))
        if how:
            result = ancf.simulate(model, t_end=0.1, step=0.01)
            assert result.multiplier("joint")[-1] == pytest.approx((0, 0, -G), abs=1e-9)
            return
        with pytest.raises(ancf.ModelError, match='"joint" joins what supports hold already') as caught:
            ancf.simulate(model, t_end=0.1, step=0.01)
        assert caught.value.where == "connections"

    def test_skew_release_is_independent(self):
        """Two rows are left, which are no coordinate directions."""
        model, bead, joint = incline(release=(0.48, 0.6, 0.64))
        result = ancf.simulate(model, t_end=0.2, step=0.01)
        assert result.multiplier(joint) @ (0.48, 0.6, 0.64) == pytest.approx(np.zeros(21), abs=1e-9)
        off = result.position(bead)[-1] - result.arc_length(joint)[-1] * SLOPE
        assert off == pytest.approx((off @ (0.48, 0.6, 0.64)) * np.array([0.48, 0.6, 0.64]), abs=1e-9)
        assert np.linalg.norm(off) > 0.01

    @pytest.mark.parametrize(
        ("z", "match"), [(0.1, r"contradict each other: .* by 0\.1 m"), (0.0, "redundant")]
    )
    def test_two_parallel_wires(self, z, match):
        model, bead = self.bead(tolerance=0.5)
        model.slide(bead, name="other", tolerance=0.5, **self.wire(model, "second", z))
        for run in (lambda: ancf.simulate(model, t_end=0.1, step=0.01), lambda: ancf.equilibrium(model)):
            with pytest.raises(ancf.ModelError, match=match) as caught:
                run()
            assert '"joint" and "other"' in str(caught.value)


THIN = {"EA": 1e4, "EI": 1e-3, "rhoA": 0.1}


def held_cable(path, elements, length=None, **given):
    """A cable all of whose nodes are held: a wire of any shape; and its model."""
    model = ancf.Model(gravity=(0, 0, -G))
    shape = {"path": path} if callable(path) else {"start": path[0], "end": path[1]}
    wire = model.add_beam("wire", elements=elements, section=ancf.Section(**THIN), length=length, **shape)
    for x in wire.node_x:
        model.hold(wire.at(float(x)), position="xyz", slope="xyz")
    return model, wire


class TestCurvedWire:
    """A bead in a vertical circle, which a cable of 64 elements follows to about 1e-8 of its radius."""

    RADIUS = 0.8

    def run(self, step, method, elements=64, t_end=1.2):
        R = self.RADIUS
        model, wire = held_cable(lambda u: (R * np.cos(np.pi * u), 0, -R * np.sin(np.pi * u)), elements)
        s = 0.2 * R
        bead = model.add_point_mass("bead", at=wire.initial_position(s), mass=1.0)
        joint = model.slide(bead, along=wire, s=s)
        return ancf.simulate(model, t_end=t_end, step=step, integrator=method), bead, joint

    def test_pendulum(self, method):
        """R theta'' = g cos theta, through all elements and back: order 2."""
        R = self.RADIUS
        angle, speed = solution(lambda t, y: [y[1], G / R * np.cos(y[0])], [0.2, 0.0], 1.2)[-1]
        wanted, errors = R * np.array([np.cos(angle), 0, -np.sin(angle)]), []
        for step in (2e-3, 1e-3, 5e-4):
            result, bead, joint = self.run(step, method)
            errors.append(np.linalg.norm(result.position(bead)[-1] - wanted))
        assert rate(errors)[-1] == pytest.approx(2, abs=0.2)  # index 1: 1.4, 1.8, then 2
        assert np.ptp(result.arc_length(joint)) > 2.5 * R
        assert errors[-1] < 3e-6
        force = speed**2 * R + G * np.sin(angle)
        assert np.linalg.norm(result.multiplier(joint)[-1]) == pytest.approx(force, rel=5e-3)

    def test_energy(self):
        result, bead, _ = self.run(1e-3, METHODS["ggl"])
        assert np.ptp(result.energy.total) < 1e-5 * np.ptp(result.energy.kinetic)
        radius = np.linalg.norm(result.position(bead), axis=1)
        assert radius == pytest.approx(np.full(len(radius), self.RADIUS), abs=2e-7)


class TestStraightCable:
    def test_several_elements_in_a_step(self, method):
        """0.2 m a step over elements of 0.05 m: a straight line is one line for all of them."""
        model, wire = held_cable(((0, 0, 0), (4, 0, 0)), 80)
        bead = model.add_point_mass("bead", at=(0.1, 0, 0), mass=1.0)
        bead.set_motion(velocity=(10.0, 0, 0))
        joint = model.slide(bead, along=wire, viscous=2.0)
        result = ancf.simulate(model, t_end=0.36, step=0.02, integrator=method)
        exact = 0.1 + 10 / 2.0 * (1 - np.exp(-2.0 * result.t))
        assert np.max(np.diff(result.arc_length(joint))) > 0.15
        assert result.arc_length(joint) == pytest.approx(exact, abs=2e-3)
        assert result.position(bead)[:, 0] == pytest.approx(result.arc_length(joint), abs=1e-9)

    def test_stretched_carrier(self):
        """s is the reference arc length: on a cable stretched by 25 percent the bead is at 1.25 s."""
        model, wire = held_cable(((0, 0, 0), (2.5, 0, 0)), 10, length=2.0)
        bead = model.add_point_mass("bead", at=(0.5, 0, 0), mass=1.0)
        bead.set_motion(velocity=(1.0, 0, 0))
        joint = model.slide(bead, along=wire, viscous=0.5)
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        x = 0.5 + 2.0 * (1 - np.exp(-0.5 * result.t))  # the friction is along the line in space
        assert result.position(bead)[:, 0] == pytest.approx(x, abs=1e-6)
        assert result.arc_length(joint) == pytest.approx(x / 1.25, abs=1e-6)
        assert result.energy.dissipated[-1] == pytest.approx(0.5 * (1 - np.exp(-1.0)), abs=1e-6)

    def test_cable_through_a_ring(self):
        """A free straight cable flies through a ring: nothing hinders it, s falls with its speed."""
        model = ancf.Model()
        cable = model.add_beam(
            "cable", start=(0, 0, 0), end=(2, 0, 0), elements=8, section=ancf.Section(**THIN)
        )
        cable.set_motion(velocity=(3.0, 0, 0))
        model.add_point_mass("far", at=(0, 0, 5), mass=1.0)
        joint = model.slide((1.9, 0, 0), along=cable)
        result = ancf.simulate(model, t_end=0.5, step=5e-3)
        assert result.arc_length(joint) == pytest.approx(1.9 - 3.0 * result.t, abs=1e-9)
        assert np.max(np.abs(result.multiplier(joint))) < 1e-6


class TestString:
    """Taut string, length 2, tension 100 N: vibration with a bead on it."""

    def build(self, mass, s, elements=40, **more):
        model = ancf.Model()
        string = model.add_beam(
            "string",
            start=(0, 0, 0),
            end=(2, 0, 0),
            length=2 / 1.01,
            elements=elements,
            section=ancf.Section(EA=1e4, EI=1e-6, rhoA=0.1 * 1.01),
        )
        model.pin(string.start)
        model.pin(string.end)
        bead = model.add_point_mass("bead", at=(s, 0, 0), mass=mass)
        joint = model.slide(bead, along=string, **more)
        return model, string, bead, joint

    @staticmethod
    def wanted(mass, s, count):
        """k sin(k L)/(sin(k s) sin(k (L - s))) = m k^2/rho: roots of the frequency equation."""
        L, rho, T = 2.0, 0.1, 100.0

        def f(k):
            return np.sin(k * L) - mass / rho * k * np.sin(k * s) * np.sin(k * (L - s))

        grid = np.linspace(1e-3, 12, 4000)
        roots = [brentq(f, a, b) for a, b in pairwise(grid) if f(a) * f(b) < 0]
        return np.sqrt(T / rho) * np.array(roots[:count])

    @pytest.mark.parametrize("s", [1.0, 0.5])
    def test_frequencies(self, s):
        """The bead's own motion along the string costs nothing: frequency zero; each other mode twice."""
        wanted, errors = self.wanted(0.15, s, 3), []
        for elements in (20, 40, 80):
            model, *_ = self.build(0.15, s, elements)
            found = ancf.modes(model, count=7).frequencies
            assert found[0] < 1e-3 * wanted[0]
            assert found[2::2] == pytest.approx(found[1::2], rel=1e-6)
            errors.append(found[1::2] / wanted - 1)
        # at the bead the string has a kink, which the cable rounds off over an element: order 1
        bent = np.abs(errors[0]) > 1e-5
        assert np.all(np.abs(rate(errors)[:, bent] - 1) < 0.03)
        assert bent.sum() == (2 if s == 1.0 else 3)  # the second mode has a node in the middle
        assert 2 * errors[2] - errors[1] == pytest.approx(0, abs=2e-5)

    def test_vibration_at_rest_on_the_string(self):
        """The bead rides on the first mode of the string and bead, at its frequency."""
        model, _, bead, joint = self.build(0.15, 1.0)
        omega = self.wanted(0.15, 1.0, 1)[0]
        k, amplitude = omega / np.sqrt(1000.0), 1e-3
        start = ancf.State(*self.first_mode(model, amplitude, k))
        result = ancf.simulate(model, t_end=0.3, step=5e-4, start=start)
        z = result.position(bead)[:, 2]
        assert z == pytest.approx(amplitude * np.cos(omega * result.t), abs=0.02 * amplitude)
        assert result.arc_length(joint) == pytest.approx(1.0 / 1.01, abs=1e-6)
        assert np.ptp(result.energy.total) < 1e-3 * np.max(result.energy.kinetic)

    @staticmethod
    def first_mode(model, amplitude, k):
        from ancf.system.system import System

        system = System(model)
        q, v = system.initial_state()
        slots, x = system.slots["string"], 2.0 * np.linspace(0, 1, 41)
        near = np.minimum(x, 2 - x)
        q[slots[:, 0] + 2] = amplitude * np.sin(k * near) / np.sin(k)
        slope = amplitude * k * np.cos(k * near) / np.sin(k) * np.sign(1 - x) * 1.01
        q[slots[:, 1] + 2] = slope
        q[system.slots["bead"][0, 0] + 2] = amplitude
        return system, 0.0, q, v


class TestMovingLoad:
    def test_force_travels_over_a_beam(self):
        """The classical series (Krylov 1905): a force F crosses a simply supported beam at speed v."""
        L, EI, rho, F, v = 2.0, 400.0, 1.5, 1.0, 12.0
        model = ancf.Model()
        beam = model.add_beam(
            "beam",
            start=(0, 0, 0),
            end=(L, 0, 0),
            elements=16,
            section=ancf.Section(EA=1e7, EI=EI, rhoA=rho),
        )
        model.pin(beam.start)
        model.hold(beam.end, position="yz")
        load = model.add_point_mass("load", at=(0, 0, 0), mass=1e-7)
        load.set_motion(velocity=(v, 0, 0))
        model.add_force(load, (0, 0, -F))
        joint = model.slide(load, along=beam, motion=f"{v}*t")
        result = ancf.simulate(model, t_end=0.16, step=2e-4, integrator=ancf.GeneralizedAlpha(0.8))
        assert result.arc_length(joint) == pytest.approx(v * result.t, abs=1e-9)
        n = np.arange(1, 40)[:, None]
        omega, drive = (n * np.pi / L) ** 2 * np.sqrt(EI / rho), n * np.pi * v / L
        t, shape = result.t[None], np.sin(n * np.pi / 2)
        series = (np.sin(drive * t) - drive / omega * np.sin(omega * t)) / (omega**2 - drive**2)
        wanted = -2 * F / (rho * L) * np.sum(shape * series, axis=0)
        got = result.position(beam.at(1.0))[:, 2]
        assert got == pytest.approx(wanted, abs=2e-3 * np.max(np.abs(wanted)))


class TestStatics:
    def hung(self, rise, length, s, section=None):
        model = ancf.Model(gravity=(0, 0, -G))
        section = ancf.Section(**THIN) if section is None else section
        cable = model.add_beam(
            "cable", start=(0, 0, 0), end=(1, 0, rise), elements=8, section=section, length=length
        )
        model.pin(cable.start)
        model.pin(cable.end)
        bead = model.add_point_mass("bead", at=(s, 0, rise * s), mass=1.0)
        return model, cable, bead, model.slide(bead, along=cable, name="joint")

    @pytest.mark.parametrize(
        ("rise", "length", "s"), [(0.2, 1.1, 0.5), (0.2, 1.1, 0.2), (0.0, 1.1, 0.3), (0.0, 0.99, 0.3)]
    )
    def test_lowest_place(self, rise, length, s):
        """Slack or level and taut: the bead rests where the cable is level, which carries its weight."""
        model, cable, bead, joint = self.hung(rise, length, s)
        state = ancf.equilibrium(model)
        at = float(state.arc_length(joint))
        assert state.multiplier(joint) == pytest.approx((0, 0, -G), abs=1e-6)
        assert state.position(cable.at(at)) == pytest.approx(state.position(bead), abs=1e-9)
        tangent = state.slope(cable.at(at))
        assert abs(tangent[2]) < 1e-7 * np.linalg.norm(tangent)
        others = [state.position(cable.at(x))[2] for x in np.linspace(0, cable.length, 41)]
        assert np.min(others) > state.position(bead)[2] - 1e-12
        if rise == 0.0:  # to the element: the kink at the bead costs less at some places in it than at others
            assert at == pytest.approx(length / 2, abs=0.5 * length / 8)

    def test_middle(self):
        """A cable stiff enough to round the kink over some elements: exactly the middle."""
        model, _, _, joint = self.hung(0.0, 1.1, 0.3, ancf.Section(EA=1e4, EI=0.05, rhoA=0.1))
        assert ancf.equilibrium(model).arc_length(joint) == pytest.approx(0.55, abs=1e-9)

    def test_modes_about_it(self):
        """Sideways bead and cable swing as one body about the line of the supports."""
        section = ancf.Section(EA=1e5, EI=1e-4, rhoA=1e-6)
        model, _, bead, _ = self.hung(0.0, 1.25, 0.5, section)
        state = ancf.equilibrium(model)
        depth = -state.position(bead)[2]
        assert depth == pytest.approx(0.375, rel=0.05)  # of the triangle 3-4-5; the kink is rounded
        found = ancf.modes(model, about=state, count=2)
        assert found.frequencies[1] == pytest.approx(np.sqrt(G / depth), rel=1e-5)
        assert found.frequencies[0] < found.frequencies[1]  # along the ellipse, which is flatter

    def test_bead_on_a_level_wire(self):
        """Everywhere in equilibrium: it stays where it is."""
        model = ancf.Model(gravity=(0, 0, -G))
        wire = model.add_rigid_body("wire", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
        model.clamp(wire)
        bead = model.add_point_mass("bead", at=(1, 0, 0), mass=2.0)
        joint = model.slide(bead, along=wire, line=((0, 0, 0), (4, 0, 0)))
        state = ancf.equilibrium(model)
        assert state.arc_length(joint) == pytest.approx(1.0, abs=1e-9)
        assert state.multiplier(joint) == pytest.approx((0, 0, -2 * G), abs=1e-9)

    def test_no_contact_pulls(self):
        """A pan that hangs on its own spring below a taut wire, which it must not pull down."""
        model = ancf.Model(gravity=(0, 0, -G))
        section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.1)
        wire = model.add_beam(
            "wire", start=(0, 0, 0), end=(2, 0, 0), elements=8, length=1.99, section=section
        )
        model.pin(wire.start)
        model.pin(wire.end)
        pan = model.add_point_mass("pan", at=(0.5, 0, 0), mass=1.0)
        model.hold(pan, position="xy")
        model.add_spring(pan, (0.5, 0, 0.5), stiffness=100.0)
        joint = model.slide(pan, along=wire, unilateral=(0, 0, 1), release=(0, 1, 0))
        assert ancf.equilibrium(model).multiplier(joint)[2] > -1e-12

    def test_slides_off_the_end(self):
        model, *_ = self.hung(0.6, 1.0, 0.5)
        with pytest.raises(ancf.SolveError, match="slides to s = 0 m, an end of cable") as caught:
            ancf.equilibrium(model)
        assert "joint" in caught.value.where


class TestResults:
    """What a result says of its sliding joints, saved and loaded, and as a new start."""

    def run(self, **more):
        return self.simulated(*TestStatics().hung(0.2, 1.1, 0.5), **more)

    @staticmethod
    def simulated(model, cable, bead, joint, **more):
        state = ancf.equilibrium(model)
        model.add_force(bead, ("2*sin(5*t)", 0, 0))
        return ancf.simulate(model, start=state, step=1e-3, t_end=0.2, **more), model, bead, joint

    def test_saved_and_loaded(self, tmp_path):
        result, _, bead, joint = self.run()
        result.save(tmp_path / "run.h5")
        loaded = ancf.load(tmp_path / "run.h5")
        written, *_ = self.run(file=tmp_path / "direct.h5")
        for other in (loaded, written, ancf.load(tmp_path / "direct.h5")):
            assert np.array_equal(other.arc_length("joint"), result.arc_length(joint))
            assert np.array_equal(other.arc_rate("joint"), result.arc_rate(joint))
            assert np.array_equal(other.multiplier("joint"), result.multiplier(joint))
            assert np.array_equal(other.position("bead"), result.position(bead))
            assert np.array_equal(other.energy.total, result.energy.total)
        assert np.ptp(result.arc_length(joint)) > 1e-3

    def test_goes_on_from_a_state(self):
        result, model, bead, joint = self.run()
        more = ancf.simulate(model, start=result.state(100), t_end=0.2, step=1e-3)
        assert more.t == pytest.approx(result.t[100:])
        assert more.arc_length(joint) == pytest.approx(result.arc_length(joint)[100:], abs=1e-6)
        assert more.position(bead) == pytest.approx(result.position(bead)[100:], abs=1e-6)
        state = result.state(50)
        assert state.arc_length(joint) == result.arc_length("joint")[50]
        assert state.multiplier("joint").shape == (3,)

    def test_unknown_names(self):
        result, _, bead, _ = self.run()
        for ask in (result.arc_length, result.arc_rate, result.multiplier):
            with pytest.raises(ancf.ModelError, match="there are: joint"):
                ask("joint of nothing")
            with pytest.raises(ancf.ModelError, match="there are: joint"):
                ask(bead)
        with pytest.raises(ancf.ModelError):
            result.tension(bead)

    def test_gap_at_the_start(self):
        """The cable alone sags away from the bead."""
        model, cable, _, _ = TestStatics().hung(0.2, 1.1, 0.5)
        state = ancf.equilibrium(model, of=[cable])
        gap = state.position("bead") - state.position(cable.at(0.55))
        with pytest.raises(ancf.ModelError, match='"joint" does not meet') as caught:
            ancf.simulate(model, t_end=0.1, step=1e-3, start=state)
        assert f"{np.linalg.norm(gap):.6g} m apart" in str(caught.value)
        assert caught.value.where == "simulate.start"
