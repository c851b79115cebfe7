"""Models by name, each with a method and steps, whose runs are left anywhere and go on."""

import ancf
from helpers import soft
from mechanisms import mechanism
from motions import ball, driven_clamp, pendulum, rod_on_a_hinge


def thrown(at_end):
    """A bead that runs off the end of a bar which is held."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    bar = model.add_rigid_body("bar", at=(0.5, 0, 0), mass=1.0, inertia=(0.1, 0.1, 0.1))
    model.clamp(bar)
    bead = model.add_point_mass("bead", at=(0.9, 0, 0), mass=0.2)
    bead.set_motion(velocity=(2.0, 0, 0))
    model.slide(bead, along=bar, line=((-0.5, 0, 0), (0.5, 0, 0)), at_end=at_end, name="slider")
    return model


def rope():
    model, beam = pendulum()
    model.add_force(beam.end, ["0.5*sin(40*t)", "0", "0"])
    return model


def bare():
    """A cable without damping, which the explicit method takes with large steps."""
    model, beam = pendulum(EA=100.0, damping=0.0)
    model.add_force(beam.end, ["0.5*sin(40*t)", "0", "0"])
    return model


def strut():
    """A beam with a section under a torque and an axis that turns."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(0.8, 0, 0), elements=2, section=soft("nonlocking"), element="nonlocking"
    )
    model.clamp(beam.start, rotation="0.3*sin(5*t)", axis=(1, 0.2, 0))
    model.add_moment(beam.end, ("0.05*sin(9*t)", 0, 0))
    return model


def droppers():
    """A wire that hangs on slack springs and is lifted now and then."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.5, rhoA=0.5, damping=0.05)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(3, 0, 0), elements=6, section=section, length=2.99)
    model.pin(wire.start)
    model.pin(wire.end)
    for k, x in enumerate((0.6, 1.2, 1.9, 2.5)):
        model.add_spring(
            wire.at(x), (x, 0, 0.5), stiffness=2e3, damping=1.0, length=0.5, slack=True, name=f"d{k}"
        )
    model.add_force(wire.at(1.5), (0, 0, "20*sin(30*t)"))
    return model


def strip():
    """A sprung mass with a strip runs along a wire and bounces under it."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e5, EI=2.0, rhoA=0.3)
    wire = model.add_beam("wire", start=(0, 0, 0), end=(4, 0, 0), elements=8, section=section, length=3.99)
    model.pin(wire.start)
    model.pin(wire.end)
    pan = model.add_point_mass("pan", at=(1.0, 0, -0.01), mass=0.5)
    pan.set_motion(velocity=(3.0, 0, 0))
    model.hold(pan, position="xy", displacement=("3*t", 0, 0))
    model.add_force(pan, (0, 0, "8 + 12*sin(25*t)"))
    model.add_contact(pan, along=wire, stiffness=5e3, damping=1.0, name="strip")
    return model


def pulled():
    """A contact that is pulled open and closes again."""
    return ball(force=(0, 0, "2*9.81 + 30*sin(20*t)"))[0]


def law():
    """A force by a law of the state, compiled anew in each process."""
    model, beam = pendulum()
    model.add_force(beam.end, ["-0.4*vx", "-0.4*vy", "sin(5*t) - z"])
    return model


def hauled():
    """A load on a rope that a winch hauls in."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=1e-3, rhoA=0.05, axial_damping=1.0)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1, 0, -1.5), elements=4, section=section)
    model.pin(rope.start)
    model.winch(rope.start, length="1.8 - 0.3*sin(3*t)**2", name="drum")
    load = model.add_point_mass("load", at=(1, 0, -1.5), mass=1.0)
    model.connect(rope.end, load)
    return model


def slope():
    """A cable slips down a slope in a current, pulled to and fro."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=0.1, rhoA=3.0, diameter=0.1, drag=(1.2, 0.2), added_mass=(1.0, 0.0))
    cable = model.add_beam("cable", start=(0, 0, 0), end=(2, 0, -0.6), elements=4, section=section)
    model.add_ground("slope", 0.0, normal=(0.3, 0, 1), stiffness=2e4, damping=300.0, friction=0.28)
    model.add_fluid("current", 100.0, velocity=(0, 0.5, 0), below=-0.2)
    model.add_force(cable.end, ["15*sin(30*t)", "4*cos(50*t)", 0])
    return model


