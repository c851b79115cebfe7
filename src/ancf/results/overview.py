"""Overview of a result, a state and modes: the sheets that ``print`` and notebooks show."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from ..model.bodies.beam import Beam
from ..model.bodies.rigid import Body, PointMass
from ..model.model import Model
from ..model.overview import body_table, sizes
from ..model.points import Point
from ..model.tables import Sheet, Table, number, plural
from .accuracy import at_most
from .faces import History, Instant, Swinging, Swung, Whirling

STATUS = {
    "complete": "complete",
    "failed": "failed",
    "interrupted": "stopped by Ctrl-C",
    "running": "not finished: it goes on, or was killed",
}
#: Bodies that a summary shows when nothing was asked for.
MOST_BODIES = 4
#: Share of an eigenvalue that its real part has if it grows, and below which a part is round-off.
GROWS, NOISE = 1e-6, 1e-10
#: Whirl of what is called a circle.
CIRCLES = 0.5
#: Numbers of a history that a sheet reads for its notes.
MOST_READ = 20_000_000
POINT_COLUMNS = ("point", "x [m]", "y [m]", "z [m]", "speed [m/s]", "tension [N]")


def of_result(result: History) -> Sheet:
    """How a run ended, its times, bodies, settings, cost, energies' drift and sensors."""
    plain = result.provenance
    settings = plain.get("settings", {})
    bodies = [*result.bodies.values()]
    facts = [
        ("status", STATUS.get(result.status, result.status) + _how_far(result, settings)),
        ("times", times(result)),
        ("steps", _steps(result, settings)),
        ("bodies", sizes(bodies)),
        ("cost", _cost(result)),
        ("energy", _drift(result, settings)),
        ("sensors", _names(settings.get("sensors", []))),
        ("inputs", _names(result._inputs_said())),
        ("called once a step", _names(settings.get("called once a step", []))),
        *(("note", text) for text in _notes(result)),
    ]
    return Sheet(f"Result{_quoted(plain.get('title'))}", facts, [body_table(bodies)])


def of_state(state: Instant) -> Sheet:
    """Time, energies, and the ends of bodies with speed and tension."""
    energy = state.energy
    parts = (f"{key} {number(float(getattr(energy, key)))} J" for key in ("kinetic", "strain", "potential"))
    model = state.system.model
    facts = [
        ("time", f"{state.t:g} s"),
        ("bodies", sizes(model.bodies.values())),
        ("energy", ", ".join(parts)),
        *(("note", text) for text in state.notes),
    ]
    points = [_at(state, point) for body in model.bodies.values() for point in points_of(body)]
    return Sheet(f"State{_quoted(model.title)}", facts, [Table(POINT_COLUMNS, points)])


def of_modes(modes: Swung) -> Sheet:
    """Frequencies and periods."""
    rows = [
        (str(k), number(hz), number(omega), number(1.0 / hz) if hz > 0.0 else "")
        for k, (hz, omega) in enumerate(zip(modes.frequencies_hz, modes.frequencies, strict=True), 1)
    ]
    columns = ("mode", "frequency [Hz]", "angular frequency [rad/s]", "period [s]")
    return Sheet(f"Modes{_quoted(modes.about.system.model.title)}", _about(modes), [Table(columns, rows, 40)])


def of_damped_modes(modes: Whirling) -> Sheet:
    """Eigenvalues, frequencies, damping, and what each mode does: it grows, whirls or only decays."""
    rows = []
    for k, (value, whirl) in enumerate(zip(modes.eigenvalues, modes.whirl, strict=True), 1):
        noise = NOISE * abs(value)
        real, imaginary = (part if abs(part) > noise else 0.0 for part in (value.real, value.imag))
        ratio = -real / abs(value) if value else 0.0
        shown = (abs(imaginary) / (2 * np.pi), ratio, real, imaginary)
        rows.append((str(k), *map(number, shown), _does(value, whirl)))
    columns = ("mode", "frequency [Hz]", "damping ratio", "real part [1/s]", "imaginary part [1/s]", "motion")
    rate = float(np.linalg.norm(modes.spin))
    turning = f"{number(rate)} rad/s; frequencies are those of who turns with it" if rate else ""
    facts = [*_about(modes), ("rotation", turning)]
    return Sheet(f"DampedModes{_quoted(modes.about.system.model.title)}", facts, [Table(columns, rows, 40)])


def _about(modes: Swinging) -> list[tuple[str, str]]:
    """How many modes there are, about what, and their notes."""
    count = f"{plural(len(modes.frequencies_hz), 'mode')} about the state at t = {modes.about.t:g} s"
    return [("count", count), *(("note", text) for text in modes.notes)]


