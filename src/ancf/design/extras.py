"""What the design loop needs beside the core: the extras, imported when they are used."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from ..errors import ModelError


def extra(name: str, group: str = "study") -> Any:
    """A module of an extra.

    Raises
    ------
    ModelError
        It is not installed.
    """
    try:
        return import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise ModelError(group, f"{package} is not installed", f"pip install 'ancf[{group}]'") from None


def pandas() -> Any:
    """The module pandas."""
    return extra("pandas")
