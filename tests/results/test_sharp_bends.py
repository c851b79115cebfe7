"""Notes on elements that are too long for the bend they make, and what their number means on the elastica."""

import json

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import brentq

import ancf
from ancf.elements.slopes import vectors_of
from ancf.results import sharp_bends
from ancf.results.sharp_bends import SHARP, bends


def root_curvature(load, towards):
    """Of a clamped elastica of EI = L = 1 that a force pulls towards an angle."""

    def length(end):
        def part(u):
            angles = np.sin(towards - end * (1 - u * u / 2)) * np.sin(end * u * u / 2)
            return 2 * u * end / np.sqrt(max(4 * load * angles, 1e-300))

        return quad(part, 0, 1, limit=500)[0]

    end = brentq(lambda end: length(end) - 1, 1e-6, towards * (1 - 1e-9), xtol=1e-15)
    return np.sqrt(2 * load * (np.cos(end - towards) - np.cos(towards)))


def pulled(load, towards, elements, EA=1e4, EI=1.0, length=1.0, clamped="start"):
    model = ancf.Model()
    section = ancf.Section(EA=EA * EI / length**2, EI=EI, rhoA=1.0)
    ends = [(0, 0, 0), (length, 0, 0)][:: 1 if clamped == "start" else -1]
    beam = model.add_beam("rod", start=ends[0], end=ends[1], elements=elements, section=section)
    model.clamp(beam.start if clamped == "start" else beam.end)
    force = load * EI / length**2
    free = beam.end if clamped == "start" else beam.start
    model.add_force(free, (force * np.cos(towards), 0, force * np.sin(towards)))
    return beam, ancf.equilibrium(model, load_steps=10)


def said(known):
    return [text for text in known.notes if "too sharply" in text]


class TestElastica:
    @pytest.mark.parametrize("towards", [np.pi / 4, np.pi / 2, 3 * np.pi / 4])
    @pytest.mark.parametrize("load", [10.0, 100.0])
    def test_it_is_said_where_moments_are_wrong(self, load, towards):
        """Not where the moment at the clamp is right to 5 %, and where it is more than a tenth too low."""
        wanted = root_curvature(load, towards)
        for elements in (2, 4, 8, 16, 32):
            beam, state = pulled(load, towards, elements)
            curvature = float(np.linalg.norm(state.curvature(beam.start)))
            error = curvature / wanted - 1
            number = curvature / elements
            assert (len(said(state)) == 1) == (number > SHARP)
            if number < 0.5:
                assert abs(error) < 0.05
            if number > 2.0:
                assert error < -0.1

    @pytest.mark.parametrize("length", [0.01, 1.0, 300.0])
    @pytest.mark.parametrize("EI", [1e-4, 1e3])
    @pytest.mark.parametrize("clamped", ["start", "end"])
    def test_the_note_says_where_and_what_to_do(self, length, EI, clamped):
        _, state = pulled(30.0, np.pi / 2, 3, EI=EI, length=length, clamped=clamped)
        [text] = said(state)
        [found] = sharp_bends.sharp_bends(state)
        assert (found.body, found.point, found.t) == ("rod", f"rod.{clamped}", 0.0)
        assert found.element == pytest.approx(length / 3)
        assert found.bend == pytest.approx(1.698, rel=5e-3)
        assert '"rod" bends too sharply' in text
        assert f"take elements of {0.5 * length / 3 / found.bend:.2g} m" in text


class TestWhere:
    @pytest.mark.parametrize("radius", [0.5, 1.0, 20.0])
    def test_an_arc_has_the_angle_of_an_element(self, radius):
        """Hermite elements along a circle: curvature times length is the angle to the fourth order."""
        for elements, angle in ((6, 1.5), (12, 3.0), (5, 0.4)):
            t = np.linspace(0, angle, elements + 1)
            row = np.concatenate(
                [
                    np.stack([radius * np.sin(t), 0 * t, radius * (1 - np.cos(t))], axis=1),
                    np.stack([np.cos(t), 0 * t, np.sin(t)], axis=1),
                ],
                axis=1,
            ).reshape(1, -1)
            slots = np.arange(2 * (elements + 1)).reshape(-1, 2) * 3
            found = bends(vectors_of(radius * t, slots, row))
            assert found == pytest.approx(angle / elements, rel=(angle / elements) ** 2 / 6)

    def test_cables_without_bending_stiffness_have_no_moment(self):
        for EI, count in ((0.0, 0), (1e-3, 1)):
            model = ancf.Model()
            section = ancf.Section(EA=1e4, EI=EI, rhoA=1.0)
            path = [(0, 0, 0), (1, 0, 0.1), (1.1, 0, 1.0), (0.2, 0, 1.2)]
            model.add_beam("loop", path=path, elements=3, section=section)
            state = ancf.simulate(model, t_end=1e-5, step=1e-6).state(0)
            assert len(said(state)) == count

    @pytest.mark.parametrize(("cables", "notes"), [(1, 1), (3, 3), (7, 4)])
    @pytest.mark.parametrize("most", [500_000, 40])
    def test_many_cables_over_time(self, cables, notes, most, monkeypatch, tmp_path):
        """Each once, the sharpest first; a long history is looked at in parts and every so many states."""
        monkeypatch.setattr(sharp_bends, "MOST", most)
        monkeypatch.setattr(sharp_bends, "CHUNK", 25)
        model = ancf.Model()
        section = ancf.Section(EA=1e4, EI=1e-2, rhoA=1.0, damping=5.0)
        for k in range(cables):
            # a quarter of a circle that springs open
            angle = np.linspace(0, np.pi / 2, 9)
            path = np.stack([np.sin(angle), 0 * angle + k, (1 + 0.02 * k) * (1 - np.cos(angle))], axis=1)
            model.add_beam(f"c{k}", path=path, elements=1, section=section, natural_shape="straight")
        result = ancf.simulate(model, t_end=0.2, step=1e-2)
        found = sharp_bends.sharp_bends(result)
        assert len(found) == cables
        assert [item.bend for item in found] == sorted((item.bend for item in found), reverse=True)
        texts = sharp_bends.notes(found)
        assert len(texts) == notes
        result.save(tmp_path / "a.h5")
        assert [text for text in ancf.load(tmp_path / "a.h5").notes if "sharply" in text] == texts


@pytest.mark.parametrize("still", [True, False])
def test_summaries_of_commands_say_it_once(call, tmp_path, still):
    text = """
gravity = [0, 0, -9.81]
[[bodies]]
name = "rod"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 2
section = { EA = 1e4, EI = 0.01, rhoA = 0.1, damping = 1.0 }
[[supports]]
type = "clamp"
point = "rod.start"
"""
    more = "[equilibrium]\n" if still else '[simulation]\nt_end = 0.1\nstep = 1e-3\nstart = "equilibrium"\n'
    (tmp_path / "model.toml").write_text(text + more, "utf-8")
    assert call("run", tmp_path / "model.toml", "-o", tmp_path / "out").code == 0
    notes = json.loads((tmp_path / "out" / "summary.json").read_text("utf-8"))["notes"]
    assert len([note for note in notes if "too sharply" in note]) == 1
