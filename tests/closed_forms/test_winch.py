"""Cables that a winch pays out and hauls in, beside closed forms and other computations."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ancf

G = 9.81


def cable(model, name, top, bottom, at_start, **given):
    """A straight cable from top to bottom, or the other way round; its points at top and bottom."""
    start, end = (top, bottom) if at_start else (bottom, top)
    beam = model.add_beam(name, start=start, end=end, **given)
    return beam, *((beam.start, beam.end) if at_start else (beam.end, beam.start))


def pendulum(at_start=True, strain="material", elements=4, damping=None, load=1.0, rhoA=1e-3, **given):
    """A load on a rope that is hauled in and paid out again; the model, the rope's top and the load."""
    angle, EA = 0.5, 1e4
    section = ancf.Section(EA=EA, EI=1e-4, rhoA=rhoA, **(damping or {}))
    model = ancf.Model(gravity=(0.0, 0.0, -G))
    tip = (2.0 * np.sin(angle), 0.0, -2.0 * np.cos(angle))
    length = float(2.0 / (1.0 + load * G * np.cos(angle) / EA))
    made = {"section": section, "elements": elements, "length": length, "strain": strain}
    _, top, bottom = cable(model, "rope", (0.0, 0.0, 0.0), tip, at_start, **made, **given)
    model.pin(top)
    model.winch(top, length=f"{length!r} - 0.6*(1 - cos(1.5*t))")
    mass = model.add_point_mass("load", at=tip, mass=load)
    model.connect(bottom, mass)
    return model, top, mass


def swing(times, load=1.0, rhoA=1e-3, EA=1e4):
    """Distance and angle of the load: l phi'' + 2 l' phi' + g sin phi = 0 with a rope that stretches.

    The rope is straight, and evenly stretched; its mass counts where it turns.
    """
    first = 2.0 / (1.0 + load * G * np.cos(0.5) / EA)

    def length(t):
        return first - 0.6 * (1.0 - np.cos(1.5 * t)), -0.9 * np.sin(1.5 * t)

    def rates(t, y):
        (L, dL), (R, dR, phi, w) = length(t), y
        turning, rate = load + rhoA * L / 3.0, rhoA * dL / 3.0
        torque = -G * np.sin(phi) * R * (load + 0.5 * rhoA * L)
        spin = (torque - (rate * R**2 + 2.0 * turning * R * dR) * w) / (turning * R**2)
        return [dR, R * w * w + G * np.cos(phi) - EA * (R / L - 1.0) / load, w, spin]

    found = solve_ivp(rates, (0.0, times[-1]), [2.0, 0.0, 0.5, 0.0], "DOP853", times, rtol=1e-11, atol=1e-12)
    return found.y[0], found.y[2]


class TestPendulum:
    @pytest.mark.parametrize(("at_start", "elements"), [(True, 4), (False, 3)])
    def test_its_angle_is_that_of_the_equation(self, at_start, elements):
        model, _, load = pendulum(at_start, elements=elements)
        result = ancf.simulate(model, t_end=3.0, step=1e-3)
        x, _, z = result.position(load).T
        distance, angle = swing(result.t)
        assert np.abs(np.arctan2(x, -z) - angle).max() < 2e-5
        assert np.abs(np.hypot(x, z) - distance).max() < 1e-4  # the rope's own mass vibrates along it

    def test_the_winch_does_the_work_and_no_more(self):
        model, _, _ = pendulum(rhoA=0.02)
        drift = []
        for step in (2e-3, 1e-3):
            energy = ancf.simulate(model, t_end=1.5, step=step).energy
            drift.append(np.abs(energy.drift).max())
        assert drift[0] / drift[1] == pytest.approx(4.0, rel=0.2)
        energy = ancf.simulate(model, t_end=0.7, step=4e-3, integrator=ancf.Radau()).energy
        assert np.abs(energy.drift).max() < 1e-7 * energy.supplied.max()
        assert energy.supplied.max() > 1.0

    @pytest.mark.parametrize(
        "damping",
        [
            {"axial_damping": 5.0},
            {"bending_damping": 0.05},
            {"damping": 0.05},
            {"slope_damping": 1e-3},
        ],
        ids=lambda given: next(iter(given)),
    )
    @pytest.mark.parametrize("strain", ["material", "paper"])
    def test_what_damping_takes_is_no_more_than_that(self, damping, strain):
        """To the error of Radau's steps."""
        model, _, _ = pendulum(strain == "paper", strain, 2, damping, rhoA=0.05)
        energy = ancf.simulate(model, t_end=0.25, step=2e-3, integrator=ancf.Radau()).energy
        assert np.abs(energy.drift).max() < 2e-7 * energy.supplied.max()
        assert np.all(np.diff(energy.dissipated) >= -1e-12)
        assert energy.dissipated[-1] > 1e-6


