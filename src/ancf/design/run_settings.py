"""Settings of a run along a line, as study and optimisation files have them in their table [run]."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from ..errors import ModelError
from ..files import exists

PANTOGRAPH = "pantograph"


def beside_file(settings: Mapping[str, Any], folder: Path) -> dict[str, Any]:
    """Settings whose files of pantographs are those beside the file, as its model and line are."""
    found = dict(settings)
    if PANTOGRAPH in found:
        given = found[PANTOGRAPH]
        listed = isinstance(given, list)
        names = [_beside(name, folder) for name in (given if listed else [given])]
        found[PANTOGRAPH] = names if listed else names[0]
    return found


def _beside(name: Any, folder: Path) -> Any:
    is_file = isinstance(name, str) and name.endswith(".toml") and exists(folder / name, "is_file")
    return str(folder / name) if is_file else name


def check_pantographs(settings: Mapping[str, Any]) -> None:
    """Look for pantographs before anything is computed.

    Raises
    ------
    ModelError
        There is none of such a name, or its file is wrong.
    """
    from ..catenary.vehicles.pantograph import find_pantograph

    given = settings.get(PANTOGRAPH, [])
    for name in given if isinstance(given, list) else [given]:
        try:
            find_pantograph(name)
        except ModelError as error:
            raise ModelError(f"run.{error.where}", error.what, error.hint) from None
