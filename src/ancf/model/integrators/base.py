"""What every integrator is: frozen settings with a name, and the run that carries it out."""

from __future__ import annotations

from dataclasses import Field, asdict, dataclass, field, fields
from typing import Any, ClassVar, NamedTuple

from .newton import Newton

#: How joints with multipliers are kept: by their second derivatives (Baumgarte), their first ones, these with
#: the positions corrected (Gear, Gupta & Leimkuhler), the positions.
FORMULATIONS = ("index1", "index2", "ggl", "index3")


def option(default: Any, description: str, **schema: Any) -> Any:
    """A setting that a model file may give too; `schema` is what JSON Schema says of its values."""
    return field(default=default, metadata={"description": description, **schema})


@dataclass(frozen=True)
class Integrator:
    """A method with its settings; nothing of it computes.

    Attributes
    ----------
    name : str
        In a model file.
    runner : str
        ``module:Class`` in ``ancf.solvers`` that takes the steps.
    """

    name: ClassVar[str]
    runner: ClassVar[str]

    @classmethod
    def options(cls) -> dict[str, Field[Any]]:
        """Settings that a model file may give, by key: those made by :func:`option`."""
        return {item.name: item for item in fields(cls) if "description" in item.metadata}

    def settings(self) -> dict[str, Any]:
        """All that a result keeps of the method, plain values by name."""
        return {self.name: asdict(self)}


class Coefficients(NamedTuple):
    """Of the Newmark family, see :mod:`ancf.solvers.newmark`."""

    beta: float
    gamma: float
    alpha_m: float
    alpha_f: float


def formulation(default: str) -> Any:
    """The setting ``formulation`` of a method of the Newmark family."""
    return option(default, "How joints with multipliers are kept.", enum=list(FORMULATIONS))


class NewmarkFamily(Integrator):
    """A method of the Newmark family with its Newton settings and its formulation of constraints.

    A new one is a dataclass with `name`, the two fields and :meth:`coefficients`.
    """

    runner: ClassVar[str] = "stepping:Run"
    newton: Newton
    formulation: str

    def coefficients(self) -> Coefficients:
        """Coefficients of the method."""
        raise NotImplementedError

    def settings(self) -> dict[str, Any]:
        """Coefficients and Newton's settings."""
        scheme = self.coefficients()._asdict()
        return {"scheme": scheme, "newton": asdict(self.newton), "formulation": self.formulation}
