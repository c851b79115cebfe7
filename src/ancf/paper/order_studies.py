"""Studies of convergence: errors over the element length or over the step."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cache
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

import ancf

from ..arrays import FloatArray
from . import kinds
from .closed import statics, vibration
from .closed.case import LENGTH

if TYPE_CHECKING:
    from ..model.integrators import Integrator

MESH, STEP = "element length", "step"
COUNTS, SHORT_COUNTS = (4, 8, 16, 32), (8, 16)
#: Of the falling cable, in seconds: it ends after 0.24 s.
T_END, REFERENCE_STEP = 0.24, 5e-4
#: A new matrix in every iteration: the errors are those of the steps alone.
EXACT = ancf.Newton(tolerance=1e-14, modified=False)


class Study(NamedTuple):
    """Errors of one method on finer and finer grids.

    Parameters
    ----------
    name : str
    over : str
        "element length", m, or "step", s.
    element : str
        Kind of element.
    order : int
        What theory says.
    sizes, errors : tuple of float
        Errors are shares of the exact value, or lengths in m for the falling cable.

    """

    name: str
    over: str
    element: str
    order: int
    sizes: tuple[float, ...]
    errors: tuple[float, ...]


def studies(short: bool) -> list[Study]:
    """All of them; the short form has two grids each."""
    return [*_of_meshes(SHORT_COUNTS if short else COUNTS), *_of_steps(2 if short else 4)]


def _of_meshes(counts: Sequence[int]) -> list[Study]:
    def study(name: str, element: str, order: int, error: Callable[[int], float], finer: int = 1) -> Study:
        meshes = [finer * n for n in counts]
        sizes = tuple(LENGTH / n for n in meshes)
        return Study(name, MESH, element, order, sizes, tuple(error(n) for n in meshes))

    return [
        study("roll-up to half a circle", kinds.CABLE, 4, _roll_up, 2),
        study("cantilever, frequency 3", kinds.CABLE, 4, lambda n: _relative(vibration.clamped(n))),
        study("thick beam, frequency 2", kinds.NONLOCKING, 4, lambda n: _relative(vibration.thick(n))),
        study("thick beam, frequency 2", kinds.ORIGINAL, 2,
              lambda n: _relative(vibration.thick(n, kinds.ORIGINAL))),
    ]  # fmt: skip


def _roll_up(elements: int) -> float:
    place = statics.rolled_up(elements).position("beam.end")
    return math.dist(place, (0.0, 0.0, 2.0 * LENGTH / math.pi)) / LENGTH


def _relative(pair: tuple[Sequence[float], Sequence[float]]) -> float:
    """Relative error of the last of several frequencies."""
    found, wanted = pair
    return abs(found[-1] / wanted[-1] - 1.0)


def _of_steps(count: int) -> list[Study]:
    """Each method from a step that suits its order; halved `count` - 1 times."""
    methods: tuple[tuple[str, Any, int, float], ...] = (
        ("trapezoidal rule", ancf.Trapezoidal(newton=EXACT), 2, 1e-3),
        ("generalised-alpha, ρ∞ = 0.4", ancf.GeneralizedAlpha(rho_inf=0.4, newton=EXACT), 2, 1e-3),
        ("central differences", ancf.Explicit(), 2, 1e-3),
        ("Radau IIA, 2 stages", ancf.Radau(stages=2, adaptive=False), 3, 8e-3),
        ("Radau IIA, 3 stages", ancf.Radau(stages=3, adaptive=False), 5, 0.016),
    )
    found = []
    for name, method, order, first in methods:
        sizes = tuple(first / 2**k for k in range(min(count, 3)))
        errors = tuple(_distance(method, step) for step in sizes)
        found.append(Study(name, STEP, kinds.CABLE, order, sizes, errors))
    return found


def _distance(method: Integrator, step: float) -> float:
    return float(np.linalg.norm(_fallen(method, step) - _limit()))


@cache
def _limit() -> FloatArray:
    """Tip by the method of order 5 with small steps."""
    return _fallen(ancf.Radau(stages=3, adaptive=False), REFERENCE_STEP)


def _fallen(method: Integrator, step: float) -> FloatArray:
    """Place and, in m, 20 ms of the velocity of the tip of a soft damped cantilever that falls, (6,).

    The fastest of its waves, about 200 rad/s, is resolved by all steps.
    """
    model = ancf.Model(gravity=(0.0, 0.0, -4.0))
    section = ancf.Section(EA=30.0, EI=0.02, rhoA=0.4, damping=0.3)
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1.3, 0, 0), elements=3, section=section, element="cable", strain="paper"
    )
    model.clamp(beam.start)
    result = ancf.simulate(model, t_end=T_END, step=step, integrator=method, output_step=T_END)
    return np.append(result.position(beam.end)[-1], 0.02 * result.velocity(beam.end)[-1])
