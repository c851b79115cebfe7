"""What sensitivities and gradients cost, in runs: ``python benchmarks/sensitivities.py [CASE...]``.

Processor time of ``ancf.simulate`` with sensitivities by 1, 8 and 16 numbers of a model, and of
``ancf.gradient`` by as many, from the model to the last number, next to that of the run alone: medians of
some rounds.  The last columns are what a further parameter costs, from the first to the 16th.  Printed,
nothing is stored.
"""

from __future__ import annotations

import sys
import time
from functools import partial
from pathlib import Path
from statistics import median
from typing import Any

import ancf
from ancf import catenary
from ancf.paper import cantilever, pendulum, sliding

COUNTS = 1, 8, 16
#: Of a run along a line.
DROPPERS = [f"{span}-{number}" for span in (2, 3) for number in range(1, 8)] + ["4-1", "4-2"]
ROUNDS = 5
#: Of a beam, in this order.
SEA = {"spectrum": "jonswap", "height": 4.0, "period": 9.0, "depth": 60.0, "components": 60, "seed": 1}
NUMBERS = ["EI", "rhoA", "EA", "length", "bending_damping", "axial_damping", "damping"]


def in_space(elements: int = 32, stays: int = 0, **damping: float) -> ancf.Model:
    """The pendulum of example 7.2, perhaps with dampings, on springs."""
    square = pendulum.section()
    section = ancf.Section(EA=square.EA, EI=square.EI, rhoA=square.rhoA, **damping)
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section)
    rope.set_motion(angular_velocity=pendulum.READINGS["spatial"])
    model.pin(rope.start)
    for k in range(stays):
        place = (k + 0.5) / stays
        model.add_spring(
            rope.at(place), (place, 0, 0.3), stiffness=2.0, damping=0.01, length=0.3, name=f"stay{k}"
        )
    return model


def falling() -> ancf.Model:
    """The cantilever of example 7.1."""
    square = cantilever.section()
    section = ancf.Section(EA=square.EA, EI=square.EI, rhoA=square.rhoA)
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section)
    model.clamp(rope.start)
    return model


def moored(elements: int = 32, **sea: Any) -> ancf.Model:
    """A chain between an anchor and a point that moves, in a current and perhaps in waves."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    chain = {
        "EA": 5e7,
        "EI": 10.0,
        "rhoA": 40.0,
        "axial_damping": 1e5,
        "bending_damping": 1.0,
        "damping": 0.1,
    }
    hull = {"diameter": 0.08, "drag": (1.3, 0.2), "added_mass": (1.0, 0.1)}
    section = ancf.Section(**chain, **hull)
    given = {"start": (0.0, 0.0, -60.0), "end": (90.0, 0.0, -4.0), "length": 110.0}
    rope = model.add_beam("rope", elements=elements, section=section, **given)
    model.pin(rope.start)
    model.pin(rope.end, displacement=("0.5*sin(0.8*t)", 0.0, "0.8*sin(0.8*t)"))
    model.add_fluid("sea", density=1025.0, velocity=(0.6, 0.2, 0.0), below=0.0, **sea)
    return model


def lying(elements: int = 32) -> ancf.Model:
    """A mooring line that lies on a ground with friction, whose upper end moves."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    damping = {"axial_damping": 1e5, "bending_damping": 1.0, "damping": 0.1}
    section = ancf.Section(EA=5e6, EI=10.0, rhoA=20.0, diameter=0.08, **damping)
    path = [(0, 0, -20), (40, 0, -20), (70, 2, 0)]
    rope = model.add_beam("rope", path=path, elements=elements, section=section)
    model.add_ground("bed", height=-20.0, stiffness=2e5, damping=1e4, friction=0.4, stick=5e4)
    model.pin(rope.start)
    model.pin(rope.end, displacement=("0.5*sin(0.8*t)", "0.3*sin(0.5*t)", "0.3*sin(0.9*t)"))
    return model


