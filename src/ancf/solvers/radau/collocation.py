"""Radau IIA collocation: coefficients, eigenvalues, dense output and the embedded error formula.

With nodes c_1 < ... < c_s = 1 and the polynomials l_j of degree s - 1 that are 1 at c_j and 0 at the other
nodes,

    a_ij = int_0^{c_i} l_j,      V_i = v_n + h sum_j a_ij A_j,      Q_i = q_n + h sum_j a_ij V_j.

Order 2s - 1, stage order s, L-stable, stiffly accurate (the last stage is the end of the step).
Reference: Hairer & Wanner, Solving Ordinary Differential Equations II, sections IV.5 and IV.8.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import FloatArray

ComplexArray = NDArray[np.complex128]

#: Nodes by number of stages.
NODES = {
    2: (1 / 3, 1.0),
    3: ((4 - 6**0.5) / 10, (4 + 6**0.5) / 10, 1.0),
}


@dataclass(frozen=True)
class Collocation:
    """Coefficients of a Radau IIA method with s stages.

    Attributes
    ----------
    c : ndarray, shape (s,)
        Nodes.
    a, inverse : ndarray, shape (s, s)
        Runge-Kutta matrix and its inverse.
    b : ndarray, shape (s,)
        Weights, the last row of ``a``.
    mu : ndarray of complex, shape (m,)
        Eigenvalues of ``a``, one of each conjugate pair; a real one comes first.
    to_modes, from_modes : ndarray of complex, shape (m, s) and (s, m)
        ``to_modes @ x`` are the parts of stage values x that belong to ``mu``; the real part of
        ``from_modes @ z`` makes stage values of them, both parts of a pair included.
    gamma, e : float and ndarray, shape (s,)
        Error formula: h gamma f(y_n) + sum e_i (Y_i - y_n) is of the size h^(s + 1).
    """

    c: FloatArray
    a: FloatArray
    inverse: FloatArray
    b: FloatArray
    mu: ComplexArray
    to_modes: ComplexArray
    from_modes: ComplexArray
    gamma: float
    e: FloatArray

    @property
    def stages(self) -> int:
        """Number of stages s."""
        return len(self.c)

    def integrals(self, tau: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Values of l_j, their integrals and double integrals from 0 to tau, each (m, s)."""
        k = np.arange(self.stages)
        powers = np.asarray(tau, dtype=np.float64)[:, None] ** k
        basis = np.linalg.inv(self.c[:, None] ** k)  # column j: coefficients of l_j
        t = np.asarray(tau, dtype=np.float64)[:, None]
        once, twice = powers * t / (k + 1), powers * t**2 / ((k + 1) * (k + 2))
        return powers @ basis, once @ basis, twice @ basis


def collocation(stages: int) -> Collocation:
    """Coefficients of the method with 2 or 3 stages."""
    c = np.array(NODES[stages])
    k = np.arange(stages)
    powers = c[:, None] ** k
    a: FloatArray = np.asarray((powers * c[:, None] / (k + 1)) @ np.linalg.inv(powers), dtype=np.float64)
    mu, T = _modes(a)
    inverse = np.asarray(np.linalg.inv(a), dtype=np.float64)
    # the embedded quadrature has the weight gamma at the start of the step and is exact to degree s - 1
    gamma = 1.0 / float(np.real(1.0 / mu[0]))
    moments = 1.0 / (k + 1)
    moments[0] -= gamma
    e = (np.linalg.solve(powers.T, moments) - a[-1]) @ inverse
    pair = np.where(np.abs(mu.imag) > 1e-9, 2.0, 1.0)
    whole = np.linalg.inv(np.column_stack([T, T[:, pair > 1].conj()]))
    to_modes = whole[: len(mu)].astype(np.complex128)
    return Collocation(c, a, inverse, a[-1].copy(), mu, to_modes, T * pair, gamma, e)


def _modes(a: FloatArray) -> tuple[ComplexArray, ComplexArray]:
    """Eigenvalues and vectors of ``a``, the real one first, one of each conjugate pair."""
    values, vectors = np.linalg.eig(a)
    keep = [i for i in np.argsort(np.abs(values.imag)) if values[i].imag > -1e-9]
    mu: ComplexArray = values[keep].astype(np.complex128)
    mu.imag[np.abs(mu.imag) < 1e-9] = 0.0
    return mu, vectors[:, keep].astype(np.complex128)
