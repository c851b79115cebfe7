"""Steps one by one: the bits of a simulation, whatever is asked between them, and inputs that change."""

import itertools

import numpy as np
import pytest

import ancf
from ancf.control.delay import Delayed
from motions import pendulum, rod_on_a_hinge
from runs_to_continue import RUNS, adaptive

#: How many steps are taken at once, one after the other.
PATTERNS = {"one by one": (1,), "in blocks": (1, 7, 300, 2, 64)}
NAMES = [name for name, run in RUNS.items() if not adaptive(run[1])]


def stepped(run, steps, pattern):
    """Take so many steps in the parts of a pattern, over and over."""
    k = 0
    while steps:
        count = min(pattern[k % len(pattern)], steps)
        run.advance(count)
        steps, k = steps - count, k + 1
    return run


@pytest.mark.filterwarnings("ignore:energies of the run do not add up")
@pytest.mark.parametrize("pattern", PATTERNS)
@pytest.mark.parametrize("name", NAMES)
def test_same_bits_as_a_simulation(name, pattern):
    build, method, step, steps, sensors = RUNS[name]
    given = {"step": step, "integrator": method, "sensors": sensors}
    whole = ancf.simulate(build(), t_end=(steps + 4) * step, **given)  # the last steps know their end
    run = stepped(ancf.stepper(build(), **given), steps, PATTERNS[pattern])
    assert run.t == whole.t[steps]
    assert np.array_equal(run.q, whole.q[steps])
    assert np.array_equal(run.v, whole.v[steps])
    for part in ("dissipated", "supplied", "kinetic", "strain"):
        assert getattr(run.energy, part) == getattr(whole.energy, part)[steps]
    recorded, wanted = run.sensors._arrays(), whole.sensors._arrays()
    for part in ("time", "q", "v", "measured"):
        assert np.array_equal(recorded[part], wanted[part][: steps + 1]), part


def test_all_that_decides_how_it_goes_on():
    """The snapshots of runs that were stepped in other parts, looks at the energy included."""
    found = []
    for pattern in ((1,), (300,), (7, 100, 2)):
        run = stepped(ancf.stepper(pendulum()[0], step=1e-3), 300, pattern)
        found.append(run._run.snapshot())
    for other in found[1:]:
        same = {k: v for k, v in other.values.items() if k != "seconds"}
        assert same == {k: v for k, v in found[0].values.items() if k != "seconds"}
        assert same["look"] > 300
        assert other.arrays.keys() == found[0].arrays.keys()
        for place, array in other.arrays.items():
            assert np.array_equal(array, found[0].arrays[place]), place


def test_a_million_steps(request):
    """Of a small model; in the short form of the tests twenty thousand."""
    count = 1_000_000 if request.config.getoption("--slow") else 20_000
    model = pendulum(1)[0]
    whole = ancf.simulate(model, t_end=(count + 4) * 1e-4, step=1e-4, output_step=count * 1e-4)
    run = ancf.stepper(model, step=1e-4)
    for _ in range(count):
        run.advance()
    assert np.array_equal(run.q, whole.q[1])
    assert run.stats.newton_iterations <= whole.stats.newton_iterations


