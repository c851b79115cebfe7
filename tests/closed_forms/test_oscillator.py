"""One mass on a spring: each integrator, its energies and its supports against its own formulas in numpy.

The motion stays on the line of the spring, where all forces are linear: a step is a linear map, and each
method must give its recurrence to round-off, not only to its order.
"""

import numpy as np
import pytest

import ancf
from ancf.solvers.formulations import FORMULATIONS

MASS, STIFFNESS, DAMPING = 0.7, 300.0, 1.3
STEP, STEPS = 0.011, 30  # omega h = 0.23


def force(t):
    return 5.0 * np.sin(9.0 * t) + 2.0


def model(*, damping=DAMPING, moved=False):
    """A mass above the end of its spring, pushed by a force; or the end of the spring moves instead."""
    made = ancf.Model()
    mass = made.add_point_mass("mass", at=(0, 0, 1.02), mass=MASS)
    mass.set_motion(velocity=(0, 0, 0.4))
    end = (0.0, 0.0, 0.0)
    if moved:
        carriage = made.add_point_mass("carriage", at=end, mass=0.1)
        made.pin(carriage, displacement=lambda t: (0.0, 0.0, 0.03 * t**2), name="carriage on its way")
        made.add_spring(mass, carriage, stiffness=STIFFNESS, damping=damping, length=1.0, name="spring")
    else:
        made.add_spring(mass, end, stiffness=STIFFNESS, damping=damping, length=1.0, name="spring")
        made.add_force(mass, lambda t: (0.0, 0.0, force(t)))
    return made


def run(integrator, steps=STEPS, **given):
    made = model(**given)
    result = ancf.simulate(made, t_end=steps * STEP, step=STEP, integrator=integrator)
    return result, result.position("mass")[:, 2] - 1.0, result.velocity("mass")[:, 2]


def acceleration(q, v, t):
    return (force(t) - STIFFNESS * q - DAMPING * v) / MASS


def newmark(beta, gamma, alpha_m, alpha_f, steps=STEPS):
    """Arnold & Bruels: the equations of motion hold at the ends of steps, q and v follow abar."""
    q, v, t, h = [0.02], [0.4], 0.0, STEP
    a = bar = acceleration(q[0], v[0], t)
    c = (1 - alpha_f) / (1 - alpha_m)
    for _ in range(steps):
        t += h
        known = (alpha_f * a - alpha_m * bar) / (1 - alpha_m)  # abar = c a + known
        q_known = q[-1] + h * v[-1] + h**2 * ((0.5 - beta) * bar + beta * known)
        v_known = v[-1] + h * ((1 - gamma) * bar + gamma * known)
        B, G = beta * h**2 * c, gamma * h * c
        a = (force(t) - STIFFNESS * q_known - DAMPING * v_known) / (MASS + G * DAMPING + B * STIFFNESS)
        q.append(q_known + B * a)
        v.append(v_known + G * a)
        bar = c * a + known
    return np.array(q), np.array(v)


def work_of(q, v, steps=STEPS):
    """Dissipated and supplied energy over the steps, mean forces times ways, at their ends."""
    forces = DAMPING * v, force(STEP * np.arange(steps + 1))
    dissipated, supplied = (np.cumsum(0.5 * (f[1:] + f[:-1]) * np.diff(q)) for f in forces)
    return np.append(0.0, dissipated), np.append(0.0, supplied)


@pytest.mark.parametrize("rho", [None, 1.0, 0.8, 0.3, 0.0])
def test_newmark_family(rho):
    method = ancf.Trapezoidal() if rho is None else ancf.GeneralizedAlpha(rho)
    result, q, v = run(method)
    coefficients = (0.25, 0.5, 0.0, 0.0)
    if rho is not None:
        alpha_m, alpha_f = (2 * rho - 1) / (rho + 1), rho / (rho + 1)
        gamma = 0.5 + alpha_f - alpha_m
        coefficients = (0.25 * (gamma + 0.5) ** 2, gamma, alpha_m, alpha_f)
    wanted_q, wanted_v = newmark(*coefficients)
    assert q == pytest.approx(wanted_q, abs=1e-12)
    assert v == pytest.approx(wanted_v, abs=1e-11)
    dissipated, supplied = work_of(wanted_q, wanted_v)
    assert result.energy.dissipated == pytest.approx(dissipated, abs=1e-11)
    assert result.energy.supplied == pytest.approx(supplied, abs=1e-11)
    assert result.energy.kinetic == pytest.approx(0.5 * MASS * wanted_v**2, abs=1e-11)
    assert result.energy.strain == pytest.approx(0.5 * STIFFNESS * wanted_q**2, abs=1e-11)
    assert result.stats.jacobians == 1


