"""Torsion springs and dampers against oscillators, elastic clamps, buckling and kinked beams."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

import ancf

SPACES = {"straight": Rotation.identity(), "turned": Rotation.from_euler("xyz", (0.5, -0.9, 2.0))}
METHODS = [ancf.Trapezoidal(), ancf.GeneralizedAlpha(rho_inf=0.9), ancf.Radau(tolerance=1e-8)]


def wheel(space, about=0.3, **spring):
    """A wheel on a hinge along z with a torsion spring to the ground."""
    model = ancf.Model()
    body = model.add_rigid_body(
        "wheel", at=(0, 0, 0), mass=1.0, inertia=(0.2, 0.2, about), axes=space.as_matrix()
    )
    axis = space.apply((0, 0, 1))
    model.hinge(body, (0, 0, 0), axis=axis)
    item = model.add_torsion_spring(body, (0, 0, 0), axis=3.0 * axis, **spring)
    return model, body, item


@pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
class TestOscillator:
    @pytest.mark.parametrize("method", METHODS, ids=["trapezoidal", "alpha", "radau"])
    @pytest.mark.parametrize("stiffness", [2.0, 30.0])
    def test_swings_with_its_frequency(self, space, method, stiffness):
        """theta = (omega0/omega) sin(omega t), omega^2 = k/I; the energies add up."""
        model, body, item = wheel(space, stiffness=stiffness)
        body.set_motion(angular_velocity=space.apply((0, 0, 5.0)))
        run = ancf.simulate(model, t_end=1.0, step=5e-4, integrator=method, sensors=[item], output_step=0.02)
        omega = np.sqrt(stiffness / 0.3)
        wanted = 5.0 / omega * np.sin(omega * run.sensors.t)
        np.testing.assert_allclose(run.sensors.torsion_angle(item), wanted, atol=5e-5)
        np.testing.assert_allclose(
            run.sensors.torsion_moment(item), stiffness * wanted, atol=5e-5 * stiffness
        )
        theta = 5.0 / omega * np.sin(omega * run.t)
        np.testing.assert_allclose(run.energy.strain, 0.5 * stiffness * theta**2, atol=2e-4 * 3.75)
        assert abs(run.energy.drift).max() < (2e-3 if isinstance(method, ancf.GeneralizedAlpha) else 1e-4)

    def test_goes_round_several_times(self, space):
        """More than two turns and back: the moment grows on, and the energy is that of the whole angle."""
        model, body, item = wheel(space, stiffness=2.0)
        body.set_motion(angular_velocity=space.apply((0, 0, 40.0)))
        run = ancf.simulate(model, t_end=0.9, step=1e-3, output_step=0.01)
        omega = np.sqrt(2.0 / 0.3)
        wanted = 40.0 / omega * np.sin(omega * run.t)
        assert wanted.max() > 4 * np.pi
        np.testing.assert_allclose(run.torsion_angle(item), wanted, atol=5e-3)
        np.testing.assert_allclose(run.energy.strain, wanted**2, atol=0.2)
        assert abs(run.energy.drift).max() < 1e-3 * 240

    def test_damping_and_an_angle_without_moment(self, space):
        """I theta'' + c theta' + k (theta - theta0) = 0 from rest; what is dissipated is the energy lost."""
        model, _, item = wheel(space, stiffness=8.0, damping=0.4, angle=0.7)
        run = ancf.simulate(model, t_end=1.5, step=5e-4, sensors=[item])
        ode = solve_ivp(
            lambda t, y: (y[1], -(8.0 * (y[0] - 0.7) + 0.4 * y[1]) / 0.3),
            (0, 1.5),
            (0.0, 0.0),
            t_eval=run.t,
            rtol=1e-10,
        )
        np.testing.assert_allclose(run.torsion_angle(item), ode.y[0], atol=1e-5)
        assert run.energy.strain[0] == pytest.approx(0.5 * 8.0 * 0.49)
        lost = run.energy.total[0] - run.energy.total[-1]
        assert run.energy.dissipated[-1] == pytest.approx(lost, rel=1e-5)
        assert ancf.equilibrium(model).torsion_angle(item) == pytest.approx(0.7, abs=1e-9)

    @pytest.mark.parametrize("swapped", [False, True])
    def test_between_two_bodies(self, space, swapped):
        """Two wheels on one axis swing against each other: omega^2 = k (1/I1 + 1/I2)."""
        model, first, _ = wheel(space, stiffness=0.0, damping=1e-12)
        second = model.add_rigid_body(
            "second", at=space.apply((0, 0, 1)), mass=1.0, inertia=(0.1, 0.1, 0.12), axes=space.as_matrix()
        )
        axis = space.apply((0, 0, 1))
        model.hinge(second, space.apply((0, 0, 1)), axis=axis)
        ends = (second, first) if swapped else (first, second)
        item = model.add_torsion_spring(*ends, axis=axis, stiffness=6.0)
        first.set_motion(angular_velocity=space.apply((0, 0, 3.0)))
        run = ancf.simulate(model, t_end=1.0, step=5e-4)
        omega = np.sqrt(6.0 * (1 / 0.3 + 1 / 0.12))
        wanted = (-1 if swapped else 1) * 3.0 / omega * np.sin(omega * run.t)
        np.testing.assert_allclose(run.torsion_angle(item), wanted, atol=5e-5)
        frequencies = ancf.modes(model, count=2).frequencies_hz
        assert frequencies[1] == pytest.approx(omega / (2 * np.pi), rel=1e-6)


