"""Gradients of numbers of runs along a line by lengths of droppers: backwards what slopes are forwards."""

import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.catenary import Butterworth
from ancf.catenary.answers.weights import NUMBERS, of_filtered
from ancf.catenary.forms.mesh import Mesh
from ancf.catenary.lines.file import parse_line
from ancf.sensitivity import blocks
from ancf.sensitivity.adjoint import UnsolvedError
from slopes import counted_corrections

EXAMPLE = Path(__file__).parents[2] / "examples" / "droppers_line.toml"
MESH = Mesh(contact=3.0, messenger=4.0)
RUN = {"speed": 65.0, "step": 2e-3, "pantograph": "en50318-2002", "start": 10.0}
RUN |= {"window": (61.0, 101.0), "until": 110.0, "mesh": MESH}
SOME = {"one": ["2-2"], "two alike": ["1-5", "2-1"], "far": ["2-5"]}
JOINT = ancf.GeneralizedAlpha(0.5, formulation="index2")
pytestmark = pytest.mark.filterwarnings("ignore::UserWarning")


def line(**changes):
    tables = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    tables["spans"][0]["repeat"] = 2
    tables["spans"][0]["length"] = 61.0
    tables["spans"][0]["droppers"] = [6.0, 18.0, 30.5, 43.0, 55.0]
    return replace(parse_line(tables, "line"), **changes)


def agree(line, numbers, droppers=SOME, evaluated=0, filter=None, off=1e-8, **given):
    done = catenary.run(line, sensitivities=droppers, **RUN | given)
    wanted, statistics = (
        catenary.slopes(done, evaluated, filter),
        catenary.statistics(done, evaluated, filter),
    )
    for number in numbers:
        own = {"evaluated": evaluated, "filter": filter}
        value, slope = catenary.gradient(line, number, droppers, **own, **RUN | given)
        if number != "uplift":
            assert value == pytest.approx(statistics[number].value, rel=1e-12), number
        expected = np.array([wanted[name][number] for name in droppers])
        assert list(slope) == list(droppers)
        assert np.max(np.abs(expected)) > 0.0
        assert np.max(np.abs(np.array([*slope.values()]) - expected)) < off * np.max(np.abs(expected)), number


def test_all_numbers():
    agree(line(), NUMBERS)


@pytest.mark.parametrize("filter", [Butterworth(4), Butterworth(3, zero_phase=False)])
def test_other_filters(filter):
    agree(line(), ("deviation", "maximum", "deviation_5_20"), filter=filter)


@pytest.mark.parametrize("evaluated", [0, 1])
def test_of_two_pantographs(evaluated):
    agree(line(), ("deviation", "uplift"), evaluated=evaluated, spacing=14.0, start=8.0, until=105.0)


@pytest.mark.parametrize("broken", [["1-9", "2-1"], ["1-10", "2-2"]], ids=["left", "right"])
def test_twin_wires(broken):
    """The uplift is that of the wire that is higher, where its droppers broke, and both press."""
    given = {"contact_damping": 20.0, "broken_droppers": broken}
    droppers = {"one": ["2-3"], "other": ["2-4"]}
    agree(line(contact_spacing=0.08), ("mean_force", "uplift"), droppers, **given)


def test_a_wire_that_is_not_even(tmp_path):
    rows = np.array([[0.0, 0.0], [70.0, 0.0], [71.0, 0.5e-3], [72.0, 0.0], [122.0, 0.0]])
    agree(line(), ("deviation",), underside=rows, broken_droppers=["2-3"])


def test_each_dropper_by_default():
    """Broken ones have none; a sum of droppers has the sum of their derivatives."""
    value, each = catenary.gradient(line(), broken_droppers=["1-3"], **RUN)
    assert list(each) == [f"{span}-{k}" for span in (1, 2) for k in range(1, 6) if (span, k) != (1, 3)]
    same, alike = catenary.gradient(line(), "deviation", {"all": list(each)}, broken_droppers=["1-3"], **RUN)
    assert same == value
    assert alike["all"] == pytest.approx(sum(each.values()), rel=1e-9)


@pytest.mark.parametrize(
    "more", [{}, {"contact_stiffness": 2e5}, {"spacing": 14.0, "start": 8.0, "until": 105.0}]
)
def test_few_corrections(more, monkeypatch):
    """The stiffness of contacts is in the solutions of a step: what is left ends after two corrections."""
    counts = counted_corrections(monkeypatch)
    catenary.gradient(line(), "deviation", SOME, **RUN | more)
    assert counts[-1][0] <= 2.1 * sum(steps for _, steps in counts)


