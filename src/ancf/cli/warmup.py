"""``ancf warmup``: compile what runs need before they need it."""

from __future__ import annotations

import time
import warnings
from collections.abc import Callable, Iterator
from typing import Any

from .. import Explicit, Model, Radau, Section, equilibrium, modes, simulate
from ..compilation import announce
from .screen import Screen

ROPE: dict[str, Any] = {"EA": 1e4, "EI": 0.01, "rhoA": 0.1, "bending_damping": 1e-4}


def warm_up(quiet: bool = False) -> None:
    """Run small models of all kinds, so that their kernels lie in the cache; what is there takes no time."""
    screen = Screen(quiet)
    announce(lambda _: None)  # each part says how long it took
    began = time.perf_counter()
    for name, work in parts():
        start = time.perf_counter()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            work()
        screen.say(f"{name}: {time.perf_counter() - start:.1f} s")
    screen.say(f"ready after {time.perf_counter() - began:.0f} s")


def parts() -> Iterator[tuple[str, Callable[[], object]]]:
    """What is compiled one after the other, with the words that are said of it."""
    yield "cables, time stepping", lambda: simulate(_cable(), t_end=0.002, step=0.001)
    yield "equilibria", lambda: equilibrium(_cable())
    yield "modes", _modes
    yield "beams with a cross-section", lambda: simulate(_beams(), t_end=0.002, step=0.001)
    yield "rigid bodies, joints, springs", lambda: simulate(_joints(), t_end=0.002, step=0.001)
    yield "sliding joints", lambda: simulate(_bead(), t_end=0.002, step=0.001)
    yield "grounds, fluids, follower loads", lambda: simulate(_surrounded(), t_end=0.002, step=0.001)
    yield "explicit stepping", lambda: simulate(_cable(), t_end=2e-5, step=1e-5, integrator=Explicit())
    yield "Radau's method", lambda: simulate(_cable(), t_end=0.002, step=0.001, integrator=Radau())


def _modes() -> None:
    model = _cable()
    modes(model, about=equilibrium(model), count=1)


def _cable() -> Model:
    model = Model(gravity=(0.0, 0.0, -9.81))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=Section(**ROPE))
    model.pin(rope.start)
    model.clamp(rope.end)
    model.add_distributed_load(rope, (0.0, 0.1, 0.0))
    model.add_moment(rope.at(0.5), (0.0, 0.01, 0.0))
    return model


def _beams() -> Model:
    model = Model(gravity=(0.0, 0.0, -9.81))
    section = Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0, nu=0.3)
    for y, element in enumerate(("original", "nonlocking")):
        ends: Any = {"start": (0, y, 0), "end": (1, y, 0)}
        beam = model.add_beam(element, elements=2, section=section, element=element, **ends)
        model.clamp(beam.start)
        model.add_moment(beam.end, (0.01, 0.0, 0.0))
    return model


def _joints() -> Model:
    model = _cable()
    rope = model.beams["rope"]
    rod = model.add_rigid_body("rod", at=(0.5, 0, -1), mass=1.0, inertia=(0.1, 0.1, 0.1))
    mass = model.add_point_mass("mass", at=(0.5, 0, -2), mass=1.0)
    model.connect(rope.at(0.5), rod.at(0, 0, 1))
    model.add_spring(rod.centre, mass, stiffness=100.0, damping=0.1, slack=True)
    other = model.add_rigid_body("other", at=(2.5, 0, -1), mass=1.0, inertia=(0.1, 0.1, 0.1))
    model.hinge(rod.at(1, 0, 0), other.at(-1, 0, 0), axis=(0, 1, 0))
    model.add_torsion_spring(rod, other, axis=(0, 1, 0), stiffness=1.0)
    return model


def _bead() -> Model:
    model = _cable()
    mass = model.add_point_mass("bead", at=(0.25, 0, 0), mass=0.1)
    model.slide(mass, along=model.beams["rope"], friction=0.1)
    return model


def _surrounded() -> Model:
    model = Model(gravity=(0.0, 0.0, -9.81))
    section = Section(EA=1e4, EI=0.01, rhoA=0.1, diameter=0.01, drag=(1.0, 0.01), added_mass=(1.0, 0.0))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
    model.pin(rope.start)
    model.pin(rope.end)
    turning: Any = model  # these methods are those of registered kinds
    turning.add_follower_force(rope.at(0.5), (0.01, 0.0, 0.0))
    turning.add_pressure(rope, 0.01, axis=(0.0, 1.0, 0.0))
    model.add_fluid("water", 1000.0, velocity=(0.1, 0.0, 0.0))
    model.add_ground("seabed", height=-0.01, stiffness=1e4, damping=10.0, friction=0.3)
    return model
