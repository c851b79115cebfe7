"""What studies need beside the core: the extra ``study``, imported when it is used."""

from __future__ import annotations

from importlib import import_module
from typing import Any

from ..errors import ModelError


def extra(name: str) -> Any:
    """A module of the extra.

    Raises
    ------
    ModelError
        It is not installed.
    """
    try:
        return import_module(name)
    except ImportError:
        package = name.partition(".")[0]
        raise ModelError("study", f"{package} is not installed", "pip install 'ancf[study]'") from None


def pandas() -> Any:
    """The module pandas."""
    return extra("pandas")
