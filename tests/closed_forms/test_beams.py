"""The two beams with cross-sections against closed forms: shear, torsion, Poisson's ratio, two planes.

Small deflections are linear up to their square, 1e-7 here.  Discrete values of an independent
implementation hold to round-off.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

import ancf
from ancf.paper import references
from helpers import SOLIDS, VARIANTS, square

REFERENCE = references.values()
SHORT = {"original": "orig", "nonlocking": "ho"}  # in the keys
SOLID_VARIANTS = [name for name in VARIANTS if VARIANTS[name]["element"] in SOLIDS]
LENGTH, E = 2.0, 1e9


def keys(start):
    return [(name, key) for name in SOLIDS for key in REFERENCE if key.startswith(f"{start}.{SHORT[name]}.")]


def beam_model(elements=8, *, width=0.02, height=0.02, nu=0.3, gravity=(0, 0, 0), end=(LENGTH, 0, 0), **more):
    """A beam from the origin along x with local y and z along the global ones."""
    extra = {k: more.pop(k) for k in ("shear_factors", "axial_damping", "bending_damping") if k in more}
    section = ancf.Section.rectangle(width, height, E=E, rho=1000.0, nu=nu, **extra)
    model = ancf.Model(gravity=gravity)
    return model, model.add_beam("beam", start=(0, 0, 0), end=end, elements=elements, section=section, **more)


def hold_section(model, point):
    """Hold place and section, not r_x: the beam shears at the wall, as in Timoshenko's theory."""
    model.hold(point, position="xyz", slope_y="xyz", slope_z="xyz")


class TestDiscreteValues:
    @pytest.mark.parametrize(("element", "key"), keys("elastica.moment1"))
    def test_roll_up(self, element, key):
        """An end moment 2 pi EI/L in one load step, within 1e-12 m; about z, hence on r_y."""
        model = ancf.Model()
        section = ancf.Section.rectangle(0.01, 0.01, E=1e8, rho=500.0)
        given = {"elements": int(key.split(".n")[-1]), "element": element, "poisson": "full"}
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), section=section, **given)
        model.clamp(beam.start, stretch="fixed")
        model.add_moment(beam.end, (0, 0, 2 * np.pi * section.EI_z))
        x, y, z = ancf.equilibrium(model).position(beam.end)
        assert (x, y) == pytest.approx(REFERENCE[key], rel=0, abs=1e-12)
        assert z == 0.0

    @pytest.mark.parametrize("element", SOLIDS)
    def test_roll_up_in_the_other_plane(self, element):
        model, beam = beam_model(16, element=element, nu=0.0)
        tips = []
        for k, moment in enumerate(((0, 0, 1.0), (0, -1.0, 0))):
            model.supports.clear()
            model.loads.clear()
            model.clamp(beam.start, name=f"wall {k}")
            model.add_moment(beam.end, 5.0 * np.array(moment), name=f"moment {k}")
            tips.append(ancf.equilibrium(model).position(beam.end))
        assert tips[0][1] > 0.5
        assert tips[1] == pytest.approx(tips[0][[0, 2, 1]], abs=1e-10)

    @pytest.mark.parametrize("nu", [0.0, 0.2, 0.4])
    @pytest.mark.parametrize("height", [0.01, 0.02])
    def test_ring_does_not_close(self, nu, height):
        """By (7/15 - nu/2) (kappa h)^2 L on any mesh: Green's strain of a section that stretches."""
        model, beam = beam_model(64, width=0.03, height=height, nu=nu, element="nonlocking", end=(1, 0, 0))
        model.clamp(beam.start)
        model.add_moment(beam.end, (0, -2 * np.pi * beam.section.EI_y, 0))
        gap = np.linalg.norm(ancf.equilibrium(model, load_steps=16).position(beam.end))
        assert gap == pytest.approx((7 / 15 - nu / 2) * (2 * np.pi * height) ** 2, rel=0.015)

    def test_limit_of_the_roll_up(self):
        fine = REFERENCE["elastica.moment1.ho.n64"]
        assert fine == pytest.approx(REFERENCE["elastica.moment1.exact.solid3d"], abs=2e-6)

    @pytest.mark.parametrize(("element", "key"), keys("linear.beam"))
    def test_frequencies(self, element, key):
        """Of bending, each in two planes.

        Round-off of an eigensolver is 1e-16 of the highest eigenvalue, 1e9 times the lowest one.
        """
        model = ancf.Model()
        section = ancf.Section.rectangle(0.01, 0.01, E=2.1e11, rho=7850.0)
        given = {"elements": int(key.split(".n")[-1]), "element": element, "poisson": "full"}
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), section=section, **given)
        if ".cantilever." in key:
            model.clamp(beam.start, stretch="fixed")
        else:
            model.pin(beam.start)
            model.pin(beam.end)
        found = ancf.modes(model, count=7).frequencies
        bending = found[found > 1.0]  # simply supported, it may also spin
        assert bending[:6] == pytest.approx(np.repeat(REFERENCE[key], 2), rel=5e-7)


