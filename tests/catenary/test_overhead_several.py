"""Wires that act as one, `count` in a file, in ice and under other tensions: as each by itself."""

import tomllib

import numpy as np
import pytest

from ancf.catenary import Conditions, Line, Mesh, Rayleigh, Span, SteadyArm, Wire, form, galloping
from ancf.catenary.lines.file import parse_track
from helpers import some
from overhead_lines import COARSE, TOML

G = 9.81
#: Supports of a file with a wire that bends little.
ARM = SteadyArm(vertical=1e8)


def both(**conditions):
    """Lines in some conditions whose two contact wires are one, and are each computed 40 mm apart."""
    tables = tomllib.loads(TOML)
    tables |= {"anchors": "tension", "stagger": 0.0, "conditions": conditions}
    tables["contact_wire"] |= {"EA": 7.5e6, "mass": 0.675, "tension": 10e3, "diameter": 0.012, "count": 2}
    tables["messenger_wire"]["diameter"] = 0.012
    spaced = tables | {"contact_wire": tables["contact_wire"] | {"spacing": 0.04}}
    tables["droppers"] = {"stiffness": 200e3}
    tables["steady_arm"] = {"vertical": 600.0}
    return [parse_track(one) for one in (tables, spaced)]


@pytest.mark.parametrize(
    "conditions",
    some(
        [
            {"ice": 0.5},
            {"contact_tension": 8e3},
            {"ice": 0.3, "contact_tension": 12e3, "temperature": -5.0},
            {"wear": 0.2, "messenger_tension": 14e3},
        ]
    ),
)
def test_states_are_those_of_two_wires(conditions):
    """Heights, and what droppers and ends carry together."""
    one, two = (form(line, COARSE) for line in both(**conditions))
    assert one.pull[0] == pytest.approx(two.pull[0] + two.pull[3], rel=1e-9)
    assert one.dropper_force == pytest.approx(two.dropper_force.reshape(-1, 2).sum(axis=1), rel=5e-3, abs=0.3)
    assert one.contact_height == pytest.approx(two.contact_height[::2], abs=5e-4)
    assert one.wave_speed == pytest.approx(two.wave_speed, rel=1e-6)
    assert one.wave_speed == pytest.approx(one.line.wave_speed, rel=1e-3)


@pytest.mark.parametrize("count", [1, 2, 4])
@pytest.mark.parametrize("ice", [0.0, 0.4])
def test_sag_in_ice(count, ice):
    """So many wires side by side sag as one of them does: (m + ice) g l^2/8T."""
    wire = Wire(EA=12e6, EI=1.0, mass=0.95, tension=10e3)
    line = Line(
        spans=[Span(length=40.0, droppers=())] * 3,
        contact_wire=wire.times(count),
        steady_arm=ARM,
        anchors="tension",
        conditions=Conditions(ice=ice, temperature=20.0),
    )
    found = form(line, Mesh(contact_support=0.05))
    x, _, z = found.contact.position.T
    assert -np.interp(60.0, x, z) == pytest.approx((0.95 + ice) * G * 40.0**2 / 8.0 / 10e3, rel=5e-3)
    assert line.contact_wire.count == count
    assert wire.times(2).times(count).count == 2 * count


@pytest.mark.parametrize("count", [2, 3])
def test_galloping(count):
    """Side by side they gallop as one does: all that counts is per mass."""
    wire = Wire(
        EA=12e6,
        EI=1.0,
        mass=0.95,
        tension=10e3,
        diameter=0.012,
        lift=((-0.3, 0.8), (0.3, -0.8)),
        damping=0.02,
    )
    found = []
    for one in (wire, wire.times(count)):
        line = Line(
            spans=[Span(length=40.0, droppers=())] * 3,
            contact_wire=one,
            steady_arm=ARM,
            anchors="tension",
            damping=Rayleigh(alpha=0.01),
            conditions=Conditions(ice=0.5, wind=15.0),
        )
        found.append(galloping(line)[0])
    for key in ("frequency", "growth", "critical_speed"):
        assert getattr(found[1], key) == pytest.approx(getattr(found[0], key), rel=1e-12)
