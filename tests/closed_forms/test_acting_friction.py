"""Friction as it acts: sensors, runs between two steps, states tell one number, which moves bodies."""

import itertools

import numpy as np
import pytest

import ancf


def sliding(stiffness, friction):
    """A ball that is thrown along a floor."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    ball = model.add_rigid_body("ball", at=(0, 0, 0.1), mass=1.3, inertia=(0.004, 0.004, 0.004))
    ball.set_motion(velocity=(1.0, 0, 0))
    skin = model.add_surface("skin", ancf.Sphere(radius=0.1), on=ball)
    floor = model.add_surface("floor", ancf.Plane())
    return model, model.add_contact(skin, floor, stiffness=stiffness, damping=300.0, friction=friction)


def laid(stiffness, friction):
    """A rope that is pulled over a floor by its end."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.05, rhoA=0.5, diameter=0.02)
    rope = model.add_beam("rope", start=(0, 0, 0.01), end=(1, 0, 0.01), elements=5, section=section)
    floor = model.add_surface("floor", ancf.Plane())
    contact = model.add_contact(rope, floor, stiffness=0.1 * stiffness, damping=100.0, friction=friction)
    model.add_force(rope.end, ("20*t", 0, 0))
    return model, contact


def crossed(stiffness, friction):
    """A cable that falls on another one and is drawn along it."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.05, rhoA=0.3, diameter=0.02)
    low = model.add_beam("low", start=(0, -0.5, 0), end=(0, 0.5, 0), elements=4, section=section)
    top = model.add_beam("top", start=(-0.5, 0, 0.02), end=(0.5, 0, 0.02), elements=4, section=section)
    for point in (low.start, low.end, top.start, top.end):
        model.pin(point)
    model.add_force(top.at(0.5), (0, "2000*t", -100))
    contact = model.add_contact(top, low, stiffness=10.0 * stiffness, damping=300.0, friction=friction)
    return model, contact


@pytest.mark.parametrize("friction", [0.1, 0.3])
@pytest.mark.parametrize("method", [None, ancf.GeneralizedAlpha(0.8)])
def test_friction_of_sensors_is_what_slows_a_ball(friction, method):
    """m a = -T in each step: limits that are renewed for the next one have not acted yet."""
    model, contact = sliding(1e5, friction)
    run = ancf.simulate(model, t_end=0.04, step=5e-4, integrator=method, sensors=[contact, "ball.centre"])
    felt, told = run.sensors.acceleration("ball.centre")[2:, 0], run.sensors.friction_force(contact)[2:]
    assert told.max() > 0.3 * friction * 1.3 * 9.81
    if method is None:
        assert np.allclose(-1.3 * felt, told, rtol=0, atol=1e-7 * told.max())
    moving = told > 1e-3 * told.max()
    assert np.all(run.sensors.slipping(contact)[2:][moving] == 1.0)  # it slides all the way
    assert run.state().friction_force(contact) == told[-1]
    assert run.state().slipping(contact) == run.sensors.slipping(contact)[-1]


@pytest.mark.parametrize(
    ("build", "method"),
    [
        *itertools.product((sliding, laid, crossed), (None, ancf.Radau(adaptive=False))),
        (laid, ancf.Explicit()),
    ],
)
def test_a_run_that_is_asked_between_steps_tells_what_sensors_do(build, method):
    """With sensors of its own and without, from the first state on."""
    model, contact = build(1e5, 0.25)
    step = 2e-5 if isinstance(method, ancf.Explicit) else 5e-4
    names = ("contact_force", "contact_gap", "friction_force", "slipping")

    def told(of):
        return [getattr(of, name)(contact) for name in names]

    run = ancf.simulate(model, t_end=40 * step, step=step, integrator=method, sensors=[contact])
    wanted = np.transpose(told(run.sensors))
    for sensors in (None, [contact]):
        live = ancf.stepper(model, step=step, integrator=method, sensors=sensors)
        found = [told(live)]
        for _ in range(40):
            live.advance()
            found.append(told(live))
        assert np.allclose(found, wanted, rtol=1e-12, atol=1e-14)
    assert np.allclose(told(run.state()), wanted[-1], rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("steps", [7, 40])
@pytest.mark.parametrize("build", [sliding, crossed])
def test_a_run_that_goes_on_begins_with_the_friction_that_acted(build, steps):
    """Not with that of the limits that are renewed for its first step."""
    model, contact = build(1e5, 0.25)
    given = {"step": 5e-4, "sensors": [contact]}
    start = ancf.simulate(model, t_end=steps * 5e-4, **given).state()
    sensors = ancf.simulate(model, t_end=(steps + 1) * 5e-4, start=start, **given).sensors
    friction = sensors.friction_force(contact)
    assert friction[0] == start.friction_force(contact)
    assert sensors.slipping(contact)[0] == start.slipping(contact)
    assert abs(friction[1] - friction[0]) > 1e-3 * friction[0]


def test_friction_along_a_rope_adds_up_to_that_of_the_contact():
    model, contact = laid(1e5, 0.25)
    run = ancf.simulate(model, t_end=0.08, step=5e-4, sensors=[contact])
    state = run.state()
    line, force = state.contact_line(contact), float(state.friction_force(contact))
    points = len(line.x) // 5
    weight = np.tile(np.polynomial.legendre.leggauss(points)[1], 5) * 0.1
    size = np.linalg.norm(line.friction, axis=1)
    assert force > 0.1
    assert weight @ size == pytest.approx(force, rel=1e-9)
    assert weight @ line.friction[:, 0] == pytest.approx(-force, rel=1e-3)  # against the pull along x
    assert weight @ (size * line.slips) / force == pytest.approx(float(state.slipping(contact)), abs=1e-9)


def reactions_on_a_drum(friction, damping, most):
    """Of a rope over a drum that a pin holds where it lies, at each step; and the run."""
    radius, a = 0.21, np.linspace(0.0, np.pi, 40)
    arc = np.stack([radius * np.cos(a), 0.0 * a, radius * np.sin(a)], axis=1)
    path = np.concatenate([[[radius, 0, -0.3]], arc, [[-radius, 0, -0.3]]])
    model = ancf.Model()
    section = ancf.Section(EA=1e5, EI=1e-3, rhoA=0.3, diameter=0.02, axial_damping=damping)
    rope = model.add_beam("rope", path=path, elements=24, section=section)
    drum = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0, 1, 0)))
    model.add_contact(rope, drum, stiffness=1e7, damping=500.0, friction=friction)
    model.pin(rope.start)
    held = model.pin(rope.at(rope.node_x[10]))
    model.add_force(rope.end, (0, 0, -50.0))
    method = ancf.Trapezoidal(newton=ancf.Newton(max_iterations=most))
    run = ancf.simulate(model, t_end=0.01, step=2e-4, sensors=[held], integrator=method)
    return run.sensors.reaction(held), run


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_reactions_of_steps_that_were_taken_again(friction):
    """They are those of the friction that acted, however many attempts it took; the first of a damped one."""
    wanted, first = reactions_on_a_drum(friction, 0.0, 60)
    for damping, most in ((0.0, 12), (0.0, 8), (1e-7, 60)):
        found, run = reactions_on_a_drum(friction, damping, most)
        assert run.stats.retries == first.stats.retries == 0  # no step was halved
        assert run.stats.jacobians > (1.5 if most < 10 else 0.9) * first.stats.jacobians
        small = 1e-5 if damping else 1e-7  # damping moves something as well
        assert np.allclose(found, wanted, rtol=0, atol=small * np.abs(wanted).max())
