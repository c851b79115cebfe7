"""A crane that brakes the swing of its load: a trolley on a track, a rope, a load, a force on the trolley.

The controller knows the crane as a cart with a rigid pendulum, linear about the rest, and weighs place, swing
and force (a linear-quadratic regulator). It looks every 20 ms at trolley and load of the flexible model and
pushes the trolley with at most 150 N. A trolley that is merely brought to its place, and held there,
leaves the load swinging.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import solve_continuous_are

import ancf

G = 9.81
TROLLEY, LOAD, ROPE = 5.0, 10.0, 3.0  # kg, kg, m
TARGET, MOST = 2.0, 150.0  # m, N
STEP, CONTROL_STEP, T_END = 4e-3, 0.02, 12.0  # s


def build(elements=6, locked=False):
    """Trolley, rope and load, with the input "thrust" in N; a locked trolley stays where it is."""
    model = ancf.Model(gravity=(0, 0, -G), title="Crane")
    section = ancf.Section(EA=2e5, EI=0.05, rhoA=0.3, axial_damping=200.0)
    rope = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -ROPE), elements=elements, section=section)
    trolley = model.add_point_mass("trolley", at=(0, 0, 0), mass=TROLLEY)
    load = model.add_point_mass("load", at=(0, 0, -ROPE), mass=LOAD)
    model.connect(trolley, rope.start)
    model.connect(load, rope.end)
    model.hold(trolley, position="xyz" if locked else "yz")
    model.add_force(trolley, (model.add_input("thrust"), 0.0, 0.0))
    return model


def gains(place=100.0, swing=1000.0, effort=0.02):
    """Feedback of the trolley's place and speed, and of the load's distance aside and its rate, N/m, N s/m.

    Of the cart with a rigid pendulum: M x'' = u + m g d/l, d'' = -g d/l - x''.
    """
    A = np.zeros((4, 4))
    A[0, 1] = A[2, 3] = 1.0
    A[1, 2] = LOAD * G / (ROPE * TROLLEY)
    A[3, 2] = -G / ROPE * (1.0 + LOAD / TROLLEY)
    B = np.array([[0.0], [1.0 / TROLLEY], [0.0], [-1.0 / TROLLEY]])
    P = solve_continuous_are(A, B, np.diag([place, 1.0, swing, 1.0]), [[effort]])
    return (B.T @ P / effort)[0]


def controller(target=TARGET, brakes=True):
    """Function of a run that gives the thrust; without ``brakes`` it heeds the trolley alone."""
    K = gains() if brakes else np.array([2000.0, 500.0, 0.0, 0.0])

    def push(run):
        trolley, load = run.position("trolley")[0], run.position("load")[0]
        rates = run.velocity("trolley")[0], run.velocity("load")[0]
        seen = np.array([trolley - target, rates[0], load - trolley, rates[1] - rates[0]])
        run.inputs["thrust"] = float(np.clip(-K @ seen, -MOST, MOST))

    return push


def move(brakes=True, t_end=T_END):
    """Carry the load to the target."""
    model = build()
    return ancf.simulate(
        model,
        t_end=t_end,
        step=STEP,
        start=ancf.equilibrium(build(locked=True)),
        output_step=CONTROL_STEP,
        controller=controller(brakes=brakes),
        control_step=CONTROL_STEP,
    )


def swing(result, after):
    """Largest distance of the load from below the trolley after a time, m."""
    apart = result.position("load")[:, 0] - result.position("trolley")[:, 0]
    return float(np.abs(apart[result.t >= after]).max())


if __name__ == "__main__":
    for name, brakes in (("holds the trolley", False), ("brakes the swing", True)):
        result = move(brakes)
        place = result.position("load")[-1, 0]
        left = 1000 * swing(result, 8.0)
        print(f"{name}: load at {place:.3f} of {TARGET:g} m, swing after 8 s {left:.1f} mm")
