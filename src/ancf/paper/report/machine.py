"""What computed: versions of the packages and the kind of machine, nothing that names it."""

from __future__ import annotations

import datetime
import platform
from importlib.metadata import PackageNotFoundError, version

from ..._version import __version__
from ..schedule import cores

PACKAGES = ("numpy", "scipy", "numba", "matplotlib")


def machine() -> dict[str, str | int]:
    """Versions, system and number of cores."""
    found = {name: _version(name) for name in PACKAGES}
    system = f"{platform.system()} {platform.machine()}".strip()
    return {
        "ancf": __version__,
        "python": platform.python_version(),
        **found,
        "system": system,
        "cores": cores(),
    }


def now() -> str:
    """Date and time, UTC."""
    return datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "unknown"
