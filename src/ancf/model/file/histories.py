"""CSV files that a model file names: their columns in place of the tables that name them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ...errors import ModelError
from .. import checks
from ..functions.series import FILE_KEYS, read_table

#: Keys that say what to read; the others stay for who follows the series.
OF_FILE = ("csv", "column", "unit", "time", "time_unit")


def with_files(tables: Any, folder: Path, where: str = "") -> Any:
    """Tables of a file in which each ``{ csv = ..., column = ... }`` has become times and values.

    Parameters
    ----------
    tables : dict, list or value
    folder : Path
        Where relative names of files begin: the folder of the model file.
    where : str
        Place in the file, for messages.

    Raises
    ------
    ModelError
        A file cannot be read, has no such column, or a key or a unit is unknown.
    """
    if isinstance(tables, list):
        return [with_files(item, folder, f"{where}[{k}]") for k, item in enumerate(tables)]
    if not isinstance(tables, dict):
        return tables
    if "csv" in tables and "column" in tables:
        return _read(tables, folder, where)
    return {key: with_files(item, folder, f"{where}.{key}".lstrip(".")) for key, item in tables.items()}


def _read(given: dict[str, Any], folder: Path, where: str) -> dict[str, Any]:
    for key in given:
        if key not in FILE_KEYS:
            hint = checks.nearest(key, FILE_KEYS)
            raise ModelError(f"{where}.{key}", f"unknown key, allowed: {checks.listed(FILE_KEYS)}", hint)
    name = checks.text(given["csv"], f"{where}.csv")
    asked = {key: given[key] for key in OF_FILE[2:] if key in given}
    found = read_table(folder / name, given["column"], where, **asked)
    rest = {key: value for key, value in given.items() if key not in OF_FILE}
    plain = {"interpolation": "spline", **rest, "t": found["t"].tolist(), "value": found["value"].tolist()}
    return plain | ({"unit": found["unit"]} if found["unit"] else {})
