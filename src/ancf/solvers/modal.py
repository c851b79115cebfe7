"""Natural modes about an equilibrium: K x = omega^2 M x on the free unknowns."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import eigh
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import eigsh

from ..errors import SolveError
from ..model import checks
from ..system.core import assemble, follow_supports, restrict
from ..system.matrix import Places
from ..system.system import System

FloatArray = NDArray[np.float64]

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
    free = system.free
    checks.integer(count, "modes.count", 1, len(free))
    K = _matrix(system, q, 0.0, 1.0)[free][:, free]
    M = _matrix(system, q, 1.0, 0.0)[free][:, free]
    values, vectors = _eigen(csc_array(K), csc_array(M), count)
    scale = max(float(np.max(np.abs(values))), 1e-300)
    if values[0] < -1e-6 * scale:
        what = f"mode 1 has omega^2 = {values[0]:.4g} 1/s^2: the state is not a stable equilibrium"
        raise SolveError("modes", what, "give about=ancf.equilibrium(model)")
    shapes = np.zeros((count, system.size))
    shapes[:, free] = vectors.T
    for shape in shapes:
        follow_supports(system.core.supports, shape, np.zeros_like(shape), np.zeros_like(shape))
    return np.sqrt(np.maximum(values, 0.0)), shapes


def _eigen(K: csc_array, M: csc_array, count: int) -> tuple[FloatArray, FloatArray]:
    n = K.shape[0]
    if n <= DENSE or count > n // 3:
        values, vectors = eigh(K.toarray(), M.toarray(), subset_by_index=(0, count - 1))
        return values, vectors
    shift = -1e-6 * abs(K).sum() / abs(M).sum()  # below zero: K alone may be singular
    start = np.random.default_rng(1).standard_normal(n)
    values, vectors = eigsh(K, k=count, M=M, sigma=shift, which="LM", v0=start)
    order = np.argsort(values)
    return values[order], vectors[:, order]


def _matrix(system: System, q: FloatArray, mass: float, stiffness: float) -> csc_array:
    """Whole matrix mass M + stiffness K with the supports applied."""
    core = system.core
    assemble(core.batches, core.ws, q, np.zeros_like(q), core.A, mass, 0.0, stiffness)
    restrict(core.supports, core.A)
    return to_sparse(core.A, system.places)


def to_sparse(A: FloatArray, places: Places) -> csc_array:
    """Whole symmetric matrix of block values."""
    n = places.n
    rows = np.concatenate([np.arange(n), places.rows])
    cols = np.concatenate([np.arange(n), places.column])
    i = 6 * rows[:, None] + np.repeat(np.arange(6), 6)
    j = 6 * cols[:, None] + np.tile(np.arange(6), 6)
    values = A.reshape(-1, 36)
    below = slice(n, None)
    ij = (
        np.concatenate([i.ravel(), j[below].ravel()]),
        np.concatenate([j.ravel(), i[below].ravel()]),
    )
    return csc_array(
        coo_array((np.concatenate([values.ravel(), values[below].ravel()]), ij), shape=(6 * n, 6 * n))
    )
