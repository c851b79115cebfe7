"""Equilibria that there are none of are given up early, and those that take many halvings are found."""

import numpy as np
import pytest

import ancf
from ancf.solvers import static_iteration, static_path

CORRECTIONS = 300 * 5  # four halvings of the whole and the last that is left, 300 each


@pytest.fixture
def corrections(monkeypatch):
    """How many corrections a search takes, found or not."""
    taken = []
    own = static_iteration.Iteration.correction

    def counted(it, r):
        taken.append(it)
        return own(it, r)

    monkeypatch.setattr(static_iteration.Iteration, "correction", counted)
    return taken


def lying(elements, start, length, friction, pull=0.0, EI=0.0):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e8, EI=EI, rhoA=50.0, diameter=0.1)
    line = model.add_beam(
        "chain", start=start, end=(100, 0, 0), elements=elements, section=section, length=length
    )
    model.add_ground("bed", height=0.0, stiffness=1e6, damping=1e5, friction=friction)
    model.pin(line.start)
    if pull:
        model.add_force(line.end, (pull, 0, 0))
    return model


@pytest.mark.parametrize("elements", [8, 20])
@pytest.mark.parametrize(
    ("start", "length", "friction"),
    [((0, 0, 0), None, 0.0), ((0, 0, 0), 120.0, 0.6), ((0, 0, 5), None, 0.0), ((0, 0, 30), 130.0, 0.6)],
)
def test_chains_without_tension(elements, start, length, friction, corrections):
    """They took 3,900 corrections: thirteen parts of the load, each as far from a rest as the one before."""
    with pytest.raises(ancf.SolveError, match=r'at 0 of the load: .*"chain" finds no rest: '):
        ancf.equilibrium(lying(elements, start, length, friction))
    assert len(corrections) <= CORRECTIONS


@pytest.mark.parametrize("pull", [0.0, 200.0])
def test_what_is_probed_leaves_no_trace(pull, monkeypatch):
    """Steps that settle only after some halvings do so as if the last one had not been tried before."""
    settle, asked = static_path.settle, []

    def late(it, share):
        asked.append(share)
        return "too much for this test" if share > 2.0**-6 and not it.began else settle(it, share)

    monkeypatch.setattr(static_path, "settle", late)
    found = []
    for probed in (static_path.PROBED, 99):
        monkeypatch.setattr(static_path, "PROBED", probed)
        asked.clear()
        found.append(ancf.equilibrium(lying(8, (0, 0, 0), None, 0.3, pull, EI=1e3)))
        first = asked[: asked.index(2.0**-6)]
        assert first == [2.0**-k for k in range(4)] + [2.0**-12] * (probed < 99) + [2.0**-4, 2.0**-5]
    assert np.array_equal(found[0].q, found[1].q)
    assert [state.stats.retries for state in found] == [6, 6]


@pytest.mark.parametrize("elements", [8, 16])
def test_rings_whose_sections_turn(elements):
    """Bent from a straight rod, all its sections turn about its axis against nothing: a clamp holds them."""
    section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0, nu=0.3)
    for clamped in (False, True):
        model = ancf.Model(gravity=(0, 0, -9.81))
        ring = model.add_beam(
            "ring",
            path=lambda u: (0.5 * np.cos(2 * np.pi * u), 0.5 * np.sin(2 * np.pi * u), 0.0),
            closed=True,
            elements=elements,
            section=section,
            element="nonlocking",
            natural_shape="straight",
        )
        if clamped:
            model.clamp(ring.start)
            state = ancf.equilibrium(model)
            assert state.position(ring.at(0.5 * ring.length))[2] < 0.0
            continue
        model.pin(ring.start)
        with pytest.raises(ancf.SolveError, match=r'"ring" is closed, .* sections turn .*: clamp it'):
            ancf.equilibrium(model)
