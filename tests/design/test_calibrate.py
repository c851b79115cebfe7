"""Calibration: linear problems against NumPy, known truths behind noise, and what the data cannot tell."""

import json
import shutil

import numpy as np
import pandas as pd
import pytest

import ancf
from ancf.design.calibrate import STARTS
from ancf.design.calibration_file import read_calibration
from ancf.design.weights import apart, noise_of
from example_scripts import script
from places import EXAMPLES

T = np.linspace(0.0, 2.0, 41)


def line(a, b):
    return {"y": a + b * T}


def wave(size, rate):
    return {"y": size * np.exp(-rate * T), "z": size * np.cos(3.0 * T)}


def noisy(exact, noise, seed):
    draw = np.random.default_rng(seed)
    return {"t": T} | {
        name: x + noise * np.std(x) * draw.standard_normal(len(x)) for name, x in exact.items()
    }


def beam(EI, damping):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=EI, rhoA=0.05, damping=damping)
    made = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section)
    model.clamp(made.start)
    return model


@pytest.fixture(scope="module")
def swinging():
    result = ancf.simulate(beam(0.3, 0.05), t_end=0.6, step=4e-3)
    return result.t, result.position("beam.end")[:, 2]


class TestPriors:
    """Against the normal equations of Bayes's rule for Gaussian noise and Gaussian priors."""

    @pytest.mark.parametrize(
        ("priors", "deviation"),
        [
            ({"a": (0.8, 0.02)}, 0.1),
            ({"b": (-1.0, 0.5)}, 0.3),
            ({"b": (-1.5, 0.1), "a": (2.0, 0.2)}, 0.15),
        ],
    )
    def test_are_further_measurements(self, priors, deviation):
        draw = np.random.default_rng(4)
        y = 1.0 - 2.0 * T + deviation * draw.standard_normal(len(T))
        bounds = {"a": (-5.0, 5.0), "b": (-5.0, 5.0)}
        fit = ancf.calibrate(line, {"t": T, "y": y}, bounds, deviations=deviation, priors=priors)
        slopes = np.stack([np.ones_like(T), T], axis=1) / deviation
        weights = np.array([1.0 / priors[name][1] ** 2 if name in priors else 0.0 for name in "ab"])
        means = np.array([priors[name][0] if name in priors else 0.0 for name in "ab"])
        whole = slopes.T @ slopes + np.diag(weights)
        solution = np.linalg.solve(whole, slopes.T @ y / deviation + weights * means)
        assert [*fit.values.values()] == pytest.approx(solution, rel=1e-6)
        left = np.sum(((solution[0] + solution[1] * T - y) / deviation) ** 2) / (len(T) - 2)
        assert fit.covariance == pytest.approx(max(left, 1.0) * np.linalg.inv(whole), rel=1e-5)
        assert fit.freedom == len(T) + len(priors) - 2
        assert fit.as_dict()["parameters"]["b"].get("prior") == ([*priors["b"]] if "b" in priors else None)

    def test_of_what_the_data_do_not_see(self):
        """The sum of two parameters is measured; a prior of one tells both."""
        data = {"t": T, "y": 3.0 * T}
        fit = ancf.calibrate(
            lambda a, b: {"y": (a + b) * T},
            data,
            {"a": (0, 5), "b": (0, 5)},
            deviations=1e-3,
            priors={"a": (1.0, 0.2), "b": (1.9, 0.4)},
        )
        # the sum is 3 to 1e-3: of the 0.1 that are missing each takes as its variance wants
        assert fit.values["a"] == pytest.approx(1.0 + 0.1 * 0.04 / 0.2, abs=1e-4)
        assert fit.values["b"] == pytest.approx(1.9 + 0.1 * 0.16 / 0.2, abs=1e-4)
        assert not fit.untold[1:]
        assert "the data tell less of a than its prior does" not in fit.notes()

    def test_of_what_the_data_do_not_touch(self):
        fit = ancf.calibrate(
            lambda a, b: {"y": a * T},
            noisy(line(0.0, 2.0), 0.01, 3),
            {"a": (0, 5), "b": (0, 5)},
            deviations=0.02,
            priors={"b": (1.0, 0.3)},
        )
        assert fit.values["b"] == pytest.approx(1.0)
        assert fit.untold == ["b"]
        assert "the data tell less of b than its prior does" in fit.notes()


