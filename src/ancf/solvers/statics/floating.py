"""Which bodies nothing holds: they have no equilibrium."""

from __future__ import annotations

import numpy as np

from ...errors import ModelError
from ...model.joints.touching import bodies_of, to_ground
from ...model.kinds import kind_of
from ...model.loads.load import Force
from ...model.loads.state_function import StateFunction
from ...model.points import initial_position
from ...system.system import System


def check_supported(system: System, ignored: list[str]) -> None:
    """Raise ModelError if a body, or a group of connected bodies, can move freely in some direction.

    ``ignored`` are bodies that are held altogether: they support what is connected to them.  A load that
    depends on the place may hold a body.
    """
    groups = {name: {name} for name in system.model.bodies}
    grounded: set[str] = set(ignored)
    for load in system.model.loads:
        if kind_of(load).has_batch(load) and not (isinstance(load, Force) and _only_resists(load)):
            grounded.update(bodies_of(load))
    for item in system.model.connections:
        touched = bodies_of(item)
        if to_ground(item):
            grounded.update(touched)
        merged = set().union(*(groups[name] for name in touched))
        for name in merged:
            groups[name] = merged
    for names in {id(g): g for g in groups.values()}.values():
        if names & grounded:
            continue
        borne = 2 if any(_borne(system, name) for name in names) else None
        free = [c for c in range(3) if c != borne and not any(_holds(system, name, c) for name in names)]
        if free:
            label = " and ".join(f'"{n}"' for n in sorted(names))
            axes = ", ".join("xyz"[c] for c in free)
            raise ModelError(
                "supports",
                f"nothing holds {label} in {axes}: it floats and has no equilibrium",
                "connect it to what holds it, model.connect(...), or add model.pin(...) or model.clamp(...)",
            )


def _only_resists(load: Force) -> bool:
    """Whether a law of the state does not depend on the place."""
    return isinstance(load.force, StateFunction) and not load.force.depends_on_place(
        initial_position(load.point)
    )


def _borne(system: System, name: str) -> bool:
    """Whether a body lies on a ground or floats at the surface of a fluid; friction alone holds nothing."""
    model = system.model
    fluids = [fluid for fluid in model.fluids if fluid.above is not None or fluid.below is not None]
    return any(g.acts_on(name) for g in model.grounds) or any(f.acts_on(name) for f in fluids)


def _holds(system: System, name: str, component: int) -> bool:
    positions = system.numbering.slots[name][:, 0] + component
    return bool(np.isin(positions, system.core.supports.held).any())
