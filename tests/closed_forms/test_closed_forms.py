"""Closed forms of statics and vibration.

Discretisation errors fall with the fourth power of the element length (checked in test_orders): the
meshes here make them smaller than the bars, which are stated with each test.
"""

from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq, root

import ancf
from ancf.elements.registry import ELEMENTS
from ancf.model.elements import KINDS
from helpers import SOLIDS, VARIANTS, square

LENGTH = 2.0


def beam_model(elements=16, *, EA=1e5, EI=3.0, rhoA=0.6, gravity=(0, 0, 0), end=(LENGTH, 0, 0), **more):
    """A cable, or another element, from the origin along x; keywords that a Section has go there."""
    damping = {k: more.pop(k) for k in ("damping", "axial_damping", "bending_damping", "nu") if k in more}
    model = ancf.Model(gravity=gravity)
    section = square(more.get("element", "cable"), EA=EA, EI=EI, rhoA=rhoA, **{"nu": 0.0, **damping})
    return model, model.add_beam("beam", start=(0, 0, 0), end=end, elements=elements, section=section, **more)


class TestBending:
    """Cantilevers; small deflections are linear up to (w/L)^2 = 1e-8."""

    SMALL = 2e-4  # N, for a deflection of about 1e-4 L

    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
    def test_tip_force(self, strain):
        """Cubic elements give nodal values of the linear beam exactly."""
        model, beam = beam_model(2, strain=strain)
        model.clamp(beam.start)
        model.add_force(beam.end, (0, 0.6 * self.SMALL, -0.8 * self.SMALL))
        state = ancf.equilibrium(model)
        w = self.SMALL * LENGTH**3 / (3 * 3.0)
        assert state.position(beam.end)[1:] == pytest.approx([0.6 * w, -0.8 * w], rel=1e-6)
        for x in (0.0, 0.7, 1.6):
            moment = self.SMALL * (LENGTH - x)
            assert state.bending_moment(beam.at(x)) == pytest.approx(moment, rel=1e-6)
            assert state.curvature(beam.at(x)) == pytest.approx(moment / 3.0, rel=1e-6)

    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
    def test_distributed_load_on_a_part(self, strain):
        """Load p from a to b: w(L) = p/(6 EI) int x^2 (3 L - x) dx."""
        a, b, p = 0.35, 1.3, 3e-4
        model, beam = beam_model(4, strain=strain)
        model.clamp(beam.start)
        model.add_distributed_load(beam, (0, 0, p), between=(a, b))
        w = p / (6 * 3.0) * (LENGTH * (b**3 - a**3) - (b**4 - a**4) / 4)
        assert ancf.equilibrium(model).position(beam.end)[2] == pytest.approx(w, rel=1e-6)

    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
    def test_moment_inside_an_element(self, strain):
        """Moment M at a: w(L) = M a (L - a/2)/EI, and the rotation there is M a/EI."""
        a, M = 0.8, 3e-4
        model, beam = beam_model(5, strain=strain)
        model.clamp(beam.start)
        model.add_moment(beam.at(a), (0, -M, 0))  # lifts the tip
        state = ancf.equilibrium(model)
        assert state.position(beam.end)[2] == pytest.approx(M * a * (LENGTH - a / 2) / 3.0, rel=1e-6)
        assert state.slope(beam.end)[2] == pytest.approx(M * a / 3.0, rel=1e-6)

    def test_simply_supported_under_gravity(self):
        """w(L/2) = 5 p L^4/(384 EI); one end slides."""
        model, beam = beam_model(8, rhoA=1e-4, gravity=(0, 0, -9.81))
        model.pin(beam.start)
        model.hold(beam.end, position="yz")
        p = 9.81e-4
        w = 5 * p * LENGTH**4 / (384 * 3.0)
        assert ancf.equilibrium(model).position(beam.at(1.0))[2] == pytest.approx(-w, rel=1e-6)

    @pytest.mark.parametrize("share", [0.25, 0.5, 1.0, 2.0])
    def test_roll_up(self, share):
        """An end moment M bends to a circle of radius EI/M without stretching the centreline."""
        M = 2 * np.pi * share * 3.0 / LENGTH
        model, beam = beam_model(64)
        model.clamp(beam.start)
        model.add_moment(beam.end, (0, -M, 0))
        state = ancf.equilibrium(model, load_steps=16)
        for x in (0.3, 1.1, LENGTH):
            radius, angle = 3.0 / M, M * x / 3.0
            wanted = (radius * np.sin(angle), 0, radius * (1 - np.cos(angle)))
            assert state.position(beam.at(x)) == pytest.approx(wanted, abs=2e-5)
            assert state.curvature(beam.at(x)) == pytest.approx(1 / radius, rel=5e-3)  # order 2
        assert state.tension(beam.at(1.0)) == pytest.approx(0, abs=1e-3)

    def test_moment_about_any_axis(self):
        """The roll-up in a plane through x, not along the axes."""
        axis = np.array([0.0, -0.6, 0.8])
        model, beam = beam_model(32)
        model.clamp(beam.start)
        model.add_moment(beam.end, axis * np.pi * 3.0 / LENGTH)
        tip = ancf.equilibrium(model, load_steps=8).position(beam.end)
        side = np.cross(axis, (1, 0, 0))
        assert tip == pytest.approx(2 * LENGTH / np.pi * side, abs=1e-4)

    def test_release_of_a_bent_beam(self):
        """A straight beam bent into an arc has the moment EI/R and springs back straight."""
        R = 1.5
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=3.0, rhoA=0.6)
        beam = model.add_beam(
            "beam",
            path=lambda u: (R * np.sin(u), 0, R * (1 - np.cos(u))),
            elements=16,
            section=section,
            natural_shape="straight",
        )
        model.clamp(beam.start)
        start = ancf.simulate(model, t_end=1e-5, step=1e-5).state(0)
        assert start.bending_moment(beam.at(0.7)) == pytest.approx(3.0 / R, rel=5e-4)
        energy = 0.5 * 3.0 / R**2 * beam.length
        assert start.energy.strain == pytest.approx(energy, rel=5e-4)  # curvature of a cubic: order 2
        assert ancf.equilibrium(model).position(beam.end) == pytest.approx((beam.length, 0, 0), abs=1e-9)


