"""A model as flat arrays: numbering, points, supports, given motions, fields."""

import warnings

import numpy as np
import pytest

import ancf
from ancf.elements.registry import ELEMENTS
from ancf.model.elements import KINDS
from ancf.system.system import System
from helpers import SHAPES, SOFT, SOLIDS, arc, cable, random_rate, shaken, square


def joined(element="cable"):
    """Two bodies that share a node, and a third one hung on them by a spring."""
    model, one = cable("curved", elements=3, name="one", element=element)
    given = {"section": one.section, "element": element}
    two = model.add_beam("two", start=arc(1.0), end=(3, 1, 0), elements=4, **given)
    three = model.add_beam("three", start=(0, 0, -2), end=(2, 0, -2), elements=2, **given)
    model.connect(one.end, two.start)
    model.add_spring(two.at(0.7), three.at(1.3), stiffness=5.0)
    return model, one, two, three


@pytest.mark.parametrize("element", ELEMENTS)
class TestNumbering:
    def test_every_unknown_belongs_to_one_node(self, element):
        system = System(joined(element)[0])
        slots = np.concatenate([s.ravel() for s in system.numbering.slots.values()])
        assert len(np.unique(slots)) == len(slots) - 1  # one shared position
        assert slots.max() < system.n
        assert np.all(slots % 3 == 0)

    def test_joint_shares_the_position_not_the_slope(self, element):
        model, one, two, _ = joined(element)
        system = System(model)
        assert system.slots["one"][-1, 0] == system.slots["two"][0, 0]
        assert system.slots["one"][-1, 1] != system.slots["two"][0, 1]
        model.pin(one.start)
        model.pin(two.end)
        model.gravity[:] = 0, 0, -9.81
        model.pin(model.bodies["three"].start)
        result = ancf.simulate(model, t_end=0.1, step=1e-3)
        assert np.array_equal(result.position(one.end), result.position(two.start))
        turned = result.slope(one.end) - result.slope(two.start)
        assert np.ptp(turned, axis=0).max() > 1e-3

    def test_names_of_unknowns(self, element):
        model, _ = cable("straight", elements=3, element=element)
        system = System(model)
        names = ("position", "slope r_x", "slope r_y", "slope r_z", "internal r_yx", "internal r_zx")
        kind = KINDS[element]
        assert system.numbering.slots["beam"].shape == (4, kind.vectors + kind.internal)
        for slot, name in zip(system.numbering.slots["beam"][2], names, strict=False):
            for c, component in enumerate("xyz"):
                assert system.numbering.describe(int(slot) + c) == f"beam node 2 {name} {component}"

    def test_numbering_does_not_change_results(self, element):
        """A spring at another place gives another order of elimination."""
        tips = []
        for extra in (False, True):
            model, one, _, three = joined(element)
            model.gravity[:] = 0, 0, -9.81
            model.clamp(one.start)
            model.pin(three.start)
            if extra:  # a spring without force: free as long as it likes
                model.add_spring(one.at(0.4), three.end, stiffness=1e-12, length=1.0)
            tips.append(ancf.simulate(model, t_end=0.1, step=1e-3).position("two.end"))
        assert tips[1] == pytest.approx(tips[0], abs=1e-8)


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("element", ELEMENTS)
class TestPoints:
    def test_initial_shape(self, shape, element):
        model, beam = cable(shape, element=element, elements=5)
        state = ancf.simulate(model, t_end=1e-4, step=1e-4).state(0)
        for x in np.linspace(0, beam.length, 13):
            assert state.position(beam.at(x)) == pytest.approx(beam.initial_position(x), abs=1e-13)
            slope = state.slope(beam.at(x))
            assert slope / np.linalg.norm(slope) == pytest.approx(beam.initial_tangent(x), abs=1e-13)
        assert np.linalg.norm(state.slope(beam.start)) == pytest.approx(beam.stretch, rel=1e-13)

    def test_fields_are_smooth_between_elements(self, shape, element):
        """Position and slope are continuous at nodes."""
        system = System(cable(shape, element=element, elements=4)[0])
        beam = system.model.bodies["beam"]
        state = ancf.State(system, 0.0, shaken(system), random_rate(system))
        for x in beam.node_x[1:-1]:
            for field in (state.position, state.slope, state.velocity):
                before, after = (field(beam.at(x + d)) for d in (-1e-9, 1e-9))
                assert before == pytest.approx(after, abs=1e-7)

    def test_points_by_name_and_object(self, shape, element):
        model, beam = cable(shape, element=element)
        state = ancf.simulate(model, t_end=1e-4, step=1e-4).state(0)
        for point, name in (
            (beam.start, "beam.start"),
            (beam.end, "beam.end"),
            (beam.at(0.25), "beam.at(0.25)"),
        ):
            assert np.array_equal(state.position(point), state.position(name))


