"""Equilibria whose supports are turned far: those of the model drawn turned; turns are counted."""

import warnings

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import ancf
from helpers import ELEMENTS, some

G = np.array([0.0, 0.0, -9.81])
AXES = {"level": (0, 1, 0), "oblique": (0.3, 0.8, -0.4)}
ANGLES = [0.4, 1.5, 1.7, 2.4, 3.0, -2.8, 6.0]


def section(element):
    if element == "cable":
        return ancf.Section(EA=6e4, EI=4.7, rhoA=0.24)
    return ancf.Section.rectangle(width=0.03, height=0.01, E=7e9, rho=2700, nu=0.3)


def arm(model, element, turn, way):
    """An arm from the origin along x turned, clamped as ``way`` says; returns it and its clamp's options."""
    end = turn.apply((1.0, 0, 0))
    plane = {} if element == "cable" else {"y_axis": turn.apply((0, 1.0, 0))}
    beam = model.add_beam(
        "arm", start=(0, 0, 0), end=end, section=section(element), elements=8, element=element, **plane
    )
    if way in ("free", "fixed"):
        return beam, beam.start, {"stretch": way}
    given = {"mass": 1.0, "inertia": (0.01, 0.02, 0.03), "axes": turn.as_matrix()}
    hub = model.add_rigid_body("hub", at=(0, 0, 0), **given)
    if way in ("welded", "tool"):
        model.clamp(beam.start, to=hub)
    else:
        knuckle, normal = model.add_rigid_body("knuckle", at=(0, 0, 0), **given), turn.apply((0, 1.0, 0))
        model.hinge(hub, knuckle, axis=normal)
        model.add_torsion_spring(hub, knuckle, axis=normal, stiffness=50.0)
        model.clamp(beam.start, to=knuckle)
    if way == "tool":
        tool = model.add_rigid_body("tool", at=end, **{**given, "mass": 0.1})
        model.clamp(beam.end, to=tool)
    return beam, hub, {}


WAYS = ["free", "fixed", "welded", "tool", "hinged"]


class TestAsDrawnTurned:
    @pytest.mark.parametrize("angle", some(ANGLES))
    @pytest.mark.parametrize("axis", AXES)
    @pytest.mark.parametrize("element", ELEMENTS)
    @pytest.mark.parametrize("way", WAYS)
    def test_same_shape(self, way, element, axis, angle):
        direction = np.array(AXES[axis]) / np.linalg.norm(AXES[axis])
        turn = Rotation.from_rotvec(angle * direction)
        turned, drawn = ancf.Model(gravity=G), ancf.Model(gravity=G)
        beam, point, options = arm(turned, element, Rotation.identity(), way)
        as_vector = {"rotation_vector": angle * direction}
        as_angle = {"rotation": angle, "axis": direction}
        turned.clamp(point, **(as_vector if way == "welded" else as_angle), **options)
        other, point, options = arm(drawn, element, turn, way)
        drawn.clamp(point, **options)
        found, wanted = ancf.equilibrium(turned), ancf.equilibrium(drawn)
        for x in (0.01, 0.3, 0.7, 1.0):
            assert found.position(beam.at(x)) == pytest.approx(wanted.position(other.at(x)), abs=1e-8)
        assert found.energy.strain == pytest.approx(wanted.energy.strain, rel=1e-6, abs=1e-9)

    @pytest.mark.parametrize("angle", [1.7, 3.0, 5.5])
    @pytest.mark.parametrize("element", ELEMENTS)
    def test_carried_on_an_arc(self, element, angle):
        """A hub that goes round a place as it turns, as the hand of a robot does."""
        turn, place = Rotation.from_rotvec((0, angle, 0)), np.array([-2.0, 0, 0])
        turned, drawn = ancf.Model(gravity=G), ancf.Model(gravity=G)
        beam, point, options = arm(turned, element, Rotation.identity(), "welded")
        moved = place + turn.apply(-place)
        turned.clamp(point, rotation=angle, axis=(0, 1, 0), displacement=moved, **options)
        other, point, options = arm(drawn, element, turn, "welded")
        drawn.clamp(point, **options)
        found, wanted = ancf.equilibrium(turned), ancf.equilibrium(drawn)
        ends = found.position(beam.end) - moved, wanted.position(other.end)
        assert ends[0] == pytest.approx(ends[1], abs=1e-8)


