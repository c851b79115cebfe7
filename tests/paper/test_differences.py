"""Differences of whole computations and Taylor remainders, of functions whose derivatives are known."""

import numpy as np
import pytest

import ancf
from ancf.model.vary import value_of
from ancf.paper.differences import DECADES, extrapolated, order, remainders


def model(mass):
    made = ancf.Model()
    made.add_point_mass("bob", at=(0, 0, 0), mass=mass)
    return made


NAME = "bob.mass"
#: Functions of the mass, and their derivatives.
FUNCTIONS = {
    "sine": (np.sin, np.cos),
    "inverse": (lambda m: 1.0 / m, lambda m: -1.0 / m**2),
    "several": (lambda m: np.array([m**3, np.exp(m), 2.0]), lambda m: np.array([3 * m**2, np.exp(m), 0.0])),
}


def of(function):
    return lambda made: function(value_of(made, NAME))


@pytest.mark.parametrize("mass", [0.3, 2.0, 50.0])
@pytest.mark.parametrize("name", FUNCTIONS)
@pytest.mark.parametrize("width", [0.005, 0.02])
def test_extrapolated(name, mass, width):
    function, derivative = FUNCTIONS[name]
    found = extrapolated(of(function), model(mass), NAME, width)
    wanted = np.asarray(derivative(mass))
    scale = max(np.max(np.abs(wanted)), np.max(np.abs(function(mass))) / mass)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=3e-11 * scale)


@pytest.mark.parametrize("mass", [0.3, 2.0])
@pytest.mark.parametrize("name", FUNCTIONS)
def test_remainders_fall_with_the_square(name, mass):
    function, derivative = FUNCTIONS[name]
    left = remainders(of(function), model(mass), NAME, np.asarray(derivative(mass)), 0.01)
    assert len(left) == len(DECADES)
    assert order(left) == pytest.approx(2.0, abs=0.02)
    wrong = remainders(of(function), model(mass), NAME, 1.001 * np.asarray(derivative(mass)), 0.01)
    assert abs(order(wrong) - 2.0) > 0.1


def test_order_is_that_of_the_worst_decade():
    assert order([1e-4, 1e-6, 1e-9, 1e-11]) == pytest.approx(3.0)
    assert order([1e-4, 1e-6, 1e-7, 1e-9]) == pytest.approx(1.0)
    assert order([1e-9, 1e-11, 2e-12, 2e-13]) == pytest.approx(2.0)  # what is round-off is not judged
    assert order([1e-13, 1e-14, 1e-15, 1e-16]) is None
