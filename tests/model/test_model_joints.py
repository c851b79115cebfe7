"""The model of joints: spherical, hinge, clamp to a body, sliding joint; files, and what is wrong."""

import json
import math
import re

import numpy as np
import pytest

import ancf
from ancf.model import Model, Section, lookup
from ancf.model.bodies import nearest
from ancf.model.file import parse_study, schema
from ancf.model.integrators import FORMULATIONS, INTEGRATORS, integrator_of, table_schema
from helpers import arc
from refusals import cable_section, flat, refused

NAN = float("nan")


def mixed():
    """A cable along x, a beam along y from its end, a point mass there and a rigid body at (0, 0, 1)."""
    model = Model()
    model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=cable_section())
    model.add_beam("bar", start=(1, 0, 0), end=(1, 1, 0), elements=2, section=flat(), element="nonlocking")
    model.add_point_mass("tip", at=(1, 0, 0), mass=2.0)
    model.add_rigid_body("hub", at=(0, 0, 1), mass=3.0, inertia=(0.1, 0.2, 0.25))
    return model


def test_joints_do_not_look_at_all_bodies(monkeypatch):
    """Chains of n pieces would take n^2 looks: only gaps that may be round-off ask for the model's size."""
    looked, extent = [], lookup._extent
    monkeypatch.setattr(lookup, "_extent", lambda body: looked.append(body) or extent(body))
    model = Model()
    rods = [
        model.add_beam(
            f"rod {k}", start=(k, 0, 0), end=(k + 1, 0, 0), elements=1, section=flat(), element="nonlocking"
        )
        for k in range(9)
    ]
    model.connect(rods[0].end, rods[1].start)
    model.hinge(rods[1].end, rods[2].start, axis=(0, 0, 1))
    model.universal(rods[2].end, rods[3].start, axis_a=(0, 1, 0), axis_b=(0, 0, 1))
    model.weld(rods[3].end, rods[4].start)
    model.prismatic(rods[4].end, rods[5].start, axis=(1, 0, 0))
    assert looked == []
    near = model.add_beam(
        "near", start=(1e-9, 0, 0), end=(0, 0, 1), elements=1, section=flat(), element="nonlocking"
    )
    model.connect(near.start, rods[0].start)
    assert len(looked) == 10


class TestSpherical:
    @pytest.mark.parametrize(
        ("a", "b", "shared"),
        [
            ("rope.end", "bar.start", True),
            ("rope.end", "tip", True),
            ("tip", "rope.at(1)", True),
            ("rope.at(0.3)", (0.3, 0, 0), False),
            ("rope.end", (1, 0, 0), False),
            ("hub.at(0, 0, -1)", "rope.start", False),
            ("hub", (0, 0, 1), False),
            ("tip", (1, 0, 0), False),
            ("rope.at(0.4)", "hub.at(0.4, 0, -1)", False),
            ("bar.at(0.3, 0.02, 0.01)", (0.98, 0.3, 0.01), False),
        ],
    )
    def test_any_two_points(self, a, b, shared):
        model = mixed()
        joint = model.connect(a, b)
        assert joint.a == model.point(a)
        assert joint.shared is shared
        if isinstance(b, str):
            assert joint.b == model.point(b)
            assert joint.name == f"joint of {joint.a} and {joint.b}"
        else:
            np.testing.assert_array_equal(joint.b, b)
            assert joint.name == f"joint of {joint.a} and ground"

    def test_not_finite(self):
        refused("connect(rope.end).b[2]", "finite", mixed().connect, "rope.end", (1, 0, NAN))

    def test_a_body_far_from_its_point(self):
        model = Model()
        arm = model.add_rigid_body("arm", at=(0.1, 0.2, 0.3), mass=1, inertia=(1e-8, 1e-8, 1e-8))
        model.connect(arm.at(-0.1, -0.2, -0.3), (0, 0, 0))
        refused("connect(arm.at(0, 0, 1)).b", "m apart", model.connect, arm.at(0, 0, 1), (0.1, 0.2, 1.30001))

    @pytest.mark.parametrize(
        ("a", "b", "phrase"),
        [
            ("rope.end", "hub", "rope.end and hub.centre are 1.41421 m apart, must coincide"),
            ("rope.end", (1, 0, 1e-3), "rope.end and the position [1.0, 0.0, 0.001] are 0.001 m apart"),
            ("rope.end", (1, 0), "wanted (3,)"),
            ("rope.end", 3.0, "must be a list of three numbers"),
            ("rope.end", "rope.at(1.0)", "is the same node as rope.end"),
            ("bar.at(0.2)", "bar.at(0.2)", "is the same point as bar.at(0.2)"),
            ("tip", "tip", "tip is the same node as tip"),
            ("hub", "hub.at(0, 0, 0.1)", 'are points of one rigid body, "hub"'),
            ("rope.end", "bar", "is no point, it is a beam"),
        ],
    )
    def test_bad(self, a, b, phrase):
        model = mixed()
        refused(f"connect({a}).b", phrase, model.connect, a, b)
        assert model.connections == []

    def test_repeated(self):
        model = mixed()
        model.connect("rope.end", "tip", name="knot")
        refused(
            'connect("x").b',
            '"knot" connects tip and rope.end already',
            model.connect,
            "tip",
            "rope.end",
            name="x",
        )
        model.connect("tip", "bar.start")
        model.connect("rope.start", (0, 0, 0))
        where, what = "connect(rope.start).b", "connects rope.start and [0.0, 0.0, 0.0] already"
        refused(where, what, model.connect, "rope.start", (0, 0, 0))
        model.connect("rope.start", "hub.at(0, 0, -1)")


