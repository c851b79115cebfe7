"""Radau IIA: orders with and without constraints, step control, outputs, energies, failures.

The stepping knows nothing of a System: it is tested on a pendulum with a rod, once as a mass with a
constraint of index 3 and once as a bead that slides on a circle, whose place on it has no mass.
"""

from functools import partial

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.sparse import csc_array

import ancf
from ancf.errors import Interrupted, ModelError, SolveError
from ancf.model.integrators import integrator_of
from ancf.paper import cantilever
from ancf.solvers.radau.collocation import collocation
from ancf.solvers.radau.method import OK, Matrices, Stepper
from helpers import rate
from motions import SLOW, driven_clamp, falling_cantilever, pendulum, step_rates, straight

G, MASS, ANGLE, T_END = 9.81, 2.0, 1.2, 1.5


def dense(*matrices):
    return Matrices(*(csc_array(np.array(m, float)) for m in matrices))


class Rod:
    """x, z and a multiplier: x^2 + z^2 = 1."""

    multipliers = np.array([2])
    weight = np.array([1.0, 1.0, 0.0])

    def residuals(self, t, q, v, a):
        x, z, lam = q.T
        rows = (MASS * a[:, 0] + 2 * x * lam, MASS * (a[:, 1] + G) + 2 * z * lam, x * x + z * z - 1)
        return np.stack(rows, axis=1)

    def matrices(self, t, q, v):
        x, z, lam = q
        K = [[2 * lam, 0, 2 * x], [0, 2 * lam, 2 * z], [2 * x, 2 * z, 0]]
        return dense(np.diag([MASS, MASS, 0]), np.zeros((3, 3)), K)

    def start(self):
        x, z = np.sin(ANGLE), -np.cos(ANGLE)
        lam = -0.5 * MASS * G * z
        a = (-2 * x * lam / MASS, -2 * z * lam / MASS - G, 0.0)
        return np.array([x, z, lam]), np.zeros(3), np.array(a)

    def multiplier(self, angle, rate):
        return 0.5 * MASS * (rate**2 + G * np.cos(angle))


class Bead:
    """x, z, the angle s on the circle, and two multipliers: (x, z) = (sin s, -cos s); s has no mass."""

    multipliers = np.array([3, 4])
    weight = np.array([1.0, 1.0, 1.0, 0.0, 0.0])

    def residuals(self, t, q, v, a):
        x, z, s, lx, lz = q.T
        sin, cos = np.sin(s), np.cos(s)
        push = (MASS * a[:, 0] + lx, MASS * (a[:, 1] + G) + lz, -(cos * lx + sin * lz))
        return np.stack([*push, x - sin, z + cos], axis=1)

    def matrices(self, t, q, v):
        lx, lz = q[3:]
        sin, cos = np.sin(q[2]), np.cos(q[2])
        K = np.zeros((5, 5))
        K[0, 3] = K[3, 0] = K[1, 4] = K[4, 1] = 1.0
        K[2, 2] = sin * lx - cos * lz
        K[2, 3:] = K[3:, 2] = -cos, -sin
        return dense(np.diag([MASS, MASS, 0, 0, 0]), np.zeros((5, 5)), K)

    def start(self):
        sin, cos = np.sin(ANGLE), np.cos(ANGLE)
        swing = -G * sin
        a = np.array([cos * swing, sin * swing, swing, 0, 0])
        force = (-MASS * a[0], -MASS * (a[1] + G))
        return np.array([sin, -cos, ANGLE, *force]), np.zeros(5), a


def exact(t):
    """Position, velocity, angle and its rate of the pendulum."""
    given = {"method": "DOP853", "rtol": 1e-13, "atol": 1e-14}
    angle, rate = solve_ivp(lambda _, y: (y[1], -G * np.sin(y[0])), (0, t), (ANGLE, 0), **given).y[:, -1]
    at, along = np.array([np.sin(angle), -np.cos(angle)]), np.array([np.cos(angle), np.sin(angle)])
    return at, rate * along, angle, rate


def steps_of(problem, stages, n):
    """The stepper after n constant steps to T_END."""
    stepper = Stepper(problem, stages, 1e-6, 1e-13, T_END)
    stepper.start(0.0, *problem.start())
    for k in range(n):
        status, step = stepper.solve(T_END / n, False)
        assert status == OK
        stepper.accept(step, (k + 1) * T_END / n)
    return stepper


