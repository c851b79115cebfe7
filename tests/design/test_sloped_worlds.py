"""Derivatives of random worlds by random numbers, forwards and backwards, against differences of runs."""

import numpy as np
import pytest
from backwards import forward

import ancf
from ancf.model.vary import value_of, varied
from ancf.sensitivity.alike import changed, same_loads
from ancf.system.system import System
from helpers import some
from sloped_worlds import SlopedWorld
from slopes import extrapolated, once

INTEGRATOR = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14, modified=False), formulation="index2")
GIVEN = {"t_end": 0.016, "step": 1e-3, "integrator": INTEGRATOR}
#: Worlds whose runs need no cut steps.
SEEDS = [1, 2, 3, 5, 7, 8, 11, 14, 16, 20, 28, 30, 32, 39]
#: Changes of a number: larger ones have less round-off, smaller ones let nothing touch in another step.
WIDTHS = 1e-3, 1e-5, 1e-6


def motion(run):
    """Places and velocities at all times, without multipliers, which have the round-off of forces."""
    places = np.setdiff1d(np.arange(run.system.size), run.system.multipliers)
    return places, np.stack([run.q[:][:, places], run.v[:][:, places]])


@pytest.mark.filterwarnings("ignore:.*the support wins")
@pytest.mark.parametrize("seed", some(SEEDS))
def test_worlds(seed):
    """All that moves, and one number of it backwards."""
    world = SlopedWorld(seed)
    model, names = world.model, world.numbers(np.random.default_rng(seed), 4)
    run = once(lambda other: motion(ancf.simulate(other, **GIVEN))[1])
    result = ancf.simulate(model, sensitivities=names, **GIVEN)
    places, off, sizes = motion(result)[0], [], []
    for name in names:
        size, known = abs(value_of(model, name)) or 1.0, result.sensitivity(name)
        found = size * np.stack([known.dq[:, places], known.dv[:, places]])
        near = [size * extrapolated(run, model, name, width, 2) for width in WIDTHS]
        off.append(min(np.max(np.abs(found - wanted)) for wanted in near))
        sizes.append(np.max(np.abs(found)))
    share = 3e-6 if "line" in model.beams else 1e-7  # fluids and cables with winches are differenced
    assert max(off) < share * max(sizes), dict(zip(names, off, strict=True))
    beam = sorted(model.beams)[0]
    text = f"integral(norm(velocity({beam}.start))**2) + last(position({beam}.end)[2])"
    _, back = ancf.gradient(model, text, names, **GIVEN)
    ahead = forward(model, text, names, **GIVEN)
    each = [(abs(value_of(model, name)) or 1.0) * np.array([back[name], ahead[name]]) for name in names]
    assert max(abs(x - y) for x, y in each) <= 1e-9 * max(np.max(np.abs(x)) for x in each)


@pytest.mark.parametrize("seed", [*SEEDS, 4, 9, 19, 26])
def test_what_a_number_leaves(seed):
    """A number of one item leaves the loads, and what they act on, to the last bit."""
    model = SlopedWorld(seed).model
    name = f"{model.connections[0].name}.stiffness"
    mine, other = System(model), System(varied(model, name, 1.01 * value_of(model, name)))
    assert same_loads(mine, other)
    assert changed(mine, other) <= {"crossing", "pressing", "rubbing", "gripping", "bumping", "springs"}


@pytest.mark.filterwarnings("ignore:.*the support wins")
@pytest.mark.parametrize(
    ("seed", "name"), [(32, "b1.end[0]"), (20, "b0.start[1]"), (30, "b0.start[0]"), (16, "b1.start[2]")]
)
def test_how_it_begins(seed, name):
    """The initial shape is smooth whatever touches: tiny changes left 3e-8 of round-off."""
    model = SlopedWorld(seed).model
    given = GIVEN | {"t_end": 1e-3}
    found = ancf.simulate(model, sensitivities=[name], **given).sensitivity(name).dq[0]
    wanted = extrapolated(lambda other: System(other).initial_state(0.0)[0], model, name, 1e-2)
    free = System(model).free
    assert np.max(np.abs(found - wanted)[free]) < 1e-10 * np.max(np.abs(wanted))


def reeled(swing=0.1, **fluid):
    """A cable that a winch lets into a fluid."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    hull = {"diameter": 0.05, "drag": (1.0, 0.1), "added_mass": (1.0, 0.2)}
    section = ancf.Section(EA=400.0, EI=0.1, rhoA=0.5, **hull)
    line = model.add_beam("line", start=(2, 0, 1), end=(2.8, 0, 0.7), elements=2, section=section)
    model.pin(line.start)
    model.winch(line.start, length=f"{line.length!r} + {swing}*sin(3*t)**2", name="drum")
    model.add_fluid("sea", 200.0, **fluid)
    return model


@pytest.mark.parametrize("fluid", [{}, {"velocity": (0.5, 0.2, 0.0)}, {"below": 0.85}], ids=str)
@pytest.mark.parametrize("name", ["line.diameter", "sea.density", "line.added_mass[0]", "gravity[2]"])
def test_reeled_in_fluids(name, fluid):
    """By the length there is: by that at the start derivatives were up to 2e-2 off."""
    model = reeled(**fluid)
    places, _ = motion(ancf.simulate(model, **GIVEN))
    known = ancf.simulate(model, sensitivities=[name], **GIVEN).sensitivity(name)
    wanted = extrapolated(lambda other: motion(ancf.simulate(other, **GIVEN))[1], model, name, 1e-2, 3)
    found = np.stack([known.dq[:, places], known.dv[:, places]])
    noise = 3e-11 / abs(value_of(model, name))
    assert np.max(np.abs(found - wanted)) < 2e-7 * np.max(np.abs(wanted)) + noise


@pytest.mark.parametrize("away", [0.0, 1.0, 300.0])
def test_moved_far_away(away):
    """Rates of a support that moves have no round-off of where it stands: its derivatives had 1e-3 of it."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    section = ancf.Section(EA=400.0, EI=0.1, rhoA=0.5)
    line = model.add_beam("line", start=(away, 0, 1), end=(away + 0.8, 0, 1), elements=2, section=section)
    model.pin(line.start, displacement=("0.001*sin(40*t)", 0, 0))
    system = System(model)
    motion = system.inputs.tables(0.0, 1e-4, 20, 0.0, 1.0).motion
    t = 1e-4 * np.arange(1, 21)
    assert np.max(np.abs(motion[:, 0, 1] - 0.04 * np.cos(40.0 * t))) < 1e-9
    assert np.max(np.abs(motion[:, 0, 2] + 1.6 * np.sin(40.0 * t))) < 1e-6
