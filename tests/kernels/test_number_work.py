"""What the numbers of batches do to x . force: the kernels against differences of the forces."""

import numpy as np
import pytest

from ancf.batches import Batches
from ancf.compiled import add_number_work, does_something, traits
from ancf.elements.cable_columns import VISCOUS
from ancf.elements.solid_force import LENGTH, M_YY, M_YZ, M_ZZ
from ancf.solvers.derivatives.friction import no_friction
from ancf.solvers.derivatives.pushes import Uses, weigh_pushes
from ancf.solvers.derivatives.sensitivity import Way
from ancf.solvers.rare import knowing
from ancf.system.core import residual
from ancf.system.system import System
from sloped import SPEEDS, WAVES, afloat, in_waves
from strained import SECTIONS, SOLIDLY, cable, of_solids, solid, sprung, states

#: Rows of the constants of beams that are of the fourth order in the size of the section.
QUARTIC = M_YY - LENGTH, M_ZZ - LENGTH, M_YZ - LENGTH


def found_by_kernel(system, batch, q, v, a, x):
    """Derivatives of x . force by the numbers of a batch, from the kernel that weighs them in a run."""
    m = len(traits(batch).numbers(batch))
    uses = Uses(Batches(), np.zeros(1, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0))
    out, work, total = np.zeros(m), np.zeros(system.size), np.zeros(system.size)
    known = knowing(add_number_work, [batch])
    tables = system.inputs.tables(0.0, 0.1, 1, 0.0, 1.0)
    way = Way(*(y[None].copy() for y in (q, v, a)))
    begin, sums = np.array([0, m]), (np.zeros(0), out, np.zeros((0, 3, 3)), total)
    given = uses, known, begin, tables, way, no_friction()
    weigh_pushes(system.core, *given, x[None].copy(), work, *sums)
    assert np.array_equal(total, x)
    return out


def work(system, batch, q, v, a, x):
    r = np.empty(system.size)
    residual(Batches([batch]), system.core.ws, q, v, a, np.zeros(system.size), r)
    return x * r


def check(system, name, field, row, seed=1, size=1.0, grown=1.0):
    """The derivative along a random change of some rows of a field, by differences of order six.

    ``grown``: factor of these rows, where they do little beside others.
    """
    batch = system.parts[name]
    q, v, a, x, rng = states(system, seed)
    values = getattr(batch, field).copy()
    values[:, row] *= grown
    batch = batch._replace(**{field: values})
    change = np.zeros_like(values)
    change[:, row] = size * values[:, row] * rng.uniform(0.2, 1.0, values[:, row].shape)

    def moved(e):
        fresh = {
            key: np.full_like(getattr(batch, key), np.inf) for key in ("kept", "felt") if name == "fluid"
        }
        return batch._replace(**{field: values + e * change}, **fresh)

    def slope(of):
        one, two, three = ((of(e) - of(-e)) / (2 * e) for e in (1e-3, 2e-3, 3e-3))
        return 1.5 * one - 0.6 * two + 0.1 * three

    numbers = traits(batch).numbers
    rate = slope(lambda e: numbers(moved(e)))
    joined = traits(batch).joined or (lambda batch, other: batch)
    own = found_by_kernel(system, joined(batch, moved(1.0)), q, v, a, x)
    wanted = slope(lambda e: work(system, moved(e), q, v, a, x).sum())
    terms, round_off = np.abs(own * rate).sum(), 1e-12 * np.abs(work(system, batch, q, v, a, x)).sum()
    assert abs(own @ rate - wanted) <= 1e-9 * terms + round_off
    assert terms == 0.0 or terms > 1e3 * round_off
    return terms


