"""A rubber rod is let go: its shapes, coloured by time."""

import ancf

model = ancf.Model(gravity=(0, 0, -9.81))
section = ancf.Section.rectangle(width=0.01, height=0.01, E=1e8, rho=500.0)
beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=8, section=section)
model.clamp(beam.start)

result = ancf.simulate(model, t_end=0.4, step=5e-4)
result.plot_shape(9).save("falling_cantilever.png")
