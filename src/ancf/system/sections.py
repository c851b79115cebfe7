"""Cross-sections of the two fully parameterised beams: strains, stresses, resultants, axes and twist.

At a point of the axis a section is given by a = r_x, b = r_y, c = r_z, B = r_yx, C = r_zx, and the
deformation gradient at (y, z) is F = [a + y B + z C, b, c].  Arrays have the shape (..., 3) of the states.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray
from ..elements.shapes import gauss
from ..elements.solid_build import stiffnesses
from ..elements.solid_shapes import initial_vectors
from ..elements.solid_strains import Vectors, dot, scalar_products
from ..model.bodies.axes import cross
from ..model.bodies.beam import Beam
from .probe import R_X, R_Y, R_YX, R_Z, R_ZX, BeamProbe


def section(probe: BeamProbe, states: FloatArray) -> Vectors:
    """Section at a point of state vectors, or of their rates."""
    return Vectors(*(probe.field(states, row) for row in (R_X, R_Y, R_Z, R_YX, R_ZX)))


def natural_section(probe: BeamProbe, nodal: FloatArray | None = None) -> Vectors:
    """Section of the natural shape at a point, without its stretch; ``nodal`` where its element is known."""
    nodal = natural_vectors(probe) if nodal is None else nodal
    if not len(nodal):
        x, y, z = np.eye(3)
        return Vectors(x, y, z, np.zeros(3), np.zeros(3))
    return Vectors(*(probe.S[row] @ nodal for row in (R_X, R_Y, R_Z, R_YX, R_ZX)))


def natural_vectors(probe: BeamProbe) -> FloatArray:
    """Vectors (k, 3) of the element in its natural shape, without its stretch; none of a straight one."""
    natural = probe.beam.natural
    if natural is None:
        return np.zeros((0, 3))
    values = initial_vectors(natural)[probe.element : probe.element + 2]
    values[:, :2] /= natural.stretch
    return np.concatenate([values[0, :4], values[1, :4], values[0, 4:]])


def strain_tensor(probe: BeamProbe, states: FloatArray, y: float, z: float) -> FloatArray:
    """Green-Lagrange strain (F^T F - F0^T F0)/2 at (y, z) in the section's axes, shape (..., 3, 3)."""
    F, F0 = (_gradient(s, y, z) for s in (section(probe, states), natural_section(probe)))
    strain: FloatArray = 0.5 * (np.swapaxes(F, -1, -2) @ F - F0.T @ F0)
    return strain


def stress_tensor(probe: BeamProbe, states: FloatArray, y: float, z: float) -> FloatArray:
    """Elastic second Piola-Kirchhoff stress, N/m^2, in the section's axes, shape (..., 3, 3).

    With ``poisson="centreline"`` the coupling of the normal strains is that of the centreline.
    """
    s = probe.beam.section
    E, nu, G = s.E, s.nu, s.G
    assert E is not None  # the model has checked that the section has a material
    assert nu is not None
    assert G is not None
    lam = E * nu / ((1 + nu) * (1 - 2 * nu))
    strain = strain_tensor(probe, states, y, z)
    if probe.beam.poisson == "full":
        return _law(strain, lam, 2 * G, 2 * G)
    middle = strain_tensor(probe, states, 0.0, 0.0)
    return _law(strain, 0.0, E, 2 * G) + _law(middle, lam, 2 * G - E, 0.0)


def _law(strain: FloatArray, lam: float, normal: float, shear: float) -> FloatArray:
    """Stress lam tr(E) I + normal (diagonal of E) + shear (the rest of E)."""
    diagonal = np.eye(3)
    trace = np.trace(strain, axis1=-2, axis2=-1)[..., None, None]
    stress: FloatArray = (normal - shear) * strain * diagonal + shear * strain + lam * trace * diagonal
    return stress


def _gradient(s: Vectors, y: float, z: float) -> FloatArray:
    return np.stack([s.a + y * s.B + z * s.C, s.b, s.c], axis=-1)


