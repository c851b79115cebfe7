"""Formulas of outputs: what they compute, against NumPy, and what they refuse."""

import re

import numpy as np
import pytest

import ancf
from ancf.design.formulas import Formula, Vocabulary

WORDS = Vocabulary(("t", "uplift", "sigma"), ("tension", "position"))
ALL_WORDS = Vocabulary(
    WORDS.names, ("position", "velocity", "tension", "curvature", "reaction", "spring_force")
)
T = np.linspace(0.0, 2.0, 41)
PULL = np.sin(3.0 * T) + T
PLACE = np.stack([np.cos(T), T**2, -T], axis=1)


class Case:
    def value(self, name):
        return {"t": T, "uplift": np.array([3.0, 5.0, 4.0]), "sigma": 7.5}[name]

    def ask(self, quantity, item):
        assert item in ("cable.start", "cable.at(0.5)", "my cable.end")
        return PULL if quantity == "tension" else PLACE


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("sigma", 7.5),
        ("uplift[1]", 5.0),
        ("uplift[-1]", 4.0),
        ("max(uplift)", 5.0),
        ("max(tension(cable.start))", np.max(PULL)),
        ("min(tension(cable.at(0.5)))", np.min(PULL)),
        ('mean(tension("my cable.end"))', np.mean(PULL)),
        ("deviation(tension(cable.start))", np.std(PULL)),
        ("rms(tension(cable.start))", np.sqrt(np.mean(PULL**2))),
        ("range(position(cable.start)[1])", 4.0),
        ("first(position(cable.start)[0])", 1.0),
        ("last(position(cable.start))[2]", -2.0),
        ("percentile(tension(cable.start), 90)", np.percentile(PULL, 90)),
        ("integral(tension(cable.start))", np.trapezoid(PULL, T)),
        ("at(position(cable.start), 1.5)[1]", 2.25),
        ("max(norm(position(cable.start)))", np.max(np.linalg.norm(PLACE, axis=1))),
        ("max(tension(cable.start), 1.5) [3]", 1.5),
        ("max(abs(tension(cable.start) - 2*t))", np.max(np.abs(PULL - 2 * T))),
        ("mean(where(t > 1, tension(cable.start), 0))", np.mean(np.where(T > 1, PULL, 0))),
        ("-2*sigma**2 + pi", -2 * 7.5**2 + np.pi),
    ],
)
def test_values(text, value):
    assert Formula(text, "outputs.x", WORDS)(Case()) == pytest.approx(value, rel=1e-12)


def test_what_a_formula_asks_for():
    made = Formula("max(tension(cable.start)) + uplift[2] - uplift[0]", "outputs.x", WORDS)
    assert made.asked == [("tension", "cable.start")]
    assert made.named == {"uplift"}
    assert made.highest == 2


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        ("tensoin(cable.start)", 'unknown name "tensoin"'),
        ("sigmaa", 'did you mean "sigma"'),
        ("max(", "is no formula"),
        ("", "is no formula"),
        ("__import__('os').system('true')", "is not allowed"),
        ("sigma.real", "is not allowed"),
        ("(lambda: 1)()", "is not allowed"),
        ("[1, 2]", "is not allowed"),
        ("'text'", "is not allowed"),
        ("open('x')", 'unknown name "open"'),
        *(
            (f"{name}({k})", f"{name} is no function (write {name}[{k}], counted from 0)")
            for name in WORDS.names
            for k in (0, 3)
        ),
        ("2*uplift(t)", "uplift is no function (write uplift)"),
        ("sigma()", "sigma is no function (write sigma)"),
        ("uplift[0.5]", "is no place in a list"),
        ("uplift[sigma]", "is no place in a list"),
        ("tension()", "is asked of one item"),
        ("percentile(tension(cable.start))", "percentile() does not take 1 arguments"),
        ("sin(t, t)", "sin() does not take 2 arguments"),
        ("(" * 500 + "1" + ")" * 500, ""),
    ],
)
def test_what_is_no_formula(text, phrase):
    with pytest.raises(ancf.ModelError) as caught:
        Formula(text, "outputs.x", WORDS)
    assert phrase in str(caught.value)
    assert caught.value.where == "outputs.x"


