"""Series: histories from arrays and CSV files, what is between their values, what a cut-off keeps, noise."""

import json
import pickle
import warnings

import numpy as np
import pytest

import ancf
from ancf.columns import read_columns, split_unit
from ancf.model import TimeFunction
from ancf.model.file import read_study, schema
from ancf.model.functions.series import Series, noises
from ancf.model.functions.units import UNITS

MOTION = """
gravity = [0, 0, -9.81]
[[bodies]]
name = "rope"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 2
section = {{ EA = 1e4, EI = 0.01, rhoA = 0.1 }}
[[supports]]
type = "pin"
point = "rope.start"
displacement = {motion}
[simulation]
t_end = 0.1
step = 1e-3
"""


def study(folder, motion):
    path = folder / "model.toml"
    path.write_text(MOTION.format(motion=motion), encoding="utf-8")
    return read_study(path)


class TestBetween:
    @pytest.mark.parametrize("n", [41, 81])
    def test_a_spline_converges_with_the_fourth_power(self, n):
        """And its second derivative with the second."""
        x = np.linspace(0.9, 1.1, 301)

        def errors(count):
            t = np.linspace(0.0, 2.0, count)
            found = Series(t, np.sin(5 * t))
            return (
                np.abs(found(x)[:, 0] - np.sin(5 * x)).max(),
                np.abs(found(x, 2)[:, 0] + 25 * np.sin(5 * x)).max(),
            )

        coarse, fine = errors(n), errors(2 * n - 1)
        assert coarse[0] / fine[0] == pytest.approx(16, rel=0.15)
        assert coarse[1] / fine[1] == pytest.approx(4, rel=0.1)

    def test_straight_lines(self):
        found = Series([0, 1, 3], [0, 2, -2], interpolation="linear")
        assert found(np.array([-1, 0.5, 2, 9]))[:, 0].tolist() == [0, 1, 0, -2]

    def test_three_columns_relative_to_the_start(self):
        t = np.linspace(0, 1, 9)
        value = np.column_stack([5 + t, t**2, 0 * t])
        found = Series(t, value, unit="mm", relative=True)
        assert found(t) == pytest.approx(1e-3 * (value - value[0]), abs=1e-15)

    @pytest.mark.parametrize(
        ("unit", "wanted"), [("mm", 1e-3), ("kN", 1e3), ("deg", np.pi / 180), ("rpm", 2 * np.pi / 60)]
    )
    def test_units(self, unit, wanted):
        assert UNITS[unit] == pytest.approx(wanted, rel=1e-15)
        assert Series([0, 1], [2, 4], unit=unit)(np.ones(1))[0, 0] == pytest.approx(4 * wanted)


class TestCutoff:
    @pytest.mark.parametrize("uneven", [False, True])
    @pytest.mark.parametrize("share", [0.25, 0.5, 1.0, 2.0, 4.0])
    def test_keeps_of_a_vibration_what_it_says(self, share, uneven):
        """The filter 1/(1 + (sqrt(2) - 1) (f/fc)^4), in phase."""
        rng = np.random.default_rng(1)
        t = np.linspace(0.0, 10.0, 4001)
        t = np.sort(t + uneven * rng.uniform(-4e-4, 4e-4, t.size))
        found = Series(t, np.sin(2 * np.pi * share * 4.0 * t), cutoff=4.0)
        x = np.linspace(4.0, 6.0, 801)
        wave = 2 * np.pi * share * 4.0 * x
        kept = 1 / (1 + (np.sqrt(2) - 1) * share**4)
        in_phase, across = (2 * np.mean(found(x)[:, 0] * part(wave)) for part in (np.sin, np.cos))
        assert in_phase == pytest.approx(kept, rel=0.01)
        assert abs(across) < 2e-3

    def test_noise_of_a_moved_end_is_smoothed(self):
        """0.3 mm of noise at 200 Hz: with a cut-off the acceleration is that of the motion."""
        rng = np.random.default_rng(7)
        t = np.linspace(0.0, 2.0, 401)
        true = 0.05 * np.sin(2 * np.pi * t)
        found = Series(t, true + 3e-4 * rng.standard_normal(t.size), cutoff=4.0)
        inside = t[60:-60]
        wanted = -0.05 * (2 * np.pi) ** 2 * np.sin(2 * np.pi * inside)
        assert np.abs(found(inside, 2)[:, 0] - wanted).max() < 0.35 * np.abs(wanted).max()
        assert np.abs(found(inside)[:, 0] - true[60:-60]).max() < 3e-4


