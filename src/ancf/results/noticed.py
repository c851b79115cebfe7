"""What a run and its stored states tell of themselves, one line each."""

from __future__ import annotations

from typing import Any

from . import accuracy, gone_through, sharp_bends, stretched, tension, turned_bends, wavering
from .below import of_bodies
from .resolution import of_steps


def of_result(result: Any, given: list[str]) -> list[str]:
    """All notes of a result, with those that its run was given at the start."""
    found = [*given, *tension.notes(tension.compressions(result))]
    found += stretched.notes(stretched.stretched(result))
    found += sharp_bends.notes(sharp_bends.sharp_bends(result))
    if len(result.t) and turned_bends.looked_at(result.model):
        found += turned_bends.notes(result.state())
    found += wavering.notes(wavering.waverings(result))
    found += [*of_bodies(result), *gone_through.of_contacts(result)]
    return [*found, *accuracy.of_energy(result), *of_steps(result), *accuracy.of_joints(result)]
