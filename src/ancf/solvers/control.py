"""When a run asks what is given to its inputs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Control:
    """A function that is called every so many steps, first at the start.

    Parameters
    ----------
    every : int
        Steps.
    call : function
    kept : function
        What a checkpoint after so many steps has of the memory of the function, ready for JSON.
    """

    every: int
    call: Callable[[int], None]
    kept: Callable[[int], dict[str, Any]]

    def ask(self, done: int) -> int:
        """Call it if it is time after so many steps; steps until the next time."""
        if done % self.every == 0:
            self.call(done)
        return self.every - done % self.every
