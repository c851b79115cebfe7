"""A chain that lies on a ground without tension: nothing holds it sideways, and the message says so."""

import pytest

import ancf

CHAIN = ancf.Section(EA=1e8, EI=0.0, rhoA=50.0, diameter=0.1)


def lying(start, length, friction, section=CHAIN):
    model = ancf.Model(gravity=(0, 0, -9.81))
    line = model.add_beam("chain", start=start, end=(100, 0, 0), elements=20, section=section, length=length)
    model.add_ground("seabed", height=0.0, stiffness=1e6, damping=1e5, friction=friction)
    model.pin(line.start)
    return model, line


@pytest.mark.parametrize(
    ("start", "length", "friction"),
    [((0, 0, 0), None, 0.0), ((0, 0, 0), None, 0.6), ((0, 0, 5), None, 0.0), ((0, 0, 30), 130.0, 0.6)],
)
def test_it_is_named(start, length, friction):
    model, _ = lying(start, length, friction)
    with pytest.raises(
        ancf.SolveError, match=r'"chain" finds no rest: .* nothing holds it sideways; hold or pull'
    ):
        ancf.equilibrium(model)


@pytest.mark.parametrize("cure", ["pull", "hold", "EI"])
@pytest.mark.parametrize("friction", [0.0, 0.6])
def test_each_cure_helps(cure, friction):
    section = ancf.Section(EA=1e8, EI=1e3, rhoA=50.0, diameter=0.1) if cure == "EI" else CHAIN
    model, line = lying((0, 0, 0), None, friction, section)
    if cure == "pull":
        model.add_force(line.end, (100.0, 0, 0))
    if cure == "hold":
        model.pin(line.end)
    state = ancf.equilibrium(model)
    depth = 50.0 * 9.81 / (1e6 * 0.1)  # m: weight over stiffness, both per length
    assert state.position("chain.at(50)")[2] == pytest.approx(-depth, rel=1e-3)


def test_a_run_needs_no_rest():
    model, _ = lying((0, 0, 0), None, 0.6)
    result = ancf.simulate(model, t_end=0.2, step=5e-3, integrator=ancf.GeneralizedAlpha(0.0))
    assert abs(result.position("chain.end")[-1, 1]) < 1e-6
