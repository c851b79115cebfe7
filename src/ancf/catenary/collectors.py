"""The pantographs in the model: chains of masses that travel under the contact wire."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import PointMass
from ..model.joints.basic import Slide
from ..model.model import Model
from ..model.surfaces.contact import Contact
from .chain import APART, Chain, Level, add_chain, add_stages, numbered
from .vehicles.pantograph import Pantograph
from .vehicles.roof import RoofMotion
from .vehicles.travel import Travel

CONTACTS = ("penalty", "joint")
#: Contact stiffness of EN 50318, N/m.
STANDARD = 50e3
#: Mass of a strip on a spring of its own, kg: its vibration against the head is far above 20 Hz.
STRIP = 0.05
#: Distance of the strip from the wire up to which the sliding joint finds its place on it, m.
NEAR = 2.0
#: Stiffness of a contact that only measures, N/m.
WEIGHTLESS = 1e-9


@dataclass(frozen=True)
class Touch:
    """How a strip touches the wire.

    Attributes
    ----------
    kind : "penalty" or "joint"
        A penalty, or the sliding joint, which is unilateral and free along the strip.
    stiffness : float or None
        Of the penalty, default that of the standards; of a spring between head and strip under a joint,
        default none: the joint is rigid. N/m.
    damping : float
        Beside this stiffness, N s/m.

    """

    kind: str = "penalty"
    stiffness: float | None = None
    damping: float = 0.0

    def __post_init__(self) -> None:
        checks.choice(self.kind, "run.contact", CONTACTS)
        if self.kind == "penalty" and self.stiffness is None:
            object.__setattr__(self, "stiffness", STANDARD)
        if self.stiffness is not None:
            checks.positive(self.stiffness, "run.contact_stiffness")
        checks.non_negative(self.damping, "run.contact_damping")
        if self.stiffness is None and self.damping:
            raise ModelError("run.contact_damping", "has no effect without contact_stiffness")

    def overlap(self, force: float) -> float:
        """By how much head and wire approach under a force, m."""
        return 0.0 if self.stiffness is None else force / self.stiffness


@dataclass(frozen=True)
class Collector:
    """One pantograph in the model.

    Attributes
    ----------
    heads : list of PointMass
        The strips, or what carries the strip: one, or two, the first ahead.
    touches : list of Contact or Slide
        Of each strip with each of the contact wires, strip after strip.
    meters : list of Contact
        Tell where the wires lie on the strips: the contacts themselves, or those of no weight beside joints.

    """

    name: str
    pantograph: Pantograph
    start: float
    heads: list[PointMass]
    touches: list[Contact | Slide]
    meters: list[Contact]

    @property
    def head(self) -> PointMass:
        """The strip, of two the one ahead."""
        return self.heads[0]

    @property
    def touch(self) -> Contact | Slide:
        """The contact with the first wire."""
        return self.touches[0]

    @property
    def meter(self) -> Contact:
        """What measures it."""
        return self.meters[0]

    @property
    def slides(self) -> bool:
        """Whether sliding joints take the force."""
        return self.touch is not self.meter

    def sensors(self) -> list[Any]:
        """What is recorded at every step."""
        return [*self.heads, *self.touches, *(self.meters if self.slides else [])]


def put_pantograph(
    model: Model,
    wires: list[Beam],
    pantograph: Pantograph,
    travel: Travel,
    *,
    label: str,
    start: float,
    height: float,
    raised: float,
    touch: Touch,
    active: bool = False,
    level: Level | None = None,
    roof: RoofMotion | None = None,
    profiles: list[FloatArray] | None = None,
) -> Collector:
    """Add a pantograph at the track position ``start`` with its strip at ``height``, where it comes to rest.

    ``raised`` is by how much its lowest spring is relaxed above the place that it gives, m.  An ``active``
    one has an input for a force on its lowest mass, see :func:`force_input`. ``level`` is the nominal height
    of the wire over the track where it is not 0 everywhere: the lowest spring stands on a guide that follows
    it, for a pantograph carries its weight at all heights, and its damper on the roof, which does not.
    ``roof`` moves the vehicle; ``profiles`` are those of the wires' undersides, one for each wire.
    """
    nominal = 0.0 if level is None else float(level(start))
    above = height - nominal if pantograph.relaxed_at == "nominal" else -raised
    sprung = touch.kind == "joint" and touch.stiffness is not None
    chain = add_chain(model, pantograph, travel, start, height - APART if sprung else height, label, roof)
    add_stages(model, chain, above, level, label)
    if active:
        actuator = model.add_input(force_input(label))
        lowest = chain.masses[:1] or chain.heads
        for mass, number in numbered(lowest):
            push = actuator if len(lowest) == 1 else actuator / len(lowest)
            model.add_force(mass, (0.0, 0.0, push), name=f"{label} actuator{number}")
    heads = chain.heads
    if sprung:
        share = pantograph.force(float(travel.speed(0.0))) / len(heads)
        heads = [
            _add_strip(model, head, touch, chain, share, f"{label} strip{n}") for head, n in numbered(heads)
        ]
    touches, meters = [], []
    for head, strip in numbered(heads):
        for k, (wire, number) in enumerate(numbered(wires)):
            profile = None if profiles is None else profiles[k]
            names = tuple(
                f"{label} {what}{' ahead' if strip == ' 1' else ' behind' if strip else ''}{number}"
                for what in ("contact", "meter")
            )
            touching, meter = _add_touch(model, wire, head, touch, names, profile)
            touches.append(touching)
            meters.append(meter)
    return Collector(label, pantograph, start, heads, touches, meters)


def _add_touch(
    model: Model,
    wire: Beam,
    head: PointMass,
    touch: Touch,
    names: tuple[str, ...],
    profile: FloatArray | None,
) -> tuple[Contact | Slide, Contact]:
    """The contact of a head with one wire, and what measures it."""
    name, of_meter = names
    if touch.kind == "penalty":
        assert touch.stiffness is not None
        contact: Contact = model.add_contact(
            head, wire, stiffness=touch.stiffness, damping=touch.damping, profile=profile, name=name
        )
        return contact, contact
    joint = model.slide(
        head, wire, release=(0, 1, 0), unilateral=(0, 0, 1), tolerance=NEAR, at_end="release", name=name
    )
    meter: Contact = model.add_contact(head, wire, stiffness=WEIGHTLESS, name=of_meter)
    return joint, meter


def force_input(label: str) -> str:
    """Name of the input of an active pantograph: "pantograph_force", "pantograph_2_force"."""
    return f"{label.replace(' ', '_')}_force"


def _add_strip(
    model: Model, head: PointMass, touch: Touch, chain: Chain, force: float, name: str
) -> PointMass:
    """A light strip above the head, on a spring with the stiffness of the contact."""
    assert touch.stiffness is not None
    x, y, z = head.position
    strip = model.add_point_mass(name, at=(x, y, z + APART - force / touch.stiffness), mass=STRIP)
    chain.hold(model, strip)
    model.add_force(strip, (0.0, 0.0, STRIP * -float(model.gravity[2])), name=f"{strip.name} balance")
    model.add_spring(
        head, strip, stiffness=touch.stiffness, damping=touch.damping, length=APART, name=f"{name} spring"
    )
    return strip
