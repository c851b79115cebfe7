"""Cables on cables: equilibrium, stick and slip, momenta and energy, nothing goes through, a knot."""

import math

import numpy as np
import pytest

import ancf

D = 0.02


def section(**given):
    return ancf.Section(**{"EA": 1e4, "EI": 0.05, "rhoA": 0.3, "diameter": D, **given})


class TestEquilibrium:
    @pytest.mark.parametrize("elements", [(8, 8), (9, 6)])
    def test_one_hangs_on_the_other(self, elements):
        """A load on the upper one; what the lower one's pins bear is its weight and what presses on it."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        low = model.add_beam(
            "low", start=(0, -0.5, 0), end=(0, 0.5, 0), elements=elements[0], section=section()
        )
        top = model.add_beam(
            "top", start=(-0.5, 0, D), end=(0.5, 0, D), elements=elements[1], section=section()
        )
        pins = [model.pin(p) for beam in (low, top) for p in (beam.start, beam.end)]
        model.add_force(top.at(0.5), (0, 0, -20.0))
        contact = model.add_contact(top, low, stiffness=1e6)
        state = ancf.equilibrium(model)
        below, above = (sum(state.reaction(pin)[2] for pin in two) for two in (pins[:2], pins[2:]))
        assert below + above == pytest.approx(20.0 + 2 * 0.3 * 9.81, rel=2e-3)
        assert below - 0.3 * 9.81 == pytest.approx(state.contact_force(contact), rel=0.03)
        assert below > 8.0
        assert -0.1 * D < state.contact_gap(contact) < 0.0


class TestFriction:
    @staticmethod
    def pulled(angle, share, friction=0.4, press=40.0, step=1e-3, until=0.2, k=1e6):
        """A rod that is pressed on two others, which are held, and pulled along itself by a share of mu N."""
        model = ancf.Model()
        stiff = section(EA=1e5, EI=50.0)
        rod = model.add_beam("rod", start=(-0.5, 0, D), end=(0.5, 0, D), elements=6, section=stiff)
        way, contacts = 0.3 * np.array([math.cos(angle), math.sin(angle), 0.0]), []
        for k_, x in enumerate((-0.23, 0.21)):
            at = np.array([x, 0, 0])
            bar = model.add_beam(f"bar{k_}", start=at - way, end=at + way, elements=2, section=stiff)
            for n in range(3):
                model.clamp(bar.at(0.3 * n), stretch="fixed")
            contacts.append(model.add_contact(rod, bar, stiffness=k, damping=300.0, friction=friction))
        model.hold(rod.start, position="y")
        model.hold(rod.end, position="y")
        model.add_distributed_load(rod, (0, 0, f"-{press}*min(t/0.05, 1)"))
        model.add_force(rod.end, (f"{share * friction * press}*max(0, min((t - 0.06)/0.04, 1))", 0, 0))
        return rod, contacts, ancf.simulate(model, t_end=until, step=step, sensors=[*contacts, rod.end])

    @pytest.mark.parametrize("angle", [0.5 * math.pi, 1.0])
    def test_sticks_below_and_slips_above(self, angle):
        """mu N holds what is less, by friction that is as large; else the rest of the pull accelerates."""
        rod, contacts, run = self.pulled(angle, 0.9, until=0.3)
        x, t = run.sensors.position(rod.end)[:, 0], run.sensors.t
        assert np.ptp(x[t > 0.2]) < 1e-4  # it vibrates; free it would go 60 cm
        assert sum(run.sensors.friction_force(c)[-1] for c in contacts) == pytest.approx(
            0.36 * 40.0, rel=2e-2
        )
        assert all(run.sensors.slipping(c)[-1] == 0.0 for c in contacts)
        rod, contacts, run = self.pulled(angle, 1.5)
        t, late = run.sensors.t, run.sensors.t > 0.12
        normal = sum(run.sensors.contact_force(c) for c in contacts)
        friction = sum(run.sensors.friction_force(c) for c in contacts)
        assert friction[late].mean() == pytest.approx(0.4 * normal[late].mean(), rel=1e-2)
        assert all(run.sensors.slipping(c)[-1] == 1.0 for c in contacts)
        pull = 24.0 * np.clip((t - 0.06) / 0.04, 0.0, 1.0)
        gained = np.trapezoid((pull - friction)[late], t[late]) / 0.3
        v = run.velocity(rod.at(0.5))[late, 0]
        # the normals of a deep crossing lean along the rod: their damping takes up to 0.9 N at 3 m/s
        assert v[-1] - v[0] == pytest.approx(gained, rel=5e-2)
        assert v[-1] - v[0] < gained


def thrown(step, friction, method=None, until=0.06, angle=1.2):
    """One cable thrown on another one: nothing holds them."""
    model = ancf.Model()
    one = model.add_beam(
        "one", start=(-0.47, 0.02, D + 0.002), end=(0.53, 0.02, D + 0.002), elements=3, section=section()
    )
    way = 0.5 * np.array([math.cos(angle), math.sin(angle), 0.0])
    two = model.add_beam("two", start=-way, end=way, elements=4, section=section())
    one.set_motion(velocity=(0.3, 0.1, -0.5))
    contact = model.add_contact(one, two, stiffness=1e5, friction=friction, damping=20.0 * (friction > 0))
    method = ancf.Trapezoidal() if method is None else method
    return model, contact, ancf.simulate(model, t_end=until, step=step, sensors=[contact], integrator=method)


class TestThrown:
    @pytest.mark.parametrize("friction", [0.0, 0.3])
    def test_momenta_and_energy(self, friction):
        """By the explicit method, which keeps both momenta whatever the forces are if those are balanced."""
        drift = []
        for step in (2e-5, 1e-5):
            _, contact, run = thrown(step, friction, ancf.Explicit())
            p, L = run.momentum, run.angular_momentum()
            assert run.sensors.contact_force(contact).max() > 1.0
            assert np.abs(p - p[0]).max() < 1e-12
            assert np.abs(L - L[0]).max() < 1e-12
            drift.append(abs(run.energy.drift).max() / run.energy.kinetic[0])
        assert drift[1] < 5e-5
        assert drift[1] < 1e-6 or drift[1] < 0.6 * drift[0]
        assert (run.energy.dissipated[-1] > 1e-3 * run.energy.kinetic[0]) == (friction > 0)

    def test_methods_agree(self):
        ends = []
        for method, step in ((None, 2e-4), (ancf.Explicit(), 1e-5), (ancf.Radau(), 1e-3)):
            model, _, run = thrown(step, 0.3, method)
            ends.append(run.position(model.beams["one"].at(0.3))[-1])
        assert np.abs(ends[0] - ends[1]).max() < 5e-5
        assert np.abs(ends[2] - ends[1]).max() < 1e-4

    def test_goes_on_to_the_last_bit(self, tmp_path):
        model, _, whole = thrown(2e-4, 0.3, until=0.05)
        kept = {"step": 2e-4, "integrator": ancf.Trapezoidal(), "output_step": 5e-3}
        ancf.simulate(model, t_end=0.03, file=tmp_path / "a.h5", **kept)
        again = ancf.resume(tmp_path / "a.h5", t_end=0.05)
        assert np.array_equal(again.q[-1], whole.q[-1])


@pytest.mark.parametrize(("speed", "step"), [(5.0, 2e-3), (300.0, 1e-3)])
def test_does_not_go_through(speed, step):
    """Steps as long as the cable is thick, and far longer ones: smaller steps, or a message."""
    model = ancf.Model()
    low = model.add_beam("low", start=(0, -0.5, 0), end=(0, 0.5, 0), elements=4, section=section())
    top = model.add_beam("top", start=(-0.5, 0, 0.2), end=(0.5, 0, 0.2), elements=4, section=section())
    top.set_motion(velocity=(0, 0, -speed))
    model.add_contact(top, low, stiffness=1e6, damping=100.0)
    if speed > 100.0:
        with pytest.raises(ancf.SolveError, match="goes through"):
            ancf.simulate(model, t_end=10 * step, step=step)
        return
    run = ancf.simulate(model, t_end=0.1, step=step)
    assert (run.position(top.at(0.5)) - run.position(low.at(0.5)))[:, 2].min() > 0.4 * D
