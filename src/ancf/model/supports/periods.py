"""Given motions that vary faster than steps follow: of how many steps a period of theirs has.

The period is that of the vibration with the same share of accelerations to velocities, root mean squares
over the time of a run. A trapezoidal step of 1/20 of a period makes it (omega h)^2/12, 0.8 %, too long.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from ...errors import ModelError
from .jumps import Jump, Motion, motions

#: Steps of a period that are enough, and of which nothing is said down to this share.
ENOUGH, NEARLY = 20.0, 0.98
#: Times at which a motion is looked at, the part of a step to both sides, and times that must have a say.
TIMES, PART, FEWEST = 300, 1 / 8, 20.0
#: Share of one golden section: times that no period of a motion can keep pace with.
GOLDEN = 0.5 * (math.sqrt(5.0) - 1.0)
#: Change of a motion that is told from round-off, as a share of its size.
ROUND_OFF = 1e-12


def few_steps(model: Any, start: float, end: float, step: float, known: list[Jump]) -> list[str]:
    """What is said of motions with fewer than ``ENOUGH`` steps in a period, between two times in s.

    Motions that jump, which are known, and tables of straight lines have no period.
    """
    if not (math.isfinite(end) and end - start > 2.0 * step):
        return []
    found, jumping = [], {jump.where for jump in known}
    for motion in motions(model):
        if motion.where in jumping or motion.straight:
            continue
        try:
            period = _period(motion, start, end, step)
        except ModelError:  # the run says at which step
            continue
        if period < NEARLY * ENOUGH * step:
            found.append(
                f"{motion.where}: moves with a period of about {period:.2g} s, {period / step:.2g} steps of "
                f"{step:g} s: take {period / ENOUGH:.1g} s, whose vibrations are right to a per cent"
            )
    return found


def _period(motion: Motion, start: float, end: float, step: float) -> float:
    """Of the vibration with the same accelerations and velocities, s; infinite if there is none."""
    d = PART * step
    share = np.modf(GOLDEN * np.arange(1, TIMES + 1))[0]
    t = start + d + (end - start - 2.0 * d) * share
    before, here, after = (motion.table(t + k * d) for k in (-1, 0, 1))
    rate = (after - before) / (2.0 * d)
    change = (after - 2.0 * here + before) / d**2
    swing = rate - np.mean(rate, axis=0)
    square = np.sum(swing**2, axis=1)
    total, least = float(np.sum(square)), ROUND_OFF * float(np.max(np.abs(here))) / d
    bend = float(np.sum(change**2))
    if total <= TIMES * least**2 or bend == 0.0 or total**2 < FEWEST * float(np.sum(square**2)):
        return math.inf
    # of a vibration: change / rate = 2 tan(omega d / 2) / d
    return math.pi * d / math.atan(0.5 * d * math.sqrt(bend / total))