def adaptive(problem, stages, tolerance):
    """The stepper after steps of its own choice to T_END."""
    stepper, h = Stepper(problem, stages, tolerance, 1e-13, T_END), 1e-3
    stepper.start(0.0, *problem.start())
    while stepper.t < T_END:
        left = T_END - stepper.t
        status, step = stepper.solve(min(h, left), True)
        assert status == OK
        error = stepper.error(step)
        h = stepper.next_size(step.h, error)
        if error < 1:
            stepper.accept(step, T_END if step.h == left else stepper.t + step.h)
        else:
            stepper.counts.retries += 1
    return stepper


class TestCoefficients:
    @pytest.mark.parametrize("stages", [2, 3])
    def test_quadrature(self, stages):
        """Exact for polynomials of degree 2s - 2, the stages for degree s - 1; not for one more."""
        m = collocation(stages)
        for k in range(2 * stages):
            error = abs(m.b @ m.c**k - 1 / (k + 1))
            assert (error < 1e-14) == (k < 2 * stages - 1), k
        for k in range(stages):
            assert m.a @ m.c**k == pytest.approx(m.c ** (k + 1) / (k + 1), abs=1e-14)

    @pytest.mark.parametrize("stages", [2, 3])
    def test_modes(self, stages):
        m, x = collocation(stages), np.arange(1.0, stages + 1)
        assert (m.from_modes @ (m.to_modes @ x)).real == pytest.approx(x, abs=1e-13)
        assert (m.from_modes @ (m.mu * (m.to_modes @ x))).real == pytest.approx(m.a @ x, abs=1e-13)

    @pytest.mark.parametrize("stages", [2, 3])
    def test_error_formula(self, stages):
        """It is zero for motions up to degree s, not for the next one."""
        m = collocation(stages)
        for k in range(1, stages + 2):
            error = m.gamma * (k == 1) + m.e @ m.c**k
            assert (abs(error) < 1e-13) == (k <= stages), k

    @pytest.mark.parametrize("stages", [2, 3])
    def test_integrals(self, stages):
        m, tau = collocation(stages), np.linspace(0, 2, 9)
        for k in range(stages):
            value, once, twice = (f @ m.c**k for f in m.integrals(tau))
            assert value == pytest.approx(tau**k, abs=1e-12)
            assert once == pytest.approx(tau ** (k + 1) / (k + 1), abs=1e-12)
            assert twice == pytest.approx(tau ** (k + 2) / ((k + 1) * (k + 2)), abs=1e-12)


@pytest.mark.parametrize("problem", [Rod(), Bead()], ids=["rod", "bead"])
@pytest.mark.parametrize("stages", [2, 3])
class TestIndex3:
    def test_orders(self, problem, stages):
        """2s - 1 in positions, s in velocities, s - 1 in multipliers."""
        at, v, angle, speed = exact(T_END)
        up, errors = np.array([0.0, G]), []
        for n in (32, 64, 128):
            stepper = steps_of(problem, stages, n)
            found = [np.abs(stepper.q[:2] - at).max(), np.abs(stepper.v[:2] - v).max()]
            if isinstance(problem, Rod):
                found.append(abs(stepper.q[2] - problem.multiplier(angle, speed)))
            else:
                found.append(np.hypot(*(stepper.q[3:] + MASS * (self.acceleration(angle, speed) + up))))
            errors.append(found)
        assert rate(errors)[-1] == pytest.approx([2 * stages - 1, stages, stages - 1], abs=0.15)

    @staticmethod
    def acceleration(angle, speed):
        along, inward = np.array([np.cos(angle), np.sin(angle)]), np.array([-np.sin(angle), np.cos(angle)])
        return -G * np.sin(angle) * along + speed**2 * inward

    def test_constraint_holds(self, problem, stages):
        stepper = steps_of(problem, stages, 32)
        r = problem.residuals(np.array([T_END]), stepper.q[None], stepper.v[None], stepper.a[None])[0]
        assert np.abs(r[problem.multipliers[0] :]).max() < 1e-12

    def test_tolerance_is_met(self, problem, stages):
        """The error at the end stays below the tolerance of a step and follows it."""
        at, _, _, _ = exact(T_END)
        for tolerance in (1e-4, 1e-6, 1e-8):
            stepper = adaptive(problem, stages, tolerance)
            assert 1e-5 * tolerance < np.abs(stepper.q[:2] - at).max() < 2 * tolerance
            assert stepper.counts.retries < 0.25 * stepper.counts.steps
        # error per step ~ h^(s + 1)
        few = adaptive(problem, stages, 1e-4).counts.steps
        assert stepper.counts.steps / few == pytest.approx(10 ** (4 / (stages + 1)), rel=0.35)

    def test_dense_output(self, problem, stages):
        """One step from exact values, in its middle: one order less than a step has in the positions."""
        errors = []
        for h in (0.1, 0.05, 0.025):
            stepper = Stepper(problem, stages, 1e-6, 1e-13, T_END)
            stepper.start(0.0, *problem.start())
            status, step = stepper.solve(h, False)
            assert status == OK
            q, v, _ = step.at(np.array([0.4, 1.0]))
            assert q[1] == pytest.approx(step.Q[-1], abs=1e-13)
            assert v[1] == pytest.approx(step.V[-1], abs=1e-12)
            errors.append(np.abs(q[0, :2] - exact(0.4 * h)[0]).max())
        assert np.all(rate(errors) > stages + 0.8)


