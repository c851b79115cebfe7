"""Studies say the same in whatever order their rows, outputs and parts come, and whatever names they have."""

import json

import numpy as np
import pandas as pd
import pytest

import ancf
from ancf.design.file import read_study_file
from ancf.design.statistics import effects, summary
from ancf.design.study import study
from design_functions import angles, ishigami

MODEL = """
gravity = [0, 0, -9.81]
[sections.bar]
shape = "rectangle"
width = 0.02
height = 0.03
E = 1e7
nu = 0.3
rho = 500.0
[[bodies]]
name = "bar"
section = "bar"
element = "nonlocking"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 2
[[supports]]
type = "clamp"
name = "root"
point = "bar.start"
[[loads]]
type = "force"
name = "pull"
point = "bar.end"
force = [0, 1.0, "sin(90*t)"]
[simulation]
t_end = 0.02
step = 0.002
start = "equilibrium"
output_step = 0.01
"""
OUTPUTS = {
    "pull": "mean(tension(bar.start))",
    "twist": "max(abs(twist(bar.end)))",
    "both": "mean(tension(bar.start)*twist(bar.end))",
    "tip": "max(position(bar.end)[2])",
    "support": "min(reaction(root)[2])",
    "low": "frequency[0]",
    "high": "frequency[4]",
}


def close(one, two):
    """Whether two parts of study.json say the same but for round-off."""
    if isinstance(one, dict):
        return one.keys() == two.keys() and all(close(one[key], two[key]) for key in one)
    if isinstance(one, list):
        return len(one) == len(two) and all(map(close, one, two))
    return two == (pytest.approx(one, rel=1e-9, abs=1e-12) if isinstance(one, float) else one)


def of_angles(method, count, seed=3, **given):
    return ancf.study(
        ishigami, ancf.sample(angles(), method=method, count=count, seed=seed, **given), workers=0
    )


def said(table):
    return json.loads(json.dumps(summary(table, table.attrs["ancf design"])))


def without_cases(found):
    """All but the numbers of cases, which are those of the order."""
    plain = {key: value for key, value in found.items() if key not in ("extremes", "outputs")}
    outputs = found["outputs"].items()
    return plain | {
        name: {key: value for key, value in row.items() if not key.endswith("_case")} for name, row in outputs
    }


@pytest.mark.parametrize("method", ["saltelli", "morris"])
class TestRowsOfADesign:
    @pytest.mark.parametrize("arranged", ["shuffled", "sorted", "backwards"])
    def test_in_another_order(self, method, arranged):
        """Groups of cases were taken as they stood: a first index of 0.44 was 0.07 in a sorted table."""
        samples = ancf.sample(angles(), method=method, count=64, seed=3)
        name = [*angles()][1]
        order = {
            "shuffled": np.random.default_rng(1).permutation(len(samples)),
            "sorted": np.argsort(samples[name].to_numpy()),
            "backwards": np.arange(len(samples))[::-1],
        }
        other = ancf.study(ishigami, samples.iloc[order[arranged]].reset_index(drop=True), workers=0)
        assert close(without_cases(said(of_angles(method, 64))), without_cases(said(other)))

    def test_with_a_column_in_other_units(self, method):
        """Then rows are known by which of their columns change."""
        samples = ancf.sample(angles(), method=method, count=32, seed=3)
        name = next(iter(angles()))
        samples[name] *= 1e3
        table = ancf.study(lambda **x: ishigami(**(x | {name: 1e-3 * x[name]})), samples, workers=0)
        wanted = said(of_angles(method, 32))
        assert close(wanted["outputs"], said(table)["outputs"])
        assert close(wanted[method], said(table)[method])

    def test_of_which_nothing_is_known(self, method):
        samples = ancf.sample(angles(), method=method, count=16, seed=3)
        for name in samples:
            samples[name] = np.random.default_rng(2).permutation(samples[name].to_numpy()) + 0.01
        found = said(ancf.study(ishigami, samples, workers=0))
        assert found[method] == {}
        assert "no longer those of the design" in found["note"]

    def test_in_part(self, method):
        """Of a part there are no indices; "saltelli" still knows which rows are independent."""
        samples = ancf.sample(angles(), method=method, count=16, seed=3)
        kept = samples.iloc[np.random.default_rng(3).permutation(len(samples))[:40]]
        found = said(ancf.study(ishigami, kept, workers=0))
        assert found[method] == {}
        group, counted = len(samples.columns) + 2, found["outputs"]["y"]["count"]
        known = int(np.isin(kept.index % group, (0, group - 1)).sum())
        assert counted == (known if method == "saltelli" else 40)


