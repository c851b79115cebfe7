"""The model of point masses and rigid bodies: points, inertia, supports, loads, files, and what is wrong."""

import json
import math

import numpy as np
import pytest
from rich.console import Console

from ancf.cli.info_model import _bodies, _masses
from ancf.cli.summary import node_count, outputs, total_mass
from ancf.model import Model, PointMass, RigidBody
from ancf.model.file import parse_study, schema
from ancf.model.supports.support import node_of
from refusals import cable_section, refused

NAN = float("nan")
TURNED = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]


def mixed():
    model = Model(gravity=(0, 0, -9.81))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=cable_section())
    tip = model.add_point_mass("tip", at=(1, 0, 0), mass=2.0)
    hub = model.add_rigid_body("hub", at=(0, 0, 1), mass=3.0, inertia=(0.1, 0.2, 0.25), axes=TURNED)
    return model, rope, tip, hub


class TestPointMass:
    def test_made(self):
        model, _, tip, _ = mixed()
        assert isinstance(tip, PointMass)
        assert (tip.name, tip.mass) == ("tip", 2.0)
        np.testing.assert_array_equal(tip.position, [1, 0, 0])
        np.testing.assert_array_equal(tip.velocity, [0, 0, 0])
        tip.set_motion(velocity=(1, 2, 3))
        np.testing.assert_array_equal(tip.velocity, [1, 2, 3])
        assert model.body("tip") is tip
        assert repr(tip) == "PointMass('tip', mass=2)"

    def test_point(self):
        model, _, tip, _ = mixed()
        assert str(tip.point) == "tip"
        assert model.point("tip") == model.point(" tip ") == tip.point
        assert not tip.point.eccentric
        np.testing.assert_array_equal(tip.point.initial_position, [1, 0, 0])
        assert node_of(tip.point) == 0

    def test_owns_its_arrays(self):
        at = np.array([1.0, 2.0, 3.0])
        tip = Model().add_point_mass("tip", at=at, mass=1)
        at[0] = 9.0
        tip.point.initial_position[1] = 9.0
        np.testing.assert_array_equal(tip.position, [1, 2, 3])

    @pytest.mark.parametrize(
        ("change", "key", "phrase"),
        [
            ({"mass": 0}, "mass", "must be > 0"),
            ({"mass": -1.0}, "mass", "must be > 0"),
            ({"mass": NAN}, "mass", "finite"),
            ({"mass": "1 kg"}, "mass", "must be a number"),
            ({"at": (1, 2)}, "at", "has shape (2,), wanted (3,)"),
            ({"at": (1, 2, NAN)}, "at[2]", "finite"),
            ({"at": None}, "at", "must be a list of numbers"),
            ({"at": (1e200, 0, 0)}, "at", "must be within 1e+100 m"),
        ],
    )
    def test_bad(self, change, key, phrase):
        model = Model()
        given = {"at": (0, 0, 0), "mass": 1.0} | change
        refused(f'add_point_mass("tip").{key}', phrase, model.add_point_mass, "tip", **given)
        assert not model.bodies

    def test_bad_motion(self):
        _, _, tip, _ = mixed()
        refused('set_motion("tip").velocity', "wanted (3,)", tip.set_motion, (1, 2))

    def test_names_are_shared(self):
        model, *_ = mixed()
        where = 'add_point_mass("rope").name'
        refused(where, "is the name of a body already", model.add_point_mass, "rope", at=(0, 0, 0), mass=1)
        refused("add_point_mass().name", "must be text", model.add_point_mass, 3, at=(0, 0, 0), mass=1)


