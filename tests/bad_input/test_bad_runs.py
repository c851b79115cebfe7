"""Wrong input that shows at or after the compilation of a model: one clear message, one type of error.

What is wrong with a description alone is refused earlier and tested with the model.
"""

import re

import numpy as np
import pytest

import ancf
from ancf.elements.registry import ELEMENTS
from ancf.paper import pendulum
from helpers import SOLIDS, cable, square

NAN, INF = float("nan"), float("inf")


def cantilever(elements=3, name="beam", element="cable", **section):
    model = ancf.Model(gravity=(0, 0, -9.81))
    given = {"EA": 1e3, "EI": 0.1, "rhoA": 0.05} | section
    beam = model.add_beam(
        name,
        start=(0, 0, 0),
        end=(1, 0, 0),
        elements=elements,
        section=square(element, **given),
        element=element,
    )
    model.clamp(beam.start)
    return model, beam


def refused(where, what, function, *args, **kwargs):
    """Call that must raise exactly a ModelError at a place; ``what`` is a regular expression."""
    with pytest.raises(ancf.ModelError) as caught:
        function(*args, **kwargs)
    assert type(caught.value) is ancf.ModelError
    assert caught.value.where == where
    assert re.search(what, str(caught.value)), str(caught.value)
    assert "\n" not in str(caught.value)
    return caught.value


def failed(what, function, *args, **kwargs):
    """Call that must raise exactly a SolveError; returns it."""
    with pytest.raises(ancf.SolveError) as caught:
        function(*args, **kwargs)
    assert type(caught.value) is ancf.SolveError
    assert re.search(what, str(caught.value)), str(caught.value)
    assert "\n" not in str(caught.value)
    return caught.value


class TestNumbers:
    @pytest.mark.parametrize("key", ["t_end", "step", "output_step"])
    @pytest.mark.parametrize("value", [0, -1.0, NAN, INF, "1", True, [0.1], (), {}, 1j])
    def test_not_a_time(self, key, value):
        given = {"t_end": 0.1, "step": 1e-3, "output_step": 2e-3} | {key: value}
        refused(f"simulate.{key}", "must be", ancf.simulate, cantilever()[0], **given)

    @pytest.mark.parametrize("key", ["t_end", "step"])
    def test_none_is_no_time(self, key):
        given = {"t_end": 0.1, "step": 1e-3} | {key: None}
        refused(f"simulate.{key}", "must be a number, is None", ancf.simulate, cantilever()[0], **given)

    def test_step_longer_than_the_run(self):
        refused(
            "simulate.step", "longer than the whole run", ancf.simulate, cantilever()[0], t_end=0.1, step=0.2
        )

    def test_too_many_steps(self):
        refused("simulate.step", r"1e\+09 steps", ancf.simulate, cantilever()[0], t_end=1.0, step=1e-12)

    @pytest.mark.parametrize("output_step", [2.5e-3, 5e-4, 1.0001e-3])
    def test_output_between_steps(self, output_step):
        given = {"t_end": 0.1, "step": 1e-3, "output_step": output_step}
        refused("simulate.output_step", "multiple of step", ancf.simulate, cantilever()[0], **given)

    def test_end_before_the_start(self):
        model, _ = cantilever()
        late = ancf.simulate(model, t_end=0.1, step=1e-3).state()
        given = {"t_end": 0.05, "step": 1e-3, "start": late}
        refused("simulate.t_end", "later than the start at 0.1 s", ancf.simulate, model, **given)

    @pytest.mark.parametrize("count", [0, -1, 1000, 2.5, "3", None])
    def test_number_of_modes(self, count):
        refused("modes.count", "must be", ancf.modes, cantilever()[0], count=count)

    @pytest.mark.parametrize("time", [NAN, INF, "0", None])
    def test_time_of_an_equilibrium(self, time):
        refused("equilibrium.time", "must be", ancf.equilibrium, cantilever()[0], time=time)

    @pytest.mark.parametrize(
        ("key", "value"),
        [
            *(("tolerance", v) for v in (0, -1e-9, 1.0, NAN, "small", None)),
            *(("contraction", v) for v in (0, 1.0, NAN, "fast")),
            *(("max_iterations", v) for v in (0, 1, -3, 2.5, "many")),
        ],
    )
    def test_newton(self, key, value):
        refused(f"Newton.{key}", "must be", ancf.Newton, **{key: value})

    @pytest.mark.parametrize("rho_inf", [-0.1, 1.1, NAN, "0.9", None])
    def test_generalised_alpha(self, rho_inf):
        refused("GeneralizedAlpha.rho_inf", "must be", ancf.GeneralizedAlpha, rho_inf=rho_inf)

    @pytest.mark.parametrize("integrator", ["trapezoidal", ancf.Trapezoidal, 3])
    def test_integrator(self, integrator):
        given = {"t_end": 0.1, "step": 1e-3, "integrator": integrator}
        refused("simulate.integrator", "Trapezoidal", ancf.simulate, cantilever()[0], **given)


