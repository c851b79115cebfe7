"""Case: a computed number whose value a formula gives."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import ancf

if TYPE_CHECKING:
    from ... import Beam, Model

LENGTH = 2.0  # m, of the beams
SIDE, MODULUS, DENSITY, NU = 0.1, 1e9, 1000.0, 0.3  # m, N/m^2, kg/m^3, of beams with a section
EA, EI, RHO_A = 1e5, 3.0, 0.6  # N, N m^2, kg/m, of cables


class Case(NamedTuple):
    """A number beside its closed form.

    Parameters
    ----------
    name : str
        What it is.
    element : str
        Kind of element, or "none".
    value, reference : float
        In `unit`.
    tolerance : float
        Largest difference as a share of the reference: what the mesh or the step leaves.
    unit : str
    origin : str
        The formula, in words or symbols.

    """

    name: str
    element: str
    value: float
    reference: float
    tolerance: float
    unit: str
    origin: str


def cable(elements: int, gravity: float = 0.0, **more: Any) -> tuple[Model, Beam]:
    """A cable along x from the origin, in a model with gravity along -z, m/s^2."""
    section = ancf.Section(EA=more.pop("EA", EA), EI=more.pop("EI", EI), rhoA=RHO_A)
    return _straight(elements, gravity, section=section, **more)


def solid(elements: int, **more: Any) -> tuple[Model, Beam]:
    """A square beam along x from the origin, nonlocking unless `element` is given."""
    section = ancf.Section.rectangle(SIDE, SIDE, E=MODULUS, rho=DENSITY, nu=NU)
    return _straight(elements, 0.0, section=section, **{"element": "nonlocking", **more})


def _straight(elements: int, gravity: float, **more: Any) -> tuple[Model, Beam]:
    """With a zero moment: all models of an element then have the same kinds of forces and compile once."""
    model = ancf.Model(gravity=(0.0, 0.0, -gravity))
    ends = {"start": (0.0, 0.0, 0.0), "end": more.pop("end", (LENGTH, 0.0, 0.0))}
    beam = model.add_beam("beam", **ends, elements=elements, **more)
    model.add_moment(beam.end, (0.0, 0.0, 0.0), name="none")
    return model, beam
