"""Cross-section: stiffnesses, mass and damping of a beam, given directly or from a shape and a material."""

from __future__ import annotations

import math
from dataclasses import dataclass

from ancf.errors import ModelError
from ancf.model import checks


@dataclass(frozen=True, slots=True)
class Rectangle:
    """Width (local y) and height (local z) in m."""

    width: float
    height: float


@dataclass(frozen=True, slots=True)
class Circle:
    """Diameter in m."""

    diameter: float


@dataclass(frozen=True, slots=True, init=False)
class Section:
    """Stiffnesses, mass and damping per length of a beam; every argument by keyword.

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

    Raises
    ------
    ModelError
        A value is no finite number or out of range; ``where`` is ``Section.EA`` and so on.

    Notes
    -----
    ``EI_y = E width height^3/12`` and ``EI_z = E height width^3/12`` are the two bending stiffnesses of
    a shape. `shape`, `E`, `nu`, `rho` are None for a section given by its stiffnesses.

    """

    EA: float
    EI_y: float
    EI_z: float
    rhoA: float
    damping: float
    axial_damping: float
    bending_damping: float
    shape: Rectangle | Circle | None
    E: float | None
    nu: float | None
    rho: float | None

    def __init__(
        self,
        *,
        EA: float,
        EI: float,
        rhoA: float,
        damping: float = 0.0,
        axial_damping: float = 0.0,
        bending_damping: float = 0.0,
    ) -> None:
        stiffness = checks.non_negative(EI, "Section.EI")
        _fill(
            self,
            EA=checks.positive(EA, "Section.EA"),
            EI_y=stiffness,
            EI_z=stiffness,
            rhoA=checks.positive(rhoA, "Section.rhoA"),
            **_dampings(damping, axial_damping, bending_damping),
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
        damping: float = 0.0,
        axial_damping: float = 0.0,
        bending_damping: float = 0.0,
    ) -> Section:
        """Rectangle of a material: m, m, Young's modulus N/m^2, density kg/m^3, Poisson's ratio."""
        b, h = checks.positive(width, "Section.width"), checks.positive(height, "Section.height")
        second_moments = (b * h**3 / 12, h * b**3 / 12)
        dampings = _dampings(damping, axial_damping, bending_damping)
        return _of_material(Rectangle(b, h), b * h, second_moments, E, rho, nu, dampings)

    @classmethod
    def circle(
        cls,
        diameter: float,
        E: float,
        rho: float,
        nu: float = 0.0,
        *,
        damping: float = 0.0,
        axial_damping: float = 0.0,
        bending_damping: float = 0.0,
    ) -> Section:
        """Full circle of a material: m, Young's modulus N/m^2, density kg/m^3, Poisson's ratio."""
        d = checks.positive(diameter, "Section.diameter")
        second_moment = math.pi * d**4 / 64
        dampings = _dampings(damping, axial_damping, bending_damping)
        return _of_material(Circle(d), math.pi * d**2 / 4, (second_moment,) * 2, E, rho, nu, dampings)

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


def _dampings(damping: float, axial: float, bending: float) -> dict[str, float]:
    given = {"damping": damping, "axial_damping": axial, "bending_damping": bending}
    return {key: checks.non_negative(value, f"Section.{key}") for key, value in given.items()}


def _of_material(
    shape: Rectangle | Circle,
    area: float,
    second_moments: tuple[float, float],
    E: float,
    rho: float,
    nu: float,
    dampings: dict[str, float],
) -> Section:
    modulus, density = checks.positive(E, "Section.E"), checks.positive(rho, "Section.rho")
    ratio = checks.number(nu, "Section.nu")
    if not -1 < ratio < 0.5:
        raise ModelError("Section.nu", f"must be > -1 and < 0.5, is {ratio:g}")
    stiffnesses = {
        "EA": checks.positive(modulus * area, "Section.EA"),
        "EI_y": checks.positive(modulus * second_moments[0], "Section.EI"),
        "EI_z": checks.positive(modulus * second_moments[1], "Section.EI"),
        "rhoA": checks.positive(density * area, "Section.rhoA"),
    }
    section: Section = object.__new__(Section)
    _fill(section, **stiffnesses, **dampings, shape=shape, E=modulus, nu=ratio, rho=density)
    return section


def _fill(section: Section, **values: object) -> None:
    for key in ("shape", "E", "nu", "rho"):
        values.setdefault(key, None)
    for key, value in values.items():
        object.__setattr__(section, key, value)
