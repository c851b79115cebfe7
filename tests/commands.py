"""What a command leaves, and Python in a process of its own."""

import functools
import os
import subprocess
import sys
import traceback
import warnings
from pathlib import Path
from typing import NamedTuple

#: Time that a process gets to end, s: no test may fail because the machine is busy.
PATIENCE = 900


class Ran(NamedTuple):
    """Exit code, standard output and standard error."""

    code: int
    out: str
    err: str

    @property
    def said(self):
        """Standard error as one line: the width of the screen does not matter."""
        return " ".join(self.err.split())


def apart(test):
    """Run a test in a forked process: an HDF5 library that could not write ends with it."""

    @functools.wraps(test)
    def run(*arguments, **named):
        reading, writing = os.pipe()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # of a process with threads
            child = os.fork()
        if child == 0:
            said = b""
            try:
                test(*arguments, **named)
            except BaseException:
                said = traceback.format_exc().encode()[-60_000:]
            os.write(writing, said)
            os._exit(1 if said else 0)
        os.close(writing)
        with open(reading, encoding="utf-8") as pipe:
            said = pipe.read()
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0, said

    return run


def python(code, *arguments, options=()):
    """Run Python code in a process of its own."""
    command = [sys.executable, *options, "-c", code, *map(str, arguments)]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
    return Ran(ran.returncode, ran.stdout, ran.stderr)


MODEL = """
title = "Cantilever [1] of Größe 1"
gravity = [0, 0, -9.81]
[sections.strip]
shape = "rectangle"
width = 0.01
height = 0.01
E = 1e8
rho = 500
[[bodies]]
name = "beam"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 4
section = "strip"
strain = "paper"
[[supports]]
type = "clamp"
point = "beam.start"
stretch = "fixed"
"""


SIMULATION = """
[simulation]
t_end = 0.4
step = 2.5e-4
outputs = ["beam.end"]
"""


FORCE = """
[[loads]]
type = "force"
point = "beam.end"
force = {force}
"""


EQUILIBRIUM = "[equilibrium]\n"


LONG = SIMULATION.replace("t_end = 0.4", "t_end = 100000.0").replace(
    "outputs", "output_step = 2.5e-3\noutputs"
)


def write(text, name="model.toml"):
    path = Path(name)
    path.write_text(text, encoding="utf-8")
    return path
