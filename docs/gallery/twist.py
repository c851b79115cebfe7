"""A flat strip is twisted by a torque: it gets stiffer and shorter with every turn."""

import numpy as np

import ancf
from ancf.viz import style

model = ancf.Model()
flat = ancf.Section.rectangle(width=0.02, height=0.002, E=2e9, rho=1200.0, nu=0.3)
strip = model.add_beam(
    "strip", start=(0, 0, 0), end=(0.5, 0, 0), elements=8, section=flat, element="nonlocking"
)
model.clamp(strip.start)
model.hold(strip.end, position="yz")
model.add_moment(strip.end, (4 * np.pi * flat.G * flat.J / 0.5, 0, 0))
state = ancf.equilibrium(model, load_steps=8)

x = np.linspace(0, 0.5, 120)
with style.new_figure(150, 60) as figure:
    axes = figure.subplots()
    for k, y in enumerate((-0.01, 0.01)):
        edge = np.array([state.position(strip.at(s, y, 0)) for s in x])
        axes.plot(edge[:, 0], 1e3 * edge[:, 2], label=f"edge at y = {1e3 * y:g} mm", **style.line(k))
    axes.set(xlabel="x [m]", ylabel="z [mm]")
    axes.set_title(
        f"{np.degrees(state.twist(strip.end)):.0f}° at the end; shorter by "
        f"{1e3 * (0.5 - state.position(strip.end)[0]):.2f} mm"
    )
    figure.savefig("twist.png")