class TestRigidBody:
    def test_made(self):
        _, _, _, hub = mixed()
        assert isinstance(hub, RigidBody)
        np.testing.assert_array_equal(hub.inertia, np.diag([0.1, 0.2, 0.25]))
        np.testing.assert_allclose(hub.axes, TURNED, atol=1e-15)
        np.testing.assert_array_equal(hub.about, [0, 0, 1])
        assert repr(hub) == "RigidBody('hub', mass=3)"

    def test_points(self):
        model, _, _, hub = mixed()
        point = hub.at(0.1, 0, 0.2)
        assert (str(point), point.x, point.y, point.z) == ("hub.at(0.1, 0, 0.2)", 0.1, 0.0, 0.2)
        assert point.eccentric
        np.testing.assert_allclose(point.initial_position, [0, 0.1, 1.2], atol=1e-15)  # d_1 = e_y, d_3 = e_z
        assert model.point("hub.at(1e-1, 0,0.2)") == point
        assert (
            hub.at(0, 0, 0)
            == hub.at(0, -0.0, 0)
            == hub.centre
            == model.point("hub")
            == model.point("hub.centre")
        )
        assert str(hub.centre) == "hub.centre"
        assert not hub.centre.eccentric
        assert node_of(hub.centre) == 0
        assert hub.at(0, 0.1, 0).eccentric

    def test_motion(self):
        _, _, _, hub = mixed()
        hub.set_motion(velocity=(1, 0, 0), angular_velocity=(0, 0, 2))
        np.testing.assert_array_equal(hub.about, hub.position)
        hub.set_motion(angular_velocity=(0, 1, 0), about=(0, 0, 0))
        np.testing.assert_array_equal(hub.velocity, [0, 0, 0])
        np.testing.assert_array_equal(hub.about, [0, 0, 0])
        refused('set_motion("hub").about', "wanted (3,)", hub.set_motion, about=(0, 0))
        np.testing.assert_array_equal(hub.angular_velocity, [0, 1, 0])

    @pytest.mark.parametrize(
        "inertia",
        [
            (1, 1, 1),
            np.array([1.0, 2.0, 3.0]),
            (1.0, 1.0, 0.0),  # a thin rod
            [[2, -0.1, 0], [-0.1, 2, 0], [0, 0, 3]],
            np.diag([0.1, 0.2, 0.3]),
            np.diag([0.1, 0.2, 0.3 * (1 + 1e-12)]),
            [[1, 1e-12, 0], [0, 1, 0], [0, 0, 1]],
            (1e-200, 1e-200, 1e-200),
        ],
    )
    def test_inertia(self, inertia):
        body = Model().add_rigid_body("a", at=(0, 0, 0), mass=1, inertia=inertia)
        np.testing.assert_array_equal(body.inertia, body.inertia.T)
        wanted = np.asarray(inertia, float)
        np.testing.assert_allclose(body.inertia, np.diag(wanted) if wanted.ndim == 1 else wanted, atol=1e-11)

    @pytest.mark.parametrize(
        ("inertia", "key", "phrase"),
        [
            (None, "", "a rigid body needs its inertia: three principal moments or a 3x3 matrix"),
            (0.1, "", "three principal moments or a 3x3 matrix"),
            ("big", "", "must be a list of numbers"),
            ((1, 2), "", "has shape (2,), wanted (3,)"),
            ([], "", "wanted (3,)"),
            ((1, 2, "3"), "[2]", "must be a number"),
            ((1, NAN, 1), "[1]", "finite"),
            ([[1, 0], [0, 1]], "", "has shape (2, 2), wanted (3, 3)"),
            ([[1, 0, 0], [0, 1]], "[1]", "has shape"),
            ([[1, 0.5, 0], [0, 1, 0], [0, 0, 1]], "", "must be symmetric: [0][1] = 0.5, [1][0] = 0"),
            ((1, 2, 3.1), "", "3.1 is above the sum of the others, 3"),
            ((1, -0.1, 1), "", "-0.1 is negative"),
            ((-1, -1, -1), "", "is negative"),
            ([[1, 0, 2], [0, 1, 0], [2, 0, 1]], "", "principal moments -1, 1, 3 kg m^2: -1 is negative"),
            ((0, 0, 0), "", "is zero"),
            ((0, 0, 1), "", "above the sum"),
            ((1e308, 1e308, 1e308), "", "must be within 1e+100"),
            ({"x": 1}, "", "must be a list of numbers"),
            (np.eye(3) * 1j, "", "holds complex"),
        ],
    )
    def test_bad_inertia(self, inertia, key, phrase):
        model = Model()
        where = f'add_rigid_body("hub").inertia{key}'
        refused(where, phrase, model.add_rigid_body, "hub", at=(0, 0, 0), mass=1, inertia=inertia)
        assert not model.bodies

    def test_axes_are_cleaned_of_rounding(self):
        c = round(math.cos(0.5), 8), round(math.sin(0.5), 8)
        given = [[c[0], -c[1], 0], [c[1], c[0], 0], [0, 0, 1]]
        body = Model().add_rigid_body("a", at=(0, 0, 0), mass=1, inertia=(1, 1, 1), axes=given)
        np.testing.assert_allclose(body.axes.T @ body.axes, np.eye(3), atol=1e-15)
        np.testing.assert_allclose(body.axes, given, atol=1e-8)

    @pytest.mark.parametrize(
        ("axes", "phrase"),
        [
            ([[1, 0, 0], [0, 1, 0]], "wanted (3, 3)"),
            (np.eye(3) * 1.001, "must be a rotation matrix"),
            (np.zeros((3, 3)), "must be a rotation matrix"),
            ([[1, 0.1, 0], [0, 1, 0], [0, 0, 1]], "must be a rotation matrix"),
            (np.diag([1.0, 1.0, -1.0]), "left-handed"),
            ("xyz", "must be a list of numbers"),
            (np.full((3, 3), 1e308), "must be a rotation matrix"),
        ],
    )
    def test_bad_axes(self, axes, phrase):
        model = Model()
        given = {"at": (0, 0, 0), "mass": 1, "inertia": (1, 1, 1), "axes": axes}
        refused('add_rigid_body("a").axes', phrase, model.add_rigid_body, "a", **given)

    @pytest.mark.parametrize(("place", "key"), [((NAN, 0, 0), "x"), ((0, "1", 0), "y"), ((0, 0, None), "z")])
    def test_bad_place(self, place, key):
        refused(f"hub.at.{key}", "must be a", mixed()[3].at, *place)


