"""Moments of supports and joints: balance with loads, changes of angular momentum, work, bad questions."""

import tomllib
from typing import ClassVar

import numpy as np
import pytest

import ancf
from ancf.design.cases import ModelCase
from ancf.errors import ModelError
from ancf.model.file import parse_study
from helpers import square

G = 9.81
WIRE = {"EA": 1e5, "EI": 20.0, "rhoA": 0.8}


def about(place, points, forces):
    return sum(np.cross(np.subtract(p, place), f) for p, f in zip(points, forces, strict=True))


class TestAtRest:
    @pytest.mark.parametrize("element", ["cable", "nonlocking"])
    def test_a_clamp_carries_all_loads(self, element):
        """Moments of weight and force about the wall, wherever the beam has bent to."""
        model = ancf.Model(gravity=(0, 0, -G))
        beam = model.add_beam(
            "beam",
            start=(0.2, 0.1, 0),
            end=(1.2, 0.4, 0),
            elements=6,
            element=element,
            section=square(element, **WIRE),
        )
        wall = model.clamp(beam.start)
        model.add_force(beam.end, (1.0, -3.0, 0.5))
        state = ancf.equilibrium(model)
        x = np.linspace(0, beam.length, 2001)
        places = np.array([state.position(beam.at(float(s))) for s in x])
        middle = np.trapezoid(places, x, axis=0) / beam.length
        weight = np.array([0, 0, -G * 0.8 * beam.length])
        loads = about((0.2, 0.1, 0), (middle, state.position(beam.end)), (weight, (1.0, -3.0, 0.5)))
        assert state.reaction_moment(wall) == pytest.approx(-loads, abs=2e-6)
        assert np.linalg.norm(loads) > 1.0

    def test_a_pin_has_none(self):
        model = ancf.Model(gravity=(0, 0, -G))
        beam = model.add_beam(
            "wire", start=(0, 0, 0), end=(3, 0, 0), elements=6, section=ancf.Section(**WIRE)
        )
        ends = model.pin(beam.start), model.pin(beam.end)
        state = ancf.equilibrium(model)
        assert state.reaction_moment(ends[0]) == pytest.approx([0, 0, 0], abs=1e-9)

    def test_a_torque(self):
        """What a shaft is twisted by, its wall takes up."""
        model = ancf.Model()
        section = ancf.Section.rectangle(0.02, 0.02, E=1e9, rho=1000.0, nu=0.3)
        bar = model.add_beam(
            "bar", start=(0, 0, 0), end=(0, 1, 1), elements=4, section=section, element="nonlocking"
        )
        wall = model.clamp(bar.start)
        torque = 0.2 * np.array([0, 1, 1]) / np.sqrt(2)
        model.add_moment(bar.end, torque)
        assert ancf.equilibrium(model).reaction_moment(wall) == pytest.approx(-torque, abs=1e-8)

    @pytest.mark.parametrize("frame", [0, 1])
    def test_a_weld(self, frame):
        """Its moment on the second body is that of the loads beyond it, and its multipliers say the same."""
        model = ancf.Model(gravity=(0, 0, -G))
        one = model.add_rigid_body("one", at=(0, 0, 0), mass=1.0, inertia=(0.1, 0.2, 0.3))
        two = model.add_rigid_body("two", at=(1, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.3))
        base = model.clamp((one, two)[frame])
        weld = model.weld(one.at(0.5, 0, 0), two.at(-0.5, 0, 0))
        far, place = ((two, 1.0), (one, 0.0))[frame]
        model.add_force(far.at(0, 0, 0.3), (1.0, 2.0, 3.0))
        state = ancf.equilibrium(model)
        forces = ((1.0, 2.0, 3.0), (0, 0, -far.mass * G))
        points = ((place, 0, 0.3), (place, 0, 0))
        loads = about((0.5, 0, 0), points, forces)
        sign = (-1.0, 1.0)[frame]  # the second body carries the first one, or is carried
        assert state.joint_moment(weld) == pytest.approx(sign * loads, abs=1e-7)
        force = state.multiplier(weld)
        assert force[:3] == pytest.approx(sign * np.sum(forces, axis=0), abs=1e-7)
        assert [-force[5], force[4], -force[3]] == pytest.approx(state.joint_moment(weld), abs=1e-7)
        centre = (float(frame), 0, 0)
        own = np.zeros(3)  # its own weight has no arm about its centre
        wanted = -about(centre, points, forces) + own
        assert state.reaction_moment(base) == pytest.approx(wanted, abs=1e-7)

    def test_a_hinge_to_the_ground(self):
        """The ground receives the moment of the weight across the axis, and none about it."""
        model = ancf.Model(gravity=(0, 0, -G))
        body = model.add_rigid_body("body", at=(1, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.3))
        hinge = model.hinge(body.at(-1, 0, 0), (0, 0, 0), axis=(1, 0, 0))
        assert ancf.equilibrium(model).joint_moment(hinge) == pytest.approx([0, 2.0 * G, 0], abs=1e-8)


