"""Forces of fluids as the theory page has them, for tests: random flows, waves, gusts, Morison's formula."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

import ancf

Flow = Callable[[float, Any], Any]


def rate(f: Callable[[float], Any], t: float, h: float = 1e-3) -> Any:
    """Derivative by differences of fourth order."""
    return (8 * (f(t + h) - f(t - h)) - (f(t + 2 * h) - f(t - 2 * h))) / (12 * h)


def random_flow(rng: Any, kind: str) -> tuple[Any, Flow, Flow]:
    """A velocity as a model takes it, and as functions of t and place: itself, a particle's acceleration."""
    c, w = rng.standard_normal(3), rng.uniform(1, 4)
    if kind == "constant":
        return tuple(c), lambda t, r: c, lambda t, r: np.zeros(3)
    if kind == "of time":
        return (
            lambda t: tuple(c * np.sin(w * t)),
            lambda t, r: c * np.sin(w * t),
            lambda t, r: c * w * np.cos(w * t),
        )
    if kind == "profile":
        z, v = np.sort(rng.uniform(-2, 2, 4)), rng.standard_normal((4, 3))

        def profile(t: float, r: Any) -> Any:
            return np.array([np.interp(r[2], z, v[:, i]) for i in range(3)])

        def shear(t: float, r: Any) -> Any:
            k = np.searchsorted(z, r[2])
            slope = (v[k] - v[k - 1]) / (z[k] - z[k - 1]) if 0 < k < len(z) else np.zeros(3)
            return slope * profile(t, r)[2]

        return {"z": z, "velocity": v}, profile, shear
    a, b, e, f = rng.uniform(0.2, 1, 4).round(3).tolist()
    given = [f"{a}*sin({b}*x+t)*cos({e}*z)", f"{f}*y*t", f"{a}*exp({b}*z/4)*cos(2*t)+0.1*x"]

    def law(t: float, r: Any) -> Any:
        x, y, z = r
        u = a * np.sin(b * x + t) * np.cos(e * z), f * y * t, a * np.exp(b * z / 4) * np.cos(2 * t) + 0.1 * x
        return np.array(u)

    return given, law, lambda t, r: rate(lambda s: law(s, r + (s - t) * law(t, r)), t)


def grown(t: float, ramp: float) -> float:
    """3 tau^2 - 2 tau^3."""
    tau = min(max(t / ramp, 0.0), 1.0) if ramp > 0.0 else 1.0
    return 3 * tau**2 - 2 * tau**3


def airy(waves: ancf.Waves, t: float, r: Any, level: float, g: float) -> tuple[Any, Any, float]:
    """Velocity, its rate at the fixed height z', and the rise of the surface."""
    amplitude, omega, h = waves.amplitude, waves.omega, waves.depth
    k = waves.numbers(g)
    assert np.allclose(omega**2, g * k * np.tanh(np.minimum(k * h, 50.0)), rtol=1e-10)
    along = np.array([np.cos(waves.direction), np.sin(waves.direction), 0.0])

    def phase(t: float) -> Any:
        return k * (along @ r) - omega * t + waves.phase

    rise = grown(t, waves.ramp) * float(np.sum(amplitude * np.cos(phase(t))))
    z = r[2] - level
    if waves.stretching == "wheeler":
        z = z - rise if math.isinf(h) else h * (z - rise) / (h + rise)
    z = min(z, 0.0)
    if math.isinf(h):
        ch = sh = np.exp(k * z)
    else:
        z = max(z, -h)
        ch, sh = (f(k * (z + h)) / np.sinh(k * h) for f in (np.cosh, np.sinh))

    def velocity(t: float) -> Any:
        u = np.sum(amplitude * omega * ch * np.cos(phase(t))) * along
        u[2] = np.sum(amplitude * omega * sh * np.sin(phase(t)))
        return grown(t, waves.ramp) * u

    return velocity(t), rate(velocity, t), rise


def gust(gusts: ancf.Gusts, t: float, r: Any) -> tuple[Any, Any]:
    """Velocity and its rate: linear between stations, a cubic with the slopes of the neighbours in time."""
    v, table = gusts.values, gusts.table
    place = np.clip(v["line"] @ r, gusts.stations[0], gusts.stations[-1])

    def speed(t: float) -> float:
        i, s = divmod(t / v["step"], 1.0)
        a, b, c, d = (table[(int(i) + j) % len(table)] for j in (-1, 0, 1, 2))
        m, n = (c - a) / 2, (d - b) / 2
        y = b + m * s + (3 * (c - b) - 2 * m - n) * s**2 + (2 * (b - c) + m + n) * s**3
        return grown(t, v["ramp"]) * float(np.interp(place, gusts.stations, y))

    way = np.array([np.cos(v["direction"]), np.sin(v["direction"]), 0.0])
    return speed(t) * way, rate(speed, t, 1e-4) * way


def morison(section: Any, density: float, g: Any, t: Any, past: Any, flow: Any, own: Any) -> Any:
    """Force per reference length at a unit tangent t; accelerations of the flow and of the point."""
    d, (dn, dt) = section.diameter, section.drag
    mn, mt = section.added_mass or (0.0, 0.0)
    along, area = np.outer(t, t), np.pi * d**2 / 4
    across = np.eye(3) - along
    n, s = across @ past, past @ t
    drag = 0.5 * density * d * (dn * np.linalg.norm(n) * n + np.pi * dt * abs(s) * s * t)
    added = mn * across + mt * along
    return drag + density * area * (flow - g + added @ (flow - own))


def on_body(body: Any, density: float, g: Any, past: Any, flow: Any, own: Any) -> Any:
    """Force at a point mass or at the centre of a rigid body."""
    drag = 0.5 * density * body.drag_area * np.linalg.norm(past) * past
    return drag + density * body.volume * (flow - g + body.added_mass * (flow - own))


def inside(middle: float, tall: float, low: float, high: float) -> float:
    """Share of what fills a height evenly between two surfaces."""
    return max(0.0, min(middle + tall / 2, high) - max(middle - tall / 2, low)) / tall