@pytest.mark.parametrize("number", ["deviation", "uplift"])
@pytest.mark.parametrize("share", [0.0, 0.5])
def test_however_states_are_kept(share, number, monkeypatch):
    """All of them, velocities alone, or none, whose steps are taken again."""
    first = catenary.gradient(line(), number, SOME, **RUN)
    made, kept = [], blocks.Keeping.__init__

    def less(self, system, steps, remembers):
        monkeypatch.setattr(blocks, "KEPT", share * 24.0 * system.size * steps)
        kept(self, system, steps, remembers)
        made.append((self.all, self.some))

    monkeypatch.setattr(blocks.Keeping, "__init__", less)
    again = catenary.gradient(line(), number, SOME, **RUN)
    assert made == [(False, share > 0.0)]
    assert again[0] == first[0]
    assert again[1] == pytest.approx(first[1], rel=1e-8)


def test_with_a_sliding_joint():
    agree(
        line(), ("deviation", "uplift"), contact="joint", contact_stiffness=5e4, integrator=JOINT, off=1e-12
    )


def test_forwards_where_the_adjoint_cannot(monkeypatch):
    def unsolved(*_):
        raise UnsolvedError

    monkeypatch.setattr("ancf.sensitivity.adjoint_sloped.SlopedAdjoint.backwards", unsolved)
    agree(line(), ("deviation",), off=1e-14)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_derivatives_of_numbers(seed):
    """Against differences of numpy's mean and deviation, sample by sample."""
    x = np.random.default_rng(seed).uniform(80.0, 150.0, 40)
    of = {
        "mean_force": np.mean,
        "deviation": np.std,
        "mean_plus_3_sigma": lambda y: np.mean(y) + 3.0 * np.std(y),
        "mean_minus_3_sigma": lambda y: np.mean(y) - 3.0 * np.std(y),
        "maximum": np.max,
        "minimum": np.min,
        "relative_deviation": lambda y: np.std(y) / np.mean(y),
    }
    found = of_filtered(x)
    assert found.keys() == of.keys()
    for key, number in of.items():
        value, by = found[key]
        assert value == pytest.approx(number(x), rel=1e-14), key
        wanted = [(number(x + 1e-3 * e) - number(x - 1e-3 * e)) / 2e-3 for e in np.eye(len(x))]
        assert by == pytest.approx(np.array(wanted), abs=1e-8), key


@pytest.mark.parametrize("order", [1, 4, 6])
@pytest.mark.parametrize("zero_phase", [True, False])
@pytest.mark.parametrize(("n", "low", "high"), [(60, 0.0, 20.0), (300, 5.0, 20.0), (150, 2.0, 50.0)])
def test_filters_transposed(n, low, high, zero_phase, order):
    """Against the matrix of the filter, column by column; the first is shorter than its margin."""
    chosen, rng = Butterworth(order, zero_phase), np.random.default_rng(n)
    matrix, w = np.stack([chosen.band(e, 1000.0, low, high) for e in np.eye(n)], axis=1), rng.normal(size=n)
    wanted = matrix.T @ w
    assert np.max(np.abs(chosen.band_back(w, 1000.0, low, high) - wanted)) < 1e-10 * np.max(np.abs(wanted))


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ({"objective": "loss"}, "gradient.objective"),
        ({"droppers": {}}, "must name a dropper"),
        ({"droppers": {"a": ["9-9"]}}, "there is no dropper"),
        ({"droppers": ["2-2"]}, "must be a mapping"),
        ({"evaluated": 1}, "pantograph"),
        ({"filter": 4}, "gradient.filter"),
        ({"pantograph": "benchmark-2015"}, 'relaxed at "mean"'),
        ({"contact": "joint"}, "up to 10 % off"),
        ({"objective": "uplift", "window": (70.0, 100.0)}, "no support in the window"),
    ],
)
def test_bad_input(given, told):
    with pytest.raises(ancf.ModelError, match=told):
        catenary.gradient(line(), **RUN | given)


@pytest.mark.parametrize("droppers", [None, {"a": ["1-1"]}])
def test_no_route(droppers):
    one = replace(line(), title="one")
    route = catenary.Route(title="two", lines=(one, one), starts=(0.0, 100.0))
    with pytest.raises(ancf.ModelError, match="a route has none"):
        catenary.gradient(route, "deviation", droppers, **RUN)
    if droppers:
        with pytest.raises(ancf.ModelError, match="a route has none"):
            catenary.run(route, sensitivities=droppers, **RUN)
