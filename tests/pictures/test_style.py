"""The style of figures: colours that survive a grey copy and colour blindness, in one place."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
from matplotlib.colors import to_rgb

import ancf
from ancf.viz import style
from ancf.viz.pictures.questions import QUANTITIES
from ancf.viz.scene import QUANTITIES as ALONG
from ancf.viz.scene import make_scene

ROOT = Path(ancf.__file__).parent

#: Colour vision without one kind of cones, on linear RGB: Machado, Oliveira, Fernandes (2009), severity 1.
DEFICIENCIES = {
    "none": np.eye(3),
    "protanopia": np.array(
        [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]
    ),
    "deuteranopia": np.array(
        [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]
    ),
}
#: From linear sRGB to CIE XYZ (IEC 61966-2-1).
TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
APART = 20.0  # CIE 1976 difference of two colours of curves
NOTICED = 2.3  # the difference that is just noticeable


def linear(color):
    c = np.array(to_rgb(color))
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


def lab(rgb):
    """CIE L*a*b* of linear RGB under daylight."""
    v = TO_XYZ @ np.clip(rgb, 0, 1) / TO_XYZ.sum(axis=1)
    f = np.where(v > 216 / 24389, np.cbrt(v), (24389 / 27 * v + 16) / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def lightness(color):
    return lab(linear(color))[0]


class TestMeasure:
    def test_known_colours(self):
        """Values of sRGB's corners from the literature."""
        assert lightness("white") == pytest.approx(100.0, abs=1e-3)
        assert lab(linear("#ff0000")) == pytest.approx([53.24, 80.09, 67.20], abs=0.02)
        assert lab(linear("#0000ff")) == pytest.approx([32.30, 79.19, -107.86], abs=0.02)

    def test_red_and_green_meet_without_red_cones(self):
        """The measure sees what it is there for: two colours far apart that a colour-blind eye confuses."""
        pair = linear("#b05000"), linear("#6b7000")
        seen = [np.linalg.norm(np.subtract(*(lab(m @ c) for c in pair))) for m in DEFICIENCIES.values()]
        assert seen[0] > 35
        assert min(seen[1:]) < 0.4 * seen[0]


class TestCurves:
    @pytest.mark.parametrize("deficiency", DEFICIENCIES)
    def test_colours_stay_apart(self, deficiency):
        matrix = DEFICIENCIES[deficiency]
        for one, two in itertools.combinations(style.LOOKS, 2):
            difference = np.linalg.norm(lab(matrix @ linear(one.color)) - lab(matrix @ linear(two.color)))
            assert difference > APART, (one.color, two.color)

    def test_grey_copy(self):
        """Without colour two curves differ in lightness or in line, and always in marker."""
        for one, two in itertools.combinations(style.LOOKS, 2):
            assert one.marker != two.marker
            assert one.line != two.line or abs(lightness(one.color) - lightness(two.color)) > 15

    def test_visible_on_white(self):
        for found in (*style.LOOKS, style.Look(style.GREY, "-", "")):
            assert lightness(found.color) < 75

    def test_after_one_round_looks_are_new(self):
        count = len(style.LOOKS)
        looks = [style.look(k) for k in range(count * count)]
        assert len(set(looks)) == count * count
        assert looks[:count] == list(style.LOOKS)
        assert style.line(1) == {"color": style.ORANGE, "linestyle": "--"}


class TestMap:
    def test_lightness_rises_evenly(self):
        light = np.array([lightness(color) for color in style.colormap()(np.linspace(0, 1, 65))])
        step = np.diff(light)
        assert np.all(step > 0)
        assert step.max() < 3 * step.mean()
        assert light[-1] - light[0] > 55
        assert light[-1] < 80  # a thin line on white

    @pytest.mark.parametrize("deficiency", DEFICIENCIES)
    def test_stops_stay_apart(self, deficiency):
        matrix = DEFICIENCIES[deficiency]
        stops = [lab(matrix @ linear(color)) for color in style.SEQUENTIAL]
        assert min(np.linalg.norm(a - b) for a, b in itertools.pairwise(stops)) > 1.5 * NOTICED


class TestLabels:
    def test_units(self):
        assert style.axis_label("tension") == "tension [N]"
        assert style.axis_label("bending_moment") == "bending moment [N m]"
        assert style.axis_label("velocity", "z") == "velocity z [m/s]"
        assert style.axis_label("strain") == "strain [-]"
        assert style.axis_label("my label") == "my label"

    def test_every_quantity_has_one(self):
        assert {*QUANTITIES, *ALONG, "t", "energy"} <= set(style.UNITS)
        for name, unit in ALONG.items():
            assert style.UNITS[name] == unit


class TestOnePlace:
    def test_no_colours_elsewhere(self):
        """No module but style.py has a colour of its own or sets what matplotlib draws with."""
        pattern = re.compile(r"[\"']#[0-9a-fA-F]{6}[\"']|rcParams|rc_context|[\"']C\d[\"']")
        wrong = [
            f"{path.relative_to(ROOT)}: {line.strip()}"
            for path in ROOT.rglob("*.py")
            if path != ROOT / "viz" / "style.py"
            for line in path.read_text(encoding="utf-8").splitlines()
            if pattern.search(line)
        ]
        assert not wrong

    def test_figure_has_its_size_and_font(self):
        with style.new_figure(85, 60) as figure:
            axes = figure.subplots()
            axes.plot([0, 1], [0, 1], **style.line(0))
            axes.set_xlabel(style.axis_label("t"))
        assert figure.get_size_inches() * 25.4 == pytest.approx([85, 60])
        assert axes.xaxis.label.get_fontsize() == 8
        assert style.png(figure, dpi=50)[:4] == b"\x89PNG"

    def test_svg_is_the_same_every_time(self):
        def made():
            with style.new_figure(40, 30) as figure:
                figure.subplots().plot([0, 1], [1, 0])
                return style.svg(figure)

        assert made() == made()
        assert "<text" not in made()

    def test_missing_matplotlib(self, monkeypatch):
        monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
        with pytest.raises(
            ancf.ModelError, match=r"matplotlib is not installed \(pip install 'ancf\[plot\]'\)"
        ):
            style.require_matplotlib()


def test_scene_needs_no_matplotlib(monkeypatch):
    """What is drawn is gathered without the library that draws."""
    monkeypatch.setitem(__import__("sys").modules, "matplotlib", None)
    with pytest.raises(ancf.ModelError, match="must be a Result"):
        make_scene(3)
