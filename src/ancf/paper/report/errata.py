"""Misprints and gaps of the paper, and what was taken."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from importlib.resources import files


@dataclass(frozen=True, slots=True)
class Erratum:
    """One of them.

    Parameters
    ----------
    where : str
        Equation, example or figure.
    kind : "misprint" or "gap"
    printed, taken : str
        What the paper says or leaves out, and what the package takes.

    """

    where: str
    kind: str
    printed: str
    taken: str


def errata() -> list[Erratum]:
    """All of them, in the order of the paper."""
    text = files("ancf.paper").joinpath("data", "errata.toml").read_text(encoding="utf-8")
    return [Erratum(**entry) for entry in tomllib.loads(text)["entry"]]
