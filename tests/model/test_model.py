"""The model: what it holds, and one clear error for everything wrong."""

import json
import math
from itertools import pairwise

import numpy as np
import pytest

from ancf.errors import ModelError
from ancf.model import Circle, Clamp, Model, Rectangle, Section
from ancf.model.points import Point
from commands import python
from refusals import helix, refused

WIRE = {"EA": 1e4, "EI": 0.08, "rhoA": 0.05}
NAN, INF = float("nan"), float("inf")


def section():
    return Section(**WIRE)


def cantilever(**changes):
    model = Model(gravity=(0, 0, -9.81))
    given = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 4, "section": section()} | changes
    return model, model.add_beam("beam", **given)


class TestSection:
    def test_direct(self):
        s = Section(**WIRE, damping=0.1, axial_damping=0.2, bending_damping=0.3)
        assert (s.EA, s.EI, s.rhoA) == (1e4, 0.08, 0.05)
        assert (s.damping, s.axial_damping, s.bending_damping) == (0.1, 0.2, 0.3)
        assert s.shape is s.E is s.nu is s.rho is None

    def test_square(self):
        s = Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0, nu=0.3, damping=0.03)
        assert pytest.approx(1e4) == s.EA
        assert pytest.approx(1e8 * 0.01**4 / 12) == s.EI
        assert s.rhoA == pytest.approx(0.05)
        assert s.shape == Rectangle(0.01, 0.01)
        assert (s.E, s.nu, s.rho, s.damping) == (1e8, 0.3, 500.0, 0.03)

    def test_circle(self):
        s = Section.circle(diameter=0.02, E=2e11, rho=7850)
        assert pytest.approx(2e11 * math.pi * 0.01**4 / 4) == s.EI
        assert pytest.approx(2e11 * math.pi * 0.01**2) == s.EA
        assert s.shape == Circle(0.02)

    def test_flat_rectangle_has_two_stiffnesses(self):
        s = Section.rectangle(width=0.02, height=0.01, E=1e8, rho=500)
        assert s.EI_y == pytest.approx(1e8 * 0.02 * 0.01**3 / 12)
        assert s.EI_z == pytest.approx(1e8 * 0.01 * 0.02**3 / 12)
        refused("Section.EI", "give Section(EA=, EI=, rhoA=) directly", lambda: s.EI)
        model = Model()
        refused(
            'add_beam("b").section',
            "one bending stiffness",
            model.add_beam,
            "b",
            start=(0, 0, 0),
            end=(1, 0, 0),
            elements=1,
            section=s,
        )

    def test_frozen(self):
        s = section()
        with pytest.raises(AttributeError):
            s.EA = 1.0
        assert s == section()
        assert hash(s) == hash(section())

    @pytest.mark.parametrize(
        ("key", "value", "phrase"),
        [
            ("EA", 0, "must be > 0, is 0"),
            ("EA", -1.5, "must be > 0, is -1.5"),
            ("EA", NAN, "finite number, is nan"),
            ("EA", INF, "finite"),
            ("EA", 10**400, "finite"),
            ("EA", "1e4", "must be a number"),
            ("EA", True, "must be a number"),
            ("EA", np.bool_(True), "must be a number"),
            ("EA", None, "must be a number"),
            ("EI", -1e-9, "must be >= 0"),
            ("rhoA", 0.0, "must be > 0"),
            ("damping", -1, "must be >= 0"),
            ("axial_damping", NAN, "finite"),
            ("bending_damping", -2, "must be >= 0, is -2"),
        ],
    )
    def test_bad(self, key, value, phrase):
        refused(f"Section.{key}", phrase, lambda: Section(**WIRE | {key: value}))

    @pytest.mark.parametrize(
        ("key", "value"),
        [
            ("width", 0),
            ("height", -1),
            ("E", NAN),
            ("rho", 0),
            ("nu", 0.5),
            ("nu", -1),
            ("nu", "0"),
            ("damping", -1),
        ],
    )
    def test_bad_rectangle(self, key, value):
        given = {"width": 0.1, "height": 0.1, "E": 1e9, "rho": 1e3} | {key: value}
        refused(f"Section.{key}", "must be", lambda: Section.rectangle(**given))

    def test_bad_circle(self):
        refused("Section.diameter", "> 0", Section.circle, diameter=0, E=1, rho=1)
        refused("Section.EI", "> 0", Section.circle, diameter=1e-100, E=1, rho=1)

    def test_bending_may_vanish(self):
        assert Section(**WIRE | {"EI": 0}).EI == 0.0


