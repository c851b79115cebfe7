"""A soft rope whose ends follow rough motions, as measured ones are."""

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

import ancf
from ancf.solvers.step.rescue import Rescue, groups_of
from ancf.solvers.stepping import Run
from ancf.system.core import apply_supports, follow_supports, residual
from ancf.system.system import System

RATE = 100.0  # Hz, of the samples
SPAN = 0.24  # s


def rope(EI, damping, inner=8, seed=1, noise=2e-4):
    """A rope of 0.6 m that hangs in two grippers, 2 cm apart at its start and 2.5 cm at its end.

    The grippers swing by 6 cm, with 0.2 mm of noise in every sample but the first; what they hold between
    them is stretched and pressed by that.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(int(RATE * (SPAN + 0.1))) / RATE
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=3e3, EI=EI, rhoA=0.05, bending_damping=damping)
    nodes = np.concatenate([[0.0], np.linspace(0.02, 0.575, inner + 1), [0.6]])
    arc = np.linspace(0.0, np.pi, 9)
    path = np.stack([0.2 * (1 - np.cos(arc)), 0.0 * arc, -0.18 * np.sin(arc)], axis=1)
    beam = model.add_beam(
        "rope", path=path, nodes=nodes, length=0.6, section=section, natural_shape="straight"
    )
    for k, x in enumerate((0.0, 0.02, 0.575, 0.6)):
        side = 1.0 if k < 2 else -1.0
        swing = 0.03 * np.stack([1 - np.cos(9 * t), side * (1 - np.cos(14 * t)), 1 - np.cos(11 * t)], axis=1)
        samples = swing + noise * rng.standard_normal((len(t), 3))
        motion = CubicSpline(t, samples - samples[0])
        model.hold(beam.at(x), position="xyz", displacement=lambda time, f=motion: f(time))
    return model, beam, nodes


def run(step, EI, damping, integrator=None, **arguments):
    model, beam, nodes = rope(EI, damping, **arguments)
    method = ancf.GeneralizedAlpha(0.5) if integrator is None else integrator
    rest = ancf.equilibrium(model)
    result = ancf.simulate(model, t_end=SPAN, step=step, output_step=0.008, start=rest, integrator=method)
    places = np.stack([result.position(beam.at(x)) for x in nodes[2:-2]], axis=1)
    return result, places


class TestRuns:
    """Damping must not make an implicit method fail, whatever the step."""

    @pytest.mark.parametrize(
        ("EI", "damping", "step", "arguments"),
        [
            (1e-4, 1e-5, 2e-3, {"inner": 14}),
            (1e-4, 1e-3, 4e-3, {"inner": 20}),
            (3e-4, 1e-4, 2e-3, {"seed": 2, "noise": 4e-4}),
            (3e-4, 1e-3, 1e-3, {"inner": 20, "seed": 3}),
            (1e-3, 1e-4, 4e-3, {"inner": 14, "noise": 4e-4}),
            (1e-3, 1e-3, 2e-3, {"integrator": ancf.GeneralizedAlpha(0.8)}),
            (3e-3, 1e-3, 4e-3, {"inner": 14, "seed": 4}),
            (3e-3, 0.0, 1e-3, {"integrator": ancf.GeneralizedAlpha(0.0)}),
        ],
    )
    def test_completes_and_agrees_with_a_fine_step(self, EI, damping, step, arguments):
        coarse, places = run(step, EI, damping, **arguments)
        assert coarse.status == "complete"
        _, fine = run(2e-4, EI, damping, **{**arguments, "integrator": ancf.GeneralizedAlpha(0.5)})
        assert np.mean(np.linalg.norm(places - fine, axis=2)) < 1e-3  # m, of a swing of 0.1 m

    def test_does_not_depend_on_what_is_recorded(self):
        """Steps that need help are judged by their energy, whether the run keeps account of it or not."""
        states = []
        for energy in (True, False):
            model, _, _ = rope(3e-4, 1e-3)
            rest = ancf.equilibrium(model)
            method = ancf.GeneralizedAlpha(0.5)
            result = ancf.simulate(model, t_end=0.04, step=4e-3, start=rest, integrator=method, energy=energy)
            assert result.stats.retries > 0
            states.append(result.q[-1])
        assert np.array_equal(*states)


class TestTangent:
    """The tangent is that of the residual, with the damping's change by the positions."""

    @staticmethod
    def systems():
        yield rope(1e-3, 1e-3)[0]
        model = ancf.Model(gravity=(0, 0, -9.81))
        section = ancf.Section(EA=2e3, EI=1e-2, rhoA=0.1, bending_damping=1e-3, axial_damping=3.0)
        beams = [
            model.add_beam(
                f"beam {k}", start=(0, 0.1 * k, 0), end=(1, 0.1 * k, 0.2), elements=4, section=section
            )
            for k in range(2)
        ]
        model.clamp(beams[0].start)
        model.clamp(beams[1].end, rotation=lambda t: 0.3 + t, axis=(0, 1, 0))
        bead = model.add_point_mass("bead", at=(1, 0, 0.2), mass=0.2)
        model.connect(bead, beams[0].end)
        model.add_spring(beams[0].at(0.5), beams[1].at(0.6), stiffness=50.0, damping=2.0)
        yield model

    @pytest.mark.parametrize("which", [0, 1])
    def test_along_any_direction(self, which):
        system = System(list(self.systems())[which])
        core, n, rng = system.core, system.n, np.random.default_rng(which)
        method = ancf.GeneralizedAlpha(0.5)
        rescue = Rescue(system, Run(system, method, 0.0, 1.0, 1e-3, 1).memory)
        rated = np.ones(n)
        rated[system.numbering.all_multipliers()] = 0.0  # they have no rates
        q, v = system.initial_state()
        state = np.stack([q, v, 0.0 * q])
        free = system.free
        state[0, free] += 0.02 * rng.standard_normal(len(free))
        state[1, free] = 3.0 * rng.standard_normal(len(free)) * rated[free]
        follow_supports(core.supports, *state)
        gb, ib = 900.0, 8e5

        def force(along, size):
            moved = state.copy()
            for row, rate in zip(moved, (1.0, gb, ib), strict=True):
                row[:n] += size * rate * along * (1.0 if rate == 1.0 else rated)
            follow_supports(core.supports, *moved)
            r = np.zeros(system.size)
            residual(core.batches, core.ws, *moved, np.zeros(system.size), r)
            apply_supports(core.supports, r)
            return r[:n]

        tangent = rescue._tangent(state, gb, ib)
        for _ in range(3):
            along = np.zeros(n)
            along[free] = rng.standard_normal(len(free))
            wanted = (force(along, 1e-7) - force(along, -1e-7)) / 2e-7
            found = tangent @ along
            assert np.max(np.abs(found - wanted)) < 1e-5 * np.max(np.abs(wanted))

    def test_groups_do_not_grow_with_the_length(self):
        counts = [len(groups_of(System(rope(1e-3, 0.0, inner=k)[0])).start) - 1 for k in (8, 40)]
        assert counts == [18, 18]
