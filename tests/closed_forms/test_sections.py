"""Results at any point of a beam's volume: places, strains, stresses, moments and axes of sections.

Against beam theory up to the square of what is small, and against integrals over the section.
"""

import numpy as np
import pytest

import ancf
from ancf.system import sections
from ancf.system.system import System
from helpers import DAMPINGS, SHAPES, SOLIDS, VARIANTS, cable, random_rate, rotation, shaken

SOLID_VARIANTS = [name for name in VARIANTS if VARIANTS[name]["element"] in SOLIDS]
PLACES = ((0.0, 0.0), (0.15, 0.1), (-0.1, 0.05), (0.02, -0.1))
#: Per section and per point of it; what a cable does not have.
OF_SECTIONS = ("section_moment", "torque", "twist", "section_rotation", "strain_tensor", "stress_tensor")


def state_of(system, q, v=None):
    return ancf.State(system, 0.0, q, np.zeros_like(q) if v is None else v)


def vectors(system, q, x):
    """r, r_y and r_z at x, from the fields of the probe."""
    probe = system.probe(system.model.bodies["beam"].at(x))
    return [probe.field(q, row) for row in (0, 3, 4)]


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("element", SOLIDS)
class TestPlaces:
    def test_initial(self, element, shape):
        system = System(cable(shape, element=element, elements=4)[0])
        beam, state = system.model.bodies["beam"], state_of(system, shaken(system, size=0.0))
        for x in np.linspace(0, beam.length, 9):
            for y, z in PLACES:
                wanted = beam.initial_position(x, y, z)
                assert state.position(beam.at(x, y, z)) == pytest.approx(wanted, abs=1e-13)
        # at the nodes r_y and r_z are the axes of the section
        middle, edge = (state.position(beam.at(beam.node_x[2], *place)) for place in ((), (0.1, 0.05)))
        assert edge - middle == pytest.approx(0.1 * beam.node_y[2] + 0.05 * beam.node_z[2], abs=1e-13)

    def test_in_any_state(self, element, shape):
        """r + y r_y + z r_z, and its rate; continuous between elements."""
        system = System(cable(shape, element=element, elements=3)[0])
        beam = system.model.bodies["beam"]
        q, v = shaken(system), random_rate(system)
        state = state_of(system, q, v)
        for x in (0.1, 0.5, beam.length):
            for y, z in PLACES:
                point = beam.at(x, y, z)
                for found, source in ((state.position(point), q), (state.velocity(point), v)):
                    r, r_y, r_z = vectors(system, source, x)
                    assert found == pytest.approx(r + y * r_y + z * r_z, abs=1e-13)
        for y, z in PLACES:
            before, after = (state.position(beam.at(beam.node_x[1] + d, y, z)) for d in (-1e-9, 1e-9))
            assert before == pytest.approx(after, abs=1e-7)

    def test_slope_beside_the_centreline(self, element, shape):
        """d/dx of the position at constant y and z."""
        system = System(cable(shape, element=element, elements=2)[0])
        beam, state = system.model.bodies["beam"], state_of(system, shaken(system))
        x, h = 0.37 * beam.length, 1e-5
        for y, z in PLACES:
            ahead, behind = (state.position(beam.at(x + d, y, z)) for d in (h, -h))
            assert state.slope(beam.at(x, y, z)) == pytest.approx((ahead - behind) / (2 * h), abs=1e-8)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("variant", SOLID_VARIANTS)
