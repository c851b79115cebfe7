"""Gradients through friction that remembers the way: the adjoint against forward sensitivities."""

import numpy as np
import pytest
from backwards import apart, followed
from jointed import methods
from test_friction_memory import DAMPED, HILLS, TRAPEZOIDAL, dragged, fallen, hung, laid, thrown

import ancf
from ancf.model.vary import varied
from ancf.sensitivity import blocks
from ancf.sensitivity.adjoint_joints import JoinedAdjoint, adjoint_of
from ancf.sensitivity.adjoint_sloped import SlopedAdjoint
from ancf.system.system import System
from helpers import some

TIP = "integral(norm(velocity(line.end))**2)"
TEXTS = [TIP, "last(position(line.at(0.6))[0])", "smoothmax(tension(line.at(0.3)), 0.1)"]
NAMES = ["line.EA", "line.EI", "line.rhoA", "line.length", "line.diameter", "gravity[0]", "gravity[2]"]
GROUND = ["on.friction", "on.stiffness", "on.damping", "on.stick"]
ON = ["on.friction", "on.stiffness", "on.damping"]
STRONG = ancf.GeneralizedAlpha(rho_inf=0.0, newton=ancf.Newton(tolerance=1e-14, modified=False))


@pytest.fixture(autouse=True)
def backwards_alone(monkeypatch):
    """No gradient of these tests may go forwards, but where one asks for it."""
    monkeypatch.setattr("ancf.design.gradient._forward", None)


def settings(step, method=DAMPED, steps=37):
    return {"t_end": steps * step, "step": step, "integrator": method}


def check(model, names, bar=1e-9, texts=TEXTS, **given):
    """Gradients of formulas agree with forward sensitivities of one run."""
    theirs = followed(model, names, **given)
    for text in texts:
        _, slope = ancf.gradient(model, text, names, **given)
        assert apart(model, slope, theirs(text)) < bar, text


@pytest.mark.parametrize(
    "method", [TRAPEZOIDAL, DAMPED, STRONG], ids=["trapezoidal", "generalized", "strong"]
)
@pytest.mark.parametrize(
    ("given", "step"),
    [
        ({"elements": 2, "friction": 0.05}, 1e-3),
        ({"elements": 5, "friction": 0.3}, 5e-4),
        ({"elements": 3, "friction": 2.0}, 5e-4),
        ({"elements": 3, "friction": 0.3, "height": HILLS}, 5e-4),
        ({"elements": 4, "friction": 0.3, "height": 1e-4}, 1e-3),
    ],
    ids=["slips", "some", "sticks", "hills", "touches"],
)
def test_grounds(given, step, method):
    model = dragged(aside=4.0, **given)
    assert adjoint_of(System(model)) is SlopedAdjoint
    check(model, NAMES + GROUND, **settings(step, method))


@pytest.mark.parametrize(
    "model",
    [laid(bent=False), laid(), laid(friction=0.8, bent=False, length=17.0, elements=8)],
    ids=["lowered", "path", "long"],
)
def test_from_equilibria(model):
    """Whose memories have derivatives; a second run goes on from the first."""
    names, given = ["line.EA", "line.rhoA", "on.friction", "on.stiffness", "gravity[2]"], {"step": 2e-3}
    start = ancf.equilibrium(model, sensitivities=names)
    texts = ["last(position(line.at(5))[0])", "smoothmax(tension(line.at(7)), 0.1)"]
    check(model, names, 1e-9, texts, start=start, t_end=0.03, integrator=DAMPED, **given)
    first = ancf.simulate(model, start=start, t_end=0.03, sensitivities=names, integrator=DAMPED, **given)
    check(model, names, 1e-9, texts, start=first.state(), t_end=0.05, integrator=DAMPED, **given)


def test_from_a_shape_that_changes():
    """Anchors of what touches at the start are where it lies there."""
    model = thrown()
    check(model, ["line.end[0]", "line.end[1]", "line.EA", *GROUND], **settings(1e-3))


def test_from_a_start_that_is_fixed():
    model, names = laid(), ["line.EA", "on.friction"]
    start = ancf.equilibrium(model).fixed(names)
    check(model, names, start=start, texts=["last(position(line.at(5))[0])"], **settings(2e-3))


@pytest.mark.parametrize("method", [TRAPEZOIDAL, DAMPED], ids=["trapezoidal", "generalized"])
@pytest.mark.parametrize("friction", some([0.02, 0.1, 0.3, 2.0]))
@pytest.mark.parametrize("step", [1e-3, 2e-3])
def test_surfaces(friction, step, method):
    """A cable that falls on a drum and slips there, sticks and leaves."""
    model = fallen(friction)
    assert adjoint_of(System(model)) is SlopedAdjoint
    check(model, [*NAMES[:4], "gravity[0]", "gravity[2]", *ON], **settings(step, method))


