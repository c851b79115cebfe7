"""Sensitivities by places of clamped beams, whose clamps turn with them."""

import numpy as np
import pytest

import ancf
from ancf.design.formulas import Formula
from ancf.design.gradient import OF_RUN, slopes_of
from ancf.sensitivity.family import Family
from ancf.sensitivity.nearby import Nearby
from ancf.sensitivity.parameters import parameters_of
from ancf.system.system import System
from helpers import EXACT
from slopes import extrapolated, off

METHODS = [ancf.Trapezoidal(newton=EXACT), ancf.GeneralizedAlpha(rho_inf=0.8, newton=EXACT)]
PLACES = [f"beam.{end}[{k}]" for end in ("start", "end") for k in range(3)]
ENERGY = "integral(norm(velocity(beam.end))**2) + 0.1*last(tension(beam.start))"


def clamped(stretch="free", **damping):
    """A cable that falls from a clamp, with a spring; it is stretched and moves at the start."""
    model = ancf.Model(gravity=(0.3, 0.2, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2, **damping)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(0.9, 0.3, 0.2), elements=3, section=section)
    model.clamp(beam.start, stretch=stretch)
    model.add_force(beam.end, (0.1, "0.5*sin(9*t)", 1.0), name="push")
    beam.set_motion(velocity=(0.0, 0.0, 0.0))
    return model


def settings(method):
    return {"t_end": 0.05, "step": 1e-3, "integrator": method}


CASES = {
    "stiff": clamped,
    "fixed": lambda: clamped(stretch="fixed"),
    "damped": lambda: clamped(axial_damping=0.5, bending_damping=0.01, damping=0.1),
}


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("case", CASES)
def test_both_ends_together_move_all_alike(case, method):
    """A beam that is moved as a whole moves as before, elsewhere."""
    model = CASES[case]()
    result = ancf.simulate(model, sensitivities=PLACES, **settings(method))
    _, slope = ancf.gradient(model, ENERGY, PLACES, **settings(method))
    for k in range(3):
        both = [result.sensitivity(f"beam.{end}[{k}]") for end in ("start", "end")]
        for point in ("beam.start", "beam.at(0.4)", "beam.end"):
            moved = sum(own.position(point) for own in both)
            assert np.max(np.abs(moved - np.eye(3)[k])) < 1e-9
            assert np.max(np.abs(sum(own.slope(point) for own in both))) < 1e-9
        each = [slope[f"beam.{end}[{k}]"] for end in ("start", "end")]
        assert abs(sum(each)) < 1e-8 * max(map(abs, slope.values()))
        assert max(map(abs, each)) > 1e-3


@pytest.mark.parametrize("case", CASES)
def test_against_differences(case):
    """Places and slopes of a run, and a gradient, against runs around."""
    model, given = CASES[case](), settings(METHODS[0])
    result = ancf.simulate(model, sensitivities=["beam.EI", *PLACES], **given)
    value, slope = ancf.gradient(model, ENERGY, PLACES, **given)

    def answers(known):
        return [known.position("beam.end").ravel(), known.slope("beam.start").ravel()]

    def value_of(known):
        return slopes_of(Formula(ENERGY, "test", OF_RUN), known.t, known)[:1]

    def of_run(changed):
        known = ancf.simulate(changed, **given)
        return np.concatenate([*answers(known), value_of(known)])

    assert value == pytest.approx(value_of(result)[0], rel=1e-12)
    for name in ("beam.start[2]", "beam.end[1]"):
        wanted = extrapolated(of_run, model, name, 2e-2)
        parts = np.split(wanted[:-1], 2)
        for found, of_runs in zip(answers(result.sensitivity(name)), parts, strict=True):
            assert off(found, of_runs) < 1e-7, name
        assert abs(slope[name] - wanted[-1]) < 1e-7 * abs(wanted[-1]), name


def test_more_than_eight_parameters():
    """In the second group of eight, too, axes turn."""
    model, given = clamped(), settings(METHODS[1])
    names = ["beam.EI", "beam.EA", "beam.rhoA", "gravity[0]", "gravity[1]", *PLACES]
    result = ancf.simulate(model, sensitivities=names, **given)
    for name in names:
        alone = ancf.simulate(model, sensitivities=[name], **given).sensitivity(name)
        scale = np.max(np.abs(alone.position("beam.end")))
        assert result.sensitivity(name).position("beam.end") == pytest.approx(
            alone.position("beam.end"), abs=1e-11 * scale
        )


def turns(model, name):
    """Whether a parameter is known to turn axes, and whether its pushes are made in compiled code."""
    system = System(model)
    [parameter] = parameters_of(model, [name], "test")
    nearby = Nearby([Family(parameter, system, shifts=True)], system, shifts=True)
    return 0 in nearby.turns, 0 in nearby.plain


def test_which_clamps_are_known_to_turn():
    """Not those that turn with time, nor where rows of joints may ask for their axes."""
    assert turns(clamped(), "beam.end[2]") == (True, True)
    assert turns(clamped(stretch="fixed"), "beam.end[2]") == (False, True)
    assert turns(clamped(), "beam.EI") == (False, True)
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2)
    driven = ancf.Model()
    beam = driven.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    driven.clamp(beam.start, rotation="0.3*sin(5*t)", axis=(0, 1, 0))
    assert turns(driven, "beam.end[2]") == (False, False)
    joined = clamped()
    other = joined.add_beam("other", start=(0.9, 0.3, 0.2), end=(1.8, 0.6, 0.4), elements=1, section=section)
    joined.weld("beam.end", other.start)
    assert turns(joined, "beam.end[2]") == (False, False)
