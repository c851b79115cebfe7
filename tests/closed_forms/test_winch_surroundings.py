"""Cables that are hauled in and paid out in water and on the ground, beside closed forms."""

from itertools import product

import numpy as np
import pytest

import ancf

G = 9.81
CALM = ancf.GeneralizedAlpha(0.8)


class TestHauledThroughACurrent:
    """A straight line at its critical angle that runs along itself stays there.

    w cos(phi) = rho d C_n U^2 sin^2(phi)/2, whatever its speed V along itself; the tension grows along it by
    w sin(phi) and the drag of U cos(phi) - V.
    """

    @pytest.mark.parametrize(("at_start", "change"), [(True, -1.5), (False, 0.8)])
    def test_its_angle_and_its_tension(self, at_start, change):
        U, rho, d, Cn, Ct, rhoA, first = 2.0, 1025.0, 0.02, 1.2, 0.03, 0.6, 30.0
        w, k = (rhoA - rho * np.pi * d * d / 4) * G, 0.5 * rho * d * Cn * U * U
        c = (-w + np.sqrt(w * w + 4.0 * k * k)) / (2.0 * k)  # cos of the angle to the current
        s = np.sqrt(1.0 - c * c)
        way = np.array([c, 0.0, -s])  # from the winch to the free end, down the current
        section = ancf.Section(EA=1e6, EI=0.0, rhoA=rhoA, diameter=d, drag=(Cn, Ct), axial_damping=1e4)
        model = ancf.Model(gravity=(0, 0, -G))
        ends = ((0, 0, 0), tuple(first * way))
        rope = model.add_beam(
            "rope", start=ends[not at_start], end=ends[at_start], elements=10, section=section
        )
        top, free = (rope.start, rope.end) if at_start else (rope.end, rope.start)
        model.pin(top)
        model.winch(top, length=f"{first} + {change}*t")
        model.add_fluid("sea", rho, velocity=(U, 0, 0))
        speeds = [0.0 * way, change * way]  # all of the line runs along itself from the start
        rope.set_motion(along=[0.0, first], velocities=speeds if at_start else speeds[::-1])
        run = ancf.simulate(model, t_end=6.0, step=0.02, integrator=CALM, output_step=0.5)
        along = U * c - change
        gain = w * s + 0.5 * rho * np.pi * d * Ct * along * abs(along)
        late = run.t > 3.0
        length = first + change * run.t[late]
        assert run.tension(top)[late] == pytest.approx(gain * length, rel=2e-3)
        assert run.position(free)[late] == pytest.approx(length[:, None] * way, abs=2e-3 * first)


class TestPaidOutIntoWater:
    """A rope that hangs in still water moves with the speed of its winch as a whole."""

    @pytest.mark.parametrize("change", [1.2, -1.0])
    def test_weight_drag_and_added_mass(self, change):
        rho, d, Ct, Cat, rhoA, first = 1000.0, 0.03, 0.2, 0.3, 1.5, 12.0
        section = ancf.Section(
            EA=1e7, EI=0.0, rhoA=rhoA, diameter=d, drag=(1.0, Ct), added_mass=(1.0, Cat), axial_damping=1e5
        )
        model = ancf.Model(gravity=(0, 0, -G))
        rope = model.add_beam("rope", start=(0, 0, -first), end=(0, 0, 0), elements=6, section=section)
        model.pin(rope.end)
        model.winch(rope.end, length=lambda t: first + change * (t - np.sin(np.pi * t) / np.pi))
        model.add_fluid("sea", rho)
        run = ancf.simulate(model, t_end=3.0, step=5e-3, start=ancf.equilibrium(model), integrator=CALM)
        t = run.t
        speed, rate = change * (1.0 - np.cos(np.pi * t)), change * np.pi * np.sin(np.pi * t)
        length = first + change * (t - np.sin(np.pi * t) / np.pi)
        displaced = rho * np.pi * d * d / 4
        drag = 0.5 * rho * np.pi * d * Ct * speed * np.abs(speed)
        force = length * ((rhoA - displaced) * G - drag - (rhoA + Cat * displaced) * rate)
        assert run.tension(rope.end) == pytest.approx(force, abs=3e-3 * np.abs(force).max())
        assert run.energy.drift == pytest.approx(np.zeros(len(t)), abs=1e-3 * run.energy.kinetic.max())


class TestPulledOverTheGround:
    """An elastic rope that lies on the ground is stretched by its winch from one end on.

    Friction f per length holds it: what is hauled in is u = F^2/(2 EA f); when it is paid out again the
    force falls by the root of 4 EA f times what was paid out.
    """

    @pytest.mark.filterwarnings("ignore:winch")  # the table has corners
    @pytest.mark.parametrize("at_start", [True, False])
    def test_force_of_what_sticks_and_slips(self, at_start):
        EA, w, mu, length = 2e3, 10.0, 0.5, 20.0
        section = ancf.Section(EA=EA, EI=0.0, rhoA=w / G, diameter=0.05)
        model = ancf.Model(gravity=(0, 0, -G))
        ends = ((0, 0, 0), (length, 0, 0))
        rope = model.add_beam(
            "rope", start=ends[not at_start], end=ends[at_start], elements=20, section=section
        )
        top, far = (rope.start, rope.end) if at_start else (rope.end, rope.start)
        model.pin(top)
        model.pin(far)
        # 0.18 m in, 0.045 m out
        way = {"t": [0, 3, 15, 18, 21, 24], "value": [length, length, 19.82, 19.82, 19.865, 19.865]}
        model.winch(top, length=way)
        model.add_ground("quay", height=0.0, stiffness=1e6, damping=2e4, friction=mu)
        run = ancf.simulate(model, t_end=22.0, step=5e-3, integrator=ancf.GeneralizedAlpha(0.5))
        f = mu * w

        def force(hauled):
            return np.sqrt(2.0 * EA * f * hauled)

        pull = np.interp(run.t, way["t"], length - np.array(way["value"]))
        got = run.tension(top)
        hauling, paying = (run.t > 7.5) & (run.t < 15.0), run.t > 19.5
        assert got[hauling] == pytest.approx(force(pull[hauling]), rel=0.01)
        assert got[paying] == pytest.approx(
            force(0.18) - np.sqrt(4 * EA * f * (0.18 - pull[paying])), abs=1.0
        )
        assert run.tension(far)[-1] == pytest.approx(0.0, abs=0.01 * force(0.18))


