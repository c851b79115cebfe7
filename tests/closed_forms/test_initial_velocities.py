"""Initial velocities of any shape: rigid motions, vibrations, energies; bad input."""

from __future__ import annotations

import numpy as np
import pytest

import ancf
from ancf.model.file import read_study

CABLE = ancf.Section(EA=1e5, EI=1e-6, rhoA=0.2)
SQUARE = ancf.Section.rectangle(width=0.02, height=0.01, E=1e9, rho=800.0, nu=0.3)
ELEMENTS = {"cable": CABLE, "original": SQUARE, "nonlocking": SQUARE}


def curved(element: str, elements: int = 5) -> tuple[ancf.Model, ancf.Beam]:
    model = ancf.Model()
    path = lambda u: (u, 0.2 * u**2, 0.1 * np.sin(2 * u))  # noqa: E731
    beam = model.add_beam("beam", path=path, elements=elements, section=ELEMENTS[element], element=element)
    return model, beam


class TestRigidMotion:
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_a_linear_field_is_a_translation_and_a_turn(self, element):
        """Of a straight beam that turns about an axis normal to it: every vector of every node."""
        spin, start = np.array([0.3, -0.7, 1.1]), np.array([0.4, -0.2, 0.9])
        end = start + np.cross(spin, [0.3, 2.0, -1.0])  # the beam is normal to the spin
        states = []
        for shaped in (False, True):
            model = ancf.Model()
            section = ELEMENTS[element]
            beam = model.add_beam("beam", start=start, end=end, elements=4, section=section, element=element)
            if shaped:
                field = [np.cross(spin, r - start) + np.array([1, 2, 3]) for r in (start, end)]
                beam.set_motion(along=[0.0, beam.length], velocities=field)
            else:
                beam.set_motion(velocity=(1, 2, 3), angular_velocity=spin)
            result = ancf.simulate(model, t_end=1e-6, step=1e-6)
            states.append(result.state(0).v)
        assert np.max(np.abs(states[0])) > 1.0
        np.testing.assert_allclose(states[1], states[0], atol=1e-12)

    def test_it_adds_to_the_rigid_motion(self):
        model, beam = curved("cable")
        beam.set_motion(velocity=(0, 0, 2), along=[0, 0.5, 1.0], velocities=[(0, 0, 0), (0, 1, 0), (0, 0, 0)])
        result = ancf.simulate(model, t_end=1e-6, step=1e-6)
        np.testing.assert_allclose(result.velocity(beam.at(0.5))[0], (0, 1, 2), atol=0.02)
        np.testing.assert_allclose(result.velocity(beam.start)[0], (0, 0, 2), atol=1e-12)


class TestVibration:
    @pytest.mark.parametrize("mode", [1, 2, 3])
    def test_taut_string(self, mode):
        """w = v0/omega sin(mode pi x/l) sin(omega t), omega = mode pi/l sqrt(T/rhoA)."""
        length, strain, v0 = 2.0, 1e-3, 1e-3
        model = ancf.Model()
        wire = model.add_beam(
            "wire",
            start=(0, 0, 0),
            end=(length, 0, 0),
            length=length / (1 + strain),
            elements=24,
            section=CABLE,
        )
        model.pin(wire.start)
        model.pin(wire.end)
        x = np.linspace(0.0, wire.length, 25)
        wave = v0 * np.sin(mode * np.pi * x / wire.length)
        wire.set_motion(along=x, velocities=np.outer(wave, (0, 0, 1)))
        omega = mode * np.pi / length * np.sqrt(CABLE.EA * strain / (CABLE.rhoA / (1 + strain)))
        result = ancf.simulate(model, t_end=2 * np.pi / omega, step=2 * np.pi / omega / 400)
        place = wire.at(wire.length / (2 * mode))
        expected = v0 / omega * np.sin(omega * result.t)
        assert np.max(np.abs(result.position(place)[:, 2] - expected)) < 2e-3 * v0 / omega

    @pytest.mark.parametrize("element", ["original", "nonlocking"])
    def test_energy_of_a_bending_wave(self, element):
        """Kinetic energy at the start is half the integral of rhoA v^2 and of rho I omega^2."""
        model = ancf.Model()
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(1, 0, 0), elements=32, section=SQUARE, element=element
        )
        x = np.linspace(0.0, 1.0, 129)
        beam.set_motion(along=x, velocities=np.outer(0.1 * np.sin(np.pi * x), (0, 0, 1)))
        result = ancf.simulate(model, t_end=1e-6, step=1e-6)
        inertia = 800.0 * 0.02 * 0.01**3 / 12
        expected = 0.25 * SQUARE.rhoA * 0.01 + 0.25 * inertia * (0.1 * np.pi) ** 2
        assert result.energy.kinetic[0] == pytest.approx(expected, rel=1e-6)


class TestGiven:
    def test_a_description_keeps_it(self):
        model, beam = curved("original")
        beam.set_motion(velocity=(1, 0, 0), along=[0, 0.4, 1.0], velocities=np.eye(3))
        again = ancf.Model.from_dict(model.to_dict())
        one, two = (ancf.simulate(m, t_end=2e-6, step=1e-6).state(-1) for m in (model, again))
        np.testing.assert_array_equal(one.v, two.v)

    def test_in_a_file(self, tmp_path):
        file = tmp_path / "wire.toml"
        file.write_text(
            """
            [sections.wire]
            EA = 1e4
            EI = 0.1
            rhoA = 0.3

            [[bodies]]
            type = "beam"
            name = "wire"
            start = [0, 0, 0]
            end = [1, 0, 0]
            elements = 4
            section = "wire"

            [bodies.motion]
            velocity = [0, 1, 0]
            along = [0, 0.5, 1]
            velocities = [[0, 0, 0], [0, 0, 1], [0, 0, 0]]

            [simulation]
            t_end = 1e-6
            step = 1e-6
            """
        )
        study = read_study(file)
        beam = study.model.bodies["wire"]
        np.testing.assert_array_equal(beam.velocities[1], (0, 0, 1))
        np.testing.assert_array_equal(beam.velocity, (0, 1, 0))

    @pytest.mark.parametrize(
        ("given", "where", "what"),
        [
            ({"along": [0, 1]}, "velocities", "is missing"),
            ({"velocities": [(0, 0, 0)] * 2}, "along", "is missing"),
            ({"along": [0, 0.5], "velocities": [(0, 0, 0)] * 3}, "velocities", "3 rows for 2"),
            ({"along": [0.5, 0.5], "velocities": [(0, 0, 0)] * 2}, "along", "increasing"),
            ({"along": [0.5], "velocities": [(0, 0, 0)]}, "along", "two"),
            ({"along": [0.0, 7.0], "velocities": [(0, 0, 0)] * 2}, "along", "7 m"),
            ({"along": [0.0, 1.0], "velocities": [(0, 0), (0, 0)]}, "velocities", "shape"),
            ({"along": [0.0, np.nan], "velocities": [(0, 0, 0)] * 2}, "along", "finite"),
        ],
    )
    def test_what_does_not_fit_is_named(self, given, where, what):
        _, beam = curved("cable")
        with pytest.raises(ancf.ModelError) as info:
            beam.set_motion(**given)
        assert f".{where}" in info.value.where
        assert what in str(info.value)
