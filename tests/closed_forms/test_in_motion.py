"""Accelerations and reactions in motion: Newton's law, closed forms, momentum, methods, files, live runs."""

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError
from helpers import square

G = 9.81
METHODS = [ancf.Trapezoidal(), ancf.GeneralizedAlpha(0.7), ancf.Explicit(), ancf.Radau(adaptive=False)]
EULER = {"EA": 500.0, "EI": 0.02, "rhoA": 0.7}


def swing(element="cable", elements=4, damping=0.0, drive=None, load=None):
    """A cable or beam that falls from the horizontal, held at two places, with a mass at its end."""
    model = ancf.Model(gravity=(0.4, 0, -G))
    section = square(element, **EULER) if element != "cable" else ancf.Section(**EULER, damping=damping)
    wire = model.add_beam(
        "wire", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section, element=element
    )
    model.pin(wire.start, displacement=drive, name="hook")
    model.hold(wire.at(1.0), position="y", name="rail")
    if load is not None:
        model.add_distributed_load(wire, load)
    return model, wire


def weights(t):
    """Of the derivative by time at the middle one of five equal steps."""
    return np.array([1.0, -8.0, 0.0, 8.0, -1.0]) / (12.0 * (t[1] - t[0]))


def rate(t, x):
    """Derivative of a history by fourth-order differences, without two rows at each end."""
    w = weights(t)
    return sum(w[k] * x[k : len(x) - 4 + k] for k in range(5) if w[k])


@pytest.mark.parametrize("method", METHODS, ids=lambda method: method.name)
def test_pendulum_of_a_point(method):
    """A mass on a taut massless link: a is centripetal and tangential, the reaction m (a - g)."""
    model = ancf.Model(gravity=(0, 0, -G))
    mass = model.add_point_mass("mass", at=(1, 0, 0), mass=2.0)
    model.add_spring(mass, (0, 0, 0), stiffness=5e3, length=1.0 - 2.0 * G / 5e3, name="link")
    model.hold(mass, position="y", name="plane")
    model.add_force(mass, ("0", "3*sin(7*t)", "0"))
    run = ancf.simulate(model, t_end=0.3, step=5e-4, integrator=method)
    r = run.position(mass)
    pull = -run.spring_force("link")[:, None] * r / np.linalg.norm(r, axis=1)[:, None]
    a = (pull + np.array([0, 0, -2.0 * G])) / 2.0
    assert run.acceleration(mass) == pytest.approx(a, abs=1e-6)
    held = np.stack([0 * run.t, -3 * np.sin(7 * run.t), 0 * run.t], axis=1)
    assert run.reaction("plane") == pytest.approx(held, abs=1e-9)
    assert run.state(40).acceleration(mass) == pytest.approx(a[40], abs=1e-6)


@pytest.mark.parametrize("elements", [2, 5])
@pytest.mark.parametrize("element", ["cable", "nonlocking", "original"])
def test_reactions_are_what_the_momentum_lacks(element, elements):
    """Sum of reactions and loads is d(momentum)/dt, with a hook that moves."""
    drive = ["0.02*sin(20*t)*t", 0, 0]
    model, wire = swing(element, elements, drive=drive, load=(0, "0.3*sin(9*t)", 0.1))
    step = 2.5e-4
    run = ancf.simulate(model, t_end=0.1, step=step, integrator=ancf.GeneralizedAlpha(0.0))
    sideways = np.stack([0 * run.t, 0.3 * np.sin(9 * run.t), 0 * run.t + 0.1], axis=1)
    outer = wire.section.rhoA * np.array([0.4, 0, -G]) + sideways
    wanted = rate(run.t, run.momentum) - outer[2:-2]
    held = run.reaction("hook") + run.reaction("rail")
    assert np.abs(wanted).max() > 3.0
    assert held[2:-2] == pytest.approx(wanted, abs=2e-2)


@pytest.mark.parametrize("x", [0.25, 0.4, 1.0])
def test_acceleration_is_the_rate_of_the_velocity(x):
    model, wire = swing(drive=["0.02*sin(20*t)*t", 0, 0])
    run = ancf.simulate(model, t_end=0.1, step=2.5e-4, integrator=ancf.GeneralizedAlpha(0.0))
    a = run.acceleration(wire.at(x))
    assert np.abs(a).max() > 5.0
    assert a[4:-2] == pytest.approx(rate(run.t, run.velocity(wire.at(x)))[2:], abs=3e-2)


