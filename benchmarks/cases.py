"""The models of the comparison, as plain numbers that both sides build from."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Self

GRAVITY = 9.81  # m/s^2, along -z


@dataclass(frozen=True, kw_only=True)
class Case:
    """What all cases have.

    Parameters
    ----------
    name, title : str
    EA, EI, rhoA : float
        N, N m^2, kg/m.
    step, t_end : float
        s.
    accuracy : float
        Change of the tip, m, up to which another setting of the peer counts as equally accurate.
    quick : bool
        Part of the short run.
    peer_tolerance : float or None
        Absolute Newton tolerance of the peer, N, where it does not get through with its default of
        1e-10: that is below the round-off of the forces of short stiff elements.
    """

    name: str
    title: str
    EA: float
    EI: float
    rhoA: float
    step: float
    t_end: float
    accuracy: float
    quick: bool
    peer_tolerance: float | None = None

    @property
    def elements(self) -> int:
        """Number of all elements."""
        raise NotImplementedError

    @property
    def size(self) -> str:
        """The same for a table."""
        return str(self.elements)

    @property
    def steps(self) -> int:
        return round(self.t_end / self.step)

    @property
    def once(self) -> bool:
        """One solve of the peer takes a minute: each variant is measured once, and may cut its steps."""
        return False

    @property
    def static(self) -> bool:
        """An equilibrium instead of a motion; it has one step."""
        return False

    @property
    def long(self) -> bool:
        """One solve takes seconds: it is measured by single solves, and less often."""
        return self.steps * self.elements > 300_000

    def first(self, steps: int) -> Self:
        """The same with the first steps only."""
        return replace(self, t_end=steps * self.step)

    def finer(self, factor: int) -> Self:
        """The same with steps that are shorter by a factor."""
        return replace(self, step=self.step / factor)


@dataclass(frozen=True, kw_only=True)
class Cable(Case):
    """A straight cable along x that starts under gravity, solved with the trapezoidal rule.

    Parameters
    ----------
    count : int
        Number of elements.
    length : float
        m.
    clamped : bool
        The start is clamped (position and slope fixed), else hinged.
    omega : float
        Initial rotation about z through the start, rad/s.
    """

    count: int
    length: float
    clamped: bool
    omega: float = 0.0

    @property
    def elements(self) -> int:
        return self.count


@dataclass(frozen=True, kw_only=True)
class Beams(Cable):
    """The same with elements that have a cross-section, a square one, and no lateral contraction.

    Parameters
    ----------
    element : str
        Ours: "original" or "nonlocking".
    side, E, rho : float
        m, N/m^2, kg/m^3.
    """

    element: str
    side: float
    E: float
    rho: float


@dataclass(frozen=True, kw_only=True)
class Hanging(Cable):
    """The equilibrium of a cable that starts straight without its weight.

    Parameters
    ----------
    held : bool
        The end is hinged, too.
    """

    held: bool

    @property
    def static(self) -> bool:
        return True


@dataclass(frozen=True, kw_only=True)
class Net(Case):
    """Cables along x, side by side along y, with springs between inner neighbours.

    They are pinned at both ends, but the end of the last one is free.

    Parameters
    ----------
    cables, count : int
        Cables, and elements of each.
    length, gap : float
        Of a cable, and between two, m.
    stiffness, damping : float
        Of the springs, N/m and N s/m.
    """

    cables: int
    count: int
    length: float
    gap: float
    stiffness: float
    damping: float

    @property
    def elements(self) -> int:
        return self.cables * self.count

    @property
    def size(self) -> str:
        return f"{self.cables}x{self.count}"


@dataclass(frozen=True, kw_only=True)
class Sliding(Case):
    """A beam with a mass at its tip slides along a carrier, pinned at both ends, at rest under its weight.

    Parameters
    ----------
    carrier, slider : int
        Numbers of elements.
    """

    carrier: int
    slider: int
    start: tuple[float, float, float] = (0.0, 0.0, 0.0)  # of the carrier, m
    joint: tuple[float, float, float] = (0.0, 3.0, 1.0)
    tip: tuple[float, float, float] = (1.0, 3.0, 1.0)
    mass: float = 1.0  # kg

    @property
    def elements(self) -> int:
        return self.carrier + self.slider

    @property
    def size(self) -> str:
        return f"{self.carrier}+{self.slider}"


@dataclass(frozen=True, kw_only=True)
class Overhead(Case):
    """A pantograph runs along an overhead line; EA, EI, rhoA are those of the contact wire.

    Line and pantograph are those of example 7.5 as the peer can have them: droppers without mass at the nodes
    of both meshes, a contact wire that the masts hold sideways alone, a carrier that bends over the masts.

    Parameters
    ----------
    contact, carrier : int
        Numbers of elements of the two wires.
    speed : float
        m/s.
    start : float
        Of the pantograph, m.
    """

    contact: int
    carrier: int
    speed: float
    start: float
    carrier_rhoA: float = 0.446  # kg/m
    spans: int = 4
    span: float = 60.0  # m
    droppers: int = 7  # in a span
    height: float = 1.5  # of the carrier at the masts, m
    zigzag: float = 0.3  # m
    tension: float = 10e3  # of both wires, N
    dropper_EA: float = 1.342e6  # N
    dropper_damping: float = 8.0  # N s/m
    damping: float = 0.03  # of both wires, N s/m^2
    masses: tuple[float, float] = (15.0, 7.2)  # frame and head, kg
    stiffness: tuple[float, float] = (50.0, 4200.0)  # N/m
    dampers: tuple[float, float] = (90.0, 10.0)  # N s/m
    force: float = 100.0  # N
    rho: float = 0.6  # spectral radius of the generalised-alpha method

    @property
    def elements(self) -> int:
        return self.contact + self.carrier

    @property
    def size(self) -> str:
        return f"{self.contact}+{self.carrier}"

    @property
    def once(self) -> bool:
        return True


def square(side: float, E: float, rho: float) -> dict[str, float]:
    """Stiffnesses and mass of a square section."""
    A = side * side
    return {"EA": E * A, "EI": E * A * A / 12, "rhoA": rho * A}


def cantilever(elements: int, quick: bool) -> Cable:
    """Example 7.1, f = 1: 1600 steps of 0.25 ms."""
    return Cable(
        name=f"cantilever-{elements}", title="7.1 cantilever", count=elements,
        length=1.0, **square(0.01, 1e8, 500.0),
        clamped=True, step=2.5e-4, t_end=0.4, accuracy=1e-8, quick=quick,
        peer_tolerance=1e-5 if elements >= 1000 else None,
    )  # fmt: skip


def pendulum(elements: int, quick: bool) -> Cable:
    """Example 7.2, f = 5: 20000 steps of 0.1 ms."""
    return Cable(
        name=f"pendulum-{elements}", title="7.2 pendulum", count=elements,
        length=1.0, **square(0.005, 1.6e6, 320.0),
        clamped=False, omega=4.0, step=1e-4, t_end=2.0, accuracy=1e-6, quick=quick,
    )  # fmt: skip


def cable(elements: int, quick: bool) -> Cable:
    """Cable of 10 m hinged at one end, released horizontally: 100 steps of 1 ms."""
    return Cable(
        name=f"cable-{elements}", title="swinging cable", count=elements,
        length=10.0, **square(0.01, 1e8, 1000.0),
        clamped=False, step=1e-3, t_end=0.1, accuracy=1e-8, quick=quick,
    )  # fmt: skip


def wire() -> Cable:
    """Steel wire of 2 mm and 5 m, clamped, EA l^2/EI = 1e6: 1000 steps of 0.2 ms."""
    return Cable(
        name="wire-50", title="steel wire", count=50,
        length=5.0, EA=6.6e5, EI=0.165, rhoA=0.0247,
        clamped=True, step=2e-4, t_end=0.2, accuracy=1e-6, quick=False, peer_tolerance=1e-6,
    )  # fmt: skip


def whirl(elements: int) -> Cable:
    """The swinging cable, that also turns about the vertical: a chain in space, 1000 steps of 1 ms."""
    return replace(
        cable(elements, quick=False), name=f"space-{elements}", title="cable in space", omega=1.0, t_end=1.0,
        accuracy=1e-6,
    )  # fmt: skip


def beams(element: str) -> Beams:
    """Fifty beams of 0.1 m side, 4 m long in all, clamped, fall under their weight: 500 steps of 1 ms."""
    side, E, rho = 0.1, 1e7, 1000.0
    title = {"original": "original beams", "nonlocking": "locking-free beams"}[element]
    return Beams(
        name=f"{element}-50", title=title, element=element, count=50, side=side, E=E, rho=rho,
        length=4.0, **square(side, E, rho),
        clamped=True, step=1e-3, t_end=0.5, accuracy=1e-6, quick=False,
    )  # fmt: skip


def static(count: int, held: bool) -> Hanging:
    """The cantilever of 7.1 under its weight, or the carrier of 7.4, laid level, between two hinges."""
    side, E, rho, length = (0.01, 1e6, 800.0, 10.0**0.5) if held else (0.01, 1e8, 500.0, 1.0)
    name, title = (
        ("static-carrier", "carrier at rest") if held else ("static-cantilever", "cantilever at rest")
    )
    return Hanging(
        name=f"{name}-{count}", title=title, count=count, held=held,
        length=length, **square(side, E, rho),
        clamped=not held, step=1.0, t_end=1.0, accuracy=1e-4 if held else 1e-6, quick=not held,
    )  # fmt: skip


def short(elements: int) -> Cable:
    """As many studies have it: ten elements and twenty steps, where the model's description counts."""
    return replace(cable(elements, quick=True), name=f"short-{elements}", title="short run", t_end=0.02)