@pytest.mark.parametrize(("stages", "steps"), [(2, (4e-3, 2e-3, 1e-3)), (3, (0.016, 0.008, 0.004))])
class TestCableOrders:
    """Rates of positions and velocities together, with constant steps."""

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_falling_cantilever(self, stages, steps, stretch):
        rates = step_rates(
            partial(falling_cantilever, stretch), ancf.Radau(stages=stages, adaptive=False), steps
        )
        assert rates == pytest.approx([2 * stages - 1], abs=0.1)

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_driven_clamp(self, stages, steps, stretch):
        rates = step_rates(partial(driven_clamp, stretch), ancf.Radau(stages=stages, adaptive=False), steps)
        assert rates == pytest.approx([2 * stages - 1], abs=0.1)


def falling(**given):
    """Example 7.1 with four elements; its tip."""
    model = cantilever.build(4)
    result = ancf.simulate(model, t_end=0.4, output_step=0.01, **given)
    return result, result.position("beam.end")


@pytest.fixture(scope="module")
def fine():
    return falling(step=1e-4, integrator=ancf.Radau(tolerance=1e-9))[1]


class TestExample71:
    @pytest.mark.parametrize("stages", [2, 3])
    def test_tolerance_is_met(self, fine, stages):
        steps = []
        for tolerance in (1e-3, 1e-5, 1e-7):
            result, tip = falling(step=1e-3, integrator=ancf.Radau(stages=stages, tolerance=tolerance))
            assert result.t == pytest.approx(0.01 * np.arange(41), abs=1e-15)
            assert np.abs(tip - fine).max() < tolerance
            steps.append(result.stats.steps)
        assert steps[0] < 0.5 * steps[1] < 0.25 * steps[2]

    def test_trapezoidal_rule_agrees_to_its_order(self, fine):
        errors = [np.abs(falling(step=step)[1] - fine).max() for step in (2e-4, 1e-4)]
        assert errors[1] < 2e-6
        assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)

    def test_energy_and_counters(self):
        """The energy that is lost, of 0.36 J that are exchanged, falls with the tolerance."""
        coarse, result = (falling(step=1e-3, integrator=ancf.Radau(tolerance=t))[0] for t in (1e-5, 1e-7))
        lost = [np.ptp(r.energy.balance) for r in (coarse, result)]
        assert lost[0] < 1e-6
        assert lost[1] < 0.02 * lost[0]
        stats = result.stats
        assert stats.factorizations == 2 * stats.jacobians
        assert stats.jacobians < 0.3 * stats.steps
        assert stats.newton_iterations < 4 * (stats.steps + stats.retries)
        assert stats.cpu_seconds > 0

    def test_thin_cable(self):
        """f = 0.1: axial waves that steps do not resolve are damped away, the tolerance is met."""
        model = cantilever.build(4, 0.1)
        given = {"t_end": 0.2, "output_step": 0.01}
        loose = ancf.simulate(model, step=1e-3, integrator=ancf.Radau(tolerance=1e-4), **given)
        wanted = ancf.simulate(model, step=1e-5, **given)
        assert loose.stats.steps < 500  # the fastest wave has 1600 periods
        assert np.abs(loose.position("beam.end") - wanted.position("beam.end")).max() < 1e-4


