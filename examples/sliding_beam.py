"""Example 7.4 of the paper: a beam with a mass at its tip slides down along a hinged carrier beam."""

import numpy as np

import ancf


def build(carrier: int = 64, slider: int = 4) -> ancf.Model:
    section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e6, rho=800.0)  # m, m, N/m^2, kg/m^3
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    lower = model.add_beam(
        "carrier", start=(0, 0, 0), end=(0, 3, 1), elements=carrier, section=section, strain="paper"
    )
    upper = model.add_beam(
        "slider", start=(0, 3, 1), end=(1, 3, 1), elements=slider, section=section, strain="paper"
    )
    tip = model.add_point_mass("tip", at=(1, 3, 1), mass=1.0)
    model.pin(lower.start)
    model.pin(lower.end)
    model.connect(tip, upper.end, name="tip joint")
    model.slide(upper.start, along=lower, name="joint")
    return model


def main(t_end: float = 1.0) -> None:
    model = build()
    start = ancf.equilibrium(model, of=["carrier"])  # the sliding beam starts straight
    result = ancf.simulate(model, t_end=t_end, step=2e-4, start=start, output_step=2e-3)
    x, y, z = result.position("tip")[-1]
    force = np.linalg.norm(result.multiplier("joint"), axis=1)
    print(f"mass at t = {result.t[-1]:g} s: x = {x:.4f} m, y = {y:.4f} m, z = {z:.4f} m")
    print(f"the joint has slid from s = {result.arc_length('joint')[0]:.4f} m", end=" ")
    print(f"to {result.arc_length('joint')[-1]:.4f} m")
    print(f"largest force on the carrier: {force.max():.3f} N")
    print(f"{result.stats.newton_iterations} Newton iterations, {result.stats.jacobians} Jacobians")


if __name__ == "__main__":
    main()