class TestHinge:
    def test_made(self):
        model = mixed()
        hinge = model.hinge("hub.at(1, 0, -1)", "bar.start", axis=(0, 0, 2))
        assert hinge.name == "hinge of hub.at(1, 0, -1) and bar.start"
        np.testing.assert_array_equal(hinge.axis, [0, 0, 1])
        ground = model.hinge("hub", (0, 0, 1), axis=(1, 1, 0), name="gate")
        np.testing.assert_allclose(ground.axis, np.array([1, 1, 0]) / math.sqrt(2))
        np.testing.assert_array_equal(ground.b, [0, 0, 1])
        model.hinge("bar.end", (1, 1, 0), axis=(0, 0, 1))

    @pytest.mark.parametrize(
        ("a", "b", "key", "phrase"),
        [
            ("rope.start", (0, 0, 0), "a", "is a cable, which does not turn about its tangent"),
            ("hub.at(0, 0, -1)", "rope.start", "b", "is a cable"),
            ("tip", (1, 0, 0), "a", "has no orientation"),
            ("bar.start", "tip", "b", "has no orientation"),
            ("bar.at(0.3)", (1, 0.3, 0), "a", "not at a node"),
            ("bar.at(0, 0.01, 0)", (0.99, 0, 0), "a", "off the centreline"),
            ("hub", (0, 0, 0), "b", "are 1 m apart"),
            ("hub", "hub", "b", "points of one rigid body"),
            ("bar.end", "bar.end", "b", "same node"),
        ],
    )
    def test_bad(self, a, b, key, phrase):
        refused(f"hinge({a}).{key}", phrase, mixed().hinge, a, b, axis=(0, 0, 1))

    def test_bad_axis(self):
        refused("hinge(hub).axis", "zero vector", mixed().hinge, "hub", (0, 0, 1), axis=(0, 0, 0))
        refused("hinge(hub).axis", "wanted (3,)", mixed().hinge, "hub", (0, 0, 1), axis=(0, 1))

    def test_holds_what_a_spherical_joint_holds(self):
        model = mixed()
        model.hinge("hub", (0, 0, 1), axis=(0, 0, 1))
        refused(
            "connect(hub).b",
            "connects hub.centre and [0.0, 0.0, 1.0] already",
            model.connect,
            "hub",
            (0, 0, 1),
        )
        refused("hinge(hub).b", "already", model.hinge, "hub", (0, 0, 1), axis=(0, 1, 0))