class TestStarts:
    def run(self, model, start):
        return ancf.simulate(model, t_end=0.1, step=1e-3, start=start)

    def test_state_of_a_longer_model(self):
        state = ancf.equilibrium(cantilever(5)[0])
        refused("simulate.start", "another model", self.run, cantilever(3)[0], state)

    @pytest.mark.parametrize("element", SOLIDS)
    def test_state_of_another_element(self, element):
        for one, two in ((element, "cable"), ("cable", element)):
            state = ancf.equilibrium(cantilever(element=one)[0])
            refused("simulate.start", "another model", self.run, cantilever(element=two)[0], state)

    def test_state_of_other_bodies(self):
        """As many unknowns, but not the same bodies."""
        state = ancf.equilibrium(cantilever(name="other")[0])
        refused("simulate.start", "another model", self.run, cantilever()[0], state)

    def test_state_of_a_model_in_other_parts(self):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e3, EI=0.1, rhoA=0.05)
        for name, z, n in (("a", 0.0, 3), ("b", 1.0, 4)):
            beam = model.add_beam(name, start=(0, 0, z), end=(1, 0, z), elements=n, section=section)
            model.clamp(beam.start)
        other = ancf.Model(gravity=(0, 0, -9.81))
        for name, z, n in (("a", 0.0, 4), ("b", 1.0, 3)):
            beam = other.add_beam(name, start=(0, 0, z), end=(1, 0, z), elements=n, section=section)
            other.clamp(beam.start)
        refused("simulate.start", "another model", self.run, other, ancf.equilibrium(model))

    def test_state_of_a_model_with_nodes_elsewhere(self):
        """As many of them: their positions would be taken for those of other points."""
        states = []
        for middle in (0.5, 0.3):
            model = ancf.Model(gravity=(0, 0, -9.81))
            section = ancf.Section(EA=1e3, EI=0.1, rhoA=0.05)
            beam = model.add_beam("a", start=(0, 0, 0), end=(1, 0, 0), nodes=(0, middle, 1), section=section)
            model.clamp(beam.start)
            states.append(ancf.equilibrium(model))
        refused("simulate.start", "another model", self.run, model, states[0])
        self.run(model, states[1])

    @pytest.mark.parametrize("start", ["equilibrium", 3, np.zeros(24)])
    def test_not_a_state(self, start):
        refused("simulate.start", "State", self.run, cantilever()[0], start)

    def test_modes_about_another_model(self):
        state = ancf.equilibrium(cantilever(5)[0])
        refused("modes.about", "another model", ancf.modes, cantilever(3)[0], about=state)

    def test_infinite_state(self):
        model, _ = cantilever()
        state = ancf.equilibrium(model)
        bad = ancf.State(state.system, 0.0, np.full_like(state.q, NAN), state.v)
        failed("no finite accelerations", self.run, model, bad)


class TestBodies:
    @pytest.mark.parametrize("of", [["bean"], ["beam", "tail"]])
    def test_unknown(self, of):
        with pytest.raises(ancf.ModelError, match=r"unknown body '(bean|tail)'.*\"beam\""):
            ancf.equilibrium(cantilever()[0], of=of)

    @pytest.mark.parametrize("of", [[5], [None], 5, [["beam"]]])
    def test_not_a_body(self, of):
        with pytest.raises(ancf.ModelError):
            ancf.equilibrium(cantilever()[0], of=of)

    def test_no_body(self):
        for function in (ancf.equilibrium, ancf.modes):
            refused("bodies", "has no body", function, ancf.Model())
        refused("bodies", "has no body", ancf.simulate, ancf.Model(), t_end=1.0, step=0.1)

    def test_body_of_another_model(self):
        model, _ = cantilever()
        _, stranger = cantilever()
        with pytest.raises(ancf.ModelError):
            ancf.equilibrium(model, of=[stranger])


