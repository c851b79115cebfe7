"""Tension at the top and bottom of a mooring chain whose upper end moves with a swell, in still water."""

import ancf

model = ancf.Model(gravity=(0, 0, -9.81))
chain = ancf.Section(
    EA=5e7, EI=10.0, rhoA=60.0, diameter=0.1, drag=(1.6, 0.1), added_mass=(1.0, 0.0), axial_damping=1e5
)
line = model.add_beam("line", start=(0, 0, -50), end=(90, 0, 0), elements=16, length=130.0, section=chain)
model.add_fluid("sea", density=1025.0, below=0.0)
model.add_ground("seabed", height=-50.0, stiffness=1e5, damping=1e3)
model.pin(line.start)
model.pin(line.end, displacement=["0", "0", "ramp(t, 0, 8)*0.5*sin(2*pi*t/8)"])

result = ancf.simulate(model, t_end=40.0, step=0.05, start=ancf.equilibrium(model))
result.plot(line.end, line.start, quantity="tension").save("swell.png")
