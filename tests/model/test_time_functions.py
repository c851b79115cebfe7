"""TimeFunction: constants, Python functions, formulas and tables; wrong ones are refused with their place."""

import math

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError
from ancf.model import TimeFunction

TIMES = np.linspace(0.0, 3.0, 31)


def scalar(given):
    return TimeFunction(given, 1, "load")


def vector(given):
    return TimeFunction(given, 3, "load")


@pytest.mark.parametrize("given", [2, 2.0, np.float64(2.0), np.int64(2), "2", "4/2"])
def test_constant(given):
    f = scalar(given)
    assert f.constant
    assert f.size == 1
    np.testing.assert_array_equal(f.table(TIMES), np.full((31, 1), 2.0))


@pytest.mark.parametrize("given", [(1, 2, 3), [1.0, "2", 3], np.array([1, 2, 3]), ("1", "1 + 1", "9**0.5")])
def test_constant_vector(given):
    f = vector(given)
    assert f.constant
    np.testing.assert_allclose(f.table(TIMES), np.tile([1.0, 2.0, 3.0], (31, 1)), rtol=1e-15)


def ramp(t, t0, t1):
    s = min(max((t - t0) / (t1 - t0), 0.0), 1.0)
    return s**3 * (10 - 15 * s + 6 * s**2)


FORMULAS = {
    "t": lambda t: t,
    "-t + 2": lambda t: 2 - t,
    "+t": lambda t: t,
    "2*t**3 - t/4": lambda t: 2 * t**3 - t / 4,
    "-t**2": lambda t: -(t**2),
    "10*sin(2*pi*t)": lambda t: 10 * math.sin(2 * math.pi * t),
    "cos(t) + tan(t/4) + tanh(t)": lambda t: math.cos(t) + math.tan(t / 4) + math.tanh(t),
    "exp(-t)*log(1 + t)*sqrt(t)": lambda t: math.exp(-t) * math.log(1 + t) * math.sqrt(t),
    "abs(t - 1)": lambda t: abs(t - 1),
    "min(t, 2, 1) + max(t, 0.5)": lambda t: min(t, 2, 1) + max(t, 0.5),
    "where(t < 1.55, t, 1/(t - 1.55))": lambda t: t if t < 1.55 else 1 / (t - 1.55),
    "1.05 < t <= 2": lambda t: float(1.05 < t <= 2),
    "(t >= 2.05) + (t == 0) - (t != 0)": lambda t: float(t >= 2.05) + float(t == 0) - float(t != 0),
    "where(t > 1.05 and t < 2.05, 3, 4)": lambda t: 3 if 1.05 < t < 2.05 else 4,
    "where(t < 1.05 or not t < 2.05, 3, 4)": lambda t: 3 if t < 1.05 or not t < 2.05 else 4,
    "step(t - 1.05)": lambda t: float(t >= 1.05),
    "ramp(t, 0.5, 2.5)": lambda t: ramp(t, 0.5, 2.5),
    " 1e-3 *\n t ": lambda t: 1e-3 * t,
}


@pytest.mark.parametrize("text", FORMULAS)
def test_formula(text):
    f = scalar(text)
    assert not f.constant
    wanted = np.array([[FORMULAS[text](t)] for t in TIMES])
    np.testing.assert_allclose(f.table(TIMES), wanted, rtol=1e-13, atol=1e-15)


def test_ramp_is_smooth():
    h = 1e-4
    f = scalar("ramp(t, 1, 2)")
    for t in (1.0, 2.0):
        first = (f(t + h) - f(t - h)) / (2 * h)
        second = (f(t + h) - 2 * f(t) + f(t - h)) / h**2
        assert abs(first[0]) < 1e-6
        assert abs(second[0]) < 1e-2
    assert f(1.5)[0] == pytest.approx(0.5)


def test_python_function():
    f = vector(lambda t: (0.0, t, -(t**2)))
    assert not f.constant
    np.testing.assert_allclose(f.table(TIMES), np.column_stack([0 * TIMES, TIMES, -(TIMES**2)]))
    assert scalar(math.sin).table(TIMES).shape == (31, 1)
    assert scalar(lambda t: np.array([t]))(2.0)[0] == 2.0


def test_table_interpolates_and_is_constant_outside():
    f = TimeFunction.from_table([1, 2, 4], [0, 10, 30], 1, "load")
    np.testing.assert_allclose(f.table(np.array([0, 1, 1.5, 3, 4, 9.0]))[:, 0], [0, 0, 5, 20, 30, 30])
    g = vector({"t": [0, 1], "value": [[0, 0, 0], [1, 2, 3]]})
    np.testing.assert_allclose(g(0.5), [0.5, 1.0, 1.5])
    assert not g.constant
    assert TimeFunction.from_table([0, 1], [5, 5], 1, "load").constant


