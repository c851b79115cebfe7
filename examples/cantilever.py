"""Example 7.1 of the paper: a soft cantilever, straight and at rest, falls under its own weight."""

import ancf


def build(elements: int = 16) -> ancf.Model:
    section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0)  # m, m, N/m^2, kg/m^3
    model = ancf.Model(gravity=(0.0, 0.0, -9.81))
    beam = model.add_beam(
        "beam", start=(0, 0, 0), end=(1, 0, 0), elements=elements, section=section, strain="paper"
    )
    model.clamp(beam.start, stretch="fixed")
    return model


def main(t_end: float = 0.4) -> None:
    result = ancf.simulate(build(), t_end=t_end, step=2.5e-4, integrator=ancf.Trapezoidal())
    x, _, z = result.position("beam.end")[-1]
    energy, stats = result.energy.total, result.stats
    print(f"tip at t = {result.t[-1]:g} s: x = {x:.6f} m, z = {z:.6f} m")
    print(f"drift of the energy: {abs(energy - energy[0]).max():.2e} J")
    print(f"{stats.steps} steps, {stats.newton_iterations} Newton iterations, {stats.jacobians} Jacobians")


if __name__ == "__main__":
    main()
