"""Linear equations of motion about an equilibrium, with inputs: forces, and motions of what is held.

With the free unknowns x, the multipliers l of the joints and held unknowns s that inputs move

    M x'' + D x' + K x + M_s s'' + D_s s' + K_s s + C^T l = F u,    C x + C_s s = 0.

Joints are eliminated: x = P p + X s, where the columns of P span the motions with C x = 0 and X s is how
all of it follows the supports at rest.  P are the undamped modes, P^T M P = 1, so that the stiffness of the
lowest ones does not drown in the round-off of the highest; what is not symmetric in K goes with P^T K P.
With m = P^T (M X + M_s), and d and k alike,

    p'' = -P^T D P p' - P^T K P p + P^T F u - m s'' - d s' - k s.

A motion of order two has s'' = u, states s and s'.  One of order one has s' = u and the state s, and
s'' = u', which no state may have on its right side: the state is e = p' + m s', the momentum of the mode
over its mass, in place of p'.  u' stays only in what depends on accelerations, such as reactions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.linalg import LinAlgError

from ..arrays import FloatArray, IntArray
from ..errors import ModelError, SolveError
from ..later import coo_array, csc_array, eigh
from ..system.core import apply_load, residual
from .damped_modal import Damped, physical
from .modal import dense, motions
from .quadratic import NEUTRAL, SHIFT, UNSEEN

#: Share of a motion of a support by which joints may be open.
OPEN = 1e-8
#: Change of a difference that is none, and how often a quarter of its step is taken.
SETTLED, QUARTERS = 1e-11, 14
#: Ratio of two squares of frequencies that are apart, and how far from the best place they are looked for.
APART, NEAR = 1.01, 1e3


@dataclass(frozen=True)
class Moved:
    """A held unknown that inputs move.

    Parameters
    ----------
    unknown : int
    order : int
        1: inputs give its rate, 2: its second rate.
    gain : ndarray, shape (inputs,)
        Of the inputs in that.
    columns : (3, n) ndarray or None
        Its columns of mass, damping and stiffness, where the matrices have none.
    """

    unknown: int
    order: int
    gain: FloatArray
    columns: FloatArray | None = None


@dataclass(frozen=True)
class Directions:
    """What changes with states, inputs and their rates: one row of full state vectors for each of them.

    Parameters
    ----------
    q, v, a : ndarray, shape (states + 2 inputs, size)
        Positions with multipliers, rates, second rates.
    r : ndarray, shape (states + 2 inputs, size)
        Forces out of balance, which in the rows of held unknowns are reactions.
    """

    q: FloatArray
    v: FloatArray
    a: FloatArray
    r: FloatArray


class Linear:
    """Linear equations of a system about an equilibrium.

    Parameters
    ----------
    made : Damped
        Matrices about a state that does not rotate.
    forces : ndarray, shape (n, inputs)
        Of inputs, by each, on all unknowns.
    moved : list of Moved

    Attributes
    ----------
    squares : ndarray, shape (modes,)
        omega^2 of the undamped modes, 1/s^2, ascending.
    shapes : ndarray, shape (free, modes)
        P, at the unknowns ``made.free``.
    A, B : ndarray
        Of the states: p, s, p' or e, s' of the motions of order two.

    Raises
    ------
    ModelError
        Joints hold what is to be moved.
    SolveError
        Something that moves has no mass.
    """

    def __init__(self, made: Damped, forces: FloatArray, moved: list[Moved]) -> None:
        self.made, self.moved, self.forces = made, moved, forces
        f, lam, axes = made.free, made.lam, made.axes
        parts = made.whole()
        self.M, self.D, self.K = (
            _with_columns(csc_array(axes.T @ x @ axes), moved, k) for k, x in enumerate(parts)
        )
        self.physical = parts[2]
        mass = self.M[f][:, f].toarray()
        Z = motions(self.K[lam][:, f].toarray(), np.diag(mass).copy()) if len(lam) else np.eye(len(f))
        self.own = np.sqrt(np.maximum(np.diag(mass), 0.0))
        self.own[self.own == 0.0] = np.max(self.own)
        self.squares, self.shapes = self._modes(Z, mass)
        held = [one.unknown for one in moved]
        self.columns = [x[:, held].toarray() for x in (self.M, self.D, self.K)]
        self.follows = self._at_rest(self._follows())
        self._assemble()

    def _modes(self, Z: FloatArray, mass: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Undamped modes of the symmetric part of the stiffness, neutral ones with omega^2 = 0."""
        f, whole = self.made.free, self._symmetric(1.0)
        k, m = Z.T @ (whole[f][:, f] @ Z), Z.T @ mass @ Z
        try:
            squares, vectors = all_modes(0.5 * (k + k.T), 0.5 * (m + m.T))
        except LinAlgError:
            what = "the mass matrix is singular"
            raise SolveError("linearise", what, "check masses, inertias and joints") from None
        shapes = Z @ vectors
        across, size = abs(self.made.axes), np.abs(shapes)
        terms = csc_array(across.T @ abs(self.physical) @ across)[f][:, f]
        least = (UNSEEN * SHIFT) ** 2 * float(abs(self.K[f][:, f]).sum() / np.abs(mass).sum())
        noise = NEUTRAL * np.sum(size * (terms @ size), axis=0) + least  # as of the damped modes
        squares = np.where(np.abs(squares) <= noise, 0.0, squares)
        order = np.argsort(squares, kind="stable")
        return squares[order], shapes[:, order]

    def _symmetric(self, sign: float) -> csc_array:
        """Symmetric or, with -1, antisymmetric part of the stiffness: exactly none of what is symmetric."""
        whole, axes = self.physical, self.made.axes
        return csc_array(axes.T @ (0.5 * (whole + sign * whole.T)) @ axes)

    def _follows(self) -> FloatArray:
        """How the free unknowns follow what inputs move through joints, (free, moved)."""
        rows = np.union1d(self.made.lam, self.made.system.spare)
        if not len(rows) or not len(self.moved):
            return np.zeros((len(self.made.free), len(self.moved)))
        C = self.K[rows][:, self.made.free].toarray() / self.own
        size = np.linalg.norm(C, axis=1)
        moving = self.columns[2][rows]
        C, moving = C / size[:, None], moving / size[:, None]
        X = -np.linalg.lstsq(C, moving, rcond=1e-12)[0]
        left = np.max(np.abs(C @ X + moving), axis=0)
        for one, gap, whole in zip(self.moved, left, np.max(np.abs(moving), axis=0), strict=True):
            if gap > OPEN * whole:
                what = f"{self.made.system.numbering.describe(one.unknown)} cannot move: joints hold it"
                raise ModelError("linearise.inputs", what, "leave the input out, or free what holds it")
        followed: FloatArray = X / self.own[:, None]
        return followed

    def _at_rest(self, X: FloatArray) -> FloatArray:
        """X: the same with all modes that have a stiffness where they stand still."""
        f = self.made.free
        pulled = self.shapes.T @ (self.K[f][:, f] @ X + self.columns[2][f])
        stiff = np.where(self.squares == 0.0, np.inf, self.squares)
        followed: FloatArray = X - self.shapes @ (pulled / stiff[:, None])
        return followed

    def _assemble(self) -> None:
        """States, their equations, and what follows of all unknowns."""
        f, P, X = self.made.free, self.shapes, self.follows
        inputs, count, moves = self.forces.shape[1], len(self.squares), len(self.moved)
        second = [j for j, one in enumerate(self.moved) if one.order == 2]
        states = 2 * count + moves + len(second)
        self.states, width = states, states + 2 * inputs
        gain = np.array([one.gain for one in self.moved]).reshape(moves, inputs)
        first = np.array([one.order == 1 for one in self.moved], dtype=bool)
        u, du = np.arange(states, states + inputs), np.arange(states + inputs, width)
        s, ds, dds = np.zeros((3, moves, width))
        s[np.arange(moves), count + np.arange(moves)] = 1.0
        ds[second, 2 * count + moves + np.arange(len(second))] = 1.0
        ds[np.ix_(first, u)] = gain[first]
        dds[np.ix_(first, du)] = gain[first]
        dds[np.ix_(~first, u)] = gain[~first]
        m, d, k = (
            P.T @ (A[f][:, f] @ X + c[f]) for A, c in zip((self.M, self.D, self.K), self.columns, strict=True)
        )
        p, dp = np.zeros((2, count, width))
        p[:, :count] = np.eye(count)
        dp[:, count + moves : 2 * count + moves] = np.eye(count)
        dp -= m[:, first] @ ds[first]
        beside = P.T @ (self._symmetric(-1.0)[f][:, f] @ P)
        self.damping = P.T @ (self.D[f][:, f] @ P)
        ddp = -self.damping @ dp - (self.squares[:, None] * p + beside @ p) - m @ dds - d @ ds - k @ s
        ddp[:, u] += P.T @ self.forces[f]
        whole = np.vstack([dp, ds, ddp, dds[second]])  # of e' = p'' + m u' without u', which p'' has alone
        self.A, self.B = whole[:, :states], whole[:, states : states + inputs]
        self._moments = m[:, first], first
        self._unknowns = [(P @ y + X @ z, z) for y, z in ((p, s), (dp, ds), (ddp, dds))]
        self._inputs = u

    def directions(self) -> Directions:
        """See :class:`Directions`."""
        made, system = self.made, self.made.system
        width, f, lam = self._unknowns[0][0].shape[1], made.free, made.lam
        moved = np.array([one.unknown for one in self.moved], dtype=np.int64)
        q, v, a = np.zeros((3, system.n, width))
        for x, (free, held) in zip((q, v, a), self._unknowns, strict=True):
            x[f], x[moved] = free, held
        r = self.M @ a + self.D @ v + self.K @ q
        r[:, self._inputs] -= self.forces
        if len(lam):
            carried = self.K[f][:, lam].toarray()
            q[lam] = -np.linalg.lstsq(carried / self.own[:, None], r[f] / self.own[:, None], rcond=1e-13)[0]
            r += self.K[:, lam] @ q[lam]
        return Directions(*(self._seen(x) for x in (q, v, a, r)))

    def _seen(self, x: FloatArray) -> FloatArray:
        """Rows of full state vectors, with their shadows, from columns (n, width)."""
        system = self.made.system
        found = np.zeros((x.shape[1], system.size))
        found[:, : system.n] = x.T
        supports = system.core.supports
        for k, (slot, shadow) in enumerate(
            zip(supports.rot_slot.tolist(), supports.rot_shadow.tolist(), strict=True)
        ):
            found[:, shadow : shadow + 3] = found[:, slot : slot + 3] @ supports.rot_R[k, 0].T
        return found

    def reading(self) -> tuple[IntArray, FloatArray, FloatArray]:
        """How states follow from changes of unknowns: these, and factors of them and of their rates.

        Returns
        -------
        unknowns : ndarray, shape (k,)
        of_q, of_v : ndarray, shape (states, k)
        """
        f, count = self.made.free, len(self.squares)
        moved = np.array([one.unknown for one in self.moved], dtype=np.int64)
        m, first = self._moments
        projected = self.shapes.T @ self.M[f][:, f]
        beside = -projected @ self.follows
        none = np.zeros((len(moved), len(f)))
        held = np.eye(len(moved))
        of_q = np.vstack([np.hstack([projected, beside]), np.hstack([none, held])])
        beside[:, first] += m
        of_v = np.vstack([np.hstack([projected, beside]), np.hstack([none, held])[~first]])
        whole_q, whole_v = np.zeros((2, self.states, len(f) + len(moved)))
        whole_q[: count + len(moved)], whole_v[count + len(moved) :] = of_q, of_v
        return np.concatenate([f, moved]), whole_q, whole_v


