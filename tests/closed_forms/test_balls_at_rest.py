"""Balls and cables at rest on what they touch: equilibria and small vibrations in closed form."""

import numpy as np
import pytest

import ancf

G = 9.81


def ball(radius, mass, floor, friction=0.0, stiffness=1e6, at=(0.0, 0.0), height=None):
    """A homogeneous ball on a surface."""
    model = ancf.Model(gravity=(0, 0, -G))
    inertia = 0.4 * mass * radius**2
    place = (*at, radius if height is None else height)
    body = model.add_rigid_body("ball", at=place, mass=mass, inertia=3 * (inertia,))
    skin = model.add_surface("skin", ancf.Sphere(radius), on=body)
    law = {"stiffness": stiffness, "friction": friction, "stick": stiffness}
    model.add_contact(skin, model.add_surface("floor", floor), **law, name="touch")
    return model, body


@pytest.mark.parametrize(("radius", "bowl"), [(0.02, 0.2), (0.05, 0.3), (0.1, 0.5)])
@pytest.mark.parametrize(("friction", "share"), [(0.0, 1.0), (5.0, 5.0 / 7.0)])
def test_in_a_ring(radius, bowl, friction, share):
    """On the way round at the bottom of a ring: omega^2 = g/(R - r), and 5/7 of it where it rolls.

    Across it would roll off the tube: there it is held.
    """
    model, body = ball(radius, 0.7, ancf.Torus(bowl + 1.0, 1.0, (0, 0, bowl), (0, 1, 0)), friction)
    model.hold(body, position="y")
    for axis in np.eye(3) if friction == 0.0 else []:  # it slides without turning
        model.add_torsion_spring(body, tuple(body.position), axis=axis, stiffness=0.1)
    state = ancf.equilibrium(model)
    wanted = np.sqrt(share * G / (bowl - radius))
    plain = ancf.modes(model, about=state, count=5).frequencies
    damped = np.abs(ancf.damped_modes(model, about=state, count=5).eigenvalues.imag)
    for found in (plain, damped):
        assert np.min(np.abs(found / wanted - 1.0)) < 2e-4, (found, wanted)


@pytest.mark.parametrize("slope", [0.0, 0.05, 0.2])
@pytest.mark.parametrize("stiffness", [2e4, 1e5])
def test_on_a_slope(slope, stiffness):
    """Held by a spring along the slope, and by soft ones: force and depth, and it does not tip over."""
    normal = np.array([-slope, 0.0, 1.0]) / np.hypot(slope, 1.0)
    radius, mass = 0.1, 2.0
    start = radius * normal
    floor = ancf.Plane((0, 0, 0), tuple(normal))
    model, body = ball(radius, mass, floor, 0.0, stiffness, at=start[:2], height=start[2])
    along = np.array([1.0, 0.0, slope]) / np.hypot(slope, 1.0)
    model.add_spring(body, tuple(start + along), stiffness=1e3, name="rope")
    model.add_spring(body, tuple(start + np.eye(3)[1]), stiffness=10.0)
    for arm in 0.05 * np.eye(3):
        for axis in np.eye(3):
            place = start + arm
            model.add_spring(body.at(*arm), tuple(place + axis), stiffness=1e-3, length=1.0)
    state = ancf.equilibrium(model)
    weight = mass * G / np.hypot(slope, 1.0)
    assert state.contact_force("touch") == pytest.approx(weight, rel=2e-3)
    assert state.contact_gap("touch") == pytest.approx(-weight / stiffness, rel=2e-3)
    assert state.spring_force("rope") == pytest.approx(slope * weight, abs=1e-3 * weight)


@pytest.mark.parametrize("element", ["cable", "nonlocking"])
@pytest.mark.parametrize("stick", [50.0, 2e3])
@pytest.mark.parametrize("kind", ["plane", "ground"])
def test_what_sticks_moves_on_its_springs(element, stick, kind):
    """A beam that lies on a plane as a whole: omega^2 = k_t/rhoA along and across it."""
    model = ancf.Model(gravity=(0, 0, -G))
    d, rhoA = 0.02, 0.6
    if element == "cable":
        section = ancf.Section(EA=1e5, EI=50.0, rhoA=rhoA, diameter=d)
    else:
        section = ancf.Section.circle(d, E=1e9, rho=4 * rhoA / (np.pi * d * d), nu=0.3)
    beam = model.add_beam(
        "beam", start=(0, 0, d / 2), end=(1, 0, d / 2), elements=3, section=section, element=element
    )
    if kind == "plane":
        law = {"stiffness": 1e4, "friction": 0.5, "stick": stick}
        model.add_contact(beam, model.add_surface("floor", ancf.Plane((0, 0, 0), (0, 0, 1))), **law)
    else:  # per length and diameter
        model.add_ground("floor", height=0.0, stiffness=1e4 / d, friction=0.5, stick=stick / d)
    start = ancf.simulate(model, t_end=20.0, step=0.02, integrator=ancf.GeneralizedAlpha(rho_inf=0.0))
    about = start.state(-1)
    wanted = np.sqrt(stick / rhoA)
    found = np.abs(ancf.damped_modes(model, about=about, count=4).eigenvalues.imag)
    assert np.sum(np.abs(found / wanted - 1.0) < 1e-3) >= 2, (found, wanted)
    plain = ancf.modes(model, about=about, count=4).frequencies
    assert np.sum(np.abs(plain / wanted - 1.0) < 1e-3) >= 2, (plain, wanted)


@pytest.mark.parametrize("kind", ["plane", "ground"])
@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_what_has_slipped_sticks_when_it_vibrates(friction, kind):
    """A spring draws a cable along until friction holds it: it has slipped, and vibrates on its springs."""
    model = ancf.Model(gravity=(0, 0, -G))
    d, rhoA, stick, k = 0.02, 0.6, 400.0, 150.0
    section = ancf.Section(EA=1e5, EI=50.0, rhoA=rhoA, diameter=d)
    cable = model.add_beam("cable", start=(0, 0, d / 2), end=(1, 0, d / 2), elements=3, section=section)
    if kind == "plane":
        law = {"stiffness": 1e4, "friction": friction, "stick": stick}
        model.add_contact(cable, model.add_surface("floor", ancf.Plane((0, 0, 0), (0, 0, 1))), **law)
    else:
        model.add_ground("floor", height=0.0, stiffness=1e4 / d, friction=friction, stick=stick / d)
    model.add_spring(cable.end, (2.0, 0, d / 2), stiffness=k, length=0.9, name="rope")
    for x in (0.0, 1.0):
        model.hold(cable.at(x), position="y")
    state = ancf.equilibrium(model)
    assert state.spring_force("rope") == pytest.approx(friction * rhoA * G, rel=5e-3)
    wanted = np.sqrt((stick + k) / rhoA)
    found = np.abs(ancf.damped_modes(model, about=state, count=3).eigenvalues.imag)
    assert np.min(np.abs(found / wanted - 1.0)) < 2e-3, (found, wanted)
    plain = ancf.modes(model, about=state, count=3).frequencies
    assert np.min(np.abs(plain / wanted - 1.0)) < 2e-3, (plain, wanted)
