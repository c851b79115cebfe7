"""Derivatives of equilibria of some bodies by where the others are described, and of runs from there."""

import numpy as np
import pytest

import ancf
from ancf.model.vary import value_of, varied

ROPE = ancf.Section(EA=1e4, EI=0.05, rhoA=0.2, diameter=0.02)


def beside(other):
    """A mass on springs, of which one goes to what is left out."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    mass = model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
    if other == "mass":
        end = model.add_point_mass("other", at=(0, 0, 1.0), mass=1.0)
    elif other == "cable":
        cable = model.add_beam("other", start=(-0.5, 0, 1), end=(0.5, 0.2, 1), elements=2, section=ROPE)
        end = cable.at(0.6)
        model.pin(cable.end)
    else:
        body = model.add_rigid_body("other", at=(0, 0, 1.0), mass=1.0, inertia=(1, 1, 1))
        end = body.at(0.1, 0.2, 0)
        if other == "hinge":
            model.hinge(body, (0, 0, 1.0), axis=(0, 1, 0))
    model.add_spring(mass, end, stiffness=100.0, length=0.5)
    for place in ((0, 1, 0), (1, -1, 0)):
        model.add_spring(mass, place, stiffness=50.0, length=0.5)
    return model, ["mass"], ["mass"]


def over_a_pulley(friction):
    """A rope that hangs over a pulley on a hinge, held at one end and loaded at the other."""
    angle, radius = np.linspace(0.0, np.pi, 40), 0.21
    arc = radius * np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    path = [arc[0] - (0, 0, 0.3), *arc, arc[-1] - (0, 0, 0.3)]
    model = ancf.Model(gravity=(0, 0, -9.81))
    rope = model.add_beam("rope", path=path, elements=20, section=ROPE, natural_shape="straight")
    pulley = model.add_rigid_body("other", at=(0, 0, 0), mass=2.0, inertia=(0.1, 0.1, 0.1))
    model.hinge(pulley, (0, 0, 0), axis=(0, 1, 0))
    drum = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0, 1, 0)), on=pulley)
    model.add_contact(rope, drum, stiffness=1e6, damping=1e3, friction=friction)
    model.pin(rope.start)
    model.add_force(rope.end, (0, 0, -50.0))
    return model, ["rope"], ["rope.end", "rope.at(0.5)"]


MODELS = {
    "mass": (lambda: beside("mass"), ["other.at[0]", "other.at[2]"]),
    "body": (lambda: beside("body"), ["other.at[1]", "other.at[2]"]),
    "hinge": (lambda: beside("hinge"), ["other.at[0]", "other.at[2]"]),
    "cable": (lambda: beside("cable"), ["other.start[0]", "other.start[2]", "other.end[1]"]),
    "pulley": (lambda: over_a_pulley(0.0), ["other.at[0]", "other.at[2]"]),
    "rough pulley": (lambda: over_a_pulley(0.2), ["other.at[2]"]),
}


@pytest.mark.parametrize("build", MODELS)
def test_against_differences(build):
    """They were 0, that of the place of the body itself too."""
    (make, names), h = MODELS[build], 1e-6
    model, of, points = make()
    state = ancf.equilibrium(model, of=of, sensitivities=names)
    for name in names:
        value, own = value_of(model, name), state.sensitivity(name)
        near = [ancf.equilibrium(varied(model, name, value + d), of=of) for d in (h, -h)]
        for point in points:
            wanted = (near[0].position(point) - near[1].position(point)) / (2 * h)
            assert own.position(point) == pytest.approx(wanted, abs=1e-4 * np.max(np.abs(wanted)))
            assert np.max(np.abs(wanted)) > 1e-3
        wanted = (near[0].momentum - near[1].momentum) / (2 * h)
        assert own.momentum == pytest.approx(wanted, abs=1e-9)
        if build != "cable":
            moved = [float(name.endswith(f"[{k}]")) for k in range(3)]
            assert own.position("other") == pytest.approx(moved, abs=1e-9)


@pytest.mark.parametrize("build", ["mass", "body"])
def test_of_runs_from_there(build):
    (make, names), h = MODELS[build], 1e-5
    model, of, _ = make()
    given = {"t_end": 0.1, "step": 5e-3}
    state = ancf.equilibrium(model, of=of, sensitivities=names)
    run = ancf.simulate(model, start=state, sensitivities=names, **given)
    for name in names:
        value = value_of(model, name)
        one, two = (varied(model, name, value + d) for d in (h, -h))
        near = [ancf.simulate(m, start=ancf.equilibrium(m, of=of), **given) for m in (one, two)]
        for point in ("mass", "other"):
            wanted = (near[0].position(point) - near[1].position(point)) / (2 * h)
            assert run.sensitivity(name).position(point) == pytest.approx(wanted, abs=1e-5)
