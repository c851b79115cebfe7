"""Bodies in fluids against Morison's formula in numpy and closed forms: drag, added mass, buoyancy."""

import math

import numpy as np
import pytest

import ancf
from ancf.batches import Batches
from ancf.linalg.sparse import to_sparse
from ancf.system.core import assemble, residual
from ancf.system.system import System

G, RHO = 9.81, 1025.0
D, DRAG, MASS = 0.08, (1.3, 0.2), (0.9, 0.3)
AREA = np.pi * D**2 / 4
METHODS = {
    "trapezoidal": ancf.Trapezoidal(),
    "alpha": ancf.GeneralizedAlpha(0.8),
    "explicit": ancf.Explicit(check=False),
}


def section(element="cable", **more):
    given = {"diameter": D, "drag": DRAG, "added_mass": MASS} | more
    if element == "cable":
        return ancf.Section(**{"EA": 2e5, "EI": 20.0, "rhoA": 12.0} | given)
    given.pop("diameter")
    return ancf.Section.circle(D, E=4e7, rho=2400.0, nu=0.3, **given)


def rod(start=(0, 0, 0), end=(3.0, 1.0, -2.0), elements=3, element="cable", gravity=(0, 0, -G), **more):
    model = ancf.Model(gravity=gravity)
    given = section(element, **more)
    return model, model.add_beam(
        "rod", start=start, end=end, elements=elements, section=given, element=element
    )


def unit(x):
    return np.asarray(x) / np.linalg.norm(x)


def morison(t, past, flow_acceleration, acceleration, stretch=1.0, data=(D, DRAG, MASS)):
    """Force per reference length, of a numpy of its own."""
    d, (dn, dt), (mn, mt) = data
    P = np.eye(3) - np.outer(t, t)
    n, along = P @ past, t @ past
    drag = RHO * d / 2 * dn * np.linalg.norm(n) * n + RHO * np.pi * d / 2 * dt * abs(along) * along * t
    added = mn * P + mt * np.outer(t, t)
    area = np.pi * d * d / 4
    weight = np.array([0, 0, G]) * RHO * area
    return drag + weight + RHO * area * ((np.eye(3) + added) @ flow_acceleration - added @ acceleration)


def forces(model, v=(0, 0, 0), a=(0, 0, 0), time=0.0, q=None):
    """Forces of the fluids on the unknowns when all positions move with v and a, and the system."""
    system = System(model)
    start, _ = system.initial_state(time)
    q = start if q is None else q
    system.place(time, q, np.zeros_like(q), np.zeros_like(q))
    rates = np.zeros((2, system.size))
    for slots in system.slots.values():
        for c in range(3):
            rates[0][slots[:, 0] + c], rates[1][slots[:, 0] + c] = v[c], a[c]
    r = np.zeros(system.size)
    batch = system.parts["fluid"]
    residual(Batches((batch,)), system.core.ws, q, *rates, np.zeros(system.size), r)
    return -r, system


def total(model, **given):
    """Their resultant."""
    f, system = forces(model, **given)
    places = np.unique(np.concatenate([slots[:, 0] for slots in system.slots.values()]))
    return np.array([f[places + c].sum() for c in range(3)])


