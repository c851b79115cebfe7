"""A tool on a cable turns freely about it, and modes say so; on a beam or a torsion spring it does not."""

import numpy as np
import pytest

import ancf

DIRECTIONS = {"down": (0, 0, -1.0), "slanted": (0.6, 0.48, -0.64)}


def hung(direction, join, element="cable", **spring):
    """A tool on the end of a rope along the direction of gravity, clamped or welded to it."""
    axis = np.array(direction)
    model = ancf.Model(gravity=9.81 * axis)
    section = ancf.Section.circle(diameter=0.01, E=1e8, rho=1200.0, nu=0.3)
    rope = model.add_beam(
        "rope", start=(0, 0, 0), end=2.0 * axis, elements=6, section=section, element=element
    )
    model.clamp(rope.start)
    place = 2.1 * axis
    tool = model.add_rigid_body("tool", at=place, mass=2.0, inertia=(0.01, 0.012, 0.02))
    if join == "clamp":
        model.clamp(rope.end, to=tool)
    else:
        model.weld(rope.end, tool.at(*(-0.1 * axis)))
    if spring:
        model.add_torsion_spring(tool, place, axis=axis, **spring)
    return model


@pytest.mark.parametrize("direction", DIRECTIONS.values(), ids=DIRECTIONS)
@pytest.mark.parametrize("join", ["clamp", "weld"])
class TestTool:
    def test_on_a_cable(self, direction, join):
        model = hung(direction, join)
        modes = ancf.modes(model, about=ancf.equilibrium(model), count=6)
        (note,) = modes.notes
        assert note.startswith('"tool" turns freely about "rope", a cable, which has no torsion')
        assert modes.frequencies[0] < 1e-4 * modes.frequencies[1]

    def test_on_a_beam(self, direction, join):
        """Its torsion gives it the frequency sqrt(G J/(L I)), with the inertia about the axis."""
        model = hung(direction, join, element="nonlocking")
        modes = ancf.modes(model, about=ancf.equilibrium(model), count=8)
        assert not any("turns freely" in note for note in modes.notes)
        axis = np.array(direction)
        about = axis @ np.diag((0.01, 0.012, 0.02)) @ axis
        section = model.bodies["rope"].section
        wanted = np.sqrt(section.G * section.J / (2.0 * about))
        assert np.min(np.abs(modes.frequencies / wanted - 1.0)) < 0.03

    def test_on_a_torsion_spring(self, direction, join):
        model = hung(direction, join, stiffness=0.5)
        modes = ancf.modes(model, about=ancf.equilibrium(model), count=6)
        assert not any("turns freely" in note for note in modes.notes)


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.1, 2.0, 2.9])
@pytest.mark.parametrize("elements", [2, 5, 8])
def test_what_turns_freely_has_no_frequency_at_all(elements, angle):
    """Round-off of a neutral motion is of either sign: it is next to nothing, and the rest has its digits."""
    found = []
    for turned in (0.0, angle):
        model = ancf.Model()
        section = ancf.Section(EA=6.3e6, EI=4.7, rhoA=0.243)
        rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
        model.clamp(rope.start, rotation=turned, axis=(0.6, 0.0, 0.8))
        tool = model.add_rigid_body("tool", at=(1, 0, 0), mass=1.0, inertia=(0.01, 0.02, 0.03))
        model.clamp(rope.end, to=tool)
        found.append(ancf.modes(model, about=ancf.equilibrium(model), count=5).frequencies)
    for frequencies in found:
        assert frequencies[0] < 1e-6 * frequencies[1]
    assert found[0][1:] == pytest.approx(found[1][1:], rel=1e-6)


@pytest.mark.parametrize("stiffness", [1e-6, 1e-4, 1.0])
def test_a_soft_torsion_spring_has_one(stiffness):
    """sqrt(k/J), rad/s, of a bar that is rigid beside the spring at its end, however soft that is."""
    model = ancf.Model()
    section = ancf.Section.rectangle(width=0.02, height=0.02, E=7e10, rho=2700.0, nu=0.3)
    given = {"section": section, "elements": 2, "element": "nonlocking"}
    bar = model.add_beam("bar", start=(0, 0, 0), end=(1, 0, 0), **given)
    model.hold(bar.start, position="xyz")
    model.hold(bar.end, position="yz")
    model.add_torsion_spring(bar.start, (0, 0, 0), axis=(1, 0, 0), stiffness=stiffness)
    inertia = 2700.0 * (section.I_y + section.I_z)
    found = ancf.modes(model, count=1).frequencies[0]
    assert found == pytest.approx(np.sqrt(stiffness / inertia), rel=1e-2)