class TestClampToABody:
    def test_made(self):
        model = mixed()
        item = model.clamp("rope.start", to="hub")
        assert (item.point, item.to, item.stretch) == (model.point("rope.start"), model.body("hub"), "free")
        assert item.name == "clamp of rope.start to hub"
        assert model.connections == [item]
        assert model.supports == []
        assert model.clamp("bar.at(0.5)", to=model.body("hub"), stretch="fixed").stretch == "fixed"

    @pytest.mark.parametrize(
        ("point", "to", "given", "key", "phrase"),
        [
            ("rope.at(0.3)", "hub", {}, "point", "not at a node"),
            ("bar.at(0, 0.01, 0)", "hub", {}, "point", "off the centreline"),
            ("tip", "hub", {}, "point", "is a point mass and has no orientation"),
            ("hub", "hub", {}, "point", "is a rigid body"),
            ("rope.start", "bar", {}, "to", '"bar" is a beam, must be a rigid body'),
            ("rope.start", "tip", {}, "to", "is a point mass"),
            ("rope.start", "hob", {}, "to", "unknown body 'hob'"),
            ("rope.start", (0, 0, 0), {}, "to", "must be a body or its name"),
            ("rope.start", "hub", {"stretch": "no"}, "stretch", 'must be one of "free", "fixed"'),
            ("rope.start", "hub", {"rotation": "t"}, "rotation", "has no effect with to"),
            ("rope.start", "hub", {"displacement": (0, 0, 0)}, "displacement", "the node follows the body"),
        ],
    )
    def test_bad(self, point, to, given, key, phrase):
        model = mixed()
        refused(f"clamp({point}).{key}", phrase, model.clamp, point, to=to, **given)
        assert model.connections == []

    def test_repeated(self):
        model = mixed()
        model.clamp("rope.start", to="hub")
        refused(
            "clamp(rope.start).to",
            'connects rope.start and "hub" already',
            model.clamp,
            "rope.start",
            to="hub",
        )
        where = "connect(hub.at(0, 0, -1)).b"
        refused(where, "already", model.connect, "hub.at(0, 0, -1)", "rope.start")


