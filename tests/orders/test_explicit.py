"""Central differences: order 2, the stable step, what happens above it."""

from functools import partial

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError, SolveError
from ancf.model.integrators import integrator_of
from ancf.paper import cantilever
from ancf.solvers.explicit.stability import lanczos, limit
from ancf.system.system import System
from helpers import rate
from motions import SLOW, driven_clamp, falling_cantilever, pendulum, step_rates, straight


class TestOrder:
    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_falling_cantilever(self, stretch):
        assert step_rates(partial(falling_cantilever, stretch), ancf.Explicit()) == pytest.approx(
            [2, 2], abs=0.1
        )

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_driven_clamp(self, stretch):
        """With free stretch the local axes turn, and the mass matrix with them."""

        assert step_rates(partial(driven_clamp, stretch), ancf.Explicit()) == pytest.approx([2, 2], abs=0.1)

    def test_damping_and_loads(self):
        """Forces that depend on the velocity see its prediction: the order stays."""

        def build():
            more = {"axial_damping": 0.1, "bending_damping": 1e-4}
            model, beam = straight(3, "material", (0, 0, -4.0), **SLOW, **more)
            model.clamp(beam.start)
            model.add_moment(beam.end, (0, "0.02*sin(20*t)", 0))
            model.add_force(beam.end, ["0", "0.05*sin(15*t)**2", "0"])
            return model, beam

        assert step_rates(build, ancf.Explicit()) == pytest.approx([2, 2], abs=0.1)


class TestAgainstImplicit:
    def test_example_71(self):
        """Both have order 2, so their difference has; energies of both agree."""
        gaps, drifts = [], []
        for step in (1e-4, 5e-5):
            runs = [
                ancf.simulate(cantilever.build(4), t_end=0.4, step=step, output_step=0.01, integrator=method)
                for method in (ancf.Trapezoidal(), ancf.Explicit())
            ]
            one, two = (r.position("beam.end") for r in runs)
            gaps.append(np.abs(one - two).max())
            drifts.append(np.ptp(runs[1].energy.balance))
        assert gaps[1] < 5e-7
        assert rate(gaps) == pytest.approx([2], abs=0.2)
        assert drifts[1] < 1e-7  # J, of 0.36 exchanged
        assert rate(drifts) == pytest.approx([2], abs=0.3)
        stats = runs[1].stats
        assert stats.steps == 8000
        assert stats.newton_iterations == stats.jacobians == stats.factorizations == stats.retries == 0

    def test_work(self):
        """Damping, a force and a moving clamp do the same work."""
        energies = []
        for method in (ancf.Trapezoidal(), ancf.Explicit()):
            model, beam = straight(3, "material", (0, 0, -4.0), **SLOW, damping=0.2)
            model.clamp(beam.start, rotation="0.5*(1 - cos(8*t))", axis=(0, 1, 0.2))
            model.add_force(beam.end, ["0", "0.05*sin(15*t)", "0"])
            energies.append(ancf.simulate(model, t_end=0.3, step=2e-4, integrator=method).energy)
        one, two = energies
        assert one.supplied[-1] > 0.01
        assert one.dissipated[-1] > 1e-3
        assert two.supplied == pytest.approx(one.supplied, abs=2e-6)
        assert two.dissipated == pytest.approx(one.dissipated, abs=2e-6)

    def test_going_on(self):
        model, beam = pendulum(EA=100.0)
        given = {"step": 2e-4, "integrator": ancf.Explicit()}
        whole = ancf.simulate(model, t_end=0.4, **given)
        first = ancf.simulate(model, t_end=0.15, **given)
        second = ancf.simulate(model, t_end=0.4, start=first.state(), **given)
        assert second.position(beam.end) == pytest.approx(whole.position(beam.end)[750:], abs=1e-6)

    def test_last_step_is_shorter(self):
        model, _ = pendulum(EA=100.0)
        result = ancf.simulate(model, t_end=0.0101, step=2e-4, output_step=2e-3, integrator=ancf.Explicit())
        assert result.t == pytest.approx([0, 0.002, 0.004, 0.006, 0.008, 0.01, 0.0101])


def bar(elements, **section):
    """A bar that moves along its axis only, and its fastest frequency: linear with material strains."""
    model, beam = straight(elements, **section)
    model.clamp(beam.start)
    for x in beam.node_x[1:]:
        model.hold(beam.at(x), position="yz", slope="yz")
    free = 2 * elements + 1
    return model, ancf.modes(model, count=free).frequencies[-1]


