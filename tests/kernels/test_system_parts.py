"""Parts of a System, each against its own definition: loads, supports, norms, scales, fields, samples."""

import numpy as np
import pytest
from scipy.sparse import csc_array
from scipy.spatial.transform import Rotation as Turn

import ancf
from ancf.connections.contact import ContactBatch
from ancf.elements.cable_slack import compression
from ancf.elements.measures import axial_strain
from ancf.elements.shapes import gauss, hermite
from ancf.elements.slopes import mean_strain, slope, vectors_of
from ancf.linalg.sparse import to_sparse
from ancf.model.functions.function import TimeFunction
from ancf.solvers import sampling
from ancf.solvers.statics.free_spin import Spin, is_neutral
from ancf.solvers.statics.pressed import least_stretch
from ancf.system.contacts import touching
from ancf.system.core import apply_load, assemble, restrict
from ancf.system.energy import energies
from ancf.system.joints import FLOOR
from ancf.system.sensors import listing
from ancf.system.supports import Rotation, axes
from ancf.system.system import System
from helpers import SOFT, cable, derivative, forces, matrix, shaken
from mechanisms import joints_of, mechanism


def unshadowed(system, slot):
    """The unknowns of which a slot is the shadow, or the slot."""
    return int(slot) if slot < system.n else system.constraints.rotations[(slot - system.n) // 3].slot


@pytest.mark.parametrize("points", range(1, 7))
def test_gauss_points_integrate_polynomials(points):
    x, w = gauss(points)
    for degree in range(2 * points):
        assert w @ x**degree == pytest.approx(1 / (degree + 1), rel=1e-13)
    assert w @ x ** (2 * points) != pytest.approx(1 / (2 * points + 1), rel=1e-9)


class TestLoads:
    def test_two_loads_at_one_point_add_up(self):
        model, beam = cable(elements=2)
        model.add_force(beam.end, (1.0, 2.0, 3.0))
        model.add_force(beam.end, lambda t: (0.0, 0.0, 10.0 * t))
        system, f = self.load_at(model, 0.4)
        assert f[system.slots["beam"][-1, 0] + np.arange(3)] == pytest.approx([1.0, 2.0, 7.0])

    @staticmethod
    def load_at(model, t):
        system = System(model)
        f = np.empty(system.size)
        apply_load(system.core.loads, system.inputs.tables(t - 0.1, 0.1, 1, 0.0, 1.0).value[0], f)
        return system, f

    @pytest.mark.parametrize("between", [(0.0, 0.9), (0.1, 0.75), (0.35, 0.4), (0.6, 1.0)])
    def test_distributed_load_on_a_part(self, between):
        """Its virtual work is the integral over the part, here with 40 Gauss points."""
        model, beam = cable("curved", elements=3)
        between = tuple(beam.length * x for x in between)
        model.add_distributed_load(beam, (0.5, -1.0, 2.0), between=between)
        system, f = self.load_at(model, 0.4)
        values = np.random.default_rng(1).standard_normal(system.size)
        x, w = np.polynomial.legendre.leggauss(40)
        work, at = 0.0, system.slots["beam"]
        for e in range(3):
            a, b = beam.node_x[e : e + 2]
            low, high = max(a, between[0]), min(b, between[1])
            if high > low:
                there = low + (high - low) * (x + 1) / 2
                nodal = values[at[e : e + 2].ravel()[:, None] + np.arange(3)]
                field = hermite((there - a) / (b - a), b - a) @ nodal
                work += 0.5 * (high - low) * w @ (field @ (0.5, -1.0, 2.0))
        assert f @ values == pytest.approx(work, rel=1e-12)

    def test_weight_does_work(self):
        """Lifting everything by 2 m takes m g 2 m, which is the potential energy."""
        model, beam = cable("curved", model=ancf.Model(gravity=(0, 0, -9.81)))
        model.add_point_mass("mass", at=(0, 0, 0), mass=0.4)
        system = System(model)
        q = shaken(system)
        lifted = q.copy()
        for slots in system.slots.values():
            lifted[slots[:, 0] + 2] += 2.0
        states, still = np.stack([q, lifted]), np.zeros((2, system.size))
        potential = energies(system, states, still)[:, 2]
        assert np.diff(potential) == pytest.approx((SOFT["rhoA"] * beam.length + 0.4) * 9.81 * 2.0)

    @pytest.mark.parametrize("count", [1, 11, 40])
    def test_energies_are_sums_over_all_unknowns(self, count):
        """However many pieces a sum has: against the whole mass matrix and the weight."""
        model = ancf.Model(gravity=(1.0, 2.0, -9.81))
        model.add_beam("rope", start=(0, 0, 0), end=(2, 0, 1), elements=count, section=ancf.Section(**SOFT))
        system = System(model)
        q, v = shaken(system), np.random.default_rng(4).uniform(-1, 1, system.size)
        kinetic, _, potential = energies(system, q[None], v[None])[0]
        assert kinetic == pytest.approx(0.5 * v @ matrix(system, q, mass=1.0) @ v, rel=1e-13)
        assert potential == pytest.approx(-system.core.loads.gravity @ q, rel=1e-13)

    def test_moments_on_cables_and_sections_are_kept_apart(self):
        """Given in turn, each works where it stands: a torque only on the beam with a section."""
        model, a = cable("straight", elements=1, name="a")
        _, b = cable("straight", elements=1, name="b", model=model, element="nonlocking")
        for k, beam in enumerate((b, a, b)):
            model.add_moment(beam.end, lambda t, k=k: (k + 1.0, 10.0 * t, 0.0))
        system = System(model)
        q, v, c = shaken(system, size=0.0), np.zeros(system.size), np.zeros(system.size)
        system.place(0.3, q, v, c)
        wanted = {"a": (2.0, 3.0, 0.0), "b": (1.0 + 3.0, 6.0, 0.0)}
        bare = System(self.without_moments())
        for name, moment in wanted.items():
            r = forces(bare, q) - forces(system, q)
            power, w = 0.0, np.array([0.2, -0.1, 0.3])
            for slot in system.slots[name].ravel():
                power += r[slot : slot + 3] @ np.cross(w, q[slot : slot + 3])
            moment = np.array(moment)
            if name == "a":  # a cable takes no torque
                t = q[system.slots["a"][-1, 1] + np.arange(3)]
                t = t / np.linalg.norm(t)
                moment = moment - t * (t @ moment)
            assert power == pytest.approx(moment @ w, rel=1e-9)

    @staticmethod
    def without_moments():
        model, _ = cable("straight", elements=1, name="a")
        return cable("straight", elements=1, name="b", model=model, element="nonlocking")[0]

    def test_moments_are_those_of_the_step(self):
        """In a block of steps each has its own: a moment that grows turns a body by its integral."""
        model = ancf.Model()
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=1.0, inertia=(1.0, 1.0, 2.0))
        model.add_moment(hub, lambda t: (0.0, 0.0, 6.0 * t))
        result = ancf.simulate(model, t_end=0.2, step=0.01)
        d_1, rate = (x[-1, result.slots["hub"][0, 1] + np.arange(3)] for x in (result.q, result.v))
        spin = np.cross(d_1, rate)[2]
        assert spin == pytest.approx(3.0 * 0.2**2 / 2.0, rel=2e-3)  # integral of 6 t over I = 2


