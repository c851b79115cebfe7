"""Time stepping: where steps and outputs fall, going on from a state, retries, counters."""

import contextlib

import numpy as np
import pytest

import ancf
from ancf.elements.registry import ELEMENTS
from ancf.errors import Interrupted
from ancf.results import Progress
from helpers import arc, square
from motions import pendulum


class TestTimes:
    @pytest.mark.parametrize(
        ("t_end", "step", "output_step", "wanted"),
        [
            (0.01, 0.002, None, [0, 0.002, 0.004, 0.006, 0.008, 0.01]),
            (0.01, 0.004, None, [0, 0.004, 0.008, 0.01]),  # the last step is shorter
            (0.01, 0.01, None, [0, 0.01]),
            (0.01, 0.001, 0.003, [0, 0.003, 0.006, 0.009, 0.01]),  # the end is always stored
            (0.01, 0.001, 0.005, [0, 0.005, 0.01]),
            (0.01, 0.003, 0.006, [0, 0.006, 0.01]),
            (0.01, 0.001, 0.5, [0, 0.01]),
            (0.3, 0.1, None, [0, 0.1, 0.2, 0.3]),  # 3 * 0.1 > 0.3 in floating point
            (0.01, np.float64(0.005), np.float32(0.005), [0, 0.005, 0.01]),
        ],
    )
    def test_stored(self, t_end, step, output_step, wanted):
        model, beam = pendulum()
        result = ancf.simulate(model, t_end=t_end, step=step, output_step=output_step)
        assert result.t == pytest.approx(wanted, abs=1e-15)
        assert result.position(beam.end).shape == (len(wanted), 3)
        assert result.tension(beam.end).shape == (len(wanted),)
        assert result.stats.steps == int(np.ceil(t_end / step - 1e-6))

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_output_is_a_part_of_every_step(self, element):
        """Also over blocks of steps, which grow, and with a shorter last step."""
        model, _ = pendulum(element=element)
        every = ancf.simulate(model, t_end=1.0003, step=5e-4)
        some = ancf.simulate(model, t_end=1.0003, step=5e-4, output_step=3.5e-3)
        rows = np.append(np.arange(0, 2001, 7), 2001)
        assert some.t == pytest.approx(every.t[rows], abs=1e-14)
        assert np.array_equal(some.q[:], every.q[rows])
        assert some.energy.dissipated == pytest.approx(every.energy.dissipated[rows], rel=1e-12)

    def test_first_state_is_the_initial_one(self):
        model, beam = pendulum()
        result = ancf.simulate(model, t_end=0.01, step=1e-3)
        assert result.position(beam.at(0.3))[0] == pytest.approx((0.3, 0, 0))
        assert result.velocity(beam.at(0.3))[0] == pytest.approx((0, 0.6, 0))


