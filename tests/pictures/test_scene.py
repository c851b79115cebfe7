"""What is drawn is what the result says, at the times and places that it says."""

from functools import cache

import numpy as np
import pytest

import ancf
from ancf.model.bodies.beam import Beam
from ancf.system.system import System
from ancf.viz.scene import QUANTITIES, looks
from ancf.viz.scene.combs import fastest
from ancf.viz.scene.compose import FAR, chosen_times, make_scene
from ancf.viz.scene.sampling import FINEST, corners, places

CABLE = ancf.Section(EA=1e4, EI=0.01, rhoA=0.1)
SQUARE = ancf.Section.rectangle(width=0.02, height=0.05, E=2e9, rho=1200.0, nu=0.3)


def swing():
    """A cable between a pin and a mass on a slack spring, and a bar with a hub at its end."""
    model = ancf.Model(gravity=(0, 0, -9.81), title="Swing")
    wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=CABLE)
    model.pin(wire.start)
    bob = model.add_point_mass("bob", at=(2, 0, 0), mass=0.5)
    model.connect(bob, wire.end)
    model.add_spring(bob, (2.0, 0.0, 0.5), stiffness=50.0, length=0.6, slack=True, name="tie")
    bar = model.add_beam(
        "bar", start=(0, 1, 0), end=(1, 1, 0), elements=2, section=SQUARE, element="nonlocking"
    )
    model.clamp(bar.start)
    hub = model.add_rigid_body("hub", at=(1, 1, 0), mass=0.2, inertia=(1e-3, 2e-3, 2e-3))
    model.clamp(bar.end, to=hub)
    return model


@cache
def result():
    return ancf.simulate(swing(), t_end=0.2, step=1e-3, output_step=2e-3)


@cache
def scene():
    return make_scene(result(), frames=26)


def named(items, name):
    return next(item for item in items if item.name == name)


class TestTimes:
    def test_all_when_there_are_few(self):
        assert make_scene(result()).t == pytest.approx(result().t)
        assert scene().stored == 101

    def test_evenly_spaced_from_first_to_last(self):
        assert scene().t == pytest.approx(np.linspace(0.0, 0.2, 26))

    def test_nearest_of_uneven_times(self):
        t = np.array([0.0, 0.1, 0.11, 0.5, 0.9, 1.0])
        assert chosen_times(t, 3, None, None).tolist() == [0, 3, 5]
        assert chosen_times(t, 2, 0.1, 0.95).tolist() == [1, 4]
        assert chosen_times(t, 5, 0.05, 0.3).tolist() == [1, 2]

    def test_from_and_to(self):
        part = make_scene(result(), start=0.05, end=0.1)
        assert (part.t[0], part.t[-1]) == pytest.approx((0.05, 0.1), abs=2.1e-3)

    @pytest.mark.parametrize(
        ("given", "message"),
        [
            (
                {"start": 3.0},
                "no state is stored between it and the end: there are states from t = 0 to 0.2 s",
            ),
            ({"start": 0.2, "end": 0.1}, "^start: is 0.2 s, behind the end at 0.1 s"),
            ({"frames": 0}, r"^frames: "),
            ({"points": 1}, r"^points: "),
            ({"end": float("nan")}, r"^end: "),
        ],
    )
    def test_wrong_input(self, given, message):
        with pytest.raises(ancf.ModelError, match=message):
            make_scene(result(), **given)

    def test_something_else(self):
        with pytest.raises(ancf.ModelError, match="must be a Result, a State or Modes, is 3"):
            make_scene(3)


