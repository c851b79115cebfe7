"""Forces by laws of the point's state, model.add_force(point, lambda t, r, v: ...), against closed forms."""

import numpy as np
import pytest

import ancf
from helpers import SOFT

M, K, C = 2.0, 50.0, 4.0
REST = np.array((0.5, -0.2, 0.1))


def model(force=None, start=(0, 0, 0), velocity=(0, 0, 0), tip=None, spring=None):
    """A mass with a force, and apart from it a cable with one at its end: every test has the same kernels."""
    made = ancf.Model()
    wire = made.add_beam("wire", start=(5, 0, 0), end=(6, 0, 0), elements=2, section=ancf.Section(**SOFT))
    made.clamp(wire.start)
    mass = made.add_point_mass("mass", at=start, mass=M)
    mass.set_motion(velocity=velocity)
    made.add_force(mass, force or (lambda t, r, v: -K * r))
    if tip is not None:
        made.add_force(wire.end, tip)
    if spring is not None:
        made.add_spring(wire.end, spring, stiffness=K, length=0.0)
    return made


def path(made, step, t_end=1.0, **given):
    run = ancf.simulate(made, t_end=t_end, step=step, output_step=0.1, **given)
    return run, run.position("mass")


FORMULAS = [f"-{K}*({name}-({rest}))-{C}*v{name}" for name, rest in zip("xyz", REST, strict=True)]


def function(t, r, v):
    return -K * (r - REST) - C * v


def oscillation(t):
    """Damped oscillation from rest at the origin."""
    decay = C / (2 * M)
    omega = np.sqrt(K / M - decay**2)
    shape = np.exp(-decay * t) * (np.cos(omega * t) + decay / omega * np.sin(omega * t))
    return REST * (1 - shape)[:, None]


class TestOscillator:
    @pytest.mark.parametrize("law", [function, FORMULAS], ids=["function", "formulas"])
    def test_order_two(self, law):
        gaps = []
        for step in (0.02, 0.01):
            run, x = path(model(law), step)
            gaps.append(np.abs(x - oscillation(run.t)).max())
        assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.03)
        assert gaps[1] < 1e-3

    def test_function_and_formulas_are_the_same(self):
        ends = [path(model(law), 0.01)[1] for law in (function, FORMULAS)]
        assert ends[0] == pytest.approx(ends[1], abs=1e-14)

    def test_radau(self):
        run, x = path(model(function), 0.02, integrator=ancf.Radau(adaptive=False))
        assert np.abs(x - oscillation(run.t)).max() < 1e-8

    def test_work_is_supplied_and_nothing_dissipated(self):
        """What the law takes: the energy that the mass would have without damping is not there."""
        run, _ = path(model(function), 0.005)
        v = run.velocity("mass")
        kinetic = 0.5 * M * np.sum(v * v, axis=1)
        assert np.all(np.asarray(run.energy.dissipated) == 0.0)
        assert run.energy.supplied == pytest.approx(kinetic, abs=1e-9)


def test_function_of_time_alone():
    """A law that uses t is the force that is given as a function of time."""
    given = ["3*sin(5*t)", "cos(3*t)", "1"]
    law = path(model([text + "+0*x" for text in given]), 0.01)[1]
    known = ancf.Model()
    mass = known.add_point_mass("mass", at=(0, 0, 0), mass=M)
    known.add_force(mass, given)
    assert law == pytest.approx(path(known, 0.01)[1], abs=1e-13)


@pytest.mark.parametrize("turn", [1.0, -3.0])
def test_magnetic_force_turns_the_velocity(turn):
    """F = q v x B does no work: a helix with the frequency q B/m, which has no symmetric derivative."""

    def force(t, r, v):
        return np.array([M * turn * v[1], -M * turn * v[0], 0.0])

    gaps = []
    for step in (0.02, 0.01):
        exact = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14))
        run, x = path(model(force, velocity=(1.0, 0.0, 0.3)), step, integrator=exact)
        t = run.t
        helix = np.stack([np.sin(turn * t) / turn, (np.cos(turn * t) - 1) / turn, 0.3 * t], axis=1)
        gaps.append(np.abs(x - helix).max())
        assert np.linalg.norm(run.velocity("mass"), axis=1) == pytest.approx(np.hypot(1, 0.3), rel=1e-9)
        assert run.energy.supplied == pytest.approx(0.0, abs=1e-9)
    assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.05)


@pytest.mark.parametrize("end", [(6.0, 0.3, -0.4), (6.5, 0.0, 0.2)])
def test_equilibrium_of_a_cable(end):
    """A pull towards a place is a spring without length."""

    def pull(t, r, v):
        return np.array([-K * (r[0] - end[0]), -K * (r[1] - end[1]), -K * (r[2] - end[2])]) - 7.0 * v

    law, spring = (
        ancf.equilibrium(model(start=(0.1, 0, 0), **given), load_steps=2)
        for given in ({"tip": pull}, {"spring": end})
    )
    assert law.position("wire.end") == pytest.approx(spring.position("wire.end"), abs=1e-12)
    assert law.position("mass") == pytest.approx(np.zeros(3), abs=1e-12)


class TestBadInput:
    @pytest.mark.parametrize(
        ("force", "place", "what"),
        [
            (lambda t, r, v: r[0], "force", "returned shape \\(\\), wanted \\(3,\\)"),
            (lambda t, r, v: ["a", 0, 0], "force", "wanted \\(3,\\)"),
            (lambda t, r, v: v / np.linalg.norm(v), "force", "must be finite .it is asked for at rest too"),
            (lambda t, r, v: 1 / 0, "force", "raised ZeroDivisionError"),
            (["1/vx", 0, 0], "force", "must be finite"),
            (["2*x + w", 0, 0], "force\\[0\\]", 'unknown name "w", known are t, x, y, z, vx, vy, vz, pi'),
            (["x", 0, None], "force\\[2\\]", "number"),
        ],
    )
    def test_is_refused_where_it_is_given(self, force, place, what):
        with pytest.raises(ancf.ModelError, match=f"^add_force\\(mass\\).{place}: .*{what}"):
            model(force)

    @pytest.mark.parametrize(
        "force",
        [
            lambda t, r, v: np.array([float(str(t)), 0, 0]),
            lambda t, r, v: np.array([{"a": t}.get("b", 0.0), 0, 0]),
        ],
    )
    def test_numba_cannot_compile_it(self, force):
        with pytest.raises(ancf.ModelError, match=r"numba cannot compile the law: .* numpy and math alone"):
            ancf.equilibrium(model(force))

    @pytest.mark.parametrize("force", [lambda t, r, v: -3.0 * v, ["-3*vx", "-3*vy", 0]])
    def test_resistance_holds_nothing(self, force):
        with pytest.raises(ancf.ModelError, match='nothing holds "mass" in x, y, z'):
            ancf.equilibrium(model(force))

    def test_a_callable_object_is_no_function(self):
        class Law:
            def __call__(self, t, r, v):
                return -r

        with pytest.raises(ancf.ModelError, match="is no plain Python function"):
            ancf.equilibrium(model(Law()))
