"""Parts of a step: predictor, elimination of the patches, turning frames, what is left, rates of motions."""

from types import SimpleNamespace
from typing import NamedTuple

import numpy as np
import pytest

import ancf
from ancf.compiled import kernel
from ancf.elements.shapes import gauss
from ancf.elements.solid import SolidBatch
from ancf.elements.solid_shapes import shape
from ancf.elements.solid_strains import quadratic_part
from ancf.linalg.border import room_for_border
from ancf.simd import LANES
from ancf.solvers.account import Account
from ancf.solvers.newmark import worst_unknown
from ancf.solvers.status import FAR
from ancf.solvers.step import corotation as turning
from ancf.solvers.step.carry import carry
from ancf.solvers.step.checks import check_way
from ancf.solvers.step.corotation import turn_rows
from ancf.solvers.step.corrections import largest, shift, update
from ancf.solvers.step.low_rank import eliminate
from ancf.solvers.step.memory import FIRST_LIMIT, H_FACTOR, H_PREV, LIMIT, WORST, aligned, allocate
from ancf.solvers.step.renewal import count, renewed
from ancf.solvers.step.scheme import Scheme, finish, predict_rows, restore
from ancf.system.core import inertia
from ancf.system.inputs import differences
from ancf.system.system import System
from helpers import SOLIDS, cable, random_rate, rotation, shaken
from turned_frames import back, forth, turned

RNG = np.random.default_rng(3)
TRAPEZOIDAL = Scheme(0.25, 0.5, 0.0, 0.0)


#: Trapezoidal rule, generalised-alpha method, HHT: all of second order.
SCHEMES = {
    "trapezoidal": TRAPEZOIDAL,
    "alpha": Scheme(0.4, 0.8, 0.2, 0.5),
    "hht": Scheme(0.36, 0.7, 0.0, 0.2),
}


@kernel
def predicted(memory, h, scheme, keep, first, last):
    predict_rows(memory, h, scheme, keep, first, last)


@kernel
def restored(memory):
    restore(memory)


@kernel
def finished(memory, h, scheme):
    finish(memory, h, scheme)


def with_past(history, n=1, h=0.1, scheme=TRAPEZOIDAL):
    """Memory after steps that ended with these accelerations of the first unknown, the oldest first.

    The other unknowns have multiples of them.
    """
    memory = allocate(n, turning.allocate([], np.zeros(0, dtype=np.int64)), ())
    memory.a[:] = memory.abar[:] = history[0] * np.arange(1, n + 1)
    for acceleration in history[1:]:
        predicted(memory, h, scheme, 1.0, 0, n)
        memory.a[:] = acceleration * np.arange(1, n + 1)
        finished(memory, h, scheme)
    return memory


def guess(history, h=0.1, keep=1.0):
    """Predicted acceleration, position and velocity after steps that ended with these accelerations."""
    memory = with_past(history, h=h)
    memory.q[:], memory.v[:] = 0.0, 0.0
    predicted(memory, h, TRAPEZOIDAL, keep, 0, 1)
    return float(memory.a[0]), float(memory.q[0]), float(memory.v[0])


