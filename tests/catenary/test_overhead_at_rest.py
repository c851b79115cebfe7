"""What is read off a run begins where the line rests: forces of droppers, strain at their clamps.

On lines of all kinds with heavy droppers and clamps, whole and broken, as designed and in other conditions.
"""

import csv
from dataclasses import replace

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.catenary import Auxiliary, Conditions, DropperRule, Droppers, StitchWire, Wire
from ancf.catenary.answers.clamp_strain import edge, hanging, strain_below_strip
from ancf.catenary.answers.passing import dropper_forces
from overhead_lines import COARSE, STEP, collector, droppers, short_line

THIRD = Auxiliary(
    wire=Wire(EA=6e6, EI=40.0, mass=0.6, tension=10e3),
    height=0.4,
    droppers=Droppers(EA=2e5, mass=0.2),
    places=DropperRule(first=6.0, pitch_max=10.0),
)
STITCH = StitchWire(reach=6.0, wire=Wire(EA=3e6, EI=10.0, mass=0.3, tension=2.5e3))
KINDS = {
    "plain": {},
    "auxiliary": {"auxiliary": THIRD},
    "twin wires": {"contact_spacing": 0.04},
    "stitch wires": {"stitch": STITCH},
}
WHOLE, BROKEN = (), ("1-1", "2-3")
#: Of three spans; the window begins 50 m behind the start.
GIVEN = {"pantograph": collector(), "step": STEP, "start": 8.0, "window": (58.0, 80.0), "until": 84.0}


def heavy(mass, **changes):
    """Three spans with droppers of this mass, kg/m."""
    own = Droppers(EA=2e5, mass=mass, clamp_contact=0.3, clamp_messenger=0.2)
    spans = [catenary.Span(length=x, droppers=droppers(x)) for x in (30.0, 36.0, 32.0)]
    return short_line(spans=spans, stagger=0.2, droppers=own, **changes)


def resting(form, broken):
    """Forces of the droppers of the line without pantographs, N; 0 of those that are broken."""
    overhead = catenary.assemble(form)
    for label in broken:
        overhead.break_dropper(*map(int, label.split("-")))
    state = ancf.equilibrium(overhead.model)
    return np.array([0.0 if d is None else float(state.spring_force(d)) for d in overhead.droppers])


@pytest.mark.parametrize("broken", [WHOLE, BROKEN], ids=["whole", "broken"])
@pytest.mark.parametrize(("kind", "mass"), list(zip(KINDS, (0.9, 0.1, 0.4, 2.0), strict=True)))
def test_forces_of_droppers(kind, mass, broken, tmp_path):
    """At rest as in the record, in files too: both are the force between the clamps."""
    state = Conditions() if kind == "plain" else Conditions(temperature=25.0)
    form = catenary.form(heavy(mass, conditions=state, **KINDS[kind]), COARSE)
    done = catenary.run(form, speed=40.0, broken_droppers=broken, **GIVEN)
    rest = resting(form, broken)
    np.testing.assert_allclose([d.rest for d in dropper_forces(done)], rest, rtol=0, atol=1e-5)
    catenary.write_run(done, tmp_path)
    with (tmp_path / "droppers.csv").open(newline="") as file:
        rows = [row for row in csv.DictReader(file) if row["state"] == "whole"]
    assert len(rows) == rest.size - len(broken)
    assert [float(row["rest_N"]) for row in rows] == pytest.approx(rest[rest > 0.0].tolist(), abs=1e-5)
    far = form.line.dropper_x > 80.0
    np.testing.assert_allclose(done.dropper_force[0, far], rest[far], rtol=0, atol=0.7)
    half = 0.5 * mass * form.dropper_length * form.line.gravity
    np.testing.assert_allclose(done.form.dropper_load, np.where(rest > 0.0, rest - half, 0.0), atol=1e-5)


@pytest.mark.parametrize("mass", [0.0, 0.5, 3.0])
@pytest.mark.parametrize("kind", KINDS)
def test_strain_at_clamps(kind, mass):
    """Where no pantograph comes near nothing changes, whatever droppers and clamps weigh."""
    form = catenary.form(heavy(mass, **KINDS[kind]), COARSE)
    done = catenary.run(form, speed=40.0, **GIVEN)
    still = replace(
        done,
        dropper_force=np.tile(resting(form, WHOLE), (done.t.size, 1)),
        recordings=[replace(done.recordings[0], force=np.zeros(done.t.size), by_wire=None)],
    )
    found = catenary.clamp_strains(still, over=(0.0, 98.0))
    assert len(found) == form.line.dropper_x.size
    assert max(one.change for one in found) < 1e-9
    assert max(one.rest for one in found) > 1e-5


@pytest.mark.parametrize("last", [10.0, 50.0, 70.0])
@pytest.mark.parametrize("first", [25.0, 60.0])
def test_strain_at_the_speed_of_the_moment(first, last):
    """Of a train that brakes or gathers speed, not at its mean."""
    form = catenary.form(heavy(0.1), COARSE)
    given = GIVEN | {"speed": [(0.0, first), (0.4, last), (9.0, last)]}
    done = catenary.run(form, **given)
    [wire] = hanging(done)
    speed = np.interp(done.t, [0.0, 0.4], [first, last])
    own = replace(done.recordings[0], force=np.full(done.t.size, 100.0), by_wire=None)
    steady = replace(done, recordings=[own])
    wanted = 100.0 * edge(wire) / (2.0 * np.sqrt(wire.EI * (wire.tension - wire.mass * speed**2)))
    away = np.abs(done.t - 0.4) > 2.0 * STEP
    np.testing.assert_allclose(strain_below_strip(steady, 0)[away], wanted[away], rtol=3e-3)
    passed = catenary.clamp_strains(replace(steady, dropper_force=0.0 * done.dropper_force))
    for one in passed:
        at = np.interp(one.position, done.recordings[0].position, done.t)
        assert one.largest - one.smallest == pytest.approx(np.interp(at, done.t, wanted), rel=5e-3)
    assert len(passed) >= 3