def from_time(t0, value):
    """A load that turns wrong at t0: raises, or returns something else than three numbers."""

    def load(t):
        if t < t0:
            return (0.0, 0.0, 0.1)
        if isinstance(value, Exception):
            raise value
        return value

    return load


class TestLoadFunctions:
    """Wrong at a later time: load and time are named, what was computed is kept."""

    WRONG = (
        (ZeroDivisionError("division by zero"), "raised ZeroDivisionError: division by zero"),
        ((1.0, 2.0), r"returned shape \(2,\), wanted \(3,\)"),
        ((0.0, NAN, 0.0), "must be finite"),
        ((0.0, INF, 0.0), "must be finite"),
        ("up", "returned 'up', wanted"),
        (None, "returned None, wanted"),
        (1.0, r"returned shape \(\), wanted \(3,\)"),
    )

    @pytest.mark.parametrize(("value", "what"), WRONG)
    def test_force(self, value, what):
        model, beam = cantilever()
        model.add_force(beam.end, from_time(0.05, value), name="gust")
        error = refused('add_force("gust").force', what, ancf.simulate, model, t_end=0.1, step=1e-3)
        assert "t = 0.05 s" in str(error)
        self.check_kept(error.result)

    def check_kept(self, result, t0=0.05):
        assert result.status == "failed"
        assert len(result.t) > 1
        assert result.t[-1] < t0
        assert np.all(np.isfinite(result.q[:]))
        wanted = ancf.simulate(cantilever_under_load(), t_end=0.05, step=1e-3)
        assert np.array_equal(result.q[:], wanted.q[: len(result.t)])

    def test_all_steps_before_are_kept(self):
        """Up to the last step that the function allowed, not up to some block of steps before."""
        model, beam = cantilever()
        model.add_force(beam.end, from_time(0.05, (NAN, 0, 0)), name="gust")
        with pytest.raises(ancf.ModelError) as caught:
            ancf.simulate(model, t_end=0.1, step=1e-3)
        assert caught.value.result.t[-1] == pytest.approx(0.049)

    def test_moment_and_distributed_load(self):
        for add in (
            lambda m, b, f: m.add_moment(b.end, f, name="bad"),
            lambda m, b, f: m.add_distributed_load(b, f, name="bad"),
        ):
            model, beam = cantilever()
            add(model, beam, from_time(0.05, (NAN, 0, 0)))
            with pytest.raises(ancf.ModelError, match=r'"bad".*t = 0.05 s') as caught:
                ancf.simulate(model, t_end=0.1, step=1e-3)
            assert len(caught.value.result.t) > 1

    def test_support(self):
        model, beam = cantilever()
        model.supports.clear()
        model.clamp(beam.start, rotation=lambda t: 0.1 * t if t < 0.05 else NAN, name="wall")
        with pytest.raises(ancf.ModelError, match=r'clamp\("wall"\).rotation.*must be finite') as caught:
            ancf.simulate(model, t_end=0.1, step=1e-3)
        assert len(caught.value.result.t) > 1

    def test_formula(self):
        model, beam = cantilever()
        model.add_force(beam.end, ["0", "sqrt(0.05 - t)", "0"], name="gust")
        with pytest.raises(ancf.ModelError, match=r'"gust".*t = 0.051 s.*finite'):
            ancf.simulate(model, t_end=0.1, step=1e-3)

    def test_equilibrium(self):
        model, beam = cantilever()
        model.add_force(beam.end, from_time(2.0, (0, NAN, 0)), name="gust")
        refused('add_force("gust").force', "t = 3 s", ancf.equilibrium, model, time=3.0)

    def test_results_in_a_file_are_kept_too(self, tmp_path):
        model, beam = cantilever()
        model.add_force(beam.end, from_time(0.05, None), name="gust")
        with pytest.raises(ancf.ModelError):
            ancf.simulate(model, t_end=0.1, step=1e-3, file=tmp_path / "run.h5")
        kept = ancf.load(tmp_path / "run.h5")
        assert kept.status == "failed"
        assert len(kept.t) > 1


def cantilever_under_load():
    model, beam = cantilever()
    model.add_force(beam.end, (0.0, 0.0, 0.1))
    return model


