"""Damping of the slopes' rates: kernel against integrals, Rayleigh's decay, energy, files, bad input."""

import numpy as np
import pytest
from scipy.optimize import curve_fit

import ancf
from ancf.elements.shapes import gauss, hermite
from ancf.errors import ModelError
from ancf.model.describe import section as plain_section
from ancf.model.describe import section_of
from ancf.model.file import parse_study
from ancf.system.system import System
from helpers import (
    BY_ROUND_OFF,
    DAMPINGS,
    SHAPES,
    SOLIDS,
    assert_close,
    cable,
    forces,
    matrix,
    random_rate,
    shaken,
    soft,
)

C = 0.7


def by_quadrature(system, name, c):
    """Matrix c int S_x^T S_x dx of one body, 6 Gauss points per element."""
    beam, slots = system.model.beams[name], system.slots[name]
    out = np.zeros((system.size, system.size))
    xi, weight = gauss(6)
    for e, h in enumerate(np.diff(beam.node_x)):
        S_x = hermite(xi, h, 1)
        part = c * h * (S_x * weight[:, None]).T @ S_x
        at = slots[e : e + 2].ravel()
        for k in range(3):
            out[np.ix_(at + k, at + k)] += part
    return out


class TestKernel:
    @pytest.mark.parametrize("strain", ["material", "paper"])
    @pytest.mark.parametrize(("shape", "elements"), [("straight", 3), ("curved and stretched", 11)])
    def test_force_and_matrix(self, shape, strain, elements):
        """Force C v with C = c int S_x^T S_x dx; the tangent is its derivative; full and partial chunks."""
        section = soft(slope_damping=C)
        system = System(cable(shape, elements=elements, strain=strain, section=section)[0])
        wanted = by_quadrature(system, "beam", C)
        q, v = shaken(system), random_rate(system)
        assert_close(forces(system, q, v=v) - forces(system, q), wanted @ v, 1e-12)
        assert_close(matrix(system, q, damping=1.0), wanted[: system.n, : system.n], BY_ROUND_OFF)

    def test_beside_other_dampings(self):
        """It adds to the others, and stays on the cable that has it."""
        model, _ = cable(elements=5, section=soft(slope_damping=C, **DAMPINGS), name="both")
        cable("curved", elements=9, section=soft(**DAMPINGS), name="others", model=model)
        cable("curved", elements=2, section=soft(), name="plain", model=model)
        system = System(model)
        model, _ = cable(elements=5, section=soft(**DAMPINGS), name="both")
        cable("curved", elements=9, section=soft(**DAMPINGS), name="others", model=model)
        cable("curved", elements=2, section=soft(), name="plain", model=model)
        without = System(model)
        q, v = shaken(system), random_rate(system)
        wanted = by_quadrature(system, "both", C)
        assert_close(forces(system, q, v=v) - forces(without, q, v=v), wanted @ v, 1e-11)
        more = matrix(system, q, damping=1.0) - matrix(without, q, damping=1.0)
        assert_close(more, wanted[: system.n, : system.n], 1e-11)

    def test_rigid_motions(self):
        """A translation is not damped; a rotation is, by c w^2 L: that it is not objective is documented."""
        system = System(cable("straight", elements=4, section=soft(slope_damping=C))[0])
        q, _ = system.initial_state()
        at = system.slots["beam"]
        still, turning = np.zeros_like(q), np.zeros_like(q)
        direction = np.subtract(SHAPES["straight"]["end"], SHAPES["straight"]["start"])
        omega = np.cross(direction, (0, 0, 1.0))
        omega *= 2.0 / np.linalg.norm(omega)  # normal to the cable
        for node in at:
            still[node[0] : node[0] + 3] = 1.0, 2.0, 3.0
            for slot in node:
                turning[slot : slot + 3] = np.cross(omega, q[slot : slot + 3])
        rest = forces(system, q)
        assert np.max(np.abs(forces(system, q, v=still) - rest)) < 1e-12
        length = np.linalg.norm(direction)
        assert turning @ (forces(system, q, v=turning) - rest) == pytest.approx(C * 4.0 * length, rel=1e-12)