class TestStraightBeam:
    def test_layout(self):
        _, beam = cantilever()
        assert beam.elements == 4
        assert beam.length == 1.0
        assert beam.stretch == 1.0
        np.testing.assert_allclose(beam.node_x, [0, 0.25, 0.5, 0.75, 1], rtol=1e-15)
        np.testing.assert_allclose(beam.node_position[:, 0], beam.node_x)
        np.testing.assert_array_equal(beam.node_tangent, np.tile([1.0, 0, 0], (5, 1)))
        assert (beam.element, beam.strain, beam.poisson, beam.gauss) == (
            "cable",
            "material",
            "centreline",
            (5, 3),
        )
        np.testing.assert_array_equal(beam.about, beam.node_position[0])

    def test_prestretched(self):
        _, beam = cantilever(end=(0, 3, 4), length=4.0)
        assert beam.length == 4.0
        assert beam.stretch == pytest.approx(1.25)
        np.testing.assert_allclose(beam.node_position[-1], [0, 3, 4], rtol=0)
        np.testing.assert_allclose(beam.node_tangent[2], [0, 0.6, 0.8])
        np.testing.assert_allclose(beam.initial_position(2.0), [0, 1.5, 2.0], atol=1e-15)

    def test_uneven_nodes(self):
        _, beam = cantilever(elements=None, nodes=[0, 0.1, 0.7, 1])
        np.testing.assert_allclose(beam.node_position[:, 0], [0, 0.1, 0.7, 1])
        assert beam.elements == 3

    def test_points(self):
        model, beam = cantilever()
        assert (beam.start.label, beam.start.x) == ("beam.start", 0.0)
        assert (beam.end.label, beam.end.x) == ("beam.end", 1.0)
        assert (beam.at(0.5).label, beam.at(0.5).x) == ("beam.at(0.5)", 0.5)
        assert beam.at(0) == beam.start
        assert beam.at(1) == beam.end != beam.start
        assert len({beam.at(0.5), model.point("beam.at(0.5)"), model.point("beam.at( 5e-1 )")}) == 1
        assert model.point("beam.end") == beam.end
        assert beam.start != "beam.start"
        assert model.body("beam") is beam

    @pytest.mark.parametrize("x", [-0.1, 1.1, NAN, "0.5", True])
    def test_bad_point(self, x):
        _, beam = cantilever()
        refused("beam.at", "0 <= x <= 1 m" if x in (-0.1, 1.1) else "must be a", beam.at, x)

    def test_motion(self):
        _, beam = cantilever()
        beam.set_motion(velocity=(1, 0, 0), angular_velocity=[0, 0, 4], about=(0.5, 0, 0))
        np.testing.assert_array_equal([beam.velocity, beam.angular_velocity], [[1, 0, 0], [0, 0, 4]])
        np.testing.assert_array_equal(beam.about, [0.5, 0, 0])
        beam.set_motion()
        np.testing.assert_array_equal(beam.about, [0, 0, 0])

    @pytest.mark.parametrize("key", ["velocity", "angular_velocity", "about"])
    @pytest.mark.parametrize("value", [(1, 2), (1, 2, NAN), 3, "abc", (0, 0, True)])
    def test_bad_motion(self, key, value):
        _, beam = cantilever()
        with pytest.raises(ModelError) as caught:
            beam.set_motion(**{key: value})
        assert caught.value.where.startswith(f'set_motion("beam").{key}')


