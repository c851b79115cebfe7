"""The overhead-line oracle against closed forms: the package is held against it, so it must be right."""

import json
from dataclasses import replace
from importlib.resources import files

import numpy as np
import pytest
from scipy.linalg import eigh

from ancf.paper import overhead
from overhead_cases import (
    LINE_2002,
    LINE_2018,
    LINE_PAPER,
    LINES,
    PANTOGRAPH_2002,
    PANTOGRAPH_2015,
    PANTOGRAPH_PAPER,
    evaluate,
    excerpt,
    filtered,
    form_of,
)
from overhead_oracle import GRAVITY, Beam, Line, OverheadLine, Wire, hermite, mesh
from overhead_stepping import Factor, Pantograph, Run, correction
from places import DATA

#: Line and pantograph of the recorded cases of the standard.
KNOWN = {"en50318-2002": (LINE_2002, PANTOGRAPH_2002), "en50318-2018": (LINE_2018, PANTOGRAPH_2015)}
RECORDED = json.loads((DATA / "overhead_oracle.json").read_text())
STRING = Wire(mass=1.35, tension=20e3, EI=195.0, support=0.0)
SPEED = np.sqrt(STRING.tension / STRING.mass)
#: A wire of 200 m on its own: the dropper hangs it in the middle from a wire that weighs nothing.
ALONE = Line(
    span=100.0,
    spans=2,
    droppers=(50.0,),
    contact=replace(STRING, EI=1e-3),
    messenger=Wire(mass=1e-6, tension=1.0, EI=1e-6, support=0.0),
    system_height=1.0,
    dropper_stiffness=1e-6,
    held=False,
)


class TestBeam:
    def test_frequencies(self):
        """A tensioned beam between hinges: omega² = (T k² + EI k⁴) / m with k = n pi / L."""
        for EI in (195.0, 2e4):
            beam = Beam(replace(STRING, EI=EI), mesh([0.0, 6.5], 0.25))
            free = np.setdiff1d(np.arange(2 * len(beam.nodes)), beam.node([0.0, 6.5]))
            K, M = (A[free][:, free].toarray() for A in (beam.K, STRING.mass * beam.N))
            k = np.pi * np.arange(1, 5) / 6.5
            found = np.sqrt(eigh(K, M, eigvals_only=True)[:4])
            assert found == pytest.approx(
                np.sqrt((STRING.tension * k**2 + EI * k**4) / STRING.mass), rel=2e-4
            )

    def test_sag_of_a_string(self):
        """Parabola of depth m g L² / (8 T); the cubics hold it exactly without bending."""
        beam = Beam(replace(STRING, EI=0.0), mesh([0.0, 60.0], 2.0))
        z, force = beam.hang(beam.weight, [0.0, 60.0], np.zeros(2))
        q = GRAVITY * STRING.mass
        x = beam.nodes
        assert z[::2] == pytest.approx(-q * x * (60 - x) / (2 * STRING.tension), abs=1e-12)
        assert force == pytest.approx([30 * q] * 2, rel=1e-12)

    def test_boundary_layer(self):
        """Level over its supports, a stiff wire hangs less: by q L / (2 T) sqrt(EI / T) at each."""
        wire = replace(STRING, EI=2e3)
        beam = Beam(wire, mesh([0.0, 60.0, 120.0, 180.0], 0.1))
        z, _ = beam.hang(beam.weight, [0.0, 60.0, 120.0, 180.0], np.zeros(4))
        q, root = GRAVITY * wire.mass, np.sqrt(wire.EI / wire.tension)
        # middle of a clamped span, exact up to exp(-L / root)
        depth = q * 60**2 / (8 * wire.tension) - q * 60 / (2 * wire.tension) * root
        k, N = beam.at(90.0)
        assert -N @ z[k : k + 4] == pytest.approx(depth, rel=3e-4)

    def test_shape_functions(self):
        """Cubics are held exactly, with their derivatives."""
        h, cubic = 0.7, np.polynomial.Polynomial([0.3, -1.2, 2.0, 0.9])
        q = [cubic(0.0), cubic.deriv()(0.0), cubic(h), cubic.deriv()(h)]
        for order in range(3):
            for xi in (0.1, 0.5, 0.9):
                assert hermite(xi, h, order) @ q == pytest.approx(cubic.deriv(order)(xi * h), abs=1e-12)

    def test_graded_mesh(self):
        nodes = mesh([0.0, 5.0, 11.5], 2.0, 0.2)
        sizes = np.diff(nodes)
        assert {0.0, 5.0, 11.5} <= set(np.round(nodes, 12))
        assert sizes.max() <= 2.0
        assert sizes[0] <= 0.2
        assert sizes[0] < sizes[1] < sizes[2]


