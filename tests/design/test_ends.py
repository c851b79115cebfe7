"""Derivatives of the initial state by ends of straight cables, without systems around their values."""

import numpy as np
import pytest

import ancf
from ancf.sensitivity.alike import Known
from ancf.sensitivity.family import Family
from ancf.sensitivity.parameters import parameters_of
from ancf.sensitivity.turns import ends_rates, slopes_local
from ancf.sensitivity.values import quiet_state
from ancf.system.system import System

PLACES = [f"beam.{end}[{k}]" for end in ("start", "end") for k in range(3)]


def cable(clamp=None, elements=3, **motion):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=100.0, EI=0.5, rhoA=0.1)
    beam = model.add_beam("beam", start=(0, 0.1, 0), end=(1, 0.3, 0.2), elements=elements, section=section)
    other = model.add_beam("other", start=(0, 1, 0), end=(1, 1, 0), elements=2, section=section)
    if clamp:
        model.clamp(beam.start, stretch=clamp)
    else:
        model.pin(beam.start)
    model.pin(other.end)
    if motion:
        beam.set_motion(**motion)
    return model


CASES = {
    "pinned": {},
    "pinned, more elements": {"elements": 10},
    "clamped": {"clamp": "free"},
    "stiff": {"clamp": "fixed"},
    "turning": {"angular_velocity": (1.0, -2.0, 3.0)},
    "turning about a place": {"angular_velocity": (1.0, -2.0, 3.0), "about": (0.5, 0.0, 0.0)},
    "moving": {"velocity": (1.0, 2.0, 3.0), "angular_velocity": (0.0, -2.0, 3.0)},
}


@pytest.mark.parametrize("place", PLACES)
@pytest.mark.parametrize("case", CASES)
def test_as_two_systems_have_it(case, place):
    model = cable(**CASES[case])
    system = System(model)
    [parameter] = parameters_of(system.model, [place], "test")
    h = 1e-5
    dq, dv = ends_rates(system, parameter.at(parameter.value + 3e-3), 3e-3)
    both = [quiet_state(System(parameter.at(parameter.value + e), like=system)) for e in (h, -h)]
    wanted = [(one - two) / (2 * h) for one, two in zip(*both, strict=True)]
    wanted[0][: system.n] = slopes_local(system, wanted[0])[: system.n]
    for mine, other in zip((dq, dv), wanted, strict=True):
        np.testing.assert_allclose(mine, other, rtol=0, atol=1e-9 * max(1.0, np.abs(other).max()))
    assert np.any(dq)


def test_motion_beside_axes_that_turn_takes_systems():
    model = cable("free")
    model.bodies["other"].set_motion(angular_velocity=(0, 1.0, 0), about=(1, 1, 0))
    system = System(model)
    [parameter] = parameters_of(system.model, ["beam.end[1]"], "test")
    assert ends_rates(system, parameter.at(0.31), 0.01) is None
    assert "systems" in vars(Family(parameter, system, shifts=True))


def test_velocities_along_a_body_take_systems():
    system = System(cable(along=[0.0, 1.0], velocities=[(0, 0, 0), (0, 0, 1.0)]))
    [parameter] = parameters_of(system.model, ["beam.end[1]"], "test")
    assert ends_rates(system, parameter.at(0.31), 0.01) is None


def test_systems_are_made_when_they_are_asked_for():
    system = System(cable("free"))
    families = [Family(p, system, shifts=True) for p in parameters_of(system.model, PLACES, "test")]
    for family in families:
        assert "systems" not in vars(family)
        near, here = family.systems
        assert here is system
        assert near.model.bodies["other"] is system.model.bodies["other"]
        assert not np.array_equal(near.initial_shape(), Known.of(system).initial_shape())


def test_tension_by_an_end():
    """A question that the numbers of the model have a part in asks for the system behind it."""
    model = cable("free")
    settings = {"t_end": 0.02, "step": 1e-3}
    result = ancf.simulate(model, sensitivities=["beam.end[0]"], **settings)
    found = result.sensitivity("beam.end[0]").tension("beam.at(0.4)")[-1]
    h = 1e-5
    near = [
        ancf.simulate(build(h * side), **settings).tension("beam.at(0.4)")[-1]
        for side in (1, -1)
        for build in [lambda e: parameters_of(model, ["beam.end[0]"], "test")[0].at(1.0 + e)]
    ]
    assert found == pytest.approx((near[0] - near[1]) / (2 * h), rel=1e-5)
