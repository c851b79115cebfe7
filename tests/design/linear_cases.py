"""Families of models that are linearised, and what is compared with runs of them."""

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError
from helpers import SOLIDS, rate, square

DAMPED = {"damping": 0.06, "axial_damping": 2.0, "bending_damping": 0.01}


def rope(model, start, end, element="cable", elements=4, **given):
    section = square(element, EA=2e3, EI=0.8, rhoA=0.4, **DAMPED)
    return model.add_beam(
        "rope", start=start, end=end, elements=elements, section=section, element=element, **given
    )


def body(model, at, name="load"):
    return model.add_rigid_body(name, at=at, mass=1.5, inertia=(0.02, 0.03, 0.04))


def hanging(u, element, **held):
    """A body below a rope that is clamped aslant, on a spring to the ground."""
    line = rope(u, (0, 0, 0), (0.5, 0.1, -1.2), element)
    u.clamp(line.start, name="hook", **held)
    load = body(u, (0.6, 0.1, -1.3))
    u.connect(line.end, load.at(-0.1, 0, 0.1), name="pin")
    u.add_spring(load.at(0, 0.1, 0), (0.6, 1.0, -1.0), stiffness=8.0, damping=0.3, name="spring")
    return load, [
        "tension(rope.at(0.5))",
        "spring_force(spring)",
        "spring_length(spring)",
        "position(load)[2]",
    ]


def clamped(u, element, **held):
    """A body at the end of a beam, all of its directions held by it."""
    line = rope(u, (0, 0, 0), (0.9, 0.1, 0.05), element)
    u.clamp(line.start, name="hook", **held)
    load = body(u, (1.0, 0.1, 0.0))
    given = {"stretch": "free"} if element == "cable" else {}
    u.clamp(line.end, to=load, name="grip", **given)
    if element == "cable":
        u.add_spring(load.at(0, 0.1, 0), (1.0, 0.9, 0.4), stiffness=20.0, damping=0.4)
        u.add_spring(load.at(0, -0.1, 0), (1.0, -0.9, 0.4), stiffness=20.0, damping=0.4)
    return load, [
        "multiplier(grip)[2]",
        "joint_moment(grip)[1]",
        "position(load)[2]",
        "curvature(rope.at(0.3))",
    ]


def hinged(u, element, **held):
    """A pendulum of two bodies on hinges, with a torsion spring, at the end of a rope."""
    arm = body(u, (0.3, 0, -0.1), "arm")
    load = body(u, (0.75, 0, -0.3))
    u.hinge(arm.at(-0.3, 0, 0.1), (0, 0, 0), axis=(0, 1, 0), name="shoulder")
    u.hinge(arm.at(0.25, 0, -0.1), load.at(-0.2, 0, 0.1), axis=(0, 1, 0), name="elbow")
    u.add_torsion_spring(arm, load, axis=(0, 1, 0), stiffness=6.0, damping=0.2, name="knee")
    line = rope(u, (0.75, 0.0, -0.3), (1.9, 0.2, 0.3), element, natural_shape="straight", length=1.4)
    u.connect(line.start, load.centre, name="eye")
    u.clamp(line.end, name="hook", **held)
    return load, ["torsion_angle(knee)", "torsion_moment(knee)", "multiplier(elbow)[0]", "position(load)[0]"]


def sliding(u, element, **held):
    """A bead on a sagging wire, held by a spring."""
    line = rope(u, (0, 0, 0), (1.8, 0.1, 0.2), element, elements=6, length=1.83)
    u.pin(line.start, name="hook", **held)
    u.hold(line.end, position="yz", name="end")
    u.add_spring(line.end, (2.2, 0.1, 0.25), stiffness=200.0, damping=0.5)
    bead = u.add_point_mass("load", at=line.at(0.7).initial_position, mass=0.4)
    u.slide(bead, along=line, s=0.7, name="eye")
    u.add_spring(bead, (0.5, 0.1, -1.0), stiffness=30.0, damping=0.2, name="spring")
    u.add_spring(line.at(1.2), (1.2, 0.6, 0.3), stiffness=30.0, damping=0.2)
    return bead, ["arc_length(eye)", "normal_force(eye)[2]", "spring_force(spring)", "position(load)[0]"]


def swimming(u, element, **held):
    """A float on a rope in a current that is an input too."""
    section = ancf.Section(EA=2e3, EI=0.8, rhoA=0.4, diameter=0.03, drag=(1.2, 0.2), added_mass=(1.0, 0.1))
    line = u.add_beam("rope", start=(0, 0, 0), end=(0.6, 0, 1.4), elements=5, section=section)
    u.pin(line.start, name="hook", **held)
    stream = u.add_input("stream", 0.9, unit="m/s")
    u.add_fluid("sea", density=1000.0, velocity=(stream, 0.1, 0.0))
    load = u.add_point_mass("load", at=(0.6, 0, 1.4), mass=0.5)
    u.connect(line.end, load)
    u.add_force(load, (0, 0, 30.0))
    return load, ["position(load)[0]", "tension(rope.end)", "norm(position(load))"]


