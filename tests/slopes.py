"""Derivatives by extrapolated differences, and Taylor remainders, that tests of sensitivities share."""

import json

import numpy as np

from ancf.model.vary import value_of, varied
from ancf.paper import differences
from ancf.sensitivity.adjoint_sloped import SlopedAdjoint


def once(function):
    """The same function of a model, which is computed once for models with one description."""
    found = {}

    def of(model):
        key = json.dumps(model.to_dict())
        if key not in found:
            found[key] = function(model)
        return found[key]

    return of


def extrapolated(function, model, name, step=1e-2, levels=5):
    """Derivative of function(model) by a number of the model: central differences, extrapolated (Romberg)."""
    return differences.extrapolated(function, model, name, step, levels)


def off(found, wanted):
    """Largest difference, relative to the largest number."""
    return float(np.max(np.abs(found - wanted)) / np.max(np.abs(wanted)))


def remainder_slopes(function, model, name, derivative, step=0.02, noise=1e-13):
    """Orders with which |f(p + h) - f(p) - h f'| falls over three decades of h.

    Empty if it is round-off from the start: the function is linear in p.
    """
    p = value_of(model, name)
    unit = abs(p) if p else 1.0
    here, left = np.asarray(function(model)), []
    scale = np.max(np.abs(here)) + np.max(np.abs(derivative)) * step * unit
    for h in step * unit * np.array([1.0, 0.1, 0.01, 0.001]):
        there = np.asarray(function(varied(model, name, p + h)))
        left.append(np.max(np.abs(there - here - h * np.asarray(derivative))))
    if left[0] <= 1e4 * noise * scale:
        return np.zeros(0)
    good = np.array(left) > 10 * noise * scale
    return np.log10(np.array(left)[:-1] / np.array(left)[1:])[good[1:]]


def counted_corrections(monkeypatch):
    """Fills with corrections so far and steps, by block, as adjoints of forces with slopes go back."""
    counts, back = [], SlopedAdjoint._back

    def counted(self, way, *given):
        status = back(self, way, *given)
        counts.append((self._corrections[0], len(way.q)))
        return status

    monkeypatch.setattr(SlopedAdjoint, "_back", counted)
    return counts
