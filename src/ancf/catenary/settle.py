"""A line that comes to rest away from its design: other lengths of droppers, other conditions."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

import ancf

from ..arrays import BoolArray, FloatArray
from ..errors import ModelError, SolveError
from .arms import hinges
from .assemble import Assembled, assembled
from .forms.form import Form
from .forms.shape import Strung, WireShape
from .lines.auxiliary import LongDroppers
from .lines.conditions import Conditions, expansion, warmer
from .lines.line import Line

#: Largest motion of a node from one equilibrium to the next at which the line has come to rest, m.
TOLERANCE = 1e-6
MOST_ITERATIONS = 30
#: Share of its tension below which a wire is slack.
SLACK = 0.1
ENDS = np.array([-1.0, 1.0])
NAMES = ("contact wire", "messenger", "auxiliary", "second contact wire")


@dataclass(frozen=True, slots=True)
class _Wires:
    """What the temperature, wear and ice make of one wire, whatever its tension."""

    rhoA: float
    EA: float
    EI: float

    def under(self, shape: WireShape, tension: float) -> WireShape:
        """The wire with its mass per length as it hangs under a tension in N."""
        mass = self.rhoA / (1.0 + tension / self.EA)
        wire = replace(shape.wire, EA=self.EA, EI=self.EI, mass=mass, tension=tension)
        return replace(shape, wire=wire)


def as_built(designed: Form, lengths: Sequence[float] | FloatArray) -> Form:
    """The line with droppers of given natural lengths (n,) in m, its ends pulled as in the design."""
    droppers, natural = designed.line.droppers, np.array(lengths)
    stiffness = designed.dropper_stiffness
    if droppers.EA is not None:
        stiffness = droppers.EA / natural
    begun = replace(designed, dropper_natural=natural, dropper_stiffness=stiffness)
    return _at_rest(designed, begun, None, mounting=True)


def mounted(begun: Form) -> Form:
    """The line where it comes to rest with what it is made of, its ends pulled as in the design."""
    return _at_rest(begun, begun, None, mounting=True)


def in_conditions(built: Form) -> Form:
    """The line in the conditions that it states, from the form in which it was built.

    Raises
    ------
    ModelError
        A wire becomes slack.
    SolveError
        It does not come to rest.

    """
    line = built.line
    begun = _changed(built)
    if line.anchors == "tension" and line.tensioner.friction > 0.0:
        found = _with_friction(built, begun)
    else:
        found = _at_rest(built, begun, None)
    _check_taut(built, found)
    return found


def _changed(built: Form) -> Form:
    """The form with the wires and natural lengths of the conditions, which does not rest yet."""
    line = built.line
    air = line.conditions
    heat = warmer(line)
    contact = _stretched(built.contact, heat)
    messenger = None if built.messenger is None else _stretched(built.messenger, heat)
    auxiliary = None if built.auxiliary is None else _stretched(built.auxiliary, heat)
    pull = built.pull.copy()
    given = air.contact_tension, air.messenger_tension, None, air.contact_tension
    for k, tension in enumerate(given[: len(pull)]):
        if tension is not None:
            pull[k] *= tension / built.pull[k].mean()
    kinds = _wires(line, air, heat)
    return replace(
        built,
        contact=kinds[0].under(contact, float(pull[0].mean())),
        messenger=None if messenger is None else kinds[1].under(messenger, float(pull[1].mean())),
        auxiliary=None if auxiliary is None else kinds[2].under(auxiliary, float(pull[2].mean())),
        twin=None
        if built.twin is None
        else kinds[0].under(_stretched(built.twin, heat), float(pull[3].mean())),
        long_droppers=_longer(built.long_droppers, 1.0 + expansion(line) * heat),
        stitches=tuple(_stitch(line, shape, air, heat) for shape in built.stitches),
        dropper_natural=built.dropper_natural * (1.0 + expansion(line) * heat),
        pull=pull,
        settled=True,
        warmer=heat,
    )


def _longer(made: LongDroppers | None, factor: float) -> LongDroppers | None:
    return None if made is None else replace(made, natural=made.natural * factor)


def _stretched(shape: WireShape, heat: float) -> WireShape:
    return replace(shape, arc=shape.arc * (1.0 + shape.wire.expansion * heat))


def _wires(line: Line, air: Conditions, heat: float) -> list[_Wires]:
    """Contact wire and messenger."""
    made = []
    third = None if line.auxiliary is None else line.auxiliary.wire
    for k, wire in enumerate((line.contact_wire, line.messenger_wire, third)):
        if wire is None:
            continue
        left = 1.0 - air.wear if k == 0 else 1.0
        longer = 1.0 + wire.expansion * heat
        mass = wire.mass * (1.0 + wire.tension / wire.EA) / longer
        ice = wire.count * air.ice * (1.0 + wire.tension / wire.EA)
        made.append(_Wires(left * mass + ice, left * wire.EA, left**2 * wire.EI))
    return made


def _stitch(line: Line, shape: WireShape, air: Conditions, heat: float) -> WireShape:
    wire = shape.wire
    mass = wire.mass * (1.0 + wire.tension / wire.EA) / (1.0 + wire.expansion * heat) + wire.count * air.ice
    return _Wires(mass, wire.EA, wire.EI).under(_stretched(shape, heat), wire.tension)


def _with_friction(built: Form, begun: Form) -> Form:
    """Ends stay where the tension is between the weights' less and plus friction, and slide elsewhere."""
    share, weights = built.line.tensioner.friction, begun.pull
    held = np.ones(weights.shape, dtype=bool)
    for _ in range(MOST_ITERATIONS):
        found = _at_rest(built, begun, held)
        low, high = weights * (1.0 - share), weights * (1.0 + share)
        slides = held & ((found.pull < low - 1e-6) | (found.pull > high + 1e-6))
        if built.messenger is None:
            slides[1] = False
        if not np.any(slides):
            return found
        begun = replace(begun, pull=np.where(slides, np.clip(found.pull, low, high), begun.pull))
        held &= ~slides
    raise SolveError("catenary.form", "the ends of the wires neither stay nor slide", "other friction")