def test_central_differences():
    """Forces see v_n + h a_n, which is the velocity in the middle plus half a step of a_n."""
    _, q, v = run(ancf.Explicit())
    x, w, t = 0.02, 0.4, 0.0
    a = acceleration(x, w, t)
    for n in range(1, STEPS + 1):
        middle, t = w + 0.5 * STEP * a, t + STEP
        x += STEP * middle
        a = acceleration(x, middle + 0.5 * STEP * a, t)
        w = middle + 0.5 * STEP * a
        assert (q[n], v[n]) == pytest.approx((x, w), abs=1e-12)


ROOT = 6**0.5
RADAU = {
    2: np.array([[5 / 12, -1 / 12], [3 / 4, 1 / 4]]),
    3: np.array(
        [
            [(88 - 7 * ROOT) / 360, (296 - 169 * ROOT) / 1800, (-2 + 3 * ROOT) / 225],
            [(296 + 169 * ROOT) / 1800, (88 + 7 * ROOT) / 360, (-2 - 3 * ROOT) / 225],
            [(16 - ROOT) / 36, (16 + ROOT) / 36, 1 / 9],
        ]
    ),
}


@pytest.mark.parametrize("stages", RADAU)
def test_radau_iia(stages):
    """y' = J y + b(t) with the tableau of Hairer & Wanner, table 5.5 and 5.6 of section IV.5."""
    _, q, v = run(ancf.Radau(stages=stages, adaptive=False))
    A = RADAU[stages]
    c, h, y = A.sum(axis=1), STEP, np.array([0.02, 0.4])
    J = np.array([[0.0, 1.0], [-STIFFNESS / MASS, -DAMPING / MASS]])
    for n in range(STEPS):
        at = np.stack([J @ y + (0.0, force((n + x) * h) / MASS) for x in c]).ravel()
        k = np.linalg.solve(np.eye(2 * stages) - h * np.kron(A, J), at).reshape(stages, 2)
        y = y + h * A[-1] @ k
        assert (q[n + 1], v[n + 1]) == pytest.approx(tuple(y), abs=1e-10)


def test_work_of_a_moving_support():
    """What the end of the spring supplies: the force of its support times its way."""
    result, _, _ = run(ancf.Trapezoidal(), moved=True)
    end = result.position("carriage")[:, 2]
    support = 0.1 * 0.06 - result.spring_force("spring")  # the spring pulls the carriage up
    supplied = np.cumsum(0.5 * (support[1:] + support[:-1]) * np.diff(end))
    assert end == pytest.approx(0.03 * result.t**2, abs=1e-13)
    assert result.energy.supplied[1:] == pytest.approx(supplied, abs=1e-10)


def test_steps_are_the_same_in_two_blocks():
    """A run that goes on from a state in its middle: the predictor begins anew, the motion does not."""
    whole, q, _ = run(ancf.Trapezoidal())
    made = model()
    first = ancf.simulate(made, t_end=12 * STEP, step=STEP)
    rest = ancf.simulate(made, t_end=STEPS * STEP, step=STEP, start=first.state(-1))
    assert rest.position("mass")[:, 2] - 1.0 == pytest.approx(q[12:], abs=1e-12)
    assert whole.t[12:] == pytest.approx(rest.t)


def test_a_step_that_is_no_motion():
    """Ten sizes of the model in one step: the explicit method has blown up and says so."""
    made = model(damping=0.0)
    with pytest.raises(ancf.SolveError, match="the motion has blown up"):
        ancf.simulate(made, t_end=200 * 0.15, step=0.15, integrator=ancf.Explicit(check=False))


@pytest.mark.parametrize("stages", RADAU)
def test_radau_balances_its_energies(stages):
    """Under gravity and with losses: what is supplied and not dissipated is there, to the method's order."""
    drift = []
    for step in (0.02, 0.01):
        made = model()
        made.gravity[:] = (0, 0, -9.81)
        method = ancf.Radau(stages=stages, adaptive=False)
        energy = ancf.simulate(made, t_end=0.4, step=step, integrator=method).energy
        total = energy.kinetic + energy.strain + energy.potential + energy.dissipated - energy.supplied
        drift.append(np.max(np.abs(total - total[0])))
        assert min(energy.dissipated[-1], abs(energy.supplied[-1])) > 0.01
    assert drift[1] < 1e-2 * energy.dissipated[-1]
    assert drift[0] / drift[1] > 2.0 ** (2 * stages - 1.8)


def test_sensors_take_every_step():
    """The states between the stored ones, positions and velocities each in their place."""
    _, q, v = run(ancf.Trapezoidal())
    made = model()
    given = {"t_end": STEPS * STEP, "step": STEP, "output_step": 10 * STEP, "sensors": ["mass"]}
    sensors = ancf.simulate(made, **given).sensors
    assert sensors.position("mass")[:, 2] - 1.0 == pytest.approx(q, abs=1e-13)
    assert sensors.velocity("mass")[:, 2] == pytest.approx(v, abs=1e-13)


