"""How long it takes to start: import, first runs with everything compiled anew, later runs."""

from __future__ import annotations

import os
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from measure import ONE_THREAD

COMMAND = "import sys; from ancf.cli import main; sys.exit(main())"
MODEL = """
gravity = [0, 0, -9.81]
[[bodies]]
name = "beam"
start = [0, 0, 0]
end = [1, 0, 0]
elements = 16
section = { EA = 1e4, EI = 0.0833, rhoA = 0.05 }
[[supports]]
type = "clamp"
point = "beam.start"
[simulation]
t_end = 0.4
step = 2.5e-4
"""

HOIST = Path(__file__).parent.parent / "examples" / "hoist.toml"
#: Python keeps what it has translated of a module, as it does by default.
_SURROUNDINGS = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}


def seconds(arguments: list[str], **environment: str) -> float:
    """Wall time of a Python process from start to end, s."""
    start = time.perf_counter()
    subprocess.run(
        [sys.executable, *arguments],
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={**_SURROUNDINGS, **ONE_THREAD, **environment},
    )
    return time.perf_counter() - start


def median(repeats: int, arguments: list[str], **environment: str) -> float:
    """Median of several such times, after one that is not counted."""
    return statistics.median([seconds(arguments, **environment) for _ in range(repeats + 1)][1:])


def startup(repeats: int, first_run: bool) -> dict[str, Any]:
    """Times in s; a fresh numba cache stands for a fresh machine."""
    times = {
        "python": median(repeats, ["-c", "pass"]),
        "import_ancf": median(repeats, ["-c", "import ancf"]),
    }
    with tempfile.TemporaryDirectory() as folder:
        model, out = Path(folder) / "model.toml", Path(folder) / "out"
        model.write_text(MODEL, encoding="utf-8")
        run = ["-c", COMMAND, "run", str(model), "-o", str(out)]
        other = ["-c", COMMAND, "run", str(HOIST), "-o", str(out)]
        if first_run:
            cache = str(Path(folder) / "cache")
            times["first_run"] = seconds(run, NUMBA_CACHE_DIR=cache)
            times["later_run"] = median(repeats, run, NUMBA_CACHE_DIR=cache)
            times["other_kinds"] = seconds(other, NUMBA_CACHE_DIR=cache)
            times["other_kinds_later"] = median(repeats, other, NUMBA_CACHE_DIR=cache)
        else:
            times["later_run"] = median(repeats, run)
    return times
