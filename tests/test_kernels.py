"""Kernels: force is the gradient of the energy, tangent the gradient of the force, mass is the body's.

Differences of order 4 with steps of 1e-3 on states that vary over about 0.1 leave errors near 1e-9 of
the largest entry; a wrong or missing term shows at 1e-3 and more.  Sums in another order differ by
round-off, 1e-12 of the largest entry here.
"""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

import ancf
from ancf.elements.measures import axial_strain, curvature
from ancf.elements.registry import ELEMENTS
from ancf.elements.shapes import gauss, hermite
from ancf.model.beam import STRAINS
from ancf.system.core import inertia, total_strain_energy
from ancf.system.system import System
from helpers import DAMPINGS, SHAPES, SOFT, cable, derivative, forces, matrix, random_rate, shaken

BY_DIFFERENCES, BY_ROUND_OFF = 1e-7, 1e-12


def assert_close(actual, wanted, tolerance):
    scale = np.max(np.abs(wanted))
    assert scale > 0
    assert np.max(np.abs(actual - wanted)) <= tolerance * scale


def energy(system, q):
    return total_strain_energy(system.core.batches, system.core.ws, q)


def element_system(kind, strain, shape, damped=False):
    return System(cable(shape, element=kind, strain=strain, damped=damped)[0])


def two_cables():
    model, a = cable("straight", elements=2, name="a")
    _, b = cable("curved", elements=2, name="b", model=model)
    return model, a, b


def spring_system(kind):
    """Springs between points inside elements, or to the ground."""
    model, a, b = two_cables()
    other = (0.3, -0.5, 1.2) if kind == "to ground" else b.at(0.3 * b.length)
    given = {"stiffness": 30.0, "damping": 4.0, "slack": kind in ("tight", "slack")}
    model.add_spring(a.at(0.7 * a.length), other, length=9.0 if kind == "slack" else 0.2, **given)
    return System(model)


def moment_system():
    model, a, b = two_cables()
    model.add_moment(a.at(0.4 * a.length), (0.5, -1.0, 2.0))
    model.add_moment(b.end, (0.3, 0.2, -0.7))
    return System(model)


@pytest.fixture(params=list(product(ELEMENTS, STRAINS, SHAPES)), ids=lambda p: "-".join(p))
def element(request):
    return element_system(*request.param)


@pytest.fixture(params=list(product(ELEMENTS, STRAINS, SHAPES)), ids=lambda p: "-".join(p))
def damped_element(request):
    return element_system(*request.param, damped=True)


@pytest.fixture(params=["both ways", "tight", "to ground"])
def spring(request):
    return spring_system(request.param)


class TestElements:
    def test_force_is_gradient_of_energy(self, element):
        q = shaken(element)
        assert_close(forces(element, q), derivative(lambda x: energy(element, x), q), BY_DIFFERENCES)

    def test_tangent_is_gradient_of_force(self, element):
        q = shaken(element)
        wanted = derivative(lambda x: forces(element, x), q)
        assert_close(matrix(element, q, stiffness=1.0), wanted, BY_DIFFERENCES)

    def test_tangent_of_the_initial_shape(self, element):
        """A straight cable is where 1/kappa would be infinite."""
        q = shaken(element, size=0.0)
        # near the natural shape of a curved cable forces vary fast: the differences are less accurate
        wanted = derivative(lambda x: forces(element, x), q, step=2e-5)
        assert_close(matrix(element, q, stiffness=1.0), wanted, 1e-5)

    def test_natural_shape_is_free_of_force(self, element):
        q = shaken(element, size=0.0)
        beam = element.model.bodies["beam"]
        natural = beam.stretch == 1.0 and beam.natural_shape == "path"
        # a curved reference leaves kappa - kappa0 rounded off to SMOOTHING^2 = 1e-8
        assert (np.max(np.abs(forces(element, q))) < 1e-6) == natural

    def test_damping_matrix_is_derivative_by_velocity(self, damped_element):
        q = shaken(damped_element)
        rest = forces(damped_element, q)
        columns = [forces(damped_element, q, v=e) - rest for e in np.eye(len(q))]  # exact: linear in v
        C = matrix(damped_element, q, damping=1.0)
        assert_close(C, np.stack(columns, axis=-1), 1e-11)
        assert_close(C, C.T, BY_ROUND_OFF)
        assert np.linalg.eigvalsh(C)[0] > -1e-10 * np.max(np.abs(C))  # never feeds energy in

    def test_matrices_add_up(self, damped_element):
        q = shaken(damped_element)
        parts = [matrix(damped_element, q, **{k: 1.0}) for k in ("mass", "damping", "stiffness")]
        whole = matrix(damped_element, q, mass=3.0, damping=2.0, stiffness=1.0)
        assert_close(whole, 3.0 * parts[0] + 2.0 * parts[1] + parts[2], BY_ROUND_OFF)

    def test_mass_of_rigid_motions(self, element):
        """Linear fields are in the shape functions: mass, first and second moment come out exactly."""
        M = matrix(element, shaken(element), mass=1.0)
        beam, slots = element.model.bodies["beam"], element.slots["beam"]
        L, rhoA = beam.length, beam.section.rhoA
        for c in range(3):
            one, x = np.zeros(element.n), np.zeros(element.n)
            one[slots[:, 0] + c] = 1.0
            x[slots[:, 0] + c], x[slots[:, 1] + c] = beam.node_x, 1.0
            got = np.array([one @ M @ one, one @ M @ x, x @ M @ x])
            assert got == pytest.approx(rhoA * np.array([L, L**2 / 2, L**3 / 3]), rel=1e-12)

    def test_inertia_is_mass_times_acceleration(self, element):
        q, a = shaken(element), random_rate(element)
        r = np.empty_like(q)
        inertia(element.core.batches, element.core.ws, a, r)
        M = matrix(element, q, mass=1.0)
        assert_close(r, M @ a, BY_ROUND_OFF)
        assert_close(forces(element, q, a=a) - forces(element, q), M @ a, 1e-11)
        assert np.linalg.eigvalsh(M)[0] > 0

    def test_mass_is_the_integral_of_the_shape_functions(self, element):
        beam, slots = element.model.bodies["beam"], element.slots["beam"]
        x, w = gauss(4)  # exact: the integrand has degree 6
        wanted = np.zeros((element.n, element.n))
        for e in range(beam.elements):
            h = beam.node_x[e + 1] - beam.node_x[e]
            S = np.zeros((len(x), 3, element.n))
            for c in range(3):
                S[:, c, slots[e : e + 2, :2].ravel() + c] = hermite(x, h)
            wanted += beam.section.rhoA * h * np.einsum("g,gci,gcj->ij", w, S, S)
        centreline = np.ix_(slots[:, :2].ravel(), slots[:, :2].ravel())
        assert_close(matrix(element, shaken(element), mass=1.0)[centreline], wanted[centreline], BY_ROUND_OFF)


