"""Example 7.5: a pantograph runs along an overhead line of four spans, in space.

The paper leaves out the pantograph's data (its table 4) and the tensions of the wires; what was taken
instead is in the catalogue of :mod:`ancf.catenary`, each value with a tag.
"""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import ancf

from .. import catenary

if TYPE_CHECKING:
    from ..catenary import Form, Line, Overhead, Pantograph, Run, Statistics

NAME = "paper-7.5"  # of line and pantograph in the catalogue
SPEEDS = (32.0, 45.0)  # m/s
MESH = catenary.Mesh(contact=15.0 / 14.0, messenger=15.0 / 8.0)  # 224 elements of the contact wire, 128 above
START = 2.0  # m, from the first support
STEP, SHORT_STEP = 5e-4, 1e-3  # s
WINDOW = (60.0, 180.0)  # m, the two middle sections
#: What is left before the last support at the end of a run, m.
LEFT = 2.0
SHORT_SPANS = 2
#: The wires have no damping along themselves: what the step cannot resolve there has to decay in the method.
INTEGRATOR = ancf.GeneralizedAlpha(0.6, newton=ancf.Newton(tolerance=1e-9, corotate=False))

NOTES = [
    "Example 7.5, table 3: 4 sections of 60 m, contact wire and carrier EA = 1.342e7 N, EI = 150 N m^2, "
    "0.89 and 0.446 kg/m; 7 droppers a section, EA = 1.342e6 N, 0.089 kg/m, without compression; zigzag "
    "0.3 m; carrier 1.5 m above the contact wire at the masts; gravity 9.81 m/s^2; 224 elements of the "
    "contact wire.",
    "Not in the paper and assumed: tension of both wires 10 kN; droppers every 7.5 m; carrier held above the "
    "middle of the track, hinged at the masts; contact wire held at rest at zero height at the masts, steady "
    "arms of 300 N/m vertically; all ends fixed; 128 elements of the carrier. Droppers: springs with half of "
    "their mass at each end, their EI neglected.",
    "Table 4, the pantograph, is missing in the paper: the two masses of EN 50318:2002 were taken (15 and "
    "7.2 kg, 50 and 4200 N/m, 90 and 10 N s/m), and the paper's contact force of 100 N at standstill.",
    "Damping of table 3: 0.03 N s/m^2 as a viscous force per length and velocity, 8 N s/m as a damper beside "
    "each dropper's spring.",
]


@cache
def _plane() -> dict[str, Any]:
    text = files(__package__).joinpath("data", "plane.json").read_text(encoding="utf-8")
    found: dict[str, Any] = json.loads(text)
    return found


def plane(speed: float) -> tuple[float, float]:
    """Mean force and standard deviation below 20 Hz of the independent plane linear model, N."""
    row = _plane()["runs"][f"{speed:g}"]
    return row["mean"], row["sigma"]


def plane_heights() -> list[float]:
    """Heights of its carrier above its contact wire at the droppers of an inner section, m."""
    heights: list[float] = _plane()["heights"]
    return heights


def plane_origin() -> str:
    """What that model is, for the origin of a check."""
    origin: str = _plane()["origin"]
    return origin


def line(short: bool = False) -> Line:
    """The line; the short form has two of its sections."""
    whole = catenary.read_line(NAME)
    assert isinstance(whole, catenary.Line)
    return whole.excerpt(0, SHORT_SPANS) if short else whole


def pantograph() -> Pantograph:
    """The pantograph."""
    return catenary.find_pantograph(NAME)


@cache
def form(short: bool = False) -> Form:
    """The line at rest; kept, as several figures need it."""
    return catenary.form(line(short), MESH)


def overhead(short: bool = False) -> Overhead:
    """A new model of the line at rest."""
    return catenary.assemble(form(short))


@cache
def history(speed: float, contact: str = "joint", short: bool = False, step: float | None = None) -> Run:
    """A run from the first support to the last one; the window is that of the middle sections.

    Parameters
    ----------
    speed : float, m/s
    contact : "joint" or "penalty"
        The paper's sliding joint without sideways force and without pull, or a stiffness of 50 kN/m.
    short : bool
        Two sections alone, with a step of 1 ms.
    step : float, s
        Default 0.5 ms.

    """
    shape = form(short)
    end = shape.line.length - LEFT
    return catenary.run(
        shape,
        speed=speed,
        pantograph=pantograph(),
        start=START,
        window=(shape.line.supports[1], end) if short else WINDOW,
        until=end,
        contact=contact,
        step=step or (SHORT_STEP if short else STEP),
        integrator=INTEGRATOR,
    )


def measured(run: Run) -> Statistics:
    """Statistics over the window."""
    return catenary.statistics(run)


def text(run: Run) -> str:
    """What was measured in a run, for the notes of a figure."""
    found, force = measured(run), run.recordings[0].force
    low, high = run.window
    names = ("mean_force", "deviation", "maximum", "minimum", "raw_maximum", "raw_minimum", "loss")
    mean, deviation, top, bottom, raw_top, raw_bottom, loss = (found[name].value for name in names)
    return (
        f"Measured, {run.speed:g} m/s, {run.settings['contact']}, {low:.4g} to {high:.4g} m: mean force "
        f"{mean:.1f} N; below 20 Hz standard deviation {deviation:.1f} N, {bottom:.0f} to {top:.0f} N; "
        f"unfiltered {raw_bottom:.0f} to {raw_top:.0f} N, no contact for {loss:.2g} % of the time. Whole "
        f"run, unfiltered: {force.min():.1f} to {force.max():.0f} N; it never pulls."
    )
