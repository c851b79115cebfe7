"""Chain: the masses of a pantograph in the model, which travel with the roof, and what is between them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

from ..errors import ModelError
from ..model.bodies.rigid import PointMass
from ..model.model import Model
from .vehicles.pantograph import Pantograph
from .vehicles.roof import RoofMotion, Track
from .vehicles.stage import Stage
from .vehicles.travel import Travel

#: Nominal height of the wire at a track position, m.
Level = Callable[[float], Any]
#: Distance of the masses in the model, m, and that of two strips from what is below; only motion matters.
#: Springs to strips 2 m apart lean so little that over 50 mm their force is off by less than 0.1 %.
APART, STRIPS_APART = 1.0, 5.0
#: Stiffness of a lowest spring of 0, N/m: the place where a pantograph stands is then unique, and over
#: centimetres it carries some millinewtons.
FAINT = 0.1
T = TypeVar("T")


def numbered(items: Sequence[T]) -> Iterator[tuple[T, str]]:
    """Items with what is behind their names: nothing for one, " 1", " 2" for more."""
    for k, item in enumerate(items):
        yield item, "" if len(items) == 1 else f" {k + 1}"


@dataclass(frozen=True)
class Chain:
    """Masses of a pantograph in the model.

    Attributes
    ----------
    pantograph : Pantograph
    travel : Travel
    track : Track
        How all of them move along and across the track, and the roof upwards.
    roof : PointMass
    masses : list of PointMass
        Without the head.
    heads : list of PointMass
        One, or two strips, the first ahead.

    """

    pantograph: Pantograph
    travel: Travel
    track: Track
    roof: PointMass
    masses: list[PointMass]
    heads: list[PointMass]

    def hold(self, model: Model, mass: PointMass) -> None:
        """Let a mass travel with the roof, free to move upwards."""
        model.hold(mass, position="xy", displacement=self.track.along)
        mass.set_motion(velocity=self.track.velocity(0.0))


def add_chain(
    model: Model,
    pantograph: Pantograph,
    travel: Travel,
    start: float,
    top: float,
    label: str,
    roof: RoofMotion | None,
) -> Chain:
    """Add roof and masses at a track position, the head at the height ``top``, m, with their forces."""
    track = Track(travel, roof)
    *low, last = pantograph.masses
    half = 0.5 * pantograph.strip_distance
    below = STRIPS_APART if half else APART
    count = len(low)
    base = top - below - APART * count

    def mass(name: str, x: float, z: float, size: float) -> PointMass:
        return model.add_point_mass(f"{label} {name}", at=(x, 0.0, z), mass=size)

    masses = [mass(f"mass {k + 1}", start, base + APART * (k + 1), m) for k, m in enumerate(low)]
    if half:
        heads = [
            mass(f"strip {name}", start + s, top, 0.5 * last)
            for name, s in (("ahead", half), ("behind", -half))
        ]
    else:
        heads = [mass(f"mass {count + 1}", start, top, last)]
    ground = mass("roof", start, base, 1.0)
    model.pin(ground, displacement=track.above)
    ground.set_motion(velocity=track.velocity(1.0))
    chain = Chain(pantograph, travel, track, ground, masses, heads)
    for one in (*masses, *heads):
        chain.hold(model, one)
        model.add_force(one, (0.0, 0.0, one.mass * -float(model.gravity[2])), name=f"{one.name} balance")
    for k in range(count + 1):
        drag = pantograph.aerodynamics[k]
        if k > 0 and drag == 0.0:
            continue
        name = f"{label} lift" if k == 0 else f"{label} lift of mass {k + 1}"
        bearers = heads if k == count else [masses[k]]
        for bearer, number in numbered(bearers):
            model.add_force(bearer, _lift(pantograph, travel, k, len(bearers)), name=name + number)
    return chain


def _lift(pantograph: Pantograph, travel: Travel, k: int, among: int) -> Any:
    """Static and aerodynamic force on a mass, constant or over time, of which each of several has a share."""
    first, drag = (pantograph.static_force if k == 0 else 0.0) / among, pantograph.aerodynamics[k] / among
    if travel.constant:
        return (0.0, 0.0, first + drag * travel.top**2)

    def force(t: float) -> Sequence[float]:
        return 0.0, 0.0, first + drag * float(travel.speed(t)) ** 2

    return force


def add_stages(model: Model, chain: Chain, above: float, level: Level | None, label: str) -> None:
    """Springs, dampers, friction and stops, the springs as short as the lift makes them.

    The lowest carries nothing when all is ``above`` lower than at the start; it stands on a guide that climbs
    with the wire, if that does.
    """
    unit, speed = chain.pantograph, float(chain.travel.speed(0.0))
    bearers = [chain.roof, *chain.masses]
    for k, stage in enumerate(unit.stages):
        tops = chain.heads if k == len(unit.masses) - 1 else [chain.masses[k]]
        for top, number in numbered(tops):
            below, name = bearers[k], f"{label} spring {k + 1}{number}"
            if k > 0:
                elongation = stage.elongation(-unit.carried(k, speed))
                _add_stage(model, below, top, stage, len(tops), elongation, name)
                continue
            if level is not None:
                _add_damper(model, below, top, stage, len(tops), f"{label} damper 1{number}")
                guide = _add_guide(model, chain, level, f"{label} guide{number}", below)
                stage = Stage(stage.spring, 0.0, 0.0, stage.stops, stage.stop_stiffness)
                below = guide
            _add_stage(model, below, top, stage, len(tops), above, name)


def _lean(below: PointMass, top: PointMass) -> float:
    """Cosine of the angle between a spring and the vertical."""
    d = top.position - below.position
    return float(d[2] / (d @ d) ** 0.5)


def _add_stage(
    model: Model,
    below: PointMass,
    top: PointMass,
    stage: Stage,
    among: int,
    elongation: float,
    name: str,
) -> None:
    """A stage, or its part among several alike, elongated by so much at the start.

    A spring that leans by an angle of the cosine c acts upwards as one of stiffness k does, if it has k/c^2.
    """
    c = _lean(below, top)
    distance = float(top.position[2] - below.position[2]) / c
    law = stage.law
    spring = stage.stiffness
    if spring == 0.0 and law is None:
        spring = FAINT
    if c * elongation >= distance:
        what = f"{name} is {elongation:.3g} m longer at the start than without force, at most {APART:g} m"
        raise ModelError("run.pantograph", what, "look at the speed, the forces and this stiffness")
    model.add_spring(
        below,
        top,
        stiffness=spring / (among * c * c),
        length=distance - c * elongation,
        law=None if law is None else law * (c, 1.0 / (among * c)),
        **_losses(stage, among, c),
        name=name,
    )


def _losses(stage: Stage, among: int, c: float) -> dict[str, Any]:
    """Damper and friction of a spring that leans."""
    rows = stage.resistance
    found: dict[str, Any] = {"damping": stage.damping / (among * c * c)}
    if rows is not None:
        found["damper"] = rows * (c, 1.0 / (among * c))
    if stage.friction:
        found["friction"] = stage.friction / (among * c)
    return found


def _add_damper(model: Model, below: PointMass, top: PointMass, stage: Stage, among: int, name: str) -> None:
    """Damper and friction alone, where there are any."""
    given = _losses(stage, among, _lean(below, top))
    if any(key != "damping" or value for key, value in given.items()):
        model.add_spring(below, top, **given, name=name)


def _add_guide(model: Model, chain: Chain, level: Level, name: str, roof: PointMass) -> PointMass:
    """A place beside the roof that climbs with the wire."""
    guide = model.add_point_mass(name, at=roof.position, mass=1.0)
    start, travel, track = float(roof.position[0]), chain.travel, chain.track
    first = float(level(start))

    def motion(t: float) -> tuple[float, float, float]:
        x, y, z = track.at(t)
        return x, y, z + float(level(start + x)) - first

    model.pin(guide, displacement=motion)
    short = 1e-3
    climb = (float(level(start + short)) - first) / short  # of what is ahead, where the slope may change
    x, y, z = track.velocity(1.0)
    guide.set_motion(velocity=(x, y, z + float(travel.speed(0.0)) * climb))
    return guide
