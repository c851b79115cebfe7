"""Sensitivities that follow a run with joints: remainders of order two, one correction where rows are few."""

import numpy as np
import pytest
from jointed import NEWTON, arms, machine, methods

import ancf
from ancf.model.vary import value_of
from ancf.sensitivity import follow
from ancf.solvers.derivatives.edge import edge_for
from ancf.system.system import System
from slopes import remainder_slopes

GIVEN = {"t_end": 0.0104, "step": 1e-3}
SLIDING = {
    "mass": {"mass": 0.2, "viscous": 0.3},
    "friction": {"mass": 0.1, "friction": 0.4, "friction_velocity": 0.2},
    "released": {"release": (0, 1, 0), "viscous": 0.1},
    "bare": {},
}
TIED = "tied"
NAMES = ["wire.EA", "wire.EI", "wire.rhoA", "wire.length", "bead.mass", "gravity"]


def beaded(way):
    """A point mass slides along a cable that swings, over the end of an element, or is tied to it."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=500.0, EI=0.5, rhoA=0.2)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section)
    model.pin(wire.start)
    bead = model.add_point_mass("bead", at=(0.3335, 0, 0), mass=0.3)
    model.add_force(bead, (-12.0, 5.0, 0.0))
    if way == TIED:
        model.connect(bead, wire.at(0.3335), name="knot")
    else:
        model.slide(bead, along=wire, name="ring", **SLIDING[way])
    return model


def names_of(way):
    own = {"mass": ["ring.mass", "ring.viscous"], "friction": ["ring.friction"], "released": ["ring.viscous"]}
    return NAMES + own.get(way, [])


def states(model, method, **more):
    return ancf.simulate(model, integrator=method, **GIVEN, **more)


@pytest.mark.parametrize("method", methods())
@pytest.mark.parametrize("way", SLIDING)
def test_remainders(way, method):
    """|f(p + h) - f(p) - h f'| of all states falls with the square of h over three decades."""
    model, names, integrator = beaded(way), names_of(way), methods()[method]
    result = states(model, integrator, sensitivities=names)
    places = np.setdiff1d(np.arange(result.system.size), result.system.multipliers)
    assert np.ptp(np.floor(result.arc_length("ring") * 3)) > 0  # from one element to the next
    for name in names:
        slope = result.sensitivity(name).dq[:, places]
        assert np.max(np.abs(slope)) * abs(value_of(model, name)) > 1e-7, name
        found = remainder_slopes(
            lambda m: states(m, integrator).q[:][:, places], model, name, slope, 1e-2, noise=3e-13
        )
        assert np.all(np.abs(found - 2.0) < 0.05), (name, found)


def by_rounds(monkeypatch):
    """Let nothing be solved at once."""
    monkeypatch.setattr(follow, "edge_for", lambda size, m: edge_for(0, m))


@pytest.mark.parametrize("method", methods())
@pytest.mark.parametrize("way", [*SLIDING, TIED])
def test_at_once_is_what_corrections_come_to(way, method, monkeypatch):
    """States, velocities and multipliers, to the end of corrections that go on until round-off."""
    model, names, integrator = beaded(way), names_of(way), methods()[method]
    assert 0 < len(System(model).multipliers) < 8
    once = states(model, integrator, sensitivities=names)
    by_rounds(monkeypatch)
    again = states(model, integrator, sensitivities=names)
    forces = once.system.multipliers
    places = np.setdiff1d(np.arange(once.system.size), forces)
    for name in names:
        one, two = once.sensitivity(name), again.sensitivity(name)
        for mine, other, chosen, enough in (
            (one.dq, two.dq, places, 1e-9),
            (one.dv, two.dv, places, 1e-9),
            (one.dq, two.dq, forces, 5e-8),
        ):
            size = np.max(np.abs(other[:, chosen]))
            assert np.max(np.abs(mine - other)[:, chosen]) < enough * size, (name, enough)


@pytest.mark.parametrize(
    ("build", "names"), [(arms, ["hub.mass", "gravity"]), (machine, ["hub.mass", "wire.EI"])]
)
@pytest.mark.parametrize("method", ["trapezoidal ggl", "generalized index2", "trapezoidal index1"])
def test_remainders_of_mechanisms(build, names, method):
    """Many rows, which corrections go through."""
    model, integrator = build(), methods()[method]
    result = states(model, integrator, sensitivities=names)
    places = np.setdiff1d(np.arange(result.system.size), result.system.multipliers)
    kept = []
    for name in names:
        slope = result.sensitivity(name).dq[:, places]
        found = remainder_slopes(
            lambda m: states(m, integrator).q[:][:, places], model, name, slope, 1e-2, noise=3e-13
        )
        assert np.all(np.abs(found - 2.0) < 0.05), (name, found)
        kept.append(len(found))
    assert max(kept) > 0  # of one of them it is not round-off


def test_more_lanes_than_parameters():
    """Each by itself, and all together: no lane knows of its neighbours."""
    method = ancf.Trapezoidal(newton=NEWTON, formulation="ggl")
    model, names = beaded("mass"), names_of("mass")
    more = [*names, "wire.start[1]", "wire.end[2]"]
    whole = states(model, method, sensitivities=more)
    for name in names:
        alone = states(model, method, sensitivities=[name]).sensitivity(name)
        assert np.max(np.abs(alone.dq - whole.sensitivity(name).dq)) <= 1e-10 * np.max(np.abs(alone.dq))


def tumbling(held):
    """A body that tumbles freely, and one that a ball joint holds."""
    model = ancf.Model(gravity=(0.3, 0.0, -9.81))
    inertia = {"mass": 0.5, "inertia": (0.002, 0.003, 0.004)}
    free = model.add_rigid_body("free", at=(0, 0, 0.2), **inertia)
    free.set_motion(velocity=(0.1, 0, -0.3), angular_velocity=(0.5, 1.0, 0.3))
    other = model.add_rigid_body("other", at=(0, 0, -0.1), **inertia)
    if held:
        model.connect(other.centre, (0, 0, -0.1))
    else:
        other.set_motion(angular_velocity=(0.5, 1.0, 0.3))
    return model


@pytest.mark.parametrize("name", ["free.inertia", "other.inertia"])
@pytest.mark.parametrize("held", [True, False])
@pytest.mark.parametrize("method", methods())
def test_what_joints_bear_alone(method, held, name):
    """The motion does not depend on how large an inertia is: the derivative is the round-off of forces."""
    given = {"t_end": 0.02, "step": 1e-3, "integrator": methods()[method]}
    run = ancf.simulate(tumbling(held), sensitivities=[name], **given)
    own = run.sensitivity(name)
    for point in ("free.at(0.1, 0, 0)", "other.at(0.1, 0, 0)"):
        assert np.max(np.abs(own.position(point))) < 1e-12
        assert np.max(np.abs(own.velocity(point))) < 1e-9
