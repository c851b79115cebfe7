"""Gusts: turbulence of a wind along a line, with the spectrum of von Karman and a coherence."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Self

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks

#: What a gust is made of, with what is taken where nothing is given; None: must be given.
KEYS: dict[str, Any] = {
    "speed": None,
    "deviation": None,
    "length": None,
    "direction": 0.0,
    "line": (0.0, 1.0, 0.0),
    "extent": None,
    "spacing": 5.0,
    "decay": 10.0,
    "duration": 600.0,
    "step": 0.1,
    "ramp": 0.0,
    "seed": 1,
}
MOST_SEED, MOST_NUMBERS = 2**32, 20_000_000


class Gusts:
    """Turbulence along the wind, made by :meth:`von_karman`; it is added to the velocity of a fluid.

    At stations along a line the speed over the mean has the spectrum (one-sided, f in Hz)

        S(f) = 4 deviation^2 (length/speed) / (1 + 70.8 (f length/speed)^2)^(5/6)

    and between two stations, ``d`` apart, the coherence ``exp(-decay f d/speed)`` (Davenport). Between
    stations it is linear, in time smooth; it repeats itself after ``duration``. Across the line and along z
    it is the same. It grows from 0 at t = 0 within ``ramp``.

    Parameters
    ----------
    given : dict
        What :meth:`von_karman` takes.
    where : str
        Place in the model, for messages.

    Attributes
    ----------
    table : ndarray, shape (times, stations)
        Speeds over the mean, m/s.
    stations : ndarray, shape (stations,)
        Places along the line, m.

    Raises
    ------
    ModelError
        A number is missing or wrong, or the table would be very large.
    """

    __slots__ = ("given", "stations", "table", "values", "where")

    def __init__(self, given: Any, where: str = "gusts") -> None:
        given = given.given if isinstance(given, Gusts) else given
        if not isinstance(given, Mapping):
            raise ModelError(where, f"must be ancf.Gusts or a table, is {checks.shown(given)}")
        if unknown := set(given) - KEYS.keys():
            name = min(map(str, unknown))
            raise ModelError(f"{where}.{name}", "has no meaning here", checks.nearest(name, KEYS))
        for key in ("speed", "deviation", "length", "extent"):
            if key not in given:
                raise ModelError(f"{where}.{key}", "is missing")
        self.given: dict[str, Any] = dict(given)
        self.where = where
        v = self.values = _read(KEYS | self.given, where)
        low, high = v["extent"]
        if not low < high:
            raise ModelError(f"{where}.extent", f"is from {low:g} to {high:g} m, must grow")
        count = max(math.ceil((high - low) / v["spacing"]), 1) + 1
        times = round(v["duration"] / v["step"])
        if times < 8 or abs(times * v["step"] - v["duration"]) > 1e-6 * v["duration"]:
            what = f"is {v['duration']:g} s, must be a multiple of step = {v['step']:g} s, at least 8 of them"
            raise ModelError(f"{where}.duration", what)
        if times * count > MOST_NUMBERS:
            what = f"{times} times at {count} stations are too many numbers"
            raise ModelError(where, what, "give a longer step, a wider spacing or a shorter duration")
        self.stations = np.linspace(low, high, count)
        self.table = _table(v, times, count, (high - low) / (count - 1))

    @classmethod
    def von_karman(
        cls,
        speed: float,
        deviation: float,
        length: float,
        extent: tuple[float, float],
        direction: float = 0.0,
        line: Any = (0.0, 1.0, 0.0),
        spacing: float = 5.0,
        decay: float = 10.0,
        duration: float = 600.0,
        step: float = 0.1,
        ramp: float = 0.0,
        seed: int = 1,
    ) -> Self:
        """Turbulence with von Karman's spectrum.

        Parameters
        ----------
        speed, deviation : float, m/s
            Mean speed of the wind, which the fluid's velocity must have itself, and standard deviation.
        length : float, m
            Of the turbulence, along the wind.
        extent : (float, float), m
            From where to where along the line; outside it is as at the end.
        direction : float, rad
            In which the wind blows, from x towards y.
        line : (3,)
            Direction of the line, such as that of a conductor, along which gusts differ.
        spacing : float, m
            Of the stations.
        decay : float
            Of the coherence.
        duration, step : float, s
            After which the gusts repeat themselves; between numbers of the table.
        ramp : float, s
            Time in which they grow.
        seed : int

        """
        given = {key: value for key, value in locals().items() if key in KEYS}
        return cls(given, "Gusts.von_karman")

    def __deepcopy__(self, memo: dict[int, Any]) -> Gusts:
        return self  # it never changes

    def __repr__(self) -> str:
        return f"Gusts({self.given!r})"

    def describe(self) -> dict[str, Any]:
        """Plain JSON-able form."""
        return {key: list(x) if isinstance(x, tuple | np.ndarray) else x for key, x in self.given.items()}


def _read(given: Mapping[str, Any], where: str) -> dict[str, Any]:
    read: dict[str, Any] = {
        key: checks.positive(given[key], f"{where}.{key}")
        for key in ("speed", "length", "spacing", "duration", "step")
    }
    read |= {key: checks.non_negative(given[key], f"{where}.{key}") for key in ("deviation", "decay", "ramp")}
    read["direction"] = checks.number(given["direction"], f"{where}.direction")
    read["line"] = checks.direction(given["line"], f"{where}.line")
    read["extent"] = checks.array(given["extent"], f"{where}.extent", (2,)).tolist()
    read["seed"] = checks.integer(given["seed"], f"{where}.seed", 0, MOST_SEED)
    return read


def spectrum(f: FloatArray, speed: float, deviation: float, length: float) -> FloatArray:
    """Von Karman's one-sided spectrum of the speed along the wind, (m/s)^2/Hz, at f in Hz."""
    x = f * length / speed
    S: FloatArray = 4.0 * deviation**2 * (length / speed) / (1.0 + 70.8 * x * x) ** (5.0 / 6.0)
    return S


def _table(v: Mapping[str, Any], times: int, count: int, apart: float) -> FloatArray:
    """Speeds (times, stations): station after station, each as coherent with the one before as it must be.

    An exponential coherence along a line is that of a Markov chain: what a station shares with all before
    it shares with the last.
    """
    rng = np.random.default_rng(v["seed"])
    f = np.arange(times // 2 + 1) / v["duration"]
    size = np.sqrt(spectrum(f, v["speed"], v["deviation"], v["length"]) / v["duration"])
    size[0] = 0.0
    shared = np.exp(-v["decay"] * f * apart / v["speed"])
    fresh = np.sqrt(1.0 - shared * shared)
    table = np.empty((times, count))
    wave = np.zeros(len(f), dtype=complex)
    for k in range(count):
        noise = (rng.normal(size=len(f)) + 1j * rng.normal(size=len(f))) / math.sqrt(2.0)
        wave = noise if k == 0 else shared * wave + fresh * noise
        spectral = wave * size
        if times % 2 == 0:
            spectral[-1] = spectral[-1].real
        # irfft adds a component to its mirror image, and divides by the number of times
        table[:, k] = np.fft.irfft(spectral, times) * times / math.sqrt(2.0)
    return table
