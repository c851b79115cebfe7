"""From a form to the model of the whole line, which rests where the form says."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

import ancf

from ..arrays import BoolArray, FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.bodies.rigid import PointMass
from ..model.joints.connections import Spring
from ..model.points import Point
from ..model.supports.support import Hold, Pin
from .arms import LONG, add_arms, add_long_spring, add_mass
from .forms.along_track import add_sideways, add_wind, curve_pull
from .forms.form import Form
from .forms.route_form import AnyForm
from .forms.shape import Strung, on_track
from .lines.galloping import add_lift
from .lines.line import Line

#: More than any count.
FAR = 10**9
#: What makes the model of a line.
MADE = "ancf.catenary.assemble(form) makes one"


@dataclass(slots=True)
class Assembled:
    """The model of a line.

    Attributes
    ----------
    form : Form
    model : Model
    contact, messenger : Strung
        The wires; a messenger with hinges has one beam for each span, a line without messenger None.
    stitches : list of Strung
        At the supports but the first and the last, if the line has them.
    droppers : list of Spring or None
        In the order of ``line.dropper_x``; None for one that was broken.
    supports : list of Point
        The contact wire at the supports.
    arms, hangers : list of Spring or None
        Vertical spring or hinged arm of the contact wire, and spring of the messenger, at the supports.
    arm_holds, hanger_holds : list of Hold or None
        What holds contact wire and messenger sideways there.
    ends : (4, 2) of Pin, Spring or None
        What keeps the ends of contact wire, messenger, auxiliary and second contact wire, None for a force.
    twin : Strung or None
        The second of two contact wires side by side, with its arms at the supports and what holds it there:
    twin_arms : list of Spring or None
    twin_arm_holds : list of Hold or None
    auxiliary : Strung or None
        Of a compound catenary, with what holds it sideways at the supports and what carries it:
    auxiliary_holds : list of Hold or None
    long_droppers : list of Spring
        In the order of ``line.long_x``.
    parts : list of Assembled
        Of a route its tension lengths; `contact` and `messenger` are then those of the first one.
    prefix : str
        Before all names of a part.

    """

    form: AnyForm
    model: ancf.Model
    contact: Strung
    messenger: Strung | None
    stitches: list[Strung] = field(default_factory=list)
    droppers: list[Spring | None] = field(default_factory=list)
    supports: list[Point] = field(default_factory=list)
    arms: list[Spring | None] = field(default_factory=list)
    hangers: list[Spring | None] = field(default_factory=list)
    arm_holds: list[Hold | None] = field(default_factory=list)
    hanger_holds: list[Hold | None] = field(default_factory=list)
    ends: list[list[Pin | Spring | None]] = field(default_factory=lambda: [[None, None] for _ in range(4)])
    twin: Strung | None = None
    twin_arms: list[Spring | None] = field(default_factory=list)
    twin_arm_holds: list[Hold | None] = field(default_factory=list)
    auxiliary: Strung | None = None
    auxiliary_holds: list[Hold | None] = field(default_factory=list)
    long_droppers: list[Spring] = field(default_factory=list)
    parts: list[Assembled] = field(default_factory=list)
    prefix: str = ""

    @property
    def contact_wire(self) -> ancf.model.Beam:
        """The contact wire, one beam; of a route the first."""
        return self.contact.beams[0]

    @property
    def contact_wires(self) -> list[ancf.model.Beam]:
        """The contact wires of all tension lengths, of twin ones both."""
        return [wire.beams[0] for wire in self.strung_contacts]

    @property
    def strung_contacts(self) -> list[Strung]:
        """The contact wires of all tension lengths with their shapes."""
        pairs = [(part.contact, part.twin) for part in self.parts or [self]]
        return [wire for pair in pairs for wire in pair if wire is not None]

    @property
    def wires(self) -> tuple[Strung | None, ...]:
        """Contact wire, messenger, auxiliary and second contact wire, as the rows of ``form.pull``."""
        return self.contact, self.messenger, self.auxiliary, self.twin

    @property
    def messengers(self) -> list[Strung]:
        """The messengers of all tension lengths that have one."""
        return [p.messenger for p in self.parts or [self] if p.messenger is not None]

    def _part(self, track: float) -> Assembled:
        """The tension length whose contact wire is the lowest at a track position, m."""

        def height(part: Assembled) -> float:
            x, _, z = part.contact.shape.position.T
            return float(np.interp(track, x, z)) if x[0] <= track <= x[-1] else np.inf

        return min(self.parts, key=height) if self.parts else self

    def contact_at(self, track: float) -> Point:
        """Point of the contact wire that is at a track position at rest, of several the lowest."""
        track = on_track(track, [part.contact for part in self.parts or [self]], "contact_at")
        part = self._part(track)
        return part.contact_wire.at(part.contact.arc_at(track))

    def contacts_at(self, track: float) -> list[Point]:
        """The same of both of twin contact wires; of one wire its point alone."""
        track = on_track(track, [part.contact for part in self.parts or [self]], "contacts_at")
        part = self._part(track)
        wires = [wire for wire in (part.contact, part.twin) if wire is not None]
        return [wire.at(wire.arc_at(track)) for wire in wires]

    def messenger_at(self, track: float) -> Point:
        """Point of the messenger that is at a track position at rest, m."""
        track = on_track(track, [part.contact for part in self.parts or [self]], "messenger_at")
        messenger = self._part(track).messenger
        if messenger is None:
            raise ModelError("overhead.messenger", "the line has no messenger")
        return messenger.at(messenger.arc_at(track))

    def track_x(self, point: Point) -> float:
        """Track position of a point at rest, m."""
        return float(checks.kind(point, "overhead.track_x.point", Point).initial_position[0])

    def dropper(self, span: int, number: int) -> Spring | None:
        """A dropper, both counted from 1 as in the dropper schedule; None if it is broken."""
        return self.droppers[self._dropper_index(span, number)]

    def break_dropper(self, span: int, number: int) -> None:
        """Take a dropper away, both counted from 1; its halves stay at the clamps as masses.

        ``overhead.droppers`` then has None in its place, and runs record a force of 0 for it.

        Raises
        ------
        ModelError
            There is no such dropper, or it is broken already.

        """
        j = self._dropper_index(span, number)
        spring = self.droppers[j]
        if spring is None:
            raise ModelError(f"dropper {span}-{number}", "is broken already")
        self.model.connections.remove(spring)
        for wires in (self, *self.parts):
            wires.droppers = [None if dropper is spring else dropper for dropper in wires.droppers]

    def _dropper_index(self, span: int, number: int) -> int:
        line = self.form.line
        for key, value in (("span", span), ("number", number)):
            checks.integer(value, f"overhead.dropper.{key}", -FAR, FAR)
        found = np.flatnonzero((line.dropper_span == span - 1) & (line.dropper_number == number - 1))
        if not found.size:
            size = f"{len(line.spans)} spans"
            if 1 <= span <= len(line.spans):
                size = f"span {span} has {np.sum(line.dropper_span == span - 1)} droppers"
            raise ModelError("overhead.dropper", f"there is no dropper {number} in span {span}", f"{size}")
        return int(found[0])

    def add_mass(self, name: str, point: Point, mass: float) -> PointMass:
        """A mass in kg that moves with a point of a wire: a clamp, a section insulator."""
        given: object = point
        if not isinstance(given, Point):
            what = f"must be a point of a wire, is {checks.shown(given)}"
            raise ModelError(f"{name}.point", what, "overhead.contact_at(270.0)")
        body = self.model.add_point_mass(
            name, at=point.initial_position, mass=checks.positive(mass, f"{name}.mass")
        )
        self.model.connect(body, point)
        return body


def assembled(
    found: Form,
    held: BoolArray | None = None,
    mounting: bool = False,
    model: ancf.Model | None = None,
    prefix: str = "",
) -> Assembled:
    """The model of a form, or its part of a `model` with names that begin with `prefix`.

    Ends (4, 2) of the wires in the order of ``Assembled.wires`` that are `held` keep their places; default
    all of a line with fixed ends, and no others. While it is mounted, one end is pulled, or both, by what
    `found` has there.
    """
    line = found.line
    if held is None:
        held = np.full((4, 2), line.anchors == "fixed")
        if mounting:
            held[:, 1] = False
    own = model is None
    if model is None:
        model = ancf.Model(gravity=(0.0, 0.0, -line.gravity), title=line.title)
    contact = found.contact.add_to(model, f"{prefix}contact", line.damping)
    messenger = None
    if found.messenger is not None:
        messenger = found.messenger.add_to(model, f"{prefix}messenger", line.damping)
    overhead = Assembled(found, model, contact, messenger, prefix=prefix)
    if found.auxiliary is not None:
        overhead.auxiliary = found.auxiliary.add_to(model, f"{prefix}auxiliary", line.damping)
    if found.twin is not None:
        overhead.twin = found.twin.add_to(model, f"{prefix}second contact", line.damping)
    for k, wire in enumerate(overhead.wires):
        if wire is not None:
            sprung = line.anchors == "spring" and not mounting
            overhead.ends[k] = _anchor(overhead, line, wire, found.pull[k], held[k], sprung)
            _load(overhead, line, wire, ("contact", "messenger", "auxiliary", "contact")[k])
            if found.settled:
                add_lift(model, wire, line.conditions)
    _add_stitches(overhead, found)
    _add_auxiliary(overhead, found)
    _add_droppers(overhead, found)
    _add_messenger_supports(overhead, found)
    add_arms(overhead, found)
    if own and found.settled and line.conditions.wind != 0.0:
        add_wind(model, line.conditions, (line.begin, line.end))
    return overhead


def _load(overhead: Assembled, line: Line, wire: Strung, name: str) -> None:
    """The pull of curves, and masses that hang on the wire."""
    shape = wire.shape
    add_sideways(overhead.model, wire, curve_pull(line, shape, name))
    share = 1.0 / line.contact_wires if name == "contact" else 1.0
    on = f"on {'second ' if wire is overhead.twin else ''}{name}"
    for k, (load, node) in enumerate(zip(line.loads_on(name), shape.nodes.load.tolist(), strict=True)):
        add_mass(overhead.model, f"{overhead.prefix}load {k + 1} {on}", wire.point(node), share * load.mass)


def _anchor(
    overhead: Assembled, line: Line, wire: Strung, pull: FloatArray, held: BoolArray, sprung: bool
) -> list[Pin | Spring | None]:
    """Fix the ends, or pull them and hold the wire along the track at its middle support; what does it."""
    model = overhead.model
    holders: list[Pin | Spring | None] = []
    for point, sign, force, kept in zip(
        (wire.start, wire.end), (-1.0, 1.0), pull.tolist(), held, strict=True
    ):
        if kept:
            holders.append(model.pin(point))
            continue
        model.hold(point, position="yz")
        if not sprung:
            model.add_force(point, (sign * force, 0.0, 0.0))
            holders.append(None)
            continue
        stiffness = line.tensioner.stiffness
        assert stiffness is not None
        fixed = point.initial_position + sign * (LONG + force / stiffness) * np.eye(3)[0]
        name = f"tensioner at the {'start' if sign < 0 else 'end'} of {wire.beams[0].name}"
        holders.append(model.add_spring(point, fixed, stiffness=stiffness, length=LONG, name=name))
    if line.anchors != "fixed":
        node = wire.shape.nodes.support[middle_support(line)]
        model.hold(wire.point(node), position="x", name=f"middle anchor of {wire.beams[0].name}")
    return holders


def middle_support(line: Line) -> int:
    """Index of the support nearest the middle of the line, not an end; ModelError if there is none."""
    supports = line.supports
    if supports.size < 3:
        what = 'is "tension" on a line of one span, which nothing holds along the track'
        raise ModelError("line.anchors", what, 'give more spans or "fixed"')
    return 1 + int(np.argmin(np.abs(supports[1:-1] - 0.5 * supports[-1])))


def _add_stitches(overhead: Assembled, found: Form) -> None:
    messenger = overhead.messenger
    if messenger is None:
        return
    nodes = messenger.shape.nodes.stitch
    for k, shape in enumerate(found.stitches):
        wire = shape.add_to(overhead.model, f"{overhead.prefix}stitch wire {k + 2}", found.line.damping)
        overhead.model.connect(messenger.point(nodes[2 * k]), wire.start)
        overhead.model.connect(messenger.point(nodes[2 * k + 1]), wire.end)
        add_sideways(overhead.model, wire, curve_pull(found.line, shape, "stitch"))
        if found.settled:
            add_lift(overhead.model, wire, found.line.conditions)
        overhead.stitches.append(wire)


def _add_auxiliary(overhead: Assembled, found: Form) -> None:
    """What the auxiliary hangs from, and what holds it sideways."""
    wire, messenger, line, model = overhead.auxiliary, overhead.messenger, found.line, overhead.model
    overhead.auxiliary_holds = [None] * line.supports.size
    if wire is None or messenger is None or found.long_droppers is None or line.auxiliary is None:
        return
    given, made, before = line.auxiliary.droppers, found.long_droppers, overhead.prefix
    stiffness = made.spring_stiffness
    damping = given.damping * (stiffness / made.stiffness) ** 2
    half = 0.5 * given.mass * made.length
    pairs = zip(wire.shape.nodes.stitch.tolist(), messenger.shape.nodes.dropper.tolist(), strict=True)
    for j, (low, high) in enumerate(pairs):
        below, above, name = wire.point(low), messenger.point(high), f"{before}long dropper {j + 1}"
        overhead.long_droppers.append(
            model.add_spring(
                below,
                above,
                stiffness=float(stiffness[j]),
                damping=float(damping[j]),
                length=float(made.natural[j]),
                slack=given.slack,
                name=name,
            )
        )
        add_mass(model, f"{name} lower clamp", below, given.clamp_contact + half[j])
        add_mass(model, f"{name} upper clamp", above, given.clamp_messenger + half[j])
    for k in range(1, line.supports.size - 1):
        overhead.auxiliary_holds[k] = model.hold(wire.point(wire.shape.nodes.support[k]), position="y")


def _uppers(overhead: Assembled, found: Form) -> list[Point]:
    """Upper ends of all droppers."""
    if overhead.messenger is None:
        return []
    line = found.line
    if overhead.auxiliary is not None:
        return [overhead.auxiliary.point(node) for node in overhead.auxiliary.shape.nodes.dropper]
    points = [overhead.messenger.point(node) for node in overhead.messenger.shape.nodes.dropper]
    for k, wire in enumerate(overhead.stitches):
        hung = np.flatnonzero(line.dropper_stitch == k + 1)
        for j, node in zip(hung.tolist(), wire.shape.nodes.dropper, strict=True):
            points[j] = wire.point(node)
    return points


def _add_droppers(overhead: Assembled, found: Form) -> None:
    line, model = found.line, overhead.model
    lower, upper = found.contact.nodes.dropper, _uppers(overhead, found)
    wires = [wire for wire in (overhead.contact, overhead.twin) if wire is not None]
    half = 0.5 * line.droppers.mass * found.dropper_length
    stiffness, damping = found.spring_stiffness, found.spring_damping
    for j in range(line.dropper_x.size):
        label = f"{line.dropper_span[j] + 1}-{line.dropper_number[j] + 1}"
        before = overhead.prefix
        below, above = wires[line.dropper_wire[j]].point(lower[j]), upper[j]
        overhead.droppers.append(
            model.add_spring(
                below,
                above,
                stiffness=float(stiffness[j]),
                damping=float(damping[j]),
                length=float(found.dropper_natural[j]),
                slack=line.droppers.slack,
                name=f"{before}dropper {label}",
            )
        )
        add_mass(model, f"{before}lower clamp {label}", below, line.droppers.clamp_contact + half[j])
        add_mass(model, f"{before}upper clamp {label}", above, line.droppers.clamp_messenger + half[j])


def _add_messenger_supports(overhead: Assembled, found: Form) -> None:
    line, model = found.line, overhead.model
    overhead.hangers = [None] * line.supports.size
    overhead.hanger_holds = [None] * line.supports.size
    if overhead.messenger is None:
        return
    for k in range(1, line.supports.size - 1):
        point = overhead.messenger.point(overhead.messenger.shape.nodes.support[k])
        add_mass(model, f"{overhead.prefix}cantilever {k + 1} mass", point, line.messenger_support_mass)
        weight = line.messenger_support_mass * line.gravity
        if line.messenger_support is None:
            overhead.hanger_holds[k] = model.hold(point, position="yz")
            continue
        overhead.hanger_holds[k] = model.hold(point, position="y")
        overhead.hangers[k] = add_long_spring(
            model,
            point,
            2,
            line.messenger_support,
            found.support_load[k] + weight,
            f"{overhead.prefix}messenger support {k + 1}",
        )
