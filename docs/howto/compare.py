"""``ancf compare``: how far the bodies of two results are apart."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from ancf.cli.results_file import open_result
from ancf.cli.screen import console, table
from ancf.errors import ModelError
from ancf.model.bodies.beam import Beam

PLACES = 9  # on each beam, its ends included
DIGITS = 9  # behind the point of a time, s: times that are the same to them are one


def compare_files(first: Path, second: Path) -> None:
    """Print the largest distance of each body, when and where it occurs.

    Raises
    ------
    ModelError
        One is no results file, or they have no body or no time in common.
    """
    one, other = open_result(first), open_result(second)
    known = {name: type(body) for name, body in other.bodies.items()}
    names = [name for name, body in one.bodies.items() if known.get(name) is type(body)]
    times = one.t.round(DIGITS), other.t.round(DIGITS)
    shared, mine, theirs = np.intersect1d(*times, return_indices=True)
    if not names or not len(shared):
        what = f"has no {'time' if names else 'body'} in common with {first}"
        hint = f"that has {', '.join(one.bodies)}, {one.t[0]:g} to {one.t[-1]:g} s"
        raise ModelError(str(second), what, hint)
    shown = table("body", "distance [m]", "t [s]", "at")
    for name in names:
        pair = points_of(one.bodies[name]), points_of(other.bodies[name])
        gaps = [
            one.position(a)[mine] - other.position(b)[theirs]
            for a, b in zip(*pair, strict=True)
        ]
        distance = np.linalg.norm(gaps, axis=2)
        place, k = np.unravel_index(np.argmax(distance), distance.shape)
        row = f"{distance[place, k]:.3g}", f"{shared[k]:g}", str(pair[0][place])
        shown.add_row(name, *row)
    console().print(shown)


def points_of(body: Any) -> list[Any]:
    """Points along a beam, by shares of its length, or the name of another body."""
    if not isinstance(body, Beam):
        return [body.name]
    return [body.at(x) for x in np.linspace(0.0, body.length, PLACES).tolist()]
