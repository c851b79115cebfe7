"""Spans that are reduced to their modes while no pantograph is near, beside the whole line."""

import numpy as np
import pytest

import ancf
from ancf import catenary
from ancf.catenary import Rayleigh, sleeping
from ancf.catenary.lines.stitch import StitchWire
from ancf.catenary.rest import assemble, form
from ancf.solvers.sleeping import parts as far_parts
from ancf.solvers.sleeping.parts import Matrices, cables_of, in_order, parts_of, reduced, shapes_of
from ancf.system.core import residual
from ancf.system.far import ASLEEP
from ancf.system.system import System
from overhead_lines import COARSE, STEP, collector, droppers, short_line

LINES = {
    "unequal spans": {},
    "equal spans": {"spans": [catenary.Span(length=36.0, droppers=droppers(36.0))] * 6, "stagger": 0.2},
    "a gradient": {"height": (0.0, 0.0, 0.03, 0.06, 0.06, 0.06)},
    "much damping": {"damping": Rayleigh(alpha=0.8, beta=1e-4)},
}


def run(line, reduce, speed=60.0, **given):
    return catenary.run(
        line, speed=speed, pantograph=collector(), mesh=COARSE, step=STEP, reduce=reduce, **given
    )


@pytest.mark.parametrize("name", LINES)
def test_the_whole_line_moves_alike(name):
    line = short_line(**LINES[name])
    whole, less = run(line, False), run(line, True)
    assert less.settings[sleeping.REDUCED] == len(line.spans)
    left = next(value for key, value in less.settings.items() if key.startswith("displacement that these"))
    assert 0.0 < left < 2e-4  # they do sleep
    force, other = whole.recordings[0].force, less.recordings[0].force
    late = whole.t > 0.3
    assert np.std(other[late]) == pytest.approx(np.std(force[late]), rel=5e-3)
    assert np.mean(other) == pytest.approx(np.mean(force), rel=1e-3)
    assert np.sqrt(np.mean((other - force) ** 2)) < 0.03 * np.std(force)
    assert np.abs(less.uplift - whole.uplift).max() < 0.01 * np.abs(whole.uplift).max()
    swing, left = np.std(whole.dropper_force, axis=0), less.dropper_force - whole.dropper_force
    assert np.sqrt(np.mean(np.square(left), axis=0)).max() < 0.05 * swing.max()


def test_two_pantographs_and_finer_modes():
    """What is left of the difference falls with the modes that are taken."""
    line, apart = short_line(**LINES["equal spans"]), []
    given = {"spacing": 30.0, "start": 12.0, "window": (100.0, 140.0)}
    whole = run(line, False, **given)
    for frequency in (1.0, 4.0):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(sleeping, "BEYOND", frequency)
            less = run(line, True, **given)
        difference = [a.force - b.force for a, b in zip(less.recordings, whole.recordings, strict=True)]
        apart.append(np.sqrt(np.mean(np.square(difference))))
    assert apart[1] < 0.5 * apart[0]


def test_states_that_are_stored_change_nothing(tmp_path):
    line = short_line()
    plain, stored = run(line, True), run(line, True, output_step=0.05, file=tmp_path / "results.h5")
    assert np.array_equal(plain.recordings[0].force, stored.recordings[0].force)
    assert np.array_equal(plain.dropper_force, stored.dropper_force)
    whole = run(line, False, output_step=0.05)
    wire = whole.result.bodies["contact"]
    for share in (0.1, 0.45, 0.93):
        mine, wanted = (r.result.position(f"contact.at({share * wire.length})") for r in (stored, whole))
        assert np.abs(mine - wanted).max() < 1e-3


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"contact": "joint"}, 'contact="joint"'),
        ({"sensitivities": {"first": ["2-1"]}}, "sensitivities"),
        ({"integrator": ancf.Trapezoidal()}, "an integrator"),
        ({"integrator": ancf.GeneralizedAlpha(0.9, newton=ancf.Newton(modified=False))}, "an integrator"),
    ],
)
def test_what_does_not_go_together(given, said):
    with pytest.raises(ancf.ModelError, match=r"run\.reduce.*" + said.replace("(", r"\(")):
        run(short_line(), True, **given)


