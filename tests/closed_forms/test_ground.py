"""Bodies on grounds: rest, impact, friction that sticks and slips, memory; catenaries of other programs."""

import json
import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ancf
from ancf.analysis import prepared
from ancf.batches import Batches
from ancf.system.core import residual
from ancf.system.system import System

DATA = Path(__file__).parents[1] / "data"
G, D, RHOA = 9.81, 0.1, 3.0
K = 2e4  # Pa/m


def lying(z=0.0, tilt=0.0, elements=3, gravity=None, length=2.0, EA=1e5, **ground):
    """A cable along x on a ground that slopes down towards x by an angle, at the depth -z normal to it."""
    model = ancf.Model(gravity=(0, 0, -G) if gravity is None else gravity)
    t, n = np.array([np.cos(tilt), 0, -np.sin(tilt)]), np.array([np.sin(tilt), 0, np.cos(tilt)])
    section = ancf.Section(EA=EA, EI=10.0, rhoA=RHOA, diameter=D)
    cable = model.add_beam("cable", start=z * n, end=z * n + length * t, elements=elements, section=section)
    given = {"height": 0.0, "stiffness": K} | ({"normal": n} if tilt else {}) | ground
    model.add_ground("ground", **given)
    return model, cable, t, n


def rest(tilt=0.0, k=K):
    return -RHOA * G * np.cos(tilt) / (D * k)


class TestPressure:
    @pytest.mark.parametrize("k", [2e3, 2e5])
    @pytest.mark.parametrize("elements", [1, 4])
    def test_a_cable_lies_where_the_ground_bears_it(self, k, elements):
        model, cable, *_ = lying(elements=elements, stiffness=k)
        model.hold(cable.start, position="xy")
        model.hold(cable.end, position="y")
        state = ancf.equilibrium(model)
        for x in (0.0, 0.7, 2.0):
            assert state.position(cable.at(x))[2] == pytest.approx(rest(k=k), rel=1e-9)

    @pytest.mark.parametrize("c", [0.0, 400.0])
    def test_a_cable_that_drops_bounces(self, c):
        """Against the same law for one mass, integrated by another program; it never pulls."""
        model, cable, *_ = lying(z=0.05, elements=2, damping=c)
        run = ancf.simulate(model, t_end=0.6, step=1e-4, output_step=1e-2)

        def law(t, y):
            on = np.clip(1.0 - y[0] / (0.01 * D), 0.0, 1.0)
            N = D * max(0.0, -K * y[0] - c * on * y[1]) if on > 0.0 else 0.0
            return [y[1], N / RHOA - G]

        exact = solve_ivp(law, (0, 0.6), (0.05, 0.0), t_eval=run.t, rtol=1e-10, atol=1e-12, max_step=1e-3)
        assert run.position(cable.at(0.9))[:, 2] == pytest.approx(exact.y[0], abs=3e-5)
        assert run.velocity(cable.end)[:, 2].max() > 0.3
        if not c:
            assert np.abs(run.energy.drift).max() < 1e-3 * RHOA * 2.0 * G * 0.05

    def test_order_two_on_the_ground(self):
        gaps = []
        for step in (2e-3, 1e-3):
            model, cable, *_ = lying(z=-0.03, elements=1, damping=100.0)
            run = ancf.simulate(model, t_end=0.05, step=step, output_step=0.05)
            exact = solve_ivp(
                lambda t, y: [y[1], -D * (K * y[0] + 100.0 * y[1]) / RHOA - G],
                (0, 0.05),
                (-0.03, 0.0),
                rtol=1e-11,
                atol=1e-13,
            )
            gaps.append(abs(run.position(cable.start)[-1, 2] - exact.y[0][-1]))
        assert gaps[0] / gaps[1] == pytest.approx(4.0, rel=0.1)

    def test_a_table_of_heights(self):
        """Of a plane it gives the forces of the plane; a slope pushes normal to itself."""
        x = y = np.linspace(-4.0, 4.0, 5)
        heights = -0.3 - 0.2 * x[:, None] + 0.1 * y[None, :]
        forces = []
        for way in ({"height": {"x": x, "y": y, "z": heights}}, {"height": -0.3, "normal": (0.2, -0.1, 1.0)}):
            model, *_ = lying(z=-0.6, **way)
            system = System(model)
            q, v = system.initial_state()
            r = np.zeros(system.size)
            residual(Batches((system.parts["ground"],)), system.core.ws, q, v, v, np.zeros(system.size), r)
            forces.append(r)
        assert np.abs(forces[0]).max() > 1.0
        assert forces[0] == pytest.approx(forces[1], rel=1e-9)

    def test_a_table_is_level_outside(self):
        model, *_ = lying(z=-0.1, height={"x": [-9, -8], "y": [-1, 1], "z": [[0, 0], [-0.05, -0.05]]})
        system = System(model)
        q, v = system.initial_state()
        r = np.zeros(system.size)
        residual(Batches((system.parts["ground"],)), system.core.ws, q, v, v, np.zeros(system.size), r)
        places = system.slots["cable"][:, 0]
        assert -r[places + 2].sum() == pytest.approx(D * K * 0.05 * 2.0)
        assert r[places].sum() == pytest.approx(0.0, abs=1e-12)


