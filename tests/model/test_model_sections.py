"""Sections of a material: their moments, torsion constants and what is wrong with them."""

import json
import math

import numpy as np
import pytest

from ancf.errors import ModelError
from ancf.model import Section, describe
from refusals import refused

WIRE = {"EA": 1e4, "EI": 0.08, "rhoA": 0.05}
STEEL = {"E": 2.1e11, "rho": 7850.0, "nu": 0.3}
MOMENTS = {"A": 2e-4, "I_y": 4e-9, "I_z": 1e-9, "J": 2e-9}
NAN, INF = float("nan"), float("inf")


def integrals(y, z, weight):
    """All moments by summing over points of an area."""
    return {
        "A": weight.sum(),
        "I_y": (weight * z**2).sum(),
        "I_z": (weight * y**2).sum(),
        "I_yyyy": (weight * y**4).sum(),
        "I_zzzz": (weight * z**4).sum(),
        "I_yyzz": (weight * y**2 * z**2).sum(),
    }


class TestMoments:
    def check(self, section, wanted):
        for key, value in wanted.items():
            assert getattr(section, key) == pytest.approx(value, rel=1e-12), key

    def test_rectangle(self):
        x, w = np.polynomial.legendre.leggauss(4)
        y, z = np.meshgrid(0.015 * x, 0.04 * x)
        wanted = integrals(y, z, 0.015 * 0.04 * np.outer(w, w))
        self.check(Section.rectangle(width=0.03, height=0.08, **STEEL), wanted)

    def test_circle(self):
        x, w = np.polynomial.legendre.leggauss(6)
        radius, angle = np.meshgrid(0.01 * (1 + x), 2 * np.pi * np.arange(16) / 16)
        weight = radius * 0.01 * w * 2 * np.pi / 16
        wanted = integrals(radius * np.cos(angle), radius * np.sin(angle), weight)
        self.check(Section.circle(diameter=0.04, **STEEL), wanted)

    def test_stiffnesses(self):
        s = Section.from_moments(**MOMENTS, **STEEL)
        assert s.shape is None
        assert s.shear_factors == (1.0, 1.0)
        assert pytest.approx(2.1e11 * 2e-4) == s.EA
        assert (s.EI_y, s.EI_z) == (pytest.approx(840.0), pytest.approx(210.0))
        assert (s.rhoA, s.J) == (pytest.approx(1.57), 2e-9)
        assert pytest.approx(2.1e11 / 2.6) == s.G

    def test_defaults_are_those_of_a_rectangle(self):
        r = Section.rectangle(width=0.03, height=0.08, **STEEL)
        s = Section.from_moments(A=r.A, I_y=r.I_y, I_z=r.I_z, J=r.J, **STEEL)
        self.check(s, {key: getattr(r, key) for key in ("I_yyyy", "I_zzzz", "I_yyzz", "J", "EA", "G")})
        given = {"I_yyyy": 2.0, "I_zzzz": 4.0, "I_yyzz": 0.5}
        s = Section.from_moments(A=1, I_y=1, I_z=1, J=1, **STEEL, **given)
        self.check(s, given)

    def test_fourth_moments_of_real_areas_are_accepted(self):
        """Also where an inequality is an equality: all of the area in four points."""
        for s in (SECTIONS["rectangle"], SECTIONS["circle"]):
            keys = ("A", "I_y", "I_z", "J", "I_yyyy", "I_zzzz", "I_yyzz", "E", "rho", "nu")
            given = {key: getattr(s, key) for key in keys}
            assert Section.from_moments(**given).I_yyzz == s.I_yyzz
        Section.from_moments(
            A=4, I_y=0.01, I_z=0.04, J=0.01, I_yyyy=0.0004, I_zzzz=0.000025, I_yyzz=0.0001, **STEEL
        )

    def test_none_without_a_material(self):
        s = Section(**WIRE)
        keys = ("A", "I_y", "I_z", "J", "I_yyyy", "I_zzzz", "I_yyzz", "shear_factors", "G", "E", "nu", "rho")
        assert [getattr(s, key) for key in keys] == [None] * len(keys)

    def test_given_torsion_and_shear(self):
        for s in (
            Section.rectangle(0.01, 0.02, 1e9, 1e3, J=3e-10, shear_factors=(0.8, 0.9)),
            Section.circle(0.01, 1e9, 1e3, J=3e-10, shear_factors=[0.8, 0.9]),
            Section.from_moments(**MOMENTS | {"J": 3e-10}, **STEEL, shear_factors=np.array([0.8, 0.9])),
        ):
            assert (s.J, s.shear_factors) == (3e-10, (0.8, 0.9))
            assert hash(s) is not None


def torsion_series(a, b, terms):
    """The same constant by the plain series along either side, which converges differently for each."""
    n = np.arange(1, 2 * terms, 2)
    total = np.sum(np.tanh(n * np.pi * a / (2 * b)) / n**5.0)
    return a * b**3 / 3 * (1 - 192 * b / (np.pi**5 * a) * total)