class TestInMotion:
    def test_a_motor(self):
        """Euler: the moment of a motor is the rate of the angular momentum; its work is what is supplied."""
        model = ancf.Model()
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.3))
        arm = model.add_beam(
            "arm",
            start=(0.1, 0, 0),
            end=(1, 0, 0),
            elements=4,
            section=ancf.Section(EA=1e6, EI=10.0, rhoA=1.0),
        )
        root = model.clamp(arm.start, to=hub)
        motor = model.clamp(hub, rotation=lambda t: 2 * t * t, axis=(0, 0, 1))
        run = ancf.simulate(model, t_end=0.5, step=5e-4)
        moment = run.reaction_moment(motor)
        assert moment.shape == (len(run.t), 3)
        work = np.trapezoid(moment[:, 2] * 4 * run.t, run.t)
        assert work == pytest.approx(run.energy.supplied[-1], rel=1e-4)
        # of the hub alone: what the beam gives it, and its own inertia of 0.3 kg m^2 at 4 rad/s^2
        received = run.joint_moment(root) + np.cross(run.position(arm.start), run.multiplier(root)[:, :3])
        assert (moment + received)[5:, 2] == pytest.approx(np.full(len(run.t) - 5, 1.2), abs=1e-4)
        assert run.state(-1).reaction_moment("clamp at hub.centre") == pytest.approx(moment[-1], abs=1e-6)

    def test_gyroscopic(self):
        """A disc that turns about an axis between its own: M = w x I w."""
        model = ancf.Model()
        disc = model.add_rigid_body("disc", at=(0, 0, 0), mass=1.0, inertia=(0.1, 0.1, 0.2))
        w = np.array([3.0, 0.0, 4.0])
        held = model.clamp(disc, rotation=lambda t: 5.0 * t, axis=w)
        run = ancf.simulate(model, t_end=0.1, step=1e-3)
        inertia = np.diag((0.1, 0.1, 0.2))
        wanted = np.cross(w, inertia @ w)
        assert run.reaction_moment(held)[0] == pytest.approx(wanted, abs=1e-6)
        assert np.linalg.norm(wanted) == pytest.approx(1.2)
        assert np.linalg.norm(run.reaction_moment(held), axis=1) == pytest.approx(1.2, abs=1e-5)


