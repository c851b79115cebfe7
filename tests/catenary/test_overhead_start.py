"""Where a run starts and what of it is evaluated when nobody says it, on short lines and on gradients."""

import warnings

import pytest

from ancf import Model, ModelError, equilibrium
from ancf.catenary import assemble, form, run
from ancf.catenary.cautions import before
from ancf.catenary.chain import add_chain, add_stages
from ancf.catenary.collectors import Touch
from ancf.catenary.plan import Door, make_plan
from ancf.catenary.vehicles.travel import make_travel
from overhead_lines import COARSE, STEP, collector, short_line


@pytest.fixture(scope="module")
def found():
    return form(short_line(), COARSE)


def planned(found, start, spacing=None, window=None, until=None):
    return make_plan(
        found, make_travel(40.0), collector(), spacing, start, window, until, Touch(), STEP, Door()
    )


class TestWindow:
    def test_behind_the_run_in(self, found):
        assert planned(found, 15.0).window == (66.0, 98.0)

    def test_a_span_that_fits_without_it(self, found):
        """50 m behind 55 m no span begins; the one from 66 m on is whole, and a warning tells it."""
        assert planned(found, 55.0).window == (66.0, 98.0)
        with pytest.warns(UserWarning, match=r"run\.window: begins 11 m after"):
            run(found, speed=40.0, pantograph=collector(), step=STEP, start=55.0)

    def test_part_of_a_span(self, found):
        with pytest.raises(ModelError, match="no span is left to evaluate") as caught:
            planned(found, 100.0)
        assert "--window 100 126" in caught.value.hint
        with pytest.raises(ModelError, match="no span is left to evaluate") as caught:
            planned(found, 10.0, spacing=120.0)
        assert "--window" not in caught.value.hint

    @pytest.mark.parametrize("spacing", [None, 15.0])
    @pytest.mark.parametrize("window", [None, (66.0, 98.0)])
    @pytest.mark.parametrize("until", [20.0, 60.0, 66.0, 97.9])
    def test_a_run_that_ends_inside(self, found, until, window, spacing):
        """Of the window that the run chooses as of one that is given: nothing is computed without it."""
        with pytest.raises(ModelError, match="inside the window from 66 m to 98 m") as caught:
            planned(found, 10.0, spacing, window, until)
        assert caught.value.where == "run.until"
        assert "run until 98 m or further" in caught.value.hint

    @pytest.mark.parametrize("window", [None, (66.0, 98.0)])
    @pytest.mark.parametrize("until", [98.0, 110.0, 166.0])
    def test_a_run_that_ends_behind(self, found, until, window):
        assert planned(found, 15.0, None, window, until).until == until

    @pytest.mark.parametrize(("low", "high"), [(98.0, 66.0), (66.0, 66.0), (500.0, 66.0)])
    def test_backwards(self, found, low, high):
        with pytest.raises(ModelError, match=f"begins at {low:g} m and ends at {high:g} m") as caught:
            planned(found, 10.0, window=(low, high))
        assert caught.value.where == "run.window"
        assert ("the smaller place first: 66 " in caught.value.hint) == (low > high)


@pytest.mark.parametrize(
    ("changes", "speed", "hard"),
    [
        ({"static_force": 60.0, "aerodynamic": 0.5}, 55.0, True),
        ({"static_force": 60.0, "aerodynamic": 0.0126}, 90.0, False),
        ({"static_force": 70e1}, 40.0, True),
        ({"static_force": 140.0, "aerodynamic": 0.0126}, 40.0, False),
        ({"static_force": 140.0, "aerodynamic": (0.2, 0.05)}, 55.0, True),
    ],
)
def test_pantographs_that_push_too_hard(found, changes, speed, hard):
    """Against the largest law of the mean force, 0.00097 v^2 + 140 N: twice that is a slip of units."""
    unit = collector(**changes)
    plan = make_plan(found, make_travel(speed), unit, None, 15.0, None, None, Touch(), STEP, Door())
    said = [text for text in before(plan) if text.startswith("pantograph.test: pushes with")]
    assert len(said) == hard
    if hard:
        assert f"{unit.force(speed):.0f} N at {3.6 * speed:.0f} km/h" in said[0]
        assert f"has {0.00097 * (3.6 * speed) ** 2 + 140.0:.0f} N at most" in said[0]


def test_start_at_a_kink_of_the_gradient():
    """The guide of the lowest spring starts as steep as the wire ahead: nothing warns, nothing is knocked."""
    line = short_line(height=(0.0, 0.0, 0.03, 0.22, 0.25, 0.25))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        way = {"start": 66.0, "window": (117.0, 120.0), "until": 121.0}
        run(line, mesh=COARSE, speed=30.0, pantograph=collector(), step=STEP, **way)


@pytest.mark.parametrize("above", [1.04, 3.0])
def test_a_spring_longer_than_the_masses_are_apart(above):
    """Relaxed so far below the start, as a trial run at many times the speed of trains may find it."""
    model = Model(gravity=(0, 0, -9.81))
    chain = add_chain(model, collector(), make_travel(40.0), 15.0, 5.0, "pantograph", None)
    with pytest.raises(ModelError, match="longer at the start than without force") as caught:
        add_stages(model, chain, above, None, "pantograph")
    assert caught.value.where == "run.pantograph"


WAVES = [(0.0, 0.002), (10.0, 0.004), (60.0, -0.003)]


@pytest.mark.parametrize("strips", [0.0, 0.4])
@pytest.mark.parametrize("wires", [{}, {"contact_spacing": 0.04}])
@pytest.mark.parametrize("underside", [None, WAVES])
@pytest.mark.parametrize("stiffness", [20e3, 50e3])
def test_the_lowest_spring_is_relaxed_where_the_pantograph_stands(strips, wires, underside, stiffness):
    """It then takes nothing of the force, however many contacts share that and whatever is worn off."""
    unit = collector(strip_distance=strips, stiffness=(4e3, 4200.0), aerodynamic=(0.01, 0.005))
    overhead = assemble(form(short_line(**wires), COARSE))
    given = {"underside": underside, "contact_stiffness": stiffness}
    made = overhead.add_pantograph(unit, 40.0, start=18.0, **given)
    state = equilibrium(overhead.model)
    force = sum(float(state.contact_force(touch)) for touch in made.touches)
    assert len(made.touches) == (2 if strips else 1) * (2 if wires else 1)
    assert force == pytest.approx(unit.force(40.0), abs=0.05)