def net() -> Net:
    """Twenty cables of ten elements side by side, with springs between neighbouring nodes: 171."""
    return Net(
        name="net-20x10", title="net of cables", **square(0.01, 1e8, 1000.0),
        cables=20, count=10, length=10.0, gap=0.5, stiffness=100.0, damping=1.0,
        step=1e-3, t_end=0.2, accuracy=1e-6, quick=False,
    )  # fmt: skip


def sliding(carrier: int, slider: int, quick: bool) -> Sliding:
    """Example 7.4: 5000 steps of 0.2 ms."""
    return Sliding(
        name=f"sliding-{carrier}+{slider}", title="7.4 sliding beam", carrier=carrier, slider=slider,
        **square(0.01, 1e6, 800.0), step=2e-4, t_end=1.0, accuracy=1e-4, quick=quick,
    )  # fmt: skip


def overhead(speed: float) -> Overhead:
    """Example 7.5: along 97 % of the line in steps of 1 ms."""
    start = 240.0 / 224 * 2
    steps = round((0.97 * 240.0 - start) / speed / 1e-3)
    return Overhead(
        name=f"overhead-{speed:g}", title=f"7.5 overhead line, {speed:g} m/s", contact=224, carrier=112,
        EA=1.342e7, EI=150.0, rhoA=0.89, speed=speed, start=start, step=1e-3, t_end=1e-3 * steps,
        accuracy=1e-3, quick=False,
    )  # fmt: skip


CASES: dict[str, Case] = {
    case.name: case
    for case in (
        cantilever(4, quick=True),
        cantilever(32, quick=True),
        cantilever(1000, quick=False),
        pendulum(4, quick=True),
        pendulum(32, quick=False),
        sliding(6, 2, quick=True),
        sliding(64, 4, quick=False),
        sliding(128, 8, quick=False),
        cable(10, quick=True),
        cable(100, quick=True),
        cable(1000, quick=True),
        cable(10000, quick=False),
        whirl(200),
        short(10),
        wire(),
        net(),
        beams("original"),
        beams("nonlocking"),
        static(100, held=False),
        static(64, held=True),
        overhead(32.0),
    )
}
