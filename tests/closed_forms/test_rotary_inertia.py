"""Rotary inertia given freely: Rayleigh's beam, twisting rods, what is written and refused."""

from __future__ import annotations

import numpy as np
import pytest

import ancf


def rayleigh(k, EI, rhoA, rhoI):
    """Frequencies in Hz of Rayleigh's beam on two pins, wave numbers k."""
    return np.sqrt(EI * k**4 / (rhoA + rhoI * k**2)) / (2 * np.pi)


@pytest.mark.parametrize(("length", "EI", "rhoA", "rhoI"), [(1.0, 100.0, 1.0, 0.02), (2.5, 7.0, 0.3, 0.08)])
def test_a_cable_on_two_pins(length, EI, rhoA, rhoI):
    found = {}
    for turned in (None, rhoI):
        model = ancf.Model()
        section = ancf.Section(EA=1e7, EI=EI, rhoA=rhoA, rotary_inertia=turned)
        nodes = np.linspace(0, length, 17)
        nodes[1:-1] += 0.01 * length * np.sin(7 * nodes[1:-1])
        beam = model.add_beam("beam", start=(0, 0, 0), end=(length, 0, 0), nodes=nodes, section=section)
        model.pin(beam.start)
        model.pin(beam.end)
        model.hold(beam.at(nodes[8]), position="y")
        found[turned] = np.array(ancf.modes(model, count=8).frequencies_hz)
    k = np.pi * np.arange(1, 4) / length
    for turned, frequencies in found.items():
        for wanted in rayleigh(k, EI, rhoA, turned or 0.0):
            assert np.min(np.abs(frequencies / wanted - 1)) < 2e-4


@pytest.mark.parametrize("factor", [1.0, 7.0])
def test_energy_of_a_spinning_cable(factor):
    """It turns as a whole about its middle: 1/2 (rhoA l^3/12 + rhoI l) omega^2, and goes on to do so."""
    section = ancf.Section(EA=1e8, EI=1e3, rhoA=2.0, rotary_inertia=0.05 * factor)
    model = ancf.Model()
    beam = model.add_beam("beam", start=(-0.5, 0, 0), end=(0.5, 0, 0), elements=3, section=section)
    beam.set_motion(angular_velocity=(0, 0, 3.0), about=(0, 0, 0))
    run = ancf.simulate(model, t_end=0.2, step=1e-3)
    wanted = 0.5 * (2.0 / 12 + 0.05 * factor) * 9.0
    assert run.energy.kinetic[0] == pytest.approx(wanted, rel=1e-12)
    assert run.energy.kinetic[-1] == pytest.approx(wanted, rel=1e-4)


@pytest.mark.parametrize("factor", [1.0, 3.0])
def test_torsional_frequencies_of_a_rod(factor):
    """omega = k sqrt(GJ/(rho I_y + rho I_z)) with the moments that are given."""
    plain = ancf.Section.circle(diameter=0.03, E=2e11, rho=7800.0, nu=0.3)
    moments = factor * 7800.0 * plain.I_y, 2 * factor * 7800.0 * plain.I_z
    section = ancf.Section.circle(diameter=0.03, E=2e11, rho=7800.0, nu=0.3, rotary_inertia=moments)
    model = ancf.Model()
    rod = model.add_beam(
        "rod", start=(0, 0, 0), end=(1, 0, 0), elements=12, section=section, element="nonlocking"
    )
    model.clamp(rod.start)
    for x in rod.node_x[1:]:
        model.hold(rod.at(float(x)), position="yz")
    found = np.array(ancf.modes(model, count=14).frequencies_hz)
    wanted = 0.25 * np.sqrt(section.G * section.J / sum(moments))
    assert np.min(np.abs(found / wanted - 1)) < 3e-3


def test_is_written_printed_and_varied():
    model = ancf.Model()
    section = ancf.Section(EA=1e4, EI=1.0, rhoA=1.0, rotary_inertia=0.25)
    model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    again = ancf.Model.from_dict(model.to_dict())
    assert again.beams["beam"].section.rotary_inertia == (0.25, 0.25)
    assert "rotary inertia" in str(section)


@pytest.mark.parametrize(
    ("given", "what"),
    [
        (0.0, "must be > 0"),
        (-1.0, "must be > 0"),
        ((1.0, 2.0), "a cable has one about all axes across it"),
        ((1.0,), "rotary_inertia"),
        ("much", "rotary_inertia"),
    ],
)
def test_what_does_not_fit(given, what):

    def cable():
        section = ancf.Section(EA=1e4, EI=1.0, rhoA=1.0, rotary_inertia=given)
        ancf.Model().add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)

    with pytest.raises(ancf.ModelError, match=what):
        cable()


def test_a_winch_knows_none():
    model = ancf.Model()
    section = ancf.Section(EA=1e4, EI=1.0, rhoA=1.0, rotary_inertia=0.1)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.pin(rope.start)
    model.winch(rope.start, length="1 + 0.1*t**2")
    with pytest.raises(ancf.ModelError, match="rotary_inertia"):
        ancf.simulate(model, t_end=0.01, step=1e-3)