class TestTurnsAreCounted:
    @pytest.mark.parametrize("angle", [1.0, 3.0, 3.3, 4.0, 7.0, -20.0])
    @pytest.mark.parametrize("element", ["original", "nonlocking"])
    def test_twist(self, element, angle):
        """Half of the twist in the middle, however often the end went round."""
        model = ancf.Model()
        size = ancf.Section.rectangle(width=0.02, height=0.02, E=7e10, rho=2700, nu=0.3)
        bar = model.add_beam(
            "bar", start=(0, 0, 0), end=(1, 0, 0), section=size, elements=24, element=element
        )
        model.clamp(bar.start)
        model.clamp(bar.end, rotation=angle, axis=(1, 0, 0))
        state = ancf.equilibrium(model)
        assert state.twist(bar.at(0.5)) == pytest.approx(0.5 * angle, rel=1e-6)

    @pytest.mark.parametrize("angle", [1.0, 3.0, 3.3, 4.0, 7.0, -20.0])
    @pytest.mark.parametrize("vector", [True, False])
    def test_torsion_spring(self, tmp_path, vector, angle):
        """k angle^2 / 2; in a run from there, and seen from the other body, the same."""
        model = ancf.Model()
        given = {"mass": 1.0, "inertia": (0.1, 0.1, 0.1)}
        hub, base = (model.add_rigid_body(n, at=(0, 0, z), **given) for n, z in (("hub", 0), ("base", -1)))
        model.clamp(base)
        turned = {"rotation_vector": (0, 0, angle)} if vector else {"rotation": angle, "axis": (0, 0, 1)}
        model.clamp(hub, **turned)
        model.add_torsion_spring(hub, base, axis=(0, 0, 1), stiffness=2.0)
        model.add_torsion_spring(base, hub, axis=(0, 0, 1), stiffness=1.0)
        state = ancf.equilibrium(model)
        assert state.energy.strain == pytest.approx(1.5 * angle**2, rel=1e-9)
        first, second = model.connections
        run = ancf.simulate(
            model, t_end=0.01, step=1e-3, start=state, sensors=[first, second], file=tmp_path / "r.h5"
        )
        assert run.energy.strain[-1] == pytest.approx(1.5 * angle**2, rel=1e-9)
        seen = []
        held = ancf.simulate(
            model,
            t_end=3e-3,
            step=1e-3,
            start=state,
            controller=lambda live: seen.append(live.torsion_moment(first)),
        )
        known = (state, run, run.sensors, run.state(-1), held, ancf.load(tmp_path / "r.h5"))
        for one in known:
            assert np.ravel(one.torsion_angle(first)) == pytest.approx(angle, rel=1e-9)
            assert np.ravel(one.torsion_moment(first)) == pytest.approx(2.0 * angle, rel=1e-9)
            assert np.ravel(one.torsion_moment(second)) == pytest.approx(-1.0 * angle, rel=1e-9)
        assert seen == pytest.approx([2.0 * angle] * len(seen), rel=1e-9)


class TestElsewhereThanTheStart:
    """A run whose supports are not where its start has what they hold says so."""

    @staticmethod
    def said(model, start=None):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            result = ancf.simulate(model, t_end=2e-5, step=1e-5, start=start)
        heard = [str(w.message) for w in caught if "at the start of the run" in str(w.message)]
        return heard, [note for note in result.notes if "at the start of the run" in note]

    @staticmethod
    def model(element, **moved):
        model = ancf.Model(gravity=G)
        beam, _, _ = arm(model, element, Rotation.identity(), "free")
        model.clamp(beam.start, **moved)
        return model

    @pytest.mark.parametrize("element", ELEMENTS)
    @pytest.mark.parametrize(
        ("moved", "far"),
        [
            ({"displacement": (0, 0, 0.01)}, "0.01 m away"),
            ({"displacement": ("0.01*cos(t)", 0, 0)}, "0.01 m away"),
            ({"rotation": 0.2, "axis": (0, 1, 0)}, "turned by 0.2"),
            ({"rotation": "0.2*cos(t)", "axis": (0, 1, 0), "stretch": "fixed"}, "turned by 0.2"),
            ({"rotation_vector": (0, 0, -0.2)}, "turned by 0.2"),
        ],
    )
    def test_from_the_initial_shape(self, moved, far, element):
        model = self.model(element, **moved)
        heard, noted = self.said(model)
        assert len(heard) == 1
        assert heard == noted
        assert heard[0].startswith('"clamp at arm.start" is ' + far)
        assert "from the initial shape" in heard[0]
        assert self.said(model, ancf.equilibrium(model)) == ([], [])

    @pytest.mark.parametrize("element", ELEMENTS)
    def test_small_ones_are_noted_and_none_is_silent(self, element):
        heard, noted = self.said(self.model(element, displacement=(0, 0, 1e-5)))
        assert not heard
        assert len(noted) == 1
        assert self.said(self.model(element, displacement=(0, 0, "1e-3*t"))) == ([], [])

    def test_of_a_body_that_carries_a_cable_and_of_one_that_carries_nothing(self):
        model = ancf.Model(gravity=G)
        _, hub, _ = arm(model, "cable", Rotation.identity(), "welded")
        model.clamp(hub, rotation=0.1, axis=(0, 0, 1))
        alone = model.add_rigid_body("alone", at=(0, 3, 0), mass=1.0, inertia=(1, 1, 1))
        model.clamp(alone, displacement=(0, 0, 0.1))
        heard, _ = self.said(model)
        assert [text.split('"')[1] for text in heard] == ["clamp at hub.centre"]

    def test_from_the_equilibrium_of_another_time(self):
        model = self.model("cable", displacement=(0, 0, "0.01*t"))
        early = ancf.equilibrium(model, time=0.0)
        other = self.model("cable", displacement=(0, 0, "0.01*t + 0.02"))
        heard, _ = self.said(other, early)
        assert len(heard) == 1
        assert "0.02 m away from the given start" in heard[0]
