"""What forms, runs and statistics print: short, with the numbers that one looks for, and no arrays."""

from dataclasses import replace

import pytest

import catenary_stand_in as stand_in
from ancf.catenary import Conditions, acceptance, elasticity, form, statistics
from overhead_lines import COARSE, short_line

LINES = {
    "plain": {},
    "fixed": {"anchors": "fixed"},
    "cold": {"conditions": Conditions(temperature=-20.0)},
    "without a name": {"title": ""},
    "without messenger": {"messenger_wire": None, "droppers": None, "spans": None},
}


def line_of(key):
    if key != "without messenger":
        return short_line(**LINES[key])
    plain = short_line()
    return replace(
        plain, messenger_wire=None, spans=[replace(span, droppers=(), pre_sag=0.0) for span in plain.spans]
    )


@pytest.mark.parametrize("key", LINES)
def test_forms(key):
    found = form(line_of(key), COARSE)
    said, one = str(found), repr(found)
    assert "array" not in said + one
    assert len(said.splitlines()) <= 12
    assert "\n" not in one
    assert len(one) < 160
    title = found.line.title or "Overhead line"
    assert said.startswith(f"{title}, at rest")
    for text in ("5 spans", "166 m", f"contact wire {found.pull[0].min():.0f}", "km/h on the contact wire"):
        assert text in " ".join(said.split())
    assert ("mm long" in said) == bool(found.dropper_load.size)
    assert one.startswith("Form(")
    assert "<table" in found._repr_html_() or title in found._repr_html_()


@pytest.mark.parametrize("count", [1, 2])
def test_runs(count):
    run = stand_in.run(count=count)
    said, one = str(run), repr(run)
    assert "array" not in said + one
    for k in range(count):
        for quantity in acceptance(run, k):
            assert quantity.name in said
    assert said.count("mean force Fm") == count
    assert one == f"Run('EN 50318:2002 reference model', {run.speed_kmh:.4g} km/h, {count} " + (
        f"pantograph{'s' * (count > 1)}, {run.window[0]:g} m to {run.window[1]:g} m)"
    )
    found = statistics(run)
    assert all(quantity.name in str(found) for quantity in found.values())
    assert repr(found) == f"Statistics({found.pantograph!r}, {len(found)} quantities)"


def test_a_run_without_its_window():
    """It prints all the same, without the table."""
    run = replace(stand_in.run(), window=(5e3, 6e3))
    assert "evaluated    from 5000 m to 6000 m" in str(run)
    assert "mean force" not in str(run)


@pytest.mark.parametrize("forces", [(100.0,), (50.0, 150.0), (60.0, 120.0, 180.0)])
def test_elasticities(forces):
    found = elasticity(form(short_line(), COARSE), forces, points=5, span=1)
    said, one = str(found), repr(found)
    lines = said.splitlines()
    assert lines[0] == "Elasticity along span 2"
    assert all(
        f"{ratio:.1f} % at {force:g} N" in said
        for force, ratio in zip(forces, 100 * found.nonuniformity, strict=True)
    )
    rows = [[float(cell) for cell in line.split()] for line in lines[-len(found.x) :]]
    assert [row[0] for row in rows] == pytest.approx(found.x.tolist(), abs=0.01)
    for k in range(len(forces)):
        assert [row[1 + k] for row in rows] == pytest.approx(found.value[k].tolist(), abs=1e-4)
    assert one == f"Elasticity(span 2, {found.value.min():.4g} to {found.value.max():.4g} mm/N)"
