"""From where friction on grounds acts in an equilibrium, where that is not the initial shape."""

from __future__ import annotations

from typing import Any


def notes(known: Any) -> list[str]:
    """What is said of a State in which cables came down without friction before there was any.

    See :func:`ancf.solvers.statics.equilibrium.lay`.
    """
    grounds = [item.name for item in known.system.model.grounds if item.friction > 0.0]
    if not (known.known.laid and grounds):
        return []
    where = " and ".join(f'"{name}"' for name in grounds)
    why = "over all the way from the initial shape it would press a cable or leave no equilibrium"
    much = "forces where cables lie are nearly those without friction, and may jump with the model's numbers"
    hint = "draw cables by a path near where they lie"
    return [f"friction on {where} holds cables from where they came down without it: {why}; {much}; {hint}"]
