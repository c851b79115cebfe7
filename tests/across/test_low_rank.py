"""One factorisation while droppers go slack and a contact moves: same motion as with a new one each time."""

from __future__ import annotations

import numpy as np
import pytest

import ancf

DROPPERS = (4.0, 8.0, 12.0, 16.0, 20.0, 24.0)


def line(damping: float = 5.0, speed: float = 50.0):
    """Two wires coupled by slack droppers, and a strip that runs along the lower one."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e6, EI=100.0, rhoA=1.0, damping=0.1)
    lower, upper = (
        model.add_beam(name, section=section, start=(0, 0, z), end=(28, 0, z), elements=28, length=27.7)
        for name, z in (("lower", 0.0), ("upper", 1.0))
    )
    for wire in (lower, upper):
        model.pin(wire.start)
        model.pin(wire.end)
    droppers = [
        model.add_spring(
            lower.at(x * 27.7 / 28),
            upper.at(x * 27.7 / 28),
            stiffness=1e5,
            damping=damping,
            length=0.995,
            slack=True,
        )
        for x in DROPPERS
    ]
    head = model.add_point_mass("head", at=(3, 0, 0.0), mass=5.0)
    model.hold(head, position="xy", displacement=[f"{speed}*t", 0, 0])
    head.set_motion(velocity=(speed, 0, 0))
    model.add_force(head, (0, 0, 5.0 * 9.81 + 150.0))
    contact = model.add_contact(head, lower, stiffness=50e3, damping=20.0)
    return model, droppers, contact


def run(newton, **given):
    model, droppers, contact = line(**given)
    result = ancf.simulate(
        model,
        t_end=0.4,
        step=1e-3,
        integrator=ancf.GeneralizedAlpha(0.8, newton=newton),
        sensors=[*droppers, contact],
    )
    sensors = result.sensors
    force = np.stack([sensors.spring_force(d) for d in droppers], axis=1)
    return result, force, sensors.contact_force(contact)


@pytest.fixture(scope="module")
def full():
    return run(ancf.Newton(modified=False, corotate=False, tolerance=1e-10))


def test_the_kept_factorisation_gives_the_same_motion(full):
    result, force, contact = run(ancf.Newton(corotate=False, tolerance=1e-10))
    switches = int(np.sum(np.diff((full[1] > 0.0).astype(int), axis=0) != 0))
    assert switches >= 8  # droppers did go slack and back
    assert np.max(np.abs(result.q[-1] - full[0].q[-1])) < 1e-6
    assert force == pytest.approx(full[1], abs=0.2)
    assert contact == pytest.approx(full[2], abs=0.2)
    assert result.stats.factorizations < 10 < full[0].stats.factorizations / 40


@pytest.mark.slow  # a time stepping of its own is compiled
def test_the_correction_saves_iterations(full, monkeypatch):
    """Without it the motion is the same, and takes more iterations."""
    from ancf.solvers import stepping

    plain = run(ancf.Newton(corotate=False, tolerance=1e-10))[0].stats
    monkeypatch.setattr(stepping, "room_for_patches", lambda system: ())
    result, _, contact = run(ancf.Newton(corotate=False, tolerance=1e-10))
    assert contact == pytest.approx(full[2], abs=0.2)
    assert result.stats.newton_iterations > plain.newton_iterations


def test_energies_can_be_left_out():
    model = line()[0]
    given = {"t_end": 0.05, "step": 1e-3}
    with_energy = ancf.simulate(model, **given)
    without = ancf.simulate(model, energy=False, **given)
    assert without.q == pytest.approx(with_energy.q, abs=1e-9)
    assert with_energy.energy.dissipated[-1] > 0.0
    with pytest.raises(ancf.ModelError, match="was not accounted for"):
        _ = without.energy
    assert without.state(-1).energy.total == pytest.approx(with_energy.energy.total[-1])
    with pytest.raises(ancf.ModelError, match=r"simulate\.energy"):
        ancf.simulate(model, energy="no", **given)


@pytest.mark.parametrize("damping", [0.0, 300.0])
def test_a_linear_spring_that_goes_slack_needs_nothing_but_the_correction(damping):
    """A weight on a spring and a rope is lifted: all is linear piece by piece, and one factorisation serves.

    The rope is in the kept matrix, goes slack, and carries again; both stiffnesses are about M/B.
    """
    model = ancf.Model(gravity=(0, 0, -9.81))
    ball = model.add_point_mass("ball", at=(0, 0, 0), mass=1.0)
    model.add_spring(ball, (0, 0, 1.0), stiffness=5e5, length=1.0)
    given = {"stiffness": 1e6, "damping": damping, "length": 1.0, "slack": True}
    rope = model.add_spring(ball, (0, 0, 1.0), **given, name="rope")
    model.add_force(ball, lambda t: (0, 0, 20 * np.sin(np.pi * (t - 0.02) / 0.1) ** 2 * (0.02 < t < 0.12)))
    newton = ancf.Newton(corotate=False)
    result = ancf.simulate(
        model,
        t_end=0.15,
        step=2e-3,
        start=ancf.equilibrium(model),
        integrator=ancf.Trapezoidal(newton=newton),
    )
    carries = result.spring_force(rope) > 0.0
    assert carries[0]
    assert carries[-1]
    assert np.sum(carries[1:] != carries[:-1]) >= 2
    assert result.stats.factorizations == 1
    assert result.stats.newton_iterations <= 2 * result.stats.steps + 10
