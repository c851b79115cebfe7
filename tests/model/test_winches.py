"""Winches in models, files and results, and what is refused."""

import pickle

import numpy as np
import pytest

import ancf
from ancf.errors import ModelError, SolveError
from ancf.model.file import parse_study

ROPE = ancf.Section(EA=1e4, EI=1e-3, rhoA=0.05)


def hoist(length="3 - ramp(t, 0.1, 0.5)", section=ROPE):
    model = ancf.Model(gravity=(0, 0, -9.81))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -3), elements=4, section=section)
    model.pin(rope.start)
    drum = model.winch(rope.start, length=length, name="drum")
    return model, rope, drum


def test_results_know_the_length(tmp_path):
    model, rope, _ = hoist(lambda t: 3.0 - 0.4 * t * t)
    given = {"step": 1e-3, "output_step": 0.02, "sensors": [rope.start, rope.at(1.0)]}
    result = ancf.simulate(model, t_end=0.2, file=tmp_path / "out.h5", **given)
    loaded = ancf.load(tmp_path / "out.h5")
    again = pickle.loads(pickle.dumps(ancf.equilibrium(hoist()[0])))
    assert again.natural_length("rope") == 3.0
    for found in (result, loaded):  # of which the second has no function any more
        assert found.natural_length("rope") == pytest.approx(3.0 - 0.4 * found.t**2, abs=1e-14)
        assert np.array_equal(found.tension(rope.start), result.tension(rope.start))
        assert np.array_equal(found.sensors.tension(rope.start)[::20], result.tension(rope.start))
        assert np.array_equal(found.sensors.natural_length(rope)[::20], result.natural_length(rope))
        assert np.array_equal(found.momentum, result.momentum)
    assert np.array_equal(loaded.energy.balance, result.energy.balance)
    run = ancf.stepper(model, step=1e-3)
    run.advance(40)
    assert run.natural_length(rope) == result.natural_length(rope)[2]
    assert ancf.equilibrium(model, time=1.0).natural_length(rope) == pytest.approx(2.6)


def test_compressed_and_damped_ropes_are_seen():
    """The forces in the middles, which notes read, are those that tension gives."""
    from ancf.results.tension import element_forces

    damped = ancf.Section(EA=1e4, EI=1e-3, rhoA=0.05, axial_damping=3.0)
    for strain in ("material", "paper"):
        model = ancf.Model(gravity=(0, 0, -9.81))
        rope = model.add_beam(
            "rope", start=(0, 0, 0), end=(2, 0, -2), elements=3, section=damped, strain=strain
        )
        model.pin(rope.end)
        model.winch(rope.end, length="2.8 + 0.2*sin(9*t)")
        result = ancf.simulate(model, t_end=0.1, step=1e-3, output_step=0.02)
        forces = element_forces(rope, result.slots["rope"], result.q, result.v, result.lengths["rope"])
        middles = 0.5 * (rope.node_x[:-1] + rope.node_x[1:])
        wanted = np.stack([result.tension(rope.at(float(x))) for x in middles], axis=1)
        assert forces == pytest.approx(wanted, rel=1e-9)


def test_a_file_says_the_same(tmp_path):
    study = parse_study(
        {
            "gravity": [0, 0, -9.81],
            "bodies": [
                {
                    "name": "rope",
                    "section": {"EA": 1e4, "EI": 1e-3, "rhoA": 0.05},
                    "start": [0, 0, 0],
                    "end": [0, 0, -3],
                    "elements": 4,
                }
            ],
            "supports": [
                {"type": "pin", "point": "rope.start"},
                {"type": "winch", "point": "rope.start", "length": "3 - ramp(t, 0.1, 0.5)", "name": "drum"},
            ],
        }
    )
    model, _rope, _ = hoist()
    results = [ancf.simulate(m, t_end=0.3, step=2e-3).q for m in (model, study.model)]
    assert np.array_equal(*results)
    assert np.array_equal(
        ancf.simulate(ancf.Model.from_dict(model.to_dict()), t_end=0.3, step=2e-3).q, results[0]
    )


