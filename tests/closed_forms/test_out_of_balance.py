"""Modes of states that are no equilibrium, that rotate, or that are none that is stable: refused or noted."""

import re

import numpy as np
import pytest
from scipy.special import jn_zeros

import ancf
from ancf.errors import ModelError, SolveError

G = 9.81
BEAM = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)


def chain(gravity=G):
    """A chain of 1 m that hangs from its start, drawn straight and unstretched."""
    model = ancf.Model(gravity=(0, 0, -gravity))
    rope = ancf.Section(EA=1e7, EI=1e-6, rhoA=1.0)
    beam = model.add_beam("chain", start=(0, 0, 0), end=(0, 0, -1), elements=20, section=rope)
    model.pin(beam.start)
    return model


def cantilever(load=None, **clamped):
    model = ancf.Model()
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=BEAM)
    model.clamp(beam.start, **clamped)
    if load is not None:
        model.add_follower_force(beam.end, (-load, 0, 0))
    return model, beam


class TestRefused:
    @pytest.mark.parametrize("ask", [ancf.modes, ancf.damped_modes])
    def test_a_chain_as_drawn(self, ask):
        """Its tension, all of its stiffness, is not there before it has stretched."""
        with pytest.raises(ModelError, match=r"no equilibrium, 9\.\d+ N are out of balance") as caught:
            ask(chain())
        assert caught.value.where == f"{ask.__name__}.about"
        assert "about=ancf.equilibrium(model)" in caught.value.hint

    def test_of_its_equilibrium(self):
        """Bessel: J0(2 w sqrt(L/g)) = 0."""
        model = chain()
        found = ancf.modes(model, about=ancf.equilibrium(model), count=3)
        assert found.frequencies[0] == pytest.approx(0.5 * jn_zeros(0, 1)[0] * np.sqrt(G), rel=2e-3)
        assert found.notes == []

    @pytest.mark.parametrize("ask", [ancf.modes, ancf.damped_modes])
    def test_under_a_following_load(self, ask):
        """At 1.5 times Beck's load a column that does not yet carry it shows no flutter."""
        model, _ = cantilever(load=1.5 * 20.05)
        with pytest.raises(ModelError, match=r"30\.\d* N are out of balance, most of it at beam\.end"):
            ask(model)
        about = ancf.equilibrium(model)
        growth = ancf.damped_modes(model, about=about, count=2)
        assert growth.eigenvalues.real.max() > 1.0
        assert growth.notes == []
        assert "flutters: grows" in str(growth)

    def test_a_moment(self):
        """Of a moment on a body it says N m."""
        model = ancf.Model()
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=1.0, inertia=(0.1, 0.1, 0.1))
        model.hinge(hub, (0, 0, 0), axis=(0, 0, 1))
        model.add_torsion_spring(hub, (0, 0, 0), axis=(0, 0, 1), stiffness=5.0, angle=-0.6)
        with pytest.raises(ModelError, match=r"3 N m are out of balance, most of it at hub "):
            ancf.modes(model, count=1)
        about = ancf.equilibrium(model)
        assert ancf.modes(model, about=about, count=1).frequencies[0] == pytest.approx(np.sqrt(50.0))

    def test_a_joint_that_does_not_carry_yet(self):
        """All stiffness of a pendulum is that of the force in its joint: m g l/I about the hinge."""
        model = ancf.Model(gravity=(0, 0, -G))
        bob = model.add_rigid_body("bob", at=(0, 0, -0.5), mass=2.0, inertia=(0.1, 0.1, 0.1))
        model.hinge(bob.at(0, 0, 0.5), (0, 0, 0), axis=(0, 1, 0))
        with pytest.raises(ModelError, match=r"19\.6 N are out of balance, most of it at bob"):
            ancf.modes(model, count=1)
        about = ancf.equilibrium(model)
        wanted = np.sqrt(2.0 * G * 0.5 / (0.1 + 2.0 * 0.25))
        assert ancf.modes(model, about=about, count=1).frequencies[0] == pytest.approx(wanted, rel=1e-9)


