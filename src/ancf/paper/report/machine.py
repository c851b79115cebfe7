"""What computed: versions of the packages and the kind of machine, nothing that names it."""

from __future__ import annotations

import datetime
import platform
import subprocess
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

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


def commit(file: Path = Path(__file__)) -> str | None:
    """Commit of the clone that a file of the package lies in; None where there is none.

    A changed clone has ``-dirty`` behind it: what it computes is nobody's.
    """
    found = None
    for command in (
        ("ls-files", "--error-unmatch", file.name),
        ("describe", "--always", "--dirty", "--abbrev=12"),
    ):
        try:
            done = subprocess.run(
                ["git", *command], cwd=file.parent, capture_output=True, text=True, check=False
            )
        except OSError:
            return None
        if done.returncode:
            return None
        found = done.stdout.strip()
    return found


def now() -> str:
    """Date and time, UTC."""
    return datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%dT%H:%M:%SZ")


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "unknown"
