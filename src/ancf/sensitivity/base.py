"""The model itself, compiled for sensitivities: its matrices, and what refuses to be differentiated."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..batches import Batches
from ..compiled import (
    Role,
    add_force_slopes,
    add_rate_stiffness,
    add_rate_work,
    add_slopes_beside,
    add_tangent_work,
    add_work_slopes,
    choose_memory,
    does_something,
    traits,
)
from ..errors import ModelError
from ..linalg.eight import lane_rows
from ..simd import LANES
from ..solvers.derivatives.directions import exact_masses
from ..solvers.derivatives.sensitivity import FURTHEST, MOVED, Matrices
from ..solvers.rare import knowing
from ..system.core import Core
from ..system.system import System
from .remembering import followed, friction_of

#: Change of a state of differences where friction remembers the way, in sizes of the model.
SHORT = 2e-7


def matrices_of(
    core: Core, size: int, moving: bool, back: bool = False, marked: Iterable[tuple[Any, Any]] = ()
) -> Matrices:
    """Room for the matrices of sensitivities, the masses of exact batches filled in.

    ``marked``: batches and those that are asked in place of them, which remember what steps do.
    ``back``: of an adjoint, which asks batches for products with matrices, as far as they know these, and for
    what velocities add to them, and not for the matrices themselves.
    """
    rate = add_rate_work if back else add_rate_stiffness
    instead = {id(batch): other for batch, other in marked}
    batches = [instead.get(id(batch), batch) for batch in core.batches if len(batch[0])]
    exact = [batch for batch in batches if _exact(batch, False)]
    turning = moving and bool(np.any(core.supports.rot_moving >= 0))
    changed = [batch for batch in exact if moving and not _exact(batch, True)]
    known = [batch for batch in changed if does_something(type(batch), rate)]
    lossy = [batch for batch in changed if not any(batch is one for one in known)]
    others = [batch for batch in batches if not _exact(batch, False)]
    smooth = [batch for batch in others if moving or not does_something(type(batch), choose_memory)]
    whole = [batch for batch in smooth if not _is_joint(batch) and _is_sloped(batch, back)]
    joints = [batch for batch in others if _is_joint(batch)] + whole
    rough = [batch for batch in others if not any(batch is one for one in joints)]
    worked = _worked(exact) if back else []
    exact = [batch for batch in exact if not any(batch is one for one in worked)]
    stirring = [batch for batch in exact if any(batch is one for one in known)]
    resting = [batch for batch in exact if not any(batch is one for one in known)]
    K, C, M = (np.zeros_like(core.A) for _ in range(3))
    W = np.zeros(core.A.size if known and not back else 0)
    outside = any(traits(batch).row is not None or traits(batch).rows is not None for batch in others)
    known_by = (add_work_slopes,) if back else (add_force_slopes, add_slopes_beside)
    slopes = knowing(known_by[0], joints, *known_by[1:])
    plain = Batches(exact), Batches(resting), Batches(stirring)
    kinds = *plain, knowing(rate, known), knowing(add_tangent_work, worked), Batches(lossy), slopes
    flags = outside, turning, bool(core.damped)
    rows = size if joints else 0
    along, found = lane_rows(3 * rows).reshape(3, rows, LANES), lane_rows(rows)
    stiff = [batch for batch in joints if hasattr(batch, "alpha")]
    alpha, row = (stiff[0].alpha, stiff[0].unknown) if stiff else (np.zeros(0), np.zeros(0, dtype=np.int64))
    places = [batch.unknown + 3 for batch in joints if Role.SLIDES in traits(batch).role]
    edge = np.concatenate([core.joints.multipliers, *places]).astype(np.int64)
    few: Any = along, found, alpha, row, edge, bool(whole)
    work = np.zeros((10, size))
    made = Matrices(*kinds, Batches(rough), K, C, M, W, *flags, moved_by(core), work, *few)
    apart = 1.0 + 0.5 * np.sin(np.arange(size, dtype=np.float64))  # springs between places that are not one
    exact_masses(made, core.ws, apart, np.zeros(size))
    return made


def _worked(exact: list[Any]) -> list[Any]:
    """Batches whose products are taken without matrices.

    Where others have matrices, products with these are the same work with more numbers in them: it pays for
    those alone that would have two.
    """
    able = [batch for batch in exact if does_something(type(batch), add_tangent_work)]
    if len(able) == len(exact):
        return able
    dampings = ((batch, traits(batch).damped) for batch in able)
    return [batch for batch, damped in dampings if damped is not None and damped(batch)]


def moved_by(core: Core) -> float:
    """Change of a state, in sizes of the model, of differences of its forces."""
    least = float(np.min(core.weight[core.weight > 0.0], initial=1.0))  # 1/size, or 1 for a small model
    return min(MOVED, FURTHEST * least)


def moved_with(system: System, m: Matrices) -> Matrices:
    """The same with the change of a model with friction, whose springs are short and slip one by one."""
    return m._replace(moved=min(m.moved, SHORT)) if friction_of(system) else m


def _is_joint(batch: Any) -> bool:
    """Whether a batch has rows with multipliers and knows all derivatives of its forces."""
    slopes = add_work_slopes, add_force_slopes, add_slopes_beside
    known = all(does_something(type(batch), own) for own in slopes)
    return known and Role.CONSTRAINS in traits(batch).role


def _is_sloped(batch: Any, back: bool) -> bool:
    """Whether a batch without rows knows all derivatives of its forces, or of their work."""
    own = traits(batch).sloped
    known = does_something(type(batch), add_work_slopes if back else add_force_slopes)
    return known and Role.CONSTRAINS not in traits(batch).role and (own is None or own(batch))


def _exact(batch: Any, moving: bool) -> bool:
    own = traits(batch).exact
    return own is not None and own(batch, moving)


def check_differentiable(system: System, where: str, follows: bool = False) -> None:
    """Raise ModelError for what has no sensitivities.

    ``follows``: what friction on grounds and surfaces remembers of the motion is followed, too.
    """
    for drive in system.inputs.drives:
        what = f'the length of "{drive.winch.name}" follows from step to step, which has no derivative here'
        raise ModelError(where, what, "give its length as a function of time")
    for name in friction_of(system):
        if not (follows and followed(system, name)):
            what = f"the model has friction that remembers the way ({name}), which has no derivative here"
            raise ModelError(where, what, "leave its friction out")
