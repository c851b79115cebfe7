"""The pantographs in the model: chains of masses that travel under the contact wire."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from ..errors import ModelError
from ..model import checks
from ..model.beam import Beam
from ..model.bodies import PointMass
from ..model.contact import Contact
from ..model.joints import Slide
from ..model.model import Model
from .pantograph import Pantograph
from .travel import Travel

#: Nominal height of the wire at a track position, m.
Level = Callable[[float], Any]
CONTACTS = ("penalty", "joint")
#: Distance of the masses in the model, m; only their motion matters.
APART = 1.0
#: Contact stiffness of EN 50318, N/m.
STANDARD = 50e3
#: Mass of a strip on a spring of its own, kg: its vibration against the head is far above 20 Hz.
STRIP = 0.05
#: Distance of the strip from the wire up to which the sliding joint finds its place on it, m.
NEAR = 2.0
#: Stiffness of a lowest spring of 0, N/m: the place where a pantograph stands is then unique, and over
#: centimetres it carries some millinewtons.
FAINT = 0.1
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
    touches : list of Contact or Slide
        With each of the contact wires.
    meters : list of Contact
        Tell where the wires lie on the strip: the contacts themselves, or those of no weight beside joints.

    """

    name: str
    pantograph: Pantograph
    start: float
    head: PointMass
    touches: list[Contact | Slide]
    meters: list[Contact]

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
        return [self.head, *self.touches, *(self.meters if self.slides else [])]


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
) -> Collector:
    """Add a pantograph at the track position ``start`` with its strip at ``height``, where it comes to rest.

    ``raised`` is by how much its lowest spring is relaxed above the place that it gives, m.  An ``active``
    one has an input for a force on its lowest mass, see :func:`force_input`. ``level`` is the nominal height
    of the wire over the track where it is not 0 everywhere: the lowest spring stands on a guide that follows
    it, for a pantograph carries its weight at all heights, and its damper on the roof, which does not.
    """
    motion = _motion(travel)
    count, sprung = len(pantograph.masses), touch.kind == "joint" and touch.stiffness is not None
    top = height - APART if sprung else height
    masses = [
        model.add_point_mass(
            f"{label} mass {k + 1}", at=(start, 0.0, top - APART * (count - 1 - k)), mass=mass
        )
        for k, mass in enumerate(pantograph.masses)
    ]
    roof = model.add_point_mass(f"{label} roof", at=(start, 0.0, top - APART * count), mass=1.0)
    model.pin(roof, displacement=motion)
    for mass in masses:
        model.hold(mass, position="xy", displacement=motion)
        model.add_force(mass, (0.0, 0.0, mass.mass * -float(model.gravity[2])), name=f"{mass.name} balance")
    for mass in (roof, *masses):
        mass.set_motion(velocity=(float(travel.speed(0.0)), 0.0, 0.0))
    nominal = 0.0 if level is None else float(level(start))
    above = height - nominal if pantograph.relaxed_at == "nominal" else -raised
    guide = roof if level is None else _add_guide(model, roof, travel, level, start, label)
    _add_springs(model, pantograph, travel, [roof, *masses], above, label, guide)
    for k, mass in enumerate(masses):
        name = f"{label} lift" if k == 0 else f"{label} lift of mass {k + 1}"
        if k == 0 or pantograph.aerodynamics[k] != 0.0:
            model.add_force(mass, _lift(pantograph, travel, k), name=name)
    if active:
        actuator = model.add_input(force_input(label))
        model.add_force(masses[0], (0.0, 0.0, actuator), name=f"{label} actuator")
    head = masses[-1]
    if sprung:
        head = _add_strip(model, head, touch, motion, pantograph.force(float(travel.speed(0.0))), label)
    touches, meters = [], []
    for k, wire in enumerate(wires):
        number = "" if len(wires) == 1 else f" {k + 1}"
        touching, meter = _add_touch(model, wire, head, touch, label, number)
        touches.append(touching)
        meters.append(meter)
    return Collector(label, pantograph, start, head, touches, meters)


