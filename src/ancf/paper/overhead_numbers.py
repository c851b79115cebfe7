"""Overhead lines in practice: states, geometry, hand-over and trains, beside formulas and another model."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..viz import style
from .check import Check
from .closed import line_gallop, line_parts, line_runs, line_states, line_twin
from .table import Table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

TITLE = "Overhead lines: states, geometry, hand-over, trains"
EXAMPLE = ""
CLAIM = (
    "Not in the paper. Lines that are warm, blown aside, curved, on a gradient or hung with measured "
    "droppers, pantographs that change wires or follow each other: beside formulas and an "
    "independent plane model."
)
COLUMNS = ("name", "value", "reference", "tolerance", "unit", "origin")
SIZE = (170.0, 120.0)  # mm
LOWEST = 1e-4  # of what is accepted: the axis starts there

NOTES = [
    "Temperature: one contact wire alone, 10 kN, 0.95 kg/m, EA = 12 MN, expansion 17e-6 per degree, "
    "five spans of 40 m with weights, one of 60 m between fixed ends; designed for 10 degrees Celsius.",
    "Wind: that wire in spans of 50 m; two wires in spans of 48 m with twelve droppers each. Air of "
    "1.225 kg/m^3, drag coefficient 1.",
    "Curve, gradient, droppers as built: contact wire of 20 kN, messenger of 16 kN, five spans of 30 to 38 "
    "m.",
    "Overlap: two tension lengths of seven spans of 40 m that share four; a pantograph of 3 m/s for the "
    "force, of 20 m/s for the momentum.",
    "Conductor rail: fifteen spans of 10 m, EI = 230 kN m^2, 6.9 kg/m. Pantograph as a lever: a level rod of "
    "2.2 m and 45 kg, 7.2 kg on 4200 N/m at its tip, 40 m/s, beside 15 kg below that head.",
    "Twin contact wires: two of 0.675 kg/m and 10 kN, 40 mm apart, in three spans of 48 m with 12 droppers "
    "each; alone in spans of 45 m.",
    "Galloping: one wire of 40 m, 15 kN, 12.2 mm, drag coefficient 1.1, lift straight over the angle of "
    "attack, alpha 0.05 1/s; its second mode after a push.",
    "Trains: two pantographs on the reference models of EN 50318 with the default mesh and step, forces "
    "below 20 Hz with a filter of order 4.",
]


def data(short: bool = False) -> Table:
    """All numbers; the short form has some lines at rest alone."""
    found = [*line_states.checks(short), *line_parts.checks(short)]
    if not short:
        found += [*line_twin.checks(), *line_gallop.checks(), *line_runs.checks()]
    rows = [(c.name, c.value, c.reference, c.tolerance, c.unit, c.origin) for c in found]
    return Table("overhead", COLUMNS, [*rows], [*NOTES])


def checks(table: Table) -> list[Check]:
    """Each number within what is accepted."""
    return [Check(*row) for row in table.rows]  # type: ignore[arg-type]


def draw(table: Table, figure: Figure) -> None:
    """Deviations as shares of what is accepted."""
    axes: Axes = figure.subplots()
    used = np.abs(table.values("value") - table.values("reference")) / table.values("tolerance")
    y = np.arange(used.size)
    axes.axvline(1.0, color="black", linewidth=1.2, label="accepted")
    axes.plot(np.maximum(used, 1.3 * LOWEST), y, "o", color=style.BLUE, label="deviation")
    axes.set(xscale="log", xlim=(LOWEST, 3.0), xlabel="deviation over what is accepted")
    names = [str(row[0]).removeprefix("Overhead line, ") for row in table.rows]
    axes.set_yticks(y, names, fontsize=5.5)
    axes.set_ylim(used.size - 0.4, -0.6)
    style.legend_above(figure, axes)
