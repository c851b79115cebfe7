"""Ways of prismatic and cylindrical joints, angles of universal ones: against places and rotations."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ancf
from ancf.cosimulation.outputs import outputs_of
from ancf.viz.view.curves import _joints
from ancf.viz.view.histories import Histories

SPACES = {"straight": Rotation.identity(), "turned": Rotation.from_euler("xyz", (0.5, -0.9, 2.0))}
spaces = pytest.mark.parametrize("space", SPACES.values(), ids=SPACES)
ALONG = np.array([0.6, 0.0, 0.8])


def body(model, name, at, space, mass=1.0):
    return model.add_rigid_body(name, at=at, mass=mass, inertia=(0.02, 0.03, 0.04), axes=space.as_matrix())


def slider(space, kind, on, swapped=False):
    """A carriage on a base that swings, or on the ground, driven along an axis; it starts 0.3 m along it."""
    model, axis = ancf.Model(gravity=space.apply((0, 0, -9.81))), space.apply(ALONG)
    base = body(model, "base", (0, 0, 0), space, 3.0)
    model.hinge(base.at(0, 0, 0.2), space.apply((0, 0, 0.2)), axis=space.apply((0, 1, 0)), name="pivot")
    carriage = body(model, "carriage", 0.3 * axis, space)
    ends = carriage.centre, base.at(0, 0, 0) if on == "base" else -0.1 * axis
    getattr(model, kind)(*(ends[::-1] if swapped else ends), axis=2.5 * axis, name="guide")
    model.add_force(carriage, space.apply((3.0, 1.0, 9.0)))
    model.add_moment(carriage, space.apply((0.02, 0.01, 0.03)))
    return model


def turns(known, name, space):
    """Of a body from where it was, (n_t,) rotations."""
    return Rotation.from_matrix(known.section_rotation(name)) * space.inv()


@spaces
@pytest.mark.parametrize("kind", ["prismatic", "cylindrical"])
class TestWays:
    @pytest.mark.parametrize(("on", "swapped"), [("base", False), ("base", True), ("ground", False)])
    def test_of_places_along_the_axis_of_the_second_end(self, space, kind, on, swapped):
        model = slider(space, kind, on, swapped)
        run = ancf.simulate(model, t_end=0.5, step=1e-3, sensors=["guide", "carriage", "base"])
        first, second = ("base", "carriage") if swapped else ("carriage", on)
        for known in (run, run.sensors):
            place = known.position(first) - (known.position(second) if second != "ground" else 0.0)
            rate = known.velocity(first) - (known.velocity(second) if second != "ground" else 0.0)
            spun, axis = np.zeros(3), space.apply(ALONG)
            if second != "ground":
                axis, spun = turns(run, second, space).apply(axis), run.angular_velocity(second)
            way = np.sum(place * axis, axis=-1) - (-0.3 if swapped else 0.3)
            speed = np.sum(rate * axis + place * np.cross(spun, axis), axis=-1)
            assert np.max(np.abs(way)) > 0.1
            assert known.joint_displacement("guide") == pytest.approx(way, abs=1e-9)
            assert known.joint_velocity("guide") == pytest.approx(speed, abs=1e-8)

    def test_the_rate_is_that_of_the_way(self, space, kind):
        run = ancf.simulate(slider(space, kind, "base"), t_end=0.2, step=1e-3)
        way, rate = run.joint_displacement("guide"), run.joint_velocity("guide")
        assert np.gradient(way, run.t)[1:-1] == pytest.approx(rate[1:-1], abs=2e-4 * np.abs(rate).max())


@pytest.mark.parametrize("element", ["original", "nonlocking"])
def test_along_the_end_of_a_bent_beam(element):
    """A ring on the line of a beam's end, whose direction has turned."""
    model = ancf.Model()
    section = ancf.Section.rectangle(width=0.02, height=0.02, E=2e11, rho=7800.0, nu=0.0)
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section, element=element
    )
    model.clamp(beam.start)
    ring = model.add_rigid_body("ring", at=(1.2, 0, 0), mass=1.0, inertia=(0.01, 0.01, 0.01))
    guide = model.prismatic(ring, beam.end, axis=(1, 0, 0))
    model.add_spring(ring, (1.9, 0, 0), stiffness=50.0, length=0.2)
    model.add_force(beam.end, (0, 0, 180.0))
    state = ancf.equilibrium(model)
    axes = state.section_rotation(beam.end)
    assert abs(axes[2, 0]) > 0.02
    wanted = (state.position(ring) - state.position(beam.end)) @ axes[:, 0] - 0.2
    assert abs(wanted) > 0.1
    assert state.joint_displacement(guide) == pytest.approx(wanted, abs=1e-6)