class TestSupports:
    def test_rotation_matrices_are_derivatives(self):
        def angle(t):
            return 0.3 + 1.2 * t - 2.0 * t**2 + 0.7 * t**3

        turn = Rotation(0, axes(np.array([0.3, -1.0, 0.4])), np.array([0.6, 0.0, 0.8]))
        t = np.array([0.4])
        rates = 1.2 - 4.0 * t + 2.1 * t**2, -4.0 + 4.2 * t
        R, dR, ddR = turn.matrices(angle(t), *rates)[0]

        def at(x):
            return turn.matrices(angle(t + x), 0 * t, 0 * t)[0, 0]

        h = 1e-3
        assert pytest.approx(np.eye(3), abs=1e-14) == R @ R.T
        turned = Turn.from_rotvec(angle(t)[0] * turn.axis).as_matrix() @ turn.R0
        assert pytest.approx(turned, abs=1e-14) == R
        first = derivative(lambda x: at(x[0]).ravel(), np.zeros(1), h)[:, 0].reshape(3, 3)
        assert dR == pytest.approx(first, abs=1e-9)
        assert ddR == pytest.approx((at(h) - 2 * at(0.0) + at(-h)) / h**2, abs=1e-4)

    @pytest.mark.parametrize("vector", [(1.0, 0, 0), (0, 0, -2.0), (0.3, -1.0, 0.4), (1.0, 1.0, 1.0)])
    def test_local_axes_are_right_handed(self, vector):
        R = axes(np.array(vector, dtype=float))
        assert pytest.approx(np.eye(3), abs=1e-15) == R.T @ R
        assert np.linalg.det(R) == pytest.approx(1.0)
        assert R[:, 0] * np.linalg.norm(vector) == pytest.approx(vector)

    @pytest.mark.parametrize("held", ["x", "yz", "xz", "xyz"])
    def test_held_components_move_as_given(self, held):
        model = ancf.Model()
        mass = model.add_point_mass("mass", at=(1.0, 2.0, 3.0), mass=1.0)
        model.hold(mass, position=held, displacement=lambda t: (t, 10 * t, 100 * t))
        system = System(model)
        q, _ = system.initial_state(0.5)
        moved = q[system.slots["mass"][0, 0] + np.arange(3)] - (1.0, 2.0, 3.0)
        assert moved == pytest.approx(
            [d if c in held else 0.0 for c, d in zip("xyz", (0.5, 5, 50), strict=True)]
        )

    def test_shadows_follow_with_their_derivatives(self):
        """r_x = R y along axes that turn while y changes: its rates by differences of four parts in h^4."""
        model, beam = cable("curved", elements=1)
        model.clamp(beam.start, rotation="0.7*t + 0.4*t**2 - 0.2*t**3", axis=(1, 2, 0.5))
        system = System(model)
        (slot,), (shadow,) = system.core.supports.rot_slot, system.core.supports.rot_shadow
        y, rate, half = np.array([1.1, 0.2, -0.3]), np.array([0.5, -1.0, 2.0]), np.array([0.7, 0.4, -0.6])

        def at(t):
            q, v, a = (np.zeros(system.size) for _ in range(3))
            x = t - 0.9
            q[slot : slot + 3] = y + rate * x + half * x**2
            v[slot : slot + 3], a[slot : slot + 3] = rate + 2 * half * x, 2 * half
            system.place(t, q, v, a)
            return [part[shadow : shadow + 3] for part in (q, v, a)]

        h = 2e-3
        r = [at(0.9 + k * h)[0] for k in range(-2, 3)]
        _, v, a = at(0.9)
        # the rates of the angle are differences themselves
        assert v == pytest.approx((r[0] - 8 * r[1] + 8 * r[3] - r[4]) / (12 * h), abs=1e-8)
        assert a == pytest.approx((-r[0] + 16 * r[1] - 30 * r[2] + 16 * r[3] - r[4]) / (12 * h * h), abs=1e-6)

    def test_clamp_of_a_rigid_body_holds_all(self):
        model = ancf.Model()
        hub = model.add_rigid_body("hub", at=(1, 2, 3), mass=1.0, inertia=(1, 2, 2.5))
        model.clamp(hub)
        system = System(model)
        assert len(system.free) == 0
        assert set(system.slots["hub"].ravel()) <= set(system.core.supports.held)


