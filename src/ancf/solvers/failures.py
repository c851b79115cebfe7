"""What is said of a step of the Newmark family that has failed for good."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..batches import Batches
from ..errors import ModelError, SolveError
from ..loads.law_functions import problem_of
from ..loads.state_force import law_of, places_of
from ..model.kinds import kind_of
from ..system.compile import beams_by_kind
from ..system.core import find_inverted
from ..system.system import System
from .bridge import MOST_PARTS
from .status import COLLAPSED, DIVERGED, FAR, NOT_FINITE, SINGULAR, SLOW, THROUGH, TOO_MANY, UNBALANCED
from .step.memory import NORM, WORST

REASONS = {
    DIVERGED: "Newton's method diverged, also with full Jacobians and smaller steps",
    NOT_FINITE: "the forces are no longer finite, also with smaller steps",
    SINGULAR: "the iteration matrix is singular",
    SLOW: "Newton's method did not converge, also with full Jacobians and smaller steps",
    FAR: "the motion in a step is too large, also in smaller steps",
    UNBALANCED: "energy came from nowhere, also with smaller steps",
    TOO_MANY: f"steps had to be halved, into more than {MOST_PARTS} parts on average",
}

HINT = "a law must have a value wherever its point may get"


def blamed(
    system: System, q: FloatArray, v: FloatArray, t: float, number: int, h: float
) -> SolveError | None:
    """The law of a force that has no value in a step from the state q, v at t, or None.

    What a law raises in a step is lost; so it is asked again, in Python, where its point would be on the way.
    """
    where = f"t = {t:.6g} s, step {number}"
    for fluid in system.model.fluids:
        if fluid.velocity.once and (problem := problem_of(fluid.velocity)) is not None:
            return SolveError(f"{where}, {problem.where}", problem.what, HINT)
    for load in system.model.loads:
        if kind_of(load).batch != "state_force" or not kind_of(load).has_batch(load):
            continue
        if law_of(load).once and (problem := problem_of(law_of(load))) is not None:
            return SolveError(f"{where}, {problem.where}", problem.what, HINT)
        for point, _ in places_of(load):
            probe, law = system.probe(point), law_of(load)
            for share in (0.0, 0.25, 0.5, 0.75, 1.0):
                try:
                    law(t + share * h, probe.field(q + share * h * v), probe.field(v))
                except ModelError as error:
                    return SolveError(f"{where}, {error.where}", error.what, HINT)
    return _in_fluids(system, q, v, t, h, where)


def _in_fluids(
    system: System, q: FloatArray, v: FloatArray, t: float, h: float, where: str
) -> SolveError | None:
    """The velocity of a fluid that has no value where the nodes of its bodies are on their way, or None."""
    for fluid in system.model.fluids:
        low, high = fluid.heights
        slots = [s for name, own in system.slots.items() if fluid.acts_on(name) for s in own[:, 0].tolist()]
        for share in (0.0, 0.5, 1.0):
            for slot in slots:
                r = q[slot : slot + 3] + share * h * v[slot : slot + 3]
                if not low <= r[2] <= high:
                    continue
                try:
                    fluid.velocity.at(t + share * h, r)
                except ModelError as error:
                    return SolveError(f"{where}, {error.where}", error.what, HINT)
    return None


def failed(system: System, memo: FloatArray, t: float, number: int, reason: str, h: float) -> SolveError:
    """Step ``number`` of length h at t has failed; ``memo`` is that of the run's memory."""
    where = f"t = {t:.6g} s, step {number}, {system.numbering.describe(int(memo[WORST]))}"
    what = f"{reason}; last correction {memo[NORM]:.3g}, step {h:g} s"
    hint = f"try a step of {h / 10:.2g} s or less, GeneralizedAlpha, more elements, or some damping"
    return SolveError(where, what, hint)


def collapsed(system: System, slot: int, t: float, number: int, h: float) -> SolveError:
    """In step ``number`` of length h at t a section has collapsed, or a beam gone through a surface."""
    place, reason, hint = inverted(system, slot)
    hint = f"try a step of {h / 10:.2g} s or less, {hint}"
    return SolveError(f"t = {t:.6g} s, step {number}, {place}", f"{reason}; step {h:g} s", hint)


def solids(system: System) -> Batches:
    """Elements with cross-sections, which alone are asked whether these are inside out.

    What looks whether a beam has gone through a surface leaves out what is far, for a step that is tried
    again: it is no judge of steps that are not.
    """
    kinds = beams_by_kind(system.model).items()
    return Batches(system.parts[kind] for kind, beams in kinds if beams[0].has_section)


def check_solids(system: System, batches: Batches, q: FloatArray, t: float, number: int, h: float) -> None:
    """Raise SolveError if a section of those of :func:`solids` is inside out after step ``number``."""
    slot = int(find_inverted(batches, system.core.ws, q)) if len(batches) else -1
    if slot >= 0:
        raise collapsed(system, slot, t, number, h)


def inverted(system: System, slot: int) -> tuple[str, str, str]:
    """Where and what a slot says that a batch has given as inverted, and what to do beside smaller steps."""
    for name, slots in system.slots.items():
        if slot in slots[:, 0]:
            place = f"{name} element {int(np.flatnonzero(slots[:, 0] == slot)[0])}"
            return place, THROUGH, "or a stiffer contact"
    return system.element_of(slot), COLLAPSED, "GeneralizedAlpha, more elements, or a stiffer section"
