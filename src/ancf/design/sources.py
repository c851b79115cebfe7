"""What the source of a function rests on: other parts of its module, modules of the user's, plain values.

Installed packages and the standard library do not count. Of the function's own module those parts count alone
that it names, directly or through others: the call of the study stands there too, with its number of samples.
"""

from __future__ import annotations

import ast
import dis
import hashlib
import inspect
import sys
import sysconfig
import textwrap
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import lru_cache
from importlib.machinery import PathFinder
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

from .fingerprints import PACKAGE

#: Folders of installed packages.
INSTALLED = ("site-packages", "dist-packages")
#: Instructions that take a name of the module.
OF_MODULE = ("LOAD_GLOBAL", "LOAD_NAME", "LOAD_FROM_DICT_OR_GLOBALS")
#: Kinds of values that say all by their text, and the longest text that is kept.
PLAIN, LONGEST = (bool, int, float, complex, str, bytes, type(None)), 80


def sources(function: Any) -> dict[str, dict[str, str]]:
    """Fingerprints of ``modules`` by name and texts of ``values`` by name that a function rests on."""
    walk = _Walk()
    walk.take(function)
    return {"modules": dict(sorted(walk.modules.items())), "values": dict(sorted(walk.values.items()))}


class _Walk:
    """Goes from a function to all that it names."""

    def __init__(self) -> None:
        self.modules: dict[str, str] = {}
        self.values: dict[str, str] = {}
        self._parts: dict[str, set[str]] = {}
        self._seen: set[Any] = set()

    def take(self, function: Any) -> None:
        """A function, a method, an object that is called or a class, and what it rests on."""
        holder = getattr(function, "__self__", None)
        if holder is not None and not isinstance(holder, ModuleType):
            self._object(holder)
        inner = inspect.unwrap(getattr(function, "__func__", function))
        inner = getattr(inner, "py_func", inner)
        if isinstance(inner, FunctionType):
            self._function(inner)
        elif isinstance(inner, type):
            self._class(inner)
        elif holder is None:
            self._object(inner)

    def _object(self, made: Any) -> None:
        for name, value in getattr(made, "__dict__", {}).items():
            self._value(f"{type(made).__name__}.{name}", value)
        self._class(type(made))

    def _class(self, kind: type) -> None:
        for base in kind.__mro__:
            own = sys.modules.get(base.__module__)
            if own is not None and not installed(getattr(own, "__file__", None)):
                for method in vars(base).values():
                    self.take(method) if isinstance(method, FunctionType) else None
                self._name(base.__qualname__.partition(".")[0], vars(own), own)

    def _function(self, function: FunctionType) -> None:
        if function.__code__ in self._seen:
            return
        self._seen.add(function.__code__)
        own = sys.modules.get(function.__module__ or "")
        if own is not None and installed(getattr(own, "__file__", None)):
            return
        for name, cell in zip(function.__code__.co_freevars, function.__closure__ or (), strict=True):
            with suppress(ValueError):  # of one that is not made yet
                self._value(name, cell.cell_contents)
        for name in _names(function.__code__):
            self._name(name, function.__globals__, own)
        with suppress(OSError, TypeError, SyntaxError, ValueError):
            tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
            self._imports(tree, function.__globals__.get("__package__") or "")

    def _value(self, name: str, value: Any) -> None:
        if isinstance(value, ModuleType):
            self._module(value.__name__)
        elif isinstance(value, FunctionType | type) or inspect.ismethod(value):
            self.take(value)
        elif _is_plain(value):
            text = repr(value)
            long = hashlib.sha256(text.encode("utf-8", "backslashreplace")).hexdigest()
            self.values[name] = text if len(text) <= LONGEST else f"{text[:40]}... ({long[:16]})"

    def _name(self, name: str, names: dict[str, Any], own: ModuleType | None) -> None:
        """A name of the function's module: its value, or the statements that make it."""
        if name.startswith("__") or (id(names), name) in self._seen:
            return
        self._seen.add((id(names), name))
        value = names.get(name)
        text = _text(own)
        if isinstance(value, ModuleType) or (name in names and _is_plain(value) and not _counts(text, name)):
            self._value(name, value)
            return
        if isinstance(value, FunctionType | type) and value.__module__ != names.get("__name__"):
            self._module(value.__module__)
        for statement in _binding(text, name):
            part = ast.get_source_segment(text, statement) or ""
            self._parts.setdefault(text, set()).add(part)
            parts = sorted(self._parts[text])
            assert own is not None
            self.modules[_said(own)] = _hash("\n".join(parts))
            self._imports(statement, names.get("__package__") or "")
            for other in _names(compile(ast.Module([statement], []), "", "exec")):
                self._name(other, names, own)

    def _imports(self, tree: ast.AST, package: str) -> None:
        for name in _imported(tree, package):
            self._module(name)

    def _module(self, name: str) -> None:
        """A module of the user's as a whole, and those that it imports."""
        if ("module", name) in self._seen:
            return
        self._seen.add(("module", name))
        if name.rpartition(".")[0]:
            self._module(name.rpartition(".")[0])
        origin = _origin(name)
        if origin is None or installed(origin):
            return
        with suppress(OSError, SyntaxError, ValueError):
            text = Path(origin).read_text(encoding="utf-8")
            self.modules[name] = _hash(text)
            folder = Path(origin).name == "__init__.py"
            self._imports(ast.parse(text), name if folder else name.rpartition(".")[0])