class TestRayleigh:
    """A taut wire whose dampings are alpha times mass and beta times each stiffness."""

    ALPHA, BETA, T, LENGTH, RHOA = 0.3, 2e-3, 2000.0, 20.0, 0.5
    EA, EI = 1e6, 0.05

    def wire(self):
        natural = self.LENGTH / (1 + self.T / self.EA)
        section = ancf.Section(
            EA=self.EA,
            EI=self.EI,
            rhoA=self.RHOA,
            damping=self.ALPHA * self.RHOA,
            axial_damping=self.BETA * self.EA,
            bending_damping=self.BETA * self.EI,
            slope_damping=self.BETA * self.T,
        )
        model = ancf.Model()
        ends = {"start": (0, 0, 0), "end": (self.LENGTH, 0, 0)}
        wire = model.add_beam("wire", **ends, length=natural, elements=16, section=section)
        model.pin(wire.start)
        model.pin(wire.end)
        return model, wire

    def test_damping_matrix(self):
        """C = alpha M + beta K at the taut state, up to the strain T/EA = 0.2 %."""
        model, _ = self.wire()
        system = System(model)
        q = ancf.equilibrium(model).q
        M, D, K = (matrix(system, q, **{key: 1.0}) for key in ("mass", "damping", "stiffness"))
        assert_close(D, self.ALPHA * M + self.BETA * K, 2.1e-3)
        lateral = np.ix_(*2 * [np.arange(system.n)[np.arange(system.n) % 3 == 2]])
        assert_close(D[lateral], (self.ALPHA * M + self.BETA * K)[lateral], 2.1e-3)

    @pytest.mark.parametrize("mode", [1, 2, 3])
    def test_decay_of_modes(self, mode):
        """Mode n of the string decays with (alpha + beta omega_n^2)/2 within 1 %."""
        model, wire = self.wire()
        omega = mode * np.pi / self.LENGTH * np.sqrt(self.T / self.RHOA)
        rate = (self.ALPHA + self.BETA * omega**2) / 2
        rest = ancf.equilibrium(model)
        q = rest.q.copy()
        slots, x = rest.slots["wire"], wire.node_x / wire.length
        k = mode * np.pi
        q[slots[:, 0] + 2] += 0.01 * np.sin(k * x)
        q[slots[:, 1] + 2] += 0.01 * k / wire.length * np.cos(k * x)
        start = ancf.State(rest.system, 0.0, q, np.zeros_like(q))
        period = 2 * np.pi / omega
        result = ancf.simulate(model, t_end=3 * period, step=period / 400, start=start)
        u = result.position(wire.at(wire.length / (2 * mode)))[:, 2] / 0.01

        def ring(t, d, w):
            return np.exp(-d * t) * (np.cos(w * t) + d / w * np.sin(w * t))

        (fitted, frequency), _ = curve_fit(ring, result.t, u, p0=(0.8 * rate, omega))
        assert fitted == pytest.approx(rate, rel=0.01)
        assert frequency == pytest.approx(np.sqrt(omega**2 - rate**2), rel=2e-3)
        assert np.max(np.abs(u - ring(result.t, fitted, frequency))) < 2e-3
        viscous_alone = self.ALPHA / 2
        assert rate > 1.2 * viscous_alone  # the slopes' part is seen


class TestRuns:
    def swinging(self, **damping):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=500.0, EI=0.2, rhoA=0.5, **damping)
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
        model.pin(beam.start)
        return model, beam

    @pytest.mark.parametrize(
        ("integrator", "step"),
        [(ancf.Trapezoidal(), 1e-3), (ancf.Radau(), 1e-3), (ancf.Explicit(), 2e-4)],
        ids=lambda i: getattr(i, "name", None),
    )
    def test_energy_balance(self, integrator, step):
        """What is lost is c int |v_x|^2 dx over time, whoever integrates."""
        model, _ = self.swinging(slope_damping=0.2)
        result = ancf.simulate(model, t_end=0.5, step=step, integrator=integrator)
        balance = result.energy.balance
        lost = result.energy.dissipated
        assert lost[-1] > 0.1
        assert np.max(np.abs(balance - balance[0])) < 2e-3 * lost[-1]
        D = by_quadrature(result.state(0).system, "beam", 0.2)
        power = np.einsum("ti,ij,tj->t", result.v[:], D, result.v[:])
        wanted = np.concatenate([[0], np.cumsum(0.5 * np.diff(result.t) * (power[1:] + power[:-1]))])
        assert lost == pytest.approx(wanted, abs=2e-4 * lost[-1])

    def test_integrators_agree(self):
        tips = []
        for integrator, step in ((ancf.Trapezoidal(), 1e-3), (ancf.Explicit(), 1e-4)):
            model, beam = self.swinging(slope_damping=0.2)
            result = ancf.simulate(model, t_end=0.4, step=step, integrator=integrator)
            tips.append(result.position(beam.end)[-1])
        assert tips[0] == pytest.approx(tips[1], abs=2e-4)
        model, beam = self.swinging()
        result = ancf.simulate(model, t_end=0.4, step=1e-3)
        assert np.linalg.norm(result.position(beam.end)[-1] - tips[0]) > 0.01  # it matters

    def test_stable_step(self):
        """Strong slope damping lowers the limit of explicit steps: h c k^2/rhoA is of the order of 1."""
        limits = [ancf.stable_step(self.swinging(slope_damping=c)[0]) for c in (0.0, 0.05, 20.0)]
        assert limits[0] > limits[1] > 20 * limits[2]


class TestFiles:
    def test_model_file(self):
        section = {"EA": 1e4, "EI": 0.1, "rhoA": 0.5, "slope_damping": 0.4}
        body = {"name": "wire", "start": [0, 0, 0], "end": [1, 0, 0], "elements": 2, "section": section}
        model = parse_study({"bodies": [body]}).model
        made = model.beams["wire"].section
        assert made == ancf.Section(**section)
        assert made.damped
        assert section_of(plain_section(made)) == made

    def test_results_keep_it(self, tmp_path):
        model, _ = TestRuns().swinging(slope_damping=0.2)
        result = ancf.simulate(model, t_end=0.01, step=1e-3)
        result.save(tmp_path / "run.h5")
        assert ancf.load(tmp_path / "run.h5").bodies["beam"].section.slope_damping == 0.2


class TestBadInput:
    @pytest.mark.parametrize(("value", "phrase"), [(-1, "must be >= 0"), (np.nan, "finite"), ("1", "number")])
    def test_values(self, value, phrase):
        with pytest.raises(ModelError, match=phrase) as caught:
            ancf.Section(EA=1.0, EI=1.0, rhoA=1.0, slope_damping=value)
        assert caught.value.where == "Section.slope_damping"

    @pytest.mark.parametrize("element", SOLIDS)
    def test_beams_refuse_it(self, element):
        model, section = ancf.Model(), ancf.Section.circle(0.1, E=1e6, rho=1e3, slope_damping=1.0)
        given = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 2, "section": section}
        with pytest.raises(ModelError, match="has no effect") as caught:
            model.add_beam("bar", element=element, **given)
        assert caught.value.where == 'add_beam("bar").section.slope_damping'
        assert model.add_beam("wire", **given).section.damped