class TestConsistent:
    """In any state, also far from the natural shape."""

    def test_strains_are_of_the_displacements(self, variant, shape):
        """(F^T F - F0^T F0)/2, F by differences of the position; F0 without the initial stretch."""
        system = System(cable(shape, elements=2, **VARIANTS[variant])[0])
        beam = system.model.bodies["beam"]
        first, q = shaken(system, size=0.0), shaken(system)
        x, y, z, h = 0.4 * beam.length, 0.05, -0.04, 1e-5

        def gradient(state, stretch):
            steps = ((h, 0, 0), (0, h, 0), (0, 0, h))
            columns = []
            for dx, dy, dz in steps:
                ahead, behind = (state.position(beam.at(x + s * dx, y + s * dy, z + s * dz)) for s in (1, -1))
                columns.append((ahead - behind) / (2 * h))
            F = np.column_stack(columns)
            if stretch != 1.0:  # of the centreline alone
                r_x = state.slope(beam.at(x))
                F[:, 0] -= (1 - 1 / stretch) * r_x
            return F

        F = gradient(state_of(system, q), 1.0)
        F0 = np.eye(3)
        if beam.natural_shape == "path":
            F0 = gradient(state_of(system, first), beam.stretch)
        wanted = 0.5 * (F.T @ F - F0.T @ F0)
        assert state_of(system, q).strain_tensor(beam.at(x, y, z)) == pytest.approx(wanted, abs=1e-8)

    def test_stress_is_the_derivative_of_the_energy(self, variant, shape):
        """Symmetric, and by Hooke's law from the strains there and on the centreline."""
        system = System(cable(shape, elements=2, **VARIANTS[variant])[0])
        beam, state = system.model.bodies["beam"], state_of(system, shaken(system))
        s = beam.section
        lam, mu = s.E * s.nu / ((1 + s.nu) * (1 - 2 * s.nu)), s.G
        strain, middle = (state.strain_tensor(beam.at(0.4, *place)) for place in ((0.1, -0.06), ()))
        stress = state.stress_tensor(beam.at(0.4, 0.1, -0.06))
        if beam.poisson == "full":
            wanted = lam * np.trace(strain) * np.eye(3) + 2 * mu * strain
        else:
            normal = s.E * np.diag(strain)
            coupled = lam * np.trace(middle) + (2 * mu - s.E) * np.diag(middle)
            wanted = 2 * mu * strain
            np.fill_diagonal(wanted, normal + coupled)
        assert stress == pytest.approx(wanted, rel=1e-12, abs=1e-12)
        assert np.array_equal(stress, stress.T)

    def test_resultants_are_integrals_of_the_stress(self, variant, shape):
        """n = int F S e_x dA and m = int (y r_y + z r_z) x F S e_x dA.

        "centreline": of a section whose J is that of a plane one; what the coupling adds to S_xx all over
        the section does work on the centreline only.
        """
        model, s = ancf.Model(), ancf.Section.rectangle(0.3, 0.2, E=600.0, rho=10.0, nu=0.3)
        plane = ancf.Section.rectangle(0.3, 0.2, E=600.0, rho=10.0, nu=0.3, J=s.I_y + s.I_z)
        beam = model.add_beam("beam", section=plane, elements=2, **SHAPES[shape], **VARIANTS[variant])
        system = System(model)
        q = shaken(system)
        n, m = self.integrated(system, q)
        probe, state = system.probe(beam.at(0.4)), state_of(system, q)
        if beam.poisson == "centreline":
            middle = np.diag(state.strain_tensor(beam.at(0.4)))
            coupled = state.stress_tensor(beam.at(0.4))[0, 0] - s.E * middle[0]
            _, r_y, r_z, r_yx, r_zx = sections.section(probe, q)
            m = m - coupled * (s.I_z * np.cross(r_y, r_yx) + s.I_y * np.cross(r_z, r_zx))
        force, moment = sections.resultants(probe, q, 0 * q)
        assert force == pytest.approx(n, rel=1e-10, abs=1e-11)
        assert moment == pytest.approx(m, rel=1e-10, abs=1e-11)
        axes = state.section_rotation(beam.at(0.4))
        assert state.section_moment(beam.at(0.4)) == pytest.approx(axes.T @ m, rel=1e-9, abs=1e-11)

    @staticmethod
    def integrated(system, q):
        """Force and moment of the stresses at x = 0.4 m."""
        beam, state = system.model.bodies["beam"], state_of(system, q)
        x, w = np.polynomial.legendre.leggauss(3)
        r_y, r_z = vectors(system, q, 0.4)[1:]
        n, m, s = np.zeros(3), np.zeros(3), beam.section.shape
        for y, wy in zip(x * s.width / 2, w * s.width / 2, strict=True):
            for z, wz in zip(x * s.height / 2, w * s.height / 2, strict=True):
                point = beam.at(0.4, y, z)
                F = np.column_stack([state.slope(point), r_y, r_z])
                traction = wy * wz * F @ state.stress_tensor(point)[:, 0]
                n += traction
                m += np.cross(y * r_y + z * r_z, traction)
        return n, m


