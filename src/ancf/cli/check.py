"""``ancf check``: whether a file is right: a model, a line, a pantograph, a study or results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from ..errors import ModelError
from ..files import results_at
from .info import is_hdf5
from .info_line import size_of
from .screen import Screen, console
from .summary import plural

#: Numbers of a results file that are looked at together.
AT_ONCE = 4_000_000
#: Warnings about a line that are printed.
MOST_SAID = 8


def check_file(path: Path, given: list[str] | None = None) -> None:
    """Tell what a file is by its first bytes or its tables, and find everything that is wrong with it.

    `given` is what ``--set`` changes in a model or line file.

    Raises
    ------
    ModelError
        It cannot be read, or something in it is wrong.

    """
    path = results_at(path)
    if is_hdf5(path):
        if given:
            raise ModelError("--set", "changes model files and line files, not results", "leave it out")
        return _check_results(path)
    from ..model.file import read_toml
    from ..model.file.kinds import LINE, MODEL, kind_of
    from ..model.file.paths import assignments, changed

    data = read_toml(path, "model file")
    kind = kind_of(data)
    if kind == LINE:
        from ..catenary.lines.file import other_values

        return _check_line(path, other_values(data, assignments(given)))
    if kind not in ("", MODEL):
        from .other_files import described

        if given:
            raise ModelError("--set", "changes model files and line files, not others", "leave it out")
        return _print_right(path, described(path, kind))
    return _check_model(path, changed(data, assignments(given)))


def _check_model(path: Path, data: dict[str, Any]) -> None:
    """Read a model and compile its System."""
    from ..model.file import parse_study
    from .info_model import compiled, counts, print_notes, task
    from .notes import check_equilibrium

    study = parse_study(data, str(path))
    system = compiled(study.model)
    check_equilibrium(study, system)
    _print_right(path, f"{counts(study.model)}; {task(study)}")
    print_notes(study, system)


def _check_line(path: Path, data: dict[str, Any]) -> None:
    """Read a line, hang its wires as strings, find its form and look at that."""
    from ..catenary.checked import at_rest
    from ..catenary.lines.file import parse_track
    from ..catenary.rest import check_track

    line = parse_track(data, str(path))
    said = check_track(line)
    Screen(quiet=False).announce_compilation()
    said += at_rest(line)
    _print_right(path, size_of(line))
    for text in said[:MOST_SAID]:
        console().print(f"  warning: {text}", soft_wrap=True)
    if len(said) > MOST_SAID:
        console().print(f"  and {plural(len(said) - MOST_SAID, 'more warning')}", soft_wrap=True)


def _check_results(path: Path) -> None:
    """Read the states and look for what is no number."""
    import numpy as np

    from .results_file import open_result

    result = open_result(path)
    rows = len(result.t)
    most = max(1, AT_ONCE // max(result.q.shape[1], 1))
    for first in range(0, rows, most):
        for name in ("t", "q", "v"):
            if not np.all(np.isfinite(getattr(result, name)[first : first + most])):
                raise ModelError(str(path), f"has values of {name} that are no finite numbers")
    _print_right(path, f"{plural(rows, 'state')} to t = {result.t[-1]:g} s, {result.status}")


def _print_right(path: Path, what: str) -> None:
    console().print(f"{path}: right; {what}", soft_wrap=True)
