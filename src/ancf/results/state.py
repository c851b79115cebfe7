"""State of a system at one time, and its energy."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..arrays import FloatArray
from ..contact.fields import ContactLine, contact_line
from ..errors import ModelError, named
from ..model.surfaces.surface import SurfaceContact
from ..model.tables import Readable, Sheet
from ..solvers.record import Stats
from ..system import initial_motion
from ..system.contact_fields import ContactFields
from ..system.energy import energies
from ..system.spring_fields import SpringFields, springs_of
from ..system.system import System
from . import accuracy, fallen, laid, motions, sharp_bends, stretched, tension, turned_bends, wavering
from .below import of_bodies
from .momenta import Momenta
from .motions import Motions
from .overview import line_of_state, of_state
from .pictures import StatePlotted
from .remembered import Remembered
from .sensitivities import sensitivity_of


@dataclass(frozen=True)
class Energy:
    """Energies in J; arrays of shape (n_t,) for a history, numbers for a state.

    ``potential`` is that of gravity, zero at the origin; all other loads, moments and moving supports
    count as ``supplied`` work since the start, and ``dissipated`` is what the damping took out.
    """

    kinetic: FloatArray
    strain: FloatArray
    potential: FloatArray
    dissipated: FloatArray
    supplied: FloatArray

    @property
    def total(self) -> FloatArray:
        """Kinetic + strain + potential energy."""
        return self.kinetic + self.strain + self.potential

    @property
    def balance(self) -> FloatArray:
        """Total + dissipated - supplied: constant but for the integration error; see :attr:`drift`."""
        return self.total + self.dissipated - self.supplied

    @property
    def drift(self) -> FloatArray:
        """Change of the balance since the start: zero but for the integration error."""
        balance = self.balance
        drift: FloatArray = balance - np.ravel(balance)[:1].sum()  # a state is its own start
        return drift


class State(SpringFields, ContactFields, Momenta, Motions, StatePlotted, Readable):
    """Positions and velocities of a model at one time; see :class:`Fields` for what it answers.

    Parameters
    ----------
    system : System
    t : float
        Time, s.
    q, v : ndarray, shape (size,)
        State vectors.
    stats : Stats
        What it cost to compute.
    known : Remembered
        What a run knows beside the state vectors; nothing for a state that was not simulated.
    """

    def __init__(
        self,
        system: System,
        t: float,
        q: FloatArray,
        v: FloatArray,
        stats: Stats | None = None,
        known: Remembered | None = None,
    ) -> None:
        self.system, self.model, self.t = system, system.model, t
        self.known = Remembered() if known is None else known
        self.derivatives: dict[str, Any] = {}  # by the name of a parameter, None: it does not depend on it
        self.stats = Stats() if stats is None else stats
        self._q, self._v = q, v
        self._moving: tuple[FloatArray, FloatArray] | None = None
        self._bodies, self._slots = self.model.bodies, system.slots
        self._joints, self._arcs, self._lengths = system.joints, system.numbering.arcs, system.lengths
        self._springs = springs_of(system.model.connections)

    def __repr__(self) -> str:
        return line_of_state(self)

    def _sheet(self) -> Sheet:
        return of_state(self)

    @property
    def rests(self) -> bool:
        """Whether it is an equilibrium of bodies without motion: supports that move count as at rest."""
        return self.known.balanced and all(map(initial_motion.at_rest, self.model.bodies.values()))

    @property
    def rates(self) -> FloatArray:
        """Rates with which forces act, shape (size,): none in an equilibrium, whose supports may move."""
        return np.zeros_like(self.v) if self.rests else self.v

    def contact_line(self, contact: Any) -> ContactLine:
        """What a beam and a surface do to each other along the beam: gap, normal force, friction, slip.

        Friction depends on the way until the state. It is known of an equilibrium and of the last state of a
        simulation; of others it is zero here, with the limit zero.

        Parameters
        ----------
        contact : SurfaceContact or its name

        Raises
        ------
        ModelError
            There is no such contact with a surface.
        """
        items = [c for c in self.model.connections if isinstance(c, SurfaceContact)]
        item = next((c for c in items if c is contact or c.name == contact), None)
        if item is None:
            name = getattr(contact, "name", contact)
            there = ", ".join(c.name for c in items) or "none"
            raise ModelError(named(name), f"is no contact with a surface here; there are: {there}")
        parts = dict(self.system.parts)
        if "rubbing" in parts:
            known = self._memory_of("rubbing") or {"acted": np.zeros_like(parts["rubbing"].acted)}
            parts["rubbing"] = parts["rubbing"]._replace(**known)
        return contact_line(parts, items, item, self.q, self.rates)

    def _turned_to(self, spring: Any) -> float | None:
        return self._remembered_turn(spring, self.known.memory)

    def _memory_of(self, part: str) -> dict[str, FloatArray] | None:
        found = {
            key.partition(".")[2]: x for key, x in self.known.memory.items() if key.startswith(f"{part}.")
        }
        return found or None

    def _contact_system(self) -> System:
        return self.system

    @property
    def energy(self) -> Energy:
        """Energies; nothing is dissipated or supplied at one time."""
        kinetic, strain, potential = energies(self.system, self.q[None], self.v[None])[0]
        zero = np.float64(0.0)
        return Energy(kinetic, strain, potential, zero, zero)  # type: ignore[arg-type]

    @property
    def notes(self) -> list[str]:
        """What to know of an equilibrium that nobody asked for: cables that are pressed harder than they can
        stand, bodies that are stretched by more than a tenth, cables that bend too sharply for their
        elements, whose forces waver within these, or are so stiff that they bend too little, bodies that
        have fallen over, are below a ground or turned round in their clamps, friction that does not act
        from the initial shape.

        It takes about as long as an iteration of the equilibrium, when it is asked for.
        """
        pressed = tension.notes(tension.compressions(self))
        bent = sharp_bends.notes(sharp_bends.sharp_bends(self))
        wavers = wavering.notes(wavering.waverings(self))
        turned = turned_bends.notes(self)
        return [
            *pressed,
            *stretched.notes(stretched.stretched(self)),
            *bent,
            *turned,
            *wavers,
            *laid.notes(self),
            *fallen.notes(self),
            *of_bodies(self),
            *accuracy.of_state(self),
        ]

    def sensitivity(self, name: str) -> Any:
        """Derivatives by a parameter of everything that the state answers, per unit of it.

        Parameters
        ----------
        name : str
            One that was asked for by ``sensitivities=`` of :func:`ancf.equilibrium` or :func:`ancf.simulate`.

        Returns
        -------
        Sensitivity
            ``state.sensitivity("rope.EA").position(point)`` and so on.

        Raises
        ------
        ModelError
            It was not asked for.
        """
        return sensitivity_of(self.derivatives, name)

    def fixed(self, names: Sequence[str]) -> State:
        """The same state as a start that does not depend on these parameters."""
        other = State(self.system, self.t, self._q, self._v, self.stats, self.known)
        other.derivatives = self.derivatives | dict.fromkeys(names)
        return other

    def _in_motion(self) -> tuple[FloatArray, FloatArray]:
        if self._moving is None:
            self._moving = motions.of_state(self.system, self.q, self.v, self.t, self.known)
        return self._moving

    def _each_state(self) -> list[Any]:
        return [(self.q, self.v, self.t, self.known)]

    def _at_rest(self, name: str) -> FloatArray | None:
        return motions.at_rest(self.system, self.q, self.rates, self.t, self.known, name)
