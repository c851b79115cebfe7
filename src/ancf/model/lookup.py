"""Lookup: the part of a Model that finds bodies and points by name, and says where an error is."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

from ancf.errors import ModelError
from ancf.model import checks
from ancf.model.beam import Beam
from ancf.model.names import Names, split_label, unknown
from ancf.model.points import Point


class Lookup:
    """Bodies and names of one model."""

    def __init__(self) -> None:
        self.bodies: dict[str, Beam] = {}
        self._names = Names()
        self._place = ""

    def body(self, name: str) -> Beam:
        """Return the body of a name; an unknown name raises ModelError with the right ones."""
        return self._body(name, "Model.body")

    def point(self, label: str) -> Point:
        """Return the point written as ``beam.start``, ``beam.end`` or ``beam.at(0.5)``."""
        return self._point(label, "Model.point")

    @contextmanager
    def located(self, place: str) -> Iterator[None]:
        """Within this context, errors and time functions speak of `place`, such as ``supports[0]``."""
        before, self._place = self._place, place
        try:
            yield
        finally:
            self._place = before

    def _where(self, method: str, name: object, subject: object = None) -> str:
        if self._place:
            return self._place
        if isinstance(name, str):
            return f'{method}("{name}")'
        if isinstance(subject, Beam):
            return f"{method}({subject.name})"
        return f"{method}({subject})" if isinstance(subject, Point | str) else f"{method}()"

    def _body(self, body: object, where: str) -> Beam:
        if isinstance(body, Beam):
            if self.bodies.get(body.name) is not body:
                raise ModelError(where, f'body "{body.name}" belongs to another model')
            return body
        if not isinstance(body, str):
            raise ModelError(where, f"must be a body or its name, is {checks.shown(body)}")
        if body not in self.bodies:
            raise unknown(where, "body", body, self.bodies)
        return self.bodies[body]

    def _point(self, point: object, where: str) -> Point:
        if isinstance(point, Point):
            self._body(point.body, where)
            return point
        if not isinstance(point, str):
            hint = "such as beam.start, beam.end or beam.at(0.5)"
            raise ModelError(where, f"must be a point, is {checks.shown(point)}", hint)
        return parse_point(self.bodies, point, where)


def parse_point(bodies: dict[str, Beam], label: str, where: str = "point") -> Point:
    """Point written as ``beam.start``, ``beam.end`` or ``beam.at(0.5)``; ModelError if there is none."""
    name, place = split_label(label, where)
    if name not in bodies:
        raise unknown(where, "body", name, bodies)
    body = bodies[name]
    if isinstance(place, str):
        return body.start if place == "start" else body.end
    try:
        return body.at(place)
    except ModelError as error:
        raise ModelError(where, error.what, error.hint) from None
