"""What is asked of lines, forms and runs with a thing of another kind is answered by name, never silently."""

from functools import cache

import numpy as np
import pytest

import catenary_stand_in as stand_in
from ancf import ModelError, catenary
from overhead_lines import COARSE, STEP, collector, short_line

RUN = stand_in.run()
GIVEN = {"speed": 50.0, "pantograph": collector(), "step": STEP}
NUMBERS = catenary.FatigueLine(range=1.0, cycles=1.0, slope=1.0)


@cache
def found():
    return catenary.form(short_line(), COARSE)


@pytest.mark.parametrize("other", [3, "text", None, [1.0]])
@pytest.mark.parametrize(
    "ask",
    [
        catenary.statistics,
        catenary.acceptance,
        catenary.time_above,
        catenary.measure,
        catenary.clamp_strains,
        lambda other: catenary.write_run(other, "nowhere"),
    ],
)
def test_no_run(ask, other):
    with pytest.raises(ModelError, match="must be a Run"):
        ask(other)


@pytest.mark.parametrize("place", [1, 7, -1, 1.5, "1", None])
@pytest.mark.parametrize(
    "ask",
    [
        lambda k: catenary.statistics(RUN, k),
        lambda k: catenary.acceptance(RUN, k),
        lambda k: catenary.time_above(RUN, (100.0,), k),
        lambda k: catenary.measure(RUN, k),
    ],
)
def test_no_such_pantograph(ask, place):
    with pytest.raises(ModelError, match=r"\.pantograph"):
        ask(place)


@pytest.mark.parametrize(
    ("ask", "where"),
    [
        (lambda: catenary.statistics(RUN, filter=4), "statistics.filter"),
        (lambda: catenary.time_above(RUN, 150.0), "time_above.levels"),
        (lambda: catenary.time_above(RUN, np.zeros(0)), "time_above.levels"),
        (lambda: catenary.time_above(RUN, (100.0, "x")), "time_above.levels"),
        (lambda: catenary.measure(RUN, head=3), "measure.head"),
        (lambda: catenary.clamp_strains(RUN, over=(90.0, 66.0)), "clamp_strains.over"),
        (lambda: catenary.clamp_strains(RUN, over=(float("nan"), 66.0)), "clamp_strains.over"),
        (lambda: catenary.clamp_strains(RUN, over=3.0), "clamp_strains.over"),
        (lambda: catenary.rainflow("text"), "rainflow.history"),
        (lambda: catenary.rainflow([[1.0], [1.0, 2.0]]), "rainflow.history"),
        (lambda: catenary.rainflow([1.0, 3.0, 1.0]).number("x"), "cycles.least"),
        (lambda: NUMBERS.damage([1.0, 2.0]), "fatigue.damage"),
        (lambda: catenary.elasticity(found(), forces=100.0), "elasticity.forces"),
        (lambda: catenary.elasticity(found(), forces=[]), "elasticity.forces"),
        (lambda: catenary.form(short_line(), 0.8), "catenary.mesh"),
        (lambda: catenary.assemble(short_line()), "assemble.form"),
        (lambda: catenary.assemble(found(), 0.8), "catenary.mesh"),
        (lambda: catenary.assemble(found()).break_dropper("1", 1), "overhead.dropper.span"),
        (lambda: catenary.assemble(found()).break_dropper(1, 1.5), "overhead.dropper.number"),
        (lambda: catenary.assemble(found()).add_mass("a", (50.0, 0.0, 0.0), 1.0), "a.point"),
        (lambda: catenary.dynamic_stiffness("benchmark-2015", [1.0]), "dynamic_stiffness.unit"),
        (lambda: catenary.dynamic_stiffness(collector(), [float("nan")]), "dynamic_stiffness.frequency"),
        (lambda: catenary.dynamic_stiffness(collector(), [1.0, -1.0]), "dynamic_stiffness.frequency"),
        (lambda: catenary.run(found(), **GIVEN, modify=3), "run.modify"),
        (lambda: catenary.stepper(found(), **GIVEN, modify="x"), "stepper.modify"),
        (lambda: catenary.run(found(), **GIVEN, control_step=1e-3), "run.control_step"),
        (lambda: catenary.run(found(), **GIVEN, control_delay=1e-3), "run.control_delay"),
        (lambda: catenary.write_report(RUN, "report.pfd"), "report.pfd"),
    ],
)
def test_is_named(ask, where):
    with pytest.raises(ModelError) as error:
        ask()
    assert where in error.value.where


@pytest.mark.parametrize("track", [-5.0, 169.0, 1e6, float("nan"), "50"])
@pytest.mark.parametrize("wire", ["contact_at", "messenger_at"])
@pytest.mark.parametrize("begin", [0.0, 400.0])
def test_beside_the_line_there_is_no_wire(wire, track, begin):
    """It was the end of the wire, however far away: a mass for 1060 m hung on the mast at 166 m."""
    line = catenary.Route(lines=(short_line(),), starts=(begin,)) if begin else short_line()
    overhead = catenary.assemble(catenary.form(line, COARSE))
    ask = getattr(overhead, wire)
    with pytest.raises(ModelError, match=rf"overhead\.{wire}\.track"):
        ask(track if isinstance(track, str) else begin + track)
    for inside in (0.0, 1e-9, 83.0, 166.0):
        assert ask(begin + inside).initial_position[0] == pytest.approx(begin + inside, abs=1e-3)
