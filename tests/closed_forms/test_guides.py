"""Cylindrical, prismatic and planar joints: what slides and turns as its equation says."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ancf

G = 9.81
SPACES = {"straight": Rotation.identity(), "turned": Rotation.from_euler("xyz", (0.5, -0.9, 2.0))}
METHODS = [ancf.Trapezoidal(), ancf.GeneralizedAlpha(rho_inf=0.9)]
INERTIA = (0.2, 0.3, 0.4)


def pair(space: Rotation, gravity=(0, 0, 0), at=(0.3, 0.0, 0.0)):
    """A free body, and its directions in space; what is given is turned."""
    model = ancf.Model(gravity=space.apply(gravity))
    body = model.add_rigid_body("body", at=space.apply(at), mass=2.0, inertia=INERTIA, axes=space.as_matrix())
    return model, body


@pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
@pytest.mark.parametrize("method", METHODS, ids=["trapezoidal", "alpha"])
class TestOnTheGround:
    @pytest.mark.parametrize("slope", [0.2, 1.2])
    def test_slides_down_a_rod_and_spins(self, space, method, slope):
        """x = x0 + g sin(slope) t^2/2; the spin about the axis stays."""
        gravity = (G * np.sin(slope), 0, -G * np.cos(slope))
        model, body = pair(space, gravity)
        body.set_motion(angular_velocity=space.apply((3.0, 0, 0)))
        model.cylindrical(body, space.apply((1.0, 0, 0)), axis=space.apply((2.0, 0, 0)))
        result = ancf.simulate(model, t_end=0.5, step=2e-3, integrator=method)
        x = 0.3 + 0.5 * G * np.sin(slope) * result.t**2
        expected = space.apply(np.stack([x, 0 * x, 0 * x], axis=1))
        np.testing.assert_allclose(result.position(body), expected, atol=1e-9)
        spin = space.inv().apply(result.angular_velocity(body))
        np.testing.assert_allclose(spin, np.tile((3.0, 0, 0), (len(result.t), 1)), atol=2e-5)

    def test_does_not_turn_on_a_prismatic_joint(self, space, method):
        """A torque about the axis and a weight across it are carried; along it the spring decides."""
        model, body = pair(space, (0, 0, -G))
        model.prismatic(body, space.apply((0, 0, 0)), axis=space.apply((1, 0, 0)), name="rail")
        model.add_moment(body, space.apply((0.7, 0.2, -0.3)))
        model.add_spring(body, space.apply((0, 0, 0)), stiffness=50.0, length=0.2)
        result = ancf.simulate(model, t_end=1.0, step=1e-3, integrator=method)
        x = 0.2 + 0.1 * np.cos(np.sqrt(50.0 / 2.0) * result.t)
        expected = space.apply(np.stack([x, 0 * x, 0 * x], axis=1))
        np.testing.assert_allclose(result.position(body), expected, atol=1e-5)
        arm = space.inv().apply(result.position(body.at(0, 0.1, 0.2)) - result.position(body))
        np.testing.assert_allclose(arm, np.tile((0, 0.1, 0.2), (len(arm), 1)), atol=1e-8)

    def test_slides_and_spins_in_a_plane(self, space, method):
        """On a slope a thrown body follows a parabola in the plane and keeps its spin about the normal."""
        model, body = pair(space, (2.0, -1.0, -G))
        body.set_motion(velocity=space.apply((0.5, 1.5, 0)), angular_velocity=space.apply((0, 0, -2.0)))
        model.planar(body, space.apply((0.9, -0.4, 0)), axis=space.apply((0, 0, 1)))
        result = ancf.simulate(model, t_end=0.5, step=2e-3, integrator=method)
        t = result.t
        expected = np.stack([0.3 + 0.5 * t + t**2, 1.5 * t - 0.5 * t**2, 0 * t], axis=1)
        np.testing.assert_allclose(result.position(body), space.apply(expected), atol=1e-9)
        spin = space.inv().apply(result.angular_velocity(body))[:, 2]
        np.testing.assert_allclose(spin, -2.0, atol=2e-5)


class TestBetweenBodies:
    @pytest.mark.parametrize("swapped", [False, True])
    @pytest.mark.parametrize("omega", [1.5, 4.0])
    def test_a_slider_on_a_turning_arm(self, omega, swapped):
        """r = r0 cosh(omega t) on an arm that turns at a given speed."""
        model = ancf.Model()
        arm = model.add_rigid_body("arm", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
        slider = model.add_rigid_body("slider", at=(0.1, 0, 0), mass=0.5, inertia=(0.01, 0.01, 0.01))
        slider.set_motion(angular_velocity=(0, 0, omega), about=(0, 0, 0))
        model.clamp(arm, rotation=f"{omega}*t")
        ends = (slider, arm) if swapped else (arm, slider)
        model.prismatic(*ends, axis=(1, 0, 0))
        result = ancf.simulate(model, t_end=0.6, step=1e-3)
        r = np.linalg.norm(result.position(slider), axis=1)
        np.testing.assert_allclose(r, 0.1 * np.cosh(omega * result.t), rtol=2e-5)

    @pytest.mark.parametrize("kind", ["cylindrical", "prismatic", "planar"])
    def test_what_is_free_keeps_its_momenta_and_energy(self, kind):
        model = ancf.Model()
        one = model.add_rigid_body("one", at=(0, 0, 0), mass=1.0, inertia=(0.1, 0.2, 0.25))
        two = model.add_rigid_body("two", at=(0.5, 0, 0), mass=3.0, inertia=(0.3, 0.2, 0.4))
        axis = (0, 0, 1) if kind == "planar" else (1, 0, 0)
        getattr(model, kind)(one.at(0.1, 0, 0), two.at(-0.2, 0, 0), axis=axis)
        one.set_motion(velocity=(0.3, 0, 0), angular_velocity=(0.5, 0.2, 1.0), about=(0.1, 0, 0))
        two.set_motion(velocity=(0.3, 0, 0), angular_velocity=(0.5, 0.2, 1.0), about=(0.1, 0, 0))
        model.add_spring(one, two, stiffness=20.0, length=0.3)
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        for momentum in (result.momentum, result.angular_momentum((0, 0, 0))):
            assert np.abs(momentum - momentum[0]).max() < 2e-5 * np.abs(momentum).max()
        assert np.ptp(np.linalg.norm(result.position(one) - result.position(two), axis=1)) > 0.05
        assert abs(result.energy.drift).max() < 1e-5 * result.energy.kinetic[0]

    @pytest.mark.parametrize("element", ["original", "nonlocking"])
    def test_the_end_of_a_beam_on_a_plane(self, element):
        """A beam built in at one end, a plane that keeps the direction of the other: F l^3/(12 E I)."""
        section = ancf.Section.rectangle(width=0.02, height=0.02, E=1e9, rho=1000.0)
        model = ancf.Model()
        elements = 32 if element == "original" else 8
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section, element=element
        )
        model.clamp(beam.start)
        model.planar(beam.end, (1, 0.2, 0.3), axis=(1, 0, 0))
        model.add_force(beam.end, (0, 0, -0.01))
        deflection = ancf.equilibrium(model).position(beam.end)[2]
        bending = 0.01 / (12 * section.EI_y)
        shear = 0.01 / (section.E / 2 * section.EA / section.E)
        assert -deflection == pytest.approx(bending + shear, rel=6e-3 if element == "original" else 1e-3)


class TestGiven:
    @pytest.mark.parametrize(
        ("kind", "b", "axis", "what"),
        [
            ("cylindrical", (0.5, 0.1, 0), (1, 0, 0), "0.1 m off the axis"),
            ("prismatic", (0.5, 0, -0.2), (1, 0, 0), "0.2 m off the axis"),
            ("planar", (0.5, 0.3, 0.4), (0, 0, 1), "0.4 m off the plane"),
            ("planar", (0.5, 0.3, 0.4), (0, 0, 0), "axis"),
        ],
    )
    def test_what_does_not_fit(self, kind, b, axis, what):
        model, body = pair(Rotation.identity())
        with pytest.raises(ancf.ModelError, match=what):
            getattr(model, kind)(body, b, axis=axis)

    @pytest.mark.parametrize("kind", ["cylindrical", "prismatic", "planar"])
    def test_a_cable_and_a_mass_have_no_axes(self, kind):
        model = ancf.Model()
        bob = model.add_point_mass("bob", at=(0, 0, 0), mass=1.0)
        wire = model.add_beam(
            "wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1, EI=1, rhoA=1)
        )
        for point in (bob, wire.start):
            with pytest.raises(ancf.ModelError, match=r"no orientation|does not turn"):
                getattr(model, kind)(point, (0, 0, 0), axis=(1, 0, 0))
