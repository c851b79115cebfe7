"""Loads as arrows: where they begin and end, how long they are, which way round ones turn."""

import numpy as np
import pytest

import ancf
from ancf.system.system import System
from ancf.viz.export import write_vtk
from ancf.viz.scene import make_scene, strokes
from ancf.viz.scene.arrows import LONGEST, RADIUS, ROW
from ancf.viz.view import view_page
from viewed import array_of, data_of

SECTION = ancf.Section.rectangle(0.02, 0.02, E=1e9, rho=1e3, nu=0.3)


def beam(length=2.0, direction=(1.0, 0.0, 0.0)):
    model = ancf.Model(gravity=(0, 0, -9.81))
    end = length * np.array(direction)
    model.add_beam("beam", start=(0, 0, 0), end=end, elements=2, section=SECTION, element="nonlocking")
    model.clamp("beam.start")
    return model


def at_rest(model, t=0.0):
    system = System(model)
    return ancf.State(system, t, *system.initial_state(t))


@pytest.mark.parametrize("force", [(0.0, 0.0, -3.0), (1.0, 2.0, -2.0), (-5.0, 0.0, 0.0), (1e6, 0.0, 1e-3)])
@pytest.mark.parametrize("length", [0.02, 2.0, 300.0])
def test_a_force_ends_where_it_acts(force, length):
    model = beam(length)
    model.add_force("beam.end", force, name="push")
    (arrow,) = make_scene(at_rest(model)).arrows
    tail, tip = arrow.ends[0, 0]
    assert tip == pytest.approx([length, 0.0, 0.0])
    size = np.linalg.norm(force)
    assert (tip - tail) / (LONGEST * length) == pytest.approx(np.array(force) / size, abs=1e-12)
    assert (arrow.name, arrow.kind, arrow.push.unit) == ("push", "force", "N")
    assert arrow.size == pytest.approx([size])


def test_lengths_are_in_proportion_over_time_and_loads_of_a_kind():
    model = beam()
    model.add_force("beam.end", (0, 0, "10*sin(3*t)"), name="first")
    model.add_force("beam.at(1)", (0, "-4*t", 0), name="second")
    model.add_moment("beam.end", (0, 1e-3, 0), name="turn")
    result = ancf.simulate(model, t_end=0.1, step=0.01)
    scene = make_scene(result)
    lengths = {a.name: np.linalg.norm(a.ends[:, 0, 1] - a.ends[:, 0, 0], axis=1) for a in scene.arrows}
    sizes = {"first": 10 * np.sin(3 * result.t), "second": 4 * result.t}
    scale = lengths["first"][-1] / sizes["first"][-1]
    for name, size in sizes.items():
        assert lengths[name] == pytest.approx(scale * size, abs=1e-12)
    assert lengths["turn"] == pytest.approx(lengths["first"].max())
    tips = {a.name: a.ends[:, 0, 1] for a in scene.arrows}
    assert tips["first"] == pytest.approx(result.position("beam.end"), abs=1e-12)


def test_a_law_of_the_state_is_asked_at_the_state():
    model = ancf.Model()
    bob = model.add_point_mass("bob", at=(1, 0, 0), mass=1.0)
    bob.set_motion(velocity=(0.0, 1.0, 0.0))
    model.add_force(bob, ("-4*x", "-4*y - 0.5*vy", "0.1*t"), name="law")
    result = ancf.simulate(model, t_end=0.5, step=0.01)
    (arrow,) = make_scene(result).arrows
    r, v = result.position(bob), result.velocity(bob)
    force = np.stack([-4 * r[:, 0], -4 * r[:, 1] - 0.5 * v[:, 1], 0.1 * result.t], axis=1)
    assert arrow.size == pytest.approx(np.linalg.norm(force, axis=1))
    along = arrow.ends[:, 0, 1] - arrow.ends[:, 0, 0]
    assert np.cross(along, force) == pytest.approx(np.zeros_like(force), abs=1e-12)


@pytest.mark.parametrize("between", [None, (0.5, 1.25)])
def test_a_distributed_load_is_a_row(between):
    model = beam()
    model.add_distributed_load("beam", (0, 0, -7.0), between=between, name="snow")
    (arrow,) = make_scene(at_rest(model)).arrows
    x0, x1 = between or (0.0, 2.0)
    assert arrow.ends.shape == (1, ROW, 2, 3)
    assert arrow.ends[0, :, 1, 0] == pytest.approx(np.linspace(x0, x1, ROW))
    assert arrow.ends[0, :, 0, 2] == pytest.approx(LONGEST * 2.0)