def cables_of(count):
    model = ancf.Model(gravity=(0, 0, -9.81))
    for k in range(count):
        wire = model.add_beam(
            f"wire{k}", start=(0, k, 0), end=(1, k, 0), elements=2, section=ancf.Section(**SOFT)
        )
        model.pin(wire.start)
        mass = model.add_point_mass(f"mass{k}", at=(0.4, k, 0), mass=0.1)
        model.slide(mass, along=wire, s=0.4)
    return System(model)


def solid(element):
    model = ancf.Model()
    square = ancf.Section.rectangle(width=0.1, height=0.1, E=1e6, rho=1000.0)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=3, element=element, section=square)
    model.clamp(beam.start)
    model.connect(beam.end, model.add_point_mass("mass", at=(1, 0, 0), mass=1.0))
    return System(model)


class TestHeld:
    @pytest.mark.parametrize(
        "make",
        [
            lambda: mechanism(),
            lambda: mechanism(stretch="free"),
            *(lambda count=count: cables_of(count) for count in (1, 3)),
            *(lambda element=element: solid(element) for element in ("original", "nonlocking")),
        ],
    )
    def test_rows_of_held_unknowns_are_those_of_the_identity(self, make):
        """Also those of unknowns that no node has, which nothing is added to."""
        system = make()
        core, q = system.core, shaken(system)
        assert not np.all(system.numbering.used())
        core.A[:] = 7.0  # of another matrix
        assemble(core.batches, core.ws, q, np.zeros_like(q), core.A, 1.0, 1.0, 1.0)
        restrict(core.supports, core.A)
        A, held = to_sparse(core.A, system.places).toarray(), system.held
        np.testing.assert_array_equal(A[held], np.eye(system.n)[held])
        np.testing.assert_array_equal(A[:, held], np.eye(system.n)[:, held])