BAD_BEAMS = [
    ({"elements": 0}, "elements", "between 1 and 1000000, is 0"),
    ({"elements": -3}, "elements", "is -3"),
    ({"elements": 1_000_001}, "elements", "is 1000001"),
    ({"elements": 4.0}, "elements", "whole number"),
    ({"elements": True}, "elements", "whole number"),
    ({"elements": "4"}, "elements", "whole number"),
    ({"elements": None}, "elements", "is missing"),
    ({"nodes": [0, 1]}, "elements", "not both"),
    ({"elements": None, "nodes": [0]}, "nodes", "has 1 nodes"),
    ({"elements": None, "nodes": [0, 0.5]}, "nodes", "must go from 0 to the length 1 m"),
    ({"elements": None, "nodes": [0.1, 1]}, "nodes", "must go from 0"),
    ({"elements": None, "nodes": [0, 0.5, 1 + 1e-7]}, "nodes", "length 1 m (length= sets it; that of a path"),
    ({"elements": None, "nodes": [0, 0.5, 0.5, 1]}, "nodes[2]", "increasing"),
    ({"elements": None, "nodes": [0, 0.7, 0.5, 1]}, "nodes[2]", "0.5 follows 0.7"),
    ({"elements": None, "nodes": [0, NAN, 1]}, "nodes[1]", "finite"),
    ({"elements": None, "nodes": [[0, 1]]}, "nodes[0]", "must be a number"),
    ({"elements": None, "nodes": np.array([[0.0, 1.0]])}, "nodes", "has shape (1, 2), wanted (n,)"),
    ({"elements": None, "nodes": np.array(["0", "1"])}, "nodes", "must hold numbers"),
    ({"start": None}, "start", "is missing"),
    ({"end": None}, "end", "is missing"),
    ({"start": (1, 0, 0)}, "end", "coincides with start"),
    ({"start": (1e9, 0, 0), "end": (1e9 + 1e-6, 0, 0)}, "end", "coincides with start"),
    ({"start": (1, 2)}, "start", "has shape (2,), wanted (3,)"),
    ({"start": (1, 2, "3")}, "start[2]", "must be a number"),
    ({"start": (1, NAN, 3)}, "start[1]", "finite"),
    ({"start": np.array([1, INF, 3])}, "start[1]", "finite"),
    ({"start": 5}, "start", "list of three numbers"),
    ({"start": (1e308, 0, 0), "end": (-1e308, 0, 0)}, "start", "within 1e+100 m"),
    ({"length": 0}, "length", "must be > 0, is 0"),
    ({"length": -1.0}, "length", "must be > 0"),
    ({"length": NAN}, "length", "finite"),
    ({"length": 1e-9}, "length", "initial shape of 1 m"),
    ({"section": None}, "section", "must be a Section"),
    ({"section": {"EA": 1}}, "section", "must be a Section"),
    ({"element": "orignal"}, "element", 'must be one of "cable", "original", "nonlocking"'),
    ({"element": 1}, "element", 'must be one of "cable"'),
    ({"strain": "papr"}, "strain", 'did you mean "paper"?'),
    ({"poisson": "none"}, "poisson", '"centreline", "full"'),
    ({"natural_shape": "curved"}, "natural_shape", '"path", "straight"'),
    ({"gauss": (0, 3)}, "gauss[0]", "between 1 and 10"),
    ({"gauss": (5, 3.0)}, "gauss[1]", "whole number"),
    ({"gauss": 5}, "gauss", "two counts"),
    ({"path": [(0, 0, 0), (1, 0, 0), (2, 0, 0)]}, "path", "not both"),
]


@pytest.mark.parametrize(("changes", "key", "phrase"), BAD_BEAMS)
def test_bad_beam(changes, key, phrase):
    with pytest.raises(ModelError) as caught:
        cantilever(**changes)
    assert caught.value.where == f'add_beam("beam").{key}'
    assert phrase in str(caught.value)


def corner(u):
    return (u, abs(u - 0.4321), 0)


