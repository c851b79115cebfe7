"""Springs with curves and friction, wires with a profile: scipy, equilibria, kept energy, messages."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ancf
from ancf.errors import ModelError

LAW = [[-0.1, -500.0], [-0.02, -40.0], [0.0, 0.0], [0.03, 30.0], [0.08, 900.0]]  # m, N
DAMPER = [[-1.0, -2.0], [0.0, 0.0], [1.0, 8.0]]  # m/s, N
FRICTION, CREEP, MASS = 3.0, 0.02, 2.0  # N, m/s, kg


def hung(**given):
    """A mass below the origin on a spring of 1 m, and the spring."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    mass = model.add_point_mass("mass", at=(0.0, 0.0, -1.0), mass=MASS)
    model.hold(mass, position="xy")
    spring = model.add_spring(mass, (0.0, 0.0, 0.0), length=1.0, name="spring", **given)
    return model, mass, spring


def curve(rows, x):
    place, force = np.array(rows).T
    k = int(np.clip(np.searchsorted(place, x, side="right") - 1, 0, len(place) - 2))
    return force[k] + (force[k + 1] - force[k]) / (place[k + 1] - place[k]) * (x - place[k])


class TestCurves:
    @pytest.mark.parametrize("linear", [0.0, 150.0])
    def test_motion(self, linear):
        """Beyond the last rows on both sides, through all of them, with damper and friction."""
        more = {"friction": FRICTION, "friction_velocity": CREEP, "stiffness": linear, "damping": 1.5}
        model, mass, spring = hung(law=LAW, damper=DAMPER, **more)
        mass.set_motion(velocity=(0.0, 0.0, -5.5))

        def rates(t, y):
            force = linear * y[0] + 1.5 * y[1] + curve(LAW, y[0]) + curve(DAMPER, y[1])
            return [y[1], 9.81 - (force + FRICTION * np.tanh(y[1] / CREEP)) / MASS]

        result = ancf.simulate(model, t_end=0.6, step=5e-5)
        told = solve_ivp(
            rates, (0, 0.6), [0.0, 5.5], rtol=1e-10, atol=1e-12, max_step=5e-4, dense_output=True
        )
        x, rate = told.sol(result.t)
        assert x.max() > 0.081
        assert x.min() < -0.02
        assert -result.position(mass)[:, 2] - 1.0 == pytest.approx(x, abs=3e-6)
        force = MASS * (9.81 - np.gradient(rate, result.t))
        smooth = slice(5, -5)
        assert result.spring_force(spring)[smooth] == pytest.approx(force[smooth], abs=2.0)

    def test_energy_is_accounted_for(self):
        """What the damper and friction take is what motion and spring lose."""
        model, mass, _ = hung(law=LAW, damper=DAMPER, friction=FRICTION)
        mass.set_motion(velocity=(0.0, 0.0, -2.5))
        result = ancf.simulate(model, t_end=0.6, step=1e-4)
        assert result.energy.dissipated[-1] > 1.0
        assert np.abs(result.energy.drift).max() < 2e-3 * result.energy.kinetic[0]

    def test_energy_of_the_curve(self):
        """Its integral: of an undamped one nothing is lost."""
        model, mass, _ = hung(law=LAW)
        mass.set_motion(velocity=(0.0, 0.0, -2.5))
        result = ancf.simulate(model, t_end=0.6, step=5e-5)
        assert result.energy.dissipated[-1] == 0.0
        assert np.abs(result.energy.drift).max() < 2e-3 * result.energy.kinetic[0]

    def test_equilibrium(self):
        """2 kg on the curve: 19.62 N at 19.62 mm of 30 mm for 30 N."""
        model, mass, spring = hung(law=LAW, friction=FRICTION)
        state = ancf.equilibrium(model)
        assert -state.position(mass)[2] - 1.0 == pytest.approx(0.01962, abs=1e-9)
        assert state.spring_force(spring) == pytest.approx(19.62, abs=1e-7)

    def test_frequency_in_the_steep_part(self):
        """A load that reaches the piece of 17.4 kN/m."""
        model, mass, _ = hung(law=LAW)
        model.add_force(mass, (0.0, 0.0, -200.0))
        slope = 870.0 / 0.05
        modes = ancf.modes(model, count=1, about=ancf.equilibrium(model))
        assert modes.frequencies_hz[0] == pytest.approx(np.sqrt(slope / MASS) / (2.0 * np.pi), rel=1e-6)

    def test_description(self):
        model, _, _ = hung(law=LAW, damper=DAMPER, friction=FRICTION)
        again = ancf.Model.from_dict(model.to_dict())
        assert again.to_dict() == model.to_dict()
        assert "friction = 3 N, law of 5 points" in str(model)