@pytest.mark.parametrize("element", ELEMENTS)
class TestSteps:
    """A step that is far too large ends with an error that says when, where and what to try."""

    @staticmethod
    def whip(element, step, file=None):
        """A cable that whirls about its end: 4 m/s at the tip, waves of 100 m/s."""
        model, beam = cantilever(8, element=element, EA=1e5, EI=1e-3)
        model.supports.clear()
        model.pin(beam.start)
        beam.set_motion(angular_velocity=(0, 40.0, 30.0))
        return ancf.simulate(model, t_end=20 * step, step=step, file=file)

    @pytest.mark.parametrize("step", [0.02, 5.0])
    def test_far_too_large(self, step, element):
        unknown = r"beam node \d+ (position|slope r_.|internal r_.x) [xyz]"
        error = failed(rf"t = .* s, step \d+, {unknown}: ", self.whip, element, step)
        assert "try a step of" in error.hint
        assert error.result.status == "failed"
        assert error.result.t[0] == 0.0

    @pytest.mark.parametrize("step", [0.02, 0.05, 0.2, 1.0, 100.0])
    def test_nothing_infinite_is_stored(self, step, tmp_path, element):
        """Whatever happens: finite states, and only the two errors of the package."""
        path = tmp_path / "run.h5"
        try:
            result = self.whip(element, step, path)
        except ancf.SolveError as error:
            result = error.result
        assert np.all(np.isfinite(result.q[:]))
        assert np.all(np.isfinite(result.v[:]))
        assert np.all(np.isfinite(result.energy.total))
        assert np.array_equal(ancf.load(path).t, result.t)

    def test_huge_load(self, element):
        model, beam = cantilever(element=element)
        model.add_force(beam.end, (0, 0, 1e300))
        error = failed(
            "finite|diverged|converge|nowhere|halved|singular", ancf.simulate, model, t_end=0.1, step=1e-3
        )
        assert np.all(np.isfinite(error.result.q[:]))


class TestEquilibria:
    def test_unstable_state_has_no_modes(self):
        """A column under twice its buckling load."""
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=0.5, rhoA=0.3)
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(0, 0, 1), elements=8, section=section, length=1.001
        )
        model.pin(beam.start)
        model.pin(beam.end)
        failed("not a stable equilibrium", ancf.modes, model, count=2)

    def test_impossible_equilibrium(self):
        """A dead force that no cable can carry in equilibrium at a finite place."""
        model = ancf.Model()
        section = ancf.Section(EA=1e3, EI=0.5, rhoA=0.3)
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
        model.pin(beam.start)
        model.add_force(beam.end, (1e300, 0, 0))
        failed("equilibrium", ancf.equilibrium, model)

    @staticmethod
    def stiff_rope(EA):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=EA, EI=0.0, rhoA=1.0)
        rope = model.add_beam(
            "rope", start=(0, 0, 0), end=(10, 0, 0), length=10.5, elements=10, section=section
        )
        return model, [model.pin(rope.start), model.pin(rope.end)]

    @staticmethod
    def check_round_off(error, EA):
        assert f'"rope" has EA = {EA:.3g} N, ' in error.hint
        assert "round-off" in error.hint
        assert "load_steps" not in str(error)

    @pytest.mark.parametrize("EA", [1e14, 2e15, 1e18])
    def test_a_stiffness_that_round_off_takes(self, EA):
        """Finer steps do not help: the cause is named, and what is stiff enough."""
        with pytest.raises(ancf.SolveError) as caught:
            ancf.equilibrium(self.stiff_rope(EA)[0])
        self.check_round_off(caught.value, EA)

    @pytest.mark.parametrize("EA", [3e12, 1e13, 3e13])
    def test_a_stiffness_that_some_processors_take(self, EA):
        """Next to that, round-off decides: it is told, or the pins carry the weight."""
        model, pins = self.stiff_rope(EA)
        try:
            state = ancf.equilibrium(model)
        except ancf.SolveError as error:
            self.check_round_off(error, EA)
        else:
            carried = sum(state.reaction(pin)[2] for pin in pins)
            assert carried == pytest.approx(9.81 * 10.5, rel=1e-3)


