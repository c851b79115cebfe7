"""What the inputs of a run were, over time, against what was given and the motion that came of it."""

import csv
import itertools
import json
import shutil

import h5py
import numpy as np
import pandas
import pytest

import ancf
from ancf.model.tables import number
from ancf.viz.export import write_csv, write_parquet
from ancf.viz.export.workbook import described
from ancf.viz.scene import make_scene
from ancf.viz.view.curves import curves
from ancf.viz.view.histories import Histories

MASS, STEP = 2.0, 1e-2
METHODS = [
    ancf.Trapezoidal(),
    ancf.GeneralizedAlpha(0.8),
    ancf.Explicit(check=False),
    ancf.Radau(adaptive=False),
]


def pushed(push=None):
    """A mass that two inputs push."""
    model = ancf.Model(title="pushed")
    body = model.add_point_mass("body", at=(0, 0, 0), mass=MASS)
    thrust = model.add_input("thrust", 0.25, unit="N", description="pull of the drive")
    side = model.add_input("side", -1.0)
    model.add_force(body, push or (thrust, 2 * side, 0.0))
    return model


def at_random(name, seed, every):
    """Another value now and then."""
    draw = np.random.default_rng(seed)
    return lambda run: run.inputs.update({name: draw.uniform(-3, 3)}) if draw.random() < every else None


#: Controllers by name, each made anew.
LED = {
    "nothing": lambda: lambda run: None,
    "constant": lambda: lambda run: run.inputs.update(thrust=4.0),
    "the first value": lambda: lambda run: run.inputs.update(thrust=0.25),
    "ramp": lambda: lambda run: run.inputs.update(thrust=3.0 * run.t),
    "of the state": lambda: lambda run: run.inputs.update(side=1.0 - run.position("body")[1]),
    "both": lambda: lambda run: run.inputs.update(thrust=run.t, side=np.sin(9.0 * run.t)),
    "now and then": lambda: at_random("thrust", 3, 0.3),
    "and back": lambda: lambda run: run.inputs.update(side=round(run.t / STEP) % 2),
}


class Noting:
    """A controller that notes the inputs before each of its calls, and after."""

    def __init__(self, controller):
        self.controller, self.times, self.rows, self.first = controller, [], [], None

    def __call__(self, run):
        if self.first is None:
            self.first = dict(run.inputs)
        self.controller(run)
        self.times.append(run.t)
        self.rows.append(dict(run.inputs))

    def at(self, name, t):
        """What acted at times: given before them."""
        last = [max((k for k, s in enumerate(self.times) if s < x - 1e-9), default=None) for x in t]
        return np.array([(self.first if k is None else self.rows[k])[name] for k in last])


def simulated(controller, t_end=0.4, model=None, every=2, **given):
    given = {
        "step": STEP,
        "controller": controller,
        "control_step": every * STEP,
        "sensors": ["body"],
    } | given
    return ancf.simulate(model or pushed(), t_end=t_end, **given)


@pytest.mark.parametrize("every", [1, 3])
@pytest.mark.parametrize("name", LED)
def test_is_what_was_given(name, every, tmp_path):
    """In memory and in a file, at stored times and at all steps, by name and by the input itself."""
    noting = Noting(LED[name]())
    made = simulated(noting, every=every, output_step=4 * STEP)
    simulated(LED[name](), every=every, output_step=4 * STEP, file=tmp_path / "run.h5")
    for result in (made, ancf.load(tmp_path / "run.h5")):
        for key, item in result.model.inputs.items():
            assert result.input(key).tolist() == noting.at(key, result.t).tolist()
            assert result.sensors.input(item).tolist() == noting.at(key, result.sensors.t).tolist()
            t, values = result.input_changes(key)
            given = [(s, row[key]) for s, row in zip(noting.times, noting.rows, strict=True)]
            told = [(0.0, noting.first[key])]
            told += [new for old, new in itertools.pairwise([told[0], *given]) if new[1] != old[1]]
            assert list(zip(t.tolist(), values.tolist(), strict=True)) == told


