"""Which bodies a connection touches."""

from __future__ import annotations

from ..kind import body_of
from ..kinds import kind_of
from ..loads.load import Load
from .connections import Connection


def bodies_of(connection: Connection | Load) -> list[str]:
    """Names of the bodies that a connection or a load touches."""
    bodies = map(body_of, kind_of(connection).ends_of(connection))
    return [body.name for body in bodies if body is not None]


def to_ground(connection: Connection) -> bool:
    """Whether one end of a connection is a fixed position."""
    return any(body_of(end) is None for end in kind_of(connection).ends_of(connection))