class TestSlide:
    def test_defaults(self):
        model = mixed()
        joint = model.slide("tip", along="rope")
        assert joint.name == "slide of tip along rope"
        assert (joint.point, joint.carrier) == (model.point("tip"), model.body("rope"))
        assert (joint.line, joint.offset, joint.s) == (None, (0.0, 0.0), 1.0)
        assert (joint.mass, joint.friction, joint.friction_velocity, joint.viscous) == (0, 0, 1e-3, 0)
        assert (joint.force, joint.motion, joint.release, joint.unilateral) == (None, None, None, None)
        assert joint.at_end == "stop"
        assert joint.tolerance == 1e-6 * model.size
        assert joint.length == 1.0

    def test_everything(self):
        joint = mixed().slide(
            "hub.at(0.3, 0, -1)",
            along="rope",
            s=0.3,
            mass=0.1,
            friction=0.2,
            friction_velocity=1e-2,
            viscous=0.3,
            force="2*t",
            release=(0, 3, 0),
            unilateral=(0, 0, -2),
            at_end="clamp",
            name="runner",
        )
        assert (joint.name, joint.s, joint.mass, joint.friction, joint.viscous) == (
            "runner",
            0.3,
            0.1,
            0.2,
            0.3,
        )
        assert joint.friction_velocity == 1e-2
        assert joint.force(2.0) == 4.0
        np.testing.assert_array_equal(joint.release, [0, 1, 0])
        np.testing.assert_array_equal(joint.unilateral, [0, 0, -1])
        assert joint.at_end == "clamp"

    def test_a_ring(self):
        joint = mixed().slide((0.3, 0, 0), along="rope")
        assert joint.name == "slide of ring along rope"
        np.testing.assert_array_equal(joint.point, [0.3, 0, 0])
        assert joint.s == pytest.approx(0.3, abs=1e-15)

    def test_motion(self):
        joint = mixed().slide("hub.at(0.3, 0, -1)", along="rope", motion="0.3 + 0.1*t")
        assert joint.s == 0.3
        assert joint.motion(1.0) == pytest.approx(0.4)
        where = "slide(hub.at(0.3, 0, -1))"
        given = {"along": "rope", "motion": "0.3 + 0.1*t"}
        for key, value in (("mass", 1.0), ("friction", 0.1), ("viscous", 1.0), ("force", 0.0)):
            model = mixed()
            refused(
                f"{where}.{key}",
                "no effect with motion",
                model.slide,
                "hub.at(0.3, 0, -1)",
                **given,
                **{key: value},
            )
        what = "is 0.2 m, but motion starts from 0.3 m"
        refused(f"{where}.s", what, mixed().slide, "hub.at(0.3, 0, -1)", **given, s=0.2)
        given["motion"] = "0.4"
        what = 'is 0.1 m off the line of "rope" at s = 0.4 m, the nearest place is s = 0.3 m'
        refused(f"{where}.motion", what, mixed().slide, "hub.at(0.3, 0, -1)", **given)
        given["motion"] = "-0.1 + t"
        refused(f"{where}.motion", "s = -0.1 m is off the line", mixed().slide, "hub.at(0.3, 0, -1)", **given)

    def test_along_a_rigid_body(self):
        model = Model()
        turned = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
        hub = model.add_rigid_body("hub", at=(0, 0, 1), mass=3.0, inertia=(0.1, 0.2, 0.25), axes=turned)
        model.add_point_mass("tip", at=(0, 0.25, 1.5), mass=1)
        joint = model.slide("tip", along=hub, line=((0, 0, 0.5), (2, 0, 0.5)))
        assert joint.s == pytest.approx(0.25)
        assert joint.length == pytest.approx(2.0)
        np.testing.assert_array_equal(joint.line[1], [2, 0, 0.5])
        assert joint.offset == (0.0, 0.0)

    def test_in_a_section(self):
        model = mixed()
        joint = model.slide((0.99, 0.7, 0.01), along="bar", offset=(0.01, 0.01))  # local y is -e_x
        assert joint.s == pytest.approx(0.7, abs=1e-14)
        assert joint.offset == (0.01, 0.01)

    @pytest.mark.parametrize(
        ("given", "key", "phrase"),
        [
            ({"along": "tip"}, "along", '"tip" is a point mass, must be a beam, a cable or a rigid body'),
            (
                {"along": "hub", "line": ((0, 0, -1), (1, 0, -1))},
                "along",
                "is the body of hub.at(0.3, 0, -1)",
            ),
            ({"along": "wire"}, "along", "unknown body 'wire'"),
            ({"along": None}, "along", "must be a body or its name"),
            ({"line": ((0, 0, 0), (1, 0, 0))}, "line", 'is for rigid bodies, "rope" is a cable'),
            ({"offset": (0, 0.01)}, "offset", "a cable has no cross-section"),
            ({"offset": 0.01}, "offset", "must be a list of numbers"),
            (
                {"s": 0.5},
                "s",
                'is 0.2 m off the line of "rope" at s = 0.5 m, the nearest place is s = 0.3 m, 0 m',
            ),
            ({"s": 1.5}, "s", "s = 1.5 m is off the line, 0 <= s <= 1 m"),
            ({"s": NAN}, "s", "finite"),
            ({"s": "0.3"}, "s", "must be a number"),
            ({"tolerance": -1}, "tolerance", "must be >= 0"),
            ({"mass": -1}, "mass", "must be >= 0"),
            ({"friction": "0.1"}, "friction", "must be a number"),
            ({"friction_velocity": 0}, "friction_velocity", "must be > 0"),
            ({"viscous": NAN}, "viscous", "finite"),
            ({"force": (0, 0, 1)}, "force", "must be a number"),
            ({"motion": "x"}, "motion", "x"),
            ({"release": (0, 0, 0)}, "release", "zero vector"),
            ({"release": (2, 0, 0)}, "release", "is along the line, where the joint has no force"),
            ({"unilateral": (-1, 0, 0)}, "unilateral", "is along the line"),
            (
                {"release": (0, 1, 0), "unilateral": (0, 1, 1)},
                "unilateral",
                "must be perpendicular to release",
            ),
            ({"at_end": "fall"}, "at_end", 'must be one of "stop", "clamp", "release"'),
        ],
    )
    def test_bad(self, given, key, phrase):
        model = mixed()
        given = {"along": "rope"} | given
        refused(f"slide(hub.at(0.3, 0, -1)).{key}", phrase, model.slide, "hub.at(0.3, 0, -1)", **given)
        assert model.connections == []

    @pytest.mark.parametrize(
        ("given", "key", "phrase"),
        [
            ({}, "line", 'is missing: the rigid body "hub" needs the start and end'),
            ({"line": ((0, 0, 0),)}, "line", "wanted (2, 3)"),
            ({"line": ((1, 0, 0), (1, 0, 0))}, "line", "has no length"),
            ({"line": ((0, 0, 0), (1, 0, 0)), "offset": (0, 0.1)}, "offset", "is for beams"),
            ({"line": ((0, 0, 0), (1, 0, 0))}, "point", "is 1 m off the line"),
        ],
    )
    def test_bad_line(self, given, key, phrase):
        refused(f"slide(rope.end).{key}", phrase, mixed().slide, "rope.end", along="hub", **given)

    def test_off_the_line(self):
        model = mixed()
        where, what = (
            "slide(bar.end).point",
            'bar.end is 1 m off the line of "rope", the nearest place is s = 1 m',
        )
        error = refused(where, what, model.slide, "bar.end", along="rope")
        assert "tolerance" in error.hint
        refused(
            "slide().point",
            "the ring at [0.5, 0.1, 0.0] is 0.1 m off",
            model.slide,
            (0.5, 0.1, 0),
            along="rope",
        )
        joint = model.slide((0.5, 0.1, 0), along="rope", tolerance=0.2)
        assert (joint.s, joint.tolerance) == (0.5, 0.2)

    def test_no_tolerance_still_forgives_rounding(self):
        assert mixed().slide((0.1 + 0.2, 1e-17, 0), along="rope", s=0.3, tolerance=0).s == 0.3
        refused("slide().s", "1e-09 m off", mixed().slide, (0.3, 1e-9, 0), along="rope", s=0.3, tolerance=0)

    def test_outside_the_section(self):
        where, what = "slide().offset", "outside the cross-section"
        refused(where, what, mixed().slide, (1, 0.5, 0), along="bar", offset=(0.03, 0))

    def test_repeated(self):
        model = mixed()
        model.slide("tip", along="rope")
        refused("slide(tip).along", 'connects tip and "rope" already', model.slide, "tip", along="rope")
        model.slide("bar.start", along="rope")
        model.connect("tip", "rope.end")  # not the same: the system looks at ranks