def driven():
    """Everything that does work: damping, a force, a moment, a moving clamp."""
    model, beam = straight(3, "material", (0, 0, -4.0), **SLOW, damping=0.2, axial_damping=0.05)
    turn = {"rotation": "0.5*(1 - cos(8*t))", "axis": (0, 1, 0.2)}
    model.clamp(beam.start, displacement=["0", "0.1*sin(7*t)**3", "0"], **turn)
    model.add_force(beam.end, ["0", "0.05*sin(15*t)", "0"])
    model.add_moment(beam.end, (0, "1e-3*sin(20*t)", 0))
    return model, beam


class TestEnergy:
    def test_work_is_that_of_other_methods(self):
        """Also at outputs between the steps, which are far longer than those of the output."""
        given = {"t_end": 0.3, "step": 2e-4}
        wanted = ancf.simulate(driven()[0], **given).energy
        result = ancf.simulate(driven()[0], integrator=ancf.Radau(), **given)
        assert result.stats.steps < 400 < len(result.t)
        energy = result.energy
        assert wanted.supplied[-1] > 0.01
        assert wanted.dissipated[-1] > 1e-3
        assert energy.supplied == pytest.approx(wanted.supplied, abs=1e-6)
        assert energy.dissipated == pytest.approx(wanted.dissipated, abs=1e-6)
        assert np.ptp(energy.balance) < 2e-7

    @pytest.mark.parametrize("stages", [2, 3])
    def test_balance_has_the_order(self, stages):
        drift = []
        for step in (16e-3, 8e-3) if stages == 3 else (8e-3, 4e-3):
            method = ancf.Radau(stages=stages, adaptive=False)
            drift.append(
                np.ptp(ancf.simulate(driven()[0], t_end=0.24, step=step, integrator=method).energy.balance)
            )
        assert rate(drift)[0] > 2 * stages - 1.5