class TestPoints:
    @pytest.mark.parametrize(
        ("label", "phrase", "hint"),
        [
            ("rope", "is no point, it is a cable", "rope.start"),
            ("tpi", "is no point", 'did you mean "tip"?'),
            ("tip.start", '"tip" is a point mass', 'its point is "tip"'),
            ("tip.at(0)", '"tip" is a point mass', 'its point is "tip"'),
            ("hub.start", '"hub" is a rigid body', "hub.at(x, y, z)"),
            ("rope.centre", '"rope" is a cable', "rope.at(x)"),
            ("hub.at(0.1)", "has 1 number, wanted x, y, z in m", ""),
            ("hub.at(0.1, 0)", "has 2 numbers, wanted x, y, z in m", ""),
            ("hub.at(0.1, 0, b)", '"b" is no place along z in m', ""),
            ("hub.at(0.1, 0, inf)", "finite", ""),
            ("hut.centre", 'unknown body "hut"', 'did you mean "hub"?'),
        ],
    )
    def test_bad_labels(self, label, phrase, hint):
        error = refused("Model.point", phrase.replace('"hut"', "'hut'"), mixed()[0].point, label)
        assert hint in error.hint

    def test_bodies_stand_for_their_points(self):
        model, rope, tip, hub = mixed()
        assert model.add_force(tip, (0, 0, 1)).point == tip.point
        assert model.add_force(hub, (0, 0, 1)).point == hub.centre
        spring = model.add_spring(hub, tip, stiffness=1)
        assert spring.length == pytest.approx(math.sqrt(2))
        assert spring.name == "spring from hub.centre to tip"
        refused("add_force(rope).point", "is no point, it is a cable", model.add_force, rope, (0, 0, 1))
        other = Model().add_point_mass("tip", at=(0, 0, 0), mass=1)
        refused("pin(tip).point", "another model", model.pin, other)

    def test_unknown_body(self):
        refused("Model.body", 'known: "rope", "tip", "hub"', mixed()[0].body, "tap")


class TestModel:
    def test_kinds(self):
        model, rope, tip, hub = mixed()
        assert model.bodies == {"rope": rope, "tip": tip, "hub": hub}
        assert model.beams == {"rope": rope}
        assert model.masses == {"tip": tip}
        assert model.rigid_bodies == {"hub": hub}

    def test_size(self):
        model = Model()
        assert model.size == 0.0
        model.add_point_mass("a", at=(5, 5, 5), mass=1)
        assert model.size == 1.0  # one place: nothing else to go by
        model.add_spring("a", (5, 5, 5.25), stiffness=1)
        assert model.size == 0.25
        model.add_point_mass("b", at=(5, 5, 8), mass=1)
        assert model.size == 3.0
        model.add_beam("c", start=(0, 5, 5), end=(5, 5, 5), elements=1, section=cable_section())
        assert model.size == 5.0

    def test_size_of_a_rigid_body(self):
        model = Model()
        ball = model.add_rigid_body("a", at=(1, 0, 0), mass=2.0, inertia=(3, 3, 3))
        assert ball.gyration_radius == pytest.approx(1.5)
        assert model.size == pytest.approx(3.0)

    def test_summary_of_the_command_line(self):
        model, _, _, _ = mixed()
        assert total_mass(model) == pytest.approx(0.5 + 2 + 3)
        assert node_count(model) == 5 + 1 + 1
        study = parse_study({"bodies": BODIES, "sections": SECTIONS})
        assert outputs(study) == ["rope.start", "rope.at(0.5)", "rope.end", "tip", "hub.centre"]

    def test_tables_of_the_command_line(self):
        model, *_ = mixed()
        console = Console(width=200, record=True)
        console.print(_bodies(model))
        console.print(_masses(model))
        text = console.export_text()
        assert "rope" in text
        assert "0.1, 0.2, 0.25" in text
        assert "point mass" in text


