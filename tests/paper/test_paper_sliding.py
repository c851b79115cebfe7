"""Example 7.4, the sliding beam, against independent numbers, within stated bars."""

import math
from functools import cache

import numpy as np
import pytest

import ancf
from ancf.paper import references, sliding

REFERENCE = references.values()
TIMES = ("0.25", "0.5", "0.75", "1")
#: A new matrix in every iteration: nothing is left to its tolerance.
EXACT = ancf.Newton(modified=False, tolerance=1e-10)


@cache
def run(carrier=6, element="cable", strain=None, nu=0.3, step=2e-4, formulation="ggl", exact=False):
    model = sliding.build(carrier, 2, element, strain, nu)
    newton = EXACT if exact else None
    return sliding.run(model, output_step=0.05, step=step, formulation=formulation, newton=newton)


def differences(result, key, t):
    """Distance of the mass from the reference and difference of s, m."""
    i = round(float(t) / 0.05)
    assert result.t[i] == pytest.approx(float(t), abs=1e-9)
    *place, s = REFERENCE[f"{key}.t{t}"]
    return math.dist(result.position("slider.end")[i], place), abs(result.arc_length("joint")[i] - s)


class TestStart:
    """Equilibrium of the carrier alone within 2e-8 m."""

    @pytest.mark.parametrize("strain", ["paper", "material"])
    @pytest.mark.parametrize("elements", [6, 16, 64])
    def test_carrier(self, elements, strain):
        model = sliding.build(elements, 2, strain=strain)
        state, length = sliding.start(model), model.beams["carrier"].length
        wanted = REFERENCE[f"7.4.static.variant{['paper', 'material'].index(strain)}.n{elements}"]
        for name, share in (("mid", 0.5), ("quarter", 0.25), ("threequarter", 0.75)):
            place = state.position(model.beams["carrier"].at(share * length))
            assert place == pytest.approx(wanted[name], rel=0, abs=2e-8)

    def test_slider_and_joint_are_as_described(self):
        model = sliding.build()
        state = sliding.start(model)
        assert state.position("slider.end") == pytest.approx(sliding.TIP, abs=1e-14)
        assert state.arc_length("joint") == pytest.approx(math.sqrt(10), abs=1e-12)


class TestCable:
    """The same discretisation, 0.2 ms: mass within 5e-6 m, s within 6e-5 m."""

    @pytest.mark.parametrize("t", TIMES)
    @pytest.mark.parametrize("formulation", ["ggl", "index2", "index1"])
    @pytest.mark.parametrize("carrier", [6, 16])
    def test_formulations_agree(self, carrier, formulation, t):
        result = run(carrier, formulation=formulation)
        place, s = differences(result, f"7.4.cable.n{carrier}+2.h0.2ms.trap2", t)
        assert place < 5e-6
        assert s < 6e-5

    @pytest.mark.parametrize("t", TIMES)
    @pytest.mark.parametrize("carrier", [6, 16])
    def test_same_formulation_as_the_reference(self, carrier, t):
        place, s = differences(run(carrier, formulation="index2"), f"7.4.cable.n{carrier}+2.h0.2ms.trap2", t)
        assert place < 2e-8
        assert s < 1e-7

    @pytest.mark.parametrize("t", TIMES)
    def test_index_3_with_generalised_alpha(self, t):
        model = sliding.build()
        method = ancf.GeneralizedAlpha(rho_inf=0.9, formulation="index3")
        start = sliding.start(model)
        result = ancf.simulate(model, t_end=1, step=2e-4, start=start, integrator=method, output_step=0.05)
        place, s = differences(result, "7.4.cable.n6+2.h0.2ms.ga3", t)
        assert place < 5e-8
        assert s < 2e-7

    def test_radau(self):
        """Another method, another formulation, error-controlled steps: the same limit."""
        model = sliding.build()
        method, start = ancf.Radau(tolerance=1e-6), sliding.start(model)
        result = ancf.simulate(model, t_end=1, step=2e-4, start=start, integrator=method, output_step=0.05)
        for t in TIMES:
            place, s = differences(result, "7.4.cable.n6+2.step_converged", t)
            assert place < 1e-7
            assert s < 5e-7
        assert result.stats.steps < 1500

    @pytest.mark.parametrize("t", TIMES)
    def test_material_strains(self, t):
        place, s = differences(run(strain="material"), "7.4.cable.variant1.n6+2.h0.2ms.trap2", t)
        assert place < 5e-6
        assert s < 6e-5

    def test_limit_with_material_strains(self):
        """Step to zero; two codes and two formulations agree on it."""
        place = run(strain="material", step=2e-5).position("slider.end")[-1]
        assert place == pytest.approx((-0.011173, 1.975303, -1.983590), abs=2e-6)

    @pytest.mark.parametrize("carrier", [6, 16])
    @pytest.mark.parametrize("t", TIMES)
    def test_limit_of_small_steps(self, carrier, t):
        """The reference has no multipliers: its joint is eliminated."""
        place, s = differences(run(carrier, step=2e-5), f"7.4.cable.n{carrier}+2.step_converged", t)
        assert place < 2e-6
        assert s < 2e-6

    def test_order_two(self):
        """Errors at 0.25 s, before the first hand-over, fall by four with half the step."""
        steps, key = (1e-3, 5e-4, 2.5e-4), "7.4.cable.n6+2.step_converged"
        errors = np.array([differences(run(step=h), key, "0.25")[0] for h in steps])
        assert np.log2(errors[:-1] / errors[1:]) == pytest.approx([2.0, 2.0], abs=0.2)

    def test_energy_is_kept(self):
        result = run()
        assert result.energy.kinetic[-1] > 5.0
        assert np.abs(result.energy.balance - result.energy.balance[0]).max() < 1e-4

    def test_converged(self):
        """128+8 elements; a bending layer of about 1 cm travels with the joint: 0.5 mm at 0.75 s."""
        result = sliding.history(sliding.MESHES[0])
        for t, bar in (("0.25", 2e-5), ("0.5", 2e-5), ("0.75", 1.2e-3), ("1", 0.02)):
            i = round(float(t) / sliding.OUTPUT_STEP)
            *place, _ = REFERENCE[f"7.4.converged.t{t}"]
            assert math.dist(result.position("slider.end")[i], place) < bar