def test_describe_is_plain():
    def push(t):
        return 1.0

    assert scalar(push).describe() == "<function push>"
    assert vector(np.array([1.0, 2.0, 3.0])).describe() == [1.0, 2.0, 3.0]
    assert vector((0, 0, "sin(t)")).describe() == [0, 0, "sin(t)"]
    assert scalar({"t": [0, 1], "value": np.array([1, 2])}).describe() == {"t": [0, 1], "value": [1, 2]}


def test_copy_keeps_the_function_and_takes_the_new_place():
    f = TimeFunction(vector((0, 0, "t")), 3, "elsewhere")
    assert f.where == "elsewhere"
    np.testing.assert_array_equal(f(2.0), [0.0, 0.0, 2.0])


BAD_SCALARS = [
    (None, "load", "must be a number"),
    (True, "load", "must be a number, is True"),
    (1j, "load", "must be a number"),
    (float("nan"), "load", "finite"),
    (float("inf"), "load", "finite"),
    ([1, 2], "load", "must be a number"),
    ("", "load", "empty"),
    ("   ", "load", "empty"),
    ("t +", "load", "no formula of t"),
    ("(t", "load", "no formula of t"),
    ("2*3 m", "load", "no formula of t"),
    ("20 ms", "load", "a number with a unit, must be a number (give the number alone"),
    ("-1.5e3kN/m^2", "load", "a number with a unit"),
    ("5 %", "load", "a number with a unit"),
    ("2t", "load", "no formula of t: invalid decimal literal at column 1 (write * for a product: 2*t)"),
    ("3 t", "load", "write * for a product: 3*t"),
    ("np.float64(2.0)*t", "load", "NumPy shows its numbers so: put float(...) of them into the text"),
    ("2*numpy.int64(3)", "load", "NumPy shows its numbers so"),
    ("t.real(3)", "load", "write * for a product"),
    ("t + 0.5pi", "load", "write * for a product: 0.5*pi"),
    ("2sin(t)", "load", "write * for a product: 2*sin"),
    ("thrust", "load", "in Python give what add_input returned"),
    ("t\x00", "load", "no formula of t"),
    ("sinus(t)", "load", 'unknown name "sinus", known are t, pi, abs()'),
    ("x", "load", 'unknown name "x"'),
    ("__import__('os')", "load", "unknown name"),
    ("t.real", "load", "not allowed"),
    ("(1).__class__", "load", "not allowed"),
    ("[t][0]", "load", "not allowed"),
    ("lambda: t", "load", "not allowed"),
    ("'a'", "load", "not allowed"),
    ("True", "load", "not allowed"),
    ("t^2", "load", "write ** for a power"),
    ("t % 2", "load", "not allowed"),
    ("t in t", "load", "not allowed"),
    ("t is t", "load", "not allowed"),
    ("~t", "load", "not allowed"),
    ("4(t - 1)", "load", "write * for a product"),
    ("pi(2)", "load", "write * for a product"),
    ("1 if t < 1 else 2", "load", "write where(condition, a, b)"),
    ("sin + 1", "load", "write sin(...)"),
    ("sin(t, t)", "load", "sin() takes 1 arguments"),
    ("min(t)", "load", "min() takes 2 or more arguments"),
    ("sin(x=t)", "load", "sin() takes 1 arguments"),
    ("ramp(t, 2, 1)", "load", "needs t0 < t1"),
    ("1/t", "load", "at t = 0 s, must be finite"),
    ("log(t)", "load", "at t = 0 s, must be finite"),
    ("sqrt(t - 1)", "load", "must be finite"),
    ("9**9**9**9", "load", "must be finite"),
    ("1" + "0" * 400, "load", "too large"),
    ("1+" * 3000 + "1", "load", "at most 5000"),
    ("-" * 4000 + "t", "load", "nested too deeply"),
    ("(" * 2000 + "t" + ")" * 2000, "load", "too many nested parentheses"),
    ({"t": [0, 1]}, "load", 'keys "t" and "value"'),
    ({"t": [0, 1], "value": [0, 1], "units": "N"}, "load", 'keys "t" and "value"'),
    ({"t": [0, 0], "value": [0, 1]}, "load.t[1]", "increasing"),
    ({"t": [0, 2, 1, 3], "value": [0] * 4}, "load.t[2]", "is 1 s after 2 s"),
    ({"t": [0], "value": [0]}, "load.t", "at least 2"),
    ({"t": [0, 1], "value": [0]}, "load.value", "1 values for 2 times"),
    ({"t": [0, 1], "value": [0, "1"]}, "load.value[1]", "must be a number"),
    ({"t": [0, 1], "value": [0, float("nan")]}, "load.value[1]", "finite"),
    ({"t": "0", "value": [0]}, "load.t", "list of numbers"),
]


