"""From contacts of the model to the flat arrays of a ContactBatch."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray, IntArray
from ..model.points import Point
from ..model.surfaces.contact import Contact
from .carrier import COLUMNS
from .contact import ContactBatch
from .contact_touch import ARC
from .curves import curves
from .joint_build import place_of
from .sliding_build import beam_line


def contacts(
    items: Sequence[Contact],
    locate: Callable[[Point], Any],
    slots: dict[str, IntArray],
    measured: FloatArray,
) -> ContactBatch:
    """Batch of these contacts, which leave what they find in ``measured``, shape (n, 4)."""
    n = len(items)
    lines = [beam_line(item.carrier, slots[item.carrier.name]) for item in items]
    slot, factor, offset = np.full((n, COLUMNS), -1), np.zeros((n, COLUMNS)), np.zeros((n, 3))
    for k, item in enumerate(items):
        point = place_of(item.point, locate)
        slot[k, : len(point.slots)], factor[k, : len(point.factors)] = point.slots, point.factors
        offset[k] = point.constant
    measured[:, ARC] = [item.s for item in items]
    counts = [len(line[0]) for line in lines]
    return ContactBatch(
        slot=slot.astype(np.int64),
        factor=factor,
        offset=offset,
        first=np.concatenate([[0], np.cumsum(counts)]).astype(np.int64),
        x=np.concatenate([line[0] for line in lines]),
        line_slot=np.concatenate([line[1] for line in lines]).astype(np.int64),
        line_poly=np.concatenate([line[2] for line in lines]),
        data=_numbers(items),
        travel=np.array([item.travel for item in items]),
        normal=np.array([item.normal for item in items]),
        **curves([item.profile for item in items]),
        found=measured,
    )


def renumbered(batch: ContactBatch, items: Sequence[Contact]) -> ContactBatch:
    """The batch with the numbers of these contacts in place of the same ones with others."""
    return batch._replace(data=_numbers(items))


def _numbers(items: Sequence[Contact]) -> FloatArray:
    return np.array([[item.stiffness, item.damping] for item in items])


def no_contacts() -> ContactBatch:
    """Batch without contacts."""
    line, columns = np.zeros((0, 2)), np.zeros((0, COLUMNS), dtype=np.int64)
    return ContactBatch(
        slot=columns,
        factor=np.zeros((0, COLUMNS)),
        offset=np.zeros((0, 3)),
        first=np.zeros(1, dtype=np.int64),
        x=line,
        line_slot=columns,
        line_poly=np.zeros((0, COLUMNS, 4)),
        data=line,
        travel=np.zeros((0, 3)),
        normal=np.zeros((0, 3)),
        **curves([]),
        found=np.zeros((0, 4)),
    )
