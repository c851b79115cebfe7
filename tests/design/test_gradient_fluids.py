"""Gradients through fluids: the adjoint against forward sensitivities and against differences of runs."""

import pytest
from backwards import apart, differences, forward
from jointed import methods

import ancf
from ancf.sensitivity.adjoint_joints import JoinedAdjoint, adjoint_of
from ancf.sensitivity.adjoint_sloped import SlopedAdjoint
from ancf.system.system import System
from sloped import SPEEDS, WAVES, afloat, in_waves, of_hull, under_gusts
from slopes import counted_corrections

TIGHT = ancf.Trapezoidal(newton=ancf.Newton(tolerance=1e-14, modified=False))
METHODS = [TIGHT, ancf.GeneralizedAlpha(rho_inf=0.7, newton=TIGHT.newton)]
NAMES = ["rope.EI", "rope.rhoA", "rope.diameter", "rope.drag[0]", "rope.drag[1]", "rope.added_mass[0]"]
NAMES += ["rope.added_mass[1]", "sea.density", "gravity[2]", "rope.length", "rope.start[0]"]
OF_BUOY = ["buoy.mass", "buoy.volume", "buoy.drag_area", "buoy.added_mass"]
OBJECTIVES = [
    "integral(norm(velocity(rope.end))**2)",
    "last(position(rope.at(1.1))[0]) + mean(tension(rope.start))",
]
MOORED = {"axial_damping": 40.0, "bending_damping": 0.5, "damping": 0.2}


@pytest.fixture(autouse=True)
def backwards_alone(monkeypatch, request):
    """No gradient of these tests may go forwards, but those that are about it."""
    if request.function not in (test_what_goes_forwards, test_winches_go_forwards):
        monkeypatch.setattr("ancf.design.gradient._forward", None)


def settings(method=TIGHT, steps=40, step=5e-3):
    return {"t_end": steps * step, "step": step, "integrator": method}


def agree(model, text, names, given, off=1e-9):
    _, slope = ancf.gradient(model, text, names, **given)
    assert apart(model, slope, forward(model, text, names, **given)) < off


@pytest.mark.parametrize("surface", [{}, {"below": 0.02}], ids=["deep", "pierced"])
@pytest.mark.parametrize("speed", SPEEDS)
def test_flows(speed, surface):
    """Alone and as joints, dampings and a point mass have it."""
    agree(afloat(buoy=False, velocity=SPEEDS[speed], **surface), OBJECTIVES[0], NAMES, settings())
    model = afloat(section=of_hull(**MOORED), velocity=SPEEDS[speed], **surface)
    agree(model, OBJECTIVES[1], NAMES + OF_BUOY, settings())


@pytest.mark.parametrize("method", METHODS)
@pytest.mark.parametrize("waves", WAVES)
def test_waves(waves, method):
    for text in OBJECTIVES:
        agree(in_waves(waves, buoy=False), text, NAMES, settings(method))


def test_gusts_over_waves():
    agree(under_gusts(), OBJECTIVES[0], [*NAMES, "air.density"], settings())


@pytest.mark.parametrize("step", [1e-3, 5e-3, 2e-2])
@pytest.mark.parametrize("elements", [1, 3, 9])
@pytest.mark.parametrize("density", [10.0, 1000.0, 13000.0])
def test_of_any_weight(density, elements, step):
    """Added masses that are small beside that of the rope and large, in small and large steps."""
    model = afloat(elements, buoy=False, velocity=SPEEDS["sheared"])
    model.fluids[0] = ancf.model.vary.varied(model, "sea.density", density).fluids[0]
    agree(model, OBJECTIVES[0], NAMES, settings(step=step))


@pytest.mark.parametrize(("step", "most"), [(1e-3, 3.5), (5e-3, 4.5), (2e-2, 5.5)])
def test_corrections(step, most, monkeypatch):
    """After the first few steps, from which the next ones begin, few are enough for round-off."""
    counts = counted_corrections(monkeypatch)
    model = afloat(9, buoy=False, section=of_hull(damping=0.2), velocity=SPEEDS["sheared"], below=0.1)
    ancf.gradient(model, OBJECTIVES[0], ["rope.EI"], **settings(step=step, steps=100))
    ((corrections, steps),) = counts
    assert steps == 100
    assert corrections <= most * steps


@pytest.mark.parametrize("kind", ["sheared", "shallow"])
def test_against_differences(kind):
    """Below the surface, where forces have no kinks."""
    given = {"lift": -1.0, "buoy": False, "section": of_hull(**MOORED)}
    model = in_waves(kind, **given) if kind in WAVES else afloat(velocity=SPEEDS[kind], **given)
    names = ["rope.EI", "rope.drag[0]", "rope.added_mass[0]", "sea.density", "rope.rhoA"]
    _, slope = ancf.gradient(model, OBJECTIVES[0], names, **settings())
    wanted = differences(model, OBJECTIVES[0], names, 1e-3, **settings())
    assert apart(model, slope, wanted) < 3e-10


