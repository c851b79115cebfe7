"""What a command leaves."""

from typing import NamedTuple


class Ran(NamedTuple):
    """Exit code, standard output and standard error."""

    code: int
    out: str
    err: str

    @property
    def said(self):
        """Standard error as one line: the width of the screen does not matter."""
        return " ".join(self.err.split())
