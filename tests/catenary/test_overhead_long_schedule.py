"""The schedule of the droppers between messenger and auxiliary: places, lengths as cut, loads."""

import csv
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from ancf import catenary
from ancf.catenary import Auxiliary, DropperRule, Droppers, Wire
from ancf.catenary.forms.long_schedule import long_rows, save_long_schedule
from ancf.catenary.forms.schedule import LONG_COLUMNS
from ancf.cli.catenary import show_form
from overhead_lines import COARSE, LENGTHS, TOML, short_line

WIRE = Wire(EA=6e6, EI=40.0, mass=0.9, tension=12e3)
LONG = Droppers(EA=2e5, mass=0.1, clamp_contact=0.2, clamp_messenger=0.3)
PITCHES = [(5.0, 10.0), (3.0, 6.5), (8.0, 40.0)]


@cache
def formed(pitch, degrees=None):
    """The form of a compound line, and the line."""
    line = compound(pitch)
    if degrees is not None:
        line = replace(line, conditions=catenary.Conditions(temperature=degrees))
    return line, catenary.form(line, COARSE)


def compound(pitch, **changes):
    first, most = pitch
    given = Auxiliary(wire=WIRE, height=0.3, droppers=LONG, places=DropperRule(first=first, pitch_max=most))
    return short_line(auxiliary=given, **changes)


@pytest.mark.parametrize("pitch", PITCHES)
@pytest.mark.parametrize("degrees", [None, -20.0, 40.0])
def test_rows_are_those_of_the_form(pitch, degrees):
    line, found = formed(pitch, degrees)
    rows = long_rows(found)
    made = found.long_droppers
    assert [row.track for row in rows] == pytest.approx(line.long_x.tolist())
    assert [row.length for row in rows] == pytest.approx((1e3 * made.length).tolist())
    starts = line.supports[[row.span - 1 for row in rows]]
    assert starts + [row.position for row in rows] == pytest.approx(line.long_x)
    assert all(0.0 < row.position < LENGTHS[row.span - 1] for row in rows)
    for span in range(1, len(LENGTHS) + 1):
        numbers = [row.dropper for row in rows if row.span == span]
        assert numbers == list(range(1, len(numbers) + 1))


@pytest.mark.parametrize("pitch", PITCHES)
def test_a_dropper_is_cut_alike_in_every_state(pitch):
    """What is cut belongs to the design: the same whatever the temperature of the state."""
    forms = [formed(pitch, degrees)[1] for degrees in (None, -20.0, 40.0)]
    lengths = [[row.natural for row in long_rows(form)] for form in forms]
    assert lengths[1] == pytest.approx(lengths[0], abs=1e-6)
    assert lengths[2] == pytest.approx(lengths[0], abs=1e-6)


@pytest.mark.parametrize("pitch", PITCHES)
def test_they_carry_what_hangs_from_the_auxiliary(pitch):
    """Its weight, its clamps and the contact wire's droppers, but for what its ends carry."""
    line, found = formed(pitch)
    rows = long_rows(found)
    span = (line.long_x[0], line.long_x[-1])
    inside = (line.dropper_x >= span[0]) & (line.dropper_x <= span[1])
    carried = sum(row.load for row in rows) - len(rows) * LONG.clamp_contact * line.gravity
    weight = WIRE.mass * line.gravity * (span[1] - span[0]) + found.dropper_force[inside].sum()
    outside = (
        WIRE.mass * line.gravity * (line.length - span[1] + span[0]) + found.dropper_force[~inside].sum()
    )
    assert weight < carried < weight + outside


@pytest.mark.parametrize("mass", [0.0, 1.5])
def test_their_own_weight_is_no_load(mass):
    """What they carry is the same however heavy they are: the auxiliary hangs as it is designed to."""
    rule = DropperRule(first=5.0, pitch_max=10.0)
    loads = []
    for own in (LONG.mass, mass):
        given = Auxiliary(wire=WIRE, height=0.3, droppers=replace(LONG, mass=own), places=rule)
        rows = long_rows(catenary.form(short_line(auxiliary=given), COARSE))
        loads.append([row.load for row in rows])
    assert loads[1] == pytest.approx(loads[0], rel=1e-3)


def test_a_route_counts_on():
    line, found = formed(PITCHES[0])
    route = catenary.Route(lines=(line, line), starts=(0.0, 140.0))
    rows, alone = long_rows(catenary.form(route, COARSE)), long_rows(found)
    first, second = rows[: len(alone)], rows[len(alone) :]
    assert first == alone
    assert [row.span - len(LENGTHS) for row in second] == [row.span for row in alone]
    assert [row.track - 140.0 for row in second] == pytest.approx([row.track for row in alone])


def test_none_without_an_auxiliary():
    assert long_rows(catenary.form(short_line(), COARSE)) == []


@pytest.mark.parametrize("long", [False, True])
def test_the_command_prints_and_writes_it(long, tmp_path, capsys):
    text = TOML
    if long:
        text += "[auxiliary_wire]\nEA = 6e6\nEI = 40.0\nmass = 0.9\ntension = 12e3\nheight = 0.3\n"
        text += "places = {first = 5.0, pitch_max = 10.0}\n[long_droppers]\nEA = 2e5\n"
    (tmp_path / "line.toml").write_text(text, encoding="utf-8")
    show_form(str(tmp_path / "line.toml"), tmp_path / "out")
    said, file = capsys.readouterr().out, tmp_path / "out" / "long_schedule.csv"
    assert file.exists() == long == ("between messenger and auxiliary" in said) == (str(file) in said)
    if long:
        found = catenary.form(catenary.read_line(str(tmp_path / "line.toml")))
        again = save_long_schedule(found, tmp_path / "again.csv")
        assert again.read_text(encoding="utf-8") == file.read_text(encoding="utf-8")
        heads, *rows = csv.reader(file.read_text(encoding="utf-8").splitlines())
        assert tuple(heads) == LONG_COLUMNS
        told = np.array([float(row[5]) for row in rows])
        assert told == pytest.approx(1e3 * found.long_droppers.natural, abs=0.05)