class TestRefused:
    @pytest.mark.parametrize(
        ("given", "key", "what"),
        [
            ({"law": [[0.0, 0.0]]}, "law", "has 1 rows"),
            ({"law": [[0.0, 0.0], [0.0, 1.0]]}, "law[1][0]", "is 0 after 0"),
            ({"damper": [[-1.0, 5.0], [0.0, 0.0]]}, "damper", "drives"),
            ({"damper": [[-1.0, -5.0], [1.0, 5.0]]}, "damper", "drives"),
            ({"damper": [[0.0, 0.0], [1.0, 5.0], [2.0, 1.0]]}, "damper", "drives"),
            ({"friction": -1.0}, "friction", "must be >= 0"),
            ({"law": LAW, "slack": True}, "law", "slack"),
            ({}, "stiffness", "both 0"),
        ],
    )
    def test_springs(self, given, key, what):
        with pytest.raises(ModelError) as caught:
            hung(**given)
        assert caught.value.where.endswith(f".{key}")
        assert what in str(caught.value)


class TestProfile:
    def strip(self, speed, wave=0.4, depth=0.01):
        """A mass that slides freely along x below a wire with waves, pushed up by 40 N."""
        model = ancf.Model()
        section = ancf.Section(EA=1e9, EI=1e9, rhoA=1.0)
        wire = model.add_beam("wire", start=(0, 0, 0), end=(4, 0, 0), elements=8, section=section)
        for x in np.linspace(0.0, 4.0, 9):
            model.pin(wire.at(x))
        s = np.linspace(0.0, 4.0, 8001)
        rows = np.column_stack([s, depth * np.sin(2.0 * np.pi * s / wave)])
        head = model.add_point_mass("head", at=(1.0, 0.0, -40.0 / 5e3), mass=1.0)
        model.hold(head, position="y")
        head.set_motion(velocity=(speed, 0.0, 0.0))
        model.add_force(head, (0.0, 0.0, 40.0))
        model.add_contact(head, wire, stiffness=5e3, profile=rows, name="touch")
        return model, head, wave, depth

    def test_energy_is_kept(self):
        """The slope of the profile pushes along the wire: what the strip gains upwards it loses in speed."""
        model, head, _, depth = self.strip(speed=1.5)
        result = ancf.simulate(model, t_end=0.6, step=5e-4)
        slowest = result.velocity(head)[:, 0].min()
        assert slowest < 1.3
        assert np.abs(result.energy.drift).max() < 1e-3 * result.energy.kinetic[0]
        assert np.ptp(result.position(head)[:, 2]) > depth

    def test_force_in_contact(self):
        """5 kN/m times the overlap of strip and profile."""
        model, head, wave, depth = self.strip(speed=1.5)
        result = ancf.simulate(model, t_end=0.3, step=1e-4)
        x, _, z = result.position(head).T
        told = 5e3 * np.maximum(z + depth * np.sin(2.0 * np.pi * x / wave), 0.0)
        assert result.contact_force("touch") == pytest.approx(told, abs=0.05)

    def test_refused(self):
        model = ancf.Model()
        wire = model.add_beam(
            "wire", start=(0, 0, 0), end=(4, 0, 0), elements=2, section=ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)
        )
        head = model.add_point_mass("head", at=(1.0, 0.0, 0.0), mass=1.0)
        with pytest.raises(ModelError, match=r"profile\[1\]\[0\]: is 0.5 after 1"):
            model.add_contact(head, wire, stiffness=1e3, profile=[[1.0, 0.0], [0.5, 0.0]])
