"""The model of the two beams with a cross-section: axes, points, supports, loads, and what is wrong."""

import json
import math

import numpy as np
import pytest

from ancf.cli.info_model import _bodies
from ancf.model import Model, Section
from helpers import arc
from refusals import flat, helix, refused

BEAMS = ("original", "nonlocking")
NAN = float("nan")


def square():
    return Section.rectangle(width=0.02, height=0.02, E=1e8, rho=500.0, nu=0.3)


def pipe():
    return Section.from_moments(A=1e-3, I_y=1e-7, I_z=1e-7, J=2e-7, E=2e11, rho=7850)


def cantilever(**changes):
    model = Model(gravity=(0, 0, -9.81))
    given = {"start": (0, 0, 0), "end": (1, 0, 0), "elements": 4, "section": flat(), "element": "original"}
    return model, model.add_beam("beam", **given | changes)


def curved(path, **changes):
    given = {"path": path, "elements": 8, "section": flat(), "element": "nonlocking"}
    return Model().add_beam("beam", **given | changes)


def assert_orthonormal(beam):
    triads = np.stack([beam.node_tangent, beam.node_y, beam.node_z], axis=1)
    np.testing.assert_allclose(
        triads @ triads.transpose(0, 2, 1), np.tile(np.eye(3), (len(triads), 1, 1)), atol=1e-14
    )
    np.testing.assert_allclose(np.linalg.det(triads), 1.0)


class TestAxesOfStraightBeams:
    @pytest.mark.parametrize(
        ("end", "y"),
        [
            ((1, 0, 0), (0, 1, 0)),
            ((-1, 0, 0), (0, -1, 0)),
            ((0, 2, 0), (-1, 0, 0)),
            ((0, 0, 1), (0, 1, 0)),
            ((0, 0, -3), (0, 1, 0)),
            ((1e-7, 0, 1), (0, 1, 0)),
            ((1, 1, math.sqrt(2)), (-math.sqrt(0.5), math.sqrt(0.5), 0)),
        ],
    )
    @pytest.mark.parametrize("element", ["cable", *BEAMS])
    def test_default(self, end, y, element):
        _, beam = cantilever(end=end, element=element, section=square())
        np.testing.assert_allclose(beam.node_y, np.tile(y, (5, 1)), atol=1e-7)
        assert_orthonormal(beam)

    def test_along_x_is_exact(self):
        _, beam = cantilever()
        np.testing.assert_array_equal(beam.node_y, np.tile([0.0, 1, 0], (5, 1)))
        np.testing.assert_array_equal(beam.node_z, np.tile([0.0, 0, 1], (5, 1)))

    def test_given_is_made_normal(self):
        _, beam = cantilever(y_axis=(5, 3, 4))
        np.testing.assert_allclose(beam.node_y, np.tile([0, 0.6, 0.8], (5, 1)), atol=1e-15)
        assert_orthonormal(beam)

    @pytest.mark.parametrize(
        ("y_axis", "place", "phrase"),
        [
            ((2, 0, 0), "", "is along the tangent at the start"),
            ((-1, 1e-7, 0), "", "is along the tangent"),
            ((0, 0, 0), "", "zero vector"),
            ((0, 1), "", "wanted (3,)"),
            ((0, NAN, 1), "[1]", "finite"),
            ("y", "", "list of three numbers"),
        ],
    )
    def test_bad(self, y_axis, place, phrase):
        refused(f'add_beam("beam").y_axis{place}', phrase, cantilever, y_axis=y_axis)


def frenet(angle):
    """Normal and binormal of the helix."""
    one = 0 * angle
    normal = np.stack([-np.cos(angle), -np.sin(angle), one], axis=-1)
    binormal = np.stack([0.5 * np.sin(angle), -0.5 * np.cos(angle), one + 1], axis=-1) / math.sqrt(1.25)
    return normal, binormal


