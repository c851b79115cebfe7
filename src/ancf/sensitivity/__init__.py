"""Exact derivatives of equilibria, runs and modes by numbers of a model: docs/theory/sensitivities.md."""