class TestGoingOn:
    @pytest.mark.parametrize("method", [ancf.Trapezoidal(), ancf.GeneralizedAlpha(rho_inf=0.8)])
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_split_run_is_the_whole_run(self, method, element):
        """Newton's tolerance; the algorithmic acceleration of generalised alpha starts anew: order 2."""
        model, beam = pendulum(element=element, EA=100.0)
        model.add_force(beam.end, ["0", "0.5*sin(9*t)", "0"])
        given = {"step": 1e-3, "integrator": method}
        whole = ancf.simulate(model, t_end=0.4, **given)
        first = ancf.simulate(model, t_end=0.15, **given)
        second = ancf.simulate(model, t_end=0.4, start=first.state(), **given)
        assert second.t[[0, -1]] == pytest.approx([0.15, 0.4])
        bar = 1e-8 if isinstance(method, ancf.Trapezoidal) else 1e-4
        assert second.position(beam.end) == pytest.approx(whole.position(beam.end)[150:], abs=bar)

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_from_any_stored_state(self, element):
        model, beam = pendulum(element=element)
        whole = ancf.simulate(model, t_end=0.2, step=1e-3)
        again = ancf.simulate(model, t_end=0.2, step=1e-3, start=whole.state(50))
        assert again.t[0] == pytest.approx(0.05)
        assert again.position(beam.end)[-1] == pytest.approx(whole.position(beam.end)[-1], abs=1e-8)

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_driven_support(self, element):
        """A moving clamp goes on where it was."""
        model, beam = pendulum(element=element, EA=200.0)
        beam.set_motion()
        given = {"elements": 3, "section": beam.section, "element": element}
        other = model.add_beam("other", start=(0, 1, 0), end=(1, 1, 0), **given)
        model.clamp(other.start, rotation="0.4*sin(5*t)", displacement=["0", "0.1*t**2", "0"])
        whole = ancf.simulate(model, t_end=0.3, step=1e-3)
        half = ancf.simulate(model, t_end=0.12, step=1e-3)
        second = ancf.simulate(model, t_end=0.3, step=1e-3, start=half.state())
        assert second.position(other.end)[-1] == pytest.approx(whole.position(other.end)[-1], abs=1e-7)

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_start_is_not_changed(self, element):
        model, _ = pendulum(element=element)
        state = ancf.equilibrium(model)
        q, v = state.q.copy(), state.v.copy()
        ancf.simulate(model, t_end=0.1, step=1e-3, start=state)
        assert np.array_equal(state.q, q)
        assert np.array_equal(state.v, v)

    def test_model_may_change_between(self):
        """A load that is added after the equilibrium acts in the simulation: plucking a cable."""
        model, beam = pendulum()
        state = ancf.equilibrium(model)
        before = state.position(beam.end)
        model.add_force(beam.end, (0, 1.0, 0))
        result = ancf.simulate(model, t_end=0.02, step=1e-3, start=state)
        assert result.position(beam.end)[-1, 1] > before[1] + 1e-5

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_new_supports_and_another_order_of_nodes(self, element):
        """What is connected and held since then changes the unknowns, not the shape."""
        model, beam = pendulum(element=element)
        given = {"elements": 5, "section": beam.section, "element": element}
        other = model.add_beam("other", start=(0, 0, -2), end=(1, 0, -2), **given)
        model.clamp(other.start)
        model.clamp(other.end)
        old = ancf.simulate(model, t_end=0.1, step=1e-3).state()
        for x in (0.2, 0.8):
            model.add_spring(beam.at(x), other.at(1 - x), stiffness=1.0)
        model.clamp(beam.end, rotation=lambda t: 0.3 * (t - 0.1), axis=(0, 0, 1))
        new = ancf.simulate(model, t_end=0.11, step=1e-3, start=old).state(0)
        for point in ("beam.at(0.3)", "beam.at(0.6)", "other.at(0.5)"):
            assert new.position(point) == pytest.approx(old.position(point), abs=1e-14)
            assert new.velocity(point) == pytest.approx(old.velocity(point), abs=1e-12)
        assert not np.array_equal(new.system.slots["beam"], old.system.slots["beam"])

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_modes_of_the_model_as_it_is_now(self, element):
        """A spring added after the equilibrium stiffens the model."""
        model, beam = pendulum(element=element)
        state = ancf.equilibrium(model)
        before = ancf.modes(model, about=state, count=4).frequencies
        above = state.position(beam.end) + np.array([0, 1, 0])
        model.add_spring(beam.end, above, stiffness=100.0, length=1.0)
        after = ancf.modes(model, about=state, count=4).frequencies
        before, after = (found[found > 1e-2] for found in (before, after))  # a beam may also spin
        assert np.all(after > before - 1e-9)
        assert after[1] > 1.05 * before[1]

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_released_load(self, element):
        """The equilibrium of one model is the start of another one with the same bodies."""
        loaded, beam = pendulum(element=element, EI=5.0)
        loaded.add_force(beam.end, (3.0, 0, 0))
        free, other = pendulum(element=element, EI=5.0)
        beam.set_motion()
        state = ancf.equilibrium(loaded)
        result = ancf.simulate(free, t_end=0.05, step=1e-3, start=state)
        assert result.position(other.end)[0] == pytest.approx(state.position(beam.end))
        assert np.linalg.norm(result.position(other.end)[-1] - result.position(other.end)[0]) > 1e-3