class TestAxial:
    def test_bar_under_its_weight(self):
        """Hanging bar: eps(x) = w (L - x)/EA, elongation w L^2/(2 EA)."""
        model, beam = beam_model(4, EA=500.0, gravity=(0, 0, -9.81), end=(0, 0, -LENGTH))
        model.pin(beam.start)
        state = ancf.equilibrium(model)
        w = 0.6 * 9.81
        assert state.position(beam.end)[2] == pytest.approx(-LENGTH - w * LENGTH**2 / (2 * 500.0), abs=1e-10)
        for x in (0.2, 1.0, 1.7):
            assert state.tension(beam.at(x)) == pytest.approx(w * (LENGTH - x), rel=1e-8)
            assert state.strain(beam.at(x)) == pytest.approx(w * (LENGTH - x) / 500.0, rel=1e-8)

    def test_green_strain(self):
        """Paper strains under a force: EA (s^2 - 1)/2 s = F for the stretch s."""
        model, beam = beam_model(3, EA=50.0, strain="paper")
        model.pin(beam.start)
        model.add_force(beam.end, (20.0, 0, 0))
        state = ancf.equilibrium(model)
        s = brentq(lambda s: 50.0 * (s * s - 1) / 2 * s - 20.0, 1, 2)
        assert state.position(beam.end)[0] == pytest.approx(s * LENGTH, rel=1e-10)
        assert state.tension(beam.at(0.9)) == pytest.approx(20.0, rel=1e-9)
        assert state.strain(beam.at(0.9)) == pytest.approx((s * s - 1) / 2, rel=1e-9)

    def test_pretension(self):
        """A cable shorter than the distance of its supports is pulled tight: EA (distance/length - 1)."""
        model, beam = beam_model(3, length=1.9)
        model.pin(beam.start)
        model.pin(beam.end)
        state = ancf.equilibrium(model)
        assert state.tension(beam.at(1.0)) == pytest.approx(1e5 * (LENGTH / 1.9 - 1), rel=1e-12)

    def test_vibration(self):
        """Clamped-free bar: omega_n = (n - 1/2) pi/L sqrt(EA/rhoA)."""
        model, beam = beam_model(16)
        model.clamp(beam.start)
        for x in beam.node_x[1:]:
            model.hold(beam.at(x), position="yz", slope="yz")
        wanted = (np.arange(1, 5) - 0.5) * np.pi / LENGTH * np.sqrt(1e5 / 0.6)
        assert ancf.modes(model, count=4).frequencies == pytest.approx(wanted, rel=2e-6)


