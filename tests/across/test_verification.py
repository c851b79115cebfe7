"""A computation that checks itself: what it repeats, what it compares, and whether the estimate is right."""

import json
import re

import numpy as np
import pytest

import ancf
from ancf.model.refine import refined
from ancf.verification import _changed, _halved, _Output, verify
from places import EXAMPLES

#: Model files: those that say how they are simulated.
FILES = sorted(path.name for path in EXAMPLES.glob("*.toml") if "\n[simulation]" in path.read_text("utf-8"))


def cantilever(elements, **more):
    """Example 7.1 of the paper."""
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0)
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section, strain="paper", **more
    )
    model.clamp(beam.start, stretch="fixed")
    return model, beam


@pytest.mark.parametrize(("elements", "step", "by"), [(4, 2.5e-4, "mesh"), (8, 2e-3, ""), (16, 2e-3, "step")])
def test_estimate_is_the_error(elements, step, by):
    """Against a computation that is far more accurate; where both errors matter they may cancel."""
    model, _ = cantilever(elements)
    found = verify(model, t_end=0.2, step=step, outputs=["beam.end"])
    fine, tip = cantilever(64)
    exact = ancf.simulate(fine, t_end=0.2, step=1.25e-4).position(tip.end)[-1]
    changes = [found[f"beam.end {axis} at t = 0.2 s"] for axis in "xyz"]
    error = max(abs(change.value - wanted) for change, wanted in zip(changes, exact, strict=True))
    estimate = max(change.error for change in changes)
    assert 0.8 * error < estimate < (2 if by else 20) * error
    if by:
        assert all((c.half_step > c.twice_elements) == (by == "step") for c in changes if c.error)


@pytest.mark.parametrize("order", [2, 3])
def test_error_of_known_orders(order):
    """f + a h^p + b l^2, computed with h, l and with one of them halved: both parts are found."""
    part, mesh = 0.3, 0.05
    output = _Output("end", "m", np.array([7.0 + part + mesh]))
    by_step, by_mesh = part - part / 2**order, mesh - mesh / 4
    assert _changed(output, by_step, by_mesh, order).error == pytest.approx(part + mesh)
    assert _changed(output, None, by_mesh, order).error == pytest.approx(mesh)


def test_histories_are_compared_at_the_times_of_the_first():
    """A run with half the step has more of them; between them it is taken along straight lines."""
    t = np.array([0.0, 1.0, 2.0])
    coarse = _Output("end", "m", np.array([0.0, 1.0, 2.0]), t)
    fine = _Output("end", "m", np.array([0.0, 0.9, 1.25, 9.0, 2.125]), np.array([0.0, 0.5, 1.0, 1.5, 2.0]))
    assert coarse.change(fine) == 0.25
    assert _Output("x", "m", np.array([1.0])).change(_Output("x", "m", np.array([0.5]))) == 0.5


def test_compares_with_runs_of_its_own():
    """Every change is the difference of two simulations, of a history the largest at any time."""
    model, beam = cantilever(4)
    found = verify(model, t_end=0.1, step=1e-3, sensors=[beam.end], output_step=5e-3)
    assert [(run["elements"], run["steps"]) for run in found.runs] == [(4, 100), (4, 200), (8, 100)]
    other, end = cantilever(8)
    for moved, again in (
        ("half_step", ancf.simulate(model, t_end=0.1, step=5e-4, sensors=["beam.end"])),
        ("twice_elements", ancf.simulate(other, t_end=0.1, step=1e-3, sensors=[end.end])),
    ):
        every = 2 if moved == "half_step" else 1
        old, new = found.result.sensors, again.sensors
        z = np.abs(new.position("beam.end")[::every, 2] - old.position("beam.end")[:, 2]).max()
        assert getattr(found["beam.end position z"], moved) == pytest.approx(z, rel=1e-9)
        end_z = abs(again.position("beam.end")[-1, 2] - found.result.position("beam.end")[-1, 2])
        assert getattr(found["beam.end z at t = 0.1 s"], moved) == pytest.approx(end_z, rel=1e-9)
        strain = abs(again.energy.strain[-1] - found.result.energy.strain[-1])
        assert getattr(found["strain energy at t = 0.1 s"], moved) == pytest.approx(strain, rel=1e-9)
    assert "half the step" in str(found)
    assert "100 steps of 0.001 s" in str(found)


