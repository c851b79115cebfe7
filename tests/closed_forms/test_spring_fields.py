"""Forces and lengths of springs: closed forms, slack, memory against file, unknown names."""

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError
from helpers import soft


def falling(slack, speed=(0.0, 0.0, 1.0)):
    """A free mass that leaves the end of its spring and damper, at rest length 1 m, or comes nearer."""
    model = ancf.Model()
    mass = model.add_point_mass("mass", at=(0, 0, 1), mass=2.0)
    mass.set_motion(velocity=speed)
    spring = model.add_spring(mass, (0, 0, 0), stiffness=50.0, damping=3.0, slack=slack, name="hanger")
    return model, mass, spring


class TestLaw:
    def test_stretched_and_damped(self):
        """F = k u + c du/dt of the closed form of the damped oscillator."""
        model, _, spring = falling(False)
        result = ancf.simulate(model, t_end=1.0, step=5e-4)
        t, w, zw = result.t, 5.0, 3.0 / 4.0
        wd = np.sqrt(w**2 - zw**2)
        u = np.exp(-zw * t) * np.sin(wd * t) / wd
        du = np.exp(-zw * t) * np.cos(wd * t) - zw * u
        assert result.spring_length(spring) == pytest.approx(1 + u, abs=2e-7)
        assert result.spring_force(spring) == pytest.approx(50 * u + 3 * du, abs=2e-5)
        assert result.spring_force(spring).min() < -1.0  # compression has the other sign

    def test_force_is_what_the_mass_feels(self):
        """Momentum of a mass on a slack spring: the impulse of the force that is reported."""
        model, mass, _ = falling(True)
        result = ancf.simulate(model, t_end=1.5, step=2e-4)
        force = result.spring_force("hanger")
        assert force.min() == 0.0
        assert np.any(force[1:] > 1.0)
        h = result.t[1]
        impulse = np.concatenate([[0.0], np.cumsum(0.5 * h * (force[1:] + force[:-1]))])
        # the force jumps when the spring goes slack: one step's share
        assert 2.0 * (1.0 - result.velocity(mass)[:, 2]) == pytest.approx(impulse, abs=2e-3)

    @pytest.mark.parametrize("speed", [1.0, -1.0])
    def test_slack_at_its_length(self, speed):
        """At the natural length a slack spring carries nothing, whatever the damper would do."""
        model, _, spring = falling(True, (0, 0, speed))
        state = ancf.simulate(model, t_end=1e-3, step=1e-3).state(0)
        assert state.spring_force(spring) == 0.0
        assert state.spring_length(spring) == 1.0

    def test_static(self):
        """A weight on two springs in a row, one of them between points inside cables."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        one = model.add_beam("one", start=(0, 0, 0), end=(2, 0, 0), elements=2, section=soft())
        low = model.add_point_mass("low", at=(0.7, 0, -2), mass=0.4)
        spring = model.add_spring(one.at(0.7), low, stiffness=40.0, length=1.8, slack=True)
        for end in (one.start, one.end):
            model.clamp(end)
        model.hold(low, position="xy")
        state = ancf.equilibrium(model)
        length = np.linalg.norm(state.position(low) - state.position(one.at(0.7)))
        assert state.spring_length(spring) == pytest.approx(length, rel=1e-14)
        vertical = (
            state.spring_force(spring) * (state.position(one.at(0.7)) - state.position(low))[2] / length
        )
        assert vertical == pytest.approx(0.4 * 9.81, rel=1e-10)
        assert state.spring_force(spring).shape == ()


class TestFiles:
    def test_loaded_result_answers_alike(self, tmp_path):
        model, _, _ = falling(False)
        hub = model.add_rigid_body("hub", at=(1, 0, 0), mass=1.0, inertia=(0.1, 0.1, 0.1))
        beam = model.add_beam("a beam", start=(3, 0, 0), end=(4, 0, 0), elements=2, section=soft())
        hub.set_motion(velocity=(0, 0.3, 0), angular_velocity=(0, 0, 2.0))
        names = ["rope/1 ä", "ground", "hanger"]
        model.add_spring(hub.at(0.1, 0.2, 0.3), beam.at(0.3), stiffness=5.0, slack=True, name=names[0])
        model.add_spring(beam.end, (5, 0, 0.2), stiffness=7.0, damping=0.1, length=0.9, name=names[1])
        result = ancf.simulate(model, t_end=0.05, step=5e-3)
        result.save(tmp_path / "run.h5")
        loaded = ancf.load(tmp_path / "run.h5")
        assert set(loaded.springs) == set(result.springs) == set(names)
        for name in names:
            assert np.ptp(result.spring_length(name)) > 1e-5
            np.testing.assert_array_equal(loaded.spring_force(name), result.spring_force(name))
            np.testing.assert_array_equal(loaded.spring_length(name), result.spring_length(name))
        assert str(loaded.springs["rope/1 ä"].a) == "hub.at(0.1, 0.2, 0.3)"


@pytest.mark.parametrize("name", ["hangar", 3, ["hanger"], None])
def test_unknown_spring(name):
    model, _, _ = falling(False)
    result = ancf.simulate(model, t_end=0.01, step=5e-3)
    for ask in (result.spring_force, result.spring_length):
        with pytest.raises(ModelError, match="hanger") as caught:
            ask(name)
        assert "unknown spring" in str(caught.value)
