"""What follows from the parts of a System, made when it is first asked for.

Of a model around the value of a parameter most is never asked.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..connections.spring_build import no_springs
from ..connections.spring_damper import SpringBatch
from . import loads
from .compile import held_arrays, joined, make_core, rotation_arrays
from .core import Core, Loads, Supports
from .joints import core_joints


class Derived:
    """Base of :class:`ancf.system.system.System`, whose attributes it has."""

    _like: Any  # a system of the same bodies, or None

    @cached_property
    def core(self: Any) -> Core:
        """What the kernels work on."""
        joints = core_joints(list(self.parts.values()), self, self.supports)
        return make_core(self.parts, self.places, self.weight, self.supports, joints, self.dead)

    @cached_property
    def supports(self: Any) -> Supports:
        """Held and driven unknowns, and local axes."""
        driven = np.array(sorted(self.constraints.driven), dtype=np.int64)
        like = self._like
        if like is not None and like.places is self.places and np.array_equal(like.held, self.held):
            held = {key: getattr(like.supports, key) for key in ("held", "held_zero", "held_one")}
        else:
            held = held_arrays(self.held, self.places, self.numbering.used())
        return Supports(
            **held,
            **rotation_arrays(self.constraints, self.places, self.n),
            prescribed=self.inputs.prescribed,
            driven=self._shadowed(driven),
        )

    @property
    def springs(self: Any) -> SpringBatch:
        """The batch of springs, which a model without them has not among its parts."""
        return self.parts["springs"] if "springs" in self.parts else no_springs()

    @cached_property
    def patterns(self: Any) -> list[loads.Pattern]:
        """Slots and factors of the dead loads."""
        return loads.patterns(self.model, self.probe, self.slots, self.numbering.arcs)

    @cached_property
    def dead(self: Any) -> Loads:
        """Dead loads."""
        value = self.value
        still, rows = loads.gravity(self.model, self.slots, self.size), len(value)
        weight, slot, row, unknown = loads.hung(self.model, self.slots, self.numbering.lengths, rows)
        return Loads(
            gravity=still.copy(),
            still=still,
            hung=weight,
            hung_slot=slot,
            hung_row=row,
            hung_from=unknown,
            grows=loads.growing(self.model, rows),
            start=np.cumsum([0] + [len(p[0]) for p in self.patterns]).astype(np.int64),
            slot=joined([p[0] for p in self.patterns], np.int64),
            factor=joined([p[1] for p in self.patterns], np.float64),
            value=value,
        )

    @cached_property
    def held(self: Any) -> IntArray:
        """Unknowns that are held, in ascending order."""
        unused = np.flatnonzero(~self.numbering.used())
        return np.unique(np.concatenate([unused, sorted(self.constraints.held)])).astype(np.int64)

    @cached_property
    def weight(self: Any) -> FloatArray:
        """What changes of the unknowns are measured in: one over the sizes of these."""
        weight, size = np.ones(self.n), self.model.size
        for slots in self.numbering.slots.values():
            weight[slots[:, :1] + np.arange(3)] = 1.0 / size
        for name, beam in self.model.beams.items():
            internal = self.numbering.slots[name][:-1, self.numbering.shared[name] :, None]
            if internal.size:
                weight[internal + np.arange(3)] = np.diff(beam.node_x)[:, None, None]
        weight[self.numbering.all_multipliers()] = 0.0
        weight[list(self.numbering.arcs.values())] = 1.0 / size
        weight[list(self.numbering.lengths.values())] = 1.0 / size
        return weight
