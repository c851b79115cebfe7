"""Modes of rings that are stiff against stretch: by how much locking raises them is said, after Love."""

import re
from types import SimpleNamespace

import numpy as np
import pytest

import ancf
from ancf.solvers.statics.locking import stiffest


def ring(elements, stiff, radius=1.0, flat=True):
    """A ring of EI = rhoA = 1 and EA R^2/EI = ``stiff``, that moves in its plane."""
    model = ancf.Model()
    angle = np.linspace(0.0, 2.0 * np.pi, elements, endpoint=False)
    path = radius * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    section = ancf.Section(EA=stiff / radius**2, EI=1.0, rhoA=1.0)
    beam = model.add_beam("ring", path=path, closed=True, elements=elements, section=section)
    for x in beam.node_x[:-1] if flat else ():
        model.hold(beam.at(float(x)), position="z", slope="z")
    return model


def exact(waves, radius):
    """Angular frequency of a ring that bends without stretch, in waves around it."""
    n = np.asarray(waves)
    return np.sqrt(n**2 * (n**2 - 1) ** 2 / (n**2 + 1)) / radius**2


@pytest.mark.parametrize("radius", [0.5, 2.0])
@pytest.mark.parametrize(("elements", "stiff"), [(8, 1e5), (8, 1e6), (12, 1e6), (16, 1e6), (16, 1e7)])
def test_by_how_much_frequencies_are_too_high_is_said(elements, stiff, radius):
    modes = ancf.modes(ring(elements, stiff, radius), count=7)
    found = modes.frequencies[modes.frequencies > 1e-3 * modes.frequencies[-1]][:4]
    waves = [2, 2, 3, 3]
    (note,) = [note for note in modes.notes if "too high" in note]
    said = float(re.search(r"up to ([\d.]+(?:e[+-]\d+)?) %", note)[1]) / 100
    assert note.startswith('"ring" may bend too little')
    wrong = np.max((found - exact(waves, radius)) / found)
    assert said == pytest.approx(wrong, rel=0.15)  # of cubics that are long for their arc as well


@pytest.mark.parametrize("build", [lambda: ring(48, 1e4), lambda: ring(64, 1e6)])
def test_what_bends_freely_has_no_note(build):
    model = build()
    modes = ancf.modes(model, count=7)
    found = modes.frequencies[modes.frequencies > 1e-2][:4]
    assert found == pytest.approx(exact([2, 2, 3, 3], 1.0), rel=3e-3)
    assert not any("too high" in note for note in modes.notes)


def test_taut_lines_do_not_lock():
    model = ancf.Model()
    section = ancf.Section(EA=1e7, EI=1.0, rhoA=1.0)
    line = model.add_beam("line", start=(0, 0, 0), end=(60, 0, 0), length=59.9, elements=20, section=section)
    model.pin(line.start)
    model.pin(line.end)
    assert ancf.modes(model, about=ancf.equilibrium(model), count=6).notes == []


@pytest.mark.parametrize("elements", [4, 8])
@pytest.mark.parametrize("length", [0.98, 0.995])
def test_prestressed_lines_do_not_lock(elements, length):
    """High modes of few elements, whose frequencies follow from the force along them."""
    section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e9, rho=1000.0)
    model = ancf.Model()
    line = model.add_beam(
        "line", start=(0, 0, 0), end=(1, 0, 0), length=length, elements=elements, section=section
    )
    model.pin(line.start)
    model.pin(line.end)
    assert ancf.modes(model, count=7).notes == []


def test_more_neutral_motions_than_modes():
    """A ring whose bend turns freely everywhere: the iteration for few modes does not end."""
    modes = ancf.modes(ring(64, 1e6, flat=False), count=12)
    assert modes.frequencies == pytest.approx(0.0, abs=1e-2)


@pytest.mark.parametrize("nodes", [(0.0, 1.0, 2.0), (0.0, 0.3, 2.0), (0.0, 1.6, 1.9, 2.0)])
@pytest.mark.parametrize("bending", [0.02, 5.0, 0.0])
def test_the_longest_element_decides(nodes, bending):
    """EA L^2/EI of each cable's longest element, of the cable with the largest; one without EI locks not."""
    model = ancf.Model()
    given = {"start": (0, 0, 0), "end": (2, 0, 0), "nodes": nodes}
    model.add_beam("one", section=ancf.Section(EA=3e4, EI=bending, rhoA=1.0), **given)
    model.add_beam(
        "two", start=(0, 1, 0), end=(3, 1, 0), elements=6, section=ancf.Section(EA=4e4, EI=0.1, rhoA=1)
    )
    model.add_beam(
        "bar",
        start=(0, 2, 0),
        end=(9, 2, 0),
        elements=1,
        section=ancf.Section.rectangle(0.01, 0.01, E=1e11, rho=1.0),
        element="nonlocking",
    )
    ratios = {"one": 3e4 * max(np.diff(nodes)) ** 2 / bending if bending else 0.0, "two": 4e4 * 0.25 / 0.1}
    name = max(ratios, key=ratios.__getitem__)
    ratio, found = stiffest(SimpleNamespace(model=model))
    assert (found, ratio) == (name, pytest.approx(ratios[name], rel=1e-12))
