"""Workers, tuning of the peer, alternating pairs, memory: the measuring itself."""

from __future__ import annotations

import json
import math
import os
import statistics
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from cases import Case

Sample = dict[str, Any]
Say = Callable[[str], None]
HERE = Path(__file__).parent
ONE_THREAD = {
    f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL", "NUMBA", "NUMEXPR", "VECLIB_MAXIMUM")
}
TUNING_SECONDS = 0.05  # CPU time of one measurement while tuning
MEMORY_STEPS = 20  # everything is allocated in the first one
TUNING_WORK = 30_000  # elements times steps that are enough to tune with
WHOLE_SECONDS = 0.3  # CPU time of one measurement of the settings that are left, over the whole run
LEAST_STEPS = 5  # of it, in large models
FINALISTS = 8  # settings that are run to the end; of long cases fewer
FEW_FINALISTS = 4
COARSE = 13  # in the short run, every so manieth setting of the grid
FINER = 4  # how much shorter the steps of the reference are
ALIKE = 1.5  # ratio of two errors up to which they count as equal
LEAST_ERROR = 1e-9  # m; what is smaller is that of Newton's method


class RefusedError(Exception):
    """A worker could not do what it was asked for."""


class Worker:
    """One side in its own process; the same process serves all measurements, so all imports are done."""

    def __init__(self, module: str, **environment: str) -> None:
        self.process = subprocess.Popen(
            [sys.executable, str(HERE / "worker.py"), module],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL,
            encoding="utf-8",
            env={**os.environ, **ONE_THREAD, **environment},
        )

    def ask(self, do: str, **request: Any) -> Any:
        """Answer to one request; RefusedError when it failed there."""
        assert self.process.stdin is not None
        assert self.process.stdout is not None
        try:
            print(json.dumps({"do": do, **request}), file=self.process.stdin, flush=True)
            line = self.process.stdout.readline()
        except BrokenPipeError:
            line = ""
        if not line:
            raise RefusedError("the process ended")
        reply = json.loads(line)
        if "error" in reply:
            raise RefusedError(reply["error"])
        return reply["ok"]

    def solve(
        self, case: Case, options: Sample, seconds: float, steps: int | None = None, refine: int = 1
    ) -> Sample:
        """Medians over a burst of solves that lasts about so many seconds."""
        sample: Sample = self.ask(
            "solve", case=case.name, options=options, seconds=seconds, steps=steps, refine=refine
        )
        return sample

    def close(self) -> None:
        """End the process."""
        self.process.kill()
        self.process.communicate()


@contextmanager
def workers(**modules: tuple[str, dict[str, str]]) -> Iterator[dict[str, Worker]]:
    """Workers by name; those whose module cannot be imported are left out."""
    opened: dict[str, Worker] = {}
    try:
        for name, (module, environment) in modules.items():
            opened[name] = Worker(module, **environment)
        yield {name: worker for name, worker in opened.items() if answers(worker)}
    finally:
        for worker in opened.values():
            worker.close()


def answers(worker: Worker) -> bool:
    """Whether the worker's module can be imported."""
    try:
        worker.ask("version")
    except RefusedError:
        return False
    return True


def distance(a: Sample, b: Sample) -> float:
    """Distance of the tips, m."""
    return math.dist(a["tip"], b["tip"])


def attempt(worker: Worker, case: Case, options: Sample, seconds: float, steps: int) -> Sample | None:
    """A solve that may fail, or take other steps than it was given: then None."""
    try:
        sample = worker.solve(case, options, seconds, steps)
    except RefusedError:
        return None
    return sample if sample["steps"] == steps or case.once else None