class TestNumbers:
    def test_norm_measures_positions_in_sizes_of_the_model(self):
        model, beam = cable("straight", elements=2, element="nonlocking")
        system = System(model)
        slots, weight = system.numbering.slots["beam"], system.core.weight
        h = np.diff(beam.node_x)
        assert weight[slots[:, 0]] == pytest.approx(1 / model.size)
        assert weight[slots[:, 1:4]] == pytest.approx(1.0)
        assert weight[slots[:-1, 4:] + 2] == pytest.approx(np.stack([h, h], axis=1))

    def test_blocks_hold_two_vectors(self):
        """Six unknowns each: none is wasted on a cable, three are on a point mass."""
        model, _ = cable("straight", elements=4)
        assert System(model).n == 6 * 5
        model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
        assert System(model).n == 6 * 6

    def test_directors_are_the_columns_of_the_axes(self):
        """A point of a turned body lies where scipy's rotation puts it."""
        turn = Turn.from_rotvec([0.4, -0.9, 0.3])
        model = ancf.Model()
        given = {"mass": 1.0, "inertia": (1, 2, 2.5), "axes": turn.as_matrix()}
        hub = model.add_rigid_body("hub", at=(1, 2, 3), **given)
        system = System(model)
        state = ancf.State(system, 0.0, *system.initial_state())
        corner = np.array([0.3, -0.2, 0.5])
        assert state.position(hub.at(*corner)) == pytest.approx(np.array([1, 2, 3]) + turn.apply(corner))

    def test_last_node_has_no_internal_vectors(self):
        """They belong to elements and stand at the node where theirs begins; unused unknowns are held."""
        system = System(cable("straight", elements=2, element="nonlocking")[0])
        slots = system.numbering.slots["beam"][:, :, None] + np.arange(3)
        used = system.numbering.used()
        assert used[slots[:-1]].all()
        assert used[slots[-1, :4]].all()
        assert not used[slots[-1, 4:]].any()
        assert set(slots[-1, 4:].ravel()) <= set(system.core.supports.held.tolist())

    def test_scales_are_stiffness_and_mass_of_what_a_row_holds(self):
        """The largest factor^2 times diagonal entry, at least a share of the joint's largest of its kind.

        Of a row that holds a place, in m, entries of places count: those of directions are in kg m^2.
        """
        system = mechanism()
        rows, _ = joints_of(system)
        q, _ = system.initial_state()
        system.level[:] = 0.0
        rows.scale[:, :], kept = 0.0, rows.scale.copy()
        M, K = (np.abs(np.diag(matrix(system, q, **{part: 1.0}))) for part in ("mass", "stiffness"))
        places = {int(slot) for slots in system.numbering.slots.values() for slot in slots[:, 0]}
        for k, diagonal in enumerate((M, K)):
            for name, unknowns in system.numbering.multipliers.items():
                mine = np.flatnonzero(np.isin(rows.unknown, unknowns))
                if not len(mine):
                    continue
                found = {True: {}, False: {}}
                for n in mine:
                    entries = range(rows.start[n], rows.start[n + 1])
                    slots = [(unshadowed(system, rows.slot[e]), rows.factor[e]) for e in entries]
                    in_m = [(s, f) for s, f in slots if s in places]
                    found[bool(in_m)][n] = max(f**2 * diagonal[s : s + 3].max() for s, f in in_m or slots)
                for own in found.values():
                    most = max(own.values(), default=0.0)
                    if most > 0.0:
                        wanted = [max(x, FLOOR * most) for x in own.values()]
                        assert kept[list(own), k] == pytest.approx(wanted, rel=1e-12), name

    def test_no_multiplier_stands_before_the_lowest(self):
        system = mechanism()
        assert system.core.joints.lowest == min(system.multipliers) // 6

    def test_times_are_counted_from_the_start_of_the_run(self):
        """However the steps are grouped, their times are the same to the last bit."""
        model = ancf.Model()
        mass = model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
        model.add_force(mass, lambda t: (t, 0.0, 0.0))
        inputs, h = System(model).inputs, 0.1
        together = inputs.tables(0.3, h, 60, 0.3, 9.0).value[:, 0, 0]
        t, alone = 0.3, []
        for n in range(60):
            alone.append(inputs.tables(0.3 + n * h, h, 1, 0.3, 9.0).value[0, 0, 0])
            t += h
        assert together.tolist() == alone == [0.3 + h * (n + 1) for n in range(60)]


