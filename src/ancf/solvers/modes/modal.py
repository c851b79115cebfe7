"""Natural modes about an equilibrium: K x = omega^2 M x on the free unknowns.

A neutral motion, such as a rigid one of a body that nothing holds, comes out with an omega^2 of round-off
of either sign.  It counts as zero when x.K x is no larger than what it changes by with the last digits of
the state and of the products, whatever the other modes are.  Whether the lowest mode has been
found at all is a matter of inertia: K - sigma M has a negative pivot for each eigenvalue below sigma
(Sylvester), and sigma is lowered until none is left.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import numpy as np
from numpy.linalg import LinAlgError

from ...arrays import FloatArray, IntArray
from ...batches import Batches
from ...compiled import traits
from ...errors import SolveError
from ...later import LinearOperator, SuperLU, csc_array, eigh, eigsh, null_space, splu
from ...linalg.sparse import to_sparse
from ...model import checks
from ...system.at_rest import assemble_at_rest
from ...system.contacts import touching
from ...system.core import follow_supports, restrict
from ...system.system import System
from ..derivatives.differences_of_forces import Differences, axes_of, without_noise
from ..statics.free_spin import FREE_SPIN, Spin
from ..statics.roundoff import shaken

MANY = 4000  # unknowns up to which joints are eliminated by dense algebra
DENSE = 300  # unknowns up to which all modes are computed by dense algebra
CROSSED = 1500  # unknowns up to which cables that cross are differentiated
MORE = 2.0  # times x.K x: an eigenvalue that is round-off
SURELY, ROUNDED = 30.0, 3.0  # times the round-off of x.K x: what is surely negative; what is zero
LOWERED = 60  # times that the shift is lowered


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
    whole = csc_array(_matrix(system, q, 0.0, 1.0) + contacts_about(system, q))
    K, C = csc_array(whole[free][:, free]), csc_array(whole[lam][:, free])
    M = csc_array(_matrix(system, q, 1.0, 0.0)[free][:, free])
    values, vectors = _eigen(K, M, C, count)
    for k in range(count):
        own, noise, spin = _own_stiffness(system, q, K, vectors[:, k], free)
        if values[k] < 0.0 and own < -(
            SURELY * max(noise, _noise(system, q, vectors[:, k], free, True)) + spin
        ):
            what = f"mode {k + 1} has omega^2 = {values[k]:.4g} 1/s^2: the state is not a stable equilibrium"
            raise SolveError("modes", what, "give about=ancf.equilibrium(model)")
        seen = own if own > ROUNDED * noise else 0.0
        if 0.0 < values[k] < MORE * seen:
            break  # so are those above
        values[k] = seen if values[k] > 0.0 else 0.0  # x.K x has more digits of what is nearly nothing
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
        Z = motions(C.toarray(), M.diagonal())
        K, M = csc_array(Z.T @ (K @ Z)), csc_array(Z.T @ (M @ Z))
        values, vectors = _eigen(K, M, csc_array((0, K.shape[0])), count)
        return values, Z @ vectors
    shift = -1e-6 * float(abs(K).sum() / abs(M).sum())  # below zero: K alone may be singular
    if n <= DENSE or count > n // 3:
        return dense(K.toarray(), M.toarray(), count, shift)
    lu, shift = _below_all(K, M, shift)
    start = np.random.default_rng(1).standard_normal(n)
    inverse = LinearOperator((n, n), matvec=lu.solve, dtype=np.float64)
    try:
        values, vectors = eigsh(K, k=count, M=M, sigma=shift, which="LM", v0=start, OPinv=inverse)
    except RuntimeError as error:  # more neutral motions than modes were asked for
        if n <= MANY:
            return dense(K.toarray(), M.toarray(), count, shift)
        hint = "hold what moves without a force, or ask for more modes"
        raise SolveError("modes", f"the iteration does not end: {error}", hint) from None
    order = np.argsort(values)
    return values[order], vectors[:, order]


def motions(C: FloatArray, mass: FloatArray) -> FloatArray:
    """A basis of the motions x with C x = 0, as columns, for unknowns with these entries of the mass matrix.

    It is orthonormal when each unknown is measured by its own mass: places of a small body are much larger
    than its directions, or much smaller, as the unit of lengths is, and the ones would leave nothing but
    round-off of the others.
    """
    own = np.sqrt(mass)
    own[own == 0.0] = np.max(own)
    rows = C / own
    rows /= np.linalg.norm(rows, axis=1, keepdims=True)
    basis: FloatArray = null_space(rows) / own[:, None]
    return basis


def _below_all(K: csc_array, M: csc_array, shift: float) -> tuple[SuperLU, float]:
    """Factors of K - shift M and a shift, the given one or less, below all eigenvalues."""
    for _ in range(LOWERED):
        try:  # pivots on the diagonal: their signs are those of the eigenvalues
            lu = splu(
                csc_array(K - shift * M),
                permc_spec="MMD_AT_PLUS_A",
                diag_pivot_thresh=0.0,
                options={"SymmetricMode": True},
            )
        except RuntimeError:  # exactly singular
            shift *= 3.0
            continue
        if np.all(lu.U.diagonal() > 0.0):
            return lu, shift
        shift *= 10.0
    raise SolveError("modes", "there is no lowest mode", "check stiffnesses and masses")


def _own_stiffness(
    system: System, q: FloatArray, K: csc_array, x: FloatArray, free: IntArray
) -> tuple[float, float, float]:
    """x.K x, its round-off, and the share of spins in it that an equilibrium leaves open.

    x has the unknowns ``free``.
    """
    own = float(x @ (K @ x))
    terms = float(np.abs(x) @ (abs(K) @ np.abs(x)))
    noise = _noise(system, q, x, free, False) + np.finfo(float).eps * terms
    spin, whole = Spin(system, system.core.supports.held), np.zeros(system.n)
    whole[free] = x
    return own, noise, FREE_SPIN * float(whole @ spin.times(whole, q))


def _noise(system: System, q: FloatArray, x: FloatArray, free: IntArray, strained: bool) -> float:
    """What last digits of the state change of x.K x, see :func:`shaken`."""
    near = (q, *shaken(system, q, strained))
    first, *others = (float(x @ (_matrix(system, one, 0.0, 1.0)[free][:, free] @ x)) for one in near)
    return max(abs(other - first) for other in others)


def dense(K: FloatArray, M: FloatArray, count: int, shift: float) -> tuple[FloatArray, FloatArray]:
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
    with unscaled(system):
        assemble_at_rest(core.batches, core.ws, q, core.A, mass, 0.0, stiffness)
    restrict(core.supports, core.A)
    return to_sparse(core.A, system.places)


def contacts_about(system: System, q: FloatArray) -> csc_array:
    """Stiffness of contacts that stay out of the matrix, (n, n), of cables that cross with normals that turn.

    The latter by differences, of models with up to CROSSED unknowns; of larger ones normals are as they are.
    """
    core, n = system.core, system.n
    found = touching(core, q, n).matrix()
    own = Batches([batch for batch in core.batches if traits(batch).rows is not None])
    if not len(own) or n > CROSSED:
        return found
    touches = touching(core._replace(batches=own), q, n)
    if not len(touches.stiffness):
        return found
    by_place, axes = Differences(system, own).at(q, np.zeros_like)[0], axes_of(system)
    slopes = csc_array(axes.T @ csc_array(0.5 * (by_place + by_place.T)) @ axes)
    return csc_array(found + without_noise(slopes, touches.matrix()))


@contextmanager
def unscaled(system: System) -> Iterator[None]:
    """The matrices themselves, without the multiples of C^T C that help a solve.

    They do nothing among motions with C x = 0, but with what a gap leaves of their second derivatives.
    """
    joints = system.parts.get("joints")
    if joints is None:
        yield
        return
    kept = joints.scale.copy()
    joints.scale[:] = 0.0
    try:
        yield
    finally:
        joints.scale[:] = kept
