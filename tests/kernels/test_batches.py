"""Batches of all kinds under one type: the numbers of a tuple, and no kernel more for a new combination."""

import pickle
from typing import NamedTuple

import numpy as np
import pytest

import ancf
from ancf.batches import Batches, add_forces
from ancf.compiled import kernel
from ancf.elements.cable import CableBatch
from ancf.solvers.newmark import advance
from ancf.solvers.step.balance import balance
from ancf.system.core import assemble, find_inverted, inertia, residual
from ancf.system.system import System
from compiled_kernels import total_strain_energy
from helpers import SOFT, random_rate, shaken


def hung(*kinds):
    """A cable with a mass, a spring or a moment at its end, or with nothing."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(**SOFT, axial_damping=0.5)
    cable = model.add_beam("cable", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section)
    model.pin(cable.start)
    if "mass" in kinds:
        model.connect(cable.end, model.add_point_mass("mass", at=(1, 0, 0), mass=0.5))
    if "spring" in kinds:
        model.add_spring(cable.end, (1, 0, 1), stiffness=30.0)
    if "moment" in kinds:
        model.add_moment(cable.end, (0.0, 0.1, 0.2))
    return model


def everything(system, batches):
    """What the kernels give for these batches."""
    q, v, a = shaken(system), random_rate(system), random_rate(system, 5)
    zero, r, Ma, A = np.zeros_like(q), np.empty_like(q), np.empty_like(q), np.empty(system.places.size)
    ws = system.core.ws
    residual(batches, ws, q, v, a, zero, r)
    inertia(batches, ws, a, Ma)
    assemble(batches, ws, q, v, A, 1.0, 2.0, 3.0)
    return r, Ma, A, total_strain_energy(batches, ws, q), find_inverted(batches, ws, q)


def test_same_numbers_as_a_tuple():
    """Kernels of a tuple are compiled for its kinds: without the cable in seconds."""
    system = System(hung("mass", "spring", "moment"))
    small = tuple(batch for batch in system.core.batches if not isinstance(batch, CableBatch))
    assert len(small) > 2
    for wanted, found in zip(everything(system, small), everything(system, Batches(small)), strict=True):
        np.testing.assert_allclose(found, wanted, rtol=1e-13, atol=1e-13 * np.max(np.abs(wanted)))


def test_each_kind_counts():
    """The whole is the sum of its batches, one by one."""
    system = System(hung("mass", "spring", "moment"))
    whole = everything(system, system.core.batches)
    parts = [everything(system, Batches([batch])) for batch in system.core.batches]
    for k in range(4):
        np.testing.assert_allclose(sum(part[k] for part in parts), whole[k], rtol=1e-12, atol=1e-10)


def test_none():
    system = System(hung())
    *arrays, energy, slot = everything(system, Batches())
    assert not any(np.any(array) for array in arrays)
    assert (energy, slot) == (0.0, -1)


def test_new_combinations_compile_no_integrator():
    for kinds in ((), ("mass",), ("spring",), ("mass", "spring", "moment")):
        ancf.simulate(hung(*kinds), t_end=1e-3, step=5e-4)
        if not kinds:
            before = [set(k.signatures) for k in (advance, balance, residual, assemble)]
    assert [set(k.signatures) for k in (advance, balance, residual, assemble)] == before


class TestPython:
    """In Python they are a tuple."""

    def test_sequence(self):
        system = System(hung("mass", "spring"))
        batches = system.core.batches
        assert [*batches] == [batches[k] for k in range(len(batches))] == list(batches[:])
        assert all(any(mine is batch for mine in batches) for batch in batches)
        assert batches[0] in batches
        assert repr(batches).startswith("Batches(CableBatch, SpringBatch")

    def test_copied_to_another_process(self):
        """Addresses are made anew."""
        system = System(hung("mass", "spring"))
        again = pickle.loads(pickle.dumps(system.core.batches))
        assert again.table[0, 0] != system.core.batches.table[0, 0]
        for wanted, found in zip(
            everything(system, system.core.batches), everything(system, again), strict=True
        ):
            np.testing.assert_array_equal(found, wanted)

    def test_no_batch(self):
        class Stranger(NamedTuple):
            x: np.ndarray

        with pytest.raises(TypeError, match="no operations for Stranger"):
            Batches([Stranger(np.ones(3))])

    def test_vectors_with_gaps(self):
        """An operation is compiled for vectors in one piece: others are refused, not read wrongly."""

        @kernel
        def some(batches, q, ws):
            add_forces(batches, q, q, q, q, ws)

        system = System(hung())
        with pytest.raises(Exception, match="add_force takes"):
            some(system.core.batches, np.zeros(2 * system.size)[::2], system.core.ws)