class TestExplicit:
    """Central differences know the ground before anything touches it."""

    def test_stable_step(self):
        model, *_ = lying(z=0.05, elements=1, stiffness=1e7, EA=1e2)
        assert ancf.stable_step(model, safety=1.0) == pytest.approx(2 / np.sqrt(1e7 * D / RHOA), rel=0.05)

    def test_a_step_that_is_too_large_is_refused_before_it_falls(self):
        model, cable, *_ = lying(z=0.05, elements=1, stiffness=1e7, EA=1e3, damping=500.0)
        with pytest.raises(ancf.ModelError, match="largest stable step"):
            ancf.simulate(model, t_end=0.3, step=4e-3, integrator=ancf.Explicit())
        run = ancf.simulate(model, t_end=0.3, step=2e-4, integrator=ancf.Explicit())
        assert run.position(cable.start)[:, 2].min() > -0.05


class TestSteps:
    """A step in which a cable bounces off, and more, is named before anything has fallen."""

    @pytest.mark.parametrize(
        ("step", "method", "height", "said"),
        [
            (1e-2, ancf.Trapezoidal(), 0.5, True),
            (1e-3, ancf.Trapezoidal(), 0.5, False),
            (1e-2, ancf.GeneralizedAlpha(0.8), 0.5, True),
            (1e-2, ancf.GeneralizedAlpha(0.0), 0.5, False),
            (1e-2, ancf.Trapezoidal(), -1e-4, False),
        ],
    )
    def test_it_is_said_at_the_start(self, step, method, height, said):
        model, *_ = lying(z=height, elements=2, stiffness=1e6)
        rate = np.sqrt(1e6 * D / RHOA)
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            ancf.stepper(model, step=step, integrator=method)
        assert len(heard) == said
        for text in (str(w.message) for w in heard):
            assert '"cable" would bounce on the ground "ground"' in text
            assert f"{rate:.3g} rad/s" in text
            assert f"take {0.5 / rate:.2g} s" in text

    @pytest.mark.parametrize(("height", "said"), [(0.5, True), (1.9, True), (2.5, False)])
    def test_what_hangs_at_rest_farther_above_than_it_is_long_does_not_fall(self, height, said):
        model = ancf.Model(gravity=(0, 0, -G))
        section = ancf.Section(EA=1e5, EI=0.1, rhoA=RHOA, diameter=D)
        cable = model.add_beam("cable", start=(0, 0, 0), end=(2.0, 0, 0), elements=4, section=section)
        model.pin(cable.start)
        model.pin(cable.end)
        model.add_ground("ground", height=-height - 0.1, stiffness=1e6)
        with warnings.catch_warnings(record=True) as heard:
            warnings.simplefilter("always")
            ancf.stepper(model, step=1e-2, start=ancf.equilibrium(model))
        assert len([w for w in heard if "would bounce" in str(w.message)]) == said

    @pytest.mark.parametrize("zeta", [0.0, 1.0])
    def test_there_energy_appears_and_below_it_does_not(self, zeta):
        """After an impact there is more than it fell with, damped or not, but with rho_inf = 0."""
        k, fell = 1e5, RHOA * 2.0 * G * 0.5
        made = {}
        for phase, rho_inf in ((3.0, 0.8), (0.45, 0.8), (3.0, 0.0), (20.0, 0.0)):
            model, *_ = lying(z=0.5, elements=2, stiffness=k, damping=2 * zeta * np.sqrt(k * RHOA / D))
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                energy = ancf.simulate(
                    model,
                    t_end=3.0,
                    step=phase / np.sqrt(k * D / RHOA),
                    integrator=ancf.GeneralizedAlpha(rho_inf),
                ).energy
            total = energy.kinetic + energy.strain + energy.potential
            made[phase, rho_inf] = (total.max() - total[0]) / fell
        assert made[3.0, 0.8] > 0.2
        assert max(made[key] for key in made if key != (3.0, 0.8)) < 0.05


