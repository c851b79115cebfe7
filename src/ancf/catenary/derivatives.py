"""Derivatives of a run by lengths of droppers: what they do to its model, its records and its statistics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

import ancf

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.points import Point
from ..sensitivity.parameters import Parameter
from ..system.beside import BODIES, SPRINGS, Acts
from .answers.passing import check_run as check_run_of
from .answers.passing import in_window, uplift_in_window
from .answers.run_data import RunSlopes
from .answers.signals import Butterworth, filter_of, sample_rate
from .answers.weights import MM, OF_BANDS, extreme_of, of_filtered
from .assemble import Assembled
from .broken import place_of
from .forms.form import Form
from .twin import second_supports

if TYPE_CHECKING:
    from .answers.run_data import Run
    from .plan import Plan

WHERE = "run.sensitivities"
#: What lengths of droppers act on: these, their clamps and the weight of both.
LENGTHS = Acts(frozenset((SPRINGS, BODIES)), weighs=True)


@dataclass(frozen=True)
class Lengthened:
    """One dropper and what it changes by per metre of its natural length.

    Parameters
    ----------
    name : str
        Of the spring.
    clamps : tuple of str
        Masses that have half of its mass each.
    stiffness, damping : float
        N/m and N s/m per m: with EA it is softer, its clamps give more of their share.
    mass : float
        Of each half, kg per m.

    """

    name: str
    clamps: tuple[str, ...]
    stiffness: float
    damping: float
    mass: float


@dataclass(frozen=True)
class Longer:
    """Builds the model of a line with some droppers longer, to the first order.

    Parameters
    ----------
    model : Model
    droppers : tuple of Lengthened

    """

    model: ancf.Model = field(repr=False)
    droppers: tuple[Lengthened, ...]

    def __call__(self, by: float) -> ancf.Model:
        """The model with natural lengths that are longer by this, m; it shares with it what stays."""
        made = self.model.snapshot()
        own = {dropper.name: dropper for dropper in self.droppers}
        for k, item in enumerate(made.connections):
            if item.name in own:
                made.connections[k] = _longer(item, own[item.name], by)
        for dropper in self.droppers:
            for name in dropper.clamps:
                body = copy(made.bodies[name])
                object.__setattr__(body, "mass", body.mass + dropper.mass * by)  # type: ignore[union-attr]
                made.bodies[name] = body
        return made


def _longer(spring: Any, own: Lengthened, by: float) -> Any:
    stiffness, damping = spring.stiffness + own.stiffness * by, spring.damping + own.damping * by
    return replace(spring, length=spring.length + by, stiffness=stiffness, damping=damping)


def parameters(overhead: Assembled, model: ancf.Model, given: Mapping[str, Sequence[str]]) -> list[Parameter]:
    """Parameters by name of the droppers that they lengthen alike, such as "6-1", span and number from 1.

    Raises
    ------
    ModelError
        There is no such dropper, or it stands twice.

    """
    made = []
    for name, labels in given.items():
        where = f"{WHERE}.{name}"
        if isinstance(labels, str) or not isinstance(labels, Sequence) or not labels:
            raise ModelError(
                where, f"must be a list of droppers, is {checks.shown(labels)}", 'such as ["6-1"]'
            )
        if len(set(labels)) < len(labels):
            raise ModelError(where, "a dropper stands there twice")
        droppers = tuple(_lengthened(overhead, model, label, where) for label in labels)
        made.append(Parameter(name, 0.0, Longer(model.snapshot(), droppers), quadratic=True, acts=LENGTHS))
    return made


def check_run(plan: Plan, given: Any, controller: Any, integrator: Any) -> None:
    """Raise ModelError for runs that have no derivatives by lengths of droppers."""
    if not isinstance(given, Mapping):
        raise ModelError(WHERE, f"must be a mapping, is {checks.shown(given)}", '{"first": ["6-1", "7-1"]}')
    if controller is not None:
        raise ModelError(WHERE, "a controller has no derivatives", "give one of both")
    if not isinstance(plan.form, Form):
        raise ModelError(WHERE, "a route has none", "take one of its tension lengths")
    if plan.touch.kind == "joint" and getattr(integrator, "formulation", "ggl") == "ggl":
        hint = 'contact="penalty", or integrator=ancf.GeneralizedAlpha(0.5, formulation="index2")'
        raise ModelError(WHERE, 'with "ggl" those of a sliding joint\'s force would be up to 10 % off', hint)
    for unit in plan.pantographs:
        if unit.relaxed_at != "nominal" and unit.slopes()[0] > 0.0:
            what = (
                f'the lowest spring of {unit.name} is relaxed at "{unit.relaxed_at}", which the droppers move'
            )
            raise ModelError(WHERE, what, 'take relaxed_at = "nominal"')


def _lengthened(overhead: Assembled, model: ancf.Model, label: Any, where: str) -> Lengthened:
    form = overhead.form
    assert isinstance(form, Form)
    j = place_of(form.line, label, where)
    spring = overhead.droppers[j]
    if spring is None:
        raise ModelError(where, f"dropper {label} is broken")
    droppers, natural = form.line.droppers, float(form.dropper_natural[j])
    stiffness = float(form.dropper_stiffness[j])
    rate, damping, stretch = 0.0, 0.0, 1.0
    if droppers.EA is not None:
        share = float(form.spring_stiffness[j]) / stiffness  # in series with its clamps
        rate = -stiffness / natural * share**2
        damping = 2.0 * droppers.damping * share**3 * float(form.clamp_give[j]) * stiffness / natural
        stretch += float(form.dropper_force[j]) / droppers.EA
    names = (f"{overhead.prefix}{end} clamp {label}" for end in ("lower", "upper"))
    clamps = tuple(name for name in names if name in model.bodies)
    return Lengthened(spring.name, clamps, rate, damping, 0.5 * droppers.mass * stretch)


def records(sensors: Any, begun: Any, name: str, rest: Any, lifted: FloatArray) -> RunSlopes:
    """Derivatives of what a run recorded, of twin contact wires those of the one that is higher at each time.

    ``begun`` is what was made ready, ``rest`` the sensitivity of the line without pantographs, ``lifted`` the
    uplift (steps, supports).
    """
    own, supports = sensors.sensitivity(name), begun.overhead.supports
    force = tuple(np.sum(_forces(sensors, own, c), axis=0) for c in begun.collectors)

    def risen(point: Point) -> FloatArray:
        rate: FloatArray = own.position(point)[:, 2] - float(rest.position(point)[2])
        return rate

    uplift = np.stack([risen(point) for point in supports], axis=1)
    for k, point in second_supports(begun.overhead).items():
        first = sensors.position(supports[k])[:, 2] - begun.rest.height[k]
        uplift[:, k] = np.where(lifted[:, k] > first, risen(point), uplift[:, k])
    return RunSlopes(force, uplift)


def _forces(sensors: Any, own: Any, collector: Any) -> list[FloatArray]:
    """Derivatives of the forces of all contacts of a pantograph, of joints those of multipliers that push."""
    if not collector.slides:
        return [own.contact_force(meter) for meter in collector.meters]
    pushing = (sensors.multiplier(touch)[:, 2] > 0.0 for touch in collector.touches)
    rates = (own.multiplier(touch)[:, 2] for touch in collector.touches)
    return [np.where(on, rate, 0.0) for on, rate in zip(pushing, rates, strict=True)]


def slopes(run: Run, pantograph: int = 0, filter: Butterworth | None = None) -> dict[str, dict[str, float]]:
    """Derivatives of the statistics of one pantograph, by parameter and quantity.

    Those of mean, deviations, extremes of the filtered and the raw force, and the largest uplift. Numbers
    that are counted, as losses of contact, have none.

    Parameters
    ----------
    run : Run
        With ``sensitivities``.
    pantograph : int
    filter : Butterworth, optional
        As of :func:`ancf.catenary.statistics`.

    Returns
    -------
    dict of str to dict of str to float
        Unit of the quantity per m of the parameter.

    """
    return Linearised(run, pantograph, filter).slopes()


class Linearised:
    """Statistics of a run whose contact force changes linearly with the parameters of its sensitivities.

    Not the statistics are linear but the histories: a deviation is the root of a sum of squares, and with the
    whole history of its derivative the sum is known for any change. Near a minimum that tells more than
    the derivative of the deviation, which vanishes there.

    Parameters
    ----------
    run : Run
        With ``sensitivities``.
    pantograph : int
    filter : Butterworth, optional
        As of :func:`ancf.catenary.statistics`.
    """

    def __init__(self, run: Run, pantograph: int = 0, filter: Butterworth | None = None) -> None:
        pantograph = check_run_of(run, "slopes", pantograph)
        if not hasattr(run, "slopes"):
            raise ModelError("slopes.run", "has no sensitivities", "run(..., sensitivities={...})")
        chosen = filter_of(filter, "slopes")
        rate, window = sample_rate(run.t), in_window(run, pantograph)
        self.names = list(run.slopes)
        histories = [run.recordings[pantograph].force]
        histories += [own.force[pantograph] for own in run.slopes.values()]
        self.raw = np.stack([x[window] for x in histories])  # (1 + p, n): the force, its derivatives
        self.force = np.stack([chosen.low_pass(x, rate)[window] for x in histories])
        self.bands = {
            key: np.stack([chosen.band(x, rate, low, high)[window] for x in histories])
            for key, (low, high) in OF_BANDS.items()
        }
        self.uplift: FloatArray | None = None
        if uplifts := uplift_in_window(run, pantograph):
            most = max(uplifts, key=lambda one: one.uplift)
            column = most.number - 1
            row = int(np.argmax(run.uplift[:, column] == most.uplift))
            rates = [own.uplift[row, column] for own in run.slopes.values()]
            self.uplift = MM * np.array([most.uplift, *rates])

    def at(self, changes: FloatArray) -> dict[str, tuple[float, FloatArray]]:
        """Statistics and their derivatives (p,) with changes (p,) of the parameters, in m, by quantity."""
        along = np.concatenate([[1.0], changes])
        found = of_filtered(along @ self.force)
        made = {key: (value, self.force[1:] @ by) for key, (value, by) in found.items()}
        for key in ("raw_maximum", "raw_minimum"):
            value, by = extreme_of(along @ self.raw, key)
            made[key] = value, self.raw[1:] @ by
        for key, band in self.bands.items():
            value, by = of_filtered(along @ band)["deviation"]
            made[key] = value, band[1:] @ by
        if self.uplift is not None:
            made["uplift"] = float(along @ self.uplift), self.uplift[1:]
        return made

    def slopes(self) -> dict[str, dict[str, float]]:
        """Derivatives of the statistics of the run itself, by parameter and quantity."""
        found = self.at(np.zeros(len(self.names)))
        return {
            name: {key: float(rates[k]) for key, (_, rates) in found.items()}
            for k, name in enumerate(self.names)
        }
