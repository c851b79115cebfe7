"""Winches that follow inputs: speeds and lengths that jump, by steppers, controllers, files and units."""

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError, SolveError
from ancf.model.file import parse_study

ROPE = ancf.Section(EA=1e4, EI=1e-3, rhoA=0.05, axial_damping=2.0)
H = 2e-3


def hoist(load=1.0, **given):
    """A load on a rope of 3 m that a winch with the input "u" hauls in; the model, the rope, the load."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    u = model.add_input("u", given.pop("first", 0.0))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(0.3, 0, -2.98), elements=4, length=3.0, section=ROPE)
    mass = model.add_point_mass("load", at=(0.3, 0, -2.98), mass=load)
    model.connect(rope.end, mass)
    model.pin(rope.start)
    given = {key: u if value == "u" else value for key, value in given.items()}
    model.winch(rope.start, **{"name": "drum", "length": 3.0, "acceleration": 2.0, **given})
    return model, rope, mass


BY_SPEED, BY_LENGTH = {"speed": "u"}, {"length": "u", "speed": 0.5, "first": 3.0}


def told(t, kind):
    """What a program tells the winch: it jumps."""
    if kind is BY_SPEED:
        return -0.4 if t < 0.5 else 0.3
    return 2.6 if t < 0.9 else 2.9


class TestWhatItDoes:
    def test_speed_with_the_acceleration_of_the_drum(self):
        model, rope, _ = hoist(speed="u")
        run = ancf.stepper(model, step=H)
        run.inputs["u"] = -0.4
        lengths = []
        for _ in range(500):
            run.advance()
            lengths.append(run.natural_length(rope))
        t = H * np.arange(1, 501)
        ramp = 0.4 / 2.0
        wanted = 3.0 - np.where(t < ramp, t * t, ramp * ramp + 0.4 * (t - ramp))
        assert lengths == pytest.approx(wanted, abs=1e-12)
        run.inputs["u"] = 0.0
        run.advance(300)
        assert run.natural_length(rope) == pytest.approx(wanted[-1] - 0.4 * ramp / 2, abs=1e-12)
        run.advance(10)
        assert run.v[run.system.lengths["rope"][0]] == 0.0

    @pytest.mark.parametrize(("way", "step"), [(-0.7, 2e-3), (0.9, 7e-3), (0.01, 2e-3), (-0.05, 1.3e-2)])
    def test_length_as_fast_as_it_can(self, way, step):
        """Way s with speed V and acceleration a: s/V + V/a, then it stops; short ones 2 sqrt(s/a)."""
        model, rope, _ = hoist(length="u", speed=0.5, first=3.0)
        run = ancf.stepper(model, step=step)
        run.inputs["u"] = 3.0 + way
        places = [3.0]
        for _ in range(round(3.0 / step)):
            run.advance()
            places.append(run.natural_length(rope))
        places, t = np.array(places), step * np.arange(len(places))
        s = abs(way)
        takes = s / 0.5 + 0.25 if s > 0.125 else 2.0 * np.sqrt(s / 2.0)
        arrived = t[np.flatnonzero(places == 3.0 + way)[0]]
        assert takes - step <= arrived <= takes + 4 * step
        assert np.all(places[t > arrived] == 3.0 + way)
        speeds = np.diff(places) / step
        assert np.abs(speeds).max() <= 0.5 + 1e-9
        assert np.abs(np.diff(speeds)).max() / step <= 2.0 * (1.0 + 1e-6)
        assert np.all(np.sign(way) * (places - 3.0 - way) <= 2.0 * step**2)  # not beyond

    def test_a_speed_of_time(self):
        model, rope, _ = hoist(speed="0.5*sin(2*t)", acceleration=5.0)
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        assert result.natural_length(rope) == pytest.approx(3.0 + 0.5 * np.sin(result.t) ** 2, abs=2e-3)

    def test_the_work_of_the_drum_is_supplied(self):
        """To the order of the steps: the acceleration of the drum jumps."""
        drift = []
        for step in (2e-3, 1e-3):
            model, _, _ = hoist(speed="u", first=-0.4)
            energy = ancf.simulate(model, t_end=0.8, step=step, start=ancf.equilibrium(model)).energy
            drift.append(np.abs(energy.drift).max() / energy.supplied.max())
        assert drift[1] < 0.6 * drift[0] < 1e-3
        lifted = 9.81 * (0.28 + 0.05 * 0.5 * (3.0**2 - 2.72**2)) + 0.5 * 1.14 * 0.4**2
        assert energy.supplied[-1] == pytest.approx(lifted, rel=0.01)


@pytest.mark.parametrize("kind", [BY_SPEED, BY_LENGTH], ids=["speed", "length"])
@pytest.mark.parametrize(
    "method",
    [ancf.Trapezoidal(), ancf.GeneralizedAlpha(0.8), ancf.Explicit(check=False)],
    ids=lambda m: type(m).__name__,
)
class TestTheSameBits:
    STEP, COUNT = 2e-4, 400

    def led(self, model, method):
        run = ancf.stepper(model, step=self.STEP, integrator=method)
        states = []
        for k in range(self.COUNT):
            run.inputs["u"] = told(20 * k * self.STEP, self.kind)
            run.advance()
            states.append(run.q)
        return run, np.array(states)

    def test_stepper_controller_and_resumed(self, kind, method, tmp_path):
        self.kind = kind
        _, steps = self.led(hoist(**kind)[0], method)
        assert np.ptp(steps[:, -3:]) > 0.0

        def controller(run):
            run.inputs["u"] = told(20 * run.t, kind)

        given = {"step": self.STEP, "integrator": method, "controller": controller}
        whole = ancf.simulate(hoist(**kind)[0], t_end=self.COUNT * self.STEP, **given)
        assert np.array_equal(whole.q[1:], steps)
        for stop in (1, 137):
            file = tmp_path / f"{stop}.h5"
            run = ancf.stepper(hoist(**kind)[0], step=self.STEP, integrator=method)
            for k in range(stop):
                run.inputs["u"] = told(20 * k * self.STEP, kind)
                run.advance()
            run.save(file)
            again = ancf.stepper(hoist(**kind)[0], start=file)
            for k in range(stop, self.COUNT):
                again.inputs["u"] = told(20 * k * self.STEP, kind)
                again.advance()
            assert np.array_equal(again.q, steps[-1])

    def test_many_at_once(self, kind, method):
        model, _, _ = hoist(**kind)
        runs = [ancf.stepper(model, step=self.STEP, integrator=method) for _ in range(2)]
        for run, parts in zip(runs, ([1] * 300, [7, 1, 92, 200]), strict=True):
            run.inputs["u"] = told(0.0, kind)
            for count in parts:
                run.advance(count)
        assert np.array_equal(runs[0].q, runs[1].q)


def test_a_state_goes_on_with_its_length_and_speed():
    model, rope, _ = hoist(speed="u")
    first = ancf.stepper(model, step=H)
    first.inputs["u"] = -0.4
    first.advance(150)
    other = ancf.stepper(hoist(speed="u")[0], step=H, start=first.state())
    assert other.natural_length(rope) == first.natural_length(rope) < 2.95
    assert other.inputs["u"] == -0.4
    for run in (first, other):
        run.advance(50)
    assert other.natural_length(rope) == pytest.approx(first.natural_length(rope), abs=1e-12)


def test_an_equilibrium_has_the_length_of_the_input():
    model, rope, _ = hoist(length="u", speed=0.5, first=2.5)
    state = ancf.equilibrium(model)
    assert state.natural_length(rope) == 2.5
    assert ancf.modes(model, about=state, count=1).frequencies[0] == pytest.approx(
        np.sqrt(9.81 / 2.5), rel=0.02
    )


def test_halved_steps_leave_the_lengths_that_follow(tmp_path):
    """Steps that are cut into parts: the next ones go on from where the drum is, also after a restart."""
    runs = []
    for count in (1, 40):
        model, _, _ = hoist(length="u", speed=0.5, first=3.0, acceleration=1.0)
        model.add_force("load", ["20*sin(60*t)", "40*sin(80*t)", "-30*cos(70*t)"])
        run = ancf.stepper(model, step=0.04)
        run.inputs["u"] = 2.0
        for _ in range(40 // count):
            run.advance(count)
            if run.t < 0.1:
                run.save(tmp_path / "early.h5")
        runs.append(run)
    again = ancf.stepper(model, start=tmp_path / "early.h5")
    again.advance(38)
    assert runs[0].stats.retries > 0
    assert np.array_equal(runs[0].q, runs[1].q)
    assert np.array_equal(runs[0].q, again.q)


def test_files(tmp_path):
    text = {
        "gravity": [0, 0, -9.81],
        "inputs": [{"name": "u", "value": -0.2}],
        "bodies": [
            {
                "name": "rope",
                "section": {"EA": 1e4, "EI": 1e-3, "rhoA": 0.05},
                "start": [0, 0, 0],
                "end": [0, 0, -3],
                "elements": 4,
            }
        ],
        "supports": [
            {"type": "pin", "point": "rope.start"},
            {"type": "winch", "point": "rope.start", "length": 3.0, "speed": "2*u", "acceleration": 2.0},
        ],
    }
    model = parse_study(text).model
    result = ancf.simulate(model, t_end=0.5, step=H, file=tmp_path / "out.h5")
    assert result.natural_length("rope")[-1] == pytest.approx(3.0 - 0.04 - 0.4 * 0.3, abs=1e-9)
    again = ancf.Model.from_dict(model.to_dict())
    assert np.array_equal(ancf.simulate(again, t_end=0.5, step=H).q, result.q[:])
    longer = ancf.resume(tmp_path / "out.h5", t_end=0.8)
    assert np.array_equal(longer.q[:], ancf.simulate(model, t_end=0.8, step=H).q)
    assert "speed 2*u [m/s], 2 m/s^2" in str(model)


class TestRefused:
    @pytest.mark.parametrize(
        ("given", "parts"),
        [
            ({"length": "u", "acceleration": None}, ["length", '"u"', "may jump", "speed="]),
            ({"speed": "u", "acceleration": None}, ["acceleration", "missing", "impulse"]),
            ({"speed": "u", "length": "3 - t"}, ["length", "function of time", "speed="]),
            ({"length": "u", "first": 3.0, "speed": "0.5*t"}, ["speed", "positive number"]),
            ({"length": "u", "first": 3.0, "speed": -0.5}, ["speed", "positive number"]),
            ({"speed": "u", "acceleration": -1.0}, ["acceleration"]),
            ({"acceleration": 1.0}, ["acceleration", "without speed"]),
            ({"length": "u", "first": 0.0, "speed": 0.5}, ["length", "0 m", "t = 0"]),
        ],
    )
    def test_what_is_given(self, given, parts):
        with pytest.raises(ModelError) as error:
            hoist(**given)
        for part in ("drum", *parts):
            assert part in str(error.value), str(error.value)

    def test_an_input_of_another_model(self):
        u = ancf.Model().add_input("v", 0.0)
        with pytest.raises(ModelError, match='input "v", which this model does not have'):
            hoist(speed=u)

    def test_methods_and_sensitivities(self):
        model, _, _ = hoist(speed="u")
        with pytest.raises(ModelError, match=r'integrator.*"drum".*Trapezoidal'):
            ancf.simulate(model, t_end=0.1, step=H, integrator=ancf.Radau())
        with pytest.raises(ModelError, match=r'"drum" follows from step to step'):
            ancf.simulate(model, t_end=0.1, step=H, sensitivities=["load.mass"])

    def test_nothing_left(self):
        """The step before can be asked, and the run goes on with another input."""
        model, rope, _ = hoist(speed="u", acceleration=50.0)
        run = ancf.stepper(model, step=1e-3)
        run.inputs["u"] = -10.0
        with pytest.raises((ModelError, SolveError), match='"rope"') as error:
            run.advance(1000)
        assert "drum" in str(error.value)
        assert "t = 0." in str(error.value)
        left = run.natural_length(rope)
        assert left > 0.003
        assert run.t < 0.5
