"""More parts of a System: states of another one, events of sliding joints, consistent starts, bad joints."""

import numpy as np
import pytest

import ancf
from ancf.connections.sliding import FREE, FROZEN, LEFT, PULLS, TOUCHES
from ancf.elements.measures import axial_strain, curvature
from ancf.errors import SolveError
from ancf.results.read_store import Rows
from ancf.solvers.events import happen
from ancf.solvers.start import consistent_start
from ancf.system.consistency import open_contacts
from ancf.system.core import first_event, inertia
from ancf.system.probe import R_X, R_XX
from ancf.system.redundancy import spare_multipliers
from ancf.system.sensors import Listing
from ancf.system.system import System
from helpers import cable, forces, rotation
from mechanisms import joints_of, mechanism, moving


def test_a_state_is_adopted_as_it_is():
    """With local axes that turn: unknowns are components along axes of the time of the state."""

    def made():
        model, beam = cable("curved", elements=2)
        model.clamp(beam.start, rotation="0.7*t", axis=(1, 2, 0.5))
        return System(model)

    one, other, t = made(), made(), 0.9
    rng = np.random.default_rng(2)
    q, v = one.initial_state(t)
    a = np.zeros_like(q)
    q[one.free] += 0.1 * rng.standard_normal(len(one.free))
    v[one.free] += rng.standard_normal(len(one.free))
    one.place(t, q, v, a)
    new_q, new_v = other.adopt(one.slots, one.joints, q, v, t)
    assert new_q == pytest.approx(q, abs=1e-14)
    assert new_v == pytest.approx(v, abs=1e-13)


@pytest.mark.parametrize("strain", ["paper", "material"])
def test_damped_forces_of_a_cable(strain):
    """N and M in motion: the rates of strain and curvature by differences of states a little apart."""
    section = {"EA": 40.0, "EI": 2.0, "rhoA": 0.7, "axial_damping": 0.5, "bending_damping": 0.2}
    model, beam = cable("straight", elements=2, strain=strain, section=ancf.Section(**section))
    system = System(model)
    rng = np.random.default_rng(3)
    q, v = system.initial_state()
    used = system.numbering.used()
    q[used] += 0.1 * rng.uniform(-1, 1, int(used.sum()))
    v[used] += rng.uniform(-1, 1, int(used.sum()))
    point, h = beam.at(0.3 * beam.length), 1e-6
    probe = system.probe(point)

    def at(x):
        r_x, r_xx = probe.field(x, R_X), probe.field(x, R_XX)
        return float(axial_strain(r_x, strain)), float(curvature(r_x, r_xx, strain))

    rates = [(a - b) / (2 * h) for a, b in zip(at(q + h * v), at(q - h * v), strict=True)]
    rest, moved = (ancf.State(system, 0.0, q, x) for x in (np.zeros_like(v), v))
    stretch = np.linalg.norm(probe.field(q, R_X)) if strain == "paper" else 1.0
    tension = moved.tension(point) - rest.tension(point)
    assert tension == pytest.approx(0.5 * rates[0] * stretch, rel=1e-6)
    moment = moved.bending_moment(point) - rest.bending_moment(point)
    assert moment == pytest.approx(0.2 * rates[1], rel=1e-4)
    assert rest.bending_moment(point) == pytest.approx(2.0 * at(q)[1])


def test_places_of_what_is_recorded():
    listing = Listing(index=np.array([2, 5, 9]))
    assert listing.places(np.array([5, 2, 3, 9, 0, 20])).tolist() == [1, 0, -1, 2, -1, -1]
    assert Listing().places(np.array([1, 2])).tolist() == [-1, -1]


def test_rows_of_a_file_that_grows():
    """Only those that were there when it was opened, counted from either end."""
    data = np.arange(20.0).reshape(10, 2)
    rows = Rows(data, 6)
    assert rows.shape == (6, 2)
    assert rows[-1].tolist() == data[5].tolist()
    assert rows[2:].tolist() == data[2:6].tolist()
    assert rows[..., 1].tolist() == data[:6, 1].tolist()
    assert rows[-2:, 0].tolist() == data[4:6, 0].tolist()


def test_inertia_of_a_body_without_symmetry():
    """A director alone that accelerates pulls at all three, by the second moments tr(I)/2 1 - I."""
    model = ancf.Model()
    I = np.array([[0.5, 0.1, -0.05], [0.1, 0.6, 0.02], [-0.05, 0.02, 0.7]])  # noqa: E741
    model.add_rigid_body("body", at=(1, 2, 3), mass=2.0, inertia=I, axes=rotation((1, -2, 0.5), 0.8))
    system = System(model)
    J = 0.5 * np.trace(I) * np.eye(3) - I
    slots = system.slots["body"][0]
    a = np.zeros(system.size)
    a[slots[1]] = 1.0  # d_1 alone: the forces on all directors are column 1 of J
    r = np.empty_like(a)
    inertia(system.core.batches, system.core.ws, a, r)
    assert r[slots[1:4]] == pytest.approx(J[:, 0], abs=1e-15)