@pytest.mark.parametrize(
    ("text", "meant"),
    [
        ("cable.start position z", "position(cable.start)[2]"),
        ("cable.at(0.5, 0, 0) velocity x", "velocity(cable.at(0.5, 0, 0))[0]"),
        ("cable.start  tension", "tension(cable.start)"),
        ("left end reaction y", 'reaction("left end")[1]'),
        ("tie force", "spring_force(tie)"),
        ("position(cable.start).y", "position(cable.start)[1]"),
        ("cable.start.z", "position(cable.start)[2]"),
        ("cable.end.tension", "tension(cable.end)"),
        ("cable.end", "position(cable.end)[0], [1] or [2]"),
    ],
)
def test_what_a_column_of_tables_is_here(text, meant):
    """What is said instead is a formula itself."""
    with pytest.raises(ancf.ModelError) as caught:
        Formula(text, "outputs.x", ALL_WORDS)
    assert caught.value.hint.startswith(f"write {meant}")
    assert Formula(meant.split(", [")[0], "outputs.x", ALL_WORDS).asked


@pytest.mark.parametrize(
    "text",
    [
        "tension(cable.start)",
        "position(cable.start)[2]",
        "position(cable.start)",
        "2*position(cable.start)",
        "tension(cable.start) - t",
        "norm(position(cable.start))",
        "last(position(cable.start))",
        "uplift",
        "2*uplift",
        "-uplift",
        "t",
    ],
)
def test_what_is_recommended_is_a_number(text):
    """Everything that the message names, and never what was written."""
    with pytest.raises(ancf.ModelError, match="must give one number") as caught:
        Formula(text, "outputs.x", WORDS)(Case())
    shown = re.split(", | or ", caught.value.hint.removeprefix("such as "))
    assert len(shown) >= 2
    assert not re.search(r"\(\([^()]*\)\)", caught.value.hint)
    for formula in shown:
        assert formula != text
        assert np.isfinite(Formula(formula, "outputs.x", WORDS)(Case()))


@pytest.mark.parametrize(
    ("text", "phrase"),
    [
        ("tension(cable.start)", "gives numbers of shape (41,), must give one number"),
        ("last(position(cable.start))", "gives numbers of shape (3,), must give one number"),
        ("uplift[3]", '"uplift" has 3 entries, [3] is none'),
        ("sigma[0]", '"sigma" is one number, it has no [0]'),
        ("max(sigma)", "max() is of a history, not of one number"),
        ("sigma/0", "is inf, must be a finite number"),
        ("log(-sigma)", "is nan, must be a finite number"),
    ],
)
def test_what_is_no_number(text, phrase):
    made = Formula(text, "outputs.x", WORDS)
    with pytest.raises(ancf.ModelError) as caught:
        made(Case())
    assert phrase in str(caught.value)


@pytest.mark.parametrize("kind", [ancf.ModelError, ancf.SolveError])
@pytest.mark.parametrize("text", ["max(tension(cable.start))", "sigma + last(position(cable.start)[2])"])
def test_errors_of_what_is_asked_name_the_output(text, kind):
    class Refusing(Case):
        def ask(self, quantity, item):
            raise kind("cable.start", "has none", "ask another one")

    with pytest.raises(kind) as caught:
        Formula(text, "outputs.pull", WORDS)(Refusing())
    assert (caught.value.where, caught.value.what) == ("outputs.pull: cable.start", "has none")


@pytest.mark.parametrize("share", [-1, 101, 300])
def test_percentiles_out_of_range(share):
    with pytest.raises(ancf.ModelError, match=r"outputs\.x: .*Percentiles must be"):
        Formula(f"percentile(tension(cable.start), {share})", "outputs.x", WORDS)(Case())
