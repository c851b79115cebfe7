"""Lines of all kinds turned end for end rest alike, and all that hangs on them is carried by what holds them.

A line that is turned by half a circle about the vertical has its last support first, and what was to its left
is to the right of who runs along it. Neither its forces nor its heights know.
"""

from dataclasses import replace

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.catenary import (
    Auxiliary,
    Conditions,
    DropperRule,
    Droppers,
    Load,
    Span,
    SteadyArm,
    StitchWire,
    Wire,
)
from helpers import some
from overhead_lines import COARSE, short_line

LENGTHS = (34.0, 41.0, 37.5, 30.0)
PLACES = ((4.0, 11.0, 19.5, 30.0), (3.5, 12.0, 20.0, 29.0, 37.0), (5.0, 17.0, 33.0), (4.5, 14.0, 26.0))
SAGS = (0.02, 0.03, 0.0, 0.01)
DROPPERS = Droppers(EA=2e5, mass=0.15, clamp_contact=0.2, clamp_messenger=0.15)
THIRD = Auxiliary(
    wire=Wire(EA=6e6, EI=40.0, mass=0.6, tension=10e3, diameter=0.01),
    height=0.4,
    droppers=Droppers(EA=2e5, mass=0.1, clamp_contact=0.1),
    places=DropperRule(first=6.0, pitch_max=10.0),
)
STITCH = StitchWire(reach=7.0, wire=Wire(EA=3e6, EI=10.0, mass=0.3, tension=2.5e3, diameter=0.0075))
SIDE = (-0.2, -0.25, -0.15, -0.22, -0.18)
KINDS = {
    "plain": {"stagger": (0.2, -0.25, 0.1, -0.2, 0.22)},
    "heights": {
        "stagger": 0.2,
        "height": (0.0, 0.02, 0.05, 0.03, 0.0),
        "messenger_support": 3e5,
        "messenger_support_mass": 8.0,
    },
    "stitch wires": {"stitch": STITCH, "stagger": 0.2},
    "auxiliary": {"auxiliary": THIRD, "stagger": 0.2},
    "twin wires": {"contact_spacing": 0.04, "stagger": 0.15},
    "curve": {
        "radius": 900.0,
        "stagger": SIDE,
        "cant": 0.05,
        "steady_arm": SteadyArm(length=1.1, mass=0.8),
        "contact_support": "free",
    },
}
STATES = {
    "design": {},
    "cold": {"temperature": -15.0, "ice": 0.2},
    "windy": {"temperature": 25.0, "wind": 9.0, "wear": 0.15},
}
CASES = [
    (kind, state, anchors)
    for kind in KINDS
    for state, anchors in (("design", "fixed"), ("cold", "fixed"), ("windy", "tension"))
]


def line(kind, state, anchors):
    changes = dict(KINDS[kind])
    radius = changes.pop("radius", None)
    spans = [
        Span(length=length, droppers=places, pre_sag=sag, radius=radius)
        for length, places, sag in zip(LENGTHS, PLACES, SAGS, strict=True)
    ]
    plain = short_line()
    wires = {k: replace(getattr(plain, k), diameter=0.012) for k in ("contact_wire", "messenger_wire")}
    if kind == "twin wires":
        wires["contact_wire"] = replace(wires["contact_wire"], tension=11e3, mass=0.9)
    given = {
        "spans": spans,
        "droppers": DROPPERS,
        "anchors": anchors,
        "conditions": Conditions(**STATES[state]),
    }
    given |= {"loads": (Load(position=52.0, mass=3.0), Load(position=90.0, mass=5.0, wire="messenger"))}
    given |= {"system_height": (1.3, 1.4, 1.45, 1.35, 1.4)}
    return short_line(**(given | wires | changes))


def turned(made):
    """The line from its other end."""
    spans = [
        replace(
            span,
            droppers=tuple(round(span.length - x, 9) for x in span.droppers[::-1]),
            pre_sag=span.pre_sag[::-1],
            radius=None if span.radius is None else -span.radius,
        )
        for span in made.spans[::-1]
    ]
    return replace(
        made,
        spans=tuple(spans),
        stagger=tuple(-y for y in made.stagger[::-1]),
        system_height=made.system_height[::-1],
        height=tuple(made.heights[::-1]),
        cant=tuple(-y for y in made.cants[::-1]),
        loads=tuple(replace(load, position=made.length - load.position) for load in made.loads),
        conditions=replace(made.conditions, wind=-made.conditions.wind),
    )