def test_equilibrium_of_a_head_under_a_wire():
    """Head spring and contact carry the same force; a string of T and L takes T/x + T/(L - x) per metre."""
    T, L, x = 2e4, 30.0, 12.0
    model = ancf.Model()
    section = ancf.Section(EA=15e6, EI=0.0, rhoA=1.35)
    wire = model.add_beam(
        "wire", section=section, start=(0, 0, 0), end=(L, 0, 0), elements=10, length=L / (1 + T / 15e6)
    )
    model.pin(wire.start)
    model.pin(wire.end)
    head = model.add_point_mass("head", at=(x, 0, 0.02), mass=7.2)
    model.hold(head, position="xy")
    model.add_spring(head, (x, 0, -0.98), stiffness=4200.0, length=1.0, name="pan")
    model.add_contact(head, wire, stiffness=5e4, name="touch")
    state = ancf.equilibrium(model)
    force = 0.02 / (1 / 4200.0 + 1 / 5e4 + 1 / (T / x + T / (L - x)))
    assert state.contact_force("touch") == pytest.approx(force, rel=0.03)  # elements of 3 m do not kink
    assert state.contact_force("touch") == pytest.approx(-state.spring_force("pan"), rel=1e-9)


def test_start_is_made_consistent():
    """From positions and velocities a little off: C = 0, dC/dt = 0, and M a + C_q^T lambda = f."""
    system = mechanism()
    q, v, a = moving(system)
    rng = np.random.default_rng(5)
    q, _ = system.initial_state()
    used = system.free
    q[used] += 1e-3 * rng.uniform(-1, 1, len(used))
    v = 0.1 * v
    v[system.core.supports.held] = 0.0
    tables = system.inputs.tables(-1e-3, 1e-3, 1, 0.0, 1.0)
    a = consistent_start(system, q, v, tables)
    for level, x in (((1.0, 0, 0), None), ((0, 1.0, 0), v)):
        system.level[:] = level
        rows = forces(system, q, v=x)[system.multipliers]
        # index 3 needs several sweeps from afar: what is left is of second order in the shift
        assert np.max(np.abs(rows)) < 1e-8
    system.level[:] = 0.0, 0.0, 1.0
    assert np.max(np.abs(forces(system, q, v, a)[system.multipliers])) < 1e-6
    free = np.setdiff1d(system.free, system.multipliers)
    r = forces(system, q, v, a) - system.core.loads.gravity
    assert np.max(np.abs(r[free])) < 1e-6 * np.max(np.abs(system.core.loads.gravity))


class TestEvents:
    """What a code of :func:`first_event` does to the joint that it names, the second of two."""

    @staticmethod
    def two(**given):
        model = ancf.Model()
        bar = model.add_rigid_body("bar", at=(0, 0, 0), mass=1.0, inertia=(0.1, 1, 1))
        for k in range(2):
            bead = model.add_point_mass(f"bead {k}", at=(0.2 * k, 0, 0), mass=1.0)
            model.slide(bead, along=bar, line=((-1, 0, 0), (1, 0, 0)), name=f"slide {k}", **given)
        system = System(model)
        batch = system.core.joints.tail[0]
        return system, batch, *system.initial_state()

    def test_opens_and_closes(self):
        system, batch, q, v = self.two(unilateral=(0, 0, 1))
        happen(system, q, v, 4 + PULLS, "now")
        assert batch.open.tolist() == [0, 1]
        happen(system, q, v, 4 + TOUCHES, "now")
        assert batch.open.tolist() == [0, 0]

    def test_a_contact_that_pulls(self):
        system, _, q, _ = self.two(unilateral=(0, 0, 1))
        lam = system.joints["slide 1"][:3]
        q[lam] = 0.3, 0.1, 1.0
        assert first_event(system.core.joints.tail, q) == -1
        q[lam[2]] = -1e-6
        assert first_event(system.core.joints.tail, q) == 4 + PULLS

    def test_contacts_that_are_apart_are_open(self):
        system, batch, q, _ = self.two(unilateral=(0, 0, 1))
        q[system.slots["bead 1"][0, 0] + 2] = -0.1  # below the bar, which it pushes up
        open_contacts(system, q)
        assert batch.open.tolist() == [0, 1]

    @pytest.mark.parametrize(("at_end", "mode"), [("clamp", FROZEN), ("release", FREE)])
    @pytest.mark.parametrize(("s", "end"), [(2.3, 2.0), (-0.2, 0.0)])
    def test_end_of_the_carrier(self, at_end, mode, s, end):
        system, batch, q, v = self.two(at_end=at_end)
        arc = system.numbering.arcs["slide 1"]
        q[arc], v[arc] = s, 3.0
        assert first_event(system.core.joints.tail, q) == 4 + LEFT
        happen(system, q, v, 4 + LEFT, "now")
        assert (q[arc], v[arc]) == (end, 0.0)
        assert batch.mode.tolist() == [0, mode]

    def test_stop(self):
        system, _, q, v = self.two()
        q[system.numbering.arcs["slide 1"]] = 2.3
        with pytest.raises(SolveError, match="has reached the end of bar") as caught:
            happen(system, q, v, 4 + LEFT, "t = 1 s")
        assert caught.value.where == "t = 1 s, slide 1"


@pytest.mark.parametrize("apart", [0.0, 0.1])
def test_joints_that_contradict_each_other(apart):
    """Two balls fix a distance that a rigid body has already; with another distance they cannot hold."""
    model = ancf.Model()
    body = model.add_rigid_body("body", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
    model.connect(body.at(0.5, 0, 0), (0.5, 0, 0), name="one")
    model.connect(body.at(-0.5, 0, 0), (-0.5, 0, 0), name="two")
    next(c for c in model.connections if c.name == "two").b[0] += apart
    system = System(model)
    if not apart:
        assert set(spare_multipliers(system)) < set(system.joints["two"])
        return
    with pytest.raises(ancf.ModelError, match="contradict each other") as caught:
        spare_multipliers(system)
    assert '"one" and "two"' in caught.value.what


def test_rows_of_a_mechanism_are_independent():
    system = mechanism()
    assert len(spare_multipliers(system)) == 0
    assert len(joints_of(system)) == 2
