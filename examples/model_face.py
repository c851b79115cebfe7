"""What the package understands, on one page: sections, beams, supports, loads, statics, motion, modes."""

import ancf


def theta(t: float) -> float:
    """Angle of the moving clamp, rad: it turns at the rate at which the beam starts."""
    return 4.0 * t


section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0, nu=0.0)
wire = ancf.Section(EA=1.342e7, EI=150.0, rhoA=0.89, damping=0.03)  # or stiffnesses directly

model = ancf.Model(gravity=(0.0, 0.0, -9.81))
beam = model.add_beam(
    "beam",
    start=(0, 0, 0),
    end=(1, 0, 0),
    elements=8,
    section=section,
    element="cable",  # "cable" | "original" | "nonlocking"
    strain="material",  # of cables: "material" | "paper"
    poisson="centreline",  # of the beams: "centreline" | "full"; a cable ignores it
    length=None,  # natural length, m; default |end - start|
)
beam.set_motion(velocity=(0, 0, 0), angular_velocity=(0, 0, 4.0), about=(0, 0, 0))  # initial rigid motion
model.clamp(beam.start, stretch="free")  # "free" | "fixed"
model.clamp(beam.start, rotation=theta, axis=(0, 0, 1))  # moving clamp, theta(t) in rad
model.add_force(beam.end, (0.0, 0.0, -0.1))  # N, or a function of time
model.add_moment(beam.end, (0.0, 0.05, 0.0))  # N m

line = model.add_beam("line", start=(0, 2, 0), end=(30, 2, 0), length=30.2, elements=12, section=wire)
model.pin(line.start)  # spherical joint to the ground
model.pin(line.end)

state = ancf.equilibrium(model)  # of=[line] for some bodies alone
result = ancf.simulate(
    model, t_end=0.4, step=2.5e-4, start=state, integrator=ancf.Trapezoidal(), output_step=None
)
modes = ancf.modes(model, about=state, count=10)

print("times and positions:", result.t.shape, result.position(beam.end).shape)
print("tip at rest, m:", state.position(beam.end).round(5))
print("tip at the end, m:", result.position(beam.end)[-1].round(5))
print("its velocity, m/s:", result.velocity(beam.end)[-1].round(4))
print("curvature of the beam's middle, 1/m:", result.curvature(beam.at(0.5))[-1].round(4))
print("sag of the line, m:", -state.position(line.at(15.1))[2].round(4))
print("tension of the line, N:", result.tension(line.at(15.1))[-1].round(1))
print("energy at the end, J:", result.energy.total[-1].round(5))
print("lowest frequencies, rad/s:", modes.frequencies[:4].round(3))
print(result.stats.steps, "steps,", result.stats.newton_iterations, "Newton iterations,", end=" ")
print(result.stats.jacobians, "Jacobians,", round(result.stats.cpu_seconds, 3), "s of CPU time")