class TestGivenDerivatives:
    @pytest.mark.parametrize("bounds", [(0.1, 0.9), (0.01, 10.0)])
    def test_save_runs_and_change_nothing(self, bounds):
        """One parameter of two with its derivative, looked for itself and by its logarithm."""

        def given(size, rate):
            own = {column: x / size for column, x in wave(size, rate).items()}
            return wave(size, rate), {"size": own}

        data = noisy(wave(0.5, 0.7), 0.02, 5)
        wanted = {"size": bounds, "rate": (0.1, 5.0)}
        plain = ancf.calibrate(wave, data, wanted, priors={"size": (0.45, 0.01)}, deviations=0.01)
        fit = ancf.calibrate(given, data, wanted, priors={"size": (0.45, 0.01)}, deviations=0.01)
        assert fit.values == pytest.approx(plain.values, rel=1e-6)
        assert fit.covariance == pytest.approx(plain.covariance, rel=1e-4)
        assert fit.evaluations < plain.evaluations

    def test_of_a_column_that_does_not_change(self):
        def given(size, rate):
            return wave(size, rate), {"rate": {"y": -T * wave(size, rate)["y"]}}  # z does not know it

        data = noisy(wave(0.5, 0.7), 0.02, 6)
        bounds = {"size": (0.1, 0.9), "rate": (0.1, 0.9)}
        plain, fit = ancf.calibrate(wave, data, bounds), ancf.calibrate(given, data, bounds)
        assert fit.values == pytest.approx(plain.values, rel=1e-6)


class TestLinear:
    @pytest.mark.parametrize("seed", [1, 2, 3])
    def test_is_linear_regression(self, seed):
        data = noisy(line(1.0, -2.0), 0.05, seed)
        fit = ancf.calibrate(line, data, {"a": (-5.0, 5.0), "b": (-5.0, 5.0)})
        slopes = np.stack([np.ones_like(T), T], axis=1)
        solution, left, *_ = np.linalg.lstsq(slopes, data["y"], rcond=None)
        covariance = left[0] / (len(T) - 2) * np.linalg.inv(slopes.T @ slopes)
        assert [*fit.values.values()] == pytest.approx(solution, rel=1e-7)
        assert fit.covariance == pytest.approx(covariance, rel=1e-6)
        assert fit.correlation[0, 1] == pytest.approx(
            covariance[0, 1] / np.sqrt(np.prod(np.diag(covariance)))
        )
        assert fit.rms["y"] == pytest.approx(np.sqrt(left[0] / len(T)))
        low, high = fit.confidence(0.9)["b"]
        assert (high - low) / 2 == pytest.approx(1.6849 * fit.deviations["b"], rel=1e-4)  # Student's, 39
        assert fit.notes() == []
        assert fit.converged

    def test_missing_entries_are_left_out(self):
        data = noisy(line(1.0, -2.0), 0.05, 1)
        holes = data["y"].copy()
        holes[::3] = np.nan
        fit = ancf.calibrate(line, data | {"y": holes}, {"a": (-5.0, 5.0), "b": (-5.0, 5.0)})
        there = np.isfinite(holes)
        assert [*fit.values.values()] == pytest.approx(np.polyfit(T[there], holes[there], 1)[::-1], rel=1e-7)
        assert fit.count == there.sum() == len(fit.residuals["y"])

    @pytest.mark.parametrize(
        ("deviations", "workers"),
        [
            (None, 0),
            ({"y": 0.1, "z": 0.2}, 2),
            (3.0, 0),
            *(pytest.param(d, w, marks=pytest.mark.slow) for d, w in ((None, 2), (3.0, 2))),
        ],
    )
    def test_workers_find_the_same(self, deviations, workers):
        data = noisy(wave(2.0, 0.7), 0.02, 5)
        bounds = {"size": (0.01, 100.0), "rate": (0.0, 5.0)}
        fit = ancf.calibrate(wave, data, bounds, deviations=deviations, workers=workers)
        alone = ancf.calibrate(wave, data, bounds, deviations=deviations)
        assert fit.values == alone.values
        for name, value in (("size", 2.0), ("rate", 0.7)):
            assert abs(fit.values[name] - value) < 4 * fit.deviations[name]

    def test_derivatives_are_of_the_parameters_themselves(self):
        """Also where their logarithms were looked for: near and far bounds give the same errors."""
        data = noisy(wave(2.0, 0.7), 0.02, 5)
        near, far = (
            ancf.calibrate(wave, data, {"size": b, "rate": (0.1, 5.0)}) for b in ((1.0, 3.0), (1e-3, 1e3))
        )
        assert near.covariance == pytest.approx(far.covariance, rel=1e-4)