class TestBending:
    @pytest.mark.parametrize("variant", SOLID_VARIANTS)
    def test_each_plane_has_its_own_stiffness(self, variant):
        """w = F L^3/(3 E I) + F L/(k G A); with the coupling in the whole volume E too large by 1.346."""
        given, F, nu = VARIANTS[variant], 1e-3, 0.3
        # r_y is linear in the original element: many are needed, and what is left falls with order 2
        elements, bar = (128, 2e-3) if given["element"] == "original" else (4, 1e-6)
        k_y, k_z = 5 / 6, 0.7
        sides = {"width": 0.2, "height": 0.4, "shear_factors": (k_y, k_z)}
        model, beam = beam_model(elements, nu=nu, **sides, **given)
        hold_section(model, beam.start)
        model.add_force(beam.end, (0, F, -F))
        tip = ancf.equilibrium(model).position(beam.end)
        s = beam.section
        stiff = (1 - nu) / ((1 + nu) * (1 - 2 * nu)) if given["poisson"] == "full" else 1.0
        factors = (1.0, 1.0) if given["poisson"] == "full" else (k_y, k_z)
        for w, second, k in ((tip[1], s.I_z, factors[0]), (-tip[2], s.I_y, factors[1])):
            wanted = F * LENGTH**3 / (3 * stiff * E * second) + F * LENGTH / (k * s.G * s.A)
            assert w == pytest.approx(wanted, rel=bar)
            assert F * LENGTH / (k * s.G * s.A) > 3 * bar * wanted  # the shear is seen

    @pytest.mark.parametrize("element", SOLIDS)
    def test_planes_turn_with_the_section(self, element):
        """The same beam with its y axis elsewhere, loaded in the same direction of the section."""
        tips = []
        for angle in (0.0, 0.7):
            y, z = np.array([0, np.cos(angle), np.sin(angle)]), np.array([0, -np.sin(angle), np.cos(angle)])
            model, beam = beam_model(6, width=0.01, height=0.03, element=element, y_axis=y)
            model.clamp(beam.start)
            model.add_force(beam.end, 0.5 * y + 2.0 * z)
            tip = ancf.equilibrium(model).position(beam.end)
            tips.append([tip[0], tip @ y, tip @ z])
        assert np.abs(tips[0][1:]).min() > 1e-2
        assert tips[1] == pytest.approx(tips[0], abs=1e-9)

    @pytest.mark.parametrize("poisson", ["centreline", "full"])
    def test_poisson_ratio(self, poisson):
        """Of 0.3: nothing in bending, or what locks it: 1.346 times too stiff."""
        tips = []
        for nu in (0.0, 0.3):
            model, beam = beam_model(8, nu=nu, element="nonlocking", poisson=poisson, gravity=(0, 0, -1e-3))
            model.clamp(beam.start)
            tips.append(ancf.equilibrium(model).position(beam.end)[2])
        if poisson == "centreline":
            assert tips[1] == pytest.approx(tips[0], rel=1e-3)
        else:
            assert tips[0] / tips[1] == pytest.approx(0.7 / (1.3 * 0.4), rel=2e-3)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_moment_inside_an_element(self, element):
        """Moment M at a: w(L) = M a (L - a/2)/EI and the rotation M a/EI, in both planes."""
        a, M = 0.83 * LENGTH / 2, 1e-4
        elements, bar = (128, 5e-3) if element == "original" else (5, 2e-3)  # r_y is kinked at a
        model, beam = beam_model(elements, width=0.05, height=0.08, element=element)
        hold_section(model, beam.start)
        model.add_moment(beam.at(a), (0, -M, M))
        state = ancf.equilibrium(model)
        s, tip = beam.section, state.position(beam.end)
        for w, slope, EI in zip(tip[1:], state.slope(beam.end)[1:], (s.EI_z, s.EI_y), strict=True):
            assert w == pytest.approx(M * a * (LENGTH - a / 2) / EI, rel=bar)
            assert slope == pytest.approx(M * a / EI, rel=bar)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_section_of_given_moments(self, element):
        """A rectangle from its moments alone is the rectangle, also where bending is strong."""
        box = ancf.Section.rectangle(0.06, 0.1, E=E, rho=1000.0, nu=0.2)
        names = ("A", "I_y", "I_z", "J", "E", "rho", "nu")
        same = ancf.Section.from_moments(**{name: getattr(box, name) for name in names})
        tips = []
        for section in (box, same):
            model = ancf.Model(gravity=(0, 0, -9.81))
            beam = model.add_beam(
                "beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section, element=element
            )
            model.clamp(beam.start)
            model.add_force(beam.end, (0, 2e3, 3e3))
            model.add_moment(beam.end, (300.0, 0, 0))
            tips.append(ancf.equilibrium(model).position(beam.end))
        assert np.linalg.norm(tips[0] - (1, 0, 0)) > 0.2
        assert tips[1] == pytest.approx(tips[0], abs=1e-10)


