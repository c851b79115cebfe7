"""Sensitivities of a result that was read from a file."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Any

import numpy as np

from ..results.result import Result
from ..system.system import System
from .answers import Sensitivity
from .family import Family
from .parameters import parameters_of
from .samples import SensorSensitivity


class Kept(Mapping[str, Any]):
    """Derivatives by the name of a parameter; what they need besides the file is made when one is asked for.

    Parameters
    ----------
    result : Result
        Read from a file.
    names : list of str
    """

    def __init__(self, result: Result, names: list[str]) -> None:
        self._result, self._names = result, names
        self._families: dict[str, Family] = {}

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __contains__(self, name: object) -> bool:
        return name in self._names

    def __getitem__(self, name: str) -> Any:
        if name not in self._names:
            raise KeyError(name)
        return self._made(name)

    def _made(self, name: str) -> Any:
        result, found = self._result, self._result.derived()[name]
        dq, dv = np.asarray(found["q"][:]), np.asarray(found["v"][:])
        n = min(len(dq), len(dv))  # of a run that was killed, which stores them behind the states
        family, q, v = self.family(name), result.q[:n], result.v[:n]
        return Sensitivity(family, np.asarray(result.t[:n]), q, v, dq[:n], dv[:n])

    def family(self, name: str) -> Family:
        """The model around the value of a parameter.

        Raises
        ------
        ModelError
            The file lacks a Python function of the model.
        """
        if name not in self._families:
            [parameter] = parameters_of(self._base.model, [name], "load.sensitivities")
            self._families[name] = Family(parameter, self._base, shifts=True)  # as of the run
        return self._families[name]

    @cached_property
    def _base(self) -> System:
        theirs = self._result.system
        base = System(theirs.model)
        if "slides" in base.parts:
            mine, other = base.parts["slides"], theirs.parts["slides"]
            mine.mode[...], mine.open[...] = other.mode, other.open
        return base


class KeptSamples(Kept):
    """The same of what sensors recorded."""

    def _made(self, name: str) -> Any:
        rows, sensors = np.asarray(self._result.derived()[name]["samples"][:]), self._result.sensors
        return SensorSensitivity(self.family(name), sensors, rows)


def with_kept(result: Result) -> Result:
    """Let a result that was read from a file answer for the derivatives that are in it."""
    names = list(result.derived())
    if names:
        result.derivatives = Kept(result, names)
        if result.derived()[names[0]]["samples"].shape[0]:
            result.sensors.derivatives = KeptSamples(result, names)
    return result
