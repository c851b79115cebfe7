"""Surfaces and contacts with them: what is given, files, messages."""

import json
import math
import re

import numpy as np
import pytest

import ancf
from ancf.model.file import parse_study, schema
from ancf.model.surfaces.shapes import SHAPES
from ancf.system.system import System

SHAPE_OF = {
    "plane": {"at": [0.1, 0.2, -3.0], "normal": [0.0, 3.0, 4.0]},
    "cylinder": {"radius": 0.2, "at": [0, 0, -2.0], "axis": [0, 2.0, 0], "length": 0.5},
    "sphere": {"radius": 0.3, "at": [0, 0, -2.0]},
    "capsule": {"radius": 0.1, "length": 0.4, "at": [0, 0, -2.0]},
    "torus": {"radius": 0.5, "tube": 0.1, "at": [0, 0, -2.0], "axis": [0, 1.0, 0]},
    "sheave": {"radius": 0.2, "groove": 0.02, "depth": 0.05, "at": [0, 0, -2.0], "angle": 0.9},
    "mesh": {
        "points": [[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0], [0, 0, 0.1]],
        "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
        "at": [0, 0, -2.0],
    },
}


ROPE = ancf.Section(EA=1e4, EI=0.01, rhoA=0.5, diameter=0.02)


def roped(diameter=0.02):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.5, **({"diameter": diameter} if diameter else {}))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=section)
    hub = model.add_rigid_body("hub", at=(0, 0, -1), mass=1.0, inertia=(1, 1, 1))
    return model, rope, hub


class TestGiven:
    @pytest.mark.parametrize("word", SHAPES)
    @pytest.mark.parametrize("on", [None, "hub"])
    def test_as_object_by_word_and_in_a_file(self, word, on):
        given = SHAPE_OF[word]
        models = []
        for number in range(2):
            model, _, _ = roped()
            shape = (SHAPES[word](**given),) if number else (word,)
            model.add_surface("thing", *shape, on=on, **({} if number else given))
            models.append(model)
        bodies = models[0].to_dict()["bodies"]
        file = {
            "gravity": [0, 0, -9.81],
            "bodies": [
                {"name": "rope", "start": [0, 0, 0], "end": [2, 0, 0], "elements": 4, "section": "s"},
                {"type": "rigid_body", "name": "hub", "at": [0, 0, -1], "mass": 1.0, "inertia": [1, 1, 1]},
            ],
            "sections": {"s": {"EA": 1e4, "EI": 0.01, "rhoA": 0.5, "diameter": 0.02}},
            "surfaces": [{"name": "thing", "shape": word, **({"on": on} if on else {}), **given}],
        }
        models.append(parse_study(file).model)
        plain = [json.loads(json.dumps(model.to_dict())) for model in models]
        assert plain[0] == plain[1] == plain[2]
        assert plain[0]["bodies"] == json.loads(json.dumps(bodies))
        assert ancf.Model.from_dict(plain[0]).to_dict() == plain[0]
        assert plain[0]["surfaces"][0]["shape"] == word
        direction = given.get("normal", given.get("axis", [0, 0, 1]))
        found = models[0].surfaces[0].shape.direction
        assert found == pytest.approx(np.array(direction) / np.linalg.norm(direction))
        assert re.search(
            rf"thing +\(.*\) m on {'the ground' if on is None else 'hub'} +{word}", str(models[0])
        )

    def test_has_a_schema(self):
        definitions = schema()["$defs"]
        for shape in SHAPES.values():
            assert f"{shape.__name__}Entry" in definitions
        assert definitions["SheaveEntry"]["required"] == ["name", "shape", "radius", "groove", "depth"]

    def test_contact_by_names_and_objects(self):
        found = []
        for named in (False, True):
            model, rope, hub = roped()
            drum = model.add_surface("drum", "cylinder", radius=0.3, on=hub)
            ends = ("rope", "drum") if named else (rope, drum)
            item = model.add_contact(*ends, stiffness=1e5, damping=2.0, friction=0.1, stick=3e4, radius=0.015)
            assert (item.radius, item.stick, item.surface.on) == (0.015, 3e4, hub)
            found.append(model.to_dict())
        assert found[0] == found[1]
        assert found[0]["connections"][0] == {
            "type": "surface_contact",
            "name": "contact of rope and drum",
            "body": "rope",
            "surface": "drum",
            "stiffness": 1e5,
            "damping": 2.0,
            "friction": 0.1,
            "stick": 3e4,
            "radius": 0.015,
        }

    def test_contact_with_a_strip_is_as_it_was(self):
        model, rope, _ = roped()
        head = model.add_point_mass("head", at=(1, 0, -0.1), mass=1.0)
        item = model.add_contact(head, rope, stiffness=1e4)
        assert (item.strip.tolist(), item.normal.tolist()) == ([0, 1, 0], [0, 0, 1])


