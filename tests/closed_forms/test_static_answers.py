"""What an equilibrium answers while supports move is that of supports that stand: no damping, no friction."""

import numpy as np
import pytest

import ancf
from ancf.model.vary import value_of, varied

G = 9.81
LAWS = {
    "0.04*t": lambda t: 0.04 * t,
    "0.02*sin(3*t)": lambda t: 0.02 * np.sin(3.0 * t),
    "0.01*t**2": lambda t: 0.01 * t**2,
}
ROPE = {"EA": 2e3, "EI": 0.5, "rhoA": 0.3, "axial_damping": 40.0, "bending_damping": 0.3, "diameter": 0.02}
BAR = {
    "width": 0.02,
    "height": 0.02,
    "E": 1e7,
    "rho": 700.0,
    "nu": 0.3,
    "axial_damping": 30.0,
    "bending_damping": 0.2,
}


def section(element):
    return ancf.Section(**ROPE) if element == "cable" else ancf.Section.rectangle(**BAR)


def hung(element, way, **spring):
    """A beam between ends that move, with a spring at one of them and another one at its middle."""
    model = ancf.Model(gravity=(0, 0, -G))
    ends = {"start": (0, 0, 0), "end": (1, 0, 0)}
    beam = model.add_beam("beam", **ends, elements=4, length=0.97, element=element, section=section(element))
    model.pin(beam.start, name="left", displacement=(0, way, way))
    model.pin(beam.end, name="right", displacement=(way, 0, 0))
    given = {"stiffness": 30.0, "damping": 20.0, "length": 0.9} | spring
    model.add_spring(beam.start, (0, 0, 1), name="above", **given)
    model.add_spring(beam.at(0.505), (0.5, 0.3, -1), name="below", **given)
    return model


def turned(element, way):
    """Two bodies on a shaft: one is driven, and a torsion spring and a stiff rod turn the other one."""
    model = ancf.Model(gravity=(0, 0, -G))
    bodies = [
        model.add_rigid_body(name, at=(0, 0, 0), mass=1.0, inertia=(0.1, 0.1, 0.1))
        for name in ("drive", "wheel")
    ]
    model.clamp(bodies[0].centre, rotation=way, axis=(0, 1, 0), name="motor")
    model.hinge(*bodies, axis=(0, 1, 0), name="shaft")
    model.add_torsion_spring(*bodies, axis=(0, 1, 0), stiffness=5.0, damping=3.0, name="twist")
    model.add_spring(
        bodies[1].at(0.2, 0, 0), (0.2, 0, 1), stiffness=8.0, damping=4.0, length=0.9, name="above"
    )
    return model


def touched(element, way):
    """A beam that its ends press upon a drum."""
    model = ancf.Model(gravity=(0, 0, -G))
    ends = {"start": (-0.5, 0, 0.021), "end": (0.5, 0, 0.021)}
    beam = model.add_beam("beam", **ends, elements=6, element=element, section=section(element))
    model.pin(beam.start, name="left", displacement=(0, 0, f"-0.01 - {way}"))
    model.pin(beam.end, name="right", displacement=(0, 0, f"-0.01 - 0.5*({way})"))
    drum = model.add_surface("drum", "cylinder", at=(0, 0, -0.2), axis=(0, 1, 0), radius=0.21)
    model.add_contact(beam, drum, stiffness=1e4, damping=500.0, radius=0.01, name="touch")
    return model


