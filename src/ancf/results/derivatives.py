"""Derivatives of a history by parameters, in its file: a group ``sensitivities`` with a group for each."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..system.sensors import Listing

GROUP = "sensitivities"
#: Of states and their rates at the stored times, and of all that sensors recorded at the steps.
DATA = ("q", "v", "samples")
#: Numbers of a chunk.
CHUNK = 32 * 1024


def create(file: Any, names: Sequence[str], size: int, listing: Listing) -> None:
    """Write the group with empty data sets; none without parameters."""
    for k, name in enumerate(names):
        group = file.create_group(f"{GROUP}/{k}")
        group.attrs["parameter"] = name
        for key, width in zip(DATA, (size, size, 2 * len(listing.index) + listing.width), strict=True):
            chunk = max(1, min(1024, CHUNK // max(width, 1))), max(width, 1)
            group.create_dataset(key, (0, width), "f8", maxshape=(None, width or None), chunks=chunk)


def add(file: Any, k: int, rows: Sequence[FloatArray]) -> None:
    """Add rows to the data sets of parameter k."""
    for key, values in zip(DATA, rows, strict=True):
        data = file[f"{GROUP}/{k}/{key}"]
        first = data.shape[0]
        data.resize(first + len(values), axis=0)
        data[first:] = values
        data.flush()


def read(file: Any, width: int, rows: int) -> dict[str, dict[str, Any]]:
    """Data sets by parameter of a file whose states have a width, and of which there are so many.

    Raises
    ------
    ModelError
        They do not belong to the states.
    """
    found: dict[str, dict[str, Any]] = {}
    groups = file.get(GROUP, {})
    for k in range(len(groups)):
        group = groups[str(k)]
        name, own = str(group.attrs["parameter"]), {key: group[key] for key in DATA}
        for key, data in own.items():
            data.refresh()
            if data.dtype != np.float64 or data.ndim != 2:
                raise ModelError(f"{GROUP}/{k}/{key}", "is no table of numbers")
        for key in DATA[:2]:
            if own[key].shape[1] != width or own[key].shape[0] > rows:
                raise ModelError(f"{GROUP}/{k}/{key}", f"does not fit {rows} states of {width} numbers")
        found[name] = own
    return found
