"""Layout of a new beam: checks what was given and places the nodes on the initial shape."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from .. import checks
from ..elements import KINDS
from ..sections.inertia import of_cable
from ..sections.section import MATERIAL, Section
from ..sections.shapes import Rectangle
from . import axes, path
from .axes import Sampler
from .beam import MOST_ELEMENTS, MOST_GAUSS_POINTS, NATURAL_SHAPES, NODE_TOLERANCE, POISSON, Beam, Shape
from .reeving import Reeved, Reeving

#: What the nodes of a beam have in the initial shape.
PLACED = ("node_position", "node_tangent", "node_y")
CURVE = "curve"  # a natural shape that has its own nodes
NOT_UNIT = 1e-6  # deviation of a square from 1 of what a description says to be a unit vector
MOST_STRETCH = 1e9  # initial stretch in a description
MIN_LOOP = 3  # elements of a closed beam
MOST_TURN = 2 * math.pi / 3  # rad, of the tangent within an element of a beam


def make_beam(
    where: str,
    name: str,
    *,
    start: Any,
    end: Any,
    path: Any,
    elements: Any,
    nodes: Any,
    section: Any,
    element: Any,
    strain: Any,
    poisson: Any,
    length: Any,
    natural_shape: Any,
    gauss: Any,
    y_axis: Any,
    closed: Any,
) -> Beam:
    """Check everything that ``Model.add_beam`` was given and lay out the nodes."""
    curve = natural_shape if not isinstance(natural_shape, str) else None
    word = CURVE if curve is not None else natural_shape
    words = _words(where, element, strain, poisson, word, NATURAL_SHAPES if curve is None else (CURVE,))
    kind = words["element"]
    _check_section(section, kind, f"{where}.section")
    loop = checks.flag(closed, f"{where}.closed")
    arc_length, shape = initial_shape(where, start, end, path, loop)
    natural = arc_length if length is None else checks.positive(length, f"{where}.length")
    if not 1e-6 < arc_length / natural < 1e6:
        raise ModelError(f"{where}.length", f"is {natural:g} m for an initial shape of {arc_length:g} m")
    node_x = _node_x(where, elements, nodes, natural)
    if loop and node_x.size < MIN_LOOP + 1:
        raise ModelError(f"{where}.elements", f"is {node_x.size - 1}, a closed beam has {MIN_LOOP} or more")
    lay = Lay(shape, path is not None, y_axis, where, loop)
    position, tangent, y = lay(node_x / natural)
    if KINDS[kind].has_section:
        _check_turns(position, arc_length / natural * tangent, np.diff(node_x), where)
    given = {"section": section, "element": element, "strain": strain, "poisson": poisson, "gauss": gauss}
    return Beam(
        natural_beam=None if curve is None else _natural_beam(where, name, curve, node_x, y_axis, given),
        name=name,
        section=section,
        gauss=_gauss(gauss, kind, section, f"{where}.gauss"),
        length=natural,
        stretch=arc_length / natural,
        node_x=node_x,
        node_position=position,
        node_tangent=tangent,
        node_y=y,
        velocity=np.zeros(3),
        angular_velocity=np.zeros(3),
        about=position[0].copy(),
        closed=loop,
        lay=lay,
        **words,
    )


def _natural_beam(
    where: str, name: str, curve: Any, node_x: FloatArray, y_axis: Any, given: dict[str, Any]
) -> Beam:
    """The beam along the curve that it follows without forces."""
    nodes = node_x.tolist()
    try:
        return make_beam(
            where,
            name,
            start=None,
            end=None,
            path=curve,
            elements=None,
            nodes=nodes,
            length=nodes[-1],
            natural_shape="path",
            y_axis=y_axis,
            closed=False,
            **given,
        )
    except ModelError as error:
        place = error.where.replace(".path", ".natural_shape").replace(".length", ".natural_shape")
        raise ModelError(place, error.what, error.hint) from None


@dataclass(frozen=True, slots=True)
class Lay:
    """Positions, tangents and local y axes at fractions of a new beam's length; a class, to be pickled.

    Parameters
    ----------
    shape : Sampler
    curved : bool
        Whether the axes follow a curve.
    y_axis : (3,) or None
        As given.
    where : str
        Place in the model, for messages.
    closed : bool
        Whether it ends where it starts.
    """

    shape: Sampler
    curved: bool
    y_axis: Any
    where: str
    closed: bool = False

    def __call__(self, fraction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Three arrays (n, 3) at fractions (n,)."""
        position, tangent = self.shape(fraction)
        y = _node_y(self.y_axis, tangent, self.shape if self.curved else None, fraction, self.where)
        if self.closed:
            position[-1], tangent[-1] = position[0], tangent[0]
            y = axes.closing(y, tangent, fraction)
        return position, tangent, y


