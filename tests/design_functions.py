"""Functions of parameters for studies: closed forms, slow ones, and such as end their process."""

import math
import os
import signal
import time
from pathlib import Path

import numpy as np

import ancf

#: Ishigami's function for a = 7, b = 0.1: first and total indices in closed form.
ISHIGAMI = {"x1": (0.3139, 0.5576), "x2": (0.4424, 0.4424), "x3": (0.0, 0.2437)}


def ishigami(x1, x2, x3):
    return {"y": math.sin(x1) + 7.0 * math.sin(x2) ** 2 + 0.1 * x3**4 * math.sin(x1)}


def angles():
    return dict.fromkeys(ISHIGAMI, ancf.Uniform(-math.pi, math.pi))


def product(a, b):
    return {"sum": a + b, "product": a * b}


def napping(a, b):
    time.sleep(0.02)
    return product(a, b)


def sometimes_wrong(a, b):
    if a > 2.5:
        raise ancf.SolveError(f"t = {a:.3f} s", "the step diverged", "a smaller step")
    if b < 0.1:
        return {"sum": a + b, "product": float("nan")}
    return product(a, b)


def counted(folder, a, b):
    """Leaves a file for each call."""
    (Path(folder) / f"{a!r}_{b!r}_{os.getpid()}_{time.perf_counter_ns()}").touch()
    return product(a, b)


def deadly(folder, times, a, b):
    """Ends its process in one case, the first times."""
    if a == 3:
        left = len([*Path(folder).iterdir()])
        if left < times:
            (Path(folder) / f"death {left}").touch()
            os.kill(os.getpid(), signal.SIGKILL)
    return napping(a, b)


def cantilever(EI, elements):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=EI, rhoA=0.05)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
    model.clamp(beam.start)
    result = ancf.simulate(model, t_end=0.02, step=1e-3)
    return {"tip": result.position(beam.end)[-1, 2], "energy": np.float64(result.energy.strain[-1])}
