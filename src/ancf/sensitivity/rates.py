"""What parameters change the numbers of batches by."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..compiled import add_number_work, does_something, traits
from .alike import OWN
from .family import Family


def rates_of(family: Family, forces: bool = False) -> dict[str, FloatArray]:
    """Derivatives of the numbers of batches by a parameter, by name, where that is all it does to them.

    ``forces``: of batches that know what the forces change by, and not their work alone.
    """
    found, (systems, weights) = {}, family.wider
    for name in family.changed:
        batch = family.base.parts[name]
        numbers, keys, sloped = traits(batch).numbers, traits(batch).numbered, traits(batch).sloped
        if sloped is not None and not sloped(batch):  # nor is known what its numbers do, as beside a winch
            continue
        if numbers is None or not (
            traits(batch).kinds if forces else does_something(type(batch), add_number_work)
        ):
            continue
        each = [system.parts[name] for system in systems]
        if any(not _has_other(batch, other, keys) for other in each):
            continue
        here, total = numbers(batch), 0.0
        for weight, one in zip(weights, each, strict=True):
            if one is not batch:
                total = total + weight * (numbers(one) - here)
        found[name] = np.asarray(total)
    return found


def joined(batch: Any, other: Any) -> Any:
    """The batch as it knows what all numbers do that it or another one has."""
    own = traits(batch).joined
    return batch if own is None else own(batch, other)


def _has_other(batch: Any, other: Any, keys: tuple[str, ...]) -> bool:
    """Whether nothing but these numbers differs, and which of them there are."""
    return batch is other or all(
        mine is theirs or np.array_equal(mine, theirs)
        for key, mine, theirs in zip(batch._fields, joined(batch, other), joined(other, batch), strict=True)
        if key not in keys and key not in OWN and key not in traits(batch).memory
    )
