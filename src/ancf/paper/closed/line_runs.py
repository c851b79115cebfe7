"""Pantographs along overhead lines beside what is known: hand-over, frequency response, another model."""

from __future__ import annotations

import json
import warnings
from dataclasses import replace
from importlib.resources import files
from typing import Any

import numpy as np

import ancf

from ... import catenary
from ...catenary.answers.signals import Butterworth
from ...model.bodies.rigid import PointMass
from ..check import Check

LENGTH, SPANS, SHARED = 40.0, 7, 4
#: Where the second of two tension lengths begins, and where both wires are level, m.
BEGIN = LENGTH * (SPANS - SHARED)
LEVEL = BEGIN + 2.0 * LENGTH
FORCE = 120.0  # N, that lifts the pantograph
MESH = catenary.Mesh(contact=2.0, messenger=3.0)
TRAINS = "plane_trains.json"


def checks() -> list[Check]:
    """Hand-over at an overlap, a fitted pantograph, both pantographs of trains."""
    found = catenary.form(overlap(), MESH)
    return [_handed_over(found), _momentum(found), *_fitted(), *_trains()]


def section(first: bool) -> catenary.Line:
    """A level line whose last support but one and last are raised, or its first two, beside the other one."""
    height, stagger = np.zeros(SPANS + 1), np.full(SPANS + 1, 0.1)
    height[:2] = 0.35, 0.06
    spans = [catenary.Span(length=LENGTH, droppers=tuple(LENGTH * np.arange(0.1, 1.0, 0.2)))] * SPANS
    return catenary.Line(
        spans=tuple(spans),
        contact_wire=catenary.Wire(EA=15e6, EI=195.0, mass=1.35, tension=20e3),
        messenger_wire=catenary.Wire(EA=11.6e6, EI=131.7, mass=1.07, tension=16e3),
        droppers=catenary.Droppers(stiffness=1e5),
        steady_arm=catenary.SteadyArm(vertical=300.0),
        system_height=1.2,
        height=tuple(height[::-1] if first else height),
        stagger=tuple(stagger if first else -stagger),
        damping=catenary.Rayleigh(alpha=0.0125, beta=1e-4),
        contact_support="free",
        anchors="tension",
    )


def overlap() -> catenary.Route:
    """Two level, identical wires that share a strip."""
    return catenary.Route(lines=(section(True), section(False)), starts=(0.0, BEGIN))


def collector(**given: Any) -> catenary.Pantograph:
    """The two masses of the reference model of 2002."""
    made: dict[str, Any] = {"masses": (15.0, 7.2), "stiffness": (50.0, 4200.0), "damping": (90.0, 10.0)}
    return catenary.Pantograph(**(made | {"static_force": FORCE} | given))


def _handed_over(found: catenary.RouteForm) -> Check:
    """Slowly, so that nothing vibrates."""
    reach = 20.0
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # the window is close to the start
        done = catenary.run(
            found,
            speed=3.0,
            pantograph=collector(damping=(200.0, 50.0)),
            step=4e-3,
            start=LEVEL - 30.0,
            window=(LEVEL - reach, LEVEL + reach),
            until=LEVEL + 30.0,
        )
    recording, mean = done.recordings[0], catenary.statistics(done)["mean_force"].value
    inside = np.abs(recording.position - LEVEL) < reach
    swing = float(np.abs(recording.force[inside] - mean).max()) / mean
    name = "Overhead line, overlap of two level wires: largest change of the force over Fm"
    return Check(name, swing, 0.0, 0.02, "", "what lifts the pantograph does not change")


