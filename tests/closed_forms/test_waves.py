"""Waves of linear theory: dispersion, spectra, kinematics by hyperbolic functions, forces, orders."""

from itertools import pairwise

import numpy as np
import pytest

import ancf
from ancf.batches import Batches
from ancf.loads.waves import RATE, RISE, SPEED, sea_at, tables
from ancf.model.surroundings.waves import wave_numbers
from ancf.system.core import residual
from ancf.system.system import System

G = 9.81
SHARED = {"diameter": 0.08, "drag": (1.2, 0.1), "added_mass": (0.9, 0.2)}
SECTION = ancf.Section(EA=1e5, EI=10.0, rhoA=12.0, **SHARED)


def kinds(depth=None, **more):
    regular = ancf.Waves.regular(1.4, 6.0, phase=0.7, depth=depth, **more)
    sea = ancf.Waves.jonswap(1.4, 6.0, seed=3, components=21, depth=depth, **more)
    return {"regular": regular, "sea": sea}


def moored(waves, elements=4, velocity=(0.4, 0, 0)):
    model = ancf.Model(gravity=(0, 0, -G))
    model.add_fluid("water", 1025.0, velocity=velocity, below=0.0, waves=waves)
    rope = model.add_beam(
        "rope", start=(0, 0, -9), end=(8, 1, -0.5), length=12.5, elements=elements, section=SECTION
    )
    model.pin(rope.start)
    model.pin(rope.end)
    return model, rope


def asked(waves, t, r, level=0.0):
    """Velocity, acceleration and rise by the kernel."""
    model = ancf.Model(gravity=(0, 0, -G))
    fluid = model.add_fluid("water", 1025.0, below=level, waves=waves)
    given = tables([fluid], model.gravity)
    kept = np.zeros(11)
    sea_at(given["sea"][0], given["wave"], 0, given["waves"][1], given["angle"], t, *r, kept)
    return kept[SPEED:RATE], kept[RATE:RISE], kept[RISE]


def linear_theory(waves, t, r, level=0.0):
    """The same by hyperbolic functions, for a wave that has grown."""
    k, h, w, A = waves.numbers(G), waves.depth, waves.omega, waves.amplitude
    along = np.array([np.cos(waves.direction), np.sin(waves.direction), 0.0])
    psi = k * (along @ r) - w * t + waves.phase
    eta = float(A @ np.cos(psi))
    z = r[2] - level
    if waves.stretching == "wheeler":
        z = z - eta if np.isinf(h) else h * (z - eta) / (h + eta)
    z = min(z, 0.0)
    if np.isinf(h):
        ch = sh = np.exp(k * z)
    else:
        ch, sh = np.cosh(k * (z + h)) / np.sinh(k * h), np.sinh(k * (z + h)) / np.sinh(k * h)
    u, up = A * w * ch @ np.cos(psi), A * w * sh @ np.sin(psi)
    du, dup = A * w * w * ch @ np.sin(psi), -A * w * w * sh @ np.cos(psi)
    return u * along + [0, 0, up], du * along + [0, 0, dup], eta


class TestDispersion:
    @pytest.mark.parametrize("depth", [0.5, 3.0, 20.0, 300.0, np.inf])
    def test_is_fulfilled(self, depth):
        omega = 2 * np.pi / np.geomspace(1.0, 60.0, 40)
        k = wave_numbers(omega, depth, G)
        assert np.allclose(omega**2, G * k * np.tanh(np.minimum(k * depth, 300.0)), rtol=1e-12)
        assert np.all(k > 0)

    def test_of_a_manual(self):
        """Shore protection manual (1984), example 2-2: 10 s in 3 m of water has 53.0 m."""
        assert 2 * np.pi / wave_numbers(np.array([2 * np.pi / 10.0]), 3.0, G)[0] == pytest.approx(
            53.0, abs=0.2
        )


class TestSpectrum:
    @pytest.mark.parametrize("gamma", [1.0, 2.0, 3.3, 5.0])
    def test_height_and_zero_crossings(self, gamma):
        """T_z/T_p by the fit of DNV-RP-C205 (2010), section 3.5.5; the tail above six peaks is left out."""
        waves = ancf.Waves.jonswap(2.0, 9.0, gamma=gamma, components=1000)
        m0, m2 = (0.5 * waves.amplitude**2 @ waves.omega**n for n in (0, 2))
        assert 4 * np.sqrt(m0) == pytest.approx(2.0, rel=1e-12)
        fitted = 0.6673 + 0.05037 * gamma - 0.006230 * gamma**2 + 0.0003341 * gamma**3
        assert 2 * np.pi * np.sqrt(m0 / m2) / 9.0 == pytest.approx(fitted, rel=0.02)

    @pytest.mark.parametrize("make", [ancf.Waves.jonswap, ancf.Waves.pierson_moskowitz])
    def test_surface_has_its_height(self, make):
        waves = make(3.0, 8.0, seed=11)
        eta = waves.elevation(np.arange(10.0, 40_000.0, 0.7))
        assert 4 * eta.std() == pytest.approx(3.0, rel=0.03)
        assert eta.mean() == pytest.approx(0.0, abs=0.01)

    def test_seeds(self):
        one, again, other = (ancf.Waves.jonswap(1.0, 5.0, seed=seed).phase for seed in (1, 1, 2))
        assert np.array_equal(one, again)
        assert not np.any(one == other)

    def test_without_enhancement_it_is_the_other(self):
        one, other = ancf.Waves.jonswap(1, 5, gamma=1), ancf.Waves.pierson_moskowitz(1, 5)
        assert np.array_equal(one.omega, other.omega)


