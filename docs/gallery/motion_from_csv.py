"""A measured motion with noise moves the end of a rope: what is faster than 3 Hz is smoothed away."""

import numpy as np

import ancf

t = np.linspace(0, 10, 1001)
noise = 0.3 * np.random.default_rng(1).standard_normal(t.size)
table = np.column_stack([t, 400 * np.sin(1.2 * t) ** 2 + noise])
np.savetxt("crane.csv", table, delimiter=",", header="t [s],x [mm]", comments="")

model = ancf.Model(gravity=(0, 0, -9.81))
steel = ancf.Section(EA=1e5, EI=1e-3, rhoA=0.1, axial_damping=50.0)
rope = model.add_beam("rope", start=(0, 0, 0), end=(0, 0, -2), elements=6, section=steel)
hook = model.add_point_mass("hook", at=(0, 0, -2), mass=5.0)
model.connect(hook, rope.end)
model.pin(rope.start, displacement=[ancf.Series.read("crane.csv", "x", cutoff=3.0, relative=True), 0, 0])

result = ancf.simulate(model, t_end=10.0, step=2e-3, start=ancf.equilibrium(model))
result.plot(rope.start, hook, plane="xz").save("motion_from_csv.png")
