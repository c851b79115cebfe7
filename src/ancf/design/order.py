"""Which case of its design a row of a table is: rows may be sorted, left out or given in other units."""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray
from .journal import case_key
from .sampling import sample, unit_samples

if TYPE_CHECKING:
    from pandas import DataFrame


def places_of(table: DataFrame, design: dict[str, Any]) -> Any:
    """Places (n,) in its design of the rows of a table, or None where they are not told.

    A row is known by its values. Columns that were changed afterwards are taken in their order if they still
    change from row to row only where the design does.

    Parameters
    ----------
    table : DataFrame
    design : dict
        What :func:`ancf.sample` says of samples of the methods "saltelli" and "morris".
    """
    names = [*design["parameters"]]
    if any(name not in table for name in names):
        names = list(table.attrs.get("parameters", names))
    if len(names) != len(design["parameters"]):
        return None
    given = table[names]
    made = sample(
        design["parameters"], method=design["method"], count=design["count"], seed=design["seed"]
    ).set_axis(names, axis=1)
    count = len(given)
    if all(np.array_equal(made[name].to_numpy()[:count], given[name].to_numpy()) for name in names):
        return np.arange(count)
    waiting: dict[str, deque[int]] = {}
    for k, row in enumerate(made.to_dict("records")):
        waiting.setdefault(case_key(row), deque()).append(k)
    found = [
        waiting[key].popleft() if waiting.get(key) else -1 for key in map(case_key, given.to_dict("records"))
    ]
    if -1 not in found:
        return np.array(found)
    unit = unit_samples(design["method"], design["count"], len(names), design["seed"])
    return np.arange(count) if _changes_as(given, unit[:count]) else None


def _changes_as(given: DataFrame, unit: FloatArray) -> bool:
    """Whether columns (n, m) stay from one row to the next wherever those of the unit cube do."""
    if len(given) != len(unit):
        return False
    return all(
        np.all((x[1:] == x[:-1]) | (u[1:] != u[:-1]))
        for x, u in zip((given[name].to_numpy() for name in given), unit.T, strict=True)
    )