def _momentum(found: catenary.RouteForm) -> Check:
    """The impulse of both contacts, of springs and dampers, beside the momentum of the masses."""
    overhead, speed, step = catenary.assemble(found), 20.0, 5e-4
    unit = collector(stiffness=(0.0, 4200.0))
    one = overhead.add_pantograph(unit, speed, start=LEVEL - 60.0)
    bodies = (overhead.model.bodies[f"pantograph mass {k}"] for k in (1, 2))
    masses = [body for body in bodies if isinstance(body, PointMass)]
    duration = 120.0 / speed
    sensors = ancf.simulate(
        overhead.model,
        t_end=duration,
        step=step,
        start=ancf.equilibrium(overhead.model),
        integrator=ancf.Trapezoidal(),
        sensors=[*one.sensors(), *masses],
        energy=False,
    ).sensors
    height = sensors.position(masses[0])[:, 2]
    faint = 0.1 * (height - height[0])  # of the spring that stands for none
    net = FORCE - sum(sensors.contact_force(meter) for meter in one.meters) - faint
    pushed = np.sum(0.5 * step * (net[1:] + net[:-1])) - unit.damping[0] * (height[-1] - height[0])
    changes = [np.diff(sensors.velocity(mass)[[0, -1], 2])[0] for mass in masses]
    gained = float(np.dot([mass.mass for mass in masses], changes))
    error = float(abs(gained - pushed)) / (FORCE * duration)
    name = "Overhead line, overlap: momentum gained less impulse of all forces, over that of the static force"
    return Check(name, error, 0.0, 1e-6, "", "balance of momentum")


def _fitted() -> list[Check]:
    frequency, found = np.linspace(0.25, 20.0, 80), []
    for name, unit in catenary.pantographs().items():
        if len(unit.masses) < 3:
            continue
        fit = catenary.identify_pantograph(
            frequency, _by_matrices(unit, frequency), kind="dynamic_stiffness", static_force=70.0
        )
        whole = f"Overhead line, pantograph fitted to the response of {name}: largest error, 0 to 20 Hz"
        origin = "matrices of the whole chain of masses"
        found.append(Check(whole, float(fit.largest), 0.0, 0.02, "", origin))
    return found


def _by_matrices(unit: catenary.Pantograph, frequency: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Dynamic stiffness at the head from the matrices of the whole chain, N/m."""
    n = len(unit.masses)
    below = np.eye(n) - np.eye(n, k=-1)
    K, C = (below.T @ np.diag(values) @ below for values in (unit.stiffness, unit.damping))
    w = 2.0 * np.pi * frequency[:, None, None]
    dynamic = K + 1j * w * C - w**2 * np.diag(unit.masses)
    made: np.ndarray[Any, Any] = 1.0 / np.linalg.inv(dynamic)[:, -1, -1]
    return made


def _trains() -> list[Check]:
    text = files("ancf.paper").joinpath("data", TRAINS).read_text(encoding="utf-8")
    data = json.loads(text)
    return [check for wanted in data["trains"] for check in _train(wanted, data["origin"])]


def _train(wanted: dict[str, Any], origin: str) -> list[Check]:
    """Fm and sigma of both pantographs on the default mesh."""
    line = catenary.read_line(wanted["line"])
    assert isinstance(line, catenary.Line)
    unit = catenary.find_pantograph(wanted["pantograph"])
    unit = replace(unit, static_force=wanted["force"], aerodynamic=0.0, relaxed_at="nominal")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # as short as the line can be
        done = catenary.run(
            line.excerpt(0, wanted["spans"]),
            speed=wanted["kmh"] / 3.6,
            pantograph=unit,
            spacing=wanted["spacing"],
            start=wanted["start"],
            window=tuple(wanted["window"]),
            until=wanted["window"][1] + 25.0,
        )
    found = []
    for k, which in enumerate(("first", "second")):
        values = catenary.statistics(done, k, Butterworth(4))
        for key, name in (("mean", "mean_force"), ("sigma", "deviation")):
            said = f"{wanted['line']}, {wanted['kmh']:g} km/h, {wanted['spacing']:g} m apart"
            whole = f"Overhead line, {said}: {values[name].name} of the {which} pantograph"
            exact = wanted[which][key]
            found.append(Check(whole, values[name].value, exact, 0.02 * exact, "N", origin))
    return found