LENGTH, E, WIDTH, HEIGHT = 2.0, 1e9, 0.06, 0.04


def cantilever(variant, elements=8, **more):
    model = ancf.Model()
    section = ancf.Section.rectangle(WIDTH, HEIGHT, E=E, rho=1000.0, nu=0.3, **more)
    given = {"start": (0, 0, 0), "end": (LENGTH, 0, 0), "elements": elements}
    beam = model.add_beam("beam", section=section, **given, **VARIANTS[variant])
    model.hold(beam.start, position="xyz", slope_y="xyz", slope_z="xyz")
    return model, beam


@pytest.mark.parametrize("variant", [v for v in SOLID_VARIANTS if "nonlocking" in v])
class TestBeamTheory:
    def test_bending(self, variant):
        """E_xx = -y kappa_z + z kappa_y, M = EI kappa; stiffer by 1.346 where the coupling locks."""
        M_y, M_z, nu = 0.02, 0.05, 0.3
        model, beam = cantilever(variant)
        model.add_moment(beam.end, (0, M_y, M_z))
        state, s = ancf.equilibrium(model), beam.section
        stiff = (1 - nu) / ((1 + nu) * (1 - 2 * nu)) if beam.poisson == "full" else 1.0
        kappa_y, kappa_z = M_y / (stiff * E * s.I_y), M_z / (stiff * E * s.I_z)
        for x in (0.5, 1.3):
            moment = state.section_moment(beam.at(x))
            assert moment == pytest.approx((0, M_y, M_z), abs=1e-5)  # of M times the slope
            assert state.bending_moment(beam.at(x)) == pytest.approx(np.hypot(M_y, M_z), rel=1e-5)
            assert state.curvature(beam.at(x)) == pytest.approx(np.hypot(kappa_y, kappa_z), rel=1e-3)
            for y, z in ((0.03, 0.02), (-0.03, 0.01), (0.0, 0.02)):
                point = beam.at(x, y, z)
                wanted = -y * kappa_z + z * kappa_y
                assert state.strain_tensor(point)[0, 0] == pytest.approx(wanted, rel=1e-3, abs=1e-10)
                assert state.strain(point) == pytest.approx(wanted, rel=1e-3, abs=1e-10)
                stress = state.stress_tensor(point)[0, 0]
                assert stress == pytest.approx(stiff * E * wanted, rel=1e-3, abs=1e-10 * E)

    def test_axes_turn_with_the_bending(self, variant):
        """The normal of the end section turns by M L/EI, up to cubes of the angle."""
        M = 0.5
        model, beam = cantilever(variant)
        model.add_moment(beam.end, (0, 0, M))
        state = ancf.equilibrium(model)
        stiff = 0.7 / (1.3 * 0.4) if beam.poisson == "full" else 1.0
        angle = M * LENGTH / (stiff * E * beam.section.I_z)
        assert state.section_rotation(beam.end) == pytest.approx(rotation((0, 0, -1), angle), abs=1e-7)
        assert angle > 1e-3

    def test_torsion(self, variant):
        """2 E_xz = y theta', 2 E_xy = -z theta' of sections that stay plane, tau = G times that."""
        T = 0.05
        model, beam = cantilever(variant)
        model.add_moment(beam.end, (T, 0, 0))
        state, rate = ancf.equilibrium(model), T / beam.torsional_stiffness
        for y, z in ((0.03, 0.02), (-0.02, 0.01)):
            strain, stress = (
                getattr(state, name)(beam.at(1.1, y, z)) for name in ("strain_tensor", "stress_tensor")
            )
            assert 2 * strain[0, 1:] == pytest.approx([-z * rate, y * rate], rel=1e-3)
            assert stress[0, 1:] == pytest.approx(beam.section.G * np.array([-z * rate, y * rate]), rel=1e-3)
        assert state.section_moment(beam.at(0.7)) == pytest.approx((T, 0, 0), abs=1e-6)
        assert state.torque(beam.at(0.7)) == pytest.approx(T, rel=1e-5)
        assert state.bending_moment(beam.at(0.7)) < 1e-6

    def test_shear(self, variant):
        """2 E_xy = Q/(k G A) under a force across."""
        k = (0.8, 0.6)
        model, beam = cantilever(variant, shear_factors=k)
        F = np.array([0.3, -0.2])
        model.add_force(beam.end, (0, *F))
        strain = ancf.equilibrium(model).strain_tensor(beam.at(1.0))
        factors = np.array(k) if beam.poisson == "centreline" else np.ones(2)
        wanted = F / (factors * beam.section.G * beam.section.A)
        assert 2 * strain[0, 1:] == pytest.approx(wanted, rel=1e-2)


