"""The block factorisation against dense algebra, the orderings against symbolic elimination.

A backward stable solve leaves a residual of about n eps (|A| |x| + |b|): 1e-13 of that is generous for
the small matrices here, and no pivoting between blocks costs some digits for indefinite ones.
"""

import numpy as np
import pytest

import ancf
from ancf.linalg import ordering
from ancf.linalg.block_ldl import allocate
from ancf.linalg.ordering import behind, fill_pattern, from_both_ends, order
from ancf.linalg.sparse import to_sparse
from ancf.system.core import (
    apply_supports,
    assemble,
    factorise_head,
    factorise_matrix,
    restrict,
    solve_matrix,
    solve_sparse,
)
from ancf.system.matrix import Places
from ancf.system.system import System
from block_matrices import PATTERNS, boolean, chain, definite, random_symmetric, tree, values
from helpers import SOFT, cable, matrix, shaken
from mechanisms import LEVELS, at_level, mechanism, moving

RNG = np.random.default_rng(7)


@pytest.fixture(params=PATTERNS)
def pattern(request):
    return PATTERNS[request.param]


def factorised(A, pairs, n):
    """Factor of a dense matrix and the number of negative pivots."""
    places = Places(*fill_pattern(pairs, n))
    factor = allocate(places.row_start, places.column)
    return factor, int(factorise_matrix(values(A, places), factor))


def backward_error(A, x, b):
    return np.linalg.norm(A @ x - b) / (np.linalg.norm(A) * np.linalg.norm(x) + np.linalg.norm(b))


class TestFactorisation:
    def test_solves_definite_systems(self, pattern):
        pairs, n = pattern
        A = definite(pairs, n)
        factor, negative = factorised(A, pairs, n)
        b = RNG.standard_normal(6 * n)
        x = b.copy()
        solve_matrix(factor, x)
        assert negative == 0
        assert backward_error(A, x, b) < 1e-14
        assert x == pytest.approx(np.linalg.solve(A, b), rel=1e-9)

    def test_zeros_at_the_start_are_left_out(self, pattern):
        """To the last bit the same as with them, wherever the first number stands."""
        pairs, n = pattern
        factor, _ = factorised(definite(pairs, n), pairs, n)
        for first in range(n + 1):
            b = np.append(np.zeros(6 * first), RNG.standard_normal(6 * (n - first)))
            wanted, x = b.copy(), b.copy()
            solve_matrix(factor, wanted)
            solve_sparse(factor, x, first)
            assert np.array_equal(x, wanted)

    def test_counts_negative_eigenvalues(self, pattern):
        pairs, n = pattern
        for seed in range(5):
            A = random_symmetric(pairs, n, seed) + 2.0 * (seed - 2) * np.eye(6 * n)
            factor, negative = factorised(A, pairs, n)
            assert negative == np.sum(np.linalg.eigvalsh(A) < 0)
            b = RNG.standard_normal(6 * n)
            x = b.copy()
            solve_matrix(factor, x)
            growth = max(np.max(np.abs(factor.L)), 1.0) ** 2  # there is no pivoting between blocks
            assert backward_error(A, x, b) < 1e-13 * growth

    def test_badly_scaled_unknowns(self):
        """Positions in m and slopes of stiff cables differ by orders of magnitude."""
        pairs, n = PATTERNS["wires"]
        scale = 10.0 ** RNG.uniform(-4, 4, 6 * n)
        A = definite(pairs, n) * scale[:, None] * scale
        factor, negative = factorised(A, pairs, n)
        b = scale * RNG.standard_normal(6 * n)
        x = b.copy()
        solve_matrix(factor, x)
        assert negative == 0
        assert scale * x == pytest.approx(scale * np.linalg.solve(A, b), rel=1e-9)

    def test_only_the_lower_triangle_counts(self):
        """Round-off above the diagonal of a diagonal block must not enter."""
        pairs, n = PATTERNS["chain"]
        A = definite(pairs, n)
        spoiled = A.copy()
        for i in range(n):
            block = spoiled[6 * i : 6 * i + 6, 6 * i : 6 * i + 6]
            block[np.triu_indices(6, 1)] += 1.0
        for one, two in zip(factorised(A, pairs, n)[0], factorised(spoiled, pairs, n)[0], strict=True):
            assert np.array_equal(one, two)

    def test_detects_singular_matrices(self):
        """Integers: the last pivot of a free chain of springs is exactly zero."""
        n = 6
        laplacian = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
        laplacian[0, 0] = laplacian[-1, -1] = 1.0
        _, code = factorised(np.kron(laplacian, np.eye(6)), chain(n), n)
        assert code == -n

    @pytest.mark.parametrize("size", [2.0**-40, 1.0, 2.0**40])
    def test_threshold_of_singular(self, size):
        """What a pivot loses of its diagonal entry counts: 2^-40 of it is left, 2^-48 is round-off."""
        codes = []
        for left in (2.0**-40, -(2.0**-40), 2.0**-48, -(2.0**-48), 0.0):
            A = np.eye(6)
            A[:2, :2] = [[1.0, 1.0], [1.0, 1.0 + left]]  # exact: the second pivot is ``left``
            codes.append(factorised(size * A, chain(1).reshape(0, 2).astype(int), 1)[1])
        assert codes == [0, 1, -1, -1, -1]

    @pytest.mark.parametrize("at", range(6))
    def test_pivots_are_chosen_inside_blocks(self, at):
        """A diagonal entry next to zero is no pivot, wherever it stands: all digits are kept."""
        pairs, n = PATTERNS["chain"]
        A = random_symmetric(pairs, n) + 8.0 * np.eye(6 * n)
        A[at, at] = 1e-18
        factor, negative = factorised(A, pairs, n)
        assert negative == np.sum(np.linalg.eigvalsh(A) < 0)
        b = RNG.standard_normal(6 * n)
        x = b.copy()
        solve_matrix(factor, x)
        assert backward_error(A, x, b) < 1e-13 * max(np.max(np.abs(factor.L)), 1.0) ** 2

    def test_pivot_blocks_are_symmetric_to_the_last_bit(self, pattern):
        """Along a chain of many nodes an antisymmetric error would grow."""
        pairs, n = pattern
        factor, _ = factorised(definite(pairs, n), pairs, n)
        D = factor.D_inv.reshape(-1, 6, 6)
        assert np.array_equal(D, D.transpose(0, 2, 1))

    def test_small_blocks_count(self):
        """Only what is exactly zero is left out: bodies are coupled by stiffnesses of any size."""
        weak = 2.0**-30
        A = np.eye(12)
        A[6:, :6] = A[:6, 6:] = weak * np.eye(6)
        factor, _ = factorised(A, chain(2), 2)
        x = np.append(np.ones(6), np.zeros(6))
        solve_matrix(factor, x)
        assert x[6:] == pytest.approx(np.full(6, -weak / (1 - weak**2)), rel=1e-14)

    def test_detects_what_is_not_a_number(self):
        pairs, n = PATTERNS["chain"]
        A = definite(pairs, n)
        A[20, 20] = np.nan
        assert factorised(A, pairs, n)[1] < 0


