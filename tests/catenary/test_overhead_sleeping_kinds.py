"""Spans that are reduced beside the whole line, of all kinds of lines: their parts come in any order.

Which part is next to which follows from the numbers of the unknowns, which clamps, auxiliaries and second
wires shuffle.
"""

from dataclasses import replace

import numpy as np
import pytest

from ancf import catenary
from ancf.catenary import Conditions, Droppers, sleeping
from ancf.catenary.lines.auxiliary import Auxiliary
from ancf.catenary.lines.span import DropperRule
from ancf.catenary.lines.stitch import StitchWire
from ancf.catenary.rest import assemble, form
from ancf.solvers.sleeping.parts import Matrices, cables_of, parts_of
from ancf.system.system import System
from overhead_lines import COARSE, STEP, collector, short_line

CLAMPS = Droppers(EA=2e5, mass=0.1, damping=5.0, clamp_contact=0.2, clamp_messenger=0.2)
THIRD = Auxiliary(
    wire=catenary.Wire(EA=6e6, EI=40.0, mass=0.6, tension=10e3),
    height=0.4,
    droppers=Droppers(EA=2e5, mass=0.1),
    places=DropperRule(first=6.0, pitch_max=10.0),
)
STITCH = StitchWire(reach=7.0, wire=catenary.Wire(EA=3e6, EI=10.0, mass=0.3, tension=2.5e3))
KINDS = {
    "clamps": {"droppers": CLAMPS},
    "auxiliary": {"auxiliary": THIRD},
    "twin wires": {"contact_spacing": 0.04},
    "stitch wires": {"stitch": STITCH, "droppers": CLAMPS},
    "weights": {"anchors": "tension", "droppers": CLAMPS, "messenger_support": 4e5},
}


def run(line, reduce, **more):
    given = {"pantograph": collector(), "mesh": COARSE, "step": STEP, "start": 12.0}
    given |= {"window": (100.0, 150.0), "until": 154.0} | more
    return catenary.run(line, speed=60.0, reduce=reduce, **given)


@pytest.mark.parametrize("kind", KINDS)
def test_the_whole_line_moves_alike(kind):
    line = short_line(**KINDS[kind])
    whole, less = run(line, False), run(line, True)
    assert less.settings["spans that are reduced while no pantograph is near"] == len(line.spans)
    force, other = whole.recordings[0].force, less.recordings[0].force
    assert np.sqrt(np.mean((other - force) ** 2)) < 0.03 * np.std(force)
    assert np.abs(less.uplift - whole.uplift).max() < 0.02 * np.abs(whole.uplift).max()
    left = np.sqrt(np.mean(np.square(less.dropper_force - whole.dropper_force), axis=0))
    swing = np.std(whole.dropper_force, axis=0)
    assert np.median(left) < 0.12 * np.median(swing)  # one may ring above the modes that are taken


@pytest.mark.parametrize("wind", [6.0, -14.0])
def test_in_wind_none_is_reduced(wind):
    """Wind acts on all wires: every span moves as it is, and the run is that of the whole line."""
    plain = short_line()
    wires = {k: replace(getattr(plain, k), diameter=0.012) for k in ("contact_wire", "messenger_wire")}
    line = short_line(conditions=Conditions(wind=wind), **wires)
    whole, less = run(line, False), run(line, True)
    assert less.settings["spans that are reduced while no pantograph is near"] == 0
    np.testing.assert_allclose(less.recordings[0].force, whole.recordings[0].force, rtol=0, atol=0.02)


def strut(overhead, point):
    ends = point, overhead.messenger_at(80.0)
    overhead.model.add_spring(*ends, stiffness=200.0, length=1.5, name="strut")


def brake(overhead, point):
    ends = point, overhead.messenger_at(80.0)
    overhead.model.add_spring(*ends, stiffness=200.0, length=1.1, friction=2.0, name="brake")


def node_near(overhead, track):
    """Point at the node of the contact wire that is nearest to a place of the track."""
    point = overhead.contact_at(track)
    return point.body.at(float(min(point.body.node_x, key=lambda x: abs(x - point.x))))


#: What is added at a place of the third span, and whether this then moves as it is.
ADDED = {
    "a constant force": (False, lambda o, at: o.model.add_force(at, (0, 0, 5.0))),
    "a strut": (False, strut),
    "a force of time": (True, lambda o, at: o.model.add_force(at, (0, 0, "5*sin(9*t)"))),
    "an input": (True, lambda o, at: o.model.add_force(at, (0, 0, o.model.add_input("push", 4.0)))),
    "a moved place": (True, lambda o, at: o.model.hold(at, position="y", displacement=(0, "1e-3*t", 0))),
    "friction": (True, brake),
}


@pytest.mark.parametrize("added", ADDED)
def test_what_a_span_has_of_its_own(added):
    """Modes know of constant loads and of springs; what changes with time keeps a span as it is."""
    awake, add = ADDED[added]
    given = {"modify": lambda overhead: add(overhead, node_near(overhead, 80.0))}
    whole, less = (run(short_line(), reduce, **given) for reduce in (False, True))
    assert less.settings[sleeping.REDUCED] == 5 - awake
    force, other = whole.recordings[0].force, less.recordings[0].force
    assert np.sqrt(np.mean((other - force) ** 2)) < 0.03 * np.std(force)
    assert np.abs(less.uplift - whole.uplift).max() < 0.02 * np.abs(whole.uplift).max()


@pytest.mark.parametrize("kind", ["clamps", "twin wires"])
def test_matrices_of_parts_know_no_order(kind):
    overhead = assemble(form(short_line(**KINDS[kind]), COARSE))
    catenary.add_pantograph(overhead, collector(), speed=50.0, start=10.0, label="pantograph")
    system = System(overhead.model)
    system.skip_energies()
    rest, cables = system.initial_shape(), cables_of(system)
    parts = parts_of(system, cables, sleeping.cuts(overhead, system))
    assert len(parts) == 5
    alone = [Matrices(system, cables, [part], rest).of_part(0, part) for part in parts]
    random = np.random.default_rng(4)
    for _ in range(6):
        order = random.permutation(len(parts)).tolist()
        made = Matrices(system, cables, [parts[k] for k in order], rest)
        for place, k in enumerate(order):
            blocks, force = made.of_part(place, parts[k])
            for one, other in zip(blocks, alone[k][0], strict=True):
                np.testing.assert_allclose(one.edge, other.edge, rtol=0, atol=1e-9 * np.abs(other.edge).max())
            np.testing.assert_allclose(force, alone[k][1], rtol=0, atol=1e-6)
