"""What tests of gradients compare them with: forward sensitivities, and differences of whole runs."""

import numpy as np

import ancf
from ancf.design.formulas import Formula
from ancf.design.gradient import OF_RUN, slopes_of
from ancf.model.vary import value_of
from ancf.viz.pictures.questions import ask
from slopes import extrapolated, once


def forward(model, text, names, **given):
    """The same by sensitivities that follow the run."""
    return followed(model, names, **given)(text)


def followed(model, names, **given):
    """A run with the sensitivities that follow it, as a function of formulas: each by these names."""
    result = ancf.simulate(model, sensitivities=names, **given)

    def of(text):
        _, slopes = slopes_of(Formula(text, "test", OF_RUN), result.t, result)
        return {
            name: sum(
                np.sum(x * result.sensitivity(name).answer(lambda f, p=pair: ask(f, *p)))
                for pair, x in slopes.items()
            )
            for name in names
        }

    return of


def apart(model, found, wanted):
    """Largest difference, each by the size of its parameter, relative to the largest derivative so."""
    size = {name: abs(value_of(model, name)) or 1.0 for name in found}
    largest = max(abs(wanted[name]) * size[name] for name in wanted)
    return max(abs(found[name] - wanted[name]) * size[name] for name in wanted) / largest


def differences(model, text, names, change=2e-2, **given):
    """By differences of whole runs, relative changes of that size at the most, extrapolated."""
    return {
        name: extrapolated(lambda m: ancf.gradient(m, text, [], **given)[0], model, name, change)
        for name in names
    }


def differences_of(model, names, change=2e-2, **given):
    """The same as a function of formulas, which share the runs."""
    run = once(lambda other: ancf.simulate(other, **given))

    def of(text):
        return {name: extrapolated(value_in(run, text), model, name, change) for name in names}

    return of


def value_in(run, text):
    """Value of a formula as a function of a model; ``run(model)`` is the result."""
    formula = Formula(text, "test", OF_RUN)

    def value(model):
        result = run(model)
        return slopes_of(formula, np.asarray(result.t), result)[0]

    return value