BAD_PATHS = [
    ([(0, 0, 0), (1, 0, 0)], "path", "needs at least 3"),
    ([(0, 0), (1, 0), (2, 0)], "path", "wanted (n, 3)"),
    ([(0, 0, 0), (1, 0), (2, 0, 0)], "path[1]", "has shape (2,)"),
    ([(0, 0, 0), (1, 0, 0), (1, 0, 0)], "path[2]", "coincides with path[1]"),
    ([(0, 0, 0), (1, NAN, 0), (2, 0, 0)], "path[1][1]", "finite"),
    ([(0, 0, 0), 3, (2, 0, 0)], "path[1]", "list of numbers"),
    ("circle", "path", "list of numbers"),
    (lambda u: (u, 0), "path", "at u = 0 the function returned shape (2,)"),
    (lambda u: (u, 0, 1 / u), "path", "at u = 0 the function raised ZeroDivisionError"),
    (lambda u: (1, 2, 3), "path", "has no length"),
    (lambda u: (u**2, 0, 0), "path", "has no tangent 0 m from its start"),
    (lambda u: (math.sin(2 * math.pi * u), 0, 0), "path", "stops or turns back there"),
    (corner, "path", "not smooth"),
]


@pytest.mark.parametrize(("path", "key", "phrase"), BAD_PATHS)
def test_bad_path(path, key, phrase):
    with pytest.raises(ModelError) as caught:
        Model().add_beam("beam", path=path, elements=4, section=section())
    assert caught.value.where == f'add_beam("beam").{key}'
    assert phrase in str(caught.value)


def circle(angle):
    return np.stack([2 * np.cos(angle), 2 * np.sin(angle), 0 * angle], axis=-1)


def helix_tangent(angle):
    return np.stack([-np.sin(angle), np.cos(angle), 0.5 + 0 * angle], axis=-1) / math.sqrt(1.25)


class TestPath:
    def test_function_is_read_at_true_arc_length(self):
        # uneven speed in u: the nodes must still sit at equal arc lengths
        beam = Model().add_beam(
            "beam", path=lambda u: helix(np.float64(3 * (u + u**2) / 2)), elements=7, section=section()
        )
        assert beam.length == pytest.approx(3 * math.sqrt(1.25), rel=1e-10)
        angle = np.linspace(0, 3, 8)
        np.testing.assert_allclose(beam.node_position, helix(angle), atol=1e-10)
        np.testing.assert_allclose(beam.node_tangent, helix_tangent(angle), atol=1e-8)
        np.testing.assert_allclose(np.linalg.norm(beam.node_tangent, axis=1), 1.0, rtol=1e-14)

    @pytest.mark.parametrize(("shape", "length"), [(circle, 2 * 1.5), (helix, 1.5 * math.sqrt(1.25))])
    def test_points_converge_with_order_four(self, shape, length):
        errors = []
        for count in (21, 41):
            # uneven points, so that chord and arc length differ
            angle = 1.5 * (np.linspace(0, 1, count) + 0.2 * np.sin(np.pi * np.linspace(0, 1, count)))
            beam = Model().add_beam("beam", path=shape(angle), elements=6, section=section())
            errors.append(np.max(np.abs(beam.node_position - shape(np.linspace(0, 1.5, 7)))))
        assert beam.length == pytest.approx(length, rel=1e-6)
        assert errors[1] < 1e-6
        assert math.log2(errors[0] / errors[1]) > 3.5

    def test_spline_passes_the_points_at_its_own_arc_lengths(self):
        from ancf.model.bodies.path import interpolated

        curve = interpolated(circle(np.linspace(0, 1.5, 9)), "path")
        position, tangent = curve.at(curve.knot_lengths)
        np.testing.assert_allclose(position, circle(np.linspace(0, 1.5, 9)), atol=1e-12)
        # the arc length between nodes, by a fine polygon with Richardson extrapolation
        s = np.linspace(0, curve.length, 4001)
        fine = curve.at(s)[0]
        polygon = [np.linalg.norm(np.diff(fine[::k], axis=0), axis=1).sum() for k in (1, 2)]
        assert (4 * polygon[0] - polygon[1]) / 3 == pytest.approx(curve.length, rel=1e-10)
        chords = np.linalg.norm(np.diff(fine, axis=0), axis=1)
        np.testing.assert_allclose(chords, curve.length / 4000, rtol=1e-7)
        np.testing.assert_allclose(np.linalg.norm(tangent, axis=1), 1.0, rtol=1e-14)

    def test_three_points_on_a_line(self):
        model = Model()
        beam = model.add_beam("beam", path=[(0, 0, 0), (1, 0, 0), (4, 0, 0)], elements=4, section=section())
        np.testing.assert_allclose(beam.node_position[:, 0], np.linspace(0, 4, 5), atol=1e-12)

    def test_length_and_uneven_nodes(self):
        angle = np.linspace(0, math.pi / 2, 200)
        beam = Model().add_beam(
            "arc",
            path=circle(angle),
            nodes=[0, 1, 2.5],
            length=2.5,
            section=section(),
            natural_shape="straight",
        )
        assert beam.natural_shape == "straight"
        assert beam.stretch == pytest.approx(math.pi / 2.5, rel=1e-8)
        np.testing.assert_allclose(beam.node_position[1], circle(np.array(math.pi / 5)), atol=1e-8)
        np.testing.assert_allclose(beam.initial_position(1.0), beam.node_position[1], atol=1e-14)
        np.testing.assert_allclose(beam.initial_tangent(1.0), beam.node_tangent[1], atol=1e-14)


