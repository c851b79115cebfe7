"""Natural shapes that are given as a curve: what is free of force, closed forms of bending, descriptions."""

from __future__ import annotations

import numpy as np
import pytest

import ancf

CABLE = ancf.Section(EA=1e5, EI=0.3, rhoA=0.2)
SQUARE = ancf.Section.rectangle(width=0.01, height=0.02, E=1e8, rho=800.0)
ELEMENTS = {"cable": CABLE, "original": SQUARE, "nonlocking": SQUARE}


def arc(radius: float, length: float):
    return lambda u: (radius * np.sin(u * length / radius), 0.0, radius * (1 - np.cos(u * length / radius)))


def wave(u):
    return u, 0.1 * np.sin(3 * u), 0.05 * u**2


class TestShape:
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_the_initial_shape_given_as_a_curve_is_free_of_force(self, element):
        """It is then the same beam as with natural_shape="path"."""
        states = []
        for natural in ("path", wave):
            model = ancf.Model()
            section = ELEMENTS[element]
            beam = model.add_beam(
                "beam", path=wave, elements=5, section=section, element=element, natural_shape=natural
            )
            model.clamp(beam.start)
            model.add_force(beam.end, (0.02, 0.01, -0.03))
            states.append(ancf.equilibrium(model))
        np.testing.assert_allclose(states[1].q, states[0].q, atol=1e-10)

    @pytest.mark.parametrize("size", [0.2, 1.0, 5.0])
    def test_only_bends_count_not_the_size(self, size):
        ends = []
        for scale in (1.0, size):
            model = ancf.Model()
            wire = model.add_beam(
                "wire",
                start=(0, 0, 0),
                end=(1, 0, 0),
                elements=8,
                section=CABLE,
                natural_shape=[(scale * x, 0.0, 0.3 * scale * x**2) for x in np.linspace(0, 1, 9)],
            )
            model.clamp(wire.start)
            model.add_force(wire.end, (0, 0, 0.05))
            ends.append(ancf.equilibrium(model).position(wire.end))
        np.testing.assert_allclose(ends[1], ends[0], atol=1e-9)


class TestClosedForms:
    @pytest.mark.parametrize("element", ["original", "nonlocking"])
    @pytest.mark.parametrize("radius", [0.7, 2.0])
    def test_a_straight_start_springs_back_into_its_arc(self, element, radius):
        """Of a beam with a section, whose bend has a direction: the end of the arc of its radius."""
        model = ancf.Model()
        beam = model.add_beam(
            "beam",
            start=(0, 0, 0),
            end=(1, 0, 0),
            elements=16 if element == "nonlocking" else 64,
            section=SQUARE,
            element=element,
            natural_shape=arc(radius, 1.0),
        )
        model.clamp(beam.start)
        end = ancf.equilibrium(model).position(beam.end)
        expected = radius * np.sin(1 / radius), 0.0, radius * (1 - np.cos(1 / radius))
        np.testing.assert_allclose(end, expected, atol=2e-4 if element == "nonlocking" else 2e-3)

    @pytest.mark.parametrize("radius", [0.5, 1.0, 3.0])
    def test_energy_of_a_cable_that_is_held_straight(self, radius):
        """EI l/(2 R^2); a straight cable rounds its curvature off by 1e-4 of the natural one."""
        for elements in (4, 16):
            model = ancf.Model()
            wire = model.add_beam(
                "wire",
                start=(0, 0, 0),
                end=(2, 0, 0),
                elements=elements,
                section=CABLE,
                natural_shape=arc(radius, 2.0),
            )
            model.clamp(wire.start, stretch="fixed")
            result = ancf.simulate(model, t_end=1e-7, step=1e-7)
            bent = 0.5 * CABLE.EI * 2.0 / radius**2
            assert result.energy.strain[0] == pytest.approx(
                bent, rel=0.25 * (2 / elements / radius) ** 4 + 3e-4
            )


class TestGiven:
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_a_description_keeps_it(self, element):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ELEMENTS[element]
        beam = model.add_beam(
            "beam",
            start=(0, 0, 0),
            end=(1, 0, 0.1),
            elements=4,
            section=section,
            element=element,
            natural_shape=wave,
        )
        model.clamp(beam.start)
        again = ancf.Model.from_dict(model.to_dict())
        one, two = (ancf.simulate(m, t_end=2e-3, step=1e-3) for m in (model, again))
        np.testing.assert_array_equal(two.position("beam.end"), one.position("beam.end"))
        if element == "cable":
            np.testing.assert_array_equal(two.tension("beam.start"), one.tension("beam.start"))

    @pytest.mark.parametrize(
        ("natural", "what"),
        [
            ([(0, 0, 0), (1, 0, 0)], "has 2 points"),
            ([(0, 0, 0)] * 4, "natural_shape"),
            ("curve", "natural_shape"),
            (3.0, "natural_shape"),
            ([(0, 0, 0), (1, 0, 0), (2, np.nan, 0)], "finite"),
        ],
    )
    def test_what_is_no_curve_is_named(self, natural, what):
        model = ancf.Model()
        with pytest.raises(ancf.ModelError, match=what) as info:
            model.add_beam(
                "wire", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=CABLE, natural_shape=natural
            )
        assert ".natural_shape" in info.value.where
