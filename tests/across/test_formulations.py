"""Forms of the constraints: a cable with a mass at its end slides along another one, like the paper's 7.4.

Index 1, 2, stabilised index 2 and index 3 have order 2 and the same solution where it is smooth: within
one element of the carrier, for r_xx jumps where the sliding point passes to the next one.
"""

from dataclasses import replace

import numpy as np
import pytest

import ancf
from ancf.solvers.formulations import FORMULATIONS
from helpers import rate

EXACT = ancf.Newton(tolerance=1e-15, modified=False)
SECTION = {"EA": 100.0, "EI": 0.02, "rhoA": 0.08}
METHODS = {
    "index1": ancf.Trapezoidal(formulation="index1", newton=EXACT),
    "index2": ancf.Trapezoidal(formulation="index2", newton=EXACT),
    "ggl": ancf.Trapezoidal(formulation="ggl", newton=EXACT),
    "alpha index2": ancf.GeneralizedAlpha(0.9, formulation="index2", newton=EXACT),
    "alpha ggl": ancf.GeneralizedAlpha(0.9, formulation="ggl", newton=EXACT),
    "alpha index3": ancf.GeneralizedAlpha(0.9, formulation="index3", newton=EXACT),
    "alpha index1": ancf.GeneralizedAlpha(0.9, formulation="index1", newton=EXACT),
}


def build(carrier=3, slider=2, s=2.9, **more):
    """A sagging carrier, and a slider that is held by the joint alone; its start state."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(**SECTION)
    wire = model.add_beam(
        "carrier", start=(0, 0, 0), end=(0, 3, 1), elements=carrier, section=section, strain="paper"
    )
    at = wire.initial_position(s)
    cable = model.add_beam(
        "slider", start=at, end=np.add(at, (1, 0, 0)), elements=slider, section=section, strain="paper"
    )
    model.pin(wire.start)
    model.pin(wire.end)
    mass = model.add_point_mass("mass", at=np.add(at, (1, 0, 0)), mass=1.0)
    model.connect(mass, cable.end)
    joint = model.slide(cable.start, along=wire, name="joint", tolerance=1.0, **more)
    return model, wire, cable, joint


def run(step, method, t_end=0.2, state=None, **more):
    model, wire, cable, joint = build(**more)
    result = ancf.simulate(model, t_end=t_end, step=step, integrator=method, start=state)
    return result, wire, cable, joint


def gaps(result, wire, cable, joint, count=50):
    """Distances of the sliding point from the carrier at its arc length, independent of the joint's code."""
    rows = np.linspace(0, len(result.t) - 1, count).astype(int)
    s, r = result.arc_length(joint), result.position(cable.start)
    return np.array([np.linalg.norm(result.state(k).position(wire.at(float(s[k]))) - r[k]) for k in rows])


def end_of(result, wire, cable, joint):
    return np.concatenate(
        [result.position(cable.end)[-1], result.position(wire.at(1.5))[-1], result.arc_length(joint)[-1:]]
    )


@pytest.fixture(scope="module")
def reference():
    """GGL at a very small step."""
    return end_of(*run(6.25e-5, METHODS["ggl"]))


class TestOrder:
    @pytest.mark.parametrize("name", METHODS)
    def test_order_two_and_the_same_solution(self, name, reference):
        errors = []
        for step in (2e-3, 1e-3, 5e-4):
            made = run(step, METHODS[name])
            errors.append(np.linalg.norm(end_of(*made) - reference))
        s = made[0].arc_length(made[3])
        assert 3.1623 * 2 / 3 < np.min(s) < np.max(s) - 0.08  # it slides, in one element
        assert rate(errors) == pytest.approx([2, 2], abs=0.2)
        assert errors[-1] < 1e-4

    @pytest.mark.parametrize("name", ["index2", "ggl", "alpha index3"])
    def test_forces_agree(self, name):
        forces = []
        for method in (METHODS["index1"], METHODS[name]):
            result, _, _, joint = run(5e-4, method)
            forces.append(result.multiplier(joint)[200:])
        assert np.max(np.abs(forces[1] - forces[0])) < 2e-2 * np.max(np.abs(forces[0]))


