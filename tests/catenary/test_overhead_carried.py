"""What a line cannot have been meant to have: loads of every section, no droppers, parts of another kind."""

import tomllib
from dataclasses import replace

import pytest

from ancf import catenary
from ancf.catenary.forms.form import check
from ancf.catenary.forms.reach import without_droppers
from ancf.catenary.lines.file import parse_track
from ancf.catenary.lines.line_parts import LISTS, MAY_LACK, PARTS
from ancf.errors import ModelError
from overhead_lines import COARSE, LENGTHS, STEP, TOML, collector, short_line

LOADS = [{"position": 20.0, "mass": 5.0}, {"position": 70.0, "mass": 2.0, "wire": "messenger"}]


def sections(starts, loads=(), own=()):
    """A file with so many tension lengths, masses above them and in the first one."""
    tables = tomllib.loads(TOML)
    spans = tables.pop("spans")
    tables["sections"] = [{"start": start, "spans": spans} for start in starts]
    if own:
        tables["sections"][0]["loads"] = list(own)
    if loads:
        tables["loads"] = list(loads)
    return tables


@pytest.mark.parametrize("starts", [(0.0, 90.0), (0.0, 90.0, 180.0)])
@pytest.mark.parametrize("count", [1, 2])
def test_loads_above_the_sections_are_refused(starts, count):
    """Each section would carry all of them, at places from its own first support."""
    with pytest.raises(ModelError, match=r"loads: stand above the sections.*write \[\[sections\.loads\]\]"):
        parse_track(sections(starts, LOADS[:count]))
    track = parse_track(sections(starts, own=LOADS[:count]))
    assert [len(part.loads) for part in track.parts] == [count, *[0] * (len(starts) - 1)]


@pytest.mark.parametrize("count", [1, 2])
def test_loads_above_one_section(count):
    assert len(parse_track(sections((0.0,), LOADS[:count])).parts[0].loads) == count


def bare(**changes):
    line = short_line(**changes)
    return replace(line, spans=[replace(span, droppers=(), pre_sag=0.0) for span in line.spans])


@pytest.mark.parametrize("tension", [10e3, 20e3])
@pytest.mark.parametrize("mass", [0.9, 1.35])
def test_a_messenger_that_carries_nothing(tension, mass):
    line = short_line()
    line = bare(contact_wire=replace(line.contact_wire, tension=tension, mass=mass))
    sag = mass * 9.81 * max(LENGTHS) ** 2 / (8.0 * tension)
    assert f"sags by {sag:.2f} m; give places, or dropper_rule" in without_droppers(line)[0]
    assert without_droppers(line)[0] in check(line)


def test_a_run_says_so_too():
    with pytest.warns(UserWarning, match="the messenger carries nothing"):
        catenary.run(
            bare(),
            speed=30.0,
            pantograph=collector(),
            mesh=COARSE,
            step=STEP,
            window=(60.0, 65.0),
            until=66.0,
        )


def test_lines_with_droppers_and_of_trams():
    assert without_droppers(short_line()) == []
    assert without_droppers(replace(bare(), messenger_wire=None)) == []


@pytest.mark.parametrize("key", [*PARTS, *LISTS])
@pytest.mark.parametrize("value", [None, 3.0, "CuAg AC-100", {"EA": 1.0}, [None], [2.0]])
def test_parts_of_another_kind(key, value):
    """They are named, with the class that is wanted; the line of a name or a table is that of a file."""
    if value is None and key in MAY_LACK:
        replace(bare(), **{key: value})
        return
    kind = PARTS.get(key) or LISTS[key]
    with pytest.raises(ModelError, match=rf"line\.{key}.*must be a (list of )?{kind.__name__}, is"):
        short_line(**{key: value})