def refused(match, work):
    with pytest.raises(ancf.ModelError, match=match):
        work()


class TestRefused:
    """One message with a place for each thing that is wrong."""

    @pytest.mark.parametrize(
        ("match", "shape", "numbers"),
        [
            (r'add_surface\("drum"\).radius: must be > 0, is 0', "cylinder", {"radius": 0}),
            (r'\("drum"\).radius: a cylinder needs it', "cylinder", {}),
            (
                r'\("drum"\).raduis: a cylinder has none \(did you mean "?radius',
                "cylinder",
                {"raduis": 1.0, "radius": 1},
            ),
            (r'\("drum"\).shape: .*"?cilinder', "cilinder", {}),
            (
                r'\("drum"\).tube: is 0.5 m, must be less than the radius',
                "torus",
                {"radius": 0.2, "tube": 0.5},
            ),
            (r'\("drum"\).axis', "cylinder", {"radius": 1.0, "axis": (0, 0, 0)}),
            (
                r'\("drum"\).depth: .* round bottom',
                "sheave",
                {"radius": 1.0, "groove": 0.1, "depth": 0.01},
            ),
            (r'\("drum"\).angle', "sheave", {"radius": 1.0, "groove": 0.1, "depth": 0.2, "angle": 3.2}),
            (r'\("drum"\).shape: must be a shape', 3.0, {}),
        ],
    )
    def test_shapes(self, match, shape, numbers):
        model, *_ = roped()
        refused(match, lambda: model.add_surface("drum", shape, **numbers))
        assert model.surfaces == []

    def test_shapes_of_their_own(self):
        refused("Cylinder.radius: must be > 0", lambda: ancf.Cylinder(radius=-1.0))
        refused("Sphere.at", lambda: ancf.Sphere(1.0, at=(0, 0)))

    def test_surfaces(self):
        model, rope, _ = roped()
        ball = ancf.Sphere(0.1, at=(0, 0, -5))
        refused("must be a rigid body", lambda: model.add_surface("ball", ball, on=rope))
        refused("have no effect", lambda: model.add_surface("ball", ball, radius=0.2))
        model.add_surface("ball", ball)
        refused('"ball" is the name of a surface already', lambda: model.add_surface("ball", ball))
        refused("hubb", lambda: model.add_surface("other", ball, on="hubb"))

    def test_contacts(self):
        model, *_ = roped()
        model.add_surface("ball", ancf.Sphere(0.1, at=(0, 0, -5)))
        model.add_surface("groove", ancf.Sheave(0.1, 0.009, 0.05, at=(0, 0, -5)))

        def add(*ends, **given):
            return lambda: model.add_contact(*(ends or ("rope", "ball")), **({"stiffness": 1e5} | given))

        refused("stiffness: must be > 0", add(stiffness=0.0))
        refused("friction: must be >= 0, is -0.1", add(friction=-0.1))
        refused("damping: must be >= 0", add(damping=-1.0))
        refused("radius: must be > 0", add(radius=0.0))
        refused("stick: must be > 0", add(stick=0.0))
        refused("must be a cable or a beam", add("hub", "ball"))
        refused("give the groove a larger radius", add("rope", "groove"))
        refused("strip: has no effect on a contact with a surface", add(strip=(0, 1, 0)))
        refused("friction: has no effect on a contact with a strip", add("hub", "rope", friction=0.1))
        refused("bal", lambda: model.add_surface_contact("rope", "bal", stiffness=1e5))
        model.add_contact("rope", "ball", stiffness=1e5)
        refused('is between "rope" and "ball" already', add())
        bare, *_ = roped(diameter=None)
        bare.add_surface("ball", ancf.Sphere(0.1, at=(0, 0, -5)))
        refused("has no diameter", lambda: bare.add_contact("rope", "ball", stiffness=1e5))

    @pytest.mark.parametrize("gap", [-0.004, -0.006, -0.1])
    def test_a_surface_inside_a_rope(self, gap):
        """By more than half of the radius: how deep, where, and what to do."""
        model, rope, _ = roped()
        model.add_surface("ball", ancf.Sphere(0.3, at=(1.25, 0.0, -0.31 - gap)))
        model.add_contact(rope, "ball", stiffness=1e5)
        if gap > -0.005:
            System(model)
        else:
            match = r'"ball" is 0\.\d+ m inside "rope" at about x = 1\.25 m .*0.01 m'
            refused(match, lambda: System(model))

    @pytest.mark.parametrize("power", [1.0, 2.0, 3.0])
    @pytest.mark.parametrize("place", [0.3, 0.7, 2.2])
    def test_where_it_is_on_an_uneven_mesh(self, power, place):
        model, nodes = ancf.Model(), 2.5 * np.linspace(0.0, 1.0, 26) ** power
        rope = model.add_beam("rope", start=(0, 0, 0), end=(2.5, 0, 0), nodes=nodes, section=ROPE)
        model.add_surface("ball", ancf.Sphere(0.3, at=(place, 0.0, -0.2)))
        model.add_contact(rope, "ball", stiffness=1e5)
        with pytest.raises(ancf.ModelError) as said:
            System(model)
        found = float(re.search(r"at about x = (\S+) m", str(said.value))[1])
        longest = np.diff(nodes)[np.searchsorted(nodes, place) - 1]
        assert found == pytest.approx(place, abs=0.5 * longest)
        assert "shorter ones" not in str(said.value)

    @pytest.mark.parametrize("wheel", [0.5, 2.0, 12.0])
    @pytest.mark.parametrize("start", ["left", "right"])
    def test_an_element_that_cuts_a_curve(self, wheel, start):
        """The nodes are where they should be: what helps is said."""
        sag = 0.3 * wheel if start == "left" else -0.3 * wheel
        ends = {"start": (-4 * wheel, 0, -sag), "end": (4 * wheel, 0, -sag)}
        centre = (0, 0, -wheel if start == "left" else wheel)
        over = ancf.Reeving([(centre, wheel + 0.01, start)], axis=(0, 1, 0), **ends)
        for elements, fits in ((5, False), (200, True)):
            model = ancf.Model()
            rope = model.add_beam("rope", path=over, elements=elements, section=ROPE)
            model.add_surface("wheel", ancf.Cylinder(radius=wheel, at=centre, axis=(0, 1, 0)))
            model.add_contact(rope, "wheel", stiffness=1e5)
            if fits:
                System(model)
            else:
                refused("element 2 between them is .* m long: give shorter ones", lambda m=model: System(m))

    def test_questions(self):
        model, rope, _ = roped()
        model.add_surface("ball", ancf.Sphere(0.3, at=(1.25, 0.0, -0.309)))
        contact = model.add_contact(rope, "ball", stiffness=1e5)
        state = ancf.State(System(model), 0.0, *System(model).initial_state())
        assert state.contact_gap(contact) == pytest.approx(-0.001)
        assert state.contact_force(contact) > 0.0
        assert state.friction_force(contact) == 0.0
        refused("many places", lambda: state.contact_offset(contact))
        refused("many places", lambda: state.arc_length(contact))
        refused(
            "is no contact with a surface here; there are: contact of rope and ball",
            lambda: state.contact_line("x"),
        )