class TestNearest:
    @pytest.mark.parametrize("element", ["cable", "nonlocking"])
    @pytest.mark.parametrize("elements", [1, 2, 7])
    def test_against_a_dense_search(self, element, elements):
        beam = Model().add_beam("b", path=arc, elements=elements, section=flat_square(), element=element)
        offset = (0.0, 0.0) if element == "cable" else (0.015, -0.01)
        fine = np.linspace(0, beam.length, 2001)
        line = np.array([beam.initial_position(x, *offset) for x in fine.tolist()])
        rng = np.random.default_rng(1)
        for point in rng.normal(size=(10, 3)) * beam.length:
            s, distance = nearest.along_beam(beam, offset, point)
            dense = np.linalg.norm(line - point, axis=1).min()
            assert distance <= dense * (1 + 1e-14)
            assert dense - distance < 1e-4 * beam.length
            assert np.linalg.norm(beam.initial_position(s, *offset) - point) == pytest.approx(
                distance, abs=1e-12
            )

    @pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
    def test_points_of_the_line_are_found_again(self, element):
        beam = Model().add_beam("b", path=arc, elements=5, section=flat_square(), element=element)
        offset = (0.0, 0.0) if element == "cable" else (0.02, 0.01)
        for s in np.linspace(0, beam.length, 41).tolist():
            found, distance = nearest.along_beam(beam, offset, beam.initial_position(s, *offset))
            assert found == pytest.approx(s, abs=1e-13 * beam.length)
            assert distance < 1e-14

    def test_nodes_are_met_exactly(self):
        beam = Model().add_beam("b", start=(0, 0, 0), end=(1, 2, 3), elements=7, section=cable_section())
        for x, r in zip(beam.node_x, beam.node_position, strict=True):
            assert nearest.along_beam(beam, (0.0, 0.0), r + np.array([3e-17, 0, 0]))[0] == x

    def test_many_elements(self, monkeypatch):
        beam = Model().add_beam("b", path=arc, elements=50, section=flat_square(), element="cable")
        point = beam.initial_position(0.77 * beam.length) + np.array([0.01, 0.02, 0.03])
        whole = nearest.along_beam(beam, (0.0, 0.0), point)
        monkeypatch.setattr(nearest, "CHUNK", 7)
        assert nearest.along_beam(beam, (0.0, 0.0), point) == whole

    def test_along_a_line(self):
        start, end = np.array([0.0, 0, 0]), np.array([0.0, 2, 0])
        assert nearest.along_line(start, end, np.array([1.0, 0.5, 0])) == (0.5, 1.0)
        assert nearest.along_line(start, end, np.array([0.0, 5, 4])) == (2.0, 5.0)
        assert nearest.along_line(start, end, np.array([0.0, -3, 4])) == (0.0, 5.0)


