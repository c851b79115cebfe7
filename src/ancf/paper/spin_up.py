"""Example 7.3: a cantilever whose clamp is spun up about the vertical to 4 rad/s within 15 s (eq. 33)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

import ancf

from ..arrays import FloatArray
from . import kinds

if TYPE_CHECKING:
    from .. import Model, Result, Section

LENGTH = 8.0  # m
E, AREA, INERTIA, DENSITY = 68.95e9, 7.299e-5, 8.215e-9, 2766.67  # N/m^2, m^2, m^4, kg/m^3
STEP, T_END = 1e-3, 20.0  # s
OMEGA, T_SPIN = 4.0, 15.0  # rad/s, s

#: Angle of the clamp (eq. 33), rad, and its derivatives, as formulas of t in s.
ANGLE = (
    f"where(t < {T_SPIN}, {OMEGA}/{T_SPIN}*(t**2/2 + ({T_SPIN}/(2*pi))**2*(cos(2*pi*t/{T_SPIN}) - 1)), "
    f"{OMEGA}*(t - {T_SPIN}/2))"
)
RATE = f"where(t < {T_SPIN}, {OMEGA}*(t/{T_SPIN} - sin(2*pi*t/{T_SPIN})/(2*pi)), {OMEGA})"
ACCELERATION = f"where(t < {T_SPIN}, {OMEGA}/{T_SPIN}*(1 - cos(2*pi*t/{T_SPIN})), 0)"

NOTES = [
    "Example 7.3: A = 7.299e-5 m^2, I = 8.215e-9 m^4, rho = 2766.67 kg/m^3, no gravity; eq. 33 with "
    "(T_s/(2 pi))^2, so that the angular acceleration is continuous.",
    "Displacements of the tip in the frame that turns with the clamp; negative u_transverse lags behind.",
    'Prescribed position and all slopes at the clamp, r_x or r_x, r_y, r_z (stretch="fixed").',
    "Section of the beams: a rectangle of 36.75 x 1.986 mm that bends in its wide direction.",
    kinds.NOTE,
    "Trapezoidal rule, step 1 ms.",
]


def section(element: str = kinds.CABLE) -> Section:
    """Stiffnesses in the plane of the motion, x and y; for a beam the rectangle that has them."""
    if element == kinds.CABLE:
        return ancf.Section(EA=E * AREA, EI=E * INERTIA, rhoA=DENSITY * AREA)
    width = (12.0 * INERTIA / AREA) ** 0.5
    return ancf.Section.rectangle(width, AREA / width, E=E, rho=DENSITY)


def build(
    elements: int = 4, element: str = "cable", strain: str | None = None, stretch: str = "fixed"
) -> Model:
    """Model of the example; its beam is called "arm".

    Parameters
    ----------
    elements : int
        Number of elements.
    element : str
        Kind of element, one of ``kinds.KINDS``.
    strain : "paper" or "material"
        Strain measures of the cable, default "paper".
    stretch : "fixed" or "free"
        Whether the clamp holds all of the slopes or their directions only.

    """
    model = ancf.Model(title="Spin-up of a cantilever, example 7.3")
    arm = model.add_beam(
        "arm",
        start=(0.0, 0.0, 0.0),
        end=(LENGTH, 0.0, 0.0),
        elements=elements,
        section=section(element),
        **kinds.options(element, strain),
    )
    model.clamp(
        arm.start,
        stretch=stretch,
        rotation=ANGLE,
        axis=(0, 0, 1),
        rotation_rate=RATE,
        rotation_acceleration=ACCELERATION,
    )
    return model


def run(model: Model, t_end: float = T_END, output_step: float | None = None) -> Result:
    """Motion until t_end in s; `output_step` in s between stored states, default every step."""
    return ancf.simulate(
        model, t_end=t_end, step=STEP, integrator=ancf.Trapezoidal(), output_step=output_step
    )


def tip_displacement(result: Result) -> tuple[FloatArray, FloatArray]:
    """Transverse and axial displacement (n,) of the tip in the tangential frame of the clamp, m."""
    x, y, _ = result.position("arm.end").T
    slope = result.slope("arm.start")
    cos, sin, _ = (slope / np.linalg.norm(slope, axis=1, keepdims=True)).T
    return cos * y - sin * x, cos * x + sin * y - LENGTH