class TestTwist:
    @pytest.mark.parametrize("element", SOLIDS)
    @pytest.mark.parametrize("turns", [0.3, 2.6, -1.7])
    def test_counts_turns(self, element, turns):
        """A straight beam whose sections are turned by hand, beyond a turn, anywhere in space."""
        Q = rotation((1.0, 2.0, -0.5), 1.1)
        system = System(cable("straight", element=element, elements=40)[0])
        beam, q = system.model.bodies["beam"], system.initial_state()[0]
        slots, t = system.slots["beam"], beam.node_tangent[0]
        rate = 2 * np.pi * turns / beam.length
        for node, x in enumerate(beam.node_x):
            turn = rotation(-t, rate * x)
            for k, axis in enumerate((beam.node_y[node], beam.node_z[node])):
                q[slots[node, 2 + k] + np.arange(3)] = turn @ axis
                for internal in slots[node, 4:][k : k + 1]:
                    q[internal + np.arange(3)] = rate * np.cross(t, turn @ axis)
        q = (q.reshape(-1, 3) @ Q.T).ravel()
        state = state_of(system, q)
        for share in (0.0, 0.35, 0.731, 1.0):
            x = share * beam.length
            assert state.twist(beam.at(x)) == pytest.approx(2 * np.pi * turns * share, rel=1e-2, abs=1e-9)
        end = state.section_rotation(beam.end)
        start = state.section_rotation(beam.start)
        assert end @ start.T == pytest.approx(rotation(-Q @ t, 2 * np.pi * turns), abs=1e-12)

    @pytest.mark.parametrize("shape", ["curved", "curved and stretched"])
    @pytest.mark.parametrize("element", SOLIDS)
    def test_is_counted_from_the_natural_shape(self, element, shape):
        system = System(cable(shape, element=element, elements=5)[0])
        beam, state = system.model.bodies["beam"], state_of(system, shaken(system, size=0.0))
        for x in (0.2, 0.8, beam.length):
            assert state.twist(beam.at(x)) == pytest.approx(0.0, abs=1e-13)
            if shape == "curved":  # a stretched start is in tension, along a helix
                assert state.section_moment(beam.at(x)) == pytest.approx(0.0, abs=1e-13)


@pytest.mark.parametrize("element", SOLIDS)
class TestAxes:
    def test_orthonormal(self, element):
        system = System(cable("curved", element=element)[0])
        beam, q = system.model.bodies["beam"], shaken(system)
        state = state_of(system, q)
        for x in (0.0, 0.3, 1.0):
            R = state.section_rotation(beam.at(x))
            product = R.T @ R
            assert product == pytest.approx(np.eye(3), abs=1e-13)
            assert np.linalg.det(R) == pytest.approx(1.0)
            _, r_y, r_z = vectors(system, q, x)
            assert R[:, 0] @ r_y == pytest.approx(0.0, abs=1e-13)
            assert R[:, 0] @ r_z == pytest.approx(0.0, abs=1e-13)
            # as near to r_y as to r_z
            assert R[:, 1] @ r_y / np.linalg.norm(r_y) == pytest.approx(R[:, 2] @ r_z / np.linalg.norm(r_z))

    def test_initial(self, element):
        model, beam = cable("curved", element=element, y_axis=(0.2, 0.5, 1.0))
        system = System(model)
        state = state_of(system, shaken(system, size=0.0))
        for node, x in enumerate(beam.node_x):
            axes = np.column_stack([beam.node_tangent[node], beam.node_y[node], beam.node_z[node]])
            assert state.section_rotation(beam.at(x)) == pytest.approx(axes, abs=1e-13)

    def test_velocity_in_a_rigid_rotation(self, element):
        model, beam = cable("curved", element=element)
        w = np.array([0.5, -1.0, 2.0])
        beam.set_motion(velocity=(1, 2, 3), angular_velocity=w, about=(0.3, 0.1, 0))
        state = ancf.simulate(model, t_end=1e-4, step=1e-4).state(0)
        for place in ((0.0, 0.1, -0.08), (0.4, -0.1, 0.05), (1.1, 0.0, 0.1)):
            arm = state.position(beam.at(*place)) - (0.3, 0.1, 0)
            wanted = np.array([1, 2, 3]) + np.cross(w, arm)
            assert state.velocity(beam.at(*place)) == pytest.approx(wanted, abs=1e-12)


