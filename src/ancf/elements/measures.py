"""Strain measures of the cable: axial strain and curvature from r_x and r_xx.

With a = r_x.r_x, b = r_x.r_xx, c = r_xx.r_xx:

=============  =======================  ==========================  =================================
strain         axial strain             curvature                   source
=============  =======================  ==========================  =================================
``paper``      eps = (a - 1)/2          kappa^2 = (a c - b^2)/a^3   Gerstmayr & Shabana, eqs. 25, 26
``material``   eps = sqrt(a) - 1        kappa^2 = (a c - b^2)/a^2   Gerstmayr & Irschik (2008)
=============  =======================  ==========================  =================================

kappa^2 is used, not kappa: its derivatives are smooth for a straight cable, where eqs. B-2 ... B-5
divide zero by zero.
"""

from __future__ import annotations

import numpy as np

from ..arrays import FloatArray

#: Power of a in kappa^2, by strain measure.
CURVATURE_POWER = {"paper": 3, "material": 2}


def axial_strain(r_x: FloatArray, strain: str) -> FloatArray:
    """Axial strain, shape (...,), dimensionless, from r_x of shape (..., 3)."""
    a = np.einsum("...k,...k->...", r_x, r_x)
    eps: FloatArray = 0.5 * (a - 1.0) if strain == "paper" else np.sqrt(a) - 1.0
    return eps


def axial_strain_rate(r_x: FloatArray, v_x: FloatArray, strain: str) -> FloatArray:
    """Time derivative of the axial strain, shape (...,), 1/s; v_x is the rate of r_x."""
    rate: FloatArray = np.einsum("...k,...k->...", r_x, v_x)
    if strain == "material":
        rate = rate / np.linalg.norm(r_x, axis=-1)
    return rate


def normal_curvature(r_x: FloatArray, r_xx: FloatArray, strain: str) -> FloatArray:
    """Curvature vector in the normal plane, shape (..., 3), 1/m; its length is kappa."""
    a = np.einsum("...k,...k->...", r_x, r_x)[..., None]
    b = np.einsum("...k,...k->...", r_x, r_xx)[..., None]
    n: FloatArray = (r_xx - r_x * (b / a)) / a ** (0.5 * (CURVATURE_POWER[strain] - 1))
    return n


def curvature(r_x: FloatArray, r_xx: FloatArray, strain: str) -> FloatArray:
    """Curvature kappa >= 0, shape (...,), 1/m."""
    kappa: FloatArray = np.linalg.norm(normal_curvature(r_x, r_xx, strain), axis=-1)
    return kappa
