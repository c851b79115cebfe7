"""Versions that a result was made with."""

from __future__ import annotations

import platform
from functools import cache
from importlib.metadata import version

from .._version import __version__


def versions() -> dict[str, str]:
    """Versions of Python, the package and the libraries that it computes with."""
    return {"python": platform.python_version(), "ancf": __version__, **_libraries()}


@cache
def _libraries() -> dict[str, str]:
    """Looked up once: it takes longer than a short run."""
    return {name: version(name) for name in ("numpy", "scipy", "numba", "h5py")}
