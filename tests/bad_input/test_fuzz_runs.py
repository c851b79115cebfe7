"""Generated runs: small models whose numbers are valid but odd, over a few steps.

Each ends complete, or with one clear error; no output is without a number, and energy that comes from nowhere
is said.  A normal run of the suite takes models of a cable alone, which share their compiled kernels.
"""

import signal
import sys
import time
import warnings
from contextlib import contextmanager

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import ancf
from ancf.errors import Interrupted
from fuzzing import SLOW, cases, finite, refused_or_fine

#: What hangs on the end of the cable.
PARTS = ("nothing", "mass", "body", "bar", "bead", "head") if SLOW else ("nothing",)
#: Energy that nobody supplied must have been said from this share of the largest part on.
UNSAID = 0.1
#: Processor time, s: after which a run that goes on is stopped as by Ctrl-C (a method that chooses its steps
#: may need millions), and after which it hangs.
PATIENCE, LONGEST = (5 if SLOW else 2), 300

FORCES = [(0, 0, 0), (0, 0, -1), ["0", "0", "step(t - 1e-3)"], ["sin(1e4*t)", "0", "1"], [0, 0, 1e6]]
FORCES += [["0", "1/(t - 0.01)", "0"], ["0", "0", "1e3*t"], ["sqrt(0.1 - t)", 0, 0], [1e-12, 0, 0]]
MOTIONS = [0, "sin(50*t)", "t**2", "step(t - 1e-3)", "1e3*t", "log(t + 1e-3)"]
GRAVITY = [(0, 0, 0), (0, 0, -9.81), (3, -2, 1), (0, 0, -1e3)]
LOSSES = [{}, {}, {"damping": 0.01}, {"axial_damping": 1.0}, {"bending_damping": 1e-3}]
INTEGRATORS = st.one_of(
    st.builds(ancf.Trapezoidal),
    st.builds(ancf.GeneralizedAlpha, rho_inf=st.sampled_from([0.0, 0.5, 0.9, 1.0])),
    st.builds(ancf.Radau, stages=st.sampled_from([2, 3]), adaptive=st.booleans()),
    st.builds(ancf.Explicit, check=st.booleans()),
)


def sizes(low, high):
    """Numbers from 10^low to 10^high."""
    return st.floats(low, high).map(lambda x: float(f"{10.0**x:.3g}"))


@st.composite
def models(draw):
    """A cable, perhaps with a spring, and something at its end."""
    model = ancf.Model(gravity=draw(st.sampled_from(GRAVITY)))
    size = draw(sizes(-2, 3))
    stiff = {"EA": draw(sizes(-2, 9)), "EI": draw(sizes(-7, 6)), "rhoA": draw(sizes(-4, 3))}
    section = ancf.Section(**stiff, **draw(st.sampled_from(LOSSES)))
    ends = {"start": (0, 0, 0), "end": (size, 0, draw(st.sampled_from([0.0, 0.3])) * size)}
    length = draw(st.sampled_from([1.0, 1.0, 0.9, 1.0001, 1.02, 1.5])) * np.linalg.norm(ends["end"])
    count = draw(st.integers(1, 3))
    cable = model.add_beam("cable", elements=count, section=section, length=float(length), **ends)
    _hold(model, cable, draw)
    model.add_force(cable.at(draw(st.sampled_from([0.3, 1.0])) * cable.length), draw(st.sampled_from(FORCES)))
    if draw(st.booleans()):
        end = draw(st.sampled_from([(0.0, 0.0, -size), (size, size, 0.0)]))
        spring = {"stiffness": draw(sizes(-3, 9)), "damping": draw(st.sampled_from([0.0, 1e-3, 10.0]))}
        rest = draw(st.sampled_from([None, 0.0, 0.5 * size, 10.0 * size]))
        model.add_spring(cable.end, end, length=rest, slack=draw(st.booleans()), **spring)
    if draw(st.booleans()):
        spin = draw(st.sampled_from([0.0, 5.0, 1e3]))
        cable.set_motion(
            velocity=(0, 0, draw(st.sampled_from([0.0, 1.0, 1e3]))), angular_velocity=(0, spin, 0)
        )
    _attach(model, cable, draw(st.sampled_from(PARTS)), draw)
    return model


def _hold(model, cable, draw):
    how = draw(st.sampled_from(["nothing", "pin", "clamp", "both", "both", "driven", "turned"]))
    if how in ("pin", "both", "driven"):
        moved = [0, 0, draw(st.sampled_from(MOTIONS))] if how == "driven" else None
        model.pin(cable.start, displacement=moved)
    if how in ("clamp", "turned"):
        model.clamp(cable.start, rotation=draw(st.sampled_from(MOTIONS[1:])) if how == "turned" else None)
    if how == "both":
        model.pin(cable.end)


