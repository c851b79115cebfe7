"""Derivatives of steps, forwards by eight parameters abreast and backwards by the adjoint."""
