"""Distributions of one parameter: what they are given by, and their quantiles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks

#: Smallest distance of a probability from 0 and 1: quantiles of the normal distribution stay finite.
EDGE = 2.0**-53


class Distribution:
    """A distribution of one number."""

    def quantile(self, u: FloatArray) -> FloatArray:
        """Values (n,) at probabilities (n,)."""
        raise NotImplementedError

    @property
    def bounded(self) -> bool:
        """Whether all its values lie in an interval."""
        return True

    @classmethod
    def word(cls) -> str:
        """Its ``type`` in study files."""
        return cls.__name__.lower()

    def describe(self) -> dict[str, Any]:
        """Plain JSON-able form, as in a study file."""
        given = {item.name: getattr(self, item.name) for item in fields(self)}  # type: ignore[arg-type]
        plain = {key: list(v) if isinstance(v, tuple) else v for key, v in given.items() if v is not None}
        return {"type": self.word(), **plain}


def _ordered(kind: Distribution, *names: str, strict: bool) -> None:
    """Numbers of a distribution, which must not decrease."""
    title = type(kind).__name__
    numbers = [checks.number(getattr(kind, name), f"{title}.{name}") for name in names]
    for low, high, name, after in zip(numbers, numbers[1:], names, names[1:], strict=False):
        if low > high:
            raise ModelError(f"{title}.{after}", f"is {high:g}, must not be below {name}, {low:g}")
    if strict and numbers[0] == numbers[-1]:
        raise ModelError(f"{title}.{names[-1]}", f"is {names[0]}, {numbers[0]:g}: nothing would vary")


@dataclass(frozen=True)
class Uniform(Distribution):
    """All values between two are equally likely.

    Parameters
    ----------
    low, high : float
    """

    low: float
    high: float

    def __post_init__(self) -> None:
        _ordered(self, "low", "high", strict=True)

    def quantile(self, u: FloatArray) -> FloatArray:
        """Values at probabilities."""
        return self.low + (self.high - self.low) * u


@dataclass(frozen=True)
class Normal(Distribution):
    """Normal distribution.

    Parameters
    ----------
    mean : float
    deviation : float
        Standard deviation.
    """

    mean: float
    deviation: float

    def __post_init__(self) -> None:
        checks.number(self.mean, "Normal.mean")
        checks.positive(self.deviation, "Normal.deviation")

    @property
    def bounded(self) -> bool:
        """False: any value may come."""
        return False

    def quantile(self, u: FloatArray) -> FloatArray:
        """Values at probabilities."""
        return self.mean + self.deviation * standard(u)


@dataclass(frozen=True)
class LogNormal(Distribution):
    """A positive number whose logarithm is normal.

    Parameters
    ----------
    mean, deviation : float
        Mean and standard deviation of the number itself, not of its logarithm.
    """

    mean: float
    deviation: float

    def __post_init__(self) -> None:
        checks.positive(self.mean, "LogNormal.mean")
        checks.positive(self.deviation, "LogNormal.deviation")

    @property
    def bounded(self) -> bool:
        """False: any positive value may come."""
        return False

    def quantile(self, u: FloatArray) -> FloatArray:
        """Values at probabilities."""
        square = np.log1p((self.deviation / self.mean) ** 2)
        values: FloatArray = self.mean * np.exp(np.sqrt(square) * standard(u) - 0.5 * square)
        return values


@dataclass(frozen=True)
class Triangular(Distribution):
    """Density that rises from one value to a second and falls to a third.

    Parameters
    ----------
    low, mode, high : float
    """

    low: float
    mode: float
    high: float

    def __post_init__(self) -> None:
        _ordered(self, "low", "mode", "high", strict=True)

    def quantile(self, u: FloatArray) -> FloatArray:
        """Values at probabilities."""
        width, left, right = self.high - self.low, self.mode - self.low, self.high - self.mode
        rising = self.low + np.sqrt(u * width * left)
        falling = self.high - np.sqrt((1.0 - u) * width * right)
        values: FloatArray = np.where(u * width <= left, rising, falling)
        return values


@dataclass(frozen=True)
class Discrete(Distribution):
    """One of some values; they keep their kind, so that counts stay whole and words stay words.

    Parameters
    ----------
    values : sequence of numbers or str
    weights : sequence of float, optional
        How likely they are, in any unit; default equally.
    """

    values: Sequence[Any]
    weights: Sequence[float] | None = None

    def __post_init__(self) -> None:
        if isinstance(self.values, str) or not isinstance(self.values, Sequence | np.ndarray):
            raise ModelError("Discrete.values", f"must be a list, is {checks.shown(self.values)}")
        values = tuple(v.item() if isinstance(v, np.generic) else v for v in self.values)
        if not values:
            raise ModelError("Discrete.values", "must hold a value")
        for k, value in enumerate(values):
            if not isinstance(value, str):
                checks.number(value, f"Discrete.values[{k}]")
        object.__setattr__(self, "values", values)
        if self.weights is None:
            return
        weights = checks.array(self.weights, "Discrete.weights", (None,))
        if len(weights) != len(values) or np.any(weights < 0) or not np.any(weights > 0):
            raise ModelError("Discrete.weights", f"must be {len(values)} numbers >= 0, not all of them 0")
        object.__setattr__(self, "weights", tuple(weights.tolist()))

    def places(self, u: FloatArray) -> Any:
        """Indices (n,) of the values at probabilities."""
        weights = np.ones(len(self.values)) if self.weights is None else np.asarray(self.weights)
        edges = np.cumsum(weights)[:-1] / np.sum(weights)
        return np.searchsorted(edges, u, side="right")

    def quantile(self, u: FloatArray) -> FloatArray:
        """Values at probabilities, an array of what they are."""
        values = np.empty(len(self.values), dtype=object)
        values[:] = self.values
        return values[self.places(u)]  # type: ignore[no-any-return]


KINDS: dict[str, type[Distribution]] = {
    kind.word(): kind for kind in (Uniform, Normal, LogNormal, Triangular, Discrete)
}


def distribution_of(given: Any, where: str = "distribution") -> Distribution:
    """A distribution from itself, from a list of values, or from a table ``{type = "uniform", ...}``.

    Raises
    ------
    ModelError
        It is none, or lacks a number; ``where`` begins with what is given.
    """
    if isinstance(given, Distribution):
        return given
    if isinstance(given, list | tuple | np.ndarray):
        return _made(Discrete, {"values": given}, where)
    if not isinstance(given, Mapping):
        raise ModelError(where, f"must be a distribution or a list of values, is {checks.shown(given)}")
    if "type" not in given:
        raise ModelError(f"{where}.type", f"is missing, must be one of {checks.listed(KINDS)}")
    kind = KINDS[checks.choice(given["type"], f"{where}.type", tuple(KINDS))]
    numbers = {key: value for key, value in given.items() if key != "type"}
    names = {item.name: item for item in fields(kind)}  # type: ignore[arg-type]
    for key in numbers:
        if key not in names:
            what = f"unknown key, allowed: {checks.listed(['type', *names])}"
            raise ModelError(f"{where}.{key}", what, checks.nearest(key, names))
    wanted = [name for name in names if name != "weights"]
    missing = [name for name in wanted if name not in numbers]
    if missing:
        what = f"{given['type']} needs {' and '.join(wanted)}: {' and '.join(missing)} missing"
        raise ModelError(where, what)
    return _made(kind, numbers, where)


def _made(kind: type[Distribution], given: dict[str, Any], where: str) -> Distribution:
    try:
        return kind(**given)
    except ModelError as error:
        place = error.where.removeprefix(kind.__name__)
        raise ModelError(where + place, error.what, error.hint) from None


def standard(u: FloatArray) -> FloatArray:
    """Quantiles of the standard normal distribution."""
    from scipy.special import ndtri

    values: FloatArray = ndtri(np.clip(u, EDGE, 1.0 - EDGE))
    return values