class TestSupports:
    def test_pin(self):
        model, _, tip, hub = mixed()
        assert model.pin(tip).held == {"position x", "position y", "position z"}
        pin = model.pin(hub, displacement=["t", 0, 0])
        assert pin.point == hub.centre
        assert pin.name == "pin at hub.centre"

    def test_clamp(self):
        model, _, _, hub = mixed()
        clamp = model.clamp(hub, rotation="t", axis=(0, 0, 2), displacement=[0, 0, "t"])
        assert clamp.held == {"position x", "position y", "position z", "rotation"}
        np.testing.assert_array_equal(clamp.axis, [0, 0, 1])
        refused("pin(hub).point", "both hold position x", model.pin, hub)

    def test_hold(self):
        model, _, tip, _ = mixed()
        assert model.hold(tip, position="xz").held == {"position x", "position z"}
        assert model.hold("hub", position="y").held == {"position y"}
        refused("pin(tip).point", "both hold position x, position z", model.pin, "tip")

    def test_bad(self):
        model, _, tip, hub = mixed()
        error = refused("clamp(tip).point", "is a point mass and has no orientation", model.clamp, tip)
        assert "model.pin" in error.hint
        refused("clamp(hub).stretch", "does not stretch", model.clamp, hub, stretch="fixed")
        refused("clamp(hub).stretch", 'must be one of "free", "fixed"', model.clamp, hub, stretch="no")
        error = refused("hold(hub).slope", "is a rigid body and has no slope", model.hold, hub, slope="x")
        assert "clamp" in error.hint
        refused("hold(tip).twist", "is a point mass and has no slope", model.hold, tip, twist=True)
        refused("hold(tip).slope_y", "has no slope", model.hold, tip, position="x", slope_y="z")
        refused("hold(tip).position", "nothing is held", model.hold, tip)
        for method in (model.pin, model.clamp):
            where = f"{method.__name__}(hub.at(0.1, 0, 0)).point"
            error = refused(where, "off the centre of mass", method, hub.at(0.1, 0, 0))
            joined = "model.connect(hub.at(0.1, 0, 0), [0.0, 0.1, 1.0]) lets it turn"
            assert error.hint == f"model.clamp(hub) holds all of it, {joined}"
        assert model.supports == []


class TestLoads:
    def test_forces_and_moments(self):
        model, _, tip, hub = mixed()
        assert model.add_force(hub.at(0.1, 0, 0), (0, 0, 1)).point.x == 0.1
        assert model.add_force("tip", ["t", 0, 0]).name == "force at tip"
        assert model.add_moment(hub.at(0.1, 0, 0), (1, 2, 3)).name == "moment at hub.at(0.1, 0, 0)"
        error = refused("add_moment(tip).point", "has no orientation", model.add_moment, tip, (1, 0, 0))
        assert "rigid body" in error.hint

    def test_no_distributed_load(self):
        model, _, tip, hub = mixed()
        for body, what in ((tip, "point mass"), (hub, "rigid body")):
            where = f"add_distributed_load({body.name}).body"
            error = refused(where, f"is a {what}", model.add_distributed_load, body, (0, 0, 1))
            assert "add_force" in error.hint


SECTIONS = {"wire": {"EA": 1e4, "EI": 1.0, "rhoA": 0.5}}
ROPE = {"name": "rope", "section": "wire", "start": [0, 0, 0], "end": [1, 0, 0], "elements": 4}
TIP = {"type": "point_mass", "name": "tip", "at": [1, 0, 0], "mass": 2.0, "motion": {"velocity": [0, 1, 0]}}
HUB = {
    "type": "rigid_body",
    "name": "hub",
    "at": [0, 0, 1],
    "mass": 3.0,
    "inertia": [0.1, 0.2, 0.25],
    "axes": TURNED,
    "motion": {"angular_velocity": [0, 0, 1], "about": [0, 0, 0]},
}
BODIES = [ROPE, TIP, HUB]


def floats(given):
    """As TOML gives it: whole numbers of a vector may stay whole."""
    return json.loads(json.dumps(given))