def test_extremes_of_tension_are_those_of_the_same_elements():
    """Forces of two halves of an element are averaged: a refined mesh is compared at the same places."""
    section = ancf.Section(EA=1e4, EI=0.01, rhoA=0.1)
    model = ancf.Model(gravity=(0, 0, -9.81))
    wire = model.add_beam("wire", start=(0, 0, 0), end=(4, 0, 0.5), elements=6, length=4.2, section=section)
    model.pin(wire.start)
    model.pin(wire.end)
    found = verify(model)
    state = found.result
    middles = 0.5 * (wire.node_x[:-1] + wire.node_x[1:])
    tension = [state.tension(wire.at(x)) for x in middles.tolist()]
    assert found["wire largest tension"].value == pytest.approx(max(tension))
    assert found["wire smallest tension"].value == pytest.approx(min(tension))
    assert found["wire largest tension"].half_step is None
    # the catenary, near enough for a rope that is 1 % longer: its force at the middles
    assert found["wire largest tension"].twice_elements < 0.01 * max(tension)


@pytest.mark.parametrize("natural", ["path", "straight"])
def test_finer_mesh_lies_on_the_given_shape(natural):
    """Not on the cubics of the coarse one: a circle stays a circle."""
    model = ancf.Model()
    arch = model.add_beam(
        "arch",
        path=lambda u: (np.cos(np.pi * u), 0.0, np.sin(np.pi * u)),
        elements=3,
        natural_shape=natural,
        section=ancf.Section(EA=1e4, EI=0.01, rhoA=0.1),
    )
    model.pin(arch.start)
    spring = model.add_spring(arch.at(1.0), arch.end, stiffness=10.0)
    force = model.add_force(arch.at(2.0), lambda t: (0, 0, t))
    finer = refined(model)
    new = finer.bodies["arch"]
    assert (arch.elements, new.elements) == (3, 6)
    assert np.array_equal(new.node_x[::2], arch.node_x)
    assert new.node_position[::2] == pytest.approx(arch.node_position, abs=1e-12)
    assert np.linalg.norm(new.node_position, axis=1) == pytest.approx(1.0, abs=1e-9)
    assert finer.supports[0].point.body is new
    assert finer.connections[0].a.body is new
    assert finer.connections[0] is not spring
    assert finer.loads[0].force is force.force
    assert new.node_x[1::2] == pytest.approx(0.5 * (arch.node_x[:-1] + arch.node_x[1:]))


@pytest.mark.parametrize("parts", [(0.5, 0.5), (0.1, 0.2, 0.7), (0.6, 0.05, 0.25, 0.1)])
@pytest.mark.parametrize("longer", [1.0, 1.02])
def test_new_nodes_lie_at_their_lengths_along_the_shape(parts, longer):
    """Also between nodes at uneven distances that were given: on a circle the angle is the length."""
    model, u = ancf.Model(), np.concatenate([[0.0], np.cumsum(parts)])
    model.add_beam(
        "arch",
        path=lambda u: (np.cos(np.pi * u), 0.0, np.sin(np.pi * u)),
        nodes=u * np.pi * longer,
        length=np.pi * longer,
        section=ancf.Section(EA=1e4, EI=0.01, rhoA=0.1),
    )
    new = refined(model).bodies["arch"]
    angle = np.pi * np.interp(np.arange(2 * len(parts) + 1) / 2, np.arange(len(u)), u)
    wanted = np.stack([np.cos(angle), 0.0 * angle, np.sin(angle)], axis=1)
    assert new.node_x == pytest.approx(angle * longer)
    assert new.node_position == pytest.approx(wanted, abs=1e-6)


@pytest.mark.parametrize(
    ("integrator", "finer"),
    [
        (ancf.Radau(tolerance=1e-5), {"tolerance": 1e-5 / 16}),
        (ancf.Radau(stages=2, tolerance=1e-5, max_step=0.01), {"tolerance": 1e-5 / 8, "max_step": 0.005}),
        (ancf.Radau(tolerance=1e-12), {"tolerance": 1e-12}),
    ],
)
def test_method_that_chooses_its_steps_gets_a_tolerance_that_halves_them(integrator, finer):
    made = _halved(integrator)
    assert {key: getattr(made, key) for key in finer} == finer
    assert _halved(ancf.Trapezoidal()) == ancf.Trapezoidal()


