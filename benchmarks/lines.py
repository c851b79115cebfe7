"""Overhead lines against the clock: form, model, run and single steps of EN 50318:2002 with two pantographs.

``python benchmarks/lines.py`` (10 and 30 spans, whole and with spans that sleep, default mesh, steps of 1 ms,
250 km/h, 200 m apart), some minutes; ``--spans 10 20 --speed 300`` for others. Processor time on one core,
kernels compiled before the clock starts. With ``--exact``, which is slow, the last column is how far sigma is
from a run that iterates on the whole line with a new matrix each time.
"""

from __future__ import annotations

import argparse
import gc
import time
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np

import ancf
from ancf import catenary

SPACING, PANTOGRAPH, STEP = 200.0, "en50318-2002", 1e-3
SINGLE = 5000  # single steps, at most


def line(spans: int) -> catenary.Line:
    """The line of the standard with so many spans."""
    given = catenary.read_line("en50318-2002")
    ends = {"stagger": 0.0, "system_height": given.system_height[0], "height": 0.0}
    return replace(given, spans=given.spans[:1] * spans, **ends)


def timed(job: Callable[[], Any]) -> tuple[Any, float]:
    """What it returns, and its processor time."""
    begin = time.process_time()
    made = job()
    return made, time.process_time() - begin


def integrator(**newton: Any) -> ancf.GeneralizedAlpha:
    """As :func:`ancf.catenary.run` has it."""
    return ancf.GeneralizedAlpha(0.9, newton=ancf.Newton(tolerance=1e-8, corotate=False, **newton))


def single_steps(form: catenary.Form, speed: float, spacing: float, reduce: bool) -> np.ndarray:
    """Processor times of steps taken one by one, us; garbage is collected before and after."""
    given = {"pantograph": PANTOGRAPH, "spacing": spacing, "step": STEP, "reduce": reduce}
    live = catenary.stepper(form, speed=speed, **given)
    live.advance(10)  # the first ones make the matrix
    seconds = np.empty(min(SINGLE, round((form.line.length - spacing - 60.0) / speed / STEP)))
    gc.collect()
    gc.disable()
    for n in range(len(seconds)):
        begin = time.thread_time()
        live.advance()
        seconds[n] = time.thread_time() - begin
    gc.enable()
    return 1e6 * seconds


def measure(spans: int, speed: float, exact: bool, reduce: bool) -> None:
    """Print one row."""
    form, forming = timed(lambda: catenary.form(line(spans)))
    given: dict[str, Any] = {"speed": speed, "pantograph": PANTOGRAPH, "spacing": SPACING, "step": STEP}
    run, whole = timed(lambda: catenary.run(form, **given, reduce=reduce))
    steps = run.result.stats.steps
    row = f"{spans:5d} {'asleep' if reduce else 'whole':>7} {forming:8.2f}"
    row += f" {whole - run.cpu_seconds:8.2f} {1e6 * run.cpu_seconds / steps:8.0f}"
    row += f" {run.simulated_seconds / run.cpu_seconds:8.2f} {run.simulated_seconds / (whole + forming):8.2f}"
    row += f" {run.result.stats.newton_iterations / steps:8.2f}"
    single = single_steps(form, speed, SPACING, reduce)
    row += f" {np.median(single):8.0f} {np.quantile(single, 0.999):8.0f} {single.max():8.0f}"
    sigma = [catenary.statistics(run, k)["deviation"].value for k in range(2)]
    row += "   " + " | ".join(f"{value:.3f}" for value in sigma)
    if exact:
        other = catenary.run(form, **given, integrator=integrator(modified=False))
        wanted = [catenary.statistics(other, k)["deviation"].value for k in range(2)]
        row += f"   {max(abs(a / b - 1.0) for a, b in zip(sigma, wanted, strict=True)):.1e}"
    print(row, flush=True)


def main() -> None:
    """All rows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--spans", type=int, nargs="+", default=[10, 30])
    parser.add_argument("--speed", type=float, default=250.0, help="km/h")
    parser.add_argument("--exact", action="store_true")
    given = parser.parse_args()
    short = catenary.form(line(6), catenary.Mesh(contact=4.0, messenger=6.0))
    for reduce in (False, True):  # compiles
        single_steps(short, 50.0, 50.0, reduce)
        catenary.run(short, speed=50.0, pantograph=PANTOGRAPH, spacing=50.0, reduce=reduce)
    heads = ("form s", "model s", "us/step", "x real", "all x", "iter.", "single", "99.9 %", "worst")
    print("spans        ", *(f"{head:>8}" for head in heads), "  sigma, N")
    for spans in given.spans:
        for reduce in (False, True):
            measure(spans, given.speed / 3.6, given.exact, reduce)


if __name__ == "__main__":
    main()
