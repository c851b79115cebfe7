"""Reference values: numbers that an independent implementation of the same elements has found.

They lie in ``data/reference.json`` (7.1 to 7.3, linear cases, counts) and ``data/sliding.json`` (7.4), each
with a text on how they were made. A key names example, quantity, element (``cable``, ``orig``, ``ho``),
numbers of elements ``n``, step ``h`` and time ``t``.
"""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from typing import Any

from .kinds import CABLE, NONLOCKING, ORIGINAL

FILES = ("reference.json", "sliding.json")
#: Names of the elements in the keys.
SHORT = {CABLE: "cable", ORIGINAL: "orig", NONLOCKING: "ho"}
#: What a reference is, by a part of its key; the first that is found counts.
ORIGINS = (
    (".step_converged", "independent implementation, same elements, limit of small steps"),
    (".converged", "independent implementation, limit of many elements and small steps"),
    (".exact", "independent solution of the boundary value problem by shooting"),
    ("jac.", "independent implementation, same contraction, tolerance 1e-8"),
    ("", "independent implementation of the same discretisation"),
)


def reference(key: str) -> Any:
    """Value of a reference, in SI units: a number, a list or numbers by name.

    Raises
    ------
    KeyError
        There is none of that name.

    """
    return values()[key]


def exists(key: str) -> bool:
    """Whether there is a reference of that name."""
    return key in values()


@cache
def values() -> dict[str, Any]:
    """All references by key."""
    return {entry["key"]: entry["value"] for name in FILES for entry in _read(name)["entries"]}


def origin(key: str) -> str:
    """Where a reference comes from, in words, with its key."""
    return next(text for part, text in ORIGINS if part in key) + f" ({key})"


def about() -> list[str]:
    """How the references were made and what their keys mean."""
    return [text for name in FILES for text in _read(name)["about"]]


@cache
def _read(name: str) -> dict[str, Any]:
    text = files(__package__).joinpath("data", name).read_text(encoding="utf-8")
    found: dict[str, Any] = json.loads(text)
    return found
