"""Convergence orders, measured as rates.

A rate needs errors well above round-off and below the first term's range: the sizes are chosen so, and
the rates of three refinements lie within 0.2 (elements) and 0.1 (steps) of the order.
"""

import numpy as np
import pytest
from scipy.optimize import brentq

import ancf
from ancf.elements.registry import ELEMENTS
from ancf.model.elements import KINDS
from ancf.system.inputs import STENCIL, differences
from helpers import SOLIDS, rate
from motions import EI, LENGTH, RHO_A, SLOW, step_rates, straight

#: Tolerances of the step errors below: Newton's share stays far under them.
EXACT = ancf.Newton(tolerance=1e-14, modified=False)


class TestElementLength:
    """Bending frequencies and the roll-up of the cable: order 4."""

    @staticmethod
    def beta_l(n):
        """Roots of cos(b) cosh(b) = -1, the clamped-free beam."""
        middle = (n - 0.5) * np.pi
        return brentq(lambda b: np.cos(b) + 1 / np.cosh(b), middle - 0.5, middle + 0.5, xtol=1e-14)

    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_cantilever_frequencies(self, strain, stretch):
        wanted = np.array([self.beta_l(n) for n in (1, 2, 3)]) ** 2 / LENGTH**2 * np.sqrt(EI / RHO_A)
        errors = []
        for elements in (8, 16):
            model, beam = straight(elements, strain)
            model.clamp(beam.start, stretch=stretch)
            got = ancf.modes(model, count=6).frequencies[::2]  # each mode twice, in y and in z
            errors.append(got / wanted - 1)
        assert np.all(np.array(errors) > 0)  # from above: the elements are stiffer than the beam
        assert np.abs(rate(errors) - 4).max() < 0.2

    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
    def test_simply_supported_frequencies(self, strain):
        wanted = (np.arange(1, 4) * np.pi / LENGTH) ** 2 * np.sqrt(EI / RHO_A)
        errors = []
        for elements in (8, 16):
            model, beam = straight(elements, strain)
            model.pin(beam.start)
            model.pin(beam.end)
            errors.append(ancf.modes(model, count=6).frequencies[::2] / wanted - 1)
        assert np.abs(rate(errors) - 4).max() < 0.2

    def test_roll_up(self):
        """An end moment of 2 pi EI/L closes the circle; of half of it, the tip stands above the wall."""
        for share in (0.5, 1.0):
            errors = []
            for elements in (12, 24, 48):
                model, beam = straight(elements)
                model.clamp(beam.start)
                model.add_moment(beam.end, (0, -2 * np.pi * share * EI / LENGTH, 0))
                tip = ancf.equilibrium(model, load_steps=8).position(beam.end)
                radius = LENGTH / (2 * np.pi * share)
                wanted = (radius * np.sin(2 * np.pi * share), 0, radius * (1 - np.cos(2 * np.pi * share)))
                errors.append(np.linalg.norm(tip - wanted))
            assert np.abs(rate(errors) - 4).max() < 0.2, share
            assert errors[-1] < 1e-4 * LENGTH


#: Of the beams: r_y is linear in the original element, which spoils the cubic r, quadratic in the other.
ORDER = {"original": 2, "nonlocking": 4}


def timoshenko(k, side, nu, factor=1.0):
    """Bending frequencies of a square simply supported beam, rad/s, with the wave numbers k, 1/m.

    EI k^4 - rhoA (1 + I/A k^2 (1 + E/(k_s G))) omega^2 + rho^2 I/(k_s G) omega^4 = 0
    """
    E_kG = 2 * (1 + nu) / factor
    radius2 = side**2 / 12  # I/A
    a, b, c = RHO_A * radius2 * RHO_A * E_kG / (EI / radius2), 1 + radius2 * k**2 * (1 + E_kG), EI * k**4
    b = b * RHO_A
    return np.sqrt((b - np.sqrt(b**2 - 4 * a * c)) / (2 * a))


