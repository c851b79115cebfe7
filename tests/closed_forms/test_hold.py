"""Held components that move: closed forms, other ways to say the same, the model file, bad input."""

import json
import warnings

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError
from ancf.model.file import parse_study
from helpers import soft

G = 9.81
SPEED = 3.0


def travelling(moves=True):
    """A mass on a spring below another one; both travel along x, the lower one is free to bounce."""
    model = ancf.Model(gravity=(0, 0, -G))
    top = model.add_point_mass("top", at=(0, 0, 1), mass=1.0)
    low = model.add_point_mass("low", at=(0, 0, 0), mass=2.0)
    model.add_spring(low, top, stiffness=80.0, name="spring")
    travel = (lambda t: (SPEED * t, 0.1 * t**2, 7.0)) if moves else None
    model.hold(top, position="z")
    model.hold(top, position="xy", displacement=travel)
    model.hold(low, position="xy", displacement=travel)
    return model, low, top


def driven_cable(support):
    """A cable under gravity whose end is moved; ``support(model, beam)`` says how."""
    model = ancf.Model(gravity=(0, 0, -G))
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1.5, 0, 0), elements=4, section=soft())
    model.clamp(beam.start)
    support(model, beam)
    return model, beam


def shake(t):
    return (0.1 * np.sin(3 * t) ** 3, 0.05 * np.sin(2 * t) ** 3, -0.2 * np.sin(2 * t) ** 3)


class TestClosedForms:
    def test_travelling_oscillator(self):
        """The bounce of a mass that travels along x and y is that of one that does not travel."""
        model, low, _ = travelling()
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        t, omega = result.t, np.sqrt(80.0 / 2.0)
        drop = 2.0 * G / 80.0
        place = np.stack([SPEED * t, 0.1 * t**2, -drop * (1 - np.cos(omega * t))], axis=1)
        # (omega h)^2/12 of the phase
        assert result.position(low) == pytest.approx(place, abs=drop * omega**3 * 1e-6 / 12 * 1.1)
        assert result.velocity(low)[:, 0] == pytest.approx(SPEED, abs=1e-9)

    def test_accelerated_mass(self):
        """Work done on a mass that is pushed along x while it falls: the kinetic energy it gets."""
        model = ancf.Model(gravity=(0, 0, -G))
        mass = model.add_point_mass("mass", at=(1, 2, 3), mass=2.0)
        model.hold(mass, position="x", displacement=("t**2", 0, 0))
        mass.set_motion(velocity=(0, 0.5, 0))
        result = ancf.simulate(model, t_end=0.8, step=1e-2)
        t = result.t
        wanted = np.stack([1 + t**2, 2 + 0.5 * t, 3 - G * t**2 / 2], axis=1)
        assert result.position(mass) == pytest.approx(wanted, abs=1e-10)
        assert result.energy.supplied == pytest.approx(0.5 * 2.0 * (2 * t) ** 2, abs=1e-8)
        assert result.energy.balance == pytest.approx(result.energy.balance[0], abs=1e-8)

    def test_rigid_body_spins_on(self):
        model = ancf.Model(gravity=(0, 0, -G))
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=2.0, inertia=(0.1, 0.1, 0.2))
        hub.set_motion(velocity=(SPEED, 0, 0), angular_velocity=(0, 0, 4.0))
        model.hold(hub, position="xy", displacement=lambda t: (SPEED * t, 0, 0))
        result = ancf.simulate(model, t_end=0.5, step=1e-3)
        t = result.t
        centre = np.stack([SPEED * t, 0 * t, -G * t**2 / 2], axis=1)
        assert result.position(hub.centre) == pytest.approx(centre, abs=1e-9)
        arm = result.position(hub.at(1, 0, 0)) - centre
        assert arm == pytest.approx(np.stack([np.cos(4 * t), np.sin(4 * t), 0 * t], axis=1), abs=1e-5)

    def test_stretched_by_one_component(self):
        """A bar whose end is moved along x carries EA u/L, and its end stays free along y and z."""
        model = ancf.Model()
        beam = model.add_beam("beam", start=(0, 0, 0), end=(2, 0, 0), elements=3, section=soft())
        model.clamp(beam.start)
        model.hold(beam.end, position="x", displacement=("0.1*t", 5.0, 5.0))
        state = ancf.equilibrium(model, time=2.0)
        assert state.position(beam.end) == pytest.approx([2.2, 0, 0], abs=1e-12)
        assert state.tension(beam.at(0.7)) == pytest.approx(40.0 * 0.1, rel=1e-10)


