"""Rows at the border of kept factors, against dense solutions of the whole matrix."""

import numpy as np
import pytest

import ancf
from ancf.compiled import kernel
from ancf.linalg.block_ldl import allocate
from ancf.linalg.border import (
    clear_rows,
    find_rows,
    forget_columns,
    make_border,
    room_for_border,
    solve_border,
)
from ancf.linalg.ordering import fill_pattern
from ancf.linalg.sparse import to_sparse
from ancf.solvers.step.low_rank import correct, room_for_patches
from ancf.system.core import assemble, factorise_head, restrict, solve_kept, solve_sparse
from ancf.system.matrix import Places
from ancf.system.system import System

RNG = np.random.default_rng(15)
HEAD = 14  # blocks before the border
COUPLED = {"chain": 1, "band": 3}  # how far blocks are coupled


@kernel
def renewed(border, A, factor):
    """The rows from the matrix; number of negative pivots."""
    find_rows(border, A, factor)
    return make_border(border, A, factor)


class Bordered:
    """A random definite K with rows R and D at its border; what is zero in R may become something later."""

    def __init__(self, reach, rows, widest=3):
        n = HEAD + rows
        self.rows, self.widest = rows, widest
        near = [(i, j) for i in range(HEAD) for j in range(max(i - reach, 0), i)]
        pairs = np.array([*near, *((HEAD + t, j) for t in range(rows) for j in range(HEAD))])
        self.places = Places(*fill_pattern(pairs, n))
        self.factor = allocate(self.places.row_start, self.places.column)
        self.border = room_for_border(HEAD, rows, widest)
        self.whole = np.zeros((6 * n, 6 * n))
        self.new_head(near)

    def new_head(self, near):
        self.near = near
        K = np.zeros((6 * HEAD, 6 * HEAD))
        for i, j in near:
            K[6 * i : 6 * i + 6, 6 * j : 6 * j + 6] = RNG.standard_normal((6, 6))
        K = K + K.T
        K += np.diag(np.abs(K).sum(axis=1) + RNG.uniform(0.5, 1.5, 6 * HEAD))
        self.whole[: 6 * HEAD, : 6 * HEAD] = K
        head = self.whole.copy()
        head[6 * HEAD :, :] = head[:, 6 * HEAD :] = np.nan  # not read
        assert factorise_head(self.values(head), self.factor, HEAD) == 0
        forget_columns.py_func(self.border)

    def new_rows(self, at):
        """Rows with entries under these blocks, one list of blocks for each row."""
        self.whole[6 * HEAD :, :] = self.whole[:, 6 * HEAD :] = 0.0
        for t, blocks in enumerate(at):
            o = 6 * (HEAD + t)
            self.whole[o : o + 6, o : o + 6] = -np.diag(RNG.uniform(0.1, 1.0, 6))
            for j in blocks:
                self.whole[o : o + 6, 6 * j : 6 * j + 6] = RNG.standard_normal((6, 6))
        self.whole[:, 6 * HEAD :] = self.whole[6 * HEAD :].T

    def values(self, whole):
        k = np.arange(self.places.n)
        rows, cols = np.append(k, self.places.rows), np.append(k, self.places.column)
        return np.concatenate(
            [whole[6 * i : 6 * i + 6, 6 * j : 6 * j + 6].ravel() for i, j in zip(rows, cols, strict=True)]
        )

    def error(self):
        """Of a solution, as a share of its size."""
        b = RNG.standard_normal(len(self.whole))
        x = b.copy()
        head = x[: 6 * HEAD].copy()
        inside = allocate(*fill_pattern(np.array(self.near), HEAD))
        assert factorise_head(self.values_of_head(), inside, HEAD) == 0
        solve_sparse(inside, head, 0)
        x[: 6 * HEAD] = head
        solve_border(self.border, x)
        return float(np.max(np.abs(x - np.linalg.solve(self.whole, b))) / np.max(np.abs(x)))

    def values_of_head(self):
        places = Places(*fill_pattern(np.array(self.near), HEAD))
        k = np.arange(HEAD)
        rows, cols = np.append(k, places.rows), np.append(k, places.column)
        K = self.whole
        return np.concatenate(
            [K[6 * i : 6 * i + 6, 6 * j : 6 * j + 6].ravel() for i, j in zip(rows, cols, strict=True)]
        )


@pytest.fixture(params=COUPLED)
def reach(request):
    return COUPLED[request.param]