@pytest.mark.parametrize("seed", [0, 2**32, 5])
@pytest.mark.parametrize("method", ["saltelli", "morris"])
def test_confidence_is_that_of_the_seed(method, seed):
    """SALib takes 0, the default here, for no seed."""
    table = of_angles(method, 16, seed)
    assert said(table)[method] == said(table)[method]


@pytest.mark.parametrize("values", [11, 14, 23])
@pytest.mark.parametrize("seed", range(3))
def test_effects_do_not_depend_on_the_order_of_equal_values(values, seed):
    """Bins of more than ten values were cut where rows with the same value happened to stand."""
    rng = np.random.default_rng(seed)
    x = rng.integers(0, values, 200)
    given = pd.DataFrame({"x": x, "noise": rng.random(200)})
    tables = [
        ancf.study(lambda x, noise: {"y": np.sin(x) + noise}, rows, workers=0)
        for rows in (given, given.iloc[rng.permutation(200)].reset_index(drop=True))
    ]
    assert close(*(effects(table, "y") for table in tables))


@pytest.mark.parametrize("count", [3, 12, 30])
def test_words_are_their_own_bins(count):
    """A study of more than ten words ended with an error of NumPy."""
    words = [f"word {k % count}" for k in range(60)]
    rows = pd.DataFrame({"word": words, "x": np.arange(60.0)})
    found = effects(ancf.study(lambda word, x: {"y": float(word.split()[1])}, rows, workers=0), "y")["word"]
    assert [row["at"] for row in found["bins"]] == sorted(set(words))
    assert found["explained"] == pytest.approx(1.0)


@pytest.mark.parametrize("first", [2**53, 2**63 - 2, -(2**60)])
def test_whole_numbers_are_known_to_their_last_digit(first):
    """Seeds beyond 2**53 were the same case as their neighbours."""
    found = ancf.study(lambda n: {"y": n % 2}, pd.DataFrame({"n": [first, first + 1]}), workers=0)
    assert found["y"].tolist() == [0.0, 1.0]


def written(folder, outputs, values=(1.0, 2.0), name="E", model=MODEL):
    folder.mkdir(exist_ok=True)
    (folder / "m.toml").write_text(model, encoding="utf-8")
    lines = ['model = "m.toml"', "[[parameters]]", 'path = "loads.pull.force[1]"', f'name = "{name}"']
    lines += [f"values = {[*values]}", "[sampling]", 'method = "grid"']
    for key, formula in outputs.items():
        lines += ["[[outputs]]", f'name = "{key}"', f"formula = '{formula}'"]
    (folder / "s.toml").write_text("\n".join(lines), encoding="utf-8")
    return read_study_file(folder / "s.toml")


def computed(file, folder=None):
    return study(file.case, file.samples, workers=0, folder=folder, report=False)