def _attach(model, cable, part, draw):
    """Something at the end of the cable, or on it."""
    place, mass = cable.initial_position(cable.length), draw(sizes(-6, 4))
    if part == "body":
        inertia = mass * draw(sizes(-6, 2)) * np.array([1.0, 1.2, 2.0])
        body = model.add_rigid_body("body", at=place, mass=mass, inertia=inertia)
        model.clamp(cable.end, to=body)
    elif part == "bar":
        section = ancf.Section.rectangle(0.02, draw(sizes(-4, 0)), E=draw(sizes(4, 11)), rho=1e3, nu=0.3)
        given = {"elements": 1, "element": "nonlocking", "section": section}
        bar = model.add_beam("bar", start=place, end=place + np.array([0.0, 0.0, 1.0]), **given)
        model.connect(cable.end, bar.start)
    elif part == "bead":
        bead = model.add_point_mass("bead", at=cable.initial_position(0.4 * cable.length), mass=mass)
        model.slide(bead, along=cable, s=0.4 * cable.length, friction=draw(st.sampled_from([0.0, 0.3])))
    elif part != "nothing":
        end = model.add_point_mass("mass", at=place, mass=mass)
        if part == "mass":
            model.connect(cable.end, end)
        else:
            model.add_contact(
                end, cable, stiffness=draw(sizes(0, 7)), damping=draw(st.sampled_from([0.0, 1.0]))
            )


@st.composite
def tasks(draw):
    """What is asked of a model."""
    what = draw(st.sampled_from(["simulate"] * 5 + ["from equilibrium"] * 2 + ["equilibrium", "modes"]))
    step, steps = draw(sizes(-6, 0)), draw(st.integers(1, 20))
    options = {"step": step, "t_end": (steps - draw(st.sampled_from([0.0, 0.5]))) * step}
    every = draw(st.sampled_from([None, None, 2 * step]))
    return what, {**options, "output_step": every, "integrator": draw(INTEGRATORS)}


def look_at(result):
    """All that a run stored is made of numbers, and its energies add up or it is said that they do not."""
    finite(result.t, result.q, result.v)
    assert np.all(np.diff(result.t) > 0.0)
    sensors = result.sensors
    finite(sensors.t, sensors.position("cable.end"), sensors.tension("cable.end"))
    for place in ("cable.start", "cable.end"):
        for quantity in ("position", "velocity", "tension", "curvature", "strain", "bending_moment"):
            finite(getattr(result, quantity)(place))
    e = result.energy
    stored, work = e.kinetic + e.strain + e.potential, e.supplied - e.dissipated
    finite(stored, work)
    gained = stored - stored[0] - (work - work[0])
    largest = max(np.abs(part - part[0]).max() for part in (e.kinetic, e.strain, e.potential, work))
    largest = max(largest, e.kinetic[0], e.strain[0]) + 1e-12 * np.abs(e.potential).max() + 1e-14
    if gained.max() > UNSAID * largest:
        assert result.notes, f"{gained.max():g} J of {largest:g} J came from nowhere"
    text = str(result)
    assert "nan" not in text
    assert "inf" not in text


def run(model, what, options):
    """Do it; everything that comes back is looked at."""
    if what == "modes":
        finite(ancf.modes(model, count=2).frequencies)
        return
    start = None
    if what != "simulate":
        start = ancf.equilibrium(model)
        finite(start.q, start.position("cable.end"), start.tension("cable.end"), start.energy.strain)
        assert "nan" not in str(start)
    if what == "equilibrium":
        return
    try:
        result = ancf.simulate(model, start=start, sensors=["cable.end"], progress=patience(), **options)
    except Interrupted as stopped:
        result = stopped.result
        assert result.status == "interrupted"
    look_at(result)


def patience():
    """What a run calls between blocks of steps."""
    end = time.process_time() + PATIENCE

    def look(progress):
        if time.process_time() > end:
            raise KeyboardInterrupt

    return look


@contextmanager
def in_time():
    """The body does not hang."""

    def hangs(*arguments):
        raise TimeoutError(f"it takes more than {LONGEST} s")

    if sys.platform == "win32":
        yield
        return
    before = signal.signal(signal.SIGPROF, hangs)
    signal.setitimer(signal.ITIMER_PROF, LONGEST)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0)
        signal.signal(signal.SIGPROF, before)


@cases(0.06)
@given(model=models(), task=tasks())
def test_runs(model, task):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        with in_time(), refused_or_fine() as refusal:
            run(model, *task)
        if refusal and getattr(refusal[0], "result", None) is not None:
            left = refusal[0].result
            finite(left.t, left.q, left.v)
