"""``ancf.study``: a function of parameters for every row of a table, in parallel, safe against any end."""

from __future__ import annotations

import functools
import hashlib
import inspect
import os
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

from ..errors import ModelError
from ..files import locked, spare_inputs, writable
from ..model import checks
from .cluster import Cluster
from .extras import pandas
from .finished import FILES
from .journal import Journal, Outcome, case_key
from .processes import Case, Processes
from .sources import sources
from .work import Function, outcome, packed

if TYPE_CHECKING:
    from pandas import DataFrame

#: Columns of the table that are no parameters and no outputs.
CASE, STATUS, MESSAGE = "case", "status", "message"
#: s between two reports of progress while many cases end.
OFTEN = 0.05


@dataclass(frozen=True)
class Step:
    """How far a study is.

    Parameters
    ----------
    done, wanted, failed : int
        Different cases.
    before : int
        Of them, those that an earlier start had done.
    elapsed : float
        Since this start, s.
    """

    done: int
    wanted: int
    failed: int
    before: int
    elapsed: float

    @property
    def left(self) -> float:
        """Time left, s; not known at the start."""
        fresh = self.done - self.before
        return self.elapsed / fresh * (self.wanted - self.done) if fresh else float("nan")


class Executor(Protocol):
    """What computes cases."""

    def outcomes(self, cases: Sequence[Case]) -> Iterator[tuple[str, Outcome]]:
        """Outcomes by key, as they come."""
        ...


def study(
    function: Function,
    samples: DataFrame,
    *,
    folder: str | Path | None = None,
    workers: int | None = None,
    scheduler: Any = None,
    retry: bool = False,
    report: bool = True,
    progress: Callable[[Step], None] | None = None,
    title: str = "",
    units: Mapping[str, str] | None = None,
    files: Mapping[str, str] | None = None,
) -> DataFrame:
    """Call a function for every row of a table and gather the numbers that it returns.

    Whatever is killed, the same call goes on: each case is written to ``folder/journal.sqlite`` when it
    ends, and none is computed twice, also not when there are more samples later. The table does not depend on
    the number of workers, nor on the order in which they end.

    Parameters
    ----------
    function : callable
        ``function(**row)`` returns numbers by name. It goes to other processes by value, with what it needs.
    samples : DataFrame
        A row for each case, from :func:`ancf.sample` or made otherwise.
    folder : path, optional
        For the journal, the tables, ``study.json`` and ``report.html``; default none.
    workers : int
        Processes, default one for each core; 0: in this process.
    scheduler : str or distributed.Client
        A Dask cluster instead, by the address of its scheduler.
    retry : bool
        Compute once more what failed before.
    report : bool
        Write ``report.html``, which needs matplotlib.
    progress : callable
        Called with a :class:`Step` when cases have ended.
    title : str
        Of the report, default the name of the function.
    units : mapping, optional
        Units of parameters and outputs by their names, for the report and ``study.json``.
    files : mapping, optional
        Hashes of the files that make the study, kept in ``study.json``.

    Returns
    -------
    DataFrame
        The samples, the outputs, ``status`` ("ok" or "failed") and ``message``: why a case failed, or what
        was warned of or noted in it.

    Raises
    ------
    ModelError
        What is given is wrong, such as a function that does not take the columns, the folder holds another
        study, the scheduler does not answer, or the outputs of the first case are no numbers.
    SolveError
        The cluster has gone; what has ended is kept.
    """
    frame = pandas()
    checks.function(function, "study.function", "the columns")
    checks.progress(progress, "study.progress")
    if not isinstance(samples, frame.DataFrame) or not len(samples) or not len(samples.columns):
        raise ModelError("study.samples", "must be a DataFrame with a row for each case", "see ancf.sample")
    rows = rows_of(samples)
    check_arguments(function, rows[0])
    content = packed(function)
    place = None if folder is None else writable(checks.path(folder, "study.folder"), f"folder {folder}")
    if place is not None:
        spare_inputs(place, FILES)
    with locked(place, f"folder {folder}"):
        given = getattr(function, "files", {})
        journal = Journal(_journal(place), identity(function), f"folder {folder}", given)
        try:
            if retry:
                journal.forget_failed()
            wanted = {case_key(row): row for row in rows}
            journal.plan(len(wanted))
            known = journal.outcomes()
            left = [(key, row) for key, row in wanted.items() if key not in known]
            if left:
                executor = _executor(function, content, workers, scheduler)
                _carry_out(executor, left, journal, known, wanted, progress)
            read = journal.files()
        finally:
            journal.close()
        table = table_of(samples, rows, known)
        table.attrs["units"] = _checked_units(units or {}, table)
        if place is not None:
            about = {
                "title": title or _title(function),
                "function": identity(function),
                "seconds": _seconds(known, wanted),
                "read": read,
                "units": table.attrs["units"],
            }
            _write(place, table, rows, about, files or {}, report)
    return table


