"""Measure a mooring line with ancf and with MoorDyn in turn: processor time at equal accuracy.

``pip install -e . moordyn`` and ``python benchmarks/mooring.py``. A chain of 320 m in 100 m of water whose
fairlead moves by 2 m in 10 s for 60 s, as in ``ancf validate mooring``. The error is that of the least and
the largest force at the fairlead from 40 to 60 s and of the static one, the worst of the three, against ancf
with short elements and steps.

Then three such lines around a ship in an irregular sea, for an hour (``--hour``: that alone).
"""

from __future__ import annotations

import math
import os
import sys
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

import numpy as np

import ancf
from ancf.mooring.cases import GRADED, chain

END, FROM, COUPLING = 60.0, 40.0, 0.05
FINE_STEP, RUNS = 0.0125, 3  # runs of ours; one of theirs, whose statics take minutes
LINES = """--- chain of 320 m
---------------------- LINE TYPES
TypeName Diam Mass/m EA BA/-zeta EI Cdn Can Cdt Cat
(-) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
chain 0.1 50 2e8 -1 0 1.6 1.0 0.1 0.0
---------------------- POINTS
ID Type X Y Z M V CdA CA
(-) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 0 0 -100 0 0 0 0
2 Coupled 290 0 0 0 0 0 0
---------------------- LINES
ID LineType AttachA AttachB UnstrLen NumSegs Outputs
(-) (-) (-) (-) (m) (-) (-)
1 chain 1 2 320 {segments} -
---------------------- OPTIONS
0 writeLog
{step} dtM
3e6 kBot
3e5 cBot
1025 WtrDnsty
9.80665 g
100 WtrDpth
0.1 dtIC
400 TmaxIC
4 CdScaleIC
1e-6 threshIC
---------------------- END
"""


def ours(nodes: np.ndarray, step: float) -> tuple[list[float], float]:
    """Static, least and largest force, N; processor time of the run, s."""
    still = ancf.equilibrium(chain(nodes, motion=0.0)[0])
    model, line = chain(nodes)
    start = ancf.equilibrium(model)
    begin = time.process_time()
    rule = ancf.GeneralizedAlpha(0.8)
    run = ancf.simulate(model, t_end=END, step=step, start=start, integrator=rule)
    taken = time.process_time() - begin
    force = run.tension(line.end)[run.t >= FROM]
    return [float(np.linalg.norm(still.reaction("fairlead"))), force.min(), force.max()], taken


@contextmanager
def silence() -> Iterator[None]:
    """What MoorDyn prints, time after time, is not shown."""
    shown = os.dup(1)
    with open(os.devnull, "w") as nothing:
        os.dup2(nothing.fileno(), 1)
    try:
        yield
    finally:
        os.dup2(shown, 1)
        os.close(shown)


def theirs(segments: int, step: float) -> tuple[list[float], float]:
    """The same of MoorDyn."""
    import moordyn

    with tempfile.TemporaryDirectory() as folder, silence():
        file = Path(folder) / "lines.txt"
        file.write_text(LINES.format(segments=segments, step=step))
        system = moordyn.Create(str(file))
        place, speed = [290.0, 0.0, 0.0], [0.0, 0.0, 0.0]
        moordyn.Init(system, place, speed)
        line = moordyn.GetLine(system, 1)
        static = float(np.linalg.norm(moordyn.GetLineNodeTen(line, segments)))
        forces, begin, omega = [], time.process_time(), 2.0 * math.pi / 10.0
        for k in range(round(END / COUPLING)):
            t = k * COUPLING
            place[0] = 290.0 + 2.0 * math.sin(omega * t)
            speed[0] = 2.0 * omega * math.cos(omega * t)
            moordyn.Step(system, place, speed, t, COUPLING)
            if t >= FROM:
                forces.append(float(np.linalg.norm(moordyn.GetLineNodeTen(line, segments))))
        taken = time.process_time() - begin
        moordyn.Close(system)
    return [static, min(forces), max(forces)], taken


def best(measure, *given) -> tuple[list[float], float]:
    """Forces, and the least processor time of some runs."""
    found = [measure(*given) for _ in range(RUNS)]
    return found[0][0], min(taken for _, taken in found)


def steps() -> Iterator[tuple[int, float]]:
    """Segments of the peer, and the longest step with which they are stable."""
    for segments in (20, 40, 80, 160):
        yield segments, 0.04 / segments


