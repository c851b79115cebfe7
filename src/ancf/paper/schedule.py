"""Which exhibits go together to one process, and in which order."""

from __future__ import annotations

import os
from collections.abc import Iterable

#: Exhibits that share runs, or kernels that the first run compiles; those that take long come first.
GROUPS: tuple[tuple[str, ...], ...] = (
    ("derivatives",),
    ("fig10", "fig11", "fig9", "table2"),
    ("closed-forms", "connections"),
    ("fig14", "fig13"),
    ("fig2", "fig3", "fig6", "fig4", "fig5", "fig7", "fig8"),
    ("en50318", "overhead"),
    ("orders",),
    ("fig1",),
    ("fig12",),
)


def grouped(names: Iterable[str]) -> list[list[str]]:
    """Names in groups, each for one process; a name that no group has is one of its own, at the end."""
    wanted = list(names)
    groups = [[name for name in group if name in wanted] for group in GROUPS]
    known = {name for group in GROUPS for name in group}
    return [group for group in groups if group] + [[name] for name in wanted if name not in known]


def cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