class TestOutput:
    @pytest.mark.parametrize("is_adaptive", [True, False])
    @pytest.mark.parametrize(
        ("t_end", "step", "output_step", "wanted"),
        [
            (0.01, 0.002, None, [0, 0.002, 0.004, 0.006, 0.008, 0.01]),
            (0.01, 0.004, None, [0, 0.004, 0.008, 0.01]),
            (0.01, 0.01, None, [0, 0.01]),
            (0.01, 0.001, 0.003, [0, 0.003, 0.006, 0.009, 0.01]),
            (0.01, 0.001, 0.5, [0, 0.01]),
            (0.03, 0.01, None, [0, 0.01, 0.02, 0.03]),
        ],
    )
    def test_times(self, is_adaptive, t_end, step, output_step, wanted):
        model, _ = pendulum(EA=50.0)
        method = ancf.Radau(adaptive=is_adaptive)
        result = ancf.simulate(model, t_end=t_end, step=step, output_step=output_step, integrator=method)
        assert result.t == pytest.approx(wanted, abs=1e-15)
        assert result.t[-1] == t_end
        assert len(result.q) == len(result.v) == len(result.energy.supplied) == len(wanted)
        if not is_adaptive:
            assert result.stats.steps == int(np.ceil(t_end / step - 1e-6))

    def test_between_steps(self):
        """Few long steps, many outputs: positions, velocities and given motions are right in between."""
        given = {"t_end": 0.3, "step": 1e-3}
        fine = ancf.simulate(driven()[0], integrator=ancf.Radau(tolerance=1e-10), **given)
        result = ancf.simulate(driven()[0], integrator=ancf.Radau(tolerance=1e-5), **given)
        assert result.stats.steps < 100
        for point in ("beam.start", "beam.at(0.5)", "beam.end"):
            assert result.position(point) == pytest.approx(fine.position(point), abs=1e-5)
            assert result.velocity(point) == pytest.approx(fine.velocity(point), abs=1e-3)
        clamp = 0.1 * np.sin(7 * result.t) ** 3
        assert result.position("beam.start")[:, 1] == pytest.approx(clamp, abs=1e-13)

    @pytest.mark.parametrize("is_adaptive", [True, False])
    @pytest.mark.parametrize(("t_end", "every"), [(0.06, 1), (0.06, 4), (0.05, 7), (0.03, 200)])
    def test_samples_are_the_states_where_both_are_stored(self, is_adaptive, t_end, every):
        """To the last bit, also at an end that is no whole output step; between them is a smooth way."""
        model, beam = pendulum(EA=100.0)
        result = ancf.simulate(
            model, t_end=t_end, step=1e-3, output_step=1e-3 * every, sensors=[beam.end],
            integrator=ancf.Radau(adaptive=is_adaptive),
        )  # fmt: skip
        sensors, count = result.sensors, round(1e3 * t_end)
        assert sensors.t == pytest.approx(1e-3 * np.arange(count + 1), abs=1e-15)
        places = [min(k * every, count) for k in range(len(result.t))]
        for ask in ("position", "velocity"):
            assert np.array_equal(getattr(sensors, ask)(beam.end)[places], getattr(result, ask)(beam.end))
        way = np.diff(sensors.position(beam.end), axis=0)
        mean = 0.5e-3 * (sensors.velocity(beam.end)[1:] + sensors.velocity(beam.end)[:-1])
        assert way == pytest.approx(mean, abs=2e-3 * np.abs(mean).max())

    def test_going_on(self):
        model, beam = pendulum(EA=100.0)
        given = {"step": 1e-3, "integrator": ancf.Radau(tolerance=1e-8)}
        whole = ancf.simulate(model, t_end=0.4, **given)
        first = ancf.simulate(model, t_end=0.15, **given)
        second = ancf.simulate(model, t_end=0.4, start=first.state(), **given)
        assert second.position(beam.end) == pytest.approx(whole.position(beam.end)[150:], abs=1e-8)

    def test_file(self, tmp_path):
        given = {"t_end": 0.1, "step": 1e-3, "integrator": ancf.Radau(stages=2, tolerance=1e-5)}
        kept = ancf.simulate(pendulum()[0], **given)
        ancf.simulate(pendulum()[0], file=tmp_path / "run.h5", **given)
        read = ancf.load(tmp_path / "run.h5")
        assert np.array_equal(read.q[:], kept.q[:])
        assert read.stats.as_dict() | {"cpu_seconds": 0} == kept.stats.as_dict() | {"cpu_seconds": 0}
        settings = read.provenance["settings"]
        assert settings["integrator"] == "radau"
        assert settings["radau"]["tolerance"] == 1e-5

    def test_progress(self):
        model, _ = pendulum(elements=16)
        seen = []
        given = {"t_end": 0.5, "step": 2e-4, "output_step": 0.1}
        ancf.simulate(model, progress=seen.append, integrator=ancf.Radau(adaptive=False), **given)
        steps = [p.step for p in seen]
        assert steps == sorted(set(steps))
        assert all(p.steps == 2500 and abs(p.t - 2e-4 * p.step) < 2e-4 for p in seen)


class TestStepControl:
    def test_rest_takes_few_steps(self):
        model, beam = pendulum()
        model.gravity[:] = 0.0
        beam.set_motion()
        result = ancf.simulate(model, t_end=0.5, step=1e-3, integrator=ancf.Radau())
        assert result.stats.steps < 20
        assert result.position(beam.end) == pytest.approx(np.tile((1, 0, 0), (501, 1)), abs=1e-12)

    def test_sudden_load(self):
        """A force that jumps within a step costs rejected steps, not accuracy."""

        def push(t):
            return (0, 0, 1.0 * (t >= 0.2003))

        ends = []
        for given in ({"integrator": ancf.Radau()}, {"integrator": ancf.Radau(tolerance=1e-9)}):
            model, beam = pendulum()
            model.gravity[:] = 0.0
            beam.set_motion()
            model.add_force(beam.end, push)
            result = ancf.simulate(model, t_end=0.4, step=1e-3, **given)
            ends.append(result.position(beam.end))
            assert result.stats.retries > 3
        assert np.abs(ends[0][:200, 2]).max() < 1e-12
        assert ends[0][-1, 2] > 0.01
        assert ends[0] == pytest.approx(ends[1], abs=2e-6)

    def test_longest_step(self):
        model, _ = pendulum(EA=20.0)
        for most in (2e-3, 1e-3):
            method = ancf.Radau(tolerance=1e-2, max_step=most)
            stats = ancf.simulate(model, t_end=0.1, step=1e-2, integrator=method).stats
            assert stats.steps == pytest.approx(0.1 / most, abs=2)

    def test_slack_spring(self):
        """An impact: the energy is kept and finer tolerances agree."""
        ends = []
        for tolerance in (1e-5, 1e-7):
            model, beam = pendulum()
            model.add_spring(beam.end, (1.5, 0.5, 0), stiffness=2e4, length=0.9, slack=True)
            method = ancf.Radau(tolerance=tolerance)
            result = ancf.simulate(model, t_end=0.3, step=2e-3, integrator=method)
            assert np.ptp(result.energy.balance) < 1e-4
            ends.append(result.position(beam.end))
        assert ends[0] == pytest.approx(ends[1], abs=1e-4)


