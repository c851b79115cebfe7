"""Welds, guided ends and universal joints against frames, beams and shafts of the textbooks."""

from __future__ import annotations

import itertools
import re

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ancf

E, NU = 2e11, 0.3
SPACES = {"straight": Rotation.identity(), "turned": Rotation.from_euler("xyz", (0.4, -0.7, 1.9))}


def square(side=0.02):
    return ancf.Section.rectangle(width=side, height=side, E=E, rho=7800.0, nu=NU)


def frame(element, elements, angle, space, side, swapped=False):
    """A column and a girder that leans from it by an angle, clamped at the foot; the model and its tip."""
    model, section = ancf.Model(), square(side)
    way = np.array([np.sin(angle), 0, np.cos(angle)])
    top, tip = space.apply((0, 0, 1.0)), space.apply((0, 0, 1.0) + 0.8 * way)
    given = {"section": section, "elements": elements, "element": element}
    column = model.add_beam("column", start=(0, 0, 0), end=top, y_axis=space.apply((0, 1, 0)), **given)
    girder = model.add_beam("girder", start=top, end=tip, y_axis=space.apply((0, 1, 0)), **given)
    model.clamp(column.start)
    ends = (girder.start, column.end) if swapped else (column.end, girder.start)
    model.weld(*ends)
    return model, girder, section, way


