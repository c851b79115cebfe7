"""What changes of the constants of elements do to all forces: kernels against differences of the forces."""

import numpy as np
import pytest

import ancf
from ancf.batches import Batches
from ancf.compiled import add_changes, does_something, traits
from ancf.elements.cable_columns import DAMPED, INV_L, LENGTH
from ancf.sensitivity.nearby import changes_of
from ancf.solvers.derivatives.friction import no_friction
from ancf.solvers.derivatives.pushes import Uses, add_pushes
from ancf.solvers.derivatives.sensitivity import Way
from ancf.system.core import residual
from ancf.system.system import System
from strained import SECTIONS, SOLIDLY, cable, of_solids, solid, states


def found_by_kernel(system, rates, way, name="cable"):
    """Derivatives of the residuals along changes of the numbers, (changes, steps, size)."""
    count, steps = len(rates), len(way.q)
    uses = Uses(Batches(), np.zeros(1, dtype=np.int64), np.zeros(0, dtype=np.int64), np.zeros(0))
    changes = changes_of(system.parts, [{name: rate} if rate is not None else {} for rate in rates])
    first, push = np.zeros((count, system.size)), np.full((count, steps, system.size), np.nan)
    tables = system.inputs.tables(0.0, 0.1, steps, 0.0, 1.0)
    given = np.zeros((0, 0, 3, 3)), first, np.zeros(count, dtype=bool), tables, way
    add_pushes(system.core, uses, changes, *given, no_friction(), np.zeros(system.size), push)
    return push


def forces(system, batch, way):
    """What the batch adds to the residuals, (steps, size)."""
    found = np.empty_like(way.q)
    for r, q, v, a in zip(found, *way, strict=True):
        residual(Batches([batch]), system.core.ws, q, v, a, np.zeros(system.size), r)
    return found


def sized(values, rng):
    """Random changes of the size of values, and of 0.3 where they are zero."""
    return np.where(values == 0.0, 0.3, values) * rng.uniform(0.2, 1.0, values.shape)


def slope(of):
    """By differences of order six."""
    one, two, three = ((of(e) - of(-e)) / (2 * e) for e in (1e-3, 2e-3, 3e-3))
    return 1.5 * one - 0.6 * two + 0.1 * three


def ways(system):
    """Two random states."""
    each = zip(*(states(system, seed)[:3] for seed in (1, 2)), strict=True)
    return Way(*(np.stack(rows) for rows in each))


@pytest.mark.parametrize("elements", [3, 9])
@pytest.mark.parametrize("shape", ["straight", "curved"])
@pytest.mark.parametrize("strain", ["material", "paper"])
@pytest.mark.parametrize("damping", SECTIONS)
def test_against_differences(damping, strain, shape, elements):
    system = System(cable(strain, elements, shape, **SECTIONS[damping])[0])
    batch, rng, way = system.parts["cable"], np.random.default_rng(3), ways(system)
    every = batch.groups.copy()
    every[:, DAMPED] = 15  # also where a constant is zero
    moves = []
    for row in range(8):
        change = np.zeros_like(batch.lane_data)
        change[:, row] = sized(batch.lane_data[:, row], rng)
        moves.append({"lane_data": change})
    moves.append({"lane_slope": sized(batch.lane_slope, rng)})
    moves.append({"lane_data": sum(move["lane_data"] for move in moves[:8])})

    def moved(move, e):
        fields = {field: getattr(batch, field) + e * by for field, by in move.items()}
        return batch._replace(groups=every, **fields)

    numbers = traits(batch).numbers
    rates = [slope(lambda e, move=move: numbers(moved(move, e))) for move in moves]
    found = found_by_kernel(system, [None, *rates], way)
    assert not found[0].any()
    size = np.abs(forces(system, batch, way)).max()
    for k, (move, own) in enumerate(zip(moves, found[1:], strict=True)):
        wanted = slope(lambda e, move=move: forces(system, moved(move, e), way))
        loose = 1e-9 if k in (LENGTH, INV_L, 9) else 1e-12
        assert np.abs(own - wanted).max() <= loose * np.abs(wanted).max() + 1e-12 * size, k


@of_solids
def test_of_solid_beams(element, shape, section, damping, elements):
    """Of each constant, of all of them, and of stiffnesses, dampings, masses and lengths by themselves."""
    system = System(solid(element, shape, section, elements, **SOLIDLY[damping])[0])
    batch, rng, way = system.parts[element], np.random.default_rng(3), ways(system)
    every = batch.groups.copy()
    every[:, 4:6] = 1  # also where a constant is zero
    kinds = [slice(0, 24), slice(2, 18), slice(18, 20), slice(20, 24), slice(0, 2)]
    moves = []
    for row in [*range(24), *kinds]:
        change = np.zeros_like(batch.lane_data)
        change[:, row] = sized(batch.lane_data[:, row], rng)
        moves.append(change)

    def moved(change, e):
        return batch._replace(groups=every, lane_data=batch.lane_data + e * change)

    rates = [slope(lambda e, move=move: traits(batch).numbers(moved(move, e))) for move in moves]
    found = found_by_kernel(system, [None, *rates], way, element)
    assert not found[0].any()
    size = np.abs(forces(system, batch, way)).max()
    for k, (move, own) in enumerate(zip(moves, found[1:], strict=True)):
        wanted = slope(lambda e, move=move: forces(system, moved(move, e), way))
        loose = 1e-9 if np.any(move[:, :2]) else 1e-12
        assert np.abs(own - wanted).max() <= loose * np.abs(wanted).max() + 1e-12 * size, k
        assert np.any(own) == np.any(wanted), k


def test_kinds_that_know_have_kinds():
    model, _ = cable("material", 3, "straight")
    for batch in System(model).parts.values():
        assert does_something(type(batch), add_changes) == (traits(batch).kinds is not None)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_of_springs(seed):
    """Slack ones that carry or not, with friction, with a law; a change of all and of some springs."""
    model = ancf.Model()
    rng = np.random.default_rng(seed)
    curve = {"law": [(-9.0, -90.0), (9.0, 60.0)]}
    kinds = [{"slack": True}, {"slack": True, "damping": 3.0}, {"friction": 2.0, "damping": 1.0}, curve]
    for k, given in enumerate([*kinds, *kinds]):
        a, b = (model.add_point_mass(f"{end}{k}", at=rng.uniform(-1, 1, 3), mass=1.0) for end in "ab")
        length = 3.0 if k == 4 else 0.1  # this one is slack
        model.add_spring(a, b if k % 2 else (0, 0, 0), stiffness=40.0, length=length, name=f"s{k}", **given)
    system = System(model)
    batch, q = system.parts["springs"], system.initial_state(0.0)[0]
    way = Way(q[None].copy(), rng.uniform(-0.1, 0.1, (1, system.size)), np.zeros((1, system.size)))
    whole = sized(batch.data, rng)
    whole[:, [3, 6]] = 0.0  # flags
    some = np.zeros_like(whole)
    some[2:5] = 0.5 * whole[2:5]
    found = found_by_kernel(system, [None, whole.ravel(), some.ravel()], way, "springs")
    assert not found[0].any()
    for own, change in zip(found[1:], (whole, some), strict=True):

        def moved(e, change=change):
            return forces(system, batch._replace(data=batch.data + e * change), way)

        wanted = slope(moved)
        assert np.abs(own - wanted).max() <= 1e-9 * np.abs(wanted).max()