@pytest.mark.parametrize("name", ["regular", "sea"])
class TestKinematics:
    @pytest.mark.parametrize("depth", [4.0, 25.0, None])
    @pytest.mark.parametrize("direction", [0.0, 2.1, -0.6])
    @pytest.mark.parametrize("stretching", ["wheeler", "none"])
    def test_by_hyperbolic_functions(self, name, depth, direction, stretching):
        height = min(1.4, 0.2 * (depth or 10))
        given = {"direction": direction, "depth": depth, "stretching": stretching}
        more = {} if name == "regular" else {"seed": 3, "components": 21}
        make = ancf.Waves.regular if name == "regular" else ancf.Waves.jonswap
        waves = make(height, 6.0, **given, **more)
        for k, z in enumerate((-3.9, -1.0, -0.2, 0.0, 0.3)):
            r, t = np.array([3.0 * k, 2.0 - k, 2.0 + z]), 6.0 + 11.3 * k
            for found, wanted in zip(asked(waves, t, r, 2.0), linear_theory(waves, t, r, 2.0), strict=True):
                assert np.allclose(found, wanted, rtol=1e-11, atol=1e-13)

    @pytest.mark.parametrize("depth", [5.0, None])
    def test_no_source_no_rotation_and_the_surface_moves_with_it(self, name, depth):
        waves, e = kinds(depth, stretching="none", direction=0.4)[name], 1e-4
        t, r = 20.3, np.array([4.0, -2.0, -1.3])
        ways = [asked(waves, t, r + d)[0] - asked(waves, t, r - d)[0] for d in e * np.eye(3)]
        gradient = np.array(ways) / (2 * e)
        assert np.trace(gradient) == pytest.approx(0.0, abs=1e-8)
        assert np.allclose(gradient, gradient.T, atol=1e-8)
        r[2] = 0.0
        rising = (asked(waves, t + e, r)[2] - asked(waves, t - e, r)[2]) / (2 * e)
        assert rising == pytest.approx(asked(waves, t, r)[0][2], abs=1e-7)

    @pytest.mark.parametrize("t", [0.5, 2.9, 5.5, 9.0])
    def test_acceleration_is_the_rate_of_the_velocity_while_it_grows(self, name, t):
        waves, e, r = kinds(12.0, stretching="none")[name], 1e-4, np.array([1.0, 5.0, -2.0])
        rate = (asked(waves, t + e, r)[0] - asked(waves, t - e, r)[0]) / (2 * e)
        assert np.allclose(asked(waves, t, r)[1], rate, atol=1e-7)

    def test_calm_at_the_start(self, name):
        waves = kinds()[name]
        for part in (*asked(waves, 0.0, (1, 2, -0.5)), *asked(waves, -3.0, (1, 2, -0.5))):
            assert not np.any(part)

    def test_surface_in_python_is_that_of_the_kernel(self, name):
        waves = kinds(8.0, direction=0.3)[name]
        times = np.array([0.0, 2.0, 7.7, 30.0])
        given = waves.elevation(times, 3.0, -1.0)
        assert np.allclose(given, [asked(waves, t, (3.0, -1.0, 0.0))[2] for t in times], atol=1e-13)

    def test_deep_water_is_calm(self, name):
        u, du, _ = asked(kinds()[name], 30.0, (0.0, 0.0, -2000.0))
        assert np.all(np.abs(u) < 1e-10)
        assert np.all(np.abs(du) < 1e-10)

    def test_below_the_bottom_is_as_at_it(self, name):
        waves = kinds(6.0, stretching="none")[name]
        at, under = (asked(waves, 17.0, (1.0, 0.0, z)) for z in (-6.0, -7.0))
        assert np.array_equal(at[0], under[0])
        assert at[0][2] == pytest.approx(0.0, abs=1e-14)