class TestHead:
    """The first rows alone, where the last ones change in every step."""

    @pytest.mark.parametrize("last", [1, 5, -1])
    def test_equals_the_factors_of_the_part(self, pattern, last):
        pairs, n = pattern
        last %= n
        A = definite(pairs, n)
        places = Places(*fill_pattern(pairs, n))
        factor = allocate(places.row_start, places.column)
        spoiled = A.copy()
        spoiled[6 * last :] = np.nan  # not read
        assert factorise_head(values(spoiled, places), factor, last) == 0
        whole, _ = factorised(A, pairs, n)
        assert np.array_equal(factor.D_inv[: 36 * last], whole.D_inv[: 36 * last])
        below = 36 * int(places.row_start[last])
        assert np.array_equal(factor.L[:below], whole.L[:below])
        assert not factor.L[below:].any()


@pytest.fixture(scope="module")
def long_cable():
    model = ancf.Model()
    section = ancf.Section.rectangle(0.01, 0.01, E=1e8, rho=500.0)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=1000, section=section)
    model.clamp(beam.start)
    return System(model)


class TestLongChain:
    """A cable of 1000 elements: M/B + K mixes entries over ten orders of magnitude."""

    @pytest.mark.parametrize("mass", [4 / 1e-3**2, 4 / 2.5e-4**2])
    def test_solve(self, long_cable, mass):
        core = long_cable.core
        q, v = long_cable.initial_state()
        assemble(core.batches, core.ws, q, v, core.A, mass, 0.0, 1.0)
        restrict(core.supports, core.A)
        A = to_sparse(core.A, long_cable.places)
        assert factorise_matrix(core.A, core.factor) == 0
        b = RNG.standard_normal(long_cable.n)
        b[core.supports.held] = 0.0
        x = b.copy()
        solve_matrix(core.factor, x)
        norm = np.max(abs(A).sum(axis=1))
        assert np.max(np.abs(A @ x - b)) < 1e-13 * (norm * np.max(np.abs(x)) + np.max(np.abs(b)))

    def test_pivot_blocks_stay_symmetric(self, long_cable):
        """An antisymmetric error would grow from node to node up to the tip."""
        core = long_cable.core
        q, v = long_cable.initial_state()
        assemble(core.batches, core.ws, q, v, core.A, 4 / 2.5e-4**2, 0.0, 1.0)
        restrict(core.supports, core.A)
        factorise_matrix(core.A, core.factor)
        D = core.factor.D_inv.reshape(-1, 6, 6)
        assert np.array_equal(D, D.transpose(0, 2, 1))

    def test_static_stiffness_is_definite(self, long_cable):
        core = long_cable.core
        q, v = long_cable.initial_state()
        assemble(core.batches, core.ws, q, v, core.A, 0.0, 0.0, 1.0)
        restrict(core.supports, core.A)
        assert factorise_matrix(core.A, core.factor) == 0


