"""Versions that a result was made with."""

from __future__ import annotations

import platform
from importlib.metadata import version

from .._version import __version__


def versions() -> dict[str, str]:
    """Versions of Python, the package and the libraries that it computes with."""
    found = {name: version(name) for name in ("numpy", "scipy", "numba", "h5py")}
    return {"python": platform.python_version(), "ancf": __version__, **found}