def _at_rest(built: Form, begun: Form, held: BoolArray | None, mounting: bool = False) -> Form:
    """Equilibria of the whole line, whose supports follow it along the track, until nothing moves."""
    now, moved = replace(begun, arm_hinges=hinges(built)), np.inf
    for _ in range(MOST_ITERATIONS):
        overhead = assembled(now, held, mounting)
        found = _rested(built, now, overhead, ancf.equilibrium(overhead.model))
        before = moved
        moved = max(
            float(np.max(np.abs(a.position - b.position)))
            for a, b in zip(_all(found), _all(now), strict=True)
        )
        now = found
        if moved < TOLERANCE:
            return now
    what = f"the line does not come to rest: its last motions are {before:.2e} and {moved:.2e} m"
    raise SolveError("catenary.form", what, "conditions nearer to the design")


def _all(form: Form) -> list[WireShape]:
    every = (*form.contacts, form.messenger, form.auxiliary, *form.stitches)
    return [shape for shape in every if shape is not None]


def _rested(built: Form, now: Form, overhead: Assembled, state: ancf.State) -> Form:
    """Places and forces of an equilibrium as a form."""
    line, wires = now.line, overhead.wires[: len(now.pull)]
    pull = np.array([_pull(now, k, wire, overhead, state) for k, wire in enumerate(wires)])
    shapes = [
        None if wire is None else _moved(wire, state, float(pull[k].mean())) for k, wire in enumerate(wires)
    ]
    contact, messenger, auxiliary, twin = (*shapes, None, None)[:4]
    assert contact is not None
    stitches = tuple(replace(wire.shape, position=wire.positions(state)) for wire in overhead.stitches)
    force = np.array([float(state.spring_force(d)) for d in overhead.droppers if d is not None])
    length = now.dropper_natural + force / now.dropper_stiffness
    moved = replace(
        now, contact=contact, messenger=messenger, auxiliary=auxiliary, twin=twin, stitches=stitches
    )
    upper, lower = moved.upper, moved.lower
    distance = np.linalg.norm(upper - lower, axis=1)
    lift = force * (upper - lower)[:, 2] / np.where(distance > 0.0, distance, 1.0)
    give = now.clamp_give
    load, side = _hangers(built, messenger, overhead, state)
    arms = [_arms(built, now, k, shape, overhead, state) for k, shape in enumerate(moved.contacts)]
    return replace(
        moved,
        dropper_force=force,
        dropper_length=length,
        dropper_load=force - 0.5 * line.droppers.mass * length * line.gravity,
        contact_height=lower[:, 2] + now.contact_give * lift,
        messenger_height=upper[:, 2] - (give - now.contact_give) * lift,
        arm_force=arms[0],
        twin_arm_force=arms[1] if twin is not None else None,
        support_load=load,
        support_side=side,
        pull=pull,
        settled=True,
        long_droppers=_long(now, overhead, state),
    )