class TestWeld:
    @pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
    @pytest.mark.parametrize(
        ("element", "elements", "angle", "side"),
        [
            ("nonlocking", 2, np.pi / 2, 0.02),
            ("nonlocking", 8, np.pi / 2, 0.02),
            ("nonlocking", 8, 1.0, 0.02),
            ("nonlocking", 8, 0.5, 0.01),
            ("nonlocking", 16, 0.5, 0.02),
            ("original", 16, 1.0, 0.02),
            ("cable", 4, np.pi / 2, 0.02),
        ],
    )
    def test_a_bent_frame(self, element, elements, angle, side, space):
        """Deflection in the plane: bending of both, the moment of the corner, axial forces and shear."""
        model, girder, section, way = frame(element, elements, angle, space, side)
        force = 0.01
        model.add_force(girder.end, space.apply((0, 0, -force)))
        moved = space.inv().apply(ancf.equilibrium(model).position(girder.end)) - (0, 0, 1) - 0.8 * way
        EI, EA, arm = section.EI_y, section.EA, 0.8 * np.sin(angle)
        wanted = 0.8 * arm**2 / (3 * EI) + arm**2 / EI + 1 / EA + 0.8 * np.cos(angle) ** 2 / EA
        if element != "cable":
            wanted += 0.8 * np.sin(angle) ** 2 / (section.G * section.A)
        assert -moved[2] / force == pytest.approx(wanted, rel=1e-3)

    def test_the_order_of_the_ends_does_not_matter(self):
        tips = []
        for swapped in (False, True):
            model, girder, *_ = frame("nonlocking", 4, 0.8, SPACES["straight"], 0.02, swapped)
            model.add_force(girder.end, (20.0, 30.0, -40.0))
            tips.append(ancf.equilibrium(model).position(girder.end) - girder.initial_position(girder.length))
        assert tips[0] == pytest.approx(tips[1], rel=1e-3)

    @pytest.mark.parametrize("angle", [np.pi / 2, 1.1])
    def test_bending_of_the_girder_twists_the_column(self, angle):
        """A force across the plane: the corner hands a bending moment over as a torque."""
        model, girder, section, _ = frame("nonlocking", 8, angle, SPACES["straight"], 0.02)
        model.add_force(girder.end, (0, 0.01, 0))
        moved = ancf.equilibrium(model).position(girder.end)[1] / 0.01
        EI, GJ, out, up = section.EI_z, section.G * section.J, 0.8 * np.sin(angle), 0.8 * np.cos(angle)
        column = 1 / (3 * EI) + up / EI + up**2 / EI  # a force and a moment about x at its end
        wanted = column + out**2 / GJ + 0.8**3 / (3 * EI) + 1.8 / (section.G * section.A)
        assert moved == pytest.approx(wanted, rel=2e-3)

    @pytest.mark.parametrize("elements", [4, 8])
    def test_three_beams_at_a_node_share_the_moment(self, elements):
        """A mast between two girders that are built in: each takes half; no condition stands there twice."""
        model, section = ancf.Model(), square()
        given = {"section": section, "elements": elements, "element": "nonlocking"}
        left = model.add_beam("left", start=(-1, 0, 0), end=(0, 0, 0), **given)
        right = model.add_beam("right", start=(0, 0, 0), end=(1, 0, 0), **given)
        mast = model.add_beam("mast", start=(0, 0, 0), end=(0, 0, 1), **given)
        model.clamp(left.start)
        model.clamp(right.end)
        for other in (right.start, mast.start):
            model.weld(left.end, other)
        model.add_force(mast.end, (1.0, 0, 0))
        state = ancf.equilibrium(model)
        moment = state.bending_moment(left.at(1.0)), state.bending_moment(right.start)
        assert state.position(mast.end)[0] == pytest.approx(
            1 / (3 * section.EI_y) + 1 / (8 * section.EI_y), rel=1e-3
        )
        assert moment == pytest.approx((0.5, 0.5), rel=2e-2)
        assert state.notes == []

    @pytest.mark.parametrize(("parts", "turned"), [((3, 5), False), ((4, 4), True)])
    def test_two_cables_in_line_are_one(self, parts, turned):
        """The same frequencies and the same fall as of one cable with all elements, to round-off."""
        rope = ancf.Section(EA=1e5, EI=20.0, rhoA=0.5)

        def whole():
            model = ancf.Model(gravity=(0, 0, -9.81))
            one = model.add_beam(
                "one",
                start=(0, 0, 0),
                end=(2, 0, 0),
                nodes=[*np.linspace(0, 1, parts[0] + 1), *np.linspace(1, 2, parts[1] + 1)[1:]],
                section=rope,
            )
            model.clamp(one.start, stretch="fixed")
            return model, one.end

        def welded():
            model = ancf.Model(gravity=(0, 0, -9.81))
            first = model.add_beam("first", start=(0, 0, 0), end=(1, 0, 0), elements=parts[0], section=rope)
            ends = ((2, 0, 0), (1, 0, 0)) if turned else ((1, 0, 0), (2, 0, 0))
            second = model.add_beam("second", start=ends[0], end=ends[1], elements=parts[1], section=rope)
            model.clamp(first.start, stretch="fixed")
            model.weld(first.end, second.end if turned else second.start)
            return model, second.start if turned else second.end

        found = []
        for model, tip in (whole(), welded()):
            run = ancf.simulate(model, t_end=0.05, step=1e-3)
            found.append(
                (ancf.modes(model, about=run.state(0), count=5).frequencies_hz, run.position(tip)[-1])
            )
        assert found[0][0] == pytest.approx(found[1][0], rel=1e-7)
        assert found[0][1] == pytest.approx(found[1][1], abs=1e-8)

    @pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
    def test_two_rigid_bodies_are_one(self, space):
        """A welded dumb-bell falls and tumbles like one body with the mass and the inertia of both."""
        omega = np.array([1.0, 5.0, -2.0])
        inertia, masses, places = np.diag((0.1, 0.2, 0.25)), (1.0, 3.0), ((0.3, 0, 0), (-0.1, 0, 0))
        both = sum(
            inertia + m * (np.dot(p, p) * np.eye(3) - np.outer(p, p))
            for m, p in zip(masses, places, strict=True)
        )
        axes = space.as_matrix()
        model = ancf.Model()
        parts = [
            model.add_rigid_body(f"part {k}", at=space.apply(p), mass=m, inertia=inertia, axes=axes)
            for k, (m, p) in enumerate(zip(masses, places, strict=True))
        ]
        model.weld(parts[0].at(-0.3, 0, 0), parts[1].at(0.1, 0, 0))
        single = ancf.Model()
        body = single.add_rigid_body("body", at=(0, 0, 0), mass=4.0, inertia=both, axes=axes)
        for part in (*parts, body):
            part.set_motion(angular_velocity=space.apply(omega), about=(0, 0, 0))
        runs = [ancf.simulate(m, t_end=0.5, step=1e-3) for m in (model, single)]
        far = runs[0].position(parts[0].at(-0.3, 0.5, 0.2)), runs[1].position(body.at(0, 0.5, 0.2))
        np.testing.assert_allclose(far[0], far[1], atol=2e-7)

    def test_a_cable_built_into_the_end_of_a_beam(self):
        """At 50 degrees from its axis: it bends from there as from a wall."""
        model, section, way = ancf.Model(), square(0.05), np.array([np.cos(0.87), 0, np.sin(0.87)])
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section, element="nonlocking"
        )
        whip = model.add_beam(
            "whip",
            start=(1, 0, 0),
            end=(1, 0, 0) + 0.5 * way,
            elements=4,
            section=ancf.Section(EA=1e4, EI=0.1, rhoA=0.1),
        )
        model.clamp(beam.start)
        model.weld(whip.start, beam.end)
        model.add_force(whip.end, 1e-4 * np.array([0, 1.0, 0]))
        assert ancf.equilibrium(model).position(whip.end)[1] == pytest.approx(1e-4 * 0.5**3 / 0.3, rel=1e-3)


