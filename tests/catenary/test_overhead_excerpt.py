"""A part of a line is in the state of the line: its droppers are off alike, its ends are pulled alike."""

from dataclasses import replace

import numpy as np
import pytest

from ancf.catenary import (
    Conditions,
    DropperErrors,
    Route,
    Span,
    Tensioner,
    elasticity,
    form,
)
from helpers import some
from overhead_lines import COARSE, droppers, short_line

ERRORS = DropperErrors(deviation=0.004, seed=5)


def long_line(spans=9, **changes):
    made = [Span(length=30.0 + 2.0 * (k % 3), droppers=droppers(30.0 + 2.0 * (k % 3))) for k in range(spans)]
    return short_line(**({"spans": made, "stagger": 0.2} | changes))


def off(line):
    """Errors of the lengths of its droppers, m."""
    return form(line, COARSE).cut_length - form(replace(line, dropper_errors=None), COARSE).cut_length


@pytest.mark.parametrize(("first", "count"), some([(0, 2), (2, 3), (4, 1), (3, 2)]))
@pytest.mark.parametrize("changes", [{}, {"contact_spacing": 0.04}])
def test_droppers_are_off_as_in_the_line(first, count, changes):
    line = short_line(dropper_errors=ERRORS, **changes)
    own = (line.dropper_span >= first) & (line.dropper_span < first + count)
    found = off(line.excerpt(first, count))
    assert found == pytest.approx(off(line)[own], abs=1e-12)
    assert np.ptp(found) > 1e-3


def test_excerpts_of_excerpts():
    line = long_line(dropper_errors=ERRORS)
    assert line.excerpt(2, 6).excerpt(1, 3) == line.excerpt(3, 3)


@pytest.mark.parametrize("span", [4, 6])
def test_elasticity_is_that_of_the_form(span):
    """Of spans beside it as of the whole line: with other droppers it was up to some per cent off."""
    line = long_line(anchors="tension", dropper_errors=replace(ERRORS, deviation=0.01))
    given = {"forces": (100.0,), "points": 2, "span": span}
    whole = elasticity(form(line, COARSE), **given).value
    part = elasticity(line, beside=3, mesh=COARSE, **given).value
    assert part == pytest.approx(whole, rel=4e-3)


def test_elasticity_of_the_longest_section():
    """Its droppers are off as they are in the route."""
    few, many = (
        long_line(spans, anchors="tension", dropper_errors=replace(ERRORS, deviation=0.01))
        for spans in (3, 4)
    )
    route = Route(lines=(few, many), starts=(0.0, 60.0))
    whole = elasticity(form(route, COARSE), (100.0,), 2)
    alone = elasticity(route, (100.0,), 2, mesh=COARSE)
    assert alone.value == pytest.approx(whole.value, rel=1e-6)


@pytest.mark.parametrize("degrees", [-30.0, 60.0])
@pytest.mark.parametrize("stiffness", some([2e3, 8e3, 50e3]))
def test_springs_pull_alike(degrees, stiffness):
    """What heat changes of the tension is that of the whole line."""
    tensioner = Tensioner(stiffness=stiffness)
    line = long_line(anchors="spring", tensioner=tensioner, conditions=Conditions(temperature=degrees))
    whole, part = form(line, COARSE).pull[0].mean(), form(line.excerpt(3, 3), COARSE).pull[0].mean()
    assert part - 20e3 == pytest.approx(whole - 20e3, rel=0.05)
    assert line.excerpt(0, 9) == line
