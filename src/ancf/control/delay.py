"""Delayed: a controller whose inputs take effect some time after it has given them."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from ..model import checks
from .memory import offers

#: Two times of a run are the same within this, s.
SAME = 1e-9


class Delayed:
    """A controller behind a dead time, as of sensors, computation and actuators together.

    The controller finds in ``run.inputs`` what it gave last. What it gives takes effect at the first call
    that is the delay later or more, so that the dead time is rounded up to whole control steps.

    Parameters
    ----------
    controller : callable
        Called with the run, see :func:`ancf.simulate`.
    delay : float, s

    Raises
    ------
    ModelError
        The delay is no number >= 0.

    """

    def __init__(self, controller: Callable[[Any], Any], delay: float, where: str = "Delayed.delay") -> None:
        self.controller, self.delay = controller, checks.non_negative(delay, where)
        self.wanted: dict[str, Any] = {}
        self.due: deque[tuple[float, dict[str, Any]]] = deque()

    @property
    def __name__(self) -> str:
        name = getattr(self.controller, "__name__", type(self.controller).__name__)
        return f"{name}, {self.delay:g} s late"

    def state(self) -> dict[str, Any]:
        """What is on its way, and what the controller offers of its own memory."""
        kept = {"wanted": self.wanted, "due": list(self.due)}
        return kept | ({"controller": self.controller.state()} if offers(self.controller) else {})  # type: ignore[attr-defined]

    def restore(self, state: dict[str, Any]) -> None:
        """Go on from such a state."""
        self.wanted = dict(state["wanted"])
        self.due = deque((float(t), dict(given)) for t, given in state["due"])
        if offers(self.controller) and "controller" in state:
            self.controller.restore(state["controller"])  # type: ignore[attr-defined]

    def __call__(self, run: Any) -> Any:
        """Ask the controller, and give what is due; returns what the controller does, as a rule nothing."""
        seen = _Seen(run, dict(run.inputs) | self.wanted)
        found = self.controller(seen)
        self.wanted = seen.inputs
        self.due.append((float(run.t) + self.delay, dict(seen.inputs)))
        while self.due and self.due[0][0] <= float(run.t) + SAME:
            for name, value in self.due.popleft()[1].items():
                run.inputs[name] = value
        return found


class _Seen:
    """The run as the controller sees it: with inputs that do not act yet."""

    def __init__(self, run: Any, inputs: dict[str, Any]) -> None:
        self._run, self.inputs = run, inputs

    def __getattr__(self, name: str) -> Any:
        return getattr(self._run, name)