def resultants(probe: BeamProbe, q: FloatArray, v: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Force n = dW/da, N, and moment m = b x dW/dB + c x dW/dC, N m, both (..., 3) in global axes.

    W is the strain energy per length; Kelvin-Voigt damping is included.
    """
    s, natural = section(probe, q), natural_section(probe)
    e = [x - x0 for x, x0 in zip(_scalars(s), _scalars(natural), strict=True)]
    t = _stresses(probe.beam, e)
    axial, bending = probe.beam.section.axial_damping, probe.beam.section.bending_damping
    if axial or bending:
        rate = section(probe, v)
        t[0] = t[0] + axial * dot(s.a, rate.a)
        t[6] = t[6] + bending * (dot(rate.a, s.B) + dot(s.a, rate.B))
        t[7] = t[7] + bending * (dot(rate.a, s.C) + dot(s.a, rate.C))
    t = [x[..., None] for x in t]
    force = t[0] * s.a + t[6] * s.B + t[7] * s.C + t[8] * s.b + t[9] * s.c
    by_B = 2 * t[3] * s.B + t[5] * s.C + t[6] * s.a + t[11] * s.b + t[14] * s.c
    by_C = 2 * t[4] * s.C + t[5] * s.B + t[7] * s.a + t[12] * s.c + t[13] * s.b
    return force, cross(s.b, by_B) + cross(s.c, by_C)


def _scalars(s: Vectors) -> list[FloatArray]:
    """Strains of the centreline, then the other products."""
    first, *rest = np.split(np.stack(scalar_products(s)), [3])
    return [*(0.5 * (first - 1.0)), *rest[0]]


def _stresses(beam: Beam, e: list[FloatArray]) -> list[FloatArray]:
    """Derivatives of the energy per length by the scalars."""
    D, lam, MY, MZ, MYY, MZZ, MYZ, LY, LZ, *shear = stiffnesses(beam)
    thick = e[1] + e[2]
    return [
        D * e[0] + lam * thick + 0.5 * (MY * e[3] + MZ * e[4]),
        D * e[1] + lam * (e[0] + e[2]) + 0.5 * (LY * e[3] + LZ * e[4]),
        D * e[2] + lam * (e[0] + e[1]) + 0.5 * (LY * e[3] + LZ * e[4]),
        0.5 * (MY * e[0] + LY * thick) + 0.25 * (MYY * e[3] + MYZ * e[4]),
        0.5 * (MZ * e[0] + LZ * thick) + 0.25 * (MZZ * e[4] + MYZ * e[3]),
        MYZ * e[5],
        MY * e[6],
        MZ * e[7],
        *(G * x for G, x in zip(shear, e[8:], strict=True)),
    ]


def rotation(s: Vectors) -> FloatArray:
    """Orthonormal axes (t, y, z) of a section as columns, shape (..., 3, 3).

    t is normal to r_y and r_z; y and z are as near to r_y as to r_z.
    """
    y, z = _unit(s.b), _unit(s.c)
    along, across = _unit(y + z), _unit(y - z)
    y, z = (along + across) / np.sqrt(2.0), (along - across) / np.sqrt(2.0)
    return np.stack([cross(y, z), y, z], axis=-1)


def _unit(vector: FloatArray) -> FloatArray:
    unit: FloatArray = vector / np.linalg.norm(vector, axis=-1, keepdims=True)
    return unit


def twist_rate(s: Vectors) -> FloatArray:
    """Rotation of the section about its normal per reference length, rad/m, shape (...)."""
    t = _unit(cross(s.b, s.c))
    of_b, of_c = (cross(x, X) / dot(x, x)[..., None] for x, X in ((s.b, s.B), (s.c, s.C)))
    return 0.5 * dot(t, of_b + of_c)


def twist(probe: BeamProbe, first: list[BeamProbe], states: FloatArray) -> FloatArray:
    """Integral of the rate of twist from the start to the point, less the natural one, rad, shape (...).

    ``first`` are probes in the elements before that of the point.
    """
    xi, weight = gauss(5)
    total = np.zeros(states.shape[:-1])
    for part, share in [*((p, 1.0) for p in first), (probe, probe.xi)]:
        h, nodal = share * part.element_length, natural_vectors(part)
        for x, w in zip(xi.tolist(), weight.tolist(), strict=True):
            there = part.moved(share * x)
            total += w * h * (twist_rate(section(there, states)) - twist_rate(natural_section(there, nodal)))
    return total
