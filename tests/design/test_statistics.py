"""What a table says: indices against closed forms, intervals against how often they hold the truth."""

import math

import numpy as np
import pandas as pd
import pytest

import ancf
from ancf.design import statistics
from ancf.design.report.figures import _explains
from ancf.design.statistics import effects, exceedance, percentile, summary
from design_functions import ISHIGAMI, angles, ishigami


def table_of(rows, function):
    return ancf.study(function, rows, workers=0)


def said(table):
    return summary(table, table.attrs["ancf design"])


@pytest.fixture(scope="module")
def waves():
    return table_of(ancf.sample(angles(), method="saltelli", count=1024, seed=3), ishigami)


class TestSobol:
    @pytest.mark.parametrize("name", ISHIGAMI)
    @pytest.mark.parametrize(("key", "place"), [("S1", 0), ("ST", 1)])
    def test_ishigami(self, waves, name, key, place):
        row = said(waves)["saltelli"]["y"]["indices"][name]
        assert abs(row[key] - ISHIGAMI[name][place]) < row[f"{key}_conf"]
        assert row[f"{key}_conf"] < 0.1

    @pytest.mark.parametrize("seed", range(5))
    def test_confidence_is_neither_wide_nor_narrow(self, seed):
        """Errors of six indices are within the half widths as a rule, and not far below them."""
        table = table_of(ancf.sample(angles(), method="saltelli", count=256, seed=seed), ishigami)
        ratios = []
        for name, exact in ISHIGAMI.items():
            row = said(table)["saltelli"]["y"]["indices"][name]
            ratios += [
                abs(row[key] - value) / row[f"{key}_conf"]
                for key, value in zip(("S1", "ST"), exact, strict=True)
            ]
        assert np.median(ratios) < 1.0
        assert max(ratios) < 2.0

    def test_groups_with_a_failed_case_are_left_out(self, waves):
        """The indices of the others are what they would have been alone."""
        broken = waves.copy()
        broken.attrs = waves.attrs
        lost = np.zeros(len(waves), dtype=bool)
        lost[np.arange(0, 40) * 7] = True
        broken.loc[lost, "y"] = np.nan
        broken.loc[lost, "status"] = "failed"
        found = said(broken)
        groups = len(set((np.arange(0, 40) * 7 // 5).tolist()))
        assert found["saltelli"]["y"]["dropped"] == groups
        assert found["saltelli"]["y"]["groups"] == 1024 - groups
        assert found["note"].startswith("40 of 5120 cases failed")
        for name, exact in ISHIGAMI.items():
            assert abs(found["saltelli"]["y"]["indices"][name]["S1"] - exact[0]) < 0.1

    def test_constant_output(self):
        table = table_of(ancf.sample(angles(), method="saltelli", count=8), lambda x1, x2, x3: {"y": 2.0})
        found = said(table)
        assert found["saltelli"]["y"]["indices"] == {}
        assert found["effects"]["y"]["x1"] == {
            "bins": [],
            "share": 0.0,
            "explained": 0.0,
            "chance": 0.0,
            "exact": False,
        }


class TestMorris:
    @pytest.mark.parametrize("seed", [0, 4])
    @pytest.mark.parametrize("c", [[3.0, -2.0], [0.0, 1.0, 10.0]])
    def test_linear_functions_have_their_slopes(self, c, seed):
        """Effects over the whole range of a parameter, without deviation."""
        kinds = {f"x{k}": ancf.Uniform(-1.0, 3.0) for k in range(len(c))}
        rows = ancf.sample(kinds, method="morris", count=10, seed=seed)
        table = table_of(
            rows, lambda **x: {"y": 1.0 + sum(a * v for a, v in zip(c, x.values(), strict=True))}
        )
        for k, slope in enumerate(c):
            row = said(table)["morris"]["y"]["indices"][f"x{k}"]
            assert row["mu"] == pytest.approx(4.0 * slope, abs=1e-12)
            assert row["mu_star"] == pytest.approx(4.0 * abs(slope), abs=1e-12)
            assert row["sigma"] == pytest.approx(0.0, abs=1e-12)

    @pytest.mark.parametrize("kind", [ancf.Uniform(-1.1, 3.7), ancf.Triangular(0.1, 0.3, 0.7)])
    @pytest.mark.parametrize("seed", [0, 4])
    def test_each_level_has_one_mean(self, kind, seed):
        kinds = {"a": kind, "b": ancf.Uniform(0.0, 0.1)}
        table = table_of(ancf.sample(kinds, method="morris", count=30, seed=seed), lambda a, b: {"y": a + b})
        for row in said(table)["effects"]["y"].values():
            assert len(row["bins"]) == 4
            assert sum(one["count"] for one in row["bins"]) == 90

    def test_products_deviate(self):
        kinds = {"a": ancf.Uniform(0.0, 1.0), "b": ancf.Uniform(0.0, 1.0)}
        table = table_of(ancf.sample(kinds, method="morris", count=200, seed=1), lambda a, b: {"y": a * b})
        row = said(table)["morris"]["y"]["indices"]["a"]
        levels = np.arange(4) / 3.0  # the other parameter, at any of them alike
        assert row["mu"] == pytest.approx(np.mean(levels), abs=0.05)
        assert row["sigma"] == pytest.approx(np.std(levels), abs=0.05)


class TestIntervals:
    @pytest.mark.parametrize("p", [5.0, 50.0, 95.0])
    @pytest.mark.parametrize("count", [60, 200])
    def test_of_percentiles_hold_the_truth(self, p, count):
        draw, inside = np.random.default_rng(1), []
        for _ in range(600):
            row = percentile(np.sort(draw.random(count)), p)
            low, high = row["low"], row["high"]
            inside.append((low is None or low <= p / 100) and (high is None or p / 100 <= high))
        assert 0.93 <= np.mean(inside) <= 0.999

    def test_of_few_cases_are_open(self):
        row = percentile(np.arange(10.0), 99.0)
        assert row["high"] is None
        assert row["low"] is not None

    @pytest.mark.parametrize("count", [1, 2, 50])
    def test_of_exceedance(self, count):
        values = np.random.default_rng(2).permutation(np.arange(float(count)))
        ordered, above, low, high = exceedance(np.append(values, np.nan))
        assert np.array_equal(ordered, np.arange(count))
        assert above == pytest.approx((count - 1.0 - np.arange(count)) / count)
        assert np.all((low <= above) & (above <= high))
        # of none out of n: 1 - (0.025)^(1/n)
        assert high[-1] == pytest.approx(1.0 - 0.025 ** (1.0 / count))

    def test_of_the_mean(self):
        rows = ancf.sample({"a": ancf.Normal(3.0, 2.0)}, method="random", count=400, seed=1)
        row = said(table_of(rows, lambda a: {"y": a}))["outputs"]["y"]
        low, high = row["mean_confidence"]
        assert high - low == pytest.approx(2 * 1.966 * 2.0 / math.sqrt(400), rel=0.1)
        assert low < 3.0 < high

    def test_a_grid_has_none(self):
        rows = ancf.sample({"a": [1.0, 2.0, 3.0]}, method="grid")
        row = said(table_of(rows, lambda a: {"y": a}))["outputs"]["y"]
        assert "percentiles" not in row
        assert (row["mean"], row["minimum"], row["maximum"]) == (2.0, 1.0, 3.0)


class TestEffects:
    def test_share_of_the_variance(self):
        """Of a x + b z with independent parts."""
        rows = ancf.sample(dict.fromkeys("xz", ancf.Uniform(0.0, 1.0)), method="sobol", count=2048)
        table = table_of(rows, lambda x, z: {"y": 3.0 * x - z})
        shares = [effects(table, "y")[name]["share"] for name in "xz"]
        assert shares == pytest.approx([0.9, 0.1], abs=0.015)  # bins of a tenth lose a hundredth
        bins = effects(table, "y")["x"]["bins"]
        assert [row["mean"] for row in bins] == pytest.approx(
            [3.0 * row["at"] - 0.5 for row in bins], abs=0.06
        )

    @pytest.mark.parametrize("interaction", [0.0, 0.7, -3.0])
    @pytest.mark.parametrize("levels", [(3, 2), (2, 2), (4, 3), (12, 5)])
    def test_shares_of_a_grid_are_exact(self, levels, interaction):
        """y = a + b/2 + c (a - mean)(b - mean): variances add, of n even steps (n^2 - 1)/12."""
        values = {name: [float(k) for k in range(n)] for name, n in zip("ab", levels, strict=True)}
        middle = [(n - 1) / 2 for n in levels]
        table = table_of(
            ancf.sample(values, method="grid"),
            lambda a, b: {"y": a + 0.5 * b + interaction * (a - middle[0]) * (b - middle[1])},
        )
        steps = [(n * n - 1) / 12 for n in levels]
        parts = np.array([steps[0], 0.25 * steps[1], interaction**2 * steps[0] * steps[1]])
        found = [effects(table, "y")[name] for name in "ab"]
        assert [one["share"] for one in found] == pytest.approx(parts[:2] / parts.sum(), rel=1e-12)
        assert all(one["exact"] and one["share"] == one["explained"] for one in found)

    def test_shares_of_the_two_effects_of_six_cases(self):
        """Of a in 0, 1, 2 and b in 0, 1: 2/3 and 1/16 of 35/48."""
        rows = ancf.sample({"a": [0, 1, 2], "b": [0, 1]}, method="grid")
        table = table_of(rows, lambda a, b: {"y": a + 0.5 * b})
        assert [effects(table, "y")[name]["share"] for name in "ab"] == pytest.approx([32 / 35, 3 / 35])

    @pytest.mark.parametrize("count", [2, 3, 4])
    def test_three_parameters_and_words(self, count):
        """A product is all interaction but for what the means give: of words as of numbers."""
        rows = ancf.sample({"a": [-1.0, 1.0], "b": [-1.0, 1.0], "word": list("wxyz"[:count])}, method="grid")
        table = table_of(rows, lambda a, b, word: {"y": a * b + 2.0 * "wxyz".index(word)})
        own = 4.0 * (count * count - 1) / 12
        shares = [effects(table, "y")[name]["share"] for name in ("a", "b", "word")]
        assert shares == pytest.approx([0.0, 0.0, own / (own + 1.0)], abs=1e-15)

    @pytest.mark.parametrize("lost", range(6))
    def test_a_grid_with_a_failed_case_is_an_estimate(self, lost):
        """Then the report tells what the means explain where chance would explain as much."""
        rows = ancf.sample({"a": [0, 1, 2], "b": [0, 1]}, method="grid")
        table = table_of(rows, lambda a, b: {"y": a + 0.5 * b})
        table.loc[lost, "y"] = np.nan
        found = [effects(table, "y")[name] for name in "ab"]
        assert not any(one["exact"] for one in found)
        k, n = np.array([3, 2]), 5
        eta = np.array([one["explained"] for one in found])
        wanted = np.maximum(eta - (1.0 - eta) * (k - 1) / (n - k), 0.0)
        assert [one["share"] for one in found] == pytest.approx(wanted)
        assert [one["chance"] for one in found] == pytest.approx((k - 1) / (n - 1))
        for one in found:
            assert ("not told from chance" in _explains(one)) == (one["share"] == 0.0)

    def test_a_grid_is_looked_at_once_for_all_parameters(self, monkeypatch):
        """It takes as long as all else."""
        looked, is_full = [], statistics.is_full
        monkeypatch.setattr(statistics, "is_full", lambda table: looked.append(len(table)) or is_full(table))
        table = table_of(ancf.sample({key: [0, 1] for key in "abc"}, method="grid"), lambda a, b, c: {"y": a})
        assert [*effects(table, "y")] == ["a", "b", "c"]
        assert looked == [8]

    @pytest.mark.parametrize("groups", [2, 4, 10])
    def test_chance_is_what_random_groups_explain(self, groups):
        """On the average over many draws of numbers that know nothing of the parameter."""
        draw, explained = np.random.default_rng(groups), []
        for _ in range(400):
            x = np.arange(40) % groups
            table = pd.DataFrame({"x": x, "z": draw.random(40), "y": draw.random(40)})
            table.attrs = {"parameters": ["x", "z"], "outputs": ["y"]}
            found = effects(table, "y")["x"]
            explained.append(found["explained"])
        assert found["chance"] == pytest.approx((groups - 1) / 39)
        assert np.mean(explained) == pytest.approx(found["chance"], rel=0.15)

    @pytest.mark.parametrize(
        ("share", "said"),
        [
            (1.0, "100 %"),
            (32 / 35, "91 %"),
            (3 / 35, "8.6 %"),
            (2e-3, "0.2 %"),
            (1e-6, "< 0.1 %"),
            (1e-17, "0 %"),
        ],
    )
    def test_what_matters_is_not_shown_as_0(self, share, said):
        assert _explains({"share": share, "chance": 0.0}) == f"{said} of the variance"

    def test_no_effect_has_no_share(self):
        rows = ancf.sample(dict.fromkeys("xz", ancf.Uniform(0.0, 1.0)), method="random", count=500)
        assert effects(table_of(rows, lambda x, z: {"y": z}), "y")["x"]["share"] < 0.03

    def test_words_and_levels_are_their_own_bins(self):
        rows = ancf.sample({"word": ["x", "y"], "n": [1, 2, 3]}, method="grid")
        table = table_of(rows, lambda word, n: {"y": n + 10.0 * (word == "y")})
        assert [(r["at"], r["mean"]) for r in effects(table, "y")["word"]["bins"]] == [
            ("x", 2.0),
            ("y", 12.0),
        ]
        assert [(r["at"], r["mean"]) for r in effects(table, "y")["n"]["bins"]] == [
            (1, 6.0),
            (2, 7.0),
            (3, 8.0),
        ]

    def test_tables_of_ones_own(self):
        rows = pd.DataFrame({"a": [1.0, 5.0, 2.0]})
        found = summary(table_of(rows, lambda a: {"y": a}), None)
        assert found["outputs"]["y"]["count"] == 3
