"""Line: an overhead line as its designer describes it; no numerics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks
from .auxiliary import Auxiliary, check_auxiliary
from .cant import LARGEST, plumb_above
from .conditions import COLDEST, HOTTEST, Conditions
from .excerpt import excerpt
from .fittings import NO_DROPPERS, DropperErrors, Droppers, Load, SteadyArm, Tensioner
from .line_parts import check_kinds, check_size
from .span import Span, of_supports, within
from .stitch import StitchWire
from .wire import Rayleigh, Wire

SUPPORTS = ("held", "free")
ANCHORS = ("fixed", "tension", "spring")
CLAMPS = ("hinged", "continuous")
HIGHEST = 100.0  # m, of wires; more is a slip of units
WIDEST = 20.0  # m, of staggers, those of anchors aside included
SPACINGS = (0.01, 0.5)  # m, of twin contact wires


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """An overhead line.

    x runs along the track from the first support, y to its left, z up from the nominal height of the contact
    wire. In a curve x follows the track. Both wires are anchored at the first and the last support.

    Parameters
    ----------
    spans : sequence of Span
    contact_wire : Wire
    messenger_wire : Wire
        None for a line without messenger and droppers, as trams have.
    droppers : Droppers
        Default none.
    steady_arm : SteadyArm, or one for each support
        At every support but the first and the last, where the wires are anchored.
    system_height : float or (supports,) m
        Height of the messenger over the contact wire at the supports.
    height : float or (supports,) m
        Height of the contact wire at the supports; straight from one to the next, less the pre-sag.
    damping : Rayleigh
        Of both wires.
    messenger_support : float, N/m
        Vertical stiffness of the messenger's supports; default rigid.
    messenger_clamp : "hinged" or "continuous"
        Whether the messenger turns freely in its supports, or bends over them; it then hangs some
        millimetres higher, its slope at the support times sqrt(EI/T).
    contact_spacing : float, m
        Of twin contact wires the distance across the track between both, each of which is a `contact_wire`
        with its own droppers and arms. Staggers are those of the middle. Default one wire.
    stagger : float or (supports,) m
        Sideways place of the contact wire at the supports; one number changes its sign at each support.
    messenger_stagger : float or (supports,) m
        The same of the messenger; default plumb above the contact wire.
    cant : float or (supports,) m
        Of the track at the supports, linear between them: how far the right rail is above the left one, at
        1.5 m between their middles, positive as in a curve to the left. y then lies across the canted track,
        z is normal to it, and staggers are those from the pantograph's axis.
    contact_support : "held" or "free"
        At rest the contact wire is held at z = 0 at the supports, or hangs there freely from the droppers
        beside it. In motion the steady arm acts about this place.
    stitch : StitchWire
        Default none.
    auxiliary : Auxiliary
        Of a compound catenary; default none.
    anchors : "fixed", "tension" or "spring"
        The wires' ends keep their places, or the forces at both ends keep their size, or springs pull there;
        the wires are then held along the track at the support nearest the middle.
    tensioner : Tensioner
        Stiffness of the springs, friction of the weights.
    messenger_support_mass : float, kg
        What moves with the messenger at a support: of the cantilever.
    loads : sequence of Load
        Masses on the wires.
    temperature : float, degrees Celsius
        At which heights, tensions and lengths of droppers hold.
    conditions : Conditions
        State in which the line is looked at. It is designed without them, and then comes to rest in them.
    dropper_lengths : (n,) m
        Unstretched lengths of the droppers as they were built, from clamp to clamp; default those of the
        design. With them the contact wire hangs at other heights than the design wants.
    dropper_errors : DropperErrors
        By which the lengths are off; default none.
    gravity : float, m/s^2
    rows : sequence of str
        Where each support stands in a table, for messages: "supports.csv, row 2, column ".
    title, source : str
    report : mapping of str to str
        "project", "author" and "customer", as they stand at the beginning of reports.
    tags : mapping of str to str
        How sure a value is, by its key.

    """

    spans: tuple[Span, ...]
    contact_wire: Wire
    steady_arm: Any
    messenger_wire: Wire | None = None
    droppers: Droppers = NO_DROPPERS
    contact_spacing: float | None = None
    system_height: Any = 0.0
    height: Any = 0.0
    damping: Rayleigh = field(default_factory=Rayleigh)
    messenger_support: float | None = None
    messenger_clamp: str = "hinged"
    stagger: Any = 0.0
    messenger_stagger: Any = None
    cant: Any = 0.0
    contact_support: str = "held"
    stitch: StitchWire | None = None
    auxiliary: Auxiliary | None = None
    anchors: str = "fixed"
    tensioner: Tensioner = field(default_factory=Tensioner)
    messenger_support_mass: float = 0.0
    loads: tuple[Load, ...] = ()
    temperature: float = 10.0
    conditions: Conditions = field(default_factory=Conditions)
    dropper_lengths: Any = None
    dropper_errors: DropperErrors | None = None
    gravity: float = 9.81
    rows: tuple[str, ...] = ()
    title: str = ""
    source: str = ""
    report: Mapping[str, str] = field(default_factory=dict, hash=False)
    tags: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check everything and spread single numbers over the supports."""
        check_kinds(self)
        if not self.spans:
            raise ModelError("line.spans", "has no span")
        check_size(len(self.spans), sum(len(span.droppers) for span in self.spans), "line.spans")
        self._check_parts()
        for k, height in enumerate(self._per_support("system_height", alternating=False)):
            if self.messenger_wire is not None:
                checks.positive(height, f"line.system_height[{k}]")
                within(height, HIGHEST, f"line.system_height[{k}]", "1.4")
        for key in ("height", "cant"):  # one number stays one, so that it fits another count of spans
            if isinstance(getattr(self, key), Sequence | np.ndarray):
                self._per_support(key, alternating=False)
        for k, height in enumerate(self.heights):
            within(height, HIGHEST, f"line.height[{k}]", "5.3")
        for key in ("stagger", "messenger_stagger"):
            if getattr(self, key) is not None:
                for k, side in enumerate(self._per_support(key, alternating=True)):
                    within(side, WIDEST, f"line.{key}[{k}]", "0.2")
        for k, cant in enumerate(self.cants):
            checks.between(cant, f"line.cant[{k}]", -LARGEST, LARGEST)
        if self.stitch is not None:
            self.stitch.check_in(self)
        check_auxiliary(self)
        self._check_lengths()
        if self.dropper_errors is not None:
            self.dropper_errors.check("line.dropper_errors")

    def _check_parts(self) -> None:
        arms = self.steady_arm
        if isinstance(arms, Sequence):
            if len(arms) != len(self.spans) + 1:
                what = f"are {len(arms)} for {len(self.spans) + 1} supports"
                raise ModelError("line.steady_arm", what, "give one, or one for each support")
            object.__setattr__(self, "steady_arm", tuple(arms))
            for k, arm in enumerate(arms):
                arm.check(f"line.steady_arm[{k}]")
        else:
            arms.check("line.steady_arm")
        for key in ("contact_wire", "droppers", "damping"):
            getattr(self, key).check(f"line.{key}")
        if self.messenger_wire is not None:
            self.messenger_wire.check("line.messenger_wire")
            if self.messenger_wire.rail:
                raise ModelError("line.messenger_wire.rail", "a messenger is no rail", "leave it out")
            if self.contact_wire.rail:
                what = "is given beside a conductor rail, which its supports carry"
                raise ModelError("line.messenger_wire", what, "leave it and the droppers out")
        for k, span in enumerate(self.spans):
            if span.droppers and (self.messenger_wire is None or self.droppers == NO_DROPPERS):
                missing = "messenger_wire" if self.messenger_wire is None else "droppers"
                hint = "a line without messenger has spans without droppers"
                raise ModelError(f"line.{missing}", f"is missing, span {k + 1} has droppers", hint)
        if self.contact_spacing is not None:
            checks.between(self.contact_spacing, "line.contact_spacing", *SPACINGS)
            if self.contact_wire.rail:
                raise ModelError("line.contact_spacing", "has no effect on a conductor rail", "leave it out")
        if self.messenger_support is not None:
            checks.positive(self.messenger_support, "line.messenger_support")
        checks.between(self.messenger_support_mass, "line.messenger_support_mass", 0.0, 1e4)
        checks.choice(self.contact_support, "line.contact_support", SUPPORTS)
        checks.choice(self.anchors, "line.anchors", ANCHORS)
        checks.choice(self.messenger_clamp, "line.messenger_clamp", CLAMPS)
        checks.positive(self.gravity, "line.gravity")
        checks.between(self.temperature, "line.temperature", COLDEST, HOTTEST)
        self.tensioner.check("line.tensioner", self.anchors)
        self.conditions.check("line.conditions", self.contact_wire, self.messenger_wire, self.anchors)
        self._check_wind()
        for k, load in enumerate(self.loads):
            load.check(f"line.loads[{k}]", self.length)
            if load.wire == "messenger" and self.messenger_wire is None:
                raise ModelError(f"line.loads[{k}].wire", "is the messenger, which the line has not")
            if load.wire == "auxiliary" and self.auxiliary is None:
                raise ModelError(f"line.loads[{k}].wire", "is the auxiliary, which the line has not")

    def _check_wind(self) -> None:
        wires = {"contact_wire": self.contact_wire, "messenger_wire": self.messenger_wire}
        wires["stitch"] = None if self.stitch is None else self.stitch.wire
        wires["auxiliary"] = None if self.auxiliary is None else self.auxiliary.wire
        for key, wire in wires.items():
            if self.conditions.wind and wire is not None and wire.diameter is None:
                raise ModelError(f"line.{key}.diameter", "is missing, wind needs it", "m, or a type")

    def _check_lengths(self) -> None:
        if self.dropper_lengths is None:
            return
        count = self.dropper_x.size
        lengths = checks.array(self.dropper_lengths, "line.dropper_lengths", (count,)).tolist()
        for j, length in enumerate(lengths):
            if not 0.0 < length < HIGHEST:
                where = f"line.dropper_lengths[{j}]"
                raise ModelError(where, f"is {length:g} m, of {self.dropper_label(j)}", "0 < length, in m")
        object.__setattr__(self, "dropper_lengths", tuple(lengths))

    def _per_support(self, key: str, alternating: bool) -> tuple[float, ...]:
        """Set a value to one number for each support."""
        value, count = getattr(self, key), len(self.spans) + 1
        if isinstance(value, list | tuple | np.ndarray):
            clean = of_supports(value, f"line.{key}", count)
        else:
            clean = np.full(count, checks.number(value, f"line.{key}"))
            if alternating:
                clean[1::2] *= -1.0
        numbers = tuple((clean + 0.0).tolist())
        object.__setattr__(self, key, numbers)
        return numbers

    @property
    def supports(self) -> FloatArray:
        """Track positions of the supports (spans + 1,), m."""
        return np.concatenate([[0.0], np.cumsum([span.length for span in self.spans])])

    @property
    def parts(self) -> tuple[Line, ...]:
        """The line itself; a route has several."""
        return (self,)

    @property
    def marks(self) -> FloatArray:
        """Track positions of the supports, m."""
        return self.supports

    @property
    def reach(self) -> tuple[FloatArray, FloatArray]:
        """From where to where a support counts as passed: the middles of the spans beside it, m."""
        middles = 0.5 * (self.supports[1:] + self.supports[:-1])
        return np.concatenate([[-np.inf], middles]), np.concatenate([middles, [np.inf]])

    @property
    def messenger_y(self) -> tuple[float, ...]:
        """Sideways places of the messenger at the supports (spans + 1,), m."""
        if self.messenger_stagger is not None:
            given: tuple[float, ...] = self.messenger_stagger
            return given
        return plumb_above(self, self.system_height)

    @property
    def length(self) -> float:
        """Length of the line, m."""
        return float(self.supports[-1])

    @property
    def begin(self) -> float:
        """Track position of the first support, m: 0; that of a route may be another."""
        return 0.0

    @property
    def end(self) -> float:
        """Track position of the last support, m."""
        return self.length

    @property
    def twin(self) -> bool:
        """Whether there are two contact wires side by side."""
        return self.contact_spacing is not None

    @property
    def contact_wires(self) -> int:
        """How many contact wires a strip touches on this line."""
        return 2 if self.twin else 1

    @property
    def dropper_x(self) -> FloatArray:
        """Track positions of all droppers (n,), m; of twin wires each place twice, the first wire's first."""
        starts = self.supports[:-1]
        places = [x0 + np.array(s.droppers) for x0, s in zip(starts, self.spans, strict=True)]
        return np.repeat(np.concatenate(places).astype(np.float64), self.contact_wires)

    @property
    def dropper_span(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """Index of the span of each dropper (n,)."""
        count = [self.contact_wires * len(s.droppers) for s in self.spans]
        return np.repeat(np.arange(len(self.spans)), count)

    @property
    def dropper_number(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """Index of each dropper in its span (n,)."""
        count = [np.arange(self.contact_wires * len(s.droppers)) for s in self.spans]
        return np.concatenate(count).astype(np.int64)

    @property
    def dropper_wire(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """Index of the contact wire that each dropper carries (n,): 0, or 1 for the second of twin wires."""
        return np.arange(self.dropper_x.size) % self.contact_wires

    @property
    def dropper_stitch(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """Index of the support from whose stitch wire a dropper hangs (n,), -1 from the messenger."""
        if self.stitch is None or len(self.spans) == 1:  # stitch wires hang at supports inside
            return np.full(self.dropper_x.size, -1)
        away = np.abs(self.dropper_x[:, None] - self.supports[1:-1])
        inside = away < self.stitch.reach - 1e-6
        return np.where(np.any(inside, axis=1), 1 + np.argmax(inside, axis=1), -1)

    @property
    def long_x(self) -> FloatArray:
        """Track positions of the droppers between messenger and auxiliary (m,), m."""
        if self.auxiliary is None:
            return np.zeros(0)
        rule = self.auxiliary.places
        given = [
            span.long_places(rule if span.long_droppers is None else span.long_droppers)
            for span in self.spans
        ]
        return np.concatenate([x0 + np.array(x) for x0, x in zip(self.supports[:-1], given, strict=True)])

    @property
    def dropper_height(self) -> FloatArray:
        """Prescribed heights of the contact wire at the droppers (n,), m, less the pre-sag."""
        sag = np.concatenate([np.array(s.pre_sag, dtype=np.float64) for s in self.spans])
        level: FloatArray = self.height_at(self.dropper_x) - np.repeat(sag, self.contact_wires)
        return level

    def height_at(self, track: Any) -> Any:
        """Nominal heights of the contact wire at track positions, m: straight between the supports."""
        return np.interp(checks.floats(track, "line.height_at.track"), self.supports, self.heights)

    @property
    def heights(self) -> tuple[float, ...]:
        """Heights of the contact wire at the supports (spans + 1,), m."""
        return self._at_supports("height")

    @property
    def cants(self) -> tuple[float, ...]:
        """Cants of the track at the supports (spans + 1,), m."""
        return self._at_supports("cant")

    def _at_supports(self, key: str) -> tuple[float, ...]:
        one = getattr(self, key)
        return one if isinstance(one, tuple) else (checks.number(one, f"line.{key}"),) * len(self.supports)

    def place_of_support(self, key: str, k: int) -> str:
        """Where a value of a support stands in its table, or in this line."""
        return f"{self.rows[k]}{key}" if k < len(self.rows) else f"line.{key}[{k}]"

    def arm(self, k: int) -> SteadyArm:
        """Steady arm of a support."""
        checks.integer(k, "line.arm.k", 0, len(self.spans))
        return self.steady_arm[k] if isinstance(self.steady_arm, tuple) else self.steady_arm  # type: ignore[no-any-return]

    def loads_on(self, wire: str) -> list[Load]:
        """Masses on "contact" or "messenger", in the order of the track."""
        return sorted((load for load in self.loads if load.wire == wire), key=lambda load: load.position)

    @property
    def wave_speed(self) -> float:
        """Wave speed of the contact wire, worn and iced, of a rail that of its longest span, m/s."""
        wire = self.conditions.worn(self.contact_wire)
        return wire.critical_speed(max(span.length for span in self.spans))

    def dropper_label(self, j: int) -> str:
        """Place of a dropper in the description: ``line.spans[2].droppers[3]``."""
        k = checks.integer(j, "line.dropper_label.j", 0, self.dropper_x.size - 1)
        span, number = int(self.dropper_span[k]), int(self.dropper_number[k])
        if span < len(self.rows) and ".csv" in self.rows[span]:
            return f"{self.rows[span].removesuffix('column ')}dropper {number + 1} of its span"
        return f"line.spans[{span}].droppers[{number // self.contact_wires}]"

    def excerpt(self, first: int, count: int) -> Line:
        """The line of `count` spans from span `first` on, anchored at its own ends."""
        return excerpt(self, first, count)  # type: ignore[no-any-return]
