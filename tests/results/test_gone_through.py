"""Methods that do not end where a beam goes through what it touches say so afterwards."""

import numpy as np
import pytest

import ancf

METHODS = {
    "radau": {"step": 1e-3, "integrator": ancf.Radau(tolerance=1e-5)},
    "explicit": {"step": 5e-5, "integrator": ancf.Explicit(check=False), "output_step": 1e-3},
}
OTHERS = ["drum", "ball", "capsule", "beam"]


def falling(other, stiffness, d, elements=4):
    """A rope of diameter d that falls on a drum, a ball, a capsule or a beam as thick as it is."""
    model = ancf.Model()
    section = ancf.Section(EA=500.0, EI=0.05, rhoA=0.5, diameter=d, bending_damping=0.01)
    ends = {"start": (-0.5, 0, 0.01), "end": (0.5, 0.05, 0.01)}
    rope = model.add_beam("rope", **ends, elements=elements, section=section)
    rope.set_motion(velocity=(0, 0, -2.0))
    foot = -0.5 * d
    if other == "beam":
        bar = model.add_beam("bar", start=(0, -0.3, -d), end=(0.1, 0.4, -d), elements=2, section=section)
        model.clamp(bar.start)
        model.pin(bar.end)
        model.add_contact(rope, bar, stiffness=stiffness, name="it")
        return model
    R = 1.5 * d
    shape = {
        "drum": lambda: ancf.Cylinder(R, (0, 0.025, foot - R), (0, 1, 0)),
        "ball": lambda: ancf.Sphere(R, (0, 0.025, foot - R)),
        "capsule": lambda: ancf.Capsule(R, 0.3, (0, 0.025, foot - R), (0.2, 1, 0)),
    }[other]()
    model.add_contact(rope, model.add_surface(other, shape), stiffness=stiffness, name="it")
    return model


def told(run):
    return [note for note in run.notes if "gone through" in note]


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("d", [0.03, 0.06])
@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("method", METHODS)
def test_deep_ones_are_told_where_others_end(method, other, d):
    """Of what is thinner than elements are long others look between the points that are asked here."""
    with pytest.raises(ancf.SolveError, match="goes through a surface") as ended:
        ancf.simulate(falling(other, 20.0, d), t_end=0.06, step=5e-4)
    run = ancf.simulate(falling(other, 20.0, d), t_end=0.06, **METHODS[method])
    (note,) = told(run)
    assert note.startswith('"it" was ')
    begins = float(note.partition("t = ")[2].partition(" s")[0])
    assert abs(begins - float(str(ended.value).partition("t = ")[2].partition(" s")[0])) < 4e-3
    depth = float(note.partition("was ")[2].partition(" m")[0])
    assert depth == pytest.approx(-np.min(run.contact_gap("it")), rel=1e-2)


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("method", METHODS)
def test_what_bears_says_nothing(method, other):
    model = falling(other, 1e5, 0.05)
    ancf.simulate(model, t_end=0.03, step=2e-4)
    run = ancf.simulate(model, t_end=0.03, **METHODS[method])
    assert np.min(run.contact_gap("it")) < 0.0
    assert told(run) == []
