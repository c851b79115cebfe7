"""Where a line comes to rest: its design, or with the droppers it has got and in its conditions."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import overload

from .. import garbage
from ..errors import ModelError
from ..model.checks import shown
from .answers.state import changes
from .assemble import Assembled, assembled
from .forms.arm_loads import pushed
from .forms.form import Form, check, check_lengths, design
from .forms.irregular import with_errors
from .forms.mesh import Mesh
from .forms.route_form import AnyForm, RouteForm
from .lines.catalogue import read_line
from .lines.conditions import Conditions
from .lines.line import Line
from .lines.route import Route
from .route_model import assembled_route
from .settle import as_built, in_conditions
from .twin import design_twin


@overload
def form(line: Line, mesh: Mesh | None = None) -> Form: ...
@overload
def form(line: Route, mesh: Mesh | None = None) -> RouteForm: ...
@overload
def form(line: Line | Route | str | Path, mesh: Mesh | None = None) -> AnyForm: ...
def form(line: Line | Route | str | Path, mesh: Mesh | None = None) -> AnyForm:
    """Find a line's form.

    The design first: the contact wire alone, held at its heights, tells the forces of the droppers; the
    messenger alone under these and all weights finds its shape; the distances are the lengths of the
    droppers. What each wire needs from the others, such as where the droppers point to, is iterated.

    Then, of a line with ``dropper_lengths``, the equilibrium with these, pulled as in the design; and with
    ``conditions`` the equilibrium in them, from there: wires of other lengths, masses and stiffnesses, ends
    that are held, pulled by weights or by springs, wind. Steady arms and supports act about their places in
    the design, and follow the wires along the track.

    Parameters
    ----------
    line : Line, Route, name or path
        Of a route each tension length by itself; a name of the catalogue, or a line file.
    mesh : Mesh
        Of all wires, default ``Mesh()``.

    Raises
    ------
    ModelError
        A dropper would have to push, or the messenger hangs too low; span and dropper are named. A wire is
        slack in the conditions.
    SolveError
        The iteration did not converge.

    """
    line = track_of(line)
    _check_mesh(mesh)
    with garbage.later():
        return _of_route(line, mesh) if isinstance(line, Route) else _of_line(line, mesh)


def track_of(line: Line | Route | str | Path) -> Line | Route:
    """The line, or that of a name of the catalogue or of a line file."""
    if isinstance(line, str | Path):
        return read_line(line)
    given: object = line
    if not isinstance(given, Line | Route):
        what = f"must be a Line, a Route, a name or a path, is {shown(given)}"
        raise ModelError("catenary.line", what, "catenary.read_line reads one")
    return given


def _check_mesh(mesh: object) -> None:
    if mesh is not None and not isinstance(mesh, Mesh):
        what = f"must be a Mesh, is {shown(mesh)}"
        raise ModelError("catenary.mesh", what, "ancf.catenary.Mesh(contact=0.8, messenger=2.0)")


def _of_line(line: Line, mesh: Mesh | None, section: int = 0) -> Form:
    plain = replace(line, conditions=Conditions(), dropper_lengths=None, dropper_errors=None)
    designed = design_twin(plain, mesh) if line.twin else design(plain, mesh)
    found = replace(designed, line=line, made_for=None)
    lengths = line.dropper_lengths
    if lengths is not None:
        check_lengths(line, found.dropper_natural)
    if line.dropper_errors is not None:
        lengths = with_errors(found, line.dropper_errors, section)
    if lengths is not None:
        found = as_built(found, lengths)
    if line.conditions != Conditions():
        found = in_conditions(found)
    if found.settled:
        where = "conditions" if line.conditions != Conditions() else "dropper_lengths"
        for text in pushed(found):
            warnings.warn(f"line.{where}: with {changes(line)} at {text}", UserWarning, stacklevel=5)
    return found


def _of_route(route: Route, mesh: Mesh | None) -> RouteForm:
    """Forms of all tension lengths of a route; an error names the section."""
    forms = []
    for k, line in enumerate(route.lines):
        try:
            forms.append(_of_line(line, mesh, k))
        except ModelError as error:
            raise _in_section(error, k) from None
    return RouteForm(route, Mesh() if mesh is None else mesh, tuple(forms))


def _in_section(error: ModelError, k: int) -> ModelError:
    """The error with the section before its place, unless that is in a table."""
    if ".csv" in error.where:
        return error
    return ModelError(f"sections[{k}].{error.where.removeprefix('line.')}", error.what, error.hint)


def check_track(line: Line | Route) -> list[str]:
    """Find what is wrong with a line, or with the sections of a route, without finding their forms.

    Returns
    -------
    list of str
        Warnings, see :func:`ancf.catenary.forms.form.check`.

    Raises
    ------
    ModelError
        A wire hangs too steep or too far beside the track, the messenger too low, a dropper has other units
        than the design.

    """
    if isinstance(line, Line):
        return check(line)
    said: list[str] = []
    for k, part in enumerate(line.lines):
        try:
            said += [_caution_in_section(text, k) for text in check(part)]
        except ModelError as error:
            raise _in_section(error, k) from None
    return said


def _caution_in_section(text: str, k: int) -> str:
    return text if ".csv" in text else f"sections[{k}].{text.removeprefix('line.')}"


def assemble(found: AnyForm, mesh: Mesh | None = None) -> Assembled:
    """Make the model of a line, see :func:`ancf.catenary.assemble`."""
    _check_mesh(mesh)
    given: object = found
    if not isinstance(given, Form | RouteForm):
        raise ModelError("assemble.form", f"must be a Form, is {shown(given)}", "ancf.catenary.form finds it")
    if mesh is not None and mesh != found.mesh:
        found = form(found.line, mesh)
    return assembled_route(found) if isinstance(found, RouteForm) else assembled(found)