class TestFields:
    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
    def test_uniform_stretch(self, strain):
        model, beam = cable("straight", strain=strain)
        system = System(model)
        q, _ = system.initial_state()
        state = ancf.State(system, 0.0, 1.2 * q, 0 * q)
        eps = 0.2 if strain == "material" else 0.22
        for x in (0.0, 0.3, 0.7, beam.length):
            assert state.strain(beam.at(x)) == pytest.approx(eps, rel=1e-12)
            force = SOFT["EA"] * eps * (1.2 if strain == "paper" else 1.0)
            assert state.tension(beam.at(x)) == pytest.approx(force, rel=1e-12)
            assert state.curvature(beam.at(x)) == pytest.approx(0, abs=1e-12)

    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
    @pytest.mark.parametrize("shape", ["curved", "curved and stretched"])
    def test_natural_shape_carries_nothing(self, strain, shape):
        """Strains and moments are counted from the natural shape; a stretched start is in tension."""
        model, beam = cable(shape, strain=strain, elements=6)
        state = ancf.simulate(model, t_end=1e-4, step=1e-4).state(0)
        s = beam.stretch
        for x in (0.1, 0.5, 0.9):
            assert state.bending_moment(beam.at(x)) == pytest.approx(0, abs=1e-9)
            assert state.curvature(beam.at(x)) > 0.1
            eps = (s - 1) if strain == "material" else (s * s - 1) / 2
            assert state.strain(beam.at(x)) == pytest.approx(eps, abs=1e-3)

    def test_curvature_of_a_circle(self):
        """Order 2 in a cubic element; the tangents are exact at the nodes."""
        errors = []
        for elements in (8, 16):
            model = ancf.Model()
            section = ancf.Section(**SOFT)
            ring = {"path": lambda u: (2 * np.cos(u), 2 * np.sin(u), 0), "natural_shape": "straight"}
            beam = model.add_beam("beam", section=section, elements=elements, **ring)
            state = ancf.simulate(model, t_end=1e-4, step=1e-4).state(0)
            errors.append(abs(state.curvature(beam.at(beam.node_x[3])) - 0.5))
        assert errors[1] < 1e-3
        assert np.log2(errors[0] / errors[1]) == pytest.approx(2, abs=0.2)

    def test_history_is_states_in_a_row(self):
        model, beam = cable("curved", damped=True)
        model.clamp(beam.start)
        model.gravity[:] = 0, 0, -9.81
        result = ancf.simulate(model, t_end=0.05, step=1e-3)
        for name in ("position", "velocity", "slope", "strain", "tension", "curvature", "bending_moment"):
            history = getattr(result, name)(beam.at(0.6))
            for k in (0, 20, 50):
                one = getattr(result.state(k), name)(beam.at(0.6))
                # the rate in the bending moment is a difference whose step depends on the history
                assert history[k] == pytest.approx(one, rel=1e-7, abs=1e-9), name


