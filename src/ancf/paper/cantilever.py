"""Example 7.1: a planar cantilever, straight and at rest, that falls under its own weight.

A parameter f makes it thin: side f cm, density 500/f^2 kg/m^3, Young's modulus 1e8/f^4 N/m^2.
Bending stiffness and weight stay the same, the axial stiffness grows with 1/f^2.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import ancf

from . import kinds

if TYPE_CHECKING:
    from .. import Model, Newton, Result, Section

LENGTH = 1.0  # m
STEP, T_END = 2.5e-4, 0.4  # s
GRAVITY = 9.81  # m/s^2

NOTES = [
    "Example 7.1: x along the undeformed beam, z up; straight and at rest at t = 0; square section, "
    "side f cm, f = 1 unless a column says otherwise.",
    'Clamp: position and all slopes held, r_x or r_x, r_y, r_z (stretch="fixed").',
    kinds.NOTE,
    "Trapezoidal rule, step 0.25 ms.",
]


def youngs_modulus(f: float) -> float:
    """Young's modulus, N/m^2."""
    return 1e8 / f**4


def section(f: float = 1.0) -> Section:
    """Square of the side f cm."""
    side = 0.01 * f
    return ancf.Section.rectangle(side, side, E=youngs_modulus(f), rho=500.0 / f**2)


def build(
    elements: int = 4,
    f: float = 1.0,
    element: str = "cable",
    strain: str | None = None,
    stretch: str = "fixed",
) -> Model:
    """Model of the example; its beam is called "beam".

    Parameters
    ----------
    elements : int
        Number of elements.
    f : float
        Parameter of the section, 0.1 to 1.
    element : str
        Kind of element, one of ``kinds.KINDS``.
    strain : "paper" or "material"
        Strain measures of the cable, default "paper".
    stretch : "fixed" or "free"
        Whether the clamp holds all of the slopes or their directions only.

    """
    model = ancf.Model(gravity=(0.0, 0.0, -GRAVITY), title="Cantilever, example 7.1")
    beam = model.add_beam(
        "beam",
        start=(0.0, 0.0, 0.0),
        end=(LENGTH, 0.0, 0.0),
        elements=elements,
        section=section(f),
        **kinds.options(element, strain),
    )
    model.clamp(beam.start, stretch=stretch)
    return model


def run(model: Model, t_end: float = T_END, newton: Newton | None = None) -> Result:
    """Motion until t_end in s, every step."""
    method = ancf.Trapezoidal() if newton is None else ancf.Trapezoidal(newton=newton)
    return ancf.simulate(model, t_end=t_end, step=STEP, integrator=method)