class TestSprings:
    def test_static_extension(self):
        """A weight on a spring, taken up by a spring of half a newton per millimetre."""
        model, beam = beam_model(2, gravity=(0, 0, -9.81), end=(0, 0, -LENGTH))
        model.add_spring(beam.start, (0, 0, 1.0), stiffness=500.0)
        model.hold(beam.start, position="xy", slope="xy")
        weight = 0.6 * LENGTH * 9.81
        state = ancf.equilibrium(model)
        assert state.position(beam.start)[2] == pytest.approx(-weight / 500.0, abs=1e-10)

    def test_oscillation(self):
        """A stiff bar on a spring moves as a mass: omega = sqrt(k/(rhoA L)) up to k L/EA."""
        model, beam = beam_model(1, EA=1e9, EI=1e6)
        for point in (beam.start, beam.end):
            model.hold(point, position="yz", slope="yz")
        model.add_spring(beam.start, (-0.5, 0, 0), stiffness=40.0)
        mode = ancf.modes(model, count=1)
        assert mode.frequencies[0] == pytest.approx(np.sqrt(40.0 / (0.6 * LENGTH)), rel=1e-7)
        modal_mass = mode.position(beam.start)[0, 0]
        assert abs(modal_mass) == pytest.approx(1 / np.sqrt(0.6 * LENGTH), rel=1e-6)

    def test_damped_oscillation(self):
        """The same bar with a damper: u = exp(-z w t) (cos w_d t + z w/w_d sin w_d t)."""
        model, beam = beam_model(1, EA=1e7, EI=1e4)
        for point in (beam.start, beam.end):
            model.hold(point, position="yz", slope="yz")
        model.add_spring(beam.start, (-0.5, 0, 0), stiffness=40.0, damping=3.0, length=0.4)
        m, t_end = 0.6 * LENGTH, 2.0
        result = ancf.simulate(model, t_end=t_end, step=1e-3, integrator=ancf.GeneralizedAlpha(rho_inf=0.5))
        w = np.sqrt(40.0 / m)
        zw = 3.0 / (2 * m)
        wd = np.sqrt(w**2 - zw**2)
        u = 0.1 * np.exp(-zw * result.t) * (np.cos(wd * result.t) + zw / wd * np.sin(wd * result.t))
        assert result.position(beam.end)[:, 0] - (LENGTH - 0.1) == pytest.approx(u, abs=2e-6)

    @pytest.mark.parametrize("slack", [True, False])
    def test_slack_spring_does_not_push(self, slack):
        """A bar moves towards the end of its spring: a rope goes slack, a spring turns it back."""
        model, beam = beam_model(1)
        beam.set_motion(velocity=(1.0, 0, 0))
        model.add_spring(beam.end, (LENGTH + 1.0, 0, 0), stiffness=40.0, length=1.0, slack=slack)
        result = ancf.simulate(model, t_end=0.5, step=1e-3)
        straight_on = LENGTH + result.t
        if slack:
            assert result.position(beam.end)[:, 0] == pytest.approx(straight_on, abs=1e-12)
        else:
            assert result.position(beam.end)[-1, 0] < straight_on[-1] - 0.1


