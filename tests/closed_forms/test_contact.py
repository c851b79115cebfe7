"""Contact of a wire with a strip: equilibrium, moving contact, loss, energy, bad input."""

from __future__ import annotations

import numpy as np
import pytest

import ancf
from ancf.connections.contact import ContactBatch
from ancf.connections.contact_touch import ASIDE, FORCE, OVERLAP
from ancf.system.system import System
from helpers import derivative, energy, forces

TENSION, LENGTH, EA = 20e3, 30.0, 15e6
G = 9.81


def wire_over(strip_z: float, x: float = 12.0, *, mass: float = 7.2, spring: float = 4200.0, **contact):
    """A tensioned wire without weight over a strip on a spring whose lower end is held."""
    model = ancf.Model()
    section = ancf.Section(EA=EA, EI=0.0, rhoA=1.35)
    natural = LENGTH / (1.0 + TENSION / EA)
    wire = model.add_beam(
        "wire", section=section, start=(0, 0, 0), end=(LENGTH, 0, 0), elements=300, length=natural
    )
    model.pin(wire.start)
    model.pin(wire.end)
    head = model.add_point_mass("head", at=(x, 0, strip_z), mass=mass)
    model.hold(head, position="xy")
    model.add_spring(head, (x, 0, strip_z - 1.0), stiffness=spring, length=1.0)
    touch = model.add_contact(head, wire, stiffness=50e3, **contact)
    return model, wire, head, touch


class TestKernel:
    """Forces of one contact on a bent and sloping wire, off its equilibrium, strip and wire both oblique."""

    STIFFNESS, DAMPING = 400.0, 30.0

    def system(self, *, lift=0.05, x=1.1, damping=0.0):
        model = ancf.Model()
        section = ancf.Section(EA=300.0, EI=1.0, rhoA=0.7)
        wire = model.add_beam("wire", start=(0, 0.2, 0), end=(2, 0.5, 0.3), elements=2, section=section)
        place = np.array([x, 0.2 + 0.15 * x, 0.15 * x + lift])
        head = model.add_point_mass("head", at=place, mass=1.0)
        model.add_contact(head, wire, stiffness=self.STIFFNESS, damping=damping)
        system = System(model)
        q, _ = system.initial_state()
        rng = np.random.default_rng(5)
        for slots in (system.slots["wire"][1:, 1], system.slots["wire"][1:, 0]):
            q[slots[:, None] + np.arange(3)] += rng.uniform(-0.02, 0.02, (len(slots), 3))
        return system, q

    @staticmethod
    def contact(system):
        return next(b for b in system.core.batches if isinstance(b, ContactBatch))

    def found(self, system, q, v=None):
        forces(system, q, v=v)
        return self.contact(system).found[0].copy()

    def test_force_is_gradient_of_energy(self):
        system, q = self.system()
        assert self.found(system, q)[FORCE] > 1.0
        wanted = derivative(lambda x: energy(system, x), q, step=1e-4)
        assert forces(system, q) == pytest.approx(wanted, abs=1e-7 * np.max(np.abs(wanted)))

    def test_damping_is_the_rate_of_the_overlap(self):
        """F = k g + c dg/dt with g of the same contact at times a little later and earlier."""
        system, q = self.system(damping=self.DAMPING)
        v = np.random.default_rng(6).uniform(-0.1, 0.1, len(q))
        h = 1e-5
        ahead, behind = (self.found(system, q + s * h * v)[OVERLAP] for s in (1, -1))
        now = self.found(system, q, v)
        wanted = self.STIFFNESS * now[OVERLAP] + self.DAMPING * (ahead - behind) / (2 * h)
        assert now[FORCE] == pytest.approx(wanted, rel=1e-8)
        assert abs(ahead - behind) / (2 * h) > 0.02  # the rate is seen

    def test_damper_never_pulls(self):
        """The head leaves faster than the overlap can push: no force, on nobody."""
        system, q = self.system(damping=self.DAMPING)
        v = np.zeros_like(q)
        v[system.slots["head"][0, 0] + 2] = -100.0
        assert self.found(system, q, v)[FORCE] == 0.0
        apart = q.copy()
        apart[system.slots["head"][0, 0] + 2] -= 1.0
        assert np.array_equal(forces(system, q, v=v), forces(system, apart, v=v))

    def test_what_it_finds(self):
        """Overlap and place on the strip, which is measured from the head in the strip's direction."""
        model = ancf.Model()
        section = ancf.Section(EA=300.0, EI=1.0, rhoA=0.7)
        wire = model.add_beam("wire", start=(0, 0.3, 1), end=(2, 0.3, 1), elements=2, section=section)
        head = model.add_point_mass("head", at=(0.7, 0.1, 1.02), mass=1.0)
        model.add_contact(head, wire, stiffness=self.STIFFNESS)
        system = System(model)
        found = self.found(system, system.initial_state()[0])
        assert found[OVERLAP] == pytest.approx(0.02)
        assert found[ASIDE] == pytest.approx(0.2)
        assert found[FORCE] == pytest.approx(0.02 * self.STIFFNESS)

    @pytest.mark.parametrize("x", [-0.02, 2.02])
    def test_beyond_the_ends(self, x):
        """Off the wire there is no force, although its first and last element would go on."""
        system, q = self.system(x=x, lift=0.2)
        assert self.found(system, q)[FORCE] == 0.0
        assert not np.any(forces(system, q)[system.slots["head"][0, 0] + np.arange(3)])


