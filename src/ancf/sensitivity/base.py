"""The model itself, compiled for sensitivities: its matrices, and what refuses to be differentiated."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..batches import Batches
from ..compiled import (
    MOST_TOUCHED,
    add_rate_stiffness,
    add_rate_work,
    add_work_slopes,
    does_something,
    touched,
    traits,
)
from ..errors import ModelError
from ..solvers.directions import exact_masses
from ..solvers.rare import knowing
from ..solvers.sensitivity import FURTHEST, MOVED, Matrices
from ..system.core import Core
from ..system.system import System


def matrices_of(core: Core, size: int, moving: bool, back: bool = False) -> Matrices:
    """Room for the matrices of sensitivities, the masses of exact batches filled in.

    ``back``: of an adjoint, which asks batches what velocities add to products with the stiffness, and not to
    this itself.
    """
    rate = add_rate_work if back else add_rate_stiffness
    batches = [batch for batch in core.batches if len(batch[0])]
    exact = [batch for batch in batches if _exact(batch, False)]
    turning = moving and bool(np.any(core.supports.rot_moving >= 0))
    changed = [batch for batch in exact if moving and not _exact(batch, True)]
    known = [batch for batch in changed if does_something(type(batch), rate)]
    lossy = [batch for batch in changed if not any(batch is one for one in known)]
    rough = [batch for batch in batches if not _exact(batch, False)]
    resting = [batch for batch in exact if not any(batch is one for one in known)]
    K, C, M = (np.zeros_like(core.A) for _ in range(3))
    W = np.zeros(core.A.size if known and not back else 0)
    local = not back and all(does_something(type(batch), touched) for batch in rough)
    others = knowing(touched, rough) if local else Batches(rough)
    if back and all(does_something(type(batch), add_work_slopes) for batch in rough):
        others = knowing(add_work_slopes, rough)
    kinds = Batches(exact), Batches(resting), knowing(rate, known), Batches(lossy), others
    near = np.zeros((4, MOST_TOUCHED * sum(len(batch[0]) for batch in rough) if local else 0))
    flags = local, turning, bool(core.damped)
    made = Matrices(*kinds, K, C, M, W, *flags, moved_by(core), np.zeros((10, size)), near)
    apart = 1.0 + 0.5 * np.sin(np.arange(size, dtype=np.float64))  # springs between places that are not one
    exact_masses(made, core.ws, apart, np.zeros(size))
    return made


def moved_by(core: Core) -> float:
    """Change of a state, in sizes of the model, of differences of its forces."""
    least = float(np.min(core.weight[core.weight > 0.0], initial=1.0))  # 1/size, or 1 for a small model
    return min(MOVED, FURTHEST * least)


def _exact(batch: Any, moving: bool) -> bool:
    own = traits(batch).exact
    return own is not None and own(batch, moving)


def check_differentiable(system: System, where: str) -> None:
    """Raise ModelError for what has no sensitivities.

    What batches remember of the motion, as friction on grounds and surfaces, is no part of the state.
    """
    for drive in system.inputs.drives:
        what = f'the length of "{drive.winch.name}" follows from step to step, which has no derivative here'
        raise ModelError(where, what, "give its length as a function of time")
    for name, batch in system.parts.items():
        late = traits(batch).late
        if traits(batch).memory and len(batch[0]) and late is not None and late(batch) is not None:
            what = f"the model has friction that remembers the way ({name}), which has no derivative here"
            raise ModelError(where, what, "leave its friction out")
