"""From a result, a state or modes to a Scene."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np

from ...arrays import FloatArray, IntArray
from ...contact.bump_fields import bump_ends
from ...contact.cross_fields import cross_places
from ...contact.fields import nearest_places
from ...errors import ModelError
from ...model import checks
from ...model.bodies.beam import Beam
from ...model.bodies.rigid import PointMass, RigidBody
from ...model.joints.basic import Spherical
from ...model.kind import body_of
from ...model.kinds import kind_of
from ...model.points import Point
from ...model.surfaces.body_contact import BodyContact
from ...model.surfaces.cable_contact import CableContact
from ...model.surfaces.contact import Contact
from ...model.surfaces.surface import SurfaceContact
from ...results.modes import Modes
from ...results.result import Result
from ...results.state import State
from ...system.spring_fields import SpringFields
from . import sampling
from .arrows import make_arrows
from .combs import make_combs
from .nets import make_nets
from .parts import Comb, Link, Marker, Scene, Strip, Thread, Triad

FRAMES, POINTS = 240, 1500
#: Largest displacement of a mode as it is drawn, of the model's size.
MODE_SIZE = 0.1
#: A spring whose fixed end is farther outside the bodies than this many of their middle extents is a support.
FAR = 2.0


class Frames(SpringFields):
    """The states that are drawn, in memory; they answer as a Result does.

    Parameters
    ----------
    source : Result or State
        For its model, slots and springs.
    t : (n,) s
    q, v : (n, size)
    rates : (n, size), optional
        With which forces act, see :attr:`ancf.State.rates`; default v.
    """

    def __init__(
        self, source: Any, t: FloatArray, q: FloatArray, v: FloatArray, rates: FloatArray | None = None
    ) -> None:
        self._bodies, self._slots, self._springs = source.bodies, source.slots, source.springs
        self._lengths = source.lengths
        self.t, self._q, self._v, self.model = t, q, v, source.model
        self._rates = v if rates is None else rates

    @property
    def rates(self) -> FloatArray:
        """See :attr:`ancf.State.rates`."""
        return self._rates

    def place(self, end: Any) -> FloatArray:
        """Positions (n, 3) of a point, a body's own point, or a fixed position, m."""
        if not isinstance(end, np.ndarray):
            return self.position(end)
        fixed: FloatArray = np.broadcast_to(end, (len(self.t), 3))
        return fixed


class Picked(NamedTuple):
    """States that are drawn, and of how many they are."""

    frames: Frames
    stored: int


def make_scene(
    source: Result | State | Modes,
    *,
    frames: int = FRAMES,
    points: int = POINTS,
    start: float | None = None,
    end: float | None = None,
    mode: int = 0,
    times: FloatArray | None = None,
) -> Scene:
    """What there is to draw of a result, a state or a mode.

    Parameters
    ----------
    source : Result, State or Modes
        A loaded, failed or unfinished result as well.
    frames : int
        At most so many stored states, evenly spaced in time; of a mode: times of one period.
    points : int
        About so many points on all centrelines together, at least the ends of each.
    start, end : float, s
        Times between which states are taken; default all.
    mode : int
        Which one, from 0; it is drawn with a displacement of a tenth of the model's size.
    times : (n,) s, optional
        Of a result: draw it at these times instead, straight between stored states and at rest beyond them.

    Raises
    ------
    ModelError
        A wrong number, nothing was stored between the times, or there is no such mode.
    """
    checks.integer(frames, "frames", 1, 1_000_000)
    checks.integer(points, "points", 2, 10_000_000)
    if isinstance(source, Modes):
        picked, moving = _of_mode(source, frames, mode), False
    else:
        picked, moving = _of_states(source, frames, start, end, times), True
    shown, stored = picked
    threads = sampling.threads(shown, points, moving)
    triads, markers = _triads(shown), _masses(shown)
    drawn = [thread.position for thread in threads] + [marker.position for marker in markers]
    extent = _extent(drawn)
    links, footed = _links(shown, extent, drawn)
    items = [*_items(shown, "supports"), *_items(shown, "loads"), *footed, *_items(shown, "connections")]
    return Scene(
        title=shown.model.title if moving else _title_of(source, mode),
        t=shown.t,
        threads=threads,
        links=links,
        markers=[*markers, *items],
        triads=triads,
        strips=_strips(shown, source, threads, extent),
        stored=stored,
        arrows=make_arrows(shown, drawn) if moving else [],
        nets=make_nets(shown.model, drawn, shown.t),
        combs=_combs(shown, source, drawn) if moving else [],
    )