class TestFriction:
    def test_rests_on_a_slope_below_the_limit(self):
        """For 1e5 steps; once the spring of its friction has come to rest it does not creep."""
        model, cable, t, _ = lying(z=rest(0.2), tilt=0.2, elements=1, friction=0.6, damping=300.0)
        run = ancf.simulate(model, t_end=111.0, step=1e-3, output_step=1.0, energy=False)
        x = run.position(cable.end) @ t
        assert np.abs(x[10:] - x[10]).max() < 1e-6 * 2.0
        assert x[-1] - x[0] == pytest.approx(RHOA * G * np.sin(0.2) / (D * K), rel=1e-6)

    @pytest.mark.parametrize("tilt", [0.3, 0.6])
    def test_slides_down_a_slope_above_the_limit(self, tilt):
        model, cable, t, _ = lying(z=rest(tilt), tilt=tilt, elements=2, friction=0.2, stick=1e8)
        run = ancf.simulate(model, t_end=0.5, step=1e-3, output_step=0.5)
        moved = (run.position(cable.start)[-1] - run.position(cable.start)[0]) @ t
        wanted = 0.5 * G * (np.sin(tilt) - 0.2 * np.cos(tilt)) * 0.25
        assert moved == pytest.approx(wanted, rel=1e-2)

    def test_a_push_to_and_fro_leaves_a_loop(self):
        """Quasi-static, against the elastic-plastic spring by hand: sticks, slips, unloads elastically."""
        push = {"t": [0, 4, 8, 12], "value": [[0, 0, 0], [40.0, 0, 0], [-40.0, 0, 0], [0, 0, 0]]}
        model, cable, *_ = lying(z=rest(), elements=1, friction=0.3, damping=50.0, length=1.0, EA=1e6)
        model.hold(cable.start, position="y")
        model.add_force(cable.start, push)
        model.add_spring(cable.start, (-5.0, 0, 0), stiffness=2000.0, damping=50.0)
        run = ancf.simulate(model, t_end=12.0, step=2e-3, output_step=0.02)
        x = run.position(cable.start)[:, 0]
        limit, k, spring, u, path = 0.3 * RHOA * G, D * K, 2000.0, 0.0, []
        stretch = 0.0
        for t in run.t:
            force = np.interp(t, push["t"], [row[0] for row in push["value"]])
            trial = (force + k * (u - stretch)) / (k + spring)  # elastic from where it is
            stretch_trial = stretch + trial - u
            if abs(k * stretch_trial) > limit:
                trial = (force - np.sign(stretch_trial) * limit) / spring
                stretch_trial = np.sign(stretch_trial) * limit / k
            u, stretch = trial, stretch_trial
            path.append(u)
        assert np.ptp(path) > 4 * limit / k
        assert x == pytest.approx(np.array(path), abs=0.05 * np.abs(path).max())

    def test_memory_goes_with_a_state(self, tmp_path):
        """A run in two halves, through a file, is the whole run."""
        model, cable, *_ = lying(tilt=0.3, z=rest(0.3), elements=2, friction=0.28, damping=300.0)
        model.add_force(cable.end, ["15*sin(9*t)", "4*cos(7*t)", 0])
        whole = ancf.simulate(model, t_end=0.6, step=1e-3)
        ancf.simulate(model, t_end=0.3, step=1e-3, file=tmp_path / "half.h5")
        loaded = ancf.load(tmp_path / "half.h5")
        known = loaded.state(-1).known.memory
        assert set(known) == {"ground.anchor", "ground.limit"}
        assert known["ground.limit"].max() > 0.0
        rest_of_it = ancf.simulate(model, t_end=0.6, step=1e-3, start=loaded.state(-1))
        assert rest_of_it.position(cable.end)[-1] == pytest.approx(whole.position(cable.end)[-1], abs=2e-6)
        resumed = ancf.resume(tmp_path / "half.h5", t_end=0.6)
        assert np.array_equal(resumed.position(cable.end)[-1], whole.position(cable.end)[-1])

    def test_a_step_that_is_taken_back_takes_the_memory_back(self):
        model, *_ = lying(z=rest(), elements=2, friction=0.3)
        method = ancf.Trapezoidal()
        given = {"output_step": None, "sensors": None, "energy": True, "start": None}
        made = prepared(model, method=method, t_end=0.1, step=1e-3, **given)
        system, run = made.system, made.run
        before = {name: x.copy() for name, x in system.memory.items()}
        saved = run.bridge._save()
        for x in system.memory.values():
            x += 1.0
        run.bridge._put_back(saved)
        assert set(before) == {"ground.anchor", "ground.limit"}
        for name, x in system.memory.items():
            assert np.array_equal(x, before[name])


def catenary(*given, **more):
    """Force at the anchor and both at the fairlead, see :func:`lying_catenary`."""
    state, anchor, fairlead = lying_catenary(*given, **more)
    return -state.reaction(anchor)[0], *state.reaction(fairlead)[[0, 2]]