class TestSupports:
    def test_all_kinds(self):
        model, beam = cantilever()
        clamp = model.clamp(beam.start, rotation=lambda t: t, axis=(0, 0, 2), name="wall")
        pin = model.pin(beam.at(0.5), displacement=(0, 0, "0.1*ramp(t, 0, 1)"))
        hold = model.hold("beam.end", position="z", slope="zy")
        assert model.supports == [clamp, pin, hold]
        assert isinstance(clamp, Clamp)
        np.testing.assert_array_equal(clamp.axis, [0, 0, 1])
        assert (clamp.stretch, clamp.rotation_rate, clamp.rotation_acceleration, clamp.displacement) == (
            "free",
            None,
            None,
            None,
        )
        assert clamp.rotation(2.0)[0] == 2.0
        assert clamp.rotation.where == 'clamp("wall").rotation'
        assert (pin.name, pin.displacement.constant) == ("pin at beam.at(0.5)", False)
        assert (hold.position, hold.slope, hold.name) == ("z", "yz", "hold at beam.end")

    def test_exact_derivatives(self):
        model, beam = cantilever()
        clamp = model.clamp(beam.end, rotation="t**2", rotation_rate="2*t", rotation_acceleration=2)
        assert (clamp.rotation_rate(3.0)[0], clamp.rotation_acceleration(3.0)[0]) == (6.0, 2.0)

    @pytest.mark.parametrize(
        ("given", "key", "phrase"),
        [
            ({"stretch": "loose"}, "stretch", '"free", "fixed"'),
            ({"rotation": "tt"}, "rotation", "unknown name"),
            ({"rotation": lambda t: (1, 2, 3)}, "rotation", "wanted a number"),
            ({"rotation": "t", "rotation_rate": 1}, "rotation_acceleration", "give both"),
            ({"rotation": "t", "rotation_acceleration": 1}, "rotation_rate", "give both"),
            ({"rotation_rate": 1, "rotation_acceleration": 0}, "rotation", "is missing"),
            ({"axis": (0, 0, 0)}, "axis", "zero vector"),
            ({"axis": (0, 1)}, "axis", "wanted (3,)"),
            ({"displacement": (0, 1)}, "displacement", "has 2 components"),
            ({"name": 5}, "name", "must be text"),
            ({"name": ""}, "name", "printable"),
            ({"name": " a"}, "name", "printable"),
        ],
    )
    def test_bad_clamp(self, given, key, phrase):
        model, beam = cantilever()
        with pytest.raises(ModelError) as caught:
            model.clamp(beam.start, **given)
        call = f'clamp("{given["name"]}")' if isinstance(given.get("name"), str) else "clamp(beam.start)"
        assert caught.value.where == f"{call}.{key}"
        assert phrase in str(caught.value)
        assert model.supports == []

    @pytest.mark.parametrize(
        ("given", "key", "phrase"),
        [
            ({}, "position", "nothing is held"),
            ({"position": "w"}, "position", 'letters of "xyz"'),
            ({"slope": "xx"}, "slope", "at most once"),
            ({"position": 1}, "position", "must be text"),
        ],
    )
    def test_bad_hold(self, given, key, phrase):
        model, beam = cantilever()
        refused(f"hold(beam.end).{key}", phrase, model.hold, beam.end, **given)

    def test_only_at_nodes(self):
        model, beam = cantilever()
        error = refused("pin(beam.at(0.3)).point", "0.25 m and 0.5 m", model.pin, beam.at(0.3))
        assert "nodes=" in error.hint
        assert model.pin(beam.at(0.25 + 1e-12)).point.body is beam

    def test_nothing_is_held_twice(self):
        model, beam = cantilever()
        model.clamp(beam.start)
        where, what = (
            "pin(beam.start).point",
            '"pin at beam.start" and "clamp at beam.start" both hold position x',
        )
        refused(where, what, model.pin, beam.at(0))
        refused("hold(beam.start).point", "slope y", model.hold, beam.start, slope="y")
        model.hold(beam.end, position="x")
        model.hold(beam.end, position="z", slope="z")
        refused("hold(beam.end).point", "both hold position z", model.hold, beam.end, position="yz")
        again = '"clamp at beam.start" clamps beam.start already'
        refused("clamp(beam.start).point", again, model.clamp, beam.start)
        refused('clamp("two").point', again, model.clamp, beam.at(0), name="two")
        assert [s.name for s in model.supports] == [
            "clamp at beam.start",
            "hold at beam.end",
            "hold at beam.end #2",
        ]


