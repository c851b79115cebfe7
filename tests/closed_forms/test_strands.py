"""Wires in helices: strands around a stiff core beside Costello's force, coils beside Love's closed forms."""

from __future__ import annotations

import numpy as np
import pytest

import ancf

E, NU = 2e11, 0.3


def _helix(radius, angle, turns, first=0.0):
    """Points of a helix that rises by ``angle`` above the plane across its axis."""
    phi = np.linspace(0, 2 * np.pi * turns, int(60 * turns) + 1)
    height = radius * phi * np.tan(angle)
    return np.stack([radius * np.cos(phi + first), radius * np.sin(phi + first), height], axis=1)


def _pulled(angle, strain, elements, wires=6, turns=2):
    """Axial force and torque of a strand whose ends do not turn."""
    radius, diameter, stiffness = 2.2e-3, 2e-3, 1e11
    section = ancf.Section.circle(diameter=diameter, E=E, rho=7850.0, nu=NU)
    model = ancf.Model()
    core = model.add_surface("core", ancf.Cylinder(radius=radius - diameter / 2, axis=(0, 0, 1)))
    paths = [_helix(radius, angle, turns, 2 * np.pi * k / wires) for k in range(wires)]
    height = paths[0][-1, 2]
    top = model.add_rigid_body("top", at=(0, 0, height), mass=1.0, inertia=(1e-3, 1e-3, 1e-3))
    for k, path in enumerate(paths):
        wire = model.add_beam(
            f"wire {k}", path=path, elements=elements * turns, section=section, element="nonlocking"
        )
        model.add_contact(wire, core, stiffness=stiffness, radius=diameter / 2)
        model.clamp(wire.start)
        model.clamp(wire.end, to=top)
    held = model.clamp(top, displacement=(0, 0, strain * height))
    state = ancf.equilibrium(model)
    EA, sin, cos = section.EA, np.sin(angle), np.cos(angle)
    pull = EA * strain * sin**2 / (1 + EA * cos**4 / (radius**2 * stiffness))
    expected = wires * pull * np.array([sin, cos * radius])
    return np.array([state.reaction(held)[2], state.reaction_moment(held)[2]]), expected


@pytest.mark.parametrize("degrees", [70.0, 75.0, 80.0])
def test_strand_around_a_core(degrees):
    """Each wire carries what its stretch asks for; what its bending adds to the torque is left out."""
    both = [_pulled(np.radians(degrees), strain, 24) for strain in (1e-4, 2e-4)]
    found, expected = (both[1][k] - both[0][k] for k in range(2))
    assert abs(found[0] / expected[0] - 1) < 1e-3
    assert abs(found[1] / expected[1] - 1) < 1e-2


@pytest.mark.parametrize("degrees", [15.0, 30.0, 60.0])
@pytest.mark.parametrize(("force", "moment"), [(0.01, 0.0), (0.0, 0.001)])
def test_coil_spring_turns_as_it_is_pulled(degrees, force, moment):
    """Rise and turn of an open coil by a force and by a torque along its axis, with 24 turns."""
    radius, diameter, angle, turns = 0.05, 0.002, np.radians(degrees), 24
    section = ancf.Section.circle(diameter=diameter, E=E, rho=7850.0, nu=NU)
    path = _helix(radius, angle, turns)
    model = ancf.Model()
    wire = model.add_beam("wire", path=path, elements=32 * turns, section=section, element="nonlocking")
    top = model.add_rigid_body("top", at=(0, 0, path[-1, 2]), mass=1.0, inertia=(1e-3, 1e-3, 1e-3))
    model.clamp(wire.start)
    model.clamp(wire.end, to=top)
    model.cylindrical(top, (0, 0, path[-1, 2]), axis=(0, 0, 1))
    model.add_force(top.centre, (0, 0, force))
    model.add_moment(top, (0, 0, moment))
    state = ancf.equilibrium(model)
    at = state.position(wire.end)
    found = state.position(top.centre)[2] - path[-1, 2], np.arctan2(at[1], at[0])
    EI, GJ = section.EI_y, section.G * section.J
    sin, cos, length = np.sin(angle), np.cos(angle), 2 * np.pi * radius * turns / np.cos(angle)
    coupling = radius * sin * cos * (1 / GJ - 1 / EI)
    rise = force * radius**2 * (cos**2 / GJ + sin**2 / EI) + moment * coupling
    turn = force * coupling + moment * (sin**2 / GJ + cos**2 / EI)
    assert found == pytest.approx((rise * length, turn * length), rel=3e-3)