def test_driven_support_moves_as_it_is_told():
    model, wire = swing(drive=["0.02*sin(20*t)", 0, 0])
    run = ancf.simulate(model, t_end=0.05, step=1e-3)
    wanted = -0.02 * 400 * np.sin(20 * run.t)
    assert run.acceleration(wire.start)[:, 0] == pytest.approx(wanted, abs=1e-6)


@pytest.mark.parametrize("method", METHODS[:3], ids=lambda method: method.name)
class TestRecorded:
    """Sensors, stepper and file have what the result computes anew."""

    def run(self, method, **given):
        model, wire = swing(damping=1e-3, load=["-0.5*vx", 0, "0.1*z"])
        return model, wire, {"step": 2e-4, "integrator": method, "sensors": [wire.at(0.4), "hook", "rail"]}

    def test_sensors_and_files(self, method, tmp_path):
        model, wire, given = self.run(method)
        run = ancf.simulate(model, t_end=0.02, output_step=2e-3, **given)
        loaded = ancf.load(ancf.simulate(model, t_end=0.02, file=tmp_path / "r.h5", **given)._store.path)
        for made in (run, loaded):
            rows = np.searchsorted(made.sensors.t, made.t - 1e-9)
            for name in ("hook", "rail"):
                recorded, computed = made.sensors.reaction(name)[rows], made.reaction(name)
                assert recorded == pytest.approx(computed, abs=1e-5)
            recorded = made.sensors.acceleration(wire.at(0.4))[rows]
            assert recorded == pytest.approx(made.acceleration("wire.at(0.4)"), abs=2e-4)
        table = run.sensors.to_pandas()
        assert np.array_equal(table["hook reaction z [N]"], run.sensors.reaction("hook")[:, 2])

    def test_stepper_and_that_questions_change_nothing(self, method):
        model, _, given = self.run(method)
        whole = ancf.simulate(model, t_end=0.021, **given)
        run = ancf.stepper(model, **given)
        for k in range(100):
            run.advance()
            force, a = run.reaction("hook"), run.acceleration("wire.at(0.4)")
            assert force == pytest.approx(whole.sensors.reaction("hook")[k + 1], abs=1e-9)
            assert a == pytest.approx(whole.sensors.acceleration("wire.at(0.4)")[k + 1], abs=1e-9)
        assert np.array_equal(run.q, whole.q[100])
        assert np.array_equal(run.sensors.reaction("rail"), whole.sensors.reaction("rail")[:101])
        assert run.state().reaction("hook") == pytest.approx(force, abs=1e-5)


def test_inputs_and_controllers():
    """A force that a controller gives is known to sensors and in all states: results keep inputs."""
    model = ancf.Model()
    mass = model.add_point_mass("mass", at=(0, 0, 0), mass=2.0)
    model.pin(mass, name="hand")
    model.add_force(mass, (model.add_input("u"), 0, 0))

    def lead(run):
        run.inputs["u"] = 10.0 * run.t

    run = ancf.simulate(model, t_end=0.1, step=1e-2, controller=lead, sensors=["hand"])
    pushed = -10.0 * np.concatenate([[0.0], run.t[:-1]])
    assert run.sensors.reaction("hand")[:, 0] == pytest.approx(pushed, abs=1e-12)
    assert run.state().reaction("hand")[0] == pytest.approx(pushed[-1], abs=1e-12)
    assert run.reaction("hand")[:, 0] == pytest.approx(pushed, abs=1e-12)


def test_friction_that_sticks_is_known_to_sensors_and_to_the_last_state():
    model = ancf.Model(gravity=(0, 0, -G))
    section = ancf.Section(EA=1e5, EI=0.0, rhoA=5.0, diameter=0.05)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(4, 0, 0), elements=4, section=section)
    model.pin(wire.start, displacement=["0.05*sin(3*t)", 0, 0], name="hook")
    model.add_ground("floor", 0.001, stiffness=1e6, damping=1e4, friction=0.4)
    run = ancf.simulate(
        model, t_end=0.1, step=1e-3, start=ancf.equilibrium(model), sensors=["hook"], integrator=METHODS[1]
    )
    assert run.state().reaction("hook") == pytest.approx(run.sensors.reaction("hook")[-1], rel=1e-2, abs=0.5)
    for ask in (run, run.state(3)):
        with pytest.raises(ModelError, match=r"friction depends on the way .*sensors record it"):
            ask.reaction("hook")


