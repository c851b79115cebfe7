"""What fits and optima print: each parameter with its numbers, and what to heed."""

import re

import numpy as np
import pytest

import ancf
from ancf.design.fit import Fit
from ancf.design.minimise import Optimum
from ancf.model.tables import number

RANDOM = np.random.default_rng(5)


def fit(count, columns, converged=True, corner=False):
    """Of numbers that are made up, as many parameters and columns as are asked for."""
    values = {f"p{k}": float(10.0 ** RANDOM.uniform(-6, 6)) for k in range(count)}
    spread = RANDOM.standard_normal((count, count)) * np.array([*values.values()])
    data = {f"position(a.at({k}))[2]": RANDOM.standard_normal(20 + k) for k in range(columns)}
    return Fit(
        values,
        {name: (0.0, x if corner else 2.0 * x) for name, x in values.items()},
        1e-4 * spread.T @ spread,
        {name: np.arange(len(y), dtype=float) for name, y in data.items()},
        data,
        {name: y + 0.01 for name, y in data.items()},
        dict.fromkeys(data, 1.0),
        evaluations=7,
        converged=converged,
        message="the steps were all used",
    )


@pytest.mark.parametrize("count", [1, 2, 5])
@pytest.mark.parametrize("columns", [1, 3])
@pytest.mark.parametrize(("converged", "corner"), [(True, False), (False, False), (True, True)])
def test_a_fit(count, columns, converged, corner):
    found = fit(count, columns, converged, corner)
    said, one = str(found), repr(found)
    flat = " ".join(said.split())
    for name, x in found.values.items():
        low, high = found.confidence()[name]
        row = f"{name} {number(x)} {number(found.deviations[name], 3)} {number(low)} to {number(high)}"
        assert row in flat
    for name, y in found.measured.items():
        assert f"{name} {len(y)} 0.01" in flat
    assert all(note in flat for note in found.notes())
    assert ("ended at a bound" in said) == corner
    assert ("stopped before" in said) != converged
    assert "7 evaluations" in said
    assert "array" not in said + one
    assert "\n" not in one
    assert one.count("=") == count


@pytest.mark.parametrize("count", [1, 3])
@pytest.mark.parametrize("constraints", [{}, {"max(tension(a.end))": 12.5}])
@pytest.mark.parametrize("converged", [True, False])
def test_an_optimum(count, constraints, converged):
    values = {f"a.p{k}": 1.5 * k for k in range(count)}
    found = Optimum(values, -3.25, dict.fromkeys(values, 0.125), constraints, 9, converged, "it is done")
    flat = " ".join(str(found).split())
    assert re.search("objective -3.25 search it is done; 9 runs", flat)
    assert all(f"{name} {number(x)} 0.125" in flat for name, x in values.items())
    assert all(f"{formula} {number(x)}" in flat for formula, x in constraints.items())
    assert ("stopped before" in flat) != converged
    assert repr(found) == f"Optimum(-3.25 at {', '.join(f'{n}={number(x)}' for n, x in values.items())})"


def test_of_a_search():
    model = ancf.Model(gravity=(0, 0, -9.81))
    bob = model.add_point_mass("bob", at=(0, 0, -1), mass=1.0)
    model.add_spring(bob, (0, 0, 0), stiffness=50.0, length=1.0, name="stay")
    bounds = {"stay.stiffness": (20.0, 80.0)}
    found = ancf.minimise(model, "last(position(bob)[2])**2", bounds, t_end=0.1, step=0.01)
    assert number(found.values["stay.stiffness"]) in str(found)
    assert "<table" in found._repr_html_()