class TestRecorded:
    """Sensors have what the result has, at every step, also of files and of runs that stop and go on."""

    SPUN = "2*t**2 + 0.3*sin(20*t)"

    def model(self, elements, element):
        model = ancf.Model(gravity=(0, 0, -G))
        hub = model.add_rigid_body("hub", at=(0, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.3))
        bar = ancf.Section.circle(diameter=0.04, E=2e9, rho=800.0)
        arm = model.add_beam(
            "arm", start=(0.1, 0, 0), end=(1, 0, 0), elements=elements, section=bar, element=element
        )
        model.clamp(arm.start, to=hub, name="root")
        model.clamp(hub, rotation=self.SPUN, axis=(0, 0.6, 0.8), name="motor")
        tip = model.add_rigid_body("tip", at=(1.2, 0, 0), mass=0.5, inertia=(0.01, 0.02, 0.01))
        if element == "cable":
            model.clamp(arm.end, to=tip, name="end")
        else:
            model.hinge(arm.end, tip.at(-0.2, 0, 0), axis=(0, 1, 0), name="end")
        post = model.add_beam("post", start=(0, 3, 0), end=(0, 3, 1), elements=2, section=bar)
        model.clamp(post.start, stretch="fixed", name="wall")
        model.add_force(post.end, ["3*sin(30*t)", 1.0, 0])
        return model

    @pytest.mark.parametrize(("elements", "element"), [(1, "cable"), (3, "cable"), (2, "nonlocking")])
    @pytest.mark.parametrize("output_step", [None, 4e-3])
    def test_as_the_result_has_it(self, elements, element, output_step, tmp_path):
        """The results' answers are held to closed forms above."""
        names = ["motor", "root", "end", "wall"]
        made = self.model(elements, element)
        calm = ancf.GeneralizedAlpha(rho_inf=0.9)
        run = ancf.simulate(
            made, t_end=0.04, step=1e-3, sensors=names, output_step=output_step, integrator=calm
        )
        run.save(tmp_path / "run.h5")
        stored = np.searchsorted(run.sensors.t, np.asarray(run.t) - 1e-9)
        for ask, name in [("reaction_moment", n) for n in ("motor", "wall")] + [
            ("joint_moment", n) for n in ("root", "end")
        ]:
            whole, sensed = getattr(run, ask)(name), getattr(run.sensors, ask)(name)
            assert sensed.shape == (41, 3)
            size = np.abs(whole).max()
            assert size > 0.05
            # accelerations of the steps of generalised-alpha are those of another time by a part of a step
            assert sensed[stored][2:] == pytest.approx(whole[2:], abs=2e-3 * size)
            again = getattr(ancf.load(tmp_path / "run.h5").sensors, ask)(name)
            assert again == pytest.approx(sensed, abs=1e-9)

    @pytest.mark.parametrize("moment", [0.5, 20.0])
    def test_a_wall_takes_what_bends_the_cable(self, moment):
        """At rest M of the load, at every step."""
        model = ancf.Model()
        rod = model.add_beam("rod", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=ancf.Section(**WIRE))
        model.clamp(rod.start, name="wall")
        model.add_moment(rod.end, (0, moment, 0))
        start = ancf.equilibrium(model)
        run = ancf.simulate(model, t_end=0.01, step=1e-3, start=start, sensors=["wall"], output_step=0.01)
        assert run.sensors.reaction_moment("wall") == pytest.approx(
            np.tile([0, -moment, 0], (11, 1)), abs=1e-4
        )

    FILE = """
gravity = [0, 0, -9.81]
simulation = {{ t_end = 0.02, step = 1e-3 }}
[[bodies]]
type = "rigid_body"
name = "hub"
at = [0, 0, 0]
mass = 2.0
inertia = [0.1, 0.2, 0.3]
[[bodies]]
name = "arm"
start = [0.1, 0, 0]
end = [1, 0, 0]
elements = {elements}
section = {{ EA = 1e5, EI = 20.0, rhoA = 0.8 }}
[[supports]]
type = "clamp"
point = "hub"
name = "motor"
rotation = "20*t**2"
axis = [0, 1, 0]
[[connections]]
type = "fixation"
point = "arm.start"
to = "hub"
name = "root"
"""

    @pytest.mark.parametrize("elements", [1, 3])
    @pytest.mark.parametrize(("formula", "ask"), [("reaction_moment", "motor"), ("joint_moment", "root")])
    def test_outputs_of_studies(self, formula, ask, elements):
        """Named outputs are formulas of it."""
        text = self.FILE.format(elements=elements)
        run = ancf.simulate(parse_study(tomllib.loads(text), "m").model, t_end=0.02, step=1e-3)
        wanted = np.abs(getattr(run, formula)(ask)[:, 1]).max()
        case = ModelCase(tomllib.loads(text), (("peak", f'max(abs({formula}("{ask}")[1]))'),), {})
        case.check({})
        assert case()["peak"] == pytest.approx(wanted, rel=1e-4)