@pytest.mark.parametrize("rows", [1, 2, 5])
def test_joints_that_travel(reach, rows):
    """To and fro over all blocks, some rows on the same ones: every solution is that of the whole matrix."""
    system = Bordered(reach, rows)
    for step in range(40):
        at = [
            {0, *(int(abs((step // 2 + 3 * t) % 26 - 13)) + k for k in range(2) if step % 7)}
            for t in range(rows)
        ]
        system.new_rows([[j for j in blocks if j < HEAD] for blocks in at])
        negative = renewed(system.border, system.values(system.whole), system.factor)
        assert negative == 6 * rows  # multipliers
        assert system.error() < 1e-10


def test_columns_are_kept_and_forgotten(reach):
    """Columns are those of the inverse, made when a block or the factors are new, and only then."""
    system = Bordered(reach, 1)
    border, first = system.border, None
    for blocks in ([3, 4, 9], [4, 5, 9], [3, 4, 9], [10, 11, 9]):
        system.new_rows([blocks])
        renewed(border, system.values(system.whole), system.factor)
        inverse = np.linalg.inv(system.whole[: 6 * HEAD, : 6 * HEAD])
        assert set(border.block[border.kept[0, :3]]) == set(blocks)
        for m in border.kept[0, :3]:
            j = border.block[m]
            columns = border.inverse[m].reshape(HEAD, 6, 6).transpose(0, 2, 1).reshape(6 * HEAD, 6)
            assert columns == pytest.approx(inverse[:, 6 * j : 6 * j + 6], abs=1e-12)
        nine = int(np.flatnonzero(border.block == 9)[0])
        first = nine if first is None else first
        assert nine == first
    border.inverse[first] += 1.0  # it is taken as it is while the factors are kept
    renewed(border, system.values(system.whole), system.factor)
    assert system.error() > 1e-3
    system.new_head(system.near)
    renewed(border, system.values(system.whole), system.factor)
    assert system.error() < 1e-10


@kernel
def cleared(border, A, n):
    clear_rows(border, A, n)


def test_rows_are_cleared_where_they_were(reach):
    system = Bordered(reach, 2)
    system.new_rows([[2, 3, 7], [5, 6]])
    A = system.values(system.whole)
    renewed(system.border, A, system.factor)
    cleared(system.border, A, HEAD)
    left = system.whole.copy()
    left[6 * HEAD :, :] = left[:, 6 * HEAD :] = 0.0
    assert np.array_equal(A, system.values(left))


def test_a_row_that_holds_nothing_is_singular(reach):
    system = Bordered(reach, 2)
    system.new_rows([[2, 3], [5]])
    system.whole[6 * HEAD + 6 :, :] = 0.0
    assert renewed(system.border, system.values(system.whole), system.factor) == -2


@kernel
def corrected(patches, core, q, v, gb, x):
    solve_kept(core, x, np.int64(0))
    correct(patches, core, q, v, gb, x)


@pytest.mark.parametrize("slack", [(0,), (0, 1, 2)])
def test_springs_beside_the_border(slack):
    """Springs that went slack since the matrix was made, and a bead that slides: as the dense matrix says."""
    model = ancf.Model()
    section = ancf.Section(EA=1e3, EI=0.1, rhoA=0.2)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=6, section=section)
    model.pin(wire.start)
    model.pin(wire.end)
    model.slide(model.add_point_mass("bead", at=(0.9, 0, 0), mass=0.3), along=wire)
    for k in range(3):
        x = 2.0 * (k + 2) / 6
        above = (x, 0.1, 0.5)
        model.add_spring(wire.at(x), above, stiffness=50.0, damping=0.5, length=0.4, slack=True)
    system, gb = System(model), 30.0
    core, patches = system.core, room_for_patches(system)
    q, v = system.initial_state()
    system.level[:] = 1.0, 0.0, 0.0
    assemble(core.batches, core.ws, q, v, core.A, 1e4, gb, 1.0)
    restrict(core.supports, core.A)
    assert factorise_head(core.A, core.factor, core.joints.first) == 0
    forget_columns.py_func(core.joints.border)
    assert renewed(core.joints.border, core.A, core.factor) >= 0
    now = q.copy()
    for k in slack:  # up, so that they carry nothing
        now[system.slots["wire"][k + 2, 0] + 2] += 0.3
    r = RNG.standard_normal(system.size)
    r[core.supports.held] = 0.0
    x = r.copy()
    corrected(patches, core, now, v, gb, x)
    rows = patches[0]
    whole = to_sparse(core.A, system.places).toarray()
    assert rows.used[0] == len(slack)
    for j in range(len(slack)):
        b = np.zeros(system.n)
        b[rows.entry[j, : rows.width[j]]] = rows.value[j, : rows.width[j]]
        assert np.linalg.norm(b) == pytest.approx(1.0)
        whole -= (50.0 + gb * 0.5) * np.outer(b, b)
    wanted = np.linalg.solve(whole, r[: system.n])
    assert x[: system.n] == pytest.approx(wanted, abs=1e-9 * np.max(np.abs(wanted)))
