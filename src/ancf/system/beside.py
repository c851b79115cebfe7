"""The system of a model with another number, in which little changes: all else is shared."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from ..connections.spring_build import springs
from ..model.model import Model
from ..model.points import Point
from .compile import Parts, bind_parts, build_bodies, build_elements
from .inputs import Inputs
from .probe import Probe, locate
from .supports import collect
from .system import System

#: Parts that can be made alone: elements, as one.
ELEMENTS, SPRINGS, BODIES = "elements", "springs", "bodies"


class Acts(NamedTuple):
    """What of a system a number of a model acts on, besides the initial shape and motion."""

    parts: frozenset[str] = frozenset()  # ELEMENTS, SPRINGS, BODIES
    weighs: bool = False  # dead loads
    moves: bool = False  # places and axes of supports
    shapes: bool = False  # shape functions, and where points are on their bodies


def beside(system: System, model: Model, acts: Acts) -> System:
    """A system that differs in the numbers of some of its parts alone.

    Parameters
    ----------
    system : System
    model : Model
        With the same bodies, supports, loads and connections but for these numbers.
    acts : Acts
    """
    made, own = System.__new__(System), {"core", "double"}
    own |= {"dead", "patterns"} if acts.weighs else set()
    own |= {"supports"} if acts.moves else set()
    made.__dict__.update((key, value) for key, value in system.__dict__.items() if key not in own)
    made.model = model
    if acts.moves:
        made.constraints = collect(model, system.numbering)
        made.constraints.held |= set(system.spare.tolist())
        made.inputs = Inputs(system.inputs.loads, made.constraints, system.inputs.given)
        made._like = system
    slots, parts = system.numbering.slots, Parts()

    def find(point: Point) -> Probe:
        return locate(point, slots[point.body.name], system.lengths.get(point.body.name, (-1, 0.0)))

    if ELEMENTS in acts.parts:
        parts |= build_elements(model, slots)
    if SPRINGS in acts.parts:
        parts[SPRINGS] = springs(model, find)
    if BODIES in acts.parts:
        parts |= build_bodies(model, slots)
    if not parts:
        return made
    rank = np.arange(system.numbering.blocks, dtype=np.int64)
    made.parts = system.parts | bind_parts(parts, rank, system.constraints, system.places)
    return made