def test_explicit_method_takes_a_step_that_is_stable_on_the_finer_mesh():
    model, _ = cantilever(4)
    step = 0.8 * ancf.stable_step(model)
    found = verify(model, t_end=40 * step, step=step, integrator=ancf.Explicit())
    steps = [run["steps"] for run in found.runs]
    assert steps[1] == 2 * steps[0]
    assert steps[2] in (2 * steps[0], 4 * steps[0])


def test_start_is_found_for_each_mesh():
    model, _ = cantilever(4)
    found = verify(model, t_end=0.01, step=1e-3, start=ancf.equilibrium)
    assert found["kinetic energy at t = 0.01 s"].value == pytest.approx(0.0, abs=1e-12)
    assert found["beam.end z at t = 0.01 s"].half_step < 1e-9
    assert found["beam.end z at t = 0.01 s"].twice_elements > 1e-6
    with pytest.raises(ancf.ModelError, match="must be a function"):
        verify(model, t_end=0.01, step=1e-3, start=ancf.equilibrium(model))


@pytest.mark.parametrize(("given", "missing"), [({"t_end": 1.0}, "step"), ({"step": 1e-3}, "t_end")])
def test_needs_both_times(given, missing):
    with pytest.raises(ancf.ModelError, match=f"verify.{missing}: is missing"):
        verify(cantilever(2)[0], **given)


def test_a_finer_run_that_fails_says_which():
    model, beam = cantilever(2)
    calls = []

    def start(again):
        calls.append(again)
        if len(calls) == 2:
            raise ancf.SolveError("t = 0", "no", "")
        return ancf.equilibrium(again)

    with pytest.raises(ancf.SolveError) as error:
        verify(model, t_end=2e-3, step=1e-3, start=start)
    assert "half the step" in error.value.__notes__[0]
    assert beam.elements == 2


@pytest.mark.parametrize(
    "name",
    # the equilibria of the tackle take 12 s; the hoist has rope on sheaves as well
    [pytest.param(name, marks=pytest.mark.slow) if name == "tackle.toml" else name for name in FILES],
)
def test_every_example_file_verifies_itself(name, call, tmp_path):
    """A few steps of each; table, file, and nothing left of the finer runs."""
    text = (EXAMPLES / name).read_text(encoding="utf-8")
    step = float(re.search(r"^step = (\S+)", text, re.MULTILINE)[1])
    every = float((re.search(r"^output_step = (\S+)", text, re.MULTILINE) or [0, step])[1])
    short = re.sub(r"^t_end = \S+", f"t_end = {2 * every}", text, flags=re.MULTILINE)
    (tmp_path / name).write_text(short, encoding="utf-8")
    ran = call("run", name, "--verify")
    assert ran.code == 0, ran.err
    found = json.loads((tmp_path / "out/verify.json").read_text(encoding="utf-8"))
    first, by_step, by_mesh = found["runs"]
    assert by_step["steps"] == 2 * first["steps"]
    assert by_mesh["elements"] == 2 * first["elements"]
    assert found["changes"]
    for change in found["changes"]:
        assert all(np.isfinite(change[key]) for key in ("value", "half_step", "twice_elements", "error"))
        assert change["output"].split()[0] in ran.out
    samples = {"sensors.csv"} if "sensors = [" in text else set()
    written = {path.name for path in (tmp_path / "out").iterdir()}
    assert written == {"results.h5", "summary.json", "verify.json"} | samples
    call("run", name)
    assert not (tmp_path / "out/verify.json").exists()


def test_statics_of_a_file(call, tmp_path):
    text = (EXAMPLES / "cantilever.toml").read_text(encoding="utf-8")
    (tmp_path / "m.toml").write_text(text[: text.index("[simulation]")] + "[equilibrium]\n", encoding="utf-8")
    assert call("run", "m.toml", "--verify").code == 0
    found = json.loads((tmp_path / "out/verify.json").read_text(encoding="utf-8"))
    assert [run["elements"] for run in found["runs"]] == [16, 32]
    assert all(change["half_step"] is None for change in found["changes"])
