"""Numbers of a model by name, such as ``beam.EI``, and the model with other values."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import fields, is_dataclass, replace
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..errors import ModelError
from . import checks
from .bodies.beam import Beam
from .bodies.rigid import Body, PointMass
from .describe import section as described
from .describe import section_of
from .exchange import exchanged, renewed
from .functions.function import Scaled, TimeFunction
from .functions.inputs import make_input
from .joints.connections import Spring
from .kinds import GROUPS, SURROUNDINGS
from .rebuild import added_again
from .sections.moments import of_similar_rectangle
from .sections.section import DAMPINGS, FOURTH_MOMENTS, Section

if TYPE_CHECKING:
    from .model import Model

KEY = re.compile(r"(?P<key>[A-Za-z_]\w*)(?:\[(?P<part>\d)\])?")
#: Ends of connections: a joint closes at the start of a run, wherever they are.
ENDS = {"a", "b"}
#: Stiffnesses and mass of a section, and what it has of a material and a shape.
DIRECT = ("EA", "EI", "rhoA", *DAMPINGS)
MATERIAL = ("E", "nu", "rho", "width", "height", "diameter", "J", "A", "I_y", "I_z")
OF_SHAPE = {
    "rectangle": ("E", "nu", "rho", "width", "height", "J"),
    "circle": ("E", "nu", "rho", "diameter", "J"),
    "moments": ("E", "nu", "rho", "A", "I_y", "I_z", "J"),
}
PAIRS = ("shear_factors", "drag", "added_mass", "rotary_inertia")
OF_BEAM = ("length", "start", "end", "velocity", "angular_velocity", "about")
#: Directions, which are no numbers, and what chooses a way.
NO_NUMBERS = ("axis", "axes", "release", "unilateral", "normal", "strip", "direction", "tolerance")
#: What varies numbers that have no name.
BUILT = "a function that builds the model, or a model file with [parameters]"
#: Other names of fields of bodies.
CALLED = {"at": "position"}
#: ``put(old, new, factor)``: a model with one body or item for another, see :mod:`ancf.model.exchange`.
Put = Callable[..., Any]


def value_of(model: Model, name: str) -> float:
    """Number of a model by its name; of a vector or a function as a whole, which varies by a factor, 1.

    Raises
    ------
    ModelError
        The model has no such number.
    """
    return _resolve(model, name, exchanged)[0]


def varied(model: Model, name: str, value: float) -> Model:
    """A model in which one number is another one, all others as they are.

    Parameters
    ----------
    model : Model
        It is left as it is.
    name : str
        ``gravity``, ``gravity[2]``, the name of an input, or NAME.KEY, with [k] for a component, of

        - a cable or beam: EA, EI, rhoA and dampings of its section, of one of a material E, nu, rho,
          width, height, diameter, J, ...; ``length``, the natural one; ``start[k]``, ``end[k]`` if straight;
        - another body: ``mass``, ``inertia``, ``at[k]``, ``volume``, ``drag_area``, ``added_mass``;
        - any of them: ``velocity[k]``, ``angular_velocity[k]``;
        - a support, load, connection or surrounding: its numbers, by the keys of its method.

        Vectors, matrices and functions of time without [k] vary as a whole, by a factor that is 1.

    Raises
    ------
    ModelError
        The model has no such number, or it cannot have this value.
    """
    made: Model = _resolve(model, name, exchanged)[1](checks.number(value, name))
    return made


def renewal(model: Model, name: str) -> tuple[float, Callable[[float], Model]]:
    """The number, and the same as a function of it for models that are only read: they share what stays."""
    now, make = _resolve(model, name, renewed)
    return now, lambda value: make(checks.number(value, name))


def names_of(model: Model) -> list[str]:
    """Names of all numbers that are there to be varied; of vectors the components."""
    found = ["gravity", "gravity[0]", "gravity[1]", "gravity[2]"]
    for item in (*model.bodies.values(), *_items(model)):
        for key in _keys(item):
            for part in ("", "[0]", "[1]", "[2]"):
                name = f"{item.name}.{key}{part}"
                try:
                    value_of(model, name)
                except ModelError:
                    continue
                found.append(name)
    return found + list(model.inputs)


def _resolve(model: Model, name: Any, exchange: Any) -> tuple[float, Any]:
    """The number now, and a function from another one to the model, whose items that makes ``exchange``."""
    name = checks.text(name, "a parameter's name")
    if name.startswith("gravity"):
        found = KEY.fullmatch(name)
        if found is not None and found["key"] == "gravity":
            return _of_vector(name, model.gravity, found["part"], lambda g: _under(model, g, name))
    if name in model.inputs:
        item = model.inputs[name]
        return float(item.value), lambda x: _with(
            model, inputs=model.inputs | {name: make_input(name, name, x, {}, item.unit, item.description)}
        )
    owner, dot, key = name.rpartition(".")
    found = KEY.fullmatch(key)
    if not dot or found is None:
        hint = "such as beam.EI, gravity, end force.force[2]"
        if name.count("[") == 2:  # an entry of a matrix
            hint = f"{name.partition('[')[0]} is a factor of the whole; of an entry {BUILT}"
        raise ModelError(name or '""', "is no number of the model", hint)
    if owner in model.bodies:
        return _of_body(partial(exchange, model), model.bodies[owner], name, found["key"], found["part"])
    for item in _items(model):
        if item.name == owner:
            checked = partial(_put_checked, model, exchange, name)
            put = partial(exchange, model) if found["key"] in ENDS else checked
            return _of_item(put, item, name, found["key"], found["part"])
    known = [*model.bodies, *(item.name for item in _items(model))]
    there = f"there are: {checks.listed(dict.fromkeys(known), 10)}" if known else "it has nothing yet"
    raise ModelError(name, f'the model has no "{owner}", {there}', checks.nearest(owner, known))


def _items(model: Model) -> list[Any]:
    return [item for key in (*GROUPS, *SURROUNDINGS) for item in getattr(model, key)]


def _keys(item: Any) -> list[str]:
    if isinstance(item, Beam):
        return [*DIRECT, *MATERIAL, *PAIRS, *OF_BEAM]
    if not is_dataclass(item):
        return []
    back = {field: key for key, field in CALLED.items()}
    names = [back.get(field.name, field.name) for field in fields(item)]
    return [name for name in names if name not in ("name", *NO_NUMBERS)]


def _with(model: Model, **values: Any) -> Model:
    other = model.snapshot()
    for key, value in values.items():
        setattr(other, key, value)
    return other


def _under(model: Model, gravity: Any, name: str) -> Model:
    """A model with another gravity, under which there may be its waves."""
    made = _with(model, gravity=gravity * (0.0, 0.0, 1.0))  # sideways they do not depend on it
    for fluid in made.fluids:
        if fluid.waves is not None:
            added_again(made, fluid, fluid, name)
    made.gravity = gravity
    return made


def _put_checked(model: Model, exchange: Any, name: str, old: Any, new: Any) -> Any:
    """A model with another item, which its method has to accept."""
    try:
        added_again(model, old, new, name)
    except ModelError as error:
        if not name.endswith((".above", ".below")):
            raise
        raise ModelError(name, error.what, f"to move where two fluids meet: {BUILT}") from None
    return exchange(model, old, new)


def _of_vector(name: str, given: Any, part: str | None, use: Any) -> tuple[float, Any]:
    """A component, or all of an array by a factor."""
    vector = np.asarray(given, dtype=np.float64)
    if part is None:
        return 1.0, lambda x: use(x * vector)
    if vector.ndim != 1 or int(part) >= len(vector):
        raise ModelError(name, f"there is no component [{part}]")

    def changed(x: float) -> Any:
        made = vector.copy()
        made[int(part)] = x
        return use(made)

    return float(vector[int(part)]), changed


def _of_body(put: Put, body: Body, name: str, key: str, part: str | None) -> tuple[float, Any]:
    def use(**values: Any) -> Any:
        return put(body, replace(body, **values))

    if isinstance(body, Beam):
        if body.has_section and key in ("EA", "EI", "rhoA"):
            raise ModelError(name, "follows from material and shape here", "E, rho, width, height, ...")
        if body.has_section and key == "slope_damping":
            what = f'has no effect on element "{body.element}", it damps cables only'
            raise ModelError(name, what, "damping, axial_damping or bending_damping")
        if key in (*DIRECT, *MATERIAL, *PAIRS):
            now, made = _of_section(body.section, name, key, part)
            return now, lambda x: use(section=made(x))
        if key == "length" and part is None:
            return body.length, lambda x: _of_length(put, body, checks.positive(x, name))
        if key in ("start", "end"):
            return _of_end(put, body, name, key, part)
        if key not in OF_BEAM:
            raise _no_key(body, name, key)
    field = CALLED.get(key, key)
    value = getattr(body, field, None)
    if isinstance(value, np.ndarray) and field in ("position", "inertia", "velocity", "angular_velocity"):
        if field == "position":
            return _of_vector(name, value, part, lambda r: _moved(put, body, r))
        return _of_vector(name, value, part, lambda x: use(**{field: x}))
    if isinstance(value, float) and part is None:
        checked = checks.positive if field == "mass" else checks.non_negative
        return value, lambda x: use(**{field: checked(x, name)})
    raise _no_key(body, name, key)


def _no_key(item: Any, name: str, key: str) -> ModelError:
    known = [
        key for key in _keys(item) if isinstance(item, Beam) or _varies(getattr(item, CALLED.get(key, key)))
    ]
    there = f"it has: {', '.join(known)}; of others {BUILT}" if known else BUILT
    return ModelError(name, f'"{item.name}" has no number "{key}"', checks.nearest(key, known) or there)


def _varies(value: Any) -> bool:
    """Whether something is a number, numbers or a function of time."""
    if isinstance(value, tuple):
        return len(value) > 0 and all(isinstance(x, float) for x in value)
    return isinstance(value, float | np.ndarray | TimeFunction)


def _moved(put: Put, body: Any, position: Any) -> Any:
    """A body without elements at another place; it turns about the same place of it."""
    if isinstance(body, PointMass):
        return put(body, replace(body, position=position))
    about = body.about + (position - body.position)
    return put(body, replace(body, position=position, about=about))


def _of_section(section: Section, name: str, key: str, part: str | None) -> tuple[float, Any]:
    plain = described(section)
    if key in PAIRS:
        if getattr(section, key) is None:
            raise ModelError(name, "the section has none")
        now, made = _of_vector(name, getattr(section, key), part or "0", list)
        if part is None:
            raise ModelError(name, "has two values", f"{name}[0], {name}[1]")
        return now, lambda x: section_of(plain | {key: made(x)})
    if part is not None:
        raise ModelError(name, "is one number, it has no components")
    if key in DIRECT:
        now = section.EI_y if key == "EI" else getattr(section, key)
        if key in DAMPINGS:
            return now, lambda x: section_of(plain | {key: x})
        return now, lambda x: _direct(section, name, key, x)
    has = OF_SHAPE[plain.get("shape", "")] if section.E is not None else ()
    if key not in has:
        if key == "diameter" and section.diameter is not None:
            return section.diameter, lambda x: section_of(plain | {key: x})
        raise ModelError(name, "the section has none", "EA, EI and rhoA are there in every section")
    return float(plain[key]), lambda x: section_of(_reshaped(section, plain, key, x))


def _reshaped(section: Section, plain: dict[str, Any], key: str, x: float) -> dict[str, Any]:
    """Description of a section with another number; what was not given with it follows.

    That are Saint-Venant's torsion constant of a shape, and fourth moments of a similar rectangle.
    """
    given = plain | {key: x}
    sizes = [name for name in ("width", "height", "diameter") if name in OF_SHAPE[plain["shape"]]]
    if key in sizes:
        made = Section.rectangle if plain["shape"] == "rectangle" else Section.circle
        own, new = (made(**{name: d[name] for name in sizes}, E=1.0, rho=1.0).J for d in (plain, given))
        if own is not None and math.isclose(own, plain["J"], rel_tol=1e-12):
            given["J"] = new
    if key in ("A", "I_y", "I_z"):
        for fourth in FOURTH_MOMENTS:
            if math.isclose(plain[fourth], of_similar_rectangle(fourth, plain), rel_tol=1e-12):
                given[fourth] = of_similar_rectangle(fourth, given)
    return given


def _direct(section: Section, name: str, key: str, x: float) -> Section:
    """A section whose EA, EI or rhoA is another one, whatever its material says."""
    checked = checks.non_negative(x, name) if key == "EI" else checks.positive(x, name)
    made: Section = object.__new__(Section)
    for field in Section.__slots__:
        object.__setattr__(made, field, getattr(section, field))
    for field in ("EI_y", "EI_z") if key == "EI" else (key,):
        object.__setattr__(made, field, checked)
    return made


def _of_length(put: Put, beam: Beam, length: float) -> Any:
    """A beam of another natural length in the same initial shape; its points stay at their share of it."""
    factor = length / beam.length
    node_x = beam.node_x * factor
    node_x[-1] = length
    made = replace(beam, length=length, stretch=beam.stretch / factor, node_x=node_x)
    return put(beam, made, factor)


def _of_end(put: Put, beam: Beam, name: str, key: str, part: str | None) -> tuple[float, Any]:
    """One end of a straight beam, the other one and the natural length stay."""
    ends = {"start": beam.node_position[0].copy(), "end": beam.node_position[-1].copy()}
    between = ends["end"] - ends["start"]
    across = between - beam.node_tangent * (beam.node_tangent @ between)[:, None]
    if np.max(np.sum(across**2, axis=1)) > (1e-9 * beam.length * beam.stretch) ** 2:
        raise ModelError(name, "is an end of a curve", BUILT)

    def use(place: Any) -> Any:
        both = ends | {key: np.asarray(place)}
        way = both["end"] - both["start"]
        distance = float(np.linalg.norm(way))
        tangent = way / distance
        y = beam.node_y[0] - (beam.node_y[0] @ tangent) * tangent
        made = replace(
            beam,
            stretch=distance / beam.length,
            node_position=both["start"] + np.outer(beam.node_x / beam.length, way),
            node_tangent=np.tile(tangent, (beam.node_x.size, 1)),
            node_y=np.tile(y / np.linalg.norm(y), (beam.node_x.size, 1)),
            about=both["start"] if np.array_equal(beam.about, ends["start"]) else beam.about,
            lay=None,
        )
        return put(beam, made)

    if part is None:
        raise ModelError(name, "has three components", f"{name}[0], {name}[1], {name}[2]")
    return _of_vector(name, ends[key], part, use)


def _of_item(put: Put, item: Any, name: str, key: str, part: str | None) -> tuple[float, Any]:
    if key not in _keys(item):
        raise _no_key(item, name, key)
    if isinstance(item, Spring) and item.slack and key in ("friction", "friction_velocity"):
        raise ModelError(name, "has no effect: a spring that is slack has no friction")
    field = key if hasattr(item, key) else CALLED[key]
    value = getattr(item, field)

    def use(changed: Any) -> Any:
        return put(item, replace(item, **{field: changed}))

    if isinstance(value, float) and part is None:
        return value, use
    if isinstance(value, np.ndarray):
        return _of_vector(name, value, part, use)
    if isinstance(value, tuple) and part is not None and _varies(value):
        return _of_vector(name, value, part, lambda x: use(tuple(x.tolist())))
    if isinstance(value, TimeFunction):
        return _of_function(value, name, part, use)
    plain = isinstance(value, bool | str | tuple | type(None))  # others would show the insides of the package
    what = f"is no number: {checks.shown(value)}" if plain else "is no number"
    raise ModelError(name, what, BUILT)


def _of_function(given: TimeFunction, name: str, part: str | None, use: Any) -> tuple[float, Any]:
    """A constant, or all of a function of time by a factor."""
    if given.inputs:
        raise ModelError(name, "depends on inputs", "vary the input")
    if given.constant:
        now = given(0.0)
        if given.size == 1 and part is not None:
            raise ModelError(name, "is one number, it has no components")
        if given.size == 1:
            return float(now[0]), lambda x: use(TimeFunction(x, 1, given.where))
        return _of_vector(name, now, part, lambda x: use(TimeFunction(x, given.size, given.where)))
    if part is not None:
        raise ModelError(
            name, "is a component of a function of time", f"{name[:-3]} is a factor of all of it"
        )
    return 1.0, lambda x: use(TimeFunction(Scaled(given, x), given.size, given.where))
