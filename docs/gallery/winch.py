"""A load is hauled in: as the rope gets shorter it swings faster and wider."""

import ancf

model = ancf.Model(gravity=(0, 0, -9.81))
steel = ancf.Section(EA=1e5, EI=1e-3, rhoA=0.05, axial_damping=100.0)
rope = model.add_beam("rope", start=(0, 0, 0), end=(0.5, 0, -3.96), elements=6, section=steel)
load = model.add_point_mass("load", at=(0.5, 0, -3.96), mass=10.0)
model.connect(load, rope.end)
model.pin(rope.start)
model.winch(rope.start, length="3.99 - 2.5*ramp(t, 1, 10)")

result = ancf.simulate(model, t_end=12.0, step=2e-3, start=ancf.equilibrium(model, of=[]))
result.plot(load, plane="xz").save("winch.png")
