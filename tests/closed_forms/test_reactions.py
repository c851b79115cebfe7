"""Reactions of supports: closed forms, balance with all loads, local axes, shared nodes, bad questions."""

import numpy as np
import pytest
from scipy.optimize import fsolve

import ancf
from ancf.errors import ModelError
from helpers import arc, soft, square

G = 9.81
WIRE = {"EA": 1e5, "EI": 0.5, "rhoA": 0.8}


def span(element="cable", elements=8, **more):
    """A sagging cable or a beam under gravity between two points of different height."""
    model = ancf.Model(gravity=(0, 0, -G))
    given = {"element": element, "elements": elements, **more}
    beam = model.add_beam("wire", start=(0, 0, 0), end=(10, 0, 1), section=square(element, **WIRE), **given)
    return model, beam


def total(state, model):
    return sum(state.reaction(support) for support in model.supports)


class TestClosedForms:
    def test_cable_under_gravity(self):
        """End forces of Irvine's elastic catenary, which has no bending stiffness."""
        model = ancf.Model(gravity=(0, 0, -G))
        section = ancf.Section(EA=1e5, EI=1e-3, rhoA=0.8)
        given = {"length": 10.6, "elements": 40, "section": section}
        beam = model.add_beam("wire", start=(0, 0, 0), end=(10, 0, 1), **given)
        left, right = model.pin(beam.start), model.pin(beam.end)
        state = ancf.equilibrium(model)
        w, length = 0.8 * G, 10.6

        def miss(force):
            H, V = force  # that the right end receives
            low, high = (V - w * length) / H, V / H
            x = H * length / 1e5 + H / w * (np.arcsinh(high) - np.arcsinh(low))
            z = (V - w * length / 2) * length / 1e5 + H / w * (np.hypot(1, high) - np.hypot(1, low))
            return x - 10, z - 1

        H, V = fsolve(miss, (50.0, 50.0), xtol=1e-12)
        assert state.reaction(right) == pytest.approx([H, 0, V], rel=2e-5, abs=1e-9)
        assert state.reaction("pin at wire.start") == pytest.approx(
            [-H, 0, w * length - V], rel=2e-5, abs=1e-9
        )
        assert state.reaction(left) + state.reaction(right) == pytest.approx([0, 0, w * length], abs=1e-7)

    def test_stretched_bar(self):
        model = ancf.Model()
        beam = model.add_beam("bar", start=(0, 0, 0), end=(2, 0, 0), elements=2, length=1.9, section=soft())
        left, right = model.clamp(beam.start), model.clamp(beam.end, stretch="fixed")
        state = ancf.equilibrium(model)
        tension = 40.0 * (2 / 1.9 - 1)
        assert state.reaction(left) == pytest.approx([-tension, 0, 0], rel=1e-9, abs=1e-9)
        assert state.reaction(right) == pytest.approx([tension, 0, 0], rel=1e-9, abs=1e-9)

    def test_simple_beam_with_a_point_load(self):
        """Force at a third of a simply supported beam: two thirds and one third, nothing along it."""
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=1e3, rhoA=1.0)
        beam = model.add_beam("bar", start=(0, 0, 0), end=(3, 0, 0), elements=3, section=section)
        left, right = model.pin(beam.start), model.hold(beam.end, position="yz")
        model.add_force(beam.at(1.0), lambda t: (0, 0, -0.3 * t))
        state = ancf.equilibrium(model, time=2.0)
        assert state.reaction(left) == pytest.approx([0, 0, 0.4], abs=1e-6)
        assert state.reaction(right) == pytest.approx([0, 0, 0.2], abs=1e-6)

    def test_mass_on_a_spring(self):
        """A mass held sideways between springs: the ground takes what the springs leave."""
        model = ancf.Model(gravity=(0, 0, -G))
        mass = model.add_point_mass("mass", at=(0, 0, 0), mass=2.0)
        model.add_spring(mass, (0, 0, 1), stiffness=300.0, name="hanger")
        model.add_spring(mass, (0.5, 0, 0), stiffness=40.0, length=0.2, name="side")
        hold = model.hold(mass, position="xy")
        state = ancf.equilibrium(model)
        pull = state.spring_force("side") * (np.array([0.5, 0, 0]) - state.position(mass))
        pull /= state.spring_length("side")
        assert state.reaction(hold) == pytest.approx([-pull[0], 0, 0], abs=1e-9)
        assert state.reaction(hold)[0] < -1.0


