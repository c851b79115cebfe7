"""Cost of our three kinds of elements next to each other: example 7.1 with 8 elements, 1600 steps.

``python benchmarks/elements.py``. The runs are taken in turn, one of each kind; default settings.
"""

from __future__ import annotations

import statistics
from typing import Any

from ancf.elements.registry import ELEMENTS
from ancf.paper import cantilever
from kernels import kernels

COUNT = 8
ROUNDS = 9
COUNTERS = ("steps", "newton_iterations", "jacobians")


def costs(rounds: int = ROUNDS) -> list[dict[str, Any]]:
    """Counters and medians of the processor times, s, by kind, and their ratio to the cable's."""
    models = {element: cantilever.build(COUNT, element=element) for element in ELEMENTS}
    stats = {element: cantilever.run(model).stats for element, model in models.items()}  # compiles
    times: dict[str, list[float]] = {element: [] for element in models}
    for _ in range(rounds):
        for element, model in models.items():
            times[element].append(cantilever.run(model).stats.cpu_seconds)
    rows = []
    for element, taken in times.items():
        ratio = statistics.median(own / cable for own, cable in zip(taken, times["cable"], strict=True))
        counters = {key: getattr(stats[element], key) for key in COUNTERS}
        rows.append({"element": element, **counters, "cpu_median": statistics.median(taken), "ratio": ratio})
    return rows


def all_kernels(sizes: tuple[int, ...] = (8, 100, 1000, 10000)) -> list[dict[str, Any]]:
    """Microseconds per element of each kernel, for each kind; the large models with the cable only."""
    return [
        {"element": element, "elements": size, **kernels(size, element)}
        for element in ELEMENTS
        for size in sizes
        if element == "cable" or size <= 100
    ]


def main() -> None:
    for row in costs():
        print(", ".join(f"{key} {value:.4g}" if key != "element" else value for key, value in row.items()))


if __name__ == "__main__":
    main()