def string_lengths(line, load, down=None):
    """Undeformed dropper lengths of a span whose messenger is a string: its height is -moment / tension."""
    down = load if down is None else down
    x, span, m = np.array(line.droppers), line.span, line.messenger
    moment = m.mass * GRAVITY * x * (span - x) / 2
    moment += [np.sum(down * np.minimum(a, x) * (span - np.maximum(a, x))) / span for a in x]
    distance = line.system_height + np.array(line.sag or np.zeros(len(x))) - moment / m.tension
    if line.dropper_EA:
        return distance / (1 + load / line.dropper_EA)
    return distance - load / line.dropper_stiffness


class TestForm:
    def test_strings(self):
        """Wires without bending: loads of half a bay on each side, lengths from moments over tension.

        The elements have no kinks: short ones at the droppers keep the rounding below the bars.
        """
        strings = {k: replace(getattr(LINE_2002, k), EI=1e-2) for k in ("contact", "messenger")}
        line = replace(LINE_2002, spans=2, **strings)
        found = OverheadLine(line, 1.0, finest=2e-3)
        x = np.array(line.droppers)
        bays = np.diff([0.0, *x, 60.0])
        P = 1.35 * GRAVITY * (bays[1:] + bays[:-1]) / 2
        assert found.load == pytest.approx(np.tile(P, 2), rel=5e-4)
        wanted = string_lengths(line, P)
        assert found.length == pytest.approx(np.tile(wanted, 2), abs=5e-5)

    def test_published_dropper_table(self):
        """2015 benchmark, wire free at the support: the table within 4.5 mm, within 3 mm without bending."""
        found = OverheadLine(LINE_2018, 0.25)
        table = np.array([1.017, 0.896, 0.810, 0.758, 0.741])
        assert found.length[45:50] == pytest.approx(table, abs=4.5e-3)
        down = found.load + GRAVITY * (LINE_2018.dropper_mass * found.length + LINE_2018.clamps[1])
        lengths = string_lengths(LINE_2018, found.load[45:54], down[45:54])
        assert lengths[:5] == pytest.approx(table, abs=3e-3)

    def test_2002(self):
        """Loads and lengths of an earlier linear model of the 2002 line, held at the supports, and free."""
        held = OverheadLine(replace(LINE_2002, spans=4), 0.25)
        assert held.load[18:23] == pytest.approx([69.5, 79.5, 86.1, 86.1, 86.1], abs=0.1)
        assert held.length[18:23] == pytest.approx([0.998, 0.816, 0.660, 0.566, 0.534], abs=2e-3)
        free = OverheadLine(replace(LINE_2002, spans=4, held=False), 0.25)
        assert free.load[18] == pytest.approx(102.9, abs=0.1)

    def test_rest_is_equilibrium(self):
        """Weight, dropper loads and support forces balance over the whole line, clamps and droppers too."""
        found = OverheadLine(LINE_2018)
        L = LINE_2018.span * LINE_2018.spans
        weight = GRAVITY * (LINE_2018.contact.mass * L + LINE_2018.clamps[0] * len(found.at))
        assert found.load.sum() + found.arm_load.sum() == pytest.approx(weight, rel=1e-9)


