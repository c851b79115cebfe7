"""Calls of public functions: a wrong keyword is named, with the near one and what is accepted.

Packages hand over what they offer, once, when they are imported. Only a call that does not fit its
signature costs anything beyond one more call: the signature is looked at when Python has refused it.
"""

from __future__ import annotations

import inspect
import re
import sys
from collections.abc import Callable, Iterable
from functools import wraps
from types import CodeType, FunctionType
from typing import Any, TypeVar

from ..errors import ArgumentError
from .checks import listed, nearest
from .other_words import WANTED, argument_of

T = TypeVar("T")

#: Most names that a message lists.
LISTED = 40
#: A parameter, or several, in a docstring: names, kind and unit, text.
PARAMETER = re.compile(r"^(\S.*?) : (.*)\n?((?:    .*(?:\n|$))*)", re.MULTILINE)
_seen: set[type] = set()


def guard(namespace: dict[str, Any], names: Iterable[str]) -> None:
    """Guard what a package offers, in the namespace of its module."""
    for name in names:
        namespace[name] = guarded(namespace[name])


def guarded(value: T) -> T:
    """A function of the package whose calls are guarded, or a class whose methods are; others as they are.

    The function takes the place of the other in its module, so that it can be pickled.
    """
    if isinstance(value, type):
        if not issubclass(value, BaseException):
            _guard_methods(value)
        return value
    if not isinstance(value, FunctionType) or value.__code__ is _CODE or not _ours(value.__module__):
        return value
    made: Any = called_as(value, value.__name__)
    setattr(sys.modules[value.__module__], value.__name__, made)
    return made  # type: ignore[no-any-return]


def _guard_methods(cls: type) -> None:
    for kind in cls.__mro__:
        if kind in _seen or not _ours(kind.__module__):
            continue
        _seen.add(kind)
        for name, member in list(vars(kind).items()):
            inner = getattr(member, "__func__", member)
            if isinstance(inner, FunctionType) and inner.__code__ is not _CODE and _is_public(name):
                made = called_as(inner, _called(cls, name, kind is cls))
                setattr(kind, name, made if inner is member else type(member)(made))


def _is_public(name: str) -> bool:
    return name == "__init__" or not name.startswith("_")


def _called(cls: type, name: str, own: bool) -> str:
    """How messages name a method: add_beam of models, Section, Section.circle; plot of what several have."""
    if name == "__init__":
        return cls.__name__
    return f"{cls.__name__}.{name}" if own and cls.__name__ != "Model" else name


def _ours(module: str) -> bool:
    return module.partition(".")[0] == "ancf"


def called_as(function: Callable[..., Any], where: str) -> Callable[..., Any]:
    """A function whose wrong calls are said of ``where``; with the names of the module of the other one.

    There its annotations are looked up.
    """
    refusal = _refused

    def call(*arguments: Any, **keywords: Any) -> Any:
        try:
            return function(*arguments, **keywords)
        except TypeError as error:
            # with a frame further down it comes from inside
            if error.__traceback__ is None or error.__traceback__.tb_next is not None:
                raise
            refused = refusal(function, where, arguments, keywords)
            if refused is None:
                raise
        raise refused

    own = FunctionType(call.__code__, function.__globals__, closure=call.__closure__)
    return wraps(function)(own)


def _refused(
    function: Callable[..., Any], where: str, arguments: tuple[Any, ...], keywords: dict[str, Any]
) -> ArgumentError | None:
    """What does not fit the signature; None: it does."""
    signature = inspect.signature(function)
    parameters = [p for p in signature.parameters.values() if p.name not in ("self", "cls")]
    known = [p.name for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY)]
    accepted = f"accepted: {listed(known, LISTED)}" if known else "it takes none"
    for name in keywords:
        if name not in known:
            hint = nearest(name, known) or argument_of(where, name, known)
            return ArgumentError(where, f'unknown argument "{name}", {accepted}', hint)
    by_place = [p.name for p in parameters if p.kind is p.POSITIONAL_OR_KEYWORD]
    count = len(arguments) - len(signature.parameters) + len(parameters)
    if count > len(by_place):
        most = f"at most {len(by_place)} go by place" if by_place else "all go by keyword"
        return ArgumentError(where, f"{count} arguments by place, {most}", accepted)
    given = {*by_place[:count], *keywords}
    missing = [p.name for p in parameters if p.default is p.empty and p.name in known and p.name not in given]
    if missing:
        told = next((WANTED[where, name] for name in missing if (where, name) in WANTED), "")
        told = told or "; ".join([*_described(function, missing), accepted])
        return ArgumentError(where, f"wants {listed(missing, LISTED)}", told)
    twice = [name for name in by_place[:count] if name in keywords]
    return (
        ArgumentError(where, f"{listed(twice, LISTED)} given twice, by place and by keyword")
        if twice
        else None
    )


def _described(function: Callable[..., Any], names: list[str]) -> list[str]:
    """What the docstring says of parameters: kind, unit and first sentence; nothing of others."""
    lines = (inspect.getdoc(function) or "").partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    found = []
    for heads, kind, text in PARAMETER.findall(lines):
        wanted = [name for name in heads.split(", ") if name in names]
        first = " ".join(text.replace("``", "").split()).split(". ")[0].rstrip(".")
        if wanted:
            found.append(f"{listed(wanted)}: {kind}" + (f" ({first})" if first else ""))
    return found


_CODE: CodeType = called_as(guard, "").__code__