class TestForces:
    @pytest.mark.parametrize("element", ["cable", "original", "nonlocking"])
    @pytest.mark.parametrize("seed", range(3))
    def test_on_a_straight_rod(self, element, seed):
        """In any direction, with any velocity, acceleration and number of elements."""
        end, v, a, u = np.random.default_rng(seed).uniform(-2, 2, (4, 3))
        model, body = rod(end=end, elements=1 + seed, element=element)
        model.add_fluid("water", RHO, velocity=u)
        wanted = morison(unit(end), u - v, np.zeros(3), a) * body.length
        assert total(model, v=v, a=a) == pytest.approx(wanted, rel=1e-12)

    def test_of_a_flow_in_time(self):
        model, body = rod()
        model.add_fluid("water", RHO, velocity=["2*sin(3*t)", 0.3, "t**2"])
        t = 0.7
        u, du = [2 * np.sin(3 * t), 0.3, t**2], [6 * np.cos(3 * t), 0.0, 2 * t]
        wanted = morison(unit((3, 1, -2)), np.array(u), np.array(du), np.zeros(3)) * body.length
        assert total(model, time=t) == pytest.approx(wanted, rel=1e-7)

    def test_velocity_as_formula_function_and_profile_is_the_same(self):
        """A flow that is linear in z, in four ways."""
        z = np.linspace(-3.0, 1.0, 9)
        ways = [
            ["0.5 + 0.2*z", 0.0, "-0.1*z"],
            lambda t, x, y, z: (0.5 + 0.2 * z, 0.0, -0.1 * z),
            {"z": z, "velocity": np.stack([0.5 + 0.2 * z, 0 * z, -0.1 * z], axis=1)},
        ]
        found = []
        for way in ways:
            model, _ = rod()
            model.add_fluid("water", RHO, velocity=way)
            found.append(forces(model)[0])
        assert found[1] == pytest.approx(found[0], rel=1e-12, abs=1e-12)
        assert found[2] == pytest.approx(found[0], rel=1e-12, abs=1e-12)
        xi, w = np.polynomial.legendre.leggauss(20)
        t = unit((3, 1, -2))
        parts = [
            morison(
                t,
                np.array([0.5 - 0.2 * (1 + s), 0, 0.1 * (1 + s)]),
                np.array([0.02, 0, -0.01]) * (1 + s),  # the flow goes up, to where it is faster
                np.zeros(3),
            )
            for s in xi
        ]
        wanted = np.linalg.norm((3, 1, -2)) / 2 * np.einsum("i,ij->j", w, parts)
        assert total(model) == pytest.approx(wanted, rel=1e-4)

    def test_profile_is_level_outside(self):
        for shift, expected in ((-50.0, 0.0), (50.0, 2.0)):
            model, body = rod(start=(0, 0, shift), end=(0, 0, shift + 1.0))
            model.add_fluid("water", RHO, velocity={"z": [-1, 1], "velocity": [[0, 0, 0], [2, 0, 0]]})
            wanted = RHO * D / 2 * DRAG[0] * expected**2 * body.length
            assert total(model)[0] == pytest.approx(wanted)

    def test_law_of_time_and_place(self):
        model, body = rod(start=(0, 0, 0), end=(0, 0, -1e-3), elements=1)
        model.add_fluid("water", RHO, velocity=["sin(2*t)*(1+x)", 0, 0])
        t = 0.4
        du = np.array([2 * np.cos(2 * t) + np.sin(2 * t) ** 2, 0, 0])
        wanted = (
            morison(np.array([0, 0, -1.0]), np.array([np.sin(2 * t), 0, 0]), du, np.zeros(3)) * body.length
        )
        assert total(model, time=t) == pytest.approx(wanted, rel=1e-7)

    def test_on_masses(self):
        model = ancf.Model(gravity=(0, 0, -G))
        model.add_point_mass("ball", at=(0, 0, 0), mass=3.0, volume=0.02, drag_area=0.05, added_mass=0.5)
        model.add_fluid("water", RHO, velocity=(1.0, -2.0, 0.5))
        v, a = np.array([0.2, 0.1, -0.4]), np.array([1.0, 2.0, 3.0])
        past = np.array([1.0, -2.0, 0.5]) - v
        wanted = 0.5 * RHO * 0.05 * np.linalg.norm(past) * past + RHO * 0.02 * (np.array([0, 0, G]) - 0.5 * a)
        assert total(model, v=v, a=a) == pytest.approx(wanted, rel=1e-12)