class TestDrift:
    """Over the whole way, element after element."""

    @pytest.mark.parametrize("name", ["ggl", "alpha index3", "alpha ggl"])
    def test_positions_hold(self, name):
        made = run(1e-3, METHODS[name], t_end=1.0, carrier=12)
        assert np.max(gaps(*made)) < 1e-10
        s = made[0].arc_length(made[3])
        assert np.ptp(s) > 3.1623 / 12 * 3  # over several elements

    @pytest.mark.parametrize("method", [ancf.Trapezoidal(), ancf.GeneralizedAlpha(0.8)])
    def test_a_few_coarse_steps_hold_too(self, method):
        """A body on a hinge: its directors stay orthonormal, which index 2 alone does not see to.

        The point on the hinge is linear in the unknowns: it stays with either.
        """
        off = {}
        for formulation in ("ggl", "index2"):
            model = ancf.Model(gravity=(0, 0, -9.81))
            hub = model.add_rigid_body("hub", at=(1, 0, 0), mass=1.0, inertia=(0.01, 0.02, 0.03))
            model.hinge(hub.at(-1, 0, 0), (0, 0, 0), axis=(0, 1, 0))
            settings = replace(method, formulation=formulation)
            result = ancf.simulate(model, t_end=0.3, step=0.02, integrator=settings)
            R = result.section_rotation(hub)
            turned = np.abs(np.swapaxes(R, 1, 2) @ R - np.eye(3)).max()
            off[formulation] = turned
            assert np.abs(result.position(hub.at(-1, 0, 0))).max() < 1e-9
        assert off["ggl"] < 1e-9
        assert off["index2"] > 1e-4

    def test_index_2_drifts_with_order_2(self):
        drift = []
        for step in (2e-3, 1e-3, 5e-4):
            drift.append(np.max(gaps(*run(step, METHODS["index2"]))))
        assert rate(drift) == pytest.approx([2, 2], abs=0.2)
        assert 1e-9 < drift[-1] < 1e-4

    def test_index_1_drifts_less(self):
        """What violates the constraint decays: less is left than by index 2, at least of order 2."""
        drift = {
            name: [np.max(gaps(*run(h, METHODS[name], t_end=0.4, carrier=12))) for h in (1e-3, 5e-4, 2.5e-4)]
            for name in ("index1", "index2")
        }
        assert np.all(rate(drift["index1"]) > 1.8)
        assert np.all(np.array(drift["index1"]) < drift["index2"])

    def test_energy(self):
        """Nothing dissipates: what the trapezoidal rule changes falls with the step."""
        change = []
        for step in (1e-3, 5e-4):
            result = run(step, METHODS["ggl"])[0]
            change.append(np.max(np.abs(result.energy.total - result.energy.total[0])))
        assert change[1] < 1e-4 * np.max(result.energy.kinetic)
        assert rate(change) == pytest.approx([2], abs=0.3)


class TestWay:
    def test_several_elements_in_a_step(self):
        """Coarse steps over short elements: within the error of the step."""
        coarse, fine = (run(h, ancf.Trapezoidal(), t_end=0.4, carrier=150) for h in (1e-2, 1e-3))
        s = coarse[0].arc_length(coarse[3])
        assert np.max(np.abs(np.diff(s))) > 1.1 * 3.1623 / 150
        assert np.linalg.norm(end_of(*coarse) - end_of(*fine)) < 2e-2
        assert np.max(gaps(*coarse)) < 1e-10

    def test_from_the_equilibrium_of_the_carrier(self):
        """Some bodies find their equilibrium, the joint to the others carries nothing."""
        model, wire, cable, joint = build()
        state = ancf.equilibrium(model, of=[wire])
        assert state.position(wire.at(1.5))[2] < wire.initial_position(1.5)[2] - 0.01
        assert state.multiplier(joint) == pytest.approx((0, 0, 0), abs=1e-12)
        assert np.allclose(state.position(cable.end), cable.initial_position(1.0))

    def test_drive_with_friction(self):
        """All forces along s at once: the balance of energy closes."""
        made = run(
            5e-4,
            METHODS["ggl"],
            force="3*sin(8*t)",
            friction=0.1,
            viscous=0.5,
            mass=0.2,
            friction_velocity=0.1,
        )
        energy = made[0].energy
        assert np.ptp(energy.balance) < 2e-4 * np.max(energy.kinetic)
        assert energy.dissipated[-1] > 0.02 * np.max(energy.kinetic)
        assert np.max(np.abs(energy.supplied)) > 0.005 * np.max(energy.kinetic)


class TestSettings:
    def test_trapezoidal_refuses_index_3(self):
        with pytest.raises(ancf.ModelError, match="multipliers, which oscillate"):
            ancf.Trapezoidal(formulation="index3")

    @pytest.mark.parametrize("kind", [ancf.Trapezoidal, ancf.GeneralizedAlpha])
    def test_unknown_name(self, kind):
        with pytest.raises(ancf.ModelError, match="ggl"):
            kind(formulation="index4")

    @pytest.mark.parametrize("name", FORMULATIONS)
    def test_weights_add_to_the_gradient(self, name):
        """d/dq of the weighted rows is C_q: w0 + w1 G/B + w2/B = 1."""
        for h in (1e-1, 1e-4):
            for s in (METHODS["ggl"].coefficients(), METHODS["alpha ggl"].coefficients()):
                c = (1 - s.alpha_f) / (1 - s.alpha_m)
                B, gamma = s.beta * h * h * c, s.gamma * h * c
                w0, w1, w2 = FORMULATIONS[name].weights(B, gamma, h)
                assert w0 + w1 * gamma / B + w2 / B == pytest.approx(1.0, rel=1e-12)