class TestStableStep:
    @pytest.mark.parametrize("elements", [1, 4, 16, 48])
    def test_is_that_of_the_fastest_mode(self, elements):
        model = cantilever.build(elements)
        system = System(model)
        drawn = ancf.State(system, 0.0, *system.initial_state())
        omega = ancf.modes(model, about=drawn, count=len(system.free)).frequencies[-1]
        assert ancf.stable_step(model) == pytest.approx(0.9 * 2 / omega, rel=2e-3)
        assert ancf.stable_step(model, safety=1.0) <= 2 / omega * (1 + 1e-9)

    def test_taut_cable(self):
        """About a state in which springs and tension add stiffness; slack ones do not count."""
        model, beam = pendulum(EA=50.0, EI=1.0)
        beam.set_motion()
        model.pin(beam.end)
        free = ancf.stable_step(model)
        model.add_spring(beam.at(0.5), (0.5, 0, 1.0), stiffness=3e5, length=0.999, slack=True)
        state = ancf.equilibrium(model)
        count = len(state.system.free)
        omega = ancf.modes(model, about=state, count=count).frequencies[-1]
        assert ancf.stable_step(model, about=state) == pytest.approx(0.9 * 2 / omega, rel=3e-3)
        assert ancf.stable_step(model) < 0.6 * free

    @pytest.mark.parametrize("elements", [4, 16])
    def test_stable_at_it_unstable_above(self, elements):
        """Example 7.1 over 2000 steps: the energy stays, or the run ends in an error."""
        model = cantilever.build(elements)
        step = ancf.stable_step(model)
        run = {"t_end": 2000 * step, "integrator": ancf.Explicit(check=False)}
        energy = ancf.simulate(model, step=step, **run).energy
        assert np.ptp(energy.balance) < 1e-3 * np.abs(energy.potential).max()
        with pytest.raises(SolveError) as caught:
            ancf.simulate(model, step=1.2 * step, **run)
        assert "stable_step" in caught.value.hint
        assert caught.value.result.status == "failed"
        assert np.all(np.isfinite(caught.value.result.q[:]))

    @staticmethod
    def growth(model, step, steps):
        """Largest over first amplitude of a run that starts in the fastest mode of a bar."""
        modes = ancf.modes(model, count=7)
        rest = modes.about
        start = ancf.State(rest.system, 0.0, rest.q + 1e-9 * modes.shapes[-1], 0 * rest.q)
        given = {"t_end": steps * step, "step": step, "start": start}
        try:
            result = ancf.simulate(model, integrator=ancf.Explicit(check=False), **given)
        except SolveError as error:  # it has grown too far
            result = error.result
        moved = np.abs(result.q[:] - rest.q).max(axis=1)
        return (moved / moved[0]).max()

    def test_sharp_for_a_bar(self):
        """Vibrations of the fastest mode: bounded 2 % below the limit, growing 2 % above it."""
        model, omega = bar(3)
        assert self.growth(model, 0.98 * 2 / omega, 200) < 1.01
        assert self.growth(model, 1.02 * 2 / omega, 200) > 1e4

    @pytest.mark.parametrize("axial_damping", [0.02, 5.0])
    def test_damped_bar(self, axial_damping):
        """The damping lowers the limit; still bounded just below it, growing just above it."""
        model, omega = bar(3, axial_damping=axial_damping)
        step = ancf.stable_step(model, safety=1.0)
        assert step < 0.996 * 2 / omega
        assert self.growth(model, 0.97 * step, 300) < 1.5
        assert self.growth(model, 1.03 * step, 300) > 1e4

    def test_limit_without_damping(self):
        assert limit(100.0, 0.0) == 0.02
        assert limit(0.0, 0.0) == np.inf
        assert limit(100.0, 1e-9) == pytest.approx(0.02, rel=1e-6)
        assert limit(0.0, 50.0) == pytest.approx(0.02, rel=1e-6)

    def test_lanczos(self):
        """Largest eigenvalue of a pencil, also with a start that cannot be seen and for n = 1."""
        rng = np.random.default_rng(3)
        for n in (1, 2, 40, 200):
            A, B = rng.standard_normal((2, n, n))
            K, M = A @ A.T, B @ B.T + n * np.eye(n)
            wanted = np.linalg.eigvals(np.linalg.solve(M, K)).real.max()
            got = lanczos(lambda x, K=K: K @ x, lambda r, M=M: np.linalg.solve(M, r), n)
            assert wanted * (1 - 1e-9) <= got <= wanted * (1 + 3e-3)