class TestNoise:
    @pytest.mark.parametrize("size", [1e-4, 3e-4, 1e-3])
    @pytest.mark.parametrize("interpolation", ["linear", "spline"])
    def test_is_found_and_measured(self, size, interpolation):
        rng = np.random.default_rng(3)
        t = np.linspace(0.0, 4.0, 801)
        value = 0.2 * np.sin(3 * t) + size * rng.standard_normal(t.size)
        high, rest, noise = Series(t, value, interpolation=interpolation).noise()
        assert high > 5 * rest
        assert noise == pytest.approx(size, rel=0.25)
        assert Series(t, value, cutoff=5.0).noise() is None

    @pytest.mark.parametrize("rate", [3.0, 20.0, 100.0])
    def test_a_motion_that_is_resolved_has_none(self, rate):
        t = np.linspace(0.0, 2.0, 801)
        assert Series(t, 0.3 * np.sin(rate * t)).noise() is None

    def test_a_run_warns(self):
        rng = np.random.default_rng(2)
        t = np.linspace(0.0, 1.0, 201)
        model = ancf.Model()
        mass = model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
        model.pin(mass, displacement=(Series(t, 0.3 * rng.standard_normal(t.size), unit="mm"), 0, 0))
        assert len(noises(model)) == 1
        with pytest.warns(UserWarning, match=r"rms\) lie above 25 Hz.* noise of about 0\.000\d+ m.*cutoff"):
            ancf.simulate(model, t_end=0.01, step=1e-3)


class TestInModels:
    def test_component_whole_and_description(self):
        t = np.linspace(0, 1, 11)
        lone = TimeFunction((Series(t, t**2, cutoff=3.0), "2*t", 5), 3, "load")
        whole = TimeFunction(Series(t, np.column_stack([t, 0 * t, -t])), 3, "load")
        at = np.array([0.0, 0.33, 0.7])
        assert lone.table(at)[:, 1].tolist() == (2 * at).tolist()
        assert whole.table(at)[:, 2] == pytest.approx(-at, abs=1e-12)
        for given in (lone, whole):
            again = TimeFunction(json.loads(json.dumps(given.describe())), 3, "load")
            assert np.array_equal(again.table(at), given.table(at))
            assert np.array_equal(pickle.loads(pickle.dumps(given)).table(at), given.table(at))
            assert not given.constant
        assert TimeFunction((Series([0, 1], [2, 2]), 0, 0), 3, "load").constant

    def test_a_moved_mass_follows_and_feels_the_acceleration(self):
        """A pin moved by a series against the same motion as a function."""
        t = np.linspace(0.0, 0.5, 101)
        runs = []
        for motion in (Series(t, 30 * np.sin(6 * t) ** 2, unit="mm"), lambda s: 0.03 * np.sin(6 * s) ** 2):
            model = ancf.Model()
            section = ancf.Section(EA=1e3, EI=0.1, rhoA=0.2)
            beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
            vector = (0, 0, motion) if isinstance(motion, Series) else (lambda s, f=motion: (0, 0, f(s)))
            model.clamp(beam.start, displacement=vector)
            runs.append(ancf.simulate(model, t_end=0.4, step=2e-3).position("beam.end")[-1])
        assert runs[0] == pytest.approx(runs[1], abs=2e-5)

    def test_in_a_file_and_in_its_results(self, tmp_path):
        rows = [f"{k};{3 * k};{'0,' + str(k)}" for k in range(10)]
        (tmp_path / "lab.csv").write_text("# by hand\nt [ms];x [mm];y [m]\n" + "\n".join(rows), "utf-8")
        motion = '[{ csv = "lab.csv", column = "x", relative = true }, 0, { csv = "lab.csv", column = "y" }]'
        made = study(tmp_path, motion).model
        [support] = made.supports
        at = np.array([0.0, 0.0045, 0.009, 1.0])
        assert support.displacement.table(at)[:, 0] == pytest.approx([0, 0.0135, 0.027, 0.027], abs=1e-12)
        assert support.displacement.table(at)[:, 2] == pytest.approx([0, 0.45, 0.9, 0.9], abs=1e-12)
        again = ancf.Model.from_dict(json.loads(json.dumps(made.to_dict())))
        assert np.array_equal(again.supports[0].displacement.table(at), support.displacement.table(at))

    def test_schema_knows_it(self):
        text = json.dumps(schema()["$defs"]["PinEntry"]["properties"]["displacement"])
        assert all(key in text for key in ('"csv"', '"column"', '"cutoff"', '"relative"', '"time_unit"'))

    def test_three_columns_of_a_file(self, tmp_path):
        (tmp_path / "a.csv").write_text("t,x,y,z\n0,0,1,2\n1,3,4,5\n", "utf-8")
        made = study(tmp_path, '{ csv = "a.csv", column = ["x", "y", "z"], unit = "cm" }').model
        found = made.supports[0].displacement(1.0)
        assert found == pytest.approx([0.03, 0.04, 0.05])


