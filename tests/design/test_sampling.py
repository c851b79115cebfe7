"""Samples of parameters: against quantiles of SciPy, the properties of their designs, and fewer of them."""

import itertools

import numpy as np
import pytest
from scipy import stats

import ancf
from ancf.design.distributions import KINDS, distribution_of
from ancf.design.sampling import GROWING, METHODS, sample, unit_samples

U = np.linspace(0.001, 0.999, 57)
TWO = {"a": ancf.Uniform(1.0, 3.0), "b": ancf.Normal(-2.0, 0.5)}


class TestDistributions:
    @pytest.mark.parametrize(
        ("ours", "theirs"),
        [
            (ancf.Uniform(-2.0, 5.0), stats.uniform(-2.0, 7.0)),
            (ancf.Normal(3.0, 0.2), stats.norm(3.0, 0.2)),
            (ancf.Triangular(1.0, 1.5, 4.0), stats.triang(0.5 / 3.0, 1.0, 3.0)),
            (ancf.Triangular(1.0, 1.0, 4.0), stats.triang(0.0, 1.0, 3.0)),
            (ancf.Triangular(1.0, 4.0, 4.0), stats.triang(1.0, 1.0, 3.0)),
        ],
        ids=["uniform", "normal", "triangular", "falling", "rising"],
    )
    def test_quantiles(self, ours, theirs):
        assert ours.quantile(U) == pytest.approx(theirs.ppf(U), rel=1e-12)

    @pytest.mark.parametrize(("mean", "deviation"), [(1.0, 0.1), (300.0, 250.0), (1e-3, 1e-5)])
    def test_mean_and_deviation_of_a_lognormal_are_its_own(self, mean, deviation):
        square = np.log(1.0 + (deviation / mean) ** 2)
        theirs = stats.lognorm(np.sqrt(square), scale=mean * np.exp(-square / 2))
        assert theirs.mean() == pytest.approx(mean)
        assert theirs.std() == pytest.approx(deviation)
        assert ancf.LogNormal(mean, deviation).quantile(U) == pytest.approx(theirs.ppf(U), rel=1e-10)

    @pytest.mark.parametrize("weights", [None, [1, 2, 5], [0, 1, 0]])
    def test_discrete_values_come_as_often_as_they_should(self, weights):
        values = [2, 3, 7]
        found = ancf.Discrete(values, weights).quantile((np.arange(8000) + 0.5) / 8000)
        wanted = np.ones(3) / 3 if weights is None else np.array(weights) / np.sum(weights)
        assert [np.mean(found == v) for v in values] == pytest.approx(wanted, abs=1e-3)
        assert all(isinstance(v, int) for v in found.tolist())

    @pytest.mark.parametrize("kind", KINDS.values(), ids=KINDS)
    def test_tables_of_files(self, kind):
        given = {"uniform": (1, 2), "normal": (1, 2), "lognormal": (1, 2), "triangular": (1, 2, 3)}
        made = kind(*given.get(kind.word(), ([1, 2, "x"],)))
        assert distribution_of(made.describe()) == made

    @pytest.mark.parametrize(
        ("given", "phrase"),
        [
            ({"type": "uniform"}, "uniform needs low and high: low and high missing"),
            ({"type": "normal", "mean": 1.0}, "normal needs mean and deviation: deviation missing"),
            ({"type": "unifrom", "low": 1, "high": 2}, 'did you mean "uniform"'),
            ({"low": 1, "high": 2}, "x.type: is missing, must be one of"),
            ({"type": "uniform", "low": 1, "hi": 2}, 'x.hi: unknown key, allowed: "type", "low", "high"'),
            ({"type": "uniform", "low": 2, "high": 1}, "x.high: is 1, must not be below low, 2"),
            ({"type": "uniform", "low": 2, "high": 2}, "nothing would vary"),
            ({"type": "uniform", "low": 2, "high": "3"}, "x.high: must be a number"),
            ({"type": "normal", "mean": 1, "deviation": 0}, "x.deviation: must be > 0"),
            ({"type": "lognormal", "mean": -1, "deviation": 1}, "x.mean: must be > 0"),
            (
                {"type": "triangular", "low": 1, "mode": 5, "high": 3},
                "x.high: is 3, must not be below mode, 5",
            ),
            ({"type": "discrete", "values": []}, "x.values: must hold a value"),
            ({"type": "discrete", "values": [1, 2], "weights": [1]}, "x.weights: must be 2 numbers >= 0"),
            ({"type": "discrete", "values": [1, None]}, "x.values[1]: must be a number"),
            (3.0, "x: must be a distribution or a list of values"),
        ],
    )
    def test_bad(self, given, phrase):
        with pytest.raises(ancf.ModelError) as caught:
            distribution_of(given, "x")
        assert phrase in str(caught.value)


