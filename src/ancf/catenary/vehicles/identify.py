"""A pantograph from a measured frequency response: a chain of masses that answers alike."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from .pantograph import Pantograph

#: What is measured at the strip: force over acceleration in kg, over velocity in N s/m, over displacement in
#: N/m, or their inverses; with the power of i omega that makes it a force over displacement.
KINDS = {"apparent_mass": (2, False), "impedance": (1, False), "dynamic_stiffness": (0, False)}
KINDS |= {"accelerance": (2, True), "mobility": (1, True), "receptance": (0, True)}
WHERE = "identify_pantograph"
#: Most masses that are tried, starts of each search, bounds of it as factors of the start.
MOST_MASSES, STARTS, WIDE = 4, 12, 1e4
#: A longer chain has to leave less than this share of the error of a shorter one: less follows the noise.
CLEARLY = 0.8
#: Relative error above which a chain does not answer as what was measured; masses of pantographs, kg.
ROUGH, LIGHTEST, HEAVIEST = 0.1, 0.05, 100.0


def dynamic_stiffness(unit: Pantograph, frequency: npt.ArrayLike) -> npt.NDArray[np.complex128]:
    """Force over displacement (n,) at the head of a pantograph on a roof at rest, N/m.

    Of small motions and without friction. From the roof on Z_1 = k_1 + i w c_1 - w^2 m_1 and, with
    s_j = k_j + i w c_j, Z_j = s_j Z_{j-1} / (s_j + Z_{j-1}) - w^2 m_j.

    Parameters
    ----------
    unit : Pantograph
    frequency : (n,) float
        Hz.

    Raises
    ------
    ModelError
        A frequency is no finite number >= 0, or it is no pantograph.

    """
    given: object = unit
    if not isinstance(given, Pantograph):
        what = f"must be a Pantograph, is {checks.shown(given)}"
        raise ModelError("dynamic_stiffness.unit", what, "find_pantograph(name)")
    hertz = np.array(
        [
            checks.non_negative(f, f"dynamic_stiffness.frequency[{k}]")
            for k, f in enumerate(np.atleast_1d(frequency).tolist())
        ]
    )
    return _chain(
        np.array(unit.masses),
        np.array(unit.slopes()),
        np.array([stage.damping_at_rest for stage in unit.stages]),
        2.0 * np.pi * hertz,
    )


def _chain(m: FloatArray, k: FloatArray, c: FloatArray, w: FloatArray) -> npt.NDArray[np.complex128]:
    spring = k[:, None] + 1j * w * c[:, None]
    below = spring[0] - w**2 * m[0]
    for j in range(1, len(m)):
        below = spring[j] * below / (spring[j] + below) - w**2 * m[j]
    made: npt.NDArray[np.complex128] = below
    return made


def _slopes(m: FloatArray, k: FloatArray, c: FloatArray, w: FloatArray) -> npt.NDArray[np.complex128]:
    """Derivatives (frequencies, 3 masses) of a chain's stiffness by the logarithms of m, of k and of c."""
    n = len(m)
    spring = k[:, None] + 1j * w * c[:, None]
    made = np.empty((3, n, w.size), dtype=np.complex128)
    below = np.zeros(w.size, dtype=np.complex128)
    for j in range(n):
        # of s Z / (s + Z): by Z the square of s / (s + Z), by s that of Z / (s + Z); the roof does not yield
        share = spring[j] / (spring[j] + below) if j > 0 else np.zeros_like(below)
        made[:, :j] *= share**2
        made[:, j] = -(w**2) * m[j], k[j] * (1.0 - share) ** 2, 1j * w * c[j] * (1.0 - share) ** 2
        below = (share * below if j > 0 else spring[0]) - w**2 * m[j]
    return made.reshape(3 * n, w.size).T