class TestNoted:
    def test_a_state_of_another_load(self):
        other = chain(20.0)
        found = ancf.modes(other, about=ancf.equilibrium(chain()), count=1)
        [note] = found.notes
        assert re.search(r"9\.\d+ N are out of balance", note)
        assert "out of balance" in " ".join(str(found).split())
        [same] = ancf.damped_modes(other, about=ancf.equilibrium(chain()), count=1).notes
        assert same == note

    @pytest.mark.parametrize("length", [1.0, 0.98])
    def test_what_is_in_balance_says_nothing(self, length):
        """Bare and prestressed beams, free and held, are equilibria as they are drawn."""
        model = ancf.Model()
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), length=length, elements=4, section=BEAM)
        if length < 1.0:
            model.pin(beam.start)
            model.pin(beam.end)
        assert ancf.modes(model, count=7).notes == []
        assert ancf.damped_modes(model, count=7).notes == []

    def test_a_curve_without_forces(self):
        model = ancf.Model()
        arc = lambda u: (np.sin(2 * u), 0, 1 - np.cos(2 * u))  # noqa: E731
        model.add_beam("hook", path=arc, elements=6, section=BEAM)
        [note] = ancf.modes(model, count=7).notes
        assert "nothing resists that this bend turns" in note  # and nothing is out of balance

    def test_gravity_off_a_taut_wire(self):
        """A sag of a ten-thousandth of the span is none: N = 2e4 N, 10 N of weight."""
        model = ancf.Model(gravity=(0, 0, -G))
        wire = model.add_beam("wire", start=(0, 0, 0), end=(1, 0, 0), length=0.98, elements=8, section=BEAM)
        model.pin(wire.start)
        model.pin(wire.end)
        found = ancf.modes(model, count=2)
        assert found.notes == []
        bent = ancf.modes(model, about=ancf.equilibrium(model), count=2)
        assert found.frequencies == pytest.approx(bent.frequencies, rel=1e-4)

    def test_a_rotation(self):
        """Southwell: a rotating blade is stiffer, by more than its speed; at standstill it is not."""
        still, _ = cantilever()
        rate = 50.0
        model, beam = cantilever(rotation=lambda t: rate * t)
        beam.set_motion(angular_velocity=(0, 0, rate))
        found = ancf.modes(model, count=2)
        assert found.frequencies == pytest.approx(ancf.modes(still, count=2).frequencies)
        assert found.notes == [f"the model rotates with 50 rad/s: {_LEFT_OUT}"]
        assert "the model rotates" in str(found)
        turning = ancf.damped_modes(model, count=2)
        assert turning.notes == []
        assert turning.eigenvalues.imag.max() > rate

    def test_a_support_that_moves(self):
        model, _ = cantilever(displacement=lambda t: (0, 0, 3.0 * t))
        assert ancf.modes(model, count=1).notes == [
            "a support moves in this state: modes() holds it where it is"
        ]

    @pytest.mark.parametrize("angle", [0.0, 0.5, "0.3", lambda t: 0.2, -3.0, 1e3])
    @pytest.mark.parametrize("of", ["a node", "a body"])
    def test_a_clamp_that_is_turned_rests(self, of, angle):
        """Differences of an angle that does not change leave rounding, which is no motion."""
        model, _ = cantilever(**({} if of == "a body" else {"rotation": angle, "axis": (0, 1, 0)}))
        if of == "a body":
            drum = model.add_rigid_body("drum", at=(0, 2, 0), mass=1.0, inertia=(1.0, 1.0, 1.0))
            model.clamp(drum, rotation=angle, axis=(0, 1, 0))
        assert ancf.modes(model, about=ancf.equilibrium(model), count=1).notes == []

    @pytest.mark.parametrize("rate", [1e-6, -1e-3, 2.0])
    def test_a_clamp_that_turns_slowly_moves(self, rate):
        model, _ = cantilever(rotation=lambda t: rate * t)
        assert ancf.modes(model, count=1).notes == [
            "a support moves in this state: modes() holds it where it is"
        ]

    def test_a_flight_is_no_rotation(self):
        model = ancf.Model()
        model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=BEAM).set_motion(
            velocity=(3, 0, 1)
        )
        assert ancf.modes(model, count=7).notes == []


_LEFT_OUT = "modes() leaves that out, ancf.damped_modes(model) has it"


class TestUnstable:
    def test_an_equilibrium_that_was_given(self):
        """What was given is not asked for once more."""
        model, _ = cantilever(load=50.0)
        with pytest.raises(SolveError, match="omega") as caught:
            ancf.modes(model, about=ancf.equilibrium(model), count=1)
        assert "about=" not in caught.value.hint
        assert "ancf.damped_modes" in caught.value.hint
        assert caught.value.hint in str(caught.value)


class TestPrinted:
    def test_damped_modes(self):
        """Hz, share of the critical damping, and what each mode does."""
        model = ancf.Model()
        mass = model.add_point_mass("mass", at=(0, 0, 1), mass=2.0)
        model.hold(mass, position="xy")
        model.add_spring(mass, (0, 0, 0), stiffness=200.0, damping=4.0)
        lines = str(ancf.damped_modes(model, count=1)).splitlines()
        assert lines[0] == "DampedModes"
        cells = lines[-1].split()
        damping = 4.0 / (2 * np.sqrt(200.0 * 2.0))
        swing = np.sqrt(100.0) * np.sqrt(1 - damping**2)
        assert [float(x) for x in cells[1:]] == pytest.approx(
            [swing / (2 * np.pi), damping, -1.0, swing], rel=1e-5
        )
        assert (
            repr(ancf.damped_modes(model, count=1))
            == f"DampedModes(1 mode, {swing / (2 * np.pi):.4g} to {swing / (2 * np.pi):.4g} Hz)"
        )
