"""A finer step must not be worse: energy and angular momentum of free bodies and cables.

Both are conserved in truth.  The methods keep them to their order; what Newton's method leaves in a step must
not add up over the more steps of a finer run.
"""

from itertools import pairwise

import numpy as np
import pytest

import ancf
from ancf.model.joints.basic import Slide
from helpers import EXACT, arc, soft
from motions import momentum
from random_models import RandomModel

STEPS = (1e-3, 5e-4, 2.5e-4, 1.25e-4)
#: The share of the accelerations that Newton's method may leave, 1e-6, in one step of 1 ms at 6 rad/s.
LEFT = 1e-8

METHODS = {
    "index1": lambda newton: ancf.Trapezoidal(formulation="index1", newton=newton),
    "index2": lambda newton: ancf.Trapezoidal(formulation="index2", newton=newton),
    "ggl": lambda newton: ancf.Trapezoidal(newton=newton),
    "alpha": lambda newton: ancf.GeneralizedAlpha(rho_inf=0.9, newton=newton),
}
#: Moments of inertia, kg m^2, and spins, rad/s: about the middle axis, a slim body, a disc.
TOPS = {
    "tumbling": ((1.0, 2.0, 2.6), (0.05, 3.0, 0.02)),
    "slim": ((0.1, 1.0, 1.05), (0.3, 0.2, 2.0)),
    "disc": ((1.0, 1.0, 1.9), (0.5, 0.1, 6.0)),
}
JOINTS = {
    "spherical": lambda model, a, b: model.connect(a, b),
    "hinge": lambda model, a, b: model.hinge(a, b, axis=(0, 1, 1)),
}


def top(kind):
    inertia, spin = TOPS[kind]
    model = ancf.Model()
    body = model.add_rigid_body("body", at=(0, 0, 0), mass=2.0, inertia=inertia)
    body.set_motion(velocity=(0.4, -0.2, 0.1), angular_velocity=spin)
    return model


def pair(joint):
    """Two free bodies that a joint ties."""
    model = ancf.Model()
    a = model.add_rigid_body("a", at=(0, 0, 0), mass=2.0, inertia=(1.0, 2.0, 2.6))
    b = model.add_rigid_body("b", at=(1.5, 0, 0), mass=0.7, inertia=(0.1, 0.2, 0.25))
    JOINTS[joint](model, a.at(1, 0, 0), b.at(-0.5, 0, 0))
    a.set_motion(angular_velocity=(0, 1.0, 0.7), about=(1, 0, 0))
    b.set_motion(angular_velocity=(0, 2.5, 2.2), about=(1, 0, 0))
    return model


def flying(elements):
    """A cable bent from straight and let go with a rotation."""
    model = ancf.Model()
    body = model.add_beam("cable", path=arc, elements=elements, section=soft(), natural_shape="straight")
    body.set_motion(velocity=(0.3, 0.1, -0.2), angular_velocity=(1.0, -2.0, 1.5))
    return model


def drifts(model, integrator, step, t_end):
    """Largest changes of energy and angular momentum, relative, and the result."""
    result = ancf.simulate(model, t_end=t_end, step=step, integrator=integrator, output_step=t_end / 10)
    spins = np.array([momentum(result, k)[1] for k in range(len(result.t))])
    energy = result.energy.total
    turned = np.linalg.norm(spins - spins[0], axis=1).max() / np.linalg.norm(spins[0])
    return np.array([np.ptp(energy) / energy[0], turned]), result


def check(build, method, tolerance, t_end):
    """Drifts of successive steps; those of the same steps solved to round-off are the bar."""
    found = []
    for step in STEPS:
        found.append(drifts(build(), METHODS[method](ancf.Newton(tolerance=tolerance)), step, t_end)[0])
    for coarse, fine in pairwise(found):
        assert np.all(fine < coarse + LEFT)
    for k in (0, len(STEPS) - 1):
        bar, _ = drifts(build(), METHODS[method](EXACT), STEPS[k], t_end)
        assert np.all(found[k] < 1.5 * bar + LEFT)
    return np.array(found)


@pytest.mark.parametrize("tolerance", [1e-11, 1e-9])
@pytest.mark.parametrize("form", METHODS)
class TestBodies:
    @pytest.mark.parametrize("kind", TOPS)
    def test_free_top(self, kind, form, tolerance):
        check(lambda: top(kind), form, tolerance, 0.5)

    @pytest.mark.parametrize("joint", JOINTS)
    def test_free_pair(self, joint, form, tolerance):
        found = check(lambda: pair(joint), form, tolerance, 0.5)
        assert np.all(found[:-1] > 2.0 * found[1:])  # the order of the method is above what Newton leaves