class TestFill:
    def test_equals_symbolic_elimination(self, pattern):
        pairs, n = pattern
        B = boolean(pairs, n)
        for k in range(n):  # eliminating k couples all later neighbours of k
            later = np.flatnonzero(B[k, k + 1 :]) + k + 1
            B[np.ix_(later, later)] = True
        row_start, column = fill_pattern(pairs, n)
        for i in range(n):
            assert column[row_start[i] : row_start[i + 1]].tolist() == np.flatnonzero(B[i, :i]).tolist()

    def test_no_pairs(self):
        row_start, column = fill_pattern(np.zeros((0, 2), dtype=np.int64), 3)
        assert row_start.tolist() == [0, 0, 0, 0]
        assert len(column) == 0


def fill_of(pairs, rank):
    return len(fill_pattern(rank[pairs], len(rank))[1])


class TestOrder:
    def test_is_a_permutation(self, pattern):
        rank, _ = order(*pattern)
        assert sorted(rank.tolist()) == list(range(pattern[1]))

    def test_keeps_a_chain(self):
        rank, name = order(chain(50), 50)
        assert name == "as given"
        assert rank.tolist() == list(range(50))

    def test_one_body(self):
        rank, _ = order(np.zeros((0, 2), dtype=np.int64), 1)
        assert rank.tolist() == [0]

    def test_tree_has_no_fill(self):
        pairs = np.random.default_rng(2).permutation(40)[tree(40)]
        rank, _ = order(pairs, 40)
        assert fill_of(pairs, rank) <= 1.02 * 39

    @pytest.mark.parametrize("n", [30, 300])
    def test_band_for_wires(self, n):
        """Wires coupled at every node: one after the other fills n columns of L, side by side two."""
        pairs = np.concatenate([chain(n), chain(n) + n, [(i, n + i) for i in range(n)]])
        rank, name = order(pairs, 2 * n)
        assert name == "band"
        assert np.max(np.abs(np.diff(rank[pairs], axis=1))) <= 2
        assert fill_of(pairs, rank) < 4 * n

    @pytest.mark.parametrize("every", [2, 3, 5])
    def test_band_of_wires_does_not_grow(self, every):
        """Wires coupled now and then: the same narrow band and few blocks of L, however long they are."""
        for n in (30, 300):
            pairs = np.concatenate([chain(n), chain(n) + n, [(i, n + i) for i in range(0, n, every)]])
            rank, name = order(pairs, 2 * n)
            assert name == "band"
            assert np.max(np.abs(np.diff(rank[pairs], axis=1))) <= 4
            assert fill_of(pairs, rank) < 4.5 * n < 0.7 * fill_of(pairs, np.arange(2 * n))

    @pytest.mark.parametrize("links", [0.1, 0.3, 0.6])
    def test_fill_is_within_a_seventh_of_the_least(self, links):
        """Of the orders that are compared, on nets between a chain and a tangle."""
        n = 60
        for seed in range(12):
            extra = np.random.default_rng(seed).integers(0, n, (int(links * n), 2))
            pairs = np.concatenate([chain(n), extra])
            least = min(
                fill_of(pairs, rank)
                for rank in (np.arange(n), ordering.band(pairs, n), ordering._minimum_degree(pairs, n))
            )
            assert fill_of(pairs, order(pairs, n)[0]) <= 1.15 * least

    def test_minimum_degree_for_a_net(self):
        k = 24
        node = np.arange(k * k).reshape(k, k)
        across = np.stack([node[:, :-1].ravel(), node[:, 1:].ravel()], axis=1)
        down = np.stack([node[:-1].ravel(), node[1:].ravel()], axis=1)
        pairs = np.concatenate([across, down])
        rank, name = order(pairs, k * k)
        assert name == "minimum degree"
        assert fill_of(pairs, rank) < 0.7 * fill_of(pairs, np.arange(k * k))