def wrong(text):
    return f'[{{ csv = "a.csv", {text} }}, 0, 0]'


BAD = [
    (wrong('column = "w"'), "displacement[0].column", '"w", the file has the columns "t", "x"'),
    (wrong('column = "x", unit = "furlong"'), "displacement[0].unit", "known are"),
    (wrong('column = "x", time_unit = "mm"'), "displacement[0].time_unit", 'wanted one of "s", "ms"'),
    (wrong('column = "x", cut = 3.0'), "displacement[0].cut", "unknown key"),
    (wrong('column = "x", cutoff = -1.0'), "displacement[0].cutoff", "must be > 0"),
    (wrong('column = "x", cutoff = 0.01'), "displacement[0].cutoff", "not one period"),
    (wrong('column = "x", cutoff = 3.0, interpolation = "linear"'), "displacement[0].cutoff", "spline"),
    (wrong('column = "words"'), 'displacement[0].csv: column "words"', "holds 'b' in row 3"),
    (wrong('column = ["x", "x", "x"]'), "displacement[0].value", ""),
    ('{ csv = "a.csv", column = "x" }', "displacement.value", "where three are wanted"),
    ('[{ csv = "none.csv", column = "x" }, 0, 0]', "displacement[0].csv", "no such file"),
    ('[{ t = [0, 1], values = [1, 2] }, 0, 0]', "displacement[0]", "a table has the keys"),
]  # fmt: skip


@pytest.mark.parametrize(("motion", "where", "says"), BAD)
def test_wrong_input_is_refused(tmp_path, motion, where, says):
    rows = "\n".join(f"{k / 10},{k},{'b' if k == 1 else k}" for k in range(9))
    (tmp_path / "a.csv").write_text("t,x,words\n" + rows, "utf-8")
    with pytest.raises(ancf.ModelError) as caught:
        study(tmp_path, motion)
    assert caught.value.where.startswith(f"supports[0].{where}")
    assert says in caught.value.what


@pytest.mark.parametrize("separator", [",", ";", "\t"])
def test_files_of_other_programs(tmp_path, separator):
    path = tmp_path / "a.csv"
    lines = ["# made by hand", separator.join(["t [s]", "x (mm)", "n"]), separator.join(["0", "1.5", "a"])]
    path.write_text("\n".join([*lines, separator.join(["1", "2.5", "b"]), separator * 2]), "utf-8-sig")
    assert read_columns(path, "x") == {"t [s]": [0, 1], "x (mm)": [1.5, 2.5], "n": ["a", "b"]}


@pytest.mark.parametrize(
    ("head", "parts"),
    [("x", ("x", "")), ("x [mm]", ("x", "mm")), ("a b (N m)", ("a b", "N m")), ("F / kN", ("F", "kN"))],
)
def test_heads(head, parts):
    assert split_unit(head) == parts


def test_nothing_is_said_of_a_model_without_series():
    model = ancf.Model()
    model.pin(model.add_point_mass("m", at=(0, 0, 0), mass=1.0), displacement=("t", 0, 0))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert noises(model) == []


