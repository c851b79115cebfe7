"""Optima against closed forms and against a search without derivatives."""

import numpy as np
import pytest
from scipy.optimize import minimize

import ancf

GIVEN = {"t_end": 0.02, "step": 2e-3}


def pulled(force=0.0, across=0.0):
    """A soft cantilever that two forces move from rest."""
    model = ancf.Model()
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ancf.Section(EA=50.0, EI=0.5, rhoA=0.1)
    )
    model.clamp(beam.start)
    model.add_force(beam.end, (0.0, across, force), name="pull")
    return model


TARGET = "(last(position(beam.end)[2]) - 0.002)**2 + (last(position(beam.end)[1]) + 0.001)**2"


def test_a_target_is_met():
    """Two forces, two places: the least is zero, from a model and from a function alike."""
    bounds = {"pull.force[2]": (-1.0, 1.0), "pull.force[1]": (-1.0, 1.0)}
    found = ancf.minimise(pulled(), f"1e6*({TARGET})", bounds, start=dict.fromkeys(bounds, 0.3), **GIVEN)
    assert found.converged
    assert found.objective < 1e-10
    assert found.gradients <= 15
    result = ancf.simulate(pulled(found.values["pull.force[2]"], found.values["pull.force[1]"]), **GIVEN)
    assert result.position("beam.end")[-1][1:] == pytest.approx([-0.001, 0.002], abs=1e-7)
    built = ancf.minimise(
        pulled,
        f"1e6*({TARGET})",
        {"force": (-1.0, 1.0), "across": (-1.0, 1.0)},
        start={"force": 0.3, "across": 0.3},
        **GIVEN,
    )
    assert [*built.values.values()] == pytest.approx([*found.values.values()], abs=1e-5)


def test_needs_fewer_runs_than_a_search_without_derivatives():
    bounds = {"pull.force[2]": (-1.0, 1.0), "pull.force[1]": (-1.0, 1.0)}
    found = ancf.minimise(pulled(), f"1e6*({TARGET})", bounds, start=dict.fromkeys(bounds, 0.3), **GIVEN)

    def number(x):
        place = ancf.simulate(pulled(*x), **GIVEN).position("beam.end")[-1]
        return 1e6 * ((place[2] - 0.002) ** 2 + (place[1] + 0.001) ** 2)

    blind = minimize(number, [0.3, 0.3], method="Nelder-Mead", options={"fatol": 1e-10, "xatol": 1e-8})
    assert blind.x == pytest.approx([*found.values.values()], abs=1e-4)
    assert 4 * found.gradients < blind.nfev


def test_bounds_and_constraints():
    """The lowest tip within a bound of the sideways motion: the optimum is on both."""
    bounds = {"pull.force[2]": (-1.0, 1.0), "pull.force[1]": (-1.0, 1.0)}
    aside = "last(position(beam.end)[1])"
    found = ancf.minimise(
        pulled(),
        f"1e3*(last(position(beam.end)[2]) + {aside})",
        bounds,
        constraints={aside: (-0.0005, None)},
        **GIVEN,
    )
    assert found.values["pull.force[2]"] == pytest.approx(-1.0)
    assert found.constraints[aside] == pytest.approx(-0.0005, rel=1e-5)
    assert found.slope["pull.force[2]"] > 0


def test_bad_input():
    with pytest.raises(ancf.ModelError, match="must be a Model or a function"):
        ancf.minimise(3, "last(t)", {"a": (0, 1)}, **GIVEN)
    with pytest.raises(ancf.ModelError, match="must return a Model"):
        ancf.minimise(lambda a: a, "last(t)", {"a": (0, 1)}, **GIVEN)
    with pytest.raises(ancf.ModelError, match="must be a pair"):
        ancf.minimise(pulled(), "last(t)", {"pull.force[2]": (0, 1)}, constraints={"last(t)": 3.0}, **GIVEN)
    assert np.isfinite(ancf.gradient(pulled(0.1), "last(position(beam.end)[2])", [], **GIVEN)[0])