def test_equilibrium_is_that_of_three_springs_in_a_row():
    """Head spring, contact and the string's stiffness T/x + T/(L - x) under a prescribed overlap."""
    x = 12.0
    model, wire, head, touch = wire_over(0.02, x)
    state = ancf.equilibrium(model)
    string = TENSION / x + TENSION / (LENGTH - x)
    force = 0.02 / (1 / 4200.0 + 1 / 50e3 + 1 / string)
    # smooth elements cannot kink: 300 of them are 5e-4 too stiff under a point
    assert state.contact_force(touch) == pytest.approx(force, rel=1e-3)
    assert state.contact_gap(touch) == pytest.approx(-state.contact_force(touch) / 50e3, rel=1e-9)
    s = float(state.arc_length(touch))
    assert state.position(wire.at(s))[0] == pytest.approx(x, abs=1e-9)
    balance = 4200.0 * (0.02 - state.position(head)[2])
    assert state.contact_force(touch) == pytest.approx(balance, rel=1e-9)


def test_an_open_contact_does_nothing():
    model, wire, _, touch = wire_over(-0.01)
    state = ancf.equilibrium(model)
    assert state.contact_force(touch) == 0.0
    assert state.contact_gap(touch) == pytest.approx(0.01, abs=1e-9)
    assert abs(state.position(wire.at(12.0))[2]) < 1e-12


def test_modes_know_the_contact():
    """A heavy head on the string vibrates as on the head spring and the string in parallel."""
    model, _, _, _ = wire_over(0.02, 15.0, mass=2000.0)
    state = ancf.equilibrium(model)
    string = 1 / (1 / (4 * TENSION / LENGTH) + 1 / 50e3)
    moved = 2000.0 + 1.35 * LENGTH / 3 * (string * LENGTH / 4 / TENSION) ** 2
    expected = np.sqrt((4200.0 + string) / moved)
    assert ancf.modes(model, about=state, count=1).frequencies[0] == pytest.approx(expected, rel=2e-3)


def test_a_turned_model_gives_the_turned_result():
    """Strip along x, wire along -z, force along y: the same equilibrium."""
    turn = np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])  # x->z, y->x, z->y
    forces = []
    for R in (np.eye(3), turn):
        model = ancf.Model()
        section = ancf.Section(EA=EA, EI=100.0, rhoA=1.35)
        natural = LENGTH / (1.0 + TENSION / EA)
        wire = model.add_beam(
            "wire", section=section, start=(0, 0, 0), end=R @ (LENGTH, 0.3, 0), elements=12, length=natural
        )
        model.pin(wire.start)
        model.pin(wire.end)
        head = model.add_point_mass("head", at=R @ (11.3, 0.05, 0.03), mass=5.0)
        model.pin(head)
        touch = model.add_contact(head, wire, stiffness=50e3, strip=R @ (0, 1, 0), normal=R @ (0, 0, 1))
        state = ancf.equilibrium(model)
        forces.append((float(state.contact_force(touch)), float(state.contact_offset(touch))))
    assert forces[0][0] > 50.0
    assert forces[1] == pytest.approx(forces[0], rel=1e-9)
    assert forces[0][1] == pytest.approx(0.3 * 11.3 / LENGTH - 0.05, abs=1e-5)


def moving(speed: float, lift: float, *, damping: float = 0.0, t_end: float = 0.2, step: float = 2.5e-4):
    """A strip held at a height above the wire's line runs along it."""
    model = ancf.Model()
    section = ancf.Section(EA=EA, EI=0.0, rhoA=1.35)
    wire = model.add_beam(
        "wire",
        section=section,
        start=(0, 0, 0),
        end=(60, 0, 0),
        elements=60,
        length=60.0 / (1.0 + TENSION / EA),
    )
    model.pin(wire.start)
    model.pin(wire.end)
    head = model.add_point_mass("head", at=(20, 0, 0), mass=7.2)
    model.hold(head, position="xy", displacement=[f"{speed}*t", 0, 0])
    head.set_motion(velocity=(speed, 0, 0))
    model.add_force(head, (0, 0, lift))
    touch = model.add_contact(head, wire, stiffness=50e3, damping=damping)
    result = ancf.simulate(model, t_end=t_end, step=step)
    return wire, head, touch, result