class TestLoads:
    def test_all_kinds(self):
        model, beam = cantilever()
        force = model.add_force(beam.at(0.3), (0, 0, -1))
        moment = model.add_moment(beam.end, lambda t: (0, t, 0))
        load = model.add_distributed_load(beam, (0, "t", 0), between=(0.1, 0.4))
        whole = model.add_distributed_load("beam", (0, 1, 0))
        assert model.loads == [force, moment, load, whole]
        assert (force.name, moment.name) == ("force at beam.at(0.3)", "moment at beam.end")
        assert (load.name, whole.name) == ("load on beam", "load on beam #2")
        assert (load.between, whole.between) == ((0.1, 0.4), (0.0, 1.0))
        assert force.force.where == "add_force(beam.at(0.3)).force"

    def test_bad_force(self):
        model, beam = cantilever()
        refused("add_force(beam.end).force", "wanted 3", model.add_force, beam.end, (1, 2))
        what = "returned shape (2,), wanted (3,)"
        refused("add_force(beam.end).force", what, model.add_force, beam.end, lambda t: (1, 2))
        refused("add_force(beam.end).force", "raised KeyError", model.add_force, beam.end, lambda t: {}[t])
        refused("add_force(beam.end).force[2]", "finite", model.add_force, beam.end, (0, 0, NAN))
        refused('add_force("f").force', "list of 3", model.add_force, beam.end, 5, name="f")
        assert model.loads == []

    def test_cable_takes_no_torque(self):
        model, beam = cantilever(end=(1, 2, 2))
        where = "add_moment(beam.at(0.5)).moment"
        refused(where, "torque", model.add_moment, beam.at(0.5), (-0.1, -0.2, -0.2))
        model.add_moment(beam.at(0.5), (0.1, 0.2, 0.21))
        model.add_moment(beam.at(0.5), (0, 0, 0))

    @pytest.mark.parametrize(
        ("between", "phrase"),
        [
            ((0.5, 0.5), "0 <= x0 < x1 <= 1 m"),
            ((0.6, 0.5), "0 <= x0 < x1"),
            ((-0.1, 0.5), "0 <= x0"),
            ((0, 1.1), "x1 <= 1 m"),
            ((0, 0.5, 1), "wanted (2,)"),
            (0.5, "list of numbers"),
        ],
    )
    def test_bad_between(self, between, phrase):
        model, beam = cantilever()
        where = "add_distributed_load(beam).between"
        refused(where, phrase, model.add_distributed_load, beam, (0, 0, 1), between=between)

    def test_bad_body(self):
        model, _ = cantilever()
        refused("add_distributed_load().body", "must be a body", model.add_distributed_load, None, (0, 0, 1))
        where = "add_distributed_load(baem).body"
        refused(where, 'did you mean "beam"?', model.add_distributed_load, "baem", (0, 0, 1))