def _of_states(
    source: Any, frames: int, start: float | None, end: float | None, times: FloatArray | None
) -> Picked:
    if isinstance(source, State):
        arrays = np.array([source.t]), source.q[None], source.v[None], source.rates[None]
        return Picked(Frames(source, *arrays), 1)
    if not isinstance(source, Result):
        what = f"must be a Result, a State or Modes, is {checks.shown(source)}"
        raise ModelError("source", what)
    if times is not None:
        q, v = (_at(source.t, data, times) for data in (source.q, source.v))
        return Picked(Frames(source, times, q, v), len(source.t))
    chosen = chosen_times(source.t, frames, start, end)
    q, v = (np.stack([data[k] for k in chosen.tolist()]) for data in (source.q, source.v))
    return Picked(Frames(source, source.t[chosen], q, v), len(source.t))


def _at(t: FloatArray, rows: Any, times: FloatArray) -> FloatArray:
    """Rows (n, size) at other times, straight between those that are known and constant beyond."""
    after = np.clip(np.searchsorted(t, times), 1, max(len(t) - 1, 1))
    found = np.empty((len(times), rows.shape[1]))
    for k, (time, place) in enumerate(zip(times.tolist(), after.tolist(), strict=True)):
        last = min(place, len(t) - 1)
        before, length = place - 1, float(t[last] - t[place - 1])
        share = min(max((time - float(t[before])) / length, 0.0), 1.0) if length > 0.0 else 0.0
        found[k] = (1.0 - share) * rows[before] + share * rows[last]
    return found


def chosen_times(t: FloatArray, frames: int, start: float | None, end: float | None) -> IntArray:
    """Places of at most so many stored times, evenly spaced between two times."""
    low = -np.inf if start is None else checks.number(start, "start")
    high = np.inf if end is None else checks.number(end, "end")
    inside = np.flatnonzero((t >= low - 1e-12) & (t <= high + 1e-12))
    if inside.size == 0:
        there = f"there are states from t = {t[0]:g} to {t[-1]:g} s" if len(t) else "nothing was stored"
        if low > high:
            raise ModelError("start", f"is {low:g} s, behind the end at {high:g} s", "the earlier time first")
        raise ModelError("start", f"no state is stored between it and the end: {there}")
    if inside.size <= frames:
        return inside
    wanted = np.linspace(t[inside[0]], t[inside[-1]], frames)
    after = np.clip(np.searchsorted(t, wanted), 1, len(t) - 1)
    near = after - (wanted - t[after - 1] < t[after] - wanted)
    return np.unique(near)


def _of_mode(modes: Modes, frames: int, mode: int) -> Picked:
    """One period of a mode about its state."""
    count = len(modes.frequencies)
    checks.integer(mode, "mode", 0, count - 1)
    about, shape = modes.about, modes.shapes[mode]
    largest = max(float(np.linalg.norm(modes.position(point)[mode])) for point in _nodes(about))
    size = about.system.model.size
    scale = MODE_SIZE * size / largest if largest > 0.0 else 0.0
    phase = np.linspace(0.0, 2 * np.pi, frames) if frames > 1 else np.array([np.pi / 2])
    q = about.q + scale * np.sin(phase)[:, None] * shape
    return Picked(Frames(about, phase / modes.frequencies[mode], q, 0.0 * q), frames)


def _title_of(modes: Any, mode: int) -> str:
    return f"{modes.about.model.title or 'mode'}: mode {mode + 1}, {modes.frequencies_hz[mode]:.4g} Hz"


def _nodes(about: State) -> Iterator[Point | PointMass | RigidBody]:
    """All nodes of beams, point masses and rigid bodies' centres."""
    for body in about.bodies.values():
        if isinstance(body, Beam):
            yield from (body.at(x) for x in body.node_x.tolist())
        else:
            yield body


def _masses(shown: Frames) -> list[Marker]:
    """Point masses and the centres of rigid bodies."""
    found = []
    for name, body in shown.bodies.items():
        if not isinstance(body, Beam):
            kind = "rigid body" if isinstance(body, RigidBody) else "point mass"
            found.append(Marker(name, kind, shown.position(name)))
    return found


def _triads(shown: Frames) -> list[Triad]:
    found = []
    for name, body in shown.bodies.items():
        if isinstance(body, RigidBody):
            axes = shown.section_rotation(body)
            found.append(Triad(name, shown.position(name), axes, 2.0 * body.gyration_radius))
    return found


def _items(shown: Frames, group: str) -> list[Marker]:
    """Marked items of a group, but joints that only fasten a point mass, which is drawn itself."""
    found = []
    for item in getattr(shown.model, group):
        kind = kind_of(item)
        ends = kind.ends_of(item)
        fastens = isinstance(item, Spherical) and any(isinstance(body_of(end), PointMass) for end in ends)
        if kind.look is not None and not fastens:
            found.append(Marker(item.name, kind.word, shown.place(ends[0])))
    return found


