"""Frequency responses of linearised models beside closed forms."""

import numpy as np
import pytest

import ancf

HZ = np.array([0.0, 0.13, 0.7, 2.1, 6.3])
S = 2j * np.pi * HZ


@pytest.mark.parametrize(
    ("mass", "stiffness", "damping"), [(2.0, 50.0, 3.0), (0.1, 7.0, 0.02), (1.0, 4.0, 10.0)]
)
def test_oscillator(mass, stiffness, damping):
    """m x'' + d x' + k x = F: place, velocity, acceleration, force of the spring, reaction of the guide."""
    model = ancf.Model()
    body = model.add_point_mass("p", at=(1, 0, 0), mass=mass)
    model.hold(body, position="yz", name="guide")
    model.add_spring(body, (0, 0, 0), stiffness=stiffness, damping=damping, name="spring")
    push = model.add_input("push", 0.0, unit="N")
    model.add_force(body, (2.0 * push, -0.5 * push, 0.0))
    outputs = [
        "position(p)[0]",
        "velocity(p)[0]",
        "acceleration(p)[0]",
        "spring_force(spring)",
        "reaction(guide)[1]",
    ]
    linear = ancf.linearise(model, outputs=outputs)
    place = 2.0 / (mass * S**2 + damping * S + stiffness)
    wanted = np.array([place, S * place, S**2 * place, (stiffness + damping * S) * place, 0.5 + 0.0 * S]).T
    np.testing.assert_allclose(linear.frequency_response(HZ)[:, :, 0], wanted, rtol=1e-11, atol=1e-12)
    assert linear.eigenvalues == pytest.approx(
        sorted(np.roots([mass, damping, stiffness]), key=lambda x: (abs(x), x.imag))
    )
    assert linear.output_units == ("m", "m/s", "m/s^2", "N", "N")
    assert linear.input_units == ("N",)


@pytest.mark.parametrize(("mass", "stiffness", "damping"), [(2.0, 50.0, 3.0), (0.1, 7.0, 0.02)])
def test_oscillator_on_a_base_that_moves(mass, stiffness, damping):
    """m x'' + d (x' - s') + k (x - s) = 0 with s'' or s' given."""
    model = ancf.Model()
    base = model.add_point_mass("base", at=(0, 0, 0), mass=3.0)
    model.pin(base, name="base support")
    body = model.add_point_mass("p", at=(1, 0, 0), mass=mass)
    model.hold(body, position="yz")
    model.add_spring(body, base, stiffness=stiffness, damping=damping, name="spring")
    passed = (damping * S[1:] + stiffness) / (mass * S[1:] ** 2 + damping * S[1:] + stiffness)
    for word, powers in (("acceleration", 2), ("velocity", 1)):
        name = f'{word}("base support")[0]'
        outputs = ["position(p)[0]", "position(base)[0]", "spring_force(spring)"]
        linear = ancf.linearise(model, inputs=[name], outputs=outputs)
        s = 1.0 / S[1:] ** powers
        wanted = np.array([passed * s, s, (stiffness + damping * S[1:]) * (passed - 1.0) * s]).T
        np.testing.assert_allclose(linear.frequency_response(HZ[1:])[:, :, 0], wanted, rtol=1e-10, atol=1e-12)
    held = ancf.linearise(
        model,
        inputs=["acceleration(base support)[0]"],
        outputs=['reaction("base support")[0]', "acceleration(base)[0]"],
    )
    a = np.ones_like(s)
    wanted = np.array([3.0 * a + mass * passed, a]).T
    np.testing.assert_allclose(held.frequency_response(HZ[1:])[:, :, 0], wanted, rtol=1e-10)


@pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
@pytest.mark.parametrize("damping", [0.0, 40.0])
def test_rod_pulled_at_its_end(element, damping):
    """u = F tan(k L)/(E k), with E = EA + i w c and k^2 = rhoA w^2/E; the tension at a point is E u'."""
    EA, rhoA, L = 4e3, 0.5, 2.0
    model = ancf.Model()
    if element == "cable":
        section = ancf.Section(EA=EA, EI=0.5, rhoA=rhoA, axial_damping=damping)
    else:
        side = 0.05
        section = ancf.Section.rectangle(
            side, side, E=EA / side**2, rho=rhoA / side**2, nu=0.0, axial_damping=damping
        )
    rod = model.add_beam("rod", start=(0, 0, 0), end=(L, 0, 0), elements=24, section=section, element=element)
    model.clamp(rod.start, name="wall")
    model.hold(rod.end, position="yz")
    pull = model.add_input("pull", 0.0)
    model.add_force(rod.end, (pull, 0.0, 0.0))
    linear = ancf.linearise(
        model, outputs=["position(rod.end)[0]", "position(rod.at(0.5))[0]", "reaction(wall)[0]"]
    )
    hz = np.array([0.5, 5.0, 15.0, 40.0])
    w = 2 * np.pi * hz
    E = EA + 1j * w * damping
    k = np.sqrt(rhoA * w**2 / E)
    wanted = np.array([np.sin(k * L), np.sin(0.5 * k), -E * k]) / (E * k * np.cos(k * L))
    found = linear.frequency_response(hz)[:, :, 0]
    np.testing.assert_allclose(
        found / np.abs(wanted).max(axis=1), wanted.T / np.abs(wanted).max(axis=1), rtol=0, atol=5e-6
    )


@pytest.mark.parametrize("damping", [0.0, 0.05])
@pytest.mark.parametrize("elements", [16, 24])
def test_taut_string(elements, damping):
    """T w'' = rhoA w_tt + c w_t - F at a: w = F sin(k a) sin(k (L - x))/(T k sin(k L)) beyond a."""
    EA, rhoA, L, stretched = 1e5, 0.02, 1.5, 1.49
    model = ancf.Model()
    section = ancf.Section(EA=EA, EI=1e-6, rhoA=rhoA, damping=damping)
    string = model.add_beam(
        "s", start=(0, 0, 0), end=(L, 0, 0), elements=elements, length=stretched, section=section
    )
    model.pin(string.start)
    model.pin(string.end)
    x = stretched / 4
    pluck = model.add_input("pluck", 0.0)
    model.add_force(string.at(x), (0.0, pluck, 0.0))
    state = ancf.equilibrium(model)
    points = (0.5, 0.625)
    linear = ancf.linearise(
        model, about=state, outputs=[f"position(s.at({stretched * p}))[1]" for p in points]
    )
    T, stretch = state.tension(string.at(0.5)), L / stretched
    hz = np.array([0.0, 3.0, 21.0, 50.0, 95.0])
    w = 2 * np.pi * hz + 1e-3
    k = np.sqrt((rhoA / stretch * w**2 - 1j * w * damping / stretch) / T)  # both per reference length
    wanted = np.array(
        [np.sin(k * L / 4) * np.sin(k * L * (1 - p)) / (T * k * np.sin(k * L)) for p in points]
    ).T
    np.testing.assert_allclose(linear.frequency_response(hz + 1e-3 / 2 / np.pi)[:, :, 0], wanted, rtol=3e-4)