def drawn(elements: int = 24) -> ancf.Model:
    """A rope with a mass at its end over a drum with friction, drawn to and fro by its other end."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    damping = {"axial_damping": 20.0, "bending_damping": 1e-4, "damping": 0.05}
    section = ancf.Section(EA=2e4, EI=0.05, rhoA=0.2, diameter=0.02, **damping)
    given = {"start": (-0.8, 0, 0), "end": (0.8, 0.02, 0), "elements": elements, "section": section}
    rope = model.add_beam("rope", **given)
    drum = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0, 1, 0), at=(0, 0, -0.2102)))
    model.add_contact(rope, drum, stiffness=1e5, damping=30.0, friction=0.1, name="on")
    model.connect(model.add_point_mass("bob", at=(0.8, 0.02, 0), mass=0.3).point, rope.end)
    stay = {"stiffness": 300.0, "damping": 2.0, "length": 0.5, "name": "stay"}
    model.add_spring(rope.start, (-0.8, 0, -0.6), **stay)
    model.add_force(rope.start, ("-2*sin(5*t)**2", 0.0, "-4*sin(9*t)**2"), name="pull")
    return model


def of_moored() -> list[str]:
    """Sixteen numbers of that model."""
    own = [f"rope.{name}" for name in ("EI", "rhoA", "EA", "length", "bending_damping", "axial_damping")]
    own += ["rope.diameter", "rope.drag[0]", "rope.drag[1]", "rope.added_mass[0]", "rope.added_mass[1]"]
    return [*own, "sea.density", "gravity[2]", "rope.start[0]", "rope.start[2]", "rope.damping"]


def lined(elements: int = 32) -> ancf.Model:
    """A wire on 15 droppers, and a collector on a spring whose strip goes along it."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=1e5, EI=2.0, rhoA=1.0, damping=0.05)
    given = {"start": (0, 0, 0), "end": (32, 0, 0), "elements": elements, "length": 31.7}
    wire = model.add_beam("rope", section=section, **given)
    model.pin(wire.start)
    model.pin(wire.end)
    for k in range(15):
        dropper = {"stiffness": 2e3, "length": 0.49, "damping": 1.0, "name": f"dropper{k}"}
        model.add_spring(wire.at((2.0 + 2 * k) * 31.7 / 32), (2.0 + 2 * k, 0, 0.5), **dropper)
    head = model.add_point_mass("head", at=(1.037, 0, 0.001), mass=4.0)
    model.hold(head, position="xy", displacement=("20*t", 0, 0))
    foot = model.add_point_mass("foot", at=(1.037, 0, -0.5), mass=1.0)
    model.pin(foot, displacement=("20*t", 0, 0))
    model.add_spring(head, foot, stiffness=300.0, length=0.75, damping=10.0, name="lift")
    strip = {"strip": (0.0, 1.0, 0.0), "normal": (0.0, 0.0, 1.0), "name": "strip"}
    model.add_contact(head, wire, stiffness=5e3, damping=30.0, **strip)
    return model


def solid(turned: bool) -> ancf.Model:
    """A damped beam with a section, perhaps with a moment."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section.rectangle(0.1, 0.05, E=1e8, rho=900.0, axial_damping=5e3, bending_damping=3.0)
    given = {"start": (0, 0, 0), "end": (3, 0, 0), "elements": 16, "section": section}
    beam = model.add_beam("rope", element="nonlocking", **given)
    model.clamp(beam.start)
    if turned:
        model.add_moment(beam.end, (8.0, "9*sin(50*t)", 5.0), name="turn")
    return model


def blown(elements: int = 32) -> ancf.Model:
    """A damped cable between two pins under a pressure that changes."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    damping = {"axial_damping": 0.5, "bending_damping": 1e-4, "damping": 0.05}
    section = ancf.Section(EA=500.0, EI=0.05, rhoA=0.2, diameter=0.02, **damping)
    given = {"start": (0, 0, 0), "end": (1, 0.1, 0), "elements": elements, "section": section}
    rope = model.add_beam("rope", length=1.05, **given)
    model.pin(rope.start)
    model.pin(rope.end)
    model.add_pressure(rope, "4*sin(30*t)", (0.0, 1.0, 0.0), name="blow")
    return model