def _links(shown: Frames, extent: float, drawn: list[FloatArray]) -> tuple[list[Link], list[Marker]]:
    """Springs as lines; those to a far fixed point, which only stand for a support, as markers."""
    points = np.concatenate([part.reshape(-1, 3) for part in drawn])
    box = points.min(axis=0), points.max(axis=0)
    links, footed = [], []
    for name, spring in shown.springs.items():
        a, b = shown.place(spring.a), shown.place(spring.b)
        if not isinstance(spring.b, Point) and _outside(b[0], box) > FAR * extent > 0.0:
            footed.append(Marker(name, "spring support", a))
            continue
        force = shown.spring_force(name)
        loose = np.full(force.shape, spring.slack) & (force == 0.0)
        links.append(Link(name, np.stack([a, b], axis=1), force, loose))
    return links, footed


def _outside(place: FloatArray, box: tuple[FloatArray, FloatArray]) -> float:
    """Distance of a place from a box, m."""
    return float(np.linalg.norm(np.maximum(np.maximum(box[0] - place, place - box[1]), 0.0)))


def _extent(drawn: list[FloatArray]) -> float:
    """Middle one of the three extents of all that moves, m: the size across a long line."""
    points = np.concatenate([part.reshape(-1, 3) for part in drawn])
    extents = np.sort(np.ptp(points, axis=0))
    return float(extents[1]) or float(extents[2])


def _strips(shown: Frames, source: Any, threads: list[Thread], extent: float) -> list[Strip]:
    """Strips somewhat longer than the wires move along them: the model does not bound them."""
    found = []
    for item in shown.model.connections:
        if isinstance(item, Contact):
            swept = max(float(np.ptp(thread.position @ item.strip)) for thread in threads)
            half = (0.6 * swept or 0.5 * extent or 0.5) * item.strip
            middle = shown.place(item.point)
            ends = np.stack([middle - half, middle + half], axis=1)
            found.append(Strip(item.name, ends, _contact_force(shown, source, item.name)))
    return found + _ways_to_surfaces(shown, source)


def _ways_to_surfaces(shown: Frames, source: Any) -> list[Strip]:
    """Of each contact all along a beam the way from its axis to what it touches where it is shortest."""
    found: list[Strip] = []
    known = source.about if isinstance(source, Modes) else source
    ways = (
        (SurfaceContact, "pressing", nearest_places),
        (CableContact, "crossing", cross_places),
        (BodyContact, "bumping", bump_ends),
    )
    for kind, part, places in ways:
        items = [item for item in shown.model.connections if isinstance(item, kind)]
        for k, item in enumerate(items):
            ends = places(known._contact_system().parts[part], k, shown.q)
            if isinstance(item, CableContact):
                ends = _kept(ends, shown.place(item.body.start))
            found.append(Strip(item.name, ends, _contact_force(shown, source, item.name)))
    return found


def _kept(ends: FloatArray, start: FloatArray) -> FloatArray:
    """Ways (n, 2, 3) with those that are not known, of no length, where the last or else the first one was.

    ``start`` (n, 3) is where they are if there is none at all.
    """
    known = np.flatnonzero(np.isfinite(ends[:, 0, 0]))
    if not len(known):
        return np.repeat(start[:, None], 2, axis=1)
    last = known[np.maximum(np.searchsorted(known, np.arange(len(ends)), side="right") - 1, 0)]
    kept: FloatArray = np.where(np.isnan(ends), ends[last, :1], ends)
    return kept


def _combs(shown: Frames, source: Any, drawn: list[FloatArray]) -> list[Comb]:
    """Contact forces along beams, if the model has surfaces that beams touch."""
    if not any(isinstance(item, SurfaceContact) for item in shown.model.connections):
        return []
    points = np.concatenate([part.reshape(-1, 3) for part in drawn])
    slipping = {}
    for item in shown.model.connections:
        if isinstance(item, SurfaceContact) and item.friction > 0.0:
            friction = _contact_number(shown, source, "friction_force", item.name)
            share = _contact_number(shown, source, "slipping", item.name)
            if friction is not None and share is not None:
                slipping[item.name] = (friction * share, share)
    return make_combs(shown, source._contact_system(), float(np.max(np.ptp(points, axis=0))), slipping)


def _contact_force(shown: Frames, source: Any, name: str) -> FloatArray | None:
    """Force of a contact at the times that are drawn."""
    return _contact_number(shown, source, "contact_force", name)


def _contact_number(shown: Frames, source: Any, asked: str, name: str) -> FloatArray | None:
    """What a contact answers at the times that are drawn, from the sensors or from a state."""
    try:
        whole = source.sensors if isinstance(source, Result) else source
        force = np.atleast_1d(getattr(whole, asked)(name))
    except (ModelError, AttributeError):
        return None
    times = np.atleast_1d(whole.t)
    interpolated: FloatArray = np.interp(shown.t, times, force)
    return interpolated