def test_no_flag():
    with pytest.raises(ancf.ModelError, match=r"run\.reduce"):
        run(short_line(), "yes")


def parted(line):
    """System of a line with a pantograph, its cables, its parts and their matrices at rest."""
    found = form(line, COARSE)
    overhead = assemble(found)
    rest = sleeping.Sleep(ancf.equilibrium(overhead.model))
    catenary.add_pantograph(overhead, collector(), speed=50.0, start=10.0, label="pantograph")
    system = System(overhead.model)
    system.skip_energies()
    plan, cables = rest.plan(system, overhead), cables_of(system)
    parts = in_order(system, parts_of(system, cables, plan.cuts))
    return system, cables, parts, Matrices(system, cables, parts, plan.rest)


STITCHED = {"stitch": StitchWire(reach=5.0, wire=catenary.Wire(EA=4e6, EI=10.0, mass=0.3, tension=2e3))}


#: Factors of mass and damping in the matrix of a step of 1 ms.
FACTORS = 4e6, 2e3


def stiffness_of(kind, s):
    """The dynamic stiffness that a boundary feels, with its modes."""
    coupling = (s * s + s * kind.drag)[:, None] * kind.coupling
    D = s * s + s * kind.loss + kind.square
    return s * s * kind.mass + s * kind.damping + kind.stiffness - coupling.T @ (coupling / D[:, None])


def stiffness_of_all(blocks, factors):
    """The same with all unknowns inside, for these factors of M, C and K."""
    inner, mixed = (
        sum(getattr(b, name).toarray() * f for b, f in zip(blocks, factors, strict=True))
        for name in ("inner", "mixed")
    )
    whole = sum(b.edge * f for b, f in zip(blocks, factors, strict=True))
    return whole - mixed.T @ np.linalg.solve(inner, mixed)


@pytest.mark.parametrize(
    ("changes", "most"),
    [*((changes, 5e-3) for changes in LINES.values()), (STITCHED, 2e-2)],
    ids=[*LINES, "stitch wires"],
)
def test_a_boundary_feels_what_it_should(changes, most):
    """The dynamic stiffness across the wires of each part against that of all its unknowns.

    Stitch wires have modes so near each other that damping couples them, which is left out.
    """
    line = short_line(**changes)
    _, _, parts, matrices = parted(line)
    assert len(parts) == len(line.spans)
    known = []
    for k, part in enumerate(parts):
        blocks, _ = matrices.of_part(k, part)
        shapes = shapes_of(blocks, 60.0, part.inner % 3 == 1, known)
        known.append(shapes)
        kind = reduced(blocks, shapes, FACTORS)
        up = part.edge % 6 == 2
        for hertz in (0.0, 2.3, 7.1, 15.4):
            s = 2j * np.pi * hertz + (3.0 if hertz else 0.0)  # decay: between the resonances
            wanted = stiffness_of_all(blocks, (s * s, s, 1.0))
            size = np.sqrt(np.abs(np.diag(wanted)[up]))
            left = np.abs(stiffness_of(kind, s) - wanted)[np.ix_(up, up)] / np.outer(size, size)
            assert left.max() < most, (k, hertz)


@pytest.mark.parametrize("step", [5e-4, 1e-3, 2e-3])
def test_a_step_couples_neighbours_alone(step):
    """Within a step a boundary feels what it does with all unknowns, at any number of modes."""
    _, _, parts, matrices = parted(short_line(**LINES["a gradient"]))
    factors = 4.0 / step**2, 2.0 / step
    for k, part in enumerate(parts):
        blocks, _ = matrices.of_part(k, part)
        wanted = stiffness_of_all(blocks, (*factors, 1.0))
        size = np.sqrt(np.diag(wanted))
        size[size == 0.0] = size.max()
        for hertz in (20.0, 60.0):
            shapes = shapes_of(blocks, hertz, part.inner % 3 == 1, [])
            kind = reduced(blocks, shapes, factors)
            coupling = (factors[0] + factors[1] * kind.drag)[:, None] * kind.coupling
            D = factors[0] + factors[1] * kind.loss + kind.square
            found = factors[0] * kind.mass + factors[1] * kind.damping + kind.stiffness
            found -= coupling.T @ (coupling / D[:, None])
            assert np.abs((found - wanted) / np.outer(size, size)).max() < 2e-3, (k, hertz)