class TestTorsion:
    @pytest.mark.parametrize("ratio", [1.0, 1.3, 2.0, 4.0])
    def test_rectangle_by_the_other_series(self, ratio):
        """Along the short side the tanh is not 1: nothing is shared but the differential equation."""
        for width, height in ((0.02, 0.02 * ratio), (0.02 * ratio, 0.02)):
            J = Section.rectangle(width, height, 1.0, 1.0).J
            assert pytest.approx(torsion_series(0.02, 0.02 * ratio, 3000), rel=1e-11) == J
            assert pytest.approx(torsion_series(0.02 * ratio, 0.02, 3000), rel=1e-13) == J

    def test_known_values(self):
        # Timoshenko and Goodier, table of k_1; the strip is a b^3/3 (1 - 0.630 b/a)
        for ratio, k in ((1.0, 0.1406), (1.5, 0.196), (2.0, 0.229), (5.0, 0.291), (10.0, 0.312)):
            assert Section.rectangle(ratio, 1.0, 1.0, 1.0).J / ratio == pytest.approx(k, abs=1.0e-3)
        thin = Section.rectangle(1.0, 1e-6, 1.0, 1.0)
        assert pytest.approx(1e-18 / 3 * (1 - 0.63025e-6), rel=1e-9) == thin.J

    def test_never_above_the_polar_moment(self):
        for width in np.geomspace(1e-3, 1e3, 13):
            s = Section.rectangle(width, 1.0, 1.0, 1.0)
            assert 0.0 < s.J < 0.85 * (s.I_y + s.I_z)
        s = Section.circle(0.3, 1.0, 1.0)
        assert pytest.approx(s.I_y + s.I_z) == s.J == pytest.approx(math.pi * 0.3**4 / 32)


class TestBad:
    @pytest.mark.parametrize(
        ("changes", "key", "phrase"),
        [
            ({"A": 0}, "A", "must be > 0, is 0"),
            ({"I_y": -1.0}, "I_y", "must be > 0, is -1"),
            ({"I_z": "1"}, "I_z", "must be a number"),
            ({"J": NAN}, "J", "finite"),
            ({"J": 0}, "J", "must be > 0"),
            ({"E": 0}, "E", "must be > 0"),
            ({"rho": None}, "rho", "must be a number"),
            ({"nu": 0.5}, "nu", "must be > -1 and < 0.5"),
            ({"nu": -1.0}, "nu", "must be > -1 and < 0.5"),
            ({"I_yyyy": 0.0}, "I_yyyy", "must be > 0"),
            ({"I_yyzz": INF}, "I_yyzz", "finite"),
            ({"I_yyyy": 0.99 * 1e-18 / 2e-4}, "I_yyyy", "must be >= I_z^2/A = 5e-15 m^6 for any area"),
            ({"I_zzzz": 0.99 * 16e-18 / 2e-4}, "I_zzzz", "must be >= I_y^2/A = 8e-14 m^6"),
            ({"I_yyzz": 3.7e-14}, "I_yyzz", "must be I_y I_z/A = 2e-14 within 1.6e-14 m^6"),
            ({"I_yyzz": 3e-15}, "I_yyzz", "within 1.6e-14 m^6 for any area"),
            ({"shear_factors": (1.0,)}, "shear_factors", "has shape (1,), wanted (2,)"),
            ({"shear_factors": 0.8}, "shear_factors", "list of numbers"),
            ({"shear_factors": (1, 0)}, "shear_factors[1]", "must be > 0"),
            ({"shear_factors": (NAN, 1)}, "shear_factors[0]", "finite"),
            ({"damping": -1}, "damping", "must be >= 0"),
            ({"A": 1e300, "I_y": 1.0, "I_z": 1.0}, "EA", "finite"),
            ({"A": 1e-300, "I_y": 1e100, "I_z": 1e100}, "I_yyyy", "finite"),
        ],
    )
    def test_from_moments(self, changes, key, phrase):
        refused(f"Section.{key}", phrase, lambda: Section.from_moments(**MOMENTS | STEEL | changes))

    @pytest.mark.parametrize("make", [Section.rectangle, Section.circle])
    @pytest.mark.parametrize(
        ("changes", "key"),
        [
            ({"J": 0}, "J"),
            ({"J": "1"}, "J"),
            ({"shear_factors": (1, 1, 1)}, "shear_factors"),
            ({"nu": 1}, "nu"),
        ],
    )
    def test_of_a_shape(self, make, changes, key):
        size = {"diameter": 0.1} if make == Section.circle else {"width": 0.1, "height": 0.2}
        refused(f"Section.{key}", "", lambda: make(**size | STEEL | changes))

    @pytest.mark.parametrize("size", [1e-300, 1e-110, 1e80, 1e200, 1e308])
    def test_absurd_sizes(self, size):
        for make in (
            lambda: Section.circle(size, **STEEL),
            lambda: Section.rectangle(size, 1.0, **STEEL),
            lambda: Section.rectangle(1.0, size, **STEEL),
            lambda: Section.rectangle(size, size, **STEEL),
        ):
            with pytest.raises(ModelError, match=r"Section\.\w+: must be (> 0|a finite number)"):
                make()

    @pytest.mark.parametrize("size", [1e-40, 1e40])
    def test_large_and_small_sizes(self, size):
        s = Section.rectangle(size, size, **STEEL)
        assert pytest.approx(0.140577 * size**4, rel=1e-5) == s.J
        assert pytest.approx(size**6 / 80) == s.I_yyyy


SECTIONS = {
    "direct": Section(**WIRE, damping=0.1, axial_damping=0.2, bending_damping=0.3),
    "rectangle": Section.rectangle(0.01, 0.03, 1e8, 500.0, 0.3, J=1e-9, bending_damping=0.1),
    "circle": Section.circle(0.02, **STEEL, shear_factors=(0.9, 0.9)),
    "moments": Section.from_moments(**MOMENTS, **STEEL, I_yyzz=3e-14, axial_damping=2.0),
}


@pytest.mark.parametrize("kind", SECTIONS)
def test_description_gives_the_section_back(kind):
    section = SECTIONS[kind]
    plain = json.loads(json.dumps(describe.section(section)))
    assert plain.get("shape", "direct") == kind
    assert describe.section_of(plain) == section
    assert ("J" in plain) == (kind != "direct")