#: Sides and St. Venant's constant by textbooks (Timoshenko & Goodier, section 109): J = k a b^3.
TORSION = {"square": (0.02, 0.02, 0.1406), "rectangle": (0.02, 0.04, 0.229), "flat": (0.06, 0.02, 0.263)}


class TestTorsion:
    @pytest.mark.parametrize("shape", TORSION)
    @pytest.mark.parametrize("variant", SOLID_VARIANTS)
    def test_static(self, variant, shape):
        """T L/(G J) within 1 % of St. Venant's J, or T L/(G (I_y + I_z)) of plane sections."""
        b, h, k = TORSION[shape]
        model, beam = beam_model(16, width=b, height=h, **VARIANTS[variant])
        model.clamp(beam.start)
        T = 0.1
        model.add_moment(beam.end, (T, 0, 0))
        state, s = ancf.equilibrium(model), beam.section
        venant = VARIANTS[variant]["poisson"] == "centreline"
        J = k * max(b, h) * min(b, h) ** 3 if venant else s.I_y + s.I_z
        for x in (0.3, 1.0, LENGTH):
            assert state.twist(beam.at(x)) == pytest.approx(T * x / (s.G * J), rel=1e-2 if venant else 2e-3)
            assert state.torque(beam.at(x)) == pytest.approx(T, rel=2e-3)

    @pytest.mark.parametrize("sides", [(6.0, 1.0), (1.0, 6.0), (30.0, 1.0), (1.0, 1.0)], ids=str)
    @pytest.mark.parametrize("variant", SOLID_VARIANTS)
    def test_loaded_section_is_not_sheared(self, variant, sides):
        """A torque on unequal sides: T L/(G J) on any mesh, and r_y and r_z stay at right angles."""
        given = {"width": 0.005 * sides[0], "height": 0.005 * sides[1], **VARIANTS[variant]}
        misses = []
        for elements in (2, 8, 128):
            model, beam = beam_model(elements, end=(0.3, 0, 0), **given)
            model.clamp(beam.start)
            wanted = 1e-5  # rad: what is of second order stays below 1e-6 of it
            model.add_moment(beam.end, (wanted * beam.torsional_stiffness / 0.3, 0, 0))
            state = ancf.equilibrium(model)
            misses.append(abs(state.twist(beam.end) / wanted - 1))
            assert abs(state.strain_tensor(beam.end)[1, 2]) < 1e-6 * wanted
        assert misses[0] < 1e-5
        assert misses[1] < max(0.2 * misses[0], 1e-7)
        assert misses[2] < max(0.2 * misses[1], 1e-7)

    @pytest.mark.parametrize("sides", [(6.0, 1.0), (1.0, 6.0), (2.0, 3.0)], ids=str)
    @pytest.mark.parametrize("element", SOLIDS)
    def test_oblique_moment_on_unequal_sides(self, element, sides):
        """Torque and both bending moments at once: each turns the end by M L/stiffness."""
        model, beam = beam_model(4, width=0.01 * sides[0], height=0.01 * sides[1], nu=0.3, element=element)
        model.clamp(beam.start)
        s, turn = beam.section, np.array([1.0, -2.0, 1.5]) * 1e-8
        stiffness = np.array([beam.torsional_stiffness, s.EI_y, s.EI_z])
        model.add_moment(beam.end, turn * stiffness / LENGTH)
        R = ancf.equilibrium(model).section_rotation(beam.end)
        found = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
        assert found == pytest.approx(turn, rel=2e-5)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_beyond_a_turn(self, element):
        """Three turns, on elements so short that turned r_y between their nodes keep their length."""
        model, beam = beam_model({"original": 160, "nonlocking": 60}[element], element=element)
        model.clamp(beam.start)
        T = 6 * np.pi * beam.torsional_stiffness / LENGTH
        model.add_moment(beam.end, (T, 0, 0))
        state = ancf.equilibrium(model, load_steps=4)
        assert state.twist(beam.end) == pytest.approx(6 * np.pi, rel=1e-2)
        assert state.twist(beam.at(LENGTH / 3)) == pytest.approx(2 * np.pi, rel=1e-2)
        assert state.position(beam.end)[1:] == pytest.approx([0, 0], abs=1e-9)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_torque_inside_an_element(self, element):
        """Up to there the twist grows, then it is constant."""
        model, beam = beam_model(5, element=element)
        model.clamp(beam.start)
        a, T = 1.02, 0.05
        model.add_moment(beam.at(a), (T, 0, 0))
        state = ancf.equilibrium(model)
        rate = T / beam.torsional_stiffness
        assert state.twist(beam.at(0.4)) == pytest.approx(0.4 * rate, rel=1e-3)
        assert state.twist(beam.end) == pytest.approx(a * rate, rel=1e-3)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_frequencies(self, element):
        """Free in torsion at one end: omega_n = (n - 1/2) pi/L sqrt(G J/(rho I_p))."""
        model, beam = beam_model(24, width=0.05, height=0.08, element=element)
        for x in beam.node_x:
            model.hold(beam.at(x), position="xyz", slope="yz")
        model.hold(beam.start, slope_y="z", slope_z="y")
        s = beam.section
        wanted = (np.arange(1, 4) - 0.5) * np.pi / LENGTH
        wanted = wanted * np.sqrt(beam.torsional_stiffness / (s.rho * (s.I_y + s.I_z)))
        assert ancf.modes(model, count=3).frequencies == pytest.approx(wanted, rel=5e-3)