class TestSystems:
    """The orderings as a System uses them."""

    @staticmethod
    def ladder(elements):
        """Two wires with a spring at every node."""
        model, section = ancf.Model(), ancf.Section(**SOFT)
        given = {"elements": elements, "section": section}
        wire = model.add_beam("wire", start=(0, 0, 0), end=(elements, 0, 0), **given)
        carrier = model.add_beam("carrier", start=(0, 0, 1), end=(elements, 0, 1), **given)
        for x in range(elements + 1):
            model.add_spring(wire.at(x), carrier.at(x), stiffness=100.0, slack=True)
        return System(model)

    def test_band_of_coupled_wires_does_not_grow(self):
        assert self.ladder(20).half_bandwidth == self.ladder(200).half_bandwidth == 17

    def test_single_cable_is_block_tridiagonal(self):
        assert System(cable(elements=40)[0]).half_bandwidth == 11

    def test_supports_as_in_reduced_dense_algebra(self):
        """Local axes are a change of variables, held unknowns drop out."""
        model, beam = cable("curved and stretched", elements=4)
        model.clamp(beam.start)
        model.hold(beam.at(beam.node_x[2]), position="y", slope="xz")
        model.clamp(beam.end, stretch="fixed")
        system = System(model)
        core, n = system.core, system.n
        q = shaken(system, size=0.3)
        T = np.eye(n)
        rot = [(s, R[0]) for s, R in zip(core.supports.rot_slot, core.supports.rot_R, strict=True)]
        assert len(rot) == 1
        for slot, R in rot:
            T[slot : slot + 3, slot : slot + 3] = R
        for slot, R in rot:
            q[core.supports.rot_shadow[0] :] = R @ q[slot : slot + 3]
        whole = matrix(system, q, mass=2.0, stiffness=1.0)
        assemble(core.batches, core.ws, q, np.zeros_like(q), core.A, 2.0, 0.0, 1.0)
        restrict(core.supports, core.A)
        got, wanted = to_sparse(core.A, system.places).toarray(), T.T @ whole @ T
        held = core.supports.held
        wanted[held] = wanted[:, held] = 0.0
        wanted[held, held] = 1.0
        assert len(held) == 5 + 3 + 6
        assert np.max(np.abs(got - wanted)) < 1e-13 * np.max(np.abs(wanted))

    def test_residual_along_local_axes(self):
        model, beam = cable("curved", elements=2)
        model.clamp(beam.start)
        system = System(model)
        supports = system.core.supports
        r = RNG.standard_normal(system.size)
        physical = r[supports.rot_shadow[0] :].copy()
        apply_supports(supports, r)
        slot = supports.rot_slot[0]
        assert r[slot] == pytest.approx(beam.node_tangent[0] @ physical)
        assert not np.any(r[supports.held])


