"""Checks shared by the model: each returns the clean value or raises one ModelError that names the place."""

from __future__ import annotations

import difflib
import math
import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from ..arrays import FloatArray
from ..errors import ModelError

T = TypeVar("T")

UNIT = 8 * float(np.finfo(np.float64).eps)  # deviation of a square from 1 that is round-off
ALL = 100  # choices that a message lists
LARGEST = 1e100  # of a coordinate in m or of an inertia in kg m^2


#: Axes by their letters, for messages.
AXES = {"x": "(1, 0, 0)", "y": "(0, 1, 0)", "z": "(0, 0, 1)"}
#: Letters and digits that look alike.
LOOKS = str.maketrans("l10", "iio")


def shown(value: object, limit: int = 60) -> str:
    """Short text of a value for a message."""
    text = repr(value)
    return text if len(text) <= limit else text[: limit - 3] + "..."


def named(value: object) -> str:
    """The same of what should be no class, which is called by its name."""
    return f"the class {value.__name__}" if isinstance(value, type) else shown(value)


def spot(r: FloatArray) -> str:
    """A vector for a message, in six digits."""
    return f"({', '.join(f'{x:.6g}' for x in r.tolist())})"


def number(value: object, where: str) -> float:
    """A finite float; no bool, no text, no NaN."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | float | np.integer | np.floating):
        raise ModelError(where, f"must be a number, is {shown(value)} ({type(value).__name__})")
    try:
        clean = float(value)
    except OverflowError:
        clean = math.inf
    if not math.isfinite(clean):
        raise ModelError(where, f"must be a finite number, is {clean}")
    return clean


def answered(value: object, where: str) -> float:
    """A finite float, or an array without axes, as states answer."""
    return number(value[()] if isinstance(value, np.ndarray) and value.ndim == 0 else value, where)


def positive(value: object, where: str) -> float:
    """A finite number > 0."""
    clean = number(value, where)
    if clean <= 0:
        raise ModelError(where, f"must be > 0, is {clean:g}")
    return clean


def non_negative(value: object, where: str) -> float:
    """A finite number >= 0."""
    clean = number(value, where)
    if clean < 0:
        raise ModelError(where, f"must be >= 0, is {clean:g}")
    return clean


def between(value: object, where: str, low: float, high: float) -> float:
    """A number between low and high, both included."""
    clean = number(value, where)
    if not low <= clean <= high:
        raise ModelError(where, f"must be between {low:g} and {high:g}, is {clean:g}")
    return clean


def integer(value: object, where: str, low: int, high: int) -> int:
    """A whole number between low and high, both included."""
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | np.integer):
        raise ModelError(where, f"must be a whole number, is {shown(value)} ({type(value).__name__})")
    if not low <= value <= high:
        raise ModelError(where, f"must be between {low} and {high}, is {shown(int(value))}")
    return int(value)


def components(value: object, where: str) -> int | None:
    """How many numbers there are at each time: 1, 3, or None where the numbers say so."""
    if value is not None and (isinstance(value, bool) or not isinstance(value, int) or value not in (1, 3)):
        raise ModelError(where, f"must be 1 or 3, is {shown(value)}", "the numbers of value at each time")
    return value


def flag(value: object, where: str) -> bool:
    """True or False, nothing else."""
    if not isinstance(value, bool | np.bool_):
        raise ModelError(where, f"must be True or False, is {shown(value)}")
    return bool(value)


def text(value: object, where: str) -> str:
    """A str."""
    if not isinstance(value, str):
        raise ModelError(where, f"must be text, is {shown(value)} ({type(value).__name__})")
    return value


def kind(value: object, where: str, wanted: type[T], hint: str = "", name: str = "") -> T:
    """An object of a class, which the message calls by its name, or by another one."""
    if isinstance(value, wanted):
        return value
    name = name or wanted.__name__
    article = "an" if name[0] in "AEIO" else "a"
    raise ModelError(where, f"must be {article} {name}, is {shown(value)}", hint)


def items(value: object, where: str, hint: str = "") -> tuple[Any, ...]:
    """What a list, a tuple or an array holds; no text, no mapping."""
    one = isinstance(value, str | bytes | Mapping) or getattr(value, "ndim", 1) == 0
    if one or not isinstance(value, Iterable):
        raise ModelError(where, f"must be a list, is {shown(value)}", hint)
    return tuple(value)


def mapping(value: object, where: str, hint: str = "") -> dict[Any, Any]:
    """What a mapping holds; nothing of None."""
    if value is not None and not isinstance(value, Mapping):
        raise ModelError(where, f"must be a mapping, is {shown(value)}", hint)
    return dict(value or {})


def numbers_named(value: Any, where: str) -> Any:
    """Numbers of a model by which derivatives are wanted, a list or a mapping; none of None."""
    if value is None:
        return ()
    if isinstance(value, str | bytes) or not isinstance(value, Mapping | Sequence):
        what = f"must be a list of names of numbers, is {shown(value)}"
        raise ModelError(where, what, 'such as ["beam.EI", "gravity"], or {name: (value, build)}')
    return value


def path(value: object, where: str) -> Path:
    """A path, or the text of one."""
    if not isinstance(value, str | os.PathLike):
        raise ModelError(where, f"must be a path, is {shown(value)}")
    return Path(value)


def is_function(value: object) -> bool:
    """Whether something is called as a function; a class would make one of its objects, and do nothing."""
    return callable(value) and not isinstance(value, type)


def function(value: object, where: str, of: str, hint: str = "") -> None:
    """What can be called, and is no class."""
    if is_function(value):
        return
    if isinstance(value, type):
        hint = hint or "what a class makes is not used: give a function, or an object that can be called"
    raise ModelError(where, f"must be a function of {of}, is {named(value)}", hint)


def progress(value: object, where: str) -> None:
    """What is called while a computation goes on, or nothing."""
    if value is not None:
        function(value, where, "the progress", "such as print")


def array(value: object, where: str, shape: tuple[int | None, ...]) -> FloatArray:
    """A finite float array of the given shape; None in the shape stands for any count."""
    clean = _from_numpy(value, where) if hasattr(value, "__array__") else _from_list(value, where, len(shape))
    fits = len(clean.shape) == len(shape) and all(
        n is None or n == m for n, m in zip(shape, clean.shape, strict=True)
    )
    if not fits:
        raise ModelError(where, f"has shape {clean.shape}, wanted {_shape_text(shape)}")
    return clean


def floats(value: object, where: str) -> FloatArray:
    """A float array of any shape, which a number is too."""
    try:
        clean: FloatArray = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        raise ModelError(where, f"must be a number or an array of them, is {shown(value)}") from None
    if value is None:  # numpy takes it for NaN
        raise ModelError(where, "must be a number or an array of them, is None")
    return clean


def increasing(values: FloatArray, where: str, what: str, unit: str) -> None:
    """Raise ModelError unless there are two values (n,) or more, each greater than the one before it."""
    if values.size < 2:
        raise ModelError(where, f"must be at least 2 increasing {what}")
    late = np.flatnonzero(np.diff(values) <= 0.0)
    if late.size:
        k = int(late[0]) + 1
        wrong = f"is {values[k]:.9g}{unit} after {values[k - 1]:.9g}{unit}: {what} must be increasing"
        raise ModelError(f"{where}[{k}]", wrong, "sort the rows, each once")


def curve(value: object, where: str) -> FloatArray:
    """Two rows or more (n, 2) of a place and a value, the places increasing."""
    clean = array(value, where, (None, 2))
    if len(clean) < 2:
        raise ModelError(where, f"has {len(clean)} rows", "give two or more, [place, value] each")
    late = np.flatnonzero(np.diff(clean[:, 0]) <= 0.0)
    if late.size:
        k = int(late[0]) + 1
        what = f"is {clean[k, 0]:g} after {clean[k - 1, 0]:g}"
        raise ModelError(f"{where}[{k}][0]", what, "sort the rows, each place once")
    return clean


def vector(value: object, where: str) -> FloatArray:
    """Three finite numbers."""
    if isinstance(value, int | float) and not isinstance(value, bool):
        what = f"must be a list of three numbers, is {shown(value)}"
        along = f"{value:g}" if isinstance(value, float) else shown(value)  # an int may be beyond all floats
        raise ModelError(where, what, f"along z it is (0, 0, {along})")
    return array(value, where, (3,))


def place(value: object, where: str) -> FloatArray:
    """Three finite numbers that can be squared without overflow: a position, m."""
    clean = vector(value, where)
    if max(map(abs, clean.tolist())) > LARGEST:
        raise ModelError(where, f"is {clean.tolist()} m, must be within {LARGEST:g} m")
    return clean


def direction(value: object, where: str) -> FloatArray:
    """Unit vector along three numbers that are not all zero; one that is of unit length stays as it is."""
    if isinstance(value, str) and value.strip().lower() in AXES:
        what = f"must be a list of three numbers, is {shown(value)}"
        raise ModelError(where, what, f"{AXES[value.strip().lower()]} is along {value.strip().lower()}")
    clean = vector(value, where)
    largest = float(np.max(np.abs(clean)))
    if largest == 0.0:
        raise ModelError(where, "must not be the zero vector")
    if largest <= 1.0 + UNIT and abs(float(clean @ clean) - 1.0) <= UNIT:
        return clean
    clean = clean / largest
    return clean / float(np.linalg.norm(clean))


def choice(value: object, where: str, allowed: Sequence[str]) -> str:
    """One of the allowed words."""
    if isinstance(value, str) and value in allowed:
        return value
    raise ModelError(
        where, f"is {shown(value)}, must be one of {listed(allowed, ALL)}", nearest(value, allowed)
    )


def listed(names: Iterable[str], limit: int = 20) -> str:
    """Quoted names separated by commas, cut after ``limit``."""
    quoted = [f'"{name}"' for name in names]
    return ", ".join(quoted[:limit]) + (f" and {len(quoted) - limit} more" if len(quoted) > limit else "")


def nearest(value: object, names: Iterable[str]) -> str:
    """Return 'did you mean "x"?' for the most similar name, or nothing.

    One that differs by capitals or by letters and digits that look alike comes before all others.
    """
    if not isinstance(value, str):
        return ""
    known = list(names)
    alike = [name for name in known if isinstance(name, str) and _looks(name) == _looks(value)]
    found = alike or difflib.get_close_matches(value, known, n=1)
    return f'did you mean "{found[0]}"?' if found else ""


def _looks(name: str) -> str:
    """A name as it looks, near enough: l, I and 1 are one, so are O and 0, and capitals."""
    return name.casefold().translate(LOOKS)


def _from_numpy(value: Any, where: str) -> FloatArray:
    raw = np.asarray(value)
    if raw.dtype.kind not in "iuf":
        raise ModelError(where, f"must hold numbers, holds {raw.dtype}")
    clean = np.array(raw, dtype=np.float64)
    if not np.all(np.isfinite(clean)):
        index = tuple(int(i) for i in np.argwhere(~np.isfinite(clean))[0])
        place = "".join(f"[{i}]" for i in index)
        raise ModelError(where + place, f"must be a finite number, is {clean[index]}")
    return clean


def _from_list(value: object, where: str, depth: int) -> FloatArray:
    if isinstance(value, str) or not isinstance(value, Sequence):
        raise ModelError(where, f"must be a list of numbers, is {shown(value)} ({type(value).__name__})")
    if depth == 1:
        return np.array([number(v, f"{where}[{i}]") for i, v in enumerate(value)], dtype=np.float64)
    rows = [_row(v, f"{where}[{i}]", depth - 1) for i, v in enumerate(value)]
    for i, row in enumerate(rows):
        if row.shape != rows[0].shape:
            raise ModelError(f"{where}[{i}]", f"has shape {row.shape}, the rows before have {rows[0].shape}")
    return np.array(rows, dtype=np.float64)


def _row(value: object, where: str, depth: int) -> FloatArray:
    return _from_numpy(value, where) if hasattr(value, "__array__") else _from_list(value, where, depth)


def _shape_text(shape: tuple[int | None, ...]) -> str:
    inside = ", ".join("n" if n is None else str(n) for n in shape)
    return f"({inside},)" if len(shape) == 1 else f"({inside})"
