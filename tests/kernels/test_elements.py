"""Elements: force is the gradient of the energy, tangent the gradient of the force, mass is the body's.

Differences of order 4 with steps of 1e-3 on states that vary over about 0.1 leave errors near 1e-9 of
the largest entry; a wrong or missing term shows at 1e-3 and more.  Sums in another order differ by
round-off, 1e-12 of the largest entry here.
"""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

import ancf
from ancf.batches import Batches
from ancf.elements.measures import axial_strain, curvature
from ancf.elements.registry import ELEMENTS
from ancf.elements.shapes import gauss, hermite
from ancf.model.elements import KINDS
from ancf.system.core import find_inverted, inertia
from ancf.system.system import System
from compiled_kernels import total_strain_energy
from helpers import (
    BY_DIFFERENCES,
    BY_ROUND_OFF,
    DAMPINGS,
    SHAPES,
    SOFT,
    SOLIDS,
    VARIANTS,
    assert_close,
    cable,
    derivative,
    energy,
    forces,
    matrix,
    random_rate,
    shaken,
)


def element_system(variant, shape, damped=False):
    return System(cable(shape, damped=damped, **VARIANTS[variant])[0])


@pytest.fixture(params=list(product(VARIANTS, SHAPES)), ids=lambda p: "-".join(p))
def element(request):
    return element_system(*request.param)


@pytest.fixture(params=list(product(VARIANTS, SHAPES)), ids=lambda p: "-".join(p))
def damped_element(request):
    return element_system(*request.param, damped=True)


def across(element, xi, h, derivative=0):
    """Factors of r_y (or r_z) of both nodes and of the internal r_yx in r_y or r_yx (paper, eqs. 7, 17)."""
    if element == "original":
        return np.stack([[1 - xi, xi], [-1 / h + 0 * xi, 1 / h + 0 * xi]][derivative], axis=-1)
    columns = [[1 - xi**2, xi**2, h * (xi - xi**2)], [-2 * xi / h, 2 * xi / h, 1 - 2 * xi]]
    return np.stack(columns[derivative], axis=-1)


