"""From a form to the model of the whole line, which rests where the form says."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

import ancf

from ..arrays import FloatArray
from ..errors import ModelError
from ..model import checks
from ..model.bodies import PointMass
from ..model.connections import Spring
from ..model.points import Point
from .form import Form, form
from .mesh import Mesh
from .shape import Strung

#: Length of a spring to a fixed point, m: long enough that its force keeps its direction, and unstretched.
LONG = 20.0


@dataclass(slots=True)
class Assembled:
    """The model of a line.

    Attributes
    ----------
    form : Form
    model : Model
    contact, messenger : Strung
        The wires; a messenger with hinges has one beam for each span.
    stitches : list of Strung
        At the supports but the first and the last, if the line has them.
    droppers : list of Spring or None
        In the order of ``line.dropper_x``; None for one that was broken.
    supports : list of Point
        The contact wire at the supports.
    arms, hangers : list of Spring or None
        Vertical spring or hinged arm of the contact wire, and spring of the messenger, at the supports.

    """

    form: Form
    model: ancf.Model
    contact: Strung
    messenger: Strung
    stitches: list[Strung] = field(default_factory=list)
    droppers: list[Spring | None] = field(default_factory=list)
    supports: list[Point] = field(default_factory=list)
    arms: list[Spring | None] = field(default_factory=list)
    hangers: list[Spring | None] = field(default_factory=list)

    @property
    def contact_wire(self) -> ancf.model.Beam:
        """The contact wire, one beam."""
        return self.contact.beams[0]

    def contact_at(self, track: float) -> Point:
        """Point of the contact wire that is at a track position at rest, m."""
        return self.contact_wire.at(self.contact.arc_at(track))

    def messenger_at(self, track: float) -> Point:
        """Point of the messenger that is at a track position at rest, m."""
        return self.messenger.at(self.messenger.arc_at(track))

    def track_x(self, point: Point) -> float:
        """Track position of a point at rest, m."""
        return float(point.initial_position[0])

    def dropper(self, span: int, number: int) -> Spring | None:
        """A dropper, both counted from 1 as in the dropper schedule; None if it is broken."""
        return self.droppers[self._dropper_index(span, number)]

    def break_dropper(self, span: int, number: int) -> None:
        """Take a dropper away, both counted from 1; its halves stay at the clamps as masses.

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
        self.droppers[j] = None

    def _dropper_index(self, span: int, number: int) -> int:
        line = self.form.line
        found = np.flatnonzero((line.dropper_span == span - 1) & (line.dropper_number == number - 1))
        if not found.size:
            size = f"{len(line.spans)} spans"
            if 1 <= span <= len(line.spans):
                size = f"span {span} has {len(line.spans[span - 1].droppers)} droppers"
            raise ModelError("overhead.dropper", f"there is no dropper {number} in span {span}", f"{size}")
        return int(found[0])

    def add_mass(self, name: str, point: Point, mass: float) -> PointMass:
        """A mass in kg that moves with a point of a wire: a clamp, a section insulator."""
        body = self.model.add_point_mass(
            name, at=point.initial_position, mass=checks.positive(mass, f"{name}.mass")
        )
        self.model.connect(body, point)
        return body


def assemble(found: Form, mesh: Mesh | None = None) -> Assembled:
    """Make the model of a line.

    Parameters
    ----------
    found : Form
    mesh : Mesh
        Default that of the form; on another one the form is found again, for each mesh has its own
        lengths of droppers that bring the wires to their heights exactly.

    """
    if mesh is not None and mesh != found.mesh:
        found = form(found.line, mesh)
    line = found.line
    model = ancf.Model(gravity=(0.0, 0.0, -line.gravity), title=line.title)
    contact = found.contact.add_to(model, "contact", line.damping)
    messenger = found.messenger.add_to(model, "messenger", line.damping)
    overhead = Assembled(found, model, contact, messenger)
    for wire in (contact, messenger):
        _anchor(overhead, wire)
    _add_stitches(overhead)
    _add_droppers(overhead)
    _add_messenger_supports(overhead)
    _add_arms(overhead)
    return overhead


def _anchor(overhead: Assembled, wire: Strung) -> None:
    """Fix both ends; or pull them, and hold the wire along the track at its middle support."""
    model, line = overhead.model, overhead.form.line
    if line.anchors == "fixed":
        model.pin(wire.start)
        model.pin(wire.end)
        return
    for point, sign in ((wire.start, -1.0), (wire.end, 1.0)):
        model.hold(point, position="yz")
        model.add_force(point, (sign * wire.shape.wire.tension, 0.0, 0.0))
    node = wire.shape.nodes.support[middle_support(overhead.form)]
    model.hold(wire.point(node), position="x", name=f"middle anchor of {wire.beams[0].name}")


def middle_support(found: Form) -> int:
    """Index of the support nearest the middle of the line, not an end; ModelError if there is none."""
    supports = found.line.supports
    if supports.size < 3:
        what = 'is "tension" on a line of one span, which nothing holds along the track'
        raise ModelError("line.anchors", what, 'give more spans or "fixed"')
    return 1 + int(np.argmin(np.abs(supports[1:-1] - 0.5 * supports[-1])))


def _add_stitches(overhead: Assembled) -> None:
    found, nodes = overhead.form, overhead.messenger.shape.nodes.stitch
    for k, shape in enumerate(found.stitches):
        wire = shape.add_to(overhead.model, f"stitch wire {k + 2}", found.line.damping)
        overhead.model.connect(overhead.messenger.point(nodes[2 * k]), wire.start)
        overhead.model.connect(overhead.messenger.point(nodes[2 * k + 1]), wire.end)
        overhead.stitches.append(wire)