@pytest.mark.parametrize("name", ["ramp", "both", "now and then"])
@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
def test_the_motion_came_of_it(method, name):
    """The momentum after a step is that of the forces which the inputs say, at its end or halfway."""
    result = simulated(LED[name](), integrator=method, every=1)
    force = np.stack([result.input("thrust"), 2.0 * result.input("side")], axis=1)
    v = result.velocity("body")[:, :2]
    if method.name == "radau":  # its stages lie within the step and see the new value alone
        wanted = STEP * np.cumsum(force[1:], axis=0)
    elif method.name == "generalized_alpha":
        return_to = result.acceleration("body")[:, :2]
        assert return_to == pytest.approx(force / MASS, abs=1e-12)
        return
    else:
        wanted = STEP * np.cumsum(0.5 * (force[1:] + force[:-1]), axis=0)
    assert MASS * (v[1:] - v[0]) == pytest.approx(wanted, abs=1e-10)


def test_earlier_states_know_them():
    """Forces of inertia need them, and a run that starts there goes on with them."""
    result = simulated(LED["both"](), every=1)
    a = result.acceleration("body")
    assert MASS * a[:, 0] == pytest.approx(result.input("thrust"), abs=1e-12)
    assert MASS * a[:, 1] == pytest.approx(2.0 * result.input("side"), abs=1e-12)
    for k in (5, 17, -1):
        on = ancf.simulate(pushed(), t_end=result.t[k] + 5 * STEP, step=STEP, start=result.state(k))
        for name in ("thrust", "side"):
            assert np.all(on.input(name) == result.input(name)[k])
            assert [x.tolist() for x in on.input_changes(name)] == [[0.0], [result.input(name)[k]]]


class TestSteps:
    @pytest.mark.parametrize("together", [1, 3])
    def test_of_a_stepper(self, together, tmp_path):
        """What is given twice before a step counts once; a stepper that was saved goes on with all."""
        draw = np.random.default_rng(5)
        run, noted = ancf.stepper(pushed(), step=STEP, sensors=["body"]), [0.25]
        for k in range(12):
            run.inputs["thrust"] = 99.0
            run.inputs["thrust"] = float(draw.uniform(-3, 3)) if k % 3 else run.inputs["thrust"]
            run.advance(together)
            noted += together * [run.inputs["thrust"]]
            if k == 7:
                run.inputs["side"] = 5.0
                run.save(tmp_path / "stop.h5")
                run = ancf.stepper(pushed(), start=tmp_path / "stop.h5")
        assert run.sensors.input("thrust").tolist() == noted
        t, values = run.sensors.input_changes("thrust")
        assert np.all(np.diff(t[1:]) > 0.0)
        assert set(values) <= set(noted)
        assert run.sensors.input("side").tolist() == [-1.0] * (8 * together + 1) + [5.0] * (4 * together)
        run.save(tmp_path / "end.h5")
        loaded = ancf.load(tmp_path / "end.h5")
        assert loaded.sensors.input("thrust").tolist() == noted
        assert loaded.input("thrust").tolist() == noted[-1:]
        on = ancf.resume(tmp_path / "end.h5", t_end=loaded.t[-1] + 3 * STEP)
        assert on.sensors.input("thrust").tolist() == noted + 3 * noted[-1:]

    def test_without_sensors_nothing_grows(self, tmp_path):
        run = ancf.stepper(pushed(), step=STEP)
        for k in range(5):
            run.inputs["thrust"] = float(k)
            run.advance()
        assert run._made.given is None
        run.save(tmp_path / "stop.h5")
        on = ancf.resume(tmp_path / "stop.h5", t_end=run.t + 2 * STEP)
        assert on.input("thrust").tolist() == [4.0] * 3