def _with_columns(matrix: csc_array, moved: list[Moved], k: int) -> csc_array:
    """A matrix with the columns of what is moved that it has not, the k-th of each."""
    for one in moved:
        if one.columns is not None:
            rows = np.arange(matrix.shape[0])
            entries = (one.columns[k], (rows, np.full(len(rows), one.unknown)))
            matrix = csc_array(matrix + coo_array(entries, shape=matrix.shape))
    return matrix


def all_modes(K: FloatArray, M: FloatArray) -> tuple[FloatArray, FloatArray]:
    """All modes of K x = w M x, ascending, x.M x = 1: the lower ones by the inverse, to their own round-off.

    That of the highest w is in the lower ones of a direct solution, that of the inverse of the lowest in the
    higher ones of the other; they part where both are small, and not between equal ones.
    """
    values, vectors = eigh(K, M)
    shift = -1e-6 * float(np.abs(K).sum() / np.abs(M).sum())
    count = _parting(values, -shift)
    if count and shift < 0.0:
        values[:count], vectors[:, :count] = dense(K, M, count, shift)
    return values, vectors @ (1.5 * np.eye(len(M)) - 0.5 * (vectors.T @ M @ vectors))


def _parting(values: FloatArray, shift: float) -> int:
    """How many of the values, ascending, are found by the inverse."""
    best = np.sqrt(max(values[-1], 0.0) * shift)
    above = np.maximum(values, 1e-3 * shift)
    ratio = above[1:] / above[:-1]
    middle = np.sqrt(above[1:] * above[:-1])
    near = np.flatnonzero((ratio > APART) & (middle > best / NEAR) & (middle < best * NEAR))
    if not len(near):
        return len(values) if values[-1] < NEAR * best else 0
    return int(near[np.argmax(ratio[near])]) + 1


