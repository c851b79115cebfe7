"""A ring that is pulled apart: in its plane it follows the closed form, a cable's bend that turns is told."""

from typing import NamedTuple

import numpy as np
import pytest

import ancf
from ancf.elements.slopes import vectors_of
from ancf.results.turned_bends import _bends as bends_of

R, EA, EI = 0.5, 1e6, 100.0
#: Growth of the pulled diameter, and decrease of the other one, over P R^3/EI of a thin ring.
ALONG, ACROSS = np.pi / 4 - 2 / np.pi, 2 / np.pi - 0.5
SAID = "nothing resists that this bend turns: it did"


def ring(elements, axes, held, pull, **given):
    """A ring in the plane of two axes, held at one side and pulled at the other."""
    angle = np.linspace(0.0, 2 * np.pi, 121)
    path = np.zeros((len(angle), 3))
    first, second = ("xyz".index(a) for a in axes)
    path[:, first], path[:, second] = R * np.cos(angle), R * np.sin(angle)
    normal = next(a for a in "xyz" if a not in axes)
    model = ancf.Model()
    section = ancf.Section(EA=EA, EI=EI, rhoA=1.0)
    beam = model.add_beam("ring", path=path, closed=True, elements=elements, section=section, **given)
    slope = {"slope": normal} if held else {}
    half = elements // 2
    model.hold(beam.at(0), position="xyz", **slope)
    model.hold(beam.at(beam.length / 2), position=axes[1] + normal, **slope)
    others = [k for k in range(1, elements) if k != half] if held else [elements // 4]
    for k in others:
        model.hold(beam.at(beam.length * k / elements), position=normal, **slope)
    force = np.zeros(3)
    force[first] = -pull
    model.add_force(beam.at(beam.length / 2), force)
    state = ancf.equilibrium(model)
    along = -state.position(beam.at(beam.length / 2))[first] - R
    across = 2 * (R - state.position(beam.at(beam.length / 4))[second])
    unit = pull * R**3 / EI
    return along / (ALONG * unit), across / (ACROSS * unit), [n for n in state.notes if SAID in n]


@pytest.mark.parametrize("axes", ["xz", "xy", "yz"])
@pytest.mark.parametrize("pull", [0.05, 5.0, -5.0])
@pytest.mark.parametrize(("elements", "close"), [(16, 0.015), (32, 5e-3)])
def test_in_its_plane(axes, pull, elements, close):
    along, across, said = ring(elements, axes, True, pull)
    assert along == pytest.approx(1.0, abs=close)
    assert across == pytest.approx(1.0, abs=close)
    assert not said


@pytest.mark.parametrize("axes", ["xz", "xy", "yz"])
@pytest.mark.parametrize("pull", [0.05, 5.0, -5.0])
@pytest.mark.parametrize("elements", [8, 16, 32])
def test_free_to_turn(axes, pull, elements):
    """It gives way by far more than a ring that resists torsion, and says so."""
    along, _, said = ring(elements, axes, False, pull)
    assert along > 1.3
    assert len(said) == 1
    assert '"ring" is bent by nature' in said[0]


@pytest.mark.parametrize("axes", ["xz", "yz"])
@pytest.mark.parametrize("pull", [0.05, 5.0])
def test_a_ring_that_was_straight_has_no_bend_that_turns(axes, pull):
    assert not ring(16, axes, True, pull, natural_shape="straight")[2]


@pytest.mark.parametrize("slack", [1.05, 1.3])
@pytest.mark.parametrize("elements", [10, 20])
def test_what_tension_shapes_is_not_told(slack, elements):
    """A rope that is drawn as an arc hangs as its weight wants, whatever its bend does."""
    x = np.linspace(-1.0, 1.0, 41)
    path = np.stack([2 * x, 0.05 * x**2, slack * x**2], axis=1)
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e5, EI=1e-3, rhoA=1.0)
    rope = model.add_beam("rope", path=path, elements=elements, section=section)
    model.pin(rope.start)
    model.pin(rope.end)
    assert not [note for note in ancf.equilibrium(model).notes if SAID in note]


@pytest.mark.parametrize("held", [False, True])
@pytest.mark.parametrize("kick", [0.0, 0.02])
def test_in_motion(held, kick):
    """A quarter of a ring that swings: free, a small kick turns its bend; in its plane nothing does."""
    angle = np.linspace(0.0, np.pi / 2, 41)
    model = ancf.Model()
    section = ancf.Section(EA=EA, EI=EI, rhoA=1.0, damping=5.0)
    path = np.stack([R * np.cos(angle), 0 * angle, R * np.sin(angle)], axis=1)
    arc = model.add_beam("arc", path=path, elements=8, section=section)
    model.clamp(arc.start)
    for k in range(1, 9) if held else ():
        model.hold(arc.at(arc.length * k / 8), position="y", slope="y")
    model.add_force(arc.end, (-20.0, 0.0 if held else kick, 0.0))
    notes = ancf.simulate(model, t_end=0.1, step=2e-4).notes
    assert bool([note for note in notes if SAID in note]) == (kick > 0.0 and not held)


def hermite_line(points, tangents, places):
    """A cable's tangents between nodes (n, 3) with slopes (n, 3) at these places."""
    slots = 3 * np.arange(2 * len(places)).reshape(-1, 2)
    return vectors_of(places, slots, np.hstack([points, tangents]).reshape(1, -1))


class Straight(NamedTuple):
    """What the angles of a curve are counted along."""

    node_x: np.ndarray


@pytest.mark.parametrize("stretch", [0.8, 1.0, 1.3])
@pytest.mark.parametrize(("radius", "pitch"), [(0.5, 0.0), (2.0, 0.7), (0.1, -0.03)])
def test_bends_of_helices(stretch, radius, pitch):
    """Of curvature k and torsion t over the way s: k times the stretch, turned by t s about the cable."""
    count, turns = 120, 1.5
    size = np.hypot(radius, pitch)
    angle = 2 * np.pi * turns * np.linspace(0.0, 1.0, count + 1)
    points = np.stack([radius * np.cos(angle), radius * np.sin(angle), pitch * angle], axis=1)
    tangents = np.stack([-radius * np.sin(angle), radius * np.cos(angle), pitch + 0 * angle], axis=1) / size
    natural = size * angle / stretch
    bend, turned = bends_of(Straight(natural), hermite_line(points, stretch * tangents, natural))
    assert bend == pytest.approx(np.full(3 * count, radius / size**2 * stretch), rel=2e-3)
    way = np.repeat(size * angle[:-1], 3) + np.tile([0.0, 0.5, 1.0], count) * size * angle[1]
    told = np.unwrap(turned) - turned[0]
    assert told == pytest.approx(pitch / size**2 * way, abs=2e-2)


@pytest.mark.parametrize("size", [0.02, 1.0, 30.0])
@pytest.mark.parametrize(("pull", "count"), [(0.5, 1), (200.0, 0)])
def test_whatever_the_size(size, pull, count):
    """Lengths count in radii and forces in EI/R^2: a note in one size is a note in all."""
    angle = np.linspace(0.0, np.pi / 2, 41)
    model = ancf.Model()
    section = ancf.Section(EA=1e6 * EI / size**2, EI=EI, rhoA=1.0)
    path = size * np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    arc = model.add_beam("arc", path=path, elements=8, section=section)
    model.clamp(arc.start)
    model.add_force(arc.end, (0.0, pull * EI / size**2, 0.0))
    assert len([n for n in ancf.equilibrium(model, load_steps=20).notes if SAID in n]) == count
