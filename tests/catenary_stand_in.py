"""A made-up run along a made-up line, with the attributes of a real one and answers known in closed form."""

from types import SimpleNamespace

import numpy as np

from ancf.catenary import Conditions, Elasticity
from ancf.catenary.answers.run_data import Recording, Run

SPAN, SPANS = 60.0, 10
DROPPERS = (5.0, 10.5, 17.0, 23.5, 30.0, 36.5, 43.0, 49.5, 55.0)
LOADS = (69.5, 79.5, 86.1, 86.1, 86.1, 86.1, 86.1, 79.5, 69.5)
STEP = 0.002


def wire(EA, EI, mass, tension):
    return SimpleNamespace(EA=EA, EI=EI, mass=mass, tension=tension, damping=0.0)


def line(spans=SPANS):
    supports = SPAN * np.arange(spans + 1)
    made = SimpleNamespace(
        title="EN 50318:2002 reference model",
        source="made up",
        tags={"system_height": "U", "contact_wire.EA": "U"},
        spans=[SimpleNamespace(length=SPAN, droppers=DROPPERS, pre_sag=(0.0,) * 9)] * spans,
        supports=supports,
        length=SPAN * spans,
        begin=0.0,
        end=SPAN * spans,
        reach=(
            np.concatenate([[-np.inf], 0.5 * (supports[1:] + supports[:-1])]),
            np.concatenate([0.5 * (supports[1:] + supports[:-1]), [np.inf]]),
        ),
        dropper_span=np.repeat(np.arange(spans), 9),
        dropper_number=np.tile(np.arange(9), spans),
        dropper_x=np.concatenate([x0 + np.array(DROPPERS) for x0 in supports[:-1]]),
        twin=False,
        contact_wires=1,
        contact_spacing=None,
        dropper_wire=np.zeros(9 * spans, dtype=int),
        wave_speed=np.sqrt(20e3 / 1.35),
        contact_wire=wire(15e6, 195.0, 1.35, 20e3),
        messenger_wire=wire(10e6, 131.7, 1.07, 16e3),
        damping=SimpleNamespace(alpha=0.0125, beta=1e-4),
        droppers=SimpleNamespace(
            stiffness=1e5, EA=None, mass=0.0, damping=0.0, slack=True, clamp_contact=0.0, clamp_messenger=0.0
        ),
        system_height=(1.2,) * (spans + 1),
        stagger=(0.0,) * (spans + 1),
        cant=(0.0,) * (spans + 1),
        messenger_support=5e4,
        steady_arm=SimpleNamespace(
            vertical=300.0, lateral=None, length=None, mass=0.0, stiffness=1e6, hinged=False
        ),
        contact_support="held",
        anchors="fixed",
        gravity=9.81,
        auxiliary=None,
        report={},
        temperature=10.0,
        conditions=Conditions(),
        dropper_lengths=None,
        dropper_errors=None,
    )
    made.parts = (made,)
    made.height_at = np.zeros_like
    return made


def form(spans=SPANS):
    count = 9 * spans
    lengths = np.tile([0.998, 0.816, 0.660, 0.566, 0.534, 0.566, 0.660, 0.816, 0.998], spans)
    loads = np.tile(LOADS, spans)
    x = np.unique(np.concatenate([line(spans).supports, line(spans).dropper_x]))
    level = np.zeros(x.size)
    nodes = SimpleNamespace(dropper=np.searchsorted(x, line(spans).dropper_x))
    wires = {
        "contact": np.column_stack([x, level, level]),
        "messenger": np.column_stack([x, level, np.interp(x, line(spans).dropper_x, lengths)]),
    }
    made = SimpleNamespace(
        **{name: SimpleNamespace(position=place, nodes=nodes) for name, place in wires.items()},
        auxiliary=None,
        twin=None,
        stitches=(),
        arm_force=np.column_stack(
            [0 * line(spans).supports, 40.0 - line(spans).supports, 0 * line(spans).supports]
        ),
        line=line(spans),
        wave_speed=np.sqrt(20e3 / 1.35),
        dropper_load=loads,
        dropper_force=loads,
        dropper_length=lengths,
        dropper_natural=lengths - loads / 1e5,
        cut_length=lengths - loads / 1e5,
        pull=np.array([[20e3, 20e3], [16e3, 16e3]]),
        contact_height=np.zeros(count),
        messenger_height=lengths,
    )
    made.arm_load = made.arm_force
    made.shifted = (made,)
    made.contact.wire = made.line.contact_wire
    made.contacts = (made.contact,)
    return made


