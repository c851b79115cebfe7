"""What joins the wires to each other and to the masts: droppers and steady arms."""

from __future__ import annotations

from dataclasses import dataclass

from ...arrays import FloatArray
from ...errors import ModelError
from ...model import checks

STEEPEST = 0.7  # rad, of a steady arm
#: Of a hinged arm: lengths in m, stiffnesses along itself in N/m; heights of uplift stops in m.
LENGTHS, STIFFNESSES, UPLIFTS = (0.05, 20.0), (1e4, 1e12), (1e-3, 10.0)
FAINT = 1.0  # N, of forces on arms that are taken for none
MOST_SEED = 2**32 - 1


def hangs(force: FloatArray) -> bool:
    """Whether a hinged arm hangs down that gives this force (3,) to a wire and to half of its weight, N."""
    return bool(abs(force[1]) < FAINT or abs(force[2]) > abs(force[1]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Tensioner:
    """What pulls the ends of the wires, besides weights without friction.

    Parameters
    ----------
    stiffness : float, N/m
        Of the spring at each end, for ``anchors = "spring"``.
    friction : float
        Share of the tension that wheels and pulleys keep, with ``anchors = "tension"``: an end moves when the
        tension is this share above or below that of the weights. It decides about states at rest; in motion
        the force at an end is what it is at rest.

    """

    stiffness: float | None = None
    friction: float = 0.0

    def check(self, where: str, anchors: str) -> None:
        """Raise ModelError if a value is out of range or does not belong to these anchors."""
        if (self.stiffness is not None) != (anchors == "spring"):
            what = "is missing" if self.stiffness is None else f'has no effect with anchors = "{anchors}"'
            raise ModelError(f"{where}.stiffness", what, "of the spring at each end, N/m")
        if self.stiffness is not None:
            checks.positive(self.stiffness, f"{where}.stiffness")
        if checks.between(self.friction, f"{where}.friction", 0.0, 0.5) and anchors != "tension":
            raise ModelError(f"{where}.friction", f'has no effect with anchors = "{anchors}"', "leave it out")


@dataclass(frozen=True, slots=True, kw_only=True)
class DropperErrors:
    """Random errors of the droppers' lengths, normally distributed.

    Parameters
    ----------
    deviation : float, m
        Standard deviation of each length.
    seed : int
        The same gives the same errors. Tension lengths of a route differ.
    before, section : int
        Of a part of a line how many droppers are before it, and of which section of a route it is, from 0:
        an excerpt has the errors that its droppers have in the line.

    """

    deviation: float
    seed: int = 1
    before: int = 0
    section: int = 0

    def check(self, where: str) -> None:
        """Raise ModelError if a value is out of range."""
        checks.non_negative(self.deviation, f"{where}.deviation")
        checks.integer(self.seed, f"{where}.seed", 0, MOST_SEED)
        for key in ("before", "section"):
            checks.integer(getattr(self, key), f"{where}.{key}", 0, MOST_SEED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Load:
    """A mass on a wire: a section insulator, a clamp of a feeder.

    Parameters
    ----------
    position : float, m
        Along the track from the first support.
    mass : float, kg
    wire : "contact", "messenger" or "auxiliary"

    """

    position: float
    mass: float
    wire: str = "contact"

    def check(self, where: str, length: float) -> None:
        """Raise ModelError if it is off the line."""
        if not 0.0 < checks.number(self.position, f"{where}.position") < length:
            what = f"is {self.position:g} m, the line reaches from 0 to {length:g} m"
            raise ModelError(f"{where}.position", what)
        checks.positive(self.mass, f"{where}.mass")
        checks.choice(self.wire, f"{where}.wire", ("contact", "messenger", "auxiliary"))


@dataclass(frozen=True, slots=True, kw_only=True)
class Droppers:
    """The droppers of a line, all alike but for their lengths.

    Parameters
    ----------
    stiffness : float, N/m
        Of each dropper whatever its length; give this or EA.
    EA : float, N
        Axial stiffness; the stiffness is EA over the unstretched length.
    mass : float, kg/m
        Mass per length; half of a dropper's mass stands at each end.
    damping : float, N s/m
    slack : bool
        They carry tension only.
    clamp_contact, clamp_messenger : float, kg
        Clamp on each wire.

    """

    stiffness: float | None = None
    EA: float | None = None
    mass: float = 0.0
    damping: float = 0.0
    slack: bool = True
    clamp_contact: float = 0.0
    clamp_messenger: float = 0.0

    def check(self, where: str) -> None:
        """Raise ModelError if a value is out of range."""
        if (self.stiffness is None) == (self.EA is None):
            what = "is missing: give stiffness or EA" if self.EA is None else "give stiffness or EA, not both"
            raise ModelError(f"{where}.stiffness", what)
        for key in ("stiffness", "EA"):
            if getattr(self, key) is not None:
                checks.positive(getattr(self, key), f"{where}.{key}")
        for key in ("mass", "damping", "clamp_contact", "clamp_messenger"):
            checks.non_negative(getattr(self, key), f"{where}.{key}")
        checks.flag(self.slack, f"{where}.slack")


#: Of a line that has none: the number is never used.
NO_DROPPERS = Droppers(stiffness=1.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class SteadyArm:
    """What holds the contact wire sideways at a support: springs, or a hinged arm.

    Parameters
    ----------
    vertical : float, N/m
        Vertical stiffness about the place at rest; 0 for none. Give this or `length`.
    lateral : float, N/m
        Sideways stiffness about the place at rest; default held.
    length : float, m
        Of an arm hinged to the mast, which pulls the wire sideways and stiffens it by its inclination.
    mass : float, kg
        Of the arm or of the spring's moving part; half of it moves with the wire.
    stiffness : float, N/m
        Of a hinged arm along itself.
    angle : float, rad
        Of a hinged arm at rest: how far it rises from the wire to its hinge. It then carries the tangent of
        this angle of its pull, where the wire hangs free otherwise. Default as its own weight makes it.
    uplift_stop : float, m
        Height above rest at which a stop meets the wire; default none.
    side : "left" or "right"
        Of the wire on which its hinge is. It can then only pull to this side, unless it can push. Default
        where it has to pull to.
    push : bool
        It can push too, as a strut: it pushes where curve and stagger draw the wire away from its side.

    """

    vertical: float | None = None
    lateral: float | None = None
    length: float | None = None
    mass: float = 0.0
    stiffness: float = 1e6
    angle: float | None = None
    uplift_stop: float | None = None
    side: str | None = None
    push: bool = False

    def sense(self, sideways: float) -> float:
        """1 if it pulls where it has to give the wire a force to the left, N, -1 if it pushes."""
        if self.side is None or abs(sideways) < FAINT:
            return 1.0
        return 1.0 if (sideways > 0.0) == (self.side == "left") else -1.0

    def stands(self, sideways: float) -> str:
        """The side of the wire on which its hinge is where it has to give this force to the left, N."""
        return self.side or ("left" if sideways > 0.0 else "right")

    def refuses(self, sideways: float) -> bool:
        """Whether it would be pushed, which it cannot stand."""
        return not self.push and self.sense(sideways) < 0.0

    @property
    def hinged(self) -> bool:
        """Whether it is a hinged arm."""
        return self.length is not None

    def check(self, where: str) -> None:
        """Raise ModelError if a value is out of range, or the two kinds are mixed."""
        if (self.vertical is None) == (self.length is None):
            missing = self.vertical is None
            what = "is missing: give vertical or length" if missing else "give vertical or length, not both"
            raise ModelError(f"{where}.vertical", what)
        if self.vertical is not None:
            checks.non_negative(self.vertical, f"{where}.vertical")
        if self.length is not None:
            checks.between(self.length, f"{where}.length", *LENGTHS)
        if self.lateral is not None:
            if checks.positive(self.lateral, f"{where}.lateral") > STIFFNESSES[1]:
                raise ModelError(f"{where}.lateral", f"is {self.lateral:g} N/m", "leave it out: it is held")
            if self.hinged:
                raise ModelError(f"{where}.lateral", "has no effect on a hinged arm", "leave it out")
        checks.non_negative(self.mass, f"{where}.mass")
        checks.between(self.stiffness, f"{where}.stiffness", *STIFFNESSES)
        if self.side is not None:
            checks.choice(self.side, f"{where}.side", ("left", "right"))
        if checks.flag(self.push, f"{where}.push") and self.side is None:
            what = "has no effect without side"
            raise ModelError(f"{where}.push", what, 'an arm that pushes stands at a side, "left" or "right"')
        if self.uplift_stop is not None:
            checks.between(self.uplift_stop, f"{where}.uplift_stop", *UPLIFTS)
        if self.angle is not None:
            if not self.hinged:
                raise ModelError(f"{where}.angle", "has no effect without length", "leave it out")
            if abs(checks.number(self.angle, f"{where}.angle")) > STEEPEST:
                raise ModelError(f"{where}.angle", f"is {self.angle:g}", f"rad, at most {STEEPEST:g}")
