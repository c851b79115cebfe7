"""Angles of joints: against closed forms, against matrices of rotation, and where else they are answered."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ancf
from ancf.cosimulation.outputs import outputs_of
from ancf.viz.view.curves import _joints
from ancf.viz.view.histories import Histories

SPACES = {"straight": Rotation.identity(), "turned": Rotation.from_euler("xyz", (0.5, -0.9, 2.0))}
GIVEN = {"t_end": 0.4, "step": 1e-3, "output_step": 0.02}
KINDS = ("hinge", "cylindrical", "planar")


def wheels(space, kind, swapped=False):
    """A wheel that spins on the ground, and one beside it: 40 and -25 rad/s about one axis."""
    model, axis = ancf.Model(), space.apply((0, 0, 1))
    given = {"mass": 1.0, "inertia": (0.2, 0.2, 0.3), "axes": space.as_matrix()}
    first = model.add_rigid_body("first", at=(0, 0, 0), **given)
    second = model.add_rigid_body("second", at=(0, 0, 0), **given)
    for body, rate in ((first, 40.0), (second, -25.0)):
        body.set_motion(angular_velocity=rate * axis)
    model.hinge(first, (0, 0, 0), axis=2.0 * axis, name="ground")
    ends = (second, first) if swapped else (first, second)
    getattr(model, kind)(*ends, axis=axis, name="between")
    return model


@pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
@pytest.mark.parametrize("kind", KINDS)
class TestSpins:
    @pytest.mark.parametrize("swapped", [False, True])
    def test_goes_round_many_times(self, space, kind, swapped):
        """What turns without moments keeps its rate: theta = omega t, of bodies theta_a - theta_b."""
        run = ancf.simulate(wheels(space, kind, swapped), **GIVEN, sensors=["ground", "between"])
        sign = -1.0 if swapped else 1.0
        for known in (run, run.sensors):
            assert known.joint_angle("ground") == pytest.approx(40.0 * known.t, abs=5e-3)
            assert known.joint_angle("between") == pytest.approx(sign * 65.0 * known.t, abs=8e-3)
            assert known.joint_rate("between") == pytest.approx(np.full(len(known.t), sign * 65.0), rel=1e-3)

    def test_a_state_is_within_half_a_turn(self, space, kind):
        """Of a stepper and of what it gives, too."""
        run = ancf.stepper(wheels(space, kind), step=1e-3, sensors=["between"])
        for steps in (20, 60, 77):
            run.advance(steps)
            wanted = np.angle(np.exp(65j * run.t))
            assert run.joint_angle("between") == pytest.approx(wanted, abs=8e-3)
            assert run.state().joint_angle("between") == run.joint_angle("between")
            assert run.sensors.joint_angle("between")[-1] == pytest.approx(65.0 * run.t, abs=8e-3)


class TestAgainstMatrices:
    @pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
    def test_a_double_pendulum(self, space):
        """Angles about the axis of the rotations that take the bodies from where they were."""
        axis, out = space.apply((0, 1, 0)), space.apply((1, 0, 0))
        model = ancf.Model(gravity=space.apply((0, 0, -9.81)))
        bodies = [
            model.add_rigid_body(
                name, at=(k + 0.5) * out, mass=1.0, inertia=(0.01, 0.1, 0.1), axes=space.as_matrix()
            )
            for k, name in enumerate(("upper", "lower"))
        ]
        model.hinge(bodies[0].at(-0.5, 0, 0), (0, 0, 0), axis=axis, name="shoulder")
        model.hinge(bodies[1].at(-0.5, 0, 0), bodies[0].at(0.5, 0, 0), axis=axis, name="elbow")
        run = ancf.simulate(model, t_end=2.0, step=1e-3)
        turned = [Rotation.from_matrix(run.section_rotation(body)) for body in bodies]
        first = (turned[0] * space.inv()).as_rotvec() @ axis
        second = (turned[1] * turned[0].inv()).as_rotvec() @ axis
        assert np.max(np.abs(second)) > 1.0
        assert run.joint_angle("shoulder") == pytest.approx(np.unwrap(first), abs=1e-7)
        assert run.joint_angle("elbow") == pytest.approx(np.unwrap(second), abs=1e-7)
        rates = [run.angular_velocity(body) @ axis for body in bodies]
        assert run.joint_rate("shoulder") == pytest.approx(rates[0], abs=1e-6)
        assert run.joint_rate("elbow") == pytest.approx(rates[1] - rates[0], abs=1e-6)

    @pytest.mark.parametrize("element", ["original", "nonlocking"])
    @pytest.mark.parametrize("axis", [(0, 1, 0), (0, 0, 1), (0, -3, 0)])
    def test_a_hinge_at_the_end_of_a_bent_beam(self, element, axis):
        """F L^2/(2 EI) of a cantilever, which a body on its end that cannot turn sees as minus its angle."""
        model = ancf.Model()
        section = ancf.Section.rectangle(width=0.02, height=0.02, E=2e11, rho=7800.0, nu=0.0)
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section, element=element
        )
        unit = np.array(axis) / np.linalg.norm(axis)
        model.clamp(beam.start)
        plate = model.add_rigid_body("plate", at=(1, 0, 0), mass=1.0, inertia=(1.0, 1.0, 1.0))
        model.hinge(plate, beam.end, axis=axis, name="end")
        model.add_torsion_spring(plate, (1, 0, 0), axis=axis, stiffness=1e3)
        model.add_force(beam.end, 10.0 * np.cross(unit, (1, 0, 0)))
        state = ancf.equilibrium(model)
        bent = 10.0 / (2.0 * section.EI_y)
        assert state.joint_angle("end") == pytest.approx(-bent, rel=0.02)
        axes = state.section_rotation(beam.end)
        slope = np.arctan2(axes[:, 0] @ np.cross(unit, (1, 0, 0)), axes[0, 0])
        assert state.joint_angle("end") == pytest.approx(-slope, rel=0.02)

    def test_a_cable_on_a_hinged_body(self):
        """A cable has no axes: it is clamped to a body, whose hinge has the angle of its end."""
        model = ancf.Model()
        wire = model.add_beam(
            "wire", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=ancf.Section(EA=1e5, EI=5.0, rhoA=0.1)
        )
        knuckle = model.add_rigid_body("knuckle", at=(1, 0, 0), mass=0.1, inertia=(1e-3, 1e-3, 1e-3))
        model.clamp(wire.start)
        model.clamp(wire.end, to=knuckle)
        model.hinge(knuckle, (1, 0, 0), axis=(0, 1, 0), name="encoder")
        model.add_moment(knuckle, (0, 0.02, 0))
        state = ancf.equilibrium(model)
        assert state.joint_angle("encoder") == pytest.approx(0.02 / (4.0 * 5.0), rel=1e-4)  # M L/(4 EI)


def pendulum():
    """A rod on a hinge that swings, beside a weld and a torsion spring."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    rod = model.add_rigid_body("rod", at=(0.5, 0, 0), mass=1.0, inertia=(0.01, 0.1, 0.1))
    tip = model.add_rigid_body("tip", at=(1, 0, 0), mass=0.1, inertia=(1e-3, 1e-3, 1e-3))
    model.hinge(rod.at(-0.5, 0, 0), (0, 0, 0), axis=(0, 1, 0), name="pivot")
    model.weld(rod.at(0.5, 0, 0), tip.centre, name="glue")
    model.add_torsion_spring(rod, (0.5, 0, 0), axis=(0, 1, 0), stiffness=1.0, name="coil")
    return model