class TestRamp:
    """first + (value - first) s with s of the minimum-jerk polynomial: 1/2 midway, flat at both ends."""

    @pytest.mark.parametrize("interpolation", ["linear", "spline"])
    @pytest.mark.parametrize("relative", [False, True])
    @pytest.mark.parametrize(("begin", "ramp"), [(0.0, 0.5), (-1.0, 0.8), (0.3, 1.7)])
    def test_sets_in_from_rest(self, begin, ramp, relative, interpolation):
        t = np.linspace(begin, 4.0, 4001)
        value = 2.0 + 0.3 * np.sin(7 * t + 0.4)
        plain = Series(t, value, interpolation=interpolation)
        found = Series(t, value, interpolation=interpolation, relative=relative, ramp=ramp)
        start = max(begin, 0.0)
        first = plain(np.array([start]))[0, 0]
        low = first if relative else 0.0
        at = np.array([start - 0.1, start, start + ramp / 2, start + ramp, 3.7, 5.0])
        share = np.array([0, 0, 0.5, 1, 1, 1])
        assert found(at)[:, 0] == pytest.approx(first - low + share * (plain(at)[:, 0] - first), abs=1e-12)
        near = start + 1e-3 * ramp * np.arange(3)
        # of the third order: neither a rate nor an acceleration at the beginning
        assert np.abs(np.diff(found(near)[:, 0])).max() < 1e-6 * 0.3

    @pytest.mark.parametrize("size", [1, 3])
    def test_derivatives_are_those_of_the_values(self, size):
        t = np.linspace(-0.5, 3.0, 200)
        value = np.column_stack([np.sin(4 * t), t**2, np.cos(t)])
        found = Series(t, value if size == 3 else value[:, 0], ramp=1.2, cutoff=5.0)
        at, d = np.array([-0.2, 0.1, 0.6, 1.1, 2.0]), 1e-4
        high, low, here = found(at + d), found(at - d), found(at)
        assert found(at, 1) == pytest.approx((high - low) / (2 * d), abs=1e-5)
        assert found(at, 2) == pytest.approx((high - 2 * here + low) / d**2, abs=1e-4)

    def test_is_read_and_written(self, tmp_path):
        rows = "\n".join(f"{k / 20},{np.sin(k / 3)}" for k in range(60))
        (tmp_path / "a.csv").write_text("t,x\n" + rows, "utf-8")
        entry = '[{ csv = "a.csv", column = "x", relative = true, ramp = 1.5 }, 0, 0]'
        model = study(tmp_path, entry).model
        [series] = model.supports[0].displacement.series
        assert series.ramp == 1.5
        again = ancf.Model.from_dict(model.to_dict()).supports[0].displacement
        at = np.linspace(0, 3, 50)
        assert np.array_equal(again.table(at), model.supports[0].displacement.table(at))
        copy = pickle.loads(pickle.dumps(series))
        assert np.array_equal(copy(at), series(at))
        assert "ramp=1.5 s" in repr(series)
        assert '"ramp"' in json.dumps(schema()["$defs"]["PinEntry"]["properties"]["displacement"])

    @pytest.mark.parametrize(
        ("first", "ramp", "says"),
        [(0.0, 5.0, "ends 2 s after t = 0"), (-3.0, 1.0, "ends 0 s"), (0.0, -1.0, "must be > 0")],
    )
    def test_longer_than_the_series(self, first, ramp, says):
        with pytest.raises(ancf.ModelError, match=r"Series\.ramp") as caught:
            Series([first, first + 1.0, first + 2.0], [0, 1, 0], ramp=ramp)
        assert says in caught.value.what

    @pytest.mark.parametrize("step", [2e-3, 5e-4])
    @pytest.mark.parametrize("ramp", [None, 0.5, 1.0])
    def test_what_is_moved_begins_at_rest(self, ramp, step):
        """With the rate of the measurement itself without a ramp."""
        t = np.linspace(0.0, 2.0, 401)
        motion = Series(t, 0.03 * np.sin(2 * np.pi * t), relative=True, ramp=ramp)
        model = ancf.Model()
        mass = model.add_point_mass("mass", at=(0, 0, 0), mass=2.0)
        model.hold(mass, position="xyz", displacement=(motion, 0, 0))
        run = ancf.simulate(model, t_end=0.4, step=step)
        first = run.velocity(mass)[0, 0]
        assert first == pytest.approx(0.03 * 2 * np.pi if ramp is None else 0.0, rel=1e-3, abs=1e-9)
        assert run.position(mass)[:, 0] == pytest.approx(motion(np.asarray(run.t))[:, 0], abs=1e-12)


