"""The models of the comparison, as plain numbers that both sides build from."""

from __future__ import annotations

from dataclasses import dataclass, replace

GRAVITY = 9.81  # m/s^2, along -z


@dataclass(frozen=True)
class Case:
    """A straight cable along x that starts under gravity, solved with the trapezoidal rule.

    Parameters
    ----------
    name, title : str
    elements : int
    length, EA, EI, rhoA : float
        m, N, N m^2, kg/m.
    clamped : bool
        The start is clamped (position and slope fixed), else hinged.
    omega : float
        Initial rotation about z through the start, rad/s.
    step, t_end : float
        s.
    accuracy : float
        Change of the tip, m, up to which another Newton setting of the peer counts as equally accurate.
    peer_tolerance : float or None
        Absolute Newton tolerance of the peer, N, where it does not get through with its default of
        1e-10: that is below the round-off of the forces of short stiff elements.
    quick : bool
        Part of the short run.
    """

    name: str
    title: str
    elements: int
    length: float
    EA: float
    EI: float
    rhoA: float
    clamped: bool
    omega: float
    step: float
    t_end: float
    accuracy: float
    quick: bool
    peer_tolerance: float | None = None

    @property
    def steps(self) -> int:
        return round(self.t_end / self.step)

    @property
    def long(self) -> bool:
        """One solve takes seconds: it is measured by single solves, and less often."""
        return self.steps * self.elements > 500_000

    def first(self, steps: int) -> Case:
        """The same with the first steps only."""
        return replace(self, t_end=steps * self.step)


def cantilever(elements: int, quick: bool) -> Case:
    """Example 7.1, f = 1: 1600 steps of 0.25 ms."""
    return Case(
        f"cantilever-{elements}", "7.1 cantilever", elements,
        length=1.0, EA=1e4, EI=1e8 * 1e-8 / 12, rhoA=0.05,
        clamped=True, omega=0.0, step=2.5e-4, t_end=0.4, accuracy=1e-8, quick=quick,
        peer_tolerance=1e-5 if elements >= 1000 else None,
    )  # fmt: skip


def pendulum(elements: int, quick: bool) -> Case:
    """Example 7.2, f = 5: 20000 steps of 0.1 ms."""
    A, E, rho = 25e-6, 1.6e6, 320.0
    return Case(
        f"pendulum-{elements}", "7.2 pendulum", elements,
        length=1.0, EA=E * A, EI=E * A * A / 12, rhoA=rho * A,
        clamped=False, omega=4.0, step=1e-4, t_end=2.0, accuracy=1e-6, quick=quick,
    )  # fmt: skip


def cable(elements: int, quick: bool) -> Case:
    """Cable of 10 m hinged at one end, released horizontally: 100 steps of 1 ms."""
    A, E, rho = 1e-4, 1e8, 1000.0
    return Case(
        f"cable-{elements}", "swinging cable", elements,
        length=10.0, EA=E * A, EI=E * A * A / 12, rhoA=rho * A,
        clamped=False, omega=0.0, step=1e-3, t_end=0.1, accuracy=1e-8, quick=quick,
    )  # fmt: skip


CASES = {
    case.name: case
    for case in (
        cantilever(4, quick=True),
        cantilever(32, quick=True),
        cantilever(1000, quick=False),
        pendulum(4, quick=True),
        pendulum(32, quick=False),
        cable(10, quick=True),
        cable(100, quick=True),
        cable(1000, quick=True),
        cable(10000, quick=False),
    )
}