class TestAxial:
    @pytest.mark.parametrize("variant", SOLID_VARIANTS)
    def test_bar(self, variant):
        """Uniaxial stress: E A E_xx s = F with E_xx = (s^2 - 1)/2, sections shrink by E_yy = -nu E_xx."""
        model, beam = beam_model(3, nu=0.3, **VARIANTS[variant])
        model.pin(beam.start)
        model.hold(beam.start, twist=True)
        EA = beam.section.EA
        model.add_force(beam.end, (0.1 * EA, 0, 0))
        state = ancf.equilibrium(model)
        s = brentq(lambda s: (s * s - 1) / 2 * s - 0.1, 1, 2, xtol=1e-15)
        eps = (s * s - 1) / 2
        assert state.position(beam.end)[0] == pytest.approx(s * LENGTH, rel=1e-9)
        for x in (0.0, 0.5, 1.3):
            assert state.tension(beam.at(x)) == pytest.approx(0.1 * EA, rel=1e-8)
            assert state.strain(beam.at(x)) == pytest.approx(eps, rel=1e-8)
            for place in ((), (0.01, -0.004)):
                strain = state.strain_tensor(beam.at(x, *place))
                assert strain == pytest.approx(np.diag([eps, -0.3 * eps, -0.3 * eps]), abs=1e-9)
                stress = state.stress_tensor(beam.at(x, *place))
                assert stress == pytest.approx(np.diag([E * eps, 0, 0]), abs=1e-6 * E)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_bar_under_its_weight(self, element):
        """Elongation w L^2/(2 EA), tension w (L - x), up to the strain."""
        model, beam = beam_model(4, element=element, gravity=(0, 0, -9.81), end=(0, 0, -LENGTH))
        model.pin(beam.start)
        model.hold(beam.start, twist=True)
        state, w = ancf.equilibrium(model), beam.section.rhoA * 9.81
        long = w * LENGTH**2 / (2 * beam.section.EA)
        assert -state.position(beam.end)[2] - LENGTH == pytest.approx(long, rel=1e-4)
        for x in (0.2, 1.0, 1.7):
            assert state.tension(beam.at(x)) == pytest.approx(w * (LENGTH - x), rel=1e-4)