def flat_square():
    return Section.rectangle(width=0.05, height=0.05, E=1e8, rho=500.0)


class TestLookup:
    def test_by_name_or_object(self):
        model = mixed()
        joint = model.slide("tip", along="rope", name="runner")
        spring = model.add_spring("hub", "tip", stiffness=1)
        assert model.connection("runner") is joint is model.connection(joint)
        assert model.connection(spring.name) is spring
        error = refused("Model.connection", 'known: "runner", "spring', model.connection, "runer")
        assert error.hint == 'did you mean "runner"?'
        refused("Model.connection", "must be a joint or spring of this model", mixed().connection, joint)
        refused("Model.connection", "must be a joint or spring", model.connection, 3)
        refused("Model.connection", "the model has none yet", mixed().connection, "runner")

    def test_names_are_unique(self):
        model = mixed()
        model.slide("tip", along="rope", name="runner")
        refused(
            'connect("runner").name',
            "is the name of a connection already",
            model.connect,
            "tip",
            "rope.end",
            name="runner",
        )
        model.connect("tip", "rope.end")
        model.connect("bar.end", (1, 1, 0))
        assert len({item.name for item in model.connections}) == 3


BODIES = [
    {"name": "rope", "section": "wire", "start": [0, 0, 0], "end": [1, 0, 0], "elements": 4},
    {"type": "point_mass", "name": "tip", "at": [1, 0, 0], "mass": 2.0},
    {"type": "rigid_body", "name": "hub", "at": [0, 0, 1], "mass": 3.0, "inertia": [0.1, 0.2, 0.25]},
]
SECTIONS = {"wire": {"EA": 1e4, "EI": 1.0, "rhoA": 0.5}}
HINGE = {"type": "hinge", "a": "hub", "b": [0, 0, 1], "axis": [0, 0, 1], "name": "gate"}
SLIDE = {
    "type": "slide",
    "point": "hub.at(0.3, 0, -1)",
    "along": "rope",
    "release": [0, 1, 0],
    "force": "2*t",
}


def study(*connections, **others):
    data = {"bodies": BODIES, "sections": SECTIONS, "connections": list(connections), **others}
    return parse_study(json.loads(json.dumps(data)))


