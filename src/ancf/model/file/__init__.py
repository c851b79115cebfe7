"""The model file: TOML with the nouns of the Python API, read into a Study or refused with one error."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from pydantic import ValidationError

from ...errors import ModelError
from ...files import exists
from ...reading import as_input
from ..checks import nearest
from ..functions.inputs import first_values, named
from ..model import Model
from ..settings import EquilibriumSettings, SimulationSettings
from . import parameters
from .build import Builder
from .entries import FileEntry
from .histories import with_files
from .kinds import MODEL, refuse
from .messages import combined, of_validation
from .paths import changed

__all__ = ["Study", "parse_study", "read_study", "read_toml", "schema"]


@dataclass(frozen=True, slots=True)
class Study:
    """A model file, read.

    Parameters
    ----------
    model : Model
    simulation : SimulationSettings or None
    equilibrium : EquilibriumSettings or None
    title : str
    source_text : str
        The text of the file; empty for a study from a dict.
    values : mapping
        What was given in place of values of the file, by path.

    """

    model: Model
    simulation: SimulationSettings | None
    equilibrium: EquilibriumSettings | None
    title: str = ""
    source_text: str = ""
    values: Mapping[str, Any] = field(default_factory=dict)


#: A number with a decimal comma behind a key.
DECIMAL_COMMA = re.compile(r"=\s*[-+]?\d+,\d")


def read_study(path: str | Path, values: Mapping[str, Any] | None = None) -> Study:
    """Read a model file.

    Parameters
    ----------
    path : path
    values : mapping, optional
        Other values than those of the file, by path: ``{"sections.rope.EA": 2e4}``, see
        :func:`ancf.model.file.paths.changed`.

    Raises
    ------
    ModelError
        The file cannot be read, is no TOML, has no such path, or describes no valid model; all problems in
        one error.

    """
    text, given = _read_text(Path(path), "model file"), dict(values or {})
    data = _toml(text, str(path))
    refuse(path, data, MODEL)
    study = parse_study(changed(with_files(data, Path(path).parent), given), str(path))
    return replace(study, source_text=text, values=given)


def read_toml(path: Path, kind: str) -> dict[str, Any]:
    """Tables of a TOML file; `kind` says in a message what the file should be.

    Raises
    ------
    ModelError
        The file cannot be read or is no TOML, nor can a CSV file that it names.

    """
    tables: dict[str, Any] = with_files(_toml(_read_text(path, kind), str(path)), path.parent)
    return tables


def parse_study(data: dict[str, Any], source: str = "model") -> Study:
    """Build a Study from the tables of a model file.

    Parameters
    ----------
    data : dict
        What TOML (or JSON) of a model file gives.
    source : str
        Its name, for a list of several problems.

    Raises
    ------
    ModelError
        ``where`` is the path in the file, ``bodies[2].section.EA``; for several problems it is `source`.

    """
    try:
        parameters.refuse_keys(data, FileEntry.model_fields)
        inputs = first_values(data.get("inputs") if isinstance(data, dict) else None)
        with named(inputs), parameters.given(data, inputs):
            entry = FileEntry.model_validate(data)
    except ValidationError as error:
        raise combined(of_validation(error), source) from None
    builder = Builder(entry)
    model = builder.build()
    if builder.problems:
        raise combined(builder.problems, source)
    simulation, equilibrium = builder.simulation(), builder.equilibrium()
    if builder.problems:
        raise combined(builder.problems, source)
    return Study(model, simulation, equilibrium, entry.title)


def schema() -> dict[str, Any]:
    """JSON Schema of the model file; every field has a description with its unit.

    Where a number may stand, a formula of parameters may as well.
    """
    plain: dict[str, Any] = _with_formulas(FileEntry.model_json_schema())
    return plain


def _with_formulas(part: Any) -> Any:
    if isinstance(part, list):
        return [_with_formulas(item) for item in part]
    if not isinstance(part, dict):
        return part
    if part.get("type") not in ("number", "integer"):
        return {key: _with_formulas(item) for key, item in part.items()}
    outside = {key: part[key] for key in ("description", "title", "default") if key in part}
    number = {key: item for key, item in part.items() if key not in outside}
    return {"anyOf": [number, {"type": "string"}], **outside}


def _read_text(path: Path, kind: str) -> str:
    try:
        return as_input(path).read_bytes().decode("utf-8-sig")
    except FileNotFoundError:
        found = [p.name for p in path.parent.glob("*.toml")] if exists(path.parent, "is_dir") else []
        raise ModelError(str(path), "no such file", nearest(path.name, found)) from None
    except IsADirectoryError:
        raise ModelError(str(path), f"is a folder, not a {kind}") from None
    except UnicodeDecodeError as error:
        raise ModelError(str(path), f"is not UTF-8 text: byte {error.start} cannot be read") from None
    except (OSError, ValueError) as error:
        raise ModelError(str(path), f"cannot be read: {error}") from None


#: Names of files that are no TOML, and are given where a model, a line or a study is wanted.
OTHER_FILE = re.compile(r"\.(csv|tsv|txt|dat|json|ya?ml|xlsx?)$", re.IGNORECASE)


def _toml(text: str, source: str) -> dict[str, Any]:
    if source.endswith(".py"):
        hint = f"run it: python {source}; a study of a function in it: ancf.study(function, samples)"
        raise ModelError(source, "is a Python file, files of TOML are read here", hint)
    try:
        return tomllib.loads(text)
    except (ValueError, RecursionError) as error:
        raise _syntax_error(text, source, str(error)) from None


def _syntax_error(text: str, source: str, message: str) -> ModelError:
    found = re.fullmatch(r"(.*) \(at line (\d+), column (\d+)\)", message, re.DOTALL)
    if found:
        row = text.split("\n")[int(found[2]) - 1]
        hint = "a point for decimals: 54.0" if DECIMAL_COMMA.search(row) else ""
        if OTHER_FILE.search(source):
            hint = "files of TOML are read here, NAME.toml; tables of numbers are named in them"
        place = f"{source}, line {found[2]}, column {found[3]}"
        return ModelError(place, f"TOML syntax: {found[1]}", hint)
    if message.endswith("(at end of document)"):
        lines = text.split("\n")
        spot = f"line {len(lines)}, column {len(lines[-1]) + 1}"
        return ModelError(
            f"{source}, {spot}", f"TOML syntax: {message.removesuffix(' (at end of document)')}"
        )
    return ModelError(source, f"TOML syntax: {message}")
