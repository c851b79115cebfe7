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

from dataclasses import dataclass

import numpy as np
from numpy.linalg import LinAlgError

from ...arrays import FloatArray, IntArray
from ...errors import ModelError, SolveError
from ...later import csc_array, eigh
from .damped_modal import Damped
from .linear_moved import Moved, along_of, more_of, reading_of
from .modal import dense, motions
from .quadratic import NEUTRAL, SHIFT, UNSEEN

#: Share of a motion of a support by which joints may be open.
OPEN = 1e-8
#: Ratio of two squares of frequencies that are apart, and how far from the best place they are looked for.
APART, NEAR = 1.01, 1e3


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
        self.M, self.D, self.K = (csc_array(axes.T @ x @ axes) for x in parts)
        self.physical = parts[2]
        mass = self.M[f][:, f].toarray()
        Z = motions(self.K[lam][:, f].toarray(), np.diag(mass).copy()) if len(lam) else np.eye(len(f))
        self.own = np.sqrt(np.maximum(np.diag(mass), 0.0))
        self.own[self.own == 0.0] = np.max(self.own)
        self.squares, self.shapes = self._modes(Z, mass)
        self.along = along_of(moved, made.system.n)
        more = more_of(moved, made.system.n)
        self.columns = [x @ self.along + y for x, y in zip((self.M, self.D, self.K), more, strict=True)]
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
                held = self.made.system.numbering.describe(int(one.unknowns[0]))
                what = f"{held} cannot move: joints hold it"
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
        r = np.zeros((system.n, width))
        r[:, self._inputs] -= self.forces
        q, v, a = np.zeros((3, system.n, width))
        parts = (self.K, self.D, self.M)
        for x, (free, moved), A, c in zip((q, v, a), self._unknowns, parts, self.columns[::-1], strict=True):
            x[f] = free
            r += A @ x + c @ moved
            x += self.along @ moved
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
        places : ndarray, shape (k,)
            In state vectors.
        of_q, of_v : ndarray, shape (states, k)
        """
        f, count, moves = self.made.free, len(self.squares), len(self.moved)
        places, read = reading_of(self.moved)
        m, first = self._moments
        projected = self.shapes.T @ self.M[f][:, f]
        beside = -projected @ self.follows
        of_q, of_v = np.zeros((2, self.states, len(f) + len(places)))
        of_q[:count, : len(f)] = of_v[count + moves : 2 * count + moves, : len(f)] = projected
        of_q[:count, len(f) :] = beside @ read
        of_q[count : count + moves, len(f) :] = read
        beside[:, first] += m
        of_v[count + moves : 2 * count + moves, len(f) :] = beside @ read
        of_v[2 * count + moves :, len(f) :] = read[~first]
        return np.concatenate([f, places]), of_q, of_v


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
