"""Checks of the joints of a System: are they independent, and do they meet where a run starts?"""

from __future__ import annotations

from typing import Any, NamedTuple, TypeGuard

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray, IntArray
from ..errors import ModelError
from ..later import csc_array, null_space, splu, svd
from ..linalg.sparse import to_sparse
from ..model.functions.function import TimeFunction
from ..model.joints.basic import Slide
from ..model.joints.touching import bodies_of
from .core import assemble, constraints, restrict
from .system import System

#: Share of a row in a dependent combination from which on its joint is named.
NAMED = 0.05
#: Ratio of smallest singular values below which rows are nearly dependent, and most rows that are looked at.
SINGULAR, MANY = 0.1, 1200
#: Largest gap of a joint at the start, in sizes of the model; a sliding joint has its own.
GAP = 1e-6
#: Given motions of supports and their units.
MOTIONS = {"displacement": "m", "rotation": "rad", "rotation_vector": "rad"}


class Rows(NamedTuple):
    """Rows C_q of the joints on the unknowns that move, in some state."""

    C: FloatArray  # (m, n)
    gap: FloatArray  # (m,) C there
    owner: NDArray[np.str_]  # (m,) joint, or rigid body
    unknown: IntArray  # (m,) multiplier, -1 where a row is a combination
    moving: IntArray  # (n,) unknowns


def nearly_dependent(system: System, q: FloatArray) -> list[str]:
    """Joints that nearly hold the same motion twice in the state q, as in a singular position of a loop.

    The smallest singular value of the rows C_q, in sizes of the model and each of length 1, is compared
    with that of the initial shape.  Empty where no joints depend on each other.
    """
    if not len(np.setdiff1d(system.multipliers, system.core.supports.held)):
        return []
    weight = system.core.weight[np.setdiff1d(system.free, system.multipliers)]
    least, names = [], []
    for state in (system.initial_shape(), q):
        C, _, owner, *_ = held_rows(system, state)
        if len(C) > MANY or not np.all(np.isfinite(C)):
            return []
        C = C / weight
        size = np.linalg.norm(C, axis=1)
        U, values, _ = svd(C / np.maximum(size, 1e-300)[:, None], full_matrices=False)
        least.append(float(values[-1]))
        share = np.abs(U[:, -1])
        names = list(dict.fromkeys(owner[share > NAMED * share.max()].tolist()))
    joints = {joint.name for joint in system.model.connections}
    return [name for name in names if name in joints] if least[1] < SINGULAR * least[0] else []


def held_rows(system: System, q: FloatArray) -> Rows:
    """Rows of all multipliers in the state q.

    A sliding joint with a released direction has two rows, normal to it.
    """
    core = system.core
    held, zero, gap = core.supports.held, np.zeros(system.size), np.zeros(system.size)
    system.level[:] = 1.0, 0.0, 0.0
    constraints(core.joints, q, zero, zero, gap, core.ws)
    assemble(core.batches, core.ws, q, zero, core.A, 0.0, 0.0, 1.0)
    restrict(core.supports, core.A)
    lam, moving = np.setdiff1d(system.multipliers, held), np.setdiff1d(system.free, system.multipliers)
    C = to_sparse(core.A, system.places)[lam][:, moving].toarray()
    released = {c.name: c.release for c in system.model.connections if isinstance(c, Slide)}
    rows, gaps, owner, numbers = [np.zeros((0, len(moving)))], [np.zeros(0)], [], [np.zeros(0, np.int64)]
    for name, unknowns in system.numbering.multipliers.items():
        mine = np.isin(lam, unknowns)
        part, g, number = C[mine], gap[lam[mine]], lam[mine]
        direction = released.get(name)
        if direction is not None and len(part):
            across = null_space(direction[None]).T
            part, g, number = across @ part, across @ g, np.full(len(across), -1)
        rows.append(part)
        gaps.append(g)
        numbers.append(number)
        owner += [name] * len(part)
    return Rows(np.concatenate(rows), np.concatenate(gaps), np.array(owner), np.concatenate(numbers), moving)


def surely_independent(C: FloatArray) -> bool:
    """A cheap look at many rows: pivots of the sparse matrix C C^T."""
    rows = csc_array(C)
    try:
        pivots = np.abs(splu(csc_array(rows @ rows.T)).U.diagonal())
    except RuntimeError:  # exactly singular
        return False
    return bool(pivots.min() > 1e-8 * pivots.max())


def open_contacts(system: System, q: FloatArray) -> None:
    """Take the unilateral contacts for open whose points are apart in the state q."""
    for batch in system.core.joints.tail:
        gaps = _gaps(system, q)[batch.unknown[:, None] + np.arange(3)]
        apart = -np.sum(batch.unilateral * gaps, axis=1)
        batch.open[:] = apart > GAP * system.model.size


def _gaps(system: System, q: FloatArray) -> FloatArray:
    """C in the rows of the multipliers, with all contacts closed."""
    r, zero = np.zeros(system.size), np.zeros(system.size)
    still = q.copy()
    still[system.multipliers] = 0.0
    system.level[:] = 1.0, 0.0, 0.0
    for batch in system.core.joints.tail:
        batch.open[:] = 0
    constraints(system.core.joints, still, zero, zero, r, system.core.ws)
    return r


def check_gaps(system: System, q: FloatArray, where: str, t: float) -> None:
    """Raise ModelError if a joint's points are apart in the state q from which a run starts at the time t."""
    if not len(system.multipliers):
        return
    gaps = _gaps(system, q)
    for joint in system.model.connections:
        if joint.name not in system.numbering.multipliers:
            continue
        apart = gaps[system.numbering.multipliers[joint.name][:3]]
        allowed = GAP * system.model.size
        if isinstance(joint, Slide):
            allowed = joint.tolerance
            if joint.unilateral is not None:  # an open contact is apart
                apart = apart - min(float(apart @ joint.unilateral), 0.0) * joint.unilateral
        gap = float(np.linalg.norm(apart))
        if gap > allowed:
            what = f'"{joint.name}" does not meet: its points are {gap:.6g} m apart, at most {allowed:.3g} m'
            hint = "start from ancf.equilibrium(model), or place the bodies where they meet"
            raise ModelError(where, what, _begins(system, joint, t) or hint)


def _begins(system: System, joint: Any, t: float) -> str:
    """What is said of given motions that take a body of a joint away at once, "" if there are none."""
    bodies = bodies_of(joint)
    for support in system.model.supports:
        if support.point.body.name not in bodies:
            continue
        given = {key: getattr(support, key, None) for key in MOTIONS}
        found = {key: f for key, f in given.items() if _is_known(f) and np.any(f(t))}
        sizes = (f"{key} with {np.linalg.norm(f(t)):.4g} {MOTIONS[key]}" for key, f in found.items())
        if found:
            series = any(function.series for function in found.values())
            cure = "relative=True of a Series counts from there" if series else "let it begin with zero"
            begins = f'"{support.name}" begins its {", its ".join(sizes)}'
            return f"{begins}: {cure}, or start from ancf.equilibrium(model)"
    return ""


def _is_known(function: Any) -> TypeGuard[TimeFunction]:
    return isinstance(function, TimeFunction) and not function.missing