class TestCoverage:
    def test_of_intervals(self):
        """With 5 % noise the truth is within two standard errors about as often as it should be."""
        inside = []
        for seed in range(200):
            fit = ancf.calibrate(
                wave, noisy(wave(2.0, 0.7), 0.05, seed), {"size": (1.0, 3.0), "rate": (0.0, 2.0)}
            )
            errors = fit.deviations
            inside += [abs(fit.values[k] - v) < 2 * errors[k] for k, v in (("size", 2.0), ("rate", 0.7))]
        assert 0.92 <= np.mean(inside) <= 0.985

    @pytest.mark.parametrize("repeats", [12, pytest.param(100, marks=pytest.mark.slow)])
    def test_of_a_beam_with_noise(self, swinging, repeats):
        """Behind 1 % noise, EI and damping within two standard errors in 93 of 100."""
        t, z = swinging
        inside = []
        for seed in range(repeats):
            measured = z + 0.01 * np.std(z) * np.random.default_rng(seed).standard_normal(len(z))
            data = {"t": t[::2], "position(beam.end)[2]": measured[::2]}
            bounds = {"EI": (0.1, 10.0), "damping": (0.0, 0.5)}
            fit = ancf.calibrate(beam, data, bounds, start={"EI": 0.35, "damping": 0.08}, step=4e-3)
            inside.append(
                [abs(fit.values[k] - v) < 2 * fit.deviations[k] for k, v in (("EI", 0.3), ("damping", 0.05))]
            )
        least = 0.93 if repeats >= 100 else 0.75
        assert np.all(np.mean(inside, axis=0) >= least)

    def test_without_noise_the_truth(self, swinging):
        t, z = swinging
        data = pd.DataFrame({"t": t, "position(beam.end)[2]": z})
        fit = ancf.calibrate(beam, data, {"EI": (0.1, 10.0), "damping": (0.0, 0.5)}, step=4e-3)
        assert fit.values == pytest.approx({"EI": 0.3, "damping": 0.05}, rel=1e-7)


SWAY = {"size": (0.1, 1.0), "rate": (0.0, 2.0)}
RATE = {"rate": (1.0, 20.0)}


def sway(size, rate):
    """Two columns that both tell both parameters, the second of some per cent of the first."""
    return {"y": size * np.exp(-rate * T), "z": 0.07 * size * np.cos(2.0 * rate * T)}


def behind(deviations, seed, size=0.4, rate=0.7):
    """What they are behind noise of these deviations."""
    draw = np.random.default_rng(seed)
    exact = sway(size, rate)
    return {"t": T} | {name: exact[name] + d * draw.standard_normal(len(T)) for name, d in deviations.items()}