class TestPieces:
    """Cables in line that are welded, with numbers as people write them."""

    @staticmethod
    def hanging(cuts, off=0.0, reverse=False, EI=20.0):
        """A cable between two clamps along a line, in pieces whose ends are off it by an angle."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e5, EI=EI, rhoA=1.0)
        places = [np.array([6.0 * x, 2.0 * x, 0.0]) for x in cuts]
        for k in range(1, len(cuts) - 1):
            places[k] = places[k] + [0.0, 0.0, off * (-1) ** k]
        pieces = []
        for k, (a, b) in enumerate(itertools.pairwise(places)):
            count = round(24 * (cuts[k + 1] - cuts[k]))
            ends = (b, a) if reverse and k % 2 else (a, b)
            length = 1.002 * (cuts[k + 1] - cuts[k]) * np.hypot(6.0, 2.0)
            pieces.append(
                model.add_beam(
                    f"piece {k}",
                    start=ends[0],
                    end=ends[1],
                    length=length,
                    elements=count,
                    section=section,
                    natural_shape="straight",
                )
            )
        ends = [(p.end, p.start) if reverse and k % 2 else (p.start, p.end) for k, p in enumerate(pieces)]
        for one, two in itertools.pairwise(ends):
            model.weld(one[1], two[0])
        model.clamp(ends[0][0])
        model.clamp(ends[-1][1])
        return ancf.equilibrium(model), ends

    @pytest.mark.parametrize("cuts", [(0, 0.5, 1), (0, 1 / 3, 2 / 3, 1), (0, 0.25, 0.5, 0.75, 1)])
    @pytest.mark.parametrize("off", [1e-9, 1e-6, 1e-4])
    @pytest.mark.parametrize("reverse", [False, True])
    def test_hang_as_one_cable(self, cuts, off, reverse):
        whole, ends = self.hanging((0, 1))
        state, pieces = self.hanging(cuts, off, reverse)
        for cut, (_, end) in zip(cuts[1:-1], pieces, strict=False):
            wanted = whole.position(ends[0][0].body.at(cut * ends[0][0].body.length))
            assert state.position(end) == pytest.approx(
                wanted, abs=1e-6 + 0.3 * off
            )  # clamps keep the pieces' ways

    def test_a_corner_that_is_meant_is_refused(self):
        with pytest.raises(ancf.ModelError, match=r"meet at .* degrees; they have no torsion"):
            self.hanging((0, 0.5, 1), off=0.06)


class TestGuide:
    @pytest.mark.parametrize(
        ("element", "elements", "within"),
        [
            ("cable", 3, 1e-5),
            ("cable", 16, 1e-5),
            ("nonlocking", 4, 1e-4),
            ("nonlocking", 16, 1e-4),
            ("original", 32, 3e-3),
        ],
    )
    @pytest.mark.parametrize("axis", [(0, 0, 2.0), (0, 0.6, -0.8)])
    def test_a_guided_end(self, element, elements, within, axis):
        """F l^3/(12 EI), and F l/GA of a beam with shear; the moments at both ends are F l/2."""
        model, section = ancf.Model(), square()
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(1.5, 0, 0), elements=elements, section=section, element=element
        )
        model.clamp(beam.start)
        model.guide(beam.end, axis=axis)
        along = np.array(axis) / np.linalg.norm(axis)
        model.add_force(beam.end, 0.1 * along + (0, 0.03, 0) * (1 - abs(along)))  # the line carries the rest
        state = ancf.equilibrium(model)
        moved = (state.position(beam.end) - (1.5, 0, 0)) @ along
        force = (0.1 * along + (0, 0.03, 0) * (1 - abs(along))) @ along
        wanted = 1.5**3 / (12 * section.EI_y) + (0 if element == "cable" else 1.5 / (section.G * section.A))
        assert moved / force == pytest.approx(wanted, rel=within)
        middle = 0.75 / elements  # of the first element, where all kinds have it
        moment = state.bending_moment(beam.at(middle))
        assert moment == pytest.approx((0.75 - middle) * force, rel=3e-3)

    @pytest.mark.parametrize(("elements", "EI"), [(6, 50.0), (10, 3.0)])
    def test_frequencies_of_a_beam_with_two_guided_ends(self, elements, EI):
        """A free motion along the lines, and k pi: the frequencies of a beam on two pins."""
        model = ancf.Model()
        beam = model.add_beam(
            "beam",
            start=(0, 0, 0),
            end=(2, 0, 0),
            elements=elements,
            section=ancf.Section(EA=1e6, EI=EI, rhoA=0.7),
        )
        for end in (beam.start, beam.end):
            model.guide(end, axis=(0, 0, 1))
        found = np.array(ancf.modes(model, count=6).frequencies_hz)
        k = np.pi * np.arange(1, 3) / 2
        assert found[0] == pytest.approx(0.0, abs=1e-2)
        for wanted in k**2 * np.sqrt(EI / 0.7) / (2 * np.pi):  # across the lines it is built in
            assert np.min(np.abs(found / wanted - 1)) < 2e-3

    def test_a_rigid_body_and_a_mass_on_a_line(self):
        """They slide down a slope with g sin(angle), whatever pulls across it."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        axis = np.array([3.0, 0, -4.0])
        body = model.add_rigid_body("body", at=(1, 2, 3), mass=2.0, inertia=(0.1, 0.2, 0.2))
        bob = model.add_point_mass("bob", at=(0, 0, 0), mass=1.0)
        model.guide(body.at(0.1, 0, 0), axis=axis)
        guide = model.guide(bob, axis=axis)
        model.add_moment(body, (1.0, -2.0, 0.5))
        run = ancf.simulate(model, t_end=0.4, step=2e-3)
        path = 0.5 * 9.81 * 0.8 * run.t[:, None] ** 2 * axis / 5
        np.testing.assert_allclose(run.position(bob), path, atol=1e-9)
        np.testing.assert_allclose(run.position(body), path + np.array([1, 2, 3]), atol=1e-7)
        assert np.linalg.norm(run.multiplier(guide)[-1]) == pytest.approx(9.81 * 0.6, rel=1e-6)


