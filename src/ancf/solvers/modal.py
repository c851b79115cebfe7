"""Natural modes about an equilibrium: K x = omega^2 M x on the free unknowns."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import LinAlgError, eigh, null_space
from scipy.sparse import csc_array
from scipy.sparse.linalg import eigsh

from ..errors import SolveError
from ..linalg.sparse import to_sparse
from ..model import checks
from ..system.contacts import touching
from ..system.core import assemble, follow_supports, restrict
from ..system.system import System

FloatArray = NDArray[np.float64]

MANY = 4000  # unknowns up to which joints are eliminated by dense algebra
DENSE = 300  # unknowns up to which all modes are computed by dense algebra


def natural_modes(system: System, q: FloatArray, count: int) -> tuple[FloatArray, FloatArray]:
    """Lowest modes about the state vector q.

    Returns
    -------
    omega : ndarray, shape (count,)
        Angular frequencies, rad/s.
    shapes : ndarray, shape (count, size)
        State vectors of the shapes, normed to x.M x = 1.

    Raises
    ------
    ModelError
        More modes are wanted than there are free unknowns.
    SolveError
        The state is not a stable equilibrium: a mode has a negative stiffness.
    """
    free = np.setdiff1d(system.free, system.multipliers)
    lam = np.intersect1d(system.free, system.multipliers)
    checks.integer(count, "modes.count", 1, len(free) - len(lam))
    system.level[:] = 1.0, 0.0, 0.0
    whole = _matrix(system, q, 0.0, 1.0)
    whole = csc_array(whole + touching(system.core, q, system.n).matrix())
    K, C = whole[free][:, free], csc_array(whole[lam][:, free])
    M = _matrix(system, q, 1.0, 0.0)[free][:, free]
    values, vectors = _eigen(csc_array(K), csc_array(M), C, count)
    scale = max(float(np.max(np.abs(values))), 1e-300)
    if values[0] < -1e-6 * scale:
        what = f"mode 1 has omega^2 = {values[0]:.4g} 1/s^2: the state is not a stable equilibrium"
        raise SolveError("modes", what, "give about=ancf.equilibrium(model)")
    shapes = np.zeros((count, system.size))
    shapes[:, free] = vectors.T
    for shape in shapes:
        follow_supports(system.core.supports, shape, np.zeros_like(shape), np.zeros_like(shape))
    return np.sqrt(np.maximum(values, 0.0)), shapes


def _eigen(K: csc_array, M: csc_array, C: csc_array, count: int) -> tuple[FloatArray, FloatArray]:
    """Lowest modes among the motions x with C x = 0."""
    n, m = K.shape[0], C.shape[0]
    if m:
        if n > MANY:
            raise SolveError("modes", f"{n} unknowns with joints, the most are {MANY}", "take fewer elements")
        Z = null_space(C.toarray())
        K, M = csc_array(Z.T @ (K @ Z)), csc_array(Z.T @ (M @ Z))
        values, vectors = _eigen(K, M, csc_array((0, K.shape[0])), count)
        return values, Z @ vectors
    shift = -1e-6 * abs(K).sum() / abs(M).sum()  # below zero: K alone may be singular
    if n <= DENSE or count > n // 3:
        return _dense(K.toarray(), M.toarray(), count, shift)
    start = np.random.default_rng(1).standard_normal(n)
    values, vectors = eigsh(K, k=count, M=M, sigma=shift, which="LM", v0=start)
    order = np.argsort(values)
    return values[order], vectors[:, order]


def _dense(K: FloatArray, M: FloatArray, count: int, shift: float) -> tuple[FloatArray, FloatArray]:
    """Lowest modes by way of M x = mu (K - shift M) x.

    The largest mu come out to their own round-off; that of the highest frequency, which is very high for
    the thickness of a thin beam, would be added to the lowest omega^2 otherwise.
    """
    n = len(K)
    try:
        mu, vectors = eigh(M, K - shift * M, subset_by_index=(n - count, n - 1))
    except LinAlgError:  # not positive definite: no stable equilibrium
        values, vectors = eigh(K, M, subset_by_index=(0, count - 1))
        return values, vectors
    return 1.0 / mu[::-1] + shift, (vectors / np.sqrt(mu))[:, ::-1]


def _matrix(system: System, q: FloatArray, mass: float, stiffness: float) -> csc_array:
    """Whole matrix mass M + stiffness K with the supports applied."""
    core = system.core
    assemble(core.batches, core.ws, q, np.zeros_like(q), core.A, mass, 0.0, stiffness)
    restrict(core.supports, core.A)
    return to_sparse(core.A, system.places)