class TestNoise:
    """Columns whose noise is not in proportion to their spread."""

    @pytest.mark.parametrize("noise", [(3e-3, 3e-3), (3e-2, 1e-4), (1e-4, 1e-2), (6e-3, 4e-4)])
    def test_intervals_hold(self, noise):
        """The truth is within 95 % intervals about as often as it should be, and the noise is found."""
        deviations, inside, sizes = dict(zip("yz", noise, strict=True)), [], []
        for seed in range(150):
            fit = ancf.calibrate(sway, behind(deviations, seed), SWAY)
            for name, (low, high) in fit.confidence(0.95).items():
                inside.append(low < {"size": 0.4, "rate": 0.7}[name] < high)
            if fit.estimated:
                sizes.append([fit.scales[name] / deviations[name] for name in "yz"])
        assert 0.92 <= np.mean(inside) <= 0.985
        if max(noise) / min(noise) != 15.0:
            assert len(sizes) > 100
            assert np.mean(sizes, axis=0) == pytest.approx([1.0, 1.0], abs=0.05)

    @pytest.mark.parametrize("seed", [1, 2, 3])
    def test_is_as_if_it_were_given(self, seed):
        """Nearly: of 41 numbers a column the noise is known within a tenth. In processes it is the same."""
        deviations = {"y": 3e-3, "z": 3e-3}
        data = behind(deviations, seed)
        fit, given = (ancf.calibrate(sway, data, SWAY, deviations=d) for d in (None, deviations))
        assert set(fit.estimated) == {"y", "z"}
        assert "the noise of the columns was estimated" in fit.notes()[0]
        assert f"y {fit.scales['y']:.3g}, z {fit.scales['z']:.3g}" in fit.notes()[0]
        for name in given.values:
            assert fit.values[name] == pytest.approx(given.values[name], abs=0.5 * given.deviations[name])
            assert fit.deviations[name] == pytest.approx(given.deviations[name], rel=0.3)
        assert given.notes() == []
        assert ancf.calibrate(sway, data, SWAY, workers=2).values == fit.values

    @pytest.mark.parametrize("given", ["y", "z"])
    def test_of_one_column_is_given(self, given):
        """The other one is weighed beside it."""
        fit = ancf.calibrate(
            sway,
            behind({"y": 3e-3, "z": 2e-3}, 7),
            SWAY,
            deviations={given: {"y": 3e-3, "z": 2e-3}[given]},
        )
        (other,) = fit.estimated
        assert other != given
        assert fit.scales[other] == pytest.approx({"y": 3e-3, "z": 2e-3}[other], rel=0.35)

    @pytest.mark.parametrize("seed", range(4))
    def test_in_proportion_stays(self, seed):
        """Where columns hardly differ, their weights are those of their spread."""
        fit = ancf.calibrate(sway, noisy(sway(0.4, 0.7), 0.02, seed), SWAY)
        assert not fit.estimated
        assert fit.notes() == []

    def test_that_is_none(self):
        """Computed data have none: no column becomes infinitely heavy."""
        fit = ancf.calibrate(sway, {"t": T, **sway(0.4, 0.7)}, SWAY)
        assert fit.values == pytest.approx({"size": 0.4, "rate": 0.7}, rel=1e-7)

    def test_of_a_column_with_few_numbers(self):
        """It is not told: the column keeps its weight."""
        data = behind({"y": 3e-3, "z": 3e-3}, 3)
        few = np.full(len(T), np.nan)
        few[[0, 20, 40]] = data["z"][[0, 20, 40]]
        fit = ancf.calibrate(sway, data | {"z": few}, SWAY)
        assert "z" not in fit.estimated
        assert abs(fit.values["rate"] - 0.7) < 4 * fit.deviations["rate"]


@pytest.mark.parametrize("unit", [0.3, 1.0, 5.0])
@pytest.mark.parametrize("ratio", [0.1, 2.0, 7.0])
def test_noise_beside_what_is_known(unit, ratio):
    """What a column with a known deviation leaves is the unit, whatever its size."""
    draw, count = np.random.default_rng(4), 5000
    rows = {"known": slice(0, count), "other": slice(count, 2 * count)}
    residuals = unit * draw.standard_normal(2 * count)
    residuals[count:] *= ratio
    jacobian = draw.standard_normal((2 * count, 3))
    found = noise_of(rows, residuals, jacobian, frozenset(["known"]))
    assert found == {"known": 1.0, "other": pytest.approx(ratio, rel=0.05)}
    alone = noise_of(rows, residuals, jacobian, frozenset())
    assert alone == pytest.approx({"known": unit, "other": ratio * unit}, rel=0.05)
    assert apart(alone) == pytest.approx(max(ratio, 1 / ratio), rel=0.05)


