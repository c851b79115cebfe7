"""Equilibria of an umbilical of welded sections with buoyancy modules: on any mesh, at any depth."""

from functools import cache

import numpy as np
import pytest

import ancf
from helpers import some

WATER, G = 1025.0, 9.81
#: Name, length m, elements of the coarsest mesh, diameter m, kg/m, N m^2.
PARTS = (
    ("lower", 60.0, 16, 0.16, 38.0, 12e3),
    ("buoyancy", 50.0, 14, 0.60, 215.0, 12e3),
    ("upper", 123.0, 40, 0.16, 38.0, 12e3),
    ("end", 3.0, 4, 0.22, 56.0, 120e3),
)
LENGTH = sum(part[1] for part in PARTS)
#: Submerged weight, N: what Archimedes leaves of it, here less than nothing.
WEIGHT = sum(
    G * length * (rhoA - WATER * np.pi * diameter**2 / 4) for _, length, _, diameter, rhoA, _ in PARTS
)


@cache
def hung(times, depth, offset):
    """The line between two clamps that hold it upright, drawn along their chord."""
    model, ends = ancf.Model(gravity=(0, 0, -G)), np.array([[0, 0, 0.2 - depth], [offset, 0, -11.0]])
    chord, done, last = ends[1] - ends[0], 0.0, None
    turn = np.arctan2(chord[2], chord[0]) - np.pi / 2
    for name, length, elements, diameter, rhoA, EI in PARTS:
        section = ancf.Section(EA=1.5e8, EI=EI, rhoA=rhoA, diameter=diameter, drag=(1.2, 0.01))
        start, end = (ends[0] + chord * x / LENGTH for x in (done, done + length))
        part = model.add_beam(
            name, start=start, end=end, length=length, elements=times * elements, section=section
        )
        if last is None:
            model.clamp(part.start, rotation=turn, axis=(0, 1, 0), name="base")
        else:
            model.weld(last, part.start)
        last, done = part.end, done + length
    model.clamp(last, name="hangoff", rotation=turn, axis=(0, 1, 0))
    model.add_fluid("sea", density=WATER, below=0.0)
    model.add_ground("seabed", height=-depth, stiffness=1e5, damping=1e4)
    return ancf.equilibrium(model)


@pytest.mark.parametrize("times", some([2, 4, 6, 9]))
@pytest.mark.parametrize(("depth", "offset"), [(150.0, 110.0), (130.0, 90.0), (140.0, 110.0), (160.0, 110.0)])
def test_on_any_mesh(times, depth, offset):
    """The clamps carry the submerged weight, and tensions go to a limit with the second power at least."""
    state = hung(times, depth, offset)
    up = state.reaction("base") + state.reaction("hangoff")
    lowest = min(state.position(f"{name}.at({length / 2})")[2] for name, length, *_ in PARTS)
    assert lowest > -depth
    assert up == pytest.approx([0, 0, WEIGHT], abs=1e-5 * abs(WEIGHT))
    coarse, middle, here = (float(hung(n, depth, offset).tension("end.end")) for n in (1, 2, times))
    if times > 2:
        assert 0.0 < here - middle < (middle - coarse) / 3.0


@pytest.mark.parametrize("times", [1, 3])
def test_by_another_way(times):
    """The same equilibrium as by many steps of the load."""
    state = hung(times, 150.0, 110.0)
    again = ancf.equilibrium(state.model, load_steps=20)
    places = [f"{name}.at({x * length})" for name, length, *_ in PARTS for x in (0.2, 0.5, 0.8)]
    for place in places:
        assert again.position(place) == pytest.approx(state.position(place), abs=1e-6)
