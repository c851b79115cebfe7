"""Models that move, shared by several tests, and rates of convergence from runs with successive steps."""

import numpy as np

import ancf
from helpers import matrix, rate, square

G = 9.81
LENGTH, EA, EI, RHO_A = 1.3, 2e4, 0.5, 0.4


def straight(elements, strain=None, gravity=(0, 0, 0), element="cable", **section):
    model = ancf.Model(gravity=gravity)
    given = {"EA": EA, "EI": EI, "rhoA": RHO_A} | section
    beam = model.add_beam(
        "beam",
        start=(0, 0, 0),
        end=(LENGTH, 0, 0),
        elements=elements,
        section=square(element, **given),
        element=element,
        strain=strain,
    )
    return model, beam


#: Soft and coarse: the fastest of its waves, about 200 rad/s, is resolved by all steps; the waves across
#: the section of a beam are three times as fast.
SLOW = {"EA": 30.0, "EI": 0.02}


def falling_cantilever(stretch):
    """A damped cantilever that falls."""
    model, beam = straight(3, "paper", (0, 0, -4.0), **SLOW, damping=0.3)
    model.clamp(beam.start, stretch=stretch)
    return model, beam


def driven_clamp(stretch):
    """A cantilever whose clamp turns and moves."""
    model, beam = straight(3, "material", **SLOW)
    turn = {"rotation": "0.5*(1 - cos(8*t))", "axis": (0, 1, 0.2)}
    model.clamp(beam.start, stretch=stretch, displacement=["0", "0.1*sin(7*t)**3", "0"], **turn)
    return model, beam


def step_rates(build, integrator, steps=(1e-3, 5e-4, 2.5e-4, 1.25e-4), t_end=0.24):
    """Rates from the differences of runs with successive steps: tip position and velocity."""
    ends = []
    for step in steps:
        model, beam = build()
        result = ancf.simulate(model, t_end=t_end, step=step, integrator=integrator, output_step=t_end)
        state = result.state()
        ends.append(np.append(state.position(beam.end), 0.02 * state.velocity(beam.end)))
    gaps = np.linalg.norm(np.diff(ends, axis=0), axis=1)
    assert gaps[-1] > 1e-9  # above what Newton leaves
    return rate(gaps)


def pendulum(elements=4, element="cable", **section):
    """A cable or beam on a pin that swings and bends."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    given = {"EA": 2e3, "EI": 0.1, "rhoA": 0.4, "damping": 0.1} | section
    section = square(element, **given)
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section, element=element
    )
    model.pin(beam.start)
    beam.set_motion(angular_velocity=(0, 0, 2.0))
    return model, beam


def ball(height=0.0, force=None, gravity=G, mass=2.0, how=None, **more):
    """A mass under a level wire, which it may only push upwards; in the plane of x and z."""
    model = ancf.Model(gravity=(0, 0, -gravity))
    wire = model.add_rigid_body("wire", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
    model.clamp(wire)
    pan = model.add_point_mass("pan", at=(1.0, 0, -height), mass=mass)
    if force is not None:
        model.add_force(pan, force)
    joint = model.slide(
        pan, along=wire, line=((0, 0, 0), (4, 0, 0)), unilateral=(0, 0, 1), name="contact", **more
    )
    return model, pan, joint


def rod_on_a_hinge(inertia=(0.01, 1 / 12, 1 / 12), axis=(0, 1, 0), turn=None, mass=1.0, half=0.5):
    """A rod along x hinged at its end; seen in turned axes."""
    turn = np.eye(3) if turn is None else turn
    model = ancf.Model(gravity=turn @ (0, 0, -G))
    at = turn @ (half, 0, 0)
    rod = model.add_rigid_body("body", at=at, mass=mass, inertia=inertia, axes=turn)
    model.add_moment(rod, (0, 0, 0))
    joint = model.hinge(rod.at(-half, 0, 0), (0, 0, 0), axis=turn @ axis, name="hinge")
    return model, rod, joint


def momentum(result, k):
    """Momentum and angular momentum about the origin at the stored time k, by the mass matrix."""
    system, q, v = result._system, result.q[k], result.v[k]
    M = matrix(system, q, mass=1.0)
    p = (M @ v[: system.n]).reshape(-1, 3)
    at = np.unique(np.concatenate([s[:, 0] for s in system.numbering.slots.values()])) // 3
    x = q[: system.n].reshape(-1, 3)
    return p[at].sum(axis=0), np.cross(x, p).sum(axis=0)