def test_from_a_model_file():
    given = {"type": "radau", "stages": 2, "tolerance": 1e-5, "max_step": 0.01}
    assert integrator_of(given) == ancf.Radau(2, 1e-5, max_step=0.01)
    assert integrator_of("radau") == ancf.Radau()


class TestFailures:
    def test_no_smaller_step(self):
        """A load that jumps needs a step below the smallest one."""
        model, beam = pendulum()
        model.add_force(beam.end, lambda t: (0, 0, 5.0 * (t >= 0.2003)))
        with pytest.raises(SolveError) as caught:
            ancf.simulate(model, t_end=0.3, step=2e-3, integrator=ancf.Radau(min_step=1e-4))
        error = caught.value
        assert error.where.startswith("t = 0.2")
        assert "beam node" in error.where
        assert "times the tolerance" in error.what
        assert "min_step" in error.hint
        assert error.result.status == "failed"
        assert 0.19 < error.result.t[-1] < 0.2003
        assert np.all(np.isfinite(error.result.q[:]))

    def test_constant_steps_that_are_far_too_long(self):
        model, _ = pendulum(EA=1e7)
        with pytest.raises(SolveError, match=r"had to be halved|did not converge") as caught:
            ancf.simulate(model, t_end=2, step=0.1, integrator=ancf.Radau(adaptive=False))
        assert np.all(np.isfinite(caught.value.result.q[:]))

    def test_function_of_time_that_fails(self):
        model, beam = pendulum()
        model.add_force(beam.end, lambda t: (0, 0, 1.0 if t < 0.1 else float("nan")))
        with pytest.raises(ModelError, match="must be finite") as caught:
            ancf.simulate(model, t_end=0.2, step=1e-3, integrator=ancf.Radau())
        assert 0.08 < caught.value.result.t[-1] <= 0.1
        assert np.all(np.isfinite(caught.value.result.q[:]))

    def test_interrupt(self):
        model, _ = pendulum(elements=16)

        def stop(progress):
            if progress.t > 2e-3:  # a busy machine may not have got anywhere yet
                raise KeyboardInterrupt

        with pytest.raises(Interrupted) as caught:
            ancf.simulate(model, t_end=50.0, step=1e-3, progress=stop, integrator=ancf.Radau())
        result = caught.value.result
        assert result.status == "interrupted"
        assert len(result.t) > 1
        assert result.t == pytest.approx(1e-3 * np.arange(len(result.t)))

    @pytest.mark.parametrize(
        ("given", "where"),
        [
            ({"stages": 1}, "Radau.stages"),
            ({"stages": 2.0}, "Radau.stages"),
            ({"tolerance": 0.0}, "Radau.tolerance"),
            ({"tolerance": float("nan")}, "Radau.tolerance"),
            ({"adaptive": 1}, "Radau.adaptive"),
            ({"min_step": -1.0}, "Radau.min_step"),
            ({"max_step": "1 ms"}, "Radau.max_step"),
            ({"min_step": 1e-3, "max_step": 1e-4}, "Radau.min_step"),
            ({"max_step": 1e-3, "adaptive": False}, "Radau.max_step"),
        ],
    )
    def test_settings(self, given, where):
        with pytest.raises(ModelError) as caught:
            ancf.Radau(**given)
        assert caught.value.where == where