def section_columns(element, slots, e, axis):
    """Slots that go with :func:`across` in element e; axis 0 is r_y, 1 is r_z."""
    shared = [slots[e, 2 + axis], slots[e + 1, 2 + axis]]
    return shared if element == "original" else [*shared, slots[e, 4 + axis]]


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
        # a cable's curved reference leaves kappa - kappa0 rounded off to SMOOTHING^2 = 1e-8
        bar = 1e-11 if beam.element in SOLIDS else 1e-6
        assert (np.max(np.abs(forces(element, q))) < bar) == natural

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
        whole = matrix(damped_element, q, mass=3.0, damping=2.0, stiffness=0.7)
        assert_close(whole, 3.0 * parts[0] + 2.0 * parts[1] + 0.7 * parts[2], BY_ROUND_OFF)

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
        used = element.numbering.used()
        assert np.linalg.eigvalsh(M[np.ix_(used, used)])[0] > 0
        assert not np.any(M[~used])

    def test_mass_is_the_integral_of_the_shape_functions(self, element):
        """rhoA on r, rho I_z on r_y and rho I_y on r_z, each component for itself."""
        beam, slots = element.model.bodies["beam"], element.slots["beam"] // 3
        section = beam.section
        x, w = gauss(4)  # exact: the integrand has degree 6
        wanted = np.zeros((element.n // 3, element.n // 3))
        for e in range(beam.elements):
            h = beam.node_x[e + 1] - beam.node_x[e]
            parts = [(section.rhoA, slots[e : e + 2, :2].ravel(), hermite(x, h))]
            if beam.element in SOLIDS:
                for axis, second in enumerate((section.I_z, section.I_y)):
                    columns = section_columns(beam.element, slots, e, axis)
                    parts.append((section.rho * second, columns, across(beam.element, x, h)))
            for factor, columns, S in parts:
                wanted[np.ix_(columns, columns)] += factor * h * np.einsum("g,gi,gj->ij", w, S, S)
        assert_close(matrix(element, shaken(element), mass=1.0), np.kron(wanted, np.eye(3)), BY_ROUND_OFF)


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

    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
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

    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
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


class TestBeamFormulas:
    """Energy and dissipation of the beams against integrals over their volume, one element in numpy."""

    @staticmethod
    def sections(system, q):
        """r_x, r_y, r_z, r_yx, r_zx at the Gauss points of the axis, shape (5, points, 3), and weights."""
        beam, slots = system.model.bodies["beam"], system.slots["beam"]
        x, w = gauss(beam.gauss[0])
        h = beam.length
        at = lambda columns: q[np.array(columns)[:, None] + np.arange(3)]  # noqa: E731
        a = hermite(x, h, 1) @ at(slots[:2, :2].ravel())
        b, c = (at(section_columns(beam.element, slots, 0, axis)) for axis in range(2))
        S, S_x = (across(beam.element, x, h, order) for order in range(2))
        return np.stack([a, S @ b, S @ c, S_x @ b, S_x @ c]), w * h

    @classmethod
    def natural(cls, system):
        beam, q = system.model.bodies["beam"], shaken(system, size=0.0)
        if beam.natural_shape == "straight":
            e, zero = np.eye(3)[:, None], np.zeros((1, 3))
            return np.stack([*e, zero, zero])
        r_x = system.slots["beam"].copy()[:, 1, None] + np.arange(3)
        straight = cls.sections(system, q)[0]
        straight[0] /= beam.stretch
        assert np.linalg.norm(q[r_x[0]]) == pytest.approx(beam.stretch)
        return straight

    @staticmethod
    def green(vectors, y, z):
        a, b, c, B, C = vectors
        F = np.stack([a + y * B + z * C, b, c], axis=-1)
        return 0.5 * np.swapaxes(F, -1, -2) @ F

    @pytest.mark.parametrize("shape", SHAPES)
    @pytest.mark.parametrize("variant", [v for v in VARIANTS if VARIANTS[v]["element"] in SOLIDS])
    def test_energy(self, variant, shape):
        system = System(cable(shape, elements=1, **VARIANTS[variant])[0])
        beam, q = system.model.bodies["beam"], shaken(system)
        now, weight = self.sections(system, q)
        before = self.natural(system)
        W = self.energy_of_the_volume(beam, now, before)
        assert energy(system, q) == pytest.approx(weight @ W, rel=1e-12)

    def energy_of_the_volume(self, beam, now, before):
        """Per length; "full" is the whole material, "centreline" couples the normal strains there only."""
        s, full = beam.section, beam.poisson == "full"
        lam = s.E * s.nu / ((1 + s.nu) * (1 - 2 * s.nu))
        x, w = gauss(3)
        W = 0.0
        for y, wy in zip((x - 0.5) * s.shape.width, w, strict=True):
            for z, wz in zip((x - 0.5) * s.shape.height, w, strict=True):
                E = self.green(now, y, z) - self.green(before, y, z)
                normal, trace = np.einsum("gii->gi", E), np.einsum("gii->g", E)
                shear = (E**2).sum((1, 2)) - (normal**2).sum(1)
                uncoupled = 0.5 * s.E * (normal**2).sum(1)
                whole = 0.5 * lam * trace**2 + s.G * (normal**2).sum(1)
                W = W + s.A * wy * wz * ((whole if full else uncoupled) + s.G * shear)
                if not full and y == z == 0.0:
                    W = W + s.A * (whole - uncoupled)
        return W if full else W - self.reduced_shear(s, now, before)

    @staticmethod
    def reduced_shear(s, now, before):
        """What the shear factors and J take off: the section's plane shear and torsion are too stiff."""
        dot = lambda i, j: np.sum(now[i] * now[j] - before[i] * before[j], axis=-1)  # noqa: E731
        k_y, k_z = s.shear_factors
        plane = s.A * ((1 - k_y) * dot(0, 1) ** 2 + (1 - k_z) * dot(0, 2) ** 2)
        torsion = (1 - s.J / (s.I_y + s.I_z)) * (s.I_y * dot(1, 4) ** 2 + s.I_z * dot(2, 3) ** 2)
        return 0.5 * s.G * (plane + torsion)

    @pytest.mark.parametrize("kind", SOLIDS)
    def test_dissipation(self, kind):
        """v.(damping force): D_a (d e0/dt)^2 + D_b |d(r_x.r_yx, r_x.r_zx)/dt|^2 + c v^2 of the centreline."""
        system = System(cable("curved", elements=1, element=kind, damped=True)[0])
        q, v = shaken(system), random_rate(system)
        power = v @ (forces(system, q, v=v) - forces(system, q))
        (a, _, _, B, C), w = self.sections(system, q)
        da, _, _, dB, dC = self.sections(system, v)[0]
        beam = system.model.bodies["beam"]
        slots, h = system.slots["beam"], beam.length
        x, gauss_weight = gauss(4)
        speed = hermite(x, h) @ v[slots[:2, :2].ravel()[:, None] + np.arange(3)]
        viscous = DAMPINGS["damping"] * h * gauss_weight @ (speed**2).sum(1)
        axial = DAMPINGS["axial_damping"] * w @ (a * da).sum(1) ** 2
        rates = [(da * X + a * dX).sum(1) for X, dX in ((B, dB), (C, dC))]
        bending = DAMPINGS["bending_damping"] * sum(w @ rate**2 for rate in rates)
        assert power == pytest.approx(viscous + axial + bending, rel=1e-11)
        assert min(viscous, axial, bending) > 0.01 * power


class TestInverted:
    """A section that has collapsed or turned inside out, anywhere in a beam."""

    @pytest.mark.parametrize("kind", SOLIDS)
    @pytest.mark.parametrize("elements", [1, 11])
    def test_is_found(self, kind, elements):
        system = System(cable("curved", elements=elements, element=kind)[0])
        slots, (batches, ws) = system.slots["beam"], (system.core.batches, system.core.ws)
        q = shaken(system, size=0.3)
        assert find_inverted(batches, ws, q) == -1
        last = elements - 1
        for axis in (2, 3):
            mirrored = q.copy()
            for k in (last, last + 1):
                mirrored[slots[k, axis] + np.arange(3)] *= -1.0  # r_y or r_z of the last element
            slot = find_inverted(batches, ws, mirrored)
            # the element before it has half of it
            assert system.element_of(slot) in {f"beam element {max(last - 1, 0)}", f"beam element {last}"}

    def test_flat_counts(self):
        system = System(cable("straight", elements=2, element="original")[0])
        q = shaken(system, size=0.0)
        y = system.slots["beam"][:, 2, None] + np.arange(3)
        q[y] = 0.0
        assert system.element_of(find_inverted(system.core.batches, system.core.ws, q)) == "beam element 0"

    def test_cables_have_no_section(self):
        system = System(cable("curved")[0])
        assert find_inverted(system.core.batches, system.core.ws, -shaken(system)) == -1


def beam_length(system):
    return system.model.bodies["beam"].length


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
        parts = [forces(system, q, v, a, Batches((batch, *others))) for batch in self.singles(system)]
        assert_close(np.sum(parts, axis=0), whole, BY_ROUND_OFF)
        singles = (Batches((b, *others)) for b in self.singles(system))
        total = sum(total_strain_energy(b, system.core.ws, q) for b in singles)
        assert energy(system, q) == pytest.approx(total, rel=1e-13)

    @staticmethod
    def singles(system):
        beam, slots = system.model.bodies["beam"], system.slots["beam"]
        for e in range(beam.elements):
            ends = slice(e, e + 2)
            nodes = {k: getattr(beam, f"node_{k}")[ends] for k in ("x", "position", "tangent", "y")}
            nodes = {f"node_{k}": values for k, values in nodes.items()}
            yield ELEMENTS[beam.element].build([replace(beam, **nodes)], [slots[ends]])

    @staticmethod
    def mixture(kind):
        """What may differ between the bodies of one model: variant, shape, damping."""
        if kind == "all":
            return list(product(VARIANTS, ["curved and stretched"], [True]))
        variants = [v for v in VARIANTS if VARIANTS[v]["element"] == kind]
        return list(product(variants, SHAPES, [False, True]))

    @pytest.mark.parametrize("kind", [*ELEMENTS, "all"])
    def test_bodies_of_all_kinds_together(self, kind):
        """A model of different bodies is the sum of its bodies."""
        model, kinds = ancf.Model(), self.mixture(kind)

        def body(k, model=None):
            variant, shape, damped = kinds[k]
            given = VARIANTS[variant] | {"gauss": (5 - k % 3, 3 + k % 2)}
            return cable(shape, model=model, name=f"c{k}", damped=damped, **given)[0]

        for k in range(len(kinds)):
            body(k, model)
        system = System(model)
        q, v, a = shaken(system), random_rate(system), random_rate(system, 5)
        whole, tangent = forces(system, q, v, a), matrix(system, q, 1.0, 1.0, 1.0)
        for k in range(len(kinds)):
            alone = System(body(k))
            here, there = (s.slots[f"c{k}"].ravel()[:, None] + np.arange(3) for s in (system, alone))
            x, dx, ddx = (np.zeros(alone.size) for _ in range(3))
            for one, many in ((x, q), (dx, v), (ddx, a)):
                one[there] = many[here]
            assert_close(forces(alone, x, dx, ddx)[there], whole[here], BY_ROUND_OFF)
            mine, theirs = here.ravel(), there.ravel()
            block = matrix(alone, x, 1.0, 1.0, 1.0)[np.ix_(theirs, theirs)]
            assert_close(tangent[np.ix_(mine, mine)], block, BY_ROUND_OFF)
