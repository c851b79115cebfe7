"""The examples that control: each does what it says, against the same without its controller."""

from functools import cache

import numpy as np
import pytest
from scipy.linalg import expm

import ancf
from ancf.catenary import Mesh, statistics
from example_scripts import script


class TestCrane:
    def test_brakes_the_swing(self):
        crane = script("crane")
        held, braked = (crane.move(brakes) for brakes in (False, True))
        assert crane.swing(held, 8.0) > 1.0
        assert crane.swing(braked, 8.0) < 0.01
        assert braked.position("load")[-1, 0] == pytest.approx(crane.TARGET, abs=0.01)
        assert held.status == braked.status == "complete"

    def test_is_the_linear_crane_for_small_ways(self):
        """A short way, on which nothing saturates: the sampled linear cart with a pendulum, solved exactly.

        The rope is light, stiff and hangs straight but for its own mass, 0.9 of 15 kg.
        """
        crane = script("crane")
        crane.TARGET = 0.02
        model = crane.build()
        start = ancf.equilibrium(crane.build(locked=True))
        given = {"t_end": 2.0, "step": 2e-3, "start": start, "control_step": crane.CONTROL_STEP}
        found = ancf.simulate(model, controller=crane.controller(crane.TARGET), output_step=0.02, **given)
        K, length = crane.gains(), -start.position("load")[2]
        whole = np.zeros((5, 5))  # x, x', d, d', u
        whole[0, 1] = whole[2, 3] = 1.0
        whole[1, 2] = crane.LOAD * crane.G / (length * crane.TROLLEY)
        whole[3, 2] = -crane.G / length * (1 + crane.LOAD / crane.TROLLEY)
        whole[1, 4], whole[3, 4] = 1 / crane.TROLLEY, -1 / crane.TROLLEY
        over, state, way = expm(whole * crane.CONTROL_STEP), np.zeros(5), [0.0]
        for _ in range(100):
            state[4] = -K @ (state[:4] - [crane.TARGET, 0, 0, 0])
            state = over @ state
            way.append(state[0])
        gap = np.abs(found.position("trolley")[:, 0] - way).max()
        assert gap < 0.05 * crane.TARGET
        assert np.ptp(way) > 0.5 * crane.TARGET

    def test_steps_one_by_one(self):
        """The same bits from a program of its own."""
        crane = script("crane")
        whole = crane.move(t_end=1.0)
        push = crane.controller()
        run = ancf.stepper(crane.build(), step=crane.STEP, start=ancf.equilibrium(crane.build(locked=True)))
        for _ in range(45):
            push(run)
            run.advance(round(crane.CONTROL_STEP / crane.STEP))
        assert np.array_equal(run.q, whole.q[45])


SHORT = {"mesh": Mesh(contact=2.0, messenger=3.0), "step": 2e-3}


@cache
def alone(**given):
    """The pantograph without its controller."""
    return script("active_pantograph").passage(**given)


class TestPantograph:
    def test_lowers_the_deviation(self, request):
        """On a coarse mesh in the short form; with --slow as the example does, without it."""
        active_pantograph = script("active_pantograph")
        given = {} if request.config.getoption("--slow") else SHORT
        passive = statistics(alone(**given))
        controller = active_pantograph.PID(wanted=passive["mean_force"].value)
        active = statistics(active_pantograph.passage(controller, **given))
        assert active["deviation"].value < 0.93 * passive["deviation"].value
        assert active["mean_force"].value == pytest.approx(passive["mean_force"].value, rel=0.02)

    def test_without_gains_it_is_the_passive_one(self):
        active_pantograph = script("active_pantograph")
        passive, idle = (
            alone(**SHORT),
            active_pantograph.passage(active_pantograph.PID(120.0, (0.0, 0.0, 0.0)), **SHORT),
        )
        assert idle.recordings[0].force == pytest.approx(passive.recordings[0].force, abs=1e-3)


class TestEnvironment:
    """The crane for Gymnasium; its own checker looks at spaces, seeds and types."""

    @pytest.fixture
    def env(self):
        pytest.importorskip("gymnasium")
        return script("crane_env").CraneEnv(duration=1.0)

    @pytest.mark.filterwarnings("ignore")  # of the checker, about spaces without bounds
    def test_is_one(self, env):
        from gymnasium.utils.env_checker import check_env

        check_env(env, skip_render_check=True)

    def test_the_regulator_beats_doing_nothing_and_noise(self, env):
        crane = script("crane")
        K, rng = crane.gains(), np.random.default_rng(2)

        def total(policy):
            seen, _ = env.reset(options={"target": 0.3})
            rewards, over = 0.0, False
            while not over:
                seen, reward, failed, late, info = env.step(np.array([policy(seen)], np.float32))
                rewards, over = rewards + reward, failed or late
            assert info["t"] == pytest.approx(1.0)
            return rewards

        led = total(lambda seen: np.clip(-K @ seen / crane.MOST, -1, 1))
        assert led > total(lambda seen: 0.0)
        assert led > total(lambda seen: rng.uniform(-1, 1))