def test_a_head_pushed_against_an_infinite_string():
    """A long string answers to a force with the speed F c/(2 T), until a wave comes back from an end."""
    c = np.sqrt(TENSION / 1.35)
    _, head, touch, result = moving(0.0, 120.0, t_end=0.15)
    force, velocity = result.contact_force(touch)[-1], result.velocity(head)[-1, 2]
    assert velocity == pytest.approx(120.0 * c / (2.0 * TENSION), rel=0.02)
    assert force == pytest.approx(120.0, rel=0.01)


def test_energy_balance_of_a_moving_contact():
    """The drive supplies what head and wire gain, also with the contact's own damping."""
    for damping in (0.0, 60.0):
        _, _, touch, result = moving(60.0, 120.0, damping=damping)
        energy = result.energy
        assert np.max(result.contact_force(touch)) > 50.0
        gained = np.ptp(energy.total)
        assert np.max(np.abs(energy.balance - energy.balance[0])) < 2e-3 * gained
        assert (energy.dissipated[-1] > 0.0) == (damping > 0.0)


def test_the_contact_runs_on_along_the_wire():
    wire, head, touch, result = moving(60.0, 120.0)
    s = result.arc_length(touch)
    last = result.state(-1)
    assert last.position(wire.at(float(s[-1])))[0] == pytest.approx(last.position(head)[0], abs=1e-9)
    assert last.position(head)[0] == pytest.approx(20.0 + 60.0 * 0.2, abs=1e-12)


def test_contact_is_lost_and_regained_without_a_pull():
    """A head thrown down from the wire comes back by its spring."""
    model, _, head, touch = wire_over(0.0, mass=7.2, spring=4200.0)
    head.set_motion(velocity=(0, 0, -0.5))
    result = ancf.simulate(model, t_end=0.16, step=2.5e-4)
    force = result.contact_force(touch)
    period = 2 * np.pi * np.sqrt(7.2 / 4200.0)
    free = result.t < 0.49 * period
    assert np.all(force >= 0.0)
    assert np.all(force[free] == 0.0)
    assert np.max(force[~free]) > 50.0
    expected = -0.5 * np.sqrt(7.2 / 4200.0) * np.sin(2 * np.pi * result.t / period)
    assert result.position(head)[free, 2] == pytest.approx(expected[free], abs=2e-6)


def test_beyond_the_end_of_the_wire_there_is_no_contact():
    _, _, touch, result = moving(200.0, 120.0, t_end=0.3)
    assert result.contact_force(touch)[-1] == 0.0
    assert np.isinf(result.contact_gap(touch)[-1])


def test_second_order_in_the_step():
    """Differences of the head's height on halving the step, while the contact stays closed."""
    heights = []
    for step in (2e-3, 1e-3, 5e-4):
        _, head, _, result = moving(40.0, 120.0, t_end=0.1, step=step)
        heights.append(result.position(head)[-1, 2])
    order = np.log2(abs(heights[1] - heights[0]) / abs(heights[2] - heights[1]))
    assert order > 1.5


def test_a_file_says_the_same(tmp_path):
    from ancf.model.file import read_study

    text = """
    [[bodies]]
    name = "wire"
    start = [0, 0, 0]
    end = [30, 0, 0]
    elements = 6
    section = {EA = 15e6, EI = 0.0, rhoA = 1.35}
    [[bodies]]
    type = "point_mass"
    name = "head"
    at = [10, 0, 0]
    mass = 7.2
    [[connections]]
    type = "contact"
    point = "head"
    along = "wire"
    stiffness = 5e4
    """
    path = tmp_path / "model.toml"
    path.write_text(text)
    model = read_study(path).model
    contact = model.connections[0]
    assert (contact.stiffness, contact.s) == (5e4, 10.0)
    assert model.to_dict()["connections"][0]["type"] == "contact"


BAD = [
    ({"stiffness": 0.0}, "stiffness", "must be"),
    ({"stiffness": 1.0, "damping": -1.0}, "damping", "must"),
    ({"stiffness": 1.0, "normal": (0, 1, 0)}, "normal", "perpendicular to strip"),
    ({"stiffness": 1.0, "strip": (1, 0, 0)}, "along", "does not run along"),
    ({"stiffness": 1.0, "strip": (0, -1, 0)}, "along", "turn the strip round"),
    ({"stiffness": 1.0, "s": 31.0}, "s", "off the wire"),
]


@pytest.mark.parametrize(("given", "key", "text"), BAD)
def test_bad_input_names_the_place(given, key, text):
    model = ancf.Model()
    wire = model.add_beam(
        "wire", section=ancf.Section(EA=EA, EI=1.0, rhoA=1.0), start=(0, 0, 0), end=(30, 0, 0), elements=2
    )
    head = model.add_point_mass("head", at=(1, 0, 0), mass=1.0)
    with pytest.raises(ancf.ModelError) as caught:
        model.add_contact(head, wire, **given)
    assert caught.value.where.endswith(key)
    assert text in str(caught.value)