class TestValleys:
    """``cos(rate t)``: beside the right rate there are others which no way downhill leaves."""

    @staticmethod
    def cosine(rate):
        return {"y": np.cos(rate * T)}

    @pytest.mark.parametrize("rate", [9.5, 10.5, 12.4])
    def test_that_the_middle_of_the_bounds_misses(self, rate):
        data = noisy(self.cosine(rate), 0.02, 1)
        middle = ancf.calibrate(self.cosine, data, RATE, start={"rate": 20.0**0.5})
        assert abs(middle.values["rate"] - rate) > 1.0
        fit = ancf.calibrate(self.cosine, data, RATE)
        assert fit.values["rate"] == pytest.approx(rate, abs=0.02)

    @pytest.mark.parametrize("rate", [1.7, 5.3, 7.4, 14.2, 18.0])
    def test_the_best_of_some_points_is_the_start(self, rate):
        """Where none of them lies in the right valley, the fit is no worse than any of them."""
        data, asked = noisy(self.cosine(rate), 0.02, 1), []

        def watched(rate):
            asked.append(rate)
            return self.cosine(rate)

        fit = ancf.calibrate(watched, data, RATE)
        left = [np.sum((self.cosine(one)["y"] - data["y"]) ** 2) for one in asked[:STARTS]]
        assert asked[0] == pytest.approx(20.0**0.5)
        assert asked[STARTS] == asked[int(np.argmin(left))]
        assert np.sum(fit.residuals["y"] ** 2) <= min(left)
        gaps = np.diff(np.log([1.0, *sorted(asked[:STARTS]), 20.0]))
        assert gaps.max() < 2.5 * np.log(20.0) / (STARTS + 1)

    @pytest.mark.parametrize("start", [1.5, 14.0, 17.0])
    def test_another_one_is_told(self, start):
        data = noisy(self.cosine(7.4), 0.02, 1)
        fit = ancf.calibrate(self.cosine, data, RATE, start={"rate": start}, deviations=0.02)
        assert abs(fit.values["rate"] - 7.4) > 1.0
        (note,) = [note for note in fit.notes() if "times the deviations" in note]
        assert note.startswith(f"the residuals are {fit.excess:.2g} times the deviations that were given")
        assert fit.excess == pytest.approx(fit.rms["y"] / 0.02, rel=0.05)

    @pytest.mark.parametrize(("factor", "told"), [(0.3, True), (0.7, False), (1.0, False), (3.0, False)])
    @pytest.mark.parametrize("seed", range(5))
    def test_noise_that_is_given_wrong(self, factor, told, seed):
        """Told where the residuals are more than twice as large."""
        data = behind({"y": 0.01, "z": 0.01}, seed)
        fit = ancf.calibrate(sway, data, SWAY, deviations=0.01 * factor)
        assert any("times the deviations" in note for note in fit.notes()) is told


class TestWhatDataCannotTell:
    def test_a_parameter_without_effect(self):
        fit = ancf.calibrate(
            lambda a, b: {"y": a * T + 0.0 * b}, noisy({"y": 2.0 * T}, 0.01, 1), {"a": (0, 5), "b": (0, 1)}
        )
        assert fit.untold == ["b"]
        assert np.isinf(fit.deviations["b"])
        assert fit.values["a"] == pytest.approx(2.0, abs=0.02)
        assert np.isfinite(fit.deviations["a"])
        assert fit.notes() == ["the data tell less of b than its bounds do"]

    def test_two_that_act_as_one(self):
        """Their sum is told, neither of them is."""
        data = noisy({"y": 3.0 * T}, 0.01, 1)
        fit = ancf.calibrate(lambda a, b: {"y": (a + b) * T}, data, {"a": (0, 5), "b": (0, 5)})
        assert fit.untold == ["a", "b"]
        assert sum(fit.values.values()) == pytest.approx(3.0, abs=0.02)

    def test_nearly_one(self):
        data = noisy({"y": T + 0.01 * T**2}, 0.01, 1)
        fit = ancf.calibrate(
            lambda a, b: {"y": a * T + b * np.sin(T)}, data, {"a": (-50.0, 50.0), "b": (-50.0, 50.0)}
        )
        assert abs(fit.correlation[0, 1]) > 0.95
        assert "are told together only" in fit.notes()[-1]

    def test_bounds(self):
        fit = ancf.calibrate(line, noisy(line(1.0, -2.0), 0.01, 1), {"a": (-5.0, 0.5), "b": (-5.0, 5.0)})
        assert fit.at_bounds == ["a"]
        assert "a ended at a bound" in fit.notes()


