"""Whether there is memory for the states and samples of a run, before it starts."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path
from typing import Any

from ..errors import ModelError
from ..system.system import System

#: Limits of a container, of both versions of control groups.
LIMITS = ("/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory/memory.limit_in_bytes")
#: What to do about more states than the memory holds.
ROOM = "give output_step=, which stores fewer states, or file=, which writes them while they are computed"
UNITS = (("TB", 1e12), ("GB", 1e9), ("MB", 1e6))
#: Bytes of a number; a state has its time and two kinds of work beside q and v.
NUMBER, BESIDE = 8.0, 3
ALWAYS = 1e7  # bytes that are always there


def check_room(system: System, settings: dict[str, Any], where: str = "simulate") -> None:
    """Raise ModelError if what a run stores would fill more than the memory there is.

    Parameters
    ----------
    system : System
        With its sensors.
    settings : dict
        Those in the header of a result.
    """
    span, listed = settings["t_end"] - settings["t_start"], system.sensors
    states, steps = span / settings["output_step"] + 1.0, span / settings["step"] + 1.0
    sizes = {
        f"{states:.3g} stored states": NUMBER * states * (2 * system.size + BESIDE),
        f"{steps:.3g} samples of the sensors": NUMBER * steps * (2 * len(listed.index) + listed.width + 1)
        if listed
        else 0.0,
    }
    if sum(sizes.values()) < ALWAYS:
        return  # to ask takes as long as a hundred steps
    memory = memory_there()
    if memory is not None and sum(sizes.values()) > memory:
        what, size = max(sizes.items(), key=lambda item: item[1])
        raise ModelError(where, f"{what} take about {_text(size)}, the memory has {_text(memory)}", ROOM)


def memory_there() -> float | None:
    """Memory of the machine, or what a container may take of it, bytes; None where nobody says."""
    found = []
    with suppress(AttributeError, ValueError, OSError):  # not on all systems
        found.append(float(os.sysconf("SC_PHYS_PAGES")) * os.sysconf("SC_PAGE_SIZE"))
    for path in LIMITS:
        with suppress(OSError, ValueError):  # "max": no limit
            found.append(float(Path(path).read_text(encoding="ascii")))
    return min((size for size in found if size > 0.0), default=None)


def _text(size: float) -> str:
    unit, bytes_ = next((pair for pair in UNITS if size >= 0.5 * pair[1]), UNITS[-1])
    return f"{size / bytes_:.2g} {unit}"