class TestFile:
    def test_all_kinds(self):
        spherical = {"type": "spherical", "a": "tip", "b": "rope.end"}
        ground = {"type": "spherical", "a": "rope.start", "b": [0, 0, 0]}
        fixation = {"type": "fixation", "point": "rope.at(0.5)", "to": "hub", "stretch": "fixed"}
        rigid = {
            "type": "slide",
            "point": [0, 0, 1.5],
            "along": "hub",
            "line": [[0, 0, 0], [0, 0, 1]],
            "at_end": "release",
        }
        model = study(spherical, ground, HINGE, fixation, SLIDE, rigid).model
        plain = json.loads(json.dumps(model.to_dict()["connections"]))
        kinds = ["spherical", "spherical", "hinge", "fixation", "slide", "slide"]
        assert [item["type"] for item in plain] == kinds
        assert plain[1]["b"] == [0, 0, 0]
        assert plain[2] == {**HINGE, "a": "hub.centre"}
        assert (plain[3]["to"], plain[3]["stretch"]) == ("hub", "fixed")
        assert (plain[4]["along"], plain[4]["force"], plain[4]["s"]) == ("rope", "2*t", pytest.approx(0.3))
        assert (plain[5]["line"], plain[5]["s"]) == ([[0, 0, 0], [0, 0, 1]], 0.5)

    @pytest.mark.parametrize(
        ("change", "where", "phrase"),
        [
            (
                {"type": "slider"},
                "type",
                'must be one of "spherical", "hinge", "cylindrical", "prismatic", "planar", "universal"',
            ),
            ({"along": "rop"}, "along", "unknown body 'rop'"),
            ({"point": [0, 0]}, "point", "wanted (3,)"),
            ({"point": "hub.middle"}, "point", "is no point"),
            ({"offset": [0.0]}, "offset", "has 1 entries, wanted 2"),
            ({"line": [[0, 0, 0]]}, "line", "has 1 entries, wanted 2"),
            ({"friction": -0.1}, "friction", "must be >= 0"),
            ({"motion": "0.3"}, "force", "no effect with motion"),
            ({"s": 0.4}, "s", "the nearest place is s = 0.3 m"),
            ({"release": [1, 0, 0]}, "release", "is along the line"),
            ({"at_end": "go"}, "at_end", 'must be one of "stop", "clamp", "release"'),
            ({"axis": [0, 0, 1]}, "axis", "unknown key"),
        ],
    )
    def test_bad_slide(self, change, where, phrase):
        refused(f"connections[0].{where}", phrase, study, SLIDE | change)

    @pytest.mark.parametrize(
        ("item", "where", "phrase"),
        [
            ({key: HINGE[key] for key in ("type", "a", "b")}, "axis", "is missing"),
            (HINGE | {"a": "tip"}, "a", "has no orientation"),
            (HINGE | {"axis": [0, 0, 0]}, "axis", "zero vector"),
            ({"type": "spherical", "a": "tip", "b": [0, 0, 0]}, "b", "are 1 m apart"),
            ({"type": "spherical", "a": [0, 0, 0], "b": "tip"}, "a", "must be text"),
            ({"type": "fixation", "point": "rope.start", "to": "tip"}, "to", "must be a rigid body"),
            (
                {"type": "fixation", "point": "rope.start", "to": "hub", "rotation": "t"},
                "rotation",
                "unknown key",
            ),
        ],
    )
    def test_bad_joints(self, item, where, phrase):
        refused(f"connections[0].{where}", phrase, study, item)

    def test_all_problems_at_once(self):
        error = refused("model", "2 problems", study, SLIDE | {"s": 0.4}, HINGE | {"b": [0, 0, 0]})
        assert "connections[0].s" in str(error)
        assert "connections[1].b" in str(error)

    def test_schema(self):
        definitions = schema()["$defs"]
        for name in ("HingeEntry", "SlideEntry", "FixationEntry", "SphericalEntry"):
            for key, field in definitions[name]["properties"].items():
                assert field.get("description"), f"{name}.{key}"
        assert definitions["SlideEntry"]["required"] == ["type", "point", "along"]