class TestFields:
    def test_strain_is_the_best_straight_line(self):
        """Over each element, in the mean of squares: numpy's fit through 60 Gauss points."""
        system = System(cable("straight", elements=2, strain="paper")[0])
        beam, q = system.model.bodies["beam"], shaken(system)
        state = ancf.State(system, 0.0, q, np.zeros_like(q))
        x, w = np.polynomial.legendre.leggauss(60)
        for e in range(2):
            a, h = beam.node_x[e], beam.node_x[e + 1] - beam.node_x[e]
            nodal = q[system.slots["beam"][e : e + 2].ravel()[:, None] + np.arange(3)]
            exact = axial_strain(hermite((x + 1) / 2, h, 1) @ nodal, "paper")
            line = np.polynomial.Polynomial.fit((x + 1) / 2, exact, 1, w=np.sqrt(w), domain=[0, 1])
            for xi in (0.05, 0.3, 0.9):
                assert state.strain(beam.at(a + xi * h)) == pytest.approx(line(xi), rel=1e-10)

    @pytest.mark.parametrize("seed", range(3))
    def test_tangents_within_elements(self, seed):
        """Those of the cubic polynomial, component by component, and strains that are means over it."""
        system = System(cable("straight", elements=3)[0])
        beam, q = system.model.bodies["beam"], shaken(system, seed=seed)
        vectors = vectors_of(beam.node_x, system.slots["beam"], q[None])
        x, w = np.polynomial.legendre.leggauss(5)
        for e, h in enumerate(np.diff(beam.node_x)):
            nodal = q[system.slots["beam"][e : e + 2].ravel()[:, None] + np.arange(3)]
            for xi in (0.0, 0.2, 0.5, 1.0):
                wanted = hermite(np.array([xi]), h, 1)[0] @ nodal
                assert [slope(part, xi)[0, e] for part in vectors] == pytest.approx(wanted, rel=1e-10)
            for strain in ("paper", "material"):
                mean = 0.5 * w @ axial_strain(hermite((x + 1) / 2, h, 1) @ nodal, strain)
                assert mean_strain(vectors, strain)[0, e] == pytest.approx(mean, rel=1e-10)

    @pytest.mark.parametrize("stretch", [0.4, 0.95, 1.0, 1.7])
    def test_least_stretch_of_cables(self, stretch):
        """Of a straight one that is shrunk or stretched evenly; the least of several counts."""
        system = System(cable("straight", elements=3)[0])
        q, _ = system.initial_state()
        assert least_stretch(system, q) == pytest.approx(1.0)
        assert least_stretch(system, stretch * q) == pytest.approx(stretch, rel=1e-12)

    @pytest.mark.parametrize("strain", ["paper", "material"])
    def test_compression_of_chords(self, strain):
        """Elements whose chord is shorter than they are, in their own strain measure; none if longer."""
        system = System(cable("straight", elements=3, strain=strain)[0])
        beam, q = system.model.bodies["beam"], shaken(system, size=0.0)
        slots = system.slots["beam"][:, 0]
        direction = beam.node_tangent[0]
        h = np.diff(beam.node_x)
        for k, x in enumerate(np.cumsum([0.0, 0.9 * h[0], 1.1 * h[1], 0.7 * h[2]])):
            q[slots[k] : slots[k] + 3] = x * direction
        batch = system.core.batches[0]
        found = compression(batch, q).reshape(20, -1)[:5, :3]
        for e, s in enumerate((0.9, 1.0, 0.7)):
            wanted = axial_strain(np.array([s, 0.0, 0.0]), strain)
            assert found[:, e] == pytest.approx(np.full(5, wanted), abs=1e-12)

    def test_fields_of_joints(self):
        """Three multipliers of a sliding joint, and its arc length behind them."""
        system = mechanism()
        q = np.arange(float(system.size))
        state = ancf.State(system, 0.0, q, 2.0 * q)
        unknowns = system.joints["on wire"]
        assert len(unknowns) == 4
        assert state.multiplier("on wire") == pytest.approx(q[unknowns[:3]])
        assert state.arc_length("on wire") == q[unknowns[3]] == q[system.numbering.arcs["on wire"]]
        assert state.arc_rate("on wire") == 2.0 * q[unknowns[3]]
        assert len(state.multiplier("hinge")) == 5