class TestForces:
    @pytest.mark.parametrize("name", ["regular", "sea"])
    @pytest.mark.parametrize("direction", [0.0, 1.0])
    def test_by_morison_on_a_short_rod(self, name, direction):
        """Froude-Krylov, added mass and drag of a rod that is short against the waves."""
        waves, r, t = kinds(20.0, direction=direction)[name], np.array([2.0, -3.0, -1.5]), 15.0
        model = ancf.Model(gravity=(0, 0, -G))
        model.add_fluid("water", 1025.0, velocity=(0.3, 0.1, 0.0), below=0.0, waves=waves)
        axis = np.array([0.6, 0.0, 0.8])
        model.add_beam("rod", start=r, end=r + 0.01 * axis, elements=1, section=SECTION)
        system = System(model)
        q, v = system.initial_state(t)
        system.place(t, q, np.zeros_like(q), np.zeros_like(q))
        f = np.zeros(system.size)
        residual(Batches((system.parts["fluid"],)), system.core.ws, q, v, v, np.zeros(system.size), f)
        slots = system.slots["rod"][:, 0]
        found = -np.array([f[slots + c].sum() for c in range(3)]) / 0.01
        u, du, _ = linear_theory(waves, t, r + 0.005 * axis)
        past = u + np.array([0.3, 0.1, 0.0])
        P, d = np.eye(3) - np.outer(axis, axis), 0.08
        n, along = P @ past, axis @ past
        drag = 512.5 * d * (1.2 * np.linalg.norm(n) * n + np.pi * 0.1 * abs(along) * along * axis)
        area = np.pi * d * d / 4
        inertia = 1025.0 * area * (du + 0.9 * P @ du + 0.2 * (axis @ du) * axis)
        assert np.allclose(found, drag + inertia + [0, 0, 1025.0 * area * G], rtol=1e-5)

    def test_what_is_wet_follows_the_surface(self):
        """Buoyancy of an upright rod as the crest and the trough of a long wave pass."""
        waves = ancf.Waves.regular(2.0, 30.0, ramp=0.0)
        bare = ancf.Section(EA=1e9, EI=1e5, rhoA=12.0, diameter=0.08, drag=(0.0, 0.0))
        for t, rise in ((0.0, 1.0), (15.0, -1.0)):
            model = ancf.Model(gravity=(0, 0, -G))
            model.add_fluid("water", 1025.0, below=0.0, waves=waves)
            rod = model.add_beam("rod", start=(0, 0, -4), end=(0, 0, 3), elements=14, section=bare)
            held = model.clamp(rod.start)
            lost = 12.0 * G * 7 - ancf.equilibrium(model, time=t).reaction(held)[2]
            wet = np.linspace(-4.0, rise, 4001)
            carried = np.array([G + linear_theory(waves, t, np.array([0, 0, z]))[1][2] for z in wet])
            force = 1025.0 * np.pi * 0.0016 * np.trapezoid(carried, wet)
            assert lost == pytest.approx(force, rel=2e-3)


class TestFluidAbove:
    """Air over waves: where it begins is where the water ends."""

    @staticmethod
    def force(above, t, place=2.0, below=0.0):
        model = ancf.Model(gravity=(0, 0, -G))
        section = ancf.Section(EA=1e5, EI=10.0, rhoA=12.0, diameter=0.08, drag=(0.0, 0.0))
        rod = model.add_beam("rod", start=(place, 0, -4), end=(place, 0, 3), elements=7, section=section)
        model.add_fluid("water", 1025.0, below=below, waves=kinds(15.0, ramp=0.0)["sea"])
        if above:
            model.add_fluid("air", 1.2 * above, above=0.0)
        system = System(model)
        q, zero = system.initial_shape(t), np.zeros(system.size)
        r = np.zeros(system.size)
        system.place(t, q, zero.copy(), zero.copy())
        residual((system.parts["fluid"],), system.core.ws, q, zero, zero, zero, r)
        return -sum(r[system.slots[rod.name][:, 0] + 2])

    @pytest.mark.parametrize("t", [0.3, 1.7, 4.4])
    @pytest.mark.parametrize("place", [0.0, 2.0])
    def test_what_the_air_carries_is_above_the_waves(self, t, place):
        rise = kinds(15.0, ramp=0.0)["sea"].elevation(t, place)[0]
        assert abs(rise) > 0.01
        more = self.force(50.0, t, place) - self.force(0.0, t, place)
        assert more == pytest.approx(60.0 * np.pi * 0.0016 * G * (3.0 - rise), rel=1e-9)

    def test_one_that_begins_elsewhere_stays_level(self):
        """With a gap between water and air nothing ties them."""
        more = self.force(50.0, 1.7, below=-0.5) - self.force(0.0, 1.7, below=-0.5)
        assert more == pytest.approx(60.0 * np.pi * 0.0016 * G * 3.0, rel=1e-9)

    def test_waves_on_both_sides_are_refused(self):
        model, _ = moored(kinds()["regular"])
        oil = ancf.Waves.regular(0.5, 4.0)
        model.add_fluid("oil", 900.0, above=0.0, below=5.0, waves=oil)
        with pytest.raises(ancf.ModelError, match=r'oil: has waves of its own and below it those of "water"'):
            System(model)