@pytest.mark.parametrize("kind", WAVES)
def test_gravity_in_waves(kind):
    """Their lengths follow from it, which shows only where there are waves: not at the start of a ramp."""
    model, names = in_waves(kind, lift=-1.0, buoy=False), ["gravity[2]"]
    found = forward(model, OBJECTIVES[0], names, **settings())
    wanted = differences(model, OBJECTIVES[0], names, 1e-3, **settings())
    assert apart(model, found, wanted) < 1e-9


@pytest.mark.parametrize("waves", ["still", "deep"])
def test_diameters_at_a_surface(waves):
    """A run has waves where it first looks for the end of a step, which is 1e-8 of this derivative."""
    model = in_waves("deep", buoy=False) if waves == "deep" else afloat(below=0.02)
    _, slope = ancf.gradient(model, OBJECTIVES[0], ["rope.diameter"], **settings())
    wanted = differences(model, OBJECTIVES[0], ["rope.diameter"], 1e-4, **settings())
    assert apart(model, slope, wanted) < (3e-8 if waves == "deep" else 1e-9)


def test_from_an_equilibrium():
    model = afloat(buoy=False, velocity=(0.4, 0.1, 0.0), below=2.0)
    names, text = ["rope.EI", "sea.density", "rope.diameter"], OBJECTIVES[0]
    model.add_force(model.bodies["rope"].end, ("3*sin(4*t)", 0.0, 0.0), name="push")

    def value(other, names=()):
        start = ancf.equilibrium(other, sensitivities=names)
        return ancf.gradient(other, text, names, start=start, **settings())

    start = ancf.equilibrium(model, sensitivities=names)
    _, slope = value(model, names)
    assert apart(model, slope, forward(model, text, names, start=start, **settings())) < 1e-9


@pytest.mark.parametrize("method", ["trapezoidal ggl", "generalized index2", "generalized index3"])
def test_beside_joints(method):
    """A rigid body clamped to the rope, and an arm on a hinge, whose rows have multipliers."""
    model = afloat(buoy=False, section=of_hull(**MOORED), velocity=SPEEDS["sheared"])
    rope, own = model.bodies["rope"], {"inertia": (0.02, 0.1, 0.1), "volume": 1e-3, "drag_area": 0.02}
    hub = model.add_rigid_body("hub", at=(1.7, 0.4, 0.5), mass=1.0, added_mass=0.5, **own)
    arm = model.add_rigid_body("arm", at=(2.1, 0.4, 0.5), mass=0.7, added_mass=0.2, **own)
    model.clamp(rope.end, to=hub)
    model.hinge(hub.at(0.2, 0, 0), arm.at(-0.2, 0, 0), axis=(0, 1, 0.3), name="elbow")
    assert adjoint_of(System(model)) is JoinedAdjoint
    text = "integral(norm(velocity(arm.centre))**2) + integral(multiplier(elbow)[2]**2)"
    agree(
        model,
        text,
        ["rope.EI", "rope.drag[0]", "hub.volume", "arm.mass", "sea.density"],
        settings(methods()[method], step=1e-3),
        1e-8,
    )


def test_solid_beams():
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    bar = ancf.Section.circle(0.1, E=1e8, rho=900.0, drag=(1.1, 0.2), added_mass=(1.0, 0.0))
    beam = model.add_beam(
        "rope", element="nonlocking", start=(0, 0, -1), end=(1, 0, 1), elements=2, section=bar
    )
    model.clamp(beam.start)
    model.add_fluid("sea", density=1025.0, velocity=(0.5, 0.2, 0.1), below=0.0)
    agree(model, OBJECTIVES[0], ["rope.E", "rope.rho", "sea.density", "gravity[2]"], settings(step=1e-3))


def swirl(t, x, y, z):
    """What numba does not compile."""
    return [float(str(0.3 * x)), 0.2, 0.0]


def test_what_goes_forwards():
    """Laws in Python are called once a step: what they do changes with no unknown of it."""
    assert adjoint_of(System(afloat())) is SlopedAdjoint
    model, given = afloat(buoy=False, velocity=swirl), settings(steps=5)
    assert adjoint_of(System(model)) is None
    _, slope = ancf.gradient(model, OBJECTIVES[0], ["rope.EI"], **given)
    assert slope == pytest.approx(forward(model, OBJECTIVES[0], ["rope.EI"], **given), rel=1e-12)


def test_winches_go_forwards():
    """Of cables with a winch the length is an unknown of the fluid's forces."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    rope = model.add_beam("rope", start=(0, 0, 0), end=(1.5, 0, 0), elements=3, section=of_hull())
    model.pin(rope.start)
    model.winch(rope.end, length="1.5 + 0.1*t")
    model.add_fluid("sea", density=1025.0)
    assert adjoint_of(System(model)) is None
