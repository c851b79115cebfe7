"""What all bridges share: a number of a run, and its derivatives, of a vector of parameters."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from ..number import Numbers


class Vector:
    """A number of a run as a function of a vector (n,) of parameters.

    Parameters
    ----------
    model, objective, parameters, settings, begin
        As of :func:`ancf.jax_function`.
    where : str
        For messages.

    Raises
    ------
    ModelError
        There are no parameters, one stands twice, or the model does not have it.
    """

    def __init__(
        self,
        model: Any,
        objective: Any,
        parameters: Any,
        settings: Mapping[str, Any],
        begin: Callable[..., Any] | None,
        where: str,
    ) -> None:
        names = parameters if isinstance(parameters, Sequence) and not isinstance(parameters, str) else ()
        if not names or not all(isinstance(name, str) for name in names) or len(set(names)) < len(names):
            what = f"must be different names of numbers, are {checks.shown(parameters)}"
            raise ModelError(f"{where}.parameters", what, 'such as ["beam.EI", "gravity"]')
        self.objective, self.where = checks.text(objective, f"{where}.objective"), where
        self.numbers = Numbers(model, names, settings, begin, where)

    def check(self, shape: tuple[int, ...]) -> None:
        """Raise ModelError for what is no vector with a number for each parameter."""
        count = len(self.numbers.names)
        if tuple(shape) != (count,):
            what = f"the parameters must have the shape ({count},), have {tuple(shape)}"
            raise ModelError(self.where, what, "in the order of " + ", ".join(self.numbers.names))

    def value(self, x: Any) -> np.float64:
        """The number alone."""
        return np.float64(self.numbers.at(self.objective, self._named(x), slope=False)[0])

    def with_slope(self, x: Any) -> tuple[np.float64, FloatArray]:
        """The number and its derivatives (n,)."""
        value, slope = self.numbers.at(self.objective, self._named(x))
        return np.float64(value), np.array([slope[name] for name in self.numbers.names])

    def _named(self, x: Any) -> dict[str, float]:
        given = np.asarray(x, dtype=np.float64)
        return dict(zip(self.numbers.names, given.tolist(), strict=True))