class TestSupports:
    @pytest.mark.parametrize("element", SOLIDS)
    def test_twist_hold(self, element):
        """It takes a torque and no bending moment."""
        model, beam = beam_model(6, element=element)
        model.pin(beam.start)
        model.pin(beam.end)
        model.hold(beam.start, twist=True)
        T, F = 0.05, 1e-3
        model.add_moment(beam.end, (T, 0, 0))
        model.add_force(beam.at(LENGTH / 2), (0, F, F))
        state, s = ancf.equilibrium(model), beam.section
        assert state.twist(beam.end) == pytest.approx(T * LENGTH / beam.torsional_stiffness, rel=2e-3)
        r_y = state.q[state.system.slots["beam"][0, 2] + np.arange(3)]
        assert r_y[2] == pytest.approx(0.0, abs=1e-13)  # none along the initial z
        turned = F * LENGTH**2 / (16 * s.EI_y)  # of a simply supported beam with its load in the middle
        if element == "nonlocking":
            assert state.slope(beam.start)[1:] == pytest.approx([turned, turned], rel=1e-2)
            assert np.linalg.norm(state.section_moment(beam.start)[1:]) < 0.1 * F * LENGTH / 4

    @pytest.mark.parametrize("variant", SOLID_VARIANTS)
    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_clamp(self, variant, stretch):
        """Free: the section keeps its axes and shrinks under tension; fixed: it keeps all."""
        model, beam = beam_model(4, **VARIANTS[variant])
        model.clamp(beam.start, stretch=stretch)
        model.add_force(beam.end, (0.05 * beam.section.EA, 10.0, -5.0))
        state = ancf.equilibrium(model)
        assert state.section_rotation(beam.start) == pytest.approx(np.eye(3), abs=1e-12)
        strain = np.diag(state.strain_tensor(beam.start))
        if stretch == "fixed":
            assert strain == pytest.approx(0, abs=1e-13)
        else:
            assert strain == pytest.approx(strain[0] * np.array([1, -0.3, -0.3]), rel=0.05)
            assert strain[0] == pytest.approx(0.05, rel=0.1)

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    @pytest.mark.parametrize("element", SOLIDS)
    def test_rotating_clamp_turns_the_section(self, element, stretch):
        model, beam = beam_model(3, element=element)
        axis = np.array([2.0, 1.0, -2.0]) / 3
        model.clamp(beam.start, stretch=stretch, rotation="0.3*sin(30*t)", axis=axis)
        result = ancf.simulate(model, t_end=0.1, step=1e-3, integrator=ancf.GeneralizedAlpha(0.6))
        K = np.cross(np.eye(3), axis)
        for t, axes in zip(result.t, result.section_rotation(beam.start), strict=True):
            angle = 0.3 * np.sin(30 * t)
            wanted = np.eye(3) + np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
            assert axes == pytest.approx(wanted, abs=1e-12)
        assert np.ptp(result.twist(beam.end)) > 1e-4

    @pytest.mark.parametrize("element", SOLIDS)
    def test_components_of_the_section(self, element):
        """What is held stays, what is not moves."""
        model, beam = beam_model(2, element=element, gravity=(1.0, 2.0, -9.81))
        model.hold(beam.start, position="xyz", slope_y="xz", slope_z="x")
        result = ancf.simulate(model, t_end=0.05, step=1e-3)
        system = result.state(0).system
        y, z = (np.array(result.q)[:, system.slots["beam"][0, k] + np.arange(3)] for k in (2, 3))
        assert np.max(np.abs(np.ptp(y[:, [0, 2]], axis=0))) == 0.0
        assert np.ptp(z[:, 0]) == 0.0
        assert min(np.ptp(y[:, 1]), np.ptp(z[:, 1]), np.ptp(z[:, 2])) > 0.0


