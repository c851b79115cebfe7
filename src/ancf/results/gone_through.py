"""Beams that may have gone through what they touch, in runs by methods that do not watch for it."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..contact.cross import PASSED as OF_RADII
from ..contact.press import PASSED as OF_SURFACE
from ..errors import ModelError
from ..model.surfaces.cable_contact import CableContact
from ..model.surfaces.surface import SurfaceContact

#: Methods whose steps nothing repeats where a beam goes through: others end there.
UNWATCHED = ("radau", "explicit")


def of_contacts(result: Any) -> list[str]:
    """Notes on a history, one for each contact; the depths are those of its stored states."""
    settings = result.provenance.get("settings", {})
    if settings.get("integrator") not in UNWATCHED or not len(result.t):
        return []
    try:
        touching = [(c, most) for c in result.system.model.connections if (most := deepest_of(c)) < np.inf]
    except ModelError:  # a file of another version
        return []
    notes = []
    for contact, most in touching:
        depth = -np.asarray(result.contact_gap(contact))
        if np.any(depth > most):
            t = float(result.t[int(np.argmax(depth > most))])
            what = f'"{contact.name}" was {depth.max():.3g} m deep, from t = {t:.6g} s on over {most:.3g} m'
            hint = "a stiffer contact; Trapezoidal and GeneralizedAlpha end there"
            notes.append(f"{what}: a beam may have gone through what it touches ({hint})")
    return notes


def deepest_of(contact: Any) -> float:
    """Depth beyond which a beam may be on the other side, m; infinite of contacts that know none."""
    if isinstance(contact, SurfaceContact):
        return contact.radius + OF_SURFACE * contact.surface.shape.narrowest
    if isinstance(contact, CableContact):
        return OF_RADII * (contact.radius_of(contact.body) + contact.radius_of(contact.other))
    return np.inf
