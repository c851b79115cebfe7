"""Cross-section: stiffnesses, mass and damping of a beam, given directly or from a shape and a material."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from ...errors import ModelError
from .. import checks
from ..tables import Readable, Sheet
from ..told import Told
from .fluid import in_fluid
from .inertia import rotary
from .moments import check_moments, of_similar_rectangle
from .shapes import Circle, Rectangle
from .sheet import of_section

__all__ = ["MATERIAL", "Circle", "Rectangle", "Section"]

#: What a section of a material has and Section(EA=, EI=, rhoA=) has not.
MATERIAL = ("A", "I_y", "I_z", "J", "E", "nu", "rho")
FOURTH_MOMENTS = ("I_yyyy", "I_zzzz", "I_yyzz")
#: Keywords of ``Section.from_moments`` that are integrals over the area.
MOMENTS = ("A", "I_y", "I_z", "J", *FOURTH_MOMENTS)
DAMPINGS = ("damping", "axial_damping", "bending_damping", "slope_damping")


@dataclass(frozen=True, slots=True, init=False)
class Section(Readable, metaclass=Told):
    """Stiffnesses, mass and damping per length of a beam; every argument by keyword.

    ``Section(EA=, EI=, rhoA=)`` is enough for a cable. The two beams need a section of a material:
    ``Section.rectangle``, ``Section.circle`` or ``Section.from_moments``.

    Parameters
    ----------
    EA : float
        Axial stiffness, N, > 0.
    EI : float
        Bending stiffness, N m^2, >= 0.
    rhoA : float
        Mass per length, kg/m, > 0.
    damping : float
        External viscous force per length and velocity, N s/m^2, >= 0.
    axial_damping : float
        Kelvin-Voigt, N s: ``N = EA eps + axial_damping d eps/dt``.
    bending_damping : float
        Kelvin-Voigt, N m^2 s: ``M = EI kappa + bending_damping d kappa/dt``.
    slope_damping : float
        Force per length ``d/dx(slope_damping dv/dx)``, N s, of cables only: what is proportional to the
        stiffness that a wire has from its tension T is ``beta T``. It is not objective: a cable that
        turns as a whole is damped too.
    diameter : float
        Outer diameter in a fluid and on the ground, m; of a circle its own.
    drag, added_mass : (float, float)
        Coefficients normal to the axis and along it, >= 0, see :meth:`ancf.Model.add_fluid`.
    rotary_inertia : float or (float, float)
        Moments of inertia of a section per length about local y and z, kg m, > 0. A cable has none by
        default, and one about all axes across it; it counts the rate of the whole slope r_x, and so
        also that of the stretch. A beam of a material has rho I_y and rho I_z by default.

    Attributes
    ----------
    EI_y, EI_z : float
        Bending stiffnesses about local y and z, N m^2.
    shape : Rectangle, Circle or None
    E, nu, rho : float or None
        Young's modulus, N/m^2, Poisson's ratio, density, kg/m^3.
    A : float or None
        Area, m^2.
    I_y, I_z : float or None
        Integrals of z^2 and of y^2 over the area, m^4.
    J : float or None
        Saint-Venant's torsion constant, m^4, for ``poisson = "centreline"``.
    I_yyyy, I_zzzz, I_yyzz : float or None
        Integrals of y^4, z^4 and y^2 z^2 over the area, m^6.
    shear_factors : (float, float) or None
        Factors k_y, k_z of the shear stiffnesses ``k_y G A`` along local y and ``k_z G A`` along z,
        for ``poisson = "centreline"``.

    Raises
    ------
    ModelError
        A value is no finite number or out of range; ``where`` is ``Section.EA`` and so on.

    Notes
    -----
    What belongs to a material is None for a section given by its stiffnesses.

    """

    EA: float
    EI_y: float
    EI_z: float
    rhoA: float
    damping: float
    axial_damping: float
    bending_damping: float
    slope_damping: float
    shape: Rectangle | Circle | None
    E: float | None
    nu: float | None
    rho: float | None
    A: float | None
    I_y: float | None
    I_z: float | None
    J: float | None
    I_yyyy: float | None
    I_zzzz: float | None
    I_yyzz: float | None
    shear_factors: tuple[float, float] | None
    diameter: float | None
    drag: tuple[float, float] | None
    added_mass: tuple[float, float] | None
    rotary_inertia: tuple[float, float] | None

    def __init__(
        self,
        *,
        EA: float,
        EI: float,
        rhoA: float,
        damping: float = 0.0,
        axial_damping: float = 0.0,
        bending_damping: float = 0.0,
        slope_damping: float = 0.0,
        diameter: float | None = None,
        drag: tuple[float, float] | None = None,
        added_mass: tuple[float, float] | None = None,
        rotary_inertia: float | tuple[float, float] | None = None,
    ) -> None:
        stiffness = checks.non_negative(EI, "Section.EI")
        _fill(
            self,
            EA=checks.positive(EA, "Section.EA"),
            EI_y=stiffness,
            EI_z=stiffness,
            rhoA=checks.positive(rhoA, "Section.rhoA"),
            **_dampings(damping, axial_damping, bending_damping, slope_damping),
            **in_fluid(diameter, drag, added_mass),
            **rotary(rotary_inertia),
        )

    @classmethod
    def rectangle(
        cls,
        width: float,
        height: float,
        E: float,
        rho: float,
        nu: float = 0.0,
        *,
        J: float | None = None,
        shear_factors: tuple[float, float] = (1.0, 1.0),
        damping: float = 0.0,
        axial_damping: float = 0.0,
        bending_damping: float = 0.0,
        slope_damping: float = 0.0,
        diameter: float | None = None,
        drag: tuple[float, float] | None = None,
        added_mass: tuple[float, float] | None = None,
        rotary_inertia: float | tuple[float, float] | None = None,
    ) -> Section:
        """Rectangle of a material.

        Parameters
        ----------
        width, height : float, m
            Along local y and along local z.
        E, rho, nu : float
            Young's modulus, N/m^2, density, kg/m^3, Poisson's ratio.
        J : float, m^4
            Torsion constant; default Saint-Venant's exact one.
        shear_factors : (float, float)
            Of the shear stiffnesses along local y and z; 5/6 for a rectangle in most textbooks.
        damping, axial_damping, bending_damping, slope_damping : float
        diameter, drag, added_mass, rotary_inertia
            As for ``Section``.

        """
        b, h = checks.positive(width, "Section.width"), checks.positive(height, "Section.height")
        dampings = _dampings(damping, axial_damping, bending_damping, slope_damping)
        dampings |= in_fluid(diameter, drag, added_mass) | rotary(rotary_inertia)
        return _of_shape(Rectangle(b, h), E, rho, nu, J, shear_factors, dampings)

    @classmethod
    def circle(
        cls,
        diameter: float,
        E: float,
        rho: float,
        nu: float = 0.0,
        *,
        J: float | None = None,
        shear_factors: tuple[float, float] = (1.0, 1.0),
        damping: float = 0.0,
        axial_damping: float = 0.0,
        bending_damping: float = 0.0,
        slope_damping: float = 0.0,
        drag: tuple[float, float] | None = None,
        added_mass: tuple[float, float] | None = None,
        rotary_inertia: float | tuple[float, float] | None = None,
    ) -> Section:
        """Full circle of a material.

        Parameters
        ----------
        diameter : float, m
        E, rho, nu : float
            Young's modulus, N/m^2, density, kg/m^3, Poisson's ratio.
        J : float, m^4
            Torsion constant; default pi diameter^4/32.
        shear_factors : (float, float)
            Of the shear stiffnesses along local y and z; 9/10 for a circle in most textbooks.
        damping, axial_damping, bending_damping, slope_damping : float
        drag, added_mass, rotary_inertia
            As for ``Section``.

        """
        shape = Circle(checks.positive(diameter, "Section.diameter"))
        dampings = _dampings(damping, axial_damping, bending_damping, slope_damping)
        dampings |= in_fluid(diameter, drag, added_mass) | rotary(rotary_inertia)
        return _of_shape(shape, E, rho, nu, J, shear_factors, dampings)

    @classmethod
    def from_moments(
        cls,
        *,
        A: float,
        I_y: float,
        I_z: float,
        J: float,
        E: float,
        rho: float,
        nu: float = 0.0,
        I_yyyy: float | None = None,
        I_zzzz: float | None = None,
        I_yyzz: float | None = None,
        shear_factors: tuple[float, float] = (1.0, 1.0),
        damping: float = 0.0,
        axial_damping: float = 0.0,
        bending_damping: float = 0.0,
        slope_damping: float = 0.0,
        diameter: float | None = None,
        drag: tuple[float, float] | None = None,
        added_mass: tuple[float, float] | None = None,
        rotary_inertia: float | tuple[float, float] | None = None,
    ) -> Section:
        """Section of any shape with two axes of symmetry, from the integrals over its area.

        Parameters
        ----------
        A : float, m^2
            Area.
        I_y, I_z : float, m^4
            Integrals of z^2 and of y^2.
        J : float, m^4
            Torsion constant.
        E, rho, nu : float
            Young's modulus, N/m^2, density, kg/m^3, Poisson's ratio.
        I_yyyy, I_zzzz, I_yyzz : float, m^6
            Integrals of y^4, z^4, y^2 z^2; they count where bending is strong. By default those of a
            rectangle whose radii of gyration are the same: ``height^2 = 12 I_y/A``,
            ``width^2 = 12 I_z/A``, which makes them 1.8 I_z^2/A, 1.8 I_y^2/A and I_y I_z/A.
        shear_factors : (float, float)
            Of the shear stiffnesses along local y and z.
        damping, axial_damping, bending_damping, slope_damping : float
        diameter, drag, added_mass, rotary_inertia
            As for ``Section``.

        Raises
        ------
        ModelError
            A value is out of range, or no area has such moments.

        """
        given = {"A": A, "I_y": I_y, "I_z": I_z}
        moments = {key: checks.positive(value, f"Section.{key}") for key, value in given.items()}
        for key, value in zip(FOURTH_MOMENTS, (I_yyyy, I_zzzz, I_yyzz), strict=True):
            default = of_similar_rectangle(key, moments)
            moments[key] = checks.positive(default if value is None else value, f"Section.{key}")
        check_moments(moments)
        torsion = checks.positive(J, "Section.J")
        dampings = _dampings(damping, axial_damping, bending_damping, slope_damping)
        dampings |= in_fluid(diameter, drag, added_mass) | rotary(rotary_inertia)
        return _of_material(None, moments, torsion, E, rho, nu, shear_factors, dampings)

    @property
    def EI(self) -> float:
        """Bending stiffness of a cable, N m^2, the same about every axis (paper, eq. 24).

        Raises
        ------
        ModelError
            The two bending stiffnesses of the shape differ.

        """
        if abs(self.EI_y - self.EI_z) > 1e-9 * max(self.EI_y, self.EI_z):
            raise ModelError(
                "Section.EI",
                f"a cable has one bending stiffness, this shape has EI_y = {self.EI_y:g} and "
                f"EI_z = {self.EI_z:g} N m^2",
                "give Section(EA=, EI=, rhoA=) directly with the EI of the plane in which it bends",
            )
        return self.EI_y

    def _sheet(self) -> Sheet:
        return of_section(self, DAMPINGS)

    @property
    def damped(self) -> bool:
        """Whether any of the dampings is there."""
        return any(getattr(self, key) for key in DAMPINGS)

    @property
    def G(self) -> float | None:
        """Shear modulus ``E/(2 (1 + nu))``, N/m^2, or None without a material."""
        return None if self.E is None or self.nu is None else self.E / (2 * (1 + self.nu))


def _dampings(*values: float) -> dict[str, Any]:
    given = dict(zip(DAMPINGS, values, strict=True))
    return {key: checks.non_negative(value, f"Section.{key}") for key, value in given.items()}


def _of_shape(
    shape: Rectangle | Circle,
    E: Any,
    rho: Any,
    nu: Any,
    J: Any,
    shear_factors: Any,
    dampings: dict[str, Any],
) -> Section:
    torsion = shape.torsion_constant() if J is None else checks.positive(J, "Section.J")
    return _of_material(shape, shape.moments(), torsion, E, rho, nu, shear_factors, dampings)


def _of_material(
    shape: Rectangle | Circle | None,
    moments: dict[str, float],
    torsion: float,
    E: Any,
    rho: Any,
    nu: Any,
    shear_factors: Any,
    dampings: dict[str, Any],
) -> Section:
    modulus, density = checks.positive(E, "Section.E"), checks.positive(rho, "Section.rho")
    ratio = checks.number(nu, "Section.nu")
    if not -1 < ratio < 0.5:
        raise ModelError("Section.nu", f"must be > -1 and < 0.5, is {ratio:g}")
    stiffnesses = {
        "EA": checks.positive(modulus * moments["A"], "Section.EA"),
        "EI_y": checks.positive(modulus * moments["I_y"], "Section.EI"),
        "EI_z": checks.positive(modulus * moments["I_z"], "Section.EI"),
        "rhoA": checks.positive(density * moments["A"], "Section.rhoA"),
    }
    for key, value in moments.items():
        checks.positive(value, f"Section.{key}")
    factors = _shear_factors(shear_factors)
    material = {"E": modulus, "nu": ratio, "rho": density, "J": torsion, "shear_factors": factors}
    section: Section = object.__new__(Section)
    _fill(section, shape=shape, **stiffnesses, **dampings, **moments, **material)
    return section


def _shear_factors(given: Any) -> tuple[float, float]:
    k_y, k_z = checks.array(given, "Section.shear_factors", (2,)).tolist()
    for i, k in enumerate((k_y, k_z)):
        checks.positive(k, f"Section.shear_factors[{i}]")
    return k_y, k_z


def _fill(section: Section, **values: object) -> None:
    for key in Section.__slots__:
        object.__setattr__(section, key, values.get(key))
