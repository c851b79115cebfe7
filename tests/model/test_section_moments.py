"""Fourth moments of sections: those of rectangles, and what no area has."""

import pytest

from ancf.errors import ModelError
from ancf.model.sections.moments import check_moments, of_similar_rectangle


def rectangle(b, h):
    """Moments of a rectangle, b along y and h along z."""
    return {
        "A": b * h,
        "I_y": b * h**3 / 12,
        "I_z": h * b**3 / 12,
        "I_yyyy": h * b**5 / 80,
        "I_zzzz": b * h**5 / 80,
        "I_yyzz": b**3 * h**3 / 144,
    }


@pytest.mark.parametrize(("b", "h"), [(1.0, 1.0), (0.02, 0.3), (2.0, 0.1)])
def test_of_a_rectangle_are_its_own(b, h):
    own = rectangle(b, h)
    for key in ("I_yyyy", "I_zzzz", "I_yyzz"):
        assert of_similar_rectangle(key, own) == pytest.approx(own[key], rel=1e-14)
    check_moments(own)


@pytest.mark.parametrize(("b", "h"), [(1.0, 1.0), (0.02, 0.3), (2.0, 0.1)])
@pytest.mark.parametrize("key", ["I_yyyy", "I_zzzz", "I_yyzz"])
def test_bounds(key, b, h):
    """Of a quantity y^2 with the mean m its square has at least m^2; products are within both spreads."""
    own = rectangle(b, h)
    A, I_y, I_z = own["A"], own["I_y"], own["I_z"]
    if key == "I_yyzz":
        spread = ((own["I_yyyy"] - I_z**2 / A) * (own["I_zzzz"] - I_y**2 / A)) ** 0.5
        bounds = [I_y * I_z / A - spread, I_y * I_z / A + spread]
    else:
        bounds = [(I_z if key == "I_yyyy" else I_y) ** 2 / A]
        own["I_yyzz"] = I_y * I_z / A
    for k, bound in enumerate(bounds):
        outwards = 1.0 if k else -1.0
        check_moments(own | {key: bound - outwards * 1e-6 * abs(bound)})
        with pytest.raises(ModelError, match=rf"Section\.{key}"):
            check_moments(own | {key: bound + outwards * 1e-6 * abs(bound)})