class TestElsewhere:
    @pytest.fixture(scope="class")
    @staticmethod
    def run():
        return ancf.simulate(pendulum(), t_end=0.1, step=1e-3, sensors=["pivot", "coil"])

    def test_is_the_angle_of_a_spring_in_its_place(self, run):
        assert run.joint_angle("pivot") == pytest.approx(run.torsion_angle("coil"), abs=1e-12)
        assert run.joint_angle("pivot")[-1] > 0.05

    def test_in_a_file(self, run, tmp_path):
        run.save(tmp_path / "swing.h5")
        again = ancf.load(tmp_path / "swing.h5")
        for known, old in ((again, run), (again.sensors, run.sensors)):
            np.testing.assert_array_equal(known.joint_angle("pivot"), old.joint_angle("pivot"))

    @pytest.mark.parametrize("of", ["result", "sensors"])
    def test_in_tables(self, run, of):
        known = run if of == "result" else run.sensors
        frame = known.to_pandas(["pivot"])
        np.testing.assert_array_equal(frame["pivot angle [rad]"], known.joint_angle("pivot"))
        assert "glue angle [rad]" not in run.to_pandas().columns

    @pytest.mark.parametrize(("quantity", "unit"), [("joint_angle", "rad"), ("joint_rate", "rad/s")])
    def test_in_pictures(self, run, quantity, unit):
        (axes,) = run.plot("pivot", quantity=quantity).axes
        np.testing.assert_array_equal(axes.lines[0].get_ydata(), getattr(run, quantity)("pivot"))
        assert axes.get_ylabel().endswith(f"[{unit}]")

    def test_in_the_viewer(self, run):
        (curve,) = (c for c in _joints(Histories(run)) if c.panel.startswith("joint angle"))
        assert (curve.name, curve.unit) == ("pivot", "rad")
        assert curve.values == pytest.approx(run.joint_angle("pivot"))

    def test_in_formulas(self, run):
        value, _ = ancf.gradient(pendulum(), "max(abs(joint_angle(pivot)))", [], t_end=0.1, step=1e-3)
        assert value == pytest.approx(np.max(run.joint_angle("pivot")), rel=1e-12)

    def test_as_outputs_of_units(self):
        run = ancf.stepper(pendulum(), step=1e-3, sensors=["pivot", "glue"])
        run.advance(50)
        found = {out.name: (out.value(run), out.unit) for out in outputs_of(run)}
        assert found["pivot.joint_angle"] == (run.joint_angle("pivot"), "rad")
        assert found["pivot.joint_rate"] == (run.joint_rate("pivot"), "rad/s")
        assert "glue.joint_moment.x" in found
        assert "glue.joint_angle" not in found

    @pytest.mark.parametrize(
        ("ask", "match"),
        [
            (lambda run: run.joint_angle("glue"), r"glue: is no hinge.*there are: pivot$"),
            (lambda run: run.joint_angle(3), "is no hinge"),
            (lambda run: run.joint_rate("pivo"), "there are: pivot"),
            (lambda run: run.joint_angle("coil"), r'torsion_angle\("coil"\)'),
            (lambda run: run.torsion_angle("pivot"), r'joint_angle\("pivot"\)'),
        ],
    )
    def test_what_has_none(self, run, ask, match):
        with pytest.raises(ancf.ModelError, match=match):
            ask(run)

    def test_what_was_not_recorded(self):
        run = ancf.simulate(pendulum(), t_end=0.01, step=1e-3, sensors=["tip"])
        with pytest.raises(ancf.ModelError, match="list it in sensors"):
            run.sensors.joint_angle("pivot")
        assert run.joint_angle("pivot").shape == (11,)
