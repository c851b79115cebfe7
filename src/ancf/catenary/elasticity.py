"""Static elasticity: how far an upward force lifts the contact wire, along a span."""

from __future__ import annotations

import csv
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

import ancf

from ..analysis import equilibria
from ..arrays import FloatArray
from ..errors import ModelError
from ..files import writing
from ..model import checks
from ..model.points import Point
from .assemble import Assembled
from .forms.form import Form
from .forms.mesh import Mesh
from .forms.route_form import AnyForm, RouteForm
from .lines.line import Line
from .lines.route import Route
from .rest import assemble, form, track_of
from .told import Told


@dataclass(frozen=True, slots=True, repr=False)
class Elasticity(Told):
    """Static elasticity along one span; ``print`` shows it as a table.

    Attributes
    ----------
    span : int
        Index of the span.
    x : (n,) m
        Places from the start of the span.
    force : (k,) N
    lift : (k, n) m
        Displacement of the place under the force.
    form : Form or None
        Of the spans that were computed.

    """

    span: int
    x: FloatArray
    force: FloatArray
    lift: FloatArray
    form: AnyForm | None = field(default=None, repr=False, compare=False)

    def __repr__(self) -> str:
        return self.in_a_line()

    @property
    def value(self) -> FloatArray:
        """Elasticity (k, n), mm/N."""
        return 1e3 * self.lift / self.force[:, None]

    @property
    def nonuniformity(self) -> FloatArray:
        """(e_max - e_min)/(e_max + e_min) of each force (k,)."""
        high, low = self.value.max(axis=1), self.value.min(axis=1)
        ratio: FloatArray = (high - low) / (high + low)
        return ratio

    def save(self, path: str | Path) -> Path:
        """Write a CSV file, one row for each place."""
        target = checks.path(path, "elasticity.save.path")
        with writing(target), target.open("w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file)
            writer.writerow(["x_m", *(f"elasticity_{f:g}N_mm_per_N" for f in self.force)])
            for x, values in zip(self.x, self.value.T, strict=True):
                writer.writerow([f"{x:.4f}", *(f"{v:.6f}" for v in values)])
        return target


def elasticity(
    line: Line | Route | AnyForm | str | Path,
    forces: Sequence[float] = (100.0, 200.0),
    points: int = 20,
    span: int | None = None,
    beside: int | None = None,
    mesh: Mesh | None = None,
) -> Elasticity:
    """Lift the contact wire at points of a span and read the displacements; droppers go slack as they do.

    Parameters
    ----------
    line : Line, Route, Form, RouteForm, name or path
        Of a route its longest tension length. A form is lifted as it was found, all of it on its mesh.
    forces : sequence of float, N
        Upward, > 0.
    points : int
        Number of equal distances; the droppers are added.
    span : int
        Index of the span, default the middle one.
    beside : int
        Spans kept on either side, to be quick; default the whole line. Two make it some 2 % stiffer with
        fixed anchors, which are then nearer.
    mesh : Mesh

    Raises
    ------
    ModelError
        A force or an index is out of range, the line has no form, or `beside` or `mesh` are given beside one.

    """
    given: Any = list(forces) if isinstance(forces, Sequence) else forces
    force = checks.array(given, "elasticity.forces", (None,))
    if not force.size:
        raise ModelError("elasticity.forces", "is empty")
    for k, value in enumerate(force):
        checks.positive(value, f"elasticity.forces[{k}]")
    checks.integer(points, "elasticity.points", 2, 10_000)
    shape: AnyForm | None = None
    if isinstance(line, Form | RouteForm):
        shape, line = line, line.line
    line = track_of(line)
    if isinstance(line, Route):
        longest = int(np.argmax([len(part.spans) for part in line.parts]))
        part = shape.forms[longest] if isinstance(shape, RouteForm) else _section(line, longest)
        found = elasticity(part, forces, points, span, beside, mesh)
        before = sum(len(part.spans) + 1 for part in line.parts[:longest])
        return replace(found, span=found.span + before)  # its first support among those of all sections
    count = len(line.spans)
    middle = count // 2 if span is None else checks.integer(span, "elasticity.span", 0, count - 1)
    reach = count if beside is None else checks.integer(beside, "elasticity.beside", 0, 1000)
    first, last = max(0, middle - reach), min(count, middle + reach + 1)
    if shape is None:
        shape = form(line.excerpt(first, last - first), mesh)
    else:
        _check_whole(beside, mesh)
    overhead = assemble(shape)
    places = np.union1d(
        np.linspace(0.0, 1.0, points + 1) * line.spans[middle].length, line.spans[middle].droppers
    )
    start = float(overhead.form.line.supports[middle - first])
    lift = _lifts(overhead, start + places, force)
    return Elasticity(middle, places, force, lift, overhead.form)


def _section(route: Route, k: int) -> Line:
    """A tension length as a line, whose droppers are off as they are in the route."""
    line = route.lines[k]
    if line.dropper_errors is None:
        return line
    return replace(line, dropper_errors=replace(line.dropper_errors, section=k))


def _check_whole(beside: int | None, mesh: Mesh | None) -> None:
    """Of a form no part is cut out, and it has its mesh."""
    if beside is not None:
        raise ModelError(
            "elasticity.beside", "has no effect: all of a form is lifted", "give the line instead"
        )
    if mesh is not None:
        raise ModelError("elasticity.mesh", "has no effect: a form has its mesh", "give the line instead")


def elasticity_beside(line: Line | Route) -> Elasticity:
    """Elasticity of the middle span at 100 and 200 N as reports show it, with three spans on either side."""
    return elasticity(line, points=10, beside=3)


def _lifts(overhead: Assembled, track: FloatArray, force: FloatArray) -> FloatArray:
    """Displacements (k, n) at track positions (n,) under forces (k,), each alone: at times 1, 2, ..."""
    model, sample = overhead.model, [overhead.contact_at(float(x)) for x in track]
    for k, x in enumerate(track):
        points = overhead.contacts_at(float(x))
        for point in points:
            times = [1 + k + len(sample) * i for i in range(force.size)]
            model.add_force(point, _only_at(times, force / len(points)))
    rest, *states = equilibria(model, range(1 + force.size * track.size))
    lifted = zip(states, sample * force.size, strict=True)
    lift = [_height(state, point) - _height(rest, point) for state, point in lifted]
    return np.reshape(lift, (force.size, track.size))


def _height(state: ancf.State, point: Point) -> float:
    return float(state.position(point)[2])


def _only_at(times: Sequence[int], force: FloatArray) -> Callable[[float], Any]:
    """An upward force of each size at its time."""
    sizes = {time: float(f) for time, f in zip(times, force, strict=True)}
    return lambda t: (0.0, 0.0, sizes.get(round(t), 0.0))
