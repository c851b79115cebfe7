"""Supports that turn bodies far in an equilibrium: they turn from the initial shape on, in parts.

Newton's iteration finds the equilibrium that is near. A cable drawn along x whose clamp points along -x at
once is nearest to a crumpled one, and a joint that holds directions up to their sign to the wrong sign.
"""

from __future__ import annotations

import math

import numpy as np

from ...compiled import traits
from ...model.model import Model
from ...model.supports.support import Clamp
from ...system.core import Tables, keep_memory, place_supports
from ...system.inputs import MOMENT, Inputs
from .iteration import Iteration

AT_ONCE = 0.5  # rad, by which a support may turn in one step


class Turning:
    """Given motions of an equilibrium at ``time``, brought on with the loads where one of them turns far."""

    def __init__(self, model: Model, time: float) -> None:
        self.time = time
        self.steps = max(1, math.ceil(farthest(model, time) / AT_ONCE))

    def begin(self, it: Iteration) -> None:
        """Put the supports of an iteration back into the initial shape."""
        if self.steps > 1:
            self._place(it, 0.0)

    def load(self, it: Iteration, share: float) -> float:
        """Put the supports of an iteration where a share of their motion is there; the share of the loads."""
        if self.steps > 1:
            _count_turns(it)
            self._place(it, share)
        return share

    def _place(self, it: Iteration, share: float) -> None:
        tables, still = partial(it.system.inputs, self.time, share), it.zero.copy()
        place_supports(it.core.supports, tables.value[0], tables, 0, it.q, still, still.copy())


def _count_turns(it: Iteration) -> None:
    """Let what goes round remember where it is, and nothing else: friction opposes the whole way."""
    rest = it.system.kept_memory()
    going = [f"{name}." for name, batch in it.system.parts.items() if traits(batch).goes_round]
    if going:
        keep_memory(it.core.remembering, it.q, it.zero)
        it.system.bring_memory({k: x for k, x in rest.items() if not k.startswith(tuple(going))})


def farthest(model: Model, time: float) -> float:
    """Largest angle in rad by which a clamp turns."""
    clamps = [support for support in model.supports if isinstance(support, Clamp)]
    given = [f(time) for c in clamps for f in (c.rotation, c.rotation_vector) if f is not None]
    return max((float(np.linalg.norm(angle)) for angle in given), default=0.0)


def partial(inputs: Inputs, time: float, share: float) -> Tables:
    """Tables of one moment at which a share of the given motions is there, at rest."""
    whole = inputs.tables(time - MOMENT, MOMENT, 1, time, np.inf)
    column = 0
    for motion in inputs.motions:
        columns = slice(column, column := column + len(motion.unknowns))
        if motion.part is not None:
            whole.motion[0, columns, 0] = motion.part(time, share)
    for k, rotation in enumerate(inputs.rotations):
        whole.rotation[0, k, 0] = rotation.part(time, share)
    whole.motion[..., 1:] = 0.0
    whole.rotation[:, :, 1:] = 0.0
    return whole