class TestCatenary:
    """Elastic catenary of Irvine: x(s) and z(s) from the end forces, found by root finding."""

    @staticmethod
    def elastic_catenary(span, drop, length, w, EA):
        """End force (H, V) at the first support and the position at arc length s."""

        def at(s, H, V):
            x = H * s / EA + H / w * (np.arcsinh(V / H) - np.arcsinh((V - w * s) / H))
            z = -(V * s - w * s**2 / 2) / EA - (np.hypot(H, V) - np.hypot(H, V - w * s)) / w
            return np.array([x, z])

        guess = (w * span / np.sqrt(24 * max(length / np.hypot(span, drop) - 1, 1e-4)), w * length / 2)
        found = root(lambda f: at(length, *f) - (span, -drop), guess, tol=1e-12)
        assert at(length, *found.x) == pytest.approx((span, -drop), abs=1e-10)
        return found.x, lambda s: at(s, *found.x)

    @pytest.mark.parametrize(("length", "drop"), [(10.5, 0.0), (12.0, 3.0), (10.0, 0.0)])
    def test_hangs_as_the_catenary(self, length, drop):
        """EI is so small that it shows within a few centimetres of the supports only."""
        span, EA, rhoA = 10.0, 2e4, 0.5
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=EA, EI=1e-6, rhoA=rhoA)
        cable = model.add_beam(
            "cable", start=(0, 0, 0), end=(span, 0, -drop), elements=80, section=section, length=length
        )
        model.pin(cable.start)
        model.pin(cable.end)
        state = ancf.equilibrium(model)
        (H, V), at = self.elastic_catenary(span, drop, length, rhoA * 9.81, EA)
        for s in (0.2 * length, 0.5 * length, 0.85 * length):
            assert state.position(cable.at(s))[[0, 2]] == pytest.approx(at(s), abs=5e-6)
            tension = np.hypot(H, V - rhoA * 9.81 * s)
            assert state.tension(cable.at(s)) == pytest.approx(tension, rel=3e-4)


