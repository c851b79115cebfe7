"""Remarks on a model that is right but may not be meant: what floats, what is slack, what gets large."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from ..errors import ModelError
from ..model.doubts import doubts, drawn_otherwise
from ..model.file import Study
from ..model.functions.series import noises
from ..model.integrators import Radau
from ..model.supports.elsewhere import elsewhere
from ..model.supports.jumps import jumps
from ..model.supports.periods import few_steps
from ..model.supports.sudden import sudden
from ..system.initial_motion import at_rest
from .summary import node_count

if TYPE_CHECKING:
    from ..system.system import System

BYTES_PER_NODE = 96
LARGE = 2e9


def check_equilibrium(study: Study, system: System) -> None:
    """Raise ModelError if the study asks for the equilibrium of something that floats."""
    from ..solvers.statics.floating import check_supported

    settings = study.simulation
    of = None if settings is None else settings.equilibrium_of
    wanted = study.equilibrium if settings is None else settings.start == "equilibrium"
    if wanted:
        check_supported(system, [] if of is None else [name for name in study.model.bodies if name not in of])


def notes(study: Study, system: System) -> list[str]:
    """All remarks on a study, one line each."""
    return [
        *_floating(system),
        *drawn_otherwise(study.model),
        *_elsewhere(study),
        *noises(study.model),
        *_jumps(study),
        *doubts(study.model),
        *_size(study),
    ]


def _floating(system: System) -> Iterator[str]:
    from ..solvers.statics.floating import check_supported

    try:
        check_supported(system, [])
    except ModelError as error:
        yield error.what


def _elsewhere(study: Study) -> Iterator[str]:
    """Of a run from the initial shape what supports and winches do not fit it."""
    settings = study.simulation
    if settings is not None and settings.start != "equilibrium":
        yield from (text for text, _ in elsewhere(study.model))


def _jumps(study: Study) -> Iterator[str]:
    settings = study.simulation
    if settings is not None:
        found = jumps(study.model, 0.0, settings.t_end, settings.step)
        yield from map(str, found)
        still = settings.start == "equilibrium"
        rests = (lambda _, body: True) if still else (lambda _, body: at_rest(body))
        yield from map(str, sudden(study.model, 0.0, settings.t_end, settings.step, rests))
        if not isinstance(settings.integrator, Radau):
            yield from few_steps(study.model, 0.0, settings.t_end, settings.step, found)


def _size(study: Study) -> Iterator[str]:
    settings = study.simulation
    if settings is None:
        return
    nodes = node_count(study.model)
    states = round(settings.t_end / (settings.output_step or settings.step)) + 1
    size = nodes * states * BYTES_PER_NODE
    if size > LARGE:
        yield f"{states} states make a results file of about {size / 1e9:.0f} GB: give a longer output_step"