class TestCollapse:
    """A cross-section that turns inside out has no meaning: when, which body, which element."""

    WHAT = r"beam element \d: the cross-section has collapsed or turned inside out"

    @pytest.mark.parametrize("element", SOLIDS)
    def test_in_a_run(self, element, tmp_path):
        """Let go at 1.7 times its length, of a material that shrinks by 0.3 of that."""
        model, beam = cable("curved", element=element, length=1.1)
        model.clamp(beam.end, stretch="fixed")
        path = tmp_path / "run.h5"
        given = {"t_end": 0.1, "step": 5e-4, "file": path}
        error = failed(rf"t = 0\.0\d+ s, step \d+, {self.WHAT}", ancf.simulate, model, **given)
        assert "try a step of" in error.hint
        result = error.result
        assert result.status == "failed"
        assert 0.005 < result.t[-1] < 0.05
        assert np.all(np.isfinite(result.q[:]))
        assert np.array_equal(ancf.load(path).t, result.t)

    @pytest.mark.parametrize("element", SOLIDS)
    @pytest.mark.parametrize(
        "method",
        [
            ancf.Radau(tolerance=1e-6),
            ancf.Radau(adaptive=False),
            ancf.GeneralizedAlpha(rho_inf=0.9),
            ancf.Explicit(check=False),
        ],
        ids=lambda method: f"{method.name} {getattr(method, 'adaptive', '')}".strip(),
    )
    def test_by_every_method(self, method, element):
        """Two of them went on with a section inside out, as if nothing had been.

        All say it at one time, but explicit steps, which are looked at now and then, as their energy is.
        """
        model, beam = cable("curved", element=element, length=1.1)
        model.clamp(beam.end, stretch="fixed")
        wanted = failed(self.WHAT, ancf.simulate, model, t_end=0.1, step=1e-4).result.t[-1]
        step = 2e-6 if method.name == "explicit" else 1e-4
        error = failed(
            self.WHAT, ancf.simulate, model, t_end=0.1, step=step, output_step=1e-4, integrator=method
        )
        late = 0.1 if method.name == "explicit" else 5e-4
        assert wanted - 5e-4 <= error.result.t[-1] <= wanted + late
        assert np.all(np.isfinite(error.result.q[:]))

    @pytest.mark.parametrize("element", SOLIDS)
    def test_in_an_equilibrium(self, element):
        """Pressed together with more than any length can bear."""
        model, beam = cantilever(2, element=element)
        for x in beam.node_x[1:]:
            model.hold(beam.at(x), position="yz", slope="yz", slope_y="xz", slope_z="xy")
        model.add_force(beam.end, (-1e4, 0, 0))
        failed(r"equilibrium at .* of the load", ancf.equilibrium, model)

    @pytest.mark.parametrize(
        ("strain", "elements", "force"),
        [("paper", 1, 50.0), ("paper", 2, 100.0), ("material", 2, 100.0), ("material", 5, 30.0)],
    )
    def test_of_a_cable(self, strain, elements, force):
        """A free stretch at a clamp lets bending vanish with r_x where EA is small: no curvature then."""
        model = ancf.Model()
        beam = model.add_beam(
            "rope",
            start=(0, 0, 0),
            end=(1, 0, 0.3),
            elements=elements,
            section=ancf.Section(EA=1.0, EI=1.0, rhoA=1.0),
            strain=strain,
        )
        model.clamp(beam.start, stretch="free")
        model.add_force(beam.end, (0, -force, 0))
        error = failed(r"rope at node 0: .* r_x vanishes", ancf.equilibrium, model)
        assert "the load is too large" in error.hint

    @pytest.mark.parametrize("element", SOLIDS)
    def test_at_the_start(self, element):
        model, _ = cantilever(3, element=element)
        state = ancf.equilibrium(model)
        q = state.q.copy()
        for slots in state.system.slots["beam"]:
            q[slots[2] + np.arange(3)] *= -1.0
        bad = ancf.State(state.system, 0.0, q, state.v)
        failed(self.WHAT, ancf.simulate, model, t_end=0.01, step=1e-4, start=bad)


