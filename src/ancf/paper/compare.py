"""Checks of several numbers at once, beside references of the independent implementation."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from .check import Check
from .references import origin, reference


def beside_reference(
    name: str, found: Mapping[str, float], key: str, tolerance: float, unit: str = "m"
) -> list[Check]:
    """One check for each number of a reference.

    Parameters
    ----------
    name : str
        Start of the checks' names: "7.1 cable, 4 elements".
    found : mapping
        Numbers by what they are called; a list in the reference has them in this order.
    key : str
        Of the reference.
    tolerance : float
        Largest difference, in `unit`.
    unit : str

    """
    wanted = reference(key)
    values = wanted if isinstance(wanted, Sequence) else [wanted]
    return numbers(name, found, values, tolerance, unit, origin(key))


def numbers(
    name: str,
    found: Mapping[str, float],
    wanted: Iterable[float],
    tolerance: float,
    unit: str,
    where: str,
) -> list[Check]:
    """One check for each number, `wanted` in the order of `found`; `where` is their origin."""
    return [
        Check(f"{name}: {label}", float(value), float(other), tolerance, unit, where)
        for (label, value), other in zip(found.items(), wanted, strict=True)
    ]


def picked(row: Mapping[str, Any], names: Mapping[str, str]) -> dict[str, float]:
    """Numbers of a row by what they are called; `names` gives the text of each column."""
    return {text: float(row[column]) for column, text in names.items()}
