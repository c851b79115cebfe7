"""Example 7.2: a flexible pendulum in space, released horizontally while it turns about the vertical.

Side f mm, density 8000/f^2 kg/m^3, Young's modulus 1e9/f^4 N/m^2: bending stiffness and weight do not
depend on f.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import ancf

from . import kinds

if TYPE_CHECKING:
    from .. import Model, Newton, Result, Section

LENGTH = 1.0  # m
STEP, T_END = 1e-4, 2.0  # s
GRAVITY = 9.81  # m/s^2
OMEGA = 4.0  # rad/s

#: Initial angular velocity, rad/s, of the two readings of the text.
READINGS = {"spatial": (0.0, 0.0, OMEGA), "literal": (0.0, OMEGA, 0.0)}

NOTES = [
    "Example 7.2: x along the undeformed pendulum, z up, gravity 9.81 m/s^2 along -z; square section, side "
    "f mm, f = 5 unless a column says otherwise; pinned at the origin.",
    'The text lets the pendulum turn about a "vertical Y axis" with gravity along z. Taken: 4 rad/s about '
    "the vertical z, hence 4 m/s in y at the tip; the motion is then three-dimensional, as shown.",
    "So that the beams do not turn about their axis, the vertical component of r_y is held at the pin.",
    kinds.NOTE,
    "Trapezoidal rule, step 0.1 ms.",
]

SENSITIVE = (
    "Full Newton, a new Jacobian for every iteration. With 4 original elements the motion is sensitive: a "
    "change of the initial angular velocity by 1e-9 rad/s moves the tip by 1e-10 m at 0.5 s, 1e-7 m at 1 s, "
    "3e-4 m at 1.5 s and 1e-3 m at 2 s, and what Newton's tolerance leaves does the same. Round-off of two "
    "programs does it too: they are compared at 0.5 and 1 s only, where their motion is determinate."
)


def youngs_modulus(f: float) -> float:
    """Young's modulus, N/m^2."""
    return 1e9 / f**4


def section(f: float = 5.0) -> Section:
    """Square of the side f mm."""
    side = 1e-3 * f
    return ancf.Section.rectangle(side, side, E=youngs_modulus(f), rho=8000.0 / f**2)


def build(
    elements: int = 4,
    f: float = 5.0,
    element: str = "cable",
    strain: str | None = None,
    reading: str = "spatial",
) -> Model:
    """Model of the example; its beam is called "rope".

    Parameters
    ----------
    elements : int
        Number of elements.
    f : float
        Parameter of the section, 0.1 to 10.
    element : str
        Kind of element, one of ``kinds.KINDS``.
    strain : "paper" or "material"
        Strain measures of the cable, default "paper".
    reading : "spatial" or "literal"
        Initial rotation about the vertical, or about the horizontal y axis as printed; the motion of
        the second stays in the plane of x and z.

    """
    model = ancf.Model(gravity=(0.0, 0.0, -GRAVITY), title="Pendulum in space, example 7.2")
    rope = model.add_beam(
        "rope",
        start=(0.0, 0.0, 0.0),
        end=(LENGTH, 0.0, 0.0),
        elements=elements,
        section=section(f),
        **kinds.options(element, strain),
    )
    rope.set_motion(angular_velocity=READINGS[reading])
    model.pin(rope.start)
    if element != kinds.CABLE:
        model.hold(rope.start, slope_y="z")
    return model


def exact_newton() -> Newton:
    """Full Newton method, which leaves nothing of a step's residual but rounding."""
    return ancf.Newton(modified=False, corotate=False)


def run(
    model: Model, t_end: float = T_END, output_step: float | None = None, newton: Newton | None = None
) -> Result:
    """Motion until t_end in s; `output_step` in s between stored states, default every step."""
    method = ancf.Trapezoidal() if newton is None else ancf.Trapezoidal(newton=newton)
    return ancf.simulate(model, t_end=t_end, step=STEP, integrator=method, output_step=output_step)
