"""RouteForm: the forms of all tension lengths of a route, read as one."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from ...arrays import FloatArray
from ...model import checks
from ..lines.route import Route
from .form import Form
from .mesh import Mesh
from .pictured import Pictured
from .schedule import Row, rows, write
from .shape import WireShape


@dataclass(frozen=True, slots=True)
class RouteForm(Pictured):
    """Tension lengths at rest.

    Arrays of droppers and supports are those of all sections, one after the other; see :class:`Form`.

    Attributes
    ----------
    line : Route
    mesh : Mesh
    forms : tuple of Form
        Of each tension length by itself, x from its own first support.

    """

    line: Route
    mesh: Mesh
    forms: tuple[Form, ...]

    def joined(self, values: Callable[[Form], Any]) -> Any:
        """Values of all forms one after the other."""
        return np.concatenate([values(form) for form in self.forms])

    def __repr__(self) -> str:
        return self.in_a_line()

    @property
    def wave_speed(self) -> float:
        """Lowest wave speed of all contact wires as they hang, m/s."""
        return min(form.wave_speed for form in self.forms)

    @property
    def settled(self) -> bool:
        """Whether these are states other than the design."""
        return any(form.settled for form in self.forms)

    @property
    def iterations(self) -> int:
        """Of the form that took most."""
        return max(form.iterations for form in self.forms)

    @property
    def dropper_load(self) -> FloatArray:
        """Tension of each dropper at its lower end, N."""
        load: FloatArray = self.joined(lambda form: form.dropper_load)
        return load

    @property
    def dropper_force(self) -> FloatArray:
        """Force of each dropper between its clamps, N."""
        force: FloatArray = self.joined(lambda form: form.dropper_force)
        return force

    @property
    def dropper_length(self) -> FloatArray:
        """From clamp to clamp under this force, m."""
        length: FloatArray = self.joined(lambda form: form.dropper_length)
        return length

    @property
    def dropper_natural(self) -> FloatArray:
        """From clamp to clamp without force at the temperature of the state, m."""
        length: FloatArray = self.joined(lambda form: form.dropper_natural)
        return length

    @property
    def cut_length(self) -> FloatArray:
        """The same at the temperature for which the line is designed, as cut, m."""
        length: FloatArray = self.joined(lambda form: form.cut_length)
        return length

    @property
    def contact_height(self) -> FloatArray:
        """Of the contact wires at the droppers, m."""
        height: FloatArray = self.joined(lambda form: form.contact_height)
        return height

    @property
    def messenger_height(self) -> FloatArray:
        """Of what the droppers hang from, m."""
        height: FloatArray = self.joined(lambda form: form.messenger_height)
        return height

    @property
    def support_height(self) -> FloatArray:
        """Of the contact wires at the supports, m."""
        height: FloatArray = self.joined(lambda form: form.support_height)
        return height

    @property
    def arm_force(self) -> FloatArray:
        """Force (supports, 3) on the contact wires at the supports, zero at anchors, N."""
        force: FloatArray = self.joined(lambda form: form.arm_force)
        return force

    @property
    def arm_load(self) -> FloatArray:
        """The same of both of twin contact wires together."""
        force: FloatArray = self.joined(lambda form: form.arm_load)
        return force

    @property
    def shifted(self) -> tuple[Form, ...]:
        """The forms in their places on the track."""
        return tuple(_shifted(form, x) for form, x in zip(self.forms, self.line.starts, strict=True))

    @property
    def contact_places(self) -> list[FloatArray]:
        """Places (n, 3) of each contact wire on the track, m."""
        return [place for form in self.shifted for place in form.contact_places]

    def with_forces(self, force: FloatArray, load: FloatArray) -> RouteForm:
        """The same with other forces of the droppers at rest, and loads at their lower ends, N."""
        cuts = np.cumsum([form.dropper_load.size for form in self.forms])[:-1]
        parts = zip(self.forms, np.split(force, cuts), np.split(load, cuts), strict=True)
        return replace(self, forms=tuple(form.with_forces(*own) for form, *own in parts))

    def schedule(self) -> list[Row]:
        """The dropper schedule, spans counted over all sections."""
        return rows(self)

    def save_schedule(self, path: str | Path) -> Path:
        """Write the dropper schedule as CSV, lengths in mm."""
        return write(self.schedule(), checks.path(path, "save_schedule.path"))


def _shifted(form: Form, x: float) -> Form:
    def moved(shape: WireShape) -> WireShape:
        return replace(shape, position=shape.position + np.array([x, 0.0, 0.0]))

    messenger = None if form.messenger is None else moved(form.messenger)
    stitches = tuple(moved(shape) for shape in form.stitches)
    auxiliary = None if form.auxiliary is None else moved(form.auxiliary)
    return replace(
        form,
        contact=moved(form.contact),
        messenger=messenger,
        stitches=stitches,
        auxiliary=auxiliary,
        twin=None if form.twin is None else moved(form.twin),
    )


#: What a model of a line is made of.
AnyForm = Form | RouteForm