class TestVibration:
    def test_string(self):
        """A taut string: omega_n = n pi/L sqrt(T/rhoA) for EI -> 0, within the bending term."""
        T, L = 1e5 * 0.01, LENGTH
        model, beam = beam_model(16, EI=1e-4, length=L / 1.01)
        model.pin(beam.start)
        model.pin(beam.end)
        natural = L / 1.01
        n = np.repeat(np.arange(1, 4), 2)
        k = n * np.pi / natural  # waves in the material coordinate: tension T, stretch 1.01
        wanted = k * np.sqrt(T / 1.01 / 0.6)
        assert ancf.modes(model, count=6).frequencies == pytest.approx(wanted, rel=1e-5)

    def test_beam_under_tension(self):
        """Material strains, stretch s: omega^2 = k^2 (T/s + EI k^2/s^2)/rhoA."""
        s = 1.02
        model, beam = beam_model(24, EI=3.0, length=LENGTH / s)
        model.pin(beam.start)
        model.pin(beam.end)
        k = np.repeat(np.arange(1, 4), 2) * np.pi * s / LENGTH
        wanted = k * np.sqrt((1e5 * (s - 1) / s + 3.0 * k**2 / s**2) / 0.6)
        assert ancf.modes(model, count=6).frequencies == pytest.approx(wanted, rel=1e-5)

    def test_shapes_are_sines(self):
        model, beam = beam_model(16)
        model.pin(beam.start)
        model.pin(beam.end)
        modes = ancf.modes(model, count=4)
        x = np.linspace(0, LENGTH, 9)
        shape = np.array([np.linalg.norm(modes.position(beam.at(s)), axis=1) for s in x])
        for mode in range(4):
            wave = np.abs(np.sin((mode // 2 + 1) * np.pi * x / LENGTH))
            # modal mass 1 kg: amplitude sqrt(2/(rhoA L))
            assert shape[:, mode] == pytest.approx(np.sqrt(2 / (0.6 * LENGTH)) * wave, abs=1e-4)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_free_beam_has_rigid_modes(self, element):
        """3 translations and 3 rotations, the spin too; then bending in both planes and torsion."""
        model, _ = beam_model(32, element=element, nu=0.3)
        frequencies = ancf.modes(model, count=8).frequencies
        bending = 4.730040744862704**2 / LENGTH**2 * np.sqrt(3.0 / 0.6)
        assert np.max(frequencies[:6]) < 1e-2 * bending
        # 100 times longer than thick: shear takes 1e-3 off, the original element's stiffness adds to it
        assert frequencies[6:] == pytest.approx(bending, rel=2e-3 if element == "nonlocking" else 0.1)

    def test_free_cable_has_rigid_modes(self):
        """Straight and free: 3 translations and 2 rotations without frequency, the spin has no mass."""
        model, _ = beam_model(8)
        frequencies = ancf.modes(model, count=6).frequencies
        beam = 4.730040744862704**2 / LENGTH**2 * np.sqrt(3.0 / 0.6)
        assert np.max(frequencies[:5]) < 1e-2 * beam
        assert frequencies[5] == pytest.approx(beam, rel=1e-4)

    @pytest.mark.parametrize(("elements", "EA"), [(1, 1e3), (6, 1e9), (120, 1e5)])
    def test_neutral_motions_for_any_count(self, elements, EA):
        """Free, or pinned at one end: rigid motions have no frequency, however many modes are asked for."""
        bending = np.sqrt(3.0 / 0.6) / LENGTH**2
        for pinned, neutral, first in ((False, 5, 4.730040744862704), (True, 2, 3.9266023120479185)):
            model, beam = beam_model(elements, EA=EA)
            if pinned:
                model.pin(beam.start)
            for count in (1, 2, 3, neutral, neutral + 1):
                found = ancf.modes(model, count=count).frequencies / bending
                assert np.all(found[:neutral] < 1e-2)
                if elements > 1:
                    assert found[neutral:] == pytest.approx(first**2, rel=1e-3)

    @pytest.mark.parametrize(("elements", "E"), [(1, 2e11), (8, 1e6), (30, 1e9)])
    @pytest.mark.parametrize("element", SOLIDS)
    def test_free_beam_for_any_count(self, element, elements, E):
        """Its six rigid motions, from the soft to the very stiff, also far from the origin."""
        section = ancf.Section.rectangle(0.01, 0.02, E=E, rho=1000.0, nu=0.3)
        for x in (0.0, 300.0):
            model = ancf.Model()
            ends = {"start": (x, 0, 0), "end": (x + 1, 0, 0)}
            model.add_beam("beam", elements=elements, section=section, element=element, **ends)
            bending = 22.4 * np.sqrt(section.EI_z / section.rhoA)
            for count in (1, 2, 4, 6, 7):
                frequencies = ancf.modes(model, count=count).frequencies
                assert np.all(frequencies[:6] < 1e-2 * bending)
                assert np.all(frequencies[6:] > 0.5 * bending)

    @pytest.mark.parametrize(("elements", "EA", "length"), [(4, 1e6, 1.0), (17, 1e9, 0.1), (120, 1e7, 50.0)])
    def test_column_about_its_buckling_load(self, elements, EA, length):
        """omega_1^2 falls with 1 - P/P_cr; past it a column is refused, whatever the count and the load."""
        EI, EA = 3.0, EA * 3.0 / length**2
        for share, count in ((0.9, 1), (0.98, 3), (1.02, 1), (1.02, 3), (2.0, 1), (30.0, 2)):
            P = share * np.pi**2 * EI / length**2
            model = ancf.Model()
            ends = {"start": (0, 0, 0), "end": (length, 0, 0), "length": length / (1 - P / EA)}
            section = ancf.Section(EA=EA, EI=EI, rhoA=0.6)
            beam = model.add_beam("column", elements=elements, section=section, **ends)
            model.pin(beam.start)
            model.pin(beam.end)
            if share > 1.0:
                with pytest.raises(ancf.SolveError, match="not a stable equilibrium"):
                    ancf.modes(model, count=count)
            else:
                omega = (np.pi / length) ** 2 * np.sqrt(EI / 0.6 * (1 - share))
                assert ancf.modes(model, count=count).frequencies[0] == pytest.approx(omega, rel=0.02)

    def test_sparse_and_dense_modes_agree(self):
        """The eigensolver changes with the number of unknowns; frequencies do not but for h^4."""
        found = []
        for elements in (40, 80):
            model, beam = beam_model(elements)
            model.clamp(beam.start)
            found.append(ancf.modes(model, count=6).frequencies)
        assert found[1] == pytest.approx(found[0], rel=1e-6)


class TestDynamics:
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_free_fall(self, element):
        """The trapezoidal rule is exact for constant acceleration."""
        model, beam = beam_model(3, gravity=(1.0, 0, -9.81), element=element)
        beam.set_motion(velocity=(0.5, 2.0, 1.0))
        result = ancf.simulate(model, t_end=0.5, step=0.01)
        t = result.t[:, None]
        wanted = (LENGTH, 0, 0) + t * (0.5, 2.0, 1.0) + t**2 / 2 * (1.0, 0, -9.81)
        assert result.position(beam.end) == pytest.approx(wanted, abs=1e-10)
        assert result.velocity(beam.at(0.3)) == pytest.approx((0.5, 2, 1) + t * (1, 0, -9.81), abs=1e-9)

    @staticmethod
    def ring(model, beam, mode, t_end, cycles=200):
        """Run from a small amplitude in a mode; modal coordinate and time."""
        modes = ancf.modes(model, count=mode + 1)
        rest, shape, omega = modes.about, modes.shapes[mode], modes.frequencies[mode]
        start = ancf.State(rest.system, 0.0, rest.q + 1e-5 * shape, 0 * rest.q)
        method = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14, modified=False))
        step = 2 * np.pi / omega / cycles
        result = ancf.simulate(model, t_end=t_end / omega, step=step, start=start, integrator=method)
        return (result.q - rest.q) @ shape / (1e-5 * shape @ shape), result.t, omega

    @staticmethod
    def simply_support(model, beam):
        """Pins; a beam's first mode is then bending if it does not spin."""
        model.pin(beam.start)
        model.pin(beam.end)
        if beam.element in SOLIDS:
            model.hold(beam.start, twist=True)

    def check_decay(self, model, beam, mode, zeta):
        """u = exp(-z w t) (cos w_d t + ...); the step's phase error is (w h)^2/12 w t."""
        u, t, w = self.ring(model, beam, mode, 12.0)
        wd = w * np.sqrt(1 - zeta**2)
        wanted = np.exp(-zeta * w * t) * (np.cos(wd * t) + zeta * w / wd * np.sin(wd * t))
        assert u == pytest.approx(wanted, abs=2e-3)
        assert np.abs(u[-1] - np.cos(w * t[-1])) > 0.05  # the damping is seen

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_external_damping(self, element):
        """Viscous force c per length: zeta = c/(2 rhoA omega)."""
        elements = 32 if element == "original" else 8  # so many keep it from locking
        model, beam = beam_model(elements, damping=0.5, element=element)
        self.simply_support(model, beam)
        w = (np.pi / LENGTH) ** 2 * np.sqrt(3.0 / 0.6)
        self.check_decay(model, beam, 0, 0.5 / (2 * 0.6 * w))

    @pytest.mark.parametrize("variant", VARIANTS)
    def test_bending_damping(self, variant):
        """Kelvin-Voigt: zeta = D_b/(2 EI) omega."""
        given = VARIANTS[variant]
        elements = 32 if given["element"] == "original" else 8
        model, beam = beam_model(elements, bending_damping=0.05, **given)
        self.simply_support(model, beam)
        w = (np.pi / LENGTH) ** 2 * np.sqrt(3.0 / 0.6)
        self.check_decay(model, beam, 0, 0.05 / (2 * 3.0) * w)

    @pytest.mark.parametrize("variant", VARIANTS)
    def test_axial_damping(self, variant):
        """Kelvin-Voigt: zeta = D_a/(2 EA) omega."""
        model, beam = beam_model(8, axial_damping=10.0, **VARIANTS[variant])
        model.clamp(beam.start)
        for x in beam.node_x[1:]:
            sections = {"slope_y": "xz", "slope_z": "xy"} if beam.element in SOLIDS else {}
            model.hold(beam.at(x), position="yz", slope="yz", **sections)
        w = 0.5 * np.pi / LENGTH * np.sqrt(1e5 / 0.6)
        self.check_decay(model, beam, 0, 10.0 / (2 * 1e5) * w)

    def test_damped_forces_are_recovered(self):
        """Tension EA eps + D_a d(eps)/dt and moment EI kappa + D_b d(kappa)/dt from a state."""
        model, beam = beam_model(2, EA=100.0, axial_damping=7.0, bending_damping=0.4)
        system = ancf.simulate(model, t_end=1e-3, step=1e-3).state(0).system
        q, v = system.initial_state()
        x = np.linspace(0, LENGTH, 3)
        curve, growth = 0.3, 0.2  # z = c x^2/2: kappa = c at x = 0, where the slope is zero
        r, s = system.slots["beam"].T
        q[r + 2], q[s + 2] = curve * x**2 / 2, curve * x
        v[r + 2], v[s + 2] = growth * x**2 / 2, growth * x
        state = ancf.State(system, 0.0, q, v)
        assert state.bending_moment(beam.start) == pytest.approx(3.0 * curve + 0.4 * growth, rel=1e-6)
        q, v = system.initial_state()
        q[r] *= 1.1
        q[s] *= 1.1
        v[r], v[s] = 0.5 * x, 0.5
        state = ancf.State(system, 0.0, q, v)
        assert state.tension(beam.at(0.7)) == pytest.approx(100.0 * 0.1 + 7.0 * 0.5, rel=1e-12)


class TestVirtualWork:
    """Loads inside elements: nodal forces times nodal displacements are the work at the point."""

    @staticmethod
    def nodal(load, element):
        model, beam = beam_model(3, element=element)
        load(model, beam)
        system = ancf.simulate(model, t_end=1e-3, step=1e-3).state(0).system
        f = np.zeros(system.size)
        for (slots, factors), amplitude in zip(system.patterns, system.inputs.loads, strict=True):
            for slot, factor in zip(slots, factors, strict=True):
                f[slot : slot + 3] += factor * amplitude(0.0)
        shake = np.random.default_rng(4).standard_normal(system.size)
        return f @ shake, ancf.State(system, 0.0, shake, 0 * shake), beam

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_force(self, element):
        F, place = np.array([1.0, -2.0, 3.0]), (0.9, 0.004, -0.006) if element in SOLIDS else (0.9,)
        work, shake, beam = self.nodal(lambda m, b: m.add_force(b.at(*place), F), element)
        assert work == pytest.approx(F @ shake.position(beam.at(*place)), rel=1e-12)

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_distributed(self, element):
        p = np.array([1.0, -2.0, 3.0])
        work, shake, beam = self.nodal(lambda m, b: m.add_distributed_load(b, p, between=(0.3, 1.7)), element)
        ends = np.unique([0.3, *beam.node_x[1:-1], 1.7])
        x, w = np.polynomial.legendre.leggauss(4)
        total = 0.0
        for a, b in pairwise(ends):
            for xi, wi in zip(x, w, strict=True):
                total += wi * (b - a) / 2 * p @ shake.position(beam.at((a + b) / 2 + (b - a) / 2 * xi))
        assert work == pytest.approx(total, rel=1e-12)

    def test_point_load_moves_the_right_point(self):
        """Statics: pulled in the middle of an element, a taut string has its corner near there."""
        model, beam = beam_model(20, EI=1e-6, EA=1e4, length=1.98)
        model.pin(beam.start)
        model.pin(beam.end)
        model.add_force(beam.at(0.5), (0, 0, 1e-3))
        T, natural = 1e4 * (LENGTH / 1.98 - 1), 1.98
        at, there = 0.5 * LENGTH / natural, 1.2 * LENGTH / natural
        w = 1e-3 * at * (LENGTH - there) / (T * LENGTH)
        assert ancf.equilibrium(model).position(beam.at(1.2))[2] == pytest.approx(w, rel=1e-4)