class TestConnections:
    def two(self):
        model, first = cantilever()
        return (
            model,
            first,
            model.add_beam("b", start=(1, 0, 0), end=(1, 1, 0), elements=2, section=section()),
        )

    def test_spherical(self):
        model, first, second = self.two()
        joint = model.connect(first.end, second.start)
        assert model.connections == [joint]
        assert joint.name == "joint of beam.end and b.start"
        refused("connect(b.start).b", "already", model.connect, second.start, first.end)
        model.connections.remove(joint)
        assert model.connections == [model.connect(second.start, first.end, name="again")]

    def test_joints_are_compared_in_a_time_that_goes_with_their_count(self, monkeypatch):
        compared = []
        equal = Point.__eq__
        monkeypatch.setattr(Point, "__eq__", lambda one, two: compared.append(one) or equal(one, two))
        counts = []
        for count in (40, 80):
            model = Model()
            masses = [model.add_point_mass(f"m{k}", at=(0, 0, 0), mass=1.0) for k in range(count)]
            compared.clear()
            for one, two in pairwise(masses):
                model.connect(one, two)
            counts.append(len(compared))
            refused("connect(m7).b", "already", model.connect, masses[7], masses[6])
        assert counts[1] <= 2 * counts[0] + 40

    def test_bad_spherical(self):
        model, first, second = self.two()
        refused("connect(beam.end).b", "are 1 m apart", model.connect, first.end, second.end)
        refused("connect(beam.at(0.3)).b", "m apart", model.connect, first.at(0.3), second.end)
        refused("connect(beam.end).b", "same node", model.connect, first.end, first.at(1.0))
        refused("connect(beam.at(0.3)).b", "same point", model.connect, first.at(0.3), first.at(0.3))
        refused("connect(beam.end).b", "has shape (2,), wanted (3,)", model.connect, first.end, (1, 0))
        refused("connect().a", "must be a point", model.connect, (1, 0, 0), first.end)

    def test_spring(self):
        model, first, second = self.two()
        spring = model.add_spring(first.at(0.3), second.end, stiffness=10)
        assert spring.length == pytest.approx(math.hypot(0.7, 1.0))
        assert (spring.damping, spring.slack) == (0.0, False)
        assert spring.name == "spring from beam.at(0.3) to b.end"
        ground = model.add_spring(
            first.end, (1, 0, 2), stiffness=0, damping=3, length=0.5, slack=True, name="dropper"
        )
        assert (ground.length, ground.slack, ground.name) == (0.5, True, "dropper")
        np.testing.assert_array_equal(ground.b, [1, 0, 2])

    @pytest.mark.parametrize(
        ("given", "key", "phrase"),
        [
            ({"stiffness": -1}, "stiffness", "must be >= 0"),
            ({"stiffness": NAN}, "stiffness", "finite"),
            ({"stiffness": 0}, "stiffness", "both 0"),
            ({"damping": -1}, "damping", "must be >= 0"),
            ({"length": -1}, "length", "must be >= 0"),
            ({"slack": 1}, "slack", "True or False"),
            ({"b": (1, 0, 0)}, "b", "coincide"),
            ({"b": (1, 0)}, "b", "wanted (3,)"),
            ({"b": "beam.middle"}, "b", "is no point"),
            ({"b": None}, "b", "list of numbers"),
        ],
    )
    def test_bad_spring(self, given, key, phrase):
        model, first, _ = self.two()
        arguments = {"b": (0, 0, 1), "stiffness": 1.0} | given
        refused(f"add_spring(beam.end).{key}", phrase, lambda: model.add_spring(first.end, **arguments))


