"""One side in a process of its own: reads requests, one JSON line each, and answers each with one line.

``python worker.py ours`` or ``python worker.py peer_exudyn``. What the side itself prints goes to
standard error, so that standard output carries answers only.
"""

from __future__ import annotations

import gc
import importlib
import json
import os
import statistics
import sys
import time
from pathlib import Path
from typing import Any

from cases import CASES, Case

MOST = 200  # solves in one measurement


def burst(side: Any, case: Case, options: dict[str, Any], seconds: float) -> dict[str, Any]:
    """Solve the case again and again for about so many CPU seconds; medians of the times.

    Each solve begins without garbage. What was there before is frozen: to walk through all that a side has
    imported takes 60 to 80 ms, a burst would be one solve, and that one would find the caches empty.
    """
    gc.collect()
    gc.freeze()
    try:
        runs = [side.solve(case, options)]
        end = time.process_time() + seconds - runs[0]["cpu_whole"]
        while len(runs) < MOST and time.process_time() < end:
            gc.collect()
            runs.append(side.solve(case, options))
    finally:
        gc.unfreeze()
    for key in ("cpu", "cpu_stepping", "cpu_whole"):
        if key in runs[-1]:
            runs[-1][key] = statistics.median(run[key] for run in runs)
    return {**runs[-1], "solves": len(runs)}


def peak_memory() -> float:
    """Most resident memory that this process has had, MB.

    On Linux from /proc, since the maximum of getrusage is inherited from the parent.
    """
    status = Path("/proc/self/status")
    if status.exists():
        line = next(row for row in status.read_text().splitlines() if row.startswith("VmHWM"))
        return float(line.split()[1]) / 1024
    import psutil

    info = psutil.Process().memory_info()
    return float(getattr(info, "peak_wset", info.rss)) / 2**20


def answer(side: Any, request: dict[str, Any]) -> Any:
    match request["do"]:
        case "version":
            return side.version()
        case "memory":
            return peak_memory()
        case "settings":
            return side.settings_to_try(CASES[request["case"]])
        case "solve":
            model = CASES[request["case"]]
            if request["steps"]:
                model = model.first(request["steps"])
            model = model.finer(request["refine"])
            return burst(side, model, request["options"], request["seconds"])
    raise ValueError(request["do"])


def main() -> None:
    replies = os.fdopen(os.dup(1), "w", encoding="utf-8")
    os.dup2(2, 1)
    side = importlib.import_module(sys.argv[1])
    for line in sys.stdin:
        try:
            reply = {"ok": answer(side, json.loads(line))}
        except Exception as error:
            text = str(error).strip() or type(error).__name__
            reply = {"error": text.splitlines()[0]}
        print(json.dumps(reply), file=replies, flush=True)


if __name__ == "__main__":
    main()