def pantograph(name="en50318-2002"):
    return SimpleNamespace(
        name=name,
        title="EN 50318:2002 pantograph",
        masses=(15.0, 7.2),
        stiffness=(50.0, 4200.0),
        damping=(90.0, 10.0),
        static_force=120.0,
        aerodynamic=0.0,
        aerodynamics=(0.0, 0.0),
        strip_length=1.45,
        tags={"masses": "V", "static_force": "U"},
    )


def elasticity(span=4):
    """0.4 to 0.6 mm/N at 100 N, a tenth more at 200 N: non-uniformity 0.2."""
    x = np.linspace(0.0, SPAN, 61)
    value = np.outer([1.0, 1.1], 0.5 - 0.1 * np.cos(2 * np.pi * x / SPAN))
    force = np.array([100.0, 200.0])
    return Elasticity(span=span, x=x, force=force, lift=1e-3 * value * force[:, None])


def contact_force(position, t, seed=1):
    """Force with the wave lengths of spans and droppers, some noise above 20 Hz, and a short loss."""
    force = 115 + 30 * np.sin(2 * np.pi * position / SPAN) + 14 * np.sin(2 * np.pi * position / 6.5 + 0.4)
    noise = 18 * np.sin(2 * np.pi * 63.0 * t + 3 * np.sin(2 * np.pi * 7 * t))
    lost = (position > 347.0) & (position < 347.6)
    return np.where(
        lost, 0.0, np.maximum(force + noise * np.random.default_rng(seed).normal(1, 0.3, t.size), 0.0)
    )


def bump(x):
    """A wave group around 0, about as an uplift looks: 1 at 0."""
    return np.exp(-((x / 14.0) ** 2)) * np.cos(2 * np.pi * x / 55.0)


def run(spans=SPANS, count=1, spacing=200.0, speed=250 / 3.6, step=STEP, **more):
    """Pantographs `spacing` apart; the first one starts ahead and all end beyond the window."""
    the_form = form(spans)
    supports, droppers = the_form.line.supports, the_form.line.dropper_x
    start = 25.0 + spacing * (count - 1)
    length = (
        the_form.line.length - 25.0 - 25.0
        if count == 1
        else spacing * (count - 1) + the_form.line.length - 50
    )
    t = step * np.arange(int(length / speed / step) + 1)
    records, uplift, slackening = [], np.zeros((t.size, len(supports))), np.zeros((t.size, len(droppers)))
    for k in range(count):
        x = start - k * spacing + speed * t
        inside = np.minimum(x, the_form.line.length - 5.0)
        height = 0.02 + 0.022 * np.cos(2 * np.pi * (inside - 27.0) / SPAN)
        name = "leading" if count > 1 and k == 0 else f"trailing {k}" if count > 1 else "en50318-2002"
        records.append(
            Recording(name, inside, contact_force(inside, t, k), height, 0.0 * t, height - 0.002 - 0.001 * k)
        )
        uplift += 0.052 * bump(inside[:, None] - supports) * (1 + 0.05 * k)
        slackening += 110 * bump(inside[:, None] - droppers)
    dropper_force = np.maximum(the_form.dropper_load + 12 * np.sin(3 * t)[:, None] - slackening, 0.0)
    given = {
        "form": the_form,
        "pantographs": [pantograph() for _ in range(count)],
        "speed": speed,
        "t": t,
        "recordings": records,
        "uplift": uplift,
        "dropper_force": dropper_force,
        "window": (SPAN * (spans // 2 - 1), SPAN * (spans // 2 + 1)),
        "cpu_seconds": 3.1,
        "simulated_seconds": float(t[-1]),
        "real_time_factor": float(t[-1]) / 3.1,
        "settings": {
            "step": step,
            "mesh": {"contact": 1.0, "messenger": 2.0},
            "contact": "penalty",
            "contact_stiffness": 5e4,
            "integrator": "GeneralizedAlpha(rho=0.8)",
        },
    }
    return Run(**{**given, **more})
