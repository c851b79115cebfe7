"""The two errors that reach a user: where it happened, what is wrong, what to do."""

from __future__ import annotations

import os
from typing import Any

#: Lines of the package, and of what runs a cell, tell the user of a notebook nothing.
OF_OTHERS = os.path.dirname(__file__), "/IPython/", "\\IPython\\"


class _Told:
    """How a notebook shows an error: the caller's own lines, and the message."""

    def _render_traceback_(self: Any, *rest: Any) -> list[str]:  # asked for by IPython
        import traceback  # nothing else needs it

        frames = traceback.extract_tb(self.__traceback__)
        own = [f for f in frames if not any(part in f.filename for part in OF_OTHERS)]
        places = [f"{_file(f.filename)}, line {f.lineno}: {f.line or ''}".rstrip(" :") for f in own]
        return [*places, f"{type(self).__name__}: {self}", *getattr(self, "__notes__", [])]


class ModelError(_Told, ValueError):
    """The description of the model is wrong; nothing was computed.

    Parameters
    ----------
    where : str
        Place in the model, in the notation of the model file: ``bodies[2].section.EA``,
        or the call and the name: ``add_beam("beam").elements``.
    what : str
        What is wrong, with the offending value.
    hint : str, optional
        What to do about it.

    Attributes
    ----------
    result : Result or None
        What a simulation had computed when, for example, a load function failed.
    """

    result: Any = None

    def __init__(self, where: str, what: str, hint: str = "") -> None:
        self.where, self.what, self.hint = where, what, hint
        super().__init__(_sentence(where, what, hint))

    def __reduce__(self) -> Any:
        return _error, (type(self), self.where, self.what, self.hint, self.__dict__)


class ArgumentError(ModelError, TypeError):
    """A call has an argument that there is not, lacks one or has too many; ``where`` is what was called."""


class UnknownNameError(ModelError, KeyError):
    """Something is asked for by a name that it does not have; mappings take it for a missing key."""

    __str__ = Exception.__str__  # that of KeyError quotes the whole message


class SolveError(_Told, RuntimeError):
    """A solve stopped; what was computed until then is kept.

    Parameters
    ----------
    where : str
        Time, step and coordinate: ``t = 0.1234 s, step 1234, beam node 3 z``.
    what : str
        What happened.
    hint : str, optional
        The likely cause and what to try.

    Attributes
    ----------
    result : Result or None
        What a simulation had computed until then.
    """

    result: Any = None

    def __init__(self, where: str, what: str, hint: str = "") -> None:
        self.where, self.what, self.hint = where, what, hint
        super().__init__(_sentence(where, what, hint))

    def __reduce__(self) -> Any:
        return _error, (type(self), self.where, self.what, self.hint, self.__dict__)

    def advise(self, hint: str) -> None:
        """Put a hint before the one that there is."""
        self.hint = f"{hint}; else {self.hint}" if self.hint else hint
        self.args = (_sentence(self.where, self.what, self.hint),)


class StorageError(SolveError):
    """The file of a run can no longer be written: the disk is full, or gone."""


class Interrupted(KeyboardInterrupt):
    """Ctrl-C during a simulation; ``result`` holds what was computed until then."""

    def __init__(self, result: Any) -> None:
        self.result = result
        super().__init__("the simulation was interrupted")

    def __reduce__(self) -> Any:
        return type(self), (self.result,)


def named(name: Any) -> str:
    """A name as the place of an error; in quotation marks where nothing of it would be seen."""
    text = str(name)
    return text if text.strip() else f'"{text}"'


def called(item: Any) -> str:
    """The name of a thing that has one, or the text that stands for it; of what is neither, what it is."""
    name = getattr(item, "name", item)
    if isinstance(name, str):
        return name
    text = repr(name)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _file(name: str) -> str:
    """A file as a notebook calls it: its cells are files with names of their own."""
    return "cell" if "ipykernel" in name or name.startswith("<ipython") else name


def _sentence(where: str, what: str, hint: str) -> str:
    return f"{where}: {what}" + (f" ({hint})" if hint else "")


def _error(kind: type[Any], where: str, what: str, hint: str, state: dict[str, Any]) -> Any:
    """An error that was pickled, with its result and its notes."""
    made = kind(where, what, hint)
    made.__dict__.update(state)
    return made