class TestEccentric:
    @pytest.mark.parametrize("variant", SOLID_VARIANTS)
    def test_force_twists(self, variant):
        """A force beside the centreline is the force on it and the torque F y."""
        F, y = 0.3, 0.01
        tips = []
        for beside in (True, False):
            model, beam = beam_model(4, **VARIANTS[variant])
            model.clamp(beam.start)
            model.add_force(beam.at(LENGTH, y if beside else 0.0, 0.0), (0, 0, F))
            if not beside:
                model.add_moment(beam.end, (F * y, 0, 0))
            state = ancf.equilibrium(model)
            tips.append([*state.position(beam.end), float(state.twist(beam.end))])
        assert tips[0][3] == pytest.approx(F * y * LENGTH / beam.torsional_stiffness, rel=1e-2)
        assert tips[0] == pytest.approx(tips[1], rel=1e-3, abs=1e-4)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_spring_pulls_as_its_force(self, element):
        """A spring between the edge and the ground, against the force that it has there."""
        ground, given = np.array([LENGTH, 0.3, 0.5]), {"stiffness": 20.0, "length": 0.1}
        model, beam = beam_model(4, element=element)
        model.clamp(beam.start)
        edge = beam.at(LENGTH, 0.01, -0.005)
        model.add_spring(edge, ground, **given)
        state = ancf.equilibrium(model)
        arm = ground - state.position(edge)
        force = 20.0 * (np.linalg.norm(arm) - 0.1) * arm / np.linalg.norm(arm)
        assert np.linalg.norm(force) > 1.0
        again, other = beam_model(4, element=element)
        again.clamp(other.start)
        again.add_force(other.at(LENGTH, 0.01, -0.005), force)
        same = ancf.equilibrium(again)
        assert same.position("beam.end") == pytest.approx(state.position("beam.end"), abs=1e-8)
        assert same.twist("beam.end") == pytest.approx(state.twist("beam.end"), abs=1e-7)


#: Elements of each kind that make 1e-3 m.
MESH = {"cable": 24, "original": 96, "nonlocking": 24}


class TestAgainstTheCable:
    """Thin beams of a square section bend as the cable does: it carries no torque, and needs none.

    For equal stiffness in both planes the torque of a straight beam is the same all along, zero if an end
    is free.
    """

    def build(self, element):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = square(element, EA=3e4, EI=1.0, rhoA=0.3)
        beam = model.add_beam(
            "beam",
            start=(0, 0, 0),
            end=(1, 0, 0),
            elements=MESH[element],
            section=section,
            element=element,
        )
        model.clamp(beam.start)
        return model, beam

    def test_in_a_plane(self):
        found = {}
        for element in MESH:
            model, beam = self.build(element)
            model.add_force(beam.end, (0, 0, -4.0))
            state = ancf.equilibrium(model)
            found[element] = np.array([state.position(beam.at(x)) for x in (0.5, 1.0)])
        assert found["cable"][1, 2] < -0.5
        for element in SOLIDS:
            assert found[element] == pytest.approx(found["cable"], abs=1e-3)

    def test_in_space(self):
        found = {}
        for element in MESH:
            model, beam = self.build(element)
            model.add_force(beam.at(0.5), (0, 8.0, 0))
            model.add_force(beam.end, (0, 0, 4.0))
            state = ancf.equilibrium(model)
            found[element] = np.array([state.position(beam.at(x)) for x in (0.5, 1.0)])
            if element in SOLIDS:
                bending = state.bending_moment(beam.start)
                assert abs(state.torque(beam.at(0.3))) < 5e-3 * bending
        assert np.all(np.abs(found["cable"][1, 1:]) > 0.2)
        for element in SOLIDS:
            assert found[element] == pytest.approx(found["cable"], abs=1e-3)

    def test_motion_in_space(self):
        """Half a second of a pushed cantilever, damped."""
        found = {}
        for element in MESH:
            model, beam = self.build(element)
            model.add_force(beam.end, ["0", "3*sin(8*t)", "1*t"])
            method = ancf.GeneralizedAlpha(rho_inf=0.7)
            result = ancf.simulate(model, t_end=0.5, step=2e-3, integrator=method)
            found[element] = result.position(beam.end)
        assert np.all(np.ptp(found["cable"], axis=0) > 0.1)
        for element in SOLIDS:
            assert found[element] == pytest.approx(found["cable"], abs=4e-3)