@pytest.mark.parametrize("element", SOLIDS)
class TestElementLengthOfBeams:
    """Thick enough that the meshes resolve shear: then the original element does not lock."""

    @staticmethod
    def cantilever(element, elements, thick=0.4):
        """Bent far by a force and a load; only its section is held, so that it shears at the wall too."""
        model, beam = straight(elements, element=element, EA=12 * EI / thick**2)
        model.hold(beam.start, position="xyz", slope_y="xyz", slope_z="xyz")
        model.add_force(beam.end, (0, 0.2, 0.4))
        model.add_distributed_load(beam, (0, 0.1, -0.3))
        return ancf.equilibrium(model).position(beam.end)

    def test_large_deflection(self, element):
        wanted = self.cantilever("nonlocking", 96)
        errors = [np.linalg.norm(self.cantilever(element, n) - wanted) for n in (6, 12, 24)]
        assert np.linalg.norm(wanted - (LENGTH, 0, 0)) > 0.3
        assert errors[-1] > 1e-8  # far above what the finest mesh leaves
        assert rate(errors)[-1] == pytest.approx(ORDER[element], abs=0.25)

    def test_timoshenko_frequencies(self, element):
        """Simply supported; each frequency stands for the two planes."""
        side, nu = 0.15, 0.3
        wanted = timoshenko(np.arange(1, 4) * np.pi / LENGTH, side, nu)
        errors = []
        for elements in (8, 16):
            model, beam = straight(elements, element=element, EA=12 * EI / side**2, nu=nu)
            model.pin(beam.start)
            model.hold(beam.start, twist=True)
            model.hold(beam.end, position="yz")
            found = ancf.modes(model, count=14).frequencies
            errors.append([np.min(np.abs(found - w)) / w for w in wanted])
        assert np.abs(rate(errors)[-1] - ORDER[element]).max() < 0.1


FIRST_STEP = {"cable": 1e-3, "original": 5e-4, "nonlocking": 5e-4}


METHODS = {
    "trapezoidal": ancf.Trapezoidal(newton=EXACT),
    "alpha 0.9": ancf.GeneralizedAlpha(rho_inf=0.9, newton=EXACT),
    "alpha 0.5": ancf.GeneralizedAlpha(rho_inf=0.5, newton=EXACT),
}


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("stretch", ["free", "fixed"])
@pytest.mark.parametrize("method", METHODS)
class TestStep:
    """Order 2, with axial waves slow enough to be resolved by the steps."""

    def test_falling_cantilever(self, method, stretch, element):
        def build():
            strain = "paper" if element == "cable" else None
            model, beam = straight(3, strain, (0, 0, -4.0), element, **SLOW, damping=0.3)
            model.clamp(beam.start, stretch=stretch)
            return model, beam

        rates = step_rates(build, METHODS[method], FIRST_STEP[element] / 2 ** np.arange(4))
        assert rates == pytest.approx([2, 2], abs=0.1)

    def test_driven_clamp(self, method, stretch, element):
        def build():
            model, beam = straight(3, element=element, **SLOW)
            turn = {"rotation": "0.5*(1 - cos(8*t))", "axis": (0, 1, 0.2)}
            model.clamp(beam.start, stretch=stretch, displacement=["0", "0.1*sin(7*t)**3", "0"], **turn)
            return model, beam

        rates = step_rates(build, METHODS[method], FIRST_STEP[element] / 2 ** np.arange(4))
        assert rates == pytest.approx([2, 2], abs=0.1)


AMPLITUDE = 1e-4  # m; Newton's 1e-14 m is 1e-10 of it