def shafts(space, first=(1, 0, 0), second=(0, 1, 0), on="body", rate=0.0):
    """Two bodies on a universal joint that turn against each other; the second one may be the ground."""
    model = ancf.Model(gravity=space.apply((0, 0, -9.81)))
    upper = body(model, "upper", (0, 0, 0), space, 2.0)
    lower = body(model, "lower", space.apply((0.1, 0.05, -0.4)), space)
    joint = space.apply((0, 0, -0.1))
    if on == "body":
        model.hinge(upper, (0, 0, 0), axis=space.apply((0.3, 0.2, 1.0)), name="pivot")
        upper.set_motion(angular_velocity=space.apply(rate * np.array([0.3, 0.2, 1.0]) / 1.063))
    other = upper.at(0, 0, -0.1) if on == "body" else joint
    hung = lower.at(-0.1, -0.05, 0.3)
    model.universal(hung, other, axis_a=space.apply(first), axis_b=space.apply(second), name="cross")
    model.add_moment(lower, space.apply((3.0, -4.0, 2.0)))
    return model


AXES = [((1, 0, 0), (0, 1, 0)), ((0, 2, 0), (3, 0, 0)), ((0.6, 0, 0.8), (0.8, 0, -0.6))]


@spaces
@pytest.mark.parametrize(("first", "second"), AXES)
@pytest.mark.parametrize("on", ["body", "ground"])
def test_angles_of_a_cross(space, first, second, on):
    """They make the rotation of one body against the other, and its angular velocity."""
    run = ancf.simulate(shafts(space, first, second, on), t_end=0.6, step=1e-3, sensors=["cross"])
    a, b = (space.apply(np.array(x) / np.linalg.norm(x)) for x in (first, second))
    angles, rates = run.joint_angles("cross"), run.joint_rates("cross")
    assert np.all(np.abs(angles).max(axis=0) > 0.2)
    about_a, about_b = (
        Rotation.from_rotvec(np.outer(angle, axis)) for angle, axis in zip(angles.T, (a, b), strict=True)
    )
    base = turns(run, "upper", space) if on == "body" else Rotation.identity()
    wanted = base.inv() * turns(run, "lower", space)
    assert np.max((about_b * about_a * wanted.inv()).magnitude()) < 1e-7
    spun = run.angular_velocity("lower") - (run.angular_velocity("upper") if on == "body" else 0.0)
    turning = base.apply(rates[:, [1]] * b + rates[:, [0]] * about_b.apply(a))
    assert turning == pytest.approx(spun, abs=1e-6)
    np.testing.assert_array_equal(run.sensors.joint_angles("cross"), angles)
    np.testing.assert_array_equal(run.sensors.joint_rates("cross"), rates)
    state = run.state(-1)
    assert state.joint_angles("cross") == pytest.approx(np.angle(np.exp(1j * angles[-1])), abs=1e-12)


def test_full_turns_of_a_cross_are_counted():
    """A shaft that spins about an axis of the cross."""
    model = ancf.Model()
    wheel = model.add_rigid_body("wheel", at=(0, 0, 0), mass=1.0, inertia=(0.3, 0.2, 0.2))
    wheel.set_motion(angular_velocity=(40.0, 0, 0))
    model.universal(wheel, (0, 0, 0), axis_a=(1, 0, 0), axis_b=(0, 1, 0), name="cross")
    run = ancf.simulate(model, t_end=0.4, step=1e-3, output_step=0.02)
    assert run.joint_angles("cross")[:, 0] == pytest.approx(40.0 * run.t, abs=5e-3)
    assert run.joint_angles("cross")[:, 1] == pytest.approx(0.0 * run.t, abs=1e-9)
    assert run.joint_rates("cross")[:, 0] == pytest.approx(40.0 + 0.0 * run.t, rel=1e-3)


def machine():
    """A slider and a cross beside each other, and a weld."""
    model = slider(SPACES["straight"], "prismatic", "ground")
    hung = model.add_rigid_body("hung", at=(2, 0, -0.3), mass=1.0, inertia=(0.02, 0.03, 0.04))
    model.universal(hung.at(0, 0, 0.3), (2, 0, 0), axis_a=(1, 0, 0), axis_b=(0, 1, 0), name="cross")
    tip = model.add_rigid_body("tip", at=(2, 0, -0.5), mass=0.1, inertia=(1e-3, 1e-3, 1e-3))
    model.weld(tip, hung.at(0, 0, -0.2), name="glue")
    model.add_force(hung, (1.0, 2.0, 0.0))
    return model


