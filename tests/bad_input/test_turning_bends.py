"""Cables that are bent by nature resist no turning of the bend: equilibria and modes say so."""

import numpy as np
import pytest

import ancf
from ancf.errors import SolveError


def arch(elements, angle=np.pi / 2, element="cable", natural="path", EA=1e6):
    """A clamped arc of a circle in the xz plane."""
    a = np.linspace(0.0, angle, 41)
    path = np.column_stack([np.sin(a), 0.0 * a, 1.0 - np.cos(a)]).tolist()
    model = ancf.Model()
    section = ancf.Section(EA=EA, EI=100.0, rhoA=1.0)
    if element != "cable":
        section = ancf.Section.circle(diameter=0.02, E=1e10, rho=2000.0)
    given = {"elements": elements, "section": section, "element": element, "natural_shape": natural}
    beam = model.add_beam("hook", path=path, **given)
    model.clamp(beam.start)
    return model, beam


@pytest.mark.parametrize(("elements", "EA"), [(12, 1e4), (12, 1e6), (12, 1e7)])
def test_an_equilibrium_that_is_not_found(elements, EA):
    said = r'"hook" is bent by nature.*hold its plane at each node \(position and slope\)'
    with pytest.raises(SolveError, match=said):
        ancf.equilibrium(arch(elements, EA=EA)[0])


@pytest.mark.parametrize("elements", [6, 12])
def test_with_its_plane_held(elements):
    model, beam = arch(elements)
    for x in beam.node_x[1:]:
        model.hold(beam.at(float(x)), position="y", slope="y")
    model.add_force(beam.end, (0.0, 0.0, -1e-3))
    state = ancf.equilibrium(model)
    assert np.all(np.isfinite(state.position(beam.end)))
    assert not any("bent by nature" in note for note in ancf.modes(model, about=state, count=3).notes)


@pytest.mark.parametrize("how", ["free", "held", "nonlocking"])
def test_ring_without_loads(how):
    """From an arc of half its bend: what the message asks for gives the ring, and nothing less does."""

    def full(u):
        return 0.5 * np.sin(2 * np.pi * u), 0.0, 0.5 * (1 - np.cos(2 * np.pi * u))

    def half(u):
        return np.sin(np.pi * u), 0.0, 1 - np.cos(np.pi * u)

    model = ancf.Model()
    section = ancf.Section.circle(diameter=0.02, E=1e9, rho=2000.0)
    kind = {"element": "nonlocking"} if how == "nonlocking" else {}
    given = {"elements": 12, "section": section, "natural_shape": full, **kind}
    ring = model.add_beam("ring", path=half, length=np.pi, **given)
    model.clamp(ring.start)
    if how == "free":
        with pytest.raises(SolveError, match='"ring" is bent by nature'):
            ancf.equilibrium(model)
        return
    for x in ring.node_x[1:] if how == "held" else ():
        model.hold(ring.at(float(x)), position="y", slope="y")
    state = ancf.equilibrium(model)
    assert state.position(ring.end) == pytest.approx(state.position(ring.start), abs=1e-6)
    assert abs(state.energy.strain) < 1e-9


@pytest.mark.parametrize("angle", [np.pi / 3, np.pi / 2, np.pi])
def test_modes(angle):
    model, _ = arch(12, angle)
    found = ancf.modes(model, count=4)
    assert found.frequencies[0] == 0.0
    assert any('"hook" is bent by nature' in note for note in found.notes)
    other, _ = arch(12, angle, element="nonlocking")
    assert ancf.modes(other, count=2).frequencies[0] > 1.0
    assert not ancf.modes(other, count=2).notes


def test_straight_ones_have_no_bend():
    model = ancf.Model()
    section = ancf.Section(EA=1e6, EI=100.0, rhoA=1.0)
    beam = model.add_beam(
        "beam", path=[(0, 0, 0), (1, 0, 0), (2, 0, 0)], natural_shape="path", elements=4, section=section
    )
    assert not beam.turns_its_bend
    assert not ancf.modes(model, count=5).notes
