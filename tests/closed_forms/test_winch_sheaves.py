"""Ropes that a winch hauls in or pays out over sheaves, beside closed forms."""

import numpy as np
import pytest

import ancf

R, D = 0.2, 0.02
RC = R + 0.5 * D
HELD = ancf.GeneralizedAlpha(0.5)


def hoist(
    change,
    turn=0.5 * np.pi,
    load=300.0,
    mu=0.3,
    rhoA=0.3,
    at_start=False,
    inertia=None,
    elements=40,
    free=1.5,
):
    """A rope from a force at its free end over a sheave to a winch; its model, winch, free end and contact.

    The speed of the winch grows to ``change`` within 0.2 s.
    """
    tail = 0.4

    def point(a):
        return np.stack([RC * np.cos(a), 0.0 * a, RC * np.sin(a)], axis=-1)

    def tangent(a):
        return np.array([-np.sin(a), 0.0, np.cos(a)])

    before = point(np.zeros(1)) - np.linspace(free, 0.0, 100)[:-1, None] * tangent(0.0)
    after = point(np.full(1, turn)) + np.linspace(0.0, tail, 50)[1:, None] * tangent(turn)
    path = np.concatenate([before, point(np.linspace(0.0, turn, 200)), after])
    length = free + turn * RC + tail
    model = ancf.Model()
    section = ancf.Section(EA=1e6, EI=1e-3, rhoA=rhoA, diameter=D, axial_damping=200.0)
    rope = model.add_beam(
        "rope",
        path=path[::-1] if at_start else path,
        elements=elements,
        length=length,
        section=section,
        natural_shape="straight",
    )
    top, end = (rope.start, rope.end) if at_start else (rope.end, rope.start)
    hub = None
    if inertia is not None:
        ends = 0.6 * inertia
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=2.0, inertia=(ends, inertia, ends))
        model.hinge(hub, (0, 0, 0), axis=(0, 1, 0))
    sheave = model.add_surface("sheave", ancf.Cylinder(radius=R, axis=(0, 1, 0)), on=hub)
    contact = model.add_contact(rope, sheave, stiffness=1e7, damping=2e3, friction=mu)
    model.pin(top)
    model.add_force(end, -load * tangent(0.0))
    # its rate is change*ramp(t, 0, 0.2): the ramp is a polynomial whose integral is 0.1 s at its end
    model.winch(top, length=lambda t: length + change * travelled(t))
    return model, top, end, contact


def travelled(t):
    """Integral of a smooth rise from 0 to 1 within 0.2 s."""
    s = min(t / 0.2, 1.0)
    return 0.2 * (s**6 - 3.0 * s**5 + 2.5 * s**4) + max(t - 0.2, 0.0)


def moved(model, step=1e-3, t_end=0.8, of=None, **given):
    rest = ancf.equilibrium(model, of=of)
    return ancf.simulate(model, t_end=t_end, step=step, start=rest, integrator=HELD, **given)


class TestOverAFixedSheave:
    """It slips all along: (T_1 - rhoA V^2)/(T_2 - rhoA V^2) = exp(mu phi), T_1 where it goes to."""

    @pytest.mark.parametrize(
        ("change", "turn", "mu", "at_start", "heavy"),
        [
            (-0.5, 0.5, 0.3, False, {}),
            (0.6, 0.5, 0.3, True, {}),
            (-3.0, 0.8, 0.15, True, {"rhoA": 1.0, "load": 100.0, "elements": 60, "free": 2.2}),
        ],
    )
    def test_ratio_of_the_forces(self, change, turn, mu, at_start, heavy):
        given = {"rhoA": 0.3, "load": 300.0, **heavy}
        model, top, end, _ = hoist(change, turn * np.pi, mu=mu, at_start=at_start, **given)
        run = moved(model, t_end=0.5, output_step=0.01)
        late = run.t > 0.3
        pull, load = run.tension(top)[late].mean(), run.tension(end)[late].mean()
        away, wanted = given["rhoA"] * change**2, np.exp(np.sign(-change) * mu * turn * np.pi)
        assert load == pytest.approx(given["load"], rel=2e-3)
        assert (pull - away) / (load - away) == pytest.approx(wanted, rel=5e-3)
        assert not heavy or abs(pull / load - wanted) > 0.02 * wanted  # without V^2

    def test_error_shrinks_with_the_mesh(self):
        gaps = []
        for elements in (10, 20, 40):
            model, top, end, _ = hoist(-0.5, elements=elements)
            run = moved(model, output_step=0.01)
            late = run.t > 0.4
            ratio = (run.tension(top)[late] / run.tension(end)[late]).mean()
            gaps.append(abs(ratio / np.exp(0.15 * np.pi) - 1.0))
        assert gaps[0] > 2 * gaps[2]
        assert gaps[2] < 2e-3

    def test_without_friction_work_lifts_the_load(self):
        model, top, _, contact = hoist(-0.5, mu=0.0, rhoA=2.0)
        run = moved(model, t_end=0.6, sensors=[contact])
        late = run.t > 0.5
        force = 300.0 + 0.0 * run.t[late]
        assert run.tension(top)[late] == pytest.approx(force, rel=5e-3)
        # the force on a sheave by size: all of T - rhoA V^2 over its angle
        assert run.sensors.contact_force(contact)[-1] == pytest.approx((300.0 - 0.5) * 0.5 * np.pi, rel=1e-2)
        hauled = 0.5 * travelled(0.6)
        lifted = 300.0 * hauled + 0.5 * 2.0 * run.natural_length("rope")[-1] * 0.5**2
        assert run.energy.supplied[-1] - run.energy.supplied[0] == pytest.approx(
            lifted - 300.0 * hauled, abs=0.01 * 300.0 * hauled
        )

    def test_all_work_is_accounted_for(self):
        drift = []
        for step in (1e-3, 5e-4):
            energy = moved(hoist(-0.5)[0], step, t_end=0.5).energy
            drift.append(np.abs(energy.drift).max() / np.ptp(energy.dissipated))
        assert drift[0] < 1e-4
        assert drift[1] < 0.6 * drift[0]


class TestOverATurningSheave:
    def test_it_turns_with_the_rope(self):
        """It sticks: R omega is the speed of the rope, and in even motion both forces are the same."""
        model, top, end, _ = hoist(-0.5, mu=0.6, inertia=0.05)
        run = moved(model, of=["rope"])
        late = run.t > 0.6
        omega = run.angular_velocity("hub")[late][:, 1]
        assert np.abs(omega).mean() * RC == pytest.approx(0.5, rel=5e-3)
        assert run.tension(top)[late].mean() == pytest.approx(run.tension(end)[late].mean(), rel=2e-3)
        inertia = 0.05 / RC**2 + 0.3 * run.natural_length("rope")[-1]
        assert run.energy.kinetic[-1] == pytest.approx(0.5 * inertia * 0.5**2, rel=1e-2)