class TestHangingRope:
    """All of an inextensible rope that is paid out from a point moves with the speed of the winch."""

    @pytest.mark.parametrize("at_start", [True, False])
    @pytest.mark.parametrize(("elements", "change"), [(3, 1.0), (8, -0.5)])
    def test_force_and_momentum(self, at_start, elements, change):
        EA, rhoA, first = 1e6, 0.4, 2.0
        model = ancf.Model(gravity=(0.0, 0.0, -G))
        section = ancf.Section(EA=EA, EI=1e-3, rhoA=rhoA, axial_damping=2e3)
        given = {"section": section, "elements": elements, "length": first}
        rope, top, bottom = cable(model, "rope", (0, 0, 0), (0, 0, -first), at_start, **given)
        model.pin(top)
        model.winch(top, length=lambda t: first + change * (t - np.sin(np.pi * t) / np.pi))
        result = ancf.simulate(model, t_end=2.0, step=2e-3, start=ancf.equilibrium(model))
        t = result.t
        speed, rate = change * (1.0 - np.cos(np.pi * t)), change * np.pi * np.sin(np.pi * t)
        length = first + change * (t - np.sin(np.pi * t) / np.pi)
        force = rhoA * length * (G - rate)
        assert result.natural_length(rope) == pytest.approx(length, abs=1e-12)
        assert result.tension(top) == pytest.approx(force, abs=2e-3 * rhoA * first * G)
        assert result.momentum[:, 2] == pytest.approx(-rhoA * length * speed, abs=1e-3)
        assert result.position(bottom)[:, 2] == pytest.approx(-length, abs=1e-4)
        energy = result.energy
        assert energy.kinetic == pytest.approx(0.5 * rhoA * length * speed**2, abs=1e-3)
        assert energy.potential == pytest.approx(-0.5 * rhoA * G * length**2, abs=1e-3)
        # what enters brings its energy of motion, and is pushed or held back
        assert np.abs(energy.drift).max() < 1e-4


class TestMovingString:
    """Waves on a taut string that runs out of a winch, whose length changes at a constant speed V.

    In the material the winch is an end that moves: with c the speed of waves and L = V t the reflected part
    of a wave f(c t - x) is -f((c t + x) (c - V)/(c + V)).
    """

    @pytest.mark.parametrize("at_start", [True, False])
    @pytest.mark.parametrize("ratio", [0.2, -0.25])
    def test_a_pulse_is_reflected(self, at_start, ratio):
        EA, eps, rhoA, first, elements = 1e4, 0.01, 0.1, 10.0, 48
        force = EA * eps
        c = np.sqrt(force / (1.0 + eps) / rhoA)  # by the material
        V, size, width = ratio * c, 1e-4, 0.15
        model = ancf.Model()
        section = ancf.Section(EA=EA, EI=0.0, rhoA=rhoA)
        far = ((1.0 + eps) * first, 0.0, 0.0)
        given = {"section": section, "elements": elements, "length": first}
        rope, top, bottom = cable(model, "string", (0, 0, 0), far, at_start, **given)

        def bump(t):
            return size * np.where(np.abs(t - width) < width, np.sin(0.5 * np.pi * t / width) ** 4, 0.0)

        model.pin(top)
        model.winch(top, length=lambda t: first + V * t)
        model.pin(bottom, displacement=lambda t: ((1.0 + eps) * V * t, float(bump(t)), 0.0))
        state = ancf.equilibrium(model)
        slots, v, place = state.system.slots["string"], state.v.copy(), rope.node_x / first
        sign = -1.0 if at_start else 1.0  # of the way from the winch along the mesh
        v[slots[:, 0]] = (1.0 + eps) * V * (place if at_start else 1.0 - place)
        v[slots[:, 1]] = (1.0 + eps) * V / first * -sign
        start = ancf.State(state.system, 0.0, state.q, v)
        t_end = 1.7 * first / (c - V)
        result = ancf.simulate(model, t_end=t_end, step=5e-4, output_step=5e-3, start=start)
        t, L = result.t, first + V * result.t
        for share in (0.25, 0.5, 0.75):
            x = share * L  # from the far end, in the material
            place = string_place(rope, share, at_start)
            y = result.position(place)[:, 1]
            tau = t + first / V  # L = V tau
            ahead, back = c * tau - x, (c * tau + x) * (c - V) / (c + V)
            wanted = bump((ahead - c * first / V) / c) - bump((back - c * first / V) / c)
            assert np.abs(y - wanted).max() < 3e-4 * size
            assert share < 0.75 or wanted.min() < -0.9 * size  # the pulse is on its way back