def moored(length, friction, winch=True, elements=20, current=0.0):
    """A chain from a seabed to a ship, on a winch there or made with this length."""
    chain = ancf.Section(EA=2e8, EI=0.0, rhoA=50.0, diameter=0.1, drag=(1.6, 0.1), added_mass=(1.0, 0.0))
    model = ancf.Model(gravity=(0, 0, -9.80665))
    line = model.add_beam(
        "chain",
        start=(0, 0, -100),
        end=(290, 0, 0),
        length=320.0 if winch else length,
        elements=elements,
        section=chain,
    )
    model.pin(line.start, name="anchor")
    model.pin(line.end, name="fairlead")
    model.add_fluid("water", density=1025.0, velocity=(0, current, 0))
    model.add_ground("seabed", height=-100.0, stiffness=3e6, damping=3e5, friction=friction)
    if winch:
        model.winch(line.end, length=length)
    return model, line


#: MoorPy 1.3.0, catenary(290, 100, length, 2e8, 411.3786, CB=0): along and across at the fairlead, N.
MOORPY = {312.0: (171626.525, 125684.204), 320.0: (88346.916, 94633.591), 335.0: (33160.516, 66476.260)}


class TestMoored:
    @pytest.mark.parametrize(
        ("length", "friction", "current"), [(312.0, 0.0, 0.0), (335.0, 0.4, 0.0), (325.0, 0.2, 1.0)]
    )
    def test_rests_as_a_chain_that_was_made_so(self, length, friction, current):
        states = [
            ancf.equilibrium(moored(length, friction, winch, current=current)[0]) for winch in (True, False)
        ]
        for share in (0.0, 0.2, 0.55, 1.0):
            here, there = (
                s.model.bodies["chain"].at(share * L) for s, L in zip(states, (320.0, length), strict=True)
            )
            assert states[0].position(here) == pytest.approx(states[1].position(there), abs=1e-5)
            assert states[0].tension(here) == pytest.approx(states[1].tension(there), rel=1e-6)
        for name in ("anchor", "fairlead"):
            assert states[0].reaction(name) == pytest.approx(states[1].reaction(name), rel=1e-6)

    def test_hauled_in_it_comes_to_rest_where_it_should(self):
        """15 m in half a minute, without friction: the chain has forgotten how long it was."""
        model, line = moored("330 - 15*ramp(t, 0, 30)", 0.0)
        run = ancf.simulate(model, t_end=150.0, step=0.1, start=ancf.equilibrium(model), integrator=CALM)
        wanted = ancf.equilibrium(moored(315.0, 0.0, False)[0])
        assert run.natural_length(line)[-1] == 315.0
        assert run.tension(line.end)[-1] == pytest.approx(wanted.tension("chain.end"), rel=1e-3)
        assert run.tension(line.start)[-1] == pytest.approx(wanted.tension("chain.start"), rel=1e-3)
        assert run.tension(line.end)[-1] > 1.3 * run.tension(line.end)[0]

    @pytest.mark.parametrize("length", MOORPY)
    def test_statics_of_moorpy(self, length):
        """One mesh for all lengths."""
        state = ancf.equilibrium(moored(length, 0.0, elements=60)[0])
        force = state.reaction("fairlead")
        assert force[[0, 2]] == pytest.approx(MOORPY[length], rel=5e-4)

    def test_all_work_is_accounted_for(self):
        """With water, ground, friction and a winch that runs, to the order of the steps.

        Steps end within the tolerance also where friction begins to slip: what Newton's method leaves there
        by default is little of the drift of coarse steps, and would be half of that of the finest.
        """
        drift = {}
        for tolerance, step in product((1e-11, 1e-13), (0.1, 0.05, 0.025, 0.0125)):
            model, _ = moored("330 - 5*ramp(t, 0, 10)", 0.3, elements=10)
            method = ancf.Trapezoidal(newton=ancf.Newton(tolerance=tolerance))
            given = {"start": ancf.equilibrium(model), "integrator": method}
            run = ancf.simulate(model, t_end=6.0, step=step, **given)
            drift[tolerance, step] = np.abs(run.energy.drift).max() / run.energy.supplied.max()
        assert drift[1e-11, 0.1] < 1e-5
        assert all(drift[1e-11, h] < 0.5 * drift[1e-11, 2.0 * h] for h in (0.05, 0.025))
        assert all(drift[1e-13, h] < 0.5 * drift[1e-13, 2.0 * h] for h in (0.05, 0.025, 0.0125))
