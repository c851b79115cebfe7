"""Parts of pictures and pages that need no model: places, corners, planes, numbers in a page."""

import base64

import numpy as np
import pytest

import ancf
from ancf.viz.pictures.projection import best_axes
from ancf.viz.scene.sampling import corners, places
from ancf.viz.view.encode import Numbers


def beam():
    model = ancf.Model()
    section = ancf.Section(EA=1.0, EI=1.0, rhoA=1.0)
    return model.add_beam("beam", start=(0, 0, 0), end=(4, 0, 0), nodes=(0, 1, 2.5, 4), section=section)


def test_places_divide_each_element_evenly():
    assert places(beam(), 2.0) == pytest.approx([0, 0.5, 1, 1.75, 2.5, 3.25, 4])
    assert places(beam(), 1.0) == pytest.approx([0, 1, 2.5, 4])
    assert places(beam(), 0.5).tolist()[:: len(places(beam(), 0.5)) - 1] == [0, 4]


def test_corners_have_the_moments_of_the_section():
    """The polygon's own area and moments, by its corners."""
    given = {"E": 1.0, "rho": 1.0}
    moments = {"A": 0.06, "I_y": 2e-4, "I_z": 4.5e-4, "J": 5e-4}
    for section in (ancf.Section.rectangle(0.3, 0.2, **given), ancf.Section.from_moments(**moments, **given)):
        y, z = corners(section)
        width, height = np.ptp(y), np.ptp(z)
        assert width * height == pytest.approx(section.A, rel=1e-12)
        assert width * height**3 / 12 == pytest.approx(section.I_y, rel=1e-12)
        assert height * width**3 / 12 == pytest.approx(section.I_z, rel=1e-12)
    y, z = corners(ancf.Section.circle(0.3, **given))
    assert np.hypot(y, z) == pytest.approx(np.full(y.size, 0.15))


@pytest.mark.parametrize(
    ("extent", "axes"),
    [
        ((1.0, 0.0, 1.0), (0, 2)),
        ((1.0, 2.0, 0.0), (0, 1)),
        ((0.0, 0.0, 3.0), (0, 2)),
        ((0.0, 3.0, 0.0), (1, 2)),
        ((1.0, 1.0, 1.0), (0, 1, 2)),
        ((0.0, 0.0, 0.0), (0, 2)),
    ],
)
def test_plane_of_a_motion(extent, axes):
    assert best_axes(np.array(extent)) == axes


class TestNumbers:
    def test_each_array_is_found_again(self):
        """Shares of 1/65535 of the range, 32-bit numbers; every one starts at a multiple of four bytes."""
        numbers, rng = Numbers(), np.random.default_rng(1)
        arrays = [rng.normal(size=shape) for shape in ((3,), (5, 3), (7, 3, 3), (1,), (9, 1))]
        plain = [(numbers.shares(x), numbers.floats(x)) for x in arrays]
        data = base64.b64decode(numbers.text())
        for x, (share, whole) in zip(arrays, plain, strict=True):
            assert share["at"] % 4 == whole["at"] % 4 == 0
            low, high = share["low"], share["high"]
            found = np.frombuffer(data, "<u2", x.size, share["at"]).reshape(share["shape"]) / 65535.0
            assert low + found * (high - low) == pytest.approx(x, abs=(high - low) / 65535.0)
            assert np.frombuffer(data, "<f4", x.size, whole["at"]).reshape(whole["shape"]) == pytest.approx(x)

    def test_extremes_are_kept(self):
        numbers = Numbers()
        plain = numbers.shares(np.array([2.0, -1.0, 5.0]))
        assert np.frombuffer(base64.b64decode(numbers.text()), "<u2", 3).tolist() == [32768, 0, 65535]
        assert (plain["low"], plain["high"]) == (-1.0, 5.0)

    def test_what_rests_is_kept_once_and_what_moves_is_not(self):
        numbers = Numbers()
        rests, moves = np.tile([1.0, 2.0], (4, 1)), np.arange(8.0).reshape(4, 2)
        assert numbers.floats(rests)["shape"] == [1, 2]
        assert numbers.floats(moves)["shape"] == [4, 2]
        assert numbers.floats(moves)["at"] == numbers.floats(moves)["at"] == 8
