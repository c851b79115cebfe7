"""Heads that only their contact with a wire holds: equilibria beside two catenaries that meet on the head."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import root

import ancf
from helpers import later

SPAN, PLACE, EA, WEIGHT, MASS, STIFFNESS = 60.0, 20.0, 15e6, 1.35 * 9.81, 7.2, 50e3


def _catenary(length, dx, dz):
    """Horizontal force and upward force at the first end of an elastic catenary."""

    def misses(p):
        H, V = p
        high, low = WEIGHT * length - V, -V
        x = H * length / EA + H / WEIGHT * (np.arcsinh(high / H) - np.arcsinh(low / H))
        z = (high**2 - low**2) / (2 * WEIGHT * EA) + (np.hypot(H, high) - np.hypot(H, low)) / WEIGHT
        return x - dx, z - dz

    way = np.hypot(dx, dz)
    pull = WEIGHT * way**2 / 8 / np.sqrt(3 * max(length - way, 1e-4) * way / 8 + 1e-3)
    return root(misses, (pull, WEIGHT * length / 2 - pull * dz / dx), tol=1e-13).x


def _string(length, force):
    """Height of a head without friction below a string, and the length of string beside it."""

    def misses(p):
        z, s = p
        (H, V), (Hr, Vr) = _catenary(s, PLACE, z), _catenary(length - s, SPAN - PLACE, -z)
        rises = WEIGHT * s - V
        return np.hypot(H, rises) - np.hypot(Hr, Vr), rises + Vr - force

    sag = 0.85 * np.sqrt(3 / 8 * SPAN * (length - SPAN))
    z, s = root(misses, (-sag, PLACE * length / SPAN), tol=1e-12).x
    assert np.abs(misses((z, s))).max() < 1e-6
    return z + force / STIFFNESS, s


def _line(length, elements=60, EI=195.0):
    model = ancf.Model(gravity=(0, 0, -9.81))
    copper = ancf.Section(EA=EA, EI=EI, rhoA=1.35)
    wire = model.add_beam(
        "wire", start=(0, 0, 0), end=(SPAN, 0, 0), elements=elements, length=length, section=copper
    )
    model.pin(wire.start)
    model.pin(wire.end)
    return model, wire


def _head(length, force, z=-5.0, hold="xy", **options):
    """A point mass with an upward force beyond its weight."""
    model, wire = _line(length, **options)
    head = model.add_point_mass("head", at=(PLACE, 0, z), mass=MASS)
    model.hold(head, position=hold)
    model.add_force(head, (0, 0, MASS * 9.81 + force))
    return model, head, model.add_contact(head, along=wire, stiffness=STIFFNESS)


@pytest.mark.parametrize("length", [60.05, 60.3])
@pytest.mark.parametrize("force", [20.0, 200.0])
def test_head_rests_below_a_sagging_string(length, force):
    """Height and place along the wire, to the limit of elements of first order at the kink."""
    z, s = _string(length, force)
    found = []
    for elements in (120, 240):
        model, head, contact = _head(length, force, elements=elements, EI=1e-2)
        state = ancf.equilibrium(model)
        assert abs(state.contact_force(contact) - force) < 1e-8 * force
        found.append((state.position(head)[2], float(state.arc_length(contact))))
    (z1, s1), (z2, s2) = found
    assert abs(2 * z2 - z1 - z) < 5e-4 * abs(z)
    assert abs(2 * s2 - s1 - s) < 1e-4


@pytest.mark.parametrize("length", [59.92, 60.0, 60.3, 60.6])
@pytest.mark.parametrize("force", [20.0, 300.0])
def test_head_is_found_from_anywhere_below(length, force):
    """Wherever the head starts, before it touches or deep in the wire: one equilibrium."""
    heights = []
    for z in (-10.0, -0.2, 0.05):
        model, head, contact = _head(length, force, z)
        state = ancf.equilibrium(model)
        assert abs(state.contact_force(contact) - force) < 1e-8 * force
        heights.append(state.position(head)[2])
    assert np.ptp(heights) < 1e-8


@pytest.mark.parametrize("length", [59.92, 60.3])
def test_chains_and_bodies_are_found_as_point_masses(length):
    """The height is that of a point mass with the same force."""
    model, head, _ = _head(length, 120.0)
    expected = ancf.equilibrium(model).position(head)[2]

    model, wire = _line(length)
    head, frame = (model.add_point_mass(n, at=(PLACE, 0, z), mass=5.0) for n, z in (("a", -1), ("b", -1.5)))
    for mass in (head, frame):
        model.hold(mass, position="xy")
    model.add_spring(head, frame, stiffness=4200.0, length=0.5)
    model.add_force(frame, (0, 0, 10.0 * 9.81 + 120.0))
    model.add_contact(head, along=wire, stiffness=STIFFNESS)
    assert abs(ancf.equilibrium(model).position(head)[2] - expected) < 1e-8

    model, wire = _line(length)
    body = model.add_rigid_body("head", at=(PLACE, 0, -1), mass=MASS, inertia=(0.1, 0.1, 0.1))
    model.prismatic(body, (PLACE, 0, -1), axis=(0, 0, 1))
    model.add_force(body.centre, (0, 0, MASS * 9.81 + 120.0))
    model.add_contact(body.centre, along=wire, stiffness=STIFFNESS)
    assert abs(ancf.equilibrium(model).position(body.centre)[2] - expected) < 1e-6


@pytest.mark.parametrize("length", [pytest.param(59.92, marks=pytest.mark.slow), 60.3])
@pytest.mark.parametrize(
    ("force", "hold", "said"),
    [
        (-5.0, "xy", 'nothing holds "head" in z, and its loads take it away'),
        (0.0, "xy", 'nothing holds "head" in z, and no load moves it there'),
        later((20.0, "x", 'nothing holds "head" in y, and no load moves it there')),
    ],
)
def test_what_nothing_holds_is_named(length, force, hold, said):
    """A head that goes away, and those whose place is open."""
    with pytest.raises(ancf.SolveError, match=said):
        ancf.equilibrium(_head(length, force, z=-0.5, hold=hold)[0])
