"""Notes on axial forces that waver within elements: said where forces at nodes are wrong, else not."""

import numpy as np
import pytest

import ancf
from ancf.results.wavering import _across as across
from ancf.results.wavering import strain_slope

DOWN = (0.0, 0.0, -9.81)


def said(known):
    return [note for note in known.notes if "waver within" in note]


def bent(elements, EA, EI, load):
    """A clamped cable of 2 m whose end is pushed down."""
    model = ancf.Model()
    section = ancf.Section(EA=EA, EI=EI, rhoA=1.0)
    beam = model.add_beam("rod", start=(0, 0, 0), end=(2, 0, 0), elements=elements, section=section)
    model.clamp(beam.start)
    model.add_force(beam.end, (0.0, 0.0, -load))
    return beam, ancf.equilibrium(model, load_steps=5)


@pytest.mark.parametrize("elements", [8, 16, 32, 64, 128])
@pytest.mark.parametrize(
    ("EA", "EI", "load"), [(1e4, 1.0, 0.5), (1e6, 1.0, 0.5), (1e6, 1.0, 2.0), (1e7, 0.1, 0.1)]
)
def test_is_said_where_forces_at_nodes_are_wrong(elements, EA, EI, load):
    """The tension is the load times the sine of the slope, from statics."""
    beam, state = bent(elements, EA, EI, load)
    nodes = [beam.at(float(x)) for x in beam.node_x]
    r_x = np.array([state.slope(node) for node in nodes])
    exact = -load * r_x[:, 2] / np.linalg.norm(r_x, axis=1)
    error = np.max(np.abs([state.tension(node) for node in nodes] - exact)) / np.max(np.abs(exact))
    if error > 0.3:
        assert said(state), error
    if error < 0.03:
        assert not said(state), error


@pytest.mark.parametrize("strain", ["paper", "material"])
@pytest.mark.parametrize(("first", "last"), [(1.0, 1.2), (0.9, 0.8), (1.3, 1.3)])
@pytest.mark.parametrize("along", [(1.0, 0.0, 0.0), (0.0, -0.6, 0.8)])
def test_half_of_what_a_strain_gains_over_an_element(strain, first, last, along):
    """Of a tangent whose length goes from one to the other on a straight line."""
    middle = 0.5 * (first + last)
    vectors = [tuple(np.full((1, 1), x * c) for x in (middle, first, last)) for c in along]
    wanted = 0.5 * (last - first) * (middle if strain == "paper" else 1.0)
    assert strain_slope(vectors, strain)[0, 0] == pytest.approx(wanted, abs=1e-14)


@pytest.mark.parametrize("elements", [2, 5, 16])
@pytest.mark.parametrize(("EI", "load"), [(1.0, 1e-4), (200.0, 0.02)])
def test_a_cantilever_carries_its_load_across(elements, EI, load):
    beam, state = bent(elements, 1e5, EI, load)
    assert across(state, beam, state.q[None]) == pytest.approx(np.full((1, elements), load), rel=1e-4)


def rope(load=None, **section):
    model = ancf.Model(gravity=DOWN)
    section = ancf.Section(**{"EA": 1e6, "EI": 0.0, "rhoA": 1.0} | section)
    line = model.add_beam("rope", start=(0, 0, 0), end=(10, 0, 0), length=10.2, elements=20, section=section)
    model.pin(line.start)
    model.pin(line.end)
    if load is not None:
        model.add_force(line.at(5.1), load)
    return model, line


@pytest.mark.parametrize("EI", [0.0, 0.1, 10.0])
@pytest.mark.parametrize("EA", [1e4, 1e6])
def test_hanging_cables_are_right(EA, EI):
    assert not said(ancf.equilibrium(rope(EA=EA, EI=EI)[0]))


def test_stiff_cables_at_their_ends():
    """Softer ones say what the force is; near the ends, where it bends, a stiffer one does not have it."""
    (soft, at), (stiff, _) = rope(EI=10.0), rope(EA=1e8, EI=10.0)
    soft, stiff = ancf.equilibrium(soft), ancf.equilibrium(stiff)
    assert stiff.tension(at.at(0.51)) > 1.5 * soft.tension(at.at(0.51))
    assert said(stiff)


def test_a_kink_under_a_load():
    """One slope of a node is no kink: the force there is a sixth off, on any mesh; two cables are right."""
    load = 1000.0
    model, line = rope((0.0, 0.0, -load))
    state = ancf.equilibrium(model)
    [note] = said(state)
    assert "rope.at(" in note
    assert abs(state.tension(line.at(5.1)) / 2399.0 - 1.0) > 0.1
    two = ancf.Model(gravity=DOWN)
    section = ancf.Section(EA=1e6, EI=0.0, rhoA=1.0)
    parts = [
        two.add_beam(name, start=start, end=end, length=5.1, elements=2, section=section)
        for name, start, end in (("left", (0, 0, 0), (5, 0, -1)), ("right", (5, 0, -1), (10, 0, 0)))
    ]
    two.pin(parts[0].start)
    two.pin(parts[1].end)
    two.connect(parts[0].end, parts[1].start)
    two.add_force(parts[0].end, (0.0, 0.0, -load))
    assert not said(ancf.equilibrium(two))


@pytest.mark.parametrize("count", [2, 3, 9])
def test_forces_that_jump_at_nodes_are_no_wavering(count):
    model = ancf.Model()
    bar = model.add_beam(
        "bar", start=(0, 0, 0), end=(1, 0, 0), elements=count, section=ancf.Section(EA=1e5, EI=1.0, rhoA=1.0)
    )
    model.clamp(bar.start)
    for k, x in enumerate(bar.node_x[1:]):
        model.add_force(bar.at(float(x)), (100.0 if k % 2 else 1e-3, 0.0, 0.0))
    assert not said(ancf.equilibrium(model))


@pytest.mark.parametrize("natural", ["path", "straight"])
def test_natural_shapes(natural):
    """A spiral that is so by nature is free of force; one that was bent has the wavering of its elements."""
    angle = np.linspace(0.0, 4.0, 41)
    path = np.column_stack(
        [np.exp(0.3 * angle) * np.cos(angle), np.exp(0.3 * angle) * np.sin(angle), 0 * angle]
    )
    model = ancf.Model()
    section = ancf.Section(EA=1e6, EI=1.0, rhoA=1.0)
    model.add_beam("spiral", path=path.tolist(), natural_shape=natural, elements=8, section=section)
    state = ancf.simulate(model, t_end=1e-9, step=1e-9).state()
    assert bool(said(state)) == (natural == "straight")


def test_of_histories():
    """In motion from a larger share on: the falling cantilever of the README, not a swinging rope."""
    section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0)
    model = ancf.Model(gravity=DOWN)
    beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section)
    model.clamp(beam.start)
    [note] = said(ancf.simulate(model, t_end=0.4, step=1e-3))
    assert '"beam"' in note
    state = ancf.equilibrium(rope()[0])
    moved, _ = rope(load=("0", "50*sin(3*t)", "0"), EI=0.1)
    assert not said(ancf.simulate(moved, t_end=0.2, step=1e-3, start=state))
