"""Drums that are wider than the rope: turns side by side, wound in by an eye or beside the turn before."""

import math

import numpy as np
import pytest

import ancf

G, MASS, RATE, R, D = 9.81, 20.0, 4.0, 0.1, 0.02
STIFFNESS, WOUND = 5e6, 1.5 * math.pi


def drum_and_rope(pitch, turns, elements, way_down, travels):
    """A rope wound by three quarters of a turn of a helix about y, with a load; a drum that winds it in.

    `way_down`: from where the rope leaves the drum to the eye, m, or 0 without one.  A drum that travels
    goes by the pitch in each turn.
    """
    model, axis, rise = ancf.Model(gravity=(0, 0, -G)), R + 0.5 * D, pitch / (2 * math.pi)
    slant, down = math.hypot(axis, rise), way_down * math.hypot(1.0, rise / axis)
    length = (2 * math.pi * turns + WOUND) * slant + down + 0.6
    a = np.linspace(WOUND, 0.0, 120)
    on = np.stack([axis * np.cos(a), -rise * a, axis * np.sin(a)], axis=1)
    eye = np.array([axis, way_down * rise / axis, -way_down])
    hangs = np.array([0.0, 0.0, WOUND * slant + down - length])
    rope = model.add_beam(
        "rope",
        path=np.array([*on, eye if way_down else [axis, 0.0, -0.3], eye + hangs]),
        elements=elements,
        section=ancf.Section(EA=2e5, EI=2e-2, rhoA=0.3, diameter=D, bending_damping=1e-3, axial_damping=20.0),
        natural_shape="straight",
    )
    drum = model.add_rigid_body("drum", at=(0, 0, 0), mass=10.0, inertia=(0.1, 0.1, 0.1))
    barrel = model.add_surface("barrel", ancf.Cylinder(R, axis=(0, 1, 0)), on=drum)
    angle = f"{RATE}*(0.5*min(t,0.4)**2/0.4+max(t-0.4,0))"
    model.clamp(
        drum,
        axis=(0, -1, 0),
        rotation=angle,
        rotation_rate=f"{RATE}*min(t,0.4)/0.4",
        rotation_acceleration=f"{RATE}/0.4*step(0.4-t)",
        displacement=("0", f"-{rise if travels else 0.0}*({angle})", "0"),
    )
    model.add_contact(rope, barrel, stiffness=STIFFNESS, damping=500.0, friction=0.1)
    model.connect(rope.start, drum.at(*rope.initial_position(0.0)))
    load = model.add_point_mass("load", at=rope.initial_position(rope.length), mass=MASS)
    model.connect(load, rope.end)
    if way_down:
        model.slide(tuple(rope.initial_position(WOUND * slant + down)), along=rope)
    return model, rope, slant


def wind(model, turns, step=1e-3):
    method = ancf.GeneralizedAlpha(rho_inf=0.6)
    t_end = 2 * math.pi * turns / RATE + 0.2
    run = ancf.simulate(model, t_end=t_end, step=step, output_step=0.02, integrator=method)
    late = run.t > 0.2 + math.pi / RATE
    risen = np.polyfit(RATE * (run.t[late] - 0.2), run.position("load")[late, 2], 1)[0]
    assert abs(run.energy.drift).max() < 3e-4 * np.ptp(run.energy.supplied)
    return run, risen


@pytest.mark.parametrize(
    ("pitch", "turns", "elements", "step"),
    [
        (0.06, 1.7, 50, 2e-3),
        *(pytest.param(pitch, 2, 56, 1e-3, marks=pytest.mark.slow) for pitch in (0.06, 0.15)),
    ],
)
def test_winds_a_helix_through_an_eye(pitch, turns, elements, step):
    """Each turn hauls in sqrt((2 pi r)^2 + p^2), r less by the depth; the eye bends the rope a little."""
    model, rope, slant = drum_and_rope(pitch, turns, elements=elements, way_down=0.25, travels=True)
    run, risen = wind(model, turns, step)
    depth = MASS * G / (R + 0.5 * D) / STIFFNESS
    length = math.hypot(R + 0.5 * D - depth, pitch / (2 * math.pi))
    assert risen == pytest.approx(length, rel=3e-3 if pitch > 0.1 else 1e-3)
    at = (WOUND + math.pi) * slant  # what was wound last but a turn, and what a turn later
    y = [run.position(rope.at(x))[-1, 1] for x in (at, at + 2 * math.pi * slant)]
    assert y[1] - y[0] == pytest.approx(pitch, rel=0.03)


@pytest.mark.slow
@pytest.mark.parametrize("elements", [64, 80, 96])
def test_turns_lie_side_by_side(elements):
    """Without a guide: each turn is laid down beside the one before, which the rope touches, and the load
    follows by a diameter in each turn."""
    turns = 3
    model, rope, slant = drum_and_rope(1.05 * D, turns, elements=elements, way_down=0.0, travels=False)
    model.add_contact(rope, rope, stiffness=STIFFNESS, damping=500.0, friction=0.1)
    run, risen = wind(model, turns)
    depth = MASS * G / (R + 0.5 * D) / STIFFNESS
    assert risen == pytest.approx(math.hypot(R + 0.5 * D - depth, D / (2 * math.pi)), rel=1e-3)
    x = np.linspace(0.5, 2 * math.pi * (turns - 0.2) * slant + WOUND * slant - 0.2, 60)
    on = np.array([run.position(rope.at(s))[-1] for s in x])
    assert np.abs(np.hypot(on[:, 0], on[:, 2]) - (R + 0.5 * D)).max() < 0.05 * D  # one layer
    later = np.array([run.position(rope.at(s + 2 * math.pi * slant))[-1] for s in x[x < 1.2]])
    assert (later[:, 1] - on[: len(later), 1]).min() > 0.97 * D