def test_a_start_at_rest_that_is_no_equilibrium():
    """What is let go falls at once: the hook holds its share of the weight of a straight rod, m g/4."""
    model = ancf.Model(gravity=(0, 0, -G))
    bar = model.add_rigid_body("bar", at=(0.5, 0, 0), mass=3.0, inertia=(1e-4, 0.25, 0.25))
    wire = model.add_beam("wire", start=(-9, 0, 0), end=(-8, 0, 0), elements=1, section=ancf.Section(**EULER))
    model.pin(wire.start, name="other")
    pin = model.add_point_mass("pin", at=(0, 0, 0), mass=1e-3)
    model.pin(pin, name="hook")
    model.connect(pin, bar.at(-0.5, 0, 0))
    run = ancf.simulate(model, t_end=1e-3, step=1e-3)
    force = run.state(0).reaction("hook")
    assert force[2] == pytest.approx(3.0 * G / 4 + 1e-3 * G, rel=1e-6)
    assert run.reaction("hook")[0] == pytest.approx(force, abs=1e-9)


class TestSlidingJoint:
    @pytest.mark.parametrize("mu", [0.0, 0.3])
    def test_normal_part_and_friction_on_a_slope(self, mu):
        model = ancf.Model(gravity=(0, 0, -G))
        bar = model.add_rigid_body("bar", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
        model.clamp(bar)
        bead = model.add_point_mass("bead", at=(0.6, 0, -0.8), mass=2.0)
        line = ((0, 0, 0), (3.0, 0, -4.0))
        joint = model.slide(
            bead, along=bar, line=line, friction=mu, friction_velocity=1e-4, viscous=0.5, name="slider"
        )
        run = ancf.simulate(model, t_end=0.3, step=1e-3)
        across = 2.0 * G * 0.6 * np.array([-0.8, 0, -0.6])
        assert run.normal_force(joint) == pytest.approx(np.broadcast_to(across, (301, 3)), abs=1e-6)
        v = run.arc_rate("slider")
        rubbed = 0.5 * v + mu * 2.0 * G * 0.6 * np.tanh(v / 1e-4)
        assert run.sliding_friction("slider") == pytest.approx(rubbed, abs=1e-6)
        along = np.array([0.6, 0, -0.8])
        force = run.multiplier(joint) - run.normal_force(joint)
        assert force @ along == pytest.approx(run.sliding_friction(joint), abs=1e-6)
        assert run.state(7).sliding_friction(joint) == pytest.approx(rubbed[7], abs=1e-6)

    def test_on_a_cable_that_stretches(self):
        """The tangential part of the force is friction, whatever the shape and the stretch."""
        model = ancf.Model(gravity=(0, 0, -G))
        rope = ancf.Section(EA=80.0, EI=0.01, rhoA=0.1)
        wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, -0.3), elements=6, section=rope)
        model.pin(wire.start)
        model.pin(wire.end)
        bead = model.add_point_mass("bead", at=wire.at(0.5).body.initial_position(0.5), mass=0.3)
        joint = model.slide(bead, along=wire, friction=0.2, friction_velocity=0.05, viscous=0.1)
        run = ancf.simulate(model, t_end=0.2, step=1e-3, sensors=[joint])
        tangents = np.array(
            [run.state(k).slope(wire.at(float(s))) for k, s in enumerate(run.arc_length(joint))]
        )
        along = np.einsum("nc,nc->n", run.multiplier(joint), tangents) / np.linalg.norm(tangents, axis=1)
        assert np.linalg.norm(tangents, axis=1).max() > 1.01
        assert np.abs(along).max() > 0.1
        assert run.sliding_friction(joint) == pytest.approx(along, abs=1e-6)
        with pytest.raises(ModelError, match="have not recorded the shape of its carrier"):
            run.sensors.normal_force(joint)


class TestRefused:
    def test_names(self):
        model, wire = swing()
        run = ancf.simulate(model, t_end=2e-3, step=1e-3, sensors=[wire.end, "hook"])
        with pytest.raises(ModelError, match=r'unknown support .*"hook", "rail"'):
            run.reaction("hock")
        with pytest.raises(
            ModelError, match=r"is no support that the sensors have recorded .*wire.end, hook"
        ):
            run.sensors.reaction("rail")
        with pytest.raises(ModelError, match=r"was not recorded by the sensors"):
            run.sensors.acceleration(wire.at(0.1))

    def test_methods_of_radau_have_no_accelerations_for_sensors(self):
        model, wire = swing()
        with pytest.raises(ModelError, match=r'"hook" is a support, and with Radau'):
            ancf.simulate(model, t_end=2e-3, step=1e-3, integrator=ancf.Radau(), sensors=["hook"])
        run = ancf.simulate(model, t_end=2e-3, step=1e-3, integrator=ancf.Radau(), sensors=[wire.end])
        with pytest.raises(ModelError, match="have no accelerations"):
            run.sensors.acceleration(wire.end)
        assert np.all(np.isfinite(run.acceleration(wire.end)))