@pytest.mark.parametrize("element", SOLIDS)
@pytest.mark.parametrize("f", [1.0, 0.5, 0.2])
def test_plain_newton_on_stiff_beams(element, f):
    """7.2 with E = 1e9 N/m^2 and more: kept Jacobians may fail, but then the run says so.

    What is called complete has kept its energy, and the rope its length.
    """
    error, model = None, pendulum.build(4, f, element)
    try:
        result = pendulum.run(model, 0.15, newton=ancf.Newton(corotate=False))
    except ancf.SolveError as caught:
        error, result = caught, caught.result
    assert np.all(np.isfinite(result.q[:]))
    assert result.status == ("complete" if error is None else "failed")
    if error is None:
        assert np.ptp(result.energy.balance) < 1e-3 * result.energy.kinetic[0]
        assert np.max(np.linalg.norm(result.position("rope.end"), axis=1)) < 1.001
    else:
        assert re.match(r"t = [\d.]+ s, step \d+, rope node \d ", error.where)
        assert re.search("came from nowhere|did not converge|had to be halved", error.what)
        assert "try a step of" in error.hint


class TestPressedStart:
    """A rope that is longer than the distance of its ends, straight at the start."""

    def fails(self, length, **more):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e6, EI=0.01, rhoA=0.1)
        rope = model.add_beam(
            "rope", start=(0, 0, 0), end=(1, 0, 0), length=length, elements=8, section=section
        )
        model.pin(rope.start)
        model.add_force(rope.end, lambda t: (0, 0, 0) if t < 0.05 else (1e300, 0, 0))
        with pytest.raises(ancf.SolveError) as caught:
            ancf.simulate(model, t_end=0.1, step=1e-3, **more)
        return caught.value

    def test_is_advised_to_hang_first(self):
        error = self.fails(2.0)
        assert error.hint.startswith('"rope" begins pressed to 50 % of its length: start=ancf.equilibrium(')
        assert "; else try a step of" in error.hint
        assert error.hint in str(error)
        assert error.result.status == "failed"

    def test_others_are_not(self):
        assert "pressed" not in self.fails(1.0).hint


class TestFiles:
    def run(self, path):
        return ancf.simulate(cantilever()[0], t_end=0.01, step=1e-3, file=path)

    def test_folder_is_a_file(self, tmp_path):
        (tmp_path / "taken").write_text("x")
        path = tmp_path / "taken" / "run.h5"
        refused(str(path), "cannot be written", self.run, path)

    def test_path_is_a_folder(self, tmp_path):
        refused(str(tmp_path), "cannot be written", self.run, tmp_path)

    def test_nowhere_to_write(self):
        refused("/proc/nothing/run.h5", "cannot be written", self.run, "/proc/nothing/run.h5")

    @pytest.mark.parametrize("path", [5, ["run.h5"]])
    def test_not_a_path(self, path):
        with pytest.raises(ancf.ModelError):
            self.run(path)

    def test_nothing_is_computed_first(self, tmp_path):
        """The file is opened before the first step."""
        calls = []
        model, beam = cantilever()
        model.add_force(beam.end, lambda t: (calls.append(t), (0, 0, 1.0))[1])
        calls.clear()
        with pytest.raises(ancf.ModelError):
            ancf.simulate(model, t_end=1.0, step=1e-3, file=tmp_path)
        assert len(calls) < 10

    @pytest.mark.parametrize("stored", [False, True])
    def test_save(self, stored, tmp_path):
        result = self.run(tmp_path / "run.h5" if stored else None)
        (tmp_path / "taken").write_text("x")
        path = tmp_path / "taken" / "copy.h5"
        refused(str(path), "cannot be written", result.save, path)


@pytest.mark.parametrize("model", ["model.toml", None, 3.0])
@pytest.mark.parametrize(
    "compute",
    [
        ancf.equilibrium,
        ancf.modes,
        ancf.damped_modes,
        ancf.linearise,
        lambda model: ancf.simulate(model, t_end=1.0, step=0.1),
        lambda model: ancf.stepper(model, step=0.1),
        lambda model: ancf.stepper(model, start="run.h5"),
    ],
)
def test_no_model(model, compute):
    with pytest.raises(ancf.ModelError, match=r"^model: must be a Model, is "):
        compute(model)


@pytest.mark.parametrize("point", [3, None, (0.0, 0.0, 1.0)])
@pytest.mark.parametrize("question", ["position", "tension"])
def test_no_point(point, question):
    model = ancf.Model()
    beam = model.add_beam(
        "b", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=1e4, EI=1.0, rhoA=0.1)
    )
    model.clamp(beam.start)
    with pytest.raises(ancf.ModelError, match=r"^point: must be a point, is .*such as beam\.start"):
        getattr(ancf.equilibrium(model), question)(point)