def test_modes_are_shared_by_spans_that_are_alike_or_mirrored():
    _, _, parts, matrices = parted(short_line(**LINES["equal spans"]))
    known, solved = [], []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(
            far_parts, "eigh", lambda *a, real=far_parts.eigh, **b: solved.append(len(b)) or real(*a, **b)
        )
        for k, part in enumerate(parts):
            known.append(shapes_of(matrices.of_part(k, part)[0], 60.0, part.inner % 3 == 1, known))
    assert len(parts) == 6
    assert np.count_nonzero(solved) <= 3  # the first span, the last one, and all between
    for k, (part, shapes) in enumerate(zip(parts, known, strict=True)):
        (mass, _, stiffness), _ = matrices.of_part(k, part)
        left = stiffness.inner @ shapes.modes - (mass.inner @ shapes.modes) * shapes.square
        assert np.abs(left).max() < 1e-3 * np.abs(stiffness.inner @ shapes.modes).max()


def assert_nothing_moves_what_sleeps(run, spans):
    """However what is inside moves, and however fast: cables and droppers do without it."""
    core, size, random = run.system.core, run.system.size, np.random.default_rng(2)
    q, v, a = run.memory.q.copy(), np.zeros(size), np.zeros(size)
    asleep = np.flatnonzero(spans.far.part[:, ASLEEP])
    for k in asleep:
        inner = spans.parts[k].inner
        for vector, most in ((q, 1e-3), (v, 1.0), (a, 1.0)):
            vector[inner] += most * random.uniform(-1.0, 1.0, len(inner))
    force = np.zeros(size)
    residual(core.batches, core.ws, q, v, a, np.zeros(size), force)
    assert not force[np.concatenate([spans.parts[k].inner for k in asleep])].any()
    for k in np.setdiff1d(np.arange(len(spans.parts)), asleep):
        assert force[spans.parts[k].inner].any()


def test_asleep_and_awake_again():
    """A part that sleeps and wakes at once is where it was, but for what its modes leave out."""
    found = form(short_line(), COARSE)
    overhead = assemble(found)
    ends = overhead.contact_at(115.0), overhead.messenger_at(115.0)
    overhead.model.add_spring(*ends, stiffness=300.0, length=1.5, name="strut")  # which never goes slack
    rest = sleeping.Sleep(ancf.equilibrium(overhead.model))
    catenary.add_pantograph(overhead, collector(), speed=50.0, start=10.0, label="pantograph")
    start = ancf.equilibrium(overhead.model)
    integrator = ancf.GeneralizedAlpha(0.9, newton=ancf.Newton(tolerance=1e-8, corotate=False))
    live = ancf.stepper(overhead.model, step=STEP, start=start, integrator=integrator, energy=False)
    live.advance(400)
    run = live._run
    q, v = run.memory.q.copy(), run.memory.v.copy()
    springs = run.system.springs.data.copy()
    spans = run.reduce(rest.plan(run.system, overhead))
    assert spans.far.part[:, ASLEEP].sum() >= 3
    ends, places = found.line.supports, np.sort(spans.far.place, axis=0)
    assert np.all((places - np.stack([ends[:-1], ends[1:]], axis=1)) * (1.0, -1.0) > 0.0)
    assert np.abs(places - np.stack([ends[:-1], ends[1:]], axis=1)).max() < 4.0  # the nodes beside them
    assert_nothing_moves_what_sleeps(run, spans)
    with spans.woken():
        assert np.abs(run.memory.q - q)[: run.system.n].max() < 2e-3
    before = [x.copy() for x in spans._changed()]
    with spans.woken():
        assert not np.array_equal(before[0], run.memory.q)
    assert all(np.array_equal(a, b) for a, b in zip(before, spans._changed(), strict=True))
    spans.wake_all()
    assert np.array_equal(run.system.springs.data, springs)
    positions = np.flatnonzero(np.arange(run.system.n) % 6 < 3)
    assert np.abs(run.memory.q - q)[positions].max() <= spans.left_out + 1e-12
    assert np.abs(run.memory.v - v)[positions].max() < 0.05 * np.abs(v[positions]).max()
