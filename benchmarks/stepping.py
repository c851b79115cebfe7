"""What steps one by one cost besides the steps: ``python benchmarks/stepping.py``.

Processor time of ``run.advance()``, with and without an input that changes each time, of ``run.advance(n)``
and of ``simulate``, over the same time of cables of some sizes; printed, nothing is stored.
"""

from __future__ import annotations

import time

import ancf

STEPS = 5000


def build(elements):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=2e3, EI=0.1, rhoA=0.4)
    beam = model.add_beam("cable", start=(0, 0, 0), end=(0.2, 0, -0.98), elements=elements, section=section)
    model.pin(beam.start)
    model.add_force(beam.end, (model.add_input("u"), 0, 0))
    return model


def seconds(work, model, step):
    run = ancf.stepper(model, step=step)
    begin = time.process_time()
    work(run)
    return time.process_time() - begin


def measured(elements, step=5e-4):
    """Microseconds per step: one by one, with an input, in one call, of a simulation."""

    def singly(run):
        for _ in range(STEPS):
            run.advance()

    def led(run):
        for k in range(STEPS):
            run.inputs["u"] = 1e-9 * k
            run.advance()

    def at_once(run):
        run.advance(STEPS)

    stats = ancf.simulate(build(elements), t_end=STEPS * step, step=step, output_step=STEPS * step).stats
    times = [seconds(work, build(elements), step) for work in (singly, led, at_once)] + [stats.cpu_seconds]
    return [1e6 * t / STEPS for t in times]


if __name__ == "__main__":
    names = ("advance()", "with an input", "advance(n)", "simulate", "advance()/advance(n)")
    print(f"{'elements':>8}", *(f"{name:>20}" for name in names), "  (us per step)")
    for elements in (4, 32, 200):
        found = measured(elements)
        print(f"{elements:8d}", *(f"{value:20.2f}" for value in [*found, found[0] / found[2]]))