@pytest.mark.parametrize(("kind", "state", "anchors"), some(CASES))
def test_it_rests_alike_from_its_other_end(kind, state, anchors):
    made = line(kind, state, anchors)
    here, there = catenary.form(made, COARSE), catenary.form(turned(made), COARSE)
    close = 2e-3 if kind == "twin wires" else 1e-4  # heights of twin wires are found within 0.01 mm
    np.testing.assert_allclose(there.dropper_force[::-1], here.dropper_force, rtol=0, atol=close)
    np.testing.assert_allclose(there.contact_height[::-1], here.contact_height, rtol=0, atol=1e-6)
    np.testing.assert_allclose(there.arm_load[::-1] * [1, -1, 1], here.arm_load, rtol=0, atol=close)
    np.testing.assert_allclose(there.support_load[::-1], here.support_load, rtol=0, atol=close)
    order = [3, 1, 2, 0] if kind == "twin wires" else slice(None)  # its left wire is the right one then
    np.testing.assert_allclose(there.pull[order, ::-1], here.pull, rtol=0, atol=50 * close)


def weights(found):
    """Places (n, 3), m, and weights, N, of all that hangs: wires by element, droppers with clamps, masses."""
    made, g = found.line, found.line.gravity
    every = [*found.contacts, found.messenger, found.auxiliary, *found.stitches]
    shapes = [shape for shape in every if shape is not None]
    places = [0.5 * (shape.position[1:] + shape.position[:-1]) for shape in shapes]
    rhoA = [shape.wire.mass * (1.0 + shape.wire.tension / shape.wire.EA) for shape in shapes]
    loads = [g * mass * np.diff(shape.arc) for mass, shape in zip(rhoA, shapes, strict=True)]
    ties = [(made.droppers, found.dropper_length, found.lower, found.upper)]
    if made.auxiliary is not None:
        low = found.auxiliary.position[found.auxiliary.nodes.stitch]
        high = found.messenger.position[found.messenger.nodes.dropper]
        ties.append((made.auxiliary.droppers, found.long_droppers.length, low, high))
    for given, length, low, high in ties:
        places += [low, high]
        loads += [
            g * (0.5 * given.mass * length + clamp) for clamp in (given.clamp_contact, given.clamp_messenger)
        ]
    for name, shape in (("contact", found.contact), ("messenger", found.messenger)):
        places.append(shape.position[shape.nodes.load])
        loads.append(np.array([g * load.mass for load in made.loads_on(name)]))
    return np.concatenate(places), np.concatenate(loads)


@pytest.mark.parametrize(("kind", "state", "anchors"), [case for case in CASES if case[1] != "windy"])
def test_what_hangs_is_carried(kind, state, anchors):
    """Weights are the forces of arms, supports and ends, and their moments about the first mast.

    In wind the air carries what it weighs, a ten-thousandth of the wires, and more.
    """
    found = catenary.form(line(kind, state, anchors), COARSE)
    places, loads = weights(found)
    overhead = catenary.assemble(found)
    rest = ancf.equilibrium(overhead.model)
    up, moment = -loads.sum(), -(places[:, 0] * loads).sum()
    for shape, force in ((found.contact, found.arm_load[:, 2]), (found.messenger, found.support_load)):
        up += force.sum()
        moment += (shape.position[shape.nodes.support, 0] * force).sum()
    for row, wire in enumerate(overhead.wires):
        for k, point in enumerate(() if wire is None else (wire.start, wire.end)):
            [support] = [
                one for one in overhead.model.supports if one.point is point or same(one.point, point)
            ]
            x, _, z = rest.position(point)
            up += rest.reaction(support)[2]
            moment += x * rest.reaction(support)[2] - z * (-1.0, 1.0)[k] * found.pull[row, k]
    assert abs(up) < 1e-6 * loads.sum()
    assert abs(moment) < 1e-6 * loads.sum() * found.line.length


def same(one, other):
    return one.body is other.body and np.allclose(one.initial_position, other.initial_position)