class TestOutputsOfFiles:
    def test_do_not_depend_on_the_others(self, tmp_path):
        """With a twist among them all were taken at stored times, no longer at every step."""
        whole = computed(written(tmp_path / "all", OUTPUTS))
        for name, formula in OUTPUTS.items():
            alone = computed(written(tmp_path / name, {name: formula}))
            assert alone[name].to_numpy() == pytest.approx(whole[name].to_numpy(), rel=1e-9)
        turned = computed(written(tmp_path / "turned", dict(reversed(OUTPUTS.items()))))
        assert turned[whole.columns].equals(whole)

    @pytest.mark.parametrize("stored", ["", "output_step = 0.002", "output_step = 0.02"])
    def test_are_those_of_every_step(self, tmp_path, stored):
        other = MODEL.replace("output_step = 0.01", stored)
        found = [
            computed(written(tmp_path / name, OUTPUTS, model=m))
            for name, m in zip("ab", (MODEL, other), strict=True)
        ]
        assert found[0].equals(found[1])

    @pytest.mark.parametrize("formula", ["frequency[-1]", "max(frequency)", "frequency[0] + mean(frequency)"])
    def test_all_frequencies_are_not_known(self, tmp_path, formula):
        """They were those that other outputs asked for."""
        with pytest.raises(ancf.ModelError, match=r"outputs\.a: .*name one from the lowest, frequency\[0\]"):
            written(tmp_path, {"a": formula, "b": "frequency[3]"})

    @pytest.mark.parametrize("values", [(1.0, 2.0, 3.0), (2.0, 1.0, 3.0), (3.0, 2.0, 1.0)])
    def test_one_that_is_not_finite_is_a_failed_case(self, tmp_path, values):
        """As the very first one it ended the study, and the same command once more went on."""
        outputs = {"x": "sqrt(max(abs(reaction(root)[1])) - 1.5)"}
        for folder in ("one", "again"):
            found = computed(written(tmp_path, outputs, values), tmp_path / folder)
            assert (found["status"] == "ok").tolist() == [value > 1.5 for value in values]
        with pytest.raises(ancf.ModelError, match="must give one number"):
            computed(written(tmp_path, {"x": "tension(bar.start)"}, values))

    @pytest.mark.parametrize("name", ["self", "values", "case_", "0"])
    def test_names_of_parameters(self, tmp_path, name):
        wanted = computed(written(tmp_path / "a", {"tip": OUTPUTS["tip"]}))
        found = computed(written(tmp_path / "b", {"tip": OUTPUTS["tip"]}, name=name))
        assert found["tip"].tolist() == wanted["tip"].tolist()
        assert found[name].tolist() == [1.0, 2.0]

    @pytest.mark.parametrize("name", ["case", "status", "message"])
    def test_names_that_are_taken(self, tmp_path, name):
        """Outputs with them were refused when all cases had been computed."""
        with pytest.raises(
            ancf.ModelError, match=rf'outputs\[0\]\.name: "{name}" is the name of another column'
        ):
            written(tmp_path, {name: OUTPUTS["tip"]})
        with pytest.raises(ancf.ModelError, match=rf'parameters\[0\]\.name: "{name}" is the name of'):
            written(tmp_path, {"tip": OUTPUTS["tip"]}, name=name)


@pytest.mark.parametrize("pair", [("a", "b"), ("b", "a")])
def test_a_correlation_is_given_once(tmp_path, pair):
    """The last one counted."""
    kinds = {"a": ancf.Normal(1.0, 0.1), "b": ancf.Normal(2.0, 0.1)}
    if pair != ("a", "b"):
        with pytest.raises(ancf.ModelError, match="the other way round too"):
            ancf.sample(kinds, method="random", count=3, correlations={("a", "b"): 0.5, pair: -0.5})
    (tmp_path / "m.toml").write_text(MODEL, encoding="utf-8")
    given = "".join(
        f'[[parameters]]\npath = "loads.pull.force[{k}]"\nname = "{name}"\n'
        'distribution = { type = "normal", mean = 1.0, deviation = 0.1 }\n'
        for k, name in enumerate("ab")
    )
    both = "".join(f"[[correlations]]\nbetween = {[*one]}\nvalue = 0.5\n" for one in (("a", "b"), pair))
    rest = '[sampling]\nmethod = "random"\ncount = 3\n[[outputs]]\nname = "x"\nformula = "frequency[0]"\n'
    (tmp_path / "s.toml").write_text(f'model = "m.toml"\n{given}{both}{rest}', encoding="utf-8")
    with pytest.raises(ancf.ModelError, match=r"correlations\[1\]\.between: .*have one already"):
        read_study_file(tmp_path / "s.toml")
