"""Remarks on a model that is right but may not be meant: what floats, what is slack, what gets large."""

from __future__ import annotations

from collections.abc import Iterator

from ancf.model.beam import Beam
from ancf.model.file import Study
from ancf.model.model import Model
from ancf.model.points import Point

BYTES_PER_NODE = 96
LARGE = 2e9


def notes(study: Study) -> list[str]:
    """All remarks on a study, one line each."""
    return [*_floating(study.model), *_stretched(study.model), *_size(study)]


def floating(model: Model) -> list[str]:
    """Bodies that neither a support nor a chain of connections ties to the ground."""
    tied = {support.point.body.name for support in model.supports}
    links = [_link(item.a, item.b) for item in model.connections]
    tied |= {name for link in links if None in link for name in link if name}
    for _ in model.bodies:
        tied |= {name for link in links if tied & link for name in link if name}
    return [name for name in model.bodies if name not in tied]


def _link(a: Point, b: object) -> frozenset[str | None]:
    return frozenset({a.body.name, b.body.name if isinstance(b, Point) else None})


def _floating(model: Model) -> Iterator[str]:
    for name in floating(model):
        yield f'body "{name}" floats: no support holds it and no connection leads to one'


def _stretched(model: Model) -> Iterator[str]:
    for beam in model.bodies.values():
        if abs(beam.stretch - 1) > 1e-12:
            yield f'body "{beam.name}" starts {_percent(beam)} than its natural length {beam.length:g} m'


def _percent(beam: Beam) -> str:
    return f"{100 * abs(beam.stretch - 1):.3g} % {'longer' if beam.stretch > 1 else 'shorter'}"


def _size(study: Study) -> Iterator[str]:
    settings = study.simulation
    if settings is None:
        return
    nodes = sum(beam.elements + 1 for beam in study.model.bodies.values())
    states = round(settings.t_end / (settings.output_step or settings.step)) + 1
    if nodes * states * BYTES_PER_NODE > LARGE:
        size = nodes * states * BYTES_PER_NODE / 1e9
        yield f"{states} states make a results file of about {size:.0f} GB: give a longer output_step"