@pytest.mark.parametrize("elements", [3, 9])
@pytest.mark.parametrize("shape", ["straight", "curved"])
@pytest.mark.parametrize("strain", ["material", "paper"])
@pytest.mark.parametrize("damping", SECTIONS)
def test_of_cables(damping, strain, shape, elements):
    system = System(cable(strain, elements, shape, **SECTIONS[damping])[0])
    for row in range(8):
        terms = check(system, "cable", "lane_data", row)
        needed = {4: "axial_damping", 5: "bending_damping", VISCOUS: "damping"}.get(row)
        assert (terms > 0.0) == (needed is None or needed in SECTIONS[damping]), row
    terms = check(system, "cable", "lane_slope", 0)
    assert (terms > 0.0) == ("slope_damping" in SECTIONS[damping])


@of_solids
def test_of_solid_beams(element, shape, section, damping, elements):
    """The poisson ratio that only the centreline has leaves two of the stiffnesses zero."""
    system = System(solid(element, shape, section, elements, **SOLIDLY[damping])[0])
    for row in range(24):
        terms = check(system, element, "lane_data", row, grown=1e6 if row in QUARTIC else 1.0)
        needed = {18: "axial", 19: "bending", 23: "external"}.get(row)
        there = np.any(system.parts[element].lane_data[:, row])
        assert (terms > 0.0) == (bool(there) if needed is None else damping in (needed, "all")), row


def test_of_springs():
    system = System(sprung())
    for column in (0, 1, 2, 4, 5):
        assert check(system, "springs", "data", column) > 0.0


def test_of_masses():
    model, _ = cable("material", 3, "straight")
    model.add_point_mass("m", at=(0, 0, 1), mass=2.0)
    model.add_rigid_body("hub", at=(0, 1, 1), mass=3.0, inertia=(1.0, 2.0, 2.5))
    system = System(model)
    q, v, a, x, _ = states(system, 2)
    batch = system.parts["bodies"]
    own = found_by_kernel(system, batch, q, v, a, x)
    assert own @ batch.mass == pytest.approx(work(system, batch, q, v, a, x).sum(), rel=1e-12)
    single = np.zeros_like(batch.mass)
    single[2] = 1.0
    assert own[2] == pytest.approx(work(system, batch._replace(mass=single), q, v, a, x).sum(), rel=1e-12)


def test_kinds_that_know_have_numbers():
    model, _ = cable("material", 3, "straight")
    for batch in System(model).parts.values():
        own = traits(batch)
        assert does_something(type(batch), add_number_work) == (own.numbers is not None)
        assert bool(own.numbered) == (own.numbers is not None)
        assert set(own.numbered) <= set(batch._fields)


@pytest.mark.parametrize("kind", WAVES)
def test_of_waves(kind):
    """Of each component height, frequency, wave number, phase and what the depth leaves of it."""
    system = System(in_waves(kind, velocity=SPEEDS["sheared"]))
    for row in range(6):
        terms = check(system, "fluid", "wave", row, size=1.0 if row > 3 else 0.01)  # some are small
        assert terms > 0.0 or not system.parts["fluid"].wave[:, row].any(), row


@pytest.mark.parametrize("kind", ["sheared", "shallow"])
def test_of_lengths_in_fluids(kind):
    """Of points factors of place and slope, weights and where their pieces are, with the surface in one."""
    model = in_waves(kind) if kind in WAVES else afloat(velocity=SPEEDS[kind], above=-1.2, below=0.1)
    system = System(model)
    for field in ("weight", "shift", "shape", "slope"):
        for point in range(5):
            terms = check(system, "fluid", field, point, size=0.01)
            assert terms > 0.0 or field == "shift", (field, point)


@pytest.mark.parametrize("kind", ["sheared", "deep"])
def test_of_fluids(kind):
    """Of fluids density, surface and gravity; of sections area, diameter, drag and added mass."""
    model = in_waves(kind) if kind in WAVES else afloat(velocity=SPEEDS[kind], above=-1.2, below=0.1)
    system = System(model)
    wanted = [("fluids", k) for k in ((0, 2, 5) if kind in WAVES else (0, 1, 2, 5))]
    for field, row in wanted + [("data", k) for k in range(6)]:
        assert check(system, "fluid", field, row, size=0.1) > 0.0, (field, row)