class TestMatrix:
    @pytest.mark.parametrize("moving", [False, True])
    def test_against_differences(self, moving):
        """Mass and damping whole, the stiffness of a straight rod its symmetric part."""
        model, _ = rod(elements=2)
        model.add_fluid("water", RHO, velocity=(1.0, -0.5, 0.3) if moving else (0, 0, 0), below=-0.7)
        system = System(model)
        rng = np.random.default_rng(1)
        q, _ = system.initial_state()
        v, a = rng.uniform(-1, 1, (2, system.size)) * (1.0 if moving else 0.0)
        batch, f = system.parts["fluid"], np.zeros(system.size)

        def force(q, v, a):
            r = np.zeros(system.size)
            residual(Batches((batch,)), system.core.ws, q, v, a, f, r)
            return r

        def whole(mass, damping, stiffness):
            A = np.zeros(system.places.size)
            assemble(Batches((batch,)), system.core.ws, q, v, A, mass, damping, stiffness)
            return to_sparse(A, system.places).toarray()

        def gradient(k, step=1e-6):
            columns = []
            for i in range(system.n):
                d = np.zeros(system.size)
                d[i] = step
                ahead, back = ([q, v, a], [q, v, a])
                ahead[k], back[k] = ahead[k] + d, back[k] - d
                columns.append((force(*ahead) - force(*back)) / (2 * step))
            return np.array(columns).T

        M, C = gradient(2, 1.0), gradient(1)
        assert whole(1.0, 0.0, 0.0) == pytest.approx(M, abs=1e-9 * np.abs(M).max())
        if moving:
            assert whole(0.0, 1.0, 0.0) == pytest.approx(C, abs=1e-6 * np.abs(C).max())
        v = a = np.zeros(system.size)
        K = gradient(0)
        own = whole(0.0, 0.0, 1.0)
        if moving:  # what the piece of a surface changes with the slope is left out
            model_dry, _ = rod(elements=2)
            model_dry.add_fluid("water", RHO, velocity=(1.0, -0.5, 0.3))
            system = System(model_dry)
            batch = system.parts["fluid"]
            q, _ = system.initial_state()
            K, own = gradient(0), whole(0.0, 0.0, 1.0)
            assert own == pytest.approx(0.5 * (K + K.T), abs=1e-6 * np.abs(K).max())
        else:
            places = system.slots["rod"][:, 0] + 2
            assert np.abs(own[np.ix_(places, places)]).max() > 0.0


def circle(t):
    """A turn of 2 rad/s from (0.7, 0)."""
    return 0.7 * np.cos(2.0 * t), 0.7 * np.sin(2.0 * t)


class TestSurface:
    @pytest.mark.parametrize("depth", [0.3, 1.0, 1.7, 2.6])
    @pytest.mark.parametrize("elements", [1, 4])
    def test_a_rod_that_pierces_it_displaces_what_is_under(self, depth, elements):
        model, _ = rod(start=(0, 0, 3.0 - depth), end=(0, 0, -depth), elements=elements)
        model.add_fluid("water", RHO, below=0.0)
        assert total(model)[2] == pytest.approx(RHO * AREA * G * depth, rel=1e-12)

    def test_a_level_rod_comes_out_over_its_diameter(self):
        for height, share in ((-0.6, 1.0), (-0.25, 0.75), (0.0, 0.5), (0.4, 0.1), (0.6, 0.0)):
            model, body = rod(start=(0, 0, height * D), end=(2, 0, height * D))
            model.add_fluid("water", RHO, below=0.0)
            assert total(model)[2] == pytest.approx(share * RHO * AREA * G * body.length, abs=1e-9)

    def test_water_and_air(self):
        model, _ = rod(start=(0, 0, 1.0), end=(0, 0, -2.0), elements=5)
        model.add_fluid("water", RHO, velocity=(0.5, 0, 0), below=0.0)
        model.add_fluid("air", 1.2, velocity=(20.0, 0, 0), above=0.0)
        wanted = D / 2 * DRAG[0] * (RHO * 0.25 * 2.0 + 1.2 * 400.0 * 1.0)
        assert total(model) == pytest.approx([wanted, 0, G * AREA * (RHO * 2.0 + 1.2)], rel=1e-12)

    def test_a_ball_floats_half_under(self):
        model = ancf.Model(gravity=(0, 0, -G))
        ball = model.add_point_mass("ball", at=(0, 0, 0.02), mass=RHO * 0.01, volume=0.02, drag_area=0.1)
        model.hold(ball, position="xy")
        model.add_fluid("water", RHO, below=0.0)
        model.add_spring(ball, (0, 0, 50.0), stiffness=1e-3, length=49.9)
        assert ancf.equilibrium(model).position(ball)[2] == pytest.approx(0.0, abs=1e-5)