class TestPredictor:
    def test_quadratic_accelerations_are_continued(self):
        t = np.arange(7) * 0.1
        a = 2.0 - 3.0 * t + 7.0 * t**2
        for known in (4, 5, 6):
            assert guess(a[:known])[0] == pytest.approx(a[known], rel=1e-12)

    @pytest.mark.parametrize("known", [2, 3, 4, 7])
    def test_what_changes_sign_in_every_step_goes_on_so(self, known):
        a = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0, 1.0])[:known]
        assert guess(a)[0] == pytest.approx(-a[-1])

    def test_another_step_size_forgets(self):
        """The values are those of the times of the old steps."""
        memory = with_past([2.0, -3.0, 5.0, 1.0])
        predicted(memory, 0.05, TRAPEZOIDAL, 1.0, 0, 1)
        assert memory.a[0] == 1.0

    @pytest.mark.parametrize("scheme", SCHEMES.values(), ids=SCHEMES)
    @pytest.mark.parametrize("n", [1, 13])
    def test_attempts_that_fail_leave_what_is_remembered(self, n, scheme):
        """Of any length, and however many: halves that follow them would begin with something else."""
        memory, other = (with_past([2.0, -3.0, 5.0, 1.0], n, scheme=scheme) for _ in range(2))
        for h in (0.1, 0.2, 0.05):
            for keep in (1.0, 0.0):
                predicted(memory, h, scheme, keep, 0, n)
                restored(memory)
        for some in (memory, other):
            predicted(some, 0.1, scheme, 1.0, 0, n)
        for name in ("q", "v", "a", "q0", "v0", "a0", "a1", "a2"):
            np.testing.assert_array_equal(getattr(memory, name), getattr(other, name), err_msg=name)

    @pytest.mark.parametrize("scheme", SCHEMES.values(), ids=SCHEMES)
    @pytest.mark.parametrize("n", [1, 8, 13, 21])
    def test_all_unknowns_alike(self, n, scheme):
        """Those by eights, those left over, and parts of them."""
        memory, alone = (with_past([2.0, -3.0, 5.0, 1.0], size, scheme=scheme) for size in (n, 1))
        for some in (memory, alone):
            size = np.arange(1, len(some.q) + 1)
            some.q[:], some.v[:] = 0.3 * size, -0.7 * size
        for part in ((0, n // 3), (n // 3, n)):
            predicted(memory, 0.1, scheme, 1.0, *part)
        predicted(alone, 0.1, scheme, 1.0, 0, 1)
        for name in ("q", "v", "a", "q0", "v0", "a0", "a1", "a2", "a3"):
            found, wanted = getattr(memory, name), getattr(alone, name)[0] * np.arange(1, n + 1)
            np.testing.assert_allclose(found, wanted, rtol=1e-13, err_msg=name)

    def test_cautious_guess_is_no_acceleration(self):
        a, q, v = guess([3.0, 3.0, 3.0, 3.0], keep=0.0)
        assert (a, q, v) == pytest.approx((0.0, 0.01 * 0.25 * 3.0, 0.1 * 0.5 * 3.0))

    def test_positions_and_velocities_follow_the_rule(self):
        _, q, v = guess([2.0, 2.0, 2.0, 2.0])
        assert (q, v) == pytest.approx((0.5 * 0.01 * 2.0, 0.1 * 2.0))

    @pytest.mark.parametrize("scheme", [SCHEMES["alpha"], SCHEMES["hht"]], ids=["alpha", "hht"])
    def test_the_algorithmic_acceleration(self, scheme):
        """(1 - alpha_m) abar_n+1 + alpha_m abar_n = (1 - alpha_f) a_n+1 + alpha_f a_n."""
        memory = with_past([2.0, -3.0], scheme=scheme)
        before, a = memory.abar[0], memory.a[0]
        predicted(memory, 0.1, scheme, 1.0, 0, 1)
        memory.a[:] = 5.0
        finished(memory, 0.1, scheme)
        known = (1 - scheme.alpha_f) * 5.0 + scheme.alpha_f * a - scheme.alpha_m * before
        assert memory.abar[0] * (1 - scheme.alpha_m) == pytest.approx(known)


@pytest.mark.parametrize("n", [1, 2, 5, 9])
def test_elimination_pivots(n):
    A = RNG.standard_normal((n, n))
    A[0, 0] = 0.0 if n > 1 else 2.0
    b = RNG.standard_normal(n)
    room = np.zeros((n + 2, n + 3))
    room[:n, :n], room[:n, n] = A, b
    eliminate.py_func(room, n)
    assert room[:n, n] == pytest.approx(np.linalg.solve(A, b), rel=1e-10)


@pytest.mark.parametrize("n", [1, 8, 72, 512, 700])
def test_vectors_begin_with_a_line(n):
    """At a multiple of 64 bytes, apart from each other, and no two whole pages of 4096 bytes apart."""
    vectors = aligned(17, n)
    places = np.array([x.ctypes.data for x in vectors])
    assert not np.any(places % 64)
    assert np.all(np.diff(places) >= 8 * n)
    assert np.diff(places)[0] % 4096 != 0
    for k, x in enumerate(vectors):
        assert (len(x), x.any()) == (n, False)
        x[:] = k
    assert all(np.all(x == k) for k, x in enumerate(vectors))


def test_worst_unknown():
    """The largest correction in the norm, or the first that is no number."""
    memory = allocate(4, turning.allocate([], np.zeros(0, dtype=np.int64)), ())
    weight = np.array([1.0, 0.01, 1.0, 0.0])
    memory.r[:] = 0.2, 5.0, -0.3, 1e9
    assert worst_unknown.py_func(memory, weight) == 2
    memory.r[1] = np.nan
    assert worst_unknown.py_func(memory, weight) == 1


@pytest.mark.parametrize("kind", SOLIDS)
def test_quadratic_part_of_the_strains(kind):
    """e2(dq) = e(q + dq) - e(q) - De dq: half the second difference, exact for quadratic strains."""
    system = System(cable("curved", elements=2, element=kind)[0])
    batch = next(b for b in system.core.batches if isinstance(b, SolidBatch))
    q, dq = shaken(system), 0.1 * RNG.standard_normal(system.size)
    beam, slots = system.model.bodies["beam"], system.slots["beam"]
    x = gauss(int(batch.groups[0, 3]))[0]

    def scalars(state):
        """Of all elements, (2, points, 15): from the shape functions, in the units of the kernels."""
        found = []
        for e in range(2):
            h = beam.node_x[e + 1] - beam.node_x[e]
            nodal = state[np.r_[slots[e, :4], slots[e + 1, :4], slots[e, 4:]][:, None] + np.arange(3)]
            names = ("r_x", "r_y", "r_z", "r_yx", "r_zx")
            a, b, c, B, C = (shape(kind, x, h, derivative=name) @ nodal for name in names)
            B, C = h * B, h * C
            pairs = ((a, a), (b, b), (c, c), (B, B), (C, C), (B, C), (a, B), (a, C))
            pairs += ((a, b), (a, c), (b, c), (b, B), (c, C), (b, C), (c, B))
            products = np.stack([(u * v).sum(1) for u, v in pairs], axis=1)
            products[:, :3] *= 0.5
            found.append(products)
        return np.array(found)

    wanted = 0.5 * (scalars(q + dq) - 2 * scalars(q) + scalars(q - dq))
    got = quadratic_part(batch._replace(lane_reference=np.zeros((1, 15 * len(x), LANES))), dq)
    got = got.reshape(len(x), 15, LANES)[..., :2].transpose(2, 0, 1)
    assert got == pytest.approx(wanted, abs=1e-12)


@kernel
def rows(frames, border, A):
    turn_rows(frames, border, A)


class TestFrames:
    """A node that turns as a whole: its frame is that rotation (with r_y) or one of the same tangent."""

    R = rotation((1.0, -2.0, 0.7), 1.9)

    def state(self, vectors):
        q = RNG.standard_normal((2, vectors, 3))
        slots = 3 * np.arange(2 * vectors).reshape(2, vectors)
        return q, slots

    @pytest.mark.parametrize("vectors", [2, 4])
    def test_rotation(self, vectors):
        q, slots = self.state(vectors)
        frames = turning.allocate([slots], np.zeros(0, dtype=np.int64))
        turned(frames, q.ravel(), (q @ self.R.T).ravel())
        for k in range(2):
            Q = frames.Q[0, :, k].reshape(3, 3)
            assert pytest.approx(np.eye(3), abs=1e-14) == Q @ Q.T
            assert np.linalg.det(Q) == pytest.approx(1.0)
            assert Q @ q[k, 1] == pytest.approx(self.R @ q[k, 1], abs=1e-13)
            if vectors > 2:
                assert pytest.approx(self.R, abs=1e-13) == Q
            else:  # the smallest one: its axis is normal to both tangents
                axis = np.array([Q[2, 1] - Q[1, 2], Q[0, 2] - Q[2, 0], Q[1, 0] - Q[0, 1]])
                assert axis @ q[k, 1] == pytest.approx(0.0, abs=1e-13)

    @pytest.mark.parametrize("vectors", [2, 4])
    def test_back_and_forth(self, vectors):
        q, slots = self.state(vectors)
        frames = turning.allocate([slots], np.zeros(0, dtype=np.int64))
        turned(frames, q.ravel(), (q @ self.R.T).ravel())
        r = RNG.standard_normal((2, vectors, 3))
        there = r.ravel().copy()
        forth(frames, there)
        for k in range(2):
            Q = frames.Q[0, :, k].reshape(3, 3)
            assert there.reshape(r.shape)[k] == pytest.approx(r[k] @ Q.T, abs=1e-14)
        back(frames, there)
        assert there == pytest.approx(r.ravel(), abs=1e-14)

    def test_rows_that_are_not_kept(self):
        """C -> C Q where a piece stands under a slot of a node that turns, in blocks that are not zero."""
        q, slots = self.state(2)
        places = {0: 36, 3: 39, 6: 75, 9: -1}
        tail = lambda s: np.array([[places[int(i)]] for i in s])  # noqa: E731
        frames = turning.allocate([slots], np.zeros(0, dtype=np.int64), tail=tail)
        turned(frames, q.ravel(), (q @ self.R.T).ravel())
        border = room_for_border(3, 1, 2)
        border.number[0], border.place[0] = 2, (36, 72)
        A = RNG.standard_normal(120)
        wanted = A.copy()
        for node, place in ((0, 36), (0, 39), (1, 75)):
            Q = frames.Q[0, :, node].reshape(3, 3)
            for o in range(place, place + 36, 6):
                wanted[o : o + 3] = A[o : o + 3] @ Q
        rows(frames, border, A)
        assert pytest.approx(wanted, abs=1e-14) == A
        border.number[0], before = 1, A.copy()
        rows(frames, border, A)
        np.testing.assert_array_equal(A[72:], before[72:])

    def test_left_out(self):
        """Nodes that hold single components, share their position, or have a joint; not those held whole."""
        slots = 3 * np.arange(8).reshape(4, 2)
        slots[3, 0] = slots[2, 0]
        held = np.array([1, 6, 7, 8, 9, 10, 11])  # one component of node 0, all of node 1
        frames = turning.allocate([slots], held)
        assert (frames.nodes.tolist(), np.unique(frames.slot[1]).tolist()) == ([1], [9])
        assert turning.allocate([slots], held, attached=np.array([9])).nodes.tolist() == []

    @pytest.mark.parametrize("counts", [(1,), (8,), (9,), (17, 3)])
    def test_any_number_of_nodes(self, counts):
        """Of two and of four vectors, in pairs or apart, in any order; what is no node's stays as it is."""
        places = RNG.permutation(150)[:, None] * 6
        apart = [3, 0] if len(counts) > 1 else [0, 3]
        slots, begin = [], 0
        for m, pairs in zip(counts, (1, 2), strict=False):
            of_nodes = places[begin : begin + m * pairs].reshape(m, pairs, 1) + apart
            slots.append(of_nodes.reshape(m, -1))
            begin += m * pairs
        q, frames = RNG.standard_normal((300, 3)), turning.allocate(slots, np.zeros(0, dtype=np.int64))
        turned(frames, q.ravel(), (q @ self.R.T).ravel())
        r = RNG.standard_normal(900)
        there = r.copy()
        forth(frames, there)
        for node in (node for some in slots for node in some):
            first = q.ravel()[node[1] : node[1] + 3] @ self.R.T
            assert np.linalg.norm(first) > 0
            for slot in node:
                assert np.linalg.norm(there[slot : slot + 3]) == pytest.approx(
                    np.linalg.norm(r[slot : slot + 3])
                )
                assert there[slot] != r[slot]
        others = np.setdiff1d(
            np.arange(900), np.concatenate([s.ravel() for s in slots])[:, None] + np.arange(3)
        )
        np.testing.assert_array_equal(there[others], r[others])
        back(frames, there)
        assert there == pytest.approx(r, abs=1e-13)


class Moving(NamedTuple):
    q: np.ndarray
    v: np.ndarray
    a: np.ndarray
    r: np.ndarray


@kernel
def corrected(s, weight):
    return update(s, weight, 3.0, 7.0)


@kernel
def shifted(s, mask, weight):
    return shift(s.q, s.r, mask, weight)


@kernel
def largest_of(x, weight):
    return largest(x, weight)


class TestCorrections:
    """A correction is taken from all unknowns, however many are left over from eight at a time."""

    @pytest.fixture(params=[6, 8, 12, 18, 30])
    def given(self, request):
        n = request.param
        q, v, a, r, weight = RNG.uniform(0.5, 1.5, (5, n + 3))  # shadows behind the unknowns stay as they are
        return Moving(q, v, a, r * RNG.choice([-1, 1], n + 3)), weight[:n].copy(), n

    def test_of_a_step(self, given):
        s, weight, n = given
        before = Moving(*(x.copy() for x in s))
        size = corrected(s, weight)
        for name, factor in (("q", 1.0), ("v", 3.0), ("a", 7.0)):
            now, old = getattr(s, name), getattr(before, name)
            assert now[:n] == pytest.approx(old[:n] - factor * s.r[:n], rel=1e-14)
            np.testing.assert_array_equal(now[n:], old[n:])
        assert size == np.max(np.abs(s.r[:n]) * weight)
        assert largest_of(s.r, weight) == size

    @pytest.mark.parametrize("bad", [np.nan, np.inf])
    def test_that_is_not_finite(self, given, bad):
        s, weight, n = given
        s.r[RNG.integers(n)] = bad
        assert np.isnan(corrected(s, weight))

    def test_of_positions_alone(self, given):
        s, weight, n = given
        mask, before = RNG.integers(0, 2, n + 3).astype(float), s.q.copy()
        size = shifted(s, mask, weight)
        taken = s.r[:n] * (1 - mask[:n])
        assert s.q[:n] == pytest.approx(before[:n] - taken, rel=1e-14)
        assert size == np.max(np.abs(taken) * weight)


@kernel
def carried(core, s, h):
    carry(core, s, h)


class TestCarry:
    """What Newton's method leaves: the residual of all steps of one length."""

    def built(self):
        model = ancf.Model(gravity=(0, 0, -9.81))
        bar = model.add_rigid_body("bar", at=(0.5, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.2))
        load = model.add_point_mass("load", at=(1, 0, 0), mass=0.5)
        model.pin(bar)
        model.connect(bar.at(0.5, 0, 0), load)
        system = System(model)
        memory = allocate(system.size, turning.turning_nodes(system, 0.01), ())
        memory.q[:], memory.f[:] = system.initial_state()[0], system.core.loads.gravity
        memory.a[:] = random_rate(system)
        system.core.joints.level[:] = 1.0, 0.0, 0.0  # the initial state keeps the constraints
        return system, memory

    def left(self, system, memory):
        """The mass times the accelerations less the weight, where nothing is held."""
        r, out = np.zeros((2, system.size))
        inertia(system.core.batches, system.core.ws, memory.a, r)
        r -= memory.f
        free = np.setdiff1d(system.free, system.multipliers)
        out[free] = r[free]
        return out

    @pytest.mark.parametrize(("before", "steps"), [(0.0, 1), (0.01, 2), (0.02, 1)])
    def test_adds_up_over_steps_of_one_length(self, before, steps):
        system, memory = self.built()
        memory.q[system.multipliers] = 0.0
        carried(system.core, memory, 0.01)
        once = memory.left.copy()
        assert once == pytest.approx(self.left(system, memory), abs=1e-12)
        assert np.max(np.abs(once)) > 0.1
        memory.memo[H_PREV] = before
        carried(system.core, memory, 0.01)
        assert memory.left == pytest.approx(steps * once, abs=1e-12)

    def test_forces_alone(self):
        """Constraints and what supports hold have no share."""
        system, memory = self.built()
        memory.q[system.multipliers] = 3.0
        memory.q[system.numbering.slots["load"][0, 0]] += 0.1  # the joint is open
        carried(system.core, memory, 0.01)
        assert np.all(memory.left[system.multipliers] == 0.0)
        assert np.all(memory.left[system.core.supports.held] == 0.0)


@kernel
def steps_taken(memory, iterations, renewals):
    """Converged steps with these numbers of iterations; a new matrix where the rule gives up the old one."""
    for n in range(iterations.shape[0]):
        fresh = memory.memo[H_FACTOR] == 0.0
        if fresh:
            renewed(memory)
            memory.memo[H_FACTOR] = 1.0
        count(memory, iterations[n], fresh)
        renewals[n] = fresh


class TestRenewal:
    """A matrix is given up when what its steps took beyond the usual has become what a new one costs."""

    def renewals(self, iterations):
        memory = allocate(1, turning.allocate([], np.zeros(0, dtype=np.int64)), ())
        found = np.zeros(len(iterations), dtype=np.bool_)
        steps_taken(memory, np.array(iterations, dtype=float), found)
        return np.flatnonzero(found).tolist(), memory.memo[LIMIT]

    #: Steps that take two iterations more than the fewest, until that makes a renewal.
    WORN = (4,) * (int(FIRST_LIMIT // 2) + 1)

    @pytest.mark.parametrize("usual", [1, 2])
    def test_steady_steps_keep_it(self, usual):
        assert self.renewals([usual + 3] + [usual] * 10_000) == ([0], FIRST_LIMIT)

    @pytest.mark.parametrize("usual", [3, 4, 6])
    def test_what_the_first_matrix_takes_is_not_usual(self, usual):
        """It was made before anything moved; the one after it tells what is usual."""
        worn = int(FIRST_LIMIT // (usual - 2)) + 1
        assert self.renewals([3] + [usual] * worn + [3] + [2] * 1000) == ([0, 1 + worn], FIRST_LIMIT)
        first, limit = self.renewals([3] + [usual] * worn + [3] + [usual] * 10_000)
        assert (first, limit) == ([0, 1 + worn], 2 * FIRST_LIMIT)

    @pytest.mark.parametrize("excess", [1, 2, 4])
    def test_after_the_excess(self, excess):
        """The first step has the matrix of its own."""
        steps = int(FIRST_LIMIT // excess) + 1
        assert self.renewals([3, 2] + [2 + excess] * steps + [3, 2])[0] == [0, 2 + steps]

    def test_one_that_does_not_help_puts_the_next_off(self):
        """By as much as it took; its own steps tell what is usual."""
        put_off = [3, *self.WORN, 3, 4] + [6] * (int(2 * FIRST_LIMIT // 2) + 1)
        first, limit = self.renewals([*put_off, 3, 6])
        assert (first, limit) == ([0, 1 + len(self.WORN), len(put_off)], 4 * FIRST_LIMIT)

    def test_a_renewal_that_helps_brings_the_next_one_nearer(self):
        """Not nearer than what one costs."""
        put_off = [3, *self.WORN, 3, 4] + [6] * (int(2 * FIRST_LIMIT // 2) + 1)
        assert self.renewals([*put_off, 3, 2])[1] == FIRST_LIMIT
        assert self.renewals([3, *self.WORN, 3, 2])[1] == FIRST_LIMIT

    def test_faster_steps_are_no_credit(self):
        """A quiet time does not pay for a matrix that is worn afterwards."""
        assert self.renewals([3, 2] + [1] * 1000 + [3] * 9 + [2])[0] == [0, 1011]


class TestDifferences:
    """Rates of given motions: exact for polynomials of degree 6, at both ends of a run too."""

    @staticmethod
    def polynomial(t, order=0):
        p = np.polynomial.Polynomial([0.3, -1.0, 2.0, 0.5, -0.7, 0.2, 0.1])
        return (p.deriv(order) if order else p)(t)

    @pytest.mark.parametrize("start", [0.0, 0.1, 0.5, 0.9])
    @pytest.mark.parametrize("steps", [1, 2, 12])
    def test_polynomial(self, start, steps):
        h = 0.1
        times = start + h * np.arange(1, steps + 1)
        given = lambda t: self.polynomial(t)[:, None]  # noqa: E731
        value, rate, second = differences(given, times, h, 0.0, 3.0)
        assert value[:, 0] == pytest.approx(self.polynomial(times), rel=1e-13)
        assert rate[:, 0] == pytest.approx(self.polynomial(times, 1), rel=1e-9)
        assert second[:, 0] == pytest.approx(self.polynomial(times, 2), rel=1e-8)

    def test_nothing_is_asked_beyond_the_ends(self):
        asked = []

        def given(t):
            asked.extend(t.tolist())
            return np.zeros((len(t), 1))

        for first in (0.0, 0.6):
            differences(given, first + 0.1 * np.arange(1, 5), 0.1, 0.0, 1.0)
        assert min(asked) >= -1e-12
        assert max(asked) <= 1.0 + 1e-12


class Counted(Account):
    """What a run knows of its energies, J: at the start, astray, exchanged."""

    def __init__(self, start, astray, exchanged):
        self.energy0, self.astray, self.exchanged = np.array([0.0, start, -start]), astray, exchanged


class TestCaution:
    @pytest.mark.parametrize("exchanged", [1e-9, 3.0, 1e12])
    @pytest.mark.parametrize("share", [0.0, 0.1, 0.19, 0.21, 0.7, 30.0])
    def test_from_a_fifth_of_what_is_exchanged_on(self, share, exchanged):
        text = Counted(0.0, share * exchanged, exchanged).caution
        assert bool(text) == (share > 0.2)
        if text:
            assert f"{share * exchanged:.2g} J came from nowhere" in text
            assert f"{100 * share:.2g} % of what was exchanged" in text

    @pytest.mark.parametrize("start", [1.0, 1e6])
    @pytest.mark.parametrize(("digits", "said"), [(1e-10, False), (1e-8, True)])
    def test_round_off_of_what_there_was_is_none(self, start, digits, said):
        """Of large energies that hardly change some are lost by rounding."""
        assert bool(Counted(start, digits * start, 0.1 * digits * start).caution) == said


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("share", [0.99, 1.0, 1.01])
def test_no_unknown_goes_further_than_a_step_can_tell(seed, share):
    """Either way, by its own measure: the first that does is named; shadows and multipliers do not count."""
    rng = np.random.default_rng(seed)
    n, size, most = 12, 17, 0.5
    weight, q0 = rng.uniform(0.5, 20.0, n), rng.uniform(-3.0, 3.0, size)
    way = rng.uniform(-0.9, 0.9, size) * most / np.append(weight, np.full(size - n, 1e-3))
    for k, sign in ((3, 1.0), (7, -1.0), (11, -1.0)):
        moved = way.copy()
        moved[k] = sign * share * most / weight[k]
        state = SimpleNamespace(q=moved, q0=np.zeros(size), memo=np.full(WORST + 1, -1.0))
        status = check_way.py_func(SimpleNamespace(weight=weight), state, most * (1.0 + 1e-12))
        assert (status == FAR, state.memo[WORST]) == ((True, k) if share > 1.0 else (False, -1.0))
        state = SimpleNamespace(q=q0 + moved, q0=q0, memo=np.zeros(WORST + 1))
        status = check_way.py_func(SimpleNamespace(weight=weight), state, most * (1.0 + 1e-12))
        assert share == 1.0 or (status == FAR) == (share > 1.0)
        moved[1] = -2.0 * most / weight[1]
        state = SimpleNamespace(q=moved, q0=np.zeros(size), memo=np.zeros(WORST + 1))
        assert check_way.py_func(SimpleNamespace(weight=weight), state, most) == FAR
        assert state.memo[WORST] == 1