ASKED = {
    hung: [
        lambda s: s.spring_force("above"),
        lambda s: s.spring_force("below"),
        lambda s: s.tension("beam.at(0.1)"),
        lambda s: s.bending_moment("beam.at(0.4)"),
        lambda s: s.reaction("left"),
    ],
    turned: [
        lambda s: s.torsion_moment("twist"),
        lambda s: s.spring_force("above"),
        lambda s: s.reaction("motor"),
    ],
    touched: [
        lambda s: s.contact_force("touch"),
        lambda s: s.contact_line("touch").normal,
        lambda s: s.reaction("left"),
    ],
}
SPRINGS = {
    "damper": {},
    "slack": {"slack": True},
    "friction": {"friction": 3.0},
    "curves": {
        "damper": [[-1.0, -7.0], [0.0, 0.0], [1.0, 9.0]],
        "law": [[-1.0, -5.0], [0.0, 0.0], [1.0, 30.0]],
    },
}
CASES = [
    *((hung, element, {}) for element in ("cable", "nonlocking", "original")),
    *((hung, "cable", given) for given in SPRINGS.values()),
    (turned, "", {}),
    (touched, "cable", {}),
]


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize(("build", "element", "given"), CASES)
@pytest.mark.parametrize("t", [0.4, 1.5])
def test_as_if_they_stood(law, build, element, given, t):
    moving = ancf.equilibrium(build(element, law, **given), time=t)
    still = ancf.equilibrium(build(element, repr(float(LAWS[law](t))), **given))
    assert np.allclose(moving.q, still.q, rtol=0, atol=1e-9)
    assert np.max(np.abs(moving.v)) > 1e-3
    for ask in ASKED[build]:
        wanted = np.asarray(ask(still))
        assert np.max(np.abs(wanted)) > 1e-3
        assert np.allclose(ask(moving), wanted, rtol=1e-6, atol=1e-6 * np.max(np.abs(wanted)))


@pytest.mark.parametrize("law", ["0.04*t", "0.03*t"])
def test_a_run_that_starts_there_has_them(law):
    """Dampers of a run act from its start, and in what is set off."""
    rate = 0.04 if law == "0.04*t" else 0.03
    model = turned("", law)
    state = ancf.equilibrium(model, time=0.5)
    run = ancf.stepper(model, step=1e-3, start=state)
    for one in (run, run.state()):
        assert one.torsion_moment("twist") - state.torsion_moment("twist") == pytest.approx(
            3.0 * rate, rel=1e-6
        )
    model = hung("cable", law)
    state = ancf.equilibrium(model, time=0.5)
    d = state.position("beam.start") - np.array([0, 0, 1.0])
    growth = d @ (0.0, rate, rate) / np.linalg.norm(d)
    run = ancf.stepper(model, step=1e-3, start=state)
    for one in (run, run.state()):
        assert one.spring_force("above") - state.spring_force("above") == pytest.approx(
            20.0 * growth, rel=1e-6
        )


@pytest.mark.parametrize("speed", [0.5, 2.0])
def test_what_is_set_off_moves(speed):
    model = ancf.Model(gravity=(0, 0, -G))
    bob = model.add_point_mass("bob", at=(0, 0, -1), mass=1.0)
    bob.set_motion(velocity=(0, 0, speed))
    model.add_spring(bob, (0, 0, 0), stiffness=50.0, damping=4.0, length=0.5, name="rope")
    assert ancf.equilibrium(model).spring_force("rope") == pytest.approx(G - 4.0 * speed, rel=1e-9)


NUMBERS = {
    hung: [
        "beam.axial_damping",
        "beam.bending_damping",
        "beam.damping",
        "above.damping",
        "above.stiffness",
        "beam.EA",
        "beam.rhoA",
    ],
    turned: ["twist.damping", "twist.stiffness", "above.stiffness", "wheel.mass"],
}


@pytest.mark.parametrize("law", ["0.04*t", "0.01*t**2"])
@pytest.mark.parametrize("build", NUMBERS)
def test_sensitivities(law, build):
    """Of answers at rest by differences; of numbers that act in motion alone they are zero."""
    model = build("cable", law)
    state = ancf.equilibrium(model, time=0.6, sensitivities=NUMBERS[build])
    for name in NUMBERS[build]:
        own, now = state.sensitivity(name), value_of(model, name)
        h = 1e-4 * max(now, 0.01)
        near = [ancf.equilibrium(varied(model, name, now + x * h), time=0.6) for x in (1.0, 0.0)]
        for ask in ASKED[build]:
            found, wanted = np.asarray(own.of(ask)), (np.asarray(ask(near[0])) - ask(near[1])) / h
            if name.endswith("damping"):
                assert np.max(np.abs(found)) < 1e-9
            size = np.max(np.abs(wanted))
            assert np.allclose(
                found, wanted, rtol=0, atol=2e-3 * size + 1e-6 * np.max(np.abs(ask(state))) / max(now, 0.01)
            )
