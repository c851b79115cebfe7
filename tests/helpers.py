"""Small models, dense views of a System and difference formulas that several tests share."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import ancf
from ancf.elements.registry import ELEMENTS
from ancf.linalg.sparse import to_sparse
from ancf.model.bodies.beam import POISSON
from ancf.model.elements import KINDS
from ancf.system.core import assemble, residual
from compiled_kernels import total_strain_energy

#: Soft enough that a test state far from the natural shape has forces of the order of 1 N.
SOFT = {"EA": 40.0, "EI": 2.0, "rhoA": 0.7}
DAMPINGS = {"damping": 0.3, "axial_damping": 0.5, "bending_damping": 0.2}
#: The same for the elements that have a cross-section: rhoA = 0.6 kg/m, EA = 36 N, no symmetry left.
SOFT_SOLID = {"width": 0.3, "height": 0.2, "E": 600.0, "rho": 10.0, "nu": 0.3, "shear_factors": (0.8, 0.9)}
#: Elements with r_y and r_z, and keywords of ``add_beam`` for each kind of energy of each element.
SOLIDS = [name for name, kind in KINDS.items() if kind.has_section]
VARIANTS = {
    f"{name}-{poisson if name in SOLIDS else strain}": {"element": name, "strain": strain, "poisson": poisson}
    for name in ELEMENTS
    for strain in KINDS[name].strains
    for poisson in (POISSON if name in SOLIDS else POISSON[:1])
}

#: Newton's method to round-off, and every way to keep joints of index 1 to 3.
EXACT = ancf.Newton(tolerance=1e-15, modified=False)
METHODS = {
    "index1": ancf.Trapezoidal(formulation="index1", newton=EXACT),
    "index2": ancf.Trapezoidal(formulation="index2", newton=EXACT),
    "ggl": ancf.Trapezoidal(newton=EXACT),
    "alpha": ancf.GeneralizedAlpha(rho_inf=0.9, newton=EXACT),
}

#: Relative bars of test_elements and test_kernels, which say why.
BY_DIFFERENCES, BY_ROUND_OFF = 1e-7, 1e-12


def some(cases, every=2):
    """Cases of a long family: every second one is tried always, all of them with --slow."""
    return [later(case) if k % every else case for k, case in enumerate(cases)]


def later(case):
    """A case that is tried with --slow alone."""
    if hasattr(case, "marks"):
        return pytest.param(*case.values, marks=[*case.marks, pytest.mark.slow], id=case.id)
    return pytest.param(*(case if isinstance(case, tuple) else (case,)), marks=pytest.mark.slow)


def arc(u):
    """A curve in space without symmetry, about 1.9 m long."""
    return (np.sin(1.2 * u), 0.4 * u**2, 1.1 * u - 0.3 * np.cos(2.0 * u))


#: Initial shapes by what is special about their natural shape.
SHAPES = {
    "straight": {"start": (0.1, 0.2, -0.1), "end": (0.9, 0.6, 0.5)},
    "stretched": {"start": (0.1, 0.2, -0.1), "end": (0.9, 0.6, 0.5), "length": 0.9},
    "curved": {"path": arc},
    "curved and stretched": {"path": arc, "length": 1.6},
    "bent from straight": {"path": arc, "natural_shape": "straight"},
}


def soft(element="cable", **more):
    """A soft section that an element can have; keywords of the damping may be added."""
    return ancf.Section.rectangle(**SOFT_SOLID, **more) if element in SOLIDS else ancf.Section(**SOFT, **more)


def square(element="cable", *, EA, EI, rhoA, nu=0.3, **more):
    """A section with these stiffnesses: for the elements that need one, a square of a material."""
    if element not in SOLIDS:
        return ancf.Section(EA=EA, EI=EI, rhoA=rhoA, **more)
    side = np.sqrt(12 * EI / EA)
    return ancf.Section.rectangle(side, side, E=EA / side**2, rho=rhoA / side**2, nu=nu, **more)


def cable(shape="straight", *, elements=3, damped=False, model=None, name="beam", section=None, **more):
    """A free cable or beam of any element, of a soft section by default; returns its model and the beam."""
    model = ancf.Model() if model is None else model
    if section is None:
        section = soft(more.get("element", "cable"), **(DAMPINGS if damped else {}))
    return model, model.add_beam(name, section=section, elements=elements, **SHAPES[shape], **more)


def shaken(system, size=1.0, seed=1):
    """Initial state vector of a system plus a random part, on the unknowns that nodes have."""
    q, _ = system.initial_state()
    used = system.numbering.used()
    q[: system.n][used] += size * 0.1 * np.random.default_rng(seed).uniform(-1, 1, int(used.sum()))
    return q


def random_rate(system, seed=2):
    """Random velocities or accelerations on the unknowns that nodes have."""
    v = np.zeros(system.size)
    used = system.numbering.used()
    v[: system.n][used] = np.random.default_rng(seed).uniform(-1, 1, int(used.sum()))
    return v


def forces(system, q, v=None, a=None, batches=None):
    """Inertia and internal forces, without gravity and dead loads."""
    zero = np.zeros_like(q)
    r = np.empty_like(q)
    batches = system.core.batches if batches is None else batches
    residual(batches, system.core.ws, q, zero if v is None else v, zero if a is None else a, zero, r)
    return r


def energy(system, q):
    """Strain energy of elements and springs."""
    return total_strain_energy(system.core.batches, system.core.ws, q)


def matrix(system, q, mass=0.0, damping=0.0, stiffness=0.0):
    """Dense mass M + damping C + stiffness K, supports not applied."""
    core = system.core
    A = np.empty(system.places.size)
    assemble(core.batches, core.ws, q, np.zeros_like(q), A, mass, damping, stiffness)
    return to_sparse(A, system.places).toarray()


def assert_close(actual, wanted, tolerance):
    """Arrays agree to a share of the largest entry."""
    scale = np.max(np.abs(wanted))
    assert scale > 0
    assert np.max(np.abs(actual - wanted)) <= tolerance * scale


def derivative(function, q, step=1e-3):
    """Derivative of a function of a vector by central differences of order 4, one column per unknown."""
    columns = []
    for i in range(len(q)):
        e = np.zeros_like(q)
        e[i] = step
        near = np.asarray(function(q + e)) - function(q - e)
        far = np.asarray(function(q + 2 * e)) - function(q - 2 * e)
        columns.append((8 * near - far) / (12 * step))
    return np.stack(columns, axis=-1)


def rotation(axis, angle):
    """Rotation matrix about an axis of any length."""
    k = np.cross(np.eye(3), np.asarray(axis, float) / np.linalg.norm(axis))
    return np.eye(3) - np.sin(angle) * k + (1 - np.cos(angle)) * k @ k


def solution(rates, start, t):
    """Solution of y' = rates(t, y) at the times t, to 1e-12."""
    t = np.atleast_1d(t)
    found = solve_ivp(rates, (0, t[-1]), start, t_eval=t, rtol=1e-12, atol=1e-13, method="DOP853")
    return found.y.T


def rate(errors, ratio=2.0):
    """Observed order from errors at steps that fall by ``ratio``."""
    errors = np.abs(np.asarray(errors, float))
    return np.log(errors[:-1] / errors[1:]) / np.log(ratio)
