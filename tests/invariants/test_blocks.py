"""How many steps make a block follows the clock: nothing that is computed or said may depend on it.

A run on a slow machine has blocks of one step, on a fast one blocks that only its length bounds.
"""

import numpy as np
import pytest

import ancf
from ancf.solvers import stepping
from ancf.solvers.radau import run as radau_run
from motions import ball, pendulum, rod_on_a_hinge, straight

#: What BLOCK_SECONDS is on the machine: 0 makes each step a block, 1e9 none but what the looks bound.
MACHINES = {"slow": 0.0, "loaded": 2e-3, "fast": 1e9}


def rope(**section):
    model, beam = pendulum(**section)
    model.add_force(beam.end, ["0.5*sin(40*t)", "0", "0"])
    return model


def pan():
    """A contact that opens and closes: events end blocks too."""
    model, body, _ = ball(force=(0, 0, "2*9.81 + 30*sin(20*t)"))
    body.set_motion(velocity=(1.0, 0, 0))
    return model


def waved(**motion):
    """A rope whose end is led by functions: their rates are differences, other ones near start and end."""
    model, beam = pendulum()
    beam.set_motion()
    model.clamp(beam.end, **motion)
    return model


#: Complete runs, by name: model, settings.
COMPLETE = {
    "cable": (rope, {"t_end": 0.3003, "step": 1e-3}),
    "generalised-alpha": (rope, {"t_end": 0.2, "step": 1e-3, "integrator": ancf.GeneralizedAlpha(0.7)}),
    "explicit": (
        lambda: rope(EA=100.0),
        {"t_end": 0.1003, "step": 2e-4, "integrator": ancf.Explicit(check=False)},
    ),
    "hinge": (lambda: rod_on_a_hinge()[0], {"t_end": 0.2, "step": 7e-4}),
    "contact": (pan, {"t_end": 0.5, "step": 1e-3}),
    "led": (
        lambda: waved(displacement=lambda t: (0.0, 0.1 * np.sin(9 * t), 0.0)),
        {"t_end": 0.1003, "step": 1e-3},
    ),
    "turned": (
        lambda: waved(rotation=lambda t: 0.4 * np.sin(7 * t), axis=(0, 1, 0)),
        {"t_end": 0.1, "step": 1e-3},
    ),
    "turned, a dozen steps": (
        lambda: waved(rotation=lambda t: 0.4 * np.sin(7 * t), axis=(0, 1, 0)),
        {"t_end": 0.012, "step": 1e-3},
    ),
    "radau": (rope, {"t_end": 0.05, "step": 1e-3, "integrator": ancf.Radau(tolerance=1e-4)}),
}


def on(monkeypatch, machine):
    for where in (stepping, radau_run):
        monkeypatch.setattr(where, "BLOCK_SECONDS", MACHINES[machine])
    monkeypatch.setattr(stepping, "WORTH", 0.0)


def same_bits(one, two):
    for name in ("t", "q", "v"):
        assert np.array_equal(getattr(one, name)[:], getattr(two, name)[:]), name
    for name in ("dissipated", "supplied"):
        assert np.array_equal(getattr(one.energy, name), getattr(two.energy, name)), name
    counts = [{k: n for k, n in r.stats.as_dict().items() if k != "cpu_seconds"} for r in (one, two)]
    assert counts[0] == counts[1]


@pytest.mark.parametrize("name", COMPLETE)
def test_same_run(name, monkeypatch):
    build, given = COMPLETE[name]
    runs, blocks = [], []
    for machine in MACHINES:
        on(monkeypatch, machine)
        seen = []
        runs.append(ancf.simulate(build(), progress=seen.append, **given))
        blocks.append(len(seen))
    assert blocks[0] > blocks[-1]  # the blocks were different
    for run in runs[1:]:
        same_bits(runs[0], run)


@pytest.mark.parametrize(
    ("told", "worth"), [(0.0, 0.1), (0.01, 0.1), (0.02, 0.18), (0.05, 0.45), (0.06, 0.5), (9.0, 0.5)]
)
def test_to_tell_what_is_done_takes_a_tenth_of_the_time(told, worth):
    """To write a block to a file may take longer than its steps, but nobody waits long for the keyboard."""
    assert stepping._worth(told) == pytest.approx(worth)
    assert worth >= stepping.BLOCK_SECONDS


def failing(steps, step, EA):
    """A whip with a step that is far too large for its axial vibrations."""
    model, beam = pendulum(EA=EA, EI=1e-4, damping=0.0)
    beam.set_motion(angular_velocity=(0, 0, 40.0))
    return ancf.simulate(model, t_end=steps * step, step=step)


def verdict(run, *given):
    """(message, hint, times and states stored) of a run that fails, (None, None, ...) of another."""
    try:
        result, said = run(*given), (None, None)
    except ancf.SolveError as error:
        result, said = error.result, (str(error), error.hint)
    return said, result


@pytest.mark.parametrize("step", [5e-3, 1e-2, 2e-2, 5e-2])
@pytest.mark.parametrize("EA", [2e3, 2e5, 2e7])
def test_same_verdict(step, EA, monkeypatch):
    """Message with its numbers, time and step, and all that is stored, of runs that fail or nearly do."""
    found = []
    for machine in MACHINES:
        on(monkeypatch, machine)
        found.append(verdict(failing, 200, step, EA))
    for said, result in found[1:]:
        assert said == found[0][0]
        same_bits(result, found[0][1])


def test_some_of_them_make_energy(monkeypatch):
    """The verdict above depends on the energy, the only one that is looked at now and then."""
    on(monkeypatch, "slow")
    said = [verdict(failing, 200, h, EA)[0][0] for h in (5e-3, 1e-2, 2e-2, 5e-2) for EA in (2e3, 2e5, 2e7)]
    assert any(text is not None and "came from nowhere" in text for text in said), said


def test_explicit_estimates(monkeypatch):
    """The stable step is estimated anew after numbers of steps that the clock does not change."""
    monkeypatch.setattr("ancf.solvers.explicit.run.RARE_STEPS", 0)
    monkeypatch.setattr("ancf.solvers.explicit.run.RARE_WIDE", 0)
    model, beam = straight(4, "paper", EA=100.0, EI=1e-3, damping=1.0)
    model.pin(beam.start)
    model.add_force(beam.end, ["1000*ramp(t, 0, 0.2)", "0", "0"])
    step, told = ancf.stable_step(model), []
    for machine in MACHINES:
        on(monkeypatch, machine)
        with pytest.raises(ancf.SolveError, match="no longer stable") as caught:
            ancf.simulate(model, t_end=0.5, step=step, integrator=ancf.Explicit())
        told.append((str(caught.value), len(caught.value.result.t)))
    assert told[1:] == told[:-1]
