"""Ropes on drums and pulleys computed and compared with closed forms."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from .. import validation
from ..catenary.answers.quantity import Quantity
from ..validation import Group, Progress
from . import belt, cases

CASE = "contact"
TITLE = "Ropes on drums and pulleys against closed forms"
#: Coefficients of friction and turns of the capstan.
FRICTIONS, TURNS = (0.05, 0.2, 0.5), (0.25, 1.0, 2.0)
LOADS, LOWER_ENDS, INERTIAS = (100.0, 3000.0), (0.1, 0.3), (0.01, 0.2)
#: And of cables that touch.
THROWN = (0.0, 0.3)
#: Shares of the reference within which a quantity counts as reproduced; of the work in 1e-6.
OF_CAPSTAN, OF_LINE, OF_SPEED, OF_WORK, OF_BELT = 1e-2, 1e-3, 5e-3, 1.0, 1e-2
#: Rows of the belt: what is computed, the theory's number of it, unit.
BELT = (
    ("tight", "tight", "N"),
    ("slack", "slack", "N"),
    ("driven", "driven", "rad/s"),
    ("torque driving", "torque", "N m"),
    ("torque driven", "torque", "N m"),
    ("slip driving", "slip", "rad"),
    ("slip driven", "slip", "rad"),
    ("stick driving", "stick", "rad"),
    ("stick driven", "stick", "rad"),
)
BELT_NAMES = {
    "tight": "belt force, tight",
    "slack": "belt force, slack",
    "driven": "speed of the driven pulley",
    "torque driving": "torque in",
    "torque driven": "torque out",
    "slip driving": "slip arc, driving",
    "slip driven": "slip arc, driven",
    "stick driving": "stick arc, driving",
    "stick driven": "stick arc, driven",
}


def compare(progress: Progress | None = None) -> list[Group]:
    """Compute all cases beside their closed forms; ``progress(done, of)`` is called after each."""
    count = len(FRICTIONS) * len(TURNS) + len(LOADS) + len(LOWER_ENDS) + len(INERTIAS) + len(THROWN) + 2
    done = 0

    def told(rows: list[Quantity]) -> list[Quantity]:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, count)
        return rows

    def group(title: str, source: str, makers: list[Callable[[], list[Quantity]]]) -> Group:
        return Group(title, source, [row for make in makers for row in told(make())])

    return [
        group(
            "Capstan",
            "Euler and Eytelwein: the force that holds is T exp(-mu phi); two turns as a helix",
            [lambda mu=mu, n=n: _capstan(mu, n) for mu in FRICTIONS for n in TURNS],  # type: ignore[misc]
        ),
        group(
            "Half a turn without friction",
            "balance of a piece of rope on a circle: T/R per length",
            [lambda load=load: _line_load(load) for load in LOADS],  # type: ignore[misc]
        ),
        group(
            "A heavy rope over a drum without friction",
            "T - w z is the same all along",
            [lambda low=low: _hung_over(low) for low in LOWER_ENDS],  # type: ignore[misc]
        ),
        group(
            "Two masses over a pulley that friction turns, 0.5 ms",
            "Atwood's machine with the moment of inertia of the pulley; energy: what is supplied is there",
            [lambda inertia=inertia: _pulley(inertia) for inertia in INERTIAS],  # type: ignore[misc]
        ),
        group(
            "One cable thrown over another one, 2 µs",
            "nothing from outside: momentum, angular momentum, and energy with what friction took",
            [lambda mu=mu: _thrown(mu) for mu in THROWN],  # type: ignore[misc]
        ),
        group(
            "A hoist: a motor, a drum, a sheave and a load, 1 ms",
            "the work of the motor is what the load has gained, what moves, and what friction has taken",
            [_hoist],
        ),
        group(
            f"A belt on two pulleys, {1e3 * belt.STEP:g} ms, {belt.STEP / belt.PEER_STEP:g} times the peer's",
            "creep theory of Reynolds and Euler; drive of Ntarladima, Pieber and Gerstmayr (2023)",
            [_belt],
        ),
    ]


def _capstan(friction: float, turns: float) -> list[Quantity]:
    ratio, wanted = cases.capstan(friction, turns)
    name = f"T2/T1, mu = {friction:g}, {turns:g} turn{'s' if turns > 1.0 else ''}"
    return [_row("ratio", name, "-", ratio, wanted, OF_CAPSTAN)]


def _line_load(load: float) -> list[Quantity]:
    found, wanted = cases.line_load(load)
    return [_row("line load", f"line load, T = {load:g} N", "N/m", found, wanted, OF_LINE)]


def _hung_over(low: float) -> list[Quantity]:
    found, wanted = cases.hung_over(low)
    name = f"difference of the ends over w h, h = {0.5 - low:g} m"
    return [_row("difference", name, "-", found / wanted, 1.0, OF_LINE)]


def _pulley(inertia: float) -> list[Quantity]:
    found = cases.pulley(inertia)
    name = f"moment of inertia {inertia:g} kg m^2"
    return [
        _row("speed", f"speed over that without stretch, {name}", "-", found["speed"], 1.0, OF_SPEED),
        Quantity(
            "drift", f"drift over work, {name}", "1e-6", 1e6 * found["drift"], None, OF_WORK, "invariant"
        ),
    ]


def _thrown(friction: float) -> list[Quantity]:
    found, name = cases.thrown(friction), f"mu = {friction:g}"
    rows = ("momentum", "1e-9", 1e9), ("angular", "1e-9", 1e9), ("drift", "1e-6", 1e6)
    words = {
        "momentum": "change of momentum",
        "angular": "change of angular momentum",
        "drift": "drift of energy",
    }
    return [
        Quantity(key, f"{words[key]}, {name}", unit, many * found[key], None, OF_WORK, "invariant")
        for key, unit, many in rows
    ]


def _hoist() -> list[Quantity]:
    drift = cases.hoist()
    name = "work in less work out and friction, over work in"
    return [Quantity("account", name, "1e-6", 1e6 * drift, None, OF_WORK, "invariant")]


def _belt() -> list[Quantity]:
    found = belt.run()
    return [
        _row(key, BELT_NAMES[key], unit, found[key], found[f"theory {theory}"], OF_BELT)
        for key, theory, unit in BELT
    ]


def _row(key: str, name: str, unit: str, value: float, wanted: float, share: float) -> Quantity:
    within = share * wanted
    return Quantity(key, name, unit, value, wanted - within, wanted + within, "closed form")


def write(groups: list[Group], folder: Path, report: bool = True) -> list[Path]:
    """Write ``validate.json`` and, if wanted, ``report.html``; returns the files."""
    return validation.write(CASE, TITLE, groups, folder, report)