def moored(seed: int = 1) -> tuple[ancf.Model, list[ancf.Point]]:
    """Three lines of 20 elements at 120 degrees; their fairleads go with a ship that surges and sways."""
    model = ancf.Model(gravity=(0, 0, -9.80665))
    section = ancf.Section(EA=2e8, EI=0.0, rhoA=50.0, diameter=0.1, drag=(1.6, 0.1), added_mass=(1.0, 0.0))
    rng = np.random.default_rng(seed)
    ways = []
    for size in (0.75, 0.4):  # m, deviation; that of the water is 1 m, and a ship goes with less of it
        omega, phase = rng.uniform(0.4, 0.9, 6), rng.uniform(0.0, 2.0 * math.pi, 6)
        parts = [f"sin({w:.6f}*t + {p:.6f})" for w, p in zip(omega, phase, strict=True)]
        ways.append(f"{size / math.sqrt(3.0):.6f}*ramp(t, 0, 60)*({' + '.join(parts)})")
    ends = []
    for k in range(3):
        c, s = math.cos(2.0 * math.pi * k / 3.0), math.sin(2.0 * math.pi * k / 3.0)
        line = model.add_beam(
            f"line {k + 1}",
            start=(300.0 * c, 300.0 * s, -100.0),
            end=(10.0 * c, 10.0 * s, 0.0),
            nodes=GRADED,
            section=section,
            length=320.0,
        )
        model.pin(line.start)
        model.pin(line.end, displacement=[*ways, 0.0])
        ends.append(line.end)
    sea = ancf.Waves.jonswap(height=4.0, period=10.0, components=50, seed=seed, depth=100.0)
    model.add_fluid("sea", 1025.0, velocity=(0.5, 0.0, 0.0), below=0.0, waves=sea)
    model.add_ground("seabed", -100.0, stiffness=3e6, damping=3e5, friction=0.3, stick=3e4)
    return model, ends


def hour(seconds: float = 3600.0) -> None:
    """Print how many times faster than real time, and what longer steps cost in accuracy."""
    print(f"three lines of 20 elements, irregular sea of 50 components, {seconds:.0f} s")
    forces = {}
    for step, t_end in ((0.2, 20.0), (0.025, 120.0), (0.2, 120.0), (0.2, seconds)):
        model, ends = moored()
        start = ancf.equilibrium(model)
        begin = time.process_time()
        rule = ancf.GeneralizedAlpha(0.8)
        given = {"output_step": 10.0, "sensors": ends, "integrator": rule, "start": start}
        run = ancf.simulate(model, t_end=t_end, step=step, **given)
        taken = time.process_time() - begin
        pull = np.array([run.sensors.tension(end) for end in ends])
        forces[step, t_end] = np.array([pull.min(axis=1), pull.max(axis=1)])
        if t_end > 20.0:  # the first one compiles
            print(
                f"{t_end:6.0f} s in steps of {step:g} s: {taken:7.2f} s, {t_end / taken:5.0f} "
                f"times real time; {pull.min() / 1e3:.1f} to {pull.max() / 1e3:.1f} kN"
            )
    off = np.abs(forces[0.2, 120.0] / forces[0.025, 120.0] - 1.0).max()
    print(f"extremes of 0.2 s beside 0.025 s: {100 * off:.2f} %")


def main() -> None:
    """Print the table, then the hour."""
    if "--hour" not in sys.argv[1:]:
        compare()
    hour()


def compare() -> None:
    """Print the table of both programs."""
    fine = np.concatenate([np.linspace(a, b, 5)[1:] for a, b in pairwise(GRADED)])
    ours(GRADED, 0.2)  # compiles
    exact, _ = ours(np.concatenate([[0.0], fine]), FINE_STEP)
    print(f"{'':36}{'static':>10}{'least':>10}{'largest':>10}{'error':>9}{'time':>9}")
    rows = [(f"ancf, 20 elements, {step} s", best(ours, GRADED, step)) for step in (0.2, 0.1, 0.05, 0.025)]
    try:
        for segments, step in steps():
            rows.append((f"MoorDyn, {segments} segments, {step:g} s", theirs(segments, step)))
    except ImportError:
        print("pip install moordyn measures the other side too")
    for name, (forces, taken) in [("ancf, 80 elements, 0.0125 s", (exact, math.nan)), *rows]:
        error = max(abs(f / e - 1.0) for f, e in zip(forces, exact, strict=True))
        shown = "".join(f"{f / 1e3:10.3f}" for f in forces)
        print(f"{name:36}{shown}{100 * error:8.3f} %{taken:7.3f} s")


if __name__ == "__main__":
    main()