def oscillator(method, omega_h, steps):
    """Displacements of u'' = -omega^2 u, u(0) = 1, by Chung & Hulbert's own recursion (1993)."""
    rho = method.rho_inf
    am, af = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
    gamma = 0.5 - am + af
    beta = 0.25 * (1 - am + af) ** 2
    w2 = omega_h**2  # time in steps
    left = np.array([[1, 0, -beta], [0, 1, -gamma], [(1 - af) * w2, 0, 1 - am]])
    right = np.array([[1, 1, 0.5 - beta], [0, 1, 1 - gamma], [-af * w2, 0, -am]])
    A = np.linalg.solve(left, right)
    x, path = np.array([1.0, 0.0, -w2]), [1.0]
    for _ in range(steps):
        x = A @ x
        path.append(x[0])
    return np.array(path), np.max(np.abs(np.linalg.eigvals(A)))


class TestNumericalDamping:
    """A bar in its first axial mode is a linear oscillator (material strains are linear along a line)."""

    @staticmethod
    def bar(omega_h, method, steps):
        model, beam = straight(3)
        model.clamp(beam.start)
        for x in beam.node_x[1:]:
            model.hold(beam.at(x), position="yz", slope="yz")
        modes = ancf.modes(model, count=1)
        shape, omega = modes.shapes[0], modes.frequencies[0]
        rest = modes.about
        tip = modes.position(beam.end)[0, 0]
        start = ancf.State(rest.system, 0.0, rest.q + AMPLITUDE / tip * shape, 0 * rest.q)
        step = omega_h / omega
        result = ancf.simulate(model, t_end=steps * step, step=step, start=start, integrator=method)
        return (result.position(beam.end)[:, 0] - LENGTH) / AMPLITUDE

    @pytest.mark.parametrize("rho_inf", [0.0, 0.4, 0.9, 1.0])
    @pytest.mark.parametrize("omega_h", [0.3, 3.0, 30.0])
    def test_is_chung_and_hulbert(self, rho_inf, omega_h):
        method = ancf.GeneralizedAlpha(rho_inf=rho_inf, newton=EXACT)
        wanted, _ = oscillator(method, omega_h, 30)
        assert self.bar(omega_h, method, 30) == pytest.approx(wanted, abs=1e-8)

    @pytest.mark.parametrize("rho_inf", [0.0, 0.4, 0.9, 1.0])
    def test_spectral_radius_at_high_frequency(self, rho_inf):
        """rho_inf is a double (for 0 a triple) eigenvalue: round-off splits it by its root."""
        _, radius = oscillator(ancf.GeneralizedAlpha(rho_inf=rho_inf), 1e4, 1)
        assert radius == pytest.approx(rho_inf, abs=2e-2 if rho_inf == 0 else 5e-3)

    def test_trapezoidal_rule_has_none(self):
        """Amplitude of an exact rotation of the phase: u and v/omega' stay on a circle."""
        u = self.bar(0.5, ancf.Trapezoidal(newton=EXACT), 400)
        phase = 2 * np.arctan(0.25)
        assert u == pytest.approx(np.cos(phase * np.arange(401)), abs=1e-8)