class TestEnds:
    """Runs that fail, are stopped or go on have the history of one that was not."""

    def failing(self, at):
        def control(run):
            if run.t > at:
                raise ValueError("no more")
            LED["both"]()(run)

        return control

    @pytest.mark.parametrize("at", [0.05, 0.21])
    def test_fails_midway(self, at, tmp_path):
        noting = Noting(self.failing(at))
        for file in (None, tmp_path / "run.h5"):
            with pytest.raises(ancf.ModelError, match="no more") as caught:
                simulated(noting, file=file)
            result = caught.value.result
            assert result.t[-1] > at
            assert result.input("side").tolist() == noting.at("side", result.t).tolist()
        assert ancf.load(tmp_path / "run.h5").input("side").tolist() == result.input("side").tolist()

    @pytest.mark.parametrize("name", ["both", "of the state", "constant"])
    @pytest.mark.parametrize("how", ["ended", "failed", "stopped", "no checkpoint"])
    def test_goes_on(self, how, name, tmp_path):
        """From its file, with the controller; what it gave just before it was stopped is there once."""
        path, controller = tmp_path / "run.h5", LED[name]()
        if how in ("ended", "no checkpoint"):
            simulated(controller, t_end=0.2, file=path)
        else:
            kind = {"failed": ValueError, "stopped": KeyboardInterrupt}[how]

            def control(run):
                controller(run)
                if run.t > 0.155:
                    raise kind("enough")

            with pytest.raises((ancf.ModelError, ancf.Interrupted)):
                simulated(control, file=path)
        if how == "no checkpoint":
            with h5py.File(path, "r+") as file:
                del file["checkpoints"]
            with pytest.warns(UserWarning, match="no checkpoint"):
                on = ancf.resume(path, t_end=0.4, controller=controller)
        else:
            on = ancf.resume(path, t_end=0.4, controller=controller)
        whole = simulated(controller)
        same = {"abs": 1e-9 if how == "no checkpoint" else 0.0, "rel": 0.0}  # without, times are counted anew
        for key in ("thrust", "side"):
            assert on.input(key) == pytest.approx(whole.input(key), **same)
            assert on.sensors.input(key) == pytest.approx(whole.sensors.input(key), **same)
            for mine, theirs in zip(on.input_changes(key), whole.input_changes(key), strict=True):
                assert mine == pytest.approx(theirs, **same)

    def test_file_of_a_version_that_kept_none(self, tmp_path):
        """Says so; resumed, it knows what it was given since."""
        path = tmp_path / "run.h5"
        simulated(LED["both"](), t_end=0.2, file=path)
        with h5py.File(path, "r+") as file:
            del file["inputs"]
        with pytest.raises(ancf.ModelError, match=r"the file keeps none \(simulate it again"):
            ancf.load(path).input("side")
        on = ancf.resume(path, t_end=0.4, controller=LED["both"]())
        whole = simulated(LED["both"]())
        known = np.isfinite(on.input("side"))
        assert known.sum() >= 20
        assert np.array_equal(on.input("side")[known], whole.input("side")[known])
        assert "side" in str(on)

    def test_damaged(self, tmp_path):
        simulated(LED["both"](), file=tmp_path / "run.h5")
        for k, spoil in enumerate(
            (
                lambda data: data.__setitem__((3, 0), 9.0),
                lambda data: data.__setitem__((0, 1), np.inf),
                lambda data: data.attrs.__setitem__("names", json.dumps(["thrust"])),
                lambda data: data.attrs.__setitem__("names", "{"),
            )
        ):
            copy = shutil.copy(tmp_path / "run.h5", tmp_path / f"{k}.h5")
            with h5py.File(copy, "r+") as file:
                spoil(file["inputs"])
            with pytest.raises(ancf.ModelError, match="damaged"):
                ancf.load(copy)


