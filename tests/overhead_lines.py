"""A short line with unequal spans and stagger for quick runs, in Python and as a file."""

from ancf.catenary import Line, Mesh, Pantograph, Rayleigh, Span, SteadyArm, Wire
from ancf.catenary.lines.fittings import Droppers

#: Lengths of the spans in m, and sideways places of the contact wire at the supports in m.
LENGTHS = (30.0, 36.0, 32.0, 38.0, 30.0)
STAGGER = (0.2, -0.2, 0.25, -0.1, 0.2, -0.2)
COARSE = Mesh(contact=2.0, messenger=3.0)
#: Step of the quick runs, s.
STEP = 2e-3


def droppers(length):
    """Five droppers at equal distances."""
    return tuple(round(length * share, 3) for share in (0.1, 0.3, 0.5, 0.7, 0.9))


def short_line(**changes):
    """Five unequal spans with stagger, 166 m in all."""
    given = {
        "title": "Short line",
        "spans": [Span(length=length, droppers=droppers(length)) for length in LENGTHS],
        "contact_wire": Wire(EA=15e6, EI=195.0, mass=1.35, tension=20e3),
        "messenger_wire": Wire(EA=11.6e6, EI=131.7, mass=1.07, tension=16e3),
        "droppers": Droppers(stiffness=1e5),
        "steady_arm": SteadyArm(vertical=300.0),
        "system_height": 1.2,
        "stagger": STAGGER,
        "damping": Rayleigh(alpha=0.0125, beta=1e-4),
    }
    return Line(**(given | changes))


def collector(**changes):
    """The two masses of the reference model of 2002, without its tie to a height."""
    given = {
        "masses": (15.0, 7.2),
        "stiffness": (50.0, 4200.0),
        "damping": (90.0, 10.0),
        "static_force": 120.0,
        "name": "test",
    }
    return Pantograph(**(given | changes))


TOML = """
title = "Short line"
system_height = 1.2
stagger = 0.2
[contact_wire]
EA = 15e6
EI = 195.0
mass = 1.35
tension = 20e3
[messenger_wire]
EA = 11.6e6
EI = 131.7
mass = 1.07
tension = 16e3
[damping]
alpha = 0.0125
beta = 1e-4
[droppers]
stiffness = 100e3
[steady_arm]
vertical = 300.0
[[spans]]
repeat = 5
length = 30.0
droppers = [4.0, 11.0, 19.0, 26.0]
"""