class TestUniversal:
    @pytest.mark.parametrize("bend", [0.3, 0.9])
    @pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
    def test_the_second_shaft_turns_unevenly(self, bend, space):
        """tan(theta2) = tan(theta1)/cos(bend), the textbook's law of Hooke's joint."""
        model = ancf.Model()
        first, second = np.array([1.0, 0, 0]), np.array([np.cos(bend), np.sin(bend), 0])
        axes = [np.column_stack([d, (0, 0, 1), np.cross(d, (0, 0, 1))]) for d in (first, second)]
        inertia = (0.1, 0.1, 0.1)
        driving = model.add_rigid_body(
            "driving", at=(0, 0, 0), mass=1.0, inertia=inertia, axes=space.as_matrix() @ axes[0]
        )
        driven = model.add_rigid_body(
            "driven", at=space.apply(second), mass=1.0, inertia=inertia, axes=space.as_matrix() @ axes[1]
        )
        model.clamp(driving, rotation="4*t", axis=space.apply(first))
        model.universal(
            driving, driven.at(-1, 0, 0), axis_a=space.apply((0, 0, 1)), axis_b=space.apply(axes[1][:, 2])
        )
        model.cylindrical(driven, space.apply(2 * second), axis=space.apply(second))
        driven.set_motion(angular_velocity=space.apply(4.0 * np.cos(bend) * second))
        run = ancf.simulate(model, t_end=0.6, step=5e-4)
        arm = space.inv().apply(run.position(driven.at(0, 0, 1)) - run.position(driven))
        turned = np.arctan2(arm @ axes[1][:, 1] * -1.0, arm @ axes[1][:, 2])
        # its arm lies in the plane of the bend at first: tan(theta1) = tan(theta2)/cos(bend)
        wanted = np.unwrap(np.arctan2(np.sin(4 * run.t) * np.cos(bend), np.cos(4 * run.t)))
        np.testing.assert_allclose(np.unwrap(turned), wanted, atol=2e-5)

    @pytest.mark.parametrize("element", ["original", "nonlocking"])
    def test_carries_a_torque_and_no_moment_across(self, element):
        """Between two beams in line: a force at the end finds a mechanism, a torque goes through."""
        model, section = ancf.Model(), square()
        given = {"section": section, "elements": 4, "element": element}
        one = model.add_beam("one", start=(0, 0, 0), end=(1, 0, 0), **given)
        two = model.add_beam("two", start=(1, 0, 0), end=(2, 0, 0), **given)
        model.clamp(one.start)
        model.universal(one.end, two.start, axis_a=(0, 1, 0), axis_b=(0, 0, 1))
        model.hold(two.end, position="yz")
        model.add_moment(two.end, (1.0, 0, 0))
        state = ancf.equilibrium(model)
        turned = (state.position(two.at(1.0, 0.0, 0.01)) - state.position(two.end))[1] / -0.01
        assert turned == pytest.approx(2 / (section.G * section.J), rel=2e-2)


