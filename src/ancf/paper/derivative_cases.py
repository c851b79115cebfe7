"""Computations whose derivatives are compared with differences: models, what is asked, by which numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import Any, NamedTuple

import numpy as np

import ancf

from ..arrays import FloatArray
from ..model.model import Model
from . import cantilever, pendulum, sliding, spin_up

#: Newton's method to round-off: what is compared shall not be what it leaves.
EXACT = ancf.Newton(tolerance=1e-14, modified=False)
TRAPEZOIDAL = ancf.Trapezoidal(newton=EXACT)
INDEX2 = ancf.Trapezoidal(newton=EXACT, formulation="index2")

#: What a computation answers, by the numbers of its model: the answer and its derivatives.
Computed = tuple[FloatArray, dict[str, FloatArray]]


class Question(NamedTuple):
    """A computation, what is asked of it, and by which numbers it is derived.

    Parameters
    ----------
    name, asked : str
        Such as "7.1, cable" and "tip, m".
    model : Model
    compute : callable
        Takes a Model and names of its numbers, returns what is asked and its derivatives.
    widths : dict of str to float
        Names of numbers, and the largest change of each for differences, as a share of it.
    """

    name: str
    asked: str
    model: Model
    compute: Callable[[Model, Sequence[str]], Computed]
    widths: dict[str, float]


def questions(short: bool) -> Iterator[Question]:
    """All questions; the short form has those that are computed soon."""
    yield from _at_rest()
    yield from _examples(short)
    if not short:
        yield from _through(
            ("spring that goes slack", "end", _slackened(), {"loose.length": 1e-5, "rope.EA": 1e-2}),
            ("strip on a wire", "head", _stripped(), {"strip.stiffness": 1e-2, "lift.length": 1e-3}),
            ("rope that meets a sphere", "rope.end", _pressed(), {"touch.stiffness": 1e-2, "rope.EI": 1e-2}),
            ("rope in a current", "rope.end", _flowing(), {"sea.density": 1e-2, "rope.drag[0]": 1e-2}),
            ("body on a hinge", "hub.at(0.1, 0.2, 0)", _hinged(), {"hub.mass": 1e-2, "hub.inertia": 1e-2}),
        )
        yield _of_modes()
        yield _by_adjoint()


def _run(model: Model, names: Sequence[str], *, ask: Any, **settings: Any) -> Computed:
    """A simulation; ``ask`` takes a result or a sensitivity."""
    result = ancf.simulate(model, sensitivities=list(names) or None, **settings)
    return ask(result), {name: ask(result.sensitivity(name)) for name in names}


def _position(face: Any, *, point: str) -> FloatArray:
    found: FloatArray = face.position(point)
    return found


def _at_rest() -> Iterator[Question]:
    """A hanging rope with a tight and a slack stay and a force."""
    names = ("rope.EA", "rope.EI", "rope.rhoA", "gravity", "stay.stiffness", "stay.b[2]", "pull.force[1]")
    widths = dict.fromkeys(names, 1e-2) | {"rope.length": 1e-3, "stay.length": 1e-3}
    for asked, point in (("position", "rope.at(2.4)"), ("tension", "rope.at(0.3)")):

        def answer(face: Any, asked: str = asked, point: str = point) -> FloatArray:
            return np.asarray(getattr(face, asked)(point))

        yield Question("equilibrium of a rope", asked, _stayed(), partial(_resting, ask=answer), widths)


def _resting(model: Model, names: Sequence[str], *, ask: Any) -> Computed:
    state = ancf.equilibrium(model, sensitivities=list(names) or None)
    return ask(state), {name: ask(state.sensitivity(name)) for name in names}


def _examples(short: bool) -> Iterator[Question]:
    """The paper's, of few elements, with its methods."""
    found: list[tuple[str, Model, str, float, float, dict[str, float]]] = [
        ("7.1", cantilever.build(2), "beam.end", 0.1, 5e-4, {"beam.rhoA": 1e-2, "beam.EI": 2e-2}),
        ("7.2", pendulum.build(2), "rope.end", 0.05, 5e-4, {"rope.angular_velocity": 1e-2, "gravity": 5e-2}),
        ("7.3", spin_up.build(2), "arm.end", 1.0, 0.02, {"arm.EI": 2e-2, "arm.rhoA": 1e-2}),
    ]
    for name, model, point, t_end, step, widths in found[: 1 if short else None]:
        settings: Any = {"t_end": t_end, "step": step, "integrator": TRAPEZOIDAL}
        compute = partial(_run, ask=partial(_position, point=point), **settings)
        yield Question(f"example {name}", point, model, compute, widths)
    if not short:
        widths = {"tip.mass": 2e-2, "gravity": 2e-2}
        yield Question("example 7.4", "tip and joint", sliding.build(4, 1), _slid, widths)


def _slid(model: Model, names: Sequence[str]) -> Computed:
    """From the equilibrium of the carrier, which depends on the numbers too."""
    given: Any = {"sensitivities": list(names) or None}
    start = ancf.equilibrium(model, of=["carrier"], **given)
    settings: Any = {"t_end": 0.3, "step": 5e-3, "integrator": INDEX2, "start": start}

    def ask(face: Any) -> FloatArray:
        return np.column_stack([face.position("tip"), face.arc_length("joint")])

    return _run(model, names, ask=ask, **settings)