def _long(now: Form, overhead: Assembled, state: ancf.State) -> LongDroppers | None:
    """Forces and lengths of the droppers between messenger and auxiliary."""
    made = now.long_droppers
    if made is None:
        return None
    force = np.array([float(state.spring_force(spring)) for spring in overhead.long_droppers])
    held = overhead.auxiliary_holds
    side = np.array([0.0 if hold is None else float(state.reaction(hold)[1]) for hold in held])
    return replace(made, force=force, length=made.natural + force / made.stiffness, side=side)


def _moved(wire: Strung, state: ancf.State, tension: float) -> WireShape:
    """The shape where it came to rest, with its material as before under the tension at its ends."""
    shape = wire.shape
    old = shape.wire
    rhoA = old.mass * (1.0 + old.tension / old.EA)
    return _Wires(rhoA, old.EA, old.EI).under(replace(shape, position=wire.positions(state)), tension)


def _pull(now: Form, k: int, wire: Strung | None, overhead: Assembled, state: ancf.State) -> FloatArray:
    """Forces (2,) along the track at the ends of a wire, N: as given, or what held ends give."""
    force: FloatArray = now.pull[k].copy()
    if wire is None:
        return force
    for i, holder in enumerate(overhead.ends[k]):
        if isinstance(holder, ancf.model.Pin):
            force[i] = ENDS[i] * float(state.reaction(holder)[0])
        elif holder is not None:
            force[i] = float(state.spring_force(holder))
    return force


def _arms(
    built: Form, now: Form, wire: int, contact: WireShape, overhead: Assembled, state: ancf.State
) -> FloatArray:
    """Forces (supports, 3) of the steady arms on a contact wire, N, by their laws about the design."""
    line, force = built.line, np.zeros_like(built.arm_force)
    rests = built.contacts[wire].position
    given = built.arm_force if wire == 0 else built.twin_arm_force
    assert given is not None
    holds, rods = (overhead.arm_holds, overhead.twin_arm_holds)[wire], hinges(now)[wire]
    for k in range(1, len(force) - 1):
        arm, node = built.arm(k), contact.nodes.support[k]
        rest, here = rests[node], contact.position[node]
        weight = np.array([0.0, 0.0, 0.5 * arm.mass * line.gravity])
        first = given[k] + weight
        if arm.length is not None:
            y, z, natural = rods[k]
            rod = np.array([0.0, y - here[1], z - here[2]])  # the cantilever follows the wire along the track
            reach = float(np.linalg.norm(rod))
            force[k] = arm.stiffness * (reach - natural) * rod / reach - weight
            continue
        force[k, 2] = first[2] - (arm.vertical or 0.0) * (here - rest)[2] - weight[2]
        hold = holds[k]
        if hold is not None:
            force[k, 1] = float(state.reaction(hold)[1])
        else:
            assert arm.lateral is not None
            force[k, 1] = first[1] - arm.lateral * (here - rest)[1]
    return force


def _hangers(
    built: Form, messenger: WireShape | None, overhead: Assembled, state: ancf.State
) -> tuple[FloatArray, FloatArray]:
    """Forces of the supports on the messenger (supports,), upwards and sideways, N."""
    line, count = built.line, built.support_load.size
    load, side = np.zeros(count), np.zeros(count)
    for k in range(1, count - 1):
        hold = overhead.hanger_holds[k]
        if messenger is None or built.messenger is None or hold is None:
            continue
        reaction = state.reaction(hold)
        side[k] = float(reaction[1])
        if line.messenger_support is None:
            load[k] = float(reaction[2]) - line.messenger_support_mass * line.gravity
            continue
        node = messenger.nodes.support[k]
        risen = messenger.position[node, 2] - built.messenger.position[node, 2]
        load[k] = built.support_load[k] - line.messenger_support * risen
    return load, side


def _check_taut(built: Form, found: Form) -> None:
    air, line = built.line.conditions, built.line
    for k, name in enumerate(NAMES[: len(found.pull)]):
        if k == 1 and built.messenger is None:
            continue
        left, was = float(found.pull[k].min()), float(built.pull[k].mean())
        if left < SLACK * was:
            degrees = line.temperature if air.temperature is None else air.temperature
            what = f"is {degrees:g} degrees Celsius, the {name} is slack: {left:.0f} of {was:.0f} N are left"
            if line.contact_wire.rail:
                what = f"is {degrees:g} degrees Celsius, the rail is pressed with {-left:.0f} N"
                what += " between its ends, which may buckle it and is not computed"
            raise ModelError("line.conditions.temperature", what, 'anchors = "tension", or a smaller change')