class TestGiven:
    def bodies(self):
        model = ancf.Model()
        rope = ancf.Section(EA=1e4, EI=1.0, rhoA=1.0)
        model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=rope)
        model.add_beam("branch", start=(1, 0, 0), end=(2, 0, 1), elements=2, section=rope)
        model.add_beam(
            "rod", start=(1, 0, 0), end=(1, 1, 0), elements=2, section=square(), element="nonlocking"
        )
        model.add_rigid_body("hub", at=(1, 0, 0), mass=1.0, inertia=(1, 1, 1))
        model.add_point_mass("bob", at=(1, 0, 0), mass=1.0)
        return model

    @pytest.mark.parametrize(
        ("method", "ends", "given", "what"),
        [
            ("weld", ("rope.end", "branch.start"), {}, "meet at 45 degrees; they have no torsion"),
            ("weld", ("rope.end", "bob"), {}, "is a point mass and has no orientation"),
            ("weld", ("rope.end", (1, 0, 0)), {}, "is a position in space"),
            ("weld", ("rope.start", "rod.start"), {}, "1 m apart, must coincide"),
            ("weld", ("rope.at(0.3)", "rod.start"), {}, "is not at a node"),
            ("weld", ("hub", "hub"), {}, "are points of one rigid body"),
            ("guide", ("rope.end",), {"axis": (0, 0, 0)}, "axis"),
            ("guide", ("rope.at(0.3)",), {"axis": (0, 0, 1)}, "is not at a node"),
            (
                "universal",
                ("hub", "rod.start"),
                {"axis_a": (1, 0, 0), "axis_b": (1, 1, 0)},
                "must be normal to axis_a",
            ),
            (
                "universal",
                ("hub", "rope.end"),
                {"axis_a": (1, 0, 0), "axis_b": (0, 1, 0)},
                "a cable, which does not turn",
            ),
            ("universal", ("hub", "bob"), {"axis_a": (1, 0, 0), "axis_b": (0, 1, 0)}, "no orientation"),
        ],
    )
    def test_what_does_not_fit(self, method, ends, given, what):
        with pytest.raises(ancf.ModelError, match=what):
            getattr(self.bodies(), method)(*ends, **given)

    @pytest.mark.parametrize("point", ["rope.end", "rod.start", "hub", "hub.at(0.1, 0, 0)", "bob"])
    def test_a_hint_that_can_be_followed(self, point):
        """Of a weld to the ground: what it proposes is accepted."""
        model = self.bodies()
        with pytest.raises(ancf.ModelError, match="is a position in space") as caught:
            model.weld(point, (1, 0, 0))
        method, held = re.match(r".*?model\.(\w+)\((.+?)\)(?: |;|$)", caught.value.hint).groups()
        getattr(model, method)(held)
        assert [s.point.body.name for s in model.supports] == [point.split(".")[0]]

    @pytest.mark.parametrize("pair", list(itertools.permutations(["rod.start", "hub"])))
    def test_a_second_joint_of_the_same_points(self, pair):
        model = self.bodies()
        model.weld("hub", "rod.start", name="first")
        with pytest.raises(
            ancf.ModelError, match=r'"first" connects hub\.centre and rod\.start already|"first" connects rod'
        ):
            model.weld(*pair)