@pytest.mark.parametrize("element", SOLIDS)
def test_damping_counts_in_forces(element):
    """N += D_a d(e0)/dt and M += D_b d(kappa)/dt, in a state of pure stretch or pure bending."""
    system = System(cable("straight", element=element, damped=True)[0])
    beam, q = system.model.bodies["beam"], system.initial_state()[0]
    t = beam.node_tangent[0]
    slots = system.slots["beam"]
    v = np.zeros_like(q)
    for node, x in enumerate(beam.node_x):
        v[slots[node, 0] + np.arange(3)] = 0.5 * x * t
        v[slots[node, 1] + np.arange(3)] = 0.5 * t
    assert state_of(system, q, v).tension(beam.at(0.3)) == pytest.approx(0.5 * DAMPINGS["axial_damping"])
    v[:] = 0.0
    for node, x in enumerate(beam.node_x):  # r_y turns about z by 0.4 x: d(r_x . r_yx)/dt = -0.4
        v[slots[node, 2] + np.arange(3)] = -0.4 * x * t
        for internal in slots[node, 4:][:1]:
            v[internal + np.arange(3)] = -0.4 * t
    moment = state_of(system, q, v).section_moment(beam.at(0.3))
    assert moment == pytest.approx((0, 0, 0.4 * DAMPINGS["bending_damping"]), abs=1e-13)


@pytest.mark.parametrize("element", SOLIDS)
def test_histories_are_states_in_a_row(element):
    model, beam = cable("curved", element=element, damped=True)
    model.clamp(beam.start)
    model.gravity[:] = 0, 0, -9.81
    result = ancf.simulate(model, t_end=0.05, step=1e-3)
    names = ("position", "velocity", "slope", "strain", "tension", "curvature", "bending_moment")
    for name in (*names, *OF_SECTIONS):
        point = beam.at(0.6, 0.1, -0.05)
        history = getattr(result, name)(point)
        assert np.ptp(history, axis=0).max() > 0, name
        for k in (0, 20, 50):
            one = getattr(result.state(k), name)(point)
            assert history[k] == pytest.approx(one, rel=1e-12, abs=1e-13), name
            assert np.array_equal(getattr(result.state(k), name)("beam.at(0.6, 0.1, -0.05)"), one), name


class TestCablesHaveNone:
    @pytest.mark.parametrize("name", OF_SECTIONS)
    def test_no_section(self, name):
        model, beam = cable("curved")
        state = ancf.simulate(model, t_end=1e-3, step=1e-3).state()
        with pytest.raises(ancf.ModelError, match=r"beam.at\(0.5\): a cable has no cross-section") as caught:
            getattr(state, name)(beam.at(0.5))
        assert 'element="original"' in caught.value.hint

    def test_no_place_beside_the_centreline(self):
        model, _ = cable("curved")
        state = ancf.simulate(model, t_end=1e-3, step=1e-3).state()
        with pytest.raises(ancf.ModelError, match="a cable has no cross-section"):
            state.position("beam.at(0.5, 0.01, 0)")

    @pytest.mark.parametrize("element", SOLIDS)
    def test_outside_the_section(self, element):
        model, _ = cable("curved", element=element)
        state = ancf.simulate(model, t_end=1e-3, step=1e-3).state()
        with pytest.raises(ancf.ModelError, match="outside the cross-section"):
            state.strain_tensor("beam.at(0.5, 0.2, 0)")
