"""What is asked of lines, forms and runs with a thing of another kind is answered by name, never silently."""

import re
from functools import cache

import numpy as np
import pandas as pd
import pytest

import ancf
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


def _reference():
    return catenary.reference_case("en50318-2002")


#: A number, none, text, a list, a description, a run and a model: of each question all that it is not about.
KINDS = {
    "number": 3,
    "none": None,
    "text": "text",
    "list": [1.0],
    "line": short_line(),
    "run": RUN,
    "model": ancf.Model(),
}


#: What is asked with it, the place that is named, and the kinds that it may be.
ASKED = [
    (catenary.galloping, "galloping.line", ["line"]),
    (catenary.arm_loads, "arm_loads.found", []),
    (catenary.verify, "verify.overhead", []),
    (lambda other: catenary.acceptance(RUN, found=other), "acceptance.found", ["none"]),
    (lambda other: catenary.slopes(other), "slopes.run", ["run"]),
    (lambda other: catenary.slopes(RUN, filter=other), "slopes.filter", ["none"]),
    (lambda other: catenary.measure(RUN, filter=other), "measure.filter", ["none"]),
    (lambda other: catenary.write_report(other, "report.html"), "write_report.run", ["run"]),
    (lambda other: catenary.write_report(RUN, other), "write_report.path", ["text"]),
    (lambda o: catenary.write_report(RUN, "a.html", reference=o), "write_report.reference", ["none"]),
    (lambda o: catenary.write_report(RUN, "a.html", elasticity=o), "write_report.elasticity", ["none"]),
    (lambda o: catenary.write_report(RUN, "a.html", measured=o), "write_report.measured", []),
    (lambda other: catenary.write_run(RUN, other), "write_run.folder", ["text"]),
    (lambda other: catenary.write_run(RUN, "runs", other), "write_run.found", ["none"]),
    (lambda other: catenary.write_validation(RUN, other, "v"), "write_validation.reference", []),
    (lambda o: catenary.write_validation(RUN, _reference(), o), "write_validation.folder", ["text"]),
    (lambda other: catenary.rows(RUN, other), "rows.reference", ["text"]),
    (lambda other: _reference().at(other), "reference.speed_kmh", ["number"]),
    (lambda other: found().save_schedule(other), "save_schedule.path", ["text"]),
    (lambda other: found().plot(size=other), "plot.size", []),
    (lambda other: elastic().save(other), "elasticity.save.path", ["text"]),
    (lambda other: catenary.dropper_errors(other, 1e-3, 1), "dropper_errors.found", []),
    (lambda o: catenary.height_errors(o, np.ones_like, (5.0, 50.0), 1), "height_errors.line", ["line"]),
    (lambda o: catenary.height_errors(short_line(), o, (5.0, 50.0), 1), "height_errors.spectrum", []),
    (lambda o: catenary.random_underside(o, np.ones_like, (5.0, 50.0), 1), "underside.line", ["line"]),
    (lambda o: catenary.random_underside(short_line(), o, (5.0, 50.0), 1), "underside.spectrum", []),
    (lambda other: catenary.read_pantograph(other), "read_pantograph.path", ["text"]),
    (lambda other: catenary.read_measuring_head(other), "read_measuring_head.path", ["text"]),
    (lambda other: catenary.read_underside(other), "read_underside.path", ["text"]),
    (lambda other: catenary.read_run(other), "read_run.folder", ["text"]),
    (lambda other: catenary.read_line("en50318-2002", other), "read_line.values", ["none"]),
    (lambda other: catenary.identify_pantograph(other, [1.0, 2.0]), "identify_pantograph.", []),
    (lambda other: catenary.identify_pantograph([1.0, 2.0], other), "identify_pantograph.", []),
    (lambda other: catenary.add_pantograph(other, collector(), 50.0, start=20.0), ".overhead", []),
    (lambda other: _added(raised=other), "add_pantograph.raised", ["number"]),
    (lambda other: _added(height=other), "add_pantograph.height", ["number", "none"]),
    (lambda other: _added(active=other), "add_pantograph.active", []),
    (lambda other: catenary.assemble(found()).contacts_at(other), "contacts_at.track", ["number"]),
    (lambda other: catenary.assemble(found()).track_x(other), "track_x.point", []),
    (lambda other: catenary.Route(lines=other, starts=(0.0,)), "route.lines", []),
    (lambda other: catenary.Route(lines=(short_line(),), starts=other), "route.starts", ["list"]),
    (lambda other: collector(masses=other), "pantograph.test.masses", ["list"]),
    (lambda other: collector(stops=other), "pantograph.test.stops", []),
    (lambda other: collector(tags=other), "pantograph.test.tags", ["none"]),
    (lambda other: _wire(lift=other), "wire.lift", ["none"]),
    (lambda o: short_line(stitch=catenary.StitchWire(wire=o, reach=5.0)), "line.stitch.wire", []),
    (lambda other: short_line(auxiliary=_auxiliary(wire=other)), "line.auxiliary.wire", []),
    (lambda other: short_line(auxiliary=_auxiliary(droppers=other)), "line.auxiliary.droppers", []),
    (lambda other: short_line(auxiliary=_auxiliary(places=other)), "line.auxiliary.places", ["none"]),
]