@pytest.fixture(scope="module")
def run():
    model = ancf.Model(gravity=(0, 0, -G))
    one = model.add_rigid_body("one", at=(0, 0, 0), mass=1.0, inertia=(0.1, 0.2, 0.3))
    two = model.add_rigid_body("two", at=(1, 0, 0), mass=2.0, inertia=(0.1, 0.2, 0.3))
    model.clamp(one, name="wall")
    model.weld(one.at(0.5, 0, 0), two.at(-0.5, 0, 0), name="weld")
    wire = model.add_beam("wire", start=(0, 2, 0), end=(1, 2, 0), elements=2, section=ancf.Section(**WIRE))
    model.clamp(wire.start)
    bead = model.add_point_mass("bead", at=(0.5, 2, 0), mass=0.1)
    model.slide(bead, along=wire, name="slide")
    return ancf.simulate(model, t_end=0.01, step=1e-3, sensors=["wall", "weld", "slide"])


class TestAsked:
    def test_plots(self, run):
        pytest.importorskip("matplotlib")
        assert run.plot("wall", quantity="reaction_moment").axes[0].get_ylabel() == "reaction moment [N m]"
        assert run.plot(run.model.supports[0]).axes[0].get_ylabel() == "reaction [N]"
        weld = run.plot("weld")
        assert [axes.get_ylabel() for axes in weld.axes] == [
            "force of the joint [N]",
            "moment of the joint [N m]",
        ]
        assert [line.get_label() for line in weld.axes[1].lines] == ["weld x", "weld y", "weld z"]
        drawn = weld.axes[1].lines[1].get_ydata()
        assert drawn == pytest.approx(run.joint_moment("weld")[:, 1])
        recorded = run.sensors.plot("weld")
        assert recorded.axes[1].lines[1].get_ydata() == pytest.approx(drawn, abs=1e-12)
        assert run.sensors.plot("wall").axes[0].get_ylabel() == "reaction [N]"
        assert run.plot("slide", quantity="normal_force").axes[0].get_ylabel() == "normal force [N]"
        assert run.plot("slide", quantity="sliding_friction").axes[0].get_ylabel() == "sliding friction [N]"

    def test_what_the_sensors_have_not(self, run):
        with pytest.raises(ModelError, match="the sensors have not recorded") as caught:
            run.sensors.normal_force("slide")
        assert "ask the result itself" in caught.value.hint
        with pytest.raises(ModelError, match=r"wire\.start: is no support that the sensors have recorded"):
            run.sensors.reaction_moment("clamp at wire.start")
        with pytest.raises(ModelError, match="slide: is no joint with a moment here"):
            run.sensors.joint_moment("slide")

    def test_bad_questions(self, run):
        with pytest.raises(ModelError, match="unknown support 'wal'"):
            run.reaction_moment("wal")
        with pytest.raises(ModelError, match="slide: is no joint with a moment here; there are: weld"):
            run.joint_moment("slide")
        with pytest.raises(ModelError, match='"torque" is not asked of a support'):
            run.plot("wall", quantity="torque")

    def test_all_quantities_are_listed(self, run):
        with pytest.raises(ModelError, match=r'must be one of "position".*"energy"') as caught:
            run.plot("wall", quantity="x")
        assert "more" not in caught.value.what


class TestBeginsToMove:
    """An equilibrium is one whatever the given motions of supports do next."""

    MOTIONS: ClassVar[dict[str, dict[str, object]]] = {
        "turns": {"rotation": "2*t**2", "axis": (0, 0.6, 0.8)},
        "moves": {"displacement": ["0.1*(1 - cos(9*t))", 0, "t**2"]},
        "turns by a vector": {"rotation_vector": ["3*t**2", 0, "t**2"]},
    }

    @pytest.mark.parametrize("motion", MOTIONS)
    @pytest.mark.parametrize("element", ["cable", "nonlocking"])
    def test_as_without_the_motion(self, element, motion):
        found = []
        for given in ({}, self.MOTIONS[motion]):
            model = ancf.Model(gravity=(0.3, -0.8, -9.7))
            section = square(element, EA=3e3, EI=4.0, rhoA=0.7)
            beam = model.add_beam(
                "beam", start=(0, 0, 0), end=(0.8, 0.2, 0), elements=3, section=section, element=element
            )
            wall = model.clamp(beam.start, **given)
            model.add_force(beam.end, (0.2, 0.5, 0.1))
            state = ancf.equilibrium(model)
            found.append((state.reaction(wall), state.reaction_moment(wall)))
        for asked in zip(*found, strict=True):
            assert asked[1] == pytest.approx(asked[0], rel=1e-9, abs=1e-9)
