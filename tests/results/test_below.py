"""What grounds do not carry, and cables that are pressed at rest, is said."""

import numpy as np
import pytest

import ancf
from ancf.results.tension import Compression

CABLE = ancf.Section(EA=1e6, EI=0.1, rhoA=0.1, diameter=0.02)
TILTED = {"height": -2.0, "normal": (0.3, 0.0, 1.0)}
TABLE = {"height": {"x": [-5.0, 5.0], "y": [-5.0, 5.0], "z": [[-2.0, -2.0], [-1.0, -1.0]]}}


def model(kind, ground, at):
    """A body on a rope in the depth ``at`` above a ground, or below it."""
    made = ancf.Model(gravity=(0, 0, -9.81))
    rope = made.add_beam("rope", start=(0, 0, at), end=(0, 0, 0), elements=2, section=CABLE)
    made.pin(rope.end)
    if kind == "mass":
        body = made.add_point_mass("load", at=(0, 0, at), mass=20.0)
    else:
        body = made.add_rigid_body("load", at=(0, 0, at), mass=20.0, inertia=(1, 1, 1))
    made.connect(rope.start, body)
    made.add_ground("bed", stiffness=1e5, damping=1e3, **ground)
    return made


@pytest.mark.parametrize("kind", ["mass", "body"])
@pytest.mark.parametrize("ground", [{"height": -2.0}, TILTED, TABLE], ids=["plane", "tilted", "table"])
@pytest.mark.parametrize("at", [-1.2, -2.4])
def test_bodies_below_a_ground(kind, ground, at):
    made = model(kind, ground, at)
    deep = made.grounds[0].depth(np.array([0.0, 0.0, at]))
    result = ancf.simulate(made, t_end=0.02, step=1e-3)
    states = ([result] if kind == "body" else [ancf.equilibrium(made), result]) if deep < 0 else [result]
    for known in states:
        said = [text for text in known.notes if "below the ground" in text]
        assert len(said) == (1 if deep > 0 else 0)
        if said:
            assert said[0].startswith('"load" is ')
            assert float(said[0].split()[2]) == pytest.approx(deep, rel=0.01)
            assert "add_surface" in said[0]


@pytest.mark.parametrize("count", [20, 1300])
def test_when_a_body_was_deepest(count):
    """Thrown down against a steady force; of long histories not every state is looked at."""
    made = ancf.Model()
    body = made.add_point_mass("load", at=(0, 0, 1.0), mass=1.0)
    body.set_motion(velocity=(0, 0, -4.0))
    made.add_force(body, (0, 0, 4.0))
    made.add_ground("bed", height=0.0, stiffness=1e5)
    result = ancf.simulate(made, t_end=2.0, step=2.0 / count)
    [said] = [text for text in result.notes if "below the ground" in text]
    assert float(said.split("t = ")[1].split()[0]) == pytest.approx(1.0, abs=0.01)
    assert float(said.split()[2]) == pytest.approx(1.0, rel=0.01)


@pytest.mark.parametrize("size", [0.05, 1.0, 300.0])
@pytest.mark.parametrize(("depth", "count"), [(5e-5, 0), (8e-4, 1)])
def test_depths_are_in_sizes_of_the_model(size, depth, count):
    made = ancf.Model()
    rod = made.add_beam("rod", start=(0, 0, size), end=(size, 0, size), elements=1, section=CABLE)
    made.clamp(rod.start)
    load = made.add_point_mass("load", at=(0, 0, -depth * made.size), mass=1.0)
    made.pin(load)
    made.add_ground("bed", height=0.0, stiffness=1e5)
    found = [text for text in ancf.equilibrium(made).notes if "below the ground" in text]
    assert len(found) == count


def test_a_rope_that_is_pressed_at_rest():
    found = []
    for shift in (0.0, -5e-6):
        made = ancf.Model()
        section = ancf.Section(EA=1e5, EI=1e-3, rhoA=0.1)
        rope = made.add_beam("rope", start=(0, 0, 0), end=(0, 0, 1.2), elements=4, section=section)
        made.clamp(rope.start)
        made.clamp(rope.end, displacement=(0, 0, shift))
        found.append([text for text in ancf.equilibrium(made).notes if "is pressed" in text])
    assert found[0] == []
    assert len(found[1]) == 1
    assert "would buckle" in found[1][0]


@pytest.mark.parametrize(("wave", "words"), [(0.0, "it is slack there"), (0.2, "would buckle, which")])
def test_what_a_pressed_cable_can_bear(wave, words):
    assert words in str(Compression("rope", "rope.at(0.5)", 0.5, 1.0, -3.0, 10.0, wave, 0.3))
