"""Scene: a result as things to draw at some times, for viewer, movies and exports; it knows no library."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from ...arrays import BoolArray, FloatArray
from ...model.kind import Look, Push
from ...model.kinds import marked

#: What the points of a thread know beside their place, with units.
QUANTITIES = {"tension": "N", "curvature": "1/m", "speed": "m/s"}
#: Markers that are no support and no joint.
BODIES = {"point mass": Look("circle", "black", 5.0), "rigid body": Look("square", "black", 5.0)}
FOOTED = {"spring support": Look("diamond", "grey", 4.0)}


def looks() -> dict[str, Look]:
    """Kinds of markers and how they look, in the order of a legend."""
    return BODIES | marked() | FOOTED


@dataclass(frozen=True, slots=True)
class Thread:
    """The centreline of a beam or cable.

    Parameters
    ----------
    name : str
    element : "cable", "original" or "nonlocking"
    x : (m,) m
        Reference arc lengths of the points.
    position : (n, m, 3) m
    values : dict of str to (n, m)
        The QUANTITIES; a mode has none.
    outline : (n, m, k, 3) m, optional
        Corners of the cross-sections, in order; cables have none.
    """

    name: str
    element: str
    x: FloatArray
    position: FloatArray
    values: dict[str, FloatArray] = field(default_factory=dict)
    outline: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class Link:
    """A spring or dropper.

    Parameters
    ----------
    name : str
    ends : (n, 2, 3) m
    force : (n,) N
        Positive in tension.
    slack : (n,) of bool
        A spring that cannot push and carries nothing.
    """

    name: str
    ends: FloatArray
    force: FloatArray
    slack: BoolArray


@dataclass(frozen=True, slots=True)
class Marker:
    """A point mass, a rigid body's centre, a support or a joint; `kind` is one of ``looks()``.

    Parameters
    ----------
    name, kind : str
    position : (n, 3) m
    """

    name: str
    kind: str
    position: FloatArray


@dataclass(frozen=True, slots=True)
class Triad:
    """The axes of a rigid body.

    Parameters
    ----------
    name : str
    centre : (n, 3) m
    axes : (n, 3, 3)
        Body axes as columns.
    size : float, m
        Length to draw.
    """

    name: str
    centre: FloatArray
    axes: FloatArray
    size: float


@dataclass(frozen=True, slots=True)
class Strip:
    """The strip of a contact, as long as it has to be, or the way to a surface where that is nearest.

    Parameters
    ----------
    name : str
    ends : (n, 2, 3) m
    force : (n,) N, optional
        A result loaded from a file without sensors does not know it.
    """

    name: str
    ends: FloatArray
    force: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class Comb:
    """What a surface does to a beam: a tooth for each element that touches it at some time.

    Parameters
    ----------
    name : str
    ends : (n, k, 2, 3) m
        From the axis along the force on the beam; of no length where nothing touches.
    force : (n, k) N/m
        Normal force per length.
    slide : (n, k) m/s
        Speed past the surface.
    slips : (n, k) of bool, optional
        Whether friction slips there; not known without sensors, but of an equilibrium and the last state.
    """

    name: str
    ends: FloatArray
    force: FloatArray
    slide: FloatArray
    slips: BoolArray | None = None


@dataclass(frozen=True, slots=True)
class Arrow:
    """A load, as one arrow or as a row of them.

    Parameters
    ----------
    name : str
    kind : str
        Its noun.
    ends : (n, k, 2, 3) m
        Tails and tips; of what turns, where it acts and its axis from there.
    size : (n,)
        Of what acts, in the unit of `push`.
    push : Push
    head : float, m
        Length of a head.
    reach : (n, k, m, 3) m
        What a picture must hold: a round arrow and not its axis, which may lie across a plane.
    """

    name: str
    kind: str
    ends: FloatArray
    size: FloatArray
    push: Push
    head: float
    reach: FloatArray


@dataclass(frozen=True, slots=True)
class Net:
    """A ground, the surface of a fluid or a surface that beams touch, at rest or on a rigid body.

    Parameters
    ----------
    name : str
    kind : "ground", "surface" or "contact"
    lines : (k, m, 3) m
    on : str
        Rigid body of which it has the axes; "": at rest.
    heights : (n, k, m) m, optional
        z of its points at each time, of a surface with waves.
    """

    name: str
    kind: str
    lines: FloatArray
    on: str = ""
    heights: FloatArray | None = None


@dataclass(frozen=True, slots=True)
class Scene:
    """What there is to draw, at n times.

    Parameters
    ----------
    title : str
    t : (n,) s
    threads, links, markers, triads, strips, arrows, nets, combs : list
    stored : int
        Number of states of the result, of which these are some.
    """

    title: str
    t: FloatArray
    threads: list[Thread] = field(default_factory=list)
    links: list[Link] = field(default_factory=list)
    markers: list[Marker] = field(default_factory=list)
    triads: list[Triad] = field(default_factory=list)
    strips: list[Strip] = field(default_factory=list)
    stored: int = 1
    arrows: list[Arrow] = field(default_factory=list)
    nets: list[Net] = field(default_factory=list)
    combs: list[Comb] = field(default_factory=list)

    @property
    def box(self) -> FloatArray:
        """Smallest and largest coordinates of all that is drawn, at all times, (2, 3), m."""
        parts = [thread.position for thread in self.threads]
        parts += [thread.outline for thread in self.threads if thread.outline is not None]
        parts += [link.ends for link in self.links] + [strip.ends for strip in self.strips]
        parts += [marker.position for marker in self.markers] + [arrow.reach for arrow in self.arrows]
        points = np.concatenate([part.reshape(-1, 3) for part in parts])
        return np.stack([points.min(axis=0), points.max(axis=0)])

    @property
    def size(self) -> float:
        """Largest extent of the box, m, 1 m for a single point."""
        return float(np.max(self.box[1] - self.box[0])) or 1.0

    def limits(self, quantity: str) -> tuple[float, float]:
        """Smallest and largest value of a quantity over all threads and times."""
        values = [thread.values[quantity] for thread in self.threads if quantity in thread.values]
        return min(float(v.min()) for v in values), max(float(v.max()) for v in values)