class TestNames:
    @pytest.mark.parametrize("name", ["", " beam", "a.b", "a/b", "a(1)", "a\nb", "beam "])
    def test_bad_body_name(self, name):
        where = f'add_beam("{name}").name'
        given = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 1, "section": section()}
        refused(where, "must be letters", Model().add_beam, name, **given)

    def test_name_that_is_no_text(self):
        given = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 1, "section": section()}
        refused("add_beam().name", "must be text", Model().add_beam, 3, **given)

    def test_names_are_unique_over_the_whole_model(self):
        model, beam = cantilever()
        model.add_force(beam.end, (0, 0, 1), name="push")
        given = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 1, "section": section()}
        refused('add_beam("beam").name', "name of a body already", model.add_beam, "beam", **given)
        refused('add_beam("push").name', "name of a load already", model.add_beam, "push", **given)
        refused('pin("beam").name', "name of a body already", model.pin, beam.end, name="beam")
        refused('add_force("push").name', "already", model.add_force, beam.end, (0, 0, 1), name="push")

    def test_automatic_names_are_numbered(self):
        model, beam = cantilever()
        names = [model.add_force(beam.end, (0, 0, 1)).name for _ in range(3)]
        assert names == ["force at beam.end", "force at beam.end #2", "force at beam.end #3"]

    def test_unknown_names_list_the_right_ones(self):
        model, _ = cantilever()
        refused("Model.body", "the model has none yet", Model().body, "beam")
        error = refused("Model.body", 'known: "beam"', model.body, "beem")
        assert error.hint == 'did you mean "beam"?'
        refused("Model.point", 'known: "beam"', model.point, "wire.end")
        refused("Model.point", "is no point", model.point, "beam")
        refused("Model.point", "is no point", model.point, "beam.middle")
        refused("Model.point", "is no arc length", model.point, "beam.at(half)")
        refused("Model.point", "outside the beam", model.point, "beam.at(2)")
        refused("Model.point", "finite", model.point, "beam.at(nan)")
        refused("Model.point", "must be a point", model.point, 3)

    def test_parts_of_another_model(self):
        model, _ = cantilever()
        _, stranger = cantilever()
        refused("pin(beam.end).point", "another model", model.pin, stranger.end)
        refused(
            "add_distributed_load(beam).body",
            "another model",
            model.add_distributed_load,
            stranger,
            (0, 0, 1),
        )


class TestModel:
    @pytest.mark.parametrize("gravity", [(0, 0), 9.81, (0, 0, NAN), (0, 0, "g"), None, (0, 0, True)])
    def test_bad_gravity(self, gravity):
        with pytest.raises(ModelError) as caught:
            Model(gravity=gravity)
        assert caught.value.where.startswith("Model.gravity")

    def test_bad_title(self):
        refused("Model.title", "must be text", Model, title=3)

    def test_size(self):
        model, _ = cantilever(end=(1, -3, 2))
        assert model.size == 3.0
        model.add_beam("b", start=(0, 0, 0), end=(0, 4, 0), elements=1, section=section())
        assert model.size == 7.0
        assert Model().size == 0.0

    def test_located_names_another_place(self):
        model, beam = cantilever()
        with model.located("loads[3]"):
            refused("loads[3].force", "wanted 3", model.add_force, beam.end, (1, 2))
            force = model.add_force(beam.end, (0, 0, "1/(1 - t)"))
        refused("loads[3].force", "at t = 1 s", force.force, 1.0)
        refused("add_force(beam.end).force", "wanted 3", model.add_force, beam.end, (1, 2))

    def test_description_is_plain(self):
        def theta(t):
            return t

        model, beam = cantilever()
        arc = model.add_beam(
            "arc", path=circle(np.linspace(0, 1, 9)), nodes=[0, 0.5, 2], length=2, section=section()
        )
        model.clamp(beam.start, rotation=theta)
        model.add_distributed_load(beam, (0, 0, "t"))
        model.add_spring(beam.end, arc.end, stiffness=1)
        plain = json.loads(json.dumps(model.to_dict()))
        assert [body["name"] for body in plain["bodies"]] == ["beam", "arc"]
        assert plain["gravity"] == [0, 0, -9.81]
        assert plain["supports"][0]["rotation"] == "<function theta>"
        assert plain["supports"][0]["type"] == "clamp"
        assert plain["loads"][0]["load"] == [0, 0, "t"]
        assert plain["loads"][0]["between"] == [0, 1]
        assert plain["connections"][0]["a"] == "beam.end"
        assert plain["bodies"][1]["nodes"] == [0, 0.5, 2]
        assert len(plain["bodies"][1]["node_position"]) == 3
        assert "node_position" not in plain["bodies"][0]
        assert plain["bodies"][0]["section"]["EA"] == 1e4


def test_import_stays_light():
    code = "import sys, ancf.model; print([m for m in ('pydantic', 'scipy', 'numba') if m in sys.modules])"
    assert python(code).out.strip() == "[]"