class TestTooLarge:
    def test_refused_at_the_start(self, tmp_path):
        model = cantilever.build(4)
        stable = ancf.stable_step(model)
        given = {"t_end": 0.1, "step": 1.2 * stable, "file": tmp_path / "run.h5"}
        with pytest.raises(ModelError) as caught:
            ancf.simulate(model, integrator=ancf.Explicit(), **given)
        error = caught.value
        assert error.where == "simulate.step"
        assert f"{1.2 * stable:g} s" in error.what
        assert f"{stable:.4g} s" in error.what
        assert "output_step" in error.hint
        assert not (tmp_path / "run.h5").exists()

    def test_stops_when_the_cable_gets_stiffer(self, monkeypatch):
        """A force that stretches a cable to twice its length; the paper's strain stiffens it."""
        monkeypatch.setattr("ancf.solvers.explicit.run.RARE_STEPS", 0)
        monkeypatch.setattr("ancf.solvers.explicit.run.RARE_WIDE", 0)
        model, beam = straight(4, "paper", EA=100.0, EI=1e-3, damping=1.0)
        model.pin(beam.start)
        model.add_force(beam.end, ["1000*ramp(t, 0, 0.2)", "0", "0"])
        step = ancf.stable_step(model)
        with pytest.raises(SolveError, match="the step is no longer stable") as caught:
            ancf.simulate(model, t_end=0.5, step=step, integrator=ancf.Explicit())
        assert "largest stable one" in caught.value.what
        result = caught.value.result
        assert 0 < result.t[-1] < 0.4
        assert np.all(np.isfinite(result.q[:]))

    def test_estimate_follows_the_run(self, monkeypatch):
        """With the step of the stretched cable the same run goes through."""
        monkeypatch.setattr("ancf.solvers.explicit.run.RARE_STEPS", 0)
        monkeypatch.setattr("ancf.solvers.explicit.run.RARE_WIDE", 0)
        model, beam = straight(4, "paper", EA=100.0, EI=1e-3, damping=1.0)
        model.pin(beam.start)
        model.add_force(beam.end, ["1000*ramp(t, 0, 0.2)", "0", "0"])
        step = 0.1 * ancf.stable_step(model)
        result = ancf.simulate(
            model, t_end=0.3, step=step, output_step=100 * step, integrator=ancf.Explicit()
        )
        assert result.position(beam.end)[-1, 0] > 2


def test_from_a_model_file():
    given = {"type": "explicit", "safety": 0.5, "check": False}
    assert integrator_of(given) == ancf.Explicit(0.5, False)


class TestBadInput:
    def test_multipliers(self):
        model = cantilever.build(2)
        model.connect(model.add_point_mass("bob", at=(0.7, 0, 0), mass=1.0), "beam.at(0.7)")
        with pytest.raises(ModelError, match="constraints with multipliers") as caught:
            ancf.simulate(model, t_end=0.1, step=1e-5, integrator=ancf.Explicit())
        assert caught.value.where == "simulate.integrator"
        assert "Radau" in caught.value.hint

    @pytest.mark.parametrize("safety", [0.0, -1.0, 1.1, float("nan"), "0.9", None])
    def test_safety(self, safety):
        for refuse in (ancf.Explicit, lambda safety: ancf.stable_step(cantilever.build(2), safety=safety)):
            with pytest.raises(ModelError) as caught:
                refuse(safety=safety)
            assert caught.value.where == "Explicit.safety"

    def test_check(self):
        with pytest.raises(ModelError, match="True or False"):
            ancf.Explicit(check="no")

    def test_about(self):
        with pytest.raises(ModelError, match="must be a State"):
            ancf.stable_step(cantilever.build(2), about=3)
        with pytest.raises(ModelError, match="another model"):
            ancf.stable_step(cantilever.build(2), about=ancf.equilibrium(cantilever.build(3)))

    def test_function_of_time_that_fails(self):
        model, beam = pendulum()
        model.add_force(beam.end, lambda t: (0, 0, 1.0 if t < 0.1 else float("nan")))
        with pytest.raises(ModelError, match="must be finite") as caught:
            ancf.simulate(model, t_end=0.2, step=5e-4, integrator=ancf.Explicit(), output_step=1e-3)
        assert caught.value.result.t[-1] == pytest.approx(0.099)
        assert np.all(np.isfinite(caught.value.result.q[:]))