def over_a_sheave():
    """A winch hauls a rope over a sheave that it turns, sticking and slipping."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=1e-3, rhoA=0.05, axial_damping=1.0, diameter=0.02)
    path = [(-0.21, 0, -0.6), (-0.21, 0, 0), (-0.15, 0, 0.15), (0, 0, 0.21), (0.4, 0, 0.21)]
    rope = model.add_beam("rope", path=path, elements=14, section=section, natural_shape="straight")
    hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=0.5, inertia=(0.01, 0.01, 0.01))
    model.hinge(hub, (0, 0, 0), axis=(0, 1, 0))
    sheave = model.add_surface("sheave", ancf.Cylinder(radius=0.18, axis=(0, 1, 0)), on=hub)
    model.add_contact(rope, sheave, stiffness=1e5, damping=30.0, friction=0.3, name="over")
    model.connect(rope.start, model.add_point_mass("load", at=path[0], mass=0.5))
    model.pin(rope.end)
    model.winch(rope.end, length=f"{rope.length} - 0.2*sin(9*t)**2")
    return model


PATCHED = ancf.Trapezoidal(newton=ancf.Newton(corotate=False))
ALPHA = ancf.GeneralizedAlpha(0.7)
#: By name: model, method, step in s, number of steps, sensors.
RUNS = {
    "cable": (rope, ancf.Trapezoidal(), 1e-3, 220, ["beam.end"]),
    "cable, alpha": (rope, ALPHA, 1e-3, 150, ["beam.end"]),
    "cable, radau": (rope, ancf.Radau(tolerance=1e-5), 2e-3, 60, ["beam.end"]),
    "cable, constant radau": (rope, ancf.Radau(adaptive=False, stages=2), 2e-3, 60, ["beam.end"]),
    "cable, explicit": (bare, ancf.Explicit(check=False), 2e-4, 300, ["beam.end"]),
    "cable, 7 steps": (rope, ancf.Trapezoidal(), 1e-3, 7, ["beam.end"]),
    "law": (law, ancf.Trapezoidal(), 1e-3, 80, ["beam.end"]),
    "led clamp": (lambda: driven_clamp("free")[0], ALPHA, 1e-3, 90, ["beam.end"]),
    "beam": (strut, ancf.Trapezoidal(), 1e-3, 60, ["beam.end"]),
    "winch": (hauled, ancf.Trapezoidal(), 1e-3, 80, ["rope.start", "rope.at(0.7)"]),
    "slope": (slope, ancf.Trapezoidal(), 1e-3, 100, ["cable.end"]),
    "sheave": (over_a_sheave, ALPHA, 1e-3, 120, ["rope.end", "over"]),
    "hinge": (lambda: rod_on_a_hinge()[0], ancf.Trapezoidal(), 7e-4, 120, ["hinge"]),
    "hinge, radau": (lambda: rod_on_a_hinge()[0], ancf.Radau(), 2e-3, 60, ["hinge"]),
    "joints": (lambda: mechanism().model, ALPHA, 1e-3, 60, ["on wire", "hook"]),
    "opens": (
        lambda: ball(force=(0, 0, "2*9.81 + 30*sin(20*t)"))[0],
        ancf.Trapezoidal(),
        1e-3,
        200,
        ["contact"],
    ),
    "let go": (lambda: thrown("release"), ancf.Trapezoidal(), 1e-3, 90, ["slider"]),
    "slack springs": (droppers, PATCHED, 1e-3, 150, ["d1"]),
    "slack springs, turned": (droppers, ancf.Trapezoidal(), 1e-3, 80, ["d1"]),
    "strip": (strip, PATCHED, 1e-3, 150, ["strip"]),
    "strip, radau": (strip, ancf.Radau(tolerance=1e-3), 2e-3, 40, ["strip"]),
}


def adaptive(method):
    """Whether steps are chosen by the time that is left too."""
    return isinstance(method, ancf.Radau) and method.adaptive
