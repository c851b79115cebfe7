"""Laws of the state as formulas: what numba compiles is what the model evaluates; files and tables."""

import numpy as np
import pytest

import ancf
from ancf.loads.law_functions import python_of
from ancf.model.file import parse_study
from ancf.model.loads.state_function import NAMES, StateFunction, force_function

FORMULAS = (
    "-20*vx",
    "2*x**2 - y/3 + -z",
    "sin(x)*cos(y) + tan(z/9) + tanh(vx) - exp(-vy) + log(3 + vz**2) + sqrt(abs(x))",
    "min(x, y, z) - max(vx, 0.2)",
    "where(x > y, 1, where(z <= 0.1, 2, 3)) + step(vx) - step(-vx)",
    "ramp(t, 0, 2)*x + ramp(x, -1, 1)",
    "(x > 0 and y > 0) + 2*(x > 0 or y > 0) + 4*(not x)",
    "0 < x < 1",
    "x == x",
    "x != y",
    "2**-x + pi*t",
    "-x**2",
)


@pytest.mark.parametrize("text", FORMULAS)
def test_compiled_formula_is_the_formula(text):
    """Plain Python of the translation against the evaluation on arrays, at many states."""
    function = StateFunction([text, 1.5, "y"], "force", np.zeros(3), lambda: 1.0)
    law, rng = python_of([text, 1.5, "y"]), np.random.default_rng(len(text))
    for _ in range(40):
        t, r, v = rng.uniform(0, 3), rng.uniform(-2, 2, 3), rng.uniform(-2, 2, 3)
        data = np.concatenate([r, v, np.full(3, np.nan)])
        assert law(t, data) == 0.0
        assert data[6:] == pytest.approx(function(t, r, v), rel=1e-14, abs=1e-14)


#: Formulas at whole numbers, where two numbers are often the same, and what they are in Python.
AT_EQUALITY = {
    "x < y": lambda x, y: x < y,
    "x <= y": lambda x, y: x <= y,
    "x > y": lambda x, y: x > y,
    "x >= y": lambda x, y: x >= y,
    "x == y": lambda x, y: x == y,
    "x != y": lambda x, y: x != y,
    "0 < x <= y": lambda x, y: 0 < x <= y,
    "x >= y > -1": lambda x, y: x >= y > -1,
    "step(x)": lambda x, y: x >= 0,
    "step(x - y)": lambda x, y: x >= y,
    "not x": lambda x, y: not x,
    "x and y": lambda x, y: x != 0 and y != 0,
    "x or y": lambda x, y: x != 0 or y != 0,
    "where(x, y, 7)": lambda x, y: y if x else 7,
    "where(x >= y, x, -y)": lambda x, y: x if x >= y else -y,
    "ramp(x, 0, 2)": lambda x, y: {-1: 0.0, 0: 0.0, 1: 0.5, 2: 1.0}[x],
}


@pytest.mark.parametrize("text", AT_EQUALITY)
def test_where_numbers_are_the_same(text):
    function = StateFunction([text, "0", "y"], "force", np.zeros(3), lambda: 1.0)
    law = python_of([text, "0", "y"])
    for x in (-1, 0, 1, 2):
        for y in (-1, 0, 1, 2):
            data = np.array([x, y, 0.0, 0.0, 0.0, 0.0, np.nan, np.nan, np.nan])
            wanted = float(AT_EQUALITY[text](x, y))
            assert law(0.0, data) == 0.0
            assert data[6:].tolist() == [wanted, 0.0, y]
            assert function(0.0, data[:3], data[3:6]).tolist() == [wanted, 0.0, y]


@pytest.mark.parametrize(("low", "high"), [(1.0, 1.0), (2.0, 1.0), (-1.0, 0.0)])
def test_a_ramp_between_places_that_move_needs_a_length(low, high):
    """Without one it is no number, which ends a step: see the formula itself."""
    data = np.array([low, high, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    python_of(["ramp(t, x, y)", "0", "0"])(3.0, data)
    assert np.isnan(data[6]) == (high <= low)


@pytest.mark.parametrize("name", NAMES[1:])
def test_each_name_makes_a_law(name):
    given = ["0", f"2*{name}", "t"]
    assert isinstance(force_function(given, "force", np.zeros(3), lambda: 1.0), StateFunction)
    state = dict(zip(NAMES, (5.0, 1.0, 2.0, 3.0, 4.0, 6.0, 7.0), strict=True))
    law = force_function(given, "force", np.zeros(3), lambda: 1.0)
    value = law(5.0, np.array([1.0, 2.0, 3.0]), np.array([4.0, 6.0, 7.0]))
    assert value.tolist() == [0.0, 2 * state[name], 5.0]


@pytest.mark.parametrize(
    "given",
    [(1, 2, 3), ["sin(t)", 0, 0], lambda t: (t, 0, 0), {"t": [0, 1], "value": [[0, 0, 0], [1, 1, 1]]}],
)
def test_functions_of_time_stay_what_they_are(given):
    assert not isinstance(force_function(given, "force", np.zeros(3), lambda: 1.0), StateFunction)


def test_defaults_do_not_count():
    """A function of time may have further arguments with values of their own."""
    given = force_function(lambda t, a=1.0, b=2.0: (a * t, b, 0.0), "force", np.zeros(3), lambda: 1.0)
    assert given(3.0).tolist() == [3.0, 2.0, 0.0]


STUDY = {
    "bodies": [{"type": "point_mass", "name": "bob", "at": [1.0, 0.0, 0.0], "mass": 1.0}],
    "loads": [{"type": "force", "point": "bob", "force": ["-20*vx", "-x", 0.5]}],
}


class TestInFiles:
    def test_is_read_printed_and_described(self):
        model = parse_study(STUDY).model
        law = model.loads[0].force
        assert law(0.0, np.array([3.0, 0, 0]), np.array([0.1, 0, 0])).tolist() == [-2.0, -3.0, 0.5]
        assert "(-20*vx, -x, 0.5) [N]" in str(model)
        assert model.to_dict()["loads"][0]["force"] == ["-20*vx", "-x", 0.5]

    def test_a_python_function_is_described_by_its_name(self):
        model = ancf.Model()
        bob = model.add_point_mass("bob", at=(0, 0, 0), mass=1.0)

        def wind(t, r, v):
            return -v

        model.add_force(bob, wind)
        assert model.to_dict()["loads"][0]["force"] == "<function wind>"
        assert "<function wind> [N]" in str(model)

    @pytest.mark.parametrize(
        ("formula", "what"),
        [
            ("2*vv + x", 'unknown name "vv", known are t, x, y, z, vx, vy, vz'),
            ("x^2", "write \\*\\* for a power"),
            ("log(x - 5)", "must be finite"),
            ("2*w", 'unknown name "w", known are t, pi'),
        ],
    )
    def test_is_refused(self, formula, what):
        load = STUDY["loads"][0] | {"force": [formula, 0, 0]}
        with pytest.raises(ancf.ModelError, match=f"loads\\[0\\].force.*{what}"):
            parse_study(STUDY | {"loads": [load]})

    def test_only_forces_take_it(self):
        load = {"type": "moment", "point": "bob", "moment": ["x", 0, 0]}
        with pytest.raises(ancf.ModelError, match='unknown name "x"'):
            parse_study(STUDY | {"loads": [load]})
