"""What elements offer beyond their numerics, which equilibria ask for."""

import ast
from pathlib import Path

import numpy as np
import pytest

import ancf
from ancf.elements.registry import ELEMENTS, offered, offers
from ancf.solvers.statics.mixed import Mixed
from ancf.solvers.statics.slack import Slack
from ancf.system.system import System
from helpers import SOLIDS, square

SOLVERS = Path(ancf.__file__).parent / "solvers"
#: Statuses of a step, in one file.
STATUSES = {"OK", "DIVERGED", "NOT_FINITE", "SINGULAR", "INVERTED", "EVENT"}


def hung(element, length):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = square(element, EA=1e4, EI=0.01, rhoA=0.3)
    wire = model.add_beam(
        "wire", start=(0, 0, 0), end=(1, 0, 0), length=length, elements=5, section=section, element=element
    )
    model.pin(wire.start)
    model.pin(wire.end)
    return System(model)


def test_who_offers_what():
    assert {name for name in ELEMENTS if offers(name, "slack")} == {"cable"}
    assert {name for name in ELEMENTS if offers(name, "quadratic_strains")} == set(SOLIDS)
    assert offered(object(), "slack") is None


@pytest.mark.parametrize("element", ELEMENTS)
def test_batches_are_known_by_their_type(element):
    system = hung(element, 1.0)
    found = [batch for batch in system.core.batches if type(batch) is ELEMENTS[element].BATCH]
    assert len(found) == 1
    for name in ("slack", "quadratic_strains"):
        assert (offered(found[0], name) is not None) == offers(element, name)


@pytest.mark.parametrize("share", [1.02, 1.3])
def test_a_slack_cable_is_left_as_it_was(share):
    """Stiffness and natural strains are lowered and come back to the last bit."""
    system = hung("cable", share)
    (batch,) = [b for b in system.core.batches if type(b) is ELEMENTS["cable"].BATCH]
    before = [part.copy() for part in (batch.lane_data, batch.lane_reference, batch.groups)]
    slack = Slack(system, system.initial_shape(), np.full(system.size, 0.1))
    assert slack.found
    assert slack.factor < 1e-2
    slack.set(1.0, 1.0)
    changed = [
        not np.array_equal(a, b)
        for a, b in zip(before, (batch.lane_data, batch.lane_reference, batch.groups), strict=True)
    ]
    assert changed == [True, True, True]
    # every element of the straight start is pressed to 1/share of its length
    assert batch.lane_reference.min() == pytest.approx(1 / share - 1, rel=1e-12)
    slack.set(0.0, 0.0)
    for old, new in zip(before, (batch.lane_data, batch.lane_reference, batch.groups), strict=True):
        assert np.array_equal(old, new)


@pytest.mark.parametrize(("element", "share"), [("cable", 1.0), ("cable", 0.9), *((e, 1.1) for e in SOLIDS)])
def test_nothing_hangs_slack(element, share):
    system = hung(element, share)
    assert not Slack(system, system.initial_shape(), np.full(system.size, 0.1)).found


@pytest.mark.parametrize("element", ELEMENTS)
def test_only_batches_with_quadratic_strains_are_copied(element):
    system = hung(element, 1.0)
    mixed = Mixed(system.core.batches)
    for old, new in zip(system.core.batches, mixed.batches, strict=True):
        assert (old is new) == (offered(old, "quadratic_strains") is None)
    before = [batch.lane_reference.copy() for batch in system.core.batches[:1]]
    mixed.correct(np.full(system.size, 1e-3))
    assert np.array_equal(before[0], system.core.batches[0].lane_reference)


def test_one_enumeration_of_statuses():
    """A status has one number, whichever method ends with it."""
    for path in SOLVERS.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Assign):
                names = {n.id for target in node.targets for n in ast.walk(target) if isinstance(n, ast.Name)}
                assert path.name == "status.py" or not names & STATUSES, path