@pytest.mark.parametrize(("given", "where", "phrase"), BAD_SCALARS)
def test_bad_scalar(given, where, phrase):
    with pytest.raises(ModelError) as caught:
        scalar(given)
    assert caught.value.where == where
    assert phrase in str(caught.value)


BAD_VECTORS = [
    ("t", "load", "list of 3 numbers or formulas"),
    (3.0, "load", "list of 3 numbers or formulas"),
    ((1, 2), "load", "has 2 components, wanted 3"),
    ([], "load", "has 0 components, wanted 3"),
    (np.array(1.0), "load", "has 1 components, wanted 3"),
    ([[0, 0, -1], 0, -1], "load[0]", "must be a number"),
    ([[1, 2], [3]], "load", "has 2 components, wanted 3"),
    (np.array(1.0), "load", "wanted 3"),
    ((1, 2, None), "load[2]", "must be a number"),
    ((1, True, 2), "load[1]", "must be a number"),
    ((1, "s", 2), "load[1]", "unknown name"),
    ((0, 0, lambda t: t), "load[2]", "must be a number"),
    ({"t": [0, 1], "value": [0, 1]}, "load.value", "three are wanted"),
]


@pytest.mark.parametrize(("given", "where", "phrase"), BAD_VECTORS)
def test_bad_vector(given, where, phrase):
    with pytest.raises(ModelError) as caught:
        vector(given)
    assert caught.value.where == where
    assert phrase in str(caught.value)


BAD_FUNCTIONS = [
    (lambda t: 1 / t, "raised ZeroDivisionError"),
    (lambda: 1, "raised TypeError"),
    (lambda t: (1, 2), "returned shape (2,), wanted (3,)"),
    (lambda t: [[1, 2, 3]], "returned shape (1, 3), wanted (3,)"),
    (lambda t: 1.0, "returned shape (), wanted (3,)"),
    (lambda t: None, "returned None, wanted (3,)"),
    (lambda t: "abc", "returned 'abc'"),
    (lambda t: (1, 2, 3j), "returned (1, 2, 3j)"),
    (lambda t: [1, [2], 3], "returned [1, [2], 3]"),
    (lambda t: (True, False, True), "wanted (3,)"),
    (lambda t: (0, 0, math.nan), "must be finite"),
]


@pytest.mark.parametrize(("function", "phrase"), BAD_FUNCTIONS)
def test_bad_function(function, phrase):
    with pytest.raises(ModelError) as caught:
        vector(function)
    assert caught.value.where == "load"
    assert "at t = 0 s" in caught.value.what
    assert phrase in caught.value.what


def test_later_failure_names_the_time():
    f = scalar(lambda t: 1 / (2 - t))
    with pytest.raises(ModelError, match=r"load: at t = 2 s the function raised ZeroDivisionError"):
        f.table(np.array([0.0, 1.0, 2.0]))
    g = vector([0, 0, "1/(t - 1.5)"])
    with pytest.raises(ModelError, match=r"load: is \[0.0, 0.0, inf\] at t = 1.5 s"):
        g.table(TIMES)


def test_keyboard_interrupt_goes_through():
    def stop(t):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        scalar(stop)


def test_size_is_1_or_3():
    with pytest.raises(ValueError, match="size"):
        TimeFunction(1.0, 2, "load")


@pytest.mark.parametrize(
    "give",
    [
        lambda model, beam, f: model.pin(beam.end, displacement=(f, 0, 0)),
        lambda model, beam, f: model.add_force(beam.end, [0, f, 1.0]),
        lambda model, beam, f: model.add_distributed_load(beam, (0, 0, f)),
        lambda model, beam, f: model.add_fluid("air", 1.2, velocity=(0, f, 0), on=[]),
    ],
)
@pytest.mark.parametrize("function", [np.sin, lambda t: 0.1 * t])
def test_a_function_for_one_component_is_told_to_give_three(give, function):
    model = ancf.Model()
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=0.1)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    with pytest.raises(ancf.ModelError, match=r"\[\d\]: must be a number, is a function: one of t gives all"):
        give(model, beam, function)