class TestBeams:
    """6+2 elements of both beams, mass within 2e-5 m.

    Near 1 s two runs that differ by round-off alone part by some 1e-5 m, see the note in the data. There the
    reference's own formulation is compared, with a new matrix in every iteration.
    """

    CASES = (("original", "orig", 0.3), ("original", "orig", 0.0), ("nonlocking", "ho", 0.0))

    @pytest.mark.parametrize(("element", "name", "nu"), CASES)
    def test_mass(self, element, name, nu):
        result = run(element=element, nu=nu)
        for t in TIMES[:3]:
            assert differences(result, f"7.4.{name}.nu{nu:g}.n6+2.h0.2ms.trap2", t)[0] < 2e-5

    @pytest.mark.parametrize(("element", "name", "nu"), CASES[1:])  # the first one is in the figures
    def test_same_formulation_as_the_reference(self, element, name, nu):
        result = run(element=element, nu=nu, formulation="index2", exact=True)
        for t, bar in (("0.25", 1e-9), ("0.5", 1e-8), ("0.75", 1e-6), ("1", 2e-5)):
            place, s = differences(result, f"7.4.{name}.nu{nu:g}.n6+2.h0.2ms.trap2", t)
            assert place < bar
            assert s < (10 * bar if t != "1" else 2e-3)

    def test_figures_with_lateral_contraction(self):
        """s of the nonlocking element shows the vibrations of its sections first: compared up to 0.25 s."""
        bars = {"original": (1e-9, 1e-8, 1e-6, 2e-5), "nonlocking": (1e-8, 1e-6, 2e-5, 1e-3)}
        for mesh, name in zip(sliding.MESHES[3:], ("orig", "ho"), strict=True):
            result = sliding.history(mesh)
            for t, bar in zip(TIMES, bars[mesh.element], strict=True):
                i = round(float(t) / sliding.OUTPUT_STEP)
                *place, s = REFERENCE[f"7.4.{name}.nu0.3.n6+2.h0.2ms.trap2.t{t}"]
                assert math.dist(result.position("slider.end")[i], place) < bar
                far = abs(result.arc_length("joint")[i] - s)
                if t == "0.25":
                    assert far < 1e-6
                if mesh.element == "original":
                    assert far < (10 * bar if t != "1" else 2e-3)
