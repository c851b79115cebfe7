"""One number of a run as a function of parameters: the model that goes with values, and its derivatives."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from ..errors import ModelError, SolveError
from ..model import checks
from ..model.model import Model
from ..model.vary import value_of, varied
from ..sensitivity.parameters import Parameter
from .gradient import gradient


class Numbers:
    """Numbers of runs of a model with other parameters.

    Parameters
    ----------
    model : Model or callable
        With the parameters as names of its numbers, or ``build(**parameters)`` returns the model.
    names : sequence of str
        Of the parameters.
    settings : mapping
        t_end, step and integrator of :func:`ancf.gradient`.
    begin : function, optional
        ``begin(model, sensitivities=...)`` is the state from which a run starts.
    where : str
        For messages.

    Raises
    ------
    ModelError
        The model is none, or has no such numbers.
    """

    def __init__(
        self, model: Any, names: Sequence[str], settings: Mapping[str, Any], begin: Any, where: str
    ) -> None:
        self.model, self.names, self.settings = model, list(names), dict(settings)
        self.begin, self.where = begin, where
        if not isinstance(model, Model) and not checks.is_function(model):
            what = f"must be a Model or a function that builds one, is {checks.named(model)}"
            raise ModelError(f"{where}.model", what)
        if isinstance(model, Model):
            for name in self.names:
                value_of(model, name)

    def at(
        self, text: str, values: Mapping[str, float], slope: bool = True
    ) -> tuple[float, dict[str, float]]:
        """A number with these values of the parameters and, if asked for, its derivatives by them.

        Raises
        ------
        ModelError
            As of :func:`ancf.gradient`, or a function builds no model.
        SolveError
            The run fails; the message says with which values.
        """
        model = self._model(values)
        wanted = self._parameters(model, dict(values)) if slope else []
        first = None if self.begin is None else self.begin(model, sensitivities=wanted)
        try:
            return gradient(model, text, wanted, start=first, **self.settings)
        except SolveError as error:
            error.advise("with " + ", ".join(f"{name} = {x:.6g}" for name, x in values.items()))
            raise

    def _model(self, values: Mapping[str, float]) -> Model:
        if isinstance(self.model, Model):
            made = self.model
            for name, x in values.items():
                made = varied(made, name, x)
            return made
        built = self.model(**values)
        if not isinstance(built, Model):
            raise ModelError(f"{self.where}.model", f"must return a Model, returned {checks.shown(built)}")
        return built

    def _parameters(self, model: Model, values: dict[str, float]) -> Any:
        """As ``parameters`` of a gradient; a factor that the model has already is 1 again."""
        known = isinstance(self.model, Model)
        return [
            name if known and value_of(model, name) == x else Parameter(name, x, self._along(name, values))
            for name, x in values.items()
        ]

    def _along(self, name: str, values: dict[str, float]) -> Callable[[float], Model]:
        return lambda x: self._model(values | {name: x})
