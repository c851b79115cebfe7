"""Overview of a model: the sheet that ``print`` and notebooks show."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Protocol

from ..arrays import FloatArray
from .bodies.beam import Beam
from .bodies.rigid import Body, kind
from .doubts import doubts, drawn_otherwise
from .functions.inputs import Input
from .functions.series import noises
from .kind import Kind
from .kinds import SURROUNDINGS, kind_of
from .sheets import place
from .supports.elsewhere import elsewhere
from .tables import Sheet, Table, counted, number, numbers, plural

BODY_COLUMNS = (
    "body",
    "kind",
    "elements",
    "length [m]",
    "mass [kg]",
    "EA [N]",
    "EI [N m^2]",
    "from [m]",
    "to [m]",
)


class Described(Protocol):
    """What a Model has."""

    title: str
    gravity: FloatArray
    bodies: dict[str, Body]
    inputs: dict[str, Input]
    supports: list[Any]
    loads: list[Any]
    connections: list[Any]
    fluids: list[Any]
    grounds: list[Any]
    surfaces: list[Any]


def of_model(model: Described) -> Sheet:
    """Bodies, supports, loads and connections of a model (of hundreds the ends), and doubts about it."""
    bodies = list(model.bodies.values())
    facts = [
        ("gravity", f"{numbers(model.gravity)} m/s^2"),
        ("bodies", sizes(bodies)),
        ("supports", counted(kind_of(item).noun for item in model.supports)),
        ("loads", counted(kind_of(item).noun for item in model.loads)),
        ("connections", counted(kind_of(item).noun for item in model.connections)),
    ]
    tables = [
        body_table(bodies),
        Table(("input", "first value", "what it is"), [_input(item) for item in model.inputs.values()]),
        Table(("support", "at", "holds"), [_item(item) for item in model.supports]),
        Table(("load", "on", "value"), [_item(item) for item in model.loads]),
        Table(("connection", "kind", "between", "data"), [_connection(item) for item in model.connections]),
    ]
    for key, record in SURROUNDINGS.items():
        items = getattr(model, key)
        if items:
            facts.append((key, counted(record.noun for _ in items)))
            tables.append(Table((record.noun, "where", "data"), [_item(item) for item in items]))
    facts += [("note", text) for text in _notes(model)]
    return Sheet(f'Model "{model.title}"' if model.title else "Model", facts, tables)


def _notes(model: Described) -> list[str]:
    """What ``ancf check`` and runs from the initial shape say of a model too."""
    away = [text for text, _ in elsewhere(model)]
    return [*drawn_otherwise(model), *away, *noises(model), *doubts(model)]


def sizes(bodies: Iterable[Body]) -> str:
    """``1 cable, 2 point masses; 16 elements, 1.6 kg`` of some bodies."""
    given = list(bodies)
    elements = sum(body.elements for body in given if isinstance(body, Beam))
    total = sum(mass(body) for body in given)
    return (
        f"{counted(kind(b) for b in given)}; {plural(elements, 'element')}, {number(total)} kg"
        if given
        else ""
    )


def body_table(bodies: Iterable[Body]) -> Table:
    """A row for each body: kind, elements, length, mass, stiffnesses and initial place."""
    return Table(BODY_COLUMNS, [_body(body) for body in bodies])


def mass(body: Body) -> float:
    """Mass of a body, kg."""
    return body.section.rhoA * body.length if isinstance(body, Beam) else body.mass


def _body(body: Body) -> tuple[str, ...]:
    if not isinstance(body, Beam):
        place = numbers(body.position, 4)
        return body.name, kind(body), "", "", number(body.mass), "", "", place, ""
    s = body.section
    bending = number(s.EI_y) if s.EI_y == s.EI_z else f"{number(s.EI_y)}, {number(s.EI_z)}"
    ends = (numbers(body.node_position[k], 4) for k in (0, -1))
    name = f"{body.element} beam" if body.has_section else body.element
    sizes = (str(body.elements), number(body.length), number(mass(body)))
    return body.name, name, *sizes, number(s.EA), bending, *ends


def _input(item: Input) -> tuple[str, str, str]:
    """Name, first value and description of an input."""
    return item.name, f"{number(item.value)} {item.unit}".rstrip(), item.description


def _item(item: Any) -> tuple[str, str, str]:
    """Name, place and numbers of a support or a load."""
    record = kind_of(item)
    return item.name, _between(item, record), record.sheet(item)


def _connection(item: Any) -> tuple[str, str, str, str]:
    """Name, kind, what it connects, and its numbers."""
    record = kind_of(item)
    return item.name, record.noun, _between(item, record), record.sheet(item)


def _between(item: Any, record: Kind) -> str:
    return record.between(item) if record.between else ", ".join(map(place, record.ends_of(item)))
