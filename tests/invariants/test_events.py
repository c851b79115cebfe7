"""What happens to sliding joints between two steps: an end of the line, contact that opens and closes."""

import numpy as np
import pytest

import ancf
from motions import ball

G = 9.81
SLOPE = np.array([0.6, 0.0, -0.8])  # direction of the inclined wire


class TestEnds:
    def run(self, how, line=1.5, speed=0.0):
        model = ancf.Model(gravity=(0, 0, -G))
        wire = model.add_rigid_body("wire", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
        model.clamp(wire)
        bead = model.add_point_mass("bead", at=SLOPE, mass=1.0)
        bead.set_motion(velocity=speed * SLOPE)
        joint = model.slide(bead, along=wire, line=((0, 0, 0), line * SLOPE), at_end=how, name="joint")
        return ancf.simulate(model, t_end=1.0, step=1e-3), bead, joint

    ARRIVAL = np.sqrt(2 * 0.5 / (0.8 * G))

    def test_stop(self):
        with pytest.raises(ancf.SolveError, match="has reached the end of wire") as caught:
            self.run("stop")
        assert "joint" in caught.value.where
        assert "1.5 m" in str(caught.value)
        result = caught.value.result
        assert result.status == "failed"
        assert result.t[-1] == pytest.approx(self.ARRIVAL, abs=1.5e-3)

    def test_stop_at_the_start(self):
        with pytest.raises(ancf.SolveError, match="has reached the start of wire"):
            self.run("stop", speed=-5.0)

    def test_clamp(self):
        result, bead, joint = self.run("clamp")
        after = result.t > self.ARRIVAL + 2e-3
        assert result.arc_length(joint)[after] == pytest.approx(1.5, abs=1e-12)
        assert result.position(bead)[after] == pytest.approx(np.tile(1.5 * SLOPE, (after.sum(), 1)), abs=1e-9)
        assert result.multiplier(joint)[-1] == pytest.approx((0, 0, -G), abs=1e-8)  # all of its weight
        speed = 0.8 * G * self.ARRIVAL
        assert result.energy.dissipated[-1] == pytest.approx(0.5 * speed**2, rel=1e-2)  # the impact
        assert result.energy.kinetic[-1] == pytest.approx(0, abs=1e-15)
        assert np.ptp(result.energy.balance) < 1e-9 * speed**2 + 1e-9

    def test_release(self):
        """Then it falls freely."""
        result, bead, joint = self.run("release")
        after = result.t - self.ARRIVAL
        speed = 0.8 * G * self.ARRIVAL
        fall = 1.5 * SLOPE + after[:, None] * speed * SLOPE + 0.5 * after[:, None] ** 2 * np.array([0, 0, -G])
        later = after > 2e-3
        assert result.position(bead)[later] == pytest.approx(fall[later], abs=2e-3)
        assert np.max(np.abs(result.multiplier(joint)[later])) < 1e-12
        assert np.ptp(result.energy.balance) < 1e-9


class TestContact:
    """The pan pushes the wire from below: what the wire receives points upwards or is zero."""

    PUSH = 2.0 * G

    def test_opens_and_closes(self):
        """Lifted by weight + 30 sin(20 t): it leaves at t = pi/20, flies and comes back with an impact."""
        model, pan, joint = ball(force=(0, 0, f"{self.PUSH} + 30*sin(20*t)"))
        pan.set_motion(velocity=(1.0, 0, 0))
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        t, z, push = result.t, result.position(pan)[:, 2], result.multiplier(joint)[:, 2]
        assert np.min(push) >= 0.0
        assert np.max(z) < 1e-9
        first = t < np.pi / 20 - 1e-3
        assert push[first] == pytest.approx(30 * np.sin(20 * t[first]), abs=1e-2)
        assert np.max(np.abs(z[first])) < 1e-12
        # in flight: m z'' = 30 sin(20 t) from rest at t0 = pi/20: comes back when the integrals are zero
        t0 = np.pi / 20

        def flight(time):
            x = 20 * (time - t0)
            return -30 / (2.0 * 400) * (x - np.sin(x))

        away = (t > t0 + 2e-3) & (t < t0 + 0.25)
        assert z[away] == pytest.approx([flight(x) for x in t[away]], abs=2e-4)
        assert np.max(np.abs(push[away])) == 0.0
        assert np.min(z) < -0.05

    def test_rests_under_a_steady_push(self):
        model, _, joint = ball(force=(0, 0, self.PUSH + 5.0))
        result = ancf.simulate(model, t_end=0.2, step=1e-3)
        assert result.multiplier(joint)[:, 2] == pytest.approx(np.full(201, 5.0), abs=1e-8)
        assert result.energy.dissipated[-1] == pytest.approx(0, abs=1e-12)

    def test_impact(self):
        """Away for the first 0.2 s, then thrown up: the momentum across the wire is lost, the rest stays."""
        model, pan, joint = ball(force=lambda t: (0, 0, self.PUSH + (-8.0 if t < 0.2 else 8.0)))
        pan.set_motion(velocity=(0.5, 0, 0))
        result = ancf.simulate(model, t_end=1.2, step=1e-3)
        z, v, push = (x[:, 2] for x in (result.position(pan), result.velocity(pan), result.multiplier(joint)))
        assert np.min(push[1:]) >= 0.0
        landed = 0.2 + 0.2 + 0.2 * np.sqrt(2)  # 4 m/s^2 down for 0.2 s, then 4 m/s^2 up
        later = result.t > landed + 3e-3
        assert np.max(np.abs(z[later])) < 1e-9
        assert np.max(np.abs(v[later])) < 1e-9
        assert push[later] == pytest.approx(8.0, abs=1e-6)
        assert result.velocity(pan)[:, 0] == pytest.approx(0.5, abs=1e-9)
        speed = 4.0 * np.sqrt(2 * 0.16 / 4.0)
        lost = result.energy.dissipated
        assert lost[-1] == pytest.approx(0.5 * 2.0 * speed**2, rel=2e-2)
        assert np.max(np.abs(lost[result.t < landed - 5e-3])) < 1e-12
        assert np.ptp(result.energy.balance) < 2e-2  # the jump of the force within a step

    def test_pulled_away_at_the_start(self):
        model, _, joint = ball(force=(0, 0, self.PUSH - 8.0))
        result = ancf.simulate(model, t_end=0.1, step=1e-3)
        assert result.multiplier(joint)[:, 2] == pytest.approx(np.zeros(101), abs=1e-12)

    def test_held_beside_the_wire(self):
        """A pan that a support holds along the wire: s follows from that."""
        model, pan, joint = ball(force=(0, 0, self.PUSH + 5.0))
        model.hold(pan, position="x")
        result = ancf.simulate(model, t_end=0.1, step=1e-3)
        assert result.multiplier(joint)[-1] == pytest.approx((0, 0, 5.0), abs=1e-8)
        assert result.arc_length(joint)[-1] == pytest.approx(1.0, abs=1e-9)

    def test_goes_on_from_an_open_contact(self):
        model, pan, _ = ball(force=(0, 0, f"{self.PUSH} - 5*t"))
        pan.set_motion(velocity=(0.5, 0, 0))
        result = ancf.simulate(model, t_end=1.0, step=1e-3)
        assert result.position(pan)[500, 2] < -0.01
        more = ancf.simulate(model, start=result.state(500), t_end=1.0, step=1e-3)
        assert more.position(pan) == pytest.approx(result.position(pan)[500:], abs=1e-5)

    def test_no_contact_force_is_ever_negative(self):
        """A random push over many openings, at several steps."""
        rng = np.random.default_rng(3)
        amplitude, phase = rng.uniform(5, 25, 6), rng.uniform(0, 6, 6)

        def force(t):
            return 0, 0, self.PUSH + 5 + amplitude @ np.sin(np.arange(3, 9) * 4 * t + phase)

        for step in (4e-3, 1e-3):
            model, pan, joint = ball(force=force, friction=0.2)
            result = ancf.simulate(model, t_end=2.0, step=step)
            push = result.multiplier(joint)[:, 2]
            assert np.min(push) >= 0.0
            assert 0.05 < np.mean(push == 0.0) < 0.95
            assert np.max(result.position(pan)[:, 2]) < 1e-9
            assert np.ptp(result.energy.balance) < 0.05 * np.max(result.energy.supplied)