class TestRun:
    def test_static_stiffness_of_a_string(self):
        """A force P at x lifts a string by P x (L - x) / (T L)."""
        line = OverheadLine(replace(ALONE, contact=replace(STRING, EI=0.1), flat=True), 0.5)
        pan = Pantograph((5.0,), (1e-6,), (0.0,), force=100.0, penalty=1e9)
        run = Run(line, pan, 10.0, 1e-3)
        u = run.equilibrium(60.25)
        lift = 100.0 * 60.25 * 139.75 / (20e3 * 200)
        assert u[run.heads[0]] == pytest.approx(lift, rel=2e-3)

    def test_moving_load_on_a_string(self):
        """A force P that starts to move over an endless string lifts it, where it is, by P c t / (2 T).

        That is d'Alembert's solution below the wave speed c; no reflection is back within the time taken.
        """
        v, P, T = 0.5 * SPEED, 100.0, STRING.tension
        line = OverheadLine(replace(ALONE, contact=replace(STRING, EI=1.0), flat=True), 0.25)
        pan = Pantograph((1e-3,), (1e-6,), (0.0,), force=P, penalty=1e6)
        run = Run(line, pan, v, 2e-4)
        run.equilibrium = lambda x: np.zeros(len(run.force))  # no contact yet: the force starts at t = 0
        history = run.run(40.0, 40.0 + 0.3 * v)
        t = 2e-4 * np.arange(1, len(history["x"]) + 1)
        wanted = P * SPEED * t / (2 * T)
        late = t > 0.05
        assert history["height"][late] == pytest.approx(wanted[late], rel=1e-2)
        assert history["force"][late].mean() == pytest.approx(P, rel=1e-3)

    def test_energy_is_kept(self):
        """Without damping and with a resting pantograph taken away, the trapezoidal rule keeps the energy."""
        line = OverheadLine(replace(ALONE, contact=STRING, flat=True), 1.0)
        run = Run(line, Pantograph((5.0,), (1.0,), (0.0,), force=100.0), 10.0, 1e-3)
        u = run.equilibrium(70.0)
        run.force[run.heads[0]] = -1e4  # pulled off the wire at once
        run.equilibrium = lambda x: u
        n = line.M.shape[0]
        energy = 0.5 * u[:n] @ (line.K @ u[:n])
        history = run.run(70.0, 90.0)
        assert (history["force"][20:] == 0).all()
        u, v = history["end"][:n], history["rate"][:n]
        assert 0.5 * (v @ (line.M @ v) + u @ (line.K @ u)) == pytest.approx(energy, rel=2e-2)

    @pytest.mark.parametrize("rho", [None, 0.6])
    def test_order_of_the_steps(self, rho):
        """Second order in the step, while the pantograph starts smoothly within one element."""
        line = OverheadLine(replace(LINE_2002, spans=2), 2.0)
        ends = [
            Run(line, PANTOGRAPH_2002, 5.0, h, rho=rho, ramp=0.2).run(72.2, 73.7)["end"][-2:]
            for h in (2e-3, 1e-3, 5e-4)
        ]
        first, second = np.linalg.norm(ends[0] - ends[1]), np.linalg.norm(ends[1] - ends[2])
        assert 3.6 < first / second < 4.4

    def test_standstill(self):
        """Nothing moves as long as the speed is nearly zero: the force stays what it was."""
        line = OverheadLine(replace(LINE_2002, spans=2), 1.0)
        history = Run(line, replace(PANTOGRAPH_2002, at_start=True), 1e-6, 1e-3).run(71.0, 71.0 + 2e-7)
        assert history["force"] == pytest.approx(120.0, abs=1e-4)


