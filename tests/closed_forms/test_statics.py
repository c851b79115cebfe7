"""Static equilibrium: slack cables from straight starts, parts of a model, supports that are missing."""

import numpy as np
import pytest
from scipy.optimize import brentq

import ancf
from ancf.elements.registry import ELEMENTS
from ancf.model.elements import KINDS
from ancf.system.core import apply_load, apply_supports, residual
from helpers import cable as free_cable
from helpers import square

GRAVITY = 9.81
FINE = {"original": 160}  # elements that keep r_y, linear in each of them, from locking


def out_of_balance(state):
    """Largest residual force on a free unknown, N."""
    system, core = state.system, state.system.core
    zero, f, r = np.zeros(system.size), np.empty(system.size), np.empty(system.size)
    q, v, a = state.q.copy(), zero.copy(), zero.copy()
    system.place(state.t, q, v, a)
    apply_load(core.loads, np.array([load(state.t) for load in system.inputs.loads]).reshape(-1, 3), f)
    residual(core.batches, core.ws, q, zero, zero, f, r)
    apply_supports(core.supports, r)
    return np.max(np.abs(r[: system.n]))


def hanging(ratio, EI, drop, strain, elements=24, EA=1e5):
    """A cable of ``ratio`` times the distance of its supports, straight at first."""
    model = ancf.Model(gravity=(0, 0, -GRAVITY))
    end = np.array([4.0, 0, -drop])
    section = ancf.Section(EA=EA, EI=EI, rhoA=0.3)
    given = {"length": ratio * np.linalg.norm(end), "elements": elements, "strain": strain}
    wire = model.add_beam("wire", start=(0, 0, 0), end=end, section=section, **given)
    model.pin(wire.start)
    model.pin(wire.end)
    return model, wire


def lowest_of_catenary(span, length):
    """Sag of an inextensible level catenary."""
    if length / span < 1 + 1e-9:
        return 0.0
    a = brentq(lambda x: np.sinh(x) / x - length / span, 1e-6, 20.0)  # x = span/(2 a)
    return span / (2 * a) * (np.cosh(a) - 1)


class TestSlackCables:
    @pytest.mark.parametrize("strain", KINDS["cable"].strains)
    @pytest.mark.parametrize("drop", [0.0, 2.5])
    @pytest.mark.parametrize("EI", [0.0, 1e-3, 0.05])
    @pytest.mark.parametrize("ratio", [1.0002, 1.005, 1.05, 1.5, 3.0])
    def test_balances(self, ratio, EI, drop, strain):
        """Round-off of EA eps is 1e-11 N; nodal forces are of the order of the weight, some N."""
        model, wire = hanging(ratio, EI, drop, strain)
        state = ancf.equilibrium(model)
        assert out_of_balance(state) < 1e-7
        assert np.linalg.norm(state.position(wire.end) - (4, 0, -drop)) == 0
        x = np.linspace(0, wire.length, 97)
        r = np.array([state.position(wire.at(s)) for s in x])
        assert np.max(np.abs(r[:, 1])) < 1e-9  # stays in its plane
        chords = np.linalg.norm(np.diff(r, axis=0), axis=1).sum()
        assert chords == pytest.approx(wire.length, rel=2e-3)
        line = -drop * r[:, 0] / 4.0
        assert np.all(r[1:-1, 2] < line[1:-1])  # hangs, no part stands up

    @pytest.mark.parametrize("ratio", [1.005, 1.05, 1.5, 3.0])
    def test_sag(self, ratio):
        """Against the inextensible catenary: EA is large and the mesh is fine."""
        model, wire = hanging(ratio, 1e-5, 0.0, "material", elements=60, EA=2e7)
        sag = -ancf.equilibrium(model).position(wire.at(wire.length / 2))[2]
        assert sag == pytest.approx(lowest_of_catenary(4.0, wire.length), rel=2e-3)

    def test_ends_apart_by_a_driven_support(self):
        """The end is moved back at the time asked for: the cable sags although it starts tight."""
        model, wire = free_cable("straight", elements=6)
        model.gravity[:] = 0, 0, -GRAVITY
        model.pin(wire.start)
        along = wire.node_tangent[0]
        model.pin(wire.end, displacement=lambda t: -0.1 * t * along)
        state = ancf.equilibrium(model, time=1.0)
        assert state.t == 1.0
        assert state.position(wire.end) == pytest.approx(np.array([0.9, 0.6, 0.5]) - 0.1 * along)
        assert out_of_balance(state) < 1e-8

    def test_same_shape_from_a_curved_start(self):
        """The equilibrium does not depend on the initial shape, for the same natural length."""
        section = ancf.Section(EA=1e4, EI=1e-3, rhoA=0.3)
        shapes = []
        path = lambda u: (4 * u, 0, -6.0 * u * (1 - u))  # noqa: E731
        for given in ({"start": (0, 0, 0), "end": (4, 0, 0)}, {"path": path, "natural_shape": "straight"}):
            model = ancf.Model(gravity=(0, 0, -GRAVITY))
            wire = model.add_beam("wire", section=section, elements=24, length=5.2, **given)
            model.pin(wire.start)
            model.pin(wire.end)
            state = ancf.equilibrium(model)
            shapes.append([state.position(wire.at(s)) for s in np.linspace(0, 5.2, 9)])
        assert np.array(shapes[0]) == pytest.approx(np.array(shapes[1]), abs=1e-8)