class TestCableFormulas:
    """The cable's energy and dissipation against the formulas of the theory, one element in numpy."""

    @staticmethod
    def at_gauss_points(system, q, points):
        beam = system.model.bodies["beam"]
        x, w = gauss(points)
        h = beam.node_x[1] - beam.node_x[0]
        values = q[system.slots["beam"][:2].ravel()[:, None] + np.arange(3)]
        return hermite(x, h, 1) @ values, hermite(x, h, 2) @ values, w * h

    def strains(self, system, q, strain):
        r_x, _, wa = self.at_gauss_points(system, q, 5)
        p, s, wb = self.at_gauss_points(system, q, 3)
        return axial_strain(r_x, strain), curvature(p, s, strain), wa, wb

    @pytest.mark.parametrize("strain", STRAINS)
    @pytest.mark.parametrize("shape", SHAPES)
    def test_energy(self, strain, shape):
        model, beam = cable(shape, elements=1, strain=strain)
        system = System(model)
        first, q = shaken(system, size=0.0), shaken(system)
        eps, kappa, wa, wb = self.strains(system, q, strain)
        eps0, kappa0 = np.zeros_like(eps), np.zeros_like(kappa)
        if beam.natural_shape == "path":
            r_x, _, _ = self.at_gauss_points(system, first, 5)
            eps0, kappa0 = axial_strain(r_x / beam.stretch, strain), self.strains(system, first, strain)[1]
        wanted = 0.5 * SOFT["EA"] * wa @ (eps - eps0) ** 2 + 0.5 * SOFT["EI"] * wb @ (kappa - kappa0) ** 2
        assert energy(system, q) == pytest.approx(wanted, rel=1e-7)  # curved: kappa is rounded off by 1e-8

    @pytest.mark.parametrize("strain", STRAINS)
    def test_dissipation_in_a_plane(self, strain):
        """v.(damping force) is the integral of D_a (d eps/dt)^2 + D_b (d kappa/dt)^2 + c v^2."""
        system = System(cable(elements=1, strain=strain, damped=True)[0])
        rng = np.random.default_rng(3)
        (e1, e2), base = np.linalg.qr(rng.standard_normal((3, 3)))[0][:2], shaken(system, size=0.0)
        in_plane = np.outer(rng.uniform(-0.2, 0.2, 4), e1) + np.outer(rng.uniform(-0.2, 0.2, 4), e2)
        straight = np.stack([np.zeros(3), e1, beam_length(system) * e1, e1])
        q, v = base.copy(), np.zeros_like(base)
        at = system.slots["beam"].ravel()[:, None] + np.arange(3)
        q[at] = straight + in_plane + np.outer([0, 0.3, 0, -0.3], e2)
        v[at] = np.outer(rng.uniform(-1, 1, 4), e1) + np.outer(rng.uniform(-1, 1, 4), e2)
        power = v @ (forces(system, q, v=v) - forces(system, q))
        h = 1e-4
        ahead, behind = (self.strains(system, q + s * h * v, strain) for s in (1, -1))
        eps_rate, kappa_rate = ((a - b) / (2 * h) for a, b in zip(ahead[:2], behind[:2], strict=True))
        M = matrix(system, q, mass=1.0) / SOFT["rhoA"]
        viscous = DAMPINGS["damping"] * v @ M @ v
        axial = DAMPINGS["axial_damping"] * ahead[2] @ eps_rate**2
        bending = DAMPINGS["bending_damping"] * ahead[3] @ kappa_rate**2
        assert power == pytest.approx(viscous + axial + bending, rel=1e-6)
        assert min(viscous, axial, bending) > 0.01 * power  # each part is seen


