"""Classes whose unknown names say what does it here: ``Waves.airy`` is answered by ``Waves.regular(...)``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from .other_words import OF_CLASSES, hint_of


class Told(type):
    """Class of such classes; of their objects an unknown name is what it always is."""

    if not TYPE_CHECKING:  # a misspelled name is an error

        def __getattr__(cls, name: str) -> Any:
            """Raise AttributeError, with what does it here if that is known."""
            said = f"{cls.__name__} has no attribute {name!r}"
            hint = "" if name.startswith("_") else hint_of(name, OF_CLASSES.get(cls.__name__, {}))
            raise AttributeError(f"{said}: {hint}" if hint else said, name=name, obj=cls)