class TestParts:
    """equilibrium(of=...) moves some bodies and leaves the others in their initial shape."""

    @staticmethod
    def pair(element="cable"):
        model, low = free_cable("straight", elements=3, name="low", element=element)
        model.gravity[:] = 0, 0, -GRAVITY
        given = {"elements": 4, "section": low.section, "element": element}
        high = model.add_beam("high", start=(0.1, 0.2, 1), end=(1.5, 0.2, 1), **given)
        for beam in (low, high):
            model.pin(beam.start)
            model.pin(beam.end)
        return model, low, high

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_moves_only_what_is_asked(self, element):
        model, low, high = self.pair(element)
        state = ancf.equilibrium(model, of=[high])
        alone = ancf.equilibrium(model)
        assert state.position(low.at(0.4)) == pytest.approx(low.initial_position(0.4), abs=1e-14)
        assert state.position(high.at(0.7)) == pytest.approx(alone.position(high.at(0.7)), abs=1e-12)
        assert alone.position(low.at(0.4))[2] < low.initial_position(0.4)[2] - 1e-3

    def test_names_and_bodies(self):
        model, _, high = self.pair()
        by_name, by_body = (ancf.equilibrium(model, of=[key]) for key in ("high", high))
        assert np.array_equal(by_name.q, by_body.q)

    def test_all_are_the_default(self):
        model, low, high = self.pair()
        assert np.array_equal(ancf.equilibrium(model).q, ancf.equilibrium(model, of=[low, high]).q)

    def test_held_bodies_support_others(self):
        """A cable may hang on another one that does not move."""
        model, _, high = self.pair()
        section = ancf.Section(EA=100.0, EI=0.1, rhoA=0.1)
        hook = model.add_beam(
            "hook", start=high.start.body.node_position[2], end=(0.8, 0.2, 0.3), elements=2, section=section
        )
        model.connect(hook.start, high.at(high.node_x[2]))
        state = ancf.equilibrium(model, of=[hook])
        assert state.position(hook.start) == pytest.approx(high.node_position[2], abs=1e-14)
        # hangs straight down from there, longer by w L/(2 EA)
        L = hook.length
        wanted = high.node_position[2] - (0, 0, L * (1 + 0.1 * GRAVITY * L / 200.0))
        assert state.position(hook.end) == pytest.approx(wanted, abs=1e-6)

    def test_unknown_name(self):
        model, _, _ = self.pair()
        with pytest.raises(ancf.ModelError, match=r"unknown body 'middle'.*low.*high"):
            ancf.equilibrium(model, of=["middle"])


