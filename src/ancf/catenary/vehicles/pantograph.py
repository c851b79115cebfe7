"""Pantograph: a chain of lumped masses that carries the collector strip."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from importlib.resources import files
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ...errors import ModelError
from ...model import checks
from ...model.checks import nearest, shown
from ...model.file import parameters, read_toml
from ...model.file.kinds import PANTOGRAPH, refuse
from ...model.file.messages import beside, combined, of_validation
from .stage import Stage, damper_of, spring_of, stops_of

RELAXED = ("start", "nominal", "mean")
#: Stiffness of stops, N/m, and the largest distance of two strips, m.
STOP, WIDEST = 1e5, 2.0
#: Beyond these what is meant is in other units: masses of files in kg, lengths of strips in m, forces in N.
MASSES, STRIPS, MOST_FORCE, MOST_AERODYNAMIC = (0.01, 500.0), (0.2, 4.0), 1e4, 10.0


def _meant(value: float, where: str, bounds: tuple[float, float], unit: str) -> float:
    """A number between bounds; ModelError that asks for its unit."""
    low, high = bounds
    if not low <= value <= high:
        what = f"is {value:g} {unit}, must be between {low:g} and {high:g}"
        raise ModelError(where, what, f"units are {unit}")
    return value


#: What each entry of a list has to be.
CHECKS: dict[str, Callable[[Any, str], Any]] = {
    "masses": checks.positive,
    "stiffness": spring_of,
    "damping": damper_of,
    "friction": checks.non_negative,
    "stops": stops_of,
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Pantograph:
    """A chain of masses, springs and dampers between the roof and the collector strip.

    Its weight is balanced, as that of a real one is by its main spring: what pushes the strip up is the
    static force F0 and the aerodynamic force k v^2, both on the lowest mass.

    Parameters
    ----------
    masses : sequence of float, kg
        From the lowest to the head with the strip.
    stiffness : sequence of float, N/m, or of (n, 2)
        Of the springs below each mass, the first stands on the roof; or rows of elongation in m and force in
        N, tension positive, straight between them and beyond.
    damping : sequence of float, N s/m, or of (n, 2)
        Of the dampers below each mass; or rows of rate of elongation in m/s and force in N.
    static_force : float, N
        Contact force at standstill.
    aerodynamic : float or one for each mass, N s^2/m^2
        k of the force k v^2, on the lowest mass or on each.
    friction : sequence of float, N
        Coulomb's, below each mass, by default none. It has grown to 0.76 of its size at 10 mm/s.
    stops : sequence of (float, float) or None, m
        Below each mass the elongations of its spring at which it meets a stop; default none.
    stop_stiffness : float, N/m
        Of all stops.
    strip_length : float, m
        Length of the collector strip across the track.
    strip_distance : float, m
        Of two strips, one behind the other, each with half of the head's mass on half of its spring and
        damper, so that the head pitches. Default 0, one strip.
    relaxed_at : "start", "nominal" or "mean"
        Height of the strip at which the lowest spring carries nothing: where the pantograph stands in
        equilibrium at the start, the nominal height of the contact wire, or the mean height over the
        window, found in a short trial run. The mean contact force is then the static and the aerodynamic
        force, as the standards want it.
    name, title, source : str
    tags : mapping of str to str
        How sure a value is, by its key.

    Raises
    ------
    ModelError
        A value is out of range, or lists of different lengths.

    """

    masses: tuple[float, ...]
    stiffness: tuple[Any, ...]
    damping: tuple[Any, ...]
    static_force: float
    aerodynamic: Any = 0.0
    friction: tuple[float, ...] = ()
    stops: tuple[Any, ...] = ()
    stop_stiffness: float = STOP
    strip_length: float = 1.45
    strip_distance: float = 0.0
    relaxed_at: str = "start"
    name: str = "pantograph"
    title: str = ""
    source: str = ""
    tags: Any = field(default=None, hash=False)

    def __post_init__(self) -> None:
        where = f"pantograph.{self.name}"
        for key, check in CHECKS.items():
            given = checks.items(getattr(self, key), f"{where}.{key}", "one for each mass, the lowest first")
            values = tuple(check(x, f"{where}.{key}[{k}]") for k, x in enumerate(given))
            object.__setattr__(self, key, values)
        for key in ("stiffness", "damping", *(name for name in ("friction", "stops") if getattr(self, name))):
            if len(getattr(self, key)) != len(self.masses) or not self.masses:
                what = f"has {len(getattr(self, key))} values for {len(self.masses)} masses"
                raise ModelError(f"{where}.{key}", what, "give one for each mass, the lowest first")
        checks.positive(self.stop_stiffness, f"{where}.stop_stiffness")
        if checks.non_negative(self.strip_distance, f"{where}.strip_distance") > WIDEST:
            raise ModelError(f"{where}.strip_distance", f"is {self.strip_distance:g} m", "units are m: 0.58")
        for k, (c, d) in enumerate(zip(self.stiffness, self.damping, strict=True)):
            if c == 0.0 and (k > 0 or d == 0.0):
                raise ModelError(f"{where}.stiffness[{k}]", "is 0: nothing carries the masses above")
        force = checks.positive(self.static_force, f"{where}.static_force")
        _meant(force, f"{where}.static_force", (0.0, MOST_FORCE), "N")
        self._check_aerodynamic(f"{where}.aerodynamic")
        length = checks.positive(self.strip_length, f"{where}.strip_length")
        _meant(length, f"{where}.strip_length", STRIPS, "m")
        checks.choice(self.relaxed_at, f"{where}.relaxed_at", RELAXED)
        if self.tags is not None and not isinstance(self.tags, Mapping):
            raise ModelError(f"{where}.tags", f"must be a mapping, is {checks.shown(self.tags)}")
        object.__setattr__(self, "tags", dict(self.tags or {}))

    def _check_aerodynamic(self, where: str) -> None:
        """One number >= 0, or one for each mass of which the sum is: wind may press a mass down."""
        if not isinstance(self.aerodynamic, Sequence):
            whole = checks.non_negative(self.aerodynamic, where)
            _meant(whole, where, (0.0, MOST_AERODYNAMIC), "N s^2/m^2")
            return
        clean = checks.array(self.aerodynamic, where, (len(self.masses),))
        whole = checks.non_negative(float(clean.sum()), where)
        _meant(whole, where, (0.0, MOST_AERODYNAMIC), "N s^2/m^2")
        object.__setattr__(self, "aerodynamic", tuple(clean.tolist()))

    @property
    def aerodynamics(self) -> tuple[float, ...]:
        """k of the force k v^2 on each mass, N s^2/m^2."""
        if isinstance(self.aerodynamic, tuple):
            return self.aerodynamic
        return (self.aerodynamic, *(0.0 for _ in self.masses[1:]))

    @property
    def stages(self) -> list[Stage]:
        """What is below each mass."""
        friction, stops = self.friction or (0.0,) * len(self.masses), self.stops or (None,) * len(self.masses)
        rows = zip(self.stiffness, self.damping, friction, stops, strict=True)
        return [Stage(*row, self.stop_stiffness) for row in rows]

    def slopes(self, speed: float = 0.0) -> tuple[float, ...]:
        """Stiffness of each spring where it carries what it has to at rest, N/m; the lowest relaxed."""
        speed = checks.number(speed, "pantograph.slopes.speed")
        held = [
            0.0,
            *(stage.elongation(-self.carried(k + 1, speed)) for k, stage in enumerate(self.stages[1:])),
        ]
        return tuple(
            stage.slope(e) if stage.law is not None else stage.stiffness
            for stage, e in zip(self.stages, held, strict=True)
        )

    def force(self, speed: Any) -> Any:
        """Static and aerodynamic force at a speed in m/s, or at several, N."""
        return (
            self.static_force + sum(self.aerodynamics) * checks.floats(speed, "pantograph.force.speed") ** 2
        )

    def carried(self, k: int, speed: float) -> float:
        """Force in the spring below mass k > 0 at rest: what lifts the masses below it, N."""
        return self.static_force + sum(self.aerodynamics[:k]) * speed**2


def pantographs() -> dict[str, Pantograph]:
    """Pantographs of the catalogue by name."""
    text = files("ancf.catenary").joinpath("data/pantographs.toml").read_text(encoding="utf-8")
    entries = tomllib.loads(text)
    return {name: Pantograph(name=name, **entry) for name, entry in entries.items()}


def find_pantograph(given: Pantograph | str | Path) -> Pantograph:
    """A pantograph, that of the catalogue with this name, or one from a file.

    Raises
    ------
    ModelError
        There is none of this name, or the file is wrong.

    """
    if isinstance(given, Pantograph):
        return given
    known = pantographs()
    unlike: object = given
    if not isinstance(unlike, str | Path):
        what = f"must be a Pantograph, a name or a path, is {shown(unlike)}"
        raise ModelError("pantograph", what, f"there are: {', '.join(known)}")
    if isinstance(given, str) and given in known:
        return known[given]
    if Path(given).suffix == ".toml":
        return read_pantograph(given)
    what = f'there is no "{given}", there are: {", ".join(known)}'
    raise ModelError("pantograph", what, nearest(str(given), known) or "or a file, NAME.toml")


def read_pantograph(path: str | Path) -> Pantograph:
    """A pantograph from a file: TOML with the keys of :class:`Pantograph`, named after the file.

    Raises
    ------
    ModelError
        The file cannot be read, or something in it is wrong.

    """
    from ..lines.entries import PantographEntry

    path = checks.path(path, "read_pantograph.path")
    data = read_toml(path, "pantograph file")
    refuse(path, data, PANTOGRAPH)
    try:
        parameters.refuse_keys(data, PantographEntry.model_fields)
        with parameters.given(data, {}):
            entry = PantographEntry.model_validate(data)
    except ValidationError as error:
        problems = of_validation(error, lambda parts: PantographEntry)
        raise beside(combined(problems, str(path)), str(path)) from None
    name = entry.name or Path(path).stem
    for k, mass in enumerate(entry.masses):
        _meant(mass, f"{path}: masses[{k}]", MASSES, "kg")
    try:
        return Pantograph(**(entry.given("parameters") | {"name": name}))
    except ModelError as error:
        raise ModelError(
            f"{path}: {error.where.removeprefix(f'pantograph.{name}.')}", error.what, error.hint
        ) from None