def test_pendulum_on_a_hinge():
    """A rigid rod: angle and force of the hinge against the elliptic integral's equation, integrated finely.

    The positions hold to round-off although the rows are those of the velocities.
    """
    made = ancf.Model(gravity=(0, 0, -9.81))
    rod = made.add_rigid_body("rod", at=(0.5, 0, 0), mass=2.0, inertia=(0.01, 0.2, 0.2))
    made.hinge(rod.at(-0.5, 0, 0), (0, 0, 0), axis=(0, 1, 0), name="hinge")
    result = ancf.simulate(made, t_end=0.3, step=5e-3)
    inertia = 0.2 + 2.0 * 0.25
    angle, rate, h = 0.0, 0.0, 1e-5
    for _ in range(30_000):  # midpoint rule
        middle = angle + 0.5 * h * rate
        rate += h * 2.0 * 9.81 * 0.5 * np.cos(middle) / inertia
        angle = middle + 0.5 * h * rate
    assert result.position(rod)[-1] == pytest.approx((0.5 * np.cos(angle), 0, -0.5 * np.sin(angle)), abs=1e-4)
    gaps = np.linalg.norm(result.position(rod.at(-0.5, 0, 0)), axis=1)
    assert np.max(gaps) < 1e-10
    along = 2.0 * (0.5 * rate**2 + 9.81 * np.sin(angle))  # towards the hinge
    across = 2.0 * (9.81 * np.cos(angle) - 0.5 * 2.0 * 9.81 * 0.5 * np.cos(angle) / inertia)
    direction = np.array([np.cos(angle), 0, -np.sin(angle)])
    normal = np.array([-np.sin(angle), 0, -np.cos(angle)])
    force = along * direction + across * normal  # that the ground receives
    assert result.multiplier("hinge")[-1, :3] == pytest.approx(force, abs=2e-3 * np.linalg.norm(force))


def test_limit_of_a_damped_oscillator():
    """The step at which the map of the explicit method, found here column by column, has an eigenvalue -1."""
    from ancf.solvers.explicit.stability import limit

    for omega, d in ((3.0, 0.0), (3.0, 0.4), (3.0, 2.0), (0.0, 2.0)):
        h = limit(omega, d)

        def grows(step, omega=omega, d=d):
            def one(q, v, a):
                middle = v + 0.5 * step * a
                q = q + step * middle
                a = -(omega**2) * q - d * (middle + 0.5 * step * a)
                return q, middle + 0.5 * step * a, a

            return np.max(np.abs(np.linalg.eigvals(np.array([one(*e) for e in np.eye(3)]).T)))

        assert grows(0.999 * h) <= 1.0 + 1e-6
        assert grows(1.01 * h) > 1.0 + 1e-4


def test_last_step_is_shorter():
    """Two fifths of a step at the end: the same map with a smaller h."""
    made = model(damping=0.0)
    result = ancf.simulate(made, t_end=2.4 * STEP, step=STEP)
    assert result.t == pytest.approx([0.0, STEP, 2 * STEP, 2.4 * STEP])
    q, v = (x[2] for x in (result.position("mass")[:, 2] - 1.0, result.velocity("mass")[:, 2]))
    h, t = 0.4 * STEP, result.t[-2:]
    a = (force(t[0]) - STIFFNESS * q) / MASS
    end = (q + h * v + 0.25 * h**2 * (a + force(t[1]) / MASS)) / (1 + 0.25 * h**2 * STIFFNESS / MASS)
    assert result.position("mass")[-1, 2] - 1.0 == pytest.approx(end, abs=1e-12)


def test_equilibrium_and_frequency():
    made = model()
    state = ancf.equilibrium(made, time=0.2)
    assert state.position("mass")[2] - 1.0 == pytest.approx(force(0.2) / STIFFNESS, abs=1e-12)
    made = ancf.Model()
    mass = made.add_point_mass("mass", at=(0, 0, 1.0), mass=MASS)
    made.hold(mass, position="xy")
    made.add_spring(mass, (0, 0, 0), stiffness=STIFFNESS, length=1.0)
    assert ancf.modes(made, count=1).frequencies[0] == pytest.approx(np.sqrt(STIFFNESS / MASS), rel=1e-12)
    hertz = np.sqrt(STIFFNESS / MASS) / (2 * np.pi)
    assert ancf.modes(made, count=1).frequencies_hz[0] == pytest.approx(hertz, rel=1e-12)
    assert ancf.stable_step(made, safety=1.0) == pytest.approx(2 / np.sqrt(STIFFNESS / MASS), rel=1e-9)


def test_index_1_is_critically_damped():
    """C'' + 2 omega C' + omega^2 C = 0 with omega = 1/(10 h)."""
    h = 0.05
    w0, w1, w2 = FORMULATIONS["index1"].weights(0.3, 0.7, h)
    assert (w0 / w2, w1 / w2) == pytest.approx((1 / (10 * h) ** 2, 2 / (10 * h)))
