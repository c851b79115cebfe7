"""The summary of a run: a dict for scripts, and the table that is printed from it."""

from __future__ import annotations

import math
from collections.abc import Collection
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import __version__
from ..errors import ModelError, SolveError
from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body
from ..model.file import Study
from ..model.model import Model
from .screen import table

if TYPE_CHECKING:
    from rich.console import Console

    from .. import Result, State

ENERGIES = ("kinetic", "strain", "potential", "dissipated", "supplied", "total")


def summarise(
    study: Study, path: Path, result: Result, seconds: dict[str, float], error: BaseException | None
) -> dict[str, Any]:
    """Everything worth keeping of a run, ready for JSON."""
    from ..results import slackness
    from ..results.tension import compressions
    from ..results.wavering import waverings

    model = study.model
    still = study.simulation is None
    state, counters = result.state(), result.stats.as_dict()
    waver = {item.body for item in waverings(state if still else result)}
    summary: dict[str, Any] = {
        "title": study.title,
        "model_file": str(path),
        **({"set": dict(study.values)} if study.values else {}),
        "status": result.status,
        "kind": "equilibrium" if still else "simulation",
        "model": sizes(model),
        "settings": settings(study),
        "t": float(result.t[-1]),
        "stored_times": len(result.t),
        "outputs": {label: at_point(model, state, label, waver) for label in outputs(study)},
        "energy": energies(result),
        "compression": [item.as_dict() for item in compressions(result)],
        "slack": [item.as_dict() for item in slackness.of_ropes(result)],
        "notes": state.notes if still else result.notes,
        "counters": {key: value for key, value in counters.items() if key != "cpu_seconds"},
        "versions": {**result.provenance.get("versions", {}), "ancf": __version__},
        **seconds,
    }
    if isinstance(error, ModelError | SolveError):
        summary["error"] = {"where": error.where, "what": error.what, "hint": error.hint}
    return summary


def sizes(model: Model) -> dict[str, Any]:
    """Counts of a model."""
    return {
        "bodies": len(model.bodies),
        "elements": sum(beam.elements for beam in model.beams.values()),
        "nodes": node_count(model),
        "supports": len(model.supports),
        "loads": len(model.loads),
        "connections": len(model.connections),
        "mass": total_mass(model),
    }


def node_count(model: Model) -> int:
    """Nodes of all bodies; a point mass or a rigid body is one."""
    return sum(body.elements + 1 if isinstance(body, Beam) else 1 for body in model.bodies.values())


def total_mass(model: Model) -> float:
    """Mass of all bodies, kg."""
    return sum(mass(body) for body in model.bodies.values())


def mass(body: Body) -> float:
    """Mass of a body, kg."""
    return body.section.rhoA * body.length if isinstance(body, Beam) else body.mass


def settings(study: Study) -> dict[str, Any]:
    """Settings of the simulation and the equilibrium, without what was not given."""
    given: dict[str, Any] = {}
    for name, part in (("simulation", study.simulation), ("equilibrium", study.equilibrium)):
        if part is not None:
            given[name] = asdict(part)
    return given


def outputs(study: Study) -> list[str]:
    """Points to print: those that the file names, otherwise those of the first bodies.

    Of a beam start, middle and end, of a rigid body the centre of mass.
    """
    if study.simulation is not None and study.simulation.outputs:
        return list(study.simulation.outputs)
    from ..results.overview import shown_points

    return [str(point) for point in shown_points(study.model)]


def at_point(model: Model, state: State, label: str, waver: Collection[str] = ()) -> dict[str, Any]:
    """State at a point, and what holds it; only a beam or cable has a tension.

    `waver` are the cables whose forces waver within elements: their tensions at points are not to be trusted.
    """
    point = model.point(label)
    held = [support.name for support in model.supports if support.point == point]
    return {
        "position": [float(x) for x in state.position(point)],
        "velocity": [float(x) for x in state.velocity(point)],
        "tension": float(state.tension(point)) if isinstance(point.body, Beam) else None,
        "tension_wavers": point.body.name in waver,
        "support": held[0] if held else None,
    }