class TestRepeatable:
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_same_run_twice(self, element):
        model, _ = pendulum(element=element)
        one, two = (ancf.simulate(model, t_end=0.2, step=1e-3) for _ in range(2))
        assert np.array_equal(one.q[:], two.q[:])
        assert one.stats.newton_iterations == two.stats.newton_iterations

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_model_is_not_changed(self, element):
        model, _ = pendulum(element=element)
        before = model.to_dict()
        ancf.simulate(model, t_end=0.05, step=1e-3)
        ancf.equilibrium(model)
        ancf.modes(model, count=2, about=ancf.equilibrium(model))
        assert model.to_dict() == before


class TestCounters:
    def test_modified_newton(self):
        """Two to four iterations a step, few Jacobians; a full method makes one for each iteration."""
        model, _ = pendulum()
        stats = ancf.simulate(model, t_end=0.5, step=1e-3).stats
        assert stats.steps == 500
        assert 1 <= stats.newton_iterations / stats.steps < 6
        assert 1 <= stats.jacobians == stats.factorizations < 50
        assert stats.retries == 0
        assert 0 < stats.cpu_seconds < 5

    def test_full_newton(self):
        model, _ = pendulum()
        method = ancf.Trapezoidal(newton=ancf.Newton(modified=False))
        stats = ancf.simulate(model, t_end=0.1, step=1e-3, integrator=method).stats
        assert stats.jacobians >= stats.newton_iterations - stats.steps

    def test_as_dict(self):
        model, _ = pendulum()
        stats = ancf.simulate(model, t_end=0.01, step=1e-3).stats
        keys = {"steps", "newton_iterations", "jacobians", "factorizations", "retries", "cpu_seconds"}
        assert set(stats.as_dict()) == keys
        assert stats.as_dict()["steps"] == 10

    def test_linear_problem_needs_one_jacobian(self):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=100.0, EI=0.1, rhoA=0.4)
        beam = model.add_beam("beam", start=(0, 0, 0), end=(0, 0, -1), elements=3, section=section)
        model.pin(beam.start)
        stats = ancf.simulate(model, t_end=0.2, step=1e-3).stats
        assert stats.jacobians == 1


class TestRetry:
    """A step that fails is halved, and the run goes on with the step it was given."""

    @staticmethod
    def impact(max_iterations):
        """A rope that jerks tight, with hardly enough iterations to take that in one step."""
        model = ancf.Model()
        section = ancf.Section(EA=2e3, EI=0.1, rhoA=0.4)
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
        beam.set_motion(velocity=(10.0, 0, 0), angular_velocity=(0, 0, 3.0))
        model.add_spring(beam.end, (1.5, 0.5, 0), stiffness=2e6, length=0.9, slack=True)
        method = ancf.Trapezoidal(newton=ancf.Newton(max_iterations=max_iterations))
        return ancf.simulate(model, t_end=0.3, step=2e-3, integrator=method), beam

    def halved(self):
        """The run with the fewest iterations allowed that gets through, and it needs some halving."""
        for max_iterations in range(3, 9):
            with contextlib.suppress(ancf.SolveError):
                result, beam = self.impact(max_iterations)
                if result.stats.retries > 0:
                    return result, beam
        pytest.fail("no run had a step halved")

    def test_goes_on_with_the_step_given(self):
        result, beam = self.halved()
        assert result.status == "complete"
        assert result.stats.steps == 150
        assert result.t == pytest.approx(2e-3 * np.arange(151))
        assert np.all(np.isfinite(result.q[:]))
        assert np.all(np.isfinite(result.position(beam.end)))

    def test_all_is_stored(self):
        """Every step is a state of its own, those that were halved too."""
        result, beam = self.halved()
        speed = np.linalg.norm(result.velocity(beam.end), axis=1)
        moved = np.linalg.norm(np.diff(result.position(beam.end), axis=0), axis=1)
        assert np.all(moved > 0)
        assert np.all(moved <= 2e-3 * 2 * (speed.max() + 1))