def beam_length(system):
    return system.model.bodies["beam"].length


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

    def test_slack_carries_nothing(self):
        model, _, _ = two_cables()
        slack, bare = spring_system("slack"), System(model)
        q, v = shaken(slack), random_rate(slack)
        assert np.array_equal(forces(slack, q, v=v), forces(bare, q, v=v))
        assert np.array_equal(
            matrix(slack, q, damping=1, stiffness=1), matrix(bare, q, damping=1, stiffness=1)
        )
        assert energy(slack, q) == energy(bare, q)

    def test_slack_never_pushes(self):
        """A tight spring whose ends approach fast: the damper would push more than the spring pulls."""
        tight, both = spring_system("tight"), spring_system("both ways")
        model, _, _ = two_cables()
        q = shaken(tight)
        towards = -forces(tight, q) + forces(System(model), q)  # the spring pulls its ends this way
        v = 100.0 * towards
        assert np.array_equal(forces(tight, q, v=v), forces(System(model), q, v=v))
        assert not np.allclose(forces(both, q, v=v), forces(System(model), q, v=v))


class TestMoments:
    def test_tangent_is_symmetric_part_of_gradient(self):
        system = moment_system()
        q = shaken(system)
        gradient = derivative(lambda x: forces(system, x), q)
        assert_close(matrix(system, q, stiffness=1.0), 0.5 * (gradient + gradient.T), BY_DIFFERENCES)

    def test_does_work_on_rotations(self):
        """Turning everything by a small angle takes the work M . angle, less the part along the tangent."""
        system, bare = moment_system(), System(two_cables()[0])
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
            work += (M - t * (t @ M)) @ w
        assert moment @ turned == pytest.approx(work, rel=1e-11)


class TestLanes:
    """Elements go through the kernels in chunks: every number of them gives what one at a time gives."""

    @pytest.mark.parametrize("shape", ["straight", "curved and stretched"])
    @pytest.mark.parametrize("elements", [1, 7, 8, 9, 17])
    @pytest.mark.parametrize("kind", ELEMENTS)
    def test_one_at_a_time(self, kind, elements, shape):
        fractions = np.linspace(0, 1, elements + 1) ** 1.3  # elements of different lengths
        length = System(cable(shape)[0]).model.bodies["beam"].length
        given = {"elements": None, "nodes": fractions * length, "element": kind, "damped": True}
        system = System(cable(shape, **given)[0])
        q, v, a = shaken(system, size=0.2), random_rate(system), random_rate(system, 5)
        whole = forces(system, q, v, a)
        others = system.core.batches[1:]
        parts = [forces(system, q, v, a, (batch, *others)) for batch in self.singles(system)]
        assert_close(np.sum(parts, axis=0), whole, BY_ROUND_OFF)
        total = sum(total_strain_energy((b, *others), system.core.ws, q) for b in self.singles(system))
        assert energy(system, q) == pytest.approx(total, rel=1e-13)

    @staticmethod
    def singles(system):
        beam, slots = system.model.bodies["beam"], system.slots["beam"]
        for e in range(beam.elements):
            ends = slice(e, e + 2)
            nodes = {k: getattr(beam, k)[ends] for k in ("node_x", "node_position", "node_tangent")}
            yield ELEMENTS[beam.element].build([replace(beam, **nodes)], [slots[ends]])

    def test_beams_of_all_kinds_together(self):
        """A model of different cables is the sum of its cables."""
        model = ancf.Model()
        kinds = list(product(STRAINS, SHAPES, [False, True]))
        for k, (strain, shape, damped) in enumerate(kinds):
            cable(
                shape, model=model, name=f"c{k}", strain=strain, damped=damped, gauss=(5 - k % 3, 3 + k % 2)
            )
        system = System(model)
        q, v, a = shaken(system), random_rate(system), random_rate(system, 5)
        whole, tangent = forces(system, q, v, a), matrix(system, q, 1.0, 1.0, 1.0)
        for k, (strain, shape, damped) in enumerate(kinds):
            alone = System(
                cable(shape, name=f"c{k}", strain=strain, damped=damped, gauss=(5 - k % 3, 3 + k % 2))[0]
            )
            here, there = (s.slots[f"c{k}"].ravel()[:, None] + np.arange(3) for s in (system, alone))
            x, dx, ddx = (np.zeros(alone.size) for _ in range(3))
            for one, many in ((x, q), (dx, v), (ddx, a)):
                one[there] = many[here]
            assert_close(forces(alone, x, dx, ddx)[there], whole[here], BY_ROUND_OFF)
            mine, theirs = here.ravel(), there.ravel()
            block = matrix(alone, x, 1.0, 1.0, 1.0)[np.ix_(theirs, theirs)]
            assert_close(tangent[np.ix_(mine, mine)], block, BY_ROUND_OFF)