class TestRatesOfGivenMotions:
    """Rates by differences of seven points: order 6, second rates at the ends of a run order 5."""

    @staticmethod
    def of(function, step, steps=20):
        times = step * np.arange(1, steps + 1)
        return times, differences(lambda t: function(t)[:, None], times, step, 0.0, times[-1])

    @pytest.mark.parametrize("degree", range(STENCIL))
    def test_exact_for_polynomials(self, degree):
        times, (value, first, second) = self.of(lambda t: t**degree, 0.1)
        assert value[:, 0] == pytest.approx(times**degree, rel=1e-12)
        scale = 2.0 ** max(degree, 1)
        assert first[:, 0] == pytest.approx(degree * times ** max(degree - 1, 0), abs=1e-11 * scale)
        wanted = degree * (degree - 1) * times ** max(degree - 2, 0)
        assert second[:, 0] == pytest.approx(wanted, abs=1e-9 * scale)

    def test_orders(self):
        errors = []
        for step in (0.2, 0.1, 0.05):
            times, found = self.of(np.exp, step, round(2 / step))
            inner = slice(STENCIL // 2, -(STENCIL // 2))
            first, second = (np.abs(f[:, 0] / np.exp(times) - 1) for f in found[1:])
            errors.append([first[inner].max(), second[inner].max(), first.max(), second.max()])
        assert rate(errors)[-1] == pytest.approx([6, 6, 6, 5], abs=0.4)

    @pytest.mark.parametrize("last", [0.04, 0.1, 1.0, 7.3])
    @pytest.mark.parametrize("spacing", [1e-3, 1e-6, 1e-9])
    def test_round_off_beyond_the_end(self, spacing, last):
        """The last stage of a step may lie behind the end of a run by the last digit, times which is much."""
        times = np.array([np.nextafter(last, np.inf)])
        value, first, second = differences(lambda t: 3.0 * t[:, None] ** 2, times, spacing, 0.0, last)
        assert value == pytest.approx(3.0 * last**2)
        assert first == pytest.approx(6.0 * last, abs=1e-15 * last**2 / spacing * 1e2)
        assert np.isfinite(second).all()

    def test_steps_in_one_block_or_many(self):
        """Inside a run the rates do not depend on how the steps were cut into blocks."""
        times, whole = self.of(np.sin, 0.05)
        for cut in range(4, 16):
            ahead = differences(lambda t: np.sin(t)[:, None], times[:cut], 0.05, 0.0, times[-1])
            after = differences(lambda t: np.sin(t)[:, None], times[cut:], 0.05, 0.0, times[-1])
            for a, b, w in zip(ahead, after, whole, strict=True):
                assert np.concatenate([a, b]) == pytest.approx(w, abs=1e-10)

    def test_exact_rates_are_used(self):
        """A clamp turned with its exact rates gives what differences give, to their order."""
        tips = []
        for given in ({}, {"rotation_rate": "0.9*cos(3*t)", "rotation_acceleration": "-2.7*sin(3*t)"}):
            model, beam = straight(3, EA=200.0)
            model.clamp(beam.start, rotation="0.3*sin(3*t)", axis=(0, 0, 1), **given)
            tips.append(ancf.simulate(model, t_end=0.5, step=2e-3).position(beam.end))
        assert tips[0] == pytest.approx(tips[1], abs=1e-8)


@pytest.mark.parametrize("element", ELEMENTS)
class TestNewtonVariants:
    """However the equations are solved, the solution is the same, to Newton's tolerance per step."""

    @staticmethod
    def run(element, newton):
        EA = 5e3 if element == "cable" else 60.0  # thick: the step resolves the waves across the section
        model, beam = straight(6, None, (0, 0, -9.81), element, EA=EA, EI=0.05, damping=0.2)
        model.pin(beam.start)
        model.add_spring(beam.end, (LENGTH, 0.2, 0.3), stiffness=40.0, length=0.2, slack=True)
        beam.set_motion(angular_velocity=(0, 0, 5.0))
        result = ancf.simulate(model, t_end=0.3, step=5e-4, integrator=ancf.Trapezoidal(newton=newton))
        return result.position(beam.end), result.stats

    def test_agree(self, element):
        wanted, full = self.run(element, EXACT)
        for corotate in (True, False):
            got, stats = self.run(element, ancf.Newton(corotate=corotate))
            assert got == pytest.approx(wanted, abs=2e-7)
            assert stats.jacobians < 0.2 * full.jacobians

    def test_tighter_tolerance_comes_closer(self, element):
        wanted, _ = self.run(element, EXACT)
        gaps = [
            np.abs(self.run(element, ancf.Newton(tolerance=t))[0] - wanted).max() for t in (1e-6, 1e-9, 1e-12)
        ]
        assert gaps[0] > 20 * gaps[1] > 400 * gaps[2]