def installed(origin: str | None) -> bool:
    """Whether a file belongs to an installed package, to the standard library or to this package."""
    if not origin or not origin.endswith(".py"):
        return True
    path = Path(origin).resolve()
    standard = {Path(sysconfig.get_path(key)).resolve() for key in ("stdlib", "platstdlib")}
    return (
        any(part in INSTALLED for part in path.parts)
        or path.is_relative_to(PACKAGE)
        or any(path.is_relative_to(folder) for folder in standard)
    )


def _is_plain(value: Any) -> bool:
    return isinstance(value, PLAIN) or (isinstance(value, tuple) and all(map(_is_plain, value)))


def _names(code: CodeType) -> Iterator[str]:
    """Names of the module that a code takes, also in what is defined inside."""
    for one in dis.get_instructions(code):
        if one.opname in OF_MODULE:
            yield str(one.argval)
        elif isinstance(one.argval, CodeType):
            yield from _names(one.argval)


def _text(own: ModuleType | None) -> str:
    file = getattr(own, "__file__", None)
    if installed(file):
        return ""
    try:
        return Path(str(file)).read_text(encoding="utf-8")
    except (OSError, ValueError):
        return ""


@lru_cache(maxsize=100)
def _statements(text: str) -> list[ast.stmt]:
    try:
        return ast.parse(text).body
    except (SyntaxError, ValueError):
        return []


def _binding(text: str, name: str) -> list[ast.stmt]:
    """Statements of a module that make a name or change it, but what runs in a script alone."""
    found = _statements(text)
    return [one for one in found if name in _bound(one) and not _is_guard(one)]


def _is_guard(statement: ast.stmt) -> bool:
    return isinstance(statement, ast.If) and "__name__" in ast.unparse(statement.test)


def _bound(statement: ast.stmt) -> set[str]:
    """Names that a statement of a module makes, or changes by an item, an attribute or a method."""
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return {statement.name}
    found = set()
    for one in ast.walk(statement):
        if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store):
            found.add(one.id)
        elif isinstance(one, ast.Attribute | ast.Subscript) and isinstance(one.ctx, ast.Store):
            found.add(_root(one))
        elif isinstance(one, ast.FunctionDef | ast.ClassDef):
            found.add(one.name)
        elif isinstance(one, ast.alias):
            found.add((one.asname or one.name).partition(".")[0])
    if isinstance(statement, ast.Expr) and isinstance(statement.value, ast.Call):
        call = statement.value.func
        found |= {_root(call)} if isinstance(call, ast.Attribute) else set()
    return found - {""}


def _root(node: ast.AST) -> str:
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def _counts(text: str, name: str) -> bool:
    """Whether functions change a name of the module: its value is where they are, not what was given."""
    if f"global {name}" not in text and "global" not in text:
        return False
    tree = (one for part in _statements(text) for one in ast.walk(part))
    return any(isinstance(one, ast.Global) and name in one.names for one in tree)


def _imported(tree: ast.AST, package: str) -> Iterable[str]:
    """Whole names of what is imported, modules or what is in them, also by a call with the name."""
    for one in ast.walk(tree):
        if isinstance(one, ast.Import):
            yield from (alias.name for alias in one.names)
        elif isinstance(one, ast.ImportFrom):
            parts = package.split(".") if package else []
            above = parts[: len(parts) - one.level + 1] if one.level else []
            base = ".".join([*above, *filter(None, [one.module])])
            yield from [base, *(f"{base}.{alias.name}".lstrip(".") for alias in one.names)] if base else ()
        elif isinstance(one, ast.Call) and one.args and isinstance(one.args[0], ast.Constant):
            called = ast.unparse(one.func).rpartition(".")[2]
            if called in ("import_module", "__import__") and isinstance(one.args[0].value, str):
                yield one.args[0].value


def _origin(name: str) -> str | None:
    """The file of a module, which is not imported for this."""
    if name in sys.modules:
        return getattr(sys.modules[name], "__file__", None)
    where, spec, whole = None, None, ""
    for part in name.split("."):
        whole = f"{whole}.{part}".lstrip(".")
        try:
            spec = PathFinder.find_spec(whole, where)
        except (ImportError, ValueError, AttributeError):
            return None
        if spec is None:
            return None
        where = list(spec.submodule_search_locations or ())
    return None if spec is None else spec.origin


def _said(own: ModuleType) -> str:
    """The name of a module, of a script that of its file."""
    if own.__name__ in ("__main__", "__mp_main__"):
        return Path(str(own.__file__)).stem
    return own.__name__


def _hash(text: str) -> str:
    return hashlib.sha256(text.encode("utf-8", "backslashreplace")).hexdigest()[:16]