def _write(
    place: Path,
    table: DataFrame,
    rows: list[dict[str, Any]],
    about: dict[str, Any],
    files: Mapping[str, str],
    report: bool,
) -> None:
    """Write the files of a study whose cases have ended, if they are not there already."""
    from .writing import write_all

    stamp = hashlib.sha256(repr((about, [*map(case_key, rows)], table.attrs)).encode()).hexdigest()
    write_all(place, table, {**about, "stamp": stamp, "files": files}, report)


def rows_of(samples: DataFrame) -> list[dict[str, Any]]:
    """Values by name of each row, as plain numbers and texts.

    Raises
    ------
    ModelError
        One is neither, or a column has the name of another or of one of the table's own.
    """
    names = [str(name) for name in samples.columns]
    for name in names:
        if names.count(name) > 1 or name in (CASE, STATUS, MESSAGE):
            raise ModelError(f'study.samples["{name}"]', "is a name that is taken", "rename the column")
    columns = [samples.iloc[:, k].tolist() for k in range(len(names))]
    for name, column in zip(names, columns, strict=True):
        for k, value in enumerate(column):
            if not isinstance(value, str):
                checks.number(value, f'study.samples["{name}"][{k}]')
    return [dict(zip(names, row, strict=True)) for row in zip(*columns, strict=True)]


def check_arguments(function: Callable[..., Any], row: Mapping[str, Any]) -> None:
    """Raise ModelError if a function does not take the names of a row: each case would fail alike."""
    try:
        takes = inspect.signature(function)
    except (TypeError, ValueError):
        return  # of some compiled functions nothing is known
    try:
        takes.bind(**row)
    except TypeError as error:
        name = getattr(function, "__name__", type(function).__name__)
        what = f"{name}{takes} does not take the columns of the samples, {', '.join(row)}: {error}"
        raise ModelError("study.function", what, "arguments and columns have the same names") from None


def identity(function: Any) -> dict[str, Any]:
    """What tells one study from another: the function's name, its source and what that rests on.

    An object may say it itself, by ``identity()``.
    """
    if hasattr(function, "identity"):
        return dict(function.identity())
    if isinstance(function, functools.partial):
        bound = hashlib.sha256(repr((function.args, sorted(function.keywords.items()))).encode()).hexdigest()
        return {**identity(function.func), "arguments": bound[:16]}
    inner = inspect.unwrap(function)
    name = getattr(inner, "__qualname__", type(inner).__qualname__)
    try:
        text = inspect.getsource(inner if hasattr(inner, "__code__") else type(inner))
    except (OSError, TypeError):
        text = ""
    source = hashlib.sha256(text.encode("utf-8")).hexdigest()[:16]
    return {"function": name, "source": source, **sources(function)}


def _title(function: Any) -> str:
    """Of the report: the name of the function, if it has one."""
    inner = function.func if isinstance(function, functools.partial) else function
    name = getattr(inner, "__name__", type(inner).__name__)
    return "" if name in ("<lambda>", "FileCase") else str(name)


