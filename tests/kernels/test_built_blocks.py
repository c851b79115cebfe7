"""Tangents of cables written node by node into the matrix, against the same written slot by slot."""

import numpy as np
import pytest

import ancf
from ancf.system.core import assemble
from ancf.system.system import System

RNG = np.random.default_rng(11)
#: Elements of the cables, of which chunks of eight may be mixed, and whether a stay ties the ends together.
SHAPES = [((1,), False), ((8,), False), ((21,), False), ((40,), False), ((3, 17), False), ((24,), True)]


def model_of(counts, tied, damping):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=300.0, EI=0.2, rhoA=0.3, damping=0.1, bending_damping=damping)
    for k, count in enumerate(counts):
        ends = {"start": (0, k, 0), "end": (2.0, k, 0.3)}
        beam = model.add_beam(f"cable {k}", **ends, elements=count, section=section)
        model.clamp(beam.start, stretch="free")
        if tied:
            model.add_spring(beam.start, beam.at(1.1), stiffness=3.0)
            model.add_spring(beam.at(0.4), beam.end, stiffness=3.0)
    return model


def assembled(system, q):
    core = system.core
    A = np.empty_like(core.A)
    assemble(core.batches, core.ws, q, 0.1 * q, A, 2.0, 3.0, 1.0)
    return A


@pytest.mark.parametrize("damping", [0.0, 0.01])
@pytest.mark.parametrize(("counts", "tied"), SHAPES)
def test_whole_blocks_and_pieces_are_one_matrix(counts, tied, damping):
    system = System(model_of(counts, tied, damping))
    q = system.initial_shape()
    q += 0.05 * RNG.standard_normal(q.shape)
    whole, cable = assembled(system, q), system.parts["cable"]
    cable.order[:] = 0
    pieces = assembled(system, q)
    assert whole == pytest.approx(pieces, abs=1e-13 * np.abs(pieces).max())


def test_both_orders_and_mixed_chunks_occur():
    """Else the test above would say less: long chains are numbered from both ends."""
    orders = [System(model_of(*shape, 0.0)).parts["cable"].order for shape in SHAPES]
    assert set(np.concatenate(orders).tolist()) == {0, 1, 2}
