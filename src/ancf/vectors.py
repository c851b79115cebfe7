"""Vectors of three numbers in kernels."""

from __future__ import annotations

from typing import Any

from .compiled import formula


@formula
def dot(a: Any, b: Any) -> Any:
    """Scalar product."""
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


@formula
def cross(a: Any, b: Any) -> Any:
    """Vector product."""
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


@formula
def both(f: Any, x: Any, g: Any, y: Any) -> Any:
    """f x + g y."""
    return f * x[0] + g * y[0], f * x[1] + g * y[1], f * x[2] + g * y[2]


@formula
def plus(x: Any, w: Any, q: Any, i: Any) -> Any:
    """x plus w times the vector at ``q[i]``."""
    return x[0] + w * q[i], x[1] + w * q[i + 1], x[2] + w * q[i + 2]


@formula
def without(x: Any, u: Any) -> Any:
    """x without its part along u, which is a unit vector or zero."""
    d = dot(u, x)
    return x[0] - d * u[0], x[1] - d * u[1], x[2] - d * u[2]
