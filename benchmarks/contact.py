"""Cost of contacts with surfaces: a rope on three sheaves in real time, and elements that touch nothing.

Run from the repository root: python benchmarks/contact.py

The second is measured in pairs, with and without contacts, either first in turn; the median ratio counts.
"""

from __future__ import annotations

import statistics

import numpy as np

import ancf

#: What two swinging cables of 500 elements may touch, and pairs of runs with and without.
IDLE, PAIRS = ("floor", "floor, friction", "cables", "cables, friction", "each cable itself, friction"), 8


def sheaves(elements: int = 100) -> ancf.Model:
    """A rope over three sheaves that friction turns, between two masses."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(
        EA=2e5, EI=0.01, rhoA=0.2, diameter=0.016, axial_damping=200.0, bending_damping=0.002
    )
    places = [((0, 0, 0), "right"), ((0.8, 0, -0.5), "left"), ((1.6, 0, 0), "right")]
    path = ancf.Reeving(
        [(at, 0.158, turn) for at, turn in places],
        axis=(0, -1, 0),
        start=(-0.158, 0, -0.8),
        end=(1.758, 0, -0.8),
    )
    rope = model.add_beam("rope", path=path, elements=elements, section=section)
    for k, (at, _) in enumerate(places):
        wheel = model.add_rigid_body(f"wheel {k}", at=at, mass=4.0, inertia=(0.03, 0.05, 0.03))
        model.hinge(wheel, at, axis=(0, 1, 0))
        groove = ancf.Sheave(0.15, groove=0.0085, depth=0.025, axis=(0, 1, 0))
        surface = model.add_surface(f"groove {k}", groove, on=wheel)
        model.add_contact(rope, surface, stiffness=5e6, damping=2000.0, friction=0.2)
    for end, name, mass in ((rope.start, "left", 20.0), (rope.end, "right", 21.0)):
        model.connect(model.add_point_mass(name, at=end_place(end), mass=mass), end)
    return model


def end_place(end: ancf.model.points.Point) -> np.ndarray:
    """Initial place of an end."""
    return end.body.initial_position(end.x)


def swinging(contact: str, elements: int = 1000) -> ancf.Model:
    """Two cables that swing above a floor and beside each other, and touch neither."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e5, EI=0.01, rhoA=0.2, diameter=0.01, axial_damping=10.0)
    cables = []
    for k, y in enumerate((0.0, 5.0)):
        cable = model.add_beam(
            f"cable {k}", start=(0, y, 0), end=(10, y, 0), elements=elements // 2, section=section
        )
        model.pin(cable.start)
        cables.append(cable)
    friction = 0.3 if "friction" in contact else 0.0
    if "floor" in contact:
        floor = model.add_surface("floor", ancf.Plane(at=(0, 0, -15)))
        for cable in cables:
            model.add_contact(cable, floor, stiffness=1e5, damping=10.0, friction=friction)
    pairs = {"cables": [cables], "itself": [[cable, cable] for cable in cables]}
    for one, other in [pair for word, found in pairs.items() if word in contact for pair in found]:
        model.add_contact(one, other, stiffness=1e5, damping=10.0, friction=friction)
    return model


def main() -> None:
    """Print both."""
    model = sheaves()
    start = ancf.equilibrium(model, of=["rope", "left", "right"])
    for time in (0.05, 1.0):  # the first may compile
        stats = ancf.simulate(model, t_end=time, step=1e-3, start=start, output_step=0.05).stats
    print(f"100 elements on three sheaves, 1 ms: {1.0 / stats.cpu_seconds:.2g} times real time")
    for contact in IDLE:
        ratios = []
        for pair in range(PAIRS + 1):
            seconds = [
                ancf.simulate(swinging(kind), t_end=0.5, step=1e-3, output_step=0.25).stats.cpu_seconds
                for kind in (("", contact) if pair % 2 else (contact, ""))
            ]
            if pair:  # the first may compile
                ratios.append(seconds[1] / seconds[0] if pair % 2 else seconds[0] / seconds[1])
        print(f"1000 elements that touch nothing, {contact}: {statistics.median(ratios) - 1:+.1%} of a step")


if __name__ == "__main__":
    main()
