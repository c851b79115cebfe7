"""Line: an overhead line as its designer describes it; no numerics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from .fittings import Droppers, SteadyArm
from .span import Span
from .stitch import StitchWire
from .wire import Rayleigh, Wire

SUPPORTS = ("held", "free")
ANCHORS = ("fixed", "tension")
CLAMPS = ("hinged", "continuous")
#: A line of some 600 km; more is a slip that would take all memory.
MOST_SPANS, MOST_DROPPERS = 10_000, 200_000


def check_size(spans: int, droppers: int, where: str) -> None:
    """Raise ModelError if a line has more spans or droppers than can be meant."""
    for count, most, what in ((spans, MOST_SPANS, "spans"), (droppers, MOST_DROPPERS, "droppers")):
        if count > most:
            raise ModelError(where, f"are {count} {what} in all, at most {most} can be")


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """An overhead line on a straight track.

    x runs along the track from the first support, y sideways, z up from the nominal height of the contact
    wire. Both wires are anchored at the first and the last support.

    Parameters
    ----------
    spans : sequence of Span
    contact_wire, messenger_wire : Wire
    droppers : Droppers
    steady_arm : SteadyArm
        At every support but the first and the last, where the wires are anchored.
    system_height : float or (supports,) m
        Height of the messenger over the nominal height of the contact wire at the supports.
    damping : Rayleigh
        Of both wires.
    messenger_support : float, N/m
        Vertical stiffness of the messenger's supports; default rigid.
    messenger_clamp : "hinged" or "continuous"
        Whether the messenger turns freely in its supports, or bends over them; it then hangs some
        millimetres higher, its slope at the support times sqrt(EI/T).
    stagger : float or (supports,) m
        Sideways place of the contact wire at the supports; one number changes its sign at each support.
    messenger_stagger : float or (supports,) m
        The same of the messenger; default that of the contact wire.
    contact_support : "held" or "free"
        At rest the contact wire is held at z = 0 at the supports, or hangs there freely from the droppers
        beside it. In motion the steady arm acts about this place.
    stitch : StitchWire
        Default none.
    anchors : "fixed" or "tension"
        The wires' ends keep their places, or the forces at both ends keep their size; the wires are then
        held along the track at the support nearest the middle.
    gravity : float, m/s^2
    title, source : str
    tags : mapping of str to str
        How sure a value is, by its key.

    """

    spans: tuple[Span, ...]
    contact_wire: Wire
    messenger_wire: Wire
    droppers: Droppers
    steady_arm: SteadyArm
    system_height: Any
    damping: Rayleigh = field(default_factory=Rayleigh)
    messenger_support: float | None = None
    messenger_clamp: str = "hinged"
    stagger: Any = 0.0
    messenger_stagger: Any = None
    contact_support: str = "held"
    stitch: StitchWire | None = None
    anchors: str = "fixed"
    gravity: float = 9.81
    title: str = ""
    source: str = ""
    tags: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check everything and spread single numbers over the supports."""
        object.__setattr__(self, "spans", tuple(self.spans))
        if not self.spans:
            raise ModelError("line.spans", "has no span")
        check_size(len(self.spans), sum(len(span.droppers) for span in self.spans), "line.spans")
        for key in ("contact_wire", "messenger_wire", "droppers", "steady_arm", "damping"):
            getattr(self, key).check(f"line.{key}")
        if self.messenger_support is not None:
            checks.positive(self.messenger_support, "line.messenger_support")
        checks.choice(self.contact_support, "line.contact_support", SUPPORTS)
        checks.choice(self.anchors, "line.anchors", ANCHORS)
        checks.choice(self.messenger_clamp, "line.messenger_clamp", CLAMPS)
        checks.positive(self.gravity, "line.gravity")
        heights = self._per_support("system_height", alternating=False)
        for k, height in enumerate(heights):
            checks.positive(height, f"line.system_height[{k}]")
        self._per_support("stagger", alternating=True)
        if self.messenger_stagger is not None:
            self._per_support("messenger_stagger", alternating=True)
        if self.stitch is not None:
            self._check_stitch(self.stitch)

    def _check_stitch(self, stitch: StitchWire) -> None:
        stitch.check("line.stitch")
        if stitch.wire.tension >= self.messenger_wire.tension:
            what = f"is {stitch.wire.tension:g} N, the messenger has {self.messenger_wire.tension:g} N only"
            raise ModelError("line.stitch.tension", what)
        shortest = min(span.length for span in self.spans)
        if stitch.reach >= 0.5 * shortest:
            what = f"is {stitch.reach:g} m, must be less than half of the shortest span, {shortest:g} m"
            raise ModelError("line.stitch.reach", what)

    def _per_support(self, key: str, alternating: bool) -> tuple[float, ...]:
        """Set a value to one number for each support."""
        value, count = getattr(self, key), len(self.spans) + 1
        if isinstance(value, list | tuple | np.ndarray):
            clean = checks.array(value, f"line.{key}", (count,))
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
    def messenger_y(self) -> tuple[float, ...]:
        """Sideways places of the messenger at the supports (spans + 1,), m."""
        places: tuple[float, ...] = self.stagger if self.messenger_stagger is None else self.messenger_stagger
        return places

    @property
    def length(self) -> float:
        """Length of the line, m."""
        return float(self.supports[-1])

    @property
    def dropper_x(self) -> FloatArray:
        """Track positions of all droppers (n,), m."""
        starts = self.supports[:-1]
        return np.concatenate([x0 + np.array(s.droppers) for x0, s in zip(starts, self.spans, strict=True)])

    @property
    def dropper_span(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """Index of the span of each dropper (n,)."""
        return np.repeat(np.arange(len(self.spans)), [len(s.droppers) for s in self.spans])

    @property
    def dropper_number(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """Index of each dropper in its span (n,)."""
        return np.concatenate([np.arange(len(s.droppers)) for s in self.spans])

    @property
    def dropper_stitch(self) -> np.ndarray[Any, np.dtype[np.int64]]:
        """Index of the support from whose stitch wire a dropper hangs (n,), -1 from the messenger."""
        if self.stitch is None or len(self.spans) == 1:  # stitch wires hang at supports inside
            return np.full(self.dropper_x.size, -1)
        away = np.abs(self.dropper_x[:, None] - self.supports[1:-1])
        inside = away < self.stitch.reach - 1e-6
        return np.where(np.any(inside, axis=1), 1 + np.argmax(inside, axis=1), -1)

    @property
    def dropper_height(self) -> FloatArray:
        """Prescribed heights of the contact wire at the droppers (n,), m: minus the pre-sag."""
        return -np.concatenate([np.array(s.pre_sag) for s in self.spans])

    @property
    def wave_speed(self) -> float:
        """Wave speed of the contact wire, m/s."""
        return self.contact_wire.wave_speed

    def dropper_label(self, j: int) -> str:
        """Place of a dropper in the description: ``line.spans[2].droppers[3]``."""
        return f"line.spans[{self.dropper_span[j]}].droppers[{self.dropper_number[j]}]"

    def excerpt(self, first: int, count: int) -> Line:
        """The line of `count` spans from span `first` on, anchored at its own ends."""
        supports = slice(first, first + count + 1)
        keys = ["system_height", "stagger"] + (
            [] if self.messenger_stagger is None else ["messenger_stagger"]
        )
        cut = {key: getattr(self, key)[supports] for key in keys}
        return replace(self, spans=self.spans[first : first + count], **cut)
