"""Spans that are reduced to their modes while no pantograph is near them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

import ancf

from ..arrays import FloatArray, IntArray
from ..control.foreseen import Foreseen
from ..control.lead import check_controller, led
from ..errors import ModelError
from ..model import checks
from ..model.points import Point
from ..preparation import Prepared, carried_out, prepared
from ..results.result import Result
from ..solvers.sleeping.arrays import FarPlan
from ..solvers.sleeping.spans import FarSpans
from ..system.nodes import node_of
from ..system.system import System
from .answers.signals import CUT_OFF
from .assemble import Assembled

#: Modes are taken up to this multiple of the cut-off of what is evaluated.
BEYOND = 2.5
#: How many spans are reduced, in the settings of a run.
REDUCED = "spans that are reduced while no pantograph is near"
#: Distance of a strip at which a span is taken as it is, m.
NEAR = 7.0


@dataclass(frozen=True)
class Sleep:
    """What a run with spans that sleep needs of the line without pantographs.

    Parameters
    ----------
    rest : State
    """

    rest: ancf.State

    def plan(self, system: System, overhead: Assembled) -> FarPlan:
        """Of a system of the line with its pantographs."""
        rest = system.initial_shape()
        for name, slots in self.rest.slots.items():
            if name in system.slots:
                for c in range(3):
                    rest[system.slots[name] + c] = self.rest.q[slots + c]
        return FarPlan(cuts(overhead, system), rest, BEYOND * CUT_OFF, NEAR)


def allowed(given: bool, integrator: Any, *, touch: str, derived: bool, where: str = "run.reduce") -> bool:
    """Whether spans are to sleep, as ``run(reduce=...)`` says.

    Parameters
    ----------
    given : bool
    integrator : integrator or None
        Default that of :func:`ancf.catenary.run`.
    touch : str
        Kind of the contact.
    derived : bool
        Whether sensitivities are wanted.

    Raises
    ------
    ModelError
        Something does not go together with it.
    """
    if not checks.flag(given, where):
        return False
    newton = getattr(integrator, "newton", None)
    plain = integrator is None or (newton is not None and newton.modified and not newton.corotate)
    against = {
        "sensitivities": derived,
        'contact="joint"': touch == "joint",
        "an integrator that does not keep its matrix as it is": not plain,
    }
    there = next((name for name, found in against.items() if found), None)
    if there is not None:
        raise ModelError(where, f"does not go together with {there}", "leave one of both out")
    return True


def cuts(overhead: Assembled, system: System) -> IntArray:
    """Blocks of the unknowns of all wires' nodes at the supports, which part a line into its spans."""
    roots = [root for part in overhead.parts or [overhead] for root in _roots(part, system)]
    every = [slots for slots in system.numbering.slots.values() if len(slots)]
    found = [slots[np.isin(slots[:, 0], roots)].ravel() // 6 for slots in every]
    return np.unique(np.concatenate(found))


def _roots(overhead: Assembled, system: System) -> list[int]:
    """Slots of the positions of the nodes at the supports of a tension length."""
    points: list[Point] = []
    for wire in overhead.wires:
        if wire is not None:
            points += [wire.point(int(node)) for node in wire.shape.nodes.support]
    supports = overhead.form.line.supports if overhead.stitches else np.zeros(0)
    for k, wire in enumerate(overhead.stitches):
        nearest = np.argmin(np.abs(wire.shape.position[:, 0] - supports[k + 1]))
        points.append(wire.point(int(nearest)))
    slots = system.numbering.slots
    return [int(slots[p.body.name][node_of(p.body, p.x), 0]) for p in points]


def reduced(made: Prepared, overhead: Assembled, sleep: Sleep) -> FarSpans:
    """Let spans of a simulation sleep that has not taken a step yet."""
    made.system.inputs = Foreseen(made.system.inputs)  # a block of steps ends where a span turns
    run: Any = made.run
    spans: FarSpans = run.reduce(sleep.plan(made.system, overhead))
    return spans


def simulated(
    overhead: Assembled,
    sleep: Sleep,
    *,
    file: str | Path | None,
    progress: Callable[[Any], None] | None,
    integrator: Any,
    controller: Callable[[Any], Any] | None = None,
    control_step: float | None = None,
    **given: Any,
) -> tuple[Result, FarSpans]:
    """As :func:`ancf.simulate`, with spans that sleep."""
    every = 0
    if controller is not None:
        every = check_controller(controller, control_step, given["step"], "run")
    made = prepared(overhead.model, method=integrator, **given)
    spans = reduced(made, overhead, sleep)
    if controller is not None:
        made = led(made, controller, every, "run")
    store = made.store(file)
    return carried_out(made, store, progress), spans


def said(spans: FarSpans | None) -> dict[str, Any]:
    """What the settings of a run say of it."""
    if spans is None:
        return {}
    if not spans.parts:
        return {REDUCED: 0}
    modes: FloatArray = np.array([len(kind.square) for kind in spans.kinds])
    return {
        REDUCED: len(spans.parts),
        "their modes up to [Hz]": BEYOND * CUT_OFF,
        "modes of a span, at most": int(modes.max()),
        "displacement that these leave out, largest [m]": spans.left_out,
        "force at supports that these leave out as spans begin to move by them, largest [N]": spans.neglected,
    }
