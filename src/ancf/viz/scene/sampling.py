"""Points along the centrelines of beams and cables, and what is known there."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from ...arrays import FloatArray
from ...errors import ModelError
from ...model.bodies.beam import Beam
from ...model.sections.section import Section
from ...model.sections.shapes import Circle, Rectangle
from ...results.tension import along
from ...system.fields import Fields
from ...system.probe import R_Y, R_Z
from .parts import Thread

#: Points per element, at most: a cubic looks smooth.
FINEST = 16
#: Corners of a circle's outline.
CORNERS = 12


def threads(shown: Fields, points: int, moving: bool = True) -> list[Thread]:
    """Threads of all beams with about so many points together; those that do not move have no values."""
    beams = [body for body in shown.bodies.values() if isinstance(body, Beam)]
    total = sum(beam.elements for beam in beams)
    return [_thread(shown, beam, places(beam, points / max(total, 1)), moving) for beam in beams]


def places(beam: Beam, per_element: float) -> FloatArray:
    """Reference arc lengths: each element in equal parts, or only some of the nodes."""
    if per_element >= 1.0:
        parts = min(int(per_element), FINEST)
        fractions = np.arange(parts) / parts
        x = beam.node_x[:-1, None] + np.diff(beam.node_x)[:, None] * fractions
        return np.append(x.ravel(), beam.length)
    count = max(2, round(beam.elements * per_element))
    kept = np.unique(np.linspace(0, beam.elements, count).round().astype(np.int64))
    nodes: FloatArray = beam.node_x[kept]
    return nodes


def _thread(shown: Fields, beam: Beam, x: FloatArray, moving: bool) -> Thread:
    points = [beam.at(place) for place in x.tolist()]
    values = {}
    if moving:
        values["tension"] = tensions(shown, beam, x)
        values["curvature"] = _joined(shown.curvature(p) for p in points)
        values["speed"] = _joined(np.linalg.norm(shown.velocity(p), axis=-1) for p in points)
    position = _joined(shown.position(p) for p in points)
    return Thread(beam.name, beam.element, x, position, values, _outline(shown, beam, x))


def tensions(shown: Fields, beam: Beam, x: FloatArray) -> FloatArray:
    """Axial forces (n, m) at arc lengths, N; of a cable by the middles of its elements."""
    if beam.has_section:
        return _joined(shown.tension(beam.at(place)) for place in x.tolist())
    return along(shown, beam, x)


def _joined(columns: Iterable[FloatArray]) -> FloatArray:
    """Histories (n,) or (n, 3) of m points as (n, m) or (n, m, 3)."""
    return np.stack([*columns], axis=1)


def _outline(shown: Fields, beam: Beam, x: FloatArray) -> FloatArray | None:
    """Corners of the cross-sections (n, m, k, 3); None for a cable."""
    if not beam.has_section:
        return None
    y, z = corners(beam.section)
    sections = []
    for place in x.tolist():
        probe = shown._beam(beam.at(place))
        r, r_y, r_z = probe.field(shown.q), probe.field(shown.q, R_Y), probe.field(shown.q, R_Z)
        sections.append(r[:, None] + y[:, None] * r_y[:, None] + z[:, None] * r_z[:, None])
    return np.stack(sections, axis=1)


def corners(section: Section) -> tuple[FloatArray, FloatArray]:
    """Local y and z of a section's corners, m; a rectangle with the same moments where there is no shape."""
    shape = section.shape
    if isinstance(shape, Circle):
        angle = 2 * np.pi * np.arange(CORNERS) / CORNERS
        return 0.5 * shape.diameter * np.cos(angle), 0.5 * shape.diameter * np.sin(angle)
    if isinstance(shape, Rectangle):
        width, height = shape.width, shape.height
    else:
        if section.A is None or section.I_y is None or section.I_z is None:
            raise ModelError("section", "has no moments to draw it by")
        width, height = (float(np.sqrt(12.0 * moment / section.A)) for moment in (section.I_z, section.I_y))
    return 0.5 * width * np.array([-1.0, 1.0, 1.0, -1.0]), 0.5 * height * np.array([-1.0, -1.0, 1.0, 1.0])