class TestBad:
    @pytest.mark.parametrize(
        ("given", "phrase"),
        [
            ({"parameters": {}}, "must be bounds (low, high) by name"),
            (
                {"parameters": {"a": (2.0, 1.0), "b": (0, 1)}},
                "has the bounds 2 and 1, the first must be below",
            ),
            ({"parameters": {"a": 3.0, "b": (0, 1)}}, "calibrate.parameters: a"),
            ({"data": {"t": T}}, 'wanted "t" and at least one'),
            ({"data": {"y": T}}, 'wanted "t" and at least one'),
            ({"data": {"t": T, "y": T[1:]}}, "has 40 entries for 41 times"),
            ({"data": {"t": T[::-1], "y": T}}, "must be increasing times"),
            ({"data": {"t": T, "y": ["x"] * 41}}, "must hold numbers, holds 'x'"),
            ({"data": {"t": T, "x": T}}, 'numbers for "x"; returned "y"'),
            ({"data": {"t": T, "y": 0 * T}}, "is constant (give its deviation)"),
            ({"data": {"t": [0.0, 1.0], "y": [0.0, 1.0]}}, "has 2 numbers for 2 parameters"),
            ({"data": 3.0}, "must be a file, a table or columns by name"),
            ({"data": "nowhere.csv"}, "no such file"),
            ({"start": {"c": 1.0}}, "calibrate.start: c: is no parameter"),
            ({"priors": {"c": (1.0, 1.0)}}, "calibrate.priors: c: is no parameter"),
            ({"priors": {"a": (9.0, 1.0)}, "deviations": 0.1}, "must be between -5 and 5"),
            ({"priors": {"a": (1.0, 0.0)}, "deviations": 0.1}, "its deviation: must be > 0"),
            ({"priors": {"a": 1.0}, "deviations": 0.1}, "calibrate.priors: a"),
            ({"priors": [1.0]}, "must be pairs (mean, deviation) by name"),
            ({"priors": {"a": (1.0, 1.0)}}, "are missing: there are priors"),
            ({"priors": {"a": (1.0, 1.0)}, "deviations": {}}, "has no deviation: there are priors"),
            ({"build": lambda a, b: (line(a, b), {"c": {}})}, 'derivatives by "c", which is no parameter'),
            ({"build": lambda a, b: (line(a, b), 1.0)}, "must return derivatives by parameter"),
            ({"build": lambda a, b: (line(a, b), {"a": 1.0})}, 'must return derivatives by "a" for columns'),
            ({"start": {"a": 9.0}}, "must be between -5 and 5"),
            ({"deviations": {"x": 1.0}}, "is the deviation of no column"),
            ({"deviations": -1.0}, "must be > 0"),
            ({"build": lambda a, b: beam(1.0, 0.0)}, "calibrate.step: is missing"),
            ({"build": lambda a, b: {"y": T[1:]}}, "must be 41 finite numbers, has the shape (40,)"),
            ({"build": lambda a, b: {"y": T * np.nan}}, "is not finite"),
            ({"build": lambda a, b: 3.0}, "must return a Model, or numbers"),
        ],
    )
    def test_one_message(self, given, phrase):
        wanted = {
            "build": line,
            "data": noisy(line(1, 2), 0.1, 1),
            "parameters": {"a": (-5, 5), "b": (-5, 5)},
        }
        wanted |= given
        with pytest.raises(ancf.ModelError) as caught:
            ancf.calibrate(wanted.pop("build"), wanted.pop("data"), wanted.pop("parameters"), **wanted)
        assert phrase in str(caught.value)

    @pytest.mark.parametrize(
        ("column", "phrase"),
        [
            ("position(baem.end)[2]", 'did you mean "beam"'),
            ("positoin(beam.end)[2]", 'unknown name "positoin"'),
            ("max(position(beam.end)[2])", "must give one at each"),
            ("position(beam.end)", "must give one at each"),
        ],
    )
    def test_columns_that_the_model_does_not_have(self, column, phrase):
        data = {"t": T, column: T}
        with pytest.raises(ancf.ModelError) as caught:
            ancf.calibrate(beam, data, {"EI": (0.1, 1.0), "damping": (0.0, 1.0)}, step=0.02)
        assert phrase in str(caught.value)

    def test_a_step_that_fails_is_not_taken(self):
        def fragile(a, b):
            if a > 3.0:
                raise ancf.SolveError("t = 1 s", "diverged")
            return line(a, b)

        fit = ancf.calibrate(fragile, noisy(line(2.5, -1.0), 0.01, 1), {"a": (-5.0, 5.0), "b": (-5.0, 5.0)})
        assert fit.values["a"] == pytest.approx(2.5, abs=0.05)

    def test_a_start_that_fails(self):
        def broken(a, b):
            raise ancf.SolveError("t = 1 s", "diverged")

        with pytest.raises(ancf.SolveError, match="diverged"):
            ancf.calibrate(broken, noisy(line(2.5, -1.0), 0.01, 1), {"a": (-5.0, 5.0), "b": (-5.0, 5.0)})


