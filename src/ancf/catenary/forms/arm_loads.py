"""What curve and stagger pull at each steady arm, with its sign, and whether the arm can stand it."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...files import writing
from ...model import checks
from ..lines.fittings import FAINT, hangs

#: Share of the forces by the closed form that droppers and bends may change: less is not judged by it.
ROUGH = 0.1


@dataclass(frozen=True, slots=True)
class ArmLoad:
    """Load of one steady arm at rest.

    Attributes
    ----------
    support : int
        Counted from 1.
    position : float, m
        Track position.
    curve, stagger : float, N
        What the closed form says that the arm has to pull to the left, against the wire in a curve,
        ``-T/R`` over half of both spans, and at the kink of the staggers. T is the tension in this state.
    sideways, upwards : float, N
        What it does pull to the left, and carry.
    side : str
        Where its hinge is: "left" or "right" of the wire; "" of an end.
    acts : str
        "pulls" or "pushes"; "" of an end.

    """

    support: int
    position: float
    curve: float
    stagger: float
    sideways: float
    upwards: float
    side: str
    acts: str


def arm_loads(found: Any) -> list[ArmLoad]:
    """Loads of the steady arms of a Form, or of a RouteForm section after section.

    Of twin contact wires those of the first one.

    Raises
    ------
    ModelError
        It is no form.

    """
    if not hasattr(found, "shifted"):
        what = f"must be a Form, is {checks.shown(found)}"
        raise ModelError("arm_loads.found", what, "ancf.catenary.form finds it, a run has run.form")
    made: list[ArmLoad] = []
    for form in found.shifted:
        line, x = form.line, form.contact.position[form.contact.nodes.support, 0]
        curve, kink = radial(line, form.contact.wire.tension)
        for k, force in enumerate(form.arm_force):
            end = k in (0, len(form.arm_force) - 1)
            side, sideways = "" if end else form.arm(k).stands(float(force[1])), float(force[1])
            acts = "" if end else "pushes" if form.arm(k).sense(sideways) < 0.0 else "pulls"
            where = len(made) + 1, float(x[k])
            made.append(
                ArmLoad(*where, float(curve[k]), float(kink[k]), sideways, float(force[2]), side, acts)
            )
    return made


#: Heads of the columns of the CSV file, in the order of the fields.
COLUMNS = ("support", "track_m", "by_curve_N", "by_stagger_N", "to_the_left_N", "up_N", "hinge", "acts")


def texts(row: ArmLoad) -> list[str]:
    """A row as it is printed and written."""
    forces = (row.curve, row.stagger, row.sideways, row.upwards)
    return [
        str(row.support),
        f"{row.position:.3f}",
        *(f"{round(force, 1) + 0.0:.1f}" for force in forces),
        row.side,
        row.acts,
    ]


def write(loads: list[ArmLoad], path: Path) -> Path:
    """Write the loads of all arms as CSV; ModelError if the file cannot be written."""
    with writing(path), path.open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file)
        writer.writerow(COLUMNS)
        writer.writerows(texts(row) for row in loads)
    return path


def radial(line: Any, tension: float | None = None) -> tuple[FloatArray, FloatArray]:
    """Forces (supports,) to the left that the arms need for curves, and for staggers, N; none at the ends.

    Under the tension of the contact wire in a state, N, by default that of the design.
    """
    tension = line.contact_wire.tension if tension is None else tension
    length = np.array([span.length for span in line.spans])
    bend = length * np.array([span.curvature for span in line.spans])
    slope = np.diff(line.stagger) / length
    curve, kink = np.zeros(length.size + 1), np.zeros(length.size + 1)
    curve[1:-1] = -0.5 * tension * (bend[1:] + bend[:-1])
    kink[1:-1] = -tension * np.diff(slope)
    return curve, kink


def check_roughly(line: Any) -> None:
    """Raise ModelError where an arm would clearly be pushed that can only pull, by the closed form."""
    curve, kink = radial(line)
    least = FAINT + ROUGH * (np.abs(curve) + np.abs(kink))
    for k, force in enumerate((curve + kink).tolist()):
        if abs(force) > least[k] and 0 < k < len(line.spans):
            _check(line, k, force, curve, kink)


def check_arms(line: Any, force: FloatArray) -> None:
    """Raise ModelError where an arm that can only pull is pushed by forces (supports, 3) on the wire, N."""
    curve, kink = radial(line)
    for k in range(1, len(force) - 1):
        _check(line, k, float(force[k, 1]), curve, kink)


def sides(force: FloatArray) -> tuple[str, ...]:
    """The side of the wire to which each arm pulls by forces (supports, 3) in N; "" where it does not."""
    across = force[:, 1].tolist()
    return tuple("" if abs(f) < FAINT else "left" if f > 0.0 else "right" for f in across)


def pushed(found: Any) -> list[str]:
    """The same of a Form as texts, for states in which it is a finding and no mistake of the design.

    Springs of which nobody said where they stand may push: they stand for any kind of arm. Hinged arms that
    carry next to nothing, or more than they pull with, are named too.
    """
    said = []
    for k in range(1, len(found.arm_force) - 1):
        given, arm, force = found.line.arm(k), found.arm(k), found.arm_force[k]
        across, up = float(force[1]), abs(float(force[2]) + 0.5 * given.mass * found.line.gravity)
        if (given.hinged or given.side) and arm.refuses(across):
            said.append(f"support {k + 1}: {_said(arm, across)}: it can only pull")
        elif given.hinged and hangs(np.array([0.0, across, up])):
            text = f"support {k + 1}: the arm pulls with {abs(across):.0f} N and carries {up:.0f} N"
            said.append(f"{text}: it hangs {'loose' if abs(across) < FAINT else 'steep'}")
    return said


def _said(arm: Any, force: float) -> str:
    return f"the arm stands to the {arm.side} of the wire and is pushed with {abs(force):.0f} N"


def _check(line: Any, k: int, force: float, curve: FloatArray, kink: FloatArray) -> None:
    arm = line.arm(k)
    if not arm.refuses(force):
        return
    from_curve, from_kink = (-abs(v) if v * force < 0.0 else abs(v) for v in (curve[k], kink[k]))
    what = f"{_said(arm, force)} at support {k + 1}, {from_curve:.0f} N by the curve and {from_kink:.0f} N "
    what += "by the staggers: it can only pull"
    other = "right" if arm.side == "left" else "left"
    in_table = k < len(line.rows)
    where = f"{line.rows[k]}arm_side" if in_table else "line.steady_arm.side"
    if isinstance(line.steady_arm, tuple) and not in_table:
        where = f"line.steady_arm[{k}].side"
    push = "arm_push = yes" if in_table else "push = true"
    raise ModelError(where, what, f'other staggers, the side "{other}", or {push} for an arm that can push')