def crossed(elements: int = 16) -> ancf.Model:
    """A taut cable between two pins, and another one that falls on it and swings there."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    damping = {"axial_damping": 20.0, "bending_damping": 1e-3, "damping": 0.2}
    section = ancf.Section(EA=2e4, EI=0.05, rhoA=0.2, diameter=0.02, **damping)
    given = {"elements": elements, "section": section}
    low = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, 0), length=0.998, **given)
    top = model.add_beam("top", start=(0.5, -0.5, 0.021), end=(0.5, 0.5, 0.021), length=1.0, **given)
    for beam in (low, top):
        model.pin(beam.start)
        model.pin(beam.end)
    model.add_contact(low, top, stiffness=1e4, damping=10.0, name="touch")
    return model


def piled(count: int = 4) -> ancf.Model:
    """A pile of balls on a plane, each on springs."""
    model = ancf.Model(gravity=(0.3, 0.0, -9.81))
    below = model.add_surface("floor", ancf.Plane())
    for k in range(count):
        at = 0.01 * k, 0.005 * k, 0.1 + 0.2 * k
        ball = model.add_rigid_body(f"b{k}", at=at, mass=0.5, inertia=(0.002, 0.003, 0.004))
        stay = {"stiffness": 200.0, "damping": 2.0, "length": 0.5, "name": f"stay{k}"}
        model.add_spring(ball.centre, (0.5, 0.3, at[2]), **stay)
        skin = model.add_surface(f"skin{k}", ancf.Sphere(radius=0.1), on=ball)
        model.add_contact(skin, below, stiffness=2e4, damping=30.0, name=f"on{k}")
        below = skin
    return model


def of_rope() -> list[str]:
    """Sixteen numbers of a model with one rope."""
    ends = [f"rope.{end}[{k}]" for end in ("start", "end") for k in range(3)]
    return [f"rope.{name}" for name in NUMBERS] + [f"gravity[{k}]" for k in range(3)] + ends


def cases() -> dict[str, tuple[ancf.Model, list[str], str, dict[str, Any]]]:
    """By name the model, the parameters, what gradients are of, and the settings."""
    square = {"axial_damping": 0.5, "bending_damping": 1e-4, "damping": 0.01}
    tip = "integral(norm(velocity({}))**2)"
    stays = [f"stay{k}.length" for k in range(16)]
    own = [f"{body}.{name}" for body in ("carrier", "slider") for name in ("E", "rho", "length")]
    own += ["tip.mass", "gravity[0]", "gravity[1]", "gravity[2]"]
    end, middle = tip.format("rope.end"), tip.format("rope.at(50)")
    of_lined = ["head.mass", "lift.stiffness", "lift.length", "strip.stiffness"]
    of_lined += [f"dropper{k}.length" for k in range(12)]
    of_lying = [f"rope.{name}" for name in (*NUMBERS, "diameter")] + [f"gravity[{k}]" for k in range(3)]
    of_lying += [f"bed.{name}" for name in ("stiffness", "friction", "damping", "stick", "height")]
    of_drawn = [f"rope.{name}" for name in NUMBERS] + [f"gravity[{k}]" for k in range(3)]
    of_drawn += ["on.friction", "on.stiffness", "on.damping", "bob.mass", "stay.stiffness", "stay.length"]
    of_blown = [f"rope.{name}" for name in (*NUMBERS, "diameter")] + [f"gravity[{k}]" for k in range(3)]
    of_blown += [*(f"rope.end[{k}]" for k in range(3)), "rope.start[0]", "blow.pressure"]
    of_crossed = [f"{rope}.{name}" for rope in ("rope", "top") for name in NUMBERS[:6]]
    of_crossed += ["gravity[2]", "gravity[1]", "touch.stiffness", "touch.damping"]
    of_piled = [f"{name}{k}" for name in ("b", "stay", "on") for k in range(4)]
    kinds = {"b": ["mass"], "s": ["length"], "o": ["stiffness", "damping"]}
    of_piled = [f"{name}.{kind}" for name in of_piled for kind in kinds[name[0]]]
    of_solid = ["rope.E", "rope.rho", "rope.axial_damping", "rope.bending_damping", "rope.length"]
    of_solid += [f"gravity[{k}]" for k in range(3)]
    return {
        "7.1, 4 elements, 1600 steps": (falling(), of_rope(), end, _set(1600, 2.5e-4)),
        "7.2, 32 elements, 1000 steps": (in_space(), of_rope(), end, _set(1000, 1e-4)),
        "7.2, 32 elements, 8000 steps": (in_space(), of_rope(), end, _set(8000, 1e-4)),
        "damped, 32 elements, 1000 steps": (in_space(**square), of_rope(), end, _set(1000, 1e-4)),
        "damped, 32 elements, 8000 steps": (in_space(**square), of_rope(), end, _set(8000, 1e-4)),
        "16 springs, 32 elements, 2000 steps": (in_space(32, 16), stays, end, _set(2000, 1e-4)),
        "current, 32 elements, 1000 steps": lambda: _hung(moored(), of_moored(), middle),
        "waves, 32 elements, 1000 steps": lambda: _hung(moored(waves=SEA), of_moored(), middle),
        "strip, 32 elements, 1000 steps": (lined(), of_lined, tip.format("head"), _set(1000, 1e-3)),
        "friction on a bed, 32 elements, 1000 steps": lambda: _hung(
            lying(), of_lying, tip.format("rope.at(35)")
        ),
        "friction on a drum, 24 elements, 1000 steps": lambda: _hung(
            drawn(), of_drawn, tip.format("bob"), 1e-3
        ),
        "pressure, 32 elements, 1000 steps": (
            blown(),
            of_blown,
            tip.format("rope.at(0.4)"),
            _set(1000, 1e-3),
        ),
        "crossed, 2 of 16 elements, 1000 steps": (
            crossed(),
            of_crossed,
            tip.format("top.at(0.3)"),
            _set(1000, 1e-3),
        ),
        "pile of 4 balls, 1000 steps": (piled(), of_piled, tip.format("b3.centre"), _set(1000, 1e-3)),
        "damped solid, 16 elements, 500 steps": (solid(False), of_solid, end, _set(500, 1e-3)),
        "moment, 16 elements, 500 steps": (solid(True), of_solid, end, _set(500, 1e-3)),
        "7.4, 6+2 elements, 2000 steps": (sliding.build(), own, tip.format("slider.end"), _set(2000, 2e-4)),
    }


def _hung(model: ancf.Model, names: list[str], objective: str, step: float = 1e-2) -> Any:
    """A case that starts from the equilibrium of a rope, of 1000 steps."""
    start = ancf.equilibrium(model, of=["rope"], sensitivities=names)
    return model, names, objective, _set(1000, step) | {"start": start}


def _set(steps: int, step: float) -> dict[str, Any]:
    return {"t_end": steps * step, "step": step}


def along_line() -> list[float]:
    """Of a run along four spans of an overhead line s, and by lengths of droppers runs each."""
    line = catenary.read_line(Path(__file__).parents[1] / "examples" / "droppers_line.toml")
    given = {"speed": 280.0 / 3.6, "pantograph": "en50318-2002", "step": 2e-3, "window": (65.0, 195.0)}
    shape = catenary.form(line, catenary.Mesh(contact=2.0, messenger=3.0))

    def by(count: int) -> None:
        wanted = {"sensitivities": {name: [name] for name in DROPPERS[:count]}} if count else {}
        catenary.run(shape, start=14.0, **given, **wanted)

    return ratios(lambda: by(0), [partial(by, count) for count in COUNTS])


def seconds(work: Any) -> float:
    """Processor time of a call."""
    begin = time.process_time()
    work()
    return time.process_time() - begin


def measured(model: ancf.Model, names: list[str], objective: str, settings: dict[str, Any]) -> list[float]:
    """Of a run s, of sensitivities and gradients by some parameters runs each."""

    def run() -> None:
        ancf.simulate(model, **settings)

    works: list[Any] = []
    for count in COUNTS:
        works.append(lambda n=count: ancf.simulate(model, sensitivities=names[:n], **settings))
    for count in COUNTS:
        works.append(lambda n=count: ancf.gradient(model, objective, names[:n], **settings))
    return ratios(run, works)


def ratios(run: Any, works: list[Any]) -> list[float]:
    """Processor time of a run in s, and of each of the works in runs, medians of some rounds."""
    for work in (run, *works):
        work()
    pairs = [[(seconds(run), seconds(work)) for work in works] for _ in range(ROUNDS)]
    runs = [own for row in pairs for own, _ in row]
    found = [[theirs / own for own, theirs in row] for row in pairs]
    return [median(runs), *(median(column) for column in zip(*found, strict=True))]


if __name__ == "__main__":
    heads = [*map(str, COUNTS), "each", *(f"g {n}" for n in COUNTS), "g each"]
    print(f"{'runs':44}{'run, s':>8}", *(f"{head:>6}" for head in heads))
    for name, make in cases().items():
        if not sys.argv[1:] or any(word in name for word in sys.argv[1:]):
            case = make() if callable(make) else make
            run, *found = measured(*case)
            k, n = len(COUNTS), len(case[1]) - COUNTS[0]
            forward, back = found[:k], found[k:]
            row = [*forward, (forward[-1] - forward[0]) / n, *back, (back[-1] - back[0]) / n]
            print(f"{name:44}{run:8.3f}", *(f"{x:6.2f}" for x in row), flush=True)
    if not sys.argv[1:] or "line" in sys.argv[1:]:
        run, *forward = along_line()
        each = (forward[-1] - forward[0]) / (COUNTS[-1] - COUNTS[0])
        print(f"{'a line of 4 spans, by droppers':44}{run:8.3f}", *(f"{x:6.2f}" for x in (*forward, each)))
