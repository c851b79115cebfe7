"""What a computation knows beside the state vectors: which sliding points were held or let go, where
contacts were found last, and what batches remember, as the friction of grounds.

Whether a unilateral joint is open follows from its gap and is not kept.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..arrays import FloatArray
from ..compiled import traits
from ..connections.contact_touch import ARC
from ..connections.sliding import FREE, FROZEN, SLIDES, SlidingBatch
from ..errors import ModelError
from ..model.joints.basic import Slide
from ..model.model import Model
from ..model.surfaces.contact import Contact
from ..system.core import keep_memory
from ..system.system import System


@dataclass(frozen=True)
class Remembered:
    """What goes with a state.

    Parameters
    ----------
    modes : dict of str to int
        SLIDES, FROZEN or FREE by sliding joint, see :mod:`ancf.connections.sliding`.
    places : dict of str to float
        Arc length on the wire by contact, m, from where the next search starts.
    memory : dict of str to ndarray
        What batches remember of the motion until the state, see ``System.memory``.
    inputs : dict of str to float
        The model's inputs in the state; nothing where they are not known.
    led : bool
        Inputs have changed during the run.
    balanced : bool
        It is the state of an equilibrium.
    laid : bool
        In it friction on grounds acts from where cables came down without it.
    """

    modes: dict[str, int] = field(default_factory=dict)
    places: dict[str, float] = field(default_factory=dict)
    memory: dict[str, FloatArray] = field(default_factory=dict)
    inputs: dict[str, float] = field(default_factory=dict)
    led: bool = False
    balanced: bool = False
    laid: bool = False

    def until(self, index: int, q: Any, v: Any, arcs: dict[str, int]) -> Remembered:
        """The same at an earlier stored state, shapes of q and v (n_t, size).

        What has reached an end stands still there: since then its s has not changed by a bit.
        """
        ended = {name for name, mode in self.modes.items() if mode != SLIDES}
        still = {n for n in ended if _stands(q[index:, arcs[n]]) and not np.any(v[index:, arcs[n]])}
        modes = {name: mode if name in still else SLIDES for name, mode in self.modes.items()}
        last = index == q.shape[0] - 1  # the memory is that of the last state
        inputs = self.inputs if last or not self.led else {}
        return Remembered(modes, self.places, self.memory if last else {}, inputs, self.led)


def of_system(system: System) -> Remembered:
    """What a system knows now."""
    batch = _sliding(system)
    modes = [] if batch is None else batch.mode.tolist()
    places = {name: float(system.measured[system.measures[name][ARC]]) for name in _contacts(system.model)}
    held = dict(zip(_slides(system.model), modes, strict=True))
    inputs = system.inputs
    return Remembered(held, places, system.kept_memory(), dict(inputs.given), inputs.changes > 0)


def restore(system: System, known: Remembered) -> None:
    """Let a system know it; what is not in its model is left out."""
    batch = _sliding(system)
    for k, name in enumerate(_slides(system.model)):
        if batch is not None and name in known.modes:
            batch.mode[k] = known.modes[name]
    for name in _contacts(system.model):
        if name in known.places:
            system.measured[system.measures[name][ARC]] = known.places[name]
    for name, x in system.memory.items():
        if name in known.memory and known.memory[name].shape == x.shape:
            x[...] = known.memory[name]


def begin(system: System, q: FloatArray, v: FloatArray, known: Remembered | None) -> None:
    """Let a system begin at a state that knows this, or nothing: then its memory starts there.

    Inputs that were given until the state go on as they were; else they have the values of the model.
    """
    keep_memory(system.core.remembering, q, v)
    if known is None:
        return
    restore(system, known)
    for name, value in known.inputs.items() if known.led else ():
        if name in system.inputs.given:
            system.inputs.give(name, value)


def begin_small(system: System, q: FloatArray, known: Remembered | None) -> None:
    """Let a system begin small vibrations about a state at rest: what friction acts on sticks."""
    begin(system, q, np.zeros_like(q), known)
    for batch in system.core.remembering:
        if (stick := traits(batch).stick) is not None:
            stick(batch)


def create(file: Any, known: Remembered) -> None:
    """Make the data sets ``modes`` and ``places`` and the group ``memory``."""
    for name, values in _rows(known).items():
        file[name] = values
    _write_inputs(file, known)


def write(file: Any, data: Callable[[str], Any], known: Remembered) -> None:
    """Renew what :func:`create` has made; ``data`` gives the data sets of the file by their names."""
    for name, values in _rows(known).items():
        if values.size:
            data(name).write_direct(values)
    _write_inputs(file, known)


def _rows(known: Remembered) -> dict[str, NDArray[Any]]:
    """What is written, by the name of its data set."""
    modes = np.array([*known.modes.values()], dtype=np.int64)
    places = np.array([*known.places.values()], dtype=np.float64)
    memory = {f"memory/{name}": np.ascontiguousarray(x) for name, x in known.memory.items()}
    return {"modes": modes, "places": places, **memory}


def _write_inputs(file: Any, known: Remembered) -> None:
    if known.inputs:
        file.attrs["inputs"] = json.dumps({"values": known.inputs, "led": known.led})


def read(file: Any, model: Model) -> Remembered:
    """What :func:`write` has left there, by the names of the model.

    Raises
    ------
    ModelError
        A mode is none, or there is a table of them.
    """
    for name in ("modes", "places"):
        if file[name].ndim != 1:
            raise ModelError(name, f"has {file[name].ndim} axes, wanted one")
    modes, places = file["modes"][:].tolist(), file["places"][:].tolist()
    if not {*modes} <= {SLIDES, FROZEN, FREE}:
        raise ModelError("modes", f"must each be {SLIDES}, {FROZEN} or {FREE}")
    found = dict(zip(_slides(model), modes, strict=True)), dict(zip(_contacts(model), places, strict=True))
    memory = {name: x[...] for name, x in file["memory"].items()} if "memory" in file else {}
    inputs: dict[str, Any] = {"values": {}, "led": False}
    if "inputs" in file.attrs:
        inputs = json.loads(file.attrs["inputs"])
    values = {name: float(inputs["values"][name]) for name in model.inputs if name in inputs["values"]}
    return Remembered(*found, memory, values, bool(inputs["led"]))


def _slides(model: Model) -> list[str]:
    return [item.name for item in model.connections if isinstance(item, Slide)]


def _contacts(model: Model) -> list[str]:
    return [item.name for item in model.connections if isinstance(item, Contact)]


def _sliding(system: System) -> SlidingBatch | None:
    return next((b for b in system.core.joints.tail if isinstance(b, SlidingBatch)), None)


def _stands(s: FloatArray) -> bool:
    return bool(np.all(s == s[-1]))