@dataclass(frozen=True)
class Identified:
    """A pantograph from its frequency response, and how far it is off.

    Parameters
    ----------
    pantograph : Pantograph
    frequency : (n,) float
        Hz.
    measured, fitted : (n,) complex
        Dynamic stiffness at the head, N/m.

    """

    pantograph: Pantograph
    frequency: FloatArray
    measured: npt.NDArray[np.complex128]
    fitted: npt.NDArray[np.complex128]

    @property
    def error(self) -> float:
        """Root of the mean square of the relative errors."""
        return float(np.sqrt(np.mean(np.abs(self.errors) ** 2)))

    @property
    def errors(self) -> npt.NDArray[np.complex128]:
        """``(fitted - measured) / |measured|`` at each frequency (n,)."""
        made: npt.NDArray[np.complex128] = (self.fitted - self.measured) / np.abs(self.measured)
        return made

    @property
    def plausible(self) -> bool:
        """Whether all masses are those of a pantograph, 0.05 to 100 kg."""
        return all(LIGHTEST <= mass <= HEAVIEST for mass in self.pantograph.masses)

    @property
    def largest(self) -> float:
        """Largest of them."""
        return float(np.max(np.abs(self.errors)))


def identify_pantograph(
    frequency: npt.ArrayLike,
    response: npt.ArrayLike,
    *,
    kind: str = "apparent_mass",
    masses: int | None = None,
    tolerance: float = 0.02,
    static_force: float = 70.0,
    **more: Any,
) -> Identified:
    """Fit a chain of masses to the frequency response at the strip, from the roof at rest.

    Relative errors of the complex response at all frequencies are made as small as can be in the mean, from
    several starts. Without `masses` the shortest chain that stays within the tolerance is taken, or else the
    shortest of which no longer one with masses of a pantograph leaves clearly less, four fifths of its error.

    Parameters
    ----------
    frequency : (n,) float
        Hz, above 0.
    response : (n,) complex
        At these frequencies, force upwards from the wire on the strip over its motion, or the inverse.
    kind : str
        "apparent_mass", "impedance", "dynamic_stiffness" or their inverses "accelerance", "mobility",
        "receptance", SI units.
    masses : int
        1 to 4; default found.
    tolerance : float
        Root of the mean square of the relative errors, of which the result says what it is.
    static_force, more
        What a response does not say: see :class:`Pantograph`.

    Raises
    ------
    ModelError
        Lists of different lengths, too few values, a value that is zero or not finite, an unknown kind.

    Warns
    -----
    UserWarning
        The error is above 10 %, with the kind that would fit, or a mass is none of a pantograph.
    """
    f, stiffness = _checked(frequency, response, kind)
    counts = list(range(1, MOST_MASSES + 1))
    if masses is not None:
        counts = [checks.integer(masses, f"{WHERE}.masses", 1, MOST_MASSES)]
    checks.positive(tolerance, f"{WHERE}.tolerance")
    more = {"name": "identified", "static_force": static_force, **more}
    found = _best(f, stiffness, counts, tolerance, more)
    for text in _cautions(found, frequency, response, kind):
        warnings.warn(text, UserWarning, stacklevel=3)
    return found


def _best(
    f: FloatArray,
    stiffness: npt.NDArray[np.complex128],
    counts: Sequence[int],
    tolerance: float,
    more: dict[str, Any],
) -> Identified:
    """The shortest chain within the tolerance, or of which no longer one is clearly better."""
    made: list[Identified] = []
    for count in counts:
        if 3 * count > 2 * f.size:
            break
        m, k, c = _fit(f, stiffness, count)
        unit = Pantograph(masses=m, stiffness=k, damping=c, **more)
        made.append(Identified(unit, f, stiffness, dynamic_stiffness(unit, f)))
        if made[-1].error <= tolerance and made[-1].plausible:
            return made[-1]
    if not made:
        raise ModelError(f"{WHERE}.frequency", f"has {f.size} values, too few for the chain", "give more")
    likely = [one for one in made if one.plausible] or made
    least = min(one.error for one in likely)
    return next(one for one in likely if one.error * CLEARLY <= least)


def _cautions(found: Identified, frequency: Any, response: Any, kind: str) -> Iterator[str]:
    """What is to be said about a chain before it is used."""
    if found.error > ROUGH:
        text = (
            f"{WHERE}: the chain is {100.0 * found.error:.0f} % off in the mean, above {100.0 * ROUGH:.0f} %"
        )
        fits = {}
        for other in KINDS:
            f, stiffness = _checked(frequency, response, other)
            counts = [n for n in range(1, MOST_MASSES) if 3 * n <= 2 * f.size]
            one = _best(f, stiffness, counts, ROUGH, {"static_force": 1.0}) if other != kind else found
            if one.plausible:
                fits[other] = one.error
        near = min(fits, key=fits.__getitem__, default=kind)
        if near != kind and fits[near] < CLEARLY * found.error:
            better = f"{100.0 * fits[near]:.2g} %"
            text += f'; as kind "{near}" a chain is {better} off: is "{kind}" what was measured?'
        yield text
    if not found.plausible:
        sizes = ", ".join(f"{mass:.3g}" for mass in found.pantograph.masses)
        text = f"{WHERE}: masses of {sizes} kg are none of a pantograph, {LIGHTEST:g} to {HEAVIEST:g} kg: "
        yield text + "they follow noise, or the kind or the unit of the response is another one"


