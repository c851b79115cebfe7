"""What the package understands, on one page: sections, beams, supports, loads, statics, motion, modes."""

from math import cos, pi

import ancf


def theta(t: float) -> float:
    """Angle of the moving clamp, rad: a smooth swing by 0.4 rad and back within a second."""
    return 0.2 * (1 - cos(2 * pi * t))


section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0, nu=0.0)
wire = ancf.Section(EA=1.342e7, EI=150.0, rhoA=0.89, damping=0.03)  # or stiffnesses directly

model = ancf.Model(gravity=(0.0, 0.0, -9.81))
beam = model.add_beam(
    "beam",
    start=(0, 0, 0),
    end=(1, 0, 0),
    elements=8,
    section=section,
    element="cable",
    strain="material",  # "material" | "paper"
    length=None,  # natural length, m; default |end - start|
)
model.clamp(beam.start, stretch="free", rotation=theta, axis=(0, 0, 1))  # moving clamp, theta(t) in rad
model.add_force(beam.end, (0.0, 0.0, -0.05))  # N, or a function of time
model.add_moment(beam.end, (0.0, 0.02, 0.0))  # N m

line = model.add_beam("line", start=(0, 1, 0), end=(30, 1, 0), elements=12, section=wire, length=30.2)
model.pin(line.start)
model.pin(line.end)
tail = model.add_beam("tail", start=(30, 1, 0), end=(30, 1, -2), elements=4, section=wire)
tail.set_motion(velocity=(0, 0, 0), angular_velocity=(0, 0.5, 0), about=(30, 1, 0))  # initial rigid motion
model.connect(tail.start, line.end)  # spherical

state = ancf.equilibrium(model, of=[beam, line])
result = ancf.simulate(
    model, t_end=0.4, step=2.5e-4, start=state, integrator=ancf.Trapezoidal(), output_step=1e-3
)
modes = ancf.modes(model, about=state, count=10)

print("times and tip positions:", result.t.shape, result.position(beam.end).shape)
print("tip at the start, m:", state.position(beam.end).round(4))
print("tip at the end, m:", result.position(beam.end)[-1].round(4))
print("sag of the line, m:", -state.position(line.at(15.1))[2].round(4))
print("tension of the line, N:", result.tension(line.at(15.1))[-1].round(1))
print("speed of the tail's end, m/s:", result.velocity(tail.end)[-1].round(4))
print("curvature of the beam at 0.5 m, 1/m:", result.curvature(beam.at(0.5))[-1].round(4))
print("energy at the end, J:", result.energy.total[-1].round(4))
print("lowest frequencies, rad/s:", modes.frequencies[:4].round(4))
print(result.stats.steps, "steps,", result.stats.newton_iterations, "Newton iterations,", end=" ")
print(result.stats.jacobians, "Jacobians,", round(result.stats.cpu_seconds, 3), "s of CPU time")