class TestTheSame:
    def test_all_components_are_a_pin(self):
        runs = [
            driven_cable(lambda m, b: m.pin(b.end, displacement=shake)),
            driven_cable(lambda m, b: m.hold(b.end, position="xyz", displacement=shake)),
        ]
        results = [ancf.simulate(model, t_end=0.5, step=5e-3) for model, _ in runs]
        np.testing.assert_array_equal(results[0].q, results[1].q)
        np.testing.assert_array_equal(results[0].energy.supplied, results[1].energy.supplied)

    def test_shared_node(self):
        """Held by the mass on the node or by the cable's end: one motion."""

        def by(which):
            def support(model, beam):
                mass = model.add_point_mass("mass", at=(1.5, 0, 0), mass=0.3)
                model.connect(mass, beam.end)
                model.hold(mass if which else beam.end, position="xz", displacement=shake)

            return driven_cable(support)

        results = [ancf.simulate(model, t_end=0.4, step=5e-3) for model, _ in (by(0), by(1))]
        np.testing.assert_array_equal(results[0].q, results[1].q)
        wanted = (1.5, 0) + np.array([shake(t) for t in results[0].t])[:, [0, 2]]
        assert results[0].position("mass")[:, [0, 2]] == pytest.approx(wanted, abs=1e-12)

    @pytest.mark.parametrize(
        "integrator", [ancf.Trapezoidal(), ancf.Radau(), ancf.Explicit()], ids=lambda i: i.name
    )
    def test_energy_balance(self, integrator):
        """Energy is balanced but for the error of the step, whoever integrates."""
        model, _ = driven_cable(lambda m, b: m.hold(b.end, position="xz", displacement=shake))
        result = ancf.simulate(model, t_end=0.5, step=1e-3, integrator=integrator)
        balance = result.energy.balance
        assert np.max(np.abs(result.energy.supplied)) > 0.1
        assert np.max(np.abs(balance - balance[0])) < 3e-4


class TestStart:
    def test_motion_that_agrees_is_silent(self):
        model, low, top = travelling()
        for mass in (low, top):
            mass.set_motion(velocity=(SPEED, 0, 0))
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            state = ancf.equilibrium(model)
        assert state.velocity(low) == pytest.approx([SPEED, 0, 0], abs=1e-9)

    def test_motion_that_differs_warns(self):
        model, low, _ = travelling()
        low.set_motion(velocity=(1.0, 0, 0.5))
        with pytest.warns(UserWarning, match="low position x.*the support wins"):
            result = ancf.simulate(model, t_end=0.01, step=1e-3)
        assert result.velocity(low)[0] == pytest.approx([SPEED, 0, 0.5], abs=1e-9)


FILE = {
    "gravity": [0, 0, -G],
    "bodies": [
        {"type": "point_mass", "name": "mass", "at": [1, 0, 0], "mass": 2.0},
        {"type": "point_mass", "name": "other", "at": [1, 0, 0], "mass": 1.0},
    ],
    "supports": [{"type": "hold", "point": "mass", "position": "x", "displacement": ["sin(t)", 0, 0]}],
}


class TestFile:
    def test_python_and_file_agree(self):
        study = parse_study(FILE)
        model = ancf.Model(gravity=(0, 0, -G))
        mass = model.add_point_mass("mass", at=(1, 0, 0), mass=2.0)
        model.add_point_mass("other", at=(1, 0, 0), mass=1.0)
        model.hold(mass, position="x", displacement=["sin(t)", 0, 0])
        assert study.model.to_dict() == model.to_dict()
        plain = json.loads(json.dumps(model.to_dict()))["supports"][0]
        assert (plain["position"], plain["displacement"]) == ("x", ["sin(t)", 0, 0])
        runs = [ancf.simulate(m, t_end=0.1, step=1e-2) for m in (study.model, model)]
        np.testing.assert_array_equal(runs[0].q, runs[1].q)

    def test_bad_displacement_is_named(self):
        bad = {**FILE, "supports": [{**FILE["supports"][0], "position": "", "displacement": [0, 0, 0]}]}
        with pytest.raises(ModelError, match=r"supports\[0\]"):
            parse_study(bad)


class TestBadInput:
    @pytest.mark.parametrize(
        ("given", "key", "phrase"),
        [
            ({"slope": "y", "displacement": (0, 0, 0)}, "displacement", "moves nothing"),
            ({"position": "x", "displacement": (0, 1)}, "displacement", "has 2 components"),
            ({"position": "x", "displacement": lambda t: 1.0}, "displacement", "wanted (3,)"),
            ({"displacement": (0, 0, 0)}, "position", "nothing is held"),
        ],
    )
    def test_refused(self, given, key, phrase):
        model = ancf.Model()
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=soft())
        with pytest.raises(ModelError) as caught:
            model.hold(beam.end, **given)
        assert caught.value.where == f"hold(beam.end).{key}"
        assert phrase in str(caught.value)

    def test_shared_node_moved_twice(self):
        model = ancf.Model()
        beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=soft())
        mass = model.add_point_mass("mass", at=(1, 0, 0), mass=1.0)
        model.connect(mass, beam.end)
        model.pin(beam.end)
        model.hold(mass, position="y", displacement=(0, "t", 0))
        with pytest.raises(ModelError, match=r'"pin at beam\.end" and "hold at mass" both hold'):
            ancf.equilibrium(model)