def test_other_bodies_cannot_be_the_wire():
    model = ancf.Model()
    wire = model.add_beam(
        "wire", section=ancf.Section(EA=EA, EI=1.0, rhoA=1.0), start=(0, 0, 0), end=(30, 0, 0), elements=2
    )
    head = model.add_point_mass("head", at=(1, 0, 0), mass=1.0)
    with pytest.raises(ancf.ModelError, match="point mass, must be a cable"):
        model.add_contact(wire.start, head, stiffness=1.0)
    with pytest.raises(ancf.ModelError, match="cannot touch itself"):
        model.add_contact(wire.start, wire, stiffness=1.0)


def test_unknown_contact_lists_the_right_ones():
    model, _, _, touch = wire_over(0.0)
    state = ancf.equilibrium(model)
    with pytest.raises(ancf.ModelError, match="contact of head and wire"):
        state.contact_force("no such")
    assert state.contact_force(touch.name) == state.contact_force(touch)


def on_an_incline(slope: float, *, speed: float, mass: float, damping: float, elements: int = 2):
    """A head in a plane x = v t, lifted by 100 N against a rigid bar of some slope that it just touches."""
    model = ancf.Model()
    start, end = np.array([0.0, 0.0, 0.0]), np.array([1.0, 0.0, slope])
    rigid = ancf.Section(EA=1e10, EI=1e7, rhoA=1.0)
    bar = model.add_beam("bar", section=rigid, start=start, end=end, elements=elements)
    model.clamp(bar.start)
    model.clamp(bar.end)
    head = model.add_point_mass("head", at=(0.3, 0.0, 0.3 * slope), mass=mass)
    model.hold(head, position="xy", displacement=[f"{speed}*t", 0, 0])
    head.set_motion(velocity=(speed, 0.0, speed * slope))
    model.add_force(head, (0.0, 0.0, 100.0))
    touch = model.add_contact(head, bar, stiffness=50e3, damping=damping)
    return model, head, touch


@pytest.mark.parametrize(
    ("slope", "speed", "mass", "damping"),
    [(0.0, 0.0, 7.2, 80.0), (0.3, 4.0, 7.2, 80.0), (-0.5, 3.0, 20.0, 150.0), (0.5, -2.0, 5.0, 40.0)],
)
def test_damping_acts_on_the_rate_of_the_overlap(slope, speed, mass, damping):
    """m g" + c g' + k g = F for the overlap g, from rest: on any slope and at any speed along it.

    A damper along the strip's normal would feel v times the slope all the time.
    """
    model, head, touch = on_an_incline(slope, speed=speed, mass=mass, damping=damping)
    result = ancf.simulate(model, t_end=0.05, step=1e-4, sensors=[head, touch])
    t, decay = result.t, 0.5 * damping / mass
    omega = np.sqrt(50e3 / mass - decay**2)
    sway = np.cos(omega * t) + decay / omega * np.sin(omega * t)
    overlap = 100.0 / 50e3 * (1.0 - np.exp(-decay * t) * sway)
    rate = 100.0 / (mass * omega) * np.exp(-decay * t) * np.sin(omega * t)
    assert -result.contact_gap(touch) == pytest.approx(overlap, abs=4e-3 * overlap.max())
    force = 50e3 * overlap + damping * rate
    assert result.contact_force(touch)[1:] == pytest.approx(force[1:], abs=5e-3 * force.max())


@pytest.mark.parametrize("output_step", [1e-4, 1e-3])
def test_sensors_know_the_contact_of_their_own_step(output_step):
    """Force, overlap and place of each step are those of the state at its end, not of the step before."""
    model, head, touch = on_an_incline(0.3, speed=4.0, mass=7.2, damping=80.0)
    result = ancf.simulate(model, t_end=0.02, step=1e-4, sensors=[head, touch], output_step=output_step)
    sensors, at = result.sensors, np.searchsorted(result.sensors.t, result.t - 1e-9)
    assert sensors.t[at] == pytest.approx(result.t, abs=1e-12)
    for name in ("contact_force", "contact_gap", "arc_length"):
        found, wanted = (getattr(whole, name)(touch) for whole in (sensors, result))
        assert found[at][1:] == pytest.approx(wanted[1:], rel=1e-9)
        assert np.ptp(wanted) > 0.0
    height = sensors.position(head)
    overlap = height[:, 2] - 0.3 * height[:, 0]  # the bar does not give
    assert -sensors.contact_gap(touch) == pytest.approx(overlap, abs=1e-3 * overlap.max())
