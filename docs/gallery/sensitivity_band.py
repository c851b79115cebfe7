"""A run and what five per cent more or less bending stiffness make of it, by exact derivatives."""

import ancf
from ancf.viz import style

model = ancf.Model(gravity=(0, 0, -9.81))
section = ancf.Section(EA=1e4, EI=1.0, rhoA=0.5)
beam = model.add_beam("beam", start=(0, 0, 0), end=(1, 0, 0), elements=6, section=section)
model.clamp(beam.start)
result = ancf.simulate(model, t_end=1.0, step=2e-3, sensitivities=["beam.EI"])

tip = result.position(beam.end)[:, 2]
change = 0.05 * section.EI * result.sensitivity("beam.EI").position(beam.end)[:, 2]
with style.new_figure(120, 70) as figure:
    axes = figure.subplots()
    axes.fill_between(result.t, tip - change, tip + change, color=style.LIGHT, label="EI ± 5 %")
    axes.plot(result.t, tip, color=style.BLUE, label="EI = 1 N m²")
    axes.set(xlabel="time [s]", ylabel="height of the tip [m]")
    style.legend_above(figure, axes)
    figure.savefig("sensitivity_band.png")
