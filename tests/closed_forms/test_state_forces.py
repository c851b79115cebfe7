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

    @pytest.mark.parametrize("force", [lambda t, r, v: -3.0 * v, ["-3*vx", "-3*vy", 0]])
    def test_resistance_holds_nothing(self, force):
        with pytest.raises(ancf.ModelError, match='nothing holds "mass" in x, y, z'):
            ancf.equilibrium(model(force))


def raises(t, r, v):
    if r[0] > 0.3:
        raise ValueError("too far")
    return (1.0, 0.0, 0.0)


def no_number(t, r, v):
    return (1.0, 0.0, np.sqrt(0.3 - r[0]))


def short(t, r, v):
    return np.array([1.0, 0.0, 0.0])[: 3 if t < 0.5 else 2]


class TestLawsWithoutValue:
    """A law that fails on the way: one message with time, step, name and what it did, whatever the method."""

    @pytest.mark.parametrize(
        "method",
        [ancf.Trapezoidal(), ancf.GeneralizedAlpha(0.8), ancf.Radau(), ancf.Explicit(check=False)],
        ids=lambda method: method.name,
    )
    @pytest.mark.parametrize(
        ("law", "said"),
        [
            (raises, r"r = \(0\.3.* m the function raised ValueError: too far"),
            (no_number, r"is \[1\.0, 0\.0, nan\] at t = .*r = \(0\.3.*must be finite"),
            (short, r"the function of t, r, v returned shape \(2,\), wanted \(3,\)"),
            (["1", "0", "sqrt(0.3 - x)"], r"is \[1\.0, 0\.0, nan\] at t = "),
        ],
        ids=["raises", "no number", "short", "formula"],
    )
    def test_message(self, law, said, method):
        made = model(law, velocity=(0.5, 0, 0))
        with pytest.raises(ancf.SolveError, match=said) as caught:
            ancf.simulate(made, t_end=2.0, step=0.01, integrator=method)
        found = caught.value
        assert "add_force(mass).force" in found.where
        at = float(found.where.split()[2])
        assert found.result.t[-1] - 1e-9 <= at < found.result.t[-1] + 0.011
        assert 0.3 < found.result.t[-1] < 0.6


class TestAlongABeam:
    """A law of (t, r, v) per length: against a load that is no law, external damping, and an elastic bed."""

    def rope(self, load=None, between=None, elements=3, **section):
        made = ancf.Model(gravity=(0, 0, -9.81))
        given = ancf.Section(**{"EA": 400.0, "EI": 0.2, "rhoA": 0.5} | section)
        wire = made.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0.3), elements=elements, section=given)
        made.pin(wire.start)
        if load is not None:
            made.add_distributed_load(wire, load, between=between)
        return made, wire

    @pytest.mark.parametrize("between", [None, (0.3, 1.9), (0.7, 0.9)])
    def test_constant_law_is_a_dead_load(self, between):
        """The weights of the Gauss points, with ends of the load within elements."""
        ends = []
        for load in ((0.3, "sin(2*t)", -1.0), ["0.3", "sin(2*t) + 0*x", "-1"]):
            made, wire = self.rope(load, between)
            ends.append(ancf.simulate(made, t_end=0.3, step=5e-3).position(wire.end))
        assert ends[0] == pytest.approx(ends[1], abs=1e-10)

    @pytest.mark.parametrize("law", [lambda t, r, v: -0.4 * v, ["-0.4*vx", "-0.4*vy", "-0.4*vz"]])
    @pytest.mark.parametrize("method", [ancf.Trapezoidal(), ancf.Radau(tolerance=1e-8)], ids=lambda m: m.name)
    def test_damping_is_that_of_the_section(self, law, method):
        found = []
        for made, wire in (self.rope(law), self.rope(damping=0.4)):
            run = ancf.simulate(made, t_end=0.5, step=2e-3, integrator=method)
            found.append(run.position(wire.end))
            assert np.abs(run.energy.drift).max() < 1e-3 * run.energy.kinetic.max()
        assert found[0] == pytest.approx(found[1], abs=2e-7)
        assert run.energy.supplied[-1] == 0.0  # of the section it is dissipated, of a law supplied

    @pytest.mark.parametrize("elements", [2, 5])
    def test_elastic_bed(self, elements):
        """A straight cable on a bed that its weight presses in evenly: z = -rhoA g/k."""
        made = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e3, EI=0.2, rhoA=0.5)
        wire = made.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=elements, section=section)
        made.hold(wire.start, position="xy")
        made.hold(wire.end, position="y")
        made.add_distributed_load(wire, lambda t, r, v: np.array([0.0, 0.0, -50.0 * r[2]]))
        state = ancf.equilibrium(made)
        for x in (0.0, 0.37, 1.0, 2.0):
            assert state.position(wire.at(x))[2] == pytest.approx(-0.5 * 9.81 / 50.0, rel=1e-9)

    def test_fails_with_a_message(self):
        made, _ = self.rope(["0", "0", "sqrt(0.5 + z)"])
        with pytest.raises(
            ancf.SolveError, match=r"add_distributed_load\(wire\)\.load: is .*nan.*r = \("
        ) as caught:
            ancf.simulate(made, t_end=2.0, step=2e-3)
        assert caught.value.result.t[-1] > 0.1

    def test_described_and_refused(self):
        made, wire = self.rope(["-y", "0", "-0.1*vz"])
        again = ancf.Model.from_dict(made.to_dict())
        assert again.to_dict() == made.to_dict()
        runs = [ancf.simulate(m, t_end=0.02, step=1e-3).q for m in (made, again)]
        assert np.array_equal(*runs)
        for law, said in (
            (lambda t, r, v: (1.0, 0.0), "wanted \\(3,\\)"),
            (lambda t, r, v: 1 / 0, "raised ZeroDivisionError"),
            (["log(-1 - 0*x)", "0", "0"], "must be finite"),
        ):
            with pytest.raises(ancf.ModelError, match=said) as caught:
                made.add_distributed_load(wire, law, name="wrong")
            assert "load" in caught.value.where