class TestProportions:
    @pytest.mark.parametrize("angle", [0.3, 0.9, 2.0, 3.1])
    @pytest.mark.parametrize("groove", [0.02, 0.3])
    def test_a_groove_is_as_deep_as_its_round_bottom(self, groove, angle):
        """Which ends where the flanks touch it, at groove (1 - sin(angle/2)) over its lowest place."""
        least = groove * (1.0 - math.sin(angle / 2))
        assert ancf.Sheave(0.4, groove, 1.001 * least, angle).depth > least
        with pytest.raises(ancf.ModelError, match="round bottom"):
            ancf.Sheave(0.4, groove, 0.999 * least, angle)

    def test_flanks_that_do_not_open(self):
        with pytest.raises(ancf.ModelError, match="must be less than pi"):
            ancf.Sheave(0.4, 0.02, 0.1, math.pi)

    @pytest.mark.parametrize("share", [1.0, 1.01])
    def test_a_ring_has_a_hole(self, share):
        assert ancf.Torus(0.3, 0.299).tube == 0.299
        with pytest.raises(ancf.ModelError, match="must be less than the radius"):
            ancf.Torus(0.3, 0.3 * share)

    def test_narrowest(self):
        """What may be gone through unseen: of a ring its wire."""
        shapes = (ancf.Cylinder(0.2, length=0.1), ancf.Sphere(0.3), ancf.Capsule(0.1, 2.0))
        assert [shape.narrowest for shape in shapes] == [0.2, 0.3, 0.1]
        assert ancf.Torus(0.5, 0.04).narrowest == 0.04
        assert ancf.Sheave(0.25, 0.02, 0.1).narrowest == 0.25