def _through(*cases: tuple[str, str, Model, dict[str, float]]) -> Iterator[Question]:
    """Short runs through contacts, slack, water and joints."""
    settings: Any = {"t_end": 0.03, "step": 1e-3, "integrator": TRAPEZOIDAL}
    for name, point, model, widths in cases:
        compute = partial(_run, ask=partial(_position, point=point), **settings)
        yield Question(name, point, model, compute, widths)


def _of_modes() -> Question:
    """Frequencies of a rope about its equilibrium, which moves with the numbers."""

    def compute(model: Model, names: Sequence[str]) -> Computed:
        given: Any = {"sensitivities": list(names) or None}
        state = ancf.equilibrium(model, **given)
        modes = ancf.modes(model, about=state, count=4, **given)
        slopes = {name: np.asarray(modes.sensitivity(name).frequencies_hz) for name in names}
        return np.asarray(modes.frequencies_hz), slopes

    widths = {
        "rope.EA": 1e-2,
        "rope.EI": 5e-3,
        "rope.rhoA": 1e-2,
        "rope.length": 1e-4,
        "stay.stiffness": 1e-2,
    }
    return Question("modes of a rope", "frequencies", _stayed(), compute, widths)


def _by_adjoint() -> Question:
    """``ancf.gradient``, backwards through the steps."""
    text = "integral(norm(velocity(rope.end))**2)"

    def compute(model: Model, names: Sequence[str]) -> Computed:
        given: Any = {"t_end": 0.1, "step": 1e-3, "integrator": TRAPEZOIDAL}
        value, slopes = ancf.gradient(model, text, list(names), **given)
        return np.array([value]), {name: np.array([slope]) for name, slope in slopes.items()}

    widths = {"rope.EA": 1e-2, "rope.EI": 1e-2, "rope.rhoA": 1e-2, "gravity": 1e-2}
    return Question("gradient, backwards", text, _hanging(), compute, widths)


def _rope(ends: Any, elements: int, length: Any = None, **section: Any) -> tuple[Model, Any]:
    """A rope in a model with gravity."""
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    start, end = ends
    given = {"EA": 1e4, "EI": 0.05, "rhoA": 0.1} | section
    rope = model.add_beam(
        "rope", start=start, end=end, elements=elements, length=length, section=ancf.Section(**given)
    )
    model.pin(rope.start)
    return model, rope


def _stayed() -> Model:
    model, rope = _rope(((0, 0, 0), (4, 0, 0.5)), 6, 4.2)
    model.pin(rope.end)
    model.add_spring(rope.at(1.4), (1.4, 0.2, 1.0), stiffness=40.0, name="stay")
    model.add_spring(rope.at(2.8), (2.8, 0, 1.0), stiffness=40.0, length=9.0, slack=True, name="loose")
    model.add_force(rope.at(2.0), (0.0, 0.6, -0.4), name="pull")
    return model


def _hanging() -> Model:
    model, rope = _rope(((0, 0, 0), (1, 0, 0)), 3, EA=500.0, EI=0.5)
    rope.set_motion(velocity=(0.0, 0.3, -0.2))
    return model


def _slackened() -> Model:
    """The stay is tight at first, and the end flies towards where it is fixed."""
    model, rope = _rope(((0, 0, 0), (1, 0, 0)), 3, EA=500.0, EI=0.5)
    load = model.add_point_mass("end", at=(1, 0, 0), mass=0.2)
    model.connect(load, rope.end)
    model.add_spring(load, (1, 0, 0.6), stiffness=400.0, length=0.595, slack=True, name="loose")
    rope.set_motion(velocity=(0.0, 0.0, 1.0))
    load.set_motion(velocity=(0.0, 0.0, 1.0))
    return model


def _stripped() -> Model:
    model, rope = _rope(((0, 0, 0), (1, 0, 0)), 2, EA=500.0, EI=0.5)
    model.pin(rope.end)
    head = model.add_point_mass("head", at=(0.5, 0, -0.001), mass=0.4)
    model.add_spring(head, (0.5, 0, -1), stiffness=200.0, length=1.1, name="lift")
    model.add_contact(head, along=rope, stiffness=3000.0, name="strip")
    return model


def _pressed() -> Model:
    model, rope = _rope(((0, 0, 0), (1, 0, 0)), 2, EA=500.0, EI=0.5, diameter=0.02)
    ball = model.add_surface("ball", ancf.Sphere(radius=0.2, at=(0.5, 0, -0.209)))
    model.add_contact(rope, ball, stiffness=2000.0, name="touch")
    rope.set_motion(velocity=(0.0, 0.3, -0.2))
    return model


def _flowing() -> Model:
    wet: dict[str, Any] = {"diameter": 0.02, "drag": (1.0, 0.1), "added_mass": (1.0, 0.0)}
    model, _ = _rope(((0, 0, 0), (1, 0, 0)), 2, EA=500.0, EI=0.5, **wet)
    model.add_fluid("sea", density=1000.0, velocity=(0.5, 0.3, 0))
    return model


def _hinged() -> Model:
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    hub = model.add_rigid_body("hub", at=(1, 0, 0), mass=0.8, inertia=(0.02, 0.03, 0.04))
    load = model.add_point_mass("load", at=(1.5, 0.3, 0.0), mass=0.3)
    model.add_spring(hub.at(0.1, 0.2, 0.0), load, stiffness=300.0, length=0.2, name="link")
    model.hinge(hub.at(-0.2, 0, 0), (0.8, 0, 0), (0, 1, 0))
    return model
