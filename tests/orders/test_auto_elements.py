"""``elements="auto"``: the error that it promises, and that it does not take many elements too many."""

from __future__ import annotations

import numpy as np
import pytest

import ancf
from ancf.model.file import parse_study

#: Natural length, horizontal and vertical distance of the ends, EA over the weight of the whole.
CABLES = {
    "taut": (10.0, 10.02, 0.0, 1e3),
    "conductor": (300.6, 300.0, 12.0, 6e3),
    "mooring": (120.0, 90.0, 40.0, 1e5),
    "slack": (10.0, 6.0, 0.0, 1e3),
    "slack steel": (10.0, 6.0, 0.0, 1e6),
    "loop": (10.0, 3.0, 2.0, 1e4),
    "steep": (50.0, 10.0, -45.0, 1e4),
}


def hanging(name, elements):
    length, across, up, ratio = CABLES[name]
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=ratio * length * 9.81 * 0.7, EI=1e-5, rhoA=0.7)
    cable = model.add_beam(
        "cable",
        start=(1, 2, 3),
        end=(1, 2 + across, 3 + up),
        length=length,
        elements=elements,
        section=section,
    )
    model.pin(cable.start)
    model.pin(cable.end)
    return model, cable


def shape(name, elements):
    model, cable = hanging(name, elements)
    state = ancf.equilibrium(model)
    return cable.elements, np.array([state.position(cable.at(x)) for x in np.linspace(0, cable.length, 49)])


@pytest.mark.parametrize("name", CABLES)
def test_keeps_the_error_that_it_promises(name):
    """1e-4 of the length, against four times as many elements."""
    count, mine = shape(name, "auto")
    _, fine = shape(name, 4 * count)
    error = np.linalg.norm(mine - fine, axis=1).max() / CABLES[name][0]
    assert error < 1e-4
    if count > 8:  # it is no tenfold effort: a third of the elements misses the bar
        _, coarse = shape(name, count // 3)
        assert np.linalg.norm(coarse - fine, axis=1).max() / CABLES[name][0] > 1e-4


@pytest.mark.parametrize("radius", [0.3, 4.0])
@pytest.mark.parametrize("element", ["cable", "nonlocking"])
def test_follows_a_path(radius, element):
    """A helix: the nodes' cubics are within 1e-4 of its length of it."""
    model = ancf.Model()

    def helix(u):
        angle = 6 * np.pi * u
        return radius * np.cos(angle), radius * np.sin(angle), 0.2 * radius * angle

    section = ancf.Section.circle(diameter=0.01 * radius, E=1e9, rho=1e3)
    beam = model.add_beam("beam", path=helix, elements="auto", section=section, element=element)
    x = np.linspace(0, beam.length, 2001)
    places = np.array([beam.initial_position(s) for s in x])
    right = np.stack(helix(x / beam.length), axis=1)
    error = np.linalg.norm(places - right, axis=1).max() / beam.length
    assert 1e-7 < error < 1e-4


def test_in_a_file():
    section = {"EA": 1e5, "EI": 0.01, "rhoA": 1.0}
    cable = {
        "name": "cable",
        "section": section,
        "start": [0, 0, 0],
        "end": [8, 0, 0],
        "length": 10,
        "elements": "auto",
    }
    beam = parse_study({"gravity": [0, 0, -9.81], "bodies": [cable]}).model.beams["cable"]
    assert 8 < beam.elements < 100


@pytest.mark.parametrize(
    ("change", "what"),
    [
        ({"gravity": (0, 0, 0)}, "is straight and has no weight"),
        ({"end": (0.0, 0, -9)}, "hangs as a fold"),
        ({"element": "original"}, 'not known for element "original"'),
        ({"elements": "many"}, "elements"),
        ({"length": -1.0}, "length"),
        ({"end": (0, 0, 0)}, "coincides with start"),
    ],
)
def test_what_it_does_not_know(change, what):
    given = {"start": (0, 0, 0), "end": (8, 0, 0), "length": 10.0, "elements": "auto"} | change
    model = ancf.Model(gravity=given.pop("gravity", (0, 0, -9.81)))
    section = ancf.Section.circle(diameter=0.01, E=1e9, rho=1e3)
    with pytest.raises(ancf.ModelError, match=what):
        model.add_beam("cable", section=section, **given)
