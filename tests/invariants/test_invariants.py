"""What may not depend on the observer, and what motion conserves.

The kernels see rotations to round-off: 1e-12 of the stiffness.  Runs agree to Newton's tolerance, 1e-11
of the size of the model in each step, a few hundred steps long.
"""

from itertools import pairwise

import numpy as np
import pytest

import ancf
from ancf.elements.cable_damping import STRAIGHT
from ancf.elements.registry import ELEMENTS
from ancf.system.system import System
from helpers import (
    SHAPES,
    SOFT,
    SOLIDS,
    VARIANTS,
    arc,
    cable,
    energy,
    forces,
    matrix,
    random_rate,
    rate,
    rotation,
    shaken,
    square,
)

Q = rotation((0.3, -1.0, 0.6), 2.1)
SHIFT = np.array([3.0, -2.0, 5.0])
EXACT = ancf.Newton(tolerance=1e-13, modified=False)


def turned(system, q, shift=SHIFT, turn=Q):
    """State vector of the same shape elsewhere; without shift also rates and forces."""
    x = q.reshape(-1, 3) @ turn.T
    for slots in system.slots.values():
        x[slots[:, 0] // 3] += shift
    return x.ravel()


def scalar_mass(system):
    """Mass matrix of one component, with one row for each slot of three."""
    M = matrix(system, system.initial_state()[0], mass=1.0)
    return M[::3, ::3]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("variant", VARIANTS)
class TestObserver:
    def test_forces_turn_with_the_body(self, variant, shape):
        system = System(cable(shape, **VARIANTS[variant], damped=True)[0])
        q, v, a = shaken(system), random_rate(system), random_rate(system, 5)
        f = forces(system, q, v, a)
        none = np.zeros(3)
        there = forces(system, turned(system, q), turned(system, v, none), turned(system, a, none))
        assert np.max(np.abs(there - turned(system, f, none))) < 1e-12 * np.max(np.abs(f)) * 50

    def test_energy_does_not_change(self, variant, shape):
        system = System(cable(shape, **VARIANTS[variant])[0])
        q = shaken(system)
        here, there = (energy(system, x) for x in (q, turned(system, q)))
        assert there == pytest.approx(here, rel=1e-12)


class TestRigidMotion:
    @pytest.mark.parametrize("shape", ["straight", "curved"])
    @pytest.mark.parametrize("variant", VARIANTS)
    def test_gives_no_force(self, variant, shape):
        """EA eps of round-off; a curved cable also has its rounded-off curvature, 1e-8 EI kappa/h."""
        system = System(cable(shape, **VARIANTS[variant])[0])
        beam = system.model.bodies["beam"]
        start = system.initial_state()[0]
        spin = rotation(beam.node_tangent[0], 2.5)  # about its own axis, if it is straight
        bar = 1e-12 if shape == "straight" or beam.element in SOLIDS else 1e-6
        for turn in (Q, spin):
            q = turned(system, start, turn=turn)
            assert np.max(np.abs(forces(system, q))) < bar * beam.section.EA
            assert energy(system, q) < bar * beam.section.EA * beam.length
        assert np.max(np.abs(forces(system, shaken(system)))) > 0.1

    @pytest.mark.parametrize("element", SOLIDS)
    def test_what_is_not_rigid_is_seen(self, element):
        """The sections turn about the axis, one more than the other: that is torsion."""
        system = System(cable("straight", element=element)[0])
        beam, q = system.model.bodies["beam"], system.initial_state()[0]
        slots, t = system.slots["beam"], beam.node_tangent[0]
        for node, x in enumerate(beam.node_x):
            turn, ahead = rotation(t, 1e-3 * x), rotation(t, 1e-3 * x + 0.5 * np.pi)
            for k, axis in ((2, beam.node_y[node]), (3, beam.node_z[node])):
                q[slots[node, k] + np.arange(3)] = turn @ axis
                for internal in slots[node, 4:][k - 2 : k - 1]:  # of a normal axis: its rate is a quarter on
                    q[internal + np.arange(3)] = 1e-3 * (ahead @ axis)
        wanted = 0.5 * beam.torsional_stiffness * 1e-6 * beam.length
        assert energy(system, q) == pytest.approx(wanted, rel=1e-4)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_is_not_damped(self, element):
        """Rates of the scalar products vanish in a rigid rotation, of any shape."""
        system = System(cable("curved", element=element, damped=True)[0])
        bare = System(cable("curved", element=element)[0])
        q, w = shaken(system), np.array([2.0, -1.0, 3.0])
        v = np.cross(w, q.reshape(-1, 3)).ravel()
        damping = forces(system, q, v) - forces(bare, q, v)
        used = system.slots["beam"][:, 2:].ravel()[:, None] + np.arange(3)
        assert np.max(np.abs(damping[used])) < 1e-12  # no forces on the sections
        viscous = v @ damping  # what is left is the drag of the motion itself
        M = matrix(bare, q, mass=1.0)
        centreline = np.zeros_like(v)
        along = system.slots["beam"][:, :2].ravel()[:, None] + np.arange(3)
        centreline[along] = v[along]
        drag = 0.3 / system.model.bodies["beam"].section.rhoA * centreline @ M @ centreline
        assert viscous == pytest.approx(drag, rel=1e-12)

    @staticmethod
    def bending_power(path, w):
        """Power of bending damping in a rigid rotation, and the cable."""
        model = ancf.Model()
        section = ancf.Section(**SOFT, bending_damping=0.2, axial_damping=0.3)
        beam = model.add_beam("beam", path=path, elements=6, section=section)
        beam.set_motion(angular_velocity=w)
        system = System(model)
        q, v = system.initial_state()
        return v @ (forces(system, q, v) - forces(system, q)), beam

    def test_rotation_in_the_plane_of_an_arc_is_not_damped(self):
        power, _ = self.bending_power(lambda u: (np.sin(u), np.cos(u), 0.0), (0, 0, 3.0))
        assert abs(power) < 1e-13

    def test_spin_is_damped_by_no_more_than_the_rounding_off(self):
        """Turning the curvature about the tangent costs nothing but D_b w^2 (0.01/L)^2 per length."""
        w = np.array([2.0, -1.0, 3.0])
        power, beam = self.bending_power(arc, w)
        h = beam.length / beam.elements
        assert 0 <= power <= 0.2 * (w @ w) * (STRAIGHT / h) ** 2 * beam.length
        real = SOFT["EI"] * 0.2 / SOFT["EI"] * (w @ w) * beam.length  # a damper that minds spin: kappa ~ 1
        assert power < 0.01 * real


def swing(turn, variant, stretch="free"):
    """A bent, loaded, driven body, seen in axes turned by the matrix ``turn``."""
    model = ancf.Model(gravity=turn @ (0.5, -1.0, -9.81))
    given = VARIANTS[variant]
    damping = {"damping": 0.2, "bending_damping": 0.01, "axial_damping": 0.3}
    section = square(given["element"], EA=4e3, EI=0.8, rhoA=0.7, **damping)
    y = turn @ (0.1, 1.0, 0.3)
    beam = model.add_beam(
        "beam", path=lambda u: turn @ arc(u), elements=5, section=section, y_axis=y, **given
    )
    spin = {"rotation": "0.3*sin(4*t)", "axis": turn @ (0.2, 1.0, -0.3)}
    model.clamp(beam.start, stretch=stretch, **spin)
    corner = (0.02, -0.015) if given["element"] in SOLIDS else ()
    model.add_force(beam.at(beam.length, *corner), lambda t: turn @ (2.0, np.sin(9 * t), 1.0))
    model.add_moment(beam.at(0.6 * beam.length), turn @ (0.1, 0.4, -0.2))
    model.add_distributed_load(beam, turn @ (0.0, 1.5, 0.0), between=(0.2, 0.9))
    model.add_spring(beam.at(0.5 * beam.length, *corner), turn @ (0.4, 0.8, 0.2), stiffness=20.0, damping=0.5)
    return model, beam


@pytest.mark.parametrize("variant", VARIANTS)
class TestTurnedModel:
    def test_statics(self, variant):
        (here, beam), (there, other) = swing(np.eye(3), variant), swing(Q, variant)
        a, b = ancf.equilibrium(here), ancf.equilibrium(there)
        assert np.linalg.norm(a.position(beam.end) - arc(1.0)) > 0.05
        for x in (0.3, 0.7, 1.0):
            p, q = beam.at(x), other.at(x)
            assert b.position(q) == pytest.approx(Q @ a.position(p), abs=1e-10)
            assert b.tension(q) == pytest.approx(a.tension(p), rel=1e-7)
            assert b.curvature(q) == pytest.approx(a.curvature(p), rel=1e-7)
            if VARIANTS[variant]["element"] in SOLIDS:
                assert b.section_moment(q) == pytest.approx(a.section_moment(p), rel=1e-6, abs=1e-8)
                assert b.section_rotation(q) == pytest.approx(Q @ a.section_rotation(p), abs=1e-8)
                assert b.twist(q) == pytest.approx(a.twist(p), abs=1e-8)
                one, two = (m.strain_tensor(w.at(x, 0.01, 0.02)) for m, w in ((a, beam), (b, other)))
                assert two == pytest.approx(one, abs=1e-8)

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_dynamics(self, variant, stretch):
        runs = []
        for turn in (np.eye(3), Q):
            model, beam = swing(turn, variant, stretch)
            runs.append((ancf.simulate(model, t_end=0.2, step=1e-3), beam))
        (a, beam), (b, other) = runs
        assert np.ptp(a.position(beam.end), axis=0).max() > 0.1
        assert b.position(other.end) == pytest.approx(a.position(beam.end) @ Q.T, abs=1e-8)
        for name in ("kinetic", "strain", "potential", "dissipated", "supplied"):
            one, two = getattr(a.energy, name), getattr(b.energy, name)
            assert two == pytest.approx(one, abs=1e-6 * np.max(np.abs(one)))


@pytest.mark.parametrize("element", ELEMENTS)
class TestFreeFlight:
    """A cable or beam bent from straight, let go in space with a rotation."""

    @staticmethod
    def fly(element, step, integrator=None):
        model, beam = cable("bent from straight", elements=6, element=element)
        beam.set_motion(velocity=(0.3, 0.1, -0.2), angular_velocity=(1.0, -2.0, 1.5))
        integrator = ancf.Trapezoidal(newton=EXACT) if integrator is None else integrator
        return ancf.simulate(model, t_end=0.2, step=step, integrator=integrator)

    @staticmethod
    def momenta(result):
        system = result.state(0).system
        M = scalar_mass(system)
        r, v = (x.reshape(len(x), -1, 3) for x in (result.q, result.v))
        one = np.zeros(len(M))
        one[system.slots["beam"][:, 0] // 3] = 1.0
        momentum = np.einsum("i,ij,tjc->tc", one, M, v)
        spin = np.cross(r[:, :, None], v[:, None, :])
        return momentum, np.einsum("ij,tijc->tc", M, spin)

    def test_momentum(self, element):
        momentum, _ = self.momenta(self.fly(element, 2e-3))
        assert np.linalg.norm(momentum[0]) > 0.1
        assert momentum == pytest.approx(np.broadcast_to(momentum[0], momentum.shape), abs=1e-9)

    @pytest.mark.parametrize("step", [2e-3, 1e-3, 2.5e-4])
    def test_momentum_does_not_depend_on_newton(self, element, step):
        """What Newton leaves is no force from outside; it used to add up, the more the finer the step."""
        for tolerance in (1e-8, 1e-11):
            method = ancf.Trapezoidal(newton=ancf.Newton(tolerance=tolerance))
            momentum, _ = self.momenta(self.fly(element, step, method))
            assert np.abs(momentum - momentum[0]).max() < 1e-12 * np.linalg.norm(momentum[0])

    def test_angular_momentum(self, element):
        """The trapezoidal rule keeps it to the order of the method."""
        errors = []
        for step in (1e-3, 5e-4, 2.5e-4):
            _, spin = self.momenta(self.fly(element, step))
            errors.append(np.max(np.linalg.norm(spin - spin[0], axis=1)) / np.linalg.norm(spin[0]))
        assert errors[-1] < 1e-3
        assert rate(errors) == pytest.approx([2, 2], abs=0.3)

    def test_centre_of_mass_flies_straight(self, element):
        result = self.fly(element, 2e-3)
        system = result.state(0).system
        M = scalar_mass(system)
        one = np.zeros(len(M))
        one[system.slots["beam"][:, 0] // 3] = 1.0
        centre = np.einsum("i,ij,tjc->tc", one, M, result.q.reshape(len(result.t), -1, 3)) / (one @ M @ one)
        v0 = np.einsum("i,ij,jc->c", one, M, result.v[0].reshape(-1, 3)) / (one @ M @ one)
        assert centre == pytest.approx(centre[0] + result.t[:, None] * v0, abs=1e-10)


@pytest.mark.parametrize("element", ELEMENTS)
class TestEnergy:
    """total + dissipated - supplied is constant but for the error of the method, order 2."""

    @staticmethod
    def undamped(element):
        model, beam = cable("straight", elements=4, element=element)
        model.pin(beam.start)
        beam.set_motion(angular_velocity=(1.0, 2.0, -3.0))
        return model

    @staticmethod
    def damped(element):
        model, beam = cable("curved", elements=4, element=element, damped=True)
        model.clamp(beam.start)
        beam.set_motion(angular_velocity=(0.0, 0.0, 0.0), velocity=(0, 0, 0))
        model.add_force(beam.end, ["3*(1 - cos(5*t))", "0", "2*(1 - cos(7*t))"])
        return model

    @staticmethod
    def loaded(element):
        model, beam = cable("curved", elements=4, element=element)
        model.gravity[:] = 0.0, 0.0, -1.0
        model.pin(beam.start)
        model.add_moment(beam.end, ["0", "0.4*sin(6*t)", "0.2*sin(3*t)"])
        model.add_distributed_load(beam, ["0", "sin(5*t)", "0"])
        return model

    @staticmethod
    def driven(element):
        model, beam = cable("straight", elements=4, element=element, damped=True)
        turn = {"rotation": "0.4*(1 - cos(6*t))", "axis": (0, 0, 1), "displacement": ["0", "0", "0.2*t**3"]}
        model.clamp(beam.start, **turn)
        model.pin(beam.end, displacement=["-0.1*(1 - cos(4*t))", "0", "0"])
        return model

    @staticmethod
    def sprung(element):
        model, beam = cable("straight", elements=4, element=element)
        model.pin(beam.start)
        model.add_spring(beam.end, (1.5, 0.2, 0.4), stiffness=20.0, damping=1.5, length=0.1)
        return model

    @pytest.mark.parametrize("case", ["undamped", "damped", "loaded", "driven", "sprung"])
    def test_drift_has_order_two(self, element, case):
        drift = []
        finest = 6.25e-5 if case == "sprung" else 2.5e-4  # the spring starts with a jump: axial waves
        for step in (4 * finest, 2 * finest, finest):
            method = ancf.Trapezoidal(newton=EXACT)
            energy = ancf.simulate(
                getattr(self, case)(element), t_end=0.8, step=step, integrator=method
            ).energy
            drift.append(np.max(np.abs(energy.balance - energy.balance[0])))
        exchanged = np.ptp(energy.total) + np.ptp(energy.kinetic) + np.ptp(energy.dissipated)
        assert drift[-1] < 1e-3 * exchanged
        assert rate(drift) == pytest.approx([2, 2], abs=0.25)

    def test_parts_are_what_they_say(self, element):
        """Nothing dissipated without damping, nothing supplied without loads; damping only takes."""
        for case, dissipates, supplies in (
            ("undamped", False, False),
            ("damped", True, True),
            ("loaded", False, True),
            ("driven", True, True),
            ("sprung", True, False),
        ):
            energy = ancf.simulate(getattr(self, case)(element), t_end=0.4, step=4e-3).energy
            assert np.any(energy.dissipated > 0) == dissipates, case
            assert np.any(energy.supplied != 0) == supplies, case
            assert all(b >= a - 1e-12 for a, b in pairwise(energy.dissipated)), case


@pytest.mark.parametrize("element", ELEMENTS)
class TestReversibility:
    def test_back_to_the_start(self, element):
        """The trapezoidal rule runs backwards along its own steps."""
        model, beam = cable("bent from straight", elements=4, element=element)
        model.gravity[:] = 0.0, 0.0, -9.81
        model.pin(beam.start)
        method = ancf.Trapezoidal(newton=EXACT)
        there = ancf.simulate(model, t_end=0.3, step=2e-3, integrator=method)
        end = there.state()
        start = ancf.State(end.system, 0.0, end.q, -end.v)
        back = ancf.simulate(model, t_end=0.3, step=2e-3, integrator=method, start=start)
        assert np.linalg.norm(there.position(beam.end)[-1] - arc(1.0)) > 0.1
        assert back.position(beam.end) == pytest.approx(there.position(beam.end)[::-1], abs=1e-9)

    def test_generalised_alpha_does_not_come_back(self, element):
        """The check above can fail: numerical damping is not reversible."""
        model, beam = cable("bent from straight", elements=4, element=element)
        model.pin(beam.start)
        method = ancf.GeneralizedAlpha(rho_inf=0.5, newton=EXACT)
        there = ancf.simulate(model, t_end=0.3, step=2e-3, integrator=method)
        end = there.state()
        start = ancf.State(end.system, 0.0, end.q, -end.v)
        back = ancf.simulate(model, t_end=0.3, step=2e-3, integrator=method, start=start)
        assert np.linalg.norm(back.position(beam.end)[-1] - arc(1.0)) > 1e-6