class TestBeams:
    @pytest.mark.parametrize("element", ["cable", "nonlocking"])
    @pytest.mark.parametrize("stiffness", [30.0, 4000.0])
    @pytest.mark.parametrize("axis", [(0, 1, 0), (0, 0, -1)])
    def test_an_elastic_clamp(self, element, stiffness, axis):
        """Tip of a cantilever on a torsion spring: F l^3/(3 EI) + F l^2/k."""
        model = ancf.Model()
        section = ancf.Section.rectangle(width=0.02, height=0.02, E=2e11, rho=7800.0, nu=0.3)
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(1.3, 0, 0), elements=6, section=section, element=element
        )
        model.pin(beam.start)
        across = np.cross(axis, (1, 0, 0))
        if element != "cable":
            model.hold(beam.start, twist=True)
            model.hold(beam.end, position="z" if axis[1] == 0 else "y")
        else:
            model.hold(beam.end, position="z" if axis[1] == 0 else "y")
        spring = model.add_torsion_spring(beam.start, (0, 0, 0), axis=axis, stiffness=stiffness)
        model.add_force(beam.end, 0.01 * across)
        state = ancf.equilibrium(model)
        wanted = 1.3**3 / (3 * section.EI_y) + 1.3**2 / stiffness
        shear = 0 if element == "cable" else 1.3 / (section.G * section.A)
        moved = (state.position(beam.end) - (1.3, 0, 0)) @ across / 0.01
        assert moved == pytest.approx(wanted + shear, rel=2e-4)
        assert state.torsion_moment(spring) == pytest.approx(0.013, rel=1e-5)

    @pytest.mark.parametrize("shape", [(0.02, 0.02), (0.03, 0.01)])
    def test_a_shaft_with_an_elastic_end(self, shape):
        """Twist by a torque: T l/(GJ) + T/k, also of a flat section."""
        model = ancf.Model()
        section = ancf.Section.rectangle(width=shape[0], height=shape[1], E=2e11, rho=7800.0, nu=0.3)
        rod = model.add_beam(
            "rod", start=(0, 0, 0), end=(0, 0, 1), elements=4, section=section, element="nonlocking"
        )
        model.pin(rod.start)
        model.hold(rod.start, slope="xy")
        model.add_torsion_spring(rod.start, (0, 0, 0), axis=(0, 0, 1), stiffness=70.0)
        model.add_moment(rod.end, (0, 0, 0.5))
        wanted = 0.5 / (section.G * section.J) + 0.5 / 70.0
        state = ancf.equilibrium(model)
        turned = state.position(rod.at(1.0, 0, 0.004)) - state.position(rod.end)
        still = rod.initial_position(1.0, 0, 0.004) - rod.initial_position(1.0)
        angle = np.arcsin(np.cross(still, turned)[2] / 0.004**2)
        assert angle == pytest.approx(wanted, rel=1e-3)

    @pytest.mark.parametrize("ratio", [0.5, 5.0])
    def test_frequencies_of_an_elastically_clamped_beam(self, ratio):
        """Roots of k l/EI (1 + cos cosh) = kl (sin cosh - cos sinh), for k l/EI = ratio."""
        EI, mass = 12.0, 0.8
        model = ancf.Model()
        beam = model.add_beam(
            "beam",
            start=(0, 0, 0),
            end=(1, 0, 0),
            elements=12,
            section=ancf.Section(EA=1e7, EI=EI, rhoA=mass),
        )
        model.pin(beam.start)
        model.hold(beam.start, slope="y")
        model.add_torsion_spring(beam.start, (0, 0, 0), axis=(0, 1, 0), stiffness=ratio * EI)

        def characteristic(b):
            return ratio * (1 + np.cos(b) * np.cosh(b)) - b * (
                np.sin(b) * np.cosh(b) - np.cos(b) * np.sinh(b)
            )

        found = np.array(ancf.modes(model, count=5).frequencies_hz)
        for low, high in ((0.3, 2.2), (3.2, 4.9)):
            b = brentq(characteristic, low, high)
            wanted = b**2 * np.sqrt(EI / mass) / (2 * np.pi)
            assert np.min(np.abs(found / wanted - 1)) < 1e-3