def _numbers(given: Any, key: str, kind: Any) -> Any:
    try:
        return np.asarray(given, dtype=kind)
    except (TypeError, ValueError, OverflowError):
        what = f"must be a list of numbers, is {checks.shown(given)}"
        raise ModelError(f"{WHERE}.{key}", what) from None


def _checked(frequency: Any, response: Any, kind: str) -> tuple[FloatArray, npt.NDArray[np.complex128]]:
    """Frequencies in ascending order and the dynamic stiffness there."""
    checks.choice(kind, f"{WHERE}.kind", tuple(KINDS))
    f = _numbers(frequency, "frequency", np.float64)
    given = _numbers(response, "response", np.complex128)
    if f.shape == given.shape == (1,):
        raise ModelError(
            f"{WHERE}.response", "has one frequency", "a chain needs two or more, some tens say more"
        )
    if f.ndim != 1 or f.shape != given.shape or f.size < 2:
        what = f"has the shape {given.shape} for frequencies of the shape {f.shape}"
        raise ModelError(f"{WHERE}.response", what, "give one complex number for each frequency")
    for i in range(f.size):
        if not (np.isfinite(f[i]) and f[i] > 0.0):
            raise ModelError(f"{WHERE}.frequency[{i}]", f"is {f[i]:g}, must be finite and > 0")
        if not np.isfinite(given[i]) or given[i] == 0:
            raise ModelError(f"{WHERE}.response[{i}]", f"is {given[i]:g}, must be finite and not 0")
    power, inverse = KINDS[kind]
    stiffness = (1.0 / given if inverse else given) * (2j * np.pi * f) ** power
    order = np.argsort(f, kind="stable")
    made: npt.NDArray[np.complex128] = stiffness[order]
    return f[order], made


def _fit(
    f: FloatArray, measured: npt.NDArray[np.complex128], count: int
) -> tuple[tuple[float, ...], tuple[float, ...], tuple[float, ...]]:
    """Masses, stiffnesses and dampings of the best chain, by least squares in their logarithms."""
    from scipy.optimize import least_squares

    w = 2.0 * np.pi * f
    scale = np.abs(measured)

    def residual(x: FloatArray) -> FloatArray:
        m, k, c = np.exp(x).reshape(3, count)
        difference = (_chain(m, k, c, w) - measured) / scale
        return np.concatenate([difference.real, difference.imag])

    def slopes(x: FloatArray) -> FloatArray:
        m, k, c = np.exp(x).reshape(3, count)
        made = _slopes(m, k, c, w) / scale[:, None]
        return np.concatenate([made.real, made.imag])

    total = max(float(np.median(scale / w**2)), 1e-3)
    rng = np.random.default_rng(0)
    best, least = None, np.inf
    for start in range(STARTS):
        low, high = np.log(f[0]), np.log(f[-1])
        at, m = np.linspace(low, high, count + 2)[1:-1], np.full(count, total)
        if start > 0:
            at, m = rng.uniform(low, high, count), total * np.exp(rng.normal(0.0, 0.7, count))
        k = m * (2.0 * np.pi * np.exp(at)) ** 2
        x = np.log(np.concatenate([m, k, 0.2 * np.sqrt(k * m)]))
        wide = np.log(WIDE)
        found = least_squares(residual, x, slopes, bounds=(x - wide, x + wide), x_scale=1.0, max_nfev=400)
        if found.cost < least:
            best, least = found.x, found.cost
        if least < 1e-12 * f.size:
            break
    assert best is not None
    rows = np.exp(best).reshape(3, count).tolist()
    return tuple(rows[0]), tuple(rows[1]), tuple(rows[2])
