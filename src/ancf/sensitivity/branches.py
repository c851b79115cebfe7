"""Which slack springs and contacts change their branch within a step of a parameter.

A derivative is that of the branches on which the steps ended.  With a stretch x(t) of a slack spring, zero
where it slackens, and x'(t) its derivative, a change h of the parameter leaves all branches as they are while
x + h x' has the sign of x at all times, to the first order in h; the same of the gap of a contact.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from ..arrays import BoolArray, FloatArray
from ..model.joints.connections import Spring
from ..model.kinds import kind_of


class Change(NamedTuple):
    """A branch that another value of a parameter changes.

    Parameters
    ----------
    name : str
        Of the spring or contact.
    t : float
        The first stored time at which it does, s.
    by : float
        The least change of the parameter that does it, at any time, in its unit.
    """

    name: str
    t: float
    by: float


#: A history (n,), positive on one branch and negative on the other, from what answers as a result does.
Kink = Callable[[Any], FloatArray]


def kinks_of(model: Any) -> dict[str, Kink]:
    """Of the slack springs and of the contacts with strips and surfaces of a model, by name."""
    found: dict[str, Kink] = {}
    for item in model.connections:
        name = item.name
        if isinstance(item, Spring):
            if item.slack:
                found[name] = _stretch(name)
        elif "contact" in kind_of(item).word:
            found[name] = _overlap(name)
    return found


def _stretch(name: str) -> Kink:
    return lambda face: face.spring_length(name) - face.springs[name].length


def _overlap(name: str) -> Kink:
    return lambda face: -face.contact_gap(name)


def changed(name: str, t: FloatArray, x: FloatArray, slope: FloatArray, by: float) -> Change | None:
    """Whether a change of the parameter by ``by``, in either direction, changes the sign of x at any time."""
    known: BoolArray = np.isfinite(x) & np.isfinite(slope)
    with np.errstate(divide="ignore", invalid="ignore"):
        far = np.where(known & (slope != 0.0), np.abs(x) / np.abs(slope), np.inf)
    at = np.flatnonzero(far < abs(by))
    return Change(name, float(t[at[0]]), float(np.min(far))) if len(at) else None