def two_contacts():
    """Two heads press on one wire, by different overlaps."""
    model = ancf.Model()
    section = ancf.Section(EA=300.0, EI=1.0, rhoA=0.7)
    wire = model.add_beam("wire", start=(0, 0, 1), end=(2, 0.2, 1), elements=2, section=section)
    for k, (x, lift) in enumerate(((0.5, 0.02), (1.5, 0.05))):
        head = model.add_point_mass(f"head {k}", at=(x, 0.1 * k, 1 + lift), mass=1.0)
        model.add_contact(head, wire, stiffness=100.0 * (k + 1), name=f"touch {k}")
    return System(model)


class TestContacts:
    def test_stiffness_of_what_touches(self):
        """k_j b_j b_j^T is the gradient of the forces, up to what the place of contact moves."""
        system = two_contacts()
        q, _ = system.initial_state()
        found = touching(system.core, q, system.n)
        assert isinstance(found.matrix(), csc_array)
        assert found.stiffness.tolist() == [100.0, 200.0]
        bare = matrix(system, q, stiffness=1.0)  # contacts add nothing to it
        gradient = derivative(lambda x: forces(system, x), q, step=1e-4)
        heights = [int(s[0, 0]) + 2 for name, s in system.slots.items() if name != "wire"]
        got = (bare + found.matrix().toarray())[np.ix_(heights, heights)]
        assert got == pytest.approx(gradient[np.ix_(heights, heights)], rel=1e-6, abs=1e-8)

    def test_stiffness_on_what_is_held(self):
        """What a support holds has no row in the matrix: the wire alone is pushed."""
        model = two_contacts().model
        model.pin("head 1")
        system = System(model)
        found = touching(system.core, system.initial_state()[0], system.n)
        heads = [system.slots[f"head {k}"][0, 0] + np.arange(3) for k in range(2)]
        assert np.any(found.rows[:, heads[0]])
        assert not np.any(found.rows[:, heads[1]])
        assert found.stiffness.tolist() == [100.0, 200.0]

    def test_a_question_moves_nothing(self):
        """A run goes on from the place of contact that it found, whatever is asked of a state."""
        system = two_contacts()
        q, v = system.initial_state()
        (batch,) = (b for b in system.core.batches if isinstance(b, ContactBatch))
        before = batch.found.copy()
        q[system.slots["head 0"][0, 0]] += 0.8
        state = ancf.State(system, 0.0, q, v)
        assert state.contact_gap("touch 0") == pytest.approx(-0.02)
        assert state.contact_gap("touch 1") == pytest.approx(-0.05)
        assert state.arc_length("touch 0") == pytest.approx(1.3 * np.hypot(2.0, 0.2) / 2.0, rel=1e-3)
        assert batch.found == pytest.approx(before, abs=0.0)

    def test_samples_of_the_second_of_two_contacts(self):
        system = two_contacts()
        q, v = system.initial_state()
        system.sensors = listing(system, [system.model.sensor("touch 1")], True)
        row = np.empty(4)
        sampling.sample(sampling.sampling_of(system), q, v, row)
        assert row[:2] == pytest.approx([200.0 * 0.05, 0.05])