@pytest.mark.parametrize("tolerance", [1e-11, 1e-9])
@pytest.mark.parametrize("form", ["ggl", "alpha"])
@pytest.mark.parametrize("elements", [1, 4, 16])
def test_free_cable(elements, form, tolerance):
    check(lambda: flying(elements), form, tolerance, 0.1)


@pytest.mark.parametrize("form", METHODS)
def test_iterations(form):
    """The bar is reached by what is done with what is left, not by more corrections."""
    for build in (lambda: top("tumbling"), lambda: pair("hinge")):
        for step in STEPS:
            _, result = drifts(build(), METHODS[form](ancf.Newton()), step, 0.5)
            stats = result.stats
            assert stats.newton_iterations < 3.5 * stats.steps
            assert stats.jacobians < 0.5 * stats.steps


def ring_on_a_cable(weight, moving, friction, elements):
    """A cable that is let go, held by a ring, or with a bead on it; all weighs so many times as much."""
    stiff = {"EA": 194.0 * weight, "EI": 0.63 * weight, "rhoA": 0.84 * weight}
    model = ancf.Model(gravity=(7.9, 3.7, -4.8))
    section = ancf.Section(**stiff, bending_damping=0.01 * weight)
    ends = {"start": (0.3, -0.5, -0.8), "end": (0.1, -0.1, -1.3)}
    cable = model.add_beam("cable", **ends, elements=elements, section=section)
    model.clamp(cable.start)
    at = tuple(cable.at(0.23).initial_position)
    point = model.add_point_mass("bead", at=at, mass=0.3 * weight) if moving else at
    model.slide(point, along=cable, friction=friction, name="joint")
    return model


class TestForcesOfJoints:
    """Smooth, so that their second differences fall with the square of the step, down to very fine ones."""

    @pytest.mark.parametrize("friction", [0.0, 0.2])
    @pytest.mark.parametrize("moving", [False, True], ids=["ring", "bead"])
    @pytest.mark.parametrize(("weight", "elements"), [(1e-6, 1), (1.0, 1), (1.0, 2), (1e3, 2), (1e6, 2)])
    @pytest.mark.parametrize("method", ["index1", "index2", "ggl"])
    def test_of_what_slides(self, method, weight, elements, moving, friction):
        """Its multipliers lost their digits across the line where it is bent: 100 N in place of 3 N."""
        model, found, iterations = ring_on_a_cable(weight, moving, friction, elements), [], []
        for step in (1e-5, 1e-6):
            run = ancf.simulate(model, t_end=60 * step, step=step, integrator=METHODS[method](ancf.Newton()))
            force = run.multiplier("joint")
            found.append(np.max(np.abs(np.diff(force, 2, axis=0))) / np.max(np.abs(force)))
            iterations.append(run.stats.newton_iterations)
        assert found[1] < max(0.04 * found[0], 5e-6)
        assert iterations[1] < 80

    @pytest.mark.parametrize("step", [5e-5, 2.5e-5, 1e-5])
    def test_beside_one_with_friction(self, step):
        """A second correction that is larger, as friction follows multipliers, was taken for round-off."""
        model = RandomModel(30).model
        run = ancf.simulate(model, t_end=2e-3, step=step)
        force = np.linalg.norm(run.multiplier("slide of ring along b1"), axis=1)
        assert np.max(force) < 2.0 * force[0]

    @pytest.mark.parametrize("seed", [5, 17, 30, 55, 142])
    @pytest.mark.parametrize("step", [2.5e-5, 1e-5])
    def test_beside_all_kinds(self, step, seed):
        """Frames of nodes far away turned the rows of the joint: 3 N of 4 N were noise after 200 steps."""
        model = RandomModel(seed).model
        run = ancf.simulate(model, t_end=200 * step, step=step)
        for joint in (c.name for c in model.connections if isinstance(c, Slide)):
            force = run.joint_force(joint)
            noise = np.max(np.abs(np.diff(force[20:], 3, axis=0))) / 8
            assert noise < 1e-3 * np.max(np.abs(force))

    @pytest.mark.parametrize("joint", JOINTS)
    @pytest.mark.parametrize("method", ["index1", "index2", "ggl"])
    def test_of_fixed_ones(self, method, joint):
        model, found = pair(joint), []
        name = model.connections[0].name
        for step in (1e-4, 1e-5, 1e-6):
            run = ancf.simulate(model, t_end=60 * step, step=step, integrator=METHODS[method](ancf.Newton()))
            force = run.joint_force(name)
            found.append(np.max(np.abs(np.diff(force, 2, axis=0))) / np.max(np.abs(force)))
        assert all(fine < max(0.04 * coarse, 3e-6) for coarse, fine in pairwise(found))