def test_questions_change_nothing():
    """Asking for anything between two steps, contacts and energies included."""
    build, method, step, steps, sensors = RUNS["strip"]
    runs = [ancf.stepper(build(), step=step, integrator=method, sensors=sensors) for _ in range(2)]
    for _ in range(steps // 2):
        for run in runs:
            run.advance()
        asked = runs[1]
        asked.contact_force("strip"), asked.energy, asked.state(), asked.sensors.t, str(asked), asked.stats
        asked.position("pan"), asked.tension("wire.at(2)")
    assert np.array_equal(runs[0].q, runs[1].q)


def pushed(mass=2.0):
    """A mass in space that two inputs push."""
    model = ancf.Model()
    body = model.add_point_mass("body", at=(0, 0, 0), mass=mass)
    u, w = model.add_input("thrust"), model.add_input("side", 0.5)
    model.add_force(body, (2 * u, w - u / 4, "sin(3*t)"))
    return model


class TestInputs:
    @pytest.mark.parametrize("steps", [1, 3])
    def test_hold_from_the_next_step_on(self, steps):
        """Against the trapezoidal rule by hand: the force at the end of a step is that of the input now."""
        h, mass, rng = 1e-2, 2.0, np.random.default_rng(3)
        run = ancf.stepper(pushed(mass), step=h)
        force, v, r = np.array([0.0, 0.5, 0.0]), np.zeros(3), np.zeros(3)
        for k in range(300):
            if k % 3 == 0:
                run.inputs["thrust"] = float(rng.uniform(-1, 1))
                run.inputs["side"] = rng.uniform(-1, 1)  # of NumPy
            if k % steps == 0:
                run.advance(steps)
            u, w = run.inputs["thrust"], run.inputs["side"]
            now = np.array([2 * u, w - u / 4, np.sin(3 * (k + 1) * h)])
            r = r + h * v + h * h * (force + now) / (4 * mass)
            v, force = v + h * (force + now) / (2 * mass), now
            if (k + 1) % steps == 0:
                assert run.velocity("body") == pytest.approx(v, abs=1e-13)
                assert run.position("body") == pytest.approx(r, abs=1e-13)
        assert run.energy.kinetic == pytest.approx(0.5 * mass * v @ v)

    @pytest.mark.parametrize(
        "method", [ancf.Trapezoidal(), ancf.Radau(adaptive=False), ancf.Explicit(check=False)]
    )
    @pytest.mark.parametrize("every", [1, 4])
    def test_controller_and_stepper_are_one(self, method, every):
        def build():
            model, beam = pendulum(EA=200.0)
            u = model.add_input("u")
            model.add_force(beam.end, (u, "0.3*cos(9*t)", -0.5 * u))
            return model

        def control(run):
            run.inputs["u"] = 0.2 - 0.4 * run.velocity("beam.end")[0] + 0.1 * np.sin(5 * run.t)

        whole = ancf.simulate(
            build(), t_end=0.1, step=5e-4, integrator=method, controller=control, control_step=every * 5e-4
        )
        run = ancf.stepper(build(), step=5e-4, integrator=method)
        for _ in range(0, 190, every):
            control(run)
            run.advance(every)
        k = round(run.t / 5e-4)
        assert np.array_equal(run.q, whole.q[k])
        still = ancf.simulate(build(), t_end=0.1, step=5e-4, integrator=method)
        assert np.abs(whole.position("beam.end") - still.position("beam.end")).max() > 1e-4

    def test_what_inputs_may_lead(self):
        """Forces, moments, loads along a beam, drives of joints: the bits of functions of time that jump."""

        def build(jumps):
            model, rod, _ = rod_on_a_hinge()
            section = ancf.Section(EA=200.0, EI=0.1, rhoA=0.3)
            beam = model.add_beam("wire", start=(0, 1, 0), end=(1, 1, 0), elements=2, section=section)
            model.pin(beam.start)
            bead = model.add_point_mass("bead", at=(0.25, 1, 0), mass=0.1)
            u = model.add_input("u", 0.3)

            def of(factor):
                return f"{factor} * where(t > 0, 0.7, 0.3)" if jumps else factor * u

            model.add_moment(rod, (0, of(1.0), 0))
            model.add_moment(beam.at(0.5), (0, 0, of(0.01)), name="turn")
            model.add_distributed_load(beam, (0, of(1.0), of(-1.0)))
            model.slide(bead, along=beam, s=0.25, force=of(0.5), name="slider")
            return model

        run, plain = (ancf.stepper(build(jumps), step=1e-3) for jumps in (False, True))
        run.inputs["u"] = 0.7
        for count in (1, 1, 18, 20):
            run.advance(count), plain.advance(count)
            assert np.array_equal(run.q, plain.q)
        still = ancf.simulate(build(False), t_end=0.05, step=1e-3)
        for point in ("bead", "body", "wire.end"):
            assert np.abs(run.position(point) - still.position(point)[40]).max() > 1e-6

    @pytest.mark.parametrize("again", ["a stepper", "a simulation", "a rebuilt model", "a file"])
    def test_a_state_goes_on_with_them(self, again, tmp_path):
        """As the run would have, to the first step's accelerations; what was never given is the model's."""

        def build(first=0.0):
            model = pushed(2.0)
            model.add_force("body", (model.add_input("further", first), 0, 0))
            return model

        run = ancf.stepper(build(), step=1e-2)
        run.inputs["thrust"] = 0.7
        run.advance(20)
        start = run.state()
        if again == "a file":
            run.save(tmp_path / "kept.h5")
            start = ancf.load(tmp_path / "kept.h5").state()
        run.advance(30)
        if again == "a simulation":
            other = ancf.simulate(build(), t_end=0.5, step=1e-2, start=start).state()
        else:
            other = ancf.stepper(build(), step=1e-2, start=start)
            assert dict(other.inputs) == dict(run.inputs)
            other.advance(30)
        assert other.position("body") == pytest.approx(run.position("body"), abs=1e-13)
        assert abs(run.velocity("body")[0]) > 0.1
        fresh = ancf.stepper(build(3.0), step=1e-2, start=ancf.stepper(build(), step=1e-2).state())
        assert fresh.inputs["further"] == 3.0

    def test_equilibrium_is_that_of_the_first_value(self):
        model, beam = pendulum()
        model.add_force(beam.end, (model.add_input("pull", 2.0), 0, 0))
        end = ancf.equilibrium(model).position("beam.end")
        plain, beam = pendulum()
        plain.add_force(beam.end, (2.0, 0, 0))
        assert np.array_equal(end, ancf.equilibrium(plain).position("beam.end"))


class TestSaved:
    @pytest.mark.parametrize(
        "method", [ancf.Trapezoidal(), ancf.Radau(adaptive=False), ancf.Explicit(check=False)]
    )
    def test_goes_on(self, method, tmp_path):
        path, given = tmp_path / "results.h5", {"step": 1e-3, "integrator": method, "sensors": ["body"]}
        run = ancf.stepper(pushed(), **given)
        run.inputs["thrust"] = 0.7
        run.advance(33)
        run.save(path)
        again, in_folder = (ancf.stepper(pushed(), start=place) for place in (path, tmp_path))
        assert np.array_equal(in_folder.q, again.q)
        assert again.inputs == in_folder.inputs == {"thrust": 0.7, "side": 0.5}
        assert ancf.load(path).state().position("body") == pytest.approx(run.position("body"), abs=0)
        resumed = ancf.resume(path, t_end=0.073)
        for one in (run, again):
            one.advance(40)
        assert np.array_equal(run.q, again.q)
        assert np.array_equal(run.q, resumed.q[-1]) or method.name == "radau"
        for part in ("t", "q", "v"):
            assert np.array_equal(getattr(run.sensors, part), getattr(again.sensors, part))
        assert len(run.sensors.t) == 74

    def test_of_a_simulation(self, tmp_path):
        path = tmp_path / "run.h5"
        ancf.simulate(pushed(), t_end=0.05, step=1e-3, file=path)
        run = ancf.stepper(pushed(), start=path)
        assert run.t == pytest.approx(0.047)
        run.advance(10)
        assert np.array_equal(run.q, ancf.simulate(pushed(), t_end=0.1, step=1e-3).q[57])

    def test_controlled_run_goes_on(self, tmp_path):
        def control(run):
            run.inputs["thrust"] = -3.0 * run.position("body")[1]

        path, given = tmp_path / "run.h5", {"step": 1e-3, "controller": control, "control_step": 4e-3}
        ancf.simulate(pushed(), t_end=0.05, file=path, **given)
        with pytest.raises(ancf.ModelError, match='was led by "control"'):
            ancf.resume(path, t_end=0.1)
        resumed = ancf.resume(path, t_end=0.1, controller=control)
        assert np.array_equal(resumed.q[:], ancf.simulate(pushed(), t_end=0.1, **given).q)


class TestFailures:
    @pytest.mark.parametrize("push", [1e9, 1e200])
    def test_an_explicit_step_that_fails(self, push):
        """It says why; the run is where it was."""
        model, beam = pendulum()
        model.add_force(beam.end, (model.add_input("u"), 0, 0))
        run = ancf.stepper(model, step=1e-5, integrator=ancf.Explicit(check=False))
        run.advance(10)
        run.inputs["u"] = push
        with pytest.raises(ancf.SolveError, match=r"the motion has blown up|no longer finite"):
            run.advance(5000)
        assert np.isfinite(run.q).all()

    def test_a_step_that_fails(self):
        """The run is where it was, answers, and goes on when the input lets it."""

        def build():
            model, beam = pendulum()
            model.add_force(beam.end, (model.add_input("u"), 0, 0))
            return model

        run, calm = (ancf.stepper(build(), step=1e-3) for _ in range(2))
        run.advance(50), calm.advance(50)
        before, t = run.q, run.t
        run.inputs["u"] = 1e13
        with pytest.raises(ancf.SolveError, match=r"t = 0\.05 s, step 51"):
            run.advance()
        assert run.t == t
        assert np.array_equal(run.q, before)
        assert run.position("beam.end") == pytest.approx(calm.position("beam.end"), abs=0)
        run.inputs["u"] = 0.0
        run.advance(50), calm.advance(50)
        assert run.t == calm.t
        assert run.position("beam.end") == pytest.approx(calm.position("beam.end"), abs=1e-8)
        assert run.stats.steps == calm.stats.steps

    def test_a_step_that_fails_in_the_middle(self):
        """Parts of it were taken before: they are taken back."""
        model = ancf.Model()
        body = model.add_point_mass("body", at=(0, 0, 0), mass=2.0)
        body.set_motion(velocity=(0.5, 0, 0))
        model.add_force(body, ["1", "0", "sqrt(0.3 - x)"])
        run = ancf.stepper(model, step=0.01)
        run.advance(48)
        before = run.q, run.v, run.t, run.energy.supplied, run.stats.steps
        with pytest.raises(ancf.SolveError, match=r"r = \(0\.3") as caught:
            run.advance()
        assert (
            float(caught.value.where.split()[2]) > before[2] + 1e-4
        )  # some parts of the step had been taken
        for value, wanted in zip(
            (run.q, run.v, run.t, run.energy.supplied, run.stats.steps), before, strict=True
        ):
            assert np.array_equal(value, wanted)
        with pytest.raises(ancf.SolveError) as again:
            run.advance()
        assert str(again.value) == str(caught.value)

    @pytest.mark.parametrize("at_once", [1, 200])
    def test_energy_from_nowhere(self, at_once):
        """The energy is looked at after the same steps as in a simulation, with the same message."""

        def whip(EA):
            model, beam = pendulum(EA=EA, EI=1e-4, damping=0.0)
            beam.set_motion(angular_velocity=(0, 0, 40.0))
            return model

        said = []
        for EA, step in itertools.product((2e5, 5e5), (5e-3, 2e-2, 8e-2)):
            try:
                ancf.simulate(whip(EA), t_end=300 * step, step=step)
                continue
            except ancf.SolveError as error:
                said.append(str(error))
            run = ancf.stepper(whip(EA), step=step)
            with pytest.raises(ancf.SolveError) as caught:
                stepped(run, 400, (at_once,))
            assert str(caught.value) == said[-1]
        assert any("came from nowhere" in text for text in said)

    def test_function_of_time_that_fails_ahead(self):
        """Steps before it are taken, and the message names its time."""
        model = pushed()
        model.add_force("body", lambda t: (0, 0, 1.0) if t < 0.0305 else 1 / 0, name="late")
        run = ancf.stepper(model, step=1e-3)
        run.advance(30)
        for _ in range(2):
            with pytest.raises(
                ancf.ModelError, match=r"at t = 0\.031 s the function raised ZeroDivisionError"
            ):
                run.advance()
            assert run.t == pytest.approx(0.03)

    def test_formula_of_an_input_that_is_none(self):
        model = ancf.Model()
        body = model.add_point_mass("body", at=(0, 0, 0), mass=1.0)
        u = model.add_input("u", 1.0)
        model.add_force(body, (1 / 3 + 1.0 * u, 0, 0))
        run = ancf.stepper(model, step=1e-3)
        with pytest.raises(ancf.ModelError, match="must be a finite number"):
            run.inputs["u"] = float("nan")
        for bad in ("fast", None, [1.0], True):
            with pytest.raises(ancf.ModelError, match="must be a number"):
                run.inputs["u"] = bad
        with pytest.raises(ancf.ModelError, match="unknown input 'v', known: \"u\""):
            run.inputs["v"] = 1.0
        with pytest.raises(ancf.ModelError, match="unknown input"):
            run.inputs["v"]
        assert dict(run.inputs) == {"u": 1.0}

    @pytest.mark.parametrize("steps", [0, -1, 1.5, "2", None])
    def test_steps(self, steps):
        with pytest.raises(ancf.ModelError, match=r"advance\.steps"):
            ancf.stepper(pushed(), step=1e-3).advance(steps)

    @pytest.mark.parametrize(
        ("given", "where", "what"),
        [
            ({}, "stepper.step", "must be a number"),
            ({"step": 0.0}, "stepper.step", "must be > 0"),
            ({"step": 1e-3, "integrator": ancf.Radau()}, "stepper.integrator", "chooses its own steps"),
            ({"step": 1e-3, "integrator": "fast"}, "stepper.integrator", "must be one of"),
            ({"step": 1e-3, "start": 3}, "stepper.start", "must be a State or a file"),
            ({"step": 1e-3, "start": "no.h5"}, "stepper.step", "cannot be given"),
            ({"start": "no.h5"}, "no.h5", "there is no such file"),
        ],
    )
    def test_wrong_settings(self, given, where, what):
        with pytest.raises(ancf.ModelError, match=what) as caught:
            ancf.stepper(pushed(), **given)
        assert caught.value.where == where

    def test_file_of_another_model(self, tmp_path):
        path = tmp_path / "run.h5"
        ancf.stepper(pushed(), step=1e-3).save(path)
        with pytest.raises(ancf.ModelError, match="is not the model that") as caught:
            ancf.stepper(pushed(3.0), start=path)
        assert caught.value.where == "stepper.model"

    def test_controllers(self):
        given = {"t_end": 0.01, "step": 1e-3}

        def wrong(run):
            run.inputs["thrust"] = 1 / (run.t - 0.004)

        with pytest.raises(
            ancf.ModelError, match=r"at t = 0\.004 s the controller raised ZeroDivision"
        ) as caught:
            ancf.simulate(pushed(), controller=wrong, control_step=2e-3, **given)
        assert caught.value.result.t[-1] == pytest.approx(0.004)
        for more, what in (
            ({"controller": 3}, "must be a function of the run"),
            ({"controller": wrong, "control_step": 1.5e-3}, "must be a multiple of step"),
            ({"controller": wrong, "control_step": -1.0}, "must be > 0"),
            ({"control_step": 1e-3}, "has no effect without a controller"),
            ({"controller": wrong, "integrator": ancf.Radau()}, "chooses its own steps"),
        ):
            with pytest.raises(ancf.ModelError, match=what):
                ancf.simulate(pushed(), **given, **more)

    @pytest.mark.parametrize("late", [False, True])
    @pytest.mark.parametrize("value", [5.0, {"thrust": 1.0}, 0.0, False])
    def test_a_controller_that_returns_something(self, value, late):
        """As of other packages: here nothing takes it, and the run says what does."""
        name = next(iter(pushed().inputs))
        controller = Delayed(lambda run: value, 1e-3) if late else lambda run: value
        with pytest.raises(ancf.ModelError, match=r"returned .* at t = 0 s, which nothing takes") as caught:
            ancf.simulate(pushed(), t_end=0.01, step=1e-3, controller=controller)
        assert f'run.inputs["{name}"] = ...' in str(caught.value)


@pytest.mark.parametrize("name", ["drum", "windlass"])
def test_a_winch_is_no_sensor(name):
    """It is said, with what has its length."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.2)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -2), elements=3, section=section)
    model.pin(rope.start)
    model.winch(rope.start, length="2 - 0.1*t", name=name)
    with pytest.raises(ancf.ModelError, match=f'"{name}" is a winch') as caught:
        ancf.simulate(model, t_end=0.01, step=1e-3, sensors=["rope.end", name])
    assert "natural_length" in caught.value.hint
    run = ancf.simulate(model, t_end=0.01, step=1e-3, sensors=[rope.end])
    assert run.sensors.natural_length(rope)[-1] == pytest.approx(1.999, abs=1e-9)
