"""Clamps that turn about axes that change: a rotation vector as a function of time."""

from __future__ import annotations

from itertools import permutations
from typing import ClassVar

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ancf

CABLE = ancf.Section(EA=1e4, EI=0.5, rhoA=0.2)
SQUARE = ancf.Section.rectangle(width=0.02, height=0.01, E=1e9, rho=800.0, nu=0.3)
ELEMENTS = {"cable": CABLE, "original": SQUARE, "nonlocking": SQUARE}
AXIS = np.array([2.0, -1.0, 2.0]) / 3.0


def run(
    element: str, stretch: str = "free", more: dict[str, object] | None = None, **turn: object
) -> ancf.Result:
    model = ancf.Model(gravity=(0, 0, -9.81))
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(0.5, 0, 0), elements=3, section=ELEMENTS[element], element=element
    )
    model.clamp(beam.start, stretch=stretch, **turn)
    if more is not None:
        model.clamp(beam.start, **more)
    return ancf.simulate(model, t_end=0.1, step=1e-3)


class TestOneAxis:
    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_a_fixed_axis_gives_the_same_motion(self, element, stretch):
        angle = lambda t: 1.5 * (1 - np.cos(12 * t))  # noqa: E731
        one = run(element, stretch, rotation=angle, axis=AXIS)
        two = run(element, stretch, rotation_vector=lambda t: angle(t) * AXIS)
        assert np.ptp(one.position("beam.end"), axis=0).max() > 0.05
        np.testing.assert_allclose(two.position("beam.end"), one.position("beam.end"), atol=2e-9)


class TestChangingAxes:
    def test_a_rigid_body_has_the_orientation_that_is_given(self):
        def turn(t):
            return Rotation.from_euler("zyx", [3.0 * t, 1.0 - np.cos(4 * t), 2.0 * t**2]).as_rotvec()

        model = ancf.Model()
        body = model.add_rigid_body("gripper", at=(0.1, 0.2, 0.3), mass=1.0, inertia=(0.1, 0.2, 0.3))
        rope = model.add_beam("rope", start=(0.1, 0.2, 0.3), end=(0.4, 0.2, 0.3), elements=3, section=CABLE)
        model.clamp(body, rotation_vector=turn)
        model.clamp(rope.start, to=body)
        result = ancf.simulate(model, t_end=1.0, step=2e-3)
        arm = np.array([0.05, 0.02, -0.01])
        expected = np.array([Rotation.from_rotvec(turn(t)).apply(arm) for t in result.t])
        here = result.position(body.at(*arm)) - result.position(body)
        np.testing.assert_allclose(here, expected, atol=1e-12)

    def test_the_tangent_points_where_it_is_told(self):
        """A ring of directions, twice around a cone: the axis changes all the time."""

        def direction(t):
            return np.array([np.cos(0.6), np.sin(0.6) * np.cos(9 * t), np.sin(0.6) * np.sin(9 * t)])

        start = direction(0.0)

        def turn(t):
            across = np.cross(start, direction(t))
            size = np.linalg.norm(across)
            angle = np.arctan2(size, start @ direction(t))
            return across * (angle / size if size > 1e-12 else 1.0)

        model = ancf.Model(gravity=(0, 0, -9.81))
        rope = model.add_beam("rope", start=(0, 0, 0), end=0.6 * start, elements=4, section=CABLE)
        model.clamp(rope.start, rotation_vector=turn)
        result = ancf.simulate(model, t_end=1.0, step=2e-3)
        slope = result.slope(rope.start)
        there = np.array([direction(t) for t in result.t])
        np.testing.assert_allclose(slope / np.linalg.norm(slope, axis=1)[:, None], there, atol=1e-12)
        assert abs(result.energy.drift).max() < 1e-3 * abs(result.energy.supplied).max()


class TestGiven:
    def test_both_ways_to_turn_are_refused(self):
        model = ancf.Model()
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=CABLE)
        with pytest.raises(ancf.ModelError, match="beside rotation"):
            model.clamp(beam.start, rotation="t", rotation_vector=["t", 0, 0])

    def test_not_three_numbers(self):
        model = ancf.Model()
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=CABLE)
        with pytest.raises(ancf.ModelError, match="rotation_vector"):
            model.clamp(beam.start, rotation_vector="t")

    def test_a_description_keeps_it(self):
        model = ancf.Model()
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=CABLE)
        model.clamp(beam.start, rotation_vector=["sin(t)", 0, "0.1*t"])
        again = ancf.Model.from_dict(model.to_dict())
        one, two = (ancf.simulate(m, t_end=0.02, step=1e-3).position("beam.end") for m in (model, again))
        np.testing.assert_array_equal(one, two)
        assert "sin(t)" in repr(again.supports[0]) or "sin(t)" in str(again)


class TestTwoClamps:
    """A second clamp of a node adds a motion or the stretch to the first one."""

    MOTIONS: ClassVar[dict[str, dict[str, object]]] = {
        "turn": {"rotation": "0.5*sin(6*t)", "axis": (0, 1, 0)},
        "way": {"displacement": ["0.1*t**2", 0, "0.2*t**2"]},
        "stretch": {"stretch": "fixed"},
    }

    @pytest.mark.parametrize("pair", list(permutations(MOTIONS, 2)), ids="-".join)
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_are_one_with_both(self, element, pair):
        """In either order, also the force and the moment of the wall, which the first one has."""
        given = [self.MOTIONS[name] for name in pair]
        two, one = run(element, **given[0], more=given[1]), run(element, **given[0], **given[1])
        np.testing.assert_array_equal(two.q, one.q)
        first, second = two.model.supports
        for ask in ("reaction", "reaction_moment"):
            np.testing.assert_array_equal(getattr(two, ask)(first), getattr(one, ask)(first.name))
            assert not np.any(getattr(two, ask)(second))

    @pytest.mark.parametrize("name", ["rotation", "displacement"])
    @pytest.mark.parametrize("vector", [False, True])
    def test_may_not_both_move(self, name, vector):
        """The first one was forgotten without a word."""
        turn = {"rotation_vector": lambda t: t * AXIS} if vector else {"rotation": "t"}
        given = {"rotation": {"rotation": "2*t"}, "displacement": {"displacement": [0, "t", 0]}}[name]
        with pytest.raises(
            ancf.ModelError, match=rf"{name}: .* has a {name} of beam.start already \(give one"
        ):
            run("cable", **(given if name == "displacement" else turn), more=given)

    @pytest.mark.parametrize("again", [{}, {"stretch": "free"}])
    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_that_hold_nothing_more_are_refused(self, stretch, again):
        with pytest.raises(ancf.ModelError, match=r"clamps beam\.start already"):
            run("cable", stretch, more=again)

    def test_moment_of_holds(self):
        """Of a pin none, of what holds the slope there all."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        beam = model.add_beam("beam", start=(0, 0, 0), end=(0.5, 0, 0), elements=3, section=CABLE)
        pin, hold, other = (
            model.pin(beam.start),
            model.hold(beam.start, slope="z"),
            model.hold(beam.start, slope="y"),
        )
        state = ancf.equilibrium(model)
        assert state.reaction_moment(hold) == pytest.approx((0, -0.2 * 0.5 * 9.81 * 0.25, 0), rel=2e-3)
        assert not np.any(state.reaction_moment(pin))
        assert not np.any(state.reaction_moment(other))