class TestBalance:
    @pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
    def test_everything_that_loads(self, element):
        """Reactions of clamps with local axes, pins and holds balance all loads."""
        model, beam = span(element, 6 if element == "cable" else 3)
        model.clamp(beam.start)
        node = beam.at(float(beam.node_x[2]))
        model.hold(node, position="y")
        model.hold(beam.end, position="z", slope="y")
        mass = model.add_point_mass("mass", at=(0, 4, 3), mass=0.7)
        model.pin(mass)
        model.add_spring(mass, beam.at(1.1), stiffness=20.0, length=2.0)
        model.add_force(beam.at(2.2), (1.0, 0.3, -0.5))
        model.add_distributed_load(beam, (0, 0.4, 0), between=(1.0, 3.0))
        state = ancf.equilibrium(model, load_steps=2)
        loads = np.array([1.0, 0.3 + 0.8, -0.5 - G * (0.7 + 0.8 * beam.length)])
        assert total(state, model) == pytest.approx(-loads, abs=1e-6)

    def test_rigid_body_and_turned_clamp(self):
        """A rigid body held at its centre carries a cable whose clamp is turned: global components."""
        model = ancf.Model(gravity=(0, 0, -G))
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=3.0, inertia=(0.1, 0.1, 0.1))
        section = ancf.Section(**WIRE)
        beam = model.add_beam("wire", path=lambda u: np.add(arc(u), (0, 0, 0.3)), elements=6, section=section)
        start = beam.node_position[0]
        joint = model.connect(hub.at(*start), beam.start)
        model.clamp(hub)
        model.clamp(beam.end, rotation="0.3", axis=(0, 1, 1))
        state = ancf.equilibrium(model)
        wanted = [0, 0, G * (3.0 + 0.8 * beam.length)]
        assert total(state, model) == pytest.approx(wanted, abs=1e-6)
        # the ground carries the hub's weight and what the hub gives to the wire
        hub_force = np.array([0, 0, 3.0 * G]) + state.multiplier(joint)
        assert state.reaction("clamp at hub.centre") == pytest.approx(hub_force, abs=1e-6)
        assert np.linalg.norm(state.multiplier(joint)) > 1.0

    def test_shared_node(self):
        """Two cables and a mass at one node, held there by three supports: each force counts once."""
        model, beam = span(length=10.5)
        other = model.add_beam("other", start=(10, 0, 1), end=(15, 2, 0), elements=4, section=square(**WIRE))
        mass = model.add_point_mass("mass", at=(10, 0, 1), mass=1.5)
        model.connect(mass, beam.end)
        model.connect(mass, other.start)
        supports = [
            model.hold(mass, position="z"),
            model.hold(beam.end, position="yz"),
            model.hold(other.start, position="x"),
        ]
        model.pin(beam.start)
        model.pin(other.end)
        state = ancf.equilibrium(model)
        weight = G * (1.5 + 0.8 * (beam.length + other.length))
        assert total(state, model) == pytest.approx([0, 0, weight], abs=1e-6)
        forces = [state.reaction(s) for s in supports]
        held = [[f != 0.0 for f in force] for force in forces]
        assert held == [[False, False, True], [False, True, False], [True, False, False]]

    def test_loads_of_the_state_s_time(self):
        model = ancf.Model()
        mass = model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
        pin = model.pin(mass)
        model.add_force(mass, ("2*t", 0, "-t**2"))
        assert ancf.equilibrium(model, time=3.0).reaction(pin) == pytest.approx([-6, 0, 9])
        assert ancf.equilibrium(model).reaction(pin) == pytest.approx([0, 0, 0])

    def test_part_of_a_model(self):
        """With `of` the bodies in equilibrium answer, also where they share a node with one left out."""
        model, beam = span(length=10.5)
        arm = model.add_beam("arm", start=(10, 0, 1), end=(12, 0, 1), elements=2, section=soft())
        model.connect(beam.end, arm.start)
        pins = model.pin(beam.start), model.clamp(arm.end)
        state = ancf.equilibrium(model, of=[beam])
        # the shared node is where the arm is: only the wire's own start is known
        assert state.reaction(pins[0])[2] == pytest.approx(0.5 * G * 0.8 * 10.5, rel=0.2)
        with pytest.raises(ModelError, match='"arm" is not in equilibrium'):
            state.reaction(pins[1])