class TestSettings:
    @pytest.mark.parametrize("load_steps", [1, 3, 10])
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_load_steps_do_not_change_the_result(self, load_steps, element):
        model, beam = free_cable("curved", element=element, elements=5)
        model.gravity[:] = 0, 0, -GRAVITY
        model.clamp(beam.start)
        model.add_force(beam.end, (1.0, 2.0, 0.5))
        tip = ancf.equilibrium(model, load_steps=load_steps).position(beam.end)
        assert tip == pytest.approx(ancf.equilibrium(model).position(beam.end), abs=1e-10)

    @pytest.mark.parametrize("load_steps", [0, -1, 1.5, "2", None, True])
    def test_wrong_load_steps(self, load_steps):
        model, beam = free_cable()
        model.clamp(beam.start)
        with pytest.raises(ancf.ModelError, match=r"equilibrium.load_steps: must be"):
            ancf.equilibrium(model, load_steps=load_steps)

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_time_of_the_loads(self, element):
        model, beam = free_cable(element=element, elements=4)
        model.clamp(beam.start)
        model.add_force(beam.end, lambda t: (0, 0, 0.3 * t))
        at_rest, loaded = (ancf.equilibrium(model, time=t).position(beam.end) for t in (0.0, 2.0))
        assert at_rest == pytest.approx((0.9, 0.6, 0.5), abs=1e-12)
        assert loaded[2] > 0.52

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_state_knows_its_initial_motion(self, element):
        """Velocities of set_motion at the deformed shape, which hangs down."""
        model, beam = free_cable(element=element, elements=4)
        model.gravity[:] = 0, 0, -GRAVITY
        model.pin(beam.start)
        beam.set_motion(angular_velocity=(0, 3.0, 2.0))
        state = ancf.equilibrium(model)
        arm = state.position(beam.end) - state.position(beam.start)
        assert state.velocity(beam.end) == pytest.approx(np.cross((0, 3.0, 2.0), arm), abs=1e-12)
        assert state.energy.kinetic > 1e-3

    def test_counters(self):
        model, beam = free_cable(elements=4)
        model.gravity[:] = 0, 0, -GRAVITY
        model.clamp(beam.start)
        stats = ancf.equilibrium(model).stats
        assert 1 < stats.newton_iterations <= stats.jacobians < 100
        assert stats.cpu_seconds > 0

    def test_model_is_left_as_it_was(self):
        """The detour of slack cables changes stiffnesses: they must come back."""
        model, _ = hanging(1.3, 1e-3, 0.0, "material")
        state = ancf.equilibrium(model)
        again = ancf.equilibrium(model)
        assert np.array_equal(state.q, again.q)
        assert out_of_balance(state) < 1e-7
        result = ancf.simulate(model, t_end=0.05, step=1e-3, start=state)
        drift = np.max(np.abs(np.array(result.q[-1]) - state.q))
        assert drift < 1e-6  # an equilibrium stays one when time runs


class TestSupports:
    """Nothing may float: the message names the body and the directions."""

    def float_message(self, model):
        with pytest.raises(ancf.ModelError) as caught:
            ancf.equilibrium(model)
        assert caught.value.where == "supports"
        return caught.value.what

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_free_body(self, element):
        model, _ = free_cable(element=element)
        model.gravity[:] = 0, 0, -1.0
        assert (
            self.float_message(model) == 'nothing holds "beam" in x, y, z: it floats and has no equilibrium'
        )

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_free_in_one_direction(self, element):
        model, beam = free_cable(element=element)
        model.hold(beam.start, position="xz")
        assert 'nothing holds "beam" in y:' in self.float_message(model)

    def test_group_of_connected_bodies(self):
        model, beam = free_cable()
        section = beam.section
        other = model.add_beam("other", start=(0.9, 0.6, 0.5), end=(2, 0, 0), elements=2, section=section)
        third = model.add_beam("third", start=(3, 0, 0), end=(4, 0, 0), elements=2, section=section)
        model.connect(beam.end, other.start)
        model.add_spring(other.end, third.start, stiffness=1.0)
        assert '"beam" and "other" and "third"' in self.float_message(model)
        model.gravity[:] = 0, 0, -1.0
        model.pin(third.end)
        model.pin(beam.start)
        ancf.equilibrium(model)

    def test_spring_to_the_ground_supports(self):
        model, beam = free_cable(elements=2)
        model.gravity[:] = 0, 0, -1.0
        model.add_spring(beam.start, (0.1, 0.2, 1.0), stiffness=50.0)
        model.hold(beam.start, slope="xyz")
        state = ancf.equilibrium(model)
        assert out_of_balance(state) < 1e-9

    def test_no_body(self):
        with pytest.raises(ancf.ModelError, match="the model has no body"):
            ancf.equilibrium(ancf.Model())