def string_place(rope, share, at_start):
    """Point at a share of the length from the far end."""
    return rope.at(rope.length * (1.0 - share if at_start else share))


class TestStatics:
    """A cable with a winch rests as one that was made with its length."""

    @staticmethod
    def hung(length, winch, at_start=True, strain="material"):
        section = ancf.Section(EA=5e3, EI=0.2, rhoA=0.3)
        model = ancf.Model(gravity=(0.0, 0.0, -G))
        made = 4.0 if winch else length
        given = {"section": section, "elements": 12, "length": made, "strain": strain}
        rope, top, bottom = cable(model, "rope", (0, 0, 0), (3.5, 0, -0.5), at_start, **given)
        model.pin(top)
        model.pin(bottom)
        model.add_distributed_load(rope, (0.0, 0.4, 0.0))
        if winch:
            model.winch(top, length=f"{length} + 0.5*t")
        return model, rope

    @pytest.mark.parametrize("length", [3.2, 4.0, 5.5])
    @pytest.mark.parametrize(("at_start", "strain"), [(True, "paper"), (False, "material")])
    def test_shape_force_frequencies(self, length, at_start, strain):
        model, rope = self.hung(length, True, at_start, strain)
        other, plain = self.hung(length, False, at_start, strain)
        state, wanted = ancf.equilibrium(model), ancf.equilibrium(other)
        for share in (0.0, 0.3, 1.0):
            here, there = rope.at(share * rope.length), plain.at(share * plain.length)
            assert state.position(here) == pytest.approx(wanted.position(there), abs=1e-8)
            assert state.tension(here) == pytest.approx(wanted.tension(there), rel=1e-6)
            assert state.slope(here) == pytest.approx(wanted.slope(there), abs=1e-7)
            assert state.curvature(here) == pytest.approx(wanted.curvature(there), rel=1e-5, abs=1e-6)
            assert state.bending_moment(here) == pytest.approx(
                wanted.bending_moment(there), rel=1e-5, abs=1e-6
            )
        assert state.natural_length(rope) == length
        mine, theirs = (ancf.modes(m, about=s, count=4) for m, s in ((model, state), (other, wanted)))
        assert mine.frequencies == pytest.approx(theirs.frequencies, rel=1e-6)

    def test_at_a_time(self):
        model, rope = self.hung(4.0, True)
        other, plain = self.hung(4.6, False)
        state, wanted = ancf.equilibrium(model, time=1.2), ancf.equilibrium(other)
        assert state.position(rope.at(2.0)) == pytest.approx(wanted.position(plain.at(2.3)), abs=1e-8)
        pin = model.supports[0]
        assert state.reaction(pin) == pytest.approx(wanted.reaction(other.supports[0]), rel=1e-6)

    def test_a_constant_length_is_a_cable_of_that_length(self):
        results = []
        for winch in (True, False):
            model, rope = constant(4.0 if winch else None)
            results.append(ancf.simulate(model, t_end=0.3, step=1e-3).position(rope.at(1.3)))
        assert np.abs(results[0] - results[1]).max() < 1e-8
        assert np.ptp(results[0][:, 2]) > 0.1


def constant(length):
    """A cable that falls, with a winch that stands still or without."""
    section = ancf.Section(EA=5e3, EI=0.2, rhoA=0.3, axial_damping=1.0, bending_damping=0.01)
    model = ancf.Model(gravity=(0.0, 0.0, -G))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(4, 0, 0), elements=8, section=section)
    model.pin(rope.end)
    if length is not None:
        model.winch(rope.start, length=length)
    return model, rope