def lying_catenary(friction, elements=100, k=1e8, length=500.0, nodes=None):
    """Of MoorPy: XF 400 m, ZF 200 m, EA 7.51e12 N, w 800 N/m; the anchor lies as the line does."""
    low = -800.0 / (k * D)
    model = ancf.Model(gravity=(0, 0, -G))
    section = ancf.Section(EA=7.51e12, EI=0.0, rhoA=800.0 / G, diameter=D)
    ends = (0, 0, low), (400.0, 0, 200.0 + low)
    line = model.add_beam(
        "line",
        start=ends[0],
        end=ends[1],
        elements=None if nodes is not None else elements,
        nodes=nodes,
        section=section,
        length=length,
    )
    anchor, fairlead = model.pin(line.start), model.pin(line.end)
    model.add_ground("seabed", 0.0, stiffness=k, friction=friction)
    return ancf.equilibrium(model), anchor, fairlead


class TestMoorPy:
    """Its catenary function, version 1.3.0, with a rigid ground: H 96643.428 N; with CB 0.1 80418.604 N."""

    def test_without_friction(self):
        anchor, fairlead, _ = catenary(0.0)
        assert anchor == pytest.approx(96643.428, rel=1e-5)
        assert fairlead == pytest.approx(96643.428, rel=1e-5)

    def test_error_of_a_soft_ground_shrinks_with_its_stiffness(self):
        gaps = [abs(catenary(0.0, k=k)[1] / 96643.428 - 1) for k in (1e5, 1e7)]
        assert gaps[1] < 1e-4
        assert gaps[0] > 3 * gaps[1]

    def test_with_friction(self):
        anchor, fairlead, _ = catenary(0.1)
        assert anchor == pytest.approx(80418.604, rel=1e-4)
        assert fairlead == pytest.approx(96643.428, rel=1e-4)

    @pytest.mark.parametrize(
        "row",
        # in the ordinary run one length without friction and one with
        [
            pytest.param(row, marks=[] if (row["length"] < 490.0) == (row["CB"] > 0.0) else pytest.mark.slow)
            for row in json.loads((DATA / "moorpy.json").read_text())["rows"]
        ],
        ids=str,
    )
    def test_lines_of_other_lengths(self, row):
        """A taut one and a slack one, with short elements where they touch down."""
        length, touch = row["length"], row["LBot"]
        parts = (0.0, touch - 20.0, 41), (touch - 20.0, touch + 20.0, 31), (touch + 20.0, length, 41)
        nodes = np.unique(np.concatenate([np.linspace(*part) for part in parts]).round(9))
        anchor, along, up = catenary(row["CB"], length=length, nodes=nodes)
        assert anchor == pytest.approx(row["HA"], rel=1e-4)
        assert along == pytest.approx(row["HF"], rel=1e-4)
        assert up == pytest.approx(row["VF"], rel=1e-4)

    @pytest.mark.parametrize(
        ("length", "friction"),
        [
            (520.0, 2.0),
            (560.0, 0.7),
            *(
                pytest.param(*pair, marks=pytest.mark.slow)
                for pair in ((520.0, 0.3), (520.0, 0.7), (560.0, 0.3), (560.0, 2.0))
            ),
        ],
    )
    def test_friction_presses_no_slack_line(self, length, friction):
        """More of it than its tension bears pulls no harder at the fairlead, and the anchor never pushes."""
        _, fairlead, up = catenary(0.0, length=length)
        anchor, along, held = catenary(friction, length=length)
        assert anchor > -1e-3 * fairlead
        assert along == pytest.approx(fairlead, rel=5e-3)
        assert held == pytest.approx(up, rel=1e-3)

    @pytest.mark.parametrize("length", [460.0, 500.0, 520.0, 560.0])
    @pytest.mark.parametrize("friction", [0.0, 0.1, 2.0])
    def test_it_is_said_where_friction_acts_from(self, friction, length):
        """Whether the anchor feels it, with the line as it is drawn, can be told from the notes alone."""
        state, anchor, _ = lying_catenary(friction, elements=40, k=1e7, length=length)
        free, place, _ = lying_catenary(0.0, elements=40, k=1e7, length=length)
        said = [
            note for note in state.notes if note.startswith('friction on "seabed" holds cables from where')
        ]
        felt = abs(state.reaction(anchor)[0] / free.reaction(place)[0] - 1.0) > 1e-3
        lies = length > 470.0  # a taut one touches nothing
        assert len(said) == (friction > 0.0 and lies and not felt)

    def test_a_slack_line_needs_a_fine_mesh(self):
        """Its curvature jumps where it touches down: the order comes near two."""
        gaps = [abs(catenary(0.0, elements=n, length=520.0)[1] / 54331.751 - 1.0) for n in (50, 100, 200)]
        assert gaps[0] > 2.0 * gaps[1] > 6.0 * gaps[2]
        assert gaps[2] < 1e-4