@pytest.mark.parametrize("what", ["section", "spring", "contact", "slide", "nothing"])
def test_what_counts_as_damped(what):
    """A run accounts for losses where something dissipates, whatever it is."""
    model = ancf.Model()
    losses = {"damping": 0.1} if what == "section" else {}
    section = ancf.Section(EA=300.0, EI=1.0, rhoA=0.7, **losses)
    wire = model.add_beam("wire", start=(0, 0, 1), end=(2, 0, 1), elements=2, section=section)
    heads = [model.add_point_mass(f"head {k}", at=(0.5 + k, 0, 1), mass=1.0) for k in range(2)]
    model.add_spring(heads[0], (0.5, 0, 0), stiffness=10.0, damping=0.2 if what == "spring" else 0.0)
    model.add_contact(heads[0], wire, stiffness=100.0, damping=0.3 if what == "contact" else 0.0)
    model.slide(heads[1], along=wire, viscous=0.4 if what == "slide" else 0.0)
    assert System(model).core.damped == (what != "nothing")


@pytest.mark.parametrize("rate", [-50.0, -0.5, 0.5, 50.0])
@pytest.mark.parametrize("extension", [-0.1, 0.1])
def test_slack_spring_in_results_and_in_motion(extension, rate):
    """max(k (l - l0) + c dl/dt, 0) where it is longer than l0: in the results, and on the mass."""
    model = ancf.Model()
    mass = model.add_point_mass("mass", at=(0, 0, 1.0 + extension), mass=1.0)
    given = {"stiffness": 30.0, "damping": 2.0, "length": 1.0, "slack": True}
    spring = model.add_spring(mass, (0, 0, 0), **given)
    mass.set_motion(velocity=(0, 0, rate))
    system = System(model)
    q, v = system.initial_state()
    wanted = max(30.0 * extension + 2.0 * rate, 0.0) if extension > 0.0 else 0.0
    assert ancf.State(system, 0.0, q, v).spring_force(spring) == pytest.approx(wanted)
    assert forces(system, q, v=v)[system.slots["mass"][0, 0] + 2] == pytest.approx(wanted)


class TestSpin:
    """A common rotation of the sections about their normals."""

    def test_a_spin_has_the_stiffness_of_its_torsion(self):
        """Of unit angle: G J/L times the square of the mean angle of r_y and r_z, on every node."""
        model, beam = cable("curved", elements=2, element="nonlocking")
        system = System(model)
        q = shaken(system, size=0.0)
        spin = Spin(system, np.zeros(0, dtype=np.int64))
        x = np.zeros(system.n)
        for node in range(3):
            y, z = (q[system.slots["beam"][node, k] + np.arange(3)] for k in (2, 3))
            t = np.cross(y, z) / np.linalg.norm(np.cross(y, z))
            for k, vector in ((2, y), (3, z)):
                x[system.slots["beam"][node, k] + np.arange(3)] = np.cross(t, vector)
        A = np.zeros(system.places.size)
        spin.add(A, q)
        section = beam.section
        energy = x @ (to_sparse(A, system.places) @ x)
        assert energy == pytest.approx(section.G * section.J / beam.length, rel=1e-12)

    def test_only_round_off_is_neutral(self):
        K = csc_array(np.array([[1.0, -1.0], [-1.0, 1.0]]))
        assert is_neutral(K, np.array([1.0, 1.0]))
        assert is_neutral(K, np.array([1.0, 1.0 + 1e-8]))
        assert not is_neutral(K, np.array([1.0, 0.9]))
        assert not is_neutral(csc_array(-np.eye(2)), np.array([1.0, 0.0]))


def test_a_time_function_is_asked_once_for_each_time():
    """A table of many times is that of each time alone."""
    function = TimeFunction(["sin(t)", 2.0, "t**2"], 3, "here")
    times = np.array([0.3, 0.1, 2.0])
    assert function.table(times) == pytest.approx(np.stack([function(t) for t in times]))
