"""A simulation in another process that goes on until it is killed."""

import subprocess
import sys
import time

from commands import PATIENCE

LONG_RUN = """
import sys, ancf
model = ancf.Model(gravity=(0, 0, -9.81))
section = ancf.Section(EA=2e3, EI=0.1, rhoA=0.4)
beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section)
model.pin(beam.start)
print("ready", flush=True)
tell = lambda p: print(p.step, flush=True)
ancf.simulate(model, t_end=1e4, step=1e-3, file=sys.argv[1], progress=tell)
"""


def started(path, steps):
    """A run in another process that has reported so many steps, and the number it reported last."""
    child = subprocess.Popen([sys.executable, "-c", LONG_RUN, str(path)], stdout=subprocess.PIPE, text=True)
    assert child.stdout.readline() == "ready\n"
    return child, reported_by(child, steps)


def reported_by(child, steps):
    reported, end = 0, time.monotonic() + PATIENCE
    while reported < steps and time.monotonic() < end:
        reported = int(child.stdout.readline())
    assert reported >= steps
    return reported
