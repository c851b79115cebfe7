"""What the head and the foot of the page say of a result."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from ...results.result import Result

STATUS = {
    "complete": "complete",
    "failed": "failed",
    "interrupted": "stopped by Ctrl-C",
    "running": "not finished",
}


@dataclass(frozen=True, slots=True)
class About:
    """Words about where the picture comes from.

    Parameters
    ----------
    status : str
        "complete", or what went wrong and how far it got.
    good : bool
        Whether the status is as it should be.
    made : str
        Versions and date.
    file : str
        Name of the results file.
    """

    status: str = ""
    good: bool = True
    made: str = ""
    file: str = ""


def about(source: Any, file: str = "") -> About:
    """Words about a Result, a State or Modes."""
    if not isinstance(source, Result):
        return About(file=file)
    plain = source.provenance
    status, t_end = STATUS.get(source.status, source.status), plain.get("settings", {}).get("t_end")
    good = source.status == "complete"
    if not good and t_end and len(source.t):
        status += f" at t = {source.t[-1]:g} s of {t_end:g} s"
    versions = plain.get("versions", {})
    made = [f"ancf {versions['ancf']}"] if "ancf" in versions else []
    made += [f"Python {versions['python']}"] if "python" in versions else []
    made += [str(plain["created"])[:10]] if plain.get("created") else []
    integrator = plain.get("settings", {}).get("integrator")
    made += [str(integrator).replace("_", "-")] if integrator else []
    return About(status, good, ", ".join(made), file)


def about_all(sources: Mapping[str, Result], file: str = "") -> About:
    """Words about several results: what is not as it should be, and what made the first one."""
    each = {label: about(source) for label, source in sources.items()}
    wrong = [f"{label} {told.status}" for label, told in each.items() if not told.good]
    status = ", ".join(wrong) or f"{len(each)} runs, complete"
    return About(status, not wrong, next(iter(each.values())).made, file)