@pytest.mark.parametrize("element", ELEMENTS)
class TestSupports:
    def run(self, model):
        model.gravity[:] = 1.0, 2.0, -9.81
        return ancf.simulate(model, t_end=0.1, step=1e-3)

    def test_pin(self, element):
        model, beam = cable("curved", element=element)
        model.pin(beam.at(beam.node_x[1]))
        r = self.run(model).position(beam.at(beam.node_x[1]))
        assert np.max(np.abs(r - beam.node_position[1])) == 0

    def test_clamp_free_stretch_holds_the_direction(self, element):
        model, beam = cable("curved", element=element)
        model.clamp(beam.end)
        slope = self.run(model).slope(beam.end)
        stretch = np.linalg.norm(slope, axis=1)
        assert np.ptp(stretch) > 1e-4
        assert slope / stretch[:, None] == pytest.approx(np.tile(beam.node_tangent[-1], (101, 1)), abs=1e-13)

    def test_clamp_fixed_stretch_holds_all(self, element):
        model, beam = cable("curved and stretched", element=element)
        model.clamp(beam.end, stretch="fixed")
        slope = self.run(model).slope(beam.end)
        assert slope == pytest.approx(np.tile(beam.stretch * beam.node_tangent[-1], (101, 1)), abs=1e-14)

    def test_hold(self, element):
        model, beam = cable("curved", element=element)
        point = beam.at(beam.node_x[2])
        model.hold(point, position="xz", slope="y")
        result = self.run(model)
        moved = np.ptp(result.position(point), axis=0)
        turned = np.ptp(result.slope(point), axis=0)
        assert moved[0] == moved[2] == turned[1] == 0
        assert min(moved[1], turned[0], turned[2]) > 1e-3

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    def test_moving_clamp(self, stretch, element):
        """Position and direction follow the functions; velocities are their derivatives."""
        model, beam = cable("curved and stretched", element=element)
        axis = np.array([1.0, -2.0, 0.5]) / np.sqrt(5.25)
        motion = {"rotation": "0.3*sin(9*t)", "displacement": ["0.1*sin(8*t)", "0.2*t**2", "-0.1*t"]}
        model.clamp(beam.start, stretch=stretch, axis=axis, **motion)
        result = self.run(model)
        t = result.t
        moved = np.column_stack([0.1 * np.sin(8 * t), 0.2 * t**2, -0.1 * t])
        speed = np.column_stack([0.8 * np.cos(8 * t), 0.4 * t, -0.1 + 0 * t])
        assert result.position(beam.start) == pytest.approx(beam.node_position[0] + moved, abs=1e-13)
        assert result.velocity(beam.start) == pytest.approx(speed, abs=1e-9)
        angle = 0.3 * np.sin(9 * t)[:, None]
        u = beam.node_tangent[0]
        across = (
            u + np.sin(angle) * np.cross(axis, u) + (1 - np.cos(angle)) * np.cross(axis, np.cross(axis, u))
        )
        slope = result.slope(beam.start)
        unit = slope / np.linalg.norm(slope, axis=1, keepdims=True)
        assert unit == pytest.approx(across, abs=1e-12)
        if stretch == "fixed":
            assert slope == pytest.approx(beam.stretch * across, abs=1e-12)

    def test_moving_pin_accelerates_the_cable(self, element):
        """A support that moves with constant acceleration: seen from it, gravity the other way."""
        tips = []
        for moving in (True, False):
            model, beam = cable("straight", element=element, elements=3)
            g = np.array([1.5, -2.0, 1.0])
            model.pin(beam.start, displacement=(lambda t, g=g: 0.5 * g * t**2) if moving else None)
            model.gravity[:] = 0.0 if moving else -g
            result = ancf.simulate(model, t_end=0.3, step=1e-3)
            tips.append(result.position(beam.end) - result.position(beam.start))
        assert tips[0] == pytest.approx(tips[1], abs=1e-9)

    def test_two_clamps_refine_each_other(self, element):
        """The second clamp of a node adds what the first one left open."""
        model, beam = cable("straight", element=element)
        model.clamp(beam.start, stretch="fixed")
        model.clamp(beam.start, rotation="0.2*t", axis=(0, 0, 1), name="turn")
        system = System(model)
        assert not system.constraints.rotations  # the slopes are held whole, and follow the rotation
        assert len(system.constraints.motions) == (3 if element in SOLIDS else 1)


