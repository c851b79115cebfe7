"""Pictures of results, states and modes: what is drawn are the result's numbers, with their units."""

import sys

import numpy as np
import pytest
from PIL import Image

import ancf
from ancf.viz import style
from ancf.viz.pictures.picture import Picture
from ancf.viz.pictures.projection import best_axes, projection
from ancf.viz.pictures.shape import times_of
from ancf.viz.scene import make_scene
from commands import python


@pytest.fixture(scope="module")
def swinging():
    """A rigid body on a hinge."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    hub = model.add_rigid_body("hub", at=(1, 0, 0), mass=1.0, inertia=(0.01, 0.02, 0.03))
    model.hinge(hub.at(-1, 0, 0), (0, 0, 0), axis=(0, 1, 0), name="hinge")
    return ancf.simulate(model, t_end=0.3, step=5e-3)


def curves(axes):
    """Curves of a panel by their text in the legend."""
    return {line.get_label(): line.get_xydata() for line in axes.lines}


def legend_texts(picture):
    return [text.get_text() for legend in picture.figure.legends for text in legend.get_texts()]


def image(picture, path):
    picture.save(path)
    return np.asarray(Image.open(path).convert("L"), dtype=float)


class TestCurves:
    def test_position_of_a_point(self, result):
        picture = result.plot("rope.end")
        (axes,) = picture.axes
        found = curves(axes)
        assert list(found) == ["rope.end x", "rope.end y", "rope.end z"]
        assert legend_texts(picture) == list(found)
        for k, letter in enumerate("xyz"):
            expected = np.column_stack([result.t, result.position("rope.end")[:, k]])
            np.testing.assert_array_equal(found[f"rope.end {letter}"], expected)
        assert axes.get_xlabel() == "$t$ [s]"
        assert axes.get_ylabel() == "position [m]"

    def test_several_points_have_a_panel_for_each_component(self, result, model):
        rope = model.bodies["rope"]
        picture = result.plot(rope.at(0.5), model.bodies["ball"], quantity="velocity")
        assert [axes.get_ylabel() for axes in picture.axes] == [f"velocity {k} [m/s]" for k in "xyz"]
        for k, axes in enumerate(picture.axes):
            np.testing.assert_array_equal(curves(axes)["ball"][:, 1], result.velocity("ball")[:, k])
            np.testing.assert_array_equal(
                curves(axes)["rope.at(0.5)"][:, 1], result.velocity(rope.at(0.5))[:, k]
            )
        assert legend_texts(picture) == ["rope.at(0.5)", "ball"]

    @pytest.mark.parametrize(
        ("quantity", "label"),
        [
            ("tension", "tension [N]"),
            ("strain", "strain [-]"),
            ("curvature", "curvature [1/m]"),
            ("bending_moment", "bending moment [N m]"),
        ],
    )
    def test_scalars(self, result, quantity, label):
        (axes,) = result.plot("rope.at(0.3)", "rope.at(0.6)", quantity=quantity).axes
        assert axes.get_ylabel() == label
        for name, found in curves(axes).items():
            np.testing.assert_array_equal(found[:, 1], getattr(result, quantity)(name))

    def test_speed(self, result):
        (axes,) = result.plot("ball", quantity="speed").axes
        expected = np.sqrt((result.velocity("ball") ** 2).sum(axis=1))
        np.testing.assert_allclose(curves(axes)["ball"][:, 1], expected)

    def test_springs_by_name_and_object(self, result, model):
        (axes,) = result.plot("taut", model.connection("loose")).axes
        assert axes.get_ylabel() == "spring force [N]"
        np.testing.assert_array_equal(curves(axes)["taut"][:, 1], result.spring_force("taut"))
        assert not np.any(curves(axes)["loose"][:, 1])

    def test_points_and_springs_have_their_own_panels(self, result):
        labels = [axes.get_ylabel() for axes in result.plot("ball", "taut").axes]
        assert labels == ["position [m]", "spring force [N]"]

    def test_over_another_quantity(self, result):
        (axes,) = result.plot("taut", x="spring_length").axes
        assert axes.get_xlabel() == "spring length [m]"
        x, y = curves(axes)["taut"].T
        np.testing.assert_allclose(y, 10.0 * (x - 0.3), atol=1e-12)  # k (length - natural length)

    def test_energies(self, result):
        upper, lower = result.plot().axes
        found = curves(upper)
        assert upper.get_ylabel() == "energy [J]"
        np.testing.assert_array_equal(found["kinetic"][:, 1], result.energy.kinetic)
        assert "dissipated" not in found
        balance = result.energy.balance
        np.testing.assert_array_equal(lower.lines[0].get_ydata(), balance - balance[0])
        assert lower.get_ylabel() == "drift of the balance [J]"

    def test_drift_of_what_moves_from_the_start(self):
        """The balance starts with the energy that there is, its drift at zero."""
        model = ancf.Model()
        section = ancf.Section(EA=1e3, EI=1.0, rhoA=0.1)
        model.add_beam("rod", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=section).set_motion(
            velocity=(0, 0, 1)
        )
        moving = ancf.simulate(model, t_end=5e-3, step=1e-3)
        _, lower = moving.plot().axes
        assert moving.energy.balance[0] > 0.01
        np.testing.assert_array_equal(lower.lines[0].get_ydata(), moving.energy.drift)
        assert lower.lines[0].get_ydata()[0] == 0.0

    def test_sensors_draw_every_step(self, result):
        (axes,) = result.sensors.plot("taut").axes
        assert len(curves(axes)["taut"]) == 201
        np.testing.assert_array_equal(curves(axes)["taut"][:, 1], result.sensors.spring_force("taut"))

    def test_curves_differ_without_colour(self, result):
        (axes,) = result.plot(*[f"rope.at({x})" for x in np.arange(1, 10) / 10], quantity="tension").axes
        looks = {
            (str(line.get_linestyle()), str(line._dash_pattern), line.get_color()) for line in axes.lines
        }
        assert len(looks) == 9

    def test_joint(self, swinging):
        force, moment = swinging.plot("hinge").axes
        assert force.get_ylabel() == "force of the joint [N]"
        assert moment.get_ylabel() == "moment of the joint [N m]"
        values = swinging.multiplier("hinge")
        assert values.shape == (61, 5)
        np.testing.assert_array_equal(curves(force)["hinge z"][:, 1], values[:, 2])
        np.testing.assert_array_equal(curves(moment)["hinge y"][:, 1], swinging.joint_moment("hinge")[:, 1])

    def test_one_state_is_a_point(self):
        model = ancf.Model()
        model.add_point_mass("ball", at=(0, 0, 0), mass=1.0)
        result = ancf.simulate(model, t_end=1e-3, step=1e-3)
        result._store._joined = {k: v[:1] for k, v in result._store.arrays.items() if k != "energy"}
        (axes,) = result.plot("ball").axes
        assert len(axes.lines[0].get_xdata()) == 1
        assert axes.lines[0].get_marker() == "o"


class TestSlidesAndContacts:
    @pytest.fixture(scope="class")
    @staticmethod
    def sliding():
        """A ball on an inclined cable."""
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=1e5, EI=1.0, rhoA=0.1)
        wire = model.add_beam("wire", start=(0, 0, 1), end=(2, 0, 0), elements=4, section=section)
        model.pin(wire.start)
        model.pin(wire.end)
        ball = model.add_point_mass("ball", at=(0.2, 0, 0.9), mass=0.05)
        joint = model.slide(ball, along=wire)
        return ancf.simulate(model, t_end=0.1, step=1e-3), joint

    @pytest.fixture(scope="class")
    @staticmethod
    def touching():
        """A strip that presses a wire upwards."""
        model = ancf.Model()
        section = ancf.Section(EA=1e5, EI=1.0, rhoA=0.1)
        wire = model.add_beam("wire", start=(0, 0, 0), end=(2, 0, 0), elements=4, section=section)
        model.pin(wire.start)
        model.pin(wire.end)
        head = model.add_point_mass("head", at=(1, 0, -1e-3), mass=0.05)
        model.hold(head, position="xy")
        contact = model.add_contact(head, along=wire, stiffness=1e3)
        model.add_force(head, (0, 0, 2.0))
        return ancf.simulate(model, t_end=0.1, step=1e-3, sensors=[contact]), contact

    def test_slide(self, sliding):
        result, joint = sliding
        (axes,) = result.plot(joint).axes
        assert axes.get_ylabel() == "arc length [m]"
        found = curves(axes)[joint.name]
        np.testing.assert_array_equal(found[:, 1], result.arc_length(joint))
        assert found[-1, 1] > found[0, 1]

    def test_contact(self, touching):
        result, contact = touching
        for source in (result, result.sensors):
            (axes,) = source.plot(contact.name).axes
            assert axes.get_ylabel() == "contact force [N]"
            assert curves(axes)[contact.name][:, 1].max() > 0.0

    def test_loaded_has_the_contact(self, touching, tmp_path):
        result, contact = touching
        result.save(tmp_path / "run.h5")
        loaded = ancf.load(tmp_path / "run.h5")
        for one, two in ((loaded, result), (loaded.sensors, result.sensors)):
            found, wanted = (curves(source.plot(contact.name).axes[0])[contact.name] for source in (one, two))
            assert np.array_equal(found, wanted)

    def test_shape_has_joint_and_strip(self, sliding, touching):
        assert legend_texts(sliding[0].plot_shape(2, color="speed")) == ["point mass", "pin", "slide"]
        picture = touching[0].plot_shape(2, plane="xy")
        assert legend_texts(picture) == ["point mass", "pin", "hold", "force"]
        (strips,) = [c for c in picture.axes[0].collections if c.get_linewidth() == [2.4]]
        ends = np.array(strips.get_segments())
        assert ends.shape == (2, 2, 2)
        np.testing.assert_allclose(ends[..., 0], 1.0)
        assert np.all(ends[:, 1, 1] > ends[:, 0, 1])


class TestInputs:
    @pytest.mark.parametrize("units", [("N", "N"), ("N", "m/s"), ("", "N")])
    def test_have_a_panel_for_each_unit(self, units):
        model = ancf.Model()
        mass = model.add_point_mass("mass", at=(0, 0, 0), mass=1.0)
        u, w = (model.add_input(name, 0.0, unit=unit) for name, unit in zip("uw", units, strict=True))
        model.add_force(mass, (u, w, 0))

        def lead(run):
            run.inputs["u"], run.inputs["w"] = run.t, -run.t

        result = ancf.simulate(
            model, t_end=0.1, step=0.01, controller=lead, control_step=0.02, sensors=[mass]
        )
        for source in (result, result.sensors):
            axes = source.plot("u", w).axes
            labels = [f"input [{unit}]" if unit else "input" for unit in dict.fromkeys(units)]
            assert [one.get_ylabel() for one in axes] == labels
            drawn = [line.get_ydata() for one in axes for line in one.lines]
            assert np.array_equal(drawn[0], source.input("u"))
            assert np.array_equal(drawn[1], source.input("w"))
            assert np.any(drawn[0] > 0.0)
            assert np.any(drawn[1] < 0.0)

    def test_a_wrong_name_is_told(self, result):
        with pytest.raises(ancf.ModelError, match="no point, support, spring, contact, joint or input here"):
            result.plot("thrust")


class TestPaths:
    def test_in_a_plane(self, result):
        picture = result.plot("rope.end", "rope.at(0.5)", plane="zx")
        (axes,) = picture.axes
        assert (axes.get_xlabel(), axes.get_ylabel()) == ("z [m]", "x [m]")
        np.testing.assert_array_equal(curves(axes)["rope.end"], result.position("rope.end")[:, [2, 0]])
        assert legend_texts(picture) == ["rope.end", "rope.at(0.5)"]
        assert axes.get_aspect() == 1.0

    def test_in_space(self, spatial):
        (axes,) = spatial.plot("arm.end", plane="xyz").axes
        np.testing.assert_array_equal(np.array(axes.lines[0].get_data_3d()).T, spatial.position("arm.end"))
        assert axes.get_zlabel() == "z [m]"


class TestMistakes:
    @pytest.mark.parametrize(
        ("what", "options", "message"),
        [
            (["rop.end"], {}, 'did you mean "rope"|unknown body'),
            (["taunt"], {}, 'did you mean "taut"'),
            (["rope"], {}, "its points are rope.start, rope.end"),
            (["rope.at(7)"], {}, "outside the beam"),
            (["ball"], {"quantity": "tension"}, "a point mass has no strains"),
            (["ball"], {"quantity": "sped"}, 'did you mean "speed"'),
            (["ball"], {"quantity": "spring_force"}, "of a point there are: position, velocity"),
            (["taut"], {"quantity": "position"}, "of a spring there are: spring_force"),
            (["ball"], {"x": "velocity"}, "plot.x: is 'velocity'"),
            (["ball"], {"quantity": "energy"}, "leave the points out|is that of the whole model"),
            ([], {"quantity": "tension"}, '"tension" of what'),
            ([], {"plane": "xz"}, "a path of what"),
            (["taut"], {"plane": "xz"}, "only points have a path"),
            (["ball"], {"plane": "xx"}, 'two or three letters of "xyz"'),
            (["ball"], {"size": (10, -1)}, "plot.size: must be > 0"),
            ([3], {}, "must be a point, support, spring, contact, joint or input"),
        ],
    )
    def test_are_named(self, result, what, options, message):
        with pytest.raises(ancf.ModelError, match=message):
            result.plot(*what, **options)

    def test_sensors_know_only_what_they_have(self, result):
        with pytest.raises(ancf.ModelError, match="was not recorded"):
            result.sensors.plot("rope.at(0.3)")
        with pytest.raises(ancf.ModelError, match="sensors have no energies"):
            result.sensors.plot()

    @pytest.mark.parametrize(
        ("times", "message"),
        [([0.1, 3.0], "3 s is outside"), (0, "between 1 and 200"), ("all", "must be a whole number")],
    )
    def test_times(self, result, times, message):
        with pytest.raises(ancf.ModelError, match=message):
            result.plot_shape(times)

    def test_colours(self, result):
        with pytest.raises(ancf.ModelError, match=r"plot_shape\.color: is 'red'"):
            result.plot_shape(color="red")
        with pytest.raises(ancf.ModelError, match=r"animate\.color: is 't'"):
            result.animate("t")

    def test_energies_that_were_not_accounted_for(self, model):
        result = ancf.simulate(model, t_end=0.01, step=1e-3, energy=False)
        with pytest.raises(ancf.ModelError, match="was not accounted for"):
            result.plot()

    def test_missing_matplotlib(self, result, monkeypatch):
        monkeypatch.setitem(sys.modules, "matplotlib", None)
        for draw in (result.plot, result.plot_shape, result.state().plot):
            with pytest.raises(ancf.ModelError, match="matplotlib is not installed"):
                draw()


class TestShapes:
    def test_colours_are_the_values(self, result):
        picture = result.plot_shape([0.1], color="tension", plane="xz")
        axes, bar = picture.axes
        scene = make_scene(result, start=0.1, end=0.1)
        (bodies,) = [c for c in axes.collections if c.get_array() is not None]
        (thread,) = scene.threads
        drawn = np.array(bodies.get_segments())
        np.testing.assert_allclose(drawn[:, 0], thread.position[0, :-1][:, [0, 2]])
        tension = thread.values["tension"][0]
        np.testing.assert_allclose(bodies.get_array(), 0.5 * (tension[1:] + tension[:-1]))
        assert bar.get_ylabel() == "tension [N]"

    def test_several_times(self, result):
        axes, bar = result.plot_shape(5).axes
        (bodies,) = [c for c in axes.collections if c.get_array() is not None]
        np.testing.assert_allclose(np.unique(bodies.get_array()), [0.0, 0.05, 0.1, 0.15, 0.2], atol=2e-3)
        assert bar.get_ylabel() == "$t$ [s]"

    def test_times_are_the_nearest(self):
        stored = np.array([0.0, 0.1, 0.2, 0.5])
        assert times_of(stored, [0.04, 0.16, 0.3]).tolist() == [0.0, 0.2]
        assert times_of(stored, [0.4, 0.06]).tolist() == [0.1, 0.5]

    def test_loaded_result(self, result, tmp_path):
        result.save(tmp_path / "run.h5")
        loaded = ancf.load(tmp_path / "run.h5")
        one, two = (image(r.plot_shape(3), tmp_path / f"{k}.png") for k, r in enumerate((result, loaded)))
        np.testing.assert_array_equal(one, two)

    def test_state_in_its_plane(self, result):
        picture = result.state().plot()
        axes, bar = picture.axes
        assert (axes.get_xlabel(), axes.get_ylabel(), bar.get_ylabel()) == ("x [m]", "z [m]", "tension [N]")
        assert legend_texts(picture) == ["point mass", "clamp"]

    def test_section_in_space(self, spatial, tmp_path):
        axes = spatial.state().plot(color="plain").axes
        assert axes[0].name == "3d"
        assert image(spatial.plot_shape(3), tmp_path / "arm.png").std() > 10

    def test_rigid_body(self, swinging):
        picture = swinging.plot_shape(3, plane="xz")
        assert legend_texts(picture) == ["rigid body", "hinge"]
        body = next(line for line in picture.axes[0].lines if line.get_label() == "rigid body")
        expected = swinging.position("hub")[[0, 30, 60]][:, [0, 2]]
        np.testing.assert_allclose(body.get_xydata(), expected)

    def test_modes(self, model):
        modes = ancf.modes(model, about=ancf.equilibrium(model), count=3)
        picture = modes.plot(2)
        titles = [axes.get_title() for axes in picture.axes]
        assert titles == [f"{k + 1}: {modes.frequencies_hz[k]:.4g} Hz" for k in range(2)]
        assert len(modes.plot(5).axes) == 3  # as many as there are

    def test_mode_is_seen_where_it_moves(self):
        """Of a straight cantilever of two stiffnesses, modes in y and in z in their own planes."""
        model = ancf.Model()
        section = ancf.Section.rectangle(0.05, 0.1, E=1e8, rho=1e3)
        beam = model.add_beam(
            "beam", start=(0, 0, 0), end=(1, 0, 0), elements=3, section=section, element="nonlocking"
        )
        model.clamp(beam.start)
        modes = ancf.modes(model, count=2)
        planes = {axes.get_xlabel()[0] + axes.get_ylabel()[0] for axes in modes.plot(2).axes}
        assert planes == {"xy", "xz"}


class TestProjection:
    def test_planes(self):
        assert best_axes(np.array([1.0, 0.0, 0.5])) == (0, 2)
        assert best_axes(np.array([1.0, 0.5, 0.01])) == (0, 1)
        assert best_axes(np.array([1.0, 0.0, 0.0])) == (0, 2)
        assert best_axes(np.array([0.0, 1.0, 0.0])) == (1, 2)
        assert best_axes(np.array([0.0, 0.0, 1.0])) == (0, 2)
        assert best_axes(np.array([1.0, 0.4, 0.5])) == (0, 1, 2)
        assert best_axes(np.zeros(3)) == (0, 2)

    def test_everything_is_inside(self):
        points = np.random.default_rng(1).uniform(-3, 5, (50, 3))
        for axes in ((0, 1), (2, 0), (0, 1, 2)):
            view = projection(points, axes)
            assert np.all(view(points) > view.low)
            assert np.all(view(points) < view.high)

    def test_long_lines_are_not_to_scale(self):
        box = np.array([[0.0, 0.0, 5.0], [600.0, 0.0, 7.0]])
        view = projection(box, (0, 2))
        assert not view.equal
        assert view.extent[1] < 5.0
        assert projection(np.array([[0.0, 0, 0], [3.0, 0, 1.0]])).equal
        # in space it is the second of the three that counts
        assert projection(np.array([[0.0, 0, 0], [10.0, 8.0, 0.3]])).equal
        assert not projection(np.array([[0.0, 0, 0], [10.0, 0.4, 0.3]])).equal


class TestPicture:
    @pytest.mark.parametrize("suffix", [".png", ".svg", ".pdf"])
    def test_files(self, result, tmp_path, suffix):
        path = result.plot("ball").save(tmp_path / "new" / f"picture{suffix}")
        assert path.stat().st_size > 2000

    def test_is_not_blank_and_has_its_size(self, result, tmp_path):
        pixels = image(result.plot("ball", size=(100, 60)), tmp_path / "ball.png")
        assert pixels.shape == pytest.approx((60 / 25.4 * style.DPI, 100 / 25.4 * style.DPI), abs=1)
        assert pixels.std() > 10

    def test_notebook(self, result):
        picture = result.plot("ball")
        data, about = picture._repr_png_()
        assert data[:4] == b"\x89PNG"
        assert about["width"] == round(130 / 25.4 * 110)
        assert repr(picture).startswith("Picture(130 x 70 mm")

    def test_needs_no_display(self):
        """Neither pyplot nor a window of a toolkit is touched."""
        code = (
            "import sys, ancf; m = ancf.Model(); m.add_point_mass('a', at=(0, 0, 0), mass=1);"
            "r = ancf.simulate(m, t_end=0.1, step=0.01); r.plot('a')._repr_png_();"
            "print('matplotlib.pyplot' in sys.modules)"
        )
        done = python(code)
        assert done.out == "False\n", done.err

    def test_wrong_files(self, result, tmp_path):
        picture = result.plot("ball")
        with pytest.raises(ancf.ModelError, match=r"use .png, .svg, .pdf"):
            picture.save(tmp_path / "a.bmp")
        with pytest.raises(ancf.ModelError, match="must be given a path"):
            picture.save(3)
        (tmp_path / "file").write_text("")
        with pytest.raises(ancf.ModelError, match="cannot be written"):
            picture.save(tmp_path / "file" / "a.png")

    def test_axes_can_be_changed(self, result):
        picture = result.plot("ball")
        picture.axes[0].set_title("mine")
        assert isinstance(picture, Picture)
        assert picture.figure.axes[0].get_title() == "mine"