class TestIntegrators:
    @pytest.mark.parametrize("formulation", ["index1", "index2", "ggl"])
    def test_of_the_trapezoidal_rule(self, formulation):
        given = {"type": "trapezoidal", "formulation": formulation}
        settings = study(simulation={"t_end": 1.0, "step": 0.1, "integrator": given}).simulation.integrator
        assert settings == ancf.Trapezoidal(formulation=formulation)

    def test_of_generalized_alpha(self):
        given = {"type": "generalized_alpha", "rho_inf": 0.5, "formulation": "index3"}
        assert integrator_of(given) == ancf.GeneralizedAlpha(rho_inf=0.5, formulation="index3")

    @pytest.mark.parametrize("name", INTEGRATORS)
    def test_keys_are_the_fields(self, name):
        """A setting of a method is a key of its table, with the same default."""
        kind = INTEGRATORS[name]
        given = {key: item.default for key, item in kind.options().items() if item.default is not None}
        assert integrator_of({"type": name, **given}) == integrator_of(name) == kind()
        assert set(kind.options()) <= set(table_schema()["properties"])

    def test_formulations_are_those_of_the_solvers(self):
        from ancf.solvers.formulations import FORMULATIONS as WEIGHTS

        assert set(FORMULATIONS) == set(WEIGHTS)

    @pytest.mark.parametrize(
        ("given", "key", "phrase"),
        [
            ({"type": "trapezoidal", "formulation": "index3"}, "formulation", "multipliers, which oscillate"),
            (
                {"type": "generalized_alpha", "formulation": "index4"},
                "formulation",
                'one of "index1", "index2"',
            ),
            ({"type": "generalized_alpha", "formulation": 3}, "formulation", "must be one of"),
            (
                {"type": "trapezoidal", "rho_inf": 0.5},
                "rho_inf",
                "is a setting of generalized_alpha, not of trap",
            ),
            ({"type": "trapezoidal", "index": 3}, "index", 'allowed: "type", "formulation", "rho_inf"'),
        ],
    )
    def test_bad(self, given, key, phrase):
        simulation = {"t_end": 1.0, "step": 0.1, "integrator": given}
        refused(f"simulation.integrator.{key}", phrase, study, simulation=simulation)

    def test_schema(self):
        table = schema()["$defs"]["SimulationEntry"]["properties"]["integrator"]["anyOf"][1]
        assert table["properties"]["formulation"]["enum"] == ["index1", "index2", "ggl", "index3"]


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("joint", ["hinge", "connect", "universal"])
def test_places_that_do_not_coincide_name_the_point_that_does(joint, seed):
    """What the message advises, followed, is a joint."""
    rng = np.random.default_rng(seed)
    axes, _ = np.linalg.qr(rng.standard_normal((3, 3)))
    axes[:, 2] *= np.linalg.det(axes)
    place = np.round(rng.standard_normal(3), 3)
    model = ancf.Model()
    body = model.add_rigid_body("body", at=rng.standard_normal(3), mass=1.0, inertia=(1, 1, 1), axes=axes)
    more = {
        "hinge": {"axis": (0, 1, 0)},
        "universal": {"axis_a": (1, 0, 0), "axis_b": (0, 1, 0)},
    }.get(joint, {})
    make = getattr(model, joint)
    with pytest.raises(ancf.ModelError, match="must coincide") as caught:
        make(body, place, **more)
    told = re.fullmatch(r"body\.at\((.*), (.*), (.*)\) is there", caught.value.hint)
    near = body.at(*map(float, told.groups()))
    assert near.initial_position == pytest.approx(place, abs=1e-11)
    with pytest.raises(ancf.ModelError) as caught:
        make(near, place + 1.0, **more)
    assert "is there" in caught.value.hint
    make(near, near.initial_position, **more)


@pytest.mark.parametrize("place", [(0, 0, 1), [0.0, 0.0, 1.0], np.array([0.0, 0.0, 1.0])])
@pytest.mark.parametrize("make", ["connect", "add_spring", "hinge"])
def test_a_place_as_the_first_end(make, place):
    model = mixed()
    more = {"add_spring": {"stiffness": 1.0}, "hinge": {"axis": (0, 1, 0)}}.get(make, {})
    with pytest.raises(ancf.ModelError, match="must be a point") as caught:
        getattr(model, make)(place, "hub", **more)
    assert caught.value.hint == "a place in space is the other end, b"
    if make != "add_spring":  # whose ends are apart
        getattr(model, make)("hub", place, **more)


@pytest.mark.parametrize(
    ("joint", "end"),
    [("connect", "start"), ("connect", "end"), ("connect", "at"), ("weld", "start"), ("weld", "end")],
)
@pytest.mark.parametrize("points", [20, 50, 200])
def test_places_that_nearly_coincide_say_how_to_draw_them(joint, end, points):
    """A place on a ring by hand is not that of the ring through sampled points; what is advised is."""
    angle = np.linspace(0, 2 * np.pi, points)
    ring = np.column_stack([5 * np.cos(angle), 5 * np.sin(angle), np.zeros(points)])
    section = ancf.Section(EA=1e6, EI=1e3, rhoA=1.0)
    model = ancf.Model()
    collar = model.add_beam("collar", path=ring, elements=24, section=section, closed=True)
    place = collar.at(collar.length / 12)

    def drawn(name, where):
        if end == "at":
            return model.add_point_mass(name, at=where, mass=1.0)
        ends = {"start": where, "end": np.asarray(where) - [0, 0, 6]}
        if end == "end":
            ends = {"start": ends["end"], "end": where}
        return getattr(model.add_beam(name, **ends, elements=2, section=section), end)

    by_hand = drawn("thing", (5 * np.cos(np.pi / 6), 5 * np.sin(np.pi / 6), 0.0))
    with pytest.raises(ancf.ModelError, match="must coincide") as caught:
        getattr(model, joint)(by_hand, place)
    assert caught.value.hint == f'draw "thing" with {end}={place}.initial_position'
    getattr(model, joint)(drawn("again", place.initial_position), place)