class TestMotion:
    @pytest.mark.parametrize("integrator", [ancf.Trapezoidal(), ancf.GeneralizedAlpha(0.8)])
    @pytest.mark.parametrize("name", ["regular", "sea"])
    def test_order_two(self, integrator, name):
        model, rope = moored(kinds(15.0)[name])
        start = ancf.equilibrium(model)

        def at(step, method=integrator):
            result = ancf.simulate(model, t_end=4.0, step=step, start=start, integrator=method)
            return result.position(rope.at(5.0))[-1]

        found = [at(step) for step in (0.02, 0.01, 0.005, 0.0025)]
        changes = [np.linalg.norm(a - b) for a, b in pairwise(found)]
        orders = np.log2(np.divide(changes[:-1], changes[1:]))
        assert np.all(np.abs(orders - 2.0) < 0.15)
        exact = at(0.01, ancf.Radau(tolerance=1e-8))
        assert np.linalg.norm(found[-1] - exact) < 0.4 * changes[-1]

    def test_equilibrium_is_that_of_calm_water(self):
        calm, waving = moored(None)[0], moored(kinds()["sea"])[0]
        assert np.array_equal(ancf.equilibrium(calm).q, ancf.equilibrium(waving).q)
        grown = moored(kinds(ramp=0.0)["sea"])[0]
        assert not np.allclose(ancf.equilibrium(calm).q, ancf.equilibrium(grown).q, atol=1e-6)

    def test_continued_run_has_the_same_bits(self, tmp_path):
        model, rope = moored(kinds()["sea"])
        whole = ancf.simulate(model, t_end=2.0, step=0.02, start=ancf.equilibrium(model))
        file = tmp_path / "part.h5"
        ancf.simulate(model, t_end=0.74, step=0.02, start=ancf.equilibrium(model), file=file)
        assert np.array_equal(ancf.resume(file, t_end=2.0).position(rope.end), whole.position(rope.end))
        assert np.array_equal(ancf.load(file).q[-1], whole.q[-1])

    def test_saving_changes_nothing(self, tmp_path):
        model, rope = moored(kinds()["sea"])
        one = ancf.simulate(model, t_end=1.0, step=0.02, start=ancf.equilibrium(model))
        run = ancf.stepper(model, step=0.02, start=ancf.equilibrium(model))
        for _ in range(5):
            run.advance(10)
            run.save(tmp_path / "now.h5")
        assert np.array_equal(run.position(rope.at(5.0)), one.position(rope.at(5.0))[-1])


@pytest.mark.parametrize("depth", [None, 15.0])
@pytest.mark.parametrize("kind", ["regular", "sea"])
@pytest.mark.parametrize("stretching", ["wheeler", "none"])
@pytest.mark.parametrize("direction", [0.0, 2.1])
class TestQuestions:
    """Waves are asked for velocities and accelerations, in Python."""

    def test_as_in_a_run(self, depth, kind, stretching, direction):
        """Also while they grow, above the surface and at the bottom."""
        waves = kinds(depth, stretching=stretching, direction=direction, ramp=8.0)[kind]
        for place in ((0.0, 0.0, -3.0), (7.0, -4.0, 0.2), (-20.0, 9.0, -14.9)):
            for t in (0.0, 3.3, 50.0):
                v, a, _ = asked(waves, t, np.array(place))
                assert waves.velocity(t, *place)[0] == pytest.approx(v, abs=1e-12)
                assert waves.acceleration(t, *place)[0] == pytest.approx(a, abs=1e-12)

    def test_rates_and_continuity(self, depth, kind, stretching, direction):
        """Far below the surface: accelerations are rates, the water keeps its volume and does not turn."""
        waves = kinds(depth, stretching="none", direction=direction, ramp=0.0)[kind]
        times, place, h = np.linspace(3.0, 40.0, 25), np.array([5.0, -2.0, -4.0]), 1e-5
        rate = (waves.velocity(times + h, *place) - waves.velocity(times - h, *place)) / (2 * h)
        assert waves.acceleration(times, *place) == pytest.approx(rate, abs=1e-8)
        grad = np.stack(
            [
                (waves.velocity(times, *(place + e)) - waves.velocity(times, *(place - e))) / (2 * h)
                for e in h * np.eye(3)
            ],
            axis=-1,
        )
        assert np.trace(grad, axis1=1, axis2=2) == pytest.approx(np.zeros(25), abs=1e-8)
        assert grad == pytest.approx(grad.transpose(0, 2, 1), abs=1e-8)
