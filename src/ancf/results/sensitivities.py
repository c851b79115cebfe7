"""Derivatives that go with a state or a result, by the name of the parameter."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..errors import ModelError
from ..model import checks


def sensitivity_of(known: Mapping[str, Any], name: Any) -> Any:
    """Those by a parameter.

    Raises
    ------
    ModelError
        They were not asked for.
    """
    there = [*known]
    if isinstance(known, dict):  # the others are of a file, and made when they are asked for
        there = [one for one, item in known.items() if item is not None]
    if not there:
        hint = 'such as ancf.simulate(..., sensitivities=["beam.EI"])'
        raise ModelError("sensitivity", "no sensitivities were asked for when this was computed", hint)
    if name not in there:
        what = f"there is none by {checks.shown(name)}, there are: {checks.listed(there)}"
        raise ModelError("sensitivity", what, checks.nearest(str(name), there))
    return known[name]
