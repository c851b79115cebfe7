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
TUNING_SECONDS = 0.1  # CPU time of one measurement while tuning
TUNING_WORK = 150_000  # elements times steps that are enough to tune with


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

    def solve(self, case: Case, options: Sample, seconds: float, steps: int | None = None) -> Sample:
        """Medians over a burst of solves that lasts about so many seconds."""
        sample: Sample = self.ask("solve", case=case.name, options=options, seconds=seconds, steps=steps)
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
    """A solve that may fail, or that may need more steps than it was given: then None."""
    try:
        sample = worker.solve(case, options, seconds, steps)
    except RefusedError:
        return None
    return sample if sample["steps"] == steps else None


def tune(peer: Worker, case: Case) -> Sample:
    """Options of the fastest run among those that end where the default settings do."""
    steps = min(case.steps, max(15, TUNING_WORK // case.elements))
    choices: list[Sample] = peer.ask("settings", case=case.name)
    default, *others = [attempt(peer, case, choice, TUNING_SECONDS, steps) for choice in choices]
    if default is None:
        return choices[0]
    best, options = default, choices[0]
    for choice, trial in zip(choices[1:], others, strict=True):
        if trial and distance(trial, default) <= case.accuracy and trial["cpu"] < best["cpu"]:
            best, options = trial, choice
    return options


def variants(peers: dict[str, Worker], case: Case) -> dict[str, tuple[Worker, Sample]]:
    """Ways to run the peer: its normal and its fast build with default settings, and the fast one tuned."""
    if not peers:
        return {}
    fast = peers.get("fast") or peers["standard"]
    tuned = tune(fast, case)
    choices: list[Sample] = fast.ask("settings", case=case.name)
    default = next(choice for choice in choices if choice["solver"] == tuned["solver"])
    chosen = {name: (worker, default) for name, worker in peers.items()}
    if tuned != default and attempt(fast, case, tuned, 0.0, case.steps):
        chosen["tuned"] = (fast, tuned)
    return chosen


def compare(ours: Worker, peers: dict[str, Worker], case: Case, pairs: int, seconds: float) -> Sample:
    """Measure one case: our side and a variant of the peer in turn, ``pairs`` times for each variant."""
    ours.solve(case, {}, 0.0)  # compiles or loads what is not there yet
    chosen = variants(peers, case)
    own: list[Sample] = []
    other: dict[str, list[Sample]] = {name: [] for name in chosen}
    mates: dict[str, list[Sample]] = {name: [] for name in chosen}
    for _ in range(pairs):
        for name, (worker, options) in chosen.items():
            own.append(ours.solve(case, {}, seconds))
            mates[name].append(own[-1])
            other[name].append(worker.solve(case, options, seconds))
        if not chosen:
            own.append(ours.solve(case, {}, seconds))
    row: Sample = {"name": case.name, "title": case.title, "elements": case.elements}
    row["ancf"] = {**summary(own), "newton_error": newton_error(ours, case, own[-1])}
    row["exudyn"] = {
        name: {**summary(other[name]), **ratios(other[name], mates[name]), "options": chosen[name][1]}
        for name in chosen
    }
    return {**row, **verdict(row, case)}


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
        "samples": len(samples),
        "solves_per_sample": last["solves"],
    }


def ratios(peer: list[Sample], ours: list[Sample]) -> Sample:
    """Medians over the pairs of peer / ours, for the solve alone and from model to result."""
    pairs = list(zip(peer, ours, strict=True))
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
    default = next(iter(peers.values()))
    fit = [name for name, peer in peers.items() if distance(peer, default) <= case.accuracy]
    best = min(fit, key=lambda name: float(peers[name]["cpu_median"]))
    gap = distance(row["ancf"], default)
    return {"best": best, "ratio": peers[best]["ratio"], "tip_difference": gap}


def newton_error(ours: Worker, case: Case, sample: Sample) -> float | None:
    """Change of our tip when Newton goes on to 1e-12, m; None if it cannot."""
    try:
        return distance(sample, ours.solve(case, {"newton": {"tolerance": 1e-12}}, 0.0))
    except RefusedError:
        return None


def memory(case: Case, module: str) -> Sample:
    """Peak resident memory of a fresh process, MB: after the import and after one solve."""
    worker = Worker(module)
    try:
        worker.ask("version")
        imported = worker.ask("memory")
        worker.solve(case, {}, 0.0)
        return {"imported_mb": imported, "peak_mb": worker.ask("memory")}
    finally:
        worker.close()