class TestGiven:
    def model(self):
        model = ancf.Model()
        rope = ancf.Section(EA=1e4, EI=1.0, rhoA=1.0)
        model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=rope)
        model.add_beam("other", start=(1, 0, 0), end=(2, 0, 0), elements=2, section=rope)
        model.add_rigid_body("hub", at=(1, 0, 0), mass=1.0, inertia=(1, 1, 1))
        model.add_point_mass("bob", at=(1, 0, 0), mass=1.0)
        return model

    @pytest.mark.parametrize(
        ("ends", "change", "what"),
        [
            (("rope.end", "other.start"), {}, "are of two cables, which have no axes"),
            (("rope.end", (1, 0, 0)), {"axis": (1, 0, 0)}, "is along the tangent of"),
            (("bob", (1, 0, 0)), {}, "is a point mass and has no orientation"),
            (("hub", "hub.at(1, 0, 0)"), {}, "are points of one rigid body"),
            (("hub", (0, 0, 0)), {"axis": (0, 0, 0)}, "axis"),
            (("hub", (0, 0, 0)), {"stiffness": 0.0}, "stiffness and damping are both 0"),
            (("hub", (0, 0, 0)), {"stiffness": -1.0}, "must be >= 0"),
            (("hub", (0, 0, 0)), {"angle": float("nan")}, "angle"),
            (("rope.at(0.3)", (0, 0, 0)), {}, "is not at a node"),
        ],
    )
    def test_what_does_not_fit(self, ends, change, what):
        given = {"axis": (0, 1, 0), "stiffness": 1.0} | change
        with pytest.raises(ancf.ModelError, match=what):
            self.model().add_torsion_spring(*ends, **given)

    def test_nobody_of_that_name(self):
        model, _, _ = wheel(SPACES["straight"], stiffness=1.0)
        with pytest.raises(ancf.ModelError, match="torsion spring"):
            ancf.equilibrium(model).torsion_angle("string")