def _add_touch(
    model: Model, wire: Beam, head: PointMass, touch: Touch, label: str, number: str
) -> tuple[Contact | Slide, Contact]:
    """The contact of a head with one wire, and what measures it."""
    name = f"{label} contact{number}"
    if touch.kind == "penalty":
        assert touch.stiffness is not None
        contact: Contact = model.add_contact(
            head, wire, stiffness=touch.stiffness, damping=touch.damping, name=name
        )
        return contact, contact
    joint = model.slide(
        head, wire, release=(0, 1, 0), unilateral=(0, 0, 1), tolerance=NEAR, at_end="release", name=name
    )
    meter: Contact = model.add_contact(head, wire, stiffness=WEIGHTLESS, name=f"{label} meter{number}")
    return joint, meter


def force_input(label: str) -> str:
    """Name of the input of an active pantograph: "pantograph_force", "pantograph_2_force"."""
    return f"{label.replace(' ', '_')}_force"


def _motion(travel: Travel) -> Any:
    if travel.constant:
        return (f"{travel.top!r}*t", 0.0, 0.0)
    return lambda t: (float(travel.distance(t)), 0.0, 0.0)


def _add_guide(
    model: Model, roof: PointMass, travel: Travel, level: Level, start: float, label: str
) -> PointMass:
    """A place beside the roof that climbs with the wire."""
    guide = model.add_point_mass(f"{label} guide", at=roof.position, mass=1.0)
    first = float(level(start))

    def motion(t: float) -> tuple[float, float, float]:
        way = float(travel.distance(t))
        return way, 0.0, float(level(start + way)) - first

    model.pin(guide, displacement=motion)
    speed, short = float(travel.speed(0.0)), 1e-3
    climb = (float(level(start + short)) - float(level(start - short))) / (2.0 * short)
    guide.set_motion(velocity=(speed, 0.0, speed * climb))
    return guide


def _lift(pantograph: Pantograph, travel: Travel, k: int) -> Any:
    """Static and aerodynamic force on a mass, constant or over time."""
    first, drag = pantograph.static_force if k == 0 else 0.0, pantograph.aerodynamics[k]
    if travel.constant:
        return (0.0, 0.0, first + drag * travel.top**2)

    def force(t: float) -> Sequence[float]:
        return 0.0, 0.0, first + drag * float(travel.speed(t)) ** 2

    return force


def _add_springs(
    model: Model,
    pantograph: Pantograph,
    travel: Travel,
    masses: list[PointMass],
    above: float,
    label: str,
    guide: PointMass,
) -> None:
    """Springs and dampers, as short as the lift makes them.

    The lowest carries nothing when all is ``above`` lower than at the start; it stands on the guide.
    """
    for k, (stiffness, damping) in enumerate(zip(pantograph.stiffness, pantograph.damping, strict=True)):
        stiffness = max(stiffness, FAINT)
        shortened = -above if k == 0 else pantograph.carried(k, float(travel.speed(0.0))) / stiffness
        ends = masses[k], masses[k + 1]
        name = f"{label} spring {k + 1}"
        if k == 0 and guide is not masses[0]:
            if damping:
                model.add_spring(*ends, stiffness=0.0, damping=damping, name=f"{label} damper 1")
            ends, damping = (guide, masses[1]), 0.0
        model.add_spring(*ends, stiffness=stiffness, damping=damping, length=APART + shortened, name=name)


def _add_strip(
    model: Model, head: PointMass, touch: Touch, motion: Any, force: float, label: str
) -> PointMass:
    """A light strip above the head, on a spring with the stiffness of the contact."""
    assert touch.stiffness is not None
    x, y, z = head.position
    place = (x, y, z + APART - force / touch.stiffness)
    strip = model.add_point_mass(f"{label} strip", at=place, mass=STRIP)
    model.hold(strip, position="xy", displacement=motion)
    strip.set_motion(velocity=head.velocity)
    model.add_force(strip, (0.0, 0.0, STRIP * -float(model.gravity[2])), name=f"{strip.name} balance")
    model.add_spring(
        head,
        strip,
        stiffness=touch.stiffness,
        damping=touch.damping,
        length=APART,
        name=f"{label} strip spring",
    )
    return strip
