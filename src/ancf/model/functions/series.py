"""Series: a measured or computed history in place of a function of time, smoothed where it is asked for."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...columns import read_columns, split_unit
from ...errors import ModelError
from .. import checks
from ..told import Told
from .units import factor, kind_of

INTERPOLATIONS = ("linear", "spline")
#: Keys of a series in a description, and in a file that names a CSV file.
KEYS = ("t", "value", "unit", "interpolation", "cutoff", "relative", "ramp", "integrate")
FILE_KEYS = ("csv", "column", "time", "time_unit", *KEYS[2:])
#: A motion is noisy if its acceleration above this share of half the sampling rate exceeds the rest and this.
HIGH, LEAST = 0.25, 1.0


class Series(metaclass=Told):
    """Values at increasing times, between which they are joined by straight lines or by a smooth curve.

    It stands where a function of time may: for all components, or for one of three. Before the first and
    after the last time it is constant.

    Parameters
    ----------
    t : (n,) s
        Increasing; in `time_unit`.
    value : (n,) or (n, 3)
        In `unit`.
    size : 1 or 3, optional
        Which of both it has to be.
    unit, time_unit : str
        One of ``ancf.model.functions.units.UNITS``, such as "mm", "kN", "deg"; default those of the package.
        One of another quantity than is meant is refused: a displacement in kN.
    interpolation : "spline" or "linear"
        A cubic spline through the values, twice differentiable, or straight lines.
    cutoff : float, Hz, optional
        A smoothing spline instead: of a vibration of this frequency it keeps the 0.71th part (-3 dB), of one
        of twice the frequency the 0.13th, of one of half of it 0.975, without a lag.
    relative : bool
        Count from the value at the first time, as displacements do; with a ramp from that where it begins.
    ramp : float, s, optional
        Time in which it sets in: from the value at t = 0, or at the first time if that is later, by ``first +
        (value - first) (10 x^3 - 15 x^4 + 6 x^5)``, so that rates and accelerations begin with zero.
    integrate : bool
        The values are speeds and the series their way, zero at the first time; "linear" joins the speeds.

    Raises
    ------
    ModelError
        Times do not increase, a value is no finite number, too few of them, or an unknown unit.
    """

    __slots__ = ("_curve", "cutoff", "integrate", "interpolation", "ramp", "relative", "t", "unit", "value")

    def __init__(
        self,
        t: Any,
        value: Any,
        *,
        size: int | None = None,
        unit: str = "",
        time_unit: str = "s",
        interpolation: str = "spline",
        cutoff: float | None = None,
        relative: bool = False,
        ramp: float | None = None,
        integrate: bool = False,
        where: str = "Series",
    ) -> None:
        self.t = checks.array(t, f"{where}.t", (None,)) * factor(time_unit, f"{where}.time_unit", "s")
        self.value = _values(value, where, size) * factor(unit, f"{where}.unit")
        self.integrate = checks.flag(integrate, f"{where}.integrate")
        self.unit = _way(unit, where) if self.integrate else kind_of(unit) if unit else None
        self.interpolation = checks.choice(interpolation, f"{where}.interpolation", INTERPOLATIONS)
        self.cutoff = None if cutoff is None else checks.positive(cutoff, f"{where}.cutoff")
        self.relative = checks.flag(relative, f"{where}.relative")
        checks.increasing(self.t, f"{where}.t", "times", " s")
        if len(self.value) != self.t.size:
            raise ModelError(f"{where}.value", f"has {len(self.value)} values for {self.t.size} times")
        self._check_cutoff(where)
        self.ramp = None if ramp is None else self._checked_ramp(ramp, f"{where}.ramp")
        self._curve = self._fitted()

    def _checked_ramp(self, ramp: Any, where: str) -> float:
        found, left = checks.positive(ramp, where), float(self.t[-1]) - self.begin
        if found > left:
            what = f"is {found:g} s, the series ends {max(left, 0.0):.6g} s after t = {self.begin:g} s"
            raise ModelError(where, what, "it sets in from t = 0 on, or from the first time if that is later")
        return found

    def _check_cutoff(self, where: str) -> None:
        if self.cutoff is None:
            return
        if self.interpolation == "linear":
            raise ModelError(f"{where}.cutoff", "smooths by a spline", 'leave interpolation = "linear" out')
        if self.t.size < 5:
            raise ModelError(f"{where}.cutoff", f"needs at least 5 times, there are {self.t.size}")
        length = float(self.t[-1] - self.t[0])
        if self.cutoff * length < 1.0:
            what = f"is {self.cutoff:g} Hz, of which the {length:g} s of the series hold not one period"
            raise ModelError(f"{where}.cutoff", what, f"take more than {1 / length:.3g} Hz")

    @classmethod
    def read(cls, csv: str | Path, column: str | list[str], *, time: str = "", **more: Any) -> Series:
        """Read it from a CSV file with a head.

        Parameters
        ----------
        csv : path
        column : str or three of them
            Names of columns, with or without the unit that stands behind them in brackets: "x" or "x [mm]".
        time : str
            Column of the times; default "t", "time" or the first one.
        more
            As for :class:`Series`; a unit that is not given is that of the head.

        Raises
        ------
        ModelError
            The file cannot be read, or has no such column.
        """
        where = more.pop("where", "Series")
        units = {key: more.pop(key) for key in ("unit", "time_unit") if key in more}
        found = read_table(Path(csv), column, where, time=time, **units)
        return cls(found["t"], found["value"], unit=found["unit"], **more, where=where)

    @property
    def size(self) -> int:
        """1 or 3."""
        return 1 if self.value.ndim == 1 else 3

    @property
    def begin(self) -> float:
        """Time at which a ramp begins, s."""
        return max(float(self.t[0]), 0.0)

    def __call__(self, times: FloatArray | float, derivative: int = 0) -> FloatArray:
        """Values (n, size) at times (n,) or at a single one, or their first or second derivative."""
        times = np.atleast_1d(np.asarray(times, dtype=np.float64))
        if self.ramp is None:
            return self._whole(times, derivative)
        first = self._whole(np.array([self.begin]))
        share = _rise((times - self.begin) / self.ramp, self.ramp)
        above = self._whole(times) - first
        if derivative == 0:
            grown: FloatArray = above * share[0] + (0.0 if self.relative else first)
            return grown
        rate = self._whole(times, 1)
        if derivative == 1:
            value: FloatArray = rate * share[0] + above * share[1]
            return value
        bend: FloatArray = self._whole(times, 2) * share[0] + 2.0 * rate * share[1] + above * share[2]
        return bend

    def _whole(self, times: FloatArray, derivative: int = 0) -> FloatArray:
        """As given, without a ramp."""
        held = np.clip(times, self.t[0], self.t[-1])
        if callable(self._curve):
            found: FloatArray = np.asarray(self._curve(held, derivative)).reshape(len(held), -1)
            inside = (times >= self.t[0]) & (times <= self.t[-1])
            return found if derivative == 0 else np.where(inside[:, None], found, 0.0)
        columns = self._curve.reshape(len(self.t), -1).T
        return np.column_stack([np.interp(held, self.t, column) for column in columns])

    @property
    def constant(self) -> bool:
        """All values are the same."""
        return bool(np.all(self.value == self.value[0]) and not (self.integrate and np.any(self.value)))

    def describe(self) -> dict[str, Any]:
        """Plain form, in the units of the package; what :meth:`of` reads."""
        plain: dict[str, Any] = {"t": self.t.tolist(), "value": self.value.tolist()}
        plain["interpolation"] = self.interpolation
        if self.cutoff is not None:
            plain["cutoff"] = self.cutoff
        plain |= {"relative": True} if self.relative else {}
        rate = "/s" if self.integrate else ""
        plain |= {"unit": (self.unit or "1") + rate} if self.unit is not None else {}
        plain |= {"integrate": True} if self.integrate else {}
        return plain | ({"ramp": self.ramp} if self.ramp is not None else {})

    @classmethod
    def of(cls, plain: Mapping[str, Any], where: str, size: int | None = None) -> Series:
        """From a table in a description or a file: straight lines, if it does not say otherwise."""
        if set(plain) - set(KEYS) or not {"t", "value"} <= set(plain):
            what = f'a table has the keys "t" and "value", not {sorted(map(str, plain))}'
            hint = 'also "unit", "interpolation", "cutoff", "relative", "ramp", "integrate"; '
            hint += '{ csv = "file.csv", column = "x" } in a file'
            raise ModelError(where, what, hint)
        smooth = "spline" if "cutoff" in plain else "linear"
        return cls(**{"interpolation": smooth, **plain}, where=where, size=size)

    def __reduce__(self) -> Any:
        return Series.of, (self.describe(), "Series", self.size)

    def __repr__(self) -> str:
        more = f", cutoff={self.cutoff:g} Hz" if self.cutoff else ""
        more += (f", ramp={self.ramp:g} s" if self.ramp else "") + (", integrated" if self.integrate else "")
        return (
            f"Series({self.t.size} values from {self.t[0]:g} to {self.t[-1]:g} s, {self.interpolation}{more})"
        )

    def noise(self) -> tuple[float, float, float] | None:
        """Acceleration of a motion that comes from noise: its size, the rest, and what the noise may be.

        Root mean squares in value/s^2 of what is above :data:`HIGH` of half the sampling rate and below, and
        the noise of the values; None if that is less than the rest or than :data:`LEAST`. White noise has
        nearly all of its acceleration there, a motion that its samples resolve next to nothing.
        """
        if self.t.size < 16 or self.integrate:  # noise of speeds is differentiated once, not twice
            return None
        step = float(np.median(np.diff(self.t)))
        cut = HIGH * 0.5 / step
        if self.cutoff is not None and self.cutoff < cut:
            return None
        smooth = Series(self.t, self.value, cutoff=cut)
        at = self.t[2:-2]
        rest = float(np.sqrt(np.mean(smooth(at, 2) ** 2)))
        even = np.linspace(self.t[0], self.t[-1], self.t.size)
        raw = np.diff(self(even), 2, axis=0) / (even[1] - even[0]) ** 2
        high = float(np.sqrt(max(np.mean(raw**2) - rest**2, 0.0)))
        if high < max(rest, LEAST):
            return None
        return high, rest, high * step**2 / np.sqrt(6.0)

    def _fitted(self) -> Any:
        """The curve that is followed, or for straight lines its values."""
        from scipy.interpolate import CubicSpline, make_interp_spline  # a model without series does without

        values = self.value
        if self.integrate and self.cutoff is None:
            straight = self.interpolation == "linear"
            joined = make_interp_spline(self.t, values, k=1) if straight else CubicSpline(self.t, values)
            return joined.antiderivative()
        if self.interpolation == "linear":
            return values - values[0] if self.relative else values
        if self.cutoff is not None:
            curve: Any = _smoothed(self.t, values, self.cutoff, self.integrate)
        else:
            curve = CubicSpline(self.t, values, bc_type="not-a-knot" if self.t.size > 3 else "natural")
        if not self.relative and not self.integrate:
            return curve
        first = curve(self.t[0])
        return lambda times, derivative=0: curve(times, derivative) - (first if derivative == 0 else 0.0)


def _rise(x: FloatArray, length: float) -> FloatArray:
    """What a ramp has reached at shares x (n,) of its length, and its rates, shape (3, n, 1)."""
    x = np.clip(x, 0.0, 1.0)[:, None]
    rest = 1.0 - x
    value = x**3 * (10.0 - 15.0 * x + 6.0 * x**2)
    return np.stack([value, 30.0 * (x * rest) ** 2 / length, 60.0 * x * rest * (rest - x) / length**2])


def _smoothed(t: FloatArray, values: FloatArray, cutoff: float, integrate: bool) -> Any:
    """Smoothing spline that keeps 1/sqrt(2) of a vibration with the cut-off frequency.

    The curve f minimises the sum of w (y - f)^2 and lam times the integral of f''^2. With weights that are
    the spacings of the times this is a filter 1/(1 + lam omega^4); see Unser, Splines, IEEE Signal
    Processing Magazine 16 (1999). Times are counted in mean spacings,
    which keeps the equations well conditioned.
    """
    from scipy.interpolate import make_smoothing_spline

    spacing = float(t[-1] - t[0]) / (len(t) - 1)
    x = (t - t[0]) / spacing
    weights = np.gradient(x)
    strength = (np.sqrt(2.0) - 1.0) / (2.0 * np.pi * cutoff * spacing) ** 4
    columns = [
        make_smoothing_spline(x, column, w=weights, lam=strength) for column in values.reshape(len(t), -1).T
    ]

    columns = [column.antiderivative() for column in columns] if integrate else columns
    unit = spacing if integrate else 1.0

    def curve(times: Any, derivative: int = 0) -> FloatArray:
        places = (np.asarray(times) - t[0]) / spacing
        parts = [unit * column(places, derivative) / spacing**derivative for column in columns]
        stacked: FloatArray = np.stack(parts, axis=-1)
        return stacked[..., 0] if values.ndim == 1 else stacked

    return curve


def _way(unit: str, where: str) -> str | None:
    """Unit of the integral of values with a unit, that of a speed; None without."""
    kind = kind_of(unit) if unit else None
    if kind is not None and kind not in ("m/s", "rad/s"):
        raise ModelError(f"{where}.integrate", f"is of speeds, the values are in {kind or '1'}")
    return kind.removesuffix("/s") if kind else None


def _values(value: Any, where: str, size: int | None) -> FloatArray:
    rows = np.ndim(value[0]) > 0 if isinstance(value, list | tuple) and len(value) else np.ndim(value) > 1
    size = checks.components(size, f"{where}.size")
    if size == 3 and not rows and len(np.atleast_1d(value)):
        hint = "give one for each component, [series, 0, 0], or three columns"
        raise ModelError(f"{where}.value", "has one number at each time, where three are wanted", hint)
    shape: tuple[int | None, ...] = (None, 3) if size == 3 or (size is None and rows) else (None,)
    return checks.array(value, f"{where}.value", shape)


def read_table(
    path: Path, column: Any, where: str, *, time: Any = "", unit: Any = None, time_unit: Any = None
) -> dict[str, Any]:
    """Times ``t`` and values ``value`` of a CSV file in units of the package; see :meth:`Series.read`.

    ``unit`` is that of the package in which the values are, "" if neither file nor caller name one.

    Raises
    ------
    ModelError
        The file cannot be read, has no such column, or a unit is unknown.
    """
    found = read_columns(path, f"{where}.csv")
    names = [column] if isinstance(column, str) else column
    if not isinstance(names, list | tuple) or (names is column and len(names) != 3):
        raise ModelError(f"{where}.column", f"must be a name or three of them, is {checks.shown(column)}")
    clock = _clock(found, time, where)
    heads = [_head(found, name, f"{where}.column") for name in names]
    said = {split_unit(head)[1] for head in heads} - {""}
    if unit is None and len(said) > 1:
        raise ModelError(f"{where}.column", f"has the units {checks.listed(sorted(said))}, wanted one")
    named = next(iter(said), "") if unit is None else unit
    scale = factor(named, f"{where}.unit")
    said_clock = (split_unit(clock)[1] or "s") if time_unit is None else time_unit
    ticks = factor(said_clock, f"{where}.time_unit", "s")
    columns = [scale * _numbers(found[head], f'{where}.csv: column "{head}"') for head in heads]
    values = columns[0] if isinstance(column, str) else np.column_stack(columns)
    times = ticks * _numbers(found[clock], f'{where}.csv: column "{clock}"')
    return {"t": times, "value": values, "unit": (kind_of(named) or "1") if named else ""}


def _clock(found: Mapping[str, Any], time: str, where: str) -> str:
    """Head of the column with the times."""
    if time:
        return _head(found, time, f"{where}.time")
    named = [head for head in found if split_unit(head)[0].lower() in ("t", "time")]
    return named[0] if named else next(iter(found))


def _head(found: Mapping[str, Any], name: Any, where: str) -> str:
    if name in found:
        return str(name)
    plain_of = {split_unit(head)[0]: head for head in found}
    plain = [head for head in found if split_unit(head)[0] == name]
    if len(plain) == 1:
        return plain[0]
    alike = [head for head in plain_of if isinstance(name, str) and head.lower() == name.lower()]
    hint = f'did you mean "{alike[0]}"?' if alike else checks.nearest(name, [*found, *plain_of])
    raise ModelError(where, f'is "{name}", the file has the columns {checks.listed(found)}', hint)


def _numbers(column: Any, where: str) -> FloatArray:
    if any(isinstance(entry, str) for entry in column):
        row, wrong = next((k, entry) for k, entry in enumerate(column) if not _is_number(entry))
        raise ModelError(where, f"must hold numbers, holds {checks.shown(wrong)} in row {row + 2}")
    return np.asarray(column, dtype=np.float64)


def _is_number(entry: Any) -> bool:
    try:
        return bool(np.isfinite(float(str(entry).replace(",", "."))))
    except ValueError:
        return False


def noises(model: Any) -> list[str]:
    """What is said of motions of a model whose accelerations are those of noise."""
    found = []
    for support in model.supports:
        for name in ("displacement", "rotation"):
            function: Any = getattr(support, name, None)
            if function is None:
                continue
            for series in function.series:
                if (noise := series.noise()) is not None:
                    where = function.where
                    where += f' of "{support.name}"' if where.startswith("supports[") else ""
                    found.append(_said(where, name, series, *noise))
    return found


def _said(where: str, name: str, series: Series, high: float, rest: float, noise: float) -> str:
    unit = "rad" if name == "rotation" else "m"
    step = float(np.median(np.diff(series.t)))
    cut = HIGH * 0.5 / step
    return (
        f"{where}: accelerations of {high:.3g} {unit}/s^2 (rms) lie above {cut:.3g} Hz and {rest:.3g} below: "
        f"those of a noise of about {noise:.2g} {unit}, not of a motion; a cutoff below {cut:.3g} Hz smooths"
    )