@pytest.mark.parametrize(("mass", "arm"), [(2.0, 0.7), (0.3, 2.0)])
def test_compound_pendulum(mass, arm):
    """(I + m l^2) phi'' + m g l phi = F l: the force at the hinge has the inertia of the centre."""
    g, inertia = 9.81, 0.05
    model = ancf.Model(gravity=(0, 0, -g))
    bob = model.add_rigid_body("bob", at=(0, 0, -arm), mass=mass, inertia=(0.02, inertia, 0.03))
    model.hinge(bob.at(0, 0, arm), (0, 0, 0), axis=(0, 1, 0), name="pivot")
    push = model.add_input("push", 0.0)
    model.add_force(bob, (push, 0.0, 0.0))
    state = ancf.equilibrium(model)
    linear = ancf.linearise(
        model, about=state, outputs=["position(bob)[0]", "acceleration(bob)[0]", "multiplier(pivot)[0]"]
    )
    turn = arm / ((inertia + mass * arm**2) * S**2 + mass * g * arm)
    found = linear.frequency_response(HZ)[:, :, 0]
    np.testing.assert_allclose(found[:, 0], arm * turn, rtol=1e-9)
    np.testing.assert_allclose(found[:, 1], arm * S**2 * turn, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(np.abs(found[:, 2]), np.abs(mass * arm * S**2 * turn - 1.0), rtol=1e-9)
    assert len(linear.A) == 2


@pytest.mark.parametrize("word", ["acceleration", "velocity"])
@pytest.mark.parametrize("across", [0.0, 3.0, -8.0])
def test_a_force_across_on_a_base_that_moves(across, word):
    """m x'' + d (x' - s') + k (x - s) = -a y and m y'' + d y' + k y = a x: the stiffness is not symmetric."""
    m, k, d = 0.7, 20.0, 0.9
    model = ancf.Model()
    base = model.add_point_mass("base", at=(0, 0, 0), mass=1.0)
    model.pin(base, name="hook")
    body = model.add_point_mass("p", at=(1, 0, 0), mass=m)
    model.hold(body, position="z")
    model.add_spring(base, body, stiffness=k, damping=d)
    model.add_force(body, [f"{-across}*y", f"{across}*(x - 1) - {k}*y - {d}*vy", "0"])
    linear = ancf.linearise(model, inputs=[f"{word}(hook)[0]"], outputs=["position(p)[0]", "position(p)[1]"])
    hz = np.array([0.05, 0.4, 1.1])
    s = 2j * np.pi * hz
    A, pulled = m * s**2 + d * s + k, (k + d * s) / s ** (2 if word == "acceleration" else 1)
    wanted = np.array([A, across + 0.0 * s]).T * (pulled / (A**2 + across**2))[:, None]
    np.testing.assert_allclose(linear.frequency_response(hz)[:, :, 0], wanted, rtol=1e-7, atol=1e-12)


@pytest.mark.parametrize(("mass", "arm", "below"), [(2.0, 1.0, 0.4), (0.5, 0.3, 0.0), (7.0, 4.0, 1.5)])
def test_pendulum_below_a_vessel_that_surges(mass, arm, below):
    """(I + m l^2) phi'' + m g l phi = -m l s'': what the vessel, held altogether, takes to be moved."""
    g, inertia, own = 9.81, 0.2, 5.0
    model = ancf.Model(gravity=(0, 0, -g))
    vessel = model.add_rigid_body("vessel", at=(0, 0, 0), mass=own, inertia=(0.1, 0.1, 0.1))
    model.clamp(vessel, name="sea")
    bob = model.add_rigid_body("bob", at=(0, 0, -below - arm), mass=mass, inertia=(0.1, inertia, 0.1))
    model.hinge(vessel.at(0, 0, -below), bob.at(0, 0, arm), axis=(0, 1, 0), name="pivot")
    outputs = ["position(bob)[0]", "acceleration(bob)[0]", "reaction(sea)[0]", "reaction_moment(sea)[1]"]
    state = ancf.equilibrium(model)
    linear = ancf.linearise(model, about=state, inputs=["acceleration(sea)[0]"], outputs=outputs)
    s2 = S[1:] ** 2
    swing = -mass * arm**2 / ((inertia + mass * arm**2) * s2 + mass * g * arm)  # l phi
    along = 1.0 + s2 * swing
    wanted = np.array([along / s2, along, own + mass * along, -below * mass * along]).T
    np.testing.assert_allclose(linear.frequency_response(HZ[1:])[:, :, 0], wanted, rtol=1e-8, atol=1e-9)