class TestMotion:
    @pytest.mark.parametrize("angle", [0.0, 0.5, 1.2])
    def test_terminal_speed_of_an_inclined_cable(self, angle):
        """It glides: its normal and its tangential part balance the weight each on its own."""
        t = np.array([np.cos(angle), 0.0, -np.sin(angle)])
        model, cable = rod(end=4.0 * t, elements=3)
        model.add_fluid("water", RHO)
        run = ancf.simulate(model, t_end=12.0, step=0.02, output_step=1.0)
        weight = (12.0 - RHO * AREA) * G
        normal = np.sqrt(2 * weight * np.cos(angle) / (RHO * D * DRAG[0]))
        along = np.sqrt(2 * weight * np.sin(angle) / (RHO * np.pi * D * DRAG[1]))
        n = np.array([-np.sin(angle), 0.0, -np.cos(angle)])
        wanted = normal * n + along * t
        for point in (cable.start, cable.at(1.7), cable.end):
            assert run.velocity(point)[-1] == pytest.approx(wanted, abs=1e-4 * np.linalg.norm(wanted))

    @pytest.mark.parametrize("added", [0.0, 1.0, 2.5])
    def test_added_mass_lowers_the_frequency_of_a_wire(self, added):
        found = []
        for wet in (False, True):
            model = ancf.Model()
            given = ancf.Section(EA=1e6, EI=0.0, rhoA=2.0, diameter=D, drag=(1, 1), added_mass=(added, 0))
            wire = model.add_beam(
                "wire", start=(0, 0, 0), end=(5, 0, 0), elements=8, section=given, length=4.99
            )
            model.pin(wire.start)
            model.pin(wire.end)
            if wet:
                model.add_fluid("water", RHO)
            found.append(ancf.modes(model, count=4).frequencies)
        ratio = np.sqrt(2.0 / (2.0 + RHO * AREA * added))
        assert found[1] / found[0] == pytest.approx(ratio, rel=1e-9)

    @pytest.mark.parametrize("speed", [0.6, 1.5])
    def test_critical_angle_of_a_towed_cable(self, speed):
        """w cos(phi) = rho d C_D V^2 sin(phi)^2/2 along a straight line with a free end."""
        weight = (12.0 - RHO * AREA) * G
        c = 0.5 * RHO * D * DRAG[0] * speed**2 / weight
        cosine = (np.sqrt(1 + 4 * c * c) - 1) / (2 * c)
        model, cable = rod(end=(6.0, 0, -14.0), elements=20)
        model.pin(cable.start)
        model.add_fluid("water", RHO, velocity=(speed, 0, 0))
        state = ancf.equilibrium(model)
        way = state.position(cable.end) - state.position(cable.start)
        assert way[0] / np.linalg.norm(way) == pytest.approx(cosine, rel=1e-4)

    @pytest.mark.parametrize("elements", [3, 20])
    @pytest.mark.parametrize("speed", [0.5, 1.0, 2.0, pytest.param(4.0, marks=pytest.mark.slow)])
    @pytest.mark.parametrize("EI", [0.0, 1.0])
    def test_critical_angle_from_a_cable_that_hangs(self, speed, elements, EI):
        """However strong the current is: drag follows the cable, and no symmetric matrix has all of it."""
        D, drag, weight = 0.03, 1.5, (2.0 - 1025.0 * np.pi * 0.03**2 / 4) * G
        model = ancf.Model(gravity=(0, 0, -G))
        section = ancf.Section(EA=1e7, EI=EI, rhoA=2.0, diameter=D, drag=(drag, 0.01))
        cable = model.add_beam("cable", start=(0, 0, -50), end=(0, 0, 0), elements=elements, section=section)
        model.pin(cable.end)
        model.add_fluid("sea", 1025.0, velocity=(-speed, 0, 0))
        state = ancf.equilibrium(model)
        c = 0.5 * 1025.0 * D * drag * speed**2 / weight
        cosine = (np.sqrt(1 + 4 * c * c) - 1) / (2 * c)
        way = state.position(cable.start) - state.position(cable.end)
        assert -way[0] / np.linalg.norm(way) == pytest.approx(cosine, rel=1e-6)
        assert way[2] < 0

    @pytest.mark.parametrize("length", [66.0, 80.0])
    def test_waves_that_have_not_begun_are_calm_water(self, length):
        """A slack line between two ends finds its place under them as without them."""
        found = []
        for waves in (None, ancf.Waves.regular(height=4.0, period=9.0, depth=60.0)):
            model = ancf.Model(gravity=(0, 0, -G))
            section = ancf.Section(EA=1e7, EI=20.0, rhoA=12.0, diameter=D, drag=DRAG)
            line = model.add_beam(
                "line", start=(0, 0, -50), end=(40, 0, -5), length=length, elements=24, section=section
            )
            model.clamp(line.start)
            model.clamp(line.end)
            model.add_fluid("water", RHO, below=0.0, waves=waves)
            state = ancf.equilibrium(model)
            found.append(np.array([state.position(line.at(x)) for x in np.linspace(0, length, 15)]))
        assert found[1] == pytest.approx(found[0], abs=1e-7)

    def test_a_ball_in_an_oscillating_flow(self):
        """Without drag the flow drags it along by (1 + C_A) rho V of its own and the added mass."""
        model = ancf.Model()
        ball = model.add_point_mass("ball", at=(0, 0, 0), mass=5.0, volume=0.01, added_mass=0.5)
        model.add_fluid("water", 1000.0, velocity=["0.3*sin(2*t)", 0, 0])
        run = ancf.simulate(model, t_end=3.0, step=0.002, output_step=0.1)
        ratio = 1.5 * 10.0 / (5.0 + 5.0)
        assert run.velocity(ball)[:, 0] == pytest.approx(ratio * 0.3 * np.sin(2 * run.t), abs=1e-6)

    @pytest.mark.parametrize(
        ("flow", "path"),
        [
            (["0.6*x", 0, "-0.6*z"], lambda t: (0.7 * np.exp(0.6 * t), 0 * t, 0.4 * np.exp(-0.6 * t))),
            (lambda t, x, y, z: (-2.0 * y, 2.0 * x, 0.1), lambda t: (*circle(t), 0.4 + 0.1 * t)),
            (["0.3*t*x", 0, 0], lambda t: (0.7 * np.exp(0.15 * t * t), 0 * t, 0.4 + 0 * t)),
            (
                {"z": [-9.0, 9.0], "velocity": [[-4.5, 0, 0.25], [4.5, 0, 0.25]]},
                lambda t: (0.7 + 0.2 * t + 0.0625 * t * t, 0 * t, 0.4 + 0.25 * t),
            ),
        ],
        ids=["stagnation", "vortex", "unsteady", "shear"],
    )
    @pytest.mark.parametrize("added", [0.0, 0.5])
    def test_what_weighs_as_the_water_goes_with_it(self, flow, path, added):
        """Without any drag, by the acceleration of the particles of the fluid alone."""
        model = ancf.Model(gravity=(0, 0, -G))
        given = {"volume": 0.02, "drag_area": 0.0, "added_mass": added}
        ball = model.add_point_mass("ball", at=(0.7, 0, 0.4), mass=RHO * 0.02, **given)
        fluid = model.add_fluid("water", RHO, velocity=flow)
        ball.set_motion(velocity=fluid.velocity.at(0.0, np.array([0.7, 0, 0.4])))
        run = ancf.simulate(model, t_end=1.0, step=1e-3)
        assert run.position(ball) == pytest.approx(np.stack(path(run.t), axis=1), abs=2e-6)

    def test_order_four_in_length_of_a_cable_in_a_current(self):
        def places(elements):
            section = ancf.Section(EA=1e5, EI=400.0, rhoA=12.0, diameter=0.08, drag=(1.2, 0.1))
            model = ancf.Model(gravity=(0, 0, -G))
            ends = {"start": (0, 0, -9), "end": (8, 1, -2), "length": 11.0}
            rope = model.add_beam("rope", **ends, elements=elements, section=section)
            model.pin(rope.start)
            model.pin(rope.end)
            stream = ["0.6 + 0.3*sin(0.5*z)*cos(0.2*x)", "1.5*exp(0.1*z)", "0.2*sin(0.3*x)"]
            model.add_fluid("water", 1025.0, velocity=stream)
            state = ancf.equilibrium(model)
            return np.array([state.position(rope.at(x)) for x in (2.75, 5.5, 8.25)])

        exact = places(64)
        gaps = [np.abs(places(n) - exact).max() for n in (8, 16, 32)]
        assert np.log2(np.divide(gaps[:-1], gaps[1:])) == pytest.approx([4.0, 4.0], abs=0.25)

    @pytest.mark.parametrize("method", METHODS)
    def test_order_two_with_drag_and_added_mass(self, method):
        def swing(step, integrator):
            model, cable = rod(end=(2.0, 0, 0), elements=2, EA=2e3, EI=2.0)
            model.pin(cable.start)
            model.add_fluid("water", RHO, velocity=["0.5*sin(3*t)", "0.1*z", 0])
            run = ancf.simulate(model, t_end=0.4, step=step, integrator=integrator, output_step=0.4)
            return run.position(cable.end)[-1]

        exact = swing(0.02, ancf.Radau(tolerance=1e-9))
        steps = (4e-4, 2e-4) if method == "explicit" else (2e-3, 1e-3)
        gaps = [np.linalg.norm(swing(h, METHODS[method]) - exact) for h in steps]
        assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.1)

    def test_energy_is_booked_once(self):
        """What drag and the added mass take is supplied, nothing is dissipated; the balance is of order 2."""
        drifts = []
        for step in (4e-3, 2e-3):
            model, cable = rod(end=(2.0, 0, 0), elements=2)
            model.pin(cable.start)
            model.add_fluid("water", RHO, velocity=(0.2, 0.3, 0))
            run = ancf.simulate(model, t_end=1.0, step=step)
            assert not np.any(run.energy.dissipated)
            assert run.energy.supplied[-1] < -1.0
            drifts.append(np.abs(run.energy.drift).max())
        assert drifts[1] < 1e-3 * abs(run.energy.supplied[-1])
        assert drifts[0] / drifts[1] > 3.0


def test_a_velocity_without_a_value_is_named():
    """In the step where it has none any more, with its time and place; not outside of the fluid."""
    section = ancf.Section(EA=1e5, EI=0.1, rhoA=3.0, diameter=0.05, drag=(1.2, 0.1), added_mass=(1.0, 0.0))
    for above, wrong in ((None, True), (5.0, False)):
        model = ancf.Model(gravity=(0, 0, -9.81))
        line = model.add_beam("line", start=(0, 0, -1), end=(2, 0, -1), elements=2, section=section)
        model.pin(line.start)
        model.add_fluid(
            "river", 100.0, velocity=lambda t, x, y, z: (math.sqrt(0.05 - t) if t > 0.05 else 0.1, 0.0, 0.0),
            above=above,
        )  # fmt: skip
        if not wrong:
            ancf.simulate(model, t_end=0.04, step=0.01)
            continue
        with pytest.raises(ancf.SolveError, match=r'add_fluid\("river"\).velocity') as caught:
            ancf.simulate(model, t_end=0.1, step=0.01)
        assert "t = 0.05" in str(caught.value)
        assert ", -1" in str(caught.value)
        assert len(str(caught.value)) < 300
