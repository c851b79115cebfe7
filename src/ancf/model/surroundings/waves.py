"""Waves on the surface of a fluid: linear (Airy) waves, regular or with a spectrum."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, Self

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..told import Told

#: Height of a wave over tanh(k h) times its length, at which it breaks (Miche 1944).
STEEPEST = 0.142
#: Frequencies of a spectrum, in those of its peak.
LOWEST, HIGHEST = 0.4, 6.0
#: Points at which the energy of a spectrum is added up.
FINE = 20_001
#: Share by which the length of a wave is found, and the most rounds that takes.
FOUND, MOST_ROUNDS = 1e-14, 60

REGULAR, JONSWAP, PIERSON_MOSKOWITZ = "regular", "jonswap", "pierson-moskowitz"
STRETCHINGS = ("wheeler", "none")
_COMMON = {"height", "period", "direction", "depth", "ramp", "stretching"}
_KEYS = {
    REGULAR: _COMMON | {"phase"},
    JONSWAP: _COMMON | {"gamma", "seed", "components"},
    PIERSON_MOSKOWITZ: _COMMON | {"seed", "components"},
}
SPECTRA = tuple(_KEYS)
MOST_COMPONENTS, MOST_SEED = 2000, 2**32


class Waves(metaclass=Told):
    """A sum of linear waves, made by :meth:`regular`, :meth:`jonswap` or :meth:`pierson_moskowitz`.

    The surface is at ``eta = R(t) sum A cos(k s - omega t + phase)`` above the highest place ``below`` of the
    fluid, s along the direction of travel; velocities are those of the linear theory,

        u = R sum A omega cosh(k (z + h))/sinh(k h) cos(...),
        w = R sum A omega sinh(k (z + h))/sinh(k h) sin(...),

    accelerations their derivatives by time. R grows from 0 at t = 0 to 1 at ``ramp``, so that an equilibrium
    at t = 0 is that of calm water. Above the mean level and below it the profile is moved to the surface
    (``"wheeler"``: z - eta over (h + eta)/h), or taken as it stands, and above the mean level as at it
    (``"none"``).

    Parameters
    ----------
    given : dict
        ``spectrum`` and what the method of its name takes.
    where : str
        Place in the model, for messages.

    Attributes
    ----------
    amplitude, omega, phase : ndarray, shape (n,)
        Of the components, m, rad/s, rad.
    height, period : float
        Of a regular wave, or significant height and peak period, m, s.
    direction : float, rad
        In which the waves travel, from x towards y.
    depth : float, m
        Of the water under the mean level; inf: deep.
    ramp : float, s
    stretching : str

    Raises
    ------
    ModelError
        A number is missing or wrong, or such a wave would break in this depth.
    """

    __slots__ = (
        "amplitude",
        "depth",
        "direction",
        "given",
        "height",
        "omega",
        "period",
        "phase",
        "ramp",
        "stretching",
        "where",
    )

    def __init__(self, given: Any, where: str = "waves") -> None:
        given = given.given if isinstance(given, Waves) else given
        if not isinstance(given, Mapping):
            what = f"must be ancf.Waves or a table with a spectrum, is {checks.shown(given)}"
            raise ModelError(where, what)
        spectrum = checks.choice(given.get("spectrum"), f"{where}.spectrum", SPECTRA)
        if unknown := set(given) - _KEYS[spectrum] - {"spectrum"}:
            wanted = ", ".join(sorted(_KEYS[spectrum]))
            raise ModelError(
                f"{where}.{min(map(str, unknown))}", "has no meaning here", f"there are: {wanted}"
            )
        for key in ("height", "period"):
            if key not in given:
                raise ModelError(f"{where}.{key}", "is missing")
        self.given: dict[str, Any] = dict(given)
        self.where = where
        self.height = checks.positive(given["height"], f"{where}.height")
        self.period = checks.positive(given["period"], f"{where}.period")
        self.direction = checks.number(given.get("direction", 0.0), f"{where}.direction")
        depth = given.get("depth")
        self.depth = math.inf if depth is None else checks.positive(depth, f"{where}.depth")
        self.ramp = checks.non_negative(given.get("ramp", self.period), f"{where}.ramp")
        self.stretching = checks.choice(
            given.get("stretching", "wheeler"), f"{where}.stretching", STRETCHINGS
        )
        if spectrum == REGULAR:
            self.amplitude = np.array([0.5 * self.height])
            self.omega = np.array([2.0 * math.pi / self.period])
            self.phase = np.array([checks.number(given.get("phase", 0.0), f"{where}.phase")])
            return
        default = 3.3 if spectrum == JONSWAP else 1.0
        gamma = checks.number(given.get("gamma", default), f"{where}.gamma")
        if gamma < 1.0:
            raise ModelError(f"{where}.gamma", f"is {gamma:g}, must be at least 1")
        count = checks.integer(given.get("components", 100), f"{where}.components", 1, MOST_COMPONENTS)
        seed = checks.integer(given.get("seed", 1), f"{where}.seed", 0, MOST_SEED)
        self.omega = equal_energies(2.0 * math.pi / self.period, gamma, count)
        self.amplitude = np.full(count, 0.25 * self.height * math.sqrt(2.0 / count))
        self.phase = np.random.default_rng(seed).uniform(0.0, 2.0 * math.pi, count)

    @classmethod
    def regular(
        cls,
        height: float,
        period: float,
        direction: float = 0.0,
        phase: float = 0.0,
        depth: float | None = None,
        ramp: float | None = None,
        stretching: str = "wheeler",
    ) -> Self:
        """One wave.

        Parameters
        ----------
        height : float, m
            From trough to crest.
        period : float, s
        direction, phase : float, rad
            Direction of travel from x towards y; with phase 0 a crest is at x = y = 0 at t = 0.
        depth : float, m
            Of the water; default deep.
        ramp : float, s
            Time in which the wave grows; default its period.
        stretching : str
            "wheeler" or "none".

        """
        given = {"height": height, "period": period, "direction": direction, "phase": phase}
        return cls(_with(REGULAR, given, depth, ramp, stretching), "Waves.regular")

    @classmethod
    def jonswap(
        cls,
        height: float,
        period: float,
        gamma: float = 3.3,
        seed: int = 1,
        components: int = 100,
        direction: float = 0.0,
        depth: float | None = None,
        ramp: float | None = None,
        stretching: str = "wheeler",
    ) -> Self:
        """An irregular sea with the spectrum of JONSWAP (Hasselmann et al. 1973).

        Its components have equal energies; the phases are random.

        Parameters
        ----------
        height : float, m
            Significant height, four times the standard deviation of the surface.
        period : float, s
            Of the peak.
        gamma : float
            Peak enhancement; 1 is the spectrum of Pierson and Moskowitz.
        seed, components : int
            Of the random phases; number of waves.
        direction, depth, ramp, stretching
            As of :meth:`regular`; the sea grows in one peak period by default.

        """
        given = {"height": height, "period": period, "gamma": gamma, "seed": seed, "components": components}
        return cls(_with(JONSWAP, given | {"direction": direction}, depth, ramp, stretching), "Waves.jonswap")

    @classmethod
    def pierson_moskowitz(
        cls,
        height: float,
        period: float,
        seed: int = 1,
        components: int = 100,
        direction: float = 0.0,
        depth: float | None = None,
        ramp: float | None = None,
        stretching: str = "wheeler",
    ) -> Self:
        """An irregular sea with the spectrum of Pierson and Moskowitz (1964); see :meth:`jonswap`."""
        given = {"height": height, "period": period, "seed": seed, "components": components}
        table = _with(PIERSON_MOSKOWITZ, given | {"direction": direction}, depth, ramp, stretching)
        return cls(table, "Waves.pierson_moskowitz")

    def __deepcopy__(self, memo: dict[int, Any]) -> Waves:
        return self  # it never changes

    def __repr__(self) -> str:
        return f"Waves({self.given!r})"

    def describe(self) -> dict[str, Any]:
        """Plain JSON-able form."""
        return dict(self.given)

    def numbers(self, g: float) -> FloatArray:
        """Wave numbers (n,) of the components under the gravity g, m/s^2, in 1/m."""
        return wave_numbers(self.omega, self.depth, g)

    def elevation(self, t: Any, x: float = 0.0, y: float = 0.0, g: float = 9.81) -> FloatArray:
        """Height of the surface over the mean level, m, at times t (n,) in s at one place, shape (n,)."""
        return self.elevations(np.atleast_1d(t), np.float64(x), np.float64(y), g)

    def elevations(self, t: Any, x: Any, y: Any, g: float = 9.81) -> FloatArray:
        """The same at places x, y of any shape (...), shape (n, ...)."""
        t = np.asarray(t, dtype=np.float64)
        s = np.asarray(x) * math.cos(self.direction) + np.asarray(y) * math.sin(self.direction)
        place = self.numbers(g) * s[..., None] + self.phase
        share = [grown(float(now), self.ramp)[0] for now in t]
        rows = [
            r * (np.cos(place - self.omega * now) @ self.amplitude)
            for r, now in zip(share, t.tolist(), strict=True)
        ]
        return np.array(rows).reshape(len(t), *s.shape)

    def velocity(self, t: Any, x: float = 0.0, y: float = 0.0, z: float = 0.0, g: float = 9.81) -> FloatArray:
        """Velocity of the water, m/s, at times t (n,) in s at one place, shape (n, 3).

        ``z`` is the height over the mean level, m.  Above the surface it is that at the surface; what is
        moved there is said by ``stretching``.
        """
        return particles(self, t, (x, y, z), g)[0]

    def acceleration(
        self, t: Any, x: float = 0.0, y: float = 0.0, z: float = 0.0, g: float = 9.81
    ) -> FloatArray:
        """Its rate at that place, m/s^2, as :meth:`velocity`."""
        return particles(self, t, (x, y, z), g)[1]

    def refuse_breaking(self, where: str, g: float) -> None:
        """Raise ModelError if such a wave would break under the gravity g."""
        k = float(wave_numbers(np.array([2.0 * math.pi / self.period]), self.depth, g)[0])
        highest = STEEPEST * 2.0 * math.pi / k * math.tanh(min(k * self.depth, 50.0))
        if self.height > highest:
            water = "deep water" if math.isinf(self.depth) else f"{self.depth:g} m of water"
            what = f"is {self.height:g} m: a wave of {self.period:g} s breaks at {highest:.3g} m in {water}"
            raise ModelError(f"{where}.height", what, "give a lower or a longer wave, or more depth")


def _with(spectrum: str, given: dict[str, Any], depth: Any, ramp: Any, stretching: Any) -> dict[str, Any]:
    """Table of all that was given."""
    more = {"depth": depth, "ramp": ramp}
    found = {key: value for key, value in more.items() if value is not None}
    return {"spectrum": spectrum, **given, **found, "stretching": stretching}


def grown(t: float, ramp: float) -> tuple[float, float]:
    """Share R of the waves at a time, and its derivative: 3 s^2 - 2 s^3 of s = t/ramp."""
    if t >= ramp:
        return 1.0, 0.0
    if t <= 0.0:
        return 0.0, 0.0
    s = t / ramp
    return s * s * (3.0 - 2.0 * s), 6.0 * s * (1.0 - s) / ramp


def particles(
    waves: Waves, t: Any, place: tuple[float, float, float], g: float
) -> tuple[FloatArray, FloatArray]:
    """Velocities and accelerations (n, 3) of the water at a place, by linear theory as in a run."""
    times, k, h = np.atleast_1d(np.asarray(t, dtype=np.float64)), waves.numbers(g), waves.depth
    way = np.array([math.cos(waves.direction), math.sin(waves.direction)])
    psi = k * float(way @ place[:2]) - np.outer(times, waves.omega) + waves.phase
    share, growth = np.array([grown(float(now), waves.ramp) for now in times]).T
    at = np.full(len(times), float(place[2]))
    if waves.stretching == "wheeler":
        eta = share * (np.cos(psi) @ waves.amplitude)
        at = at - eta if math.isinf(h) else h * (at - eta) / (h + eta)
    at = np.clip(at, -h, 0.0)[:, None]
    mirrored = np.exp(-2.0 * k * (at + h))  # by the bottom
    speed = waves.amplitude * waves.omega * np.exp(k * at) / (1.0 - np.exp(-2.0 * k * h))
    level, lift = speed * (1.0 + mirrored), speed * (1.0 - mirrored)
    cos, sin = np.cos(psi), np.sin(psi)
    parts = [level * cos, lift * sin, waves.omega * level * sin, -waves.omega * lift * cos]
    u, w, du, dw = (part.sum(axis=1) for part in parts)
    rates = share * du + growth * u, share * dw + growth * w
    first, second = (
        np.stack([one * way[0], one * way[1], up], axis=1) for one, up in ((share * u, share * w), rates)
    )
    return first, second


def spectrum_of(omega: FloatArray, peak: float, gamma: float) -> FloatArray:
    """JONSWAP's spectrum of the surface at omega, but for a factor; gamma = 1: Pierson and Moskowitz."""
    ratio = omega / peak
    width = np.where(ratio <= 1.0, 0.07, 0.09)
    enhanced = gamma ** np.exp(-0.5 * ((ratio - 1.0) / width) ** 2)
    return ratio**-5.0 * np.exp(-1.25 * ratio**-4.0) * enhanced


def equal_energies(peak: float, gamma: float, count: int) -> FloatArray:
    """Frequencies (count,) that halve the energies of `count` bands of equal energy of a spectrum."""
    omega = peak * np.linspace(LOWEST, HIGHEST, FINE)
    S = spectrum_of(omega, peak, gamma)
    energy = np.concatenate([[0.0], np.cumsum(0.5 * (S[1:] + S[:-1]))])
    wanted = (np.arange(count) + 0.5) / count
    found: FloatArray = np.interp(wanted * energy[-1], energy, omega)
    return found


def wave_numbers(omega: FloatArray, depth: float, g: float) -> FloatArray:
    """Wave numbers k (n,) with omega^2 = g k tanh(k h)."""
    deep = omega * omega / g
    if math.isinf(depth):
        return deep
    k = deep / np.sqrt(np.tanh(np.minimum(deep * depth, 50.0)))  # never below, at most 11 % off
    for _ in range(MOST_ROUNDS):
        th = np.tanh(k * depth)
        change = (k * th - deep) / (th + k * depth * (1.0 - th * th))
        k = k - change
        if np.all(np.abs(change) <= FOUND * k):
            break
    return k