def ranked(peer: Worker, case: Case, choices: list[Sample]) -> list[tuple[Sample, Sample]]:
    """Options that end where the default settings do after the first steps, with their samples; best first.

    The default settings are the first ones.
    """
    steps = min(case.steps, max(LEAST_STEPS, TUNING_WORK // case.elements))
    default, *others = [attempt(peer, case, choice, TUNING_SECONDS, steps) for choice in choices]
    if default is None:
        return []
    better = [
        (trial["cpu"], k)
        for k, trial in enumerate(others, 1)
        if trial and distance(trial, default) <= case.accuracy and trial["cpu"] < default["cpu"]
    ]
    found = [(choices[0], default)]
    return found + [(choices[k], taken(others[k - 1])) for _, k in sorted(better)]


def taken(trial: Sample | None) -> Sample:
    """A sample that is there."""
    assert trial is not None
    return trial


def tune(peer: Worker, case: Case, choices: list[Sample]) -> tuple[Sample, list[Sample]]:
    """The fastest options that keep the accuracy to the end of the whole run, and all that were run to it.

    What is accurate and fast on the first steps need not be so at the end: the whole run decides among those
    that are fastest there.
    """
    default, *candidates = ranked(peer, case, choices) or [(choices[0], {})]
    if case.once:
        return (candidates or [default])[0][0], []
    whole = attempt(peer, case, default[0], WHOLE_SECONDS, case.steps)
    if whole is None:
        return choices[0], []
    tried = [{"options": default[0], "cpu": whole["cpu"], "tip_difference": 0.0, "accurate": True}]
    for options, _ in candidates[: FEW_FINALISTS if case.long else FINALISTS]:
        trial = attempt(peer, case, options, WHOLE_SECONDS, case.steps)
        if trial is not None:
            gap = distance(trial, whole)
            kept = {"cpu": trial["cpu"], "tip_difference": gap, "accurate": gap <= case.accuracy}
            tried.append({"options": options, **kept})
    best = min((t for t in tried if t["accurate"]), key=lambda t: float(t["cpu"]))
    return dict(best["options"]), tried


def variants(
    peers: dict[str, Worker], case: Case, every: int
) -> tuple[dict[str, tuple[Worker, Sample]], list[Sample]]:
    """Ways to run the peer: its normal and its fast build with default settings, and the fast one tuned.

    And all settings that were tried to the end. Of the grid every so manieth is tried, from the first one on.
    """
    if not peers:
        return {}, []
    fast = peers.get("fast") or peers["standard"]
    choices: list[Sample] = fast.ask("settings", case=case.name)[::every]
    tuned, tried = tune(fast, case, choices)
    default = next(choice for choice in choices if choice["solver"] == tuned["solver"])
    chosen = {name: (worker, default) for name, worker in peers.items()}
    return (chosen if tuned == default else {**chosen, "tuned": (fast, tuned)}), tried


class Pairs:
    """Samples of our side and of the peer's variants, taken in turn: A B A B ..."""

    def __init__(self, ours: Worker, chosen: dict[str, tuple[Worker, Sample]], case: Case) -> None:
        self.ours, self.chosen, self.case = ours, dict(chosen), case
        self.own: list[Sample] = []
        self.by_variant: dict[str, list[tuple[Sample, Sample]]] = {name: [] for name in chosen}

    def round(self, seconds: float) -> None:
        """One pair for each variant; of a long case one solve of ours serves for the whole round."""
        for k, (name, (worker, options)) in enumerate(self.chosen.items()):
            if k == 0 or not self.case.long:
                self.own.append(self.ours.solve(self.case, {}, seconds))
            sample = attempt(worker, self.case, options, seconds, self.case.steps)
            if sample is not None:
                self.by_variant[name].append((sample, self.own[-1]))
        if not self.chosen:
            self.own.append(self.ours.solve(self.case, {}, seconds))

    def prune(self) -> None:
        """Leave out the variants that failed, are inaccurate, or over a tenth slower than the best."""
        first = {name: both[0][0] for name, both in self.by_variant.items() if both}
        fit = accurate(first, self.case)
        limit = 1.1 * min((first[name]["cpu"] for name in fit), default=0.0)
        self.chosen = {name: self.chosen[name] for name in fit if first[name]["cpu"] <= limit}


def accurate(peers: dict[str, Sample], case: Case) -> list[str]:
    """Variants that end where the first one, with default settings, does."""
    return [name for name in peers if distance(peers[name], next(iter(peers.values()))) <= case.accuracy]


def compare(ours: Worker, peers: dict[str, Worker], case: Case, pairs: int, seconds: float) -> Sample:
    """Measure one case: our side and a variant of the peer in turn, ``pairs`` times for each variant."""
    ours.solve(case, {}, 0.0)  # compiles or loads what is not there yet
    chosen, tried = variants(peers, case, COARSE if seconds < TUNING_SECONDS else 1)
    taken = Pairs(ours, chosen, case)
    for k in range(pairs):
        taken.round(seconds)
        if case.once:
            break
        if k == 0 and case.long:
            taken.prune()
    row: Sample = {"name": case.name, "title": case.title, "elements": case.elements, "size": case.size}
    error = None if case.once or case.static else newton_error(ours, case, taken.own[-1])
    row["ancf"] = {**summary(taken.own), "newton_error": error}
    row["exudyn"] = {
        name: {**summary([a for a, _ in both]), **ratios(both), "options": chosen[name][1]}
        for name, both in taken.by_variant.items()
        if both
    }
    row |= verdict(row, case)
    row["tried"] = tried
    row["equal_accuracy"] = equal_accuracy(ours, chosen, case, row)
    return row


def summary(samples: list[Sample]) -> Sample:
    """Best and median times of one side, and the counters of its last run."""
    last = samples[-1]
    times = [sample["cpu"] for sample in samples]
    median = statistics.median(times)
    return {
        "cpu_best": min(times),
        "cpu_median": median,
        "cpu_whole_median": statistics.median(sample["cpu_whole"] for sample in samples),
        "cpu_stepping": last.get("cpu_stepping"),
        "us_per_step": 1e6 * median / last["steps"],
        **{key: last[key] for key in ("steps", "newton_iterations", "jacobians", "tip")},
        **{key: last[key] for key in ("force",) if key in last},
        "samples": len(samples),
        "solves_per_sample": last["solves"],
    }


def ratios(pairs: list[tuple[Sample, Sample]]) -> Sample:
    """Medians over the pairs of peer / ours, for the solve alone and from model to result."""
    each = [a["cpu"] / b["cpu"] for a, b in pairs]
    return {
        "ratio": statistics.median(each),
        "ratios": each,
        "ratio_whole": statistics.median(a["cpu_whole"] / b["cpu_whole"] for a, b in pairs),
    }


def verdict(row: Sample, case: Case) -> Sample:
    """The fastest variant of the peer that is as accurate as its default, and the ratio to it."""
    peers: Sample = row["exudyn"]
    if not peers:
        return {"best": None, "ratio": None, "tip_difference": None}
    fit = accurate(peers, case)
    for name in peers:
        peers[name]["accurate"] = name in fit
    best = min(fit, key=lambda name: float(peers[name]["cpu_median"]))
    gap = distance(row["ancf"], next(iter(peers.values())))
    return {"best": best, "ratio": peers[best]["ratio"], "tip_difference": gap}


def equal_accuracy(
    ours: Worker, chosen: dict[str, tuple[Worker, Sample]], case: Case, row: Sample
) -> float | None:
    """The ratio if the less accurate side had steps short enough for the other's error at the tip.

    Errors are distances from our tip with steps that are shorter by FINER; the order of a side is that of its
    errors with the step and half of it, its cost is in proportion to the number of steps. None where that
    takes too long, or where errors do not fall.
    """
    if case.once or case.long or case.static or row["best"] is None:
        return None
    worker, options = chosen[row["best"]]
    try:
        truth = ours.solve(case, {}, 0.0, refine=FINER)
        own, peer = distance(row["ancf"], truth), distance(row["exudyn"][row["best"]], truth)
        worse = (ours, {}) if own > peer else (worker, options)
        half = distance(worse[0].solve(case, worse[1], 0.0, refine=2), truth)
    except RefusedError:
        return None
    large, small = max(own, peer), max(min(own, peer), LEAST_ERROR)
    if large <= ALIKE * small:
        return float(row["ratio"])
    if not 0.0 < half < large:
        return None
    more = (large / small) ** (1.0 / min(max(math.log2(large / half), 0.5), 4.0))
    return float(row["ratio"]) * (more if peer > own else 1.0 / more)


def contacts(ours: Worker, case: Case) -> dict[str, Sample]:
    """Our side with each kind of contact, a burst of a second each, after one that may compile."""
    kinds = ("joint", "penalty")
    for kind in kinds:
        ours.solve(case, {"contact": kind}, 0.0)
    return {kind: ours.solve(case, {"contact": kind}, 1.0) for kind in kinds}


def newton_error(ours: Worker, case: Case, sample: Sample) -> float | None:
    """Change of our tip when Newton goes on to 1e-12, m; None if it cannot."""
    try:
        return distance(sample, ours.solve(case, {"newton": {"tolerance": 1e-12}}, 0.0))
    except RefusedError:
        return None


def memory(case: Case, module: str) -> Sample:
    """Peak resident memory of a fresh process, MB: after the import and after some steps."""
    worker = Worker(module)
    try:
        worker.ask("version")
        imported = worker.ask("memory")
        worker.solve(case, {}, 0.0, MEMORY_STEPS)
        return {"imported_mb": imported, "peak_mb": worker.ask("memory")}
    finally:
        worker.close()
