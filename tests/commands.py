"""What a command leaves, and Python in a process of its own."""

import subprocess
import sys
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


def python(code, *arguments, options=()):
    """Run Python code in a process of its own."""
    command = [sys.executable, *options, "-c", code, *map(str, arguments)]
    ran = subprocess.run(command, capture_output=True, text=True, timeout=PATIENCE)
    return Ran(ran.returncode, ran.stdout, ran.stderr)
