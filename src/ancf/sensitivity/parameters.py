"""Parameters of sensitivities: names of numbers of a model, or functions that build it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Any

from ..errors import ModelError
from ..model import checks
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import PointMass, RigidBody
from ..model.joints.connections import Spring
from ..model.model import Model
from ..model.sections.section import DAMPINGS
from ..model.supports.winches import by_body
from ..model.vary import renewal
from ..system.beside import Acts
from .acts import WET, acts_of

#: Numbers of a section in which all forces of cables and beams are linear.
OF_SECTIONS = {"EA", "EI", "rhoA", "E", "rho", *DAMPINGS}
#: The same of a spring without a curve.
OF_SPRINGS = {"stiffness", "damping", "length"}


@dataclass(frozen=True)
class Named:
    """Builds a model with another value of one of its numbers.

    Parameters
    ----------
    model : Model
    name : str
        See :func:`ancf.model.vary.varied`.
    """

    model: Model
    name: str

    def __call__(self, value: float) -> Model:
        """The model with this value."""
        return self._found[1](value)

    @property
    def value(self) -> float:
        """The number now."""
        return self._found[0]

    @cached_property
    def _found(self) -> tuple[float, Callable[[float], Model]]:
        return renewal(self.model, self.name)

    def __reduce__(self) -> Any:
        """What makes models is found again elsewhere."""
        return Named, (self.model, self.name)


@dataclass(frozen=True)
class Parameter:
    """A number on which a model depends.

    Parameters
    ----------
    name : str
    value : float
        Its value in the model.
    build : callable
        ``build(value)`` is the model with another value.
    quadratic : bool
        What it builds is known to change by a polynomial of degree two: two values tell all.
    linear : bool
        All forces are known to be linear in it, and nothing else depends on it: one value tells all.
    kinked : bool
        Of one that is linear: there are kinks, between which it is.
    acts : Acts, optional
        What it acts on, besides the initial shape and motion, where that is known.
    """

    name: str
    value: float
    build: Callable[[float], Model]
    quadratic: bool = False
    linear: bool = False
    kinked: bool = False
    acts: Acts | None = None

    @property
    def named(self) -> bool:
        """Whether it is a number of the model by its name, which a file can keep."""
        return isinstance(self.build, Named)

    def at(self, value: float) -> Model:
        """The model with a value.

        Raises
        ------
        ModelError
            It cannot be built, or is none.
        """
        made = self.build(value)
        if not isinstance(made, Model):
            raise ModelError(
                self.name, f"build({value:g}) must return a Model, returned {checks.shown(made)}"
            )
        return made


def parameters_of(model: Model, given: Any, where: str) -> list[Parameter]:
    """Parameters as sensitivities are given them.

    Parameters
    ----------
    model : Model
    given : sequence or mapping
        Names of numbers of the model, or by name a pair (value, build).
    where : str
        For messages.

    Raises
    ------
    ModelError
        One is no number of the model, or stands twice.
    """
    if isinstance(given, Mapping):
        return [_built(name, item, f"{where}.{name}") for name, item in given.items()]
    given = checks.numbers_named(given, where)
    made: list[Parameter] = []
    kept = model.snapshot()
    for k, item in enumerate(given):
        found = item if isinstance(item, Parameter) else _named(kept, item, f"{where}[{k}]")
        if found.name in [one.name for one in made]:
            raise ModelError(f"{where}[{k}]", f'"{found.name}" stands there twice')
        made.append(found)
    return made


def check_known(start: Any, parameters: list[Parameter], where: str) -> None:
    """Raise ModelError if a state from which something begins does not know how it depends on a parameter."""
    for parameter in parameters:
        if parameter.name not in start.derivatives:
            what = f"the state that is given does not know how it depends on {parameter.name}"
            hint = "equilibrium(..., sensitivities=[...]), or state.fixed([...]) if it does not"
            raise ModelError(where, what, hint)


def _named(model: Model, name: Any, where: str) -> Parameter:
    """Of a model that stays as it is."""
    clean = checks.text(name, where)
    build = Named(model, clean)
    value = build.value
    spring, acts = _of_spring(model, clean), acts_of(model, clean)
    if spring is not None:
        return Parameter(clean, value, build, linear=True, kinked=spring.slack, acts=acts)
    still = all(fluid.waves is None for fluid in model.fluids)  # waves are as fast as gravity makes them
    around = acts is not None and clean.startswith("gravity") and still
    linear = _of_body(model, clean) or around or _of_fluid(model, clean)
    return Parameter(clean, value, build, linear=linear, acts=acts)


def _of_spring(model: Model, name: str) -> Spring | None:
    """Of a number in which a spring's force is linear, as long as it does not slacken, the spring."""
    owner, _, key = name.rpartition(".")
    for one in model.connections:
        if isinstance(one, Spring) and one.name == owner and key in OF_SPRINGS:
            return one if one.law is None and one.damper is None else None
    return None


def _of_body(model: Model, name: str) -> bool:
    """Whether forces are linear in a number: stiffnesses, masses and dampings of a body without a winch."""
    owner, _, key = name.rpartition(".")
    body = model.bodies.get(owner)
    if isinstance(body, Beam):
        return key in OF_SECTIONS and owner not in by_body(model)
    return isinstance(body, PointMass | RigidBody) and key == "mass"


def _of_fluid(model: Model, name: str) -> bool:
    """Whether forces are linear in a number: the density of a fluid, drag and added mass of a beam."""
    owner, _, key = name.partition("[")[0].rpartition(".")
    if isinstance(model.bodies.get(owner), Beam):
        return key in WET and owner not in by_body(model)
    return key == "density" and any(fluid.name == owner for fluid in model.fluids)


def _built(name: Any, given: Any, where: str) -> Parameter:
    pair = isinstance(given, tuple | list) and len(given) == 2 and checks.is_function(given[1])
    if isinstance(given, Parameter):
        return given
    if not pair:
        raise ModelError(where, f"must be a pair (value, build), is {checks.shown(given)}")
    return Parameter(checks.text(name, where), checks.number(given[0], where), given[1])
