"""Blow-off of a conductor in gusts of 25 m/s: its middle, seen along the line."""

import numpy as np

import ancf

model = ancf.Model(gravity=(0, 0, -9.81))
aluminium = ancf.Section(EA=3e7, EI=50.0, rhoA=1.6, diameter=0.03, drag=(1.0, 0.0))
line = model.add_beam("line", start=(0, 0, 0), end=(300, 0, 0), elements=20, length=301.5, section=aluminium)
model.pin(line.start)
model.pin(line.end)
gusts = ancf.Gusts.von_karman(
    25.0,
    deviation=4.0,
    length=80.0,
    extent=(0, 300),
    direction=np.pi / 2,
    line=(1, 0, 0),
    spacing=20.0,
    duration=60.0,
    seed=3,
)
model.add_fluid("wind", density=1.25, velocity=(0, 25.0, 0), gusts=gusts)

result = ancf.simulate(model, t_end=60.0, step=0.05, start=ancf.equilibrium(model))
result.plot(line.at(150.75), plane="yz").save("wind_on_a_conductor.png")
