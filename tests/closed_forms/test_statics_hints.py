"""What an equilibrium that is not found says to do: by the place where it ended, and by what may slip."""

import numpy as np
import pytest

import ancf
from ancf.errors import SolveError
from ancf.solvers.statics import equilibrium as statics
from ancf.solvers.statics import path as static_path

SLIPS = "where friction slips for good there is none: simulate"


def bollard(friction, turns=0.5, elements=16):
    """A rope around a bollard, held at one end and pulled at the other."""
    radius, angle = 0.21, np.linspace(np.pi, np.pi * (1 - 2 * turns), 60)
    around = radius * np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=1)
    model = ancf.Model()
    section = ancf.Section(EA=1e5, EI=1e-3, rhoA=0.3, diameter=0.02)
    rope = model.add_beam("rope", path=around, elements=elements, section=section)
    drum = model.add_surface("drum", ancf.Cylinder(radius=0.2, axis=(0, 1, 0)))
    model.add_contact(rope, drum, stiffness=1e8, friction=friction)
    model.pin(rope.start)
    model.add_force(rope.end, 100.0 * np.array([np.sin(angle[-1]), 0, -np.cos(angle[-1])]))
    return model


@pytest.mark.parametrize("friction", [0.1, 0.3])
def test_friction_that_does_not_settle(monkeypatch, friction):
    monkeypatch.setattr(statics, "MOST_RENEWED", 1)
    with pytest.raises(SolveError, match=f"friction did not settle in 1 rounds .{SLIPS}"):
        ancf.equilibrium(bollard(friction))


@pytest.mark.parametrize(("friction", "said"), [(0.3, SLIPS), (0.0, "start nearer to the equilibrium")])
def test_what_surfaces_let_go(monkeypatch, friction, said):
    """Friction is named where there is some."""
    monkeypatch.setattr(statics, "_attempts", lambda core, q: [(1, True)])
    monkeypatch.setattr(statics, "_holding", lambda core: [(core.batches[0], lambda batch, q, last: 1)])
    monkeypatch.setattr(statics, "settle", lambda it, share: "it was stopped")
    with pytest.raises(SolveError, match=f"it was stopped .{said}"):
        ancf.equilibrium(bollard(friction))


@pytest.mark.parametrize("reach", [0.0, 0.25, 0.6])
@pytest.mark.parametrize("steps", [1, 4])
def test_where_the_path_ends(monkeypatch, steps, reach):
    """Natural lengths act in full from the first step on: before any load they may be what fails."""
    monkeypatch.setattr(static_path, "settle", lambda it, share: "it was stopped" if share > reach else None)
    model = ancf.Model(gravity=(0, 0, -9.81))
    section = ancf.Section(EA=1e4, EI=1.0, rhoA=0.1)
    model.clamp(model.add_beam("rod", start=(0, 0, 0), end=(1, 0, 0), elements=4, section=section).start)
    with pytest.raises(SolveError) as caught:
        ancf.equilibrium(model, load_steps=steps)
    alone = "natural lengths alone leave no equilibrium near the initial shape" in str(caught.value)
    assert alone == (reach == 0.0)
    assert "give more load_steps" in str(caught.value)