def _does(value: complex, whirl: float) -> str:
    """What a damped mode does."""
    size = abs(value)
    if value.real > GROWS * size:
        return "flutters: grows" if value.imag > GROWS * size else "diverges: grows"
    if size == 0.0:
        return "neutral"
    if value.imag <= GROWS * size:
        return "decays"
    if abs(whirl) > CIRCLES:
        return "whirls with the rotation" if whirl > 0.0 else "whirls against the rotation"
    return ""


def line_of_result(result: History) -> str:
    """One line: title, states, times, status."""
    title = result.provenance.get("title")
    return f"Result({f'{title!r}, ' if title else ''}{times(result)}, {result.status})"


def line_of_state(state: Instant) -> str:
    """One line: time and bodies."""
    return f"State(t = {state.t:g} s, {sizes(state.bodies.values())})"


def line_of_modes(modes: Swinging) -> str:
    """One line: how many, lowest and highest frequency."""
    hz = modes.frequencies_hz
    ends = f", {hz[0]:.4g} to {hz[-1]:.4g} Hz" if len(hz) else ""
    return f"{type(modes).__name__}({plural(len(hz), 'mode')}{ends})"


def times(result: History) -> str:
    """``41 states, t = 0 to 0.4 s``."""
    t = result.t
    return f"{plural(len(t), 'state')}, t = {t[0]:g} to {t[-1]:g} s" if len(t) else "no states"


def _quoted(title: Any) -> str:
    return f' "{title}"' if title else ""


def _how_far(result: History, settings: dict[str, Any]) -> str:
    t_end = settings.get("t_end")
    if result.status == "complete" or t_end is None or not len(result.t):
        return ""
    return f" at t = {result.t[-1]:g} s of {t_end:g} s"


def _steps(result: History, settings: dict[str, Any]) -> str:
    method = str(settings.get("integrator", "")).replace("_", "-")
    step = f" of {settings['step']:g} s" if "step" in settings else ""
    return f"{result.stats.steps}{step}" + (f", {method}" if method else "")


def _cost(result: History) -> str:
    stats = result.stats
    parts = [plural(stats.newton_iterations, "Newton iteration"), plural(stats.jacobians, "Jacobian")]
    if stats.retries:
        parts.append(plural(stats.retries, "retry", "retries"))
    return ", ".join([*parts, f"{stats.cpu_seconds:.3g} s CPU"])


def _drift(result: History, settings: dict[str, Any]) -> str:
    """Change of the balance since the first stored time; of a long history its end alone is looked at."""
    if not settings.get("energy", True) or not len(result.t):
        return ""
    energy, work = result._end_energies()
    balance = energy.sum(axis=1) + work[:, 0] - work[:, 1]
    largest = float(np.max(np.abs(np.concatenate([energy, work], axis=1))))
    last = float(balance[-1] - balance[0])
    drift = (
        at_most(float(np.max(np.abs(result.energy.drift))), last) if is_short(result) else f"{last:.2g} (end)"
    )
    return f"drift of the balance {drift} J, largest part {largest:.3g} J"


def is_short(result: History) -> bool:
    """Whether all states are looked at: print must not read gigabytes."""
    return bool(len(result.t)) and result.q.shape[0] * result.q.shape[1] <= MOST_READ


def _notes(result: History) -> list[str]:
    """Notes of a history that is not long; of a long one those that were there before it began."""
    return result.notes if is_short(result) else [str(text) for text in result.provenance.get("notes", [])]


def _names(names: list[str]) -> str:
    if not names:
        return ""
    first = ", ".join(names[:6])
    return f"{first}, and {len(names) - 6} more" if len(names) > 6 else first


def shown_points(model: Model) -> list[Point]:
    """Start, middle and end of the first beams of a model, and its first other bodies."""
    return [point for body in [*model.bodies.values()][:MOST_BODIES] for point in points_of(body)]


def points_of(body: Body) -> Iterable[Point]:
    """Start, middle and end of a beam, the one point of another body."""
    if isinstance(body, Beam):
        return body.start, body.at(0.5 * body.length), body.end
    return (body.point if isinstance(body, PointMass) else body.centre,)


def _at(state: Instant, point: Point) -> tuple[str, ...]:
    place = state.position(point)
    noise = 1e-12 * float(np.max(np.abs(place)))
    coordinates = [number(x if abs(x) > noise else 0.0) for x in place.tolist()]
    speed = number(float(np.linalg.norm(state.velocity(point))))
    tension = number(float(state.tension(point))) if isinstance(point.body, Beam) else ""
    return str(point), *coordinates, speed, tension