@pytest.mark.parametrize("moment", [(0, 1, 0), (0, -1, 0), (3, 0, 0), (1, 2, 3), (-1, 0.5, 0)])
def test_a_moment_turns_to_the_right_about_its_axis(moment):
    model = beam(direction=(0.6, 0.8, 0.0))
    model.add_moment("beam.end", moment, name="turn")
    (arrow,) = make_scene(at_rest(model)).arrows
    lines = strokes(arrow, 0)
    end = np.array([1.2, 1.6, 0.0])
    axis = np.array(moment) / np.linalg.norm(moment)
    arc = lines[:-4]  # the last four are the head
    radius = RADIUS * LONGEST * 1.6
    assert np.linalg.norm(arc - end, axis=2) == pytest.approx(np.full(arc.shape[:2], radius))
    assert (arc - end) @ axis == pytest.approx(np.zeros(arc.shape[:2]), abs=1e-12)
    assert np.all(np.cross(arc[:, 0] - end, arc[:, 1] - end) @ axis > 0.0)
    turned = np.linalg.norm(arc[:, 1] - arc[:, 0], axis=1).sum() / radius
    assert turned == pytest.approx(1.5 * np.pi, rel=1e-2)
    assert lines[-4:, 0] == pytest.approx(np.broadcast_to(arc[-1, 1], (4, 3)))


def test_a_moment_across_a_plane_leaves_it_a_plane():
    model = beam()
    model.add_force("beam.end", (0, 0, -1.0))
    model.add_moment("beam.end", (0, 1.0, 0))
    axes = at_rest(model).plot().axes[0]
    assert axes.name != "3d"
    assert axes.get_xlim()[1] > 2.0 + RADIUS * LONGEST * 2.0
    labels = [c.get_label() for c in axes.collections]
    assert {"force", "moment"} <= set(labels)


def test_nothing_is_drawn_of_nothing():
    """No load, one that is zero, a small one beside a large one, a mode."""
    assert make_scene(at_rest(beam())).arrows == []
    model = beam()
    model.add_force("beam.end", (0, 0, 0), name="none")
    assert make_scene(at_rest(model)).arrows == []
    model.add_force("beam.end", (0, 0, 100.0), name="large")
    model.add_force("beam.at(1)", (0, 0, 1.0), name="small")
    assert [arrow.name for arrow in make_scene(at_rest(model)).arrows] == ["large"]
    assert make_scene(ancf.modes(model, about=ancf.equilibrium(model), count=1)).arrows == []


def test_a_zero_in_time_has_no_lines():
    model = beam()
    model.add_force("beam.end", (0, 0, "sin(t)"))
    model.add_moment("beam.end", ("sin(t)", 0, 0))
    for arrow in make_scene(ancf.simulate(model, t_end=0.02, step=0.01)).arrows:
        assert strokes(arrow, 0).shape == (0, 2, 3)
        assert len(strokes(arrow, 1)) > 4
        assert np.isfinite(strokes(arrow, 1)).all()
        assert np.isfinite(arrow.reach).all()


def test_a_function_that_a_file_does_not_hold(tmp_path):
    model = beam()
    model.add_force("beam.end", lambda t: np.array([0.0, 0.0, 1.0]), name="lost")
    model.add_force("beam.end", (0, 1.0, 0), name="kept")
    ancf.simulate(model, t_end=0.02, step=0.01, file=tmp_path / "a.h5")
    assert [arrow.name for arrow in make_scene(ancf.load(tmp_path / "a.h5")).arrows] == ["kept"]


@pytest.mark.parametrize("across", [1.0, 5.0])
def test_a_long_line_is_not_hidden_by_its_arrows(across):
    """Its picture is not to scale: arrows are a part of what it measures across."""
    model = ancf.Model()
    for name, place in {"a": (0, 0, 0), "b": (1000, 0, 0), "c": (500, 0, across)}.items():
        model.add_point_mass(name, at=place, mass=1.0)
        model.add_force(name, (0, 0, -1.0))
    for arrow in make_scene(at_rest(model)).arrows:
        assert 0.1 * across < np.linalg.norm(arrow.ends[0, 0, 1] - arrow.ends[0, 0, 0]) < across


def test_page_and_export_have_them(tmp_path):
    model = beam()
    model.add_force("beam.end", (0, 0, "-3*t"), name="push")
    model.add_distributed_load("beam", (0, 0, -7.0), name="snow")
    model.add_moment("beam.end", (0, "t", 0), name="turn")
    result = ancf.simulate(model, t_end=0.02, step=0.01)
    arrows = {arrow.name: arrow for arrow in make_scene(result).arrows}
    data = data_of(view_page(result))
    groups = {group["kind"]: group for group in data["scene"]["arrows"]}
    assert {kind: group["names"] for kind, group in groups.items()} == {
        "force": ["push"],
        "moment": ["turn"],
        "distributed load": ["snow"],
    }
    for group in groups.values():
        arrow = arrows[group["names"][0]]
        ends = np.broadcast_to(array_of(data, group["ends"]), arrow.ends.shape)
        assert ends == pytest.approx(arrow.ends, abs=1e-6)
        assert group["count"] == [arrow.ends.shape[1]]
        assert group["turns"] == (group["kind"] == "moment")
    assert write_vtk(result, tmp_path / "a.vtkhdf").stat().st_size > 0
