"""What contacts do, from state vectors: the same face for one state or a history."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..connections.contact import ARC, ASIDE, FORCE, OVERLAP, contact_values
from ..errors import ModelError, named
from ..model.contact import Contact
from ..model.model import Model
from .joint_fields import JointFields
from .system import System


class ContactFields(JointFields):
    """Values of contacts, given as the model's object or by name; shapes are () or (n_t,)."""

    model: Model

    def contact_force(self, contact: Any) -> FloatArray:
        """Size of the force that the wire receives across the strip, N, never negative.

        It is the part along the contact's ``normal``, to which that along the track adds where the wire
        climbs.

        Raises
        ------
        ModelError
            There is no such contact.
        """
        return self._contact(contact)[..., FORCE]

    def contact_gap(self, contact: Any) -> FloatArray:
        """Gap between strip and wire along the normal, m; negative while they touch.

        Infinite where the wire does not cross the strip at all.
        """
        return -self._contact(contact)[..., OVERLAP]

    def contact_offset(self, contact: Any) -> FloatArray:
        """Place of the wire on the strip, from the strip's point along its direction, m."""
        return self._contact(contact)[..., ASIDE]

    def arc_length(self, joint: Any) -> FloatArray:
        """Reference arc length s of a sliding joint on its carrier, or of a wire at a contact, m.

        Raises
        ------
        ModelError
            There is no such sliding joint or contact.
        """
        if getattr(joint, "name", joint) in self._contacts():
            return self._contact(joint)[..., ARC]
        return super().arc_length(joint)

    def _contacts(self) -> list[str]:
        """Names of the contacts that can be asked for."""
        return [c.name for c in self.model.connections if isinstance(c, Contact)]

    def _contact(self, contact: Any) -> FloatArray:
        """Force, overlap, s and place on the strip, shape (..., 4)."""
        name = getattr(contact, "name", contact)
        names = self._contacts()
        if name not in names:
            there = "there are: " + ", ".join(names) if names else "there are none"
            raise ModelError(named(name), f"is no contact here; {there}")
        batch = self._contact_system().parts["contacts"]
        mine = batch._replace(found=batch.found.copy())  # a question must not move where a run goes on
        q, v = np.atleast_2d(self.q[...]), np.atleast_2d(self.v[...])  # type: ignore[attr-defined]
        out = np.empty((len(q), 4))
        contact_values(mine, names.index(name), np.ascontiguousarray(q), np.ascontiguousarray(v), out)
        values: FloatArray = out if len(self.q.shape) > 1 else out[0]  # type: ignore[attr-defined]
        return values

    def _contact_system(self) -> System:
        raise NotImplementedError
