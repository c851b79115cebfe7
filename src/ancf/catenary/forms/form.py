"""Form finding: the line at rest with prescribed heights and tensions, and the lengths of its droppers."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError, SolveError
from ...model import checks
from ..lines.auxiliary import LongDroppers
from ..lines.conditions import expansion
from ..lines.fittings import Droppers, SteadyArm
from ..lines.line import Line
from .arm_loads import check_arms, check_roughly, sides
from .first_guess import first_guess
from .hang import Hung, hang_auxiliary, hang_contact, hang_messenger, hang_stitches
from .mesh import Mesh
from .pictured import Pictured
from .reach import cautions, check_aside
from .schedule import Row, rows, write
from .shape import WireShape

TOLERANCE = 1e-8  # m
MOST_ITERATIONS = 60
#: How many times longer or shorter than designed droppers can be; more is a slip of units.
UNLIKE = 10.0
#: Least length of a dropper without force over the one at rest: what is stretched more has other units.
SHORTEST = 0.1
#: Parts of a line that may change without finding its form again: it rests alike.
WITHOUT_WEIGHT = ("damping", "rows", "title", "source", "report", "tags")


@dataclass(frozen=True, slots=True)
class Form(Pictured):
    """A line at rest.

    Attributes
    ----------
    line : Line
    mesh : Mesh
        With which it was found, and with which the wires keep their heights exactly.
    contact, messenger : WireShape
        The wires with their natural lengths; a messenger only if the line has one.
    stitches : tuple of WireShape
        Stitch wires at the supports but the first and the last, if the line has them.
    dropper_load : (n,) N
        Tension of each dropper at its lower end.
    dropper_force : (n,) N
        Its force between the two wires' clamps; half of the dropper's weight is at each.
    dropper_length, dropper_natural : (n,) m
        From clamp to clamp under this force, and without force at the temperature of the state.
    dropper_stiffness : (n,) N/m
    clamp_give : (n,) m/N
        What both wires give too little at the clamps on this mesh, see :mod:`ancf.catenary.clamps`.
    contact_give : (n,) m/N
        The contact wire's part of it.
    contact_height, messenger_height : (n,) m
        Of the contact wire and of what the droppers hang from, at the droppers.
    support_load, support_side : (supports,) N
        Upward and sideways forces of the supports on the messenger; zero at the two anchors.
    arm_force : (supports, 3) N
        Force on the contact wire at the supports; zero at the two anchors.
    iterations : int
    pull : (2, 2), (3, 2) or (4, 2) N
        Component along the track of the forces at both ends of contact wire, messenger, auxiliary and second
        contact wire.
    settled : bool
        Whether it is the state of the line's conditions or of lengths that were given, not of the design.
    auxiliary : WireShape or None
        Of a compound catenary; the droppers hang from it then, and it from the messenger by
    long_droppers : LongDroppers or None
    twin : WireShape or None
        The second of two contact wires side by side, and
    twin_arm_force : (supports, 3) N or None
        the force on it at the supports.
    arm_sides : tuple of str
        Of each support the side of the wire on which the hinge of its arm is where the line does not say it:
        that to which it pulls in the design, in every state. "" of ends, and where the design pulls nowhere.
    arm_hinges : tuple of (supports, 3) m, or None
        Of a state other than the design where its hinged arms have their hinges, sideways and upwards, and
        their natural lengths, of each contact wire: those of the design.
    warmer : float, K
        Than in the design, by its conditions.
    made_for : (Line, Mesh)
        What it was found for.

    Raises
    ------
    ModelError
        It is given a line or a mesh that rests in another way (`dataclasses.replace`).

    """

    line: Line
    mesh: Mesh
    contact: WireShape
    messenger: WireShape | None
    stitches: tuple[WireShape, ...]
    dropper_load: FloatArray
    dropper_force: FloatArray
    dropper_length: FloatArray
    dropper_natural: FloatArray
    dropper_stiffness: FloatArray
    clamp_give: FloatArray
    contact_give: FloatArray
    contact_height: FloatArray
    messenger_height: FloatArray
    support_load: FloatArray
    support_side: FloatArray
    arm_force: FloatArray
    iterations: int
    pull: FloatArray
    settled: bool = False
    auxiliary: WireShape | None = None
    long_droppers: LongDroppers | None = None
    twin: WireShape | None = None
    twin_arm_force: FloatArray | None = None
    arm_sides: tuple[str, ...] = ()
    arm_hinges: tuple[FloatArray, ...] | None = None
    warmer: float = 0.0
    made_for: tuple[Line, Mesh] | None = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        if self.made_for is None:
            object.__setattr__(self, "made_for", (self.line, self.mesh))
            return
        line, mesh = self.made_for
        hint = "find the form again, ancf.catenary.form(line, mesh)"
        if self.mesh != mesh:
            raise ModelError("form.mesh", "is not the one that the form was found with", hint)
        for item in fields(Line):
            if item.name not in WITHOUT_WEIGHT and getattr(self.line, item.name) != getattr(line, item.name):
                what = "is not what the form was found for: the lengths of wires and droppers belong to it"
                raise ModelError(f"form.line.{item.name}", what, hint)

    def __repr__(self) -> str:
        return self.in_a_line()

    @property
    def wave_speed(self) -> float:
        """Wave speed of the contact wire as it hangs, m/s; of a rail its critical speed."""
        return self.contact.wire.critical_speed(max(span.length for span in self.line.spans))

    @property
    def cut_length(self) -> FloatArray:
        """Lengths (n,) without force at the temperature for which the line is designed, as cut, m."""
        cut: FloatArray = self.dropper_natural / (1.0 + expansion(self.line) * self.warmer)
        return cut

    @property
    def spring_stiffness(self) -> FloatArray:
        """Stiffnesses (n,) in N/m of the droppers between the nodes: with the give of their clamps."""
        stiffness: FloatArray = self.dropper_stiffness / (1.0 + self.clamp_give * self.dropper_stiffness)
        return stiffness

    @property
    def spring_damping(self) -> FloatArray:
        """Dampers (n,) in N s/m beside these springs: in series with the give they brake less."""
        damping: FloatArray = (
            self.line.droppers.damping * (self.spring_stiffness / self.dropper_stiffness) ** 2
        )
        return damping

    def arm(self, k: int) -> SteadyArm:
        """Steady arm of a support, with the side on which it stands."""
        arm, sides = self.line.arm(k), self.arm_sides or ("",) * (k + 1)
        return arm if arm.side is not None or not sides[k] else replace(arm, side=sides[k])

    @property
    def support_height(self) -> FloatArray:
        """Heights of the contact wire at the supports, m."""
        height: FloatArray = self.contact.position[self.contact.nodes.support, 2]
        return height

    @property
    def arm_load(self) -> FloatArray:
        """Force (supports, 3) on all contact wires at the supports, N."""
        return self.arm_force if self.twin_arm_force is None else self.arm_force + self.twin_arm_force

    @property
    def shifted(self) -> tuple[Form, ...]:
        """The forms of all tension lengths in their places on the track: itself."""
        return (self,)

    @property
    def contacts(self) -> tuple[WireShape, ...]:
        """The contact wire, or both of twin ones."""
        return (self.contact,) if self.twin is None else (self.contact, self.twin)

    @property
    def contact_places(self) -> list[FloatArray]:
        """Places (n, 3) of each contact wire on the track, m."""
        return [shape.position for shape in self.contacts]

    @property
    def lower(self) -> FloatArray:
        """Nodes (n, 3) of the contact wires at the droppers, m."""
        every = np.stack([shape.position[shape.nodes.dropper] for shape in self.contacts])
        made: FloatArray = every[self.line.dropper_wire, np.arange(every.shape[1])]
        return made

    @property
    def upper(self) -> FloatArray:
        """Nodes (n, 3) from which the droppers hang, m."""
        if self.auxiliary is not None:
            return self.auxiliary.position[self.auxiliary.nodes.dropper]
        if self.messenger is None:
            return np.zeros((0, 3))
        position = self.messenger.position[self.messenger.nodes.dropper]
        for k, shape in enumerate(self.stitches):
            position[self.line.dropper_stitch == k + 1] = shape.position[shape.nodes.dropper]
        return position

    def with_forces(self, force: FloatArray, load: FloatArray) -> Form:
        """The same with other forces of the droppers at rest, and loads at their lower ends, N."""
        return replace(self, dropper_force=force, dropper_load=load)

    def schedule(self) -> list[Row]:
        """The dropper schedule, one row for each dropper."""
        return rows(self)

    def save_schedule(self, path: str | Path) -> Path:
        """Write the dropper schedule as CSV, lengths in mm."""
        return write(self.schedule(), checks.path(path, "save_schedule.path"))


def design(line: Line, mesh: Mesh | None = None) -> Form:
    """Find the form that a line is designed to have, whatever its conditions and the droppers it got.

    The contact wire alone, held at its heights, tells the forces of the droppers; the messenger alone
    under these and all weights finds its shape; the distances are the lengths of the droppers. What each
    wire needs from the others, such as where the droppers point to, is iterated.

    Parameters
    ----------
    line : Line
    mesh : Mesh
        Of both wires, default ``Mesh()``.

    Raises
    ------
    ModelError
        A dropper would have to push, or the messenger hangs too low; span and dropper are named.
    SolveError
        The iteration did not converge.

    """
    mesh = Mesh() if mesh is None else mesh
    now = first_guess(line, mesh)
    check_aside(line, now.contact)
    for iteration in range(1, MOST_ITERATIONS + 1):
        _check_reach(line, now)
        before = now
        now = hang_contact(now)
        contact_error = now.error
        now = hang_stitches(hang_messenger(hang_auxiliary(now)))
        change = float(np.max(np.abs(now.dropper - before.dropper), initial=0.0))
        left = max(change, contact_error, now.error)
        if left < TOLERANCE:
            return _finished(line, mesh, now, iteration)
    what = f"no convergence in {MOST_ITERATIONS} iterations, the last is off by {left:.2e} m"
    raise SolveError("catenary.form", what, "wires that sag much, or droppers very close to each other")


def check(line: Line, mesh: Mesh | None = None) -> list[str]:
    """Find what is wrong with a line without finding its form: its wires as strings must fit.

    Returns
    -------
    list of str
        Warnings: spans in which the contact wire leaves strips of the usual length.

    Raises
    ------
    ModelError
        A wire hangs too steep or too far beside the track, the messenger too low, or the mesh is too large.

    """
    begun = first_guess(line, Mesh() if mesh is None else mesh)
    check_aside(line, begun.contact)
    check_roughly(line)
    _check_reach(line, begun)
    if line.dropper_lengths is not None:
        check_lengths(line, begun.short.length)
    return cautions(line, begun.contact)


def check_lengths(line: Line, designed: FloatArray) -> None:
    """Raise ModelError where a dropper as built is so much longer or shorter that units must differ, in m."""
    built = np.array(line.dropper_lengths)
    factor = np.maximum(built / designed, designed / built)
    worst = int(np.argmax(factor)) if factor.size else 0
    if factor.size and factor[worst] > UNLIKE:
        what = f"is {1e3 * built[worst]:g} mm, of {line.dropper_label(worst)}, "
        what += f"which is designed {1e3 * designed[worst]:.0f} mm long"
        raise ModelError(f"line.dropper_lengths[{worst}]", what, "in Python in m, in a table in mm")


def _check_reach(line: Line, now: Hung) -> None:
    """Raise ModelError where the messenger is not above the contact wire."""
    if now.auxiliary is not None and np.any(now.long.vector[:, 2] <= 0.0):
        worst = int(np.argmin(now.long.vector[:, 2]))
        what = f"the messenger hangs below the auxiliary at {line.long_x[worst]:g} m"
        raise ModelError("line.auxiliary.height", what, "give less, or more system_height or tension")
    gap = now.dropper[:, 2]
    if not gap.size:
        return
    worst = int(np.argmin(gap))
    if gap[worst] <= 0.0:
        upper = "messenger" if now.auxiliary is None else "auxiliary"
        what = f"the {upper} hangs {-gap[worst]:.3f} m below the contact wire there, the dropper cannot reach"
        raise ModelError(line.dropper_label(worst), what, "give more system_height or more tension")


def _finished(line: Line, mesh: Mesh, now: Hung, iterations: int) -> Form:
    length, force = now.short.length, now.short.force
    own = line.droppers.mass * length * line.gravity
    load = force - 0.5 * own
    least = float(np.min(load, initial=np.inf))
    check_arms(line, now.arm)
    if least <= 0.0:
        worst = int(np.argmax(load <= least + 1e-3 * abs(least)))  # the first of those that are alike
        what = f"would carry {load[worst]:.1f} N at rest: it has to push the contact wire down"
        raise ModelError(line.dropper_label(worst), what, "change its place or the pre_sag around it")
    natural, stiffness = unstretched(line.droppers, length, force, line.dropper_label)
    tensions = [line.contact_wire.tension, messenger_tension(line)]
    if line.auxiliary is not None:
        tensions.append(line.auxiliary.wire.tension)
    return Form(
        line=line,
        mesh=mesh,
        contact=now.contact,
        messenger=now.messenger,
        stitches=now.stitches,
        dropper_load=load,
        dropper_force=force,
        dropper_length=length,
        dropper_natural=natural,
        dropper_stiffness=stiffness,
        clamp_give=now.give.sum(axis=0),
        contact_give=now.give[0],
        contact_height=now.contact.position[now.contact.nodes.dropper, 2] + now.give[0] * now.lift,
        messenger_height=now.upper[:, 2] - now.give[1] * now.lift,
        support_load=now.support,
        support_side=now.side,
        arm_force=now.arm,
        arm_sides=sides(now.arm),
        iterations=iterations,
        pull=np.outer(tensions, [1.0, 1.0]),
        auxiliary=now.auxiliary,
        long_droppers=_long(line, now),
    )


def _long(line: Line, now: Hung) -> LongDroppers | None:
    """The droppers between messenger and auxiliary, which have to pull."""
    if line.auxiliary is None:
        return None
    ties, given = now.long, line.auxiliary.droppers
    load = ties.force - 0.5 * given.mass * ties.length * line.gravity
    if np.any(load <= 0.0):
        worst = int(np.argmin(load))
        what = f"the one at {line.long_x[worst]:g} m would carry {load[worst]:.1f} N at rest: it has to push"
        raise ModelError("line.auxiliary.droppers", what, "change its place, or places of droppers around it")

    def label(j: int) -> str:
        return f"line.auxiliary: long dropper at {line.long_x[j]:g} m"

    natural, stiffness = unstretched(given, ties.length, ties.force, label)
    give: FloatArray = now.long_give.sum(axis=0)
    return LongDroppers(ties.force, ties.length, natural, stiffness, give, now.auxiliary_side)


def messenger_tension(line: Line) -> float:
    """Tension of the messenger, N; 0 without one."""
    return 0.0 if line.messenger_wire is None else line.messenger_wire.tension


def unstretched(
    droppers: Droppers, length: FloatArray, force: FloatArray, label: Callable[[int], str]
) -> tuple[FloatArray, FloatArray]:
    """Natural lengths, m, and stiffnesses, N/m, of droppers."""
    if droppers.EA is not None:
        natural = length / (1.0 + force / droppers.EA)
    else:
        assert droppers.stiffness is not None
        natural = length - force / droppers.stiffness
    share = natural / length
    if share.size and float(share.min()) < SHORTEST:
        worst = int(np.argmin(share))
        stretch = f"{1e3 * (length - natural)[worst]:.1f} mm of its {1e3 * length[worst]:.1f} mm"
        hint = f"give stiffer droppers: {'EA is in N' if droppers.EA is not None else 'stiffness is in N/m'}"
        raise ModelError(label(worst), f"is stretched by {stretch}", hint)
    if droppers.EA is not None:
        return natural, droppers.EA / natural
    return natural, np.full(length.size, droppers.stiffness)
