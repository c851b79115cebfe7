"""Largest stable step of central differences: the fastest vibration of the present shape.

The largest eigenvalue of L^-1 K L^-T, with M = L L^T, comes from Lanczos' method in the inner product of
the mass matrix; its residual bounds the error.  Reference: Parlett, The Symmetric Eigenvalue Problem,
chapter 13.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ...arrays import FloatArray
from ...errors import SolveError
from ...later import csc_array, eigh_tridiagonal
from ...linalg.sparse import to_sparse
from ...model.surfaces.cable_contact import CableContact
from ...model.surfaces.surface import SurfaceContact
from ...system.core import assemble, restrict, solve_matrix
from ...system.system import System
from .steps import mass_factor

#: Relative error of the eigenvalue, and the most Lanczos steps for it.
SHARP, MOST_VECTORS = 2e-3, 200
#: Parts of the highest frequency that are looked at, halvings of the step, and a growth that is none.
PARTS, HALVINGS, STEADY = (0.0, 0.25, 0.5, 0.75, 1.0), 40, 1e-9


def stable_limit(system: System, q: FloatArray, v: FloatArray) -> float:
    """Largest step for which small vibrations about a state do not grow, s; inf if nothing vibrates.

    Leaves the factors of the mass matrix in the system's core.

    Raises
    ------
    SolveError
        The mass matrix is singular, or the fastest vibration is beyond the numbers that there are.
    """
    core = system.core
    if mass_factor(core, q, v) < 0:
        raise SolveError("start", "the mass matrix is singular", "an explicit method needs a mass everywhere")
    omega = np.sqrt(_largest(system, q, v, 0.0, 1.0))
    resists = core.damped or any(len(batch.base) > 0 for batch in core.external)
    damping = _largest(system, q, v, 1.0, 0.0) if resists else 0.0
    stiff, drag = _of_grounds(system)
    return limit(float(np.hypot(omega, np.sqrt(stiff))), damping + drag)


def _of_grounds(system: System) -> tuple[float, float]:
    """Bounds of what grounds and surfaces add to omega^2 and to the damping once a body touches them."""
    stiff, drag = [0.0], [0.0]
    for ground in system.model.grounds:
        for name, beam in system.model.beams.items():
            if ground.acts_on(name) and beam.section.diameter is not None:
                share = beam.section.diameter / beam.section.rhoA
                stiff.append(share * max(ground.stiffness, ground.stick or 0.0))
                drag.append(
                    share * ground.damping * np.sqrt(max(1.0, (ground.stick or 0.0) / ground.stiffness))
                )
    for item in system.model.connections:
        if isinstance(item, SurfaceContact | CableContact):
            k, stick = item.stiffness, item.stick or item.stiffness
            both = [item.body] if isinstance(item, SurfaceContact) else [item.body, item.other]
            mass = 1.0 / sum(1.0 / body.section.rhoA for body in both)
            stiff.append(max(k, stick if item.friction else 0.0) / mass)
            drag.append(item.damping * float(np.sqrt(max(1.0, stick / k))) / mass)
    return max(stiff), float(max(drag))


def limit(omega: float, damping: float) -> float:
    """Largest stable step for u'' = -omega^2 u - damping u', s."""
    if omega == 0.0 and damping == 0.0:
        return np.inf
    high = min(2.0 / omega if omega > 0.0 else np.inf, 1.0 / damping if damping > 0.0 else np.inf)
    if damping == 0.0:
        return high
    low = 0.0
    for _ in range(HALVINGS):
        h = 0.5 * (low + high)
        growth = max(_growth(part * omega * h, damping * h) for part in PARTS)
        low, high = (h, high) if growth <= 1.0 + STEADY else (low, h)
    return low


def _growth(omega_h: float, d: float) -> float:
    """Spectral radius of a step of (u, h v, h^2 a) when the damping force sees v_n + h a_n."""
    q = np.array([1.0, 1.0, 0.5])
    a = -(omega_h**2) * q - d * np.array([0.0, 1.0, 1.0])
    v = np.array([0.0, 1.0, 0.5]) + 0.5 * a
    return float(np.max(np.abs(np.linalg.eigvals(np.stack([q, v, a])))))


def _largest(system: System, q: FloatArray, v: FloatArray, damping: float, stiffness: float) -> float:
    """Largest eigenvalue of M^-1 (damping D + stiffness K), at least 0; an upper bound, sharp."""
    core, free = system.core, system.free
    values, x = np.empty(system.places.size), np.zeros(system.n)
    assemble(core.batches, core.ws, q, v, values, 0.0, damping, stiffness)
    restrict(core.supports, values)
    K = csc_array(to_sparse(values, system.places)[free][:, free])
    scale = float(np.max(np.abs(K.data), initial=0.0))
    if scale == 0.0:
        return 0.0
    K.data /= scale  # products of very large stiffnesses would overflow

    def solve(r: FloatArray) -> FloatArray:
        x[:] = 0.0
        x[free] = r
        solve_matrix(core.factor, x)
        return x[free]

    with np.errstate(all="ignore"):
        found = scale * max(lanczos(lambda y: K @ y, solve, len(free)), 0.0) if np.isfinite(scale) else np.inf
    if not np.isfinite(found):
        what = "the fastest vibration of the model is too fast to be computed"
        raise SolveError("start", what, "see whether stiffnesses, masses and lengths are as meant")
    return found


def lanczos(
    apply: Callable[[FloatArray], FloatArray], solve: Callable[[FloatArray], FloatArray], n: int
) -> float:
    """Largest eigenvalue of M^-1 K from x -> K x and r -> M^-1 r; Ritz value plus its error bound."""
    r = np.random.default_rng(1).standard_normal(n)
    p = solve(r)
    norm = np.sqrt(np.sum(p * r))
    vectors, duals = [p / norm], [r / norm]
    diagonal: list[float] = []
    beside: list[float] = []
    value, error = 0.0, 0.0
    for k in range(min(n, MOST_VECTORS)):
        r = apply(vectors[-1])
        diagonal.append(float(np.sum(vectors[-1] * r)))
        for x, u in zip(vectors, duals, strict=True):  # against round-off, with all former ones
            r = r - np.sum(x * r) * u
        p = solve(r)
        norm = float(np.sqrt(max(np.sum(p * r), 0.0)))
        if not np.isfinite(norm + diagonal[-1]):
            return np.inf
        values, shapes = eigh_tridiagonal(np.array(diagonal), np.array(beside))
        value = float(values[-1])
        error = norm * abs(float(shapes[-1, -1]))
        if error <= SHARP * abs(value) or norm <= 1e-14 * max(np.max(np.abs(values)), 1e-300) or k == n - 1:
            break
        vectors.append(p / norm)
        duals.append(r / norm)
        beside.append(norm)
    return value + error