def refused(change, *parts):
    model, rope, _ = hoist()

    def made():
        change(model, rope)
        return ancf.equilibrium(model)

    with pytest.raises(ModelError) as error:
        made()
    for part in parts:
        assert part in str(error.value), str(error.value)


@pytest.mark.parametrize(
    ("change", "parts"),
    [
        (lambda m, r: m.winch(r.end, length=2.0), ["drum", "already"]),
        (lambda m, r: m.add_force(r.at(1.5), (1, 0, 0)), ["rope.at(1.5)", "drum", "between the ends"]),
        (lambda m, r: m.add_spring(r.at(0.75), (1, 0, 0), stiffness=1.0), ["between the ends"]),
        (lambda m, r: m.pin(r.at(0.75)), ["between the ends"]),
        (lambda m, r: m.hold(r.end, slope="x"), ["holds a slope"]),
        (lambda m, r: m.clamp(r.end, stretch="fixed"), ["holds a slope", "free"]),
        (lambda m, r: m.add_distributed_load(r, (1, 0, 0), between=(0, 1)), ["a part of the cable"]),
        (lambda m, r: m.slide((0, 0, -1), along=r), ["runs along", "rope"]),
        (lambda m, r: m.add_ground("floor", -5.0, 1e4), ["floor", "rope", "diameter"]),
        (
            lambda m, r: m.winch(
                m.add_beam("b", start=(0, 0, 0), end=(1, 0, 0), elements=2, section=ROPE).at(0.5), 1
            ),
            ["no end"],
        ),
        (lambda m, r: m.winch(m.add_point_mass("p", at=(0, 0, 0), mass=1), 1), ["no cable"]),
        (
            lambda m, r: m.winch(
                m.add_beam("b", path=[(0, 0, 0), (1, 0, 0.2), (2, 0, 0)], elements=2, section=ROPE).end, 1
            ),
            ["natural curvature", "straight"],
        ),
    ],
)
def test_what_does_not_go_together_is_refused(change, parts):
    refused(change, *parts)


@pytest.mark.parametrize("length", [0.0, "-1 + t", lambda t: -2.0])
def test_no_length_at_the_start(length):
    with pytest.raises(ModelError, match=r'winch\("drum"\)\.length.*rope.*t = 0, the least is 0.003 m'):
        hoist(length)


@pytest.mark.parametrize("method", [ancf.Trapezoidal(), ancf.GeneralizedAlpha(0.5)])
def test_a_length_that_falls_to_zero(method):
    """One message with the time and the cable; what was computed until then is kept."""
    model, _, _ = hoist("3 - 6*t*t")
    with pytest.raises((ModelError, SolveError)) as error:
        ancf.simulate(model, t_end=1.0, step=2e-3, integrator=method)
    assert '"rope"' in str(error.value)
    assert "t = 0.70" in str(error.value)


def test_methods_agree():
    """Rates of the length, and the mass that goes with it, for each of them."""
    ends = []
    soft = ancf.Section(EA=200.0, EI=1e-3, rhoA=0.05)
    for method, step in (
        (ancf.Trapezoidal(), 5e-4),
        (ancf.GeneralizedAlpha(0.8), 5e-4),
        (ancf.Radau(), 1e-2),
        (ancf.Explicit(), 2e-4),
    ):
        model, rope, _ = hoist("3 - 0.5*(1 - cos(4*t))", soft)
        model.add_force(rope.end, (0.05, 0, -0.5))
        result = ancf.simulate(model, t_end=0.6, step=step, integrator=method, start=ancf.equilibrium(model))
        ends.append(result.position(rope.end)[-1])
        assert np.abs(result.energy.drift).max() < 1e-4
    for end in ends[1:]:
        assert end == pytest.approx(ends[2], abs=2e-5)