def test_without_a_controller_they_stay():
    """No table has a column of them that was not asked for."""
    result = ancf.simulate(pushed(lambda t: (t, 0.0, 0.0)), t_end=0.1, step=STEP)
    assert result.input("thrust").tolist() == [0.25] * 11
    assert not any("input" in name for name in result.to_pandas())
    assert "inputs" not in str(result)
    assert result.to_pandas("thrust")["input thrust [N]"].tolist() == [0.25] * 11


@pytest.mark.parametrize("name", ["thurst", "body", "", 3])
def test_unknown(name):
    result = simulated(LED["ramp"](), t_end=0.1)
    for ask in (result.input, result.input_changes, result.sensors.input):
        with pytest.raises(ancf.ModelError, match="input"):
            ask(name)


@pytest.fixture(scope="module")
def result():
    return simulated(LED["both"](), output_step=2 * STEP)


class TestTables:
    def test_csv_and_parquet(self, result, tmp_path):
        """A table of them at the stored times, and columns beside what sensors recorded at all steps."""
        wrote = {path.name: path for path in (*write_csv(result, tmp_path), *write_parquet(result, tmp_path))}
        for name, known in (("inputs", result), ("sensors", result.sensors)):
            with wrote[f"{name}.csv"].open(encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            frame = pandas.read_parquet(wrote[f"{name}.parquet"])
            for key, head in (("thrust", "input thrust [N]"), ("side", "input side")):
                assert [float(row[head]) for row in rows] == known.input(key).tolist()
                assert frame[head].tolist() == known.input(key).tolist()

    def test_frames(self, result):
        for known in (result, result.sensors):
            frame, data = known.to_pandas(), known.to_xarray()
            assert frame["input thrust [N]"].tolist() == known.input("thrust").tolist()
            assert frame.attrs["units"]["input thrust [N]"] == "N"
            assert frame.attrs["units"]["input side"] == ""
            assert frame.attrs["descriptions"] == {
                "input thrust [N]": "pull of the drive",
                "input side": "input side",
            }
            assert data["input side"].values.tolist() == known.input("side").tolist()
            assert data["input thrust"].attrs == {"units": "N", "long_name": "pull of the drive"}
            assert [*known.to_pandas("side")] == ["input side"]
            assert [*known.to_pandas(result.model.inputs["side"])] == ["input side"]

    def test_described(self, result):
        inputs = result.model.inputs
        assert described("input thrust [N]", inputs) == ("input thrust", "N", "pull of the drive")
        assert described("input side", inputs)[1:] == ("", "input, given while the run went on")

    def test_printed_and_plotted(self, result):
        low, high = result.input("side").min(), result.input("side").max()
        assert f"inputs   thrust 0 to 0.38 N, side {number(low)} to {number(high)}" in str(result)
        assert "thrust  0.25 N       pull of the drive" in str(result.model)
        drawn = {c.name: c for c in curves(result, Histories(result), [], make_scene(result))}
        assert drawn["thrust"].panel == "inputs, N"
        assert drawn["side"].values.tolist() == result.input("side").tolist()


class TestUnits:
    """What an input is measured in goes with its model."""

    def test_description_of_the_model(self):
        again = ancf.Model.from_dict(json.loads(json.dumps(pushed().to_dict())))
        assert again.to_dict() == pushed().to_dict()
        assert (again.inputs["thrust"].unit, again.inputs["side"].unit) == ("N", "")

    @pytest.mark.parametrize(
        ("given", "place"),
        [
            ({"unit": "N]"}, "unit"),
            ({"unit": "a\nb"}, "unit"),
            ({"unit": 3}, "unit"),
            ({"unit": "m" * 50}, "unit"),
            ({"description": None}, "description"),
        ],
    )
    def test_refused(self, given, place):
        with pytest.raises(ancf.ModelError, match=rf'^add_input\("u"\)\.{place}: '):
            ancf.Model().add_input("u", 1.0, **given)
