"""Makes examples/calibrate.csv: a hanging cable that swings free, "measured" with 1 % noise.

``ancf calibrate examples/calibrate.toml`` finds its bending stiffness, damping and length again.
"""

import csv
from pathlib import Path

import numpy as np

import ancf
from ancf.model.file import read_study

HERE = Path(__file__).parent
#: What the calibration is to find.
TRUE = {"EI": 0.02, "damping": 0.06, "length": 2.15}
COLUMNS = [f"position(cable.at({x}))[{k}]" for x in (0.5, 1.0, 1.5) for k in (1, 2)]


def measured(noise: float = 0.01, seed: int = 1) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times and columns with noise in parts of their spread."""
    study = read_study(HERE / "calibrate_model.toml", TRUE)
    settings = study.simulation
    result = ancf.simulate(
        study.model,
        t_end=settings.t_end,
        step=settings.step,
        start=ancf.equilibrium(study.model),
        integrator=settings.integrator,
        output_step=0.02,
    )
    draw = np.random.default_rng(seed)
    columns = {}
    for name in COLUMNS:
        point, component = name.removeprefix("position(").removesuffix("]").split(")[")
        exact = result.position(point)[:, int(component)]
        columns[name] = exact + noise * np.std(exact) * draw.standard_normal(len(exact))
    return result.t, columns


def main() -> None:
    """Write the file."""
    t, columns = measured()
    with (HERE / "calibrate.csv").open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["t", *columns])
        writer.writerows([f"{x:.7g}" for x in row] for row in zip(t, *columns.values(), strict=True))


if __name__ == "__main__":
    main()
