"""Bending strain of the contact wire where forces act on it: at the clamps of the droppers, below a strip.

A force F bends a wire under the tension T within some lambda = sqrt(EI/T), a decimetre, which elements of a
run do not resolve. The beam under tension has it in closed form: EI w'''' - T w'' = F delta has
w'' = -F exp(-|x|/lambda) / (2 sqrt(EI T)), and of a force that moves with v the same with T - rhoA v^2 for T.
T is the tension that the wire has at rest under the conditions of the line: warm, worn, in the wind.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from .cycles import Cycles, rainflow
from .passing import check_run, dropper_places
from .signals import Butterworth, sample_rate

if TYPE_CHECKING:
    from ..lines.line import Line
    from ..lines.route import Route
    from ..lines.wire import Wire
    from .run_data import Run

#: Bending strain that a pantograph may cause in contact wires of all alloys, by the rule of RTRI (Ohara and
#: Yamashita, Quarterly Report of RTRI 66 (2025) 84-89, who tell its origin in tests of hard-drawn copper).
ALLOWED = 500e-6


@dataclass(frozen=True)
class ClampStrain:
    """Strain of the upper edge of the contact wire at the clamp of a dropper by bending, while trains pass.

    Parameters
    ----------
    span, number : int
        Of the dropper, from 1.
    position : float
        Track position, m.
    rest, largest, smallest : float
        Before the run and its extremes.
    cycles : Cycles
        Of its history, by rainflow.

    """

    span: int
    number: int
    position: float
    rest: float
    largest: float
    smallest: float
    cycles: Cycles

    @property
    def change(self) -> float:
        """Largest difference to the strain at rest, which a gauge that is set to zero before would show."""
        return max(self.largest - self.rest, self.rest - self.smallest)


def bends(line: Line | Route) -> bool:
    """Whether the contact wire bends as a beam under tension: without stiffness its strain is endless.

    That of a conductor rail is spread over its span instead.
    """
    wire = line.parts[0].contact_wire
    return bool(wire.EI > 0.0 and not getattr(wire, "rail", False))


def strained(run: Run) -> bool:
    """Whether contact wires bend, and all pantographs run below their wave speeds: strains are known."""
    if not bends(run.form.line):
        return False
    fastest = [float(np.max(_speeds(run, k))) for k in range(len(run.recordings))]
    return all(np.isfinite(strain_of_force(wire, speed)) for wire in hanging(run) for speed in fastest)


def hanging(run: Run) -> list[Wire]:
    """All contact wires as they hang: with the tension, mass and stiffness of their state."""
    return [shape.wire for form in run.form.shifted for shape in form.contacts]


def edge(wire: Any) -> float:
    """Distance of the edge of a contact wire from its axis, m; of a round bar if no diameter is given."""
    given = getattr(wire, "diameter", None)
    return 0.5 * given if given is not None else 2.0 * float(np.sqrt(wire.EI / wire.EA))


def strain_of_force(wire: Any, speed: Any = 0.0) -> Any:
    """Bending strain of a contact wire at a force of 1 N that stands, or moves with a speed in m/s, 1/N.

    Of several speeds an array. It grows without limit towards the wave speed, from where on it is endless.
    """
    pull = wire.tension - wire.mass * np.square(speed)
    known = wire.EI * pull > 0.0
    stiff = np.where(known, wire.EI * pull, 1.0)
    return np.where(known, edge(wire) / (2.0 * np.sqrt(stiff)), np.inf)[()]


def strain_below_strip(run: Run, pantograph: int) -> FloatArray:
    """Strain (n,) of the upper edge below the strip of a pantograph, by its contact force below 20 Hz.

    Of several wires that it touches the one with the largest.
    """
    recording, rate, butterworth = run.recordings[pantograph], sample_rate(run.t), Butterworth()
    speed = _speeds(run, pantograph)
    strains = [
        strain_of_force(wire, speed) * butterworth.low_pass(recording.force_on(k), rate)
        for k, wire in enumerate(hanging(run))
    ]
    return np.asarray(np.max(strains, axis=0), dtype=np.float64)


def clamp_strains(run: Run, over: tuple[float, float] | None = None) -> list[ClampStrain]:
    """Strains at the clamps of the droppers between two track positions, by default those of the window.

    The force of a clamp is that of its dropper less its weight; where a strip passes, its contact force
    below 20 Hz adds to it, also at the very instant of the passing. What the strip gives above 20 Hz
    accelerates the clamp, whose inertia is left out, as is that of the wire. From the wave speed on the
    closed form has no strain below a strip, and nothing is returned.
    """
    check_run(run, "clamp_strains")
    low, high = run.window if over is None else checks.array(over, "clamp_strains.over", (2,)).tolist()
    if not low <= high:
        raise ModelError(
            "clamp_strains.over", f"begins at {low:g} m and ends at {high:g} m", "the smaller first"
        )
    if not strained(run):
        return []
    rate, butterworth, found, first, before = sample_rate(run.t), Butterworth(), [], 0, 0
    wires = hanging(run)
    for part in run.form.line.parts:
        on_wires = [
            [butterworth.low_pass(one.force_on(before + wire), rate) for one in run.recordings]
            for wire in range(part.contact_wires)
        ]
        places = dropper_places(run)[first : first + len(part.dropper_x)]
        for j, (span, number, x) in enumerate(places, start=first):
            if low <= x <= high:
                own = int(part.dropper_wire[j - first])
                history, rest = _history(run, part, wires[before + own], on_wires[own], j, x)
                extremes = float(np.max(history)), float(np.min(history))
                found.append(ClampStrain(span, number, x, rest, *extremes, rainflow(history)))
        first, before = first + len(part.dropper_x), before + part.contact_wires
    return found


def _history(
    run: Run, part: Line, wire: Wire, contact: list[FloatArray], j: int, x: float
) -> tuple[FloatArray, float]:
    """Strain at a clamp at the steps and at the passings of strips, and at rest."""
    droppers = part.droppers
    half = 0.5 * droppers.mass * float(run.form.dropper_length[j])
    weight, standing = part.gravity * (droppers.clamp_contact + half), strain_of_force(wire)
    moments = [_passings(run, k, x) for k in range(len(run.recordings))]
    t = np.union1d(run.t, np.concatenate(moments))
    strain = standing * (np.interp(t, run.t, run.dropper_force[:, j]) - weight)
    for k, recording in enumerate(run.recordings):
        speed = np.interp(t, run.t, _speeds(run, k))
        length = np.sqrt(wire.EI / np.maximum(wire.tension - wire.mass * speed**2, 1e-9 * wire.tension))
        away = np.abs(np.interp(t, run.t, recording.position) - x)
        force = np.interp(t, run.t, contact[k])
        strain = strain + strain_of_force(wire, speed) * force * np.exp(-np.minimum(away / length, 50.0))
    return strain, standing * (float(run.form.dropper_force[j]) - weight)


def _speeds(run: Run, k: int) -> FloatArray:
    """Speeds (n,) of a pantograph at all steps, m/s."""
    made: FloatArray = np.abs(np.gradient(run.recordings[k].position, run.t))
    return made


def _passings(run: Run, k: int, x: float) -> FloatArray:
    """Times (n,) at which a pantograph is at a track position, s."""
    ahead = run.recordings[k].position - x
    i = np.flatnonzero((ahead[:-1] < 0.0) & (ahead[1:] >= 0.0))
    made: FloatArray = run.t[i] - ahead[i] * (run.t[i + 1] - run.t[i]) / (ahead[i + 1] - ahead[i])
    return made
