"""Which bodies a connection touches."""

from __future__ import annotations

from ancf.model.connections import Connection
from ancf.model.contact import Contact
from ancf.model.joints import Fixation, Slide
from ancf.model.points import Point


def bodies_of(connection: Connection) -> list[str]:
    """Names of the bodies that a connection touches."""
    if isinstance(connection, Fixation):
        return [connection.point.body.name, connection.to.name]
    if isinstance(connection, Slide):
        own = [connection.point.body.name] if isinstance(connection.point, Point) else []
        return [*own, connection.carrier.name]
    if isinstance(connection, Contact):
        return [connection.point.body.name, connection.carrier.name]
    return [end.body.name for end in (connection.a, connection.b) if isinstance(end, Point)]


def to_ground(connection: Connection) -> bool:
    """Whether one end of a connection is a fixed position."""
    if isinstance(connection, Fixation | Contact):
        return False
    end = connection.point if isinstance(connection, Slide) else connection.b
    return not isinstance(end, Point)