class TestElsewhere:
    @pytest.fixture(scope="class")
    @staticmethod
    def run():
        return ancf.simulate(machine(), t_end=0.1, step=1e-3, sensors=["guide", "cross"])

    @pytest.mark.parametrize(
        ("name", "words"),
        [("guide", ("joint_displacement", "joint_velocity")), ("cross", ("joint_angles", "joint_rates"))],
    )
    def test_in_a_file(self, run, name, words, tmp_path):
        run.save(tmp_path / "swing.h5")
        again = ancf.load(tmp_path / "swing.h5")
        for known, old in ((again, run), (again.sensors, run.sensors)):
            for word in words:
                np.testing.assert_array_equal(getattr(known, word)(name), getattr(old, word)(name))

    @pytest.mark.parametrize("of", ["result", "sensors"])
    def test_in_tables(self, run, of):
        known = run if of == "result" else run.sensors
        frame = known.to_pandas(["guide", "cross"])
        np.testing.assert_array_equal(frame["guide displacement [m]"], known.joint_displacement("guide"))
        for k in range(2):
            np.testing.assert_array_equal(
                frame[f"cross angle {k + 1} [rad]"], known.joint_angles("cross")[:, k]
            )
        assert not {"glue displacement [m]", "glue angle 1 [rad]"} & set(run.to_pandas().columns)

    @pytest.mark.parametrize(
        ("name", "quantity", "unit"),
        [
            ("guide", "joint_displacement", "m"),
            ("guide", "joint_velocity", "m/s"),
            ("cross", "joint_angles", "rad"),
            ("cross", "joint_rates", "rad/s"),
        ],
    )
    def test_in_pictures(self, run, name, quantity, unit):
        (axes,) = run.plot(name, quantity=quantity).axes
        drawn = np.array([line.get_ydata() for line in axes.lines]).T
        wanted = getattr(run, quantity)(name)
        np.testing.assert_array_equal(drawn, wanted.reshape(len(run.t), -1))
        labels = [line.get_label() for line in axes.lines]
        assert labels == (["cross 1", "cross 2"] if name == "cross" else ["guide"])
        assert axes.get_ylabel().endswith(f"[{unit}]")

    def test_in_the_viewer(self, run):
        found = {c.name: c for c in _joints(Histories(run)) if not c.panel.startswith("joint force")}
        assert {"guide", "cross, 1", "cross, 2"} == found.keys()
        assert (found["guide"].unit, found["cross, 2"].unit) == ("m", "rad")
        assert found["guide"].values == pytest.approx(run.joint_displacement("guide"))
        assert found["cross, 2"].values == pytest.approx(run.joint_angles("cross")[:, 1])

    @pytest.mark.parametrize(
        "text", ["joint_displacement(guide)", "joint_velocity(guide)", "joint_angles(cross)[1]"]
    )
    def test_in_formulas(self, run, text):
        value, _ = ancf.gradient(machine(), f"max(abs({text}))", [], t_end=0.1, step=1e-3)
        word, _, rest = text.partition("(")
        name, _, part = rest.partition(")")
        history = getattr(run, word)(name)
        assert value == pytest.approx(np.max(np.abs(history[:, 1] if part else history)), rel=1e-12)

    def test_as_outputs_of_units(self):
        run = ancf.stepper(machine(), step=1e-3, sensors=["guide", "cross", "glue"])
        run.advance(50)
        found = {out.name: (out.value(run), out.unit) for out in outputs_of(run)}
        assert found["guide.joint_displacement"] == (run.joint_displacement("guide"), "m")
        assert found["guide.joint_velocity"] == (run.joint_velocity("guide"), "m/s")
        assert found["cross.joint_angles[2]"] == (run.joint_angles("cross")[1], "rad")
        assert found["cross.joint_rates[1]"] == (run.joint_rates("cross")[0], "rad/s")
        assert not any(name.startswith(("glue.joint_disp", "glue.joint_ang")) for name in found)

    @pytest.mark.parametrize(
        ("ask", "match"),
        [
            (
                lambda run: run.joint_displacement("glue"),
                "glue: is no prismatic or cylindrical joint.*: guide$",
            ),
            (lambda run: run.joint_velocity(3), "is no prismatic"),
            (lambda run: run.joint_angles("glue"), "glue: is no universal joint here; there are: cross$"),
            (lambda run: run.joint_rates("pivot"), r'joint_angle\("pivot"\) is the one of a hinge'),
            (lambda run: run.joint_angle("cross"), r'joint_angles\("cross"\) has the two'),
            (lambda run: run.joint_angle("guide"), r'joint_displacement\("guide"\) is its way'),
        ],
    )
    def test_what_has_none(self, run, ask, match):
        with pytest.raises(ancf.ModelError, match=match):
            ask(run)

    @pytest.mark.parametrize("ask", ["joint_displacement", "joint_velocity", "joint_angles", "joint_rates"])
    def test_what_was_not_recorded(self, ask):
        run = ancf.simulate(machine(), t_end=0.01, step=1e-3, sensors=["tip"])
        name = "cross" if ask in ("joint_angles", "joint_rates") else "guide"
        with pytest.raises(ancf.ModelError, match="list it in sensors"):
            getattr(run.sensors, ask)(name)
        assert len(getattr(run, ask)(name)) == 11