def pushed(law, spin=0.0):
    """A beam whose tip a support pushes down, with a damper beside it, and whose clamp may turn."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e5, EI=10.0, rhoA=0.2, damping=0.3)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
    model.clamp(beam.start, rotation=spin, axis=(0.0, 1.0, 0.0), name="root")
    model.hold(beam.end, position="z", displacement=(0, 0, law), name="push")
    model.add_spring(beam.end, (1, 0, 1), stiffness=1e-6, damping=20.0)
    return model


LAWS = {
    "-0.01*t": lambda t: -0.01 * t,
    "-0.005*t**2": lambda t: -0.005 * t**2,
    "-0.02*sin(0.5*pi*t)": lambda t: -0.02 * np.sin(0.5 * np.pi * t),
}


class TestWhileSupportsMove:
    """An equilibrium at a time is that of supports that stand: so are its reactions."""

    @pytest.mark.parametrize("law", LAWS)
    @pytest.mark.parametrize("t", [0.5, 2.0])
    @pytest.mark.parametrize("spin", [0.0, "0.02*t"])
    def test_they_are_those_of_supports_at_rest(self, law, t, spin):
        place = LAWS[law](t)
        moving = ancf.equilibrium(pushed(law, spin), time=t)
        still = ancf.equilibrium(pushed(place, 0.02 * t if spin else 0.0))
        for name in ("push", "root"):
            assert moving.reaction(name) == pytest.approx(still.reaction(name), abs=1e-7)
        assert moving.reaction_moment("root") == pytest.approx(still.reaction_moment("root"), abs=1e-7)

    @pytest.mark.parametrize("rate", [0.5, 3.0])
    def test_what_was_set_off_is_in_motion(self, rate):
        """A rod that hangs from a pin and swings against a damper at its end, whose force the pin feels."""
        model = ancf.Model(gravity=(0, 0, -G))
        given = {"start": (0, 0, 0), "end": (0, 0, -2.0), "elements": 1}
        rod = model.add_beam("rod", section=ancf.Section(EA=1e5, EI=1e3, rhoA=0.7), **given)
        rod.set_motion(angular_velocity=(0.0, rate, 0.0))
        model.pin(rod.start, name="pin")
        model.add_spring(rod.end, (1, 0, -2), stiffness=1e-3, damping=10.0)
        force = 10.0 * 2.0 * rate
        assert 0.1 * force < ancf.equilibrium(model).reaction("pin")[0] < 0.9 * force


class TestRefused:
    def test_unknown_support(self):
        model, beam = span(length=10.5)
        model.pin(beam.start, name="mast")
        model.pin(beam.end)
        state = ancf.equilibrium(model)
        for name in ("mest", 4, ["mast"]):
            with pytest.raises(ModelError, match=r'unknown support .*"mast", "pin at wire\.end"'):
                state.reaction(name)
