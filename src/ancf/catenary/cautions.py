"""Warnings: what a run cannot show, from its plan and from what it recorded."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from .answers.signals import CUT_OFF, at_zero
from .answers.statistics import MEAN_FORCE_LAW, mean_force_target
from .forms.reach import without_droppers
from .lines.doubts import doubts
from .lines.galloping import said as galloping
from .plan import RUN_IN, Plan
from .sleeping import REDUCED

if TYPE_CHECKING:
    from .answers.run_data import Run

#: Share of the wave speed from which on the forces grow without limit.
NEAR = 0.9
#: Largest element in lengths of the shortest wave that runs ahead, by its frequency up to the cut-off.
LARGEST = 0.9
#: Largest step, s: the implicit rules shift a wave by a twelfth of the square of its angle in a step, and
#: 4 ms are half a radian at the cut-off.
LONGEST = 4e-3
#: Lift of a pantograph over the largest mean force of the standards from which on units are to be looked at.
HARD = 2.0
#: Decay of vibrations at half the cut-off, 1/s, below which spans that are linear come out of step with
#: others, as frequencies follow the tension; and uplift of a support, m, from which on that changes much.
DECAY, LIFTED = 0.15, 0.1
#: Losses of contact of one or two steps from which on they are chatter.
CHATTER = 3


def before(plan: Plan, sleeps: bool = False) -> Iterator[str]:
    """What is to be said about a run before it is computed; ``sleeps``: spans are to be reduced."""
    yield from _speed(plan)
    if sleeps:
        yield from _hardly_damped(plan)
    yield from _lift(plan)
    yield from doubts(plan.form.line)
    for part in plan.form.line.parts:
        yield from without_droppers(part)
    if plan.step > LONGEST * (1.0 + 1e-9):
        text = (
            f"run.step: {1e3 * plan.step:g} ms is long for what is evaluated up to {CUT_OFF:g} Hz: standard "
        )
        yield (
            text + f"deviations change by some percent; take {1e3 * LONGEST:g} ms or less, 1 ms by default"
        )
    for text in galloping(plan.form.line):
        yield f"line.conditions.wind: {text}"
    run_in = plan.window[0] - plan.places[0]
    if run_in < RUN_IN - 1e-6:
        text = (
            f"run.window: begins {run_in:.4g} m after the place where the first pantograph starts: what its "
        )
        yield text + f"start has stirred up is evaluated; leave {RUN_IN:g} m or more"


def _lift(plan: Plan) -> Iterator[str]:
    """Pantographs that push much harder than any law of the mean force has it."""
    top = plan.travel.top
    law = max(mean_force_target(3.6 * top, supply) for supply in MEAN_FORCE_LAW)
    for unit in {one.name: one for one in plan.pantographs}.values():
        force = float(unit.force(top))
        if force > HARD * law:
            text = (
                f"pantograph.{unit.name}: pushes with {force:.0f} N at {3.6 * top:.0f} km/h, where EN 50367 "
            )
            text += f"has {law:.0f} N at most; static_force is in N, aerodynamic in N s^2/m^2: 0.0126 for "
            yield text + "0.00097 N h^2/km^2"


def _hardly_damped(plan: Plan) -> Iterator[str]:
    """Lines along which vibrations last, so that spans which are reduced come out of step."""
    hertz = 0.5 * CUT_OFF
    omega = 2.0 * np.pi * hertz
    decay = min(
        part.damping.alpha + omega**2 * part.damping.beta + part.contact_wire.damping / part.contact_wire.mass
        for part in plan.form.line.parts
    )
    if decay < DECAY:
        text = f"run.reduce: damping takes {decay:.2g}/s at {hertz:g} Hz, hardly any: spans that move by "
        text += "their modes come out of step with the line, and standard deviations may change by 1 to 2 %; "
        yield text + "give line.damping, or leave reduce out"


def _speed(plan: Plan) -> Iterator[str]:
    top = plan.travel.top
    wave, largest = plan.form.wave_speed, plan.form.mesh.contact
    if top >= NEAR * wave:
        text = f"run.speed: {3.6 * top:.0f} km/h is {top / wave:.4g} of the wave speed of the contact wire, "
        text += f"{3.6 * wave:.0f} km/h: "
        if top < wave:
            yield text + "near it forces and uplift grow without limit, and no mesh resolves the waves ahead"
        else:
            yield text + "no wave runs ahead of the pantograph"
        return
    shortest = (wave - top) / CUT_OFF
    if largest > LARGEST * shortest:
        text = f"mesh.contact: elements of {largest:g} m do not resolve the waves ahead of a pantograph at "
        text += (
            f"{3.6 * top:.0f} km/h, {shortest:.2g} m at {CUT_OFF:g} Hz: standard deviations may be off by "
        )
        yield text + f"more than 3 %; take {LARGEST * shortest:.2f} m or less"


def after(run: Run) -> Iterator[str]:
    """What is to be said about a run that is computed.

    A rigid joint knows of impacts that are over in a step: theirs is not judged.
    """
    lift = float(np.nanmax(run.uplift, initial=0.0))
    if run.settings.get(REDUCED, 0) and lift > LIFTED:
        text = f"run.reduce: supports are lifted by {1e3 * lift:.0f} mm, more than spans that move by their "
        yield text + "modes can follow: standard deviations may change by 1 to 3 %; leave reduce out to see"
    if run.settings.get("contact") != "penalty":
        return
    for recording in run.recordings:
        bounds = at_zero(recording.force, 1.0).bounds
        ended = bounds[bounds[:, 1] < recording.force.size]
        short = int(np.sum(ended[:, 1] - ended[:, 0] <= 2))
        if short >= CHATTER:
            text = (
                f"contact of {recording.name}: is lost {short} times for one or two steps only: it chatters, "
            )
            text += "the step does not resolve the motion of the head on the wire; extremes and losses mean "
            yield text + "nothing; take a shorter step, a softer contact or more numerical damping"