class TestBothEnds:
    @pytest.mark.parametrize("n", [1, 2, 3, 8, 9, 200])
    def test_halves_of_a_chain_meet_in_the_middle(self, n):
        """Blocks of one half come in turn with those of the other, and L has no block more."""
        rank = from_both_ends(np.arange(n), 1)
        assert sorted(rank.tolist()) == list(range(n))
        if n >= 4:
            assert rank[[0, -1, 1, -2]].tolist() == [0, 1, 2, 3]
            coupled = np.abs(np.diff(rank[chain(n)], axis=1)).ravel()
            assert sorted(coupled.tolist()) == [1] + [2] * (n - 2)
        assert len(fill_pattern(rank[chain(n).reshape(-1, 2).astype(int)], n)[1]) == n - 1

    @pytest.mark.parametrize(("n", "every"), [(40, 3), (100, 1), (100, 10)])
    def test_wires_fill_hardly_more(self, n, every):
        pairs = np.concatenate([chain(n), chain(n) + n, [(i, n + i) for i in range(0, n, every)]])
        rank = ordering.band(pairs, 2 * n)
        spread = int(np.max(np.abs(np.diff(rank[pairs], axis=1))))
        fill = [len(fill_pattern(r[pairs], 2 * n)[1]) for r in (rank, from_both_ends(rank, spread))]
        assert fill[1] <= fill[0] + 3 * spread**2

    def test_short_bands_stay(self):
        rank = np.random.default_rng(2).permutation(20)
        assert from_both_ends(rank, 4) is rank


class TestBehind:
    """Blocks of multipliers come behind what they are coupled with."""

    @pytest.mark.parametrize("seed", range(5))
    def test_order(self, seed):
        rng = np.random.default_rng(seed)
        n, bodies = 20, 14
        later, last = [14, 15, 16, 17], [18, 19]
        inner = rng.integers(0, bodies, (25, 2))
        joints = np.array([(block, k) for block in later for k in rng.choice(bodies, 3, replace=False)])
        pairs = np.concatenate([inner, joints])
        place = behind(rng.permutation(n), pairs, np.array(later), last)
        assert sorted(place.tolist()) == list(range(n))
        for block in later:
            met = np.unique(joints[joints[:, 0] == block, 1])
            assert place[block] > place[met].max()
        assert place[last].tolist() == [18, 19]

    def test_others_keep_their_order(self):
        rank = np.random.default_rng(2).permutation(12)
        place = behind(rank, np.array([(11, 3), (11, 7)]), np.array([11]), [])
        others = np.arange(11)
        assert np.array_equal(np.argsort(place[others]), np.argsort(rank[others]))
        first_after = np.max(place[[3, 7]])
        assert place[11] == first_after + 1


@pytest.fixture(scope="module")
def jointed():
    """Every kind of joint, with local axes at a support."""
    return mechanism(stretch="free")


class TestJoints:
    """Matrices with multipliers, which have zeros on the diagonal: no pivoting, bodies first."""

    def assembled(self, system, level, mass):
        at_level(system, level)
        core = system.core
        q, v, _ = moving(system)
        weights = {"position": (mass, 0.0, 1.0), "velocity": (mass, 1.0, 0.0), "acceleration": (1.0, 0, 0)}
        assemble(core.batches, core.ws, q, v, core.A, *weights[level])
        restrict(core.supports, core.A)
        return to_sparse(core.A, system.places).toarray()

    @pytest.mark.parametrize("level", LEVELS)
    @pytest.mark.parametrize("mass", [1e2, 1e6])
    def test_solve(self, jointed, level, mass):
        A = self.assembled(jointed, level, mass)
        core = jointed.core
        code = int(factorise_matrix(core.A, core.factor))
        free_rows = np.setdiff1d(jointed.multipliers, core.supports.held)
        assert code == len(free_rows) == np.sum(np.linalg.eigvalsh(A) < 0)
        b = RNG.standard_normal(jointed.n)
        b[core.supports.held] = 0.0
        x = b.copy()
        solve_matrix(core.factor, x)
        for _ in range(2):  # as the iterations of a step refine it
            rest = b - A @ x
            solve_matrix(core.factor, rest)
            x += rest
        wanted = np.linalg.solve(A, b)
        scale = np.abs(wanted) + np.abs(wanted).max() * 1e-9
        assert np.max(np.abs(x - wanted) / scale) < 1e-6

    def test_sliding_rows_come_last(self, jointed):
        first = jointed.core.joints.first
        blocks = {int(jointed.joints[name][0]) // 6 for name in ("on wire", "on arm")}
        assert blocks == {jointed.n // 6 - 2, jointed.n // 6 - 1}
        assert first == jointed.n // 6 - 2

    def test_multipliers_come_behind_their_bodies(self, jointed):
        slots = jointed.numbering.slots
        for name, bodies in (("clamp", ("wire", "hub")), ("hinge", ("hub", "arm")), ("hub", ("hub",))):
            mine = jointed.joints[name].min() // 6
            near = [slots[body][-1 if body == "wire" else 0].max() // 6 for body in bodies]
            assert mine > max(near)