class TestFile:
    def test_read(self):
        model = parse_study({"bodies": floats(BODIES), "sections": SECTIONS}).model
        assert list(model.bodies) == ["rope", "tip", "hub"]
        np.testing.assert_array_equal(model.masses["tip"].velocity, [0, 1, 0])
        hub = model.rigid_bodies["hub"]
        np.testing.assert_allclose(hub.axes, TURNED, atol=1e-15)
        np.testing.assert_array_equal(hub.inertia, np.diag([0.1, 0.2, 0.25]))
        np.testing.assert_array_equal(hub.angular_velocity, [0, 0, 1])
        np.testing.assert_array_equal(hub.about, [0, 0, 0])

    def test_items(self):
        data = {
            "bodies": BODIES,
            "sections": SECTIONS,
            "supports": [
                {"type": "clamp", "point": "hub"},
                {"type": "hold", "point": "tip", "position": "z"},
            ],
            "loads": [{"type": "force", "point": "hub.at(0.1, 0, 0)", "force": [1, 0, 0]}],
            "connections": [{"type": "spring", "a": "tip", "b": "hub.at(0, 0, 0.5)", "stiffness": 10.0}],
            "simulation": {"t_end": 1.0, "step": 0.1, "outputs": ["tip", "hub.centre"]},
        }
        model = parse_study(data).model
        assert [s.point.label for s in model.supports] == ["hub.centre", "tip"]
        assert str(model.connections[0].b) == "hub.at(0, 0, 0.5)"

    @pytest.mark.parametrize(
        ("change", "where", "phrase"),
        [
            ({"type": "mass"}, "bodies[2].type", 'must be one of "beam", "point_mass", "rigid_body"'),
            ({"inertia": None}, "bodies[2].inertia", "must be a list"),
            ({"inertia": [1, 2]}, "bodies[2].inertia", "has shape (2,), wanted (3,)"),
            ({"inertia": [1, 2, 4]}, "bodies[2].inertia", "above the sum of the others"),
            ({"inertia": [[1, 0, 0], [0, "1", 0], [0, 0, 1]]}, "bodies[2].inertia[1][1]", "must be a number"),
            ({"mass": 0}, "bodies[2].mass", "must be > 0"),
            ({"at": [0, 0]}, "bodies[2].at", "wanted 3"),
            ({"axes": [[1, 0, 0], [0, 1, 0], [0, 0, 2]]}, "bodies[2].axes", "must be a rotation matrix"),
            ({"axes": [[1, 0, 0], [0, 1, 0]]}, "bodies[2].axes", "has 2 entries, wanted 3"),
            ({"elements": 4}, "bodies[2].elements", "unknown key"),
            ({"motion": {"about": [0, 0]}}, "bodies[2].motion.about", "wanted 3"),
            ({"name": "tip"}, "bodies[2].name", "is the name of a body already"),
        ],
    )
    def test_bad(self, change, where, phrase):
        hub = HUB | change
        if hub["inertia"] is None:
            phrase = "a rigid body needs its inertia"
        refused(where, phrase, parse_study, {"bodies": [ROPE, TIP, hub], "sections": SECTIONS})

    def test_missing_inertia(self):
        hub = {key: value for key, value in HUB.items() if key != "inertia"}
        error = refused("bodies[0].inertia", "is missing", parse_study, {"bodies": [hub]})
        assert "principal moments" in error.hint

    def test_a_point_mass_does_not_turn(self):
        tip = TIP | {"motion": {"angular_velocity": [0, 0, 1]}}
        refused("bodies[0].motion.angular_velocity", 'allowed: "velocity"', parse_study, {"bodies": [tip]})

    def test_misspelt_keys_of_beams_are_still_found(self):
        error = refused("bodies[0].elemens", "unknown key", parse_study, {"bodies": [ROPE | {"elemens": 3}]})
        assert error.hint == 'did you mean "elements"?'

    def test_schema(self):
        plain = schema()
        titles = {part["$ref"].rpartition("/")[2] for part in plain["properties"]["bodies"]["items"]["oneOf"]}
        assert titles == {"BeamEntry", "PointMassEntry", "RigidBodyEntry"}
        inertia = plain["$defs"]["RigidBodyEntry"]["properties"]["inertia"]
        assert "kg m^2" in inertia["description"]
        assert "inertia" in plain["$defs"]["RigidBodyEntry"]["required"]


class TestDescription:
    def test_is_what_a_file_takes(self):
        model = parse_study({"bodies": BODIES, "sections": SECTIONS}).model
        plain = json.loads(json.dumps(model.to_dict()))
        again = parse_study({"bodies": plain["bodies"][1:]}).model
        assert again.to_dict()["bodies"] == plain["bodies"][1:]
        np.testing.assert_array_equal(again.rigid_bodies["hub"].about, [0, 0, 0])
