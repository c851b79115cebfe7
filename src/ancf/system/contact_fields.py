"""What contacts with strips and surfaces do, from state vectors: the same face for one state or a history."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..connections.contact import contact_values
from ..connections.contact_touch import ARC, ASIDE, FORCE, OVERLAP
from ..contact.bump_fields import bump_pressures, roll_frictions
from ..contact.cross_fields import cross_pressures, grip_frictions
from ..contact.fields import frictions, pressures
from ..contact.rubbed import RUBBED, SLIPPED
from ..errors import ModelError, called, named
from ..model.model import Model
from ..model.surfaces.body_contact import BodyContact
from ..model.surfaces.cable_contact import CableContact
from ..model.surfaces.contact import Contact
from ..model.surfaces.surface import SurfaceContact
from .slide_fields import SlideFields
from .system import System

#: By kind of contact with many places: its batches, and what tells their sums; of friction that at a start.
TOUCHING: dict[type, tuple[str, str, Any, Any]] = {
    SurfaceContact: ("pressing", "rubbing", pressures, frictions),
    CableContact: ("crossing", "gripping", cross_pressures, grip_frictions),
    BodyContact: ("bumping", "rolling", bump_pressures, roll_frictions),
}


class ContactFields(SlideFields):
    """Values of contacts, given as the model's object or by name; shapes are () or (n_t,)."""

    model: Model

    def contact_force(self, contact: Any) -> FloatArray:
        """Size of the force that the wire receives across the strip, N, never negative.

        It is the part along the contact's ``normal``, to which that along the track adds where the wire
        climbs. Of a contact with a surface, and of cables, it is the sum of the normal forces along the
        beam, by size.

        Raises
        ------
        ModelError
            There is no such contact.
        """
        return self._contact(contact)[..., FORCE]

    def contact_gap(self, contact: Any) -> FloatArray:
        """Gap between strip and wire along the normal, m; negative while they touch.

        Infinite where the wire does not cross the strip at all. Of a contact with a surface it is the least
        gap along the beam; of cables the least one between them, infinite where none is near.
        """
        return -self._contact(contact)[..., OVERLAP]

    def contact_offset(self, contact: Any) -> FloatArray:
        """Place of the wire on the strip, from the strip's point along its direction, m."""
        return self._strip(contact)[..., ASIDE]

    def friction_force(self, contact: Any) -> FloatArray:
        """Sum of the friction forces along a beam on a surface or a cable, by size, N.

        Raises
        ------
        ModelError
            There is no such contact with a surface, or it is not known: friction depends on the way until a
            state, sensors record it and the last state knows it.
        """
        return self._rubbed(contact, RUBBED)

    def slipping(self, contact: Any) -> FloatArray:
        """Share of the friction of a contact that slips, 0 to 1; errors as of `friction_force`."""
        return self._rubbed(contact, SLIPPED)

    def arc_length(self, joint: Any) -> FloatArray:
        """Reference arc length s of a sliding joint on its carrier, or of a wire at a contact, m.

        Raises
        ------
        ModelError
            There is no such sliding joint or contact.
        """
        if called(joint) in self._contacts():
            return self._strip(joint)[..., ARC]
        return super().arc_length(joint)

    def _contacts(self) -> list[str]:
        """Names of the contacts that can be asked for."""
        return [name for kind in (Contact, *TOUCHING) for name in _named(self.model, kind)]

    def rubs(self, contact: Any) -> bool:
        """Whether a contact is one with a surface or of cables, which may have friction."""
        name = called(contact)
        return any(name in _named(self.model, kind) for kind in TOUCHING)

    def _strip(self, contact: Any) -> FloatArray:
        """The same of a contact with a strip."""
        name = called(contact)
        if self.rubs(contact):
            what = "is a contact all along a beam, which has many places"
            raise ModelError(named(name), what, "of a surface, ask state.contact_line(...) for them")
        return self._contact(contact)

    def _rubbed(self, contact: Any, column: int) -> FloatArray:
        name = called(contact)
        if name in _named(self.model, Contact):
            raise ModelError(named(name), "is a contact with a strip, which has no friction")
        found = self._contact(contact)[..., column]
        if np.any(np.isnan(found)):
            what = "its friction is not known of all states"
            raise ModelError(named(name), what, "record it: sensors=[...]; or ask the last state")
        return found

    def _contact(self, contact: Any) -> FloatArray:
        """Force, overlap, s and place on the strip, or friction and the share that slips, shape (..., 4)."""
        name = called(contact)
        names = self._contacts()
        if name not in names:
            there = "there are: " + ", ".join(names) if names else "there are none"
            raise ModelError(named(name), f"is no contact here; {there}")
        strips = _named(self.model, Contact)
        if name not in strips:
            return self._pressed(name)
        batch = self._contact_system().parts["contacts"]
        mine = batch._replace(found=batch.found.copy())  # a question must not move where a run goes on
        q, v = np.atleast_2d(self.q[...]), np.atleast_2d(self.rates[...])  # type: ignore[attr-defined]
        out = np.empty((len(q), 4))
        contact_values(mine, strips.index(name), np.ascontiguousarray(q), np.ascontiguousarray(v), out)
        values: FloatArray = out if len(self.q.shape) > 1 else out[0]  # type: ignore[attr-defined]
        return values

    def _pressed(self, name: str) -> FloatArray:
        """What ``found`` of a contact all along a beam says, friction as far as it is known."""
        q, v = np.atleast_2d(self.q[...]), np.atleast_2d(self.rates[...])  # type: ignore[attr-defined]
        kind = next(kind for kind in TOUCHING if name in _named(self.model, kind))
        smooth, rough, forces, _ = TOUCHING[kind]
        k, parts = _named(self.model, kind).index(name), self._contact_system().parts
        out = forces(parts[smooth], np.ascontiguousarray(q), np.ascontiguousarray(v))[:, k]
        known = self._memory_of(rough)
        if rough not in parts:
            out[:, RUBBED:] = 0.0
        elif known is not None and "found" in known:
            out[-1, RUBBED:] = known["found"][k, RUBBED:]  # limits have been renewed since it acted
        values: FloatArray = out if len(self.q.shape) > 1 else out[0]  # type: ignore[attr-defined]
        return values

    def _memory_of(self, part: str) -> dict[str, FloatArray] | None:
        """What a batch remembers of the motion until the last state, None where that is not known."""
        return None

    def _contact_system(self) -> System:
        raise NotImplementedError


def _named(model: Model, kind: type) -> list[str]:
    return [c.name for c in model.connections if isinstance(c, kind)]
