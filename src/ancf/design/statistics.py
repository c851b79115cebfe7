"""What the table of a study says: distributions, main effects, Sobol' and Morris indices, with confidence."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from ..arrays import FloatArray
from .extras import extra
from .order import places_of
from .sampling import DESIGN, DRAWN, LEVELS, unit_samples

if TYPE_CHECKING:
    from pandas import DataFrame

#: Percentiles that are listed, and the level of all confidence intervals.
PERCENTILES = (1.0, 5.0, 25.0, 50.0, 75.0, 95.0, 99.0)
LEVEL = 0.95
#: Bins of a parameter for its main effect, and the fewest cases in one.
BINS, FEWEST = 10, 5
RESAMPLES = 1000
#: Methods that depend on which row is which.
ORDERED = ("saltelli", "morris")
LOST = (
    "The rows are no longer those of the design: without knowing which belong together there are no indices."
)


def summary(table: DataFrame, design: dict[str, Any] | None) -> dict[str, Any]:
    """All of it, ready for JSON.

    Parameters
    ----------
    table : DataFrame
        As :func:`ancf.study` returns it.
    design : dict or None
        How the samples were made.
    """
    method = design["method"] if design else "list"
    failed = int((table["status"] == "failed").sum())
    places = places_of(table, design) if design is not None and method in ORDERED else None
    lost = method in ORDERED and places is None
    note = _note(table, method, failed) + (f" {LOST}" if lost else "")
    noted = int(((table["status"] == "ok") & (table["message"] != "")).sum())
    made: dict[str, Any] = {"cases": len(table), "failed": failed, "noted": noted, "note": note}
    random = drawn_rows(table)
    made["outputs"] = {
        name: _described(column(table, name)[random], method) | _extreme(column(table, name), random)
        for name in outputs_of(table)
    }
    made["extremes"] = _cases_of(table, made["outputs"])
    made["effects"] = {name: effects(table, name) for name in outputs_of(table)}
    if method in ORDERED and design is not None:
        indices = _sobol if method == "saltelli" else _morris
        whole = places is not None and np.array_equal(np.sort(places), np.arange(len(_unit(design))))
        rows = table.iloc[np.argsort(np.asarray(places))] if whole else table
        made[method] = {name: indices(rows, name, design) for name in outputs_of(table)} if whole else {}
    return made


def parameters_of(table: DataFrame) -> list[str]:
    """Names of the parameters."""
    names: list[str] = table.attrs["parameters"]
    return names


def outputs_of(table: DataFrame) -> list[str]:
    """Names of the outputs."""
    names: list[str] = table.attrs["outputs"]
    return names


def labelled(units: Mapping[str, str], name: str) -> str:
    """A name with its unit, "pull [N]", or alone where that is not known."""
    return name if name not in units else f"{name} [{units[name] or '-'}]"


def label_of(table: DataFrame, name: str) -> str:
    """The same of a column of a table."""
    return labelled(table.attrs.get("units", {}), name)


def column(table: DataFrame, name: str) -> FloatArray:
    """Numbers (n,) of an output, NaN where a case failed."""
    return np.asarray(table[name].to_numpy(), dtype=np.float64)


def is_drawn(method: str) -> bool:
    """Whether the cases, or some of them, are a random sample of the parameters."""
    return method in DRAWN or method == "saltelli"


def drawn_rows(table: DataFrame) -> Any:
    """Which rows describe the distribution: of "saltelli" the two independent ones of each base point."""
    design = table.attrs.get(DESIGN)
    places = places_of(table, design) if design is not None and design["method"] == "saltelli" else None
    if design is None or places is None:
        return np.ones(len(table), dtype=bool)
    group = len(design["parameters"]) + 2
    return np.isin(places % group, (0, group - 1))


def _note(table: DataFrame, method: str, failed: int) -> str:
    if not failed:
        return f"All {len(table)} cases succeeded."
    told = f"{failed} of {len(table)} cases failed; statistics are those of the others"
    if method == "saltelli":
        return f"{told}, Sobol' indices those of the base points all of whose cases succeeded."
    if method == "morris":
        return f"{told}, Morris' indices those of the trajectories all of whose cases succeeded."
    return f"{told}, which may differ from the failed ones."


def _described(values: FloatArray, method: str) -> dict[str, Any]:
    good = np.sort(values[np.isfinite(values)])
    count = len(good)
    if not count:
        return {"count": 0}
    made: dict[str, Any] = {
        "count": count,
        "mean": float(np.mean(good)),
        "deviation": float(np.std(good, ddof=1)) if count > 1 else None,
        "minimum": float(good[0]),
        "maximum": float(good[-1]),
    }
    if is_drawn(method):
        if count > 1:
            from scipy.special import stdtrit

            half = stdtrit(count - 1, 0.5 * (1.0 + LEVEL)) * made["deviation"] / np.sqrt(count)
            made["mean_confidence"] = [made["mean"] - float(half), made["mean"] + float(half)]
        made["percentiles"] = [percentile(good, p) for p in PERCENTILES]
    return made


def _extreme(values: FloatArray, rows: Any) -> dict[str, int]:
    """Cases of the smallest and the largest value among some rows, the first of equal ones."""
    good = np.flatnonzero(rows & np.isfinite(values))
    if not len(good):
        return {}
    return {
        "minimum_case": int(good[np.argmin(values[good])]),
        "maximum_case": int(good[np.argmax(values[good])]),
    }


def _cases_of(table: DataFrame, outputs: dict[str, Any]) -> list[dict[str, Any]]:
    """Parameters of the cases with the smallest and the largest outputs, in their order."""
    keys = ("minimum_case", "maximum_case")
    cases = sorted({row[key] for row in outputs.values() for key in keys if key in row})
    return [
        {"case": case, "parameters": {name: table[name].tolist()[case] for name in parameters_of(table)}}
        for case in cases
    ]


def percentile(ordered: FloatArray, p: float) -> dict[str, float | None]:
    """A percentile and its confidence interval from the order of the values; None where it has no end."""
    from scipy.stats import binom

    count = len(ordered)
    low = int(binom.ppf(0.5 * (1.0 - LEVEL), count, p / 100.0)) - 1
    high = int(binom.ppf(0.5 * (1.0 + LEVEL), count, p / 100.0))
    return {
        "percent": p,
        "value": float(np.percentile(ordered, p)),
        "low": float(ordered[low]) if low >= 0 else None,
        "high": float(ordered[high]) if high < count else None,
    }


def exceedance(values: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """Values in order, the share of cases above each, and its confidence interval (Clopper and Pearson)."""
    from scipy.stats import beta

    ordered = np.sort(values[np.isfinite(values)])
    count = len(ordered)
    above = count - 1.0 - np.arange(count)
    tail = 0.5 * (1.0 - LEVEL)
    low = np.where(above > 0, beta.ppf(tail, above, count - above + 1.0), 0.0)
    high = np.where(above < count, beta.ppf(1.0 - tail, above + 1.0, count - above), 1.0)
    return ordered, above / count, np.asarray(low), np.asarray(high)


def effects(table: DataFrame, output: str) -> dict[str, dict[str, Any]]:
    """Mean of an output over each parameter, in bins, and the share of its variance that these means have.

    ``explained`` is the variance of the means over that of the output, the correlation ratio: on a full grid,
    all combinations of the values equally often, that of the analysis of variance, and ``exact``, with a mean
    for each value: ``share`` is the same there. Elsewhere means differ by chance too, ``chance`` is what as
    many random groups explain on the average, and ``share`` what ``explained`` has beyond that, not below 0
    (Kelley's epsilon squared): 0 says that the cases cannot tell the effect from chance.
    """
    y = column(table, output)
    good = np.isfinite(y)
    table, y = table[good], y[good]
    exact = is_full(table)
    return {name: _effect(table[name].to_numpy(), y, exact) for name in parameters_of(table)}


def _effect(x: Any, y: FloatArray, exact: bool) -> dict[str, Any]:
    """Of a parameter (n,) on an output (n,), on a full grid or elsewhere."""
    bins = [*_bins(x)]
    if not bins or np.ptp(y) == 0.0:
        return {"bins": [], "share": 0.0, "explained": 0.0, "chance": 0.0, "exact": exact}
    rows = []
    for at, inside in bins:
        part = y[inside]
        error = float(np.std(part, ddof=1) / np.sqrt(len(part))) if len(part) > 1 else None
        rows.append({"at": at, "mean": float(np.mean(part)), "error": error, "count": len(part)})
    if exact:
        bins = [(level, x == level) for level in dict.fromkeys(x.tolist())]
    explained = _explained(y, [y[inside] for _, inside in bins])
    groups, cases = len(bins), len(y)
    share, chance = explained, 0.0
    if not exact:
        chance = (groups - 1) / (cases - 1)
        share = max(0.0, explained - (1.0 - explained) * (groups - 1) / max(cases - groups, 1))
    return {"bins": rows, "share": share, "explained": explained, "chance": chance, "exact": exact}


def _explained(y: FloatArray, parts: list[FloatArray]) -> float:
    """Variance of the means of parts over that of all numbers (n,)."""
    between = sum(len(part) * (float(np.mean(part)) - float(np.mean(y))) ** 2 for part in parts)
    return min(1.0, between / (len(y) * float(np.var(y))))


def is_full(table: DataFrame) -> bool:
    """Whether the rows are all combinations of the values that their parameters have, equally often."""
    codes = [table[name].factorize()[0] for name in parameters_of(table)]
    if not codes or not len(table):
        return False
    combinations = math.prod(int(code.max()) + 1 for code in codes)
    if len(table) % combinations:
        return False
    _, counts = np.unique(np.stack(codes), axis=1, return_counts=True)
    return len(counts) == combinations and bool(np.all(counts == counts[0]))


def _bins(x: Any) -> Iterator[tuple[Any, Any]]:
    """Places and members of the bins: the values themselves where they are few, or words.

    Equal values are in one bin, that of the middle one of them, in whatever order the rows are.
    """
    levels = list(dict.fromkeys(x.tolist()))
    if len(levels) <= BINS or any(isinstance(level, str) for level in levels):
        if len(levels) > 1:
            for level in sorted(levels, key=lambda v: (isinstance(v, str), v)):
                yield level, x == level
        return
    count = max(2, min(BINS, len(x) // FEWEST))
    order = np.argsort(x, kind="stable")
    bins = np.concatenate([np.full(len(part), k) for k, part in enumerate(np.array_split(order, count))])
    starts = np.flatnonzero(np.diff(x[order], prepend=np.nan) != 0.0)
    sizes = np.diff(starts, append=len(x))
    bins = np.repeat(bins[starts + (sizes - 1) // 2], sizes)
    for k in np.unique(bins):
        part = order[bins == k]
        yield float(np.mean(x[part])), part


def _seed(design: dict[str, Any]) -> int:
    """For resamples; SALib takes 0 for no seed."""
    return int(design["seed"] % 2**32) or 2**32 - 1


def _unit(design: dict[str, Any]) -> FloatArray:
    return unit_samples(design["method"], design["count"], len(design["parameters"]), design["seed"])


def _kept(table: DataFrame, output: str, group: int) -> tuple[FloatArray, Any, int]:
    """Outputs of the groups without a failed case, which rows these are, and how many groups have one."""
    y = column(table, output)
    whole = np.all(np.isfinite(y.reshape(-1, group)), axis=1)
    rows = np.repeat(whole, group)
    return y[rows], rows, int(np.sum(~whole))


def _sobol(table: DataFrame, output: str, design: dict[str, Any]) -> dict[str, Any]:
    """First and total Sobol' indices with half widths of their confidence intervals."""
    names = [*design["parameters"]]
    y, _, dropped = _kept(table, output, len(names) + 2)
    made: dict[str, Any] = {"groups": len(y) // (len(names) + 2), "dropped": dropped, "indices": {}}
    if made["groups"] < 2 or np.ptp(y) == 0.0:
        return made
    problem = {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}
    analyze = extra("SALib.analyze.sobol").analyze
    found = analyze(
        problem,
        y,
        calc_second_order=False,
        num_resamples=RESAMPLES,
        conf_level=LEVEL,
        seed=_seed(design),
    )
    for k, name in enumerate(names):
        made["indices"][name] = {key: float(found[key][k]) for key in ("S1", "S1_conf", "ST", "ST_conf")}
    return made


def _morris(table: DataFrame, output: str, design: dict[str, Any]) -> dict[str, Any]:
    """Elementary effects over the range of each parameter: mean, mean size with confidence, deviation."""
    names = [*design["parameters"]]
    y, rows, dropped = _kept(table, output, len(names) + 1)
    made: dict[str, Any] = {"groups": len(y) // (len(names) + 1), "dropped": dropped, "indices": {}}
    if made["groups"] < 2 or np.ptp(y) == 0.0:
        return made
    problem = {"num_vars": len(names), "names": names, "bounds": [[0.0, 1.0]] * len(names)}
    analyze = extra("SALib.analyze.morris").analyze
    found = analyze(
        problem,
        _unit(design)[rows],
        y,
        num_resamples=RESAMPLES,
        conf_level=LEVEL,
        num_levels=LEVELS,
        seed=_seed(design),
    )
    for k, name in enumerate(names):
        made["indices"][name] = {
            key: float(found[key][k]) for key in ("mu", "mu_star", "mu_star_conf", "sigma")
        }
    return made
