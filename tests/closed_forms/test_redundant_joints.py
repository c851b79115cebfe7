"""Joints that hold the same motion twice and agree: closed loops, doors with two hinges, tables."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

import ancf

G = 9.81


def parallelogram(
    length: float, masses: tuple[float, float], turn: Rotation, order: tuple[int, ...], angle: float = 1.0
) -> tuple[ancf.Model, ancf.RigidBody]:
    """Two hanging cranks of a length and a coupler that stays parallel, four hinges: three rows too many.

    The whole is turned in space together with gravity; the joints are added in some order.
    """
    model = ancf.Model(gravity=turn.apply((0, 0, -G)))
    crank = np.array([np.sin(angle), 0.0, -np.cos(angle)]) * length
    width = np.array([0.8, 0.0, 0.0])
    axes = turn.as_matrix()
    thin = np.diag((length**2 / 12, length**2 / 12, length**2 / 12))

    def body(name, at, mass, inertia):
        return model.add_rigid_body(name, at=turn.apply(at), mass=mass, inertia=inertia, axes=axes)

    left = body("left", 0.5 * crank, masses[0], masses[0] * thin)
    right = body("right", width + 0.5 * crank, masses[0], masses[0] * thin)
    coupler = body("coupler", crank + 0.5 * width, masses[1], masses[1] * 0.1 * np.eye(3))
    ends = [
        (left.at(*(-0.5 * crank)), turn.apply((0, 0, 0))),
        (left.at(*(0.5 * crank)), coupler.at(*(-0.5 * width))),
        (coupler.at(*(0.5 * width)), right.at(*(0.5 * crank))),
        (right.at(*(-0.5 * crank)), turn.apply(width)),
    ]
    for k in order:
        model.hinge(*ends[k], axis=turn.apply((0, 1, 0)), name=f"h{k}")
    return model, coupler


def swing(length: float, masses: tuple[float, float], angle: float, t: np.ndarray) -> np.ndarray:
    """Angle of the cranks: (2 m l^2/12 + 2 m l^2/4 + M l^2) phi'' = -(m + M) g l sin(phi)."""
    m, M = masses
    ratio = (m + M) * G / ((2 * m / 3 + M) * length)
    return solve_ivp(
        lambda _, y: (y[1], -ratio * np.sin(y[0])), (0, t[-1]), (angle, 0.0), t_eval=t, rtol=1e-10, atol=1e-12
    ).y[0]


SPACE = Rotation.from_euler("zyx", (0.4, -1.1, 0.7))


class TestParallelogram:
    @pytest.mark.parametrize(
        ("length", "masses", "turn", "order"),
        [
            (0.5, (1.0, 2.0), Rotation.identity(), (0, 1, 2, 3)),
            (1.5, (3.0, 0.5), SPACE, (2, 0, 3, 1)),
            (0.2, (0.1, 0.1), SPACE, (3, 2, 1, 0)),
        ],
    )
    @pytest.mark.parametrize("method", [ancf.Trapezoidal(), ancf.GeneralizedAlpha(rho_inf=0.9)])
    def test_swings_as_its_equation_says(self, length, masses, turn, order, method):
        model, coupler = parallelogram(length, masses, turn, order)
        result = ancf.simulate(model, t_end=1.0, step=1e-3, integrator=method)
        phi = swing(length, masses, 1.0, result.t)
        crank = length * np.stack([np.sin(phi), 0 * phi, -np.cos(phi)], axis=1)
        expected = turn.apply(crank + np.array([0.4, 0, 0]))
        assert np.abs(result.position(coupler) - expected).max() < 3e-5 * max(1.0, length / 0.2)
        assert len(result.notes) in (1, 2, 3)
        assert all("held by other joints already" in note for note in result.notes)

    @pytest.mark.parametrize("formulation", ["index1", "index2", "ggl"])
    def test_every_formulation(self, formulation):
        model, coupler = parallelogram(0.5, (1.0, 2.0), SPACE, (1, 3, 0, 2))
        method = ancf.Trapezoidal(formulation=formulation)
        result = ancf.simulate(model, t_end=0.5, step=1e-3, integrator=method)
        phi = swing(0.5, (1.0, 2.0), 1.0, result.t)
        height = -0.5 * np.cos(phi)
        assert SPACE.inv().apply(result.position(coupler))[:, 2] == pytest.approx(height, abs=3e-5)

    def test_equilibrium_and_mode(self):
        """A horizontal force F: tan(phi) = F/((m + M) g); then the frequency about it."""
        m, M, length, F = 1.0, 2.0, 0.5, 8.0
        model, coupler = parallelogram(length, (m, M), Rotation.identity(), (0, 1, 2, 3), angle=0.3)
        model.add_force(coupler, (F, 0, 0))
        state = ancf.equilibrium(model)
        phi = np.arctan2(F, (m + M) * G)
        assert state.position(coupler)[0] == pytest.approx(length * np.sin(phi) + 0.4, abs=1e-8)
        stiffness = np.hypot(F, (m + M) * G) * length
        omega = np.sqrt(stiffness / ((2 * m / 3 + M) * length**2))
        found = ancf.modes(model, about=state, count=1).frequencies_hz[0]
        assert found == pytest.approx(omega / (2 * np.pi), rel=1e-7)

    def test_results_of_a_file_and_going_on(self, tmp_path):
        model, coupler = parallelogram(0.5, (1.0, 2.0), SPACE, (0, 1, 2, 3))
        whole = ancf.simulate(model, t_end=0.2, step=1e-3)
        ancf.simulate(model, t_end=0.1, step=1e-3, file=tmp_path / "half.h5")
        result = ancf.resume(tmp_path / "half.h5", t_end=0.2)
        np.testing.assert_array_equal(result.position(coupler)[-1], whole.position(coupler)[-1])
        assert ancf.load(tmp_path / "half.h5").notes == whole.notes


class TestDoor:
    @pytest.mark.parametrize("hinges", [2, 3])
    def test_more_hinges_move_as_one(self, hinges):
        ends = []
        for count in (1, hinges):
            model = ancf.Model(gravity=(1.0, 2.0, -G))
            door = model.add_rigid_body("door", at=(0.5, 0, 0), mass=20.0, inertia=(1.0, 2.0, 3.0))
            for k, z in enumerate(np.linspace(0, 0.8, count)):
                model.hinge(door.at(-0.5, 0, z), (0, 0, z), axis=(0, 0, 1), name=f"hinge {k}")
            result = ancf.simulate(model, t_end=0.5, step=2e-3)
            ends.append(result.position(door))
        assert np.ptp(ends[0][:, 1]) > 0.1
        np.testing.assert_allclose(ends[1], ends[0], atol=1e-9)

    def test_forces_of_all_hinges_together_carry_the_door(self):
        """How they share is not determined; their sum is."""
        model = ancf.Model(gravity=(0, 0, -G))
        door = model.add_rigid_body("door", at=(0.5, 0, 0), mass=20.0, inertia=(1.0, 2.0, 3.0))
        names = [model.hinge(door.at(-0.5, 0, z), (0, 0, z), axis=(0, 0, 1)) for z in (0.0, 0.8)]
        result = ancf.simulate(model, t_end=0.01, step=1e-3, integrator=ancf.GeneralizedAlpha())
        total = sum(result.multiplier(joint)[-1, :3] for joint in names)
        assert abs(total) == pytest.approx((0, 0, 20.0 * G), abs=1e-6)


class TestFeet:
    def test_a_body_on_three_balls_stays(self):
        """Nine rows for six motions: nothing moves."""
        model = ancf.Model(gravity=(0, 0, -G))
        body = model.add_rigid_body("table", at=(0, 0, 0), mass=1.0, inertia=(1, 1, 1))
        for name, place in zip(("one", "two", "three"), np.eye(3), strict=True):
            model.connect(body.at(*place), place, name=name)
        result = ancf.simulate(model, t_end=0.1, step=0.01)
        assert np.abs(result.position(body)).max() < 1e-9


class TestRefused:
    @pytest.mark.parametrize("order", list(itertools.permutations(range(4)))[::7])
    def test_a_flat_parallelogram(self, order):
        """All four hinges in a line: one row more depends on the others there, and not beside it."""
        model, _ = parallelogram(0.5, (1.0, 2.0), SPACE, order, angle=np.pi / 2)
        with pytest.raises(ancf.ModelError, match="not beside it") as info:
            ancf.simulate(model, t_end=0.1, step=1e-3)
        assert info.value.where == "connections"
        assert info.value.hint == "start from another position of the mechanism"

    def test_hinges_with_other_axes(self):
        """Two hinges of a door whose axes differ: it cannot move, and they do not contradict each other."""
        model = ancf.Model(gravity=(0, 0, -G))
        door = model.add_rigid_body("door", at=(0.5, 0, 0), mass=20.0, inertia=(1.0, 2.0, 3.0))
        model.hinge(door.at(-0.5, 0, 0.4), (0, 0, 0.4), axis=(0, 0, 1), name="upper")
        model.hinge(door.at(-0.5, 0, 0), (0, 0, 0), axis=(0, 0.2, 1), name="lower")
        result = ancf.simulate(model, t_end=0.1, step=1e-2)
        assert np.abs(result.position(door) - (0.5, 0, 0)).max() < 1e-9


def driven(motion, turn=SPACE, **more):
    """A rigid body on two hinges to the ground in one line, which a given motion of one support drives."""
    model = ancf.Model(gravity=turn.apply((0, 0, -G)))
    door = model.add_rigid_body("door", at=(0, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.3))
    rod = model.add_beam("rod", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ROD)
    model.clamp(rod.start, to=door, name="grip")
    axis = (0, 1, 0)
    for k, y in enumerate((-0.3, 0.3)):
        model.hinge(door.at(0, y, 0), (0, y, 0), axis=axis, name=f"h{k}")
    model.clamp(rod.start, name="drive", **motion)
    return model, rod


ROD = ancf.Section(EA=1e4, EI=5.0, rhoA=0.3)
METHODS = {
    "ggl": ancf.Trapezoidal(),
    "index2": ancf.Trapezoidal(formulation="index2"),
    "index1": ancf.Trapezoidal(formulation="index1"),
    "alpha": ancf.GeneralizedAlpha(rho_inf=0.8),
    "radau": ancf.Radau(),
}


class TestDriven:
    """Rows that are left out because supports hold them have to agree with the motions of these."""

    @pytest.mark.parametrize("method", METHODS)
    def test_a_motion_that_agrees_is_followed(self, method):
        model, _ = driven({"rotation": "sin(3*t)", "axis": (0, 1, 0)})
        run = ancf.simulate(model, t_end=0.5, step=1e-3, output_step=0.01, integrator=METHODS[method])
        turned = run.section_rotation("door")[-1] @ (1, 0, 0)
        angle = np.sin(1.5)
        assert turned == pytest.approx((np.cos(angle), 0, -np.sin(angle)), abs=1e-5)
        assert any("are held by other joints already" in note for note in run.notes)

    @pytest.mark.parametrize("method", METHODS)
    @pytest.mark.parametrize(
        "motion", [{"displacement": ["0.2*t**2", 0, "0.1*t**2"]}, {"rotation": "t**2", "axis": (0, 0.6, 0.8)}]
    )
    def test_one_that_does_not_ends_the_run(self, method, motion):
        """It went on without the hinge. What was computed until then stays."""
        model, _ = driven(motion)
        with pytest.raises(ancf.SolveError, match=r"\"h\d\" is off by 0\.000\d+ (m|rad)") as caught:
            ancf.simulate(model, t_end=0.5, step=1e-3, output_step=5e-3, integrator=METHODS[method])
        assert "a given motion of a support contradicts it" in str(caught.value)
        t = caught.value.result.t
        assert 0.0 < t[-1] < 0.1
        assert f"t = {t[-1]:.6g} s" in str(caught.value)

    @pytest.mark.parametrize("before", [0, 5])
    def test_of_a_run_that_is_led(self, before):
        model, _ = driven({"displacement": ["0.2*t**2", 0, 0]})
        run = ancf.stepper(model, step=2e-3)
        for _ in range(before):
            run.advance()
        with pytest.raises(ancf.SolveError, match="others held that at the start, and no longer do"):
            run.advance(100)
        assert 0.01 < run.t < 0.1  # where it was before the step in which it was seen

    @pytest.mark.parametrize(("time", "works"), [(0.0, True), (1.0, False)])
    def test_of_an_equilibrium(self, time, works):
        model, _ = driven({"displacement": [0, 0, "0.1*t"]})
        if works:
            assert ancf.equilibrium(model, time=time).position("door") == pytest.approx((0, 0, 0))
        else:
            with pytest.raises(ancf.SolveError, match=r"equilibrium at t = 1 s: .* is off by 0\.\d+ (m|rad)"):
                ancf.equilibrium(model, time=time)
