"""Whether the steps of a run follow its motion: how far velocities turn in a step, weighed by the mass.

Of a vibration of the rate w a method turns the velocities in a step of length h by an angle p, and the
kinetic energies of their changes sum up to 4 sin^2(p/2) of those of the velocities.  The trapezoidal rule has
tan(p/2) = w h/2: it keeps the energy however long its steps are, so that no energy tells.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..system.core import inertia
from .faces import History

#: Steps of a period below which it is said, stored states that are looked at, and those that say nothing yet.
PERIOD, MOST, FEWEST = 8.0, 1000, 6
#: Steps of a period whose period is right to a per cent.
ENOUGH = 20.0
#: Numbers that are read at once.
READ = 1_000_000


def of_steps(result: History) -> list[str]:
    """A note on a history of which every step was stored, and whose steps are long for what moves."""
    settings = result.provenance.get("settings", {})
    step = settings.get("step")
    known = step is not None and settings.get("output_step") == step and settings.get("integrator") != "radau"
    if not known or len(result.t) < FEWEST:
        return []
    try:
        core, size = result.system.core, result.system.size
    except ModelError:  # a file of another version, whose unknowns are in another order
        return []
    changes, whole, momentum = 0.0, 0.0, np.empty(size)
    for before, after in _pairs(result.v, size):
        inertia(core.batches, core.ws, after - before, momentum)
        changes += float(momentum @ (after - before))
        inertia(core.batches, core.ws, after, momentum)
        whole += float(momentum @ after)
    if not whole > 0.0 or changes < 4.0 * math.sin(math.pi / PERIOD) ** 2 * whole:
        return []
    half = math.asin(min(0.5 * math.sqrt(changes / whole), 1.0))
    period = math.pi * step / max(math.tan(half), 1e-9)
    return [
        f"steps of {step:g} s are long for what moves: most kinetic energy is that of vibrations with a "
        f"period of about {period:.2g} s, {period / step:.2g} steps; take {period / ENOUGH:.1g} s"
    ]


def _pairs(rates: Any, size: int) -> Iterator[tuple[FloatArray, FloatArray]]:
    """Rates before and after steps all over a history; a file is read a few times, not at each of them."""
    last = rates.shape[0] - 1
    stride = -(-last // MOST)
    at_once = max(READ // (2 * size), 1) * stride
    for first in range(0, last, at_once):
        stop = min(first + at_once, last)
        before = np.array(rates[first:stop:stride])
        yield from zip(before, np.array(rates[first + 1 : stop + 1 : stride]), strict=True)