def table_of(samples: DataFrame, rows: list[dict[str, Any]], known: Mapping[str, Outcome]) -> DataFrame:
    """Samples and outputs side by side, in the order of the samples."""
    frame = pandas()
    ended = [known[case_key(row)] for row in rows]
    names = dict.fromkeys(name for one in ended for name in one.outputs)
    columns: dict[str, Any] = {str(name): samples[name].to_numpy() for name in samples.columns}
    clash = next((name for name in names if name in columns or name in (CASE, STATUS, MESSAGE)), None)
    if clash is not None:
        what = "is the name of a parameter or of another column too"
        raise ModelError(f"outputs.{clash}", what, "give the output another name")
    for name in names:
        columns[name] = [one.outputs.get(name, float("nan")) for one in ended]
    columns |= {STATUS: [one.status for one in ended], MESSAGE: [one.message for one in ended]}
    made = frame.DataFrame(columns)
    made.index.name = CASE
    made.attrs = {**samples.attrs, "outputs": [*names], "parameters": [str(n) for n in samples.columns]}
    return made


def _checked_units(units: Any, table: DataFrame) -> dict[str, str]:
    """Units by columns of a table; ModelError if there is another one, or a unit is no text."""
    names = [*table.attrs["parameters"], *table.attrs["outputs"]]
    for name, unit in checks.mapping(units, "study.units").items():
        if name not in names:
            raise ModelError("study.units", f'there is no column "{name}"', checks.nearest(str(name), names))
        checks.text(unit, f'study.units["{name}"]')
    return dict(units)


def _journal(place: Path | None) -> Path | None:
    return None if place is None else place / "journal.sqlite"


def _executor(function: Function, content: bytes, workers: Any, scheduler: Any) -> Executor:
    if scheduler is not None:
        if workers is not None:
            raise ModelError("study.workers", "has no effect with a scheduler", "give one of both")
        return Cluster(content, scheduler)
    count = cores() if workers is None else checks.integer(workers, "study.workers", 0, 10_000)
    return Processes(content, count) if count else Here(function)


def cores() -> int:
    """Cores that this process may use."""
    affinity = getattr(os, "sched_getaffinity", None)
    return len(affinity(0)) if affinity else os.cpu_count() or 1


class Here:
    """Computes cases in this process, one after the other."""

    def __init__(self, function: Function) -> None:
        self._function = function

    def outcomes(self, cases: Sequence[Case]) -> Iterator[tuple[str, Outcome]]:
        """Outcomes by key, as they come."""
        for key, values in cases:
            yield key, outcome(self._function, values)


def _carry_out(
    executor: Executor,
    left: list[Case],
    journal: Journal,
    known: dict[str, Outcome],
    wanted: Mapping[str, Any],
    progress: Callable[[Step], None] | None,
) -> None:
    """Compute what is left; what has ended is in the journal, whatever comes next."""
    before = done = len(wanted) - len(left)
    failed = sum(known[key].failed for key in wanted if key in known)
    start = told = time.monotonic()
    for key, one in executor.outcomes(left):
        journal.add([(key, one)])
        known[key] = one
        done, failed, now = done + 1, failed + one.failed, time.monotonic()
        if progress is not None and (now - told > OFTEN or done == len(wanted)):
            progress(Step(done, len(wanted), failed, before, now - start))
            told = now
        _check_first(one, known)


def _check_first(one: Outcome, known: Mapping[str, Outcome]) -> None:
    """Raise ModelError if the very first outputs are no numbers: it is the function that is wrong."""
    if len(known) == 1 and one.wrong_kind:
        where, _, what = one.message.partition(": ")
        raise ModelError(where, what)


def _seconds(known: Mapping[str, Outcome], wanted: Mapping[str, Any]) -> float:
    return float(sum(known[key].seconds for key in wanted))