def following(u, element, **held):
    """A column below a force that turns with its end."""
    line = rope(u, (0, 0, 0), (0.05, 0, 1.0), element, elements=5)
    u.clamp(line.start, name="hook", **held)
    u.add_follower_force(line.end, (-0.7, 0.0, 0.0) if element == "cable" else (-0.7, 0.2, 0.1))
    load = u.add_point_mass("load", at=(0.05, 0, 1.0), mass=0.05)
    u.connect(line.end, load)
    return load, ["position(load)[0]", "tension(rope.at(0.2))", "bending_moment(rope.at(0.3))"]


BUILDS = {
    "hanging": hanging,
    "clamped": clamped,
    "hinged": hinged,
    "sliding": sliding,
    "swimming": swimming,
    "following": following,
}


#: Each with the elements that it has.
CASES = [
    (name, e)
    for name in BUILDS
    for e in ("cable", *SOLIDS)
    if e == "cable" or name not in ("sliding", "swimming")
]


ids = [f"{name}-{element}" for name, element in CASES]


cases = pytest.mark.parametrize(("name", "element"), CASES, ids=ids)


def built(name, element, push=0.3, **held):
    """A model whose load an input pushes, and questions that suit it; ``held``: what moves its hook."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    u = model.add_input("push", push, unit="N")
    load, outputs = BUILDS[name](model, element, **held)
    model.add_force(load, (u, 0.4 * u, -0.3 * u))
    return model, outputs


def answers(state, outputs):
    """Outputs of a state, by the model's own linear state space about it: their values there."""
    return ancf.linearise(state.model, about=state, outputs=outputs).outputs_at


HELD = ["reaction(hook)[0]", "reaction(hook)[2]"]


#: Supports of which a moment is asked.
CLAMPED = ("hanging", "clamped", "hinged", "following")


class Asked:
    """Answers of a run for formulas."""

    def __init__(self, run):
        self.run = run

    def value(self, name):
        raise AssertionError(name)

    def ask(self, quantity, item):
        return getattr(self.run, quantity)(item)


def assert_of_second_order(left, least=1e-7):
    """Remainders (sizes, outputs) at halved sizes fall with the square, where round-off lets them be seen."""
    orders = np.array([rate(column)[-1] for column in left.T])
    seen = left[-1] > least
    assert seen.sum() >= 0.5 * len(seen), left[-1]
    assert np.all(np.abs(orders[seen] - 2.0) < 0.05), orders


def given_motion(times):
    """A smooth start from rest, its rate and second rate."""
    w = 7.0
    c, si = np.cos(w * times), np.sin(w * times)
    return np.array([(1 - c) ** 2, 2 * w * si * (1 - c), 2 * w**2 * (c - c**2 + si**2)]).T


def by_rule(linear, order, motion, step, gain=1.0):
    """Outputs (steps + 1, outputs) by the trapezoidal rule where s, s' and s'' (steps + 1, 3) are given.

    The rule is that of the unknowns: z = p + g s, where the modes follow a support that moves at rest.
    """
    count, first = len(linear.frequencies_hz), linear.states.index("rate of mode 1")
    rows, B = linear.A[first : first + count], linear.B[:, 0]
    read = linear.reading.of_q  # of a state vector
    m, g = -B[:count] / gain, -read[:count] @ np.linalg.pinv(read[count : count + 1])[:, 0]
    K, D = rows[:, :count], rows[:, first : first + count]

    def beside(s, ds, dds):
        u = (dds if order == 2 else ds) / gain
        more = rows[:, -1] * ds if order == 2 else 0.0
        own = rows[:, count] * s + D @ (m * ds) + more + B[first : first + count] * u - m * dds
        return own - K @ g * s - D @ g * ds + g * dds

    z, dz, found = np.zeros(count), np.zeros(count), []
    ddz = beside(*motion[0])
    inverse = np.linalg.inv(np.eye(count) - 0.25 * step**2 * K - 0.5 * step * D)
    for k, given in enumerate(motion):
        s, ds, dds = given
        if k:
            z, dz = z + step * dz + 0.25 * step**2 * ddz, dz + 0.5 * step * ddz
            ddz = inverse @ (K @ z + D @ dz + beside(*given))
            z, dz = z + 0.25 * step**2 * ddz, dz + 0.5 * step * ddz
        x = np.concatenate([z - g * s, [s], dz - g * ds + m * ds, [ds] if order == 2 else []])
        found.append(linear.C @ x + linear.D[:, 0] * (dds if order == 2 else ds) / gain)
    return np.array(found)


READ = [("hanging", "cable"), ("hinged", "nonlocking"), ("clamped", "original"), ("sliding", "cable")]


def driven(**given):
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=2e3, EI=0.05, rhoA=0.3)
    line = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -1.5), elements=3, section=section)
    model.pin(line.start, name="hook")
    pay = model.add_input("pay", given.pop("first", 0.0))
    model.add_input("idle", 0.0)
    given = {key: (pay if value is None else value) for key, value in given.items()}
    model.winch(line.start, acceleration=1.0, name="drum", **given)
    return model


def refused(model, match, error=ModelError, **given):
    about = given.pop("about", None) or ancf.equilibrium(model)
    with pytest.raises(error, match=match):
        ancf.linearise(model, about=about, **given)