class TestDesigns:
    @pytest.mark.parametrize("method", [m for m in METHODS if m not in ("grid", "list")])
    @pytest.mark.parametrize("seed", [0, 7])
    def test_same_seed_same_samples(self, method, seed):
        one, other, third = (sample(TWO, method=method, count=8, seed=s) for s in (seed, seed, seed + 1))
        assert one.equals(other)
        assert not one.equals(third)
        assert one.attrs["ancf design"]["seed"] == seed

    @pytest.mark.parametrize("method", GROWING)
    @pytest.mark.parametrize("count", [3, 8])
    def test_more_begin_with_the_same(self, method, count):
        few, many = (sample(TWO, method=method, count=n, seed=5) for n in (count, 3 * count))
        assert few.equals(many.head(len(few)))

    @pytest.mark.parametrize("dimension", [1, 2, 5])
    def test_latin_hypercube_has_each_stratum_once(self, dimension):
        u = unit_samples("latin-hypercube", 20, dimension, 3)
        assert np.array_equal(np.sort(np.floor(20 * u), axis=0), np.tile(np.arange(20.0)[:, None], dimension))

    @pytest.mark.parametrize("dimension", [1, 3, 4])
    def test_saltelli_changes_one_column_at_a_time(self, dimension):
        rows = unit_samples("saltelli", 16, dimension, 3).reshape(16, dimension + 2, dimension)
        for k in range(dimension):
            changed = rows[:, 1 + k] != rows[:, 0]
            assert np.array_equal(changed, np.tile(np.arange(dimension) == k, (16, 1)))
            assert np.array_equal(rows[:, 1 + k, k], rows[:, -1, k])

    @pytest.mark.parametrize("dimension", [1, 3, 6])
    def test_morris_walks_one_step_of_each_parameter(self, dimension):
        rows = unit_samples("morris", 30, dimension, 3).reshape(30, dimension + 1, dimension)
        steps = np.diff(rows, axis=1)
        assert np.array_equal(np.sort(np.abs(steps) > 0.1, axis=1).sum(axis=1), np.ones((30, dimension)))
        assert np.abs(steps)[np.abs(steps) > 0.1] == pytest.approx(2.0 / 3.0)
        assert np.min(rows) >= 0.0
        assert np.max(rows) <= 1.0
        for k in range(dimension):  # all levels and both directions are walked
            assert np.array_equal(np.unique(rows[..., k]), np.arange(4) / 3)  # no two alike
            assert 0 < np.mean(steps[..., k][np.abs(steps[..., k]) > 0.1] > 0) < 1

    def test_grid_has_all_combinations(self):
        lists = {"a": [1, 2, 3], "b": [0.5, 1.5], "c": ["x", "y"]}
        made = sample(lists, method="grid")
        assert [tuple(row) for row in made.itertuples(index=False)] == [*itertools.product(*lists.values())]
        assert [made[name].dtype.kind for name in "ab"] == ["i", "f"]

    @pytest.mark.parametrize("value", [-0.9, -0.3, 0.6])
    @pytest.mark.parametrize("method", ["random", "latin-hypercube", "sobol"])
    def test_correlations(self, value, method):
        kinds = {"a": ancf.Normal(5.0, 2.0), "b": ancf.Normal(-1.0, 0.1), "c": ancf.Uniform(0.0, 1.0)}
        made = sample(kinds, method=method, count=4096, seed=1, correlations={("a", "b"): value})
        assert np.corrcoef(made["a"], made["b"])[0, 1] == pytest.approx(value, abs=0.03)
        assert np.corrcoef(made["a"], made["c"])[0, 1] == pytest.approx(0.0, abs=0.04)
        assert made["b"].mean() == pytest.approx(-1.0, abs=0.005)
        assert made["b"].std() == pytest.approx(0.1, rel=0.04)

    @pytest.mark.parametrize(
        ("given", "phrase"),
        [
            ({"parameters": {}}, "must be a distribution or a list of values by name"),
            ({"method": "sobel"}, 'did you mean "sobol"'),
            ({"count": None}, "sample.count: is missing: sobol needs how many"),
            ({"count": 0}, "sample.count: must be between 1"),
            ({"seed": -1}, "sample.seed"),
            ({"method": "grid", "count": None}, "sample.a: must be a list of values"),
            ({"method": "grid", "parameters": {"a": [1, 2]}}, "sample.count: has no effect on a grid"),
            ({"correlations": {("a", "c"): 0.5}}, 'there is no parameter "c"'),
            ({"correlations": {("a", "a"): 0.5}}, "must be between two parameters"),
            ({"correlations": {("a", "b"): 1.5}}, "must be between -1 and 1"),
            ({"correlations": {("a", "b"): 1.0}}, "not positive definite"),
            ({"correlations": {("a", "b"): 0.5}, "method": "saltelli"}, "vary independently"),
        ],
    )
    def test_bad(self, given, phrase):
        arguments = {"parameters": TWO, "method": "sobol", "count": 4} | given
        with pytest.raises(ancf.ModelError) as caught:
            sample(arguments.pop("parameters"), **arguments)
        assert phrase in str(caught.value)
