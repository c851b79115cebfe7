"""Derivatives of an equilibrium, by the implicit function theorem: K s = -R_p."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..arrays import FloatArray, IntArray
from ..errors import SolveError
from ..later import LinearOperator, csc_array, gmres, splu
from ..linalg.sparse import to_sparse
from ..solvers.derivatives.directions import products_along
from ..solvers.derivatives.sensitivity import Way
from ..solvers.statics.equilibrium import STENCIL_STEP
from ..system.contacts import touching
from ..system.core import Core, assemble, follow_supports, place_supports, restrict
from ..system.system import System
from .base import matrices_of, moved_with
from .family import Family
from .leaning import Leaning
from .nearby import Nearby
from .remembering import friction_of
from .values import Push

#: Residual of the equations, relative to their right-hand side, that is aimed at and that is accepted; part
#: of the solution by which what is left may change it: on stiff grounds that is round-off of places.
AIMED, ACCEPTED, CHANGED = 1e-13, 1e-8, 1e-7
#: Part of what is left of a right-hand side that a correction may leave if another one is to follow.
HELPS = 0.1
#: Directions of a search before it begins again, and how often it does.
DIRECTIONS, AGAIN = 60, 5


def of_equilibrium(
    system: System,
    core: Core,
    q: FloatArray,
    time: float,
    families: list[Family],
    friction: Leaning | None = None,
) -> list[tuple[FloatArray, FloatArray]]:
    """Derivatives of the state vectors q and v of an equilibrium, (size,) each, by family.

    Parameters
    ----------
    system : System
        That found it: its contacts and joints are as they are in it.
    core : Core
        Of the system, perhaps with bodies that are held altogether.
    q : (size,)
    time : float, s
    families : list of Family
    friction : Leaning, optional
        That remembers the way; the derivatives of its memory are filled.

    Raises
    ------
    SolveError
        The equilibrium is neutral: it has no derivative.
    """
    if friction is not None:
        friction.begin(_leant(system, core, time, families, friction))
    system.level[:] = 1.0, 0.0, 0.0
    h, q, zero = STENCIL_STEP, q.copy(), np.zeros_like(q)
    tables = system.inputs.tables(time - h, h, 1, time, np.inf)
    place_supports(core.supports, core.loads.value, tables, 0, q, zero, zero.copy())
    solve, stiff = _solver(system, core, q, friction)
    found, left = [], np.setdiff1d(core.supports.held, system.held)
    leans = friction is not None or friction_of(system)  # whose forces at rest batches alone do not tell
    plain = {} if leans else _plainly(system, core, q, families, (time - h, h, time, np.inf))
    for k, family in enumerate(families):
        family.know(system)
        push = plain[k] if k in plain else family.at_rest(core, q, (time, h))
        own = _described(core, family, left, time)
        if np.any(own):
            push.push[0, : system.n] += stiff(own)
        if friction is not None:
            push.push[0] += friction.push(k) + friction.times(_followed(core, push.held[0, 0].copy()))
        s = solve(push.push[0], family.name)
        dq = _followed(core, s) + own + push.held[0, 0]
        found.append((dq, family.of_motion(q, dq, time)))
    if friction is not None:
        friction.end(np.array(found))
    return found


def _plainly(
    system: System, core: Core, q: FloatArray, families: list[Family], when: tuple[float, float, float, float]
) -> dict[int, Push]:
    """What parameters that change no support and no row of a joint do to a state at rest, by family."""
    nearby, zero, none = Nearby(families, system), np.zeros((1, q.size)), np.zeros((3, 1, q.size))
    tables = system.inputs.tables(*when[:2], 1, *when[2:])
    motion, rotation = tables.motion.copy(), tables.rotation.copy()
    motion[..., 1:], rotation[:, :, 1:] = 0.0, 0.0  # supports that move count as at rest
    tables = tables._replace(motion=motion, rotation=rotation)
    nearby.know()
    pushes = nearby.plain_at_steps(Way(q[None].copy(), zero.copy(), zero.copy()), when, tables)
    pushes[..., core.supports.held] = 0.0
    each = zip(nearby.plain, pushes, strict=True)
    return {k: Push(push, zero, none) for k, push in each if families[k].plain}


def _leant(system: System, core: Core, time: float, families: list[Family], friction: Leaning) -> FloatArray:
    """Derivatives of the shape from which friction acts, (p, 2, size)."""
    q, h = friction.shape, STENCIL_STEP
    if friction.laid:
        friction.leave_out()
        rows = [dq for dq, _ in of_equilibrium(system, core, q, time, families)]
    else:
        rows = []
        for family in families:
            family.know(system)
            d = family.of_states(time)[0].copy()
            d[core.supports.held] = 0.0
            d[system.n :] = 0.0
            rows.append(_followed(core, d + family.at_rest(core, q, (time, h)).held[0, 0]))
    return np.stack([rows, np.zeros((len(rows), q.size))], axis=1)


def _described(core: Core, family: Family, left: IntArray, time: float) -> FloatArray:
    """Derivative of the places of bodies that are left out of an equilibrium, where they are described."""
    own = np.zeros(family.base.size)
    if len(left):
        own[left] = family.of_states(time)[0][left]
    return _followed(core, own)


def _followed(core: Core, d: FloatArray) -> FloatArray:
    """The same derivative, the shadows of its free unknowns filled."""
    follow_supports(core.supports, d, np.zeros_like(d), np.zeros_like(d))
    return d


def _solver(system: System, core: Core, q: FloatArray, friction: Leaning | None):  # type: ignore[no-untyped-def]
    """A function that solves K s = -push, with the exact K of the state, and one that makes K d of held d."""
    n, still = system.n, np.zeros_like(q)
    m = moved_with(system, matrices_of(core, q.size, moving=False))
    assemble(core.batches, core.ws, q, still, core.A, 0.0, 0.0, 1.0)
    restrict(core.supports, core.A)
    K = csc_array(to_sparse(core.A, system.places) + touching(core, q, n).matrix())
    try:
        lu = splu(K)
    except RuntimeError:
        raise _neutral() from None
    d, r = np.zeros((3, q.size)), np.empty_like(q)

    def stiff(x: FloatArray) -> FloatArray:
        d[:] = 0.0
        d[0, :] = x
        products_along(core, m, q, still, still, d, np.zeros((0, 3, 3)), still, r)
        y: FloatArray = r[:n] + (0.0 if friction is None else friction.times(d[0])[:n])
        y[core.supports.held] = 0.0
        return y

    def times(x: FloatArray) -> FloatArray:
        d[:] = 0.0
        d[0, :n] = x
        d[0, core.supports.held] = 0.0
        products_along(core, m, q, still, still, d, np.zeros((0, 3, 3)), still, r)
        y: FloatArray = r[:n].copy()
        if friction is not None:
            y += friction.times(d[0])[:n]
        y[core.supports.held] = x[core.supports.held]
        return y

    def solve(push: FloatArray, name: str) -> FloatArray:
        b, s = -push[:n], np.zeros_like(q)
        size = float(np.linalg.norm(b))
        if size == 0.0:
            return s
        b /= size  # products by differences take what is next to nothing for nothing
        x, left = _refined(lu.solve, times, b)
        exact = not (len(m.rough) or len(m.joined) or friction is not None)
        if not exact and float(np.linalg.norm(left)) > AIMED:
            before = LinearOperator((n, n), matvec=lu.solve, dtype=np.float64)
            whole = LinearOperator((n, n), matvec=times, dtype=np.float64)
            x, _ = gmres(whole, b, x0=x, M=before, rtol=AIMED, restart=DIRECTIONS, maxiter=AGAIN)
            left = b - times(x)
        if not _is_solution(left, lu.solve, x):
            raise _neutral(name)
        s[:n] = size * x
        return s

    return solve, stiff


def _refined(
    solve: Callable[[FloatArray], FloatArray], times: Callable[[FloatArray], FloatArray], b: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """A solution of the equations, corrected while that helps, and what is left of b, of size 1."""
    x = solve(b)
    left = b - times(x)
    while float(np.linalg.norm(left)) > AIMED:
        better = x + solve(left)
        rest = b - times(better)
        if not float(np.linalg.norm(rest)) < HELPS * float(np.linalg.norm(left)):
            break
        x, left = better, rest
    return x, left


def _is_solution(left: FloatArray, solve: Callable[[FloatArray], FloatArray], x: FloatArray) -> bool:
    """Whether what is left of a right-hand side of size 1 is nothing, or changes the solution by nothing.

    It may be round-off of forces much larger than the right-hand side.
    """
    large = float(np.linalg.norm(x))
    if float(np.linalg.norm(left)) <= ACCEPTED * max(1.0, large):
        return True
    return float(np.linalg.norm(solve(left))) <= CHANGED * large


def _neutral(name: str = "") -> SolveError:
    what = "the equilibrium is neutral or slack: it does not depend smoothly on a number"
    return SolveError(
        f"sensitivity {name}".strip(), what, "hold what moves without force, or use a simulation"
    )
