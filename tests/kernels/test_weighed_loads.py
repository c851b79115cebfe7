"""Loads weighed with lambda: sparse sums against the whole load vectors."""

import numpy as np
import pytest

import ancf
from ancf.solvers.derivatives.pushes import weigh_loads
from ancf.system.core import apply_load
from ancf.system.system import System

SECTION = ancf.Section(EA=1e3, EI=2.0, rhoA=1.0, diameter=0.05)


def loaded(kind):
    """A cable with loads of some kinds that change with time."""
    model = ancf.Model(gravity=(0.3, 0.0, -9.81))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(2, 0, 0.3), elements=4, section=SECTION)
    if kind in ("forces", "all"):
        model.add_force(rope.end, ("sin(3*t)", "t", 2.0))
        model.add_distributed_load(rope, (0.0, "cos(t)", 0.4))
    if kind in ("hung", "all"):
        model.winch(rope.end, length="2.0 + 0.3*t")
    return System(model)


@pytest.mark.parametrize("kind", ["weight", "forces", "hung", "all"])
@pytest.mark.parametrize("steps", [1, 7])
def test_against_whole_vectors(kind, steps):
    system = loaded(kind)
    loads, value = system.core.loads, system.inputs.tables(0.2, 0.1, steps, 0.0, 1.0).value
    lam, whole = np.random.default_rng(2).uniform(-1, 1, (steps, system.size)), np.empty(system.size)
    wanted = 0.0
    for step in range(steps):
        apply_load(loads, value[step], whole)
        wanted += lam[step] @ whole
    assert bool(len(loads.hung_slot)) == (kind in ("hung", "all"))
    assert weigh_loads(loads, value, lam.sum(axis=0), lam) == pytest.approx(wanted, rel=1e-12)
