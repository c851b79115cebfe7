"""How sure a state or a history is, from its own numbers: locking of stiff cables, energy from nowhere."""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError
from ..model.bodies.beam import Beam
from ..model.doubts import doubts
from ..model.points import Point
from ..solvers.statics.locking import freed, locked, stiffest
from ..system import redundancy
from ..system.consistency import nearly_dependent
from ..system.system import System
from . import turned_round
from .faces import History, Instant

#: Share of the displacement that locking may take unsaid, and of the model's size that is never said.
LOCKED, SMALL = 3e-4, 1e-9
#: Share of a frequency by which locking may raise it unsaid.
TOO_HIGH = 3e-3
#: N L^2/EI of an element from which on tension counts beside bending.
HELD = 1.0
#: Share of the energy exchanged that may come from nowhere, or get lost, unsaid.
DRIFT = 0.02
#: Joints that a note names.
MOST_NAMED = 4
#: Methods that do not take energy out.
KEEPING = ("trapezoidal", "explicit")


def of_state(state: Instant) -> list[str]:
    """Notes on an equilibrium: which cable bends too little, and by how much."""
    system = state.system
    found = [*turned_round.notes(system, state.q), *redundancy.notes(system), *doubts(system.model)]
    if np.any(state.v):
        return found
    moved = np.abs(locked(system, state.q))
    start, _ = system.initial_state(state.t)
    named = {}
    for name, body in system.model.bodies.items():
        slots = system.slots[name][:, 0, None] + np.arange(3)
        own = system.numbering.slots[name][:, 0, None] + np.arange(3)
        off = float(np.max(moved[own]))
        displaced = float(np.max(np.abs(state.q[slots] - start[slots])))
        if isinstance(body, Beam) and off > LOCKED * displaced and off > SMALL * system.model.size:
            named[name] = off, displaced
    if not named:
        return found
    name, (off, displaced) = max(named.items(), key=lambda item: item[1][0])
    share = f"{100 * off / displaced:.2g} % of its displacement" if displaced > off else "more than it moves"
    text = (
        f'"{name}" may bend too little, by about {off:.2g} m, {share}: its elements are very stiff against '
        f"stretch (EA L^2/EI = {stiffest(system)[0]:.1e}); take more of them, or a smaller EA"
    )
    return [text + _kinked(system, name, moved), *found]


def _kinked(system: System, name: str, moved: FloatArray) -> str:
    """Advice for a cable that a force at a node bends: where nothing resists bending it has a kink there."""
    beam = system.model.beams[name]
    pushed = {getattr(load, "point", None) for load in system.model.loads}
    own = [
        p
        for p in pushed
        if isinstance(p, Point)
        and p.body is beam
        and 0.0 < p.x < beam.length
        and beam.node_at(p.x) is not None
    ]
    if not own:
        return ""
    off = {
        p: float(np.max(moved[system.numbering.slots[name][beam.node_at(p.x), 0] + np.arange(3)]))
        for p in own
    }
    point = max(own, key=lambda p: off[p])
    how = "which two cables have that end there and are connected: model.connect(a.end, b.start)"
    return f"; the load at {point} makes a kink, {how}"


def of_locked_modes(about: Instant, omega: FloatArray, shapes: FloatArray) -> list[str]:
    """A note on modes of cables that bend too little, by how much their frequencies are too high.

    The estimate sees stresses at two points of an element alone: where tension holds elements there is none.
    """
    system = about.system
    lower = freed(system, about.q, omega, shapes)
    own = omega[len(omega) - len(lower) :]
    above = float(np.max((own - lower) / own, initial=0.0))
    if above <= TOO_HIGH or any(_held(about, beam) for beam in system.model.beams.values()):
        return []
    ratio, name = stiffest(system)
    text = (
        f'"{name}" may bend too little: frequencies are up to {100 * above:.2g} % too high, '
        f"its elements are very stiff against stretch (EA L^2/EI = {ratio:.1e}); take more of "
        "them, or a smaller EA"
    )
    return [text]


def _held(about: Instant, beam: Beam) -> bool:
    """Whether the force along a cable holds its elements at least as much as they resist bending."""
    if beam.has_section or beam.section.EI == 0.0:
        return False
    pulls = [float(about.tension(beam.at(float(x)))) for x in 0.5 * (beam.node_x[1:] + beam.node_x[:-1])]
    return bool(np.any(np.abs(pulls) * np.diff(beam.node_x) ** 2 > HELD * beam.section.EI))


def at_most(largest: float, last: float) -> str:
    """How far a balance of energies drifted: by size at most, and at the end."""
    return f"at most {abs(largest):.2g} (end {last:.2g})"


def of_joints(result: History) -> list[str]:
    """Notes on joints of which others hold a part already."""
    try:
        return redundancy.notes(result.system)
    except ModelError:  # a file of another version, whose unknowns are in another order
        return []


def of_energy(result: History) -> list[str]:
    """A note on a history whose energies do not add up."""
    settings = result.provenance.get("settings", {})
    if not settings.get("energy", True) or len(result.t) < 2 or "integrator" not in settings:
        return []
    e = result.energy
    parts = (e.kinetic, e.strain, e.potential - e.potential[0], e.dissipated, e.supplied)
    exchanged = max(float(np.max(np.abs(part))) for part in parts)
    floor = 1e-12 * float(np.max(np.abs(e.potential)))
    drift = np.asarray(e.drift)
    k = int(np.argmax(drift if settings["integrator"] not in KEEPING else np.abs(drift)))
    if abs(drift[k]) <= DRIFT * exchanged + floor + 1e-15:
        return []
    happened = f"{drift[k]:.2g} J came from nowhere" if drift[k] > 0.0 else f"{-drift[k]:.2g} J were lost"
    share = f"{100 * abs(drift[k]) / exchanged:.2g} % of the energy exchanged"
    return [f"{happened} until t = {result.t[k]:.6g} s, {share}: {_cause(result, drift)}"]


def _cause(result: History, drift: FloatArray) -> str:
    """Why energy comes and goes: joints that depend on each other where most of it did, or the step."""
    general = "the step does not resolve the motion, or EA is too large for its round-off"
    try:
        system = result.system
    except ModelError:  # a file of another version, whose unknowns are in another order
        return general
    k = int(np.argmax(np.abs(np.diff(drift))))
    for n in (k + 1, k):
        if names := nearly_dependent(system, np.array(result.q[n])):
            listed = ", ".join(f'"{name}"' for name in names[:MOST_NAMED])
            listed += f" and {len(names) - MOST_NAMED} more" if len(names) > MOST_NAMED else ""
            form = result.provenance["settings"].get("formulation")
            other = 'the formulation "ggl" and ' if form in ("index1", "index2") else ""
            return (
                f"near t = {result.t[n]:.6g} s a singular position is passed, where the joints {listed} hold "
                f"nearly the same motion twice; take {other}smaller steps"
            )
    return general