@pytest.mark.parametrize("friction", [0.05, 0.3])
@pytest.mark.parametrize("elements", [6, 8])
def test_drums_from_equilibria(friction, elements):
    """A second run goes on from the first; derivatives of tensions are differences along those of states."""
    model, names = hung(friction, elements), ["line.EA", "line.rhoA", "gravity[2]", *ON]
    given, texts = {"step": 2e-3, "integrator": DAMPED}, ["last(position(line.end)[2])", TEXTS[2]]
    start = ancf.equilibrium(model, sensitivities=names)
    check(model, names, 1e-8, texts, start=start, t_end=0.05, **given)
    first = ancf.simulate(model, start=start, t_end=0.05, sensitivities=names, **given)
    check(model, names, 1e-8, texts, start=first.state(), t_end=0.1, **given)


@pytest.mark.parametrize("friction", [0.05, 0.3])
def test_ground_and_drum(friction):
    model = dragged(aside=4.0, elements=3, friction=friction, drum=True)
    check(model, [*NAMES, *GROUND, "over.friction", "over.stiffness"], **settings(5e-4))


@pytest.mark.parametrize("method", ["trapezoidal index1", "trapezoidal ggl", "generalized index2"])
@pytest.mark.parametrize("friction", [0.1, 0.5])
def test_drums_that_turn(friction, method):
    model = fallen(friction, turns=True)
    assert adjoint_of(System(model)) is JoinedAdjoint
    names = ["line.EA", "line.rhoA", "gravity[0]", "gravity[2]", "block.mass", *ON]
    check(model, names, 1e-7, TEXTS[:2], **settings(1e-3, methods()[method], 60))


def towed(elements=3, friction=0.3):
    """A cable that drags a block on the ground, which hinges on its end."""
    model = dragged(aside=4.0, elements=elements, friction=friction)
    line = model.bodies["line"]
    block = model.add_rigid_body("block", at=(1.1, 0, 0.05), mass=0.2, inertia=(1e-3, 2e-3, 2e-3))
    model.connect(block.at(-0.1, 0, -0.05), line.end)
    other = model.add_point_mass("other", at=(1.2, 0, 0.4), mass=0.1)
    model.add_spring(block.at(0.1, 0, 0), other, stiffness=50.0, damping=0.1, length=0.3, name="stay")
    return model


@pytest.mark.parametrize("method", ["trapezoidal index1", "trapezoidal ggl", "generalized index2"])
@pytest.mark.parametrize("elements", [2, 4])
def test_beside_joints(elements, method):
    model = towed(elements)
    assert adjoint_of(System(model)) is JoinedAdjoint
    names = ["line.EA", "line.rhoA", "gravity[2]", "block.mass", "stay.stiffness", *GROUND]
    check(model, names, 1e-7, TEXTS[:2], **settings(5e-4, methods()[method]))


@pytest.mark.parametrize("seed", [1, 2])
def test_orders_of_names(seed):
    model, given = dragged(aside=4.0, elements=3), settings(5e-4)
    names = NAMES + GROUND
    _, here = ancf.gradient(model, TIP, names, **given)
    order = np.random.default_rng(seed).permutation(names).tolist()
    _, there = ancf.gradient(model, TIP, order, **given)
    assert list(there) == order
    assert apart(model, there, here) < 1e-13
    (few,) = ancf.gradient(model, TIP, [order[0]], **given)[1].values()
    assert few == pytest.approx(here[order[0]], rel=1e-10)


@pytest.mark.parametrize("steps", [37, 130])
@pytest.mark.parametrize("elements", [2, 5])
def test_blocks_that_are_taken_again(steps, elements, monkeypatch):
    """From snapshots, where memories come back as well."""
    model, given = dragged(aside=4.0, elements=elements), settings(5e-4, steps=steps)
    _, at_once = ancf.gradient(model, TIP, NAMES + GROUND, **given)
    monkeypatch.setattr(blocks, "BLOCK", 1.0)
    _, kept = ancf.gradient(model, TIP, NAMES + GROUND, **given)
    monkeypatch.setattr(blocks, "KEPT", 0.0)
    monkeypatch.setattr(blocks, "LARGEST", 1.0)
    _, again = ancf.gradient(model, TIP, NAMES + GROUND, **given)
    assert again == kept
    assert apart(model, at_once, kept) < 1e-9


@pytest.mark.parametrize("name", ["on.friction", "on.stick", "line.rhoA"])
def test_taylor_remainders(name):
    """Of order two where events stay."""
    model, given = dragged(aside=4.0), settings(1e-3, steps=30)
    value, slope = ancf.gradient(model, TIP, [name], **given)
    p = ancf.model.vary.value_of(model, name)
    changes = 2e-3 * p * 0.5 ** np.arange(3)
    left = [
        abs(ancf.gradient(varied(model, name, p + h), TIP, [], **given)[0] - value - h * slope[name])
        for h in changes
    ]
    orders = np.log2(np.array(left[:-1]) / left[1:])
    assert np.all(np.abs(orders - 2.0) < 0.1), orders