class TestSpeeds:
    """Series of speeds, of which a support or a length takes the way."""

    @pytest.mark.parametrize("unit", ["m/s", "mm/s", "km/h", "rpm", ""])
    @pytest.mark.parametrize("how", ["linear", "spline"])
    def test_the_way_is_the_integral(self, how, unit):
        """Of a trapezoid of speeds exact with straight lines, of a sine to the fourth order."""
        scale = UNITS[unit] if unit else 1.0
        t = np.array([0.0, 1.0, 3.0, 4.0]) if how == "linear" else np.linspace(0.0, 4.0, 401)
        v = [0.0, 2.0, 2.0, 0.0] if how == "linear" else np.sin(3 * t)
        found = Series(t, v, unit=unit, interpolation=how, integrate=True)
        at = np.array([0.0, 0.5, 2.0, 3.5, 4.0])
        way = [0.0, 0.25, 3.0, 5.75, 6.0] if how == "linear" else (1 - np.cos(3 * at)) / 3
        assert found(at)[:, 0] == pytest.approx(scale * np.asarray(way), abs=1e-8)
        assert found(at, 1)[:, 0] == pytest.approx(scale * np.interp(at, t, v), abs=1e-4)
        assert found.unit == {"rpm": "rad", "": None}.get(unit, "m")
        again = pickle.loads(pickle.dumps(found))
        assert np.array_equal(again(at), found(at))
        assert again.unit == found.unit

    @pytest.mark.parametrize("columns", [1, 3])
    def test_a_cutoff_smooths_the_speeds(self, columns):
        t = np.linspace(0.0, 10.0, 501)
        noisy = np.sin(t)[:, None] + 0.2 * np.random.default_rng(1).standard_normal((len(t), columns))
        noisy = noisy[:, 0] if columns == 1 else noisy
        speeds = Series(t, noisy, unit="m/s", cutoff=1.0)
        found = Series(t, noisy, unit="m/s", cutoff=1.0, integrate=True)
        fine = np.linspace(0.0, 10.0, 20001)
        v = speeds(fine)
        way = np.vstack([np.zeros(columns), np.cumsum(0.5 * (v[1:] + v[:-1]) * (fine[1] - fine[0]), axis=0)])
        assert found(fine) == pytest.approx(way, abs=1e-6)
        assert found(fine, 1) == pytest.approx(v, abs=1e-12)
        assert found(fine[1:-1], 2) == pytest.approx(speeds(fine[1:-1], 1), abs=1e-9)

    def test_a_constant_speed_is_no_constant_way(self):
        model = ancf.Model()
        mass = model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
        speed = Series([0.0, 1.0, 2.0], [2.0, 2.0, 2.0], unit="m/s", integrate=True)
        model.hold(mass, position="xyz", displacement=(speed, 0, 0))
        mass.set_motion(velocity=(2.0, 0, 0))
        run = ancf.simulate(model, t_end=1.0, step=0.01)
        assert run.position(mass)[:, 0] == pytest.approx(2.0 * run.t, abs=1e-12)

    def test_one_time_is_enough(self):
        for more in ({}, {"interpolation": "linear"}, {"cutoff": 2.0}, {"ramp": 0.5}, {"integrate": True}):
            found = Series(np.linspace(0, 1, 11), np.linspace(0, 2, 11), **more)
            assert np.array_equal(found(0.75), found(np.array([0.75])))
            assert found(0.75).shape == (1, 1)

    @pytest.mark.parametrize("unit", ["mm", "kN", "m/s^2", "1"])
    def test_what_is_no_speed_is_refused(self, unit):
        with pytest.raises(ancf.ModelError, match=r"Series\.integrate: is of speeds, the values are in"):
            Series([0, 1], [0, 1], unit=unit, integrate=True)

    def test_a_file_moves_a_support_by_its_speeds(self, tmp_path):
        (tmp_path / "trolley.csv").write_text("t [s];v [mm/s]\n0;0\n1;2000\n3;2000\n4;0\n", encoding="utf-8")
        motion = '[{ csv = "trolley.csv", column = "v", interpolation = "linear"%s }, 0, 0]'
        found = study(tmp_path, motion % ", integrate = true").model
        for model in (found, ancf.Model.from_dict(json.loads(json.dumps(found.to_dict())))):
            [support] = model.supports
            assert support.displacement(3.5)[0] == pytest.approx(5.75)
        with pytest.raises(ancf.ModelError, match="must be in m") as caught:
            study(tmp_path, motion % "")
        assert "integrate = true" in caught.value.hint
