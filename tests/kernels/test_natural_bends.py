"""Natural curvature of cables: that of the natural shape, and none where it is round-off."""

import numpy as np
import pytest

import ancf
from ancf.elements.cable_build import STRAIGHT, reference_strains


def bent(path, elements, strain="material"):
    model = ancf.Model()
    section = ancf.Section(EA=1e6, EI=1e-3, rhoA=2.0)
    return model.add_beam("rope", path=path, elements=elements, section=section, strain=strain)


def over_a_drum(radius, straight, points):
    """A straight piece, half a circle and a straight piece, in points at about the same distance."""
    arc = np.linspace(0.0, np.pi, points)
    down = np.linspace(-straight, 0.0, points, endpoint=False)
    left = np.stack([np.full(points, radius), 0.0 * down, down], axis=1)
    over = np.stack([radius * np.cos(arc), 0.0 * arc, radius * np.sin(arc)], axis=1)
    right = np.stack([np.full(points, -radius), 0.0 * down, down[::-1]], axis=1)
    return np.concatenate([left, over, right])


@pytest.mark.parametrize("strain", ["material", "paper"])
@pytest.mark.parametrize(("radius", "straight", "points"), [(0.2, 0.5, 40), (0.05, 1.0, 60), (3.0, 9.0, 50)])
def test_straight_pieces_beside_a_bend(radius, straight, points, strain):
    """A spline leaves a share of 0.27 from point to point: gone before the end; the arc is there."""
    rope = bent(over_a_drum(radius, straight, points), 3 * points, strain)
    _, kappa0 = reference_strains(rope)
    h = np.diff(rope.node_x)[:, None]
    assert np.all((kappa0 == 0.0) | (kappa0 * h >= STRAIGHT))
    assert np.all(kappa0[: points // 2] == 0.0)
    assert np.all(kappa0[-points // 2 :] == 0.0)
    middle = np.abs(rope.node_x[:-1] - 0.5 * rope.length) < 0.8 * radius
    assert kappa0[middle][:, :3] == pytest.approx(np.full((middle.sum(), 3), 1.0 / radius), rel=5e-3)


@pytest.mark.parametrize(("radius", "elements"), [(1e3, 1000), (1e5, 100), (1e6, 10)])
def test_a_slight_bend_of_short_elements_stays(radius, elements):
    angle = np.linspace(0.0, 1.0 / radius, 5)
    path = np.stack([radius * np.sin(angle), 0.0 * angle, radius * (1.0 - np.cos(angle))], axis=1)
    _, kappa0 = reference_strains(bent(path, elements))
    assert kappa0[:, :3] == pytest.approx(np.full((elements, 3), 1.0 / radius), rel=2e-2)
