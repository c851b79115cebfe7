"""Random lines with spans that are reduced beside the same lines whole, and what is said if they differ."""

import math
import warnings
from dataclasses import replace

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.catenary import Mesh, Rayleigh, sleeping
from ancf.catenary.lines.stitch import StitchWire
from ancf.catenary.rest import assemble, form
from ancf.solvers.status import SLOW, STEPS
from ancf.system.far import ASLEEP, CALM, CALMED
from helpers import some
from overhead_lines import COARSE, STEP, collector, short_line

MESH = Mesh(contact=2.0, messenger=3.0)
HEAVY = catenary.Pantograph(
    masses=(22.0, 7.8), stiffness=(50.0, 8600.0), damping=(90.0, 20.0), static_force=105.0, name="heavy"
)


def stitched(seed):
    """Six spans with stitch wires, which go slack behind a pantograph, and the speed along them."""
    random = np.random.default_rng(seed)
    length, count = float(round(random.uniform(45, 62), 2)), int(random.integers(4, 7))
    tension = float(random.uniform(10e3, 22e3))
    places = tuple(round(length * (i + 0.5) / count, 3) for i in range(count))
    line = catenary.Line(
        spans=[catenary.Span(length=length, droppers=places)] * 6,
        contact_wire=catenary.Wire(EA=13e6, EI=130.0, mass=1.0, tension=tension),
        messenger_wire=catenary.Wire(EA=6e6, EI=50.0, mass=1.0, tension=0.95 * tension),
        droppers=catenary.Droppers(stiffness=1e5)
        if seed % 2
        else catenary.Droppers(EA=2e5, mass=0.1, damping=5.0),
        system_height=1.4,
        steady_arm=catenary.SteadyArm(vertical=1000.0),
        damping=Rayleigh(alpha=0.12, beta=1e-5),
        stagger=0.2,
        stitch=StitchWire(
            reach=round(0.2 * length, 2), wire=catenary.Wire(EA=3e6, EI=10.0, mass=0.3, tension=2.5e3)
        ),
    )
    return line, float(random.uniform(0.45, 0.72) * math.sqrt(tension))


def beside(line, speed, reduce, pantograph=HEAVY, **given):
    length = line.spans[0].length
    given = {"spacing": 40.0, "start": 12.0, "window": (2 * length, 4 * length), "until": 5 * length} | given
    return catenary.run(line, speed=speed, pantograph=pantograph, reduce=reduce, **given)


@pytest.mark.parametrize("seed", some([4, 1, 7, 2]))
def test_slack_stitch_wires_feed_nothing(seed):
    """Taken for modes, a slack wire was stretched each time it woke: 5 % of sigma, 7 mm of uplift."""
    line, speed = stitched(seed)
    step = 1e-3 if seed % 3 else 2e-3
    whole, less = (beside(line, speed, reduce, step=step, mesh=MESH) for reduce in (False, True))
    assert less.settings[sleeping.REDUCED] == len(line.spans)
    for one, other in zip(whole.recordings, less.recordings, strict=True):
        assert np.std(other.force) == pytest.approx(np.std(one.force), rel=5e-3)
    assert np.nanmax(np.abs(less.uplift - whole.uplift)) < 0.03 * np.nanmax(whole.uplift)
    left = next(value for key, value in less.settings.items() if key.startswith("force at supports"))
    assert 0.0 < left < 0.2


@pytest.mark.parametrize(
    ("damping", "said"),
    [
        (Rayleigh(), True),
        (Rayleigh(alpha=0.1, beta=1e-5), True),
        (Rayleigh(alpha=0.0125, beta=1e-4), False),
        (Rayleigh(alpha=0.2), False),
    ],
)
def test_hardly_damped_lines_are_said(damping, said):
    line = replace(short_line(), damping=damping)
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        for reduce in (False, True):
            catenary.run(line, speed=50.0, pantograph=collector(), mesh=COARSE, step=STEP, reduce=reduce)
    texts = [str(one.message) for one in found if "run.reduce" in str(one.message)]
    assert len(texts) == said
    assert not said or "hardly any" in texts[0]


@pytest.mark.parametrize("pushing", [100.0, 400.0])
def test_supports_that_are_lifted_are_said(pushing):
    """A wire without messenger on soft arms is lifted by decimetres, and its tension changes with that."""
    line = catenary.Line(
        spans=[catenary.Span(length=30.0, droppers=())] * 6,
        contact_wire=catenary.Wire(EA=13e6, EI=130.0, mass=1.07, tension=12e3),
        steady_arm=catenary.SteadyArm(vertical=2e3),
        damping=Rayleigh(alpha=0.05, beta=5e-4),
    )
    unit = replace(HEAVY, static_force=pushing)
    given = {"pantograph": unit, "mesh": Mesh(contact=1.0), "step": STEP, "spacing": None}
    with warnings.catch_warnings(record=True) as found:
        warnings.simplefilter("always")
        made = beside(line, 15.0, True, **given)
    lifted = float(np.nanmax(made.uplift))
    texts = [str(one.message) for one in found if "run.reduce" in str(one.message)]
    assert len(texts) == (lifted > 0.1)
    assert (lifted > 0.1) == (pushing > 200.0)
    assert not texts or f"{1e3 * lifted:.0f} mm" in texts[0]


@pytest.mark.parametrize("ahead", range(4))
def test_a_bridged_step_is_taken_once(ahead):
    """What may sleep after a part of a step that is bridged waits; the part was taken for one that failed."""
    overhead = assemble(form(short_line(), COARSE))
    rest = sleeping.Sleep(ancf.equilibrium(overhead.model))
    catenary.add_pantograph(overhead, collector(), speed=50.0, start=10.0, label="pantograph")
    integrator = ancf.GeneralizedAlpha(0.9, newton=ancf.Newton(tolerance=1e-8, corotate=False))
    live = ancf.stepper(overhead.model, step=STEP, integrator=integrator, energy=False)
    live.advance(4)
    run = live._run
    spans = run.reduce(rest.plan(run.system, overhead))
    live.advance(1 + ahead)
    spans.wake_all()
    spans.far.part[:, CALM] = int(spans.far.memo[CALMED])
    position, steps = run.memory.q.copy(), int(run.memory.counts[STEPS])
    t = live.t
    run.bridged(t, STEP, 6 + ahead, SLOW)
    assert int(run.memory.counts[STEPS]) == steps + 1
    moved = run.memory.q - position
    x = np.argmax(np.abs(moved))
    assert moved[x] == pytest.approx(50.0 * STEP, rel=1e-6)
    assert not spans.far.part[:, ASLEEP].any()