@pytest.mark.parametrize("element", ELEMENTS)
class TestInitialMotion:
    def test_rigid_motion(self, element):
        model, beam = cable("curved", element=element)
        motion = {"velocity": (1.0, 2.0, 3.0), "angular_velocity": (0.5, -1.0, 2.0), "about": (0.3, 0.1, 0.0)}
        beam.set_motion(**motion)
        state = ancf.simulate(model, t_end=1e-4, step=1e-4).state(0)
        for x in (0.0, 0.4, beam.length):
            arm = state.position(beam.at(x)) - motion["about"]
            wanted = motion["velocity"] + np.cross(motion["angular_velocity"], arm)
            assert state.velocity(beam.at(x)) == pytest.approx(wanted, abs=1e-12)

    def test_support_wins_and_says_so(self, element):
        model, beam = cable("straight", element=element)
        model.pin(beam.start)
        beam.set_motion(velocity=(0, 0, 2.0))
        with pytest.warns(UserWarning, match=r"beam node 0 position z: set_motion asks for 2.*support wins"):
            result = ancf.simulate(model, t_end=0.01, step=1e-3)
        assert np.max(np.abs(result.velocity(beam.start))) == 0
        assert result.velocity(beam.at(beam.node_x[1]))[0] == pytest.approx((0, 0, 2.0))

    def test_motion_that_fits_is_silent(self, element):
        model, beam = cable("straight", element=element)
        model.pin(beam.start)
        beam.set_motion(angular_velocity=(0, 0, 2.0))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            ancf.simulate(model, t_end=0.01, step=1e-3)

    @pytest.mark.parametrize("stretch", ["free", "fixed"])
    @pytest.mark.parametrize("along", [(1, 0, 0), (0, 1, 0), (0, 0, 1), (1, 2, 2)])
    def test_spin_about_its_own_axis_fits_a_clamp_that_turns(self, along, stretch, element):
        """Nothing but sections moves: round-off of the clamp is no motion that it holds otherwise."""
        model, turned = ancf.Model(), square(element, EA=1e4, EI=1.0, rhoA=0.5)
        beam = model.add_beam("beam", start=(0, 0, 0), end=along, elements=2, section=turned, element=element)
        model.clamp(beam.start, rotation="8*t", axis=along, stretch=stretch)
        beam.set_motion(angular_velocity=8.0 * np.array(along) / np.linalg.norm(along))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            ancf.simulate(model, t_end=1e-4, step=1e-5)

    def test_a_clamp_at_rest_says_what_to_do(self, element):
        model, beam = cable("straight", element=element)
        model.clamp(beam.start)
        beam.set_motion(angular_velocity=(0, 0, 2.0))
        with pytest.warns(UserWarning, match=r"the support wins: let it move so too, or change set_motion"):
            ancf.simulate(model, t_end=1e-4, step=1e-5)

    def test_motion_of_one_body_says_nothing_of_others(self, element):
        """The other body's support moves: nobody asked it not to."""
        model, beam = cable("straight", element=element)
        model.pin(beam.start)
        beam.set_motion(angular_velocity=(0, 0, 2.0))
        other = model.add_beam(
            "other", start=(0, 0, 3), end=(1, 0, 3), elements=2, section=beam.section, element=element
        )
        model.clamp(other.start, rotation="0.5*t", displacement=["0.3*t", "0", "0"])
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            result = ancf.simulate(model, t_end=0.01, step=1e-3)
        assert result.velocity(other.start)[0] == pytest.approx((0.3, 0, 0), abs=1e-9)


@pytest.mark.parametrize("element", ELEMENTS)
class TestLoads:
    def test_weight(self, element):
        """Sum of the nodal weights, whatever the shape and the stretch."""
        for shape in SHAPES:
            model, beam = cable(shape, element=element)
            model.gravity[:] = 1.0, -2.0, 3.0
            system = System(model)
            f = system.core.loads.gravity.reshape(-1, 3)[system.slots["beam"][:, 0] // 3].sum(axis=0)
            assert f == pytest.approx(beam.section.rhoA * beam.length * model.gravity, rel=1e-12)

    def test_loads_of_time_are_taken_at_the_end_of_a_step(self, element):
        """A force on a free cable: the momentum is the trapezoidal sum of the forces."""
        model, beam = cable("straight", element=element, elements=2)
        model.add_force(beam.at(0.5 * beam.length), ["0", "0", "sin(40*t)"])
        result = ancf.simulate(model, t_end=0.1, step=1e-3)
        F = np.sin(40 * result.t)
        momentum = np.concatenate([[0.0], np.cumsum(0.5e-3 * (F[1:] + F[:-1]))])
        M = beam.section.rhoA * beam.length
        x, _ = np.polynomial.legendre.leggauss(2)  # exact for the two cubics
        x = np.concatenate([(x + 1) / 4, (x + 3) / 4]) * beam.length
        centre = np.mean([result.velocity(beam.at(s)) for s in x], axis=0)
        assert M * centre[:, 2] == pytest.approx(momentum, abs=1e-7)
