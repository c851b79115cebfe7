"""Places of a route are those of its track: it may begin at any of them, and runs alike."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import ancf
from ancf import ModelError, catenary
from ancf.catenary import Conditions, Mesh, Route, Span
from ancf.catenary.answers.passing import dropper_forces
from ancf.catenary.report.marks import clear
from overhead_lines import COARSE, STEP, collector, droppers, short_line

LENGTH, SHARED = 36.0, 3
GIVEN = {"speed": 55.0, "pantograph": collector(), "mesh": COARSE, "step": STEP}
PLACES = (-250.0, 35.5, 1200.0)
SECTIONS = {"alone": 1, "overlapping": 2}


def route(begin, sections=1, **changes):
    """Tension lengths of equal spans, the first of which begins there, m."""
    count = 5
    spans = [Span(length=LENGTH, droppers=droppers(LENGTH))] * count
    made = []
    for k in range(sections):
        height = np.zeros(count + 1)
        if sections > 1:  # each wire is raised at its anchor beside the other
            height[[0, 1] if k else [-1, -2]] = 0.35, 0.06
        side = 0.1 if k else -0.1
        more = {"anchors": "tension", "contact_support": "free", "height": tuple(height)}
        made.append(short_line(spans=spans, stagger=(side,) * (count + 1), **more, **changes))
    starts = begin + LENGTH * (count - SHARED) * np.arange(sections)
    return Route(lines=tuple(made), starts=tuple(starts))


@pytest.mark.parametrize("begin", PLACES)
@pytest.mark.parametrize("sections", SECTIONS.values(), ids=SECTIONS)
def test_from_the_default_start_over_the_default_window(begin, sections):
    here, there = route(0.0, sections), route(begin, sections)
    assert (there.begin, there.end, there.length) == (begin, begin + here.end, here.length)
    one, other = catenary.run(here, **GIVEN), catenary.run(there, **GIVEN)
    assert np.subtract(other.window, one.window) == pytest.approx(begin)
    first, second = one.recordings[0], other.recordings[0]
    np.testing.assert_allclose(second.position - begin, first.position, rtol=0, atol=1e-9)
    np.testing.assert_allclose(second.force, first.force, rtol=0, atol=1e-3)
    np.testing.assert_allclose(other.uplift, one.uplift, rtol=0, atol=1e-7)
    assert catenary.statistics(other)["mean_force"].value > 100.0
    kept = [clear(shown(run), x.position) for run, x in ((one, first), (other, second))]
    assert 0 < kept[0].sum() < kept[0].size
    np.testing.assert_array_equal(*kept)


def shown(run):
    """What a figure of a report asks for, with a window of no length."""
    return SimpleNamespace(run=SimpleNamespace(window=(run.window[0], run.window[0]), form=run.form))


@pytest.mark.parametrize("begin", PLACES)
@pytest.mark.parametrize("reduce", [False, True])
def test_steps(begin, reduce):
    """A stepper begins there too, and ends where the route does."""
    line = route(begin)
    stepper = catenary.stepper(line, **GIVEN, reduce=reduce)
    still = float(stepper.pantograph().position)
    assert still == pytest.approx(begin + LENGTH / 3.0)
    stepper.advance(20)
    assert stepper.pantograph().force > 50.0
    with pytest.raises(ModelError, match=f"end of the line, {line.end:g} m"):
        stepper.advance(int(5.0 * LENGTH / (55.0 * STEP)))


@pytest.mark.parametrize("begin", PLACES)
def test_of_ones_own_simulation(begin):
    overhead = catenary.assemble(catenary.form(route(begin), COARSE))
    unit = overhead.add_pantograph(collector(), 55.0, start=begin + 20.0)
    result = ancf.simulate(
        overhead.model, t_end=0.02, step=STEP, start=ancf.equilibrium(overhead.model), sensors=unit.sensors()
    )
    assert result.sensors.contact_force(unit.meter).min() > 50.0
    with pytest.raises(ModelError, match="start"):
        overhead.add_pantograph(collector(), 55.0, start=begin - 1.0)


@pytest.mark.parametrize("begin", PLACES)
def test_undersides_and_gusts_lie_along_it(begin):
    rows = catenary.random_underside(route(begin), lambda nu: 1e-9 / nu**2, wavelengths=(2.0, 30.0), seed=2)
    assert rows[[0, -1], 0].tolist() == [begin, begin + 5 * LENGTH]
    here = short_line()
    wires = {k: replace(getattr(here, k), diameter=0.012) for k in ("contact_wire", "messenger_wire")}
    blown = {"conditions": Conditions(wind=12.0, turbulence=0.2), **wires}
    runs = []
    for x in (0.0, begin):
        given = {"start": x + 20.0, "window": (x + 72.0, x + 80.0), "until": x + 85.0}
        runs.append(catenary.run(route(x, **blown), **GIVEN, **given))
    stagger = [run.recordings[0].stagger for run in runs]
    np.testing.assert_allclose(*stagger, rtol=0, atol=1e-6)


@pytest.mark.parametrize("begin", PLACES)
@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"start": -5.0}, "starts at {0:g} m, the line reaches from {1:g} to {2:g} m"),
        ({"start": 181.0}, "starts at {0:g} m, the line reaches from {1:g} to {2:g} m"),
        ({"window": (-4.0, 60.0)}, "is {0:g} m to {3:g} m, the line reaches from {1:g} to {2:g} m"),
        ({"until": 190.0}, "the line ends at {2:g} m"),
    ],
)
def test_what_is_beside_it_is_refused(begin, given, said):
    line = route(begin)
    places = {k: tuple(begin + x for x in v) if isinstance(v, tuple) else begin + v for k, v in given.items()}
    [first, *more] = np.atleast_1d(next(iter(places.values()))).tolist()
    wanted = said.format(first, line.begin, line.end, *more)
    with pytest.raises(ModelError) as error:
        catenary.run(catenary.form(line, Mesh(contact=4.0, messenger=6.0)), speed=55.0, **places)
    assert wanted in str(error.value)


@pytest.mark.parametrize("slack", [(True, False), (False, True), (True, True), (False, False)])
def test_droppers_go_slack_as_those_of_their_section(slack):
    """Those of a section that can push are never slack, whatever the first section has."""
    made = route(0.0, 2)
    parts = [
        replace(line, droppers=replace(line.droppers, slack=one))
        for line, one in zip(made.lines, slack, strict=True)
    ]
    done = catenary.run(replace(made, lines=tuple(parts)), **GIVEN)
    pushed = replace(done, dropper_force=done.dropper_force - 1e3)
    found = [one.slack.number > 0 for one in dropper_forces(pushed)]
    assert found == np.repeat(slack, 25).tolist()