class TestAxesAlongPaths:
    @pytest.mark.parametrize(("turns", "elements"), [(0.4, 2), (0.4, 7), (3.0, 24), (60.0, 480)])
    def test_helix_turns_back_by_its_torsion(self, turns, elements):
        """Axes that do not turn about the tangent turn by -tau ds against normal and binormal."""
        angle = np.linspace(0, 2 * np.pi * turns, elements + 1)
        path = lambda u: helix(2 * np.pi * turns * np.float64(u))  # noqa: E731
        beam = curved(path, elements=elements, y_axis=(-1, 0.2, 0.3))
        normal, binormal = frenet(angle)
        turned = np.arctan2(np.sum(beam.node_y * binormal, 1), np.sum(beam.node_y * normal, 1))
        wanted = turned[0] - 0.5 / math.sqrt(1.25) * angle  # tau ds = 0.5/1.25 * sqrt(1.25) d angle
        error = np.exp(1j * turned) - np.exp(1j * wanted)
        assert np.max(np.abs(error)) < 1e-7 * max(1.0, turns)
        assert_orthonormal(beam)

    @pytest.mark.parametrize("element", ["cable", *BEAMS])
    def test_do_not_depend_on_the_mesh(self, element):
        fine = curved(arc, elements=64, element=element, section=square())
        for elements in (2, 4, 16):
            coarse = curved(arc, elements=elements, element=element, section=square())
            np.testing.assert_allclose(coarse.node_y, fine.node_y[:: 64 // elements], atol=1e-9)
        nodes = fine.length * np.array([0, 0.25, 0.375, 1])
        uneven = curved(arc, elements=None, nodes=nodes, element=element, section=square())
        np.testing.assert_allclose(uneven.node_y, fine.node_y[[0, 16, 24, 64]], atol=1e-9)

    def test_plane_curves(self):
        """In a horizontal plane z stays up; in a vertical one y stays horizontal, upside down too."""
        angle = np.linspace(0, 1.9 * np.pi, 60)
        c, s, o = np.cos(angle), np.sin(angle), 0 * angle
        flat_ring = curved(np.stack([c, s, o], 1), elements=20)
        np.testing.assert_allclose(flat_ring.node_z, np.tile([0, 0, 1], (21, 1)), atol=1e-12)
        loop = curved(np.stack([s, o, -c], 1), elements=20)
        np.testing.assert_allclose(loop.node_y, np.tile([0, 1, 0], (21, 1)), atol=1e-12)

    def test_straight_path_with_an_axis(self):
        beam = curved([(0, 0, 0), (1, 0, 0), (4, 0, 0)], y_axis=(0, 0, 1))
        np.testing.assert_allclose(beam.node_y, np.tile([0, 0, 1], (9, 1)), atol=1e-12)

    def test_a_turned_path_turns_the_axes(self):
        angle, k = 0.7, np.array([0.6, 0.0, 0.8])
        K = np.cross(np.eye(3), k)
        R = np.eye(3) - np.sin(angle) * K + (1 - np.cos(angle)) * K @ K
        one = curved(arc, y_axis=(0, 1, 0.3))
        two = curved(lambda u: R @ arc(u), y_axis=R @ (0, 1, 0.3))
        np.testing.assert_allclose(two.node_y, one.node_y @ R.T, atol=1e-9)

    def test_bad_axis(self):
        tangent = curved(arc).node_tangent[0]
        refused('add_beam("beam").y_axis', "along the tangent", curved, arc, y_axis=tangent)

    @pytest.mark.parametrize("element", BEAMS)
    def test_an_element_may_not_turn_too_far(self, element):
        def ring(u):
            return (np.cos(2 * np.pi * u), np.sin(2 * np.pi * u), 0.0)

        for elements, angle in ((1, "360"), (2, "180")):
            where = 'add_beam("beam").elements'
            what = f"element 0 of the initial shape turns by {angle} degrees"
            refused(where, what, curved, ring, elements=elements, element=element)
        assert curved(ring, elements=4, element=element).elements == 4
        assert curved(ring, elements=1, element="cable", section=square()).elements == 1


class TestShapeInside:
    def test_middle_axes(self):
        """They are normal to the cubic and come near the path's axes with the mesh."""
        errors = []
        for elements in (8, 16, 32):
            beam, fine = curved(arc, elements=elements), curved(arc, elements=2 * elements)
            middle = 0.5 * (beam.node_x[1:] + beam.node_x[:-1])
            tangent = np.array([beam.initial_tangent(x) for x in middle])
            triads = np.concatenate([tangent[:, None], beam.middle_axes], axis=1)
            product = triads @ triads.transpose(0, 2, 1)
            np.testing.assert_allclose(product, np.tile(np.eye(3), (elements, 1, 1)), atol=1e-13)
            errors.append(np.max(np.abs(beam.middle_axes[:, 0] - fine.node_y[1::2])))
        assert errors[-1] < 1e-5
        assert math.log2(errors[-2] / errors[-1]) > 2.7

    @pytest.mark.parametrize("element", BEAMS)
    def test_initial_axes_and_positions(self, element):
        beam = curved(arc, element=element, length=1.1)
        for i, x in enumerate(beam.node_x):
            axes = np.stack([beam.node_y[i], beam.node_z[i]])
            np.testing.assert_allclose(beam.initial_axes(x), axes, atol=1e-12)
            wanted = beam.node_position[i] + 0.01 * axes[0] - 0.02 * axes[1]
            np.testing.assert_allclose(beam.initial_position(x, 0.01, -0.02), wanted, atol=1e-14)
        for e, x in enumerate(0.5 * (beam.node_x[1:] + beam.node_x[:-1])):
            ends = np.stack([beam.node_y, beam.node_z], axis=1)[e : e + 2]
            middle = beam.middle_axes[e] if element == "nonlocking" else ends.mean(axis=0)
            np.testing.assert_allclose(beam.initial_axes(x), middle, atol=1e-14)
        x = 0.3 * beam.length
        np.testing.assert_array_equal(beam.initial_position(x), beam.initial_position(x, 0.0, 0.0))

    def test_axes_inside_converge(self):
        """The quadratic of the nonlocking element is one order better than the straight line."""
        x = np.linspace(0, 1, 41)
        exact = curved(arc, elements=2560)
        orders = {}
        for element in BEAMS:
            errors = []
            for elements in (8, 16, 32):
                beam = curved(arc, elements=elements, element=element)
                error = [beam.initial_axes(beam.length * s) - exact.initial_axes(exact.length * s) for s in x]
                errors.append(np.max(np.abs(error)))
            orders[element] = math.log2(errors[0] / errors[-1]) / 2
        assert 1.8 < orders["original"] < 2.2
        assert 2.7 < orders["nonlocking"] < 3.5


class TestWords:
    @pytest.mark.parametrize("element", BEAMS)
    @pytest.mark.parametrize("strain", [None, "green"])
    def test_defaults(self, element, strain):
        _, beam = cantilever(element=element, strain=strain)
        assert (beam.element, beam.strain, beam.poisson, beam.gauss) == (
            element,
            "green",
            "centreline",
            (5, 3),
        )

    def test_poisson(self):
        _, beam = cantilever(poisson="full")
        G, s = 1e8 / 2.6, flat()
        assert beam.poisson == "full"
        assert beam.torsional_stiffness == pytest.approx(G * (s.I_y + s.I_z))
        assert cantilever()[1].torsional_stiffness == pytest.approx(G * s.J)
        assert cantilever(element="cable", section=square())[1].torsional_stiffness == 0.0

    @pytest.mark.parametrize(
        ("changes", "key", "phrase"),
        [
            ({"element": "orignal"}, "element", 'did you mean "original"?'),
            ({"element": "solid"}, "element", '"cable", "original", "nonlocking"'),
            ({"strain": "paper"}, "strain", '"paper" is a strain measure of cables'),
            ({"strain": "material"}, "strain", '"material" is a strain measure of cables'),
            ({"strain": "gren"}, "strain", 'did you mean "green"?'),
            ({"strain": 3}, "strain", 'must be one of "green"'),
            ({"strain": np.zeros(2)}, "strain", 'must be one of "green"'),
            ({"element": "cable", "section": square(), "strain": "green"}, "strain", '"material", "paper"'),
            ({"poisson": "none"}, "poisson", '"centreline", "full"'),
            ({"gauss": 5}, "gauss", "along the axis, across the section"),
            ({"gauss": (0, 3)}, "gauss[0]", "between 1 and 10"),
            ({"gauss": (5, 1)}, "gauss[1]", "between 2 and 10"),
            ({"gauss": (5, 11)}, "gauss[1]", "between 2 and 10"),
            ({"gauss": (5, 4), "section": pipe()}, "gauss[1]", "must be 3"),
            ({"gauss": (5, 2), "section": Section.circle(0.1, 1e9, 1e3)}, "gauss[1]", "must be 3"),
        ],
    )
    def test_bad(self, changes, key, phrase):
        refused(f'add_beam("beam").{key}', phrase, cantilever, **changes)

    @pytest.mark.parametrize("count", [2, 4, 7])
    def test_points_across_a_rectangle(self, count):
        assert cantilever(gauss=(4, count))[1].gauss == (4, count)

    @pytest.mark.parametrize("element", BEAMS)
    def test_a_section_without_material(self, element):
        error = refused(
            'add_beam("beam").section',
            "needs A, I_y, I_z, J, E, nu, rho of its section",
            cantilever,
            element=element,
            section=Section(EA=1e4, EI=0.08, rhoA=0.05),
        )
        for maker in ("rectangle", "circle", "from_moments"):
            assert maker in error.hint

    def test_two_stiffnesses_are_for_beams(self):
        refused('add_beam("beam").section', "one bending stiffness", cantilever, element="cable")


class TestPoints:
    def test_labels(self):
        model, beam = cantilever()
        point = beam.at(0.5, 0.02, -0.005)
        assert (point.x, point.y, point.z) == (0.5, 0.02, -0.005)
        assert str(point) == "beam.at(0.5, 0.02, -0.005)"
        assert point.eccentric
        assert model.point(str(point)) == point
        assert model.point(" beam.at(5e-1,0.02 , -0.005)") == point
        assert hash(model.point(str(point))) == hash(point)
        assert model.point("beam.at(0.5, 0.01)") == beam.at(0.5, y=0.01)
        assert str(beam.at(0.5, z=0.01)) == "beam.at(0.5, 0, 0.01)"

    def test_ends(self):
        _, beam = cantilever()
        assert str(beam.at(0, 0.01)) == "beam.at(0, 0.01, 0)"
        assert beam.at(0, 0.01) != beam.start
        assert beam.at(1, 0.01).x == 1.0
        assert beam.at(1, 0.0, -0.0) == beam.end
        assert str(beam.at(0.5, 0, 0)) == "beam.at(0.5)"
        assert not beam.at(0.5, -0.0).eccentric
        assert str(beam.at(0.5, -0.0, 0.01)) == "beam.at(0.5, 0, 0.01)"
        assert len({beam.at(0.5), beam.at(0.5, 0.01), beam.at(0.5, 0, 0.01), beam.at(0.5, 0.01, 0)}) == 3

    def test_edges_belong_to_the_section(self):
        _, beam = cantilever()
        assert beam.at(0.5, 0.02, 0.01).y == 0.02
        assert beam.at(0.5, -0.02 * (1 + 1e-10), -0.01).z == -0.01
        _, round_one = cantilever(section=Section.circle(0.1, 1e9, 1e3))
        assert round_one.at(0.5, 0.03, 0.04).y == 0.03
        _, any_shape = cantilever(section=pipe())
        assert any_shape.at(0.5, 3.0, 4.0).z == 4.0

    @pytest.mark.parametrize(
        ("section", "y", "z", "phrase"),
        [
            (flat(), 0.0201, 0, "outside the cross-section, a rectangle 0.04 m wide (y) and 0.02 m high (z)"),
            (flat(), 0, -0.011, "outside the cross-section"),
            (Section.circle(0.1, 1e9, 1e3), 0.04, 0.04, "a circle with a diameter of 0.1 m"),
        ],
    )
    def test_outside(self, section, y, z, phrase):
        model, beam = cantilever(section=section)
        refused("beam.at", phrase, beam.at, 0.5, y, z)
        refused("Model.point", phrase, model.point, f"beam.at(0.5, {y}, {z})")

    @pytest.mark.parametrize(
        ("place", "where", "phrase"),
        [
            ((0.5, NAN), "beam.at.y", "finite"),
            ((0.5, 0, "0.1"), "beam.at.z", "must be a number"),
            ((0.5, True), "beam.at.y", "must be a number"),
            ((1.5, 0.01), "beam.at", "outside the beam"),
        ],
    )
    def test_bad(self, place, where, phrase):
        refused(where, phrase, cantilever()[1].at, *place)

    @pytest.mark.parametrize(
        ("label", "phrase"),
        [
            ("beam.at(0.5, a, 0)", '"a" is no place along local y in m'),
            ("beam.at(0.5, 0, )", '"" is no place along local z in m'),
            ("beam.at(, 0, 0)", '"" is no arc length in m'),
            ("beam.at()", '"" is no arc length'),
            ("beam.at(0.5, 0, 0, 0)", "has 4 numbers, wanted x or x, y, z"),
            ("beam.at(0.5; 0; 0)", "is no arc length"),
            ("beam.end(0, 0)", "is no point"),
            ("beam.at(0.5, nan, 0)", "finite"),
        ],
    )
    def test_bad_label(self, label, phrase):
        refused("Model.point", phrase, cantilever()[0].point, label)

    def test_a_cable_has_no_section(self):
        model, beam = cantilever(element="cable", section=square())
        refused("beam.at", "a cable has no cross-section to place a point in", beam.at, 0.5, 0.001)
        refused("Model.point", "no cross-section", model.point, "beam.at(0.5, 0, 0.001)")
        assert beam.at(0.5, 0, 0) == beam.at(0.5)


class TestSupports:
    def test_hold(self):
        model, beam = cantilever()
        item = model.hold(beam.start, slope_y="zx", slope_z="y", name="guide")
        assert (item.position, item.slope, item.slope_y, item.slope_z, item.twist) == (
            "",
            "",
            "xz",
            "y",
            False,
        )
        assert item.held == {"slope_y x", "slope_y z", "slope_z y"}
        item = model.hold(beam.end, position="x", twist=True)
        assert item.held == {"position x", "twist"}

    def test_clamp_holds_all(self):
        model, beam = cantilever()
        held = model.clamp(beam.start).held
        assert len(held) == 13
        assert {"position x", "slope z", "slope_y x", "slope_z z", "twist"} <= held
        model, cable = cantilever(element="cable", section=square())
        assert len(model.clamp(cable.start).held) == 6

    @pytest.mark.parametrize(
        ("given", "key", "phrase"),
        [
            ({}, "position", "nothing is held: give position, slope, slope_y, slope_z or twist"),
            ({"slope_y": "w"}, "slope_y", 'letters of "xyz"'),
            ({"slope_z": "xx"}, "slope_z", "at most once"),
            ({"slope_z": 1}, "slope_z", "must be text"),
            ({"twist": "x"}, "twist", "True or False"),
            ({"twist": 1}, "twist", "True or False"),
            ({"twist": True, "slope_y": "z"}, "twist", "give slope_y or twist, not both"),
        ],
    )
    def test_bad_hold(self, given, key, phrase):
        model, beam = cantilever()
        refused(f"hold(beam.end).{key}", phrase, model.hold, beam.end, **given)
        assert model.supports == []

    @pytest.mark.parametrize(
        ("given", "key", "phrase"),
        [
            ({"slope_y": "x"}, "slope_y", '"beam" is a cable and has no r_y'),
            ({"slope_z": "x"}, "slope_z", "has no r_z"),
            ({"twist": True, "position": "x"}, "twist", "has no r_y"),
        ],
    )
    def test_not_on_a_cable(self, given, key, phrase):
        model, beam = cantilever(element="cable", section=square())
        refused(f"hold(beam.end).{key}", phrase, model.hold, beam.end, **given)

    def test_nothing_is_held_twice(self):
        model, beam = cantilever()
        model.clamp(beam.start)
        for given, what in (
            ({"twist": True}, "both hold twist"),
            ({"slope_y": "x"}, "both hold slope_y x"),
            ({"slope_z": "zy"}, "both hold slope_z y, slope_z z"),
        ):
            refused("hold(beam.start).point", what, model.hold, beam.start, **given)
        model.pin(beam.end)
        model.hold(beam.end, twist=True)
        model.hold(beam.end, slope="y", slope_z="y")
        refused(
            "hold(beam.end).point", "both hold r_y (twist and slope_y)", model.hold, beam.end, slope_y="x"
        )
        refused("hold(beam.end).point", "both hold twist", model.hold, beam.end, twist=True)
        refused("clamp(beam.end).point", "both hold", model.clamp, beam.end)
        model.hold(beam.at(0.5), slope_y="z")
        refused("hold(beam.at(0.5)).point", "twist and slope_y", model.hold, beam.at(0.5), twist=True)
        model.clamp(beam.start, rotation="t")  # a second clamp refines the first one

    @pytest.mark.parametrize("method", ["pin", "clamp", "hold"])
    def test_on_the_centreline_only(self, method):
        model, beam = cantilever()
        given = {"position": "x"} if method == "hold" else {}
        where = f"{method}(beam.at(0.5, 0.01, 0)).point"
        error = refused(where, "is off the centreline", getattr(model, method), beam.at(0.5, 0.01), **given)
        assert error.hint == "give beam.at(0.5)"
        refused(
            f"{method}(beam.at(0, 0.01, 0)).point",
            "centreline",
            getattr(model, method),
            "beam.at(0, 0.01, 0)",
            **given,
        )


class TestLoadsAndConnections:
    def test_off_the_centreline(self):
        model, beam = cantilever()
        point = beam.at(0.3, 0.02, 0.01)
        force = model.add_force(point, (0, 0, 1))
        moment = model.add_moment("beam.at(0.3, 0.02, 0.01)", (0, 1, 0))
        assert force.point == moment.point == point
        assert force.name == "force at beam.at(0.3, 0.02, 0.01)"

    @pytest.mark.parametrize("element", BEAMS)
    def test_a_beam_takes_torque(self, element):
        model, beam = cantilever(element=element)
        np.testing.assert_array_equal(model.add_moment(beam.end, (2, 0, 0)).moment(0.0), [2, 0, 0])

    def test_a_cable_does_not(self):
        model, beam = cantilever(element="cable", section=square())
        refused("add_moment(beam.end).moment", "torque", model.add_moment, beam.end, (2, 0, 0))

    def test_spring_from_an_eccentric_point(self):
        model, beam = cantilever(y_axis=(0, 0, 1))  # local z is -e_y
        spring = model.add_spring(beam.at(0.3, 0.02, 0.01), (0.3, 0, 1.02), stiffness=1)
        assert spring.length == pytest.approx(math.hypot(0.01, 1.0), rel=1e-14)
        spring = model.add_spring(beam.at(0.5), beam.at(0.5, 0, 0.01), stiffness=1)
        assert spring.length == pytest.approx(0.01, rel=1e-14)
        where = "add_spring(beam.at(0.5, 0, 0.01)).b"
        refused(where, "coincide", model.add_spring, beam.at(0.5, 0, 0.01), (0.5, -0.01, 0), stiffness=1)

    def test_joints_off_the_centreline(self):
        model, beam = cantilever()
        other = model.add_beam(
            "b", start=(1, 0.01, 0), end=(1, 1, 0), elements=2, section=flat(), element="nonlocking"
        )
        joint = model.connect(beam.at(1, 0.01), other.start)
        assert not joint.shared
        refused("connect(beam.end).b", "are 0.01 m apart", model.connect, beam.end, other.start)


class TestDescription:
    def test_of_beams(self):
        model, beam = cantilever(y_axis=(0, 0, 1), gauss=(4, 2))
        arch = model.add_beam(
            "arch", path=arc, elements=3, section=pipe(), element="nonlocking", poisson="full"
        )
        model.hold(beam.start, slope_y="x", slope_z="yz")
        model.hold(arch.end, twist=True)
        model.add_force(beam.at(0.5, 0.01, 0), (0, 0, 1))
        plain = json.loads(json.dumps(model.to_dict()))
        first, second = plain["bodies"]
        assert (first["element"], first["strain"], first["gauss"]) == ("original", "green", [4, 2])
        assert first["y_axis"] == [0, 0, 1]
        assert "node_y" not in first
        assert (second["element"], second["poisson"], second["section"]["shape"]) == (
            "nonlocking",
            "full",
            "moments",
        )
        np.testing.assert_array_equal(second["node_y"], arch.node_y)
        assert second["y_axis"] == second["node_y"][0]
        assert plain["supports"][0]["slope_y"] == "x"
        assert plain["supports"][1]["twist"] is True
        assert plain["loads"][0]["point"] == "beam.at(0.5, 0.01, 0)"

    def test_table_of_the_command_line(self):
        model, _ = cantilever()
        model.add_beam("rope", start=(0, 1, 0), end=(1, 1, 0), elements=2, section=square())
        columns = {str(c.header): list(c.cells) for c in _bodies(model).columns}
        s = flat()
        assert columns["EI_y [N m^2]"] == [f"{s.EI_y:.6g}", f"{square().EI:.6g}"]
        assert columns["EI_z [N m^2]"][0] == f"{s.EI_z:.6g}"
        assert columns["GJ [N m^2]"] == [f"{1e8 / 2.6 * s.J:.6g}", "0"]
        model, _ = cantilever(element="cable", section=square())
        assert [str(c.header) for c in _bodies(model).columns][-2:] == ["EA [N]", "EI [N m^2]"]