class TestStability:
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_leaves_an_unstable_start(self, element):
        """A cable that stands upright on its pin falls over and hangs."""
        model = ancf.Model(gravity=(0, 0, -GRAVITY))
        section = square(element, EA=1e4, EI=0.5, rhoA=0.3)
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(0, 0, 1), elements=6, section=section, element=element
        )
        model.pin(beam.start)
        state = ancf.equilibrium(model)
        assert state.position(beam.end) == pytest.approx((0, 0, -1.0), abs=1e-3)
        assert out_of_balance(state) < 1e-7

    @pytest.mark.parametrize("share", [0.9, 1.5])
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_euler_column(self, share, element):
        """Below P = pi^2 EI/(4 L^2) a column stands, above it buckles to the elastica."""
        EI, L = 0.5, 1.0
        model = ancf.Model()
        section = square(element, EA=1e6, EI=EI, rhoA=0.3)
        beam = model.add_beam(
            "beam",
            start=(0, 0, 0),
            end=(0, 0, L),
            elements=FINE.get(element, 20),
            section=section,
            element=element,
        )
        model.clamp(beam.start)
        model.add_force(beam.end, (0, 0, -share * np.pi**2 * EI / (4 * L**2)))
        tip = ancf.equilibrium(model).position(beam.end)
        side = np.hypot(tip[0], tip[1])
        # P/P_cr = 1.5: 4 K(k)^2/pi^2 with K(k) = 1.9237, k = 0.7887, tip aside by 2 k/sqrt(P/EI) L
        k = brentq(lambda k: (_elliptic(k) * 2 / np.pi) ** 2 - 1.5, 0.1, 0.99)
        wanted = 2 * k / np.sqrt(1.5 * np.pi**2 / 4) if share > 1 else 0.0
        # P/P_cr of 1.5 is that of a beam without shear; a beam 400 times longer than thick is near it
        assert side == pytest.approx(wanted, abs=1e-4 if element == "cable" else 1e-3)

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_equilibrium_stays_when_time_runs(self, element):
        section = square(element, EA=1e3, EI=2.0, rhoA=0.7)
        model, beam = free_cable("curved", element=element, elements=5, section=section)
        model.gravity[:] = 0, 0, -GRAVITY
        model.clamp(beam.start)
        model.add_moment(beam.end, (0.2, 0.1, 0.3))
        state = ancf.equilibrium(model)
        result = ancf.simulate(model, t_end=0.2, step=1e-3, start=state)
        moved = np.linalg.norm(result.position(beam.end) - state.position(beam.end), axis=1)
        assert np.max(moved) < 1e-8

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_neutral_equilibrium(self, element):
        """Nothing holds the direction of a pinned cable without weight: it stays where it is."""
        model, beam = free_cable("straight", element=element)
        model.pin(beam.start)
        assert ancf.equilibrium(model).position(beam.end) == pytest.approx((0.9, 0.6, 0.5), abs=1e-9)


class TestMoments:
    """A moment has no potential: it does work on rotations, wherever they take the slope."""

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_balances_reaction(self, element):
        """The bending moment is the one applied, all along, whatever the shape."""
        section = square(element, EA=1e3, EI=2.0, rhoA=0.7)
        elements = FINE.get(element, 16)
        model, beam = free_cable("straight", element=element, elements=elements, section=section)
        model.clamp(beam.start)
        t = beam.node_tangent[0]
        M = 1.7 * np.cross(t, (0, 0, 1.0)) / np.linalg.norm(np.cross(t, (0, 0, 1.0)))
        model.add_moment(beam.end, M)
        state = ancf.equilibrium(model, load_steps=4)
        for x in (0.2, 0.5, 0.9):
            assert state.bending_moment(beam.at(x)) == pytest.approx(1.7, rel=1e-3)

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_with_weight(self, element):
        """Moment at the clamp: the applied one less the weight's."""
        model = ancf.Model(gravity=(0, 0, -GRAVITY))
        section = square(element, EA=1e5, EI=5.0, rhoA=0.2)
        beam = model.add_beam(
            "beam",
            start=(0, 0, 0),
            end=(1, 0, 0),
            elements=FINE.get(element, 16),
            section=section,
            element=element,
        )
        model.clamp(beam.start)
        model.add_moment(beam.end, (0, -3.0, 0))
        state = ancf.equilibrium(model)
        x = np.linspace(0, 1, 401)
        arm = np.trapezoid([state.position(beam.at(s))[0] for s in x], x)
        bar = 5e-3 if element == "original" else 2e-3  # its moment is constant in an element
        assert state.bending_moment(beam.start) == pytest.approx(3.0 - 0.2 * GRAVITY * arm, rel=bar)


def _elliptic(k):
    """Complete elliptic integral of the first kind of the modulus k, by the arithmetic-geometric mean."""
    a, b = 1.0, np.sqrt(1 - k * k)
    for _ in range(20):
        a, b = (a + b) / 2, np.sqrt(a * b)
    return np.pi / (2 * a)
