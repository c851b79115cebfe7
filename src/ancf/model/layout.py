"""Layout of a new beam: checks what was given and places the nodes on the initial shape."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ancf.errors import ModelError
from ancf.model import checks, path
from ancf.model.beam import (
    ELEMENTS,
    MOST_ELEMENTS,
    MOST_GAUSS_POINTS,
    NATURAL_SHAPES,
    NODE_TOLERANCE,
    POISSON,
    STRAINS,
    Beam,
)
from ancf.model.checks import FloatArray
from ancf.model.section import Section

Sampler = Callable[[FloatArray], tuple[FloatArray, FloatArray]]


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
) -> Beam:
    """Check everything that ``Model.add_beam`` was given and lay out the nodes."""
    words = {
        "element": checks.choice(element, f"{where}.element", ELEMENTS),
        "strain": checks.choice(strain, f"{where}.strain", STRAINS),
        "poisson": checks.choice(poisson, f"{where}.poisson", POISSON),
        "natural_shape": checks.choice(natural_shape, f"{where}.natural_shape", NATURAL_SHAPES),
    }
    _check_section(section, words["element"], f"{where}.section")
    arc_length, shape = _initial_shape(where, start, end, path)
    natural = arc_length if length is None else checks.positive(length, f"{where}.length")
    if not 1e-6 < arc_length / natural < 1e6:
        raise ModelError(f"{where}.length", f"is {natural:g} m for an initial shape of {arc_length:g} m")
    node_x = _node_x(where, elements, nodes, natural)
    position, tangent = shape(node_x / natural)
    return Beam(
        name=name,
        section=section,
        gauss=_gauss(gauss, f"{where}.gauss"),
        length=natural,
        stretch=arc_length / natural,
        node_x=node_x,
        node_position=position,
        node_tangent=tangent,
        velocity=np.zeros(3),
        angular_velocity=np.zeros(3),
        about=position[0].copy(),
        **words,
    )


def _check_section(section: Any, element: str, where: str) -> None:
    if not isinstance(section, Section):
        hint = "ancf.Section(EA=, EI=, rhoA=) or ancf.Section.rectangle(...)"
        raise ModelError(where, f"must be a Section, is {checks.shown(section)}", hint)
    if element == "cable":
        try:
            _ = section.EI
        except ModelError as error:
            raise ModelError(where, error.what, error.hint) from None


def _initial_shape(where: str, start: Any, end: Any, given: Any) -> tuple[float, Sampler]:
    if given is not None:
        if start is not None or end is not None:
            raise ModelError(f"{where}.path", "give either start and end, or path, not both")
        curve = _curve(given, f"{where}.path")
        return curve.length, lambda fraction: curve.at(fraction * curve.length)
    for key, value in (("start", start), ("end", end)):
        if value is None:
            raise ModelError(f"{where}.{key}", "is missing: give start and end, or path")
    first, last = checks.vector(start, f"{where}.start"), checks.vector(end, f"{where}.end")
    distance = math.dist(first, last)
    if not math.isfinite(distance):
        raise ModelError(f"{where}.end", "is too far from start")
    if distance <= 1e-12 * max(math.hypot(*first), math.hypot(*last)):
        raise ModelError(f"{where}.end", f"coincides with start at {first.tolist()}")
    return distance, lambda fraction: path.straight(first, last, fraction)


def _curve(given: Any, where: str) -> path.Curve:
    if callable(given):
        return path.sampled(given, where)
    points = checks.array(given, where, (None, 3))
    if len(points) < 3:
        hint = "use start and end for a straight beam"
        raise ModelError(where, f"has {len(points)} points, needs at least 3", hint)
    return path.interpolated(points, where)


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
        raise ModelError(where, f"go from {ends} m, must go from 0 to the length {length:.12g} m")
    gaps = np.diff(node_x)
    if np.min(gaps) <= 10 * slack:
        i = int(np.argmin(gaps))
        raise ModelError(f"{where}[{i + 1}]", f"must be increasing: {node_x[i + 1]:g} follows {node_x[i]:g}")


def _gauss(given: Any, where: str) -> tuple[int, int]:
    if not isinstance(given, tuple | list) or len(given) != 2:
        raise ModelError(where, f"must be two counts (axial, bending), is {checks.shown(given)}")
    axial, bending = (checks.integer(n, f"{where}[{i}]", 1, MOST_GAUSS_POINTS) for i, n in enumerate(given))
    return axial, bending