class TestProgress:
    def test_reports(self):
        model, _ = pendulum(elements=16)
        seen = []
        ancf.simulate(model, t_end=1.0, step=2e-4, progress=seen.append, output_step=0.1)
        assert all(isinstance(p, Progress) for p in seen)
        steps = [p.step for p in seen]
        assert steps == sorted(set(steps))
        assert seen[-1] == Progress(step=5000, steps=5000, t=1.0, t_end=1.0)
        assert [p.t for p in seen] == pytest.approx([2e-4 * n for n in steps])
        assert len(seen) < 100  # about ten times a second

    def test_interrupt_keeps_what_is_there(self):
        model, beam = pendulum()

        def stop(progress):
            if progress.t > 0.05:
                raise KeyboardInterrupt

        with pytest.raises(Interrupted) as caught:
            ancf.simulate(model, t_end=5.0, step=1e-3, progress=stop)
        result = caught.value.result
        assert isinstance(caught.value, KeyboardInterrupt)
        assert result.status == "interrupted"
        assert result.t[-1] > 0.05
        assert result.stats.steps == len(result.t) - 1
        assert np.all(np.isfinite(result.position(beam.end)))
        whole = ancf.simulate(model, t_end=result.t[-1], step=1e-3)
        assert np.array_equal(whole.q[:], result.q[:])

    def test_interrupt_in_a_file(self, tmp_path):
        model, _ = pendulum()

        def stop(progress):
            raise KeyboardInterrupt

        with pytest.raises(Interrupted) as caught:
            ancf.simulate(model, t_end=5.0, step=1e-3, progress=stop, file=tmp_path / "run.h5")
        assert caught.value.result.status == "interrupted"
        assert len(ancf.load(tmp_path / "run.h5").t) > 1


class TestRest:
    """Nothing happens to what is at rest and unloaded: round-off must not be taken for a failure."""

    @pytest.mark.parametrize("free", [True, False])
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_straight(self, free, element):
        model, beam = pendulum(element=element)
        model.gravity[:] = 0.0
        beam.set_motion()
        if free:
            model.supports.clear()
        result = ancf.simulate(model, t_end=0.5, step=1e-3)
        assert result.position(beam.at(0.7)) == pytest.approx(np.tile((0.7, 0, 0), (501, 1)), abs=1e-12)

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_until_a_load_comes(self, element):
        """A straight cable without weight, pushed from t = 0.2 s on."""
        model, beam = pendulum(element=element)
        model.gravity[:] = 0.0
        beam.set_motion()
        model.add_force(beam.end, lambda t: (0, 0, 1.0 * (t >= 0.2)))
        z = ancf.simulate(model, t_end=0.4, step=1e-3).position(beam.end)[:, 2]
        assert np.max(np.abs(z[:200])) < 1e-12
        assert z[-1] > 0.01

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_until_a_support_moves(self, element):
        model, beam = pendulum(element=element)
        model.gravity[:] = 0.0
        beam.set_motion()
        model.pin(beam.end, displacement=lambda t: (0, 0, 5.0 * max(t - 0.2, 0.0) ** 3))
        z = ancf.simulate(model, t_end=0.4, step=1e-3).position(beam.end)[:, 2]
        assert np.max(np.abs(z[:200])) < 1e-12
        assert z[-1] == pytest.approx(0.04, abs=1e-12)


@pytest.mark.parametrize("element", ELEMENTS)
def test_curved_start_at_rest_stays(element):
    """No load, no motion: nothing moves; the natural shape of a curved cable is rounded off by 1e-8."""
    model = ancf.Model()
    section = square(element, EA=2e3, EI=0.1, rhoA=0.4)
    beam = model.add_beam("beam", path=arc, elements=4, section=section, element=element)
    model.clamp(beam.start)
    result = ancf.simulate(model, t_end=0.2, step=1e-3)
    assert result.position(beam.end) == pytest.approx(np.tile(arc(1.0), (201, 1)), abs=1e-6)