class TestThreads:
    def test_position_and_values_are_those_of_the_result(self):
        wire = named(scene().threads, "wire")
        at = [int(np.argmin(np.abs(result().t - t))) for t in scene().t]
        for j in (0, 17, len(wire.x) - 1):
            point = f"wire.at({float(wire.x[j])!r})"
            assert wire.position[:, j] == pytest.approx(result().position(point)[at], abs=1e-14)
            speed = np.linalg.norm(result().velocity(point)[at], axis=1)
            assert wire.values["speed"][:, j] == pytest.approx(speed, abs=1e-12)
            wanted = result().curvature(point)[at]
            assert wire.values["curvature"][:, j] == pytest.approx(wanted, rel=1e-12, abs=1e-12)
        assert set(wire.values) == set(QUANTITIES)

    def test_tensions_of_cables_are_those_of_the_middles(self):
        """Straight between them: within elements they waver."""
        for beam in (body for body in result().bodies.values() if isinstance(body, Beam)):
            thread = named(scene().threads, beam.name)
            at = [int(np.argmin(np.abs(result().t - t))) for t in scene().t]
            x = thread.x if beam.has_section else 0.5 * (beam.node_x[1:] + beam.node_x[:-1])
            known = np.stack([result().tension(beam.at(float(s)))[at] for s in x], axis=1)
            wanted = np.stack([np.interp(thread.x, x, row) for row in known])
            assert thread.values["tension"] == pytest.approx(wanted, rel=1e-9, abs=1e-9 * np.abs(known).max())

    def test_limits_are_over_all_threads(self):
        values = np.concatenate([thread.values["speed"].ravel() for thread in scene().threads])
        assert scene().limits("speed") == (values.min(), values.max())

    def test_outline_is_the_cross_section(self):
        wire, bar = (named(scene().threads, name) for name in ("wire", "bar"))
        assert wire.outline is None
        assert bar.outline.shape == (26, len(bar.x), 4, 3)
        assert bar.outline.mean(axis=2) == pytest.approx(bar.position, abs=1e-12)
        width, height = (bar.outline[0, 3, i] - bar.outline[0, 3, 0] for i in (1, 3))
        assert np.linalg.norm(width) == pytest.approx(0.02)
        assert np.linalg.norm(height) == pytest.approx(0.05)
        corner = result().position("bar.at(0.5, 0.01, 0.025)")
        j = int(np.argmin(np.abs(bar.x - 0.5)))
        assert bar.outline[-1, j, 2] == pytest.approx(corner[-1], abs=1e-12)

    def test_outlines_of_other_shapes(self):
        y, z = corners(ancf.Section.circle(0.04, E=1e9, rho=1.0))
        assert np.hypot(y, z) == pytest.approx(0.02)
        moments = SQUARE.shape.moments()
        same = ancf.Section.from_moments(E=2e9, rho=1200.0, J=1e-8, **moments)
        assert corners(same)[0] == pytest.approx(corners(SQUARE)[0])
        assert corners(same)[1] == pytest.approx(corners(SQUARE)[1])

    @pytest.mark.parametrize(
        ("share", "count"), [(100.0, 4 * FINEST + 1), (3.7, 13), (1.0, 5), (0.5, 2), (0.01, 2)]
    )
    def test_places(self, share, count):
        beam = swing().beams["wire"]
        x = places(beam, share)
        assert len(x) == count
        assert (x[0], x[-1]) == (0.0, 2.0)
        assert np.all(np.diff(x) > 0.0)
        assert set(x[:: max(1, (count - 1) // 4)]) <= set(np.linspace(0, 2, 65))


class TestOthers:
    def test_spring_is_a_link_and_slackens(self):
        [tie] = scene().links
        assert tie.ends[:, 1] == pytest.approx(np.tile([2.0, 0.0, 0.5], (26, 1)))
        assert tie.ends[:, 0] == pytest.approx(named(scene().markers, "bob").position)
        length = np.linalg.norm(tie.ends[:, 1] - tie.ends[:, 0], axis=1)
        assert tie.force == pytest.approx(np.maximum(50.0 * (length - 0.6), 0.0), abs=1e-9)
        assert tie.slack[0]
        assert not tie.slack[-1]
        assert np.array_equal(tie.slack, length <= 0.6)

    def test_spring_to_a_far_point_is_a_support(self):
        model = ancf.Model(gravity=(0, 0, -9.81))
        wire = model.add_beam("wire", start=(0, 0, 0), end=(50, 0, 1), elements=4, section=CABLE)
        near, far = (wire.at(12.5), (12.5, 0, 0.25 + FAR)), (wire.at(25.0), (25.0, 0.0, 20.0))
        for name, (a, b) in {"near": near, "far": far}.items():
            model.add_spring(a, b, stiffness=1e3, length=1.0, name=name)
        model.pin(wire.start)
        model.pin(wire.end)
        drawn = make_scene(ancf.simulate(model, t_end=1e-3, step=1e-3).state(0))
        assert [link.name for link in drawn.links] == ["near"]
        assert named(drawn.markers, "far").kind == "spring support"
        assert named(drawn.markers, "far").position[0] == pytest.approx(wire.at(25.0).initial_position)

    def test_markers(self):
        kinds = {marker.name: marker.kind for marker in scene().markers}
        assert kinds == {
            "bob": "point mass",
            "hub": "rigid body",
            "pin at wire.start": "pin",
            "clamp at bar.start": "clamp",
            **{name: kind for name, kind in kinds.items() if kind == "fixation"},
        }
        assert len(kinds) == 5
        assert set(kinds.values()) <= set(looks())

    def test_rigid_body_has_axes(self):
        [hub] = scene().triads
        assert hub.axes[0] == pytest.approx(np.eye(3))
        assert np.einsum("nij,nik->njk", hub.axes, hub.axes) == pytest.approx(
            np.tile(np.eye(3), (26, 1, 1)), abs=1e-9
        )
        assert hub.centre == pytest.approx(result().position("hub")[::4])

    def test_box_holds_everything(self):
        low, high = scene().box
        for part in (scene().threads[0].position, scene().threads[1].outline, scene().links[0].ends):
            assert np.all(part >= low - 1e-12)
            assert np.all(part <= high + 1e-12)
        assert high[2] == pytest.approx(0.5)
        assert scene().size == pytest.approx((high - low).max())


class TestSources:
    def test_file_is_drawn_as_the_result_that_wrote_it(self, tmp_path):
        result().save(tmp_path / "run.h5")
        again = make_scene(ancf.load(tmp_path / "run.h5"), frames=26)
        assert again.title == "Swing"
        for mine, theirs in zip(scene().threads, again.threads, strict=True):
            assert np.array_equal(mine.position, theirs.position)
            assert np.array_equal(mine.values["tension"], theirs.values["tension"])
        assert [m.name for m in again.markers] == [m.name for m in scene().markers]
        assert np.array_equal(again.links[0].slack, scene().links[0].slack)

    def test_state(self):
        drawn = make_scene(result().state(-1))
        assert drawn.t == pytest.approx([0.2])
        assert drawn.threads[0].position[0] == pytest.approx(scene().threads[0].position[-1])

    def test_mode_swings_by_a_tenth_of_the_size(self):
        model = ancf.Model()
        wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=8, section=CABLE)
        model.clamp(wire.start)
        modes = ancf.modes(model, count=3)
        drawn = make_scene(modes, frames=41, mode=2)
        [thread] = drawn.threads
        still = np.column_stack([thread.x, 0 * thread.x, 0 * thread.x])
        assert np.linalg.norm(thread.position - still, axis=2).max() == pytest.approx(0.2, rel=1e-3)
        assert thread.position[[0, 20, 40]] == pytest.approx(np.stack([still] * 3), abs=1e-12)
        assert drawn.t[-1] == pytest.approx(1.0 / modes.frequencies_hz[2])
        assert "mode 3" in drawn.title
        with pytest.raises(ancf.ModelError, match=r"^mode: "):
            make_scene(modes, mode=3)

    def test_strip_knows_its_force(self):
        model = ancf.Model()
        wire = model.add_beam("wire", start=(0, 0, 1), end=(4, 0, 1), elements=4, length=3.99, section=CABLE)
        model.pin(wire.start)
        model.pin(wire.end)
        head = model.add_point_mass("head", at=(1, 0, 0.9995), mass=1.0)
        model.add_force(head, (0, 0, 50.0))
        contact = model.add_contact(head, wire, stiffness=1e4, name="contact")
        done = ancf.simulate(model, t_end=0.02, step=1e-3, sensors=[contact], output_step=2e-3)
        [strip] = make_scene(done).strips
        assert strip.force == pytest.approx(done.sensors.contact_force("contact")[::2])
        assert strip.force.max() > 0.0
        assert strip.ends.mean(axis=1) == pytest.approx(done.position(head))
        assert np.abs(strip.ends[:, 1] - strip.ends[:, 0])[:, [0, 2]].max() < 1e-12


class TestNets:
    """Grounds and surfaces of fluids."""

    @staticmethod
    def of(**ground):
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.5, diameter=0.02, drag=(1, 0))
        wire = model.add_beam("wire", start=(0, 0, -2), end=(4, 0, 0), elements=3, section=section)
        model.pin(wire.start)
        model.add_ground("bed", **({"height": -2.0, "stiffness": 1e4} | ground))
        model.add_fluid("water", 1000.0, below=0.5)
        model.add_fluid("air", 1.2, above=0.5, below=90.0)
        system = System(model)
        return make_scene(ancf.State(system, 0.0, *system.initial_state())).nets

    def test_a_plane_and_one_surface(self):
        """Of two fluids that meet; one far away is left out."""
        bed, surface = self.of()
        assert (bed.kind, surface.kind) == ("ground", "surface")
        assert np.all(bed.lines[..., 2] == -2.0)
        assert np.all(surface.lines[..., 2] == 0.5)
        for net in (bed, surface):
            assert net.lines[..., 0].min() < 0.0 < 4.0 < net.lines[..., 0].max()
            assert np.ptp(net.lines[..., 1]) > 1.0

    def test_waves_move_and_fluids_have_arrows(self):
        """The surface is that of the waves at each time, fine enough for them; arrows are the current's."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.5, diameter=0.02, drag=(1, 0))
        wire = model.add_beam("wire", start=(0, 0, -20), end=(60, 0, 0), elements=3, section=section)
        model.pin(wire.start)
        model.pin(wire.end)
        waves = ancf.Waves.jonswap(2.0, 5.0, seed=2, components=9, direction=0.4, ramp=0.5)
        profile = {"z": [-20.0, 0.0], "velocity": [[0.0, 0.1, 0], [0.4, 0.9, 0]]}
        model.add_fluid("water", 1000.0, velocity=profile, below=0.0, waves=waves)
        model.add_fluid("air", 1.2, above=0.0)
        scene = make_scene(ancf.simulate(model, t_end=1.0, step=0.05))
        [net] = scene.nets
        assert (net.name, net.kind) == ("surface of water", "surface")
        x, y = net.lines[..., 0], net.lines[..., 1]
        assert np.abs(np.diff(x[-9:], axis=1)).max() < 39.0 / 10  # the length of the waves of the peak
        for k in (0, 9, 20):
            wanted = [
                [waves.elevation(scene.t[k], *p)[0] for p in zip(*row, strict=True)]
                for row in zip(x, y, strict=True)
            ]
            assert net.heights[k] == pytest.approx(np.array(wanted), abs=1e-12)
        assert np.ptp(net.heights[20]) > 0.3 > np.ptp(net.heights[0])
        [arrow] = scene.arrows
        assert (arrow.name, arrow.kind) == ("water", "fluid")
        assert arrow.size == pytest.approx(np.hypot(0.4, 0.9))
        along = arrow.ends[3, :, 1] - arrow.ends[3, :, 0]
        assert along[-1] / np.linalg.norm(along[-1]) == pytest.approx(
            np.array([0.4, 0.9, 0]) / np.hypot(0.4, 0.9)
        )
        assert np.linalg.norm(along[0]) / np.linalg.norm(along[-1]) == pytest.approx(0.1 / np.hypot(0.4, 0.9))

    def test_slopes_and_tables(self):
        tilted = self.of(normal=(0.3, -0.2, 1.0))[0].lines
        assert tilted[..., 2] == pytest.approx(-2.0 - 0.3 * tilted[..., 0] + 0.2 * tilted[..., 1])
        table = self.of(height={"x": [-9, 9], "y": [-9, 9], "z": [[-2, -2], [-3, -3]]})[0].lines
        assert table[..., 2] == pytest.approx(-2.5 - table[..., 0] / 18.0)

    def test_surfaces_that_beams_touch(self):
        """Circles and meridians, of one on a rigid body in its axes; the way where a beam is nearest."""
        model = ancf.Model()
        section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.5, diameter=0.02)
        rope = model.add_beam("rope", start=(-1, 0, 0.35), end=(1, 0, 0.35), elements=5, section=section)
        hub = model.add_rigid_body("hub", at=(0, 0, -1), mass=1.0, inertia=(1, 1, 1))
        ball = model.add_surface("ball", ancf.Sphere(radius=0.3))
        model.add_surface("drum", ancf.Cylinder(0.2, at=(0, 0.1, 0), axis=(0, 1, 0), length=0.5), on=hub)
        model.add_surface("floor", ancf.Plane(at=(0, 0, -2)))
        model.add_contact(rope, ball, stiffness=1e4, name="way")
        system = System(model)
        scene = make_scene(ancf.State(system, 0.0, *system.initial_state()))
        nets = {net.name: net for net in scene.nets}
        assert np.linalg.norm(nets["ball"].lines, axis=-1) == pytest.approx(0.3)
        drum = nets["drum"].lines
        assert nets["drum"].on == "hub"
        assert np.hypot(drum[..., 0], drum[..., 2]).max() == pytest.approx(0.2)
        assert (drum[..., 1].min(), drum[..., 1].max()) == pytest.approx((-0.15, 0.35))
        assert nets["floor"].lines[..., 2] == pytest.approx(-2.0)
        [way] = [strip for strip in scene.strips if strip.name == "way"]
        assert way.ends[0, :, 2] == pytest.approx([0.35, 0.3])

    def test_none_without_surroundings(self):
        assert scene().nets == []


class TestCombs:
    """Contact forces along a rope on a drum, and where it slips."""

    @staticmethod
    def hung(friction, pull):
        """A rope over the upper half of a drum with forces on both ends, held by friction or not."""
        radius, a = 0.21, np.linspace(0.0, np.pi, 40)
        arc = np.stack([radius * np.cos(a), 0.0 * a, radius * np.sin(a)], axis=1)
        path = np.concatenate([[[radius, 0, -0.3]], arc, [[-radius, 0, -0.3]]])
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=1e-3, rhoA=0.3, diameter=0.02)
        rope = model.add_beam("rope", path=path, elements=24, section=section)
        drum = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0, 1, 0)))
        contact = model.add_contact(rope, drum, stiffness=1e7, damping=500.0, friction=friction, name="on")
        model.add_force(rope.start, (0, 0, -50.0))
        model.add_force(rope.end, (0, 0, -pull))
        return model, rope, contact

    def test_force_points_away_from_the_drum_and_adds_up(self):
        model, rope, contact = self.hung(0.3, 50.0)
        run = ancf.simulate(model, t_end=0.02, step=2e-4, output_step=2e-3, sensors=[contact])
        [comb] = make_scene(run).combs
        ways = comb.ends[:, :, 1] - comb.ends[:, :, 0]
        sizes = np.linalg.norm(ways, axis=-1)
        touched = comb.force > 0.0
        outwards = comb.ends[:, :, 0] * (1.0, 0.0, 1.0)
        outwards /= np.linalg.norm(outwards, axis=-1)[..., None]
        assert np.sum(ways * outwards, axis=-1)[touched] == pytest.approx(sizes[touched], rel=2e-2)
        ratio = sizes[touched] / comb.force[touched]
        assert ratio == pytest.approx(ratio[0], rel=2e-2)  # means of normals over an element are shorter
        whole = comb.force.sum(axis=1) * rope.length / rope.elements
        assert whole == pytest.approx(run.contact_force(contact), rel=2e-2)
        limits = 0.3 * comb.force * rope.length / rope.elements
        drawn = slice(None, None, len(run.sensors.t) // 10)
        friction, share = run.sensors.friction_force(contact)[drawn], run.sensors.slipping(contact)[drawn]
        part = share < 1.0
        assert 0 < part.sum() < len(part)
        slips, most = np.sum(limits * comb.slips, axis=1), share * limits.sum(axis=1)
        assert slips[part] == pytest.approx(np.minimum(friction * share, most)[part], abs=limits.max())
        assert np.array_equal(comb.slips[~part], touched[~part])
        assert not np.all(comb.slips[part][touched[part]])

    def test_slips_where_it_slides(self):
        model, rope, contact = self.hung(0.1, 150.0)  # holds 68 N
        method = ancf.GeneralizedAlpha(rho_inf=0.6)
        run = ancf.simulate(
            model, t_end=0.014, step=2e-4, output_step=2e-3, sensors=[contact], integrator=method
        )
        comb = make_scene(run).combs[0]
        there = comb.force[-1] > 0.0
        assert np.all(comb.slips[-1][there])
        speed = np.linalg.norm(run.velocity(rope.at(0.5 * rope.length))[-1])
        assert np.median(comb.slide[-1][there]) == pytest.approx(speed, rel=0.05)

    def test_stick_and_slip_need_sensors(self):
        model, _, _ = self.hung(0.1, 150.0)
        run = ancf.simulate(model, t_end=2e-3, step=2e-4)
        assert make_scene(run).combs[0].slips is None

    def test_the_fastest_slip(self):
        """As many as the friction that slips takes, in the order of their speeds."""
        slide = np.array([[0.1, 3.0, 2.0, 0.2], [1.0, 2.0, 3.0, 4.0]])
        limits = np.array([[5.0, 2.0, 4.0, 0.0], [1.0, 1.0, 1.0, 1.0]])
        slips = fastest(slide, limits, np.array([6.0, 0.0]), np.array([0.7, 0.0]))
        assert slips.tolist() == [[False, True, True, False], [False] * 4]

    @pytest.mark.parametrize("acted", [0.1, 1.0, 10.0])
    def test_limits_of_another_time(self, acted):
        """However large those that friction acted with are beside those of now."""
        slide, limits = np.array([[0.1, 3.0, 2.0]] * 2), np.array([[5.0, 0.0, 5.0]] * 2)
        slips = fastest(slide, limits, acted * np.array([10.0, 5.0]), np.array([1.0, 0.6]))
        assert slips.tolist() == [[True, False, True], [False, False, acted >= 1.0]]


def test_a_way_between_cables_stays_where_it_was_while_nothing_is_near():
    section = ancf.Section(EA=1e4, EI=0.05, rhoA=0.3, diameter=0.02)
    model = ancf.Model()
    low = model.add_beam("low", start=(0, -0.5, 0), end=(0, 0.5, 0), elements=4, section=section)
    top = model.add_beam("top", start=(-0.4, 0, 0.03), end=(0.6, 0, 0.03), elements=4, section=section)
    top.set_motion(velocity=(0, 0, 5.0))
    model.add_contact(top, low, stiffness=1e5, name="way")
    run = ancf.simulate(model, t_end=0.6, step=2e-3, output_step=0.06)
    [way] = [strip for strip in make_scene(run).strips if strip.name == "way"]
    near = np.isfinite(run.contact_gap("way"))
    assert near[0]
    assert not near[-1]
    last = np.flatnonzero(near)[-1]
    assert way.ends[-1] == pytest.approx(np.repeat(way.ends[last, :1], 2, axis=0))