class TestCommand:
    @pytest.fixture
    def here(self, tmp_path):
        for name in ("calibrate.toml", "calibrate_model.toml", "calibrate.csv"):
            shutil.copy(EXAMPLES / name, tmp_path)
        return tmp_path

    def test_example(self, here, call):
        """It finds what its data were made with."""
        ran = call("calibrate", here / "calibrate.toml", "-o", "out", "-j", "0")
        assert ran.code == 0, ran.err
        found = json.loads((here / "out" / "fit.json").read_text(encoding="utf-8"))
        for name, value in script("calibrate").TRUE.items():
            row = found["parameters"][name]
            assert abs(row["value"] - value) < 3.5 * row["deviation"]
            assert row["deviation"] < 0.01 * value
        assert found["notes"] == []
        page = (here / "out" / "report.html").read_text(encoding="utf-8")
        assert "A cable from its motion" in page
        table = pd.read_csv(here / "out" / "fit.csv")
        assert len(table) == 101
        assert len(table.columns) == 13

    def test_data_of_the_example_are_what_its_script_makes(self):
        made = script("calibrate")
        t, columns = made.measured()
        stored = pd.read_csv(EXAMPLES / "calibrate.csv")
        assert [*stored.columns] == ["t", *made.COLUMNS]
        assert stored["t"].to_numpy() == pytest.approx(t)
        for name, values in columns.items():
            assert stored[name].to_numpy() == pytest.approx(values, rel=1e-6, abs=1e-8)

    @pytest.mark.parametrize(
        ("old", "new", "phrase"),
        [
            ("parameters.EI", "parameters.EJ", "parameters.EJ"),
            ("high = 1.0", "high = 1e-4", "has the bounds 0.001 and 0.0001"),
            ("high = 1.0", "hihg = 1.0", "parameters[0].hihg: unknown key"),
            ('name = "damping"', 'name = "EI"', 'parameters[1].name: "EI" is the name of another one'),
            ("calibrate.csv", "calibrat.csv", "no such file"),
            ("calibrate_model.toml", "m.toml", "no such file"),
            ('title = "A', 'titel = "A', "titel: unknown key"),
        ],
    )
    def test_bad(self, here, call, old, new, phrase):
        path = here / "calibrate.toml"
        text = path.read_text(encoding="utf-8")
        assert old in text
        path.write_text(text.replace(old, new, 1), encoding="utf-8")
        ran = call("calibrate", path, "-j", "0", "--no-report")
        assert ran.code == 2
        assert phrase in ran.said

    def test_data_longer_than_the_run(self, here):
        model = here / "calibrate_model.toml"
        model.write_text(
            model.read_text(encoding="utf-8").replace("t_end = 2.0", "t_end = 1.0"), encoding="utf-8"
        )
        with pytest.raises(ancf.ModelError, match=r"go on to t = 2 s, simulation\.t_end of the model is 1 s"):
            read_calibration(here / "calibrate.toml")
