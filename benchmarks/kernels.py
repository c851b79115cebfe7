"""Time of our kernels by themselves: force, tangent, factorisation, solve; microseconds per element.

``python benchmarks/kernels.py [ELEMENTS ...]``. The loops are compiled, so that calls from Python do not
count. The state is a beam bent into half a circle and a little stretched. The force includes the inertia.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any

import numpy as np

from ancf import Model, Section
from ancf.compiled import kernel
from ancf.elements.registry import ELEMENTS
from ancf.system.core import assemble, factorise_matrix, residual, restrict, solve_matrix
from ancf.system.system import System

SECONDS = 0.1  # of one measurement
REPEATS = 5  # measurements, of which the best counts
NAMES = ("force", "tangent", "factorise", "solve")


@kernel
def repeat_force(batches, ws, q, v, a, f, r, times):  # type: ignore[no-untyped-def]
    for _ in range(times):
        residual(batches, ws, q, v, a, f, r)


@kernel
def repeat_tangent(batches, ws, q, v, A, times):  # type: ignore[no-untyped-def]
    for _ in range(times):
        assemble(batches, ws, q, v, A, 1e6, 0.0, 1.0)


@kernel
def repeat_factorise(A, factor, times):  # type: ignore[no-untyped-def]
    for _ in range(times):
        factorise_matrix(A, factor)


@kernel
def repeat_solve(factor, b, x, times):  # type: ignore[no-untyped-def]
    for _ in range(times):
        for i in range(x.shape[0]):
            x[i] = b[i]
        solve_matrix(factor, x)


def system(elements: int, element: str) -> System:
    """A beam bent into half a circle, hinged at one end."""
    angle = np.linspace(0.0, np.pi, max(elements, 3) + 1)
    path = np.stack([np.sin(angle), np.zeros_like(angle), np.cos(angle)], axis=1)
    section = Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0, nu=0.3)
    model = Model(gravity=(0.0, 0.0, -9.81))
    beam = model.add_beam(
        "beam",
        path=path,
        elements=elements,
        element=element,
        section=section,
        length=3.14,
        natural_shape="straight",
    )
    model.pin(beam.start)
    return System(model)


def loops(compiled: System) -> dict[str, Callable[[int], Any]]:
    """Functions that run a kernel so many times."""
    core = compiled.core
    q, v = compiled.initial_state()
    a, f, r = np.zeros_like(q), np.zeros_like(q), np.zeros_like(q)
    x, b = np.zeros(compiled.n), np.ones(compiled.n)
    A = core.A.copy()
    assemble(core.batches, core.ws, q, v, A, 1e6, 0.0, 1.0)
    restrict(core.supports, A)
    return {
        "force": lambda times: repeat_force(core.batches, core.ws, q, v, a, f, r, times),
        "tangent": lambda times: repeat_tangent(core.batches, core.ws, q, v, core.A, times),
        "factorise": lambda times: repeat_factorise(A, core.factor, times),
        "solve": lambda times: repeat_solve(core.factor, b, x, times),
    }


def best_time(loop: Callable[[int], Any]) -> float:
    """CPU seconds of one call."""
    loop(1)
    times = 1
    while (spent := cpu(loop, times)) < SECONDS / 4:
        times *= 4
    times = max(1, round(times * SECONDS / spent))
    return min(cpu(loop, times) for _ in range(REPEATS)) / times


def cpu(loop: Callable[[int], Any], times: int) -> float:
    start = time.process_time()
    loop(times)
    return time.process_time() - start


def kernels(elements: int, element: str = "cable") -> dict[str, float]:
    """Microseconds per element of each kernel, in the order in which a step needs them."""
    runs = loops(system(elements, element))
    return {name: 1e6 * best_time(runs[name]) / elements for name in NAMES}


def main() -> None:
    print(f"{'':12}{'elements':>8}" + "".join(f"{name:>12}" for name in NAMES) + "   us per element")
    for element in ELEMENTS:
        for elements in [int(text) for text in sys.argv[1:]] or [8, 100, 1000, 10000]:
            times = kernels(elements, element)
            print(f"{element:12}{elements:8d}" + "".join(f"{times[name]:12.4f}" for name in NAMES))


if __name__ == "__main__":
    main()
