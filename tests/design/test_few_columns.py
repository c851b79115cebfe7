"""What factors of a step lack of its matrix, where it has few columns: contacts, moments, joints beside."""

import numpy as np
import pytest

import ancf
from ancf.compiled import kernel
from ancf.linalg.eight_twisted import allocate_twisted
from ancf.sensitivity import follow
from ancf.solvers.derivatives.ahead import ahead_of
from ancf.solvers.derivatives.edge import edge_for
from ancf.solvers.derivatives.lacking import MOST_ROWS, columns_for, made_orthonormal
from helpers import some

METHODS = {
    "trapezoidal": ancf.Trapezoidal(),
    "generalized": ancf.GeneralizedAlpha(0.8),
    "ggl": ancf.GeneralizedAlpha(0.7, formulation="ggl"),
}
#: Numbers of a beam that all models have.
NAMES = ["rope.EA", "rope.rhoA", "rope.length", "rope.bending_damping", "gravity[2]", "rope.start[2]"]


def wire(model, heads, damping, rise=0.0):
    """A wire on springs, along which heads go whose strips are pressed against it; perhaps clamped aslant."""
    section = ancf.Section(EA=1e5, EI=2.0, rhoA=1.0, bending_damping=1e-2, axial_damping=1.0, damping=damping)
    given = {"start": (0, 0, 0), "end": (12, 0, 12 * rise), "elements": 9, "section": section}
    rope = model.add_beam("rope", length=11.9, **given)
    if rise:
        model.clamp(rope.start)
    else:
        model.pin(rope.start)
    model.pin(rope.end)
    for k in range(5):
        x, given = 1.5 + 2 * k, {"stiffness": 2e3, "length": 0.49, "damping": 1.0, "name": f"dropper{k}"}
        model.add_spring(rope.at(x), (x, 0, 0.5 + rise * x), **given)
    for k in range(heads):
        x = 1.037 + 2.3 * k
        head = model.add_point_mass(f"head{k}", at=(x, 0, rise * x + 0.007), mass=4.0 - k)
        model.hold(head, position="xy", displacement=(f"{15 - k}*t", 0, 0))
        foot = model.add_point_mass(f"foot{k}", at=(x, 0, rise * x - 0.5), mass=1.0)
        model.pin(foot, displacement=(f"{15 - k}*t", 0, 0))
        model.add_spring(head, foot, stiffness=300.0, length=0.75, damping=10.0, name=f"lift{k}")
        strip = {"strip": (0.0, 1.0, 0.0), "normal": (0.0, 0.0, 1.0), "name": f"strip{k}"}
        model.add_contact(head, rope, stiffness=5e3 * (1 + k), damping=30.0, **strip)
    return rope


def strips(heads, damping=0.0, rise=0.0, bead=False):
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    rope = wire(model, heads, damping, rise)
    if bead:
        ring = model.add_point_mass("bead", at=(6.0, 0, 0), mass=0.3)
        model.slide(ring, along=rope, name="ring", mass=0.1, viscous=0.2)
        model.add_force(ring, (5.0, 1.0, 0.0))
    return model


def pushed(element):
    """A beam with a moment and a follower force at its end."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    if element == "cable":
        section = ancf.Section(EA=5e5, EI=200.0, rhoA=4.5, axial_damping=50.0, bending_damping=0.1)
    else:
        section = ancf.Section.rectangle(0.1, 0.05, E=1e8, rho=900.0, axial_damping=5e3, bending_damping=3.0)
    given = {"start": (0, 0, 0), "end": (2, 0, 0), "elements": 5, "section": section}
    rope = model.add_beam("rope", element=element, **given)
    model.clamp(rope.start)
    model.add_moment(rope.end, (0.0 if element == "cable" else 8.0, "9*sin(50*t)", 5.0), name="turn")
    jet = ("40*t", 0.0, 0.0) if element == "cable" else (3.0, 4.0, "60*t")
    model.add_follower_force(rope.at(1.7), jet, name="jet")
    return model


CASES = {
    "one strip": lambda: strips(1),
    "one strip, damped": lambda: strips(1, 0.3),
    "two strips, damped": lambda: strips(2, 0.3),
    "three strips": lambda: strips(3),
    "clamped aslant": lambda: strips(2, 0.3, rise=0.003),
    "a ring beside": lambda: strips(1, 0.3, bead=True),
    "moment and jet on a cable": lambda: pushed("cable"),
    "moment and jet on a beam": lambda: pushed("nonlocking"),
}
#: Of these eight vectors do not tell all columns.
MANY = {"three strips", "moment and jet on a beam"}


def followed(build, method, monkeypatch, made=edge_for):
    """Derivatives of states, and how many columns there were at the end."""
    kept = []

    def noted(size, m):
        kept.append(made(size, m))
        return kept[-1]

    monkeypatch.setattr(follow, "edge_for", noted)
    names = (
        ["gravity[2]", "rope.length", "rope.start[2]"]
        if build is CASES["moment and jet on a beam"]
        else NAMES
    )
    found = ancf.simulate(
        build(), t_end=0.0304, step=1e-3, integrator=METHODS[method], sensitivities=names, energy=False
    )
    rows = [(found.sensitivity(name).dq[:], found.sensitivity(name).dv[:]) for name in names]
    places = np.setdiff1d(np.arange(found.system.size), found.system.multipliers)
    return [(q[:, places], v[:, places]) for q, v in rows], kept[-1].columns


def without_twists(core, m, shifts):
    """Matrices whose factors are symmetric: corrections make up for the rest."""
    return ahead_of(core, m, shifts)._replace(twisted=allocate_twisted(core.factor, False))


@pytest.mark.parametrize(("case", "method"), some([(c, m) for c in CASES for m in METHODS]))
def test_at_once_is_what_corrections_come_to(case, method, monkeypatch):
    """By the columns of each step, and with symmetric factors alone; also where columns are many."""
    once, columns = followed(CASES[case], method, monkeypatch)
    assert (columns.number[2] > 0) == (case in MANY)
    assert case in MANY or 0 < columns.number[0] <= 8
    monkeypatch.setattr(follow, "ahead_of", without_twists)
    rounds, none = followed(CASES[case], method, monkeypatch, lambda size, m: edge_for(0, m))
    assert none.probe.shape[1] == 0
    for one, other in zip(once, rounds, strict=True):
        for mine, wanted in zip(one, other, strict=True):
            assert np.max(np.abs(mine - wanted)) < 1e-8 * np.max(np.abs(wanted))


@kernel
def orthonormal(columns):
    return made_orthonormal(columns)


@pytest.mark.parametrize("rank", range(9))
@pytest.mark.parametrize("own", [0, 2])
def test_columns_of_products(rank, own):
    """As many as the products of eight vectors span, also where some are small beside others; orthonormal."""
    rng, columns = np.random.default_rng(rank), columns_for(40, np.arange(own, dtype=np.int64), True)
    rows = rng.standard_normal((20, rank)) * np.logspace(0, -6, max(rank, 1))[:rank]
    given = rows @ rng.standard_normal((rank, 8))
    columns.number[1] = own + 20
    columns.base[own : own + 20] = given
    count = orthonormal(columns)
    assert count == rank
    E = columns.base[own : own + 20, :count]
    assert np.max(np.abs(E.T @ E - np.eye(count)), initial=0.0) < 1e-12
    assert np.max(np.abs(given - E @ (E.T @ given))) < 1e-13 * max(np.max(np.abs(given)), 1e-300) * 8
    assert len(columns.row) == MOST_ROWS