def _uppers(overhead: Assembled) -> list[Point]:
    """Upper ends of all droppers."""
    line = overhead.form.line
    points = [overhead.messenger.point(node) for node in overhead.form.messenger.nodes.dropper]
    for k, wire in enumerate(overhead.stitches):
        hung = np.flatnonzero(line.dropper_stitch == k + 1)
        for j, node in zip(hung.tolist(), wire.shape.nodes.dropper, strict=True):
            points[j] = wire.point(node)
    return points


def _add_droppers(overhead: Assembled) -> None:
    found, line, model = overhead.form, overhead.form.line, overhead.model
    lower, upper = found.contact.nodes.dropper, _uppers(overhead)
    half = 0.5 * line.droppers.mass * found.dropper_length
    stiffness, damping = found.spring_stiffness, found.spring_damping
    for j in range(line.dropper_x.size):
        label = f"{line.dropper_span[j] + 1}-{line.dropper_number[j] + 1}"
        below, above = overhead.contact.point(lower[j]), upper[j]
        overhead.droppers.append(
            model.add_spring(
                below,
                above,
                stiffness=float(stiffness[j]),
                damping=float(damping[j]),
                length=float(found.dropper_natural[j]),
                slack=line.droppers.slack,
                name=f"dropper {label}",
            )
        )
        _add_mass(model, f"lower clamp {label}", below, line.droppers.clamp_contact + half[j])
        _add_mass(model, f"upper clamp {label}", above, line.droppers.clamp_messenger + half[j])


def _add_mass(model: ancf.Model, name: str, point: Point, mass: float) -> PointMass | None:
    """A mass that moves with a node of a wire; nothing if it is zero."""
    if mass == 0.0:
        return None
    body = model.add_point_mass(name, at=point.initial_position, mass=float(mass))
    model.connect(body, point)
    return body


def _add_messenger_supports(overhead: Assembled) -> None:
    found, line, model = overhead.form, overhead.form.line, overhead.model
    overhead.hangers = [None] * line.supports.size
    for k in range(1, line.supports.size - 1):
        point = overhead.messenger.point(found.messenger.nodes.support[k])
        if line.messenger_support is None:
            model.hold(point, position="yz")
            continue
        model.hold(point, position="y")
        overhead.hangers[k] = _add_long_spring(
            model, point, 2, line.messenger_support, found.support_load[k], f"messenger support {k + 1}"
        )


def _add_arms(overhead: Assembled) -> None:
    found, line, model = overhead.form, overhead.form.line, overhead.model
    nodes = found.contact.nodes.support
    overhead.supports = [overhead.contact.point(node) for node in nodes]
    overhead.arms = [None] * nodes.size
    for k in range(1, nodes.size - 1):
        point, arm = overhead.supports[k], line.steady_arm
        force = found.arm_force[k] + np.array([0.0, 0.0, 0.5 * arm.mass * line.gravity])
        _add_mass(model, f"arm {k + 1} mass", point, 0.5 * arm.mass)
        name = f"steady arm {k + 1}"
        if arm.hinged:
            overhead.arms[k] = _add_hinged_arm(overhead, k, force, name)
            continue
        overhead.arms[k] = _add_vertical_arm(model, point, arm.vertical, force[2], name)
        if arm.lateral is None:
            model.hold(point, position="y")
        else:
            _add_long_spring(model, point, 1, arm.lateral, force[1], f"{name} sideways")


def _add_vertical_arm(
    model: ancf.Model, point: Point, stiffness: float | None, load: float, name: str
) -> Spring | None:
    """The vertical spring of a steady arm; without stiffness its force at rest alone."""
    if stiffness:
        return _add_long_spring(model, point, 2, stiffness, load, name)
    if load != 0.0:
        model.add_force(point, (0.0, 0.0, load), name=name)
    return None


def _add_long_spring(
    model: ancf.Model, point: Point, axis: int, stiffness: float, load: float, name: str
) -> Spring:
    """A spring along an axis that pulls with a load at rest, in N, in the direction of the axis."""
    distance = LONG + max(load, 0.0) / stiffness
    fixed = point.initial_position + distance * np.eye(3)[axis]
    return model.add_spring(point, fixed, stiffness=stiffness, length=distance - load / stiffness, name=name)


def _add_hinged_arm(overhead: Assembled, k: int, force: FloatArray, name: str) -> Spring:
    """A bar to a pivot on the mast, in the direction in which it has to pull at rest, N."""
    line, size = overhead.form.line, float(np.linalg.norm(force))
    arm = line.steady_arm
    assert arm.length is not None
    if abs(force[1]) < 1.0 or abs(force[2]) > abs(force[1]):
        what = f"the wire pulls sideways with {abs(force[1]):.0f} N at support {k + 1}, which has to carry "
        what += f"{force[2]:.0f} N: a hinged arm would hang down"
        hint = 'give more stagger, contact_support = "free", or vertical instead of length'
        raise ModelError("line.steady_arm.length", what, hint)
    point = overhead.supports[k]
    pivot = point.initial_position + arm.length * force / size
    return overhead.model.add_spring(
        point, pivot, stiffness=arm.stiffness, length=arm.length - size / arm.stiffness, name=name
    )
