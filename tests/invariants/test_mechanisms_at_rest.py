"""Random mechanisms of rigid bodies come to a stable rest: chains on all kinds of joints, springs, ropes.

Bodies that may turn where nothing holds them, slides on springs, ropes below: wherever they are drawn, what
is found is balanced, and gives way nowhere.
"""

import numpy as np
import pytest

import ancf

G = 9.81


def unit(draw):
    x = draw.standard_normal(3)
    return x / np.linalg.norm(x)


def join(model, draw, point, last, kind):
    if kind == "ball":
        model.connect(point, last)
    elif kind == "universal":
        a = unit(draw)
        b = np.cross(a, unit(draw))
        model.universal(point, last, tuple(a), tuple(b / np.linalg.norm(b)))
    else:
        way = {"hinge": model.hinge, "slide": model.cylindrical}[kind]
        way(point, last, axis=tuple(unit(draw)))


def mechanism(seed):
    """A chain of one to four bodies, of sizes and masses over two decades; perhaps with a rope at its end."""
    draw = np.random.default_rng(seed)
    model, last, place = ancf.Model(gravity=(0.0, 0.0, -G)), (0.0, 0.0, 0.0), np.zeros(3)
    size = 10.0 ** draw.uniform(-1.0, 1.0)
    for k in range(draw.integers(1, 5)):
        d, mass = size * unit(draw) * draw.uniform(0.3, 1.0), 10.0 ** draw.uniform(-1.0, 1.0)
        inertia = tuple(mass * size**2 * draw.uniform(0.01, 0.02, 3))
        body = model.add_rigid_body(f"body{k}", at=tuple(place + d), mass=mass, inertia=inertia)
        kind = draw.choice(["ball", "hinge", "universal", "slide", "ball", "hinge"])
        join(model, draw, body.at(*-d), last, kind)
        soft = mass * G / size
        if kind == "slide" or draw.random() < 0.4:
            end, length = place + d + size * unit(draw), size * draw.uniform(0.3, 1.2)
            model.add_spring(body.centre, tuple(end), stiffness=soft * draw.uniform(0.5, 5.0), length=length)
        last, place = body.at(*d), place + 2.0 * d
    if draw.random() < 0.3:
        section = ancf.Section(EA=1e4 * size, EI=1e-3 * size**3, rhoA=0.3)
        given = {"start": tuple(place), "end": tuple(place + size * unit(draw)), "elements": 5}
        rope = model.add_beam("rope", section=section, **given)
        model.connect(last, rope.start)
        if draw.random() < 0.5:
            model.pin(rope.end)
    return model


@pytest.mark.parametrize("seed", range(24))
def test_they_come_to_a_stable_rest(seed):
    model = mechanism(seed)
    state = ancf.equilibrium(model)
    lowest = ancf.modes(model, about=state, count=1)  # refuses a state that gives way
    assert lowest.notes == [] or not any("out of balance" in note for note in lowest.notes)
    run = ancf.simulate(model, start=state, t_end=0.01, step=1e-3)
    energy = sum(body.mass * G * 0.01 for body in model.bodies.values() if hasattr(body, "mass"))
    assert np.max(run.energy.kinetic) < 1e-12 * energy