def forces_of(made: Damped, name: str) -> FloatArray:
    """Forces of an input on all unknowns along their own axes, per unit of it, (n,)."""
    inputs, first = made.system.inputs, made.system.inputs.given[name]

    def pushed(by: float) -> FloatArray:
        inputs.give(name, first + by)
        try:
            return -_out_of_balance(made, made.q, made.v, made.a, loads_alone=True)
        finally:
            inputs.give(name, first)

    found: FloatArray = slope(pushed, max(abs(first), 1.0))
    return found


def columns_of(made: Damped, unknown: int) -> FloatArray:
    """Columns of mass, damping and stiffness of a length that a winch changes, (3, n)."""
    size = float(made.q[unknown])

    def column(k: int) -> FloatArray:
        def changed(by: float) -> FloatArray:
            a, v, q = (x.copy() for x in (made.a, made.v, made.q))
            (a, v, q)[k][unknown] += by
            return _out_of_balance(made, q, v, a)

        return slope(changed, 1e-2 * size)

    return np.array([column(k) for k in range(3)])


def _out_of_balance(
    made: Damped, q: FloatArray, v: FloatArray, a: FloatArray, loads_alone: bool = False
) -> FloatArray:
    """Forces out of balance along the axes of the unknowns, (n,); of loads alone where these alone change."""
    system, core = made.system, made.system.core
    before = core.loads.value.copy()
    core.loads.value[:] = system.inputs.moment(made.time, (q, v)).value[0]
    f, r = np.zeros(system.size), np.zeros(system.size)
    apply_load(core.loads, core.loads.value, f)
    residual(core.external if loads_alone else core.batches, core.ws, q, v, a, f, r)
    core.loads.value[:] = before
    found: FloatArray = made.axes.T @ physical(system, r)
    return found


def slope(value: Callable[[float], FloatArray], step: float) -> FloatArray:
    """Derivative of value(x) at 0 by differences of order four, with a step at which it has settled.

    Raises
    ------
    ModelError
        What the value itself raises, however small the step.
    """
    best, least, before = np.zeros(()), np.inf, None
    for attempt in range(QUARTERS):
        try:
            near, far = ((value(x) - value(-x)) / (2.0 * x) for x in (step, 2.0 * step))
        except ModelError:
            if attempt == QUARTERS - 1:
                raise
            step *= 0.25
            continue
        found = (4.0 * near - far) / 3.0
        change = np.inf if before is None else float(np.max(np.abs(found - before), initial=0.0))
        if before is None or change < least:
            best, least = found, change
        if change <= SETTLED * np.max(np.abs(found), initial=0.0):
            break
        before, step = found, 0.25 * step
    return best
