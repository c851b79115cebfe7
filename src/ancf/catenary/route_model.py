"""The model of a route: all its tension lengths, each with its own names."""

from __future__ import annotations

import ancf

from .assemble import Assembled, assembled
from .forms.along_track import add_wind
from .forms.route_form import RouteForm


def assembled_route(found: RouteForm) -> Assembled:
    """The model of all tension lengths of a route."""
    line = found.line.lines[0]
    model = ancf.Model(gravity=(0.0, 0.0, -line.gravity), title=found.line.title)
    parts = [assembled(form, model=model, prefix=f"section {k + 1} ") for k, form in enumerate(found.shifted)]
    if found.settled and line.conditions.wind != 0.0:
        add_wind(model, line.conditions, (found.line.begin, found.line.end))
    whole = Assembled(found, model, parts[0].contact, parts[0].messenger, parts=parts)
    for key in (
        "stitches",
        "droppers",
        "supports",
        "arms",
        "hangers",
        "arm_holds",
        "hanger_holds",
        "long_droppers",
    ):
        setattr(whole, key, [item for part in parts for item in getattr(part, key)])
    return whole