@dataclass(frozen=True, slots=True)
class Between:
    """Positions and tangents at fractions of a straight line between two points (3,), m."""

    start: FloatArray
    end: FloatArray

    def __call__(self, fraction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Two arrays (n, 3) at fractions (n,)."""
        return path.straight(self.start, self.end, fraction)


@dataclass(frozen=True, slots=True)
class Straight:
    """Positions, tangents and the local y axis (3,) at fractions of a straight beam."""

    line: Between
    y: FloatArray

    def __call__(self, fraction: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Three arrays (n, 3) at fractions (n,)."""
        return *self.line(fraction), np.tile(self.y, (fraction.size, 1))


@dataclass(frozen=True, slots=True)
class Along:
    """Positions and tangents at fractions of a curve's length."""

    curve: path.Curve | Reeved

    def __call__(self, fraction: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Two arrays (n, 3) at fractions (n,)."""
        return self.curve.at(fraction * self.curve.length)


def placed_beam(
    where: str, name: str, section: Section, take: Callable[[str], Any], given: Mapping[str, Any]
) -> Beam:
    """Beam of a description: to the last bit the one that was described.

    ``take`` gives what must be there. Positions, tangents and local y axes of the nodes are there where
    they do not follow from the two ends and ``y_axis``.
    """
    element, strain, poisson, natural = map(take, ("element", "strain", "poisson", "natural_shape"))
    words = _words(where, element, strain, poisson, natural, (*NATURAL_SHAPES, CURVE))
    _check_section(section, words["element"], f"{where}.section")
    length = checks.positive(take("length"), f"{where}.length")
    nodes = given.get("nodes")
    node_x = _node_x(where, take("elements") if nodes is None else None, nodes, length)
    lay = None if "node_position" in given else _lay_between(where, take)
    position, tangent, y = _rows(where, node_x.size, take) if lay is None else lay(node_x / length)
    closed = checks.flag(given.get("closed", False), f"{where}.closed")
    if closed and not all(np.array_equal(rows[0], rows[-1]) for rows in (position, tangent, y)):
        raise ModelError(f"{where}.closed", "is true, and the last node is not the first")
    made = Beam(
        name=name,
        section=section,
        gauss=_gauss(take("gauss"), words["element"], section, f"{where}.gauss"),
        length=length,
        stretch=checks.between(take("stretch"), f"{where}.stretch", 1.0 / MOST_STRETCH, MOST_STRETCH),
        node_x=node_x,
        node_position=position,
        node_tangent=tangent,
        node_y=y,
        velocity=np.zeros(3),
        angular_velocity=np.zeros(3),
        about=position[0].copy(),
        closed=closed,
        lay=lay,
        **words,
    )
    if made.natural_shape == CURVE:
        made.natural_beam = _placed_natural(made, take("natural"), f"{where}.natural")
    return made


def _placed_natural(beam: Beam, given: Any, where: str) -> Beam:
    """The natural shape of a description."""
    if not isinstance(given, Mapping):
        raise ModelError(where, f"must be a table, is {checks.shown(given)}")

    def take(key: str) -> Any:
        if key not in given:
            raise ModelError(f"{where}.{key}", "is missing in the description")
        return given[key]

    stretch = checks.between(take("stretch"), f"{where}.stretch", 1.0 / MOST_STRETCH, MOST_STRETCH)
    placed: dict[str, Any] = dict(zip(PLACED, _rows(where, beam.node_x.size, take), strict=True))
    return replace(beam, natural_shape="path", natural_beam=None, lay=None, stretch=stretch, **placed)


def _rows(where: str, count: int, take: Callable[[str], Any]) -> Iterator[FloatArray]:
    """What a description says of the nodes, (count, 3) each."""
    for key in PLACED:
        rows = checks.array(take(key), f"{where}.{key}", (None, 3))
        if len(rows) != count:
            raise ModelError(f"{where}.{key}", f"has {len(rows)} rows for {count} nodes")
        if key != "node_position" and np.max(np.abs(np.sum(rows * rows, axis=1) - 1.0)) > NOT_UNIT:
            raise ModelError(f"{where}.{key}", "must be unit vectors")
        yield rows


def _lay_between(where: str, take: Callable[[str], Any]) -> Shape:
    start, end = (checks.place(take(key), f"{where}.{key}") for key in ("start", "end"))
    return Straight(Between(start, end), checks.direction(take("y_axis"), f"{where}.y_axis"))


def is_straight(beam: Beam) -> bool:
    """Whether its nodes follow from its ends and its first y axis, to the last bit."""
    start, end = beam.node_position[[0, -1]]
    if np.array_equal(start, end) or beam.stretch != math.dist(start, end) / beam.length:
        return False
    rows = Straight(Between(start, end), beam.node_y[0])(beam.node_x / beam.length)
    return all(np.array_equal(getattr(beam, key), mine) for key, mine in zip(PLACED, rows, strict=True))


def _words(
    where: str, element: Any, strain: Any, poisson: Any, natural_shape: Any, shapes: tuple[str, ...]
) -> dict[str, Any]:
    """Kind of element, strain measure, Poisson effect and natural shape."""
    kind = checks.choice(element, f"{where}.element", tuple(KINDS))
    return {
        "element": kind,
        "strain": _strain(strain, kind, f"{where}.strain"),
        "poisson": checks.choice(poisson, f"{where}.poisson", POISSON),
        "natural_shape": checks.choice(natural_shape, f"{where}.natural_shape", shapes),
    }


def _check_section(section: Any, element: str, where: str) -> None:
    if not isinstance(section, Section):
        hint = "ancf.Section(EA=, EI=, rhoA=) or ancf.Section.rectangle(...)"
        raise ModelError(where, f"must be a Section, is {checks.shown(section)}", hint)
    if not KINDS[element].has_section:
        try:
            _ = section.EI
            of_cable(section)
        except ModelError as error:
            raise ModelError(where, error.what, error.hint) from None
    elif section.E is None:
        what = (
            f'element "{element}" needs {", ".join(MATERIAL)} of its section, this one has only stiffnesses'
        )
        hint = "make it with ancf.Section.rectangle(...), .circle(...) or .from_moments(...)"
        raise ModelError(where, what, hint)
    elif section.slope_damping:
        what = f'has no effect on element "{element}", it damps cables only'
        raise ModelError(f"{where}.slope_damping", what, "leave it out")


def _strain(given: Any, element: str, where: str) -> str:
    allowed = KINDS[element].strains
    if given is None:
        return allowed[0]
    if KINDS[element].has_section and isinstance(given, str) and given in KINDS["cable"].strains:
        what = f'"{given}" is a strain measure of cables, element "{element}" has the "green" strain'
        raise ModelError(where, what, "leave strain out")
    return checks.choice(given, where, allowed)


def initial_shape(where: str, start: Any, end: Any, given: Any, closed: bool) -> tuple[float, Sampler]:
    """Length in m and shape of what a beam follows; ModelError if it is none."""
    if given is not None:
        if start is not None or end is not None:
            raise ModelError(f"{where}.path", "give either start and end, or path, not both")
        curve = _curve(given, f"{where}.path", closed)
        return curve.length, Along(curve)
    if closed:
        raise ModelError(
            f"{where}.closed", "needs a path that goes round", "give path instead of start and end"
        )
    for key, value in (("start", start), ("end", end)):
        if value is None:
            raise ModelError(f"{where}.{key}", "is missing: give start and end, or path")
    first, last = checks.place(start, f"{where}.start"), checks.place(end, f"{where}.end")
    distance = math.dist(first, last)
    if distance <= 1e-12 * max(math.hypot(*first), math.hypot(*last)):
        raise ModelError(f"{where}.end", f"coincides with start at {first.tolist()}")
    return distance, Between(first, last)


def _curve(given: Any, where: str, closed: bool) -> path.Curve | Reeved:
    if isinstance(given, Reeving):
        return given.curve(where, closed)
    if callable(given):
        return path.sampled(given, where, closed)
    points = checks.array(given, where, (None, 3))
    if len(points) < 3:
        hint = "use start and end for a straight beam"
        raise ModelError(where, f"has {len(points)} points, needs at least 3", hint)
    return path.interpolated(points, where, closed)


def _node_x(where: str, elements: Any, nodes: Any, length: float) -> FloatArray:
    if (elements is None) == (nodes is None):
        problem = (
            "is missing: give elements, or nodes" if nodes is None else "give elements or nodes, not both"
        )
        raise ModelError(f"{where}.elements", problem)
    if nodes is None:
        count = checks.integer(elements, f"{where}.elements", 1, MOST_ELEMENTS)
        return np.linspace(0.0, length, count + 1)
    node_x = checks.array(nodes, f"{where}.nodes", (None,))
    _check_nodes(node_x, length, f"{where}.nodes")
    node_x[0], node_x[-1] = 0.0, length
    return node_x


def _check_nodes(node_x: FloatArray, length: float, where: str) -> None:
    slack = NODE_TOLERANCE * length
    if not 2 <= node_x.size <= MOST_ELEMENTS + 1:
        raise ModelError(where, f"has {node_x.size} nodes, must be 2 to {MOST_ELEMENTS + 1}")
    if abs(node_x[0]) > slack or abs(node_x[-1] - length) > slack:
        ends = f"{node_x[0]:.12g} to {node_x[-1]:.12g}"
        hint = "length= sets it; that of a path of points is the length of its smooth curve"
        raise ModelError(where, f"go from {ends} m, must go from 0 to the length {length:.12g} m", hint)
    gaps = np.diff(node_x)
    if np.min(gaps) <= 10 * slack:
        i = int(np.argmin(gaps))
        raise ModelError(f"{where}[{i + 1}]", f"must be increasing: {node_x[i + 1]:g} follows {node_x[i]:g}")


def _node_y(
    y_axis: Any, tangent: FloatArray, curve: Sampler | None, fraction: FloatArray, where: str
) -> FloatArray:
    first = axes.first_axis(y_axis, tangent[0], f"{where}.y_axis")
    return np.tile(first, (fraction.size, 1)) if curve is None else axes.along(curve, fraction, first)


def _check_turns(position: FloatArray, slope: FloatArray, length: FloatArray, where: str) -> None:
    """Raise ModelError if an element bends so much that the section between its nodes would collapse."""
    turn = axes.turns(position, slope, length)
    worst = int(np.argmax(turn))
    if turn[worst] > MOST_TURN:
        angle = f"{np.degrees(turn[worst]):.0f} degrees"
        what = f"element {worst} of the initial shape turns by {angle}, at most {np.degrees(MOST_TURN):.0f}"
        raise ModelError(f"{where}.elements", what, "give more elements")


def _gauss(given: Any, element: str, section: Section, where: str) -> tuple[int, int]:
    cable = not KINDS[element].has_section
    if not isinstance(given, tuple | list) or len(given) != 2:
        counts = "axial, bending" if cable else "along the axis, across the section"
        raise ModelError(where, f"must be two counts ({counts}), is {checks.shown(given)}")
    lowest = (1, 1) if cable else (1, 2)  # one point across has no stiffness against bending
    first, second = (
        checks.integer(n, f"{where}[{i}]", lowest[i], MOST_GAUSS_POINTS) for i, n in enumerate(given)
    )
    if not cable and second != 3 and not isinstance(section.shape, Rectangle):
        what = f"is {second}, must be 3: the points across the section are those of a rectangle"
        raise ModelError(f"{where}[1]", what, "other sections are integrated exactly")
    return first, second