@pytest.mark.parametrize(
    ("ask", "where", "kind"),
    [(ask, where, kind) for ask, where, taken in ASKED for kind in KINDS if kind not in taken],
)
def test_another_kind_is_named(ask, where, kind, tmp_path, monkeypatch):
    """They ended with an error from inside: AttributeError, TypeError, IndexError."""
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ModelError) as error:
        ask(KINDS[kind])
    assert where in error.value.where


@cache
def elastic():
    return catenary.elasticity(found(), points=2)


def _added(**options):
    return catenary.add_pantograph(catenary.assemble(found()), collector(), 50.0, start=20.0, **options)


def _wire(**changes):
    return catenary.Wire(**({"EA": 1e7, "EI": 100.0, "mass": 1.0, "tension": 5e3} | changes))


def _auxiliary(**changes):
    given = {"wire": _wire(), "height": 0.5, "droppers": catenary.Droppers(stiffness=1e5)}
    return catenary.Auxiliary(**(given | changes))


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


TABLE = pd.DataFrame({"a": [1.0, 2.0]})
#: What is asked with another kind, the place that is named, and which of the others it may be.
OTHERS = {
    "text": "x",
    "array": np.ones(2),
    "table": TABLE,
    "mapping": {"a": 1},
    "class": dict,
    "object": object(),
}
ASKED_TOO = [
    (lambda o: catenary.run(found(), **GIVEN, control_delay=o), "run.control_delay", ()),
    (lambda o: catenary.run(found(), **GIVEN, sensitivities=o), "run.sensitivities", ()),
    (lambda o: short_line().height_at(o), "line.height_at.track", ("array", "table")),
    (lambda o: short_line().dropper_label(o), "line.dropper_label.j", ()),
    (lambda o: short_line().arm(o), "line.arm.k", ()),
    (lambda o: found().arm(o), "line.arm.k", ()),
    (lambda o: _wire().times(o), "wire.times.count", ()),
    (lambda o: _wire().section(o), "wire.section.rayleigh", ()),
    (lambda o: collector().force(o), "pantograph.force.speed", ("array", "table")),
    (lambda o: collector().slopes(o), "pantograph.slopes.speed", ()),
    (lambda o: catenary.statistics(RUN)[o], "statistics", ()),
]


@pytest.mark.parametrize(
    ("ask", "where", "kind"),
    [(ask, where, kind) for ask, where, taken in ASKED_TOO for kind in OTHERS if kind not in taken],
)
def test_tables_and_arrays_are_named(ask, where, kind):
    """They ended with TypeError, ValueError, AttributeError or IndexError."""
    with pytest.raises(ModelError, match=re.escape(where)):
        ask(OTHERS[kind])


@pytest.mark.parametrize("roof", [0.51, [1.0], {"up": -2.0}])
def test_a_roof_that_is_far_up(roof):
    """A metre took half a minute to say that there is no equilibrium."""
    with pytest.raises(ModelError, match=r"run\.roof.*at most 0\.5 m"):
        catenary.run(found(), **GIVEN, roof=roof)