class TestCorrection:
    def test_laws_hold(self):
        """Droppers pull or are slack, contact pushes or is open, and both laws hold."""
        rng = np.random.default_rng(5)
        for trial in range(50):
            n, m = 12, 1 + trial % 3
            A = rng.normal(size=(n + m, n + m))
            C = 1e-2 * (A @ A.T) / n + 1e-3 * np.eye(n + m)  # compliance of droppers and contacts
            k, penalty = rng.uniform(1, 3, n), 50.0
            free, gap = rng.normal(size=n), rng.normal(size=m) * 0.1
            G, g = k[:, None] * C[:n, :n], (k[:, None] * C[:n, n:], C[n:, :n])
            s, f, pull = correction(free, gap, G, g, C[n:, n:], True, penalty)
            linear = free + G @ s - g[0] @ f
            assert pull == pytest.approx(np.maximum(linear, 0), abs=1e-10)
            assert s == pytest.approx(np.minimum(linear, 0), abs=1e-10)
            depth = gap + g[1] @ s - C[n:, n:] @ f
            assert f == pytest.approx(penalty * np.maximum(depth, 0.0), abs=1e-10)

    def test_factor(self):
        line = OverheadLine(replace(LINE_2002, spans=2), 2.0, 2.0)
        A, b = line.K + 1e3 * line.M, np.linspace(-1, 1, line.K.shape[0])
        assert A @ Factor(A).solve(b) == pytest.approx(b, abs=1e-8)


class TestNumbers:
    def test_filter(self):
        """20 Hz is at half of the amplitude after both passes, low frequencies pass without a shift."""
        t = np.arange(0, 8, 1e-3)
        for f, size in ((2.0, 1.0), (20.0, 0.5), (60.0, 0.0)):
            wave = np.sin(2 * np.pi * f * t)
            assert filtered(wave, 1e-3, order=4)[2000:6000] == pytest.approx(size * wave[2000:6000], abs=2e-3)

    @pytest.mark.parametrize("case", ["en50318-2002.250", "en50318-2002.300", "en50318-2018.275"])
    def test_recorded(self, case):
        """A coarser mesh and a longer step come close to the recorded, converged statistics."""
        line, pantograph = KNOWN[case.split(".")[0]]
        recorded, kmh = RECORDED[case], float(case.split(".")[1])
        row, pantograph = recorded["zero_phase_4"], replace(pantograph, force=recorded["force"])
        found = evaluate(line, pantograph, kmh / 3.6, 2e-3, mesh={"size": 1.0}, order=4)
        for name in ("mean", "sigma"):
            assert found[name] == pytest.approx(row[name], rel=1.5e-2)
        for name in ("max", "min"):
            assert found[name] == pytest.approx(row[name], abs=2.5)
        assert found["uplift"] == pytest.approx(row["uplift"], abs=0.6)

    def test_recorded_of_the_papers_line(self):
        """Its droppers are stiff: 2 ms are too long."""
        row = RECORDED["paper.45"]["zero_phase_4"]
        given = {"window": (60.0, 180.0), "start": 2.0, "mesh": {"size": 0.5}, "order": 4}
        found = evaluate(LINE_PAPER, PANTOGRAPH_PAPER, 45.0, 1e-3, **given)
        assert found["mean"] == pytest.approx(row["mean"], abs=0.2)
        assert found["sigma"] == pytest.approx(row["sigma"], rel=0.015)

    @pytest.mark.parametrize("name", LINES)
    def test_recorded_forms(self, name):
        assert form_of(LINES[name]) == RECORDED[f"{name}.form"]

    def test_the_package_has_what_is_recorded(self):
        """The numbers that ``ancf reproduce`` compares the paper's line with."""
        text = files("ancf.paper").joinpath("data", "plane.json").read_text(encoding="utf-8")
        assert json.loads(text) == excerpt(RECORDED)
        assert overhead.plane(32.0)[1] == RECORDED["paper.32"]["zero_phase_4"]["sigma"]
