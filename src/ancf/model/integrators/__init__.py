"""Time integrators as settings, one file per method; a new one is its file and a line here."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ...errors import ModelError
from .. import checks
from .base import FORMULATIONS, Coefficients, Integrator, NewmarkFamily
from .explicit import Explicit
from .generalized_alpha import GeneralizedAlpha
from .newton import Newton
from .radau import Radau
from .trapezoidal import Trapezoidal

__all__ = [
    "FORMULATIONS",
    "INTEGRATORS",
    "Coefficients",
    "Explicit",
    "GeneralizedAlpha",
    "Integrator",
    "NewmarkFamily",
    "Newton",
    "Radau",
    "Trapezoidal",
    "integrator_from",
    "integrator_of",
    "table_schema",
]

#: The integrators by the name that a model file uses.
INTEGRATORS: dict[str, type[Integrator]] = {
    kind.name: kind for kind in (Trapezoidal, GeneralizedAlpha, Radau, Explicit)
}


def integrator_of(given: Any) -> Integrator:
    """The integrator that a model file asks for, by a name alone or a table with the key ``type``.

    Raises
    ------
    ModelError
        There is no such method or setting, or a value is out of range; ``where`` begins with ``integrator``.
    """
    if isinstance(given, str):
        return INTEGRATORS[checks.choice(given, "integrator", tuple(INTEGRATORS))]()
    if not isinstance(given, dict):
        what = f"must be a name or a table with type, is {checks.shown(given)}"
        raise ModelError("integrator", what)
    owners = _owners()
    for key in given:
        if key not in ("type", *owners):
            allowed = ["type", *owners]
            what = f"unknown key, allowed: {checks.listed(allowed)}"
            raise ModelError(f"integrator.{key}", what, checks.nearest(key, allowed))
    if "type" not in given:
        raise ModelError("integrator.type", f"is missing, must be one of {checks.listed(list(INTEGRATORS))}")
    kind = INTEGRATORS[checks.choice(given["type"], "integrator.type", tuple(INTEGRATORS))]
    options = {key: value for key, value in given.items() if key != "type"}
    for key in options:
        if kind.name not in owners[key]:
            what = f"is a setting of {' and '.join(owners[key])}, not of {kind.name}"
            raise ModelError(f"integrator.{key}", what)
    try:
        return kind(**options)
    except ModelError as error:
        place = error.where.removeprefix(kind.__name__)
        raise ModelError(f"integrator{place}", error.what, error.hint) from None


def integrator_from(name: str, settings: Mapping[str, Any]) -> Integrator:
    """The integrator of these settings, all fields by name, as a result keeps them.

    Raises
    ------
    ModelError
        There is no such method, or it has other settings.
    """
    kind = INTEGRATORS[checks.choice(name, "integrator", tuple(INTEGRATORS))]
    given = {key: Newton(**value) if key == "newton" else value for key, value in settings.items()}
    try:
        return kind(**given)
    except TypeError as error:
        raise ModelError("integrator", f"{name} has other settings here: {error}") from None


def table_schema() -> dict[str, Any]:
    """JSON Schema of the table of an integrator in a model file."""
    properties: dict[str, Any] = {"type": {"enum": list(INTEGRATORS), "description": "Kind of integrator."}}
    for key, names in _owners().items():
        about = dict(INTEGRATORS[names[0]].options()[key].metadata)
        what = about.pop("description")
        properties[key] = {**about, "description": f"Of {' and '.join(names)}: {what[0].lower()}{what[1:]}"}
    return {"type": "object", "properties": properties, "required": ["type"], "additionalProperties": False}


def _owners() -> dict[str, list[str]]:
    """Methods by the settings that they have in a file."""
    found: dict[str, list[str]] = {}
    for name, kind in INTEGRATORS.items():
        for key in kind.options():
            found.setdefault(key, []).append(name)
    return found
