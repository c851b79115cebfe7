"""What computes one case, in whatever process: an outcome for every end but that of the process."""

from __future__ import annotations

import math
import pickle
import time
import warnings
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from ..errors import ModelError
from ..model.checks import shown
from ..reading import inputs_told
from .fingerprints import fingerprints
from .journal import FAILED, OK, Outcome

Function = Callable[..., Mapping[str, float]]
#: Begins the message of a case whose outputs are of the wrong kind: it is the function that is wrong.
WRONG_KIND = "outputs"


class Noted(dict[str, float]):
    """Outputs of a case with what is to know of it.

    Parameters
    ----------
    outputs : mapping of str to float
    notes : sequence of str
    """

    def __init__(self, outputs: Mapping[str, float], notes: Sequence[str]) -> None:
        super().__init__(outputs)
        self.notes = tuple(notes)


class NotFiniteError(ModelError):
    """A case has an output that is no finite number: others may have one."""


def outcome(function: Function, values: Mapping[str, Any]) -> Outcome:
    """Call the function with the values of one case; an error is an outcome too."""
    start = time.perf_counter()
    with inputs_told() as read:
        made = _outcome(function, values, start)
    return replace(made, files=fingerprints(read)) if read else made


def _outcome(function: Function, values: Mapping[str, Any], start: float) -> Outcome:
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            given = function(**values)
            outputs = _numbers(given)
        except Exception as error:
            wrong = isinstance(error, ModelError) and error.where.startswith(WRONG_KIND)
            wrong = wrong and not isinstance(error, NotFiniteError)
            return Outcome(FAILED, {}, _told(error), time.perf_counter() - start, wrong)
    told = [f"warning: {w.message}" for w in caught if w.category is UserWarning]
    told += [f"note: {text}" for text in getattr(given, "notes", ())]
    return Outcome(OK, outputs, "; ".join(dict.fromkeys(told)), time.perf_counter() - start)


def _numbers(given: Any) -> dict[str, float]:
    """Numbers by name.

    Raises
    ------
    ModelError
        They are none.
    """
    if not isinstance(given, Mapping) or not given:
        what = f"must be numbers by name, are {shown(given)} ({type(given).__name__})"
        raise ModelError(WRONG_KIND, what, 'such as return {"tension": 1.0}')
    made = {}
    for name, value in given.items():
        array = np.asarray(value) if not isinstance(value, str | bool) else np.asarray("")
        if array.dtype.kind not in "iuf" or array.size != 1:
            what = f"must be a number, is {shown(value)} ({type(value).__name__})"
            raise ModelError(f"{WRONG_KIND}.{name}", what)
        number = float(array.reshape(-1)[0])
        if not math.isfinite(number):
            raise NotFiniteError(str(name), f"is {number}, must be a finite number")
        made[str(name)] = number
    return made


def _told(error: Exception) -> str:
    """Where, what and what to do, on one line."""
    text = str(error) or type(error).__name__
    named = hasattr(error, "where") and hasattr(error, "what")
    return " ".join((text if named else f"{type(error).__name__}: {text}").split())


def packed(function: Callable[..., Any]) -> bytes:
    """The function as bytes that another process understands, also one of a script or a notebook.

    Raises
    ------
    ModelError
        It holds something that cannot be taken along.
    """
    try:
        import cloudpickle as pickler
    except ImportError:
        pickler = pickle
    try:
        return pickler.dumps(function)  # type: ignore[no-any-return]
    except Exception as error:
        what = f"cannot be handed to other processes: {type(error).__name__}: {error}"
        raise ModelError("study.function", what, "give it plain data, and open files inside it") from None


def unpacked(content: bytes) -> Any:
    """The function again."""
    return pickle.loads(content)