def energies(result: Result) -> dict[str, Any]:
    """Energies at the first and last stored time, and the drift of their balance, J."""
    energy = result.energy
    series = {name: np.asarray(getattr(energy, name)) for name in ENERGIES}
    ends = {key: {n: float(x[i]) for n, x in series.items()} for key, i in (("start", 0), ("end", -1))}
    drift = np.asarray(energy.drift)
    return {**ends, "balance_drift": float(np.max(np.abs(drift))), "balance_drift_end": float(drift[-1])}


def print_summary(to: Console, summary: dict[str, Any]) -> None:
    """Print what was computed, the outputs, the energies and the cost."""
    to.print(
        f"{summary['title'] or summary['model_file']}: {summary['status']}", style="bold", soft_wrap=True
    )
    to.print(_what(summary), soft_wrap=True)
    to.print()
    to.print(_point_table(summary))
    if any(value["tension_wavers"] for value in summary["outputs"].values()):
        to.print("~ wavers within elements that are long for how they bend: see the note", soft_wrap=True)
    if summary["kind"] == "simulation":
        to.print()
        to.print(_energy(summary["energy"]))
    to.print()
    for note in summary["notes"]:
        to.print(f"note: {note}", soft_wrap=True)
    to.print(_cost(summary), soft_wrap=True)


def _what(summary: dict[str, Any]) -> str:
    size = summary["model"]
    parts = [plural(size["bodies"], "body", "bodies"), plural(size["elements"], "element")]
    if summary["kind"] == "simulation":
        step = summary["settings"]["simulation"]["step"]
        parts += [f"{summary['counters']['steps']} steps of {step:g} s", f"t = {summary['t']:g} s"]
    return ", ".join(parts)


def _point_table(summary: dict[str, Any]) -> Any:
    moving = summary["kind"] == "simulation"
    last = "speed [m/s]" if moving else "support"
    made = table("point", "x [m]", "y [m]", "z [m]", "tension [N]", last)
    for label, value in summary["outputs"].items():
        speed = f"{math.hypot(*value['velocity']):.6g}"
        place = [coordinate(x, value["position"]) for x in value["position"]]
        end = speed if moving else value["support"] or ""
        doubt = "~" if value["tension_wavers"] else ""
        tension = "" if value["tension"] is None else f"{doubt}{value['tension']:.6g}"
        made.add_row(label, *place, tension, end)
    return made


def _energy(energy: dict[str, Any]) -> Any:
    made = table("energy [J]", *ENERGIES)
    rows = {key: [energy[key][name] for name in ENERGIES] for key in ("start", "end")}
    noise = 1e-15 * max(abs(x) for row in rows.values() for x in row)
    for key, row in rows.items():
        made.add_row(key, *[f"{x if abs(x) > noise else 0.0:.6g}" for x in row])
    from ..results.accuracy import at_most

    drift = at_most(energy["balance_drift"], energy["balance_drift_end"])
    made.add_row("drift", *[""] * (len(ENERGIES) - 1), drift)
    return made


def _cost(summary: dict[str, Any]) -> str:
    count = summary["counters"]
    parts = [
        plural(count["newton_iterations"], "Newton iteration"),
        plural(count["jacobians"], "Jacobian"),
    ]
    if count.get("retries"):
        parts.append(plural(count["retries"], "retry", "retries"))
    parts.append(f"{summary['cpu_seconds']:.3g} s CPU of the solve, {summary['wall_seconds']:.3g} s in all")
    return ", ".join(parts)


def coordinate(x: float, others: list[float]) -> str:
    """A coordinate with micrometres; what is rounding noise beside the others is 0."""
    return f"{0.0 if abs(x) <= 1e-12 * max(map(abs, others)) else x:.6f}"


def plural(count: int, one: str, many: str = "") -> str:
    """``1 body``, ``2 bodies``."""
    return f"{count} {one if count == 1 else many or one + 's'}"
